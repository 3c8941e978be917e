"""One picture, whose view layers Blender renders one after the other: its messages and each layer's time limit."""

import time

from ..messages.messages import Messages

# Least time limit of a layer in seconds; 0 would mean no limit.
_LEAST = 1e-3


class Picture:
    """key: identifies the picture; layers: the names of the view layers to render."""

    def __init__(self, key, layers):
        self.key = key
        self.messages = Messages()
        self._layers = len(layers)
        self._begun = set()
        self._pressed = self.started = time.monotonic()

    def has(self, key, layer):
        """Whether the picture has this key and the layer has not begun yet."""
        return key == self.key and layer not in self._begun

    def begin(self, layer):
        self._begun.add(layer)
        self.started = time.monotonic()

    def limit(self, seconds):
        """Return the current layer's time limit, an even share of the rest of the picture's; 0 is no limit."""
        if seconds == 0.0:
            return 0.0
        left = seconds - (self.started - self._pressed)
        return max(_LEAST, left / max(1, self._layers - len(self._begun) + 1))
