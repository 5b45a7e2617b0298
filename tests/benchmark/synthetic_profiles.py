#!/usr/bin/python3
"""Tests whether tanktread-fit recovers known moduli from synthetic outlines, and whether its standard errors are
correct. The outlines are those of a capsule in a tube at five speeds.

    # outlines without noise; the start value is wrong by a factor of 10; runs of the program, minutes
    tests/benchmark/synthetic_profiles.py --exact
    # 100 samples with noise of 0.5 % and 2 % of the radius; both laws are fitted to each sample; minutes
    tests/benchmark/synthetic_profiles.py --samples 100
    # 20 samples of outlines that are found in synthetic pictures, 256 pixels wide, with blur and noise
    tests/benchmark/synthetic_profiles.py --pictures 20
    # writes outlines with noise, computed on a finer mesh, like those in inputs/studies
    tests/benchmark/synthetic_profiles.py --write DIR

The steady shape depends only on the capillary number. Therefore fits to samples and pictures do not run the program.
They interpolate the outlines of 11 runs per law by Chebyshev polynomials in the logarithm of the capillary number.
The largest error of this interpolation is printed.
"""

import functools
import itertools
import os
import pathlib
import types

from package import INPUTS, SIDE, answer, command_line, expect, numpy, scenes_of, table, tanktread
import scipy.interpolate
import scipy.ndimage

from tanktread.studies import fit_data, fit_model, outline, silhouette

DECK = INPUTS / "studies/capsule_in_tube.yaml"
LAWS, SPANS, FINE, SPEEDS = scenes_of(__file__).values()
MODULUS, RADIUS, POINTS, NODES = 20.0, 0.8, 60, 11
ANGLES = 2 * numpy.pi * numpy.arange(1600) / 1600  # the chords of a polygon lie 2e-6 of the radius inside its circle


def profile(study, settings):
    outcome = study.run(DECK, settings)
    expect(outcome.done, f"a run failed: {outcome.message}")
    return silhouette.seen(outcome.run.snapshots()[-1]).centred()


def radii(curve):
    """Returns the distances of a curve from its centroid at ANGLES."""
    points = curve.even(3000)[numpy.arange(3001) % 3000]  # closed
    angle = numpy.unwrap(numpy.arctan2(points[:, 1], points[:, 0]))
    spline = scipy.interpolate.CubicSpline(angle, numpy.linalg.norm(points, axis=1), bc_type="periodic")
    return spline(angle[0] + (ANGLES - angle[0]) % (2 * numpy.pi))


class Emulator:
    """Replaces fit_model.Runs. Interpolates the outlines of a law over the logarithm of the capillary number."""

    count, name = 0, staticmethod(fit_model.Runs.name)

    def __init__(self, study, law):
        self.failures = {}
        self._low, self._high = SPANS[law]
        low, high = numpy.log(SPANS[law])
        nodes = (low + high) / 2 + (high - low) / 2 * numpy.cos(numpy.pi * (numpy.arange(NODES) + 0.5) / NODES)
        jobs = [LAWS[law] | FINE | {"Membrane/shear modulus": float(numpy.exp(-node))} for node in nodes]
        study.all([(DECK, job) for job in jobs])
        values = numpy.array([radii(profile(study, job)) for job in jobs])
        self._radii = scipy.interpolate.BarycentricInterpolator(nodes, values)

    @functools.cache
    def curve(self, capillary_number):
        radius = self._radii(numpy.log(capillary_number))
        points = numpy.column_stack([radius * numpy.cos(ANGLES), radius * numpy.sin(ANGLES)])
        return silhouette.Outline(points).centred()

    def all(self, jobs):
        numbers = [settings["Flow/mean velocity"] / settings["Membrane/shear modulus"] for _, settings in jobs]
        beyond = {self.name(*job): fit_model.Failure(job[0].name, job[1], "none", "beyond the emulator")
                  for job, number in zip(jobs, numbers) if not self._low < number < self._high}
        self.failures |= beyond
        return [None if self.name(*job) in beyond else [self.curve(number)] for job, number in zip(jobs, numbers)]


