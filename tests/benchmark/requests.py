#!/usr/bin/python3
"""Are requested accuracies met, how good are the estimates, and what does a ladder cost?

    tests/benchmark/requests.py                          # all scenes; results are kept under results/requests
    tests/benchmark/requests.py --scene shear drop       # these
    tests/benchmark/requests.py --scene shear --search   # also the cheapest single run that meets each request

For each scene and each of its series, `--accuracy` is asked for 1 %, 0.1 % and 0.01 % of the largest value. Levels that
are finished are used again by the next request. The true error is the difference from a run that is two levels finer
than the finest level. A ladder that stops at its limit and says so is neither met nor missed.

`--search` looks for the cheapest single run that meets the request among n = 3 to 12 and the five pairs of tolerances
of accuracy.py. The cost is the number of processor seconds.
"""

import argparse
import json
import pathlib
import shutil

from package import answer, numpy, studies, tanktread
from tanktread.figures.accuracy import average, largest
from tanktread.results import Run


REQUESTS = [1e-2, 1e-3, 1e-4]
TOLERANCES = [(1e-3, 1e-3), (3e-4, 3e-4), (1e-4, 1e-4), (2e-5, 1e-5), (4e-6, 1e-5)]
SIDES = [3, 4, 5, 6, 8, 10, 12]
D, ENERGY, STRESS = "taylor_inertia", "energy", "stresslet_13"
TREADING, LENGTH, AREA, V1 = "tank_treading_velocity", "length_x1", "area", "velocity_x1"
# name: deck, settings, series
SHIPPED = {
    "shear": ("shear_neo_hookean", {}, [D, TREADING, STRESS]),
    "skalak": ("shear_skalak", {}, [D, ENERGY, LENGTH]),
    "bending": ("shear_bending", {"Time/final time": 2.0}, [D, ENERGY, "inclination"]),
    "oblate": ("oblate_shear", {"Time/final time": 4.0, "Output/interval": 0.2}, [D, STRESS, AREA]),
    "extension": ("uniaxial_extension", {}, [D, "stresslet_11", "energy@end"]),
    "drop": ("drop_uniaxial", {}, [D, "stresslet_11", "area@end"]),
    "parabolic": ("parabolic_capsule", {}, [D, V1, "inclination"]),
    "oscillating": ("oscillating_shear", {}, [D, STRESS, "energy@mean"]),
    "relaxation": ("relaxation", {}, [D, ENERGY, AREA]),
    "viscous": ("viscous_membrane", {}, [D, STRESS, "membrane_dissipation"]),
    "adaptive": ("hyperbolic_skalak", {}, [D, LENGTH, ENERGY]),
    "drop_steady": ("drop_steady", {}, [D, "leading_rate", "stresslet_11"]),
    "capsule_steady": ("capsule_steady", {}, [D, "leading_rate", ENERGY]),
    "jeffery": ("jeffery", {"Time/final time": 6.0}, ["inclination", "stresslet_13", "angular_velocity_x2"]),
    "sphere_array": ("sphere_array", {}, ["sphere/drag_x1", "pressure_gradient_x1", "sphere/torque_x2"]),
    "settling": ("settling_spheres", {}, ["left/velocity_x3", "left/centroid_x3", "left/stresslet_33"]),
    "tube": ("capsule_in_tube", {"Time/final time": 2.0}, [V1, "disturbed_pressure_drop", LENGTH]),
    "fold": ("drop_branch", {}, ["parameter", "taylor_inertia", "area"]),
}
CAPSULE = "Membrane: {law: neo-Hookean, capillary number: 0.2}, Time: {final time: 2.0}, Output: {interval: 0.1}"
OWN = {
    "weak": ("{Flow: {type: simple shear}, Membrane: {law: neo-Hookean, capillary number: 0.05}, Time: {final time: 1.0}, "
             "Output: {interval: 0.05}}", [D, ENERGY, STRESS]),
    "thin": ("{Flow: {type: simple shear}, Particle: {viscosity ratio: 0.1}, " + CAPSULE + "}", [D, AREA, TREADING]),
    "thick": ("{Flow: {type: simple shear}, Particle: {viscosity ratio: 8.0}, " + CAPSULE + "}", [D, STRESS, TREADING]),
    "planar": ("{Flow: {type: planar hyperbolic}, " + CAPSULE + "}", [D, "stresslet_11", ENERGY]),
    "red_cell": ("{Flow: {type: simple shear}, Particle: {shape: red cell}, Membrane: {law: Skalak, capillary number: 0.5, "
                 "bending modulus: 0.01, bending reference: flat}, Time: {final time: 1.0}, Output: {interval: 0.05}}",
                 [D, AREA, "inclination"]),
    "pair": ("{Flow: {type: simple shear}, Particles: {defaults: {Membrane: {law: neo-Hookean, capillary number: 0.3}}, "
             "a: {center: [-1.5, 0.0, 0.4]}, b: {center: [1.5, 0.0, -0.4]}}, Time: {final time: 2.0}, "
             "Output: {interval: 0.1}}", ["a/taylor_inertia", "b/velocity_x3", "smallest_gap"]),
    "tube_drop": ("{Flow: {type: duct, mean velocity: 1.0}, Tube: {section: circle}, Particle: {radius: 0.5}, "
                  "Membrane: {law: surface tension, capillary number: 0.1}, Time: {final time: 1.0}, "
                  "Output: {interval: 0.1}}", [D, V1, "disturbed_pressure_drop"]),
    "lattice": ("{Flow: {type: simple shear}, Domain: {side lengths: [3.0, 3.0, 3.0]}, " + CAPSULE.replace("2.0}", "1.0}")
                + "}", ["relative_viscosity", "particle/taylor_inertia", "normal_stress_difference_1"]),
    "surfactant": ("{Flow: {type: simple shear}, Membrane: {law: surface tension, capillary number: 0.1}, "
                   "Interface: {surfactant: {elasticity number: 0.3, Peclet number: 5.0}}, Time: {final time: 1.0}, "
                   "Output: {interval: 0.05}}", [D, "largest_concentration", AREA]),
    "refined": ("{Flow: {type: planar hyperbolic}, Membrane: {law: Skalak, capillary number: 0.5}, Adaptation: "
                "{enabled: true}, Time: {final time: 2.0}, Output: {interval: 0.1}}", [D, LENGTH, ENERGY]),
    "steady_drop": ("{Flow: {type: simple shear}, Membrane: {law: surface tension, capillary number: 0.15}, Steady: {}}",
                    [D, "inclination", STRESS]),
    "polar": ("{Flow: {type: simple shear}, Surface: {mesh: polar, poles: c1}, " + CAPSULE + "}", [D, ENERGY, STRESS]),
    "held": ("{Flow: {type: simple shear}, Particle: {shape: spheroid, semi-axes: [1.0, 1.0, 2.0], motion: prescribed, "
             "velocity: [0.0, 0.0, 1.0]}}", ["drag_x3", "torque_x2", "stresslet_13"]),
}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scene", nargs="+", default=[*SHIPPED, *OWN], choices=[*SHIPPED, *OWN], metavar="NAME",
                        help=f"of {', '.join([*SHIPPED, *OWN])} (default: all)")
    parser.add_argument("--search", action="store_true", help="also search the cheapest single run")
    studies.arguments(parser, "results/requests")
    parser.set_defaults(limit=60)
    parsed = parser.parse_args()
    study = studies.study(parsed)
    rows = []
    print("| scene | request | level | allowed | true error | estimate | estimate/true | result | ladder, s | cheapest, s |\n"
          "|---|---|---|---|---|---|---|---|---|---|")
    for name in parsed.scene:
        try:
            rows += Scene(name, parsed.output / "ladders", study, parsed.limit).rows(parsed.search)
        except tanktread.Mistake as mistake:
            print(f"| {name} | {mistake} |", flush=True)
    report(rows)


