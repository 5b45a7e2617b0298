#!/usr/bin/python3
# Tests of steady shapes, spectra and branches: their results, and the messages if nothing is found.
import itertools
import pathlib
import re
import time

import numpy

from harness import check, close, deck, main, run, series, start, summary

DECK = """
Tanktread:
  Flow: {type: uniaxial extension}
  Membrane: {law: surface tension, capillary number: 0.08}
  Surface: {elements per side: 3}
  Steady: {tolerance: 1.0e-8}
"""
IN_TIME = """
Tanktread:
  Flow: {type: uniaxial extension}
  Membrane: {law: surface tension, capillary number: 0.08}
  Surface: {elements per side: 3}
  Time: {final time: 20, steady tolerance: 1.0e-7, tolerance: 1.0e-5}
  Output: {interval: 20}
"""
LONG = """
Tanktread:
  Particle: {shape: spheroid, semi-axes: [0.7575722442, 0.7575722442, 1.7424161616]}
  Surface: {elements per side: 6}
  Solvers: {projection: least squares}
"""
STUCK = """
Tanktread:
  Flow: {type: duct, mean velocity: 0.005, held: pressure drop}
  Channel: {section: circle, profile: constriction, depth: 0.5, half length: 1.5, start: -4, end: 4, contact gap: 0.001, repulsion: 2.0,
            repulsion range: 0.06, azimuthal elements: 8, axial elements: 32}
  Particle: {shape: sphere, radius: 0.65, center: [-0.95, 0, 0]}
  Membrane: {law: neo-Hookean, shear modulus: 1.0, pre-inflation: 0.1}
  Surface: {elements per side: 4}
"""
BRANCH = """
Tanktread:
  Membrane: {capillary number: 0.1}
  Surface: {elements per side: 6}
  Continuation: {parameter: Membrane/capillary number, to: 0.2, step: 0.005, points: 8}
  Spectrum: {number: 3}
"""


def the_search_finds_the_final_shape_of_a_run_with_a_fourth_of_the_evaluations():
    run(deck(DECK), "--output", "steady", "--quiet")
    run(deck(IN_TIME, "in_time.yaml"), "--output", "in_time", "--quiet")
    close(series("steady", "taylor_surface")[-1], series("in_time", "taylor_surface")[-1], 1e-6)
    mine, others = (summary(name)["counts"]["evaluations"] for name in ("steady", "in_time"))
    check(4 * mine <= others, mine, others)


def the_check_refuses_the_searches_that_a_run_refuses():
    branches = {"step=5": "parameter", "parameter=Membrane/capillary number,to=-1": "capillary number", "parameter=Flow/type,to=1": "number",
                "parameter=Membrane/law,to=1": "number", "parameter=Membrane/capillary number,to=0.08": "differ",
                "parameter=Membrane/capillary number,to=0.1,second parameter=Flow/viscosity,second values=[-1]": "viscosity"}
    refused = [(deck(DECK), [f"Continuation/{one}" for one in re.split(r",(?=[a-z ]+=)", words)], word) for words, word in branches.items()]
    refused.append((deck(DECK), ["Symmetry/use=none", "Spectrum/parity=[1, 1, 1]"], "Spectrum/parity"))
    for path, settings, word in refused:
        words = [path, *[part for one in settings for part in ("--set", one)], "--quiet"]
        said = [run(*words, *how, code=2).stderr for how in (["--check"], ["--output", "out"])]
        check(said[0] == said[1] and word in said[0], settings, said)


def two_ranks_find_the_same_shape():
    for projection in "collocation", "least squares":
        for name, ranks in ("one", 1), ("two", 2):
            run(deck(DECK), "--set", f"Solvers/projection={projection}", "--output", name, "--quiet", "--overwrite", ranks=ranks)
        close(series("two", "taylor_surface")[-1], series("one", "taylor_surface")[-1], 1e-10)


def a_drop_in_shear_is_found_for_any_rotation_of_its_mesh():
    """The surface of the drop tank-treads. In the run in time, the mesh has rotated with the shape. On a mesh with four
    elements per side, this rotation of the mesh changes D by 1.3e-3."""
    shear = ["--set", "Flow/type=simple shear", "--set", "Membrane/capillary number=0.2", "--set", "Surface/elements per side=5"]
    run(deck(DECK), *shear, "--output", "shear", "--quiet")
    run(deck(IN_TIME, "in_time.yaml"), *shear, "--output", "shear_in_time", "--quiet")
    for name, digits in ("taylor_surface", 1e-3), ("inclination", 0.2):  # effect of the positions of the mesh
        close(series("shear", name)[-1], series("shear_in_time", name)[-1], digits)


