"""A surface as the eye sees it, orthographic, by a depth buffer: what is hidden stays hidden, element edges too, and
colours can be read off the bar."""

import itertools

import numpy

STEP = 0.7        # pixels between samples of a surface: below 1/√2, so that no pixel of it is left out
COARSE = 6        # facets along a side of a cell to measure it by
RIM = 0.14        # what of a colour is lost where the surface turns away from the eye; none where it faces it
EDGE_WIDTH = 1.2  # of an element edge on the surface, pixels
EDGE_INK = 0.75   # how white it is
INSIDE = 0.45     # how dark the inner side is where a cell's face cuts a particle open
CONTOUR = 8       # pixels of depth between neighbours from which on a contour is drawn
OVERSAMPLING = 2  # finer pixels along a pixel


def picture(shot, values, view, colour_of, pixels=640):
    """Returns an image (rows, columns, RGBA) of a surface, its uppermost row first, and the extent of the image (left,
    right, low, high) in the surface's length.

    `values` (n,) at the nodes of `shot` colour it; `view` (3, 3): right, up and towards the eye. Of a lattice it shows
    what is in the cell at the origin: particles with their images, cut at its faces. `pixels`: of the longer side.
    `colour_of`: maps values to RGBA."""
    depth, found, corner, size = seen(shot, values, view, OVERSAMPLING * pixels)
    columns, rows = numpy.array(depth.shape) // OVERSAMPLING
    image = _coloured(depth, found, colour_of).reshape(columns, OVERSAMPLING, rows, OVERSAMPLING, 4).mean((1, 3))
    image[..., :3] /= numpy.maximum(image[..., 3:], 1e-12)
    end = corner + numpy.array(depth.shape) / size
    return numpy.clip(image.transpose(1, 0, 2)[::-1], 0, 1), (corner[0], end[0], corner[1], end[1])


def seen(shot, values, view, pixels):
    """Returns of the sample nearest to the eye in every pixel (right, up) the depth towards the eye in pixels, -inf
    outside the surface, and rows of value, cosine to the eye and distance from an element edge; the lower left corner;
    pixels per length."""
    places, frame = shot.positions @ view.T, shot.frame @ view.T
    low, high = frame[:, :2].min(0), frame[:, :2].max(0)
    size = pixels / (high - low).max()
    shape = OVERSAMPLING * (numpy.ceil((high - low) * size / OVERSAMPLING).astype(int) + 4)
    corner = low - 2 * OVERSAMPLING / size
    depth = numpy.full(shape.prod(), -numpy.inf, numpy.float32)
    found = numpy.zeros((shape.prod(), 3), numpy.float32)
    shifts, lattice = [numpy.zeros(3)], None
    if shot.cell is not None:
        vectors = shot.cell @ view.T * size
        shifts = [steps @ vectors for steps in itertools.product((-1, 0, 1), repeat=3)]
        lattice = numpy.linalg.inv(vectors)
    for shift in shifts:
        for sample in _samples(shot, places * size + shift, values, lattice):
            column, row = numpy.clip((sample[:, :2] - corner * size).astype(int), 0, shape - 1).T
            place = column * shape[1] + row
            order = numpy.argsort(sample[:, 2], kind="stable")  # the nearest one last, which stays
            order = order[sample[order, 2] > depth[place[order]]]
            depth[place[order]] = sample[order, 2]
            found[place[order]] = sample[order, 3:]
    return depth.reshape(shape), found.reshape(*shape, 3), corner, size


def _samples(shot, places, values, lattice=None):
    """Yields samples no further than STEP pixels apart, of some cells at a time: rows of position (3), value, cosine to
    the eye, distance from the cell's edge. With `lattice`, which maps positions to coordinates along its vectors, only
    samples in the cell at the origin, and those of inner sides too, whose value is NaN."""
    known = numpy.column_stack([places, values]).astype(numpy.float32)  # to a ten thousandth of a pixel
    grid = shot.sampled(places, COARSE)
    visible = _normals(grid)[0] > -0.2 if lattice is None else (numpy.abs(grid @ lattice) < 0.5).all(-1)
    seen = numpy.flatnonzero(visible.any((1, 2)))
    if len(seen) == 0:
        return
    # by the longest facet of each cell as seen, because a cell is not sampled evenly by its parameters
    facets = [numpy.linalg.norm(numpy.diff(grid[seen, :, :, :2], axis=axis), axis=-1).max((1, 2)) for axis in (1, 2)]
    k = 8 * numpy.ceil(numpy.maximum(*facets) * 1.05 * COARSE / STEP / 8).astype(int)
    for n in numpy.unique(k):
        for which in numpy.array_split(seen[k == n], max(1, (k == n).sum() * n * n // 500000)):
            sample = shot.sampled(known, n, which)
            facing, area, length_t, length_s = _normals(sample[..., :3])
            along = numpy.arange(n + 1, dtype=numpy.float32) / n
            inside = n * numpy.minimum(along, 1 - along)
            edge = area * numpy.minimum(inside / length_t, inside[:, None] / length_s)
            if lattice is None:
                keep = facing > -0.05
            else:
                keep = (numpy.abs(sample[..., :3] @ lattice.astype(numpy.float32)) < 0.5).all(-1)
                sample[facing < 0, 3] = numpy.nan
            yield numpy.column_stack([sample[keep], facing[keep], edge[keep]])


def _normals(grid):
    """Returns at points of grids the cosine of normal and eye, the area of a facet, its lengths along t and along s."""
    t, s = numpy.gradient(grid, axis=(1, 2))
    normal = numpy.cross(s, t)
    area, length_t, length_s = (numpy.maximum(numpy.linalg.norm(x, axis=-1), 1e-12) for x in (normal, t, s))
    return normal[..., 2] / area, area, length_t, length_s


def _coloured(depth, found, colour_of):
    """Returns colours (columns, rows, 4), multiplied by their opacity: a darker rim, element edges and contours;
    transparent outside the surface."""
    value, facing, edge = numpy.moveaxis(found, -1, 0)
    hit = numpy.isfinite(depth)
    image = numpy.zeros((*depth.shape, 4))
    image[hit] = numpy.where(numpy.isnan(value[hit])[:, None], (INSIDE, INSIDE, INSIDE, 1), colour_of(value[hit]))
    image[..., :3] *= (1 - RIM * (1 - numpy.clip(facing, 0, 1)) ** 2)[..., None]
    share = EDGE_INK * numpy.clip(EDGE_WIDTH * OVERSAMPLING / 2 - edge + 0.5, 0, 1)
    image[..., :3] += (share * hit)[..., None] * (1 - image[..., :3])
    around = numpy.pad(depth, 1, constant_values=-numpy.inf)
    behind = numpy.minimum.reduce([around[2:, 1:-1], around[:-2, 1:-1], around[1:-1, 2:], around[1:-1, :-2]])
    with numpy.errstate(invalid="ignore"):
        contour = hit & (depth - behind > CONTOUR * OVERSAMPLING)
    image[contour, :3] = 0.35 * image[contour, :3]
    return image
