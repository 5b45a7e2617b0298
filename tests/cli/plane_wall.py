#!/usr/bin/python3
# Tests of scenes next to a plane wall: known forces on rigid spheres, independence of the position of the wall, ranks
# and units, resumed runs, rejected decks.
# ranks: 2
import numpy

from harness import check, close, deck, main, refused, run, series

CAPSULE = """
Tanktread:
  Flow: {type: simple shear}
  Wall: {point: [0, 0, 0]}
  Particle: {shape: sphere, center: [0, 0, 1.2], viscosity ratio: 2.0}
  Membrane: {law: neo-Hookean, capillary number: 0.3}
  Surface: {elements per side: 4}
  Solvers: {tolerance: 1.0e-11}
  Time: {scheme: bs3, fixed step: 0.02, final time: 0.08}
"""
OF_CAPSULE = "velocity_x1", "velocity_x3", "energy", "stresslet_13", "taylor_inertia", "gap"

SPHERE = """
Tanktread:
  Flow: {type: quiescent}
  Wall: {}
  Particle: {shape: sphere, center: [0, 0, 1.1], motion: prescribed}
  Surface: {elements per side: 6}
  Adaptation: {enabled: true}
  Quadrature: {tolerance: 1.0e-6}
"""


def _with(text, **lists):
    """Returns the text of a deck in which the given sections replace or extend its sections."""
    lines = [line for line in text.splitlines() if not any(line.startswith(f"  {name}:") for name in lists)]
    return "\n".join(lines + [f"  {name}: {words}" for name, words in lists.items()]) + "\n"


def _last(name, *more, names=OF_CAPSULE, ranks=1, text=CAPSULE, **lists):
    run(deck(_with(text, **lists)), *more, "--output", name, "--quiet", ranks=ranks)
    return numpy.array([series(name, key)[-1] for key in names])


def the_force_on_a_fixed_sphere_is_the_known_one():
    """The exact values are from Brenner (1961) and Goldman, Cox & Brenner (1967)."""
    towards = _last("towards", "--set", "Particle/velocity=[0, 0, -1]", names=["drag_x3"], text=SPHERE)[0]
    close(towards / (6 * numpy.pi), 11.45915720, 2e-5 * 11.46, "drag across")
    along = _last("along", "--set", "Particle/velocity=[1, 0, 0]", names=["drag_x1", "torque_x2"], text=SPHERE)
    close(-along[0] / (6 * numpy.pi), 2.26430304, 1e-5, "drag along")
    close(abs(along[1]) / (8 * numpy.pi), 0.088763344, 1e-5, "torque")
    held = _last("held", names=["drag_x1", "torque_x2", "gap", "nearest_to_wall_x3"], text=SPHERE, Flow="{type: simple shear}")
    close(held[0] / (6 * numpy.pi * 1.1), 1.63254384, 1e-5, "drag in shear")
    close(held[1] / (4 * numpy.pi), 0.95179124, 1e-5, "torque in shear")
    close(held[2], 0.1, 1e-6, "gap")
    close(held[3], 0.1, 1e-6, "its place")


def a_side_of_a_wide_channel_acts_like_a_plane_wall():
    """Compares a drop that is pulled along one side of a square channel of side L, at the distance h = 1, with a drop
    at the same distance from a plane wall. Next to a wall, the far field of a force decays like h/r^2, and the
    disturbance that the other sides reflect changes the drop's velocity by a further factor h/L. The difference
    therefore decays like L^-3. The exponent measured between two sizes differs from 3 by a term of order 1/L."""
    drop = """
Tanktread:
  Flow: {type: quiescent, gravity: [1, 0, 0]}
  Particle: {radius: 0.25, center: [0, 0, 1], density difference: 48}
  Membrane: {law: surface tension, surface tension: 1}
  Surface: {elements per side: 3}
  Quadrature: {tolerance: 1.0e-5}
  Time: {fixed step: 1.0e-6, final time: 1.0e-6}
"""

    def velocity(name, **lists):
        run(deck(_with(drop, **lists)), "--output", name, "--quiet")
        return series(name, "velocity_x1")[0]

    alone = velocity("images", Wall="{}")
    sides, lacking = numpy.array([3, 4, 6]), []
    for side, elements in zip(sides, (24, 28, 32)):
        place = f"{{radius: 0.25, center: [0, 0, {1 - side / 2}], density difference: 48}}"
        tube = f"{{section: rectangle, sides: [{side}, {side}], azimuthal elements: {elements}}}"
        lacking.append(alone - velocity(f"side {side}", Tube=tube, Particle=place))
    powers = -numpy.diff(numpy.log(lacking)) / numpy.diff(numpy.log(sides))
    extrapolated = numpy.polyfit(1 / numpy.sqrt(sides[1:] * sides[:-1]), powers, 1)[1]
    check(abs(extrapolated - 3) < 0.1, f"the power goes to {extrapolated}: {powers} between {sides}")


