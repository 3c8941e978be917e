"""`make tradeoff` without Blender: the arithmetic of curves of error against seconds, and the table in the README."""

import pytest

from tools.harness.page import marks
from tools.tradeoff import page
from tools.tradeoff.curves import middle, seconds_to, slope


def test_curves():
    first, second, third = ([(t * s, 1.0 / t**0.5) for t in (1, 4, 16)] for s in (1.0, 2.0, 3.0))
    points = middle([first, third, second])
    assert points[1] == (8.0, 0.5, 0.5, 0.5)
    # A quarter of the squared error takes four times the seconds.
    assert seconds_to(points, 1.0 / 8**0.5) == pytest.approx(16.0)
    assert seconds_to(points, 1.1) is None and seconds_to(points, 0.2) is None
    assert slope(points) == pytest.approx(0.5)


def test_the_readme_has_the_presets_and_the_chart(tmp_path, monkeypatch):
    monkeypatch.setattr(page, "ROOT", tmp_path)
    (tmp_path / "scenes").mkdir()
    (tmp_path / "tradeoff.png").write_bytes(b"chart")
    path = tmp_path / "README.md"
    begin, end = marks("tradeoff", "tradeoff")
    path.write_text(f"before\n{begin}\nold\n{end}\nafter\n")
    draft = {"target": 0.1, "samples": 304.0, "seconds": 7.39, "error": 0.0805, "told": 0.0837, "ended_by": "target error"}
    figures = {
        "machine": {"processor": "a processor", "processors": 2, "load": 0.5},
        **{"threads": 2, "blender": "5.2.3", "commit": "abc", "quick": False},
        "presets": {"DRAFT": draft},
        "equal_error": [{"error": 0.5, "lancer": 0.4, "cycles": 0.6}],
    }
    page.update_tables(figures, tmp_path, path)
    text = path.read_text()
    assert text.startswith(f"before\n{begin}\na processor, 2 processors, load 0.5") and text.endswith(f"{end}\nafter\n")
    assert "| DRAFT | 10 % | 304 | 7.39 | 8.05 % | 8.37 % | target error |" in text
    # A head, a line below it and one preset; only the page has equal errors.
    assert sum(line.startswith("|") for line in text.splitlines()) == 3
    assert (tmp_path / "scenes" / "tradeoff.png").read_bytes() == b"chart"
