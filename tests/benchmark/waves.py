"""Waves on a capsule: a field of a snapshot in spherical harmonics of the place on the unstressed sphere."""

from package import numpy
from tanktread.lagrange import by_degree, grid_table

SMOOTH = 8  # the flow and its answer live in degrees up to this one


class Spectrum:
    """Power of a field by degree: `power[l]`, the sum over orders and components of the squared coefficients. The
    unstressed surface is a sphere of radius `radius`, on which degree l has the wavelength 2 pi radius/sqrt(l (l +
    1))."""

    def __init__(self, snapshot, field="load", largest=40):
        self.radius, directions, weights, values = _on_the_sphere(snapshot, field)
        self.degrees, self.power = numpy.arange(largest + 1), numpy.zeros(largest + 1)
        for degree, order, harmonic in harmonics(directions, largest):
            coefficients = (weights * harmonic) @ values
            self.power[degree] += (1 if order == 0 else 2) * (abs(coefficients) ** 2).sum()

    def wavelength(self, degree):
        return 2 * numpy.pi * self.radius / numpy.sqrt(degree * (degree + 1))

    @property
    def short(self):
        """Share of the power in degrees beyond SMOOTH."""
        return self.power[SMOOTH + 1:].sum() / self.power.sum()


def harmonics(directions, largest):
    """Yields (degree, order from 0, values) of the orthonormal spherical harmonics at unit vectors (3, n), by the
    stable recursion in the degree; scipy.special.sph_harm takes a hundred times as long."""
    x, y, z = directions
    sectoral = numpy.full(len(z), (4 * numpy.pi) ** -0.5, complex)
    for order in range(largest + 1):
        if order > 0:
            sectoral = sectoral * (x + 1j * y) * -((2 * order + 1) / (2 * order)) ** 0.5
        before, now = 0 * z, sectoral
        for degree in range(order, largest + 1):
            yield degree, order, now
            a = ((4 * (degree + 1) ** 2 - 1) / ((degree + 1) ** 2 - order**2)) ** 0.5
            b = ((degree**2 - order**2) / (4 * degree**2 - 1)) ** 0.5 if degree > order else 0.0
            before, now = now, a * (z * now - b * before)


def _on_the_sphere(snapshot, field, gauss=6):
    """Returns the mean radius of the unstressed surface, and at Gauss points of its cells directions (3, n), weights of
    the unit sphere (n,) and values of the field (n, k)."""
    nodes = snapshot.points - snapshot.fields["displacement"]
    nodes = nodes - nodes.mean(0)
    values = numpy.asarray(snapshot.fields[field]).reshape(len(nodes), -1)
    points, weights = numpy.polynomial.legendre.leggauss(gauss)
    found = []
    for p, _, cells in by_degree(snapshot.cells):
        table, by_s, by_t = (grid_table(p, (points + 1) / 2, *order) for order in ((0, 0), (1, 0), (0, 1)))
        place, along, across = (one @ nodes[cells] for one in (table, by_s, by_t))
        solid = abs((place * numpy.cross(along, across)).sum(-1)) / numpy.linalg.norm(place, axis=-1) ** 3
        areas = solid * numpy.outer(weights, weights).ravel() / 4
        found.append((place.reshape(-1, 3), areas.ravel(), (table @ values[cells]).reshape(-1, values.shape[1])))
    places, areas, values = map(numpy.concatenate, zip(*found))
    radii = numpy.linalg.norm(places, axis=1)
    return radii.mean(), (places / radii[:, None]).T, areas, values
