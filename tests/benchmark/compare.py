#!/usr/bin/python3
"""Compares the results and the work of two programs on all decks of inputs/ and tests/decks/ (named decks/<name> here).

    tests/benchmark/compare.py OLD_PROGRAM NEW_PROGRAM [--decks NAME ...] [--differences FILE]
    tests/benchmark/compare.py OLD_PROGRAM NEW_PROGRAM --without-thresholds
    tests/benchmark/compare.py PROGRAM PROGRAM --exact --threads 1 3

The difference of a series is the largest one over its rows, divided by the larger of two numbers: the largest absolute
value of the series in the old run, and the natural unit of its dimension, made of R_C, the reciprocal rate of the flow
and the viscosity. If the runs have different numbers of rows, they are compared at the times that both recorded and at
their ends, and the table says so. Nothing is interpolated, because the interpolation error would hide the difference.
Values that only the summary holds are compared as well.

The script prints one row per deck. The exit code is 1 if a difference exceeds the tolerance, unless FILE allows it: a
YAML list of {deck, series, tolerance, reason}, where deck and series may be patterns like `*`. The series `exit code`
and `Expect/<name>` stand for a changed exit code and for an expectation that is no longer met. Their difference is
infinite, which the tolerance `.inf` allows.

With --without-thresholds, each deck runs ten fixed steps with far sums over all nodes, linear solves to 1e-12 and no
adaptation, so that round-off cannot change steps, meshes or iterations, and differences show the algebra. The step is
the smallest one of the old program's run as shipped. Settings that a deck does not allow are left out.

With --exact, every series, count and snapshot must be equal in all bits, except seconds. With --threads, the old program
runs with the first number of threads and the new one with the second.

The two runs of a deck are neighbours in the queue, so that other work on the machine slows both alike. Results are kept
in DIR and are not computed again. They are kept separately for the old and the new program, and for each version of a
program (by a hash of its file). Decks for two ranks run last, half as many at a time.
"""

import concurrent.futures
import contextlib
import fnmatch
import hashlib
import json
import math
import pathlib
import re
import shutil
import subprocess
import sys

from package import INPUTS, command_line, numpy, scenes_of, table, tanktread, yaml
from power_balance import ENDS

# Settings that shorten the decks which take more than about ten seconds of processor time. All other decks run to their
# own ends. Round-off grows from step to step in suspensions, so they end after about ten steps. Two branches end before
# their fold, with exit code 3. capsule_stuck fails at 330, where the gap is smaller than Channel/contact gap.
SOONER = ("capsule_capillary", "capsule_constriction", "capsule_cylinder", "capsule_step", "shear_paper", "suspension")
SHORTER = {name: {"Time/final time": ENDS[name]} for name in SOONER} | scenes_of(__file__)

# Series that count work. The table shows their totals and ratios; they are not compared as results. Series in seconds
# are left out because they measure the machine. Step sizes and estimated errors are compared only if the runs have the
# same number of rows.
WORK = {"rejected_steps", "iterations", "evaluations", "assemblies", "solver_iterations", "velocity_iterations",
        "kernel_evaluations"}
STEPS, EVALUATIONS, ITERATIONS, KERNELS, SECONDS = range(5)
DIMENSIONS = dict(re.findall(r"^\| `(\w+)` \| ([^|]+) \|", (INPUTS / "SERIES.md").read_text(), re.MULTILINE))


def all_decks():
    """Returns {name: (paths of the deck and of its overlay, ranks)}."""
    found = {}
    for path in sorted(INPUTS.glob("*.yaml")) + sorted((tanktread.SOURCE / "tests/decks").glob("*.yaml")):
        remarks = dict(re.findall(r"^# (base|ranks): (\S+)", path.read_text(), re.MULTILINE))
        base = [tanktread.SOURCE / remarks["base"]] if "base" in remarks else []
        name = path.stem if path.parent.name == "inputs" else f"decks/{path.stem}"
        found[name] = base + [path], int(remarks.get("ranks", 1))
    return found


def study_of(program, role, arguments):
    """Returns the Study that runs a program. Its directory is named by the checksum of the program file. The study runs
    a copy of this file, so that the program may be rebuilt during the comparison."""
    digest = hashlib.sha1(pathlib.Path(program).read_bytes()).hexdigest()[:12]
    threads = arguments.threads[role == "new"] if arguments.threads else None
    directory = pathlib.Path(arguments.output).resolve() / (f"{role}-{digest}" + (f"-{threads}" if threads else ""))
    directory.mkdir(parents=True, exist_ok=True)
    if not (directory / "program").exists():
        shutil.copy2(program, directory / "program")
    return tanktread.Study(directory / "program", directory, limit=arguments.limit, fresh=arguments.fresh,
                           threads=threads)


