"""Sentences in panels, wrapped into several lines: Blender cuts out the middle of a label wider than the panel."""

# Pixels at a display scale of 1, measured with Blender's font: mean width of a letter, borders of panel and label, an icon.
_LETTER, _BORDERS, _ICON = 5.9, 40, 20
# Keep a number and its percent sign on one line.
_GLUED = "\N{NO-BREAK SPACE}%"


def sentence(column, context, text, icon="NONE", buttons=0):
    """Draw a sentence; return the row of its first line, with room for that many small buttons."""
    first, *rest = _wrapped(text, _letters(context, buttons + (icon != "NONE")))
    row = column.row(align=True)
    row.label(text=first, icon=icon)
    for part in rest:
        column.label(text=part, icon="NONE" if icon == "NONE" else "BLANK1")
    return row


def _letters(context, icons):
    """Return the number of letters that fit in a line; None without a window, for no limit."""
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
