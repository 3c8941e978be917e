"""Denoising of a view layer's finished picture.

Denoising is a guess, which no figure about accuracy includes: DECLARATION accompanies each such figure.
"""

import dataclasses
import functools
import time

from ..bindings.abi import LancerError
from ..bindings.enums import Pass
from ..bindings.session import Cancelled, Session
from ..host.priority import lowered
from . import denoiser, oidn

DECLARATION = "denoised: the error given is that of the picture before denoising"

AS_IT_IS = "the picture is shown with its noise"
# The network's guides, as in Cycles by default.
_GUIDES = (Pass.ALBEDO, Pass.DENOISING_NORMAL)
_GUIDE_SAMPLES = 32


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


def apply(session, poll=None, tell=None):
    """Return (Denoised, "") of the session's picture, (None, "") if poll cancelled, or (None, reason) if denoising failed.

    tell(text) reports progress.
    """
    started = time.monotonic()
    try:
        guides = _guides(session, poll, tell)
        color = session.read(Pass.COMBINED)
        threads = session.settings.threads

        def working(fraction):
            if tell is not None:
                tell(f"Denoising {fraction:.0%}")

        denoised = denoiser.denoise(color, *guides, threads=threads, poll=poll, tell=working)
        return dataclasses.replace(denoised, seconds=time.monotonic() - started), ""
    except Cancelled:
        return None, ""
    except MemoryError:
        return None, f"there is not enough memory for denoising; {AS_IT_IS}"
    except LancerError as error:
        return None, f"{error}; {AS_IT_IS}"


def _guides(session, poll, tell):
    """Return albedo and normal of the picture's first samples; raise Cancelled by poll.

    They are rendered separately, since few samples suffice: as passes they would slow down every sample of the picture.
    """
    if set(_GUIDES) <= set(session.settings.passes):
        return [session.read(source) for source in _GUIDES]
    if tell is not None:
        tell("Denoising: rendering albedo and normals")
    rendered = session.statistics().samples // (session.camera.region_width * session.camera.region_height)
    samples = max(1, min(rendered, _GUIDE_SAMPLES))
    settings = dataclasses.replace(session.settings, passes=(Pass.COMBINED, *_GUIDES), samples=samples)
    with lowered(lambda: Session(session.scene, session.camera, settings)) as guides:
        if not guides.render_all(samples, poll) or (poll is not None and poll()):
            raise Cancelled
        return [guides.read(source) for source in _GUIDES]


def statistics(denoised):
    """Return the entries of last_statistics. denoised: the Denoised from apply, or None."""
    if denoised is None:
        return {"denoised": "", "denoiser": "", "denoising_seconds": 0.0, "denoising_bytes": 0}
    return {
        "denoised": DECLARATION,
        "denoiser": f"Open Image Denoise {denoised.version}",
        "denoising_seconds": denoised.seconds,
        "denoising_bytes": denoised.memory_bytes,
    }
