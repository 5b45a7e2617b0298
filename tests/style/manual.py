#!/usr/bin/python3
"""inputs/REFERENCE.md is what the program prints of itself.

Usage: manual.py <source directory> <tanktread>
"""
import difflib
import pathlib
import subprocess
import sys

source, program = pathlib.Path(sys.argv[1]), sys.argv[2]
printed = subprocess.run([program, "--reference"], check=True, capture_output=True, text=True).stdout
stored = (source / "inputs/REFERENCE.md").read_text()
if printed != stored:
    sys.stdout.writelines(difflib.unified_diff(stored.splitlines(True), printed.splitlines(True), "inputs/REFERENCE.md", "--reference"))
    sys.exit("\nThe manual is stale: tanktread --reference > inputs/REFERENCE.md")
