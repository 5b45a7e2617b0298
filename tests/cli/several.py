#!/usr/bin/python3
# ranks: 2
# Tests of several capsules and drops in one run: each has its own parameters and series; the result does not depend on
# their order, on ranks or on a resumption.
import pathlib
import re

import numpy

from harness import check, close, deck, difference, main, run, series, summary

MIXED = """
Tanktread:
  Flow: {type: simple shear}
  Particles:
    defaults:
      Surface: {elements per side: 3}
      Membrane: {capillary number: 0.3}
    capsule: {center: [-1.5, 0.0, 0.4]}
    drop: {center: [1.5, 0.0, -0.4], viscosity ratio: 5.0, Membrane: {law: surface tension, capillary number: 0.2}, Surface: {elements per side: 4}}
    small: {like: capsule, center: [0.0, 2.5, 0.0], radius: 0.8}
    ball: {motion: free, center: [0.0, -2.0, 0.0], shape: ellipsoid, semi-axes: [0.8, 0.6, 0.7]}
    pebble: {motion: prescribed, velocity: [0.1, 0.0, 0.0], center: [0.1, -3.15, 0.05], radius: 0.5}
  Time: {fixed step: 0.02, final time: 0.12}
  Solvers: {tolerance: 1.0e-12}
  Output: {interval: 0.04}
"""
REFINED = """
Tanktread:
  Flow: {type: planar hyperbolic}
  Particles:
    defaults:
      Surface: {elements per side: 4, extraordinary points: catmull-clark}
      Membrane: {law: Skalak, capillary number: 0.6}
      Adaptation: {enabled: true, surface tolerance: 1.0e-5, levels: 2}
    left: {center: [0.0, -1.2, 0.0]}
    right: {center: [0.0, 1.2, 0.0], radius: 0.9}
  Time: {fixed step: 0.02, final time: 0.12}
  Solvers: {tolerance: 1.0e-12}
  Output: {interval: 0.04}
"""
OWN = ("wall_seconds", "solver_iterations", "velocity_iterations")  # depend on the machine or on the order of summation


def _all(results):
    """Returns {name: values} for all series of a run. The series of a particle are named `particle/name`."""
    import h5py

    found = {}
    with h5py.File(f"{results}/run.h5", "r") as file:
        file["series"].visititems(lambda name, item: found.update({name: item[:]}) if hasattr(item, "shape") else None)
    return {name: values for name, values in found.items() if name not in OWN}


def _same(one, other, tolerance):
    a, b = _all(one), _all(other)
    check(a.keys() == b.keys(), one, other, "other series")
    for name in a:
        # The error of the direction of a nearly spherical shape is round-off divided by D.
        weight = a.get(name.replace("inclination", "taylor_inertia"), 1) if name.endswith("inclination") else 1
        off = difference(a[name], b[name], f"{other}: {name}", weight)
        check(off <= tolerance, f"{other}: {name} is off by {off:.1e} of {one}")


def _resumes_on_other_ranks(text):
    deck(text)
    run("deck.yaml", "--output", "whole", "--quiet")
    for ranks, then in ((1, 1), (3, 3), (1, 3), (3, 1)):
        results = f"from_{ranks}_on_{then}"
        run("deck.yaml", "--output", results, "--set", "Time/final time=0.08", "--quiet", ranks=ranks)
        run("--resume", results, "--set", "Time/final time=0.12", "--quiet", ranks=then)
        _same("whole", results, 1e-10)


def a_mixture_resumes_on_other_ranks():
    _resumes_on_other_ranks(MIXED)
    for name in ("capsule", "drop", "small"):
        check(numpy.abs(series("whole", f"{name}/volume_error")).max() < 1e-13, name, "lost volume")


def volumes_as_multipliers_give_the_same_run():
    sharp = ["--set", "Time/final time=0.04", "--set", "Time/tolerance=1e-9", "--set", "Time/newton tolerance=0.1"]
    run(deck(MIXED), *sharp, "--output", "projection", "--quiet")
    for ranks in (1, 2):
        run(deck(MIXED), *sharp, "--set", "Solvers/volume=multipliers", "--output", f"multipliers_{ranks}", "--quiet", ranks=ranks)
        _same("projection", f"multipliers_{ranks}", 1e-7)  # steps are solved to 1e-10, and series contain differences of velocities


