#!/usr/bin/python3
# Tests that tanktread-outline finds the outlines of particles in pictures as microscopes give them, states their errors, and refuses pictures
# in one sentence that names an option which helps.
import pathlib
import sys

import numpy
import scipy.ndimage
from PIL import Image

from harness import SOURCE, check, close, main, package

sys.path += [str(SOURCE / "postproc"), str(SOURCE / "tests/benchmark")]
from tanktread.mistakes import Mistake
from tanktread.studies import fit_data, outline, picture, silhouette

from looks_of_particles import found_in, grid, looks, photographed, ring

def each_look_is_found_within_three_stated_errors_of_at_most_one_per_cent():
    for a, b in (36, 30), (70, 60):
        for name, drawing in looks(a, b).items():
            for blur, noise in ((1.5, 0.01),) if name != "filled, dark" else ((1, 0), (1.5, 0.08), (2.5, 0.01)):
                found, off = found_in(photographed(drawing, blur, noise), a, b)
                size = 2 * numpy.sqrt(a * b)
                check(off < 3 * found.error, f"{name}, {a}: {off:.2f} pixels off, stated {found.error:.2f}, {found.text}")
                check(found.error < 0.01 * size, f"{name}, {a}: stated {found.error:.2f}, {found.text}")


def both_edges_of_a_narrow_rim_lie_within_three_stated_errors():
    image = photographed(looks(70, 60)["a narrow dark rim, bright inside"])
    middle = found_in(image, 70, 60)[0]
    for given in "outer", "inner":
        off = abs(numpy.ptp(found_in(image, 70, 60, given)[0].points, axis=0) - numpy.ptp(middle.points, axis=0)) / 2
        check((off > 1).all() and (off < 3 * middle.error).all(), given, off, middle.error)


def the_edge_of_a_wide_rim_is_said_or_asked_for():
    _, _, far = grid(60, 52)
    rim = numpy.where(ring(far, 0, -9), 0.25, 0.6 + 0.2 * (far < -9))
    found, off = found_in(photographed(rim), 60, 52)  # a body as bright as the surroundings is asked for, this one is not
    check(off < 0.1 and "outer edge of a dark rim 9.0 pixels" in found.text, found.text, off)
    plain = photographed(numpy.where(ring(far, 0, -9), 0.25, 0.6))
    try:
        found_in(plain, 60, 52)
        check(False, "a wide ring is accepted")
    except Mistake as mistake:
        check("--edge outer, --edge middle or --edge inner" in str(mistake), mistake)
    for k, given in enumerate(outline.EDGES):
        found, off = found_in(plain, 60 - 4.5 * k, 52 - 4.5 * k, given)
        check(off < 0.2 and ("encloses it" in " ".join(found.others)) == (k > 0), given, off, found.others)
    try:
        found_in(photographed(0.6 - 0.3 * (far < 0)), 60, 52, "inner")
        check(False, "an inner edge without a rim")
    except Mistake as mistake:
        check("leave out --edge inner" in str(mistake), mistake)


def an_edge_in_an_image_is_found_to_a_twentieth_of_a_pixel():
    x, y, _ = grid(100, 100, 28)
    along, across = (0.8 * x + 0.6 * y) / 90, (-0.6 * x + 0.8 * y) / 70
    angle = 2 * numpy.pi * numpy.arange(400) / 400
    exact = numpy.stack([90 * numpy.cos(angle), 70 * numpy.sin(angle)], axis=-1) @ [[0.8, 0.6], [-0.6, 0.8]] + [127.5 + 0.3, 127.5 - 0.4]
    edge = silhouette.Outline(exact)
    for noise, bound in (0, 0.02), (0.01, 0.05):
        image = photographed(0.8 - 0.5 * (along**2 + across**2 < 1), 1.5, noise)
        found = outline.outline(image, "picture", 60)
        off = edge.distances(found.points)
        check(numpy.sqrt((off**2).mean()) < bound, f"noise {noise}: {numpy.sqrt((off ** 2).mean()):.3f} pixels")
        check(noise == 0 or 0.6 < off.std() / found.noise < 1.6, f"stated {found.noise:.3f}, found {off.std():.3f}")
    Image.fromarray(image.astype("u1")).save("picture.png")
    said = package("outline", "picture.png", "-o", "edge.csv", "--overlay", "check.png")
    check(said.returncode == 0 and "60 points" in said.stdout and "outermost closed edge" in said.stdout, said)
    datum = fit_data.OutlineData({"outline": "edge.csv", "scale": 1.0}, "edge", pathlib.Path())
    check(abs(edge.distances(datum.points * [1, -1])).max() < 0.2, "the points in the file")
    close(datum.error, found.error, 0.05 * found.error, "the error in the file")


