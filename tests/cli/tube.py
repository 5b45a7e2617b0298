#!/usr/bin/python3
# ranks: 2
# Tests of a particle in a tube: messages about wrong values; independence of ranks, resumptions and the solver of the
# block system; a run ends at contact.
import math
import pathlib

import numpy

from harness import SOURCE, check, deck, difference, main, refused, run, series, summary

DECK = """
Tanktread:
  Flow: {type: duct}
  Tube: {section: circle, azimuthal elements: 10, axial elements: 10}
  Particle: {radius: 0.6, center: [0.0, 0.05, -0.15]}
  Membrane: {law: Skalak, capillary number: 0.1, pre-inflation: 0.02}
  Surface: {elements per side: 3}
  Time: {final time: 0.3}
  Output: {interval: 0.1}
"""
CLOCK = ["wall_seconds"]  # the only series that may differ


def _words(settings):
    return [word for setting in settings for word in ("--set", setting)]


def _names(results):
    import h5py

    with h5py.File(pathlib.Path(results) / "run.h5", "r") as file:
        return [name for name in file["series"] if name not in CLOCK]


def _outline(points, name="outline.csv"):
    pathlib.Path(name).write_text("x2,x3\n" + "".join(f"{x},{y}\n" for x, y in points))


def _ellipse(n=24, way=1):
    turns = [2 * math.pi * way * k / n for k in range(n)]
    return [(1.2 * math.cos(t), 0.9 * math.sin(t)) for t in turns]


def _refused(words, *settings):
    refused(words, deck(DECK), *_words(settings))


def decks_that_contradict_the_tube_are_rejected():
    _refused(["Tube", "planar hyperbolic", "duct", "simple shear"], "Flow/type=planar hyperbolic")
    _refused(["Flow/mean velocity", "simple shear"], "Flow/type=simple shear", "Flow/mean velocity=2")
    _refused(["Membrane/capillary number", "gradient"], "Flow/type=quiescent")
    _refused(["Tube/radius", "circle", "ellipse"], "Tube/section=ellipse", "Tube/semi-axes=[1.0, 2.0]", "Tube/radius=1")
    _refused(["Tube/section", "rectangle", "Tube/sides"], "Tube/section=rectangle")
    _refused(["desingularised", "Tube"], "Quadrature/rule=desingularised")
    said = run(deck(DECK), "--set", "Solvers/wall=iterative", "--check", "--quiet").stderr
    check("Solvers/wall `iterative` has no effect on the wall of a straight tube" in said, said)
    run(deck(DECK), "--set", "Solvers/wall=factored", "--check", "--quiet")
    without = deck(DECK.replace("  Tube: {section: circle, azimuthal elements: 10, axial elements: 10}\n", ""), "without.yaml")
    check("needs a section Tube" in run(without, "--check", code=2).stderr, "a duct without a tube")


def a_particle_that_does_not_fit_is_rejected_with_its_dimensions():
    _refused(["does not fit", "beyond the wall", "0.357", "R_C = 1.2", "R_T = 1"], "Particle/radius=1.2")
    _refused(["Particle/center", "outside of the tube", "0.5"], "Particle/center=[0.0, 0.0, 1.5]")
    _refused(["too close", "gap is 0.00995", "0.02"], "Particle/center=[0.0, 0.0, 0.39]")
    _refused(["Tube/length", "4.6", "3"], "Tube/length=3.0")
    _refused(["Tube/length", "at least 5.6", "is 5"], "Tube/length=5.0", "Particle/initial shape/stretch=[1.8, 0.8, 0.7]")


def a_wrong_outline_is_rejected_with_its_values():
    as_file = ["Tube/section=file", "Tube/outline=outline.csv", "Flow/mean velocity=1"]
    _refused(["outline.csv"], *as_file)  # there is none
    _outline(_ellipse(way=-1))
    _refused(["outline.csv", "clockwise"], *as_file)
    eight = [(1.2 * math.cos(t), 0.9 * math.sin(2 * t)) for t in [2 * math.pi * k / 24 for k in range(24)]]
    _outline(eight)
    _refused(["outline.csv", "crosses itself"], *as_file)
    _outline(_ellipse()[:2])
    _refused(["outline.csv", "2"], *as_file)


def _compare(one, other, tolerance):
    for name in _names(one):
        if name.startswith(("solver", "velocity_iter")):
            continue
        a, b = series(one, name), series(other, name)
        off = difference(a, b, name)
        check(off <= tolerance, f"{name} differs by {off:.2e}")


def two_ranks_give_the_result_of_one():
    for settings in ["Particle/viscosity ratio=1"], ["Particle/viscosity ratio=5", "Time/final time=0.1"]:
        for ranks in 1, 2:
            run(deck(DECK), *_words(settings), "--output", f"on_{ranks}", "--overwrite", "--quiet", ranks=ranks)
        _compare("on_1", "on_2", 1e-10)


def every_form_of_the_block_system_gives_the_same_run():
    for ratio in 1, 5:
        fixed = ["Time/fixed step=0.025", "Time/final time=0.025", f"Particle/viscosity ratio={ratio}", "Solvers/tolerance=1e-10",
                 # the two solvers end the iteration of a stage at different iterates
                 "Time/tolerance=1e-8", "Time/newton iterations=20"]
        run(deck(DECK), *_words(fixed), "--output", "schur", "--overwrite", "--quiet")
        for form in "block triangular", "block diagonal", "block":
            more = [f"Solvers/tube={form}", "Solvers/Belos/Maximum Iterations=2000", "Solvers/Belos/Num Blocks=500"]
            run(deck(DECK), *_words(fixed + more), "--output", "blocks", "--overwrite", "--quiet")
            check(summary("blocks")["counts"]["velocity_iterations"] > 0, "nothing was solved")
            # the error of a stage is 2e-9; the error of its stresslet is a hundred times as large
            _compare("schur", "blocks", 1e-6)


