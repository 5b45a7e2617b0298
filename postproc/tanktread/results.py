"""Results of a run: its series, deck, summary and snapshots."""

import json
import pathlib
import re

import numpy
import yaml

from .files import Named, arrays_of, datasets, opened, parsed, text_of_hdf, yaml_text
from .mistakes import Mistake, expect, optional
from .snapshots import DIMENSIONS, Snapshot

RATES = {"simple shear": "shear rate", "four-roll": "rate", "planar hyperbolic": "rate", "uniaxial extension": "rate"}
# Series of one particle; the others belong to the scene. A deck with several particles states it by /series/<particle>.
OF_PARTICLE = re.compile(
    r"area|axis_\d(_x\d)?|cent(er|roid)_x\d|compressed_area|energy|inclination|intrinsic_viscosity|length_x\d|phase|"
    r"(projected|hull)_area|(hull_)?circularity|"
    r"gap|(local|rms)_area_change|n_control_points|(normal|shape)_velocity|smallest_tension|stresslet_\d\d|"
    r"tank_treading_\w+|taylor_\w+|((angular|migration)_)?velocity(_x\d)?|volume(_error)?|refit_error|quaternion_\d|"
    r"\w*concentration|surfactant_mass|torque_x\d|drag(_x\d)?|(flow|force)_power|(fluid|membrane)_dissipation|"
    r"power_residual")


