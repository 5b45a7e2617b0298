"""Figures of particles in channels, and whether they pass."""

from typing import Literal

import numpy

from ..files import arrays_of
from ..mistakes import expect, log
from . import style
from .draw import draw_pieces, middle, section
from .pushed import Pushed, capillary_number, drop_of_velocity, highest
from .register import figure


@figure
def channel(run, axes=None, *, shapes: int = 7, across: Literal[2, 3] = 2):
    """A channel cut open with its particle at several times; extents, velocity and pressure drop along the way.

    Also the wall's shear stress and the velocity on the centre line of the empty channel.

    shapes: number of times, evenly along the particle's way
    across: the section x2 = 0 or x3 = 0 is drawn, of a bend x3 = 0"""
    c = arrays_of(run.directory / "channel.h5")  # centre (n, 3), s (n,), wall (4, n, 3) and others
    if axes is None or hasattr(axes, "add_subplot"):
        figure = style.canvas(axes, 10.5, 9.5)
        panels = figure.subplot_mosaic([["cut", "cut"], ["extents", "velocity"], ["pressure", "wall"]],
                                       height_ratios=[1.1, 1, 1])
    else:
        figure, axes = style.panels(axes, 5, 1, 10.5, 9.5)
        panels = dict(zip(("cut", "extents", "velocity", "pressure", "wall"), axes))
    way = way_along(run, c)
    cut_open(panels["cut"], run, c, way, shapes, across - 1)
    along_the_way(panels, run, c, way)
    panels["wall"].plot(c["wall_s"], c["wall_shear_stress"], color=style.RUNS[2])
    panels["wall"].set(xlabel="arc length along the centre line" + run.in_units("length"),
                       title="shear stress on the wall of the empty channel" + run.in_units("force/length^2"))
    return figure


def way_along(run, c):
    """Returns the way of the centroid (rows,) along the centre line: to its nearest point, and on along its tangent."""
    name = "center_x" if "center_x1" in run.series else "centroid_x"
    places = numpy.column_stack([run.series[f"{name}{k}"] for k in (1, 2, 3)])
    nearest = numpy.argmin(numpy.linalg.norm(places[:, None] - c["centre"][None], axis=2), axis=1)
    along = numpy.gradient(c["centre"], c["s"], axis=0)[nearest]
    return c["s"][nearest] + numpy.sum((places - c["centre"][nearest]) * along, axis=1)


def cut_open(axis, run, c, way, n, across):
    bent = numpy.ptp(c["centre"][:, 1]) > 0
    across = 2 if bent else across  # in its plane
    up = 3 - across
    lines = c["wall"][2:] if across == 1 else c["wall"][:2]
    axis.plot(lines[:, :, 0].T, lines[:, :, up].T, color=style.INK, linewidth=1.6)
    reach, labelled = run.series["length_x1"].max(), []  # places of the times
    shots = [run.snapshot_at(numpy.interp(x, way, run.series["time"])) for x in numpy.linspace(way[0], way[-1], n)]
    for shot, colour in style.shaded({shot.path: shot for shot in shots}.values()):
        centre = middle(shot.points)
        draw_pieces(axis, section(shot, centre[across], across), colour)
        at = centre[:2] if bent else (centre[0], lines[:, :, 1:].min() * 0.97)
        if all(numpy.hypot(*numpy.subtract(at, other)) >= reach / 8 for other in labelled):
            labelled.append(at)
            axis.text(*at, f"{shot.time:.3g}", color=colour, ha="center", va="center" if bent else "bottom", fontsize=8)
    axis.grid(False)
    shown = lines[:, (c["s"] > way.min() - reach) & (c["s"] < way.max() + reach)].reshape(-1, 3)
    axis.set(aspect="equal", xlim=(shown[:, 0].min(), shown[:, 0].max() + (0.1 if bent else 0)),
             xlabel="x₁" + run.in_units("length"), ylabel=("x₂", "x₃")[up - 1] + run.in_units("length"),
             title=f"{run.name}: cut open at x{across + 1} = centroid; times "
                   f"{'inside' if bent else 'below'}{run.in_units('time')}")
    if bent:
        axis.set_ylim(shown[:, 1].min() - 0.1, shown[:, 1].max() + 0.1)