def natural_unit(dimension, run):
    """Returns the natural unit of a dimension such as `force length/time`; 1 for dimensionless values and for keys of
    the deck."""
    length, velocity, stress = (run.scale(name)[0] for name in ("length", "velocity", "stress"))
    units = {"length": length, "time": length / velocity, "force": stress * length**2, "degree": 180 / math.pi}
    factors = re.findall(r"(/?)([a-z]+)(?:\^(\d))?", dimension)
    return math.prod(units.get(word, 1.0) ** ((-1 if slash else 1) * int(power or 1)) for slash, word, power in factors)


def rows_of(old, new):
    """Returns which rows of the two runs are compared, and a remark if the runs have different numbers of rows."""
    t, u = old.series["time"], new.series["time"]
    if len(t) == len(u):
        return numpy.arange(len(t)), numpy.arange(len(u)), ""
    i, j = numpy.nonzero(abs(t[:, None] - u) <= 1e-9 * max(t[-1], u[-1]))
    remark = f"{len(t)} and {len(u)} rows, compared at {len(i)} common times"
    return numpy.append(i, len(t) - 1), numpy.append(j, len(u) - 1), remark


def conditioning(prefix, name, series):
    """Returns the factor by which the difference of a series is multiplied. The factor of a direction is the relative
    difference of the two axes that determine it, because round-off is amplified if these axes are nearly equally long.
    All other factors are 1. Returns None if the axes are not recorded, as for the inclination of a rigid body, whose
    quaternion is compared instead."""
    if name == "inclination" and prefix + "taylor_inertia" in series:
        return numpy.minimum(1, 2 * series[prefix + "taylor_inertia"])
    if name == "inclination" or name.startswith("axis_1_x"):
        return 1 - series[prefix + "axis_2"] / series[prefix + "axis_1"] if prefix + "axis_2" in series else None
    return numpy.ones(len(series["time"]))


def scaled(name, old, new, unit):
    """Returns the difference of a series in every row; infinity where only one is NaN."""
    with numpy.errstate(invalid="ignore"):  # equal infinite values: inf - inf
        change = abs(new - old)
    if name == "inclination":
        change = numpy.minimum(change, abs(180 - change))  # -90 and 90 degrees are the same direction
    elif name.startswith("axis_1_x"):
        change = numpy.minimum(change, abs(new + old))  # the sign of an axis is arbitrary
    change = numpy.where((old == new) | (numpy.isnan(old) & numpy.isnan(new)), 0.0, change)
    return numpy.nan_to_num(change, nan=numpy.inf) / numpy.max(abs(old), initial=unit, where=numpy.isfinite(old))


def differences_of(old, new):
    """Returns {series: difference} of two runs, and a remark on the rows that are compared."""
    i, j, remark = rows_of(old, new)
    found = {name: math.inf for name in old.series.keys() ^ new.series.keys()}
    for name in old.series.keys() & new.series.keys():
        prefix, base = name[:name.rfind("/") + 1], name[name.rfind("/") + 1:]
        factor = conditioning(prefix, base, old.series)
        skipped = base in WORK or old.units[name] == "s" or (base in ("time_step", "step_error") and remark)
        if not skipped and factor is not None:
            change = scaled(base, old.series[name][i], new.series[name][j], natural_unit(old.units[name], old))
            # NaN from only one of the programs is allowed if the axes are equal up to rounding
            change[numpy.isinf(change) & (factor[i] < 2e-6)] = 0
            found[name] = float(numpy.max(numpy.where(change > 0, change * factor[i], 0.0), initial=0.0))
    first, second = ((run.summary or {}).get("final", {}) for run in (old, new))
    for name in (first.keys() | second.keys()) - old.series.keys() - new.series.keys() - WORK - {"wall_seconds"}:
        base = name.rsplit("/", 1)[-1]
        a, b = (numpy.ravel(numpy.array(final.get(name, []), float)) for final in (first, second))
        unit = natural_unit(DIMENSIONS.get(base, "1"), old)
        found["final/" + name] = float(scaled(base, a, b, unit).max(initial=0.0)) if len(a) == len(b) else math.inf
    return found, remark


def contents_of(run):
    """Returns {name: numbers} of everything in the results of a run that must not depend on the number of threads."""
    found = {name: values for name, values in run.series.items() if run.units[name] != "s"}
    for group in "final", "counts":
        found |= {f"{group}/{name}": numpy.ravel(numpy.array(value, float)) for name, value in (run.summary or {}).get(group, {}).items()
                  if name != "wall_seconds"}
    for k, shot in enumerate(run.snapshots()):
        found |= {f"snapshot {k}/{name}": values for name, values in shot.fields.items()} | {f"snapshot {k}/points": shot.points}
    return found


