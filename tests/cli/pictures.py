#!/usr/bin/python3
# Tests that the figures of the package draw the results of a run, or report in one sentence why they cannot.
import pathlib
import re
import subprocess
import sys
from unittest import mock

import matplotlib.image
import numpy

from harness import PROGRAM, SOURCE, check, close, deck, main, package, run

sys.path.append(str(SOURCE / "postproc"))
import tanktread
from tanktread import figures
from tanktread.figures import draw, register, render, style, surfaces
from tanktread.figures.series import unbroken
from tanktread.interpolation import difference

render.OVERSAMPLING = 1  # renders surfaces in a quarter of the time

DECK = """
Tanktread:
  Flow: { type: simple shear }
  Particle: { shape: sphere }
  Membrane: { law: neo-Hookean, capillary number: 0.3 }
  Surface: { mesh: cube, elements per side: 3 }
  Time: { final time: 0.2 }
  Output: { interval: 0.1 }
"""


def _command(name, *arguments, code=0):
    """Runs a command of the package (default: tanktread-figure). Returns its output."""
    result = package(name, *arguments) if name in ("read", "report") else package("figure", name, *arguments)
    check(result.returncode == code and "Traceback" not in result.stderr, name, result.stdout, result.stderr)
    return result.stdout + result.stderr


def all_figures_of_a_run_are_drawn():
    deck(DECK)
    run("deck.yaml", "--output", "results", "--quiet")
    pathlib.Path("curve.csv").write_text("t,taylor_inertia\n" + "".join(f"{0.05 * k},{0.05 * k}\n" for k in range(5)))
    words = {"convergence": ["--curve", "curve.csv"]}
    for name in "deformation", "shape", "meshes", "refinement", "convergence", "rheology":
        _command(name, "results", *words.get(name, []), "-o", f"{name}.png")
        with open(f"{name}.png", "rb") as file:
            check(file.read(8) == b"\x89PNG\r\n\x1a\n", f"{name}.png is no picture")
    _command("animation", "results", "-o", "animation.gif", "--width", "240")
    with open("animation.gif", "rb") as file:
        check(file.read(6) == b"GIF89a", "animation.gif is no animation")
    check("taylor_inertia" in _command("read", "results"), "tanktread-read does not list the series")
    said = _command("shape", "results", "--field", "colour", code=2)
    check("colour" in said and "load" in said, said)


def nothing_is_cut_off_at_the_edges_of_a_figure():
    tall = DECK.replace("shape: sphere }", "shape: ellipsoid, semi-axes: [0.4, 0.4, 2.0], motion: free }").replace("  Membrane: { law: neo-Hookean, capillary number: 0.3 }\n", "")
    run(deck(tall.replace("final time: 0.2", "final time: 0.001")), "--output", "tall", "--quiet")
    for name in "shape", "meshes":
        _command(name, "tall", "-o", f"{name}.png")
        picture = matplotlib.image.imread(f"{name}.png")[..., :3]
        for edge, pixels in {"left": picture[:, :8], "right": picture[:, -8:], "upper": picture[:8], "lower": picture[-8:]}.items():
            check((pixels == 1).all(), f"something touches the {edge} edge of the picture {name}")


