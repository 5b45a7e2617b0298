"""Functions shared by the scripts of tests/cli. A script is called as `<name>.py <tanktread> <source directory>` and reads like this:

    #!/usr/bin/python3
    # label: long                     (optional: left out of the default run)
    # ranks: 2                        (optional: number of processors that it uses)
    from harness import check, main, run

    def an_unknown_key_is_named():
        result = run("inputs/shear_neo_hookean.yaml", "--set", "Flow/shaer rate=1", "--check", code=2)
        check("shaer rate" in result.stderr, result.stderr)

    main()

main() runs every function of the script whose docstring is not "not a test", each in a separate empty directory, and fails if a
function fails. In a script of two ranks, the functions that start only one rank run first, two at a time. If a relative path given to
run() exists in the source directory, that file is used.
"""
import concurrent.futures
import importlib
import inspect
import itertools
import multiprocessing
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import traceback

PROGRAM = pathlib.Path(sys.argv[1]).resolve() if len(sys.argv) > 1 else None
SOURCE = pathlib.Path(sys.argv[2]).resolve() if len(sys.argv) > 2 else None


class Failed(Exception):
    pass


def check(holds, *message):
    """Fails the test unless `holds`."""
    if not holds:
        raise Failed(" ".join(str(part) for part in message))


def close(value, expected, tolerance, what="value"):
    """Fails the test unless |value - expected| <= tolerance."""
    check(abs(value - expected) <= tolerance, f"{what} is {value!r}, expected {expected!r} within {tolerance!r}")


def difference(a, b, what="series", weight=1):
    """Returns the largest weight * |a - b| of two series, divided by the largest |a| if that is above 1. Fails the test unless the series are NaN
    in the same rows: directions of equal semi-axes are undefined."""
    import numpy

    check(a.shape == b.shape and (numpy.isnan(a) == numpy.isnan(b)).all(), f"{what}: other rows, or NaN in other rows: {a} and {b}")
    defined = ~numpy.isnan(a)
    return numpy.max(weight * abs(a - b), initial=0, where=defined) / numpy.max(abs(a), initial=1, where=defined)


def deck(text, name="deck.yaml"):
    """Writes a deck into the test's directory."""
    path = pathlib.Path(name)
    path.write_text(text)
    return path


def command(*arguments, ranks=1):
    """Returns the command line of the program."""
    words = [str(SOURCE / a) if isinstance(a, str) and "/" in a and (SOURCE / a).is_file() else str(a) for a in arguments]
    launcher = ["mpirun", "-n", str(ranks)] if ranks > 1 else []
    return [*launcher, str(PROGRAM), *words]


def run(*arguments, code=0, ranks=1, timeout=600):
    """Runs the program and fails the test unless it exits with `code` (None: any). Returns stdout, stderr and returncode."""
    words = command(*arguments, ranks=ranks)
    result = subprocess.run(words, capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=timeout)
    if code is not None and result.returncode != code:
        raise Failed(f"{' '.join(words)}\nexit code {result.returncode}, expected {code}\n{result.stdout}\n{result.stderr}")
    return result


def refused(words, *arguments, mistakes=1):
    """Runs the program. Fails the test unless it prints one sentence for each of `mistakes` mistakes, the first of
    which contains all `words`, exits with code 2 and writes no results."""
    result = run(*arguments, "--output", "refused", code=2)
    lines = result.stderr.splitlines()
    check(len(lines) == mistakes, f"{len(lines)} lines on standard error:\n{result.stderr}")
    for word in words:
        check(word in lines[0], f"no '{word}' in: {lines[0]}")
    for line in lines:
        for word in ("terminate", "Traceback", "Throw", "std::", "Teuchos::", ".cpp", "filesystem error"):
            check(word not in line, f"'{word}' in: {line}")
        check(len(line) < 400, f"{len(line)} characters: {line}")
    check(result.stdout == "", f"on standard output: {result.stdout}")
    check(not pathlib.Path("refused").exists(), "results were written")


def start(*arguments, ranks=1):
    """Starts the program in the background: a subprocess.Popen, for tests that kill it."""
    return subprocess.Popen(command(*arguments, ranks=ranks), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, text=True)


