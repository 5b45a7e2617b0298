#!/usr/bin/python3
"""Checks limits of size in app and lib: .cpp files per folder, lines per file and function, data members per class.
Checks that includes have no cycle, that only files that exchange unknowns, sum or record make collective calls, and that
wrappers of Dynamics override all its functions.
structure_exceptions.txt lists exceptions; their values may only decrease.

Usage: structure.py <source directory> [--shrink]     --shrink reduces the values of exceptions to the current sizes
"""
import bisect
import pathlib
import re
import sys

LIMITS = {"files": 25, "lines": 400, "members": 25, "function": 60, "collectives": 0}
# Files that may make collective calls, because they define these calls, exchange unknowns (row share, block system), sum
# contributions, or record results.
MAY_CALL = {"ranks", "agreement", "row_share", "vectors", "system", "results", "record"}
COLLECTIVE = re.compile(r"\branks_?(?:\(\))?(?:\.|->)(?:replicate|add|add_all|any|own)\(|\bdo(?:Import|Export)\(|\bcoupling::largest\("
                        r"|\b(?:error_of_any|take_first|of_first)\(|\bTeuchos::(?:reduceAll|gatherAll|broadcast|scan|barrier)\("
                        r"|\bMPI_(?:I?(?:All|B|R)(?:reduce|gather|to|cast|arrier)\w*|Scan|Gather\w*|Scatter\w*)\(")
MASKED = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<![0-9A-Fa-f])\'(?:\\.|[^\'\\\n])+\'|^[ \t]*#(?:\\\n|[^\n])*', re.DOTALL | re.MULTILINE)
NOT_DATA = re.compile(r"(using|typedef|friend|static|template|enum|class|struct|union|operator|extern|explicit|virtual)\b")


def masked(text):
    """Replaces comments, literals and preprocessor lines by blanks, so that braces and lines keep their positions."""
    return MASKED.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), text)


class Scopes:
    """The functions (name, lines) and classes (name, data members) of one file, found by counting braces."""

    def __init__(self, text):
        self.text, self.functions, self.classes = masked(text), [], []
        self.newlines = [match.start() for match in re.finditer("\n", self.text)]
        self.closing, opened = {}, []
        for match in re.finditer(r"[{}]", self.text):
            if match[0] == "{":
                opened.append(match.start())
            else:
                self.closing[opened.pop()] = match.start()
        self.scope(0, len(self.text), None)

    def scope(self, at, end, members):
        """Reads the declarations of a namespace (members is None) or of a class, whose data members it counts in members[0]."""
        while at < end:
            if self.text[at].isspace() or self.text[at] in ";}":
                at += 1
            else:
                at = self.declaration(at, end, members)

    def declaration(self, start, end, members):
        """Reads one declaration and returns the position after it."""
        at, parentheses, head = start, 0, ""
        while at < end:
            letter = self.text[at]
            parentheses += (letter == "(") - (letter == ")")
            if letter == "{" and parentheses == 0:
                close = self.closing[at]
                kind = self.inner(head, at, close)
                if kind == "namespace":
                    return close + 1
                following = self.text[close + 1:end].lstrip()
                if kind != "class" and not following.startswith((",", ";", "{", ")", "=", "catch ")):  # the body, and not the braces of an initializer
                    self.functions.append((self.name(head), self.line(close) - self.line(start) + 1))
                    return close + 1
                head, at = head + "{}", close
            elif letter == ";" and parentheses == 0:
                if members is not None:
                    members[0] += self.data_members(head)
                return at + 1
            elif letter == ":" and re.fullmatch(r"\s*(public|private|protected)\s*", head):
                return at + 1
            else:
                head += letter
            at += 1
        return end

    def inner(self, head, at, close):
        """Reads a namespace or class that opens at `at`; returns its kind."""
        if re.match(r"\s*(inline\s+)?namespace\b|\s*extern\s*$", head):
            self.scope(at + 1, close, None)
            return "namespace"
        plain = re.sub(r"template\s*<[^{}]*?>\s*(?=(?:class|struct|requires)\b)", "", head.strip())
        match = re.match(r"(?:class|struct|union)\b\s*(?:alignas\([^)]*\)\s*)?([\w:]*)", plain)
        if not match or "(" in plain[match.end():]:
            return "other"
        members = [0]
        self.scope(at + 1, close, members)
        self.classes.append((match[1] or "unnamed", members[0]))
        return "class"

    def data_members(self, head):
        """Counts the data members that a declaration of a class adds."""
        head = re.sub(r"\[\[.*?\]\]|alignas\([^)]*\)|\b(mutable|inline|constexpr|const)\b", " ", head).strip()
        if not head or NOT_DATA.match(head):
            return 0
        while re.search(r"<[^<>;]*>", head):
            head = re.sub(r"<[^<>;]*>", "", head)
        declared = re.split(r"=|{", head, maxsplit=1)[0]
        if "(" in declared and "(*" not in declared:
            return 0
        while re.search(r"[({\[][^(){}\[\]]*[)}\]]", head):
            head = re.sub(r"[({\[][^(){}\[\]]*[)}\]]", "", head)
        return 1 + head.count(",")

    def name(self, head):
        match = re.search(r"([\w:~]+|operator[^\w\s(]+|operator\(\))\s*\(", head)
        return match[1] if match else head.split()[-1] if head.split() else "unnamed"

    def line(self, position):
        return bisect.bisect_left(self.newlines, position)


