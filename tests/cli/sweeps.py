#!/usr/bin/python3
# ranks: 2
# Tests of the module tanktread, which runs decks and evaluates surfaces, and of sweeps: a sweep writes its table even
# if runs fail, and an interrupted sweep is resumed.
import csv
import os
import pathlib
import signal
import subprocess
import sys
import time
from unittest import mock

import h5py
import numpy

from harness import PROGRAM, SOURCE, check, close, deck, main, package, run

os.environ["TANKTREAD"] = str(PROGRAM)
sys.path.append(str(SOURCE / "postproc"))
import tanktread
from tanktread.interpolation import interpolated

DECK = """
Tanktread:
  Flow: { type: simple shear }
  Membrane: { law: neo-Hookean, capillary number: 0.3 }
  Surface: { elements per side: 3 }
  Time: { final time: 0.5 }
  Output: { interval: 0.5 }
"""
STUDY = """
deck: deck.yaml
grid: {Membrane/capillary number: {from: 0.1, to: 0.4, number: 3}, Time/scheme: [bs3, tr-bdf2]}
record: {D: taylor_inertia, top: {series: area, take: largest}, D(t): {series: taylor_inertia, take: all}}
"""


def _sweep(*arguments, code=0):
    result = package("sweep", *arguments)
    check(result.returncode == code and "Traceback" not in result.stderr, result.stdout, result.stderr)
    return result.stdout + result.stderr


def _rows(path="results/study/table.csv"):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def particles_that_are_stuck_are_distinguished_from_slow_ones():
    from tanktread.studies import critical
    t = numpy.linspace(0, 30, 301)
    check(critical.stays(t, 1 - numpy.exp(-t), 1, 1), "it came to rest")
    check(critical.stays(t, 1.4e-3 * numpy.sin(numpy.pi * (t / 2 - 0.75)), 1, 1), "it rests, but for what integrals leave")
    check(critical.stays(t, 0.01 * t, 1, 1) is None, "it creeps on")
    check(critical.stays(t, 1.3e-5 * t**2, 1, 1) is None, "it is slow and grows faster")
    check(critical.stays(t, 0.0005 * numpy.maximum(t - 25, 0), 1, 1) is None, "it is slow and sets off")
    check(critical.stays(t[:50], 0 * t[:50], 1, 1) is None, "nobody looked for long enough")
    refused = package("critical", "deck.yaml", "--between", "2", "1", "--past", "0")
    check(refused.returncode == 2 and "ascend" in refused.stderr, refused.stderr)


def both_bounds_of_a_critical_value_are_runs():
    from tanktread.studies import critical
    runs = []
    with mock.patch.object(critical, "stays_at", lambda parsed, study, value: runs.append(value) or value < 1.2):
        found = package("critical", "deck.yaml", "--between", "1", "2", "--past", "0", "--within", "0.1")
        critical.common.edge(lambda value: critical.stays_at(None, None, value), 1, 2, 1.1)
        low, high = (f"{end:.5g}" for end in (max(value for value in runs if value < 1.2), min(value for value in runs if value > 1.2)))
        check(found.stdout == f"critical Flow/mean velocity: {low} (stays) to {high} (passes)\n", found.stdout, found.stderr, runs)
        for ends, said in (("1.3", "2"), "the particle passes at 1.3: give --between a smaller"), (("1", "1.1"), "the particle stays at 1.1: give --between a larger"):
            found = package("critical", "deck.yaml", "--between", *ends, "--past", "0")
            check(found.returncode == 2 and said in found.stderr, found.stderr)


def the_atlas_finds_the_largest_step_of_a_scheme():
    with mock.patch.object(sys, "path", [str(SOURCE / "tests/benchmark"), *sys.path]):
        from edges_of_methods import largest_step
    limit, steps = 2.51 / (2 * 4 / 0.3), []
    for stable, expected in (1.5, "edge"), (20, "holds to here"), (0.1, "fails from here"):
        end = {"taylor_inertia": 1, "energy": 1}
        made = mock.Mock(run=lambda deck, given: mock.Mock(done=not steps.append(step := given.get("Time/fixed step", 0)) and step <= stable * limit, final=end))
        step, how = largest_step(made, {"Surface/elements per side": 4}, "bs3")
        check(how == expected and step in steps and (expected != "edge" or step <= 1.5 * limit < 1.1 * step), stable, step / limit, how)


