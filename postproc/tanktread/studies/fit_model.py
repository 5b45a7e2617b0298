"""Weighted least-squares fit of one membrane law: its unknowns and their standard errors, from runs of the program."""

import collections
import itertools

import numpy
import scipy.optimize
import scipy.stats

from ..mistakes import Mistake, expect, progress

STEP = 0.01     # step of the one-sided differences by an unknown during the iteration (an unknown is a logarithm, or a
                # value divided by its start)
TELLS = 0.02    # step of the central differences at the solution, from which the standard errors follow
TINY = 1e-6     # step of the differences by a position
FAILED = 1e6    # value of every residual if a run failed
MISSED = 1e-3   # if a chi square as large as that of the fit has a smaller probability, the stated errors of the data
                # do not explain the residuals
SETTLED = 1e-2  # the iteration ends if the next step would lower chi square by less than this fraction of chi square
                # per degree of freedom; such a step changes the unknowns by about a tenth of their standard errors
FAINT = 1e-4    # an unknown is kept constant in a step if the norm of the derivative of the residuals is at most this
SERIES = 8      # smallest number of points of a datum for the runs test of the signs of its residuals


class Settled(Exception):
    """Ends the iteration, because the next step is small compared with the standard errors. Argument: the vector x."""


def parts(sizes):
    """Returns the slices that divide an array into consecutive parts of the given sizes."""
    return [slice(*ends) for ends in itertools.pairwise(numpy.cumsum([0, *sizes]))]


def determined(unknowns, x, errors):
    """Returns the standard errors of the unknowns in x, or inf where the data do not determine an unknown: where it is
    uncertain by a factor of e or, if it is not logarithmic, by more than its start value and more than its value."""
    most = [1 if one.logarithmic else max(1, abs(number)) for one, number in zip(unknowns, x)]
    return numpy.where((errors > 0) & (errors < most), errors, numpy.inf)


# A run without results, or from which a datum of its experiment cannot be predicted. `settings`: of the run.
Failure = collections.namedtuple("Failure", "experiment settings directory message")


class Runs:
    """Predictions of the data from runs of the program. A run is made once. The prediction for an experiment is None if
    one of its runs failed or gave no outline or no value; the first such run is in `failures`."""

    def __init__(self, study, decks, law):
        self.law, self.study, self.decks, self._run = law, study, decks, None
        self._found, self._made, self.failures = {}, set(), {}

    count = property(lambda self: len(self._made))

    @staticmethod
    def name(experiment, settings):
        return f"{experiment.name} {experiment.cases} {sorted(settings.items())}"

    def all(self, jobs):
        """Returns the predictions for a list of pairs (experiment, settings), in its order."""
        names = [self.name(*job) for job in jobs]
        new = {name: job for name, job in zip(names, jobs) if name not in self._found}
        outcomes = iter(self.study.all([(self.decks, settings | case) for experiment, settings in new.values()
                                        for case in experiment.cases]))
        for name, (experiment, settings) in new.items():
            self._found[name] = self._predictions(name, experiment, settings, outcomes)
        if new:
            progress(f"{self.law}: {self.count} runs made or found")
        return [self._found[name] for name in names]

    def _predictions(self, name, experiment, settings, outcomes):
        """Returns the predictions of an experiment's data from the next of the outcomes; None if a run failed."""
        of_runs = collections.defaultdict(dict)  # predictions of each datum by each run
        for case, outcome in zip(map(str, experiment.cases), outcomes):
            expect(not outcome.refused, f"{experiment.name}: the deck is refused: {outcome.message}")
            self._made.add(outcome.directory)
            message = None if outcome.done else outcome.message
            self._run = outcome.run if outcome.done else self._run
            for datum in () if message else experiment.data:
                try:
                    if case in map(str, datum.cases):
                        of_runs[datum][case] = datum.prediction(outcome.run)
                except ValueError as error:  # the shape has no outline, or the series no value
                    if isinstance(error, Mistake) and not any(self._found.values()):
                        raise  # a mistake of the experiment file, such as a series that the run does not have
                    message = str(error)
            if message:
                self.failures.setdefault(name, Failure(experiment.name, settings, outcome.directory.name, message))
        return None if name in self.failures else [
            datum.joined([of_runs[datum][str(case)] for case in datum.cases]) for datum in experiment.data]

    def unit(self, key):
        """Returns the unit of a key if the deck has units: ", pN/µm"; otherwise ""."""
        return self._run.in_units(self.study.dimension(key)) if self._run else ""


