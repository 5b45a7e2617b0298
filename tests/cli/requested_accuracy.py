#!/usr/bin/python3
# ranks: 2
"""Tests of requested accuracy: levels, estimated errors and their files, resumption, messages about missed requests."""
import math
import os
import pathlib
import signal
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "postproc"))
os.environ["TANKTREAD"] = str(pathlib.Path(sys.argv[1]).resolve())

from harness import check, close, deck, main, refused, run, series, start, summary

DROP = """Tanktread:
  Flow: {type: uniaxial extension, shear rate: 1.0}
  Particle: {shape: sphere, radius: 1.0, viscosity ratio: 1.0}
  Membrane: {law: surface tension, capillary number: 0.05}
  Time: {final time: 1.0}
  Output: {interval: 0.1}
"""
BRANCH = """Tanktread:
  Flow: {type: uniaxial extension}
  Membrane: {law: surface tension, capillary number: 0.04}
  Surface: {elements per side: 3}
  Steady: {tolerance: 1.0e-6}
  Continuation: {parameter: Membrane/capillary number, to: 0.08, step: 0.01}
"""


def _run_file(results):
    import h5py

    return h5py.File(pathlib.Path(results) / "run.h5", "r")


def _same(a, b, tolerance):
    """Fails the test unless the series and errors of two runs agree. Series that measure work are not compared."""
    import numpy

    with _run_file(a) as one, _run_file(b) as other:
        for group in ("series", "error"):
            check(set(one[group]) == set(other[group]), f"other names in /{group}")
            for name in one[group]:
                if name in ("wall_seconds", "iterations", "evaluations", "solver_iterations", "step_error", "assemblies"):
                    continue
                x, y = one[group][name][:], other[group][name][:]
                check(x.shape == y.shape, f"{group}/{name}: other rows")
                largest = numpy.nanmax(abs(one["series"][name][:]), initial=1e-3)
                check(numpy.nanmax(abs(x - y), initial=0) <= tolerance * largest, f"{group}/{name}: {x} and {y}")


def a_request_is_met_and_every_series_has_an_error():
    import numpy
    import tanktread

    deck(DROP)
    run("deck.yaml", "--accuracy", "taylor_inertia=1%", "--accuracy", "area@end=1e-3", "--quiet", "--output", "met")
    found = summary("met")["accuracy"]
    check(found["met"], found)
    for one in found["requests"]:
        check(one["met"] and one["estimated error"] <= one["allowed"], one)
    run("deck.yaml", "--set", "Surface/elements per side=12", "--set", "Time/tolerance=1e-6", "--set", "Quadrature/tolerance=1e-6", "--quiet",
        "--output", "fine")
    with _run_file("met") as file, _run_file("fine") as fine:
        for name in ("taylor_inertia", "area", "energy", "stresslet_11", "velocity_x1"):
            error, values = file["error"][name], file["series"][name]
            check(error.shape == values.shape, f"{name}: another shape")
            check(error.attrs["unit"] == values.attrs["unit"], f"{name}: another unit")
        check("wall_seconds" not in file["error"] and "time" not in file["error"], "the work has an error")
        at = numpy.isin(file["series/time"][:].round(9), fine["series/time"][:].round(9))
        reference = numpy.interp(file["series/time"][at], fine["series/time"][:], fine["series/taylor_inertia"][:])
        true = abs(file["series/taylor_inertia"][at] - reference)
        check(true.max() <= 0.01 * reference.max(), f"the request is not met: {true.max()}")
        factor = numpy.nanmax(file["error/taylor_inertia"][:]) / true.max()
        check(1 / 4 < factor < 4, f"the estimate is {factor} times the error")
    check(summary("met")["error"]["taylor_inertia"] > 0, "no error in the summary")
    errors = [shot.fields["position error"].max() for shot in tanktread.run("met").snapshots()]
    check(len(errors) > 5 and 0 < max(errors) < 0.02, errors)  # of the radius


def a_looser_request_takes_fewer_levels():
    deck(DROP)
    levels = []
    for request in ("taylor_inertia=5%", "taylor_inertia=0.01%"):
        run("deck.yaml", "--accuracy", request, "--quiet", "--overwrite", "--output", "some")
        levels.append(len(summary("some")["accuracy"]["levels"]))
    check(levels[0] < levels[1], levels)
    check(not pathlib.Path("some/level_7").exists(), "a level too many")


