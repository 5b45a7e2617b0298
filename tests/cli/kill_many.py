#!/usr/bin/python3
# label: long
# ranks: 2
# Tests that a run with 64 capsules, killed at any moment, is resumed from its last checkpoint: bitwise equal on the
# same number of ranks, equal up to rounding on other numbers. The third argument is the number of kills (default:
# 20).
import pathlib
import random
import signal
import sys
import time

import numpy

from harness import check, main, run, series, start

KILLS = int(sys.argv[3]) if len(sys.argv) > 3 else 20
DECK = "inputs/suspension.yaml"
SHORT = ["--set", "Time/final time=0.2", "--set", "Output/interval=0.05", "--quiet"]
SERIES = ["time", "cell 1/taylor_inertia", "cell 64/taylor_inertia", "cell 17/centroid_x3", "smallest_gap", "stresslet_13", "evaluations"]


def _largest_difference(one, other):
    return max(numpy.max(numpy.abs(series(one, name) - series(other, name))) / max(1, numpy.max(numpy.abs(series(one, name)))) for name in SERIES)


def a_killed_run_is_resumed():
    whole, seconds = {}, {}
    for ranks in (1, 2):
        begin = time.monotonic()
        run(DECK, *SHORT, "--output", f"whole_{ranks}", ranks=ranks, timeout=3600)
        seconds[ranks] = time.monotonic() - begin
    off = _largest_difference("whole_1", "whole_2")
    check(off <= 1e-10, f"two ranks differ from one by {off:.1e}")
    moments, worst, resumed = random.Random(5), 0, 0
    for k in range(KILLS):
        before, after = 1 + k % 2, 1 + k // 2 % 4
        results = f"killed_{k}"
        process = start(DECK, *SHORT, "--output", results, ranks=before)
        time.sleep(moments.uniform(0.1, 0.7) * seconds[before])
        process.send_signal(signal.SIGKILL)
        process.communicate()
        if process.returncode != -signal.SIGKILL:
            continue  # it was done
        time.sleep(1)  # mpirun has ended; its processes end shortly afterwards
        if not any(pathlib.Path(results).glob("snapshot_*.hdf")):
            continue  # no snapshot had been written yet
        went_on = run("--resume", results, "--quiet", ranks=after, timeout=3600, code=None)
        check(went_on.returncode == 0, results, went_on.stderr)
        resumed += 1
        off = _largest_difference(f"whole_{before}", results)
        worst = max(worst, off)
        check(off == 0 if before == after else off <= 1e-10, f"{results}: {before} and then {after} processes: off by {off:.1e}")
    print(f"{resumed} resumed, at most {worst:.1e} off")
    check(resumed > KILLS / 2, f"only {resumed} of {KILLS} were killed before their end")


main()
