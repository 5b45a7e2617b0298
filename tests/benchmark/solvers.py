#!/usr/bin/python3
"""Three Krylov solvers under three preconditioners for each kind of system, each chosen by the deck alone.

    tests/benchmark/solvers.py build/release/app/tanktread

Prints a table: mean and largest number of iterations of a solve, and the seconds of the systems.
"""
import itertools
import pathlib
import subprocess
import sys
import tempfile

import yaml

INPUTS = pathlib.Path(__file__).resolve().parents[2] / "inputs"
KRYLOV = ["GMRES", "BICGSTAB", "TFQMR"]
SHEAR = [INPUTS / "shear_neo_hookean.yaml", "Surface/elements per side=6", "Time/final time=1"]
CAPILLARY = [INPUTS / "capsule_capillary.yaml", "Surface/elements per side=6", "Time/final time=0.5"]


def solver(system, krylov, preconditioner):
    long = {"Maximum Iterations": 2000}
    if krylov == "GMRES" and preconditioner == "block":
        long["Num Blocks"] = 600  # no restart
    return [f"Solvers/{system}/iterative solver={krylov}"] + [f"Solvers/{system}/Belos/{key}={value}" for key, value in long.items()]


def of_system(system):
    return [(kind, [f"Solvers/{system}/preconditioner={kind}"]) for kind in ("none", "neumann", "recycled")]


# name of the system, deck and settings, its list, preconditioners with their settings, counts and clock in the summary
SYSTEMS = [
    ("velocity at viscosity ratio 5", SHEAR + ["Particle/viscosity ratio=5"], "velocity", of_system("velocity"), "velocity"),
    ("blocks in a tube, viscosity ratio 5", CAPILLARY + ["Particle/viscosity ratio=5"], "velocity",
     [(form, [f"Solvers/tube={form}"]) for form in ("block", "block diagonal", "block triangular")], "velocity"),
    ("implicit step", SHEAR, "implicit step", of_system("implicit step"), "step"),
]


def run(program, deck, settings):
    """Iterations and solves, the largest number where it is kept, and seconds; or what went wrong."""
    words = [word for setting in settings for word in ("--set", setting)]
    with tempfile.TemporaryDirectory() as folder:
        results = folder + "/results"
        said = subprocess.run([program, deck, *words, "--output", results, "--no-expect", "--quiet"], capture_output=True, text=True)
        summary = pathlib.Path(results) / "summary.yaml"
        if said.returncode or not summary.exists():
            return None, [line for line in said.stderr.splitlines() if "warning" not in line][-1:]
        found = yaml.safe_load(summary.read_text())
    return found["counts"], found["seconds"]


def row(counts, seconds, kind):
    if kind == "velocity":
        solves, iterations, largest = counts["velocity_solves"], counts["velocity_iterations"], counts["most_velocity_iterations"]
        return solves, iterations / solves, largest, seconds["velocity system"]
    return counts["linear_solves"], counts["solver_iterations"] / counts["linear_solves"], None, seconds["implicit solve"]


def main():
    program = sys.argv[1]
    print("| system | preconditioner | solver | solves | iterations, mean | largest | seconds |\n|---|---|---|---|---|---|---|")
    for name, (deck, *settings), system, preconditioners, kind in SYSTEMS:
        for (preconditioner, chosen), krylov in itertools.product(preconditioners, KRYLOV):
            counts, seconds = run(program, deck, settings + chosen + solver(system, krylov, preconditioner))
            if not counts:
                print(f"| {name} | {preconditioner} | {krylov} | {' '.join(seconds)[:100]} | | | |", flush=True)
                continue
            solves, mean, largest, spent = row(counts, seconds, kind)
            print(f"| {name} | {preconditioner} | {krylov} | {solves} | {mean:.1f} | {largest or ''} | {spent:.2f} |", flush=True)


if __name__ == "__main__":
    main()
