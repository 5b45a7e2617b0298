"""Runs of the program from Python, and their results as numpy arrays. numpy, h5py and PyYAML are all it needs.

    import sys; sys.path.append("postproc")
    import tanktread

    # 1. a deck with keys changed; made once, and found again
    run = tanktread.run("inputs/shear_neo_hookean.yaml", {"Membrane/capillary number": 0.2, "Surface/elements per side": 6})
    run.series["taylor_inertia"]       # one value a step, with .units[...] and .descriptions[...]
    run.deck["Flow"]["type"]           # the effective deck
    run.time, run.time_label           # of the series, times the rate of the flow

    # 2. results that are there, and a saved step
    last = tanktread.run("results/shear_neo_hookean").snapshots()[-1]
    last.fields["traction"]            # at the nodes of its cells
    last.evaluate(last.points, [0, 0], [0.5, 0.25], [0.5, 0.5])    # places of cell 0 at parameters s, t, exactly
    last.scaled(run).fields["traction"], run.label("traction")     # the same without units, as pictures have it

    # 3. many runs side by side; one that fails does not stop the others
    study = tanktread.Study(directory="results/mine", jobs=2)
    outcomes = study.all([("inputs/shear_neo_hookean.yaml", {"Membrane/capillary number": ca}) for ca in (0.1, 0.2, 0.3)])
    [one.final["taylor_inertia"] for one in outcomes if one.done]
"""

import concurrent.futures
import hashlib
import itertools
import json
import math
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import time

import h5py
import numpy
import yaml

SOURCE = pathlib.Path(__file__).resolve().parents[1]
PROGRAM = pathlib.Path(os.environ.get("TANKTREAD") or SOURCE / "build" / "release" / "app" / "tanktread")
if not PROGRAM.exists():
    PROGRAM = pathlib.Path(shutil.which("tanktread") or PROGRAM)  # the one that is installed
ENVIRONMENT = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}

DIMENSIONS = {"traction": "stress", "load": "stress", "pressure": "stress", "pressure error": "stress", "displacement": "length", "velocity": "velocity",
              "into cell": "length", "smallest tension": "tension", "largest tension": "tension", "mean curvature": "curvature"}  # of fields