def the_requests_of_a_deck_bind_like_those_of_the_command_line():
    deck(DROP + "  Accuracy: {requests: 'taylor_inertia=1%, area=1e-4'}\n  Expect: {area: {value: 12.6, tolerance: 0.5}}\n")
    run("deck.yaml", "--set", "Expect/start={series: taylor_inertia, value: 0, tolerance: 0.1, at: 0}", "--quiet", "--output", "deck")
    found = summary("deck")
    check(found["accuracy"]["met"], found)
    with _run_file("deck") as file:
        for one, row in zip(found["expect"], (-1, 0)):
            error = file["error/area" if row else "error/taylor_inertia"][row]
            check(one["passed"] and one["estimated error"] == error > 0, one, error)
        check(file["error/taylor_inertia"][-1] != error, "the error at the start is that at the end")
    early = "Expect/early={series: inclination, value: 40, tolerance: 100, at: 0}"
    said = run("deck.yaml", "--set", "Expect/area/value=20", "--set", early, "--quiet", "--output", "missed", code=1).stderr
    check(len(said.splitlines()) == 1 and "missed Expect/area" in said, said)
    check("Expect/early: inclination is undefined at the time 0, because the two semi-axes" in said, said)
    said = run("deck.yaml", "--no-expect", "--set", "Expect/area/value=20", "--quiet", "--output", "reported").stderr
    check("Expect/area: area is" in said and "does not fail the run" in said, said)


def a_series_that_vanishes_has_no_relative_error():
    deck(DROP)
    said = run("deck.yaml", "--accuracy", "velocity_x2=1%", "--accuracy", "taylor_inertia=5%", "--quiet", "--output", "still", code=1).stderr
    check("velocity_x2=1%: the error cannot be estimated, because the series is not larger than its differences" in said, said)
    check(len(summary("still")["accuracy"]["levels"]) < 7, "finer levels were run")
    deck(DROP.replace("uniaxial extension", "simple shear"))
    run("deck.yaml", "--accuracy", "stresslet_12=1%", "--set", "Accuracy/levels=3", "--quiet", "--output", "plane")
    found = summary("plane")["accuracy"]["requests"][0]
    # allowed: 1e-10 of the largest series with this unit, which is the energy, 251
    check(found["met"] and 0 < found["allowed"] < 1e-7, found)


def a_request_that_is_not_met_is_reported():
    deck(DROP)
    result = run("deck.yaml", "--accuracy", "taylor_inertia=1e-12", "--set", "Accuracy/levels=3", "--quiet", "--output", "few", code=1)
    lines = result.stderr.splitlines()
    check(len(lines) == 1 and "not reached" in lines[0] and "taylor_inertia=1e-12: estimated error" in lines[0], result.stderr)
    check(not summary("few")["accuracy"]["met"], "said to be met")


def points_of_a_branch_have_no_error_of_position():
    """Point k of a branch has different parameter values on two levels, so that positions cannot be compared."""
    import tanktread

    deck(BRANCH)
    run("deck.yaml", "--accuracy", "taylor_surface@end=5%", "--set", "Accuracy/levels=3", "--quiet", "--output", "branch")
    check(summary("branch")["accuracy"]["met"], summary("branch")["accuracy"])
    for shot in tanktread.run("branch").snapshots():
        check("position error" not in shot.fields, sorted(shot.fields))


def only_the_warnings_of_the_finest_level_are_printed():
    """The walls of the first levels are too coarse for the gap."""
    deck("""
Tanktread:
  Flow: {type: duct}
  Tube: {radius: 1.0, periodic length: 2, azimuthal elements: 12}
  Particle: {radius: 0.75, motion: free}
  Surface: {elements per side: 6}
  Time: {final time: 0.01}
  Output: {interval: 0.01}
""")
    said = run("deck.yaml", "--accuracy", "velocity_x1=10%", "--quiet", "--output", "levels", "--set", "Accuracy/levels=3").stderr
    check("narrower than" in (pathlib.Path("levels") / "level_0/summary.yaml").read_text(), "no level has a warning")
    check(said.count("narrower than") == len(summary("levels")["warnings"]), said, summary("levels")["warnings"])


