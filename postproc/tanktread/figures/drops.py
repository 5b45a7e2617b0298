"""Figures of drops with surfactant, and of vesicles at rest."""

import numpy

from ..mistakes import expect, log
from ..results import time_label
from ..runs import Study
from ..runs import run as run_of
from . import style
from .draw import draw_pieces, section
from .register import figure
from .vesicles import Energy, at_rest


@figure
def surfactant(runs, axes=None):
    """Drops with surfactant: last section, concentration along the axis x3, and over time D and its extremes.

    A clean drop among the runs is drawn for comparison."""
    figure, (cut, along, deformation, extremes) = style.panels(axes, 2, 2, 7.2, 5.6)
    for run, color in style.coloured(runs):
        last = run.snapshot_at(None)
        draw_pieces(cut, section(last, last.points[:, 1].mean()) / run.radius, color, 1.4)
        deformation.plot(run.time, run.series["taylor_inertia"], color=color, label=run.name)
        line = f"{run.name}: D = {run.series['taylor_inertia'][-1]:.6f}"
        if "surfactant_mass" in run.series:
            order = numpy.argsort(last.points[:, 2])
            along.plot(last.points[order, 2] / run.radius, last.fields["concentration"][order], ".", color=color,
                       markersize=2)
            smallest, largest, mass = (run.series[name] for name in ("smallest_concentration", "largest_concentration",
                                                                     "surfactant_mass"))
            extremes.plot(run.time, largest, color=color)
            extremes.plot(run.time, smallest, color=color, linestyle=style.DASHES)
            line += (f", concentration from {smallest[-1]:.5f} to {largest[-1]:.5f}, "
                     f"mass kept to {abs(mass / mass[0] - 1).max():.1e}")
        log.info(line)
    cut.autoscale()
    cut.set(aspect="equal", xlabel="$x_1$ / R$_C$", ylabel="$x_3$ / R$_C$")
    along.set(xlabel="$x_3$ / R$_C$", ylabel="concentration / initial one")
    style.finish(deformation, xlabel=time_label(runs), ylabel="D")
    extremes.set(xlabel=time_label(runs), ylabel="largest, smallest concentration")
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
    outline, energy, error = least(run)
    log.info(f"{run.name}: energy {run.series['energy'][-1]:.9g}, relative error {error:.1e}")
    figure, axes = style.panels(axes, 1, 3 if meshes else 2, 10 if meshes else 7, 3.2)
    last = run.snapshot_at(None)
    centre = last.points.mean(0)
    draw_pieces(axes[0], section(last, centre[1]) - centre[[0, 2]], style.RUNS[0], ends="butt")
    for side in (-1, 1):
        axes[0].plot(side * outline[0], outline[1], linewidth=1, **style.GUIDE)
    length = run.in_units("length")
    axes[0].set(aspect="equal", xlabel="$x_1$" + length, ylabel="$x_3$" + length)
    axes[1].semilogy(run.time, abs(run.series["energy"] - energy), color=style.RUNS[0])
    axes[1].set(xlabel=time_label([run]), ylabel="|energy - axisymmetric shape's|" + run.in_units("force length"))
    if meshes:
        points, error, seconds = numpy.array(list(errors(deck, meshes, "results/vesicles"))).T
        for row in zip(points, error, seconds):
            log.info("control points {:.0f}: relative error {:.2e}, {:.2g} processor seconds".format(*row))
        axes[2].loglog(points, abs(error), "o-", color=style.RUNS[0], label="fixed meshes")
        axes[2].loglog(points, abs(error[0]) * (points / points[0]) ** -2, label="fourth order", **style.GUIDE)
        style.finish(axes[2], xlabel="control points", ylabel="relative error of the energy")
    return figure


def least(run):
    """Returns the section and the energy of the axisymmetric shape at rest, and the relative error of the run's
    energy."""
    outline, energy = at_rest(Energy(run), run.series["length_x3"][-1] / run.series["length_x1"][-1])
    return outline, energy, run.series["energy"][-1] / energy - 1


def errors(path, meshes, output):
    """Yields control points, relative error of the energy at rest and processor seconds of the deck on each mesh."""
    runs = Study(directory=output)
    for n in meshes:
        outcome = runs.run(path, {"Surface/elements per side": n})
        expect(outcome.done, outcome.message)
        yield outcome.series["n_control_points"][-1], least(outcome.run)[2], outcome.processor_seconds
