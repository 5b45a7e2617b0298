#!/usr/bin/python3
# A report is one page that needs no network; in a browser, where there is one, it turns, plays and shows values without an error.
import base64
import gzip
import json
import os
import pathlib
import re
import shutil
import subprocess

import numpy

from harness import PROGRAM, SOURCE, check, close, deck, main, run

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
  const told = {}, canvas = document.getElementById("shape"), plot = report.plots[0];
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
  plot.pointer = [plot.canvas.clientWidth / 2, 60]; plot.draw(); told.value = plot.said;
  document.body.dataset.told = JSON.stringify(told);
})();
</script>"""


def _script(name, *arguments, code=0):
    result = subprocess.run([SOURCE / f"postproc/tanktread-{name}", *arguments], capture_output=True, text=True, env=os.environ | {"TANKTREAD": str(PROGRAM)})
    check(result.returncode == code and "Traceback" not in result.stderr, name, result.stdout, result.stderr)
    return result.stdout + result.stderr


def _content(path):
    text = pathlib.Path(path).read_text()
    check(not re.search(r"(src|href)=[\"']?(https?:)?//", text) and "fetch(" not in text, "the page asks the network")
    return json.loads(gzip.decompress(base64.b64decode(re.search(r'type="text/plain">([^<]*)<', text)[1])))


def _used(path):
    """What the page does in a browser; None where there is none."""
    browser = shutil.which("chromium")
    if not browser:
        return None
    page = pathlib.Path("used.html")
    page.write_text(pathlib.Path(path).read_text().replace("</body>", USE + "</body>"))
    words = ["--headless=new", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--virtual-time-budget=20000", "--dump-dom",
             f"--user-data-dir={pathlib.Path('profile').resolve()}", "--enable-logging=stderr"]
    result = subprocess.run([browser, *words, page.resolve().as_uri()], capture_output=True, text=True, timeout=120)
    errors = [line for line in result.stderr.splitlines() if "CONSOLE" in line and "GL Driver Message" not in line]
    check(not errors and "data-error" not in result.stdout, errors, re.findall('data-error="[^"]*"', result.stdout))
    told = re.search('data-told="([^"]*)"', result.stdout)
    check(told, "the page did not get through", result.stdout[-500:])
    return json.loads(told[1].replace("&quot;", '"'))


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


def a_run_that_is_not_finished_says_so():
    deck(DECK)
    run("deck.yaml", "--output", "results", "--quiet", code=1)
    pathlib.Path("results/summary.yaml").unlink()
    _script("report", "results")
    check("not finished" in _content("results/report.html")["facts"]["status"], "status")


def a_sweep_is_a_table_and_a_plot():
    deck(DECK)
    deck("deck: deck.yaml\ngrid: {Membrane/capillary number: [0.1, 0.2]}\nrecord: {D: taylor_inertia}\n", "study.yaml")
    _script("sweep", "study.yaml")
    _script("report", "results/study", "-o", "page.html")
    content = _content("page.html")
    check(content["scatter"]["keys"] == ["Membrane/capillary number"] and len(content["scatter"]["values"]["D"]) == 2, content["scatter"])
    told = _used("page.html")
    check(told is None or told["value"].startswith("0."), told)


def what_is_no_result_is_said():
    pathlib.Path("empty").mkdir()
    said = _script("report", "empty", code=2)
    check("empty holds no run, sweep or fit" in said and said.count("\n") == 1, said)


main()
