"""The pages and tables of runs: NAME.json, index.html, and lines between two marks of a Markdown file."""

import html
import json

_STYLE = """
body { font: 14px sans-serif; margin: 24px; color: #222; background: #f4f4f4 }
table { border-collapse: collapse; background: #fff; margin-bottom: 24px } td, th { padding: 4px 8px; border: 1px solid #ccc }
td { text-align: right } td.text, th.text { text-align: left }
.yes { color: #07702c } .no { color: #b00020 } .absent { color: #777 }
img { image-rendering: pixelated; display: block; background: #000 }
"""


class Markup(str):
    """Text that is already HTML."""


def escaped(text):
    return text if isinstance(text, Markup) else Markup(html.escape(str(text)))


def element(name, content, **attributes):
    """Return an element, without an end tag if the content is None. class_ is class, data_value data-value; None is omitted."""
    given = {key.rstrip("_").replace("_", "-"): value for key, value in attributes.items() if value is not None}
    told = "".join(f' {key}="{html.escape(str(value))}"' for key, value in given.items())
    return Markup(f"<{name}{told}>" + ("" if content is None else f"{escaped(content)}</{name}>"))


def lines(texts, between="<br>"):
    return Markup(between.join(escaped(text) for text in texts))


def cell(content, tag="td", first=False):
    """Return a cell. content: its text, (text, class), or (text, class, sort key)."""
    content, kind, value = (*content, None)[:3] if isinstance(content, tuple) else (content, "", None)
    kind = f"text {kind}".strip() if first else kind
    return element(tag, content, class_=kind or None, data_value=value)


def row(cells, tag="td", **attributes):
    return element("tr", Markup("".join(cell(one, tag, not number) for number, one in enumerate(cells))), **attributes)


def table(head, rows, kind=None):
    """Return a table. rows: lists of cells, or finished rows. The first column is text."""
    made = (one if isinstance(one, Markup) else row(one) for one in rows)
    top, body = element("thead", row(head, "th")), element("tbody", Markup("\n".join(made)))
    return element("table", Markup(f"{top}\n{body}"), class_=kind)


def write(folder, name, figures, title, parts, style="", script=""):
    """Write NAME.json with the figures and index.html with the parts; plain text becomes a paragraph."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / f"{name}.json").write_text(json.dumps(figures, indent=1) + "\n", encoding="utf-8")
    body = "\n".join(part if isinstance(part, Markup) else element("p", part) for part in parts if part)
    head = f'<meta charset="utf-8"><title>{html.escape(title)}</title><style>{_STYLE}{style}</style>'
    body = f"<h1>{html.escape(title)}</h1>\n{body}" + (f"<script>{script}</script>" if script else "")
    text = f"<!DOCTYPE html><html><head>{head}</head><body>{body}</body></html>\n"
    (folder / "index.html").write_text(text, encoding="utf-8")


def markdown(head, rows):
    """Return a Markdown table; cells with a class become their text."""
    rows = [[one[0] if isinstance(one, tuple) else one for one in cells] for cells in rows]
    return "\n".join("| " + " | ".join(map(str, line)) + " |" for line in [head, ["---"] * len(head), *rows])


def marks(name, program):
    return f"<!-- {name}: written by `make {program} README=1` -->", f"<!-- {name}: end -->"


def put_between(path, name, parts, program=None):
    """Replace the text between the two marks of that name; program: that of the marks, if not name. Raises ValueError without
    the marks.
    """
    begin, end = marks(name, program or name)
    whole = path.read_text(encoding="utf-8")
    if begin not in whole or end not in whole:
        raise ValueError(f"{path.name} lacks the lines between which the table belongs: {begin} and {end}")
    before, rest = whole.split(begin, 1)
    text = "\n\n".join(part for part in parts if part)
    path.write_text(f"{before}{begin}\n{text}\n{end}{rest.split(end, 1)[1]}", encoding="utf-8")


def percent(value, digits=1):
    return "" if value is None else f"{100 * value:.{digits}f} %"


def times(value):
    return "" if value is None else f"{value:.2f}x"
