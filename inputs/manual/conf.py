"""Settings of Sphinx for the manual. inputs/manual/build calls it."""

import logging
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parents[1]
BUILD = pathlib.Path(sys.argv[sys.argv.index("-d") + 1]).parent if "-d" in sys.argv else SOURCE / "build/manual"
sys.path.insert(0, str(SOURCE / "postproc"))

project = "tanktread"
author = "the tanktread developers"
copyright = author
version = release = re.search(r"project\(tanktread VERSION (\S+)", (SOURCE / "CMakeLists.txt").read_text())[1]
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.mathjax", "breathe"]
source_suffix = [".md", ".rst"]

myst_enable_extensions = ["dollarmath", "deflist"]
myst_heading_anchors = 4
myst_update_mathjax = False  # its settings are of MathJax 3; Debian has 2
default_role = "literal"
autodoc_member_order = "bysource"
autodoc_typehints = "description"
breathe_projects = {"tanktread": str(BUILD / "xml")}
breathe_default_project = "tanktread"
# Sphinx 5 takes two overloads that differ only in a requires-clause for one declaration: deck::Section::key of a choice.
logging.getLogger("sphinx.sphinx.domains.cpp").addFilter(
    lambda record: not ("Duplicate C++ declaration" in str(record.msg) and "const Choice &words" in str(record.msg)))

exclude_patterns = ["files"]  # linked files that are not pages

html_theme = "sphinx_rtd_theme"
html_theme_options = {"navigation_depth": 3, "prev_next_buttons_location": None}
html_title = f"tanktread {release}"
html_static_path = [str(HERE / "static")]
html_css_files = ["manual.css"]
html_copy_source = False
html_show_search_summary = False  # a page that is opened from a disk may not read other pages
html_show_sphinx = False
pygments_style = "friendly"
# MathJax of Debian, copied into the site: formulas need no network.
MATHJAX = pathlib.Path("/usr/share/javascript/mathjax")
mathjax_path = "mathjax/MathJax.js?config=TeX-AMS_SVG"
mathjax2_config = {"showMathMenu": False, "messageStyle": "none", "tex2jax": {"processClass": "math"}}
MATHJAX_PARTS = ["MathJax.js", "config/TeX-AMS_SVG.js", "jax/element", "jax/input/TeX", "jax/output/SVG", "extensions"]


def docstring(app, what, name, thing, options, lines):
    """Turns a plain docstring into reStructuredText: single stars and trailing underscores are text, not markup."""
    for number, line in enumerate(lines):
        if not line.startswith("    "):
            pieces = re.split(r"(`[^`]*`)", line)
            pieces[::2] = [re.sub(r"([*|])", r"\\\1", re.sub(r"(\w)_(?=\W|$)", r"\1\\_", piece)) for piece in pieces[::2]]
            lines[number] = "".join(pieces)
    for number in range(len(lines) - 1, 0, -1):
        if lines[number].startswith("    ") and not lines[number - 1].strip():
            start = number
            while start > 0 and (lines[start - 1].startswith("    ") or not lines[start - 1].strip()):
                start -= 1
            if start == 0 or not lines[start - 1].rstrip().endswith("::"):
                if all(line.startswith("    ") or not line.strip() for line in lines[start:number + 1]) and start == number - 1:
                    lines.insert(number, "::")
                    lines.insert(number + 1, "")


def copy_mathjax(app, error):
    """Copies the parts of MathJax that the pages use into the site."""
    import shutil

    if error:
        return
    for part in MATHJAX_PARTS:
        there = pathlib.Path(app.outdir) / "_static/mathjax" / part
        there.parent.mkdir(parents=True, exist_ok=True)
        if (MATHJAX / part).is_dir():
            shutil.copytree(MATHJAX / part, there, dirs_exist_ok=True)
        else:
            shutil.copy(MATHJAX / part, there)


def setup(app):
    app.connect("autodoc-process-docstring", docstring)
    app.connect("build-finished", copy_mathjax)
