#!/usr/bin/python3
"""Finds the mesh and the tolerances with which a requested accuracy costs least, for several scenes or for your own
deck. It makes the table of inputs/manual/accuracy/index.md.

    tests/benchmark/accuracy.py                      # a quarter of an hour; runs are kept under results/accuracy
    tests/benchmark/accuracy.py --scene shear tube   # only these scenes
    tests/benchmark/accuracy.py --deck mine.yaml --series inclination --mesh 'Surface/elements per side' 3 4 6

Every scene runs on several meshes with loose, default and tight tolerances. For each requested error, the run with the
fewest kernel evaluations is printed. The error of a run is the largest difference of the series from a finer run,
divided by the largest value of the series. The number of kernel evaluations is the same on every machine. The computing
time on one core is divided by that of the first deck (inputs/shear_neo_hookean.yaml).
"""

import itertools

from package import SHEAR, SIDE, answer, choice_of, command_line, expect, numpy, scenes_of, studies, table, tanktread
from tanktread.interpolation import difference

DEMANDS = [1e-2, 1e-3, 1e-4]
# Time/tolerance and Quadrature/tolerance
TOLERANCES = [(1e-3, 1e-3), (3e-4, 3e-4), (1e-4, 1e-4), (2e-5, 1e-5), (4e-6, 1e-5)]
SCENES = scenes_of(__file__)


def main():
    parser = command_line(__doc__)
    choice_of(parser, SCENES)
    parser.add_argument("--deck", help="your own deck, used instead of the scenes")
    parser.add_argument("--series", default="taylor_inertia", help="series of that deck (default: %(default)s)")
    parser.add_argument("--mesh", nargs="+", default=[SIDE, "3", "4", "6", "8"], metavar="WORD",
                        help="key of the mesh of that deck and its values, coarse to fine; the reference run has 1.5 "
                             "times the last value (default: %(default)s)")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE",
                        help="sets another key of that deck (repeatable)")
    studies.arguments(parser, "results/accuracy")
    parsed = parser.parse_args()
    study = studies.study(parsed)
    scenes = {"deck": scene_of(parsed)} if parsed.deck else {name: SCENES[name] for name in parsed.scene}
    unit = study.run(SHEAR, {"Output/interval": 0.75}).processor_seconds
    rows = []

    def lines():
        for name, scene in scenes.items():
            found = list(runs(study, scene))
            expect(found, f"no run of {scene['deck']} came to its end")
            rows.extend((name, *one) for one in found)
            for demand in DEMANDS:
                good = [one for one in found if one[3] <= demand]
                *choice, error, kernels, seconds = min(good or found, key=lambda one: one[4 if good else 3])
                met = f"{demand:g}" if good else f"{demand:g}: not met, {error:.1e}"
                yield [scene["title"], met, *choice, float(kernels), seconds / unit]

    table(["scene", "error", "mesh", "`Time/tolerance`", "`Quadrature/tolerance`", "kernel evaluations",
           "seconds / first deck's"], lines())
    studies.write_table(parsed.output / "accuracy.csv", [
        "scene", "mesh", "time", "quadrature", "error", "kernel_evaluations", "seconds"], rows)


def scene_of(parsed):
    """Returns the scene of a user's deck."""
    key, *values = parsed.mesh
    expect(len(values) > 1 and all(value.isdigit() for value in values),
           "--mesh needs a key and two or more whole numbers")
    name = key.rsplit("/", 1)[-1]
    return {"title": parsed.deck, "deck": parsed.deck, "base": tanktread.runs.settings_of(parsed.set),
            "series": parsed.series, "reference": {key: int(1.5 * int(values[-1]))},
            "meshes": {f"{name} = {value}": {key: int(value)} for value in values}}


def runs(study, scene):
    """Yields mesh, two tolerances, relative error, kernel evaluations and seconds of every run that came to its end.
    The error is the largest one over the run against a finer run, or at the end against the value that the deck
    expects."""
    def run(mesh, time, quadrature):
        tolerances = {"Time/tolerance": time, "Quadrature/tolerance": quadrature}
        return study.run(scene["deck"], scene["base"] | tolerances | mesh)

    def error_of(one):
        values = one.series[series]
        if not scene["reference"]:
            return abs(values[-1] / one.run.value(f"Expect/{series}/value") - 1)
        true = finer.series[series]
        return difference(one.series["time"], values, finer.series["time"], true) / numpy.nanmax(abs(true))

    series = scene["series"]
    if scene["reference"]:
        finer = run(scene["reference"], 5e-6, 1e-6)
        expect(finer.done, f"the reference did not come to its end: {finer.message}")
    for (name, mesh), tolerances in itertools.product(scene["meshes"].items(), TOLERANCES):
        one = run(mesh, *tolerances)
        if one.done:
            yield name, *tolerances, error_of(one), one.kernel_evaluations, one.processor_seconds


if __name__ == "__main__":
    answer(main)
