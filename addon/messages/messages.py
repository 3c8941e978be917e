"""What a render left out or replaced, counted and told once."""

import math
from typing import NamedTuple

from .severity import Severity


class Message(NamedTuple):
    text: str
    key: str
    severity: Severity
    count: int = 1

    @property
    def line(self):
        return self.text if self.count == 1 else f"{self.text} ({self.count} times)"


# What the library's own messages say of their severity; others are of something that is shown otherwise.
_OF_LIBRARY = (
    ("without area were left out", Severity.HINT),
    ("left out", Severity.LEFT_OUT),
    ("gives no light", Severity.LEFT_OUT),
)


class Messages:
    """Sentences, what hurts most first, else in order of their first arrival; a sentence met again is only counted."""

    def __init__(self, lines=(), severity=Severity.DIFFERENT):
        self._messages = {}
        for text in lines:
            self.add(text, severity=severity)

    @classmethod
    def of_library(cls, lines):
        """Of the lines that a Session gives."""
        messages = cls()
        for text in lines:
            messages.add(text, severity=next((severity for word, severity in _OF_LIBRARY if word in text), Severity.DIFFERENT))
        return messages

    def add(self, text, key="", severity=Severity.DIFFERENT):
        """key: what is missing, for programs: "node:" and the node's label, or "feature:" and its name.

        Whoever asks for it gets another picture than Cycles'. What merely warns has no key.
        """
        self._count(Message(text, key, severity))

    def _count(self, message):
        """Whether it is new here."""
        known = self._messages.get(message.text)
        if known is not None:
            message = known._replace(count=known.count + message.count, severity=max(known.severity, message.severity))
        self._messages[message.text] = message
        return known is None

    def merge(self, other):
        """Adds what another holds. Gives of it what is new here."""
        new = Messages()
        for message in other._messages.values():
            if self._count(message):
                new._count(message)
        return new

    def copy(self):
        messages = Messages()
        messages.merge(self)
        return messages

    def replaced(self, old, new):
        """The same messages with other words in the place of some."""
        messages = Messages()
        for message in self._messages.values():
            messages._count(message._replace(text=message.text.replace(old, new)))
        return messages

    def __len__(self):
        return len(self._messages)

    def __iter__(self):
        return iter(self.lines())

    def told(self):
        """Each Message, what hurts most first."""
        return sorted(self._messages.values(), key=lambda message: -message.severity)

    def lines(self):
        return [message.line for message in self.told()]

    def missing(self):
        """{key: how often it was met}"""
        counts = {}
        for message in self._messages.values():
            if message.key:
                counts[message.key] = counts.get(message.key, 0) + message.count
        return counts

    def number(self, value, who, what, default, low=-math.inf, high=math.inf):
        """value where it is a finite number in [low, high]; else the nearest usable one, with a message."""
        value = float(value)
        usable = min(max(value, low), high)
        # Blender keeps single precision, in which a limit such as pi may lie half a step outside.
        if math.isfinite(value) and abs(value - usable) <= abs(value) * 2.0**-23:
            return usable
        if not math.isfinite(usable):
            usable = default
        self.add(f"{who}: {what} is {value:g}, {usable:g} is used")
        return usable

    def color(self, value, who, what, default=0.0):
        """Three channels, each finite and not negative."""
        channels = [float(c) for c in value[:3]]
        if all(math.isfinite(c) and c >= 0.0 for c in channels):
            return tuple(channels)
        usable = tuple(max(c, 0.0) if math.isfinite(c) else default for c in channels)
        told = ", ".join(f"{c:g}" for c in channels)
        self.add(f"{who}: {what} is ({told}), ({', '.join(f'{c:g}' for c in usable)}) is used")
        return usable
