"""Unknowns, data and experiments of a fit. Data are outlines or series, which are predicted from runs."""

import copy

import numpy

from .. import tables, units
from ..interpolation import interpolated
from ..mistakes import Mistake, expect, log
from . import reading, silhouette
from .reading import any_name, deck_key, number, positive, read

# distance of the default bounds of an unknown from its start: a factor of 1000 or, with linear spacing, log(1000) times
# the start value
FAR = numpy.log(1000)
GAP = 0.1  # an outline counts as open if the gap from its last to its first point exceeds this fraction of its length


class Unknown:
    """A key of the deck whose value is fitted. The fit varies `number(value)`: the logarithm of the value or, with
    `spacing: linear`, the value divided by its start value."""

    kinds = {"start": number, "known": number, "error": positive, "from": number, "to": number,
             "spacing": reading.word("linear", "logarithmic")}

    def __init__(self, key, given, owner=None):
        self.key, self.owner, self.name = key, owner, key if owner is None else f"{owner}: {key}"
        given = read(given if isinstance(given, dict) else {"start": given}, self.kinds, self.name)
        expect(("known" in given) == ("error" in given), f"{self.name}: `known` and `error` go together")
        expect("start" in given or "known" in given, f"{self.name} has no start value")
        self.start_value, self.error = given.get("start", given.get("known")), given.get("error")
        self.logarithmic = given.get("spacing") != "linear"
        expect(not self.logarithmic or self.start_value > 0,
               f"{self.name} starts from a positive number, or has `spacing: linear`")
        self.known, *bounds = map(given.get, ("known", "from", "to"))
        width = bounds[1] - bounds[0] if None not in bounds else 0
        self.unit = 1.0 if self.logarithmic else abs(self.start_value) or abs(width) / 2 or 1.0
        expect(not self.logarithmic or all(bound is None or bound > 0 for bound in bounds),
               f"{self.name}: `from` and `to` must be above 0, or it has `spacing: linear`")
        start = self.number(self.start_value)
        low, high = self.bounds = tuple(start + far if bound is None else self.number(bound)
                                        for bound, far in zip(bounds, (-FAR, FAR)))
        expect(low <= start <= high and low < high,
               f"{self.name} starts from {self.start_value:g}, which is not between `from` and `to`")

    def number(self, value):
        return numpy.log(value) if self.logarithmic else value / self.unit

    def value(self, number):
        return float(numpy.exp(number) if self.logarithmic else number * self.unit)

    def bound_of(self, number, step):
        """Returns the bound, `from` or `to`, that lies between a number and number + step; None if there is none."""
        low, high = self.bounds
        return "from" if number + step < low else "to" if number + step > high else None

    def error_of(self, value, error):
        """Returns the standard error of the value. `error`: standard error of number(value)."""
        return error * (value if self.logarithmic else self.unit)


class Datum:
    """Base class of outlines and series. `at`: time of the datum; None is the end of the run. `error`: standard error,
    or None if it is not stated. `cases`: settings of the runs that the datum needs, in addition to those of its
    experiment."""

    def __init__(self, given, name):
        self.name, self.at, self.error, self.cases = name, given.get("at"), given.get("error"), [{}]

    def table(self, path, names, chosen=None):
        """Returns the table of two columns, `names`, in a file. Sets `error` to its column of standard errors if no
        error is stated. `chosen`: names or numbers, from 1, of two or three columns, which then count instead."""
        try:
            found = tables.read(path) if chosen else tables.read(path, (*names, "error"), (2, 3))
        except Mistake as mistake:
            raise Mistake(f"{self.name}: {mistake}; `columns` chooses columns by name or number") from None
        known = found.columns
        for one in chosen or ():
            expect(one in known if isinstance(one, str) else one <= len(known),
                   f"{self.name}: {path} has no column {one}; there are: {', '.join(known)}")
        index = [known.index(one) if isinstance(one, str) else one - 1 for one in chosen or range(1, len(known) + 1)]
        if self.error is None and len(index) > 2:
            self.error = found.values[:, index[2]]
            expect((self.error > 0).all() and numpy.isfinite(self.error).all(), f"{self.name}: column "
                   f"{known[index[2]]} of {path} is of standard errors, and one is not a number above 0")
        names, own = ([one[k] for k in index[:2]] for one in (known, found.units))
        return tables.Table(names, own, found.values[:, index[:2]], found.lines)

    def joined(self, predictions):
        """Returns the prediction of the datum from its predictions by each of the runs `cases`."""
        return predictions[0]

    def another(self, key, value):
        """Returns a copy of the datum for an experiment in which a key has another value."""
        return copy.copy(self)


