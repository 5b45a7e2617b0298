#!/usr/bin/python3
"""Error of a run's deformation against a reference curve: over time, against the mesh, against seconds and velocity evaluations.

    postproc/convergence.py results/n3 results/n6 results/n12 --curve nh_shear_ca0.3_spectral.csv

The curve is a table with the columns `t`, which is time times the rate of the flow, and `taylor_inertia`. A line joins runs that agree in Time/scheme and Time/tolerance.
"""

import argparse

import needs  # before what it looks for
import numpy

import literature
import style
import tanktread
from style import plt


class Errors:
    """Of one run: `times` and `errors` of the series within the curve, its largest error, its mesh and what it cost."""

    def __init__(self, run, curve, series):
        t = run.time
        inside = (t >= curve["t"][0]) & (t <= curve["t"][-1])
        self.run, self.times = run, t[inside]
        self.errors = numpy.array([literature.difference([time], [value], curve["t"], curve[series])
                                   for time, value in zip(t[inside], run.series[series][inside])])
        self.largest = self.errors.max()
        self.points = run.series["n_control_points"][-1]
        self.seconds, self.evaluations = run.series["wall_seconds"][-1], run.series["evaluations"][-1]

    @property
    def family(self):
        return f"{self.run.value('Time/scheme')}, tolerance {self.run.value('Time/tolerance'):g}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", nargs="+", help="directories of runs' results")
    parser.add_argument("--curve", required=True, metavar="FILE", help="the reference: a table with named columns")
    parser.add_argument("--series", default="taylor_inertia", help="which series, and column of the curve (default: %(default)s)")
    parser.add_argument("-o", "--output", default="convergence.png", metavar="FILE", help="the picture (default: %(default)s)")
    arguments = parser.parse_args()

    curve = literature.table(arguments.curve, ("t", arguments.series))
    runs = sorted((Errors(tanktread.run(directory), curve, arguments.series) for directory in arguments.results), key=lambda one: one.points)
    families = sorted({one.family for one in runs})
    color = dict(zip(families, style.RUNS * len(families)))

    figure, axes = plt.subplots(2, 2, figsize=(9.6, 7))
    draw_times(axes[0, 0], runs)
    for axis, cost, label in ((axes[0, 1], "points", "control points"), (axes[1, 0], "seconds", "seconds"), (axes[1, 1], "evaluations", "velocity evaluations")):
        for family in families:
            members = [one for one in runs if one.family == family]
            axis.loglog([getattr(one, cost) for one in members], [one.largest for one in members], "o-", color=color[family], ms=4, label=family)
        axis.set_xlabel(label)
        axis.set_ylabel(f"largest error of {arguments.series}")
    draw_order(axes[0, 1], runs)
    axes[0, 1].legend(loc="lower left")
    style.save(figure, arguments.output)
    report(runs, families)


def draw_times(axis, runs):
    shades = plt.get_cmap("viridis")(numpy.linspace(0.1, 0.8, len(runs)))
    for one, shade in zip(runs, shades):
        axis.semilogy(one.times, numpy.maximum(one.errors, 1e-12), color=shade, linewidth=1.2, label=one.run.name)
    axis.set_ylim(0.1 * min(numpy.median(one.errors) for one in runs), 30 * runs[0].largest)  # room for the legend
    axis.set_xlabel(tanktread.time_label([one.run for one in runs]))
    axis.set_ylabel("error")
    axis.legend(loc="upper left", ncols=2)


def draw_order(axis, runs):
    """What fourth order in the mesh size would do from the coarsest mesh on."""
    n = numpy.array([runs[0].points, runs[-1].points])
    if n[1] > n[0]:
        axis.loglog(n, 0.3 * runs[0].largest * (n / n[0]) ** -2.0, color=style.FAINT, linestyle=(0, (4, 3)), label="fourth order")


def report(runs, families):
    """Largest errors and, for each family of several meshes, the order fitted in the mesh size (control points to the power -1/2)."""
    for one in runs:
        print(f"{one.run.name}: {one.points:.0f} control points, {one.family}: largest error {one.largest:.2e}, "
              f"{one.evaluations:.0f} evaluations, {one.seconds:.2f} s")
    for family in families:
        members = [one for one in runs if one.family == family]
        if len({one.points for one in members}) > 1:
            slope = numpy.polyfit(numpy.log([one.points for one in members]), numpy.log([one.largest for one in members]), 1)[0]
            print(f"{family}: order {-2 * slope:.2f}")


if __name__ == "__main__":
    main()
