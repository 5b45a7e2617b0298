#!/usr/bin/python3
# Tests that figures and reports draw posts, plates, tubes and channels, cut particles wherever they are, and accept several
# particles and units.
import base64
import gzip
import json
import pathlib
import re
import sys
from unittest import mock

import numpy

from harness import SOURCE, check, close, deck, main, package, run

sys.path.append(str(SOURCE / "postproc"))
import tanktread
from tanktread import figures
from tanktread.figures import draw, render, scene, style

render.picture = lambda *_, **__: (numpy.zeros((4, 4, 4)), (0, 1, 0, 1))  # pictures.py tests the rendering of surfaces
MESH = "Surface: {elements per side: 3}"
CAPSULE = f"Membrane: {{law: neo-Hookean, shear modulus: 10}}, {MESH}"
UNITS = "Tanktread:\n  Units: {length: 1 um, time: 1 ms, force: 1 pN}\n"
DUCT = "  Flow: {type: duct, mean velocity: 1, viscosity: 1 mPa s}\n"
TUBE = f"""{UNITS}{DUCT}  Tube: {{section: rectangle, sides: [24, 20], azimuthal elements: 12, axial elements: 8}}
  Particles:
    soft: {{radius: 3, center: [-6, 4, 2], {CAPSULE}}}
    drop: {{radius: 3, center: [6, -5, -2], Membrane: {{law: surface tension, surface tension: 10}}, {MESH}}}
    ball: {{radius: 3, center: [0, 5, -4], motion: free, {MESH}}}
  Quadrature: {{tolerance: 1.0e-2}}
  Time: {{fixed step: 0.2, final time: 0.4}}
  Output: {{interval: 0.2}}
"""
POSTS = f"""{UNITS}  Flow: {{type: quiescent, pressure gradient: [-0.1, 0, 0], viscosity: 1 mPa s}}
  Domain: {{periodic: x1 x2, side lengths: [10, 8, 1]}}
  Wall: {{point: [0, 0, -3], distance: 9, elements per period: 6}}
  Particles:
    post: {{shape: cylinder, axis: x2, radius: 1, center: [12, 0, -1], Surface: {{azimuthal elements: 8, axial elements: 5}}}}
    near: {{radius: 1.5, center: [-3, -2, 1], {CAPSULE}}}
    far: {{radius: 1.5, center: [0, 2, 4], {CAPSULE}}}
  Quadrature: {{tolerance: 1.0e-2}}
  Time: {{fixed step: 0.1, final time: 0.1}}
"""


def _made(name, text):
    run(deck(text, f"{name}.yaml"), "--output", name, "--quiet")
    return tanktread.run(name)


def _alone(more, center, flow="simple shear", time=0.001):
    return (f"Tanktread:\n  Flow: {{type: {flow}}}\n{more}  Particle: {{center: {center}}}\n  Membrane: {{law: neo-Hookean, capillary number: 0.2}}\n"
            f"  {MESH}\n  Quadrature: {{tolerance: 1.0e-2}}\n  Time: {{final time: {time}}}\n")


def _drawn(axis, color):
    """Returns the end points (n, 2) of all line segments of a colour on an axis."""
    pieces = [one for one in axis.collections if hasattr(one, "get_segments") and one.get_colors().tolist() == [list(style.plt.matplotlib.colors.to_rgba(color))]]
    return numpy.concatenate([numpy.concatenate(one.get_segments()) for one in pieces if len(one.get_segments())] or [numpy.zeros((0, 2))])


def _facing_the_fluid(shot, inside):
    """Fails the test unless the normals of all walls point to the side of a point of the fluid."""
    walls = shot.walls
    normal = numpy.cross(walls[:, 0, 1] - walls[:, 0, 0], walls[:, 1, 0] - walls[:, 0, 0])
    check((((inside - walls.mean((1, 2))) * normal).sum(1) > 0).all(), "a wall whose normal points out of the fluid")


def sections_go_through_particles_that_are_off_the_origin():
    pair = (f"Tanktread:\n  Particles:\n    one: {{center: [5, 3, 1], {CAPSULE}}}\n    other: {{center: [8, -3, 2], {CAPSULE}}}\n"
            "  Quadrature: {tolerance: 1.0e-2}\n  Time: {final time: 0.001}\n")
    for name, text, labels, title in (("alone", _alone("", [5, 3, -2]), ("x₁", "x₃"), "section x₂ / R$_C$ = 3"),
                                      ("linear", _alone("", [5, 3, -2], "linear, gradient: [0, 1, 0, 0, 0, 0, 0, 0, 0]"), ("x₁", "x₂"), "section x₃ / R$_C$ = -2"),
                                      ("pair", pair, ("x₁", "x₃"), "section x₂ / R$_C$ = 3")):
        _made(name, text)
        axis = figures.shape(name).axes[1]
        points = _drawn(axis, style.RUNS[0])
        check(len(points) > 100 and axis.get_title(loc="left") == title, name, len(points), axis.get_title(loc="left"))
        check((axis.get_xlabel(), axis.get_ylabel()) == tuple(f"{one} / R$_C$" for one in labels), axis.get_xlabel(), axis.get_ylabel())
        # 24 intervals per side of an element; the elements deviate from the sphere by 2e-3
        middle = (points.max(0) + points.min(0)) / 2
        close(numpy.linalg.norm(points - middle, axis=1).max(), 1, 5e-3, f"{name}: radius of the section through the middle of a sphere")


