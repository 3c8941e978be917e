"""Denoising of arrays by Open Image Denoise.

    image = denoise(color, albedo, normal).image

With the noise of its samples, a picture is denoised twice: with a part of that noise added, and with it subtracted. The two
results tell the error of their mean, which is then combined with the samples (bindings/denoised.py).
"""

import time
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..bindings.abi import LancerError
from ..bindings.denoised import Combined, combine
from . import oidn
from .device import Device
from .plan import BALANCED, PLANS, Plan

# The largest half-precision number: the range of the network's input, relative to the median of a usual picture.
_BRIGHTEST = 65504.0
# The part of the noise that is added and subtracted. For 1/4, 1/2, 3/4 and 1 the squared error of the mean is 0.97, 0.97, 1.00
# and 1.07 of that of one denoised picture at 4 samples, 0.95, 0.94, 0.94 and 0.96 at 256 (geometric means over scenes).
_STEP = 0.5
# Added to normals for their combination, whose errors are relative to luminance.
_ABOVE = 2.0


class Noise(NamedTuple):
    """Half the difference of two halves of the samples of colours and guides, (height, width, 3)."""

    color: np.ndarray
    albedo: np.ndarray | None = None
    normal: np.ndarray | None = None
    errors: np.ndarray | None = None  # of the colours' luminance, (height, width, 1)


@dataclass(frozen=True)
class Denoised:
    image: np.ndarray  # the shape of the colours; alpha unchanged
    seconds: float
    memory_bytes: int  # the images plus the largest growth of the process; 0 if unknown
    version: str
    combined: Combined | None = None  # with the error; None without noise
    pair: tuple = ()  # the arguments of combine(), from which other figures can be computed
    catcher: np.ndarray | None = None  # the pass SHADOW_CATCHER, (height, width, 3)


