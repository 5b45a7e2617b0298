"""Triangulated surfaces: reading, checking and mending them, and distances to them."""

import contextlib
import io
import pathlib

import numpy
from scipy import sparse
from scipy.sparse import csgraph
from scipy.spatial import cKDTree

from ..files import bytes_of
from ..mistakes import Mistake, expect, log, optional

# Corners of the triangles into which cells of meshio are divided; quadrilaterals are divided by their shorter diagonal.
DIVISIONS = {"triangle": [[0, 1, 2]], "triangle6": [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]],
             "quad8": [[0, 4, 7], [4, 1, 5], [5, 2, 6], [6, 3, 7], [4, 5, 6], [4, 6, 7]]}
FEWEST = 100  # triangles; with fewer, neighbours differ by some 25 degrees, and the surface between them is a guess
SAME = 1e-6   # distance of doubled vertices, divided by the extent of the surface: text files have 6 or 7 digits


def read(path):
    """Returns the vertices (n, 3) and triangles (m, 3) of a mesh file, as they are in the file."""
    bytes_of(path)
    meshio = optional("meshio", "a mesh file")
    said = io.StringIO()
    try:
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            mesh = meshio.read(path)
    except (Exception, SystemExit) as error:  # the readers raise exceptions of many types, and may exit
        known = " ".join(sorted({name for name in meshio.extension_to_filetypes if name.count(".") == 1}))
        if pathlib.Path(path).suffix.lower() not in known.split():
            raise Mistake(f"{path}: the ending of its name is none of a mesh file: {known}") from None
        reason = str(error) if isinstance(error, Exception) else said.getvalue()
        raise Mistake(f"{path} cannot be read as a mesh ({' '.join(reason.split())[:120]}): save it as STL, as OBJ, or "
                      "as PLY") from None
    points, parts = numpy.asarray(mesh.points, float), [numpy.zeros((0, 3), int)]
    expect(points.size, f"{path} holds no points")
    expect(points.ndim == 2 and points.shape[1] == 3, f"{path}: its points are not in space, they have no x3")
    for block in mesh.cells:
        cells = numpy.asarray(block.data)
        if block.type in ("quad", "quad9"):
            cells = cells[:, :4]
            diagonals = [numpy.linalg.norm(points[cells[:, i]] - points[cells[:, i + 2]], axis=1) for i in (0, 1)]
            cells = numpy.where((diagonals[0] <= diagonals[1])[:, None], cells, numpy.roll(cells, -1, axis=1))
            parts.append(cells[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3))
        elif block.type in DIVISIONS:
            parts.append(cells[:, DIVISIONS[block.type]].reshape(-1, 3))
        elif block.type.startswith("polygon"):
            parts.append(numpy.array([[c[0], c[k], c[k + 1]] for c in cells for k in range(1, len(c) - 1)], int))
    triangles = numpy.concatenate(parts)
    expect(len(triangles), f"{path} holds no triangles: save the surface of the body")
    expect(triangles.min() >= 0 and triangles.max() < len(points), f"{path}: a triangle has a vertex that is not there")
    expect(numpy.isfinite(points[triangles]).all(), f"{path}: a vertex is not a number")
    return points, triangles


def merged(points, triangles):
    """Returns the surface with doubled vertices merged, and without triangles of no area by repeated vertices, doubled
    triangles and unused vertices."""
    used, flat = numpy.unique(triangles, return_inverse=True)
    points = points[used]
    pairs = cKDTree(points).query_pairs(SAME * numpy.ptp(points, axis=0).max(), output_type="ndarray")
    graph = sparse.coo_matrix((numpy.ones(len(pairs)), tuple(pairs.T)), (len(points),) * 2)
    count, label = csgraph.connected_components(graph, directed=False)
    if count < len(points):
        log.info(f"merged: {len(points) - count} doubled vertices")
    first = numpy.unique(label, return_index=True)[1]
    points, triangles = points[first], label[flat].reshape(-1, 3)
    whole = (triangles != numpy.roll(triangles, 1, axis=1)).all(1)
    single = numpy.unique(numpy.sort(triangles, axis=1), axis=0, return_index=True)[1]
    kept = numpy.sort(single[whole[single]])
    if len(kept) < len(triangles):
        log.info(f"left out: {len(triangles) - len(kept)} triangles that are doubled or have no area")
    return points, triangles[kept]


