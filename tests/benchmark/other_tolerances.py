#!/usr/bin/python3
"""Prints the error that each tolerance but Time/tolerance causes, divided by the tolerance, as Markdown tables.

    tests/benchmark/other_tolerances.py [quadrature] [solvers] [adaptation] [steady] [periodic]

quadrature, solvers: `Quadrature/tolerance`, `Solvers/tolerance`. The error of the velocity, root mean square over the
nodes of the last snapshot, over rate x R_C. A run with default keys deforms the particle; copies of it go on from the
checkpoint by one explicit step of 1e-9, each with another tolerance, so that all velocities are of one shape. The
reference has 1e-9 (integrals; 1e-7 in tubes and lattices, which take long) or 1e-12 (solver).

adaptation: `Adaptation/surface tolerance`. The largest distance of a node at the end of a run from the surface of a run
with a sixteenth of the tightest tolerance, over R_C.

steady, periodic: `Steady/tolerance`, `Periodic/tolerance`. The error of the nodes of the shape found, root mean square
over R_C, against a tolerance of 1e-11 (Steady) or 1e-7 (Periodic, Time/tolerance 1e-8 in all runs).
"""

import pathlib
import shutil
import subprocess
import sys

from package import RATIO, SIDE, answer, command_line, numpy, studies, table, tanktread
import scipy.spatial

SHEAR, OBLATE, CA = "shear_neo_hookean", "oblate_shear", "Membrane/capillary number"
RED_CELL = {"Particle/shape": "red cell", "Membrane/law": "Skalak", "Time/final time": 2}


def until(end, ratio=None, **more):
    """Returns settings with a final time and a viscosity ratio."""
    return {"Time/final time": end} | ({RATIO: ratio} if ratio else {}) | more


SIX = {SIDE: 6}
DEFORMED = {  # name: (deck, settings); shapes whose velocity is looked at
    "capsule in shear": (SHEAR, until(3, **SIX)),
    "ratio 5": (SHEAR, until(5, 5, **SIX)),
    "ratio 0.05": (SHEAR, until(3, 0.05, **SIX)),
    "ratio 50": (SHEAR, until(3, 50, **SIX)),
    "red cell, bending, ratio 5": ("shear_bending", RED_CELL | {RATIO: 5}),
    "drop in extension, ratio 5": ("drop_uniaxial", until(3, 5, **SIX)),
    "viscous membrane": ("viscous_membrane", until(3)),
    "adaptive mesh, ratio 0.2": ("hyperbolic_skalak", until(5, 0.2)),
    "capsule in tube, ratio 5": ("capsule_in_tube", until(1, 5, **{SIDE: 4})),
    "lattice, ratio 5": ("sheared_lattice", until(2, **{"Particles/capsule/viscosity ratio": 5})),
    "next to a wall, ratio 10": ("capsule_lifted_from_wall", until(2, 10)),
    "two capsules, ratio 5": ("capsule_pair", until(4, **{
        "Particles/defaults/viscosity ratio": 5, "Particles/defaults/Surface/elements per side": 4,
        "Particles/first/center": [-1.5, 0, 0.25], "Particles/second/center": [1.5, 0, -0.25]})),
}
ADAPT = {"Adaptation/enabled": True, "Quadrature/tolerance": 1e-5, "Time/tolerance": 1e-5, "Output/interval": 1e3}
ADAPTED = {
    "Skalak, planar hyperbolic": ("hyperbolic_skalak", until(6)),
    "the same, Ca = 0.45": ("hyperbolic_skalak_ca0.45", until(6)),
    "the same, ratio 5": ("hyperbolic_skalak", until(6, 5)),
    "drop, four-roll mill": ("drop_four_roll", until(3)),
    "drop, extension": ("drop_uniaxial", until(5, **SIX | {CA: 0.11})),
    "drop, extension, ratio 5": ("drop_uniaxial", until(5, 5, **SIX | {CA: 0.1})),
    "capsule in shear": (SHEAR, until(5, **SIX | {CA: 0.6})),
    "Skalak, shear": (SHEAR, until(5, **SIX | {"Membrane/law": "Skalak", CA: 1})),
    "oblate, shear": (OBLATE, until(3, **SIX)),
    "red cell, bending": ("shear_bending", RED_CELL | SIX),
}
SHEARED = SIX | {"Flow/type": "simple shear", CA: 0.2}
STEADY = {
    "drop, extension": ("drop_steady", SIX),
    "the same, near the fold": ("drop_steady", SIX | {CA: 0.119}),
    "the same, ratio 0.1": ("drop_steady", SIX | {RATIO: 0.1, CA: 0.05}),
    "the same, ratio 10": ("drop_steady", SIX | {RATIO: 10, CA: 0.08}),
    "drop, shear": ("drop_steady", SHEARED),
    "drop, shear, ratio 5": ("drop_steady", SHEARED | {RATIO: 5}),
    "Skalak, extension": ("capsule_steady", SIX),
    "Skalak, extension, ratio 5": ("capsule_steady", SIX | {RATIO: 5, CA: 0.3}),
    "Skalak, planar hyperbolic": ("capsule_steady", SIX | {"Flow/type": "planar hyperbolic", CA: 0.3}),
    "neo-Hookean, extension": ("uniaxial_extension", SIX | {"Steady/tolerance": 1e-8}),
}
PERIODIC = {"oblate, Ca = 0.6": (OBLATE, {})} | {
    f"ratio {ratio:g}": (OBLATE, {RATIO: ratio}) for ratio in (0.2, 3, 5, 8, 15)} | {
    "ratio 8, Ca = 0.3": (OBLATE, {RATIO: 8, CA: 0.3}),
    "ratio 5, flatter": (OBLATE, {RATIO: 5, "Particle/semi-axes": [1.2, 1.2, 0.7]}),
    "ratio 8, resists area": (OBLATE, {RATIO: 8, "Membrane/area dilatation": 10}),
    "ratio 5, bending": (OBLATE, {RATIO: 5, "Membrane/bending modulus": 0.02}),
}


