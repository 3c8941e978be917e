"""A view layer's finished picture without noise: whether it is wanted, what it needs of the render, and what is told of it.

What denoising shows is a guess. No figure about accuracy counts it: DECLARATION goes wherever such a figure goes.
"""

import functools

from .bindings import denoiser, oidn
from .bindings.abi import LancerError
from .bindings.enums import Pass
from .bindings.session import Cancelled

DECLARATION = "denoised: the error given is that of the picture before denoising"

_AS_IT_IS = "the picture is shown with its noise"
# What guides the network, as in Cycles by default.
_GUIDES = (Pass.ALBEDO, Pass.DENOISING_NORMAL)


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
        return f"{error}; {_AS_IT_IS}"
    return ""


def sources(scene, view_layer):
    """The passes that the core should render for it, for ExportOptions; none where it is not wanted or cannot be done."""
    return _GUIDES if wanted(scene, view_layer) and not missing() else ()


def apply(session, poll=None, tell=None):
    """(Denoised, "") of the session's picture; (None, "") where poll() said to stop; (None, why) where it failed.

    tell(fraction) is called while it works.
    """
    try:
        color, albedo, normal = (session.read(source) for source in (Pass.COMBINED, *_GUIDES))
        return denoiser.denoise(color, albedo, normal, threads=session.settings.threads, poll=poll, tell=tell), ""
    except Cancelled:
        return None, ""
    except MemoryError:
        return None, f"there is not enough memory for denoising; {_AS_IT_IS}"
    except LancerError as error:
        return None, f"{error}; {_AS_IT_IS}"


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
