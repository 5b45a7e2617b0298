"""Drawing of surfaces, and of their sections, on axes."""

import numpy
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize

from . import render, style
from .style import plt

VIEW = (-85, 18)   # azimuth and elevation of the eye, degrees: x1 to the right and x3 up, a little from above
SECTION_GRID = 24  # facets along a side of a cell where the section is cut
GRID = 12          # facets along a side of a cell where a field is followed along the section


def magnitude(values):
    return numpy.linalg.norm(values, axis=-1) if values.ndim > 1 else values


def scale(fields):
    low, high = min(f.min() for f in fields), max(f.max() for f in fields)
    if low < 0:
        bound = max(-low, high)
        return Normalize(-bound, bound), style.SIGNED
    return Normalize(low, high), style.FIELD


def view_axes(azimuth, elevation):
    """Returns the directions right, up and towards the eye as rows (3, 3); x3 points up."""
    a, e = numpy.radians([azimuth, elevation])
    eye = numpy.array([numpy.cos(e) * numpy.cos(a), numpy.cos(e) * numpy.sin(a), numpy.sin(e)])
    right = numpy.array([-numpy.sin(a), numpy.cos(a), 0])
    return numpy.array([right, numpy.cross(eye, right), eye])


def draw_surface(axis, shot, field, norm, colours, azimuth, elevation, pixels=640, triad=True):
    """Draws the visible part of the surface with the edges of its elements, and the directions of the axes."""
    view = view_axes(azimuth, elevation)
    values = shot.fields[field]
    paint = plt.get_cmap(colours)
    image, extent = render.picture(shot, magnitude(values), view, lambda seen: paint(norm(seen)), pixels)
    axis.imshow(image, extent=extent, aspect="equal", interpolation="antialiased", zorder=2)
    if shot.cell is not None:
        draw_cell(axis, shot.frame @ view.T)
    if triad:
        draw_triad(axis, view, numpy.array(extent))
    axis.set_anchor("N")
    axis.autoscale_view()
    axis.axis("off")


def draw_cell(axis, corners):
    """Draws the edges of a cell from its corners (8, 3) (right, up, towards the eye); the three that meet in the
    foremost corner lie above the particles, the others below."""
    front = corners[:, 2].argmax()
    for k in range(8):
        for other in (k | 1, k | 2, k | 4):
            if other != k:
                axis.plot(*corners[[k, other], :2].T, color=style.INK,
                          linewidth=0.8, zorder=3 if front in (k, other) else 1)


def draw_triad(axis, view, extent):
    """Draws the directions of the axes at the lower left of the extent (left, right, low, high)."""
    low, high = extent[[0, 2]], extent[[1, 3]]
    length = 0.13 * (high - low).max()
    foot = low - 0.3 * length
    for k, arm in enumerate(view[:2].T * length):
        axis.annotate("", foot + arm, foot, arrowprops={"arrowstyle": "->", "color": style.INK, "lw": 0.9, "shrinkA": 0,
                                                        "shrinkB": 0})
        axis.annotate(f"x{'₁₂₃'[k]}", foot + 1.35 * arm, ha="center", va="center", fontsize=8.5)
    axis.plot(*zip(foot - 0.5 * length, foot + 1.5 * length), alpha=0)  # room for the letters


def cut(grid, across, place):
    """Ends of the line pieces in which the plane x_{across+1} = place cuts a surface, given on fine grids as rows of
    place and further values: from shape (patches, m, m, k) to (pieces, 2, k). Cut on the triangles of the grids, the
    values with them."""
    a, b, c, d = grid[:, :-1, :-1], grid[:, :-1, 1:], grid[:, 1:, 1:], grid[:, 1:, :-1]
    k = grid.shape[-1]
    triangles = numpy.concatenate([numpy.stack([a, b, c], 3).reshape(-1, 3, k),
                                  numpy.stack([a, c, d], 3).reshape(-1, 3, k)])
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
    """Returns the line pieces (pieces, 2, 2) in which the plane x_{across+1} = place cuts the surface: their ends in
    the other two coordinates."""
    return numpy.delete(cut(shot.sampled(shot.positions, SECTION_GRID), across, place), across, axis=2)