class Run:
    """`series`, `units`, `descriptions` by name, `<particle>/<name>` of one of several particles (a series is NaN where it is undefined, as its description states); `deck`, the effective deck as nested dicts; `provenance`; `summary` (None before the end)."""

    def __init__(self, directory):
        self.directory = pathlib.Path(directory)
        with h5py.File(self.directory / "run.h5", "r") as file:
            found = _datasets(file["series"])
            self.series = {name: data[:] for name, data in found.items()}
            self.units = {name: _text(data.attrs["unit"]) for name, data in found.items()}
            self.descriptions = {name: _text(data.attrs["description"]) for name, data in found.items()}
            self.deck_text = _text(file["deck"][()])
            self.provenance = {key: _text(value) for key, value in file["provenance"].attrs.items()}
        self.deck = (_loaded(self.deck_text) or {}).get("Tanktread", {})
        summary = self.directory / "summary.yaml"
        self.summary = _loaded(summary.read_text(encoding="utf-8")) if summary.exists() else None

    @property
    def name(self):
        return self.directory.resolve().name

    def in_units(self, dimension):
        """", µm/s" for length/time where the deck has the list Units, for the labels of figures; otherwise nothing."""
        units = self.deck.get("Units") or {}
        named = {key: value.removeprefix("1 ").replace("um", "µm") for key, value in units.items()}
        dimension = dimension.replace("viscosity x length", "force x time/length").replace("stress", "force/length^2").replace(" x ", " ")
        return ", " + re.sub("length|time|force", lambda word: named[word[0]], dimension).replace("^2", "²") if named and dimension else ""

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

    def cell(self, time):
        """Of a lattice the three vectors, as rows, of the cell that repeats, over R_C; None without one."""
        if "cell_1_x1" not in self.series:
            return None
        row = numpy.abs(self.series["time"] - time).argmin()
        return numpy.array([[self.series[f"cell_{k}_x{i}"][row] for i in (1, 2, 3)] for k in (1, 2, 3)]) / self.scale("length")[0]

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
        self.cell = None  # of a lattice, in one that is `scaled`
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

    @property
    def places(self):
        """The nodes as they are drawn: `points`, of a lattice those in the cell around the origin."""
        return self.points if self.cell is None else self.points + self.fields["into cell"]

    @property
    def frame(self):
        """Points whose extent is that of a picture: `points`, of a lattice the corners of the cell, first along its third vector."""
        return self.points if self.cell is None else numpy.array(list(itertools.product((-0.5, 0.5), repeat=3))) @ self.cell

    def scaled(self, run):
        """The same without units: lengths over R_C, fields as `run.label` says."""
        copy = Snapshot(self.path, self.time)
        points = self.points / run.scale("length")[0]
        copy.cell = run.cell(self.time)
        copy._content = points, self.cells, {name: values / run.scale(DIMENSIONS.get(name))[0] for name, values in self.fields.items()}
        return copy

    def evaluate(self, values, cells, s, t, ds=0, dt=0):
        """A field (n,) or (n, k) at parameters s, t (each in [0, 1]) of `cells` (numbers), all of the same length m: shape (m,) or (m, k). `ds`, `dt`: how
        often it is differentiated by them. Exact: a cell holds the polynomial of its element; node (i, j) of one of degree p lies at (i/p, j/p)."""
        values, cells, s, t = numpy.asarray(values), numpy.asarray(cells), numpy.asarray(s, float), numpy.asarray(t, float)
        result = numpy.empty((len(cells),) + values.shape[1:])
        sizes = numpy.array([len(self.cells[cell]) for cell in cells])
        for n in set(sizes.tolist()):
            which = numpy.flatnonzero(sizes == n)
            p = round(n**0.5) - 1
            i, j = numpy.array(node_order(p)).T
            table = _lagrange(p, s[which], ds)[:, i] * _lagrange(p, t[which], dt)[:, j]
            nodes = values[numpy.array([self.cells[cell] for cell in cells[which]])]
            result[which] = numpy.einsum("mn,mn...->m...", table, nodes)
        return result

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


def run(where, settings=None):
    """The run whose results stand in a directory, or those of a deck (a .yaml file), which is run when it has none; of a deck with keys changed,
    {"Section/key": value}, under results/ by a name that follows from both. One sentence and the end of the program where that fails."""
    if settings:
        outcome = Study(directory="results").run(where, settings)
        if not outcome.done:
            sys.exit(f"{where} did not run to its end: {outcome.message}")
        return outcome.run
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


def _loaded(text):
    return yaml.load(text, getattr(yaml, "CSafeLoader", yaml.SafeLoader))  # the former is ten times as fast


def _datasets(group):
    """All below a group of HDF5, by their paths."""
    found = {}
    group.visititems(lambda name, item: found.update({name: item}) if isinstance(item, h5py.Dataset) else None)
    return found


def _text(value):
    return value.decode("utf-8") if isinstance(value, bytes) else str(value)


def node_order(p):
    """(i, j) of the nodes of a Lagrange quadrilateral, as lib/record/files/lagrange.hpp states it."""
    inner = range(1, p)
    edges = [(i, 0) for i in inner] + [(p, j) for j in inner] + [(i, p) for i in inner] + [(0, j) for j in inner]
    return [(0, 0), (p, 0), (p, p), (0, p)] + edges + [(i, j) for j in inner for i in inner]


def _lagrange(p, x, derivative=0):
    """Derivatives of the p + 1 Lagrange polynomials of the nodes i/p at the places x: shape (len(x), p + 1)."""
    coefficients = numpy.linalg.inv(numpy.vander(numpy.arange(p + 1) / p, increasing=True))
    for _ in range(derivative):
        coefficients = coefficients[1:] * numpy.arange(1, len(coefficients))[:, None]
    return numpy.vander(x, len(coefficients), increasing=True) @ coefficients


