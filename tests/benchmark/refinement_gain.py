#!/usr/bin/python3
"""Refined against uniform meshes: errors of D and of the largest traction against control points, kernel evaluations
and seconds.

All at the final time of the runs. The values to compare with are extrapolated from the three finest uniform runs with
the order that they show; the finest is not drawn, for it is too close to them. Prints what a refined mesh saves at
equal accuracy, from the uniform runs by interpolation of logarithms. Kernel evaluations tell the work on a machine that
does other things too.

    tests/benchmark/refinement_gain.py  # runs inputs/hyperbolic_skalak_ca0.8.yaml on seven meshes, to time 2
    tests/benchmark/refinement_gain.py --uniform a b c d --refined e f  # runs of yours
"""

import argparse

from package import answer, draw, numpy, plt, style, tanktread
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

COSTS = {"points": "control points", "kernel": "kernel evaluations", "seconds": "seconds"}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--uniform", nargs="+",
                        help="directories of runs on fixed meshes, coarse to fine, three at least")
    parser.add_argument("--refined", nargs="+", help="of runs whose mesh refined itself")
    parser.add_argument("-o", "--output", default="refinement_gain.png", metavar="FILE",
                        help="the picture (default: %(default)s)")
    arguments = parser.parse_args()

    if not (arguments.uniform or arguments.refined):
        arguments.uniform, arguments.refined = made()
    if not (arguments.uniform and arguments.refined):
        parser.error("--uniform and --refined: both, or none")
    if len(arguments.uniform) < 3:
        parser.error("--uniform: three runs at least, coarse to fine")
    uniform = [result(directory) for directory in arguments.uniform]
    refined = [result(directory) for directory in arguments.refined]
    truth = {quantity: extrapolated(uniform, quantity) for quantity in ("D", "traction")}
    for run in uniform + refined:
        print(f"{run['name']:14} {run['points']:5.0f} points {run['seconds']:7.1f} s  D {run['D']:.6f}  largest "
              f"traction {run['traction']:.4f}")
    figure, axes = plt.subplots(2, 3, figsize=(10.8, 6.6), sharey="row", sharex="col")
    for axis, cost in zip(axes[1], COSTS):
        axis.set_xlabel(COSTS[cost])
    for row, quantity in zip(axes, truth):
        for axis, cost in zip(row, COSTS):
            for runs, color, mark, name in (uniform, style.RUNS[0], "o",
                                            "uniform"), (refined, style.RUNS[1], "s", "refined"):
                shown = runs[:-1] if runs is uniform else runs
                axis.loglog([run[cost] for run in shown], [error(run, quantity, truth) for run in shown], mark + "-",
                            color=color, label=name)
        row[0].set_ylabel({"D": "error of D", "traction": "relative error of the largest traction"}[quantity])
    for run in uniform[:-1] + refined:
        axes[0][0].annotate(f"{run['points']:.0f}", (run["points"], error(run, "D", truth)), (5, 4),
                            textcoords="offset points", fontsize=7.5)
    for scale in axes[1][0].xaxis, axes[1][2].xaxis, axes[1][0].yaxis:
        scale.set_major_locator(LogLocator(subs=(1, 2, 5)))
        scale.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        scale.set_minor_formatter(NullFormatter())
    axes[0][0].legend(loc="lower left")
    report(uniform, refined, truth)
    style.save(figure, arguments.output)


def made():
    """Uniform and refined runs."""
    deck, short = tanktread.SOURCE / "inputs" / "hyperbolic_skalak_ca0.8.yaml", {"Time/final time": 2}
    uniform = [tanktread.results_of(deck, f"refinement_gain/n{n}",
                                    short | {"Adaptation/enabled": "false", "Surface/elements per side": n})
               for n in (6, 8, 11, 15)]
    refined = [tanktread.results_of(deck, f"refinement_gain/tolerance_{tolerance:g}",
                                    short | {"Adaptation/surface tolerance": tolerance})
               for tolerance in (8e-4, 4e-4, 2e-4)]
    return uniform, refined


def result(directory):
    run = tanktread.run(directory)
    shot = run.snapshot_at(None)
    traction = draw.magnitude(shot.sampled(shot.fields["traction"], 12).reshape(-1, 3)).max()
    return {"name": run.name, "points": run.series["n_control_points"][-1], "seconds": run.series["wall_seconds"][-1],
            "kernel": sum(number for name, number in run.summary["counts"].items()
                          if name.startswith("kernel_evaluations")), "D": run.series["taylor_inertia"][-1],
            "traction": traction}


def extrapolated(runs, quantity):
    """From the three finest: the value at h = 0 of v + c h^p, p between 2 and 6; of the finest where they have
    converged to rounding or steps."""
    h = numpy.array([run["points"] for run in runs[-3:]]) ** -0.5
    v = numpy.array([run[quantity] for run in runs[-3:]])
    if (v[0] - v[1]) * (v[1] - v[2]) <= 0:
        print(f"{quantity}: {v[2]:.7g} of the finest run; the three finest agree to {numpy.ptp(v):.1g}")
        return v[2]
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
            for cost in COSTS:
                costs = numpy.array([one[cost] for one in uniform[:-1]])[::-1]
                equal = numpy.exp(numpy.interp(numpy.log(mine), numpy.log(errors), numpy.log(costs)))
                words.append(f"{equal / run[cost]:.2f} times the {COSTS[cost]} uniformly"
                             + (" or more" if mine < errors[0] else ""))
        print(", ".join(words))


if __name__ == "__main__":
    answer(main)
