#!/usr/bin/python3
"""Refined against uniform meshes: errors of D and of the largest traction against control points and seconds, all at the final time of the runs.

The values to compare with are the finest uniform run's, D extrapolated with the order that the three finest show. Prints what a
refined mesh saves at equal accuracy, from the uniform runs by interpolation of logarithms.
"""

import argparse

import numpy

import read
import shape
import style
from style import plt


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--uniform", nargs="+", required=True, help="directories of runs on fixed meshes, coarse to fine, three at least")
    parser.add_argument("--refined", nargs="+", required=True, help="of runs whose mesh refined itself")
    parser.add_argument("-o", "--output", default="refinement_gain.png", metavar="FILE", help="the picture (default: %(default)s)")
    arguments = parser.parse_args()

    uniform = [result(directory) for directory in arguments.uniform]
    refined = [result(directory) for directory in arguments.refined]
    truth = {"D": extrapolated(uniform, "D"), "traction": uniform[-1]["traction"]}
    for run in uniform + refined:
        print(f"{run['name']:14} {run['points']:5.0f} points {run['seconds']:7.1f} s  D {run['D']:.6f}  largest traction {run['traction']:.4f}")
    figure, axes = plt.subplots(2, 2, figsize=(8.4, 6.6), sharey="row")
    for row, quantity in zip(axes, truth):
        for axis, cost in zip(row, ("points", "seconds")):
            for runs, color, mark, name in (uniform, style.RUNS[0], "o", "uniform"), (refined, style.RUNS[1], "s", "refined"):
                shown = runs[:-1] if runs is uniform else runs
                axis.loglog([run[cost] for run in shown], [error(run, quantity, truth) for run in shown], mark + "-", color=color, label=name)
            axis.set_xlabel({"points": "control points", "seconds": "seconds on one core"}[cost])
        row[0].set_ylabel({"D": "error of D", "traction": "relative error of the largest traction"}[quantity])
    axes[0][0].legend()
    report(uniform, refined, truth)
    style.save(figure, arguments.output)


def result(directory):
    run = read.run(directory)
    shot = run.snapshot_at(None)
    traction = shape.magnitude(shot.sampled(shot.fields["traction"], 12).reshape(-1, 3)).max()
    return {"name": run.name, "points": run.series["n_control_points"][-1], "seconds": run.series["wall_seconds"][-1],
            "D": run.series["taylor_inertia"][-1], "traction": traction}


def extrapolated(runs, quantity):
    """From the three finest: the value at h = 0 of v + c h^p, p between 2 and 6."""
    h = numpy.array([run["points"] for run in runs[-3:]]) ** -0.5
    v = numpy.array([run[quantity] for run in runs[-3:]])
    orders = numpy.linspace(2, 6, 401)
    wanted = (v[0] - v[1]) / (v[1] - v[2])
    found = [(h[0] ** p - h[1] ** p) / (h[1] ** p - h[2] ** p) for p in orders]
    p = orders[numpy.argmin(abs(numpy.array(found) - wanted))]
    value = v[2] - (v[1] - v[2]) * h[2] ** p / (h[1] ** p - h[2] ** p)
    print(f"{quantity}: {value:.7g} from order {p:.2f}; the finest run has {v[2]:.7g}")
    return value


def error(run, quantity, truth):
    return abs(run[quantity] - truth[quantity]) / (truth[quantity] if quantity == "traction" else 1)


def report(uniform, refined, truth):
    for run in refined:
        words = [f"{run['name']}: {run['points']:.0f} points, {run['seconds']:.1f} s"]
        for quantity in truth:
            mine = error(run, quantity, truth)
            errors = numpy.array([error(one, quantity, truth) for one in uniform[:-1]])[::-1]
            words.append(f"error of {quantity} {mine:.1e}")
            for cost in "points", "seconds":
                costs = numpy.array([one[cost] for one in uniform[:-1]])[::-1]
                equal = numpy.exp(numpy.interp(numpy.log(mine), numpy.log(errors), numpy.log(costs)))
                words.append(f"{equal / run[cost]:.2f} times the {cost} uniformly" + (" or more" if mine < errors[0] else ""))
        print(", ".join(words))


if __name__ == "__main__":
    main()
