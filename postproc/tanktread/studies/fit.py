"""From an experiment to moduli with error bars: unknown keys of a deck by weighted least squares from outlines,
lengths, velocities or curves.

    tanktread-fit inputs/studies/experiment.yaml      # results/experiment/fit.txt, fit.yaml, fit.png

An experiment is a YAML file: `deck` (one, or several that overlay each other), `set` (keys of all runs), `unknown`,
`laws` and `experiments`; inputs/studies/experiment.yaml is an example.

    unknown: {Membrane/shear modulus: {start: 1}}
        from, to: bounds; known, error: a value known beforehand; spacing: linear for what may be negative
    laws: {skalak: {Membrane/law: Skalak, unknown: {…}}}
        each is fitted and compared with the others; its own unknowns are added or start elsewhere
    experiments: {slow: {set: {…}, unknown: {…}, data: [datum, …]}}
        each is a run, with unknowns of its own. Values may have units if the deck has the section Units;
        start, from, to, known and what is found are numbers in the deck's units
    datum: {outline: points.csv, error: 0.5, scale: 0.01}
        the edge as seen along x2: columns x1, x3 in the picture's unit, its error in that unit (or a third column, as
        tanktread-outline writes it); the flow goes to the right; plane: [x1, x3]; scale: the deck's length per unit;
        scale error: its relative error, or free; at: time of the snapshot (default: the last)
    datum: {series: velocity_x1, value: 1.2, error: 0.01}
        the last value of a series, or at: time
    datum: {series: taylor_inertia, curve: relaxation.csv}
        columns time, value and, if `error` does not give it, error; over: length_x2 divides by another series;
        origin: free if the curve's time does not start with the run's
    next: {Flow/mean velocity: [1, 2, 4]}
        settings of a further experiment with data like the first one's: which would determine most

The position of an outline in its picture is free. Derivatives are differences of runs, made side by side: one per step
for each unknown key and experiment, none for positions and scales. Runs are kept and found again if all their keys are
equal, so it is best to leave a `start` as it was. Standard errors follow from those of the data and, if the deck
requests an accuracy, from the estimated errors of the series. A quantity known with an error belongs under `unknown`,
such as Flow/viscosity: {known: 0.97, error: 0.01}. If chi square is too large for the errors of the data, errors that
the residuals give are printed too; a mesh that is too coarse for the data is the first suspect.
"""

import os
import pathlib

import yaml

from ..figures import style
from ..mistakes import command_line, expect, log, progress
from ..runs import Study
from .common import keys_of, number, optional, study_of
from .fit_data import Experiment, Unknown
from .fit_model import Fit, Runs
from .fit_report import draw, further, told

def load(path, study):
    """Returns the fits of all laws, not yet solved, and the content of the file."""
    text = study_of(path, {"set", "unknown", "laws", "experiments", "next"}, {"limit"})
    study.limit = optional(number, text, "limit", path)
    expect(text["experiments"], f"{path} has no experiments")
    laws = {law: keys_of(settings, f"{path}: the law {law}") for law, settings in text["laws"].items()}
    experiments = [Experiment(name, given, pathlib.Path(path).parent) for name, given in text["experiments"].items()]
    for key, values in text["next"].items():
        expect(isinstance(values, list) and values, f"{path}: next, {key} must be a list of values, but is {values}")
    fits = []
    for law, settings in (laws or {"the deck's law": {}}).items():
        settings = text["set"] | settings
        unknowns = text["unknown"] | keys_of(settings.pop("unknown", None), f"{path}: {law}, unknown")
        unknowns = [Unknown(key, given) for key, given in unknowns.items()]
        fits.append(Fit(law, settings, unknowns, experiments, Runs(study, text["deck"], law)))
        expect(fits[-1].unknowns, f"{path}: nothing is unknown")
    return fits, text


def run(path, directory=None, jobs=None, laws=None):
    """Fits the laws of an experiment file, writes fit.txt, fit.yaml and fit.png, and returns the Fits, the best first.
    `directory`: of these and runs/ (default: results/<experiment>). `jobs`: runs at a time (default: the number of
    cores). `laws`: names of the laws that are fitted (default: all)."""
    directory = pathlib.Path(directory or f"results/{pathlib.Path(path).stem}")
    fits, text = load(path, Study(directory=directory / "runs", jobs=jobs or os.cpu_count()))
    known = [fit.law for fit in fits]
    expect(set(laws or known) <= set(known), f"there is no such law; there are: {', '.join(known)}")
    fits = [fit for fit in fits if fit.law in (laws or known)]
    for fit in fits:
        n = len(fit.experiments)
        moved = sum(one.owner in (None, experiment.name) for one in fit.unknowns for experiment in fit.experiments)
        progress(f"{fit.law}: {n} runs to start with, then some {moved + n} a step, for 3 to 10 steps as a rule")
        fit.solve()
    fits.sort(key=lambda fit: fit.aic)
    said = told(fits, further(fits, text["next"]))
    progress("")
    log.info(said)
    (directory / "fit.txt").write_text(said + "\n", encoding="utf-8")
    record = {fit.law: {
        "chi square": fit.square, "degrees of freedom": int(fit.freedom), "AIC": float(fit.aic), "runs": fit.runs.count,
        "unknown": {name: dict(zip(("value", "error"), map(float, found))) for name, found in fit.values.items()}}
        for fit in fits}
    (directory / "fit.yaml").write_text(yaml.safe_dump(record, sort_keys=False), encoding="utf-8")
    style.save(style.draw(draw, fits), directory / "fit.png")
    return fits


def main():
    parser = command_line(__doc__)
    parser.add_argument("experiment", help="the experiment, a YAML file")
    parser.add_argument("--output", metavar="DIR", help="where results go (default: results/<experiment>)")
    parser.add_argument("--jobs", type=int, help="runs at a time (default: the number of cores)")
    parser.add_argument("--law", nargs="+", metavar="NAME", help="fit these laws only")
    arguments = parser.parse_args()
    run(arguments.experiment, arguments.output, arguments.jobs, arguments.law)
