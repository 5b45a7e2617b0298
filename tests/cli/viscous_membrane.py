#!/usr/bin/python3
# ranks: 2
# Tests of a membrane with surface viscosity: relaxation of a sphere, dissipation, two ranks, rejected decks.
import numpy

from harness import check, deck, main, refused, run, series

DECK = """
Tanktread:
  Flow: {type: quiescent}
  Particle:
    shape: sphere
    initial shape: {stretch: [1.001, 1.0, 0.999]}
  Membrane: {shear modulus: 1.0, shear viscosity: 0.5}
  Surface: {elements per side: 6}
  Time: {final time: 12.0, tolerance: 1.0e-9}
  Output: {interval: 2.0}
"""


def _rate(results):
    """Returns the decay rate of D between the times 8 and 12, when the fast mode (rate 1.9) has decayed."""
    time, d = series(results, "time"), series(results, "taylor_inertia")
    early, late = numpy.argmin(abs(time - 8)), numpy.argmin(abs(time - 12))
    return -numpy.log(d[late] / d[early]) / (time[late] - time[early])


def a_sphere_relaxes_at_the_rate_of_linear_theory():
    """The harmonic of degree 2 decays at the rate 0.22457708 with the surface shear viscosity eta_s = 0.5, and at
    0.24835904 without it, if both fluids have viscosity 1. The rates are eigenvalues of the linearised 2 x 2 system for
    the normal and the tangential displacement. Time integration schemes agree to 3e-6. The discretisation error is
    1.3e-5 with 8 elements per side, and 3e-5 with 6."""
    for viscosity, expected in (0.5, 0.22457708), (0.0, 0.24835904):
        run(deck(DECK), "--set", f"Membrane/shear viscosity={viscosity}", "--set", "Surface/elements per side=8", "--output", f"at_{viscosity}", "--quiet")
        found = _rate(f"at_{viscosity}")
        check(abs(found - expected) < 2e-5, f"rate {found:.6f} where theory gives {expected:.6f}")


def the_dissipation_in_the_membrane_is_the_loss_of_its_energy():
    """In a fluid at rest, the energy decreases by the dissipation in the fluids and in the membrane. The surface shear
    viscosity is 1000, so that the dissipation in the fluids is only a thousandth of the total."""
    words = ["--set", "Membrane/shear viscosity=1000", "--set", "Membrane/dilatational viscosity=3000", "--set", "Time/final time=1500"]
    run(deck(DECK), *words, "--set", "Output/interval=100", "--output", "thick", "--quiet")
    time, energy, power = (series("thick", name) for name in ("time", "energy", "membrane_dissipation"))
    spent = numpy.sum((power[1:] + power[:-1]) / 2 * numpy.diff(time))
    fallen = energy[0] - energy[-1]
    # tolerance: trapezoidal rule, and the dissipation in the fluids
    check(abs(spent / fallen - 1) < 5e-3, f"{spent} dissipated in the membrane of {fallen}")


def _linear_rates(viscosity, relaxation, dilatational=0.0, harmonic=2):
    """Returns the relaxation rates of a sphere with a Maxwell element, the slowest first. They follow from (4.19) for
    the displacements of the membrane and of the stress-free state of the springs in the Maxwell element."""
    l, size = harmonic, harmonic * (harmonic + 1)

    def pull(shear, area):
        load = numpy.array([[-4 * area, 2 * area * size], [2 * area, -area * size - (size - 2) * shear]])
        waves = numpy.array([[-(l + 1), l], [1, 1]])
        layer = numpy.diag([l / ((2 * l + 1) * (2 * l + 3)), (l + 1) / ((2 * l + 1) * (2 * l - 1))])
        return waves @ layer @ numpy.linalg.inv(waves) @ load

    springs, forget = pull(viscosity / relaxation, dilatational / relaxation), numpy.eye(2) / relaxation
    return sorted(-numpy.linalg.eigvals(numpy.block([[pull(1, 3) + springs, -springs], [forget, -forget]])).real)


def a_viscoelastic_membrane_relaxes_at_the_rate_of_linear_theory():
    for relaxation in 0.2, 2.0:
        words = ["--set", f"Membrane/relaxation time={relaxation}", "--set", "Time/scheme=bs3", "--set", "Time/tolerance=1e-8"]
        run(deck(DECK), *words, "--set", "Time/final time=28", "--output", f"memory_{relaxation}", "--quiet")
        time, d = series(f"memory_{relaxation}", "time"), series(f"memory_{relaxation}", "taylor_inertia")
        early, late = numpy.argmin(abs(time - 22)), numpy.argmin(abs(time - 28))
        found, expected = -numpy.log(d[late] / d[early]) / (time[late] - time[early]), _linear_rates(0.5, relaxation)[0]
        check(abs(found - expected) < 1e-4, f"rate {found:.6f} where theory gives {expected:.6f}")


