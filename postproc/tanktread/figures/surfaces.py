"""Figures of surfaces and their sections, and the animation of a run."""

import numpy
from matplotlib.animation import FuncAnimation
from matplotlib.ticker import FuncFormatter, MaxNLocator

from ..mistakes import expect, log
from ..results import field_label
from . import style
from .draw import (direction, draw_sections, draw_surface, draw_triad, magnitude, middle, section_variation,
                   share_window, view_of)
from .register import figure
from .scene import flow_plane, surrounded
from .series import unbroken

ROUNDING = 1e-9  # a field is uniform if its range, divided by its largest absolute value, is smaller
TICKS = FuncFormatter(lambda value, _: f"{value:.10g}".replace("-", "−"))  # without a common offset or factor


def field_of(shots, field):
    """Returns the colour normalisation, the colour map and the label pattern for a field of several snapshots. If the
    field is uniform, the colour bar extends from 0.99 to 1.01 times its value. Raises Mistake if a snapshot does not
    contain the field."""
    for shot in shots:
        expect(field in shot.fields, f"{shot.path} holds no field {field}; there are: {', '.join(sorted(shot.fields))}")
    values = numpy.concatenate([magnitude(shot.fields[field]) for shot in shots])
    low, high, pattern = values.min(), values.max(), "|{}|" if numpy.ndim(shots[0].fields[field]) > 1 else "{}"
    bound = max(-low, high)
    if 0 <= low and high - low < ROUNDING * bound:
        low, high = 0.99 * low, 1.01 * high
    limits, colours = ((-bound, bound), style.SIGNED) if low < 0 else ((low, high), style.FIELD)
    return style.plt.Normalize(*limits), colours, pattern


def colour_bar(figure, norm, colours, **properties):
    """Draws a horizontal colour bar. The tick labels have no common offset or factor, because its text would overlap
    the label of the colour bar."""
    longest = max(len(TICKS(place)) for place in MaxNLocator(4).tick_values(norm.vmin, norm.vmax))
    figure.colorbar(style.plt.cm.ScalarMappable(norm, colours), orientation="horizontal", format=TICKS,
                    ticks=MaxNLocator(2) if longest > 4 else None, **properties)


@figure(lambda runs: (1, len(runs) + 1, 4.4 * len(runs) + 4.6, 4.4))
def shape(runs, *axes, time: float | None = None, field: str = "traction", view: tuple[float, float] | None = None):
    """Deformed surface, coloured by the magnitude of the traction, and its section in the plane of the flow.

    The plane of the section goes through the middle of the particles, or through as many of them as possible. It is
    x1 x3 unless the flow is `linear`. The dashed line in the section has the direction of the longest axis of the
    ellipsoid of inertia. Its angle is the inclination.

    time: simulated time of the snapshot (default: the last one)
    field: field of the snapshot that colours the surface
    view: azimuth and elevation of the observer, in degrees (default: above the plane of the flow, -85 18 for x1 x3)"""
    shots = [surrounded(run, run.snapshot_at(time)) for run in runs]
    norm, colours, pattern = field_of(shots, field)
    for axis, run, shot in zip(axes, runs, shots):
        draw_surface(axis, shot, field, norm, colours, view_of(runs, view))
        axis.set_title(f"{run.name}, {run.moment(shot.time)}")
    label = field_label(runs, field, pattern if pattern == "{}" else "magnitude of the {}")
    left, right, low, high = axes[0].axis()
    width = 0.5 * max(1, 0.5 * (high - low) / (right - left))  # width of the colour bar divided by width of the picture
    colour_bar(axes[0].figure, norm, colours, label=label,
               cax=axes[0].inset_axes([0.55 - width / 2, -0.08, width, 0.03]))
    draw_sections(axes[-1], runs, shots)


