#!/usr/bin/python3
"""Checks limits of app and lib (LIMITS): sizes of modules, folders, files, functions and classes; calls of collective functions; includes of headers;
and the length of the recipes in lib/README.md. Checks that includes have no cycle, and that wrappers of Dynamics override all its functions.
structure_exceptions.txt lists exceptions: `limit what value`. Their values may only decrease. Only a value of `tokens` may be raised, by hand
and with the reason in a comment at the end of its line.

Usage: structure.py <source directory> [--shrink]     --shrink reduces the values of exceptions to the current sizes
"""
import bisect
import collections
import pathlib
import re
import sys
import typing

from layers import OWNERS

LIMITS = {
    "tokens": 0,         # tokens of a module (app, or a folder of lib), and of all modules (`all`); each has an exception
    "files": 25,         # .cpp files of a folder
    "lines": 400,        # lines of a file
    "function": 60,      # lines of a function
    "public": 25,        # public functions of a class, without deleted and defaulted functions
    "members": 20,       # data members of a class
    "collectives": 0,    # calls of collective functions in a file, see Collectives
    "includes": 10,      # project headers that a header includes itself
    "brings": 100,       # project headers that a header includes itself or through other headers
    "trilinos": 0,       # Trilinos headers, and headers of TRILINOS that bring one, that a header outside of TRILINOS includes itself
    "recipe_lines": 12,  # lines of a recipe in lib/README.md, without empty lines
    "recipe_files": 5,   # files that a recipe names
}
STEP = {"tokens": 10, "brings": 10}  # exceptions are rounded up to multiples of these numbers, because many changes alter the values a little
TRILINOS = ("lib/system/solvers/", "lib/system/parallel/", "lib/system/blocks/tpetra", "lib/membrane/direct_solver")  # headers that may include Trilinos
MASKED = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<![0-9A-Fa-f])\'(?:\\.|[^\'\\\n])+\'|^[ \t]*#(?:\\\n|[^\n])*', re.DOTALL | re.MULTILINE)
NOT_DATA = re.compile(r"(using|typedef|friend|static|template|enum|class|struct|union|operator|extern|explicit|virtual)\b")
TOKEN = re.compile(r'//[^\n]*|/\*.*?\*/|R"\((?:.|\n)*?\)"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'|[A-Za-z_]\w*|\d[\w.\']*(?:[eE][+-]?\d+)?'
                   r'|<<=|>>=|<=>|->\*|\.\.\.|::|->|\+\+|--|<<|>>|<=|>=|==|!=|&&|\|\||[-+*/%&|^]=|[^\s\w]', re.DOTALL)
COLLECTIVE = re.compile(r"(?:\bTeuchos::|\.|->)(?:reduceAll\w*|gatherAll|broadcast|scan|barrier)\b|\bMPI_Comm_(?:dup|split|create)\w*\("
                        r"|\bMPI_I?(?i:all(?:reduce|gather|to)\w*|bcast|barrier|reduce\w*|(?:ex)?scan|gather\w*|scatter\w*)\("
                        r"|\bdo(?:Import|Export)\(|\b(?:norm[12]|normInf|meanValue)\(")
THIN = 3  # a function of at most this many lines that calls a collective function is a wrapper
WRAPPERS = {"Targets::gather", "apply_together", "set_together"}  # longer functions that are wrappers
EXCEPTION = re.compile(r"(\w+) (\S+) (\d+)((?: +#.*)?)")  # a line of structure_exceptions.txt: limit, what, value, reason
NAME = re.compile(r"([\w:~]+|operator[^\w\s(]+|operator\(\))\s*\(")
NOT_FUNCTION = re.compile(r"^(?:using|typedef|friend|static_assert)\b|=\s*(?:default|delete)$")
LISTS_OPTIONS = re.compile(r"(Options|Parameters|Settings)$")  # names of classes without limits of members and functions


def masked(text):
    """Replaces comments, literals and preprocessor lines by blanks, so that braces and lines keep their positions."""
    return MASKED.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), text)


def tokens(path):
    """Counts the tokens of a file without comments. A string literal counts as many tokens as it has words."""
    text = path.read_text()
    if path.suffix == ".py":
        text = re.sub(r"^\s*(\"\"\"|''').*?\1", "", re.sub(r"#[^\n]*", "", text), flags=re.DOTALL | re.MULTILINE)
    found = (match[0] for match in TOKEN.finditer(text) if not match[0].startswith(("//", "/*")))
    return sum(max(1, len(one.split())) if one[0] in '"R' and one.endswith('"') else 1 for one in found)


class Function(typing.NamedTuple):
    namespace: str
    owner: str  # class of a member function, without the classes around it; empty for a free function
    name: str
    lines: int
    body: str   # text from the parameters on

    def full_name(self):
        return f"{self.owner}::{self.name}" if self.owner else self.name


