#!/usr/bin/python3
"""Tests a page of inputs/cookbook.

Usage: cookbook.py <tanktread> <source directory> <page> [--pictures]

A page is tested as it stands, in a copy:
- A block ```yaml, ```bash, ```python or ```csv is the file that the last link above it names, and the deck `<page>.yaml` is among them.
- The commands of the blocks ```sh are run from the root of the copy and end with exit code 0. `Expect` in the decks holds the values that are expected.
- Each line of a block ```text is printed by these commands, in this order. Numbers agree to 1e-3, or to two units of the last digit. A line may end
  early, with an ellipsis.
- The commands make the picture ![...](name.png) as results/name.png. The committed picture has at most 60 kB.
- A number with a decimal point in the text is a rounded number of a block. Numbers in code style are not checked.
- What the text gives as `--set '...'` is accepted on top of the page's deck, and each command of the package that it names exists.
- Relative links lead to a file.

--pictures copies the pictures that were made into the source, reduced to 256 colours or fewer and 900 pixels.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from harness import PROGRAM, SOURCE, Failed, check

FENCE = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
NUMBER = re.compile(r"(?<![\w.])[-−]?\d+(?:\.\d+)?(?:e[-+]?\d+)?(?![\w])")
FOLDER = pathlib.Path("inputs/cookbook")
LARGEST = 60000  # size limit of a committed picture in bytes


def blocks(text):
    """Yields (kind, content, name of the last link above) of the fenced blocks of a page."""
    for match in FENCE.finditer(text):
        links = re.findall(r"\]\(([\w.]+)\)", text[:match.start()])
        yield match[1], match[2], links[-1] if links else None


def value(word):
    return float(word.replace("−", "-"))


def unit(word):
    """Returns one unit of the last digit of a number."""
    mantissa, _, exponent = word.partition("e")
    return 10.0**(int(exponent or 0) - len(mantissa.partition(".")[2]))


def agree(expected, found):
    """Returns whether two lines have equal words and nearly equal numbers, up to an ellipsis in the first one."""
    a, b = NUMBER.findall(expected), NUMBER.findall(found)
    words = [NUMBER.sub("#", line).split() for line in (expected, found)]
    if words[0] and words[0][-1] == "…":
        words = [words[0][:-1], words[1][:len(words[0]) - 1]]
    return words[0] == words[1] and all(abs(value(x) - value(y)) <= max(1e-3 * abs(value(x)), 2.0001 * unit(x)) for x, y in zip(a, b))


def copy(root):
    """Makes a copy of what the commands of a page use: the folder of the cookbook, and links to the rest."""
    for name in ("postproc", "tests", "lib"):
        (root / name).symlink_to(SOURCE / name)
    (root / "inputs").mkdir()
    for path in (SOURCE / "inputs").iterdir():
        if path.name != FOLDER.name:
            (root / "inputs" / path.name).symlink_to(path)
    shutil.copytree(SOURCE / FOLDER, root / FOLDER)
    (root / "build/release/app").mkdir(parents=True)
    (root / "build/release/app/tanktread").symlink_to(PROGRAM)


def execute(commands, root):
    """Runs the commands as one shell script that stops at the first failure. Returns what it prints."""
    environment = os.environ | {"TANKTREAD": str(PROGRAM), "PYTHONDONTWRITEBYTECODE": "1", "MPLCONFIGDIR": str(root), "OMP_NUM_THREADS": "1"}
    made = subprocess.run(["bash", "-e", "-u", "-o", "pipefail"], input=commands, cwd=root, env=environment, text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, check=False)
    check(made.returncode == 0, f"exit code {made.returncode} of\n{commands}\n{made.stdout}")
    return made.stdout


def a_page_shows_its_files_verbatim(page, text):
    shown = {name for kind, content, name in blocks(text) if kind not in ("sh", "text")}
    for kind, content, name in blocks(text):
        if kind not in ("sh", "text"):
            check(name and (SOURCE / FOLDER / name).is_file(), f"a block {kind} has no link to its file above it, but to {name}")
            check(content == (SOURCE / FOLDER / name).read_text(), f"{name} is not what the page shows")
    check(f"{page}.yaml" in shown, f"the deck {page}.yaml is not shown")


def printed_output_agrees_with_the_page(text, printed):
    lines = printed.splitlines()
    for kind, content, _ in blocks(text):
        for line in content.splitlines() if kind == "text" else []:
            found = next((k for k, other in enumerate(lines) if agree(line, other)), None)
            check(found is not None, f"not printed: {line}\namong\n" + "\n".join(lines))
            del lines[:found + 1]


def numbers_of_the_text_occur_in_the_blocks(text):
    known = [value(word) for _, content, _ in blocks(text) for word in NUMBER.findall(content)]
    prose = re.sub(r"`[^`\n]*`|\]\([^)]*\)", " ", FENCE.sub("", text))
    for word in NUMBER.findall(prose):
        check("." not in word or any(abs(abs(value(word)) - abs(other)) <= 0.5001 * unit(word) for other in known), f"{word} is in no block")


def suggested_commands_are_accepted(page, text, root):
    prose = FENCE.sub("", text)
    for words in re.findall(r"`((?:--set '[^'`]*' ?)+)`", prose):
        execute(f"build/release/app/tanktread {FOLDER}/{page}.yaml {words} --check > /dev/null", root)
    for name in set(re.findall(r"`(?:postproc/)?(tanktread-\w+)", prose)):
        check((SOURCE / "postproc" / name).is_file(), f"there is no {name}")
    for link in re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", prose):
        check((SOURCE / FOLDER / link).exists(), f"the link {link} leads nowhere")


def pictures_are_made(text, root, keep):
    """Checks that the pictures of a page were made. If `keep` is true, copies them into the source directory."""
    names = re.findall(r"!\[[^\]]*\]\(([^)]+)\)", text)
    check(names, "the page has no picture")
    for name in names:
        check((root / "results" / name).is_file(), f"results/{name} was not made")
        if keep:
            from PIL import Image
            image = Image.open(root / "results" / name).convert("RGB")
            image.thumbnail((900, 2000), Image.Resampling.LANCZOS)
            for colours in 256, 128, 64:
                image.quantize(colours, dither=Image.Dither.NONE).save(SOURCE / FOLDER / name, optimize=True)
                if (SOURCE / FOLDER / name).stat().st_size <= LARGEST:
                    break
        check((SOURCE / FOLDER / name).is_file() and (SOURCE / FOLDER / name).stat().st_size <= LARGEST,
              f"{name} is missing or has more than {LARGEST} bytes")


def main():
    page, keep = sys.argv[3], "--pictures" in sys.argv
    text = (SOURCE / FOLDER / f"{page}.md").read_text()
    try:
        a_page_shows_its_files_verbatim(page, text)
        numbers_of_the_text_occur_in_the_blocks(text)
        with tempfile.TemporaryDirectory(prefix="tanktread-") as directory:
            root = pathlib.Path(directory)
            copy(root)
            printed = execute("\n".join(content for kind, content, _ in blocks(text) if kind == "sh"), root)
            printed_output_agrees_with_the_page(text, printed)
            pictures_are_made(text, root, keep)
            suggested_commands_are_accepted(page, text, root)
    except Failed as failed:
        sys.exit(f"FAILED {page}: {failed}")
    print(f"passed {page}")


main()
