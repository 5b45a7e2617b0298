#!/usr/bin/python3
"""The deformed surface with its traction, and its section in the x1 x3 plane with the axis of inertia."""

import argparse
import sys

import numpy
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import Normalize

import read
import style
from style import plt

CELL_GRID = 8     # facets along a side of a cell in the picture
SECTION_GRID = 24  # and where the section is cut


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("results", nargs="+", help="directories of runs' results; their sections share one panel")
    parser.add_argument("-o", "--output", default="shape.png", metavar="FILE", help="the picture (default: %(default)s)")
    parser.add_argument("--time", type=float, help="simulated time of the snapshot (default: the last one)")
    parser.add_argument("--field", default="traction", help="field of the snapshot that colours the surface (default: %(default)s)")
    parser.add_argument("--view", type=float, nargs=2, default=[-60, 25], metavar=("AZIMUTH", "ELEVATION"), help="where from, in degrees")
    arguments = parser.parse_args()

    runs = [read.run(directory) for directory in arguments.results]
    shots = [run.snapshot_at(arguments.time) for run in runs]
    for shot in shots:
        if arguments.field not in shot.fields:
            sys.exit(f"{shot.path} holds no field {arguments.field}; there are: {', '.join(sorted(shot.fields))}")

    n = len(runs)
    figure, axes = plt.subplots(1, n + 1, figsize=(4.4 * n + 4.6, 4.4), squeeze=False)
    norm, colours = scale([magnitude(shot.fields[arguments.field]) for shot in shots])
    for axis, run, shot in zip(axes[0], runs, shots):
        draw_surface(axis, shot, arguments.field, norm, colours, *arguments.view)
        axis.set_title(f"{run.name}, t = {shot.time:g}")
    vector = numpy.ndim(shots[0].fields[arguments.field]) > 1
    figure.colorbar(ScalarMappable(norm, colours), cax=axes[0][0].inset_axes([0.3, -0.08, 0.5, 0.03]), orientation="horizontal",
                    label=("magnitude of the " if vector else "") + arguments.field)
    draw_sections(axes[0][n], runs, shots)
    style.save(figure, arguments.output)


def magnitude(values):
    return numpy.linalg.norm(values, axis=-1) if values.ndim > 1 else values


def scale(fields):
    low, high = min(f.min() for f in fields), max(f.max() for f in fields)
    if low < 0:
        bound = max(-low, high)
        return Normalize(-bound, bound), style.SIGNED
    return Normalize(low, high), style.FIELD


def view_axes(azimuth, elevation):
    """Right, up and towards the eye, as rows; x3 points up."""
    a, e = numpy.radians([azimuth, elevation])
    eye = numpy.array([numpy.cos(e) * numpy.cos(a), numpy.cos(e) * numpy.sin(a), numpy.sin(e)])
    right = numpy.array([-numpy.sin(a), numpy.cos(a), 0])
    return numpy.array([right, numpy.cross(eye, right), eye])


def draw_surface(axis, shot, field, norm, colours, azimuth, elevation):
    """Facets that face the eye, the farthest first, lit from the upper left; element edges on top."""
    view = view_axes(azimuth, elevation)
    grid = shot.sampled(shot.points, CELL_GRID) @ view.T
    values = shot.sampled(shot.fields[field], CELL_GRID)
    if numpy.ndim(shot.fields[field]) > 1:
        values = magnitude(values)
    corners = numpy.stack([grid[:, :-1, :-1], grid[:, :-1, 1:], grid[:, 1:, 1:], grid[:, 1:, :-1]], axis=3).reshape(-1, 4, 3)
    colour_of = (values[:, :-1, :-1] + values[:, :-1, 1:] + values[:, 1:, 1:] + values[:, 1:, :-1]).ravel() / 4
    normal = numpy.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    normal /= numpy.maximum(numpy.linalg.norm(normal, axis=1, keepdims=True), 1e-300)

    facing = numpy.flatnonzero(normal[:, 2] > -0.02)
    facing = facing[numpy.argsort(corners[facing, :, 2].mean(1), kind="stable")]
    light = numpy.array([-0.4, 0.6, 0.7]) / numpy.linalg.norm([-0.4, 0.6, 0.7])
    shade = 0.62 + 0.38 * numpy.clip(normal[facing] @ light, 0, 1)
    rgba = plt.get_cmap(colours)(norm(colour_of[facing]))
    rgba[:, :3] *= shade[:, None]
    axis.add_collection(PolyCollection(corners[facing, :, :2], facecolors=rgba, edgecolors=rgba, linewidths=0.3, rasterized=True))

    edges = numpy.concatenate([grid[:, 0], grid[:, -1], grid[:, :, 0], grid[:, :, -1]])
    cell_normals = normal.reshape(len(grid), CELL_GRID, CELL_GRID, 3)
    sides = [cell_normals[:, 0], cell_normals[:, -1], cell_normals[:, :, 0], cell_normals[:, :, -1]]
    seen = numpy.concatenate([side[:, :, 2] for side in sides]) > 0
    pieces = numpy.stack([edges[:, :-1, :2], edges[:, 1:, :2]], axis=2)[seen]
    axis.add_collection(LineCollection(pieces, colors="#ffffff", linewidths=0.45, alpha=0.55))
    draw_triad(axis, view, grid)
    axis.set_aspect("equal", anchor="N")
    axis.autoscale_view()
    axis.axis("off")


