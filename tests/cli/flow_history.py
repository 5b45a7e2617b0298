#!/usr/bin/python3
# Tests of Flow/history: a table from a file gives the same run as a table in the deck and is copied to the results; a
# wrong table is rejected in one sentence; a history in a tube.
import pathlib

import numpy

from harness import check, close, deck, main, run, series

SHEAR = """Tanktread:
  Flow: {type: simple shear, history: {%s}}
  Membrane: {law: Skalak, capillary number: 0.3}
  Surface: {elements per side: 3}
  Time: {final time: 0.4}
  Output: {interval: 0.2}
"""
TUBE = """Tanktread:
  Flow: {type: duct, mean velocity: %g%s}
  Particle: {radius: 0.6%s}
  %s
  Surface: {elements per side: 3}
  Tube: {radius: 1.0, azimuthal elements: 8, axial elements: 6}
  Time: {final time: %g}
"""
CAPSULE = "Membrane: {law: Skalak, shear modulus: 5.0}"
OVER_MEAN_VELOCITY = ("cap_velocity", "disturbance_flux", "force_imbalance", "normal_velocity", "shape_velocity")  # that at amplitude 1
IN_LISTS = "times: [0, 0.15, 0.15], amplitudes: [0.5, 1.5, -1]"
IN_FILE = "# measured\ntime, amplitude\n0, 0.5\n\n 0.15, 1.5  # the pump stops\n0.15, -1\n"


def _row(results):
    """Returns the last row of the series, without the series that depend on the speed of the machine."""
    import h5py

    with h5py.File(pathlib.Path(results) / "run.h5", "r") as file:
        return {name: values[-1] for name, values in file["series"].items() if name != "wall_seconds"}


def _same(one, other, tolerance=0.0, but=()):
    for name, value in _row(one).items():
        # NaN in both: two semi-axes are equal, so that the direction is undefined
        undefined = value != value and _row(other)[name] != _row(other)[name]
        if name not in but and not undefined:
            close(_row(other)[name], value, tolerance * max(1, abs(value)), f"{name} of {other}")


def a_table_from_a_file_gives_the_same_run_as_one_in_the_deck():
    run(deck(SHEAR % IN_LISTS), "--output", "lists", "--quiet")
    pathlib.Path("beside").mkdir()
    pathlib.Path("beside/pump.csv").write_text(IN_FILE)
    run(deck(SHEAR % "file: pump.csv", "beside/deck.yaml"), "--output", "file", "--quiet")
    _same("lists", "file")
    turning = IN_LISTS + ", angles: [0, 45, 90]"
    run(deck(SHEAR % turning), "--output", "turning", "--quiet")
    pathlib.Path("turning.csv").write_text("0,0.5,0\n0.15,1.5,45\n0.15,-1,90\n")
    run(deck(SHEAR % "file: turning.csv"), "--output", "turning_file", "--quiet")
    _same("turning", "turning_file")
    check(_row("turning") != _row("lists"), "angles turn nothing")


def the_intrinsic_viscosity_refers_to_the_current_flow():
    steps = "  Time: {scheme: bs3, fixed step: 0.1, final time: 0.2}\n"
    head = "Tanktread:\n  Flow: {type: simple shear, history: {times: [0, 0.2], amplitudes: [0.5, %s]}}\n"
    deck(head % 0.0 + steps + "  Particle: {motion: free}\n  Surface: {elements per side: 4}\n", "only.yaml")
    deck(head % 1e-17 + steps + "  Particles: {ball: {motion: free, Surface: {elements per side: 4}}}\n", "coupled.yaml")
    for name, prefix in ("only", ""), ("coupled", "ball/"):
        run(f"{name}.yaml", "--output", name, "--quiet")
        found = series(name, prefix + "intrinsic_viscosity")
        check(abs(found[:-1] - 2.5).max() < 0.01 and numpy.isnan(found[-1]), f"{name}: {found}")  # NaN: no flow at the end


def a_resumed_run_uses_its_copy_of_the_table():
    pathlib.Path("pump.csv").write_text(IN_FILE)
    run(deck(SHEAR % "file: pump.csv"), "--output", "whole", "--quiet")
    run(deck(SHEAR % "file: pump.csv"), "--output", "part", "--quiet", "--set", "Time/final time=0.2")
    pathlib.Path("pump.csv").write_text("0, 7\n")
    run("--resume", "part", "--quiet", "--set", "Time/final time=0.4")
    _same("whole", "part")


