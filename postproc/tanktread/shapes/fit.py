"""Fits of spline surfaces to triangulated surfaces."""

import dataclasses

import numpy
from scipy import sparse
from scipy.spatial import cKDTree

from . import triangles as meshes
from .sphere_map import factors
from .splines import Rule

POINTS = 4       # Gauss points per element and direction
ITERATIONS = 8  # fits to projected points; a later one lowers the distance by less than 3 %


def located(directions, places, triangles):
    """Returns for unit vectors (k, 3) the spherical triangle (k,) that contains each, and the weights (k, 3) of its
    corners. It walks from a near vertex across the side beyond which the vector lies."""
    first = numpy.empty(len(places), int)
    first[triangles.ravel()] = numpy.repeat(numpy.arange(len(triangles)), 3)
    found = first[cKDTree(places).query(directions)[1]]
    other = meshes.neighbours(triangles)
    left = numpy.arange(len(directions))
    for _ in range(len(triangles)):
        a, b, c = places[triangles[found]].transpose(1, 0, 2)
        weights = numpy.stack([(directions * numpy.cross(one, two)).sum(1) for one, two in ((b, c), (c, a), (a, b))])
        weights /= abs(weights).sum(0)
        left = numpy.flatnonzero(weights.min(0) < -1e-10)
        if not len(left):
            break
        across = other[found[left]]  # across the sides 01, 12, 20, opposite to the corners 2, 0, 1
        found[left] = across[numpy.arange(len(left)), (weights[:, left].argmin(0) + 1) % 3]
    weights = numpy.maximum(weights.T, 0)
    return found, weights / weights.sum(1, keepdims=True)


def projected(points, found, corners, around):
    """Returns the nearest triangle among those around the triangle `found` of each point, and the nearest point."""
    counts = numpy.diff(around.indptr)[found]
    one = numpy.repeat(numpy.arange(len(points)), counts)
    start = numpy.repeat(numpy.cumsum(counts) - counts, counts)
    two = around.indices[numpy.arange(len(one)) - start + numpy.repeat(around.indptr[found], counts)]
    there = meshes.closest(points[one], corners[two])
    order = numpy.lexsort((((points[one] - there)**2).sum(1), one))
    best = order[numpy.unique(one[order], return_index=True)[1]]
    return two[best], there[best]


@dataclasses.dataclass
class Report:
    """How a spline surface differs from a triangulated one. Lengths in the unit of the file."""
    rms: float       # root mean square distance
    largest: float   # largest distance, in both directions
    depth: float     # depth of the facets of the mesh, which bounds the root mean square distance from below
    size: float      # radius of the sphere with the volume
    volume: float
    volume_error: float  # relative, splines minus mesh
    area: float
    area_error: float
    jacobian: float  # smallest Jacobian, divided by its mean; negative at a fold
    within: float    # smallest Jacobian along the mean normal of its element, divided by its mean in the element; the
    # program (surface/quality.hpp) refuses elements where it is negative, which turn by more than 90 degrees


