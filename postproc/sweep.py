#!/usr/bin/python3
"""Many runs of a deck over values of its keys: side by side on the cores, resumable, with a table of what came out and a plot of any of its columns.

    postproc/sweep.py inputs/studies/study.yaml                                                # results/study/table.csv and table.h5
    postproc/sweep.py inputs/studies/study.yaml --plot D 'Membrane/capillary number'           # and results/study/D.png
    postproc/sweep.py inputs/studies/study.yaml --plot 'D(t)' time                             # whole series, a line a run

A study is a small YAML file: `deck` (one, or several laid over each other), `set` (keys of all runs), and the keys that vary: `grid` (every combination),
`together` (lists side by side), `random` (number, seed, keys); where there are several of these three, each combination of theirs. A key's values are a list,
or {from, to, number, spacing: linear | logarithmic}; of a random one {from, to, spacing}, or a list to draw from. `record` names the columns: a series'
name for its last value, or {series, take: last | smallest | largest | mean | all, at: time}. inputs/studies/study.yaml is an example.

A run that is there is not made again, whatever the study has become since; one that was broken off goes on. One that fails has a row with its message.
"""

import argparse
import collections
import csv
import itertools
import os
import pathlib
import signal
import sys
import time

import needs  # before what it looks for
import h5py
import numpy
import yaml

import tanktread

TAKES = {"last": lambda values: values[-1], "smallest": numpy.min, "largest": numpy.max, "mean": numpy.mean, "all": None}
KEYS = {"deck", "set", "grid", "together", "random", "record", "limit", "ranks"}


class Mistake(Exception):
    """What a user's file has wrong, in one sentence."""


def expect(holds, message):
    if not holds:
        raise Mistake(message)


def number(given, name):
    """A number of a YAML file, in which 1e-2 is a word."""
    try:
        return float(given)
    except (TypeError, ValueError):
        raise Mistake(f"{name}: {given} is not a number") from None


def whole(given, name):
    """A whole number above 0."""
    expect(isinstance(given, int) and not isinstance(given, bool) and given > 0, f"{name} must be a whole number above 0, but is {given}")
    return given


def keys_of(given, name):
    """A list of keys of a YAML file, empty where there is none."""
    expect(given is None or isinstance(given, dict), f"{name} must be a list of keys with values, but is {given}")
    return given or {}


def tell(progress):
    """On standard error: in place on a terminal, which "" gives free again, as lines elsewhere."""
    if sys.stderr.isatty():
        print(f"\r\x1b[K{progress}", end="", file=sys.stderr, flush=True)
    elif progress:
        print(progress, file=sys.stderr, flush=True)


def yaml_of(path, known):
    """A file of these lists, all of them known."""
    try:
        text = yaml.safe_load(pathlib.Path(path).read_text(encoding="utf-8"))
    except OSError as error:
        raise Mistake(f"{path} cannot be read: {error.strerror}") from None
    except yaml.YAMLError as error:
        raise Mistake(f"{path} is not YAML: {' '.join(str(error).split())}") from None
    expect(isinstance(text, dict), f"{path} must be a list of keys: {', '.join(sorted(known))}")
    unknown = sorted(set(text) - set(known))
    expect(not unknown, f"{path}: {unknown[0] if unknown else ''} is not known; there are: {', '.join(sorted(known))}")
    return text


def decks_of(text, path):
    """The decks that a file names, looked for beside it and where the script is started."""
    expect(text.get("deck"), f"{path} names no deck")
    names = text["deck"] if isinstance(text["deck"], list) else [text["deck"]]
    found = []
    for name in names:
        expect(isinstance(name, str), f"{path}: a deck is the name of a file, but {name} is none")
        places = [pathlib.Path(path).parent / name, pathlib.Path(name), tanktread.SOURCE / name]
        found.append(next((place.resolve() for place in places if place.is_file()), None))
        expect(found[-1], f"{path}: there is no deck {name}, beside it or where the script is started")
    return found


