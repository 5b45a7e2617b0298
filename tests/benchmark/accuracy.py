#!/usr/bin/python3
"""Which mesh and tolerances an accuracy takes, and what it costs: the table of inputs/ACCURACY.md, scene by scene.

    tests/benchmark/accuracy.py                      # a quarter of an hour; runs are kept under results/accuracy
    tests/benchmark/accuracy.py --scene shear tube   # these

Every scene runs on several meshes with loose, default and tight tolerances; of those that meet a demand, the one with the fewest kernel evaluations is told.
Kernel evaluations are the same on every machine; seconds of one core are told as multiples of those that the first deck takes, run beside them.
"""

import argparse

import package  # noqa: F401 before the package tanktread
import numpy

from tanktread import interpolation
from tanktread.studies import common as studies
from tanktread.mistakes import answer

DEMANDS = [1e-2, 1e-3, 1e-4]
TOLERANCES = [(1e-3, 1e-3), (3e-4, 3e-4), (1e-4, 1e-4), (2e-5, 1e-5), (4e-6, 1e-5)]  # Time/tolerance and Quadrature/tolerance


def _side(n):
    return {"Surface/elements per side": n}


def _refined(n, tolerance):
    return _side(n) | {"Adaptation/surface tolerance": tolerance}


MESHES = [(f"n = {n}", _side(n)) for n in (3, 4, 6, 8, 10)]
FIRST = "inputs/shear_neo_hookean.yaml"
# name: title, deck, settings of all runs, series, settings of the reference run or its value at the end, meshes
SCENES = {
    "shear": ("capsule in shear, Ca = 0.3, to 7.5", FIRST, {}, "taylor_inertia", _side(14), MESHES),
    "ratio": ("the same, viscosity ratio 5", FIRST, {"Particle/viscosity ratio": 5.0}, "taylor_inertia", _side(12), MESHES),
    "refined": ("Skalak capsule drawn out, Ca = 0.6, mesh refined", "inputs/hyperbolic_skalak.yaml", {}, "taylor_inertia", _refined(10, 4e-5),
                [(f"n = {n}, surface tolerance {tolerance:g}", _refined(n, tolerance)) for n, tolerance in
                 ((4, 1.6e-3), (4, 8e-4), (6, 8e-4), (6, 4e-4), (6, 2e-4), (8, 1e-4))]),
    "drop": ("drop in uniaxial extension", "inputs/drop_uniaxial.yaml", {}, "taylor_inertia", _side(12) | {"Time/tolerance": 1e-6}, MESHES),
    "tube": ("capsule that nearly fills a tube", "inputs/capsule_in_tube.yaml", {}, "velocity_x1", None, MESHES[1:]),
}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scene", nargs="+", default=list(SCENES), choices=SCENES, metavar="NAME", help=f"of {', '.join(SCENES)} (default: all)")
    studies.arguments(parser, "results/accuracy")
    parsed = parser.parse_args()
    study = studies.study(parsed)
    unit = study.run(FIRST, {"Output/interval": 0.75}).processor_seconds
    rows = []
    print("| scene | error | mesh | `Time/tolerance` | `Quadrature/tolerance` | kernel evaluations | seconds over the first deck's |\n|---|---|---|---|---|---|---|")
    for name in parsed.scene:
        found = runs(study, *SCENES[name][1:])
        rows += [(name, mesh, *tolerances, error, one.kernel_evaluations, one.processor_seconds) for mesh, tolerances, one, error in found]
        for demand in DEMANDS:
            good = [entry for entry in found if entry[3] <= demand]
            best = min(good or found, key=lambda entry: entry[2].kernel_evaluations if good else entry[3])
            mesh, (time, quadrature), one, error = best
            met = f"{demand:g}" if good else f"{demand:g}: not met, {error:.1e}"
            print(f"| {SCENES[name][0]} | {met} | {mesh} | {time:g} | {quadrature:g} | {one.kernel_evaluations:.2g} | {one.processor_seconds / unit:.2g} |", flush=True)
    studies.write_table(parsed.output / "accuracy.csv", ["scene", "mesh", "time", "quadrature", "error", "kernel_evaluations", "seconds"], rows)


def settings(base, mesh, tolerances):
    return base | {"Time/tolerance": tolerances[0], "Quadrature/tolerance": tolerances[1]} | mesh


def runs(study, deck, base, series, reference, meshes):
    """Mesh, tolerances, outcome and relative error of every run that came to its end: largest over the run against a finer run, or at the end
    against the value that the deck expects."""
    truth = study.run(deck, settings(base, reference, (5e-6, 1e-6))).series if reference else None
    found = []
    for name, mesh in meshes:
        for tolerances in TOLERANCES:
            one = study.run(deck, settings(base, mesh, tolerances))
            if not one.done:
                continue
            values = one.series[series]
            if truth:
                error = interpolation.difference(one.series["time"], values, truth["time"], truth[series]) / numpy.max(abs(truth[series]))
            else:
                expected = one.run.value(f"Expect/{series}/value")
                error = abs(values[-1] / expected - 1)
            found.append((name, tolerances, one, error))
    return found


if __name__ == "__main__":
    answer(main)
