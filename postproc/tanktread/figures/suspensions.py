"""Figures of suspensions: stress, viscosity, and drift over many turns."""

import pathlib

import numpy

from ..interpolation import averages_between
from ..mistakes import expect, log
from ..results import time_label
from ..runs import Study
from ..studies.sweep import Sweep
from . import style
from .register import figure

SYMBOLS = {"relative_viscosity": "μ_eff/μ", "normal_stress_difference_1": "N₁", "normal_stress_difference_2": "N₂"}
DRIFTS = {"area": "area / its first value − 1", "volume_error": "V / V$_0$ − 1", "energy": "energy / its mean − 1",
          "taylor_inertia": "D", "inclination": "inclination / degrees"}
CA = "Particles/capsule/Membrane/capillary number"


@figure(2, 1, 6.4, 6.4, sharex=True)
def rheology(runs, upper, lower):
    """Intrinsic viscosity and normal stress differences of a dilute suspension in simple shear, over time.

    [η] = S_13/(μ γ̇ V), N1 = (S_11 − S_33)/(μ γ̇ V), N2 = (S_33 − S_22)/(μ γ̇ V) from the stresslet S, per volume of
    particles in a volume of suspension; flow along x1, its gradient along x3. A rigid sphere has [η] = 5/2."""
    for run, color in style.coloured(runs):
        viscosity, n1, n2 = stresses(run)
        upper.plot(run.time, viscosity, color=color, label=run.name)
        lower.plot(run.time, n1, color=color, label="N₁" if run is runs[0] else None)
        lower.plot(run.time, n2, color=color, linestyle=style.DASHES, label="N₂" if run is runs[0] else None)
        log.info(f"{run.name}, t = {run.time[-1]:g}: [η] = {viscosity[-1]:.5f}, N1 = {n1[-1]:.5f}, N2 = {n2[-1]:.5f}")
    style.finish(upper, ylabel="intrinsic viscosity [η]")
    lower.axhline(0, color=style.FAINT, linewidth=0.8)
    style.finish(lower, ylabel="normal stress differences / (μ γ̇ φ)", xlabel=time_label(runs))


def stresses(run):
    """Returns [η], N1 and N2 over time (rows,), without a unit."""
    flow = run.value("Flow/type")
    expect(flow == "simple shear", f"{run.directory}: intrinsic viscosity is of simple shear, and this is {flow}")
    volume = run.series["volume"][0] if "volume" in run.series else run.snapshots()[0].volume()
    unit = run.value("Flow/viscosity", 1) * run.rate[0] * volume
    s11, s22, s33, s13 = (run.series[f"stresslet_{k}"] / unit for k in ("11", "22", "33", "13"))
    return s13, s11 - s33, s33 - s22


@figure(2, 1, 6.4, 6.4, sharex=True)
def suspension(runs, upper, lower, *, from_: float = 1, blocks: int = 8):
    """Effective viscosity and normal stress differences of a lattice of particles over strain, with their averages.

    Averages have a standard error by blocks: the spread of the means of equal parts of the strain, over the root of
    their number.

    from_: strain at which averages begin
    blocks: number of parts of an average"""
    for run, color in style.coloured(runs):
        strain, words, label = run.time, [], f"{run.name}, φ = {run.series['volume_fraction'][0]:.3g}"
        for (name, symbol), axis, line in zip(SYMBOLS.items(), (upper, lower, lower), ("-", "-", "--")):
            axis.plot(strain, run.series[name], color=color, linestyle=line,
                      label=label if axis is upper else symbol if run is runs[0] else None)
            mean, error = average(strain, run.series[name], from_, blocks)
            if numpy.isfinite(mean):
                axis.plot([from_, strain[-1]], [mean, mean], color=color, linewidth=0.8, linestyle=":")
            words.append(f"{symbol} = {mean:.5f} ± {error:.5f}")
        log.info(f"{run.name}, strain {from_:g} to {strain[-1]:g}: {', '.join(words)}")
    style.finish(upper, ylabel="effective viscosity μ_eff/μ")
    lower.axhline(0, color=style.FAINT, linewidth=0.8)
    stress = runs[0].unit(runs[0].units["normal_stress_difference_1"])
    style.finish(lower, ylabel="normal stress differences" + stress, xlabel="strain")


