#!/usr/bin/python3
"""Lists what a run recorded, or prints some of its series. Your own scripts take the same from the module `tanktread`."""

import argparse
import sys

import needs  # before what it looks for
from tanktread import *  # scripts of users' may say read.run


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("results", help="directory of a run's results, or a deck")
    parser.add_argument("-s", "--series", nargs="+", metavar="NAME", help="print these series, one line a step, instead of the list")
    arguments = parser.parse_args()
    result = run(arguments.results)
    if arguments.series:
        unknown = [name for name in arguments.series if name not in result.series]
        if unknown:
            sys.exit(f"no series {unknown[0]}; there are: {', '.join(sorted(result.series))}")
        for values in zip(*(result.series[name] for name in arguments.series)):
            print(*(f"{value:.16g}" for value in values))
        return
    print(f"{result.name}: {len(result.series['time'])} rows, {len(result.snapshots())} snapshots")
    for name, values in sorted(result.series.items()):
        print(f"  {name:24} {values[-1] if len(values) else float('nan'):14.7g}  {result.units[name]:14}  {result.descriptions[name]}")


if __name__ == "__main__":
    main()
