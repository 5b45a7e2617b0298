"""Errors that are reported in one sentence, and the functions that start all commands of the package."""

import argparse
import importlib
import logging
import pathlib
import signal
import sys

log = logging.getLogger("tanktread")  # numerical results of a figure or study; a command prints them


class Mistake(ValueError):
    """An error of the user, for example a missing file, a wrong key, or a series that was not recorded. Its text is one
    sentence."""


def expect(holds, message):
    """Raises Mistake with the message unless `holds`."""
    if not holds:
        raise Mistake(message)


ON_PYPI = {"pil": "pillow", "vtk9": "vtk"}  # names on PyPI that differ from those of Debian


def optional(module, purpose, package=None):
    """Returns an imported module that only some functions need. Raises Mistake with its name if it is not installed."""
    try:
        return importlib.import_module(module)
    except ImportError:
        name = package or module.split(".")[0]
        raise Mistake(f"{purpose} needs {name}, which {sys.executable} does not have: "
                      f"apt install python3-{name}, or pip install {ON_PYPI.get(name, name)}") from None


def progress(text):
    """Prints the progress on standard error. On a terminal each text replaces the previous one, and "" removes it."""
    if sys.stderr.isatty():
        print(f"\r\x1b[K{text}", end="", file=sys.stderr, flush=True)
    elif text:
        print(text, file=sys.stderr, flush=True)


def command_line(doc):
    """Returns the parser of the command line of a script whose docstring is `doc`."""
    return argparse.ArgumentParser(description=doc, formatter_class=argparse.RawDescriptionHelpFormatter)


def answer(main):
    """Runs the main function of a command and ends the process. If it raises Mistake, prints the sentence and exits
    with code 2."""
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # a reader of the output, such as head, may end before this process
    log.setLevel(logging.INFO)
    handler = logging.Handler()
    handler.emit = lambda record: print(record.getMessage(), flush=True)
    log.handlers[:] = [handler]
    try:
        sys.exit(main())
    except Mistake as mistake:
        text = str(mistake)
    except ModuleNotFoundError as error:
        text = (f"{sys.executable} has no {error.name}: use Debian's /usr/bin/python3 with the packages in "
                "app/packages.txt, or pip install numpy h5py PyYAML scipy matplotlib")
    except OSError as error:  # a file that cannot be written
        text = f"{error.filename}: {error.strerror}" if error.filename else str(error)
    except KeyboardInterrupt:
        sys.exit("stopped: the same command continues from here")
    progress("")
    print(f"{pathlib.Path(sys.argv[0]).name}: {' '.join(text.split())}", file=sys.stderr)
    sys.exit(2)
