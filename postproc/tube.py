#!/usr/bin/python3
"""Particles in tubes: shapes over time in perspective and in two sections, one row a run; with --motion path, migration, velocity,
tank-treading and pressure drop of all runs.

    tube.py results/capsule_cylinder results/capsule_capillary -o shapes.png --motion motion.png
"""

import argparse

import needs  # before what it looks for
import numpy
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize

import duct
import meshes
import shape
import style
import tanktread
from style import plt

FLOOR = 1e-4  # of the distance from the largest velocity: what the tolerances of a run let through is none
TIMES = [0.0, 0.5, 1.0, 2.0, 5.0, 20.0]
PANELS = [("migration_velocity", "migration velocity / vₘ"), ("velocity_x1", "velocity along the tube / vₘ"),
          ("tank_treading_velocity", "tank-treading velocity / vₘ"), ("disturbed_pressure_drop", "disturbed pressure drop / (μ vₘ/R$_T$)")]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", nargs="+", help="directories of runs' results, or decks, which are run when they have none")
    parser.add_argument("-o", "--output", default="tube.png", metavar="FILE", help="the picture of the shapes (default: %(default)s)")
    parser.add_argument("--motion", metavar="FILE", help="a second picture: how the runs move")
    parser.add_argument("--times", type=float, nargs="+", default=TIMES, help="simulated times of the shapes (default: %(default)s)")
    arguments = parser.parse_args()
    runs = [tanktread.run(directory) for directory in arguments.results]
    for run in runs:
        run.require("centroid_x1")
    ducts = [duct.duct(run.directory) for run in runs]
    style.save(shapes(runs, ducts, arguments.times), arguments.output)
    if arguments.motion:
        style.save(motion(runs, ducts), arguments.motion)


def shots_of(run, times):
    """The saved steps nearest to the times, each once."""
    found = {shot.path: shot for shot in (run.snapshot_at(time) for time in times if time <= run.series["time"][-1] * (1 + 1e-9))}
    return list(found.values())


def section(run, d, shot, across):
    """Of the particle in the plane x_{across+1} = centroid, and the centroid, over R_T."""
    c = numpy.array([numpy.interp(shot.time, run.series["time"], run.series[f"centroid_x{k}"]) for k in (1, 2, 3)])
    return shape.section(shot, c[across], across) / d["radius"], c / d["radius"]


def shapes(runs, ducts, times):
    figure = plt.figure(figsize=(11.5, 4.4 * len(runs)))
    for row, (part, run, d) in enumerate(zip(figure.subfigures(len(runs), 1, squeeze=False)[:, 0], runs, ducts)):
        shots = shots_of(run, times)
        colours = plt.get_cmap(style.TIME)(numpy.linspace(0.12, 1, len(shots)))
        upper, lower = part.subfigures(2, 1, height_ratios=[0.45, 0.55])
        norm = Normalize(0, max(numpy.linalg.norm(shot.fields["traction"], axis=1).max() for shot in shots[1:] or shots))
        unit = run.value("Flow/viscosity", 1) * run.rate[0]
        axes = upper.subplots(1, len(shots))
        for axis, shot, colour in zip(numpy.atleast_1d(axes), shots, colours):
            shape.draw_surface(axis, shot, "traction", norm, style.FIELD, *shape.VIEW, pixels=360, triad=shot is shots[0])
            axis.set_title(f"t = {shot.time:.3g}", color=colour, loc="center")
        meshes.share_window(numpy.atleast_1d(axes))
        part.suptitle(run.name, x=0.01, ha="left", fontsize=11, fontweight="bold")
        left, middle = lower.subplots(1, 2, width_ratios=[2.1, 1])
        along(left, run, d, shots, colours)
        across(middle, run, d, shots, colours)
        upper.colorbar(ScalarMappable(Normalize(0, norm.vmax / unit), style.FIELD), ax=axes, label="traction / (μ vₘ/R$_T$)", shrink=0.8)
    return figure


