"""Functions that read files of the program or of a user. If a file is missing or wrong, they raise Mistake."""

import contextlib
import difflib
import functools
import pathlib

import h5py
import yaml

from .mistakes import Mistake, expect

# Returns the content of a YAML text. PyYAML has the fast loader if it was built with libyaml.
yaml_text = functools.partial(yaml.load, Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))


def bytes_of(path):
    """Returns the content of a regular file. A device, which may have no end, is not read."""
    expect(pathlib.Path(path).exists(), f"there is no file {path}")
    expect(pathlib.Path(path).is_file(), f"{path} is a directory or a device, not a file")
    try:
        return pathlib.Path(path).read_bytes()
    except OSError as error:
        raise Mistake(f"{path} cannot be read: {error.strerror}") from None


def parsed(path, parse=yaml_text, kind=object):
    """Returns parse(text) of a file in UTF-8. Raises Mistake if it is not of this kind, such as dict."""
    data = bytes_of(path)
    try:
        found = parse(data.decode("utf-8"))
    except yaml.YAMLError as error:
        raise Mistake(f"{path} is not YAML: {error}") from None
    except UnicodeDecodeError:
        raise Mistake(f"{path} is no text in UTF-8") from None
    except ValueError as error:
        raise Mistake(f"{path} cannot be read: {error}") from None
    expect(isinstance(found, kind), f"{path} is damaged: it holds no section of keys with values")
    return found


@contextlib.contextmanager
def opened(path):
    """Opens an HDF5 file for reading. A missing dataset in the body of the `with` statement raises Mistake, too."""
    try:
        with h5py.File(path, "r") as file:
            yield file
    except (OSError, KeyError, RuntimeError) as error:
        raise Mistake(f"{path} cannot be read: {error}") from None


def text_of_hdf(value):
    """Returns a string of HDF5 as str."""
    return value.decode("utf-8") if isinstance(value, bytes) else str(value)


def datasets(group):
    """Returns {path: dataset} of all datasets below a group of HDF5."""
    found = {}
    group.visititems(lambda name, item: found.update({name: item}) if isinstance(item, h5py.Dataset) else None)
    return found


class Named(dict):
    """A dict of the named contents of a file. An unknown name raises Mistake with the available names. `where`:
    beginning of the message, such as "run.h5 holds no series"."""

    def __init__(self, content, where):
        super().__init__(content)
        self.where = where

    def __missing__(self, name):
        there = sorted(self) if len(self) < 20 else difflib.get_close_matches(name, self, 9, 0) + ["…"]
        raise Mistake(f"{self.where} {name}; there are: {', '.join(there)}")


def arrays_of(path):
    """Returns {name: array} of the datasets of an HDF5 file, such as duct.h5 of a tube and channel.h5 of a channel."""
    with opened(path) as file:
        return {name: data[()] for name, data in file.items()}
