"""Photometric files that Cycles or Lancer does not read: the messages of a lamp with an IES Texture."""

import os
import tempfile

import bpy
import stage

from addon.export.images import Images
from addon.export.lights import export_lamp_nodes
from addon.messages.messages import Messages

_WHOLE = """IESNA:LM-63-1995
TILT=NONE
1 -1 2 3 1 1 2 0 0 0
1 1 100
0 45 90
0
5 4 1
"""
FILES = {
    "whole": _WHOLE,
    "commas": _WHOLE.replace("0 45 90", "0,45,90"),
    # As in C a whole number ends at its point, and the next number begins there.
    "split count": _WHOLE.replace("2 0 0 0", "2.0 0 0"),
    "tilted": _WHOLE.replace("NONE", "INCLUDE\n1 2\n0 90\n1 1"),
    "old line ends": _WHOLE.replace("\n", "\r"),
    "no last number": _WHOLE.replace(" 4 1\n", " 4\n"),
    "another type": _WHOLE.replace("1 1 2 0", "1 4 2 0"),
    "underscore": _WHOLE.replace("0 45 90", "0 4_5 90"),
    "infinite": _WHOLE.replace("5 4 1", "5 inf 1"),
    "no number": _WHOLE.replace("1 1 100", "nan 1 100"),
    "large": _WHOLE.replace("5 4 1", "5 1e200 1"),
    "large factors": _WHOLE.replace("1 1 100", "1e300 1e300 100"),
    "descending": _WHOLE.replace("0 45 90", "0 90 45"),
    "open end": _WHOLE.rstrip(),
}


def _lines(tell):
    """Return the messages of a lamp's IES Texture; tell(node) gives the node its file."""
    lamp = stage.light("POINT")
    lamp.data.use_nodes = True
    tree = lamp.data.node_tree
    node = tree.nodes.new("ShaderNodeTexIES")
    tell(node)
    tree.links.new(node.outputs[0], next(n for n in tree.nodes if n.type == "EMISSION").inputs["Strength"])
    messages = Messages()
    export_lamp_nodes(lamp, messages, Images())
    return [line.split("': ", 1)[1] for line in messages.lines()], list(messages.missing())


def files():
    """Return {name: [(messages, keys) of an external file, of a text]}."""
    stage.empty()
    folder = tempfile.mkdtemp()
    found = {}
    for name, contents in FILES.items():
        path = os.path.join(folder, name + ".ies")
        with open(path, "w", newline="") as file:
            file.write(contents)

        def external(node, path=path):
            node.mode, node.filepath = "EXTERNAL", path

        def internal(node, contents=contents):
            node.mode, node.ies = "INTERNAL", bpy.data.texts.new("lamp")
            node.ies.write(contents)

        found[name] = [_lines(external), _lines(internal)]
    return {"version": list(bpy.app.version), "files": found}
