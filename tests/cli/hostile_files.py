#!/usr/bin/python3
# Tests that every command of the Python package reports damaged files, NaN and missing series in one sentence with exit
# code 2, and accepts file names with spaces and umlauts.
import os
import pathlib
import shutil
import sys

import h5py
import numpy
import yaml

from harness import SOURCE, check, deck, main, package, run

sys.path.append(str(SOURCE / "postproc"))
from tanktread import Run, figures

DECK = """
Tanktread:
  Flow: { type: simple shear }
  Membrane: { law: neo-Hookean, capillary number: 0.3 }
  Surface: { elements per side: 3 }
  Time: { final time: 0.2 }
  Output: { interval: 0.1 }
"""
STUDY = "deck: deck.yaml\ngrid: {Membrane/capillary number: [0.1, 0.2]}\nrecord: {D: taylor_inertia}\n"
FIT = "deck: deck.yaml\nunknown: {Membrane/capillary number: {start: 0.3}}\nexperiments: {one: {data: [%s]}}\n"
CURVE, OUTLINE = "{series: taylor_inertia, curve: %s, error: 0.1}", "{outline: %s, scale: 1, error: 0.1}"
PHASES = "deck: deck.yaml\nalong: {key: Flow/shear rate, from: 1, to: 2, within: 1.5}\nacross: {Particle/radius: [1]}\ncurves: {one: {}}\n"
FROM_MANY_RUNS = {"step", "viscosity", "tweezers", "treading", "recovery"}  # figures that make their runs from a deck or study
CASES = []  # (words of the command, exit code, standard error)


def _ended(*words):
    """Returns the exit code and the standard error of a command."""
    result = package(*words)
    return result.returncode, "".join(line for line in result.stderr.splitlines(True) if " runs" not in line)  # progress


def _refused(*words):
    code, said = _ended(*words)
    if not (code == 2 and said.count("\n") == 1 and "Traceback" not in said and len(said) < 500):
        CASES.append(f"{' '.join(map(str, words))}: exit code {code}: {said[-700:]}")


def _all_refused():
    found = list(CASES)
    CASES.clear()
    check(not found, len(found), "cases:\n", "\n".join(found))


def _run(name="one", text=DECK):
    run(deck(text, f"{name}.yaml"), "--output", name, "--quiet")
    return pathlib.Path(name)


def _damaged(name, damage):
    """Returns the directory of a run with its record changed by damage(file)."""
    shutil.copytree("one", name)
    with h5py.File(f"{name}/run.h5", "r+") as file:
        damage(file)
    return name


def _cut(path, share):
    content = path.read_bytes()
    path.write_bytes(content[:int(len(content) * share)])


def _drawn_from_runs():
    return [name for name in figures.FIGURES if name not in FROM_MANY_RUNS]


def truncated_or_incomplete_records():
    _run()
    bad = [_damaged("no_series", lambda file: file.pop("series")), _damaged("no_deck", lambda file: file.pop("deck")),
           _damaged("no_unit", lambda file: file["series/volume"].attrs.pop("unit"))]
    for name, share in ("half", 0.5), ("most", 0.97), ("empty", 0):
        shutil.copytree("one", name)
        _cut(pathlib.Path(name, "run.h5"), share)
        bad.append(name)
    pathlib.Path("text").mkdir()
    pathlib.Path("text/run.h5").write_text("nothing")
    for name in (*bad, "text", "nowhere"):
        _refused("read", name)
        _refused("report", name)
        for figure in "deformation", "shape":
            _refused("figure", figure, name)
    _all_refused()