def _lagrange_table(p, k):
    """Lagrange polynomials of the nodes at the uniform grid: shape ((k + 1)^2, (p + 1)^2)."""
    line = _lagrange(p, numpy.arange(k + 1) / k)
    return numpy.array([numpy.outer(line[:, j], line[:, i]).ravel() for i, j in node_order(p)]).T


class Outcome:
    """How a run ended: `done` (to its end, whatever it expected), `failed`, `refused` (a mistake in the deck) or `slow` (stopped at the time limit).
    `message`: its last line on standard error. `series`, `final` and `counts` hold what it recorded, as far as it came."""

    def __init__(self, directory, note):
        self.directory, self.message, self.seconds = pathlib.Path(directory), note["message"], note["seconds"]
        self.processor_seconds = note.get("processor_seconds", math.nan)  # of all ranks
        self.code, self.command = note["code"], note["command"]
        self._run = None

    done = property(lambda self: self.code in (0, 1) and (self.directory / "summary.yaml").exists())
    failed = property(lambda self: not (self.done or self.refused or self.slow))
    refused = property(lambda self: self.code == 2)
    slow = property(lambda self: self.code in (None, 4))

    @property
    def run(self):
        if self._run is None:
            self._run = Run(self.directory)
        return self._run

    series = property(lambda self: self.run.series)
    counts = property(lambda self: self.run.summary["counts"])
    final = property(lambda self: self.run.summary["final"])
    phases = property(lambda self: self.run.summary["seconds"])

    @property
    def kernel_evaluations(self):
        return sum(value for name, value in self.counts.items() if name.startswith("kernel_evaluations"))

    @property
    def end(self):
        """Simulated time that the run came to."""
        try:
            return float(self.series["time"][-1])
        except (OSError, IndexError):
            return 0.0


def deck_at(name):
    """Where a deck is, as a whole path: looked for from where the script is started, then from the source directory."""
    found = next((place for place in (pathlib.Path(name), SOURCE / name) if place.is_file()), None)
    if found is None:
        sys.exit(f"{name}: there is no such deck")
    return found.resolve()


