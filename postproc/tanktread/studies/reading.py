"""Reads study files. A study states the kinds of its keys, and read() checks the whole file. Errors raise Mistake,
which names the key, what is expected and what is given."""

import contextlib
import math
import pathlib
import re

import numpy
import yaml

from ..files import parsed
from ..mistakes import Mistake, expect
from ..runs import shared

MOST = 100_000  # largest number of runs of a study


class _Loader(getattr(yaml, "CSafeLoader", yaml.SafeLoader)):  # type: ignore[misc]
    """Loads YAML. Keys of sections are texts, also if they look like numbers. A repeated key is an error."""

    def construct_mapping(self, node, deep=False):
        lines = {}
        for key, _ in node.value if isinstance(node, yaml.MappingNode) else ():
            line = f"line {key.start_mark.line + 1}"
            expect(isinstance(key, yaml.ScalarNode), f"{line}: a name is a text, not a list or section")
            if key.tag == "tag:yaml.org,2002:merge":
                continue
            expect(key.value not in lines, f"{line}: the key {key.value} is already in {lines.get(key.value)}, in the "
                   "same section")
            lines[key.value], key.tag = line, "tag:yaml.org,2002:str"
        return super().construct_mapping(node, deep)


def _shown(given):
    """Returns a short text of a value for a message."""
    words = {dict: "a section", list: "a list", type(None): "nothing", bool: "true" if given is True else "false"}
    text = words.get(type(given)) or str(given)
    return text if len(text) < 50 else text[:50] + "…"


def text(given, name):
    """Returns a text. Raises Mistake if it is not one, or has characters that are not printable."""
    expect(isinstance(given, str), f"{name} must be a text, but is {_shown(given)}")
    expect(given.strip() and given.replace("\u00a0", " ").isprintable(),
           f"{name} is empty or has characters that cannot be printed")
    return given


def anything(given, name):
    """Returns a value that is checked later."""
    return given


def texts(given, name):
    """Returns a list of texts from a text or a list of texts."""
    return read(given, [text], name) if isinstance(given, list) else [text(given, name)]


def word(*words):
    """Returns the kind of a value that is one of these words."""

    def kind(given, name):
        expect(given in words, f"{name} is {' or '.join(words)}, not {_shown(given)}")
        return given

    return kind


def flag(given, name):
    """Returns true or false."""
    expect(isinstance(given, bool), f"{name} is true or false, not {_shown(given)}")
    return given


def number(given, name):
    """Returns a finite number as a float. Accepts texts, because PyYAML reads 1e-2 as a text."""
    with contextlib.suppress(TypeError, ValueError, OverflowError):
        if not isinstance(given, bool) and math.isfinite(float(given)):
            return float(given)
    point = "; write a decimal point" if isinstance(given, str) and re.fullmatch(r"[-+]?\d*,\d+", given) else ""
    raise Mistake(f"{name}: {_shown(given)} is not a number{point}")


def positive(given, name):
    """Returns a number above 0 as a float."""
    expect(number(given, name) > 0, f"{name} must be a number above 0, but is {_shown(given)}")
    return float(given)


def whole(given, name, least=1):
    """Returns a whole number that is not below `least`."""
    expect(isinstance(given, int) and not isinstance(given, bool) and given >= least,
           f"{name} must be a whole number, {least} or above, but is {_shown(given)}")
    return given


def few(number, name):
    """Returns a number of runs. Raises Mistake if it exceeds MOST."""
    expect(number <= MOST, f"{name} makes {_shown(number)} runs, and a study makes at most {MOST}")
    return number


def setting(given, name):
    """Returns the value of a key or section of a deck: a number, a text, true or false, or a list or section of
    these."""
    if isinstance(given, dict):
        return read(given, {any_name: setting}, name)
    for one in given if isinstance(given, list) else [given]:
        expect(isinstance(one, (int, float, str)), f"{name} must be a number or a text, or a list of them, but "
               f"{'holds' if isinstance(given, list) else 'is'} {_shown(one)}")
        if isinstance(one, str):
            text(one, name)
    return given


