#!/usr/bin/python3
# ranks: 2
# Tests of drops with a viscous interface: steady shapes in slow flows, power balance, schemes, surfactant, several
# particles, ranks, rejected decks.
import math

from harness import check, deck, main, refused, run, series

DECK = """
Tanktread:
  Flow: {type: simple shear}
  Particle: {shape: sphere, viscosity ratio: 2.0}
  Membrane: {law: surface tension, capillary number: 0.1, shear viscosity: 1.0, dilatational viscosity: 0.5}
  Surface: {elements per side: 6}
"""
STEADY = DECK + "  Steady: {}\n"
RUN = DECK + "  Time: {final time: 0.3, tolerance: 1.0e-5}\n  Output: {interval: 0.3}\n"


def _set(**values):
    """Returns command-line arguments that set keys. `Membrane__shear_viscosity` stands for Membrane/shear viscosity."""
    return [word for key, value in values.items() for word in ("--set", f"{key.replace('__', '/').replace('_', ' ')}={value}")]


def _last(name, results):
    return series(results, name)[-1]


def _deformation(capillary, ratio, shear, dilatational):
    """Returns D in a slow simple shear (3.28)."""
    w = 5 / (5 + 5 * ratio + 6 * dilatational + 4 * shear)
    return capillary / 8 * (5 + (3 + 4.5 * ratio + 6 * dilatational) * w)


def steady_shapes_in_slow_flows_agree_with_small_deformation_theory():
    """In shear, D/Ca is an even function of Ca, because reversing the flow mirrors the shape; one value, Ca = 1e-3, is
    therefore enough. In extension, the limit is extrapolated from three values. The discretisation error is 5e-5 to
    9e-5."""
    for motion, ratio, shear, dilatational in ("relaxed", 0.4, 1.5, 0.5), ("normal", 3, 0.5, 2):
        more = _set(Particle__viscosity_ratio=ratio, Membrane__shear_viscosity=shear, Membrane__dilatational_viscosity=dilatational)
        more += _set(Interface__motion=motion) + ["--quiet"]
        exact = _deformation(1, ratio, shear, dilatational)
        run(deck(STEADY), *more, *_set(Membrane__capillary_number=1e-3), "--output", f"shear_{motion}")
        found = _last("taylor_inertia", f"shear_{motion}") / 1e-3
        check(abs(found / exact - 1) < 1e-4, f"D/Ca is {found} in shear where theory gives {exact}")
        slopes = []
        for capillary in 1e-3, 2e-3, 4e-3:
            words = ["--set", "Flow/type=uniaxial extension"] + _set(Membrane__capillary_number=capillary)
            run(deck(STEADY), *more, *words, "--output", f"drawn_{motion}_{capillary}")
            slopes.append(_last("taylor_inertia", f"drawn_{motion}_{capillary}") / capillary)
        found = (8 * slopes[0] - 6 * slopes[1] + slopes[2]) / 3
        check(abs(found / (1.5 * exact) - 1) < 1e-4, f"D/Ca is {found} in extension where theory gives {1.5 * exact}")


def the_power_of_the_flow_is_dissipated_in_fluids_and_interface():
    """With 6 elements per side, the residual of the power balance is below 1e-4. It decreases with the fourth power of
    the element size."""
    residuals = []
    for n in 4, 6:
        run(deck(STEADY), *_set(Surface__elements_per_side=n, Output__power_balance="true"), "--output", f"power_{n}", "--quiet")
        residuals.append(abs(_last("power_residual", f"power_{n}")))
    order = math.log(residuals[0] / residuals[1]) / math.log(6 / 4)
    check(residuals[1] < 1e-4 and order > 3.5, f"{residuals} is lacking, order {order}")
    flow, fluids, interface = (_last(name, "power_6") for name in ("flow_power", "fluid_dissipation", "membrane_dissipation"))
    check(interface > 0.04 * flow, f"{interface} becomes heat in the interface of {flow}")
    # discretisation error; D has an error of 6e-5
    check(abs((fluids + interface) / flow - 1) < 1e-4, f"{fluids} and {interface} become heat of {flow}")


