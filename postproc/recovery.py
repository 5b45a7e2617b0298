#!/usr/bin/python3
"""A red cell let go: drawn out by tweezers until its length is twice its width, it returns to its disc, as its membrane's viscosity allows. Length over
width against time, beside what was measured, and the time constant of the exponential that fits best, for several moduli and viscosities of the membrane.
"""

import argparse

import needs  # before what it looks for
import numpy

import style
import tanktread
from style import plt

# Hochmuth, Worthy & Evans, Biophys. J. 26, 1979: seconds, and length over width.
MEASURED = ((0, 2.005), (0.032, 1.732), (0.065, 1.525), (0.115, 1.367), (0.184, 1.247), (0.231, 1.197), (0.300, 1.157), (0.397, 1.112))
RADIUS, FLUID, INSIDE = 3.91, 1.2e-3, 5  # of the disc in um; Pa s outside; viscosity inside over that outside
MEMBRANES = ((5.3, 0.32), (4, 1.0), (10, 0.1))  # shear modulus in uN/m, viscosity in uN s/m: in use, and the slowest and fastest published


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("deck", nargs="?", default="inputs/red_cell_tweezers.yaml", help="lengths in radii of the disc (default: %(default)s)")
    parser.add_argument("--force", type=float, default=5.6, help="that draws it out, over shear modulus and radius (default: %(default)s)")
    parser.add_argument("--elements", type=int, default=6, help="elements per side (default: %(default)s)")
    parser.add_argument("-o", "--output", default="recovery.png", metavar="FILE", help="the picture (default: %(default)s)")
    arguments = parser.parse_args()

    figure, plot = plt.subplots(figsize=(5.2, 3.6))
    time, ratio = numpy.array(MEASURED).T
    print(f"measured: time constant {constant(time, ratio):.4f} s")
    for (modulus, viscosity), color in zip(MEMBRANES, style.RUNS):
        seconds, found = let_go(arguments, modulus, viscosity)
        print(f"{modulus:g} uN/m, {viscosity:g} uN s/m: time constant {constant(seconds, found):.4f} s, from a length over width of {found[0]:.3f}")
        plot.plot(seconds, found, color=color, label=f"{modulus:g} µN/m, {viscosity:g} µN s/m")
    plot.plot(time, ratio, style.MARKS[0], color=style.INK, markersize=4, label="Hochmuth and others 1979")
    plot.set_xlabel("time / s")
    plot.set_ylabel("length over width")
    plot.legend()
    style.save(figure, arguments.output)


def let_go(arguments, modulus, viscosity):
    """Seconds, and length over width from there on where it is what it was in the experiment at first."""
    pulled = {f"Membrane/forces/{name}/force": [sign * arguments.force, 0, 0] for name, sign in (("left", -1), ("right", 1))}
    mesh = {"Surface/elements per side": arguments.elements}
    start = tanktread.run(arguments.deck, pulled | mesh)
    unit = FLUID * RADIUS / modulus  # of time, in seconds: the deck's are fluid viscosity x radius / shear modulus
    free = {f"Membrane/forces/{name}/force": [0, 0, 0] for name in ("left", "right")}
    run = tanktread.run(arguments.deck, free | mesh | {
        "Particle/viscosity ratio": INSIDE, "Membrane/shear viscosity": viscosity / (FLUID * RADIUS), "Time/final time": 0.4 / unit,
        "Output/interval": 0.1 / unit, "Particle/initial shape/run": str(start.directory.resolve())})
    ratio = run.series["length_x1"] / run.series["length_x2"]
    seconds = run.series["time"] * unit
    first = numpy.interp(-MEASURED[0][1], -ratio, seconds)
    after = seconds >= first
    return seconds[after] - first, ratio[after]


def constant(seconds, ratio):
    """t_c of (ratio - 1) = (first - 1) exp(-t/t_c), by least squares over 0.4 s at even times."""
    times = numpy.linspace(0, min(0.397, seconds[-1]), 200)
    excess = numpy.interp(times, seconds, ratio) - 1
    best = numpy.geomspace(0.005, 1, 2000)
    return best[numpy.argmin([numpy.sum((excess - excess[0] * numpy.exp(-times / t)) ** 2) for t in best])]


if __name__ == "__main__":
    main()
