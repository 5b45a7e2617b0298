"""Report of a fit as text and as a figure, and the information that further experiments would add."""

import copy
import itertools

import numpy
import scipy.optimize
import scipy.special
import scipy.stats

from ..figures import style
from .fit_data import OutlineData
from .fit_model import Fit, determined


UNLIKELY = 0.01  # a share of signs with a smaller probability is not explained by random errors


def further(fits, settings):
    """Returns for each possible further experiment (name, {unknown: standard error if the experiment is added}, {other
    law: expected increase of its chi square}). The experiment has data of the same kind and error as the first
    experiment, with the values that the best law predicts. `settings`: {key: values}, one experiment per value. Of a
    curve against this key, it has one row."""
    rows = []
    for key, value in ((key, value) for key, values in settings.items() for value in values if fits):
        best, first = fits[0], fits[0].experiments[0]
        candidate = first.another(key, value)
        (truth,) = best.runs.all([(candidate, best.settings_of(candidate, best.x))])
        if truth is None:
            rows.append((f"{key} {value}", {}, {}))
            continue
        for one, prediction in zip(candidate.data, truth):
            one.error = one.error if one.error is not None else best.scatter
            if isinstance(one, OutlineData):
                one.points, one.scale, one.error = prediction.even(one.count), 1.0, one.error * one.scale
            else:
                one.values = one.predicted(prediction, one.start(prediction))
        alone, *others = (_alone(fit, candidate) for fit in fits)
        alone.errors()
        both = numpy.zeros((len(best.unknowns),) * 2)
        both[numpy.ix_(best.told, best.told)] += best.information() / (1 if best.stated else best.scatter ** 2)
        index = numpy.array(alone.index)[alone.told]
        both[numpy.ix_(index, index)] += alone.information()
        size = numpy.sqrt(numpy.diag(both))
        size = numpy.where(size > 0, size, 1)
        known, axes = numpy.linalg.eigh(both / numpy.outer(size, size))
        # directions without information have a large error, which is that of all unknowns in them
        errors = numpy.sqrt((axes**2 / known.clip(1e-12)).sum(1)) / size
        errors = determined(best.unknowns, best.x, errors)
        rows.append((f"{key} {value}", {unknown.name: unknown.error_of(unknown.value(x), error)
                                        for unknown, x, error in zip(best.unknowns, best.x, errors)},
                     {fit.law: one.square if one else numpy.inf for fit, one in zip(fits[1:], others)}))
    return rows


def _alone(fit, candidate):
    """Returns a fit of the experiment `candidate` only. Its unknowns keep their values from `fit`; only positions are
    fitted. Returns None if the run of the candidate failed."""
    index = [k for k, unknown in enumerate(fit.unknowns) if unknown.owner in (None, candidate.name)]
    unknowns = [copy.copy(fit.unknowns[k]) for k in index]
    for unknown in unknowns:
        unknown.known = None  # a value known beforehand is already included in `fit`
    one, numbers = Fit(fit.law, fit.settings, unknowns, [candidate], fit.runs), fit.x[index]
    (found,) = one.predictions(numbers)
    if found is None:
        return None
    places = numpy.concatenate([datum.start(prediction) for datum, prediction in zip(candidate.data, found)])
    if len(places):
        places = scipy.optimize.least_squares(lambda p: one.residuals(found, numpy.append(numbers, p)), places).x
    one.x, one.index = numpy.append(numbers, places), index
    residual = one.residuals(found, one.x)
    one.square = float(residual @ residual)
    return one


def stated(value, error):
    """Returns a value and its error as text. The error has two digits, and the value is rounded accordingly."""
    powers = [int(f"{abs(one):.1e}".partition("e")[2]) for one in (value or error, error)]
    texts = f"{value:#.{numpy.clip(powers[0] - powers[1] + 2, 1, 12)}g}", f"{error:#.2g}"
    return " ± ".join(text.rstrip(".") for text in texts)


def failed(fit):
    """Returns {experiment: {directory of a run: message}} of the runs that failed or gave no outline or no value."""
    found = {}
    for one in fit.runs.failures.values():
        found.setdefault(one.experiment, {})[one.directory] = one.message
    return found


