"""Finds by bisection the critical value of a key above which a particle passes a constriction and below which it stays.

    tanktread-critical inputs/capsule_stuck.yaml --between 0.006 0.0063 --past 0.5
    tanktread-critical inputs/capsule_stuck.yaml --between 0.006 0.0063 --past 0.5 --set 'Particle/viscosity ratio=5'

The particle passes if the run ends with the centroid beyond x1 = --past.

Whether it stays is decided from the last part of the run, which is 10 R/V long. R is the radius of the channel and V
the mean velocity. The particle stays if two conditions hold for its velocity along the channel. First, the average is
less than 0.001 V in magnitude. Second, the average in the second half of this time exceeds that in the first half by
less than 0.0001 V plus the standard error of this difference. The allowance is needed because quadrature errors move a
particle at rest. The standard error follows from the deviations of the positions from a fitted parabola.

If the particle neither passes nor stays, the run is repeated with twice the final time, at most twice. If this does not
decide either, the search ends with a message.
"""

import numpy

from ..mistakes import Mistake, command_line, expect, log
from ..runs import settings_of
from . import common

SLOW = 1e-3  # a particle that stays is slower than this fraction of the mean velocity
NOISE = 0.1  # it may be faster in the second half of the time than in the first by this fraction of SLOW
LAST = 10  # time at the end of a run that is examined, in channel radii divided by the mean velocity
SAMPLES = 401  # number of positions in that time
TIMES = 3  # largest number of runs per value of the key; each takes twice the time of the previous one


def stays(time, way, radius, speed):
    """Returns True if the particle stays by the criterion above, otherwise None. `way`: x1 of the centroid at the times
    `time`. `radius`: radius of the channel. `speed`: mean velocity."""
    last = LAST * radius / speed
    if time[-1] - time[0] < last:
        return None
    at = time[-1] - last * numpy.linspace(1, 0, SAMPLES)
    places = numpy.interp(at, time, way)
    wanders = numpy.std(places - numpy.polyval(numpy.polyfit(at - at[-1], places, 2), at - at[-1]))
    first, second = 2 * numpy.diff(places[[0, SAMPLES // 2, -1]]) / last
    # standard error of second - first, a difference of (end - 2 middle + beginning) with errors `wanders`
    by_chance = 6**0.5 * wanders * 2 / last
    return (abs(first + second) / 2 < SLOW * speed and second - first < NOISE * SLOW * speed + by_chance) or None


def stays_at(parsed, study, value):
    """Returns True if the particle stays at a value of the key, and False if it passes. Doubles the final time of the
    run until this is decided. Raises Mistake if it is not decided after TIMES runs."""
    settings = {"Time/end when past": parsed.past} | settings_of(parsed.set) | {parsed.key: value}
    for _ in range(TIMES):
        outcome = study.run(parsed.deck, settings)
        expect(outcome.done, f"{parsed.key}={value:.6g}: {outcome.message}")
        run, series = outcome.run, outcome.series
        radius, speed = run.value("Channel/radius", 1.0), run.value("Flow/mean velocity", 1.0)
        held = run.summary["status"] != "past" and stays(series["time"], series["centroid_x1"], radius, speed)
        said = {True: "stays", False: "passes", None: f"neither passes nor stays by {series['time'][-1]:g}"}[held]
        log.info(f"{parsed.key} = {value:.5g}: {said}; to x1 = {series['centroid_x1'][-1]:.4f}, there "
                 f"{series['velocity_x1'][-1] / speed:.2g} of the mean velocity; smallest film "
                 f"{series['gap'].min():.3g}, largest error of the volume {abs(series['volume_error']).max():.1g}; "
                 f"{outcome.processor_seconds:.0f} processor seconds")
        if held is not None:
            return held
        settings["Time/final time"] = 2 * run.value("Time/final time")
    raise Mistake(f"{parsed.key}={value:.6g} neither passes nor stays")


def main():
    parser = command_line(__doc__)
    parser.add_argument("deck", help="deck of a particle in a channel")
    parser.add_argument("--key", default="Flow/mean velocity",
                        help="key whose critical value is sought (default: %(default)s)")
    parser.add_argument("--between", nargs=2, type=float, required=True, metavar=("LOW", "HIGH"),
                        help="values of the key: the particle stays at LOW and passes at HIGH")
    parser.add_argument("--within", type=float, default=0.02, metavar="PART",
                        help="relative accuracy of the critical value (default: %(default)s)")
    parser.add_argument("--past", type=float, required=True, metavar="X1",
                        help="the particle has passed if its centroid is beyond x1 = X1")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE",
                        help="sets another key in all runs (repeatable)")
    common.arguments(parser, "results/critical", limit=None)
    parsed = parser.parse_args()
    low, high = parsed.between
    expect(0 < low < high, f"--between needs two positive values that ascend, but is given {low:g} and {high:g}")
    expect(parsed.within > 0, f"--within must be above 0, but is {parsed.within:g}")
    study = common.study(parsed)
    low, high, how = common.edge(lambda value: stays_at(parsed, study, value), low, high, 1 + parsed.within)
    expect(how != "fails from here", f"the particle passes at {high:g}: give --between a smaller first value")
    expect(how != "holds to here", f"the particle stays at {low:g}: give --between a larger second value")
    log.info(f"critical {parsed.key}: {low:.5g} (stays) to {high:.5g} (passes)")
