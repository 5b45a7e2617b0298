#!/usr/bin/python3
"""The balance of power (6.13) on every row of every deck of inputs/: the largest share of the row's power that is left
over, and what makes it fall.

    tests/benchmark/power_balance.py [deck ...]

Each deck as it is, to the short end times below where it is long; where more than 1e-4 is left over again with
Time/tolerance and Quadrature/tolerance a tenth, and with 3/2 of the elements of particles and walls as well. Where
nothing takes power, in a spherical membrane with a tension and in what has come to rest, what the mesh leaves over has
nothing to be a share of: rows of less than a hundredth of the run's largest power have their share of that hundredth.
Prints a table; decks without the series with the sentence that says why. Runs are kept under results/power_balance.
"""

import sys

from package import INPUTS, answer, numpy, scenes_of, table, tanktread, yaml

ENDS = scenes_of(__file__)
MESHES = {"elements per side", "azimuthal elements", "meridional elements", "axial elements"}


def finer(deck, change, path=()):
    """Returns {path of a key: change(section, key, value)} for keys of a deck for which this is not None."""
    found = {}
    for key, value in deck.items():
        if isinstance(value, dict):
            found |= finer(value, change, (*path, key))
        elif (new := change(path[-1] if path else "", key, value)) is not None:
            found["/".join((*path, key))] = new
    return found


def left_over(outcome):
    """Returns the largest share of a row's power that is left over, when, the root of the mean square, and the number
    of rows; None without any power."""
    series = outcome.series
    flow, forces, fluids = (series[name] for name in ("flow_power", "force_power", "fluid_dissipation"))
    power = (abs(flow) + abs(forces) + abs(fluids) + abs(flow + forces - fluids)) / 2
    if not power.max() > 0:
        return None
    share = abs(series["power_residual"]) * power / numpy.maximum(power, 0.01 * power.max())
    return share.max(), series["time"][share.argmax()], numpy.sqrt((share**2).mean()), len(share)


def row(study, name):
    path = INPUTS / f"{name}.yaml"
    base = {"Output/power balance": True} | ({"Time/final time": ENDS[name]} if name in ENDS else {})
    first = study.run(path, base)
    if first.refused or not (first.directory / "run.h5").exists():
        return [f"`{name}`", "", first.message.removeprefix("tanktread: "), *[""] * 4]
    shares = [left_over(first)]
    if shares[0] and shares[0][0] > 1e-4:
        tight = base | {key: float(first.run.value(key, 1e-4)) / 10
                        for key in ("Time/tolerance", "Quadrature/tolerance")}
        mesh = finer(yaml.safe_load(path.read_text())["Tanktread"],
                     lambda _, key, value: round(1.5 * value) if key in MESHES else None)
        shares += [left_over(study.run(path, settings)) for settings in ([tight, tight | mesh] if mesh else [tight])]
    words = [f"{one[0]:.1e}" if one else "" for one in shares + [None] * 2]
    if not shares[0]:
        return [f"`{name}`", "", "no power", *[""] * 4]
    _, when, mean, rows = shares[0]
    return [f"`{name}`", rows, words[0], f"{when:.3g}", f"{mean:.1e}", *words[1:3]]


def main():
    study = tanktread.Study(directory="results/power_balance", limit=600)
    names = sys.argv[1:] or sorted(path.stem for path in INPUTS.glob("*.yaml"))
    table(["deck", "rows", "largest share", "at time", "root mean square", "tolerances a tenth",
           "and 3/2 of the elements"], (row(study, name) for name in names))


if __name__ == "__main__":
    answer(main)