class Class:
    """Numbers of members of a class."""

    def __init__(self, name, public):
        self.name, self.public = name, public  # public: true if the next declaration is public
        self.data = self.functions = self.public_functions = 0

    def declare(self, head):
        """Counts the members that one declaration adds."""
        head = re.sub(r"\[\[.*?\]\]|alignas\([^)]*\)|\b(mutable|inline|constexpr|const)\b", " ", head).strip()
        head = re.sub(r"\boperator\s*(\(\)|[^\w\s(]+)", "operator", head)
        while re.search(r"<[^<>;]*>", head):
            head = re.sub(r"<[^<>;]*>", "", head)
        declared = re.split(r"=|{", head, maxsplit=1)[0]
        if re.match(r"[^(]*\((?!\*)", declared):  # `(*` begins the name of a pointer to a function
            counts = not NOT_FUNCTION.search(head)
            self.functions += counts
            self.public_functions += counts and self.public
        elif head and not NOT_DATA.match(head):
            while re.search(r"[({\[][^(){}\[\]]*[)}\]]", head):
                head = re.sub(r"[({\[][^(){}\[\]]*[)}\]]", "", head)
            self.data += 1 + head.count(",")


class Scopes:
    """The functions and classes of one file, found by counting braces."""

    def __init__(self, text):
        self.text, self.functions, self.classes, self.namespace = masked(text), [], [], ""
        self.newlines = [match.start() for match in re.finditer("\n", self.text)]
        self.closing, opened = {}, []
        for match in re.finditer(r"[{}]", self.text):
            if match[0] == "{":
                opened.append(match.start())
            else:
                self.closing[opened.pop()] = match.start()
        self.scope(0, len(self.text), None)

    def scope(self, at, end, owner):
        """Reads the declarations of a namespace (owner is None) or of the class `owner`."""
        while at < end:
            if self.text[at].isspace() or self.text[at] in ";}":
                at += 1
            else:
                at = self.declaration(at, end, owner)

    def declaration(self, start, end, owner):
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
                    self.define(head, start, close, owner)
                    return close + 1
                head, at = head + "{}", close
            elif letter == ";" and parentheses == 0:
                if owner:
                    owner.declare(head)
                return at + 1
            elif letter == ":" and re.fullmatch(r"\s*(public|private|protected)\s*", head):
                owner.public = "public" in head
                return at + 1
            else:
                head += letter
            at += 1
        return end

    def inner(self, head, at, close):
        """Reads a namespace or class that opens at `at`; returns its kind."""
        if re.match(r"\s*(inline\s+)?namespace\b|\s*extern\s*$", head):
            outer, names = self.namespace, re.findall(r"\w+", head)
            self.namespace = names[-1] if names[-1] not in ("namespace", "extern") else outer
            self.scope(at + 1, close, None)
            self.namespace = outer
            return "namespace"
        plain = re.sub(r"template\s*<[^{}]*?>\s*(?=(?:class|struct|requires)\b)", "", head.strip())
        match = re.match(r"(class|struct|union)\b\s*(?:alignas\([^)]*\)\s*)?([\w:]*)", plain)
        if not match or "(" in plain[match.end():]:
            return "other"
        self.classes.append(Class(match[2] or "unnamed", match[1] != "class"))
        self.scope(at + 1, close, self.classes[-1])
        return "class"

    def define(self, head, start, close, owner):
        """Stores a function with its body."""
        match = NAME.search(self.text, start, close)
        name = match[1] if match else (head.split() or ["unnamed"])[-1]
        *outer, last = name.split("::") if re.fullmatch(r"[\w:~]+", name) else [name]
        of = owner.name.split("::")[-1] if owner else outer[-1] if outer else ""
        body = self.text[match.end() if match else start:close]
        self.functions.append(Function(self.namespace, of, last, self.line(close) - self.line(start) + 1, body))
        if owner:
            owner.declare(head)

    def line(self, position):
        return bisect.bisect_left(self.newlines, position)