def edges(triangles):
    """Returns the ends (3 m, 2) of the sides of the triangles in their direction: first sides, second sides, third."""
    return numpy.concatenate([triangles[:, [i, (i + 1) % 3]] for i in range(3)])


def neighbours(triangles):
    """Returns for the three sides of each triangle of a closed surface the triangle on the other side: (m, 3)."""
    sides = numpy.sort(edges(triangles), axis=1)
    order = numpy.lexsort(sides.T).reshape(-1, 2)
    other = numpy.empty(len(sides), int)
    other[order] = order[:, ::-1] % len(triangles)
    return other.reshape(3, -1).T


def volume(points, triangles):
    """Returns the volume within a closed surface; it is negative if the surface is inside out."""
    corners = (points - points.mean(0))[triangles]
    return float(numpy.einsum("ij,ij->", corners[:, 0], numpy.cross(corners[:, 1], corners[:, 2])) / 6)


def normals(corners):
    """Returns vectors along the normals of triangles (..., 3, 3) with the length of twice the area: (..., 3)."""
    return numpy.cross(corners[..., 1, :] - corners[..., 0, :], corners[..., 2, :] - corners[..., 0, :])


def area(points, triangles):
    return float(numpy.linalg.norm(normals(points[triangles]), axis=1).sum() / 2)


def bends(points, triangles):
    """Returns for the three sides of each triangle the change of the unit normal across it, |n1 - n2|, and the distance
    of the centres of the two triangles: two arrays (m, 3)."""
    corners, other = points[triangles], neighbours(triangles)
    normal = normals(corners)
    normal /= numpy.maximum(numpy.linalg.norm(normal, axis=1, keepdims=True), numpy.finfo(float).tiny)
    middles = corners.mean(1)
    return (numpy.linalg.norm(normal[:, None] - normal[other], axis=2),
            numpy.linalg.norm(middles[:, None] - middles[other], axis=2))


def expect_closed(triangles, path):
    """Raises Mistake unless each side belongs to two triangles and the triangles at each vertex are one fan."""
    sides, counts = numpy.unique(numpy.sort(edges(triangles), axis=1), axis=0, return_counts=True)
    open_ = int((counts == 1).sum())
    expect(not open_, f"{path} is not closed: {open_} sides of triangles are at a hole or rim; close the holes in the "
           "program that made the mesh")
    expect(counts.max() == 2, f"{path}: {int((counts > 2).sum())} sides belong to more than two triangles, so that the "
           "surface branches; mend it in the program that made the mesh")
    # corners of triangles, joined across sides; there are as many groups as vertices unless two fans share a vertex
    other, count = neighbours(triangles), len(triangles)
    corner = numpy.arange(3 * count).reshape(-1, 3)
    pairs = []
    for i in range(3):
        for vertex in i, (i + 1) % 3:
            there = (triangles[other[:, i]] == triangles[:, [vertex]]).argmax(1)
            pairs.append([corner[:, vertex], corner[other[:, i], there]])
    one, two = numpy.concatenate(pairs, axis=1)
    groups = csgraph.connected_components(sparse.coo_matrix((numpy.ones(len(one)), (one, two)), (3 * count,) * 2))[0]
    expect(groups == len(numpy.unique(triangles)), f"{path}: the surface touches itself at a vertex; separate the two "
           "parts in the program that made the mesh")


