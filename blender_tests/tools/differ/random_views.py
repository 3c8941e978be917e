"""Random stereoscopy: two eyes of the camera in each way to converge, on spheres for panoramas, or a camera for each view."""

from .record import Record

_SHARE = 0.05


def views(dice, records, is_asked=False):
    """The record of the views; none in most scenes, and where data of single samples are compared, or bakes."""
    frame = next(record.fields for record in records if record.verb == "frame")
    if any(record.verb == "bake" for record in records):
        return []
    if not is_asked and (not dice.chance(_SHARE) or frame.get("kind") == "DATA"):
        return []
    frame["passes"], frame["bounces"] = ["Combined"], min(1, frame["bounces"])
    frame.pop("mattes", None)
    if frame["kind"] == "DATA":
        frame["kind"] = "LOBES"
    for record in records:
        if record.verb == "film":
            # Blender 5 cannot write two pictures of pixels that are not square.
            for name in ("pixel_aspect_x", "pixel_aspect_y"):
                record.fields.pop(name, None)
    if dice.chance(0.25):
        return [Record("eyes", "Eyes", {"apart": [dice.vector(-0.5, 0.5) for _ in range(dice.whole(1, 2))]})]
    stereo = {
        "interocular_distance": dice.number(0.02, 0.8),
        "convergence_distance": dice.number(1.0, 6.0),
        "convergence_mode": dice.pick(("PARALLEL", "OFFAXIS", "TOE")),
        "pivot": dice.pick(("CENTER", "LEFT", "RIGHT")),
    }
    if dice.chance(0.5):
        stereo["use_spherical_stereo"] = True
        if dice.chance(0.5):
            stereo |= {
                "use_pole_merge": True,
                "pole_merge_angle_from": dice.number(0.2, 1.0),
                "pole_merge_angle_to": dice.number(1.0, 1.5),
            }
    return [Record("eyes", "Eyes", {"stereo": stereo})]
