"""Sentences in panels: all words, in lines that fit."""

import importlib.util
import os
from types import SimpleNamespace

import pytest
from conftest import ROOT

# Load the file alone: the other files of its room need Blender.
_spec = importlib.util.spec_from_file_location("sentences", os.path.join(ROOT, "addon", "ui", "sentences.py"))
_sentences = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(_sentences)
sentence = _sentences.sentence

TEXT = "error 14.7 %, with 95 % confidence between 13.5 % and 16.1 %; objects_with_a_name_of_many_letters are left out: 0 %"


class Column:
    def __init__(self):
        self.lines = []

    def row(self, align):
        return self

    def label(self, text, icon):
        self.lines.append((text, icon))


def written(text, width=None, scale=1.0, **options):
    column = Column()
    region = None if width is None else SimpleNamespace(width=width)
    context = SimpleNamespace(region=region, preferences=SimpleNamespace(system=SimpleNamespace(ui_scale=scale)))
    assert sentence(column, context, text, **options) is column
    return column.lines


@pytest.mark.parametrize("width", [1, 120, 200, 240, 300, 1000])
def test_every_word_is_written_and_no_line_is_longer_than_the_panel(width):
    lines = [text for text, _ in written(TEXT, width)]
    assert " ".join(lines) == TEXT
    # The mean width of letters is at least five pixels; a single word may be longer than the panel.
    assert all(len(line) * 5.0 <= width or " " not in line.replace(" %", "%") for line in lines)
    # A number and its sign stay together.
    assert not any(line.startswith("%") for line in lines)


def test_what_takes_room_counts():
    plain = written(TEXT, 240)
    assert written(TEXT, 480, scale=2.0) == plain
    with_icon = written(TEXT, 260, icon="ERROR")
    assert [text for text, _ in with_icon] == [text for text, _ in plain]
    assert [icon for _, icon in with_icon] == ["ERROR"] + ["BLANK1"] * (len(plain) - 1)
    assert [text for text, _ in written(TEXT, 280, icon="ERROR", buttons=1)] == [text for text, _ in plain]


def test_without_a_window_all_of_it_is_one_line():
    assert written(TEXT) == [(TEXT, "NONE")]
