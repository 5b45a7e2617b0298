#!/usr/bin/python3
# Tests that a report is one page that needs no network. If a browser is available, tests that the page can be rotated
# and played, and shows values and labels with units.
import base64
import gzip
import html
import json
import pathlib
import re

import numpy
import yaml

from harness import check, close, deck, main, package, run, shown

DECK = """
Tanktread:
  Flow: { type: simple shear }
  Membrane: { law: neo-Hookean, capillary number: 0.3 }
  Surface: { elements per side: 3 }
  Time: { final time: 1.0 }
  Output: { interval: 0.25 }
  Expect: { taylor_inertia: { value: 0.3, tolerance: 1.0 }, area: { value: 1.0, tolerance: 1.0e-3 } }
"""
USE = """<script>
addEventListener("error", event => { document.body.dataset.error = event.message; });
const wait = seconds => new Promise(done => setTimeout(done, 1000 * seconds));
(async () => {
  while (!window.report) await wait(0.05);
  const told = { texts: [] }, write = CanvasRenderingContext2D.prototype.fillText, canvas = document.getElementById("shape"), plot = report.plots[0];
  const drag = (kind, x, y) => canvas.dispatchEvent(new PointerEvent(kind, { clientX: x, clientY: y, offsetX: x, pointerId: 1 }));
  if (canvas) {
    canvas.setPointerCapture = () => {};
    const picture = () => { report.surface.draw(); return canvas.toDataURL(); };
    told.ink = new Set(bytes(picture().split(",")[1])).size;
    const before = picture();
    drag("pointerdown", 100, 100); drag("pointermove", 180, 140); drag("pointerup", 180, 140);
    told.turned = picture() !== before;
    const frame = report.surface.frame;
    document.getElementById("play").click(); await wait(0.5); document.getElementById("play").click();
    told.played = report.surface.frame !== frame;
  }
  CanvasRenderingContext2D.prototype.fillText = function (text, ...place) { told.texts.push(text); write.call(this, text, ...place); };
  for (const one of report.plots) one.draw();
  if (plot) { plot.pointer = [plot.canvas.clientWidth / 2, 60]; plot.draw(); told.value = plot.said; }
  told.pictures = [...document.images].map(image => image.naturalWidth);
  told.cells = [...document.querySelectorAll("td")].map(cell => cell.textContent);
  told.numbers = [0, 7, 1234567, 0.00000564287, -0.0123456, 98765432.1].map(value => number(value, 2));
  document.body.dataset.told = JSON.stringify(told);
})();
</script>"""


def _script(name, *arguments, code=0):
    result = package(name, *arguments)
    check(result.returncode == code and "Traceback" not in result.stderr, name, result.stdout, result.stderr)
    return result.stdout + result.stderr


def _content(path):
    text = pathlib.Path(path).read_text()
    check(not re.search(r"(src|href)=[\"']?(https?:)?//", text) and "fetch(" not in text, "the page asks the network")
    return json.loads(gzip.decompress(base64.b64decode(re.search(r'type="text/plain">([^<]*)<', text)[1])))


def _used(path):
    """Returns values that the page computes in a browser; None if no browser is available."""
    page = pathlib.Path("used.html")
    page.write_text(pathlib.Path(path).read_text().replace("</body>", USE + "</body>"))
    document, errors = shown(page.resolve().as_uri())
    if document is None:
        return None
    check(not errors and "data-error" not in document, errors, re.findall('data-error="[^"]*"', document))
    told = re.search('data-told="([^"]*)"', document)
    check(told, "the page did not get through", document[-500:])
    told = json.loads(html.unescape(told[1]))
    check(told["numbers"] == ["0", "7", "1234567", "5.6e-6", "-0.012", "9.9e7"], told["numbers"])
    return told


def a_run_is_one_page_with_its_shapes_and_curves():
    deck(DECK)
    run("deck.yaml", "--output", "results", "--quiet", code=1)
    _script("report", "results")
    content = _content("results/report.html")
    shapes = content["shapes"]
    check(len(shapes["frames"]) == 5 and shapes["frames"][-1]["time"] == 1.0, "frames")
    places = numpy.frombuffer(base64.b64decode(shapes["frames"][0]["places"]), "<i2").reshape(-1, 3) / 32767 * shapes["size"]
    close(numpy.linalg.norm(places, axis=1).max(), 1, 2e-3, "radius of the sphere at the start")
    for frame in shapes["frames"]:
        grid = numpy.frombuffer(base64.b64decode(frame["places"]), "<i2").reshape(frame["cells"], shapes["k"] + 1, shapes["k"] + 1, 3) / 32767 * shapes["size"]
        close(abs(numpy.diff(grid, axis=1)).max(), 0, 0.5, "a step between neighbours")
    close(content["curves"]["y"]["taylor_inertia"][0], 0, 1e-6, "D at the start")
    expected = next(body for title, _, body in content["sections"] if title == "Expectations")
    check([row[0] for row in expected[1:]] == ["✓", "✗"], expected)
    told = _used("results/report.html")
    check(told is None or (told["turned"] and told["played"] and told["value"]), told)
    check(told is None or {"time · shear rate", "taylor_inertia"} <= set(told["texts"]), told)