def a_branch_passes_its_fold_where_a_mode_becomes_unstable():
    run(deck(DECK), deck(BRANCH, "branch.yaml"), "--output", "branch", "--quiet", "--no-expect")
    parameter, fold, rate = (series("branch", name) for name in ("parameter", "fold", "leading_rate"))
    at = fold.argmax()
    check(fold.sum() == 1 and parameter.argmax() == at, parameter, fold)
    check((rate[:at] < 0).all() and (rate[at + 1:] > 0).all() and len(rate) > at + 1, rate)
    check(abs(rate[at]) < 1e-3, rate[at])  # for any mesh, because the mesh follows the mode


def a_fold_nearer_than_the_first_step_is_found():
    """The first step is shortened until a steady shape is found."""
    near = ["--set", "Surface/elements per side=4", "--set", "Membrane/capillary number=0.119", "--set", "Continuation/parameter=Membrane/capillary number",
            "--set", "Continuation/to=0.14"]
    for name, step in ("short", 0.0005), ("long", 0.01):
        run(deck(DECK), *near, "--set", f"Continuation/step={step}", "--output", name, "--quiet")
    found = [series(name, "parameter")[series(name, "fold").argmax()] for name in ("short", "long")]
    close(found[1], found[0], 1e-5)


def a_branch_with_too_few_points_is_reported():
    said = run(deck(DECK), deck(BRANCH, "branch.yaml"), "--set", "Continuation/points=2", "--output", "short", "--quiet", "--no-expect").stderr
    check("Continuation/points ended the branch before" in said, said)


def a_branch_that_turns_back_ends_where_it_began():
    """The branch passes a fold and ends on its unstable part, at the parameter value at which it started. Natural
    continuation stops at the fold."""
    deck(LONG, "long.yaml")
    words = [deck(DECK), "long.yaml", "--set", "Surface/elements per side=4", "--set", "Membrane/capillary number=0.117", "--set",
             "Particle/initial shape/stretch=[1.15, 1.15, 0.756]", "--set", "Continuation/parameter=Membrane/capillary number", "--set",
             "Continuation/to=0.14", "--set", "Continuation/step=0.002", "--quiet"]
    run(*words, "--output", "back")
    parameter, fold, d = (series("back", name) for name in ("parameter", "fold", "taylor_surface"))
    check(parameter[-1] == parameter[0] == 0.117 and fold.sum() == 1, parameter, fold)
    check((numpy.diff(d) > 0).all() and d[-1] > d[fold.argmax()] + 0.02, d)
    said = run(*words, "--set", "Continuation/method=natural", "--output", "natural", code=3).stderr
    stopped = series("natural", "parameter")
    check("does not pass" in said and (numpy.diff(stopped) > 0).all(), said, stopped)
    close(stopped[-1], parameter[fold.argmax()], 1e-4)


def a_fold_continued_in_a_second_parameter_agrees_with_a_separate_branch():
    coarse = ["--set", "Surface/elements per side=4", "--quiet", "--no-expect"]
    second = ["--set", "Continuation/second parameter=Particle/viscosity ratio", "--set", "Continuation/second values=[1.4, 2]"]
    run(deck(DECK), deck(BRANCH, "branch.yaml"), *coarse, *second, "--output", "folds")
    run(deck(DECK), deck(BRANCH, "branch.yaml"), *coarse, "--set", "Particle/viscosity ratio=2", "--set", "Membrane/capillary number=0.095",
        "--output", "own")
    parameter, ratio, fold, rate = (series("folds", name) for name in ("parameter", "second_parameter", "fold", "leading_rate"))
    check(list(ratio[fold > 0]) == [1, 1.4, 2] and list(fold[-3:]) == [1, 1, 1], ratio, fold)
    close(parameter[-1], series("own", "parameter")[series("own", "fold").argmax()], 1e-6)
    check((abs(rate[-3:]) < 1e-3).all(), rate)


