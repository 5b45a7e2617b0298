"""Puts the pages of the manual together: assemble.py DIRECTORY writes DIRECTORY/source from the Markdown files of the repository.

Links between files become links between pages, decks become pages, tables get figures (tables.py), and equation numbers and
keys of decks become links. A page is written only if it has changed, so that Sphinx reads only what is new."""

import pathlib
import re
import sys
import xml.etree.ElementTree as xml

import tables

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Files of the repository that are pages: where they are in the manual. The pages of inputs/manual keep their names.
PAGES = {
    "README.md": "start.md",
    "inputs/README.md": "decks/index.md",
    "inputs/REFERENCE.md": "decks/reference.md",
    "inputs/SERIES.md": "results/series.md",
    "lib/README.md": "theory/equations.md",
    "lib/CMakeLists.txt": "developers/modules.md",
    "app/packages.txt": "developers/packages.md",
    "CONTRIBUTING.md": "developers/contributing.md",
    "tests/benchmark/README.md": "developers/benchmarks.md",
    "tests/stability/README.md": "limits/edges.md",
    "CHANGELOG.md": "developers/changelog.md",
    "LICENSE": "developers/licence.md",
    "CITATION.cff": "developers/citation.md",
}
TITLES = {"lib/CMakeLists.txt": "Modules of the library", "app/packages.txt": "Packages", "LICENSE": "Licence",
          "CITATION.cff": "Citation"}
LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^()\s]+)\)")
FENCE = re.compile(r"^ {0,3}(```+|~~~+)")


