#!/usr/bin/python3
# ranks: 2
# Tests of a particle in a channel: messages about wrong values; end of a run beyond a given position; mirror symmetry;
# ranks; bodies that are held.
import pathlib

import h5py
import numpy

from harness import check, deck, main, refused, run, series, summary

DECK = """
Tanktread:
  Flow: {type: duct}
  Channel: {profile: constriction, depth: 0.3, half length: 1.0, azimuthal elements: 8, axial elements: 20, start: -3.4, end: 3.4}
  Particle: {radius: 0.4, center: [-1.0, 0.0, 0.0]}
  Membrane: {law: neo-Hookean, capillary number: 0.05}
  Surface: {elements per side: 4}
  Time: {final time: 1.0, end when past: -0.7}
  Output: {interval: 0.2}
"""


def _words(settings):
    return [word for setting in settings for word in ("--set", setting)]


def _refused(words, *settings, mistakes=1):
    refused(words, deck(DECK), *_words(settings), mistakes=mistakes)


def wrong_channels_are_rejected():
    _refused(["Channel", "Tube", "one duct"], "Tube/section=circle")
    _refused(["Channel/depth", "between 0 and 1", "1.2"], "Channel/depth=1.2")
    _refused(["closed", "0.01 R_T"], "Channel/depth=0.995")
    _refused(["Channel/start", "1.7", "-2.5"], "Channel/start=-2.5")
    _refused(["Channel/bend radius", "1.02"], "Channel/bend radius=1.02")
    _refused(["Channel/profile", "step", "corner radius"], "Channel/profile=step")
    _refused(["Channel/corner radius", "0.3"], "Channel/profile=step", "Channel/corner radius=0.3")
    _refused(["Channel/points", "file"], "Channel/points=rows.csv")
    turns = numpy.linspace(0, 2 * numpy.pi, 24, endpoint=False)
    numpy.savetxt("eight.csv", numpy.column_stack([numpy.sin(turns), numpy.sin(2 * turns)]), delimiter=",")
    _refused(["Channel/outline", "eight.csv", "crosses itself"], "Channel/section=file", "Channel/outline=eight.csv")
    circle = numpy.column_stack([numpy.cos(turns), numpy.sin(turns)])
    for name, rows, words in (("twice", circle[[*range(24), 0, 0]], ["line 25", "the point of line 1 is repeated"]), ("open", 1e-6 * circle[:16], ["open", "e-06"])):
        numpy.savetxt(f"{name}.csv", rows, delimiter=",")
        _refused([f"{name}.csv", *words], "Channel/section=file", f"Channel/outline={name}.csv")
    numpy.savetxt("aside.csv", circle + [0.5, 0], delimiter=",")
    bend = "profile: straight, bend radius: 1.4, section: file, outline: aside.csv"
    bent = DECK.replace("profile: constriction, depth: 0.3, half length: 1.0", bend).replace("end: 3.4", "end: 6")
    refused(["Channel/bend radius", "1.5", "1.4"], deck(bent, "bent.yaml"))
    _refused(["Channel/repulsion range", "belong together"], "Channel/repulsion=10")
    _refused(["Channel/repulsion", "circular"], "Channel/repulsion=10", "Channel/repulsion range=0.01", "Channel/directions=x3")
    for setting, mistakes in ("Membrane/load=strong", 1), ("Particle/motion=prescribed", 2):  # the latter also contradicts Membrane
        _refused(["Channel/repulsion", setting.split("=")[1], "contradict"], "Channel/repulsion=10", "Channel/repulsion range=0.01", setting,
                 mistakes=mistakes)
    _refused(["does not fit", "0.7"], "Particle/radius=0.75", "Particle/center=[0, 0, 0]")
    _refused(["too close to an end", "1.7"], "Particle/center=[-1.6, 0, 0]")
    _refused(["Channel/contact gap", "0.9"], "Particle/center=[-1.0, 0.0, 0.4]", "Channel/contact gap=0.9")
    _refused(["Flow/held", "quiescent"], "Flow/type=quiescent", "Flow/held=pressure drop", "Membrane/shear modulus=1")
    pathlib.Path("rows.csv").write_text("s,f\n-1,1\n0,0.7\n0,0.6\n1,1\n")
    lines = DECK.replace("profile: constriction, depth: 0.3, half length: 1.0", "profile: file, points: rows.csv")
    refused(["line 4", "ascend"], deck(lines, "file.yaml"))
    pathlib.Path("rows.csv").write_text("s,f\n-1,0\n1,1\n")
    refused(["closed at s = -3.4"], deck(lines, "file.yaml"))


