"""Lagrange polynomials of the cells in snapshots. Node (i, j) of a cell of degree p is at the parameters (i/p, j/p)."""

import numpy


def node_order(p):
    """Returns the pairs (i, j) of the nodes of a Lagrange quadrilateral in their order in the file (VTK's)."""
    inner = range(1, p)
    edges = [(i, 0) for i in inner] + [(p, j) for j in inner] + [(i, p) for i in inner] + [(0, j) for j in inner]
    return [(0, 0), (p, 0), (p, p), (0, p)] + edges + [(i, j) for j in inner for i in inner]


def polynomials(p, x, derivative=0):
    """Returns derivatives of the p + 1 polynomials of the nodes i/p at the parameters x: shape (len(x), p + 1)."""
    coefficients = numpy.linalg.inv(numpy.vander(numpy.arange(p + 1) / p, increasing=True))
    for _ in range(derivative):
        coefficients = coefficients[1:] * numpy.arange(1, len(coefficients))[:, None]
    return numpy.vander(x, len(coefficients), increasing=True) @ coefficients


def table(p, s, t, ds=0, dt=0):
    """Returns the polynomials of a cell's nodes at pairs of parameters s, t (m,): shape (m, (p + 1)^2)."""
    i, j = numpy.array(node_order(p)).T
    return polynomials(p, s, ds)[:, i] * polynomials(p, t, dt)[:, j]


def grid_table(p, along, ds=0, dt=0):
    """Returns the polynomials on the grid of parameters along x along, t first: shape (len(along)^2, (p + 1)^2)."""
    return table(p, numpy.tile(along, len(along)), numpy.repeat(along, len(along)), ds, dt)


def by_degree(cells):
    """Yields (degree, indices of the cells of this degree, their node numbers (cells, (degree + 1)^2))."""
    sizes = numpy.array([len(cell) for cell in cells])
    for n in numpy.unique(sizes):
        which = numpy.flatnonzero(sizes == n)
        yield round(n**0.5) - 1, which, numpy.array([cells[k] for k in which])
