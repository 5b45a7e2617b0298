"""Figures of particles in tubes and channels."""

from typing import Literal

import numpy

from ..files import arrays_of
from ..mistakes import expect
from ..snapshots import evenly
from . import style
from .draw import (draw_pieces, draw_surface, extents_along, magnitude, middle_plane, section, share_window, view_of)
from .register import figure
from .scene import surrounded

STEP = 0.2    # difference between velocity contours, divided by the mean velocity
FLOOR = 1e-4  # smallest distance of the centroid from the velocity maximum that is drawn; smaller ones are not accurate
SHAPES = 6    # number of times at which a particle is drawn; of several particles, half of it
PANELS = {"migration_velocity": "migration velocity / vₘ", "velocity_x1": "velocity along the tube / vₘ",
          "tank_treading_velocity": "tank-treading velocity / vₘ",
          "disturbed_pressure_drop": "additional pressure drop / (μ vₘ/R$_T$)"}
ACROSS, UP = "x₂ / R$_T$", "x₃ / R$_T$"  # labels of axes


@figure(lambda runs: (1, len(runs), 3.9 * len(runs) + 0.9, 4.0))
def duct(runs, *axes):
    """Cross-section of a tube with the velocity of the empty tube, and the paths of the particles' centroids in it.

    R_T is the radius of the circle with the area of the cross-section. Of a channel, the inlet is drawn without
    paths."""
    ducts = [driven(run) for run in runs]
    largest = [d["maximum"][2] / d["mean_velocity"] for d in ducts]
    outlines = numpy.concatenate([d["outline"] for d in ducts])
    margin = 0.02 * numpy.ptp(outlines, axis=0).max()
    low, high = outlines.min(0) - margin, outlines.max(0) + margin  # all panels have the same limits
    levels = numpy.append(numpy.arange(0, max(largest), STEP), max(largest))
    for axis, d, run, most in zip(axes, ducts, runs, largest):
        filled = draw_section(axis, d, levels)
        for path in paths_of(run).values() if "Tube" in run.deck else ():
            label = None if axis.get_legend_handles_labels()[1][1:] else "path of the centroid"
            draw_path(axis, path[1:] / d["radius"], style.RUNS[1], 4, linewidth=1.6, label=label)
        axis.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]))
        axis.set_title(f"{run.name}: largest velocity {most:.4f}", pad=10)
    axes[0].set_ylabel(UP)
    axes[0].legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=2, handlelength=1.5)
    axes[0].figure.colorbar(filled, ax=list(axes), label="velocity of the empty tube / its mean", shrink=0.8,
                            ticks=levels[:-1:2], spacing="proportional")


def duct_of(run):
    """Returns {name: array} of duct.h5. Lengths are divided by R_T, except `radius`, which is R_T."""
    expect("Tube" in run.deck or "Channel" in run.deck, f"{run.directory} is not in a tube")
    arrays = arrays_of(run.directory / "duct.h5")
    arrays["maximum"][:2] /= arrays["radius"]
    return arrays | {name: arrays[name] / arrays["radius"] for name in ("outline", "x2", "x3")}


def driven(run):
    """Returns duct_of(run). Raises Mistake if the fluid does not flow through the duct."""
    d, kind = duct_of(run), run.value("Flow/type")
    expect(kind == "duct", f"{run.directory}: no fluid is driven through its tube, because Flow/type is {kind}")
    return d


def expect_tube(run):
    """Raises Mistake unless the run is in a straight tube."""
    expect("Channel" not in run.deck, f"{run.directory} is in a channel: use the figure `channel`")
    run.expect_particles()