def a_field_that_is_uniform_up_to_rounding_has_one_colour():
    deck("""
Tanktread:
  Flow: { type: quiescent }
  Particles:
    defaults: { motion: free, force: [0.0, 0.0, -1.0], Surface: { elements per side: 4 } }
    left: { center: [-1.5, 0.0, 0.0] }
    right: { center: [1.5, 0.0, 0.0] }
  Time: { final time: 0.01 }
""")
    run("deck.yaml", "--output", "pair", "--quiet")
    shot = tanktread.run("pair").snapshots()[-1]
    traction = numpy.linalg.norm(shot.fields["traction"], axis=1)
    check(0 < numpy.ptp(traction) < 1e-9 * traction.max(), "the traction does not differ by rounding errors only", numpy.ptp(traction))
    norm = surfaces.field_of([shot], "traction")[0]
    close(abs(norm(traction) - 0.5).max(), 0, 1e-6, "difference from the middle of the colour bar")
    for axis in figures.meshes("pair").axes:
        if axis.name == "polar":
            close(max(axis.lines[0].get_ydata()) / axis.get_ylim()[1], 0, 1e-6, "height of the curve of a uniform field")
    for low, high in (1.5, 1.500001), (1.49, 1.51), (0, 2e-7), (-3e7, 3e7):
        with style.plt.rc_context(style.STYLE):
            bar, axis = style.plt.subplots(figsize=(2.4, 1.2))
            surfaces.colour_bar(bar, style.plt.Normalize(low, high), style.FIELD, cax=axis, label="label")
            bar.canvas.draw()
        check(axis.xaxis.get_offset_text().get_text() == "", low, high, axis.xaxis.get_offset_text().get_text())
        ends = [box.get_window_extent() for box in axis.get_xticklabels() if low <= box.get_position()[0] <= high]
        check(all(one.x1 < other.x0 for one, other in zip(ends, ends[1:])), f"ticks between {low} and {high} overlap")
    style.plt.close("all")


def meshes_of_a_snapshot_are_drawn_once():
    deck(DECK.replace("final time: 0.2", "final time: 0.001"))
    run("deck.yaml", "--output", "short", "--quiet", "--set", "Output/interval=1")
    count = len(tanktread.run("short").snapshots())
    for name, times, expected in ("short", None, count), ("short", [0, 0, 0], 1):
        drawn = sum(axis.name == "polar" for axis in figures.meshes(name, times=times).axes)
        check(drawn == expected, f"{drawn} meshes instead of {expected}")


def points_of_a_branch_are_named_by_their_numbers():
    deck(DECK.replace("simple shear", "uniaxial extension").replace("0.3 }", "0.05 }").replace("Time: { final time: 0.2 }\n  Output: { interval: 0.1 }",
                                                                    "Steady: { tolerance: 1.0e-3 }\n  Continuation: { parameter: Membrane/capillary number, to: 0.06, step: 0.01, points: 2 }"))
    run("deck.yaml", "--output", "branch", "--quiet")
    last = len(tanktread.run("branch").time) - 1
    titled = {figures.shape: f"branch, point {last}", figures.meshes: "branch\npoint 0", figures.animation: f"branch, point {last}"}
    for function, title in titled.items():
        axes = function("branch", **({"frame": last} if function is figures.animation else {})).axes
        found = [axis.get_title(loc="left") for axis in axes]
        check(any(one.startswith(title) for one in found), f"no title {title}: {found}")
        labels = [text.get_text() for axis in axes if axis.get_legend() for text in axis.get_legend().get_texts()]
        check(function is not figures.shape or "point 0" in labels, labels)
    style.plt.close("all")


def a_suspension_that_ends_before_the_averages_begin_is_reported():
    deck("""
Tanktread:
  Flow: { type: simple shear }
  Domain: { side lengths: [4.0, 4.0, 4.0] }
  Particles: { capsule: { Membrane: { capillary number: 0.3 }, Surface: { elements per side: 3 } } }
  Time: { final time: 0.1 }
""")
    run("deck.yaml", "--output", "lattice", "--quiet")
    said = _command("suspension", "lattice", "--from", "0.1")
    check("lattice ends at strain 0.1, not after --from 0.1: it has no averages" in said and "nan" not in said, said)
    check([len(axis.lines) for axis in figures.suspension("lattice", from_=0.1).axes] == [1, 3], "a line of an average")
    check("μ_eff/μ = 1." in _command("suspension", "lattice", "--from", "0.05"), "averages")


def a_particle_in_a_periodic_tube_is_cut_only_at_the_ends_of_the_period():
    run(deck("""Tanktread:
  Flow: {type: duct}
  Tube: {section: circle, periodic length: 3.0, azimuthal elements: 10}
  Particle: {radius: 0.7}
  Membrane: {law: neo-Hookean, capillary number: 0.1}
  Surface: {elements per side: 3}
  Time: {final time: 0.01}
"""), "--output", "train", "--quiet")
    read = tanktread.run("train")
    shot = read.snapshot_at(None).scaled(read)
    share = numpy.abs(shot.positions @ numpy.linalg.inv(shot.cell)).max(axis=0)
    close(numpy.linalg.norm(shot.cell[0]), 3 / 0.7, 1e-9, "the period along x1")
    check((share[1:] < 0.5).all() and (share[1:] > 0.45).all(), share, "the cell across the tube contains the particle closely")