def wait_within(process, results, whole):
    """Waits until the background run that writes to `results` has probably done two fifths of its steps. `whole`:
    results of the same run without interruption."""
    while process.poll() is None and not pathlib.Path(results, "run.h5").exists():
        time.sleep(0.001)
    seconds = series(whole, "wall_seconds")
    time.sleep(0.4 * (seconds[-1] - seconds[0]))


def package(name, *arguments):
    """Runs the command tanktread-<name> of the Python package in a fork of this process, which has made its imports once. Returns stdout, stderr and
    returncode."""
    os.environ["TANKTREAD"] = str(PROGRAM)
    if str(SOURCE / "postproc") not in sys.path:
        sys.path.append(str(SOURCE / "postproc"))
    from tanktread import __main__ as commands

    for module, _ in commands.COMMANDS.values():
        importlib.import_module(f"tanktread.{module}")
    importlib.import_module("tanktread.figures.render").OVERSAMPLING = 1  # renders surfaces in a quarter of the time
    with tempfile.TemporaryFile("w+") as out, tempfile.TemporaryFile("w+") as said:
        child = os.fork()
        if child == 0:
            for number, file in (1, out), (2, said):
                os.dup2(file.fileno(), number)
            sys.stdout, sys.stderr = (os.fdopen(number, "w") for number in (1, 2))
            sys.argv, code = [f"tanktread-{name}", *map(str, arguments)], 1
            try:
                commands.main()
                code = 0
            except SystemExit as end:
                if isinstance(end.code, str):
                    print(end.code, file=sys.stderr)
                else:
                    code = end.code or 0
            except BaseException:
                traceback.print_exc()
            sys.stdout.flush(), sys.stderr.flush()
            os._exit(code)
        _, status = os.waitpid(child, 0)
        out.seek(0), said.seek(0)
        return subprocess.CompletedProcess([name, *arguments], os.waitstatus_to_exitcode(status), out.read(), said.read())


def shown(page):
    """Returns the document that headless Chromium makes of a page, and the lines of its console. If there is no
    Chromium, prints this and returns (None, [])."""
    browser = shutil.which("chromium")
    if not browser:
        print("skipped a part: chromium is not installed")
        return None, []
    words = [browser, "--headless=new", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--virtual-time-budget=20000",
             "--dump-dom", f"--user-data-dir={pathlib.Path('profile').resolve()}", "--enable-logging=stderr", page]
    result = subprocess.run(words, capture_output=True, text=True, timeout=300)
    return result.stdout, [line for line in result.stderr.splitlines() if "CONSOLE" in line and "GL Driver Message" not in line]


def series(results, name):
    """Returns a series of a run as a numpy array."""
    import h5py

    with h5py.File(pathlib.Path(results) / "run.h5", "r") as file:
        return file["series"][name][:]


def summary(results):
    """Returns the summary of a run as a dictionary."""
    import yaml

    return yaml.safe_load((pathlib.Path(results) / "summary.yaml").read_text())


def _outcome(test):
    """Runs a test. Returns True if it passes, and the text to be printed."""
    with tempfile.TemporaryDirectory(prefix="tanktread-") as directory:
        os.chdir(directory)
        start = time.perf_counter()
        try:
            test()
            return True, f"passed {test.__name__.replace('_', ' ')} ({time.perf_counter() - start:.1f} s)"
        except Exception as error:  # the other tests of the script are run too
            said = str(error) if isinstance(error, Failed) else traceback.format_exc()
            return False, "FAILED " + test.__name__.replace("_", " ") + "\n" + said
        finally:
            os.chdir(SOURCE)


def main():
    """Runs the functions of the calling script."""
    script = sys.modules["__main__"]
    tests = [f for f in vars(script).values() if callable(f) and getattr(f, "__module__", None) == "__main__"
             and not f.__name__.startswith("_") and (f.__doc__ or "") != "not a test"]
    if not tests:
        sys.exit("no tests in this script")
    head = pathlib.Path(script.__file__).read_text().splitlines()[:20]
    apart = [f for f in tests if "ranks" in inspect.getsource(f)] if "# ranks: 2" in head else tests
    failed = 0
    with concurrent.futures.ProcessPoolExecutor(2, multiprocessing.get_context("fork")) as two:
        outcomes = list(two.map(_outcome, [f for f in tests if f not in apart]))
    for passed, said in itertools.chain(outcomes, map(_outcome, apart)):
        failed += not passed
        print(said, flush=True)
    sys.exit(1 if failed else 0)