def the_plan_names_unknown_and_eliminated_blocks():
    def line(name, text, *settings):
        words = [word for setting in settings for word in ("--set", setting)]
        plan = run(deck(text, "plan.yaml"), *words, "--check").stdout
        return re.search(rf"^ *{name} +(.*)$", plan, re.MULTILINE)[1]

    def blocks(text, *settings):
        return line("blocks", text, *settings)

    check(blocks(REFINED) == "velocities computed without a system; eliminated: volume multipliers (projection)", blocks(REFINED))
    kept = blocks(REFINED, "Solvers/volume=multipliers")
    check(kept == "velocities, volume multipliers", kept)
    free = blocks(REFINED, "Solvers/volume=multipliers", "Volume/constraint=none",
                  "Particles/defaults/Membrane/load measure=current")
    check(free == "velocities computed without a system", free)
    mixed = blocks(MIXED)
    check(mixed == "velocities, double-layer densities of rigid bodies; eliminated: volume multipliers (projection)", mixed)
    tractions = blocks(CONFINED, "Solvers/rigid bodies=first kind", "Solvers/tube=block")
    check("tractions of rigid bodies; eliminated:" in tractions and "wall traction and pressure drop (response)" in tractions, tractions)
    implicit = "Time/scheme=tr-bdf2"
    check("each evaluation" in line("time", MIXED, implicit) and "each evaluation" not in line("time", REFINED, implicit),
          "the plan says when implicit steps solve for velocities")


def meshes_that_change_resume_on_other_ranks():
    _resumes_on_other_ranks(REFINED)
    for name in ("left", "right"):
        check(len(set(series("whole", f"{name}/n_control_points"))) > 1, "the mesh of", name, "never changed")


def the_order_of_particles_does_not_matter():
    deck(MIXED, "one.yaml")
    lines = MIXED.splitlines()
    capsule = next(k for k, line in enumerate(lines) if line.startswith("    capsule:"))
    lines[capsule], lines[capsule + 1] = lines[capsule + 1], lines[capsule]
    deck("\n".join(lines), "other.yaml")
    for name in ("one", "other"):
        run(f"{name}.yaml", "--output", name, "--quiet")
    a, b = _all("one"), _all("other")
    for name in a:
        if name.startswith(("first", "second")):
            continue  # numbers of particles, in the order of the deck
        off = difference(a[name], b[name], name)
        check(off <= 1e-10, name, "is off by", off)


def series_of_a_body_that_is_listed_first_refer_to_the_accepted_shape():
    """With a coarse tolerance, the shapes during the iteration of a step differ from the accepted shape. The series of
    the body must belong to the accepted shape."""
    body = "    ball: {center: [0.0, 0.3, 1.9], radius: 0.6, motion: free}\n"
    capsule = "    capsule: {viscosity ratio: 2.0, Membrane: {law: neo-Hookean, capillary number: 0.3}}\n"
    head = "Tanktread:\n  Flow: {type: simple shear}\n  Time: {tolerance: 1.0e-2, final time: 0.2}\n  Particles:\n    defaults: {Surface: {elements per side: 3}}\n"
    run(deck(head + body + capsule, "one.yaml"), "--output", "first", "--quiet")
    run(deck(head + capsule + body, "other.yaml"), "--output", "last", "--quiet")
    check(series("first", "ball/quaternion_0")[0] == 1, series("first", "ball/quaternion_0")[0])
    a, b = _all("first"), _all("last")
    for name in a:
        if not name.startswith(("first", "second")):
            check(difference(a[name], b[name], name) <= 1e-10, name)


def membranes_of_other_particles_do_not_act_on_a_rigid_body():
    plain = """
Tanktread:
  Flow: {type: quiescent}
  Particles:
    defaults: {Surface: {elements per side: 3}}
    one: {motion: free, force: [1.0, 0.0, 0.0]}
    two: {motion: free, center: [0.0, 3.0, 0.0]}
  Time: {fixed step: 0.05, final time: 0.05}
"""
    deck(plain, "plain.yaml")
    deck(plain.replace("defaults: {", "defaults: {Membrane: {law: Skalak, pre-inflation: 0.1, capillary number: 0.3}, "), "inflated.yaml")
    for name in ("plain", "inflated"):
        run(f"{name}.yaml", "--output", name, "--quiet", "--no-expect")
    _same("plain", "inflated", 1e-13)


