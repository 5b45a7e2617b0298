#!/usr/bin/python3
# Tests of runs that start from the end of another run or from a file, and that do not need it afterwards.
import pathlib
import shutil

from harness import check, close, deck, main, run, series

FIRST = """
Tanktread:
  Flow: { type: planar hyperbolic }
  Membrane: { law: Skalak, capillary number: 0.3 }
  Surface: { elements per side: 4, extraordinary points: catmull-clark }
  Time: { scheme: bs3, final time: %s }
  Output: { surface text: true }
  Adaptation: { enabled: %s, interval: 1, surface tolerance: 1.0e-4 }
"""
NAMED = """
Tanktread:
  Flow: { type: planar hyperbolic }
  Particles:
    cell:
      Membrane: { law: Skalak, capillary number: 0.3 }
      Surface: { elements per side: 4, extraordinary points: catmull-clark }
      Adaptation: { enabled: true, interval: 1, surface tolerance: 1.0e-4 }
  Time: { scheme: bs3, final time: 0.05 }
"""
THEN = """
Tanktread:
  Flow: { type: quiescent }
  Particle: { initial shape: { %s } }
  Membrane: { law: Skalak, shear modulus: 1 }
  Surface: { elements per side: 4, extraordinary points: catmull-clark }
  Time: { scheme: bs3, final time: 0.05 }
"""
COPIES = """
Tanktread:
  Flow: { type: quiescent }
  Particles:
    many:
      center: [0.5, 0, 0]
      initial shape: { %s }
      copies: { file: positions.csv }
      Membrane: { law: Skalak, shear modulus: 1 }
      Surface: { elements per side: 4, extraordinary points: catmull-clark }
  Quadrature: { tolerance: 1.0e-3 }
  Time: { scheme: bs3, fixed step: 0.001, final time: 0.001 }
"""
SEVERAL = """
Tanktread:
  Flow: { type: %s }
  Particles:
    defaults: { %s Membrane: { law: Skalak, shear modulus: 3 }, Surface: { elements per side: 4, extraordinary points: catmull-clark } }
    soft: { center: [-3, 0, 0], Membrane: { law: Skalak, shear modulus: 1 } }
    hard: { center: [3, 0, 0] }
  Quadrature: { tolerance: 1.0e-3 }
  Time: { scheme: bs3, fixed step: 0.02, final time: 0.04 }
"""
MEASURES = "taylor_inertia", "inclination", "area", "volume"
CENTRE = "centroid_x1", "centroid_x2", "centroid_x3"
ADAPTS = "  Adaptation: { enabled: true, interval: 1, surface tolerance: 1.0e-4 }\n"

SPHEROID = """
Tanktread:
  Flow: { type: simple shear }
  Particle: { shape: red cell }
  Membrane: { law: Skalak, capillary number: 0.3, stress-free shape: spheroid, stress-free reduced volume: 0.95 }
  Surface: { %s }
  Adaptation: { enabled: true, levels: 2, surface tolerance: 3.0e-4 }
  Quadrature: { tolerance: 1.0e-3 }
  Time: { scheme: bs3, fixed step: 0.001, final time: 0.002 }
"""


def _same_start(then, first):
    """not a test"""
    for name in ("taylor_inertia", "inclination", "area", "volume"):
        close(series(then, name)[0], series(first, name)[-1], 1e-9, name)
    check(series(then, "n_control_points")[0] == series(first, "n_control_points")[-1], "control points")
    check(series(then, "taylor_inertia")[-1] < series(then, "taylor_inertia")[0], "it relaxes")


def a_run_starts_from_the_end_of_another_and_a_resumed_run_does_not_need_it():
    run(deck(FIRST % ("0.1", "false")), "--output", "first", "--quiet")
    newest = max(str(path) for path in pathlib.Path("first").glob("snapshot_*.hdf"))
    for shape in ("run: first", f"run: {newest}", "file: first/surface.iga"):
        run(deck(THEN % shape), "--output", "then", "--quiet")
        _same_start("then", "first")
        shutil.rmtree("then")
    run(deck(THEN % "run: first"), "--output", "then", "--quiet", "--set", "Time/final time=0.02")
    shutil.rmtree("first")
    run("--resume", "then", "--quiet", "--set", "Time/final time=0.05")
    close(series("then", "time")[-1], 0.05, 0, "time")


