"""Reads tables of numbers as spreadsheets and instruments write them. lib/deck/table.cpp has the same rules:

- Semicolons, tabs, commas or spaces separate the columns. Numbers have decimal points or, in all columns, decimal
  commas.
- `#` begins a comment, and so does `%` at the beginning of a line. Empty lines and trailing separators have no meaning.
- Lines before the first row of numbers are titles, names of the columns, and units. Names may also be in the last
  comment before the first row. If the reader of the table knows the names, they decide which column is which.
- What has two meanings is refused: 1,234 may be a thousand, and 0,5,1,2 may be two numbers or four."""

import dataclasses
import re

import numpy

from .files import bytes_of
from .mistakes import Mistake, expect

SEPARATORS = {";": "semicolons", "\t": "tabs", ",": "commas", " ": "spaces"}
UNQUOTED = r'(?=(?:[^"]*"[^"]*")*[^"]*$)'  # an even number of quotes follows
NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+|\d*,\d+)(?:[eEdD][+-]?\d+)?", re.A)
THOUSANDS = re.compile(r"[+-]?[1-9]\d{0,2},\d{3}", re.A)
MISSING = re.compile(r"nan|n/?a|null|none|[+-]?inf", re.I)
ONE_UNIT = (r"(?:(?:milli|micro|nano|pico|centi|kilo)?(?:met(?:er|re)|second|newton|pascal|gram|joule|poise|dyne)s?"
            r"|microns?|sec|min|minutes?|hours?|deg|degrees?|rad|radians?|px|pixels?"
            r"|[fpnuµμmcdkMG]?(?:m|s|N|Pas?|g|J|Hz|P|dyn)|h|°|%|1)(?:(?:\^|\*\*)?[-⁻]?[\d⁰¹²³⁴])?")
UNIT = re.compile(rf"{ONE_UNIT}(?:[ */·.]+{ONE_UNIT})*|[-–]?", re.A)
# a name and its unit: in brackets, after a slash or a comma, or as the last word
NAMED = [re.compile(pattern) for pattern in (
    r"(.*?)\s*[\[(](.*)[\])]", r"(.+?)\s*/\s*(.+)", r"(.+),\s*(.+)", r"(.+)[ _]([^\s\d-]\S*)")]
SYNONYMS = {"x": "x1", "y": "x2", "z": "x3", "points:0": "x1", "points:1": "x2", "points:2": "x3", "t": "time"}
SYNONYMS |= dict.fromkeys(("err", "sd", "std", "stdev", "se", "sem", "stderr", "sigma", "uncertainty", "standarderror",
                           "standarddeviation"), "error")
UNUSED = {"", "id", "index", "no", "nr", "error"}  # names of columns that are left out if they are not wanted


@dataclasses.dataclass
class Table:
    """`columns`: names, as wanted or as the file states them (`column 1` … if it has none). `units`: texts as the file
    states them, "1" if dimensionless, None if it states none. `values`: (rows, columns). `lines`: line of each row."""
    columns: list
    units: list
    values: numpy.ndarray
    lines: list


class _Wrong(Exception):
    """A table that cannot be read with one of the separators: line and what is wrong there."""

    def __init__(self, line, text):
        super().__init__(text)
        self.line = line


def _text_of(path):
    data = bytes_of(path)
    expect(b"\0" not in data and data[:2] not in (b"\xff\xfe", b"\xfe\xff"),
           f"{path} is a workbook, another binary file, or text in UTF-16: save the table as CSV in UTF-8")
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("latin-1")
    return text.replace("\u2212", "-")  # the minus sign


def _fields(text, separator):
    """Returns the fields of a line without blanks and quotes around them, and without empty ones at the end."""
    text, between = (text.strip(" \t"), " +") if separator == " " else (text, separator)
    parts = re.split(between + (UNQUOTED if '"' in text else ""), text)
    parts = [re.sub(r'^"(.*)"$', r"\1", part.strip(" \t")).strip(" \t") for part in parts]
    while parts and not parts[-1]:
        parts.pop()
    return parts


def _number(field):
    return float(field.lower().replace("d", "e").replace(",", "."))


def _key(name):
    """Returns the name in lower case without blanks and underscores. Names with the same meaning have the same key."""
    name = re.sub(r"[\s_]", "", name).lower()
    return SYNONYMS.get(name, name)


def _name_and_unit(text):
    text = text.strip(" \t,;:")
    for pattern in NAMED:
        found = pattern.fullmatch(text)
        if found and UNIT.fullmatch(found[2].strip()):
            return found[1].strip(), found[2].strip() or "-"
    return text, ""