def experiments(outlines):
    """Returns the experiments of a fit, one per speed. `outlines`: for each speed, points (n, 2) and their standard
    error."""
    found = []
    for speed, (points, error) in zip(SPEEDS, outlines):
        datum = fit_data.OutlineData.__new__(fit_data.OutlineData)  # not by its constructor, which reads a file
        vars(datum).update(name=f"speed {speed}", at=None, axis=1, scale=1.0, error=error, points=points,
                           count=len(points), places=2, free_scale=False, scale_error=0, cases=[{}])
        found.append(types.SimpleNamespace(name=datum.name, settings={"Flow/mean velocity": speed}, unknowns=[],
                                           data=[datum], cases=[{}]))
    return found


def fitted(law, data, runs, start, settings=None):
    unknown = fit_data.Unknown("Membrane/shear modulus", {"start": start})
    return fit_model.Fit(law, LAWS[law] | (settings or {}), [unknown], data, runs).solve()


def exact(study):
    for law in LAWS:
        base = LAWS[law] | FINE | {"Membrane/shear modulus": MODULUS}
        curves = [profile(study, base | {"Flow/mean velocity": speed}).even(POINTS) for speed in SPEEDS]
        runs = fit_model.Runs(study, [DECK], law)
        one = fitted(law, experiments((curve, 0.005 * RADIUS) for curve in curves), runs, 10 * MODULUS, FINE)
        print(f"{law}, no noise, start {10 * MODULUS:g}: G_s / true - 1 = "
              f"{one.unknowns[0].value(one.x[0]) / MODULUS - 1:.1e}, {runs.count} runs", flush=True)


def told(law, noise, fits):
    """Returns one row of the table. `fits`: for each sample, the fit of the true law and the fit of the other law."""
    values = numpy.array([true.unknowns[0].value(true.x[0]) for true, _ in fits]) / MODULUS - 1
    stated, spread = numpy.mean([true.number_errors[0] for true, _ in fits]), values.std(ddof=1)
    gaps = numpy.array([other.aic - true.aic for true, other in fits])
    return [law, noise, f"{100 * values.mean():+.3f} % ± {100 * spread / numpy.sqrt(len(fits)):.3f} %",
            f"{100 * spread:.3f} %", f"{100 * stated:.3f} %", f"{spread / stated:.2f}",
            f"{(gaps > 10).sum()} of {len(fits)}, wrongly {(gaps < -10).sum()}",
            sum(other.runs_test() < -2 for _, other in fits)]


def print_rows(study, rows, number, seed):
    """Constructs the emulators. Prints their largest error at capillary numbers between the interpolation nodes, and
    then the table of the rows that rows(emulators, generator, number) yields."""
    made = {law: Emulator(study, law) for law in LAWS}
    for law, one in made.items():
        known = {number: profile(study, LAWS[law] | FINE | {"Membrane/shear modulus": 1 / number})
                 for number in (0.02, 0.08)}
        off = max(abs(one.curve(number).distances(curve.even(POINTS))).max() for number, curve in known.items())
        print(f"{law}: the emulator is {off / RADIUS:.1e} of the radius from runs in between")
    table(["law", "noise", "mean error of G_s ± its standard error", "spread", "stated error", "spread / stated",
           "law found (AIC + 10)", "runs test rejects the other"], rows(made, numpy.random.default_rng(seed), number))


def fits_of(law, made, number, measured):
    """Returns `number` pairs of fits, of the true law and of the other law. measured(curve) returns noisy points of an
    outline and their standard error."""
    curves = [made[law].curve(speed / MODULUS) for speed in SPEEDS]
    data = [experiments(map(measured, curves)) for _ in range(number)]
    return [[fitted(name, one, made[name], 1.5 * MODULUS) for name in {law: None} | LAWS] for one in data]


