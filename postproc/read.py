#!/usr/bin/python3
"""Results of a run as numpy arrays: `read.run("results/shear")`. As a program it lists what a run recorded.

    import read
    run = read.run("results/shear_neo_hookean")   # or a deck, which is run when it has no results yet
    run.series["taylor_inertia"]       # one value a step, with .units[...] and .descriptions[...]
    run.deck["Flow"]["type"]           # the effective deck
    last = run.snapshots()[-1]         # a saved step
    last.fields["traction"]            # at the nodes of its cells
    run.time, run.time_label           # of the series, times the rate of the flow
    last.scaled(run).fields["traction"], run.label("traction")    # the same without units, as pictures have it
"""

import argparse
import json
import os
import pathlib
import subprocess
import sys

import needs  # before what it looks for
import h5py
import numpy
import yaml

SOURCE = pathlib.Path(__file__).resolve().parents[1]
PROGRAM = pathlib.Path(os.environ.get("TANKTREAD") or SOURCE / "build" / "release" / "app" / "tanktread")


DIMENSIONS = {"traction": "stress", "load": "stress", "pressure": "stress", "pressure error": "stress", "displacement": "length", "velocity": "velocity",
              "smallest tension": "tension", "largest tension": "tension", "mean curvature": "curvature"}  # of fields


class Run:
    """`series`, `units`, `descriptions` by name, `<particle>/<name>` of one of several particles; `deck`, the effective deck as nested dicts; `provenance`; `summary` (None before the end)."""

    def __init__(self, directory):
        self.directory = pathlib.Path(directory)
        with h5py.File(self.directory / "run.h5", "r") as file:
            found = _datasets(file["series"])
            self.series = {name: data[:] for name, data in found.items()}
            self.units = {name: _text(data.attrs["unit"]) for name, data in found.items()}
            self.descriptions = {name: _text(data.attrs["description"]) for name, data in found.items()}
            self.deck_text = _text(file["deck"][()])
            self.provenance = {key: _text(value) for key, value in file["provenance"].attrs.items()}
        self.deck = (yaml.safe_load(self.deck_text) or {}).get("Tanktread", {})
        summary = self.directory / "summary.yaml"
        self.summary = yaml.safe_load(summary.read_text(encoding="utf-8")) if summary.exists() else None

    @property
    def name(self):
        return self.directory.resolve().name

    @property
    def particles(self):
        """The names of several particles, in the order of the deck; none where there is one."""
        names = {name.split("/")[0] for name in self.series if "/" in name}
        kinds = list(self.deck.get("Particles", {}))
        return sorted(names, key=lambda name: min(((k, int(name[len(kind):] or 0)) for k, kind in enumerate(kinds)
                                                   if name == kind or (name.startswith(kind + " ") and name[len(kind):].strip().isdigit())),
                                                  default=(len(kinds), 0)))

    @property
    def rate(self):
        """What makes time a number: the rate of the flow, of a parabolic one its maximum velocity over its half width, in a duct its mean velocity over the
        duct's radius (of equal area); with its name. (1, None) where the flow has no rate."""
        kind = self.value("Flow/type")
        if kind == "duct":
            with h5py.File(self.directory / "duct.h5", "r") as file:
                return float(file["mean_velocity"][()] / file["radius"][()]), "mean velocity / tube radius"
        if kind == "linear":
            gradient = numpy.reshape(numpy.array(self.value("Flow/gradient"), float), (3, 3))
            return float(numpy.linalg.norm(gradient, 2)), "rate"
        if kind == "parabolic":
            return float(self.value("Flow/maximum velocity", 1)) / float(self.value("Flow/half width")), "maximum velocity / half width"
        rates = {"simple shear": "shear rate", "four-roll": "rate", "planar hyperbolic": "rate", "uniaxial extension": "rate"}
        return (float(self.value("Flow/shear rate", 1)), rates[kind]) if kind in rates else (1.0, None)

    @property
    def time(self):
        """Of the series, without a unit where the flow has a rate: what `time_label` says."""
        return self.series["time"] * self.rate[0]

    @property
    def time_label(self):
        name = self.rate[1]
        return f"time · {name}" if name else "time, in the deck's unit"

    @property
    def radius(self):
        """R_C, of the sphere of equal volume; of several particles the first one's."""
        if self.particles:
            return float(3 * self.series[f"{self.particles[0]}/volume"][0] / (4 * numpy.pi)) ** (1 / 3)
        if self.summary and "numbers" in self.summary:
            return float(self.summary["numbers"]["radius"])
        return self.snapshots()[0].volume() ** (1 / 3) * (3 / (4 * numpy.pi)) ** (1 / 3)

    def scale(self, dimension):
        """What a length, velocity, stress or curvature is divided by to be a number, and how that is written: R_C, and the viscosity times the rate of the
        flow; where it has no rate the modulus over R_C, or of a rigid body the viscosity times its speed over R_C. Tensions are numbers already."""
        radius, viscosity = self.radius, float(self.value("Flow/viscosity", 1))
        rate, words = self.rate
        symbol = "σ" if self.value("Membrane/law") == "surface tension" else "G$_s$"
        modulus = float(self.value("Membrane/shear modulus") or self.value("Membrane/surface tension") or 0)
        if words:
            stress, velocity = f"(μ · {words})", f"({words} · R$_C$)"
        elif modulus:
            rate, stress, velocity = modulus / (viscosity * radius), f"({symbol} / R$_C$)", f"({symbol} / μ)"
        else:
            speeds = [numpy.linalg.norm(self.value(f"Particle/{key}", 0)) for key in ("velocity", "angular velocity")]
            rate, stress, velocity = float(max(speeds[0] / radius, speeds[1]) or 1), "(μ · speed / R$_C$)", "speed"
        return {"length": (radius, " / R$_C$"), "curvature": (1 / radius, " · R$_C$"), "velocity": (rate * radius, " / " + velocity),
                "stress": (viscosity * rate, " / " + stress), "tension": (1.0, " / " + symbol)}.get(dimension, (1.0, ""))

    def label(self, field, pattern="{}"):
        """What is on the axis of a field without units; `pattern` such as `|{}|`."""
        return pattern.format(field) + self.scale(DIMENSIONS.get(field))[1]

    def value(self, path, default=None):
        """One key of the deck: `value("Membrane/capillary number")`."""
        node = self.deck
        for part in path.split("/"):
            if not isinstance(node, dict) or part not in node:
                return default
            node = node[part]
        return node

    def require(self, *names):
        """Ends the program with one sentence unless the run recorded these series."""
        for name in names:
            if name not in self.series:
                sys.exit(f"{self.directory} holds no series {name}; there are: {', '.join(sorted(self.series))}")

    def snapshots(self):
        """The saved steps, in order of time; each is read when it is used."""
        series = self.directory / "run.hdf.series"
        if not series.exists():
            return []
        return [Snapshot(self.directory / entry["name"], entry["time"]) for entry in json.loads(series.read_text())["files"]]

    def snapshot_at(self, time):
        """The saved step nearest to a time (None: the last one)."""
        saved = self.snapshots()
        if not saved:
            raise FileNotFoundError(f"{self.directory} holds no snapshots")
        return saved[-1] if time is None else min(saved, key=lambda one: abs(one.time - time))


