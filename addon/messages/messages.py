"""Messages about parts of a scene that a render leaves out or replaces; each is reported once, with a count."""

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


# Severities of the library's own messages by words in them; all others are DIFFERENT.
_OF_LIBRARY = (
    ("without area were left out", Severity.HINT),
    ("left out", Severity.LEFT_OUT),
    ("gives no light", Severity.LEFT_OUT),
)


class Messages:
    """A list of messages by severity, the highest first, then by arrival; a repeated message is only counted."""

    def __init__(self, lines=(), severity=Severity.DIFFERENT):
        self._messages = {}
        for text in lines:
            self.add(text, severity=severity)

    @classmethod
    def of_library(cls, lines):
        """Return the Messages of a Session's lines."""
        messages = cls()
        for text in lines:
            messages.add(text, severity=next((severity for word, severity in _OF_LIBRARY if word in text), Severity.DIFFERENT))
        return messages

    def add(self, text, key="", severity=Severity.DIFFERENT):
        """Add a message. key: the missing feature, for programs: "node:" and the node's label, or "feature:" and its name.

        A message has a key only if the missing feature makes the picture differ from Cycles'.
        """
        self._count(Message(text, key, severity))

    def _count(self, message):
        """Add or count a message; return whether it was known before."""
        known = self._messages.get(message.text)
        if known is not None:
            message = known._replace(count=known.count + message.count, severity=max(known.severity, message.severity))
        self._messages[message.text] = message
        return known is None

    def merge(self, other):
        """Add the messages of other and return those that were new."""
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
        """Return a copy with new in place of old in each text."""
        messages = Messages()
        for message in self._messages.values():
            messages._count(message._replace(text=message.text.replace(old, new)))
        return messages

    def __len__(self):
        return len(self._messages)

    def __iter__(self):
        return iter(self.lines())

    def told(self):
        """Return all Message records, the most severe first."""
        return sorted(self._messages.values(), key=lambda message: -message.severity)

    def lines(self):
        return [message.line for message in self.told()]

    def missing(self):
        """Return {key: count} of the missing features."""
        counts = {}
        for message in self._messages.values():
            if message.key:
                counts[message.key] = counts.get(message.key, 0) + message.count
        return counts

    def number(self, value, who, what, default, low=-math.inf, high=math.inf):
        """Return value clamped to [low, high], or default if it is not finite; add a message if that changes it."""
        value = float(value)
        usable = min(max(value, low), high)
        # Blender stores single precision, in which a limit such as pi can lie half a step outside.
        if math.isfinite(value) and abs(value - usable) <= abs(value) * 2.0**-23:
            return usable
        if not math.isfinite(usable):
            usable = default
        self.add(f"{who}: {what} is {value:g}, {usable:g} is used")
        return usable

    def color(self, value, who, what, default=0.0):
        """Return three channels, clamped to 0 and default if not finite; add a message if that changes them."""
        channels = [float(c) for c in value[:3]]
        if all(math.isfinite(c) and c >= 0.0 for c in channels):
            return tuple(channels)
        usable = tuple(max(c, 0.0) if math.isfinite(c) else default for c in channels)
        told = ", ".join(f"{c:g}" for c in channels)
        self.add(f"{who}: {what} is ({told}), ({', '.join(f'{c:g}' for c in usable)}) is used")
        return usable
