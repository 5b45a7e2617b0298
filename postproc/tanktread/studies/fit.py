"""Fits unknown keys of a deck, such as the moduli of a membrane, to an experiment by weighted least squares.

    tanktread-fit inputs/studies/experiment.yaml      # results/experiment/fit.txt, fit.yaml, fit.png

An experiment is described by a YAML file; inputs/studies/experiment.yaml is an example. Its keys are `deck` (one deck,
or several of which later ones override earlier ones), `set` (settings of all runs), `unknown`, `laws`, `experiments`
and `next`:

    unknown: {Membrane/shear modulus: {start: 1}}
        a key to fit, and its start value. Optional: `from` and `to` (bounds; by default a thousandth of the start and
        1000 times the start); `known` and `error` (a value known beforehand and its standard error); `spacing: linear`
        (for a quantity that may be negative; the default bounds are then 6.9 times the start below and above it)
    laws: {skalak: {Membrane/law: Skalak, unknown: {…}}}
        the settings of each law. All laws are fitted, and the fits are compared. `unknown` adds unknowns for this law,
        or changes their start values
    experiments: {slow: {set: {…}, unknown: {…}, data: [datum, …]}}
        each experiment is one run, or one run per value of a key (`against`). `unknown` lists unknowns of this
        experiment only. Values in `set` may have units if
        the deck has the section Units. start, from, to, known and the results are numbers in the deck's units
    datum: {outline: points.csv, error: 0.5, scale: 0.01}
        a table of points on the outline as seen along x2, with the columns x1, x3 (or x, y: the axes of the picture) in
        the unit of the picture. The flow goes to the right. error: standard error of a point in this unit (or a third
        column, as tanktread-outline writes it). scale: length in the deck's unit per unit of the picture. Optional:
        `plane: [x1, x3]` (coordinates of the two columns); `scale error` (relative error of the scale, or free); `at`
        (time of the snapshot, default: the last); `open: true` (the outline need not close)
    datum: {series: velocity_x1, value: 1.2, error: 0.01}
        a value at the end of a series. Optional: `at` (another time)
    datum: {series: taylor_inertia, curve: relaxation.csv}
        a file with the columns time, value and, if `error` is not given, standard error. Optional: `over: length_x2`
        (the data are the ratio of two series); `origin: free` (the curve's time has an unknown offset from the run's)
    datum: {series: taylor_inertia, curve: rates.csv, against: Flow/shear rate}
        a file whose first column holds values of a key: each row is a run with this value, and the second column is the
        last value of the series in this run (`at`: its value at another time). Rows with equal values share a run. A
        force-extension curve varies two keys, by multiples of the first column:
            against: {Membrane/forces/left/force: [-1, 0, 0], Membrane/forces/right/force: [1, 0, 0]}
    columns: [force, length, error]
        of any datum with a file: names or numbers (from 1) of its columns, if the file has others too. Columns may be
        separated by commas, semicolons, tabs or spaces. Values with units in the first line, such as `force [pN];
        length [um]`, are converted to the units of the deck, which must then have the section Units
    next: {Flow/mean velocity: [1, 2, 4]}
        settings of possible further experiments with the same kind of data as the first one. The standard errors that
        each of them would give are printed

The position of an outline in its picture is always fitted. Derivatives are finite differences: each step of the
iteration makes one run for each pair of an unknown and an experiment. Positions and scales need no runs. Runs are kept,
and they are found again if all their keys are equal. Therefore it is best not to change a `start`.

Either all data have errors or none. If none has, all data have the same weight, and standard errors follow from the
residuals; `known` values and scales with an error are then refused. Otherwise standard errors follow from the errors of
the data and, if the deck requests an accuracy, from the estimated errors of the series. If a key of the deck is a
measured value with an error, give it under `unknown`, for example Flow/viscosity: {known: 0.97, error: 0.01}. If chi
square is too large for the errors of the data, standard errors that follow from the residuals are printed too. The most
likely cause is a mesh that is too coarse for the data.

Two tests of the signs of the residuals are printed: whether signs change along the data as often as those of random
errors (runs test), and whether as many are positive as negative (exact binomial test). Runs that failed or gave no
outline or no value are listed. A fit that ends at the edge of a region where runs fail reports no value.
"""

import os
import pathlib

import yaml

from ..figures import style
from ..mistakes import command_line, expect, log, progress
from ..runs import Study
from . import reading
from .fit_data import Experiment, Unknown
from .fit_model import Fit, Runs
from .fit_report import draw, failed, further, told
from .reading import any_name, deck_key


KINDS = {"set": reading.SETTINGS, "unknown": {deck_key: reading.anything},
         "laws": {any_name: {deck_key: reading.setting, "unknown": {deck_key: reading.anything}}},
         "experiments": {any_name: reading.anything}, "next": {deck_key: [reading.setting]}, "limit": reading.positive}


def load(path, study):
    """Returns the fits of all laws, not yet solved, and the content of the file."""
    given = reading.study_of(path, KINDS)
    study.limit = given.get("limit")
    expect(given["experiments"], f"{path} has no experiments")
    for key, values in given["next"].items():
        expect(values, f"{path}: next: {key} has no values")
    experiments = [Experiment(name, one, pathlib.Path(path).parent) for name, one in given["experiments"].items()]
    fits = []
    for law, settings in (given["laws"] or {"the deck's law": {}}).items():
        unknowns = given["unknown"] | settings.pop("unknown", {})
        unknowns = [Unknown(key, one) for key, one in unknowns.items()]
        fits.append(Fit(law, given["set"] | settings, unknowns, experiments, Runs(study, given["deck"], law)))
        expect(fits[-1].unknowns, f"{path}: nothing is unknown")
        check_settings(fits[-1], given["next"], path)
        check_errors(fits[-1])
    return fits, given


