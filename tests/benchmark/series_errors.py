#!/usr/bin/python3
"""Prints the error of each series at default keys over nine scenes, as a Markdown table.

    tests/benchmark/series_errors.py [--scenes NAME ...] [--jobs 2] [--output DIR]

Each scene is run with the defaults of Surface/elements per side (6), Time/tolerance and Quadrature/tolerance (1e-4) and
the elements of tubes. It is compared with a finer run. The finer run has twice as many elements in each direction on
particles and walls and a tenth of each tolerance, including that of mesh refinement. Its steps are at most 1/200 of the
time. The error is the largest |difference| over the rows of the first run, divided by the largest absolute value of the
finer run. The finer run is interpolated to each row by a cubic polynomial and by a straight line, and the smaller
difference counts. The straight line is better where a series jumps.

For several particles, the largest error of a series over all particles is printed. Series that count work or estimate
errors are left out. Series below 1/1000 of their natural unit are left out too; most of them are 0 by symmetry. An
entry is empty if the scene does not have the series or the error is below 1e-9. Results are kept in DIR and are not
computed again.
"""

import sys

from compare import WORK, natural_unit
from package import INPUTS, SIDE, answer, command_line, expect, interpolation, numpy, scenes_of, studies, table
from power_balance import MESHES, finer

DEFAULTS = {SIDE: 6, "Time/tolerance": 1e-4, "Quadrature/tolerance": 1e-4}
SCENES = scenes_of(__file__)
# Series that are no results: times, work, step sizes, numbers of points and particles, positions of gaps, which jump
# between gaps of equal width, and estimates of errors, whose exact value is 0.
LEFT_OUT = WORK | {"time", "time_step", "step_error", "n_control_points", "particle_at_wall", "first_of_gap",
                   "second_of_gap", "gap_x1", "gap_x2", "gap_x3", "volume_error", "refit_error", "disturbance_flux",
                   "force_imbalance", "cap_velocity"}
TOLERANCES = {"Time": "tolerance", "Quadrature": "tolerance", "Adaptation": "surface tolerance"}


def refined(section, key, value):
    """Returns the value of a key in the finer run; None if the finer run uses the same value."""
    return 2 * value if key in MESHES else value / 10 if TOLERANCES.get(section) == key else None


def at_times(times, values, wanted, points):
    """Returns a series at the given times, by polynomials through `points` rows at which it is defined. The result is
    NaN outside the range of these rows."""
    defined = ~numpy.isnan(values)
    times, values = times[defined], values[defined]
    found = numpy.full(len(wanted), numpy.nan)
    if len(times):
        inside = (wanted >= times[0]) & (wanted <= times[-1])
        found[inside] = interpolation.interpolated(times, values, wanted[inside], points)
    return found


def change(times, values, fine_times, fine_values, name):
    """Returns the largest difference over the rows of a run at which both series are defined, or NaN."""
    if name == "inclination":
        defined = ~numpy.isnan(fine_values)
        fine_values = fine_values.copy()
        fine_values[defined] = numpy.unwrap(fine_values[defined], period=180)
    found = numpy.min([abs(values - at_times(fine_times, fine_values, times, points)) for points in (4, 2)], axis=0)
    if name == "inclination":
        found = abs((found + 90) % 180 - 90)  # -90 and 90 degrees are the same direction
    return numpy.nanmax(found) if not numpy.isnan(found).all() else numpy.nan


def errors(first, fine):
    """Returns {series: relative error} of a scene, the largest over its particles."""
    found: dict = {}
    for name, values in first.series.items():
        base, exact = name.rsplit("/", 1)[-1], fine.series[name]
        size = numpy.max(abs(exact), initial=0, where=numpy.isfinite(exact))
        if base in LEFT_OUT or fine.units[name] == "s" or size < 1e-3 * natural_unit(fine.units[name], fine):
            continue
        error = change(first.series["time"], values, fine.series["time"], exact, base) / size
        found[base] = numpy.fmax(error, found.get(base, numpy.nan))
    return found


def errors_of(study, name):
    """Makes the two runs of a scene and returns its errors."""
    deck = INPUTS / f"{SCENES[name]['deck']}.yaml"
    surface = "Particles/defaults/Surface" if "\n  Particles:" in deck.read_text() else "Surface"
    base, runs = {key.replace("Surface", surface): value for key, value in DEFAULTS.items()} | SCENES[name]["set"], []
    for _ in range(2):
        outcome = study.run(deck, base)
        expect(outcome.done, f"{name}: {outcome.message}")
        print(f"{name}: {outcome.command} took {outcome.processor_seconds:.1f} processor seconds", file=sys.stderr)
        runs.append(outcome.run)
        base |= finer(runs[0].deck, refined) | {"Time/maximum step": outcome.end / 200}
    return errors(*runs)


def text(number):
    return "" if not number >= 1e-9 else f"{number:.0e}".replace("e-0", "e-").replace("e+00", "")


def main():
    parser = command_line(__doc__)
    parser.add_argument("--scenes", nargs="+", choices=SCENES, default=list(SCENES), help="scenes (default: all)")
    studies.arguments(parser, "results/series_errors", limit=1800, jobs=2)
    parsed = parser.parse_args()
    study = studies.study(parsed)
    found = study.map(lambda name: errors_of(study, name), parsed.scenes)
    names = dict.fromkeys(series for one in found for series in one)
    rows = {series: [one.get(series, numpy.nan) for one in found] for series in names}
    table(["series", *parsed.scenes], ([f"`{series}`", *map(text, row)] for series, row in sorted(
        rows.items(), key=lambda item: -numpy.nanmax(item[1])) if any(map(text, row))))


if __name__ == "__main__":
    answer(main)
