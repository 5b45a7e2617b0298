"""Figures of accuracy: estimated error against computing time, error relative to a reference curve, and extrapolation
from rounded edges of a channel to sharp edges."""

import pathlib
import tempfile

import numpy
import scipy.interpolate
import scipy.optimize

from .. import tables
from ..interpolation import difference, mean
from ..mistakes import expect, log
from ..results import Run, time_label
from ..runs import Study, deck_at, settings_of
from . import style
from .register import figure

PARTS = {"mesh": ("Surface/", "Particles/", "Adaptation/", "Tube/", "Channel/", "Wall/"),
         "time": ("Time/", "Steady/", "Periodic/", "Continuation/"), "quadrature": ("Quadrature/", "Solvers/")}
COSTS = {"n_control_points": "control points", "wall_seconds": "wall time / s", "evaluations": "velocity evaluations"}
SAMPLES = 400  # number of centroid positions at which extents are drawn


def changes_by_part(run, settings, request, study):
    """Returns {part: change of the result of a run if only this part of the discretisation (see PARTS) is refined}.
    `settings`: settings of the run and of the next finer level."""
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        deck = pathlib.Path(folder) / f"{run.directory.parent.resolve().name}.yaml"
        deck.write_text(run.deck_text, encoding="utf-8")
        for part, keys in PARTS.items():
            coarse, finer = ({key: one[key] for key in one if key.startswith(keys)} for one in settings)
            if finer != coarse:
                outcome = study.run(deck, finer)
                expect(outcome.done, f"the run with a finer {part} did not come to its end: {outcome.message}")
                found[part] = largest(values(outcome.run, request), values(run, request))
    return found


def values(run, request):
    """Returns the times and values whose error a request limits: the whole series, its last value, or its average. Of a
    branch of steady shapes, only the folds and the last point are included."""
    times, series = run.series["time"], run.series[request["series"]]
    if "fold" in run.series:
        chosen = numpy.flatnonzero((run.series["fold"] != 0) | (numpy.arange(len(series)) == len(series) - 1))
        times, series = numpy.arange(len(chosen), dtype=float), series[chosen]
    if request["of"] == "run":
        return times, series
    known = ~numpy.isnan(series)
    return numpy.zeros(1), numpy.array([series[-1] if request["of"] == "end" else mean(times[known], series[known])])


def largest(one, other):
    """Returns the largest difference of two series (times, values) at their common times. If these are fewer than five
    and fewer than the rows of the shorter series, or if the values there cover less than half of the range of the
    first series, interpolates one series at the times of the other."""
    _, mine, theirs = numpy.intersect1d(one[0].round(9), other[0].round(9), return_indices=True)
    known = [values[~numpy.isnan(values)] for values in (one[1][mine], one[1])]
    covers = len(known[0]) > 0 and numpy.ptp(known[0]) >= numpy.ptp(known[1]) / 2
    if len(mine) >= min(5, len(one[0]), len(other[0])) and covers:
        return float(numpy.nanmax(abs(one[1][mine] - other[1][theirs])))
    return difference(*one, *other)


@figure(1, 1, 6.4, 4.4)
def work(run, axis, *, parts: bool = True):
    """Estimated error against wall time for each series with requested accuracy, with the dominant source of error.

    Each point is one level: --accuracy runs the deck at several levels, each more accurate than the previous one. The
    error of a level is its difference from the finest level. The error of the finest level is estimated by the program.
    The sources of error are the mesh, the time steps and the quadrature. The dominant source is the one whose
    refinement changes the result most.

    parts: also make the runs that determine the dominant source of error"""
    found = (run.summary or {}).get("accuracy") or {}
    expect(found, f"{run.directory} is no run with requested accuracy: run its deck with --accuracy SERIES=VALUE")
    expect(found.get("levels"), f"{run.directory} has no finished level")
    runs = [Run(run.directory / f"level_{level['level']}") for level in found["levels"]]
    settings = [settings_of(level["settings"]) for level in found["levels"]]
    study, k = Study(directory=run.directory / "parts"), max(0, len(runs) - 3)  # parts of the third last level
    for request, color in style.coloured(found["requests"]):
        *coarser, finest = (values(one, request) for one in runs)
        errors = numpy.array([*(largest(one, finest) for one in coarser), request["estimated error"]])
        known = numpy.isfinite(errors) & (errors > 0)
        if known.sum() < 2:
            log.info(f"{request['request']}: {request.get('untrusted', 'the error is unknown')}")
            continue
        seconds, errors = numpy.array([level["seconds"] for level in found["levels"]])[known], errors[known]
        slope = numpy.polyfit(numpy.log(seconds), numpy.log(errors), 1)[0]
        changes = changes_by_part(runs[k], settings[k:k + 2], request, study) if parts else {}
        words = f"{request['request']}: slope {slope:.1f}"
        words += f", mainly {max(changes, key=lambda part: changes[part])}" if changes else ""
        axis.loglog(seconds, errors, "o-", ms=4, color=color, label=words)
        axis.axhline(request["allowed"], linewidth=0.8, **style.GUIDE | {"color": color})
        listed = ", ".join(f"{part} {change:.2g}" for part, change in changes.items())
        log.info(words + (f"; change by refinement of {listed}" if changes else ""))
    style.finish(axis, xlabel="wall time of the level / s", ylabel="estimated error",
                 title="dashed: requested accuracy")