def a_branch_that_is_stopped_keeps_its_points():
    """The branch is stopped by the wall-clock limit and by a signal."""
    words = [deck(DECK), "--set", "Continuation/parameter=Membrane/capillary number", "--set", "Continuation/to=0.02", "--set",
             "Continuation/step=1e-5", "--set", "Continuation/largest change=1e-5", "--set", "Continuation/points=10000", "--quiet"]
    said = {}
    for limit in 0.5, 4, 32:  # computing the first point takes several seconds if the machine is busy
        said["clock"] = run(*words, "--set", f"Output/wall-clock limit={limit}", "--output", "clock", "--overwrite", code=4).stderr
        if pathlib.Path("clock/summary.yaml").exists():
            break
    process = start(*words, "--output", "signal")
    while len(list(pathlib.Path("signal").glob("snapshot_*"))) < 3 and process.poll() is None:
        time.sleep(0.002)
    process.terminate()
    said["signal"] = process.communicate()[1]
    check(process.returncode == 4, process.returncode, said)
    for name, reason in ("clock", "stopped: at the wall-clock limit"), ("signal", "stopped: by a signal"):
        check(summary(name)["status"] == reason and f"the results so far are in {name}" in said[name], summary(name)["status"], said[name])
        check(series(name, "parameter")[-1] > 0.02, series(name, "parameter"))
    said = run(words[0], "--set", "Output/wall-clock limit=1e-9", "--output", "none", "--quiet", code=4).stderr
    check("stopped at the wall-clock limit before any results were written" in said, said)


def a_branch_coarsens_its_mesh_at_every_point():
    """The branch leads from an elongated drop on a refined mesh to a sphere, for which the initial mesh is fine
    enough."""
    run(deck(DECK), "--set", "Steady/tolerance=1e-5", "--set", "Membrane/capillary number=0.1", "--set",
        "Continuation/parameter=Membrane/capillary number", "--set", "Continuation/to=0.0005", "--set", "Continuation/step=0.01", "--set",
        "Continuation/largest change=0.055", "--set", "Adaptation/enabled=true", "--set", "Adaptation/coarsen=true", "--set",
        "Adaptation/surface tolerance=4e-5", "--set", "Adaptation/coarsening tolerance=0.01", "--set", "Adaptation/levels=2", "--output", "coarser",
        "--quiet")
    points = series("coarser", "n_control_points")
    check(points.max() > 300 and points[-1] == points[0] == 56, points)


def a_branch_in_the_radius_keeps_a_drop_with_surfactant_similar():
    """If the capillary, elasticity and Peclet numbers are constant, shape and concentration do not depend on the radius
    of the drop or the rate of the flow."""
    text = """
Tanktread:
  Flow: {type: simple shear}
  Membrane: {law: surface tension, capillary number: 0.1}
  Interface: {surfactant: {elasticity number: 0.3, Peclet number: 3.0}}
  Surface: {elements per side: 3}
  Quadrature: {tolerance: 1.0e-6}
  Steady: {tolerance: 1.0e-8}
"""
    for parameter in "Particle/radius", "Flow/shear rate":
        run(deck(text), "--set", f"Continuation/parameter={parameter}", "--set", "Continuation/to=1.5", "--output", "similar", "--overwrite",
            "--quiet")
        check(series("similar", "parameter")[-1] == 1.5, series("similar", "parameter"))
        for name in "surfactant_mass", "taylor_inertia", "largest_concentration":
            values = series("similar", name)
            check(abs(values - values[0]).max() < 1e-4, parameter, name, values)  # tolerance: quadrature and search


def a_branch_whose_resting_shape_changes_needs_a_fixed_mesh():
    text = """
Tanktread:
  Flow: {type: simple shear, shear rate: 1.0}
  Membrane: {law: surface tension, surface tension: 12.5}
  Surface: {elements per side: 4}
  Adaptation: {enabled: true, surface tolerance: 4.0e-5, levels: 1}
  Steady: {}
  Continuation: {parameter: Particle/radius, to: 1.4}
"""
    said = run(deck(text), "--output", "refused", "--quiet", code=3).stderr
    check("set Adaptation/enabled to false" in said and "the results so far are in refused" in said, said)
    run(deck(text), "--output", "fixed", "--quiet", "--set", "Adaptation/enabled=false")
    sizes = series("fixed", "volume") / series("fixed", "parameter")**3
    check(abs(sizes / sizes[0] - 1).max() < 1e-5, sizes)  # tolerance: search


def a_branch_without_a_fold_is_reported():
    said = run(deck(DECK), "--set", "Continuation/parameter=Membrane/capillary number", "--set", "Continuation/to=0.09", "--set",
               "Continuation/second parameter=Particle/viscosity ratio", "--set", "Continuation/second values=[2]", "--output", "no_fold", "--quiet",
               code=3).stderr
    check(len(said.splitlines()) == 1 and "no fold" in said, said)
    check(len(series("no_fold", "parameter")) > 2, "the points of the branch")


