#!/usr/bin/python3
"""Measures how the phases of a run scale with the number of MPI ranks.

    tests/benchmark/scaling.py [deck] [--ranks 2] [--set "Section/key=value"] [--no-capacity]

The deck is run in three ways, alternately: on one rank; on several ranks (--ranks N); and as N independent one-rank
runs at the same time. The table has one row per phase, with medians over the repetitions:

    ratio       seconds on one rank / seconds on N ranks (of the first rank)
    capacity    N x seconds of one run without others / seconds of one of N independent runs at the same time. It is the
                largest ratio that the machine allows: cores share memory bandwidth, caches, power and the host
    efficiency  ratio / capacity

Communication and waiting are the phase `exchange`; the other phases contain only the work of the rank itself. The phase
`start` includes the start of MPI. The last lines compare the counts and the results of the runs on one and on several
ranks. The machine should have an idle core for every rank.
"""

import argparse
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

from package import SHEAR, answer, command_line, table, tanktread, yaml


def summaries(words, ranks, copies):
    """Returns the summaries of some runs that are made at the same time, by a program with its arguments."""
    words = ["mpirun", "--bind-to", "none", "-n", str(ranks), *words, "--quiet", "--output"]
    with tempfile.TemporaryDirectory() as where:
        places = [pathlib.Path(where, str(copy)) for copy in range(copies)]
        runs = [subprocess.Popen([*words, place], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                                 env=os.environ | tanktread.ENVIRONMENT) for place in places]
        for place, error in zip(places, [run.communicate()[1] for run in runs]):
            if not (place / "summary.yaml").exists():
                sys.exit(error.strip() or "the run wrote no summary")
        return [yaml.safe_load((place / "summary.yaml").read_text()) for place in places]


def seconds(summary):
    """Returns seconds by phase, and of all phases but the start."""
    times = summary["seconds"]
    return times | {"all but start": sum(times.values()) - times.get("start", 0)}


def main():
    parser = command_line(__doc__)
    parser.add_argument("deck", nargs="?", default=tanktread.SOURCE / SHEAR, help="the deck (default: %(default)s)")
    parser.add_argument("--ranks", type=int, default=2, help="number of ranks (default: %(default)s)")
    parser.add_argument("--repeat", type=int, default=5, help="number of repetitions (default: %(default)s)")
    parser.add_argument("--set", dest="settings", action="append", metavar="KEY=VALUE",
                        help="sets a key of the deck (repeatable; default: 24 elements per side, final time 0.4)")
    parser.add_argument("--capacity", action=argparse.BooleanOptionalAction, default=True,
                        help="also make the independent runs that measure the capacity (default: yes)")
    parser.add_argument("--program", default=tanktread.PROGRAM, help="path of the program (default: %(default)s)")
    arguments = parser.parse_args()
    settings = arguments.settings or ["Surface/elements per side=24", "Time/final time=0.4"]
    words = [arguments.program, arguments.deck, *(word for one in settings for word in ("--set", one))]
    many = arguments.ranks
    kinds = {"one": (1, 1), "many": (many, 1)} | ({"side": (1, many)} if arguments.capacity else {})
    runs = {kind: [] for kind in kinds}
    for _ in range(arguments.repeat):
        for kind, (ranks, copies) in kinds.items():
            runs[kind] += summaries(words, ranks, copies)
    times = {kind: list(map(seconds, of_kind)) for kind, of_kind in runs.items()}
    rows = []
    for phase in times["one"][0]:
        middle = [statistics.median(run.get(phase, 0) for run in all_runs) for all_runs in times.values()]
        if min(middle) > 0:
            one, several, *side = middle
            capacity = [many * one / each for each in side]
            rows.append([phase, one, several, one / several, *capacity, *(one / several / each for each in capacity)])
    table(["seconds", "1 rank", f"{many} ranks", "ratio", *["capacity", "efficiency"] * arguments.capacity], rows)
    one, other = runs["one"][0], runs["many"][0]
    for key in ("evaluations", "solver_iterations", "kernel_evaluations_far"):
        print(f"{key}: {one['counts'][key]:.10g} and {other['counts'][key]:.10g}")
    differences = [abs(value - other["final"][key]) for key, value in one["final"].items()
                   if key.split("/")[-1] == "taylor_inertia"]
    print(f"difference of D {max(differences, default=0):.1e}")


if __name__ == "__main__":
    answer(main)
