#!/usr/bin/python3
"""Solvers of the linear systems, each chosen by keys of the deck: iterations, seconds and agreement of the choices.

    tests/benchmark/solvers.py krylov        # three Krylov solvers under three preconditioners
    tests/benchmark/solvers.py eliminations  # which unknowns of the coupled system are eliminated

Prints a table: mean iterations per velocity solve and per implicit step, seconds in these systems, processor seconds,
and the largest difference of all series from the first choice, as compare.py takes it.

The scenes of `eliminations` make a few steps of fixed size with `Solvers/tolerance` 1e-12, so that the choices differ
only by the solution of the linear systems. The steps are small, because the frozen operators also enter the estimated
error that TR-BDF2 subtracts (4.30). Walls are coarse, because blocks without a preconditioner and iterated walls take
minutes on finer ones.
"""

from compare import differences_of
from package import RATIO, SIDE, answer, command_line, studies, table

EXPLICIT = {"Time/scheme": "bs3"}  # no Jacobian, from which the iterated wall is missing
MANY = {"Solvers/velocity/Belos/Maximum Iterations": 600}  # without a preconditioner
FIVE = {RATIO: 5, SIDE: 6}
SMALL = {"Solvers/tolerance": 1e-12, "Time/fixed step": 5e-4, "Time/final time": 2.5e-3, "Output/interval": 1e-3,
         "Time/iteration tolerance": 1e-12, "Time/newton tolerance": 1e-10, "Time/newton iterations": 30}
COARSE = {RATIO: 5, SIDE: 4, "Tube/azimuthal elements": 8, "Tube/axial elements": 12}
BENT = {RATIO: 5, SIDE: 3, "Channel/azimuthal elements": 8, "Time/final time": 1e-3}
TUBE = [{"Solvers/tube": form} | (MANY if form == "block" else {})
        for form in ("schur", "block triangular", "block diagonal", "block")]
LAYER = [{"Solvers/double layer": form} for form in ("assembled", "matrix-free")]
FROZEN = [{"Solvers/frozen operator": "assembled"}]


def krylov(system, preconditioners):
    """Returns the choices of a preconditioner and a Krylov solver for a system."""
    return [chosen | {f"Solvers/{system}/iterative solver": solver, f"Solvers/{system}/Belos/Maximum Iterations": 2000}
            # without a preconditioner GMRES is not restarted
            | ({f"Solvers/{system}/Belos/Num Blocks": 600} if (solver, *chosen.values()) == ("GMRES", "block") else {})
            for chosen in preconditioners for solver in ("GMRES", "BICGSTAB", "TFQMR")]


def preconditioners(system):
    return [{f"Solvers/{system}/preconditioner": kind} for kind in ("none", "neumann", "recycled")]


# table: {scene: (deck, settings, choices)}; the first choice is what the others are compared with
TABLES = {
    "krylov": {
        "velocity, ratio 5": ("shear_neo_hookean", FIVE | {"Time/final time": 1},
                              krylov("velocity", preconditioners("velocity"))),
        "blocks in a tube, ratio 5": ("capsule_capillary", FIVE | {"Time/final time": 0.5}, krylov("velocity", [
            {"Solvers/tube": form} for form in ("block", "block diagonal", "block triangular")])),
        "implicit step": ("shear_neo_hookean", {SIDE: 6, "Time/final time": 1},
                          krylov("implicit step", preconditioners("implicit step")))},
    "eliminations": {
        "capsule in a tube, ratio 5": ("capsule_in_tube", SMALL | COARSE, TUBE + FROZEN),
        "capsule in a channel, ratio 5": ("capsule_bend", SMALL | BENT | EXPLICIT, [
            {"Solvers/wall": form} for form in ("factored", "iterative")]),
        "capsule in shear, ratio 5": ("shear_neo_hookean", SMALL | FIVE, LAYER + FROZEN),
        "two settling spheres": ("settling_spheres", SMALL, [{**one, "Solvers/velocity/preconditioner": kind}
                                                             for one in LAYER for kind in ("own", "none", "recycled")]),
        "capsule, drop and ball": ("capsule_drop_ball", SMALL, LAYER + FROZEN)},
}


def rows(study, scenes):
    for scene, (deck, settings, choices) in scenes.items():
        first = None
        for choice in choices:
            outcome = study.run(f"inputs/{deck}.yaml", settings | choice)
            words = ", ".join(f"`{key.split('/')[-1]}: {value}`" for key, value in choice.items() if "Belos" not in key)
            if not outcome.done:
                yield [scene, words, outcome.message, "", "", "", ""]
                continue
            run, counts = outcome.run, outcome.counts
            first = first or run
            mean = [counts.get(part, 0) / max(1, counts.get(of, 0)) for part, of in
                    (("velocity_iterations", "velocity_solves"), ("solver_iterations", "linear_solves"))]
            seconds = sum(outcome.phases.get(name, 0.0) for name in ("velocity system", "implicit solve"))
            yield [scene, words, *(f"{one:.1f}" for one in mean), f"{seconds:.2f}", f"{outcome.processor_seconds:.2f}",
                   "–" if run is first else f"{max(differences_of(first, run)[0].values()):.1e}"]


def main():
    parser = command_line(__doc__)
    parser.add_argument("table", choices=TABLES)
    studies.arguments(parser, "results/solvers", limit=None)
    parsed = parser.parse_args()
    table(["scene", "choice", "iterations per velocity", "per implicit step", "seconds in the systems",
           "processor seconds", "differs from the first choice by"], rows(studies.study(parsed), TABLES[parsed.table]))


if __name__ == "__main__":
    answer(main)
