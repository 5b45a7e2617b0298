"""Figure of the work of a scene against its accuracy."""

import pathlib
import tempfile

import numpy

from ..interpolation import difference, mean
from ..mistakes import expect, log
from ..results import Run
from ..runs import Study, settings_of
from . import style
from .register import figure

PARTS = {"mesh": ("Surface/", "Particles/", "Adaptation/", "Tube/", "Channel/"),
         "time": ("Time/", "Steady/", "Periodic/"), "quadrature": ("Quadrature/", "Solvers/")}


class Levels:
    """The levels of a run with requested accuracy, coarse to fine: their settings, seconds and runs."""

    def __init__(self, run):
        found = (run.summary or {}).get("accuracy")
        expect(found, f"{run.directory} is no run with requested accuracy: run its deck with --accuracy SERIES=VALUE")
        expect(found.get("levels"), f"{run.directory} has no finished level")
        self.requests, levels = found["requests"], found["levels"]
        self.settings = [settings_of(level["settings"]) for level in levels]
        self.seconds = numpy.array([level["seconds"] for level in levels])
        self.runs = [Run(run.directory / f"level_{level['level']}") for level in levels]

    def errors(self, request):
        """Returns the error of each level: the difference from the finest one, of which the estimate is taken."""
        finest = values(self.runs[-1], request)
        found = [largest(values(one, request), finest) for one in self.runs[:-1]]
        return numpy.array([*found, request["estimated error"]])

    def parts(self, request, study):
        """Returns {part: change of the result if only this part is refined}, at the second last level but one."""
        k = max(0, len(self.runs) - 3)
        base, found = values(self.runs[k], request), {}
        with tempfile.TemporaryDirectory() as folder:
            deck = pathlib.Path(folder) / f"{self.runs[k].directory.parent.resolve().name}.yaml"
            deck.write_text(self.runs[k].deck_text, encoding="utf-8")
            for part, keys in PARTS.items():
                coarse, finer = ({key: value for key, value in settings.items() if key.startswith(keys)}
                                 for settings in self.settings[k:k + 2])
                if finer != coarse:
                    outcome = study.run(deck, finer)
                    expect(outcome.done, f"the run with a finer {part} did not come to its end: {outcome.message}")
                    found[part] = largest(values(outcome.run, request), base)
        return found


def values(run, request):
    """Returns times and values of which a request limits the error; of a branch those at folds and at its end."""
    times, series = run.series["time"], run.series[request["series"]]
    if "fold" in run.series:
        chosen = numpy.flatnonzero((run.series["fold"] != 0) | (numpy.arange(len(series)) == len(series) - 1))
        times, series = numpy.arange(len(chosen), dtype=float), series[chosen]
    if request["of"] == "run":
        return times, series
    return numpy.zeros(1), numpy.array([series[-1] if request["of"] == "end" else mean(times, series)])


def largest(one, other):
    """Returns the largest difference of two series at the times that both have; by interpolation if these are few."""
    _, mine, theirs = numpy.intersect1d(one[0].round(9), other[0].round(9), return_indices=True)
    if len(mine) >= min(5, len(one[0]), len(other[0])):
        return float(numpy.nanmax(abs(one[1][mine] - other[1][theirs])))
    return difference(*one, *other)


@figure(1, 1, 6.4, 4.4)
def work(run, axis, *, parts: bool = True):
    """Estimated error against seconds, for each series whose accuracy was requested, with the part that dominates.

    Each point is a level of the run. The error of a level is its difference from the finest one, whose own error is
    estimated. The dominant part, mesh, time or quadrature, is the one whose refinement changes the result most.

    parts: also make the runs that tell the dominant part"""
    levels = Levels(run)
    study = Study(directory=run.directory / "parts")
    for request, color in style.coloured(levels.requests):
        errors = levels.errors(request)
        known = numpy.isfinite(errors) & (errors > 0)
        if known.sum() < 2:
            log.info(f"{request['request']}: {request.get('untrusted', 'the error is unknown')}")
            continue
        seconds, errors = levels.seconds[known], errors[known]
        slope = numpy.polyfit(numpy.log(seconds), numpy.log(errors), 1)[0]
        found = levels.parts(request, study) if parts else {}
        words = f"{request['request']}: slope {slope:.1f}" + (f", mostly {max(found, key=found.get)}" if found else "")
        axis.loglog(seconds, errors, "o-", ms=4, color=color, label=words)
        axis.axhline(request["allowed"], linewidth=0.8, **style.GUIDE | {"color": color})
        changes = ", ".join(f"{part} {change:.2g}" for part, change in found.items())
        log.info(words + (f"; change by refinement of {changes}" if changes else ""))
    style.finish(axis, xlabel="seconds of the level", ylabel="estimated error", title="dashed: requested accuracy")