def draw_section(axis, d, levels):
    """Draws the velocity of the empty tube in its cross-section as filled contours, and returns them."""
    velocity = d["velocity"] / d["mean_velocity"]
    inside = numpy.isfinite(velocity)
    grid = numpy.stack(numpy.meshgrid(d["x2"], d["x3"]), axis=-1)[inside]
    field = *numpy.concatenate([grid, d["outline"]]).T, numpy.append(velocity[inside], numpy.zeros(len(d["outline"])))
    filled = axis.tricontourf(*field, levels, cmap=style.FIELD)
    lines = axis.tricontour(*field, levels[1:-1], colors="white", linewidths=0.5, alpha=0.7)
    wall = style.plt.Polygon(d["outline"], facecolor="none", edgecolor=style.INK, linewidth=1.6)
    axis.add_patch(wall)
    for artist in filled.collections + lines.collections if hasattr(filled, "collections") else [filled, lines]:
        artist.set_clip_path(wall)
    axis.plot(*d["maximum"][:2], marker="+", color=style.INK, markersize=9, linestyle="none", label="largest velocity")
    axis.set(aspect="equal", xlabel=ACROSS)
    axis.grid(False)
    axis.spines[:].set_visible(False)
    return filled


def paths_of(run):
    """Returns {particle: positions of its centroid (3, rows)}, without bodies whose motion is prescribed."""
    found = {}
    for particle in run.particles:
        before = f"{particle}/" if run.several else ""
        for name in "centroid_x", "center_x":
            if f"{before}{name}1" in run.series:
                found[particle] = numpy.array([run.series[f"{before}{name}{k}"] for k in (1, 2, 3)])
                break
    return found


def draw_path(axis, path, color, size, **pen):
    """Draws a path (2, rows) across the tube with a mark at its start."""
    axis.plot(*path, color=color, **pen)
    axis.plot(*path[:, 0], color=color, marker="o", markersize=size)