def draw_triad(axis, view, grid):
    low, high = grid[..., :2].min((0, 1, 2)), grid[..., :2].max((0, 1, 2))
    length = 0.13 * (high - low).max()
    foot = low - 0.3 * length
    for k, arm in enumerate(view[:2].T * length):
        axis.annotate("", foot + arm, foot, arrowprops={"arrowstyle": "->", "color": style.INK, "lw": 0.9, "shrinkA": 0, "shrinkB": 0})
        axis.annotate(f"x{'₁₂₃'[k]}", foot + 1.35 * arm, ha="center", va="center", fontsize=8.5)
    axis.plot(*zip(foot - 0.5 * length, foot + 1.5 * length), alpha=0)  # room for the letters


def cut(grid, across, place):
    """Ends of the line pieces in which the plane x_{across+1} = place cuts a surface, given on fine grids as rows of place and further values:
    from shape (patches, m, m, k) to (pieces, 2, k). Cut on the triangles of the grids, the values with them."""
    a, b, c, d = grid[:, :-1, :-1], grid[:, :-1, 1:], grid[:, 1:, 1:], grid[:, 1:, :-1]
    k = grid.shape[-1]
    triangles = numpy.concatenate([numpy.stack([a, b, c], 3).reshape(-1, 3, k), numpy.stack([a, c, d], 3).reshape(-1, 3, k)])
    height = triangles[:, :, across] - place
    height[height == 0] = 1e-300  # a corner in the plane belongs to its upper side
    through = (height > 0).any(1) & (height < 0).any(1)
    triangles, height = triangles[through], height[through]
    lone = numpy.where((height > 0).sum(1) == 1, (height > 0).argmax(1), (height < 0).argmax(1))
    rows = numpy.arange(len(lone))
    ends = []
    for other in (lone + 1) % 3, (lone + 2) % 3:
        share = (height[rows, lone] / (height[rows, lone] - height[rows, other]))[:, None]
        ends.append(triangles[rows, lone] + share * (triangles[rows, other] - triangles[rows, lone]))
    return numpy.stack(ends, axis=1)


def section(shot, place, across=1):
    """Line pieces in which the plane x_{across+1} = place (x2 by default) cuts the surface: shape (pieces, 2, 2), the other two coordinates."""
    return numpy.delete(cut(shot.sampled(shot.points, SECTION_GRID), across, place), across, axis=2)


def draw_sections(axis, runs, shots):
    for run, shot, color in zip(runs, shots, style.RUNS * len(runs)):
        x2 = (shot.points[:, 1].min() + shot.points[:, 1].max()) / 2
        rest = run.snapshots()[0]
        if rest.time < shot.time and run is runs[0]:
            axis.add_collection(LineCollection(section(rest, x2), colors=style.FAINT, linewidths=1, linestyles="-"))
        pieces = section(shot, x2)
        axis.add_collection(LineCollection(pieces, colors=color, linewidths=1.8, capstyle="round"))
        middle = (pieces.min((0, 1)) + pieces.max((0, 1))) / 2
        name = f"{run.name}: " if len(runs) > 1 else ""
        if "taylor_inertia" not in run.series:  # a rigid particle
            axis.plot([], [], color=color, linewidth=1.8, label=f"{name}t = {shot.time:g}")
            continue
        angle = numpy.interp(shot.time, run.series["time"], run.series["inclination"])
        deformation = numpy.interp(shot.time, run.series["time"], run.series["taylor_inertia"])
        along = numpy.array([numpy.cos(numpy.radians(angle)), numpy.sin(numpy.radians(angle))])
        reach = numpy.abs((pieces - middle) @ along).max()
        words = f"{name}inclination {round(angle, 2) + 0.0:.2f}°, D = {deformation:.4f}"
        axis.plot(*(middle + numpy.outer([-reach, reach], along)).T, color=color, linestyle=(0, (5, 3)), linewidth=1, label=words)
    if runs[0].snapshots()[0].time < shots[0].time:
        axis.plot([], [], color=style.FAINT, linewidth=1, label="at the start")
    axis.set_aspect("equal", anchor="N")
    axis.autoscale_view()
    axis.set_xlabel("x₁")
    axis.set_ylabel("x₃")
    axis.set_title("section in the x₁x₃ plane")
    axis.legend(loc="upper center", bbox_to_anchor=(0.5, 0), borderaxespad=4)


if __name__ == "__main__":
    main()