def check_settings(fit, further, path):
    """Raises Mistake if a setting of a fit or of a further experiment has no effect, because the key is unknown or its
    values are those of a table."""

    def varies(key, experiment):
        unknown = any(one.key == key and one.owner in (None, experiment.name) for one in fit.unknowns)
        return "is unknown" if unknown else "has the values of a table" if all(
            key in case for case in experiment.cases) else None

    for experiment in fit.experiments:
        for key in experiment.settings:
            expect(not varies(key, experiment), f"{path}: {experiment.name}: {key} is in `set`, but it "
                   f"{varies(key, experiment)}: remove it from one of the two")
        for one in fit.unknowns:
            expect(one.owner not in (None, experiment.name) or not any(one.key in case for case in experiment.cases),
                   f"{path}: {experiment.name}: {one.key} is unknown, but it has the values of a table")
    for key in fit.settings:
        expect(not all(varies(key, one) for one in fit.experiments), f"{path}: {key} is in `set` or in the law "
               f"{fit.law}, but it {varies(key, fit.experiments[0])} in all runs: remove it from one of the two")
    first = fit.experiments[0]
    for key in further:
        expect(varies(key, first) != "is unknown", f"{path}: next: {key} is unknown")
        for datum in first.data:
            against = getattr(datum, "against", None) or {}
            expect(key not in against or against == {key: 1}, f"{path}: next: {key} is one of the keys that vary in "
                   f"{datum.name}, and a single value cannot replace them: name another key")


def check_errors(fit):
    """Raises Mistake if only some of the data, known values and scales of a fit have errors: their residuals could not
    be weighted."""
    bare = [datum.name for datum in fit.data if datum.error is None]
    expect(len(bare) in (0, len(fit.data)),
           f"`error` is missing for {', '.join(bare)}, but other data have one: give it for all data or for none")
    given = [one.name for one in fit.unknowns if one.known is not None]
    given += [f"the scale of {datum.name}" for datum in fit.data if datum.length > datum.count]
    expect(fit.stated or not given,
           f"{', '.join(given)} has an error, but the data have none, so that they cannot be weighted: give `error` "
           "for all data")


def recorded(fit):
    """Returns {unknown: {value, error, unit, at bound}} for fit.yaml. `unit` is absent if the unknown is dimensionless
    or the deck has no section Units, and `at bound` if the value does not lie at a bound. If the fit ended at the edge
    of a region where runs fail, the value is NaN, the error infinite, and `edge` is the value there."""
    found = {}
    for unknown, number, bound, (name, (value, error)) in zip(fit.unknowns, fit.x, fit.at_bound, fit.values.items()):
        unit = fit.runs.unit(unknown.key).removeprefix(", ")
        found[name] = {"value": float(value), "error": float(error)} | ({"unit": unit} if unit else {})
        found[name] |= {"at bound": bound} if bound and not fit.edge else {}
        found[name] |= {"edge": unknown.value(number)} if fit.edge else {}
    return found


def run(path, directory=None, jobs=None, laws=None):
    """Fits the laws of an experiment file, writes fit.txt, fit.yaml and fit.png, and returns the Fits, the best first.
    `directory`: folder for these files and runs/ (default: results/<experiment>). `jobs`: number of simultaneous runs
    (default: the number of cores). `laws`: names of the laws that are fitted (default: all)."""
    directory = pathlib.Path(directory or f"results/{pathlib.Path(path).stem}")
    fits, given = load(path, Study(directory=directory / "runs", jobs=os.cpu_count() if jobs is None else jobs))
    known = [fit.law for fit in fits]
    expect(set(laws or known) <= set(known), f"there is no such law; there are: {', '.join(known)}")
    fits = [fit for fit in fits if fit.law in (laws or known)]
    for fit in fits:
        n = sum(len(experiment.cases) for experiment in fit.experiments)
        moved = sum(len(experiment.cases) for one in fit.unknowns for experiment in fit.experiments
                    if one.owner in (None, experiment.name))
        progress(f"{fit.law}: {n} runs to start with, then some {moved + n} a step, for 3 to 10 steps as a rule")
        fit.solve()
    fits.sort(key=lambda fit: (bool(fit.edge), fit.aic))
    said = told(fits, further([fit for fit in fits if not fit.edge], given["next"]))
    progress("")
    log.info(said)
    (directory / "fit.txt").write_text(said + "\n", encoding="utf-8")
    record = {fit.law: {
        "chi square": fit.square, "degrees of freedom": int(fit.freedom), "AIC": float(fit.aic), "runs": fit.runs.count,
        "unknown": recorded(fit)} | ({"failed runs": failed(fit)} if fit.runs.failures else {}) for fit in fits}
    (directory / "fit.yaml").write_text(yaml.safe_dump(record, sort_keys=False, allow_unicode=True), encoding="utf-8")
    style.save(style.draw(draw, fits), directory / "fit.png")
    return fits


def main():
    parser = command_line(__doc__)
    parser.add_argument("experiment", help="YAML file of the experiment")
    parser.add_argument("--output", metavar="DIR", help="directory of the results (default: results/<experiment>)")
    parser.add_argument("--jobs", type=int, help="number of simultaneous runs (default: the number of cores)")
    parser.add_argument("--law", nargs="+", metavar="NAME", help="fit these laws only")
    arguments = parser.parse_args()
    run(arguments.experiment, arguments.output, arguments.jobs, arguments.law)
