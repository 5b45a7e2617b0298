"""Finds the outline of a particle in a picture with subpixel accuracy, and the standard error of its points.

    tanktread-outline picture.png -o profile.csv --overlay check.png

The picture is a PNG, TIFF or JPEG. The result is a table of points for tanktread-fit, in pixels. The origin is the
upper left corner of the picture. x1 points to the right and x3 up, so that x3 is negative; the fit is not affected.

The outline is the outermost closed edge. The particle must lie completely within the picture. Edges that end at the
frame of the picture, such as channel walls, and slow changes of the light are ignored. If there are several particles,
the largest one is taken; `--region` chooses another one.

Many particles have a rim: a dark ring in bright field, a bright halo in phase contrast. It has an outer and an inner
edge, and `--edge` says which one is the outline. Without this option,

- of a bright halo around a darker body the inner edge is taken, because the halo is light beside the body;
- of a rim narrower than a twentieth of the particle the middle is taken, and also of a blurred line up to 8 % of it;
- of a wider rim with resolved edges around a body that is brighter or darker than the surroundings, the outer edge is
  taken;
- of a rim one of whose edges is three times as strong as the other, the strong edge is taken.

The command prints which edge was taken, and the edges that enclose it. It refuses other wide rims.

The stated error consists of the scatter of the points by noise, which is independent for each point, and of the width
of the edge, which is the same for all points. The latter is a tenth of the distance in which the brightness changes,
and a fifth of the width of a narrow rim, but at most 0.9 % of the size. Both edges of a narrow rim then lie within
three errors of its middle. A picture whose points would have an error of more than 1 % of the size is refused.

The edge is found on normals to a first outline, which is the ridge of the gradient of the smoothed picture:

1. The brightness is averaged over all normals. The edges are the steep parts of the average profile. An edge lies where
   the brightness is halfway between the values on its two sides.
2. The profile of each normal is fitted by the average profile, shifted along the normal, by least squares.
3. Each point of the outline is averaged from the neighbouring normals. No normal is used twice, so that the errors of
   the points by noise are independent.
4. Blur of variance s moves a curved edge towards its centre of curvature by s/2 times the curvature. This shift is
   corrected.
"""

import dataclasses

import numpy
import scipy.ndimage
import scipy.signal

from ..figures import style
from ..mistakes import command_line, expect, log
from . import picture as pictures

FINE = 0.25       # distance between samples on a normal, in pixels
NOTICED = 0.05    # an edge has at least this fraction of the largest step and of the largest slope of the profile
WEAK = 0.3        # an edge of a rim is weak if its step is less than this fraction of the step of the other edge
RIM = 0.12        # two edges of opposite sign belong to a rim if their distance is at most this fraction of the size
NARROW = 0.05     # a rim is narrow up to this fraction of the size: a fifth of it is 1 % of the size
WIDE = 0.08       # a blurred line is narrow up to this fraction of the size: two thirds of it lie within three errors
LINE = 3.65       # a rim whose width is less than this multiple of its blur is a line (a Gaussian profile: 3.59)
SHARP = 5.0       # the edges of a rim are resolved if its width is at least this multiple of its blur
ROUGH = 0.5       # largest accepted scatter of single normals, in pixels, in addition to five times that by noise
LARGEST = 0.01    # largest accepted error of a point, as a fraction of the size
EDGES = ("outer", "middle", "inner")


@dataclasses.dataclass
class Edge:
    """A steep part of a profile. `at`: offset where the brightness is halfway between the values at the two ends.
    `centroid`: offset of the sharp step with the same integral. `low`, `high`: offsets of the ends. `step`: brightness
    at `high` minus brightness at `low`. `blur`: standard deviation of the Gaussian with the same slope. Lengths in
    pixels; offsets increase outwards."""
    at: float
    centroid: float
    low: float
    high: float
    step: float
    blur: float

    def width(self):
        """Returns the part of the stated error that is due to the width of the edge: a tenth of the distance in which a
        quarter of the step becomes three quarters, because the level at which an edge is seen depends on the optics and
        the camera, and the distance of the two definitions of its position."""
        return float(numpy.hypot(0.135 * self.blur, self.at - self.centroid))


@dataclasses.dataclass
class Choice:
    """The edge that is taken. `first`, `last`: the edges between whose middles it lies in the middle. `width`: part of
    the stated error in pixels. `text`: which edge it is, for the reader."""
    first: Edge
    last: Edge
    width: float
    text: str

    at = property(lambda self: (self.first.at + self.last.at) / 2)


