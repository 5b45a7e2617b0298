#!/usr/bin/python3
# Tests of scenes on lattices: the same lattice described by other cells, several ranks, a tilt that is reduced by a
# period, resumed runs, rejected decks.
# ranks: 2
import pathlib

import h5py
import numpy

from harness import check, deck, difference, main, refused, run, series

DECK = """
Tanktread:
  Flow: {type: simple shear}
  Domain: {side lengths: [2.8, 2.8, 2.8]}
  Particles:
    defaults:
      viscosity ratio: 2.0
      Membrane: {law: neo-Hookean, capillary number: 0.3}
      Surface: {elements per side: 3}
    one: {center: [0.3, 0.2, 0.1]}
  Quadrature: {tolerance: 1.0e-6}
  Solvers: {tolerance: 1.0e-11}
  Time: {scheme: bs3, fixed step: 0.02, final time: 0.04}
"""
OF_ONE = "one/velocity_x1", "one/velocity_x2", "one/velocity_x3", "one/energy", "one/stresslet_13", "one/taylor_inertia"
OF_ALL = "relative_viscosity", "normal_stress_difference_1", "normal_stress_difference_2", "smallest_gap"


def _row(name, *more, names=OF_ONE + OF_ALL, ranks=1, **lists):
    run(deck(_with(**lists)), *more, "--output", name, "--quiet", ranks=ranks)
    return numpy.array([series(name, key)[-1] for key in names])


def _with(**lists):
    """Returns the text of the deck in which the given sections replace or extend the sections of DECK."""
    lines, keep = [], True
    for line in DECK.splitlines():
        if not line.startswith("   "):
            keep = not any(line.startswith(f"  {name}:") for name in lists)
        if keep:
            lines.append(line)
    return "\n".join(lines + [f"  {name}: {text}" for name, text in lists.items() if text]) + "\n"


def results_do_not_depend_on_the_cell_that_describes_a_lattice():
    one = _row("one")
    tilted = _row("tilted", Domain="{lattice vectors: [2.8, 0, 0, 0, 2.8, 0, 2.8, 0, 2.8]}")
    check(abs(tilted - one).max() < 1e-9, "a whole period of tilt:", tilted - one)
    two = _row("two", "--set", "Particles/two/center=[0.3, 3.0, 0.1]", Domain="{side lengths: [2.8, 5.6, 2.8]}")
    check(abs(two - one).max() < 1e-5, "two particles in a cell:", two - one)
    beyond = _row("beyond", "--set", "Particles/one/center=[0.3, 5.8, -2.7]")
    beyond[0] += 2.8
    check(abs(beyond - one).max() < 1e-8, "in another cell:", beyond - one)


def a_single_particle_equals_a_list_of_one_particle():
    """A deck with the section Particle gives the same run as a deck with the section Particles and one particle. Only
    the names of series differ, by the prefix of the particle. The runs agree to round-off, because the order of Eigen's
    sums depends on the alignment of vectors in memory."""
    free = DECK[DECK.index("    defaults"):DECK.index("  Quadrature")]
    for kind, keys, lists in (
        ("capsule", "center: [0.3, 0.2, 0.1], viscosity ratio: 2.0", {"Membrane": "{law: neo-Hookean, capillary number: 0.3}"}),
        ("free", "center: [0.3, 0.2, 0.1], motion: free, shape: spheroid, semi-axes: [1.0, 0.8, 0.8], torque: [0, 1, 0]", {}),
        ("prescribed", "center: [0.3, 0.2, 0.1], motion: prescribed, velocity: [0.1, 0, 0]", {}),
    ):
        lists["Surface"] = "{elements per side: 3}"
        inner = ", ".join([keys] + [f"{name}: {text}" for name, text in lists.items()])
        several = DECK.replace(free, f"    one: {{{inner}}}\n")
        single = DECK.replace("  Particles:\n" + free, f"  Particle: {{{keys}}}\n" + "".join(f"  {name}: {text}\n" for name, text in lists.items()))
        run(deck(several), "--output", f"list_{kind}", "--quiet")
        run(deck(single), "--output", kind, "--quiet")
        with h5py.File(f"list_{kind}/run.h5") as a, h5py.File(f"{kind}/run.h5") as b:
            expected, found = a["series"], b["series"]
            own = expected["one"]
            check(set(found) == set(expected) - {"one"} | set(own), kind, set(found) ^ (set(expected) | set(own)))
            for name in set(found) - {"wall_seconds"}:
                column = (own if name in own else expected)[name]
                check(difference(found[name][:], column[:], name) < 1e-13, kind, name, found[name][:], column[:])


