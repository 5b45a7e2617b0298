#!/usr/bin/python3
"""A particle on a refined and on a fixed mesh: surfaces, sections, and the traction along the section (the paper's
Figures 17 and 18).

    tests/benchmark/fixed_against_refined.py  # runs inputs/hyperbolic_skalak_ca0.8.yaml, refined and not
    tests/benchmark/fixed_against_refined.py results/refined results/fixed  # runs of yours
"""

import argparse

from package import answer, draw, numpy, plt, style, tanktread
from matplotlib.collections import LineCollection


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("refined", nargs="?", help="directory of a run's results")
    parser.add_argument("fixed", nargs="*", help="of others, to be compared with it")
    parser.add_argument("-o", "--output", default="fixed_against_refined.png", metavar="FILE",
                        help="the picture (default: %(default)s)")
    parser.add_argument("--field", default="traction", help="field along the section (default: %(default)s)")
    arguments = parser.parse_args()

    runs = [tanktread.run(directory) for directory in ([arguments.refined, *arguments.fixed]
                                                       if arguments.refined else made())]
    end = min(run.series["time"][-1] for run in runs)
    shots = [run.snapshot_at(end).scaled(run) for run in runs]
    names = [f"{run.name}, {run.series['n_control_points'][-1]:.0f} control points" for run in runs]
    extent = shots[0].points.max(0) - shots[0].points.min(0)
    columns = max(3, len(runs))
    tall = 4.2 * (extent[2] / extent[0] + 0.25)
    figure = plt.figure(figsize=(4.2 * columns, tall + 4.4), layout="constrained")
    grid = figure.add_gridspec(3, columns, height_ratios=[tall, 0.1, 3.4])
    norm, colours = draw.scale([draw.magnitude(shot.fields[arguments.field]) for shot in shots])
    for k, (shot, name) in enumerate(zip(shots, names)):
        axis = figure.add_subplot(grid[0, k])
        draw.draw_surface(axis, shot, arguments.field, norm, colours, *draw.VIEW)
        axis.set_title(name)
    vector = numpy.ndim(shots[0].fields[arguments.field]) > 1
    words = tanktread.field_label(runs, arguments.field, "|{}|" if vector else "{}")
    figure.colorbar(plt.cm.ScalarMappable(norm, colours), cax=figure.add_subplot(grid[1, 0]), orientation="horizontal",
                    label=words)

    outline, tip, along = (figure.add_subplot(grid[2, k]) for k in range(3))
    curves = []
    for k, (shot, name, color) in enumerate(zip(shots, names, style.RUNS)):
        look = {"color": color, "linewidth": 2.2 if k == 0 else 1.2, "linestyle": "-" if k == 0 else (0, (4, 2)),
                "zorder": 2 + k}
        middle = (shot.points.min(0) + shot.points.max(0)) / 2
        section = draw.section(shot, middle[1]) - middle[[0, 2]]
        for axis in outline, tip:
            axis.add_collection(LineCollection(section, colors=color, linewidths=look["linewidth"],
                                               linestyles=look["linestyle"]))
        curves.append(profile(shot, arguments.field))
        along.plot(*by_distance(shot, arguments.field), label=name, **look)
    outline.set_aspect("equal")
    outline.autoscale_view()
    reach = outline.dataLim.x1
    tip.set(xlim=(0.9 * reach, 1.01 * reach), ylim=(-0.11 * reach, 0.11 * reach))
    outline.add_patch(plt.Rectangle((0.9 * reach, -0.11 * reach), 0.11 * reach, 0.22 * reach, fill=False,
                                    edgecolor=style.FAINT, linewidth=0.8))
    for axis, title in (outline, "the section x₂ = 0"), (tip, "its tip"):
        axis.set(title=title, xlabel="x₁ / R$_C$", ylabel="x₃ / R$_C$")
    along.set(title=f"{arguments.field} on the section near the tip", xlabel="x₃ / R$_C$", ylabel=words,
              xlim=(-0.11 * reach, 0.11 * reach), ylim=(0, None))
    along.legend(loc="upper left", bbox_to_anchor=(0, -0.2))
    for run, (angle, values) in zip(runs[1:], curves[1:]):
        print(f"{run.name}: largest {arguments.field} {largest(values):.5g} against {largest(curves[0][1]):.5g}, "
              f"largest difference on the section {100 * difference(curves[0], (angle, values)):.2f} % of the largest")
    style.save(figure, arguments.output)


def made():
    deck = tanktread.SOURCE / "inputs" / "hyperbolic_skalak_ca0.8.yaml"
    fixed = {"Adaptation/enabled": "false", "Surface/elements per side": 10}
    return [tanktread.results_of(deck), tanktread.results_of(deck, "fixed_against_refined/fixed", fixed)]


def profile(shot, field):
    """Magnitude of a field on the section, by angle."""
    angle, _, values = draw.on_section(shot, field)
    return angle, numpy.linalg.norm(values, axis=1)


def by_distance(shot, field):
    """x3 and the field's magnitude on that half of the section where x1 is above the middle."""
    ends = draw.field_cut(shot, field).mean(axis=1)
    ends = ends[ends[:, 0] > 0]
    ends = ends[numpy.argsort(ends[:, 2])]
    return ends[:, 2], numpy.linalg.norm(ends[:, 3:], axis=1)


def largest(values):
    return numpy.max(values)


def difference(one, other):
    return numpy.max(abs(numpy.interp(one[0], *other, period=2 * numpy.pi) - one[1])) / largest(one[1])


if __name__ == "__main__":
    answer(main)