def a_rigid_body_that_is_listed_first_hides_no_warning():
    """With these long steps and the constraint `flux`, the drop loses more than 1e-3 of its volume."""
    text = """
Tanktread:
  Flow: {type: uniaxial extension}
  Particles:
    ball: {motion: free, center: [0.0, 4.0, 0.0], radius: 0.5, Surface: {elements per side: 3}}
    drop: {center: [0.0, 0.0, 0.0], Membrane: {law: surface tension, capillary number: 0.2}, Surface: {elements per side: 3}}
  Volume: {constraint: flux}
  Time: {scheme: bs3, fixed step: 0.3, final time: 1.2}
"""
    said = run(deck(text), "--quiet", "--output", "volume").stderr
    check("of the volume is lost" in said, said)


def a_distant_particle_has_no_influence():
    alone = """
Tanktread:
  Flow: {type: planar hyperbolic}
  Membrane: {capillary number: 0.3}
  Surface: {elements per side: 3}
  Symmetry: {use: none}
  Time: {fixed step: 0.05, final time: 0.5}
"""
    both = """
Tanktread:
  Flow: {type: planar hyperbolic}
  Particles:
    defaults: {Membrane: {capillary number: 0.3}, Surface: {elements per side: 3}}
    here: {}
    there: {center: [0.0, 1000.0, 0.0]}
  Time: {fixed step: 0.05, final time: 0.5}
"""
    deck(alone, "alone.yaml"), deck(both, "both.yaml")
    for name in ("alone", "both"):
        run(f"{name}.yaml", "--output", name, "--quiet")
    close(series("both", "here/taylor_inertia")[-1], series("alone", "taylor_inertia")[-1], 1e-6, "D")
    check(series("both", "smallest_gap").min() > 900, "the gap")


def the_load_of_a_capsule_is_measured_on_its_own_unstressed_surface():
    """A drop, whose load is per current area, does not change the capsule, whose load is per unstressed area. At a
    distance of 1000 along the vorticity axis, the disturbance by the drop is 1e-9 of the rate."""
    text = """
Tanktread:
  Flow: {type: simple shear}
  Particles:
    defaults: {Surface: {elements per side: 3}, viscosity ratio: 2.0}
    here: {Membrane: {law: Skalak, capillary number: 0.3, shear viscosity: 0.5}}
%s
  Time: {scheme: bs3, fixed step: 0.05, final time: 0.5}
  Solvers: {tolerance: 1.0e-13}
  Output: {interval: 0.5}
"""
    deck(text % "", "alone.yaml")
    deck(text % "    drop: {center: [0.0, 1000.0, 0.0], Membrane: {law: surface tension, capillary number: 0.3}}", "beside.yaml")
    for name in "alone", "beside":
        run(f"{name}.yaml", "--output", f"own_{name}", "--quiet")
    for name in "taylor_inertia", "inclination", "energy", "membrane_dissipation", "smallest_tension":
        one = summary("own_alone")["final"]
        close(series("own_beside", f"here/{name}")[-1], one.get(f"here/{name}", one.get(name)), 1e-9, name)


def pairs_are_symmetric_and_their_gap_is_exact():
    deck("""
Tanktread:
  Flow: {type: simple shear}
  Particles:
    defaults: {Membrane: {capillary number: 0.3}, Surface: {elements per side: 3}}
    first: {center: [-1.2, 0.3, 0.5]}
    second: {center: [1.2, -0.3, -0.5]}
  Time: {final time: 0.4}
""")
    run("deck.yaml", "--output", "pair", "--quiet")
    distance = 2 * numpy.linalg.norm([1.2, 0.3, 0.5])
    # error of the spheres as splines
    close(series("pair", "smallest_gap")[0], distance - 2, 2e-3, "the gap of two spheres")
    for k in (1, 2, 3):
        a, b = series("pair", f"first/centroid_x{k}"), series("pair", f"second/centroid_x{k}")
        check(numpy.abs(a + b).max() < 1e-4, f"x{k} is not that of a symmetric pair", numpy.abs(a + b).max())  # Time/tolerance
    found = summary("pair")
    check(found["status"] == "done" and "first/taylor_inertia" in found["final"], found)