def _names(text, separator, count, own=True):
    """Returns the fields of a line of `count` names; None if it is no such line. `own`: whether it has the separator of
    the rows; otherwise another one."""
    tries = [_fields(text, separator)]
    if separator == " " or not own and separator not in text:
        tries = [_fields(text, one) for one in ";\t," if separator != ","]  # 0,5 below a;b may be one number
        tries += [_fields(re.sub(" {2,}", "\t", text.strip()), "\t")]
        joined = re.sub(r"\s+(?=[\[(])|\s*(/)\s*", r"\1", text)  # without blanks before units
        tries += [_fields(joined, " "), _fields(text, " ")]
    return next((names for names in tries if len(names) == count), None)


def _units(text, separator, count):
    """Returns the fields of a line of units, with or without brackets; None if it is no such line."""
    fields = [re.sub(r"^[\[(](.*)[\])]$", r"\1", field).strip() for field in _fields(text, separator)]
    fields += [""] * (count - len(fields))
    return fields if len(fields) == count and all(map(UNIT.fullmatch, fields)) else None


def _header(head, notes, separator, count, keys):
    """Returns the line, the names and the units of the columns, or None if there are none. `head`: lines before the
    first row. `notes`: comments before it. `keys`: names that are expected."""
    lines = head or notes[-2:]
    own = any(_names(text, separator, count) for _, text in lines)
    for k, (line, text) in enumerate(lines):
        names, below = _names(text, separator, count, own), [_units(one, separator, count) for _, one in lines[k + 1:]]
        if names is None or not head and None in below:
            continue
        if None in below or len(below) > 1:
            raise _Wrong(lines[k + 1][0], "this line is neither numbers nor the units of the columns: begin it with #")
        names, units = zip(*map(_name_and_unit, names))
        units = [one or own for one, own in zip(below[0] if below else units, units)]
        if head or any(units) or keys & set(map(_key, names)):
            return line, names, [None if not one else "1" if one in "-–" else one for one in units]
    if head:
        raise _Wrong(head[-1][0], f"this line does not name as many columns as a row has numbers, {count}" +
                     ("; decimal commas need semicolons or tabs between the columns" if separator == "," else ""))
    return None


def _order(names, wanted, counts, others):
    """Returns {wanted name: index} in the wanted order; None if the names of all columns, `names`, do not decide it."""
    keys = list(map(_key, names))
    picked = {name: keys.index(_key(name)) for name in wanted if _key(name) in keys}
    free = [k for k, key in enumerate(keys) if k not in picked.values() and key not in UNUSED]
    missing = [name for name in wanted[:min(counts)] if name not in picked]
    if missing == ["value"] and len(free) == 1:
        picked["value"], free, missing = free[0], [], []
    if "error" in picked:  # the first one after the value
        after = keys[picked.get("value", -1) + 1:]
        picked["error"] = len(keys) - len(after) + after.index("error") if "error" in after else picked["error"]
    twice = [name for name in picked if name != "error" and keys.count(_key(name)) > 1]
    if missing or twice or len(picked) not in counts or free and not others:
        return None
    return {name: picked[name] for name in wanted if name in picked}


def _check(rows, separator, nan):
    """Raises _Wrong at the first row that does not hold numbers, as many as the first one."""
    commas, points, count = [], [], len(rows[0][1])
    for line, row in rows:
        for field in row:
            if nan and field.lower() == "nan":
                continue
            if not NUMBER.fullmatch(field):
                raise _Wrong(line, f'"{field}" is not a number' if field else "a value is missing")
            if not abs(_number(field)) < 1e75:
                raise _Wrong(line, f'"{field}" is not a number below 1e75 in size')
            if separator in ", " and re.fullmatch(r"0\d+", field):
                raise _Wrong(line, f'"{field}" may be the end of a number: decimal commas need semicolons or tabs '
                             "between the columns, and separators of thousands are not accepted")
            (commas if "," in field else points).extend([(line, field)] * (not field.isdigit()))
        if len(row) != count or count < 2:
            raise _Wrong(line, f"this row holds {len(row)} number{'s' * (len(row) > 1)}" +
                         (f", but the first row {count}" if len(row) != count else ""))
    points = [(line, field) for line, field in points if "." in field]
    if commas and points:
        raise _Wrong(commas[0][0], f'"{commas[0][1]}" has a decimal comma, but "{points[0][1]}" in line {points[0][0]} '
                     "has a decimal point")
    if commas and all(THOUSANDS.fullmatch(field) for _, field in commas):
        line, field = commas[0]
        raise _Wrong(line, f'"{field}" may be {field.replace(",", ".")} or {field.replace(",", "")}: write decimal '
                     "points, and no separators of thousands")


