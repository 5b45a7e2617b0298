#!/usr/bin/python3
"""Drops with surfactant: the section of the last snapshot, the concentration along the axis x3, and over time the
deformation and the smallest and largest concentration.
"""

import argparse

import needs  # before what it looks for
import numpy
from matplotlib.collections import LineCollection

import shape
import style
import tanktread
from style import plt


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", nargs="+", help="directories of runs' results, or decks, which are run when they have none; a clean drop among them "
                                                   "is drawn for comparison")
    parser.add_argument("-o", "--output", default="surfactant.png", metavar="FILE", help="the picture (default: %(default)s)")
    arguments = parser.parse_args()

    runs = [tanktread.run(where) for where in arguments.results]
    figure, ((section, along), (deformation, extremes)) = plt.subplots(2, 2, figsize=(7.2, 5.6))
    for run, color in zip(runs, style.RUNS * len(runs)):
        last = run.snapshots()[-1]
        pieces = shape.section(last, last.points[:, 1].mean()) / run.radius
        section.add_collection(LineCollection(pieces, colors=color, linewidths=1.4, capstyle="round"))
        deformation.plot(run.time, run.series["taylor_inertia"], color=color, label=run.name)
        line = f"{run.name}: D = {run.series['taylor_inertia'][-1]:.6f}"
        if "surfactant_mass" in run.series:
            order = numpy.argsort(last.points[:, 2])
            along.plot(last.points[order, 2] / run.radius, last.fields["concentration"][order], ".", color=color, markersize=2)
            extremes.plot(run.time, run.series["largest_concentration"], color=color)
            extremes.plot(run.time, run.series["smallest_concentration"], color=color, linestyle=(0, (4, 2)))
            mass = run.series["surfactant_mass"]
            line += (f", concentration from {run.series['smallest_concentration'][-1]:.5f} to {run.series['largest_concentration'][-1]:.5f}, "
                     f"mass kept to {abs(mass / mass[0] - 1).max():.1e}")
        print(line)
    section.autoscale()
    section.set_aspect("equal")
    section.set_xlabel("$x_1$ / R$_C$")
    section.set_ylabel("$x_3$ / R$_C$")
    along.set_xlabel("$x_3$ / R$_C$")
    along.set_ylabel("concentration / initial one")
    deformation.set_ylabel("D")
    deformation.legend()
    extremes.set_ylabel("largest, smallest concentration")
    for axis in deformation, extremes:
        axis.set_xlabel(tanktread.time_label(runs))
    style.save(figure, arguments.output)


if __name__ == "__main__":
    main()
