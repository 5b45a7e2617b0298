#!/usr/bin/python3
"""Shapes at rest by Newton's method: three Krylov solvers, three preconditioners and two line searches, each chosen by the deck alone.

    tests/benchmark/steady_solvers.py build/release/app/tanktread

Prints a table: velocity evaluations to the shape at rest, or `-` where that was not found, and last those of Anderson's method.
"""
import itertools
import pathlib
import sys
import tempfile

import yaml

from solvers import INPUTS, run

KRYLOV = ["GMRES", "BICGSTAB", "TFQMR"]
PRECONDITIONERS = ["none", "own", "recycled"]
SEARCHES = ["Full Step", "Backtrack"]
SCENES = ["drop_steady", "capsule_steady"]
SETTINGS = ["Surface/elements per side=6", "Quadrature/tolerance=1e-7", "Steady/iterations=40"]


def evaluations(program, scene, settings):
    """Of the shape alone, without its spectrum."""
    deck = yaml.safe_load((INPUTS / f"{scene}.yaml").read_text())
    for section in "Spectrum", "Expect":
        deck["Tanktread"].pop(section)
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "deck.yaml"
        path.write_text(yaml.safe_dump(deck))
        counts, _ = run(program, path, SETTINGS + settings)
    return str(counts["evaluations"]) if counts else "-"


def main():
    program = sys.argv[1]
    print("| scene | preconditioner | line search | " + " | ".join(KRYLOV) + " |\n|---|---|---|" + "---|" * len(KRYLOV))
    for name, preconditioner, search in itertools.product(SCENES, PRECONDITIONERS, SEARCHES):
        newton = ["Steady/method=newton-krylov", f"Solvers/steady/preconditioner={preconditioner}", f"Solvers/NOX/Line Search/Method={search}"]
        row = [evaluations(program, name, newton + [f"Solvers/steady/iterative solver={krylov}"]) for krylov in KRYLOV]
        print(f"| {name} | `{preconditioner}` | {search} | " + " | ".join(row) + " |", flush=True)
    for name in SCENES:
        print(f"| {name} | Anderson's method | | {evaluations(program, name, ['Steady/method=anderson'])} | | |", flush=True)


if __name__ == "__main__":
    main()
