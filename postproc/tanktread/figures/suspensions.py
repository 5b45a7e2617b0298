"""Figures of pairs of particles, particles next to a wall, suspensions, and the drift over many revolutions of a
membrane."""

import pathlib

import numpy

from .. import tables
from ..interpolation import averages_between
from ..mistakes import expect, log
from ..results import time_label
from ..runs import Study
from ..snapshots import evenly
from ..studies.sweep import Sweep
from . import style
from .draw import draw_pieces, section
from .register import figure
from .scene import wall

SYMBOLS = {"relative_viscosity": "μ_eff/μ", "normal_stress_difference_1": "N₁", "normal_stress_difference_2": "N₂"}
DRIFTS = {"area": "area / first value − 1", "volume_error": "V / V$_0$ − 1", "energy": "energy / mean − 1",
          "taylor_inertia": "D", "inclination": "inclination / degrees"}
CA = "Particles/capsule/Membrane/capillary number"


@figure(3, 1, 6.4, 8, sharex=True)
def encounter(runs, path, gap, deformation, *, pair: tuple[str, str] | None = None, curve: pathlib.Path | None = None):
    """Two particles that pass each other: their relative path, the smallest gap, and their Taylor parameters D.

    All panels are functions of dx. dx and dz are the components along x1 and x3 of the vector from the centroid of the
    second particle to that of the first one, divided by R_C (radius of the sphere with the volume of a particle).

    pair: names of the two particles (default: the first two)
    curve: file of a published path: CSV with the columns dx and dz, divided by R_C"""
    for run, color in style.coloured(runs):
        names = pair or run.particles[:2]
        expect(len(names) == 2, f"{run.directory}: an encounter is of two particles, and this run has one")
        dx, dz = (numpy.subtract(*[run.of(name, f"centroid_x{k}") for name in names]) / run.radius for k in (1, 3))
        path.plot(dx, dz, color=color, label=run.name)
        smallest = run.series["smallest_gap"] / run.radius
        pairs = numpy.column_stack([run.series["first_of_gap"], run.series["second_of_gap"]])
        others = pairs != sorted(1 + run.particles.index(name) for name in names)
        smallest[others.any(axis=1)] = numpy.nan
        why = ": choose another --pair" if len(run.particles) > 2 else ", but that of a periodic image"
        expect(not numpy.isnan(smallest).all(),
               f"{run.directory}: the smallest gap is never that of {' and '.join(names)}{why}")
        gap.plot(dx, smallest, color=color)
        for name, line in zip(names, ("-", style.DASHES)):
            if f"{name}/taylor_inertia" in run.series:  # it is not rigid
                label = name if run is runs[0] else None
                deformation.plot(dx, run.of(name, "taylor_inertia"), color=color, linestyle=line, label=label)
        least = numpy.nanargmin(smallest)
        log.info(f"{run.name}: smallest gap {smallest[least]:.5f} R_C at dx = {dx[least]:.3f}, "
                 f"largest dz {dz.max():.5f}")
    if curve:
        known = tables.read(curve, ("dx", "value")).values.T
        path.plot(*known, style.MARKS[0], color=style.FAINT, markersize=3.5, label="literature")
    style.finish(path, ylabel="dz / R$_C$")
    gap.set(ylabel="smallest gap / R$_C$", ylim=(0, None))
    deformation.set(xlabel="dx / R$_C$", ylabel="D")
    if deformation.lines:
        deformation.legend()
    else:  # both particles are rigid
        deformation.remove()
        gap.set(xlabel="dx / R$_C$")
        gap.tick_params(labelbottom=True)