def modes_of_a_viscoelastic_membrane_are_those_of_linear_theory():
    """The modes of the second harmonic have four different rates. They lie among modes with the rate -1/T. Of the five
    modes with the same rate, two are symmetric about all mirror planes, and three are antisymmetric about two of the
    planes."""
    words = ["--set", "Membrane/dilatational viscosity=0.25", "--set", "Membrane/relaxation time=2", "--set", "Quadrature/tolerance=1e-7"]
    words += ["--set", "Particle/initial shape/stretch=[1, 1, 1]", "--set", "Spectrum/number=4", "--output", "modes", "--quiet", "--overwrite"]

    def errors(n, exact, *more):
        run(deck(DECK.split("  Time")[0]), *words, "--set", f"Surface/elements per side={n}", "--set", f"Spectrum/near={-exact}", *more)
        return numpy.array(sorted(abs(series("modes", f"rate_{k}")[-1] / -exact - 1) for k in range(1, 5)))

    projected = "--set", "Solvers/projection=least squares"
    for exact in _linear_rates(0.5, 2.0, 0.25):
        coarse, fine = errors(3, exact, *projected), errors(4, exact, *projected)
        check(fine[1] < min(1e-3, coarse[1] / 2), exact, coarse, fine)  # for the order 4 the factor would be 1/3
    for parity, n in ("[1, 1, 1]", 2), ("[-1, 1, -1]", 1), ("[1, 1, -1]", 0):
        found = errors(3, exact, "--set", f"Spectrum/parity={parity}")
        check((found < 1e-2).sum() == n, parity, exact, found)


def the_power_of_the_flow_is_stored_or_dissipated_in_a_viscoelastic_membrane():
    """The power balance holds up to the discretisation error of this coarse mesh. In the end, almost all power is
    dissipated, because the energy of the springs no longer changes."""
    words = ["--set", "Membrane/relaxation time=0.5", "--set", "Membrane/dilatational viscosity=0.5", "--set", "Time/scheme=bs3"]
    words += ["--set", "Membrane/shear modulus=4"]
    words += ["--set", "Particle/initial shape/stretch=[1.0, 1.0, 1.0]", "--set", "Time/tolerance=1e-5", "--set", "Time/final time=10"]
    run(deck(DECK), *words, "--set", "Flow/type=simple shear", "--set", "Output/power balance=true", "--output", "power", "--quiet")
    flow, force, heat = (series("power", name) for name in ("flow_power", "force_power", "membrane_dissipation"))
    check(numpy.max(abs(force)) < 1e-10 * numpy.max(abs(flow)), f"the springs count as a force: {force} of {flow}")
    check(abs(series("power", "power_residual")[-1]) < 1e-3, "the balance is off")
    total, stored = series("power", "fluid_dissipation") + heat, numpy.diff(series("power", "energy"))
    check(heat[0] < 1e-12 * heat[-1] and heat[-1] > 0.02 * flow[-1], f"heat {heat} of {flow}")
    check(abs(total[-1] / flow[-1] - 1) < 0.05 and stored[0] > 0, f"{total[-1]} becomes heat of {flow[-1]}")


def _agree(one, other, tolerance):
    for name in "taylor_inertia", "stresslet_13", "membrane_dissipation":
        a, b = series(one, name)[-1], series(other, name)[-1]
        check(abs(a - b) <= tolerance * abs(a), f"{name} is {a} and {b}")


def two_ranks_agree_with_one_and_a_run_is_resumed():
    words = ["--set", "Time/fixed step=0.05", "--set", "Particle/viscosity ratio=2", "--set", "Solvers/tolerance=1e-12", "--set", "Output/interval=0.1"]
    words += ["--set", "Flow/type=simple shear", "--set", "Surface/elements per side=3", "--set", "Time/newton tolerance=1e-3", "--quiet"]
    for kind, more in ("flows", []), ("forgets", ["--set", "Membrane/relaxation time=0.5", "--set", "Time/scheme=bs3"]):
        for ranks in 1, 2:
            run(deck(DECK), *words, *more, "--set", "Time/final time=0.2", "--output", f"{kind}_on_{ranks}", ranks=ranks)
        _agree(f"{kind}_on_1", f"{kind}_on_2", 1e-10)
        run(deck(DECK), *words, *more, "--set", "Time/final time=0.1", "--output", f"{kind}_in_parts")
        run("--resume", f"{kind}_in_parts", "--set", "Time/final time=0.2", "--quiet")
        _agree(f"{kind}_on_1", f"{kind}_in_parts", 1e-12)


def contradictory_decks_are_rejected():
    for setting, sentence in (
        ("Membrane/shear viscosity=-1", "shear viscosity"),
        ("Membrane/load=strong", "it needs loads by virtual work, `weak`"),
    ):
        refused([sentence], deck(DECK), "--set", setting)


main()
