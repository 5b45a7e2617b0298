"""Imported first: the package tanktread of this source directory, and what several measurements use."""

import hashlib
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
INPUTS = tanktread.SOURCE / "inputs"
SHEAR, RATIO, SIDE = "inputs/shear_neo_hookean.yaml", "Particle/viscosity ratio", "Surface/elements per side"
PENS = [{"color": color, "marker": mark, "ms": 5} for color, mark in zip(style.RUNS, style.MARKS)]
__all__ = ["INPUTS", "PENS", "RATIO", "SHEAR", "SIDE", "answer", "changed", "command_line", "draw", "expect",
           "final", "footer", "interpolation", "line", "lines", "numpy", "plt", "scenes_of", "studies", "style", "table",
           "tanktread", "ticks", "worst", "yaml"]


def scenes_of(script):
    """Returns the content of scenes/<name of the script>.yaml."""
    path = pathlib.Path(script)
    return tanktread.files.parsed(path.parent / "scenes" / f"{path.stem}.yaml", kind=dict)


def table(head, rows):
    """Prints a Markdown table; each row, a list of texts and numbers, as soon as it is there."""
    print("| " + " | ".join(head) + " |\n" + "|---" * len(head) + "|", flush=True)
    for row in rows:
        print("| " + " | ".join(f"{one:.3g}" if isinstance(one, float) else str(one) for one in row) + " |", flush=True)


def changed(deck, directory, without=(), **sections):
    """Writes a copy of a deck of inputs/ without some sections and with others replaced, and returns its path."""
    content = {key: value for key, value in yaml.safe_load((INPUTS / f"{deck}.yaml").read_text())["Tanktread"].items()
               if key not in without}
    text = yaml.safe_dump({"Tanktread": content | sections})
    path = pathlib.Path(directory) / "decks" / f"{deck}_{hashlib.sha1(text.encode()).hexdigest()[:8]}.yaml"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    return path.resolve()


def line(study, axes, name, jobs, measures, x=None, **pen):
    """Makes the runs of a line of a figure and draws it: one measure on each of the axes, which may be fewer.

    `jobs`: {x: (deck, settings)}; `measures`: functions of an outcome, and `x` another one for what is not known
    before. Returns rows (name, x, *measures, message), with NaN of runs that did not come to their end."""
    rows = []
    for at, (deck, settings) in jobs.items():
        outcome = study.run(deck, settings)
        values = [measure(outcome) if outcome.done else numpy.nan for measure in measures]
        rows.append((name, x(outcome) if x and outcome.done else at, *values, outcome.message[:100]))
    for axis, column in zip(axes, zip(*(row[2:-1] for row in rows))):
        axis.plot([row[1] for row in rows], column, label=name, **pen)
    return rows


def lines(study, axes, given, job, measures, x=None):
    """Draws a `line` of each of the `cases` of a map (scenes/atlas.yaml), {name: settings}, over its `values`.

    `job`: function of a value that returns the deck and the settings of a run. Returns the rows of all lines."""
    rows = []
    for (name, settings), pen in zip(given["cases"].items(), PENS):
        jobs = {at: (job(at)[0], given.get("base", {}) | settings | job(at)[1]) for at in given["values"]}
        rows += line(study, axes, name, jobs, measures, x, **pen)
    return rows


def final(name):
    """Returns the measure of `line` that is the last value of a series."""
    return lambda outcome: outcome.final[name]


def worst(name):
    """Returns the measure of `line` that is the largest absolute value of a series over the run."""
    return lambda outcome: numpy.nanmax(abs(outcome.series[name]))


def ticks(axis, values, label):
    """Marks these values on a logarithmic axis x, and no others."""
    axis.set(xscale="log", xlabel=label)
    axis.set_xticks(values, [f"{value:g}" for value in values])
    axis.minorticks_off()


def footer(figure, text, **look):
    """Writes a text that may hold a command, after a dollar sign, below a figure."""
    figure.supxlabel(text.replace("$ ", r"\$ "), x=0.01, ha="left", fontsize=7.5, **look)
