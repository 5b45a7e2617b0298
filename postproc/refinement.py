#!/usr/bin/python3
"""D over time with a mark at every change of the mesh, and the number of control points; runs on fixed meshes beside it (the paper's Figure 14)."""

import argparse

import numpy

import read
import style
from style import plt


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("results", nargs="+", help="directories of runs' results")
    parser.add_argument("-o", "--output", default="refinement.png", metavar="FILE", help="the picture (default: %(default)s)")
    parser.add_argument("--steady", type=float, metavar="D", help="a steady value of the literature, drawn at the right")
    parser.add_argument("--deformation", default="taylor_inertia", choices=["taylor_inertia", "taylor_surface"], help="which Taylor parameter")
    arguments = parser.parse_args()

    figure, (upper, lower) = plt.subplots(2, 1, figsize=(6.4, 6), sharex=True, height_ratios=[3, 2])
    for directory, color in zip(arguments.results, style.RUNS * len(arguments.results)):
        run = read.run(directory)
        t, deformation, points = (run.series[name] for name in ("time", arguments.deformation, "n_control_points"))
        changes = numpy.flatnonzero(numpy.diff(points)) + 1
        upper.plot(t, deformation, color=color, label=f"{run.name}: {points[0]:.0f} → {points[-1]:.0f} control points, D = {deformation[-1]:.4f}")
        upper.plot(t[changes], deformation[changes], "o", color=color, markerfacecolor="white", markersize=4.5)
        lower.step(t, points, where="post", color=color)
        print(f"{run.name}: {len(changes)} changes of the mesh, D({t[-1]:g}) = {deformation[-1]:.6f}, {points[-1]:.0f} control points")
    if arguments.steady is not None:
        end = max(line.get_xdata()[-1] for line in upper.lines if len(line.get_xdata()))
        upper.plot([0.97 * end, 1.03 * end], [arguments.steady] * 2, color=style.INK, label=f"literature, {arguments.steady:g}")
    upper.set_ylabel("Taylor parameter D")
    upper.set_ylim(bottom=0)
    upper.legend(loc="lower right")
    lower.set_ylabel("control points")
    lower.set_ylim(bottom=0)
    lower.set_xlabel("time · rate")
    style.save(figure, arguments.output)


if __name__ == "__main__":
    main()
