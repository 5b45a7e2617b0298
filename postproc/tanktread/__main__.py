"""The commands: tanktread-figure and others, or `python3 -m tanktread figure …` and so on."""

import importlib
import pathlib
import sys

from .mistakes import answer

COMMANDS = {"figure": ("figures", "command"), "sweep": ("studies.sweep", "main"), "fit": ("studies.fit", "main"),
            "outline": ("studies.outline", "main"), "phases": ("studies.phases", "main"),
            "critical": ("studies.critical", "main"), "report": ("report", "main"), "read": ("read", "main"),
            "surface": ("shapes.command", "main")}


def main():
    """Runs the command whose name is the name of the program or, otherwise, the first argument."""
    name = pathlib.Path(sys.argv[0]).name.removeprefix("tanktread-")
    if name not in COMMANDS:
        if len(sys.argv) < 2 or sys.argv[1] not in COMMANDS:
            sys.exit(f"usage: python3 -m tanktread {{{','.join(COMMANDS)}}} …")
        name = sys.argv.pop(1)
        sys.argv[0] = f"tanktread-{name}"
    module, function = COMMANDS[name]
    answer(lambda: getattr(importlib.import_module(f"tanktread.{module}"), function)())


if __name__ == "__main__":
    main()
