"""Figures of drops with surfactant, and of vesicles at rest compared with axisymmetric solutions by Legendre
polynomials."""

import numpy
from numpy.polynomial import legendre
from scipy import optimize

from ..mistakes import expect, log
from ..results import time_label
from ..runs import Study, run as run_of
from . import style
from .draw import draw_pieces, section
from .pushed import derivatives
from .register import figure

DEGREES = 16, 30, 40  # polynomial degrees; each solution is the start of the solution of the next higher degree
ROUND = 1e-2  # an axisymmetric shape may have a relative difference of the extents along x1 and x2 up to this
COSINE, WEIGHT = legendre.leggauss(400)


@figure(2, 2, 7.2, 5.6)
def surfactant(runs, cut, along, deformation, extremes):
    """Drops with surfactant: last section, concentration along the axis x3, and D and extreme concentrations over time.

    D is the Taylor parameter. Concentrations are divided by the initial concentration. If one of the runs is a drop
    without surfactant, its section and D are drawn for comparison."""
    for run in runs:
        run.expect_one_particle()
    expect(any("surfactant_mass" in run.series for run in runs), f"{runs[0].directory} has no surfactant")
    for run, color in style.coloured(runs):
        last = run.snapshot_at(None)
        draw_pieces(cut, section(last, last.points[:, 1].mean()) / run.radius, color, 1.4)
        deformation.plot(run.time, run.series["taylor_inertia"], color=color, label=run.name)
        line = f"{run.name}: D = {run.series['taylor_inertia'][-1]:.6f}"
        if "surfactant_mass" in run.series:
            along.plot(last.points[:, 2] / run.radius, last.fields["concentration"], ".", color=color, markersize=2)
            smallest, largest, mass = (run.series[name] for name in ("smallest_concentration", "largest_concentration",
                                                                     "surfactant_mass"))
            extremes.plot(run.time, largest, color=color)
            extremes.plot(run.time, smallest, color=color, linestyle=style.DASHES)
            line += (f", concentration from {smallest[-1]:.5f} to {largest[-1]:.5f}, "
                     f"mass kept to {abs(mass / mass[0] - 1).max():.1e}")
        log.info(line)
    cut.autoscale()
    cut.set(aspect="equal", xlabel="$x_1$ / R$_C$", ylabel="$x_3$ / R$_C$")
    along.set(xlabel="$x_3$ / R$_C$", ylabel="concentration / initial value")
    style.finish(deformation, xlabel=time_label(runs), ylabel="D")
    extremes.set(xlabel=time_label(runs), ylabel="largest, smallest (dashed)")


@figure()
def vesicle(deck, axes=None, *, meshes: list[int] | None = None):
    """Vesicles at rest, compared with axisymmetric shapes of least energy from an independent computation.

    The panels show the section of the last snapshot, the difference of the energy from the reference over time and,
    with --meshes, the relative error of the energy against the number of control points. Without --meshes a directory
    of results may be given instead of a deck. The vesicle must be axisymmetric about x3.

    The reference shape is r(theta) = exp(s(theta)), where s is a sum of even Legendre polynomials of cos theta. It has
    the volume, bending modulus, spontaneous curvature, tension, global area dilatation and area-difference elasticity
    of the run. Newton's method finds a stationary point of its energy. The search starts from a spheroid.

    meshes: numbers of elements per side; the deck is run with each of them"""
    run = run_of(deck)
    outline, energy, error = least(run)
    log.info(f"{run.name}: energy {run.series['energy'][-1]:.9g}, relative error {error:.1e}")
    figure, axes = style.panels(axes, 1, 3 if meshes else 2, 10 if meshes else 7, 3.2)
    last = run.snapshot_at(None)
    centre = last.points.mean(0)
    draw_pieces(axes[0], section(last, centre[1]) - centre[[0, 2]], style.RUNS[0], ends="butt")
    axes[0].plot(numpy.outer(outline[0], [-1, 1]), outline[1], linewidth=1, **style.GUIDE)
    length = run.in_units("length")
    axes[0].set(aspect="equal", xlabel="$x_1$" + length, ylabel="$x_3$" + length)
    axes[1].semilogy(run.time, abs(run.series["energy"] - energy), color=style.RUNS[0])
    axes[1].set(xlabel=time_label([run]), ylabel="|energy − energy of the reference|" + run.in_units("force length"))
    if meshes:
        study = Study(directory="results/vesicles")
        outcomes = [study.run(deck, {"Surface/elements per side": n}) for n in meshes]
        for outcome in outcomes:
            expect(outcome.done, outcome.message)
        points, error, seconds = numpy.transpose([(one.series["n_control_points"][-1], least(one.run)[2],
                                                   one.processor_seconds) for one in outcomes])
        for row in zip(points, error, seconds):
            log.info("control points {:.0f}: relative error {:.2e}, {:.2g} processor seconds".format(*row))
        axes[2].loglog(points, abs(error), "o-", color=style.RUNS[0], label="fixed meshes")
        axes[2].loglog(points, abs(error[0]) * (points / points[0]) ** -2, label="fourth order", **style.GUIDE)
        style.finish(axes[2], xlabel="control points", ylabel="relative error of the energy")
    return figure


def least(run):
    """Returns the meridian and the energy of the axisymmetric equilibrium shape, and the relative error of the energy
    of the run."""
    outline, energy = at_rest(Energy(run), run.series["length_x3"][-1] / run.series["length_x1"][-1])
    return outline, energy, run.series["energy"][-1] / energy - 1