def included(source, files):
    """Returns {file: (project files, other headers)} of the includes of each file."""
    known, found = set(files), {}
    for path in files:
        names = re.findall(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', path.read_text(), re.MULTILINE)
        places = {name: [path.parent / name, source / "lib" / name, source / "app" / name] for name in names}
        own = {name: next((one for one in ones if one in known), None) for name, ones in places.items()}
        found[path] = [one for one in own.values() if one], [name for name, one in own.items() if not one]
    return found


def reached(path, includes):
    """Returns the project files that a file includes itself or through other files."""
    found, waiting = set(), list(includes[path][0])
    while waiting:
        one = waiting.pop()
        if one not in found:
            found.add(one)
            waiting += includes[one][0]
    return found


def has_trilinos(paths, includes):
    """Returns true if any of the files includes a Trilinos header itself."""
    return any(re.fullmatch(OWNERS["TRILINOS"], header) for path in paths for header in includes[path][1])


def cycles(source, includes):
    """Yields each cycle of includes."""
    done, chain = set(), []

    def visit(path):
        if path in chain:
            yield " -> ".join(one.relative_to(source).as_posix() for one in [*chain[chain.index(path):], path])
        elif path not in done:
            chain.append(path)
            for one in includes[path][0]:
                yield from visit(one)
            done.add(chain.pop())

    for path in includes:
        yield from visit(path)


class Collectives:
    """Finds the collective functions of the project, and counts their calls.

    A collective function is a function of lib/system/parallel that reaches a call of MPI or Teuchos, or a wrapper: a function of at most THIN lines,
    or one of WRAPPERS, that calls a collective function. Longer functions do not count, because almost every function up to main calls one
    indirectly. A call of a member function is found by the name before it: a variable or an accessor that app or lib declares with the class of the
    function. A free function is found by its namespace. The following calls are not found: through a variable declared with auto (unless another
    variable has the same name), a base class or a std::function; of constructors and operators; in initial values of members; and inside Belos,
    Anasazi and NOX."""

    def __init__(self, scopes):
        self.variables, self.known = collections.defaultdict(set), set()  # {class: names}, {(namespace or "", class or "", function)}
        for one in scopes.values():
            for name, variable in re.findall(r"\b([A-Z]\w*)\b(?:\s*const)?[\s&*>]+(\w+)\b", one.text):
                self.variables[name].add(variable)
        candidates = [one for path, scope in scopes.items() for one in scope.functions if one.name.lstrip("~") != one.owner
                      and (one.lines <= THIN or one.full_name() in WRAPPERS or path.parent.name == "parallel")]
        found = True
        while found:
            self.compile()
            found = {self.key(one) for one in candidates if self.calls(one)} - self.known
            self.known |= found

    def key(self, function):
        return ("", function.owner, function.name) if function.owner else (function.namespace, "", function.name)

    def compile(self):
        """Makes the patterns of the calls of all known functions."""
        groups = collections.defaultdict(set)
        for namespace, owner, name in self.known:
            groups[namespace, owner].add(re.escape(name))
        self.within, patterns = {}, [COLLECTIVE.pattern]  # within: patterns of calls without a qualifier, by (namespace, class)
        for (namespace, owner), names in groups.items():
            call = rf"(?:{'|'.join(sorted(names))})(?:<[^;(){{}}]*>)?\("
            self.within[namespace, owner] = re.compile(rf"(?<![.>\w:]){call}")
            before = "|".join(sorted({owner, *self.variables[owner]})) if owner else namespace
            patterns.append(rf"\b(?:{before})(?:\(\)|\[[^\]]*\])?(?:\.|->|::){call}" if owner else rf"\b{before}::{call}")
        self.pattern = re.compile("|".join(patterns))

    def calls(self, function):
        """Returns the number of calls of known functions in a function."""
        within = [self.within[key] for key in ((function.namespace, ""), ("", function.owner)) if key in self.within and key != ("", "")]
        return sum(len(pattern.findall(function.body)) for pattern in [self.pattern, *within])


def recipes(text):
    """Yields (name, lines) of each recipe in the section Recipes. A recipe begins with a heading, or with a paragraph that has a bold name in its
    first sentence, and ends before the next recipe. Empty lines are left out."""
    name, lines, after_empty = None, [], True
    for line in re.split(r"^## ", text.split("\n## Recipes\n")[1], flags=re.MULTILINE)[0].splitlines():
        begins = re.match(r"#+ (.*)|(?![\s\d])[^.:]*?\*\*(.+?)\*\*", line) if after_empty else None
        if begins:
            yield name, lines
            name, lines = re.sub(r"\W+", " ", (begins[1] or begins[2]).lower()).strip().replace(" ", "_"), []
        lines += [line] if line.strip() else []
        after_empty = not line.strip()
    yield name, lines


class Measured(dict):
    """Values by limit and by the name of the file, folder, module, function, class or recipe."""

    def put(self, limit, what, value):
        """Stores a value, if no larger value has the same name."""
        self[limit, what] = max(value, self.get((limit, what), 0))

    def measure_file(self, name, scopes, collectives):
        self.put("lines", name, scopes.text.count("\n"))
        self.put("collectives", name, sum(collectives.calls(one) for one in scopes.functions))
        for one in scopes.functions:
            self.put("function", f"{name}:{one.full_name()}", one.lines)
        for one in scopes.classes:
            if not LISTS_OPTIONS.search(one.name) and (one.functions or not name.endswith("options.hpp")):
                self.put("members", f"{name}:{one.name}", one.data)
                self.put("public", f"{name}:{one.name}", one.public_functions)

    def measure_header(self, source, path, includes):
        name, brought = path.relative_to(source).as_posix(), reached(path, includes)
        self.put("includes", name, len(includes[path][0]))
        self.put("brings", name, len(brought))
        if not name.startswith(TRILINOS):
            doors = [one for one in includes[path][0] if one.relative_to(source).as_posix().startswith(TRILINOS)]
            self.put("trilinos", name, has_trilinos([path], includes) + sum(has_trilinos([one, *reached(one, includes)], includes) for one in doors))

    def measure_folders(self, source, files):
        scripts = [path for folder in ("app", "lib") for path in (source / folder).rglob("*.py")]
        for path in [*files, *scripts]:
            parts = path.relative_to(source).parts
            for module in ("/".join(parts[:2]) if parts[0] == "lib" and len(parts) > 2 else parts[0], "all"):
                self["tokens", module] = self.get(("tokens", module), 0) + tokens(path)
        for folder in {path.parent for path in files}:
            self.put("files", folder.relative_to(source).as_posix(), sum(path.suffix == ".cpp" and path.parent == folder for path in files))

    def measure_recipes(self, source):
        for name, lines in recipes((source / "lib/README.md").read_text()):
            if name:
                named = re.findall(r"[\w./-]+\.(?:hpp|cpp|py|md|cmake|txt)\b", "\n".join(lines))
                self.put("recipe_lines", f"lib/README.md:{name}", len(lines))
                self.put("recipe_files", f"lib/README.md:{name}", len(set(named)))


def measured(source, files, includes):
    """Returns the values of all limits."""
    values, scopes = Measured(), {path: Scopes(path.read_text()) for path in files}
    collectives = Collectives(scopes)
    for path in files:
        values.measure_file(path.relative_to(source).as_posix(), scopes[path], collectives)
        if path.suffix == ".hpp":
            values.measure_header(source, path, includes)
    values.measure_folders(source, files)
    values.measure_recipes(source)
    return values


def unforwarded(source):
    """Yields each virtual function of Dynamics that its wrapper does not override."""
    functions = re.findall(r"virtual [\w:<>&*, ]*?\b(\w+)\(", masked((source / "lib/system/dynamics.hpp").read_text()))
    wrapper = "lib/motion/guarded.hpp"
    overridden = set(re.findall(r"(\w+)\([^;{}]*\)(?: const)? override", masked((source / wrapper).read_text())))
    yield from (f"{wrapper}: does not forward Dynamics::{name}" for name in functions if name not in overridden)


def rounded(limit, value):
    """Returns the smallest exception that admits a value."""
    step = STEP.get(limit, 1)
    return -(-value // step) * step


def shrunk(lines, values):
    """Yields the lines of structure_exceptions.txt with values that are as small as possible, without exceptions that are not needed."""
    for line in lines:
        match = EXCEPTION.fullmatch(line)
        value = values.get((match[1], match[2]), 0) if match else 0
        if not match or match[1] not in LIMITS:
            yield line
        elif value > LIMITS[match[1]]:
            yield f"{match[1]} {match[2]} {min(int(match[3]), rounded(match[1], value))}{match[4]}"


def main():
    source, list_of = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(__file__).with_name("structure_exceptions.txt")
    files = sorted(path for folder in ("app", "lib") for path in (source / folder).rglob("*") if path.suffix in (".cpp", ".hpp"))
    includes = included(source, files)
    values, exceptions = measured(source, files, includes), {}
    if "--shrink" in sys.argv:
        list_of.write_text("".join(f"{line}\n" for line in shrunk(list_of.read_text().splitlines(), values)))
    errors = [f"a cycle of includes: {cycle}" for cycle in cycles(source, includes)] + list(unforwarded(source))
    for line in list_of.read_text().splitlines():
        match = EXCEPTION.fullmatch(line)
        if match and match[1] in LIMITS and (match[1], match[2]) not in exceptions:
            exceptions[match[1], match[2]] = int(match[3])
        elif line and not line.startswith("#"):
            errors.append(f"{list_of.name}: unknown limit, repeated or not `limit what value`: {line}")
    for limit, what in sorted(values.keys() | exceptions.keys()):
        value, exception = values.get((limit, what), 0), exceptions.get((limit, what))
        if value > max(LIMITS[limit], exception or 0):
            errors.append(f"{limit} {what} {value}: at most {max(LIMITS[limit], exception or 0)}")
        elif exception is not None and (rounded(limit, value) < exception or value <= LIMITS[limit]):
            errors.append(f"{limit} {what} {value}: the exception of {exception} is larger than needed; structure.py <source directory> --shrink lowers it")
    print("\n".join(errors))
    sys.exit(bool(errors))


if __name__ == "__main__":
    main()
