#!/usr/bin/python3
"""Branches of steady shapes: D against the parameter, where unstable drawn with a broken line, folds marked; below, the leading rate.

The runs have a list Continuation; the lower part, and what is unstable, need a list Spectrum too.
"""

import argparse

import needs  # before what it looks for
import numpy

import style
import tanktread
from style import plt


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", nargs="+", help="directories of runs' results, or decks")
    parser.add_argument("-o", "--output", default="branch.png", metavar="FILE", help="the picture (default: %(default)s)")
    parser.add_argument("--series", default="taylor_surface", metavar="NAME", help="what is drawn against the parameter (default: %(default)s)")
    parser.add_argument("--exact", type=float, nargs=2, action="append", default=[], metavar=("P", "VALUE"), help="a known point (repeatable)")
    arguments = parser.parse_args()

    runs = [tanktread.run(directory) for directory in arguments.results]
    for run in runs:
        run.require("parameter", "fold", arguments.series)
    rated = all("leading_rate" in run.series for run in runs)
    figure, axes = plt.subplots(1 + rated, 1, figsize=(5.2, 3.4 + 1.8 * rated), sharex=True, squeeze=False, height_ratios=[3, 1.6][: 1 + rated])
    upper = axes[0, 0]
    for run, color in zip(runs, style.RUNS * len(runs)):
        parameter, value, folds = run.series["parameter"], run.series[arguments.series], run.series["fold"] > 0
        draw(upper, parameter, value, unstable(run), color, run.name)
        upper.plot(parameter[folds], value[folds], "o", color=color, markerfacecolor="white")
        for p, d in zip(parameter[folds], value[folds]):
            print(f"{run.name}: fold at {p:.7g}, {arguments.series} = {d:.6f}")
        if rated:
            draw(axes[1, 0], parameter, run.series["leading_rate"], unstable(run), color)
    for p, d in arguments.exact:
        upper.plot(p, d, "+", color=style.INK)
    upper.set_ylabel("Taylor parameter D" if arguments.series.startswith("taylor") else arguments.series)
    if len(runs) > 1:
        upper.legend()
    if rated:
        axes[1, 0].axhline(0, color=style.INK, linewidth=0.6)
        axes[1, 0].set_ylabel("leading rate")
    axes[-1, 0].set_xlabel(runs[0].deck["Continuation"]["parameter"])
    style.save(figure, arguments.output)


def unstable(run):
    """Of each point, whether some mode grows; a fold belongs to both."""
    return run.series.get("unstable_modes", numpy.zeros(len(run.time))) > 0


def draw(axes, x, y, broken, color, label=None):
    """The curve point by point, with a broken line between two points where `broken`."""
    axes.plot([], [], color=color, label=label)
    for k in range(len(x) - 1):
        axes.plot(x[k:k + 2], y[k:k + 2], color=color, linestyle="--" if broken[k:k + 2].any() else "-")
    axes.plot(x, y, ".", color=color, markersize=3)


if __name__ == "__main__":
    main()