def along_the_way(panels, run, c, way):
    s, label = run.series, "arc length of the centroid along the centre line" + run.in_units("length")
    extents, velocity, pressure = panels["extents"], panels["velocity"], panels["pressure"]
    for k, color, line in zip((1, 2, 3), style.RUNS, ("-", "-", "--")):
        extents.plot(way, s[f"length_x{k}"], color=color, linestyle=line, label="along x" + " ₁₂₃"[k])
    style.finish(extents, xlabel=label, title="extents of the particle" + run.in_units("length"))
    speed = numpy.linalg.norm([s[f"velocity_x{k}"] for k in (1, 2, 3)], axis=0)
    velocity.plot(way, speed, color=style.RUNS[0], label="of the centroid")
    velocity.plot(c["s"], numpy.linalg.norm(c["velocity"], axis=1), color=style.FAINT, linestyle="--",
                  label="on the centre line, empty channel")
    style.finish(velocity, xlim=(way.min(), way.max()), xlabel=label, title="velocity" + run.in_units("length/time"))
    pressure.plot(way, s["disturbed_pressure_drop"], color=style.RUNS[0], label="reciprocal theorem")
    if "pressure_drop_by_flux" in s:
        pressure.plot(way, s["pressure_drop_by_flux"], color=style.RUNS[1], linestyle=":", label="by the flow rate")
    style.finish(pressure, xlabel=label, title=f"pressure drop that the particle adds{run.in_units('force/length^2')} "
                                               f"(empty channel: {c['pressure_drop']:.5g})")


@figure
def stuck(runs, axes=None, *, elements: int = 160):
    """Whether a capsule passes a round constriction at a given pressure drop: runs, and the drop without friction.

    Without friction an axisymmetric neo-Hookean membrane touches the wall and closes the channel, at rest. Its largest
    pressure drop, over that of the empty channel at the mean velocity V, gives the critical Ca of any viscosity ratio.
    The runs are drawn with the positions that they came to, and their velocities there.

    elements: elements of the membrane, from pole to pole"""
    first = runs[0]
    needed = {"Channel/profile": "constriction", "Channel/section": "circle", "Membrane/law": "neo-Hookean",
              "Particle/shape": "sphere"}
    for key, wanted in needed.items():
        expect(first.value(key) == wanted, f"{key} must be {wanted}, but is {first.value(key)}")
    drop = drop_of_velocity(first)
    way, pressure = Pushed(first, elements).through()
    largest, there = highest(way, pressure)
    log.info(f"without friction: critical Ca = {largest / drop:.5g}, centroid there {there:.3f}, "
             f"pressure drop {largest:.5g} G_s / length")
    figure, (upper, lower) = style.panels(axes, 2, 1, 5.6, 6, sharex=True)
    upper.plot(way, pressure / drop, color=style.INK, label="at rest, without friction")
    for run, color in style.coloured(runs):
        x, ca, speed = run.series["centroid_x1"], capillary_number(run), run.series["velocity_x1"]
        near = x > way[0] - 0.2
        expect(near.any(), f"{run.directory}: its particle does not come to the constriction")
        upper.plot(x[near], numpy.full(near.sum(), ca), color=color)
        upper.plot(x[-1], ca, "o", color=color, markersize=4)
        label = f"Ca = {ca:g}, {run.value('Flow/held', 'flow rate')} held"
        lower.plot(x[near], speed[near] / run.value("Flow/mean velocity", 1.0), color=color, label=label)
        log.info(f"{run.name}: Ca = {ca:g}, to x = {x[-1]:.4f}, there {speed[-1]:.4g}, "
                 f"smallest film {run.series['gap'].min():.4g}")
    style.finish(upper, ylim=(0, None), ylabel="Ca")
    style.finish(lower, yscale="log", ylabel="velocity / V", xlabel="centroid $x_1$" + first.in_units("length"))
    return figure
