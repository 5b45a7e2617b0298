#!/usr/bin/python3
# Tests of the environment variable that selects the instruction set of the kernels: the results are equal, and a wrong
# value is reported.
import os
import re

from harness import check, deck, main, run, series

DECK = """
Tanktread:
  Flow: {type: simple shear}
  Membrane: {capillary number: 0.3}
  Surface: {elements per side: 4}
  Time: {final time: 0.5}
"""


def _run_with(instructions, *words, code=0):
    os.environ["TANKTREAD_INSTRUCTIONS"] = instructions
    return run(deck(DECK), *words, code=code)


def _allowed():
    said = _run_with("none of them", "--check", code=2).stderr
    return re.search(r"TANKTREAD_INSTRUCTIONS: (.*) \(", said)[1].split(", ")


def unavailable_instruction_sets_are_rejected_in_one_sentence():
    check(_allowed()[0] == "baseline", _allowed())


def the_plan_names_the_instruction_set():
    for instructions in _allowed():
        check(re.search(rf"kernels +{instructions}\b", _run_with(instructions, "--check").stdout), instructions)


def results_agree():
    for instructions in _allowed():
        _run_with(instructions, "--output", instructions, "--quiet")
    first, *others = _allowed()
    for name in "taylor_inertia", "energy", "smallest_tension", "local_area_change", "stresslet_13":
        expected = series(first, name)
        for other in others:
            found = series(other, name)
            check(len(found) == len(expected) and max(abs(found - expected)) < 1e-9, name, other, found, expected)


main()
