"""How the pictures look, in one place. Importing it selects a backend that needs no display."""

import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

INK = "#22272e"      # text and axes
FAINT = "#8a929c"    # literature, guides
GRID = "#e4e7eb"
RUNS = ["#0b6fb8", "#d1622b", "#2d8a57", "#8452a1", "#b8860b"]  # one a run, told apart by colour-blind readers too
MARKS = ["o", "s", "^", "D", "v", "P"]                          # one a literature source
FIELD = "viridis"                                               # colour map of a field without sign
SIGNED = "RdBu_r"                                               # and of one with a sign
TIME = "copper_r"                                               # of moments, which no field has

plt.rcParams.update({
    "figure.dpi": 150,
    "figure.constrained_layout.use": True,
    "font.size": 9.5,
    "text.color": INK,
    "axes.labelcolor": INK,
    "axes.edgecolor": FAINT,
    "axes.linewidth": 0.7,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.titlesize": 10,
    "axes.titlelocation": "left",
    "grid.color": GRID,
    "grid.linewidth": 0.7,
    "xtick.color": INK,
    "ytick.color": INK,
    "xtick.major.width": 0.7,
    "ytick.major.width": 0.7,
    "legend.frameon": False,
    "legend.fontsize": 8.5,
    "lines.linewidth": 1.6,
})


def save(figure, path):
    """Writes a figure, into a folder that is made if it is not there, or ends the program with one sentence."""
    path, kinds = pathlib.Path(path), figure.canvas.get_supported_filetypes()
    path = path if path.suffix or not path.name else path.with_name(path.name + ".png")
    if path.suffix[1:].lower() not in kinds:
        sys.exit(f"a picture has a name that ends in .{', .'.join(sorted(kinds))}, but was to be named {path}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        figure.savefig(path, bbox_inches="tight", pad_inches=0.08)
    except OSError as error:
        sys.exit(f"{path} cannot be written: {error.strerror}")
    plt.close(figure)
    print(path)
