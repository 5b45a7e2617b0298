#!/usr/bin/python3
"""How the phases of a run scale with the number of ranks.

    postproc/scaling.py [deck] [--ranks 2] [--set "Section/key=value"]

Runs the deck on one rank and on several, in turns, and prints seconds a phase and their ratio: medians over the repetitions, of the first rank.
Waiting and messages are the phase `exchange`, so that a phase is a rank's own work; the last lines say whether both runs did the same.
The machine should have a free core for every rank.
"""

import argparse
import os
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile

SOURCE = pathlib.Path(__file__).resolve().parent.parent
ENVIRONMENT = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}


def summary(program, deck, settings, ranks):
    """Text of summary.yaml after a run."""
    with tempfile.TemporaryDirectory() as where:
        words = ["mpirun", "--bind-to", "none", "-n", str(ranks), str(program), str(deck), "--quiet", "--output", where]
        for setting in settings:
            words += ["--set", setting]
        done = subprocess.run(words, capture_output=True, text=True, env=os.environ | ENVIRONMENT, check=False)
        path = pathlib.Path(where) / "summary.yaml"
        if not path.exists():
            sys.exit(done.stderr.strip() or "the run wrote no summary")
        return path.read_text()


def seconds(text):
    """By phase."""
    block = re.search(r"^seconds:\n((?:  .*\n)*)", text, re.M)[1]
    return {name: float(value) for name, value in re.findall(r"^  (.+): (\S+)$", block, re.M)}


def value(text, key):
    return float(re.findall(rf"^  {key}: (\S+)$", text, re.M)[0])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("deck", nargs="?", default=SOURCE / "inputs/shear_neo_hookean.yaml")
    parser.add_argument("--ranks", type=int, default=2)
    parser.add_argument("--repeat", type=int, default=5, help="runs of each kind (default: %(default)s)")
    parser.add_argument("--set", dest="settings", action="append", metavar="KEY=VALUE",
                        help="(default: 24 elements a side, to time 0.4)")
    parser.add_argument("--program", default=SOURCE / "build/release/app/tanktread")
    arguments = parser.parse_args()
    settings = arguments.settings or ["Surface/elements per side=24", "Time/final time=0.4"]
    runs = {1: [], arguments.ranks: []}
    for _ in range(arguments.repeat):
        for ranks, texts in runs.items():
            texts.append(summary(arguments.program, arguments.deck, settings, ranks))
    one, many = ([seconds(text) for text in runs[ranks]] for ranks in (1, arguments.ranks))
    for times in one + many:
        times["total"] = sum(times.values())
    print(f"{'seconds':>18}{'1 rank':>12}{f'{arguments.ranks} ranks':>12}{'ratio':>8}")
    for phase in one[0]:
        first, last = (statistics.median(times.get(phase, 0) for times in kind) for kind in (one, many))
        print(f"{phase:>18}{first:>12.4g}{last:>12.4g}{first / last if last > 0 else 0:>8.2f}")
    for key in ("evaluations", "solver_iterations", "kernel_evaluations_far"):
        print(f"{key:>24}{value(runs[1][0], key):>16.10g}{value(runs[arguments.ranks][0], key):>16.10g}")
    difference = abs(value(runs[1][0], "taylor_inertia") - value(runs[arguments.ranks][0], "taylor_inertia"))
    print(f"{'difference of D':>24}{difference:>16.1e}")


if __name__ == "__main__":
    main()
