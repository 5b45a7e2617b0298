#!/usr/bin/python3
"""Prints the error that each tolerance but Time/tolerance causes, divided by the tolerance, over ten scenes, as Markdown tables.

    tests/benchmark/other_tolerances.py [quadrature] [solvers] [adaptation] [steady] [periodic] [--jobs 2] [--output DIR]

quadrature, solvers: `Quadrature/tolerance`, `Solvers/tolerance`. The error of the velocity, root mean square over the nodes of the last
snapshot, over rate x R_C. A run with default keys deforms the particle; copies of it go on from the checkpoint by one explicit step of 1e-9,
each with another tolerance, so that all velocities are of one shape. The reference has 1e-9 (integrals; 1e-7 in tubes and lattices, which
take long) or 1e-12 (solver).

adaptation: `Adaptation/surface tolerance`. The largest distance of a node at the end of a run from the surface of a run with a sixteenth of
the tightest tolerance, over R_C.

steady, periodic: `Steady/tolerance`, `Periodic/tolerance`. The error of the nodes of the shape found, root mean square over R_C, against a
tolerance of 1e-11 (Steady) or 1e-7 (Periodic, Time/tolerance 1e-8 in all runs).

Results are kept in DIR and are found again.
"""
import argparse
import pathlib
import shutil
import subprocess
import sys

SOURCE = pathlib.Path(__file__).resolve().parents[2]
import package  # noqa: E402, F401 before the package tanktread
import numpy  # noqa: E402
from scipy.spatial import cKDTree  # noqa: E402

import tanktread  # noqa: E402
import time_tolerance  # noqa: E402

RATIO, SIDE, SHEAR, OBLATE = "Particle/viscosity ratio", "Surface/elements per side", "shear_neo_hookean", "oblate_shear"

DEFORMED = {  # name: (deck, settings); shapes whose velocity is looked at
    "capsule in shear": (SHEAR, {SIDE: 6, "Time/final time": 3}),
    "ratio 5": (SHEAR, {SIDE: 6, RATIO: 5, "Time/final time": 5}),
    "ratio 0.05": (SHEAR, {SIDE: 6, RATIO: 0.05, "Time/final time": 3}),
    "ratio 50": (SHEAR, {SIDE: 6, RATIO: 50, "Time/final time": 3}),
    "red cell, bending, ratio 5": ("shear_bending", {"Particle/shape": "red cell", RATIO: 5, "Membrane/law": "Skalak", "Time/final time": 2}),
    "drop in extension, ratio 5": ("drop_uniaxial", {SIDE: 6, RATIO: 5, "Time/final time": 3}),
    "viscous membrane": ("viscous_membrane", {"Time/final time": 3}),
    "adaptive mesh, ratio 0.2": ("hyperbolic_skalak", {RATIO: 0.2, "Time/final time": 5}),
    "capsule in tube, ratio 5": ("capsule_in_tube", {SIDE: 4, RATIO: 5, "Time/final time": 1}),
    "lattice, ratio 5": ("sheared_lattice", {"Particles/capsule/viscosity ratio": 5, "Time/final time": 2}),
    "next to a wall, ratio 10": ("capsule_lifted_from_wall", {RATIO: 10, "Time/final time": 2}),
    "two capsules, ratio 5": ("capsule_pair", {"Particles/defaults/viscosity ratio": 5, "Particles/defaults/Surface/elements per side": 4,
                                               "Particles/first/center": [-1.5, 0, 0.25], "Particles/second/center": [1.5, 0, -0.25],
                                               "Time/final time": 4}),
}
ADAPT = {"Adaptation/enabled": True, "Quadrature/tolerance": 1e-5, "Time/tolerance": 1e-5}
ADAPTED = {
    "Skalak, planar hyperbolic": ("hyperbolic_skalak", {"Time/final time": 6}),
    "the same, Ca = 0.45": ("hyperbolic_skalak_ca0.45", {"Time/final time": 6}),
    "the same, ratio 5": ("hyperbolic_skalak", {RATIO: 5, "Time/final time": 6}),
    "drop, four-roll mill": ("drop_four_roll", {"Time/final time": 3}),
    "drop, extension": ("drop_uniaxial", {SIDE: 6, "Membrane/capillary number": 0.11, "Time/final time": 5}),
    "drop, extension, ratio 5": ("drop_uniaxial", {SIDE: 6, "Membrane/capillary number": 0.1, RATIO: 5, "Time/final time": 5}),
    "capsule in shear": (SHEAR, {SIDE: 6, "Membrane/capillary number": 0.6, "Time/final time": 5}),
    "Skalak, shear": (SHEAR, {SIDE: 6, "Membrane/law": "Skalak", "Membrane/capillary number": 1, "Time/final time": 5}),
    "oblate, shear": ("oblate_shear", {SIDE: 6, "Time/final time": 3}),
    "red cell, bending": ("shear_bending", {"Particle/shape": "red cell", "Membrane/law": "Skalak", SIDE: 6, "Time/final time": 2}),
}
STEADY = {
    "drop, extension": ("drop_steady", {SIDE: 6}),
    "the same, near the fold": ("drop_steady", {SIDE: 6, "Membrane/capillary number": 0.119}),
    "the same, ratio 0.1": ("drop_steady", {SIDE: 6, RATIO: 0.1, "Membrane/capillary number": 0.05}),
    "the same, ratio 10": ("drop_steady", {SIDE: 6, RATIO: 10, "Membrane/capillary number": 0.08}),
    "drop, shear": ("drop_steady", {SIDE: 6, "Flow/type": "simple shear", "Membrane/capillary number": 0.2}),
    "drop, shear, ratio 5": ("drop_steady", {SIDE: 6, "Flow/type": "simple shear", RATIO: 5, "Membrane/capillary number": 0.2}),
    "Skalak, extension": ("capsule_steady", {SIDE: 6}),
    "Skalak, extension, ratio 5": ("capsule_steady", {SIDE: 6, RATIO: 5, "Membrane/capillary number": 0.3}),
    "Skalak, planar hyperbolic": ("capsule_steady", {SIDE: 6, "Flow/type": "planar hyperbolic", "Membrane/capillary number": 0.3}),
    "neo-Hookean, extension": ("uniaxial_extension", {"Steady/tolerance": 1e-8, SIDE: 6}),
}
PERIODIC = {
    "oblate, Ca = 0.6": (OBLATE, {}),
    "ratio 0.2": (OBLATE, {RATIO: 0.2}),
    "ratio 3": (OBLATE, {RATIO: 3}),
    "ratio 5": (OBLATE, {RATIO: 5}),
    "ratio 8": (OBLATE, {RATIO: 8}),
    "ratio 15": (OBLATE, {RATIO: 15}),
    "ratio 8, Ca = 0.3": (OBLATE, {RATIO: 8, "Membrane/capillary number": 0.3}),
    "ratio 5, flatter": (OBLATE, {RATIO: 5, "Particle/semi-axes": [1.2, 1.2, 0.7]}),
    "ratio 8, resists area": (OBLATE, {RATIO: 8, "Membrane/area dilatation": 10}),
    "ratio 5, bending": (OBLATE, {RATIO: 5, "Membrane/bending modulus": 0.02}),
}


