"""Reading of files that the program or a user wrote. What is wrong with one is a Mistake: one sentence."""

import warnings

import h5py
import numpy
import yaml

from .mistakes import Mistake, expect


def yaml_text(text):
    """Returns the content of a YAML text, by the fast loader if PyYAML has it."""
    return yaml.load(text, getattr(yaml, "CSafeLoader", yaml.SafeLoader))


def text_of_hdf(value):
    """Returns a string of HDF5 as str."""
    return value.decode("utf-8") if isinstance(value, bytes) else str(value)


def datasets(group):
    """Returns {path: dataset} of all datasets below a group of HDF5."""
    found = {}
    group.visititems(lambda name, item: found.update({name: item}) if isinstance(item, h5py.Dataset) else None)
    return found


def arrays_of(path, purpose):
    """Returns {name: array} of an HDF5 file's datasets, such as duct.h5 and channel.h5. `purpose` ends the sentence."""
    try:
        with h5py.File(path, "r") as file:
            return {name: data[()] for name, data in file.items()}
    except OSError:
        raise Mistake(f"{path} cannot be read: {purpose}") from None


def table(path, names=()):
    """Returns a CSV file's columns of these names as a structured array, or without names its rows of numbers (n, k).

    Needs two rows or columns of numbers. Raises Mistake otherwise."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            found = numpy.genfromtxt(path, delimiter=",", comments="#", names=True if names else None)
    except (OSError, ValueError, IndexError):
        found = numpy.zeros(0)
    whole = found.ndim == 2 and found.shape[1] > 1
    if names:
        whole = found.size > 1 and set(names) <= set(found.dtype.names or ())
    expect(whole,
           f"{path} is no table {'with the columns ' + ', '.join(names) if names else 'of two columns of numbers'}, "
                  "separated by commas")
    return found if names else found[numpy.isfinite(found).all(axis=1)]
