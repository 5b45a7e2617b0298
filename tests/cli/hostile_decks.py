#!/usr/bin/python3
# Tests that --check ends soon for any deck: with the plan, or with one sentence for each mistake and exit code 2.
#
# By hand: hostile_decks.py <tanktread> <source directory> --count 5000 --seed 7 makes other mutations of the shipped decks.
import argparse
import json
import pathlib
import random
import re
import shutil
import subprocess
import sys

from harness import SOURCE, check, command, main

arguments = argparse.ArgumentParser()
arguments.add_argument("program")
arguments.add_argument("source")
arguments.add_argument("--count", type=int, default=60)
arguments.add_argument("--seed", type=int, default=1)
OPTIONS = arguments.parse_args()

# time limit of one case, to detect a program that hangs; the largest surface that a deck allows takes much less
SECONDS = 60

# texts that must not be in a message: errors of libraries or of the language, and paths of source files
TRACES = ["std::", "Teuchos", "Belos::", "NOX::", "Amesos2::", "Throw", "terminate", "what()", "bad_alloc", "basic_string", "vector::", "map::", ".cpp", ".hpp",
          "filesystem error", "HDF5-DIAG", "yaml-cpp", "Eigen::"]

NUMBERS = ["0", "-0.0", "-1", "1e308", "-1e308", "1e-308", "1e400", ".nan", "nan", ".inf", "-.inf", "2147483648", "-2147483649", "9223372036854775808", "1e75",
           "1e-75", "0x10", "1_000", "1e", "--1", "3.5", "100000000000000000000000000000", "0.0001", "1e6", "17"]
WORDS = ["", "~", "null", "true", "no", "[]", "{}", "[1]", "[1, 2, 3]", "[[1, 2], [3]]", "[a, b]", "[{a: 1}]", "{a: {b: 1}}", "\"\"", "\"\\n\\t\\x1b\"", "'it''s'",
         "a: b", "\u03b3\u0307 = 1", "\U0001f600", "&a 1", "*a", "!!str 1", "!!binary aGVsbG8=", "|", ">", "- 1", "?", "@", "`", "%", "../../etc/passwd",
         "/dev/zero", "/", ".", "pipe", "x" * 300, "a/" * 2000, "auto", "assembled", "matrix-free", "free", "prescribed", "file", "quiescent", "duct", "drop"]
NAMES = ["dt", "Particles", "gravity", "Tanktread", "", " ", "\"\"", "x" * 500, "\u03bb", "\"a\\nb\"", "<<", "Expect", "[1]", "{a: 1}", "value", "radius", "0"]


def _leaves(tree, path=()):
    for key, value in tree.items():
        yield (*path, key)
        if isinstance(value, dict):
            yield from _leaves(value, (*path, key))


def _keys():
    """Returns the paths of all keys in the manual, each as a list of names."""
    section, keys = "", []
    for line in (SOURCE / "inputs/REFERENCE.md").read_text().splitlines():
        if line.startswith("## "):
            section = line[3:].strip("` ").replace("<name>", "volume")
        elif match := re.match(r"\| `([^`]+)` \|", line):
            keys.append(f"{section}/{match[1]}".split("/"))
    return keys


KEYS = _keys()


def _dumped(tree):
    """Returns a deck as text. A value of type `Raw` is inserted verbatim."""
    lines = []

    def write(name, value, indent):
        if isinstance(value, dict):
            lines.append(f"{indent}{name}:" if value else f"{indent}{name}: {{}}")
            for key, inner in value.items():
                write(key, inner, indent + "  ")
        else:
            lines.append(f"{indent}{name}: {value if isinstance(value, str) else json.dumps(value)}")

    for name, value in tree.items():
        write(name, value, "")
    return "\n".join(lines) + "\n"


def _set(tree, path, value):
    for key in path[:-1]:
        if not isinstance(tree.get(key), dict):
            tree[key] = {}
        tree = tree[key]
    tree[path[-1]] = value


def _values_changed(tree, dice):
    for _ in range(dice.randint(1, 3)):
        _set(tree["Tanktread"], dice.choice(KEYS), dice.choice(NUMBERS + WORDS))
    return _dumped(tree)


def _value_of_the_deck_changed(tree, dice):
    path = dice.choice(list(_leaves(tree)))
    _set(tree, path, dice.choice(NUMBERS + WORDS))
    return _dumped(tree)


def _keys_renamed(tree, dice):
    path = dice.choice(list(_leaves(tree)))
    _set(tree, (*path[:-1], dice.choice(NAMES)), dice.choice(["1", "{}", "word"]))
    return _dumped(tree)


