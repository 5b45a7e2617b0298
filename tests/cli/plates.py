#!/usr/bin/python3
# ranks: 2
# Tests of plates and posts in periodic cells: exact values, balances of forces and power, ranks, resumed runs, rejected
# decks.
import math

import numpy

from harness import check, close, deck, main, refused, run, series

SPHERE = """
Tanktread:
  Flow: {type: quiescent}
  Domain: {periodic: x1 x2, side lengths: [16.0, 16.0, 1.0]}
  Wall: {point: [0.0, 0.0, -2.0], normal: [0.0, 0.0, 1.0], distance: 4.0, elements per period: 24}
  Particles: {sphere: {motion: prescribed, Surface: {elements per side: 6}}}
  Quadrature: {tolerance: 1.0e-5}
  Solvers: {rigid bodies: first kind}
  Time: {scheme: bs3, fixed step: 1.0e-6, final time: 1.0e-6}
"""

CAPSULE = """
Tanktread:
  Flow: {type: quiescent, pressure gradient: [-1.0, 0.3, 0.0]}
  Domain: {periodic: x1 x2, side lengths: [5.0, 4.0, 1.0]}
  Wall: {point: [0.0, 0.0, -1.5], distance: 3.0, velocity: [0.2, 0.0, 0.0], second velocity: [1.0, 0.5, 0.0], elements per period: 10}
  Particle: {radius: 0.8, center: [2.3, 0.1, 0.3], viscosity ratio: 2.0}
  Membrane: {law: neo-Hookean, shear modulus: 5.0}
  Surface: {elements per side: 4}
  Output: {power balance: true, interval: 0.02}
  Solvers: {tolerance: 1.0e-11}
  Time: {scheme: bs3, fixed step: 0.01, final time: 0.04}
"""

POST = """
Tanktread:
  Flow: {type: quiescent, pressure gradient: [-1.0, 0.0, 0.0]}
  Domain: {side lengths: [1.0, 1.0, 0.5]}
  Particle: {shape: cylinder, axis: x3, radius: 0.17841241161527712}
  Surface: {azimuthal elements: 16, axial elements: 4}
  Quadrature: {tolerance: 1.0e-6}
"""


def _first(name, text, *settings, names, ranks=1):
    run(deck(text, f"{name}.yaml"), *[word for setting in settings for word in ("--set", setting)], "--output", name, "--overwrite", "--quiet", ranks=ranks)
    return numpy.array([series(name, key)[0] for key in names])


def the_force_and_torque_on_a_sphere_midway_between_plates_are_exact():
    """The expected values were computed with the exact Green's function of the slit and with point sources."""
    across = _first("across", SPHERE, "Particles/sphere/velocity=[0, 0, 1]", names=["sphere/drag_x3", "wall_force_x3", "second_wall_force_x3"])
    close(across[0] / (-6 * math.pi), 2.789204, 5e-4, "drag across")
    close(across[1] + across[2] + across[0], 0, 1e-6 * abs(across[0]), "sum of the forces across")
    torque = _first("torque", SPHERE, "Particles/sphere/angular velocity=[0, 1, 0]", names=["sphere/torque_x2"])
    close(torque[0] / (-8 * math.pi), 1.073027, 2e-4, "torque")
    settings = ("Particles/sphere/motion=free", "Wall/velocity=[-1, 0, 0]", "Wall/second velocity=[1, 0, 0]")
    spin, force, second = _first("couette", SPHERE, *settings, names=["sphere/angular_velocity_x2", "wall_force_x1", "second_wall_force_x1"])
    close(2 * spin, 0.475800, 2e-4, "spin in Couette flow")
    close(force + second, 0, 1e-5 * force, "sum of the forces along")
    shear = _first("shear", SPHERE, "Particles/sphere/motion=free", "Flow/type=simple shear", "Flow/shear rate=0.5", names=["sphere/angular_velocity_x2"])
    close(shear[0], spin, 1e-10, "spin with plates that move with the flow")


