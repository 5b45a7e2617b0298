#!/usr/bin/python3
"""Error against computing cost: runs a scene with all combinations of numerical options that differ from the default in
one or two choices.

    tests/benchmark/work_precision.py tests/benchmark/shear.yaml  # results/work_precision/shear.png, .csv
    tests/benchmark/work_precision.py tests/benchmark/shear.yaml --differences 1  # one choice at a time
    tests/benchmark/work_precision.py tests/benchmark/shear.yaml --only time mesh  # only these choices

A study is a YAML file (tests/benchmark/README.md). It contains a deck, the definition of its error, and the choices.
Each choice has several options, which set a few keys; the first option is the default. The cost is measured in kernel
evaluations, which do not depend on the machine, and in processor seconds of this machine, summed over all ranks.

Each point of the figure is a run. The default is marked by a ring. The black line is the Pareto front. Its runs are
numbered, and the legend lists the options in which they differ from the default.
"""

import dataclasses
import itertools
import operator
import pathlib

from package import answer, command_line, expect, footer, interpolation, numpy, plt, studies, style
from tanktread import tables
from tanktread.files import parsed as read

COSTS = {"seconds": "processor seconds", "kernels": "kernel evaluations"}
# A completed run as a point of the figure. Points are compared by identity.
Point = dataclasses.make_dataclass("Point", "picked label error kind seconds kernels evaluations".split(), eq=False)


class Scene:
    """A study file: its keys are members. `choices`: {choice: {option: settings}}; the first option is the default."""

    def __init__(self, path, curves):
        vars(self).update({"base": {}, "levels": [1e-3, 1e-4, 1e-5], "pairs": None} | read(path))
        self.name, self.curves = pathlib.Path(path).stem, curves
        self.default = {choice: next(iter(options)) for choice, options in self.choices.items()}
        # colours show the choice with the most options; the options of the choice `time` count twice
        self.shape = max(self.choices, key=lambda choice: len(self.choices[choice]) * (1 if choice == "time" else 0.5))

    def combinations(self, differences, only):
        """Yields the default options, then all combinations that differ from them in one choice, then in two."""
        choices = [choice for choice in self.choices if not only or choice in only]
        for group in itertools.chain(*(itertools.combinations(choices, k) for k in range(differences + 1))):
            if len(group) < 2 or self.pairs is None or set(group) in map(set, self.pairs):
                for options in itertools.product(*(list(self.choices[choice])[1:] for choice in group)):
                    yield self.default | dict(zip(group, options))

    def errors(self, study):
        """Returns the function that computes the error of an outcome. Uses a curve of the literature if its folder is
        given."""
        if "final" in self.error:
            return lambda outcome: abs(outcome.final[self.error["final"]] - self.error.get("value", 0.0))
        series = self.error["series"]
        if self.curves and "curve" in self.error:
            t, values = tables.read(self.curves / self.error["curve"], ("t", series), others=True).values.T
        else:
            reference = study.run(self.deck, self.base | self.error["reference"])
            expect(reference.done, f"the reference run failed: {reference.message}")
            t, values = reference.series["time"], reference.series[series]
        return lambda outcome: interpolation.difference(outcome.series["time"], outcome.series[series], t, values)

    def points(self, study, differences, only):
        """Makes the runs. Returns the completed runs as Points, and the rows of all runs for the table."""
        error_of, points, rows = self.errors(study), [], []
        for picked in self.combinations(differences, only):
            settings = dict(self.base)
            for choice, option in picked.items():
                settings |= self.choices[choice][option] or {}
            ranks, deck = int(settings.pop("ranks", 1)), settings.pop("deck", self.deck)
            outcome = study.run(deck, settings, ranks)
            label = ", ".join(one for choice, one in picked.items() if one != self.default[choice]) or "default"
            if outcome.done:
                one = Point(picked, label, error_of(outcome), kind(picked[self.shape]), outcome.processor_seconds,
                            outcome.kernel_evaluations, outcome.counts.get("evaluations", 1))
                points.append(one)
                rows.append((*picked.values(), one.error, one.seconds, one.kernels, one.evaluations, ""))
                print(f"{label:44} error {one.error:.2e}  {one.seconds:7.2f} s  {one.kernels:.3g} kernel, "
                      f"{one.evaluations} velocity evaluations", flush=True)
            else:
                print(f"{label}: {outcome.status}: {outcome.message}", flush=True)
                rows.append((*picked.values(), "", outcome.processor_seconds, "", "", outcome.message))
        return points, rows


def kind(option):
    """Returns an option without its number: `tr-bdf2` for `tr-bdf2 1e-4`."""
    name, _, number = option.rpartition(" ")
    return name if name and number[0].isdigit() else option


def front(points, cost):
    """Returns the Pareto front in order of increasing cost: the points for which no other point has both lower cost and
    lower error."""
    ordered = sorted(points, key=lambda one: (getattr(one, cost), one.error))
    return [one for k, one in enumerate(ordered) if all(one.error < other.error for other in ordered[:k])]


