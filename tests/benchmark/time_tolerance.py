#!/usr/bin/python3
"""Whether Time/tolerance means what it says, and what it costs: errors of time integration alone, on one mesh.

    tests/benchmark/time_tolerance.py ratios     # viscosity ratios 0.05 to 50: error divided by tolerance, each implicit scheme
    tests/benchmark/time_tolerance.py scenes     # the same for scenes of other kinds, default scheme
    tests/benchmark/time_tolerance.py cost --against OLD_PROGRAM    # cheapest run with an error below 1e-4, divided by that of another program
    tests/benchmark/time_tolerance.py schemes    # evaluations and seconds of every scheme for an error below 1e-4; soft, stiff, tubes, lattices, several
    tests/benchmark/time_tolerance.py figure     # error against work at four viscosity ratios, results/time_tolerance/viscosity_ratio.png

The error is the largest difference of D (`taylor_inertia`, of the particle where it is largest) over the run to a reference on the same mesh with the
same integrals. Two references by different schemes are made; their difference is printed. Runs are made once, under results/time_tolerance.
"""
import argparse
import pathlib
import sys

SOURCE = pathlib.Path(__file__).resolve().parents[2]
import package  # noqa: E402, F401 before the package tanktread
import numpy  # noqa: E402
from scipy.interpolate import CubicSpline  # noqa: E402

import tanktread  # noqa: E402

SHEAR, RATIO, SIDE = "inputs/shear_neo_hookean.yaml", "Particle/viscosity ratio", "Surface/elements per side"
BASE = {SIDE: 6, "Quadrature/tolerance": 1e-6}
LONG = {"Output/interval": 1e3, "Time/steady tolerance": 1e-13}  # pictures and an early end would shorten steps
RATIOS = [0.05, 0.2, 1, 2, 5, 10, 50]


def shear(ratio, **more):
    return SHEAR, BASE | {RATIO: ratio} | {key.replace("_", " "): value for key, value in more.items()}


SCENES = {  # name: deck, settings
    "flow that oscillates, ratio 5": ("inputs/oscillating_shear.yaml", {RATIO: 5}),
    "flow that oscillates, ratio 0.2": ("inputs/oscillating_shear.yaml", {RATIO: 0.2}),
    "drop in extension, ratio 5": ("inputs/drop_uniaxial.yaml", {SIDE: 6, RATIO: 5, "Time/final time": 4}),
    "drop in extension, ratio 0.1": ("inputs/drop_uniaxial.yaml", {SIDE: 6, RATIO: 0.1, "Time/final time": 4}),
    "drop in shear, ratio 2": ("inputs/drop_uniaxial.yaml", {"Flow/type": "simple shear", "Membrane/capillary number": 0.2, SIDE: 6, RATIO: 2, "Time/final time": 4}),
    "red cell stretched": ("inputs/red_cell_si.yaml", {}),
    "red cell in shear, ratio 5": ("inputs/shear_bending.yaml", {"Particle/shape": "red cell", RATIO: 5, "Membrane/law": "Skalak", SIDE: 8,
                                                               "Membrane/capillary number": 0.5, "Time/final time": 3}),
    "adaptive mesh": ("inputs/hyperbolic_skalak.yaml", {}),
    "adaptive mesh, ratio 5": ("inputs/hyperbolic_skalak.yaml", {RATIO: 5}),
    "drop, adaptive mesh": ("inputs/drop_four_roll.yaml", {"Time/final time": 3}),
    "two capsules, ratio 5": ("inputs/capsule_pair.yaml", {"Particles/defaults/viscosity ratio": 5, "Particles/defaults/Surface/elements per side": 4,
                                                          "Particles/first/center": [-2, 0, 0.25], "Particles/second/center": [2, 0, -0.25],
                                                          "Time/final time": 8}),
    "lattice, ratio 5": ("inputs/sheared_lattice.yaml", {"Particles/capsule/viscosity ratio": 5, "Time/final time": 3}),
    "lattice, ratio 0.2": ("inputs/sheared_lattice.yaml", {"Particles/capsule/viscosity ratio": 0.2, "Time/final time": 3}),
    "viscous membrane": ("inputs/viscous_membrane.yaml", {"Time/final time": 6}),
    "viscous membrane, ratio 5": ("inputs/viscous_membrane.yaml", {RATIO: 5, "Time/final time": 6}),
    "tube, ratio 5": ("inputs/capsule_in_tube.yaml", {SIDE: 6, RATIO: 5, "Time/final time": 1}),
    "tube, ratio 0.2": ("inputs/capsule_in_tube.yaml", {SIDE: 6, RATIO: 0.2, "Time/final time": 1}),
    "next to a wall, ratio 10": ("inputs/capsule_lifted_from_wall.yaml", {RATIO: 10, "Time/final time": 3}),
    "parabolic flow, ratio 5": ("inputs/parabolic_capsule.yaml", {RATIO: 5}),
    "oblate, ratio 20": ("inputs/oblate_shear.yaml", {RATIO: 20, "Time/final time": 6}),
}
COSTS = {"ratio 5": shear(5), "ratio 5, n = 12": shear(5, **{SIDE: 12}), "ratio 1": shear(1), "ratio 0.2": shear(0.2),
         "viscous membrane": SCENES["viscous membrane"], "tube, ratio 5": ("inputs/capsule_in_tube.yaml", {SIDE: 6, RATIO: 5})}