def values_of(key, given):
    """A list, a single value, or a range."""
    if isinstance(given, list):
        expect(given, f"{key} has no values")
        return given
    if not isinstance(given, dict):
        return [given]
    expect({"from", "to", "number"} <= set(given), f"{key}: a range has from, to and number")
    low, high = (number(given[end], f"{key}: {end}") for end in ("from", "to"))
    return [float(value) for value in spaced(key, given, low, high)(numpy.linspace(0, 1, whole(given["number"], f"{key}: number")))]


def spaced(key, given, low, high):
    """From [0, 1] to [low, high], by the spacing that is given."""
    if given.get("spacing", "linear") == "linear":
        return lambda share: low + (high - low) * share
    expect(given["spacing"] == "logarithmic", f"{key}: the spacing is linear or logarithmic, not {given['spacing']}")
    expect(low > 0 and high > 0, f"{key}: a logarithmic range is of positive numbers")
    return lambda share: low * (high / low) ** share


def drawn(text):
    """Rows of random settings."""
    expect("number" in text and keys_of(text.get("keys"), "random: keys"), "random needs a number and keys")
    size, seed = whole(text["number"], "random: number"), text.get("seed", 1)
    expect(isinstance(seed, int) and seed >= 0, f"random: seed must be a whole number, 0 or above, but is {seed}")
    generator = numpy.random.default_rng(seed)
    columns = {}
    for key, given in text["keys"].items():
        if isinstance(given, list):
            given = values_of(key, given)
            columns[key] = [given[k] for k in generator.integers(len(given), size=size)]
        else:
            expect(isinstance(given, dict) and {"from", "to"} <= set(given), f"{key}: random values have from and to, or are a list to draw from")
            low, high = (number(given[end], f"{key}: {end}") for end in ("from", "to"))
            columns[key] = [float(value) for value in spaced(key, given, low, high)(generator.random(size))]
    return [dict(zip(columns, row)) for row in zip(*columns.values())]


def combinations(text):
    """The settings of every run that a study asks for, each once."""
    grid = {key: values_of(key, given) for key, given in keys_of(text.get("grid"), "grid").items()}
    together = {key: values_of(key, given) for key, given in keys_of(text.get("together"), "together").items()}
    expect(len({len(values) for values in together.values()}) <= 1, "the lists of `together` must be equally long")
    groups = [[dict(zip(grid, row)) for row in itertools.product(*grid.values())],
              [dict(zip(together, row)) for row in zip(*together.values())] or [{}],
              drawn(text["random"]) if keys_of(text.get("random"), "random") else [{}]]
    fixed = keys_of(text.get("set"), "set")
    rows = [fixed | a | b | c for a, b, c in itertools.product(*groups)]
    return [row for k, row in enumerate(rows) if row not in rows[:k]]


def columns_of(text, path):
    """{column: (series, take, at)}"""
    record = text.get("record")
    expect(record, f"{path} records nothing: name series under `record`")
    if isinstance(record, list):
        expect(all(isinstance(name, str) for name in record), f"{path}: `record` as a list is of names of series")
        record = {name: name for name in record}
    found = {}
    for name, given in keys_of(record, f"{path}: record").items():
        given = {"series": given} if isinstance(given, str) else keys_of(given, f"{path}: {name}")
        take = str(given.get("take", "last"))
        expect(take in TAKES, f"{path}: take {take} of {name} is not one of {', '.join(TAKES)}")
        expect(not set(given) - {"series", "take", "at"}, f"{path}: {name} has series, take and at")
        found[name] = (given.get("series", name), take, number(given["at"], f"{path}: {name}, at") if "at" in given else None)
    return found


def recorded(outcome, columns):
    """What the table has of a run, whole series as arrays; nothing of a run that did not get there."""
    row = {}
    for name, (series, take, at) in columns.items():
        values = outcome.series.get(series) if outcome.done else None
        if outcome.done and values is None:
            raise Mistake(f"a run of this study has no series {series} (column {name}); there are: {', '.join(sorted(outcome.series))}")
        if values is None or not len(values):
            row[name] = numpy.array([]) if take == "all" else numpy.nan
        elif take == "all":
            row[name] = values
        else:
            defined = values if take == "last" else values[~numpy.isnan(values)]  # a series is NaN where it is undefined
            row[name] = numpy.interp(at, outcome.series["time"], values) if at is not None else TAKES[take](defined) if len(defined) else numpy.nan
            row[name] = float(row[name])
    return row