def run(study, scene, settings):
    """Returns the outcome of a run, or None if it did not come to its end, which is printed."""
    outcome = study.run(f"inputs/{scene[0]}.yaml", scene[1] | settings)
    if not outcome.done:
        print(f"{outcome.directory}: {outcome.message}", file=sys.stderr)
    return outcome if outcome.done else None


def velocity(study, base, name, settings):
    """Returns the nodes' velocities of the shape that a run ended with, with other settings, over rate x R_C."""
    copy = base.directory.parent / "resumed" / f"{base.directory.name}_{name}"
    if not (copy / "done").exists():
        shutil.rmtree(copy, ignore_errors=True)
        shutil.copytree(base.directory, copy)
        step = 1e-9 / abs(base.run.rate[0]) if base.run.rate[1] else 1e-9
        settings = {"Time/final time": base.end + step, "Time/fixed step": step, "Time/scheme": "bs3",
                    "Time/steady tolerance": 1e-30} | settings
        words = [word for key, value in settings.items() for word in ("--set", f"{key}={tanktread.text_of(value)}")]
        done = subprocess.run([study.program, "--resume", copy, "--no-expect", "--quiet", *words], capture_output=True,
                              text=True, check=False)
        if done.returncode:
            print(f"{copy}: {done.stderr.strip()}", file=sys.stderr)
            return None
        (copy / "done").touch()
    found = tanktread.Run(copy)
    return found.snapshots()[-1].fields["velocity"] / found.scale("velocity")[0]


def size(difference):
    """Returns the root mean square of vectors (n, 3)."""
    return float(numpy.sqrt((difference**2).sum(axis=1).mean()))


def ratio(error, tolerance):
    return f"{error / tolerance:.1g}" if error < tolerance else f"{error / tolerance:.1f}"


def print_errors(study, first, tolerances, scenes, cells):
    """Prints a table of one row a scene and one column a tolerance; `cells` returns a row's texts, or None."""
    rows = study.map(lambda name: [name, *(cells(scenes[name]) or [""] * len(tolerances))], list(scenes))
    table([first, *(numpy.format_float_scientific(one, trim="-", exp_digits=1) for one in tolerances)], rows)
    print()


