"""The plane of a run's flow, and what a picture shows besides particles: posts, plane walls, tubes and channels.
Lengths are divided by R_C."""

import numpy

from ..files import arrays_of
from ..lagrange import node_order
from ..mistakes import expect
from ..snapshots import Snapshot, evenly

MARGIN = 0.3           # length of walls beyond the particles, divided by the largest extent of all particles together
REACH = 2.0            # distance from the particles up to which plane walls and tubes are drawn, divided by that extent
AROUND, DEGREE = 8, 4  # number of cells around a post, and their degree; radii have errors below 1e-4
EVERY, CORNER = 5, 0.2  # of an outline, each fifth point is drawn, and points where it turns by more than 0.2 radians
RINGS = 80             # largest number of cross-sections of a channel that are drawn


def flow_plane(run):
    """Returns the plane in which the program measures deformation and inclination, as rows (3, 3): first direction,
    normal, second direction. It is the plane x1 x3 unless the flow is `linear`. Then it contains the flow or, if the
    flow is not planar, is normal to the vorticity."""
    if run.value("Flow/type") != "linear":
        return numpy.eye(3)
    gradient = numpy.array(run.value("Flow/gradient"), float).reshape(3, 3)
    values, vectors = numpy.linalg.eigh(gradient.T @ gradient + gradient @ gradient.T)
    spin = gradient - gradient.T
    vorticity = numpy.array([spin[2, 1], spin[0, 2], spin[1, 0]])
    normal = vectors[:, 0] if values[0] < 1e-12 * values[2] else vorticity
    if numpy.linalg.norm(normal) <= 1e-10 * values[2] ** 0.5:
        return numpy.eye(3)
    normal = normal / numpy.linalg.norm(normal)
    normal[abs(normal) < 1e-12] = 0
    first = projected(0 if abs(normal[0]) < 1 - 1e-9 else 1, normal)
    second = numpy.cross(first, normal)
    second *= numpy.sign(second[abs(second).argmax()])
    return numpy.array([first, numpy.cross(second, first), second]) + 0.0


def projected(axis, normal):
    """Returns the unit vector along the projection of a coordinate axis (0, 1 or 2) onto the plane with a normal."""
    along = numpy.eye(3)[axis] - normal[axis] * normal
    return along / numpy.linalg.norm(along)


def wall(run):
    """Returns a point of the plane wall, its unit normal, and a unit vector along it, each (3,). The vector along the
    wall is the projection of x1 onto it, or of x3 if the normal is close to x1."""
    expect(run.value("Wall/normal"), f"{run.directory}: its deck has no plane Wall")
    point, normal = (numpy.array(run.value(f"Wall/{key}"), float) for key in ("point", "normal"))
    normal /= numpy.linalg.norm(normal)
    return point, normal, projected(2 if abs(normal[0]) > 0.9 else 0, normal)


def surrounded(run, shot):
    """Returns a dimensionless copy of a snapshot (see Snapshot.scaled) with the posts of its scene and the walls near
    its particles. Without particles, the surfaces in the snapshot are the posts and walls themselves."""
    copy = shot.scaled(run)
    if run.particles:
        copy.posts = posts(run, copy.cell)
        if "Tube" in run.deck or "Channel" in run.deck:
            add_duct(run, copy)
        elif "Wall" in run.deck:
            add_plates(run, copy)
    return copy


def posts(run, cell):
    """Returns the posts in the periodic cell at the origin as a Snapshot without fields; None if there are none."""
    s, t = numpy.array(node_order(DEGREE)).T / DEGREE
    points = []
    for post in [run.kind(name) for name in run.bodies if name not in run.particles]:
        radius, axis = post.get("radius", 1.0) / run.radius, int(post.get("axis", "x1")[1]) - 1
        place = numpy.array(post.get("center", [0, 0, 0]), float) / run.radius @ numpy.linalg.inv(cell)
        place -= place.round() * [f"x{k + 1}" in run.deck["Domain"]["periodic"] for k in range(3)]
        length, centre = abs(cell[axis, axis]), place @ cell * (numpy.arange(3) != axis)
        pieces = max(1, round(length * AROUND / (2 * numpy.pi * radius)))  # cells are about as long as wide
        along, wide = length * (numpy.add.outer(numpy.arange(pieces), t) / pieces - 0.5), numpy.ones((pieces, len(t)))
        ends = 0.4999 * length * numpy.outer([-1, 1], numpy.ones(len(t)))  # inside the faces of the cell
        for x, factor in zip([*along, *ends], [*wide, t, 1 - t]):
            for part in range(AROUND):
                angle = 2 * numpy.pi * (part + s) / AROUND
                ring = x, radius * factor * numpy.cos(angle), radius * factor * numpy.sin(angle)
                points.append(centre + numpy.roll(numpy.transpose(ring), axis, axis=1))
    return Snapshot.of(points) if points else None


