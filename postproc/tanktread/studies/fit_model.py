"""Weighted least squares from runs of the program: one law, its unknowns and their errors."""

import itertools

import numpy
import scipy.optimize
import scipy.stats

from ..mistakes import Mistake, expect, progress

STEP = 0.01     # of a logarithm, for derivatives on the way
TELLS = 0.02    # and for those that errors follow from, to both sides
FAILED = 1e6    # a residual where a run failed
MISSED = 1e-3   # probability of a larger chi square, below which the errors of the data do not hold
# of chi square per degree of freedom, by which a last step lowers it: a tenth of the standard errors long
SETTLED = 1e-2
FAINT = 1e-4    # an unknown that does not change chi by more, times e, is left where it is
SERIES = 8      # points of a datum along which the signs of residuals have a meaning


class Settled(Exception):
    """A fit has come to numbers, which go with this, that a further step would not change by what the data tell."""


class Runs:
    """What runs of the program predict. `settings` of an experiment's run to predictions of its data, or None where it
    failed."""

    def __init__(self, study, decks, law):
        self.law, self.study, self.decks, self._found, self.messages, self._run = law, study, decks, {}, [], None

    count = property(lambda self: len(self._found))

    def all(self, jobs):
        """Returns the predictions of many (experiment, settings), in their order."""
        texts = [experiment.name + str(sorted(settings.items())) for experiment, settings in jobs]
        new = {text: job for text, job in zip(texts, jobs) if text not in self._found}
        outcomes = self.study.all([(self.decks, settings) for _, settings in new.values()])
        if new:
            progress(f"{self.law}: {self.count + len(new)} runs made or found")
        for (text, (experiment, _)), outcome in zip(new.items(), outcomes):
            if outcome.refused:
                raise Mistake(f"the deck is refused: {outcome.message}")
            self.messages += [] if outcome.done else [outcome.message]
            self._found[text] = self._predicted(experiment, outcome) if outcome.done else None
        return [self._found[text] for text in texts]

    def unit(self, key):
        """Returns the unit of a key if the deck has units: ", pN/µm"; otherwise ""."""
        return self._run.in_units(self.study.dimension(key)) if self._run else ""

    def _predicted(self, experiment, outcome):
        self._run = outcome.run
        try:
            return [datum.prediction(outcome.run) for datum in experiment.data]
        except ValueError as error:  # a shape without an outline is as far from the data as a run that failed
            self.messages.append(str(error))
            return None


