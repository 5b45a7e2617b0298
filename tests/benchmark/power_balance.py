#!/usr/bin/python3
"""The balance of power (6.13) on every row of every deck of inputs/: the largest share of the row's power that is left over, and what makes it fall.

    tests/benchmark/power_balance.py [deck ...]

Each deck as it is, to the short end times below where it is long; where more than 1e-4 is left over again with Time/tolerance and Quadrature/tolerance a
tenth, and with 3/2 of the elements of particles and walls as well. Where nothing takes power, in a spherical membrane with a tension and in what has come to rest, what the
mesh leaves over has nothing to be a share of: rows of less than a hundredth of the run's largest power have their share of that hundredth. Prints a table;
decks without the series with the sentence that says why. A run is made once, under results/power_balance.
"""
import argparse
import pathlib
import sys

import yaml

SOURCE = pathlib.Path(__file__).resolve().parents[2]
import package  # noqa: E402, F401 before the package tanktread
import numpy  # noqa: E402

import tanktread  # noqa: E402

ENDS = {"suspension": 0.4, "sheared_suspension": 0.4, "capsule_stuck": 30, "capsule_capillary": 2, "capsule_cylinder": 2, "capsule_lifted_from_wall": 4,
        "shear_paper": 1, "capsule_step": 2, "capsule_expansion": 3, "capsule_bend": 2, "red_cell_treading": 0.02, "viscous_membrane": 4,
        "hyperbolic_skalak_ca0.8": 3, "drop_four_roll": 4, "capsule_constriction": 1, "shear_neo_hookean_ca0.6": 6, "shear_neo_hookean_ca0.45": 6,
        "oscillating_shear": 2, "capsule_treading": 2}

MESHES = {"elements per side", "azimuthal elements", "meridional elements", "axial elements"}


def refined(deck, path=()):
    """{key: 3/2 of the elements} for every mesh, of particles and walls, that a deck gives by its elements."""
    found = {}
    for key, value in deck.items():
        if isinstance(value, dict):
            found |= refined(value, (*path, key))
        elif key in MESHES:
            found["/".join((*path, key))] = round(1.5 * value)
    return found


def left_over(outcome):
    """The largest share of a row's power that is left over, when, the root of the mean square, and rows; None without any power."""
    series = outcome.series
    flow, forces, fluids = (series[name] for name in ("flow_power", "force_power", "fluid_dissipation"))
    power = (abs(flow) + abs(forces) + abs(fluids) + abs(flow + forces - fluids)) / 2
    if not power.max() > 0:
        return None
    share = numpy.abs(series["power_residual"]) * power / numpy.maximum(power, 0.01 * power.max())
    return share.max(), series["time"][share.argmax()], numpy.sqrt((share**2).mean()), len(share)


def row(study, name):
    path = SOURCE / "inputs" / f"{name}.yaml"
    deck = yaml.safe_load(path.read_text())["Tanktread"]
    base = {"Output/power balance": True} | ({"Time/final time": ENDS[name]} if name in ENDS else {})
    first = study.run(path, base)
    if first.refused or not (first.directory / "run.h5").exists():
        return f"| `{name}` | | {first.message.removeprefix('tanktread: ')} | | | | |"
    shares = [left_over(first)]
    if shares[0] and shares[0][0] > 1e-4:
        effective = tanktread.Run(first.directory)
        finer = base | {key: float(effective.value(key, 1e-4)) / 10 for key in ("Time/tolerance", "Quadrature/tolerance")}
        shares += [left_over(study.run(path, finer)), left_over(study.run(path, finer | refined(deck))) if refined(deck) else None]
    shares += [None] * (3 - len(shares))
    words = [f"{one[0]:.1e}" if one else "" for one in shares]
    of_first = f"{shares[0][3]} | {words[0]} | {shares[0][1]:.3g} | {shares[0][2]:.1e}" if shares[0] else "| no power | | "
    return f"| `{name}` | {of_first} | {words[1]} | {words[2]} |"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("decks", nargs="*", help="their names (default: all)")
    parser.add_argument("--output", default="results/power_balance", help="where runs stand (default: %(default)s)")
    parser.add_argument("--limit", type=float, default=600, metavar="SECONDS", help="of processor time of a run (default: %(default)s)")
    arguments = parser.parse_args()
    study = tanktread.Study(directory=arguments.output, limit=arguments.limit)
    titles = "| deck | rows | largest share | at time | root mean square | tolerances a tenth | and 3/2 of the elements |"
    print(titles + "\n" + "|---" * (titles.count("|") - 1) + "|")
    for name in arguments.decks or sorted(path.stem for path in (SOURCE / "inputs").glob("*.yaml")):
        print(row(study, name), flush=True)


if __name__ == "__main__":
    main()
