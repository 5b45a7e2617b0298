"""Figures of particles beside each other and beside a wall."""

import pathlib

import numpy

from ..files import table
from ..mistakes import expect, log
from ..results import time_label
from ..snapshots import evenly
from . import style
from .draw import draw_pieces, section
from .register import figure


@figure(3, 1, 6.4, 8, sharex=True)
def encounter(runs, path, gap, deformation, *, pair: tuple[str, str] | None = None, curve: pathlib.Path | None = None):
    """Two particles that meet: the path of one past the other, the smallest gap, and how they deform.

    Drawn against dx; dx, dz are x1 and x3 of the first centroid less those of the second one, over R_C.

    pair: names of the two particles (default: the first two)
    curve: a path of the literature, a CSV file with columns dx, dz over R_C"""
    for run, color in style.coloured(runs):
        names = pair or run.particles[:2]
        expect(len(names) == 2, f"{run.directory}: an encounter is of two particles, and this run has one")
        dx, dz = (numpy.subtract(*[run.of(name, f"centroid_x{k}") for name in names]) / run.radius for k in (1, 3))
        path.plot(dx, dz, color=color, label=run.name)
        smallest = run.series["smallest_gap"] / run.radius
        gap.plot(dx, smallest, color=color)
        for name, line in zip(names, ("-", style.DASHES)):
            if f"{name}/taylor_inertia" in run.series:  # it is not rigid
                label = name if run is runs[0] else None
                deformation.plot(dx, run.of(name, "taylor_inertia"), color=color, linestyle=line, label=label)
        least = numpy.argmin(smallest)
        log.info(f"{run.name}: smallest gap {smallest[least]:.5f} R_C at dx = {dx[least]:.3f}, "
                 f"largest dz {dz.max():.5f}")
    if curve:
        path.plot(*table(curve).T[:2], style.MARKS[0], color=style.FAINT, markersize=3.5, label="literature")
    style.finish(path, ylabel="dz / R$_C$")
    gap.set(ylabel="smallest gap / R$_C$", ylim=(0, None))
    deformation.set(xlabel="dx / R$_C$", ylabel="D")
    if deformation.lines:
        deformation.legend()


@figure()
def plane_wall(runs, axes=None, *, times: int = 5, curve: pathlib.Path | None = None):
    """Particles beside a plane wall: sections at several times, the gap, and the centroid's velocity along and away.

    times: number of times that are drawn
    curve: a gap over time to draw beside the first one, a CSV file in the units of the figure"""
    figure = style.canvas(axes, 7.2, 2.6 * len(runs) + 2.8)
    grid = figure.add_gridspec(len(runs) + 1, 2, height_ratios=[1] * len(runs) + [1.1])
    gap, speed = (figure.add_subplot(grid[-1, k]) for k in (0, 1))
    for k, (run, color) in enumerate(style.coloured(runs)):
        film = run.series["gap"] / run.radius
        sections(figure.add_subplot(grid[k, :]), run, times)
        gap.plot(run.time, film, color=color, label=run.name)
        velocity = numpy.array([run.series[f"velocity_x{i}"] for i in (1, 2, 3)]) / run.scale("velocity")[0]
        away, along = (direction @ velocity for direction in wall(run)[1:])
        speed.plot(run.time, away, color=color, label=None if k else "away")
        speed.plot(run.time, along, color=color, linestyle=style.DASHES, label=None if k else "along")
        log.info(f"{run.name}: gap from {film[0]:.6g} to {film[-1]:.6g} R_C; "
                 f"velocity away from the wall {away[-1]:.5g}, along it {along[-1]:.5g}")
    if curve:
        gap.plot(*table(curve).T[:2], style.MARKS[0], color=style.INK, markersize=3, label="exact")
    speed.axhline(0, color=style.FAINT, linewidth=0.8)
    style.finish(gap, yscale="log", xlabel=time_label(runs), ylabel="gap / R$_C$")
    style.finish(speed, xlabel=time_label(runs), ylabel=runs[0].label("velocity", "centroid's {}"))
    return figure


def wall(run):
    """Returns a point of the wall, its unit normal, and the direction along it: x1, or x3 if the normal is x1; (3,)."""
    expect(run.value("Wall/normal"), f"{run.directory}: its deck has no plane Wall")
    point, normal = (numpy.array(run.value(f"Wall/{key}"), float) for key in ("point", "normal"))
    normal /= numpy.linalg.norm(normal)
    along = numpy.eye(3)[2 if abs(normal[0]) > 0.9 else 0]
    along -= along @ normal * normal
    return point, normal, along / numpy.linalg.norm(along)


def sections(axis, run, moments):
    """Draws sections of the snapshots through their middle, in the plane of the normal and along the wall."""
    point, normal, along = wall(run)
    across = numpy.argmin(abs(normal) + abs(along))
    point, along, normal = numpy.delete([point, along, normal], across, axis=1)  # in the plane of the sections
    for shot, colour in style.shaded(evenly(run.snapshots(), moments), 0.15, 0.95):
        pieces = section(shot, shot.points[:, across].mean(), across) - point
        draw_pieces(axis, pieces @ numpy.transpose([along, normal]) / run.radius, colour, ends="butt")
        axis.plot([], [], color=colour, label=f"{shot.time * run.rate[0]:.3g}")
    axis.axhspan(-0.15, 0, color=style.FAINT, alpha=0.5, linewidth=0)
    axis.autoscale_view()
    axis.set(ylim=(-0.15, None), aspect="equal", title=f"{run.name}: section across the wall at several times",
             xlabel="along the wall / R$_C$", ylabel="above it / R$_C$")
    axis.legend(ncols=2, fontsize=7, loc="center left", bbox_to_anchor=(1, 0.5))
