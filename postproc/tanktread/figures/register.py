"""The list of all figures, and the command line of each, which follows from the signature of its function."""

import argparse
import functools
import inspect
import subprocess
import sys
import textwrap
import typing

from ..mistakes import expect
from ..results import Run
from ..runs import SOURCE, run as run_of, runs_of, settings_of
from . import style

FIGURES: dict = {}
BENCHMARK = SOURCE / "tests/benchmark"
RUNS = {"runs": (runs_of, "+", "directories of results, or decks; a deck without results is run"),
        "run": (run_of, None, "directory of results, or a deck; a deck without results is run")}
ENDINGS = {"animation": "gif"}  # file formats of figures that are not written as png
AXES = inspect.Parameter("axes", inspect.Parameter.POSITIONAL_OR_KEYWORD, default=None)


def figure(*size, **layout):
    """Returns the decorator for functions of figures. It sets the style, accepts directories and decks as runs, and
    adds the function to FIGURES.

    The parameters of the function are `runs`, `run`, or a deck or study; then `axes`; then options by keyword. If the
    `size` and `layout` of the panels are given (see `style.panels`; the size may be a function of the runs), the
    function receives the axes of each panel. Otherwise it receives the `axes` of the caller and returns the figure. The
    first paragraph of its docstring is the caption. Lines `option: text` below it describe options on the command
    line."""
    def decorate(function):
        first, *others = inspect.signature(function).parameters.values()
        convert = RUNS.get(first.name, (lambda given: given,))[0]

        @functools.wraps(function)
        def drawn(given=first.default, axes=None, **options):
            expect(given is not first.empty, f"{function.__name__} needs {first.name}")
            expect(not isinstance(given, (list, tuple)) or first.name == "runs",
                   f"the figure `{function.__name__}` needs one {first.name}, but is given a list")
            given = convert(given)
            expect(given != [], f"the figure `{function.__name__}` needs at least one run, but is given an empty list")
            for run in given if isinstance(given, list) else [given]:
                expect(not isinstance(run, Run) or len(run.series["time"]), f"{run} holds no row of series yet")
            with style.plt.rc_context(style.STYLE):
                if not size:
                    return style.dotted(function(given, axes, **options))
                whole, parts = style.panels(axes, *(size[0](given) if callable(size[0]) else size), **layout)
                function(given, *parts, **options)
                return style.dotted(whole)

        drawn.__signature__ = inspect.Signature([first, AXES, *(one for one in others if one.kind is one.KEYWORD_ONLY)])
        FIGURES[function.__name__] = drawn
        return drawn

    return decorate


def caption(function):
    """Returns the first paragraph of the docstring, on one line."""
    return " ".join(inspect.getdoc(function).split("\n\n")[0].split())


def _parsed_as(kind):
    """Returns what argparse needs to know to parse an option of a type."""
    arguments, origin = typing.get_args(kind), typing.get_origin(kind)
    if type(None) in arguments:  # an optional one
        return _parsed_as(arguments[0])
    if kind is bool:
        return {"action": "store_true"}
    if origin is typing.Literal:
        return {"choices": arguments, "type": type(arguments[0])}
    if origin is tuple:
        return {"nargs": len(arguments), "type": arguments[0]}
    if origin is not list:
        return {"type": kind}
    if typing.get_origin(arguments[0]) is tuple:
        return _parsed_as(arguments[0]) | {"action": "append"}
    return {"nargs": "+", "type": arguments[0], "action": "extend", "default": None}


def parser_of(name, program="tanktread-figure"):
    """Returns the parser of a figure's command line."""
    function = FIGURES[name]
    first, _, *options = inspect.signature(function).parameters.values()
    hints, doc = typing.get_type_hints(function), inspect.getdoc(function)
    texts = dict(line.split(": ", 1) for line in doc.split("\n") if ": " in line)
    shown = [line for line in doc.split("\n") if line.split(": ", 1)[0] not in {option.name for option in options}]
    parser = argparse.ArgumentParser(prog=f"{program} {name}", description="\n".join(shown).rstrip(),
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    _, number, words = RUNS.get(first.name, (None, None, f"the {first.name}"))
    if first.default is not first.empty:
        number, words = "?", f"{words} (default: {first.default})"
    parser.add_argument("given", metavar=first.name, nargs=number, default=first.default, help=words)
    parser.add_argument("-o", "--output", default=name, metavar="FILE",
                        help=f"the picture: .png, .pdf, .svg, … (default: {name}.{ENDINGS.get(name, 'png')})")
    if first.name in RUNS:
        parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE",
                            help="sets a key of the deck (repeatable)")
    for option in options:
        told = "" if isinstance(option.default, bool | None) else f" (default: {option.default})"
        kind = {"action": argparse.BooleanOptionalAction} if option.default is True else _parsed_as(hints[option.name])
        if option.name.endswith("_"):  # argparse would show the underscore, which a keyword of Python needs
            kind["metavar"] = option.name[:-1].upper()
        parser.add_argument("--" + option.name.replace("_", "-").removesuffix("-"), **(
            {"dest": option.name, "default": option.default, "help": texts.get(option.name, "") + told} | kind))
    return parser


def measurements():
    """Returns {name: caption} of the scripts of the source directory that measure the program and draw a figure."""
    texts = {path.stem: path.read_text(encoding="utf-8") for path in BENCHMARK.glob("*.py")}
    return {name.replace("_", "-"): " ".join(text.split('"""')[1].split("\n\n")[0].split())
            for name, text in texts.items() if "style.save(" in text and text.startswith("#!")}


def command():
    """Draws a figure from the results of runs, or lists all figures."""
    figures = {name.replace("_", "-"): function for name, function in FIGURES.items()}
    listed = argparse.ArgumentParser(prog="tanktread-figure", description=command.__doc__,
                                     epilog="tanktread-figure FIGURE --help shows the options of a figure")
    listed.add_argument("figure", nargs="?", help="the name of a figure")
    listed.add_argument("--list", action="store_true", help="print all figures with their captions")
    words = sys.argv[1:]
    if not words or words[0].startswith("-"):
        if not listed.parse_args(words).list:
            listed.error("name a figure, or give --list")
        captions = {name: caption(function) for name, function in figures.items()} | measurements()
        for name, text in sorted(captions.items()):
            print(textwrap.fill(text, 118, initial_indent=f"{name:21} ", subsequent_indent=" " * 22,
                                break_on_hyphens=False))
        return 0
    name = words[0].removesuffix(".py").replace("-", "_")
    if name.replace("_", "-") in measurements():
        return subprocess.run([sys.executable, BENCHMARK / f"{name}.py", *words[1:]], check=False).returncode
    expect(name in FIGURES, f"there is no figure {words[0]}; there are: {', '.join(sorted(figures))}")
    parsed = vars(parser_of(name).parse_args(words[1:]))
    given, output = parsed.pop("given"), parsed.pop("output")
    settings = settings_of(parsed.pop("set", []))
    for option, value in parsed.items():
        expect(type(value) is not int or value > 0 or option == "from_", f"--{option} must be above 0, but is {value}")
    if settings:
        given = [run_of(one, settings) for one in given] if isinstance(given, list) else run_of(given, settings)
    style.save(FIGURES[name](given, **{option: value for option, value in parsed.items() if value is not None}), output)
    return 0
