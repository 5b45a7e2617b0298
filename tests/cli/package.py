#!/usr/bin/python3
# ranks: 2
# Tests of the Python package: installation, exact surfaces, conversion for pandas, xarray, meshio and VTK, and all
# figures.
import importlib.util
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import warnings
from unittest import mock

import h5py
import numpy
import yaml

from harness import PROGRAM, SOURCE, check, close, deck, main, run

os.environ["TANKTREAD"] = str(PROGRAM)
sys.path.append(str(SOURCE / "postproc"))
import tanktread
from tanktread import figures
from tanktread.figures import red_cells, style
from tanktread.lagrange import node_order

CAPSULE = """
Tanktread:
  Flow: { type: simple shear }
  Particle: { shape: sphere }
  Membrane: { law: neo-Hookean, capillary number: 0.3 }
  Surface: { elements per side: 3 }
  Time: { final time: 0.2 }
  Output: { interval: 0.1 }
"""
PAIR = """
Tanktread:
  Flow: { type: simple shear }
  Particles:
    defaults: { Membrane: { capillary number: 0.3 }, Surface: { elements per side: 3 } }
    upper: { center: [-1.5, 0.0, 0.5] }
    lower: { center: [1.5, 0.0, -0.5] }
  Time: { final time: 0.1 }
  Output: { interval: 0.05 }
"""
MIXED = """
Tanktread:
  Flow: { type: simple shear }
  Particles:
    defaults: { Surface: { elements per side: 3 } }
    drop: { Membrane: { law: surface tension, capillary number: 0.1 }, Interface: { surfactant: { elasticity number: 0.3, diffusivity: 0.1 } } }
    ball: { motion: free, radius: 0.5, center: [2.5, 0.0, 0.0] }
  Quadrature: { tolerance: 0.01 }
  Time: { scheme: bs3, fixed step: 0.01, final time: 0.01 }
"""
TUBE = """
Tanktread:
  Flow: { type: duct }
  Tube: { section: circle, radius: 1.0, length: 4.4, azimuthal elements: 8, axial elements: 6 }
  Particle: { shape: sphere, radius: 0.4 }
  Membrane: { law: neo-Hookean, capillary number: 0.1 }
  Surface: { elements per side: 3 }
  Quadrature: { tolerance: 1.0e-3 }
  Time: { scheme: bs3, fixed step: 0.01, final time: 0.02 }
  Output: { interval: 0.01 }
"""
CHANNEL = TUBE.replace("radius: 0.4 }", "radius: 0.5, center: [-0.6, 0, 0] }").replace("Tube: { section: circle, radius: 1.0, length: 4.4, azimuthal elements: 8, axial elements: 6 }",
                       "Channel: { section: circle, radius: 1.0, profile: constriction, depth: 0.6, half length: 1.0, azimuthal elements: 12, axial elements: 24 }")


figures.render.OVERSAMPLING = 1  # renders surfaces in a quarter of the time


def _run(name, text):
    run(deck(text, f"{name}.yaml"), "--output", name, "--quiet")
    return tanktread.run(name)


def _has(*packages):
    """Returns True if the optional packages are installed; otherwise prints which one is missing."""
    missing = [name for name in packages if importlib.util.find_spec(name) is None]
    if missing:
        print(f"skipped a part: python3-{missing[0]} is not installed")
    return not missing


def _done(*words, **more):
    result = subprocess.run([str(word) for word in words], capture_output=True, text=True, **more)
    check(result.returncode == 0, words, result.stdout, result.stderr)
    return result.stdout


def a_virtual_environment_imports_the_package_from_another_folder():
    if not _has("ensurepip", "setuptools"):
        return
    shutil.copytree(SOURCE / "postproc", "postproc", symlinks=True, ignore=shutil.ignore_patterns("gallery", "__pycache__"))
    _done("/usr/bin/python3", "-m", "venv", "--system-site-packages", "V")
    _done("V/bin/pip", "install", "--no-build-isolation", "--no-deps", "./postproc")
    there = _done(pathlib.Path.cwd() / "V/bin/python", "-c",
                  "import tanktread; print(tanktread.__file__)", cwd="/")
    check(str(pathlib.Path.cwd() / "V/lib") in there, there)
    version = re.search(r"VERSION ([\d.]+)", (SOURCE / "CMakeLists.txt").read_text().split("project(")[1])[1]
    check(tanktread.__version__ == version, tanktread.__version__, version)
    check("deformation" in _done(pathlib.Path.cwd() / "V/bin/tanktread-figure", "--list", cwd="/"), "the commands")


