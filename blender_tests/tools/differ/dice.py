"""Random choices that are the same in every Python: all come of random.Random.random."""

import random


class Dice:
    def __init__(self, seed):
        self._source = random.Random(seed)

    def chance(self, share):
        return self._source.random() < share

    def number(self, low=0.0, high=1.0):
        """Three decimals are enough for any picture, and short in print."""
        return round(low + (high - low) * self._source.random(), 3)

    def whole(self, low, high):
        """Both ends belong to it."""
        return low + int(self._source.random() * (high - low + 1))

    def pick(self, choices):
        """One of a sequence; of a dict a key, by the weights that are its values."""
        if isinstance(choices, dict):
            at = self._source.random() * sum(choices.values())
            for choice, weight in choices.items():
                at -= weight
                if at < 0.0:
                    return choice
            return choice
        return choices[int(self._source.random() * len(choices))]

    def color(self, low=0.05, high=0.95):
        return [self.number(low, high) for _ in range(3)]

    def vector(self, low=-1.0, high=1.0):
        return [self.number(low, high) for _ in range(3)]

    def some(self, choices, share):
        """Each with that chance, in their order."""
        return [choice for choice in choices if self.chance(share)]