def implicit_and_explicit_schemes_agree():
    """The mesh has the motion `relaxed` or `material`. The dissipation in the interface must be computed from the
    velocity of the fluid. The error of each scheme is below three times Time/tolerance."""
    found = {}
    for motion, scheme in ("relaxed", "tr-bdf2"), ("relaxed", "bdf3"), ("relaxed", "bs3"), ("material", "bdf3"):
        name = f"{motion}_{scheme}"
        words = _set(Interface__motion=motion, Time__scheme=scheme, Output__power_balance="true")
        run(deck(RUN), *words, "--output", name, "--quiet")
        found[name] = [_last(key, name) for key in ("taylor_inertia", "membrane_dissipation", "stresslet_13")]
        check(abs(_last("power_residual", name)) < 1e-4, f"{name}: {_last('power_residual', name)} is lacking")
    for name, values in found.items():
        for one, other in zip(values, found["relaxed_bs3"]):
            # measured relative differences: 3e-5 for the motion `relaxed`, 4e-4 for the motion `material`
            check(abs(one / other - 1) < 1e-3, f"{name}: {one} where bs3 has {other}")


def a_surfactant_on_a_viscous_interface():
    words = ["--set", "Interface/surfactant={elasticity number: 0.3, Peclet number: 10}"]
    words += _set(Time__scheme="rkc2", Output__power_balance="true")
    run(deck(RUN), *words, "--output", "laden", "--quiet")
    check(abs(_last("power_residual", "laden")) < 1e-4, f"{_last('power_residual', 'laden')} is lacking")
    check(_last("largest_concentration", "laden") > 1.02, "hardly any surfactant is swept away")


def loads_of_viscous_membranes_per_current_area_agree_with_those_per_reference_area():
    """Both measures give the same load up to the discretisation error."""
    found = []
    for measure in "reference", "current":
        words = _set(Membrane__law="Skalak", Membrane__load_measure=measure, Surface__elements_per_side=4, Time__final_time=1.2)
        run(deck(RUN), *words, "--output", measure, "--quiet")
        found.append(_last("taylor_inertia", measure))
    check(1e-9 < abs(found[0] / found[1] - 1) < 1e-4, f"measures give a D of {found}")


SEVERAL = """
Tanktread:
  Flow: {type: simple shear}
  Domain: {side lengths: [5.0, 5.0, 5.0]}
  Particles:
    defaults: {Surface: {elements per side: 4}}
    drop: {center: [0.0, 0.0, 1.2], viscosity ratio: 3.0, Membrane: {law: surface tension, capillary number: 0.2, shear viscosity: 1.0}}
    capsule: {center: [0.0, 0.0, -1.2], Membrane: {law: Skalak, capillary number: 0.2, dilatational viscosity: 1.0}}
  Time: {fixed step: 0.05, final time: 0.1, newton tolerance: 1.0e-3}
  Solvers: {tolerance: 1.0e-12}
  Output: {interval: 0.05}
"""


def two_ranks_agree_with_one_and_a_run_is_resumed():
    for ranks in 1, 2:
        run(deck(SEVERAL), "--output", f"on_{ranks}", "--quiet", ranks=ranks)
    run(deck(SEVERAL), *_set(Time__final_time=0.05), "--output", "parts", "--quiet")
    run("--resume", "parts", *_set(Time__final_time=0.1), "--quiet")
    for name in "drop/membrane_dissipation", "capsule/membrane_dissipation", "drop/taylor_inertia", "stresslet_13":
        whole = _last(name, "on_1")
        for other in "on_2", "parts":
            check(abs(_last(name, other) / whole - 1) < 1e-10, f"{name} is {_last(name, other)} in {other} and {whole}")


def contradictory_decks_are_rejected():
    for setting, sentence in (
        ("Membrane/load=strong", "it needs loads by virtual work, `weak`"),
        ("Membrane/relaxation time=1", "the interface has no stress-free shape"),
    ):
        refused([sentence], deck(RUN), "--set", setting)


main()
