#!/usr/bin/python3
# Tests that a run ends when its shape is steady, although the membrane tank-treads and its mesh moves around the shape.
from harness import check, deck, main, run, series, summary

DECK = """
Tanktread:
  Flow: {type: simple shear}
  Membrane: {capillary number: 0.3}
  Surface: {elements per side: 4}
  Time: {final time: 15, steady tolerance: 5.0e-4}
  Output: {interval: 15}
"""


def a_tank_treading_capsule_is_steady_when_its_deformation_is():
    said = run(deck(DECK), "--output", "out", "--quiet").stderr
    check("steady at time" in said and summary("out")["status"] == "steady", said)
    times, d = series("out", "time"), series("out", "taylor_inertia")
    check(times[-1] < 10, f"found at {times[-1]} only")
    before = d[times > times[-1] - 1]  # values in the last unit of time
    check(abs(before - d[-1]).max() < 2e-3, before)
    check(series("out", "normal_velocity")[-1] > 5e-3, "the largest normal velocity would have told as well")


def a_run_is_not_steady_before_its_flow_starts():
    begins = "history: {times: [0, 0.5, 0.5], amplitudes: [0, 0, 1]}"
    text = DECK.replace("type: simple shear", f"type: simple shear, {begins}").replace("final time: 15", "final time: 1")
    run(deck(text), "--output", "late", "--quiet")
    check(series("late", "time")[-1] == 1 and series("late", "taylor_inertia")[-1] > 0.1, series("late", "time"), "ended at rest")
    sine = text.replace(begins, "history: {type: sine, frequency: 1}")
    check("changes in time" in run(deck(sine), "--check", code=2).stderr, "a flow that oscillates has no steady shape")


def a_shape_that_is_not_found_from_rest_is_approached_through_weaker_flows():
    """The capsule is in extension near the fold, which is at Ca = 0.507 on this mesh. From rest, the search takes more than
    25 iterations. The message lists the weaker flows that were used."""
    text = """
Tanktread:
  Flow: {type: uniaxial extension}
  Membrane: {law: neo-Hookean, capillary number: 0.5, pre-inflation: 0.05}
  Surface: {elements per side: 4}
  Quadrature: {tolerance: 1.0e-5}
  Steady: {tolerance: 1.0e-7}
"""
    found = run(deck(text), "--output", "near", "--set", "Steady/iterations=25").stdout
    check("steady shapes of the flow times" in found and "led to it" in found, found)
    near = series("near", "taylor_surface")[-1]
    run(deck(text), "--output", "start", "--quiet", "--set", "Membrane/capillary number=0.4")
    run(deck(text.replace("  Steady:", "  Particle: {initial shape: {run: start}}\n  Steady:")), "--output", "from", "--quiet")
    check(abs(near - series("from", "taylor_surface")[-1]) < 1e-5, near, series("from", "taylor_surface")[-1])
    few = ["--set", "Steady/tolerance=1e-8", "--set", "Steady/iterations=40", "--set", "Surface/elements per side=6"]
    slow = run(deck(text), "--output", "slow", *few).stdout  # a search that starts in a weaker flow does not reach 1e-8 in 40 iterations
    check("steady shapes of the flow times" in slow and "led to it" in slow, slow)
    beyond = run(deck(text), "--output", "beyond", "--set", "Membrane/capillary number=0.7", code=3)
    check("but none of the full flow" in beyond.stdout and "was not found" in beyond.stderr, beyond.stdout, beyond.stderr)


def a_compressed_membrane_is_found_by_shorter_steps():
    """A capsule without bending stiffness fills two thirds of a tube."""
    text = """
Tanktread:
  Flow: {type: duct}
  Tube: {radius: 1.5, azimuthal elements: 12, axial elements: 11}
  Membrane: {law: Skalak, capillary number: 0.1}
  Surface: {elements per side: 4}
"""
    found = run(deck(text + "  Steady: {}\n"), "--output", "steps").stdout
    check("with a tenth of this step" in found, found)
    run(deck(text + "  Time: {final time: 20, steady tolerance: 1.0e-5}\n"), "--output", "in_time", "--quiet")
    pairs = [(series(name, "length_x1")[-1], series(name, "velocity_x1")[-1]) for name in ("steps", "in_time")]
    check(all(abs(a / b - 1) < 1e-4 for a, b in zip(*pairs)), pairs)  # ten times the steady tolerance


SLACK = """
Tanktread:
  Flow: {type: duct}
  Tube: {section: rectangle, sides: [3.3333333333, 3.3333333333], azimuthal elements: 16, axial elements: 16}
  Membrane: {law: neo-Hookean, capillary number: 0.075}
  Surface: {elements per side: 4}
"""


def the_message_of_a_slack_membrane_names_remedies_that_work():
    said = run(deck(SLACK + "  Steady: {}\n"), "--output", "slack", "--quiet", code=3).stderr
    check("75 % of the membrane is compressed (to -0.13 G_s) with no resistance to bending" in said, said)
    check("pre-inflation" in said and "bending number" in said and "steady tolerance" in said, said)
    count = summary("slack")["counts"]["evaluations"]
    check(count <= 6 * 100, f"{count} velocities, more than in six searches of Steady/iterations: the searches do not end early")
    for key in ("pre-inflation=0.05", "bending number=0.01"):
        run(deck(SLACK + "  Steady: {}\n"), "--output", key, "--quiet", "--set", f"Membrane/{key}")
    run(deck(SLACK + "  Time: {final time: 20, steady tolerance: 1.0e-4}\n"), "--output", "in_time", "--quiet")
    check(summary("in_time")["status"] == "steady", summary("in_time")["status"])


def the_message_of_a_branch_of_slack_membranes_says_so():
    branch = "  Steady: {iterations: 30}\n  Continuation: {parameter: Membrane/capillary number, to: 0.1}\n"
    said = run(deck(SLACK + branch), "--output", "branch", "--quiet", code=3).stderr
    check("no steady shape was found at Membrane/capillary number = 0.075, because 75 % of the membrane is compressed" in said, said)


main()
