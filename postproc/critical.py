#!/usr/bin/python3
"""The critical value of a key, above which a particle passes a constriction and below which it stays, by bisection.

    critical.py inputs/capsule_stuck.yaml --between 0.006 0.0063 --past 0.5
    critical.py inputs/capsule_stuck.yaml --between 0.006 0.0063 --past 0.5 --set 'Particle/viscosity ratio=5' --set 'Channel/repulsion range=0.01'

A run passes when it ends as past the place x1 = --past. It stays when, over the last ten channel radii over the mean velocity, its centroid went on average
slower than a thousandth of that velocity, and in the second half of them no faster along the flow than in the first. Faster by a tenth of that
thousandth, or by the standard error of the difference, which follows from how far the centroid strays from the parabola through its places, counts as no
faster: a particle at rest wanders with the errors of its integrals. A run that does neither is made again for twice the time, and once more;
one that still does neither ends the search, with a message. A run that is there is not made again.
"""

import argparse
import pathlib

import needs  # before what it looks for
import numpy

import study
import sweep

SLOW = 1e-3  # speed of one that stays, over the mean velocity
NOISE = 0.1  # of that, by which a second half may be faster
LAST = 10  # channel radii over the mean velocity
SAMPLES = 401  # of the way in that time
TIMES = 3  # that an undecided run is made, each for twice the time


def stays(time, way, radius, speed):
    """Of centroids along their way; None: it cannot be told."""
    last = LAST * radius / speed
    if time[-1] - time[0] < last:
        return None
    at = time[-1] - last * numpy.linspace(1, 0, SAMPLES)
    places = numpy.interp(at, time, way)
    wanders = numpy.std(places - numpy.polyval(numpy.polyfit(at - at[-1], places, 2), at - at[-1]))
    first, second = 2 * numpy.diff(places[[0, SAMPLES // 2, -1]]) / last
    by_chance = 6**0.5 * wanders * 2 / last  # of the end less the middle twice and the beginning
    return True if abs(first + second) / 2 < SLOW * speed and second - first < NOISE * SLOW * speed + by_chance else None


class Search:
    """Runs at one value of the key after the other."""

    def __init__(self, parsed):
        self.parsed, self.runs, self.deck = parsed, study.study(parsed), study.deck_of(parsed.deck)
        self.settings = {"Time/end when past": parsed.past} | study.settings_of(parsed.set)

    def stays(self, value):
        held, settings = None, self.settings | {self.parsed.key: value}
        for _ in range(TIMES):
            run, held = self.one(value, settings)
            if held is not None:
                return held
            settings = settings | {"Time/final time": 2 * run.value("Time/final time")}
        raise sweep.Mistake(f"{self.parsed.key}={value:.6g} neither passes nor stays")

    def one(self, value, settings):
        outcome = self.runs.run(self.deck, settings)
        sweep.expect(outcome.done, f"{self.parsed.key}={value:.6g}: {outcome.message}")
        run, series = outcome.run, outcome.series
        speed = run.value("Flow/mean velocity", 1.0)
        held = run.summary["status"] != "past" and stays(series["time"], series["centroid_x1"], run.value("Channel/radius", 1.0), speed)
        said = {True: "stays", False: "passes", None: f"neither passes nor stays by {series['time'][-1]:g}"}[held]
        print(f"{self.parsed.key} = {value:.5g}: {said}; to x1 = {series['centroid_x1'][-1]:.4f}, there {series['velocity_x1'][-1] / speed:.2g} of the mean "
              f"velocity; smallest film {series['gap'].min():.3g}, largest error of the volume {numpy.abs(series['volume_error']).max():.1g}; "
              f"{outcome.processor_seconds:.0f} processor seconds", flush=True)
        return run, held


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("deck", type=pathlib.Path, help="the deck of a particle in a channel")
    parser.add_argument("--key", default="Flow/mean velocity", help="the key (default: %(default)s)")
    parser.add_argument("--between", nargs=2, type=float, required=True, metavar=("LOW", "HIGH"), help="values of the key, at the first of which it stays")
    parser.add_argument("--within", type=float, default=0.02, metavar="PART", help="of the value, to which it is found (default: %(default)s)")
    parser.add_argument("--past", type=float, required=True, metavar="X1", help="where it has passed")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="another key of all runs; may be there many times")
    study.arguments(parser, pathlib.Path("results/critical"))
    parser.set_defaults(limit=None)
    parsed = parser.parse_args()
    low, high = parsed.between
    sweep.expect(0 < low < high, f"--between needs two positive values that ascend, but is given {low:g} and {high:g}")
    search = Search(parsed)
    found, how = study.edge(search.stays, low, high, 1 + parsed.within)
    sweep.expect(how == "edge", f"{'it passes' if how == 'fails from here' else 'it stays'} at {found:g} already: --between other values")
    print(f"critical {parsed.key}: {found:.5g} to {found * (1 + parsed.within):.5g}")
    return 0


if __name__ == "__main__":
    sweep.answer(main)