def options_are_converted_to_the_type_of_their_choices():
    """An option with a few allowed numbers is read as a number. An option that is on by default can be switched off."""
    of = lambda name, *words: register.parser_of(name).parse_args(["results", *words])
    check(of("channel", "--across", "3").across == 3, "the section across a channel")
    check(of("work").parts and not of("work", "--no-parts").parts, "the parts of the error")


def the_axis_of_time_is_dimensionless_as_its_label_says():
    deck(DECK.replace("simple shear", "simple shear, shear rate: 500").replace("final time: 0.2", "final time: 0.0004").replace("interval: 0.1", "interval: 0.0002"))
    run("deck.yaml", "--output", "fast", "--quiet")
    close(tanktread.run("fast").time[-1], 0.2, 1e-12, "time times rate at the end")
    for function in figures.deformation, figures.refinement:
        lowest = function("fast").axes[-1]
        check(lowest.get_xlabel() == "time · shear rate", function.__name__, lowest.get_xlabel())
        close(lowest.lines[0].get_xdata()[-1], 0.2, 1e-12, f"end of the curve of {function.__name__}")


def inclination_is_drawn_only_if_the_flow_has_no_axis_of_symmetry():
    for name, flow in ("shear", "simple shear"), ("extension", "uniaxial extension"):
        run(deck(DECK.replace("simple shear", flow)), "--output", name, "--quiet")
    labels = [[axes.get_ylabel() for axes in figures.deformation(runs).axes] for runs in ("shear", "extension", ["shear", "extension"])]
    both = ["Taylor parameter D", "inclination, degrees"]
    check(labels == [both, both[:1], both], labels)


def figures_are_dimensionless():
    run(deck(DECK), "--output", "plain", "--quiet")
    micrometres = DECK.replace("simple shear", "simple shear, shear rate: 40, viscosity: 2.0e-2").replace("sphere", "sphere, radius: 3.0e-6")
    run(deck(micrometres.replace("final time: 0.2", "final time: 5.0e-3").replace("interval: 0.1", "interval: 2.5e-3")), "--output", "si", "--quiet")
    plain, si = (tanktread.run(name) for name in ("plain", "si"))
    for field in "traction", "load", "displacement", "velocity", "smallest tension", "mean curvature":
        one, other = (run.snapshots()[-1].scaled(run).fields[field] for run in (plain, si))
        close(abs(one - other).max() / abs(one).max(), 0, 1e-4, field)
        check(plain.label(field) == si.label(field) != field, plain.label(field))
    for function in figures.shape, figures.animation, figures.meshes:
        one, other = (function(name, **({"frame": 0} if function is figures.animation else {})).axes for name in ("plain", "si"))
        for this, that in zip(one, other):
            for limits in "get_xlim", "get_ylim":
                a, b = numpy.array(getattr(this, limits)()), numpy.array(getattr(that, limits)())
                check(abs(a - b).max() <= 1e-3 * numpy.ptp(a), function.__name__, a, b)
            check(this.get_xlabel() == that.get_xlabel() and this.get_ylabel() == that.get_ylabel(), function.__name__, this.get_xlabel(), that.get_xlabel())
    quiet = "Tanktread:\n  Flow: {type: quiescent, viscosity: 3}\n  Particle: {%s}\n%s  Surface: {elements per side: 4}\n  Time: {final time: 0.01}\n"
    for name, text, label in (("drop", quiet % ("radius: 2", "  Membrane: {law: surface tension, surface tension: 5}\n"), "traction / (σ / R$_C$)"),
                              ("body", quiet % ("radius: 2, motion: prescribed, velocity: [7, 0, 0]", ""), "traction / (μ · speed / R$_C$)")):
        run(deck(text), "--output", name, "--quiet")
        found = tanktread.run(name)
        close(found.snapshots()[0].volume(), 32 * numpy.pi / 3, 0.05, "volume")
        check(found.label("traction") == label, found.label("traction"))
        traction = numpy.linalg.norm(found.snapshots()[0].scaled(found).fields["traction"], axis=1)
        # exact tractions: 2 sigma/R (drop), 3 mu U/(2 R) (rigid sphere)
        close(traction.mean(), {"drop": 2, "body": 1.5}[name], 0.02, name)


