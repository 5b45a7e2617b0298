#!/usr/bin/python3
"""Error against work: a scene with all combinations of choices that differ from the default in one or two.

    tests/benchmark/work_precision.py tests/benchmark/shear.yaml  # results/work_precision/shear.png, .csv
    tests/benchmark/work_precision.py tests/benchmark/shear.yaml --differences 1  # one choice at a time
    tests/benchmark/work_precision.py tests/benchmark/shear.yaml --only time mesh  # these choices

A study is a small YAML file (tests/benchmark/README.md): a deck, what counts as its error, and the choices, each with
options of a few keys; the first option is the default. Work is told in kernel evaluations, which no machine changes,
and in processor seconds of this machine, all ranks together. Each point is a run; the black line is the Pareto front,
whose runs are numbered and told beside it by what differs from the default, the ring.
"""

import argparse
import itertools
import math
import pathlib
import sys

from package import answer, interpolation, numpy, plt, studies, style
import yaml


class Scene:
    """A study file. `options(choice)`: {option: settings}; the first is the default."""

    def __init__(self, path, curves, without=()):
        if not pathlib.Path(path).is_file():
            sys.exit(f"{path} is no file: give a study of tests/benchmark")
        text = yaml.safe_load(pathlib.Path(path).read_text(encoding="utf-8"))
        self.name, self.title = pathlib.Path(path).stem, text["title"]
        self.decks, self.base, self.choices = text["deck"], text.get("base", {}), text["choices"]
        self.choices = {choice: {name: keys for name, keys in options.items() if name not in without} for choice,
                        options in self.choices.items()}
        self.error, self.levels = text["error"], text.get("levels", [1e-3, 1e-4, 1e-5])
        self.pairs = text.get("pairs")
        self.curves = curves

    def default(self):
        return {choice: next(iter(options)) for choice, options in self.choices.items()}

    def settings(self, picked):
        merged = dict(self.base)
        for choice, option in picked.items():
            merged |= self.choices[choice][option] or {}
        return merged

    def combinations(self, differences, only):
        """The default, then every pick that differs from it in one choice, then in two."""
        default = self.default()
        yield default
        choices = [choice for choice in self.choices if not only or choice in only]
        groups = [(choice,) for choice in choices]
        if differences > 1:
            groups += [pair for pair in itertools.combinations(choices, 2) if self.pairs is None
                       or any(set(pair) == set(wanted) for wanted in self.pairs)]
        for group in groups:
            others = [[option for option in self.choices[choice] if option != default[choice]] for choice in group]
            for options in itertools.product(*others):
                yield default | dict(zip(group, options))

    def against(self):
        """What stands after the error's text: a curve of the literature is taken where its folder is given."""
        if "curve" not in self.error:
            return ""
        return f", against {self.error['curve']}" if self.curves else ", against a finer run"

    def errors(self, study):
        """The function outcome -> error."""
        if "final" in self.error:
            return lambda outcome: abs(outcome.final[self.error["final"]] - self.error.get("value", 0.0))
        series = self.error["series"]
        if self.curves and "curve" in self.error:
            curve = numpy.genfromtxt(self.curves / self.error["curve"], delimiter=",", names=True)
            t, values = curve["t"], curve[series]
        else:
            reference = study.run(self.decks, self.base | self.error["reference"])
            if not reference.done:
                raise SystemExit(f"the reference run failed: {reference.message}")
            t, values = reference.series["time"], reference.series[series]
        return lambda outcome: interpolation.difference(outcome.series["time"], outcome.series[series], t, values)


class Point:
    def __init__(self, picked, default, outcome, error):
        self.picked, self.outcome, self.error = picked, outcome, error
        self.seconds, self.kernels = outcome.processor_seconds, outcome.kernel_evaluations
        self.evaluations = outcome.counts.get("evaluations", 1)
        self.label = ", ".join(option for choice, option in picked.items() if option != default[choice]) or "default"


def kind(option):
    """An option without its number: `tr-bdf2 1e-4` is a `tr-bdf2`."""
    name, _, number = option.rpartition(" ")
    return name if name and number[0].isdigit() else option