def exact_differences(*runs):
    """Returns {name: 0 if the numbers of both runs have the same bits, otherwise infinity}."""
    old, new = map(contents_of, runs)
    return {name: 0.0 if name in old and name in new and numpy.asarray(old[name]).tobytes() == numpy.asarray(new[name]).tobytes() else math.inf
            for name in old.keys() | new.keys()}


def work_of(outcome, run):
    """Returns steps, velocity evaluations, solver iterations, kernel evaluations and processor seconds of a run; NaN if
    unknown."""
    if not run:
        return [math.nan] * SECONDS + [outcome.processor_seconds]
    counts = {name: float(values[-1]) for name, values in run.series.items() if len(values)}
    counts |= (run.summary or {}).get("counts", {})
    kernels = [value for name, value in counts.items() if name.startswith("kernel_evaluations")]
    iterations = [counts[name] for name in ("solver_iterations", "velocity_iterations") if name in counts]
    return [counts.get("steps", len(run.series["time"]) - 1), counts.get("evaluations", math.nan),
            sum(iterations) if iterations else math.nan, sum(kernels) if kernels else math.nan,
            outcome.processor_seconds]


def loaded(outcome):
    """Returns the results of a run, or None if it ended before it had any."""
    try:
        return tanktread.Run(outcome.directory)
    except tanktread.Mistake:
        return None


class Comparison:
    """Compares the outcomes of one deck. `failed` is true if a difference is neither within the tolerance nor
    allowed."""

    def __init__(self, name, ranks, outcomes, arguments, named):
        self.name, self.ranks, self.remarks, found = name, ranks, [], {}
        runs = [loaded(outcome) for outcome in outcomes]
        self.work = [work_of(*pair) for pair in zip(outcomes, runs)]
        codes = ["time limit" if outcome.code is None else outcome.code for outcome in outcomes]
        if codes[0] != codes[1] or bool(runs[0]) != bool(runs[1]):
            found["exit code"] = math.inf
        if any(codes):
            self.remarks.append(f"exit codes {codes[0]} and {codes[1]}")
        if all(runs):
            series, remark = (exact_differences(*runs), "") if arguments.exact else differences_of(*runs)
            found |= series
            met = [{one["name"] for one in (run.summary or {}).get("expect") or [] if one["passed"]} for run in runs]
            found |= {f"Expect/{key}": math.inf for key in met[0] - met[1]}
            self.remarks += [remark] * bool(remark) + [f"Expect/{key} is met now" for key in sorted(met[1] - met[0])]
        failures = {}
        for series, difference in found.items():
            entry = next((one for one in named if fnmatch.fnmatch(name, one["deck"])
                          and fnmatch.fnmatch(series, one["series"])), {})
            if difference > float(entry.get("tolerance", arguments.tolerance)):
                failures[series] = difference
            elif difference > arguments.tolerance and entry["reason"] not in self.remarks:
                self.remarks.append(entry["reason"])
        self.remarks += [f"**{len(failures)} of {len(found)} series differ**"] * bool(failures)
        self.failed = bool(failures)
        self.worst = max((failures or found).items(), key=lambda item: (item[1], item[0]), default=("", 0.0))

    def ratio(self, k):
        """Returns new/old of the entry k of `work`; NaN if the old one is 0 or one is unknown."""
        return self.work[1][k] / self.work[0][k] if self.work[0][k] else math.nan

    def row(self):
        numbers = [f"{self.work[role][k]:.0f}" for k in (STEPS, EVALUATIONS) for role in (0, 1)]
        numbers += [f"{self.ratio(k):.3f}" for k in (EVALUATIONS, ITERATIONS, KERNELS, SECONDS)]
        numbers = ["" if one == "nan" else one for one in numbers]
        series = self.worst[0] if self.worst[1] else ""
        return [f"`{self.name}`", series, f"{self.worst[1]:.1e}", *numbers, "; ".join(self.remarks)]


def totals(comparisons):
    """Returns a line with the sums of evaluations and of seconds, and the deck with the largest ratio of each."""
    words = []
    one_rank = [one for one in comparisons if one.ranks == 1]  # processor seconds of several ranks include busy waiting
    for what, k, measured in (("velocity evaluations", EVALUATIONS, comparisons),
                              ("processor seconds on one rank", SECONDS, one_rank)):
        known = [one for one in measured if one.work[0][k] > 0 and one.work[1][k] > 0]
        if known:
            old, new = (sum(one.work[role][k] for one in known) for role in (0, 1))
            # runs below 1 are mostly noise
            top = max([one for one in known if one.work[0][k] >= 1] or known, key=lambda one: one.ratio(k))
            words.append(f"{what} {old:.0f} and {new:.0f}, ratio {new / old:.3f}, largest {top.ratio(k):.3f} "
                         f"(`{top.name}`)")
    return f"\n{len(comparisons)} decks: " + "; ".join(words)


