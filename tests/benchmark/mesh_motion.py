#!/usr/bin/python3
"""Errors of drops and their cost, depending on the speed at which their mesh relaxes (`Interface/relaxation`).

    tests/benchmark/mesh_motion.py [speed ...]

The speeds are 0.1, 0.3, 1 and 3 by default. Each scene of scenes/mesh_motion.yaml runs with 5 elements per side and
`Time/tolerance` 3e-4. The error of a series is its largest deviation, at ten times, from a run with 12 elements per
side, `Time/tolerance` 2e-5 and speed 0.3, divided by the largest value of the series. The largest error of six series
is printed. Runs are kept under results/mesh_motion.
"""

from package import SIDE, answer, command_line, expect, interpolation, numpy, scenes_of, table, tanktread

SERIES = "taylor_inertia", "stresslet_12", "stresslet_11", "area", "length_x1", "length_x3"
DROP = {"Membrane/law": "surface tension", SIDE: 5, "Time/tolerance": 3e-4}
FINE = {SIDE: 12, "Time/tolerance": 2e-5, "Interface/relaxation": 0.3}


def run(study, path, keys, end):
    outcome = study.run(path, DROP | keys | {"Output/interval": end / 10})
    expect(outcome.done, outcome.message)
    return outcome


def error(outcome, reference, end):
    times, errors = numpy.linspace(0, end, 11)[1:], []
    for name in SERIES:
        fine, found = (interpolation.interpolated(one.series["time"], one.series[name], times) for one in (reference, outcome))
        if abs(fine).max() > 1e-3:
            errors.append(abs(found - fine).max() / abs(fine).max())
    return max(errors)


def rows(study, speeds):
    for name, deck in scenes_of(__file__).items():
        path = study.directory / f"{name.replace('/', ' ')}.yaml"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(tanktread.runs.text_of({"Tanktread": deck}))
        end = deck["Time"]["final time"]
        reference = run(study, path, FINE, end)
        outcomes = [run(study, path, {"Interface/relaxation": speed}, end) for speed in speeds]
        yield [name, *(f"{error(one, reference, end):.1e}, {one.final['evaluations']:.0f}" for one in outcomes)]


def main():
    parser = command_line(__doc__)
    parser.add_argument("speeds", nargs="*", type=float, metavar="speed", help="speeds (default: 0.1 0.3 1 3)")
    speeds = parser.parse_args().speeds or [0.1, 0.3, 1.0, 3.0]
    table(["drop", *(f"{speed:g}" for speed in speeds)], rows(tanktread.Study(directory="results/mesh_motion"), speeds))


if __name__ == "__main__":
    answer(main)
