#!/usr/bin/python3
"""Shapes at rest by Newton's method: three Krylov solvers, three preconditioners and two line searches, each chosen by the deck alone.

    tests/benchmark/steady_solvers.py build/release/app/tanktread

Prints a table: velocity evaluations to the shape at rest, or `-` where that was not found, and last those of Anderson's method.
"""
import itertools
import sys

from solvers import INPUTS, run

KRYLOV = ["GMRES", "BICGSTAB", "TFQMR"]
PRECONDITIONERS = ["none", "own", "recycled"]
SEARCHES = ["Full Step", "Backtrack"]
SCENES = [(name, INPUTS / f"{name}_steady.yaml") for name in ("drop", "capsule")]
SETTINGS = ["Surface/elements per side=6", "Spectrum/number=1", "Quadrature/tolerance=1e-7", "Steady/iterations=40"]


def evaluations(program, deck, settings):
    counts, _ = run(program, deck, SETTINGS + settings)
    return str(counts["evaluations"]) if counts else "-"


def main():
    program = sys.argv[1]
    print("| scene | preconditioner | line search | " + " | ".join(KRYLOV) + " |\n|---|---|---|" + "---|" * len(KRYLOV))
    for (name, deck), preconditioner, search in itertools.product(SCENES, PRECONDITIONERS, SEARCHES):
        newton = ["Steady/method=newton-krylov", f"Solvers/steady/preconditioner={preconditioner}", f"Solvers/NOX/Line Search/Method={search}"]
        row = [evaluations(program, deck, newton + [f"Solvers/steady/iterative solver={krylov}"]) for krylov in KRYLOV]
        print(f"| {name} | `{preconditioner}` | {search} | " + " | ".join(row) + " |", flush=True)
    for name, deck in SCENES:
        print(f"| {name} | Anderson | | {evaluations(program, deck, ['Steady/method=anderson'])} | | |", flush=True)


if __name__ == "__main__":
    main()
