#!/usr/bin/python3
# Tests of the reader of tables of the Python package. tests/unit/deck/table.cpp tests that of the program with the same tables.
import os
import pathlib
import sys

import numpy
import yaml

from harness import PROGRAM, SOURCE, check, deck, main, package, run

os.environ["TANKTREAD"] = str(PROGRAM)
sys.path.append(str(SOURCE / "postproc"))
import tanktread
from tanktread import files, tables


def foreign_tables_are_read_or_refused_in_one_sentence():
    cases = yaml.safe_load((SOURCE / "tests/unit/deck/tables.yaml").read_text())
    check(len(cases) > 40, len(cases))
    for name, case in cases.items():
        pathlib.Path("table.csv").write_bytes(case["text"].encode("latin-1"))
        wanted = case.get("as", ["time", "value", "error"])
        try:
            found = tables.read("table.csv", wanted, case.get("counts", [len(wanted)] if "as" in case else [2, 3]))
        except tanktread.Mistake as mistake:
            check(case.get("says", "no refusal") in str(mistake) and "table.csv" in str(mistake) and "\n" not in str(mistake), name, mistake)
            continue
        check(found.values.tolist() == case.get("values"), name, found)
        check("units" not in case or found.units == [one.encode("latin-1").decode() or None for one in case["units"]], name, found)


def a_file_that_cannot_be_read_is_refused():
    pathlib.Path("folder").mkdir()
    pathlib.Path("binary").write_bytes(b"\xff\x00")
    for path, words in (("none.csv", "there is no file none.csv"), ("folder", "folder is a directory"), ("/dev/zero", "/dev/zero is a directory or a device"), ("binary", "binary is")):
        for read in tables.read, files.parsed:
            try:
                check(not read(path), path)
            except tanktread.Mistake as mistake:
                check(str(mistake).startswith(words), mistake)


def the_series_of_a_run_are_a_table_with_names_and_units():
    units = "  Units: {length: 1 um, time: 1 ms, force: 1 pN}\n"
    motion = "  Particle: {motion: prescribed, velocity: [1, 0, 0]}\n  Surface: {elements per side: 3}\n"
    run(deck("Tanktread:\n" + units + motion), "--output", "results", "--quiet")
    pathlib.Path("table.csv").write_text(package("read", "results", "--csv").stdout)
    found, series = tables.read("table.csv", nan=True), tanktread.run("results").series
    check(sorted(found.columns) == sorted(series) and found.columns[0] == "time", found.columns)
    check(numpy.array_equal(found.values, numpy.transpose([series[name] for name in found.columns]), equal_nan=True), found.values)
    unit = dict(zip(found.columns, found.units))
    check([unit[name] for name in ("time", "area", "volume", "drag_x1", "kernel_evaluations")] == ["ms", "um^2", "um^3", "pN", None], unit)
    said = package("read", "results", "--csv", "-s", "time", "drag_x1").stdout
    check(said.splitlines()[0] == "time (ms),drag_x1 (pN)", said)


def all_columns_are_returned_by_default():
    pathlib.Path("table.csv").write_text("a (um),b\n1,2\n")
    check(vars(tables.read("table.csv")) | {"values": None} == {"columns": ["a", "b"], "units": ["um", None], "lines": [2], "values": None}, "names")
    pathlib.Path("table.csv").write_text("1.0 2\n")
    check(tables.read("table.csv").columns == ["column 1", "column 2"], "no names")


main()
