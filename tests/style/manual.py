#!/usr/bin/python3
"""Checks that inputs/REFERENCE.md, inputs/SERIES.md and the table of rejections agree with the output of the program.

Usage: manual.py <source directory> <tanktread>
"""
import difflib
import pathlib
import subprocess
import sys

source, program = pathlib.Path(sys.argv[1]), sys.argv[2]
stale = []
for flag, name in ("--reference", "inputs/REFERENCE.md"), ("--reference-series", "inputs/SERIES.md"), ("--rejections", "inputs/manual/limits/rejections.md"):
    printed = subprocess.run([program, flag], check=True, capture_output=True, text=True).stdout
    stored = (source / name).read_text()
    if printed != stored:
        sys.stdout.writelines(difflib.unified_diff(stored.splitlines(True), printed.splitlines(True), name, flag))
        stale.append(f"The manual is stale: tanktread {flag} > {name}")
if stale:
    sys.exit("\n" + "\n".join(stale))
