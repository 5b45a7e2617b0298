#!/usr/bin/python3
"""Iterations of the block system of a capsule in a tube under several solvers and preconditioners, each chosen by the deck alone.

    tests/benchmark/tube_solvers.py build/release/app/tanktread [deck.yaml]

The run is the capillary's first half unit of time, on a coarser mesh; mean and largest number of iterations of a velocity at 1e-8.
"""
import pathlib
import subprocess
import sys
import tempfile

import yaml

LONG = ["Solvers/Belos/Maximum Iterations=2000", "Solvers/Belos/Num Blocks=600"]
CHOICES = [
    ("Schur complement on v", []),
    ("Schur complement on v, BiCGStab", ["Solvers/iterative solver=BICGSTAB"]),
    ("block triangular, factored wall", ["Solvers/tube=block triangular"]),
    ("block triangular, BiCGStab", ["Solvers/tube=block triangular", "Solvers/iterative solver=BICGSTAB"]),
    ("block diagonal, factored wall", ["Solvers/tube=block diagonal"]),
    ("block diagonal, GMRES(10)", ["Solvers/tube=block diagonal", "Solvers/Belos/Num Blocks=10", "Solvers/Belos/Maximum Restarts=100"]),
    ("raw block system", ["Solvers/tube=block", *LONG]),
]


def counts(program, deck, settings, results):
    words = [word for setting in settings for word in ("--set", setting)]
    said = subprocess.run([program, deck, *words, "--output", results, "--overwrite", "--quiet"], capture_output=True, text=True)
    if said.returncode not in (0, 1):
        return None, said.stderr.strip()
    summary = yaml.safe_load((pathlib.Path(results) / "summary.yaml").read_text())
    return summary["counts"], sum(summary["seconds"].values())


def main():
    program = sys.argv[1]
    deck = sys.argv[2] if len(sys.argv) > 2 else str(pathlib.Path(__file__).resolve().parents[2] / "inputs/capsule_capillary.yaml")
    print(f"{'':34}{'lambda':>7}{'solves':>8}{'mean':>8}{'largest':>9}{'seconds':>9}")
    for ratio in 1, 5:
        for name, settings in CHOICES:
            common = ["Surface/elements per side=6", "Time/final time=0.5", f"Particle/viscosity ratio={ratio}"]
            with tempfile.TemporaryDirectory() as folder:
                found, seconds = counts(program, deck, common + settings, folder + "/results")
            if not found:
                print(f"{name:34}{ratio:7}  {seconds[:120]}")
                continue
            solves = found["velocity_solves"]
            mean = found["velocity_iterations"] / solves if solves else 0
            print(f"{name:34}{ratio:7}{solves:8}{mean:8.1f}{found['most_velocity_iterations']:9}{seconds:9.1f}", flush=True)


if __name__ == "__main__":
    main()