def tumbling_and_tank_treading_are_distinguished_by_shape_and_membrane():
    from tanktread.studies import phases
    t = numpy.linspace(0, 40, 801)
    shape = 360 * t / 22  # the shape makes half a turn in a time of 11, in the same sense as the phase
    swung = 20 * numpy.sin(t)

    def told(inclination, phase):
        return phases.in_shear({"time": t, "inclination": (inclination + 90) % 180 - 90, "phase": phase}, 0.4)[0]

    check(told(-shape, shape + swung) == "tumbles", "its membrane swings on it")
    check(told(20 + swung, shape) == "treads", "its shape swings")
    check(told(-shape, 2 * shape) == "both", "its membrane goes around on it")
    check(told(-numpy.maximum(shape, 550), 2 * shape) == "both", "it turns over as the run ends")
    check(told(20 + swung, swung) is None, "nothing went around")
    check(told(-numpy.maximum(shape, 200), numpy.maximum(shape, 200) + swung) == "tumbles", "late")
    check(told(-numpy.minimum(shape, 200), shape) == "treads", "it has stopped tumbling")
    round_at_first = numpy.where(t < 1, numpy.nan, 0)
    check(told(round_at_first - shape, shape + swung) == "tumbles" and told(round_at_first + 20, shape) == "treads", "a sphere has no inclination")
    check(told(numpy.nan * t, shape) is None, "it stays a sphere")


def slipping_and_parachutes_are_distinguished_by_the_asymmetry_of_the_cell():
    from tanktread.studies import phases
    t = numpy.linspace(0, 160, 81)
    fading, growing = numpy.exp(-0.02 * t), numpy.exp(0.02 * t)

    def told(offset, tilt, prolate=False, swollen=1.0):
        series = {"time": t, "centroid_x2": 0 * t, "centroid_x3": offset * swollen + 0 * t, "volume": 4 / 3 * numpy.pi * swollen**3 + 0 * t,
                  "taylor_inertia": 0.3 + 0 * t, "inclination": tilt + (0 if prolate else 90) - (0 if prolate else 180) * (tilt > 0)}
        return phases.in_capillary(series, 0.4)

    check(told(-0.03 * fading, 2 * fading)[0] == "parachute", "it comes back to the axis")
    check(told(0, -2 * fading)[0] == told(0, 2 * fading, True)[0] == "parachute", "longer across the tube, and along it")
    check(told(0.002 * growing, 0.1 * growing)[0] == "slips", "it leaves the axis")
    check(told(0 * t, 0.1 * growing)[0] == told(0.002 * growing, 0 * t, True)[0] == "slips", "it turns away from it; it only leaves it")
    check(told(0.06 * (1 + numpy.sin(t)), 0 * t)[0] == "slips", "it swings about it")
    check(told(0.02, 2 + 0 * t)[0] == "parachute", "it stays a little askew")
    check(told(0.02, numpy.nan * t)[0] == "parachute" and told(0.2, numpy.nan * t)[0] == "slips", "a sphere has no inclination")
    check(told(0.2, 20 + 0 * t)[0] == "slips" and told(0.08, 0 * t, swollen=3)[0] == "parachute", "it stays beside it; in any unit of length")
    check(told(0.0002 * growing, 0 * t)[0] == "parachute", "that is its mesh")
    check(told(0.15 * numpy.exp(-((t - 112) / 8)**2), 0 * t)[0] == "slips", "it turned over in between")
    check(told(2 * fading**4, 60 * fading**4)[0] == "parachute", "a start that is far from it is not looked at")
    for askew, after in zip(told(0.03 * fading, 0 * t)[1:], (64, 128)):
        close(askew, 0.03 * numpy.exp(-0.02 * after), 2e-4, "the largest one in the first and the last third of the rest")