def a_run_ends_at_contact_and_continues_with_a_smaller_limit():
    deck("""
Tanktread:
  Flow: {type: planar hyperbolic}
  Particles:
    defaults: {Membrane: {capillary number: 0.3}, Surface: {elements per side: 3}}
    above: {center: [0.0, 0.0, 1.1]}
    below: {center: [0.0, 0.0, -1.1]}
  Contact: {limit: 0.19}
  Time: {final time: 0.4}
""")
    error = run("deck.yaml", "--output", "results", "--quiet", code=3).stderr
    check("Particles/above and Particles/below touch" in error and "Contact/limit" in error and "checkpoint" in error, error)
    rows = len(series("results", "time"))
    run("--resume", "results", "--quiet", "--set", "Contact/limit=1e-3")
    gap = series("results", "smallest_gap")
    check(len(gap) > rows and gap.min() < 0.19 < gap[0], gap)


def the_narrowest_gap_does_not_depend_on_ranks():
    deck("""
Tanktread:
  Flow: {type: linear, gradient: [0.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0]}
  Particles:
    defaults: {viscosity ratio: 5.0, Membrane: {shear modulus: 10.0}, Surface: {elements per side: 4}}
    one: {center: [3.0, -1.0, 2.0]}
    two: {center: [3.0, 1.8, 2.3]}
  Time: {final time: 0.2}
  Output: {interval: 0.1}
""")
    run("deck.yaml", "--output", "one", "--quiet")
    run("deck.yaml", "--output", "ranks", "--quiet", ranks=2)
    for name in ("smallest_gap", "gap_x1", "gap_x2", "gap_x3"):
        check(numpy.abs(series("one", name) - series("ranks", name)).max() < 1e-10, name, series("one", name), series("ranks", name))


def among_equal_gaps_the_same_one_is_reported_on_any_ranks():
    """Two spheres on a cubic lattice. The gap to the other sphere equals the gaps to its images along x1 and x3."""
    spheres = "\n".join(f"    s{k}: {{center: [0.3, {2.3 * k}, 0.2]}}" for k in range(2))
    deck(f"""
Tanktread:
  Flow: {{type: quiescent}}
  Domain: {{side lengths: [2.3, 4.6, 2.3]}}
  Particles:
    defaults: {{motion: free, force: [1.0, 0.0, 0.0], Surface: {{elements per side: 3}}}}
{spheres}
  Time: {{scheme: bs3, fixed step: 0.01, final time: 0.01}}
""")
    for ranks in (1, 3):
        run("deck.yaml", "--output", f"on_{ranks}", "--quiet", ranks=ranks)
    for name in ("first_of_gap", "second_of_gap", "gap_x1", "gap_x2", "gap_x3"):
        off = numpy.abs(series("on_1", name) - series("on_3", name)).max()
        check(off < 1e-9, f"{name} on three ranks: {off}")
    check(series("on_1", "first_of_gap")[0] == series("on_1", "second_of_gap")[0] == 1, "the first particle and its image")


CONFINED = """
Tanktread:
  Flow: {type: duct}
  Tube: {section: circle, azimuthal elements: 12, axial elements: 12}
  Particles:
    defaults:
      Surface: {elements per side: 3}
      Membrane: {capillary number: 0.1}
    behind: {radius: 0.4, center: [-1.1, 0.0, 0.2], viscosity ratio: 3.0}
    ball: {motion: free, center: [0.0, 0.1, -0.2], shape: ellipsoid, semi-axes: [0.4, 0.3, 0.35]}
    ahead: {radius: 0.4, center: [1.1, 0.0, 0.0], Membrane: {law: surface tension, capillary number: 0.2}}
  Time: {fixed step: 0.02, final time: 0.12}
  Solvers: {tolerance: 1.0e-12}
  Output: {interval: 0.04}
"""


def a_mixture_in_a_tube_resumes_on_other_ranks_and_balances():
    _resumes_on_other_ranks(CONFINED)
    drop = series("whole", "disturbed_pressure_drop")
    for route in ("pressure_drop_by_flux", "pressure_drop_by_force"):
        off = numpy.abs(series("whole", route) / drop - 1).max()
        check(off < 5e-2, route, "is off by", off)  # tolerance for three elements per side