def missing_or_nan_series():
    _run()

    def nan(file):
        file["series/volume"][...] = numpy.nan

    def bare(file):
        for name in set(file["series"]) - {"time"}:
            del file[f"series/{name}"]

    pathlib.Path("curve.csv").write_text("t,taylor_inertia\n0,0\n0.1,0.1\n0.2,0.2\n")
    for name, damage in ("nan", nan), ("bare", bare):
        _damaged(name, damage)
        # NaN is detected when the file is read, so that one figure suffices
        for figure in _drawn_from_runs() if name == "bare" else ["deformation"]:
            if figure not in ("shape", "work"):
                _refused("figure", figure, name, *(["--curve", "curve.csv"] if figure == "convergence" else []))
    _refused("read", "nan")
    _refused("report", "nan")
    _refused("read", "bare", "-s", "taylor_inertia")

    def late(file):
        file["series/volume"][:1] = numpy.nan

    Run(_damaged("late", late))  # an earlier version, which did not record the volume, began the run
    _damaged("no_row", lambda file: [(file["series"].__delitem__(name), file["series"].create_dataset(name, data=[]).attrs.update(unit="1", description=""))
                                     for name in list(file["series"])])
    _refused("figure", "deformation", "no_row")
    _refused("figure", "shape", "one", "--field", "nothing")
    _refused("figure", "nothing", "one")
    _all_refused()


def truncated_snapshots_and_summaries():
    _run()
    for name, part, share in (("a", "run.hdf.series", 0.5), ("b", "summary.yaml", 1), ("c", "snapshot", 0.5), ("d", "snapshot", 0)):
        shutil.copytree("one", name)
        path = next(pathlib.Path(name).glob("**/*[0-9].hdf")) if part == "snapshot" else pathlib.Path(name, part)
        for one in path.parent.glob("*.hdf") if part == "snapshot" else [path]:
            _cut(one, share)
        if part == "summary.yaml":
            path.write_text("a: [")
        _refused("figure", "shape", name)
        _refused("report", name)
    pathlib.Path("a/run.hdf.series").write_text("{}")
    pathlib.Path("b/summary.yaml").write_text("text")
    _refused("figure", "shape", "a")
    _refused("report", "b")
    _refused("read", _damaged("cut_deck", lambda file: [file.pop("deck"), file.create_dataset("deck", data="Tanktread: [")]))
    _all_refused()


def snapshots_and_scenes_without_the_data_of_a_figure():
    _run()
    for name, text in ("a", '{"files": [{"name": 3}]}'), ("b", '{"files": 1}'), ("c", '{"files": [{"name": "x.hdf", "time": "t"}]}'):
        shutil.copytree("one", name)
        pathlib.Path(name, "run.hdf.series").write_text(text)
        _refused("report", name)
        _refused("figure", "shape", name)
    shutil.copytree("one", "bare")
    for path in pathlib.Path("bare").glob("**/*.hdf"):
        with h5py.File(path, "r+") as file:
            if "VTKHDF/PointData" in file:
                for field in list(file["VTKHDF/PointData"]):
                    del file["VTKHDF/PointData"][field]
    _refused("report", "bare")
    _refused("figure", "shape", "bare")
    for figure in "surfactant", "tube", "duct", "tube-motion", "channel":
        _refused("figure", figure, "one")
        check("Errno" not in _ended("figure", figure, "one")[1], figure)
    _all_refused()


