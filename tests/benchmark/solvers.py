#!/usr/bin/python3
"""Three Krylov solvers under three preconditioners for each kind of system, each chosen by the deck alone.

    tests/benchmark/solvers.py build/release/app/tanktread

Prints a table: mean and largest number of iterations of a solve, and the seconds of the systems. Runs are kept under
results/solvers.
"""

import itertools
import sys

from package import RATIO, SIDE, answer, table, tanktread

SHEARED = "inputs/shear_neo_hookean.yaml", {SIDE: 6, "Time/final time": 1}
CAPILLARY = "inputs/capsule_capillary.yaml", {SIDE: 6, RATIO: 5, "Time/final time": 0.5}


def preconditioners(system):
    return {kind: {f"Solvers/{system}/preconditioner": kind} for kind in ("none", "neumann", "recycled")}


# name: deck and settings, section of the system, preconditioners with their settings
SYSTEMS = {
    "velocity at viscosity ratio 5": (SHEARED[0], SHEARED[1] | {RATIO: 5}, "velocity", preconditioners("velocity")),
    "blocks in a tube, viscosity ratio 5": (*CAPILLARY, "velocity", {form: {"Solvers/tube": form} for form in (
        "block", "block diagonal", "block triangular")}),
    "implicit step": (*SHEARED, "implicit step", preconditioners("implicit step")),
}


def row(study, deck, settings, system, preconditioner, krylov):
    belos = {f"Solvers/{system}/iterative solver": krylov, f"Solvers/{system}/Belos/Maximum Iterations": 2000}
    if krylov == "GMRES" and preconditioner == "block":
        belos[f"Solvers/{system}/Belos/Num Blocks"] = 600  # no restart
    outcome = study.run(deck, settings | belos)
    if not outcome.done:
        return [outcome.message[:100], "", "", ""]
    counts, seconds = outcome.counts, outcome.phases
    if system == "velocity":
        return [counts["velocity_solves"], counts["velocity_iterations"] / counts["velocity_solves"],
                counts["most_velocity_iterations"], seconds["velocity system"]]
    return [counts["linear_solves"], counts["solver_iterations"] / counts["linear_solves"], "",
            seconds["implicit solve"]]


def main():
    study = tanktread.Study(sys.argv[1] if len(sys.argv) > 1 else None, "results/solvers")
    table(["system", "preconditioner", "solver", "solves", "iterations, mean", "largest", "seconds"], (
        [name, kind, krylov, *row(study, deck, settings | chosen, system, kind, krylov)]
        for name, (deck, settings, system, kinds) in SYSTEMS.items()
        for (kind, chosen), krylov in itertools.product(kinds.items(), ("GMRES", "BICGSTAB", "TFQMR"))))


if __name__ == "__main__":
    answer(main)
