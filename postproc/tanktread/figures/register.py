"""The list of all figures, and the command line of each, which follows from the signature of its function."""

import argparse
import functools
import inspect
import pathlib
import subprocess
import sys
import textwrap
import typing

from ..mistakes import expect
from ..results import Run
from ..runs import run as run_of
from ..runs import SOURCE, runs_of, settings_of
from .style import draw, save

FIGURES: dict = {}
BENCHMARK = SOURCE / "tests/benchmark"
RUNS = {"runs": (runs_of, "+", "directories of results, or decks, which are run if they have none"),
        "run": (run_of, None, "directory of results, or a deck, which is run if it has none")}


def figure(function):
    """Decorates the function of a figure: sets the style, accepts directories and decks as runs, adds it to FIGURES.

    Parameters are `runs`, `run`, or a deck or study; `axes`; and options by keyword. The first paragraph of the
    docstring is the caption; lines `option: text` below it describe options on the command line."""
    first = next(iter(inspect.signature(function).parameters))
    convert = RUNS.get(first, (lambda given: given,))[0]

    @functools.wraps(function)
    def drawn(given=inspect.signature(function).parameters[first].default, axes=None, **options):
        expect(given is not inspect.Parameter.empty, f"{function.__name__} needs {first}")
        given = convert(given)
        for run in given if isinstance(given, list) else [given]:
            expect(not isinstance(run, Run) or len(run.series["time"]), f"{run} holds no row of series yet")
        return draw(functools.partial(function, **options), given, axes)

    FIGURES[function.__name__] = drawn
    return drawn


def caption(function):
    """Returns the first paragraph of the docstring, on one line."""
    return " ".join(inspect.getdoc(function).split("\n\n")[0].split())


def _options(function):
    """Yields (name, default, type, help) of the keyword options."""
    hints = typing.get_type_hints(function)
    lines = dict(line.split(": ", 1) for line in inspect.getdoc(function).split("\n") if ": " in line)
    for name, one in list(inspect.signature(function).parameters.items())[2:]:
        kind = hints[name]
        inner = [each for each in typing.get_args(kind) if each is not type(None)]
        if type(None) in typing.get_args(kind):  # an optional one
            kind = inner[0]
        yield name, one.default, kind, lines.get(name, "")


def parser_of(name, program="tanktread-figure"):
    """Returns the parser of a figure's command line."""
    function = FIGURES[name]
    parameter = next(iter(inspect.signature(function).parameters.values()))
    parser = argparse.ArgumentParser(prog=f"{program} {name}", description=inspect.getdoc(function),
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    _, number, words = RUNS.get(parameter.name, (None, None, f"the {parameter.name}"))
    if parameter.default is not parameter.empty:
        number, words = "*" if number == "+" else "?", f"{words} (default: {parameter.default or 'runs made for it'})"
    parser.add_argument("given", metavar=parameter.name, nargs=number, default=parameter.default, help=words)
    parser.add_argument("-o", "--output", default=getattr(function, "output", f"{name}.png"), metavar="FILE",
                        help="the picture: .png, .pdf, .svg, … (default: %(default)s)")
    if parameter.name in RUNS:
        parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE",
                            help="a key of the deck (repeatable)")
    for option, default, kind, text in _options(function):
        more = {"default": default, "help": text + ("" if default in (None, False) else f" (default: {default})"),
                "dest": option}
        arguments, origin = typing.get_args(kind), typing.get_origin(kind)
        if kind is bool:
            more["action"] = "store_true"
        elif origin is typing.Literal:
            more["choices"] = arguments
        elif origin is list and typing.get_origin(arguments[0]) is tuple:
            pair = typing.get_args(arguments[0])
            more |= {"nargs": len(pair), "type": pair[0], "action": "append"}
        elif origin is list:
            more |= {"nargs": "+", "type": arguments[0], "action": "extend", "default": None}
        elif origin is tuple:
            more |= {"nargs": len(arguments), "type": arguments[0]}
        else:
            more["type"] = kind
        parser.add_argument("--" + option.replace("_", "-").removesuffix("-"), **more)
    return parser


def measurements():
    """Returns {name: caption} of the scripts of the source directory that measure the program and draw a figure."""
    texts = {path.stem: path.read_text(encoding="utf-8") for path in BENCHMARK.glob("*.py")}
    return {name.replace("_", "-"): " ".join(text.split('"""')[1].split("\n\n")[0].split())
            for name, text in texts.items() if "style.save(" in text and text.startswith("#!")}


def command():
    """Draws one of the figures from runs, or lists all."""
    names = [name.replace("_", "-") for name in FIGURES]
    listed = argparse.ArgumentParser(prog="tanktread-figure", description=command.__doc__,
                                     epilog="tanktread-figure FIGURE --help shows the options of one")
    listed.add_argument("figure", nargs="?", help="the name of a figure")
    listed.add_argument("--list", action="store_true", help="print all figures with their captions")
    words = sys.argv[1:]
    if not words or words[0].startswith("-"):
        if not listed.parse_args(words).list:
            listed.error("name a figure, or give --list")
        captions = {name.replace("_", "-"): caption(function) for name, function in FIGURES.items()} | measurements()
        for name, text in sorted(captions.items()):
            print(textwrap.fill(text, 118, initial_indent=f"{name:21} ", subsequent_indent=" " * 22))
        return 0
    name = words[0].removesuffix(".py").replace("-", "_")
    if name.replace("_", "-") in measurements():
        return subprocess.run([sys.executable, BENCHMARK / f"{name}.py", *words[1:]], check=False).returncode
    expect(name in FIGURES, f"there is no figure {words[0]}; there are: {', '.join(sorted(names))}")
    parsed = vars(parser_of(name).parse_args(words[1:]))
    given, output = parsed.pop("given"), pathlib.Path(parsed.pop("output"))
    settings = settings_of(parsed.pop("set", []))
    for option, value in parsed.items():
        expect(type(value) is not int or value > 0 or option == "from_", f"--{option} must be above 0, but is {value}")
    if settings:
        given = [run_of(one, settings) for one in given] if isinstance(given, list) else run_of(given, settings)
    save(FIGURES[name](given, **{option: value for option, value in parsed.items() if value is not None}), output)
    return 0
