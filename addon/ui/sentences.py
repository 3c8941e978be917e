"""Sentences in panels: Blender cuts out the middle of what is wider than a panel, so they take the lines that they need."""

# In pixels at a display scale of 1, measured in Blender's own font: a letter of a usual sentence, the panel's and the label's
# borders, an icon.
_LETTER, _BORDERS, _ICON = 5.9, 40, 20
# A number and its sign are one word.
_GLUED = "\N{NO-BREAK SPACE}%"


def sentence(column, context, text, icon="NONE", buttons=0):
    """Writes it; gives the row of its first line, where room is left for so many small buttons."""
    first, *rest = _wrapped(text, _letters(context, buttons + (icon != "NONE")))
    row = column.row(align=True)
    row.label(text=first, icon=icon)
    for part in rest:
        column.label(text=part, icon="NONE" if icon == "NONE" else "BLANK1")
    return row


def _letters(context, icons):
    """How many have room in a line; all where there is no window."""
    if context.region is None:
        return None
    width = context.region.width / context.preferences.system.ui_scale
    return max(1, int((width - _BORDERS - icons * _ICON) / _LETTER))


def _wrapped(text, letters):
    parts = [""]
    for word in text.replace(" %", _GLUED).split(" "):
        if letters is not None and parts[-1] and len(parts[-1]) + len(word) >= letters:
            parts.append("")
        parts[-1] += f" {word}" if parts[-1] else word
    return [part.replace(_GLUED, " %") for part in parts]
