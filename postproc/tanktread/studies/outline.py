"""Finds the outline of a particle in a picture (PNG) with subpixel accuracy, and the standard error of its points.

    tanktread-outline picture.png -o profile.csv --overlay check.png

The result is a table of points for tanktread-fit, in pixels. The origin is the upper left corner of the picture. x1
points to the right and x3 up, so that x3 is negative; the fit is not affected.

The particle must be darker or brighter than its surroundings, and lie completely within the picture. If there are
several particles, the largest one is taken. The edge is found on rays from the centre of the particle:

1. The brightness profile is averaged over all rays. The average edge is the position of the sharp step that encloses
   the same integral of brightness, because blur does not change this integral.
2. The profile of each ray is fitted by the average profile, shifted along the ray, by least squares.
3. Each point of the outline is averaged from the neighbouring rays. No ray is used twice, so that the errors of the
   points are independent.
4. Blur of variance s moves a curved edge towards its centre of curvature by s/2 times the curvature. This shift is
   corrected.
"""

import numpy
import scipy.ndimage
from matplotlib.image import imread

from ..figures import style
from ..interpolation import mean
from ..mistakes import Mistake, command_line, expect, log

WINDOW = 8   # half the length, in pixels, of the part of a ray around the edge whose brightness is used
FINE = 0.25  # distance between samples of a ray, in pixels


def grey(path):
    """Returns the brightness of a picture, 0 to 1, shape (rows, columns), with the uppermost row first. Transparent
    pixels are shown on white."""
    try:
        picture = imread(path)
        picture = numpy.atleast_3d(picture.astype(float) / (255 if picture.dtype.kind == "u" else 1))
    except Exception as error:  # imread raises exceptions of many types
        raise Mistake(f"{path} is no picture that can be read: {error}") from None
    return (1 + (picture[..., :3] - 1) * picture[..., 3:].prod(2, keepdims=True)).mean(2)


def frame(picture):
    """Returns the values of the pixels on the four sides of a picture."""
    return numpy.concatenate([picture[0], picture[-1], picture[:, 0], picture[:, -1]])


def body(picture, path):
    """Returns a mask (rows, columns) of the particle: the largest connected region that Otsu's threshold separates from
    most pixels of the frame, with holes filled."""
    smooth = scipy.ndimage.gaussian_filter(picture, 2)
    numbers, edges = numpy.histogram(smooth, 256)
    middles = (edges[1:] + edges[:-1]) / 2
    below, sums = numpy.cumsum(numbers), numpy.cumsum(numbers * middles)
    with numpy.errstate(divide="ignore", invalid="ignore"):
        between = below * (below[-1] - below) * (sums / below - (sums[-1] - sums) / (below[-1] - below)) ** 2
    level = middles[numpy.nanargmax(between)]
    labels, count = scipy.ndimage.label((smooth > level) != (numpy.median(frame(smooth)) > level))
    expect(count, f"{path}: nothing is set off from its surroundings")
    mask = scipy.ndimage.binary_fill_holes(labels == 1 + numpy.argmax(numpy.bincount(labels.ravel())[1:]))
    expect(mask.sum() > 200, f"{path}: what is set off is {int(mask.sum())} pixels large, too small for an outline")
    expect(not frame(mask).any(), f"{path}: the outline does not close within the picture")
    return mask