def status_of(outcome):
    return "done" if outcome.done else "refused" if outcome.refused else "stopped" if outcome.slow else "failed"


class Sweep:
    """A study file and its runs: `keys` that vary, `rows` of settings, `outcomes` in the same order once they are made."""

    def __init__(self, path, study):
        text = yaml_of(path, KEYS)
        self.name, self.study, self.decks, self.ranks = pathlib.Path(path).stem, study, decks_of(text, path), whole(text.get("ranks", 1), f"{path}: ranks")
        self.rows, self.columns = combinations(text), columns_of(text, path)
        self.study.limit = number(text["limit"], f"{path}: limit") if text.get("limit") else None
        self.keys = [key for key in dict.fromkeys(key for row in self.rows for key in row) if len({str(row.get(key)) for row in self.rows}) > 1]

    def make(self):
        """Makes the runs, the progress of the whole on standard error."""
        start, ends = time.monotonic(), collections.Counter()

        def told(outcome):
            ends[status_of(outcome)] += 1
            if ends["done"] == 1:  # a column that no run has is told after the first one, not after the last
                recorded(outcome, self.columns)
            made = sum(ends.values())
            left = (time.monotonic() - start) / made * (len(self.rows) - made)
            said = ", ".join(f"{number} {status}" for status, number in ends.items())
            if sys.stderr.isatty() or made * 10 // len(self.rows) > (made - 1) * 10 // len(self.rows):
                tell(f"{made} of {len(self.rows)} runs: {said}; {left:.0f} s left")

        self.outcomes = self.study.all([(self.decks, row, self.ranks) for row in self.rows], told)
        tell("")

    def write(self, directory):
        """table.csv, without whole series, and table.h5 with them (/<column>, rows padded with NaN); the deck beside them."""
        found = [recorded(outcome, self.columns) for outcome in self.outcomes]
        whole = [name for name, (_, take, _) in self.columns.items() if take == "all"]
        single = [name for name in self.columns if name not in whole]
        with open(directory / "table.csv", "w", encoding="utf-8", newline="") as file:
            out = csv.writer(file)
            out.writerow([*self.keys, *single, "status", "processor_seconds", "directory", "message"])
            for row, values, outcome in zip(self.rows, found, self.outcomes):
                out.writerow([*(row.get(key, "") for key in self.keys), *(values[name] for name in single), status_of(outcome),
                              f"{outcome.processor_seconds:.3g}", outcome.directory.name, "" if outcome.done else outcome.message])
        with h5py.File(directory / "table.h5", "w") as file:
            file["status"] = [status_of(outcome) for outcome in self.outcomes]
            file["directory"] = [str(outcome.directory) for outcome in self.outcomes]
            file.attrs["keys"] = self.keys
            for key in self.keys:
                values = [row.get(key, numpy.nan) for row in self.rows]
                numbers = all(isinstance(value, (int, float)) for value in values)
                file[f"keys/{key}"] = values if numbers else [str(value) for value in values]
            if whole:
                found = [values | {"time": outcome.series["time"] if outcome.done else numpy.array([])} for values, outcome in zip(found, self.outcomes)]
            file.attrs["columns"] = [*single, *whole, *(["time"] if whole else [])]
            for name in file.attrs["columns"]:
                longest = max(numpy.size(values[name]) for values in found)
                one = [numpy.pad(numpy.atleast_1d(values[name]), (0, longest - numpy.size(values[name])), constant_values=numpy.nan) for values in found]
                file[f"columns/{name}"] = numpy.array(one) if name in whole or name == "time" else numpy.array(one)[:, 0]
        print(directory / "table.csv", directory / "table.h5", sep="\n")


def table(directory):
    """{column or key: values} of a sweep's table.h5, and which of them vary as keys."""
    with h5py.File(directory / "table.h5", "r") as file:
        keys = list(file.attrs["keys"])
        found = {key: file[f"keys/{key}"] for key in keys} | {name: file[f"columns/{name}"] for name in file.attrs["columns"]}
        return {name: data.asstr()[:] if data.dtype.kind == "O" else data[:] for name, data in found.items()}, keys