def hidden_surfaces_are_hidden_and_colours_agree_with_the_colour_bar():
    deck(DECK.replace("shape: sphere", "shape: red cell").replace("final time: 0.2", "final time: 0.001"))
    run("deck.yaml", "--output", "cell", "--quiet")
    shot = tanktread.run("cell").snapshot_at(0)
    view = draw.view_axes(-85, 15)  # in this view, the rim of the cell hides a part of its dimple
    depth, found, corner, size = render.seen(shot, shot.points @ view[2], view, 100)
    hit = numpy.isfinite(depth)
    check(abs(found[hit][:, 0] * size - depth[hit]).max() < 1e-3, "a value that is not of the place that is seen")
    x = shot.sampled(shot.points, 40).reshape(-1, 3) @ view.T
    column, row = ((x[:, :2] - corner) * size).astype(int).T
    # largest change of depth within one pixel, in pixels, where the cosine of normal and line of sight exceeds 0.3
    slope = 3
    facing = (shot.sampled(shot.fields["Normals"], 40).reshape(-1, 3) @ view.T)[:, 2] > 0.3
    hidden = depth[column, row] - x[:, 2] * size
    check(hidden[facing].min() > -2 * slope, "a pixel shows what lies behind", hidden[facing].min())
    check((hidden[facing] > 10).any(), "nothing is hidden: the test shows nothing")
    image, _ = render.picture(shot, shot.points[:, 0], view, lambda values: numpy.tile([0.2, 0.4, 0.6, 1.0], (len(values), 1)), 100)
    solid = image[image[..., 3] == 1][:, :3]
    check((abs(solid - [0.2, 0.4, 0.6]).max(axis=1) < render.RIM * 0.6).mean() > 0.75, "most of the surface has other colours than the bar")


def an_angle_that_jumps_is_not_drawn_as_a_vertical_line():
    t, angle = unbroken(numpy.arange(4.0), numpy.array([-80.0, -89.0, 88.0, 80.0]))
    check(numpy.isnan(angle[2]) and numpy.isnan(t[2]) and len(angle) == 5, angle)


def rows_where_a_series_is_undefined_are_left_out():
    t, angle = numpy.linspace(0, 1, 21), numpy.linspace(45, 25, 21)
    close(difference(t, numpy.where(t < 0.1, numpy.nan, angle), t, angle), 0, 1e-9, "a difference")
    check(difference(t, numpy.nan * t, t, angle) == 0, "nothing to compare")
    deck(DECK.replace("shape: sphere }", "shape: sphere, motion: free }").replace("  Membrane: { law: neo-Hookean, capillary number: 0.3 }\n", ""))
    run("deck.yaml", "--output", "sphere", "--quiet")
    check("NaN if" in _command("read", "sphere"), "the description says when there is no inclination")
    _command("animation", "sphere", "-o", "sphere.gif", "--width", "240")
    _command("report", "sphere")
    deck(DECK)
    run("deck.yaml", "--output", "capsule", "--quiet")
    _command("shape", "capsule", "--time", "0")
    _command("deformation", "capsule")


def a_deck_is_run_when_it_has_no_results():
    deck(DECK)
    with mock.patch.object(tanktread.runs, "PROGRAM", PROGRAM):
        check(tanktread.run("deck.yaml").directory == pathlib.Path("results/deck"), "another place")
        before = pathlib.Path("results/deck/run.h5").stat().st_mtime_ns
        tanktread.run("deck.yaml")
        check(pathlib.Path("results/deck/run.h5").stat().st_mtime_ns == before, "a run that is there is made again")