def positions_are_exact_at_nodes_and_on_a_sphere():
    errors = []
    for n in 3, 6:
        shot = _run(f"sphere{n}", CAPSULE.replace("per side: 3", f"per side: {n}").replace("final time: 0.2", "final time: 1.0e-3")).snapshots()[0]
        for cell in range(0, len(shot.cells), 7):
            p = round(len(shot.cells[cell]) ** 0.5) - 1
            i, j = numpy.array(node_order(p)).T
            at = shot.evaluate(shot.points, numpy.full(len(i), cell), i / p, j / p)
            close(abs(at - shot.points[shot.cells[cell]]).max(), 0, 1e-13, "distance from a stored node")
        generator = numpy.random.default_rng(1)
        cells = generator.integers(len(shot.cells), size=2000)
        x = shot.evaluate(shot.points, cells, *generator.random((2, 2000)))
        errors.append(abs(numpy.linalg.norm(x, axis=1) - 1).max())
    # expected order: at least three, because of the eight extraordinary points
    check(errors[1] < errors[0] / 8, "not of order three or more", errors)
    close(errors[1], 0, 2e-3, "distance from the sphere")


def particles_have_names_and_series_whether_one_or_several():
    one, two, tube = _run("one", CAPSULE), _run("two", PAIR), _run("tube", TUBE)
    check(one.particles == ["particle"] == tube.particles and two.particles == ["upper", "lower"], one.particles, two.particles)
    check(one.of("particle", "volume") is one.series["volume"] and two.of("lower", "volume") is two.series["lower/volume"], "a series")
    for word in {name.partition("/")[2] for found in (two, _run("mixed", MIXED)) for name in found.series if "/" in name}:
        check(tanktread.results.OF_PARTICLE.fullmatch(word), f"OF_PARTICLE lacks {word}")
    last = two.snapshots()[-1]
    for name in two.particles:
        nodes = numpy.unique(numpy.concatenate([last.cells[k] for k in last.cells_of(name)]))
        close(last.points[nodes, 0].mean(), two.of(name, "centroid_x1")[-1], 0.02, "middle of the nodes")
    close(last.area(), sum(two.of(name, "area")[-1] for name in two.particles), 1e-9, "area")
    check(len(one.snapshots()[0].cells_of("particle")) == len(one.snapshots()[0].cells), "cells of the one")
    try:
        one.snapshots()[0].cells_of("nobody")
        check(False, "a particle that is not there")
    except tanktread.mistakes.Mistake as mistake:
        check("no particle nobody" in str(mistake), mistake)


def series_are_converted_to_pandas_and_xarray_with_units():
    runs = [_run("one", CAPSULE), _run("two", PAIR), _run("tube", TUBE), _run("lattice", PAIR + "  Domain: { lattice vectors: [6, 0, 0, 0, 4, 0, 0, 0, 4] }\n")]
    for found in runs:
        if _has("pandas"):
            frame, tidy = found.frame(), found.frame(tidy=True)
            check(set(frame.columns) | {"time"} == set(found.series) and frame.index.name == "time", frame)
            check(frame.attrs["units"] == found.units, "units")
            check(len(tidy) == len(found.particles) * len(frame) and set(tidy["particle"]) == set(found.particles), tidy)
        if _has("xarray"):
            data = found.dataset()
            check(data["volume"].dims == ("particle", "time") and list(data["particle"].values) == found.particles, data)
            check(data["volume"].units == "length^3" and "volume" in data["volume"].long_name, data["volume"].attrs)
            last = data["volume"].sel(particle=found.particles[-1]).values
            check((last == found.of(found.particles[-1], "volume")).all(), "values")
            check(data["wall_seconds"].dims == ("time",), data["wall_seconds"])
    check("scene_energy" in runs[1].dataset() if _has("xarray") else True, "the energy of the scene")