@figure()
def plane_wall(runs, axes=None, *, times: int = 5, curve: pathlib.Path | None = None):
    """Particles near a plane wall: sections at several times, the gap, and the velocities away from and along the wall.

    The gap is divided by R_C (radius of the sphere with the particle's volume). The velocity is that of the centroid.

    times: number of times that are drawn
    curve: file of a reference for the gap over time: CSV with two columns in the units of the figure"""
    for run in runs:
        wall(run)  # states if there is none
        run.expect_one_particle()
    figure = style.canvas(axes, 7.2, 2.6 * len(runs) + 2.8)
    grid = figure.add_gridspec(len(runs) + 1, 2, height_ratios=[1] * len(runs) + [1.1])
    gap, speed = (figure.add_subplot(grid[-1, k]) for k in (0, 1))
    for k, (run, color) in enumerate(style.coloured(runs)):
        film = run.series["gap"] / run.radius
        sections(figure.add_subplot(grid[k, :]), run, times)
        gap.plot(run.time, film, color=color, label=run.name)
        velocity = numpy.array([run.series[f"velocity_x{i}"] for i in (1, 2, 3)]) / run.scale("velocity")[0]
        away, along = (direction @ velocity for direction in wall(run)[1:])
        speed.plot(run.time, away, color=color, label=None if k else "away")
        speed.plot(run.time, along, color=color, linestyle=style.DASHES, label=None if k else "along")
        log.info(f"{run.name}: gap from {film[0]:.6g} to {film[-1]:.6g} R_C; "
                 f"velocity away from the wall {away[-1]:.5g}, along it {along[-1]:.5g}")
    if curve:
        known = tables.read(curve, ("time", "value")).values.T
        gap.plot(*known, style.MARKS[0], color=style.INK, markersize=3, label="reference")
    speed.axhline(0, color=style.FAINT, linewidth=0.8)
    low, high = gap.get_ylim()
    style.finish(gap, yscale="log" if high > 3 * low > 0 else "linear", xlabel=time_label(runs), ylabel="gap / R$_C$")
    style.finish(speed, xlabel=time_label(runs), ylabel=runs[0].label("velocity"))
    return figure


def sections(axis, run, moments):
    """Draws sections through the particle at several times, in the plane of the wall's normal and the vector along the
    wall (see `wall`)."""
    point, normal, along = wall(run)
    across = numpy.argmin(abs(normal) + abs(along))
    point, along, normal = numpy.delete([point, along, normal], across, axis=1)  # in the section plane
    for shot, colour in style.shaded(evenly(run.snapshots(), moments), 0.15, 0.95):
        pieces = section(shot, shot.points[:, across].mean(), across) - point
        draw_pieces(axis, pieces @ numpy.transpose([along, normal]) / run.radius, colour, ends="butt")
        axis.plot([], [], color=colour, label=f"{shot.time * run.rate[0]:.3g}")
    distance = run.value("Wall/distance", 0) / run.radius  # of the second wall
    for low in [-0.15] + [distance] * (distance > 0):
        axis.axhspan(low, low + 0.15, color=style.FAINT, alpha=0.5, linewidth=0)
    axis.autoscale_view()
    axis.set(ylim=(-0.15, distance + 0.15 if distance else None), aspect="equal",
             title=f"{run.name}: section normal to the wall at several times",
             xlabel="along the wall / R$_C$", ylabel="above the wall / R$_C$")
    axis.legend(ncols=2, fontsize=7, loc="center left", bbox_to_anchor=(1, 0.5))


@figure(2, 1, 6.4, 6.4, sharex=True)
def rheology(runs, upper, lower):
    """Intrinsic viscosity and normal stress differences of a dilute suspension in simple shear, over time.

    They follow from the stresslet S of a particle of volume V, or of all particles with the total volume V:
    [η] = S_13/(μ γ̇ V), N1 = (S_11 − S_33)/(μ γ̇ V) and N2 = (S_33 − S_22)/(μ γ̇ V). The flow is along x1 and its
    gradient along x3. γ̇ is the shear rate, and μ is the viscosity of the outer fluid. The normal stress differences of
    a dilute suspension are N1 and N2 times μ γ̇ φ, where φ is the volume fraction of the particles. A rigid sphere has
    [η] = 5/2."""
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
    """Returns the dimensionless intrinsic viscosity [η] and normal stress differences N1 and N2, each (rows,)."""
    flow = run.value("Flow/type")
    expect(flow == "simple shear", f"{run.directory}: intrinsic viscosity is of simple shear, and this is {flow}")
    expect(run.value("Flow/history") is None, f"{run.directory}: the flow changes in time; see its intrinsic_viscosity")
    volume = run.snapshot_at(0).volume(48) if run.several else 4 / 3 * numpy.pi * run.radius**3
    if all((f"{name}/volume" if run.several else "volume") in run.series for name in run.particles):
        volume = sum(run.of(name, "volume")[0] for name in run.particles)
    unit = run.value("Flow/viscosity", 1) * run.rate[0] * volume
    s11, s22, s33, s13 = (run.series[f"stresslet_{k}"] / unit for k in ("11", "22", "33", "13"))
    return s13, s11 - s33, s33 - s22


