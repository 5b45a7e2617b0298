#!/usr/bin/python3
"""From an experiment to moduli with error bars: unknown keys of a deck by weighted least squares from outlines, lengths, velocities or curves.

    postproc/fit.py inputs/studies/experiment.yaml                  # results/experiment/fit.txt, fit.yaml, fit.png
    postproc/fit.py inputs/studies/experiment.yaml --samples 100    # and whether the stated errors are right, from synthetic noise

An experiment is a YAML file: `deck` (one, or several laid over each other), `set` (keys of all runs), `unknown`, `laws` and `experiments`;
inputs/studies/experiment.yaml is an example.
    unknown: {Membrane/shear modulus: {start: 1}}        # from, to: bounds; known, error: a value known beforehand; spacing: linear for what may be negative
    laws: {skalak: {Membrane/law: Skalak, unknown: {…}}} # each is fitted, and compared with the others; what is unknown here is its own, or starts elsewhere
    experiments: {slow: {set: {…}, unknown: {…}, data: [datum, …]}}    # each is a run; what is unknown here is its own
           # values may have units where the deck has the list Units; start, from, to, known and what is found are numbers in the deck's units
    datum: {outline: points.csv, error: 0.5, scale: 0.01}   # the edge as seen along x2, columns x1, x3 in the picture's unit, its error in that unit
           # (or a third column, as outline.py writes it); the flow goes to the right;
           # plane: [x1, x3]; scale: the deck's length a unit; scale error: its relative error, or free; at: time of the snapshot (default: the last)
    datum: {series: velocity_x1, value: 1.2, error: 0.01}   # a series' last value, or at: time
    datum: {series: taylor_inertia, curve: relaxation.csv}  # columns time, value and, if it is not given by `error`, error
           # over: length_x2 divides by another series; origin: free where the curve's time does not start with the run's
    next: {Flow/mean velocity: [1, 2, 4]}                # settings of a further experiment with data like the first one's: which would tell most

The place of an outline in its picture is free. Derivatives are differences of runs, made side by side: one a step for each unknown key and experiment,
none for places and scales. Runs are kept and found again where all their keys are the same, so that a `start` is best left as it was. Errors are
those of the data carried on, of nothing else: what is known with an error belongs under `unknown`, Flow/viscosity: {known: 0.97, error: 0.01} say. Where
chi square is too large for them, errors that the residuals tell are given too; a mesh that is too coarse for the data is the first suspect.
"""

import argparse
import copy
import itertools
import os
import pathlib

import needs  # before what it looks for
import numpy
import scipy.optimize
import scipy.stats
import yaml

import literature
import silhouette
import tanktread
from sweep import Mistake, answer, decks_of, expect, keys_of, number, tell, yaml_of

KEYS = {"deck", "set", "unknown", "laws", "experiments", "next", "limit"}
STEP = 0.01     # of a logarithm, for derivatives on the way
TELLS = 0.02    # and for those that errors come from, to both sides
FAILED = 1e6    # a residual where a run failed
FAR = numpy.log(1000)  # from its start, where the user sets no bounds to an unknown; of a linear one in parts of its start
MISSED = 1e-3   # probability of a larger chi square, below which the errors of the data do not hold
SETTLED = 1e-2  # of chi square a degree of freedom, which a last step takes off: it is a tenth of the standard errors long
FAINT = 1e-4    # what does not change chi by more, times e, is left where it is
SERIES = 8      # points of a datum along which the signs of residuals tell something
GAP = 0.1       # of an outline's length, from its last point to the first, at which it does not close


def numbers_of(path, least):
    """A CSV file with `least` columns or more, below a row of names or none."""
    try:
        values = numpy.genfromtxt(path, delimiter=",", comments="#")
    except (OSError, ValueError) as error:
        raise Mistake(f"{path} cannot be read: {error}") from None
    values = values[1:] if values.ndim == 2 and not numpy.isfinite(values[0]).any() else values
    expect(values.ndim == 2 and values.shape[1] >= least and numpy.isfinite(values[:, :least]).all(), f"{path} must have {least} columns of numbers")
    return values


class Settled(Exception):
    """A fit has come to numbers, which go with this, that a further step would not change by what the data tell."""


