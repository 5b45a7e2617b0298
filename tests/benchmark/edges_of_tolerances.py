"""Maps of the atlas about accuracy asked for: of a step, of the integrals, of the volume."""

from edges_of_steps import PEN, SCHEMES
from package import PENS, SHEAR, SIDE, line, plt, style, worst


def _error(reference):
    return lambda outcome: max(abs(outcome.final["taylor_inertia"] - reference.final["taylor_inertia"]), 1e-9)


def step_tolerance(study):
    """Tolerances of a step that are too loose

    Neo-Hookean capsule in shear, inflated by 5 %, 98 control points, to γ̇t = 2 at Ca = 0.05: error of D and of the
    volume against Time/tolerance. An explicit scheme at its stability limit takes the same number of steps whatever it
    is asked for: a loose tolerance buys nothing, and costs volume, a thousandfold from 1e-5 to 1e-2.

    Survives: 1e-4 or tighter for explicit schemes; any tolerance for implicit ones, which then do take fewer steps; the
    exact constraint, which takes the drift out of both and with it most of the error of D."""
    base = {SIDE: 4, "Membrane/capillary number": 0.05, "Membrane/pre-inflation": 0.05, "Time/final time": 2.0,
            "Output/interval": 2.0}
    reference = study.run(SHEAR, base | {"Time/tolerance": 1e-7})
    measures = _error(reference), lambda one: one.counts["evaluations"], worst("volume_error")
    figure, axes = plt.subplots(1, 3, figsize=(9.6, 3.9))
    rows = []
    for scheme in ("bs3", "rkc2", "tr-bdf2", "bdf3"):
        for constraint, dash in ("exact", "-"), ("flux", ":"):
            jobs = {tolerance: (SHEAR, base | {"Time/scheme": scheme, "Time/tolerance": tolerance,
                                               "Volume/constraint": constraint})
                    for tolerance in (1e-2, 3e-3, 1e-3, 1e-4, 1e-5)}
            shown = axes if constraint == "flux" else axes[:2]
            rows += line(study, shown, SCHEMES[scheme] + ("" if dash == "-" else ", `flux`"), jobs, measures,
                         linestyle=dash, **PEN[scheme])
    for axis, label in zip(axes, ("error of D at the end", "velocity evaluations", "volume error without `exact`")):
        axis.set(xscale="log", yscale="log", xlabel="Time/tolerance", ylabel=label)
        axis.invert_xaxis()
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles[::2], labels[::2], loc="upper right", ncols=3, fontsize=7, title="dotted: constraint `flux`",
                  title_fontsize=7, bbox_to_anchor=(1, 1.012), labelspacing=0.25)
    return figure, ["scheme", "tolerance", "deformation_error", "evaluations", "volume_error", "message"], rows


def quadrature_tolerance(study):
    """Tolerances of the integrals that are too loose

    Neo-Hookean capsule in shear, Ca = 0.3, 98 control points, to γ̇t = 3: error of D against the same mesh with tight
    integrals, over what was asked for or over the points of the fixed rule. Fluid leaks through the membrane where a
    rule is too coarse, with two or three points an element. Rules by tolerance never take fewer than the space needs,
    so they have no edge even at 0.1; what is left of the volume error is the mesh's.

    Survives: any tolerance; four fixed points; the constraint, which closes the leak."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.6, 4.2))
    base = {SIDE: 4, "Time/final time": 3.0, "Output/interval": 3.0, "Time/tolerance": 1e-5}
    rules = (left, [{"Quadrature/tolerance": 10.0**-k} for k in range(1, 7)]), (
        right, [{"Quadrature/points": points, "Quadrature/rule": "fixed"} for points in (2, 3, 4, 6, 8)])
    rows = []
    for name, settings, pen in (("exact", {"Volume/constraint": "exact"}, PENS[0]),
                                ("none", {"Volume/constraint": "none", "Membrane/load measure": "current"}, PENS[1])):
        reference = study.run(SHEAR, base | settings | {"Quadrature/tolerance": 1e-9})
        for axis, chosen in rules:
            jobs = {next(iter(one.values())): (SHEAR, base | settings | one) for one in chosen}
            rows += line(study, [axis], f"D, constraint `{name}`", jobs, (_error(reference),), **pen)
            if name == "none":
                rows += line(study, [axis], "volume, constraint `none`", jobs, (worst("volume_error"),),
                             linestyle=":", mfc="none", **pen)
    left.set(xscale="log", yscale="log", xlabel="Quadrature/tolerance", ylabel="error")
    left.invert_xaxis()
    right.set(yscale="log", xlabel="Gauss points a direction, fixed rule")
    left.legend(loc="best")
    return figure, ["error", "tolerance_or_points", "value", "message"], rows


def volume_drift(study):
    """The volume over a long run, by constraint

    Neo-Hookean capsule in shear, Ca = 0.6, 98 control points, load per current area, to γ̇t = 20. Quadrature and steps
    leave a small net flux that never changes its sign, so its effect grows with time.

    Survives: `flux` takes it out of every velocity and leaves the error of the steps; `exact` restores the volume after
    every step."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.6, 4.2))
    rows = []
    for constraint, color in zip(("flux", "none", "exact"), style.RUNS):
        series = study.run(SHEAR, {SIDE: 4, "Membrane/capillary number": 0.6, "Membrane/load measure": "current",
                                   "Volume/constraint": constraint, "Time/final time": 20.0,
                                   "Output/interval": 20.0}).series
        t, error, d = (series[name] for name in ("time", "volume_error", "taylor_inertia"))
        left.semilogy(t[1:], abs(error[1:]).clip(1e-16), color=color, label=f"`{constraint}`")
        right.plot(t, d, color=color)
        rows += [(constraint, *values) for values in zip(t, error, d)]
    left.set(xlabel="time", ylabel="volume error")
    left.legend(loc="center right")
    right.set(xlabel="time", ylabel="Taylor parameter D", ylim=(0.45, 0.6))
    return figure, ["constraint", "time", "volume_error", "taylor_inertia"], rows


MAPS = [step_tolerance, quadrature_tolerance, volume_drift]
