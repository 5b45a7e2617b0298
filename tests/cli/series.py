#!/usr/bin/python3
# Tests of the series and fields in the results, and that the manual lists all of them.
import pathlib
import re
import shutil
import sys

import h5py
import numpy

from harness import SOURCE, check, close, deck, main, run, series, summary

SHEAR = """
Tanktread:
  Flow: { type: simple shear }
  Membrane: { law: neo-Hookean, capillary number: 0.3 }
  Surface: { elements per side: 4 }
  Time: { final time: 0.5 }
"""
RIGID = """
Tanktread:
  Flow: { type: simple shear }
  Particle: { motion: free }
  Surface: { elements per side: 4 }
  Time: { scheme: bs3, final time: 2.0 }
"""
CHANNEL = """
Tanktread:
  Flow: { type: duct }
  Channel: { profile: constriction, depth: 0.3, half length: 1.0, azimuthal elements: 8, axial elements: 16, start: -3.4, end: 3.4 }
  Particle: { radius: 0.4, center: [-1.0, 0.0, 0.0] }
  Membrane: { law: neo-Hookean, capillary number: 0.05 }
  Surface: { elements per side: 3 }
  Quadrature: { tolerance: 0.01 }
  Time: { scheme: bs3, fixed step: 0.01, final time: 0.01 }
  Output: { surface text: true }
"""
LATTICE = """
Tanktread:
  Flow: { type: simple shear }
  Domain: { side lengths: [5, 5, 5] }
  Particles:
    drop:
      Membrane: { law: surface tension, capillary number: 0.1 }
      Interface: { surfactant: { elasticity number: 0.3, diffusivity: 0.1 } }
      Surface: { elements per side: 3 }
    ball: { motion: free, shape: sphere, radius: 0.5, center: [2.5, 0, 0], Surface: { elements per side: 3 } }
  Quadrature: { tolerance: 0.01 }
  Time: { scheme: bs3, fixed step: 0.01, final time: 0.01 }
"""
SPECTRUM = """
Tanktread:
  Flow: { type: simple shear }
  Membrane: { law: surface tension, capillary number: 0.1 }
  Surface: { elements per side: 3 }
  Quadrature: { tolerance: 0.01 }
  Spectrum: { number: 3 }
"""


def _settings(*settings):
    return [word for setting in settings for word in ("--set", setting)]


def _finished(text, *settings):
    """Deletes the directory `run` and runs a deck there."""
    shutil.rmtree("run", ignore_errors=True)
    run(deck(text), *_settings(*settings), "--output", "run", "--quiet")


def a_shear_in_another_plane_gives_the_same_results():
    names = ["taylor_inertia", "taylor_surface", "inclination", "tank_treading_velocity", "tank_treading_frequency", "phase", "axis_1", "axis_3",
             "intrinsic_viscosity"]
    _finished(SHEAR)
    there = {name: series("run", name) for name in names + ["axis_1_x3"]}
    _finished(SHEAR, "Flow/type=linear", "Flow/gradient=[0, 1, 0, 0, 0, 0, 0, 0, 0]")
    check("x1 x2" in summary("run")["plan"]["deformation"], summary("run")["plan"])
    for name in names:
        # the tank-treading velocity is measured on a polygon, which depends on the mesh; other errors are about 1e-8
        tolerance = 1e-4 if "treading" in name else 1e-6
        close(series("run", name)[-1], there[name][-1], tolerance * max(1, abs(there[name][-1])), name)
    close(series("run", "axis_1_x2")[-1], there["axis_1_x3"][-1], 1e-6, "direction of the longest axis")
    check(there["taylor_inertia"][-1] > 0.2, there)


def in_a_nonplanar_flow_d_refers_to_the_longest_and_shortest_axis():
    _finished(SHEAR, "Flow/type=linear", "Flow/gradient=[-0.5, 0, 0, 0, 1, 0, 0, 0, -0.5]", "Time/final time=0.3")
    a, b = series("run", "axis_1")[-1], series("run", "axis_3")[-1]
    close(series("run", "taylor_inertia")[-1], (a - b) / (a + b), 1e-12, "D")
    check(a > 1.05 > series("run", "axis_2")[-1], a)


def a_free_sphere_rotates_at_half_the_rate_and_has_einsteins_viscosity():
    _finished(RIGID)
    close(series("run", "tank_treading_frequency")[-1], 0.5, 1e-6, "frequency")
    # error of the polygon on which it is measured
    close(series("run", "tank_treading_velocity")[-1], 0.5, 1e-3, "velocity")
    close(series("run", "phase")[-1], numpy.degrees(1.0), 1e-3, "phase")
    close(series("run", "intrinsic_viscosity")[-1], 2.5, 0.01, "intrinsic viscosity")  # the coarse mesh