class Unknown:
    """A key whose value is sought, as the number that the fit varies: the logarithm of what is positive."""

    def __init__(self, key, given, owner=None):
        given = given if isinstance(given, dict) else {"start": given}
        self.key, self.owner, self.name = key, owner, key if owner is None else f"{owner}: {key}"
        expect(isinstance(given.get("start", given.get("known")), (int, float)), f"{self.name} needs a number to start from")
        expect(("known" in given) == ("error" in given), f"{self.name}: `known` and `error` go together")
        self.start_value = float(given.get("start", given.get("known")))
        self.logarithmic = given.get("spacing") != "linear"
        expect(not self.logarithmic or self.start_value > 0, f"{self.name} starts from a positive number, or has `spacing: linear`")
        self.unit = 1.0 if self.logarithmic else abs(self.start_value) or 1.0
        start = self.number(self.start_value)
        for word in {"known", "error", "from", "to"} & set(given):
            number(given[word], f"{self.name}: {word}")
        self.bounds = tuple(self.number(given[word]) if word in given else start + far for word, far in (("from", -FAR), ("to", FAR)))
        self.known, self.error = given.get("known"), given.get("error")

    def number(self, value):
        return numpy.log(value) if self.logarithmic else value / self.unit

    def value(self, number):
        return float(numpy.exp(number) if self.logarithmic else number * self.unit)

    def error_of(self, value, error):
        """The standard error of the value from that of the number."""
        return value * error if self.logarithmic else self.unit * error


class OutlineData:
    """Points of an edge in a plane. Unknown with it: where it lies, and its scale where that has an error."""

    def __init__(self, given, name, folder):
        known = {"outline", "plane", "error", "scale", "scale error", "at", "open"}
        expect(set(given) <= known, f"{name}: an outline has {', '.join(sorted(known))}")
        expect(isinstance(given.get("scale"), (int, float)), f"{name} has no scale: the deck's length for a unit of its picture (1 if they are the same)")
        self.name, self.at, self.scale, self.error = name, given.get("at"), float(given["scale"]), given.get("error")
        plane = given.get("plane", ["x1", "x3"])
        expect(len(set(plane)) == 2 and set(plane) <= {"x1", "x2", "x3"}, f"{name}: the plane is two of x1, x2, x3")
        self.axis = 6 - sum(int(one[1]) for one in plane) - 1
        table = numbers_of(folder / str(given["outline"]), 2)
        self.points = table[:, :2][:, numpy.argsort(plane)]
        if self.error is None and table.shape[1] > 2:
            self.error = float(numpy.sqrt((table[:, 2] ** 2).mean()))
        steps = numpy.linalg.norm(self.points - numpy.roll(self.points, 1, axis=0), axis=1)
        expect(given.get("open") or steps[0] <= max(GAP * steps.sum(), 3 * numpy.median(steps)),
               f"{name}: the outline does not close: its last point is {steps[0] / steps.sum():.0%} of its length from the first (`open: true` takes it as it is)")
        self.free_scale, self.scale_error = given.get("scale error") == "free", given.get("scale error", 0)
        self.places = 2 + bool(self.scale_error)  # of the numbers that say where it lies
        self.count = len(self.points)

    @property
    def length(self):
        """Of its residuals: those of the points, and that of a scale with an error."""
        return self.count + (self.places > 2 and not self.free_scale)

    def start(self, prediction):
        """Its place, from the middles of both."""
        low, high = self.points.min(0), self.points.max(0)
        middle = (prediction.points.min(0) + prediction.points.max(0)) / 2
        return numpy.concatenate([middle - self.scale * (low + high) / 2, numpy.zeros(self.places - 2)])

    def prediction(self, run):
        shot = run.snapshot_at(self.at)
        expect(self.at is None or abs(shot.time - self.at) < 1e-6 * max(1, abs(self.at)), f"{self.name}: there is no snapshot at {self.at}: set Output/interval")
        return silhouette.seen(shot, self.axis).centred()  # where a run carries its particle is not in the picture

    def placed(self, place):
        return self.points * self.scale * numpy.exp(place[2] if self.places > 2 else 0) + place[:2]

    def residuals(self, prediction, place):
        found = prediction.distances(self.placed(place)) / self.scale / (self.error or 1)
        return numpy.append(found, place[2] / self.scale_error) if self.places > 2 and not self.free_scale else found


