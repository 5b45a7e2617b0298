"""Functions shared by all studies: options, tables, bisection, reading of study files. Errors in a study file raise
Mistake."""

import contextlib
import pathlib

import numpy

from ..files import parsed as content_of
from ..mistakes import Mistake, expect, log
from ..runs import PROGRAM, SOURCE, Study, quoted, shared, text_of


def edge(holds, low, high, factor=1.05):
    """Returns the largest value for which holds(value) was found true, the smallest value for which it was found false,
    and how the search ended: `edge`, `holds to here` (true up to `high`) or `fails from here` (false from `low` on). A
    value that was not found is NaN. If the search ended with `edge`, the ratio of the two values is at most `factor`.
    The search bisects the logarithm of the value. It assumes that holds(value) is true below the edge and false above
    it."""
    if not holds(low):
        return numpy.nan, low, "fails from here"
    if holds(high):
        return high, numpy.nan, "holds to here"
    while high / low > factor:
        middle = (low * high) ** 0.5
        low, high = (middle, high) if holds(middle) else (low, middle)
    return low, high, "edge"


def arguments(parser, results, limit=300, jobs=None):
    """Adds the options that all studies share to a parser. Adds `--jobs` only if a default is given."""
    parser.add_argument("--program", default=PROGRAM, type=pathlib.Path,
                        help="path of the program (default: %(default)s)")
    parser.add_argument("--output", default=results, type=pathlib.Path, metavar="DIR",
                        help="directory of figures and tables, and of the runs in runs/ (default: %(default)s)")
    parser.add_argument("--fresh", action="store_true", help="repeat runs that exist already")
    parser.add_argument("--limit", type=float, default=limit, metavar="SECONDS",
                        help="largest processor time of a run (default: %(default)s)" if limit else
                        "largest processor time of a run (default: no limit)")
    if jobs:
        parser.add_argument("--jobs", type=int, default=jobs, help="number of simultaneous runs (default: %(default)s)")


def study(parsed):
    return Study(parsed.program, parsed.output / "runs", parsed.limit, getattr(parsed, "jobs", 1), parsed.fresh)


def write_table(path, head, rows):
    """Writes a CSV file of rows of numbers and words."""
    path.parent.mkdir(parents=True, exist_ok=True)
    lines = [",".join(head)] + [",".join(text_of(entry).replace(",", ";") for entry in row) for row in rows]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    log.info(path)


def command_of(script, *words):
    """Returns the command line, from the source directory, that reproduces a chart; it is printed below the chart."""
    return " ".join([str(pathlib.Path(script).resolve().relative_to(SOURCE)), *map(quoted, words)])


def number(given, name):
    """Returns a value of a YAML file as a float. Accepts strings, because PyYAML reads 1e-2 as a string."""
    with contextlib.suppress(TypeError, ValueError):
        if not numpy.isnan(float(given)):
            return float(given)
    raise Mistake(f"{name}: {given} is not a number")


def positive(given, name):
    """Returns a value as a float. Raises Mistake unless it is above 0 and finite."""
    expect(0 < number(given, name) < numpy.inf, f"{name} must be a number above 0, but is {given}")
    return float(given)


def optional(read, section, key, name):
    """Returns read(value, label) for the value of a key in a section; None if the key is absent."""
    return read(section[key], f"{name}: {key}") if section.get(key) is not None else None


def whole(given, name):
    """Returns an integer. Raises Mistake unless it is above 0."""
    expect(isinstance(given, int) and not isinstance(given, bool) and given > 0,
           f"{name} must be a whole number above 0, but is {given}")
    return given


def keys_of(given, name):
    """Returns a section of a YAML file; {} if it is absent."""
    expect(given is None or isinstance(given, dict), f"{name} must be a section of keys with values, but is {given}")
    return given or {}


def only(given, known, name):
    """Raises Mistake if a section has other keys than those known."""
    for key in given:
        expect(key in known, f"{name}: {key} is not known; there are: {', '.join(known)}")


def study_of(path, sections, others):
    """Returns the content of a study file. Raises Mistake if it has other keys than `deck`, `sections` and `others`.
    Absent sections are {}. `deck` is a list of paths; decks are searched for next to the file, in the current
    directory, and in the directories of shared()."""
    text, known = content_of(path), sorted({"deck"} | sections | others)
    expect(isinstance(text, dict), f"{path} must be a section of keys: {', '.join(known)}")
    only(text, known, path)
    expect(text.get("deck"), f"{path} names no deck")
    decks = []
    for name in text["deck"] if isinstance(text["deck"], list) else [text["deck"]]:
        expect(isinstance(name, str), f"{path}: a deck is the name of a file, but {name} is none")
        places = [folder / name for folder in (pathlib.Path(path).parent, *shared())]
        decks.append(next((place.resolve() for place in places if place.is_file()), None))
        expect(decks[-1], f"{path}: there is no deck {name}, beside it or where the script is started")
    return text | {name: keys_of(text.get(name), f"{path}: {name}") for name in sections} | {"deck": decks}


def values_of(key, given):
    """Returns a list of values from a list, a single value or a range."""
    if isinstance(given, list):
        expect(given, f"{key} has no values")
        return given
    if not isinstance(given, dict):
        return [given]
    expect({"from", "to", "number"} <= set(given), f"{key}: a range has from, to and number")
    only(given, ("from", "to", "number", "spacing"), key)
    return spaced(key, given, numpy.linspace(0, 1, whole(given["number"], f"{key}: number")))


def spaced(key, given, shares):
    """Returns the values at fractions `shares` (n,), from 0 to 1, of the range given by from, to and spacing."""
    low, high = (number(given[end], f"{key}: {end}") for end in ("from", "to"))
    if given.get("spacing", "linear") == "linear":
        return (low + (high - low) * shares).tolist()
    expect(given["spacing"] == "logarithmic", f"{key}: the spacing is linear or logarithmic, not {given['spacing']}")
    expect(low > 0 and high > 0, f"{key}: a logarithmic range is of positive numbers")
    return (low * (high / low) ** shares).tolist()