def along(axis, run, d, shots, colours):
    """Sections in the plane x2 = centroid, side by side as the particle travels, each about its own centroid along x1."""
    place = 0.0
    for shot, colour in zip(shots, colours):
        pieces, c = section(run, d, shot, 1)
        axis.add_collection(LineCollection(pieces - [c[0] - place, 0], colors=[colour], linewidths=1.6, capstyle="round"))
        axis.plot(place, c[2], marker=".", color=colour, markersize=4)
        place += numpy.ptp(shot.points[:, 0]) / d["radius"] + 0.12
    low, high = wall_heights(d["outline"], c[1])
    for height in low, high:
        axis.axhline(height, color=style.INK, linewidth=1.4)
    axis.axhline(0, color=style.FAINT, linewidth=0.8, linestyle=(0, (6, 4)))
    axis.set_aspect("equal")
    axis.autoscale_view()
    axis.set_xlabel("x₁, flow to the right")
    axis.set_ylabel("x₃ / R$_T$")
    axis.set_xticks([])
    axis.grid(False)
    axis.set_title("section x₂ = centroid")


def wall_heights(outline, x2):
    """Where the line x2 = const. meets the wall: lowest and highest x3."""
    a, b = outline[:-1], outline[1:]
    cut = (a[:, 0] - x2) * (b[:, 0] - x2) <= 0
    share = (x2 - a[cut, 0]) / numpy.where(b[cut, 0] == a[cut, 0], 1, b[cut, 0] - a[cut, 0])
    heights = a[cut, 1] + share * (b[cut, 1] - a[cut, 1])
    return heights.min(), heights.max()


def across(axis, run, d, shots, colours):
    """Sections in the plane x1 = centroid inside of the wall."""
    axis.plot(*d["outline"].T, color=style.INK, linewidth=1.4)
    for shot, colour in zip(shots, colours):
        pieces, _ = section(run, d, shot, 0)
        axis.add_collection(LineCollection(pieces, colors=[colour], linewidths=1.6, capstyle="round"))
    axis.plot(*d["maximum"][:2], marker="+", color=style.INK, markersize=8)
    axis.set_aspect("equal")
    axis.grid(False)
    axis.set_xlabel("x₂ / R$_T$")
    axis.set_ylabel("x₃ / R$_T$")
    axis.set_title("section x₁ = centroid")


def motion(runs, ducts):
    figure, axes = plt.subplots(2, 3, figsize=(12.5, 6.6))
    axes = axes.ravel()
    for run, d, colour in zip(runs, ducts, style.RUNS):
        speed, radius = d["mean_velocity"], d["radius"]
        s = run.series
        time = run.time
        axes[0].plot(*d["outline"].T, color=colour, linewidth=1)
        axes[0].plot(s["centroid_x2"] / radius, s["centroid_x3"] / radius, color=colour, label=run.name)
        axes[0].plot(s["centroid_x2"][0] / radius, s["centroid_x3"][0] / radius, color=colour, marker="o", markersize=3.5)
        axes[0].plot(*d["maximum"][:2], color=colour, marker="+", markersize=8)
        off = numpy.hypot(s["centroid_x2"] / radius - d["maximum"][0], s["centroid_x3"] / radius - d["maximum"][1])
        axes[1].semilogy(time, numpy.maximum(off, FLOOR), color=colour)
        for axis, (name, label) in zip(axes[2:], PANELS):
            scale = run.value("Flow/viscosity", 1) * speed / radius if "pressure" in name else speed
            axis.plot(time[1:], s[name][1:] / scale, color=colour)
            axis.set_title(label)
    axes[0].set_aspect("equal")
    axes[0].set_title("paths of the centroid; + largest velocity")
    axes[0].set_xlabel("x₂ / R$_T$")
    axes[0].set_ylabel("x₃ / R$_T$")
    axes[1].set_ylim(bottom=FLOOR)
    axes[1].set_title("distance from the largest velocity / R$_T$")
    for axis in axes[1:]:
        axis.set_xlabel("t vₘ / R$_T$")
    for axis in axes[2:]:
        axis.set_xlim(left=0)
    axes[0].legend(loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=2)
    return figure


if __name__ == "__main__":
    main()