class Snapshot:
    """A saved step. `points` (n, 3) and `fields` {name: (n,) or (n, k)} at the nodes; `cells`: node numbers of each Lagrange quadrilateral."""

    def __init__(self, path, time):
        self.path, self.time = pathlib.Path(path), time
        self._content = None

    def _read(self):
        if self._content is None:
            with h5py.File(self.path, "r") as file:
                grid = file["VTKHDF"]
                connectivity, offsets = grid["Connectivity"][:], grid["Offsets"][:]
                cells = [connectivity[a:b] for a, b in zip(offsets[:-1], offsets[1:])]
                fields = {name: data[:] for name, data in grid["PointData"].items()}
                self._content = grid["Points"][:], cells, fields
        return self._content

    points = property(lambda self: self._read()[0])
    cells = property(lambda self: self._read()[1])
    fields = property(lambda self: self._read()[2])

    def scaled(self, run):
        """The same without units: lengths over R_C, fields as `run.label` says."""
        copy = Snapshot(self.path, self.time)
        points = self.points / run.scale("length")[0]
        copy._content = points, self.cells, {name: values / run.scale(DIMENSIONS.get(name))[0] for name, values in self.fields.items()}
        return copy

    def volume(self, k=16):
        """By k^2 facets a cell."""
        grid = self.sampled(self.points, k)
        a, b, c, d = grid[:, :-1, :-1], grid[:, :-1, 1:], grid[:, 1:, 1:], grid[:, 1:, :-1]
        return abs(sum(numpy.einsum("...i,...i", x, numpy.cross(y, z)).sum() for x, y, z in ((a, b, c), (a, c, d)))) / 6

    def checkpoint(self):
        """What the run goes on from: {"arrays": {...}, "numbers": {...}, "texts": {...}}."""
        with h5py.File(self.path, "r") as file:
            root = file["checkpoint"]
            return {
                "arrays": {name: data[:] for name, data in root["arrays"].items()},
                "numbers": {name: float(data[()]) for name, data in root["numbers"].items()},
                "texts": {name: _text(data[()]) for name, data in root["texts"].items()},
            }

    def sampled(self, values, k=8, cells=None):
        """A field at the (k + 1)^2 points of a uniform grid on every cell, or on `cells` (numbers): shape (cells, k + 1, k + 1[, components]);
        t first, then s.

        Exact: a cell holds the polynomial of its element.
        """
        values = numpy.asarray(values)
        chosen = self.cells if cells is None else [self.cells[i] for i in cells]
        result = numpy.empty((len(chosen), k + 1, k + 1) + values.shape[1:], values.dtype)
        for n in {len(cell) for cell in chosen}:
            which = [i for i, cell in enumerate(chosen) if len(cell) == n]
            table = _lagrange_table(int(round(n**0.5)) - 1, k).astype(values.dtype)
            nodes = values[numpy.array([chosen[i] for i in which])]
            sampled = table @ nodes.reshape(len(which), n, -1)
            result[which] = sampled.reshape((len(which), k + 1, k + 1) + values.shape[1:])
        return result


