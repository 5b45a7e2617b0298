"""Maps of the atlas about steps in time: how long may they be?"""

import math

from package import PENS, RATIO, SHEAR, SIDE, line, plt, studies, style, ticks, worst

SCHEMES = {"bs3": "explicit, BS3", "crank-nicolson": "Crank–Nicolson, sub-iterated (the paper's)",
           "rkc2": "stabilised explicit, RKC2", "tr-bdf2": "TR-BDF2, quasi-Newton", "bdf3": "BDF3, quasi-Newton"}
PEN = dict(zip(SCHEMES, PENS))


def follows(study, settings, step, reference):
    """Returns whether a run at a fixed step comes to its end and to where steps under control of the error lead: D and
    the energy within 5 %."""
    outcome = study.run(SHEAR, settings | {"Time/fixed step": step})
    return outcome.done and all(abs(outcome.final[name] / reference.final[name] - 1) < 0.05
                                for name in ("taylor_inertia", "energy"))


def largest_step(study, settings, scheme, stiffness):
    """Returns the largest fixed step of a scheme, and what it is (studies.edge). The run is forty times the explicit
    limit long, so that what grows can be seen to grow, and bisection starts around that limit."""
    limit = 2.51 / stiffness
    settings = settings | {"Time/final time": 40 * limit, "Output/interval": 40 * limit}
    reference = study.run(SHEAR, settings | {"Time/scheme": "tr-bdf2"})
    if not reference.done:
        return math.nan, "no reference"
    settings = settings | {"Time/scheme": scheme}
    return studies.edge(lambda step: follows(study, settings, step, reference),
                        (0.1 if scheme == "crank-nicolson" else 0.3) * limit, 10 * limit, 1.1)


def stiffness(ca, n, dilatation=1.0):
    """Returns rho = max(1 + C, 1) k/(2 Ca), k = pi/h, h = pi/(2 n) of (4.5) for elements of the sphere's cube mesh."""
    return (1 + dilatation) * 2 * n / (2 * ca)


def draw_steps(study, variable, label, values, of):
    """Draws the largest step of every scheme over a variable; of(value): settings and stiffness."""
    figure, axis = plt.subplots(figsize=(7.6, 5))
    rows = []
    for scheme in SCHEMES:
        found = [(value, *largest_step(study, of(value)[0], scheme, of(value)[1])) for value in values]
        rows += [(scheme, *one) for one in found]
        axis.plot(values, [step for _, step, _ in found], label=SCHEMES[scheme], **PEN[scheme])
        for value, step, what in found:
            if what != "edge":
                axis.annotate("↑" if what == "holds to here" else "↓", (value, step), (0, 4), ha="center",
                              textcoords="offset points", color=PEN[scheme]["color"])
    axis.plot(values, [2.51 / of(value)[1] for value in values], color=style.FAINT, linestyle=(0, (4, 3)),
              label="2.51/ρ, ρ by (4.5)")
    ticks(axis, values, label)
    axis.set(yscale="log", ylabel="largest step that works, times rate")
    axis.legend(loc="best")
    return figure, ["scheme", variable, "largest_step", "note"], rows


def fixed_step(study):
    """Largest fixed step against the capillary number

    Neo-Hookean capsule in shear, 98 control points. The stiffer the membrane (small Ca) the faster it answers: an
    explicit scheme must follow the fastest mode of the mesh, whose rate is ρ ~ 1/Ca, so Δt ρ ≤ 2.51; the sub-iteration
    of Crank–Nicolson contracts only for Δt ρ < 2, and eight of them have to do, implicit or not.

    Survives: an iteration that knows the stiff part (TR-BDF2 or BDF3 with the frozen Jacobian), whose step is bound by
    accuracy; as many stages as the step needs (RKC2). Arrows: no edge found."""
    return draw_steps(study, "capillary_number", "Ca", [0.02, 0.05, 0.1, 0.2, 0.3, 0.6],
                      lambda ca: ({SIDE: 4, "Membrane/capillary number": ca}, stiffness(ca, 4)))


def fixed_step_dilatation(study):
    """Largest fixed step against Skalak's C

    Skalak capsule in shear, Ca = 0.3, 98 control points. A membrane that resists dilatation has ρ ~ (1 + C)/Ca.

    Survives: the frozen Jacobian, which holds the dilatation."""
    return draw_steps(study, "area_dilatation", "C", [1.0, 3.0, 10.0, 30.0, 100.0], lambda c: (
        {SIDE: 4, "Membrane/law": "Skalak", "Membrane/area dilatation": c}, stiffness(0.3, 4, c)))


def fixed_step_mesh(study):
    """Largest fixed step against the mesh

    Neo-Hookean capsule in shear, Ca = 0.3. Forces of the membrane grow with the wave number, k of (4.5), and finer
    meshes carry shorter waves: the largest step of an explicit scheme and of the sub-iteration halves when elements do.

    Survives: the frozen Jacobian, at a cost that does not depend on the mesh."""
    return draw_steps(study, "elements_per_side", "n, elements along a side of the cube", [3, 4, 5, 6],
                      lambda n: ({SIDE: n}, stiffness(0.3, n)))


def viscosity_ratio(study):
    """Viscosity ratio towards 0 and 100

    Neo-Hookean capsule in shear, Ca = 0.3, 98 control points, to γ̇t = 1. The equation (2.4) for the velocity, (1 − (1
    − λ)H) v = …, loses its breathing mode as λ → 0 and eleven more modes, rigid motions and strains, grow slow as λ →
    ∞. Left: iterations that its solver needs, with the flux taken out of its unknowns (`exact`, `flux`) and without
    (`none`). Right: the volume error of the run.

    Survives: the flux constraint inside the system, which holds the breathing mode; its iterations stay bounded at both
    ends."""
    figure, axes = plt.subplots(1, 2, figsize=(9.6, 4.4))
    base = {SIDE: 4, "Time/final time": 1.0, "Membrane/load measure": "current", "Output/interval": 1.0}
    rows = []
    for constraint, pen in zip(("exact", "none"), PENS):
        jobs = {ratio: (SHEAR, base | {RATIO: ratio, "Volume/constraint": constraint})
                for ratio in (0.001, 0.01, 0.1, 0.3, 3.0, 10.0, 30.0, 100.0)}
        rows += line(study, axes, f"Volume/constraint `{constraint}`", jobs, (
            lambda one: one.counts["velocity_iterations"] / one.counts["evaluations"],
            lambda one: max(worst("volume_error")(one), 1e-16), lambda one: one.counts["steps"]), **pen)
    axes[0].set(xscale="log", xlabel="λ", ylabel="iterations a velocity", ylim=(0, None))
    axes[0].legend(loc="best")
    axes[1].set(xscale="log", yscale="log", xlabel="λ", ylabel="largest volume error")
    return figure, ["constraint", "viscosity_ratio", "iterations_a_velocity", "volume_error", "steps", "message"], rows


MAPS = [fixed_step, fixed_step_dilatation, fixed_step_mesh, viscosity_ratio]
