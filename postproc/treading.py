#!/usr/bin/python3
"""A red cell that treads in shear: its frequency over the shear rate and its inclination, means of the last whole turn, against the shear rate, beside
those that were measured. The deck is run once a shear rate and viscosity of the membrane, to 50 over the rate.
"""

import argparse

import needs  # before what it looks for
import numpy

import style
import tanktread
from style import plt

# Tran-Son-Tay, Sutera & Rao, Biophys. J. 46, 1984, tables 1 and 2: shear rate in 1/s, angular frequency and its bar in radians a second.
MEASURED = ((28.6, 6.22, 0.31), (42.9, 9.42, 0.57), (57.1, 12.7, 0.57), (114.3, 24.6, 1.07), (171.4, 37.4, 1.45))
INCLINATION = (12.5, 13.2)  # degrees, of all of them


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("deck", nargs="?", default="inputs/red_cell_treading.yaml", help="with units (default: %(default)s)")
    parser.add_argument("--viscosity", action="append", default=[], type=float, metavar="UN_S_M",
                        help="of the membrane, in uN s/m (may be repeated; default: 0.1, 0.32 and 1)")
    parser.add_argument("--elements", type=int, default=6, help="elements per side (default: %(default)s)")
    parser.add_argument("-o", "--output", default="treading.png", metavar="FILE", help="the picture (default: %(default)s)")
    arguments = parser.parse_args()

    figure, (plot, angles) = plt.subplots(1, 2, figsize=(8.2, 3.4))
    rates = numpy.array([row[0] for row in MEASURED])
    viscosities = sorted(arguments.viscosity or [0.1, 0.32, 1.0])
    for viscosity, color in zip(viscosities, style.RUNS):
        turns = numpy.array([at_rate(arguments, rate, viscosity) for rate in rates])
        label = f"{viscosity:g} µN s/m"
        plot.plot(rates, turns[:, 0] / rates, "o-", markersize=3, color=color, label=label)
        angles.plot(rates, turns[:, 1], "o-", markersize=3, color=color, label=label)
        angles.fill_between(rates, turns[:, 2], turns[:, 3], color=color, alpha=0.12, linewidth=0)
        for (rate, frequency, bar), (here, mean, low, high) in zip(MEASURED, turns):
            within = "within its bar" if abs(here - frequency) <= bar else "OUTSIDE its bar"
            print(f"{viscosity:g} uN s/m, {rate} 1/s: frequency {here:.3f} 1/s (measured {frequency} +- {bar}, {within}), inclination {mean:.2f} "
                  f"({low:.2f} to {high:.2f})")
    plot.errorbar(rates, [row[1] / row[0] for row in MEASURED], [row[2] / row[0] for row in MEASURED], fmt=style.MARKS[1], color=style.INK, markersize=4,
                  linewidth=0.8, capsize=2, label="Tran-Son-Tay and others 1984")
    angles.axhspan(*INCLINATION, color=style.FAINT, alpha=0.4, label="measured")
    plot.set_ylabel("frequency / shear rate")
    angles.set_ylabel("inclination / degrees")
    for axes in plot, angles:
        axes.set_xlabel("shear rate / s$^{-1}$")
        axes.legend()
    style.save(figure, arguments.output)


def at_rate(arguments, rate, viscosity):
    """Frequency in radians a second, and mean, least and largest inclination, of the last whole turn."""
    end = 50 / rate
    settings = {"Flow/shear rate": f"{rate} 1/s", "Time/final time": end, "Output/interval": end, "Membrane/shear viscosity": f"{viscosity}e-6 N s/m",
                "Surface/elements per side": arguments.elements}
    run = tanktread.run(arguments.deck, settings)
    time, phase, inclination = (run.series[name] for name in ("time", "phase", "inclination"))
    begin = numpy.interp(phase[-1] - 360, phase, time)
    times = numpy.linspace(begin, time[-1], 401)
    defined = ~numpy.isnan(inclination)
    around = numpy.interp(times, time[defined], inclination[defined])
    return 2 * numpy.pi / (time[-1] - begin), around.mean(), around.min(), around.max()


if __name__ == "__main__":
    main()