def oriented(points, triangles, path):
    """Returns the triangles of one closed body, in the same order, with all normals outwards."""
    other, count = neighbours(triangles), len(triangles)
    rows = numpy.repeat(numpy.arange(count), 3)
    # two triangles are oriented alike if they traverse their common side in opposite directions
    start = numpy.stack([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]], axis=1)
    near = triangles[other]
    reverse = numpy.zeros((count, 3), bool)
    for i in range(3):
        there = near[..., i] == start[..., 1]
        reverse |= there & (near[..., (i + 1) % 3] == start[..., 0])
    alike = numpy.where(reverse, 1, -1)
    graph = sparse.csr_matrix((numpy.ones(3 * count), (rows, other.ravel())), (count, count))
    order, before = csgraph.breadth_first_order(graph, 0, directed=False)
    sign = numpy.ones(count, int)
    for one in order[1:]:
        sign[one] = sign[before[one]] * alike[one, (other[one] == before[one]).argmax()]
    expect((sign[:, None] * sign[other] == alike).all(), f"{path}: the surface has one side only, like a Klein bottle")
    turned = numpy.where(sign[:, None] > 0, triangles, triangles[:, ::-1])
    if volume(points, turned) < 0:
        turned = turned[:, ::-1]
    changed = int((turned != triangles).any(1).sum())
    if changed == count:
        log.info("turned: all triangles, the surface was inside out")
    elif changed:
        log.info(f"turned: {changed} of {count} triangles, which had the opposite orientation")
    return turned


def is_within(point, corners):
    """Returns whether a point is inside a closed surface of triangles (m, 3, 3): the solid angle of the surface."""
    a, b, c = (corners - point).transpose(1, 0, 2)
    la, lb, lc = (numpy.linalg.norm(one, axis=1) for one in (a, b, c))
    down = la * lb * lc + (a * b).sum(1) * lc + (b * c).sum(1) * la + (c * a).sum(1) * lb
    return abs(numpy.arctan2((a * numpy.cross(b, c)).sum(1), down).sum()) > numpy.pi


def expect_one_body(points, triangles, path):
    """Raises Mistake unless the surface is connected and, like a sphere, has no handle."""
    sides = edges(triangles)
    graph = sparse.coo_matrix((numpy.ones(len(sides)), tuple(sides.T)), (len(points),) * 2)
    count, label = csgraph.connected_components(graph, directed=False)
    if count > 1:
        sizes = numpy.bincount(label[triangles[:, 0]])
        largest = triangles[label[triangles[:, 0]] == sizes.argmax()]
        inner = [k for k in range(count) if k != sizes.argmax()
                 and is_within(points[(label == k).argmax()], points[largest])]
        listed = ", ".join(map(str, sorted(sizes, reverse=True)[:5])) + ", …" * (count > 5)
        if inner:
            raise Mistake(f"{path} has an inner surface within the outer one (parts of {listed} triangles): a particle "
                          "has one surface, so delete the inner one")
        raise Mistake(f"{path} holds {count} bodies, of {listed} triangles: save each one in its own file")
    handles = 1 - (len(points) - len(triangles) // 2) // 2
    expect(handles == 0, f"{path} has {handles} handle{'s' * (handles > 1)}, like a ring: a particle has the topology "
           "of a sphere, so close the hole through it")


def size_classes(radii):
    """Yields (largest radius, indices) of the groups of radii that lie within a factor of two."""
    level = numpy.ceil(numpy.log2(radii / radii.max() + 1e-9))
    for one in numpy.unique(level):
        which = numpy.flatnonzero(level == one)
        yield radii[which].max(), which


def near_pairs(points, reach, middles, radii):
    """Returns indices of points and of balls (middles, radii) with a distance of at most `reach` between each two."""
    found = []
    for radius, which in size_classes(radii):
        lists = cKDTree(middles[which]).query_ball_point(points, reach + radius)
        one = numpy.repeat(numpy.arange(len(points)), [len(one) for one in lists])
        two = which[numpy.concatenate([*map(numpy.asarray, lists), []]).astype(int)]
        found.append([one, two])
    one, two = numpy.concatenate(found, axis=1)
    reach = numpy.broadcast_to(reach, len(points))
    close = numpy.linalg.norm(points[one] - middles[two], axis=1) <= reach[one] + radii[two]
    return one[close], two[close]


def balls(corners):
    """Returns the centres and radii of balls around triangles."""
    middles = corners.mean(1)
    return middles, numpy.linalg.norm(corners - middles[:, None], axis=2).max(1)


def crossings(points, triangles):
    """Returns the number of pairs of a side and a triangle without a common vertex that cross each other. Two triangles
    of a surface cross if and only if there is such a pair, except for touching. Balls around both find the pairs. The
    vertices are moved by a distance too small for a merger, so that sides of a symmetric surface do not pass exactly
    through other sides."""
    move = numpy.random.default_rng(0).normal(size=points.shape)
    points = points + 0.1 * SAME * numpy.ptp(points, axis=0).max() * move
    sides = numpy.unique(numpy.sort(edges(triangles), axis=1), axis=0)
    ends, corners = points[sides], points[triangles]
    one, two = near_pairs(ends.mean(1), numpy.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) / 2, *balls(corners))
    apart = (sides[one][:, :, None] != triangles[two][:, None, :]).all((1, 2))
    p, q, (a, b, c) = ends[one[apart], 0], ends[one[apart], 1], corners[two[apart]].transpose(1, 0, 2)

    def side(w, x, y, z):
        """Returns on which side of the plane through w, x and y the point z lies: -1, 0 or 1."""
        return numpy.sign(numpy.einsum("ij,ij->i", numpy.cross(x - w, y - w), z - w))

    through = numpy.stack([side(p, q, a, b), side(p, q, b, c), side(p, q, c, a)])
    return int(((side(a, b, c, p) * side(a, b, c, q) < 0) & (abs(through.sum(0)) == 3)).sum())


