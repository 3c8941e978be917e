"""Cycles' panoramic projections as those of lancer.h."""

from ..bindings.enums import CameraKind

_KINDS = {
    "EQUIRECTANGULAR": CameraKind.EQUIRECTANGULAR,
    "FISHEYE_EQUIDISTANT": CameraKind.FISHEYE_EQUIDISTANT,
    "FISHEYE_EQUISOLID": CameraKind.FISHEYE_EQUISOLID,
    "FISHEYE_LENS_POLYNOMIAL": CameraKind.FISHEYE_POLYNOMIAL,
    "MIRRORBALL": CameraKind.MIRROR_BALL,
    "CENTRAL_CYLINDRICAL": CameraKind.CYLINDRICAL,
}


def panorama(data, aspect, who, messages):
    """Return (kind, parameters) of a camera of type PANO; a perspective camera, with a message, if it is not supported.

    aspect: width over height of the image, including the aspect of pixels.
    """
    # Before 4.2 the properties belong to the Cycles add-on, which may be disabled.
    owner = data if hasattr(data, "panorama_type") else getattr(data, "cycles", None)
    if owner is None:
        messages.add(f"{who}: panoramas are set by the Cycles add-on, which is off, a perspective camera is used")
        return CameraKind.PERSPECTIVE, (0.0,) * 8
    kind = _KINDS.get(owner.panorama_type)
    if kind is None:
        messages.add(
            f"{who}: panorama {owner.panorama_type} is not supported, a perspective camera is used", "feature:panorama"
        )
        return CameraKind.PERSPECTIVE, (0.0,) * 8
    values = tuple(_values(owner, data, kind, aspect))
    return kind, values + (0.0,) * (8 - len(values))


def _values(owner, data, kind, aspect):
    if kind == CameraKind.EQUIRECTANGULAR:
        return owner.latitude_min, owner.latitude_max, owner.longitude_min, owner.longitude_max
    if kind == CameraKind.FISHEYE_EQUIDISTANT:
        return (owner.fisheye_fov,)
    if kind == CameraKind.FISHEYE_EQUISOLID:
        return owner.fisheye_lens, owner.fisheye_fov, *_sensor(data, aspect)
    if kind == CameraKind.FISHEYE_POLYNOMIAL:
        return owner.fisheye_fov, *_sensor(data, aspect), *(getattr(owner, f"fisheye_polynomial_k{i}") for i in range(5))
    if kind == CameraKind.CYLINDRICAL:
        sides = ("u_min", "u_max", "v_min", "v_max")
        ranges = (getattr(owner, f"central_cylindrical_range_{side}") for side in sides)
        return *ranges, owner.central_cylindrical_radius
    return ()


def _sensor(data, aspect):
    """Return width and height in millimetres of the part of the sensor that the image covers."""
    fit = data.sensor_fit
    size = data.sensor_height if fit == "VERTICAL" else data.sensor_width
    if fit == "HORIZONTAL" or (fit == "AUTO" and aspect > 1.0):
        return size, size / aspect
    return size * aspect, size