def a_run_in_time_from_a_mode_grows_at_its_rate():
    """On the unstable branch, two runs start with opposite amplitudes of the mode. Terms of even order cancel in their
    difference. At the start, the mesh also moves along the surface."""
    deck(LONG, "long.yaml")
    run(deck(DECK), "long.yaml", "--set", "Membrane/capillary number=0.117", "--set", "Spectrum/number=1", "--set",
        "Particle/initial shape/stretch=[0.9, 0.9, 1.2346]", "--output", "unstable", "--quiet")
    rate = series("unstable", "leading_rate")[-1]
    check(rate > 0.1, rate)
    growing = ["--set", "Particle/initial shape/run=unstable", "--set", "Particle/initial shape/mode=1", "--set", "Membrane/capillary number=0.117",
               "--set", "Time/tolerance=1e-6", "--quiet", "--overwrite"]
    apart = {}
    for end in 0.5, 1.0:
        d = []
        for amplitude in 0.003, -0.003:
            run(deck(IN_TIME, "in_time.yaml"), "long.yaml", *growing, "--set", f"Particle/initial shape/mode amplitude={amplitude}", "--set",
                f"Time/final time={end}", "--output", "grows")
            d.append(series("grows", "taylor_surface")[-1])
        apart[end] = abs(d[0] - d[1])
    close(numpy.log(apart[1.0] / apart[0.5]) / 0.5, rate, 0.01 * rate)


def a_mode_as_initial_shape_needs_a_run_with_modes():
    run(deck(DECK), "--output", "bare", "--quiet")
    for settings, word in (["Particle/initial shape/mode=1", "Particle/initial shape/stretch=[1, 1, 1]"], "run"), \
                          (["Particle/initial shape/mode=1", "Particle/initial shape/run=bare"], "no mode 1"):
        said = run(deck(DECK), *(word for one in settings for word in ("--set", one)), "--output", "no", "--quiet", code=2).stderr
        check(len(said.splitlines()) == 1 and word in said, said)


def modes_of_all_parities_are_the_modes_without_symmetry():
    """The union of the modes of all parities is the set of modes without symmetry: for a drop, whose modes are compared
    by normal displacements, and for a capsule."""
    for law, projection in ("surface tension", "collocation"), ("surface tension", "least squares"), ("neo-Hookean", "collocation"):
        scene = ["--set", f"Membrane/law={law}", "--set", f"Solvers/projection={projection}", "--set", "Steady/tolerance=1e-9", "--quiet"]
        run(deck(DECK), *scene, "--set", "Symmetry/use=none", "--set", "Spectrum/number=16", "--output", "whole", "--overwrite")
        parts, kinds = [], []
        for parity in itertools.product((1, -1), repeat=3):
            run(deck(DECK), *scene, "--set", f"Spectrum/parity={list(parity)}", "--set", "Spectrum/number=5", "--output", "part", "--overwrite")
            parts += [series("part", f"rate_{k}")[-1] for k in range(1, 6)]
            kinds += summary("part")["modes"].values()
        whole = [series("whole", f"rate_{k}")[-1] for k in range(1, 17)]
        apart = abs(numpy.sort(parts)[::-1][:16] - whole).max()
        check(apart < 2e-5, law, projection, apart, whole, parts)
        check(kinds.count("translation") == 3 and kinds.count("volume") == 1, kinds)


def a_parity_needs_a_symmetry_and_signs():
    for settings, word in ([], "no symmetry"), (["--set", "Spectrum/parity=[1, 0, 1]"], "1 or -1"):
        said = run(deck(DECK), "--set", "Spectrum/parity=[1, -1, 1]", "--set", "Symmetry/use=none", *settings, "--output", "no", "--quiet",
                   code=2).stderr
        check(len(said.splitlines()) == 1 and word in said, said)