BESIDE_OTHERS = """
Tanktread:
  Flow: {type: duct}
  Tube: {section: circle, azimuthal elements: 8, axial elements: 8}
  Particles:
    defaults: {radius: 0.4, Surface: {elements per side: 3}}
    body: {motion: prescribed, center: [-0.6, 0.0, 0.2], velocity: [0.5, 0.0, 0.0]}
    drop: {center: [0.6, 0.1, 0.0], viscosity ratio: 3.0, Membrane: {law: surface tension, capillary number: 0.2}}
    capsule: {center: [1.8, 0.0, -0.1], Membrane: {capillary number: 0.2, pre-inflation: 0.05}}
  Solvers: {tolerance: 1.0e-10, rigid bodies: second kind}
  Time: {scheme: bs3, fixed step: 1.0e-3, final time: 1.0e-3}
"""


def the_block_system_includes_velocity_dependent_loads_and_conserves_every_volume():
    """A prescribed body and a viscous membrane together with other particles, in a tube with ends and in a periodic
    tube, and at a prescribed pressure drop."""
    viscous = DECK.replace("pre-inflation: 0.02", "pre-inflation: 0.02, shear viscosity: 1.0")
    viscous = viscous.replace("final time: 0.3", "fixed step: 1.0e-3, final time: 1.0e-3")
    periodic = BESIDE_OTHERS.replace("axial elements: 8}", "axial elements: 8, periodic length: 5.0}")
    held = BESIDE_OTHERS.replace("{type: duct}", "{type: duct, held: pressure drop}")
    for name, text, of in (("ends", BESIDE_OTHERS, "capsule/"), ("period", periodic, "capsule/"), ("held", held, "capsule/"), ("viscous", viscous, "")):
        found = {}
        for form in "schur", "block triangular":
            settings = [f"Solvers/tube={form}", "Solvers/tolerance=1e-10", "Solvers/Belos/Maximum Iterations=2000",
                        "Solvers/Belos/Num Blocks=500"]
            run(deck(text, f"{name}.yaml"), *_words(settings), "--output", f"{name} {form}", "--quiet")
            names = f"{of}velocity_x1", f"{of}velocity_x3", "disturbed_pressure_drop"
            found[form] = [series(f"{name} {form}", key)[0] for key in names]
        off = max(abs(a - b) for a, b in zip(*found.values()))
        check(off < 1e-6, f"{name}: {found}")


def a_run_ends_when_its_only_particle_is_too_long_for_the_tube():
    needle = """
Tanktread:
  Flow: {type: duct}
  Tube: {section: circle, azimuthal elements: 8, axial elements: 8, length: 3.72}
  Particle: {motion: prescribed, shape: spheroid, semi-axes: [0.15, 0.15, 0.9], angular velocity: [0, 7.853981633974483, 0]}
  Surface: {elements per side: 3}
  Time: {scheme: bs3, fixed step: 0.1, final time: 0.2}
  Output: {interval: 0.2, power balance: true}
"""
    said = run(deck(needle), "--output", "out", "--quiet", code=3).stderr
    check("Tube/length = 3.72 is too short" in said and "the particle has become" in said, said)


def a_run_in_a_tube_is_resumed_bitwise_equal():
    _outline(_ellipse())
    path = deck(DECK.replace("section: circle", "section: file, outline: outline.csv, flow elements: 24"))
    run(path, "--output", "whole", "--quiet")
    run(path, "--output", "parts", "--set", "Time/final time=0.1", "--quiet")
    pathlib.Path("outline.csv").unlink()  # the results contain a copy
    run("--resume", "parts", "--set", "Time/final time=0.3", "--quiet")
    for name in _names("whole"):
        a, b = series("whole", name), series("parts", name)
        check(a.tobytes() == b.tobytes(), f"{name} differs")


def the_strong_form_of_the_load_acts_in_a_tube():
    run(deck(DECK), "--set", "Membrane/load=strong", "--set", "Time/final time=0.01", "--output", "out", "--quiet")
    # tolerance for this coarse mesh
    check(abs(series("out", "disturbance_flux")).max() < 1e-2, series("out", "disturbance_flux"))


def contact_ends_the_run_with_a_checkpoint_that_can_be_resumed():
    capillary = ["Tube/section=file", f"Tube/outline={SOURCE}/inputs/capillary_outline.csv", "Tube/flow elements=48", "Particle/center=[0.0, 0.2, 0.0]"]
    said = run(deck(DECK), *_words(capillary + ["Tube/contact gap=0.195"]), "--output", "out", "--quiet", code=3).stderr
    for word in "touches the wall", "gap is 0.11", "0.195 R_C = 0.117", "at time", "checkpoint", "out":
        check(word in said, f"no '{word}' in: {said}")
    check(series("out", "time")[-1] < 0.3, "it stopped too late")
    check((series("out", "gap")[:-1] >= 0.195 * 0.6).all() and series("out", "gap")[-1] < 0.195 * 0.6, "it stopped at another gap")
    run("--resume", "out", "--set", "Tube/contact gap=0.1", "--quiet")
    check(series("out", "time")[-1] == 0.3, "the run did not go on")


main()
