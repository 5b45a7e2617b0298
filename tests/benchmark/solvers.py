#!/usr/bin/python3
"""Compares the solvers of the linear systems: iterations, computing time, and agreement of their results.

    tests/benchmark/solvers.py krylov        # three Krylov solvers under three preconditioners
    tests/benchmark/solvers.py eliminations  # which unknowns of the coupled system are eliminated

Prints a table: mean iterations per velocity solve and per implicit step, seconds in these systems, processor seconds,
and the largest difference of all series from the first choice, computed as in compare.py.

The scenes of `eliminations` make a few steps of fixed size with `Solvers/tolerance` 1e-12, so that the choices differ
only by the solution of the linear systems. The steps are small, because the frozen operators also enter the estimated
error that TR-BDF2 subtracts, see (4.30) in lib/README.md. Walls are coarse, because blocks without a preconditioner and
iterated walls take minutes on finer ones.
"""

from compare import differences_of
from package import answer, command_line, scenes_of, studies, table

TABLES = scenes_of(__file__)


def krylov(system, choices):
    """Returns the choices of a preconditioner and a Krylov solver for a system."""
    return [chosen | {f"Solvers/{system}/iterative solver": solver, f"Solvers/{system}/Belos/Maximum Iterations": 2000}
            # without a preconditioner GMRES is not restarted
            | ({f"Solvers/{system}/Belos/Num Blocks": 600} if (solver, *chosen.values()) == ("GMRES", "block") else {})
            for chosen in choices for solver in ("GMRES", "BICGSTAB", "TFQMR")]


def rows(study, scenes):
    for scene, given in scenes.items():
        choices, first = given["choices"], None
        for choice in krylov(given["krylov"], choices) if "krylov" in given else choices:
            outcome = study.run(f"inputs/{given['deck']}.yaml", given["settings"] | choice)
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
    parser.add_argument("table", choices=("krylov", "eliminations"))
    studies.arguments(parser, "results/solvers", limit=None)
    parsed = parser.parse_args()
    table(["scene", "choice", "iterations per velocity", "per implicit step", "seconds in the systems",
           "processor seconds", "differs from the first choice by"], rows(studies.study(parsed), TABLES[parsed.table]))


if __name__ == "__main__":
    answer(main)
