"""The parts of a chapter of the report."""

import math
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class Figure:
    """A number measured in this run, and the range that it must be in; why: the derivation of the range."""

    what: str
    measured: float
    low: float
    high: float
    expected: str
    why: str

    @property
    def ok(self):
        return self.low <= self.measured <= self.high

    @classmethod
    def near(cls, what, measured, expected, limit, why):
        """Returns a figure within limit of a closed form; a limit of 0 requires the number itself."""
        text = number(expected) if limit == 0 else f"{number(expected)} ± {limit:.2g}"
        return cls(what, float(measured), expected - limit, expected + limit, text, why)

    @classmethod
    def at_most(cls, what, measured, limit, why):
        return cls(what, float(measured), -math.inf, limit, f"at most {number(limit)}", why)

    @classmethod
    def at_least(cls, what, measured, limit, why):
        return cls(what, float(measured), limit, math.inf, f"at least {number(limit)}", why)


@dataclass(frozen=True)
class Picture:
    """pixels: (height, width, 3 or 4), linear, row 0 the lowest, as from a render; white: the value displayed as 1."""

    name: str
    caption: str
    pixels: np.ndarray
    white: float = 1.0


@dataclass(frozen=True)
class Source:
    """A function, by its file and the text with which its definition begins."""

    file: str
    text: str

    @property
    def line(self):
        lines = (ROOT / self.file).read_text(encoding="utf-8").splitlines()
        found = next((number for number, line in enumerate(lines, 1) if self.text in line), None)
        if found is None:
            raise LookupError(f"{self.file} has no '{self.text}'")
        return found

    @property
    def name(self):
        """Returns the last word of the text: the function's name."""
        return re.findall(r"\w+", self.text)[-1]


@dataclass(frozen=True)
class Chapter:
    """texts: where the texts require it; built: the implementation; problems: the difficulties and their solutions."""

    title: str
    texts: str
    built: str
    formula: str
    problems: str
    sources: tuple[Source, ...]
    figures: tuple[Figure, ...]
    pictures: tuple[Picture, ...]

    @classmethod
    def of(cls, prose, figures, pictures=()):
        """prose: the fields of the chapter in chapters.toml."""
        sources = tuple(Source(*source) for source in prose["sources"])
        return cls(**{**prose, "sources": sources}, figures=tuple(figures), pictures=tuple(pictures))

    @property
    def ok(self):
        return all(figure.ok for figure in self.figures)


def number(value):
    """Returns the number with four digits, or all digits of a whole number."""
    return f"{value:.0f}" if float(value).is_integer() and abs(value) < 1e9 else f"{value:.4g}"


def worst(measured, expected):
    """Returns the largest deviation, relative to the expected value where that is not 0."""
    measured, expected = np.asarray(measured, float), np.asarray(expected, float)
    scale = np.where(expected != 0.0, np.abs(expected), 1.0)
    return float(np.max(np.abs(measured - expected) / scale))
