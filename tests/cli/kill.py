#!/usr/bin/python3
# ranks: 1
# Tests that the files of a run that is killed at any moment can be read and contain every completed step.
import pathlib
import random
import signal
import time

from harness import check, deck, main, run, series, start

DECK = """
Tanktread:
  Flow: { type: simple shear }
  Particle: { shape: sphere }
  Membrane: { law: neo-Hookean, capillary number: 0.3 }
  Surface: { mesh: cube, elements per side: 3 }
  Time: { final time: 10.0, tolerance: 1.0e-6 }
  Output: { interval: 0.1 }
"""
KILLS = 20
SERIES = ["time", "taylor_inertia", "energy", "volume_error", "evaluations"]


def _rows(results):
    """Returns the number of rows in the record; 0 if there is no record yet."""
    return len(series(results, "time")) if (pathlib.Path(results) / "run.h5").exists() else 0


def _holds_the_beginning_of(whole, results):
    """Checks that every series of `results` is bitwise equal to the beginning of the series of `whole`."""
    rows = _rows(results)
    for name in SERIES if rows else []:
        part = series(results, name)
        check(len(part) == rows, f"{name} has {len(part)} rows, time has {rows}")
        check(part.tobytes() == series(whole, name)[:rows].tobytes(), f"{name} differs from the run that was left alone")


def _snapshots_are_whole(results):
    """Checks that every snapshot can be opened, and that the list of snapshots contains no others."""
    import h5py
    import json

    results = pathlib.Path(results)
    for path in results.glob("snapshot_*.hdf"):
        with h5py.File(path, "r") as file:
            check(file["checkpoint/arrays/x shape 1"].shape[1] == 3 and file["VTKHDF/Points"].shape[1] == 3, path)
    if (results / "run.hdf.series").exists():
        for entry in json.loads((results / "run.hdf.series").read_text())["files"]:
            check((results / entry["name"]).exists(), f"{entry['name']} is listed and missing")


def the_files_of_a_killed_run_contain_every_completed_step():
    deck(DECK)
    begin = time.monotonic()
    run("deck.yaml", "--output", "whole", "--quiet")
    duration = time.monotonic() - begin
    moments = random.Random(5)
    most = 0
    for k in range(KILLS):
        results = f"killed_{k}"
        process = start("deck.yaml", "--output", results, "--quiet")
        end = time.monotonic() + moments.uniform(0.02, 1) * duration
        seen = 0
        while time.monotonic() < end and process.poll() is None:
            seen = max(seen, _rows(results))  # tests also that the record can be read during the run
        process.send_signal(signal.SIGKILL)
        process.communicate()
        rows = _rows(results)
        check(rows >= seen, f"{seen} rows were there, {rows} are left")
        most = max(most, rows)
        _holds_the_beginning_of("whole", results)
        _snapshots_are_whole(results)
    check(most > 3, "no run was killed after its third step: the test saw nothing")


main()
