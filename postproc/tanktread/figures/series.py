"""Figures of series over time."""

import pathlib
from typing import Literal

import numpy

from ..files import table
from ..interpolation import difference
from ..mistakes import expect, log
from ..results import time_label
from . import style
from .register import figure

EXPECTED = "expected by the deck"
Deformation = Literal["taylor_inertia", "taylor_surface"]


@figure()
def deformation(runs, axes=None, *, curves: list[pathlib.Path] | None = None,
                deformation: Deformation = "taylor_inertia"):
    """Deformation and inclination over time, beside published curves; of several particles, of each.

    Bands are the estimated errors of a run with requested accuracy.

    curves: published curves, CSV files with the columns t, taylor_inertia and, if known, inclination
    deformation: which Taylor parameter"""
    # the angle in the plane x1 x3 has no meaning if the flow is symmetric about an axis
    inclined = [run for run in runs if run.value("Flow/type") != "uniaxial extension"]
    height, layout = (6.4, {"sharex": True, "height_ratios": [3, 2]}) if inclined else (4.2, {})
    figure, axes = style.panels(axes, 2 if inclined else 1, 1, 6.4 if len(runs) == 1 else 9.8, height, **layout)
    panels = dict(zip((deformation, "inclination"), axes))
    known = {path.stem: curve_of(path) for path in map(pathlib.Path, curves or [])}
    for run, color in style.coloured(runs):
        if run.several:
            draw_particles(panels, run, deformation, style.RUNS if len(runs) == 1 else [color])
            continue
        draw_run(panels, run, color)
        for label, curve in known.items():
            words = {"taylor_inertia": "in D"} | ({"inclination": "degrees"} if run in inclined else {})
            apart = [f"{difference(run.time, run.series[name], curve['t'], curve[name]):.2e} {unit}"
                     for name, unit in words.items() if name in curve.dtype.names]
            log.info(f"{run.name}: largest difference from {label}: {', '.join(apart)}")
    end = max(run.time[-1] for run in runs)
    for (label, curve), mark in zip(known.items(), style.MARKS * len(known)):
        inside = curve[curve["t"] <= end * 1.001]
        for axis, name in zip(axes, ("taylor_inertia", "inclination")):
            if name in curve.dtype.names:
                axis.plot(inside["t"], inside[name], mark, ms=3.6, mfc="none", mec=style.FAINT, mew=0.8, zorder=2,
                          markevery=max(1, len(inside) // 40), label=label)
    titles = [" and ".join(dict.fromkeys(str(run.value(key)) for run in runs if run.value(key)))
              for key in ("Membrane/law", "Flow/type")]
    if len(runs) == 1 and runs[0].value("Membrane/capillary number"):
        titles.append(f"Ca = {runs[0].value('Membrane/capillary number'):g}")
    axes[0].set(ylabel="Taylor parameter D" + (" (surface)" if deformation == "taylor_surface" else ""),
                ylim=(0, None), title=", ".join(filter(None, titles)))
    place, corner = ("lower right", None) if len(runs) == 1 else ("upper left", (1.01, 1))
    axes[0].legend(loc=place, bbox_to_anchor=corner)
    if inclined:
        axes[1].set_ylabel("inclination, degrees")
    axes[-1].set(xlabel=time_label(runs), xlim=(0, None))
    return figure


def draw_series(axis, run, name, **pen):
    """Draws a series, an inclination as `unbroken`, and the band of its estimated error, if the run has one."""
    drawn = run.time, run.series[name]
    axis.plot(*unbroken(*drawn) if name.endswith("inclination") else drawn, zorder=3, **pen)
    if run.band(name) is not None:
        axis.fill_between(run.time, *run.band(name), color=pen["color"], alpha=0.25, linewidth=0, zorder=2)


def draw_run(panels, run, color):
    """Draws the series on {name: axis}, and what the deck expects of them."""
    points = run.series.get("n_control_points")
    label = run.name + (f", {points[-1]:.0f} control points" if points is not None and len(points) else "")
    for name, axis in panels.items():
        draw_series(axis, run, name, color=color, label=label)
        if expected := run.value(f"Expect/{name}"):
            at = expected["at"] * run.rate[0] if "at" in expected else run.time[-1]
            first = EXPECTED not in {line.get_label() for line in axis.lines}
            axis.plot(at, expected["value"], "x", color=style.INK, ms=7, mew=1.4, zorder=6,
                      label=EXPECTED if first else None)


def draw_particles(panels, run, deformation, colors):
    """Draws deformation and inclination of several particles, with thin lines if they are many."""
    deforming = [name for name in run.particles if f"{name}/{deformation}" in run.series]
    expect(deforming, f"{run.directory}: none of its particles deforms")
    few = len(deforming) <= len(style.RUNS)
    for k, name in enumerate(deforming):
        words = f"{run.name}: {name}" if few else f"{run.name}: {len(deforming)} particles" if k == 0 else None
        for series, axis in panels.items():
            draw_series(axis, run, f"{name}/{series}", color=colors[k % len(colors) if few else 0],
                        linewidth=1.8 if few else 0.5, label=words)


def unbroken(t, angle):
    """Returns times and angles with NaN where an axis passes from one end of its range of 180 degrees to the other."""
    passes = numpy.flatnonzero(numpy.abs(numpy.diff(angle)) > 90) + 1
    return numpy.insert(t, passes, numpy.nan), numpy.insert(angle, passes, numpy.nan)


def curve_of(path):
    """Returns the rows of a published curve in the order of time, as a structured array."""
    found = table(path, ("t", "taylor_inertia"))
    expect(all(numpy.isfinite(found[name]).all() for name in ("t", "taylor_inertia")), f"{path} has NaN")
    return numpy.sort(found, order="t")


@figure()
def refinement(runs, axes=None, *, deformation: Deformation = "taylor_inertia"):
    """D over time with a mark at every change of the mesh, and the number of control points (the paper's Figure 14).

    Of several runs of one scene, the difference of D from the first one stands below, at the times of snapshots.

    deformation: which Taylor parameter"""
    first = runs[0]
    scenes = [[run.deck.get(name) for name in ("Flow", "Particle", "Membrane", "Tube")] for run in runs]
    compares = len(runs) > 1 and all(scene == scenes[0] for scene in scenes)
    heights = [3, 1.5, 1.8] if compares else [3, 1.8]
    figure, axes = style.panels(axes, len(heights), 1, 6.4, 1.25 * sum(heights), sharex=True, height_ratios=heights)
    upper, lower = axes[0], axes[-1]
    for run, color in style.coloured(runs):
        t, values, points = run.time, run.series[deformation], run.series["n_control_points"]
        changes = numpy.flatnonzero(numpy.diff(points)) + 1
        upper.plot(t, values, color=color,
                   label=f"{run.name}: {points[0]:.0f} → {points[-1]:.0f} control points, D = {values[-1]:.4f}")
        upper.plot(t[changes], values[changes], "o", color=color, markerfacecolor="white", markersize=4.5)
        lower.step(t, points, where="post", color=color)
        if compares and run is not first:
            both, mine, firsts = numpy.intersect1d(t.round(9), first.time.round(9), return_indices=True)
            change = values[mine] - first.series[deformation][firsts]
            axes[1].plot(both, 1e3 * change, "o-", markersize=3, color=color)
        log.info(f"{run.name}: {len(changes)} changes of the mesh, D({t[-1]:g}) = {values[-1]:.6f}, "
                 f"{points[-1]:.0f} control points")
    if compares:
        axes[1].axhline(0, color=style.RUNS[0])
        axes[1].set_ylabel("10³ (D − D of\nthe first)")
    upper.set(ylabel="Taylor parameter D", ylim=(0, None))
    upper.legend(loc="lower right")
    lower.set(ylabel="control points", ylim=(0, None), xlabel=time_label(runs))
    return figure
