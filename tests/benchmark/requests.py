#!/usr/bin/python3
"""Checks whether requested accuracies (`--accuracy`) are met, how good the error estimates are, and what they cost.

    tests/benchmark/requests.py                          # all scenes; results are kept under results/requests
    tests/benchmark/requests.py --scene shear drop       # only these scenes
    tests/benchmark/requests.py --scene shear --search   # also the cheapest single run that meets each request

For each scene and each of its series, `--accuracy` is requested at 1 %, 0.1 % and 0.01 % of the largest value. To meet
a request, the program makes runs at several levels, each more accurate than the previous one. Finished levels are used
again by the next request. The true error is the difference from a run that is two levels finer than the finest level. A
request for which the program reports that it has reached its limit is counted neither as met nor as missed.

`--search` looks for the cheapest single run that meets the request among 3 to 12 elements per side and the five pairs
of tolerances of accuracy.py. The cost is the number of processor seconds.
"""

import collections
import shutil

from accuracy import DEMANDS as REQUESTS
from accuracy import TOLERANCES
from package import SIDE, answer, choice_of, command_line, numpy, scenes_of, studies, table, tanktread, yaml
from tanktread.figures.accuracy import largest, values

SIDES = [3, 4, 5, 6, 8, 10, 12]
SCENES = scenes_of(__file__)
COLUMNS = ["scene", "request", "level", "allowed", "true error", "estimate", "estimate/true", "result", "ladder, s",
           "cheapest, s"]


def main():
    parser = command_line(__doc__)
    choice_of(parser, SCENES)
    parser.add_argument("--search", action="store_true", help="also search for the cheapest single run")
    studies.arguments(parser, "results/requests", limit=60)
    parsed = parser.parse_args()
    limit, parsed.limit = parsed.limit, 6 * parsed.limit  # a reference may take five times as long as all levels of a request
    study, rows = studies.study(parsed), []

    def lines():
        for name in parsed.scene:
            try:
                for row in Scene(name, parsed.output / "ladders", study, limit).rows(parsed.search):
                    rows.append(dict(zip(COLUMNS, row)))
                    yield row
            except tanktread.Mistake as mistake:
                yield [name, mistake, *[""] * 8]

    table(COLUMNS, lines())
    report(rows)