def front(points, cost):
    """Those that no other beats in both, by rising cost."""
    best, kept = math.inf, []
    for point in sorted(points, key=lambda one: (getattr(one, cost), one.error)):
        if point.error < best:
            best = point.error
            kept.append(point)
    return kept


def draw(axis, points, cost, label, colors, shape, families, numbers):
    """Every run, lines through those of a family, and the front: filled, with its numbers."""
    kept = front(points, cost)
    for family in families:
        line = sorted(family, key=lambda one: getattr(one, cost))
        axis.loglog([getattr(one, cost) for one in line], [one.error for one in line],
                    color=colors[kind(line[0].picked[shape])], linewidth=0.7, alpha=0.55, zorder=1)
    axis.loglog([getattr(one, cost) for one in kept], [one.error for one in kept], color=style.INK, linewidth=1.4,
                zorder=2)
    for point in points:
        color = colors[kind(point.picked[shape])]
        axis.plot(getattr(point, cost), point.error, "o", color=color, ms=5.5 if point in kept else 3.5,
                  mfc=color if point in kept else "white", mew=0.9, zorder=3)
        if point in kept:
            axis.annotate(numbers[point], (getattr(point, cost), point.error), (-4, -4), textcoords="offset points",
                          fontsize=7.5, ha="right", va="top")
    axis.plot(getattr(points[0], cost), points[0].error, "o", ms=11, mfc="none", mec=style.INK, mew=1.3)
    axis.set_xlabel(label)


def families_of(points, choices, shape):
    """Where a study has two choices: the runs that share an option of the one that colours stand for, told apart by the
    other."""
    if len(choices) != 2:
        return []
    return [[one for one in points if one.picked[shape] == option]
            for option in dict.fromkeys(one.picked[shape] for one in points)]


