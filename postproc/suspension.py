#!/usr/bin/python3
"""Effective viscosity and normal stress differences of a lattice of particles over strain, with their averages from a strain on.

Averages carry a standard error by blocks: the spread of the means of `--blocks` equal parts of the strain, over the root of their number.
"""

import argparse

import needs  # before what it looks for
import numpy

import style
import tanktread
from style import plt

SERIES = {"relative_viscosity": "μ_eff/μ", "normal_stress_difference_1": "N₁", "normal_stress_difference_2": "N₂"}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", nargs="+", help="directories of runs' results, or decks, which are run when they have none")
    parser.add_argument("--from", type=float, default=1, dest="first", metavar="STRAIN", help="where averages begin (default: %(default)s)")
    parser.add_argument("--blocks", type=int, default=8, help="of an average (default: %(default)s)")
    parser.add_argument("-o", "--output", default="suspension.png", metavar="FILE", help="the picture (default: %(default)s)")
    arguments = parser.parse_args()

    runs = [tanktread.run(where) for where in arguments.results]
    figure, (upper, lower) = plt.subplots(2, 1, figsize=(6.4, 6.4), sharex=True)
    for run, color in zip(runs, style.RUNS * len(runs)):
        run.require(*SERIES)
        strain = run.time
        label = f"{run.name}, φ = {run.series['volume_fraction'][0]:.3g}"
        words = []
        for name, symbol in SERIES.items():
            values = run.series[name]
            axes, line = (upper, "-") if name == "relative_viscosity" else (lower, "-" if name.endswith("1") else "--")
            axes.plot(strain, values, color=color, linestyle=line, label=label if axes is upper else symbol if run is runs[0] else None)
            mean, error = average(strain, values, arguments.first, arguments.blocks)
            if numpy.isfinite(mean):
                axes.plot([arguments.first, strain[-1]], [mean, mean], color=color, linewidth=0.8, linestyle=":")
            words.append(f"{symbol} = {mean:.5f} ± {error:.5f}")
        print(f"{run.name}, strain {arguments.first:g} to {strain[-1]:g}: {', '.join(words)}")
    upper.set_ylabel("effective viscosity μ_eff/μ")
    upper.legend()
    lower.axhline(0, color=style.FAINT, linewidth=0.8)
    lower.set_ylabel("normal stress differences")
    lower.set_xlabel("strain")
    lower.legend()
    style.save(figure, arguments.output)


def average(strain, values, first, blocks):
    """Mean over the strain from `first` on, by the trapezoidal rule, and its standard error from equal blocks."""
    if strain[-1] <= first:
        return numpy.nan, numpy.nan
    integral = numpy.concatenate([[0], numpy.cumsum(numpy.diff(strain) * (values[1:] + values[:-1]) / 2)])
    ends = numpy.linspace(first, strain[-1], blocks + 1)
    means = numpy.diff(numpy.interp(ends, strain, integral)) / numpy.diff(ends)
    return means.mean(), means.std(ddof=1) / numpy.sqrt(blocks)


if __name__ == "__main__":
    main()