def a_shape_is_kept_if_its_modes_cannot_be_computed():
    limits = "{Maximum Iterations: 1, Maximum Restarts: 1}"
    said = run(deck(DECK), "--set", "Spectrum/method=krylov", "--set", "Spectrum/number=1", "--set", "Symmetry/use=none", "--set", f"Solvers/spectrum/Belos={limits}",
               "--output", "kept", "--quiet", code=3).stderr
    check("the results so far" in said, said)
    run(deck(DECK), "--set", "Symmetry/use=none", "--output", "alone", "--quiet")
    close(series("kept", "taylor_surface")[-1], series("alone", "taylor_surface")[-1], 1e-9, "the shape")
    check(numpy.isnan(series("kept", "rate_1")).all() and list(pathlib.Path("kept").glob("snapshot_*")), "modes, or no snapshot")


def above_the_fold_no_shape_is_found_and_the_last_shape_is_written():
    said = run(deck(DECK), "--set", "Membrane/capillary number=0.3", "--set", "Steady/iterations=20", "--output", "none", "--quiet", code=3).stderr
    check(len(said.splitlines()) == 1 and "not found" in said and "the results so far" in said, said)
    check(summary("none")["status"].startswith("failed"), summary("none")["status"])
    check(len(series("none", "taylor_surface")) == 1, "the row of what was reached")


def the_mesh_of_a_shape_and_of_a_branch_adapts():
    near = ["--set", "Adaptation/enabled=true", "--set", "Adaptation/surface tolerance=5e-4", "--set", "Membrane/capillary number=0.1"]
    run(deck(DECK), *near, "--output", "cut", "--quiet")
    points, d = series("cut", "n_control_points")[-1], series("cut", "taylor_surface")[-1]
    check(points > 200 and summary("cut")["counts"]["refinements"] > 0, points)
    run(deck(DECK), "--set", "Membrane/capillary number=0.1", "--output", "whole", "--quiet")
    exact = 0.2263735  # an axisymmetric solution
    check(abs(d - exact) < abs(series("whole", "taylor_surface")[-1] - exact) / 2, d)
    run(deck(DECK), *near, "--set", "Continuation/parameter=Membrane/capillary number", "--set", "Continuation/to=0.115", "--set",
        "Continuation/points=12", "--output", "branch_cut", "--quiet")
    points = series("branch_cut", "n_control_points")
    check(points[-1] > points[0], points)
    close(series("branch_cut", "taylor_surface")[-1], 0.3038398, 5e-3)


def a_capsule_stuck_in_a_constriction_is_a_steady_state():
    """At a prescribed flow rate, the capsule would be pushed through, so that no shape is at rest."""
    search = ["--set", "Steady/tolerance=1e-7", "--set", "Steady/step=7", "--quiet"]
    run(deck(STUCK), *search, "--output", "stuck")
    place = series("stuck", "centroid_x1")[-1]
    check(place < -0.3 and abs(series("stuck", "velocity_x1")[-1]) < 1e-6, place, series("stuck", "velocity_x1"))
    run(deck(STUCK), "--set", "Particle/initial shape/run=stuck", "--set", "Time/final time=10", "--output", "stays", "--quiet")
    close(series("stays", "centroid_x1")[-1], place, 1e-5)
    said = run(deck(STUCK), *search, "--set", "Flow/held=flow rate", "--output", "no", code=2).stderr
    check(len(said.splitlines()) == 1 and "Flow/held" in said and "at rest" in said, said)


SWINGS = """
Tanktread:
  Flow: {type: simple shear}
  Particle: {shape: spheroid, semi-axes: [1.0772173, 1.0772173, 0.8617739], orientation: [0, -45, 0]}
  Membrane: {law: Skalak, area dilatation: 1.0, capillary number: 0.6}
  Surface: {elements per side: 3}
"""


def an_oblate_capsule_swings_periodically():
    """A run in time returns to this state after one period, rotated by half a turn. `Steady` is rejected for this
    scene, and a search that starts from a wrong period fails."""
    run(deck(SWINGS), "--set", "Periodic/period=9", "--set", "Periodic/turn=180", "--set", "Periodic/tolerance=1e-4", "--set", "Time/tolerance=1e-5",
        "--output", "swings", "--quiet")
    period, d, angle = (series("swings", name)[-1] for name in ("period", "taylor_inertia", "inclination"))
    check(8.5 < period < 9.7, period)
    run(deck(SWINGS), "--set", "Particle/initial shape/run=swings", "--set", "Time/tolerance=1e-5", "--set", f"Time/final time={float(period)!r}",
        "--output", "on", "--quiet")
    half = len(series("on", "time")) // 2
    close(series("on", "taylor_inertia")[-1], d, 1e-4)
    close(series("on", "inclination")[-1], angle, 0.02)
    check(abs(series("on", "inclination")[half] - angle) > 0.2 or abs(series("on", "taylor_inertia")[half] - d) > 5e-3, "it swings")
    for settings, word, mistakes in (["Steady/tolerance=1e-6"], "swings", 1), (["Periodic/period=9", "Steady/tolerance=1e-6"], "no period", 2):
        said = run(deck(SWINGS), *(word for one in settings for word in ("--set", one)), "--output", "no", "--quiet", code=2).stderr
        check(len(said.splitlines()) == mistakes and word in said, said)
    said = run(deck(SWINGS), "--set", "Periodic/period=1", "--output", "never", "--quiet", code=3).stderr
    check(len(said.splitlines()) == 1 and "did not recur" in said, said)