class Fit:
    """One law: what is unknown, its best values and their errors. The numbers that are varied are those of the
    unknowns, then of the outlines' places."""

    def __init__(self, law, settings, unknowns, experiments, runs):
        self.law, self.settings, self.experiments, self.runs = law, settings, experiments, runs
        self.unknowns = [*unknowns, *(one for experiment in experiments for one in experiment.unknowns)]
        self.data = [datum for experiment in experiments for datum in experiment.data]
        self.count = sum(datum.count for datum in self.data)
        self.stated = all(datum.error is not None for datum in self.data)

    def jobs(self, numbers):
        """Returns (experiment, settings) of all runs at these values of the fitted numbers."""
        found = []
        for experiment in self.experiments:
            values = {one.key: one.value(x) for one, x in zip(self.unknowns, numbers)
                      if one.owner in (None, experiment.name)}
            found.append((experiment, self.settings | experiment.settings | values))
        return found

    def predictions(self, numbers):
        """Returns the predictions of all data, or None if a run failed."""
        return self.flat(self.runs.all(self.jobs(numbers)))

    @staticmethod
    def flat(found):
        return None if any(one is None for one in found) else list(itertools.chain.from_iterable(found))

    def residuals(self, predictions, numbers, places):
        """Returns the weighted residuals of all data and of values known beforehand."""
        if predictions is None:
            return numpy.full(self.length(), FAILED)
        parts, start = [], 0
        for datum, prediction in zip(self.data, predictions):
            parts.append(datum.residuals(prediction, places[start:start + datum.places]))
            start += datum.places
        known = [(one.value(x) - one.known) / one.error for one, x in zip(self.unknowns, numbers)
                 if one.known is not None]
        return numpy.concatenate([*parts, known])

    def length(self):
        return sum(datum.length for datum in self.data) + sum(one.known is not None for one in self.unknowns)

    def split(self, x):
        return x[:len(self.unknowns)], x[len(self.unknowns):]

    def jacobian(self, x, step, sides=(1,)):
        """Returns finite differences by the unknowns, a matrix (residuals, unknowns) per side, and by the positions."""
        numbers, places = self.split(x)
        shifted = [numbers + side * step * unit for side in sides for unit in numpy.eye(len(numbers))]
        jobs = [self.jobs(one) for one in [numbers, *shifted]]
        made = self.runs.all([job for one in jobs for job in one])
        n = len(self.experiments)
        found = [self.flat(made[k:k + n]) for k in range(0, len(made), n)]
        base = self.residuals(found[0], numbers, places)
        columns = [(self.residuals(one, at, places) - base) / (side * step)
                   if one is not None else numpy.full(len(base), numpy.nan)
                   for one, at, side in zip(found[1:], shifted, numpy.repeat(sides, len(numbers)))]
        k = len(numbers)
        each = [numpy.array(columns[k * i:k * (i + 1)]).reshape(k, len(base)).T for i in range(len(sides))]
        return each, self.of_places(found[0], places, len(base))

    def of_places(self, predictions, places, rows, tiny=1e-6):
        """Returns derivatives by the positions of outlines (rows, positions). Each changes the residuals of its own
        outline only."""
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
        """Returns values at which all runs come to their end. If they do not at the user's start, multiplies one
        unknown after the other by 3, 1/3, 10 or 1/10."""
        start = numpy.array([one.number(one.start_value) for one in self.unknowns])
        tries = [start] + [start + shift * unit * numpy.array([one.logarithmic for one in self.unknowns])
                           for shift in numpy.log([3, 1 / 3, 10, 1 / 10]) for unit in numpy.eye(len(start))]
        low, high = numpy.transpose([one.bounds for one in self.unknowns])
        for numbers in (one for one in tries if ((low <= one) & (one <= high)).all()):
            predictions = self.predictions(numbers)
            if predictions is not None:
                return numpy.concatenate([numbers, *(datum.start(one) for datum, one in zip(self.data, predictions))])
        raise Mistake(f"{self.law}: all runs fail at the start and around it; the first one: {self.runs.messages[0]}")

    def effort(self):
        """Returns in words how many runs the fit takes."""
        moved = sum(one.owner in (None, experiment.name) for one in self.unknowns for experiment in self.experiments)
        n = len(self.experiments)
        return f"{self.law}: {n} runs to start with, then some {moved + n} a step, for 3 to 10 steps as a rule"

    def solve(self, start=None):
        x = self.begin() if start is None else start
        places = len(x) - len(self.unknowns)
        free = len(x) - (self.length() - self.count)  # less what is known beforehand
        expect(free < self.count,
               f"{self.law}: {free} numbers are unknown, positions included, and there are {self.count} data")
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
            self.x = scipy.optimize.least_squares(function, x, derivative, bounds, x_scale="jac", xtol=1e-7, ftol=1e-5,
                                                  gtol=1e-15, max_nfev=40).x
        except Settled as settled:
            self.x = settled.args[0]
        self.residual = function(self.x)
        self.square = float(self.residual @ self.residual)
        self.errors()
        return self

    def errors(self):
        """Computes the covariance of the unknowns, with positions eliminated, and `told`: which unknowns the data
        determine at all."""
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
        """Returns {name: (value, standard error or inf)}."""
        found = {}
        for one, x, error, known in zip(self.unknowns, self.x, self.number_errors, self.determined):
            value = one.value(x)
            found[one.name] = value, one.error_of(value, error) if known else numpy.inf
        return found

    @property
    def squares(self):
        """Returns {name of the datum: (chi square, points)}."""
        found, start = {}, 0
        for datum in self.data:
            found[datum.name] = float((self.residual[start:start + datum.length] ** 2).sum()), datum.length
            start += datum.length
        return found

    @property
    def missed(self):
        """Returns whether the errors of the data do not explain the residuals."""
        return self.stated and self.probability < MISSED

    @property
    def aic(self):
        parameters = len(self.x)
        if self.stated:
            return self.square + 2 * parameters
        return self.count * numpy.log(self.square / self.count) + 2 * (parameters + 1)

    def runs_test(self):
        """Returns z of the runs test (Wald and Wolfowitz) of the signs along all outlines and curves: by how many
        standard deviations the number of runs of one sign differs from chance."""
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
        """Returns the information matrix of the unknowns, with positions eliminated."""
        a, b = self.derivative[:, self.told], self.moved
        return a.T @ a - (a.T @ b) @ numpy.linalg.pinv(b.T @ b) @ (b.T @ a) if b.size else a.T @ a