class Fit:
    """Fit of one law. The vector x of the fit contains the unknowns, then the positions of the data: the shift (and the
    logarithm of the scale factor) of each outline, and the time shift of each curve with a free origin."""

    def __init__(self, law, settings, unknowns, experiments, runs):
        self.law, self.settings, self.experiments, self.runs = law, settings, experiments, runs
        self.unknowns = [*unknowns, *(one for experiment in experiments for one in experiment.unknowns)]
        self.data = [datum for experiment in experiments for datum in experiment.data]
        self.rows = parts(datum.length for datum in self.data)  # slice of the residuals of each datum
        # slice of the position of each datum in x
        self.positions = parts([len(self.unknowns), *(datum.places for datum in self.data)])[1:]
        self.count = sum(datum.count for datum in self.data)
        self.beyond = []  # vector x at which runs failed and the iteration ended
        self.stated = all(datum.error is not None for datum in self.data)

    length = property(lambda self: sum(datum.length for datum in self.data)
                      + sum(one.known is not None for one in self.unknowns), doc="The number of residuals.")

    def settings_of(self, experiment, x):
        """Returns the settings of the run of an experiment for the unknowns in x. Positions in x are not used."""
        return self.settings | experiment.settings | {
            one.key: one.value(number) for one, number in zip(self.unknowns, x) if one.owner in (None, experiment.name)}

    def predictions(self, *points):
        """Returns for each vector x the predictions of all data, or None if a run failed."""
        made = self.runs.all([(one, self.settings_of(one, x)) for x in points for one in self.experiments])
        groups = [made[part] for part in parts([len(self.experiments)] * len(points))]
        return [None if None in group else list(itertools.chain.from_iterable(group)) for group in groups]

    def residuals(self, predictions, x):
        """Returns the residuals divided by their standard errors: of all data, then of the unknowns whose value was
        given with an error (`known`)."""
        if predictions is None:
            return numpy.full(self.length, FAILED)
        each = [datum.residuals(found, x[own]) for datum, found, own in zip(self.data, predictions, self.positions)]
        known = [(one.value(number) - one.known) / one.error for one, number in zip(self.unknowns, x)
                 if one.known is not None]
        return numpy.concatenate([*each, known])

    def jacobian(self, x, step, sides=(1,)):
        """Returns the derivatives of the residuals by finite differences: with respect to the unknowns, shape (sides,
        residuals, unknowns), and with respect to the positions, shape (residuals, positions)."""
        n = len(self.unknowns)
        shifts = [side * step * unit for side in sides for unit in numpy.eye(len(x))[:n]]
        first, *found = self.predictions(x, *(x + shift for shift in shifts))
        base, by_position = self.residuals(first, x), numpy.zeros((self.length, len(x)))
        rows = [numpy.full(self.length, numpy.nan) if one is None else
                (self.residuals(one, x + shift) - base) / shift.sum() for one, shift in zip(found, shifts)]
        for datum, prediction, own, there in zip(self.data, first, self.positions, self.rows):
            moved = [datum.residuals(prediction, x[own] + TINY * unit) for unit in numpy.eye(datum.places)]
            by_position[there, own] = (numpy.reshape(moved, (-1, datum.length)) - base[there]).T / TINY
        return numpy.reshape(rows, (len(sides), n, self.length)).transpose(0, 2, 1), by_position[:, n:]

    def begin(self):
        """Returns a start vector x for which no run fails. Tries the user's start values, and then vectors in which one
        unknown is multiplied by 3, 1/3, 10 or 1/10."""
        start = numpy.array([one.number(one.start_value) for one in self.unknowns])
        units = numpy.diag([float(one.logarithmic) for one in self.unknowns])
        tries = [start, *(start + shift * unit for shift in numpy.log([3, 1 / 3, 10, 1 / 10]) for unit in units)]
        low, high = numpy.transpose([one.bounds for one in self.unknowns])
        for x in (one for one in tries if ((low <= one) & (one <= high)).all()):
            (found,) = self.predictions(x)
            if found is not None:
                return numpy.concatenate([x, *(datum.start(one) for datum, one in zip(self.data, found))])
        first = next(iter(self.runs.failures.values()))
        raise Mistake(f"{self.law}: all runs fail at the start and around it; the first one, {first.directory} of the "
                      f"experiment {first.experiment}: {first.message}")

    def failures_at(self, *points):
        """Returns the Failures of runs at these vectors x."""
        names = [self.runs.name(one, self.settings_of(one, x)) for x in points for one in self.experiments]
        return [self.runs.failures[name] for name in names if name in self.runs.failures]

    def solve(self):
        x = self.begin()
        places = len(x) - len(self.unknowns)
        free = len(x) - (self.length - self.count)  # an unknown or scale with a known value does not need data
        expect(free < self.count,
               f"{self.law}: {free} numbers are unknown, positions included, and there are {self.count} data")
        bounds = numpy.array([one.bounds for one in self.unknowns] + [(-numpy.inf, numpy.inf)] * places).T

        best = numpy.inf, x  # smallest chi square, and where it was found

        def function(x):
            nonlocal best
            (found,) = self.predictions(x)
            residual = self.residuals(found, x)
            if found is not None:
                best = min(best, (float(residual @ residual), x), key=lambda one: one[0])
            elif abs(x - best[1])[:len(self.unknowns)].max() < TELLS:  # the edge of a region where runs fail
                self.beyond = [x]
                raise Settled(best[1])
            return residual

        def derivative(x):
            (columns,), by_position = self.jacobian(x, STEP)
            if not numpy.isfinite(columns).all():  # runs fail on this side
                (other,), _ = self.jacobian(x, STEP, (-1,))
                columns = numpy.nan_to_num(numpy.where(numpy.isfinite(columns), columns, other))
            full = numpy.column_stack([columns * (numpy.linalg.norm(columns, axis=0) > FAINT), by_position])
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
        # the step that would minimise chi square if only this unknown varied and had no bounds
        with numpy.errstate(invalid="ignore", divide="ignore"):
            steps = -(self.derivative.T @ self.residual) / numpy.square(self.derivative).sum(0)
        self.at_bound = [one.bound_of(number, step) if known else None
                         for one, number, step, known in zip(self.unknowns, self.x, steps, self.told)]
        return self

    def errors(self):
        """Computes the covariance matrix of the unknowns that the data determine. The positions are eliminated. `told`:
        one flag per unknown, true if the data determine it. `edge`: Failures of runs next to the solution, which may
        then be the edge of the region where runs succeed instead of a minimum."""
        (up, down), self.moved = self.jacobian(self.x, TELLS, (1, -1))
        shifts = TELLS * numpy.eye(len(self.unknowns), len(self.x))
        near = [self.x + side * shift for side in (1, -1) for one, number, shift in zip(self.unknowns, self.x, shifts)
                if not one.bound_of(number, side * TELLS)]
        self.edge = self.failures_at(*self.beyond, *near)
        up, down = (numpy.where(numpy.isfinite(one), one, other) for one, other in ((up, down), (down, up)))
        self.derivative, disagreement = (up + down) / 2, numpy.linalg.norm(up - down, axis=0) / 2
        strength = numpy.linalg.norm(self.derivative, axis=0)
        self.told = numpy.isfinite(strength) & (strength > 2 * disagreement) & (strength > 0)
        full = numpy.column_stack([self.derivative[:, self.told], self.moved])
        scale, k = numpy.linalg.norm(full, axis=0), self.told.sum()
        expect((scale > 0).all(), f"{self.law}: the position of an outline or curve has no effect: the runs do not "
               "reach the data; change a start value or Time/final time")
        _, sizes, right = numpy.linalg.svd(full / scale)
        sizes = numpy.pad(sizes, (0, full.shape[1] - len(sizes)))  # the error is infinite in directions without data
        with numpy.errstate(divide="ignore", invalid="ignore"):
            spread = right.T / sizes
        covariance = (spread @ spread.T / numpy.outer(scale, scale))[:k, :k]
        self.freedom = self.length - full.shape[1]
        self.covariance = covariance * (1 if self.stated else self.square / self.freedom)
        self.number_errors = numpy.full(len(self.unknowns), numpy.inf)
        self.number_errors[self.told] = numpy.sqrt(numpy.diag(self.covariance))
        self.probability = float(scipy.stats.chi2.sf(self.square, self.freedom))

    @property
    def values(self):
        """Returns {name: (value, standard error or inf)}; (NaN, inf) at an edge where runs fail."""
        if self.edge:
            return {one.name: (numpy.nan, numpy.inf) for one in self.unknowns}
        return {one.name: (one.value(x), one.error_of(one.value(x), error)) for one, x, error in
                zip(self.unknowns, self.x, determined(self.unknowns, self.x, self.number_errors))}

    scatter = property(lambda self: numpy.sqrt(self.square / self.freedom),
                       doc="By what factor residuals are larger than their errors.")
    missed = property(lambda self: self.stated and self.probability < MISSED,
                      doc="Whether the errors of the data do not explain the residuals.")
    aic = property(lambda self: self.square + 2 * len(self.x) if self.stated else
                   self.count * numpy.log(self.square / self.count) + 2 * (len(self.x) + 1))

    def runs_test(self):
        """Returns z of the Wald-Wolfowitz runs test of the signs of residuals along all outlines and curves; NaN if
        none has both signs and enough points."""
        runs = mean = variance = 0
        for datum, own in zip(self.data, self.rows):
            signs = self.residual[own][:datum.count] > 0
            plus, minus, n = signs.sum(), (~signs).sum(), datum.count
            if n < SERIES or not plus or not minus:
                continue
            runs += 1 + (signs[1:] != signs[:-1]).sum()
            mean += 1 + 2 * plus * minus / n
            variance += 2 * plus * minus * (2 * plus * minus - n) / (n * n * (n - 1))
        return float((runs - mean) / numpy.sqrt(variance)) if variance else numpy.nan

    def signs(self):
        """Returns (number of positive residuals, number of residuals, name, probability) of the data whose residuals
        have one sign most clearly: of each outline or curve, of all values of a series, and of all data. The
        probability is that of a two-sided binomial test, multiplied by the number of tests. Returns None if there are
        too few data."""
        groups = collections.defaultdict(list)
        for datum, own in zip(self.data, self.rows):
            name = datum.name if datum.count >= SERIES else " / ".join(getattr(datum, "series", ["outlines"]))
            groups[name].extend(self.residual[own][:datum.count] > 0)
        if len(groups) > 1:
            groups["all data"] = list(itertools.chain.from_iterable(groups.values()))
        tests = [(sum(signs), len(signs), name) for name, signs in groups.items() if len(signs) >= SERIES]
        found = [(*test, min(1.0, len(tests) * scipy.stats.binomtest(*test[:2]).pvalue)) for test in tests]
        return min(found, key=lambda test: test[3], default=None)

    def information(self):
        """Returns the information matrix of the unknowns, with positions eliminated."""
        a, b = self.derivative[:, self.told], self.moved
        return a.T @ a - (a.T @ b) @ numpy.linalg.pinv(b.T @ b) @ (b.T @ a) if b.size else a.T @ a