def a_ball_in_a_tube_moves_as_by_the_first_kind_equation():
    words = "{motion: free, radius: 0.5, center: [0.0, 0.0, 0.2]%s}"
    deck("""
Tanktread:
  Flow: {type: duct}
  Tube: {section: circle}
  %s
  Quadrature: {tolerance: 1.0e-6}
  Solvers: {rigid bodies: second kind}
  Time: {final time: 0.01, fixed step: 0.01, scheme: bs3}
""" % ("Particles: {ball: " + words % ", Surface: {elements per side: 6}" + "}"), "second.yaml")
    deck(pathlib.Path("second.yaml").read_text().replace("Particles: {ball: " + words % ", Surface: {elements per side: 6}" + "}",
                                                         "Particle: " + words % "" + "\n  Surface: {elements per side: 6}"), "first.yaml")
    for name in ("first", "second"):
        run(f"{name}.yaml", "--output", name, "--quiet")
    for name in ("velocity_x1", "angular_velocity_x2", "stresslet_13"):
        # collocation error of the first kind: 1e-4 of a stresslet with six elements per side
        close(series("second", f"ball/{name}")[0], series("first", name)[0], 3e-4, name)
    close(series("second", "disturbed_pressure_drop")[0], series("first", "disturbed_pressure_drop")[0], 2e-4, "pressure drop")  # the second's error


def meshes_are_refined_next_to_films():
    deck("""
Tanktread:
  Flow: {type: quiescent}
  Particles:
    defaults:
      motion: prescribed
      Surface: {elements per side: 4, extraordinary points: catmull-clark}
      Adaptation: {enabled: true, film resolution: 0.5}
    one: {velocity: [1.0, 0.0, 0.0]}
    two: {center: [2.1, 0.0, 0.0]}
""")
    run("deck.yaml", "--output", "fine", "--quiet")
    run("deck.yaml", "--output", "coarse", "--quiet", "--set", "Particles/defaults/Adaptation/enabled=false")
    exact = -4.03209888 * 6 * numpy.pi  # own multipole solution: X^A_11 of Jeffrey & Onishi at the distance 2.1
    by_tractions = ["--set", "Solvers/rigid bodies=first kind", "--set", "Quadrature/tolerance=1.0e-6"]
    run("deck.yaml", "--output", "tractions", "--quiet", *by_tractions)
    run("deck.yaml", "--output", "ranks", "--quiet", *by_tractions, ranks=2)
    error = {name: abs(series(name, "one/drag_x1")[0] / exact - 1) for name in ("fine", "coarse", "tractions")}
    check(error["fine"] < 0.1 * error["coarse"] and error["fine"] < 5e-3 and error["tractions"] < 0.1 * error["fine"], error)
    check(abs(series("ranks", "one/drag_x1") - series("tractions", "one/drag_x1")).max() < 1e-9, "ranks")


def figures_distinguish_particles():
    import h5py

    deck(MIXED)
    run("deck.yaml", "--output", "mixed", "--set", "Time/final time=0.02", "--quiet")
    picture = sorted(pathlib.Path("mixed").glob("snapshot_*.hdf"))[-1]
    with h5py.File(picture, "r") as file:
        particle = file["VTKHDF/PointData/particle"][:]
    check(set(particle) == {1, 2, 3, 4, 5}, set(particle))


COPIES = """
Tanktread:
  Flow: {type: simple shear}
  Particles:
    defaults: {Membrane: {capillary number: 0.3}, Surface: {elements per side: 3}}
    one: {center: [0.0, 0.0, 9.0]}
    many: {radius: 0.5, copies: {%s}}
  Time: {final time: 0.01}
"""


def _centres(results, kind="many "):
    """Returns the initial positions of the copies."""
    found = _all(results)
    names = sorted({name.split("/")[0] for name in found if name.startswith(kind)}, key=lambda name: int(name.split()[1]))
    return numpy.array([[found[f"{name}/centroid_x{k}"][0] for k in (1, 2, 3)] for name in names])