class Runs:
    def __init__(self, arguments):
        self.study = tanktread.Study(arguments.program, arguments.output, arguments.limit, arguments.jobs)

    def run(self, scene, settings):
        deck, own = scene
        outcome = self.study.run(SOURCE / "inputs" / f"{deck}.yaml", own | settings)
        if outcome.done:
            return outcome
        print(f"{outcome.directory}: {outcome.message}", file=sys.stderr)
        return None

    def velocity(self, base, name, settings):
        """Returns the nodes' velocities of the shape that a run ended with, found with other settings, over rate x R_C."""
        copy = base.directory.parent / "resumed" / f"{base.directory.name}_{name}"
        if not (copy / "done").exists():
            shutil.rmtree(copy, ignore_errors=True)
            shutil.copytree(base.directory, copy)
            step = 1e-9 / abs(base.run.rate[0]) if base.run.rate[1] else 1e-9
            settings = {"Time/final time": base.end + step, "Time/fixed step": step, "Time/scheme": "bs3", "Time/steady tolerance": 1e-30} | settings
            words = [word for key, value in settings.items() for word in ("--set", f"{key}={tanktread.text_of(value)}")]
            done = subprocess.run([self.study.program, "--resume", copy, "--no-expect", "--quiet", *words], capture_output=True, text=True, check=False)
            if done.returncode:
                print(f"{copy}: {done.stderr.strip()}", file=sys.stderr)
                return None
            (copy / "done").touch()
        run = tanktread.Run(copy)
        return run.snapshots()[-1].fields["velocity"] / run.scale("velocity")[0]


def mean_size(difference):
    return float(numpy.sqrt(numpy.mean(numpy.sum(difference**2, axis=1))))


def table(first, tolerances, scenes, cells, runs):
    """Prints one row a scene, one column a tolerance; `cells` returns the row's texts."""
    rows = runs.study.map(lambda name: [name, *cells(scenes[name])], list(scenes))
    time_tolerance.table([first, *(numpy.format_float_scientific(one, trim="-", exp_digits=1) for one in tolerances)], rows)
    print()


def ratio(error, tolerance):
    return "" if error is None else f"{error / tolerance:.1g}" if error < tolerance else f"{error / tolerance:.1f}"


