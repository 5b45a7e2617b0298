#!/usr/bin/python3
"""Which unknowns of the coupled system are eliminated: iterations, seconds and agreement of the choices in five scenes.

    tests/benchmark/eliminations.py build/release/app/tanktread

Every scene makes a few steps of fixed size with `Solvers/tolerance` 1e-12, so that the choices differ only by the
solution of the linear systems. The steps are small, because the frozen operators also enter the estimated error that
TR-BDF2 subtracts (4.30). Prints a table: mean iterations per velocity solve and per implicit step, processor seconds,
and the largest difference of all series from the first choice, as compare.py takes it.
"""

import sys

from compare import differences_of
from package import RATIO, SIDE, answer, table, tanktread

SMALL = {"Solvers/tolerance": 1e-12, "Time/fixed step": 0.002, "Time/final time": 0.01, "Output/interval": 0.005,
         "Time/iteration tolerance": 1e-12, "Time/newton tolerance": 1e-10, "Time/newton iterations": 30}
EXPLICIT = {"Time/scheme": "bs3"}  # no Jacobian, from which the iterated wall is missing
MANY = {"Solvers/velocity/Belos/Maximum Iterations": 600}  # without a preconditioner
FIVE = {RATIO: 5, SIDE: 6}
TUBE = [{"Solvers/tube": form} | (MANY if form == "block" else {})
        for form in ("schur", "block triangular", "block diagonal", "block")]
LAYER = [{"Solvers/double layer": form} for form in ("assembled", "matrix-free")]
FROZEN = [{"Solvers/frozen operator": form} for form in ("nodal", "assembled")]
# name: deck, settings, choices; the first choice is the default or what the others are compared with
SCENES = {
    "capsule in a tube, ratio 5": ("capsule_in_tube", FIVE, TUBE + FROZEN[1:]),
    "capsule in a channel, ratio 5": ("capsule_bend", FIVE | EXPLICIT, [
        {"Solvers/wall": form} for form in ("factored", "iterative")]),
    "capsule in shear, ratio 5": ("shear_neo_hookean", FIVE, LAYER + FROZEN[1:]),
    "two settling spheres": ("settling_spheres", {}, [{**one, "Solvers/velocity/preconditioner": kind}
                                                      for one in LAYER for kind in ("own", "none", "recycled")]),
    "capsule, drop and ball": ("capsule_drop_ball", {}, LAYER + FROZEN[1:]),
}


def rows(study):
    for scene, (deck, settings, choices) in SCENES.items():
        first = None
        for choice in choices:
            outcome = study.run(f"inputs/{deck}.yaml", SMALL | settings | choice)
            words = ", ".join(f"`{key.removeprefix('Solvers/')}: {value}`" for key, value in choice.items())
            if not outcome.done:
                yield [scene, words, outcome.message, "", "", ""]
                continue
            run, counts = outcome.run, outcome.counts
            first = first or run
            mean = [counts.get(part, 0) / max(1, counts.get(of, 0)) for part, of in
                    (("velocity_iterations", "velocity_solves"), ("solver_iterations", "linear_solves"))]
            yield [scene, words, *(f"{one:.1f}" for one in mean), f"{outcome.processor_seconds:.2f}",
                   "–" if run is first else f"{max(differences_of(first, run)[0].values()):.1e}"]


def main():
    table(["scene", "choice", "iterations per velocity", "per implicit step", "processor seconds",
           "differs from the first choice by"],
          rows(tanktread.Study(sys.argv[1] if len(sys.argv) > 1 else None, "results/eliminations")))


if __name__ == "__main__":
    answer(main)
