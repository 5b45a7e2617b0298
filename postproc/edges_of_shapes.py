"""Maps of the atlas about the particle itself: where there is no steady shape any more."""

import numpy

import style
from style import plt

DROP = "inputs/drop_folds.yaml"
CAPSULE = "inputs/capsule_branch.yaml"
ELLIPSOID = {"Flow/type": "planar hyperbolic", "Particle/shape": "ellipsoid", "Particle/semi-axes": "[1.8785, 0.7653, 0.6957]",
             "Particle/initial shape/stretch": "[0.7167, 1.1541, 1.2091]"}  # 2.7 : 1.1 : 1, at first 1.6 : 1.05 : 1
INFLATED = {"Continuation/second parameter": "Membrane/pre-inflation", "Continuation/second values": "[0.15, 0.2, 0.3, 0.4]", "Continuation/points": 12}


def bursting(study):
    """Where drops and capsules burst: the folds of their steady branches

    Left: critical Ca = μEa/σ of drops against their viscosity in uniaxial extension (-x₁/2, -x₂/2, x₃)E and planar hyperbolic flow (x₁, 0, -x₃)E. Right: critical
    Ca = μEa/G_s of neo-Hookean capsules in uniaxial extension against the pre-inflation of the radius. Each is a fold that `Continuation` locates and goes on
    with; the table has D there, and how far the mesh before is off.

    Survives: smaller Ca. Skalak membranes harden, and have no fold."""
    curves = [("drop, uniaxial", DROP, {}, (5, 6)), ("drop, planar", DROP, ELLIPSOID, (5, 6)), ("neo-Hookean capsule, uniaxial", CAPSULE, INFLATED, (10, 12))]
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.6, 4.2))
    rows = []
    for (name, deck, settings, meshes), color in zip(curves, style.RUNS):
        axis = right if "capsule" in name else left
        coarse, fine = (folds(study.run(deck, settings | {"Surface/elements per side": n})) for n in meshes)
        for second, ca, d in fine.T:
            before = coarse[1:, coarse[0] == second]
            apart = abs(before[:, 0] - (ca, d)) if before.size else (numpy.nan, numpy.nan)
            rows.append((name, second, ca, d, apart[0] / ca, apart[1]))
        axis.plot(coarse[0], coarse[1], "x", color=color, ms=6, label=f"{name}: n = {meshes[0]}")
        axis.plot(fine[0], fine[1], "o-", color=color, ms=3.5, label=f"n = {meshes[1]}")
    left.set_xscale("log")
    left.set_xlabel("viscosity ratio λ")
    right.set_xlabel("pre-inflation")
    for axis in left, right:
        axis.set_ylabel("Ca at the fold")
        axis.legend()
    return figure, ["scene", "viscosity_ratio_or_pre_inflation", "capillary_number", "taylor_parameter", "change_of_ca_relative", "change_of_d"], rows


def folds(outcome):
    """Rows: the second parameter, critical Ca and D there; as far as the run came."""
    series = outcome.series
    return numpy.array([series[name][series["fold"] > 0] for name in ("second_parameter", "parameter", "taylor_surface")])


MAPS = [bursting]
