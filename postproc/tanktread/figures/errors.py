"""Figures of the error against a known curve, and of sharp edges from rounded ones."""

import pathlib

import numpy
import scipy.interpolate
import scipy.optimize

from ..files import table
from ..interpolation import difference
from ..mistakes import expect, log
from ..results import time_label
from ..runs import Study, deck_at, settings_of
from . import style
from .register import figure

SAMPLES = 400  # along the way


class Errors:
    """Errors of one run at the times within the curve, its `costs` (control points, seconds, velocity evaluations), and
    its family."""

    def __init__(self, run, curve, series):
        inside = (run.time >= curve["t"][0]) & (run.time <= curve["t"][-1])
        expect(inside.any(), f"{run.directory} has no row within the times of the curve")
        self.run, self.times, values = run, run.time[inside], run.series[series][inside]
        self.errors = numpy.array([difference([time], [value], curve["t"], curve[series])
                                   for time, value in zip(self.times, values)])
        self.largest = self.errors.max()
        self.costs = [run.series[name][-1] for name in ("n_control_points", "wall_seconds", "evaluations")]
        self.family = f"{run.value('Time/scheme')}, tolerance {run.value('Time/tolerance')}"


@figure(2, 2, 9.6, 7)
def convergence(runs, over_time, *over_costs, curve: pathlib.Path | None = None, series: str = "taylor_inertia"):
    """Error of a run's deformation against a curve: over time, against the mesh, seconds and velocity evaluations.

    The curve is a CSV file with the columns `t`, which is time times the rate of the flow, and `taylor_inertia`. A line
    joins runs that agree in Time/scheme and Time/tolerance.

    curve: the reference, a table with named columns
    series: which series, and column of the curve"""
    expect(curve, "give the reference: --curve FILE")
    known = table(curve, ("t", series))
    expect(numpy.isfinite(known["t"]).all() and ("NaN if" in runs[0].descriptions.get(series, "")
                                                 or numpy.isfinite(known[series]).all()), f"{curve} has NaN")
    found = sorted((Errors(run, known, series) for run in runs), key=lambda one: one.costs[0])
    for one, shade in zip(found, style.plt.get_cmap(style.FIELD)(numpy.linspace(0.1, 0.8, len(found)))):
        over_time.semilogy(one.times, numpy.maximum(one.errors, 1e-12), color=shade, linewidth=1.2, label=one.run.name)
        points, seconds, evaluations = one.costs
        log.info(f"{one.run.name}: {points:.0f} control points, {one.family}: largest error {one.largest:.2e}, "
                 f"{evaluations:.0f} evaluations, {seconds:.2f} s")
    room = 0.1 * min(numpy.median(one.errors) for one in found), 30 * found[0].largest  # for the legend
    over_time.set(xlabel=time_label([one.run for one in found]), ylabel="error", ylim=room)
    over_time.legend(loc="upper left", ncols=2)
    for family, color in style.coloured(sorted({one.family for one in found})):
        members = [one for one in found if one.family == family]
        costs, largest = numpy.array([one.costs for one in members]).T, [one.largest for one in members]
        for axis, cost in zip(over_costs, costs):
            axis.loglog(cost, largest, "o-", color=color, ms=4, label=family)
        if numpy.ptp(costs[0]) > 0:  # fitted in the mesh size, which is control points to the power -1/2
            log.info(f"{family}: order {-2 * numpy.polyfit(numpy.log(costs[0]), numpy.log(largest), 1)[0]:.2f}")
    for axis, label in zip(over_costs, ("control points", "seconds", "velocity evaluations")):
        axis.set(xlabel=label, ylabel=f"largest error of {series}")
    n = numpy.array([found[0].costs[0], found[-1].costs[0]])
    if n[1] > n[0]:  # in the mesh size, from the coarsest mesh on
        over_costs[0].loglog(n, 0.3 * found[0].largest * (n / n[0]) ** -2.0, label="fourth order", **style.GUIDE)
    over_costs[0].legend(loc="lower left")


