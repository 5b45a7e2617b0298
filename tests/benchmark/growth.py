#!/usr/bin/python3
"""How a velocity evaluation grows with the mesh: seconds by part, interactions and bytes, with fitted exponents.

    tests/benchmark/growth.py  # runs the program benchmark first: minutes
    # what build/release/tests/benchmark/benchmark --benchmark_filter=growth --benchmark_out=growth.json wrote
    tests/benchmark/growth.py growth.json

Exponents are fitted by least squares to the meshes from --from control points on.
"""

import argparse
import json
import pathlib
import subprocess
import sys

from package import answer, numpy, plt, style, tanktread

PARTS = [("evaluation s", "whole evaluation"), ("layer far s", "far sum"), ("layer near s", "near elements"),
         ("layer self s", "own elements"), ("layer setup s", "nodes and forces"), ("projection s", "sparse solves"),
         ("membrane s", "membrane")]


def rows(benchmarks, dense):
    """Of one kind of far sum, by control points."""
    chosen = [one for one in benchmarks if one["name"].startswith("growth/") and f"/dense:{int(dense)}" in one["name"]]
    return sorted(chosen, key=lambda one: one["points"])


def exponent(chosen, key, least):
    """Slope of log(key) over log(points), or None for fewer than two meshes."""
    known = [one for one in chosen if one["points"] >= least and one.get(key, 0) > 0]
    if len(known) < 2:
        return None
    return numpy.polyfit(numpy.log([one["points"] for one in known]), numpy.log([one[key] for one in known]), 1)[0]


def table(trees, dense, least):
    keys = ["evaluation s", "layer far s", "layer near s", "layer self s", "layer setup s", "projection s",
            "membrane s", "volume s", "setup s", "far interactions", "far error", "bytes kept", "bytes peak"]
    print(f"{'':>18}" + "".join(f"{one['points']:>12.0f}" for one in trees) + f"{'exponent':>12}{'step by step':>16}")
    for key in keys:
        slope = exponent(trees, key, least)
        known = [one for one in trees if one["points"] >= least]
        steps = [numpy.log(b[key] / a[key]) / numpy.log(b["points"] / a["points"]) for a, b in zip(known, known[1:])]
        print(f"{key:>18}" + "".join(f"{one[key]:>12.4g}" for one in trees) + (""
                                                                               if slope is None else f"{slope:>12.2f}")
              + "".join(f"{step:>8.2f}" for step in steps))
    for one in dense:
        print(f"{'dense':>18}  {one['points']:.0f} control points: {one['evaluation s']:.4g} s, "
              f"{one['far interactions']:.4g} far interactions")


def draw(axis, chosen, key, label, color, least, line="o-"):
    slope = exponent(chosen, key, least)
    text = label if slope is None else f"{label}: $N^{{{slope:.2f}}}$"
    axis.loglog([one["points"] for one in chosen], [one[key] for one in chosen], line, color=color, ms=4, label=text)


def measured():
    """The file that the benchmark writes, which is run when there is none."""
    path, program = pathlib.Path("results/growth.json"), tanktread.SOURCE / "build/release/tests/benchmark/benchmark"
    if not path.exists():
        if not program.exists():
            sys.exit(f"{program} does not exist: build it (tests/run does)")
        path.parent.mkdir(exist_ok=True)
        subprocess.run([program, "--benchmark_filter=growth", f"--benchmark_out={path}"], check=True)
    return path


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", nargs="?",
                        help="what the benchmark wrote (default: results/growth.json, written now if it is not there)")
    parser.add_argument("--from", dest="least", type=float, default=3000, metavar="POINTS",
                        help="fit from here on (default: %(default)g)")
    parser.add_argument("-o", "--output", default="growth.png", metavar="FILE",
                        help="the picture (default: %(default)s)")
    arguments = parser.parse_args()
    if arguments.file and not pathlib.Path(arguments.file).is_file():
        sys.exit(f"{arguments.file} is no file: give what the benchmark wrote")
    with open(arguments.file or measured()) as stream:
        benchmarks = json.load(stream)["benchmarks"]
    trees, dense = rows(benchmarks, False), rows(benchmarks, True)
    table(trees, dense, arguments.least)

    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(12.6, 4.4))
    colors = style.RUNS + [style.FAINT, style.INK]
    for (key, label), color in zip(PARTS, colors):
        draw(left, trees, key, label, color, arguments.least)
    if dense:
        draw(left, dense, "evaluation s", "whole, far sum dense", style.FAINT, arguments.least, "o--")
    left.set_title("processor seconds of one velocity evaluation")
    draw(middle, trees, "far interactions", "far sum as chosen", style.RUNS[0], arguments.least)
    if dense:
        draw(middle, dense, "far interactions", "dense", style.FAINT, arguments.least, "o--")
    middle.set_title("pairs of points in the far sum")
    draw(right, trees, "bytes peak", "highest", style.RUNS[0], arguments.least)
    draw(right, trees, "bytes kept", "kept", style.RUNS[1], arguments.least)
    right.set_title("bytes, mesh and fit not counted")
    for axis in (left, middle, right):
        axis.set_xlabel("control points")
        axis.legend(loc="upper left")
    left.set_ylim(top=left.get_ylim()[1] * 1000)  # room for the legend
    error = max(one["far error"] for one in trees)
    figure.supxlabel("\\$ build/release/tests/benchmark/benchmark --benchmark_filter=growth "
                     "--benchmark_out=growth.json; tests/benchmark/growth.py growth.json\n"
                     "a capsule in shear on one core, tolerance 1e-5; far sum against the dense one: "
                     f"at most {error:.1e} of the largest velocity", x=0.01, ha="left", fontsize=7.5)
    style.save(figure, arguments.output)


if __name__ == "__main__":
    answer(main)
