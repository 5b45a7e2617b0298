"""Functions shared by all studies: options, tables and bisection."""

import pathlib

import numpy

from ..mistakes import log
from ..runs import PROGRAM, SOURCE, Study, quoted, text_of


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
