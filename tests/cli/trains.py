#!/usr/bin/python3
# ranks: 2
# Tests of periodic ducts: n particles in n periods move like one particle in one period; the position of the seam of
# the wall does not matter; rejected decks.
import math

from harness import check, deck, main, refused, run, series, summary

HEAD = """
Tanktread:
  Flow: {type: duct}
  Tube: {section: circle, azimuthal elements: 12, axial elements: 8, grading: 1, periodic length: 2.0}
  Time: {fixed step: 0.1, final time: 0.2}
  Quadrature: {tolerance: 1.0e-6}
  Output: {interval: 0.2}
"""
BODY = "Membrane: {law: neo-Hookean, capillary number: 0.1, pre-inflation: 0.05}, Surface: {elements per side: 3}"
ONE = HEAD + "  Particle: {radius: 0.4, center: [0.0, 0.0, 0.2]}\n" + "".join(f"  {part}\n" for part in BODY.replace("}, ", "}\n").splitlines())
NAMES = ("velocity_x1", "velocity_x3", "disturbed_pressure_drop", "stresslet_13")


def _several(n, ratio, shift=0.0):
    """Returns the deck of n particles in n periods. The first particle is shifted by `shift`."""
    centers = [2.0 * i - (n - 1) + (shift if i == 0 else 0) for i in range(n)]
    head = HEAD.replace("periodic length: 2.0", f"periodic length: {2.0 * n}").replace("axial elements: 8", f"axial elements: {8 * n}")
    return head + "  Particles:\n    defaults: {radius: 0.4, viscosity ratio: %d, %s}\n" % (ratio, BODY) + "".join(
        f"    p{i}: {{center: [{x}, 0.0, 0.2]}}\n" for i, x in enumerate(centers))


def _run(text, name, *settings, ranks=1):
    run(deck(text, f"{name}.yaml"), *[word for setting in settings for word in ("--set", setting)], "--output", name, "--overwrite", "--quiet", ranks=ranks)


def _one(*settings, viscosity_ratio=1, ranks=1, at=-1):
    _run(ONE, "one", *settings, f"Particle/viscosity ratio={viscosity_ratio}", ranks=ranks)
    return {name: series("one", name)[at] for name in NAMES}


def several_periods_agree_with_one():
    """The runs agree up to the accuracy of rounding and of the lattice sums, also after explicit steps."""
    steps = ("Time/scheme=bs3", "Time/fixed step=0.01", "Time/final time=0.02")
    for ratio in (1, 4):
        _run(_several(1, ratio), "p1", *steps)
        for n in (2, 3):
            _run(_several(n, ratio), f"p{n}", *steps)
            for i in range(n):
                for what in ("velocity_x1", "velocity_x3"):
                    off = series(f"p{n}", f"p{i}/{what}") - series("p1", f"p0/{what}")
                    check(abs(off).max() < 1e-7, f"{n} periods, ratio {ratio}, p{i}/{what}: {off}")
            off = series(f"p{n}", "disturbed_pressure_drop") / n - series("p1", "disturbed_pressure_drop")
            check(abs(off).max() < 1e-7, f"{n} periods, ratio {ratio}, pressure drop: {off}")


def trains_of_spheres_are_exact_to_one_part_in_a_hundred_thousand_with_default_keys():
    """Free spheres in a tube at a distance of 2.5 tube radii. The references are an exact multipole solution (radius
    0.5), and runs with n = 12 on walls of 36 x 36 and 48 x 56 elements."""
    text = """
Tanktread:
  Flow: {type: duct}
  Domain: {periodic: x1, side lengths: [2.5]}
  Tube: {}
  Particle: {radius: %g, motion: free}
  Time: {fixed step: 1.0e-3, final time: 1.0e-3}
"""
    for radius, velocity, pressure_drop in ((0.5, 1.67980599962, 0.521548970797), (0.8, 1.27523098, 7.670797)):
        _run(text % radius, "spheres")
        for name, exact in (("velocity_x1", velocity), ("disturbed_pressure_drop", pressure_drop)):
            off = series("spheres", name)[-1] / exact - 1
            check(abs(off) < 1e-5, f"radius {radius}, {name}: {off}")
        counts = summary("spheres")["counts"]
        # one solve for the velocity of the flow, and one for each unit force and torque; a recorded row needs none
        check(counts["velocity_solves"] == 7 * counts["evaluations"], f"solves are counted again: {counts}")