def copies_are_at_the_given_positions():
    deck("r2; x3; x1; x2; r1; r3\n0; 0; 0; 0; 0; 0\n90; 0,5; 1,5; 0; 0; 0\n", "places.csv")
    deck("0, 0, 0\n1.5, 0, 0.5\n", "short.csv")
    for name, how in (("file", "file: places.csv"), ("lattice", "lattice: [2, 1, 3], spacing: [2.0, 1.0, 1.5]")):
        deck(COPIES % how)
        run("deck.yaml", "--output", name, "--quiet")
    check(numpy.abs(_centres("file") - [[0, 0, 0], [1.5, 0, 0.5]]).max() < 1e-12, _centres("file"))
    expected = [[x, 0, z] for x in (-1, 1) for z in (-1.5, 0, 1.5)]
    check(numpy.abs(_centres("lattice") - expected).max() < 1e-12, _centres("lattice"))


def random_copies_do_not_overlap_and_are_reproducible():
    deck(COPIES % "volume fraction: 0.1, box: [4.0, 4.0, 4.0], seed: 7, least gap: 0.1")
    for name in ("one", "other"):
        run("deck.yaml", "--output", name, "--quiet")
    x = _centres("one")
    check(len(x) == round(0.1 * 64 / (numpy.pi / 6)) and (x == _centres("other")).all(), x)
    check(numpy.abs(x).max() <= 1.5, "out of the box", x)
    distance = numpy.linalg.norm(x[:, None] - x[None], axis=2) + 10 * numpy.eye(len(x))
    check(distance.min() >= 1.05, distance.min())
    run("deck.yaml", "--output", "third", "--quiet", "--set", "Particles/many/copies/seed=8")
    check((_centres("third") != x).any(), "another seed, the same places")


def copies_fill_a_cell_across_its_faces():
    text = COPIES.replace("  Particles:", "  Domain: {side lengths: [3.0, 3.5, 4.0]}\n  Particles:").replace("  Time:", "  Output: {interval: 0.01}\n  Time:")
    text = text.replace("    one: {center: [0.0, 0.0, 9.0]}\n", "    one: {center: [0.2, 0.0, 0.0], radius: 0.6}\n")
    deck(text % "volume fraction: 0.4, seed: 3, least gap: 0.03")
    check(run("deck.yaml", "--check", "--quiet").stdout == run("deck.yaml", "--check", "--quiet").stdout, "not the same again")
    run("deck.yaml", "--output", "cell", "--quiet", "--set", "Quadrature/tolerance=1e-3", "--set", "Time/tolerance=1e-2")
    x = _centres("cell")
    check(len(x) == round(0.4 * 42 / (numpy.pi / 6)), len(x))
    apart = x[:, None] - x[None]
    apart -= numpy.array([3, 3.5, 4]) * numpy.round(apart / [3, 3.5, 4])
    distance = numpy.linalg.norm(apart, axis=2) + 10 * numpy.eye(len(x))
    check(distance.min() >= 1.015, distance.min())
    check(series("cell", "smallest_gap")[0] > 0.01, "the gap", series("cell", "smallest_gap")[0])
    check((numpy.abs(x) > numpy.array([1, 1.25, 1.5])).any(), "none crosses a face")


def kinds_of_equal_seed_are_at_other_positions_of_a_cell():
    """Copies with equal numbers in two kinds are not close to each other. Random points in a cell of side 40 have a
    mean distance of 19."""
    run(deck("""
Tanktread:
  Flow: {type: quiescent}
  Domain: {side lengths: [40.0, 40.0, 40.0]}
  Particles:
    defaults: {motion: prescribed, Surface: {elements per side: 3}, copies: {number: 4}}
    many: {}
    other: {}
  Quadrature: {tolerance: 1.0e-2}
  Time: {scheme: bs3, fixed step: 0.01, final time: 0.01}
"""), "--output", "kinds", "--quiet")
    apart = _centres("kinds", "many ") - _centres("kinds", "other ")
    distance = numpy.linalg.norm(apart - 40 * numpy.round(apart / 40), axis=1)
    check(distance.mean() > 8, distance)