def signs(fit):
    """Returns the lines of the report about the signs of the residuals: along each outline or curve, and their
    share."""
    lines, z, share = [], fit.runs_test(), fit.signs()
    if numpy.isfinite(z):
        meaning = "change as by chance" if z > -2 else "stay the same too long: the model is not the data’s"
        lines.append(f"  signs of the residuals along the data: {meaning} ({z:.1f} standard deviations)")
    if share:
        plus, count, name, probability = share
        side = "below" if 2 * plus > count else "above"
        meaning = ("as by chance" if probability > UNLIKELY else f"the model is {side} the data, which random errors "
                   "do not explain: the data have an offset, or the model is not theirs")
        lines.append(f"  signs of the residuals: {plus} of {count} positive in {name} (binomial test, probability "
                     f"{probability:.2g}): {meaning}")
    return lines


def told(fits, rows):
    """Returns the report as text."""
    lines = []
    for fit in fits:
        probability = f" (probability {fit.probability:.2g})" if fit.stated else ""
        lines.append(f"{fit.law}: chi square {fit.square:.4g} for {fit.freedom} degrees of freedom{probability}, "
                     f"AIC {fit.aic:.2f}, {fit.runs.count} runs")
        if not fit.stated:
            lines.append("  no errors of the data are given: they are taken from the residuals, which then say nothing "
                         "about the law")
        elif len(fit.data) > 1:
            lines.append("  of it: " + ", ".join(f"{datum.name} {(fit.residual[own] ** 2).sum():.3g} of {datum.length}"
                                                 for datum, own in zip(fit.data, fit.rows)))
        if fit.missed and not fit.edge:
            lines.append(f"  the residuals are {fit.scatter:.3g} times what the errors of the data say: a finer "
                         "mesh, a free scale or another law first")
        for name, runs in failed(fit).items():
            lines.append(f"  {len(runs)} run{'s' * (len(runs) > 1)} of {name} failed or gave no outline or no value; "
                         f"the first one, {next(iter(runs))}: {next(iter(runs.values()))}")
        if fit.edge:
            ends = (f"{one.name} = {one.value(x):.3g}{fit.runs.unit(one.key).replace(',', '', 1)}"
                    for one, x in zip(fit.unknowns, fit.x))
            of = ", ".join(dict.fromkeys(one.experiment for one in fit.edge))
            lines.append(f"  no value, because the fit ended at an edge beyond which runs of {of} fail, at "
                         f"{', '.join(ends)}: mend these runs, leave out the experiment, or give other start values")
        for unknown, bound, (name, (value, error)) in zip(fit.unknowns, fit.at_bound, fit.values.items()):
            if fit.edge:
                break
            unit = fit.runs.unit(unknown.key).replace(",", "", 1)
            if numpy.isfinite(error):
                also = f"; by the residuals ± {fit.scatter * error:.2g}" if fit.missed else ""
                share = 100 * error / abs(value or numpy.nan)
                lines.append(f"  {name} = {stated(value, error)}{unit} ({share:.2g}%{also})")
            else:
                lines.append(f"  {name}: not determined by these data (they are as well met by values far from "
                             f"{value:.3g}{unit})")
            if bound:
                better = "smaller" if bound == "from" else "larger"
                lines.append(f"  {name} lies at its bound `{bound}`: a {better} value would fit the data better, and "
                             "the standard errors ignore the bound")
        size = numpy.sqrt(numpy.diag(fit.covariance))
        correlation = fit.covariance / numpy.outer(size, size)
        shown = enumerate(itertools.compress(fit.unknowns, [] if fit.edge else fit.told))
        for (i, one), (j, other) in itertools.combinations(shown, 2):
            lines.append(f"  correlation of {one.name} and {other.name}: {correlation[i, j]:.3f}")
        # residuals far below the errors of the data, such as round-off, say nothing about the model
        if not fit.edge and (not fit.stated or abs(fit.residual).max() > 1e-2):
            lines += signs(fit)
    ended = [fit for fit in fits if fit.edge]
    fits = [fit for fit in fits if not fit.edge]
    if len(fits) > 1:
        gaps = numpy.array([fit.aic for fit in fits]) - fits[0].aic
        weights = scipy.special.softmax(-gaps / 2)
        lines.append("laws, best first: " + ", ".join(f"{fit.law} (AIC + {gap:.1f}, weight {weight:.2g})"
                                                      for fit, gap, weight in zip(fits, gaps, weights)))
        told_apart = (f"tell {fits[0].law} from the others" if gaps[1] > 10 else
                      "do not tell these laws apart (a difference in AIC below 10)")
        lines.append(f"the data {told_apart}{', but none of them describes the data' if fits[0].missed else ''}")
    if fits and ended:
        lines.append(f"not compared, because they ended at an edge: {', '.join(fit.law for fit in ended)}")
    for name, errors, rises in rows:
        said = [f"± {error:.2g} of {key}" if numpy.isfinite(error) else f"{key} not determined"
                for key, error in errors.items()] + [f"chi square of {law} + {rise:.3g}" for law, rise in rises.items()]
        lines.append(f"a further experiment, {name}: {', '.join(said) or 'its run fails'}")
    return "\n".join(lines)


