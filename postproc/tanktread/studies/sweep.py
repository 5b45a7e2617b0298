"""Runs a deck for many values of its keys, several runs at a time, and writes and plots a table of results.

    tanktread-sweep inputs/studies/study.yaml                                        # results/study/table.csv, table.h5
    tanktread-sweep inputs/studies/study.yaml --plot D 'Membrane/capillary number'   # and results/study/D.png
    tanktread-sweep inputs/studies/study.yaml --plot 'D(t)' time                     # whole series, one line per run

A study is a YAML file; inputs/studies/study.yaml is an example. Its keys are

    deck       the deck, or several decks of which later ones override earlier ones
    set        settings of all runs
    grid       {key: values}. All combinations of the values are run
    together   {key: values}. The lists have the same length: the first run takes the first value of each, and so on
    random     {number, seed, keys: {key: values}}. The values of `number` runs are drawn at random
    record     {column: series}. The columns of the table, see below
    limit      largest processor time of a run in seconds (default: no limit)

If more than one of `grid`, `together` and `random` is given, all their combinations are run. Values are a list, or
{from, to, number, spacing: linear | logarithmic}. Random values are drawn from a list or from a range {from, to,
spacing}. A column of `record` is the name of a series, which stands for its last value, or {series, take: last |
smallest | largest | mean | all}, or {series, at: time}. The mean is an average over time. `record` may also be a list
of series; their last values are the columns.

Values may have units, such as 40 1/s, if the deck has the section Units. The tables contain them as numbers in the
units of the deck.

The tables contain the runs that have ended, and are written again whenever a run ends. The column `status` is done,
refused, stopped (by a signal or at its limit) or failed. `ended` tells how a completed run ended: steady (with
Time/steady tolerance), past (Time/end when past), or done: at its final time, or with the shape that was requested.

A run that is complete is not repeated, even if the study has changed. A run that was interrupted is resumed. A run that
was stopped at its `limit` is resumed, or repeated if it has no checkpoint, when the limit is larger or removed. The row
of a run that fails contains its error message.
"""

import collections
import contextlib
import csv
import functools
import itertools
import math
import os
import pathlib
import re
import sys
import time

import h5py
import numpy

from ..files import Named, opened
from ..interpolation import interpolated, mean
from ..mistakes import Mistake, command_line, expect, log, progress
from ..runs import Study, text_of
from . import reading
from .reading import any_name, deck_key, read

RUN = ["status", "ended", "processor_seconds", "directory", "message"]  # the last columns of every table
TAKES = {"last": lambda time, values: values[-1], "smallest": lambda time, values: values.min(),
         "largest": lambda time, values: values.max(), "mean": mean, "all": None}


def drawn(given):
    """Returns a list of settings {key: value}, drawn at random as the section `random` requests."""
    generator, size = numpy.random.default_rng(given.get("seed", 1)), given["number"]
    columns = {key: [one[k] for k in generator.integers(len(one), size=size)] if isinstance(one, list) else
               reading.spaced(one, key, generator.random(size)) for key, one in given["keys"].items()}
    return [dict(zip(columns, row)) for row in zip(*columns.values())]


def combinations(given):
    """Returns the settings of all runs of a study, without duplicates."""
    grid, together, random = given["grid"], given["together"], given["random"]
    expect(len({len(values) for values in together.values()}) <= 1, "the lists of `together` must be equally long")
    expect(not random or ("number" in random and random.get("keys")), "random needs a number and keys")
    names = [*grid, *together, *random.get("keys", {})]
    twice = sorted({name for name in names if names.count(name) > 1})
    expect(not twice, f"{', '.join(twice)}: a key is in one of grid, together and random only")
    reading.few(math.prod([*map(len, grid.values()), *map(len, [*together.values()][:1]), random.get("number", 1)]),
                "the study")
    groups = [[dict(zip(grid, row)) for row in itertools.product(*grid.values())],
              [dict(zip(together, row)) for row in zip(*together.values())] or [{}],
              drawn(random) if random else [{}]]
    rows = [given["set"] | a | b | c for a, b, c in itertools.product(*groups)]
    return list({str({key: text_of(value) for key, value in row.items()}): row for row in rows}.values())


def columns_of(record, path):
    """Returns {column: (series, take, at)} from the section `record` of a study file."""
    expect(record, f"{path} records nothing: name series under `record`")
    for name, given in record.items():
        expect(not {"take", "at"} <= set(given), f"{path}: {name} has series, and take or at")
    return {name: (given.get("series", name), given.get("take", "last"), given.get("at"))
            for name, given in record.items()}


