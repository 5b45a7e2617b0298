#!/usr/bin/python3
"""Whether a run over many turns of a membrane drifts: series against the turns, the mean of each turn, and a straight line through these means.

    drift.py inputs/red_cell_treading.yaml --set 'Surface/elements per side=4' --set 'Time/final time=101.5' --set 'Output/interval=20' \\
        --set 'Flow/history/times=[0, 100, 100, 200]' --set 'Flow/history/amplitudes=[1, 1, 0, 0]'      # two hundred turns, then no flow
    drift.py results/red_cell_treading

A turn is one of `phase`. Those before --from are left out of the line, which is told as its change over the others, with its standard error. Where the
flow has a history that ends in rest, how often the energy then rises.
"""

import argparse

import needs  # before what it looks for
import numpy

import style
import study
import sweep
import tanktread
from style import plt

SERIES = {"area": "area / its first value − 1", "volume_error": "V / V$_0$ − 1", "energy": "energy / its mean − 1", "taylor_inertia": "D",
          "inclination": "inclination / degrees"}


def turns(time, values, phase):
    """Returns means in time over whole turns of the phase. Rows with NaN, where a series is undefined, are left out."""
    ends = numpy.interp(360 * numpy.arange(phase.max() // 360 + 1), phase, time)
    time, values = time[~numpy.isnan(values)], values[~numpy.isnan(values)]
    whole = numpy.concatenate([[0], numpy.cumsum((values[1:] + values[:-1]) / 2 * numpy.diff(time))])
    return numpy.diff(numpy.interp(ends, time, whole)) / numpy.diff(ends)


def drift(means, first):
    """The change of a straight line over all turns from `first` on, and its standard error."""
    number = numpy.arange(first, len(means))
    (slope, _), covariance = numpy.polyfit(number, means[first:], 1, cov=True)
    return slope * (len(number) - 1), covariance[0, 0] ** 0.5 * (len(number) - 1)


def flow_of(run):
    """When the flow begins to end, and from when on it is at rest; never where its history does not end so."""
    amplitudes, times = (numpy.atleast_1d(run.value(f"Flow/history/{name}", [])) for name in ("amplitudes", "times"))
    on = numpy.flatnonzero(amplitudes)
    if len(on) and len(times) == len(amplitudes) and on[-1] + 1 < len(times):
        return times[on[-1]], times[on[-1] + 1]
    return numpy.inf, numpy.inf


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", help="a deck, or the directory of a run's results")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="another key of the deck; may be there many times")
    parser.add_argument("--from", dest="first", type=int, default=10, metavar="TURN", help="of the line (default: %(default)s)")
    parser.add_argument("-o", "--output", default="drift.png", metavar="FILE", help="the picture (default: %(default)s)")
    arguments = parser.parse_args()
    sweep.expect(arguments.first >= 0, f"--from needs a turn, but is given {arguments.first}")
    sweep.expect(not arguments.set or arguments.run.endswith(".yaml"), f"--set changes keys of a deck, but {arguments.run} is none")
    run = tanktread.run(arguments.run, study.settings_of(arguments.set))
    run.require("phase", *SERIES)
    stop, rest = flow_of(run)
    flows = run.series["time"] <= stop
    time, phase = run.series["time"][flows], run.series["phase"][flows]
    sweep.expect(phase[-1] / 360 >= arguments.first + 3, f"{run.directory} has {max(phase[-1] / 360, 0):.1f} turns; a line from turn {arguments.first} on needs "
                 f"{arguments.first + 3}: a later Time/final time, or --from an earlier one")
    figure, plots = plt.subplots(len(SERIES), 1, figsize=(6.4, 7.6), sharex=True)
    print(f"{phase[-1] / 360:.1f} turns, {len(time)} steps; the largest error of the volume {numpy.abs(run.series['volume_error']).max():.2g}")
    for (name, label), plot in zip(SERIES.items(), plots):
        values = run.series[name][flows]
        means = turns(time, values, phase)
        scale = {"area": values[0], "energy": means.mean()}.get(name)
        if scale:
            values, means = values / scale - 1, means / scale - 1
        change, error = drift(means, arguments.first)
        later, within = means[arguments.first:], values[(phase > 360 * arguments.first) & ~numpy.isnan(values)]
        print(f"{name}: changes by {change:.2g} ± {error:.1g} over {len(later)} turns; their means {later.min():.6g} to {later.max():.6g}, "
              f"within turns {within.min():.6g} to {within.max():.6g}")
        plot.plot(phase / 360, values, color=style.FAINT, linewidth=0.3)
        plot.plot(numpy.arange(len(means)) + 0.5, means, color=style.RUNS[0], linewidth=1)
        plot.set_ylabel(label, fontsize=8)
    plots[-1].set_xlabel("turns of the membrane")
    energy = run.series["energy"][run.series["time"] >= rest]
    if len(energy) > 1:
        print(f"without flow the energy goes from {energy[0]:.6g} to {energy[-1]:.6g} in {len(energy)} steps; it rises in {(numpy.diff(energy) > 0).sum()}")
    style.save(figure, arguments.output)


if __name__ == "__main__":
    sweep.answer(main)