def a_particle_shifted_by_a_period_gives_the_same_result():
    _run(_several(2, 4), "here", "Time/scheme=bs3")
    _run(_several(2, 4, shift=4.0), "there", "Time/scheme=bs3")
    for name in ("p0/velocity_x1", "p1/velocity_x1", "p0/velocity_x3", "disturbed_pressure_drop"):
        off = series("there", name) - series("here", name)
        # the wall moves with the mean of both particles, so that its elements are at other positions
        check(abs(off).max() < 1e-6, f"{name}: {off}")


def a_domain_along_the_tube_sets_its_period():
    one = _one(viscosity_ratio=4)
    text = ONE.replace(", periodic length: 2.0", "").replace("  Time:", "  Domain: {periodic: x1, side lengths: [2.0]}\n  Time:")
    _run(text, "domain", "Particle/viscosity ratio=4")
    for name in NAMES:
        check(series("domain", name)[-1] == one[name], name)


def a_body_in_particle_and_in_particles_gives_the_same_result():
    """The sections Particle and Particles with one particle describe the same scene. By default the unknown is the
    traction in both."""
    for motion in ("free", "prescribed"):
        body = f"{{shape: sphere, radius: 0.4, motion: {motion}"
        _run(HEAD + f"  Particle: {body}}}\n  Surface: {{elements per side: 4}}\n", "particle", "Time/scheme=bs3")
        _run(HEAD + f"  Particles: {{ball: {body}, Surface: {{elements per side: 4}}}}}}\n", "list", "Time/scheme=bs3")
        for name in ("velocity_x1", "drag_x1", "centroid_x1"):
            check(abs(series("particle", name) - series("list", f"ball/{name}")).max() == 0, f"{motion}, {name}")
        check(abs(series("particle", "disturbed_pressure_drop") - series("list", "disturbed_pressure_drop")).max() == 0, motion)


def a_prescribed_flow_rate_and_its_pressure_drop_give_the_same_result():
    """The pressure gradient of the empty tube is 8 mu V/R^2. An empty tube with the total pressure drop of the tube
    with the particle is therefore faster by Delta p^D/(8 L), for mu = V = R = 1."""
    for ratio in (1, 4):
        settings = ["Time/scheme=bs3", "Time/fixed step=1e-4", "Time/final time=1e-4", f"Particle/viscosity ratio={ratio}",
                    "Membrane/shear modulus=1"]
        text = ONE.replace("capillary number: 0.1, ", "")
        _run(text, "rate", *settings)
        faster = 1 + series("rate", "disturbed_pressure_drop")[0] / 16
        _run(text, "drop", *settings, "Flow/held=pressure drop", f"Flow/mean velocity={faster}")
        check(abs(series("drop", "flow_rate")[0] / math.pi - 1) < 1e-7, f"flow rate {series('drop', 'flow_rate')[0]}")
        check(abs(series("drop", "velocity_x1")[0] - series("rate", "velocity_x1")[0]) < 1e-7, "velocity")


SPHERE = """
Tanktread:
  Flow: {type: duct}
  %s
  Particle: {radius: 0.7, motion: free}
  Surface: {elements per side: 3}
  Time: {scheme: bs3, fixed step: 1.0e-5, final time: 1.0e-5}
"""


