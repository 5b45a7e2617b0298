"""Maps of the atlas about steps in time, how long they may be, and about accuracy asked for: of a step, of the
integrals, of the volume."""

import math

from package import PENS, SHEAR, SIDE, line, lines, numpy, studies, style, varied

SCHEMES = {"bs3": "explicit, BS3", "crank-nicolson": "Crank–Nicolson, sub-iterated (the paper's)",
           "rkc2": "stabilised explicit, RKC2", "tr-bdf2": "TR-BDF2, quasi-Newton", "bdf3": "BDF3, quasi-Newton"}
PEN = dict(zip(SCHEMES, PENS))


def stiffness(settings):
    """Returns rho = max(1 + C, 1) k/(2 Ca), k = pi/h, h = pi/(2 n) of (4.5) for elements of the sphere's cube mesh."""
    return (1 + settings.get("Membrane/area dilatation", 1.0)) * settings[SIDE] / settings.get(
        "Membrane/capillary number", 0.3)


def largest_step(study, settings, scheme):
    """Returns the largest fixed step of a scheme, and what it is (studies.edge): with it a run comes to its end and to
    where steps under control of the error lead, D and the energy within 5 %. The run is forty times the explicit limit
    long, so that what grows can be seen to grow, and bisection starts around that limit."""
    limit = 2.51 / stiffness(settings)
    settings = settings | {"Time/final time": 40 * limit, "Output/interval": 40 * limit}
    reference = study.run(SHEAR, settings | {"Time/scheme": "tr-bdf2"})
    if not reference.done:
        return math.nan, "no reference"

    def follows(step):
        outcome = study.run(SHEAR, settings | {"Time/scheme": scheme, "Time/fixed step": step})
        return outcome.done and all(abs(outcome.final[name] / reference.final[name] - 1) < 0.05
                                    for name in ("taylor_inertia", "energy"))

    return studies.edge(follows, (0.1 if scheme == "crank-nicolson" else 0.3) * limit, 10 * limit, 1.1)


def largest_steps(study, given, axes):
    jobs = {value: given["base"] | more for value, more in varied(given).items()}
    for scheme, pen in PEN.items():
        found = [(value, *largest_step(study, settings, scheme)) for value, settings in jobs.items()]
        yield from ((scheme, *one) for one in found)
        axes[0].plot(list(jobs), [step for _, step, _ in found], label=SCHEMES[scheme], **pen)
        for value, step, what in found:
            if what != "edge":
                axes[0].annotate("↑" if what == "holds to here" else "↓", (value, step), (0, 4), ha="center",
                                 textcoords="offset points", color=pen["color"])
    axes[0].plot(list(jobs), [2.51 / stiffness(settings) for settings in jobs.values()], label="2.51/ρ, ρ by (4.5)",
                 **style.GUIDE)


def worst(name):
    """Returns the measure of `line` that is the largest absolute value of a series over the run."""
    return lambda outcome: numpy.nanmax(abs(outcome.series[name]))


def error_from(reference):
    """Returns the measure of `line` that is the error of D at the end."""
    return lambda outcome: max(abs(outcome.final["taylor_inertia"] - reference.final["taylor_inertia"]), 1e-9)


def viscosity_ratio(study, given, axes):
    return lines(study, axes, given, (
        lambda one: one.counts["velocity_iterations"] / one.counts["evaluations"],
        lambda one: max(worst("volume_error")(one), 1e-16), lambda one: one.counts["steps"]))


def step_tolerance(study, given, axes):
    reference = study.run(SHEAR, given["base"] | {"Time/tolerance": 1e-7})
    measures = error_from(reference), lambda one: one.counts["evaluations"], worst("volume_error")
    for scheme in "bs3", "rkc2", "tr-bdf2", "bdf3":
        for constraint, words, look, shown in ("exact", "", {}, axes[:2]), (
                "flux", ", `flux`", {"linestyle": ":", "label": None}, axes):
            settings = given["base"] | {"Time/scheme": scheme, "Volume/constraint": constraint}
            jobs = {tolerance: settings | more for tolerance, more in varied(given).items()}
            yield from line(study, shown, SCHEMES[scheme] + words, SHEAR, jobs, measures, **PEN[scheme] | look)


def quadrature_tolerance(study, given, axes):
    for (name, settings), pen in zip(given["cases"].items(), PENS):
        settings = given["base"] | settings
        reference = study.run(SHEAR, settings | {"Quadrature/tolerance": 1e-9})
        for axis, rules in zip(axes, given["rules"]):
            jobs = {value: settings | rule for value, rule in rules.items()}
            yield from line(study, [axis], f"D, constraint `{name}`", SHEAR, jobs, [error_from(reference)], **pen)
            if name == "none":
                yield from line(study, [axis], "volume, constraint `none`", SHEAR, jobs, [worst("volume_error")],
                                linestyle=":", mfc="none", **pen)


def volume_drift(study, given, axes):
    for (constraint, settings), color in zip(given["cases"].items(), style.RUNS):
        series = study.run(SHEAR, given["base"] | settings).series
        t, error, d = (series[name] for name in ("time", "volume_error", "taylor_inertia"))
        axes[0].plot(t[1:], abs(error[1:]).clip(1e-16), color=color, label=f"`{constraint}`")
        axes[1].plot(t, d, color=color)
        yield from ((constraint, *values) for values in zip(t, error, d))
