#!/usr/bin/python3
"""The atlas of failure: for a method, the edge where it stops working, found by bisection on short runs, drawn and
explained.

    tests/benchmark/atlas.py --list  # the maps, with what each shows
    tests/benchmark/atlas.py --map fixed-step  # one of them: results/atlas/fixed-step.png and fixed-step.csv
    tests/benchmark/atlas.py  # all: an hour or two on one core

Runs are kept under results/atlas/runs and not made again. What a map shows is held by a test of tests/stability
(README.md there).
"""

import textwrap

from package import answer, command_line, studies, style
import edges_of_membranes
import edges_of_meshes
import edges_of_shapes
import edges_of_steps
import edges_of_tolerances

MAPS = {}
for module in edges_of_steps, edges_of_membranes, edges_of_meshes, edges_of_tolerances, edges_of_shapes:
    MAPS |= {function.__name__.replace("_", "-"): function for function in module.MAPS}


def caption(figure, function, command):
    """What the map shows, and the command that makes it, under the chart."""
    width = int(figure.get_size_inches()[0] * 15.5)
    paragraphs = [" ".join(part.split()) for part in function.__doc__.split("\n\n")]
    words = "\n".join(textwrap.fill(part, width) for part in paragraphs[1:])
    figure.suptitle(paragraphs[0], x=0.01, ha="left", fontsize=11)
    figure.supxlabel(f"{words}\n\n$ {command}".replace("$ ", r"\$ "), x=0.01, ha="left", fontsize=7.5, color=style.INK)


def draw(name, study, output):
    function = MAPS[name]
    print(f"{name}: {function.__doc__.splitlines()[0]}", flush=True)
    figure, head, rows = function(study)
    caption(figure, function, studies.command_of(__file__, "--map", name))
    studies.write_table(output / f"{name}.csv", head, rows)
    style.save(figure, output / f"{name}.png")


def main():
    parser = command_line(__doc__)
    parser.add_argument("--map", nargs="+", default=list(MAPS), choices=list(MAPS), metavar="NAME",
                        help="which (default: all)")
    parser.add_argument("--list", action="store_true", help="print the maps and what they show, run nothing")
    studies.arguments(parser, "results/atlas", jobs=1)
    parsed = parser.parse_args()
    if parsed.list:
        for name in parsed.map:
            print(f"{name:22}{MAPS[name].__doc__.splitlines()[0]}")
        return
    study = studies.study(parsed)
    for name in parsed.map:
        draw(name, study, parsed.output)


if __name__ == "__main__":
    answer(main)
