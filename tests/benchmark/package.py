"""Imports the package tanktread of this source directory. Contains functions shared by several measurements. Unless
OMP_NUM_THREADS is set, measured runs use one thread, because other threads that wait use processor time too."""

import os
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "postproc"))
try:
    import numpy
    import tanktread
    import yaml
    from tanktread import interpolation
    from tanktread.figures import draw, style
    from tanktread.mistakes import answer, command_line, expect
    from tanktread.studies import common as studies
except ModuleNotFoundError as error:
    sys.exit(f"{sys.executable} has no {error.name}: use Debian's /usr/bin/python3 (app/packages.txt)")

plt = style.plt
plt.switch_backend("Agg")
plt.rcParams.update(style.STYLE)
os.environ.setdefault("OMP_NUM_THREADS", "1")
INPUTS, SCENES = tanktread.SOURCE / "inputs", tanktread.SOURCE / "tests/benchmark/scenes"
SHEAR, RATIO, SIDE = "inputs/shear_neo_hookean.yaml", "Particle/viscosity ratio", "Surface/elements per side"
PENS = [{"color": color, "marker": mark, "ms": 5} for color, mark in zip(style.RUNS, style.MARKS)]


def scenes_of(script):
    """Returns the content of scenes/<name of the script>.yaml."""
    return tanktread.files.parsed(SCENES / f"{pathlib.Path(script).stem}.yaml", kind=dict)


def choice_of(parser, scenes):
    """Adds the option --scene to a parser: which of the `scenes` are measured."""
    parser.add_argument("--scene", nargs="+", default=list(scenes), choices=scenes, metavar="NAME",
                        help=f"names of scenes (default: all): {', '.join(scenes)}")


def table(head, rows):
    """Prints a Markdown table. Each row, a list of texts and numbers, is printed as soon as it is available."""
    print("| " + " | ".join(head) + " |\n" + "|---" * len(head) + "|", flush=True)
    for row in rows:
        print("| " + " | ".join(f"{one:.3g}" if isinstance(one, float) else str(one) for one in row) + " |", flush=True)


def line(study, axes, name, deck, jobs, measures, x=None, **pen):
    """Makes the runs of one line of a figure and draws it. The first measures are drawn, one on each of the axes.

    `jobs`: {x: settings}; `measures`: functions of an outcome, or names of series, whose last values are drawn; `x`: a
    series whose last values are the abscissas instead of those in `jobs`. Returns rows (name, x, *measures, message),
    with NaN for runs that were not completed."""
    rows = []
    for at, settings in jobs.items():
        outcome = study.run(deck, settings)
        values = [numpy.nan] * len(measures)
        if outcome.done:
            values = [outcome.final[one] if isinstance(one, str) else one(outcome) for one in measures]
            at = outcome.final[x] if x else at
        rows.append((name, at, *values, outcome.message[:100]))
    for axis, column in zip(axes, zip(*(row[2:-1] for row in rows))):
        axis.plot([row[1] for row in rows], column, **{"label": name} | pen)
    return rows


def varied(given):
    """Returns {value: settings} for the axis x of a map (scenes/atlas.yaml)."""
    return {value: {given["key"]: value} for value in given["values"]} if "key" in given else given["values"]


def lines(study, axes, given, measures, x=None, pens=PENS):
    """Draws one line() for each of the `cases` {name: settings} of a map. Returns the rows of all lines."""
    rows = []
    for (name, settings), pen in zip(given["cases"].items(), pens):
        jobs = {value: given["base"] | settings | more for value, more in varied(given).items()}
        rows += line(study, axes, name, given["deck"], jobs, measures, x, **pen)
    return rows


def footer(figure, text, **look):
    """Writes a text below a figure. The part of the text after a dollar sign is a command."""
    figure.supxlabel(text.replace("$ ", r"\$ "), x=0.01, ha="left", fontsize=7.5, **look)
