"""Random cameras, films, layers and passes."""

import math

from .record import Record

_LIGHT_PASSES = (
    "Diffuse Direct", "Diffuse Indirect", "Diffuse Color", "Glossy Direct", "Glossy Indirect", "Glossy Color",
    "Transmission Direct", "Transmission Indirect", "Transmission Color", "Emission", "Environment", "Ambient Occlusion",
    "Mist", "Denoising Albedo", "Denoising Normal", "Denoising Depth",
)  # fmt: skip
_DATA_PASSES = ("Depth", "Position", "Normal", "Vector", "UV", "Object Index", "Material Index")
_PANORAMAS = (
    "EQUIRECTANGULAR", "FISHEYE_EQUIDISTANT", "FISHEYE_EQUISOLID", "FISHEYE_LENS_POLYNOMIAL", "MIRRORBALL",
    "CENTRAL_CYLINDRICAL",
)  # fmt: skip


def frame(dice):
    """How the scene is looked at: (fields of the settings record, other records)."""
    film, layer = {}, {}
    frame = {
        "size": [48, 32],
        "bounces": dice.pick({0: 4, 1: 5, 2: 1, 3: 0.3}),
        "transparent_bounces": dice.pick((8, 8, 8, 1, 0)),
    }
    is_data = dice.chance(0.15)
    if is_data:
        frame |= {"kind": "DATA", "passes": dice.some(_DATA_PASSES, 0.5) or ["Normal"]}
    else:
        frame["passes"] = ["Combined", *(dice.some(_LIGHT_PASSES, 0.4) if dice.chance(0.3) else ())]
        if len(frame["passes"]) > 1 and dice.chance(0.7):
            # Passes of light after many bounces are much noisier than their sum.
            frame["bounces"] = min(1, frame["bounces"])
        if any(name.startswith("Denoising") for name in frame["passes"]):
            # Without bounces Cycles weighs what clear surfaces add to the guides otherwise: its paths always pass them.
            frame["bounces"] = max(1, frame["bounces"])
        if dice.chance(0.2):
            frame["filter_width"] = dice.number(0.8, 2.0)
    if dice.chance(0.2):
        film["film_transparent"] = True
        if dice.chance(0.3):
            film |= {"film_transparent_glass": True, "film_transparent_roughness": dice.number(0.0, 0.6)}
    # Blender 5 cannot write two passes of pixels that are not square.
    if dice.chance(0.06) and len(frame["passes"]) == 1:
        film[dice.pick(("pixel_aspect_x", "pixel_aspect_y"))] = 1.5
    if dice.chance(0.06):
        film |= {"use_border": True, "border_min_x": 0.1, "border_max_x": 0.8, "border_min_y": 0.2, "border_max_y": 0.9}
    if dice.chance(0.04):
        layer["material_override"] = "@Material 1"
    if dice.chance(0.04):
        layer["use_sky"] = False
    if dice.chance(0.03):
        layer["use_solid"] = False
    if dice.chance(0.03):
        layer["world_override"] = "@Other world"
    if is_data and dice.chance(0.1):
        layer["pass_alpha_threshold"] = dice.number(0.0, 1.0)
    return frame, [Record("film", "Film", film), Record("layer", "Layer", layer), *_camera(dice, is_data)]


def _camera(dice, is_data):
    turn, height = dice.number(-0.9, 0.9), dice.number(0.5, 3.5)
    location = [round(5 * math.sin(turn), 3), round(-5 * math.cos(turn), 3), height]
    settings, lens = {"lens": dice.number(35.0, 60.0)}, {}
    kind = dice.pick({"PERSP": 8, "ORTHO": 1, "PANO": 1})
    if kind != "PERSP":
        settings |= {"type": kind, "ortho_scale": dice.number(3.0, 6.0)}
    if dice.chance(0.15):
        settings |= {"shift_x": dice.number(-0.2, 0.2), "shift_y": dice.number(-0.2, 0.2)}
    if dice.chance(0.1):
        settings |= {"clip_start": dice.number(0.1, 4.5), "clip_end": dice.number(5.0, 9.0)}
    if dice.chance(0.1):
        settings |= {
            "sensor_fit": dice.pick(("HORIZONTAL", "VERTICAL")),
            "sensor_width": dice.number(25.0, 40.0),
            "sensor_height": dice.number(18.0, 40.0),
        }
    fields = {"settings": settings}
    if not is_data and dice.chance(0.1):
        lens = {"use_dof": True, "focus_distance": dice.number(3.0, 6.0), "aperture_fstop": dice.number(0.6, 4.0)}
        if dice.chance(0.2):
            lens["focus_object"] = "@Thing 1"
        if dice.chance(0.5):
            lens |= {
                "aperture_blades": dice.whole(3, 6),
                "aperture_rotation": dice.number(0, 2),
                "aperture_ratio": dice.number(0.7, 1.5),
            }
        fields["dof"] = lens
    if kind == "PANO":
        fields["panorama"] = _panorama(dice)
        location = [round(x / 2, 3) for x in location]
    place = {"data": "@Camera", "location": location, "target": [dice.number(-0.3, 0.3), 0.0, dice.number(0.7, 1.1)]}
    if dice.chance(0.08):
        place["scale"] = [dice.number(0.5, 2.0)] * 3
        if dice.chance(0.4):
            place["scale"][dice.whole(0, 2)] *= -1
    records = [Record("camera", "Camera", fields), Record("object", "Camera object", place)]
    if dice.chance(0.05):
        rig = {"location": dice.vector(-0.2, 0.2), "rotation": dice.vector(-0.2, 0.2), "scale": [dice.number(0.8, 1.2)] * 3}
        records += [Record("object", "Rig", rig), Record("parent", "Camera object", {"parent": "@Rig"})]
    return records


def _panorama(dice):
    """What each kind of panorama reads; a Blender leaves out what it lacks."""
    fields = {
        "panorama_type": dice.pick(_PANORAMAS),
        "fisheye_fov": dice.number(1.0, 3.0),
        "fisheye_lens": dice.number(8.0, 20.0),
    }
    if dice.chance(0.5):
        fields |= {f"{name}_min": dice.number(-1.4, -0.3) for name in ("latitude", "longitude")}
        fields |= {f"{name}_max": dice.number(0.3, 1.4) for name in ("latitude", "longitude")}
    if dice.chance(0.5):
        fields |= {
            "central_cylindrical_range_u_min": dice.number(-2.0, -0.5),
            "central_cylindrical_range_u_max": dice.number(0.5, 2.0),
            "central_cylindrical_range_v_min": dice.number(-1.0, -0.4),
            "central_cylindrical_range_v_max": dice.number(0.4, 1.5),
            "central_cylindrical_radius": dice.number(0.5, 2.0),
        }
    if dice.chance(0.5):
        fields |= {"fisheye_polynomial_k1": dice.number(-0.06, -0.02), "fisheye_polynomial_k2": dice.number(-2e-3, 2e-3)}
    return fields
