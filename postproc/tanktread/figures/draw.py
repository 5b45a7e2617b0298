"""Functions that draw surfaces and their plane sections on axes."""

import numpy
from matplotlib.collections import LineCollection, PolyCollection

from . import render, style
from .scene import flow_plane, surrounded

VIEW = (-85, 18)   # azimuth and elevation of the observer in degrees: x1 points to the right, x3 up, seen from above
LIGHT, DARK = 0.9, 0.78  # grey values of walls that face the observer and that are parallel to the line of sight
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


def draw_surface(axis, shot, field, norm, colours, view, pixels=640, triad=True):
    """Draws the visible part of the surfaces with element edges, posts and walls, the edges of the periodic cell, and
    the coordinate axes. `view` (3, 3): see view_axes."""
    paint = style.plt.get_cmap(colours)
    image, extent = render.picture(shot, magnitude(shot.fields[field]), view, lambda seen: paint(norm(seen)), pixels)
    axis.imshow(image, extent=extent, aspect="equal", interpolation="antialiased", zorder=2)
    draw_walls(axis, shot, view)
    edges = shot.edges @ view.T
    front = edges[..., 2].max(initial=-numpy.inf)  # edges at the nearest corner are drawn over the particles
    for edge in edges:
        axis.plot(*edge[:, :2].T, color=style.INK, linewidth=0.8, zorder=3 if edge[:, 2].max() == front else 1)
    if triad:
        draw_triad(axis, view, *numpy.reshape(extent, (2, 2)).T)
    axis.set_anchor("N")
    axis.autoscale_view()
    axis.axis("off")


def view_of(runs, view):
    """Returns the rows of view_axes for an azimuth and elevation; None: for VIEW on the plane of the first run's flow,
    whose first direction then points to the right and the second one up."""
    return view_axes(*view) if view else view_axes(*VIEW) @ flow_plane(runs[0])


def draw_walls(axis, shot, view):
    """Draws the walls whose side of the fluid faces the observer, so that they are behind all particles, and their
    edges."""
    corners = shot.walls.reshape(-1, 4, 3)[:, [0, 1, 3, 2]] @ view.T
    normal = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 3] - corners[:, 0])
    facing = normal[:, 2] / numpy.linalg.norm(normal, axis=1).clip(1e-300)
    order = [k for k in corners[..., 2].mean(1).argsort() if facing[k] > 1e-6]
    greys = numpy.repeat(DARK + (LIGHT - DARK) * facing[order, None], 3, axis=1)
    look = {"facecolors": greys, "edgecolors": greys, "linewidths": 0.4, "zorder": 0.5}
    axis.add_collection(PolyCollection(corners[order, :, :2], **look))
    for rim in shot.rims:
        axis.plot(*(rim @ view[:2].T).T, color=style.FAINT, linewidth=0.7, zorder=1)


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


def section(shot, place, across=1, axes=None, particle=None):
    """Returns the section of the surfaces with the plane x_{across+1} = place as line segments (segments, 2, 2), in the
    two coordinates of the plane. With `axes` (3, 3), coordinates are along the directions in its rows. `particle`: the
    only one that is cut (default: all)."""
    cells = shot.cells_of(particle) if particle else None
    return flat(shot.sampled(shot.positions, SECTION_GRID, cells), place, across, axes)


def flat(grid, place, across=1, axes=None):
    """Returns the section of grids of cells (see `cut`) with the plane x_{across+1} = place, as `section` does."""
    grid = grid if axes is None else grid @ numpy.transpose(axes)
    return numpy.delete(cut(grid, across, place), across, axis=2)


def extents_along(shot, direction):
    """Returns the smallest and the largest coordinate along a direction (3,) of each particle, shape (particles, 2)."""
    height = shot.positions @ direction
    each = [numpy.concatenate([shot.cells[cell] for cell in shot.cells_of(name)]) for name in shot.particles]
    return numpy.array([[height[nodes].min(), height[nodes].max()] for nodes in each or [slice(None)]])


def middle_plane(shot, direction):
    """Returns the coordinate, along a direction (3,), of the plane that cuts the most particles: through the middle of
    all of them or, if more are cut there, of one of them."""
    low, high = extents_along(shot, direction).T
    middles = (low + high) / 2
    return max([middles.mean(), *middles], key=lambda place: ((low < place) & (place < high)).sum())


def draw_surroundings(axis, shot, place, across=1, axes=None, scale=1.0):
    """Draws the section of posts, walls and periodic cell (see `section`). Lengths are multiplied by `scale`."""
    if len(shot.edges):
        corners = shot.corners.reshape(2, 2, 2, 3)
        sides = numpy.array([corners.take(k, axis) for axis in range(3) for k in (0, 1)])
        draw_pieces(axis, scale * flat(sides, place, across, axes), style.FAINT, 0.6, "butt")
    draw_pieces(axis, scale * flat(shot.walls, place, across, axes), style.INK, 1.3, "butt")
    if shot.posts:
        draw_pieces(axis, scale * section(shot.posts, place, across, axes), style.FAINT, 1.3)