def _columns(given, name):
    """Returns a list of two or three columns of a table: names, or numbers from 1."""
    kinds = [lambda one, name: reading.text(one, name) if isinstance(one, str) else reading.whole(one, name)]
    found = read(given, kinds, name)
    expect(2 <= len(found) <= 3, f"{name} are the two or three columns of the data, and of their standard errors")
    return found


class OutlineData(Datum):
    """Points of a particle's outline in a coordinate plane. The fit also finds the position of the outline and, if
    `scale error` is given, its scale."""

    kinds = {"outline": reading.text, "plane": [reading.word("x1", "x2", "x3")], "error": positive, "scale": positive,
             "scale error": lambda given, name: numpy.inf if given == "free" else positive(given, name) if given else 0,
             "at": number, "open": reading.flag, "columns": _columns}

    def __init__(self, given, name, folder):
        given = read(given, self.kinds, name)
        expect("scale" in given,
               f"{name} has no scale: the deck's length for a unit of its picture (1 if they are the same)")
        super().__init__(given, name)
        self.scale, self.scale_error = given["scale"], given.get("scale error", 0)
        plane, path = given.get("plane", ["x1", "x3"]), folder / given["outline"]
        expect(len(set(plane)) == len(plane) == 2, f"{name}: the plane is two of x1, x2, x3")
        self.axis = 6 - sum(int(one[1]) for one in plane) - 1
        of_picture = {"x", "y"} <= set(map(str.lower, tables.read(path).columns))  # the names of the picture's axes
        found = self.table(path, ("x", "y") if of_picture else plane, given.get("columns"))
        self.points = found.values[:, numpy.argsort(plane)]
        if numpy.ndim(self.error):
            self.error = float(numpy.sqrt((self.error**2).mean()))
        steps = numpy.linalg.norm(self.points - numpy.roll(self.points, 1, axis=0), axis=1)
        expect(given.get("open") or steps[0] <= max(GAP * steps.sum(), 3 * numpy.median(steps)),
               f"{name}: the outline does not close: its last point is {steps[0] / steps.sum():.0%} of its length "
               "from the first (`open: true` takes it as it is)")
        self.count = len(self.points)
        self.places = 2 + bool(self.scale_error)  # number of components of x (shift, scale)

    length = property(lambda self: self.count + (0 < self.scale_error < numpy.inf),
                      doc="The number of residuals: one per point, and one of a scale with an error.")

    def start(self, prediction):
        """Returns start values (2,) or (3,): the shift that moves the centre of the bounding box of the data to the
        centre of the bounding box of the prediction, and 0 for the logarithm of the scale factor if it is fitted."""
        own, middle = ((points.min(0) + points.max(0)) / 2 for points in (self.points, prediction.points))
        return numpy.append(middle - self.scale * own, numpy.zeros(self.places - 2))

    def prediction(self, run):
        shot = run.snapshot_at(self.at)
        expect(self.at is None or abs(shot.time - self.at) < 1e-6 * max(1, abs(self.at)),
               f"{self.name}: there is no snapshot at {self.at}: set Output/interval")
        return silhouette.seen(shot, self.axis).centred()  # the position in the deck's frame is not part of the data

    def placed(self, place):
        return self.points * self.scale * numpy.exp(place[2] if self.places > 2 else 0) + place[:2]

    def residuals(self, prediction, place):
        found = prediction.distances(self.placed(place)) / self.scale / (self.error or 1)
        return found if self.length == self.count else numpy.append(found, place[2] / self.scale_error)


def _against(given, name):
    """Returns {key of the deck: factor or list of factors}: the key is the first column multiplied by the factor."""
    if isinstance(given, str):
        deck_key(given, name)
        return {given: 1.0}
    found = read(given, {deck_key: lambda one, name: read(one, [number] if isinstance(one, list) else number, name)},
                 name)
    expect(found, f"{name} names no key")
    return found


def _with_unit(number, unit):
    return f"{number:.15g} {unit}" if unit not in (None, "1") else float(number)


