#!/usr/bin/python3
# Tests of a membrane pulled at two patches: linear theory of a sphere, drift under a single force, rejected decks.
import numpy
from numpy.polynomial import legendre

from harness import check, deck, main, run, series

DECK = """
Tanktread:
  Flow: {type: quiescent}
  Particle: {shape: sphere}
  Membrane:
    shear modulus: 1.0
    forces:
      left: {direction: [-1, 0, 0], radius: 0.8, force: [-0.001, 0, 0]}
      right: {direction: [1, 0, 0], radius: 0.8, force: [0.001, 0, 0]}
  Surface: {elements per side: 6}
  Time: {final time: 60.0, tolerance: 1e-5}
"""


def _harmonics(force, radius, degree):
    """Yields l, p_r, p_t and P_l for each degree l. The load of the patch around x1 = 1 is the sum over l of p_r Y r +
    p_t grad Y, where Y = P_l(x1)."""
    mu, weight = legendre.leggauss(4000)
    sine = numpy.sqrt(1 - mu**2)
    shape = numpy.where(mu > 0, numpy.clip(1 - (sine / radius) ** 2, 0, None) ** 2, 0)
    density = force * shape / (2 * numpy.pi * (weight * shape).sum())
    for l in range(1, degree):
        p = legendre.Legendre.basis(l)
        radial = (2 * l + 1) / 2 * (weight * density * mu * p(mu)).sum()
        slope = -sine * p.deriv()(mu)  # derivative of P_l with respect to the polar angle
        yield l, radial, (2 * l + 1) / (2 * l * (l + 1)) * (weight * -density * sine * slope).sum(), p


def _stretch(force, radius, degree=60):
    """Returns the half lengths along and across two opposite forces, minus 1, of a sphere with shear modulus 1 and area modulus 3.

    Displacements a Y r + b grad Y balance a load of harmonic l by 2 K (2a - L b) = p_r and G (L - 2) b - K (2a - L b) = p_t, L = l (l + 1)."""
    along = across = 0.0
    # the second patch doubles even harmonics and cancels odd harmonics
    for l, radial, tangential, p in _harmonics(2 * force, radius, degree):
        if l % 2:
            continue
        b = (tangential + radial / 2) / (l * (l + 1) - 2)
        a = (radial / 6 + l * (l + 1) * b) / 2
        along, across = along + a * p(1.0), across + a * p(0.0)
    return along, across


def _drift(force, radius):
    """Returns the velocity of the centroid of the unit sphere under one force, if both viscosities are 1. With the unit
    normal r and a spherical harmonic Y of degree 1, the single layer has the eigenvalue 2/3 for the eigenfunction
    Y r + grad Y and the eigenvalue 1/15 for -2 Y r + grad Y."""
    _, radial, tangential, _ = next(_harmonics(force, radius, 2))
    return 2 / 3 * (radial + 2 * tangential) / 3 - 2 / 15 * (tangential - radial) / 3


def a_sphere_is_stretched_as_in_linear_theory():
    run(deck(DECK), "--output", "pulled", "--quiet")
    along, across = _stretch(0.001, 0.8)
    for name, expected in ("length_x1", along), ("length_x2", across), ("length_x3", across):
        length = series("pulled", name)  # error of the initial sphere: 4e-5
        found = (length[-1] - length[0]) / 2
        # discretisation error: 5e-2 for n = 4
        check(abs(found - expected) < 3e-3 * along, f"{name}: {found:.4e} where linear theory gives {expected:.4e}")
    check(series("pulled", "normal_velocity")[-1] < 1e-5, "it still moves")


def a_single_force_moves_the_centroid():
    words = ["--set", "Membrane/forces/left/force=[0, 0, 0]", "--set", "Time/final time=1e-3", "--set", "Time/tolerance=1e-4"]
    run(deck(DECK), *words, "--output", "towed", "--quiet")
    found, expected = series("towed", "velocity_x1")[0], _drift(0.001, 0.8)
    check(abs(found - expected) < 1e-3 * expected, f"the centroid moves at {found} where the load gives {expected}")


def contradictory_decks_are_rejected():
    for setting, sentence in (
        ("Membrane/forces/left/direction=[0, 0, 0]", "must not be zero"),
        ("Membrane/forces/left/direction=[2, 0, 0]", "act on the same point"),
        ("Membrane/load=strong", "contradict"),
        ("Membrane/forces/left/radius=-1", "positive"),
    ):
        told = run(deck(DECK), "--set", setting, "--check", code=2).stderr
        check(sentence in told, setting, told)


main()
