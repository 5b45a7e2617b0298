#!/usr/bin/python3
"""Folds of branches against a second parameter: where drops burst against their viscosity, capsules against their pre-inflation; D there below.

The runs have Continuation/second parameter; several are drawn as curves of one figure. What they found is listed, one line a fold.
"""

import argparse
import sys

import needs  # before what it looks for
import numpy

import style
import tanktread
from style import plt


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", nargs="+", help="directories of runs' results, or decks")
    parser.add_argument("-o", "--output", default="folds.png", metavar="FILE", help="the picture (default: %(default)s)")
    parser.add_argument("--series", default="taylor_surface", metavar="NAME", help="what is drawn below (default: %(default)s)")
    parser.add_argument("--exact", type=float, nargs=2, action="append", default=[], metavar=("SECOND", "VALUE"), help="a known fold (repeatable)")
    arguments = parser.parse_args()

    runs = [tanktread.run(directory) for directory in arguments.results]
    figure, (upper, lower) = plt.subplots(2, 1, figsize=(5.2, 5.2), sharex=True, height_ratios=[3, 2])
    names, reached = set(), []
    for run, color in zip(runs, style.RUNS * len(runs)):
        run.require("parameter", "second_parameter", "fold", arguments.series)
        continuation = run.deck["Continuation"]
        names.add((continuation["second parameter"], continuation["parameter"]))
        folds = numpy.flatnonzero(run.series["fold"] > 0)
        folds = folds[numpy.argsort(run.series["second_parameter"][folds], kind="stable")]
        second, parameter, value = (run.series[name][folds] for name in ("second_parameter", "parameter", arguments.series))
        reached += list(second)
        upper.plot(second, parameter, "o-", color=color, markersize=3.5, label=run.name)
        lower.plot(second, value, "o-", color=color, markersize=3.5)
        for row in zip(second, parameter, value):
            print(f"{run.name}: {continuation['second parameter']} {row[0]:.7g}: fold at {row[1]:.7g}, {arguments.series} = {row[2]:.6f}")
    if len(names) > 1:
        sys.exit("folds.py: one figure has one pair of parameters; these runs have " + "; ".join(" against ".join(pair[::-1]) for pair in sorted(names)))
    for point in arguments.exact:
        upper.plot(*point, "+", color=style.INK, markersize=9)
    second, parameter = names.pop()
    if min(reached) > 0 and max(reached) > 10 * min(reached):
        lower.set_xscale("log")
    if len(runs) > 1:
        upper.legend()
    upper.set_ylabel(parameter + " at the fold")
    lower.set_ylabel("Taylor parameter D there" if arguments.series.startswith("taylor") else arguments.series + " there")
    lower.set_xlabel(second)
    style.save(figure, arguments.output)


if __name__ == "__main__":
    main()