def of_velocity(runs, key, tolerances, reference, scenes):
    def cells(scene):
        base = runs.run(scene, {"Output/interval": 1e3})
        if base is None:
            return [""] * len(tolerances)
        heavy = key.startswith("Q") and scene[0] in ("capsule_in_tube", "sheared_lattice")
        exact = runs.velocity(base, f"{key[0]}_exact", {key: 1e-7 if heavy else reference})
        found = [runs.velocity(base, f"{key[0]}_{one:g}", {key: one}) for one in tolerances]
        return [ratio(None if one is None or exact is None else mean_size(one - exact), tolerance) for one, tolerance in zip(found, tolerances)]

    table(f"error/`{key}` at", tolerances, scenes, cells, runs)


def quadrature(runs):
    of_velocity(runs, "Quadrature/tolerance", [1e-2, 1e-3, 1e-4, 1e-5], 1e-9, DEFORMED)


def solvers(runs):
    without = ("capsule in shear", "adaptive mesh, ratio 0.2")  # no linear system; one that the checkpoint holds the solution of
    of_velocity(runs, "Solvers/tolerance", [1e-3, 1e-4, 1e-6, 1e-8], 1e-12, {name: one for name, one in DEFORMED.items() if name not in without})


def distance(one, other):
    """Returns the largest distance of the nodes of one snapshot from the surface of another: to tangent planes of a fine grid on each cell."""
    grid = other.sampled(other.points, 32)
    cells = numpy.repeat(numpy.arange(len(other.cells)), 33 * 33)
    t, s = (numpy.tile(axis.ravel(), len(other.cells)) for axis in numpy.meshgrid(numpy.linspace(0, 1, 33), numpy.linspace(0, 1, 33), indexing="ij"))
    nearest = cKDTree(grid.reshape(-1, 3)).query(one.points)[1]
    at = cells[nearest], s[nearest], t[nearest]
    normal = numpy.cross(other.evaluate(other.points, *at, ds=1), other.evaluate(other.points, *at, dt=1))
    normal /= numpy.linalg.norm(normal, axis=1)[:, None]
    return float(abs(numpy.sum((one.points - other.evaluate(other.points, *at)) * normal, axis=1)).max())


def adaptation(runs):
    key, tolerances = "Adaptation/surface tolerance", [1.6e-3, 4e-4, 1e-4]

    def cells(scene):
        deck, own = scene
        scene = deck, ADAPT | own | {"Output/interval": 1e3}
        found = [runs.run(scene, {key: one}) for one in (*tolerances, tolerances[-1] / 16)]
        if None in found:
            return [""] * len(tolerances)
        ends = [one.run.snapshots()[-1] for one in found]
        points = [int(one.series["n_control_points"][-1]) for one in found]
        return [f"{ratio(distance(end, ends[-1]) / found[-1].run.radius, one)} ({n})" for end, one, n in zip(ends, tolerances, points)]

    table(f"error/`{key}` (control points) at", tolerances, ADAPTED, cells, runs)


def of_shape(runs, key, tolerances, reference, scenes, also):
    def cells(scene):
        deck, own = scene
        found = [runs.run((deck, also | own), {key: one}) for one in (*tolerances, reference)]
        if found[-1] is None:
            return [""] * len(tolerances)
        exact = found[-1].run.snapshots()[-1].points
        return ["" if one is None else f"{ratio(mean_size(one.run.snapshots()[-1].points - exact) / one.run.radius, tolerance)} ({one.final['iterations']:g})"
                for one, tolerance in zip(found, tolerances)]

    table(f"error/`{key}` (iterations of NOX) at", tolerances, scenes, cells, runs)


def steady(runs):
    of_shape(runs, "Steady/tolerance", [1e-4, 1e-6, 1e-8], 1e-11, STEADY, {"Solvers/tolerance": 1e-12})


def periodic(runs):
    of_shape(runs, "Periodic/tolerance", [1e-3, 1e-4, 1e-5], 1e-7, PERIODIC,
             {"Periodic/period": 9.1, "Periodic/turn": 180, SIDE: 4, "Time/tolerance": 1e-8, "Time/steady tolerance": 1e-30})


def main():
    tables = {one.__name__: one for one in (quadrature, solvers, adaptation, steady, periodic)}
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tables", nargs="*", choices=[[], *tables], help="(default: all)")
    parser.add_argument("--program", type=pathlib.Path, help="(default: that of the release build)")
    parser.add_argument("--jobs", type=int, default=2, help="runs at a time (default: %(default)s)")
    parser.add_argument("--output", default="results/other_tolerances", metavar="DIR", help="directory of the results (default: %(default)s)")
    parser.add_argument("--limit", type=float, default=1800, metavar="SECONDS", help="processor time of a run (default: %(default)s)")
    arguments = parser.parse_args()
    for name in arguments.tables or tables:
        tables[name](Runs(arguments))


if __name__ == "__main__":
    main()
