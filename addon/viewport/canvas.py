"""A picture as a texture, drawn into a region of Blender's window."""

import gpu
import numpy as np
from gpu_extras.presets import draw_texture_2d

# The largest number of a half-precision texture.
_BRIGHTEST = 65504.0


class Canvas:
    """The texture of one picture at a time. Use it in Blender's main thread during drawing."""

    def __init__(self):
        self._image = self._texture = None

    def draw(self, image, rectangle):
        """Draw image, (height, width, 4) float32, scene-linear and premultiplied, into the rectangle of the region."""
        if image is not self._image:
            self._texture = _texture(image)
            self._image = image
        gpu.state.blend_set("ALPHA_PREMULT")
        draw_texture_2d(self._texture, (rectangle.x, rectangle.y), rectangle.width, rectangle.height)
        gpu.state.blend_set("NONE")


def _texture(image):
    height, width, channels = image.shape
    values = np.ascontiguousarray(np.minimum(image, _BRIGHTEST), np.float32)
    buffer = gpu.types.Buffer("FLOAT", height * width * channels, values)
    return gpu.types.GPUTexture((width, height), format="RGBA16F", data=buffer)
