#!/usr/bin/python3
"""Meshes of a run at some times, and below each the variation of a field along the section x2 = 0 in polar form (the paper's Figures 15 and 16).

The angle is that of the ellipse as long and as high as the section, of which it makes a circle: in a slender one the tips would not be seen.
"""

import argparse

import needs  # before what it looks for
import numpy

import shape
import style
import tanktread
from style import plt

GRID = 12  # facets along a side of a cell where the section is cut


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", nargs="+", help="directories of runs' results, or decks; of several, each at the last of the times")
    parser.add_argument("-o", "--output", default="meshes.png", metavar="FILE", help="the picture (default: %(default)s)")
    parser.add_argument("--times", type=float, nargs="+", help="simulated times (default: the start, the middle and the end)")
    parser.add_argument("--field", default="traction", help="field whose variation is drawn (default: %(default)s)")
    parser.add_argument("--reference", type=float, nargs="+", help="reference value of its variation, in the deck's unit: a circle in the lower row; one, or one a panel")
    parser.add_argument("--view", type=float, nargs=2, default=shape.VIEW, metavar=("AZIMUTH", "ELEVATION"), help="where from, in degrees")
    arguments = parser.parse_args()

    runs = [tanktread.run(directory) for directory in arguments.results]
    end = runs[0].series["time"][-1]
    times = arguments.times or ([None] if len(runs) > 1 else [0, end / 2, end])
    pairs = [(run, times[-1]) for run in runs] if len(runs) > 1 else [(runs[0], time) for time in times]
    shots = [(run, run.snapshot_at(time).scaled(run)) for run, time in pairs]

    seen = [(shot.points - (shot.points.min(0) + shot.points.max(0)) / 2) @ shape.view_axes(*arguments.view)[:2].T for _, shot in shots]
    tall = 1.15 * numpy.ptp(numpy.concatenate(seen)[:, 1]) / numpy.ptp(numpy.concatenate(seen)[:, 0])
    figure = plt.figure(figsize=(4 * len(shots), 4 * tall + 5.2), layout="constrained")
    norm, colours = shape.scale([shape.magnitude(shot.fields[arguments.field]) for _, shot in shots])
    grid = figure.add_gridspec(3, len(shots), height_ratios=[4 * tall + 0.4, 0.12, 3.9])
    surfaces, tops = [], []
    for k, (run, shot) in enumerate(shots):
        surfaces.append(figure.add_subplot(grid[0, k]))
        shape.draw_surface(surfaces[-1], shot, arguments.field, norm, colours, *arguments.view)
        points = run.series["n_control_points"][numpy.searchsorted(run.series["time"], shot.time * (1 + 1e-12), side="right") - 1]
        surfaces[-1].set_title(f"{run.name}\nt = {shot.time:.3g}: {points:.0f} control points")
        polar = figure.add_subplot(grid[2, k], projection="polar")
        unit = run.scale(tanktread.DIMENSIONS.get(arguments.field))[0] / run.scale("length")[0]
        reference = arguments.reference and arguments.reference[min(k, len(arguments.reference) - 1)] / unit
        tops.append((draw_variation(polar, shot, arguments.field, reference), polar))
        if reference and (k == 0 or len(set(arguments.reference)) > 1):
            polar.legend(loc="upper left", bbox_to_anchor=(-0.1, 0.04))
    share_window(surfaces)
    for _, polar in tops:
        polar.set_ylim(0, 1.05 * max(top for top, _ in tops))
    vector = numpy.ndim(shots[0][1].fields[arguments.field]) > 1
    figure.colorbar(plt.cm.ScalarMappable(norm, colours), cax=figure.add_subplot(grid[1, len(shots) // 2]), orientation="horizontal",
                    label=tanktread.field_label(runs, arguments.field, "|{}|" if vector else "{}"))
    style.save(figure, arguments.output)


def share_window(axes):
    """All surfaces on the same scale, each in the middle of its panel."""
    limits = numpy.array([[axis.get_xlim(), axis.get_ylim()] for axis in axes])
    middles, half = limits.mean(2), numpy.ptp(limits, axis=2).max(0) / 2
    for axis, middle in zip(axes, middles):
        axis.set_xlim(middle[0] - half[0], middle[0] + half[0])
        axis.set_ylim(middle[1] - half[1], middle[1] + half[1])
        axis.set_anchor("C")


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
    """Along the section, by the angle that makes a circle of its ellipse: angle, |d field / dl|."""
    ends = cut(shot, field)
    length = numpy.linalg.norm(ends[:, 1, :3] - ends[:, 0, :3], axis=1)
    ends, length = ends[length > 0.2 * numpy.median(length)], length[length > 0.2 * numpy.median(length)]  # slivers give rounding
    variation = numpy.linalg.norm(ends[:, 1, 3:] - ends[:, 0, 3:], axis=1) / length
    place = ends.mean(axis=1)
    angle = numpy.arctan2(place[:, 2] / abs(place[:, 2]).max(), place[:, 0] / abs(place[:, 0]).max())
    order = numpy.argsort(angle)
    return angle[order], variation[order]


def draw_variation(axis, shot, field, reference):
    """Returns how far out it reaches."""
    angle, variation = section_variation(shot, field)
    closed = numpy.append(angle, angle[0] + 2 * numpy.pi)
    top = max(variation.max(), 1.15 * (reference or 0), 1e-12)
    axis.plot(closed, numpy.append(variation, variation[0]), color=style.RUNS[0], linewidth=1, label=f"|d {field}/dl|")
    if reference:
        axis.plot(numpy.linspace(0, 2 * numpy.pi, 200), [reference] * 200, color=style.RUNS[1], linestyle=":", linewidth=1.6,
                  label=f"reference, {reference:g}")
    axis.set_xticks(numpy.radians([0, 90, 180, 270]), ["x₁", "x₃", "", ""])
    axis.set_rlabel_position(55)
    axis.tick_params(labelsize=7.5)
    axis.set_title(f"|d {field}/dl| on the section x₂ = 0, l in R$_C$", fontsize=8.5, loc="center")
    print(f"{shot.path}: largest variation {variation.max():.3g}")
    return top


if __name__ == "__main__":
    main()
