#!/usr/bin/python3
"""Prints the residual of the power balance for every deck of inputs/, and how it decreases with refinement.

    tests/benchmark/power_balance.py [deck ...]

The power balance is (6.13) in lib/README.md. Its residual in a row of the series is divided by the power of the row:
half the sum of the magnitudes of all terms. If this power is less than a hundredth of the largest power of the run, the
residual is divided by that hundredth. This is the case if nothing moves, for example for a spherical membrane with a
tension, where only the discretisation error is left.

Each deck is run as it is; long decks are run to the shorter final times in scenes/power_balance.yaml. If the largest
residual exceeds 1e-4, the deck is run again with a tenth of Time/tolerance and Quadrature/tolerance, and once more with
3/2 times as many elements of particles and walls in addition. For decks without the series of the power, the table has
the message of the program. Runs are kept under results/power_balance.
"""

from package import INPUTS, answer, command_line, numpy, scenes_of, table, tanktread, yaml

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
    """Returns the largest residual of a row divided by its power, its time, the root mean square over the rows, and the
    number of rows; None if there is no power."""
    series = outcome.series
    flow, forces, fluids = (series[name] for name in ("flow_power", "force_power", "fluid_dissipation"))
    power = (abs(flow) + abs(forces) + abs(fluids) + abs(flow + forces - fluids)) / 2
    if not power.max() > 0:
        return None
    share = abs(numpy.nan_to_num(series["power_residual"])) * power / numpy.maximum(power, 0.01 * power.max())
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
    parser = command_line(__doc__)
    parser.add_argument("decks", nargs="*", metavar="deck", help="names of decks of inputs/ (default: all)")
    study = tanktread.Study(directory="results/power_balance", limit=600)
    names = parser.parse_args().decks or sorted(path.stem for path in INPUTS.glob("*.yaml"))
    table(["deck", "rows", "largest residual / power", "at time", "root mean square", "tolerances / 10",
           "and elements x 3/2"], (row(study, name) for name in names))


if __name__ == "__main__":
    answer(main)
