"""Unknowns and data of a fit. Data are outlines or series; each datum computes its prediction from a run."""

import numpy

from .. import tables
from ..interpolation import interpolated
from ..mistakes import expect, log
from . import silhouette
from .common import keys_of, number, only, optional, positive

# distance of the default bounds of an unknown from its start: a factor of 1000 or, with linear spacing, log(1000) times
# the start value
FAR = numpy.log(1000)
GAP = 0.1  # an outline counts as open if the gap from its last to its first point exceeds this fraction of its length


class Unknown:
    """A key of the deck whose value is fitted. The fit varies `number(value)`: the logarithm of the value or, with
    `spacing: linear`, the value divided by its start value."""

    def __init__(self, key, given, owner=None):
        given = given if isinstance(given, dict) else {"start": given}
        self.key, self.owner, self.name = key, owner, key if owner is None else f"{owner}: {key}"
        only(given, ("start", "known", "error", "from", "to", "spacing"), self.name)
        expect(("known" in given) == ("error" in given), f"{self.name}: `known` and `error` go together")
        spacing = given.get("spacing", "logarithmic")
        expect(spacing in ("linear", "logarithmic"),
               f"{self.name}: the spacing is linear or logarithmic, not {spacing}")
        self.start_value = number(given.get("start", given.get("known")), f"{self.name}: start")
        self.logarithmic = spacing == "logarithmic"
        expect(not self.logarithmic or self.start_value > 0,
               f"{self.name} starts from a positive number, or has `spacing: linear`")
        self.known, *bounds = (optional(number, given, word, self.name) for word in ("known", "from", "to"))
        width = bounds[1] - bounds[0] if None not in bounds else 0
        self.unit = 1.0 if self.logarithmic else abs(self.start_value) or abs(width) / 2 or 1.0
        expect(not self.logarithmic or all(bound is None or bound > 0 for bound in bounds),
               f"{self.name}: `from` and `to` must be above 0, or it has `spacing: linear`")
        start = self.number(self.start_value)
        low, high = self.bounds = tuple(start + far if bound is None else self.number(bound)
                                        for bound, far in zip(bounds, (-FAR, FAR)))
        expect(low <= start <= high and low < high,
               f"{self.name} starts from {self.start_value:g}, which is not between `from` and `to`")
        self.error = positive(given["error"], f"{self.name}: error") if "error" in given else None

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
    or None if it is not stated."""

    def __init__(self, given, name):
        self.name, self.at = name, optional(number, given, "at", name)
        self.error = optional(positive, given, "error", name)

    def columns(self, path, *names):
        """Returns two columns (n, 2) of a table. Sets `error` to its column of errors if no error is stated."""
        rows = tables.read(path, (*names, "error"), (2, 3)).values
        if self.error is None and rows.shape[1] > 2:
            self.error = rows[:, 2]
            expect((self.error > 0).all() and numpy.isfinite(self.error).all(), f"{self.name}: the third column of the "
                   "table is of standard errors, and one is not a number above 0")
        return rows[:, :2]


class OutlineData(Datum):
    """Points of a particle's outline in a coordinate plane. The fit also finds the position of the outline and, if
    `scale error` is given, its scale."""

    def __init__(self, given, name, folder):
        known = {"outline", "plane", "error", "scale", "scale error", "at", "open"}
        expect(set(given) <= known, f"{name}: an outline has {', '.join(sorted(known))}")
        expect("scale" in given,
               f"{name} has no scale: the deck's length for a unit of its picture (1 if they are the same)")
        super().__init__(given, name)
        self.scale = positive(given["scale"], f"{name}: scale")
        plane = given.get("plane", ["x1", "x3"])
        expect(isinstance(plane, list) and len(plane) == 2 and plane[0] != plane[1]
               and all(one in ("x1", "x2", "x3") for one in plane), f"{name}: the plane is two of x1, x2, x3")
        self.axis = 6 - sum(int(one[1]) for one in plane) - 1
        path = folder / str(given["outline"])
        of_picture = {"x", "y"} <= set(map(str.lower, tables.read(path).columns))  # the names of the picture's axes
        self.points = self.columns(path, *(("x", "y") if of_picture else plane))[:, numpy.argsort(plane)]
        if numpy.ndim(self.error):
            self.error = float(numpy.sqrt((self.error**2).mean()))
        steps = numpy.linalg.norm(self.points - numpy.roll(self.points, 1, axis=0), axis=1)
        expect(given.get("open") or steps[0] <= max(GAP * steps.sum(), 3 * numpy.median(steps)),
               f"{name}: the outline does not close: its last point is {steps[0] / steps.sum():.0%} of its length "
               "from the first (`open: true` takes it as it is)")
        self.scale_error = error = given.get("scale error") or 0
        if error:
            self.scale_error = numpy.inf if error == "free" else positive(error, f"{name}: scale error")
        self.count, self.places = len(self.points), 2 + bool(error)  # places: number of components of x (shift, scale)

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


class SeriesData(Datum):
    """Values, at given times, of a series or of the ratio of two series. With `origin: free`, the fit also finds the
    time shift between the data and the run."""

    length = property(lambda self: self.count)  # number of residuals
    discretisation = None  # estimated error of the series in the first run; 0 if its deck does not request an accuracy

    def __init__(self, given, name, folder):
        known = {"series", "over", "value", "curve", "error", "at", "origin"}
        expect(set(given) <= known and ("value" in given) != ("curve" in given),
               f"{name}: a series has value or curve, and error, at, over, origin")
        super().__init__(given, name)
        self.series = [given[word] for word in ("series", "over") if word in given]
        self.places = int("origin" in given)
        expect("at" not in given or "value" in given, f"{name}: `at` is of a value; a curve has its own times")
        expect(not self.places or given["origin"] == "free" and "curve" in given,
               f"{name}: `origin: free` is of a curve, and there is no other origin")
        if "curve" in given:
            self.times, self.values = self.columns(folder / str(given["curve"]), "time", "value").T
            self.span = float(numpy.ptp(self.times)) or 1.0  # unit of the time shift in the fit
        else:
            self.times, self.values = self.at, numpy.array([number(given["value"], f"{name}: value")])
        self.count = len(self.values)

    def start(self, prediction):
        """Returns the start value of the time shift, divided by `span`: the last time at which the series of the run
        passes the first value of the curve, or is nearest to it. Empty if the origin is not free."""
        if not self.places:
            return numpy.array([])
        times, values = prediction
        passed = numpy.flatnonzero((values[1:] - self.values[0]) * (values[:-1] - self.values[0]) <= 0)
        nearest = passed[-1] if len(passed) else numpy.argmin(abs(values - self.values[0]))
        return (times[[nearest]] - self.times[0]) / self.span

    def prediction(self, run):
        values, times = run.series[self.series[0]], run.series["time"]
        last = 0 if self.times is None or self.places else numpy.max(self.times)
        expect(last <= times[-1] * (1 + 1e-9),
               f"{self.name}: the run ends at {times[-1]:g}, before its data: set Time/final time")
        if self.times is not None and not self.places:
            expect(numpy.min(self.times) >= times[0] - 1e-9 * abs(times[-1]),
                   f"{self.name}: its data begin before the run, at {numpy.min(self.times):g}: give `origin: free`")
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
        expect(defined[-1] if self.times is None else defined.any(),
               f"{self.name}: {' / '.join(self.series)} is undefined (NaN) in the run")
        return times[defined], values[defined]

    def predicted(self, prediction, place):
        """Returns the values of the run at the data's times."""
        times, values = prediction
        if self.times is None:
            return values[-1:]
        wanted = numpy.atleast_1d(self.times) + (place[0] * self.span if self.places else 0)
        return interpolated(times, values, numpy.clip(wanted, times[0], times[-1]))

    def residuals(self, prediction, place):
        """Returns residuals of unit variance. The discretisation error d of the runs is modelled as a sum of up to six
        cosines in time with random coefficients. The residuals z divided by the errors e of the data then have the
        covariance 1 + U U^T, where the rows of U have a norm of about d/e. The result is (1 + U U^T)^(-1/2) z."""
        found = self.values - self.predicted(prediction, place)
        if self.error is None:
            return found
        times = numpy.zeros(1) if self.times is None else numpy.atleast_1d(self.times)
        waves = numpy.arange(min(self.count, 6))
        u = numpy.cos(numpy.pi * numpy.outer((times - times[0]) / (numpy.ptp(times) or 1), waves))
        u *= numpy.where(waves > 0, numpy.sqrt(2), 1) / numpy.sqrt(len(waves)) * (self.discretisation or 0)
        q, size, _ = numpy.linalg.svd(u / numpy.reshape(self.error, (-1, 1)), full_matrices=False)
        z = found / self.error
        return z - q @ ((1 - 1 / numpy.hypot(1, size)) * (q.T @ z))


class Experiment:
    def __init__(self, name, given, folder):
        expect(isinstance(given, dict) and given.get("data"), f"the experiment {name} has no data")
        expect(set(given) <= {"set", "unknown", "data"}, f"the experiment {name} has set, unknown and data")
        self.name, self.settings = name, keys_of(given.get("set"), f"{name}: set")
        unknowns = keys_of(given.get("unknown"), f"{name}: unknown")
        self.unknowns, self.data = [Unknown(key, one, name) for key, one in unknowns.items()], []
        expect(isinstance(given["data"], list), f"{name}: data must be a list of outlines and series")
        for one in given["data"]:
            one = keys_of(one, f"{name}: a datum")
            expect("outline" in one or "series" in one, f"{name}: a datum is an outline or a series")
            label = one.get("outline", one.get("series")) if len(given["data"]) > 1 else "data"
            self.data.append((OutlineData if "outline" in one else SeriesData)(one, f"{name}: {label}", folder))
