"""Spline surfaces in Bezier-extraction text (.iga): their functions, and their least-squares fits."""

import math
import pathlib
import tempfile

import numpy
from scipy import sparse

from ..mistakes import expect
from ..runs import Study

SPHERE = """Tanktread:
  Flow: {type: quiescent}
  Membrane: {shear modulus: 1.0}
  Surface: {elements per side: %d}
  Time: {scheme: bs3, final time: 1.0e-3}
  Output: {interval: 1.0e-3, surface text: true}
"""


def bernstein(degree, x, derivative=0):
    """Returns the Bernstein polynomials, or their first derivatives, at parameters x: (len(x), degree + 1)."""
    if derivative:
        lower = degree * bernstein(degree - 1, x)
        return numpy.pad(lower, ((0, 0), (1, 0))) - numpy.pad(lower, ((0, 0), (0, 1)))
    i = numpy.arange(degree + 1)
    choices = numpy.array([math.comb(degree, k) for k in i])
    return choices * x[:, None]**i * (1 - x[:, None])**(degree - i)


class Surface:
    """A spline surface: `lines` of its file, `nodes` (n, 3), and `elements`, each (degree, control points, extraction
    matrix (control points, (degree + 1)^2), s fastest)."""

    def __init__(self, text):
        self.lines = text.splitlines()
        starts = [k for k, line in enumerate(self.lines) if line.startswith("node ")]
        self.first = starts[0]
        self.nodes = numpy.array([self.lines[k].split()[1:4] for k in starts], float)
        self.elements = []
        for k, line in enumerate(self.lines):
            if line.startswith("belem"):
                size, degree = map(int, line.split()[1:3])
                self.elements.append((degree, numpy.array(self.lines[k + 1].split(), int), numpy.array(
                    [row.split() for row in self.lines[k + 2:k + 2 + size]], float)))

    def table(self, along, ds=0, dt=0):
        """Returns the functions, or derivatives of them, on the grid of parameters along x along in all elements: a
        sparse matrix (elements len(along)^2, n), s fastest."""
        rows, columns, values = [], [], []
        m = len(along)**2
        for k, (degree, points, extraction) in enumerate(self.elements):
            part = numpy.kron(bernstein(degree, along, dt), bernstein(degree, along, ds)) @ extraction.T
            rows.append(numpy.repeat(k * m + numpy.arange(m), len(points)))
            columns.append(numpy.tile(points, m))
            values.append(part.ravel())
        place = numpy.concatenate(rows), numpy.concatenate(columns)
        return sparse.csr_matrix((numpy.concatenate(values), place), (m * len(self.elements), len(self.nodes)))

    def text(self, nodes):
        """Returns the text of the file with other control points."""
        lines = list(self.lines)
        for k, node in enumerate(nodes):
            lines[self.first + k] = "node " + " ".join(f"{x:.17g}" for x in node) + " 1"
        return "\n".join(lines) + "\n"


def sphere(elements):
    """Returns the unit sphere of the program with this number of elements per side."""
    with tempfile.TemporaryDirectory() as directory:
        deck = pathlib.Path(directory, "sphere.yaml")
        deck.write_text(SPHERE % elements)
        outcome = Study(directory=directory).run(deck, {})
        expect(outcome.done, outcome.message)
        return Surface((outcome.directory / "surface.iga").read_text())


class Rule:
    """Quadrature of a spline surface with points x points Gauss points in each element: tables of the functions and
    their derivatives, and `weights` (m,) for integrals over the parameters."""

    def __init__(self, surface, points):
        x, w = numpy.polynomial.legendre.leggauss(points)
        self.along = (1 + x) / 2
        self.value, self.s, self.t = (surface.table(self.along, *ds) for ds in ((0, 0), (1, 0), (0, 1)))
        self.weights = numpy.tile(numpy.kron(w, w) / 4, len(surface.elements))

    def normal(self, nodes):
        """Returns the normals with the length of the Jacobian (m, 3)."""
        return numpy.cross(self.s @ nodes, self.t @ nodes)

    def volume(self, nodes):
        return float(self.weights @ ((self.value @ nodes) * self.normal(nodes)).sum(1)) / 3

    def area(self, nodes):
        return float(self.weights @ numpy.linalg.norm(self.normal(nodes), axis=1))