def a_tank_treading_state_is_found_and_its_decay_rate_is_that_of_a_run():
    shear = ["--set", "Flow/type=simple shear", "--set", "Membrane/law=neo-Hookean", "--set", "Membrane/capillary number=0.3", "--set",
             "Surface/elements per side=4"]
    run(deck(DECK), *shear, "--set", "Steady/tolerance=1e-7", "--set", "Spectrum/number=8", "--output", "tread", "--quiet")
    run(deck(IN_TIME, "in_time.yaml"), *shear, "--set", "Time/steady tolerance=5e-4", "--output", "tread_in_time", "--quiet")
    # effect of the positions of the mesh, which rotates around the shape in the run in time
    for name, digits in ("taylor_inertia", 3e-3), ("inclination", 0.3):
        close(series("tread", name)[-1], series("tread_in_time", name)[-1], digits)
    kinds = list(summary("tread")["modes"].values())
    check("labels" in kinds, kinds)
    check(series("tread", "leading_rate")[-1] < -0.5, series("tread", "leading_rate"))


def modes_are_those_on_a_mesh_that_fits_the_shape():
    """For an oblate capsule at rest, the mesh is refined before the modes are computed."""
    at_rest = """
Tanktread:
  Flow: {type: quiescent}
  Particle: {shape: spheroid, semi-axes: [1, 1, 0.4]}
  Membrane: {law: neo-Hookean, shear modulus: 1}
  Surface: {elements per side: 3, extraordinary points: catmull-clark}
  Adaptation: {enabled: %s, indicator: variation, reference length: 1, levels: 1}
  Spectrum: {number: 2, method: krylov}
"""
    for enabled in "true", "false":
        run(deck(at_rest % enabled), "--output", enabled, "--quiet")
    check(series("true", "n_control_points")[-1] > series("false", "n_control_points")[-1], "nothing is refined")


def the_end_of_a_branch_must_be_allowed_before_its_first_point_is_computed():
    branch = ["--set", "Continuation/parameter=Membrane/capillary number", "--output", "none", "--overwrite", "--quiet"]
    fold = ["--set", "Continuation/to=0.1", "--set", "Continuation/second parameter=Particle/viscosity ratio", "--set",
            "Continuation/second values=[2, -1]"]
    for way, key in (["--set", "Continuation/to=0"], "Membrane/capillary number"), (fold, "Particle/viscosity ratio"):
        said = run(deck(DECK), *branch, *way, code=2).stderr
        check(len(said.splitlines()) == 1 and key in said and not list(pathlib.Path("none").glob("snapshot_*")), said)
    same = ["--set", "Continuation/to=0.1", "--set", "Continuation/second parameter=Membrane/capillary number", "--set",
            "Continuation/second values=[0.1, 0.2]"]
    for way, words in ([], "Continuation/to is missing"), (same, "must differ from Continuation/parameter"):
        said = run(deck(DECK), *branch, *way, code=2).stderr
        check(len(said.splitlines()) == 1 and words in said, said)


def a_parameter_must_be_a_number_of_the_deck():
    said = run(deck(DECK), "--set", "Continuation/parameter=Membrane/capillary number", "--set", "Continuation/to=0.1", "--set",
               "Continuation/second parameter=Particle/viscosity ratio", "--output", "no", "--quiet", code=2).stderr
    check("Continuation/second values" in said, said)
    for path, word in ("Membrane/law", "number"), ("Membrane/colour", "key"), ("Membrane/capillary number", "differ"):
        said = run(deck(DECK), "--set", f"Continuation/parameter={path}", "--set", "Continuation/to=0.08", "--output", "no", "--quiet", code=2).stderr
        check(len(said.splitlines()) == 1 and "Continuation" in said and word in said, said)


main()
