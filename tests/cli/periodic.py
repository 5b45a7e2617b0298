#!/usr/bin/python3
# Tests of periodic motions: of capsules and drops in flows that are periodic in time, along tubes, between plates and on
# adaptive meshes, and their Floquet exponents for disturbances of any parity.
import math

from harness import check, close, deck, main, refused, run, series

DRIVEN = """Tanktread:
  Flow: {type: %s, history: {type: sine, mean: 0, amplitude: 1, frequency: 0.5}}
  Membrane: {law: neo-Hookean, capillary number: 0.2}
  Surface: {elements per side: 3}
  Time: {tolerance: 1.0e-5%s}
  %s
"""
SEARCH = "Periodic: {period: 2, tolerance: 1.0e-4}"


def the_periodic_motion_is_the_limit_of_a_run_in_time():
    run(deck(DRIVEN % ("simple shear", "", SEARCH)), "--output", "found", "--quiet")
    run(deck(DRIVEN % ("simple shear", ", final time: 12", "Output: {interval: 12}")), "--output", "run", "--quiet")
    close(series("found", "period")[-1], 2, 0, "period")
    for name in "taylor_inertia", "energy":
        close(series("found", name)[-1], series("run", name)[-1], 1e-3, name)  # ten times Periodic/tolerance


def the_period_is_that_of_the_flow():
    refused(["Periodic/period", "multiple", "Flow/history"], deck(DRIVEN % ("simple shear", "", "Periodic: {period: 3.1}")), "--check")


def the_period_is_in_the_unit_of_time_of_the_deck():
    fast = DRIVEN.replace("type: %s,", "type: %s, shear rate: 1.0e+11,").replace("frequency: 0.5", "frequency: 0.5e+11")
    run(deck(DRIVEN % ("simple shear", "", SEARCH)), "--output", "slow", "--quiet")
    run(deck(fast % ("simple shear", "", SEARCH.replace("period: 2,", "period: 2.0e-11,"))), "--output", "fast", "--quiet")
    close(series("fast", "taylor_inertia")[-1], series("slow", "taylor_inertia")[-1], 1e-6, "D")


def floquet_exponents_in_a_weak_flow_are_decay_rates():
    """In a weak flow, the Floquet exponents are the decay rates of a sphere at rest, for disturbances with the parity
    of the motion and with another parity."""
    weak = DRIVEN.replace("amplitude: 1,", "amplitude: 1.0e-3,")
    rest = """Tanktread:
  Flow: {type: quiescent}
  Membrane: {law: neo-Hookean, shear modulus: 5}
  Surface: {elements per side: 3}
  %s
"""
    for parity in "[1, 1, 1]", "[1, -1, 1]":
        spectrum = "Spectrum: {number: 4, parity: %s}" % parity
        run(deck(weak % ("uniaxial extension", "", SEARCH + "\n  " + spectrum)), "--output", "driven", "--quiet", "--overwrite")
        run(deck(rest % spectrum), "--output", "rest", "--quiet", "--overwrite")
        driven, at_rest = ([series(name, f"rate_{k}")[-1] for k in range(1, 5)] for name in ("driven", "rest"))
        # excludes the neutral modes: volume, translations, rotations
        decaying = [rate for rate in at_rest if rate < -0.1][:2]
        for rate in decaying:
            check(min(abs(rate - other) for other in driven) < 5e-3, parity, rate, driven)


def the_mesh_is_adapted_to_the_periodic_shape():
    more = SEARCH + "\n  Adaptation: {enabled: true, surface tolerance: 2.0e-4}"
    run(deck(DRIVEN % ("simple shear", "", more)), "--output", "found", "--quiet")
    run(deck(DRIVEN % ("simple shear", "", SEARCH)), "--set", "Surface/elements per side=8", "--output", "fine", "--quiet")
    check(series("found", "n_control_points")[-1] > 56, "nothing is refined")
    close(series("found", "taylor_inertia")[-1], series("fine", "taylor_inertia")[-1], 5e-4, "D")