def recorded(outcome, columns):
    """Returns {column: value} for a run; {} if neither the run nor a level of its accuracy was completed. For whole
    series (`take: all`), the value is an array, and `time` is added. A column with one value has a second column
    `<column> error` if an accuracy was requested. If a series has no value at the time `at`, the value is NaN and a
    `message` is added."""
    if not outcome.done and not outcome.accurate:
        return {}
    row, time = {}, outcome.series["time"]
    for name, (series, take, at) in columns.items():
        values, errors = outcome.series[series], outcome.run.errors.get(series)
        if take == "all":
            row |= {name: values, "time": time}
            continue
        kept = numpy.full(len(values), True) if take == "last" else ~numpy.isnan(values)  # defined values only
        take_error = TAKES["last" if take == "last" else "largest"]
        for column, found, one in (name, values, TAKES[take]), (f"{name} error", errors, take_error):
            if found is not None and at is not None and len(found):
                known, place, order = ~numpy.isnan(found), numpy.clip(at, time[0], time[-1]), 6 if column == name else 2
                there = abs(place - at) <= 1e-9 * abs(at) and not numpy.isnan(numpy.interp(place, time, found))
                row[column] = interpolated(time[known], found[known], [place], order)[0] if there else numpy.nan
                if not there and column == name:
                    row["message"] = f"{name} has no value at {at:g}; the run is from {time[0]:g} to {time[-1]:g}"
            elif found is not None:
                row[column] = float(one(time[kept], found[kept])) if kept.any() else numpy.nan
    return row


def numbers_of(key, given, outcomes):
    """Returns the values of a key in all runs as numbers in the unit of the deck; None if not all of them are numbers.
    A text such as `40 1/s` is looked up in the effective deck of its run. If its run has no results, the value of
    another run with the same text is used, and NaN if there is none."""
    if not all(isinstance(value, (int, float)) or re.match(r"[-+]?\.?\d", str(value)) for value in given):
        return None
    known = {}
    for value, outcome in zip(given, outcomes):
        plain = value
        if isinstance(value, str):  # PyYAML also reads 1e-2 as a string
            try:
                plain = float(value)
            except ValueError:
                plain = None
        known.setdefault(value, numpy.nan if plain is None else plain)
        with contextlib.suppress(Mistake):  # the run has no results
            found = outcome.run.value_of(key) if isinstance(value, str) else None
            known[value] = plain if found is None else found
    numbers = [known[value] for value in given]
    numeric = all(isinstance(one, (int, float)) for one in numbers) and not numpy.isnan(numbers).all()
    return numbers if numeric else None


def _drawn_from(given, name):
    """Returns the list or the range from which the values of a key are drawn at random."""
    if isinstance(given, list):
        return reading.values(given, name)
    found = read(given, reading.RANGE, name)
    expect({"from", "to"} <= set(found), f"{name}: random values have from and to, or are a list to draw from")
    return found


def _columns(given, name):
    """Returns {column: {series, take, at}} from the section or list `record`."""
    if isinstance(given, list):
        given = {one: one for one in read(given, [reading.text], name)}
    return read(given, {any_name: _column}, name)


def _column(given, name):
    kinds = {"series": reading.text, "take": reading.word(*TAKES), "at": reading.number}
    return {"series": reading.text(given, name)} if isinstance(given, str) else read(given, kinds, name)


KINDS = {"set": reading.SETTINGS, "grid": {deck_key: reading.values}, "together": {deck_key: reading.values},
         "random": {"number": reading.whole, "seed": functools.partial(reading.whole, least=0),
                    "keys": {deck_key: _drawn_from}},
         "record": _columns, "limit": reading.positive, "ranks": reading.whole}


