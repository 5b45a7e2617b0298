#!/usr/bin/python3
"""Checks the functions that kernels compiled for several instruction sets export to the linker. Only functions in the namespace of the
instruction set are allowed. Otherwise the linker may use a function compiled for one instruction set everywhere, also on a processor
that does not have it.

Usage: kernels.py <build directory>
"""
import pathlib
import subprocess
import sys

SETS = "avx2", "avx512"


def errors(name, file):
    symbols = subprocess.run(["nm", "--demangle", "--defined-only", "--extern-only", file], check=True, capture_output=True, text=True).stdout
    for line in symbols.splitlines():
        _, kind, symbol = line.split(" ", 2)
        if kind in "TWi" and f"::{name}::" not in symbol:
            yield f"{file}: {kind} {symbol}"


found = [(name, file) for name in SETS for file in pathlib.Path(sys.argv[1]).rglob(f"*_{name}.dir/**/*_kernel.cpp.o")]
bad = [error for name, file in found for error in errors(name, file)]
print("\n".join(bad) if found else "no kernels")
sys.exit(bool(bad) or not found)