def a_run_whose_deck_names_its_particle_is_the_run_of_one_particle():
    run(deck(NAMED), "--output", "first", "--quiet")
    run(deck(THEN % "run: first" + ADAPTS), "--output", "then", "--quiet")
    for name in ("taylor_inertia", "area"):
        close(series("then", name)[0], series("first", "cell/" + name)[-1], 1e-9, name)


def particles_start_from_those_of_a_run_of_several():
    """One particle of the run; all of them, each from the one with its name, also copies on a refined mesh."""
    run(deck(SEVERAL % ("planar hyperbolic", "")), "--output", "two", "--quiet")
    run(deck(THEN % "run: two, particle: hard" + "  Quadrature: { tolerance: 1.0e-3 }\n"), "--output", "one", "--quiet", "--set", "Time/final time=0.01")
    for name in *MEASURES, *CENTRE:
        close(series("one", name)[0], series("two", f"hard/{name}")[-1], 1e-9, name)
    run(deck(SEVERAL % ("quiescent", "initial shape: { run: two },")), "--output", "all", "--quiet")
    run(deck(SEVERAL % ("quiescent", "initial shape: { run: two, particle: soft },")), "--output", "equal", "--quiet", "--set", "Particles/hard/center=[3, 0, 0]",
        "--set", "Particles/hard/initial shape/particle=hard")
    for particle in "soft", "hard":
        for name in *MEASURES, *CENTRE:
            close(series("all", f"{particle}/{name}")[0], series("two", f"{particle}/{name}")[-1], 1e-9, f"{particle}/{name}")
            check(series("all", f"{particle}/{name}")[0] == series("equal", f"{particle}/{name}")[0], name)
    check(abs(series("all", "soft/taylor_inertia")[0] - series("all", "hard/taylor_inertia")[0]) > 1e-6, "equal shapes")
    copies = ["--set", "Particles/cell/copies/lattice=[2, 1, 1]", "--set", "Particles/cell/copies/spacing=[4, 4, 4]", "--quiet"]
    run(deck(NAMED), "--output", "copies", *copies)
    run(deck(NAMED.replace("planar hyperbolic", "quiescent").replace("cell:", "cell:\n      initial shape: { run: copies }").replace(
        "capillary number: 0.3", "shear modulus: 1")), "--output", "again", *copies)
    for copy in "cell 1", "cell 2":
        for name in *MEASURES, *CENTRE, "n_control_points":
            close(series("again", f"{copy}/{name}")[0], series("copies", f"{copy}/{name}")[-1], 1e-9, f"{copy}/{name}")
    for which, words in (("run: two", "must be one of the particles of two, `soft` or `hard`."), ("run: two, particle: sotf", "`soft` or `hard`, but is \"sotf\"."),
                         ("particle: hard, stretch: [1, 1, 1]", "initial shape/particle needs Particle/initial shape/run")):
        said = run(deck(THEN % which), "--output", "wrong", "--quiet", code=2).stderr
        check(words in said and said.count("\n") == 1, said)


def a_run_that_starts_from_its_own_directory_keeps_the_shape():
    run(deck(FIRST % ("0.05", "false")), "--output", "own", "--quiet")
    run(deck(THEN % "run: own"), "--output", "other", "--quiet")
    run("deck.yaml", "--output", "own", "--overwrite", "--quiet")
    check((series("own", "taylor_inertia") == series("other", "taylor_inertia")).all(), series("own", "taylor_inertia"))


def copies_translate_and_rotate_a_shape_from_a_file_or_run():
    run(deck(FIRST % ("0.05", "false")), "--output", "first", "--quiet", "--set", "Particle/center=[0.5, 0, 0]", "--set", "Particle/drift=held")
    deck("0, 0, 0, 0, 0, 0.0\n4, 1, 0, 0, 0, 90\n", "positions.csv")
    for shape in "run: first", "file: first/surface.iga":
        run(deck(COPIES % shape), "--output", "then", "--quiet", "--overwrite")
        for copy, centre, axes in (1, (0.5, 0, 0), "123"), (2, (4.5, 1, 0), "213"):
            for k in range(3):
                close(series("then", f"many {copy}/centroid_x{k + 1}")[0], centre[k], 1e-6, "centroid")
                close(series("then", f"many {copy}/length_x{k + 1}")[0], series("first", f"length_x{axes[k]}")[-1], 1e-9, "length")


def random_copies_do_not_overlap_in_their_initial_shape():
    places = "initial shape: { stretch: [1, 1, 1.8], volume: own }\n      copies: { number: 4, box: [8, 8, 8], seed: 2 }"
    text = COPIES.replace("initial shape: { %s }\n      copies: { file: positions.csv }", places).replace("center: [0.5, 0, 0]", "radius: 1")
    run(deck(text), "--check", "--quiet")