class Fit:
    """A fit of the spline space of a unit sphere to a body of triangles, whose vertices have places on the sphere."""

    def __init__(self, surface, points, triangles, places):
        self.surface, self.points, self.triangles = surface, points, triangles
        self.corners = points[triangles]
        self.rule = Rule(surface, POINTS)
        directions = self.rule.value @ surface.nodes
        found, weights = located(directions / numpy.linalg.norm(directions, axis=1, keepdims=True), places, triangles)
        targets = numpy.einsum("ij,ijk->ik", weights, self.corners[found])
        self.nodes = self.least_squares(numpy.linalg.norm(self.rule.normal(surface.nodes), axis=1), targets)
        at_vertex = sparse.csr_matrix((numpy.ones(triangles.size), (numpy.repeat(numpy.arange(len(triangles)), 3),
                                                                    triangles.ravel())))
        around = (at_vertex @ at_vertex.T).tocsr()  # for each triangle those with a common vertex
        for _ in range(ITERATIONS):
            # The projection stays near the triangle of the map, so that it does not jump to another layer of a fold.
            found, there = projected(self.rule.value @ self.nodes, found, self.corners, around)
            self.nodes = self.least_squares(numpy.linalg.norm(self.rule.normal(self.nodes), axis=1), there)
        self.keep_volume_and_area()

    def matrix(self, weights):
        return self.rule.value.T @ sparse.diags(self.rule.weights * weights) @ self.rule.value

    def least_squares(self, weights, targets):
        """Returns the control points of the surface nearest to the targets (m, 3) at the points of the rule."""
        right = self.rule.value.T @ ((self.rule.weights * weights)[:, None] * targets)
        return factors(self.matrix(weights)).solve(right)

    def keep_volume_and_area(self):
        """Moves the surface by the least mean square that gives it volume and area of the mesh. The mean square
        distance is least for a smooth surface whose area is smaller than that of the facets by a few 1e-3."""
        wanted = numpy.array([meshes.volume(self.points, self.triangles), meshes.area(self.points, self.triangles)])
        rule = self.rule
        for _ in range(6):  # Newton steps
            normal = rule.normal(self.nodes)
            length = numpy.linalg.norm(normal, axis=1)
            unit, ds, dt = normal / length[:, None], rule.s @ self.nodes, rule.t @ self.nodes
            w = rule.weights[:, None]
            slopes = numpy.stack([rule.value.T @ (w * normal), rule.s.T @ (w * numpy.cross(dt, unit))
                                  + rule.t.T @ (w * numpy.cross(unit, ds))])
            moves = numpy.stack([factors(self.matrix(length)).solve(one) for one in slopes])
            gram = numpy.einsum("ikl,jkl->ij", slopes, moves)
            missing = wanted - [rule.volume(self.nodes), rule.area(self.nodes)]
            scale = 1 / numpy.sqrt(numpy.diag(gram))
            # a sphere has the least area of its volume, so both cannot be met: the cut-off shares the difference
            steps = numpy.linalg.lstsq(gram * numpy.outer(scale, scale), missing * scale, rcond=1e-3)[0] * scale
            self.nodes = self.nodes + numpy.einsum("i,ijk->jk", steps, moves)

    def report(self):
        rule, fine = self.rule, Rule(self.surface, POINTS + 1)
        normal = fine.normal(self.nodes)
        length = numpy.linalg.norm(normal, axis=1)
        now = fine.value @ self.nodes
        which, there = meshes.nearest(now, self.corners, normal)
        away = numpy.linalg.norm(now - there, axis=1)
        weight = fine.weights * length
        sign = numpy.sign((normal * meshes.normals(self.corners[which])).sum(1))
        along = numpy.linspace(0, 1, 2 * POINTS + 1)
        back = meshes.nearest(self.points, (self.surface.table(along) @ self.nodes)[self.cells(len(along))])[1]
        volume, area = meshes.volume(self.points, self.triangles), meshes.area(self.points, self.triangles)
        change, distance = meshes.bends(self.points, self.triangles)
        return Report(
            float(numpy.sqrt(weight @ away**2 / weight.sum())),
            float(max(away.max(), numpy.linalg.norm(back - self.points, axis=1).max())),
            float((change * distance).mean() / 4), (3 * volume / 4 / numpy.pi)**(1 / 3),
            rule.volume(self.nodes), rule.volume(self.nodes) / volume - 1,
            rule.area(self.nodes), rule.area(self.nodes) / area - 1,
            float((sign * length).min() / (weight.sum() / fine.weights.sum())), self.within())

    def within(self):
        normal = self.rule.normal(self.nodes).reshape(len(self.surface.elements), -1, 3)
        mean = normal.sum(1, keepdims=True)
        along = (normal * mean).sum(2) / numpy.linalg.norm(mean, axis=2)
        return float((along / numpy.linalg.norm(normal, axis=2).mean(1, keepdims=True)).min())

    def cells(self, n):
        """Returns triangles (k, 3) between points on the grid of n along n parameters in all elements."""
        i = (numpy.arange(n - 1)[:, None] * n + numpy.arange(n - 1)).ravel()
        one = numpy.concatenate([numpy.stack([i, i + 1, i + n + 1], 1), numpy.stack([i, i + n + 1, i + n], 1)])
        return (numpy.arange(len(self.surface.elements))[:, None, None] * n * n + one).reshape(-1, 3)
