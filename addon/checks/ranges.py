"""The values of a material's nodes over their images: a sample of texels, evaluated through the nodes.

Values that depend on the shading point, on two images or on nodes not evaluated here are NaN, unknown. So each value occurs in
the image, and none is only a bound.
"""

import numpy as np

from ..bindings.blocks import even_sample
from ..bindings.enums import AlphaMode, MathOperation, MixMode, NodeKind, Transfer, VectorOperation
from ..bindings.shading import NodeRef

_MATH = {
    MathOperation.ADD: lambda a, b, c: a + b,
    MathOperation.SUBTRACT: lambda a, b, c: a - b,
    MathOperation.MULTIPLY: lambda a, b, c: a * b,
    MathOperation.DIVIDE: lambda a, b, c: np.where(b == 0.0, 0.0, a / b),
    MathOperation.MULTIPLY_ADD: lambda a, b, c: a * b + c,
    MathOperation.MINIMUM: lambda a, b, c: np.minimum(a, b),
    MathOperation.MAXIMUM: lambda a, b, c: np.maximum(a, b),
}
_VECTOR = {
    VectorOperation.ADD: lambda a, b, c: a + b,
    VectorOperation.SUBTRACT: lambda a, b, c: a - b,
    VectorOperation.MULTIPLY: lambda a, b, c: a * b,
    VectorOperation.MULTIPLY_ADD: lambda a, b, c: a * b + c,
    VectorOperation.MINIMUM: lambda a, b, c: np.minimum(a, b),
    VectorOperation.MAXIMUM: lambda a, b, c: np.maximum(a, b),
}
_MIX = {
    MixMode.MIX: lambda t, a, b: a + t * (b - a),
    MixMode.ADD: lambda t, a, b: a + t * b,
    MixMode.SUBTRACT: lambda t, a, b: a - t * b,
    MixMode.MULTIPLY: lambda t, a, b: a * (1.0 - t + t * b),
}


class Ranges:
    """Values of the nodes of one material or world."""

    def __init__(self, nodes, images):
        self.nodes = nodes
        self.images = images
        self._known = {}

    def values(self, parameter):
        """Return the known values of a parameter, (n, 3)."""
        values = self._value(parameter)[0][:, :3]
        return values[np.isfinite(values).all(axis=1)]

    def _value(self, parameter):
        """Return (values (n, 4), the image that they come from or None); n is 1 without an image."""
        if not isinstance(parameter, NodeRef):
            scalar = not isinstance(parameter, tuple)
            return np.array([[*([parameter] * 3 if scalar else parameter), 1.0]]), None
        number = parameter.node
        if number not in self._known:
            self._known[number] = self._compute(self.nodes[number])
        return self._known[number]

    def _compute(self, node):
        if node.kind == NodeKind.IMAGE:
            return self._picture(node), (node.image, node.image_count)
        found = [self._value(value) for value in node.inputs]
        pictures = {picture for _, picture in found if picture is not None}
        inputs = [values for values, _ in found]
        inputs += [np.zeros((1, 4))] * (5 - len(inputs))
        result = _result(node, inputs) if len(pictures) < 2 else None
        picture = pictures.pop() if len(pictures) == 1 else None
        if result is None:
            return np.full((1, 4), np.nan), None
        if result.shape[1] == 3:
            result = np.hstack((result, np.ones((len(result), 1))))
        return result, picture

    def _picture(self, node):
        """Return texels in the nodes' colour space; extension and interpolation can produce other values too."""
        parts = [_decoded(image) for image in self.images[node.image : node.image + node.image_count]]
        return np.concatenate(parts) if parts else np.full((1, 4), np.nan)


def _result(node, inputs):
    """Return a node's values, (n, 3) or (n, 4); None if its kind is not evaluated here."""
    a, b, c = (value[:, :3] for value in inputs[:3])
    if node.kind == NodeKind.MATH and node.option in _MATH:
        result = _MATH[node.option](a, b, c)
        return np.clip(result, 0.0, 1.0) if node.flags & 1 else result
    if node.kind == NodeKind.VECTOR_MATH:
        if node.option == VectorOperation.SCALE:
            return a * inputs[3][:, :3]
        return _VECTOR[node.option](a, b, c) if node.option in _VECTOR else None
    if node.kind == NodeKind.MIX and node.option in _MIX:
        result = _MIX[node.option](np.clip(a, 0.0, 1.0) if node.flags & 1 else a, b, c)
        return np.clip(result, 0.0, 1.0) if node.flags & 2 else result
    if node.kind == NodeKind.SEPARATE:
        return np.repeat(a[:, node.option : node.option + 1], 3, axis=1)
    if node.kind == NodeKind.COMBINE:
        return np.hstack([part[:, :1] for part in np.broadcast_arrays(a, b, c)])
    if node.kind == NodeKind.GREY:
        return np.repeat(a @ np.array(node.matrix[:3])[:, None], 3, axis=1)
    if node.kind == NodeKind.ALPHA:
        return np.repeat(inputs[0][:, 3:], 3, axis=1)
    if node.kind == NodeKind.CLAMP:
        return np.clip(a, np.minimum(b, c), np.maximum(b, c))
    if node.kind == NodeKind.INVERT:
        return b + a * (1.0 - 2.0 * b)
    return None


def _decoded(image):
    """Return an even sample of an image's texels, (n, 4), with straight alpha, in the working space."""
    texels = even_sample(image.texels)
    if texels.dtype != np.float32:
        texels = texels / float(np.iinfo(texels.dtype).max)
    texels = texels.astype(float)
    color = np.repeat(texels, 3, axis=1) if texels.shape[1] == 1 else texels[:, :3]
    alpha = texels[:, 3:] if texels.shape[1] == 4 and image.alpha != AlphaMode.NONE else np.ones((len(texels), 1))
    if image.alpha == AlphaMode.ASSOCIATED:
        color = np.where(alpha > 0.0, color / alpha, 0.0)
    if image.transfer == Transfer.SRGB:
        color = np.where(color <= 0.04045, color / 12.92, (np.maximum(color, 0.0) / 1.055 + 0.055 / 1.055) ** 2.4)
    return np.hstack((color @ np.array(image.matrix).reshape(3, 3).T, alpha))
