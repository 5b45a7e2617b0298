"""Outline of a surface in parallel projection, as a camera sees it, and the distances of points from it.

The surface folds in the image along the curves on which its normal is perpendicular to the direction of view. The
outline is the outer boundary of the images of these curves. A curve that is hidden behind others, such as the bottom of
a hollow rear, does not contribute.
"""

import numpy
import scipy.sparse.csgraph
import scipy.spatial

TILT = 1e-6 * numpy.array([0.6, 0.8])  # slopes by which the direction of view is turned, so that no part of the surface
                                       # is seen exactly along it; moves the outline by up to 1e-6 of the size
SAMPLES = 10000  # sampled points of the surface, at least
FINER = 6        # points of a fold per triangle of the samples: the chords of the outline are then of the order of 1e-5
                 # of the size from its arcs
INSIDE = 1e-3    # a normal is evaluated this far, in local coordinates, inside its cell, because it is not defined at a
                 # pole. An error d of the position of a fold moves its image by d^2 only
SAME = 1e-7      # points of two cells whose distance is a smaller fraction of the size are one point
SEVERAL = "the outline is more than one closed curve"
SLIT = 2e-4      # narrowest slit in an outline, as a fraction of the size
TRIED = 30       # points of the boundary of a face from which a point inside it is looked for
SEEN = 1e-3      # a camera does not see gaps that are narrower than 2 SEEN of the size


