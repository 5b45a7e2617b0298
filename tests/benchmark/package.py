"""Imported first: puts the package tanktread of this source directory on the path and sets the style of its figures."""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "postproc"))
try:
    import matplotlib
    from tanktread.figures import style
except ModuleNotFoundError as error:
    sys.exit(f"{sys.executable} has no {error.name}: use Debian's /usr/bin/python3 (app/packages.txt)")

matplotlib.use("Agg")
matplotlib.rcParams.update(style.STYLE)
