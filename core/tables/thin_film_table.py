"""Writes src/bsdf/thin_film_table.h: the colours of light that interferes, by optical path difference; needs numpy, scipy and
colour-science.

python tables/thin_film_table.py src/bsdf/thin_film_table.h

Reflected by a film, light of the wavelength w changes by cos(2 pi d / w) with the path difference d. The colour of this change
is the Fourier transform of the colour matching functions over 1 / w, at d: of the primaries of Rec. 709, over its value at 0
(Belcour and Barla 2017). Nodes and sampling of the transform are those of Cycles from 5.0 on, whose kernel interpolates
linearly between them."""

import sys
from pathlib import Path

import colour
import numpy as np
from scipy.interpolate import CubicSpline

NODES = 512
LENGTH = 60.0  # of 2 pi d at the last node, in micrometres
SCALE = 10000
# XYZ of D65 to Rec. 709.
TO_RGB = np.array([[3.2404542, -1.5371385, -0.4985314], [-0.9692660, 1.8760108, 0.0415560], [0.0556434, -0.2040259, 1.0572252]])


def transforms():
    """Return the complex transforms of X, Y and Z, one row a node."""
    observer = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"]
    spline = CubicSpline(observer.wavelengths / 1000.0, observer.values, extrapolate=False)
    frequencies = np.maximum(np.arange(2 * NODES - 2) * np.pi / LENGTH, 1e-40)
    with np.errstate(over="ignore", invalid="ignore"):
        sampled = np.nan_to_num(spline(1.0 / frequencies) / frequencies[:, None] ** 2)
    return np.fft.rfft(sampled, axis=0)


def main(path):
    found = transforms() @ TO_RGB.T
    found /= found[0].real
    rows = np.round(SCALE * np.stack([found.real, found.imag], axis=-1)).astype(np.int16)
    words = np.ascontiguousarray(rows.transpose(1, 0, 2)).view("<u4")[..., 0]
    body = ",\n".join(" {" + ",".join(map(str, channel)) + "}" for channel in words)
    Path(path).write_text(
        f"""// Written by tables/thin_film_table.py.
// clang-format off
#pragma once

#include <cstdint>

namespace lancer {{

// Colours of light that interferes, in 1/{SCALE}, by channel and path difference: sixteen bits each of the real part, in the
// lower half of a word, and of the imaginary part.
inline constexpr int kFilmNodes = {NODES};
inline constexpr float kFilmScale = {SCALE}.0f, kFilmLength = {LENGTH * 1000:.1f}f; // of 2 pi d at the last node, nanometres
constexpr uint32_t kFilmColors[3][kFilmNodes] = {{
{body}
}};

}} // namespace lancer
""",
        encoding="utf-8",
    )


if __name__ == "__main__":
    main(*sys.argv[1:])
