#!/usr/bin/python3
# Tests of surfaces from files: a written surface can be read again, and a file without a closed surface is rejected in
# one sentence.
import pathlib

from harness import check, close, deck, main, refused, run, series

START = """
Tanktread:
  Flow: { type: simple shear }
  Membrane: { law: Skalak, capillary number: 0.3 }
  Surface: { elements per side: 4 }
  Time: { scheme: bs3, final time: 0.05 }
  Output: { surface text: true }
"""
IMPORT = """
Tanktread:
  Flow: { type: simple shear }
  Particle: { shape: file, file: %s }
  Membrane: { law: Skalak, capillary number: 0.3 }
  Time: { scheme: bs3, final time: 0.05 }
"""


def _written():
    """not a test"""
    run(deck(START), "--output", "first", "--quiet")
    return pathlib.Path("first/surface.iga")


def a_written_surface_can_start_the_next_run():
    file = _written()
    run(deck(IMPORT % file), "--output", "second", "--quiet")
    close(series("second", "volume")[0], series("first", "volume")[-1], 1e-13, "volume")
    close(series("second", "taylor_inertia")[0], series("first", "taylor_inertia")[-1], 1e-13, "D")
    check(series("second", "n_control_points")[0] == 98, "control points")


SEVERAL = """
Tanktread:
  Flow: { type: simple shear }
  Particles:
    %s: { shape: file, file: %s, Membrane: { law: Skalak, capillary number: 0.3 } }
    ball: { center: [0, 0, 4], Surface: { elements per side: 6 } }
  Time: { scheme: bs3, final time: 0.05 }
"""


def the_timed_evaluation_counts_the_elements_of_a_file():
    check("kernel evaluations" in run(deck(SEVERAL % ("red", _written())), "--check").stdout, "no timed evaluation")


def a_particle_from_a_file_must_not_be_named_surface():
    """The copy of its file would have the name of a file of the results."""
    file = _written()
    refused(["surface.iga", "another name"], deck(SEVERAL % ("surface", file)))
    run(deck(SEVERAL % ("red", file)), "--check", "--quiet")


def the_error_of_a_mesh_from_a_file_cannot_be_estimated():
    refused(["Accuracy", "Particle/shape `file`", "not refined"], deck(IMPORT % _written()), "--accuracy", "taylor_inertia=1%")


def _refused(name, lines, *words):
    """not a test"""
    pathlib.Path(name).write_text("\n".join(lines) + "\n")
    result = run(deck(IMPORT % name), "--check", code=2)
    said = result.stderr.strip()
    check(said.count("\n") == 0 and all(word in said for word in (name, *words)), said)


def files_without_a_closed_surface_are_rejected_in_one_sentence():
    lines = _written().read_text().splitlines()
    starts = [i for i, line in enumerate(lines) if line.startswith("belem")] + [len(lines)]
    count = next(i for i, line in enumerate(lines) if line.startswith("elemN"))
    elements = len(starts) - 1
    without = lines[:starts[7]] + lines[starts[8]:]
    _refused("missing.iga", without, "elemN", str(elements), str(elements - 1))
    _refused("empty.iga", [], "elemN")
    _refused("binary.iga", ["no\x07de 1 2 3 1"], '"no\\x07de" is not a keyword')
    _refused("hole.iga", [f"elemN {elements - 1}" if i == count else line for i, line in enumerate(without)], "closed")
    mirrored = [" ".join([w[0], w[1], w[2], str(-float(w[3])), w[4]]) if (w := line.split())[0] == "node" else line for line in lines]
    _refused("inverted.iga", mirrored, "inside out")
    nodes = [line.split() for line in lines if line.startswith("node ")]
    moved = [f"node {float(x) + 3} {y} {z} {weight}" for _, x, y, z, weight in nodes]
    ids = [first + 1 for first in starts[:-1]]
    again = [" ".join(str(int(a) + len(nodes)) for a in line.split()) if i in ids else line for i, line in enumerate(lines) if i >= starts[0]]
    _refused("two.iga", [f"nodeN {2 * len(nodes)}", f"elemN {2 * elements}", *map(" ".join, nodes), *moved, *lines[starts[0]:], *again], "separate parts")
    words = lines[starts[0] + 2].split()
    spoilt = [str(float(words[0]) + 0.1), *words[1:]]
    _refused("sum.iga", [" ".join(spoilt) if i == starts[0] + 2 else line for i, line in enumerate(lines)], "sum to 1")