def average(strain, values, first, blocks):
    """Returns the mean over strain from `first` on, by the trapezoidal rule, and its standard error by equal blocks."""
    expect(blocks > 1, f"--blocks must be at least 2, but is {blocks}")
    if strain[-1] <= first:
        return numpy.nan, numpy.nan
    means = averages_between(strain, values, numpy.linspace(first, strain[-1], blocks + 1))
    return means.mean(), means.std(ddof=1) / numpy.sqrt(blocks)


@figure(2, 1, 6.4, 7.2, sharex=True)
def viscosity(study, upper, lower, *, single: str = "inputs/shear_neo_hookean.yaml", from_: float = 4, blocks: int = 4,
              jobs: int = 1):
    """Relative viscosity of a sheared suspension against its volume fraction, with standard errors by blocks.

    A curve for each capillary number, from a sweep of runs that are kept in results/<study>. Below it stands
    (μ_eff/μ - 1)/φ, and at φ = 0 the intrinsic viscosity of one capsule, to which the straight line should go. The
    errors do not contain what another start or more particles in the cell would change.

    single: deck of one capsule
    from_: strain at which averages begin
    blocks: number of parts of an average
    jobs: runs at a time"""
    directory = pathlib.Path("results") / pathlib.Path(study).stem
    directory.mkdir(parents=True, exist_ok=True)
    made = Study(directory=directory / "runs", jobs=jobs)
    runs = Sweep(study, made)
    expect(all(CA in row for row in runs.rows), f"{study} varies or sets no {CA}")
    runs.make()
    runs.write(directory)
    rows: dict = {}
    for outcome, settings in zip(runs.outcomes, runs.rows):
        if row := averages(outcome, from_, blocks):
            rows.setdefault(settings[CA], []).append(row)
    expect(rows, f"none of the runs of {study} went beyond --from {from_:g}; the first one: {runs.outcomes[0].message}")
    deck = next(one for one in runs.outcomes if one.done).run.deck
    alike = {"Time/final time": deck["Time"]["final time"],
             "Surface/elements per side": deck["Particles"]["capsule"]["Surface"]["elements per side"]}
    for (ca, found), color in style.coloured(rows.items()):
        outcome = made.run(single, {"Membrane/capillary number": ca} | alike)
        expect(outcome.done, f"one capsule at Ca = {ca:g}: {outcome.message}")
        alone = stresses(outcome.run)[0][-1]
        fraction, mean, error = numpy.array(sorted(found)).T
        slope = (mean - 1) / fraction
        look = {"color": color, "fmt": "o", "markersize": 4, "capsize": 2.5}
        upper.errorbar(fraction, mean, error, label=f"Ca = {ca:g}", **look)
        upper.plot([0, fraction[-1]], [1, 1 + alone * fraction[-1]], color=color, linewidth=0.8, linestyle=":")
        lower.errorbar(fraction, slope, error / fraction, **look)
        lower.plot(0, alone, "D", color=color, markersize=5, markerfacecolor="none", clip_on=False)
        log.info(f"Ca = {ca:g}: " + ", ".join(f"{m:.4f} ± {e:.4f} at {f:.3g}" for f, m, e in sorted(found)))
        if len(fraction) > 2:
            (_, limit), covariance = numpy.polyfit(fraction, slope, 1, w=fraction / error, cov="unscaled")
            log.info(f"  per volume fraction, extrapolated to 0: {limit:.3f} ± {covariance[1, 1] ** 0.5:.3f}; "
                     f"one capsule: {alone:.4f}")
    style.finish(upper, ylabel="relative viscosity μ_eff/μ")
    lower.set(ylabel="(μ_eff/μ − 1)/φ; at 0: one capsule", xlabel="volume fraction φ", xlim=(-0.005, None))