class Manual:
    """The source tree of the manual."""

    def __init__(self, directory):
        self.source = pathlib.Path(directory) / "source"
        self.xml = pathlib.Path(directory) / "xml"
        self.written = set()
        self.pages = dict(PAGES)
        for path in sorted((ROOT / "inputs/manual").rglob("*.md")):
            self.pages[str(path.relative_to(ROOT))] = str(path.relative_to(ROOT / "inputs/manual"))
        for path in sorted((ROOT / "inputs/cookbook").glob("*.md")):
            name = "index.md" if path.name == "README.md" else path.name
            self.pages[str(path.relative_to(ROOT))] = f"cookbook/{name}"
        for path in sorted([*(ROOT / "inputs").glob("*.yaml"), *(ROOT / "inputs").glob("[!m]*/*.yaml")]):
            inside = path.relative_to(ROOT / "inputs")
            self.pages[str(path.relative_to(ROOT))] = f"decks/{inside.with_suffix('.md')}"
        self.keys = self._keys()
        self.equations = set(re.findall(r"\((\d\.\d+)\)(?:  P-[\w., -]+)?$", (ROOT / "lib/README.md").read_text(), re.M))

    @staticmethod
    def _keys():
        """Returns the anchors of all sections and keys of decks, by `Section` and `Section/key`."""
        found, section = {}, None
        for line in (ROOT / "inputs/REFERENCE.md").read_text().splitlines():
            if line.startswith("## "):
                section = line[3:]
                found[section] = anchor(section)
            elif key := re.match(r"\| `([^`]+)` \|", line):
                found[f"{section}/{key[1]}"] = anchor(f"{section}/{key[1]}")
        return found

    def write(self, page, text):
        path = self.source / page
        self.written.add(path)
        content = text if isinstance(text, bytes) else text.encode()
        if not path.exists() or path.read_bytes() != content:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)

    def link(self, mark, text, target, here, page):
        """Returns a link from a file of the repository as a link of the manual."""
        drawn = self.source / pathlib.Path(page).parent / target in self.written
        if drawn or re.match(r"[a-z]+:", target) or target.startswith("#"):
            return f"{mark}[{text}]({target})"
        path, _, fragment = target.partition("#")
        there = (ROOT / here).parent.joinpath(path).resolve()
        if not there.exists():
            raise SystemExit(f"{here}: a link to {target}, which does not exist")
        name = str(there.relative_to(ROOT))
        if there.is_dir():
            name = f"{name}/README.md" if (there / "README.md").exists() else ""
            if not name:
                return text
        if name in self.pages:
            goal = self.pages[name]
            if name == "lib/README.md" and fragment.startswith("adding-"):
                goal = "developers/recipes.md"
        else:
            goal = f"files/{name}"
            self.write(goal, there.read_bytes())
        return f"{mark}[{text}]({relative(page, goal)}{'#' + fragment if fragment else ''})"

    def prose(self, line, page, equations):
        """Returns a line outside of code blocks with links from equation numbers and keys."""
        pieces = re.split(r"(`[^`]+`|!?\[[^\]]*\]\([^)]*\))", line)
        for k, piece in enumerate(pieces):
            if piece.startswith("`"):
                key = piece.strip("`").split("=")[0].split(": ")[0]
                if key in self.pages and key.endswith(".yaml"):
                    pieces[k] = f"[{piece}]({relative(page, self.pages[key])})"
                elif "/" in key and key in self.keys and page != "decks/reference.md":
                    pieces[k] = f'<a href="{relative(page, "decks/reference.html")}#{self.keys[key]}">{piece}</a>'
            elif equations and not piece.startswith(("[", "!")):
                pieces[k] = re.sub(r"\((\d\.\d+)\)", lambda found: self.equation(found, page), piece)
        return "".join(pieces)

    def equation(self, found, page):
        if found[1] not in self.equations:
            return found[0]
        return f'<a href="{relative(page, "theory/equations.html")}#eq-{found[1]}">{found[0]}</a>'

    def page(self, here, text, page):
        """Writes a page from the text of the file `here`."""
        text = self.figures(text, page)
        lines, fence, table = [], None, "accuracy/" in page
        for line in text.splitlines():
            mark = FENCE.match(line)
            if mark and (fence is None or line.strip() == fence):
                fence = mark[1] if fence is None else None
                line = re.sub(r"^( *`+)csv$", r"\1text", line)  # Pygments has no colours for it
            elif fence is None and line.startswith("    ") and not re.match(r" *(\d+\.|[-*]) ", line):
                labels = re.findall(r"\((\d\.\d+)\)(?:  P-[\w., -]+)?$", line) if page == "theory/equations.md" else []
                if labels:
                    self.anchor_before_block(lines, labels[0])
            elif fence is None:
                line = LINK.sub(lambda found: self.link(found[1], found[2], found[3], here, page), line)
                line = line if line.startswith("#") else self.prose(line, page, not (table and line.startswith("|")))
            lines.append(line)
        self.write(page, "\n".join(lines) + "\n")

    @staticmethod
    def anchor_before_block(lines, label):
        """Puts the anchor of an equation before the code block that continues or begins after the last line."""
        start = len(lines)
        while start and lines[start - 1].startswith("    "):
            start -= 1
        if start > 1 and lines[start - 2].startswith("<span"):
            lines[start - 2] += f'<span id="eq-{label}"></span>'
        else:
            lines[start:start] = [f'<span id="eq-{label}"></span>', ""]

    def figures(self, text, page):
        """Replaces the requests for figures by figures of the table above."""
        lines, table, out, count = text.splitlines(), [], [], 0
        block = None
        for line in lines:
            if line.startswith("|"):
                table = table + [line] if out and out[-1].startswith("|") else [line]
            if line.startswith("```{table-figure}"):
                block = {"caption": line.removeprefix("```{table-figure}").strip()}
            elif block is not None and line.startswith("```"):
                count += 1
                name = f"{pathlib.Path(page).stem}_{count}.svg"
                path = self.source / pathlib.Path(page).parent / "figures" / name
                path.parent.mkdir(parents=True, exist_ok=True)
                self.written.add(path)
                wish = path.with_suffix(".txt")
                self.written.add(wish)
                said = repr((table, block, pathlib.Path(tables.__file__).read_text()))
                if not path.exists() or not wish.exists() or wish.read_text() != said:
                    try:
                        tables.draw(table, block, path)
                    except (ValueError, IndexError) as error:
                        raise SystemExit(f"{page}: figure '{block['caption']}': {error}") from error
                    wish.write_text(said)
                caption = block["caption"].replace("`", "")
                out += [f"![{caption}](figures/{name})", "", f"*{caption}*"]
                block = None
                continue
            elif block is not None:
                key, value = re.match(r":(\w+): *(.*)", line).groups()
                block[key] = value
            if block is None:
                out.append(line)
        return "\n".join(out)


