#!/usr/bin/python3
"""Prints the error caused by each tolerance except Time/tolerance, divided by the tolerance, as Markdown tables.

    tests/benchmark/other_tolerances.py [quadrature] [solvers] [adaptation] [steady] [periodic]

quadrature, solvers: `Quadrature/tolerance` and `Solvers/tolerance`. The error is that of the velocity: root mean square
over the nodes of the last snapshot, divided by rate x R_C. R_C is the radius of the sphere with the particle's volume.
A run with default keys deforms the particle. Copies of this run continue from its checkpoint by one explicit step of
1e-9, each with another tolerance, so that all velocities belong to the same shape. The reference has the tolerance 1e-9
for quadrature (1e-7 in tubes and lattices, which are expensive) and 1e-12 for the solver.

adaptation: `Adaptation/surface tolerance`. The error is the largest distance, divided by R_C, of a node at the end of a
run from the surface of the reference. The reference has 1/16 of the tightest tolerance.

steady, periodic: `Steady/tolerance` and `Periodic/tolerance`. The error is the root mean square over the nodes of the
difference in position from the reference, divided by R_C. The reference has the tolerance 1e-11 (Steady) or 1e-7
(Periodic; Time/tolerance is 1e-8 in all these runs).
"""

import shutil
import subprocess
import sys

from package import SIDE, answer, command_line, numpy, scenes_of, studies, table, tanktread
import scipy.spatial

SCENES = scenes_of(__file__)
ADAPT = {"Adaptation/enabled": True, "Quadrature/tolerance": 1e-5, "Time/tolerance": 1e-5, "Output/interval": 1e3}


def run(study, scene, settings):
    """Returns the outcome of a run. If the run was not completed, prints this and returns None."""
    settings = scene | settings
    outcome = study.run(f"inputs/{settings.pop('deck')}.yaml", settings)
    if not outcome.done:
        print(f"{outcome.directory}: {outcome.message}", file=sys.stderr)
    return outcome if outcome.done else None


def velocity(study, base, name, settings):
    """Returns the velocities of the nodes, divided by rate x R_C, of the final shape of a run, computed with other
    settings."""
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
    """Prints a table with one row per scene and one column per tolerance. cells(scene) returns the texts of a row, or
    None."""
    rows = study.map(lambda name: [name, *(cells(scenes[name]) or [""] * len(tolerances))], list(scenes))
    table([first, *(numpy.format_float_scientific(one, trim="-", exp_digits=1) for one in tolerances)], rows)
    print()


def of_velocity(study, key, tolerances, reference, scenes):
    def cells(scene):
        base = run(study, scene, {"Output/interval": 1e3})
        if base is None:
            return None
        heavy = key.startswith("Q") and scene["deck"] in ("capsule_in_tube", "sheared_lattice")
        exact = velocity(study, base, f"{key[0]}_exact", {key: 1e-7 if heavy else reference})
        found = [velocity(study, base, f"{key[0]}_{one:g}", {key: one}) for one in tolerances]
        return ["" if one is None or exact is None else ratio(size(one - exact), tolerance)
                for one, tolerance in zip(found, tolerances)]

    print_errors(study, f"error/`{key}` at", tolerances, scenes, cells)


def distance(one, other, k=32):
    """Returns the largest distance of the nodes of one snapshot from the surface of another, approximated by tangent
    planes on a fine grid of each cell."""
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
        found = [run(study, ADAPT | scene, {key: one}) for one in (*tolerances, tolerances[-1] / 16)]
        if None in found:
            return None
        *ends, last = [one.run.snapshots()[-1] for one in found]
        return [f"{ratio(distance(end, last) / found[-1].run.radius, tolerance)} "
                f"({one.series['n_control_points'][-1]:.0f})" for end, tolerance, one in zip(ends, tolerances, found)]

    print_errors(study, f"error/`{key}` (control points) at", tolerances, SCENES["adapted"], cells)


def of_shape(study, key, tolerances, reference, scenes, also):
    def cells(scene):
        *found, exact = [run(study, also | scene, {key: one}) for one in (*tolerances, reference)]
        if exact is None:
            return None
        points = exact.run.snapshots()[-1].points
        return ["" if one is None else f"{ratio(size(one.run.snapshots()[-1].points - points) / one.run.radius, each)} "
                f"({one.final['iterations']:g})" for one, each in zip(found, tolerances)]

    print_errors(study, f"error/`{key}` (iterations of NOX) at", tolerances, scenes, cells)


# scenes without a linear system for the velocity, and scenes whose checkpoint contains the solution of this system
WITHOUT = "capsule in shear", "adaptive mesh, ratio 0.2"
TABLES = {  # {name: (function, arguments)}
    "quadrature": (of_velocity, "Quadrature/tolerance", [1e-2, 1e-3, 1e-4, 1e-5], 1e-9, SCENES["deformed"]),
    "solvers": (of_velocity, "Solvers/tolerance", [1e-3, 1e-4, 1e-6, 1e-8], 1e-12,
                {name: one for name, one in SCENES["deformed"].items() if name not in WITHOUT}),
    "adaptation": (adaptation,),
    "steady": (of_shape, "Steady/tolerance", [1e-4, 1e-6, 1e-8], 1e-11, SCENES["steady"], {"Solvers/tolerance": 1e-12}),
    "periodic": (of_shape, "Periodic/tolerance", [1e-3, 1e-4, 1e-5], 1e-7, SCENES["periodic"], {
        "Periodic/period": 9.1, "Periodic/turn": 180, SIDE: 4, "Time/tolerance": 1e-8, "Time/steady tolerance": 1e-30})}


def main():
    parser = command_line(__doc__)
    parser.add_argument("tables", nargs="*", choices=[[], *TABLES], help="tables (default: all)")
    studies.arguments(parser, "results/other_tolerances", limit=1800, jobs=2)
    parsed = parser.parse_args()
    for name in parsed.tables or TABLES:
        print_table, *given = TABLES[name]
        print_table(studies.study(parsed), *given)


if __name__ == "__main__":
    answer(main)
