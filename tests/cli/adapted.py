#!/usr/bin/python3
# ranks: 2
# Tests of adaptive meshes: two ranks produce the mesh of one rank, and a run that is resumed after refinements is
# bitwise equal to an uninterrupted run.
import pathlib
import shutil
import subprocess

import h5py
import numpy

from harness import check, command, deck, main, run, series, summary

DECK = """
Tanktread:
  Flow: { type: planar hyperbolic }
  Membrane: { law: Skalak, capillary number: 0.6 }
  Surface: { elements per side: 4, extraordinary points: catmull-clark }
  Adaptation: { enabled: true, surface tolerance: 3.0e-4, levels: 2, coarsen: true }
  Time: { final time: 0.9 }
  Output: { interval: 0.1 }
"""
POLAR = DECK.replace("elements per side: 4, extraordinary points: catmull-clark", "mesh: polar, azimuthal elements: 12, meridional elements: 8")
GROWING = """
Tanktread:
  Flow: { type: simple shear }
  Particle: { viscosity ratio: 2 }
  Membrane: { law: surface tension, capillary number: 0.1 }
  Surface: { elements per side: 3, extraordinary points: catmull-clark }
  Adaptation: { enabled: true, indicator: variation, reference length: 0.05, levels: 3, largest number of points: %d }
  Quadrature: { tolerance: 1.0e-2 }
  Solvers: { double layer: assembled }
  Symmetry: { use: none }
  Time: { scheme: bs3, fixed step: 0.002, final time: 0.006 }
  Output: { interval: 0.1 }
"""
BETWEEN = """
Tanktread:
  Flow: { type: simple shear }
  Membrane: { law: neo-Hookean, capillary number: 0.3 }
  Surface: { elements per side: 3, extraordinary points: catmull-clark }
  Adaptation: { enabled: %s, surface tolerance: 5.0e-4 }
  Time: { fixed step: 0.07, final time: 0.7 }
  Output: { interval: 0.1, between steps: interpolate }
"""
NAMES = ["time", "taylor_inertia", "n_control_points", "energy", "smallest_tension", "evaluations"]


def _points(results):
    return series(results, "n_control_points")


def two_ranks_give_the_same_mesh_as_one():
    for ranks in 1, 2:
        run(deck(DECK), "--output", f"on_{ranks}", "--quiet", ranks=ranks)
    check(len(set(_points("on_1"))) > 2, f"the mesh changed less than twice: {_points('on_1')}")
    for name in NAMES:
        one, two = series("on_1", name), series("on_2", name)
        check(one.shape == two.shape, f"{name}: {len(one)} and {len(two)} rows")
        check(numpy.max(abs(one - two)) <= 1e-10 * max(1, numpy.max(abs(one))), f"{name} differs")


def a_run_resumed_after_refinements_is_bitwise_equal():
    for mesh in "cube", "polar":
        text = DECK if mesh == "cube" else POLAR
        whole, part = f"whole_{mesh}", f"part_{mesh}"
        run(deck(text), "--output", whole, "--quiet")
        check(len(set(_points(whole))) > 2, f"the mesh changed less than twice: {_points(whole)}")
        shutil.copytree(whole, part)
        for later in sorted(pathlib.Path(part).glob("snapshot_*.hdf"))[-3:]:
            later.unlink()
        run("--resume", part, "--quiet")
        for name in NAMES:
            check(series(whole, name).tobytes() == series(part, name).tobytes(), f"{name} differs")


def a_symmetric_scene_stays_symmetric_on_every_mesh():
    run(deck(DECK), "--output", "run", "--quiet")
    plan = summary("run")["plan"]["symmetry"]
    check(plan.startswith("mirror x1, mirror x2 and mirror x3"), plan)
    turned = deck(DECK.replace("Surface:", "Particle: { orientation: [20.0, 35.0, 50.0], drift: free }\n  Surface:"))
    run(turned, "--output", "turned", "--quiet")
    check(summary("turned")["plan"]["symmetry"].startswith("point symmetry"), summary("turned")["plan"]["symmetry"])
    with h5py.File(sorted(pathlib.Path("turned").glob("snapshot_*.hdf"))[-1], "r") as file:
        middle = (file["VTKHDF/Points"][()].max(0) + file["VTKHDF/Points"][()].min(0)) / 2
    check(abs(middle).max() < 1e-12, f"the particle has drifted to {middle}, where the flow carries it off")


def the_largest_number_of_points_is_respected_and_coarse_regions_are_reported():
    run(deck(DECK), "--set", "Adaptation/largest number of points=160", "--output", "run", "--quiet")
    most = max(_points("run"))
    check(98 <= most <= 160, f"{most} control points")
    warnings = summary("run")["warnings"]
    check(len(warnings) == 1 and "Adaptation/largest number of points = 160" in warnings[0], warnings)


def every_change_of_the_mesh_conserves_the_volume():
    for points in "catmull-clark", "g1":
        run(deck(DECK.replace("catmull-clark", points)), "--output", points, "--quiet")
        volume, lost = series(points, "volume"), series(points, "refit_error")
        check(len(set(_points(points))) > 2, f"the mesh changed less than twice: {_points(points)}")
        check(numpy.max(abs(volume / volume[0] - 1)) < 1e-12, volume / volume[0] - 1)
        check(numpy.max(abs(series(points, "volume_error") - (volume / volume[0] - 1))) < 1e-14, series(points, "volume_error"))
        check((numpy.diff(lost) >= 0).all() and 0 < lost[-1] < 1e-2, lost)
    check(lost[-1] > 1e-6, "spaces of `g1` are not nested: a refit moves the surface")


def a_change_of_the_mesh_that_fails_is_undone():
    """The meshes have 56, 218, 866 and 3458 control points. On the last mesh, the double layer alone needs 860 MB, more
    than the limit of the process."""
    run(deck(GROWING % 900), "--output", "whole", "--quiet")
    check((_points("whole") == [56, 218, 866, 866]).all(), _points("whole"))
    words = " ".join(f"'{word}'" for word in command(deck(GROWING % 4000), "--output", "out", "--quiet"))
    result = subprocess.run(["bash", "-c", f"ulimit -v 700000; {words}"], capture_output=True, text=True, timeout=600)
    check(result.returncode == 3 and result.stderr.count("\n") == 1, result.returncode, result.stderr)
    check("not enough memory" in result.stderr and "step 2; the checkpoint of the last good step" in result.stderr, result.stderr)
    counts = summary("out")["counts"]
    check(counts["steps"] == 2 and counts["refinements"] == 2, counts)
    with h5py.File("out/snapshot_000002.hdf", "r") as file:
        check(len(file["checkpoint/arrays/x shape 1"]) == 866, "a checkpoint on another mesh")
    run("--resume", "out", "--set", "Adaptation/largest number of points=900", "--quiet")
    for name in NAMES:
        check(series("whole", name).tobytes() == series("out", name).tobytes(), f"{name} differs")


def a_snapshot_within_a_step_has_the_mesh_of_that_step():
    """A snapshot at a time before the first change of the mesh has the same points as in a run without adaptation."""
    pictures = {}
    for enabled in "true", "false":
        run(deck(BETWEEN % enabled), "--output", enabled, "--quiet")
        step = int(numpy.argmax(_points("true") > _points("true")[0]))
        check(step > 0, "the mesh has not changed")
        with h5py.File(f"{enabled}/snapshot_{step:06}.hdf", "r") as file:
            pictures[enabled] = file["VTKHDF/Points"][:]
    check(numpy.allclose(pictures["true"], pictures["false"], rtol=0, atol=1e-12), "another shape")


main()
