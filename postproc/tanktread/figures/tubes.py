"""Figures of particles in tubes and channels."""

from typing import Literal

import numpy

from ..files import arrays_of
from ..mistakes import expect
from . import style
from .draw import VIEW, draw_pieces, draw_surface, middle, section, share_window
from .register import figure

STEP = 0.2    # difference between velocity contours, divided by the mean velocity
FLOOR = 1e-4  # smallest distance of the centroid from the velocity maximum that is drawn; smaller ones are not accurate
TIMES = [0.0, 0.5, 1.0, 2.0, 5.0, 20.0]
PANELS = {"migration_velocity": "migration velocity / vₘ", "velocity_x1": "velocity along the tube / vₘ",
          "tank_treading_velocity": "tank-treading velocity / vₘ",
          "disturbed_pressure_drop": "additional pressure drop / (μ vₘ/R$_T$)"}
ACROSS, UP = "x₂ / R$_T$", "x₃ / R$_T$"  # labels of axes


@figure(lambda runs: (1, len(runs), 3.9 * len(runs) + 0.9, 4.0))
def duct(runs, *axes):
    """Cross-section of a tube with the velocity of the empty tube, and the path of the particle's centroid in it.

    R_T is the radius of the circle with the area of the cross-section."""
    ducts = [duct_of(run) for run in runs]
    largest = [d["maximum"][2] / d["mean_velocity"] for d in ducts]
    outlines = numpy.concatenate([d["outline"] for d in ducts])
    margin = 0.02 * numpy.ptp(outlines, axis=0).max()
    low, high = outlines.min(0) - margin, outlines.max(0) + margin  # all panels have the same limits
    levels = numpy.append(numpy.arange(0, max(largest), STEP), max(largest))
    for axis, d, run, most in zip(axes, ducts, runs, largest):
        filled = draw_section(axis, d, levels)
        if f"{place_name(run)}2" in run.series:
            draw_path(axis, run, d, style.RUNS[1], 4, linewidth=1.6, label="path of the centroid")
        axis.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]))
        axis.set_title(f"{run.name}: largest velocity {most:.4f}", pad=10)
    axes[0].set_ylabel(UP)
    axes[0].legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=2, handlelength=1.5)
    axes[0].figure.colorbar(filled, ax=list(axes), label="velocity of the empty tube / its mean", shrink=0.8,
                            ticks=levels[:-1:2], spacing="proportional")


def duct_of(run):
    """Returns {name: array} of duct.h5. Lengths are divided by R_T, except `radius`, which is R_T."""
    expect(run.value("Flow/type") == "duct", f"{run.directory} is not in a tube")
    arrays = arrays_of(run.directory / "duct.h5")
    arrays["maximum"][:2] /= arrays["radius"]
    return arrays | {name: arrays[name] / arrays["radius"] for name in ("outline", "x2", "x3")}


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


def place_name(run):
    """Returns the name of the series of the particle's position without the number of the coordinate."""
    return "center_x" if "center_x1" in run.series else "centroid_x"


def draw_path(axis, run, d, color, size, **pen):
    """Draws the path of the centroid across the tube with a mark at its start, and returns it, shape (2, rows)."""
    path = numpy.array([run.series[f"{place_name(run)}{k}"] for k in (2, 3)]) / d["radius"]
    axis.plot(*path, color=color, **pen)
    axis.plot(*path[:, 0], color=color, marker="o", markersize=size)
    return path


