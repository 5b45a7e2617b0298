#!/usr/bin/python3
"""Checks that every equation number cited in a comment occurs in lib/README.md, and that every file named in a comment or in lib/README.md exists.

Usage: equations.py <source directory>
"""
import pathlib
import re
import sys

NUMBER = re.compile(r"\(([1-9]\.\d{1,2})\)|\b(P-\d+)")
FILE = re.compile(r"(?<![\w/.])((?:[\w.-]+/)*[\w-]+\.(?:md|cpp|hpp|py))\b")


def numbers(text):
    return {first or second for first, second in NUMBER.findall(text)}


def comments(path):
    """Yields (line number, text) of each comment line."""
    for number, line in enumerate(path.read_text().splitlines(), 1):
        if "//" in line:
            yield number, line.split("//", 1)[1]


def exists(name, path, source):
    """Returns whether a file exists. Its name may be relative to the source directory, to lib/, or to the file that names it."""
    return any((place / name).exists() for place in (source, source / "lib", path.parent))


def main():
    source = pathlib.Path(sys.argv[1])
    readme = source / "lib/README.md"
    known = numbers(readme.read_text())
    errors = [f"lib/README.md: there is no {name}" for name in FILE.findall(readme.read_text()) if not exists(name, readme, source)]
    for folder in ("lib", "app", "tests"):
        for path in sorted((source / folder).rglob("*.[ch]pp")):
            for line, text in comments(path):
                errors += [f"{path}:{line}: ({number}) does not stand in lib/README.md" for number in sorted(numbers(text) - known)]
                errors += [f"{path}:{line}: there is no {name}" for name in FILE.findall(text) if not exists(name, path, source)]
    print("\n".join(errors))
    sys.exit(bool(errors))


main()
