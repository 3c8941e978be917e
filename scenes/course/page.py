"""The page that a run leaves: one HTML file, its pictures beside it, nothing from the network."""

import html
import json
import os

import numpy as np

from scenes.parity import png

from .chapter import ROOT, number

_STYLE = """
body { font: 15px/1.45 sans-serif; margin: 24px auto; max-width: 1040px; padding: 0 16px; color: #222; background: #f4f4f4 }
section { background: #fff; border: 1px solid #ddd; padding: 4px 20px 16px; margin: 20px 0 }
table { border-collapse: collapse; width: 100% } td, th { padding: 4px 8px; border: 1px solid #ccc; text-align: left }
td { vertical-align: top } td.number { white-space: nowrap; font-family: monospace }
pre { background: #f0f0f0; padding: 8px; white-space: pre-wrap } figure { display: inline-block; margin: 8px 12px 8px 0 }
img { width: 300px; image-rendering: pixelated; display: block; background: #000 } figcaption { max-width: 300px; color: #555 }
.ok { color: #07702c } .off { color: #b00020; font-weight: bold } .texts { color: #777 }
"""
_INTRODUCTION = (
    "000 are the lectures on light and ray tracing, 003 the project, 004 the slides of the second course. Every value was "
    "measured in this run, and every picture rendered; what is expected comes from the formula, not from an earlier run."
)


def write(chapters, folder, title):
    """Writes index.html, course.json and the pictures into a folder that exists."""
    names = [f"{place}-{picture.name}.png" for place, chapter in enumerate(chapters, 1) for picture in chapter.pictures]
    if len(set(names)) < len(names):
        raise ValueError("two pictures of a chapter have one name")
    sections = "\n".join(_section(place, chapter, folder) for place, chapter in enumerate(chapters, 1))
    contents = "".join(
        f'<li><a href="#c{place}">{html.escape(chapter.title)}</a> {_mark(chapter.ok)}</li>'
        for place, chapter in enumerate(chapters, 1)
    )
    title, told = html.escape(title), html.escape(summary(chapters))
    text = f"""<!DOCTYPE html><html lang="en"><head><meta charset="utf-8"><title>The course</title>
<style>{_STYLE}</style></head><body>
<h1>The course, chapter by chapter</h1><p>{title}. {told}</p><p>{_INTRODUCTION}</p>
<ol>{contents}</ol>
{sections}</body></html>
"""
    (folder / "index.html").write_text(text, encoding="utf-8")
    records = [{"title": chapter.title, "figures": [_record(figure) for figure in chapter.figures]} for chapter in chapters]
    (folder / "course.json").write_text(json.dumps({"title": title, "chapters": records}, indent=1), encoding="utf-8")


def summary(chapters):
    figures = [figure for chapter in chapters for figure in chapter.figures]
    off = sum(not figure.ok for figure in figures)
    return f"{len(chapters)} chapters, {len(figures)} figures measured in this run: " + (f"{off} off." if off else "all ok.")


def _link(source, folder):
    path = os.path.relpath(ROOT / source.file, folder)
    return f'<a href="{path}#L{source.line}">{source.name}</a> ({source.file}:{source.line})'


def _section(place, chapter, folder):
    sources = ", ".join(_link(source, folder) for source in chapter.sources)
    rows = "".join(
        f'<tr><td>{html.escape(figure.what)}</td><td class="number">{number(figure.measured)}</td>'
        f'<td class="number">{html.escape(figure.expected)}</td><td>{_mark(figure.ok)}</td>'
        f"<td>{html.escape(figure.why)}</td></tr>"
        for figure in chapter.figures
    )
    pictures = "".join(_picture(f"{place}-{picture.name}.png", picture, folder) for picture in chapter.pictures)
    return f"""<section id="c{place}"><h2>{place}. {html.escape(chapter.title)}</h2>
<p class="texts">In the texts: {html.escape(chapter.texts)}</p><p>{html.escape(chapter.built)}</p>
<pre>{html.escape(chapter.formula.strip())}</pre><p><b>Where:</b> {sources}</p>
<p><b>Problems met:</b> {html.escape(chapter.problems)}</p>
<table><tr><th>Measured</th><th>Value</th><th>Expected</th><th></th><th>Why</th></tr>{rows}</table>{pictures}</section>"""


def _picture(file_name, picture, folder):
    shown = png.display(np.asarray(picture.pixels)[::-1], 1.0 / picture.white)
    (folder / file_name).write_bytes(png.encode(shown))
    caption = html.escape(picture.caption)
    return f'<figure><img src="{file_name}" alt="{caption}"><figcaption>{caption}</figcaption></figure>'


def _mark(ok):
    return '<span class="ok">ok</span>' if ok else '<span class="off">off</span>'


def _record(figure):
    return {"what": figure.what, "measured": figure.measured, "expected": figure.expected, "ok": figure.ok}
