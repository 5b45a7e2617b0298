"""Reading of study files: YAML sections, numbers, ranges, decks. What is wrong is a Mistake: one sentence."""

import pathlib

import numpy

from ..files import parsed
from ..mistakes import expect
from ..runs import shared


def number(given, name):
    """Returns a number of a YAML file, in which 1e-2 is a string."""
    try:
        found = float(given)
    except (TypeError, ValueError):
        found = numpy.nan
    expect(not numpy.isnan(found), f"{name}: {given} is not a number")
    return found


def positive(given, name):
    """Returns a number above 0."""
    expect(0 < number(given, name) < numpy.inf, f"{name} must be a number above 0, but is {given}")
    return float(given)


def optional(read, section, key, name):
    """Returns read(value, name of the key) of a key of a section; None if the key is absent."""
    return read(section[key], f"{name}: {key}") if section.get(key) is not None else None


def whole(given, name):
    """Returns a whole number above 0."""
    expect(isinstance(given, int) and not isinstance(given, bool) and given > 0,
           f"{name} must be a whole number above 0, but is {given}")
    return given


def keys_of(given, name):
    """Returns a section of a YAML file, {} if it is absent."""
    expect(given is None or isinstance(given, dict), f"{name} must be a list of keys with values, but is {given}")
    return given or {}


def yaml_of(path, known):
    """Returns the content of a YAML file with these sections only."""
    text = parsed(path)
    expect(isinstance(text, dict), f"{path} must be a list of keys: {', '.join(sorted(known))}")
    unknown = sorted(set(text) - set(known))
    expect(not unknown, f"{path}: {unknown[0] if unknown else ''} is not known; there are: {', '.join(sorted(known))}")
    return text


def decks_of(text, path):
    """Returns the paths of the decks that a file names, looked for next to it, in the present directory and with the
    program."""
    expect(text.get("deck"), f"{path} names no deck")
    found = []
    for name in text["deck"] if isinstance(text["deck"], list) else [text["deck"]]:
        expect(isinstance(name, str), f"{path}: a deck is the name of a file, but {name} is none")
        places = [pathlib.Path(path).parent / name, *(folder / name for folder in shared())]
        found.append(next((place.resolve() for place in places if place.is_file()), None))
        expect(found[-1], f"{path}: there is no deck {name}, beside it or where the script is started")
    return found


def values_of(key, given):
    """Returns a list of values from a list, a single value or a range."""
    if isinstance(given, list):
        expect(given, f"{key} has no values")
        return given
    if not isinstance(given, dict):
        return [given]
    expect({"from", "to", "number"} <= set(given), f"{key}: a range has from, to and number")
    low, high = (number(given[end], f"{key}: {end}") for end in ("from", "to"))
    shares = numpy.linspace(0, 1, whole(given["number"], f"{key}: number"))
    return [float(value) for value in spaced(key, given, low, high)(shares)]


def spaced(key, given, low, high):
    """Returns the function from [0, 1] to [low, high] with the spacing that is given."""
    if given.get("spacing", "linear") == "linear":
        return lambda share: low + (high - low) * share
    expect(given["spacing"] == "logarithmic", f"{key}: the spacing is linear or logarithmic, not {given['spacing']}")
    expect(low > 0 and high > 0, f"{key}: a logarithmic range is of positive numbers")
    return lambda share: low * (high / low) ** share