class Scene:
    """A scene, its ladders and its reference."""

    def __init__(self, name, folder, study, limit):
        self.name, self.study, self.limit = name, study, limit
        deck, self.series, self.settings = (SCENES[name].get(key, {}) for key in ("deck", "series", "set"))
        folder.mkdir(parents=True, exist_ok=True)
        if isinstance(deck, str):
            self.deck = tanktread.deck_at(f"inputs/{deck}.yaml")
        else:
            self.deck = folder / f"{name}.yaml"
            self.deck.write_text(yaml.safe_dump({"Tanktread": deck}), encoding="utf-8")
        self.directory = folder / name

    def run(self, words, settings):
        """Runs the program. Returns its exit code, last message and times as a dict."""
        sets = [word for key, value in settings.items() for word in ("--set", f"{key}={tanktread.text_of(value)}")]
        return self.study._make([str(self.study.program), *map(str, words), *sets, "--quiet"])

    def ladder(self, request):
        """Returns the summary of the ladder for a request, and how it ended."""
        settings = {"Accuracy/requests": request, "Accuracy/wall-clock limit": self.limit}
        if (self.directory / "ladder.yaml").exists():
            note = self.run(["--resume", self.directory], settings)
        else:
            note = self.run([self.deck, "--no-expect", "--output", self.directory], self.settings | settings)
        if note["code"] not in (0, 1, 4):
            shutil.rmtree(self.directory, ignore_errors=True)
            raise tanktread.Mistake(f"{request}: {note['message']}")
        return tanktread.Run(self.directory).summary["accuracy"], note["code"]

    def rows(self, search):
        found = []
        for value in REQUESTS:
            for series in self.series:
                accuracy, code = self.ladder(f"{series}={100 * value:g}%")
                cost = sum(one["seconds"] for one in accuracy["levels"])
                found.append((accuracy["requests"][0], accuracy["levels"][-1]["level"], code, cost))
        reference = self.reference(max(level for _, level, *_ in found))
        return [self.row(*one, reference, search) for one in found]

    def row(self, request, level, code, cost, reference, search):
        mine = values(tanktread.Run(self.directory / f"level_{level}"), request)
        true, allowed, estimate = largest(mine, values(reference, request)), request["allowed"], request[
            "estimated error"]
        result = "not reached"
        if not request["met"] and code == 4:
            result = "unknown"
        elif request["met"]:
            result = "untrusted" if "untrusted" in request else "met" if true <= allowed else "missed"
        cheapest = numpy.nan
        if search and request["met"]:
            cheapest, cost = self.cheapest(request, reference), self.fresh(request["request"])
        return [self.name, request["request"], level, allowed, true, estimate,
                estimate / true if true > 0 else numpy.nan, result, cost, cheapest]

    def fresh(self, request):
        """Returns the processor seconds of a whole ladder."""
        directory = self.directory.with_name(f"{self.name}_fresh")
        return self.run([self.deck, "--no-expect", "--overwrite", "--output", directory],
                        self.settings | {"Accuracy/requests": request})["processor_seconds"]

    def reference(self, level):
        """Returns a run two levels finer."""
        self.run(["--resume", self.directory], {
            "Accuracy/requests": f"{self.series[0].split('@')[0]}=1e-14",
            "Accuracy/levels": min(level + 3, max(level + 2, 7)), "Accuracy/wall-clock limit": 5 * self.limit})
        for k in (level + 2, level + 1):
            summary = self.directory / f"level_{k}/summary.yaml"
            if summary.exists() and is_reference(found := tanktread.Run(summary.parent)):
                return found
        raise tanktread.Mistake("no finer level came to its end without wrinkles")

    def cheapest(self, request, reference):
        """Returns the processor seconds of the cheapest single run that meets the request; NaN if there is none."""
        best, exact = numpy.inf, values(reference, request)
        for time, quadrature in TOLERANCES:
            for side in SIDES:
                outcome = self.study.run(self.deck, self.settings | {
                    SIDE: side, "Time/tolerance": time, "Quadrature/tolerance": quadrature})
                if not outcome.done or outcome.processor_seconds > best:
                    break
                if largest(values(outcome.run, request), exact) <= request["allowed"]:
                    best = outcome.processor_seconds
                    break
        return best if numpy.isfinite(best) else numpy.nan


def is_reference(run):
    """Returns whether a run came to its end and has no wrinkles that its mesh does not represent."""
    return run.summary["status"] in ("done", "steady", "past") and "have grown" not in str(run.summary.get("warnings"))


def report(rows):
    """Prints the shares of requests that are met and of estimates that are good."""
    counts = collections.Counter(row["result"] for row in rows)
    counted = [row for row in rows if row["result"] in ("met", "missed")]
    print(f"\n{len(rows)} cases, of which {len(counted)} count: " + ", ".join(
        f"{counts[word]} {word}" for word in ("met", "missed", "unknown", "untrusted", "not reached")))
    if counted:
        factors = numpy.array([row["estimate/true"] for row in counted])
        factors = factors[numpy.isfinite(factors)]
        print(f"met: {counts['met'] / len(counted):.3f}; estimate/true error between 1/3 and 3: "
              f"{numpy.mean((factors > 1 / 3) & (factors < 3)):.3f}, median {numpy.median(factors):.2f}")
    ratios = [row["ladder, s"] / row["cheapest, s"] for row in rows if numpy.isfinite(row["cheapest, s"])]
    if ratios:
        print("seconds of the ladder divided by the cheapest run: "
              f"median {numpy.median(ratios):.1f}, largest {max(ratios):.1f}")


if __name__ == "__main__":
    answer(main)
