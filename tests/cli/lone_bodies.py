#!/usr/bin/python3
# Tests of scenes with a single rigid body: steady orientations and their decay rates, periodic orbits, power balance,
# repulsion by a wall, mesh refinement, and prescribed motion in a flow that varies in time.
import numpy

from harness import check, close, deck, main, run, series

SPHEROID = """Tanktread:
  Flow: {type: %s}
  Particle: {motion: free, shape: spheroid, semi-axes: [1, 1, 2], orientation: [0, %g, 0]}
  Surface: {elements per side: 4}
  Solvers: {rigid bodies: first kind}
  %s
"""
ALONE = """Tanktread:
  Flow: {%s}
  Particle: {motion: %s}
  Surface: {elements per side: 3}
  Time: {final time: 0.4, fixed step: 0.1}
  %s
"""
FLATTENING = (2**2 - 1) / (2**2 + 1)  # (r^2 - 1)/(r^2 + 1) with the aspect ratio r, Jeffery 1922


def a_spheroid_aligns_with_an_extension():
    """A deviation of the symmetry axis from the axis of extension decays at the rate 3/2 FLATTENING, if the rate of
    extension is 1."""
    run(deck(SPHEROID % ("uniaxial extension", 60, "Steady: {tolerance: 1.0e-7}\n  Spectrum: {number: 6}")), "--output", "found", "--quiet")
    rates = sorted(series("found", f"rate_{k}")[-1] for k in range(1, 7))
    expected = sorted([1, -0.5, -0.5, 0, -1.5 * FLATTENING, -1.5 * FLATTENING])
    for rate, exact in zip(rates, expected):
        close(rate, exact, 2e-3, "rate")
    close(series("found", "leading_rate")[-1], 0, 2e-3, "of a rotation about the axis")


def pressure_drops_in_ducts_are_additive():
    """Stokes flow is linear: a body that moves in fluid at rest, and the body at rest in the flow, together are the body
    that moves in the flow. A free body under a force behaves like a body with a prescribed equal velocity."""
    moves = "velocity: [1, 0.2, 0.1], angular velocity: [0.1, 0.3, 0.2]"
    text = """Tanktread:
  Flow: {type: %s}
  %s
  Particle: {radius: 0.5, center: [0.1, 0.15, -0.1], %s}
  Surface: {elements per side: 3}
  Solvers: {tolerance: 1.0e-11}  # the drops below are compared to 1e-8
  Time: {final time: 0.01, fixed step: 0.01}
"""

    def drop(flow, motion):
        run(deck(text % (flow, duct, motion)), "--output", "found", "--quiet", "--overwrite")
        return series("found", "disturbed_pressure_drop")[0]

    for duct in "Tube: {azimuthal elements: 8, axial elements: 8}", \
                "Channel: {depth: 0.2, half length: 2, azimuthal elements: 8, axial elements: 12}":
        alone, both, still = drop("quiescent", f"motion: prescribed, {moves}"), drop("duct", f"motion: prescribed, {moves}"), drop("duct", "motion: prescribed")
        check(abs(alone + still - both) < 1e-8 * abs(still), f"{duct}: {alone} and {still} are not {both}")
        for flow in "quiescent", "duct":
            free = drop(flow, "motion: free, force: [3, 1, 0.5], torque: [0.2, 0.1, 0.5]")
            now = {name: [series("found", f"{name}_x{i}")[0].item() for i in (1, 2, 3)] for name in ("velocity", "angular_velocity")}
            told = drop(flow, f"motion: prescribed, velocity: {now['velocity']}, angular velocity: {now['angular_velocity']}")
            check(abs(free - told) < 1e-8 * abs(told), f"{duct}, {flow}: {free} if free, {told} if prescribed")


def errors_in_a_channel_at_rest_do_not_depend_on_the_unit_of_time():
    """Measures of error refer to a speed of the scene: they do not depend on the unit of time."""
    text = """Tanktread:
  Flow: {type: quiescent, viscosity: %g}
  Channel: {profile: constriction, radius: 1, depth: 0.2, half length: 1, start: -4, end: 4, azimuthal elements: 8, axial elements: 16}
  Membrane: {shear modulus: %g}
  Particle: {shape: ellipsoid, semi-axes: [0.5, 0.4, 0.4], center: [-1, 0.1, 0]}
  Surface: {elements per side: 3}
  Time: {final time: %g, fixed step: %g}
"""
    for name, unit in ("one", 1), ("other", 10):
        run(deck(text % (unit, 1, 0.2 * unit, 0.1 * unit)), "--output", name, "--quiet")
        for column in "channel_pressure_drop", "channel_extra_pressure_drop":
            check(abs(series(name, column)).max() == 0, f"{column} in fluid at rest: {series(name, column)}")
    for column in "disturbance_flux", "force_imbalance", "cap_velocity":
        one, other = series("one", column)[-1], series("other", column)[-1]
        check(abs(other - one) < 1e-3 * abs(one), f"{column} is {one}, and {other} in another unit of time")


