#!/usr/bin/python3
"""Weak and strong form of the load side by side: deformation and step size over time, and the section where the strong
form stalls.

    tests/benchmark/strong_form.py  # runs inputs/shear_neo_hookean.yaml in both forms, to time 2
    tests/benchmark/strong_form.py results/weak results/strong  # runs of yours
"""

import argparse

from package import answer, plt, style, tanktread
from matplotlib.collections import LineCollection

from tanktread.figures.draw import section


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("weak", nargs="?", help="directory of the results of a run in the weak form")
    parser.add_argument("strong", nargs="?", help="directory of the results of the same run in the strong form")
    parser.add_argument("-o", "--output", default="strong_form.png", metavar="FILE",
                        help="the picture (default: %(default)s)")
    arguments = parser.parse_args()

    weak, strong = (tanktread.run(given or made(load)) for load,
                    given in (("weak", arguments.weak), ("strong", arguments.strong)))
    runs = [("weak form", weak, style.RUNS[0]), ("strong form", strong, style.RUNS[1])]
    end = runs[1][1].series["time"][-1]
    figure = plt.figure(figsize=(9.6, 4.6))
    grid = figure.add_gridspec(2, 2, width_ratios=[1.1, 1])
    upper = figure.add_subplot(grid[0, 0])
    lower = figure.add_subplot(grid[1, 0], sharex=upper)
    draw_series(upper, lower, runs, end)
    draw_sections(figure.add_subplot(grid[:, 1]), runs)
    style.save(figure, arguments.output)


def made(load):
    deck = tanktread.SOURCE / "inputs" / "shear_neo_hookean.yaml"
    settings = {"Membrane/load": load, "Surface/elements per side": 6, "Time/final time": 2, "Output/interval": 0.05}
    # 3: the strong form fails, which is what is shown
    return tanktread.results_of(deck, f"strong_form/{load}", settings, accepted=(0, 1, 3))


def draw_series(upper, lower, runs, end):
    for name, run, color in runs:
        t = run.series["time"]
        upper.plot(t, run.series["taylor_surface"], color=color, label=name)
        lower.semilogy(t[1:], run.series["time_step"][1:], color=color)
    for axes in upper, lower:
        axes.axvline(end, color=style.FAINT, linewidth=0.8, linestyle=(0, (4, 3)), zorder=1)
    first = runs[0][1]
    upper.set_title(f"{first.value('Membrane/law')}, {first.value('Flow/type')}, Ca = "
                    f"{first.value('Membrane/capillary number'):g}, " f"{first.series['n_control_points'][-1]:.0f} "
                                                                      "control points")
    upper.set_ylabel("Taylor parameter D (surface)")
    upper.set_ylim(bottom=0)
    upper.tick_params(labelbottom=False)
    upper.legend(loc="lower right")
    lower.set(ylabel="step", xlabel="time", xlim=(0, None))
    lower.annotate(f"stalls at {end:.3g}", (end, lower.get_ylim()[0]), (5, 8), textcoords="offset points",
                   color=style.INK, fontsize=8.5)


def draw_sections(axis, runs):
    (_, weak, blue), (_, strong, orange) = runs
    last = strong.snapshots()[-1]
    regular = [shot for shot in strong.snapshots() if shot.time < last.time][-1]
    shots = [("weak form", weak.snapshot_at(regular.time).scaled(weak), blue, 1.6),
             ("strong form", regular.scaled(strong), orange, 1.6), ("strong form", last.scaled(strong), orange, 0.7)]
    for name, shot, color, width in shots:
        x2 = (shot.points[:, 1].min() + shot.points[:, 1].max()) / 2
        axis.add_collection(LineCollection(section(shot, x2), colors=color, linewidths=width, capstyle="round",
                                           label=f"{name}, t = {shot.time:.4g}"))
    axis.set_aspect("equal", anchor="N")
    axis.autoscale_view()
    low, high = axis.get_ylim()
    axis.set_ylim(low, high + 0.3 * (high - low))  # room for the legend
    axis.set_title("section in the x₁x₃ plane")
    axis.set_xlabel("x₁ / R$_C$")
    axis.set_ylabel("x₃ / R$_C$")
    axis.legend(loc="upper left")


if __name__ == "__main__":
    answer(main)
