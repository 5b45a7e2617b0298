"""Lists the series of a run with their last values, or prints some of them."""

from .mistakes import command_line, log
from .runs import run


def main():
    parser = command_line(__doc__)
    parser.add_argument("results", help="directory of a run's results, or a deck; a deck without results is run")
    parser.add_argument("-s", "--series", nargs="+", metavar="NAME",
                        help="print these series, one line per step, instead of the list")
    arguments = parser.parse_args()
    result = run(arguments.results)
    if arguments.series:
        for values in zip(*(result.series[name] for name in arguments.series)):
            log.info(" ".join(f"{value:.16g}" for value in values))
        return
    log.info(f"{result.name}: {len(result.series['time'])} rows, {len(result.snapshots())} snapshots")
    for name, values in sorted(result.series.items()):
        last = values[-1] if len(values) else float("nan")
        log.info(f"  {name:24} {last:14.7g}  {result.units[name]:14}  {result.descriptions[name]}")