def the_position_of_a_straight_channel_does_not_matter():
    lines = DECK.replace("profile: constriction, depth: 0.3, half length: 1.0", "profile: straight").replace("end when past: -0.7", "end when past: 4")
    run(deck(lines), "--check", "--quiet", *_words(["Channel/start=0", "Channel/end=6.8", "Particle/center=[3.4, 0, 0]"]))


def a_run_ends_when_the_particle_is_past_the_given_position():
    run(deck(DECK), "--output", "past", "--quiet")
    x = series("past", "centroid_x1")
    check(x[-2] <= -0.7 < x[-1], f"it ended at {x[-1]}")
    check(summary("past")["status"] == "past", summary("past")["status"])
    with h5py.File("past/channel.h5") as file:
        rates = file["flow_rate"][:]
    check(len(rates) == 10 and numpy.abs(rates / numpy.pi - 1).max() < 3e-3, f"flow rates through sections: {rates}")


def gaps_that_the_wall_mesh_does_not_resolve_are_reported():
    """Runs with a prescribed body and searches for steady shapes print the same warning as runs in time."""
    body = """Tanktread:
  Flow: {type: duct}
  Tube: {azimuthal elements: 8, axial elements: 8}
  Particle: {radius: %g, %s}
  Surface: {elements per side: 3}
%s"""
    capsule = "  Membrane: {law: Skalak, capillary number: 0.01, bending number: 0.01}\n  Steady: {tolerance: 1.0e-4}\n"
    for radius, more, lists, told in (0.8, "motion: prescribed", "", True), (0.3, "motion: prescribed", "", False), (0.8, "center: [0, 0, 0]", capsule, True):
        run(deck(body % (radius, more, lists)), "--output", "told", "--overwrite", "--quiet")
        warned = [line for line in summary("told")["warnings"] if "narrower than 0.6 of the wall's elements" in line]
        check(len(warned) == told, f"radius {radius}, {more}: {summary('told')['warnings']}")
    in_time = capsule[:capsule.index("  Steady")] + "  Time: {final time: 1.0e-3}\n  Output: {interval: 1.0e-3, between steps: land}\n"
    run(deck(body % (0.8, "center: [0, 0, 0]", in_time)), "--output", "told", "--overwrite", "--quiet")
    before = summary("told")["warnings"]
    run("--resume", "told", "--quiet")
    check(any("narrower than 0.6" in line for line in before) and summary("told")["warnings"] == before, before, summary("told")["warnings"])


def results_do_not_depend_on_mirror_planes_and_ranks():
    fixed = ["Time/fixed step=0.02", "Time/final time=0.06", "Quadrature/tolerance=1e-7"]
    run(deck(DECK), *_words(fixed), "--output", "mirrored", "--quiet")
    run(deck(DECK), *_words(fixed + ["Symmetry/use=none"]), "--output", "whole", "--quiet")
    run(deck(DECK), *_words(fixed), "--output", "two", "--quiet", ranks=2)
    for name, tolerance in (("velocity_x1", 1e-5), ("length_x1", 1e-6), ("disturbed_pressure_drop", 1e-3), ("channel_pressure_drop", 1e-6)):
        one, other, shared = (numpy.array(series(results, name)) for results in ("mirrored", "whole", "two"))
        scale = numpy.abs(one).max()
        check(numpy.abs(one - other).max() < tolerance * scale, f"{name}: {one} with, {other} without mirror planes")
        check(numpy.abs(one - shared).max() < 1e-8 * scale, f"{name}: {one} on one rank, {shared} on two")


