"""One picture, whose view layers Blender has rendered one after the other: its messages, and the time that each may take."""

import time

from ..messages.messages import Messages

# Seconds of a layer for which nothing is left: 0 would be no limit.
_LEAST = 1e-3


class Picture:
    """key: whatever tells it from another picture; layers: the names of those that are to be rendered."""

    def __init__(self, key, layers):
        self.key = key
        self.messages = Messages()
        self._layers = len(layers)
        self._begun = set()
        self._pressed = self.started = time.monotonic()

    def has(self, key, layer):
        """Whether this layer is one that is still to come."""
        return key == self.key and layer not in self._begun

    def begin(self, layer):
        self._begun.add(layer)
        self.started = time.monotonic()

    def limit(self, seconds):
        """Of the time that the whole picture may take, an even share for the layer that has begun; 0 is no limit."""
        if seconds == 0.0:
            return 0.0
        left = seconds - (self.started - self._pressed)
        return max(_LEAST, left / max(1, self._layers - len(self._begun) + 1))