def _rows(lines, separator, nan):
    """Returns the lines before the first row of numbers, and (line, fields) of all rows. Raises _Wrong if the
    separator is another one."""
    split = [(line, _fields(text, separator)) for line, text in lines]
    first = next((k for k, (_, row) in enumerate(split) if any(map(NUMBER.fullmatch, row))), len(split))
    for line, row in split[:first]:
        for field in filter(MISSING.fullmatch, row):
            raise _Wrong(line, f'"{field}" is not a number')
    if first == len(split):
        raise _Wrong(lines[0][0], "no row of numbers follows")
    _check(split[first:], separator, nan)
    return lines[:first], split[first:]


def _check_unnamed(rows, separator, counts):
    """Raises _Wrong if the number of columns, of which no names are known, is wrong or uncertain."""
    line, count = rows[0][0], len(rows[0][1])
    if counts and count not in counts:
        raise _Wrong(line, f"this row holds {count} numbers")
    halves = separator == "," or separator == " " and all(len(field) == 3 for _, row in rows for field in row[1::2])
    whole = all(re.fullmatch(r"[+-]?\d+", field) for _, row in rows for field in row)
    if halves and whole and count % 2 == 0 and count // 2 >= min(counts, default=2):
        raise _Wrong(line, f"these may be {count} whole numbers, or {count // 2} with decimal commas or separators of "
                     "thousands: name the columns in the first line, or write decimal points")


def _table(head, rows, notes, separator, wanted, counts, others):
    count = len(rows[0][1])
    order = range(count)
    header = _header(head, [note for note in notes if note[0] < rows[0][0]], separator, count, set(map(_key, wanted)))
    if header:
        line, names, units = header
        if wanted:
            picked = _order(names, wanted, counts, others)
            if picked is None:
                raise _Wrong(line, "the names of the columns are " + ", ".join(name or '""' for name in names))
            names, order = zip(*picked.items())
    else:
        _check_unnamed(rows, separator, counts)
        names, units = wanted[:count] or [f"column {k + 1}" for k in order], [None] * count
    return Table(list(names), [units[k] for k in order],
                 numpy.array([[_number(row[k]) for k in order] for _, row in rows]), [line for line, _ in rows])


def read(path, wanted=(), counts=(), others=False, nan=False):
    """Returns the Table in a file. Raises Mistake if there is none, or if it is not certain what it holds.

    wanted: names of the columns in their order, such as ("x1", "x2", "x3"). If the file has names, these decide which
        column is which. A column that is wanted as `value` may have any name. By default, all columns are returned
    counts: possible numbers of columns, if the last ones of `wanted` are optional (default: all)
    others: whether the file may have further columns, if it has names
    nan: whether a number may be `nan`"""
    wanted = list(wanted)
    counts = counts or [len(wanted)] * bool(wanted)
    lines, notes = [], []
    for line, text in enumerate(re.split("\r\n|\r|\n", _text_of(path)), 1):
        bare, _, note = text.partition("#") if not text.lstrip().startswith("%") else ("", "", text.lstrip()[1:])
        if bare.strip(" \t,;") and not re.match('"?sep=', bare):  # Excel's `sep=;`
            lines.append((line, bare))
        elif note.strip():
            notes.append((line, note))
    expected = (f"{' or '.join(map(str, counts))} columns of numbers, {', '.join(wanted)}" if wanted else
                "at least two columns of numbers")
    expect(lines, f"{path} holds no numbers; expected are {expected}")
    tried = []  # (line of the first mistake, mistake, separator, content)
    for separator in [one for one in SEPARATORS if any(one in text.strip() for _, text in lines)] or [" "]:
        try:
            tried.append((numpy.inf, None, separator, _rows(lines, separator, nan)))
        except _Wrong as wrong:
            tried.append((wrong.line, wrong, separator, None))
    _, mistake, separator, content = max(tried, key=lambda one: one[0])
    try:
        if mistake:
            raise mistake
        return _table(*content, notes, separator, wanted, counts, others)
    except _Wrong as wrong:
        used = any(separator in text.strip() for _, text in lines)
        found = f"columns separated by {SEPARATORS[separator]}" if used else "no separator"
        raise Mistake(f"{path}, line {wrong.line}, {found}: {wrong}; expected are {expected}") from None
