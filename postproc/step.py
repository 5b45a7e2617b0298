#!/usr/bin/python3
"""Extents of a capsule against its centroid in a channel that steps: edges rounded with two radii, what they say of sharp edges, and published curves.

    step.py inputs/capsule_step.yaml --radii 0.1 0.05 --finer 'Channel/azimuthal elements=32' --finer 'Surface/elements per side=8'
    step.py inputs/capsule_step.yaml --radii 0.1 0.05 --curves lx.csv ly.csv lz.csv

The extent along x3 has kinks, beside which it is no better than rows are close: --set 'Time/maximum step=0.01' for three digits.

Each --finer is made of both radii beside the deck's own run, and what it changes is told; curves are of what is finest in one way after the other, by
the sum of these changes. An edge rounded with the radius r changes the flow around by r^2q, where q = 0.544 is the power of the velocity beside a sharp
edge of 90 degrees, sin(3 pi q/2) = q (Dean & Montagnon, Proc. Camb. Phil. Soc. 45, 1949), by which two radii say what none is.
"""

import argparse
import pathlib

import needs  # before what it looks for
import numpy
import scipy.interpolate

import style
import study
import sweep
from style import plt

PLACES = 400  # along the way


def power():
    """2 q, by iteration, each of which takes the error down four times."""
    q = 0.5
    for _ in range(60):
        q = (numpy.pi - numpy.arcsin(q)) / (1.5 * numpy.pi)
    return 2 * q


def sharp_edges(of_large, of_small, ratio):
    """What no rounding has, of two radii and their ratio."""
    return of_small - (of_large - of_small) / (ratio**power() - 1)


def extents(outcome, x):
    """Over 2 a, with the centroid at x, by splines, for steps are long; shape (3, x.size)."""
    sweep.expect(outcome.done, f"{outcome.directory}: {outcome.message}")
    series, a = outcome.series, outcome.run.value("Particle/radius", 1.0)
    way = series["centroid_x1"]
    sweep.expect((numpy.diff(way) > 0).all(), f"{outcome.directory}: its centroid went back, so that there are several extents at a place")
    sweep.expect(way[0] <= x[0] and x[-1] <= way[-1], f"{outcome.directory}: --between {x[0]:g} {x[-1]:g}, but it went from {way[0]:g} to {way[-1]:g}")
    return scipy.interpolate.CubicSpline(way, numpy.transpose([series[f"length_x{k}"] for k in (1, 2, 3)]))(x).T / (2 * a)


def of_radius(runs, parsed, radius, x):
    """The extents, with what each --finer changes."""
    def of(words):
        return extents(runs.run(study.deck_of(parsed.deck), {"Channel/corner radius": radius} | study.settings_of(words)), x)
    first = found = of(parsed.set)
    for finer in parsed.finer:
        change = of(parsed.set + [finer]) - first
        print(f"radius {radius:g}, {finer}: changes " + ", ".join(f"{value:.1e}" for value in numpy.abs(change).max(axis=1)), flush=True)
        found = found + change
    return found


def curve_of(path, between):
    """A published curve, rows of a centroid and an extent, and its points between these centroids."""
    try:
        curve = numpy.loadtxt(path, delimiter=",", ndmin=2)
    except (OSError, ValueError) as error:
        raise sweep.Mistake(f"{path} is no curve: {error}") from error
    inside = curve[(curve[:, 0] > between[0]) & (curve[:, 0] < between[1])] if curve.shape[1] == 2 else []
    sweep.expect(len(inside), "{} has no rows of two numbers with the first between {:g} and {:g}".format(path, *between))
    return curve, inside


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("deck", type=pathlib.Path, help="the deck of a particle in a channel with the profile step")
    parser.add_argument("--radii", nargs=2, type=float, required=True, metavar=("LARGE", "SMALL"), help="of the edges")
    parser.add_argument("--finer", action="append", default=[], metavar="KEY=VALUE", help="a key by which runs are made finer; may be there many times")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="another key of all runs; may be there many times")
    parser.add_argument("--curves", nargs=3, type=pathlib.Path, metavar="FILE", help="published extents along x1, x2, x3: a centroid and an extent over 2 a a row")
    parser.add_argument("--between", nargs=2, type=float, default=(-3.9, 4.9), metavar=("LOW", "HIGH"), help="centroids (default: -3.9 4.9)")
    study.arguments(parser, pathlib.Path("results/step"))
    parser.set_defaults(limit=None)
    parsed = parser.parse_args()
    large, small = parsed.radii
    sweep.expect(0 < small < large, f"--radii needs two positive radii, the larger one first, but is given {large:g} and {small:g}")
    sweep.expect(parsed.between[0] < parsed.between[1], "--between needs two centroids that ascend, but is given {:g} and {:g}".format(*parsed.between))
    study.settings_of(parsed.set + parsed.finer)
    curves = [curve_of(path, parsed.between) for path in parsed.curves or []]
    x, runs = numpy.linspace(*parsed.between, PLACES), study.study(parsed)
    of_large, of_small = of_radius(runs, parsed, large, x), of_radius(runs, parsed, small, x)
    sharp = sharp_edges(of_large, of_small, large / small)
    names = ("x₁", "x₂", "x₃")
    figure, axis = plt.subplots(figsize=(7, 5))
    for k, (name, colour) in enumerate(zip(names, style.RUNS)):
        for y, line in ((of_large, ":"), (of_small, "--"), (sharp, "-")):
            axis.plot(x, y[k], line, color=colour, label=f"along {name}" if line == "-" else None)
        at = numpy.argmax(numpy.abs(sharp[k] - of_small[k]))
        print(f"along {name}: radii {large:g} and {small:g} differ by {numpy.abs(of_large[k] - of_small[k]).max():.1e}, sharp edges from {small:g} by "
              f"{abs(sharp[k, at] - of_small[k, at]):.1e} at most, at {x[at]:.2f}")
    for k, (curve, inside) in enumerate(curves):
        off = numpy.interp(inside[:, 0], x, sharp[k]) - inside[:, 1]
        at = numpy.argmax(numpy.abs(off))
        axis.plot(*curve.T, style.MARKS[k], color=style.FAINT, markersize=3, label=f"published, {names[k]}")
        print(f"along {names[k]}: {off[at]:+.4f} off the curve at most, at {inside[at, 0]:.3f}; {numpy.sqrt(numpy.mean(off**2)):.4f} on average")
    axis.set_xlabel("centroid $x_1$")
    axis.set_ylabel("extent over 2a")
    axis.set_title(f"edges sharp (lines), rounded by {small:g} (dashes) and {large:g} (dots)")
    axis.legend()
    style.save(figure, parsed.output / "step.png")
    return 0


if __name__ == "__main__":
    sweep.answer(main)