def a_python_without_numpy_gets_a_message_which_python_to_use():
    for script in "postproc/tanktread-figure", "postproc/tanktread-read", "tests/benchmark/atlas.py":
        result = subprocess.run(["/usr/bin/python3", "-S", SOURCE / script, "nowhere"], capture_output=True, text=True)
        check(result.returncode == 1 and "/usr/bin/python3" in result.stderr and result.stderr.count("\n") == 1, result.stderr)


def a_rigid_particle_is_drawn_and_missing_series_are_named():
    deck(DECK.replace("sphere }", "spheroid, semi-axes: [1.0, 1.0, 0.5], motion: free }").replace("  Membrane: { law: neo-Hookean, capillary number: 0.3 }\n", ""))
    run("deck.yaml", "--output", "rigid", "--quiet")
    _command("shape", "rigid")
    _command("animation", "rigid", "-o", "rigid.gif", "--width", "240")
    check("[η] = 2." in _command("rheology", "rigid"), "a spheroid's intrinsic viscosity is not between 2 and 3")
    for name in "deformation", "refinement":
        said = _command(name, "rigid", code=2)
        check("no series taylor_inertia" in said and said.count("\n") == 1, said)


def several_particles_are_drawn_and_read_by_name():
    deck("""
Tanktread:
  Flow: { type: simple shear }
  Particles:
    defaults: { Membrane: { capillary number: 0.3 }, Surface: { elements per side: 3 } }
    upper: { center: [-1.5, 0.0, 0.5] }
    lower: { center: [1.5, 0.0, -0.5] }
  Time: { final time: 0.2 }
""")
    run("deck.yaml", "--output", "pair", "--quiet")
    check("smallest gap 1." in _command("encounter", "pair"), "the gap of the pair")
    check("upper/taylor_inertia" in _command("read", "pair"), "the series of a particle")
    _command("shape", "pair")
    upper, lower = next(axis for axis in figures.meshes("pair", times=[0.2]).axes if axis.name == "polar").lines
    check([upper.get_label(), lower.get_label()] == ["upper", "lower"], "a curve for each particle")
    (angle, variation), (other_angle, other) = upper.get_data(), lower.get_data()  # equal after half a turn
    turned = numpy.interp(angle, other_angle + numpy.pi, other, period=2 * numpy.pi)
    # A section through nodes has more points, or fewer, by rounding: where the curve jumps from element to element, interpolation between them differs.
    close(numpy.quantile(abs(variation - turned), 0.9) / variation.max(), 0, 1e-9, "difference of two equal particles")
    close(abs(variation - turned).max(), 0, abs(numpy.diff(other)).max(), "difference of two equal particles where they jump")
    check("two particles" in _command("encounter", _alone(), code=2), "an encounter of one")


def one_of_several_particles_is_drawn():
    deck("""
Tanktread:
  Flow: { type: simple shear }
  Particles: { only: { Membrane: { capillary number: 0.3 }, Surface: { elements per side: 3 } } }
  Time: { final time: 0.01 }
""")
    run("deck.yaml", "--output", "one", "--quiet")
    check(any("56 control points" in axis.get_title(loc="left") for axis in figures.meshes("one", times=[0]).axes), "the title of a mesh")
    check([axis.get_ylabel() for axis in figures.animation("one", frame=0).axes[2:]] == ["D", "control points"], "panels of an animation")


def posts_are_drawn_and_are_no_particles():
    cell = ("Tanktread:\n  Flow: {type: quiescent, pressure gradient: [-1, 0, 0]}\n  Domain: {periodic: x1 x2 x3, side lengths: [4, 4, 1]}\n"
            "  Time: {fixed step: 0.01, final time: 0.01}\n  Quadrature: {tolerance: 1e-2}\n")
    post, mesh = "shape: cylinder, axis: x3, radius: 0.5, center: [1, 1, 0]", "Surface: {azimuthal elements: 8, axial elements: 4}"
    ball = "{radius: 0.3, center: [-1, 0, 0], Membrane: {law: neo-Hookean, shear modulus: 1}, Surface: {elements per side: 3}}"
    scenes = {"one": f"  Particle: {{{post}}}\n  {mesh}\n", "with": f"  Particles:\n    post: {{{post}, {mesh}}}\n    ball: {ball}\n"}
    for name, particles in scenes.items():
        run(deck(cell + particles), "--output", name, "--quiet")
        _command("shape", name, "-o", f"{name}.png")
        _command("report", name, "-o", f"{name}.html")
    alone, both = (tanktread.run(name) for name in scenes)
    check(alone.particles == [] and both.particles == ["ball"], "particles", alone.particles, both.particles)
    check(alone.radius == 0.5, "R_C of the post", alone.radius)
    close(both.radius, 0.3, 1e-6, "R_C of the ball")
    check("no particles, only posts" in _command("meshes", "one", code=2), "no reason is given")
    check(not numpy.isnan(both.frame(tidy=True).query("particle == 'post'")["post_force_x1"]).any(), "the force on the post is missing")