def a_free_sphere_has_the_same_velocity_at_a_prescribed_flow_rate_and_pressure_drop():
    """The corrections of the pressure drop for collocation errors change the flow rate, if the pressure drop is
    prescribed. Without them, the velocities differ by 8e-5 in the tube and by 3e-4 in the channel. What remains is of
    second order in the corrections."""
    tube, square = "Tube: {length: 5.0, azimuthal elements: 12, axial elements: 14}", "section: rectangle, sides: [2.0, 2.0], profile: straight"
    channel = "Channel: {%s, azimuthal elements: 12, axial elements: 8}\n  Domain: {periodic: x1, side lengths: [3.0]}" % square
    for name, duct in ("tube", tube), ("channel", channel):
        text = SPHERE % duct
        _run(text, name)
        empty = series(name, "channel_pressure_drop")[0] if name == "channel" else 40
        faster = 1 + series(name, "disturbed_pressure_drop")[0] / empty
        _run(text, f"{name}_drop", "Flow/held=pressure drop", f"Flow/mean velocity={float(faster)!r}")
        for kind in "velocity_x1", "disturbed_pressure_drop":
            off = abs(series(f"{name}_drop", kind)[0] / series(name, kind)[0] - 1)
            check(off < 1e-5, f"{name}, {kind}: {off}")


CHANNEL = """
Tanktread:
  Flow: {type: duct}
  Channel: {section: circle, profile: constriction, depth: 0.3, half length: 2.0, azimuthal elements: 12}
  Domain: {periodic: x1, side lengths: [5.0]}
  Particle: {radius: 0.5, center: [-2.4, 0.0, 0.1], viscosity ratio: 4}
  Membrane: {law: neo-Hookean, capillary number: 0.1}
  Surface: {elements per side: 3}
  Quadrature: {tolerance: 1.0e-5}
  Time: {scheme: bs3, fixed step: 0.05, final time: 0.1}
"""


def a_periodic_channel_gives_the_same_result_across_its_seam():
    _run(CHANNEL, "inside")
    _run(CHANNEL.replace("[-2.4,", "[2.6,"), "beyond")
    for name in ("velocity_x1", "disturbed_pressure_drop", "gap", "stresslet_13"):
        off = series("inside", name) - series("beyond", name)
        check(abs(off).max() < 1e-10, f"{name}: {off}")
    by_flux, by_force, drop = (series("inside", name) for name in ("pressure_drop_by_flux", "pressure_drop_by_force", "disturbed_pressure_drop"))
    # discretisation error of this wall
    check(abs(by_flux - drop).max() < 5e-3 * drop.max(), f"by flux {by_flux}, {drop}")
    check(abs(by_force - drop).max() < 5e-3 * drop.max(), f"by force {by_force}, {drop}")


def the_power_balance_of_a_periodic_channel_is_the_same_on_two_ranks():
    # more than 64 points, so that ranks share the work
    short = ("Output/power balance=true", "Time/final time=0.05", "Surface/elements per side=4")
    for ranks in (1, 2):
        _run(CHANNEL, f"power_{ranks}", *short, ranks=ranks)
    one, two = (series(f"power_{ranks}", "power_residual") for ranks in (1, 2))
    check(abs(one - two).max() < 1e-9, f"power residual {one} and {two}")


def the_extra_pressure_drop_of_a_long_period_is_that_of_one_constriction():
    """The reference is the axisymmetric solution of tests/cli/channel_accuracy.py. On a wall with these elements, a
    channel with two ends has the same error."""
    _run(CHANNEL.replace("depth: 0.3", "depth: 0.5").replace("[5.0]", "[12.0]").replace("elements: 12", "elements: 16"), "long", "Time/final time=0.05")
    check(abs(series("long", "channel_extra_pressure_drop")[0] / 159.429662 - 1) < 2e-4, series("long", "channel_extra_pressure_drop")[0])


