#!/usr/bin/python3
# Tests that the schema of decks contains all keys of the manual and accepts all decks in inputs/, and that --new prints
# valid decks.
import json
import re

import yaml

from harness import SOURCE, check, main, run


def _schema():
    return json.loads(run("--schema").stdout)["properties"]["Tanktread"]


def _below(schema, path):
    """Returns the schema of a section. `<name>` in the path stands for any name."""
    for part in filter(None, path.split("/")):
        schema = schema["properties"].get(part) or schema["additionalProperties"]
    return schema


def every_key_of_the_manual_has_a_type_and_a_meaning():
    section, count = "", 0
    for line in run("--reference").stdout.splitlines():
        if line.startswith("## "):
            section = line[3:].strip("`")
        row = re.match(r"\| `([^`]+)` \|", line)
        if not row or section.startswith("Particles"):
            continue
        key = _below(_schema_once, section)["properties"][row[1]]
        check(("type" in key or "enum" in key) and key["description"], section, row[1], key)
        count += 1
    check(count > 100, f"{count} keys")


def bounds_and_choices_of_the_schema_are_those_of_the_program():
    properties = _schema_once["properties"]
    side = properties["Surface"]["properties"]["elements per side"]
    check((side["type"], side["minimum"], side["maximum"]) == ("integer", 3, 200), side)
    check("Skalak" in properties["Membrane"]["properties"]["law"]["enum"], "laws")
    axes = properties["Particle"]["properties"]["semi-axes"]
    check((axes["type"], axes["minItems"], axes["items"]["exclusiveMinimum"]) == ("array", 3, 0), axes)


def _errors(value, schema, path=""):
    """Yields the errors of a deck according to the schema."""
    if schema in (True, None):
        return
    if "enum" in schema and value not in schema["enum"]:
        yield f"{path}: {value}"
    kinds = {"object": dict, "array": list, "string": str, "boolean": bool, "integer": int, "number": (int, float)}
    types = schema.get("type", list(kinds))
    if not any(isinstance(value, kinds[kind]) for kind in ([types] if isinstance(types, str) else types)):
        yield f"{path}: {value!r} is no {types}"
    elif isinstance(value, str) and not re.match(schema.get("pattern", ""), value):
        yield f"{path}: {value!r} is no number with a unit"
    elif isinstance(value, dict):
        for key, inner in value.items():
            other = schema.get("properties", {}).get(key, schema.get("additionalProperties", True))
            if other is False:
                yield f"{path}/{key} is not known"
            else:
                yield from _errors(inner, other, f"{path}/{key}")
    elif isinstance(value, (int, float)) and not (schema.get("minimum", value) <= value <= schema.get("maximum", value)):
        yield f"{path}: {value}"


def every_shipped_deck_is_accepted_and_a_wrong_one_is_not():
    for path in sorted((SOURCE / "inputs").glob("*.yaml")):
        found = list(_errors(yaml.safe_load(path.read_text())["Tanktread"], _schema_once))
        check(not found, path.name, found)
    for wrong in {"Flow": {"type": "simple shears"}}, {"Flow": {"rate": 1}}, {"Surface": {"elements per side": 2}}, {"Time": {"final time": "long"}}:
        check(list(_errors(wrong, _schema_once)), wrong, "is accepted")


def every_deck_of_new_is_valid():
    kinds = re.search(r"commented deck of this kind: (.*?) --", re.sub(r"\s+", " ", run("--help").stdout))[1]
    kinds = re.findall(r"[\w-]+", kinds.replace(" or ", " "))
    check(len(kinds) >= 5, kinds)
    numbers = {"capsule": ["capillary_number 0.3,"], "drop": ["capillary_number 0.05,"], "tube": ["capillary_number 0.05,", "confinement 0.8,"],
               "red-cell": ["capillary_number 0.497", "bending_number 0.005"]}
    for kind in kinds:
        text = run("--new", kind).stdout
        with open(f"{kind}.yaml", "w") as file:
            file.write(text)
        plan = run(f"{kind}.yaml", "--check").stdout
        check(" Units:\n" in text and re.search(r"viscosity: \d+ mPa s\n", text) and "  unusual" not in plan, kind, text)
        check(all(f" {name}" in plan for name in numbers.get(kind, ())), kind, plan)
    for path in "red-cell.yaml", *(SOURCE / "inputs").glob("red_cell*.yaml"):  # with which the measured disc is at rest
        check("bending reference: unstressed" in run(path, "--check").stdout, path)
        check(text.count("#") > text.count(": ") / 3, kind, "is not commented")
    said = run("--new", "capsul", code=2).stderr
    check("capsule" in said and said.count("\n") == 1, said)


_schema_once = _schema()
main()