def the_phase_of_a_capsule_is_the_integral_of_its_frequency():
    _finished(SHEAR, "Time/final time=14")
    time, phase, frequency = (series("run", name) for name in ("time", "phase", "tank_treading_frequency"))
    start = numpy.searchsorted(time, 4.0)  # steady
    end = numpy.interp(phase[start] + 180, phase, time)  # after half a turn, the shape is mapped onto itself
    check(end < 14, f"half a turn takes until {end}")
    fine = numpy.linspace(time[start], end, 4000)
    turned = numpy.trapz(numpy.interp(fine, time, frequency), fine)
    # errors of the polygon and of linear interpolation between rows
    close(turned / numpy.pi, 1, 2e-3, "half a turn by the frequency")
    perimeter = 2 * numpy.pi * series("run", "tank_treading_velocity")[-1] / frequency[-1]
    check(5.5 < perimeter < 8, f"the curve is {perimeter} long")


def the_phase_is_continuous_at_refinement_and_resumption():
    adapted = SHEAR + "  Adaptation: { enabled: true, surface tolerance: 2.0e-4, levels: 2 }\n  Output: { interval: 0.1 }\n"
    _finished(adapted, "Time/final time=0.9", "Surface/extraordinary points=catmull-clark")
    check(len(set(series("run", "n_control_points"))) > 1, "the mesh never changed")
    phase = series("run", "phase")
    check(all(numpy.diff(phase) > 0) and phase[-1] > 8, phase)
    shutil.copytree("run", "part")
    for later in sorted(pathlib.Path("part").glob("snapshot_*.hdf"))[-2:]:
        later.unlink()
    run("--resume", "part", "--quiet")
    for name in "phase", "tank_treading_frequency":
        check(series("part", name).tobytes() == series("run", name).tobytes(), f"{name} differs")


def a_drop_has_taylors_viscosity_and_its_interface_tank_treads():
    _finished(SHEAR, "Membrane/law=surface tension", "Membrane/capillary number=0.03", "Particle/viscosity ratio=2")
    # tolerance: terms of order Ca^2, and the discretisation error
    close(series("run", "intrinsic_viscosity")[-1], (1 + 2.5 * 2) / (1 + 2), 0.02, "intrinsic viscosity")
    frequency = series("run", "tank_treading_frequency")
    check(0.2 < frequency[-1] < 0.5, f"frequency {frequency[-1]}")
    time = series("run", "time")
    close(series("run", "phase")[-1], numpy.degrees(numpy.trapz(frequency, time)), 1e-9, "phase")


def series_of_a_drop_need_no_additional_evaluations():
    _finished(SHEAR, "Membrane/law=surface tension", "Membrane/capillary number=0.1")
    counts = summary("run")["counts"]
    check(series("run", "evaluations")[-1] < 12 * counts["steps"], counts)


def derived_numbers_are_in_the_plan_and_in_the_summary():
    _finished(SHEAR, "Membrane/bending modulus=0.05", "Particle/radius=2", "Time/final time=0.02")
    numbers = summary("run")["numbers"]
    close(numbers["radius"], 2, 1e-12, "R_C")
    close(numbers["shear_modulus"], 2 / 0.3, 1e-12, "G_s")
    close(numbers["bending_number"], 0.05 / (2 / 0.3 * 4), 1e-12, "E_b/(G_s R_C^2)")
    close(numbers["relaxation_time"], 0.3, 1e-12, "mu R_C/G_s")
    close(numbers["capillary_number"], 0.3, 1e-12, "Ca")
    close(numbers["reduced_volume"], 1, 1e-4, "reduced volume")
    tube = run("inputs/capsule_in_tube.yaml", "--check").stdout
    check("confinement" in tube and "flow_rate" in tube and "capillary_number" in tube, tube)


def directions_of_equal_semi_axes_are_undefined():
    """A sphere has no inclination; the capsule that it deforms into has one. Each run reports this, is resumed exactly,
    and fails an expectation at a time when the inclination is undefined."""
    directions = "inclination", "axis_1_x1", "axis_1_x2", "axis_1_x3"
    expect = "  Expect: { early: { series: inclination, value: 40, tolerance: 100, at: 0 }, late: { series: inclination, value: 40, tolerance: 10 } }\n"
    shutil.rmtree("run", ignore_errors=True)
    said = run(deck(SHEAR + "  Output: { interval: 0.1 }\n" + expect), "--output", "run", "--quiet", code=1).stderr
    check(said == "tanktread: missed Expect/early: inclination is undefined at the time 0, because the two semi-axes in the plane of the flow (any two "
                  "if the flow is not planar) differ by less than 1e-6 R_C\n", said)
    for name in directions:
        values = series("run", name)
        check(numpy.isnan(values[0]) and numpy.isfinite(values[1:]).all(), name, values)
    check([one["passed"] for one in summary("run")["expect"]] == [False, True] and numpy.isnan(summary("run")["expect"][0]["value"]), summary("run")["expect"])
    shutil.copytree("run", "part")
    for later in sorted(pathlib.Path("part").glob("snapshot_*.hdf"))[-2:]:
        later.unlink()
    run("--resume", "part", "--quiet", code=1)
    for name in directions:
        check(series("part", name).tobytes() == series("run", name).tobytes(), f"{name} differs")

    _finished(RIGID, "Time/final time=0.2")
    final = summary("run")["final"]
    check(all(isinstance(final[name], float) and numpy.isnan(final[name]) for name in directions) and final["phase"] > 5, final)


