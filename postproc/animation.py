#!/usr/bin/python3
"""The particle in motion, as a GIF: its surface with the elements and a field, and below it over time D and the number of control points,
or of a rigid particle its inclination and angular velocity; of several D of each that deforms and the smallest gap.

A frame is a saved step: `Output/interval` says how many there are. Between two of them nothing is made up.
"""

import argparse
import sys

import needs  # before what it looks for
import numpy
from matplotlib.animation import FuncAnimation, PillowWriter
from matplotlib.cm import ScalarMappable

import shape
import style
import tanktread
from deformation import unbroken
from style import plt

LEAST_WIDTH = 100  # pixels
DEFORMABLE = {"D": ["taylor_inertia"], "control points": ["n_control_points"]}  # what stands beside an axis, and its series
RIGID = {"incl., °": ["inclination"], "ω₂": ["angular_velocity_x2"]}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", help="directory of a run's results, or a deck, which is run when it has none")
    parser.add_argument("-o", "--output", default="animation.gif", metavar="FILE", help="the animation (default: %(default)s)")
    parser.add_argument("--field", default="traction", help="field that colours the surface (default: %(default)s)")
    parser.add_argument("--view", type=float, nargs=2, default=shape.VIEW, metavar=("AZIMUTH", "ELEVATION"), help="where from, in degrees")
    parser.add_argument("--rate", type=float, default=8, help="frames a second (default: %(default)s)")
    parser.add_argument("--width", type=int, default=720, help="of the animation, in pixels (default: %(default)s)")
    parser.add_argument("--frame", type=float, metavar="TIME", help="one picture of this time instead, a PNG")
    arguments = parser.parse_args()
    if arguments.width < LEAST_WIDTH or arguments.rate <= 0:
        parser.error(f"--width must be at least {LEAST_WIDTH} and --rate positive, but they are {arguments.width} and {arguments.rate:g}")

    run = tanktread.run(arguments.results)
    every = [shot.scaled(run) for shot in run.snapshots()]
    shots = every if arguments.frame is None else [run.snapshot_at(arguments.frame).scaled(run)]
    field = arguments.field
    if field not in shots[0].fields:
        sys.exit(f"{shots[0].path} holds no field {arguments.field}; there are: {', '.join(sorted(shots[0].fields))}")
    film = Film(run, every, field, arguments.view, arguments.width * 2 // 3)
    if arguments.frame is not None:
        film.show(shots[0])
        style.save(film.figure, arguments.output)
        return
    film.figure.set_dpi(arguments.width / film.figure.get_figwidth())
    FuncAnimation(film.figure, film.show, frames=shots).save(arguments.output, PillowWriter(arguments.rate), dpi=film.figure.dpi)
    print(arguments.output)


class Film:
    """One figure in which frame after frame is drawn: the same scale, the same window, the same colours in all of them."""

    def __init__(self, run, shots, field, view, pixels):
        self.run, self.field, self.view, self.pixels = run, field, view, pixels
        places = numpy.concatenate([shot.frame - middle(shot) for shot in shots]) @ shape.view_axes(*view)[:2].T
        self.window = places.min(0), places.max(0)
        self.norm, self.colours = shape.scale([shape.magnitude(shot.fields[field]) for shot in shots])
        extent = self.window[1] - self.window[0]
        plt.rcParams["figure.constrained_layout.use"] = False  # it would move the axes from frame to frame
        self.figure = plt.figure(figsize=(7.2, 7.2 * 0.80 * extent[1] / extent[0] + 3.1))
        height = self.figure.get_figheight()
        self.surface = self.figure.add_axes([0.02, 2.75 / height, 0.84, 1 - 3.1 / height])
        bar = self.figure.add_axes([0.88, 2.9 / height, 0.018, max(0.15, 1 - 3.9 / height)])
        vector = numpy.ndim(shots[0].fields[field]) > 1
        self.figure.colorbar(ScalarMappable(self.norm, self.colours), cax=bar, label=run.label(field, "|{}|" if vector else "{}"))
        upper = self.figure.add_axes([0.11, 1.55 / height, 0.75, 0.95 / height])
        self.panels = [upper, self.figure.add_axes([0.11, 0.5 / height, 0.75, 0.75 / height], sharex=upper)]
        self.shown = shown(run)
        run.require(*(name for names in self.shown.values() for name in names))
        self.marks = self.draw_series()

    def draw_series(self):
        marks = []
        for axis, (label, names), color in zip(self.panels, self.shown.items(), style.RUNS):
            for name in names:
                values = self.run.series[name]
                drawn = unbroken(self.run.time, values) if name == "inclination" else (self.run.time, values)
                axis.plot(*drawn, color=color, linewidth=1.8 if len(names) < 9 else 0.6, drawstyle="steps-post" if name == "n_control_points" else "default")
                marks.append(axis.plot([], [], "o", color=style.INK, markersize=4.5 if len(names) < 9 else 1.5, clip_on=False)[0])
            axis.set_ylabel(label)
            values = numpy.concatenate([self.run.series[name][~numpy.isnan(self.run.series[name])] for name in names])
            if len(values) and values.min() >= 0:
                axis.set_ylim(0, 1.1 * max(values.max(), 1e-6))
        self.panels[0].tick_params(labelbottom=False)
        self.panels[1].set_xlabel(self.run.time_label)
        self.panels[1].set_xlim(self.run.time[0], self.run.time[-1])
        return marks

    def show(self, shot):
        self.surface.clear()
        shape.draw_surface(self.surface, shot, self.field, self.norm, self.colours, *self.view, pixels=self.pixels, triad=False)
        middle_seen = shape.view_axes(*self.view)[:2] @ middle(shot)
        room = 0.11 * (self.window[1] - self.window[0])[0]
        (left, low), (right, high) = self.window + middle_seen
        shape.draw_triad(self.surface, shape.view_axes(*self.view), numpy.array([left, right, low, high]))
        self.surface.set_xlim(left - room, right + room)
        self.surface.set_ylim(low - room, high + room)
        row = numpy.searchsorted(self.run.series["time"], shot.time * (1 - 1e-12))  # of this saved step, the last one if none came after
        row = min(row, len(self.run.time) - 1)
        self.surface.set_title(f"{self.run.name}, t = {shot.time:.4g}: {self.run.series['n_control_points'][row]:.0f} control points")
        for mark, name in zip(self.marks, (name for names in self.shown.values() for name in names)):
            mark.set_data([self.run.time[row]], [self.run.series[name][row]])
        return self.marks


def shown(run):
    """What stands below the surface."""
    if not run.particles:
        return DEFORMABLE if "taylor_inertia" in run.series else RIGID
    deforming = [f"{name}/taylor_inertia" for name in run.particles if f"{name}/taylor_inertia" in run.series]
    return ({"D": deforming} if deforming else {}) | {"smallest gap": ["smallest_gap"]}


def middle(shot):
    return (shot.frame.min(0) + shot.frame.max(0)) / 2


if __name__ == "__main__":
    main()