def anchor(key):
    return "key-" + re.sub(r"[^a-z0-9]+", "-", key.lower())


def relative(page, goal):
    """Returns the path of one page from another."""
    return "../" * page.count("/") + goal


def reference(text):
    """Gives every section and key of inputs/REFERENCE.md an anchor."""
    section, lines = None, []
    for line in text.splitlines():
        if line.startswith("## "):
            section = line[3:]
            lines += [f'<span id="{anchor(section)}"></span>', ""]
        elif key := re.match(r"\| `([^`]+)` \|", line):
            line = f'| <span id="{anchor(f"{section}/{key[1]}")}"></span>' + line[2:]
        lines.append(line)
    return "\n".join(lines)


def split_equations(text):
    """Returns the theory and the recipes of lib/README.md as two pages."""
    start = text.index("\n## Recipes\n") + 1
    end = text.index("\n## Where this differs from the paper") + 1
    recipes = text[start:end].replace("## Recipes", "# Adding parts", 1).replace("\n### ", "\n## ")
    return text[:start] + text[end:], recipes


def toctree(entries, hidden="", depth=1):
    return f"```{{toctree}}\n:maxdepth: {depth}\n{hidden}\n" + "\n".join(entries) + "\n```\n"


def api(manual):
    """Writes a page per namespace of the C++ library, and the list of them."""
    index = xml.parse(manual.xml / "index.xml").getroot()
    spaces = sorted(c.find("name").text for c in index if c.get("kind") == "namespace")
    spaces = [name for name in spaces if name.startswith("tanktread") and "INSTRUCTIONS" not in name]  # of kernels
    for name in spaces:
        manual.write(f"api/cpp/{name.replace('::', '-')}.rst",
                     f"{name}\n{'=' * len(name)}\n\n.. doxygennamespace:: {name}\n   :content-only:\n   :members:\n")
    return [f"cpp/{name.replace('::', '-')}" for name in spaces]


def main():
    manual = Manual(sys.argv[1])
    decks = []
    for here, page in manual.pages.items():
        path = ROOT / here
        text = path.read_text(encoding="utf-8")
        if path.suffix == ".yaml":
            decks.append(page.removeprefix("decks/").removesuffix(".md"))
            manual.write(page, f"# {path.name}\n\n`tanktread {here}`\n\n```yaml\n{text}```\n" if "studies/" not in here else
                         f"# {path.name}\n\n```yaml\n{text}```\n")
            continue
        if here == "README.md":
            continue  # its statements are in start.md
        if here in TITLES:
            text = f"# {TITLES[here]}\n\n`{here}`:\n\n```text\n{text}```\n"
        if here == "lib/README.md":
            text, recipes = split_equations(text)
            manual.page(here, recipes, "developers/recipes.md")
        if here == "inputs/REFERENCE.md":
            text = reference(text)
        if here == "inputs/README.md":
            text += "\n## All decks\n\n" + toctree(sorted(decks_of(manual)))
        if here == "inputs/manual/api/index.md":
            text += "\n" + toctree(api(manual))
        manual.page(here, text, page)
    cookbook = [p.removesuffix(".md") for p in manual.pages.values() if p.startswith("cookbook/") and p != "cookbook/index.md"]
    index = (ROOT / "inputs/manual/index.md").read_text()
    if cookbook:
        text = (ROOT / "inputs/cookbook/README.md").read_text()
        listed = toctree([name.removeprefix("cookbook/") for name in cookbook], ":hidden:\n")
        manual.page("inputs/cookbook/README.md", text.replace("\n## ", f"\n{listed}\n## ", 1), "cookbook/index.md")
    else:
        index = index.replace("cookbook/index\n", "")
    manual.page("inputs/manual/index.md", index, "index.md")
    for path in sorted(manual.source.rglob("*")):
        if path.is_file() and path not in manual.written:
            path.unlink()


def decks_of(manual):
    return [page.removeprefix("decks/").removesuffix(".md") for here, page in manual.pages.items() if here.endswith(".yaml")]


main()
