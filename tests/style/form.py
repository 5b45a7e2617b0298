#!/usr/bin/python3
"""Checks the form of all files: C++ lines of at most 150 characters (aim: 140), #pragma once in headers, no threads but those of
base/threads.hpp, Debian's Python in scripts, scripts that are executable, bash scripts that stop at the first error, and decks whose cost is stated equally in both places.

Usage: form.py <source directory>
"""
import os
import pathlib
import re
import sys


def cpp_errors(path, text):
    for number, line in enumerate(text.splitlines(), 1):
        if len(line) > 150:
            yield f"{path}:{number}: {len(line)} characters"
        if "\t" in line or line != line.rstrip():
            yield f"{path}:{number}: a tab, or a blank at the end of the line"
    if path.suffix == ".hpp" and "#pragma once" not in text:
        yield f"{path}: no #pragma once"


THREADS = re.compile(r"\bstd::(?:jthread|thread|async|execution)\b|#pragma omp|\bpthread_create\b|\btbb::|\bKokkos::parallel_")


def thread_errors(path, text):
    """Yields means of starting threads other than base/threads.hpp in the program and its library."""
    for match in THREADS.finditer(text) if path.stem != "threads" else ():
        yield f"{path}: {match[0]}: loops on several threads use base/threads.hpp"


def python_errors(path, text):
    """Yields lines of the Python package beyond 120 characters."""
    if "postproc" in path.parts:
        for number, line in enumerate(text.splitlines(), 1):
            if len(line) > 120:
                yield f"{path}:{number}: {len(line)} characters"


def script_errors(path, text):
    first = text.split("\n", 1)[0]
    executable = os.access(path, os.X_OK)
    if path.suffix == ".py" and (executable or first.startswith("#!")) and first != "#!/usr/bin/python3":
        yield f"{path}: starts with '{first}' instead of #!/usr/bin/python3"
    if first.startswith("#!") and path.parent.name in ("postproc", "benchmark") and not executable:
        yield f"{path}: not executable"
    if first.startswith("#!") and "bash" in first and "set -euo pipefail" not in text:
        yield f"{path}: no set -euo pipefail"


def cost_errors(source):
    """Yields the decks whose line `# Cost:` and row in inputs/README.md state different costs."""
    for name, cost in re.findall(r"(?m)^\| \[(\w[\w.]*\.yaml)\].*\| ([^|]+) \|$", (source / "inputs/README.md").read_text()):
        if f"\n# Cost: {cost} on one core.\n" not in (source / "inputs" / name).read_text():
            yield f"inputs/README.md states the cost of {name} as `{cost}`, and its line `# Cost:` does not (tests/benchmark/deck_costs.py)"


def main():
    source = pathlib.Path(sys.argv[1])
    errors = list(cost_errors(source))
    for folder in ("app", "lib", "tests", "postproc", ".ci"):
        for path in sorted(p for p in (source / folder).rglob("*") if p.is_file()):
            if path.suffix in (".cpp", ".hpp"):
                errors += [*cpp_errors(path, path.read_text()), *(thread_errors(path, path.read_text()) if folder in ("app", "lib") else [])]
            elif path.suffix in (".py", ""):
                errors += script_errors(path, path.read_text())
                errors += python_errors(path, path.read_text()) if path.suffix == ".py" else []
    print("\n".join(errors))
    sys.exit(bool(errors))


main()
