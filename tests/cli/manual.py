#!/usr/bin/python3
# label: long
# Tests that the manual is built without warnings and has no dead links, and that its search finds important words. If a
# browser is available, tests that it shows the pages.
import html.parser
import importlib.util
import pathlib
import re
import shutil
import subprocess
import urllib.parse

from harness import SOURCE, check, main, shown

NEEDED = {"sphinx": "python3-sphinx", "myst_parser": "python3-myst-parser", "breathe": "python3-breathe",
          "sphinx_rtd_theme": "python3-sphinx-rtd-theme"}


class _Page(html.parser.HTMLParser):
    """Links, anchors and loaded files of a page."""

    def __init__(self, path):
        super().__init__()
        self.links, self.anchors, self.loaded = [], set(), []
        self.feed(path.read_text())

    def handle_starttag(self, tag, attributes):
        of = dict(attributes)
        self.anchors |= {of[key] for key in ("id", "name") if of.get(key)}
        if tag == "a" and of.get("href"):
            self.links.append(of["href"])
        if of.get("src") or tag == "link" and of.get("href"):
            self.loaded.append(of.get("src") or of["href"])


def _dead(pages, path, link):
    """Returns whether a link within the site leads nowhere."""
    if re.match(r"[a-z]+:", link):
        return False
    name, _, anchor = urllib.parse.unquote(link).partition("#")
    there = (path.parent / name.partition("?")[0]).resolve() if name else path
    return not there.exists() or bool(anchor) and there in pages and anchor not in pages[there].anchors


def _in_a_browser(site):
    """not a test"""
    for address, expected in ("theory/index.html", r'class="MathJax_SVG"'), ("search.html?q=haematocrit", r'href="glossary.html'):
        document, console = shown(f"file://{site}/{address}")
        check(document is None or re.search(expected, document), address, "does not show", expected)
        check(not console, console)


def the_manual_is_a_site_without_dead_links():
    missing = [package for module, package in NEEDED.items() if not importlib.util.find_spec(module)]
    missing += [package for program, package in (("doxygen", "doxygen"),) if not shutil.which(program)]
    missing += [] if pathlib.Path("/usr/share/javascript/mathjax").exists() else ["libjs-mathjax"]
    if missing:
        print("skipped:", ", ".join(missing), "not installed: app/install manual")
        return
    built = subprocess.run([SOURCE / "inputs/manual/build", "--no-install", "site"], capture_output=True, text=True)
    check(built.returncode == 0 and not built.stderr, built.stdout, built.stderr)
    site = pathlib.Path("site/html").resolve()
    pages = {path: _Page(path) for path in site.rglob("*.html") if "_static" not in path.parts}
    check(len(pages) > 60, len(pages), "pages")
    dead = [f"{path.relative_to(site)}: {link}" for path, page in pages.items() for link in page.links + page.loaded if _dead(pages, path, link)]
    check(not dead, len(dead), "dead links", *dead[:20])
    outside = [f"{path.relative_to(site)}: {link}" for path, page in pages.items() for link in page.loaded if re.match(r"(https?:)?//", link)]
    check(not outside, "the network is asked for", *outside[:20])
    index = (site / "searchindex.js").read_text()
    for word in "surfac", "viscos", "haematocrit", "checkpoint":  # the index holds stems
        check(re.search(rf'"?{word}"?:', index), "the search does not know", word)
    for key in "Membrane/shear viscosity", "Quadrature/tolerance":
        anchor = "key-" + re.sub(r"[^a-z0-9]+", "-", key.lower())
        check(anchor in pages[site / "decks/reference.html"].anchors, "no anchor of", key)
    _in_a_browser(site)


main()