def denoise(
    color, albedo=None, normal=None, noise=None, *, plan=PLANS[0], combines=True, threads=0, poll=None, tell=None, library=None
):
    """Return the Denoised of linear colours, (height, width, 3 or 4) float32; a fourth channel is copied.

    albedo and normal, (height, width, 3), are those of the first rough surfaces, and guide the network. A normal needs an
    albedo. noise: Noise, with that of each guide; None: one result without an error. combines: False leaves the samples out of
    the result. The arguments are not modified. threads: 0 = all. tell(fraction) is called while waiting. Raise Cancelled if
    poll returns True, LancerError for inputs of wrong shape or with values that are not finite, and if the library fails.
    """
    errors = noise.errors if noise is not None else None
    image, guides, noise = _checked(color, {"albedo": albedo, "normal": normal}, noise)
    plan = Plan(*plan)
    started = time.monotonic()
    filters = (2 if noise else 1) + (len(guides) if plan.prefilters else 0)
    combined, pair = None, ()
    with Device(library or oidn.load(), filters, threads, poll, tell) as device:
        exposure = _Exposure(image[..., :3])
        # A black picture needs no denoising.
        if exposure.lit:
            run = _Run(device, exposure, plan, guides, noise)
            if noise:
                pair = *run.pair(image[..., :3]), errors
                combined = combine(*pair, combines=combines)
            image[..., :3] = combined.picture if noise else run.colors(image[..., :3])
    held = image.nbytes + sum(array.nbytes for array in (*guides.values(), *noise.values()))
    number, memory = device.version, device.memory
    version = ".".join(str(part) for part in (number // 10000, number // 100 % 100, number % 100))
    size = memory.growth + held if memory.known else 0
    return Denoised(image, time.monotonic() - started, size, version, combined, pair)


class _Run:
    """The runs for one picture: guides first, then colours."""

    def __init__(self, device, exposure, plan, guides, noise):
        self._device, self._exposure, self._plan, self._noise = device, exposure, plan, noise
        self._guides = {name: self._prefiltered(name, guide) if plan.prefilters else guide for name, guide in guides.items()}

    def _prefiltered(self, name, guide):
        """Return a guide without noise, so that the network can rely on it (cleanAux), and with its details."""
        clean = np.empty_like(guide)
        # A better network gives the same picture in the end.
        self._device.run({name: guide}, clean, BALANCED)
        if not self._noise:
            return clean
        above = np.float32(_ABOVE if name == "normal" else 0.0)
        return combine(guide + above, self._noise[name], clean + above, clean + above, 1.0).picture - above

    def colors(self, color, turned=False):
        """Return denoised colours; turned: of the picture with rows as columns, in which a network makes other errors."""
        scaled, excess = self._exposure.scaled(color)
        inputs = {"color": scaled, **self._guides}
        if turned:
            inputs = {name: np.ascontiguousarray(array.swapaxes(0, 1)) for name, array in inputs.items()}
        result = np.empty_like(inputs["color"])
        clean = bool(self._guides) and self._plan.prefilters
        self._device.run(inputs, result, self._plan.quality, hdr=True, cleanAux=clean)
        return self._exposure.restored(result.swapaxes(0, 1) if turned else result, excess)

    def pair(self, color):
        """Return the arguments of combine()."""
        step = np.float32(_STEP) * self._noise["color"]
        first, second = self.colors(color + step), self.colors(color - step, turned=True)
        return np.array(color), self._noise["color"], first, second, _STEP


class _Exposure:
    """Scales colours into the network's range, and denoised colours back.

    The library adjusts exposure itself, but fails for very dark pictures, and an extremely bright pixel spoils its
    surroundings.
    """

    def __init__(self, color):
        peak = _peak(color)
        exponents = np.frexp(peak[peak > 0.0])[1]
        self.lit = exponents.size > 0
        if self.lit:
            # Scale by the median exponent of lit pixels: a power of two is exact, and the median ignores single bright pixels.
            middle = exponents.size // 2
            self._exponent = int(np.partition(exponents, middle)[middle])

    def scaled(self, color):
        """Return the scaled colours, and for each pixel the factor by which it was too bright; None: none was."""
        peak = _peak(color)
        brightest = np.ldexp(_BRIGHTEST, self._exponent)
        if float(peak.max()) <= brightest:
            return np.ldexp(color, -self._exponent), None
        # Clamp pixels that are too bright, but keep their hue.
        excess = np.maximum(peak.astype(np.float64) / brightest, 1.0)
        return np.ldexp(color / excess[..., None], -self._exponent).astype(np.float32), excess

    def restored(self, color, excess):
        if excess is not None:
            # Restore the brightness of visible lamps; single bright pixels are noise that the network has removed.
            seen = _peak(color) > 0.5 * _BRIGHTEST
            color = color * np.where(seen, excess, 1.0)[..., None]
        with np.errstate(over="ignore"):
            return np.minimum(np.ldexp(color, self._exponent), np.finfo(np.float32).max).astype(np.float32, copy=False)


def _peak(color):
    """Return the largest channel of each pixel, (height, width)."""
    return np.maximum(np.maximum(color[..., 0], color[..., 1]), color[..., 2])


def _checked(color, guides, noise):
    """Return a writable copy of the colours, and guides and noise by their names in the library; raise LancerError if
    invalid."""
    shape = np.shape(color)
    if len(shape) != 3 or shape[2] not in (3, 4) or 0 in shape:
        raise LancerError(f"denoising: colours of shape {shape}, not (height, width, 3 or 4)")
    if guides["normal"] is not None and guides["albedo"] is None:
        raise LancerError("denoising: a normal needs an albedo beside it")
    noise = {name: array for name, array in noise._asdict().items() if name != "errors"} if noise is not None else {}
    images, noises = {}, {}
    for kind, given, into in (("", guides, images), ("noise of ", noise, noises)):
        for name, array in given.items():
            if array is None and not (noise and guides.get(name) is not None):
                continue
            if np.shape(array) != (*shape[:2], 3):
                raise LancerError(f"denoising: {kind}{name} of shape {np.shape(array)} beside colours of shape {shape}")
            into[name] = np.ascontiguousarray(array, np.float32)
    image = np.array(color, np.float32, order="C")
    named = {"colour": image, **images, **{f"noise of {name}": array for name, array in noises.items()}}
    for name, array in named.items():
        if not np.isfinite(array).all():
            raise LancerError(f"denoising: {name} is not finite everywhere")
    return image, images, noises
