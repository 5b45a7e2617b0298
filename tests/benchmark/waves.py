"""Waves on a capsule: expansion of its load in spherical harmonics on the unstressed sphere."""

from package import numpy
from tanktread.lagrange import by_degree, grid_table

SMOOTH = 8  # largest degree of the smooth part of the load, which balances the flow


def spectrum(snapshot, largest=40):
    """Returns the power of the load at the degrees 0 to `largest`, and the wavelengths 2 pi R/sqrt(l (l + 1)) of the
    degrees l = 1 to `largest`. The power of a degree is the sum of the squared coefficients over its orders and over
    the components of the load. R: radius of the unstressed sphere."""
    radius, (x, y, z), weights, values = _on_the_sphere(snapshot)
    degrees, power = numpy.arange(1, largest + 1), numpy.zeros(largest + 1)
    # orthonormal harmonics by the stable recursion in the degree; scipy.special.sph_harm takes a hundred times as long
    sectoral = numpy.full(len(z), (4 * numpy.pi) ** -0.5, complex)
    for order in range(largest + 1):
        if order > 0:
            sectoral = sectoral * (x + 1j * y) * -((2 * order + 1) / (2 * order)) ** 0.5
        before, now = 0 * z, sectoral
        for degree in range(order, largest + 1):
            power[degree] += (1 if order == 0 else 2) * (abs((weights * now) @ values) ** 2).sum()
            a = ((4 * (degree + 1) ** 2 - 1) / ((degree + 1) ** 2 - order**2)) ** 0.5
            b = ((degree**2 - order**2) / (4 * degree**2 - 1)) ** 0.5 if degree > order else 0.0
            before, now = now, a * (z * now - b * before)
    return power, 2 * numpy.pi * radius / numpy.sqrt(degrees * (degrees + 1))


def share_of_waves(power):
    """Returns the share of the power in degrees beyond SMOOTH."""
    return power[SMOOTH + 1:].sum() / power.sum()


def _on_the_sphere(snapshot, gauss=6):
    """Returns the mean radius of the unstressed surface, and three arrays at the Gauss points of its cells: directions
    (3, n), quadrature weights on the unit sphere (n,), and values of the load (n, 3)."""
    nodes = snapshot.points - snapshot.fields["displacement"]
    nodes = nodes - nodes.mean(0)
    points, weights = numpy.polynomial.legendre.leggauss(gauss)
    found = []
    for p, _, cells in by_degree(snapshot.cells):
        table, by_s, by_t = (grid_table(p, (points + 1) / 2, *order) for order in ((0, 0), (1, 0), (0, 1)))
        place, along, across = (one @ nodes[cells] for one in (table, by_s, by_t))
        solid = abs((place * numpy.cross(along, across)).sum(-1)) / numpy.linalg.norm(place, axis=-1) ** 3
        areas = solid * numpy.outer(weights, weights).ravel() / 4
        found.append((place.reshape(-1, 3), areas.ravel(), (table @ snapshot.fields["load"][cells]).reshape(-1, 3)))
    places, areas, values = map(numpy.concatenate, zip(*found))
    radii = numpy.linalg.norm(places, axis=1)
    return radii.mean(), (places / radii[:, None]).T, areas, values
