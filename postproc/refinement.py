#!/usr/bin/python3
"""D over time with a mark at every change of the mesh, and the number of control points; runs on fixed meshes beside it (the paper's Figure 14).

Of several runs of one scene, how far D is from the first one's stands below, at the times that both have: those of the snapshots.
"""

import argparse

import needs  # before what it looks for
import numpy

import style
import tanktread
from style import plt


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", nargs="+", help="directories of runs' results, or decks")
    parser.add_argument("-o", "--output", default="refinement.png", metavar="FILE", help="the picture (default: %(default)s)")
    parser.add_argument("--steady", type=float, nargs="+", default=[], metavar="D", help="steady values of the literature, drawn at the right")
    parser.add_argument("--deformation", default="taylor_inertia", choices=["taylor_inertia", "taylor_surface"], help="which Taylor parameter")
    arguments = parser.parse_args()

    runs = [tanktread.run(directory) for directory in arguments.results]
    for run in runs:
        run.require("taylor_inertia", "taylor_surface")
    compares = len(runs) > 1 and all(scene(run) == scene(runs[0]) for run in runs)
    heights = [3, 1.5, 1.8] if compares else [3, 1.8]
    figure, axes = plt.subplots(len(heights), 1, figsize=(6.4, 1.25 * sum(heights)), sharex=True, height_ratios=heights)
    upper, lower = axes[0], axes[-1]
    for run, color in zip(runs, style.RUNS * len(runs)):
        t, deformation, points = run.time, run.series[arguments.deformation], run.series["n_control_points"]
        changes = numpy.flatnonzero(numpy.diff(points)) + 1
        upper.plot(t, deformation, color=color, label=f"{run.name}: {points[0]:.0f} → {points[-1]:.0f} control points, D = {deformation[-1]:.4f}")
        upper.plot(t[changes], deformation[changes], "o", color=color, markerfacecolor="white", markersize=4.5)
        lower.step(t, points, where="post", color=color)
        if compares and run is not runs[0]:
            both, mine, firsts = numpy.intersect1d(t.round(9), runs[0].time.round(9), return_indices=True)
            axes[1].plot(both, 1e3 * (deformation[mine] - runs[0].series[arguments.deformation][firsts]), "o-", markersize=3, color=color)
        print(f"{run.name}: {len(changes)} changes of the mesh, D({t[-1]:g}) = {deformation[-1]:.6f}, {points[-1]:.0f} control points")
    end = max(run.time[-1] for run in runs)
    for steady in arguments.steady:
        upper.plot([0.97 * end, 1.03 * end], [steady] * 2, color=style.INK)
    if arguments.steady:
        upper.plot([], [], color=style.INK, label="literature: " + ", ".join(f"{steady:g}" for steady in arguments.steady))
    if compares:
        axes[1].axhline(0, color=style.RUNS[0])
        axes[1].set_ylabel("10³ (D − D of\nthe first)")
    upper.set_ylabel("Taylor parameter D")
    upper.set_ylim(bottom=0)
    upper.legend(loc="lower right")
    lower.set_ylabel("control points")
    lower.set_ylim(bottom=0)
    lower.set_xlabel(tanktread.time_label(runs))
    style.save(figure, arguments.output)


def scene(run):
    """What the mesh has no part in."""
    return [run.deck.get(name) for name in ("Flow", "Particle", "Membrane", "Tube")]


if __name__ == "__main__":
    main()
