"""Maps of the atlas about the numerical method: poles, thin bodies, tips, convected meshes, size of time steps, and
tolerances of time steps, of integrals and of the volume."""

import math

from package import PENS, SHEAR, SIDE, draw, line, lines, numpy, studies, style, varied

LOOKS = [(style.FAINT, "-", 3.5), (style.RUNS[1], "--", 1.4), (style.RUNS[3], "--", 1.4), (style.RUNS[0], "-", 1.4)]
SCHEMES = {"bs3": "explicit, BS3", "crank-nicolson": "Crank–Nicolson, sub-iterated (the paper's)",
           "rkc2": "stabilised explicit, RKC2", "tr-bdf2": "TR-BDF2, quasi-Newton", "bdf3": "BDF3, quasi-Newton"}
PEN = dict(zip(SCHEMES, PENS))


def pole_treatment(study, given, axes):
    pens = [pen | {"linestyle": "--" if "Gauss" in name else "-"} for name, pen in zip(given["cases"], PENS)]
    return lines(study, axes, given, ("pressure_l2_error", "drag_error"), "n_control_points", pens)


def gap(study, given, axes):
    tight = {h: given["base"] | thin | {"Quadrature/tolerance": 1e-10} for h, thin in varied(given).items()}
    rows = line(study, axes[:1], "the mesh", given["deck"], tight, ("drag_error", "drag_x1"), **style.GUIDE)
    true = {h: drag for _, h, _, drag, _ in rows}
    return rows + lines(study, axes, given, (
        lambda one: abs(one.final["drag_x1"] / true[one.run.value("Particle/semi-axes")[2]] - 1),
        lambda one: one.kernel_evaluations))


def gap_tube(study, given, axes):
    finer = {gap: radius | given["base"] | given["reference"] for gap, radius in varied(given).items()}
    rows = line(study, [], "n = 9", given["deck"], finer, ("velocity_x1",))
    true = {gap: velocity for _, gap, velocity, _ in rows} | given["exact"]
    return rows + lines(study, axes, given, [
        lambda one: abs(one.final["velocity_x1"] / true[round(1 - one.run.value("Particle/radius"), 2)] - 1)])


def hyperbolic(study, given, axes):
    return lines(study, axes, given, (
        lambda one: one.run.snapshots()[-1].fields["mean curvature"].min(), "smallest_tension", "taylor_inertia",
        "n_control_points"))


def tip_traction(study, given, axes):
    truth = None
    for (name, settings), (color, dash, width) in zip(given["cases"].items(), LOOKS):
        outcome = study.run(given["deck"], given["base"] | settings)
        if not outcome.done:
            yield name, "", "", "", outcome.message[:100]
            continue
        place, height, size = draw.near_tip(outcome.run.snapshots()[-1], "traction")
        truth = truth or (height, size)
        error = numpy.max(abs(numpy.interp(truth[0], height, size) - truth[1])) / truth[1].max()
        yield name, outcome.final["n_control_points"], error, outcome.final["taylor_inertia"], ""
        for axis, values in zip(axes, (place, size)):
            axis.plot(height, values, dash, color=color, linewidth=width,
                      label=f"{name}: {100 * error:.1f} %" if error > 0 else name)
    axes[0].set_ylim(bottom=axes[0].dataLim.y1 - 0.6)


def drop_mesh(study, given, axes):
    for (motion, settings), color, offset in zip(given["cases"].items(), style.RUNS, (-0.27, 0, 0.27)):
        for k, (ca, more) in enumerate(varied(given).items()):
            outcome = study.run(given["deck"], given["base"] | settings | more)
            stretch = _stretch(outcome.run.snapshots()[-1])
            yield ca, motion, outcome.end, stretch, outcome.series["taylor_surface"][-1], outcome.message[:100]
            for axis, value in zip(axes, (outcome.end, stretch)):
                axis.barh(k + offset, value, 0.24, color=color, label=f"`{motion}`" if k == 0 else None)


def _stretch(shot, k=3):
    """Returns the area of the largest cell divided by the area of the smallest cell."""
    grid = shot.sampled(shot.points, k)
    along, across = numpy.diff(grid, axis=2)[:, :-1], numpy.diff(grid, axis=1)[:, :, :-1]
    areas = numpy.linalg.norm(numpy.cross(along, across), axis=-1).sum((1, 2))
    return areas.max() / areas.min()


def stiffness(settings):
    """Returns rho = max(1 + C, 1) k/(2 Ca), k = pi/h, h = pi/(2 n) of (4.5) for elements of the sphere's cube mesh."""
    return (1 + settings.get("Membrane/area dilatation", 1.0)) * settings[SIDE] / settings.get(
        "Membrane/capillary number", 0.3)


def largest_step(study, settings, scheme):
    """Returns the largest fixed step of a scheme, or the smallest step that was tried if it is too large, and how the
    search ended (studies.edge). A step counts as stable if the run is completed and its D and energy agree within 5 %
    with a run with controlled steps. The run is forty times as long as the explicit stability limit, so that
    instabilities can grow. The bisection starts around this limit."""
    limit = 2.51 / stiffness(settings)
    settings = settings | {"Time/final time": 40 * limit, "Output/interval": 40 * limit}
    reference = study.run(SHEAR, settings | {"Time/scheme": "tr-bdf2"})
    if not reference.done:
        return math.nan, "no reference"

    def follows(step):
        outcome = study.run(SHEAR, settings | {"Time/scheme": scheme, "Time/fixed step": step})
        return outcome.done and all(abs(outcome.final[name] / reference.final[name] - 1) < 0.05
                                    for name in ("taylor_inertia", "energy"))

    low, high, how = studies.edge(follows, (0.1 if scheme == "crank-nicolson" else 0.3) * limit, 10 * limit, 1.1)
    return (high if how == "fails from here" else low), how


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
    """Returns a measure for line(): the largest absolute value of a series over the run."""
    return lambda outcome: numpy.nanmax(abs(outcome.series[name]))


def error_from(reference):
    """Returns a measure for line(): the error of D at the end of the run."""
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
