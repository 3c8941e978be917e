"""A view layer's finished picture without noise: whether it is wanted, what it needs of the render, and what is told of it.

What denoising shows is a guess. No figure about accuracy counts it: DECLARATION goes wherever such a figure goes.
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
# What guides the network, as in Cycles by default.
_GUIDES = (Pass.ALBEDO, Pass.DENOISING_NORMAL)
_GUIDE_SAMPLES = 32


def wanted(scene, view_layer):
    """Does this layer ask for it? The layer's own switch is that of Cycles, an add-on that may be off."""
    settings = scene.lancer
    # Normals shows geometry, which has no noise to guess at.
    here = getattr(getattr(view_layer, "cycles", None), "use_denoising", True)
    return settings.use_denoising and settings.integrator != "NORMALS" and here


@functools.cache
def missing():
    """Why it cannot be done here, as a sentence; "" where it can."""
    try:
        oidn.load()
    except LancerError as error:
        return f"{error}; {AS_IT_IS}"
    return ""


def ready(scene, view_layer):
    return wanted(scene, view_layer) and not missing()


def apply(session, poll=None, tell=None):
    """(Denoised, "") of the session's picture; (None, "") where poll() said to stop; (None, why) where it failed.

    tell(text) is called while it works.
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
    """Albedo and normal of the picture's own first samples.

    They are rendered by themselves: beside them each sample of the picture would take longer, and few of them are enough.
    """
    if set(_GUIDES) <= set(session.settings.passes):
        return [session.read(source) for source in _GUIDES]
    if tell is not None:
        tell("Denoising: looking at surfaces")
    rendered = session.statistics().samples // (session.camera.region_width * session.camera.region_height)
    samples = max(1, min(rendered, _GUIDE_SAMPLES))
    settings = dataclasses.replace(session.settings, passes=(Pass.COMBINED, *_GUIDES), samples=samples)
    with lowered(lambda: Session(session.scene, session.camera, settings)) as guides:
        if not guides.render_all(samples, poll) or (poll is not None and poll()):
            raise Cancelled
        return [guides.read(source) for source in _GUIDES]


def statistics(denoised):
    """For last_statistics; denoised: what apply gave, or None."""
    if denoised is None:
        return {"denoised": "", "denoiser": "", "denoising_seconds": 0.0, "denoising_bytes": 0}
    return {
        "denoised": DECLARATION,
        "denoiser": f"Open Image Denoise {denoised.version}",
        "denoising_seconds": denoised.seconds,
        "denoising_bytes": denoised.memory_bytes,
    }