def _alone():
    deck(DECK, "alone.yaml")
    run("alone.yaml", "--output", "alone", "--quiet")
    return "alone"


def the_manual_names_every_figure_and_all_files_it_names_exist():
    text = (SOURCE / "README.md").read_text() + (SOURCE / "inputs/manual/figures.md").read_text()
    named = set(re.findall(r"tanktread-figure ([\w-]+)", text))
    drawn = {name.replace("_", "-") for name in figures.FIGURES}
    check(drawn <= named, "figures that neither README.md nor inputs/manual/figures.md names:", drawn - named)
    for path in re.findall(r"\b(?:postproc|inputs|tests|app)/[\w./]*\w\.\w+", text):
        check((SOURCE / path).exists(), f"a document names {path}, which is not there")


def a_vesicle_is_compared_with_an_axisymmetric_shape_and_other_particles_are_rejected():
    vesicle = DECK.replace("simple shear", "quiescent").replace("law: neo-Hookean, capillary number: 0.3",
                                                                "law: surface tension, surface tension: 1, bending modulus: 1, bending reference: flat")
    deck(vesicle, "vesicle.yaml")
    said = _command("vesicle", "vesicle.yaml", "-o", "vesicle.png")
    check("relative error" in said and pathlib.Path("vesicle.png").exists(), said)
    check("relative error" in _command("vesicle", "results/vesicle", "-o", "again.png"), "of the directory of a run")
    deck(vesicle.replace("shape: sphere", "shape: ellipsoid, semi-axes: [1.3, 1.0, 1.0]"), "along_x1.yaml")
    deck(DECK, "capsule.yaml")
    for path, words in (("along_x1.yaml", "not axisymmetric about x3"), ("capsule.yaml", "the law `surface tension`"), ("nowhere.yaml", "no such deck")):
        said = _command("vesicle", path, code=2)
        check(words in said.splitlines()[-1], said)


def impossible_figures_are_rejected_in_one_sentence():
    name, folder = _alone(), pathlib.Path("not_a_folder")
    folder.write_text("")
    pathlib.Path("curve.csv").write_text("nothing\nof,a,table\n")
    for script, words, code, said in (("shape", ["-o", "not_a_folder/shape.png"], 2, "cannot be written"), ("shape", ["-o", "shape.doc"], 2, "ends in"),
                                      ("animation", ["--width", "0"], 2, "--width must be"), ("convergence", ["--curve", "curve.csv"], 2, "no row of numbers"),
                                      ("convergence", ["--curve", "none.csv"], 2, "no file none.csv"), ("plane-wall", [], 2, "no plane Wall"),
                                      ("suspension", [], 2, "no Domain"), ("branch", [], 2, "no Continuation")):
        heard = _command(script, name, *words, code=code)
        check(said in heard.splitlines()[-1], script, heard)
    _command("shape", name, "-o", "new/folder/shape")
    check(pathlib.Path("new/folder/shape.png").exists(), "a folder is made, and a name without ending is of a PNG")


def help_is_printed_and_missing_results_are_named():
    for name in "deformation", "shape.py", "read", "animation", "growth", "work-precision", "tweezers":
        check("usage" in _command(name, "--help"), name)
        said = _command(name, "nowhere", code=2)
        check("nowhere" in said and said.count("\n") == 1, said)


main()