class Sweep:
    """A study file and its runs. `keys`: keys that vary. `rows`: settings of each run. `outcomes`: their Outcomes, or
    None for runs that have not ended."""

    def __init__(self, path, study):
        given = reading.study_of(path, KINDS)
        self.name, self.study, self.decks = pathlib.Path(path).stem, study, given["deck"]
        self.ranks, self.study.limit = given.get("ranks", 1), given.get("limit")
        self.rows, self.columns = combinations(given), columns_of(given.get("record"), path)
        self.outcomes, self.found = [None] * len(self.rows), {}  # found: recorded() of each run that has ended
        self.keys = [key for key in dict.fromkeys(key for row in self.rows for key in row)
                     if len({str(row.get(key)) for row in self.rows}) > 1]
        series = any(take == "all" for _, take, _ in self.columns.values())
        for name in self.columns:
            expect(name not in (*self.keys, *RUN, *(["time"] if series else [])),
                   f"{path}: record: {name} is already a column of the table")
            expect(not any(other.startswith(f"{name}/") for other in self.columns),
                   f"{path}: record: {name} is also the beginning of the name of another column")

    def make(self, directory):
        """Makes the runs, writes the tables whenever a run has ended, and prints the progress on standard error."""
        start, ends, written = time.monotonic(), collections.Counter(), 0

        def told(k, outcome):
            nonlocal written
            ends[outcome.status] += 1
            self.found[k] = recorded(outcome, self.columns)  # raises Mistake for columns that do not exist
            self.outcomes[k] = outcome
            made, now = sum(ends.values()), time.monotonic()
            if now > written:
                self.write(directory)
                written = time.monotonic() + 10 * (time.monotonic() - now)  # tables of many rows are written less often
            left = (now - start) / made * (len(self.rows) - made)
            said = ", ".join(f"{number} {status}" for status, number in ends.items())
            if sys.stderr.isatty() or made * 10 // len(self.rows) > (made - 1) * 10 // len(self.rows):
                progress(f"{made} of {len(self.rows)} runs: {said}; {left:.0f} s left")

        try:
            self.study.all([(self.decks, row, self.ranks) for row in self.rows], told)
        finally:
            if self.found:
                self.write(directory)
        progress("")

    def write(self, directory):
        """Writes table.csv and table.h5 of the runs that have ended. Whole series are only in table.h5
        (/columns/<name>, rows padded with NaN). Keys and columns in table.h5 have the attribute `unit`, such as ", µm",
        taken from the first completed run. Values of keys are numbers in the unit of the deck, or text."""
        ended = sorted(self.found)
        outcomes, found = [self.outcomes[k] for k in ended], [self.found[k] for k in ended]
        given = {key: [self.rows[k].get(key, numpy.nan) for k in ended] for key in self.keys}
        keys = {key: numbers_of(key, values, outcomes) for key, values in given.items()}
        shown = {key: given[key] if values is None else
                 [text if numpy.isnan(value) else value for text, value in zip(given[key], values)]
                 for key, values in keys.items()}
        whole = [name for name, (_, take, _) in self.columns.items() if take == "all"]
        single = [word for name in self.columns if name not in whole for word in (name, f"{name} error")
                  if word == name or any(word in values for values in found)]
        columns = {name: [values.get(name, numpy.nan) for values in found] for name in single}
        messages = [own.get("message", "") if one.done else one.message for one, own in zip(outcomes, found)]
        partial = directory / "table.csv.part", directory / "table.h5.part"
        with open(partial[0], "w", encoding="utf-8", newline="") as file:
            out = csv.writer(file)
            out.writerow([*self.keys, *single, *RUN])
            for one, message, *values in zip(outcomes, messages, *shown.values(), *columns.values()):
                out.writerow([*values, one.status, one.ended, f"{one.processor_seconds:.3g}", one.directory.name,
                              message])
        for name in [*whole, "time"] if whole else []:
            padded = itertools.zip_longest(*(values.get(name, []) for values in found), fillvalue=numpy.nan)
            columns[name] = numpy.reshape(list(padded), (-1, len(found))).T
        with h5py.File(partial[1], "w") as file:
            file["status"] = [outcome.status for outcome in outcomes]
            file["ended"] = [outcome.ended for outcome in outcomes]
            file["message"] = messages
            file["directory"] = [str(outcome.directory) for outcome in outcomes]
            file.attrs["keys"] = self.keys
            for key, values in keys.items():
                file[f"keys/{key}"] = list(map(str, given[key])) if values is None else values
            file.attrs["columns"] = list(columns)
            for name, values in columns.items():
                file[f"columns/{name}"] = values
            run = next((outcome.run for outcome in outcomes if outcome.done), None)
            for key in self.keys if run else []:
                file[f"keys/{key}"].attrs["unit"] = run.unit(self.study.dimension(key))
            for name in columns if run else []:
                series = (self.columns.get(name) or self.columns.get(name.removesuffix(" error")) or [name])[0]
                file[f"columns/{name}"].attrs["unit"] = run.unit(run.units[series])
        for path in partial:  # renamed when complete, so that a killed sweep keeps whole tables
            path.rename(path.with_suffix(""))


def table(directory):
    """Reads the table.h5 of a sweep. Returns {column or key: values}, the keys that vary, and {column or key: axis
    label}."""
    with opened(directory / "table.h5") as file:
        keys = list(file.attrs["keys"])
        found = {key: file[f"keys/{key}"] for key in keys}
        found |= {name: file[f"columns/{name}"] for name in file.attrs["columns"]}
        labels = {name: name + data.attrs.get("unit", "") for name, data in found.items()}
        values = {name: data.asstr()[:] if data.dtype.kind == "O" else data[:] for name, data in found.items()}
        return Named(values, f"{directory}/table.h5 has no column"), keys, labels


