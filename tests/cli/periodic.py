#!/usr/bin/python3
# Tests of periodic motions: in a flow that is periodic in time, on adaptive meshes, and their Floquet exponents for
# disturbances of another parity.
from harness import check, close, deck, main, refused, run, series

DRIVEN = """Tanktread:
  Flow: {type: %s, history: {type: sine, mean: 0, amplitude: 1, frequency: 0.5}}
  Membrane: {law: neo-Hookean, capillary number: 0.2}
  Surface: {elements per side: 3}
  Time: {tolerance: 1.0e-5%s}
  %s
"""
SEARCH = "Periodic: {period: 2, tolerance: 1.0e-4}"


def a_driven_motion_is_that_which_a_run_settles_to():
    run(deck(DRIVEN % ("simple shear", "", SEARCH)), "--output", "found", "--quiet")
    run(deck(DRIVEN % ("simple shear", ", final time: 12", "Output: {interval: 12}")), "--output", "run", "--quiet")
    close(series("found", "period")[-1], 2, 0, "period")
    for name in "taylor_inertia", "energy":
        close(series("found", name)[-1], series("run", name)[-1], 1e-3, name)  # ten times Periodic/tolerance


def its_period_is_that_of_the_flow():
    refused(["Periodic/period", "multiple", "Flow/history"], deck(DRIVEN % ("simple shear", "", "Periodic: {period: 3.1}")), "--check")


def its_unit_of_time_is_that_of_the_deck():
    fast = DRIVEN.replace("type: %s,", "type: %s, shear rate: 1.0e+11,").replace("frequency: 0.5", "frequency: 0.5e+11")
    run(deck(DRIVEN % ("simple shear", "", SEARCH)), "--output", "slow", "--quiet")
    run(deck(fast % ("simple shear", "", SEARCH.replace("period: 2,", "period: 2.0e-11,"))), "--output", "fast", "--quiet")
    close(series("fast", "taylor_inertia")[-1], series("slow", "taylor_inertia")[-1], 1e-6, "D")


def its_exponents_are_decay_rates_where_the_flow_is_weak():
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


def a_mesh_is_adapted_to_the_shape_that_comes_back():
    more = SEARCH + "\n  Adaptation: {enabled: true, surface tolerance: 2.0e-4}"
    run(deck(DRIVEN % ("simple shear", "", more)), "--output", "found", "--quiet")
    run(deck(DRIVEN % ("simple shear", "", SEARCH)), "--set", "Surface/elements per side=8", "--output", "fine", "--quiet")
    check(series("found", "n_control_points")[-1] > 56, "nothing is refined")
    close(series("found", "taylor_inertia")[-1], series("fine", "taylor_inertia")[-1], 5e-4, "D")


main()
