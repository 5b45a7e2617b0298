"""Interpolation of series and the differences of two of them."""

import numpy


def interpolated(t, values, at, order=6):
    """Returns values(t) at the times `at`, by polynomials through `order` points. Repeated times, which mark a change
    of the mesh, are left out."""
    result, kept = [], numpy.diff(t, prepend=-numpy.inf) > 0
    t, values = numpy.asarray(t)[kept], numpy.asarray(values)[kept]
    for time in at:
        start = min(max(int(numpy.searchsorted(t, time)) - order // 2, 0), max(len(t) - order, 0))
        nodes = t[start:start + order]
        weights = [numpy.prod([(time - other) / (node - other) for other in nodes if other != node]) for node in nodes]
        result.append(float(numpy.dot(weights, values[start:start + order])))
    return numpy.array(result)


def averages_between(t, values, ends):
    """Returns the averages (m - 1,) of values(t) between successive times `ends` (m,), by the trapezoidal rule."""
    integral = numpy.concatenate([[0], numpy.cumsum(numpy.diff(t) * (values[1:] + values[:-1]) / 2)])
    return numpy.diff(numpy.interp(ends, t, integral)) / numpy.diff(ends)


def mean(t, values):
    """Returns the time average of values(t), interpolated by cubics through the four nearest rows. Returns the value if
    there is only one time. Repeated times, which mark a change of the mesh, are left out."""
    kept = numpy.diff(t, prepend=-numpy.inf) > 0
    t, values = numpy.asarray(t)[kept], numpy.asarray(values)[kept]
    if len(t) < 2:
        return float(values[-1])
    middles = interpolated(t, values, (t[1:] + t[:-1]) / 2, order=4)
    return float(numpy.diff(t) @ (values[1:] + 4 * middles + values[:-1]) / 6 / (t[-1] - t[0]))


def difference(t, values, curve_t, curve_values):
    """Returns the largest |values - curve| over the common range of time; 0 if there is none. The function with more
    times is interpolated at the times of the function with fewer times. Rows with NaN and repeated times, which mark a
    change of the mesh, are left out."""
    pairs = numpy.array([t, values], float), numpy.array([curve_t, curve_values], float)
    pairs = [pair[:, ~numpy.isnan(pair[1]) & (numpy.diff(pair[0], prepend=-numpy.inf) > 0)] for pair in pairs]
    (fine_t, fine), (coarse_t, coarse) = sorted(pairs, key=lambda pair: -pair.shape[1])
    common = (coarse_t >= fine_t[:1]) & (coarse_t <= fine_t[-1:])
    return float(numpy.max(numpy.abs(coarse[common] - interpolated(fine_t, fine, coarse_t[common])), initial=0.0))