class SeriesData(Datum):
    """Values of a series or of the ratio of two series: at one time, at given times, or in steady states that depend on
    keys of the deck (`against`). With `origin: free`, the fit also finds the time shift between the data and the run.
    `along`: times or values of the key (None: the last value of the run). `unit`: unit of `along` as the table states
    it."""

    kinds = {"series": reading.text, "over": reading.text, "value": number, "curve": reading.text, "error": positive,
             "at": number, "origin": reading.word("free"), "against": _against, "columns": _columns}
    length = property(lambda self: self.count)  # number of residuals
    span = property(lambda self: float(numpy.ptp(self.along)) or 1.0, doc="The unit of the time shift in the fit.")
    discretisation = None  # estimated error of the series in the first run; 0 if its deck does not request an accuracy

    def __init__(self, given, name, folder):
        given = read(given, self.kinds, name)
        expect("series" in given and ("value" in given) != ("curve" in given),
               f"{name}: a series has value or curve, and error, at, over, origin, against")
        super().__init__(given, name)
        self.series = [given[word] for word in ("series", "over") if word in given]
        self.places, self.against, self.unit = int("origin" in given), given.get("against"), None
        expect(not self.against or "curve" in given, f"{name}: `against` is of a curve")
        expect(self.at is None or "value" in given or self.against,
               f"{name}: `at` is of a value, or of a curve against a key; a curve over time has its own times")
        expect(not self.places or ("curve" in given and not self.against),
               f"{name}: `origin: free` is of a curve over time")
        if "curve" in given:
            path, named = folder / given["curve"], next(iter(self.against or ["time"])).rpartition("/")[2]
            known = tables.read(path).columns  # the first column, unless another one has the name of the key
            first = next((one for one in known if one.lower() == named.lower()), known[0])
            found = self.table(path, (first, "value"), given.get("columns"))
            self.along, self.values = found.values.T
            self.unit, self.value_unit = found.units
        else:
            self.along, self.values, self.value_unit = self.at, numpy.array([given["value"]]), None
        self.count = len(self.values)
        if self.against:
            self._sort()

    def _sort(self):
        """Orders the rows by the values of the key, and sets the runs that the datum needs: one per value."""
        order = numpy.argsort(self.along, kind="stable")
        self.along, self.values = self.along[order], self.values[order]
        self.error = self.error[order] if numpy.ndim(self.error) else self.error
        self.nodes = numpy.unique(self.along)
        self.cases = [{key: [_with_unit(one * value, self.unit) for one in factor] if isinstance(factor, list) else
                       _with_unit(factor * value, self.unit) for key, factor in self.against.items()}
                      for value in self.nodes]

    def axis(self, runs):
        """Returns the label of the axis of `along`."""
        if self.unit and self.against:
            return f"{next(iter(self.against))}, {self.unit}"
        key = next(iter(self.against)) if self.against else "Time/final time"
        return (key if self.against else "time") + runs.unit(key)

    def another(self, key, value):
        """Returns a copy of the datum; if it is a curve against the key, with one row, at this value of the key."""
        one = copy.copy(self)
        if self.against and key in self.against:
            one.cases, one.along, one.nodes, one.count = [{key: value}], numpy.zeros(1), numpy.zeros(1), 1
            one.error = float(numpy.sqrt(numpy.mean(numpy.square(self.error)))) if self.error is not None else None
        return one

    def _convert(self, run):
        """Converts the columns of the table from their units to those of a run."""
        name, ratio = self.series[0], len(self.series) > 1
        factors = []
        for unit, one in (self.value_unit, name), (None if self.against else self.unit, "time"):
            own = "1" if ratio and one == name else run.si[one] or run.units[one] or "1"
            factors.append(1.0 if unit is None else units.factor(unit, own))
            expect(factors[-1], f"{self.name}: the table is in {unit}, which does not fit the unit of {one}, {own}"
                   + ("" if "Units" in run.deck else "; the deck has no section Units"))
        self.values, self.error = (one if one is None else one * factors[0] for one in (self.values, self.error))
        self.along, self.value_unit = self.along if self.along is None else self.along * factors[1], None
        self.unit = self.unit if self.against else None

    def start(self, prediction):
        """Returns the start value of the time shift, divided by `span`: the last time at which the series of the run
        passes the first value of the curve, or is nearest to it. Empty if the origin is not free."""
        if not self.places:
            return numpy.array([])
        times, values = prediction
        passed = numpy.flatnonzero((values[1:] - self.values[0]) * (values[:-1] - self.values[0]) <= 0)
        nearest = passed[-1] if len(passed) else numpy.argmin(abs(values - self.values[0]))
        return (times[[nearest]] - self.along[0]) / self.span

    def prediction(self, run):
        """Returns the times and values of a run's series, where it is defined."""
        values, times = run.series[self.series[0]], run.series["time"]
        if self.value_unit or (self.unit and not self.against):
            self._convert(run)
        wanted = self.at if self.against else self.along
        last = 0 if wanted is None or self.places else numpy.max(wanted)
        expect(last <= times[-1] * (1 + 1e-9),
               f"{self.name}: the run ends at {times[-1]:g}, before its data: set Time/final time")
        if wanted is not None and not self.places:
            expect(numpy.min(wanted) >= times[0] - 1e-9 * abs(times[-1]),
                   f"{self.name}: its data begin before the run, at {numpy.min(wanted):g}: give `origin: free`")
        if self.places:
            expect(self.span <= (times[-1] - times[0]) * (1 + 1e-9),
                   f"{self.name}: the run is shorter than the data, {self.span:g}: set Time/final time")
        # the largest estimated error; for a ratio, the errors of both series combined; 0 if it is unknown
        if self.discretisation is None:
            for name in self.series:
                if name in run.untrusted:
                    log.info(f"{self.name}: the standard errors do not contain the discretisation error of {name}, "
                             f"which is unknown: {run.untrusted[name]}")
            sizes = [numpy.nanmax(abs(run.series[name])) for name in self.series]
            errors = [numpy.nanmax(run.errors[name]) if run.band(name) is not None else 0 for name in self.series]
            self.discretisation = (errors[0] if len(self.series) == 1 else
                                   sizes[0] / sizes[1] * numpy.hypot(*numpy.divide(errors, sizes)))
        values = values / run.series[self.series[1]] if len(self.series) > 1 else values
        defined = ~numpy.isnan(values)
        expect(defined[-1] if wanted is None else defined.any(),
               f"{self.name}: {' / '.join(self.series)} is undefined (NaN) in the run")
        return times[defined], values[defined]

    def joined(self, predictions):
        """Returns the prediction by one run; of a curve against a key, its values and those of the series there."""
        if not self.against:
            return predictions[0]
        return self.nodes, numpy.array([values[-1] if self.at is None else interpolated(times, values, [self.at])[0]
                                        for times, values in predictions])

    def predicted(self, prediction, place):
        """Returns the values that the runs give for the data, or for other values of `along`."""
        at, values = prediction
        if self.along is None:
            return values[-1:]
        if self.against:
            return numpy.interp(self.along, at, values)  # the data are at the values `at`; figures join these by lines
        wanted = numpy.atleast_1d(self.along) + (place[0] * self.span if self.places else 0)
        return interpolated(at, values, numpy.clip(wanted, at[0], at[-1]))

    def residuals(self, prediction, place):
        """Returns residuals of unit variance. The discretisation error d of the runs is modelled as a sum of up to six
        cosines in time with random coefficients. The residuals z divided by the errors e of the data then have the
        covariance 1 + U U^T, where the rows of U have a norm of about d/e. The result is (1 + U U^T)^(-1/2) z."""
        found = self.values - self.predicted(prediction, place)
        if self.error is None:
            return found
        along = numpy.zeros(1) if self.along is None else numpy.atleast_1d(self.along)
        waves = numpy.arange(min(self.count, 6))
        u = numpy.cos(numpy.pi * numpy.outer((along - along[0]) / (numpy.ptp(along) or 1), waves))
        u *= numpy.where(waves > 0, numpy.sqrt(2), 1) / numpy.sqrt(len(waves)) * (self.discretisation or 0)
        q, size, _ = numpy.linalg.svd(u / numpy.reshape(self.error, (-1, 1)), full_matrices=False)
        z = found / self.error
        return z - q @ ((1 - 1 / numpy.hypot(1, size)) * (q.T @ z))