def the_plane_of_the_flow_is_that_of_the_program():
    number = lambda value: f"{value:.4g}"
    for gradient in ([0, 1, 0, 0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0, 0, -2, 0], [0, 0.6, 0.8, 0, 0, 0, 0, 0, 0], [1, 0.5, 0, 0, 1, 0.3, 0, 0, -2], [1, 0, 0, 0, 1, 0, 0, 0, -2]):
        text = _alone("", [0, 0, 0], f"linear, gradient: {gradient}")
        said = re.search(r"\n  deformation +.*in the plane (.*)\n", run(deck(text), "--check").stdout)[1]
        made = mock.Mock(value=lambda key: {"Flow/type": "linear", "Flow/gradient": gradient}[key])
        axes = scene.flow_plane(made)
        names = [f"x{numpy.argmax(one) + 1}" if 1 in one else f"({', '.join(map(number, one))})" for one in axes[::2]]
        check(said == " ".join(names), said, names)
        close(abs(numpy.cross(axes[2], axes[0]) - axes[1]).max(), 0, 1e-15, "the normal")


def walls_are_drawn_where_they_are_and_face_the_fluid():
    read = _made("wall", _alone("  Wall: {point: [9, 0, -2], normal: [0.6, 0, 0.8]}\n", [12, 3, -1], "quiescent").replace("capillary number", "shear modulus"))
    shot = scene.surrounded(read, read.snapshot_at(None))
    close(abs(shot.walls @ [0.6, 0, 0.8] - (9 * 0.6 - 2 * 0.8)).max(), 0, 1e-12, "distance of the drawn wall from the plane")
    _facing_the_fluid(shot, shot.points.mean(0))
    check(len(_drawn(figures.shape("wall").axes[1], style.INK)), "the section has no wall")
    far = _made("far", _alone("  Wall: {point: [0, 0, -20]}\n", [0, 0, 0]))
    check(len(scene.surrounded(far, far.snapshot_at(None)).walls) == 0, "a wall is drawn ten diameters away")
    read = _made("tube", TUBE)
    shot = scene.surrounded(read, read.snapshot_at(0))
    close(abs(abs(shot.walls[..., 1:]) / [12 / 3, 10 / 3]).max(axis=-1).min(), 1, 1e-3, "R_C: the points are on the sides of the rectangle")
    _facing_the_fluid(shot, shot.walls.mean((0, 1, 2)))
    channel = (f"Tanktread:\n{DUCT.replace(' mPa s', '')}  Channel: {{section: circle, radius: 2, depth: 0.4, half length: 2, azimuthal elements: 8, axial elements: 10}}\n"
               f"  Particle: {{radius: 0.5, center: [-1, 0, 0], motion: free}}\n  {MESH}\n  Quadrature: {{tolerance: 1.0e-2}}\n  Time: {{fixed step: 0.05, final time: 0.05}}\n")
    read = _made("channel", channel)
    shot = scene.surrounded(read, read.snapshot_at(0))
    x, y, z = numpy.moveaxis(shot.walls, -1, 0) * 0.5
    expected = 2 * (1 - 0.2 * (1 + numpy.cos(numpy.pi * numpy.clip(x, -2, 2) / 2)))
    close(abs(numpy.hypot(y, z) - expected).max(), 0, 1e-3, "radius of the constriction at the drawn points")
    check(x.min() < -1.5 and x.max() > -0.5, "the wall is not beside the particle", x.min(), x.max())
    check("channel: use the figure `channel`" in package("figure", "tube", "channel").stderr, "a channel as a tube")


def posts_and_plates_are_drawn_with_particles():
    read = _made("posts", POSTS)
    shot = scene.surrounded(read, read.snapshot_at(None))
    check(shot.particles == ["near", "far"] and len(shot.walls) == 2, shot.particles)
    close(abs(shot.walls[..., 2] * read.radius - [[[-3]], [[6]]]).max(), 0, 1e-12, "heights of the plates")
    _facing_the_fluid(shot, [0, 0, 1 / read.radius])
    # The post at x1 = 12 has its periodic image at x1 = 2 in the cell at the origin.
    x = shot.posts.points * read.radius
    off = numpy.hypot(x[:, 0] - 2, x[:, 2] + 1)
    close(abs(off[abs(x[:, 1]) < 3.99] - 1).max(), 0, 1e-3, "distance of the post's surface from its axis")
    check(off.max() < 1.001 and off.min() < 1e-9 and abs(numpy.ptp(x[:, 1]) - 8) < 1e-12, "the post is closed and as long as the period")
    # Seen along x2, nothing hides the post. Its pixels are grey, which means that they have no value.
    depth, found, corner, size = render.seen(shot, shot.points[:, 0], draw.view_axes(-90, 0), 300)
    right, up = (corner[k] + numpy.arange(depth.shape[k]) / size for k in (0, 1))
    off = numpy.hypot(right[:, None] * read.radius - 2, up * read.radius + 1)
    grey = numpy.isnan(found[..., 0])
    check(grey[off < 0.9].all() and numpy.isinf(depth[(off > 1.1) & (off < 1.3)]).all(), "the picture has no post", grey[off < 0.9].mean())
    axis = figures.shape("posts").axes[1]
    radius = numpy.linalg.norm(_drawn(axis, style.FAINT) * read.radius - [2, -1], axis=1)
    check((abs(radius - 1) < 1e-3).sum() > 50, "the section has no post")
    heights = numpy.unique((_drawn(axis, style.INK)[:, 1] * read.radius).round(9))
    check(heights.tolist() == [-3, 6], "plates in the section", heights)