def levels_that_the_deck_does_not_allow_count_as_failed():
    deck(DROP.replace("final time: 1.0", "final time: 0.1") + "  Surface: {elements per side: 3}\n  Adaptation: {enabled: true, largest number of points: 100}\n")
    words = ("--accuracy", "taylor_inertia=5%", "--set", "Accuracy/levels=3", "--quiet", "--output", "few")
    said = run("deck.yaml", *words, code=1).stderr.splitlines()[-1]  # the levels have meshes of 56, 98 and 152 points
    check("level 2 failed: Adaptation/largest number of points must be above" in said, said)
    check(len(summary("few")["accuracy"]["levels"]) == 2, summary("few")["accuracy"])
    predicted = run("deck.yaml", *words, "--set", "Adaptation/largest number of points=60", "--check").stdout
    check("no level can be predicted, because level 3 failed: Adaptation/largest number of points" in predicted, predicted[-400:])
    run("deck.yaml", *words, "--overwrite", "--set", "Adaptation/largest number of points=153", "--set", "Adaptation/surface tolerance=1e-9", code=1)
    check("largest number of points" in summary("few")["accuracy"]["requests"][0]["untrusted"], summary("few")["accuracy"])


def a_signal_in_a_search_stops_the_levels_and_the_finished_ones_are_published():
    deck(BRANCH)
    process = start("deck.yaml", "--accuracy", "taylor_surface@end=1e-9", "--quiet", "--output", "levels")
    while not list(pathlib.Path("levels").glob("level_2/snapshot_*")) and process.poll() is None:
        time.sleep(0.002)
    process.send_signal(signal.SIGTERM)
    said = process.communicate()[1]
    check(process.returncode == 4 and "was stopped; --resume levels continues" in said, process.returncode, said)
    check(len(summary("levels")["accuracy"]["levels"]) >= 2, summary("levels")["accuracy"])
    check(summary("levels")["status"] == "stopped: by a signal", summary("levels")["status"])


def an_existing_run_cannot_be_resumed_with_a_request():
    deck(DROP)
    run("deck.yaml", "--set", "Time/final time=0.1", "--quiet", "--output", "plain")
    before = sorted(pathlib.Path("plain").iterdir())
    said = run("--resume", "plain", "--accuracy", "taylor_inertia=5%", "--set", "Accuracy/levels=3", "--quiet", code=2).stderr
    check("another --output" in said, said)
    check(sorted(pathlib.Path("plain").iterdir()) == before, "results were deleted")


def results_are_kept_if_the_new_scene_cannot_start():
    deck(DROP.replace("final time: 1.0", "final time: 0.1"))
    run("deck.yaml", "--accuracy", "taylor_inertia=1e-9", "--set", "Accuracy/levels=3", "--quiet", "--output", "kept", code=1)
    before = sorted(pathlib.Path("kept").rglob("*"))
    deck("""Tanktread:
  Flow: {type: uniaxial extension}
  Particles:
    defaults: {Membrane: {law: surface tension, capillary number: 0.05}}
    one: {center: [0.0, 0.0, 0.0]}
    other: {center: [1.0, 0.0, 0.0]}
  Time: {final time: 0.1}
""")
    said = run("deck.yaml", "--accuracy", "one/taylor_inertia=5%", "--overwrite", "--quiet", "--output", "kept", code=2).stderr
    check("overlap" in said, said)
    check(sorted(pathlib.Path("kept").rglob("*")) == before, "results were deleted")


def only_files_of_levels_are_deleted():
    deck(DROP.replace("final time: 1.0", "final time: 0.1"))
    words = ("deck.yaml", "--accuracy", "taylor_inertia=1e-9", "--set", "Accuracy/levels=3", "--quiet", "--output", "out")
    own = [pathlib.Path("out/mine/failure.txt"), pathlib.Path("out/mine/run.h5"), pathlib.Path("out/failure.txt")]
    own[0].parent.mkdir(parents=True)
    for path in own:
        path.touch()
    run(*words, code=1)
    failed = pathlib.Path("out/level_0/failure.txt")  # of an earlier search
    failed.touch()
    run(*words, "--overwrite", code=1)
    check(all(path.exists() for path in own), "a file of the user was deleted")
    check(not failed.exists(), "the failure of an earlier level was kept")