def draw(axis, points, cost, colors, families, numbers):
    """Draws all runs, lines through the runs of each family, and the Pareto front as filled, numbered markers."""
    def plot(line, *words, **look):
        axis.loglog([getattr(one, cost) for one in line], [one.error for one in line], *words, **look)

    kept = front(points, cost)
    for family in families:
        plot(sorted(family, key=operator.attrgetter(cost)), color=colors[family[0].kind], linewidth=0.7, alpha=0.55,
             zorder=1)
    plot(kept, color=style.INK, linewidth=1.4, zorder=2)
    for one in points:
        color, chosen = colors[one.kind], one in kept
        plot([one], "o", color=color, ms=5.5 if chosen else 3.5, mfc=color if chosen else "white", mew=0.9, zorder=3)
        if chosen:
            axis.annotate(numbers[one], (getattr(one, cost), one.error), (-4, -4), textcoords="offset points",
                          fontsize=7.5, ha="right", va="top")
    plot(points[:1], "o", ms=11, mfc="none", mec=style.INK, mew=1.3)
    axis.set_xlabel(COSTS[cost])


def draw_legend(axis, colors, numbers):
    for name, color in colors.items():
        axis.plot([], [], "o", color=color, ms=5, label=name)
    axis.plot([], [], "o", ms=10, mfc="none", mec=style.INK, label="default")
    axis.plot([], [], color=style.INK, label="Pareto front:")
    axis.axis("off")
    axis.legend(loc="upper left", bbox_to_anchor=(-0.1, 1), fontsize=8)
    words = "\n".join(f"{number:2}  {one.label}" for one, number in numbers.items())
    axis.text(0, 0.97 - 0.047 * (len(colors) + 2), words, transform=axis.transAxes, va="top", fontsize=7.5,
              linespacing=1.5)


def report(scene, points):
    """Prints the default against the front, and the quickest run for each level of error."""
    default = points[0]
    for cost, unit in COSTS.items():
        best = min((one for one in points if one.error <= default.error), key=operator.attrgetter(cost))
        mine, least = getattr(default, cost), getattr(best, cost)
        print(f"the default has error {default.error:.2e} for {mine:.4g} {unit}; the least for that is {least:.4g}, "
              f"{mine / least:.2f} times less, by {best.label} with error {best.error:.2e}")
    for level in scene.levels:
        best = min((one for one in points if one.error <= level), key=operator.attrgetter("seconds"), default=None)
        words = (f"best {best.label}: {best.seconds:.3g} s, {best.kernels:.3g} kernel evaluations, "
                 f"{best.evaluations} velocity evaluations") if best else "none"
        print(f"error {level:g}: {words}")


def main():
    parser = command_line(__doc__)
    parser.add_argument("study", help="the study, a YAML file of tests/benchmark")
    parser.add_argument("--differences", type=int, default=2, choices=(1, 2),
                        help="largest number of choices that differ from the default in a run (default: 2)")
    parser.add_argument("--only", nargs="+", default=[], metavar="CHOICE", help="vary these choices only")
    parser.add_argument("--curves", type=pathlib.Path, metavar="DIR",
                        help="directory of reference curves (default: the reference is a run of the study)")
    studies.arguments(parser, "results/work_precision")
    parsed = parser.parse_args()
    scene = Scene(parsed.study, parsed.curves)
    points, rows = scene.points(studies.study(parsed), parsed.differences, parsed.only)
    expect(points, "no run came to its end")
    kinds = list(dict.fromkeys(one.kind for one in points))
    shades = plt.get_cmap("turbo")(numpy.linspace(0.05, 0.92, len(kinds)))
    colors = dict(zip(kinds, style.RUNS if len(kinds) <= len(style.RUNS) else shades))
    on_front = sorted({*front(points, "seconds"), *front(points, "kernels")}, key=lambda one: -one.error)
    numbers = {point: number for number, point in enumerate(on_front, 1)}
    # if the study has two choices, lines join the runs with equal options of the choice that colours show
    options = dict.fromkeys(one.picked[scene.shape] for one in points) if len(scene.choices) == 2 else ()
    families = [[one for one in points if one.picked[scene.shape] == option] for option in options]
    figure, axes = plt.subplots(1, 3, figsize=(11.5, 5.2), width_ratios=[1, 1, 0.42])
    axes[1].sharey(axes[0])
    axes[0].set_ylabel("error")
    for axis, cost in zip(axes, COSTS):
        draw(axis, points, cost, colors, families, numbers)
    draw_legend(axes[2], colors, numbers)
    figure.suptitle(scene.title, x=0.01, ha="left", fontsize=11)
    words = ["--differences", "1"] * (parsed.differences == 1) + ["--only", *parsed.only] * bool(parsed.only)
    against = f", against {scene.error['curve'] if parsed.curves else 'a finer run'}" if "curve" in scene.error else ""
    footer(figure, f"$ {studies.command_of(__file__, parsed.study, *words)}\n"
                   f"error: {scene.error.get('text', '')}{against}")
    studies.write_table(parsed.output / f"{scene.name}.csv",
                        [*scene.choices, "error", "seconds", "kernel_evaluations", "evaluations", "message"], rows)
    style.save(figure, parsed.output / f"{scene.name}.png")
    report(scene, points)


if __name__ == "__main__":
    answer(main)