@figure(2, 1, 6.4, 6.4, sharex=True)
def suspension(runs, upper, lower, *, from_: float = 1, blocks: int = 8):
    """Effective viscosity and normal stress differences of a periodic suspension against strain, with their averages.

    Dotted lines are averages over the strain. They are printed with standard errors: the strain is divided into equal
    blocks, and the standard error is the standard deviation of the block averages divided by the square root of the
    number of blocks.

    from_: strain at which averages begin
    blocks: number of blocks for the standard errors"""
    for run, color in style.coloured(runs):
        expect("Domain" in run.deck, f"{run.directory} is no suspension: its deck has no Domain")
        expect(SYMBOLS.keys() <= run.series.keys(), f"{run.directory} has no effective viscosity, because it has walls "
               "or posts: see its series mean_velocity_x1, wall_force_x1, post_force_x1, disturbed_pressure_drop")
        strain, words, label = run.time, [], f"{run.name}, φ = {run.series['volume_fraction'][0]:.3g}"
        for (name, symbol), axis, line in zip(SYMBOLS.items(), (upper, lower, lower), ("-", "-", "--")):
            axis.plot(strain, run.series[name], color=color, linestyle=line,
                      label=label if axis is upper else symbol if run is runs[0] else None)
            if strain[-1] > from_:
                mean, error = average(strain, run.series[name], from_, blocks)
                axis.plot([from_, strain[-1]], [mean, mean], color=color, linewidth=0.8, linestyle=":")
                words.append(f"{symbol} = {mean:.5f} ± {error:.5f}")
        log.info(f"{run.name}, strain {from_:g} to {strain[-1]:g}: {', '.join(words)}" if words else
                 f"{run.name} ends at strain {strain[-1]:g}, not after --from {from_:g}: it has no averages")
    style.finish(upper, ylabel="effective viscosity μ_eff/μ")
    lower.axhline(0, color=style.FAINT, linewidth=0.8)
    stress = runs[0].unit(runs[0].units["normal_stress_difference_1"])
    style.finish(lower, ylabel="normal stress differences" + stress, xlabel="strain")


def average(strain, values, first, blocks):
    """Returns the mean of values(strain) from the strain `first` on, by the trapezoidal rule, and its standard error,
    from the means over `blocks` equal parts. The last strain must exceed `first`."""
    expect(blocks > 1, f"--blocks must be at least 2, but is {blocks}")
    means = averages_between(strain, values, numpy.linspace(first, strain[-1], blocks + 1))
    return means.mean(), means.std(ddof=1) / numpy.sqrt(blocks)