def a_tube_with_several_particles_and_units_is_drawn_at_several_times():
    _made("tube", TUBE)
    whole = figures.tube("tube")
    titles = [axis.get_title(loc="center") for axis in whole.axes]
    check([one for one in titles if one.startswith("t = ")] == ["t = 0 ms", "t = 0.2 ms", "t = 0.4 ms"], titles)
    along, across = (next(axis for axis in whole.axes if axis.get_title(loc="left").startswith(start)) for start in ("section x₂ / R$_T$", "x₁ = middle"))
    for axis, number in (along, 6), (across, 9):  # the plane through `soft` and `ball` misses `drop`; each is cut across
        pieces = sum(len(one.get_segments()) > 0 for one in axis.collections if hasattr(one, "get_segments"))
        dots = sum(line.get_marker() == "." for line in axis.lines)
        check(number == (dots if axis is along else pieces), axis.get_title(loc="left"), pieces, dots)
    radius = (24 * 20 / numpy.pi) ** 0.5
    starts = {tuple(numpy.round([line.get_xdata()[0] * radius, line.get_ydata()[0] * radius], 2)) for line in figures.tube_motion("tube").axes[0].lines
              if line.get_marker() == "o"}
    check(starts == {(4, 2), (-5, -2), (5, -4)}, "starts of the paths", starts)
    check(sum(line.get_marker() == "o" for line in figures.duct("tube").axes[0].lines) == 3, "paths across the duct")
    film = figures.animation("tube", frame=0.4)
    check("t = 0.4 ms" in film.axes[0].get_title(loc="left"), film.axes[0].get_title(loc="left"))
    check([text.get_text() for text in film.axes[2].get_legend().get_texts()] == ["soft", "drop"], "the particles of the curves of D")


def every_figure_draws_each_scene_or_says_why_it_cannot():
    _made("tube", TUBE), _made("posts", POSTS)
    drawn = {name: set() for name in ("tube", "posts")}
    for name in sorted(set(figures.FIGURES) - {"viscosity", "step", "tweezers", "treading", "recovery", "vesicle", "growth_rates"}):
        for results, done in drawn.items():
            try:
                figures.FIGURES[name](results, **({"frame": 0} if name == "animation" else {}))
                done.add(name)
            except tanktread.Mistake as mistake:
                check(results in str(mistake) or "--curve" in str(mistake), name, mistake)
            style.plt.close("all")
    both = {"animation", "deformation", "meshes", "shape"}
    check(drawn == {"tube": both | {"duct", "tube", "tube_motion"}, "posts": both | {"encounter"}}, drawn)


def a_report_shows_posts_and_walls():
    read = _made("posts", POSTS)
    check(package("report", "posts").returncode == 0, "no report")
    page = pathlib.Path("posts/report.html").read_text()
    content = json.loads(gzip.decompress(base64.b64decode(re.search(r'type="text/plain">([^<]*)<', page)[1])))
    last = content["shapes"]["frames"][-1]
    walls = numpy.frombuffer(base64.b64decode(last["walls"]), "<i2").reshape(-1, 2, 2, 3) / 32767 * content["shapes"]["size"]
    facing = numpy.frombuffer(base64.b64decode(last["facing"]), "i1").reshape(-1, 4, 3) / 127
    plates = walls[:2]
    close(abs(plates[1, ..., 2] - plates[0, ..., 2] - 9).max(), 0, 1e-3, "distance of the plates")  # 16 bits
    check(facing[0, 0].tolist() == [0, 0, 1] and facing[1, 0].tolist() == [0, 0, -1], "their normals", facing[:2, 0])
    post = walls[2:] - plates.mean((0, 1, 2)) - [2, 0, -1 - 1.5]
    close(numpy.hypot(post[..., 0], post[..., 2]).max(), 1, 1e-3, "radius of the post")
    check(len(base64.b64decode(last["lines"])) == 12 * 2 * 3 * 2, "twelve edges of the cell")
    check(last["moment"] == "t = 0.1 ms" and list(content["curves"]["y"])[:2] == ["near/taylor_inertia", "far/taylor_inertia"], last["moment"], list(content["curves"]["y"])[:3])


main()