@figure()
def tube(runs, axes=None, *, times: list[float] = TIMES):
    """Particles in tubes: their shapes at several times in perspective and in two sections, for each run.

    R_T is the radius of the circle with the area of the tube's cross-section, vₘ the mean velocity of the empty tube.

    times: simulated times of the shapes"""
    figure = style.canvas(axes, 11.5, 4.4 * len(runs))
    for part, run in zip(figure.subfigures(len(runs), 1, squeeze=False)[:, 0], runs):
        run.expect_one_particle()
        d = duct_of(run)
        reached = [run.snapshot_at(time) for time in times if time <= run.series["time"][-1] * (1 + 1e-9)]
        expect(reached, f"{run.directory} ends before the first of these times")
        shots = list({shot.path: shot for shot in reached}.values())  # each once
        shaded = style.shaded(shots)
        upper, lower = part.subfigures(2, 1, height_ratios=[0.45, 0.55])
        largest = max(numpy.linalg.norm(shot.fields["traction"], axis=1).max() for shot in shots[1:] or shots)
        norm, unit = style.plt.Normalize(0, largest), run.value("Flow/viscosity", 1) * run.rate[0]
        row = numpy.atleast_1d(upper.subplots(1, len(shots)))
        for axis, (shot, colour) in zip(row, shaded):
            draw_surface(axis, shot, "traction", norm, style.FIELD, *VIEW, pixels=360, triad=shot is shots[0])
            axis.set_title(run.moment(shot.time, ".3g"), color=colour, loc="center")
        share_window(row)
        part.suptitle(run.name, x=0.01, ha="left", fontsize=11, fontweight="bold")
        draw_tube_sections(run, d, shaded, *lower.subplots(1, 2, width_ratios=[2.1, 1]))
        upper.colorbar(style.plt.cm.ScalarMappable(style.plt.Normalize(0, norm.vmax / unit), style.FIELD), ax=row,
                       label="traction / (μ vₘ/R$_T$)", shrink=0.8)
    return figure


def draw_tube_sections(run, d, shaded, along, across):
    """Draws two kinds of sections through the centroid of a particle. On `along`: sections normal to x2 at successive
    times, side by side, and the wall as two lines, at its lowest and highest x3 at the x2 of the last centroid. On
    `across`: sections normal to x1, inside the outline of the wall. Lengths are divided by R_T."""
    across.plot(*d["outline"].T, color=style.INK, linewidth=1.4)
    place = 0.0
    for shot, colour in shaded:
        c = numpy.array([numpy.interp(shot.time, run.series["time"], run.series[f"{place_name(run)}{k}"])
                         for k in (1, 2, 3)])
        side, front = section(shot, c[1], 1) / d["radius"], section(shot, c[0], 0) / d["radius"]
        c /= d["radius"]
        draw_pieces(across, front, colour)
        draw_pieces(along, side - [c[0] - place, 0], colour)
        along.plot(place, c[2], marker=".", color=colour, markersize=4)
        place += numpy.ptp(shot.points[:, 0]) / d["radius"] + 0.12
    a, b = d["outline"][:-1], d["outline"][1:]
    met = (a[:, 0] - c[1]) * (b[:, 0] - c[1]) <= 0
    (x, height), (dx, rise) = a[met].T, (b - a)[met].T
    heights = height + (c[1] - x) / numpy.where(dx == 0, 1, dx) * rise
    for wall in heights.min(), heights.max():
        along.axhline(wall, color=style.INK, linewidth=1.4)
    along.axhline(0, color=style.FAINT, linewidth=0.8, linestyle=(0, (6, 4)))
    along.autoscale_view()
    along.set(aspect="equal", xticks=[], xlabel="x₁, flow to the right", ylabel=UP, title="section x₂ = centroid")
    across.plot(*d["maximum"][:2], marker="+", color=style.INK, markersize=8)
    across.set(aspect="equal", xlabel=ACROSS, ylabel=UP, title="section x₁ = centroid")
    for axis in along, across:
        axis.grid(False)


@figure(2, 3, 12.5, 6.6)
def tube_motion(runs, paths, distance, *others):
    """Particles in tubes over time: path across the tube, migration, velocity, tank-treading and pressure drop.

    R_T is the radius of the circle with the area of the tube's cross-section, vₘ the mean velocity of the empty tube.
    The pressure drop is the one that the particle adds to that of the empty tube."""
    for run, colour in style.coloured(runs):
        run.expect_one_particle()
        d = duct_of(run)
        speed, maximum = d["mean_velocity"], d["maximum"][:2]
        paths.plot(*d["outline"].T, color=colour, linewidth=1)
        path = draw_path(paths, run, d, colour, 3.5, label=run.name)
        paths.plot(*maximum, color=colour, marker="+", markersize=8)
        off = numpy.hypot(*(path - maximum[:, None]))
        distance.semilogy(run.time, numpy.maximum(off, FLOOR), color=colour)
        for axis, (name, label) in zip(others, PANELS.items()):
            scale = run.value("Flow/viscosity", 1) * speed / d["radius"] if "pressure" in name else speed
            axis.plot(run.time[1:], run.series[name][1:] / scale, color=colour)
            axis.set(title=label, xlabel="t vₘ / R$_T$")
    style.plt.setp(others, xlim=(0, None))
    paths.set(aspect="equal", title="paths of the centroid (+: largest velocity)", xlabel=ACROSS, ylabel=UP)
    paths.legend(loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=2)
    distance.set(ylim=(FLOOR, None), title="distance from the point of largest velocity / R$_T$", xlabel="t vₘ / R$_T$")