PULSATING = """Tanktread:
  Flow: {type: %s, history: {type: sine, frequency: 1.0, amplitude: %s, mean: 1.0}}
  %s
  Membrane: {law: surface tension, surface tension: %s}
  %s
  Surface: {elements per side: %d}
  Quadrature: {tolerance: %s}
  Time: {tolerance: 1.0e-6%s}
  %s
"""


def floquet_exponents_in_a_weakly_pulsating_flow_are_growth_rates_of_the_steady_drop():
    """The tangential motion of mesh points along the interface is not a change of the shape."""
    surfactant = "Interface: {%s, surfactant: {equation of state: Langmuir, elasticity number: 0.2, coverage: 0.5, Peclet number: 10}}"
    for interface in "Interface: {relaxation: 0.5}", "Interface: {relaxation: 2}", surfactant % "relaxation: 0.5":
        text = PULSATING % ("uniaxial extension", "1.0e-6", "Particle: {shape: sphere}", "14.0", interface, 4, "1.0e-6", "", "Spectrum: {number: 8}")
        steady = text.replace(", history: {type: sine, frequency: 1.0, amplitude: 1.0e-6, mean: 1.0}", "") + "  Steady: {}\n"
        text += "  Periodic: {period: 1.0, tolerance: 1.0e-7}\n"
        run(deck(text), "--output", "periodic", "--quiet", "--overwrite")
        run(deck(steady), "--output", "steady", "--quiet", "--overwrite")
        rate = series("steady", "leading_rate")[-1]
        # errors of the time steps change the multiplier exp(rate) by about Time/tolerance divided by
        # Periodic/difference, 1e-4
        close(series("periodic", "leading_rate")[-1], rate, 5e-4 * math.exp(-rate), f"leading rate, {interface}")
        rates = [series("periodic", f"rate_{k}")[-1] for k in range(1, 9)]
        check(not any(rate < math.log(1e-4) for rate in rates), "hidden modes are not reported", rates)
        check("surfactant" in interface or math.isnan(rates[-1]), "all modes of a drop are above the errors of the steps")


def a_drop_in_pulsating_shear_has_a_periodic_motion():
    """The mesh points slide along the interface and do not return. The shape, surfactant and growth rates return."""
    surfactant = "Interface: {surfactant: {equation of state: Langmuir, elasticity number: 0.2, coverage: 0.5, Peclet number: 10}}"
    for interface, names, n in ("", ["taylor_inertia", "area"], 4), (surfactant, ["taylor_inertia", "area", "largest_concentration"], 6):
        text = PULSATING % ("simple shear", "0.5", "Particle: {shape: sphere}", "5.0", interface, n, "1.0e-4", "%s", "%s")
        run(deck(text % ("", "Periodic: {period: 1.0, tolerance: 1.0e-5}")), "--output", "found", "--quiet", "--overwrite")
        run(deck(text % (", final time: 8", "Output: {interval: 8.0}")), "--output", "run", "--quiet", "--overwrite")
        for name in names:
            close(series("found", name)[-1], series("run", name)[-1], 1e-3, name)  # other mesh points
        check(abs(series("found", "volume_error")[-1]) < 1e-12, "the volume is not that of the deck")
    slow = PULSATING % ("simple shear", "1.0e-3", "Particle: {shape: sphere}", "5.0", "", 4, "1.0e-6", "", "Spectrum: {number: 3}\n  %s")
    run(deck(slow % "Periodic: {period: 1.0, tolerance: 1.0e-5}"), "--output", "slow", "--quiet")
    run(deck((slow % "Steady: {}").replace(", history: {type: sine, frequency: 1.0, amplitude: 1.0e-3, mean: 1.0}", "")), "--output", "steady",
        "--quiet")
    # a mesh point slides by 1 % of R_C in a period
    close(series("slow", "leading_rate")[-1], series("steady", "leading_rate")[-1], 0.02, "leading rate")