def last_values_have_errors_even_with_one_row():
    deck(DECK)
    run("deck.yaml", "--accuracy", "taylor_inertia=50%", "--output", "asked", "--quiet", "--set", "Accuracy/levels=3", code=None)
    text = DECK.replace("simple shear", "uniaxial extension").replace("number: 0.3", "number: 0.05")
    run(deck(text[:text.index("  Expect")] + "  Steady: {}\n"), "--output", "steady", "--quiet")
    for name, asked in ("asked", True), ("steady", False):
        _script("report", name)
        content, summary = _content(f"{name}/report.html"), yaml.safe_load(pathlib.Path(name, "summary.yaml").read_text())
        rows = {row[0]: row for row in next(body for title, _, body in content["sections"] if title == "Last values")}
        check(asked or content["curves"] is None, "one row")
        check(rows["taylor_inertia"][1] == summary["final"]["taylor_inertia"] and "area, length²" in rows, rows)
        check(rows["taylor_inertia"][2] == (summary["error"]["taylor_inertia"] if asked else "–"), rows["taylor_inertia"])


def axes_have_the_units_of_the_deck():
    deck(DECK.replace("  Flow:", "  Units: { length: 1 um, time: 1 ms, force: 1 nN }\n  Flow:").replace("capillary number: 0.3", "shear modulus: 1")
         .replace("simple shear", "quiescent").replace("  Membrane:", "  Particle: { initial shape: { stretch: [1.2, 1, 0.9] } }\n  Membrane:"))
    run("deck.yaml", "--output", "results", "--quiet", code=1)
    _script("report", "results")
    curves = _content("results/report.html")["curves"]
    check(curves["label"] == "time, ms" and curves["labels"]["volume"] == "volume, µm³", curves["label"], curves["labels"]["volume"])
    told = _used("results/report.html")
    check(told is None or {"time, ms", "taylor_inertia"} <= set(told["texts"]), told)


def an_unfinished_run_is_marked_in_its_report():
    deck(DECK)
    run("deck.yaml", "--output", "results", "--quiet", code=1)
    kept = pathlib.Path("results/summary.yaml")
    kept.write_text(yaml.safe_dump({**yaml.safe_load(kept.read_text()), "memory": 7}))
    _script("report", "results")
    memory = next(body for title, _, body in _content("results/report.html")["sections"] if title == "Bytes of memory")
    check(memory == [["memory", 7]], "an entry of one number", memory)
    kept.unlink()
    _script("report", "results")
    check("not finished" in _content("results/report.html")["facts"]["status"], "status")


def a_sweep_is_a_table_and_a_plot():
    deck(DECK)
    deck("deck: deck.yaml\ngrid: {Membrane/capillary number: [0.1, 0.2, -1]}\nrecord: {A: area, D: taylor_inertia}\n", "study.yaml")
    _script("sweep", "study.yaml")
    _script("report", "results/study", "-o", "page.html")
    content = _content("page.html")
    check(content["scatter"]["keys"] == ["Membrane/capillary number"] and len(content["scatter"]["values"]["D"]) == 3, content["scatter"])
    rows = [dict(zip(content["sections"][0][2][0], row)) for row in content["sections"][0][2][1:]]
    check([row["status"] for row in rows] == ["done", "done", "refused"] and "Membrane/capillary number" in rows[2]["message"] and not rows[0]["message"], rows)
    told = _used("page.html")
    check(told is None or {"Membrane/capillary number", "A, length²"} <= set(told["texts"]), told)
    check(told is None or told["value"].count(", ") == 1, told)


def a_fit_is_a_picture_and_a_table():
    deck(DECK)
    pathlib.Path("curve.csv").write_text("0.5,0.2\n0.75,0.25\n1,0.3\n")
    deck("deck: deck.yaml\nunknown: {Membrane/capillary number: {start: 0.2, to: 0.25}}\n"
         "experiments: {one: {data: [{series: taylor_inertia, curve: curve.csv, error: 0.01}]}}\n", "experiment.yaml")
    _script("fit", "experiment.yaml", "--jobs", "1")
    _script("report", "results/experiment", "-o", "page.html")
    row = dict(zip(*_content("page.html")["sections"][1][2][:2]))
    check(row["unknown"] == "Membrane/capillary number" and row.get("at bound") == "to", row)
    told = _used("page.html")
    check(told is None or (told["pictures"][0] > 300 and "Membrane/capillary number" in told["cells"]), told)


def unknowns_of_a_fit_have_the_units_of_the_deck():
    deck(DECK[:DECK.index("  Expect")].replace("  Flow:", "  Units: { length: 1 um, time: 1 ms, force: 1 nN }\n  Flow:").replace("capillary number: 0.3", "shear modulus: 1"))
    deck("deck: deck.yaml\nset: {Flow/viscosity: 0.2, Time/final time: 0.2}\nunknown: {Membrane/shear modulus: {start: 0.9}}\n"
         "experiments: {one: {data: [{series: taylor_inertia, value: 0.05, error: 0.01}, {series: length_x1, value: 2.1, error: 0.01}]}}\n", "experiment.yaml")
    _script("fit", "experiment.yaml", "--jobs", "1")
    _script("report", "results/experiment", "-o", "page.html")
    row = dict(zip(*_content("page.html")["sections"][1][2][:2]))
    check(row["unknown"] == "Membrane/shear modulus, nN/µm", row)
    check(yaml.safe_load(pathlib.Path("results/experiment/fit.yaml").read_text())["the deck's law"]["unknown"]["Membrane/shear modulus"]["unit"] == "nN/µm", "fit.yaml")


def a_directory_without_results_is_reported():
    pathlib.Path("empty").mkdir()
    said = _script("report", "empty", code=2)
    check("empty holds no run, sweep or fit" in said and said.count("\n") == 1, said)


main()