def plot(directory, column, key, output):
    """A column of the table against a key, or whole series against time, a line for every combination of the other keys."""
    import style
    from style import plt

    columns, keys = table(directory)
    for name in column, key:
        expect(name in columns, f"the table has no {name}; there are: {', '.join(columns)}")
    expect(columns[column].ndim == columns[key].ndim, f"{column} and {key} cannot be drawn against each other: one of them is a whole series")
    figure, axis = plt.subplots(figsize=(6.4, 4.4))
    others = [name for name in keys if name != key]
    labels = [", ".join(f"{name.split('/')[-1]} {columns[name][k]}" for name in others) for k in range(len(columns[column]))]
    numbers = columns[key].dtype.kind in "fi"
    for k, label in enumerate(dict.fromkeys(labels)):
        chosen = [i for i, one in enumerate(labels) if one == label]
        x, y = columns[key][chosen], columns[column][chosen]
        if y.ndim > 1:
            for i, (along, values) in enumerate(zip(x, y)):
                axis.plot(along, values, color=style.RUNS[k % len(style.RUNS)], label=label if i == 0 else None)
            continue
        order = numpy.argsort(x)
        few = len(set(labels)) <= 12
        axis.plot(x[order], y[order], "o-" if few else "o", ms=3.5, color=style.RUNS[k % len(style.RUNS)] if few else style.RUNS[0], label=label if few else None)
    if numbers and columns[key].ndim == 1 and columns[key].min() > 0 and columns[key].max() > 30 * columns[key].min():
        axis.set_xscale("log")
    axis.set_xlabel(key)
    axis.set_ylabel(column)
    if axis.get_legend_handles_labels()[1] and others:
        axis.legend(fontsize=7.5)
    style.save(figure, output)


def answer(main):
    """Runs a script's main; what is wrong with its input is one sentence, and exit code 2."""
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        sys.exit(main())
    except Mistake as mistake:
        tell("")
        print(f"{pathlib.Path(sys.argv[0]).name}: {mistake}", file=sys.stderr)
        sys.exit(2)
    except KeyboardInterrupt:
        sys.exit("stopped: the same command goes on from here")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("study", help="the study, a YAML file")
    parser.add_argument("--output", type=pathlib.Path, metavar="DIR", help="of the table and, under runs/, of results (default: results/<study>)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="runs at a time (default: the number of cores)")
    parser.add_argument("--fresh", action="store_true", help="make every run anew, also those that are there")
    parser.add_argument("--list", action="store_true", help="print the settings of the runs, and make none")
    parser.add_argument("--plot", nargs=2, metavar=("COLUMN", "KEY"), help="draw a column of the table against a key, or one column against another")
    parser.add_argument("-o", "--picture", type=pathlib.Path, metavar="FILE", help="the picture (default: <COLUMN>.png beside the table)")
    arguments = parser.parse_args()
    directory = arguments.output or pathlib.Path("results") / pathlib.Path(arguments.study).stem
    expect(arguments.jobs > 0, "--jobs must be at least 1")
    sweep = Sweep(arguments.study, tanktread.Study(directory=directory / "runs", jobs=arguments.jobs, fresh=arguments.fresh))
    if arguments.list:
        for row in sweep.rows:
            print(", ".join(f"{key}={tanktread.text_of(value)}" for key, value in row.items()))
        return 0
    directory.mkdir(parents=True, exist_ok=True)
    sweep.make()
    sweep.write(directory)
    good = sum(outcome.done for outcome in sweep.outcomes)
    if not good:
        print(f"sweep.py: none of the runs came to its end; the first one: {sweep.outcomes[0].message}", file=sys.stderr)
        return 1
    if arguments.plot:
        name = "".join(c if c.isalnum() or c in "._-" else "_" for c in arguments.plot[0]).strip("_")
        plot(directory, *arguments.plot, arguments.picture or directory / f"{name}.png")
    return 0


if __name__ == "__main__":
    answer(main)