class SeriesData:
    """Values of a series, or of its ratio to another one, at times. Unknown with it: when a curve begins, where its origin is free."""

    length = property(lambda self: self.count)  # of its residuals

    def __init__(self, given, name, folder):
        known = {"series", "over", "value", "curve", "error", "at", "origin"}
        expect(set(given) <= known and ("value" in given) != ("curve" in given), f"{name}: a series has value or curve, and error, at, over, origin")
        for word in {"value", "error"} & set(given):
            number(given[word], f"{name}: {word}")
        self.name, self.series, self.error = name, [given["series"], *([given["over"]] if "over" in given else [])], given.get("error")
        self.places = int("origin" in given)
        expect(not self.places or given["origin"] == "free" and "curve" in given, f"{name}: `origin: free` is of a curve, and there is no other origin")
        if "curve" in given:
            table = numbers_of(folder / str(given["curve"]), 2)
            self.times, self.values = table[:, 0], table[:, 1]
            self.error = table[:, 2] if self.error is None and table.shape[1] > 2 else self.error
            self.span = float(numpy.ptp(self.times))  # which the place is told in
        else:
            self.times, self.values = given.get("at"), numpy.array([float(given["value"])])
        self.count = len(self.values)

    def start(self, prediction):
        """The time of a run at which the curve begins: the last one at which the run is as near as it comes to the first value."""
        if not self.places:
            return numpy.array([])
        times, values = prediction
        passed = numpy.flatnonzero((values[1:] - self.values[0]) * (values[:-1] - self.values[0]) <= 0)
        nearest = passed[-1] if len(passed) else numpy.argmin(abs(values - self.values[0]))
        return (times[[nearest]] - self.times[0]) / self.span

    def prediction(self, run):
        for name in self.series:
            expect(name in run.series, f"{self.name}: there is no series {name}; there are: {', '.join(sorted(run.series))}")
        values, times = run.series[self.series[0]], run.series["time"]
        last = 0 if self.times is None or self.places else numpy.max(self.times)
        expect(last <= times[-1] * (1 + 1e-9), f"{self.name}: the run ends at {times[-1]:g}, before its data: set Time/final time")
        values = values / run.series[self.series[1]] if len(self.series) > 1 else values
        defined = ~numpy.isnan(values)
        expect(defined[-1] if self.times is None else defined.any(), f"{self.name}: {' / '.join(self.series)} is undefined (NaN) in the run")
        return times[defined], values[defined]

    def predicted(self, prediction, place):
        """What the run has at the data's times."""
        times, values = prediction
        if self.times is None:
            return values[-1:]
        wanted = numpy.atleast_1d(self.times) + (place[0] * self.span if self.places else 0)
        return literature.interpolated(times, values, numpy.clip(wanted, times[0], times[-1]))

    def residuals(self, prediction, place):
        return (self.values - self.predicted(prediction, place)) / (1 if self.error is None else self.error)


class Experiment:
    def __init__(self, name, given, folder):
        expect(isinstance(given, dict) and given.get("data"), f"the experiment {name} has no data")
        expect(set(given) <= {"set", "unknown", "data"}, f"the experiment {name} has set, unknown and data")
        self.name, self.settings = name, keys_of(given.get("set"), f"{name}: set")
        self.unknowns = [Unknown(key, one, name) for key, one in keys_of(given.get("unknown"), f"{name}: unknown").items()]
        kinds = {"outline": OutlineData, "series": SeriesData}
        self.data = []
        expect(isinstance(given["data"], list), f"{name}: data must be a list of outlines and series")
        for k, one in enumerate(given["data"]):
            one = keys_of(one, f"{name}: a datum")
            kind = next((kind for word, kind in kinds.items() if word in one), None)
            expect(kind, f"{name}: a datum is an outline or a series")
            self.data.append(kind(one, f"{name}: {one.get('outline') or one['series']}" if k or len(given["data"]) > 1 else f"{name}: data", folder))


class Runs:
    """What runs of the program predict. `settings` of an experiment's run to predictions of its data, or None where it failed."""

    def __init__(self, study, decks, law):
        self.law, self.study, self.decks, self._found, self.messages, self._run = law, study, decks, {}, [], None

    count = property(lambda self: len(self._found))

    def all(self, jobs):
        """Predictions of many (experiment, settings)."""
        texts = [experiment.name + str(sorted(settings.items())) for experiment, settings in jobs]
        new = {text: job for text, job in zip(texts, jobs) if text not in self._found}
        outcomes = self.study.all([(self.decks, settings) for _, settings in new.values()])
        if new:
            tell(f"{self.law}: {self.count + len(new)} runs made or found")
        for (text, (experiment, _)), outcome in zip(new.items(), outcomes):
            if outcome.refused:
                raise Mistake(f"the deck is refused: {outcome.message}")
            self.messages += [] if outcome.done else [outcome.message]
            self._found[text] = self._predicted(experiment, outcome) if outcome.done else None
        return [self._found[text] for text in texts]

    def unit(self, key):
        """Of a key, where the deck has units: ", pN/µm"."""
        return self._run.in_units(self.study.dimension(key)) if self._run else ""

    def _predicted(self, experiment, outcome):
        try:
            self._run = outcome.run
            return [datum.prediction(outcome.run) for datum in experiment.data]
        except ValueError as error:  # a shape without an outline is as far from the data as a run that failed
            self.messages.append(str(error))
            return None


