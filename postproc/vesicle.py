#!/usr/bin/python3
"""Vesicles at rest, beside axisymmetric shapes of least energy that are found without tanktread: the section of the last snapshot, the energy over time, and
with --meshes its error against the mesh.

    vesicle.py inputs/vesicle.yaml --meshes 4 6 8 12

Those shapes are r(theta) = exp(a sum of even Legendre polynomials of cos theta), with the volume of the run, its bending modulus and spontaneous curvature,
tension, global area dilatation and area-difference elasticity; a stationary point by Newton's method from a spheroid, so that prolate stays prolate.
"""

import argparse
import pathlib

import needs  # before what it looks for
import numpy
from matplotlib.collections import LineCollection
from numpy.polynomial import legendre
from scipy import optimize

import shape
import study
import style
import sweep
import tanktread
from style import plt

DEGREES = 16, 30, 40  # of the polynomials, from the first on each started from the one before
ROUND = 1e-2  # by which the extents across the axis may differ
COSINE, WEIGHT = legendre.leggauss(400)


class Shape:
    """exp(sum c_k P_2k): values, first and second derivatives of the polynomials at the points, and what is measured of a surface, by complex numbers too."""

    def __init__(self, degree):
        self.bases = [numpy.array([legendre.legval(COSINE, legendre.legder(numpy.eye(l + 1)[l], order)) if l >= order else 0 * COSINE
                                   for l in range(0, degree + 1, 2)]).T for order in (0, 1, 2)]
        self.size = degree // 2 + 1

    def radius(self, c):
        return numpy.exp(self.bases[0] @ c)

    def measures(self, c):
        """Area, volume, the integral of twice the mean curvature, and half that of its square."""
        _, first, second = (basis @ c for basis in self.bases)
        r, sine2 = self.radius(c), 1 - COSINE**2
        slope2, bend = sine2 * (r * first) ** 2, sine2 * r * (second + first**2) - COSINE * r * first  # by theta
        g = numpy.sqrt(r**2 + slope2)
        curvature = (r**2 + 2 * slope2 - r * bend) / g**3 + (1 + COSINE * first) / g
        ring = 2 * numpy.pi * WEIGHT * r * g
        return numpy.array([ring.sum(), 2 * numpy.pi / 3 * WEIGHT @ r**3, ring @ curvature, ring @ curvature**2 / 2])

    def gradients(self, c):
        """Of the measures, shape (4, size), exact to round-off."""
        return numpy.array([self.measures(c + 1e-30j * one).imag / 1e-30 for one in numpy.eye(self.size)]).T


class Energy:
    """Of a run's membrane, a function of the measures, and its derivatives by them."""

    def __init__(self, run):
        def of(key, default=0.0):
            return float(run.value(f"Membrane/{key}", default))

        sweep.expect(run.value("Membrane/law", "") == "surface tension" and run.value("Membrane/bending reference", "") == "flat",
                     f"{run.name}: a vesicle has the law `surface tension` and the bending reference `flat`")
        sweep.expect(run.summary, f"{run.name} has not come to its end")
        last = [run.series[f"length_x{k}"][-1] for k in (1, 2)]
        sweep.expect(abs(last[0] / last[1] - 1) < ROUND,
                     f"{run.name}: its last shape is {last[0]:.4g} long along x1 and {last[1]:.4g} along x2, not axisymmetric about x3")
        sweep.expect(run.value("Flow/type", "") == "quiescent", f"{run.name}: a vesicle at rest is in a `quiescent` fluid")
        numbers = run.summary["numbers"]
        self.area, self.volume = numbers["area"], numbers["volume"]  # of the resting shape, whatever the run began with
        self.tension, self.bending, self.curvature = of("surface tension"), of("bending modulus"), of("spontaneous curvature")
        self.of_area = of("global area dilatation") * self.tension / self.area
        self.of_leaves = numpy.pi * of("area difference modulus") * self.bending / self.area
        self.leaves = of("area difference") * 4 * numpy.sqrt(numpy.pi * self.area)
        sweep.expect(self.of_leaves == 0 or self.leaves > 0, f"{run.name}: give Membrane/area difference")

    def __call__(self, measures):
        area, _, leaves, bent = measures
        return (self.tension * area + self.of_area / 2 * (area - self.area) ** 2 + self.of_leaves / 2 * (leaves - self.leaves) ** 2
                + self.bending * (bent - self.curvature * leaves + self.curvature**2 / 2 * area))

    def by_measures(self, measures):
        area, _, leaves, _ = measures
        return numpy.array([self.tension + self.of_area * (area - self.area) + self.bending * self.curvature**2 / 2, 0,
                            self.of_leaves * (leaves - self.leaves) - self.bending * self.curvature, self.bending])


