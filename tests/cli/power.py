#!/usr/bin/python3
# Tests of Output/power balance: up to discretisation errors, the power of the ambient flow equals the dissipation plus
# the rate of change of the stored energy.
import numpy

from harness import check, close, deck, main, refused, run, series

CAPSULE = """
Tanktread:
  Flow: {type: simple shear}
  Particle: {viscosity ratio: 5.0}
  Membrane: {capillary number: 0.3}
  Surface: {elements per side: 4}
  Time: {final time: 1.0, tolerance: 1.0e-5}
  Output: {interval: 0.5, power balance: true}
"""


def the_power_of_a_sphere_without_tension_is_that_of_its_stresslet():
    deck(CAPSULE)
    run("deck.yaml", "--output", "drop", "--quiet")
    power = 2 * (4 * numpy.pi / 3) * 0.5 * 5 * (5 - 1) / (2 * 5 + 3)  # Taylor 1932, spherical drop
    close(series("drop", "flow_power")[0], power, 2e-4 * power, "the power of the flow")
    close(series("drop", "fluid_dissipation")[0], power, 2e-4 * power, "all of which is dissipated")


def power_that_is_not_dissipated_is_stored():
    deck(CAPSULE)
    errors = []
    for n in (4, 8):
        run("deck.yaml", "--output", f"mesh_{n}", "--quiet", "--set", f"Surface/elements per side={n}")
        errors.append(numpy.abs(series(f"mesh_{n}", "power_residual")).max())
    check(errors[0] < 2e-3 and errors[1] < errors[0] / 3, "the residual does not fall with the mesh", errors)
    time, power, heat, energy = (series("mesh_8", name) for name in ("time", "flow_power", "fluid_dissipation", "energy"))
    net = power - heat
    stored = ((net[1:] + net[:-1]) / 2 * numpy.diff(time)).sum()
    close(stored, energy[-1] - energy[0], 5e-3 * energy[-1], "the energy stored")


def a_steady_shape_stores_nothing():
    """A drop in a steady extensional flow, and a tank-treading capsule. Up to the discretisation error, all power of
    the flow is dissipated."""
    extension = CAPSULE.replace("simple shear", "uniaxial extension").replace("capillary number: 0.3", "law: surface tension, capillary number: 0.05")
    for name, text in ("drop", extension), ("capsule", CAPSULE.replace("ratio: 5.0", "ratio: 1.0")):
        deck(text.replace("Time: {final time: 1.0, tolerance: 1.0e-5}", "Steady: {tolerance: 1.0e-8}").replace("interval: 0.5, ", ""))
        errors = []
        for n in (4, 8):
            run("deck.yaml", "--output", f"{name}_{n}", "--quiet", "--set", f"Surface/elements per side={n}")
            errors.append(abs(series(f"{name}_{n}", "power_residual")[-1]))
        check(errors[0] < 2e-3 and errors[1] < errors[0] / 3, f"the residual of the {name} does not fall with the mesh", errors)
        power = series(f"{name}_8", "flow_power")[-1]
        close(series(f"{name}_8", "fluid_dissipation")[-1], power, 1e-3 * power, f"what the fluids dissipate around the {name}")


TUBE = """
Tanktread:
  Flow: {type: duct}
  Tube: {section: circle, azimuthal elements: 12, axial elements: 12}
  Particle: {radius: 0.7, center: [0.0, 0.0, 0.1], viscosity ratio: 5.0}
  Membrane: {capillary number: 0.1, pre-inflation: 0.05}
  Surface: {elements per side: 4}
  Time: {tolerance: 1.0e-5, final time: 0.1}
  Output: {interval: 0.1, power balance: true}
"""


def in_a_tube_the_pressure_drop_supplies_the_power():
    deck(TUBE, "tube.yaml")
    errors = []
    for n in (4, 8):
        run("tube.yaml", "--output", f"tube_{n}", "--quiet", "--set", f"Surface/elements per side={n}")
        errors.append(numpy.abs(series(f"tube_{n}", "power_residual")).max())
    check(errors[0] < 2e-3 and errors[1] < errors[0] / 3, "the residual does not fall with the mesh", errors)
    power, flow_rate = series("tube_8", "flow_power")[-1], numpy.pi
    close(power, flow_rate * series("tube_8", "disturbed_pressure_drop")[-1], 1e-12 * power, "what the pressure drop does")


COUETTE = """
Tanktread:
  Flow: {type: simple shear}
  Tube: {section: rectangle, sides: [8.0, 4.0], azimuthal elements: 24, axial elements: 12}
  Membrane: {law: surface tension, capillary number: 0.02}
  Surface: {elements per side: 6}
  Time: {final time: 0.4}
  Output: {interval: 0.2, power balance: true}
"""