def empty_tables_and_files_that_are_not_tables():
    _run()
    _run("wall", DECK.replace("  Membrane:", "  Particle: { center: [0, 0, 1.5] }\n  Wall: { point: [0, 0, 0], normal: [0, 0, 1] }\n  Membrane:"))
    _run("pair", DECK.replace("  Membrane: { law: neo-Hookean, capillary number: 0.3 }\n  Surface: { elements per side: 3 }\n",
                              "  Particles: { defaults: { Membrane: { capillary number: 0.3 }, Surface: { elements per side: 3 } },\n"
                              "    upper: { center: [-1.5, 0.0, 0.5] }, lower: { center: [1.5, 0.0, -0.5] } }\n"))
    for name, text in (("empty.csv", ""), ("nan.csv", "t,taylor_inertia\n0,0\n0.1,nan\n0.2,0.2\n"), ("one.csv", "t\n0\n1\n"),
                       ("binary.csv", "\x00\x01,\x02\n")):
        pathlib.Path(name).write_text(text)
        _refused("figure", "convergence", "one", "--curve", name)
        for text in (CURVE, OUTLINE):
            pathlib.Path("fit.yaml").write_text(FIT % (text % name))
            _refused("fit", "fit.yaml", "--jobs", "1")
        for figure in "encounter", "plane-wall":
            _refused("figure", figure, "wall" if figure == "plane-wall" else "pair", "--curve", name)
        _refused("figure", "step", "deck.yaml", "--curves", name, name, name)
        _refused("figure", "deformation", "one", "--curves", name)
        _refused("outline", name)
    pathlib.Path("late.csv").write_text("t,taylor_inertia\n100,0\n200,0.1\n")
    _refused("figure", "convergence", "one", "--curve", "late.csv")
    pathlib.Path("exact.csv").write_text("0,0,0.1\n0.1,0.05,0\n0.2,0.1,0.1\n")
    for datum in "{series: taylor_inertia, curve: exact.csv}", "{series: taylor_inertia, value: 0.1, error: 0}", CURVE.replace("0.1", "1e-x") % "exact.csv":
        pathlib.Path("fit.yaml").write_text(FIT % datum)
        _refused("fit", "fit.yaml", "--jobs", "1")
    _all_refused()


def files_that_are_not_studies():
    deck(DECK)
    for name, content in (("empty.yaml", b""), ("binary.yaml", b"\x00\xff\xfe"), ("latin.yaml", "deck: für.yaml".encode("latin-1")), ("list.yaml", b"[1, 2]"),
                          ("cut.yaml", STUDY.encode()[:40]), ("csv.yaml", b"deck: x.csv\n")):
        pathlib.Path(name).write_bytes(content)
        for command in "sweep", "fit", "phases":
            _refused(command, name)
        _refused("figure", "viscosity", name)
    _refused("sweep", "nowhere.yaml")
    _refused("critical", "nowhere.yaml", "--between", "1", "2", "--past", "0")
    _refused("critical", "binary.yaml", "--between", "1", "2", "--past", "0")
    _refused("figure", "step", "binary.yaml")
    _all_refused()


def truncated_results_of_studies():
    deck(DECK)
    pathlib.Path("study.yaml").write_text(STUDY)
    check(_ended("sweep", "study.yaml", "--jobs", "1")[0] == 0, "the sweep")
    pathlib.Path("curve.csv").write_text("0.1,0.04\n0.2,0.08\n")
    pathlib.Path("fit.yaml").write_text(FIT % (CURVE % "curve.csv"))
    check(_ended("fit", "fit.yaml", "--jobs", "1")[0] == 0, "the fit")
    for name, share in (("table.h5", 0.5), ("table.h5", 0)):
        _cut(pathlib.Path("results/study", name), share)
        _refused("report", "results/study")
    text = pathlib.Path("results/fit/fit.yaml").read_text()
    for wrong in "", "a: [", "law: {}", "1", text[:60]:
        pathlib.Path("results/fit/fit.yaml").write_text(wrong)
        _refused("report", "results/fit")
    pathlib.Path("results/fit/fit.yaml").write_text(text)
    pathlib.Path("results/fit/fit.png").unlink()
    _refused("report", "results/fit")
    for path in [*pathlib.Path("results/study/runs").glob("*/run.h5"), *pathlib.Path("results/fit/runs").glob("*/run.h5")]:
        _cut(path, 0.5)
    _refused("sweep", "study.yaml", "--jobs", "1")
    _refused("fit", "fit.yaml", "--jobs", "1")
    _all_refused()
    for path in pathlib.Path("results/study/runs").glob("*/outcome.json"):
        _cut(path, 0.5)
    check(_ended("sweep", "study.yaml", "--jobs", "1")[0] == 0, "runs whose notes are cut are made again")


