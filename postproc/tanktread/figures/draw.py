"""Functions that draw surfaces and their plane sections on axes."""

import itertools

import numpy
from matplotlib.collections import LineCollection

from . import render, style

VIEW = (-85, 18)   # azimuth and elevation of the observer in degrees: x1 points to the right, x3 up, seen from above
SECTION_GRID = 24  # intervals along a side of a cell in the grid from which a section is computed
GRID = 12          # intervals along a side of a cell in the grid from which a field along a section is computed


def magnitude(values):
    return numpy.linalg.norm(values, axis=-1) if values.ndim > 1 else values


def middle(points):
    """Returns the centre (3,) of the bounding box of points (n, 3)."""
    return (points.min(0) + points.max(0)) / 2


def view_axes(azimuth, elevation):
    """Returns the directions to the right, up and towards the observer as rows (3, 3). x3 points up in the picture."""
    a, e = numpy.radians([azimuth, elevation])
    eye = numpy.array([numpy.cos(e) * numpy.cos(a), numpy.cos(e) * numpy.sin(a), numpy.sin(e)])
    right = numpy.array([-numpy.sin(a), numpy.cos(a), 0])
    return numpy.array([right, numpy.cross(eye, right), eye])


def draw_surface(axis, shot, field, norm, colours, azimuth, elevation, pixels=640, triad=True):
    """Draws the visible part of the surfaces with element edges, the edges of the periodic cell, and the coordinate
    axes."""
    view, paint = view_axes(azimuth, elevation), style.plt.get_cmap(colours)
    image, extent = render.picture(shot, magnitude(shot.fields[field]), view, lambda seen: paint(norm(seen)), pixels)
    axis.imshow(image, extent=extent, aspect="equal", interpolation="antialiased", zorder=2)
    if shot.cell is not None:
        corners = shot.frame @ view.T
        front = corners[:, 2].argmax()  # edges at the corner nearest to the observer are drawn over the particles
        for edge in itertools.combinations(range(8), 2):
            if edge[0] ^ edge[1] in (1, 2, 4):
                axis.plot(*corners[[*edge], :2].T, color=style.INK, linewidth=0.8, zorder=3 if front in edge else 1)
    if triad:
        draw_triad(axis, view, *numpy.reshape(extent, (2, 2)).T)
    axis.set_anchor("N")
    axis.autoscale_view()
    axis.axis("off")


def draw_triad(axis, view, low, high):
    """Draws the coordinate directions in the lower left corner of the window between low (2,) and high (2,)."""
    length = 0.13 * (high - low).max()
    foot = low - 0.3 * length
    arrow = {"arrowstyle": "->", "color": style.INK, "lw": 0.9, "shrinkA": 0, "shrinkB": 0}
    for arm, name in zip(view[:2].T * length, style.AXES):
        axis.annotate("", foot + arm, foot, arrowprops=arrow)
        axis.annotate(name, foot + 1.35 * arm, ha="center", va="center", fontsize=8.5)
    axis.plot(*zip(foot - 0.5 * length, foot + 1.5 * length), alpha=0)  # includes the letters in the limits


def cut(grid, across, place):
    """Returns the intersection of a surface with the plane x_{across+1} = place as line segments: the values at their
    end points, shape (segments, 2, k). `grid` (cells, m, m, k): position (3) and further values on a grid of each cell,
    interpolated linearly on triangles."""
    a, b, c, d = grid[:, :-1, :-1], grid[:, :-1, 1:], grid[:, 1:, 1:], grid[:, 1:, :-1]
    triangles = numpy.concatenate([numpy.stack(corners, 3).reshape(-1, 3, grid.shape[-1])
                                   for corners in ((a, b, c), (a, c, d))])
    height = triangles[:, :, across] - place
    height[height == 0] = 1e-300  # a corner in the plane counts as above it
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
    """Returns the section of the surfaces with the plane x_{across+1} = place as line segments (segments, 2, 2), in the
    two coordinates of the plane."""
    return numpy.delete(cut(shot.sampled(shot.positions, SECTION_GRID), across, place), across, axis=2)


def draw_pieces(axis, pieces, color, width=1.6, ends="round"):
    """Draws line segments (segments, 2, 2)."""
    axis.add_collection(LineCollection(pieces, colors=[color], linewidths=width, capstyle=ends))