def a_mesh_is_written_and_read_back_with_its_area():
    for found in _run("one", CAPSULE), _run("two", PAIR):
        shot = found.snapshots()[-1]
        area = sum(found.of(name, "area")[-1] for name in found.particles)
        if _has("meshio"):
            import meshio

            shot.mesh().write("mesh.vtu")
            back = meshio.read("mesh.vtu")
            shot._content = back.points, [nodes for block in back.cells for nodes in block.data], back.point_data
            close(shot.area() / area, 1, 1e-6, "area of the mesh that was read back")
            check(back.point_data["traction"].shape == back.points.shape, "a field")
        if _has("vtkmodules"):
            grid = found.snapshots()[-1].mesh("vtk")
            check(grid.GetNumberOfCells() == len(shot.cells) and grid.GetCellType(0) == 70, "Lagrange quadrilaterals")
            from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter
            from vtkmodules.vtkFiltersCore import vtkMassProperties, vtkTriangleFilter

            surface, triangles, mass = vtkDataSetSurfaceFilter(), vtkTriangleFilter(), vtkMassProperties()
            surface.SetInputData(grid)
            surface.SetNonlinearSubdivisionLevel(4)
            triangles.SetInputConnection(surface.GetOutputPort())
            mass.SetInputConnection(triangles.GetOutputPort())
            close(mass.GetSurfaceArea() / area, 1, 2e-3, "area by 2^4 facets along a cell")


def _made_up(name, sections, series, time=None):
    """Writes a record with the given series only, for figures that would need long runs."""
    pathlib.Path(name).mkdir()
    time = numpy.linspace(0, 10, 201) if time is None else time
    with h5py.File(f"{name}/run.h5", "w") as file:
        for key, values in ({"time": time, "n_control_points": 98 + 0 * time} | series).items():
            file[f"series/{key}"] = values
            file[f"series/{key}"].attrs.update({"unit": "1", "description": key})
        file["deck"] = yaml.safe_dump({"Tanktread": sections})
        file.create_group("provenance")
    pathlib.Path(name, "summary.yaml").write_text("{numbers: {radius: 1.0}, status: done}")
    return name


def _all_figures():
    """Yields each figure with its runs, its options, and the replacements of its long runs."""
    pathlib.Path("curve.csv").write_text("t,taylor_inertia\n" + "".join(f"{0.05 * k},{0.05 * k}\n" for k in range(5)))
    _run("one", CAPSULE), _run("two", PAIR), _run("tube", TUBE), _run("channel", CHANNEL)
    _run("wall", CAPSULE.replace("shape: sphere", "shape: sphere, center: [0, 0, 1.5]") + "  Wall: { point: [0, 0, 0], normal: [0, 0, 1] }\n")
    _run("lattice", PAIR + "  Domain: { lattice vectors: [6, 0, 0, 0, 4, 0, 0, 0, 4] }\n")
    _run("vesicle", CAPSULE.replace("simple shear", "quiescent").replace("law: neo-Hookean, capillary number: 0.3", "law: surface tension, "
         "surface tension: 1, bending modulus: 1, bending reference: flat"))
    p = numpy.linspace(0.1, 0.2, 5)
    points = {"parameter": p, "second_parameter": 1 + p, "taylor_surface": p, "fold": (numpy.arange(5) == 3) * 1.0, "leading_rate": p - 0.15,
              "unstable_modes": (p > 0.15) * 1.0}
    _made_up("points", {"Continuation": {"parameter": "Membrane/capillary number", "second parameter": "Particle/viscosity ratio"},
                        "Membrane": {"capillary number": 0.1}}, points, p)
    t = numpy.linspace(0, 40, 801)
    turns = {name: 1 + 0.01 * numpy.sin(t) for name in ("area", "volume_error", "energy", "taylor_inertia", "inclination")} | {"phase": 180 * t}
    _made_up("turns", {"Flow": {"type": "simple shear"}}, turns | {f"length_x{k}": 2 - 0.02 * t * (k == 1) for k in (1, 2)}, t)
    for name in "deformation", "shape", "meshes", "refinement", "rheology":
        yield name, ["one"], {}
    _run("covered", CAPSULE.replace("law: neo-Hookean, capillary number: 0.3", "law: surface tension, capillary number: 0.3") + "  Interface: { surfactant: { elasticity number: 0.2 } }\n")
    yield "surfactant", ["covered"], {}
    run(deck(CAPSULE, "ladder.yaml"), "--accuracy", "taylor_inertia=50%", "--set", "Accuracy/levels=3", "--output", "ladder", "--quiet")
    yield "work", "ladder", {}
    yield from (("convergence", ["one"], {"curve": "curve.csv"}), ("animation", "one", {"frame": 0}), ("encounter", ["two"], {}),
                ("duct", ["tube"], {}), ("tube", ["tube"], {}), ("tube_motion", ["tube"], {}), ("channel", "channel", {}), ("plane_wall", ["wall"], {}),
                ("suspension", ["lattice"], {"from_": 0.01, "blocks": 2}), ("vesicle", "vesicle", {}), ("branch", ["points"], {}), ("folds", ["points"], {}),
                ("drift", "turns", {}), ("stuck", ["channel"], {"elements": 40}))


