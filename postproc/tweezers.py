#!/usr/bin/python3
"""A red cell in optical tweezers: its diameters along and across the force, against the force, beside those that were measured; and its outline from the
side at each force. The deck is run once a force.
"""

import argparse

import needs  # before what it looks for
import numpy

import style
import tanktread
from style import plt

# Mills, Qie, Dao, Lim & Suresh, Mech. Chem. Biosyst. 1, 2004: force in pN, transverse and axial diameter in um, the axial one's bounds where known.
MEASURED = ((0, 7.74, 7.74, None), (16, 6.71, 9.16, (8.34, 9.99)), (47, 5.40, 11.34, (10.06, 12.75)), (88, 4.75, 13.03, (11.4, 14.7)),
            (151, 4.48, 14.55, (12.4, 16.7)), (193, 4.26, 15.26, (12.95, 17.65)))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("deck", nargs="?", default="inputs/red_cell_tweezers.yaml", help="lengths in radii of the disc (default: %(default)s)")
    parser.add_argument("--radius", type=float, default=3.91, help="of the disc, in um (default: %(default)s)")
    parser.add_argument("--shear-modulus", type=float, default=5.3, help="in uN/m (default: %(default)s)")
    parser.add_argument("--law", action="append", default=[], metavar="LAW", help="another law of the membrane to lay beside (may be repeated)")
    parser.add_argument("-o", "--output", default="tweezers.png", metavar="FILE", help="the picture (default: %(default)s)")
    arguments = parser.parse_args()

    figure, (plot, outlines) = plt.subplots(1, 2, figsize=(8.2, 3.6), width_ratios=(1.2, 1))
    for law, color in zip([None] + arguments.law, style.RUNS):
        runs = [at_force(arguments, pn, law) for pn, *_ in MEASURED]
        sizes = arguments.radius * numpy.array([[run.series["length_x2"][-1], run.series["length_x1"][-1]] for run in runs])
        report(law, sizes)
        forces = [row[0] for row in MEASURED]
        plot.plot(forces, sizes[:, 1], color=color, label=f"{law or runs[0].value('Membrane/law')}, along")
        plot.plot(forces, sizes[:, 0], color=color, linestyle=(0, (4, 2)), label="across")
        if law is None:
            draw_outlines(outlines, runs, arguments.radius)
    draw_measured(plot)
    plot.set_xlabel("force / pN")
    plot.set_ylabel("diameter / µm")
    plot.legend()
    style.save(figure, arguments.output)


def at_force(arguments, pn, law):
    force = pn / (arguments.radius * arguments.shear_modulus)
    settings = {f"Membrane/forces/{name}/force": [sign * force, 0, 0] for name, sign in (("left", -1), ("right", 1))}
    if law:
        settings["Membrane/law"] = law
    return tanktread.run(arguments.deck, settings)


def report(law, sizes):
    for (pn, across, along, bounds), (found_across, found_along) in zip(MEASURED, sizes):
        within = "" if bounds is None else ", within its bar" if bounds[0] <= found_along <= bounds[1] else ", OUTSIDE its bar"
        print(f"{law or ''}{pn:4d} pN: along {found_along:.2f} um (measured {along}{within}), across {found_across:.2f} um (measured {across})")


def draw_measured(plot):
    forces = numpy.array([row[0] for row in MEASURED])
    along = numpy.array([row[2] for row in MEASURED])
    low, high = (numpy.array([row[2] if row[3] is None else row[3][k] for row in MEASURED]) for k in (0, 1))
    plot.errorbar(forces, along, (along - low, high - along), fmt=style.MARKS[0], color=style.INK, markersize=4, linewidth=0.8, capsize=2,
                  label="Mills and others 2004")
    plot.plot(forces, [row[1] for row in MEASURED], style.MARKS[1], color=style.INK, markersize=4, fillstyle="none", label="across, measured")


def draw_outlines(plot, runs, radius):
    """The convex outlines as seen along x3, one a force."""
    for (pn, *_), run, shade in zip(MEASURED, runs, numpy.linspace(0.25, 1, len(runs))):
        points = numpy.asarray(run.snapshots()[-1].points)[:, :2] * radius
        around = numpy.linspace(0, 2 * numpy.pi, 361)
        directions = numpy.stack([numpy.cos(around), numpy.sin(around)])
        outline = points[(points @ directions).argmax(axis=0)]
        plot.plot(*outline.T, color=plt.get_cmap(style.TIME)(shade), linewidth=1.1, label=f"{pn} pN")
    plot.set_aspect("equal")
    plot.set_xlabel("x$_1$ / µm")
    plot.set_ylabel("x$_2$ / µm")
    plot.legend(fontsize=7, ncols=3, loc="lower center", bbox_to_anchor=(0.5, 1))


if __name__ == "__main__":
    main()