def a_border_is_found_near_the_previous_one_and_elsewhere():
    from tanktread.studies import phases
    deck(DECK)
    deck("""
deck: deck.yaml
along: {key: Flow/shear rate, from: 1e-2, to: 10, within: 1.1}
across: {Particle/viscosity ratio: [1, 2, 3, 4, 5]}
curves: {one: {}, other: {Particle/viscosity ratio: [1], Membrane/law: [Skalak]}}
""", "phases.yaml")
    diagram = phases.Diagram("phases.yaml", None)
    at = {1: 0.3, 2: 0.33, 3: 2.0, 4: 0.001, 5: 100.0}

    def holds(name, row, value):
        below = value < at[row["Particle/viscosity ratio"]]
        diagram.made[name, row["Particle/viscosity ratio"], value] = ("tumbles" if below else "treads",)
        return below

    diagram.holds = holds
    diagram.find()
    rows = diagram.borders["one"]
    check([row[3] for row in rows] == ["edge"] * 3 + ["treads from here", "tumbles to here"], rows)
    check(numpy.isnan(rows[3][1]) and rows[3][2] == 0.01 and rows[4][1] == 10 and numpy.isnan(rows[4][2]), rows)
    check(all(row[1] < at[row[0]] <= row[2] < 1.11 * row[1] for row in rows[:3]), rows)
    made = [sum(key[0] == "one" and key[1] == x for key in diagram.made) for x in at]
    check(made[1] <= 6 < made[0], f"runs of each border: {made}")
    check(diagram.rows["other"] == [{"Particle/viscosity ratio": 1, "Membrane/law": "Skalak"}], diagram.rows)
    deck("deck: deck.yaml\nalong: {key: A/a, from: 2, to: 1, within: 1.1}\nacross: {A/b: [1]}\ncurves: {one: {}}\n", "wrong.yaml")
    refused = package("phases", "wrong.yaml")
    check(refused.returncode == 2 and "ascend" in refused.stderr and len(refused.stderr.splitlines()) == 1, refused.stderr)
    deck("deck: deck.yaml\nmotion: rolling\nalong: {key: A/a, from: 1, to: 2, within: 1.1}\nacross: {A/b: [1]}\ncurves: {one: {}}\n", "wrong.yaml")
    refused = package("phases", "wrong.yaml")
    check(refused.returncode == 2 and "shear or capillary, not rolling" in refused.stderr and len(refused.stderr.splitlines()) == 1, refused.stderr)
    for words, said in (("begin: half", "half is not a number"), ("begin: 2", "less than 1"), ("literature: {paper: [1, 2]}", "paper, 1 of the list must be a list"), ("set: 3", "section of keys")):
        deck(f"deck: deck.yaml\nalong: {{key: A/a, from: 1, to: 2, within: 1.1}}\nacross: {{A/b: [1]}}\ncurves: {{one: {{}}}}\n{words}\n", "wrong.yaml")
        refused = package("phases", "wrong.yaml")
        check(refused.returncode == 2 and said in refused.stderr and len(refused.stderr.splitlines()) == 1, refused.stderr)


def a_phase_diagram_without_a_border_gives_a_table_and_a_sentence():
    deck(DECK)
    deck("deck: deck.yaml\nalong: {key: Flow/shear rat, from: 1, to: 2, within: 1.1}\nacross: {Particle/radius: [1]}\ncurves: {one: {}}\n", "phases.yaml")
    ended = package("phases", "phases.yaml")
    check(ended.returncode == 2 and "no border was found" in ended.stderr and len(ended.stderr.splitlines()) == 1, ended.stderr)
    check("shear rat" in pathlib.Path("results/phases/borders.csv").read_text(), "why there is none")


def a_diagram_over_values_that_are_not_positive_is_drawn():
    from tanktread.studies import phases
    deck(DECK)
    deck("deck: deck.yaml\nalong: {key: A/a, from: 1, to: 20, within: 1.1}\nacross: {A/b: [-1, 0, 1]}\ncurves: {one: {}}\n", "phases.yaml")
    diagram = phases.Diagram("phases.yaml", None)
    diagram.borders["one"] = [(b, 3.0 + b, 3.2 + b, "edge") for b in (-1, 0, 1)]
    axes = diagram.draw().axes[0]
    check(axes.get_xscale() == "linear" and axes.get_xlim()[0] < -1, axes.get_xlim())