def edge(picture, mask, points):
    """Returns points (n, 2) of the edge as (column, row), and the standard error of a point, in pixels. Each point is
    the middle value of a parabola fitted to an odd number of neighbouring rays, about two pixels apart."""
    row, column = scipy.ndimage.center_of_mass(mask)
    each = max(2, int(numpy.sqrt(mask.sum() * numpy.pi) / points)) // 2 * 2 + 1
    angle = 2 * numpy.pi * numpy.arange(points * each) / (points * each)
    ray, middle = numpy.array([numpy.sin(angle), numpy.cos(angle)])[:, :, None], numpy.reshape([row, column], (2, 1, 1))
    radius = numpy.arange(0, numpy.hypot(*mask.shape), FINE)
    inside = scipy.ndimage.map_coordinates(mask.astype(float), middle + ray * radius, order=1) > 0.5
    found = radius[inside.shape[1] - 1 - inside[:, ::-1].argmax(1)]
    reach = min(WINDOW, 0.5 * found.min())
    off = numpy.linspace(-reach, reach, 1 + 2 * int(WINDOW / FINE))

    def profiles():
        """Returns the brightness along the window of each ray, scaled to 1 inside and 0 outside the particle."""
        values = scipy.ndimage.map_coordinates(picture, middle + ray * (found[:, None] + off), order=3, mode="nearest")
        ends = numpy.stack([values[:, :len(off) // 5].mean(1), values[:, -len(off) // 5:].mean(1)])
        ends = scipy.ndimage.gaussian_filter1d(ends, len(angle) / 40, axis=1, mode="wrap")[:, :, None]
        return (values - ends[1]) / (ends[0] - ends[1])

    # Blur conserves the area of a disc, so the radius of the edge is the radius of the disc with the same sum of
    # brightness. Rings are therefore weighted by their radius.
    for _ in range(3):
        rings = (profiles() * (found[:, None] + off)).mean(1)
        found = numpy.sqrt((found - reach) ** 2 + 4 * reach * rings)
    for _ in range(3):
        values = profiles()
        slope = numpy.gradient(values.mean(0), off)
        found = found - (values - values.mean(0)) @ slope / (slope @ slope)
    variance = -mean(off, off**2 * slope) * (off[-1] - off[0])
    # The loop over rings has removed the shift by blur as for a circle. It is restored here, because unbent() removes
    # the shift for the actual curvature.
    found -= (variance / (2 * found)).mean()
    radius, error = averaged(found, each)
    places = numpy.column_stack([column + radius * numpy.cos(angle[::each]), row + radius * numpy.sin(angle[::each])])
    return unbent(places, variance), error


def unbent(points, variance):
    """Returns the points (n, 2) of an outline, corrected for the shift by blur of the given variance. The points are in
    the order of their angle."""
    before, after = points - numpy.roll(points, 1, axis=0), numpy.roll(points, -1, axis=0) - points
    chord, lengths = before + after, [numpy.linalg.norm(one, axis=1) for one in (before, after, before + after)]
    # curvature of the circle through three neighbouring points
    curvature = 2 * (before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]) / numpy.prod(lengths, axis=0)
    outwards = chord[:, ::-1] * [1, -1] / lengths[2][:, None]
    return points + (variance / 2 * curvature)[:, None] * outwards


def averaged(radius, each):
    """Returns for each point the middle value of the parabola (for three rays, the line) fitted to its `each` rays, and
    the standard error of these values. `radius`: radius of the edge on each ray."""
    rays = numpy.roll(radius, each // 2).reshape(-1, each)
    basis = numpy.vander(numpy.linspace(-1, 1, each), 3 if each > 4 else 2, increasing=True)
    weights = numpy.linalg.pinv(basis)
    rest = rays - rays @ weights.T @ basis.T
    error = numpy.sqrt((rest**2).sum() / (len(rays) * (each - basis.shape[1]))) * numpy.linalg.norm(weights[0])
    return rays @ weights[0], float(error)


def main():
    parser = command_line(__doc__)
    parser.add_argument("picture", help="PNG file")
    parser.add_argument("-o", "--output", default="outline.csv", metavar="FILE",
                        help="table of the points (default: %(default)s)")
    parser.add_argument("--points", type=int, help="number of points (default: 60, fewer for a small particle)")
    parser.add_argument("--overlay", metavar="FILE", help="writes the picture with the points drawn on it, as a check")
    arguments = parser.parse_args()
    picture = grey(arguments.picture)
    expect(numpy.ptp(picture) > 0, f"{arguments.picture}: its brightness is the same everywhere")
    mask = body(picture, arguments.picture)
    # each point takes three rays, about two pixels apart, because their scatter gives the standard error
    most = int(numpy.sqrt(mask.sum() * numpy.pi) / 2)
    number = min(60, most) if arguments.points is None else arguments.points
    expect(8 <= number <= most, f"{arguments.picture}: --points must be from 8 to {most}, half the rays of its outline")
    points, error = edge(picture, mask, number)
    expect(numpy.isfinite(points).all(), f"{arguments.picture}: no edge was found on some rays")
    table = numpy.column_stack([points * [1, -1], numpy.full(len(points), error)])
    numpy.savetxt(arguments.output, table, "%.4f,%.4f,%.3g", header="x1,x3,error", comments="")
    log.info(f"{arguments.output}: {len(points)} points, each with an error of {error:.3f} pixels")
    if arguments.overlay:
        figure, (axis,) = style.panels(None, 1, 1, 6, 6 * picture.shape[0] / picture.shape[1])
        axis.imshow(picture, cmap="gray")
        axis.plot(*points.T, ".", color=style.RUNS[1], ms=2)
        axis.axis("off")
        style.save(figure, arguments.overlay)