def forces_in_long_cells_meet_the_tolerance():
    """In a long cell, the flows of the sphere and of the plates are larger than their sum. The drag along the plates must
    err by less than a fifth of Quadrature/tolerance, as the text of this key says."""
    settings = ("Domain/side lengths=[24.0, 24.0, 1.0]", "Particles/sphere/velocity=[1, 0, 0]", "Wall/elements per period=36", "Solvers/rigid bodies=second kind")
    drag = {tolerance: _first("long", SPHERE, *settings, f"Quadrature/tolerance={tolerance}", names=["sphere/drag_x1"])[0] for tolerance in (1e-4, 1e-6)}
    close(drag[1e-4], drag[1e-6], 2e-5 * abs(drag[1e-6]), "drag along")


def the_plan_names_the_equation_of_a_body_between_plates():
    """Tractions cost twice the time for one configuration, but four times in a run over time."""
    for motion, unknown in (("prescribed", "tractions of rigid bodies"), ("free", "double-layer densities of rigid bodies")):
        plan = run(deck(SPHERE), "--set", f"Particles/sphere/motion={motion}", "--set", "Solvers/rigid bodies=auto", "--check").stdout
        check(f" blocks {unknown};" in " ".join(plan.split()), plan)


def between_plates_the_flow_is_poiseuilles_with_and_without_a_small_sphere():
    """For a pressure gradient of 0.5 and a distance of 4, the mean velocity is 2/3. The sphere, whose volume fraction
    is 1e-4, changes it by less than the tolerance."""
    settings = ("Flow/pressure gradient=[-0.5, 0, 0]", "Particles/sphere/motion=free", "Particles/sphere/radius=0.3", "Wall/elements per period=8")
    names = ["mean_velocity_x1", "wall_force_x1", "second_wall_force_x1", "sphere/velocity_x1", "permeability"]
    mean, lower, upper, velocity, permeability = _first("poiseuille", SPHERE, *settings, names=names)
    close(mean, 2 / 3, 1e-4, "mean velocity")
    close(lower + upper, 0.5 * 4 * 256, 1e-6 * 512, "force on the plates")
    close(velocity, 1, 0.01, "velocity of the sphere")
    close(permeability, 2 * mean, 1e-12, "permeability")


def a_capsule_between_plates_on_two_ranks_and_resumed():
    names = ["velocity_x1", "velocity_x3", "energy", "taylor_inertia", "gap", "wall_force_x1", "second_wall_force_x3", "mean_velocity_x2", "power_residual"]
    run(deck(CAPSULE), "--output", "one", "--quiet")
    run(deck(CAPSULE), "--output", "two", "--quiet", ranks=2)
    run(deck(CAPSULE), "--set", "Time/final time=0.02", "--output", "half", "--quiet")
    run(deck(CAPSULE), "--resume", "half", "--quiet")
    for name in names:
        for other in ("two", "half"):
            off = abs(series("one", name) - series(other, name)).max() / max(1, abs(series("one", name)).max())
            check(off < 1e-10, f"{name} of {other}: {off}")
    check(abs(series("one", "power_residual")).max() < 5e-3, series("one", "power_residual"))
    total = series("one", "wall_force_x1") + series("one", "second_wall_force_x1")
    check(abs(total - 60).max() < 1e-4 * 60, f"the plates take {total}, the pressure gives 60")


def the_position_along_the_plates_does_not_matter():
    names = ["velocity_x1", "velocity_x3", "wall_force_x1", "mean_velocity_x1", "gap"]
    here = _first("here", CAPSULE, names=names)
    there = _first("there", CAPSULE, "Particle/center=[12.3, -7.9, 0.3]", names=names)
    # the particle is shifted by two periods in both directions
    check(abs(here - there).max() < 1e-9, f"{here} and {there}")
    shifted = _first("shifted", CAPSULE, "Particle/center=[2.05, 0.32, 0.3]", names=names)
    # the particle is shifted relative to the elements of the plates
    check(abs(here - shifted).max() < 1e-3, f"{here} and {shifted}")