class Fit:
    """One law: what is unknown, its best values and their errors. The numbers that are varied are those of the unknowns, then of the outlines' places."""

    def __init__(self, law, settings, unknowns, experiments, runs):
        self.law, self.settings, self.experiments, self.runs = law, settings, experiments, runs
        self.unknowns = [*unknowns, *(one for experiment in experiments for one in experiment.unknowns)]
        self.data = [datum for experiment in experiments for datum in experiment.data]
        self.count = sum(datum.count for datum in self.data)
        self.stated = all(datum.error is not None for datum in self.data)

    def jobs(self, numbers):
        """(experiment, settings) of all runs at these numbers of the unknowns."""
        found = []
        for experiment in self.experiments:
            values = {one.key: one.value(x) for one, x in zip(self.unknowns, numbers) if one.owner in (None, experiment.name)}
            found.append((experiment, self.settings | experiment.settings | values))
        return found

    def predictions(self, numbers):
        """Of all data, or None."""
        return self.flat(self.runs.all(self.jobs(numbers)))

    @staticmethod
    def flat(found):
        return None if any(one is None for one in found) else list(itertools.chain.from_iterable(found))

    def residuals(self, predictions, numbers, places):
        """Weighted, of all data and of what is known beforehand."""
        if predictions is None:
            return numpy.full(self.length(), FAILED)
        parts, start = [], 0
        for datum, prediction in zip(self.data, predictions):
            parts.append(datum.residuals(prediction, places[start:start + datum.places]))
            start += datum.places
        known = [(one.value(x) - one.known) / one.error for one, x in zip(self.unknowns, numbers) if one.known is not None]
        return numpy.concatenate([*parts, known])

    def length(self):
        return sum(datum.length for datum in self.data) + sum(one.known is not None for one in self.unknowns)

    def split(self, x):
        return x[:len(self.unknowns)], x[len(self.unknowns):]

    def jacobian(self, x, step, sides=(1,)):
        """Differences: columns of the unknowns by runs (a matrix a side), and of the places."""
        numbers, places = self.split(x)
        shifted = [numbers + side * step * unit for side in sides for unit in numpy.eye(len(numbers))]
        jobs = [self.jobs(one) for one in [numbers, *shifted]]
        made = self.runs.all([job for one in jobs for job in one])
        n = len(self.experiments)
        found = [self.flat(made[k:k + n]) for k in range(0, len(made), n)]
        base = self.residuals(found[0], numbers, places)
        columns = [(self.residuals(one, at, places) - base) / (side * step) if one is not None else numpy.full(len(base), numpy.nan)
                   for one, at, side in zip(found[1:], shifted, numpy.repeat(sides, len(numbers)))]
        k = len(numbers)
        each = [numpy.array(columns[k * i:k * (i + 1)]).reshape(k, len(base)).T for i in range(len(sides))]
        return each, self.of_places(found[0], places, len(base))

    def of_places(self, predictions, places, rows, tiny=1e-6):
        """Derivatives by the places of outlines, each of which moves its own residuals only: shape (rows, places)."""
        derivative, row, column = numpy.zeros((rows, len(places))), 0, 0
        for datum, prediction in zip(self.data, predictions):
            own = places[column:column + datum.places]
            base = datum.residuals(prediction, own)
            for k in range(datum.places):
                shifted = datum.residuals(prediction, own + tiny * (numpy.arange(datum.places) == k))
                derivative[row:row + len(base), column + k] = (shifted - base) / tiny
            row, column = row + len(base), column + datum.places
        return derivative

    def begin(self):
        """Numbers to start from, at which all runs come to their end: where they do not at the user's, one of the unknowns times 3, 1/3, 10 or 1/10."""
        start = numpy.array([one.number(one.start_value) for one in self.unknowns])
        tries = [start] + [start + shift * unit * numpy.array([one.logarithmic for one in self.unknowns])
                           for shift in numpy.log([3, 1 / 3, 10, 1 / 10]) for unit in numpy.eye(len(start))]
        for numbers in tries:
            predictions = self.predictions(numbers)
            if predictions is not None:
                return numpy.concatenate([numbers, *(datum.start(one) for datum, one in zip(self.data, predictions))])
        raise Mistake(f"{self.law}: all runs fail at the start and around it; the first one: {self.runs.messages[0]}")

    def effort(self):
        """How many runs it takes, in words."""
        moved = sum(one.owner in (None, experiment.name) for one in self.unknowns for experiment in self.experiments)
        n = len(self.experiments)
        return f"{self.law}: {n} runs to start with, then some {moved + n} a step, for 3 to 10 steps as a rule"

    def solve(self, start=None):
        x = self.begin() if start is None else start
        places = len(x) - len(self.unknowns)
        free = len(x) - (self.length() - self.count)  # less what is known beforehand
        expect(free < self.count, f"{self.law}: {free} numbers are unknown, places of outlines among them, and there are {self.count} data")
        bounds = numpy.array([one.bounds for one in self.unknowns] + [(-numpy.inf, numpy.inf)] * places).T

        def function(x):
            numbers, places = self.split(x)
            return self.residuals(self.predictions(numbers), numbers, places)

        def derivative(x):
            (columns,), of_places = self.jacobian(x, STEP)
            columns = numpy.nan_to_num(columns)
            full = numpy.column_stack([columns * (numpy.linalg.norm(columns, axis=0) > FAINT), of_places])
            residual = function(x)
            step = numpy.linalg.lstsq(full, -residual, rcond=None)[0]
            if numpy.square(full @ step).sum() < SETTLED * (residual @ residual) / max(1, len(residual) - len(x)):
                raise Settled(numpy.clip(x + step, *bounds))
            return full

        try:
            self.x = scipy.optimize.least_squares(function, x, derivative, bounds, x_scale="jac", xtol=1e-7, ftol=1e-5, gtol=1e-15, max_nfev=40).x
        except Settled as settled:
            self.x = settled.args[0]
        self.residual = function(self.x)
        self.square = float(self.residual @ self.residual)
        self.errors()
        return self

    def errors(self):
        """Covariance of the unknowns' numbers, places taken into account; `told`: which of them the data determine at all."""
        (up, down), of_places = self.jacobian(self.x, TELLS, (1, -1))
        up, down = (numpy.where(numpy.isfinite(one), one, other) for one, other in ((up, down), (down, up)))
        self.derivative, disagreement = (up + down) / 2, numpy.linalg.norm(up - down, axis=0) / 2
        strength = numpy.linalg.norm(self.derivative, axis=0)
        self.told = numpy.isfinite(strength) & (strength > 2 * disagreement) & (strength > 0)
        self.moved = of_places
        full = numpy.column_stack([self.derivative[:, self.told], of_places])
        scale = numpy.linalg.norm(full, axis=0)
        _, sizes, right = numpy.linalg.svd(full / scale)
        k = self.told.sum()
        with numpy.errstate(divide="ignore"):
            spread = right.T / sizes
        covariance = (spread @ spread.T / numpy.outer(scale, scale))[:k, :k]
        self.freedom = self.length() - full.shape[1]
        self.covariance = covariance * (1 if self.stated else self.square / self.freedom)
        errors = numpy.full(len(self.unknowns), numpy.inf)
        errors[self.told] = numpy.sqrt(numpy.diag(self.covariance))
        self.number_errors = errors
        self.determined = errors < 1  # a factor of e, or of a linear one its own start
        self.probability = float(scipy.stats.chi2.sf(self.square, self.freedom))

    @property
    def values(self):
        """{name: (value, standard error or inf)}"""
        found = {}
        for one, x, error, known in zip(self.unknowns, self.x, self.number_errors, self.determined):
            value = one.value(x)
            found[one.name] = value, one.error_of(value, error) if known else numpy.inf
        return found

    @property
    def squares(self):
        """{datum's name: (chi square, points)}"""
        found, start = {}, 0
        for datum in self.data:
            found[datum.name] = float((self.residual[start:start + datum.length] ** 2).sum()), datum.length
            start += datum.length
        return found

    @property
    def missed(self):
        """Whether the data's errors do not explain the residuals."""
        return self.stated and self.probability < MISSED

    @property
    def aic(self):
        parameters = len(self.x)
        return self.square + 2 * parameters if self.stated else self.count * numpy.log(self.square / self.count) + 2 * (parameters + 1)

    def runs_test(self):
        """Wald and Wolfowitz, of the signs along all outlines and curves together: how many deviations fewer runs of one sign than by chance; z."""
        runs = mean = variance = start = 0
        for datum in self.data:
            signs = self.residual[start:start + datum.count] > 0
            start += datum.length
            plus, minus, n = signs.sum(), (~signs).sum(), datum.count
            if n < SERIES or not plus or not minus:
                continue
            runs += 1 + (signs[1:] != signs[:-1]).sum()
            mean += 1 + 2 * plus * minus / n
            variance += 2 * plus * minus * (2 * plus * minus - n) / (n * n * (n - 1))
        return float((runs - mean) / numpy.sqrt(variance)) if variance else 0.0

    def information(self):
        """Of the unknowns' numbers, places taken out."""
        a, b = self.derivative[:, self.told], self.moved
        return a.T @ a - (a.T @ b) @ numpy.linalg.pinv(b.T @ b) @ (b.T @ a) if b.size else a.T @ a


