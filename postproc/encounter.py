#!/usr/bin/python3
"""Two particles that meet: the path of one past the other, the smallest gap between them, and how they deform, against their distance along the flow.

dx, dz: x1 and x3 of the first one's centroid less the second one's, over R_C. `--curve` lays a path of the literature beside them: columns dx, dz, over
`--unit` times R_C.
"""

import argparse
import sys

import needs  # before what it looks for
import numpy

import literature
import style
import tanktread
from style import plt


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", nargs="+", help="directories of runs' results, or decks, which are run when they have none")
    parser.add_argument("--pair", nargs=2, metavar="NAME", help="which two particles (default: the first two)")
    parser.add_argument("--curve", metavar="FILE", help="a path to lay beside them, comma-separated")
    parser.add_argument("--unit", type=float, default=1, help="length of that path's unit, over R_C (default: %(default)s)")
    parser.add_argument("-o", "--output", default="encounter.png", metavar="FILE", help="the picture (default: %(default)s)")
    arguments = parser.parse_args()

    figure, (path, gap, deformation) = plt.subplots(3, 1, figsize=(6.4, 8), sharex=True)
    for run, color in zip([tanktread.run(where) for where in arguments.results], style.RUNS * len(arguments.results)):
        first, second = arguments.pair or pair(run)
        run.require(f"{first}/centroid_x1", f"{second}/centroid_x1")
        dx, dz = ((run.series[f"{first}/centroid_x{k}"] - run.series[f"{second}/centroid_x{k}"]) / run.radius for k in (1, 3))
        path.plot(dx, dz, color=color, label=run.name)
        gap.plot(dx, run.series["smallest_gap"] / run.radius, color=color)
        for name, line in (first, "-"), (second, (0, (4, 2))):
            if f"{name}/taylor_inertia" not in run.series:  # it is rigid
                continue
            deformation.plot(dx, run.series[f"{name}/taylor_inertia"], color=color, linestyle=line, label=name if color == style.RUNS[0] else None)
        least = numpy.argmin(run.series["smallest_gap"])
        print(f"{run.name}: smallest gap {run.series['smallest_gap'][least] / run.radius:.5f} R_C at dx = {dx[least]:.3f}, largest dz {dz.max():.5f}")
    if arguments.curve:
        curve = literature.table(arguments.curve) * arguments.unit
        path.plot(curve[:, 0], curve[:, 1], style.MARKS[0], color=style.FAINT, markersize=3.5, label="literature")
    path.set_ylabel("dz / R$_C$")
    path.legend()
    gap.set_ylabel("smallest gap / R$_C$")
    gap.set_ylim(bottom=0)
    deformation.set_ylabel("D")
    if deformation.lines:
        deformation.legend()
    deformation.set_xlabel("dx / R$_C$")
    style.save(figure, arguments.output)


def pair(run):
    """The first two particles of a run."""
    names = run.particles
    if len(names) < 2:
        sys.exit(f"{run.directory}: an encounter is of two particles, and this run has {max(1, len(names))}")
    return names[:2]


if __name__ == "__main__":
    main()