def drift_over_many_turns_is_distinguished_from_swinging():
    from tanktread.figures import suspensions as drift
    t = numpy.linspace(0, 100, 20001)
    phase = 360 * t / 2 + 10 * numpy.sin(numpy.pi * t)
    means = drift.turns(t, 1 + 0.3 * numpy.sin(2 * numpy.pi * t), phase)
    check(len(means) == 50 and abs(drift.line(means, 5)[0]) < 1e-6, means)
    change, error = drift.line(drift.turns(t, 1e-3 * t + 0.3 * numpy.sin(2 * numpy.pi * t), phase), 5)
    check(abs(change - 1e-3 * 2 * 44) < 1e-6 and error < 1e-6, f"{change} {error}")


def results_for_sharp_edges_are_extrapolated_from_two_radii():
    from tanktread.figures import accuracy as step
    q = step.power() / 2
    close(numpy.sin(1.5 * numpy.pi * q), q, 1e-14, "the velocity beside an edge of 90 degrees")
    close(step.sharp_edges(2 + 0.1**(2 * q), 2 + 0.05**(2 * q), 2), 2, 1e-14, "without rounding")
    refused = package("figure", "step", "deck.yaml", "--radii", "0.05", "0.1")
    check(refused.returncode == 2 and "larger one first" in refused.stderr, refused.stderr)
    refused = package("figure", "step", "deck.yaml", "--radii", "0.1", "0.05", "--set", "Time")
    check(refused.returncode == 2 and "KEY=VALUE" in refused.stderr, refused.stderr)
    refused = package("figure", "step", "none.yaml", "--radii", "0.1", "0.05")
    check(refused.returncode == 2 and "no such deck" in refused.stderr, refused.stderr)


def a_deck_with_changed_keys_is_run_once_and_its_surface_is_evaluated():
    path = deck(DECK).resolve()
    found = tanktread.run(path, {"Particle/semi-axes": [1.0, 1.0, 0.8], "Particle/shape": "spheroid"})
    check(found.value("Particle/shape") == "spheroid" and found.series["time"][-1] == 0.5, "another run")
    made = (found.directory / "run.h5").stat().st_mtime_ns
    check(tanktread.run("deck.yaml", {"Particle/shape": "spheroid", "Particle/semi-axes": [1.0, 1.0, 0.8]}).directory == found.directory, "by its name from here")
    check((tanktread.run(path, {"Particle/shape": "spheroid", "Particle/semi-axes": [1.0, 1.0, 0.8]}).directory / "run.h5").stat().st_mtime_ns == made, "again")
    shot = found.snapshots()[-1]
    grid = shot.sampled(shot.points, 4)
    cells = numpy.arange(len(grid))
    at = shot.evaluate(shot.points, cells, numpy.full(len(cells), 0.75), numpy.full(len(cells), 0.25))
    close(abs(at - grid[:, 1, 3]).max(), 0, 1e-13, "a place")
    h, s, t = 1e-4, numpy.full(len(cells), 0.3), numpy.full(len(cells), 0.6)
    slope = (shot.evaluate(shot.points, cells, s + h, t) - shot.evaluate(shot.points, cells, s - h, t)) / (2 * h)
    close(abs(shot.evaluate(shot.points, cells, s, t, ds=1) - slope).max(), 0, 1e-7, "a derivative")


def equal_runs_of_a_study_are_made_once():
    study, job = tanktread.Study(directory="equal", jobs=2), (deck(DECK), {"Time/final time": 0.1})
    first, second = study.all([job, job])
    check(first.done and second.done and first.directory == second.directory, first.message, second.message)


