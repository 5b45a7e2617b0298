#!/usr/bin/python3
"""Rates of the leading mode along a branch of steady shapes, and the same from runs in time that start with that mode added to the shape.

    postproc/growth_rates.py inputs/drop_branch.yaml                         # runs under results/growth_rates; minutes
    postproc/growth_rates.py inputs/capsule_treading.yaml --series inclination --amplitude 0.02

The run has a list Spectrum, and Continuation or not. From each of its points but folds two runs go on in time, the mode added with one sign and
the other; their difference grows or decays at the mode's rate, which is fitted to the later half of it. Complex modes are left out.
"""

import argparse
import pathlib

import needs  # before what it looks for
import numpy
import yaml

import style
import tanktread
from branch import draw, unstable
from style import plt


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", help="directory of the run's results, or a deck")
    parser.add_argument("-o", "--output", default="growth_rates.png", metavar="FILE", help="the picture (default: %(default)s)")
    parser.add_argument("--series", default="taylor_surface", metavar="NAME", help="what the difference is taken of (default: %(default)s)")
    parser.add_argument("--amplitude", type=float, default=0.003, help="of the mode, over R_C (default: %(default)s)")
    parser.add_argument("--length", type=float, default=2, help="of the runs, in times of the rate (default: %(default)s)")
    parsed = parser.parse_args()

    run = tanktread.run(parsed.results)
    run.require("leading_rate", parsed.series)
    study = tanktread.Study(directory="results/growth_rates")
    deck = deck_in_time(run, study.directory)
    path = (run.value("Continuation") or {}).get("parameter", "Membrane/capillary number")
    parameter = run.series.get("parameter", numpy.array([run.value(path)]))
    rate = run.series["leading_rate"]
    found = numpy.array([in_time(study, deck, run, k, path, parsed) for k in range(len(rate))])
    for p, one, other in zip(parameter, rate, found):
        print(f"{path} {p:.8g}: rate {one:.6f}" + ("" if numpy.isnan(other) else f", of runs in time {other:.6f}, relative difference {abs(other / one - 1):.1e}"))

    figure, axes = plt.subplots(figsize=(5.2, 3.6))
    draw(axes, parameter, rate, unstable(run), style.RUNS[0], "eigenvalue")
    axes.plot(parameter, found, "o", color=style.RUNS[1], markerfacecolor="none", label="run in time")
    axes.axhline(0, color=style.INK, linewidth=0.6)
    axes.set_xlabel(path)
    axes.set_ylabel("rate of the leading mode")
    axes.legend()
    style.save(figure, parsed.output)


def deck_in_time(run, directory):
    """The deck of a run, without what replaces time."""
    lists = {name: keys for name, keys in run.deck.items() if name not in ("Steady", "Continuation", "Spectrum", "Expect")}
    lists["Particle"] = {key: value for key, value in lists.get("Particle", {}).items() if key != "initial shape"}
    directory.mkdir(parents=True, exist_ok=True)
    path = directory.resolve() / f"{run.name}.yaml"
    path.write_text(yaml.safe_dump({"Tanktread": lists}, sort_keys=False), encoding="utf-8")
    return path


def in_time(study, deck, run, k, path, parsed):
    """The rate from two runs at a point; none at a fold, of a complex mode, or where a run fails."""
    rate = run.series["leading_rate"][k]
    number = 1
    while f"rate_{number}" in run.series and run.series[f"rate_{number}"][k] != rate:
        number += 1
    if run.series.get("fold", numpy.zeros(k + 1))[k] or run.series.get(f"frequency_{number}", numpy.ones(k + 1))[k]:
        return numpy.nan
    end, values = parsed.length / abs(rate), []
    settings = {"Time/final time": end, "Time/tolerance": 1e-6, "Output/interval": end, "Particle/initial shape/mode": number,
                "Particle/initial shape/run": pathlib.Path(run.snapshots()[k].path).resolve()}
    settings |= {key: run.series[name][k] for key, name in ((path, "parameter"), (run.value("Continuation/second parameter"), "second_parameter"))
                 if name in run.series}
    times = numpy.linspace(end / 2, end, 11)
    for sign in 1, -1:
        outcome = study.run(deck, settings | {"Particle/initial shape/mode amplitude": sign * parsed.amplitude})
        if not outcome.done:
            print(f"from {settings['Particle/initial shape/run']}: {outcome.message}")
            return numpy.nan
        values.append(numpy.interp(times, outcome.run.time, outcome.series[parsed.series]))
        if numpy.isnan(values[-1]).any():
            print(f"from {settings['Particle/initial shape/run']}: {parsed.series} is undefined (NaN)")
            return numpy.nan
    return numpy.polyfit(times, numpy.log(abs(values[0] - values[1])), 1)[0]


if __name__ == "__main__":
    main()
