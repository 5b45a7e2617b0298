"""Reads pictures, removes their background, and finds the region inside the outermost closed edge."""

import dataclasses

import numpy
import scipy.ndimage

from ..mistakes import Mistake, expect, optional

COARSE = 600     # a picture is searched at this number of pixels along its longer side, or fewer
SMOOTHING = 2    # standard deviation, in pixels of the search, of the filter before the gradient is taken
LEAST = 200      # area, in pixels of the search, of the smallest particle
WEAKEST = 0.25   # an edge encloses a particle if its gradient is at least this fraction of the strongest closed edge
BACKGROUNDS = {"even": 0, "plane": 1, "curved": 2}  # degrees of the polynomials in row and column


def grey(path):
    """Returns the brightness of a picture (PNG, TIFF, JPEG and others), shape (rows, columns), with the uppermost row
    first. Its unit is that of the file. Colours are averaged, and transparent pixels are shown on white."""
    image = optional("PIL.Image", "reading a picture", "pil")
    try:
        with image.open(path) as picture:
            if picture.mode in ("P", "PA", "LA", "La", "RGBa", "RGBA", "CMYK", "YCbCr", "HSV", "LAB", "1"):
                picture = picture.convert("RGBA")
            values = numpy.atleast_3d(numpy.asarray(picture).astype(float))
    except FileNotFoundError:
        raise Mistake(f"{path}: there is no such file") from None
    except Exception as error:  # PIL raises exceptions of many types
        raise Mistake(f"{path} is no picture that can be read ({error}): save it as PNG, TIFF or JPEG with 8 bits per "
                      "colour, or in grey with 8 or 16 bits") from None
    expect(numpy.isfinite(values).all(), f"{path}: some pixels are no numbers: save it with 8 or 16 bits per pixel")
    if values.shape[2] == 4:
        values = 255 + (values[..., :3] - 255) * values[..., 3:] / 255
    return values.mean(2)


def part(picture, region, path):
    """Returns the part of a picture in the rectangle `region`: column and row of its upper left corner, and of its
    lower right corner, in pixels."""
    if region is None:
        return picture
    left, upper, right, lower = region
    rows, columns = picture.shape
    expect(0 <= left < right <= columns and 0 <= upper < lower <= rows,
           f"{path}: --region does not lie in the picture, which has {columns} columns and {rows} rows: "
           f"LEFT UPPER RIGHT LOWER from 0 0 to {columns} {rows}")
    return picture[upper:lower, left:right]


def surface(picture, degree):
    """Returns the brightness (rows, columns) of the surroundings: the polynomial of the given degree in row and column
    that fits the outer eighth of the picture on each side. Pixels that deviate from it, such as channel walls, have
    little weight (Cauchy's weights, scaled by the median deviation)."""
    row, column = (numpy.linspace(-1, 1, count) for count in picture.shape)
    row, column = numpy.meshgrid(row, column, indexing="ij")
    terms = numpy.stack([row**i * column**j for i in range(degree + 1) for j in range(degree + 1 - i)], axis=-1)
    rim = numpy.maximum(abs(row), abs(column)) > 0.75
    basis, values, weights = terms[rim], picture[rim], numpy.ones(rim.sum())
    for _ in range(10):
        factors = numpy.linalg.lstsq(basis * weights[:, None], values * weights, rcond=None)[0]
        rest = abs(values - basis @ factors)
        weights = 1 / numpy.sqrt(1 + (rest / max(2 * numpy.median(rest), 1e-12)) ** 2)
    return terms @ factors


def without_background(picture, given, path, region=None):
    """Returns a picture minus its background. `given`: a name of BACKGROUNDS or the path of a picture without the
    particle, of which the same region is taken."""
    if given in BACKGROUNDS:
        return picture - surface(picture, BACKGROUNDS[given])
    empty = part(grey(given), region, given)
    expect(empty.shape == picture.shape, f"{given} has {empty.shape[1]} columns and {empty.shape[0]} rows, and {path} "
           f"has {picture.shape[1]} and {picture.shape[0]}: --background needs a picture of the same size")
    return picture - empty