def plot(directory, column, key, axes=None):
    """Returns a figure of a column against a key, or of whole series against time. There is one line per combination of
    the other keys. Values that are text are drawn in the order of the study, without a line."""
    from ..figures import style

    columns, keys, labels = table(directory)
    expect(columns[column].ndim == columns[key].ndim,
           f"{column} and {key} cannot be drawn against each other: one of them is a whole series")
    figure, (axis,) = style.panels(axes, 1, 1, 6.4, 4.4)
    others = [name for name in keys if name != key]
    units = {name: labels[name].removeprefix(name).replace(",", "", 1) for name in others}
    lines = numpy.array([", ".join(f"{name.split('/')[-1]} {columns[name][k]}{units[name]}" for name in others)
                         for k in range(len(columns[column]))])
    few, text = len(set(lines)) <= 12, columns[key].dtype.kind == "O"
    for k, label in enumerate(dict.fromkeys(lines)):
        x, y, color = columns[key][lines == label], columns[column][lines == label], style.RUNS[k % len(style.RUNS)]
        if y.ndim > 1:
            axis.plot(x.T, y.T, color=color)[0].set_label(label)
            continue
        order = numpy.arange(len(x)) if text else numpy.argsort(x)
        # another line style when the colours repeat
        dash = ("-", "--", ":")[k // len(style.RUNS)] if few and not text else ""
        axis.plot(x[order], y[order], "o", linestyle=dash, ms=3.5, color=color if few else style.RUNS[0],
                  label=label if few else None)
    along = columns[key] if columns[key].dtype.kind in "fi" and columns[key].ndim == 1 else numpy.zeros(1)
    if numpy.nanmin(along) > 0 and numpy.nanmax(along) > 30 * numpy.nanmin(along):
        axis.set_xscale("log")
    axis.set(xlabel=labels[key], ylabel=labels[column])
    if axis.get_legend_handles_labels()[1] and others:
        axis.legend(fontsize=7.5)
    return figure


def run(path, directory=None, jobs=None, fresh=False):
    """Makes the runs of a study file, writes its table, and returns the Sweep. `directory`: directory of table.csv,
    table.h5 and runs/ (default: results/<study>). `jobs`: number of simultaneous runs (default: one per core). `fresh`:
    if true, existing results are not used."""
    directory = pathlib.Path(directory or f"results/{pathlib.Path(path).stem}")
    sweep = Sweep(path, Study(directory=directory / "runs", jobs=os.cpu_count() if jobs is None else jobs, fresh=fresh))
    directory.mkdir(parents=True, exist_ok=True)
    sweep.make(directory)
    for name in "table.csv", "table.h5":
        log.info(directory / name)
    return sweep


def main():
    parser = command_line(__doc__)
    parser.add_argument("study", help="YAML file of the study")
    parser.add_argument("--output", metavar="DIR",
                        help="directory of the table, and of the runs in runs/ (default: results/<study>)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(),
                        help="number of simultaneous runs (default: the number of cores)")
    parser.add_argument("--fresh", action="store_true", help="repeat runs that exist already")
    parser.add_argument("--list", action="store_true", help="print the settings of the runs without making them")
    parser.add_argument("--plot", nargs=2, metavar=("COLUMN", "KEY"),
                        help="plot a column of the table against a key or against another column")
    parser.add_argument("-o", "--picture", type=pathlib.Path, metavar="FILE",
                        help="file of the plot (default: <COLUMN>.png next to the table)")
    arguments = parser.parse_args()
    expect(arguments.jobs > 0, "--jobs must be at least 1")
    if arguments.list:
        for row in Sweep(arguments.study, Study()).rows:
            log.info(", ".join(f"{key}={text_of(value)}" for key, value in row.items()))
        return
    sweep = run(arguments.study, arguments.output, arguments.jobs, arguments.fresh)
    if not any(outcome.done for outcome in sweep.outcomes):
        sys.exit(f"tanktread-sweep: none of the runs came to its end; the first one: {sweep.outcomes[0].message}")
    if arguments.plot:
        from ..figures import style

        directory, name = sweep.study.directory.parent, re.sub(r"[^\w.-]", "_", arguments.plot[0]).strip("_")
        style.save(style.draw(plot, directory, *arguments.plot), arguments.picture or directory / f"{name}.png")