@figure()
def meshes(runs, axes=None, *, times: list[float] | None = None, field: str = "traction",
           view: tuple[float, float] | None = None):
    """Meshes at several times, and the variation of a field along the section in the plane of the flow (Figures 15 and
    16 of Maestre et al. 2017).

    The variation is the magnitude of the derivative of the field with respect to arc length. It is drawn in polar
    coordinates. Before the polar angle is computed, the section is scaled to equal length and height, because otherwise
    the tips of slender shapes would take up a small range of angles. If there are several particles, each has its own
    curve, of the section through its own middle.

    times: simulated times (default: the start, the middle and the end); if there are several runs, only the last one
    field: field whose variation is drawn
    view: azimuth and elevation of the observer, in degrees (default: above the plane of the flow, -85 18 for x1 x3)"""
    end = runs[0].series["time"][-1]
    moments = times or [0, end / 2, end]
    found = [(run, run.snapshot_at(moment)) for run in runs for moment in (moments if len(runs) == 1 else moments[-1:])]
    pairs = list({shot.path: (run, surrounded(run, shot)) for run, shot in found}.values())  # each snapshot once
    shots = [shot for _, shot in pairs]
    norm, colours, pattern = field_of(shots, field)
    seen = numpy.concatenate([(shot.frame - middle(shot.frame)) @ view_of(runs, view)[:2].T for shot in shots])
    tall = 1.15 * numpy.ptp(seen[:, 1]) / numpy.ptp(seen[:, 0])
    figure = style.canvas(axes, 4 * len(shots), 4 * tall + 5.2)
    grid = figure.add_gridspec(3, len(shots), height_ratios=[4 * tall + 0.4, 0.12, 3.9])
    surfaces, polars = zip(*[(figure.add_subplot(grid[0, k]), figure.add_subplot(grid[2, k], projection="polar"))
                             for k in range(len(shots))])
    reach = max(1e-12, 0.1 * (norm.vmax - norm.vmin))  # rounding errors of a uniform field stay invisible
    for (run, shot), surface, polar in zip(pairs, surfaces, polars):
        several, axes = len(run.particles) > 1, flow_plane(run)
        draw_surface(surface, shot, field, norm, colours, view_of(runs, view))
        row = numpy.searchsorted(run.series["time"], shot.time * (1 + 1e-12), side="right") - 1
        points = run.control_points()[row]
        surface.set_title(f"{run.name}\n{run.moment(shot.time, '.3g')}: {points:.0f} control points")
        curves = {particle: section_variation(shot, field, particle, axes) for particle in run.particles}
        largest, whose = max((variation.max(), particle) for particle, (_, variation) in curves.items())
        reach = max(reach, largest)
        log.info(f"{shot.path}: largest variation {largest:.3g}" + several * f", of {whose}")
        for (particle, (angle, variation)), color in style.coloured(curves.items()):
            polar.plot([*angle, angle[0] + 2 * numpy.pi], [*variation, variation[0]], color=color, linewidth=1,
                       label=particle)
        if several and len(curves) <= len(style.RUNS):
            polar.legend(loc="upper center", bbox_to_anchor=(0.5, -0.02), ncols=3)
        polar.set_xticks(numpy.radians([0, 90, 180, 270]), [*map(direction, axes[::2]), "", ""])
        polar.set_rlabel_position(55)
        polar.yaxis.set_major_formatter(TICKS)
        polar.tick_params(labelsize=7.5)
        polar.set_title(f"|d {field}/dl| on the section{'s' * several} normal to {direction(axes[1])}, l in R$_C$",
                        fontsize=8.5, loc="center")
    share_window(surfaces)
    style.plt.setp(polars, ylim=(0, 1.05 * reach))
    colour_bar(figure, norm, colours, cax=figure.add_subplot(grid[1, len(shots) // 2]),
               label=field_label(runs, field, pattern))
    return figure


@figure()
def animation(run, axes=None, *, field: str = "traction", view: tuple[float, float] | None = None, rate: float = 8,
              width: int = 720, frame: float | None = None):
    """The moving particle, as a GIF: its surface with the elements, coloured by a field, and two series over time.

    The series are D (the Taylor parameter) and the number of control points. For a rigid particle they are inclination
    (for a sphere velocity) and angular velocity. For several particles they are D of each deformable particle, or the
    angular velocities of rigid ones, and the smallest gap. Each snapshot is one frame: `Output/interval` sets the
    number of frames. In Python, the attribute `film` of the figure is the FuncAnimation of matplotlib.

    field: field that colours the surface
    view: azimuth and elevation of the observer, in degrees (default: above the plane of the flow, -85 18 for x1 x3)
    rate: frames per second
    width: width of the animation in pixels
    frame: time of one frame; only this frame is drawn, as a picture"""
    expect(width >= 100 and rate > 0,
           f"--width must be at least 100 and --rate positive, but they are {width} and {rate:g}")
    run.expect_particles()
    shots = [surrounded(run, shot) for shot in run.snapshots()]
    expect(shots, f"{run.directory} holds no snapshots")
    # all frames have the same scale, window and colours
    directions, colouring = view_of([run], view), field_of(shots, field)
    places = numpy.concatenate([shot.frame - middle(shot.frame) for shot in shots]) @ directions[:2].T
    window = numpy.array([places.min(0), places.max(0)])
    figure, surface, panels = arranged(axes, run, window[1] - window[0], field, *colouring)
    marks = draw_series(panels, run)

    def show(shot):
        surface.clear()
        draw_surface(surface, shot, field, *colouring[:2], directions, pixels=width * 2 // 3, triad=False)
        low, high = window + directions[:2] @ middle(shot.frame)
        draw_triad(surface, directions, low, high)
        xlim, ylim = numpy.transpose([low, high]) + 0.11 * (high[0] - low[0]) * numpy.array([-1, 1])
        # row of the series at the time of the snapshot, or the last row if the series end earlier
        row = min(numpy.searchsorted(run.series["time"], shot.time * (1 - 1e-12)), len(run.time) - 1)
        points = run.control_points()[row]
        title = f"{run.name}, {run.moment(shot.time, '.4g')}: {points:.0f} control points"
        surface.set(xlim=xlim, ylim=ylim, title=title)
        for name, mark in marks.items():
            mark.set_data([run.time[row]], [run.series[name][row]])

    if frame is not None:
        show(surrounded(run, run.snapshot_at(frame)))
    else:
        figure.set_dpi(width / figure.get_figwidth())
        figure.film = FuncAnimation(figure, show, frames=shots, interval=1000 / rate)
    return figure


def arranged(axes, run, extent, field, norm, colours, pattern):
    """Returns the figure (with a colour bar), the axes for the surface, and the two axes for the series."""
    with style.plt.rc_context({"figure.constrained_layout.use": False}):  # it would move the axes from frame to frame
        figure = style.canvas(axes, 7.2, 7.2 * 0.80 * extent[1] / extent[0] + 3.1)
    height = figure.get_figheight()
    surface = figure.add_axes([0.02, 2.75 / height, 0.84, 1 - 3.1 / height])
    bar = figure.add_axes([0.88, 2.9 / height, 0.018, max(0.15, 1 - 3.9 / height)])
    figure.colorbar(style.plt.cm.ScalarMappable(norm, colours), cax=bar, label=run.label(field, pattern))
    upper = figure.add_axes([0.11, 1.55 / height, 0.75, 0.95 / height])
    return figure, surface, (upper, figure.add_axes([0.11, 0.5 / height, 0.75, 0.75 / height], sharex=upper))


def draw_series(panels, run):
    """Draws the series below the surface. Returns {name: marker of the value at the time of the frame}."""
    deforming = [f"{name}/taylor_inertia" for name in run.particles if f"{name}/taylor_inertia" in run.series]
    if run.several:
        last = {"smallest gap" + run.in_units("length"): ["smallest_gap"]} if "smallest_gap" in run.series else {
            "control points": [f"{name}/n_control_points" for name in run.particles]}
        turning = {"ω₂" + run.in_units("1/time"): [f"{name}/angular_velocity_x2" for name in run.particles]}
        shown = ({"D": deforming} if deforming else turning) | last
    elif "taylor_inertia" in run.series:
        shown = {"D": ["taylor_inertia"], "control points": ["n_control_points"]}
    else:
        # the inclination of a sphere is undefined
        turned = len(run.defined("inclination")[1]) > 0
        first = ("incl., °", "inclination") if turned else ("v₁" + run.in_units("length/time"), "velocity_x1")
        shown = {first[0]: [first[1]], "ω₂" + run.in_units("1/time"): ["angular_velocity_x2"]}
    marks = {}
    for axis, (label, names), color in zip(panels, shown.items(), style.RUNS):
        width, size = (1.8, 4.5) if len(names) < 9 else (0.6, 1.5)
        each = 1 < len(names) <= len(style.RUNS)  # of a few particles, each has its colour
        for name, own in zip(names, style.RUNS if each else [color] * len(names)):
            drawn = run.time, run.series[name]
            axis.plot(*unbroken(*drawn) if name == "inclination" else drawn, color=own, linewidth=width,
                      drawstyle="steps-post" if name.endswith("n_control_points") else "default",
                      label=name.split("/")[0])
            marks[name], = axis.plot([], [], "o", color=style.INK, markersize=size, clip_on=False)
        axis.set_ylabel(label)
        if each:
            axis.legend(loc="center left", bbox_to_anchor=(1, 0.5), fontsize=7)
        values = numpy.concatenate([run.defined(name)[1] for name in names])
        if len(values) and values.min() >= 0:
            axis.set_ylim(0, 1.1 * max(values.max(), 1e-6))
    panels[0].tick_params(labelbottom=False)
    panels[1].set(xlabel=run.time_label, xlim=(run.time[0], run.time[-1]) if len(run.time) > 1 else None)
    return marks
