"""Maps of the atlas about accuracy asked for: of a step, of the integrals, of the volume."""

import math

from package import plt, style
from edges_of_steps import SCHEMES

SHEAR = "inputs/shear_neo_hookean.yaml"


def _error(outcome, reference, name="taylor_inertia"):
    return abs(outcome.final[name] - reference.final[name]) if outcome.done else math.nan


def step_tolerance(study):
    """Tolerances of a step that are too loose

    Neo-Hookean capsule in shear, inflated by 5 %, 98 control points, to γ̇t = 2 at Ca = 0.05: error of D and of the
    volume against Time/tolerance. An explicit scheme at its stability limit takes the same number of steps whatever it
    is asked for: a loose tolerance buys nothing, and costs volume, a thousandfold from 1e-5 to 1e-2.

    Survives: 1e-4 or tighter for explicit schemes; any tolerance for implicit ones, which then do take fewer steps; the
    exact constraint, which takes the drift out of both and with it most of the error of D."""
    tolerances = [1e-2, 3e-3, 1e-3, 1e-4, 1e-5]
    base = {"Surface/elements per side": 4, "Membrane/capillary number": 0.05, "Membrane/pre-inflation": 0.05,
            "Time/final time": 2.0, "Output/interval": 2.0}
    reference = study.run(SHEAR, base | {"Time/tolerance": 1e-7})
    figure, axes = plt.subplots(1, 3, figsize=(9.6, 3.9))
    rows = []
    for scheme in study.schemes(("bs3", "rkc2", "tr-bdf2", "bdf3")):
        color, mark, name = SCHEMES[scheme]
        for constraint, line in (("exact", "-"), ("flux", ":")):
            found = []
            for tolerance in tolerances:
                outcome = study.run(SHEAR, base | {"Time/scheme": scheme, "Time/tolerance": tolerance,
                                                   "Volume/constraint": constraint})
                if outcome.done:
                    found.append((tolerance, _error(outcome, reference), abs(outcome.series["volume_error"]).max(),
                                  outcome.counts["evaluations"]))
                    rows.append((scheme, constraint, *found[-1]))
            for axis, column in zip(axes, (1, 2, 3)):
                if column != 2 or constraint == "flux":
                    axis.loglog([one[0] for one in found], [one[column] for one in found], line, color=color,
                                marker=mark, ms=4, label=name if line == "-" else None)
    for axis, label in zip(axes, ("error of D at the end", "volume error without `exact`", "velocity evaluations")):
        axis.set(xlabel="Time/tolerance", ylabel=label)
        axis.invert_xaxis()
    axes[0].plot([], [], ":", color=style.FAINT, label="Volume/constraint `flux`")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="upper right", ncols=3, fontsize=7,
                  bbox_to_anchor=(1, 1.012), labelspacing=0.25)
    return figure, ["scheme", "constraint", "tolerance", "deformation_error", "volume_error", "evaluations"], rows


def quadrature_tolerance(study):
    """Tolerances of the integrals that are too loose

    Neo-Hookean capsule in shear, Ca = 0.3, 98 control points, to γ̇t = 3: error of D against the same mesh with tight
    integrals, over what was asked for or over the points of the fixed rule. Fluid leaks through the membrane where a
    rule is too coarse, with two or three points an element. Rules by tolerance never take fewer than the space needs,
    so they have no edge even at 0.1; what is left of the volume error is the mesh's.

    Survives: any tolerance; four fixed points; the constraint, which closes the leak."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.6, 4.2))
    base = {"Surface/elements per side": 4, "Time/final time": 3.0, "Output/interval": 3.0, "Time/tolerance": 1e-5}
    rows = []
    for name, settings, color, mark in (("constraint `exact`", {"Volume/constraint": "exact"}, style.RUNS[0], "o"),
                                        ("constraint `none`",
                                         {"Volume/constraint": "none", "Membrane/load measure": "current"},
                                         style.RUNS[1], "s")):
        reference = study.run(SHEAR, base | settings | {"Quadrature/tolerance": 1e-9})
        for axis, key, values in ((left, "tolerance", (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6)),
                                  (right, "points", (2, 3, 4, 6, 8))):
            found = []
            for value in values:
                fixed = {"Quadrature/rule": "fixed", "Quadrature/points": value}
                rule = {"Quadrature/tolerance": value} if key == "tolerance" else fixed
                outcome = study.run(SHEAR, base | settings | rule)
                if outcome.done:
                    found.append((value, _error(outcome, reference), abs(outcome.series["volume_error"]).max()))
                    rows.append((name, key, *found[-1], outcome.kernel_evaluations))
            axis.plot([one[0] for one in found], [max(one[1], 1e-9) for one in found], color=color, marker=mark, ms=5,
                      label=f"D, {name}")
            if "none" in name:
                axis.plot([one[0] for one in found], [one[2] for one in found], ":", color=color, marker=mark, ms=4,
                          mfc="none", label=f"volume, {name}")
    left.set_xscale("log")
    left.invert_xaxis()
    left.set_xlabel("Quadrature/tolerance")
    right.set_xlabel("Gauss points a direction, fixed rule")
    for axis in left, right:
        axis.set_yscale("log")
    left.set_ylabel("error")
    left.legend(loc="best")
    return figure, ["constraint", "key", "value", "deformation_error", "volume_error", "kernel_evaluations"], rows


def volume_drift(study):
    """The volume over a long run, by constraint

    Neo-Hookean capsule in shear, Ca = 0.6, 98 control points, load per current area, to γ̇t = 20. Quadrature and steps
    leave a small net flux that never changes its sign, so its effect grows with time.

    Survives: `flux` takes it out of every velocity and leaves the error of the steps; `exact` restores the volume after
    every step."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.6, 4.2))
    rows = []
    for constraint, color in (("none", style.RUNS[1]), ("flux", style.RUNS[0]), ("exact", style.RUNS[2])):
        outcome = study.run(SHEAR, {"Surface/elements per side": 4, "Membrane/capillary number": 0.6,
                                    "Membrane/load measure": "current", "Volume/constraint": constraint,
                                    "Time/final time": 20.0, "Output/interval": 20.0})
        t = outcome.series["time"]
        left.semilogy(t[1:], abs(outcome.series["volume_error"][1:]).clip(1e-16), color=color, label=f"`{constraint}`")
        right.plot(t, outcome.series["taylor_inertia"], color=color)
        rows += [(constraint, *values) for values in zip(t, outcome.series["volume_error"],
                                                         outcome.series["taylor_inertia"])]
    left.set_ylabel("volume error")
    left.legend(loc="center right")
    right.set(ylabel="Taylor parameter D", ylim=(0.45, 0.6))
    for axis in left, right:
        axis.set_xlabel("time")
    return figure, ["constraint", "time", "volume_error", "taylor_inertia"], rows


MAPS = [step_tolerance, quadrature_tolerance, volume_drift]
