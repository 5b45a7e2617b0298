"""Figures that compare red cells with experiments."""

import pathlib

import numpy

from ..files import parsed
from ..mistakes import log
from ..runs import run as run_of
from . import style
from .register import figure

MEASURED = parsed(pathlib.Path(__file__).with_name("red_cells.yaml"))
RADIUS, FLUID, INSIDE = 3.91, 1.2e-3, 5  # radius of the disc in um; viscosity of the plasma in Pa s; viscosity ratio
DRAWN = 5.6  # force of the tweezers before the release, divided by shear modulus and radius
# (shear modulus in uN/m, surface viscosity in uN s/m): usual values, then values for the slowest and fastest recovery
MEMBRANES = ((5.3, 0.32), (4, 1.0), (10, 0.1))
BAR = {"color": style.INK, "markersize": 4, "linewidth": 0.8, "capsize": 2}  # style of measured values


@figure(1, 2, 8.2, 3.6, width_ratios=(1.2, 1))
def tweezers(deck="inputs/red_cell_tweezers.yaml", plot=None, outlines=None, *, shear_modulus: float = 5.3):
    """A red cell in optical tweezers: its diameters along and across the force, compared with measurements.

    The right panel shows the outline of the cell at each force. The deck is run once for each force of the
    measurements. The unit of length of the deck must be the radius of the undeformed cell.

    shear_modulus: shear modulus of the membrane, in uN/m"""
    runs = [pulled(deck, row[0] / (RADIUS * shear_modulus), {}) for row in MEASURED["stretched"]]
    across, along = RADIUS * numpy.array([[run.series[f"length_x{k}"][-1] for run in runs] for k in (2, 1)])
    for (pn, narrow, wide, low, high), here_across, here_along in zip(MEASURED["stretched"], across, along):
        within = f", {'within' if low <= here_along <= high else 'OUTSIDE'} its bar" if low < high else ""
        log.info(f"{pn:4d} pN: along {here_along:.2f} um (measured {wide}{within}), "
                 f"across {here_across:.2f} um (measured {narrow})")
    forces, narrow, wide, low, high = numpy.transpose(MEASURED["stretched"])
    plot.plot(forces, along, color=style.RUNS[0], label=f"{runs[0].value('Membrane/law')}, along the force")
    plot.plot(forces, across, color=style.RUNS[0], linestyle=style.DASHES, label="across the force")
    around = numpy.linspace(0, 2 * numpy.pi, 361)
    for (pn, *_), (run, color) in zip(MEASURED["stretched"], style.shaded(runs, 0.25)):  # hull, seen along x3
        points = run.snapshots()[-1].points[:, :2] * RADIUS
        outline = points[(points @ [numpy.cos(around), numpy.sin(around)]).argmax(axis=0)]
        outlines.plot(*outline.T, color=color, linewidth=1.1, label=f"{pn} pN")
    outlines.set(aspect="equal", xlabel="x$_1$ / µm", ylabel="x$_2$ / µm")
    outlines.legend(fontsize=7, ncols=3, loc="lower center", bbox_to_anchor=(0.5, 1))
    plot.errorbar(forces, wide, (wide - low, high - wide), fmt=style.MARKS[0], label="along, Mills et al. 2004", **BAR)
    plot.plot(forces, narrow, style.MARKS[1], color=style.INK, markersize=4, fillstyle="none",
              label="across, Mills et al. 2004")
    style.finish(plot, xlabel="force / pN", ylabel="diameter / µm")


def pulled(deck, force, more):
    """Returns the run of a deck in which forces along x1 pull both ends of the cell apart. `force`: force divided by
    shear modulus and radius of the disc. `more`: further settings."""
    ends = {"left": -force, "right": force}
    return run_of(deck, {f"Membrane/forces/{name}/force": [pull, 0, 0] for name, pull in ends.items()} | more)


