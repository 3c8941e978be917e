"""What a render left out or replaced, counted and told once."""

import math


class Messages:
    """Sentences in order of their first arrival; a sentence met again is only counted."""

    def __init__(self, lines=()):
        self._counts = {}
        self._keys = {}
        for text in lines:
            self.add(text)

    def add(self, text, key=""):
        """key: what is missing, for programs: "node:" and the node's label, or "feature:" and its name.

        Whoever asks for it gets another picture than Cycles'. What merely warns has no key.
        """
        self._counts[text] = self._counts.get(text, 0) + 1
        if key:
            self._keys[text] = key

    def merge(self, other):
        """Adds what another holds. Gives of it what is new here."""
        new = Messages()
        for text, count in other._counts.items():
            if text not in self._counts:
                new._counts[text] = count
            self._counts[text] = self._counts.get(text, 0) + count
        self._keys.update(other._keys)
        new._keys.update({text: key for text, key in other._keys.items() if text in new._counts})
        return new

    def missing(self):
        """{key: how often it was met}"""
        counts = {}
        for text, key in self._keys.items():
            counts[key] = counts.get(key, 0) + self._counts[text]
        return counts

    def __len__(self):
        return len(self._counts)

    def __iter__(self):
        return iter(self.lines())

    def lines(self):
        return [text if count == 1 else f"{text} ({count} times)" for text, count in self._counts.items()]

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
