#!/usr/bin/python3
"""Relative viscosity of a sheared suspension against its volume fraction, with standard errors, a curve for each capillary number, from a sweep of runs that
are made once, resumed where they were broken off: results/<study>. Below what it is per volume fraction, (μ_eff/μ - 1)/φ, and at φ = 0 the intrinsic
viscosity of one capsule in the same shear and on the same mesh, to which the straight line through the rest should go.

    postproc/viscosity.py inputs/studies/suspension.yaml

Standard errors by blocks, as in suspension.py. They do not know what another start, or more particles in the cell, would change.
"""

import argparse
import pathlib

import needs  # before what it looks for
import numpy

import style
import sweep
import tanktread
from rheology import rheology
from style import plt
from suspension import average

CA = "Particles/capsule/Membrane/capillary number"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("study", help="a study of sweep.py over volume fractions and capillary numbers of particles called `capsule`")
    parser.add_argument("--single", default="inputs/shear_neo_hookean.yaml", metavar="DECK", help="of one of them (default: %(default)s)")
    parser.add_argument("--from", type=float, default=4, dest="first", metavar="STRAIN", help="where averages begin (default: %(default)s)")
    parser.add_argument("--blocks", type=int, default=4, help="of an average (default: %(default)s)")
    parser.add_argument("--jobs", type=int, default=1, help="runs at a time (default: %(default)s)")
    parser.add_argument("--output", type=pathlib.Path, metavar="DIR", help="of the picture, the table and, under runs/, of results (default: results/<study>)")
    arguments = parser.parse_args()

    directory = arguments.output or pathlib.Path("results") / pathlib.Path(arguments.study).stem
    directory.mkdir(parents=True, exist_ok=True)
    study = tanktread.Study(directory=directory / "runs", jobs=arguments.jobs)
    runs = sweep.Sweep(arguments.study, study)
    sweep.expect(all(CA in row for row in runs.rows), f"{arguments.study} varies or sets no {CA}")
    runs.make()
    runs.write(directory)
    rows = {}
    for outcome, settings in zip(runs.outcomes, runs.rows):
        if row := averages(outcome, arguments):
            rows.setdefault(settings[CA], []).append(row)
    figure, (upper, lower) = plt.subplots(2, 1, figsize=(6.4, 7.2), sharex=True)
    for (ca, found), color in zip(rows.items(), style.RUNS * len(rows)):
        alone = intrinsic(study, arguments, ca, next(one for one in runs.outcomes if one.done))
        fraction, mean, error = numpy.array(sorted(found)).T
        draw(upper, lower, color, f"Ca = {ca:g}", alone, fraction, mean, error)
        print(f"Ca = {ca:g}: " + ", ".join(f"{m:.4f} ± {e:.4f} at {f:.3g}" for f, m, e in zip(fraction, mean, error)))
        if len(fraction) > 2:
            slope, off = straight_line(fraction, (mean - 1) / fraction, error / fraction)
            print(f"  per volume fraction, extrapolated to 0: {slope:.3f} ± {off:.3f}; one capsule alone: {alone:.4f}")
    upper.set_ylabel("relative viscosity μ_eff/μ")
    upper.legend()
    lower.set_ylabel("(μ_eff/μ − 1)/φ; at 0: one capsule alone")
    lower.set_xlabel("volume fraction φ")
    lower.set_xlim(left=-0.005)
    style.save(figure, directory / "viscosity.png")


def averages(outcome, arguments):
    """Volume fraction, mean and standard error of a run that came to its end; what one that did not says is printed."""
    if not outcome.done:
        print(f"left out: {outcome.message.removeprefix('tanktread: ')}")
        return None
    series = outcome.series
    strain = outcome.run.time
    if strain[-1] <= arguments.first:
        print(f"left out: {outcome.directory.name} ends at strain {strain[-1]:g}, before --from {arguments.first:g}")
        return None
    if series["contact_impulse"][-1] > 0:
        print(f"{outcome.directory.name}, φ = {series['volume_fraction'][0]:.3g}: the limiter's impulse is {series['contact_impulse'][-1]:.3g}")
    return (series["volume_fraction"][0], *average(strain, series["relative_viscosity"], arguments.first, arguments.blocks))


def intrinsic(study, arguments, ca, one):
    """[η] of one capsule alone, on the mesh and to the strain of the suspension's."""
    deck = one.run.deck
    settings = {"Membrane/capillary number": ca, "Surface/elements per side": deck["Particles"]["capsule"]["Surface"]["elements per side"],
                "Time/final time": deck["Time"]["final time"]}
    one = study.run(arguments.single, settings)
    sweep.expect(one.done, f"one capsule alone at Ca = {ca:g}: {one.message}")
    return rheology(one.run)[0][-1]


def straight_line(x, y, error):
    """Its value at 0 and the standard error of that, from the errors of y."""
    table = numpy.column_stack([numpy.ones_like(x), x]) / error[:, None]
    covariance = numpy.linalg.inv(table.T @ table)
    return (covariance @ table.T @ (y / error))[0], covariance[0, 0] ** 0.5


def draw(upper, lower, color, label, alone, fraction, mean, error):
    look = {"color": color, "fmt": "o", "markersize": 4, "capsize": 2.5}
    upper.errorbar(fraction, mean, error, label=label, **look)
    upper.plot([0, fraction[-1]], [1, 1 + alone * fraction[-1]], color=color, linewidth=0.8, linestyle=":")
    lower.errorbar(fraction, (mean - 1) / fraction, error / fraction, **look)
    lower.plot(0, alone, "D", color=color, markersize=5, markerfacecolor="none", clip_on=False)


if __name__ == "__main__":
    sweep.answer(main)