class Study:
    """Runs of decks with keys changed: made once, kept in `directory`, and found again by what they are made of. `limit`: processor seconds that one
    run may take (None: any). `jobs`: runs at a time. `fresh`: makes also those that are there."""

    def __init__(self, program=None, directory="results/study", limit=None, jobs=1, fresh=False):
        self.program, self.directory, self.limit, self.jobs, self.fresh = pathlib.Path(program or PROGRAM), pathlib.Path(directory), limit, jobs, fresh
        self._made, self._running = set(), set()
        self._manual = None

    def run(self, decks, settings, ranks=1):
        """The outcome of `tanktread decks… --set …`. `decks`: a path (`deck_at`), or several; `settings`: {"Section/key": value}.
        One that a signal stopped goes on from its checkpoint."""
        decks = [decks] if isinstance(decks, (str, pathlib.Path)) else list(decks)
        where = self.directory / self.name(decks, settings, ranks)
        note = where / "outcome.json"
        before = Outcome(where, json.loads(note.read_text())) if note.exists() else None
        if before and (where in self._made or not self.fresh) and self._stands(before):
            return before
        self._made.add(where)
        launcher = ["mpirun", "--oversubscribe", "-n", str(ranks)] if ranks > 1 else []
        if before and before.code == 4 and not self.fresh:
            words = ["--resume", str(where)]
        else:
            shutil.rmtree(where, ignore_errors=True)  # of an earlier program, or broken off
            where.mkdir(parents=True)
            words = [str(deck_at(deck)) for deck in decks] + [word for key, value in settings.items() for word in ("--set", f"{key}={text_of(value)}")]
            words += ["--output", str(where)]
        made = self._make(launcher + [str(self.program)] + words + ["--quiet"])
        partial = note.with_suffix(".part")  # a note is whole, or there is none
        partial.write_text(json.dumps(made))
        partial.rename(note)
        return Outcome(where, made)

    def _stands(self, outcome):
        """Whether a run need not be made again: another program may know the keys that this one refused, and one that was stopped can go on."""
        never_began = outcome.refused or not (outcome.directory / "run.h5").exists()
        return outcome.directory in self._made or not (never_began or outcome.code == 4)

    def _make(self, words):
        if not self.program.exists():
            sys.exit(f"{self.program} does not exist: build it (cmake --workflow --preset release), or name another one: TANKTREAD=...")
        start = time.monotonic()
        bounds = ["setpriv", "--pdeathsig", "KILL"]  # who is killed leaves no run behind that writes where the next one wants to
        bounds += ["prlimit", f"--cpu={math.ceil(self.limit)}"] if self.limit else []
        with subprocess.Popen(bounds + words, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, env=os.environ | ENVIRONMENT) as process:
            self._running.add(process)
            said = process.stderr.read().strip().splitlines()
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = code = os.waitstatus_to_exitcode(status)
            self._running.discard(process)
        if code < 0 or code > 4:  # killed, by the limit
            code, said = None, [f"stopped after {self.limit:g} s of processor time" if self.limit else f"killed by signal {-code}"]
        return {"code": code, "message": said[-1] if said else "", "seconds": time.monotonic() - start,
                "processor_seconds": usage.ru_utime + usage.ru_stime, "command": " ".join(map(quoted, words))}

    @staticmethod
    def name(decks, settings, ranks=1):
        """Of a run's directory, by the content of the decks and the settings: a run of a deck that has changed is another run."""
        texts = [deck_at(deck).read_text() for deck in decks]
        text = json.dumps([texts, {key: text_of(value) for key, value in sorted(settings.items())}, ranks])
        return pathlib.Path(decks[-1]).stem + "_" + hashlib.sha1(text.encode()).hexdigest()[:12]

    def all(self, jobs, told=lambda outcome: None):
        """Outcomes of many (decks, settings[, ranks]), as many at a time as the study has `jobs`, in their order; `told` of each when it ends. An
        interrupt stops the runs, which leave checkpoints."""
        with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
            futures = [pool.submit(self.run, *job) for job in jobs]
            try:
                for future in concurrent.futures.as_completed(futures):
                    told(future.result())
            except BaseException:
                pool.shutdown(wait=False, cancel_futures=True)
                for process in list(self._running):
                    process.send_signal(signal.SIGTERM)
                raise
            return [future.result() for future in futures]

    def map(self, function, items):
        """function of every item, as many at a time as `all` has runs."""
        with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
            return list(pool.map(function, items))

    def knows(self, key, word=None):
        """Whether this program's manual has a key, and in its row a word (a choice)."""
        row = self._row(key)
        return row is not None and (word is None or f"`{word}`" in row)

    def dimension(self, key):
        """Of a key's values, in words: force/length; "" of a number and of what the manual does not know."""
        row = self._row(key)
        unit = row.split("|")[4].strip() if row else ""
        return "" if unit == "1" else unit

    def _row(self, key):
        """Of a key in this program's manual, or None."""
        if self._manual is None:
            self._manual = subprocess.run([str(self.program), "--reference"], capture_output=True, text=True, check=True).stdout
        section, name = key.rsplit("/", 1)
        body = self._manual.partition(f"\n## {section}\n")[2].partition("\n## ")[0]
        return next((row for row in body.splitlines() if row.startswith(f"| `{name}`")), None)

    def schemes(self, wanted):
        """Those of the schemes that this program has."""
        return [scheme for scheme in wanted if self.knows("Time/scheme", scheme)]


def quoted(word):
    return f"'{word}'" if " " in word else word


def text_of(value):
    """A value as the command line has it."""
    if isinstance(value, bool):
        return "true" if value else "false"
    return f"{value:.15g}" if isinstance(value, float) else str(value)