def files_that_are_not_images_and_unwritable_paths():
    from matplotlib.image import imsave

    _run()
    pathlib.Path("file").write_text("")
    imsave("grey.png", numpy.zeros((64, 64)), cmap="gray")
    imsave("tiny.png", numpy.zeros((1, 1)), cmap="gray")
    shutil.copy("grey.png", "cut.png")
    _cut(pathlib.Path("cut.png"), 0.5)
    x = numpy.linspace(-2, 2, 128)
    imsave("good.png", (x**2 + x[:, None] ** 2 < 1) * 1.0, cmap="gray")
    for name in "grey.png", "tiny.png", "cut.png", "nowhere.png", ".":
        _refused("outline", name)
    imsave("clear.png", numpy.dstack([numpy.zeros((128, 128, 3)), x**2 + x[:, None] ** 2 < 1]))
    check(_ended("outline", "clear.png")[0] == 0, "a shape in the opacity only")
    _refused("outline", "good.png", "--points", "0")
    _refused("outline", "good.png", "-o", "file/points.csv")
    _refused("outline", "good.png", "--overlay", "file/points.png")
    _refused("report", "one", "-o", "file/page.html")
    _refused("figure", "deformation", "one", "-o", "file/picture.png")
    pathlib.Path("study.yaml").write_text(STUDY)
    _refused("sweep", "study.yaml", "--output", "file/results")
    _refused("phases", "study.yaml", "--output", "file/results")
    _all_refused()


def file_names_with_spaces_and_umlauts_are_accepted():
    place = pathlib.Path("ein Ort für Läufe")
    place.mkdir()
    os.chdir(place)
    run(deck(DECK, "größer als 1.yaml"), "--output", "lauf eins", "--quiet")
    pathlib.Path("studie für D.yaml").write_text(STUDY.replace("deck.yaml", "größer als 1.yaml"))
    pathlib.Path("kurve ä.csv").write_text("t,taylor_inertia\n0.1,0.04\n0.2,0.08\n")
    pathlib.Path("fit ö.yaml").write_text((FIT % (CURVE % "kurve ä.csv")).replace("deck.yaml", "größer als 1.yaml"))
    pathlib.Path("phasen ß.yaml").write_text(PHASES.replace("deck.yaml", "größer als 1.yaml"))
    from matplotlib.image import imsave

    x = numpy.linspace(-2, 2, 128)
    imsave("bild ü.png", (x**2 + x[:, None] ** 2 < 1) * 1.0, cmap="gray")
    for words, code in ((["read", "lauf eins"], 0), (["report", "lauf eins", "-o", "seite ü.html"], 0), (["figure", "deformation", "lauf eins", "-o", "ä ö.png"], 0),
                        (["figure", "convergence", "lauf eins", "--curve", "kurve ä.csv", "-o", "k ä.png"], 0), (["sweep", "studie für D.yaml", "--jobs", "1"], 0),
                        (["report", "results/studie für D"], 0), (["fit", "fit ö.yaml", "--jobs", "1"], 0), (["report", "results/fit ö"], 0),
                        (["outline", "bild ü.png", "-o", "rand ü.csv"], 0), (["phases", "phasen ß.yaml", "--output", "phasen ü"], 2),
                        (["critical", "größer als 1.yaml", "--between", "1", "2", "--past", "9", "--output", "kritisch ü"], 2)):
        ended, said = _ended(*words)
        check(ended == code and "Traceback" not in said and said.count("\n") == (code == 2), words, ended, said)
    check(yaml.safe_load(pathlib.Path("results/fit ö/fit.yaml").read_text()), "the fit")
    check(pathlib.Path("phasen ü/runs.csv").exists() and any(pathlib.Path("kritisch ü/runs").iterdir()), "runs")


main()
