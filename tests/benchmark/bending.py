#!/usr/bin/python3
"""A capsule that resists bending, in shear: D over time beside the literature's curves, on several meshes and moduli.

    tests/benchmark/bending.py --curves DIR  # beside the literature's curves

Runs inputs/shear_bending.yaml (Ca = 0.15, E_b = 0.0375 R^2 E_s), with its own reference curvature and relaxed when
flat, and without bending. The curves are tables of time and D, `bending_<author>_<year>.csv` or `.txt` (columns t,
shortest, longest, D, angle).
"""

import argparse
import pathlib

from package import answer, literature, numpy, plt, studies, style

DECK = "inputs/shear_bending.yaml"


def plateau(series):
    """Mean D from time 3 on."""
    t, d = series["time"], series["taylor_inertia"]
    late = t >= 3
    return numpy.trapz(d[late], t[late]) / (t[late][-1] - t[late][0])


def curves(folder):
    for path in sorted(folder.glob("bending_*")):
        data = numpy.loadtxt(path, delimiter="," if path.suffix == ".csv" else None)
        author, year = path.stem.removeprefix("bending_").rsplit("_", 1)
        yield literature.Curve(f"{author.capitalize()} {year}", data[:, 0],
                               data[:, 3] if path.suffix == ".txt" else data[:, 1])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--curves", type=pathlib.Path, metavar="DIR", help="folder of the literature's (default: none)")
    parser.add_argument("--meshes", nargs="+", type=int, default=[6, 9, 12], metavar="N",
                        help="elements along a side of the cube (default: 6 9 12)")
    studies.arguments(parser, "results/bending")
    parsed = parser.parse_args()
    study = studies.study(parsed)

    figure, (left, right) = plt.subplots(1, 2, figsize=(9.6, 4.6), width_ratios=[1.6, 1])
    for k, curve in enumerate(curves(parsed.curves) if parsed.curves else []):
        left.plot(curve.t, curve.d, linestyle="none", marker=style.MARKS[k % len(style.MARKS)], ms=3, color=style.FAINT,
                  mew=0.8, mfc="none", label=curve.label)
    rows = []
    cases = [("curved when relaxed", {}, style.RUNS[0]),
             ("flat when relaxed", {"Membrane/bending reference": "flat"}, style.RUNS[2]),
             ("without bending", {"Membrane/bending modulus": 0.0}, style.RUNS[1])]
    for name, settings, color in cases:
        found = []
        for n in parsed.meshes:
            outcome = study.run(DECK, settings | {"Surface/elements per side": n})
            if not outcome.done:
                print(f"{name}, n = {n}: {outcome.message}")
                continue
            found.append((n, plateau(outcome.series)))
            rows.append((name, n, found[-1][1], outcome.seconds))
            print(f"{name}, n = {n}: plateau D = {found[-1][1]:.6f}, {outcome.seconds:.1f} s")
            if n == parsed.meshes[-1]:
                left.plot(outcome.series["time"], outcome.series["taylor_inertia"], color=color,
                          label=f"{name}, n = {n}")
        right.plot([n for n, _ in found], [d for _, d in found], "o-", color=color, ms=4)
    left.axhspan(0.133, 0.164, color=style.GRID, zorder=0)
    left.set(xlim=(0, 4), ylim=(0, 0.2), xlabel="time", ylabel="Taylor parameter D (inertia)")
    left.legend(loc="lower right", ncols=2)
    left.set_title("neo-Hookean, Ca = 0.15, shear; band: plateaus of the literature")
    right.set_xticks(parsed.meshes)
    right.set(xlabel="n, elements along a side of the cube", ylabel="plateau of D (mean from time 3 on)")
    figure.supxlabel(r"\$ " + studies.command_of(__file__, "--meshes", *map(str, parsed.meshes)), x=0.01, ha="left",
                     fontsize=7.5)
    studies.write_table(parsed.output / "bending.csv", ["case", "elements_per_side", "plateau", "seconds"], rows)
    style.save(figure, parsed.output / "bending.png")


if __name__ == "__main__":
    answer(main)
