#!/usr/bin/python3
"""Maps of the limits of numerical methods: each map shows where a method stops working, and what works instead.

    tests/benchmark/atlas.py --list  # the maps with their titles
    tests/benchmark/atlas.py --map fixed-step  # one of them: results/atlas/fixed-step.png and fixed-step.csv
    tests/benchmark/atlas.py  # all: an hour or two on one core

The limits are found from short runs, some by bisection. Runs are kept under results/atlas/runs and are not repeated.
Tests in tests/stability check what the maps show (see README.md there).
"""

import textwrap

from package import answer, command_line, footer, plt, scenes_of, studies, style
import edges_of_methods
import edges_of_shapes

MAPS = scenes_of(__file__)
FUNCTIONS = vars(edges_of_methods) | vars(edges_of_shapes)


def draw(name, study, output):
    """Draws a map, with its text and the command that reproduces it below the chart, and writes its table."""
    given = MAPS[name]
    print(f"{name}: {given['title']}", flush=True)
    figure, (axes,) = plt.subplots(1, len(given["axes"]), squeeze=False, **given["figure"])
    rows = list(FUNCTIONS[given.get("function", name.replace("-", "_"))](study, given, axes))
    for axis, calls in zip(axes, given["axes"]):
        if "ticks" in given:
            values = list(given["values"])
            axis.set(xscale="log", xticks=values, xticklabels=[f"{value:g}" for value in values])
            axis.set_xticks([], minor=True)
        for method, arguments in calls.items():
            getattr(axis, method)(**arguments)
    if "legend" in given:
        figure.legend(*axes[1].get_legend_handles_labels(), **given["legend"])
    width = int(figure.get_size_inches()[0] * 15.5)
    words = "\n".join(textwrap.fill(paragraph, width) for paragraph in given["text"].splitlines())
    figure.suptitle(given["title"], x=0.01, ha="left", fontsize=11)
    footer(figure, f"{words}\n\n$ {studies.command_of(__file__, '--map', name)}", color=style.INK)
    studies.write_table(output / f"{name}.csv", given["head"], rows)
    style.save(figure, output / f"{name}.png")


def main():
    parser = command_line(__doc__)
    parser.add_argument("--map", nargs="+", default=list(MAPS), choices=list(MAPS), metavar="NAME",
                        help="names of maps (default: all)")
    parser.add_argument("--list", action="store_true",
                        help="print the names and titles of the maps without running anything")
    studies.arguments(parser, "results/atlas", jobs=1)
    parsed = parser.parse_args()
    study = studies.study(parsed)
    for name in parsed.map:
        if parsed.list:
            print(f"{name:22}{MAPS[name]['title']}")
        else:
            draw(name, study, parsed.output)


if __name__ == "__main__":
    answer(main)
