#!/usr/bin/python3
"""Measures the processor seconds of the decks in inputs/, and compares them with the costs that are stated for them.

    tests/benchmark/deck_costs.py                              # all decks; runs are kept under results/deck_costs
    tests/benchmark/deck_costs.py posts.yaml vesicle.yaml      # only these decks
    tests/benchmark/deck_costs.py --write                      # also corrects the decks and the table of inputs/README.md

The cost of a deck is stated in words in its line `# Cost:` and in the last column of the table of inputs/README.md. Use
a machine without other load, whose cores are then fastest. Words are wrong (*) if the measured time is outside of their
range by a factor of more than 1.5. A deck that reaches the limit keeps its words. tests/style/form.py checks that deck
and table state the same.
"""

import re

from package import INPUTS, answer, command_line, studies, table

FACTOR = 1.5
# words and the times in seconds up to which they are used
WORDS = {"seconds": 8, "ten seconds": 14, "a quarter of a minute": 22, "half a minute": 42, "a minute": 85}
WORDS |= {f"{name} minutes": 60 * n + 30 for n, name in enumerate("two three four five six seven eight".split(), 2)}
README = INPUTS / "README.md"


def main():
    parser = command_line(__doc__)
    parser.add_argument("decks", nargs="*", default=sorted(path.name for path in INPUTS.glob("*.yaml")))
    parser.add_argument("--write", action="store_true", help="correct the words in the decks and in inputs/README.md")
    studies.arguments(parser, "results/deck_costs", limit=120)
    parsed = parser.parse_args()
    study = studies.study(parsed)
    table(["deck", "processor seconds", "words", "of the deck", "of the table"],
          (row(name, study.run(INPUTS / name, {}), parsed.write) for name in parsed.decks))


def row(name, outcome, write):
    """Returns the row of the printed table for a deck. If `write`, corrects words that are wrong or differ."""
    if not outcome.done:
        return [name, outcome.message, "", "", ""]
    seconds = outcome.processor_seconds
    words = next(words for words, most in WORDS.items() if seconds <= most)
    places = {INPUTS / name: r"(?m)^(# Cost: )([^\n]*?)( on one core\.)",
              README: rf"(?m)^(\| \[{re.escape(name)}\].*\| )([^|]+)( \|)$"}
    stated = [re.search(pattern, path.read_text())[2] for path, pattern in places.items()]
    for path, pattern in places.items() if write and (wrong(stated[0], seconds) or stated[0] != stated[1]) else ():
        path.write_text(re.sub(pattern, rf"\g<1>{words}\g<3>", path.read_text()))
    return [name, seconds, words, *(one + " *" * wrong(one, seconds) for one in stated)]


def wrong(words, seconds):
    """Returns whether words are unknown or stand for times that are too short or too long by more than FACTOR."""
    if words not in WORDS:
        return True
    shortest = max((most for most in WORDS.values() if most < WORDS[words]), default=0)
    return not shortest / FACTOR <= seconds <= WORDS[words] * FACTOR


if __name__ == "__main__":
    answer(main)
