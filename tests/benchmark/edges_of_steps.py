"""Maps of the atlas about steps in time: how long may they be?"""

import math

from package import PENS, RATIO, SHEAR, SIDE, lines, plt, studies, style, ticks, worst

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


def draw_steps(study, given, of):
    """Draws the largest step of every scheme over the values of a variable; of(value): settings and stiffness."""
    figure, axis = plt.subplots(figsize=(7.6, 5))
    values, rows = given["values"], []
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
    ticks(axis, values, given["label"])
    axis.set(yscale="log", ylabel="largest step that works, times rate")
    axis.legend(loc="best")
    return figure, ["scheme", given["variable"], "largest_step", "note"], rows


def fixed_step(study, given):
    return draw_steps(study, given, lambda ca: ({SIDE: 4, "Membrane/capillary number": ca}, stiffness(ca, 4)))


def fixed_step_dilatation(study, given):
    return draw_steps(study, given, lambda c: (
        {SIDE: 4, "Membrane/law": "Skalak", "Membrane/area dilatation": c}, stiffness(0.3, 4, c)))


def fixed_step_mesh(study, given):
    return draw_steps(study, given, lambda n: ({SIDE: n}, stiffness(0.3, n)))


def viscosity_ratio(study, given):
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.6, 4.4))
    rows = lines(study, (left, right), given, lambda ratio: {RATIO: ratio}, (
        lambda one: one.counts["velocity_iterations"] / one.counts["evaluations"],
        lambda one: max(worst("volume_error")(one), 1e-16), lambda one: one.counts["steps"]))
    left.set(xscale="log", xlabel="λ", ylabel="iterations a velocity", ylim=(0, None))
    left.legend(loc="best")
    right.set(xscale="log", yscale="log", xlabel="λ", ylabel="largest volume error")
    return figure, ["constraint", "viscosity_ratio", "iterations_a_velocity", "volume_error", "steps", "message"], rows