def a_sphere_around_a_shape_is_about_the_centroid_of_its_volume():
    """The tip of the egg is at x3 = 1.5, and the centroid of its volume at -0.29. The mean of the control points is at 0."""
    def egg(node):
        name, x, y, z, weight = node.split()
        x, y, z = float(x), float(y), float(z)
        return f"{name} {x * (1 - z / 2)} {y * (1 - z / 2)} {1.5 * z} {weight}"

    lines = _written().read_text().splitlines()
    pathlib.Path("egg.iga").write_text("\n".join(egg(line) if line.startswith("node ") else line for line in lines) + "\n")
    said = run(deck("""
Tanktread:
  Flow: {type: simple shear}
  Particles:
    egg: {shape: file, file: egg.iga, Membrane: {capillary number: 0.3}, copies: {number: 1, box: [1, 1, 1]}}
  Time: {final time: 1}
"""), "--check", code=2).stderr
    close(float(said.split("a particle of radius ")[1].split()[0]), 1.88, 0.04, "radius")  # the control point at the tip is at 1.60


def keys_of_other_shapes_and_meshes_are_rejected():
    file = _written()
    for setting, word in ("Surface/elements per side=6", "Surface"), ("Particle/radius=1", "Particle/radius"), ("Adaptation/enabled=true", "Adaptation"):
        result = run(deck(IMPORT % file), "--set", setting, "--check", code=2)
        check(word in result.stderr and "file" in result.stderr, result.stderr)
    result = run(deck(IMPORT % "nowhere.iga"), "--check", code=2)
    check("nowhere.iga" in result.stderr, result.stderr)


def a_file_is_found_next_to_the_deck_and_a_resumed_run_does_not_need_it():
    file = _written()
    pathlib.Path("decks").mkdir()
    file.rename("decks/surface.iga")  # the name that the run's own last surface has
    more = ["--set", "Output/surface text=true", "--quiet"]
    run(deck(IMPORT % "surface.iga", "decks/deck.yaml"), *more, "--output", "whole", "--set", "Time/final time=0.1")
    run("decks/deck.yaml", *more, "--output", "part")
    pathlib.Path("decks/surface.iga").unlink()
    run("--resume", "part", *more, "--set", "Time/final time=0.1")
    for name in "taylor_inertia", "volume_error", "energy":
        close(series("part", name)[-1], series("whole", name)[-1], 1e-6, name)  # steps land on other snapshots


def a_branch_finds_the_file_next_to_the_deck_at_each_of_its_points():
    file = _written()
    pathlib.Path("branches").mkdir()
    file.rename("branches/surface.iga")
    text = """
Tanktread:
  Flow: {type: uniaxial extension}
  Particles: {drop: {shape: file, file: surface.iga, Membrane: {law: surface tension, capillary number: 0.02}}}
  Steady: {}
  Continuation: {parameter: Particles/drop/Membrane/capillary number, to: 0.04, points: 3}
"""
    run(deck(text, "branches/deck.yaml"), "--output", "branch", "--quiet")
    check(len(series("branch", "parameter")) >= 2, series("branch", "parameter"))


def a_surface_file_in_the_results_directory_is_not_deleted():
    file = _written()
    text = file.read_text()
    pathlib.Path("second").mkdir()
    pathlib.Path("second/particle.iga").write_text(text)
    run(deck(IMPORT % "second/particle.iga"), "--output", "second", "--quiet")
    check(pathlib.Path("second/particle.iga").read_text() == text, "the file is another")


def the_final_shape_of_a_search_is_written_too():
    scene = "Tanktread: {Flow: {type: uniaxial extension}, %s Membrane: {law: surface tension, capillary number: 0.02}, %s}"
    run(deck(scene % ("Surface: {elements per side: 3},", "Steady: {tolerance: 1.0e-5}")), "--output", "found", "--quiet", "--set", "Output/surface text=true")
    run(deck(scene % ("Particle: {shape: file, file: found/surface.iga},", "Time: {final time: 1.0e-3}")), "--output", "again", "--quiet")
    # the same control points, summed in another order
    close(series("again", "taylor_inertia")[0], series("found", "taylor_inertia")[-1], 1e-12, "D of the shape from the file")


main()
