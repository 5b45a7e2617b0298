#!/usr/bin/python3
"""Draws pictures of particles as microscopes give them, and prints what tanktread-outline finds in them.

    looks_of_particles.py                                   # a table: looks at three sizes, errors in pixels
    looks_of_particles.py --figure outlines.png             # the figure of inputs/manual/studies.md

The drawings are ellipses, whose edges are known exactly."""
import pathlib
import sys

import numpy
import scipy.ndimage

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "postproc"))
from tanktread.figures import style
from tanktread.mistakes import Mistake, answer, command_line
from tanktread.studies import outline, picture

SIZES = (36, 30), (70, 60), (135, 115)  # semi-axes in pixels
FINER = 4  # samples per pixel and direction of a drawing


def grid(a, b, margin=30):
    """Returns columns and rows of the samples of a picture, relative to the middle of an ellipse with semi-axes a, b,
    and their distance from it, in pixels."""
    y, x = ((numpy.arange(FINER * 2 * int(half + margin)) + 0.5) / FINER - int(half + margin) for half in (b, a))
    x, y = numpy.meshgrid(x - 0.3, y + 0.4)  # not in the middle of a pixel
    ratio = numpy.hypot(x / a, y / b)
    return x, y, (ratio - 1) * ratio / numpy.maximum(numpy.hypot(x / a**2, y / b**2), 1e-9)


def photographed(drawing, blur=1.5, noise=0.01):
    """Returns the picture (rows, columns), 0 to 255, of a drawing with `FINER` samples per pixel."""
    rows, columns = drawing.shape
    image = drawing.reshape(rows // FINER, FINER, columns // FINER, FINER).mean((1, 3))
    image = scipy.ndimage.gaussian_filter(image, blur)
    image += noise * numpy.random.default_rng(1).standard_normal(image.shape)
    return numpy.clip(numpy.round(255 * image), 0, 255)


def ring(distance, outer, inner):
    return (distance < outer) & (distance >= inner)


def looks(a, b):
    """Returns {look: drawing} of an ellipse with semi-axes a, b. Its edge is the middle of a rim, or the boundary of the
    body."""
    x, y, far = grid(a, b)
    body, width = far < 0, 0.03 * a
    dark = 0.6 - 0.35 * body
    return {"filled, dark": dark, "filled, bright": 0.3 + 0.35 * body,
            "a narrow dark rim, bright inside": numpy.where(abs(far) < width, 0.25, 0.6 + 0.15 * body),
            "a thin ring": numpy.where(abs(far) < 1.5, 0.25, 0.6),
            "a bright halo around a dark body": numpy.where(ring(far, 0.1 * a, 0), 0.85, 0.6 - 0.3 * body),
            "a halo that decays": 0.6 - 0.3 * body + 0.25 * numpy.exp(-far.clip(0) / (0.06 * a)) * ~body,
            "a gradient of light": dark + 0.5 * x / numpy.ptp(x),
            "vignetting": dark * (1 - 0.3 * (x**2 + y**2) / (x**2 + y**2).max()),
            "channel walls": numpy.where(ring(abs(y), b + 20, b + 14), 0.2,
                                         numpy.where(abs(y) > b + 20, 0.8, dark)),
            "a bright spot inside": dark + 0.6 * (numpy.hypot(x - 0.3 * a, y) < 0.3 * b),
            "a second particle at the edge": numpy.where(numpy.hypot(x - a - 28, y - b - 28) < 20, 0.25, dark),
            "dust": numpy.where((abs(x - a - 10) < 2) & (abs(y) < 2) | (abs(x) < 2) & (abs(y + b + 12) < 3), 0.2,
                                dark)}


def found_in(image, a, b, given=None):
    """Returns the outline in a picture of an ellipse with semi-axes a, b, and the largest of the errors of its mean
    distance from the ellipse and of its two half widths, in pixels."""
    found = outline.outline(picture.without_background(image, "curved", "picture"), "picture", given=given)
    rows, columns = image.shape
    x, y = (found.points - [columns / 2 - 0.5 + 0.3, rows / 2 - 0.5 - 0.4]).T
    ratio = numpy.hypot(x / a, y / b)
    off = (ratio - 1) * ratio / numpy.hypot(x / a**2, y / b**2)
    return found, max(abs(off.mean()), abs(numpy.ptp(x) / 2 - a), abs(numpy.ptp(y) / 2 - b))


def draw(path):
    """Draws six looks with the outlines that are found."""
    names = ["a narrow dark rim, bright inside", "a bright halo around a dark body", "a thin ring", "channel walls",
             "a bright spot inside", "dust"]
    with style.plt.rc_context(style.STYLE):
        figure, axes = style.panels(None, 2, 3, 7.5, 4.9)
        for axis, name in zip(axes, names):
            image = photographed(looks(70, 60)[name])
            found, off = found_in(image, 70, 60)
            axis.imshow(image, cmap="gray", vmin=0, vmax=255)
            axis.plot(*found.points.T, ".", color=style.RUNS[1], ms=3)
            axis.set_title(f"{name}\n{found.text}\n{off:.2f} pixels off, stated {found.error:.2f}", fontsize=7.5)
            axis.axis("off")
        style.save(figure, path)


def main():
    parser = command_line(__doc__)
    parser.add_argument("--figure", metavar="FILE", help="writes the figure instead of the table")
    path = parser.parse_args().figure
    if path:
        return draw(path)
    print("| look | semi-axes | error | stated | % of the size | edge taken |\n|---|---|---|---|---|---|")
    for a, b in SIZES:
        for name, drawing in looks(a, b).items():
            try:
                found, off = found_in(photographed(drawing), a, b)
                print(f"| {name} | {a}, {b} | {off:.2f} | {found.error:.2f} | {50 * found.error / numpy.sqrt(a * b):.2f} "
                      f"| {found.text} |")
            except Mistake as mistake:
                print(f"| {name} | {a}, {b} | | | | {mistake} |")


if __name__ == "__main__":
    answer(main)
