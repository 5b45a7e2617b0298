#!/usr/bin/python3
"""Compares the cost of finding steady shapes by several solvers and by simulations in time.

    tests/benchmark/steady.py solvers   # Newton's method by three Krylov solvers, preconditioners and two line searches
    tests/benchmark/steady.py states    # the same steady shapes by `Steady` and by simulations in time
    tests/benchmark/steady.py branch    # cost of a point on a branch around the fold of a drop

Each command prints a table of velocity evaluations. Runs are kept under results/steady.

`states` uses the initial mesh of each deck. A simulation in time ends when `shape_velocity` is 1e-6. It is made with
the time tolerance of the deck and with 1e-7; the differences in the table are from the latter. If the membrane
tank-treads or the material points rotate, the mesh of the simulation has moved along the surface, which changes the
discretisation error. Therefore `Steady` is also started from the end of the simulation; then both have the same mesh.

`branch` follows the branch of inputs/drop_branch.yaml from Ca = 0.1 to the fold and back, with collocation and without
the section Spectrum.
"""

import hashlib
import itertools
import pathlib

from package import INPUTS, SIDE, answer, command_line, expect, table, tanktread, yaml

FOLDER, KRYLOV = "results/steady", ["GMRES", "BICGSTAB", "TFQMR"]
SEARCHED = ["drop_steady", "capsule_steady"]
STATES = {"capsule_in_tube": "velocity_x1"} | dict.fromkeys(  # deck: series that is compared
    ("drop_uniaxial", "drop_four_roll", "uniaxial_extension", "hyperbolic_skalak", "hyperbolic_skalak_ca0.45",
     "hyperbolic_skalak_ca0.8", "shear_neo_hookean"), "taylor_surface")


def changed(deck, without=(), **sections):
    """Writes a copy of a deck of inputs/ without some sections and with others replaced, and returns its path."""
    content = {key: value for key, value in yaml.safe_load((INPUTS / f"{deck}.yaml").read_text())["Tanktread"].items()
               if key not in without}
    text = yaml.safe_dump({"Tanktread": content | sections})
    path = pathlib.Path(FOLDER) / "decks" / f"{deck}_{hashlib.sha1(text.encode()).hexdigest()[:8]}.yaml"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    return path.resolve()


def solvers(study):
    def evaluations(scene, settings):
        outcome = study.run(changed(scene, ("Spectrum", "Expect")), settings | {
            SIDE: 6, "Quadrature/tolerance": 1e-7, "Steady/iterations": 40})
        return outcome.counts["evaluations"] if outcome.done else "-"

    def newton(scene, preconditioner, search, krylov):
        return evaluations(scene, {"Steady/method": "newton-krylov", "Solvers/steady/iterative solver": krylov,
                                   "Solvers/steady/preconditioner": preconditioner,
                                   "Solvers/NOX/Line Search/Method": search})

    cases = itertools.product(SEARCHED, ("none", "own", "recycled"), ("Full Step", "Backtrack"))
    table(["scene", "preconditioner", "line search", *KRYLOV], itertools.chain(
        ([*case, *(newton(*case, krylov) for krylov in KRYLOV)] for case in cases),
        ([name, "Anderson's method", "", evaluations(name, {"Steady/method": "anderson"}), "", ""]
         for name in SEARCHED)))


def states(study):
    search, until = {"Steady": {"tolerance": 1e-8}}, {"final time": 100.0, "steady tolerance": 1e-6}

    def row(name, series):
        deck = yaml.safe_load(tanktread.deck_at(f"inputs/{name}.yaml").read_text())["Tanktread"]
        time, without = deck.get("Time", {}) | until, ("Expect", "Output", "Adaptation", "Time")
        plain, tight = (study.run(changed(name, without, Time=one), {}) for one in (time, time | {"tolerance": 1e-7}))
        begun = deck.get("Particle", {}) | {"initial shape": {"run": str(tight.directory.resolve())}}
        rest, after = (study.run(changed(name, without, **one), {}) for one in (search, search | {"Particle": begun}))
        lost = [one.message for one in (rest, plain, tight, after) if not one.done]
        if lost:
            return [f"`{name}`", lost[0], *[""] * 6]
        value = tight.final[series]
        counts = [one.counts["evaluations"] for one in (rest, plain, tight)]
        return [f"`{name}`, {series}", f"{rest.final[series]:.7f}", f"{abs(rest.final[series] - value):.1e}",
                f"{abs(after.final[series] - value):.1e}", *counts, f"{counts[1] / counts[0]:.1f}"]

    table(["deck, series", "`Steady`", "difference from time", "on the same mesh", "evaluations", "in time",
           "in time, 1e-7", "ratio of the first two"], itertools.starmap(row, STATES.items()))


def branch(study):
    deck = changed("drop_branch", ("Spectrum", "Expect", "Solvers"))

    def row(n):
        outcome = study.run(deck, {"Membrane/capillary number": 0.1, SIDE: n})
        expect(outcome.done, f"the branch of n = {n} was not found: {outcome.message}")
        points = len(outcome.series["time"])
        return [6 * n * n + 2, points, f"{outcome.counts['evaluations'] / points:.0f}",
                f"{outcome.processor_seconds / points:.1f}",
                f"{outcome.run.summary['memory']['largest of a rank'] / 2**20:.0f} MB"]

    table(["control points", "points on the branch", "evaluations per point", "processor seconds per point", "memory"],
          map(row, (6, 12)))


def main():
    tables = {one.__name__: one for one in (solvers, states, branch)}
    parser = command_line(__doc__)
    parser.add_argument("table", choices=tables)
    tables[parser.parse_args().table](tanktread.Study(directory=FOLDER))


if __name__ == "__main__":
    answer(main)
