#!/usr/bin/python3
"""Prints the error of each series at default keys over nine scenes, as a Markdown table.

    tests/benchmark/series_errors.py [--scenes NAME ...] [--jobs 2] [--output DIR]

Each scene is run with the defaults of Surface/elements per side (6), Time/tolerance and Quadrature/tolerance (1e-4), and of the elements
of tubes. The finer run has twice as many elements along each direction of particles and walls, and a tenth of each tolerance, that of
refinement included; its steps are at most 1/200 of the time. The error is the largest |difference| over the rows of the first run,
divided by the largest absolute value of the finer one. The finer run is interpolated to each of these rows by a cubic and by a straight
line, which is better where a series jumps, and the smaller difference counts.

Series of several particles are taken together. Those that count work, estimate errors or are below 1/1000 of their natural unit (most of
them are 0 by symmetry) are left out. An entry is empty if the scene lacks the series or the error is below 1e-9. Results are kept in DIR
and are found again.
"""
import argparse
import pathlib
import sys

SOURCE = pathlib.Path(__file__).resolve().parents[2]
import package  # noqa: E402, F401 before the package tanktread
import numpy  # noqa: E402

from tanktread import interpolation  # noqa: E402
import tanktread  # noqa: E402
from compare import WORK, natural_unit  # noqa: E402
from power_balance import MESHES  # noqa: E402

DEFAULTS = {"Surface/elements per side": 6, "Time/tolerance": 1e-4, "Quadrature/tolerance": 1e-4}
SCENES = {  # name: (deck, settings in addition to DEFAULTS)
    "capsule in shear": ("shear_neo_hookean", {}),
    "viscosity ratio 5": ("shear_neo_hookean", {"Particle/viscosity ratio": 5}),
    "with bending": ("shear_bending", {}),
    "shear to and fro": ("oscillating_shear", {}),
    "refined capsule": ("hyperbolic_skalak", {}),
    "red cell": ("red_cell_si", {}),
    "drop": ("drop_uniaxial", {}),
    "capsule in tube": ("capsule_in_tube", {}),
    "lattice": ("sheared_lattice", {}),
}

# Series that are no results: times, work, step sizes, numbers of points and particles, positions of gaps, which jump between gaps of equal
# width, and estimates of errors, whose exact value is 0.
LEFT_OUT = WORK | {"time", "time_step", "step_error", "n_control_points", "particle_at_wall", "first_of_gap", "second_of_gap",
                   "gap_x1", "gap_x2", "gap_x3", "volume_error", "refit_error", "disturbance_flux", "force_imbalance", "cap_velocity"}
TOLERANCES = {"Time": "tolerance", "Quadrature": "tolerance", "Adaptation": "surface tolerance"}


def defaults_for(deck):
    """Returns DEFAULTS by the paths that a deck has them at: several particles have their surface in Particles/defaults."""
    surface = "Particles/defaults/Surface" if "\n  Particles:" in deck.read_text() else "Surface"
    return {key.replace("Surface", surface): value for key, value in DEFAULTS.items()}


def refined(deck, path=()):
    """Returns the settings of the finer run, from the effective deck of the first one."""
    found = {}
    for key, value in deck.items():
        if isinstance(value, dict):
            found |= refined(value, (*path, key))
        elif key in MESHES:
            found["/".join((*path, key))] = 2 * value
        elif path and TOLERANCES.get(path[-1]) == key:
            found["/".join((*path, key))] = value / 10
    return found


def at_times(times, values, wanted, name, points):
    """Returns a series at other times, by polynomials through this many rows where it is defined. Times outside these rows give NaN."""
    defined = ~numpy.isnan(values)
    times, values = times[defined], values[defined]
    if name == "inclination":
        values = numpy.unwrap(values, period=180)
    found = numpy.full(len(wanted), numpy.nan)
    if len(times):
        inside = (wanted >= times[0]) & (wanted <= times[-1])
        found[inside] = interpolation.interpolated(times, values, wanted[inside], points)
    return found


def change(times, values, fine_times, fine_values, name):
    """Returns the largest difference over the rows of a run at which both series are defined, or NaN."""
    difference = numpy.min([numpy.abs(values - at_times(fine_times, fine_values, times, name, points)) for points in (4, 2)], axis=0)
    if name == "inclination":
        difference = numpy.abs((difference + 90) % 180 - 90)  # -90 and 90 degrees are the same direction
    return numpy.max(difference, initial=0, where=~numpy.isnan(difference)) if not numpy.isnan(difference).all() else numpy.nan


def errors(first, fine):
    """Returns {series: relative error} of a scene, the largest over its particles."""
    found = {}
    t, u = first.series["time"], fine.series["time"]
    for name in first.series:
        base = name.rsplit("/", 1)[-1]
        values, size = fine.series[name], numpy.max(numpy.abs(fine.series[name]), initial=0, where=numpy.isfinite(fine.series[name]))
        if base in LEFT_OUT or fine.units[name] == "s" or size < 1e-3 * natural_unit(fine.units[name], fine):
            continue
        found[base] = numpy.fmax(change(t, first.series[name], u, values, base) / size, found.get(base, numpy.nan))
    return found


def text(number):
    return "" if not number >= 1e-9 else f"{number:.0e}".replace("e-0", "e-").replace("e+00", "")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", nargs="+", choices=SCENES, default=list(SCENES), metavar="NAME", help="(default: all)")
    parser.add_argument("--jobs", type=int, default=2, help="runs at a time (default: %(default)s)")
    parser.add_argument("--output", default="results/series_errors", metavar="DIR", help="directory of the results (default: %(default)s)")
    parser.add_argument("--limit", type=float, default=1800, metavar="SECONDS", help="processor time of a run (default: %(default)s)")
    arguments = parser.parse_args()
    study = tanktread.Study(directory=arguments.output, limit=arguments.limit, jobs=arguments.jobs)

    def runs_of(name):
        deck = SOURCE / "inputs" / f"{SCENES[name][0]}.yaml"
        base, outcomes = defaults_for(deck) | SCENES[name][1], []
        for settings in lambda: base, lambda: base | refined(outcomes[0].run.deck) | {"Time/maximum step": outcomes[0].end / 200}:
            outcomes.append(study.run(deck, settings()))
            if not outcomes[-1].done:
                sys.exit(f"{name}: {outcomes[-1].message}")
            print(f"{name}: {outcomes[-1].command} took {outcomes[-1].processor_seconds:.1f} processor seconds", file=sys.stderr)
        return errors(outcomes[0].run, outcomes[1].run)

    found = study.map(runs_of, arguments.scenes)
    names = dict.fromkeys(series for one in found for series in one)
    rows = {series: [one.get(series, numpy.nan) for one in found] for series in names}
    print("| series | " + " | ".join(arguments.scenes) + " |\n|---" + "|---" * len(found) + "|")
    for series, row in sorted(rows.items(), key=lambda item: -numpy.nanmax(item[1])):
        if any(map(text, row)):
            print(f"| `{series}` | " + " | ".join(map(text, row)) + " |")


if __name__ == "__main__":
    main()
