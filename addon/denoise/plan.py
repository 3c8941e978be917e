"""How much work the denoiser gets: the best of its networks that takes a small part of a picture's time.

The choice depends on the picture's pixels and samples alone, so that equal settings give equal pictures.
"""

from typing import NamedTuple

# Qualities of the library from version 2 on.
FAST, BALANCED, HIGH = 4, 5, 6
# Microseconds per pixel of one run, of the combination with the samples and all else, and of a sample of a usual scene,
# measured with two threads and AVX2: only the ratios matter. With AVX-512 runs take two thirds of their time.
_RUN = {FAST: 1.15, BALANCED: 3.0, HIGH: 8.2}
_AROUND = 1.0
_SAMPLE = 1.25
# Share of the time for samples that denoising may take, and the seconds that it may take in any case.
_SHARE, _SECONDS = 0.1, 2.0


class Plan(NamedTuple):
    quality: int
    prefilters: bool  # albedo and normal are denoised first

    @property
    def cost(self):
        """Microseconds per pixel."""
        return 2.0 * _RUN[self.quality] + _AROUND + (2.0 * _RUN[BALANCED] if self.prefilters else 0.0)


# In order of quality. Squared errors over twenty scenes of 4 to 64 samples, relative to the first: 1; 1.16; 1.25; 1.4.
PLANS = (Plan(HIGH, True), Plan(BALANCED, True), Plan(BALANCED, False), Plan(FAST, False))


FASTEST = PLANS[-1]


def plan(pixels, samples):
    """Return the Plan for a picture with that many pixels and samples per pixel."""
    allowed = max(_SHARE * _SAMPLE * samples, 1e6 * _SECONDS / pixels)
    return next((each for each in PLANS if each.cost <= allowed), FASTEST)