def power_of_the_flow_is_that_of_its_rate_of_strain():
    """In Couette flow, the additional power of the plates equals S:E, with the stresslet S of the particle."""
    text = CAPSULE.replace("velocity: [0.2, 0.0, 0.0], second velocity: [1.0, 0.5, 0.0], ", "").replace(", pressure gradient: [-1.0, 0.3, 0.0]", "")
    run(deck(text.replace("quiescent", "simple shear")), "--output", "shear", "--quiet")
    power, stresslet = series("shear", "flow_power"), series("shear", "stresslet_13")
    check(abs(power - stresslet).max() < 2e-3 * abs(power).max(), f"{power} and {stresslet}")


def mean_velocity_does_not_depend_on_how_bodies_are_modelled():
    """Two spheres near one of two moving plates, computed with tractions as unknowns and with double-layer densities as
    unknowns. A drop of high viscosity and high tension gives nearly the same mean velocity."""
    text = """
Tanktread:
  Flow: {type: simple shear}
  Domain: {periodic: x1 x2, side lengths: [4.0, 4.0, 1.0]}
  Wall: {point: [0.0, 0.0, -1.5], distance: 3.0, elements per period: 12}
  Particles:
    defaults: {motion: free, radius: 0.5, Surface: {elements per side: 4}}
    a: {center: [0.0, 0.0, 0.7]}
    b: {center: [0.0, 2.0, 0.7]}
  Time: {scheme: bs3, fixed step: 1.0e-6, final time: 1.0e-6}
"""
    by = {kind: _first(kind.split()[0], text, f"Solvers/rigid bodies={kind}", names=["mean_velocity_x1"])[0] for kind in ("first kind", "second kind")}
    check(by["first kind"] > 0.04, f"{by}: the fluid is drawn along by the nearer plate")
    # measured: 2e-4, the discretisation error of the double layer
    close(by["second kind"], by["first kind"], 1e-3 * by["first kind"], "mean velocity")
    drops = text.replace("motion: free, ", "viscosity ratio: 300.0, Membrane: {law: surface tension, capillary number: 0.001}, ")
    close(_first("drops", drops, names=["mean_velocity_x1"])[0], by["first kind"], 0.03 * by["first kind"], "mean velocity of drops")  # 1e-2


def a_single_plate_in_a_domain_is_the_image_plane_of_a_dilute_layer():
    """As the period grows, a plate in a periodic cell gives the result of the section Wall, which uses images."""
    text = """
Tanktread:
  Flow: {type: simple shear}
  Wall: {point: [0, 0, 0]}
  Particle: {radius: 0.5, center: [0.0, 0.0, 0.9], motion: free}
  Surface: {elements per side: 4}
  Quadrature: {tolerance: 1.0e-5}
  Time: {scheme: bs3, fixed step: 1.0e-6, final time: 1.0e-6}
"""
    alone = _first("alone", text, names=["velocity_x1", "angular_velocity_x2"])
    layer = text.replace("  Wall: {point: [0, 0, 0]}", "  Wall: {point: [0, 0, 0], elements per period: 32}\n  Domain: {periodic: x1 x2, side lengths: [8, 8, 1]}")
    layer = layer.replace("  Time:", "  Solvers: {rigid bodies: first kind}\n  Time:")
    many = _first("layer", layer, names=["velocity_x1", "angular_velocity_x2"])
    check(abs(many - alone).max() < 5e-3, f"{many} and {alone}")


