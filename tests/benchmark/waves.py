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
        self.power = numpy.zeros(largest + 1)
        for degree, _, harmonic in harmonics(directions, largest):
            coefficients = (weights * harmonic) @ values
            self.power[degree] += (coefficients**2).sum()
        self.degrees = numpy.arange(largest + 1)

    def wavelength(self, degree):
        return 2 * numpy.pi * self.radius / numpy.sqrt(degree * (degree + 1))

    @property
    def short(self):
        """Share of the power in degrees beyond SMOOTH."""
        return self.power[SMOOTH + 1:].sum() / self.power.sum()

    @property
    def mean_degree(self):
        """Of what is beyond SMOOTH, weighted by power."""
        tail = self.power[SMOOTH + 1:]
        return (self.degrees[SMOOTH + 1:] * tail).sum() / tail.sum()


def short_share(run, field="load"):
    """Of the last snapshot of a run."""
    return Spectrum(run.snapshots()[-1], field).short


def harmonics(directions, largest):
    """(degree, order, values) of the real, orthonormal spherical harmonics at unit vectors (n, 3), by the stable
    recursion in the degree."""
    x, y, z = directions.T
    sine, azimuth = numpy.hypot(x, y), numpy.arctan2(y, x)
    sectoral = numpy.full_like(z, (4 * numpy.pi) ** -0.5)
    for order in range(largest + 1):
        if order > 0:
            sectoral = sectoral * sine * -((2 * order + 1) / (2 * order)) ** 0.5
        waves = [numpy.ones_like(z)] if order == 0 else [2**0.5 * numpy.cos(order * azimuth),
                                                         2**0.5 * numpy.sin(order * azimuth)]
        before, now = numpy.zeros_like(z), sectoral
        for degree in range(order, largest + 1):
            for wave in waves:
                yield degree, order, now * wave
            a = ((4 * (degree + 1) ** 2 - 1) / ((degree + 1) ** 2 - order**2)) ** 0.5
            b = 0.0 if degree == order else ((degree**2 - order**2) / (4 * degree**2 - 1)) ** 0.5
            before, now = now, a * (z * now - b * before)


def _on_the_sphere(snapshot, field, gauss=6):
    """Mean radius of the unstressed surface, and at Gauss points of its cells directions, weights of the unit sphere,
    values of the field."""
    nodes = snapshot.points - snapshot.fields["displacement"]
    nodes = nodes - nodes.mean(0)
    values = numpy.asarray(snapshot.fields[field]).reshape(len(nodes), -1)
    points, weights = numpy.polynomial.legendre.leggauss(gauss)
    places, areas, found = [], [], []
    for p, _, cells in by_degree(snapshot.cells):
        table, by_s, by_t = (grid_table(p, (points + 1) / 2, *order) for order in ((0, 0), (1, 0), (0, 1)))
        place, along, across = (numpy.einsum("gn,cnk->cgk", one, nodes[cells]) for one in (table, by_s, by_t))
        # of the element, over the parameters
        solid = numpy.abs((place * numpy.cross(along, across)).sum(-1)) / numpy.linalg.norm(place, axis=-1) ** 3
        places.append(place.reshape(-1, 3))
        areas.append((solid * numpy.outer(weights, weights).ravel() / 4).ravel())
        found.append(numpy.einsum("gn,cnk->cgk", table, values[cells]).reshape(-1, values.shape[1]))
    places = numpy.concatenate(places)
    radii = numpy.linalg.norm(places, axis=1)
    return radii.mean(), places / radii[:, None], numpy.concatenate(areas), numpy.concatenate(found)