def report(scene, points):
    """The default against the front; what each option of each choice needs at best for a level of error."""
    default = points[0]
    for cost, unit in (("seconds", "s"), ("kernels", "kernel evaluations")):
        better = [one for one in points if getattr(one, cost) < getattr(default, cost) and one.error <= default.error]
        if better:
            best = min(better, key=lambda one: getattr(one, cost))
            print(f"the default is not on the front of {cost}: {best.label} has error {best.error:.2e} for "
                  f"{getattr(best, cost):.4g} {unit}, " f"the default {default.error:.2e} for "
                                                        f"{getattr(default, cost):.4g}, "
                                                        f"{getattr(default, cost) / getattr(best, cost):.2f} times as "
                                                        "much")
        else:
            print(f"the default is on the front of {cost}: {default.error:.2e} for {getattr(default, cost):.4g} {unit}")
    for level in scene.levels:
        reaching = [one for one in points if one.error <= level]
        if not reaching:
            print(f"error {level:g}: none")
            continue
        best = min(reaching, key=lambda one: one.seconds)
        print(f"error {level:g}: best {best.label}: {best.seconds:.3g} s, {best.kernels:.3g} kernel evaluations, "
              f"{best.evaluations} velocity evaluations")
        for choice, options in scene.choices.items():
            for option in options:
                these = [one for one in reaching if one.picked[choice] == option]
                if these and len(options) > 1:
                    quickest, least = min(these, key=lambda one: one.seconds), min(these, key=lambda one: one.kernels)
                    print(f"    {choice:14} {option:26} {quickest.seconds:9.3g} s "
                          f"({quickest.seconds / best.seconds:6.2f} x)  {least.kernels:9.3g} kernels "
                          f"({least.kernels / min(one.kernels for one in reaching):6.2f} x)  {quickest.label}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("study", help="the study: a file of tests/benchmark")
    parser.add_argument("--differences", type=int, default=2, choices=(1, 2),
                        help="choices that may differ from the default at a time (default: 2)")
    parser.add_argument("--only", nargs="+", metavar="CHOICE", help="vary these choices only")
    parser.add_argument("--without", nargs="+", default=[], metavar="OPTION",
                        help="leave these options of the choices out")
    parser.add_argument("--curves", type=pathlib.Path, metavar="DIR",
                        help="folder of reference curves (default: none, a run of the study's `reference` instead)")
    studies.arguments(parser, "results/work_precision")
    parsed = parser.parse_args()
    study, scene = studies.study(parsed), Scene(parsed.study, parsed.curves, parsed.without)

    error_of, points, rows, default = scene.errors(study), [], [], scene.default()
    for picked in scene.combinations(parsed.differences, parsed.only):
        settings = scene.settings(picked)
        ranks = int(settings.pop("ranks", 1))
        decks = settings.pop("deck", scene.decks)
        outcome = study.run(decks, settings, ranks)
        name = ", ".join(option for choice, option in picked.items() if option != default[choice]) or "default"
        if not outcome.done:
            print(f"{name}: {'not in this program' if outcome.refused else 'failed'}: {outcome.message}", flush=True)
            rows.append((*picked.values(), "", outcome.processor_seconds, "", "", outcome.message))
            continue
        point = Point(picked, default, outcome, error_of(outcome))
        points.append(point)
        rows.append((*picked.values(), point.error, point.seconds, point.kernels, point.evaluations, ""))
        print(f"{name:44} error {point.error:.2e}  {point.seconds:7.2f} s  {point.kernels:.3g} kernel, "
              f"{point.evaluations} velocity evaluations", flush=True)

    shape = max(scene.choices, key=lambda choice: len(scene.choices[choice])
                if choice == "time" else 0.5 * len(scene.choices[choice]))
    kinds = list(dict.fromkeys(kind(option) for option in scene.choices[shape]))
    few = len(kinds) <= len(style.RUNS)
    colors = dict(zip(kinds, style.RUNS if few else plt.get_cmap("turbo")(numpy.linspace(0.05, 0.92, len(kinds)))))
    on_front = sorted({*front(points, "seconds"), *front(points, "kernels")}, key=lambda one: -one.error)
    numbers = {point: number for number, point in enumerate(on_front, 1)}
    families = families_of(points, scene.choices, shape)
    figure, axes = plt.subplots(1, 3, figsize=(11.5, 5.2), width_ratios=[1, 1, 0.42])
    axes[1].sharey(axes[0])
    axes[0].set_ylabel("error")
    draw(axes[0], points, "seconds", "processor seconds", colors, shape, families, numbers)
    draw(axes[1], points, "kernels", "kernel evaluations", colors, shape, families, numbers)
    for name, color in colors.items():
        if any(kind(point.picked[shape]) == name for point in points):
            axes[2].plot([], [], "o", color=color, ms=5, label=name)
    axes[2].plot([], [], "o", ms=10, mfc="none", mec=style.INK, label="the default")
    axes[2].plot([], [], color=style.INK, label="Pareto front:")
    axes[2].axis("off")
    axes[2].legend(loc="upper left", bbox_to_anchor=(-0.1, 1), fontsize=8)
    rest = len(axes[2].get_legend_handles_labels()[0])
    axes[2].text(0, 0.97 - 0.047 * rest, "\n".join(f"{number:2}  {point.label}" for point, number in numbers.items()),
                 transform=axes[2].transAxes, va="top", fontsize=7.5, linespacing=1.5)
    figure.suptitle(scene.title, x=0.01, ha="left", fontsize=11)
    words = [parsed.study]
    words += ["--differences", str(parsed.differences)] if parsed.differences != 2 else []
    words += ["--only", *parsed.only] if parsed.only else []
    words += ["--without", *parsed.without] if parsed.without else []
    command = r"\$ " + studies.command_of(__file__, *words)
    figure.supxlabel(f"{command}\nerror: {scene.error.get('text', '')}" + scene.against(), x=0.01, ha="left",
                     fontsize=7.5)
    studies.write_table(parsed.output / f"{scene.name}.csv",
                        [*scene.choices, "error", "seconds", "kernel_evaluations", "evaluations", "message"], rows)
    style.save(figure, parsed.output / f"{scene.name}.png")
    report(scene, points)


if __name__ == "__main__":
    answer(main)