def _section(manual, heading):
    """Returns the text of one section of the manual of series."""
    return manual.split(f"\n## {heading}\n")[1].split("\n## ")[0]


def _recorded(directory):
    """Returns pairs of a section of the manual of series and a name that the results in a directory contain and that the section must list."""
    said = summary(directory)
    names = [("Summary", name) for name in [*said, *(f"counts/{name}" for name in said["counts"])]] + [("Numbers", name) for name in said["numbers"]]
    snapshot = sorted(path.name for path in pathlib.Path(directory).glob("snapshot_*.hdf"))[0]
    archives = (("run.h5", "series", "Series"), (snapshot, "VTKHDF/PointData", "Fields"), ("duct.h5", "/", "The empty tube"),
                ("channel.h5", "/", "The empty channel"))
    others = {path.name for path in pathlib.Path(directory).glob("*.h5")} - {path for path, _, _ in archives}
    check(not others, "_recorded does not inspect", others)
    for path, group, section in archives:
        if pathlib.Path(directory, path).exists():
            with h5py.File(pathlib.Path(directory, path), "r") as file:
                data = []  # series of one of several particles are in a group with its name
                file[group].visititems(lambda name, item: data.append(name) if isinstance(item, h5py.Dataset) else None)
            names += [(section, re.sub(r"^(mode |rate_|frequency_)\d+", r"\1k", name.split("/")[-1])) for name in data]
    return names


def the_manual_names_all_files_series_and_fields():
    """Each run overwrites the results of the previous one. No file of the previous run may be left."""
    manual, files = run("--reference-series").stdout, (SOURCE / "inputs/manual/results/index.md").read_text()
    flat = SHEAR.replace("final time: 0.5", "final time: 0.02").replace("side: 4", "side: 3")
    prescribed = ["Flow/type=quiescent", "Particle/motion=prescribed", "Particle/shape=spheroid", "Particle/semi-axes=[2, 1, 1]",
                  "Particle/velocity=[1, 0, 0]"]
    decks = [(CHANNEL, []), (LATTICE, []), (SPECTRUM, []), (flat, ["Membrane/law=surface tension"]),
             (RIGID, ["Time/final time=0.02", "Surface/elements per side=3"]), ("Tanktread:\n  Surface: { elements per side: 3 }\n", prescribed),
             (flat, ["Flow/type=duct", "Tube/section=circle", "Tube/radius=2", "Tube/azimuthal elements=8", "Tube/axial elements=8"]), (flat, [])]
    found, times = set(), {}
    for text, settings in decks:
        run(deck(text), *_settings(*settings), "--output", "run", "--overwrite", "--quiet")
        before, times = times, {path.name: path.stat().st_mtime_ns for path in pathlib.Path("run").iterdir()}
        stale = [name for name, time in times.items() if before.get(name) == time]
        check(not stale, "--overwrite has left", stale, "before a run of", text, settings)
        unnamed = [name for name in times if f"| `{re.sub('[0-9]{6}', 'NNNNNN', name)}` |" not in files]
        check(not unnamed, "inputs/manual/results/index.md lacks", unnamed)
        missing = [one for one in _recorded("run") if f"| `{one[1]}` |" not in _section(manual, one[0])]
        check(not missing, text, settings, "the manual lacks", missing)
        found |= {*times, *_recorded("run")}
    rows = {("Fields", name) for name in re.findall(r"^\| `([^`]+)` \|", _section(manual, "Fields"), re.MULTILINE)}
    unused = {name for _, name in rows - found}
    # The field of nodes is not in the group of the others, and no run here has a requested accuracy.
    check(unused == {"Points", "position error"}, "fields of the manual that no deck has recorded:", unused)
    rows = set(re.findall(r"^\| `([^`]+)` \|", files.split("\n## ")[1], re.MULTILINE))
    unwritten = rows - {re.sub("[0-9]{6}", "NNNNNN", name) for name in found if isinstance(name, str)}
    check(len(rows) > 6 and not unwritten, "files of the manual that no deck has written:", unwritten)


def the_python_package_scales_all_fields_with_a_unit():
    sys.path.append(str(SOURCE / "postproc"))
    from tanktread import DIMENSIONS
    names = {"length": "length", "length/time": "velocity", "force/length^2": "stress", "1/length": "curvature"}
    fields = dict(re.findall(r"^\| `([^`]+)` \| ([^|]+) \|", _section((SOURCE / "inputs/SERIES.md").read_text(), "Fields"), re.MULTILINE))
    check({"traction", "velocity", "concentration"} <= set(fields), fields)
    for field, unit in fields.items():
        if unit != "1" and field != "Points":  # Snapshot.scaled scales the points
            check(unit in names, f"the unit {unit} of the field {field} has no dimension in Run.scale")
            check(DIMENSIONS.get(field) == names[unit], f"DIMENSIONS of postproc/tanktread/snapshots.py lacks the field {field}: {names[unit]}")
    for field, dimension in DIMENSIONS.items():
        check(field in fields, f"{field} is in DIMENSIONS, but is no field of inputs/SERIES.md")


main()