@figure(1, 2, 8.2, 3.4)
def treading(deck="inputs/red_cell_treading.yaml", plot=None, angles=None, *,
             viscosity: list[float] = [0.1, 0.32, 1.0], elements: int = 6):
    """A tank-treading red cell in shear: frequency and inclination against the shear rate, compared with measurements.

    The frequency and the mean inclination are those of the last full revolution of the membrane. Bands show the range
    of the inclination in this revolution. The deck must have units. It is run for each measured shear rate and each
    surface viscosity of the membrane, to the time 50 / shear rate.

    viscosity: surface viscosities of the membrane, in uN s/m
    elements: elements per side"""
    rates, frequencies, bars = numpy.transpose(MEASURED["treading"])
    for value, color in style.coloured(sorted(viscosity)):
        found = [last_turn(deck, rate, value, elements) for rate in rates]
        turning, angle, least, largest = numpy.transpose(found)
        pen = {"color": color, "markersize": 3, "label": f"viscosity {value:g} µN s/m"}
        plot.plot(rates, turning / rates, "o-", **pen)
        angles.plot(rates, angle, "o-", **pen)
        angles.fill_between(rates, least, largest, color=color, alpha=0.12, linewidth=0)
        for (rate, frequency, bar), (here, mean, low, high) in zip(MEASURED["treading"], found):
            within = "within" if abs(here - frequency) <= bar else "OUTSIDE"
            log.info(f"{value:g} uN s/m, {rate} 1/s: frequency {here:.3f} 1/s (measured {frequency} +- {bar}, {within} "
                     f"its bar), inclination {mean:.2f} ({low:.2f} to {high:.2f})")
    plot.errorbar(rates, frequencies / rates, bars / rates, fmt=style.MARKS[1], label="Tran-Son-Tay et al. 1984", **BAR)
    angles.axhspan(*MEASURED["inclination"], color=style.FAINT, alpha=0.4, label="measured")
    style.finish(plot, xlabel="shear rate / s$^{-1}$", ylabel="angular frequency / shear rate")
    style.finish(angles, xlabel="shear rate / s$^{-1}$", ylabel="inclination / degrees")


def last_turn(deck, rate, viscosity, elements):
    """Returns the tank-treading frequency in radians per second, and the mean, smallest and largest inclination in
    degrees, over the last full revolution of the membrane."""
    end = 50 / rate
    run = run_of(deck, {"Flow/shear rate": f"{rate} 1/s", "Time/final time": end, "Output/interval": end,
                        "Membrane/shear viscosity": f"{viscosity}e-6 N s/m", "Surface/elements per side": elements})
    time, phase = run.series["time"], run.series["phase"]
    begin = numpy.interp(phase[-1] - 360, phase, time)
    around = numpy.interp(numpy.linspace(begin, time[-1], 401), *run.defined("inclination"))
    return 2 * numpy.pi / (time[-1] - begin), around.mean(), around.min(), around.max()


@figure(1, 1, 5.2, 3.6)
def recovery(deck="inputs/red_cell_tweezers.yaml", plot=None, *, elements: int = 6):
    """A red cell that is released by optical tweezers and returns to its resting shape, compared with an experiment.

    The figure shows the length of the cell divided by its width over time, for several shear moduli and surface
    viscosities of the membrane. At time 0 this ratio equals the first measured value, 2.0. The time constant of the
    best-fitting exponential is printed for each curve. The unit of length of the deck must be the radius of the
    undeformed cell.

    elements: elements per side"""
    time, ratio = numpy.array(MEASURED["recovery"]).T
    log.info(f"measured: time constant {constant(time, ratio):.4f} s")
    for (modulus, viscosity), color in zip(MEMBRANES, style.RUNS):
        seconds, found = let_go(deck, elements, modulus, viscosity)
        log.info(f"{modulus:g} uN/m, {viscosity:g} uN s/m: time constant {constant(seconds, found):.4f} s, "
                 f"from a length over width of {found[0]:.3f}")
        plot.plot(seconds, found, color=color, label=f"{modulus:g} µN/m, {viscosity:g} µN s/m")
    plot.plot(time, ratio, style.MARKS[0], color=style.INK, markersize=4, label="Hochmuth et al. 1979")
    style.finish(plot, xlabel="time / s", ylabel="length / width")


def let_go(deck, elements, modulus, viscosity):
    """Runs the release of a stretched cell. Returns times in seconds and the ratio of length to width. Time 0 is when
    the ratio equals the first measured ratio."""
    mesh = {"Surface/elements per side": elements}
    start = pulled(deck, DRAWN, mesh).directory.resolve()
    unit = FLUID * RADIUS / modulus  # the deck's unit of time (fluid viscosity x radius / shear modulus) in seconds
    run = pulled(deck, 0, mesh | {"Particle/initial shape/run": str(start), "Particle/viscosity ratio": INSIDE,
                                  "Membrane/shear viscosity": viscosity / (FLUID * RADIUS),
                                  "Time/final time": 0.4 / unit, "Output/interval": 0.1 / unit})
    seconds, ratio = run.series["time"] * unit, run.series["length_x1"] / run.series["length_x2"]
    first = numpy.interp(-MEASURED["recovery"][0][1], -ratio, seconds)
    after = seconds >= first
    return seconds[after] - first, ratio[after]


def constant(seconds, ratio):
    """Returns the time constant t_c of ratio(t) - 1 = (ratio(0) - 1) exp(-t/t_c) in seconds, by a least-squares fit at
    200 uniformly spaced times in the first 0.4 s."""
    times = numpy.linspace(0, min(0.397, seconds[-1]), 200)
    excess = numpy.interp(times, seconds, ratio) - 1
    return min(numpy.geomspace(0.005, 1, 2000),
               key=lambda t: numpy.sum((excess - excess[0] * numpy.exp(-times / t)) ** 2))
