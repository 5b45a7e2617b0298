#!/usr/bin/python3
"""Deformation and inclination over time, beside the curves of the literature; of each of several particles that deforms, without these."""

import argparse
import sys

import needs  # before what it looks for
import numpy

import literature
import style
import tanktread
from style import plt

EXPECTED = "expected by the deck"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("results", nargs="+", help="directories of runs' results, or decks, which are run when they have none")
    parser.add_argument("-o", "--output", default="deformation.png", metavar="FILE", help="the picture (default: %(default)s)")
    parser.add_argument("--curves", metavar="DIR", help="folder of literature curves, named as postproc/literature.py says (default: none)")
    parser.add_argument("--deformation", default="taylor_inertia", choices=["taylor_inertia", "taylor_surface"], help="which Taylor parameter")
    arguments = parser.parse_args()

    runs = [tanktread.run(directory) for directory in arguments.results]
    for run in runs:
        if not run.particles:
            run.require("taylor_inertia", "taylor_surface", "inclination")
    figure, (upper, lower) = plt.subplots(2, 1, figsize=(6.4 if len(runs) == 1 else 9.8, 6.4), sharex=True, height_ratios=[3, 2])
    known = []
    for run in runs:
        known += [curve for curve in literature.curves(run, arguments.curves) if curve.label not in [one.label for one in known]]
    for run, color in zip(runs, style.RUNS * len(runs)):
        if run.particles:
            draw_particles(upper, lower, run, arguments.deformation, style.RUNS if len(runs) == 1 else [color])
            continue
        draw_run(upper, lower, run, arguments.deformation, color)
        report(run, literature.curves(run, arguments.curves))
    draw_literature(upper, lower, known, end=max(run.time[-1] for run in runs))

    upper.set_ylabel("Taylor parameter D" if arguments.deformation == "taylor_inertia" else "Taylor parameter D (surface)")
    upper.set_ylim(bottom=0)
    upper.set_title(title(runs))
    upper.legend(loc="lower right") if len(runs) == 1 else upper.legend(loc="upper left", bbox_to_anchor=(1.01, 1))
    lower.set_ylabel("inclination, degrees")
    lower.set_xlabel(tanktread.time_label(runs))
    lower.set_xlim(left=0)
    style.save(figure, arguments.output)


def title(runs):
    words = [" and ".join(dict.fromkeys(str(run.value(key)) for run in runs if run.value(key))) for key in ("Membrane/law", "Flow/type")]
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
    lower.plot(*unbroken(t, run.series["inclination"]), color=color, zorder=3)
    for axes, name in (upper, deformation), (lower, "inclination"):
        expected = run.value(f"Expect/{name}")
        if expected:
            at = expected["at"] * run.rate[0] if "at" in expected else t[-1]
            known = {text.get_label() for text in axes.lines}
            axes.plot(at, expected["value"], "x", color=style.INK, ms=7, mew=1.4, zorder=6, label=EXPECTED if EXPECTED not in known else None)


def draw_particles(upper, lower, run, deformation, colors):
    """The same of several, thin where they are many."""
    deforming = [name for name in run.particles if f"{name}/{deformation}" in run.series]
    if not deforming:
        sys.exit(f"{run.directory}: none of its particles deforms")
    few = len(deforming) <= len(style.RUNS)
    for k, name in enumerate(deforming):
        pen = {"color": colors[k % len(colors)] if few else colors[0], "linewidth": 1.8 if few else 0.5, "zorder": 3}
        words = f"{run.name}: {name}" if few else f"{run.name}: {len(deforming)} particles" if k == 0 else None
        upper.plot(run.time, run.series[f"{name}/{deformation}"], label=words, **pen)
        lower.plot(*unbroken(run.time, run.series[f"{name}/inclination"]), **pen)


def unbroken(t, angle):
    """Times and angles with a gap where an axis, which has no direction, passes from one end of its range of 180 degrees to the other."""
    passes = numpy.flatnonzero(numpy.abs(numpy.diff(angle)) > 90) + 1
    return numpy.insert(t, passes, numpy.nan), numpy.insert(angle, passes, numpy.nan)


def draw_literature(upper, lower, known, end):
    marks = iter(style.MARKS)
    for curve in known:
        inside = curve.t <= end * 1.001
        if curve.exact:
            pen = {"color": style.INK, "linestyle": (0, (1, 1.6)), "linewidth": 2.2, "zorder": 5}
            upper.plot(curve.t, curve.d, label=curve.label, **pen)
            lower.plot(curve.t, curve.inclination, **pen)
            continue
        every = max(1, inside.sum() // 40)
        pen = {"linestyle": "none", "marker": next(marks), "ms": 3.6, "mfc": "none", "mec": style.FAINT, "mew": 0.8, "zorder": 2, "markevery": every}
        upper.plot(curve.t[inside], curve.d[inside], label=curve.label, **pen)
        if curve.inclination is not None:
            formed = inside & (curve.t > 0.05)
            lower.plot(curve.t[formed], curve.inclination[formed], **pen)


def report(run, known):
    t = run.time
    for curve in known:
        if not curve.exact:
            continue
        d = literature.difference(t, run.series["taylor_inertia"], curve.t, curve.d)
        angle = literature.difference(t, run.series["inclination"], curve.t, curve.inclination)
        print(f"{run.name}: largest difference from the {curve.label}: {d:.2e} in D, {angle:.2e} degrees")


if __name__ == "__main__":
    main()