def _solver_lists(tree, dice):
    solver = dice.choice(["GMRES", "Block GMRES", "Hybrid Block GMRES", "Seed GMRES", "BICGSTAB", "CG", "RCG", "TFQMR", "GCRODR", "LSQR", "Fixed Point", "Foo", "", "gmres"])
    _set(tree["Tanktread"], ["Solvers", "iterative solver"], json.dumps(solver))
    for _ in range(dice.randint(0, 2)):
        key = dice.choice(["Num Blocks", "Block Size", "Maximum Iterations", "Maximum Restarts", "Orthogonalization", "Num Recycled Blocks", "Verbosity",
                           "Implicit Residual Scaling", "Convergence Tolerance", "Timer Label", "Foo"])
        _set(tree["Tanktread"], ["Solvers", "Belos", key], dice.choice(["2000000000", "-1", "0", "3", "Foo", "1.5", "true", "ICGS", "{a: 1}", "30"]))
    if dice.random() < 0.3:
        _set(tree["Tanktread"], ["Time", "scheme"], "crank-nicolson")
        _set(tree["Tanktread"], ["Time", "nonlinear solver"], dice.choice(["anderson", "newton-krylov", "plain"]))
        _set(tree["Tanktread"], ["Solvers", "NOX", dice.choice(["Nonlinear Solver", "Direction", "Line Search", "Foo", "Anderson Parameters"])],
             dice.choice(["Foo", "{Method: Foo}", "{Method: Newton}", "{Storage Depth: -5}", "3", "{}"]))
    return _dumped(tree)


def _lines_shuffled(tree, dice):
    lines = _dumped(tree).splitlines()
    for _ in range(dice.randint(1, 3)):
        at = dice.randrange(len(lines))
        change = dice.randrange(4)
        if change == 0:
            lines.insert(dice.randrange(len(lines)), lines[at])  # given twice, or elsewhere
        elif change == 1:
            lines[at] = " " * dice.randint(0, 9) + lines[at].strip()
        elif change == 2:
            lines[at] = "\t" + lines[at]
        else:
            del lines[at]
            lines = lines or [""]
    return "\n".join(lines) + "\n"


def _bytes_changed(tree, dice):
    text = bytearray(_dumped(tree).encode())
    for _ in range(dice.randint(1, 8)):
        text[dice.randrange(len(text))] = dice.randrange(256)
    return bytes(text)


def _cut(tree, dice):
    text = _dumped(tree).encode()
    return text[:dice.randrange(len(text))]


def _deep(tree, dice):
    levels = dice.choice([10, 100, 1000, 100000])
    opening, closing = dice.choice([("{a: ", "}"), ("[", "]"), ("- ", ""), ("? ", ""), ("a: &x {b: *x, c: ", "}")])
    return "Tanktread:\n  Flow: " + opening * levels + "1" + closing * dice.choice([0, levels])


def _noise(tree, dice):
    return bytes(dice.randrange(256) for _ in range(dice.choice([0, 1, 10, 1000])))


def _punctuation(tree, dice):
    return "Tanktread:\n  Flow: " + "".join(dice.choice("{}[]:,-?&*!|>'\"%@`# \n\ta1.") for _ in range(dice.choice([5, 50, 500])))


MUTATIONS = [_values_changed, _values_changed, _value_of_the_deck_changed, _value_of_the_deck_changed, _keys_renamed, _solver_lists, _lines_shuffled, _bytes_changed,
             _cut, _deep, _noise, _punctuation]


def _fault(name):
    """Returns a sentence that describes a wrong response of the program to the deck `name`, or an empty text."""
    try:
        result = subprocess.run(command(name, "--check", "--quiet"), capture_output=True, stdin=subprocess.DEVNULL, timeout=SECONDS)
    except subprocess.TimeoutExpired:
        return f"no answer within {SECONDS} s"
    said = result.stderr.decode(errors="replace")
    lines = [line for line in said.splitlines() if not line.startswith("tanktread: warning: ")]
    if result.returncode not in (0, 2):
        return f"exit code {result.returncode}: {said[:500]}"
    if result.returncode == 0:
        return f"an error was said, but exit code 0: {said[:500]}" if lines else ""
    if not lines or any(not line.startswith("tanktread: ") or len(line) > 1100 for line in lines):
        return f"not a sentence of the program's for each mistake: {said[:500]}"
    traces = [trace for trace in TRACES if trace in lines[0]]
    return f"{traces} in: {lines[0][:500]}" if traces else ""


def mutated_decks_are_checked_or_rejected_in_one_sentence():
    import yaml

    for outline in (SOURCE / "inputs").glob("*.csv"):
        shutil.copy(outline, ".")
    originals = [yaml.safe_load(path.read_text()) for path in sorted((SOURCE / "inputs").glob("*.yaml"))]
    faults = []
    for case in range(OPTIONS.count):
        dice = random.Random(f"{OPTIONS.seed} {case}")
        mutation = MUTATIONS[case % len(MUTATIONS)]
        text = mutation(json.loads(json.dumps(dice.choice(originals))), dice)
        name = f"case_{case}.yaml"
        pathlib.Path(name).write_bytes(text if isinstance(text, bytes) else text.encode())
        if fault := _fault(name):
            faults.append(f"case {case} of seed {OPTIONS.seed}, {mutation.__name__[1:]}: {fault}\n{pathlib.Path(name).read_bytes()[:1500]!r}")
            print(faults[-1], file=sys.stderr, flush=True)
    check(not faults, f"{len(faults)} of {OPTIONS.count} decks:\n" + "\n".join(faults))


main()
