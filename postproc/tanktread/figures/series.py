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


@figure
def deformation(runs, axes=None, *, curves: list[pathlib.Path] | None = None,
                deformation: Deformation = "taylor_inertia"):
    """Deformation and inclination over time, beside published curves; of several particles, of each.

    Bands are the estimated errors of a run with requested accuracy.

    curves: published curves, CSV files with the columns t, taylor_inertia and, if known, inclination
    deformation: which Taylor parameter"""
    inclined = any(has_inclination(run) for run in runs)
    width = 6.4 if len(runs) == 1 else 9.8
    if inclined:
        figure, (upper, lower) = style.panels(axes, 2, 1, width, 6.4, sharex=True, height_ratios=[3, 2])
    else:
        figure, (upper,) = style.panels(axes, 1, 1, width, 4.2)
        lower = None
    known = {path.stem: curve_of(path) for path in map(pathlib.Path, curves or [])}
    for run, color in zip(runs, style.RUNS * len(runs)):
        if run.several:
            draw_particles(upper, lower, run, deformation, style.RUNS if len(runs) == 1 else [color])
        else:
            draw_run(upper, lower, run, deformation, color)
            report(run, known)
    draw_curves(upper, lower, known, end=max(run.time[-1] for run in runs))
    upper.set(ylabel="Taylor parameter D" + (" (surface)" if deformation == "taylor_surface" else ""), ylim=(0, None),
              title=title(runs))
    if len(runs) == 1:
        upper.legend(loc="lower right")
    else:
        upper.legend(loc="upper left", bbox_to_anchor=(1.01, 1))
    if inclined:
        lower.set_ylabel("inclination, degrees")
    bottom = lower if inclined else upper
    bottom.set(xlabel=time_label(runs), xlim=(0, None))
    return figure


def has_inclination(run):
    """Returns False if the angle in the plane x1 x2 has no meaning, because the flow is symmetric about an axis."""
    return run.value("Flow/type") != "uniaxial extension"


def title(runs):
    words = [" and ".join(dict.fromkeys(str(run.value(key)) for run in runs if run.value(key)))
             for key in ("Membrane/law", "Flow/type")]
    if len(runs) == 1 and runs[0].value("Membrane/capillary number"):
        words.append(f"Ca = {runs[0].value('Membrane/capillary number'):g}")
    return ", ".join(word for word in words if word)


def label(run):
    points = run.series.get("n_control_points")
    mesh = f", {points[-1]:.0f} control points" if points is not None and len(points) else ""
    return run.name + mesh


def draw_run(upper, lower, run, deformation, color):
    t = run.time
    upper.plot(t, run.series[deformation], color=color, label=label(run), zorder=3)
    style.draw_band(upper, run, deformation, color)
    if lower:
        style.draw_band(lower, run, "inclination", color)
        lower.plot(*unbroken(t, run.series["inclination"]), color=color, zorder=3)
    for axes, name in [(upper, deformation)] + ([(lower, "inclination")] if lower else []):
        expected = run.value(f"Expect/{name}")
        if expected:
            at = expected["at"] * run.rate[0] if "at" in expected else t[-1]
            known = {text.get_label() for text in axes.lines}
            axes.plot(at, expected["value"], "x", color=style.INK, ms=7, mew=1.4, zorder=6, label=EXPECTED
                      if EXPECTED not in known else None)


def draw_particles(upper, lower, run, deformation, colors):
    """Draws deformation and inclination of several particles, with thin lines if they are many."""
    deforming = [name for name in run.particles if f"{name}/{deformation}" in run.series]
    expect(deforming, f"{run.directory}: none of its particles deforms")
    few = len(deforming) <= len(style.RUNS)
    for k, name in enumerate(deforming):
        pen = {"color": colors[k % len(colors)] if few else colors[0], "linewidth": 1.8 if few else 0.5, "zorder": 3}
        words = f"{run.name}: {name}" if few else f"{run.name}: {len(deforming)} particles" if k == 0 else None
        upper.plot(run.time, run.series[f"{name}/{deformation}"], label=words, **pen)
        style.draw_band(upper, run, f"{name}/{deformation}", pen["color"])
        if lower:
            lower.plot(*unbroken(run.time, run.series[f"{name}/inclination"]), **pen)


