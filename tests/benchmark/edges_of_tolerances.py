"""Maps of the atlas about accuracy asked for: of a step, of the integrals, of the volume."""

from edges_of_steps import PEN, SCHEMES
from package import PENS, SHEAR, line, plt, style, worst


def _error(reference):
    return lambda outcome: max(abs(outcome.final["taylor_inertia"] - reference.final["taylor_inertia"]), 1e-9)


def step_tolerance(study, given):
    reference = study.run(SHEAR, given["base"] | {"Time/tolerance": 1e-7})
    measures = _error(reference), lambda one: one.counts["evaluations"], worst("volume_error")
    figure, axes = plt.subplots(1, 3, figsize=(9.6, 3.9))
    rows = []
    for scheme in ("bs3", "rkc2", "tr-bdf2", "bdf3"):
        for constraint, words, dash, shown in ("exact", "", "-", axes[:2]), ("flux", ", `flux`", ":", axes):
            settings = given["base"] | {"Time/scheme": scheme, "Volume/constraint": constraint}
            jobs = {tolerance: settings | {"Time/tolerance": tolerance} for tolerance in given["values"]}
            rows += line(study, shown, SCHEMES[scheme] + words, SHEAR, jobs, measures, linestyle=dash, **PEN[scheme])
    for axis, label in zip(axes, ("error of D at the end", "velocity evaluations", "volume error without `exact`")):
        axis.set(xscale="log", yscale="log", xlabel="Time/tolerance", ylabel=label)
        axis.invert_xaxis()
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles[::2], labels[::2], loc="upper right", ncols=3, fontsize=7, title="dotted: constraint `flux`",
                  title_fontsize=7, bbox_to_anchor=(1, 1.012), labelspacing=0.25)
    return figure, ["scheme", "tolerance", "deformation_error", "evaluations", "volume_error", "message"], rows


def quadrature_tolerance(study, given):
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.6, 4.2))
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
    left.set(xscale="log", yscale="log", xlabel="Quadrature/tolerance", ylabel="error")
    left.invert_xaxis()
    right.set(yscale="log", xlabel="Gauss points a direction, fixed rule")
    left.legend(loc="best")
    return figure, ["error", "tolerance_or_points", "value", "message"], rows


def volume_drift(study, given):
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.6, 4.2))
    rows = []
    for (constraint, settings), color in zip(given["cases"].items(), style.RUNS):
        series = study.run(SHEAR, given["base"] | settings).series
        t, error, d = (series[name] for name in ("time", "volume_error", "taylor_inertia"))
        left.semilogy(t[1:], abs(error[1:]).clip(1e-16), color=color, label=f"`{constraint}`")
        right.plot(t, d, color=color)
        rows += [(constraint, *values) for values in zip(t, error, d)]
    left.set(xlabel="time", ylabel="volume error")
    left.legend(loc="center right")
    right.set(xlabel="time", ylabel="Taylor parameter D", ylim=(0.45, 0.6))
    return figure, ["constraint", "time", "volume_error", "taylor_inertia"], rows
