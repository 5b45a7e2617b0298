#!/usr/bin/python3
"""What a dilute suspension of the particle shows in simple shear: intrinsic viscosity and normal stress differences over time, from the stresslet S.

    [η] = S_13/(μ γ̇ V),   N1 = (S_11 − S_33)/(μ γ̇ V),   N2 = (S_33 − S_22)/(μ γ̇ V)

per volume of particles in a volume of suspension; flow along x1, its gradient along x3. A rigid sphere has [η] = 5/2 (Einstein 1906).
"""

import argparse
import sys

import needs  # before what it looks for
import numpy

import style
import tanktread
from style import plt


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", nargs="+", help="directories of runs' results, or decks, which are run when they have none")
    parser.add_argument("-o", "--output", default="rheology.png", metavar="FILE", help="the picture (default: %(default)s)")
    arguments = parser.parse_args()

    runs = [tanktread.run(where) for where in arguments.results]
    figure, (upper, lower) = plt.subplots(2, 1, figsize=(6.4, 6.4), sharex=True)
    for run, color in zip(runs, style.RUNS * len(runs)):
        viscosity, n1, n2 = rheology(run)
        upper.plot(run.time, viscosity, color=color, label=run.name)
        lower.plot(run.time, n1, color=color, label="N₁" if run is runs[0] else None)
        lower.plot(run.time, n2, color=color, linestyle=(0, (4, 2)), label="N₂" if run is runs[0] else None)
        print(f"{run.name}, t = {run.time[-1]:g}: [η] = {viscosity[-1]:.5f}, N1 = {n1[-1]:.5f}, N2 = {n2[-1]:.5f}")
    upper.set_ylabel("intrinsic viscosity [η]")
    upper.legend()
    lower.axhline(0, color=style.FAINT, linewidth=0.8)
    lower.set_ylabel("normal stress differences / (μ γ̇ φ)")
    lower.set_xlabel(tanktread.time_label(runs))
    lower.legend()
    style.save(figure, arguments.output)


def rheology(run):
    """[η], N1 and N2 over time, without a unit."""
    if run.value("Flow/type") != "simple shear":
        sys.exit(f"{run.directory}: intrinsic viscosity is drawn of simple shear, and this is {run.value('Flow/type')}")
    run.require("stresslet_13")
    unit = run.value("Flow/viscosity", 1) * run.rate[0] * volume(run)
    s11, s22, s33, s13 = (run.series[f"stresslet_{k}"] / unit for k in ("11", "22", "33", "13"))
    return s13, s11 - s33, s33 - s22


def volume(run):
    """Of the particle: the series, or of a rigid one by the divergence theorem on its first picture."""
    if "volume" in run.series:
        return run.series["volume"][0]
    x = run.snapshots()[0]
    grid = x.sampled(x.points, 16)
    a, b, c, d = grid[:, :-1, :-1], grid[:, :-1, 1:], grid[:, 1:, 1:], grid[:, 1:, :-1]
    return sum(numpy.einsum("...i,...i", p, numpy.cross(q, r)).sum() for p, q, r in ((a, b, c), (a, c, d))) / 6


if __name__ == "__main__":
    main()