def samples(made, generator, number):
    for law, noise in itertools.product(LAWS, (0.005 * RADIUS, 0.02 * RADIUS)):
        fits = fits_of(law, made, number, lambda curve: (
            curve.even(POINTS) + noise * generator.standard_normal((POINTS, 2)), noise))
        yield told(law, f"{100 * noise / RADIUS:g} %", fits)


def picture(curve, generator, pixels=256, blur=1.5, noise=0.02, finer=6):
    """Returns an image of a dark particle on a bright background, the length of a pixel, and the position of the
    particle relative to the image centre in pixels (to the left and down). The particle takes 0.8 of the width. `blur`:
    standard deviation in pixels. `noise`: standard deviation divided by the contrast. `finer`: samples per pixel and
    direction."""
    length = numpy.ptp(curve.even(400), axis=0).max() / (0.8 * pixels)
    shift = generator.uniform(-3, 3, 2)
    x = ((numpy.arange(pixels * finer) + 0.5) / finer - pixels / 2) * length
    right, up = (axis + one * length for axis, one in zip(numpy.meshgrid(x, -x), shift))
    rim = curve.even(3000)
    reach = numpy.interp(numpy.arctan2(up, right), numpy.arctan2(rim[:, 1], rim[:, 0]), numpy.linalg.norm(rim, axis=1),
                         period=2 * numpy.pi)
    inside = (numpy.hypot(right, up) < reach).reshape(pixels, finer, pixels, finer).mean((1, 3))
    image = scipy.ndimage.gaussian_filter(0.8 - 0.5 * inside, blur)
    return image + 0.5 * noise * generator.standard_normal(image.shape), length, shift


def pictures(made, generator, number):
    def measured(curve):
        image, length, shift = picture(curve, generator)
        found = outline.outline(image, "a picture", POINTS)
        points = ((found.points - (image.shape[0] - 1) / 2) * [1, -1] + shift) * length
        off.extend(curve.distances(points) / length)
        return points, found.noise * length  # the optics of these pictures are known: an edge has no width of its own

    for law in LAWS:
        off = []
        fits = fits_of(law, made, number, measured)
        yield told(law, f"pictures; edge {numpy.mean(off):+.3f} ± {numpy.std(off):.3f} pixel", fits)


def write(study, directory):
    """Writes one outline per speed, computed on a finer mesh than the mesh of the fit. Unit: 0.01 tube radii. Each has
    noise of 0.5 % of the particle radius, and is shifted at random."""
    generator = numpy.random.default_rng(5)
    directory.mkdir(parents=True, exist_ok=True)
    for speed in SPEEDS:
        curve = profile(study, {SIDE: 8, "Flow/mean velocity": speed, "Membrane/shear modulus": MODULUS})
        noise = 0.005 * RADIUS * generator.standard_normal((POINTS, 2))
        points = 100 * (curve.even(POINTS) + noise) + generator.uniform(150, 250, 2)
        path = directory / f"profile_{speed}.csv"
        numpy.savetxt(path, points, delimiter=",", header="x1,x3", comments="", fmt="%.2f")
        print(path)


def main():
    parser = command_line(__doc__)
    parser.add_argument("--exact", action="store_true", help="fit outlines without noise")
    parser.add_argument("--samples", type=int, default=0, metavar="N", help="number of samples with noise")
    parser.add_argument("--pictures", type=int, default=0, metavar="N", help="number of samples of five pictures")
    parser.add_argument("--write", type=pathlib.Path, metavar="DIR", help="directory to which outlines are written")
    parser.add_argument("--output", default="results/synthetic_profiles", metavar="DIR",
                        help="directory of the runs (default: %(default)s)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(),
                        help="number of simultaneous runs (default: the number of cores)")
    parsed = parser.parse_args()
    study = tanktread.Study(directory=parsed.output, jobs=parsed.jobs)
    if parsed.write:
        write(study, parsed.write)
    if parsed.exact:
        exact(study)
    for seed, rows, number in (1, samples, parsed.samples), (2, pictures, parsed.pictures):
        if number:
            print_rows(study, rows, number, seed)


if __name__ == "__main__":
    answer(main)