def draw_sections(axis, runs, shots):
    for run, shot, color in zip(runs, shots, style.RUNS * len(runs)):
        x2 = (shot.frame[:, 1].min() + shot.frame[:, 1].max()) / 2
        rest = run.snapshots()[0].scaled(run)
        if rest.time < shot.time and run is runs[0] and shot.cell is None:
            axis.add_collection(LineCollection(section(rest, x2), colors=style.FAINT, linewidths=1, linestyles="-"))
        pieces = section(shot, x2)
        axis.add_collection(LineCollection(pieces, colors=color, linewidths=1.8, capstyle="round"))
        name = f"{run.name}: " if len(runs) > 1 else ""
        if "taylor_inertia" not in run.series:  # a rigid particle
            axis.plot([], [], color=color, linewidth=1.8, label=f"{name}t = {shot.time:g}")
            continue
        angle = numpy.interp(shot.time, run.series["time"], run.series["inclination"])
        deformation = numpy.interp(shot.time, run.series["time"], run.series["taylor_inertia"])
        if numpy.isnan(angle):  # two equal semi-axes
            axis.plot([], [], color=color, linewidth=1.8, label=f"{name}t = {shot.time:g}, D = {deformation:.4f}")
            continue
        along = numpy.array([numpy.cos(numpy.radians(angle)), numpy.sin(numpy.radians(angle))])
        middle = (pieces.min((0, 1)) + pieces.max((0, 1))) / 2
        reach = numpy.abs((pieces - middle) @ along).max()
        words = f"{name}inclination {round(angle, 2) + 0.0:.2f}°, D = {deformation:.4f}"
        axis.plot(*(middle + numpy.outer([-reach, reach], along)).T,
                  color=color, linestyle=(0, (5, 3)), linewidth=1, label=words)
    if runs[0].snapshots()[0].time < shots[0].time and shots[0].cell is None:
        axis.plot([], [], color=style.FAINT, linewidth=1, label="at the start")
    axis.set_aspect("equal", anchor="N")
    axis.autoscale_view()
    axis.set(xlabel="x₁ / R$_C$", ylabel="x₃ / R$_C$", title="section in the x₁x₃ plane")
    axis.legend(loc="upper center", bbox_to_anchor=(0.5, 0), borderaxespad=4)


def share_window(axes):
    """Sets the limits of all axes so that their surfaces have one scale, each in the middle of its panel."""
    limits = numpy.array([[axis.get_xlim(), axis.get_ylim()] for axis in axes])
    middles, half = limits.mean(2), numpy.ptp(limits, axis=2).max(0) / 2
    for axis, middle in zip(axes, middles):
        axis.set(xlim=(middle[0] - half[0], middle[0] + half[0]), ylim=(middle[1] - half[1], middle[1] + half[1]))
        axis.set_anchor("C")


def field_cut(shot, field):
    """Ends of the short pieces in which the plane x2 = middle cuts the surface: rows of place (from the middle) and
    field, shape (pieces, 2, 3 + k)."""
    values = shot.fields[field]
    values = values if values.ndim > 1 else values[:, None]
    middle = (shot.points.min(0) + shot.points.max(0)) / 2
    grid = numpy.concatenate([shot.sampled(shot.points, GRID) - middle, shot.sampled(values, GRID)], axis=-1)
    return cut(grid, 1, 0)


def near_tip(shot, field):
    """Returns x1 (n,), x3 (n,) and the magnitude of a field (n,) along the half of the section where x1 is above the
    middle, by x3; positions from the middle."""
    place = field_cut(shot, field).mean(axis=1)
    place = place[place[:, 0] > 0]
    place = place[numpy.argsort(place[:, 2])]
    return place[:, 0], place[:, 2], numpy.linalg.norm(place[:, 3:], axis=1)


def section_variation(shot, field):
    """Returns angle (n,) and |d field / dl| (n,) along the section x2 = middle. The angle is that of the section's
    ellipse, stretched to a circle."""
    ends = field_cut(shot, field)
    length = numpy.linalg.norm(ends[:, 1, :3] - ends[:, 0, :3], axis=1)
    # slivers give rounding
    ends, length = ends[length > 0.2 * numpy.median(length)], length[length > 0.2 * numpy.median(length)]
    variation = numpy.linalg.norm(ends[:, 1, 3:] - ends[:, 0, 3:], axis=1) / length
    place = ends.mean(axis=1)
    angle = numpy.arctan2(place[:, 2] / abs(place[:, 2]).max(), place[:, 0] / abs(place[:, 0]).max())
    order = numpy.argsort(angle)
    return angle[order], variation[order]