# figures that make many runs; they are tested below
ELSEWHERE = {"growth_rates", "step", "viscosity", "tweezers", "treading", "recovery"}


def every_figure_is_drawn_and_accepts_axes():
    made = list(_all_figures())
    check({name for name, *_ in made} | ELSEWHERE == set(figures.FIGURES), "figures without a test", set(figures.FIGURES) - {name for name, *_ in made})
    for name, given, options in made:
        figure = figures.FIGURES[name](given, **options)
        style.save(figure, f"{name}.png")
        check(pathlib.Path(f"{name}.png").read_bytes()[:4] == b"\x89PNG" and figure.axes, name)
        if name == "vesicle":  # seconds
            continue
        host = style.plt.figure(figsize=(12, 9))
        check(figures.FIGURES[name](given, host, **options) is host and len(host.axes) == len(figure.axes), name, "in a given figure")
        style.plt.close("all")
    figure, axes = style.plt.subplots(2, 1)
    check(figures.deformation("one", axes) is figure and axes[0].lines, "in given axes")


def a_run_with_one_row_is_drawn_as_dots():
    _run("steady", CAPSULE.replace("simple shear", "uniaxial extension").replace("number: 0.3", "number: 0.05") + "  Steady: {}\n")
    for name in "deformation", "refinement":
        lines = [line for axis in figures.FIGURES[name]("steady").axes for line in axis.lines if len(line.get_xdata())]
        check(lines and all(line.get_marker() == "o" for line in lines), name)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        figures.animation("steady", frame=0)


def _mistake(function):
    """Returns the sentence of the Mistake that a function raises."""
    try:
        function()
    except tanktread.Mistake as mistake:
        return str(mistake)
    raise AssertionError("no Mistake")


def settings_may_be_arrays_of_numpy():
    path, axes = deck(CAPSULE), [1.0, 1.0, 0.8]
    found = [tanktread.run(path, {"Particle/shape": "spheroid", "Particle/semi-axes": one, "Surface/elements per side": three}).directory
             for one, three in ((numpy.array(axes), numpy.array(3)), (tuple(axes), numpy.int64(3)), (axes, 3), ([*map(numpy.float64, axes)], 3))]
    check(len(set(found)) == 1 and tanktread.run(found[0]).value("Particle/semi-axes") == axes, found)
    check(tanktread.text_of(numpy.array([[True, False]])[0, 0]) == "true" and tanktread.text_of(numpy.float64(0.1)) == "0.1", "a logical value and a number")
    check("Particle/semi-axes" in _mistake(lambda: tanktread.run(path, {"Particle/semi-axes": numpy.eye(3)})), "a matrix")


def wrong_arguments_of_the_package_are_reported_in_one_sentence():
    from tanktread.studies import fit, sweep
    deck("deck: deck.yaml\nrecord: [area]\n", "study.yaml")
    for jobs in 0, -1, 1.5, "2", None:
        check(_mistake(lambda: tanktread.Study(jobs=jobs)) == f"jobs must be a whole number above 0, but is {jobs}", jobs)
    for study in sweep, fit:
        check("jobs must be a whole number above 0, but is 0" in _mistake(lambda: study.run("study.yaml", jobs=0)), "of a study")
    check(tanktread.Study(jobs=numpy.int64(2)).jobs == 2, "a number of numpy")
    for name, draw in figures.FIGURES.items():
        check(name in _mistake(lambda: draw([])), name)
    check(_mistake(lambda: figures.shape([])) == "the figure `shape` needs at least one run, but is given an empty list", "no runs")
    check(_mistake(lambda: figures.animation(["one", "two"])) == "the figure `animation` needs one run, but is given a list", "several runs")