def draw_sections(axis, runs, shots):
    start = runs[0].snapshots()[0]
    moved = start.time < shots[0].time and shots[0].cell is None
    if moved:
        draw_pieces(axis, section(start.scaled(runs[0]), middle(shots[0].frame)[1]), style.FAINT, 1, "butt")
    for run, shot, color in zip(runs, shots, style.RUNS * len(runs)):
        pieces = section(shot, middle(shot.frame)[1])
        draw_pieces(axis, pieces, color, 1.8)
        name, time, angle = f"{run.name}: " if len(runs) > 1 else "", run.moment(shot.time), numpy.nan
        if "taylor_inertia" in run.series:  # not a rigid particle
            angle, deformation = (numpy.interp(shot.time, run.series["time"], run.series[key])
                                  for key in ("inclination", "taylor_inertia"))
            time += f", D = {deformation:.4f}"
        if numpy.isnan(angle):  # undefined: rigid particle, or two equal semi-axes
            axis.plot([], [], color=color, linewidth=1.8, label=name + time)
            continue
        along = numpy.array([numpy.cos(numpy.radians(angle)), numpy.sin(numpy.radians(angle))])
        centre = middle(pieces.reshape(-1, 2))
        reach = numpy.abs((pieces - centre) @ along).max()
        axis.plot(*(centre + numpy.outer([-reach, reach], along)).T, color=color, linestyle=(0, (5, 3)), linewidth=1,
                  label=f"{name}inclination {round(angle, 2) + 0.0:.2f}°, D = {deformation:.4f}")
    if moved:
        axis.plot([], [], color=style.FAINT, linewidth=1,
                  label="at the start" if "Continuation" not in runs[0].deck else runs[0].moment(start.time))
    axis.autoscale_view()
    axis.set(aspect="equal", anchor="N", xlabel="x₁ / R$_C$", ylabel="x₃ / R$_C$", title="section in the x₁x₃ plane")
    axis.legend(loc="upper center", bbox_to_anchor=(0.5, 0), borderaxespad=4)


def share_window(axes):
    """Sets the limits of all axes so that all surfaces are drawn to the same scale, each in the middle of its panel."""
    limits = numpy.array([[axis.get_xlim(), axis.get_ylim()] for axis in axes])
    width, height = numpy.ptp(limits, axis=2).max(0) / 2
    for axis, (x, y) in zip(axes, limits.mean(2)):
        axis.set(xlim=(x - width, x + width), ylim=(y - height, y + height), anchor="C")


def field_cut(shot, field, particle=None):
    """Returns the section through the middle of a particle (default: of all surfaces), normal to x2, as line segments
    (segments, 2, 3 + k): position relative to the middle (3), and the values of a field (k)."""
    cells = shot.cells_of(particle) if particle else range(len(shot.cells))
    grid = shot.sampled(numpy.column_stack([shot.points, shot.fields[field]]), GRID, cells)
    grid[..., :3] -= middle(shot.points[numpy.concatenate([shot.cells[cell] for cell in cells])])
    return cut(grid, 1, 0)


def near_tip(shot, field):
    """Returns x1 (n,), x3 (n,) and the magnitude of a field (n,) along the half of the section (see field_cut) with
    x1 > 0, in ascending order of x3. Positions are relative to the middle of the surface."""
    place = field_cut(shot, field).mean(axis=1)
    place = place[numpy.argsort(place[:, 2])]
    x, _, z, *values = place[place[:, 0] > 0].T
    return x, z, numpy.linalg.norm(values, axis=0)


def section_variation(shot, field, particle):
    """Returns an angle (n,) and |d field / dl| (n,) along the section of a particle (see field_cut), with the arc
    length l. The angle is the polar angle after the section has been scaled along x1 and x3 to equal extents."""
    ends = field_cut(shot, field, particle)
    length, change = (numpy.linalg.norm(ends[:, 1, columns] - ends[:, 0, columns], axis=1)
                      for columns in (slice(3), slice(3, None)))
    kept = length > 0.2 * numpy.median(length)  # differences over very short segments are dominated by rounding
    x, _, z = ends[kept, :, :3].mean(axis=1).T
    angle = numpy.arctan2(z / abs(z).max(), x / abs(x).max())
    order = numpy.argsort(angle)
    return angle[order], (change[kept] / length[kept])[order]