@figure(2, 2, 9.6, 7)
def convergence(runs, over_time, *over_costs, curve: pathlib.Path | None = None, series: str = "taylor_inertia"):
    """Error of a series relative to a reference curve: over time, and against the size of the mesh and the cost.

    The reference is a CSV file. Its column `t` is time times the rate of the flow. The column of values has the name of
    the series. The last three panels show the largest error of each run against the number of control points, the wall
    time and the number of velocity evaluations. A line joins runs with the same Time/scheme and Time/tolerance.

    curve: file of the reference curve (required)
    series: series that is compared, and name of its column in the file"""
    expect(curve, "give the reference: --curve FILE")
    rows = tables.read(curve, ("t", series), others=True, nan="NaN if" in runs[0].descriptions.get(series, ""))
    known = dict(zip(rows.columns, rows.values.T))
    runs = sorted(runs, key=lambda run: run.series["n_control_points"][-1])
    families: dict = {}
    errors = []
    for run, shade in zip(runs, style.plt.get_cmap(style.FIELD)(numpy.linspace(0.1, 0.8, len(runs)))):
        inside = (run.time >= known["t"][0]) & (run.time <= known["t"][-1]) & ~numpy.isnan(run.series[series])
        expect(inside.any(), f"{run.directory} has no row within the times of the curve")
        times = run.time[inside]
        errors.append(numpy.array([difference([time], [value], known["t"], known[series])
                                   for time, value in zip(times, run.series[series][inside])]))
        over_time.semilogy(times, numpy.maximum(errors[-1], 1e-12), color=shade, linewidth=1.2, label=run.name)
        points, seconds, evaluations = (run.series[name][-1] for name in COSTS)
        family = f"{run.value('Time/scheme')}, tolerance {run.value('Time/tolerance')}"
        families.setdefault(family, []).append((points, seconds, evaluations, errors[-1].max()))
        log.info(f"{run.name}: {points:.0f} control points, {family}: largest error {errors[-1].max():.2e}, "
                 f"{evaluations:.0f} evaluations, {seconds:.2f} s")
    least = min(float(numpy.median(one)) for one in errors)
    room = 0.1 * least, 30 * errors[0].max()  # limits that leave space for the legend
    over_time.set(xlabel=time_label(runs), ylabel="error", ylim=room)
    over_time.legend(loc="upper left", ncols=2)
    for (family, rows), color in style.coloured(sorted(families.items())):
        *costs, worst = numpy.transpose(rows)
        for axis, cost, label in zip(over_costs, costs, COSTS.values()):
            axis.loglog(cost, worst, "o-", color=color, ms=4, label=family)
            axis.set(xlabel=label, ylabel=f"largest error of {series}")
        if numpy.ptp(costs[0]) > 0:  # fitted in the mesh size, which is control points to the power -1/2
            log.info(f"{family}: order {-2 * numpy.polyfit(numpy.log(costs[0]), numpy.log(worst), 1)[0]:.2f}")
    n = numpy.array([runs[k].series["n_control_points"][-1] for k in (0, -1)])
    if n[1] > n[0]:  # guide line: an error proportional to the fourth power of the mesh size
        over_costs[0].loglog(n, 0.3 * errors[0].max() * (n / n[0]) ** -2.0, label="fourth order", **style.GUIDE)
    over_costs[0].legend(loc="lower left")


