"""`make course QUICK=1`: every figure is within its bounds, and the page is whole."""

import json
import re
import subprocess
import sys

import blenders
import pytest

from tools.harness.places import TOOLS
from tools.harness.workers import START

# A run in which the only figure of a chapter is replaced by one that is off.
OFF = """
import sys
sys.path.insert(0, {tools!r})
import start
from scenes.course import lighting
from tools.course import run
from tools.harness.f12 import registered
lighting.CHAPTERS[2].__globals__["worst"] = lambda *_: {deviation}
sys.exit(registered(run.main))
"""


def report(folder, *arguments, deviation=None):
    start = [START, "course.run"] if deviation is None else ["-c", OFF.format(tools=str(TOOLS), deviation=deviation)]
    command = [sys.executable, *start, "--quick", "--output", str(folder), *arguments]
    done = subprocess.run(command, env=blenders.environment(folder), capture_output=True, text=True, timeout=600)
    return done.returncode, done.stdout + done.stderr


def test_the_report(tmp_path):
    code, said = report(tmp_path)
    assert code == 0, said[-3000:]
    with open(tmp_path / "course.json", encoding="utf-8") as file:
        chapters = json.load(file)["chapters"]
    assert len(chapters) == 21 and all(chapter["figures"] for chapter in chapters)
    figures = [figure for chapter in chapters for figure in chapter["figures"]]
    assert [figure["what"] for figure in figures if not figure["ok"]] == [] and len(figures) > 120
    page = (tmp_path / "index.html").read_text(encoding="utf-8")
    pictures = re.findall(r'<img src="([^"]+)"', page)
    assert len(pictures) > 40 and all((tmp_path / name).stat().st_size > 100 for name in pictures)
    assert "http" not in page and 'class="off"' not in page
    links = re.findall(r'href="([^"#]+)#L(\d+)">(\w+)<', page)
    assert len(links) > 50
    for file_name, line, name in links:
        with open(tmp_path / file_name, encoding="utf-8") as file:
            assert name in file.read().splitlines()[int(line) - 1], (file_name, line, name)


@pytest.mark.parametrize("deviation, code", [("0.0", 0), ("1.0", 1), ("float('nan')", 1)])
def test_a_figure_that_is_off_ends_with_an_error(tmp_path, deviation, code):
    found, said = report(tmp_path, "--only", "minnaert", deviation=deviation)
    assert found == code, said[-2000:]
    assert ("off: k = 1" in said) == bool(code) and ("all ok." in said) == (not code)
    assert ('class="off"' in (tmp_path / "index.html").read_text(encoding="utf-8")) == bool(code)


def test_an_unknown_chapter_is_told(tmp_path):
    code, said = report(tmp_path, "--only", "nothing")
    assert code == 1 and "shadows" in said