def unbroken(t, angle):
    """Returns times and angles with a NaN where an axis passes from one end of its range of 180 degrees to the
    other."""
    passes = numpy.flatnonzero(numpy.abs(numpy.diff(angle)) > 90) + 1
    return numpy.insert(t, passes, numpy.nan), numpy.insert(angle, passes, numpy.nan)


def curve_of(path):
    """Returns the rows of a published curve in the order of time, as a structured array."""
    found = table(path, ("t", "taylor_inertia"))
    expect(all(numpy.isfinite(found[name]).all() for name in ("t", "taylor_inertia")), f"{path} has NaN")
    return numpy.sort(found, order="t")


def draw_curves(upper, lower, known, end):
    for (label, curve), mark in zip(known.items(), style.MARKS * len(known)):
        inside = curve[curve["t"] <= end * 1.001]
        pen = {"linestyle": "none", "marker": mark, "ms": 3.6, "mfc": "none", "mec": style.FAINT, "mew": 0.8,
               "zorder": 2, "markevery": max(1, len(inside) // 40)}
        upper.plot(inside["t"], inside["taylor_inertia"], label=label, **pen)
        if lower and "inclination" in curve.dtype.names:
            lower.plot(inside["t"], inside["inclination"], **pen)


def report(run, known):
    for label, curve in known.items():
        names = [("taylor_inertia", "in D")] + [("inclination", "degrees")] * has_inclination(run)
        apart = [f"{difference(run.time, run.series[name], curve['t'], curve[name]):.2e} {words}"
                 for name, words in names if name in curve.dtype.names]
        log.info(f"{run.name}: largest difference from {label}: {', '.join(apart)}")


@figure
def refinement(runs, axes=None, *, deformation: Deformation = "taylor_inertia"):
    """D over time with a mark at every change of the mesh, and the number of control points (the paper's Figure 14).

    Of several runs of one scene, the difference of D from the first one stands below, at the times of snapshots.

    deformation: which Taylor parameter"""
    compares = len(runs) > 1 and all(scene(run) == scene(runs[0]) for run in runs)
    heights = [3, 1.5, 1.8] if compares else [3, 1.8]
    figure, axes = style.panels(axes, len(heights), 1, 6.4, 1.25 * sum(heights), sharex=True, height_ratios=heights)
    upper, lower = axes[0], axes[-1]
    for run, color in zip(runs, style.RUNS * len(runs)):
        t, values, points = run.time, run.series[deformation], run.series["n_control_points"]
        changes = numpy.flatnonzero(numpy.diff(points)) + 1
        upper.plot(t, values, color=color,
                   label=f"{run.name}: {points[0]:.0f} → {points[-1]:.0f} control points, D = {values[-1]:.4f}")
        upper.plot(t[changes], values[changes], "o", color=color, markerfacecolor="white", markersize=4.5)
        lower.step(t, points, where="post", color=color)
        if compares and run is not runs[0]:
            both, mine, firsts = numpy.intersect1d(t.round(9), runs[0].time.round(9), return_indices=True)
            axes[1].plot(both, 1e3 * (values[mine] - runs[0].series[deformation][firsts]), "o-", markersize=3,
                         color=color)
        log.info(f"{run.name}: {len(changes)} changes of the mesh, D({t[-1]:g}) = {values[-1]:.6f}, "
                 f"{points[-1]:.0f} control points")
    if compares:
        axes[1].axhline(0, color=style.RUNS[0])
        axes[1].set_ylabel("10³ (D − D of\nthe first)")
    upper.set(ylabel="Taylor parameter D", ylim=(0, None))
    upper.legend(loc="lower right")
    lower.set(ylabel="control points", ylim=(0, None), xlabel=time_label(runs))
    return figure


def scene(run):
    """Returns the sections of the deck that do not depend on the mesh."""
    return [run.deck.get(name) for name in ("Flow", "Particle", "Membrane", "Tube")]
