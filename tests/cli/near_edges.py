#!/usr/bin/python3
# Tests that a run near a limit of the method warns once, on standard error and in its summary, and that other runs do
# not warn.
from harness import check, deck, main, run, summary

DECK = """
Tanktread:
  Flow: {type: simple shear}
  Membrane: {capillary number: 0.3}
  Surface: {elements per side: 3}
  Time: {final time: 0.2}
"""

LOW = ["Membrane/capillary number=0.02", "Surface/elements per side=6", "Time/final time=2.5", "Time/tolerance=1e-3"]


def _said(*settings, code=0):
    """Returns the warnings of a run on standard error, and the warnings in its summary."""
    words = [word for setting in settings for word in ("--set", setting)]
    told = [line for line in run(deck(DECK), *words, "--output", "out", "--overwrite", "--quiet", code=code).stderr.splitlines() if "warning:" in line]
    return told, summary("out")["warnings"] if code == 0 else None


def a_normal_run_gives_no_warning():
    check(_said() == ([], []), _said())


def compression_without_bending_stiffness_is_reported_once_with_advice():
    told, kept = _said(*LOW)
    check(len(told) == 1 and len(kept) == 1 and kept[0] in told[0] and "Membrane/bending modulus" in told[0], told, kept)


def bending_stiffness_or_pre_inflation_avoids_the_warning():
    for cure in "Membrane/bending modulus=2.0", "Membrane/pre-inflation=0.05":
        told, kept = _said(*LOW, cure)
        check(told == [] and kept == [], cure, told, kept)


def a_total_area_modulus_that_needs_many_steps_is_reported():
    few, many = (_said("Membrane/global area dilatation=" + k, "Time/final time=0.01") for k in ("1e4", "1e5"))
    check(few == ([], []), few)
    check(len(many[0]) == len(many[1]) == 1 and "of 1e4" in many[0][0], many)


def a_stiff_area_that_locks_the_mesh_is_reported_before_the_run_and_the_remedy_ends_the_warning():
    stiff = ["Membrane/law=Skalak", "Membrane/area dilatation=1e3", "Time/final time=0.01"]
    plan = run(deck(DECK), "--check", "--quiet", *(word for setting in stiff for word in ("--set", setting))).stdout
    check("warning" in plan.split("\nplan")[1] and "set Membrane/area points to 1" in plan, plan)
    told, kept = _said(*stiff)
    check(len(told) == len(kept) == 1 and kept[0] in told[0] and "set Membrane/area points to 1" in kept[0], told, kept)
    check(_said(*stiff, "Membrane/area points=1") == ([], []), "the remedy")


def a_tip_that_the_mesh_does_not_resolve_is_reported_and_refinement_resolves_it():
    drawn = ["Flow/type=planar hyperbolic", "Membrane/law=Skalak", "Membrane/capillary number=0.8", "Time/final time=1.5", "Time/tolerance=1e-3"]
    told, kept = _said(*drawn)
    check(len(told) == len(kept) == 1 and "turns by" in kept[0] and "Adaptation/enabled" in kept[0], told, kept)
    cured, _ = _said(*drawn, "Surface/elements per side=6", "Adaptation/enabled=true")
    check(not any("turns by" in line for line in cured), cured)


def a_fixed_step_beyond_the_stability_limit_is_reported_before_the_run_fails():
    told, _ = _said("Time/scheme=bs3", "Time/fixed step=0.3", "Membrane/capillary number=0.1", "Time/final time=30", code=3)
    check(any("Time/scheme" in line for line in told), told)


main()
