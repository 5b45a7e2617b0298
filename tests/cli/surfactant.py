#!/usr/bin/python3
# ranks: 2
# Tests of a drop with surfactant: mass, motions of the mesh, ranks, a resumed run, and a run that fails because the
# tension vanishes.
import numpy

from harness import check, deck, main, run, series, summary

DECK = """
Tanktread:
  Flow: {type: simple shear}
  Particle: {shape: sphere, viscosity ratio: 2}
  Membrane: {law: surface tension, capillary number: 0.2}
  Interface: {surfactant: {elasticity number: 0.3, diffusivity: 0.05}}
  Surface: {elements per side: 4}
  Time: {scheme: bs3, fixed step: 0.04, final time: 0.8}
  Solvers: {tolerance: 1.0e-12}
  Output: {interval: 0.4}
"""
SERIES = "taylor_inertia", "stresslet_13", "energy", "largest_concentration", "smallest_concentration"


def _close(one, other, tolerance):
    for name in SERIES:
        a, b = series(one, name), series(other, name)
        check(len(a) == len(b) and numpy.max(abs(a - b)) <= tolerance * numpy.max(abs(a)), f"{name} differs by {numpy.max(abs(a - b))}")


def two_ranks_agree_with_one_and_the_mass_is_conserved():
    for ranks in 1, 2:
        run(deck(DECK), "--output", f"on_{ranks}", "--quiet", ranks=ranks)
        mass = series(f"on_{ranks}", "surfactant_mass")
        check(numpy.max(abs(mass - 1)) < 1e-14, f"the mass is off by {numpy.max(abs(mass - 1))}")
    _close("on_1", "on_2", 1e-10)


def implicit_steps_do_not_depend_on_the_unit_of_time():
    """The flow is twice as fast and the run half as long. Because the factors are powers of two, any difference must
    come from a constant with a unit."""
    implicit = DECK.replace("scheme: bs3", "scheme: tr-bdf2")
    run(deck(implicit), "--output", "slow", "--quiet")
    run("deck.yaml", *[word for setting in ("Flow/shear rate=2", "Interface/surfactant/diffusivity=0.1", "Time/fixed step=0.02", "Time/final time=0.4",
                                            "Output/interval=0.2") for word in ("--set", setting)], "--output", "fast", "--quiet")
    for name in ("taylor_inertia", "largest_concentration", "smallest_concentration"):
        off = numpy.max(abs(series("slow", name) - series("fast", name)))
        check(off < 1e-12, name, "differs by", off)


def a_resumed_run_agrees_with_an_uninterrupted_one():
    run(deck(DECK), "--output", "whole", "--quiet")
    run(deck(DECK), "--set", "Time/final time=0.4", "--output", "parts", "--quiet")
    run("--resume", "parts", "--set", "Time/final time=0.8", "--quiet")
    _close("whole", "parts", 1e-13)  # the time 0.4 is reached by different sums of steps


def the_concentration_does_not_depend_on_the_motion_of_the_mesh():
    for motion in "relaxed", "material":
        words = ["--set", "Flow/type=uniaxial extension", "--set", f"Interface/motion={motion}", "--set", "Surface/elements per side=8"]
        words += ["--set", "Membrane/capillary number=0.05", "--set", "Time/scheme=rkc2"]
        run(deck(DECK), *words, "--output", motion, "--quiet")
    d = [series(motion, "taylor_inertia")[-1] for motion in ("relaxed", "material")]
    check(abs(d[0] / d[1] - 1) < 1e-4, f"D is {d[0]} and {d[1]}")  # with 6 elements per side: 1.7e-4
    largest = series("material", "largest_concentration")[-1]
    check(largest > 1.2, f"hardly anything is swept to the poles: {largest}")


def a_run_whose_tension_vanishes_reports_this_and_writes_a_checkpoint():
    words = ["--set", "Interface/surfactant/elasticity number=0.9", "--set", "Flow/type=uniaxial extension", "--set", "Membrane/capillary number=0.5"]
    told = run(deck(DECK), *words, "--output", "spent", "--quiet", code=3).stderr
    check("the surface tension vanishes where the surfactant concentration is 1." in told, told)
    check("failed" in summary("spent")["status"], summary("spent")["status"])


main()