def load(path, study):
    """The fits of all laws, not yet solved, and the file's text."""
    text = yaml_of(path, KEYS)
    folder = pathlib.Path(path).parent
    decks = decks_of(text, path)
    study.limit = number(text["limit"], f"{path}: limit") if text.get("limit") else None
    expect(keys_of(text.get("experiments"), f"{path}: experiments"), f"{path} has no experiments")
    laws = {law: keys_of(settings, f"{path}: the law {law}") for law, settings in keys_of(text.get("laws"), f"{path}: laws").items()}
    lists = [text, *text["experiments"].values(), *laws.values()]
    expect(any(isinstance(one, dict) and one.get("unknown") for one in lists), f"{path}: nothing is unknown")
    unknowns = [Unknown(key, given) for key, given in keys_of(text.get("unknown"), f"{path}: unknown").items()]
    experiments = [Experiment(name, given, folder) for name, given in text["experiments"].items()]
    for key, values in keys_of(text.get("next"), f"{path}: next").items():
        expect(isinstance(values, list) and values, f"{path}: next, {key} must be a list of values, but is {values}")
    fixed, fits = keys_of(text.get("set"), f"{path}: set"), []
    for law, settings in (laws or {"the deck's law": {}}).items():
        settings = fixed | settings
        own = {key: Unknown(key, given) for key, given in keys_of(settings.pop("unknown", None), f"{path}: {law}, unknown").items()}
        fits.append(Fit(law, settings, list(({one.key: one for one in unknowns} | own).values()), experiments, Runs(study, decks, law)))
    return fits, text