def the_force_on_posts_of_a_square_array_is_the_known_one():
    """Across the posts, F/(mu U) = 24.83 per unit length at the area fraction 0.1 (Sangani & Acrivos 1982), and two
    meshes agree. The permeability along the posts is also known."""
    names = ["permeability", "post_force_x1", "mean_velocity_x2"]
    coarse = _first("coarse", POST, names=names)
    fine = _first("fine", POST, "Surface/azimuthal elements=24", names=names)
    close(fine[0] * 24.83, 1, 3e-4, "permeability")
    close(coarse[0] / fine[0], 1, 3e-5, "coarse mesh")
    close(fine[1], 0.5, 1e-9, "force")
    close(fine[2], 0, 1e-9, "velocity across")
    two = _first("two", POST, names=names, ranks=2)
    check(abs(two - coarse).max() < 1e-10, f"{two} and {coarse}")
    along = _first("along", POST, "Flow/pressure gradient=[0, 0, -1]", names=["permeability"])[0]
    # Drummond & Tahir 1984, square array along its axis: (-ln c - 1.47634 + 2 c - c^2/2 + ...)/(4 c) a^2
    c = 0.1
    close(along, (-math.log(c) - 1.47634 + 2 * c - c * c / 2 - 0.0509713 * c**4) / (4 * c) * c / math.pi, 1e-4 * along, "permeability along")


def a_flow_that_varies_in_time_is_refused_for_posts_alone():
    refused(["Flow/history", "`cylinder`"], deck(POST), "--set", "Flow/history/times=[0, 1]", "--set", "Flow/history/amplitudes=[1, 2]")


def a_thin_post_must_not_cross_a_particle():
    text = """
Tanktread:
  Flow: {type: quiescent, pressure gradient: [-1.0, 0.0, 0.0]}
  Domain: {side lengths: [6.0, 6.0, 6.0]}
  Particles:
    drop: {center: [6.3, 0.1, 0.0], Membrane: {law: surface tension, surface tension: 1.0}, Surface: {elements per side: 4}}
    post: {shape: cylinder, axis: x3, radius: 0.05, Surface: {azimuthal elements: 8, axial elements: 8}}
  Time: {final time: 0.1}
"""
    refused(["Particles/drop crosses Particles/post"], deck(text), "--check")
    refused(["Particles/drop crosses Particles/post"], "deck.yaml", "--check", "--quiet")  # without the timed evaluation
    run("deck.yaml", "--check", "--set", "Particles/drop/center=[7.06, 0, 0]")
    refused(["cylinder", "drift `held`"], "deck.yaml", "--set", "Particles/drop/center=[3, 3, 0]", "--set", "Particles/drop/drift=held")
    refused(["Particles/drop crosses Particles/post"], "deck.yaml", "--check", "--set", "Particles/drop/center=[7.04, 0, 0]")


def keys_without_effect_on_posts_alone_are_named():
    for setting, key in ("Output/power balance=true", "Output/power balance"), ("Solvers/rigid bodies=second kind", "Solvers/rigid bodies"):
        said = run(deck(POST), "--check", "--set", setting).stderr
        check(f"{key}" in said and "has no effect" in said, said)


def posts_and_particles_balance_the_pressure_gradient():
    text = """
Tanktread:
  Flow: {type: quiescent, pressure gradient: [-1.0, 0.0, 0.0]}
  Domain: {side lengths: [3.0, 3.0, 3.0]}
  Particles:
    post: {shape: cylinder, axis: x3, radius: 0.5, Surface: {azimuthal elements: 12}}
    ball: {motion: free, radius: 0.4, center: [0.1, 1.5, 0.1], Surface: {elements per side: 4}}
  Solvers: {rigid bodies: first kind}
  Time: {scheme: bs3, fixed step: 1.0e-3, final time: 1.0e-3}
"""
    names = ["post/post_force_x1", "ball/velocity_x1", "mean_velocity_x1", "pressure_gradient_x1"]
    force, velocity, mean, gradient = _first("ball", text, names=names)
    # 27: pressure gradient times volume of the cell, because the ball is force-free. Tolerance: quadrature of the force
    close(force, 27, 1e-5 * 27, "force on the post")
    # the ball is midway between two posts, where the flow is faster than on average
    check(0 < mean < velocity, f"mean velocity {mean}, of the ball {velocity}")
    close(gradient, -1, 1e-12, "pressure gradient")


