"""The combination of a picture with denoised versions of it, and the error of the result: lancer_combine_denoised."""

import ctypes
from typing import NamedTuple

import numpy as np

from . import abi


class Combined(NamedTuple):
    """error, low, high: of the picture, in the unit of PictureError, with its interval; moved: relative light that denoising
    alone has moved between blocks."""

    picture: np.ndarray  # (height, width, 3)
    bars: np.ndarray  # standard error of the luminance of each block, (blocks in height, blocks in width)
    error: float
    low: float
    high: float
    moved: float


def combine(noisy, noise, first, second, step, errors=None, *, combines=True, confidence=0.95, block=1, library=None):
    """Return the Combined of a picture, linear (height, width, 3) float32 like the other three.

    noise: Pass.HALVES, from at least two samples; first, second: a denoiser's results for noisy + step noise and noisy - step
    noise. errors: Pass.ERROR, (height, width, 1), which tells small lights from bright errors. combines: False returns the mean
    of first and second. block: side of the blocks of bars, in pixels. Raise LancerError for other shapes and for
    values that are not finite.
    """
    library = library or abi.load_library()
    height, width, channels = np.shape(noisy)
    inputs = [np.ascontiguousarray(array, np.float32) for array in (noisy, noise, first, second)]
    if channels != 3 or any(array.shape != (height, width, 3) for array in inputs):
        shapes = ", ".join(str(array.shape) for array in inputs)
        raise abi.LancerError(f"combine: pictures of shapes {shapes}")
    picture = np.empty((height, width, 3), np.float32)
    bars = np.empty(((height + block - 1) // block, (width + block - 1) // block), np.float32)
    error = abi.DenoisedError()
    pointers = [array.ctypes.data for array in inputs]
    known = None if errors is None else np.ascontiguousarray(errors, np.float32)
    if known is not None and known.size != height * width:
        raise abi.LancerError(f"combine: errors of shape {known.shape} beside pictures of shape {inputs[0].shape}")
    pointers.insert(2, None if known is None else known.ctypes.data)
    outputs = picture.ctypes.data, bars.ctypes.data, ctypes.byref(error)
    settings = float(step), int(combines), float(confidence), int(block)
    abi.check(library.lancer_combine_denoised(width, height, *pointers, *settings, *outputs), library)
    return Combined(picture, bars, error.error, error.low, error.high, error.moved)