def an_iterated_wall_gives_the_result_of_a_factored_one():
    for ratio, symmetry, form in (1, "auto", "schur"), (1, "none", "schur"), (5, "auto", "schur"), (5, "auto", "block triangular"):
        fixed = ["Time/scheme=bs3", "Time/fixed step=0.01", "Time/final time=0.01", "Quadrature/tolerance=1e-5", f"Particle/viscosity ratio={ratio}"]
        for solver, tube in ("factored", "schur"), ("iterative", form):
            more = [f"Solvers/wall={solver}", f"Solvers/tube={tube}", f"Symmetry/use={symmetry}"]
            run(deck(DECK), *_words(fixed + more), "--output", f"{ratio} {symmetry} {solver}", "--overwrite", "--quiet")
        # tolerance: quadrature
        for name in "velocity_x1", "length_x1", "disturbed_pressure_drop", "pressure_drop_by_flux", "channel_pressure_drop":
            one, other = (series(f"{ratio} {symmetry} {solver}", name)[-1] for solver in ("factored", "iterative"))
            check(abs(other / one - 1) < 1e-5, f"{name}: {one} factored, {other} iterated, ratio {ratio}, symmetry {symmetry}, {form}")


def a_profile_from_a_file_gives_the_result_of_the_constriction():
    s = numpy.linspace(-1, 1, 41)
    rows = "".join(f"{a},{float(f)!r}\n" for a, f in zip(s, 1 - 0.15 * (1 + numpy.cos(numpy.pi * s))))
    pathlib.Path("same.csv").write_text("s,f\n" + rows)
    lines = DECK.replace("profile: constriction, depth: 0.3, half length: 1.0", "profile: file, points: same.csv")
    short = ["Time/end when past=-2", "Channel/azimuthal elements=12", "Channel/axial elements=36"]
    run(deck(lines, "file.yaml"), *_words(short), "--output", "file", "--quiet")
    run(deck(DECK), *_words(short), "--output", "built", "--quiet")
    one, other = (series(results, "channel_extra_pressure_drop")[-1] for results in ("file", "built"))
    check(abs(one / other - 1) < 2e-3, f"{one} by file, {other} built in")


def an_outline_from_a_file_is_scaled_at_the_inlet_too():
    turns = numpy.linspace(0, 2 * numpy.pi, 48, endpoint=False)
    circle = numpy.column_stack([numpy.cos(turns), numpy.sin(turns)])
    numpy.savetxt("circle.csv", circle, delimiter=",", header="x2,x3", comments="")
    pathlib.Path("narrows.csv").write_text("s,f\n-1,1.3\n1,1\n")
    lines = DECK.replace("profile: constriction, depth: 0.3, half length: 1.0", "profile: file, points: narrows.csv")
    lines = lines.replace("start: -3.4", "start: -3.9")
    short = ["Time/scheme=bs3", "Time/fixed step=1e-6", "Time/final time=1e-6", "Time/end when past=2", "Surface/elements per side=3",
             "Channel/axial elements=12", "Quadrature/tolerance=1e-3", "Output/interval=1e-6"]
    run(deck(lines), *_words(short), "--output", "circle", "--quiet")
    outline = ["Channel/section=file", "Channel/outline=circle.csv", "Channel/flow elements=48"]
    run(deck(lines), *_words(short + outline), "--output", "outline", "--quiet")
    for name in "channel_pressure_drop", "velocity_x1":
        one, other = (series(results, name)[0] for results in ("circle", "outline"))
        check(abs(other / one - 1) < 2e-3, f"{name}: {one} of a circle, {other} of its outline")


def gaps_are_found_in_every_period():
    text = """
Tanktread:
  Flow: {type: duct}
  Domain: {periodic: x1, side lengths: [6.8]}
  Channel: {profile: constriction, depth: 0.3, half length: 1.0, azimuthal elements: 8, axial elements: 12}
  Particle: {radius: 0.55, center: [0.0, 0.0, 0.05]}
  Membrane: {law: neo-Hookean, capillary number: 0.05}
  Surface: {elements per side: 3}
  Adaptation: {enabled: true, levels: 1, film resolution: 0.6, surface tolerance: 0.1}
  Time: {scheme: bs3, fixed step: 1.0e-5, final time: 1.0e-5}
  Output: {interval: 1.0e-5}
"""
    for name, x1 in ("first", 0), ("third", 13.6):
        run(deck(text), "--set", f"Particle/center=[{x1}, 0, 0.05]", "--output", name, "--quiet")
    first, third = (series(name, "n_control_points") for name in ("first", "third"))
    plan = run(deck(text), "--set", "Solvers/wall=iterative", "--check").stdout
    check("factored once" in " ".join(plan.split()), "the wall of a periodic channel is not factored")
    check(first[0] > 56 and (first == third).all(), f"control points in the modelled period {first}, two periods farther {third}")