def further(fits, settings):
    """What further experiments would tell: (settings, {unknown: error with it}, {other law: expected rise of chi square}). Each has data like the first
    experiment's, on the best law's prediction."""
    best, first = fits[0], fits[0].experiments[0]
    rows = []
    for key, value in [(key, value) for key, values in settings.items() for value in values]:
        candidate = copy.copy(first)
        candidate.settings, candidate.data = first.settings | {key: value}, []
        truth = best.runs.all([(first, best.settings | candidate.settings | dict(_values(best, first)))])[0]
        if truth is None:
            rows.append(({key: value}, None, None))
            continue
        for datum, prediction in zip(first.data, truth):
            one = copy.copy(datum)
            if isinstance(datum, OutlineData):
                one.points, one.scale = prediction.even(datum.count), 1.0
                one.error = (datum.error or _scatter(best)) * datum.scale
            else:
                one.values = datum.predicted(prediction, datum.start(prediction))
                one.error = datum.error if datum.error is not None else _scatter(best)
            candidate.data.append(one)
        rows.append(({key: value}, _errors_with(best, candidate), {other.law: _rise(other, candidate) for other in fits[1:]}))
    return rows


def _scatter(fit):
    return numpy.sqrt(fit.square / fit.freedom)


def _values(fit, experiment):
    return [(one.key, one.value(x)) for one, x in zip(fit.unknowns, fit.x) if one.owner in (None, experiment.name)]


def _alone(fit, candidate):
    """A fit of the candidate only, at the values of `fit`."""
    one = Fit(fit.law, fit.settings, [], [candidate], fit.runs)
    one.index = [k for k, unknown in enumerate(fit.unknowns) if unknown.owner in (None, candidate.name)]
    one.unknowns = [copy.copy(fit.unknowns[k]) for k in one.index]
    for unknown in one.unknowns:
        unknown.known = None  # what is known beforehand counts once
    one.x = fit.x[one.index]
    predictions = one.predictions(one.x)
    if predictions is None:
        return None
    one.x = numpy.concatenate([one.x, *(datum.start(prediction) for datum, prediction in zip(candidate.data, predictions))])
    numbers, places = one.split(one.x)
    if len(places):
        placed = scipy.optimize.least_squares(lambda p: one.residuals(predictions, numbers, p), places)
        one.x = numpy.concatenate([numbers, placed.x])
    one.residual = one.residuals(predictions, *one.split(one.x))
    one.square = float(one.residual @ one.residual)
    return one


def _errors_with(fit, candidate):
    one = _alone(fit, candidate)
    one.errors()
    both = numpy.zeros((len(fit.unknowns),) * 2)
    both[numpy.ix_(fit.told, fit.told)] += fit.information() / (1 if fit.stated else _scatter(fit) ** 2)
    index = numpy.array(one.index)[one.told]
    both[numpy.ix_(index, index)] += one.information()
    errors = numpy.sqrt(numpy.diag(numpy.linalg.pinv(both)))
    errors = numpy.where((errors > 0) & (errors < 1), errors, numpy.inf)  # as in Fit.errors: others stay undetermined
    return {unknown.name: unknown.error_of(unknown.value(x), error) for unknown, x, error in zip(fit.unknowns, fit.x, errors)}


