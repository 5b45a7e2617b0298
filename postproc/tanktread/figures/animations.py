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
DEFORMABLE = {"D": ["taylor_inertia"], "control points": ["n_control_points"]}  # label of an axis, and its series
RIGID = {"incl., °": ["inclination"]}


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
    every = [shot.scaled(run) for shot in run.snapshots()]
    expect(every, f"{run.directory} holds no snapshots")
    film = Film(axes, run, every, field, view, width * 2 // 3)
    if frame is not None:
        film.show(run.snapshot_at(frame).scaled(run))
    else:
        film.figure.set_dpi(width / film.figure.get_figwidth())
        film.figure.film = FuncAnimation(film.figure, film.show, frames=every)
        film.figure.film.rate = rate
    return film.figure


animation.output = "animation.gif"


class Film:
    """One figure in which frame after frame is drawn: the same scale, the same window, the same colours in all of
    them."""

    def __init__(self, axes, run, shots, field, view, pixels):
        self.run, self.field, self.view, self.pixels = run, field, view, pixels
        places = numpy.concatenate([shot.frame - middle(shot.frame) for shot in shots]) @ view_axes(*view)[:2].T
        self.window = numpy.array([places.min(0), places.max(0)])
        self.norm, self.colours, pattern = field_of(shots, field)
        extent = self.window[1] - self.window[0]
        # constrained layout would move the axes from frame to frame
        with style.plt.rc_context({"figure.constrained_layout.use": False}):
            self.figure = style.canvas(axes, 7.2, 7.2 * 0.80 * extent[1] / extent[0] + 3.1)
        height = self.figure.get_figheight()
        self.surface = self.figure.add_axes([0.02, 2.75 / height, 0.84, 1 - 3.1 / height])
        bar = self.figure.add_axes([0.88, 2.9 / height, 0.018, max(0.15, 1 - 3.9 / height)])
        self.figure.colorbar(ScalarMappable(self.norm, self.colours), cax=bar, label=run.label(field, pattern))
        upper = self.figure.add_axes([0.11, 1.55 / height, 0.75, 0.95 / height])
        self.panels = [upper, self.figure.add_axes([0.11, 0.5 / height, 0.75, 0.75 / height], sharex=upper)]
        self.marks = self.draw_series()

    def draw_series(self):
        """Draws the series, and returns {name: mark of the present value}."""
        marks = {}
        for axis, (label, names), color in zip(self.panels, shown(self.run).items(), style.RUNS):
            width, size = (1.8, 4.5) if len(names) < 9 else (0.6, 1.5)
            for name in names:
                drawn = self.run.time, self.run.series[name]
                axis.plot(*unbroken(*drawn) if name == "inclination" else drawn, color=color, linewidth=width,
                          drawstyle="steps-post" if name == "n_control_points" else "default")
                marks[name], = axis.plot([], [], "o", color=style.INK, markersize=size, clip_on=False)
            axis.set_ylabel(label)
            values = numpy.concatenate([self.run.defined(name)[1] for name in names])
            if len(values) and values.min() >= 0:
                axis.set_ylim(0, 1.1 * max(values.max(), 1e-6))
        self.panels[0].tick_params(labelbottom=False)
        self.panels[1].set(xlabel=self.run.time_label, xlim=(self.run.time[0], self.run.time[-1]))
        return marks

    def show(self, shot):
        view, series = view_axes(*self.view), self.run.series
        self.surface.clear()
        draw_surface(self.surface, shot, self.field, self.norm, self.colours, *self.view, self.pixels, triad=False)
        (left, low), (right, high) = self.window + view[:2] @ middle(shot.frame)
        room = 0.11 * numpy.ptp(self.window[:, 0])
        draw_triad(self.surface, view, numpy.array([left, right, low, high]))
        # of this saved step, the last one if none came after
        row = min(numpy.searchsorted(series["time"], shot.time * (1 - 1e-12)), len(series["time"]) - 1)
        title = f"{self.run.name}, t = {shot.time:.4g}: {series['n_control_points'][row]:.0f} control points"
        self.surface.set(xlim=(left - room, right + room), ylim=(low - room, high + room), title=title)
        for name, mark in self.marks.items():
            mark.set_data([self.run.time[row]], [series[name][row]])
        return list(self.marks.values())


def shown(run):
    """Returns {axis label: [series]} of the two panels below the surface."""
    if not run.several:
        rate = "ω₂" + run.in_units("1/time")
        return DEFORMABLE if "taylor_inertia" in run.series else RIGID | {rate: ["angular_velocity_x2"]}
    deforming = [f"{name}/taylor_inertia" for name in run.particles if f"{name}/taylor_inertia" in run.series]
    return ({"D": deforming} if deforming else {}) | {"smallest gap" + run.in_units("length"): ["smallest_gap"]}