def gaps_to_images_beyond_the_nearest_cells_are_found():
    """The long axis of the body points to its image one cell along x1 and two cells along x3. Up to the discretisation
    error at the tips, the tips have the distance |[2, 0, 4]| - 2 x 2.1 = 0.272. The smallest gap to an image in an
    adjacent cell is 0.532."""
    text = """
Tanktread:
  Flow: {type: quiescent}
  Domain: {side lengths: [2, 2, 2]}
  Particles:
    needle: {motion: free, shape: spheroid, semi-axes: [2.1, 0.2, 0.2], orientation: [0, -63.434949, 0], Surface: {elements per side: 6}}
  Time: {scheme: bs3, fixed step: 0.001, final time: 0.001}
"""
    run(deck(text), "--output", "needle", "--quiet")
    gap = series("needle", "smallest_gap")[0]
    check(abs(gap - (20**0.5 - 4.2)) < 5e-3, gap)


def ranks_agree():
    one, two = _row("on_one"), _row("on_two", ranks=2)
    check(abs(two - one).max() < 1e-10, two - one)


def reducing_the_tilt_by_a_period_does_not_change_the_result():
    fine = "--set", "Quadrature/tolerance=1e-8", "--set", "Time/final time=0.06"
    # the tilt of the cell is reduced by one period at time 0.05
    before = _row("before", *fine, Domain="{lattice vectors: [2.8, 0, 0, 0, 2.8, 0, 1.26, 0, 2.8]}")
    # the same lattice with the tilt already reduced
    after = _row("after", *fine, Domain="{lattice vectors: [2.8, 0, 0, 0, 2.8, 0, -1.54, 0, 2.8]}")
    check(abs(before - after).max() < 1e-8, before - after)


def snapshots_contain_the_lattice_vector_that_moves_a_particle_into_the_cell():
    _row("left", "--set", "Particles/one/center=[0.3, 5.8, -2.7]")
    cell = numpy.array([[series("left", f"cell_{k}_x{i}")[-1] for i in (1, 2, 3)] for k in (1, 2, 3)])
    check(abs(cell - [[2.8, 0, 0], [0, 2.8, 0], [0.04 * 2.8, 0, 2.8]]).max() < 1e-12, "not the sheared cell", cell)
    with h5py.File(sorted(pathlib.Path("left").glob("snapshot_*.hdf"))[-1]) as file:
        points, shift = file["VTKHDF/Points"][:], file["VTKHDF/PointData/into cell"][:]
    check(numpy.ptp(shift, 0).max() == 0 and abs(shift[0] - numpy.round(shift[0] @ numpy.linalg.inv(cell)) @ cell).max() < 1e-12, "no lattice vector", shift[0])
    middle = (points.min(0) + points.max(0)) / 2
    check(abs(middle[1] - 5.8) < 0.1 and (abs((middle + shift[0]) @ numpy.linalg.inv(cell)) < 0.51).all(), "not taken into the cell", middle, shift[0])


def a_resumed_run_has_the_lattice_of_its_checkpoint():
    run(deck(DECK), "--output", "whole", "--quiet", "--set", "Output/interval=0.02")
    run(deck(DECK), "--output", "parts", "--quiet", "--set", "Output/interval=0.02", "--set", "Time/final time=0.02")
    run("--resume", "parts", "--quiet", "--set", "Time/final time=0.04")
    for name in OF_ONE + OF_ALL:
        check(abs(series("whole", name) - series("parts", name)).max() < 1e-12, name)


def a_lattice_follows_a_rotating_flow():
    """A shear flow whose axes rotate at a constant rate about x2 is a steady flow in the rotating frame, where the
    rotation is subtracted from its gradient. The two particles differ in size, so that nothing is equal by symmetry.
    Both runs use the same steps; they differ by the time integration error of bs3 in the two frames."""
    rate, end = 5.0, 0.02
    pair = """{defaults: {viscosity ratio: 2.0, Membrane: {law: neo-Hookean, shear modulus: 3.0}, Surface: {elements per side: 3}},
              one: {center: [0.3, 0.2, 0.1]}, two: {center: [2.6, 0.1, 0.4], radius: 0.8}}"""
    names = "one/energy", "two/energy", "relative_viscosity", "smallest_gap", "one/smallest_tension"
    lists = {"Domain": "{side lengths: [5.0, 2.8, 2.8]}", "Particles": pair, "Time": f"{{scheme: bs3, fixed step: 0.005, final time: {end}}}"}
    angle = numpy.degrees(rate * end)
    changing = f"{{type: simple shear, history: {{times: [0, {end}], angles: [0, {angle}], axis: x2}}}}"
    text = _with(**lists, Flow=changing)
    run(deck(text), "--output", "turning", "--quiet")
    turn = rate * numpy.array([[0, 0, 1], [0, 0, 0], [-1, 0, 0]])
    gradient = [float(x) for x in (numpy.array([[0, 0, 1], [0, 0, 0], [0, 0, 0]]) - turn).ravel()]
    run(deck(text.replace(changing, f"{{type: linear, gradient: {gradient}}}")), "--output", "steady", "--quiet")
    for name in names:
        off = abs(series("turning", name) - series("steady", name)).max()
        # tolerance: quadrature error (Quadrature/tolerance is 1e-6), which depends on the orientation of the mesh
        check(off < 1e-5 * max(1, abs(series("steady", name)).max()), name, off)