def run(where):
    """The run whose results stand in a directory, or those of a deck (a .yaml file), which is run when it has none. One sentence and the end of the
    program where that fails."""
    directory = results_of(where) if str(where).endswith(".yaml") else where
    try:
        return Run(directory)
    except FileNotFoundError:
        sys.exit(f"{directory} holds no run.h5: give the directory of a run's results, or a deck")
    except OSError as error:
        sys.exit(f"{directory}/run.h5 cannot be read: {error}")


def results_of(deck, name=None, settings=None, accepted=(0, 1)):
    """Where the results of a deck stand, run with settings {"Section/key": value}: results/<name>, by default that of the deck. It is run when there
    are none. `accepted`: exit codes; 1 is a missed expectation, which a picture shows."""
    directory = pathlib.Path("results") / (name or pathlib.Path(deck).stem)
    if not (directory / "run.h5").exists():
        if not PROGRAM.exists():
            sys.exit(f"{PROGRAM} does not exist, so {deck} cannot be run: app/quickstart builds it; TANKTREAD=... names another one")
        words = [str(deck)] + [word for key, value in (settings or {}).items() for word in ("--set", f"{key}={value}")] + ["--output", str(directory)]
        print(PROGRAM.name, *words, file=sys.stderr)
        code = subprocess.run([PROGRAM, *words, "--quiet"], check=False).returncode
        if code not in accepted:
            sys.exit(f"{deck} did not run to its end (exit code {code}); nothing is drawn")
    return directory


def time_label(runs):
    """What is on the axis of time of several runs."""
    return " or ".join(dict.fromkeys(one.time_label for one in runs))


def field_label(runs, field, pattern="{}"):
    """What is on the axis of a field of several runs, without units."""
    return " or ".join(dict.fromkeys(one.label(field, pattern) for one in runs))


def _datasets(group):
    """All below a group of HDF5, by their paths."""
    found = {}
    group.visititems(lambda name, item: found.update({name: item}) if isinstance(item, h5py.Dataset) else None)
    return found


def _text(value):
    return value.decode("utf-8") if isinstance(value, bytes) else str(value)


def node_order(p):
    """(i, j) of the nodes of a Lagrange quadrilateral, as lib/output/lagrange.hpp states it."""
    inner = range(1, p)
    edges = [(i, 0) for i in inner] + [(p, j) for j in inner] + [(i, p) for i in inner] + [(0, j) for j in inner]
    return [(0, 0), (p, 0), (p, p), (0, p)] + edges + [(i, j) for j in inner for i in inner]


def _lagrange_table(p, k):
    """Lagrange polynomials of the nodes at the uniform grid: shape ((k + 1)^2, (p + 1)^2)."""
    nodes, grid = numpy.arange(p + 1) / p, numpy.arange(k + 1) / k
    line = numpy.ones((k + 1, p + 1))
    for i in range(p + 1):
        for other in range(p + 1):
            if other != i:
                line[:, i] *= (grid - nodes[other]) / (nodes[i] - nodes[other])
    return numpy.array([numpy.outer(line[:, j], line[:, i]).ravel() for i, j in node_order(p)]).T


def main():
    parser = argparse.ArgumentParser(description="List what a run recorded.")
    parser.add_argument("results", help="directory of a run's results, or a deck")
    parser.add_argument("-s", "--series", nargs="+", metavar="NAME", help="print these series, one line a step, instead of the list")
    arguments = parser.parse_args()
    result = run(arguments.results)
    if arguments.series:
        unknown = [name for name in arguments.series if name not in result.series]
        if unknown:
            sys.exit(f"no series {unknown[0]}; there are: {', '.join(sorted(result.series))}")
        for values in zip(*(result.series[name] for name in arguments.series)):
            print(*(f"{value:.16g}" for value in values))
        return
    print(f"{result.name}: {len(result.series['time'])} rows, {len(result.snapshots())} snapshots")
    for name, values in sorted(result.series.items()):
        print(f"  {name:24} {values[-1] if len(values) else float('nan'):14.7g}  {result.units[name]:14}  {result.descriptions[name]}")


if __name__ == "__main__":
    main()