def any_name(given, name):
    """Checks the name of a part of a study, such as an experiment or a column of a table."""
    parts = text(given, f"{name}: a name").split("/")
    expect(all(part.strip(" .") for part in parts), f"{name}: {given} is not a name")


def deck_key(given, name):
    """Checks the form of a key of a deck."""
    any_name(given, name)
    expect("/" in given, f"{name}: {given} is not a key of a deck: give Section/key, such as Flow/shear rate")


SETTINGS = {deck_key: setting}
RANGE = {"from": number, "to": number, "spacing": word("linear", "logarithmic")}


def values(given, name):
    """Returns a list of values from a list, a single value or a range."""
    if not isinstance(given, dict):
        given = given if isinstance(given, list) else [given]
        expect(given, f"{name} has no values")
        return [setting(one, name) for one in given]
    given = read(given, RANGE | {"number": whole}, name)
    expect({"from", "to", "number"} <= set(given), f"{name}: a range has from, to and number")
    return spaced(given, name, numpy.linspace(0, 1, few(given["number"], name)))


def spaced(given, name, shares):
    """Returns the values at fractions `shares` (n,), from 0 to 1, of a range {from, to, spacing}."""
    low, high = given["from"], given["to"]
    if given.get("spacing", "linear") == "linear":
        return (low + (high - low) * shares).tolist()
    expect(low > 0 and high > 0, f"{name}: a logarithmic range is of positive numbers")
    return (low * (high / low) ** shares).tolist()


def read(given, kind, name):
    """Returns a value of a study file that is checked and converted by its kind. A kind is a function (value, name)
    that returns the value; [kind]: a list of values of this kind; or {key: kind}: a section of these keys. In a
    section, a function (key, name) instead of a key stands for all other keys, and checks them. Keys without a value
    are left out."""
    if callable(kind):
        return kind(given, name)
    if isinstance(kind, list):
        expect(isinstance(given, list), f"{name} must be a list, but is {_shown(given)}")
        return [read(one, kind[0], f"{name}, {number} of the list") for number, one in enumerate(given, 1)]
    expect(given is None or isinstance(given, dict),
           f"{name} must be a section of keys with values, but is {_shown(given)}")
    others, found = next(filter(callable, kind), None), {}
    for key, one in (given or {}).items():
        if key not in kind and not others:
            raise Mistake(f"{name}: {key} is not known; there are: {', '.join(sorted(kind))}")
        if key not in kind:
            others(key, name)
        elif one is None and not isinstance(kind[key], dict):
            continue
        found[key] = read(one, kind.get(key, kind.get(others)), f"{name}: {key}")
    return found


def study_of(path, kinds):
    """Returns the content of a study file: a section of these kinds and of `deck`, a list of the paths of its decks.
    Absent sections are {}. Decks are searched for next to the file, in the current directory, and in the directories of
    shared()."""
    kinds = kinds | {"deck": texts}
    found = {key: {} for key, kind in kinds.items() if isinstance(kind, dict)}
    try:
        given = parsed(path, lambda content: yaml.load(content, Loader=_Loader))
        expect(isinstance(given, dict), f"{path} must be a section of keys: {', '.join(sorted(kinds))}")
        found |= read(given, kinds, path)
    except RecursionError:
        raise Mistake(f"{path} holds sections or lists within each other without end") from None
    expect(found.get("deck"), f"{path} names no deck")
    folders = [pathlib.Path(path).parent, *shared()]
    for k, deck in enumerate(found["deck"]):
        places = [(folder / deck).resolve() for folder in folders if (folder / deck).is_file()]
        expect(places, f"{path}: there is no deck {deck}, beside it or where the script is started")
        found["deck"][k] = places[0]
    return found