def without_thresholds(study, paths, settings, ranks):
    """Returns the settings of a comparison of the algebra: `settings` of the shipped run, and those that a deck allows
    of ten fixed steps, exact far sums and solves, and no adaptation."""
    with contextlib.suppress(tanktread.Mistake, KeyError, ValueError):  # without results or steps, the deck has no time
        steps = study.run(paths, settings, ranks).run.series["time_step"]
        step = float(steps[steps > 0].min())
        settings = settings | {"Time/fixed step": step, "Time/final time": 10 * step, "Output/interval": 10 * step}
    for key, value in (("Quadrature/far sum", "dense"), ("Solvers/tolerance", 1e-12), ("Adaptation/enabled", False),
                       ("Particles/defaults/Adaptation/enabled", False)):
        more = settings | {key: value}
        words = [f"--set={name}={json.dumps(given)}" for name, given in more.items()]
        if subprocess.run([study.program, *paths, *words, "--check"], capture_output=True, check=False).returncode != 2:
            settings = more
    return settings


def pairs_of(arguments, decks):
    """Yields (name, ranks, outcomes of the old and the new program) of each deck; decks on two ranks last."""
    studies = [study_of(program, role, arguments) for program, role in zip(arguments.programs, ("old", "new"))]
    settings = {name: SHORTER.get(name, {}) for name in decks}
    if arguments.without_thresholds:
        for name in arguments.decks or decks:
            settings[name] = without_thresholds(studies[0], *decks[name][:1], settings[name], decks[name][1])
    for several_ranks in False, True:
        names = [name for name in arguments.decks or decks if (decks[name][1] > 1) == several_ranks]
        with concurrent.futures.ThreadPoolExecutor(max(1, arguments.jobs // (1 + several_ranks))) as pool:
            pairs = [[pool.submit(study.run, decks[name][0], settings[name], decks[name][1])
                      for study in studies] for name in names]
            for name, pair in zip(names, pairs):
                yield name, decks[name][1], [future.result() for future in pair]


def main():
    parser = command_line(__doc__)
    parser.add_argument("programs", nargs=2, metavar="PROGRAM", help="the old and the new program")
    parser.add_argument("--decks", nargs="+", metavar="NAME", help="names of decks (default: all)")
    parser.add_argument("--jobs", type=int, default=2, help="number of simultaneous runs (default: %(default)s)")
    parser.add_argument("--output", default="results/compare", metavar="DIR",
                        help="directory of the results (default: %(default)s)")
    parser.add_argument("--tolerance", type=float, default=1e-9,
                        help="largest difference that passes (default: %(default)s)")
    parser.add_argument("--without-thresholds", action="store_true", help="compare ten fixed steps with exact sums and solves")
    parser.add_argument("--exact", action="store_true", help="require the same bits, also of snapshots")
    parser.add_argument("--threads", type=int, nargs=2, metavar="N", help="numbers of threads of the two programs")
    parser.add_argument("--differences", metavar="FILE", help="YAML list of differences that are allowed")
    parser.add_argument("--limit", type=float, default=300, metavar="SECONDS",
                        help="largest processor time of a run (default: %(default)s)")
    parser.add_argument("--fresh", action="store_true", help="repeat the runs of an earlier comparison")
    arguments = parser.parse_args()
    named = yaml.safe_load(pathlib.Path(arguments.differences).read_text()) or [] if arguments.differences else []
    decks, comparisons = all_decks(), []
    if unknown := set(arguments.decks or []) - decks.keys():
        sys.exit(f"there is no deck {', '.join(sorted(unknown))}; choose from {', '.join(decks)}")

    def rows():
        for name, ranks, outcomes in pairs_of(arguments, decks):
            comparisons.append(Comparison(name, ranks, outcomes, arguments, named))
            yield comparisons[-1].row()

    table(["deck", "worst series", "difference", "steps", "new", "evaluations", "new", "ratio", "iterations", "kernels",
           "seconds", "remarks"], rows())
    print(totals(comparisons))
    if failed := [one.name for one in comparisons if one.failed]:
        sys.exit(f"{len(failed)} decks differ: {', '.join(failed)}")


if __name__ == "__main__":
    main()