@figure(1, 1, 7, 5)
def step(deck, axis, *, radii: tuple[float, float] = (0.1, 0.05), finer: list[str] | None = None,
         set_: list[str] | None = None, curves: tuple[pathlib.Path, pathlib.Path, pathlib.Path] | None = None,
         between: tuple[float, float] = (-3.9, 4.9)):
    """Extents of a capsule against its position in a channel with a step, for rounded edges and for sharp edges.

    The deck is run with two radii of the edges of the step. The extents for sharp edges are extrapolated from the two
    runs. The effect of a rounded edge is proportional to radius^(2q), because the velocity near a sharp edge of 90
    degrees is proportional to distance^q. The exponent q = 0.544 solves sin(3 pi q/2) = q (Dean & Montagnon, Proc.
    Camb. Phil. Soc. 45, 1949).

    Each setting --finer is applied in two further runs, one per radius. The change that it causes is printed, and is
    added to the extents. The extent along x3 has kinks as a function of the position. Near a kink the error depends on
    the distance between recorded rows: with --set 'Time/maximum step=0.01', three digits are correct.

    radii: radii of the edges, the larger one first
    finer: settings that refine a run, each KEY=VALUE
    set_: other settings of all runs, each KEY=VALUE
    curves: three files of published extents along x1, x2, x3; rows of centroid position x1, extent / (2 x radius)
    between: range of the centroid position that is drawn"""
    (large, small), (begin, end), words, finer = radii, between, set_ or [], finer or []
    expect(0 < small < large,
           f"--radii needs two positive radii, the larger one first, but is given {large:g} and {small:g}")
    expect(begin < end, f"--between needs two centroids that ascend, but is given {begin:g} and {end:g}")
    settings_of(words + finer)
    known = [tables.read(path, ("centroid_x1", "value")).values for path in curves or []]
    within = [curve[(curve[:, 0] > begin) & (curve[:, 0] < end)].T for curve in known]
    for path, rows in zip(curves or [], within):
        expect(rows.size, f"{path} has no row between {begin:g} and {end:g}")
    x, runs, deck = numpy.linspace(begin, end, SAMPLES), Study(directory="results/step"), deck_at(deck)
    of_large, of_small = (of_radius(runs, deck, words, finer, radius, x) for radius in radii)
    sharp = sharp_edges(of_large, of_small, large / small)
    for name, colour, dots, dashes, line in zip(style.AXES, style.RUNS, of_large, of_small, sharp):
        axis.plot(x, dots, ":", x, dashes, "--", color=colour)
        axis.plot(x, line, color=colour, label=f"along {name}")
        off = numpy.abs(line - dashes)
        log.info(f"along {name}: radii {large:g} and {small:g} differ by {numpy.abs(dots - dashes).max():.1e}, "
                 f"sharp edges from {small:g} by {off.max():.1e} at most, at {x[off.argmax()]:.2f}")
    for curve, (centroid, extent), name, mark, line in zip(known, within, style.AXES, style.MARKS, sharp):
        off = numpy.interp(centroid, x, line) - extent
        at = numpy.argmax(numpy.abs(off))
        axis.plot(*curve.T, mark, color=style.FAINT, markersize=3, label=f"published, {name}")
        log.info(f"along {name}: {off[at]:+.4f} off the curve at most, at {centroid[at]:.3f}; "
                 f"{numpy.sqrt(numpy.mean(off**2)):.4f} on average")
    style.finish(axis, xlabel="centroid $x_1$", ylabel="extent / (2 × radius)",
                 title=f"sharp edges (lines), edges of radius {small:g} (dashed) and {large:g} (dotted)")


def power():
    """Returns the exponent 2 q with which the effect of a rounded edge grows with its radius (see `step`)."""
    return 2 * scipy.optimize.brentq(lambda q: numpy.sin(1.5 * numpy.pi * q) - q, 0.5, 0.6, xtol=1e-15)


def sharp_edges(of_large, of_small, ratio):
    """Returns the extents of a particle next to sharp edges, extrapolated from its extents with edges of a large and a
    small radius. `ratio`: large radius divided by small radius."""
    return of_small - (of_large - of_small) / (ratio**power() - 1)


def extents(outcome, x):
    """Returns the extents (3, x.size) along the axes, divided by 2 a, when the centroid is at x1 = x. They are
    interpolated by cubic splines."""
    expect(outcome.done, f"{outcome.directory}: {outcome.message}")
    series, way = outcome.series, outcome.series["centroid_x1"]
    expect((numpy.diff(way) > 0).all(),
           f"{outcome.directory}: its centroid went back, so that there are several extents at a place")
    expect(way[0] <= x[0] and x[-1] <= way[-1],
           f"{outcome.directory}: --between {x[0]:g} {x[-1]:g}, but it went from {way[0]:g} to {way[-1]:g}")
    lengths = [series[f"length_x{k}"] for k in (1, 2, 3)]
    return scipy.interpolate.CubicSpline(way, lengths, axis=1)(x) / (2 * outcome.run.value("Particle/radius", 1.0))


def of_radius(runs, deck, words, finer, radius, x):
    """Returns the extents (3, x.size) for one radius of the edges, plus the change that each setting of --finer causes
    when it is applied separately."""
    settings = {"Channel/corner radius": radius} | settings_of(words)
    first = found = extents(runs.run(deck, settings), x)
    for one in finer:
        change = extents(runs.run(deck, settings | settings_of([one])), x) - first
        log.info(f"radius {radius:g}, {one}: changes " + ", ".join(f"{value:.1e}" for value in abs(change).max(axis=1)))
        found = found + change
    return found
