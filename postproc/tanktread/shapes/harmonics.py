"""Star-shaped surfaces: spherical harmonics, and points through which they are fitted."""

import math

import numpy
from scipy.spatial import ConvexHull, cKDTree
from scipy.special import lpmv

from .. import tables
from ..mistakes import expect, log

DIRECTIONS = 10000  # vertices of the triangulation of harmonics
MISFIT = 0.05       # root mean square distance of points from harmonics, divided by the radius, of a star-shaped body


def harmonic(degree, order, direction):
    """Returns the real spherical harmonic Y_lm at unit vectors (n, 3), as an array (n,)."""
    m = abs(order)
    ratio = math.factorial(degree - m) / math.factorial(degree + m)
    scale = math.sqrt((2 * degree + 1) / (4 * math.pi) * ratio) * (-1)**m
    azimuth = numpy.arctan2(direction[:, 1], direction[:, 0])
    turn = 1 if m == 0 else math.sqrt(2) * (numpy.cos(m * azimuth) if order > 0 else numpy.sin(m * azimuth))
    return scale * lpmv(m, degree, direction[:, 2]) * turn


def radius(coefficients, direction):
    """Returns the sum of the harmonics at unit vectors (n, 3)."""
    return sum(value * harmonic(l, m, direction) for (l, m), value in coefficients.items())


def fitted(points, degree, path):
    """Returns the coefficients of the harmonics through points (n, 3), and the centre (3,) of the sphere that fits the
    points best. Raises Mistake unless the points are star-shaped about it and cover all directions."""
    middle = points.mean(0)
    table = numpy.column_stack([2 * (points - middle), numpy.ones(len(points))])
    center = middle + numpy.linalg.lstsq(table, ((points - middle)**2).sum(1), rcond=None)[0][:3]
    distance = numpy.linalg.norm(points - center, axis=1)
    expect(distance.min() > 0, f"{path}: the centre of the points is one of them, so they are not on a surface")
    directions = (points - center) / distance[:, None]
    pairs = [(l, m) for l in range(degree + 1) for m in range(-l, l + 1)]
    expect(len(points) >= len(pairs), f"{len(points)} points do not determine {len(pairs)} harmonics: lower --degree")
    table = numpy.column_stack([harmonic(l, m, directions) for l, m in pairs])
    values = numpy.linalg.lstsq(table, distance, rcond=None)[0]
    misfit = numpy.sqrt(((table @ values - distance)**2).mean())
    gap = cKDTree(directions).query(lattice())[0].max()
    expect(misfit < MISFIT * distance.mean(), f"{path}: no surface that each ray from the centre meets once fits the "
           f"points, they are off by {misfit / distance.mean():.0%} of the radius: raise --degree, or triangulate the "
           "points and give the mesh")
    expect(gap < math.pi / degree, f"{path}: a cone of {math.degrees(gap):.0f} degrees about the centre holds no "
           "points, more than the harmonics span: lower --degree, or triangulate the points and give the mesh")
    log.info(f"{len(points)} points, root mean square distance from the harmonics {misfit:.1e}")
    return dict(zip(pairs, values)), center


def lattice():
    """Returns unit vectors (n, 3), spread evenly on a spiral."""
    k = numpy.arange(DIRECTIONS) + 0.5
    z, angle = 1 - 2 * k / DIRECTIONS, math.pi * (1 + math.sqrt(5)) * k
    return numpy.column_stack([numpy.sqrt(1 - z**2) * numpy.cos(angle), numpy.sqrt(1 - z**2) * numpy.sin(angle), z])


def triangulated(path, degree):
    """Returns vertices and triangles of the surface of harmonics or points in a table."""
    center = numpy.zeros(3)
    if {"l", "m"} <= set(tables.read(path).columns):
        coefficients = {(int(l), int(m)): value for l, m, value in tables.read(path, ("l", "m", "value")).values}
    else:
        coefficients, center = fitted(tables.read(path, ("x1", "x2", "x3")).values, degree, path)
    directions = lattice()
    hull = ConvexHull(directions)
    faces = hull.simplices
    a, b, c = directions[faces].transpose(1, 0, 2)
    faces = numpy.where(((a * numpy.cross(b, c)).sum(1) < 0)[:, None], faces[:, ::-1], faces)
    length = radius(coefficients, directions)
    expect(length.min() > 0, f"{path}: the radius is negative in some directions; lower --degree")
    return center + length[:, None] * directions, faces