class Experiment:
    """An experiment and its runs. `cases`: settings of each run, in addition to `settings`. All runs share the
    unknowns."""

    kinds = {"set": reading.SETTINGS, "unknown": {deck_key: reading.anything}, "data": [{any_name: reading.anything}]}

    def __init__(self, name, given, folder):
        given = read(given, self.kinds, f"the experiment {name}")
        expect(given.get("data"), f"the experiment {name} has no data")
        self.name, self.settings, data = name, given.get("set", {}), []
        self.unknowns = [Unknown(key, one, name) for key, one in given.get("unknown", {}).items()]
        for one in given["data"]:
            kind = next((kind for kind in ("outline", "series") if one.get(kind) is not None), None)
            expect(kind, f"{name}: a datum is an outline or a series")
            label = one[kind] if len(given["data"]) > 1 and isinstance(one[kind], str) else "data"
            data.append({"outline": OutlineData, "series": SeriesData}[kind](one, f"{name}: {label}", folder))
        self.take(data)

    def take(self, data):
        """Sets the data, and `cases` to the different settings of the runs that they need."""
        cases = {str(case): case for datum in data for case in datum.cases}
        reading.few(len(cases), f"the experiment {self.name}")
        self.data, self.cases = data, list(cases.values())

    def another(self, key, value):
        """Returns a copy of the experiment, without its unknowns, in which a key has another value."""
        one = copy.copy(self)
        one.settings, one.unknowns = self.settings | {key: value}, []
        one.take([datum.another(key, value) for datum in self.data])
        return one