def the_interval_of_a_finished_level_may_change():
    deck(DROP.replace("final time: 1.0", "final time: 0.2"))
    run("deck.yaml", "--accuracy", "taylor_inertia=1e-9", "--set", "Accuracy/levels=3", "--quiet", "--output", "kept", code=1)
    run("--resume", "kept", "--set", "Output/interval=0.05", "--set", "Accuracy/levels=4", "--quiet", code=1)
    check([level["level"] for level in summary("kept")["accuracy"]["levels"]] == [0, 1, 2, 3], summary("kept")["accuracy"]["levels"])


def the_wall_clock_limit_is_respected_and_reported():
    deck(DROP)
    result = run("deck.yaml", "--accuracy", "taylor_inertia=1e-9", "--set", "Accuracy/wall-clock limit=0.6", "--quiet", "--output", "short",
                 code=4, timeout=60)
    check("wall-clock limit" in result.stderr or "was stopped" in result.stderr, result.stderr)
    check("--resume short continues the run" in result.stderr and "--resume short/level" not in result.stderr, result.stderr)
    run("deck.yaml", "--accuracy", "taylor_inertia=1e-9", "--set", "Accuracy/levels=3", "--quiet", "--output", "few", code=1)
    check(summary("few")["status"] == "done", summary("few")["status"])
    run("--resume", "few", "--set", "Accuracy/levels=8", "--set", "Accuracy/wall-clock limit=1e-6", "--quiet", code=4)
    check(summary("few")["status"] == "stopped: at the wall-clock limit" and summary("few/level_2")["status"] == "done", summary("few")["status"])
    run("--resume", "few", "--set", "Accuracy/levels=4", "--set", "Accuracy/wall-clock limit=600", "--quiet", code=1)
    check(summary("few")["status"] == "done" and summary("few")["accuracy"]["levels"][-1]["level"] == 3, summary("few")["status"])
    said = run("deck.yaml", "--accuracy", "taylor_inertia=1%", "--set", "Accuracy/wall-clock limit=1e-6", "--check", "--quiet", code=4).stderr
    check(len(said.splitlines()) == 1 and "wall-clock limit" in said, said)


def a_level_of_a_rigid_body_continues():
    deck("Tanktread:\n  Flow: {type: simple shear}\n  Particle: {motion: free, shape: spheroid, semi-axes: [1, 1, 2]}\n"
         "  Time: {final time: 50000}\n  Output: {interval: 50}\n  Accuracy: {requests: velocity_x1=1%}\n")
    record, times = pathlib.Path("levels/level_0/run.h5"), []
    for words in ["deck.yaml", "--output", "levels"], ["--resume", "levels"]:
        process = start(*words, "--quiet")
        while process.poll() is None and not (record.exists() and len(series(record.parent, "time")) > len(times) + 1):
            time.sleep(0.002)
        process.send_signal(signal.SIGTERM)
        check("--resume levels continues" in process.communicate()[1] and process.returncode == 4, process.returncode)
        before, times = times, list(series(record.parent, "time"))
        check(times[:len(before)] == before and len(times) > len(before), "did not continue", before[-3:], times[:3])


def a_ladder_that_was_killed_gives_the_same_result():
    deck(DROP)
    request = ("--accuracy", "taylor_inertia=0.1%", "--quiet")
    run("deck.yaml", *request, "--output", "whole")
    for seconds in (0.1, 0.4):
        process = start("deck.yaml", *request, "--overwrite", "--output", "killed")
        while not pathlib.Path("killed/level_1").exists() and process.poll() is None:
            time.sleep(0.01)
        time.sleep(seconds)
        if process.poll() is None:
            os.kill(process.pid, signal.SIGKILL)
        process.communicate()
        run("--resume", "killed", "--quiet")
        _same("whole", "killed", 1e-13)
    kept = os.stat("killed/level_0/run.h5").st_mtime_ns
    run("--resume", "killed", "--quiet", "--set", "Accuracy/requests=taylor_inertia=0.05%")
    check(os.stat("killed/level_0/run.h5").st_mtime_ns == kept, "a finished level was run again")
    found = summary("killed")["accuracy"]
    check(found["requests"][0]["request"] == "taylor_inertia=0.05%", found)
    run("--resume", "killed", "--quiet")
    found = summary("killed")["accuracy"]
    check(found["seconds"] >= sum(one["seconds"] for one in found["levels"]) > 0, found)