def wrong_tables_are_rejected():
    wrong = {"": "no numbers", "time, amplitude\n": "no row", "0\n": "1 number", "0,1,2,3\n": "4 numbers", "0,1\n1,2,3\n": "line 2", "0,1\n1,2,\n2,b\n": "\"b\" is not a number",
             "0,nan\n": "not a number", "1,1\n0,1\n": "line 2: times must", "-1,1\n": "line 1: times must", "time,angle\n0,1\n": "columns are time, angle; expected",
             "0,1e99\n": "not a number", "time (s),amplitude\n0,1\n": "no section Units"}
    for text, words in wrong.items():
        pathlib.Path("wrong.csv").write_text(text)
        said = run(deck(SHEAR % "file: wrong.csv"), "--check", code=2).stderr
        check(said.count("\n") == 1 and 'Flow/history/file "wrong.csv"' in said and words in said, repr(text), said)
    pathlib.Path("good.csv").write_text("0,1\n")
    for more, words in (("times: [0]", "Flow/history/times contradict"), ("angles: [0]", "Flow/history/angles contradict"), ("type: sine, frequency: 1", "`table`"),
                        ("axis: x3", "Flow/history/axis needs")):
        said = run(deck(SHEAR % f"file: good.csv, {more}"), "--check", code=2).stderr
        check(said.count("\n") == 1 and "Flow/history" in said and words in said, more, said)


def in_a_tube_the_amplitude_scales_the_mean_velocity():
    for name, particle, made_of in (("capsule", "", CAPSULE), ("viscous", ", viscosity ratio: 3", CAPSULE), ("free", ", motion: free, center: [0, 0, 0.1]", "Output: {}")):
        run(deck(TUBE % (2, "", particle, made_of, 0.2)), "--output", f"{name}_steady", "--quiet")
        run(deck(TUBE % (1, ", history: {times: [0], amplitudes: [2]}", particle, made_of, 0.2)), "--output", f"{name}_twice", "--quiet")
        _same(f"{name}_steady", f"{name}_twice", 1e-9, OVER_MEAN_VELOCITY)


def in_a_tube_a_run_may_start_at_zero_amplitude_and_a_prescribed_pressure_drop_scales_with_the_amplitude():
    sine = ", history: {type: sine, frequency: 1.0}"  # zero at the start
    run(deck(TUBE % (1, sine, ", motion: free, center: [0, 0, 0.1]", "Output: {interval: 0.1}", 0.1)), "--output", "sine", "--quiet")
    drop = series("sine", "disturbed_pressure_drop")
    check(drop[0] == 0 and drop[-1] > 0, drop)
    half = ", held: pressure drop, history: {times: [0], amplitudes: [0.5]}"
    run(deck(TUBE % (1, half, "", CAPSULE, 0.02)), "--output", "half", "--quiet")
    run(deck(TUBE % (0.5, ", held: pressure drop", "", CAPSULE, 0.02)), "--output", "of_half", "--quiet")
    close(series("half", "flow_rate")[-1], series("of_half", "flow_rate")[-1], 1e-9, "flow rate at half the amplitude")


def a_capsule_in_a_tube_whose_flow_stops_comes_to_rest():
    history = ", history: {times: [0, 0.5, 0.5], amplitudes: [1, 1, 0]}"
    run(deck(TUBE % (1, history, ", center: [0, 0, 0.1]", CAPSULE, 2.0)), "--output", "stops", "--quiet")
    time, energy, velocity = (series("stops", name) for name in ("time", "energy", "velocity_x1"))
    while_it_flows = time < 0.49
    check(velocity[while_it_flows].min() > 0.5 and abs(velocity[-1]) < 4e-3, velocity)
    relaxing = energy[time > 0.51]
    check((numpy.diff(relaxing) < 0).all() and relaxing[-1] < 0.2 * relaxing[0], relaxing)
    drop = series("stops", "disturbed_pressure_drop")
    check(abs(drop[-1]) < 0.05 * abs(drop[while_it_flows][-1]), drop)


def an_initial_shape_in_a_tube_reaches_the_same_steady_shape_as_the_resting_shape():
    text = TUBE % (1, "", "%s", CAPSULE, 3)
    run(deck(text % ""), "--output", "resting", "--quiet")
    run(deck(text % ", initial shape: {stretch: [1.2, 0.9, 0.95]}"), "--output", "stretched", "--quiet")
    close(series("stretched", "volume")[0], series("resting", "volume")[0], 1e-9, "volume")
    for name in "taylor_inertia", "length_x1", "length_x2":
        (first, last), (rest, end) = ((series(run, name)[0], series(run, name)[-1]) for run in ("stretched", "resting"))
        check(abs(first - rest) > 0.08 and abs(last - end) < 0.04 * abs(first - rest), name, first, last, rest, end)
    run(deck(text % ", initial shape: {run: resting}"), "--output", "goes_on", "--quiet", "--set", "Time/final time=0.05")
    close(series("goes_on", "taylor_inertia")[0], series("resting", "taylor_inertia")[-1], 1e-9, "taylor_inertia of the other run")


def an_initial_shape_that_does_not_fit_into_its_tube_is_rejected():
    for shape in "stretch: [1, 2, 1], volume: own", "stretch: [0.2, 2.5, 2]", "map: [1, 0, 0, 0, 1, 0, 0, 2, 1]":
        said = run(deck(TUBE % (1, "", f", initial shape: {{{shape}}}", CAPSULE, 1)), "--output", "through", "--quiet", code=2).stderr
        check(said.count("\n") == 1 and "does not fit into the tube" in said, said)


main()
