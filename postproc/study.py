"""Runs of the program with keys of their decks changed: made once, kept, and found again by what they are made of."""

import concurrent.futures
import hashlib
import json
import math
import os
import pathlib
import resource
import shutil
import subprocess
import sys
import time

import read
from read import SOURCE

ENVIRONMENT = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


class Outcome:
    """How a run ended: `done` (to its end, whatever it expected), `failed`, `refused` (a mistake in the deck) or `slow` (stopped at the time limit).
    `message`: its last line on standard error. `series`, `final` and `counts` hold what it recorded, as far as it came."""

    def __init__(self, directory, note):
        self.directory, self.message, self.seconds = pathlib.Path(directory), note["message"], note["seconds"]
        self.processor_seconds = note.get("processor_seconds", math.nan)  # of all ranks; of all runs at a time where there were several
        self.code, self.command = note["code"], note["command"]
        self._run = None

    done = property(lambda self: self.code in (0, 1) and (self.directory / "summary.yaml").exists())
    failed = property(lambda self: not (self.done or self.refused or self.slow))
    refused = property(lambda self: self.code == 2)
    slow = property(lambda self: self.code in (None, 4))

    @property
    def run(self):
        if self._run is None:
            self._run = read.Run(self.directory)
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


class Study:
    """Runs `program`; results in `directory`. `limit`: processor seconds that one run may take. `jobs`: runs at a time, for what is not timed."""

    def __init__(self, program=read.PROGRAM, directory="results/study", limit=300, jobs=1, fresh=False):
        self.program, self.directory, self.limit, self.jobs, self.fresh = pathlib.Path(program), pathlib.Path(directory), limit, jobs, fresh
        if not self.program.exists():
            sys.exit(f"{program} does not exist: build it (cmake --workflow --preset release), or give --program")
        self._made = set()
        self._manual = None

    def run(self, decks, settings, ranks=1):
        """The outcome of `tanktread decks… --set …`. `decks`: a path from the source directory, or several; `settings`: {"Section/key": value}."""
        decks = [decks] if isinstance(decks, str) else list(decks)
        words = [str(self.program)]
        words += [str(SOURCE / deck) for deck in decks]  # a whole path stays as it is
        for key, value in settings.items():
            words += ["--set", f"{key}={_text(value)}"]
        if ranks > 1:
            words = ["mpirun", "--oversubscribe", "-n", str(ranks)] + words
        where = self.directory / _name(decks, settings, ranks)
        note = where / "outcome.json"
        if note.exists() and (not self.fresh or where in self._made):
            outcome = Outcome(where, json.loads(note.read_text()))
            never_began = outcome.refused or not (where / "run.h5").exists()  # another program may know more keys
            if where in self._made or not never_began:
                return outcome
        self._made.add(where)
        shutil.rmtree(where, ignore_errors=True)  # of an earlier program, or broken off
        where.mkdir(parents=True)
        note.write_text(json.dumps(self._make(words + ["--quiet", "--output", str(where)])))
        return Outcome(where, json.loads(note.read_text()))

    def _make(self, words):
        start, before = time.monotonic(), _processor()
        done = subprocess.run(["prlimit", f"--cpu={math.ceil(self.limit)}"] + words, capture_output=True, text=True, env=os.environ | ENVIRONMENT, check=False)
        code, said = done.returncode, done.stderr.strip().splitlines()
        if code < 0 or code > 4:  # killed, by the limit
            code, said = None, [f"stopped after {self.limit:g} s of processor time"]
        return {"code": code, "message": said[-1] if said else "", "seconds": time.monotonic() - start,
                "processor_seconds": _processor() - before, "command": " ".join(map(_quoted, words))}

    def all(self, jobs):
        """Outcomes of many (decks, settings), `jobs` of them at a time, in their order."""
        with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
            return list(pool.map(lambda job: self.run(*job), jobs))

    def map(self, function, items):
        """function of every item, as many at a time as `all` has runs."""
        with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
            return list(pool.map(function, items))

    def knows(self, key, word=None):
        """Whether this program's manual has a key, and in its row a word (a choice)."""
        if self._manual is None:
            self._manual = subprocess.run([str(self.program), "--reference"], capture_output=True, text=True, check=True).stdout
        section, name = key.rsplit("/", 1)
        body = self._manual.partition(f"\n## {section}\n")[2].partition("\n## ")[0]
        rows = [row for row in body.splitlines() if row.startswith(f"| `{name}`")]
        return bool(rows) and (word is None or f"`{word}`" in rows[0])

    def schemes(self, wanted):
        """Those of the schemes that this program has."""
        return [scheme for scheme in wanted if self.knows("Time/scheme", scheme)]


def _processor():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def edge(holds, low, high, factor=1.05):
    """The largest value at which `holds` still does, by bisection of the logarithm to a factor, and what it is: `edge`, or `holds to
    here` (high), `fails from here` (low) where there is none between. It is taken to hold below and to fail above."""
    if not holds(low):
        return low, "fails from here"
    if holds(high):
        return high, "holds to here"
    while high / low > factor:
        middle = (low * high) ** 0.5
        if holds(middle):
            low = middle
        else:
            high = middle
    return low, "edge"


def arguments(parser, results):
    """The options that all studies share."""
    parser.add_argument("--program", default=read.PROGRAM, type=pathlib.Path, help="default: %(default)s")
    parser.add_argument("--output", default=results, type=pathlib.Path, metavar="DIR",
                        help="of pictures, tables and, under runs/, results (default: %(default)s)")
    parser.add_argument("--fresh", action="store_true", help="make every run anew, also those that are there")
    parser.add_argument("--limit", type=float, default=300, metavar="SECONDS", help="of processor time that one run may take (default: %(default)s)")


def study(parsed, jobs=1):
    return Study(parsed.program, parsed.output / "runs", parsed.limit, jobs, parsed.fresh)


def write_table(path, head, rows):
    """A CSV file; `rows` of numbers and words."""
    path.parent.mkdir(parents=True, exist_ok=True)
    lines = [",".join(head)] + [",".join(_text(entry).replace(",", ";") for entry in row) for row in rows]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    print(path)


def command_of(script, *words):
    """The command line that makes a chart again, as printed under it."""
    return " ".join([f"postproc/{pathlib.Path(script).name}", *map(_quoted, words)])


def _quoted(word):
    return f"'{word}'" if " " in word else word


def _text(value):
    if isinstance(value, bool):
        return "true" if value else "false"
    return f"{value:.9g}" if isinstance(value, float) else str(value)


def _name(decks, settings, ranks):
    """Of the content of the decks and the settings: a run of a deck that has changed is another run."""
    texts = [path.read_text() for path in (SOURCE / deck for deck in decks)]
    text = json.dumps([texts, {key: _text(value) for key, value in sorted(settings.items())}, ranks])
    return pathlib.Path(decks[-1]).stem + "_" + hashlib.sha1(text.encode()).hexdigest()[:12]
