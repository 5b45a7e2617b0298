"""Lists the series of a run with their last values, or prints some of them.

    tanktread-read results/first                            # all series with their last values, units and descriptions
    tanktread-read results/first -s time taylor_inertia     # numbers only, one line per step
    tanktread-read results/first --csv > first.csv          # all series or those of -s; the first line: time (s),…"""

import csv
import sys

from .mistakes import command_line, log
from .runs import run


def main():
    parser = command_line(__doc__)
    parser.add_argument("results", help="directory of a run's results, or a deck; a deck without results is run")
    parser.add_argument("-s", "--series", nargs="+", metavar="NAME",
                        help="print these series, one line per step, instead of the list")
    parser.add_argument("--csv", action="store_true", help="print a CSV table of these series, or of all, that begins "
                        "with their names and units")
    arguments = parser.parse_args()
    result = run(arguments.results)
    if arguments.csv:
        names = arguments.series or sorted(result.series, key=lambda name: name != "time")
        out = csv.writer(sys.stdout, lineterminator="\n")
        out.writerow(map(result.column, names))
        out.writerows(zip(*(result.series[name].tolist() for name in names)))
        return
    if arguments.series:
        for values in zip(*(result.series[name] for name in arguments.series)):
            log.info(" ".join(f"{value:.16g}" for value in values))
        return
    log.info(f"{result.name}: {len(result.series['time'])} rows, {len(result.snapshots())} snapshots")
    for name, values in sorted(result.series.items()):
        last = values[-1] if len(values) else float("nan")
        log.info(f"  {name:24} {last:14.7g}  {result.units[name]:14}  {result.descriptions[name]}")