def draw_pieces(axis, pieces, color, width=1.6, ends="round"):
    """Draws line segments (segments, 2, 2)."""
    axis.add_collection(LineCollection(pieces, colors=[color], linewidths=width, capstyle=ends))


def direction(axis):
    """Returns the name of a direction (3,), such as x₁ or (0.6, 0.8, 0)."""
    along = numpy.flatnonzero(numpy.abs(axis) > 1 - 1e-9)
    return style.AXES[along[0]] if len(along) else "({:.3g}, {:.3g}, {:.3g})".format(*axis)


def draw_sections(axis, runs, shots):
    """Draws the sections of the surfaces of runs in the plane of the first run's flow, each through its particles."""
    start, axes = runs[0].snapshots()[0], flow_plane(runs[0])
    places = [middle_plane(shot, axes[1]) for shot in shots]
    moved = start.time < shots[0].time and shots[0].cell is None
    for shot, place in zip(shots, places):
        draw_surroundings(axis, shot, place, axes=axes)
    if moved:
        first = surrounded(runs[0], start)
        place = middle_plane(first, axes[1])
        draw_surroundings(axis, first, place, axes=axes)
        draw_pieces(axis, section(first, place, axes=axes), style.FAINT, 1, "butt")
    for run, shot, place, color in zip(runs, shots, places, style.RUNS * len(runs)):
        pieces = section(shot, place, axes=axes)
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
    sign = numpy.sign(axes[1][abs(axes[1]).argmax()])
    across, normal, up = (direction(one) for one in (axes[0], sign * axes[1], axes[2]))
    named = " or ".join(dict.fromkeys(f"{round(sign * place, 3) + 0.0:.3g}" for place in places))
    axis.set(aspect="equal", anchor="N", xlabel=f"{across} / R$_C$", ylabel=f"{up} / R$_C$",
             title=f"section {normal}{' · x' * ('(' in normal)} / R$_C$ = {named}")
    axis.legend(loc="upper center", bbox_to_anchor=(0.5, 0), borderaxespad=4)


def share_window(axes):
    """Sets the limits of all axes so that all surfaces are drawn to the same scale, each in the middle of its panel."""
    limits = numpy.array([[axis.get_xlim(), axis.get_ylim()] for axis in axes])
    width, height = numpy.ptp(limits, axis=2).max(0) / 2
    for axis, (x, y) in zip(axes, limits.mean(2)):
        axis.set(xlim=(x - width, x + width), ylim=(y - height, y + height), anchor="C")


def field_cut(shot, field, particle=None, axes=None):
    """Returns the section through the middle of a particle (default: of all surfaces), normal to x2, as line segments
    (segments, 2, 3 + k): position relative to the middle (3), and the values of a field (k). With `axes` (3, 3),
    positions are along the directions in its rows, and the section is normal to the second one."""
    cells = shot.cells_of(particle) if particle else range(len(shot.cells))
    points = shot.positions @ (numpy.eye(3) if axes is None else axes).T
    grid = shot.sampled(numpy.column_stack([points, shot.fields[field]]), GRID, cells)
    grid[..., :3] -= middle(points[numpy.concatenate([shot.cells[cell] for cell in cells])])
    return cut(grid, 1, 0)


def near_tip(shot, field):
    """Returns x1 (n,), x3 (n,) and the magnitude of a field (n,) along the half of the section (see field_cut) with
    x1 > 0, in ascending order of x3. Positions are relative to the middle of the surface."""
    place = field_cut(shot, field).mean(axis=1)
    place = place[numpy.argsort(place[:, 2])]
    x, _, z, *values = place[place[:, 0] > 0].T
    return x, z, numpy.linalg.norm(values, axis=0)


def section_variation(shot, field, particle, axes):
    """Returns an angle (n,) and |d field / dl| (n,) along the section of a particle (see field_cut), with the arc
    length l. The angle is the polar angle after the section has been scaled along its two axes to equal extents."""
    ends = field_cut(shot, field, particle, axes)
    length, change = (numpy.linalg.norm(ends[:, 1, columns] - ends[:, 0, columns], axis=1)
                      for columns in (slice(3), slice(3, None)))
    kept = length > 0.2 * numpy.median(length)  # differences over very short segments are dominated by rounding
    x, _, z = ends[kept, :, :3].mean(axis=1).T
    angle = numpy.arctan2(z / abs(z).max(), x / abs(x).max())
    order = numpy.argsort(angle)
    return angle[order], (change[kept] / length[kept])[order]
