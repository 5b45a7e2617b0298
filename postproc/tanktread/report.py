"""Writes one HTML file about a run, a sweep or a fit. It can be opened without a network.

    tanktread-report results/shear_neo_hookean                    # results/shear_neo_hookean/report.html
    tanktread-report results/study -o sweep.html                  # a sweep; a fit likewise

The page of a run shows the moving particle in three dimensions, which can be rotated, and curves of its series, with
the value under the pointer. It also contains the deck, the plan and the warnings of the run, the computing time of its
phases, its results compared with the expectations of the deck, and the paper to cite.
"""

import base64
import gzip
import json
import pathlib

import numpy

from .figures.scene import flow_plane, quads, surrounded
from .files import opened, parsed
from .mistakes import command_line, expect, log
from .runs import run as run_of
from .snapshots import DIMENSIONS, evenly
from .studies.sweep import table

FRAMES = 24            # largest number of snapshots in the page
BYTES = 3.4e6          # largest size of all shapes before they are packed
CITE = ("J. Maestre, J. Pallares, I. Cuesta, M. A. Scott, A 3D isogeometric BE–FE analysis with dynamic remeshing for "
        "the simulation of a deformable particle in shear flows, Comput. Methods Appl. Mech. Engrg. 326 (2017), whose "
        "method tanktread implements and extends")
FIRST = ["taylor_inertia", "inclination", "velocity_x1", "smallest_gap", "disturbed_pressure_drop", "stresslet_13",
         "tank_treading_frequency", "drag"]


def packed(values, largest, kind):
    """Returns values of magnitude up to 1 as integers up to `largest`, of a type such as u1, in base 64."""
    return base64.b64encode(numpy.round(values * largest).astype(kind).tobytes()).decode()


def shapes(run, field):
    """Returns snapshots as grids of cells: positions in 16 bits, relative to the bounding box of all snapshots, and
    normals and the magnitude of the field in 8 bits; posts and walls as quadrilaterals with normals, and the edges of
    walls and of the periodic cell as lines. The first two directions on the page are in the plane of the flow."""
    shots = evenly(run.snapshots(), FRAMES)
    if not shots:
        return None
    expect("Normals" in shots[-1].fields, f"{shots[-1].path} is damaged: it has no normals")
    field = field or ("traction" if "traction" in shots[-1].fields else next(iter(shots[-1].fields)))
    expect(field in shots[-1].fields,
           f"the snapshots hold no field {field}; there are: {', '.join(sorted(shots[-1].fields))}")
    cells = max(len(shot.cells) for shot in shots)
    k = next((k for k in (6, 5, 4, 3) if 10 * cells * (k + 1) ** 2 * len(shots) < BYTES), 2)
    shots = evenly(shots, max(2, int(BYTES / (10 * cells * (k + 1) ** 2))))
    shots, axes = [surrounded(run, shot) for shot in shots], flow_plane(run)
    seen = [numpy.concatenate([shot.frame, shot.positions]) @ axes.T for shot in shots]
    low, high = (numpy.array([edge(points, axis=0) for points in seen]) for edge in (numpy.min, numpy.max))
    middles = (low + high) / 2  # centre of the view of each snapshot; it moves with the particle in a duct
    if run.several and run.value("Flow/type") != "duct":
        middles[:] = (low.min(0) + high.max(0)) / 2
    size = 1.05 * max(abs(low - middles).max(), abs(high - middles).max(), 1e-300)  # between nodes a surface may bulge
    values = [numpy.linalg.norm(shot.sampled(shot.fields[field].reshape(len(shot.points), -1), k), axis=-1)
              for shot in shots]
    bottom, top = min(v.min() for v in values), max(v.max() for v in values)
    frames = []
    for shot, middle, value in zip(shots, middles, values):
        def placed(points):
            return packed((points @ axes.T - middle) / size, 32767, "<i2")

        posts = [quads(shot.posts.sampled(shot.posts.points, 6))] if shot.posts else []
        walls = numpy.concatenate([shot.walls, *posts])
        facing = numpy.cross(walls[:, 1, 1] - walls[:, 0, 0], walls[:, 1, 0] - walls[:, 0, 1])
        facing = numpy.repeat(facing / numpy.linalg.norm(facing, axis=1)[:, None].clip(1e-300), 4, axis=0)
        lines = numpy.concatenate([shot.edges, *(numpy.stack([rim[:-1], rim[1:]], axis=1) for rim in shot.rims)])
        normals = shot.sampled(shot.fields["Normals"], k)
        normals = normals / numpy.linalg.norm(normals, axis=-1, keepdims=True)
        colours = (value - bottom) / max(top - bottom, 1e-300)
        frames.append({"time": shot.time, "moment": run.moment(shot.time, ".5g"), "cells": len(shot.cells),
                       "places": placed(shot.sampled(shot.positions, k)), "colours": packed(colours, 255, "u1"),
                       "normals": packed(normals @ axes.T, 127, "i1"), "facing": packed(facing @ axes.T, 127, "i1"),
                       "walls": placed(walls), "lines": placed(lines)})
    label = run.label(field)
    for formatted, plain in ("$_s$", "ₛ"), ("R$_C$", "R_C"), ("$", ""):
        label = label.replace(formatted, plain)
    return {"k": k, "size": float(size * run.radius), "field": label, "low": float(bottom), "high": float(top),
            "frames": frames}


