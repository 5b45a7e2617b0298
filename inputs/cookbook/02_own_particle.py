#!/usr/bin/python3
"""Writes a particle of your own shape, for `Particle/shape: file` of a deck.

    inputs/cookbook/02_own_particle.py SHAPE -o particle.iga [--elements 6] [--degree 4]

SHAPE is one of
    harmonics.csv    rows l,m,coefficient: the radius is the sum of coefficient x Y_lm(direction), where Y_lm are the real orthonormal
                     spherical harmonics (m < 0: sine, m > 0: cosine; no Condon-Shortley phase), with the pole along x3
    points.csv       rows x1,x2,x3: points on the surface, in any order
    surface.stl      triangles (binary or text), of which the corners are used

Points are fitted by spherical harmonics up to `--degree`, by least squares, about the centre of the sphere that fits them best. Every ray from that
centre may meet the surface once only. Prints how far the points lie from the fit, and the fit from the surface that is written."""
import argparse
import math
import pathlib
import sys
import tempfile

import numpy
from scipy.special import lpmv

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "postproc"))
import tanktread
from tanktread import tables
from tanktread.mistakes import answer

SPHERE = """Tanktread:
  Flow: {type: quiescent}
  Membrane: {shear modulus: 1.0}
  Surface: {elements per side: %d}
  Time: {scheme: bs3, final time: 1.0e-3}
  Output: {interval: 1.0e-3, surface text: true}
"""


def harmonic(degree, order, direction):
    """Returns the real spherical harmonic Y_lm at unit vectors (n, 3), as an array (n,)."""
    m = abs(order)
    scale = math.sqrt((2 * degree + 1) / (4 * math.pi) * math.factorial(degree - m) / math.factorial(degree + m)) * (-1)**m
    azimuth = numpy.arctan2(direction[:, 1], direction[:, 0])
    turn = 1 if m == 0 else math.sqrt(2) * (numpy.cos(m * azimuth) if order > 0 else numpy.sin(m * azimuth))
    return scale * lpmv(m, degree, direction[:, 2]) * turn


def radius(coefficients, direction):
    """Returns the sum of the harmonics at unit vectors (n, 3)."""
    return sum(value * harmonic(l, m, direction) for (l, m), value in coefficients.items())


def corners_of_stl(path):
    """Returns the corners (n, 3) of the triangles of an STL file, each once."""
    data = path.read_bytes()
    count = int.from_bytes(data[80:84], "little")
    if len(data) == 84 + 50 * count:
        triangles = numpy.frombuffer(data[84:], [("numbers", "<f4", 12), ("attribute", "<u2")])["numbers"]
        corners = triangles[:, 3:].reshape(-1, 3).astype(float)
    else:
        corners = numpy.array([line.split()[1:4] for line in data.decode().splitlines() if line.split()[:1] == ["vertex"]], float)
    return numpy.unique(corners, axis=0)


def fitted(points, degree):
    """Returns the coefficients of the harmonics through points (n, 3), and the centre (3,)."""
    table = numpy.column_stack([2 * points, numpy.ones(len(points))])
    center = numpy.linalg.lstsq(table, (points**2).sum(1), rcond=None)[0][:3]
    distance = numpy.linalg.norm(points - center, axis=1)
    pairs = [(l, m) for l in range(degree + 1) for m in range(-l, l + 1)]
    if len(points) < len(pairs):
        sys.exit(f"{len(points)} points do not determine {len(pairs)} harmonics: lower --degree")
    table = numpy.column_stack([harmonic(l, m, (points - center) / distance[:, None]) for l, m in pairs])
    values = numpy.linalg.lstsq(table, distance, rcond=None)[0]
    print(f"{len(points)} points, root mean square distance from the fit {numpy.sqrt(((table @ values - distance)**2).mean()):.1e}")
    return dict(zip(pairs, values)), center


def sphere(elements):
    """Returns three items for a unit sphere: the lines of its file, its control points (n, 3), and the values (m, n) of its spline functions at m points."""
    with tempfile.TemporaryDirectory() as directory:
        deck = pathlib.Path(directory, "sphere.yaml")
        deck.write_text(SPHERE % elements)
        outcome = tanktread.Study(directory=directory).run(deck, {})
        if not outcome.done:
            sys.exit(outcome.message)
        lines = (outcome.directory / "surface.iga").read_text().splitlines()
    nodes = numpy.array([line.split()[1:4] for line in lines if line.startswith("node ")], float)
    rows = []
    for k, line in enumerate(lines):
        if line.startswith("belem"):
            size, p = map(int, line.split()[1:3])
            along = numpy.array([[math.comb(p, i) * s**i * (1 - s)**(p - i) for i in range(p + 1)] for s in numpy.linspace(0, 1, 5)])
            part = numpy.zeros((25, len(nodes)))
            extraction = numpy.array([row.split() for row in lines[k + 2:k + 2 + size]], float)
            part[:, [int(i) for i in lines[k + 1].split()]] = numpy.kron(along, along) @ extraction.T
            rows.append(part)
    return lines, nodes, numpy.concatenate(rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("shape", type=pathlib.Path, help="file of the shape, see above")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True, metavar="FILE", help="file of the particle")
    parser.add_argument("--elements", type=int, default=6, help="elements per side (default: %(default)s)")
    parser.add_argument("--degree", type=int, default=4, help="largest degree of the harmonics that are fitted to points (default: %(default)s)")
    words = parser.parse_args()
    center = numpy.zeros(3)
    if words.shape.suffix == ".stl":
        coefficients, center = fitted(corners_of_stl(words.shape), words.degree)
    else:
        if {"l", "m"} <= set(tables.read(words.shape).columns):
            coefficients = {(int(l), int(m)): value for l, m, value in tables.read(words.shape, ("l", "m", "value")).values}
        else:
            coefficients, center = fitted(tables.read(words.shape, ("x1", "x2", "x3")).values, words.degree)
    lines, nodes, table = sphere(words.elements)
    direction = table @ nodes
    direction /= numpy.linalg.norm(direction, axis=1)[:, None]
    surface = radius(coefficients, direction)[:, None] * direction
    controls = numpy.linalg.lstsq(table, surface, rcond=None)[0]
    off = numpy.linalg.norm(table @ controls, axis=1) - numpy.linalg.norm(surface, axis=1)
    print(f"{len(nodes)} control points, largest distance from the harmonics {abs(off).max():.1e}")
    moved = iter(controls + center)
    lines = ["node " + " ".join(f"{x:.17g}" for x in next(moved)) + " 1" if line.startswith("node ") else line for line in lines]
    words.output.parent.mkdir(parents=True, exist_ok=True)
    words.output.write_text("\n".join(lines) + "\n")
    print(words.output)


answer(main)
