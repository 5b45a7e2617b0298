"""Figures of drops with surfactant, and of vesicles at rest."""

import numpy
from matplotlib.collections import LineCollection

from ..mistakes import expect, log
from ..results import time_label
from ..runs import Study
from ..runs import run as run_of
from . import style
from .draw import section
from .register import figure
from .vesicles import Energy, at_rest


@figure
def surfactant(runs, axes=None):
    """Drops with surfactant: last section, concentration along the axis x3, and over time D and its extremes.

    A clean drop among the runs is drawn for comparison."""
    figure, (cut, along, deformation, extremes) = style.panels(axes, 2, 2, 7.2, 5.6)
    for run, color in zip(runs, style.RUNS * len(runs)):
        last = run.snapshot_at(None)
        pieces = section(last, last.points[:, 1].mean()) / run.radius
        cut.add_collection(LineCollection(pieces, colors=color, linewidths=1.4, capstyle="round"))
        deformation.plot(run.time, run.series["taylor_inertia"], color=color, label=run.name)
        line = f"{run.name}: D = {run.series['taylor_inertia'][-1]:.6f}"
        if "surfactant_mass" in run.series:
            order = numpy.argsort(last.points[:, 2])
            along.plot(last.points[order, 2] / run.radius, last.fields["concentration"][order], ".", color=color,
                       markersize=2)
            smallest, largest = (run.series[f"{name}_concentration"] for name in ("smallest", "largest"))
            extremes.plot(run.time, largest, color=color)
            extremes.plot(run.time, smallest, color=color, linestyle=(0, (4, 2)))
            mass = run.series["surfactant_mass"]
            line += (f", concentration from {smallest[-1]:.5f} to {largest[-1]:.5f}, "
                     f"mass kept to {abs(mass / mass[0] - 1).max():.1e}")
        log.info(line)
    cut.autoscale()
    cut.set(aspect="equal", xlabel="$x_1$ / R$_C$", ylabel="$x_3$ / R$_C$")
    along.set(xlabel="$x_3$ / R$_C$", ylabel="concentration / initial one")
    deformation.set_ylabel("D")
    deformation.legend()
    extremes.set_ylabel("largest, smallest concentration")
    for axis in deformation, extremes:
        axis.set_xlabel(time_label(runs))
    return figure


@figure
def vesicle(deck, axes=None, *, meshes: list[int] | None = None):
    """Vesicles at rest beside axisymmetric shapes of least energy that are found without tanktread.

    The section of the last snapshot, the energy over time, and with --meshes its error against the mesh. The deck, or
    the directory of its run if there are no --meshes, is axisymmetric about x3. The shapes are r(theta) = exp(a sum of
    even Legendre polynomials of cos theta), with the run's volume, bending modulus, spontaneous curvature, tension,
    global area dilatation and area-difference elasticity: a stationary point by Newton's method from a spheroid.

    meshes: elements per side of further runs"""
    run = run_of(deck)
    series = run.series
    outline, energy = at_rest(Energy(run), series["length_x3"][-1] / series["length_x1"][-1])
    log.info(f"{run.name}: energy {series['energy'][-1]:.9g}, relative error {series['energy'][-1] / energy - 1:.1e}")
    figure, axes = style.panels(axes, 1, 3 if meshes else 2, 10 if meshes else 7, 3.2)
    last = run.snapshot_at(None)
    middle = last.points.mean(0)
    axes[0].add_collection(LineCollection(section(last, middle[1]) - middle[[0, 2]], colors=style.RUNS[0],
                                          linewidths=1.6))
    for side in (-1, 1):
        axes[0].plot(side * outline[0], outline[1], color=style.FAINT, linestyle=(0, (4, 3)), linewidth=1)
    length = run.in_units("length")
    axes[0].set(aspect="equal", xlabel="$x_1$" + length, ylabel="$x_3$" + length)
    axes[1].semilogy(run.time, abs(series["energy"] - energy), color=style.RUNS[0])
    axes[1].set(xlabel=time_label([run]), ylabel="|energy - axisymmetric shape's|" + run.in_units("force length"))
    if meshes:
        points, error, seconds = numpy.array(list(errors(deck, meshes, "results/vesicles"))).T
        for row in zip(points, error, seconds):
            log.info("control points {:.0f}: relative error {:.2e}, {:.2g} processor seconds".format(*row))
        axes[2].loglog(points, abs(error), "o-", color=style.RUNS[0], label="fixed meshes")
        axes[2].loglog(points, abs(error[0]) * (points / points[0]) ** -2, color=style.FAINT, linestyle=(0, (4, 3)),
                       label="fourth order")
        axes[2].set(xlabel="control points", ylabel="relative error of the energy")
        axes[2].legend()
    return figure


def errors(path, meshes, output):
    """Yields control points, relative error of the energy at rest and processor seconds of the deck on each mesh."""
    runs = Study(directory=output)
    for n in meshes:
        outcome = runs.run(path, {"Surface/elements per side": n})
        expect(outcome.done, outcome.message)
        run, series = outcome.run, outcome.series
        energy = at_rest(Energy(run), series["length_x3"][-1] / series["length_x1"][-1])[1]
        yield series["n_control_points"][-1], series["energy"][-1] / energy - 1, outcome.processor_seconds