def the_shift_of_a_curved_edge_by_blur_is_corrected():
    _, _, far = grid(24, 24)
    off = found_in(photographed(0.6 - 0.35 * (far < 0), 2.5, 0), 24, 24)[1]
    close(off, 0, 0.06, "error of the radius")  # without the correction, it is 2.5^2 / (2 * 24) = 0.13


def pictures_are_read_in_the_usual_formats():
    _, _, far = grid(40, 34)
    image = photographed(0.6 - 0.35 * (far < 0))
    pictures = {"a.png": Image.fromarray(image.astype("u1")), "a.jpg": Image.fromarray(image.astype("u1")), "a.tif": Image.fromarray((16 * image).astype("u2")),
                "float.tif": Image.fromarray((image / 255).astype("f4")), "rgb.tif": Image.fromarray(image.astype("u1")).convert("RGB"),
                "rgba.png": Image.fromarray(image.astype("u1")).convert("RGBA"), "palette.png": Image.fromarray(image.astype("u1")).convert("P")}
    for name, one in pictures.items():
        one.save(name)
        values = picture.grey(name)
        factor = {"a.tif": 16, "float.tif": 1 / 255}.get(name, 1)
        close(abs(values / factor - image).max(), 0, 12 if name == "a.jpg" else 1e-4, name)
    check(abs(found_in(picture.grey("a.jpg"), 40, 34)[1]) < 0.2, "the outline in a JPEG")
    pathlib.Path("text.png").write_text("no picture")
    for name, words in ("text.png", "save it as PNG, TIFF or JPEG"), ("absent.png", "there is no such file"):
        said = package("outline", name)
        check(said.returncode == 2 and words in said.stderr and said.stderr.count("\n") == 1, said)


def a_refusal_names_an_option_that_helps():
    x, y, far = grid(40, 34)
    empty = 0.6 + 0.15 * numpy.sin(0.45 * x) * numpy.sin(0.45 * y) - 0.4 * (abs(y - 34) < 4)  # structured light, and a wall that touches
    for name, drawing in ("empty", empty), ("full", empty - 0.2 * (far < 0)), ("plain", 0.6 - 0.3 * (far < 0)):
        Image.fromarray(photographed(drawing, noise=0.005).astype("u1")).save(f"{name}.png")
    for background in "curved", "even":
        said = package("outline", "full.png", "--background", background)
        check(said.returncode == 2 and "--background FILE" in said.stderr and said.stderr.count("\n") == 1, said)
    said = package("outline", "full.png", "--background", "empty.png", "-o", "full.csv")
    check(said.returncode == 0, said)
    points = numpy.loadtxt("full.csv", delimiter=",", skiprows=1)
    close(numpy.ptp(points[:, 0]), 80, 6 * points[0, 2], "the width")
    Image.open("plain.png").crop((50, 0, 140, 128)).save("cut.png")
    two = numpy.concatenate([picture.grey("plain.png")] * 2, axis=1)
    Image.fromarray(two.astype("u1")).save("two.png")
    said = package("outline", "two.png", "--region", "140", "0", "280", "128", "-o", "two.csv")
    close(numpy.loadtxt("two.csv", delimiter=",", skiprows=1)[:, 0].mean(), 140 + 70 - 0.5 + 0.3, 0.5, "the particle in the region")
    for words, arguments in (("does not lie", ["two.png", "--region", "140", "0", "400", "128"]), ("no edge closes within the picture", ["cut.png"]),
                             ("has 280 columns", ["plain.png", "--background", "two.png"]), ("--points must be from 8", ["plain.png", "--points", "500"])):
        said = package("outline", *arguments)
        check(said.returncode == 2 and words in said.stderr and said.stderr.count("\n") == 1, said)
    check("--region chooses" in package("outline", "two.png").stdout, "of two particles one is taken without a word")


main()
