#!/usr/bin/python3
# Tests that the energy of a membrane never increases in a fluid at rest: an inflated ellipsoid relaxes to equilibrium.
# Tests that a drop in a rigidly rotating fluid relaxes as in a fluid at rest.
import numpy

from harness import check, deck, main, run, series

DECK = """
Tanktread:
  Flow: {type: quiescent}
  Particle: {shape: ellipsoid, semi-axes: [1.3, 1.0, 0.8]}
  Membrane: {shear modulus: 1.0, pre-inflation: 0.1}
  Surface: {elements per side: 3}
  Time: {final time: 20.0}
"""


def _relax(*settings):
    """Checks that the energy decreases in every step and by more than 1 % in total, and that the membrane is almost at
    rest at the end."""
    words = [word for setting in settings for word in ("--set", setting)]
    run(deck(DECK), *words, "--output", "out", "--overwrite", "--quiet")
    energy = series("out", "energy")
    rise = numpy.max(numpy.diff(energy))
    check(rise <= 1e-10 * energy[0], f"the energy rises by {rise:.2e} of {energy[0]:.4f}")
    check(energy[-1] < 0.99 * energy[0], f"the energy hardly falls: from {energy[0]:.6f} to {energy[-1]:.6f}")
    moving = series("out", "normal_velocity")
    check(moving[-1] < 0.02 * moving[0], f"still moving: {moving[-1]:.2e} of {moving[0]:.2e}")


def a_neo_hookean_membrane_in_implicit_steps():
    _relax()


def a_skalak_membrane_in_explicit_steps():
    """The step is below the stability limit, because at the limit an explicit scheme oscillates within its
    tolerance."""
    _relax("Membrane/law=Skalak", "Membrane/area dilatation=2.0", "Time/scheme=bs3", "Time/maximum step=0.1")


def the_scale_of_velocities_does_not_depend_on_the_unit_of_time():
    path = deck(DECK.replace("20.0", "0.5, steady tolerance: 1.0e-9"))
    run(path, "--output", "one", "--quiet")
    # this doubles the relaxation time
    run(path, "--output", "half", "--quiet", "--set", "Flow/viscosity=2", "--set", "Time/final time=1")
    for name in "normal_velocity", "shape_velocity":
        one, half = series("one", name)[0], series("half", name)[0]
        check(abs(half / one - 1) < 1e-10, f"{name} is {one}, and {half} in another unit of time")


def a_drop_in_a_fluid_that_turns_relaxes_as_in_one_at_rest():
    """D and the energy agree for all motions of the mesh, up to the errors of the steps and the quadrature."""
    settings = ["Membrane/law=surface tension", "Membrane/pre-inflation=0", "Particle/drift=free", "Time/final time=2.0", "Time/tolerance=1e-5"]
    turning = ["Flow/type=linear", "Flow/gradient=[0, 0, 2, 0, 0, 0, -2, 0, 0]"]
    path = deck(DECK.replace("shear modulus", "surface tension"))
    for motion in "material", "normal", "relaxed":
        for name, more in ("rests", []), ("turns", turning):
            words = [word for setting in [*settings, *more, f"Interface/motion={motion}"] for word in ("--set", setting)]
            run(path, *words, "--output", name, "--overwrite", "--quiet")
        for name in "energy", "taylor_inertia":
            rests, turns = series("rests", name)[-1], series("turns", name)[-1]
            check(abs(turns - rests) <= 1e-3 * rests, f"{motion}: {name} is {turns} where the fluid turns, {rests} where it rests")


main()
