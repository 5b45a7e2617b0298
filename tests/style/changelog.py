#!/usr/bin/python3
"""Checks the form of CHANGELOG.md, so that a user finds in a minute whether to upgrade: releases with dates, six headings in a fixed order, one short
line with a link per change, and three lines that answer whether decks run, numbers change and checkpoints resume.

Usage: changelog.py <source directory>
"""
import datetime
import pathlib
import re
import sys

HEADINGS = ["Before you upgrade", "Wrong results in earlier releases", "Added", "Changed", "Fixed", "Removed"]
ANSWERS = ["- Decks: ", "- Numbers: ", "- Checkpoints: "]  # first lines of "Before you upgrade"
RELEASE = re.compile(r"## (?:Unreleased|(\d+\.\d+\.\d+) \((\d{4}-\d\d-\d\d)\))")
LINK = re.compile(r"\[([^\]]+)\]\(([^)\s]+)\)")
BYTES, LINES, WORDS = 20000, 60, 20  # limits of the file, of a release and of a line


def anchors(path):
    """Returns the anchors of the headings of a Markdown file, as GitHub forms them."""
    headings = re.findall(r"^#+ (.*)$", path.read_text(), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def link_errors(source, target):
    name, _, anchor = target.partition("#")
    if not (source / name).exists():
        yield f"a link to {target}, which does not exist"
    elif anchor and anchor not in anchors(source / name):
        yield f"a link to {target}, but {name} has no such heading"


def line_errors(source, line):
    links = LINK.findall(line)
    words = len(LINK.sub(r"\1", line.removeprefix("- ")).split())
    if words > WORDS:
        yield f"{words} words; at most {WORDS}"
    if not links:
        yield "no link to a page that explains the change"
    for _, target in links:
        yield from link_errors(source, target)


def order_errors(releases):
    """Yields what is wrong in the sequence of (version, date); both are None for Unreleased."""
    if any(version is None for version, _ in releases[1:]):
        yield "Unreleased must be the first section"
    dated = [(tuple(map(int, version.split("."))), date) for version, date in releases if version]
    if any(newer[0] <= older[0] or newer[1] < older[1] for newer, older in zip(dated, dated[1:])):
        yield "releases must be in the order of their versions and dates, the newest first"
    for _, date in dated:
        try:
            datetime.date.fromisoformat(date)
        except ValueError:
            yield f"there is no day {date}"


def release_errors(source, title, body):
    """Yields (line, error) of one release, whose body is a list of (number, line) without empty lines."""
    if body and body[-1][0] - title >= LINES:
        yield title, f"{body[-1][0] - title + 1} lines; at most {LINES}"
    headings = [line.removeprefix("### ") for _, line in body if line.startswith("#")]
    if headings != [heading for heading in HEADINGS if heading in headings]:
        yield title, f"headings {headings}; they must be some of {HEADINGS}, in this order"
    if HEADINGS[0] not in headings:
        yield title, f"no heading '{HEADINGS[0]}'"
    lines = [line for _, line in body]
    if [line[:len(answer)] for line, answer in zip(lines[1:], ANSWERS)] != ANSWERS:
        yield title, f"the lines after '{HEADINGS[0]}' must begin with {ANSWERS}"
    for k, (number, line) in enumerate(body):
        if line.startswith("### "):
            if k + 1 == len(body) or lines[k + 1].startswith("#"):
                yield number, "a heading without lines"
        elif not line.startswith("- "):
            yield number, "a line that does not begin with '- '"
        else:
            for error in line_errors(source, line):
                yield number, error


def errors(source):
    """Yields (line, error) for the whole file."""
    text = (source / "CHANGELOG.md").read_text()
    if len(text.encode()) >= BYTES:
        yield 1, f"{len(text.encode())} bytes; must be below {BYTES}"
    lines = [(number, line) for number, line in enumerate(text.splitlines(), 1) if line]
    starts = [k for k, (_, line) in enumerate(lines) if line.startswith("## ")]
    releases = []
    for start, end in zip(starts, [*starts[1:], len(lines)]):
        number, title = lines[start]
        if not (match := RELEASE.fullmatch(title)):
            yield number, "must be '## Unreleased' or '## <version> (<year>-<month>-<day>)'"
            continue
        releases.append(match.groups())
        yield from release_errors(source, number, lines[start + 1:end])
    for error in order_errors(releases):
        yield 1, error


found = [f"CHANGELOG.md:{number}: {error}" for number, error in errors(pathlib.Path(sys.argv[1]))]
print("\n".join(found))
sys.exit(bool(found))