def the_processor_time_of_a_resumed_run_includes_its_earlier_parts():
    """The first part is given a processor time of 1000 s in its record. The last part follows a part without a record,
    as a study that is killed leaves it."""
    path = deck(CAPSULE.replace("per side: 3", "per side: 6").replace("final time: 0.2", "scheme: bs3, final time: 1000"))

    def part():
        return tanktread.Study(directory="runs").run(path, {"Output/wall-clock limit": 0.3})

    note = part().directory / "outcome.json"
    note.write_text(json.dumps(json.loads(note.read_text()) | {"processor_seconds": 1000.0, "seconds": 2000.0}))
    resumed = part()
    check("--resume" in resumed.command and 1000 < resumed.processor_seconds < 1100 and 2000 < resumed.seconds < 2100, resumed.processor_seconds, resumed.seconds)
    before = resumed.series["wall_seconds"][-1]
    note.unlink()
    resumed = part()
    check("--resume" in resumed.command and before < resumed.processor_seconds < 100, resumed.processor_seconds, before)


def the_name_of_a_run_is_found_by_reading_each_deck_once():
    paths, read, opened = [deck(CAPSULE), deck("Tanktread: { Time: { final time: 0.1 } }\n", "other.yaml")], [], pathlib.Path.read_bytes
    with mock.patch.object(pathlib.Path, "read_bytes", lambda path, **more: read.append(path.name) or opened(path, **more)):
        first = tanktread.Study.name(paths, {})
    check(read == ["deck.yaml", "other.yaml"], read)
    deck("Tanktread: { Time: { final time: 0.2 } }\n", "other.yaml")
    check(tanktread.Study.name(paths, {}) != first, "a deck with another content")
    deck("Tanktread: [", "other.yaml")
    check(tanktread.Study.name(paths, {}).startswith("other_"), "a deck that is not YAML")


def the_command_below_a_chart_is_relative_to_the_source_directory():
    from tanktread.studies import common
    said = common.command_of(SOURCE / "tests/benchmark/atlas.py", "--map", "fixed step")
    check(said == "tests/benchmark/atlas.py --map 'fixed step'" and (SOURCE / said.split()[0]).is_file(), said)


def figures_of_experiments_are_drawn_from_their_runs():
    _made_up("turn", {"Membrane": {"law": "Skalak"}}, {"phase": 3600 * numpy.linspace(0, 1, 201), "inclination": numpy.full(201, 12.0)})
    t = numpy.linspace(0, 1, 201)
    _made_up("free", {"Membrane": {"law": "Skalak"}}, {"length_x1": 2.1 - t, "length_x2": 1 + 0 * t}, t)
    one = _run("one", CAPSULE)
    for name, given in ("treading", tanktread.run("turn")), ("recovery", tanktread.run("free")), ("tweezers", one):
        with mock.patch.object(red_cells, "run_of", lambda *_: given):
            style.save(figures.FIGURES[name](), f"{name}.png")
    check(pathlib.Path("tweezers.png").exists(), "tweezers")


def the_list_of_figures_contains_each_figure_with_its_caption():
    words = " ".join(_done(SOURCE / "postproc/tanktread-figure", "--list").split())
    for name, function in figures.FIGURES.items():
        check(f"{name.replace('_', '-')} {figures.caption(function)}" in words, name, words)
    check("work-precision" in words and "atlas" in words, "those of tests/benchmark")
    for name in figures.FIGURES:
        check("positional" in figures.parser_of(name).format_help(), name)


def type_annotations_are_correct():
    if shutil.which("mypy"):
        _done("mypy", "--cache-dir", pathlib.Path("cache").resolve(), cwd=SOURCE / "postproc")
    else:
        print("skipped: mypy is not installed")


main()