def _rise(fit, candidate):
    one = _alone(fit, candidate)
    return one.square if one else numpy.inf


def rounded(value, error):
    """A value with a digit more than its error tells."""
    return f"{value:.{int(numpy.clip(numpy.ceil(numpy.log10(abs(value) / error)) + 2, 2, 10))}g}" if value and error else f"{value:.6g}"


def told(fits, rows):
    """The report as text."""
    lines = []
    for fit in fits:
        said = f"chi square {fit.square:.4g} for {fit.freedom} degrees of freedom" + (f" (probability {fit.probability:.2g})" if fit.stated else "")
        lines += [f"{fit.law}: {said}, AIC {fit.aic:.2f}, {fit.runs.count} runs"]
        if not fit.stated:
            lines += ["  no errors of the data are given: they are taken from the residuals, which then say nothing about the law"]
        if fit.stated and len(fit.data) > 1:
            lines.append("  of it: " + ", ".join(f"{name} {square:.3g} of {count}" for name, (square, count) in fit.squares.items()))
        larger = numpy.sqrt(fit.square / fit.freedom) if fit.missed else 1
        if fit.missed:
            lines.append(f"  the residuals are {larger:.3g} times what the errors of the data say: a finer mesh, a free scale or another law first")
        for unknown, (name, (value, error)) in zip(fit.unknowns, fit.values.items()):
            unit = fit.runs.unit(unknown.key).replace(",", "", 1)
            if numpy.isfinite(error):
                also = f"; by the residuals ± {larger * error:.2g}" if fit.missed else ""
                lines.append(f"  {name} = {rounded(value, error)} ± {error:.2g}{unit} ({error / abs(value):.2%}{also})")
            else:
                lines.append(f"  {name}: not determined by these data (they are as well met by values far from {value:.3g}{unit})")
        shown = [one.name for one, yes in zip(fit.unknowns, fit.told) if yes]
        if len(shown) > 1:
            size = numpy.sqrt(numpy.diag(fit.covariance))
            correlation = fit.covariance / numpy.outer(size, size)
            lines += [f"  correlation of {a} and {b}: {correlation[i, j]:.3f}" for (i, a), (j, b) in itertools.combinations(enumerate(shown), 2)]
        if any(datum.count >= SERIES for datum in fit.data):
            z = fit.runs_test()
            lines.append(f"  signs of the residuals along the data: {'change as by chance' if z > -2 else 'stay the same too long: the model is not the data’s'} "
                         f"({z:.1f} standard deviations)")
    if len(fits) > 1:
        gap = [fit.aic - fits[0].aic for fit in fits]
        total = sum(numpy.exp(-one / 2) for one in gap)
        lines.append("laws, best first: " + ", ".join(f"{fit.law} (AIC + {one:.1f}, weight {numpy.exp(-one / 2) / total:.2g})" for fit, one in zip(fits, gap)))
        said = f"tell {fits[0].law} from the others" if gap[1] > 10 else "do not tell these laws apart (a difference in AIC below 10)"
        lines.append(f"the data {said}{', but none of them describes the data' if fits[0].missed else ''}")
    for settings, errors, rises in rows:
        name = ", ".join(f"{key} {value}" for key, value in settings.items())
        if errors is None:
            lines.append(f"a further experiment, {name}: its run fails")
            continue
        said = [f"± {error:.2g} of {key}" if numpy.isfinite(error) else f"{key} not determined" for key, error in errors.items()] + [f"chi square of {law} + {rise:.3g}" for law, rise in rises.items()]
        lines.append(f"a further experiment, {name}: " + ", ".join(said))
    return "\n".join(lines)