def a_run_is_repeated_if_a_file_named_in_its_deck_has_changed():
    deck(DECK.replace("simple shear", "simple shear, history: { file: history.csv }"))
    ends = []
    for factor in 1, 2:
        pathlib.Path("history.csv").write_text(f"0,{factor}\n1,{factor}\n")
        ends.append(tanktread.run("deck.yaml", {"Membrane/capillary number": 0.2}).series["taylor_inertia"][-1])
    check(ends[1] > 1.5 * ends[0], "the file is twice the flow", ends)
    plain, earlier = {"Membrane/capillary number": 0.2}, {"Particle/initial shape/run": "earlier"}
    name = tanktread.runs.Study.name
    before = name(["deck.yaml"], plain), name(["deck.yaml"], earlier)
    pathlib.Path("earlier").mkdir()
    pathlib.Path("earlier/run.h5").write_text("another one")
    check(name(["deck.yaml"], plain) == before[0] and name(["deck.yaml"], earlier) != before[1], "an earlier run")
    for folder, text in ("a", "0,1\n1,1\n"), ("b", "0,1\n1,2\n"):
        pathlib.Path(folder).mkdir()
        pathlib.Path(folder, "deck.yaml").write_text(pathlib.Path("deck.yaml").read_text())
        pathlib.Path(folder, "history.csv").write_text(text)
    pathlib.Path("history.csv").unlink()
    check(name(["a/deck.yaml"], {}) != name(["b/deck.yaml"], {}), "a file beside the deck")


def a_column_at_a_given_time_is_interpolated_exactly_and_times_outside_the_run_are_reported():
    deck(DECK)
    pathlib.Path("study.yaml").write_text("deck: deck.yaml\ngrid: {Time/final time: [0.5, 0.3]}\nrecord: {D: {series: taylor_inertia, at: 0.37},\n"
                                          "  end: {series: taylor_inertia, at: 0.3}}\n")
    _sweep("study.yaml", "--jobs", "1")
    rows = _rows()
    exact = {row["directory"]: tanktread.run(f"results/study/runs/{row['directory']}").series for row in rows}
    run("deck.yaml", "--set", "Time/tolerance=1e-7", "--output", "fine", "--quiet")
    fine = tanktread.run("fine").series
    close(float(rows[0]["D"]) / interpolated(fine["time"], fine["taylor_inertia"], [0.37])[0], 1, 1e-4, "D between steps")
    close(float(rows[1]["end"]), exact[rows[1]["directory"]]["taylor_inertia"][-1], 1e-12, "D at the end")
    check(rows[1]["D"] == "nan" and rows[1]["status"] == "done" and "D has no value at 0.37" in rows[1]["message"] and not rows[0]["message"], rows)


def a_column_may_be_the_series_of_a_particle_and_a_mean_is_over_time():
    deck("Tanktread: { Flow: { type: simple shear }, Time: { final time: 0.1 }, Particles: { upper: { center: [0, 0, 3] }, lower: {},\n"
         "  defaults: { Membrane: { capillary number: 0.3 }, Surface: { elements per side: 3 } } } }")
    pathlib.Path("study.yaml").write_text("deck: deck.yaml\nrecord: {upper/area: upper/area, mean: {series: upper/area, take: mean}}\n")
    _sweep("study.yaml", "--jobs", "1")
    row, found = _rows()[0], tanktread.run(next(pathlib.Path("results/study/runs").glob("deck_*"))).series
    close(float(row["upper/area"]), found["upper/area"][-1], 1e-12, "the last value")
    # two Gauss points per interval integrate the interpolating cubics exactly
    time, off = found["time"], numpy.diff(found["time"]) / numpy.sqrt(12)
    between = [interpolated(time, found["upper/area"], (time[1:] + time[:-1]) / 2 + side * off, order=4) for side in (-1, 1)]
    close(float(row["mean"]), numpy.diff(time) @ (between[0] + between[1]) / 2 / time[-1], 1e-12, "the mean over time")


def a_sweep_has_a_row_for_every_combination_and_draws_a_column():
    deck(DECK)
    deck(STUDY, "study.yaml")
    _sweep("study.yaml", "--jobs", "2", "--plot", "D", "Membrane/capillary number")
    rows = _rows()
    check(len(rows) == 6 and all(row["status"] == "done" for row in rows), rows)
    check([float(row["Membrane/capillary number"]) for row in rows] == [0.1, 0.1, 0.25, 0.25, 0.4, 0.4], rows)
    run("deck.yaml", "--set", "Membrane/capillary number=0.25", "--set", "Time/scheme=bs3", "--output", "one", "--quiet")
    alone = tanktread.run("one").series
    close(float(rows[2]["D"]), alone["taylor_inertia"][-1], 1e-12, "D")
    close(float(rows[2]["top"]), alone["area"].max(), 1e-12, "largest area")
    with h5py.File("results/study/table.h5") as file:
        series = file["columns/D(t)"][2]
        check(abs(series[numpy.isfinite(series)] - alone["taylor_inertia"]).max() < 1e-12, "the whole series")
    check(pathlib.Path("results/study/D.png").read_bytes()[:4] == b"\x89PNG", "no picture")


