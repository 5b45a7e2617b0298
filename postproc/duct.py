#!/usr/bin/python3
"""The section of the tube with the velocity of the empty tube, and the path of the particle's centroid across it."""

import argparse
import sys

import needs  # before what it looks for
import h5py
import numpy

import style
import tanktread
from style import plt

STEP = 0.2  # between contours, in mean velocities


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("results", nargs="+", help="directories of runs' results, or decks, which are run when they have none; one panel each")
    parser.add_argument("-o", "--output", default="duct.png", metavar="FILE", help="the picture (default: %(default)s)")
    parser.add_argument("--no-path", action="store_true", help="without the path of the centroid")
    arguments = parser.parse_args()

    runs = [tanktread.run(directory) for directory in arguments.results]
    ducts = [duct(run.directory) for run in runs]
    top = max(d["maximum"][2] / d["mean_velocity"] for d in ducts)
    places = numpy.concatenate([d["outline"] for d in ducts])
    room = 0.02 * numpy.ptp(places, axis=0).max()
    low, high = places.min(0) - room, places.max(0) + room  # of every panel: one scale
    levels = numpy.append(numpy.arange(0, top, STEP), top)
    figure, axes = plt.subplots(1, len(ducts), figsize=(3.9 * len(ducts) + 0.9, 4.0), squeeze=False)
    for axis, d, run in zip(axes[0], ducts, runs):
        filled = draw_section(axis, d, levels)
        if not arguments.no_path:
            draw_path(axis, run, d["radius"])
        axis.set_xlim(low[0], high[0])
        axis.set_ylim(low[1], high[1])
        axis.set_title(f"{run.name}: largest {d['maximum'][2] / d['mean_velocity']:.4f}", pad=10)
    axes[0][0].set_ylabel("x₃ / R$_T$")
    axes[0][0].legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=2, handlelength=1.5)
    figure.colorbar(filled, ax=list(axes[0]), label="velocity of the empty tube over its mean", shrink=0.8, ticks=levels[:-1:2],
                    spacing="proportional")
    style.save(figure, arguments.output)


def duct(directory):
    """The arrays of duct.h5 by name, places over R_T, the `radius`."""
    try:
        with h5py.File(f"{directory}/duct.h5", "r") as file:
            arrays = {name: data[()] for name, data in file.items()}
        for name in "outline", "x2", "x3":
            arrays[name] = arrays[name] / arrays["radius"]
        arrays["maximum"][:2] /= arrays["radius"]
        return arrays
    except OSError:
        sys.exit(f"{directory} holds no duct.h5: give the directory of a run in a tube")


def draw_section(axis, d, levels):
    """Contours to the very wall: the grid's own edge is hidden by the wall's polygon, beyond which nothing is shown."""
    velocity = spread(d["velocity"] / d["mean_velocity"])
    filled = axis.contourf(d["x2"], d["x3"], velocity, levels, cmap=style.FIELD)
    lines = axis.contour(d["x2"], d["x3"], velocity, levels[1:-1], colors="white", linewidths=0.5, alpha=0.7)
    wall = plt.Polygon(d["outline"], facecolor="none", edgecolor=style.INK, linewidth=1.6)
    axis.add_patch(wall)
    for artist in filled.collections + lines.collections if hasattr(filled, "collections") else [filled, lines]:
        artist.set_clip_path(wall)
    axis.plot(*d["maximum"][:2], marker="+", color=style.INK, markersize=9, linestyle="none", label="largest velocity")
    axis.set_aspect("equal")
    axis.grid(False)
    axis.spines[:].set_visible(False)
    axis.set_xlabel("x₂ / R$_T$")
    return filled


def spread(velocity):
    """Values beyond the wall by extrapolation from the inside, so that the lines of contour reach the wall: one ring of points at a time."""
    v = velocity.copy()
    for _ in range(2):
        padded = numpy.pad(v, 2, constant_values=numpy.nan)
        middle = slice(2, -2)
        guesses = []
        for d2, d3 in (0, 1), (0, -1), (1, 0), (-1, 0), (1, 1), (1, -1), (-1, 1), (-1, -1):
            near = padded[2 + d3:padded.shape[0] - 2 + d3, 2 + d2:padded.shape[1] - 2 + d2]
            far = numpy.roll(padded, (-2 * d3, -2 * d2), (0, 1))[middle, middle]
            guesses.append(2 * near - far)
        guesses = numpy.array(guesses)
        known = numpy.isfinite(guesses)
        mean = numpy.where(known, guesses, 0).sum(0) / numpy.maximum(known.sum(0), 1)
        v = numpy.where(numpy.isfinite(v), v, numpy.where(known.any(0), numpy.minimum(mean, 0), numpy.nan))
    return v


def draw_path(axis, run, radius):
    if "centroid_x2" not in run.series:
        return
    x2, x3 = (run.series[name] / radius for name in ("centroid_x2", "centroid_x3"))
    axis.plot(x2, x3, color=style.RUNS[1], linewidth=1.6, label="path of the centroid")
    axis.plot(x2[0], x3[0], color=style.RUNS[1], marker="o", markersize=4)


if __name__ == "__main__":
    main()