def measured(source, files):
    """Returns {(limit, file, folder, function or class): value} for all limits."""
    values = {}

    def take(limit, what, value):
        values[limit, what] = max(value, values.get((limit, what), 0))

    for path in files:
        name, text = path.relative_to(source).as_posix(), path.read_text()
        take("lines", name, text.count("\n"))
        scopes = Scopes(text)
        for function, lines in scopes.functions:
            take("function", f"{name}:{function}", lines)
        for one, members in scopes.classes:
            take("members", f"{name}:{one}", members)
        if path.stem not in MAY_CALL and "record" not in path.parts:
            take("collectives", name, len(COLLECTIVE.findall(scopes.text)))
    for folder in {path.parent for path in files}:
        take("files", folder.relative_to(source).as_posix(), sum(path.suffix == ".cpp" for path in files if path.parent == folder))
    return values


def cycles(source, files):
    """Yields each cycle of includes."""
    known = set(files)
    includes = {path: [found for name in re.findall(r'^\s*#\s*include\s*"([^"]+)"', path.read_text(), re.MULTILINE)
                       for found in (path.parent / name, source / "lib" / name, source / "app" / name) if found in known] for path in files}
    done, chain = set(), []

    def visit(path):
        if path in chain:
            yield " -> ".join(one.relative_to(source).as_posix() for one in [*chain[chain.index(path):], path])
        elif path not in done:
            chain.append(path)
            for one in includes[path]:
                yield from visit(one)
            done.add(chain.pop())

    for path in files:
        yield from visit(path)


def unforwarded(source):
    """Yields each virtual function of Dynamics that its wrapper does not override."""
    functions = re.findall(r"virtual [\w:<>&*, ]*?\b(\w+)\(", masked((source / "lib/system/dynamics.hpp").read_text()))
    wrapper = "lib/motion/guarded.hpp"
    overridden = set(re.findall(r"(\w+)\([^;{}]*\)(?: const)? override", masked((source / wrapper).read_text())))
    yield from (f"{wrapper}: does not forward Dynamics::{name}" for name in functions if name not in overridden)


def main():
    source, list_of = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(__file__).with_name("structure_exceptions.txt")
    files = sorted(path for folder in ("app", "lib") for path in (source / folder).rglob("*") if path.suffix in (".cpp", ".hpp"))
    values, exceptions = measured(source, files), {}
    for line in list_of.read_text().splitlines():
        if line and not line.startswith("#"):
            limit, what, value = line.split()
            exceptions[limit, what] = int(value)
    if "--shrink" in sys.argv:
        head = [line for line in list_of.read_text().splitlines() if line.startswith("#")]
        kept = {key: min(value, values.get(key, 0)) for key, value in exceptions.items() if values.get(key, 0) > LIMITS[key[0]]}
        list_of.write_text("\n".join([*head, *(f"{limit} {what} {value}" for (limit, what), value in sorted(kept.items()))]) + "\n")
        exceptions = kept
    errors = [f"a cycle of includes: {cycle}" for cycle in cycles(source, files)] + list(unforwarded(source))
    for limit, what in sorted(values.keys() | exceptions.keys()):
        value, exception = values.get((limit, what), 0), exceptions.get((limit, what))
        if value > max(LIMITS[limit], exception or 0):
            errors.append(f"{limit} {what} {value}: at most {max(LIMITS[limit], exception or 0)}")
        elif exception is not None and value < exception:
            errors.append(f"{limit} {what} {value}: the exception of {exception} is larger than needed; structure.py <source directory> --shrink lowers it")
    print("\n".join(errors))
    sys.exit(bool(errors))


if __name__ == "__main__":
    main()