def values_with_units_are_numbers_in_the_unit_of_the_deck():
    deck(DECK.replace("Flow:", "Units: { time: 1 ms }\n  Flow:").replace("capillary number: 0.3", "shear modulus: 5 uN/m").replace("0.5 }", "2 ms }"))
    deck("deck: deck.yaml\ngrid: {Flow/shear rate: [10 1/s, 5 1/s, 100 1/s, 40 1/s, 9 kg], Membrane/law: [neo-Hookean, Skalak]}\nrecord: {D: taylor_inertia}\n",
         "study.yaml")
    _sweep("study.yaml", "--jobs", "1", "--plot", "D", "Flow/shear rate")
    rates = [row["Flow/shear rate"] for row in _rows()]
    check(rates[::2] == rates[1::2] == ["0.01", "0.005", "0.1", "0.04", "9 kg"], rates)
    with h5py.File("results/study/table.h5") as file:
        close(abs(file["keys/Flow/shear rate"][:8:2] - [0.01, 0.005, 0.1, 0.04]).max(), 0, 1e-15, "rates in 1/ms")
        check(numpy.isnan(file["keys/Flow/shear rate"][8:]).all() and file["keys/Flow/shear rate"].attrs["unit"] == ", 1/ms", "of a refused run; unit")
    from tanktread.studies import sweep
    axes = sweep.plot(pathlib.Path("results/study"), "D", "Flow/shear rate").axes[0]
    check(axes.lines[0].get_xdata()[:4].tolist() == [0.005, 0.01, 0.04, 0.1] and axes.lines[0].get_linestyle() == "-", axes.lines[0].get_xdata())
    axes = sweep.plot(pathlib.Path("results/study"), "D", "Membrane/law").axes[0]
    check(axes.lines[0].get_xdata().tolist() == ["neo-Hookean", "Skalak"] and axes.lines[0].get_linestyle() == "None", "laws are joined by a line")
    check(axes.lines[0].get_label() == "shear rate 0.01 1/ms", axes.lines[0].get_label())
    check(tanktread.runs.Study(PROGRAM).dimension("Particles/cell/radius") == "length", "a key of one of several particles")


def random_values_are_reproducible_and_lists_are_combined_in_order():
    deck(DECK)
    deck("deck: deck.yaml\nrecord: [taylor_inertia]\ntogether: {A/x: [1, 2], A/y: [3, 4]}\n"
         "random: {number: 3, seed: 7, keys: {B/z: {from: 0.01, to: 100.0, spacing: logarithmic}}}\n", "study.yaml")
    said = _sweep("study.yaml", "--list")
    check(said == _sweep("study.yaml", "--list") and said.count("\n") == 6, said)
    check("A/x=1, A/y=3" in said and "A/x=2, A/y=4" in said and "A/x=1, A/y=4" not in said, said)


def a_failed_run_does_not_stop_the_sweep_and_a_sweep_of_failures_is_reported():
    deck(DECK)
    deck(STUDY.replace("[bs3, tr-bdf2]", "[bs3, nonsense]"), "study.yaml")
    _sweep("study.yaml")
    ends = [row["status"] for row in _rows()]
    check(ends == ["done", "refused"] * 3 and "nonsense" in _rows()[1]["message"], _rows())
    deck(STUDY.replace("[bs3, tr-bdf2]", "[nonsense]"), "study.yaml")
    check("none of the runs" in _sweep("study.yaml", code=1), "a sweep of failures")


