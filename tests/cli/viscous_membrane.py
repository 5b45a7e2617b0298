#!/usr/bin/python3
# ranks: 2
# A membrane with a viscosity of its own: how a sphere relaxes, what it dissipates, ranks, and what a deck may not ask for.
import numpy

from harness import check, deck, main, run, series

DECK = """
Tanktread:
  Flow: {type: quiescent}
  Particle:
    shape: sphere
    initial shape: {stretch: [1.001, 1.0, 0.999]}
  Membrane: {shear modulus: 1.0, shear viscosity: 0.5}
  Surface: {elements per side: 6}
  Time: {final time: 12.0, tolerance: 1.0e-9}
  Output: {interval: 2.0}
"""


def _rate(results):
    """Of the decay of D between times 8 and 12, where the fast mode (rate 1.9) is gone."""
    time, d = series(results, "time"), series(results, "taylor_inertia")
    early, late = numpy.argmin(abs(time - 8)), numpy.argmin(abs(time - 12))
    return -numpy.log(d[late] / d[early]) / (time[late] - time[early])


def a_sphere_relaxes_at_the_rate_of_linear_theory():
    """Of the second harmonic, viscosities 1: 0.22457708 with eta_s = 0.5, 0.24835904 without, by the 2 x 2 system of two displacements."""
    for viscosity, expected in (0.5, 0.22457708), (0.0, 0.24835904):
        run(deck(DECK), "--set", f"Membrane/shear viscosity={viscosity}", "--output", f"at_{viscosity}", "--quiet")
        found = _rate(f"at_{viscosity}")
        check(abs(found - expected) < 2e-5, f"rate {found:.6f} where theory gives {expected:.6f}")


def what_the_membrane_dissipates_comes_from_its_energy():
    """In a fluid at rest the energy falls by what fluid and membrane dissipate: with a membrane a thousand times as viscous, by the membrane's part."""
    words = ["--set", "Membrane/shear viscosity=1000", "--set", "Membrane/dilatational viscosity=3000", "--set", "Time/final time=1500"]
    run(deck(DECK), *words, "--set", "Output/interval=100", "--output", "thick", "--quiet")
    time, energy, power = (series("thick", name) for name in ("time", "energy", "membrane_dissipation"))
    spent = numpy.sum((power[1:] + power[:-1]) / 2 * numpy.diff(time))
    fallen = energy[0] - energy[-1]
    check(abs(spent / fallen - 1) < 5e-3, f"{spent} dissipated in the membrane of {fallen}")  # trapezoids, and a thousandth in the fluids


def two_processes_do_what_one_does():
    words = ["--set", "Time/fixed step=0.1", "--set", "Time/final time=0.5", "--set", "Particle/viscosity ratio=2", "--set", "Solvers/tolerance=1e-12"]
    words += ["--set", "Flow/type=simple shear", "--set", "Surface/elements per side=4", "--set", "Output/interval=0.5", "--quiet"]
    for ranks in 1, 2:
        run(deck(DECK), *words, "--output", f"on_{ranks}", ranks=ranks)
    for name in "taylor_inertia", "stresslet_13", "membrane_dissipation":
        one, two = series("on_1", name), series("on_2", name)
        check(numpy.max(abs(one - two)) <= 1e-10 * numpy.max(abs(one)), f"{name} differs by {numpy.max(abs(one - two))}")


def a_deck_that_makes_no_sense_is_refused():
    for setting, sentence in (
        ("Membrane/shear viscosity=-1", "shear viscosity"),
        ("Membrane/load measure=current", "needs Membrane/load"),
        ("Membrane/load=strong", "needs Membrane/load"),
    ):
        told = run(deck(DECK), "--set", setting, "--check", code=2).stderr
        check(sentence in told, setting, told)


main()
