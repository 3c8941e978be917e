"""Records of photometric files as Blender's texts."""

import bpy


def build_photometry(name, fields):
    rows = [fields["down"], fields["across"], *fields["values"]]
    counts = f"{len(fields['down'])} {len(fields['across'])} {fields['type']}"
    lines = ["IESNA:LM-63-1995", "TILT=NONE", f"1 -1 1 {counts} 2 0 0 0", "1 1 10", *(" ".join(map(str, row)) for row in rows)]
    text = bpy.data.texts.new(name)
    text.write("\n".join([*lines, ""]))
    return text
