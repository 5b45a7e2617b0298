"""Runs of the program: a single run of a deck, or the runs of a study. Completed runs are kept and not repeated."""

import collections
import concurrent.futures
import contextlib
import fcntl
import functools
import hashlib
import json
import math
import numbers
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import threading
import time
from shlex import quote as quoted

import numpy
import yaml

from .files import Named, parsed, yaml_text
from .mistakes import Mistake, expect
from .results import Run

SOURCE = pathlib.Path(__file__).resolve().parents[2]  # the source directory, unless the package is installed
ENVIRONMENT = {"OPENBLAS_NUM_THREADS": "1", "OMPI_ALLOW_RUN_AS_ROOT": "1",
               "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


def _program():
    """Returns the path of the program: the variable TANKTREAD, otherwise the program of this source directory or
    installation, otherwise the program in PATH."""
    if named := os.environ.get("TANKTREAD"):
        return pathlib.Path(named)
    found = [parent / "bin/tanktread" for parent in pathlib.Path(__file__).resolve().parents[3:6]]
    found = [SOURCE / "build/release/app/tanktread", *found, pathlib.Path(shutil.which("tanktread") or "tanktread")]
    return next((path for path in found if path.is_file()), found[0 if (SOURCE / "CMakeLists.txt").exists() else -1])


PROGRAM = _program()


def shared():
    """Returns the directories in which decks and studies are searched for: the current directory, the source directory,
    and share/tanktread of the installation."""
    return pathlib.Path(), SOURCE, PROGRAM.resolve().parent.parent / "share/tanktread"


def deck_at(name):
    """Returns the absolute path of a deck, searched for in the directories of shared(). Raises Mistake if none has
    it."""
    found = next((place / name for place in shared() if (place / name).is_file()), None)
    expect(found, f"{name}: there is no such deck")
    return found.resolve()


def _plain(value):
    """Returns a value with lists instead of arrays of numpy and tuples, and numbers of Python instead of numpy's."""
    if isinstance(value, (numpy.ndarray, numpy.generic)):
        return value.tolist()
    return [_plain(one) for one in value] if isinstance(value, (list, tuple)) else value


def text_of(value):
    """Returns a value as text for the command line. Arrays of numpy and tuples are written as lists."""
    value = _plain(value)
    text = f"{value:.15g}" if isinstance(value, float) else str(value)
    return text.lower() if isinstance(value, bool) else text


def settings_of(words):
    """Returns {key: value} of the words KEY=VALUE."""
    for word in words:
        expect("=" in word, f"{word}: a setting is KEY=VALUE")
    return dict(word.split("=", 1) for word in words)


def run(where, settings=None):
    """Returns the Run of a results directory or of a deck (a .yaml file). A deck is run first if it has no results.
    With settings {"Section/key": value}, the deck is run with these keys changed; a value may be an array. The
    directory of this run below `results` is named by the deck and a checksum of deck and settings. If `where` is a Run,
    it is returned. Raises Mistake if the run fails."""
    if isinstance(where, Run):
        return where
    if settings:
        outcome = Study(directory="results").run(where, settings)
        expect(outcome.done, f"{where} did not run to its end: {outcome.message}")
        return outcome.run
    return Run(results_of(where) if str(where).endswith(".yaml") else where)


def runs_of(runs):
    """Returns a list of Runs from one or several runs, directories or decks."""
    return [run(one) for one in (runs if isinstance(runs, (list, tuple)) else [runs])]


def results_of(deck, name=None, settings=None, accepted=(0, 1)):
    """Returns the directory results/<name> (default: the name of the deck). Runs the deck there first if it has no
    results. `accepted`: exit codes that do not raise Mistake. Exit code 1 means a missed expectation; figures show
    it."""
    directory = pathlib.Path("results") / (name or pathlib.Path(deck).stem)
    if not (directory / "run.h5").exists():
        _exists(PROGRAM)
        words = [str(deck_at(deck)), *_set(settings or {}), "--output", str(directory)]
        print(PROGRAM.name, *words, file=sys.stderr)
        code = subprocess.run([PROGRAM, *words, "--quiet"], env=os.environ | ENVIRONMENT, check=False).returncode
        expect(code in accepted, f"{deck} did not run to its end (exit code {code})")
    elif 3 not in accepted:
        status = str((Run(directory).summary or {"status": "stopped"})["status"])
        expect(not status.startswith(("failed", "stopped")), f"{directory} did not come to its end: tanktread --resume "
               f"{directory} continues it, or name this directory to use what is there")
    return directory


def _exists(program):
    expect(program.is_file(), f"there is no program {program}: build it (cmake --workflow --preset release), install "
                              "it, or name one: TANKTREAD=...")


def _files_of(value, folders):
    """Yields the files that are named in nested dicts and lists. Each name is searched for in `folders`; the first file
    found is used, or run.h5 if the name is a results directory."""
    for one in value.values() if isinstance(value, dict) else value if isinstance(value, list) else ():
        yield from _files_of(one, folders)
    if isinstance(value, (str, pathlib.Path)) and str(value):
        places = (folder / value / part for folder in folders for part in ("", "run.h5"))
        yield from [place for place in places if os.path.isfile(place)][:1]


def _set(settings):
    """Returns the command-line arguments that set the keys in `settings`."""
    return [word for key, value in settings.items() for word in ("--set", f"{key}={text_of(value)}")]


STOPS = signal.SIGTERM, signal.SIGINT, signal.SIGHUP  # a second one kills a run even if it is writing its checkpoint


def _signal(code):
    """Returns the signal that killed a program with this exit code, or 0; mpirun ends with 128 plus the signal."""
    killed = 0 if code is None else -code if code < 0 else code - 128
    return killed if 0 < killed < 65 else 0


class Outcome:
    """Outcome of one run of a Study. One of these is true: `done` (the run was completed), `failed`, `refused` (the
    deck has a mistake), or `slow` (stopped at the time limit or by a signal). `stopped`: true if stopped by a signal.
    `message`: last line on standard error. `seconds`: wall time. `processor_seconds`: processor time of all ranks.
    Both times include the earlier parts of a resumed run. `limit`: the limit at which the run was stopped; infinite if
    there was none.
    `series`: series of the run. `final`, `counts`, `phases`: sections of its summary."""

    def __init__(self, directory, note):
        self.directory, self.message, self.seconds = pathlib.Path(directory), note["message"], note["seconds"]
        self.processor_seconds = note.get("processor_seconds", math.nan)
        self.code, self.command = note["code"], note["command"]
        # earlier versions noted no limit: a run that such a version stopped at its limit is resumed
        self.limit = note.get("limit", 0) if self.code is None else math.inf

    done = property(lambda self: self.code in (0, 1) and (self.directory / "summary.yaml").exists())
    # true for a run with a requested accuracy that has stopped before, but has results of a finished level
    accurate = property(lambda self: self.code == 4 and (self.directory / "summary.yaml").exists()
                        and "accuracy" in self.run.summary)
    failed = property(lambda self: self.status == "failed")
    refused = property(lambda self: self.code == 2)
    stopped = property(lambda self: self.code == 4 or _signal(self.code) in STOPS)
    slow = property(lambda self: self.code is None or self.stopped)

    run = functools.cached_property(lambda self: Run(self.directory))
    series = property(lambda self: self.run.series)
    counts = property(lambda self: self._of_summary("counts"))
    final = property(lambda self: self._of_summary("final"))
    phases = property(lambda self: self._of_summary("seconds"))

    def _of_summary(self, section):
        return Named(self.run.summary[section] or {}, f"{self.directory}/summary.yaml holds in {section} no")

    status = property(lambda self: "done" if self.done else "refused" if self.refused else "stopped" if self.slow
                      else "failed", doc="`done`, `refused`, `stopped` or `failed`.")
    ended = property(lambda self: self.run.summary["status"] if self.done else self.status,
                     doc="As `status`, but `steady` or `past` if a completed run ended so before its final time.")
    kernel_evaluations = property(lambda self: sum(value for name, value in self.counts.items()
                                                   if name.startswith("kernel_evaluations")))

    @property
    def end(self):
        """The simulated time that the run has reached; 0 if it recorded none."""
        with contextlib.suppress(Mistake, IndexError):
            return float(self.series["time"][-1])
        return 0.0


def _earlier(directory, before, ranks):
    """Returns the wall time and the processor time that a run has taken before it is resumed. `before`: its Outcome. If
    this is None, because the study was killed during the run, both times follow from the series `wall_seconds`."""
    if before:
        return {"seconds": before.seconds, "processor_seconds": before.processor_seconds}
    seconds = 0.0
    with contextlib.suppress(Mistake, IndexError):
        seconds = float(Run(directory).series["wall_seconds"][-1])
    return {"seconds": seconds, "processor_seconds": ranks * seconds}


def _occupied(directory):
    """Returns whether a run of the program is writing to a directory; it holds a lock of the directory meanwhile."""
    if not directory.is_dir():
        return False
    descriptor = os.open(directory, os.O_RDONLY)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return True
    finally:
        os.close(descriptor)
    return False


class Study:
    """Runs of decks with changed keys. Their results are kept in `directory`; a run with the same decks and settings is
    not repeated. `limit`: largest processor time of a run in seconds (None: no limit); it does not count
    the earlier parts of a resumed run. The limit of a run with several ranks holds for each rank and is rounded up to
    whole seconds. `jobs`: number of simultaneous runs. `fresh`: if true, existing results are not used.
    `threads`: number of threads of each run, or of each of its ranks (default: OMP_NUM_THREADS; if it is not set, the
    cores divided by `jobs`, and one for several ranks); results do not depend on it."""

    def __init__(self, program=None, directory="results/study", limit=None, jobs=1, fresh=False, threads=None):
        expect(isinstance(jobs, numbers.Integral) and jobs > 0, f"jobs must be a whole number above 0, but is {jobs}")
        expect(limit is None or 0 < limit < math.inf, f"limit must be a number above 0, but is {limit}")
        self.program, self.directory = pathlib.Path(program or PROGRAM), pathlib.Path(directory)
        self.limit, self.jobs, self.fresh, self.threads = limit, jobs, fresh, threads
        self._made, self._running = set(), set()
        self._locks, self._lock = collections.defaultdict(threading.Lock), threading.Lock()

    def run(self, decks, settings, ranks=1):
        """Returns the Outcome of `tanktread decks… --set …`. `decks`: a path (see deck_at), or several paths; later
        decks override earlier ones. `settings`: {"Section/key": value}. A run that was stopped by a signal or at a
        smaller limit, or killed together with its study, is resumed from its checkpoint, or repeated if it has none."""
        decks = [decks] if isinstance(decks, (str, pathlib.Path)) else list(decks)
        where = self.directory / self.name(decks, settings, ranks)
        with self._lock:
            lock = self._locks[where]
        with lock:  # of two equal runs, the second one finds the results of the first
            return self._run(decks, settings, ranks, where)

    def _run(self, decks, settings, ranks, where):
        note, before = where / "outcome.json", None
        with contextlib.suppress(Mistake):  # outcome.json is missing or damaged
            before = Outcome(where, parsed(note, json.loads))
        # A run that was refused or has no results is repeated: another version of the program may accept its keys.
        began = before and not before.refused and (where / "run.h5").exists()
        unfinished = not before or before.stopped or before.limit < (self.limit or math.inf)
        if before and (where in self._made or (began and not unfinished and not self.fresh)):
            return before
        expect(not _occupied(where), f"{where}: another run is writing to it, perhaps of the same study")
        self._made.add(where)
        # without --bind-to none, runs side by side would all be bound to the first cores
        launcher = ["mpirun", "--oversubscribe", "--bind-to", "none", "-n", str(ranks)] if ranks > 1 else []
        program, made = launcher + [str(self.program), "--quiet"], None
        # If results exist without outcome.json, the study was killed during the run.
        if (where / "run.h5").exists() and unfinished and not self.fresh:
            earlier = _earlier(where, before, ranks)
            made = self._make(program + ["--resume", str(where)], ranks)
            made |= {name: made[name] + seconds for name, seconds in earlier.items()}
        if made is None or made["code"] == 2:  # not resumed, or there is no checkpoint
            shutil.rmtree(where, ignore_errors=True)
            where.mkdir(parents=True)
            words = [str(deck_at(deck)) for deck in decks] + _set(settings)
            made = self._make(program + words + ["--output", str(where)], ranks)
        partial = note.with_suffix(".part")  # renamed when complete, so that outcome.json is never incomplete
        partial.write_text(json.dumps(made))
        partial.rename(note)
        return Outcome(where, made)

    def _make(self, words, ranks):
        _exists(self.program)
        shared = 1 if ranks > 1 else max(1, len(os.sched_getaffinity(0)) // self.jobs)
        threads = str(self.threads or os.environ.get("OMP_NUM_THREADS", shared))
        start = time.monotonic()
        bounds = ["setpriv", "--pdeathsig", "KILL"]  # a run must not outlive the study that made it
        bounds += ["prlimit", f"--cpu={math.ceil(self.limit)}"] if self.limit else []
        environment = os.environ | ENVIRONMENT | {"OMP_NUM_THREADS": threads}
        with subprocess.Popen(bounds + words, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                              env=environment, preexec_fn=self._start_timer) as process:
            self._running.add(process)
            said = process.stderr.read().strip().splitlines()
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = code = os.waitstatus_to_exitcode(status)
            self._running.discard(process)
        killed, used = _signal(code), usage.ru_utime + usage.ru_stime
        at_limit = killed in (signal.SIGXCPU, signal.SIGPROF) or used > (self.limit or math.inf) / 2
        if self.limit and at_limit and killed in (signal.SIGKILL, signal.SIGXCPU, signal.SIGPROF):
            code, said = None, [f"stopped after {self.limit:g} s of processor time"]
        elif killed:
            said.append(f"killed by signal {killed}")
        return {"code": code, "message": said[-1] if said else "", "limit": self.limit,
                "seconds": time.monotonic() - start,
                "processor_seconds": used, "command": " ".join(map(quoted, words))}

    def _start_timer(self):
        """Starts the timer that ends a run of one rank at the limit. The timer counts fractions of a second, which
        prlimit does not, and exec keeps it. The ranks that mpirun starts do not inherit it."""
        if self.limit:
            signal.setitimer(signal.ITIMER_PROF, self.limit)

    @staticmethod
    def name(decks, settings, ranks=1):
        """Returns the name of a run's directory: the name of the last deck, and a checksum of the settings, the decks,
        and the content of all files that they name."""
        paths = [deck_at(deck) for deck in decks]
        texts = [parsed(path, str) for path in paths]
        named, folders = [dict(sorted(settings.items()))], [pathlib.Path(), *(path.parent for path in paths)]
        with contextlib.suppress(yaml.YAMLError, ValueError):  # the program refuses a deck that is not YAML
            named += [yaml_text(text) for text in texts]
        files = [hashlib.sha1(path.read_bytes()).hexdigest() for path in _files_of(named, folders)]
        text = json.dumps([texts, {key: text_of(value) for key, value in sorted(settings.items())}, ranks, *files])
        return pathlib.Path(decks[-1]).stem + "_" + hashlib.sha1(text.encode()).hexdigest()[:12]

    def all(self, jobs, told=lambda k, outcome: None):
        """Returns the Outcomes of a list of (decks, settings[, ranks]) in its order. `self.jobs` runs are made at a
        time. Calls told(k, outcome) when run k, from 0, has ended. An interrupt stops all runs; they write
        checkpoints."""
        with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
            futures = {pool.submit(self.run, *job): k for k, job in enumerate(jobs)}
            try:
                for future in concurrent.futures.as_completed(futures):
                    told(futures[future], future.result())
            except BaseException:
                pool.shutdown(wait=False, cancel_futures=True)
                for process in list(self._running):
                    process.send_signal(signal.SIGTERM)
                raise
            return [future.result() for future in futures]

    def map(self, function, items):
        """Returns the list of function(item) for all items. Processes `self.jobs` items at a time."""
        with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
            return list(pool.map(function, items))

    @functools.cached_property
    def _manual(self):
        return subprocess.run([self.program, "--reference"], capture_output=True, text=True, check=True).stdout

    def dimension(self, key):
        """Returns the dimension of a key, such as force/length; "" if the key is dimensionless or unknown."""
        key = re.sub(r"^Particles/[^/]*/(?=.*/)", "", key)  # Particles/cell/Membrane/law is described as Membrane/law,
        key = re.sub(r"^Particles/[^/]*/", "Particle/", key)  # and Particles/cell/radius as Particle/radius
        section, _, name = key.rpartition("/")
        headings = section, f"`{section.rpartition('/')[0]}/<name>`"  # Membrane/forces/left is Membrane/forces/<name>
        bodies = [self._manual.partition(f"\n## {one}\n")[2].partition("\n## ")[0] for one in headings]
        body = bodies[0] or bodies[1]
        row = next((row for row in body.splitlines() if row.startswith(f"| `{name}`")), "|||| |")
        unit = row.split("|")[4].strip()
        return "" if unit == "1" else unit