class Run:
    """The results in a directory, in the units of the deck.

    `series`: {name: values (rows,)}, one row per recorded step. If there are several particles, the series of a
    particle is named `<particle>/<name>`. A value is NaN where the series is undefined (see its description). An
    unknown name raises Mistake. `units`, `descriptions`: {name: text}. `si`: {name: what the value 1 stands for, such
    as "1e-06 m"}; "" if it is dimensionless or the deck has no section Units. `errors`: {name: estimated error (rows,)}
    if an accuracy was requested, otherwise empty; NaN where no error can be estimated. `untrusted`: {name: reason why
    it cannot be estimated}. `deck`: the effective deck as nested dicts; `deck_text`: the same as YAML text.
    `provenance`: version, compiler, ranks. `summary`: the content of summary.yaml, or None if the run has not
    ended."""

    def __init__(self, directory):
        self.directory = pathlib.Path(directory)
        path, summary = self.directory / "run.h5", self.directory / "summary.yaml"
        expect(path.is_file(), f"{directory} holds no run.h5: give the directory of a run's results, or a deck")
        with opened(path) as file:
            found = datasets(file["series"])
            self.series = Named({name: data[:] for name, data in found.items()}, f"{directory} holds no series")
            self.units = {name: text_of_hdf(data.attrs["unit"]) for name, data in found.items()}
            self.si = {name: text_of_hdf(data.attrs.get("SI", "")) for name, data in found.items()}
            self.descriptions = {name: text_of_hdf(data.attrs["description"]) for name, data in found.items()}
            errors = datasets(file["error"]) if "error" in file else {}
            self.errors = {name: data[:] for name, data in errors.items()}
            self.untrusted = {name: text_of_hdf(data.attrs["description"]).removeprefix("no error: ")
                              for name, data in errors.items() if not numpy.isfinite(data[:]).any()}
            self.deck_text = text_of_hdf(file["deck"][()])
            self.provenance = {key: text_of_hdf(value) for key, value in file["provenance"].attrs.items()}
        for name, values in self.series.items():
            # A series that an earlier version did not record is NaN until the run was resumed.
            known = numpy.flatnonzero(~numpy.isnan(values))
            always = len(values) == 0 or (len(known) and not numpy.isnan(values[known[0]:].sum()))
            expect("NaN if" in self.descriptions[name] or always,
                   f"{path} has NaN in the series {name}, which is always defined: the file is damaged")
            expect(values.shape == self.series["time"].shape,
                   f"{path} has other rows in the series {name} than in `time`: the file is damaged")
        try:
            self.deck = yaml_text(self.deck_text)["Tanktread"] or {}
        except (yaml.YAMLError, KeyError, TypeError):
            raise Mistake(f"{path} holds no deck: the file is damaged") from None
        self.summary = Named(parsed(summary, kind=dict), f"{summary} holds no") if summary.exists() else None

    def __repr__(self):
        return f"<Run {self.name}: {len(self.series['time'])} rows, particles {', '.join(self.particles)}>"

    name = property(lambda self: self.directory.resolve().name, doc="The name of the directory.")
    several = property(lambda self: any("/" in name for name in self.series), doc="Whether the deck has the section "
                       "Particles, so that series of one particle are named <particle>/<name>.")

    @property
    def particles(self):
        """The names of the particles in the order of the deck, without posts; ["particle"] if the deck has the section
        Particle."""
        return [name for name in self.bodies if self.kind(name).get("shape") != "cylinder"]

    def kind(self, name):
        """Returns the section of the deck that describes a body: `cell` for `cell 3`."""
        if not self.several:
            return self.deck.get("Particle", {})
        kinds = self.deck.get("Particles", {})
        return kinds.get(name) or kinds.get(re.sub(r" \d+$", "", name), {})

    @property
    def bodies(self):
        """The names of particles and posts in the order of the deck; ["particle"] if it has the section Particle."""
        if not self.several:
            return ["particle"]
        names = sorted({name.split("/")[0] for name in self.series if "/" in name}, key=lambda name: (len(name), name))
        of_kinds = [name for kind in self.deck.get("Particles", {}) for name in names  # `cell 3` is the third of `cell`
                    if re.fullmatch(rf"{re.escape(str(kind))}( \d+)?", name)]
        return list(dict.fromkeys(of_kinds))

    def of(self, particle, name):
        """Returns the series `name` (rows,) of one particle. `particle`: its name in `particles`."""
        return self.series[f"{particle}/{name}" if self.several else name]

    def expect_particles(self):
        """Raises Mistake if the scene has posts only."""
        expect(self.particles, f"{self.directory} has no particles, only posts")

    def expect_one_particle(self):
        """Raises Mistake if the deck has the section Particles."""
        expect(not self.several, f"{self.directory} has several particles, and this figure is of one particle")

    def control_points(self):
        """Returns the number of control points of all particles (rows,)."""
        self.expect_particles()
        return sum(self.of(particle, "n_control_points") for particle in self.particles)

    def _split(self):
        """Returns ({series: {particle: values (rows,)}}, {series of the scene: values})."""
        own, scene = {}, {}
        for name, values in self.series.items():
            particle, _, series = name.rpartition("/")
            if particle or (not self.several and OF_PARTICLE.fullmatch(name)):
                own.setdefault(series, {})[particle or "particle"] = values
            else:
                scene[name] = values
        return own, scene

    def frame(self, tidy=False):
        """Returns the series as a pandas.DataFrame with the index `time`, a column for each name in `series`, and the
        units and descriptions in its `attrs`. With tidy=True it has one row per time and particle, and the columns
        `time`, `particle` and the series of particles, also if there is only one particle. Needs pandas."""
        pandas = optional("pandas", "run.frame()")
        if not tidy:
            found = pandas.DataFrame(dict(self.series)).set_index("time")
            found.attrs = {"units": dict(self.units), "descriptions": dict(self.descriptions)}
            return found
        own, _ = self._split()
        parts = [pandas.DataFrame({"time": self.series["time"], "particle": one} | {
            name: values[one] for name, values in own.items() if one in values}) for one in self.bodies]
        return pandas.concat(parts, ignore_index=True)

    def dataset(self):
        """Returns the series as an xarray.Dataset. Series of particles have the dimensions (particle, time), also if
        there is only one particle; series of the scene have (time,). A series of the scene is renamed `scene_<name>` if
        a series of particles has the same name. Variables have the attributes `units` and `long_name`. Needs xarray."""
        xarray = optional("xarray", "run.dataset()")
        own, scene = self._split()
        time, variables = scene.pop("time"), {}
        about = {name: {"units": self.units[name], "long_name": self.descriptions[name]} for name in self.series}
        for name, values in own.items():
            rows = numpy.array([values.get(one, numpy.full(len(time), numpy.nan)) for one in self.bodies])
            variables[name] = ("particle", "time"), rows, about[f"{min(values)}/{name}" if self.several else name]
        for name, values in scene.items():
            variables[f"scene_{name}" if name in own else name] = ("time",), values, about[name]
        coordinates = {"time": ("time", time, about["time"]), "particle": self.bodies}
        return xarray.Dataset(variables, coordinates, {"deck": self.deck_text, "name": self.name} | self.provenance)

    def in_units(self, dimension):
        """Returns the unit of a dimension for labels of figures, such as ", µm/s" for length/time; "" if the deck has
        no section Units."""
        return self.unit(dimension) if self.deck.get("Units") else ""

    def unit(self, dimension):
        """Returns ", µm/s" for length/time; ", length/time" if the deck has no section Units; "" if there is no
        dimension."""
        if dimension in ("", "1", "of the key"):
            return ""
        units = (self.deck.get("Units") or {}).items()
        named = {key: value.removeprefix("1 ").replace("um", "µm") for key, value in units}
        dimension = dimension.replace("viscosity x length", "force x time/length")
        dimension = re.sub("stress|pressure", "force/length^2", dimension).replace(" x ", " ")
        words = re.sub("length|time|force", lambda word: named.get(word[0], word[0]), dimension)
        return ", " + re.sub(r"\^(\d)", lambda power: "⁰¹²³⁴"[int(power[1])], words)

    def axis(self, name):
        """Returns the axis label of a series: its name and, unless it is dimensionless, its unit."""
        return name + self.unit(self.units[name])

    def column(self, name):
        """Returns the heading of a series in a table: its name and, unless it is dimensionless, its unit in ASCII, such
        as "velocity_x1 (um/s)"."""
        unit = self.unit(self.units[name]).removeprefix(", ").replace("µ", "u")
        unit = re.sub("[⁰¹²³⁴]", lambda power: f"^{'⁰¹²³⁴'.index(power[0])}", unit)
        return f"{name} ({unit})" if unit else name

    @property
    def rate(self):
        """The rate of the flow (1/time), by which times are multiplied to be dimensionless, and its name; (1, None) if
        the flow has no rate. In a parabolic flow it is the maximum velocity divided by the half width. In a duct it is
        the mean velocity divided by the radius of a circle with the area of the duct's cross-section."""
        kind = self.value("Flow/type")
        if kind == "duct":
            duct = arrays_of(self.directory / "duct.h5")
            return float(duct["mean_velocity"] / duct["radius"]), "mean velocity / tube radius"
        if kind == "linear":
            return float(numpy.linalg.norm(numpy.array(self.value("Flow/gradient"), float).reshape(3, 3), 2)), "rate"
        if kind == "parabolic":
            width = float(self.value("Flow/half width"))
            return float(self.value("Flow/maximum velocity", 1)) / width, "maximum velocity / half width"
        return (float(self.value("Flow/shear rate", 1)), RATES[kind]) if kind in RATES else (1.0, None)

    time_scale = property(lambda self: 1 if "Continuation" in self.deck else self.rate[0],
                          doc="The factor by which times of the deck and of the series are multiplied in figures.")

    time = property(lambda self: self.series["time"] * self.time_scale,
                    doc="Times of the series (rows,), multiplied by `rate`, or numbers of points on a branch: see "
                    "`time_label`.")

    @property
    def time_label(self):
        """The axis label of `time`."""
        if "Continuation" in self.deck:
            return "number of the point"
        name = self.rate[1]
        return f"time · {name}" if name else f"time{self.in_units('time') or ', in the unit of the deck'}"

    def moment(self, time, form="g"):
        """Returns "t = 0.5", with the unit if the deck has units, or "point 5" on a branch, for titles of figures.
        `form`: format of the time."""
        unit = self.in_units("time").replace(",", "")
        return f"point {time:.0f}" if "Continuation" in self.deck else f"t = {time:{form}}{unit}"

    @property
    def radius(self):
        """R_C: radius of the sphere with the volume of the first particle; without particles, of the first post."""
        if not self.particles:
            return float(self.values_of("Particle/radius")[0])
        numbers = (self.summary or {}).get("numbers") or {}
        if "radius" in numbers and not self.several:
            return float(numbers["radius"])
        volume = self.of(self.particles[0], "volume")[0] if self.several else self.snapshot_at(0).volume()
        return float(3 * volume / (4 * numpy.pi)) ** (1 / 3)

    def scale(self, dimension):
        """Returns the scale by which a length, velocity, stress, curvature or tension is divided to be dimensionless,
        and its symbol. The scale of lengths is R_C. The scale of stresses is the viscosity times the rate of the flow;
        if the flow has no rate, the modulus of the first membrane or interface divided by R_C; for rigid bodies, the
        viscosity times the largest prescribed speed divided by R_C; if no speed is prescribed, the viscosity divided by
        the unit of time of the deck. Tensions in snapshots are dimensionless already."""
        radius, viscosity = self.radius, float(self.value("Flow/viscosity", 1))
        rate, words = self.rate
        symbol = "σ" if "surface tension" in self.values_of("Membrane/law")[:1] else "G$_s$"
        moduli = self.values_of("Membrane/surface tension" if symbol == "σ" else "Membrane/shear modulus")
        speeds = [numpy.linalg.norm(speed) / radius for speed in self.values_of("Particle/velocity")]
        speeds += [numpy.linalg.norm(speed) for speed in self.values_of("Particle/angular velocity")]
        if words:
            stress, velocity = f"(μ · {words})", f"({words} · R$_C$)"
        elif moduli:
            rate, stress, velocity = float(moduli[0]) / (viscosity * radius), f"({symbol} / R$_C$)", f"({symbol} / μ)"
        elif any(speeds):
            rate, stress, velocity = float(max(speeds)), "(μ · speed / R$_C$)", "speed"
        else:
            time = self.in_units("time").removeprefix(", ") or "unit of time"
            rate, stress, velocity = 1.0, f"(μ / {time})", f"(R$_C$ / {time})"
        return {"length": (radius, " / R$_C$"), "velocity": (rate * radius, f" / {velocity}"),
                "stress": (viscosity * rate, f" / {stress}"), "curvature": (1 / radius, " · R$_C$"),
                "tension": (1.0, f" / {symbol}")}.get(dimension, (1.0, ""))

    def label(self, field, pattern="{}"):
        """Returns the axis label of a dimensionless field. `pattern`: format of its name, such as `|{}|`."""
        return pattern.format(field) + self.scale(DIMENSIONS.get(field))[1]

    def value(self, path, default=None):
        """Returns the value of one key of the deck: `value("Membrane/capillary number")`."""
        found = self.deck
        for part in path.split("/"):
            found = found.get(part, default) if isinstance(found, dict) else default
        return found

    def values_of(self, path):
        """Returns the values of a key of a particle, such as `Membrane/law` or `Particle/velocity`, for all particles
        of the deck that set it, in the order of the deck."""
        if not self.several:
            return [value for value in [self.value(path)] if value is not None]
        own = [f"Particles/{name}/{path.removeprefix('Particle/')}" for name in self.deck["Particles"]]
        return [value for value in map(self.value, own) if value is not None]

    def value_of(self, key):
        """Returns the value of a key in the effective deck; None if the particles have different values. The key may
        be in Particles/defaults, a section that the effective deck does not have."""
        own = key.removeprefix("Particles/defaults/")
        values = self.values_of(own) if own != key else [self.value(key)]
        return values[0] if all(value == values[0] for value in values) and values else None

    def cell(self, time):
        """Returns the vectors of the periodic cell at a time, divided by R_C, as rows (3, 3); None if there is none."""
        if "cell_1_x1" not in self.series:
            return None
        row = numpy.abs(self.series["time"] - time).argmin()
        vectors = [[self.series[f"cell_{k}_x{i}"][row] for i in (1, 2, 3)] for k in (1, 2, 3)]
        return numpy.array(vectors) / self.scale("length")[0]

    def defined(self, name):
        """Returns times and values of a series at the rows where it is defined (not NaN)."""
        known = ~numpy.isnan(self.series[name])
        return self.series["time"][known], self.series[name][known]

    def band(self, name):
        """Returns the limits (rows,) of a series: value minus and plus estimated error; None if there is no error."""
        error = self.errors.get(name, numpy.nan)
        return (self.series[name] - error, self.series[name] + error) if numpy.isfinite(error).any() else None

    def snapshots(self):
        """Returns the list of Snapshots in order of time. The file of each is read when its data are first used."""
        series = self.directory / "run.hdf.series"
        files = Named(parsed(series, json.loads, dict), f"{series} holds no")["files"] if series.exists() else []
        try:
            return [Snapshot(self.directory / one["name"], float(one["time"]), self.particles) for one in files]
        except (TypeError, ValueError, KeyError):
            raise Mistake(f"{series} is damaged: a snapshot has no name or time") from None

    def snapshot_at(self, time):
        """Returns the Snapshot nearest to a time (None: the last one). Raises Mistake if there is none."""
        saved = self.snapshots()
        expect(saved, f"{self.directory} holds no snapshots")
        return saved[-1] if time is None else min(saved, key=lambda one: abs(one.time - time))


def time_label(runs):
    """Returns the label of a time axis for several runs."""
    return " or ".join(dict.fromkeys(one.time_label for one in runs))


def field_label(runs, field, pattern="{}"):
    """Returns the axis label of a dimensionless field for several runs."""
    return " or ".join(dict.fromkeys(one.label(field, pattern) for one in runs))