@figure(1, 1, 7, 5)
def step(deck, axis, *, radii: tuple[float, float] = (0.1, 0.05), finer: list[str] | None = None,
         set_: list[str] | None = None, curves: tuple[pathlib.Path, pathlib.Path, pathlib.Path] | None = None,
         between: tuple[float, float] = (-3.9, 4.9)):
    """Extents of a capsule against its centroid in a channel that steps, with edges rounded less and less, and sharp.

    The extent along x3 has kinks, beside which it is no better than rows are close: --set 'Time/maximum step=0.01' for
    three digits. Each --finer is made with both radii, and its change is printed; the curves add these changes. An edge
    rounded with the radius r changes the flow around by r^2q, where q = 0.544 is the power of the velocity beside a
    sharp edge of 90 degrees, sin(3 pi q/2) = q (Dean & Montagnon, Proc. Camb. Phil. Soc. 45, 1949); so two radii give
    the extents beside sharp edges.

    radii: radii of the edges, the larger one first
    finer: keys by which runs are made finer, each KEY=VALUE
    set_: other keys of all runs, each KEY=VALUE
    curves: published extents along x1, x2, x3: a centroid and an extent over 2 a per row
    between: centroids between which extents are drawn"""
    (large, small), (begin, end), words, finer = radii, between, set_ or [], finer or []
    expect(0 < small < large,
           f"--radii needs two positive radii, the larger one first, but is given {large:g} and {small:g}")
    expect(begin < end, f"--between needs two centroids that ascend, but is given {begin:g} and {end:g}")
    settings_of(words + finer)
    known = [table(path)[:, :2] for path in curves or []]
    within = [curve[(curve[:, 0] > begin) & (curve[:, 0] < end)] for curve in known]
    for path, rows in zip(curves or [], within):
        expect(len(rows), f"{path} has no row between {begin:g} and {end:g}")
    x, runs, deck = numpy.linspace(begin, end, SAMPLES), Study(directory="results/step"), deck_at(deck)
    of_large, of_small = (of_radius(runs, deck, words, finer, radius, x) for radius in radii)
    sharp = sharp_edges(of_large, of_small, large / small)
    for name, colour, dots, dashes, line in zip(style.AXES, style.RUNS, of_large, of_small, sharp):
        axis.plot(x, dots, ":", x, dashes, "--", color=colour)
        axis.plot(x, line, color=colour, label=f"along {name}")
        off = numpy.abs(line - dashes)
        log.info(f"along {name}: radii {large:g} and {small:g} differ by {numpy.abs(dots - dashes).max():.1e}, "
                 f"sharp edges from {small:g} by {off.max():.1e} at most, at {x[off.argmax()]:.2f}")
    for curve, (centroid, extent), name, mark, line in zip(known, (rows.T for rows in within), style.AXES, style.MARKS,
                                                           sharp):
        off = numpy.interp(centroid, x, line) - extent
        at = numpy.argmax(numpy.abs(off))
        axis.plot(*curve.T, mark, color=style.FAINT, markersize=3, label=f"published, {name}")
        log.info(f"along {name}: {off[at]:+.4f} off the curve at most, at {centroid[at]:.3f}; "
                 f"{numpy.sqrt(numpy.mean(off**2)):.4f} on average")
    style.finish(axis, xlabel="centroid $x_1$", ylabel="extent over 2a",
                 title=f"edges sharp (lines), rounded by {small:g} (dashes) and {large:g} (dots)")


def power():
    """Returns the power 2 q of the radius of an edge."""
    return 2 * scipy.optimize.brentq(lambda q: numpy.sin(1.5 * numpy.pi * q) - q, 0.5, 0.6, xtol=1e-15)


def sharp_edges(of_large, of_small, ratio):
    """Returns the extents beside sharp edges, from those of two radii with this ratio."""
    return of_small - (of_large - of_small) / (ratio**power() - 1)


def extents(outcome, x):
    """Returns the extents (3, x.size) over 2 a with the centroid at x1 = x, by cubic splines."""
    expect(outcome.done, f"{outcome.directory}: {outcome.message}")
    series, way = outcome.series, outcome.series["centroid_x1"]
    expect((numpy.diff(way) > 0).all(),
           f"{outcome.directory}: its centroid went back, so that there are several extents at a place")
    expect(way[0] <= x[0] and x[-1] <= way[-1],
           f"{outcome.directory}: --between {x[0]:g} {x[-1]:g}, but it went from {way[0]:g} to {way[-1]:g}")
    lengths = [series[f"length_x{k}"] for k in (1, 2, 3)]
    return scipy.interpolate.CubicSpline(way, lengths, axis=1)(x) / (2 * outcome.run.value("Particle/radius", 1.0))


def of_radius(runs, deck, words, finer, radius, x):
    """Returns the extents (3, x.size) with edges of a radius, with the sum of the changes by each --finer."""
    def of(more):
        return extents(runs.run(deck, {"Channel/corner radius": radius} | settings_of(more)), x)

    first = found = of(words)
    for one in finer:
        change = of(words + [one]) - first
        log.info(f"radius {radius:g}, {one}: changes " + ", ".join(f"{value:.1e}" for value in abs(change).max(axis=1)))
        found = found + change
    return found