def a_volume_other_than_the_resting_one_is_conserved_and_restored():
    run(deck(THEN % "stretch: [1.2, 0.9, 0.8], volume: own"), "--output", "own", "--quiet", "--set", "Time/final time=0.02")
    run("--resume", "own", "--quiet", "--set", "Time/final time=0.05")
    volume = series("own", "volume")
    close(volume[0], 4.18879 * 1.2 * 0.9 * 0.8, 1e-3, "volume")  # the fit on 98 control points
    check(abs(volume / volume[0] - 1).max() < 1e-13, volume)
    close(series("own", "volume_error")[-1], 0, 1e-13, "volume_error")


def the_own_volume_of_a_shape_of_another_run_is_kept_after_a_resume():
    run(deck(THEN % "stretch: [1.2, 0.9, 0.8], volume: own"), "--output", "first", "--quiet", "--set", "Time/final time=0.01")
    run(deck(THEN % "run: first, volume: own"), "--output", "then", "--quiet", "--set", "Time/final time=0.02")
    run("--resume", "then", "--quiet", "--set", "Time/final time=0.05")
    volume = series("then", "volume")
    close(volume[0], series("first", "volume")[-1], 1e-12, "volume")
    check(abs(volume / volume[0] - 1).max() < 1e-13, volume)


def a_resumed_run_starts_from_its_copy_of_the_initial_shape():
    """The flat particle fits between the walls, the sphere does not."""
    run(deck(THEN % "stretch: [1.2, 1.2, 0.69]"), "--output", "flat", "--quiet", "--set", "Time/final time=0.001")
    wall = "  Wall: { point: [0, 0, -0.9] }\n"
    run(deck(THEN % "run: flat" + wall), "--output", "then", "--quiet", "--set", "Time/final time=0.001")
    shutil.rmtree("flat")
    run("--resume", "then", "--quiet", "--set", "Time/final time=0.002")


def the_adapted_mesh_of_another_run_is_used():
    run(deck(FIRST % ("0.5", "true")), "--output", "first", "--quiet")
    check(series("first", "n_control_points")[-1] > 98, "the first run refines")
    run(deck(THEN % "run: first" + ADAPTS), "--output", "then", "--quiet")
    _same_start("then", "first")


def a_stress_free_spheroid_keeps_its_points_on_an_adapted_mesh():
    for surface in "extraordinary points: catmull-clark, elements per side: 3", "mesh: polar, poles: c1, azimuthal elements: 8, meridional elements: 6":
        text = SPHEROID % surface
        run(deck(text), "--output", "first", "--overwrite", "--quiet")
        points = series("first", "n_control_points")
        check(points[-1] > points[0], "the first run refines")
        run(deck(text), "--output", "then", "--overwrite", "--quiet", "--set", "Particle/initial shape/run=first")
        close(series("then", "energy")[0] / series("first", "energy")[-1], 1, 1e-9, f"energy on {surface}")


def another_mesh_is_rejected_in_one_sentence():
    run(deck(FIRST % ("0.01", "false")), "--output", "first", "--quiet")
    for shape, *more in (("run: first", "Surface/elements per side=5"), ("file: first/surface.iga", "Surface/elements per side=5"),
                         ("run: first", "Adaptation/enabled=true")):
        result = run(deck(THEN % shape), "--set", *more, "--check", code=2)
        check(result.stderr.strip().count("\n") == 0 and "Particle/initial shape/" in result.stderr, result.stderr)


def a_run_that_lacks_data_is_rejected_in_one_sentence():
    import h5py

    for adapts, missing in ("false", "arrays/x shape 1"), ("false", "texts/deck"), ("true", "arrays/mesh edges"), ("true", "arrays/initial"):
        run(deck(FIRST % ("0.01", adapts)), "--output", "first", "--overwrite", "--quiet")
        for snapshot in pathlib.Path("first").glob("snapshot_*.hdf"):
            with h5py.File(snapshot, "r+") as file:
                del file["checkpoint"].attrs["checksum"], file[f"checkpoint/{missing}"]
        said = run(deck(THEN % "run: first" + (ADAPTS if adapts == "true" else "")), "--check", code=2).stderr
        check(said.strip().count("\n") == 0 and "Particle/initial shape/run" in said and "lacks" in said, missing, said)


main()
