"""Outline of a surface in parallel projection, and the distances of points from it."""

import numpy
import scipy.interpolate

ZERO = 1e-11  # a component of a normal counts as 0 below this fraction of its largest value


class Outline:
    """A closed curve: periodic cubic spline in the chord length through `points` (n, 2), in counter-clockwise order."""

    def __init__(self, points):
        closed = numpy.vstack([points, points[:1]])
        along = numpy.concatenate([[0], numpy.cumsum(numpy.linalg.norm(numpy.diff(closed, axis=0), axis=1))])
        self.points, self.length = numpy.asarray(points), along[-1]
        self._curve = scipy.interpolate.CubicSpline(along, closed, bc_type="periodic")

    def even(self, n):
        """Returns n points (n, 2) at equal distances."""
        return self._curve(numpy.arange(n) / n * self.length)

    def centred(self):
        """Returns the outline moved so that the centroid of the enclosed area is at the origin."""
        a = self.even(8 * len(self.points))
        b = numpy.roll(a, -1, axis=0)
        area = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
        return Outline(self.points - ((a + b) * area[:, None]).sum(0) / (3 * area.sum()))

    def distances(self, points):
        """Returns the distances (m,) of points (m, 2) from the curve along its normal, positive outside."""
        u = numpy.linspace(0, self.length, 2 * len(self.points), endpoint=False)
        u = u[((points[:, None] - self._curve(u)) ** 2).sum(2).argmin(1)]
        for _ in range(6):
            off, slope, bend = self._curve(u) - points, self._curve(u, 1), self._curve(u, 2)
            curvature = (slope**2 + off * bend).sum(1)
            square = (slope**2).sum(1)
            u = u - (off * slope).sum(1) / numpy.where(curvature > 0.1 * square, curvature, square)
        slope = self._curve(u, 1)
        normal = numpy.column_stack([slope[:, 1], -slope[:, 0]]) / numpy.linalg.norm(slope, axis=1)[:, None]
        return ((points - self._curve(u)) * normal).sum(1)


def seen(shot, axis=1, k=8):
    """Returns the Outline of a snapshot's surface in the projection along x_{axis+1}. In every cell, bisection finds
    points whose normal is perpendicular to this axis, on k + 1 lines of constant s and of constant t. The outline
    passes through the outermost of these points in each direction from the middle. Raises ValueError if a ray from the
    middle meets the outline more than once."""

    def across(cells, s, t):
        tangent_s, tangent_t = (shot.evaluate(shot.points, cells, s, t, *order) for order in ((1, 0), (0, 1)))
        return numpy.cross(tangent_s, tangent_t)[:, axis]

    shape = len(shot.cells), k + 1, k + 1
    cell, s, t = numpy.indices(shape).reshape(3, -1)
    values = across(cell, s / k, t / k).reshape(shape)
    tiny = ZERO * abs(values).max()
    found = [numpy.array([cell, s / k, t / k])[:, abs(values).ravel() <= tiny]]
    for along in 1, 2:  # find each sign change between neighbouring samples on a line by bisection
        first, second = numpy.moveaxis(values, along, 0)[:-1], numpy.moveaxis(values, along, 0)[1:]
        step, which, other = numpy.nonzero((first * second < 0) & (abs(first) > tiny) & (abs(second) > tiny))
        sign, low, high = numpy.sign(first[step, which, other]), step / k, (step + 1) / k
        for _ in range(50):
            middle = (low + high) / 2
            place = numpy.array([which, *((middle, other / k) if along == 1 else (other / k, middle))])
            before = across(which, *place[1:]) * sign > 0
            low, high = numpy.where(before, middle, low), numpy.where(before, high, middle)
        found.append(place)
    which, s, t = numpy.concatenate(found, axis=1)
    points = shot.evaluate(shot.points, which.astype(int), s, t)
    return _outermost(numpy.delete(points, axis, axis=1))


def _outermost(points):
    """Returns the Outline through the points that are outermost in their direction from the middle of all points. Of
    several points that are close together, one is kept."""
    x, y = (points - (points.min(0) + points.max(0)) / 2).T
    order = numpy.argsort(numpy.arctan2(y, x))
    angle, radius, points = numpy.arctan2(y, x)[order], numpy.hypot(x, y)[order], points[order]
    window = 2 * numpy.pi * 4 / len(points)
    wide, far = numpy.concatenate([angle - 2 * numpy.pi, angle, angle + 2 * numpy.pi]), numpy.tile(radius, 3)
    first, last = numpy.searchsorted(wide, angle - window), numpy.searchsorted(wide, angle + window)
    top = numpy.array([far[a:b].max() for a, b in zip(first, last)])
    # removes points of inner curves; the radius of the outline decreases by less than this within the window
    points = points[radius > top * (1 - 3 * window)]
    spacing = numpy.linalg.norm(points - numpy.roll(points, 1, axis=0), axis=1).sum() / len(points)
    kept = [0]
    for i in range(1, len(points)):
        if numpy.linalg.norm(points[i] - points[kept[-1]]) > 0.3 * spacing:
            kept.append(i)
    if numpy.linalg.norm(points[kept[-1]] - points[0]) < 0.3 * spacing:
        kept.pop()
    points = points[kept]
    before, after = points - numpy.roll(points, 1, axis=0), numpy.roll(points, -1, axis=0) - points
    chord = before + after
    off = (chord[:, 0] * before[:, 1] - chord[:, 1] * before[:, 0]) / numpy.linalg.norm(chord, axis=1)
    if abs(off).max() > 0.3 * spacing:
        raise ValueError("the outline is met more than once in a direction from its middle: the shape is hollow as it "
                         "is seen")
    return Outline(points)