def checked(path):
    """Returns the vertices and triangles of the body in a mesh file, mended. Raises Mistake if it is no particle."""
    points, triangles = merged(*read(path))
    expect(len(triangles) >= FEWEST, f"{path} holds {len(triangles)} triangles, too few for a smooth surface: export "
           f"the surface with at least {FEWEST}, better 2000")
    expect_closed(triangles, path)
    expect_one_body(points, triangles, path)
    triangles = oriented(points, triangles, path)
    count = crossings(points, triangles)
    expect(not count, f"{path} crosses itself: {count} sides pass through a triangle; mend it in the program that made "
           "the mesh")
    return points, triangles


def closest(points, corners):
    """Returns the closest points (n, 3) on triangles corners (n, 3, 3), each to its own triangle."""
    a, b, c = corners.transpose(1, 0, 2)

    def dot(one, two):
        return numpy.einsum("ij,ij->i", one, two)

    best, least = a.copy(), numpy.full(len(points), numpy.inf)
    with numpy.errstate(divide="ignore", invalid="ignore"):
        for start, end in ((a, b), (b, c), (c, a)):
            along = numpy.nan_to_num(dot(points - start, end - start) / dot(end - start, end - start))
            there = start + numpy.clip(along, 0, 1)[:, None] * (end - start)
            distance = dot(points - there, points - there)
            best[distance < least] = there[distance < least]
            least = numpy.minimum(distance, least)
        n = numpy.cross(b - a, c - a)
        foot = points - (dot(points - a, n) / dot(n, n))[:, None] * n
    inside = numpy.all([dot(numpy.cross(end - start, foot - start), n) > 0 for start, end in ((a, b), (b, c), (c, a))],
                       axis=0)
    return numpy.where(inside[:, None], foot, best)


def nearest(points, corners, directions=None):
    """Returns the triangle (n,) of a surface nearest to each point, and the nearest points on them (n, 3). With
    `directions` (n, 3), only triangles whose normals point the same way are considered: the right one of two layers.
    A point without such a triangle nearby gets the nearest triangle of all."""
    reach = cKDTree(corners.reshape(-1, 3)).query(points)[0]
    middles, radii = balls(corners)
    one, two = near_pairs(points, reach, middles, radii)
    there = closest(points[one], corners[two])
    distance = numpy.linalg.norm(points[one] - there, axis=1)
    if directions is not None:
        distance += 1e3 * radii.max() * (numpy.einsum("ij,ij->i", directions[one], normals(corners)[two]) <= 0)
    order = numpy.lexsort((distance, one))
    first = order[numpy.unique(one[order], return_index=True)[1]]
    return two[first], there[first]