def draw(fits, path):
    """Outlines, curves and values with the fit, residuals, and the ellipses of pairs of unknowns."""
    import style
    from style import plt

    best = fits[0]
    predictions, places = best.predictions(best.x[:len(best.unknowns)]), best.split(best.x)[1]
    pairs = list(itertools.combinations(range(int(best.told.sum())), 2))[:3]
    figure, axes = plt.subplots(1, 2 + len(pairs), figsize=(4.6 * (2 + len(pairs)), 4.4), squeeze=False)
    data, residual, start, row = axes[0][0], axes[0][1], 0, 0
    for k, (datum, prediction) in enumerate(zip(best.data, predictions)):
        color = style.RUNS[k % len(style.RUNS)]
        if isinstance(datum, OutlineData):
            data.plot(*numpy.vstack([prediction.even(400), prediction.even(1)]).T, color=color, linewidth=1)
            data.plot(*datum.placed(places[start:start + datum.places]).T, ".", color=color, ms=2.5, label=datum.name)
            data.set_aspect("equal")
        elif numpy.size(datum.times) > 1:
            line = numpy.linspace(datum.times.min(), datum.times.max(), 200)
            along = copy.copy(datum)
            along.times = line
            data.plot(line, along.predicted(prediction, places[start:start + datum.places]), color=color, linewidth=1)
            data.errorbar(datum.times, datum.values, datum.error, fmt=".", color=color, ms=4, label=datum.name)
        else:
            data.errorbar(datum.name, datum.values[0], datum.error or 0, fmt=".", color=color, ms=4)
            data.plot(datum.name, datum.predicted(prediction, [])[0], "_", color=color, ms=12)
        start += datum.places
        residual.plot(numpy.arange(row, row + datum.count), best.residual[row:row + datum.count], ".", ms=2.5, color=color)
        row += datum.length
    if data.get_legend_handles_labels()[0]:
        data.legend(fontsize=7)
    curves = [datum for datum in best.data if not isinstance(datum, OutlineData) and numpy.size(datum.times) > 1]
    if curves:
        data.set_xlabel("time" + best.runs.unit("Time/final time"))
        data.set_ylabel(" or ".join(dict.fromkeys(" / ".join(datum.series) for datum in curves)))
    elif not all(isinstance(datum, OutlineData) for datum in best.data):
        data.tick_params(axis="x", rotation=60, labelsize=7)
    data.set_title(f"data and {best.law}")
    residual.set_title("residuals over their errors")
    names = [one for one, yes in zip(best.unknowns, best.told) if yes]
    for axis, (i, j) in zip(axes[0][2:], pairs):
        angle = numpy.linspace(0, 2 * numpy.pi, 200)
        values, vectors = numpy.linalg.eigh(best.covariance[numpy.ix_([i, j], [i, j])])
        for share, line in (0.683, "-"), (0.954, "--"):
            circle = numpy.sqrt(scipy.stats.chi2.ppf(share, 2)) * (vectors * numpy.sqrt(values)) @ [numpy.cos(angle), numpy.sin(angle)]
            index = [best.unknowns.index(names[k]) for k in (i, j)]
            x, y = ([names[k].value(best.x[at] + one) for one in circle[m]] for m, (k, at) in enumerate(zip((i, j), index)))
            axis.plot(x, y, line, color=style.RUNS[0], label=f"{share:.1%}")
        axis.plot(*(names[k].value(best.x[best.unknowns.index(names[k])]) for k in (i, j)), "+", color=style.INK)
        axis.set_xlabel(names[i].name + best.runs.unit(names[i].key))
        axis.set_ylabel(names[j].name + best.runs.unit(names[j].key))
        axis.legend()
    style.save(figure, path)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("experiment", help="the experiment, a YAML file")
    parser.add_argument("--output", type=pathlib.Path, metavar="DIR", help="where results go (default: results/<experiment>)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="runs at a time (default: the number of cores)")
    parser.add_argument("--law", nargs="+", metavar="NAME", help="fit these laws only")
    arguments = parser.parse_args()
    directory = arguments.output or pathlib.Path("results") / pathlib.Path(arguments.experiment).stem
    fits, text = load(arguments.experiment, tanktread.Study(directory=directory / "runs", jobs=arguments.jobs))
    laws = arguments.law or [fit.law for fit in fits]
    expect(set(laws) <= {fit.law for fit in fits}, f"there is no such law; there are: {', '.join(fit.law for fit in fits)}")
    fits = [fit for fit in fits if fit.law in laws]
    for fit in fits:
        tell(fit.effort())
        fit.solve()
    fits.sort(key=lambda fit: fit.aic)
    said = told(fits, further(fits, text.get("next") or {}))
    tell("")
    print(said)
    (directory / "fit.txt").write_text(said + "\n", encoding="utf-8")
    record = {fit.law: {"chi square": fit.square, "degrees of freedom": int(fit.freedom), "AIC": float(fit.aic), "runs": fit.runs.count,
                        "unknown": {name: {"value": value, "error": float(error)} for name, (value, error) in fit.values.items()}} for fit in fits}
    (directory / "fit.yaml").write_text(yaml.safe_dump(record, sort_keys=False), encoding="utf-8")
    draw(fits, directory / "fit.png")
    return 0


if __name__ == "__main__":
    answer(main)