def a_drop_between_posts_moves_with_the_flow():
    """The drop itself has all mirror planes. The post and the flow break these symmetries, so the run must not use
    them."""
    text = """
Tanktread:
  Flow: {type: quiescent, pressure gradient: [-1.0, 0.0, 0.0]}
  Domain: {side lengths: [3.0, 3.0, 3.0]}
  Particles:
    post: {shape: cylinder, axis: x3, radius: 0.5, Surface: {azimuthal elements: 12}}
    drop: {radius: 0.4, center: [0.1, 1.5, 0.1], Surface: {elements per side: 3}, Membrane: {law: surface tension, surface tension: 5.0}}
  Time: {scheme: bs3, fixed step: 1.0e-3, final time: 1.0e-3}
"""
    velocity = _first("drop", text, names=["drop/velocity_x1"])[0]
    check(velocity > 0.1, f"velocity {velocity}")
    refused(["Steady", "posts"], deck(text, "steady.yaml"), "--set", "Steady/tolerance=1e-6")


def in_a_flow_that_varies_in_time_series_refer_to_the_current_flow():
    """An amplitude of -1 reverses velocities and the pressure gradient. An angle of 90 degrees about the normal of the
    plates rotates them."""
    names = ["velocity_x1", "velocity_x2", "wall_force_x1", "wall_force_x2", "mean_velocity_x1", "permeability", "flow_power", "power_residual"]
    words = ("gradient: [-1.0, 0.3, 0.0]", "velocity: [0.2, 0.0, 0.0], second velocity: [1.0, 0.5, 0.0]")

    def same(history, gradient, velocities):
        there = CAPSULE
        for word, by in zip(words, (gradient, velocities)):
            there = there.replace(word, by)
        here = CAPSULE.replace(words[0] + "}", f"{words[0]}, history: {{times: [0.0, 0.01], {history}}}}}")
        run(deck(here), "--output", "here", "--overwrite", "--quiet")
        run(deck(there), "--output", "there", "--overwrite", "--quiet")
        for name in names:
            off = abs(series("here", name) - series("there", name)).max()
            check(off < 1e-10 * max(1, abs(series("there", name)).max()), f"{name}: {off}")

    same("amplitudes: [-1.0, -1.0]", "gradient: [1.0, -0.3, 0.0]", "velocity: [-0.2, 0.0, 0.0], second velocity: [-1.0, -0.5, 0.0]")
    same("angles: [90.0, 90.0], axis: x3", "gradient: [-0.3, -1.0, 0.0]", "velocity: [0.0, 0.2, 0.0], second velocity: [-0.5, 1.0, 0.0]")


def a_flow_past_a_post_changes_in_time():
    """The mean velocity and the force on the post are proportional to the amplitude of the pressure gradient. The
    permeability is undefined when the amplitude is zero."""
    text = POST.replace("  Particle: {shape: cylinder", "  Particles:\n    post: {shape: cylinder").replace(
        "\n  Surface: {azimuthal elements: 16, axial elements: 4}\n",
        ", Surface: {azimuthal elements: 16, axial elements: 4}}\n    sphere: {motion: free, radius: 0.1, center: [0.5, 0.5, 0.25], "
        "Surface: {elements per side: 3}}\n").replace("radius: 0.17841241161527712}", "radius: 0.17841241161527712")
    text = text.replace("[-1.0, 0.0, 0.0]}", "[-1.0, 0.0, 0.0], history: {times: [0.0, 0.02], amplitudes: [1.0, 0.0]}}")
    run(deck(text + "  Time: {scheme: bs3, fixed step: 0.01, final time: 0.02}\n"), "--output", "post", "--quiet")
    mean, force = series("post", "mean_velocity_x1"), series("post", "post/post_force_x1")
    for name, one in (("mean velocity", mean), ("force", force)):
        check(abs(one / one[0] - [1, 0.5, 0]).max() < 1e-3, f"{name}: {one}")  # tolerance: the sphere moves slightly
    check(numpy.isnan(series("post", "permeability")[-1]), series("post", "permeability"))


