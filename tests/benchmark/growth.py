#!/usr/bin/python3
"""Cost of a velocity evaluation against the size of the mesh: seconds of each part, pairs of points and bytes, with
fitted exponents.

    tests/benchmark/growth.py  # first runs the program `benchmark`, which takes minutes
    tests/benchmark/growth.py growth.json

growth.json is the file that this command writes:
build/release/tests/benchmark/benchmark --benchmark_filter=growth --benchmark_out=growth.json

The exponents are fitted by least squares to the meshes with at least --from control points.
"""

import json
import pathlib
import subprocess

from package import answer, command_line, expect, footer, numpy, plt, scenes_of, style, table, tanktread
from tanktread.files import parsed as read

CHARTS, KEYS = scenes_of(__file__).values()


def measured():
    """Returns the file that the benchmark writes, which is run if there is none."""
    path, program = pathlib.Path("results/growth.json"), tanktread.SOURCE / "build/release/tests/benchmark/benchmark"
    if not path.exists():
        expect(program.exists(), f"{program} does not exist: build it (tests/run does)")
        path.parent.mkdir(exist_ok=True)
        subprocess.run([program, "--benchmark_filter=growth", f"--benchmark_out={path}"], check=True)
    return path


def exponent(meshes, key, least):
    """Returns the slope of log(key) over log(points), as text, or "" for fewer than two meshes."""
    known = [(one["points"], one[key]) for one in meshes if one["points"] >= least and one.get(key, 0) > 0]
    return f"{numpy.polyfit(*numpy.log(known).T, 1)[0]:.2f}" if len(known) > 1 else ""


def draw(axis, meshes, lines, least, colors, dash="o-"):
    for (key, label), color in zip(lines.items(), colors):
        slope = exponent(meshes, key, least)
        axis.loglog([one["points"] for one in meshes], [one[key] for one in meshes], dash, color=color, ms=4,
                    label=f"{label}: $N^{{{slope}}}$" if slope else label)


def main():
    parser = command_line(__doc__)
    parser.add_argument("file", nargs="?", help="results of the program `benchmark` (default: results/growth.json, "
                        "which is made if it does not exist)")
    parser.add_argument("--from", dest="least", type=float, default=3000, metavar="POINTS",
                        help="fewest control points of a mesh in the fit (default: %(default)g)")
    parser.add_argument("-o", "--output", default="growth.png", metavar="FILE",
                        help="file of the figure (default: %(default)s)")
    arguments = parser.parse_args()
    found = read(arguments.file or measured(), json.loads)["benchmarks"]
    trees, dense = ([one for one in sorted(found, key=lambda one: one.get("points", 0))
                     if one["name"].startswith("growth/") and f"/dense:{kind}" in one["name"]] for kind in (0, 1))
    table(["", *(f"{one['points']:.0f}" for one in trees), "exponent"], (
        [key, *(f"{one[key]:.4g}" for one in trees), exponent(trees, key, arguments.least)] for key in KEYS))
    figure, axes = plt.subplots(1, 3, figsize=(12.6, 4.4))
    for axis, chart in zip(axes, CHARTS):
        draw(axis, trees, chart["chosen"], arguments.least, style.RUNS + [style.FAINT, style.INK])
        draw(axis, dense, chart["dense"] if dense else {}, arguments.least, [style.FAINT], "o--")
        axis.set(title=chart["title"], xlabel="control points")
        axis.legend(loc="upper left")
    axes[0].set_ylim(top=axes[0].get_ylim()[1] * 1000)  # leaves space for the legend
    error = max(one["far error"] for one in trees)
    footer(figure, "$ build/release/tests/benchmark/benchmark --benchmark_filter=growth --benchmark_out=growth.json; "
           "tests/benchmark/growth.py growth.json\na capsule in shear on one core, tolerance 1e-5; far sum against the "
           f"dense one: at most {error:.1e} of the largest velocity")
    style.save(figure, arguments.output)


if __name__ == "__main__":
    answer(main)
