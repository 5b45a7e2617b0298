"""Draws a figure from a Markdown table. A page of the manual asks for it below the table:

    ```{table-figure} The caption.
    :x: column         numbers along the axis; without it each row is a category, named by its first cells (:label:)
    :y: column; column
    :by: column        one curve per value of this column; an empty cell repeats the cell above
    :across: yes       the header has the numbers along the axis, and each row is a curve
    :split: yes        a row with values separated by ";" is several rows
    :log: xy           logarithmic axes
    ```
Further options: :label: columns; :xlabel:, :ylabel: texts; :percent: yes, "1 %" is 0.01; :below: largest value drawn;
:height: inches; :points: yes, no lines. A cell without a number is left out; the first number of a cell counts."""

import re

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt

NUMBER = re.compile(r"[-−+]?\d[\d,]*(?:\.\d+)?(?:e[-+−]?\d+)?")
plt.rcParams |= {"svg.hashsalt": "tanktread", "font.size": 9, "axes.grid": True, "grid.alpha": 0.3,
                 "legend.fontsize": 8}


def plain(text):
    """Returns the text of a cell without Markdown's marks."""
    return text.replace("`", "").replace("\\", "").replace("$", "").strip()


def number(text, percent=False):
    """Returns the first number in a cell, or None."""
    found = NUMBER.search(text)
    if not found:
        return None
    value = float(found[0].replace(",", "").replace("−", "-"))
    return value / 100 if percent and "%" in text else value


def cells(line):
    return [cell.strip().replace("\\|", "|") for cell in re.split(r"(?<!\\)\|", line.strip()[1:-1])]


def rows_of(lines, split):
    """Returns the header and the rows of a table; an empty first cell repeats the cell above."""
    header, rows = cells(lines[0]), []
    for line in lines[2:]:
        row = cells(line)
        row += [""] * (len(header) - len(row))
        parts = max(len(cell.split(";")) for cell in row) if split else 1
        for part in range(parts):
            rows.append([cell.split(";")[part].strip() if len(cell.split(";")) == parts > 1 else cell for cell in row])
    return header, rows


def filled(rows, column):
    """Returns a column in which an empty cell repeats the cell above."""
    found, last = [], ""
    for row in rows:
        last = row[column] or last
        found.append(last)
    return found


def column(header, name):
    names = [plain(one) for one in header]
    if plain(name) not in names:
        raise ValueError(f"no column '{name}' in {names}")
    return names.index(plain(name))


def curves(header, rows, options):
    """Yields (label, x, y) of the curves over numbers."""
    percent = "percent" in options
    labels = [column(header, name) for name in options.get("label", header[0]).split(";")]
    if "across" in options:
        columns = [k for k in range(len(header)) if k not in labels and number(header[k]) is not None]
        texts = zip(*(filled(rows, k) for k in labels))
        for row, text in zip(rows, texts):
            points = [(number(header[k]), number(row[k])) for k in columns]
            yield plain(", ".join(text)), [p for p in points if p[1] is not None]
        return
    x = filled(rows, column(header, options["x"]))
    groups = filled(rows, column(header, options["by"])) if "by" in options else [""] * len(rows)
    for name in options["y"].split(";"):
        k = column(header, name)
        for group in dict.fromkeys(groups):
            points = [(number(a), number(row[k], percent)) for a, row, g in zip(x, rows, groups) if g == group]
            named = f"{options['by']} {group}" if NUMBER.match(group) else group
            label = name if not group else f"{named}, {name}" if ";" in options["y"] else named
            yield plain(label), sorted(p for p in points if None not in p)


def draw(lines, options, path):
    """Draws the table `lines` to the file `path`."""
    header, rows = rows_of(lines, "split" in options)
    scale, positive = options.get("log", ""), {}
    if "x" in options or "across" in options:
        figure, axes = plt.subplots(figsize=(6.6, float(options.get("height", 4))))
        many = 0
        for k, (label, points) in enumerate(curves(header, rows, options)):
            points = [p for p in points if ("x" not in scale or p[0] > 0) and ("y" not in scale or p[1] > 0)]
            if points:
                many += 1
                axes.plot(*zip(*points), "osv^D<>"[k % 7] + ("" if "points" in options else "--" if k > 9 else "-"), label=label, markersize=4, linewidth=1)
        axes.set_xlabel(plain(options.get("xlabel", options.get("x", ""))))
        axes.set_ylabel(plain(options.get("ylabel", "" if ";" in options.get("y", ";") else options["y"])))
        if many > 1:
            axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1)) if many > 5 else axes.legend()
    else:
        labels = [column(header, name) for name in options.get("label", header[0]).split(";")]
        texts = [plain(", ".join(text)) for text in zip(*(filled(rows, k) for k in labels))]
        names = options["y"].split(";")
        limit = float(options.get("below", "inf"))
        keep = [k for k, row in enumerate(rows)
                if any((number(row[column(header, n)]) or 0) < limit and number(row[column(header, n)]) is not None for n in names)]
        figure, axes = plt.subplots(figsize=(7.5, float(options.get("height", max(2.2, 0.24 * len(keep) + 1)))))
        for m, name in enumerate(names):
            k = column(header, name)
            points = [(number(rows[r][k]), place) for place, r in enumerate(keep)]
            points = [p for p in points if p[0] is not None and p[0] < limit and ("x" not in scale or p[0] > 0)]
            if points:
                axes.plot(*zip(*points), "osv^D"[m % 5], label=plain(name), markersize=5, alpha=0.8)
        axes.set_yticks(range(len(keep)), [texts[r][:60] for r in keep])
        axes.set_ylim(len(keep) - 0.5, -0.5)
        axes.set_xlabel(plain(options.get("ylabel", "")))
        if len(names) > 1:
            axes.legend()
    if "x" in scale:
        axes.set_xscale("log")
    if "y" in scale:
        axes.set_yscale("log")
    figure.savefig(path, bbox_inches="tight", metadata={"Date": None})
    plt.close(figure)