@figure()
def tube(runs, axes=None, *, times: list[float] | None = None):
    """Particles in tubes: their shapes at several times in perspective and in two sections, for each run.

    The section along the tube goes through as many particles as possible. In the section across the tube, each particle
    is cut in its middle. R_T is the radius of the circle with the area of the tube's cross-section, vₘ the mean
    velocity of the empty tube.

    times: simulated times of the shapes (default: equally spaced from the start to the end)"""
    figure = style.canvas(axes, 11.5, 4.4 * len(runs))
    for part, run in zip(figure.subfigures(len(runs), 1, squeeze=False)[:, 0], runs):
        d = duct_of(run)
        expect_tube(run)
        reached = [run.snapshot_at(time) for time in times or [0] if time <= run.series["time"][-1] * (1 + 1e-9)]
        expect(reached, f"{run.directory} ends before the first of these times")
        reached = reached if times else evenly(run.snapshots(), SHAPES // (1 + (len(run.particles) > 1)))
        shots = [surrounded(run, shot) for shot in {shot.path: shot for shot in reached}.values()]  # each once
        shaded, view = style.shaded(shots), view_of([run], None)
        upper, lower = part.subfigures(2, 1, height_ratios=[0.45, 0.55])
        norm = style.plt.Normalize(0, max(magnitude(shot.fields["traction"]).max() for shot in shots[1:] or shots))
        row = numpy.atleast_1d(upper.subplots(1, len(shots)))
        for axis, (shot, colour) in zip(row, shaded):
            draw_surface(axis, shot, "traction", norm, style.FIELD, view, pixels=360, triad=shot is shots[0])
            axis.set_title(run.moment(shot.time, ".3g"), color=colour, loc="center")
        share_window(row)
        part.suptitle(run.name, x=0.01, ha="left", fontsize=11, fontweight="bold")
        draw_tube_sections(run.radius / d["radius"], d, shaded, *lower.subplots(1, 2, width_ratios=[2.1, 1]))
        label = "traction / (μ vₘ/R$_T$)" if run.value("Flow/type") == "duct" else run.label("traction")
        upper.colorbar(style.plt.cm.ScalarMappable(norm, style.FIELD), ax=row, label=label, shrink=0.8)
    return figure


def draw_tube_sections(unit, d, shaded, along, across):
    """Draws two kinds of sections of snapshots. On `along`: the sections normal to x2 at successive times, side by
    side, and the wall as two lines, at its lowest and highest x3 in the last section. On `across`: the sections normal
    to x1 through each particle, inside the outline of the wall. `unit`: unit of length of the snapshots / R_T."""
    across.plot(*d["outline"].T, color=style.INK, linewidth=1.4)
    place, planes = 0.0, []
    for shot, colour in shaded:
        ends = [unit * extents_along(shot, axis) for axis in numpy.eye(3)]  # each (particles, 2)
        low, high = ends[0].min(), ends[0].max()
        planes.append(unit * middle_plane(shot, numpy.eye(3)[1]))
        draw_pieces(along, unit * section(shot, planes[-1] / unit) - [low - place, 0], colour)
        for name, (x1, _, x3) in zip(shot.particles, numpy.mean(ends, axis=2).T):
            draw_pieces(across, unit * section(shot, x1 / unit, 0, particle=name), colour)
            if numpy.prod(unit * extents_along(shot, numpy.eye(3)[1])[shot.particles.index(name)] - planes[-1]) < 0:
                along.plot(x1 - low + place, x3, marker=".", color=colour, markersize=4)
        place += high - low + 0.12
    a, b = d["outline"][:-1], d["outline"][1:]
    met = (a[:, 0] - planes[-1]) * (b[:, 0] - planes[-1]) <= 0
    (x, height), (dx, rise) = a[met].T, (b - a)[met].T
    heights = height + (planes[-1] - x) / numpy.where(dx == 0, 1, dx) * rise
    for wall in heights.min(), heights.max():
        along.axhline(wall, color=style.INK, linewidth=1.4)
    along.axhline(0, color=style.FAINT, linewidth=0.8, linestyle=(0, (6, 4)))
    along.autoscale_view()
    named = " to ".join(dict.fromkeys(f"{round(place, 3) + 0.0:.3g}" for place in (planes[0], planes[-1])))
    along.set(aspect="equal", xticks=[], xlabel="x₁, flow to the right", ylabel=UP,
              title=f"section x₂ / R$_T$ = {named}")
    across.plot(*d["maximum"][:2], marker="+", color=style.INK, markersize=8)
    across.set(aspect="equal", xlabel=ACROSS, ylabel=UP,
               title=f"x₁ = middle of {'each' if len(shot.particles) > 1 else 'the'} particle")
    for axis in along, across:
        axis.grid(False)


@figure(2, 3, 12.5, 6.6)
def tube_motion(runs, paths, distance, *others):
    """Particles in tubes over time: path across the tube, migration, velocity, tank-treading and pressure drop.

    R_T is the radius of the circle with the area of the tube's cross-section, vₘ the mean velocity of the empty tube.
    The pressure drop is the one that all particles together add to that of the empty tube. A panel is left out if no
    particle has its series."""
    several = len(runs) == 1 and runs[0].several
    for run, colour in style.coloured(runs):
        d = driven(run)
        expect_tube(run)
        speed, maximum, moving = d["mean_velocity"], d["maximum"][:2], paths_of(run)
        expect(moving, f"{run.directory}: the motion of its particles is prescribed, so that nothing changes in time")
        paths.plot(*d["outline"].T, color=style.INK if several else colour, linewidth=1)
        paths.plot(*maximum, color=style.INK if several else colour, marker="+", markersize=8)
        for (name, path), own in style.coloured(moving.items()):
            own, label = (own, name) if several else (colour, run.name if name == next(iter(moving)) else None)
            path = path[1:] / d["radius"]
            draw_path(paths, path, own, 3.5, label=label)
            off = numpy.hypot(*(path - maximum[:, None]))
            distance.semilogy(run.time, numpy.maximum(off, FLOOR), color=own)
            for axis, series in zip(others[:-1], PANELS):
                if (series := f"{name}/{series}" if run.several else series) in run.series:
                    axis.plot(run.time[1:], run.series[series][1:] / speed, color=own)
        drop = run.series["disturbed_pressure_drop"] / (run.value("Flow/viscosity", 1) * speed / d["radius"])
        others[-1].plot(run.time[1:], drop[1:], color=style.INK if several else colour)
    for axis, label in zip(others, PANELS.values()):
        axis.set(title=label, xlabel="t vₘ / R$_T$", xlim=(0, None), visible=len(axis.lines) > 0)
    paths.set(aspect="equal", title="paths of the centroid (+: largest velocity)", xlabel=ACROSS, ylabel=UP)
    paths.legend(loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=2)
    distance.set(ylim=(FLOOR, None), title="distance from the point of largest velocity / R$_T$", xlabel="t vₘ / R$_T$")


@figure(5, 1, 10.5, 9.5, mosaic="AA;BC;DE", height_ratios=[1.1, 1, 1])
def channel(run, cut, extents, velocity, pressure, wall, *, shapes: int = 7, across: Literal[2, 3] = 2):
    """Section of a channel with its particles at several times; extents, velocity and pressure drop along the channel.

    The section goes through as many particles as possible. The velocity panel also shows the velocity of the empty
    channel on its centre line. The pressure drop is drawn against the position of the first particle. The last panel
    shows the shear stress on the wall of the empty channel.

    shapes: number of times; the (first) particle is drawn at equal distances along its path
    across: the section is normal to x2 (2) or x3 (3); that of a bend is always normal to x3"""
    expect("Channel" in run.deck, f"{run.directory} is not in a channel")
    c = arrays_of(run.directory / "channel.h5")  # centre (n, 3), s (n,), wall (4, n, 3) and others
    s, ways = run.series, {name: way_along(path, c) for name, path in paths_of(run).items()}
    expect(ways, f"{run.directory}: no particle moves along its channel, because no motion is computed")
    cut_open(cut, run, c, list(ways.values()), shapes, across - 1)
    ways = {name: in_period(run, c, way) for name, way in ways.items()}
    way = next(iter(ways.values()))
    label = "arc length of the centroid along the centre line" + run.in_units("length")
    for name, at in ways.items():
        before = f"{name}/" if run.several else ""
        for k, axis, color, line in zip((1, 2, 3), style.AXES, style.RUNS, ("-", "-", "--")):
            if f"{before}length_x{k}" in s:
                extents.plot(at, s[f"{before}length_x{k}"], color=color, linestyle=line,
                             label=f"along {axis}" if at is way else None)
        speed = numpy.linalg.norm([s[f"{before}velocity_x{k}"] for k in (1, 2, 3)], axis=0)
        velocity.plot(at, speed, color=style.RUNS[0], label="of the centroid" if at is way else None)
    style.finish(extents, xlabel=label, title="extents of the particle" + run.in_units("length"),
                 visible=len(extents.lines) > 0)
    velocity.plot(c["s"], numpy.linalg.norm(c["velocity"], axis=1), color=style.FAINT, linestyle="--",
                  label="on the centre line, empty channel")
    every = numpy.concatenate(list(ways.values()))
    speeds = "velocity" + run.in_units("length/time")
    style.finish(velocity, xlim=(numpy.nanmin(every), numpy.nanmax(every)), xlabel=label, title=speeds)
    pressure.plot(way, s["disturbed_pressure_drop"], color=style.RUNS[0], label="from the reciprocal theorem")
    if "pressure_drop_by_flux" in s:
        pressure.plot(way, s["pressure_drop_by_flux"], color=style.RUNS[1], linestyle=":", label="from the flow rate")
    stress = run.in_units("force/length^2")
    added = f"pressure drop added by the particle{'s' * (len(ways) > 1)}{stress}"
    style.finish(pressure, xlabel=label, title=f"{added} (empty channel: {c['pressure_drop']:.5g})")
    if "wall_s" in c:  # a periodic channel has no arrays of the wall
        wall.plot(c["wall_s"], c["wall_shear_stress"], color=style.RUNS[2])
    wall.set(xlabel="arc length along the centre line" + run.in_units("length"), visible="wall_s" in c,
             title="shear stress on the wall of the empty channel" + stress)


def way_along(path, c):
    """Returns the position s (rows,) along the centre line of the points of a path (3, rows): s of the nearest point of
    the centre line, plus the component along its tangent of the vector from this point to the given one."""
    nearest = numpy.argmin(numpy.linalg.norm(path.T[:, None] - c["centre"][None], axis=2), axis=1)
    along = numpy.gradient(c["centre"], c["s"], axis=0)[nearest]
    return c["s"][nearest] + numpy.sum((path.T - c["centre"][nearest]) * along, axis=1)


def in_period(run, c, way):
    """Returns positions along the centre line, in a periodic channel moved into the period that is drawn. NaN separates
    successive periods."""
    if run.cell(0) is None:
        return way
    period = c["s"][-1] - c["s"][0]
    number = (way - c["s"][0]) // period
    return numpy.where(numpy.diff(number, prepend=number[0]) == 0, way - number * period, numpy.nan)


def cut_open(axis, run, c, ways, n, across):
    """Draws the section of a channel with its particles at n times. `ways`: see way_along, of each particle."""
    way, every = ways[0], numpy.concatenate(ways)
    period = c["s"][-1] - c["s"][0] if run.cell(0) is not None else numpy.inf
    bent = numpy.ptp(c["centre"][:, 1]) > 0
    across = 2 if bent else across  # a bend is cut in its plane x1 x2
    up = 3 - across
    lines = c["wall"][2:] if across == 1 else c["wall"][:2]
    axis.plot(lines[:, :, 0].T, lines[:, :, up].T, color=style.INK, linewidth=1.6)
    shots = [run.snapshot_at(numpy.interp(x, way, run.series["time"])) for x in numpy.linspace(way[0], way[-1], n)]
    shots = list({shot.path: shot for shot in shots}.values())
    reach, labelled = max(numpy.ptp(shot.points[:, 0]) for shot in shots), []  # labelled: positions of the time labels
    for shot, colour in style.shaded(shots):
        place = middle_plane(shot, numpy.eye(3)[across])
        centres = numpy.array([extents_along(shot, one).mean(1) for one in numpy.eye(3)[:2]]).T
        shifts = numpy.nan_to_num((centres[:, 0] - c["s"][0]) // period) * min(period, 1e300)  # into the drawn period
        for name, shift in zip(shot.particles, shifts):
            draw_pieces(axis, section(shot, place, across, particle=name) - [shift, 0], colour)
        centre = centres[0] - [shifts[0], 0]
        at = centre if bent else (centre[0], lines[:, :, 1:].min() * 0.97)
        if all(numpy.hypot(*numpy.subtract(at, other)) >= reach / 8 for other in labelled):
            labelled.append(at)
            axis.text(*at, f"{shot.time:.3g}", color=colour, ha="center", va="center" if bent else "bottom", fontsize=8)
    axis.grid(False)
    seen = (c["s"] > every.min() - reach) & (c["s"] < every.max() + reach)
    shown = lines[:, seen | numpy.isfinite(period)].reshape(-1, 3)
    low, high = shown.min(0), shown.max(0)
    margin = 0.02 * (high - low).max()
    axis.set(aspect="equal", xlim=(low[0], high[0]), ylim=(low[1] - margin, high[1] + margin) if bent else (None, None),
             xlabel="x₁" + run.in_units("length"), ylabel=style.AXES[up] + run.in_units("length"),
             title=f"{run.name}: section x{across + 1} = middle of particle{'s' * (len(shot.particles) > 1)}; times "
                   f"{'inside' if bent else 'below'}{run.in_units('time')}")
