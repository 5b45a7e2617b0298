"""Renderer of surfaces: orthographic projection with a depth buffer that removes hidden parts. Surfaces have almost no
shading, so that their colours agree with the colour bar."""

import itertools

import numpy

STEP = 0.7        # distance between samples of a surface in pixels: below 1/√2, so that no pixel is missed
COARSE = 6        # intervals along a side of a cell in the grid from which the size of the cell is estimated
RIM = 0.14        # darkening where the surface is parallel to the line of sight; 0 where it faces the observer
EDGE_WIDTH = 1.2  # width of element edges, in pixels
EDGE_INK = 0.75   # opacity of the white element edges
INSIDE = 0.45     # grey value of the inner side of a particle that a face of the periodic cell cuts open
CONTOUR = 8       # a contour is drawn where the depth of neighbouring pixels differs by more than this, in pixels
OVERSAMPLING = 2  # finer pixels along the side of a pixel of the image


def picture(shot, values, view, colour_of, pixels=640):
    """Returns an image (rows, columns, RGBA) of the surfaces in a snapshot, its uppermost row first, and its extent
    (left, right, low, high) in the length unit of the snapshot.

    `values` (n,): values at the nodes that determine the colours. `view` (3, 3): rows are the directions to the right,
    up and towards the observer. If the snapshot is a lattice, the image shows the periodic cell centred at the origin,
    with the periodic images of the particles, cut at its faces. Posts are grey. `colour_of`: function that maps values
    to RGBA. `pixels`: length of the longer side."""
    depth, found, corner, size = seen(shot, values, view, OVERSAMPLING * pixels)
    columns, rows = numpy.array(depth.shape) // OVERSAMPLING
    image = _coloured(depth, found, colour_of).reshape(columns, OVERSAMPLING, rows, OVERSAMPLING, 4).mean((1, 3))
    image[..., :3] /= numpy.maximum(image[..., 3:], 1e-12)
    end = corner + numpy.array(depth.shape) / size
    return numpy.clip(image.transpose(1, 0, 2)[::-1], 0, 1), (corner[0], end[0], corner[1], end[1])


def seen(shot, values, view, pixels):
    """Returns four items: the depth of the visible sample in every pixel (right, up), towards the observer, in pixels,
    and -inf outside the surface; for every pixel the value, the cosine of the angle between normal and line of sight,
    and the distance from an element edge in pixels; the position of the lower left corner; pixels per length."""
    frame = shot.frame @ view.T
    low, high = frame[:, :2].min(0), frame[:, :2].max(0)
    size = pixels / (high - low).max()
    shape = OVERSAMPLING * (numpy.ceil((high - low) * size / OVERSAMPLING).astype(int) + 4)
    corner = low - 2 * OVERSAMPLING / size
    depth = numpy.full(shape.prod(), -numpy.inf, numpy.float32)
    found = numpy.zeros((shape.prod(), 3), numpy.float32)
    shifts, lattice = [-shot.origin @ view.T * size], None
    if shot.cell is not None:
        vectors = shot.cell @ view.T * size
        shifts = [shifts[0] + steps @ vectors for steps in itertools.product((-1, 0, 1), repeat=3)]
        lattice = numpy.linalg.inv(vectors)
    drawn = [(shot, values)] + [(one, numpy.full(len(one.points), numpy.nan)) for one in [shot.posts] if one]
    for (one, known), shift in itertools.product(drawn, shifts):
        for sample in _samples(one, one.positions @ view.T * size + shift, known, lattice):
            sample[:, :3] += shot.origin @ view.T * size
            if one is shot.posts:
                sample[:, 5] = numpy.inf  # without the edges of its elements
            column, row = numpy.clip((sample[:, :2] - corner * size).astype(int), 0, shape - 1).T
            place = column * shape[1] + row
            order = numpy.argsort(sample[:, 2], kind="stable")  # the sample nearest to the observer is written last
            order = order[sample[order, 2] > depth[place[order]]]
            depth[place[order]] = sample[order, 2]
            found[place[order]] = sample[order, 3:]
    return depth.reshape(shape), found.reshape(*shape, 3), corner, size


def _samples(shot, places, values, lattice=None):
    """Yields samples of the surface at most STEP pixels apart, for some cells at a time. A row holds position (3),
    value, cosine of the angle between normal and line of sight, and distance from the edge of the cell in pixels.
    `lattice`: matrix that maps positions to lattice coordinates. If it is given, yields only samples in the periodic
    cell at the origin, also of inner sides, whose value is NaN."""
    known = numpy.column_stack([places, values]).astype(numpy.float32)  # rounding: 1e-4 pixels
    grid = shot.sampled(places, COARSE)
    visible = _normals(grid)[0] > -0.2 if lattice is None else (numpy.abs(grid @ lattice) < 0.5).all(-1)
    seen = numpy.flatnonzero(visible.any((1, 2)))
    if len(seen) == 0:
        return
    # the longest projected interval determines the number of samples, because intervals differ in length
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
    """Returns, at the points of grids, the cosine of the angle between normal and line of sight, and the area and the
    lengths along t and s of a grid interval."""
    t, s = numpy.gradient(grid, axis=(1, 2))
    normal = numpy.cross(s, t)
    area, length_t, length_s = (numpy.maximum(numpy.linalg.norm(x, axis=-1), 1e-12) for x in (normal, t, s))
    return normal[..., 2] / area, area, length_t, length_s


def _coloured(depth, found, colour_of):
    """Returns the RGBA colours (columns, rows, 4), with RGB multiplied by the opacity. Draws the darker rim, element
    edges and contours. Pixels outside the surface are transparent."""
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