def curves(run):
    """Returns all series, the most important ones first. Long series are thinned to every second, third … row."""
    first = [name for key in FIRST for name in (key, *(f"{one}/{key}" for one in run.bodies)) if name in run.series]
    defined = {name: run.defined(name)[1] for name in first}
    first = [name for name, values in defined.items() if len(values) and numpy.ptp(values) > 1e-9]
    names = first + sorted(name for name in run.series if name not in first and name != "time")
    step = max(1, len(run.time) // 600)
    rows = sorted({*range(0, len(run.time), step), len(run.time) - 1})
    kept = [name for name in names if len(names) <= 80 or "/" not in name or name.endswith("/taylor_inertia")]
    return {"x": _list(run.time[rows]), "rate": float(run.time_scale), "label": run.time_label,
            "labels": {name: run.axis(name) for name in kept},
            "y": {name: _list(run.series[name][rows]) for name in kept},
            "errors": {name: _list(run.errors[name][rows]) for name in kept if run.band(name) is not None},
            "meanings": {name: run.descriptions[name] for name in kept}}


def _list(values):
    return [float(f"{value:.7g}") if numpy.isfinite(value) else None for value in numpy.asarray(values, float)]


def _rows(name, entry):
    """Returns the rows of an entry of the summary, which is a mapping or a single value."""
    if not isinstance(entry, dict):
        entry = {} if entry is None else {name: entry}
    return [[key, value] for key, value in entry.items()]


def of_run(directory, field):
    run = run_of(directory)
    summary = run.summary or {}
    status = summary.get("status", "not finished: this is what it has written so far")
    facts = {"status": status} | dict(sorted(run.provenance.items()))
    head = ["name", "value", "expected", "error", "estimated error"]
    asked = ["request", "value", "allowed", "estimated error"]
    requests = [["✓" if one["met"] else "✗", *(one[key] for key in asked), one.get("untrusted", "")]
                for one in (summary.get("accuracy") or {"requests": []})["requests"]]
    errors = summary.get("error") or {}
    last = [[run.axis(name), summary["final"][name], errors.get(name, "–"), run.descriptions[name]]
            for name in summary.get("final") or () if name in run.units and (errors or len(run.time) < 2)]
    sections = [
        ("Warnings", "list", summary.get("warnings") or []),
        ("Expectations", "table", [["", *head]] + [
            ["✓" if one.get("passed") else "✗", *(one.get(key, None if key == "name" else "–") for key in head)]
            for one in summary.get("expect") or []]),
        ("Accuracy", "table", requests and [["", *asked, "remark"], *requests]),
        ("Last values", "table", last and [["series", "value", "estimated error", "meaning"], *last]),
        *((title, "table", _rows(word, summary.get(word)))
          for title, word in (("Errors", "estimated errors"), ("Plan", "plan"), ("Numbers of the scene", "numbers"),
                              ("Seconds by phase", "seconds"), ("Bytes of memory", "memory"), ("Counts", "counts"))),
        ("Deck", "text", run.deck_text)]
    return {"title": run.name, "facts": facts, "shapes": shapes(run, field),
            "curves": curves(run) if len(run.time) > 1 else None, "sections": sections}


def of_sweep(directory):
    columns, keys, labels = table(directory)
    single = {name: values for name, values in columns.items() if values.ndim == 1}
    with opened(directory / "table.h5") as file:
        status = file["status"].asstr()[:]
        # tables of earlier versions contain no messages
        messages = file["message"].asstr()[:] if "message" in file else numpy.full(len(status), "")
    numbers = [name for name, values in single.items() if values.dtype.kind in "fiu"]
    rows = [[*(labels[name] for name in single), "status", "message"],
            *zip(*(one.tolist() for one in single.values()), status, messages)]
    scatter = {"keys": [key for key in keys if key in numbers], "columns": [one for one in numbers if one not in keys],
               "labels": labels, "values": {name: _list(single[name]) for name in numbers}}
    facts = {"runs": len(status), "done": int((status == "done").sum()), "keys": ", ".join(keys)}
    return {"title": f"sweep {directory.resolve().name}", "facts": facts, "scatter": scatter,
            "sections": [("Runs", "table", rows)]}


def of_fit(directory):
    fits = parsed(directory / "fit.yaml")
    of_law = ["chi square", "degrees of freedom", "AIC", "runs"]
    rows = [["law", "unknown", "value", "standard error", "at bound", *of_law]]
    expect(isinstance(fits, dict) and fits and all(isinstance(fit, dict) and {"unknown", *of_law} <= set(fit)
                                                   for fit in fits.values()), f"{directory}/fit.yaml is damaged")
    for law, fit in fits.items():
        for name, one in fit["unknown"].items():
            missing = "no value: runs fail" if "edge" in one else "not determined"
            found = [one["value"], one["error"]] if numpy.isfinite(one["error"]) else [missing, ""]
            label = f"{name}, {one['unit']}" if "unit" in one else name
            rows.append([law, label, *found, one.get("at bound", ""), *(fit[key] for key in of_law)])
    picture = base64.b64encode((directory / "fit.png").read_bytes()).decode()
    return {"title": f"fit {directory.resolve().name}", "facts": {"best law": next(iter(fits))}, "picture": picture,
            "sections": [("What the data say", "text", parsed(directory / "fit.txt", str)),
                         ("Unknowns", "table", rows)]}


def write(directory, output=None, field=None):
    """Writes the page about the run, sweep or fit in a directory, and returns its path. `output`: the page (default:
    report.html in the directory). `field`: colours the surface (default: traction)."""
    from matplotlib import colormaps

    directory = pathlib.Path(directory)
    kinds = {"run.h5": lambda: of_run(directory, field), "table.h5": lambda: of_sweep(directory),
             "fit.yaml": lambda: of_fit(directory)}
    kind = next((name for name in kinds if (directory / name).exists()), None)
    expect(kind, f"{directory} holds no run, sweep or fit ({', '.join(kinds)})")
    colours = colormaps["viridis"](numpy.linspace(0, 1, 256))[:, :3]
    content = kinds[kind]() | {"cite": CITE, "colours": packed(colours, 255, "u1")}
    # JSON has no NaN and no infinities: the page shows dashes instead
    content = json.loads(json.dumps(content, default=str), parse_constant=lambda constant: "–")
    data = base64.b64encode(gzip.compress(json.dumps(content, allow_nan=False).encode())).decode()
    page = (pathlib.Path(__file__).resolve().parent / "report_page.html").read_text(encoding="utf-8")
    path = pathlib.Path(output or directory / "report.html")
    title = content["title"].replace("&", "&amp;").replace("<", "&lt;")
    path.write_text(page.replace("%TITLE%", title).replace("%DATA%", data), encoding="utf-8")
    return path


def main():
    parser = command_line(__doc__)
    parser.add_argument("directory", metavar="results", help="directory of a run's, a sweep's or a fit's results")
    parser.add_argument("-o", "--output", type=pathlib.Path, metavar="FILE",
                        help="HTML file (default: report.html in the directory of the results)")
    parser.add_argument("--field", help="field of the snapshots that colours the surface (default: traction)")
    path = write(**vars(parser.parse_args()))
    log.info(f"{path}: {path.stat().st_size / 1e6:.2f} MB")
