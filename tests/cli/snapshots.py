#!/usr/bin/python3
# Tests of snapshots between steps: fixed steps keep their size, and snapshots are at the requested times.
import pathlib

import h5py
import json
import numpy

from harness import check, close, deck, main, run

DECK = """
Tanktread:
  Flow: { type: simple shear }
  Membrane: { law: neo-Hookean, capillary number: 0.3 }
  Surface: { mesh: cube, elements per side: 3 }
  Time: { final time: 1.0 }
  Output: { interval: 0.25 }
"""


def _series(results, name):
    with h5py.File(pathlib.Path(results) / "run.h5", "r") as file:
        return file["series"][name][()]


def _pictures(results):
    """Returns (time, points of the surface) of each snapshot."""
    found = []
    for entry in json.loads((pathlib.Path(results) / "run.hdf.series").read_text())["files"]:
        with h5py.File(pathlib.Path(results) / entry["name"], "r") as file:
            found.append((entry["time"], file["VTKHDF/Points"][()]))
    return found


def fixed_steps_keep_their_size_and_snapshots_are_at_the_requested_times():
    deck(DECK)
    run("deck.yaml", "--output", "fixed", "--quiet", "--set", "Time/fixed step=0.1", "--set", "Time/tolerance=1e-6")
    check(numpy.ptp(_series("fixed", "time_step")[1:]) < 1e-12, _series("fixed", "time_step"))
    run("deck.yaml", "--output", "exact", "--quiet", "--set", "Time/tolerance=1e-6")
    for (time, points), (exact_time, exact_points) in zip(_pictures("fixed"), _pictures("exact"), strict=True):
        close(time, exact_time, 1e-12, "time of a picture")
        worst = abs(points - exact_points).max()
        # error of the steps of 0.1, not of the interpolation between them; at the end of a step it is 5e-4
        check(worst < 2e-3, f"at {time} the surface is off by {worst}")


def the_first_step_is_not_longer_than_the_interval_between_snapshots():
    deck(DECK.replace("interval: 0.25", "interval: 0.05, between steps: interpolate"))
    run("deck.yaml", "--output", "long", "--quiet", "--set", "Time/initial step=0.22", "--set", "Time/final time=0.5")
    times = [time for time, _ in _pictures("long")]
    check(numpy.allclose(times, numpy.linspace(0, 0.5, 11)), times)
    run("deck.yaml", "--output", "least", "--quiet", "--set", "Time/initial step=0.2", "--set", "Time/maximum step=0.04", "--set", "Time/final time=0.2")
    check(_series("least", "time_step").max() < 0.0401, _series("least", "time_step"))


def a_run_with_snapshots_between_steps_is_resumed_to_the_same_end():
    deck(DECK.replace("interval: 0.25", "interval: 0.15, between steps: interpolate"))
    run("deck.yaml", "--output", "whole", "--quiet")
    run("deck.yaml", "--output", "cut", "--quiet")
    newest = sorted(pathlib.Path("cut").glob("snapshot_*.hdf"))
    for path in newest[-2:]:
        path.unlink()
    run("--resume", "cut", "--quiet")
    check(_series("whole", "energy").tobytes() == _series("cut", "energy").tobytes(), "the energies differ")
    for (time, points), (other_time, other_points) in zip(_pictures("whole"), _pictures("cut"), strict=True):
        check(time == other_time and points.tobytes() == other_points.tobytes(), f"the pictures at {time} differ")


main()
