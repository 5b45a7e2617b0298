#!/usr/bin/python3
"""Weak and strong form of the membrane load: deformation and step size over time, and the section at which the run with
the strong form fails.

    tests/benchmark/strong_form.py  # runs inputs/shear_neo_hookean.yaml in both forms, to time 2
    tests/benchmark/strong_form.py results/weak results/strong  # your own runs
"""

from package import SHEAR, SIDE, answer, command_line, draw, plt, style, tanktread
from matplotlib.collections import LineCollection


def main():
    parser = command_line(__doc__)
    parser.add_argument("runs", nargs="*", help="two directories of results: weak form, then strong form")
    parser.add_argument("-o", "--output", default="strong_form.png", metavar="FILE",
                        help="file of the figure (default: %(default)s)")
    arguments = parser.parse_args()
    weak, strong = map(tanktread.run, arguments.runs or [made("weak"), made("strong")])
    figure, axes = plt.subplot_mosaic("AC;BC", figsize=(9.6, 4.6), width_ratios=[1.1, 1])
    axes["A"].sharex(axes["B"])
    draw_series(axes["A"], axes["B"], weak, strong)
    draw_sections(axes["C"], weak, strong)
    style.save(figure, arguments.output)


def made(load):
    """Runs the deck if there are no results, and returns their directory. The strong form ends with exit code 3,
    because the run fails; the figure shows this."""
    settings = {"Membrane/load": load, SIDE: 6, "Time/final time": 2, "Output/interval": 0.05}
    return tanktread.results_of(SHEAR, f"strong_form/{load}", settings, accepted=(0, 1, 3))


def draw_series(upper, lower, weak, strong):
    end = strong.series["time"][-1]
    for name, run, color in ("weak form", weak, style.RUNS[0]), ("strong form", strong, style.RUNS[1]):
        t = run.series["time"]
        upper.plot(t, run.series["taylor_surface"], color=color, label=name)
        lower.semilogy(t[1:], run.series["time_step"][1:], color=color)
    for axes in upper, lower:
        axes.axvline(end, color=style.FAINT, linewidth=0.8, linestyle=(0, (4, 3)), zorder=1)
    upper.set(title=f"{weak.value('Membrane/law')}, {weak.value('Flow/type')}, Ca = "
              f"{weak.value('Membrane/capillary number'):g}, {weak.series['n_control_points'][-1]:.0f} control points",
              ylabel="Taylor parameter D (surface)", ylim=(0, None))
    upper.tick_params(labelbottom=False)
    upper.legend(loc="lower right")
    lower.set(ylabel="step", xlabel="time", xlim=(0, None))
    lower.annotate(f"stalls at {end:.3g}", (end, lower.get_ylim()[0]), (5, 8), textcoords="offset points", fontsize=8.5)


def draw_sections(axis, weak, strong):
    *_, regular, last = strong.snapshots()
    for name, shot, color, width in (("weak", weak.snapshot_at(regular.time).scaled(weak), style.RUNS[0], 1.6),
                                     ("strong", regular.scaled(strong), style.RUNS[1], 1.6),
                                     ("strong", last.scaled(strong), style.RUNS[1], 0.7)):
        axis.add_collection(LineCollection(draw.section(shot, draw.middle(shot.points)[1]), colors=color,
                                           linewidths=width, label=f"{name} form, t = {shot.time:.4g}"))
    axis.set_aspect("equal", anchor="N")
    axis.autoscale_view()
    axis.margins(y=0.15)  # leaves space for the legend
    axis.set(title="section in the x₁x₃ plane", xlabel="x₁ / R$_C$", ylabel="x₃ / R$_C$")
    axis.legend(loc="upper left")


if __name__ == "__main__":
    answer(main)