def a_ladder_resumes_without_the_files_of_its_deck():
    os.mkdir("decks")
    history = pathlib.Path("decks/history.csv")
    history.write_text("time,amplitude\n0,1\n10,0.9\n", encoding="utf-8")
    deck(DROP.replace("shear rate: 1.0", "history: {file: history.csv}"), "decks/deck.yaml")
    process = start("decks/deck.yaml", "--accuracy", "taylor_inertia=0.5%", "--quiet", "--output", "levels")
    while not pathlib.Path("levels/level_1").exists() and process.poll() is None:
        time.sleep(0.001)
    process.kill()
    process.communicate()
    check(not pathlib.Path("levels/summary.yaml").exists(), "the ladder ended before it was killed")
    history.unlink()
    run("--resume", "levels", "--quiet")
    check(summary("levels")["accuracy"]["met"], summary("levels")["accuracy"])


def a_level_that_failed_is_not_run_again():
    deck(DROP.replace("0.05", "0.3").replace("  Time: {final time: 1.0}\n", "  Steady: {}\n").replace("  Output: {interval: 0.1}\n", ""))
    words = ("--accuracy", "taylor_inertia=1%", "--set", "Accuracy/levels=3")
    first = run("deck.yaml", *words, "--output", "burst", code=3)
    check("no accuracy level was completed" in first.stderr, first.stderr)
    kept = pathlib.Path("burst/level_0/failure.txt")
    reason = kept.read_text(encoding="utf-8").split("--- failed: ")[1]
    check(reason and reason in first.stdout, first.stdout)
    kept.write_text(kept.read_text(encoding="utf-8") + ", as was found before", encoding="utf-8")
    again = run("--resume", "burst", code=3)
    check(f"{reason}, as was found before" in again.stdout, again.stdout)


def two_ranks_agree():
    deck(DROP)
    for ranks in (1, 2):
        run("deck.yaml", "--accuracy", "taylor_inertia=1%", "--quiet", "--output", f"of_{ranks}", ranks=ranks)
    _same("of_1", "of_2", 1e-9)  # tolerance: errors are differences of series that agree to 1e-10


def resistance_has_errors():
    deck("""Tanktread:
  Flow: {type: simple shear}
  Particle: {shape: sphere, radius: 1.0, motion: prescribed, velocity: [0.0, 0.0, 1.0]}
""")
    run("deck.yaml", "--accuracy", "drag_x3=0.1%", "--quiet", "--output", "drag")
    found = summary("drag")
    exact = -6 * math.pi
    close(series("drag", "drag_x3")[-1], exact, 1e-3 * abs(exact), "drag")
    check(found["accuracy"]["met"] and found["error"]["drag_x3"] > 0, found["accuracy"])


def coarse_levels_may_have_fewer_modes_than_are_asked_for():
    """The level with 3 elements per side has 7 unknowns, and 12 modes are reported by default."""
    deck(BRANCH[:BRANCH.index("  Continuation")] + "  Spectrum: {}\n", "modes.yaml")
    run("modes.yaml", "--accuracy", "rate_2=1%,rate_12=5%", "--quiet", "--output", "modes")
    coarsest = (pathlib.Path("modes") / "level_0/summary.yaml").read_text()
    check("has only 7 unknowns" in coarsest, coarsest)
    found = summary("modes")
    check(found["accuracy"]["met"] and found["error"]["rate_12"] > 0, found["accuracy"], found["error"])
    run("modes.yaml", "--quiet", "--output", "krylov", "--set", "Spectrum/method=krylov")
    run("modes.yaml", "--quiet", "--output", "dense")
    for k in range(1, 13):
        one, other = series("krylov", f"rate_{k}")[-1], series("dense", f"rate_{k}")[-1]
        check(one == other or (k > 7 and math.isnan(one) and math.isnan(other)), k, one, other)


def tables_reports_and_bands_have_errors():
    import numpy
    from tanktread import report
    from tanktread.studies import sweep
    from tanktread.studies.fit_data import SeriesData

    deck(DROP + "  Accuracy: {requests: 'taylor_inertia=1%'}\n")
    deck("deck: deck.yaml\ngrid: {Particle/viscosity ratio: [1.0, 2.0]}\nrecord: {D: taylor_inertia}\n", "study.yaml")
    made = sweep.run("study.yaml", "table", jobs=1)
    columns, *_ = sweep.table(pathlib.Path("table"))
    check((columns["D error"] > 0).all() and (columns["D error"] < 0.01 * columns["D"]).all(), columns)
    one = made.outcomes[0].run
    low, high = one.band("taylor_inertia")
    check((low <= high).all() and numpy.nanmax(high - low) > 0, "the band")
    found = report.of_run(one.directory, None)
    check(found["curves"]["errors"]["taylor_inertia"] and any(title == "Accuracy" and rows for title, _, rows in found["sections"]), "the report")
    datum = SeriesData({"series": "taylor_inertia", "value": 0.1, "error": 1e-9}, "data", pathlib.Path())
    prediction = datum.prediction(one)
    weighted = datum.residuals(prediction, [])[0] * numpy.nanmax(one.errors["taylor_inertia"])
    close(weighted, 0.1 - one.series["taylor_inertia"][-1], 1e-6, "residual divided by the discretisation error")


