"""Denoising of one session's picture: at the checks of a target error, and at the end of the render."""

from typing import NamedTuple

from ..denoise import view_layer as denoise


class Wishes(NamedTuple):
    """What a scene asks of denoising."""

    combines: bool  # the samples may take part in the result
    of_target: bool  # the target error is that of the denoised picture


def wishes(scene, view_layer):
    """Return the Wishes of a view layer, or None if it is not denoised."""
    if not denoise.ready(scene, view_layer):
        return None
    return Wishes(scene.lancer.use_denoising_samples, scene.lancer.use_denoised_target)


class Denoising:
    """Keeps the newest result, which is reused while no samples follow. failure: why there is none."""

    def __init__(self, session, wanted, poll, tell):
        self._session, self._wanted, self._poll, self._tell = session, wanted, poll, tell
        self._samples, self._denoised = 0, None
        self.failure = ""

    def result(self):
        """Return the Denoised of the current samples; None if denoising failed or was cancelled."""
        samples = self._session.statistics().samples
        if self._denoised is None or samples != self._samples:
            self._denoised, self.failure = denoise.apply(self._session, self._wanted.combines, self._poll, self._tell)
            self._samples = samples
        return self._denoised

    def bound(self):
        """Return the upper end of the denoised picture's error; None if there is no denoised picture or no error."""
        denoised = None if self.failure else self.result()
        return denoised.combined.high if denoised is not None and denoised.combined is not None else None