def a_drop_between_plates_is_steady_midway():
    """From two positions off the midplane, the search finds the same shape in the midplane."""
    text = """
Tanktread:
  Flow: {type: simple shear}
  Domain: {periodic: x1 x2, side lengths: [6.0, 5.0, 1.0]}
  Wall: {point: [0.0, 0.0, -1.5], distance: 3.0, elements per period: 8}
  Particle: {viscosity ratio: 2.0, center: [0.3, 0.2, 0.15]}
  Membrane: {law: surface tension, capillary number: 0.1}
  Surface: {elements per side: 3}
  Steady: {}
"""
    run(deck(text), "--output", "steady", "--quiet")
    run(deck(text), "--set", "Particle/center=[0.3, 0.2, -0.1]", "--output", "other", "--quiet")
    check(abs(series("steady", "centroid_x3")[-1]) < 5e-3, series("steady", "centroid_x3"))  # error of the coarse mesh
    for name in ("taylor_inertia", "centroid_x3", "inclination"):
        close(series("steady", name)[-1], series("other", name)[-1], 1e-5, name)


def a_single_moving_plate_causes_a_flow():
    moves = CAPSULE.replace(", pressure gradient: [-1.0, 0.3, 0.0]", "").replace("shear modulus: 5.0", "capillary number: 0.2")
    for given in ("second velocity: [1.0, 0.5, 0.0]", "velocity: [1.0, 0.5, 0.0]"):
        alone = moves.replace("velocity: [0.2, 0.0, 0.0], second velocity: [1.0, 0.5, 0.0]", given)
        check(_first("alone", alone, names=["normal_velocity"])[0] > 0, given)


def impossible_decks_are_rejected():
    refused(["Wall/distance", "Domain"], deck(SPHERE.replace("  Domain: {periodic: x1 x2, side lengths: [16.0, 16.0, 1.0]}\n", "")))
    refused(["Wall and Domain", "normal"], deck(SPHERE.replace("x1 x2", "x1 x3").replace("16.0, 1.0]", "16.0, 16.0]")))
    refused(["Wall/velocity", "along the wall"], deck(SPHERE), "--set", "Wall/velocity=[0, 0, 1]")
    refused(["Flow/pressure gradient", "along the walls"], deck(SPHERE), "--set", "Flow/pressure gradient=[0, 0, 1]")
    refused(["Particles/sphere crosses the wall"], deck(SPHERE), "--set", "Particles/sphere/radius=2.1")
    refused(["Wall/second velocity", "Wall/distance"], deck(SPHERE.replace("distance: 4.0, ", "")), "--set", "Wall/second velocity=[1, 0, 0]")
    refused(["cylinder", "Domain"], deck(POST.replace("  Domain: {side lengths: [1.0, 1.0, 0.5]}\n", "")))
    refused(["Particle/axis", "x1, x2 or x3"], deck(POST.replace("axis: x3, ", "")))
    refused(["touches its own image"], deck(POST), "--set", "Particle/radius=0.5")
    refused(["Flow/pressure gradient", "posts"], deck(CAPSULE.replace("  Wall:", "  Ignored:").replace("  Ignored: {point: [0.0, 0.0, -1.5], distance: 3.0, velocity: [0.2, 0.0, 0.0], second velocity: [1.0, 0.5, 0.0], elements per period: 10}\n", "")))
    refused(["Particle/velocity", "cylinder"], deck(POST), "--set", "Particle/velocity=[1, 0, 0]")
    refused(["Particle/semi-axes", "cylinder"], deck(POST), "--set", "Particle/semi-axes=[1, 1, 2]")
    refused(["Particle/drift", "cylinder"], deck(POST), "--set", "Particle/drift=held")
    refused(["Interface/relaxation", "cylinder"], deck(POST), "--set", "Interface/relaxation=2")
    refused(["Interface/surfactant", "cylinder"], deck(POST), "--set", "Interface/surfactant/elasticity number=0.2")


main()
