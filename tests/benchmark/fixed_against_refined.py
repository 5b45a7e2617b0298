#!/usr/bin/python3
"""A particle on a refined and on a fixed mesh: surfaces, sections, and the traction along the section (Figures 17 and
18 of Maestre et al. 2017).

    tests/benchmark/fixed_against_refined.py  # runs inputs/hyperbolic_skalak_ca0.8.yaml with and without refinement
    tests/benchmark/fixed_against_refined.py results/refined results/fixed  # your own runs
"""

from package import SIDE, answer, command_line, draw, numpy, plt, style, tanktread
from matplotlib.collections import LineCollection
from tanktread.figures.surfaces import field_of

DECK = "inputs/hyperbolic_skalak_ca0.8.yaml"


def main():
    parser = command_line(__doc__)
    parser.add_argument("runs", nargs="*",
                        help="directories of results: a run with refinement, and the runs compared with it")
    parser.add_argument("-o", "--output", default="fixed_against_refined.png", metavar="FILE",
                        help="the picture (default: %(default)s)")
    parser.add_argument("--field", default="traction", help="field along the section (default: %(default)s)")
    arguments = parser.parse_args()
    runs = [tanktread.run(directory) for directory in arguments.runs or (tanktread.results_of(
        DECK), tanktread.results_of(DECK, "fixed_against_refined/fixed", {"Adaptation/enabled": "false", SIDE: 10}))]
    end = min(run.series["time"][-1] for run in runs)
    shots = [run.snapshot_at(end).scaled(run) for run in runs]
    names = [f"{run.name}, {run.series['n_control_points'][-1]:.0f} control points" for run in runs]
    extent = numpy.ptp(shots[0].points, axis=0)
    columns, tall = max(3, len(runs)), 4.2 * (extent[2] / extent[0] + 0.25)
    figure = plt.figure(figsize=(4.2 * columns, tall + 4.4))
    grid = figure.add_gridspec(3, columns, height_ratios=[tall, 0.1, 3.4])
    norm, colours, pattern = field_of(shots, arguments.field)
    for k, (shot, name) in enumerate(zip(shots, names)):
        axis = figure.add_subplot(grid[0, k], title=name)
        draw.draw_surface(axis, shot, arguments.field, norm, colours, draw.view_axes(*draw.VIEW))
    words = tanktread.field_label(runs, arguments.field, pattern)
    figure.colorbar(plt.cm.ScalarMappable(norm, colours), cax=figure.add_subplot(grid[1, 0]), orientation="horizontal",
                    label=words)
    draw_sections(*(figure.add_subplot(grid[2, k]) for k in range(3)), shots, names, arguments.field, words)
    (height, first), *others = (draw.near_tip(shot, arguments.field)[1:] for shot in shots)
    for run, (at, values) in zip(runs[1:], others):
        change = abs(numpy.interp(height, at, values) - first).max() / first.max()
        print(f"{run.name}: largest {arguments.field} {values.max():.5g} against {first.max():.5g}, largest difference "
              f"on the half of the section with the tip {100 * change:.2f} % of the largest")
    style.save(figure, arguments.output)


def draw_sections(outline, tip, along, shots, names, field, words):
    for k, (shot, name, color) in enumerate(zip(shots, names, style.RUNS)):
        look = {"linewidth": 2.2 if k == 0 else 1.2, "linestyle": "-" if k == 0 else (0, (4, 2))}
        middle = draw.middle(shot.points)
        section = draw.section(shot, middle[1]) - middle[[0, 2]]
        for axis in outline, tip:
            axis.add_collection(LineCollection(section, colors=color, **look))
        along.plot(*draw.near_tip(shot, field)[1:], label=name, color=color, zorder=2 + k, **look)
    outline.autoscale_view()
    reach = outline.dataLim.x1
    low = -0.11 * reach
    outline.add_patch(plt.Rectangle((0.9 * reach, low), -low, -2 * low, fill=False, edgecolor=style.FAINT))
    outline.set(aspect="equal", title="the section x₂ = 0", xlabel="x₁ / R$_C$", ylabel="x₃ / R$_C$")
    tip.set(xlim=(0.9 * reach, 1.01 * reach), ylim=(low, -low), title="tip of the section", xlabel="x₁ / R$_C$")
    along.set(title=f"{field} on the section near the tip", xlabel="x₃ / R$_C$", ylabel=words, xlim=(low, -low),
              ylim=(0, None))
    along.legend(loc="upper left", bbox_to_anchor=(0, -0.2))


if __name__ == "__main__":
    answer(main)
