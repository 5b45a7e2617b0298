#!/usr/bin/python3
# Tests of the reader of tables of the Python package. tests/unit/deck/table.cpp tests that of the program with the same tables.
import pathlib
import sys

import yaml

from harness import SOURCE, check, main

sys.path.append(str(SOURCE / "postproc"))
import tanktread
from tanktread import tables


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
    for path, words in (("none.csv", "there is no file none.csv"), ("folder", "folder is a directory"), ("/dev/zero", "/dev/zero is a directory or a device")):
        try:
            check(not tables.read(path), path)
        except tanktread.Mistake as mistake:
            check(words in str(mistake), mistake)


def all_columns_are_returned_by_default():
    pathlib.Path("table.csv").write_text("a (um),b\n1,2\n")
    check(vars(tables.read("table.csv")) | {"values": None} == {"columns": ["a", "b"], "units": ["um", None], "lines": [2], "values": None}, "names")
    pathlib.Path("table.csv").write_text("1.0 2\n")
    check(tables.read("table.csv").columns == ["column 1", "column 2"], "no names")


main()
