#!/usr/bin/python3
"""A channel cut open with its particle at several moments; extents, velocity and pressure drop against the way of the centroid; the wall's
shear stress and the velocity on the centre line of the empty channel.

    channel.py results/capsule_constriction -o channel.png
"""

import argparse
import sys

import needs  # before what it looks for
import h5py
import numpy
from matplotlib.collections import LineCollection

import shape
import style
import tanktread
from style import plt


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", help="directory of a run's results, or a deck, which is run when it has none")
    parser.add_argument("-o", "--output", default="channel.png", metavar="FILE", help="the picture (default: %(default)s)")
    parser.add_argument("--shapes", type=int, default=7, metavar="N", help="moments of the particle, evenly along its way (default: %(default)s)")
    parser.add_argument("--across", type=int, choices=(2, 3), default=2, help="the section x2 = 0 or x3 = 0 is drawn, of a bend x3 = 0 (default: x2 = 0)")
    arguments = parser.parse_args()
    run = tanktread.run(arguments.results)
    style.save(picture(run, channel(run.directory), arguments.shapes, arguments.across), arguments.output)


def channel(directory):
    """The arrays of channel.h5 by name."""
    try:
        with h5py.File(f"{directory}/channel.h5", "r") as file:
            return {name: data[()] for name, data in file.items()}
    except OSError:
        sys.exit(f"{directory} holds no channel.h5: give the directory of a run in a channel")


def centroid(run):
    """Its places, shape (rows, 3)."""
    name = "center_x" if "center_x1" in run.series else "centroid_x"
    return numpy.column_stack([run.series[f"{name}{k}"] for k in (1, 2, 3)])


def way_along(run, c):
    """Of the centroid, along the centre line: to the nearest of its places, and on along it."""
    places = centroid(run)
    nearest = numpy.argmin(numpy.linalg.norm(places[:, None] - c["centre"][None], axis=2), axis=1)
    along = numpy.gradient(c["centre"], c["s"], axis=0)[nearest]
    return c["s"][nearest] + numpy.sum((places - c["centre"][nearest]) * along, axis=1)


def picture(run, c, n, across):
    figure, axes = plt.subplot_mosaic([["cut", "cut"], ["extents", "velocity"], ["pressure", "wall"]], figsize=(10.5, 9.5), height_ratios=[1.1, 1, 1])
    cut_open(axes["cut"], run, c, n, across - 1)
    along_the_way(axes, run, c)
    wall(axes["wall"], run, c)
    return figure


def cut_open(axis, run, c, n, across):
    bent = numpy.ptp(c["centre"][:, 1]) > 0
    across = 2 if bent else across  # in its plane
    lines = c["wall"][2:] if across == 1 else c["wall"][:2]
    for line in lines:
        axis.plot(line[:, 0], line[:, 2 if across == 1 else 1], color=style.INK, linewidth=1.6)
    way, reach = way_along(run, c), run.series["length_x1"].max()
    shots, labelled = {}, []  # places of the times
    for x in numpy.linspace(way[0], way[-1], n):
        shot = run.snapshot_at(numpy.interp(x, way, run.series["time"]))
        shots[shot.path] = shot
    for shot, colour in zip(shots.values(), plt.get_cmap(style.TIME)(numpy.linspace(0.12, 1, len(shots)))):
        middle = (shot.points.min(0) + shot.points.max(0)) / 2
        axis.add_collection(LineCollection(shape.section(shot, middle[across], across), colors=[colour], linewidths=1.6, capstyle="round"))
        at = middle[:2] if bent else (middle[0], lines[:, :, 1:].min() * 0.97)
        if any(numpy.hypot(*numpy.subtract(at, other)) < reach / 8 for other in labelled):
            continue
        labelled.append(at)
        axis.text(*at, f"{shot.time:.3g}", color=colour, ha="center", va="center" if bent else "bottom", fontsize=8)
    axis.set_aspect("equal")
    axis.grid(False)
    shown = lines[:, (c["s"] > way.min() - reach) & (c["s"] < way.max() + reach)].reshape(-1, 3)
    axis.set_xlim(shown[:, 0].min(), shown[:, 0].max() + (0.1 if bent else 0))
    if bent:
        axis.set_ylim(shown[:, 1].min() - 0.1, shown[:, 1].max() + 0.1)
    axis.set_xlabel("x₁" + run.in_units("length"))
    axis.set_ylabel(("x₃" if across == 1 else "x₂") + run.in_units("length"))
    axis.set_title(f"{run.name}: cut open at x{across + 1} = centroid; times {'inside' if bent else 'below'}{run.in_units('time')}")


def along_the_way(axes, run, c):
    s, way = run.series, way_along(run, c)
    speed = numpy.linalg.norm([s[f"velocity_x{k}"] for k in (1, 2, 3)], axis=0)
    for k, name in enumerate(("x₁", "x₂", "x₃"), 1):
        axes["extents"].plot(way, s[f"length_x{k}"], color=style.RUNS[k - 1], label=f"along {name}", linestyle="--" if k == 3 else "-")
    axes["extents"].legend()
    axes["extents"].set_title("extents of the particle" + run.in_units("length"))
    axes["velocity"].plot(way, speed, color=style.RUNS[0], label="of the centroid")
    axes["velocity"].plot(c["s"], numpy.linalg.norm(c["velocity"], axis=1), color=style.FAINT, linestyle="--", label="on the centre line, empty channel")
    axes["velocity"].set_xlim(way.min(), way.max())
    axes["velocity"].legend()
    axes["velocity"].set_title("velocity" + run.in_units("length/time"))
    axes["pressure"].plot(way, s["disturbed_pressure_drop"], color=style.RUNS[0], label="reciprocal theorem")
    if "pressure_drop_by_flux" in s:
        axes["pressure"].plot(way, s["pressure_drop_by_flux"], color=style.RUNS[1], linestyle=":", label="by the flow rate")
    axes["pressure"].legend()
    added = f"pressure drop that the particle adds{run.in_units('force/length^2')}"
    axes["pressure"].set_title(f"{added} (empty channel: {c['pressure_drop']:.5g})")
    for name in ("extents", "velocity", "pressure"):
        axes[name].set_xlabel("way of the centroid along the centre line" + run.in_units("length"))


def wall(axis, run, c):
    axis.plot(c["wall_s"], c["wall_shear_stress"], color=style.RUNS[2])
    axis.set_xlabel("way along the centre line" + run.in_units("length"))
    axis.set_title("shear stress on the wall of the empty channel" + run.in_units("force/length^2"))


if __name__ == "__main__":
    main()
