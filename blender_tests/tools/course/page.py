"""The page of a run: one HTML file and its pictures, nothing from the network."""

import os

from scenes.course.chapter import ROOT, number
from tools.harness import page
from tools.harness.page import Markup, element, lines
from tools.harness.pictures import write_picture

_STYLE = """
body { font: 15px/1.45 sans-serif; margin: 24px auto; max-width: 1040px; padding: 0 16px; color: #222; background: #f4f4f4 }
section { background: #fff; border: 1px solid #ddd; padding: 4px 20px 16px; margin: 20px 0 }
table { width: 100% } td, th { text-align: left } td { vertical-align: top }
td.number { white-space: nowrap; font-family: monospace }
pre { background: #f0f0f0; padding: 8px; white-space: pre-wrap } figure { display: inline-block; margin: 8px 12px 8px 0 }
img { width: 300px } figcaption { max-width: 300px; color: #555 }
.ok { color: #07702c } .off { color: #b00020; font-weight: bold } .texts { color: #777 }
"""
_INTRODUCTION = (
    "000 are the lectures on light and ray tracing, 003 the project, 004 the slides of the second course. Every value was "
    "measured in this run, and every picture rendered; what is expected comes from the formula, not from an earlier run."
)


def write(chapters, folder, title):
    """Write index.html, course.json and the pictures into an existing folder."""
    names = [f"{place}-{picture.name}.png" for place, chapter in enumerate(chapters, 1) for picture in chapter.pictures]
    if len(set(names)) < len(names):
        raise ValueError("two pictures of a chapter have one name")
    contents = (
        element("li", lines((element("a", chapter.title, href=f"#c{place}"), _mark(chapter.ok)), " "))
        for place, chapter in enumerate(chapters, 1)
    )
    sections = (_section(place, chapter, folder) for place, chapter in enumerate(chapters, 1))
    records = [{"title": chapter.title, "figures": [_record(figure) for figure in chapter.figures]} for chapter in chapters]
    parts = [f"{title}. {summary(chapters)}", _INTRODUCTION, element("ol", lines(contents, "")), *sections]
    page.write(folder, "course", {"title": title, "chapters": records}, "The course, chapter by chapter", parts, _STYLE)


def summary(chapters):
    figures = [figure for chapter in chapters for figure in chapter.figures]
    off = sum(not figure.ok for figure in figures)
    return f"{len(chapters)} chapters, {len(figures)} figures measured in this run: " + (f"{off} off." if off else "all ok.")


def _link(source, folder):
    path = f"{os.path.relpath(ROOT / source.file, folder)}#L{source.line}"
    return lines((element("a", source.name, href=path), f"({source.file}:{source.line})"), " ")


def _section(place, chapter, folder):
    head = ["Measured", "Value", "Expected", "", "Why"]
    rows = [
        [figure.what, (number(figure.measured), "number"), (figure.expected, "number"), _mark(figure.ok), figure.why]
        for figure in chapter.figures
    ]
    sources = lines((_link(source, folder) for source in chapter.sources), ", ")
    parts = [
        element("h2", f"{place}. {chapter.title}"),
        element("p", f"In the texts: {chapter.texts}", class_="texts"),
        element("p", chapter.built),
        element("pre", chapter.formula.strip()),
        element("p", lines((element("b", "Where:"), sources), " ")),
        element("p", lines((element("b", "Problems met:"), chapter.problems), " ")),
        page.table(head, rows),
        *(_picture(f"{place}-{picture.name}.png", picture, folder) for picture in chapter.pictures),
    ]
    return element("section", Markup("\n".join(parts)), id=f"c{place}")


def _picture(file_name, picture, folder):
    write_picture(folder / file_name, picture.pixels, picture.white)
    parts = (element("img", None, src=file_name, alt=picture.caption), element("figcaption", picture.caption))
    return element("figure", lines(parts, ""))


def _mark(ok):
    return element("span", "ok" if ok else "off", class_="ok" if ok else "off")


def _record(figure):
    return {"what": figure.what, "measured": figure.measured, "expected": figure.expected, "ok": figure.ok}