def the_pressure_drop_may_be_prescribed():
    for held in "flow rate", "pressure drop":
        run(deck(DECK), *_words([f"Flow/held={held}"]), "--output", held.split()[0], "--quiet")
    rate, added, empty = (numpy.array(series("pressure", name)) for name in ("flow_rate", "disturbed_pressure_drop", "channel_pressure_drop"))
    check(numpy.allclose(rate, numpy.pi * (1 - added / empty), rtol=1e-10), "the flow rate is not what is left of it")
    check(series("pressure", "velocity_x1")[-1] < series("flow", "velocity_x1")[-1], "it is not slower")


def the_viscosity_ratio_may_differ_from_one():
    straight = "{profile: straight, azimuthal elements: 16, axial elements: 32, start: -3.1, end: 3.1}"
    first = ["Time/final time=1e-6", "Time/end when past=3", "Particle/center=[0, 0, 0]", "Quadrature/tolerance=1e-6"]
    built = "{profile: constriction, depth: 0.3, half length: 1.0, azimuthal elements: 8, axial elements: 20, start: -3.4, end: 3.4}"
    for ratio, law in (5, "neo-Hookean"), (0.2, "surface tension"):
        words = _words(first + [f"Particle/viscosity ratio={ratio}", f"Membrane/law={law}"])
        for name, walls in ("channel", f"Channel: {straight}"), ("tube", "Tube: {azimuthal elements: 24, axial elements: 30}"):
            run(deck(DECK.replace(f"Channel: {built}", walls), f"{name}.yaml"), *words, "--output", f"{name} {ratio}", "--quiet")
        for series_name in "velocity_x1", "disturbed_pressure_drop":
            one, other = (series(f"{name} {ratio}", series_name)[0] for name in ("channel", "tube"))
            check(abs(one / other - 1) < 2e-5, f"viscosity ratio {ratio}, {series_name}: {one} in a channel, {other} in the tube")
        run(deck(DECK), *_words([f"Particle/viscosity ratio={ratio}", f"Membrane/law={law}", "Time/end when past=-0.9"]), "--output", f"narrow {ratio}", "--quiet")
        check(numpy.abs(series(f"narrow {ratio}", "volume_error")).max() < 1e-12, "the volume is not kept")


def a_particle_passes_a_bend_backwards_as_forwards():
    """By reversibility of Stokes flow, a particle that passes the bend backwards moves as fast as one that passes it
    forwards, along the centre line and across it. The two walls have different meshes."""
    bend = "profile: straight, azimuthal elements: 12, bend radius: 2.0, bend start: 0.0, start: -3.0, end: 6.141592653589793"
    lines = DECK.replace("profile: constriction, depth: 0.3, half length: 1.0, azimuthal elements: 8, axial elements: 20, start: -3.4, end: 3.4", bend)
    first = ["Time/final time=1e-6", "Time/end when past=8", "Particle/viscosity ratio=5", "Surface/elements per side=3"]
    found = []
    for center, elements in ("[-0.5, 0.2, 0]", 40), ("[1.8, 2.5, 0]", 46):
        run(deck(lines), *_words(first + [f"Particle/center={center}", f"Channel/axial elements={elements}"]), "--output", f"wall {elements}", "--quiet")
        found.append([series(f"wall {elements}", name)[0] for name in ("velocity_x1", "velocity_x2", "disturbed_pressure_drop")])
    (along, across, drop), (across_after, along_after, drop_after) = found
    check(abs(along / along_after - 1) < 2e-4, f"{along} before, {along_after} after")
    check(abs(abs(across) - abs(across_after)) < 2e-4 * along, f"{across} before, {across_after} after")
    check(abs(drop / drop_after - 1) < 5e-3, f"{drop} before, {drop_after} after")


main()
