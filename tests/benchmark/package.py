"""Imported first: the package tanktread of this source directory, and what most measurements use of it."""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "postproc"))
try:
    import numpy
    import tanktread
    from tanktread import interpolation
    from tanktread.figures import draw, literature, style
    from tanktread.mistakes import answer, expect
    from tanktread.studies import common as studies
except ModuleNotFoundError as error:
    sys.exit(f"{sys.executable} has no {error.name}: use Debian's /usr/bin/python3 (app/packages.txt)")

plt = style.plt
plt.switch_backend("Agg")
plt.rcParams.update(style.STYLE)
__all__ = ["answer", "draw", "expect", "interpolation", "literature", "numpy", "plt", "studies", "style", "tanktread"]
