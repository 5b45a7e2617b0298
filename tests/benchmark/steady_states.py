#!/usr/bin/python3
"""Steady states of decks that end steady in time, by runs in time and by Steady: what they differ by, and velocity evaluations of each.

    tests/benchmark/steady_states.py build/release/app/tanktread [deck ...]

On the deck's first mesh. A run in time goes on until `shape_velocity` is 1e-6, with the deck's time tolerance and with 1e-7, which the value is of.
Where membranes tread or labels turn, the mesh lies elsewhere by then; `Steady` that starts from the end of the run has the same labels.
Prints a table.
"""
import pathlib
import subprocess
import sys
import tempfile

import yaml

from solvers import INPUTS

# decks, and the series that is compared
SCENES = {
    "drop_uniaxial": "taylor_surface",
    "drop_four_roll": "taylor_surface",
    "uniaxial_extension": "taylor_surface",
    "hyperbolic_skalak": "taylor_surface",
    "hyperbolic_skalak_ca0.45": "taylor_surface",
    "hyperbolic_skalak_ca0.8": "taylor_surface",
    "shear_neo_hookean": "taylor_surface",
    "capsule_in_tube": "velocity_x1",
}
UNTIL = {"final time": 100.0, "steady tolerance": 1e-6}


def final(program, deck, results):
    path = results.with_suffix(".yaml")
    path.write_text(yaml.safe_dump({"Tanktread": deck}))
    said = subprocess.run([program, path, "--output", results, "--quiet"], capture_output=True, text=True)
    summary = results / "summary.yaml"
    if said.returncode or not summary.exists():
        return None, (said.stderr.splitlines() or ["nothing was found"])[-1]
    return yaml.safe_load(summary.read_text())["final"], None


def row(program, name):
    series = SCENES.get(name, "taylor_surface")
    deck = yaml.safe_load((INPUTS / f"{name}.yaml").read_text())["Tanktread"]
    for section in "Expect", "Output", "Adaptation":
        deck.pop(section, None)
    time = deck.pop("Time") | UNTIL
    search = {"Steady": {"tolerance": 1e-8}}
    with tempfile.TemporaryDirectory() as folder:
        names = [pathlib.Path(folder) / name for name in ("steady", "in_time", "tight", "after")]
        after = deck | search | {"Particle": deck.get("Particle", {}) | {"initial shape": {"run": str(names[2])}}}
        decks = [deck | search, deck | {"Time": time}, deck | {"Time": time | {"tolerance": 1e-7}}, after]
        found = [final(program, one, name) for one, name in zip(decks, names)]
    if lost := [why for one, why in found if one is None]:
        return f"| `{name}` | {series} | {lost[0]} | | | | | | |"
    rest, plain, tight, after = (one for one, _ in found)
    counts = [int(one["evaluations"]) for one in (rest, plain, tight)]
    return (f"| `{name}` | {series} | {rest[series]:.7f} | {abs(rest[series] - tight[series]):.1e} | {abs(after[series] - tight[series]):.1e} | "
            f"{counts[0]} | {counts[1]} | {counts[2]} | {counts[1] / counts[0]:.1f} |")


def main():
    program, *names = sys.argv[1:]
    titles = "| deck | series | `Steady` | in time, off by | the same labels | evaluations | in time | in time, 1e-7 | ratio of the first two |"
    print(titles + "\n" + "|---" * (titles.count("|") - 1) + "|")
    for name in names or SCENES:
        print(row(program, name), flush=True)


if __name__ == "__main__":
    main()
