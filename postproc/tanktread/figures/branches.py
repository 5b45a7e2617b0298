"""Figures of branches of steady shapes."""

import numpy
import yaml

from ..mistakes import expect, log
from ..runs import Study
from . import style
from .register import figure


@figure()
def branch(runs, axes=None, *, series: str = "taylor_surface", exact: list[tuple[float, float]] | None = None):
    """Branches of steady shapes: D against the parameter, folds marked; below, the rate of the leading mode.

    Unstable parts are broken lines. The runs have the section Continuation; the rate, and what is unstable, need the
    section Spectrum too.

    series: what is drawn against the parameter
    exact: a known point, as parameter and value (repeatable)"""
    rated = all("leading_rate" in run.series for run in runs)
    heights = [3, 1.6] if rated else [3]
    figure, axes = style.panels(axes, len(heights), 1, 5.2, 3.4 + 1.8 * rated, sharex=True, height_ratios=heights)
    upper = axes[0]
    for run, color in style.coloured(runs):
        parameter, value, fold = run.series["parameter"], run.series[series], run.series["fold"] > 0
        draw(upper, run, parameter, value, color, run.name)
        upper.plot(parameter[fold], value[fold], "o", color=color, markerfacecolor="white")
        for p, d in zip(parameter[fold], value[fold]):
            log.info(f"{run.name}: fold at {p:.7g}, {series} = {d:.6f}")
        if rated:
            draw(axes[1], run, parameter, run.series["leading_rate"], color)
    for point in exact or []:
        upper.plot(*point, "+", color=style.INK)
    upper.set_ylabel(label_of(runs[0], series))
    if len(runs) > 1:
        upper.legend()
    if rated:
        axes[1].axhline(0, color=style.INK, linewidth=0.6)
        axes[1].set_ylabel(runs[0].axis("leading_rate").replace("_", " "))
    axes[-1].set_xlabel(runs[0].deck["Continuation"]["parameter"])
    return figure


def label_of(run, series):
    return "Taylor parameter D" if series.startswith("taylor") else run.axis(series)


def draw(axes, run, x, y, color, label=None):
    """Draws a curve of a branch point by point, with a broken line between two points if a mode grows at one."""
    broken = run.series.get("unstable_modes", 0 * x) > 0
    axes.plot([], [], color=color, label=label)
    for k in range(len(x) - 1):
        axes.plot(x[k:k + 2], y[k:k + 2], color=color, linestyle="--" if broken[k:k + 2].any() else "-")
    axes.plot(x, y, ".", color=color, markersize=3)


@figure(2, 1, 5.2, 5.2, sharex=True, height_ratios=[3, 2])
def folds(runs, upper, lower, *, series: str = "taylor_surface", exact: list[tuple[float, float]] | None = None):
    """Folds of branches against a second parameter, such as where drops burst against their viscosity; D there below.

    The runs have the key Continuation/second parameter. Each fold is printed.

    series: what is drawn below
    exact: a known fold, as second parameter and value (repeatable)"""
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
    lower.set(ylabel=label_of(runs[0], series) + (" there" if series.startswith("taylor") else ""), xlabel=second)


@figure(1, 1, 5.2, 3.6)
def growth_rates(run, axis, *, series: str = "taylor_surface", amplitude: float = 0.003, length: float = 2):
    """Rates of the leading mode along a branch of steady shapes, and those of runs in time from the same shapes.

    The run has the section Spectrum. From each of its points except folds, two runs in time start with the mode added
    with either sign; their difference grows or decays at the mode's rate, which is fitted to its later half. Complex
    modes are left out. Runs are kept in results/growth_rates.

    series: series whose difference is taken
    amplitude: of the mode, over R_C
    length: of the runs, in times of the rate"""
    study = Study(directory="results/growth_rates")
    deck = deck_in_time(run, study.directory)
    path = (run.value("Continuation") or {}).get("parameter", "Membrane/capillary number")
    parameter = run.series.get("parameter", numpy.array([run.value(path)]))
    rate = run.series["leading_rate"]
    found = [in_time(study, deck, run, k, path, series, amplitude, length) for k in range(len(rate))]
    for p, one, other in zip(parameter, rate, found):
        compared = f", of runs in time {other:.6f}, relative difference {abs(other / one - 1):.1e}"
        log.info(f"{path} {p:.8g}: rate {one:.6f}{'' if numpy.isnan(other) else compared}")
    draw(axis, run, parameter, rate, style.RUNS[0], "eigenvalue")
    axis.plot(parameter, found, "o", color=style.RUNS[1], markerfacecolor="none", label="run in time")
    axis.axhline(0, color=style.INK, linewidth=0.6)
    style.finish(axis, xlabel=path, ylabel="rate of the leading mode" + run.unit(run.units["leading_rate"]))


def deck_in_time(run, directory):
    """Writes the deck of a run without the sections that replace time, and returns its path."""
    sections = {name: keys for name, keys in run.deck.items()
                if name not in ("Steady", "Continuation", "Spectrum", "Expect")}
    sections["Particle"] = {key: value for key, value in run.deck.get("Particle", {}).items() if key != "initial shape"}
    directory.mkdir(parents=True, exist_ok=True)
    path = directory.resolve() / f"{run.name}.yaml"
    path.write_text(yaml.safe_dump({"Tanktread": sections}, sort_keys=False), encoding="utf-8")
    return path


def in_time(study, deck, run, k, path, series, amplitude, length):
    """Returns the rate from two runs in time at point k; NaN at a fold, of a complex mode, or if a run fails."""
    here = {name: values[k] for name, values in run.series.items()}
    number = 1
    while here.get(f"rate_{number}", here["leading_rate"]) != here["leading_rate"]:
        number += 1
    if here.get("fold", 0) or here.get(f"frequency_{number}", 1):
        return numpy.nan
    end, start, values = length / abs(here["leading_rate"]), run.snapshots()[k].path.resolve(), []
    settings = {"Time/final time": end, "Time/tolerance": 1e-6, "Output/interval": end,
                "Particle/initial shape/mode": number, "Particle/initial shape/run": start}
    keys = {"parameter": path, "second_parameter": run.value("Continuation/second parameter")}
    settings |= {key: here[name] for name, key in keys.items() if name in here}
    times = numpy.linspace(end / 2, end, 11)
    for sign in 1, -1:
        outcome = study.run(deck, settings | {"Particle/initial shape/mode amplitude": sign * amplitude})
        if outcome.done:
            values.append(numpy.interp(times, outcome.series["time"], outcome.series[series]))
        if not outcome.done or numpy.isnan(values[-1]).any():
            log.info(f"from {start}: {f'{series} is undefined (NaN)' if outcome.done else outcome.message}")
            return numpy.nan
    return numpy.polyfit(times, numpy.log(abs(values[0] - values[1])), 1)[0]
