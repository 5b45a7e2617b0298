"""Maps of the atlas about steps in time: how long may they be?"""

import math

from package import plt, studies, style

SHEAR = "inputs/shear_neo_hookean.yaml"
SCHEMES = {  # pen of each integrator
    "bs3": (style.RUNS[0], "o", "explicit, BS3"),
    "rkc2": (style.RUNS[2], "s", "stabilised explicit, RKC2"),
    "crank-nicolson": (style.RUNS[1], "^", "Crank–Nicolson, sub-iterated (the paper's)"),
    "bdf3": (style.RUNS[4], "v", "BDF3, quasi-Newton"),
    "tr-bdf2": (style.RUNS[3], "D", "TR-BDF2, quasi-Newton"),
}


def follows(study, deck, settings, step, reference):
    """Whether a run at a fixed step comes to its end and to where steps under control of the error lead: D and the
    energy within 5 %."""
    outcome = study.run(deck, settings | {"Time/fixed step": step})
    if not outcome.done:
        return False
    return all(abs(outcome.final[name] - reference.final[name]) < 0.05 * abs(reference.final[name])
               for name in ("taylor_inertia", "energy"))


def largest_step(study, settings, scheme, stiffness):
    """The largest fixed step of a scheme, and what it is (study.edge). The run is forty times the explicit limit long,
    so that what grows can be seen to grow, and bisection starts around that limit."""
    limit = 2.51 / stiffness
    settings = settings | {"Time/final time": 40 * limit, "Output/interval": 40 * limit}
    reference = study.run(SHEAR, settings | {"Time/scheme": "tr-bdf2"})
    if not reference.done:
        return math.nan, "no reference"
    settings = settings | {"Time/scheme": scheme}
    return studies.edge(lambda step: follows(study, SHEAR, settings, step, reference),
                        (0.1 if scheme == "crank-nicolson" else 0.3) * limit, 10 * limit, 1.1)


def stiffness(ca, n, dilatation=1.0):
    """(4.5) for elements of the sphere's cube mesh: rho = max(1 + C, 1) k/(2 Ca), k = pi/h, h = pi/(2 n)."""
    return (1 + dilatation) * 2 * n / (2 * ca)


def draw_steps(study, variable, label, values, of):
    """Largest step of every scheme over a variable; of(value): settings and stiffness."""
    figure, axis = plt.subplots(figsize=(7.6, 5))
    rows = []
    for scheme in study.schemes(SCHEMES):
        color, mark, name = SCHEMES[scheme]
        found = [(value, *largest_step(study, of(value)[0], scheme, of(value)[1])) for value in values]
        rows += [(scheme, value, step, what) for value, step, what in found]
        axis.loglog([value for value, _, _ in found], [step for _, step, _ in found], color=color, marker=mark, ms=5,
                    label=name)
        for value, step, what in found:
            if what != "edge":
                axis.annotate("↑" if what == "holds to here" else "↓", (value, step), (0, 4),
                              textcoords="offset points", ha="center", color=color)
    axis.loglog(values, [2.51 / of(value)[1] for value in values], color=style.FAINT, linestyle=(0, (4, 3)),
                label="2.51/ρ, ρ by (4.5)")
    axis.set_xticks(values, [f"{value:g}" for value in values])
    axis.xaxis.set_minor_locator(plt.NullLocator())
    axis.set(xlabel=label, ylabel="largest step that works, times rate")
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
                      lambda ca: ({"Surface/elements per side": 4, "Membrane/capillary number": ca}, stiffness(ca, 4)))


def fixed_step_dilatation(study):
    """Largest fixed step against Skalak's C

    Skalak capsule in shear, Ca = 0.3, 98 control points. A membrane that resists dilatation has ρ ~ (1 + C)/Ca.

    Survives: the frozen Jacobian, which holds the dilatation."""
    def of(c):
        return {"Surface/elements per side": 4, "Membrane/law": "Skalak",
                "Membrane/area dilatation": c}, stiffness(0.3, 4, c)
    return draw_steps(study, "area_dilatation", "C", [1.0, 3.0, 10.0, 30.0, 100.0], of)


def fixed_step_mesh(study):
    """Largest fixed step against the mesh

    Neo-Hookean capsule in shear, Ca = 0.3. Forces of the membrane grow with the wave number, k of (4.5), and finer
    meshes carry shorter waves: the largest step of an explicit scheme and of the sub-iteration halves when elements do.

    Survives: the frozen Jacobian, at a cost that does not depend on the mesh."""
    return draw_steps(study, "elements_per_side", "n, elements along a side of the cube", [3, 4, 5, 6],
                      lambda n: ({"Surface/elements per side": n}, stiffness(0.3, n)))


def viscosity_ratio(study):
    """Viscosity ratio towards 0 and 100

    Neo-Hookean capsule in shear, Ca = 0.3, 98 control points, to γ̇t = 1. The equation (2.4) for the velocity, (1 − (1
    − λ)H) v = …, loses its breathing mode as λ → 0 and eleven more modes, rigid motions and strains, grow slow as λ →
    ∞. Left: iterations that its solver needs, with the flux taken out of its unknowns (`exact`, `flux`) and without
    (`none`). Right: steps of the run and its volume error.

    Survives: the flux constraint inside the system, which holds the breathing mode; its iterations stay bounded at both
    ends."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.6, 4.4))
    ratios = [0.001, 0.01, 0.1, 0.3, 3.0, 10.0, 30.0, 100.0]
    rows = []
    for constraint, color in (("exact", style.RUNS[0]), ("none", style.RUNS[1])):
        found = []
        for ratio in ratios:
            outcome = study.run(SHEAR, {"Surface/elements per side": 4, "Particle/viscosity ratio": ratio,
                                        "Time/final time": 1.0, "Membrane/load measure": "current",
                                        "Volume/constraint": constraint, "Output/interval": 1.0})
            if outcome.done:
                iterations = outcome.counts["velocity_iterations"] / max(outcome.counts.get("evaluations"), 1)
                found.append((ratio, iterations, outcome.counts["steps"], abs(outcome.series["volume_error"]).max()))
            rows.append((constraint, ratio, *(found[-1][1:] if outcome.done else ("", "", "")), outcome.message[:80]))
        left.semilogx([one[0] for one in found], [one[1] for one in found], "o-", color=color, ms=4,
                      label=f"Volume/constraint `{constraint}`")
        right.loglog([one[0] for one in found], [max(one[3], 1e-16) for one in found], "o-", color=color, ms=4)
    left.set(xlabel="λ", ylabel="iterations a velocity", ylim=(0, None))
    left.legend(loc="best")
    right.set(xlabel="λ", ylabel="largest volume error")
    return figure, ["constraint", "viscosity_ratio", "iterations_a_velocity", "steps", "volume_error", "message"], rows


MAPS = [fixed_step, fixed_step_dilatation, fixed_step_mesh, viscosity_ratio]