class Outline:
    """A closed polygon through `points` (n, 2). Its corners are kept. `length`: its perimeter."""

    def __init__(self, points):
        self.points = numpy.asarray(points)
        self._steps = numpy.roll(self.points, -1, axis=0) - self.points
        self._along = numpy.concatenate([[0], numpy.cumsum(numpy.linalg.norm(self._steps, axis=1))])
        self.length = self._along[-1]

    @property
    def area(self):
        """The enclosed area."""
        return abs(_cross(self.points, self._steps).sum()) / 2

    def even(self, n):
        """Returns n points (n, 2) at equal distances along the outline."""
        along, closed = numpy.arange(n) / n * self.length, numpy.vstack([self.points, self.points[:1]])
        return numpy.column_stack([numpy.interp(along, self._along, x) for x in closed.T])

    def centred(self):
        """Returns the outline moved so that the centroid of the enclosed area is at the origin."""
        a = self.points - self.points[0]
        weights = _cross(a, self._steps)
        shift = ((2 * a + self._steps) * weights[:, None]).sum(0) / (3 * weights.sum())
        return Outline(a - shift)

    def contains(self, points):
        """Returns whether each of the points (m, 2) is inside."""
        low, high = self.points[:, 1], numpy.roll(self.points[:, 1], -1)
        x, y = numpy.transpose(points)[:, :, None]
        left = _cross(self._steps, numpy.stack([x - self.points[:, 0], y - low], axis=2)) > 0
        return (((low <= y) & (y < high) & left) | ((high <= y) & (y < low) & ~left)).sum(1) % 2 == 1

    def distances(self, points):
        """Returns the distances (m,) of points (m, 2) from the outline, positive outside."""
        found = numpy.empty(len(points))
        square = numpy.maximum((self._steps**2).sum(1), numpy.finfo(float).tiny)
        for part in numpy.array_split(numpy.arange(len(points)), 1 + len(points) * len(self.points) // 10**6):
            off = points[part, None] - self.points
            nearest = numpy.clip((off * self._steps).sum(2) / square, 0, 1)
            found[part] = numpy.linalg.norm(off - nearest[:, :, None] * self._steps, axis=2).min(1)
            found[part] *= numpy.where(self.contains(points[part]), -1, 1)
        return found


def _cross(a, b):
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def seen(shot, axis=1):
    """Returns the Outline of a snapshot's surface, or of its surfaces, in the projection along x_{axis+1}. Coordinates
    are the other two. Raises ValueError if a camera sees more than one curve."""
    middle = (shot.points.min(0) + shot.points.max(0)) / 2

    def projected(points):
        return numpy.delete(points, axis, axis=1) - (points[:, axis] - middle[axis])[:, None] * TILT

    return _envelope(*_folds(shot, numpy.insert(TILT, axis, 1), projected))


def _folds(shot, view, projected):
    """Returns the curves on which the normal is perpendicular to the vector `view`: the images (n, 2) of their points,
    and the indices (m, 2) of the ends of their segments. Also returns the images (j, 3, 2) of triangles on the surface.

    The curves cross triangles of sampled points where the component of the normal along `view` changes sign. This
    component is interpolated linearly, and the points are on the exact surface."""
    count = len(shot.cells)
    k = int(numpy.clip(numpy.ceil(numpy.sqrt(SAMPLES / count)), 4, 32))  # intervals per direction of a cell
    cell, t, s = numpy.indices((count, k + 1, k + 1)).reshape(3, -1)
    place = numpy.column_stack([s, t]) / k
    points = shot.evaluate(shot.points, cell, *place.T)
    along_s, along_t = (shot.evaluate(shot.points, cell, *numpy.clip(place, INSIDE, 1 - INSIDE).T, *order)
                        for order in ((1, 0), (0, 1)))
    normals = numpy.cross(along_s, along_t)
    normals /= numpy.linalg.norm(normals, axis=1)[:, None]
    same = scipy.spatial.cKDTree(points).query_pairs(SAME * numpy.ptp(points, axis=0).max(), output_type="ndarray")
    vertex = _components(same, len(points))  # neighbouring cells have equal points at their common side
    value = numpy.bincount(vertex, normals @ view)[vertex]

    corner = numpy.arange(len(points)).reshape(count, k + 1, k + 1)
    a, b, c, d = corner[:, :-1, :-1], corner[:, :-1, 1:], corner[:, 1:, 1:], corner[:, 1:, :-1]
    triangles = numpy.stack([[a, b, c], [a, c, d]], axis=-1).reshape(3, -1).T
    above = (value > 0)[triangles]
    crossed = (above.any(1) & ~above.all(1)).nonzero()[0]
    odd = numpy.where(above[crossed].sum(1) == 1, above[crossed].argmax(1), above[crossed].argmin(1))
    tip, *others = (triangles[crossed, (odd + j) % 3] for j in range(3))
    ends, keys = [], []
    for other in others:
        ends.append(place[tip] + (value[tip] / (value[tip] - value[other]))[:, None] * (place[other] - place[tip]))
        keys.append(numpy.sort([vertex[tip], vertex[other]], axis=0).T)
    names, node = numpy.unique(numpy.concatenate(keys), axis=0, return_inverse=True)
    node = node.reshape(2, -1)
    between = numpy.linspace(0, 1, FINER + 1)[:, None, None]
    where = (1 - between) * ends[0] + between * ends[1]
    found = shot.evaluate(shot.points, numpy.tile(cell[tip], FINER + 1), *where.reshape(-1, 2).T)
    new = len(names) + numpy.arange((FINER - 1) * len(tip)).reshape(FINER - 1, -1)
    nodes = numpy.concatenate([node[:1], new, node[1:]])
    fold = numpy.empty((nodes.max() + 1, 3))
    fold[nodes.ravel()] = found
    segments = numpy.stack([nodes[:-1], nodes[1:]], axis=-1).reshape(-1, 2)
    return projected(fold), numpy.concatenate([segments, _missing(fold, segments)]), projected(points)[triangles]


def _missing(points, segments):
    """Returns segments (m, 2) that close the curves. They connect open ends that are next to each other, where a side
    of a cell is that of two smaller cells."""
    ends, made = numpy.flatnonzero(numpy.bincount(segments.ravel(), minlength=len(points)) % 2), []
    while len(ends) > 1:
        near = scipy.spatial.cKDTree(points[ends]).query(points[ends], 2)[1]
        own = numpy.arange(len(ends))
        near = numpy.where(near[:, 0] == own, near[:, 1], near[:, 0])
        pairs = (near[near] == own) & (own < near)
        if not pairs.any():
            break
        made.append(numpy.column_stack([ends[pairs], ends[near[pairs]]]))
        ends = numpy.setdiff1d(ends, made[-1])
    return numpy.concatenate([numpy.zeros((0, 2), int), *made])


def _components(pairs, n):
    """Returns for each of n items the number of its connected component. `pairs`: connected items (m, 2)."""
    graph = scipy.sparse.coo_matrix((numpy.ones(len(pairs)), tuple(numpy.transpose(pairs))), (n, n))
    return scipy.sparse.csgraph.connected_components(graph, directed=False)[1]


def _split(points, segments):
    """Returns points and edges (m, 2) of a plane graph, in which the segments are divided where they cross, and the
    direction (m, 2) of each edge."""
    start, step = points[segments[:, 0]], points[segments[:, 1]] - points[segments[:, 0]]
    longest = numpy.linalg.norm(step, axis=1).max()
    i, j = scipy.spatial.cKDTree(start + step / 2).query_pairs(longest, output_type="ndarray").T
    apart = (segments[i][:, :, None] != segments[j][:, None]).all((1, 2))
    i, j = i[apart], j[apart]
    off, area = start[j] - start[i], _cross(step[i], step[j])
    with numpy.errstate(divide="ignore", invalid="ignore"):
        on_i, on_j = _cross(off, step[j]) / area, _cross(off, step[i]) / area
    crossing = (on_i >= 0) & (on_i <= 1) & (on_j >= 0) & (on_j <= 1)
    i, j, on_i, on_j = i[crossing], j[crossing], on_i[crossing], on_j[crossing]
    new, m = len(points) + numpy.arange(len(i)), len(segments)
    owner = numpy.concatenate([numpy.tile(numpy.arange(m), 2), i, j])
    along = numpy.concatenate([numpy.zeros(m), numpy.ones(m), on_i, on_j])
    node = numpy.concatenate([segments.T.ravel(), new, new])
    order = numpy.lexsort([along, owner])
    owner, node = owner[order], node[order]
    inner = owner[1:] == owner[:-1]
    return (numpy.concatenate([points, start[i] + on_i[:, None] * step[i]]),
            numpy.column_stack([node[:-1], node[1:]])[inner], step[owner[1:][inner]])


def _faces(points, edges, directions):
    """Returns the closed polygons that surround the faces of a plane graph, as arrays of indices of points, and their
    areas. A bounded face is on the left of its polygon and has a positive area. The outer polygon of each connected
    part of the graph has a negative area."""
    m = len(edges)
    tail = edges.T.ravel()
    twin = numpy.roll(numpy.arange(2 * m), m)
    angle = numpy.arctan2(*numpy.concatenate([directions, -directions]).T[::-1])
    order = numpy.lexsort([angle, tail])
    first = numpy.searchsorted(tail[order], tail[order])  # first and last of those with the same tail
    last = numpy.searchsorted(tail[order], tail[order], side="right") - 1
    rank = numpy.arange(2 * m)
    before = numpy.empty(2 * m, int)
    before[order] = order[numpy.where(rank > first, rank - 1, last)]  # the next edge clockwise about the tail
    following = before[twin]
    label = _components(numpy.column_stack([numpy.arange(2 * m), following]), 2 * m)
    here = points[tail] - points.mean(0)
    areas = numpy.bincount(label, _cross(here, here[following])) / 2
    polygons = {}
    for face in numpy.flatnonzero(abs(areas) > (SEEN * numpy.ptp(points, axis=0).max())**2):
        at = (label == face).argmax()
        walk = [at]
        while following[walk[-1]] != at:
            walk.append(following[walk[-1]])
        polygons[face] = tail[walk]
    return [(points[one], areas[face]) for face, one in polygons.items()]


def _envelope(points, segments, triangles):
    """Returns the Outline of the outer boundary of curves. Raises ValueError if a camera sees more than one curve."""
    faces = _faces(*_split(points, segments))
    outer = sorted((polygon for polygon in faces if polygon[1] < 0), key=lambda polygon: polygon[1])
    size = numpy.ptp(outer[0][0], axis=0).max()
    outline = Outline(_without_slits(outer[0][0][::-1], SLIT * size))
    if not all(outline.contains(polygon[:1])[0] for polygon, _ in outer[1:]):
        raise ValueError(f"{SEVERAL}: surfaces are seen side by side")
    for polygon, area in faces:
        point = _inner(Outline(polygon), SEEN * size) if area > 0 else None
        if point is not None and not _covered(point, triangles):
            raise ValueError(f"{SEVERAL}: the background is seen through a gap in the shape")
    return outline


def _without_slits(points, width):
    """Returns the polygon without slits that are narrower than `width`. They arise where two arcs nearly coincide.
    Removes the tip of a slit, where the polygon turns back, until its sides are `width` apart."""
    kept = []
    for x, y in [*points.tolist(), *points[:1].tolist()]:
        while len(kept) > 1:
            (before_x, before_y), (tip_x, tip_y) = kept[-2:]
            a, b = complex(tip_x - before_x, tip_y - before_y), complex(x - tip_x, y - tip_y)
            turn, longer = a.conjugate() * b, max(abs(a), abs(b))
            if turn.real > -0.8 * abs(a) * abs(b) or abs(turn.imag) > width * longer:  # 0.8: a turn by 143 degrees
                break
            kept.pop()
        kept.append((x, y))
    return numpy.array(kept[:-1])


def _inner(face, least):
    """Returns a point of the face that is far from its boundary, or None if all are closer than `least`."""
    at, ahead = face.even(2 * TRIED).reshape(-1, 2, 2).swapaxes(0, 1)
    inwards = (ahead - at)[:, ::-1] * [-1, 1] / numpy.linalg.norm(ahead - at, axis=1)[:, None]
    tried = numpy.concatenate([at + far * inwards for far in least * 3.0 ** numpy.arange(6)])
    far = -face.distances(tried)
    return tried[far.argmax()] if far.max() > 0.99 * least else None


def _covered(point, triangles):
    """Returns whether the point (2,) is in one of the triangles (m, 3, 2)."""
    side = _cross(numpy.roll(triangles, -1, axis=1) - triangles, point - triangles) > 0
    return bool((side.all(1) | ~side.any(1)).any())