def noise_of(picture):
    """Returns the standard deviation of the noise of a pixel, from the mixed fourth difference, to which smooth changes
    and straight edges contribute little (Immerkaer 1996). 6 is its factor for white noise, and 0.6745 the median of the
    absolute value of normal deviates."""
    return numpy.median(abs(scipy.ndimage.convolve(picture, [[1, -2, 1], [-2, 4, -2], [1, -2, 1]]))) / 0.6745 / 6


@dataclasses.dataclass
class Region:
    """The inside of a closed edge. `inside`: mask (rows, columns) of the search, whose pixels are `step` pixels of the
    picture. `gradient`: of the smoothed picture (rows, columns). `others`: the number of further closed edges of
    comparable size that lie outside of it. `weaker`: width and height in pixels of a weaker closed edge around it."""
    inside: numpy.ndarray
    step: int
    gradient: numpy.ndarray
    others: int
    weaker: tuple | None

    def middle(self):
        """Returns the row and column of the centroid, in pixels of the picture."""
        return numpy.array(scipy.ndimage.center_of_mass(self.inside)) * self.step


def enclosed(edges):
    """Returns masks of the regions that `edges` (a mask) separates from the frame of the picture, with holes filled.
    The largest region is the first. Regions inside of another one are left out."""
    labels, count = scipy.ndimage.label(scipy.ndimage.binary_fill_holes(edges) & ~edges)
    found = []
    boxes = scipy.ndimage.find_objects(labels)
    sizes = [(box[0].stop - box[0].start) * (box[1].stop - box[1].start) for box in boxes]
    taken = numpy.zeros_like(edges)
    for number in numpy.argsort(sizes)[::-1]:
        box = boxes[number]
        if sizes[number] < LEAST / 2:
            break
        full = scipy.ndimage.binary_fill_holes(labels[box] == number + 1)
        if full.sum() >= LEAST / 2 and not taken[box][full].any():
            mask = numpy.zeros_like(edges)
            mask[box] = full
            taken |= mask
            found.append(mask)
    return sorted(found, key=lambda mask: -mask.sum())


def extent(mask, step):
    """Returns width and height of a mask in pixels of the picture."""
    return tuple(step * (one.stop - one.start) for one in scipy.ndimage.find_objects(mask.astype(int))[0][::-1])


def outermost(picture):
    """Returns the Region inside the outermost closed edge, or None if no edge closes.

    An edge is a line on which the gradient of the smoothed picture is larger than a threshold. The threshold decreases
    from the largest gradient to that of the noise. A line that ends at the frame of the picture, such as a channel
    wall, encloses nothing. The smoothing increases if no edge closes, because it reduces the noise."""
    step = -(-max(picture.shape) // COARSE)
    noise = noise_of(picture)
    for smoothing in (step * SMOOTHING * factor for factor in (1, 2, 4)):
        gradient = scipy.ndimage.gaussian_gradient_magnitude(picture, smoothing, mode="nearest")
        coarse = gradient[::step, ::step]
        # white noise has gradients of noise / (sqrt(8 pi) smoothing^2), of which none in a picture exceeds five times
        # the value; slowly varying light has its median gradient everywhere
        lowest = max(5 * noise / (numpy.sqrt(8 * numpy.pi) * smoothing**2), 3 * numpy.median(coarse), 1e-9)
        if coarse.max() <= lowest:
            continue
        levels = numpy.geomspace(0.98 * coarse.max(), lowest, max(2, int(6 * numpy.log2(coarse.max() / lowest))))
        found = [(level, enclosed(coarse > level)) for level in levels]
        found = [(level, regions) for level, regions in found if regions]
        if not found:
            continue
        largest = max(regions[0].sum() for _, regions in found)
        strongest = next(level for level, regions in found if regions[0].sum() > largest / 4)
        closed = [(level, regions) for level, regions in found if level >= WEAKEST * strongest]
        # the highest threshold with nearly the largest region, because noise deforms edges at low thresholds
        area = max(regions[0].sum() for _, regions in closed)
        level, regions = next(one for one in closed if one[1][0].sum() > 0.8 * area)
        inside = regions[0]
        if inside.sum() < LEAST:
            continue
        wider = [regions[0] for _, regions in found if regions[0].sum() > 1.5 * area and regions[0][inside].all()]
        others = sum(one.sum() > area / 4 for one in regions[1:])
        return Region(inside, step, gradient, others, extent(wider[0], step) if wider else None)
    return None
