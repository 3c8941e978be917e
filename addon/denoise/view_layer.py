"""Denoising of a view layer's finished picture, and the error of the denoised picture."""

import dataclasses
import functools
import math
import time

import numpy as np

from ..bindings import shadowed
from ..bindings.abi import LancerError
from ..bindings.enums import Catchers, Pass
from ..bindings.session import Cancelled
from . import denoiser, oidn, shadows
from .plan import FASTEST, plan

DECLARATION = "denoised: a guess that can remove details; its own error is told beside that of the picture before denoising"

AS_IT_IS = "the picture is shown with its noise"
# Passes of the picture's own samples: guides of the network as in Cycles by default, and the noise of each.
PASSES = (Pass.ALBEDO, Pass.DENOISING_NORMAL, Pass.HALVES, Pass.ALBEDO_HALVES, Pass.NORMAL_HALVES)
_NOISE = (Pass.HALVES, Pass.ALBEDO_HALVES, Pass.NORMAL_HALVES)


def wanted(scene, view_layer):
    """Whether the layer is to be denoised. The layer's own switch belongs to Cycles, an add-on that may be disabled."""
    settings = scene.lancer
    # The integrator NORMALS has no noise.
    here = getattr(getattr(view_layer, "cycles", None), "use_denoising", True)
    return settings.use_denoising and settings.integrator != "NORMALS" and here


@functools.cache
def missing():
    """Return a sentence about why denoising is impossible in this Blender; "" if it is possible."""
    try:
        oidn.load()
    except LancerError as error:
        return f"{error}; {AS_IT_IS}"
    return ""


def ready(scene, view_layer):
    return wanted(scene, view_layer) and not missing()


def prepared(settings, shown=()):
    """Return the settings of a session whose picture is to be denoised. shown: passes that the user sees."""
    guides_shown = {Pass.ALBEDO, Pass.DENOISING_NORMAL, Pass.DENOISING_DEPTH} & set(shown)
    return dataclasses.replace(
        settings,
        passes=tuple(sorted({*settings.passes, *PASSES})),
        # The rule of 5.2 serves the network better where surfaces are transparent; passes that are shown follow Blender.
        blended_features=settings.blended_features or not guides_shown,
    )


def inputs(session):
    """Return the arguments of denoiser.denoise for a session's picture."""
    pixels = session.camera.region_width * session.camera.region_height
    samples = session.statistics().samples / pixels
    noise, errors = None, session.read(Pass.ERROR)
    # Pixels of fewer than two samples have no error.
    if np.isfinite(errors).all():
        noise = denoiser.Noise(*(session.read(source) for source in _NOISE), errors)
    return {
        "color": session.read(Pass.COMBINED),
        "albedo": session.read(Pass.ALBEDO),
        "normal": session.read(Pass.DENOISING_NORMAL),
        "noise": noise,
        "plan": plan(pixels, samples),
        "threads": session.settings.threads,
    }


def apply(session, combines=True, poll=None, tell=None):
    """Return (Denoised, "") of the session's picture, (None, "") if poll cancelled, or (None, reason) if denoising failed.

    combines: whether the samples may take part in the result. tell(text) reports progress.
    """
    started = time.monotonic()

    def working(fraction):
        if tell is not None:
            tell(f"Denoising {fraction:.0%}")

    try:
        denoised = _denoised(session, combines, {"poll": poll, "tell": working})
        return dataclasses.replace(denoised, seconds=time.monotonic() - started), ""
    except Cancelled:
        return None, ""
    except MemoryError:
        return None, f"there is not enough memory for denoising; {AS_IT_IS}"
    except LancerError as error:
        return None, f"{error}; {AS_IT_IS}"


def _denoised(session, combines, work):
    """Return the Denoised of a session's picture, and of its pass of shadow catchers. work: arguments of denoiser.denoise."""
    given = inputs(session)
    if session.settings.catchers == Catchers.OBJECTS:
        return denoiser.denoise(**given, combines=combines, **work)
    # The noise of the samples is that of the picture with its shadow catchers.
    del given["noise"], given["color"]
    return shadows.denoise_parts(shadowed.parts_of(session), **given, **work)


def error_of(session):
    """Return (error, upper end of its interval) of a session's picture after fast denoising; None if it cannot be known."""
    if session.settings.catchers != Catchers.OBJECTS:
        return None
    try:
        combined = denoiser.denoise(**{**inputs(session), "plan": FASTEST}).combined
    except LancerError:
        return None
    return (combined.error, combined.high) if combined is not None else None


def statistics(denoised):
    """Return the entries of last_statistics. denoised: the Denoised from apply, or None."""
    if denoised is None:
        told = {"denoised": "", "denoiser": "", "denoising_seconds": 0.0, "denoising_bytes": 0}
    else:
        told = {
            "denoised": DECLARATION,
            "denoiser": f"Open Image Denoise {denoised.version}",
            "denoising_seconds": denoised.seconds,
            "denoising_bytes": denoised.memory_bytes,
        }
    combined = denoised.combined if denoised is not None else None
    # One sample tells no error.
    values = (combined.error, combined.low, combined.high, combined.moved) if combined else (math.inf,) * 3 + (0.0,)
    names = ("denoised_error", "denoised_error_low", "denoised_error_high", "denoised_moved")
    return {**told, **dict(zip(names, values, strict=True))}