def a_lattice_follows_an_oscillating_flow():
    """The position of a rigid body and the lattice depend only on the time integral of the amplitude. It is 0.04 in all
    three runs, which therefore end at the same state."""
    spheroid = "{motion: free, shape: spheroid, semi-axes: [1.2, 0.8, 0.8], center: [0.3, 0.2, 0.1]}"
    text = DECK[:DECK.index("  Particles")] + f"  Particle: {spheroid}\n" + DECK[DECK.index("  Quadrature"):]
    run(deck(text), "--output", "once", "--quiet")
    ways = {"table": "{times: [0, 0.04], amplitudes: [2, 0]}", "jump": "{times: [0, 0.02, 0.02], amplitudes: [3, 3, -1]}"}
    for name, history in ways.items():
        run(deck(text.replace("{type: simple shear}", f"{{type: simple shear, history: {history}}}")), "--output", name, "--quiet")
        for key in ("cell_3_x1", "cell_3_x3", "centroid_x1", "centroid_x3", "quaternion_2", "length_x3"):
            off = abs(series(name, key)[-1] - series("once", key)[-1])
            check(off < (1e-12 if "cell" in key else 1e-6), name, key, off)
    viscosity = series("table", "relative_viscosity")
    check(numpy.isnan(viscosity[-1]) and numpy.isfinite(viscosity[:-1]).all(), "not undefined where the flow rests:", viscosity)


def a_parabolic_flow_has_the_periods_of_its_lattice():
    """A particle that is shifted by a lattice vector has the same velocity. For a long period, the velocity tends to
    that of a single particle in unbounded fluid."""
    names = "one/velocity_x1", "one/velocity_x3", "one/energy", "one/stresslet_13"
    flow = "{type: parabolic, profile: plane, maximum velocity: 1.5, half width: 4.0}"
    cells = ("{periodic: x1, side lengths: [2.8, 1, 1]}", [2.8, 0]), ("{periodic: x1 x2, side lengths: [2.8, 3.0, 1]}", [5.6, -3.0])
    for number, (domain, shift) in enumerate(cells):
        here = _row(f"here{number}", names=names, Flow=flow, Domain=domain)
        centre = f"Particles/one/center=[{0.3 + shift[0]}, {0.2 + shift[1]}, 0.1]"
        there = _row(f"there{number}", "--set", centre, names=names, Flow=flow, Domain=domain)
        check(abs(there - here).max() < 1e-9, domain, there - here)
    alone = _row("alone", names=names, Flow=flow, Domain=None)
    far = [abs(_row(f"far{h}", names=names, Flow=flow, Domain=f"{{periodic: x1, side lengths: [{h}, 1, 1]}}") - alone).max() for h in (10, 20)]
    check(far[1] < 1e-2 and far[0] > 3 * far[1], "a long period is not that of one particle:", far)


def a_steady_shape_on_a_lattice_is_the_final_shape_of_a_run():
    """In a shear along the plane of a lattice with two periods, the cell does not deform. The search for a steady shape
    finds the shape that a run in time approaches. They differ by 6e-4, because their control points are at different
    positions, and by the time integration error."""
    drop = """{defaults: {viscosity ratio: 2.0, Membrane: {law: surface tension, capillary number: 0.2}, Surface: {elements per side: 4}},
             one: {center: [0.0, 0.0, 0.0]}}"""
    lists = {"Domain": "{periodic: x1 x2, side lengths: [2.8, 2.8, 1]}", "Time": "{tolerance: 1.0e-3, final time: 9.0}", "Particles": drop}
    names = "one/taylor_inertia", "one/inclination", "one/energy"
    end = _row("run", names=names, **lists)
    found = _row("found", names=names, **{**lists, "Steady": "{}"})
    check(abs(found / end - 1).max() < 2e-3, "not the same shape:", found, end)
    refused(["Steady", "simple shear", "changes in time"], deck(_with(Steady="{}")))


def a_particle_close_to_its_image_is_refused_at_the_start():
    text = DECK[:DECK.index("  Particles")] + "  Particle: {motion: free, radius: 1.38}\n  Contact: {limit: 0.03}\n" + DECK[DECK.index("  Time"):]
    refused(["Particle and its own image start too close to each other", "the gap is 0.04011, less than 0.0414", "Contact/limit"], deck(text))
    refused(["Domain is smaller than Particle,", "image"], deck(text), "--set", "Particle/radius=1.5")