def a_run_that_reached_its_limit_is_repeated_with_a_larger_limit():
    deck(DECK.replace("per side: 3", "per side: 6").replace("final time: 0.5", "scheme: bs3, final time: 40.0"))  # two processor seconds
    ends, times = [], []
    for limit in "limit: 1", "limit: 1", "":
        deck(f"deck: deck.yaml\nrecord: [taylor_inertia]\n{limit}\n", "study.yaml")
        _sweep("study.yaml", "--jobs", "1", code=1 if limit else 0)
        ends.append(_rows()[0]["status"])
        times += [path.stat().st_mtime_ns for path in pathlib.Path("results/study/runs").glob("*/outcome.json")]
    check(ends == ["stopped", "stopped", "done"] and times[0] == times[1], ends, times)


def a_limit_is_not_rounded_to_seconds():
    path = deck(DECK.replace("per side: 3", "per side: 6").replace("final time: 0.5", "scheme: bs3, final time: 400.0"))  # twenty processor seconds
    for limit in 0.4, 1.2:
        ended = tanktread.Study(limit=limit).run(path, {})
        check(ended.status == "stopped" and ended.message == f"stopped after {limit} s of processor time", ended.message)
        check(ended.processor_seconds > limit - 0.1, ended.processor_seconds)  # the kernel counts processor time in ticks
        try:
            tanktread.Study(limit=limit)._start_timer()
            left, _ = signal.setitimer(signal.ITIMER_PROF, 0)
        finally:
            signal.setitimer(signal.ITIMER_PROF, 0)
        check(abs(left - limit) < 0.1, left)  # a limit in whole seconds would be 0.6 or 0.8 larger
    for limit, words in ((-1, "above 0, but is -1"), (0, "above 0, but is 0"), (float("inf"), "limit: inf is not a number")):
        deck(f"deck: deck.yaml\nrecord: [area]\nlimit: {str(limit).replace('inf', '.inf')}\n", "study.yaml")
        said = _sweep("study.yaml", code=2)
        check(words in said and said.count("\n") == 1, said)


def a_killed_sweep_continues():
    deck(DECK.replace("per side: 3", "per side: 6").replace("final time: 0.5", "final time: 8.0"))
    deck(STUDY, "study.yaml")
    for number in signal.SIGTERM, signal.SIGKILL:  # each keeps the table of the runs that have ended
        process = subprocess.Popen([SOURCE / "postproc/tanktread-sweep", "study.yaml", "--jobs", "2"], stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                   start_new_session=True)
        before = len(_rows()) if pathlib.Path("results/study/table.csv").exists() else 0
        while process.poll() is None and (not pathlib.Path("results/study/table.csv").exists() or len(_rows()) in (0, before)):
            time.sleep(0.02)
        # sends the signal to the study and its runs, as a batch system does; the study sends it to its runs again
        os.killpg(process.pid, number)
        process.wait()
        check(_rows() and all(row["status"] == "done" for row in _rows()), "the table of a killed sweep", _rows())
        with h5py.File("results/study/table.h5") as file:
            check(abs(len(file["columns/D"]) - len(_rows())) <= 1, "the other table")  # SIGKILL may come between the two files
    kept = {path: path.stat().st_mtime_ns for path in pathlib.Path("results/study/runs").glob("*/outcome.json") if '"code": 0' in path.read_text()}
    check(kept, "nothing was done before")
    _sweep("study.yaml", "--jobs", "2")
    check(all(row["status"] == "done" for row in _rows()), _rows())
    notes = [path.read_text() for path in pathlib.Path("results/study/runs").glob("*/outcome.json")]
    check(any("--resume" in note for note in notes), "no run was resumed", notes)
    check(all(path.stat().st_mtime_ns == when for path, when in kept.items()), "a run that was there is made again")


def a_table_tells_steady_shapes_from_the_final_time():
    deck(DECK.replace("final time: 0.5", "final time: 0.5, steady tolerance: 1.0e-9"))
    pathlib.Path("study.yaml").write_text("deck: deck.yaml\ngrid: {Time/steady tolerance: [1.0e-9, 10.0], Membrane/law: [neo-Hookean, none]}\nrecord: [taylor_inertia]\n")
    _sweep("study.yaml", "--jobs", "1")
    check([(row["status"], row["ended"]) for row in _rows()] == [("done", "done"), ("refused", "refused"), ("done", "steady"), ("refused", "refused")], _rows())
    with h5py.File("results/study/table.h5") as file:
        check(file["ended"].asstr()[::2].tolist() == ["done", "steady"], "in HDF5")


