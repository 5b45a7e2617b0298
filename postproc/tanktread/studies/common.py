"""Options, tables and the bisection that the studies share."""

import pathlib

from ..mistakes import log
from ..runs import PROGRAM, Study, quoted, text_of


def edge(holds, low, high, factor=1.05):
    """Returns the largest value at which `holds` is true, by bisection of the logarithm to a factor, and how the search
    ended: `edge`, `holds to here` (high) or `fails from here` (low). `holds` is assumed true below the edge and false
    above."""
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


def arguments(parser, results, limit=300, jobs=None):
    """Adds the options that all studies share to a parser; `--jobs` if there is a default for it."""
    parser.add_argument("--program", default=PROGRAM, type=pathlib.Path, help="default: %(default)s")
    parser.add_argument("--output", default=results, type=pathlib.Path, metavar="DIR",
                        help="of pictures, tables and, under runs/, results (default: %(default)s)")
    parser.add_argument("--fresh", action="store_true", help="make every run anew, also those that are there")
    parser.add_argument("--limit", type=float, default=limit, metavar="SECONDS",
                        help="of processor time that one run may take (default: %(default)s)")
    if jobs:
        parser.add_argument("--jobs", type=int, default=jobs, help="runs at a time (default: %(default)s)")


def study(parsed):
    return Study(parsed.program, parsed.output / "runs", parsed.limit, getattr(parsed, "jobs", 1), parsed.fresh)


def write_table(path, head, rows):
    """Writes a CSV file of rows of numbers and words."""
    path.parent.mkdir(parents=True, exist_ok=True)
    lines = [",".join(head)] + [",".join(text_of(entry).replace(",", ";") for entry in row) for row in rows]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    log.info(path)


def command_of(script, *words):
    """Returns the command line that makes a chart again, which is printed below it."""
    return " ".join([f"{pathlib.Path(script).parent.name}/{pathlib.Path(script).name}", *map(quoted, words)])