@figure(5, 1, 10.5, 9.5, mosaic="AA;BC;DE", height_ratios=[1.1, 1, 1])
def channel(run, cut, extents, velocity, pressure, wall, *, shapes: int = 7, across: Literal[2, 3] = 2):
    """Section of a channel with its particle at several times; extents, velocity and pressure drop along the channel.

    The velocity panel also shows the velocity of the empty channel on its centre line. The last panel shows the shear
    stress on the wall of the empty channel.

    shapes: number of times; the particle is drawn at equal distances along its path
    across: the section is normal to x2 (2) or x3 (3); that of a bend is always normal to x3"""
    expect(run.value("Channel"), f"{run.directory} is not in a channel")
    c = arrays_of(run.directory / "channel.h5")  # centre (n, 3), s (n,), wall (4, n, 3) and others
    s, way = run.series, way_along(run, c)
    cut_open(cut, run, c, way, shapes, across - 1)
    label = "arc length of the centroid along the centre line" + run.in_units("length")
    for k, name, color, line in zip((1, 2, 3), style.AXES, style.RUNS, ("-", "-", "--")):
        extents.plot(way, s[f"length_x{k}"], color=color, linestyle=line, label=f"along {name}")
    style.finish(extents, xlabel=label, title="extents of the particle" + run.in_units("length"))
    speed = numpy.linalg.norm([s[f"velocity_x{k}"] for k in (1, 2, 3)], axis=0)
    velocity.plot(way, speed, color=style.RUNS[0], label="of the centroid")
    velocity.plot(c["s"], numpy.linalg.norm(c["velocity"], axis=1), color=style.FAINT, linestyle="--",
                  label="on the centre line, empty channel")
    style.finish(velocity, xlim=(way.min(), way.max()), xlabel=label, title="velocity" + run.in_units("length/time"))
    pressure.plot(way, s["disturbed_pressure_drop"], color=style.RUNS[0], label="from the reciprocal theorem")
    if "pressure_drop_by_flux" in s:
        pressure.plot(way, s["pressure_drop_by_flux"], color=style.RUNS[1], linestyle=":", label="from the flow rate")
    stress = run.in_units("force/length^2")
    style.finish(pressure, xlabel=label,
                 title=f"pressure drop added by the particle{stress} (empty channel: {c['pressure_drop']:.5g})")
    wall.plot(c["wall_s"], c["wall_shear_stress"], color=style.RUNS[2])
    wall.set(xlabel="arc length along the centre line" + run.in_units("length"),
             title="shear stress on the wall of the empty channel" + stress)


def way_along(run, c):
    """Returns the position s (rows,) of the centroid along the centre line: s of the nearest point of the centre line,
    plus the component along its tangent of the vector from this point to the centroid."""
    name = place_name(run)
    places = numpy.column_stack([run.series[f"{name}{k}"] for k in (1, 2, 3)])
    nearest = numpy.argmin(numpy.linalg.norm(places[:, None] - c["centre"][None], axis=2), axis=1)
    along = numpy.gradient(c["centre"], c["s"], axis=0)[nearest]
    return c["s"][nearest] + numpy.sum((places - c["centre"][nearest]) * along, axis=1)


def cut_open(axis, run, c, way, n, across):
    bent = numpy.ptp(c["centre"][:, 1]) > 0
    across = 2 if bent else across  # a bend is cut in its plane x1 x2
    up = 3 - across
    lines = c["wall"][2:] if across == 1 else c["wall"][:2]
    axis.plot(lines[:, :, 0].T, lines[:, :, up].T, color=style.INK, linewidth=1.6)
    reach, labelled = run.series["length_x1"].max(), []  # labelled: positions of the time labels
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
    low, high = shown.min(0), shown.max(0) + (0.1 if bent else 0)
    axis.set(aspect="equal", xlim=(low[0], high[0]), ylim=(low[1] - 0.1, high[1]) if bent else (None, None),
             xlabel="x₁" + run.in_units("length"), ylabel=style.AXES[up] + run.in_units("length"),
             title=f"{run.name}: section x{across + 1} = centroid; times "
                   f"{'inside' if bent else 'below'}{run.in_units('time')}")