def of_velocity(study, key, tolerances, reference, scenes):
    def cells(scene):
        base = run(study, scene, {"Output/interval": 1e3})
        if base is None:
            return None
        heavy = key.startswith("Q") and scene[0] in ("capsule_in_tube", "sheared_lattice")
        exact = velocity(study, base, f"{key[0]}_exact", {key: 1e-7 if heavy else reference})
        found = [velocity(study, base, f"{key[0]}_{one:g}", {key: one}) for one in tolerances]
        return ["" if one is None or exact is None else ratio(size(one - exact), tolerance)
                for one, tolerance in zip(found, tolerances)]

    print_errors(study, f"error/`{key}` at", tolerances, scenes, cells)


def quadrature(study):
    of_velocity(study, "Quadrature/tolerance", [1e-2, 1e-3, 1e-4, 1e-5], 1e-9, DEFORMED)


def solvers(study):
    # without a linear system, and with one that the checkpoint holds the solution of
    without = "capsule in shear", "adaptive mesh, ratio 0.2"
    of_velocity(study, "Solvers/tolerance", [1e-3, 1e-4, 1e-6, 1e-8], 1e-12,
                {name: one for name, one in DEFORMED.items() if name not in without})


def distance(one, other, k=32):
    """Returns the largest distance of the nodes of one snapshot from the surface of another: to tangent planes of a
    fine grid on each cell."""
    grid = other.sampled(other.points, k)
    nearest = scipy.spatial.cKDTree(grid.reshape(-1, 3)).query(one.points)[1]
    cell, t, s = numpy.unravel_index(nearest, grid.shape[:3])
    at = cell, s / k, t / k
    normal = numpy.cross(other.evaluate(other.points, *at, ds=1), other.evaluate(other.points, *at, dt=1))
    normal /= numpy.linalg.norm(normal, axis=1)[:, None]
    return float(abs(((one.points - other.evaluate(other.points, *at)) * normal).sum(axis=1)).max())


def adaptation(study):
    key, tolerances = "Adaptation/surface tolerance", [1.6e-3, 4e-4, 1e-4]

    def cells(scene):
        found = [run(study, (scene[0], ADAPT | scene[1]), {key: one}) for one in (*tolerances, tolerances[-1] / 16)]
        if None in found:
            return None
        *ends, last = [one.run.snapshots()[-1] for one in found]
        return [f"{ratio(distance(end, last) / found[-1].run.radius, tolerance)} "
                f"({one.series['n_control_points'][-1]:.0f})" for end, tolerance, one in zip(ends, tolerances, found)]

    print_errors(study, f"error/`{key}` (control points) at", tolerances, ADAPTED, cells)


def of_shape(study, key, tolerances, reference, scenes, also):
    def cells(scene):
        *found, exact = [run(study, (scene[0], also | scene[1]), {key: one}) for one in (*tolerances, reference)]
        if exact is None:
            return None
        points = exact.run.snapshots()[-1].points
        return ["" if one is None else f"{ratio(size(one.run.snapshots()[-1].points - points) / one.run.radius, each)} "
                f"({one.final['iterations']:g})" for one, each in zip(found, tolerances)]

    print_errors(study, f"error/`{key}` (iterations of NOX) at", tolerances, scenes, cells)


def steady(study):
    of_shape(study, "Steady/tolerance", [1e-4, 1e-6, 1e-8], 1e-11, STEADY, {"Solvers/tolerance": 1e-12})


def periodic(study):
    of_shape(study, "Periodic/tolerance", [1e-3, 1e-4, 1e-5], 1e-7, PERIODIC, {
        "Periodic/period": 9.1, "Periodic/turn": 180, SIDE: 4, "Time/tolerance": 1e-8, "Time/steady tolerance": 1e-30})


def main():
    tables = {one.__name__: one for one in (quadrature, solvers, adaptation, steady, periodic)}
    parser = command_line(__doc__)
    parser.add_argument("tables", nargs="*", choices=[[], *tables], help="(default: all)")
    parser.add_argument("--jobs", type=int, default=2, help="runs at a time (default: %(default)s)")
    studies.arguments(parser, pathlib.Path("results/other_tolerances"))
    parser.set_defaults(limit=1800)
    parsed = parser.parse_args()
    for name in parsed.tables or tables:
        tables[name](studies.study(parsed, parsed.jobs))


if __name__ == "__main__":
    answer(main)
