"""The animation of a run."""

import numpy
from matplotlib.animation import FuncAnimation
from matplotlib.cm import ScalarMappable

from ..mistakes import expect
from . import style
from .draw import VIEW, draw_surface, draw_triad, middle, view_axes
from .register import figure
from .series import unbroken
from .surfaces import field_of

LEAST_WIDTH = 100  # pixels


@figure
def animation(run, axes=None, *, field: str = "traction", view: tuple[float, float] = VIEW, rate: float = 8,
              width: int = 720, frame: float | None = None):
    """The particle in motion, as a GIF: its surface with the elements and a field, and series over time below.

    D and the number of control points; of a rigid particle inclination and angular velocity; of several particles D of
    each that deforms and the smallest gap. A frame is a saved step: `Output/interval` sets their number. The figure has
    the FuncAnimation as `film`.

    field: field that colours the surface
    view: azimuth and elevation of the eye, in degrees
    rate: frames per second
    width: of the animation, in pixels
    frame: draw one picture of this time instead"""
    expect(width >= LEAST_WIDTH and rate > 0,
           f"--width must be at least {LEAST_WIDTH} and --rate positive, but they are {width} and {rate:g}")
    shots = [shot.scaled(run) for shot in run.snapshots()]
    expect(shots, f"{run.directory} holds no snapshots")
    # one scale, one window and the same colours in all frames
    directions, colouring = view_axes(*view), field_of(shots, field)
    places = numpy.concatenate([shot.frame - middle(shot.frame) for shot in shots]) @ directions[:2].T
    window = numpy.array([places.min(0), places.max(0)])
    figure, surface, panels = arranged(axes, run, window[1] - window[0], field, *colouring)
    marks = draw_series(panels, run)

    def show(shot):
        surface.clear()
        draw_surface(surface, shot, field, *colouring[:2], *view, pixels=width * 2 // 3, triad=False)
        (left, low), (right, high) = window + directions[:2] @ middle(shot.frame)
        room = 0.11 * (right - left)
        draw_triad(surface, directions, numpy.array([left, right, low, high]))
        # of this saved step, the last one if none came after
        row = min(numpy.searchsorted(run.series["time"], shot.time * (1 - 1e-12)), len(run.time) - 1)
        title = f"{run.name}, t = {shot.time:.4g}: {run.series['n_control_points'][row]:.0f} control points"
        surface.set(xlim=(left - room, right + room), ylim=(low - room, high + room), title=title)
        for name, mark in marks.items():
            mark.set_data([run.time[row]], [run.series[name][row]])
        return list(marks.values())

    if frame is not None:
        show(run.snapshot_at(frame).scaled(run))
    else:
        figure.set_dpi(width / figure.get_figwidth())
        figure.film = FuncAnimation(figure, show, frames=shots)
        figure.film.rate = rate
    return figure


animation.output = "animation.gif"


def arranged(axes, run, extent, field, norm, colours, pattern):
    """Returns the figure with its colour bar, the axes of the surface, and those of the two series."""
    with style.plt.rc_context({"figure.constrained_layout.use": False}):  # it would move the axes from frame to frame
        figure = style.canvas(axes, 7.2, 7.2 * 0.80 * extent[1] / extent[0] + 3.1)
    height = figure.get_figheight()
    surface = figure.add_axes([0.02, 2.75 / height, 0.84, 1 - 3.1 / height])
    bar = figure.add_axes([0.88, 2.9 / height, 0.018, max(0.15, 1 - 3.9 / height)])
    figure.colorbar(ScalarMappable(norm, colours), cax=bar, label=run.label(field, pattern))
    upper = figure.add_axes([0.11, 1.55 / height, 0.75, 0.95 / height])
    return figure, surface, (upper, figure.add_axes([0.11, 0.5 / height, 0.75, 0.75 / height], sharex=upper))


def draw_series(panels, run):
    """Draws the series below the surface, and returns {name: mark of the present value}."""
    deforming = [f"{name}/taylor_inertia" for name in run.particles if f"{name}/taylor_inertia" in run.series]
    if run.several:
        shown = ({"D": deforming} if deforming else {}) | {"smallest gap" + run.in_units("length"): ["smallest_gap"]}
    elif "taylor_inertia" in run.series:
        shown = {"D": ["taylor_inertia"], "control points": ["n_control_points"]}
    else:
        shown = {"incl., °": ["inclination"], "ω₂" + run.in_units("1/time"): ["angular_velocity_x2"]}
    marks = {}
    for axis, (label, names), color in zip(panels, shown.items(), style.RUNS):
        width, size = (1.8, 4.5) if len(names) < 9 else (0.6, 1.5)
        for name in names:
            drawn = run.time, run.series[name]
            axis.plot(*unbroken(*drawn) if name == "inclination" else drawn, color=color, linewidth=width,
                      drawstyle="steps-post" if name == "n_control_points" else "default")
            marks[name], = axis.plot([], [], "o", color=style.INK, markersize=size, clip_on=False)
        axis.set_ylabel(label)
        values = numpy.concatenate([run.defined(name)[1] for name in names])
        if len(values) and values.min() >= 0:
            axis.set_ylim(0, 1.1 * max(values.max(), 1e-6))
    panels[0].tick_params(labelbottom=False)
    panels[1].set(xlabel=run.time_label, xlim=(run.time[0], run.time[-1]))
    return marks