def mistakes_are_reported_in_one_sentence():
    deck(DECK)
    for text, words in (("deck: nowhere.yaml\nrecord: [a]", "no deck nowhere.yaml"), ("deck: deck.yaml", "records nothing"),
                        ("deck: deck.yaml\nkeys: {}", "keys is not known"), ("deck: deck.yaml\nrecord: {D: {take: most}}", "D: take is last or smallest or largest or mean or all, not most"),
                        ("deck: deck.yaml\nrecord: {D: {series: a, take: mean, at: 1}}", "take or at"),
                        ("deck: deck.yaml\nrecord: [a]\ngrid: {A/b: {from: 1}}", "from, to and number"), ("a: [", "not YAML"),
                        ("deck: 3", "deck must be a text, but is 3"), ("deck: deck.yaml\nrecord: [a]\nset: 3", "set must be a section of keys"),
                        ("deck: deck.yaml\nrecord: [a]\ngrid: [A/b]", "grid must be a section of keys"), ("deck: deck.yaml\nrecord: D", "record must be"),
                        ("deck: deck.yaml\nrecord: [a]\ngrid: {A/b: {from: x, to: 2, number: 3}}", "x is not a number"),
                        ("deck: deck.yaml\nrecord: [a]\nrandom: {number: -1, keys: {A/b: [1]}}", "a whole number, 1 or above"),
                        ("deck: deck.yaml\nrecord: [a]\ngrid: {A/b: {from: 1, to: 2, number: 2, spaceing: linear}}", "A/b: spaceing is not known"),
                        ("deck: deck.yaml\nrecord: [a]\nrandom: {number: 2, sede: 5, keys: {A/b: [1]}}", "random: sede is not known"),
                        ("deck: deck.yaml\nrecord: [a]\nrandom: {number: 2, keys: {A/b: {from: 1, to: 2, number: 2}}}", "A/b: number is not known"),
                        ("deck: deck.yaml\nrecord: [a]\ngrid: {A/b: {from: 1, to: 2, number: 1000000000}}",
                         "A/b makes 1000000000 runs, and a study makes at most 100000"),
                        ("deck: deck.yaml\nrecord: [a]\nrandom: {number: 1000000000, keys: {A/b: [1]}}", "the study makes 1000000000 runs"),
                        ("deck: deck.yaml\nrecord: [a]\ngrid: {A/b: {from: 1, to: 2, number: 1000}, A/c: {from: 1, to: 2, number: 1000}}",
                         "the study makes 1000000 runs, and a study makes at most 100000"),
                        ("deck: deck.yaml\nrecord: [a]\ngrid: {3: [1]}", "grid: 3 is not a key of a deck"),
                        ("deck: deck.yaml\nrecord: [a]\ngrid: {A/b: [1]}\ngrid: {A/c: [1]}", "line 4: the key grid is already in line 3"),
                        ("deck: deck.yaml\nrecord: {A/b: a}\ngrid: {A/b: [1, 2]}", "A/b is already a column"),
                        ("deck: deck.yaml\nrecord: {status: a}\ngrid: {A/b: [1, 2]}", "status is already a column"),
                        ("deck: deck.yaml\nrecord: {all: {series: a, take: all}, time: time}", "time is already a column"),
                        ("deck: deck.yaml\nrecord: [a]\ngrid: {A/b: [1, 2]}\ntogether: {A/b: [3, 4]}", "A/b: a key is in one of"),
                        ("deck: deck.yaml\nrecord: [a]\nranks: 0", "a whole number, 1 or above"), ("deck: deck.yaml\nrecord: [a]\nlimit: x", "limit: x is not")):
        deck(text, "study.yaml")
        said = _sweep("study.yaml", code=2)
        check(words in said and said.count("\n") == 1, said)
    check("absent.yaml" in _sweep("absent.yaml", code=2), "a file that is not there")
    deck(STUDY.replace("D: taylor_inertia", "D: tailor"), "study.yaml")
    check("no series tailor" in _sweep("study.yaml", "--jobs", "1", code=2), "an unknown series")
    check(len(list(pathlib.Path("results/study/runs").iterdir())) < 4, "a column that no run has is told after all runs")


main()