SCHEMES = {f"ratio {ratio:g}": shear(ratio) for ratio in RATIOS} | {
    "Ca = 0.02": (SHEAR, BASE | {"Membrane/capillary number": 0.02, "Membrane/pre-inflation": 0.05, "Time/final time": 2}),
    "Ca = 2, Skalak": (SHEAR, BASE | {"Membrane/law": "Skalak", "Membrane/capillary number": 2, "Time/final time": 3}),
    "Skalak, C = 100": (SHEAR, BASE | {"Membrane/law": "Skalak", "Membrane/area dilatation": 100, "Time/final time": 3}),
    **{name: SCENES[name] for name in ("tube, ratio 5", "lattice, ratio 5", "two capsules, ratio 5", "drop in extension, ratio 5")}}


class Runs:
    """Runs of one program. `reference` returns a run by an explicit scheme, and its difference to one by an implicit scheme."""

    def __init__(self, program, directory, jobs, limit):
        self.study = tanktread.Study(program, directory, limit, jobs)

    def many(self, scene, variants, also=LONG):
        deck, base = scene
        return self.study.all([(deck, base | also | variant) for variant in variants])

    def reference(self, scene, tolerance):
        implicit = {"Time/scheme": "bdf3", "Time/newton iterations": 20, "Time/tolerance": 10 * tolerance}  # its steps err by less (4.31)
        first, second = self.many(scene, [{"Time/scheme": "bs3", "Time/tolerance": tolerance}, implicit])
        found = [one for one in (first, second) if one.done]
        if len(found) < 2:
            sys.exit(f"{scene}: a reference did not come to its end: {first.message} {second.message}")
        return first, error(second, first)


def error(outcome, reference):
    """Largest |D - reference's D| over the run, of the particle where it is largest."""
    largest = 0.0
    for name in (name for name in reference.series if name.split("/")[-1] == "taylor_inertia"):
        time, values = reference.series["time"], reference.series[name]
        later = numpy.concatenate([[True], numpy.diff(time) > 0])
        at = outcome.series["time"]
        inside = at <= time[-1]
        largest = max(largest, numpy.max(abs(outcome.series[name][inside] - CubicSpline(time[later], values[later])(at[inside]))))
    return float(largest)


def cheapest(outcomes, reference, level=1e-4):
    """Evaluations and processor seconds of the cheapest run with an error below the level; None if there is none."""
    good = [one for one in outcomes if one.done and error(one, reference) < level]
    return (min(one.counts["evaluations"] for one in good), min(one.processor_seconds for one in good)) if good else None


def table(head, rows):
    print("| " + " | ".join(head) + " |\n" + "|---" * len(head) + "|")
    for row in rows:
        print("| " + " | ".join(row) + " |", flush=True)


def ratios(runs, parsed):
    tolerances, schemes = [1e-3, 1e-4, 1e-5, 1e-6], ["tr-bdf2", "bdf3", "auto"]

    def rows():
        for ratio in RATIOS:
            scene = shear(ratio)
            reference, difference = runs.reference(scene, 1e-8)
            cells = []
            for scheme in schemes:
                outcomes = runs.many(scene, [{"Time/scheme": scheme, "Time/tolerance": one} for one in tolerances])
                cells.append(", ".join(f"{error(one, reference) / tolerance:.2f}" for one, tolerance in zip(outcomes, tolerances)))
            yield [f"{ratio:g}", *cells, f"{difference:.0e}"]

    table(["viscosity ratio", *(f"`{scheme}` at 1e-3 to 1e-6" for scheme in schemes), "references differ by"], rows())