def a_free_sphere_moves_with_the_known_velocity():
    free = _last("alone", names=["velocity_x1", "angular_velocity_x2", "velocity_x3"], Flow="{type: simple shear}", Time="{scheme: bs3, fixed step: 0.001, final time: 0.001}", Output="{interval: 0.001}",
                 text=SPHERE.replace("prescribed", "free"))
    close(free[0] / 1.1, 0.73889120, 1e-5, "velocity")
    close(free[1] * 2, 0.75339762, 1e-5, "angular velocity")
    close(free[2], 0, 1e-6, "velocity across")


def the_position_of_the_wall_does_not_matter():
    """Shifts the wall together with the particle, and rotates both by half a turn about x2, which maps the flow onto
    itself."""
    one = _last("one")
    moved = _last("moved", "--set", "Wall/point=[3, 1, -5]", "--set", "Particle/center=[0, 0, -3.8]")
    moved[0] += 5
    check(abs(moved - one).max() < 1e-9, "moved:", moved - one)
    below = _last("below", "--set", "Wall/normal=[0, 0, -2]", "--set", "Particle/center=[0, 0, -1.2]")
    below[:2] *= -1
    check(abs(below - one).max() < 1e-7, "below:", below - one)


def ranks_agree():
    one, two = _last("on_one"), _last("on_two", ranks=2)
    check(abs(two - one).max() < 1e-10, two - one)
    clusters = "--set", "Quadrature/far sum=tree", "--set", "Time/final time=0.02"
    one, two = _last("tree_on_one", *clusters), _last("tree_on_two", *clusters, ranks=2)
    check(abs(two - one).max() < 1e-10, two - one)


def a_run_next_to_a_wall_is_resumed():
    run(deck(CAPSULE), "--output", "whole", "--quiet", "--set", "Output/interval=0.04")
    run(deck(CAPSULE), "--output", "parts", "--quiet", "--set", "Output/interval=0.04", "--set", "Time/final time=0.04")
    run("--resume", "parts", "--quiet", "--set", "Time/final time=0.08")
    for name in OF_CAPSULE:
        check(abs(series("whole", name) - series("parts", name)).max() < 1e-12, name)


def units_do_not_matter():
    """In other units, lengths are divided by 4 and times by 10, and viscosities are multiplied by 3."""
    one = _last("one", names=["taylor_inertia", "velocity_x3", "gap"])
    other = _last("other", names=["taylor_inertia", "velocity_x3", "gap"], Flow="{type: simple shear, shear rate: 10.0, viscosity: 3.0}",
                  Particle="{shape: sphere, radius: 0.25, center: [0, 0, 0.3], viscosity ratio: 2.0}",
                  Time="{scheme: bs3, fixed step: 0.002, final time: 0.008}")
    check(abs(other * [1, 0.4, 4] - one).max() < 1e-9, other, one)


def a_run_ends_if_a_sphere_comes_too_close_to_the_wall():
    text = _with(SPHERE.replace("motion: prescribed", "motion: free, force: [0, 0, -20]"), Wall="{contact gap: 0.09}", Surface="{elements per side: 3}", Time="{final time: 5.0}")
    error = run(deck(text), "--output", "close", "--quiet", code=3).stderr
    check(all(word in error for word in ("touches the wall", "Wall/contact gap", "checkpoint")), error)


def decks_that_are_impossible_with_a_wall_are_rejected():
    for lists, words in (
        ({"Flow": "{type: planar hyperbolic}"}, ["Wall", "planar hyperbolic", "along the wall"]),
        ({"Flow": "{type: uniaxial extension}"}, ["Wall", "along the wall"]),
        ({"Wall": "{normal: [1, 0, 0]}"}, ["Wall", "simple shear", "along the wall"]),
        ({"Wall": "{normal: [0, 0, 0]}"}, ["Wall/normal", "direction"]),
        ({"Wall": "{shape: sphere}"}, ["Wall/shape", "plane"]),
        ({"Wall": "{point: [0, 0, 0.5]}"}, ["crosses the wall", "0.3001 behind"]),
        ({"Wall": "{point: [0, 0, 0.1995]}"}, ["too close to the wall", "0.00038", "Wall/contact gap"]),
        ({"Flow": "{type: duct}", "Tube": "{section: circle, radius: 5.0}"}, ["Wall", "contradict"]),
        ({"Quadrature": "{rule: fixed}"}, ["Wall", "fixed"]),
        ({"Steady": "{}", "Flow": "{type: quiescent}", "Membrane": "{law: surface tension, surface tension: 1.0}"}, ["Steady", "Wall"]),
    ):
        refused(words, deck(_with(CAPSULE, **lists)))


main()
