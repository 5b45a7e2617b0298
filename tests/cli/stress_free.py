#!/usr/bin/python3
# ranks: 2
# Tests of membranes whose stress-free shape differs from the resting shape: relaxation, ranks, rejected decks.
import numpy

from harness import check, close, deck, main, run, series

DECK = """
Tanktread:
  Flow: {type: quiescent}
  Particle: {shape: spheroid, semi-axes: [1.0, 1.0, 0.7]}
  Membrane: {law: Skalak, shear modulus: 1.0, stress-free shape: sphere}
  Surface: {elements per side: 4}
  Time: {final time: 30.0}
  Output: {interval: 1.0, surface text: true}
"""


def a_spheroid_relaxes_towards_its_stress_free_sphere():
    """The stress-free sphere has the same area but a larger volume. At the volume of the spheroid, the equilibrium
    shape is therefore rounder than the spheroid, but not a sphere."""
    run(deck(DECK), "--output", "relaxed", "--quiet")
    energy, volume = series("relaxed", "energy"), series("relaxed", "volume_error")
    check(numpy.all(numpy.diff(energy) <= 1e-12) and energy[-1] < 0.5 * energy[0], f"the energy falls: {energy}")
    check(abs(volume).max() < 1e-12, volume)
    check(series("relaxed", "normal_velocity")[-1] < 1e-3, "it comes to rest")


def a_shape_read_as_stress_free_has_no_stress():
    """If the stress-free shape is read from the surface file of a spheroid, a stretched spheroid has the same energy as
    if the spheroid itself is the stress-free shape."""
    run(deck(DECK), "--set", "Membrane/stress-free shape=resting", "--set", "Time/final time=0.01", "--output", "own", "--quiet")
    close(series("own", "energy")[0], 0, 1e-12, "energy at rest")
    words = ["--set", "Membrane/stress-free shape=file", "--set", "Membrane/stress-free file=own/surface.iga", "--set", "Time/final time=0.01"]
    run(deck(DECK), *words, "--set", "Particle/initial shape/stretch=[1.2, 1, 1]", "--output", "filed", "--quiet")
    run(deck(DECK), "--set", "Membrane/stress-free shape=resting", "--set", "Time/final time=0.01", "--set",
        "Particle/initial shape/stretch=[1.2, 1, 1]", "--output", "stretched", "--quiet")
    # tolerance: motion during the time 0.01, and digits of the file
    close(series("filed", "energy")[0] / series("stretched", "energy")[0], 1, 1e-4, "energy")
    run("--resume", "filed", "--quiet", "--set", "Time/final time=0.02")


def two_ranks_agree_with_one():
    words = ["--set", "Time/fixed step=0.1", "--set", "Time/final time=0.3", "--set", "Output/interval=0.3", "--quiet"]
    words += ["--set", "Particle/shape=red cell", "--set", "Particle/radius=1", "--set", "Membrane/stress-free shape=spheroid"]
    words += ["--set", "Membrane/stress-free reduced volume=0.95", "--set", "Membrane/bending number=0.01", "--set", "Membrane/spontaneous curvature=1.5"]
    text = DECK.replace(", semi-axes: [1.0, 1.0, 0.7]", "")
    for ranks in 1, 2:
        run(deck(text), *words, "--output", f"on_{ranks}", ranks=ranks)
    for name in "taylor_inertia", "energy":
        one, two = series("on_1", name), series("on_2", name)
        check(numpy.max(abs(one - two)) <= 1e-10 * numpy.max(abs(one)), f"{name} differs by {numpy.max(abs(one - two))}")


def contradictory_decks_are_rejected():
    spheroid = "Membrane/stress-free shape=spheroid"
    for settings, sentence in (
        ([spheroid, "Membrane/stress-free reduced volume=1.2"], "Membrane/stress-free reduced volume"),
        ([spheroid], "needs Membrane/stress-free reduced volume"),
        (["Membrane/stress-free reduced volume=0.9"], "belongs to"),
        (["Membrane/stress-free shape=file"], "needs Membrane/stress-free file"),
        (["Membrane/stress-free shape=cube"], "stress-free shape"),
        (["Membrane/spontaneous curvature=1"], "bending modulus"),
        (["Membrane/spontaneous curvature=1", "Membrane/bending modulus=1", "Membrane/bending reference=unstressed"], "contradict"),
        (["Membrane/law=surface tension", "Membrane/bending modulus=1", "Membrane/bending reference=unstressed"], "has no unstressed shape"),
    ):
        told = run(deck(DECK), *(word for one in settings for word in ("--set", one)), "--check", code=2).stderr
        check(sentence in told, settings, told)
    run(deck(DECK), "--set", "Time/final time=0.01", "--output", "own", "--quiet")
    for settings, sentence in (
        (["Particle/shape=ellipsoid", "Particle/semi-axes=[1, 0.9, 0.8]"], "axis of revolution"),
        (["Membrane/stress-free shape=file", "Membrane/stress-free file=nowhere.iga"], "nowhere.iga"),
        (["Membrane/stress-free shape=file", "Membrane/stress-free file=own/surface.iga", "Surface/elements per side=5"], "another spline space"),
    ):
        told = run(deck(DECK), *(word for one in settings for word in ("--set", one)), "--output", "wrong", "--quiet", code=2).stderr
        check(sentence in told, settings, told)


main()
