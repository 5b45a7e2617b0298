"""Figures of surfaces and their sections."""

import numpy
from matplotlib.cm import ScalarMappable

from ..mistakes import expect, log
from ..results import field_label
from . import style
from .draw import VIEW, draw_sections, draw_surface, magnitude, middle, scale, section_variation, share_window, view_axes
from .register import figure


def field_of(shots, field):
    """Raises Mistake unless the snapshots hold a field. Returns the colour scale of all of them and its label
    pattern."""
    for shot in shots:
        expect(field in shot.fields, f"{shot.path} holds no field {field}; there are: {', '.join(sorted(shot.fields))}")
    norm, colours = scale([magnitude(shot.fields[field]) for shot in shots])
    return norm, colours, "|{}|" if numpy.ndim(shots[0].fields[field]) > 1 else "{}"


@figure
def shape(runs, axes=None, *, time: float | None = None, field: str = "traction", view: tuple[float, float] = VIEW):
    """The deformed surface coloured by its traction, and its section in the x1 x3 plane with the axis of inertia.

    time: simulated time of the snapshot (default: the last one)
    field: field of the snapshot that colours the surface
    view: azimuth and elevation of the eye, in degrees"""
    shots = [run.snapshot_at(time).scaled(run) for run in runs]
    norm, colours, pattern = field_of(shots, field)
    figure, axes = style.panels(axes, 1, len(runs) + 1, 4.4 * len(runs) + 4.6, 4.4)
    for axis, run, shot in zip(axes, runs, shots):
        draw_surface(axis, shot, field, norm, colours, *view)
        axis.set_title(f"{run.name}, t = {shot.time:g}")
    label = field_label(runs, field, pattern if pattern == "{}" else "magnitude of the {}")
    figure.colorbar(ScalarMappable(norm, colours), cax=axes[0].inset_axes([0.3, -0.08, 0.5, 0.03]),
                    orientation="horizontal", label=label)
    draw_sections(axes[-1], runs, shots)
    return figure


@figure
def meshes(runs, axes=None, *, times: list[float] | None = None, field: str = "traction",
           view: tuple[float, float] = VIEW):
    """Meshes at some times, and below each the variation of a field along the section x2 = 0 (the paper's Figures 15,
    16).

    The polar angle is that of the ellipse as long and as high as the section, which shows the tips of slender shapes.

    times: simulated times (default: the start, the middle and the end); of several runs the last of them is drawn
    field: field whose variation is drawn
    view: azimuth and elevation of the eye, in degrees"""
    end = runs[0].series["time"][-1]
    if len(runs) > 1:
        pairs = [(run, times[-1] if times else end) for run in runs]
    else:
        pairs = [(runs[0], moment) for moment in times or [0, end / 2, end]]
    shots = [run.snapshot_at(moment).scaled(run) for run, moment in pairs]
    norm, colours, pattern = field_of(shots, field)
    seen = numpy.concatenate([(shot.points - middle(shot.points)) @ view_axes(*view)[:2].T for shot in shots])
    tall = 1.15 * numpy.ptp(seen[:, 1]) / numpy.ptp(seen[:, 0])
    figure = style.canvas(axes, 4 * len(shots), 4 * tall + 5.2)
    grid = figure.add_gridspec(3, len(shots), height_ratios=[4 * tall + 0.4, 0.12, 3.9])
    surfaces, polars = zip(*[(figure.add_subplot(grid[0, k]), figure.add_subplot(grid[2, k], projection="polar"))
                             for k in range(len(shots))])
    for (run, _), shot, surface in zip(pairs, shots, surfaces):
        draw_surface(surface, shot, field, norm, colours, *view)
        row = numpy.searchsorted(run.series["time"], shot.time * (1 + 1e-12), side="right") - 1
        points = run.series["n_control_points"][row]
        surface.set_title(f"{run.name}\nt = {shot.time:.3g}: {points:.0f} control points")
    share_window(surfaces)
    reach = max([draw_variation(polar, shot, field) for polar, shot in zip(polars, shots)])
    for polar in polars:
        polar.set_ylim(0, 1.05 * reach)
    figure.colorbar(ScalarMappable(norm, colours), cax=figure.add_subplot(grid[1, len(shots) // 2]),
                    orientation="horizontal", label=field_label(runs, field, pattern))
    return figure


def draw_variation(axis, shot, field):
    """Draws the variation of a field along the section, and returns the largest."""
    angle, variation = section_variation(shot, field)
    axis.plot(numpy.append(angle, angle[0] + 2 * numpy.pi), numpy.append(variation, variation[0]),
              color=style.RUNS[0], linewidth=1)
    axis.set_xticks(numpy.radians([0, 90, 180, 270]), ["x₁", "x₃", "", ""])
    axis.set_rlabel_position(55)
    axis.tick_params(labelsize=7.5)
    axis.set_title(f"|d {field}/dl| on the section x₂ = 0, l in R$_C$", fontsize=8.5, loc="center")
    log.info(f"{shot.path}: largest variation {variation.max():.3g}")
    return max(variation.max(), 1e-12)
