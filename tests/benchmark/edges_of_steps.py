"""Maps of the atlas about steps in time, how long they may be, and about accuracy asked for: of a step, of the
integrals, of the volume."""

import math

from package import PENS, RATIO, SHEAR, SIDE, line, lines, panels, studies, style, ticks, worst

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
    figure, (axis,) = panels(given)
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
    ticks(axis, values)
    axis.legend(loc="best")
    return figure, rows


def fixed_step(study, given):
    return draw_steps(study, given, lambda ca: ({SIDE: 4, "Membrane/capillary number": ca}, stiffness(ca, 4)))


def fixed_step_dilatation(study, given):
    return draw_steps(study, given, lambda c: (
        {SIDE: 4, "Membrane/law": "Skalak", "Membrane/area dilatation": c}, stiffness(0.3, 4, c)))


def fixed_step_mesh(study, given):
    return draw_steps(study, given, lambda n: ({SIDE: n}, stiffness(0.3, n)))


def viscosity_ratio(study, given):
    figure, axes = panels(given)
    rows = lines(study, axes, given, lambda ratio: {RATIO: ratio}, (
        lambda one: one.counts["velocity_iterations"] / one.counts["evaluations"],
        lambda one: max(worst("volume_error")(one), 1e-16), lambda one: one.counts["steps"]))
    axes[0].set_ylim(0, None)
    axes[0].legend(loc="best")
    return figure, rows


def _error(reference):
    return lambda outcome: max(abs(outcome.final["taylor_inertia"] - reference.final["taylor_inertia"]), 1e-9)


def step_tolerance(study, given):
    reference = study.run(SHEAR, given["base"] | {"Time/tolerance": 1e-7})
    measures = _error(reference), lambda one: one.counts["evaluations"], worst("volume_error")
    figure, axes = panels(given)
    rows = []
    for scheme in ("bs3", "rkc2", "tr-bdf2", "bdf3"):
        for constraint, words, dash, shown in ("exact", "", "-", axes[:2]), ("flux", ", `flux`", ":", axes):
            settings = given["base"] | {"Time/scheme": scheme, "Volume/constraint": constraint}
            jobs = {tolerance: settings | {"Time/tolerance": tolerance} for tolerance in given["values"]}
            rows += line(study, shown, SCHEMES[scheme] + words, SHEAR, jobs, measures, linestyle=dash, **PEN[scheme])
    for axis in axes:
        axis.invert_xaxis()
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles[::2], labels[::2], loc="upper right", ncols=3, fontsize=7, title="dotted: constraint `flux`",
                  title_fontsize=7, bbox_to_anchor=(1, 1.012), labelspacing=0.25)
    return figure, rows


def quadrature_tolerance(study, given):
    figure, (left, right) = panels(given)
    rules = (left, {tolerance: {"Quadrature/tolerance": tolerance} for tolerance in given["tolerances"]}), (
        right, {points: {"Quadrature/points": points, "Quadrature/rule": "fixed"} for points in given["points"]})
    rows = []
    for (name, settings), pen in zip(given["cases"].items(), PENS):
        settings = given["base"] | settings
        reference = study.run(SHEAR, settings | {"Quadrature/tolerance": 1e-9})
        for axis, chosen in rules:
            jobs = {value: settings | rule for value, rule in chosen.items()}
            rows += line(study, [axis], f"D, constraint `{name}`", SHEAR, jobs, (_error(reference),), **pen)
            if name == "none":
                rows += line(study, [axis], "volume, constraint `none`", SHEAR, jobs, (worst("volume_error"),),
                             linestyle=":", mfc="none", **pen)
    left.invert_xaxis()
    left.legend(loc="best")
    return figure, rows


def volume_drift(study, given):
    figure, (left, right) = panels(given)
    rows = []
    for (constraint, settings), color in zip(given["cases"].items(), style.RUNS):
        series = study.run(SHEAR, given["base"] | settings).series
        t, error, d = (series[name] for name in ("time", "volume_error", "taylor_inertia"))
        left.plot(t[1:], abs(error[1:]).clip(1e-16), color=color, label=f"`{constraint}`")
        right.plot(t, d, color=color)
        rows += [(constraint, *values) for values in zip(t, error, d)]
    left.legend(loc="center right")
    right.set_ylim(0.45, 0.6)
    return figure, rows
