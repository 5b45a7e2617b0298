#!/usr/bin/python3
# Tests that a run which uses the symmetry of its scene gives the result of the run without symmetry, with less work.
from harness import check, deck, main, run, series, summary

DECK = """
Tanktread:
  Flow: {type: simple shear}
  Membrane: {capillary number: 0.3}
  Surface: {elements per side: 6}
  Time: {final time: 2.0}
"""


def _compare(*settings):
    """Checks that the deformation at the final time agrees to 1e-10 with and without symmetry. Returns the ratio of
    kernel evaluations without symmetry to those with symmetry."""
    words = [word for setting in settings for word in ("--set", setting)]
    for use in "auto", "none":
        run(deck(DECK), *words, "--set", f"Symmetry/use={use}", "--output", use, "--overwrite", "--quiet")
    part, whole = (series(use, "taylor_inertia") for use in ("auto", "none"))
    check(len(part) == len(whole), f"{len(part) - 1} steps of the part, {len(whole) - 1} of the whole")
    off = abs(part[-1] - whole[-1])
    check(off <= 1e-10, f"the deformation differs by {off:.2e}")
    return summary("none")["counts"]["kernel_evaluations_far"] / summary("auto")["counts"]["kernel_evaluations_far"]


def a_capsule_in_shear():
    check(_compare() >= 3.5, "hardly less work")


def a_capsule_in_planar_hyperbolic_flow():
    check(_compare("Flow/type=planar hyperbolic", "Membrane/law=Skalak", "Membrane/capillary number=0.6") >= 3.5, "hardly less work")


def an_ellipsoid_with_a_viscous_interior():
    # the tolerance of the solver for the velocity must be below the tolerance of the comparison
    check(_compare("Particle/viscosity ratio=3", "Particle/shape=ellipsoid", "Particle/semi-axes=[1.2, 1.0, 0.9]", "Surface/elements per side=4",
                   "Time/final time=0.5", "Solvers/tolerance=1e-12") >= 2.5, "hardly less work")


main()
