"""Makes the surface of a particle (.iga) from a triangulated surface, points, or spherical harmonics.

    tanktread-surface cell.stl -o cell.iga --unit um

The surface is read by `Particle/shape: file` of a deck. The data are one of

    mesh.stl         triangles or quadrilaterals in a format that meshio reads (stl, off, obj, ply, vtk, msh …). The
                     surface must be closed, without handles, and not cross itself; it may be of any shape otherwise
    points.csv       rows x1,x2,x3: points on the surface in any order, through which spherical harmonics are fitted.
                     Each ray from their centre must meet the surface once
    harmonics.csv    rows l,m,coefficient: the radius is the sum of coefficient x Y_lm(direction), where Y_lm are the
                     real orthonormal spherical harmonics (m < 0: sine, m > 0: cosine; no Condon-Shortley phase), with
                     the pole along x3

1. Doubled vertices are merged, and triangles that are turned inwards are turned over. Other faults are refused.
2. The triangles are mapped to the unit sphere without folds.
3. Splines are fitted to the surface of the triangles by least squares. Their volume and area are those of the mesh.
"""

import pathlib

import numpy
from matplotlib.collections import LineCollection

from ..figures import style
from ..mistakes import Mistake, command_line, expect, log
from ..units import factor
from . import harmonics, sphere_map, splines, triangles
from .fit import Fit

ELEMENTS = 8, 12, 16, 20, 24  # tried in this order
# Limits of a good fit. Lengths are relative to the radius of the sphere with the volume.
RMS, LARGEST, CHANGE, JACOBIAN, WITHIN = 0.01, 0.1, 1e-3, 0.05, 0.1
TABLES = ".csv", ".txt", ".dat", ".tsv", ".xyz"


def faults(report, count):
    """Returns what is wrong with a fit to `count` triangles, as a list of texts."""
    change = CHANGE * max(1, 1000 / count)  # facets have more area than a smooth surface, by a multiple of their number
    return [text for wrong, text in (
        (report.rms > RMS * report.size + report.depth,
         f"the root mean square distance is {report.rms / report.size:.3f} radii"),
        (report.largest > LARGEST * report.size, f"the largest distance is {report.largest / report.size:.2f} radii"),
        (abs(report.volume_error) > change, f"the volume differs by {report.volume_error:.1e}"),
        (abs(report.area_error) > change, f"the area differs by {report.area_error:.1e}"),
        (report.within < WITHIN, "the surface turns by about 90 degrees within an element"),
        (report.jacobian < JACOBIAN, f"the smallest Jacobian is {report.jacobian:.3f} of its mean")) if wrong]


def fitted(points, faces, elements, path):
    """Returns a good Fit and its Report. `elements`: per side, None for the fewest of ELEMENTS that are enough."""
    places = sphere_map.on_sphere(points, faces, path)
    for count in [elements] if elements else ELEMENTS:
        fit = Fit(splines.sphere(count), points, faces, places)
        report = fit.report()
        wrong = faults(report, len(faces))
        if not wrong:
            return fit, report
    remedy = (f"raise --elements (now {count})" if count < ELEMENTS[-1] else "smooth the mesh, or export a finer one")
    raise Mistake(f"{path}: {' and '.join(wrong)}, so that the splines do not represent the surface: {remedy}")


def section(points, faces, axes, k):
    """Returns the lines (n, 2, 3), in the coordinates along `axes` (3, 3), in which the plane through the origin with
    the normal axes[k] cuts triangles."""
    corners = (points @ axes.T)[faces]
    corners[..., k] += 1e-9 * numpy.ptp(corners)  # no vertex is in the plane
    height = corners[..., k, None]
    after = numpy.roll(corners, -1, axis=1)
    cut = (height > 0) != (after[..., k, None] > 0)
    with numpy.errstate(divide="ignore", invalid="ignore"):
        ends = corners + height / (height - after[..., k, None]) * (after - corners)
    crossed = cut.sum(1)[:, 0] == 2
    return ends[crossed][cut[crossed][..., 0]].reshape(-1, 2, 3)


def drawn(fit):
    """Returns a figure of the sections of mesh and splines by the three planes of the principal axes."""
    middle = fit.points.mean(0)
    axes = numpy.linalg.svd(fit.points - middle, full_matrices=False)[2]
    along = numpy.linspace(0, 1, 13)
    smooth = fit.surface.table(along) @ fit.nodes - middle
    figure, panels = style.panels(None, 1, 3, 9, 3.4)
    for axis, (i, j) in zip(panels, ((0, 1), (0, 2), (1, 2))):
        for points, faces, look in (
                (fit.points - middle, fit.triangles, {"colors": style.FAINT, "linewidths": 3, "label": "mesh"}),
                (smooth, fit.cells(len(along)), {"colors": style.RUNS[0], "linewidths": 1, "label": "splines"})):
            axis.add_collection(LineCollection(section(points, faces, axes, 3 - i - j)[..., [i, j]], **look))
        axis.autoscale()
        axis.set(aspect="equal", xlabel=f"principal axis {i + 1}", ylabel=f"principal axis {j + 1}")
    panels[0].legend(loc="center")
    return figure


def main():
    parser = command_line(__doc__)
    parser.add_argument("shape", type=pathlib.Path, help="mesh, points or harmonics, see above")
    parser.add_argument("-o", "--output", type=pathlib.Path, metavar="FILE",
                        help="file of the surface (default: the name of the data with .iga)")
    parser.add_argument("--elements", type=int, metavar="N", help="elements per side of the cube mesh, 6 N^2 + 2 "
                        "control points (default: the fewest of 8, 12, 16, 20 and 24 with a good fit)")
    parser.add_argument("--unit", help="unit of the numbers in the data, for example um; the deck then states it")
    parser.add_argument("--degree", type=int, default=8, help="largest degree of the harmonics that are fitted to "
                        "points (default: %(default)s)")
    parser.add_argument("--figure", type=pathlib.Path, metavar="FILE",
                        help="picture of mesh and splines (default: the name of the output with .png)")
    words = parser.parse_args()
    expect(words.elements is None or 3 <= words.elements <= 64, "--elements must be from 3 to 64")
    expect(words.unit is None or factor(words.unit, "m"), f"--unit {words.unit} is no unit of length; write um or nm")
    output = words.output or words.shape.with_suffix(".iga")
    expect(output.suffix == ".iga", f"the name of the output ends in .iga, but it is {output}")
    if words.shape.suffix.lower() in TABLES:
        points, faces = harmonics.triangulated(words.shape, words.degree)
    else:
        points, faces = triangles.checked(words.shape)
    fit, report = fitted(points, faces, words.elements, words.shape)
    output.parent.mkdir(parents=True, exist_ok=True)
    output.write_text(fit.surface.text(fit.nodes))
    unit = f" {words.unit}" if words.unit else ""
    log.info(f"mesh: {len(faces)} triangles, volume {report.volume / (1 + report.volume_error):.6g}, "
             f"area {report.area / (1 + report.area_error):.6g}")
    log.info(f"splines: {len(fit.nodes)} control points, volume {report.volume:.6g}, area {report.area:.6g}")
    log.info(f"distance: root mean square {report.rms:.1e}{unit}, largest {report.largest:.1e}{unit}")
    log.info(f"smallest Jacobian divided by its mean: {report.jacobian:.2f}")
    style.save(style.draw(drawn, fit), words.figure or output.with_suffix(".png"))
    if words.unit:
        log.info(f"Units: {{length: 1 {words.unit}}}")
    log.info(f"Particle: {{shape: file, file: {output}}}")