def a_run_without_a_request_states_its_known_errors():
    deck(DROP)
    run("deck.yaml", "--quiet", "--output", "plain")
    known = summary("plain")["estimated errors"]
    check("unknown" in known["mesh"] and float(known["time integration"].split()[0]) > 0 and "quadrature" in known, known)
    run("deck.yaml", "--accuracy", "taylor_inertia=5%", "--quiet", "--output", "asked")
    check("estimated errors" not in summary("asked"), "the mesh is said to be unknown")


def the_check_predicts_levels_and_seconds():
    deck(DROP)
    result = run("deck.yaml", "--accuracy", "taylor_inertia=0.1%", "--check")
    check(result.stdout.count("pilot run of level") == 2, "no progress", result.stdout[-400:])
    check("is predicted to meet it" in result.stdout and "s in all, from a pilot run" in result.stdout, result.stdout[-400:])
    check(not pathlib.Path("results").exists(), "results were written")
    limited = run("deck.yaml", "--accuracy", "taylor_inertia=1e-6", "--set", "Accuracy/wall-clock limit=3", "--check").stdout
    check("more than Accuracy/wall-clock limit allows" in limited, limited[-400:])


def the_check_predicts_levels_if_the_coarsest_fails():
    """Level 0 has four times the fixed step of the deck, which is then beyond the limit of stability."""
    deck("""Tanktread:
  Flow: {type: simple shear}
  Membrane: {law: neo-Hookean, capillary number: 0.05, pre-inflation: 0.05}
  Time: {scheme: bs3, fixed step: 0.007, final time: 0.3}
""")
    result = run("deck.yaml", "--accuracy", "taylor_inertia=5%", "--check")
    check("from a pilot run of the levels 1 and 2" in result.stdout, result.stdout[-400:])


def wrinkles_are_reported_instead_of_an_error():
    import tanktread

    deck("""Tanktread:
  Flow: {type: simple shear}
  Membrane: {law: neo-Hookean, capillary number: 0.1}
  Time: {final time: 5.0}
  Output: {interval: 1.0}
""")
    result = run("deck.yaml", "--accuracy", "taylor_inertia=5%", "--set", "Accuracy/levels=3", "--quiet", "--output", "wrinkled", code=1)
    check("wrinkles" in result.stderr.splitlines()[-1], result.stderr)
    check(math.isnan(summary("wrinkled")["accuracy"]["requests"][0]["estimated error"]), "an error in spite of wrinkles")
    check("position error" not in tanktread.run("wrinkled").snapshots()[-1].fields, "an error of position in spite of wrinkles")


def wrong_requests_are_rejected():
    deck(DROP)
    for request, words in (("taylor_inertai=1e-3", ["taylor_inertia meant"]), ("taylor_inertia", ["no value"]),
                           ("taylor_inertia=-1", ["positive"]), ("taylor_inertia@start=1", ["@end"]), ("wall_seconds=1", ["no error"]),
                           ("=1", ["no series"])):
        refused(words, "deck.yaml", "--accuracy", request)
    refused(["initial shape/run"], "deck.yaml", "--accuracy", "area=1%", "--set", "Particle/initial shape/run=results/other")
    refused(["is missing"], "deck.yaml", "--set", "Accuracy/levels=4")
    stress_free = ["Membrane/law=neo-Hookean", "Membrane/stress-free shape=file", "Membrane/stress-free file=sphere.iga"]
    refused(["Accuracy and Membrane/stress-free file contradict", "one mesh"], "deck.yaml", "--accuracy", "area=1%",
            *(word for setting in stress_free for word in ("--set", setting)))
    refused(["area@mean", "branch"], deck(BRANCH), "--accuracy", "area@mean=1%")


main()