def draw(fits, axes=None):
    """Returns a figure of the data with the fit, the residuals, and the ellipses of pairs of unknowns."""
    best = fits[0]
    (predictions,) = best.predictions(best.x)
    curves = [datum for datum in best.data if numpy.size(getattr(datum, "along", None)) > 1]
    over_time = any(not datum.against for datum in curves)
    known = list(itertools.compress(zip(best.unknowns, best.x), [] if best.edge else best.told))
    pairs = list(itertools.combinations(range(len(known)), 2))[:3]
    figure, axes = style.panels(axes, 1, 2 + len(pairs), 4.6 * (2 + len(pairs)), 4.4)
    data, residual = axes[:2]
    for (datum, prediction, own, rows), color in style.coloured(zip(best.data, predictions, best.positions, best.rows)):
        place = best.x[own]
        if isinstance(datum, OutlineData):
            data.plot(*numpy.vstack([prediction.even(400), prediction.even(1)]).T, color=color, linewidth=1)
            data.plot(*datum.placed(place).T, ".", color=color, ms=2.5, label=datum.name)
            data.set_aspect("equal")
        elif datum in curves:
            line = copy.copy(datum)
            line.along = numpy.linspace(datum.along.min(), datum.along.max(), 200)
            data.plot(line.along, line.predicted(prediction, place), color=color, linewidth=1)
            data.errorbar(datum.along, datum.values, datum.error, fmt=".", color=color, ms=4, label=datum.name)
        elif over_time or not curves:  # a single value has no place on the axis of a key
            name = datum.name.removesuffix(": data")
            if over_time:
                name = prediction[0][-1] if datum.at is None else datum.at
            data.errorbar(name, datum.values[0], datum.error or 0, fmt=".", color=color, ms=7)
            data.plot(name, datum.predicted(prediction, [])[0], "_", color=color, ms=14)
        residual.plot(numpy.arange(rows.start, rows.start + datum.count), best.residual[rows][:datum.count], ".",
                      ms=2.5 if datum.count > 1 else 7, color=color)
    if data.get_legend_handles_labels()[0]:
        data.legend(fontsize=7)
    series = [datum for datum in best.data if not isinstance(datum, OutlineData)]
    if curves:
        data.set_xlabel(" or ".join(dict.fromkeys(datum.axis(best.runs) for datum in curves)))
    elif series:
        data.tick_params(axis="x", rotation=60, labelsize=7)
    ylabel = " or ".join(dict.fromkeys(" / ".join(datum.series) for datum in series))
    data.set(ylabel=ylabel, title=f"data and {best.law}")
    residual.set(title="residuals / standard errors" if best.stated else "residuals", xlabel="number of the datum")
    residual.axhline(0, color=style.FAINT, linewidth=0.8)
    residual.xaxis.get_major_locator().set_params(integer=True)
    for axis, (i, j) in zip(axes[2:], pairs):
        angle = numpy.linspace(0, 2 * numpy.pi, 200)
        values, vectors = numpy.linalg.eigh(best.covariance[numpy.ix_([i, j], [i, j])])
        pair = known[i], known[j]
        for share, line in (0.683, "-"), (0.954, "--"):
            size = numpy.sqrt(scipy.stats.chi2.ppf(share, 2) * values)
            circle = (vectors * size) @ [numpy.cos(angle), numpy.sin(angle)]
            x, y = ([unknown.value(at + one) for one in row] for (unknown, at), row in zip(pair, circle))
            axis.plot(x, y, line, color=style.RUNS[0], label=f"{share:.1%}")
        axis.plot(*(unknown.value(at) for unknown, at in pair), "+", color=style.INK)
        axis.set(**{word: one.name + best.runs.unit(one.key) for word, (one, _) in zip(("xlabel", "ylabel"), pair)})
        axis.legend()
    return figure