SPHERES = """
Tanktread:
  Flow: {type: duct}
  Tube: {section: circle, azimuthal elements: 16, axial elements: 16, periodic length: 2.5}
  Particles: {sphere: {radius: 0.5, motion: free, Surface: {elements per side: 4}}}
  Solvers: {rigid bodies: first kind}
  Quadrature: {tolerance: 1.0e-5}
  Time: {scheme: bs3, fixed step: 0.1, final time: 0.1}
"""


def spheres_solved_for_by_tractions_agree_with_multipoles():
    run(deck(SPHERES), "--output", "spheres", "--quiet")
    for name, exact, within in (("sphere/velocity_x1", 1.67980599962, 1e-5), ("disturbed_pressure_drop", 0.521548970797, 5e-5)):
        found = series("spheres", name)[0]
        check(abs(found / exact - 1) < within, f"{name}: {found}, not {exact}")
    run(deck(SPHERES), "--output", "on_two_ranks", "--quiet", ranks=2)
    off = series("on_two_ranks", "disturbed_pressure_drop") - series("spheres", "disturbed_pressure_drop")
    check(abs(off).max() < 1e-9, f"two ranks: {off}")


def a_body_far_from_the_origin_moves_like_one_at_the_origin():
    """Points at which the residual is computed coincide with nodes of the coarse quadrature, up to rounding errors."""
    text = SPHERES.replace("azimuthal elements: 16, axial elements: 16", "azimuthal elements: 8, axial elements: 6").replace("1.0e-5", "2.0e-3")
    text = text.replace("scheme: bs3, fixed step: 0.1, final time: 0.1", "final time: 1.0e-4")  # the first step is chosen from a trial
    found = {}
    for radius in (0.3, 0.5):
        for start in (0, 1000):
            where = "--set", f"Particles/sphere/radius={radius}", "--set", f"Particles/sphere/center=[{start}, 0, 0]"
            run(deck(text), *where, "--set", "Particles/sphere/Surface/elements per side=3", "--output", "far", "--quiet", "--overwrite")
            found[start] = series("far", "sphere/velocity_x1")
        off = abs(found[1000] - found[0]).max()
        check(off < 1e-6, f"radius {radius}: {off}")  # Solvers/tolerance limits the agreement


def ranks_give_the_same_result():
    one, two = _one(viscosity_ratio=4), _one(viscosity_ratio=4, ranks=2)
    for name in one:
        check(abs(one[name] - two[name]) < 1e-9 * max(1, abs(one[name])), f"{name}: {one[name]} {two[name]}")


def the_plan_states_the_periodic_tube_of_several_particles():
    pair = HEAD + "  Particles:\n    defaults: {radius: 0.4, %s}\n    one: {center: [-0.5, 0.0, 0.0]}\n    two: {center: [0.5, 0.0, 0.0]}\n" % BODY
    told = run(deck(pair, "pair.yaml"), "--check").stdout
    check(all(word in told for word in ("section `circle`", "one period of the wall", "unknowns of the traction")) and "unbounded" not in told, told)


def mistakes_are_reported():
    refused(["Tube/images", "0"], deck(ONE), "--set", "Tube/images=0")
    refused(["1e+09", "memory"], deck(ONE.replace("axial elements: 8, ", "")), "--set", "Tube/periodic length=1e9")
    refused(["Tube/periodic length", "Domain"], deck(ONE.replace("  Time:", "  Domain: {periodic: x1, side lengths: [2.0]}\n  Time:")))
    refused(["Tube/length", "Domain"], deck(ONE), "--set", "Tube/length=6")
    refused(["Domain/periodic `x2`", "Channel"], deck(CHANNEL), "--set", "Domain/periodic=x2")
    refused(["Channel/start", "two ends"], deck(CHANNEL), "--set", "Channel/start=-4")
    refused(["Channel/bend radius", "periodic"], deck(CHANNEL), "--set", "Channel/bend radius=3")
    refused(["period", "3", "as long"], deck(CHANNEL), "--set", "Domain/side lengths=[3.0]")


main()