def at_rest(energy, aspect):
    """The shape of least energy near a spheroid whose axis is `aspect` times its equator: section (r sin, r cos) and energy."""
    first = Shape(DEGREES[0])
    logarithm = -numpy.log(1 - COSINE**2 + (COSINE / aspect) ** 2) / 2
    c = numpy.array([(4 * k + 1) / 2 * (WEIGHT * first.bases[0][:, k]) @ logarithm for k in range(first.size)])
    c[0] += numpy.log(energy.volume / first.measures(c)[1]) / 3
    found = optimize.minimize(lambda c: energy(first.measures(c)), c, jac=lambda c: energy.by_measures(first.measures(c)) @ first.gradients(c), method="SLSQP",
                              constraints={"type": "eq", "fun": lambda c: first.measures(c)[1] / energy.volume - 1,
                                           "jac": lambda c: first.gradients(c)[1] / energy.volume}, options={"maxiter": 500, "ftol": 1e-12})
    c, values = found.x, []
    slopes = first.gradients(c)
    pressure = energy.by_measures(first.measures(c)) @ slopes @ slopes[1] / (slopes[1] @ slopes[1])
    for degree in DEGREES[1:]:
        now = Shape(degree)

        def balance(y):
            gradients, measures = now.gradients(y[:-1]), now.measures(y[:-1])
            return numpy.append(energy.by_measures(measures) @ gradients - y[-1] * gradients[1], measures[1] - energy.volume)

        solved = optimize.root(balance, numpy.append(numpy.pad(c, (0, now.size - len(c))), pressure), tol=1e-13)
        sweep.expect(abs(solved.fun).max() < 1e-8 * energy.bending, f"no axisymmetric shape at rest was found, {abs(solved.fun).max():.1e} is left")
        c, pressure = solved.x[:-1], solved.x[-1]
        values.append(energy(now.measures(c)))
    r, sine = now.radius(c), numpy.sqrt(1 - COSINE**2)
    print(f"axisymmetric: energy {values[-1]:.9g}, of degree {DEGREES[1]} {values[0] - values[-1]:+.1e}")
    return numpy.array([r * sine, r * COSINE]), values[-1]


def errors(path, meshes, output):
    """Control points, relative error of the energy at rest and processor seconds of the deck on meshes."""
    runs = tanktread.Study(directory=output)
    for n in meshes:
        outcome = runs.run(path, {"Surface/elements per side": n})
        sweep.expect(outcome.done, outcome.message)
        run, series = outcome.run, outcome.series
        energy = at_rest(Energy(run), series["length_x3"][-1] / series["length_x1"][-1])[1]
        yield series["n_control_points"][-1], series["energy"][-1] / energy - 1, outcome.processor_seconds


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("deck", type=pathlib.Path, help="a vesicle, axisymmetric about x3; without --meshes the directory of its run will do")
    parser.add_argument("--meshes", type=int, nargs="*", default=[], metavar="N", help="elements per side of further runs")
    parser.add_argument("-o", "--output", default="vesicle.png", metavar="FILE", help="the picture (default: %(default)s)")
    arguments = parser.parse_args()

    deck = arguments.deck if arguments.deck.is_dir() and not arguments.meshes else study.deck_of(arguments.deck)
    run = tanktread.run(deck)
    run.require("energy", "length_x1", "length_x2", "length_x3")
    series = run.series
    outline, energy = at_rest(Energy(run), series["length_x3"][-1] / series["length_x1"][-1])
    print(f"{run.name}: energy {series['energy'][-1]:.9g}, relative error {series['energy'][-1] / energy - 1:.1e}")
    figure, axes = plt.subplots(1, 3 if arguments.meshes else 2, figsize=(10 if arguments.meshes else 7, 3.2))
    last = run.snapshots()[-1]
    middle = last.points.mean(0)
    axes[0].add_collection(LineCollection(shape.section(last, middle[1]) - middle[[0, 2]], colors=style.RUNS[0], linewidths=1.6))
    for side in (-1, 1):
        axes[0].plot(side * outline[0], outline[1], color=style.FAINT, linestyle=(0, (4, 3)), linewidth=1)
    axes[0].set(aspect="equal", xlabel="$x_1$", ylabel="$x_3$")
    axes[1].semilogy(run.time, abs(series["energy"] - energy), color=style.RUNS[0])
    axes[1].set(xlabel=tanktread.time_label([run]), ylabel="|energy - axisymmetric shape's|")
    if arguments.meshes:
        points, error, seconds = numpy.array(list(errors(deck, arguments.meshes, "results/vesicles"))).T
        for row in zip(points, error, seconds):
            print("control points {:.0f}: relative error {:.2e}, {:.2g} processor seconds".format(*row))
        axes[2].loglog(points, abs(error), "o-", color=style.RUNS[0], label="fixed meshes")
        axes[2].loglog(points, abs(error[0]) * (points / points[0]) ** -2, color=style.FAINT, linestyle=(0, (4, 3)), label="fourth order")
        axes[2].set(xlabel="control points", ylabel="relative error of the energy")
        axes[2].legend()
    style.save(figure, arguments.output)
    return 0


if __name__ == "__main__":
    sweep.answer(main)