def a_large_pressure_in_a_drop_does_not_change_the_power_balance():
    deck(COUETTE, "couette.yaml")
    # the pressure is a hundred times the viscous stress; its integrals have a relative error of 1e-4
    run("couette.yaml", "--output", "couette", "--quiet")
    lacks = numpy.abs(series("couette", "power_residual"))[1:]
    check(lacks.max() < 1e-3, "the quadrature of a uniform pressure counts as power", lacks)


def a_parabolic_flow_does_the_same_work_on_a_rigid_body_as_on_a_very_viscous_drop():
    """The traction of a rigid body (2.40), its double-layer density (2.23) and the velocity of a drop enter different
    terms of (6.11)."""
    text = """
Tanktread:
  Flow: {type: parabolic, half width: 2.0, maximum velocity: 2.0}
  Particle: {radius: 0.8, center: [0.0, 0.3, 0.5], %s
  Surface: {elements per side: 4}
  Output: {power balance: true}
  Time: {fixed step: 1.0e-4, final time: 1.0e-4}
"""
    powers = []
    for particle in ("motion: free}\n  Solvers: {rigid bodies: first kind}", "motion: free}\n  Solvers: {rigid bodies: second kind}",
                     "viscosity ratio: 1.0e+4}\n  Membrane: {law: neo-Hookean, capillary number: 0.3}"):
        run(deck(text % particle), "--output", "found", "--quiet", "--overwrite")
        powers.append(series("found", "flow_power")[0])
        check(abs(series("found", "power_residual")).max() < 1e-3, series("found", "power_residual"))
    check(max(powers) - min(powers) < 1e-3 * min(powers), powers)


def a_parabolic_flow_between_plates_is_the_flow_of_its_pressure_gradient():
    text = """
Tanktread:
  Flow: {type: quiescent, pressure gradient: [-1.0, 0.0, 0.0]}
  Domain: {periodic: x1 x2, side lengths: [5.0, 4.0, 1.0]}
  Wall: {point: [0.0, 0.0, -1.5], distance: 3.0, elements per period: 8}
  Particle: {radius: 0.8, center: [2.3, 0.1, 0.3], viscosity ratio: 2.0}
  Membrane: {law: neo-Hookean, shear modulus: 5.0}
  Surface: {elements per side: 3}
  Output: {power balance: true}
  Time: {scheme: bs3, fixed step: 1.0e-3, final time: 1.0e-3}
"""
    parabola = "type: parabolic, profile: plane, half width: 1.5, maximum velocity: 1.125"  # 1.5^2/2
    for name, flow in ("gradient", "type: quiescent, pressure gradient: [-1.0, 0.0, 0.0]"), ("parabola", parabola):
        run(deck(text.replace("type: quiescent, pressure gradient: [-1.0, 0.0, 0.0]", flow)), "--output", name, "--quiet")
    power = series("gradient", "flow_power")
    check(power.min() > 0.1 and abs(series("parabola", "flow_power") - power).max() < 1e-9, series("parabola", "flow_power"), power)


SPINDLE = """
Tanktread:
  Flow: {type: planar hyperbolic}
  Particle: {orientation: [20.0, 35.0, 50.0]}
  Membrane: {law: Skalak, area dilatation: 1.0, capillary number: 0.6}
  Surface: {elements per side: 6}
  Adaptation: {enabled: true, surface tolerance: 4.0e-4, levels: 2}
  Time: {final time: 1.1}
  Output: {interval: 0.5, power balance: true}
"""


def after_a_change_of_the_mesh_the_power_uses_the_new_velocity():
    deck(SPINDLE, "spindle.yaml")
    run("spindle.yaml", "--output", "spindle", "--quiet")
    points, lacks = series("spindle", "n_control_points"), numpy.abs(series("spindle", "power_residual"))
    check(points[-1] > points[0], "no refinement to look at", points)
    # it would be 5e-3 with the velocity of the previous mesh
    check(numpy.nanmax(lacks) < 1e-3, "a row has the loads of one mesh and the velocity of another", lacks)


def the_residual_of_powers_that_vanish_is_undefined():
    """On a spherical drop, the tension and the flow have no power, up to errors of quadrature."""
    sphere = CAPSULE.replace("ratio: 5.0", "ratio: 1.0").replace("capillary number: 0.3", "law: surface tension, surface tension: 2.0")
    run(deck(sphere, "sphere.yaml"), "--set", "Time/final time=0.02", "--set", "Output/interval=0.02", "--output", "sphere", "--quiet")
    residual = series("sphere", "power_residual")
    check(numpy.isnan(residual[0]) and (abs(residual[1:]) < 1e-3).all(), residual)


def mistakes_are_reported():
    deck(CAPSULE)
    refused(["Output/power balance", "strong"], "deck.yaml", "--set", "Membrane/load=strong")


main()
