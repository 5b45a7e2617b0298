"""Figures of series as functions of time or along branches of steady shapes."""

import pathlib
from typing import Literal

import numpy
import yaml

from .. import tables
from ..interpolation import difference
from ..mistakes import expect, log
from ..results import time_label
from ..runs import Study
from . import style
from .register import figure

EXPECTED = "expected by the deck"
Deformation = Literal["taylor_inertia", "taylor_surface"]


@figure()
def deformation(runs, axes=None, *, curves: list[pathlib.Path] | None = None,
                deformation: Deformation = "taylor_inertia"):
    """Taylor parameter D and inclination over time, compared with published curves if they are given.

    If a run has several particles, each of them is drawn. Bands show the estimated errors of a run with requested
    accuracy.

    curves: files of published curves: CSV with the columns t, taylor_inertia and, if known, inclination
    deformation: series that is drawn as D"""
    # the angle in the plane x1 x3 has no meaning if the flow is symmetric about an axis
    inclined = [run for run in runs if run.value("Flow/type") != "uniaxial extension"]
    height, layout = (6.4, {"sharex": True, "height_ratios": [3, 2]}) if inclined else (4.2, {})
    figure, axes = style.panels(axes, 2 if inclined else 1, 1, 6.4 if len(runs) == 1 else 9.8, height, **layout)
    panels = dict(zip((deformation, "inclination"), axes))
    known: dict = {}
    for path in map(pathlib.Path, curves or []):
        rows = tables.read(path, ("t", "taylor_inertia", "inclination"), (2, 3), others=True)
        known[path.stem] = dict(zip(rows.columns, rows.values[rows.values[:, 0].argsort(kind="stable")].T))
    for run, color in style.coloured(runs):
        if run.several:
            draw_particles(panels, run, deformation, style.RUNS if len(runs) == 1 else [color])
            continue
        draw_run(panels, run, color)
        for label, curve in known.items():
            words = {"taylor_inertia": "in D"} | ({"inclination": "degrees"} if run in inclined else {})
            apart = [f"{difference(run.time, run.series[name], curve['t'], curve[name]):.2e} {unit}"
                     for name, unit in words.items() if name in curve]
            log.info(f"{run.name}: largest difference from {label}: {', '.join(apart)}")
    for (label, curve), mark in zip(known.items(), style.MARKS * len(known)):
        inside = curve["t"] <= 1.001 * max(run.time[-1] for run in runs)
        for axis, name in zip(axes, ("taylor_inertia", "inclination")):
            if name in curve:
                axis.plot(curve["t"][inside], curve[name][inside], mark, ms=3.6, mfc="none", mec=style.FAINT, mew=0.8,
                          zorder=2, markevery=max(1, inside.sum() // 40), label=label)
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
    """Draws a series and, if the run has it, the band of its estimated error. Inclinations are drawn by unbroken()."""
    drawn = run.time, run.series[name]
    axis.plot(*unbroken(*drawn) if name.endswith("inclination") else drawn, zorder=3, **pen)
    if run.band(name) is not None:
        axis.fill_between(run.time, *run.band(name), color=pen["color"], alpha=0.25, linewidth=0, zorder=2)


def draw_run(panels, run, color):
    """Draws the series on their axes, and marks the expected values in the deck. `panels`: {name of series: axis}."""
    points = run.series.get("n_control_points")
    label = run.name + (f", {points[-1]:.0f} control points" if points is not None and len(points) else "")
    for name, axis in panels.items():
        draw_series(axis, run, name, color=color, label=label)
        if expected := run.value(f"Expect/{name}"):
            at = expected["at"] * run.time_scale if "at" in expected else run.time[-1]
            axis.plot(at, expected["value"], "x", color=style.INK, ms=7, mew=1.4, zorder=6,
                      label=None if EXPECTED in {line.get_label() for line in axis.lines} else EXPECTED)


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
    """Returns times and angles for a plot. NaN is inserted where an angle jumps by 180 degrees at the end of its range,
    so that no line is drawn there."""
    passes = numpy.flatnonzero(numpy.abs(numpy.diff(angle)) > 90) + 1
    return numpy.insert(t, passes, numpy.nan), numpy.insert(angle, passes, numpy.nan)


@figure()
def refinement(runs, axes=None, *, deformation: Deformation = "taylor_inertia"):
    """Taylor parameter D over time with a mark at every change of the mesh, and the number of control points
    (Figure 14 of Maestre et al. 2017).

    If there are several runs of the same scene, a middle panel shows the difference of their D from D of the first run,
    at the times that both runs recorded.

    deformation: series that is drawn as D"""
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
        axes[1].set_ylabel("10³ (D − D of\nfirst run)")
    upper.set(ylabel="Taylor parameter D", ylim=(0, None))
    upper.legend(loc="lower right")
    lower.set(ylabel="control points", ylim=(0, None), xlabel=time_label(runs))
    return figure


@figure()
def branch(runs, axes=None, *, series: str = "taylor_surface", exact: list[tuple[float, float]] | None = None):
    """Branches of steady shapes: Taylor parameter D against the varied parameter, and growth rate of the leading mode.

    Circles mark folds. Dashed lines mark unstable shapes. The leading mode is the eigenmode with the largest growth
    rate. The runs must have the section Continuation. The growth rate and the dashed lines also need the section
    Spectrum.

    series: series that is drawn against the parameter
    exact: a known point to mark: values of the parameter and of the series (repeatable)"""
    rated = all("leading_rate" in run.series for run in runs)
    heights = [3, 1.6] if rated else [3]
    figure, axes = style.panels(axes, len(heights), 1, 5.2, 3.4 + 1.8 * rated, sharex=True, height_ratios=heights)
    upper = axes[0]
    for run, color in style.coloured(runs):
        expect("Continuation" in run.deck, f"{run.directory} is no branch: its deck has no Continuation")
        parameter, value, fold = run.series["parameter"], run.series[series], run.series["fold"] > 0
        draw_branch(upper, run, parameter, value, color, run.name)
        upper.plot(parameter[fold], value[fold], "o", color=color, markerfacecolor="white")
        for p, d in zip(parameter[fold], value[fold]):
            log.info(f"{run.name}: fold at {p:.7g}, {series} = {d:.6f}")
        if rated:
            draw_branch(axes[1], run, parameter, run.series["leading_rate"], color)
    for point in exact or []:
        upper.plot(*point, "+", color=style.INK)
    upper.set_ylabel("Taylor parameter D" if series.startswith("taylor") else runs[0].axis(series))
    if len(runs) > 1:
        upper.legend()
    if rated:
        axes[1].axhline(0, color=style.INK, linewidth=0.6)
        axes[1].set_ylabel(runs[0].axis("leading_rate").replace("leading_rate", "growth rate"))
    axes[-1].set_xlabel(runs[0].deck["Continuation"]["parameter"])
    return figure


def draw_branch(axes, run, x, y, color, label=None):
    """Draws a curve along a branch. A segment is dashed if the shape at one of its two points has a growing mode."""
    broken = run.series.get("unstable_modes", 0 * x) > 0
    axes.plot([], [], color=color, label=label)
    for k in range(len(x) - 1):
        axes.plot(x[k:k + 2], y[k:k + 2], color=color, linestyle="--" if broken[k:k + 2].any() else "-")
    axes.plot(x, y, ".", color=color, markersize=3)


@figure(2, 1, 5.2, 5.2, sharex=True, height_ratios=[3, 2])
def folds(runs, upper, lower, *, series: str = "taylor_surface", exact: list[tuple[float, float]] | None = None):
    """Folds of branches of steady shapes against a second parameter, for example the critical capillary number of
    drops against their viscosity ratio.

    The upper panel shows the first parameter at the fold, the lower panel the Taylor parameter D at the fold. The runs
    must have the key Continuation/second parameter. Each fold is printed.

    series: series that is drawn in the lower panel
    exact: a known fold to mark: values of the second and of the first parameter (repeatable)"""
    names, reached = set(), []
    for run, color in style.coloured(runs):
        found = numpy.flatnonzero(run.series["fold"] > 0)
        expect(len(found) and "second_parameter" in run.series,
               f"{run.directory} has no folds along a Continuation/second parameter")
        name = run.deck["Continuation"]["second parameter"]
        names.add((name, run.deck["Continuation"]["parameter"]))
        found = found[numpy.argsort(run.series["second_parameter"][found], kind="stable")]
        second, parameter, value = (run.series[key][found] for key in ("second_parameter", "parameter", series))
        reached += list(second)
        upper.plot(second, parameter, "o-", color=color, markersize=3.5, label=run.name)
        lower.plot(second, value, "o-", color=color, markersize=3.5)
        for at, p, d in zip(second, parameter, value):
            log.info(f"{run.name}: {name} {at:.7g}: fold at {p:.7g}, {series} = {d:.6f}")
    pairs = "; ".join(f"{parameter} against {second}" for second, parameter in sorted(names))
    expect(len(names) == 1, f"one figure has one pair of parameters; these runs have {pairs}")
    for point in exact or []:
        upper.plot(*point, "+", color=style.INK, markersize=9)
    second, parameter = names.pop()
    if min(reached) > 0 and max(reached) > 10 * min(reached):
        lower.set_xscale("log")
    if len(runs) > 1:
        upper.legend()
    upper.set_ylabel(parameter + " at the fold")
    lower.set(xlabel=second,
              ylabel="Taylor parameter D at the fold" if series.startswith("taylor") else runs[0].axis(series))


@figure(1, 1, 5.2, 3.6)
def growth_rates(run, axis, *, series: str = "taylor_surface", amplitude: float = 0.003, length: float = 2):
    """Growth rate of the leading mode along a branch of steady shapes, compared with simulations in time.

    The leading mode is the eigenmode with the largest growth rate. The run must have the section Spectrum. From each of
    its steady shapes except folds, two simulations in time start. The mode is added to the shape with opposite signs.
    The difference of the two simulations is proportional to exp(rate x time). The rate is fitted to the second half of
    the time. Complex modes are left out. The simulations are kept in results/growth_rates.

    series: series whose difference is fitted
    amplitude: largest displacement by the added mode, divided by R_C (radius of the sphere with the particle's volume)
    length: duration of the simulations, times the magnitude of the rate"""
    study = Study(directory="results/growth_rates")
    deck = deck_in_time(run, study.directory)
    path = (run.value("Continuation") or {}).get("parameter", "Membrane/capillary number")
    parameter = run.series.get("parameter", numpy.array([run.value(path)]))
    rate = run.series["leading_rate"]
    found = [in_time(study, deck, run, k, path, series, amplitude, length) for k in range(len(rate))]
    for p, one, other in zip(parameter, rate, found):
        compared = f", of runs in time {other:.6f}, relative difference {abs(other / one - 1):.1e}"
        log.info(f"{path} {p:.8g}: rate {one:.6f}{'' if numpy.isnan(other) else compared}")
    draw_branch(axis, run, parameter, rate, style.RUNS[0], "eigenvalue")
    axis.plot(parameter, found, "o", color=style.RUNS[1], markerfacecolor="none", label="simulation in time")
    axis.axhline(0, color=style.INK, linewidth=0.6)
    style.finish(axis, xlabel=path, ylabel="growth rate of the leading mode" + run.unit(run.units["leading_rate"]))


def deck_in_time(run, directory):
    """Writes the deck of a run without the sections that replace the simulation in time (Steady, Continuation,
    Spectrum), and returns its path."""
    sections = {key: run.deck[key] for key in run.deck if key not in ("Steady", "Continuation", "Spectrum", "Expect")}
    sections["Particle"] = {key: value for key, value in run.deck.get("Particle", {}).items() if key != "initial shape"}
    directory.mkdir(parents=True, exist_ok=True)
    path = directory.resolve() / f"{run.name}.yaml"
    path.write_text(yaml.safe_dump({"Tanktread": sections}, sort_keys=False), encoding="utf-8")
    return path


def in_time(study, deck, run, k, path, series, amplitude, length):
    """Returns the growth rate of the leading mode at point k, fitted to the difference of two simulations in time with
    opposite initial amplitudes of the mode. Returns NaN at a fold, if the mode is complex, or if a run fails."""
    here = {name: values[k] for name, values in run.series.items()}
    number = next((n for n in range(1, len(here)) if here.get(f"rate_{n}") == here["leading_rate"]), 0)
    if here.get("fold", 0) or here.get(f"frequency_{number}", 1):
        return numpy.nan
    end, start, values = length / abs(here["leading_rate"]), run.snapshots()[k].path.resolve(), []
    # the times of snapshots contain all t, so that nothing is interpolated
    settings = {"Time/final time": end, "Time/tolerance": 1e-6, "Output/interval": end / 20,
                "Particle/initial shape/mode": number, "Particle/initial shape/run": start}
    keys = {"parameter": path, "second_parameter": run.value("Continuation/second parameter")}
    settings |= {key: here[name] for name, key in keys.items() if name in here}
    t = numpy.linspace(end / 2, end, 11)
    for sign in 1, -1:
        outcome = study.run(deck, settings | {"Particle/initial shape/mode amplitude": sign * amplitude})
        values.append(numpy.interp(t, outcome.series["time"], outcome.series[series]) if outcome.done else numpy.nan)
        if numpy.isnan(values[-1]).any():
            log.info(f"from {start}: {f'{series} is undefined (NaN)' if outcome.done else outcome.message}")
            return numpy.nan
    return numpy.polyfit(t, numpy.log(abs(values[0] - values[1])), 1)[0]
