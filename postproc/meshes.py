#!/usr/bin/python3
"""Meshes of a run at some times, and below each the variation of a field along the section x2 = 0 in polar form (the paper's Figures 15 and 16)."""

import argparse

import numpy

import read
import shape
import style
from style import plt

GRID = 12  # facets along a side of a cell where the section is cut


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("results", nargs="+", help="directories of runs' results; of several, each at the last of the times")
    parser.add_argument("-o", "--output", default="meshes.png", metavar="FILE", help="the picture (default: %(default)s)")
    parser.add_argument("--times", type=float, nargs="+", help="simulated times (default: the start, the middle and the end)")
    parser.add_argument("--field", default="traction", help="field whose variation is drawn (default: %(default)s)")
    parser.add_argument("--reference", type=float, nargs="+", help="reference value of its variation, a circle in the lower row; one, or one a panel")
    parser.add_argument("--view", type=float, nargs=2, default=[-90, 20], metavar=("AZIMUTH", "ELEVATION"), help="where from, in degrees")
    arguments = parser.parse_args()

    runs = [read.run(directory) for directory in arguments.results]
    end = runs[0].series["time"][-1]
    times = arguments.times or ([None] if len(runs) > 1 else [0, end / 2, end])
    shots = [(run, run.snapshot_at(times[-1])) for run in runs] if len(runs) > 1 else [(runs[0], runs[0].snapshot_at(time)) for time in times]

    extents = [shot.points.max(0) - shot.points.min(0) for _, shot in shots]
    tall = max(extent[2] / extent[0] for extent in extents) + 0.12
    figure = plt.figure(figsize=(4 * len(shots), 4 * tall + 3.9), layout="constrained")
    norm, colours = shape.scale([shape.magnitude(shot.fields[arguments.field]) for _, shot in shots])
    grid = figure.add_gridspec(2, len(shots), height_ratios=[4 * tall, 3.6])
    for k, (run, shot) in enumerate(shots):
        axis = figure.add_subplot(grid[0, k])
        shape.draw_surface(axis, shot, arguments.field, norm, colours, *arguments.view)
        points = numpy.interp(shot.time, run.series["time"], run.series["n_control_points"])
        axis.set_title(f"{run.name}, t = {shot.time:.3g}: {points:.0f} control points")
        polar = figure.add_subplot(grid[1, k], projection="polar")
        reference = arguments.reference and arguments.reference[min(k, len(arguments.reference) - 1)]
        draw_variation(polar, shot, arguments.field, reference)
    style.save(figure, arguments.output)


def cut(shot, field):
    """Ends of the short pieces in which the plane x2 = middle cuts the surface: rows of place (from the middle) and field, shape (pieces, 2, 3 + k)."""
    values = shot.fields[field]
    values = values if values.ndim > 1 else values[:, None]
    middle = (shot.points.min(0) + shot.points.max(0)) / 2
    grid = numpy.concatenate([shot.sampled(shot.points, GRID) - middle, shot.sampled(values, GRID)], axis=-1)
    return shape.cut(grid, 1, 0)


def on_section(shot, field):
    """Along the section, by angle: angle, distance from the middle, field."""
    place = cut(shot, field).mean(axis=1)
    angle = numpy.arctan2(place[:, 2], place[:, 0])
    order = numpy.argsort(angle)
    return angle[order], numpy.hypot(place[:, 0], place[:, 2])[order], place[order, 3:]


def section_variation(shot, field):
    """Along the section, by angle: angle, distance from the middle, |d field / dl|."""
    ends = cut(shot, field)
    length = numpy.linalg.norm(ends[:, 1, :3] - ends[:, 0, :3], axis=1)
    ends, length = ends[length > 0.2 * numpy.median(length)], length[length > 0.2 * numpy.median(length)]  # slivers give rounding
    variation = numpy.linalg.norm(ends[:, 1, 3:] - ends[:, 0, 3:], axis=1) / length
    place = ends.mean(axis=1)
    angle = numpy.arctan2(place[:, 2], place[:, 0])
    order = numpy.argsort(angle)
    return angle[order], numpy.hypot(place[:, 0], place[:, 2])[order], variation[order]


def draw_variation(axis, shot, field, reference):
    angle, distance, variation = section_variation(shot, field)
    closed = numpy.append(angle, angle[0] + 2 * numpy.pi)
    top = max(variation.max(), 1.15 * (reference or 0), 1e-12)
    scale = 0.45 * top / distance.max()
    axis.plot(closed, scale * numpy.append(distance, distance[0]), color=style.FAINT, linestyle=(0, (4, 3)), linewidth=1)
    axis.plot(closed, numpy.append(variation, variation[0]), color=style.RUNS[0], linewidth=1)
    if reference:
        axis.plot(numpy.linspace(0, 2 * numpy.pi, 200), [reference] * 200, color=style.RUNS[1], linestyle=":", linewidth=1.4)
    axis.set_ylim(0, 1.05 * top)
    axis.set_xticklabels([])
    axis.tick_params(labelsize=7)
    axis.set_title(f"|d {field}/dl| on the section", fontsize=8.5, loc="center")
    print(f"{shot.path}: largest variation {variation.max():.3g}")


if __name__ == "__main__":
    main()
