"""Effects of an object's transform on a lamp, as in Cycles: stretched, sheared, mirrored, flattened."""

import bpy
import numpy as np

from ..bindings.enums import AreaShape, LightKind


def axes_of(kind, matrix, keeps_scale=False):
    """Return the matrix with columns of unit length, or of their own; a zero column becomes the unit vector of its axis.

    The z axis of a flattened area lamp becomes the normal of its plane. A spot before 4.0 keeps z alone, as Cycles did.
    """
    result = matrix[:3].copy()
    lengths = np.linalg.norm(result[:, :3], axis=0)
    for axis in range(3):
        result[:, axis] = result[:, axis] / lengths[axis] if lengths[axis] > 0.0 else np.eye(3)[axis]
    if kind == LightKind.AREA and not lengths[2] > 0.0:
        normal = np.cross(result[:, 0], result[:, 1])
        result[:, 2] = normal / np.linalg.norm(normal)
    if kind == LightKind.SPOT and bpy.app.version < (4, 0) and (is_sheared(matrix) or not lengths.all()):
        z = result[:, 2]
        x = np.cross(np.eye(3)[np.abs(z).argmin()], z)
        result[:, 0] = x / np.linalg.norm(x)
        result[:, 1] = np.cross(z, result[:, 0])
    if keeps_scale:
        result[:, :3] *= np.where(lengths > 0.0, lengths, 1.0)
    return result


def cone_stretch(matrix):
    """Return the stretch of a spot's cone along x and y by its scale; before 4.0 Cycles keeps the cone round."""
    lengths = np.linalg.norm(matrix[:3, :3], axis=0)
    if bpy.app.version < (4, 0) or not lengths.all():
        return 1.0, 1.0
    return float(lengths[0] / lengths[2]), float(lengths[1] / lengths[2])


def area_of(matrix, shape, size):
    """Return the area of an area lamp with these full lengths; of a sheared one that of the parallelogram or ellipse."""
    area = size[0] * size[1] * (0.25 * np.pi if shape == AreaShape.ELLIPSE else 1.0)
    if not (area > 0.0 and is_sheared(matrix)):
        return area
    x, y = matrix[:3, 0], matrix[:3, 1]
    return area * float(np.linalg.norm(np.cross(x, y)) / (np.linalg.norm(x) * np.linalg.norm(y)))


def is_sheared(matrices):
    """Whether the axes of each matrix are not orthogonal. Parents leave errors of 1e-5 in single precision; ten times that
    bends a cone by 0.006 degrees, which is invisible.
    """
    columns = matrices[..., :3, :3]
    lengths = np.linalg.norm(columns, axis=-2, keepdims=True)
    axes = columns / np.where(lengths > 0.0, lengths, 1.0)
    cosines = np.swapaxes(axes, -1, -2) @ axes
    return np.abs(cosines[..., [0, 0, 1], [1, 2, 2]]).max(axis=-1) > 1e-4


def is_flattened(kind, matrix, depsgraph):
    """Whether a column of length 0 takes the lamp's light away in Cycles.

    A sun, and a spot before 4.0, depend on z alone. An area lamp flattened along z keeps its shape, but Cycles' light tree
    finds no direction in which it emits.
    """
    flat = np.linalg.norm(matrix[:3, :3], axis=0) == 0.0
    if kind == LightKind.SPOT:
        return bool(flat[2] if bpy.app.version < (4, 0) else flat.any())
    return bool(flat[2]) and (kind == LightKind.SUN or kind == LightKind.AREA and _uses_light_tree(depsgraph))


def shines_all_around(kind, matrix, radius, depsgraph):
    """Whether a spot without a direction shines to all sides: since 4.0, but for a point that the light tree leaves out."""
    flat = np.linalg.norm(matrix[:3, :3], axis=0) == 0.0
    is_kept = radius > 0.0 or not _uses_light_tree(depsgraph)
    return kind == LightKind.SPOT and bpy.app.version >= (4, 0) and flat.tolist() == [False, False, True] and is_kept


def describe_shear(kind, matrix, depsgraph):
    """Return the words for a message where Cycles contradicts itself about a sheared lamp; "" elsewhere."""
    if kind == LightKind.AREA and not np.linalg.norm(matrix[:3, 2]) > 0.0:
        return "its transform flattens it, Cycles lets only samples find it, here rays meet it too"
    if not is_sheared(matrix):
        return ""
    if kind == LightKind.AREA:
        return "its transform shears it, Cycles' samples and rays contradict each other, here its true shape shines"
    if kind == LightKind.SPOT and bpy.app.version >= (4, 0) and _uses_light_tree(depsgraph):
        return "its transform shears it, Cycles' light tree misses a part of its cone, here all of it shines"
    return ""


def _uses_light_tree(depsgraph):
    """Whether Cycles chooses lights by its light tree: from 3.5 on, unless the scene switches it off."""
    cycles = getattr(getattr(depsgraph, "scene", None), "cycles", None)
    return bpy.app.version >= (3, 5) and getattr(cycles, "use_light_tree", True)