def averages(outcome, first, blocks):
    """Returns volume fraction, mean and standard error of a run, or None of one that did not end beyond `first`."""
    if not outcome.done:
        log.info(f"left out: {outcome.message.removeprefix('tanktread: ')}")
        return None
    name, series, strain = outcome.directory.name, outcome.series, outcome.run.time
    if strain[-1] <= first:
        log.info(f"left out: {name} ends at strain {strain[-1]:g}, before --from {first:g}")
        return None
    fraction, impulse = series["volume_fraction"][0], series["contact_impulse"][-1]
    if impulse > 0:
        log.info(f"{name}, φ = {fraction:.3g}: the limiter's impulse is {impulse:.3g}")
    return fraction, *average(strain, series["relative_viscosity"], first, blocks)


@figure(len(DRIFTS), 1, 6.4, 7.6, sharex=True)
def drift(run, *axes, from_: int = 10):
    """Whether a run over many turns of a membrane drifts: series against the turns, and the mean of each turn.

    A turn is one of `phase`. A straight line through the means gives the change over all turns from --from on, with its
    standard error. If the flow has a history that ends at rest, the steps in which the energy then rises are counted.

    from_: first turn of the straight line"""
    expect(from_ >= 0, f"--from needs a turn, but is given {from_}")
    stop, rest = flow_of(run)
    flows = run.series["time"] <= stop
    time, phase = run.series["time"][flows], run.series["phase"][flows]
    made = phase[-1] / 360
    expect(made >= from_ + 3, f"{run.directory} has {max(made, 0):.1f} turns; a line from turn {from_} on needs "
                              f"{from_ + 3}: a later Time/final time, or --from an earlier one")
    log.info(f"{made:.1f} turns, {len(time)} steps; "
             f"the largest error of the volume {numpy.abs(run.series['volume_error']).max():.2g}")
    for (name, label), axis in zip(DRIFTS.items(), axes):
        values = run.series[name][flows]
        means = turns(time, values, phase)
        if scale := {"area": values[0], "energy": means.mean()}.get(name):
            values, means = values / scale - 1, means / scale - 1
        change, error = line(means, from_)
        later, within = means[from_:], values[(phase > 360 * from_) & ~numpy.isnan(values)]
        log.info(f"{name}: changes by {change:.2g} ± {error:.1g} over {len(later)} turns; their means "
                 f"{later.min():.6g} to {later.max():.6g}, within turns {within.min():.6g} to {within.max():.6g}")
        axis.plot(phase / 360, values, color=style.FAINT, linewidth=0.3)
        axis.plot(numpy.arange(len(means)) + 0.5, means, color=style.RUNS[0], linewidth=1)
        axis.set_ylabel(label, fontsize=8)
    axes[-1].set_xlabel("turns of the membrane")
    energy = run.series["energy"][run.series["time"] >= rest]
    if len(energy) > 1:
        log.info(f"without flow the energy goes from {energy[0]:.6g} to {energy[-1]:.6g} in {len(energy)} steps; "
                 f"it rises in {(numpy.diff(energy) > 0).sum()}")


def turns(time, values, phase):
    """Returns means in time over whole turns of the phase. Rows with NaN, where a series is undefined, are left out."""
    ends = numpy.interp(360 * numpy.arange(phase.max() // 360 + 1), phase, time)
    return averages_between(time[~numpy.isnan(values)], values[~numpy.isnan(values)], ends)


def line(means, first):
    """Returns the change of the line through the means over all turns from `first` on, and its standard error."""
    number = numpy.arange(first, len(means))
    (slope, _), covariance = numpy.polyfit(number, means[first:], 1, cov=True)
    return slope * (len(number) - 1), covariance[0, 0] ** 0.5 * (len(number) - 1)


def flow_of(run):
    """Returns the times at which the flow begins to end and from which it rests; infinity if it does not rest."""
    amplitudes, times = (numpy.atleast_1d(run.value(f"Flow/history/{name}", [])) for name in ("amplitudes", "times"))
    on = numpy.flatnonzero(amplitudes)
    if len(on) and len(times) == len(amplitudes) and on[-1] + 1 < len(times):
        return times[on[-1]], times[on[-1] + 1]
    return numpy.inf, numpy.inf
