#!/usr/bin/python3
# ranks: 2
# Tests of surfactants and Maxwell elements: implicit schemes, several particles, adaptive meshes, steady shapes.
import numpy
import yaml

from harness import check, deck, main, run, series, summary

DROP = {"shape": "sphere", "Membrane": {"law": "surface tension", "capillary number": 0.1}, "Surface": {"elements per side": 4},
        "Interface": {"surfactant": {"elasticity number": 0.3, "diffusivity": 0.1}}}
CAPSULE = {"shape": "sphere", "Surface": {"elements per side": 3},
           "Membrane": {"law": "neo-Hookean", "capillary number": 0.3, "shear viscosity": 0.5, "relaxation time": 0.3}}
STEPS = {"Time": {"scheme": "tr-bdf2", "fixed step": 0.1, "final time": 0.4}}


def _one(particle, **more):
    """Returns the path of a deck with one particle."""
    lists = {name: particle[name] for name in ("Membrane", "Surface", "Interface") if name in particle}
    own = {name: value for name, value in particle.items() if name not in lists}
    return _deck(Particle=own, **lists, **more)


def _deck(**more):
    scene = {"Flow": {"type": "simple shear"}, "Time": {"scheme": "tr-bdf2", "tolerance": 1e-5, "final time": 0.4}, "Output": {"interval": 0.2}}
    return deck(yaml.safe_dump({"Tanktread": {**scene, **more}}), f"{len(str(more))}.yaml")


def _two(particle, apart):
    return _deck(Particles={"a": particle, "b": {**particle, "center": apart}}, **STEPS)


def distant_particles_behave_like_single_ones():
    for particle, names in (DROP, ("taylor_inertia", "largest_concentration")), (CAPSULE, ("taylor_inertia", "membrane_dissipation")):
        for output, text in ("one", _one(particle, Symmetry={"use": "none"}, **STEPS)), ("two", _two(particle, [0, 1000, 0])):
            run(text, "--output", output, "--quiet", "--overwrite")
        for name in names:
            off = abs(series("two", "b/" + name) - series("one", name)).max() / abs(series("one", name)).max()
            # a stresslet of 10 changes the velocity gradient at a distance of 1000 by 10/(8 pi) 1000^-3
            check(off < 1e-9, f"{name} differs by {off}")


def implicit_and_explicit_steps_agree():
    for particle, names in (DROP, ("taylor_inertia", "largest_concentration")), (CAPSULE, ("taylor_inertia", "energy")):
        for scheme in "tr-bdf2", "bdf3", "bs3":
            run(_one(particle), "--set", f"Time/scheme={scheme}", "--set", "Time/tolerance=1e-6", "--output", scheme, "--quiet", "--overwrite")
        for scheme in "tr-bdf2", "bdf3":
            for name in names:
                off = abs(series(scheme, name)[-1] / series("bs3", name)[-1] - 1)
                # The difference is about thirty times the tolerance, because the energy, to which it is relative, is
                # still small.
                check(off < 1e-4, f"{name} of {scheme} differs by {off}")
            if particle is DROP:
                mass = series(scheme, "surfactant_mass")
                check(abs(mass - 1).max() < 1e-12, f"the mass is off by {abs(mass - 1).max()}")


def ranks_and_resumed_runs_agree():
    for particle in DROP, CAPSULE:
        text = _two(particle, [2.5, 0, 0.5])
        for ranks in 1, 2:
            run(text, "--output", f"on_{ranks}", "--quiet", "--overwrite", ranks=ranks)
        run(text, "--set", "Time/final time=0.2", "--output", "parts", "--quiet", "--overwrite")
        run("--resume", "parts", "--set", "Time/final time=0.4", "--quiet")
        for other, most in ("on_2", 1e-10), ("parts", 0):
            off = abs(series(other, "a/taylor_inertia") - series("on_1", "a/taylor_inertia")).max()
            check(off <= most, f"{other} differs by {off}")