def polynomials(degree):
    """Returns the values, first and second derivatives, each (400, n), of the even Legendre polynomials P_2k at COSINE,
    the Gauss points in the cosine of the polar angle."""
    even = [legendre.Legendre.basis(l) for l in range(0, degree + 1, 2)]
    return [numpy.array([one.deriv(order)(COSINE) for one in even]).T for order in (0, 1, 2)]


def measures(bases, c):
    """Returns four integrals (4,) over the surface r = exp(sum c_k P_2k): area, volume, integral of twice the mean
    curvature, and half the integral of the square of twice the mean curvature. `c` may be complex."""
    exponent, first, second = (basis @ c for basis in bases)
    r, sine2 = numpy.exp(exponent), 1 - COSINE**2
    # (dr/dtheta)^2 and d2r/dtheta2, theta the polar angle
    slope2, bend = sine2 * (r * first) ** 2, sine2 * r * (second + first**2) - COSINE * r * first
    g = numpy.sqrt(r**2 + slope2)
    curvature = (r**2 + 2 * slope2 - r * bend) / g**3 + (1 + COSINE * first) / g
    ring = 2 * numpy.pi * WEIGHT * r * g
    return numpy.array([ring.sum(), 2 * numpy.pi / 3 * WEIGHT @ r**3, ring @ curvature, ring @ curvature**2 / 2])


class Energy:
    """Energy of a membrane with the parameters of a run, as a function of the four integrals of measures()."""

    def __init__(self, run):
        expect((run.value("Membrane/law"), run.value("Membrane/bending reference")) == ("surface tension", "flat"),
               f"{run.name}: a vesicle has the law `surface tension` and the bending reference `flat`")
        expect(run.summary, f"{run.name} has not come to its end")
        last = [run.series[f"length_x{k}"][-1] for k in (1, 2)]
        expect(abs(last[0] / last[1] - 1) < ROUND, f"{run.name}: its last shape is {last[0]:.4g} long along x1 and "
               f"{last[1]:.4g} along x2, not axisymmetric about x3")
        expect(run.value("Flow/type") == "quiescent", f"{run.name}: a vesicle at rest is in a `quiescent` fluid")
        numbers = run.summary["numbers"]
        self.area, self.volume = numbers["area"], numbers["volume"]  # of the resting shape, not of the initial shape
        names = ("surface tension", "bending modulus", "spontaneous curvature", "global area dilatation",
                 "area difference modulus", "area difference")
        self.tension, self.bending, self.curvature, dilatation, modulus, leaves = (
            float(run.value(f"Membrane/{name}", 0)) for name in names)
        self.of_area = dilatation * self.tension / self.area
        self.of_leaves = numpy.pi * modulus * self.bending / self.area
        self.leaves = leaves * 4 * numpy.sqrt(numpy.pi * self.area)
        expect(self.of_leaves == 0 or self.leaves > 0, f"{run.name}: give Membrane/area difference")

    def __call__(self, measures):
        area, _, leaves, bent = measures
        return (self.tension * area + self.of_area / 2 * (area - self.area) ** 2
                + self.of_leaves / 2 * (leaves - self.leaves) ** 2
                + self.bending * (bent - self.curvature * leaves + self.curvature**2 / 2 * area))


@numpy.errstate(all="ignore")  # trial shapes of the search may overflow
def at_rest(energy, aspect):
    """Computes the shape of least energy near the spheroid with the aspect ratio `aspect` (polar axis divided by
    equatorial diameter). Returns its meridian (2, 400), the distance from the axis and the height, and its energy."""
    first = polynomials(DEGREES[0])
    c = legendre.legfit(COSINE, -numpy.log(1 - COSINE**2 + (COSINE / aspect) ** 2) / 2, DEGREES[0])[::2]
    c[0] += numpy.log(energy.volume / measures(first, c)[1]) / 3

    def of_energy(c):
        return energy(measures(first, c))

    def excess(c):
        return measures(first, c)[1] / energy.volume - 1

    c = optimize.minimize(of_energy, c, jac=lambda c: derivatives(of_energy, c), method="SLSQP",
                          constraints={"type": "eq", "fun": excess, "jac": lambda c: derivatives(excess, c)},
                          options={"maxiter": 500, "ftol": 1e-12}).x
    slopes = energy.volume * derivatives(excess, c)
    pressure, values = derivatives(of_energy, c) @ slopes / (slopes @ slopes), []
    for degree in DEGREES[1:]:
        bases = polynomials(degree)

        def lagrangian(y):
            found = measures(bases, y[:-1])
            return energy(found) - y[-1] * (found[1] - energy.volume)

        start = numpy.append(numpy.pad(c, (0, degree // 2 + 1 - len(c))), pressure)
        solved = optimize.root(lambda y: derivatives(lagrangian, y), start, tol=1e-13)
        expect(abs(solved.fun).max() < 1e-8 * energy.bending,
               f"no axisymmetric shape at rest was found, {abs(solved.fun).max():.1e} is left")
        c, pressure = solved.x[:-1], solved.x[-1]
        values.append(energy(measures(bases, c)))
    log.info(f"axisymmetric: energy {values[-1]:.9g}, of degree {DEGREES[1]} {values[0] - values[-1]:+.1e}")
    return numpy.exp(bases[0] @ c) * [numpy.sqrt(1 - COSINE**2), COSINE], values[-1]