def mistakes_of_copies_are_named():
    deck("0, 0, 0\n1.5, 0\n", "short.csv")
    for how, words in (
        ("number: 500, box: [4.0, 4.0, 4.0]", ["Particles/many/copies", "not all copies fit", "of 500"]),
        ("number: 5", ["box", "ball", "Domain"]),
        ("volume fraction: 0.1, box: [2504.0, 2504.0, 2504.0]", ["Particles/many/copies", "at most 1000000", "memory", "29985"]),
        ("lattice: [1000, 1001, 1], spacing: [1.0, 1.0, 1.0]", ["Particles/many/copies", "at most 1000000", "1001000"]),
        ("lattice: [2, 2, 1]", ["Particles/many/copies/spacing"]),
        ("lattice: [2, 2, 1], spacing: [0.9, 2.0, 2.0]", ["overlap", "many 1", "many 3"]),
        ("file: none.csv", ["none.csv"]),
        ("file: short.csv", ["short.csv", "line 2", "commas", "2 numbers", "x1, x2, x3"]),
        ("number: 5, lattice: [1, 1, 1], spacing: [1.0, 1.0, 1.0]", ["one of `file`, `lattice`"]),
        ("", ["one of `file`"]),
    ):
        deck(COPIES % how)
        error = run("deck.yaml", "--check", code=2).stderr.strip()
        check(error.count("\n") == 0 and all(word in error for word in words), how, error)
    error = run(deck(COPIES.replace(" one:", " many 2:") % "lattice: [2, 1, 1], spacing: [2.0, 2.0, 2.0]"), "--check", code=2).stderr
    check("Particles/many 2 has the name of copy 2 of Particles/many" in error, error)


def mistakes_are_reported():
    deck(MIXED)
    for setting, words in (
        ("Particles/small/center=[1.5, 0, 0]", ["Particles/drop and Particles/small overlap", "near ["]),
        ("Particles/small/center=[1.5, 0.0, -0.4]", ["Particles/small is inside of Particles/drop"]),
        ("Particles/small/like=drp", ["Particles/small/like", "drp"]),
        ("Particles/capsule/like=small", ["/like must be", "does not lead back"]),
        ("Particles/capsule/shape=spheroid", ["Particles/capsule", "needs Particle/semi-axes"]),
        ("Particles/small/centre=[0, 0, 0]", ["Particles/small/centre", "Particles/small/center"]),
        ("Particles/small/motion=rigid", ["Particles/small/motion", "prescribed"]),
        ("Particles/ball/velocity=[1, 0, 0]", ["Particles/ball", "Particle/velocity", "prescribed"]),
        ("Particles/small/force=[1, 0, 0]", ["Particles/small", "Particle/force", "free"]),
        ("Particles/small/density difference=1", ["Particles/small", "Flow/gravity"]),
        ("Particles/small/Membrane/load=strong", ["Particles/small/Membrane/load"]),
        ("Particles/drop/Interface/motion=sideways", ["Particles/drop/Interface/motion", "relaxed"]),
        ("Membrane/law=Skalak", ["Membrane and Particles contradict", "Particles/defaults"]),
        ("Tube/section=circle", ["Particles/capsule", "does not fit into the tube"]),
        ("Expect/taylor_inertia/value=1", ["tolerance"]),
    ):
        error = run("deck.yaml", "--check", "--set", setting, code=2).stderr.strip()
        check(error.count("\n") == 0 and all(word in error for word in words), setting, error)
    error = run("deck.yaml", "--check", "--set", "Domain/side lengths=[20, 20, 20]", "--set", "Particles/small/center=[21.5, 0.0, -0.4]",
                code=2).stderr
    check("Particles/small is inside of Particles/drop" in error, error)
    error = run("deck.yaml", "--check", "--set", "Expect/x/value=1", "--set", "Expect/x/tolerance=1", "--set", "Expect/x/series=drop/taylor",
                code=2).stderr
    check(re.search("drop/taylor", error), error)


def a_run_with_a_body_at_rest_ends_when_the_drop_is_steady():
    run(deck("""Tanktread:
  Flow: {type: uniaxial extension}
  Particles:
    defaults: {Surface: {elements per side: 3}}
    drop: {center: [0, 1.5, 0], Membrane: {law: surface tension, capillary number: 0.1}}
    ball: {motion: prescribed, center: [0, -1.5, 0], radius: 0.5}
  Time: {final time: 1, steady tolerance: 0.44}
"""), "--output", "steady", "--quiet")
    check(summary("steady")["status"] == "steady", summary("steady")["status"])
    check(abs(series("steady", "ball/shape_velocity")).max() < 1e-10, series("steady", "ball/shape_velocity"))


main()
