#!/usr/bin/python3
"""Particles beside a plane wall: sections at several moments with the wall, the gap over time, and how fast the centroid moves along the wall and away
from it. Lengths over R_C.
"""

import argparse

import needs  # before what it looks for
import numpy
from matplotlib.collections import LineCollection

import literature
import shape
import style
import tanktread
from style import plt


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", nargs="+", help="directories of runs' results, or decks, which are run when they have none")
    parser.add_argument("--times", type=int, default=5, help="how many moments are drawn (default: %(default)s)")
    parser.add_argument("--curve", metavar="FILE", help="a gap over time to lay beside the first one, comma-separated, in the units of the figure")
    parser.add_argument("-o", "--output", default="plane_wall.png", metavar="FILE", help="the picture (default: %(default)s)")
    arguments = parser.parse_args()

    runs = [tanktread.run(where) for where in arguments.results]
    figure = plt.figure(figsize=(7.2, 2.6 * len(runs) + 2.8))
    grid = figure.add_gridspec(len(runs) + 1, 2, height_ratios=[1] * len(runs) + [1.1])
    gap, speed = (figure.add_subplot(grid[-1, k]) for k in (0, 1))
    for k, (run, color) in enumerate(zip(runs, style.RUNS * len(runs))):
        run.require("gap")
        sections(figure.add_subplot(grid[k, :]), run, arguments.times)
        gap.plot(run.time, run.series["gap"] / run.radius, color=color, label=run.name)
        away, along = velocities(run)
        speed.plot(run.time, away, color=color, label="away" if k == 0 else None)
        speed.plot(run.time, along, color=color, linestyle=(0, (4, 2)), label="along" if k == 0 else None)
        print(f"{run.name}: gap from {run.series['gap'][0] / run.radius:.6g} to {run.series['gap'][-1] / run.radius:.6g} R_C; "
              f"velocity away from the wall {away[-1]:.5g}, along it {along[-1]:.5g}")
    if arguments.curve:
        curve = literature.table(arguments.curve)
        gap.plot(curve[:, 0], curve[:, 1], style.MARKS[0], color=style.INK, markersize=3, label="exact")
    gap.set_yscale("log")
    gap.set_ylabel("gap / R$_C$")
    speed.axhline(0, color=style.FAINT, linewidth=0.8)
    speed.set_ylabel(runs[0].label("velocity", "centroid's {}"))
    for axis in gap, speed:
        axis.set_xlabel(tanktread.time_label(runs))
        axis.legend()
    style.save(figure, arguments.output)


def wall(run):
    """A point of the wall, its normal, and the direction along it that sections are drawn in: of x1, or x3 where that is the normal."""
    point, normal = (numpy.array(run.value(f"Wall/{key}"), float) for key in ("point", "normal"))
    normal /= numpy.linalg.norm(normal)
    along = numpy.eye(3)[2 if abs(normal[0]) > 0.9 else 0]
    along -= along @ normal * normal
    return point, normal, along / numpy.linalg.norm(along)


def velocities(run):
    """Of the centroid, or the mean of all particles: away from the wall, and along it."""
    _, normal, along = wall(run)
    velocity = numpy.array([run.series[f"velocity_x{k}"] for k in (1, 2, 3)]) / run.scale("velocity")[0]
    return normal @ velocity, along @ velocity


def sections(axis, run, moments):
    """Across the axis that is farthest from the normal and the direction along, through the mean of each particle there."""
    point, normal, along = wall(run)
    shots = run.snapshots()
    chosen = [shots[k] for k in sorted(set(numpy.linspace(0, len(shots) - 1, moments).round().astype(int)))]
    colours = plt.get_cmap(style.TIME)(numpy.linspace(0.15, 0.95, len(chosen)))
    for shot, colour in zip(chosen, colours):
        across = numpy.argmin(abs(normal) + abs(along))
        pieces = shape.section(shot, shot.points[:, across].mean(), across)
        places = numpy.insert(pieces, across, 0, axis=2) - numpy.where(numpy.arange(3) == across, 0, point)
        axis.add_collection(LineCollection(numpy.stack([places @ along, places @ normal], axis=2) / run.radius, colors=colour))
        axis.plot([], [], color=colour, label=f"{shot.time * run.rate[0]:.3g}")
    axis.axhspan(-0.15, 0, color=style.FAINT, alpha=0.5, linewidth=0)
    axis.autoscale_view()
    axis.set_ylim(bottom=-0.15)
    axis.set_aspect("equal")
    axis.set_title(f"{run.name}: section across the wall at several times")
    axis.set_xlabel("along the wall / R$_C$")
    axis.set_ylabel("above it / R$_C$")
    axis.legend(ncols=2, fontsize=7, loc="center left", bbox_to_anchor=(1, 0.5))


if __name__ == "__main__":
    main()