@dataclasses.dataclass
class Outline:
    """`points`: (n, 2) as (column, row). `noise`: standard error of a point by noise, `width`: error of all points by
    the width of the edge, in pixels. `text`: which edge was taken. `others`: texts about other edges, for example edges
    that enclose it."""
    points: numpy.ndarray
    noise: float
    width: float
    text: str
    others: list

    error = property(lambda self: float(numpy.hypot(self.noise, self.width)), doc="the stated error of a point, pixels")


def size_of(points):
    """Returns the diameter of the circle that has the area of a closed polygon (n, 2)."""
    x, y = points.T
    return numpy.sqrt(2 / numpy.pi * abs(x @ numpy.roll(y, 1) - y @ numpy.roll(x, 1)))


def first_outline(region, path):
    """Returns points (n, 2) as (row, column) on the edge of a region, less than one pixel apart, in the order of their
    angle."""
    middle = region.middle()
    count = max(90, 4 * int(numpy.sqrt(region.inside.sum())) * region.step)
    angle = 2 * numpy.pi * numpy.arange(count) / count
    ray = numpy.stack([numpy.sin(angle), numpy.cos(angle)], axis=-1)
    radius = numpy.arange(0, numpy.hypot(*region.gradient.shape), 0.5)
    places = middle[:, None, None] + ray.T[:, :, None] * radius
    inside = scipy.ndimage.map_coordinates(region.inside.astype(float), places / region.step, order=1) > 0.5
    last = inside.shape[1] - 1 - inside[:, ::-1].argmax(1)
    hollow = (~inside & (radius < radius[last][:, None])).sum() / inside.sum()
    expect(hollow < 0.02, f"{path}: the outline is met more than once on rays from its centre: if it is that of a "
           "particle and of what touches it, --region LEFT UPPER RIGHT LOWER leaves out one of them")
    gradient = scipy.ndimage.map_coordinates(region.gradient, places, order=1, mode="constant")
    # the region ends where the gradient exceeds its threshold, and the ridge is the next maximum outwards
    rising = (numpy.diff(gradient, axis=1) > 0) | (numpy.arange(len(radius) - 1) < last[:, None])
    found = radius[rising.argmin(1)]
    near = scipy.ndimage.median_filter(found, 2 * (count // 40) + 1, mode="wrap")
    found = numpy.where(abs(found - near) > numpy.maximum(3 * region.step, 0.1 * near), near, found)
    found = scipy.ndimage.gaussian_filter1d(found, count / found.mean() / 2, mode="wrap")
    return middle + found[:, None] * ray


def with_normals(points, count):
    """Returns `count` points with equal distances on a closed curve through the points (n, 2), which are ordered from
    the direction of columns to that of rows, and outward unit normals."""
    closed = numpy.concatenate([points, points[:1]])
    along = numpy.concatenate([[0], numpy.cumsum(numpy.linalg.norm(numpy.diff(closed, axis=0), axis=1))])
    even = along[-1] * numpy.arange(count) / count
    points = numpy.stack([numpy.interp(even, along, one) for one in closed.T], axis=-1)
    smooth = scipy.ndimage.gaussian_filter1d(points, 3 * count / along[-1], axis=0, mode="wrap")
    tangent = numpy.roll(smooth, -1, axis=0) - numpy.roll(smooth, 1, axis=0)
    return points, tangent[:, ::-1] * [-1, 1] / numpy.linalg.norm(tangent, axis=1)[:, None]


def levelled(values, part=slice(None)):
    """Returns values (n, m) minus the mean of each row over some columns, plus the mean of all. The median over rows
    then does not depend on slow changes of the light along the outline."""
    level = numpy.nanmean(values[:, part], axis=1, keepdims=True)
    return values - level + numpy.nanmean(level)


class Normals:
    """Brightness of a picture on normals to a curve. `found` (n,): offset of the edge on each normal, in pixels.
    `shift` (n,): the same averaged over `each` neighbours, to which profiles refer. Profiles that refer to the offsets
    of single normals are too steep, because these follow the noise. `expected`: standard error of `found` by the noise
    of the picture."""

    def __init__(self, picture, points, normals, each):
        self.picture, self.points, self.normals, self.each = picture, points, normals, each
        self.coefficients = scipy.ndimage.spline_filter(picture, 3, mode="mirror")
        self.found = self.shift = numpy.zeros(len(points))
        self.expected = 0.0

    def values(self, off):
        """Returns the brightness (n, len(off)) at offsets from the edge; NaN outside of the picture."""
        places = (self.points + self.shift[:, None] * self.normals).T[:, :, None] + self.normals.T[:, :, None] * off
        values = scipy.ndimage.map_coordinates(self.coefficients, places, order=3, prefilter=False, mode="mirror")
        rows, columns = self.picture.shape
        outside = (places < 0).any(0) | (places[0] > rows - 1) | (places[1] > columns - 1)
        return numpy.where(outside, numpy.nan, values)

    def profile(self, off):
        """Returns the median brightness over all normals at each offset, which ignores what lies beside a small part of
        the outline, smoothed over half a pixel, and its standard error. NaN where half of the normals have left the
        picture."""
        values = levelled(self.values(off), abs(off) < -off[0] / 3)
        seen = numpy.isfinite(values).mean(0) > 0.5
        profile = numpy.full(len(off), numpy.nan)
        profile[seen] = scipy.ndimage.gaussian_filter1d(numpy.nanmedian(values[:, seen], axis=0), 0.5 / FINE)
        # differences of neighbours are free of slow changes along the outline; 0.6745: median of |normal deviates|;
        # 1.25: standard error of a median divided by that of a mean
        noise = numpy.nanmedian(abs(numpy.diff(values[:, seen], axis=0))) / 0.6745 / numpy.sqrt(2)
        return profile, 1.25 * noise / numpy.sqrt(len(values))

    def align(self, first, last, reach):
        """Shifts each normal so that its brightness between the offsets `first` and `last` agrees best with the average
        of all normals. Levels and contrast vary slowly along the outline. Shifts by at most `reach` in a step."""
        off = numpy.arange(first, last + FINE / 2, FINE)
        values = self.values(off)
        values = numpy.where(numpy.isfinite(values), values, numpy.nanmedian(values, axis=0))
        mean = numpy.median(levelled(values), axis=0)
        slope = numpy.gradient(scipy.ndimage.gaussian_filter1d(mean, 0.5 / FINE), off)
        # the slope is fitted too, so that the levels do not depend on the shift
        basis = numpy.stack([numpy.ones(len(off)), mean - mean.mean(), slope], axis=-1)
        factors = values @ numpy.linalg.pinv(basis).T
        levels = scipy.ndimage.gaussian_filter1d(factors[:, :2], len(values) / 40, axis=0, mode="wrap")
        contrast = levels[:, 1] / numpy.median(levels[:, 1])
        rest = (values - levels @ basis[:, :2].T) / numpy.where(contrast > 0.1, levels[:, 1], 1)[:, None]
        self.expected = pictures.noise_of(self.picture) / numpy.sqrt(slope @ slope * FINE)
        self.found = self.shift - numpy.clip(rest @ slope / (slope @ slope), -reach, reach)
        self.shift = scipy.ndimage.uniform_filter1d(self.found, self.each, mode="wrap")

    def brighter_outside(self):
        """Returns the fraction of the normals on which the brightness increases outwards at the edge. It is averaged
        over a fifteenth of the outline to reduce the noise."""
        rise = self.values(numpy.array([-1.5, 1.5])) @ [-1, 1]
        rise = scipy.ndimage.uniform_filter1d(numpy.nan_to_num(rise), len(rise) // 15 + 1, mode="wrap")
        return (rise > 0).mean()


def edges_of(off, profile, noise=0.0):
    """Returns the edges of a profile, from the outermost to the innermost. `profile`: brightness at the offsets `off`,
    which increase outwards, and `noise` its standard error."""
    off, profile = off[numpy.isfinite(profile)], profile[numpy.isfinite(profile)]
    slope = numpy.gradient(profile, off)
    # five standard errors of the slope of a profile that is smoothed over half a pixel, which is about noise per pixel
    least = max(NOTICED * abs(slope).max(), 5 * noise)
    peaks, _ = scipy.signal.find_peaks(abs(slope), height=least, prominence=least)
    # a step with two steepest points is one edge if the slope between them stays above a third of the smaller one
    for before, after in list(zip(peaks, peaks[1:])):
        less = min(abs(slope[before]), abs(slope[after]))
        if (slope[before:after + 1] / slope[before]).min() * abs(slope[before]) > less / 3:
            peaks = peaks[peaks != min(before, after, key=lambda one: abs(slope[one]))]
    found = []
    for number, peak in enumerate(peaks):
        # an edge ends where the slope changes its sign, and between two edges where the slope is smallest
        before = peaks[number - 1] if number else 0
        after = peaks[number + 1] if number + 1 < len(peaks) else len(off) - 1
        same = slope * slope[peak] > 0
        low = before + abs(slope[before:peak + 1]).argmin() if number else 0
        high = peak + abs(slope[peak:after + 1]).argmin() if number + 1 < len(peaks) else len(off) - 1
        low = max(low, peak - same[peak::-1].argmin() if not same[:peak].all() else 0)
        high = min(high, peak + same[peak:].argmin() if not same[peak:].all() else len(off) - 1)
        first, last, blur = low, high, 0.0
        for _ in range(20):  # the ends are three standard deviations from the steepest point, or nearer
            step = profile[last] - profile[first]
            blur = abs(step / slope[peak]) / numpy.sqrt(2 * numpy.pi)
            reach = int(numpy.ceil(max(3 * blur, 1) / FINE))
            first, last = max(low, peak - reach), min(high, peak + reach)
        part = slice(first, last + 1)
        rise = (profile[part] - profile[first]) / step
        above = max(1, int((rise >= 0.5).argmax()))
        share = (0.5 - rise[above - 1]) / (rise[above] - rise[above - 1])
        found.append(Edge(float(off[first + above - 1] + FINE * share), float(off[last] - FINE * rise.sum() + FINE / 2),
                          float(off[first]), float(off[last]), float(step), float(blur)))
    tall = max((abs(edge.step) for edge in found), default=0.0)
    # six standard errors of the difference of two values, which noise exceeds in no picture
    return [edge for edge in found if abs(edge.step) > max(NOTICED * tall, 6 * numpy.sqrt(2) * noise)][::-1]


def rim_of(edges, size):
    """Returns the outer and the inner edge of the rim that begins with the first of `edges`, or None. `size`: of the
    particle, in pixels."""
    if len(edges) < 2 or edges[0].step * edges[1].step > 0:
        return None
    width, blur = edges[0].at - edges[1].at, max(edge.blur for edge in edges[:2])
    return edges[:2] if width <= max(RIM * size, LINE * blur) else None


def choose(off, profile, noise, size, given, path):
    """Returns the Choice among the edges of a profile, and a list of texts about the other edges. `noise`:
    standard error of the profile. `given`: one of EDGES, or None."""
    edges, texts = edges_of(off, profile, noise), []
    expect(edges, f"{path}: no edge was found along the outline: --region LEFT UPPER RIGHT LOWER chooses the part of "
           "the picture around the particle")
    rim, around, inside = rim_of(edges, size), edges[0].step, 0.0
    if rim:
        # brightness inside of the rim minus that of the surroundings, divided by the step of the outer edge
        inside = -(rim[0].step + rim[1].step) / around
        halo = around < 0 and inside > WEAK / 2
        inner = rim_of(edges[1:], size) if halo else None
        if inner:  # the halo surrounds a dark rim
            texts = [f"the outer edge of a bright halo {rim[0].at - rim[1].at:.1f} pixels wide encloses it"]
            rim, halo, inside = inner, False, (inner[0].step + inner[1].step + around) / around
    if not rim:
        expect(given in (None, "outer"), f"{path}: the particle has no rim: leave out --edge {given}")
        return Choice(edges[0], edges[0], edges[0].width(), "the outermost closed edge"), texts
    first, last = rim
    width = first.at - last.at
    name = f"{'bright halo' if halo else 'dark rim' if first.step > 0 else 'bright rim'} {width:.1f} pixels wide"
    beyond = texts + [f"the outer edge of the {name} encloses it: --edge outer takes that edge"]
    # the other edge of the rim moves a blurred edge by about its variance divided by the width of the rim
    most = 0.9 * LARGEST * (size + 2 * last.at)  # a tenth is left for the noise
    widths = {one: min(float(numpy.hypot(edge.width(), edge.blur**2 / width)), most)
              for one, edge in {"outer": first, "inner": last}.items()}
    within = texts + [f"the {name} lies inside of it: --edge middle or --edge inner takes its middle or its inner edge"]
    choices = {"outer": (Choice(first, first, widths["outer"], f"the outer edge of a {name}"), within),
               "middle": (Choice(first, last, max(first.width(), last.width()), f"the middle of a {name}"), beyond),
               "inner": (Choice(last, last, widths["inner"], f"the inner edge of a {name}"), beyond)}
    if given:
        return choices[given]
    line = width < LINE * max(first.blur, last.blur)
    # blur reduces the steps of a line
    strong = [one for one, other in (rim, rim[::-1]) if abs(other.step) < (WEAK / 2 if line else WEAK) * abs(one.step)]
    plain = abs(inside) < WEAK / 2  # as bright inside as outside
    default = "inner" if halo or last in strong else "outer" if first in strong else None
    if width <= NARROW * size or width <= WIDE * size and (line or plain):
        choice, texts = choices[default or "middle"]
        return dataclasses.replace(choice, width=max(choice.width, min(width / 5, most))), texts
    expect(default or not plain and width > SHARP * max(first.blur, last.blur),
           f"{path}: the particle has a {name}, {width / size:.0%} of its size: "
           "--edge outer, --edge middle or --edge inner says where its outline is")
    return choices[default or "outer"]


def edge(picture, region, count, given, path):
    """Returns the Outline with `count` points of the edge of a region. Each point is the mean of an odd
    number of neighbouring normals, about two pixels apart."""
    start = first_outline(region, path)
    size = size_of(start)
    each = max(2, int(numpy.pi * size / 2 / count)) // 2 * 2 + 1
    lines = Normals(picture, *with_normals(start, count * each), each)
    expect(not 0.25 < lines.brighter_outside() < 0.75,
           f"{path}: the particle is darker than its surroundings on one side and brighter on the other, as in relief "
           "contrast (DIC): take it in bright field or phase contrast; if walls or uneven light are the reason, "
           "--background FILE, a picture without the particle, removes them")
    coarse = min(4.0 * region.step, size / 8)
    for _ in range(3):
        lines.align(-coarse, coarse, coarse / 2)
    off = numpy.arange(-0.3 * size, 0.2 * size, FINE)
    choice, texts = choose(off, *lines.profile(off), size, given, path)
    first, last = choice.first, choice.last
    for _ in range(4):
        lines.align(min(last.low, last.at - 3), max(first.high, first.at + 3), 2)
        edges = edges_of(off, *lines.profile(off))
        first, last = (min((one for one in edges if one.step * old.step > 0), default=old,
                           key=lambda one: abs(one.at - old.at)) for old in (first, last))
    at = (first.at + last.at) / 2
    expect(abs(at - choice.at) < max(3, choice.first.at - choice.last.at),
           f"{path}: the edge that was found first is lost when the normals are aligned: --edge outer, --edge middle "
           "or --edge inner says where the outline is")
    places = lines.points + (lines.found + at)[:, None] * lines.normals
    expect(numpy.std(lines.found - lines.shift) < 5 * lines.expected + ROUGH,
           f"{path}: what lies beside the particle disturbs its edge: --background FILE, a picture without the "
           "particle, removes it, and --region LEFT UPPER RIGHT LOWER leaves it out")
    points, noise = averaged(places[:, ::-1], lines.normals[::each, ::-1], each)
    blur = (first.blur + last.blur) / 2
    return Outline(unbent(points, blur**2), noise, choice.width, choice.text, texts)


def unbent(points, variance):
    """Returns the points (n, 2) of an outline, corrected for the shift by blur of the given variance. The points are in
    the order of their angle."""
    before, after = points - numpy.roll(points, 1, axis=0), numpy.roll(points, -1, axis=0) - points
    chord, lengths = before + after, [numpy.linalg.norm(one, axis=1) for one in (before, after, before + after)]
    # curvature of the circle through three neighbouring points
    curvature = 2 * (before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]) / numpy.prod(lengths, axis=0)
    outwards = chord[:, ::-1] * [1, -1] / lengths[2][:, None]
    return points + (variance / 2 * curvature)[:, None] * outwards


def averaged(places, normals, each):
    """Returns points (n, 2) of the outline, each from the mean of `each` neighbouring places (n * each, 2), and the
    standard error of a point along its normal (n, 2). The mean of places on a curve lies inside of it. The second
    difference of the means corrects this."""
    parts = numpy.roll(places, each // 2, axis=0).reshape(-1, each, 2)
    means = parts.mean(1)
    bend = (numpy.roll(means, 1, axis=0) + numpy.roll(means, -1, axis=0) - 2 * means) / each**2
    along = numpy.arange(each) - each // 2
    rest = ((parts - means[:, None] - bend[:, None] / 2 * (along**2 - (along**2).mean())[:, None])
            * normals[:, None]).sum(2)
    rest = rest - (rest @ along / (along @ along))[:, None] * along
    error = numpy.sqrt((rest**2).sum() / (rest.size * (each - 2)))
    return means - bend / 2 * (along**2).mean(), float(error)


def outline(picture, path, count=None, given=None):
    """Returns the Outline of the particle in a picture (rows, columns) from which the background has been removed.
    `count`: number of points; by default 60, or fewer if the particle is small or the noise large. `given`: one of
    EDGES, or None. `path` names the picture in messages."""
    expect(numpy.ptp(picture) > 0, f"{path}: its brightness is the same everywhere")
    region = pictures.outermost(picture)
    expect(region, f"{path}: no edge closes within the picture: it must contain the whole particle; if it does, "
           "--background FILE, a picture without the particle, removes walls and uneven light, and --region LEFT UPPER "
           "RIGHT LOWER leaves out what is beside the particle")
    # each point takes three normals, about two pixels apart, because their scatter gives the standard error
    most = int(numpy.sqrt(region.inside.sum() * numpy.pi) * region.step / 2)
    expect(count is None or 8 <= count <= most,
           f"{path}: --points must be from 8 to {most}, half the rays of its outline")
    for number in [count] if count else sorted({min(one, most) for one in (60, 40, 27, 18, 12, 8)}, reverse=True):
        found = edge(picture, region, number, given, path)
        size = size_of(found.points)
        if found.error <= LARGEST * size:
            break
    expect(found.error <= LARGEST * size,
           f"{path}: the points would have an error of {found.error:.2f} pixels, {found.error / size:.1%} of the size "
           f"of the particle: take {'fewer --points, or ' if count and found.noise > found.width else ''}a sharper "
           "picture in which the particle is larger")
    if region.weaker:
        found.others.append("a weaker edge encloses it, {:.0f} x {:.0f} pixels".format(*region.weaker))
    if region.others:
        found.others.append(f"{region.others} other closed edges of comparable size: --region chooses one")
    return found


def main():
    parser = command_line(__doc__)
    parser.add_argument("picture", help="PNG, TIFF or JPEG file")
    parser.add_argument("-o", "--output", default="outline.csv", metavar="FILE",
                        help="table of the points (default: %(default)s)")
    parser.add_argument("--points", type=int, help="number of points (default: 60, fewer for a small particle)")
    parser.add_argument("--region", type=int, nargs=4, metavar=("LEFT", "UPPER", "RIGHT", "LOWER"),
                        help="part of the picture that is searched, in pixels from its upper left corner")
    parser.add_argument("--background", default="curved", metavar="{even,plane,curved,FILE}",
                        help="what is subtracted: a constant, a linear or quadratic fit of uneven light at "
                             "the border of the picture, or a picture without the particle (default: %(default)s)")
    parser.add_argument("--edge", choices=EDGES, help="edge of a rim that is the outline (default: see above)")
    parser.add_argument("--overlay", metavar="FILE", help="writes the picture with the points drawn on it, as a check")
    arguments = parser.parse_args()
    path = arguments.picture
    picture = pictures.part(pictures.grey(path), arguments.region, path)
    clear = pictures.without_background(picture, arguments.background, path, arguments.region)
    found = outline(clear, path, arguments.points, arguments.edge)
    points = found.points + (arguments.region[:2] if arguments.region else [0, 0])
    table = numpy.column_stack([points * [1, -1], numpy.full(len(points), found.error)])
    numpy.savetxt(arguments.output, table, "%.4f,%.4f,%.3g", header="x1,x3,error", comments="")
    width, height = numpy.ptp(points, axis=0)
    log.info(f"{arguments.output}: {len(points)} points, each with an error of {found.error:.3f} pixels "
             f"({found.noise:.3f} by noise, {found.width:.3f} by the width of the edge)")
    log.info(f"taken: {found.text}, {width:.1f} x {height:.1f} pixels")
    for text in found.others:
        log.info(text)
    if arguments.overlay:
        figure, (axis,) = style.panels(None, 1, 1, 6, 6 * picture.shape[0] / picture.shape[1])
        axis.imshow(picture, cmap="gray")
        axis.plot(*found.points.T, ".", color=style.RUNS[1], ms=2)
        axis.axis("off")
        style.save(figure, arguments.overlay)