def a_steady_search_finds_the_final_shape_of_a_run():
    flow = {"Flow": {"type": "uniaxial extension"}}
    slow = {**DROP, "Membrane": {"law": "surface tension", "capillary number": 0.05}}
    run(_one(slow, **flow, Steady={"tolerance": 1e-8}, Time={}), "--output", "steady", "--quiet")
    run(_one(slow, **flow, Time={"scheme": "tr-bdf2", "tolerance": 1e-6, "steady tolerance": 1e-7, "final time": 60}, Output={"interval": 60}),
        "--output", "run", "--quiet")
    for name in "taylor_inertia", "largest_concentration", "smallest_concentration":
        off = abs(series("steady", name)[-1] - series("run", name)[-1])
        check(off < 1e-5, f"{name} differs by {off}")  # ten times Time/tolerance
    check(abs(series("steady", "surfactant_mass")[-1] - 1) < 1e-12, "the mass is off")


def adaptive_meshes_conserve_the_mass():
    flow = {"Flow": {"type": "uniaxial extension"}, "Adaptation": {"enabled": True}}
    strong = {**DROP, "Membrane": {"law": "surface tension", "capillary number": 0.2}}
    run(_one(strong, **flow, Time={"scheme": "tr-bdf2", "final time": 1}), "--output", "adapted", "--quiet")
    points = series("adapted", "n_control_points")
    check(points[-1] != points[0], "the mesh is still the first one")
    mass = series("adapted", "surfactant_mass")
    check(abs(mass - 1).max() < 1e-12, f"the mass is off by {abs(mass - 1).max()}")
    largest = series("adapted", "largest_concentration")
    check(numpy.all(numpy.diff(largest) > -1e-3), "the concentration jumps where the mesh changes")


def _theory(l, tension, elasticity, diffusivity):
    """Returns the matrix of d(f, g)/dt for a nearly spherical drop, where f and g are the amplitudes of the harmonic of
    degree l in the radius and in the concentration; see tests/verify/surfactant.cpp. The diffusion term holds for l =
    2."""
    mobility = numpy.array([[10 * (l + 1), 6 * (3 * l + 2)], [3 * l + 2, 13 * l + 12]]) / ((19 * l + 16) * (2 * l + 3))
    load, motion = numpy.array([[-4, 2 * elasticity], [0, -elasticity]]), numpy.array([[1, 0], [-2, 6]])
    return tension * motion @ mobility @ load - numpy.diag([0, 6 * diffusivity])


def modes_of_a_drop_at_rest_are_those_of_linear_theory():
    """The second harmonics of shape and concentration on a sphere decay together. Only the first harmonic of the concentration decays more slowly."""
    text = """Tanktread:
  Flow: {type: quiescent}
  Particle: {viscosity ratio: %g}
  Membrane: {law: surface tension, surface tension: 1.5}
  Interface: {surfactant: {elasticity number: 0.3, diffusivity: 0.05}}
  Surface: {elements per side: %d}
  Quadrature: {tolerance: 1.0e-7}
  Solvers: {projection: least squares, tolerance: 1.0e-9}
  Spectrum: {number: 12}
"""
    for l in 1, 4:
        exact = numpy.linalg.eigvals(_theory(l, 0.7 * 1.5, 0.3 / 0.7, 0.05))
        errors = []
        for n in 3, 6:
            run(deck(text % (l, n)), "--output", f"on_{n}", "--quiet", "--overwrite")
            rates = [series(f"on_{n}", f"rate_{k}")[-1] for k in range(1, 13)]
            errors.append(max(min(abs(rate / e - 1) for rate in rates) for e in exact))
        check(errors[1] < min(1e-5, errors[0] / 8), errors)
        kinds = list(summary("on_6")["modes"].values())
        check(kinds.count("mass") == kinds.count("volume") == 1, kinds)


main()