@figure(2, 1, 6.4, 7.2, sharex=True)
def viscosity(study, upper, lower, *, single: str = "inputs/shear_neo_hookean.yaml", from_: float = 4, blocks: int = 4,
              jobs: int = 1):
    """Relative viscosity of a sheared suspension against its volume fraction, with standard errors.

    There is one curve for each capillary number. The runs are those of a sweep and are kept in results/<study>. The
    lower panel shows (μ_eff/μ − 1)/φ, where μ_eff/μ is the relative viscosity and φ the volume fraction. Its value at
    φ = 0 is the intrinsic viscosity of a single capsule. The dotted lines of the upper panel are this dilute limit.
    Standard errors come from averages over blocks of the strain. They do not include the effect of other initial
    positions or of more particles in the periodic cell.

    single: deck of a single capsule
    from_: strain at which averages begin
    blocks: number of blocks for the standard errors
    jobs: number of simultaneous runs"""
    directory = pathlib.Path("results") / pathlib.Path(study).stem
    made = Study(directory=directory / "runs", jobs=jobs)
    runs = Sweep(study, made)
    expect(all(CA in row for row in runs.rows), f"{study} varies or sets no {CA}")
    runs.make(directory)
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
        if len(fraction) > 2 and numpy.all((error > 0) & numpy.isfinite(error)):
            (_, limit), covariance = numpy.polyfit(fraction, slope, 1, w=fraction / error, cov="unscaled")
            log.info(f"  per volume fraction, extrapolated to 0: {limit:.3f} ± {covariance[1, 1] ** 0.5:.3f}; "
                     f"one capsule: {alone:.4f}")
    style.finish(upper, ylabel="relative viscosity μ_eff/μ")
    lower.set(ylabel="(μ_eff/μ − 1)/φ; φ = 0: one capsule", xlabel="volume fraction φ", xlim=(-0.005, None))


def averages(outcome, first, blocks):
    """Returns the volume fraction, and the mean relative viscosity with its standard error, of a run. Returns None if
    the run failed or ended before the strain `first`."""
    if not outcome.done:
        log.info(f"left out: {outcome.message.removeprefix('tanktread: ')}")
        return None
    name, series, strain = outcome.directory.name, outcome.series, outcome.run.time
    if strain[-1] <= first:
        log.info(f"left out: {name} ends at strain {strain[-1]:g}, not after --from {first:g}")
        return None
    fraction, impulse = series["volume_fraction"][0], series["contact_impulse"][-1]
    if impulse > 0:
        log.info(f"{name}, φ = {fraction:.3g}: the limiter's impulse is {impulse:.3g}")
    return fraction, *average(strain, series["relative_viscosity"], first, blocks)


@figure(len(DRIFTS), 1, 6.4, 7.6, sharex=True)
def drift(run, *axes, from_: int = 10):
    """Drift in a run over many revolutions of the membrane: series, and their average over each revolution.

    A revolution is 360 degrees of the series `phase`. A straight line is fitted to the averages, from the revolution
    --from on. The change along this line is printed with its standard error. If the amplitude of the flow
    (Flow/history) ends at 0, the steps after that in which the energy rises are counted.

    from_: first revolution of the straight line"""
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
    axes[-1].set_xlabel("revolutions of the membrane")
    energy = run.series["energy"][run.series["time"] >= rest]
    if len(energy) > 1:
        log.info(f"without flow the energy goes from {energy[0]:.6g} to {energy[-1]:.6g} in {len(energy)} steps; "
                 f"it rises in {(numpy.diff(energy) > 0).sum()}")


def turns(time, values, phase):
    """Returns the time average over each full revolution (360 degrees of `phase`). NaN values are left out."""
    ends = numpy.interp(360 * numpy.arange(phase.max() // 360 + 1), phase, time)
    return averages_between(time[~numpy.isnan(values)], values[~numpy.isnan(values)], ends)


def line(means, first):
    """Fits a straight line to the means of the revolutions from `first` on. Returns its change over all of them, and
    the standard error of this change."""
    number = numpy.arange(first, len(means))
    (slope, _), covariance = numpy.polyfit(number, means[first:], 1, cov=True)
    return slope * (len(number) - 1), covariance[0, 0] ** 0.5 * (len(number) - 1)


def flow_of(run):
    """Returns the last time of Flow/history with a non-zero amplitude, and the next time, from which the amplitude is
    0. Both are infinite if the history does not end at zero amplitude."""
    amplitudes, times = (numpy.atleast_1d(run.value(f"Flow/history/{name}", [])) for name in ("amplitudes", "times"))
    on = numpy.flatnonzero(amplitudes)
    if len(on) and len(times) == len(amplitudes) and on[-1] + 1 < len(times):
        return times[on[-1]], times[on[-1] + 1]
    return numpy.inf, numpy.inf
