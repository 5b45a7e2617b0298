#!/usr/bin/python3
"""What a point on a branch of steady shapes costs: velocity evaluations, processor seconds and memory, around the fold of a drop in uniaxial extension.

    tests/benchmark/branch_cost.py build/release/app/tanktread [n ...]

The branch of inputs/drop_branch.yaml, collocated and without its spectrum, from Ca = 0.1 up to the fold and back, on meshes of n elements a side, 6 and 12 if
none is given: 218 and 866 control points. Prints a table.
"""
import os
import pathlib
import subprocess
import sys
import tempfile

import yaml

from solvers import INPUTS


def row(program, n):
    deck = yaml.safe_load((INPUTS / "drop_branch.yaml").read_text())["Tanktread"]
    for section in "Spectrum", "Expect", "Solvers":
        deck.pop(section)
    deck["Membrane"]["capillary number"] = 0.1
    deck["Surface"]["elements per side"] = n
    with tempfile.TemporaryDirectory() as folder:
        path, results = pathlib.Path(folder) / "deck.yaml", pathlib.Path(folder) / "results"
        path.write_text(yaml.safe_dump({"Tanktread": deck}))
        child = subprocess.Popen([program, path, "--output", results, "--quiet"])
        _, status, used = os.wait4(child.pid, 0)
        if status:
            sys.exit(f"branch_cost.py: the branch of n = {n} was not found")
        final = yaml.safe_load((results / "summary.yaml").read_text())["final"]
    points = final["time"] + 1  # a row a point, numbered from 0
    return (f"| {6 * n * n + 2} | {points:.0f} | {final['evaluations'] / points:.0f} | {(used.ru_utime + used.ru_stime) / points:.1f} | "
            f"{used.ru_maxrss / 1024:.0f} MB |")


def main():
    program, *meshes = sys.argv[1:]
    print("| control points | points on the branch | evaluations a point | processor seconds a point | memory of the run |\n|---|---|---|---|---|")
    for n in [int(n) for n in meshes] or [6, 12]:
        print(row(program, n), flush=True)


if __name__ == "__main__":
    main()
