"""The look of the figures, and the axes that they are drawn in."""

import itertools
import pathlib

import matplotlib.pyplot as plt
import numpy
from matplotlib.axis import Axis
from matplotlib.figure import FigureBase
from matplotlib.transforms import Bbox

from ..mistakes import Mistake, expect

INK = "#22272e"      # text and axes
FAINT = "#8a929c"    # literature, guides
GRID = "#e4e7eb"
RUNS = ["#0b6fb8", "#d1622b", "#2d8a57", "#8452a1", "#b8860b"]  # one per run, distinct to colour-blind readers too
MARKS = ["o", "s", "^", "D", "v", "P"]                          # one per source in the literature
FIELD = "viridis"                                               # colour map of a field without negative values
SIGNED = "RdBu_r"                                               # colour map of a field with negative values
TIME = "copper_r"                                               # colour map of times
DASHES = (0, (4, 2))
AXES = ("x₁", "x₂", "x₃")
GUIDE = {"color": FAINT, "linestyle": (0, (4, 3))}              # guide line, for example a convergence order

STYLE = {
    "figure.dpi": 150, "figure.constrained_layout.use": True, "font.size": 9.5, "text.color": INK,
    "axes.labelcolor": INK, "axes.edgecolor": FAINT, "axes.linewidth": 0.7, "axes.titlesize": 10,
    "axes.titlelocation": "left", "axes.spines.top": False, "axes.spines.right": False, "axes.axisbelow": True,
    "axes.grid": True, "grid.color": GRID, "grid.linewidth": 0.7, "legend.frameon": False, "legend.fontsize": 8.5,
    "xtick.color": INK, "ytick.color": INK, "xtick.major.width": 0.7, "ytick.major.width": 0.7, "lines.linewidth": 1.6}


def canvas(axes, width, height):
    """Returns the figure for panels of different sizes: a new one of this size (inches), or the given (Sub)Figure."""
    if axes is None:
        return plt.figure(figsize=(width, height))
    if isinstance(axes, FigureBase):
        return axes
    raise Mistake("this figure arranges panels of different sizes: give it a Figure or SubFigure instead of axes")


def panels(axes, rows, columns, width, height, mosaic=None, **layout):
    """Returns a figure and its axes (rows * columns,). If `axes` is None, both are new. If `axes` is a (Sub)Figure, it
    receives new axes. Otherwise the given axes are used. `mosaic` arranges new axes as `Figure.subplot_mosaic` does."""
    if axes is None or isinstance(axes, FigureBase):
        figure = canvas(axes, width, height)
        if mosaic:
            return figure, list(figure.subplot_mosaic(mosaic, **layout).values())
        return figure, figure.subplots(rows, columns, squeeze=False, **layout).ravel()
    axes = numpy.atleast_1d(axes).ravel()
    expect(len(axes) == rows * columns, f"this figure needs {rows * columns} axes, and is given {len(axes)}")
    return axes[0].figure, axes


def draw(function, *arguments):
    """Returns function(*arguments), a figure, drawn in the style of this package."""
    with plt.rc_context(STYLE):
        return function(*arguments)


def coloured(runs):
    """Returns pairs of a run, or of another item, and its colour."""
    return zip(runs, itertools.cycle(RUNS))


def shaded(items, first=0.12, last=1.0):
    """Returns a list of pairs of an item and its colour; the items are ordered in time."""
    return list(zip(items, plt.get_cmap(TIME)(numpy.linspace(first, last, len(items)))))


def dotted(figure):
    """Returns the figure. Lines of one point, which would be invisible, are replaced by dots."""
    lone = [line for axis in figure.axes for line in axis.lines if len(line.get_xdata()) == 1]
    plt.setp([line for line in lone if line.get_marker() == "None"], marker="o", clip_on=False)
    return figure


def finish(axes, **properties):
    """Sets properties of axes, such as xlabel, and draws their legend."""
    axes.set(**properties)
    axes.legend()


def tight_box(figure):
    """Lays out a figure for the last time. Returns the box, in inches, that contains everything in it. The tight box of
    matplotlib ignores the part of an axis label that is longer than its axes."""
    for _ in range(2):  # the constrained layout needs two passes: the first one can leave overlaps
        figure.draw_without_rendering()
    figure.set_layout_engine("none")
    labels = [axis.label for axis in figure.findobj(Axis) if axis.get_visible() and axis.label.get_visible()]
    boxes = [label.get_window_extent() for label in labels if label.get_text()]
    in_inches = figure.dpi_scale_trans.inverted()
    return Bbox.union([figure.get_tightbbox(), *(box.transformed(in_inches) for box in boxes)])


def save(figure, path):
    """Writes a figure as PNG, PDF, SVG and so on by its name, or its animation as GIF. Makes the folder."""
    path = pathlib.Path(path)
    film = getattr(figure, "film", None)
    path = path if path.suffix or not path.name else path.with_name(path.name + (".gif" if film else ".png"))
    kinds = ["gif"] if film else sorted(figure.canvas.get_supported_filetypes())
    expect(path.suffix[1:].lower() in kinds, f"the name of a figure ends in .{', .'.join(kinds)}, but it is {path}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        if film:
            film.save(path, writer="pillow", dpi=figure.dpi)
        else:
            with plt.rc_context(STYLE):
                figure.savefig(path, bbox_inches=tight_box(figure).padded(0.08))
    except OSError as error:
        raise Mistake(f"{path} cannot be written: {error.strerror}") from None
    except ValueError as error:
        raise Mistake(f"the figure cannot be drawn: {error}") from None
    plt.close(figure)
    print(path)