class Scene:
    """A scene, its ladders and its reference."""

    def __init__(self, name, folder, study, limit):
        self.name, self.study, self.limit = name, study, limit
        folder.mkdir(parents=True, exist_ok=True)
        if name in SHIPPED:
            deck, self.settings, self.series = SHIPPED[name]
            self.deck = f"inputs/{deck}.yaml"
        else:
            text, self.series = OWN[name]
            self.settings = {}
            self.deck = folder / f"{name}.yaml"
            self.deck.write_text(f"Tanktread: {text}\n", encoding="utf-8")
        self.directory = folder / name

    def ladder(self, request):
        """Returns the summary of the ladder for a request, and how it ended."""
        words = {"Accuracy/requests": request, "Accuracy/wall-clock limit": self.limit}
        fresh = not (self.directory / "ladder.yaml").exists()
        start = [str(tanktread.runs.deck_at(self.deck)), "--no-expect", "--output", str(self.directory)] + sets(
            self.settings) if fresh else ["--resume", str(self.directory)]
        note = self.study._make([str(self.study.program), *start, *sets(words), "--quiet"])
        if note["code"] not in (0, 1, 4):
            shutil.rmtree(self.directory, ignore_errors=True)
            raise tanktread.Mistake(f"{request}: {note['message']}")
        return Run(self.directory).summary["accuracy"], note["code"]

    def rows(self, search):
        found, reached = [], 0
        for value in REQUESTS:
            for series in self.series:
                accuracy, code = self.ladder(f"{series}={100 * value:g}%")
                level = accuracy["levels"][-1]["level"]
                reached = max(reached, level)
                cost = sum(one["seconds"] for one in accuracy["levels"])
                found.append((accuracy["requests"][0], level, code, cost))
        reference = self.reference(reached)
        rows = []
        for request, level, code, cost in found:
            mine = self.values(Run(self.directory / f"level_{level}"), request)
            true = largest(mine, self.values(reference, request))
            result = "unknown" if not request["met"] and code == 4 else "untrusted" if "untrusted" in request else (
                "met" if true <= request["allowed"] else "missed") if request["met"] else "not reached"
            cheapest = self.cheapest(request, reference) if search and request["met"] else numpy.nan
            cost = self.fresh(request["request"]) if search and request["met"] else cost
            row = {"scene": self.name, "request": request["request"], "level": level, "allowed": request["allowed"],
                   "true": true, "estimate": request["estimated error"],
                   "factor": request["estimated error"] / true if true > 0 else numpy.nan, "result": result,
                   "seconds": cost, "cheapest": cheapest}
            print("| " + " | ".join(f"{one:.3g}" if isinstance(one, float) else str(one) for one in row.values()) + " |",
                  flush=True)
            rows.append(row)
        (self.directory / "requests.json").write_text(json.dumps(rows), encoding="utf-8")
        return rows

    def fresh(self, request):
        """Returns the processor seconds of a whole ladder."""
        words = sets(self.settings | {"Accuracy/requests": request})
        directory = self.directory.with_name(f"{self.name}_fresh")
        return self.study._make([str(self.study.program), str(tanktread.runs.deck_at(self.deck)), "--no-expect", "--quiet",
                                 "--overwrite", "--output", str(directory), *words])["processor_seconds"]

    def reference(self, level):
        """Returns a run two levels finer."""
        series = self.series[0].split("@")[0]
        words = {"Accuracy/requests": f"{series}=1e-14", "Accuracy/levels": min(level + 3, max(level + 2, 7)),
                 "Accuracy/wall-clock limit": 5 * self.limit}
        self.study._make([str(self.study.program), "--resume", str(self.directory), *sets(words), "--quiet"])
        finer = [k for k in (level + 2, level + 1) if (self.directory / f"level_{k}/summary.yaml").exists()]
        if not finer:
            raise tanktread.Mistake("the reference did not come to its end")
        return Run(self.directory / f"level_{finer[0]}")

    @staticmethod
    def values(run, request):
        """Returns the times and values of which the request limits the error."""
        times, series = run.series["time"], run.series[request["series"]]
        if "fold" in run.series:
            chosen = numpy.flatnonzero((run.series["fold"] != 0) | (numpy.arange(len(series)) == len(series) - 1))
            times, series = numpy.arange(len(chosen), dtype=float), series[chosen]
        if request["of"] == "run":
            return times, series
        return numpy.zeros(1), numpy.array([series[-1] if request["of"] == "end" else average(times, series)])

    def cheapest(self, request, reference):
        """Returns the processor seconds of the cheapest single run that meets the request."""
        best = numpy.inf
        for pair in TOLERANCES:
            for side in SIDES:
                outcome = self.study.run(self.deck, self.settings | {
                    "Surface/elements per side": side, "Time/tolerance": pair[0], "Quadrature/tolerance": pair[1]})
                if not outcome.done or outcome.processor_seconds > best:
                    break
                if largest(self.values(outcome.run, request), self.values(reference, request)) <= request["allowed"]:
                    best = min(best, outcome.processor_seconds)
                    break
        return best if numpy.isfinite(best) else numpy.nan


def sets(settings):
    return [word for key, value in settings.items() for word in ("--set", f"{key}={tanktread.runs.text_of(value)}")]


def report(rows):
    """Prints the shares of requests that are met and of estimates that are good."""
    counted = [row for row in rows if row["result"] in ("met", "missed")]
    factors = numpy.array([row["factor"] for row in counted if numpy.isfinite(row["factor"])])
    print(f"\n{len(rows)} cases, of which {len(counted)} count: "
          + ", ".join(f"{sum(row['result'] == word for row in rows)} {word}" for word in
                      ("met", "missed", "unknown", "untrusted", "not reached")))
    if len(counted):
        print(f"met: {numpy.mean([row['result'] == 'met' for row in counted]):.3f}; estimate/true error between 1/3 and 3: "
              f"{numpy.mean((factors > 1 / 3) & (factors < 3)):.3f}, median {numpy.median(factors):.2f}")
    ratios = [row["seconds"] / row["cheapest"] for row in rows if numpy.isfinite(row["cheapest"])]
    if ratios:
        print(f"seconds of the ladder divided by the cheapest run: median {numpy.median(ratios):.1f}, largest {max(ratios):.1f}")


if __name__ == "__main__":
    answer(main)