def scenes(runs, parsed):
    tolerances = [1e-4, 1e-5]

    def rows():
        for name, scene in SCENES.items():
            reference, difference = runs.reference(scene, 1e-7)
            outcomes = runs.many(scene, [{"Time/tolerance": one} for one in tolerances])
            yield [name, *(f"{error(one, reference) / tolerance:.2f} ({one.counts['evaluations']})" for one, tolerance in zip(outcomes, tolerances)),
                   f"{difference:.0e}"]

    table(["scene", "error/tolerance (evaluations) at 1e-4", "at 1e-5", "references differ by"], rows())


SWEEP = [{"Time/tolerance": round(10 ** (-k / 4), 12)} for k in range(8, 25)]


def cost(runs, parsed):
    old = Runs(parsed.against, parsed.output / "old", parsed.jobs, parsed.limit)

    def rows():
        for name, scene in COSTS.items():
            reference, _ = runs.reference(scene, 1e-7)
            (e0, s0), (e1, s1) = (cheapest(one.many(scene, SWEEP, {}), reference) or (numpy.nan, numpy.nan) for one in (old, runs))
            yield [name, f"{e0}", f"{e1}", f"{e1 / e0:.2f}", f"{s0:.2f}", f"{s1:.2f}", f"{s1 / s0:.2f}"]

    table(["scene", "evaluations before", "now", "ratio", "processor seconds before", "now", "ratio"], rows())


def schemes(runs, parsed):
    names = ["tr-bdf2", "bdf3", "auto", "bs3", "rkc2"]

    def rows():
        for name, scene in SCHEMES.items():
            reference, _ = runs.reference(scene, 1e-7)
            found = [cheapest(runs.many(scene, [{"Time/scheme": scheme} | one for one in SWEEP]), reference) for scheme in names]
            yield [name, *(f"{one[0]}, {one[1]:.2f} s" if one else "" for one in found)]

    table(["evaluations and seconds for an error below 1e-4", *(f"`{name}`" for name in names)], rows())


def figure(runs, parsed):
    import style
    names = ["tr-bdf2", "bdf3", "auto", "bs3", "rkc2"]
    drawing, axes = style.plt.subplots(2, 4, figsize=(12, 6), sharey=True)
    for column, ratio in enumerate((0.2, 1, 5, 20)):
        reference, _ = runs.reference(shear(ratio), 1e-8)
        for name, color in zip(names, style.RUNS):
            done = [one for one in runs.many(shear(ratio), [{"Time/scheme": name} | one for one in SWEEP]) if one.done]
            errors = [error(one, reference) for one in done]
            for axis, work in zip(axes[:, column], ([one.processor_seconds for one in done], [one.counts["evaluations"] for one in done])):
                axis.loglog(work, errors, ".-", color=color, label=name, markersize=4, linewidth=1)
        axes[0, column].set(title=f"viscosity ratio {ratio:g}", xlabel="processor seconds")
        axes[1, column].set_xlabel("velocity evaluations")
    for axis in axes[:, 0]:
        axis.set_ylabel("largest error of D")
    axes[0, 0].legend(fontsize=8)
    style.save(drawing, parsed.output / "viscosity_ratio.png")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["ratios", "scenes", "cost", "schemes", "figure"])
    parser.add_argument("--program", type=pathlib.Path, default=tanktread.PROGRAM, help="default: %(default)s")
    parser.add_argument("--against", type=pathlib.Path, help="another program, for `cost`")
    parser.add_argument("--output", type=pathlib.Path, default="results/time_tolerance", help="where runs stand (default: %(default)s)")
    parser.add_argument("--jobs", type=int, default=1, help="runs at a time (default: %(default)s)")
    parser.add_argument("--limit", type=float, default=900, metavar="SECONDS", help="of processor time of a run (default: %(default)s)")
    parsed = parser.parse_args()
    if parsed.what == "cost" and not parsed.against:
        parser.error("cost needs --against PROGRAM")
    globals()[parsed.what](Runs(parsed.program, parsed.output / "runs", parsed.jobs, parsed.limit), parsed)


if __name__ == "__main__":
    main()