def the_mesh_of_a_drop_in_an_oscillating_flow_returns():
    """The relaxation restores the mesh after every cycle. With the motion `normal`, D changes by 0.7 % from the fourth
    to the sixteenth cycle."""
    run(deck("""
Tanktread:
  Flow: {type: simple shear, history: {type: sine, frequency: 0.25}}
  Particle: {shape: sphere}
  Membrane: {law: surface tension, capillary number: 0.4}
  Surface: {elements per side: 3}
  Time: {final time: 64}
  Output: {interval: 16}
"""), "--output", "cycles", "--quiet")
    time = series("cycles", "time")
    for name, accuracy in ("taylor_inertia", 1e-3), ("inclination", 1e-3):  # of the time steps
        after = [series("cycles", name)[abs(time - at).argmin()] for at in (16, 64)]
        close(after[1], after[0], accuracy * abs(after[0]), name)


def a_drop_in_a_pulsating_tube_flow_has_a_periodic_shape_further_along_the_tube():
    """The search finds the shape and the mean velocity that a run approaches."""
    text = PULSATING % ("duct", "0.5", "Tube: {section: circle, periodic length: 6.0}", "6.0", "Particle: {shape: sphere, radius: 0.6}", 3, "1.0e-3",
                        "%s", "%s")
    run(deck(text % ("", "Periodic: {period: 1.0, tolerance: 1.0e-5}")), "--output", "found", "--quiet")
    run(deck(text % (", final time: 8", "Output: {interval: 1.0}")), "--output", "run", "--quiet")
    for name in "taylor_inertia", "area":
        close(series("found", name)[-1], series("run", name)[-1], 1e-4, name)  # ten times Periodic/tolerance
    at = series("run", "time")
    places = [x for t, x in zip(at, series("run", "centroid_x1")) if abs(t - round(t)) < 1e-9 and t > 6.5]
    close(series("found", "mean_particle_velocity_x1")[-1], places[-1] - places[-2], 1e-4, "mean velocity")


def positions_along_a_tube_meet_the_tolerance_of_time_steps():
    """In a flow that oscillates about zero, two rigid spheres on the axis of a tube return to their places."""
    text = """Tanktread:
  Flow: {type: duct, history: {type: sine, mean: 0.0, amplitude: 0.5, frequency: 1.0, phase: 40}}
  Tube: {radius: 1, azimuthal elements: 10}
  Particles:
    defaults: {Surface: {elements per side: 3}, motion: free}
    behind: {radius: 0.4, center: [-0.6, 0, 0]}
    ahead: {radius: 0.4, center: [0.6, 0, 0]}
  Time: {final time: 1.0, tolerance: 1.0e-4}
  Output: {interval: 1}
"""
    run(deck(text), "--output", "tube", "--quiet")
    for name, place in ("behind", -0.6), ("ahead", 0.6):
        close(series("tube", f"{name}/centroid_x1")[-1], place, 1e-3 * 0.4, name)  # ten tolerances, times the radius


def a_capsule_between_plates_moves_periodically():
    """The mean velocities of the fluid and of the particles are series of different names."""
    text = """Tanktread:
  Flow: {type: quiescent, pressure gradient: [-1, 0, 0], history: {type: sine, mean: 1.0, amplitude: 0.5, frequency: 1.0}}
  Domain: {periodic: x1 x2, side lengths: [3, 3, 1]}
  Wall: {point: [0, 0, -1], distance: 2, elements per period: 6}
  Particle: {radius: 0.5}
  Membrane: {law: Skalak, shear modulus: 2, pre-inflation: 0.05}
  Surface: {elements per side: 3}
  Time: {tolerance: 1.0e-4%s}
  %s
"""
    run(deck(text % ("", "Periodic: {period: 1.0, tolerance: 1.0e-4}")), "--output", "plates", "--quiet")
    run(deck(text % (", final time: 6", "Output: {interval: 1.0}")), "--output", "plates_run", "--quiet")
    places = [x for t, x in zip(series("plates_run", "time"), series("plates_run", "centroid_x1")) if abs(t - round(t)) < 1e-9]
    close(series("plates", "mean_particle_velocity_x1")[-1], places[-1] - places[-2], 1e-3, "mean velocity of the capsule")
    check(series("plates", "mean_velocity_x1")[-1] > 0, "the fluid moves")


main()