def add_plates(run, shot):
    """Adds the plane walls near the particles. In a periodic cell a wall is drawn over one period, and the cell ends at
    the walls."""
    point, normal, u = wall(run)
    x, base = shot.positions, point @ normal / run.radius
    size, distance = numpy.ptp(x, axis=0).max(), run.value("Wall/distance", 0) / run.radius
    top = base + distance if distance else (x @ normal).max() + MARGIN * size
    sides, centre = numpy.array([u, numpy.cross(normal, u)]), numpy.zeros(3)
    if shot.cell is not None:
        within = abs(shot.cell @ normal) < 1e-9 * numpy.linalg.norm(shot.cell, axis=1)
        sides = shot.cell[within] * numpy.array([[1], [numpy.sign(numpy.linalg.det([*shot.cell[within], normal]))]])
        shot.cell[~within], shot.origin = (top - base) * normal, (top + base) / 2 * normal
    else:
        if (x @ normal).min() - base > REACH * size:
            return
        low, high = (x @ sides.T).min(0) - MARGIN * size, (x @ sides.T).max(0) + MARGIN * size
        sides, centre = sides * (high - low)[:, None], (low + high) / 2 @ sides
    steps = numpy.array([[(i - 0.5, j - 0.5) for i in (0, 1)] for j in (0, 1)])  # x along the first side varies fastest
    lower = centre + base * normal + steps @ sides
    shot.walls = numpy.array([lower] + ([lower[:, ::-1] + distance * normal] if distance else []))
    if shot.cell is None:  # otherwise the edges of the cell show the walls
        shot.rims = [one.reshape(-1, 3)[[0, 1, 3, 2, 0]] for one in shot.walls]


def add_duct(run, shot):
    """Adds the wall of the tube or channel beside the particles; if it is periodic, over one period."""
    size, x = numpy.ptp(shot.positions, axis=0).max(), shot.positions[::5]
    outline = thinned(arrays_of(run.directory / "duct.h5")["outline"])[::-1] / run.radius  # clockwise: normals inwards
    low, high = x[:, 0].min() - MARGIN * size, x[:, 0].max() + MARGIN * size
    if shot.cell is not None:
        low, high = numpy.array([-0.5, 0.5]) * shot.cell[0, 0]
    if "Channel" in run.deck:
        centre, rings = cross_sections(arrays_of(run.directory / "channel.h5"), outline, run.radius)
        if shot.cell is not None:
            rings = numpy.concatenate([rings[k > -1:] + [k * shot.cell[0, 0], 0, 0] for k in (-1, 0, 1)])
            rings = rings[(rings[:, 0, 0] > low - 1e-9) & (rings[:, 0, 0] < high + 1e-9)]
        else:
            nearest = numpy.linalg.norm(x[:, None] - centre, axis=2).argmin(1)
            more = int(MARGIN * size / numpy.linalg.norm(centre[1] - centre[0])) + 1
            rings = rings[max(0, nearest.min() - more):nearest.max() + more + 1]
        rings = numpy.array(evenly(rings, RINGS))
    else:
        rings = numpy.array([numpy.insert(outline, 0, end, axis=1) for end in (low, high)])
        if numpy.linalg.norm(x[:, None, 1:] - outline, axis=2).min() > REACH * size:
            return
    shot.walls = quads(rings)
    shot.rims = [rings[0], rings[-1]]


def quads(grid):
    """Returns the quadrilaterals (n, 2, 2, 3) of grids of points (..., rows, columns, 3)."""
    corners = [[grid[..., :-1, :-1, :], grid[..., :-1, 1:, :]], [grid[..., 1:, :-1, :], grid[..., 1:, 1:, :]]]
    return numpy.moveaxis(numpy.array(corners), (0, 1), (-3, -2)).reshape(-1, 2, 2, 3)


def cross_sections(channel, outline, unit):
    """Returns points of the centre line of a channel (n, 3), and the outline (n, m, 3) of its cross-section at each of
    them. `channel`: arrays of channel.h5. `outline`: that of the inlet (m, 2). `unit`: the unit of lengths."""
    side, centre = channel["wall"][1] - channel["wall"][0], channel["centre"] / unit
    side /= numpy.linalg.norm(side, axis=1)[:, None]
    across = numpy.stack([side, numpy.broadcast_to([0, 0, 1], side.shape)], axis=1)
    return centre, centre[:, None] + numpy.einsum("nk,mk,nkc->nmc", channel["factor"], outline, across)


def thinned(outline):
    """Returns some of the points (m, 2) of a closed outline, among them its corners."""
    sides = numpy.diff(outline, axis=0)
    angle = numpy.arctan2(sides[:, 1], sides[:, 0])
    turn = abs((angle - numpy.roll(angle, 1) + numpy.pi) % (2 * numpy.pi) - numpy.pi)
    kept = numpy.append((turn > CORNER) | (numpy.arange(len(turn)) % EVERY == 0), True)
    return outline[kept]