def a_prescribed_body_keeps_its_velocity_outside_of_the_cell():
    """The flow has a gradient along the period, and one of the bodies is partly outside the cell. Two bodies with equal
    prescribed velocity keep their distance of 0.7."""
    body = "motion: prescribed, velocity: [0.5, 0.0, 0.2], Surface: {elements per side: 3}"
    deck(f"""
Tanktread:
  Flow: {{type: planar hyperbolic}}
  Domain: {{side lengths: [6.5, 3.7, 3.9]}}
  Particles:
    one: {{{body}, center: [0.55, 0.0, 0.0]}}
    two: {{{body}, center: [3.45, 0.0, 0.0], radius: 1.2}}
  Time: {{scheme: bs3, fixed step: 0.01, final time: 0.03}}
""")
    run("deck.yaml", "--output", "pair", "--quiet")
    gap = series("pair", "smallest_gap")
    check(abs(gap - gap[0]).max() < 1e-9, "the gap changes:", gap)


def the_relative_viscosity_is_undefined_when_an_oscillating_flow_pauses():
    """At the final time, rounding gives the amplitude sin(pi) the value 1e-16 instead of 0."""
    deck("""
Tanktread:
  Flow: {type: simple shear, history: {type: sine, frequency: 1}}
  Domain: {side lengths: [3.5, 3.5, 3.5]}
  Membrane: {law: surface tension, surface tension: 3}
  Surface: {elements per side: 3}
  Time: {final time: 0.5}
  Output: {interval: 0.25}
""")
    run("deck.yaml", "--output", "pauses", "--quiet")
    undefined = numpy.isnan(series("pauses", "relative_viscosity"))
    check(undefined[0] and undefined[-1] and not undefined[1:-1].any(), undefined)


def an_assembled_double_layer_on_a_lattice_is_named_as_a_key_without_effect():
    said = run(deck(DECK), "--check", "--set", "Solvers/double layer=assembled").stderr
    check("Solvers/double layer has no effect in a Domain without a tube" in said, said)


def decks_that_are_impossible_on_a_lattice_are_rejected():
    for lists, words in (
        ({"Flow": "{type: parabolic, half width: 3.0}"}, ["Domain", "parabolic", "same in every cell"]),
        ({"Flow": "{type: parabolic, profile: plane, half width: 3.0, history: {times: [0, 1], angles: [0, 9], axis: x2}}",
          "Domain": "{periodic: x1, side lengths: [2.8, 1, 1]}"}, ["Domain", "parabolic", "same in every cell"]),
        ({"Domain": "{side lengths: [1.9, 2.8, 2.8]}"}, ["Domain", "smaller", "Particles/one", "image"]),
        ({"Domain": "{lattice vectors: [2.8, 0, 0, 0, 2.8, 0, 2.8, 2.8, 0]}"}, ["Domain/lattice vectors", "no volume"]),
        ({"Domain": "{periodic: x1}"}, ["Domain", "side lengths"]),
        ({"Domain": "{side lengths: [2.8, -2.8, 2.8]}"}, ["Domain/side lengths", "positive"]),
        ({"Domain": "{side lengths: [2.8, 2.8, 2.8], lattice vectors: [1, 0, 0, 0, 1, 0, 0, 0, 1]}"}, ["contradict"]),
        ({"Flow": "{type: duct}", "Tube": "{section: circle, radius: 5.0}"}, ["Domain", "contradict"]),
        ({"Quadrature": "{rule: desingularised}"}, ["Domain", "desingularised"]),
    ):
        refused(words, deck(_with(**lists)))


def the_pressure_gradient_balances_the_weight_of_the_current_volume():
    run(deck("""
Tanktread:
  Flow: {type: quiescent, gravity: [0.2, 0, -1]}
  Domain: {side lengths: [4, 4, 4]}
  Particle: {density difference: 0.7, initial shape: {stretch: [1.5, 1, 0.8]}}
  Membrane: {law: surface tension, surface tension: 1}
  Volume: {constraint: none}
  Surface: {elements per side: 3}
  Quadrature: {tolerance: 1.0e-3}
  Time: {scheme: bs3, fixed step: 0.1, final time: 0.4}
"""), "--output", "out", "--quiet")
    volume, gradient = (series("out", name) for name in ("volume", "pressure_gradient_x3"))
    check(abs(volume[-1] / volume[0] - 1) > 1e-6, "the volume does not change", volume)
    check(abs(gradient / (-0.7 * volume / 64) - 1).max() < 1e-10, gradient, volume)


main()