def prescribed_bodies_need_no_final_time():
    """The run ends with its first row. By symmetry, drags of two spheres that move side by side are equal."""
    run(deck("""
Tanktread:
  Flow: {type: uniform, velocity: [1, 0, 0]}
  Particles:
    one: {motion: prescribed, Surface: {elements per side: 3}}
    two: {motion: prescribed, center: [0, 3, 0], Surface: {elements per side: 3}}
"""), "--output", "both", "--quiet")
    check(list(series("both", "time")) == [0], series("both", "time"))
    one, two = (series("both", f"{name}/drag_x1")[-1] for name in ("one", "two"))
    check(0 < one < 6 * numpy.pi, one)
    close(two, one, 1e-10 * one)


def a_run_ends_when_a_body_no_longer_turns():
    text = SPHEROID % ("uniaxial extension", 60, "Time: {final time: 20, steady tolerance: 1.0e-3}\n  Output: {interval: 20}")
    for settings in [], ["--set", "Output/power balance=true", "--set", "Solvers/rigid bodies=second kind"]:
        run(deck(text), *settings, "--output", "found", "--quiet", "--overwrite")
        check(series("found", "time")[-1] < 15 and series("found", "shape_velocity")[-1] < 1e-3 < series("found", "shape_velocity")[0], "it goes on")


def a_spheroid_tumbles_with_the_period_of_jeffery():
    exact = numpy.pi * (2 + 0.5)
    run(deck(SPHEROID % ("simple shear", 30, "Time: {tolerance: 1.0e-5}\n  Periodic: {period: 7.7, turn: 180, tolerance: 1.0e-4}")),
        "--output", "found", "--quiet")
    close(series("found", "period")[-1], exact, 1e-3 * exact, "half a period")


def powers_balance_around_one_body():
    """All power of the flow is dissipated in the fluid. For a sphere it is 20/3 pi mu R^3 E:E, with E:E = 1/2 in a
    shear of rate 1."""
    run(deck(ALONE % ("type: simple shear", "free", "Output: {power balance: true}")), "--output", "found", "--quiet")
    exact = 20 / 3 * numpy.pi / 2
    close(series("found", "flow_power")[-1], exact, 2e-3 * exact, "power of the flow")
    check(abs(series("found", "power_residual")).max() < 5e-3, series("found", "power_residual"))


def a_wall_pushes_a_body():
    """The repulsive force of the wall is compared with its integral over the sphere, where the gap is known at every
    point."""
    text = """Tanktread:
  Flow: {type: quiescent}
  Particle: {motion: free, radius: 0.6, center: [0, 0.2, 0.1]}
  Surface: {elements per side: 4}
  Tube: {radius: 1.0, azimuthal elements: 12, axial elements: 10, repulsion: 2.0, repulsion range: 0.1}
  Time: {final time: 0.02, fixed step: 0.01}
"""
    run(deck(text), "--output", "found", "--quiet")
    cosine, weight = numpy.polynomial.legendre.leggauss(40)
    turn = 2 * numpy.pi * (numpy.arange(80) + 0.5) / 80
    sine = numpy.sqrt(1 - cosine**2)[:, None]
    y, z = 0.2 + 0.6 * sine * numpy.cos(turn), 0.1 + 0.6 * sine * numpy.sin(turn)
    push = 2 * numpy.exp(-(1 - numpy.hypot(y, z)) / 0.1) / numpy.hypot(y, z) * weight[:, None] * 0.36 * 2 * numpy.pi / 80
    for component, exact in (2, -(push * y).sum()), (3, -(push * z).sum()):
        close(-series("found", f"drag_x{component}")[0], exact, 2e-3 * abs(exact), "push")
        check(series("found", f"velocity_x{component}")[0] < 0, "it moves towards the wall")


def series_of_a_prescribed_body_refer_to_the_current_flow():
    """The torque on a sphere at rest in a simple shear of rate a(t) is 8 pi mu R^3 a(t)/2."""
    told = "type: simple shear, history: {type: sine, mean: 1, amplitude: 0.5, frequency: 1}"
    run(deck(ALONE % (told, "prescribed", "")), "--output", "found", "--quiet")
    a = 1 + 0.5 * numpy.sin(2 * numpy.pi * series("found", "time"))
    torque = numpy.hypot(series("found", "torque_x1"), numpy.hypot(series("found", "torque_x2"), series("found", "torque_x3")))
    check(abs(torque / (4 * numpy.pi * a) - 1).max() < 5e-3, torque, 4 * numpy.pi * a)


def a_mesh_is_refined_for_a_body_that_does_not_deform():
    """A slender spheroid on a coarse mesh, for which the exact pressure is known."""
    text = """Tanktread:
  Flow: {type: quiescent}
  Particle: {motion: prescribed, shape: spheroid, semi-axes: [0.3, 0.3, 1.5], velocity: [0, 0, 1]}
  Surface: {elements per side: 3}
  Quadrature: {tolerance: 1.0e-6}
  Adaptation: {enabled: %s, load tolerance: 0.01}
"""
    for enabled in "false", "true":
        run(deck(text % enabled), "--output", enabled, "--quiet")
    check(series("true", "n_control_points")[-1] > 200, "nothing is refined")
    check(series("true", "pressure_l2_error")[-1] < 0.01 < series("false", "pressure_l2_error")[-1], "pressure")


main()
