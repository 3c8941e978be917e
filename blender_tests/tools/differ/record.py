"""A scene as plain data: a list of records, each a thing or a setting, later ones referring to earlier ones by name.

A Record is (verb, name, fields). fields hold numbers, texts, lists and dicts alone, so that a scene is JSON and Python, too.
A text that begins with @ names another record; the list ["@Node", "Output"] as the input of a node is a link. What a record
refers to may be missing: the reference is left out then. So any list of records is a scene, and any part of it is, too.
"""

import json
import pprint
from typing import NamedTuple

_WIDTH = 120


class Record(NamedTuple):
    verb: str
    name: str
    fields: dict


def is_link(value):
    return isinstance(value, list) and len(value) == 2 and isinstance(value[0], str) and value[0].startswith("@")


def to_json(records):
    return json.dumps([list(record) for record in records])


def from_json(text):
    return [Record(*record) for record in json.loads(text)]


def to_python(records, remark=""):
    """The scene as Python, which `start.py differ.show FILE` renders by both engines."""
    lines = [f"# {line}" for line in remark.splitlines()]
    lines.append("SCENE = [")
    for record in records:
        text = pprint.pformat(tuple(record), width=_WIDTH, compact=True, sort_dicts=False)
        lines += [f"    {line}" for line in f"{text},".splitlines()]
    return "\n".join([*lines, "]", ""])


def from_python(text):
    values = {}
    exec(compile(text, "scene", "exec"), values)
    return [Record(*record) for record in values["SCENE"]]
