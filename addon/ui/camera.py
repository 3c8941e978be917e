"""The Data tab of a camera: settings of panoramas, which Blender's own panel shows only for Cycles."""

import bpy

from .panel import LancerPanel

# (name, label) of the settings of each projection, grouped as in the panel.
_SHAPES = {
    "EQUIRECTANGULAR": (
        (("latitude_min", "Latitude Min"), ("latitude_max", "Max")),
        (("longitude_min", "Longitude Min"), ("longitude_max", "Max")),
    ),
    "FISHEYE_EQUIDISTANT": ((("fisheye_fov", None),),),
    "FISHEYE_EQUISOLID": ((("fisheye_lens", "Lens"), ("fisheye_fov", None)),),
    "FISHEYE_LENS_POLYNOMIAL": (
        (("fisheye_fov", None),),
        tuple((f"fisheye_polynomial_k{power}", f"K{power}") for power in range(5)),
    ),
    "CENTRAL_CYLINDRICAL": (
        (("central_cylindrical_range_v_min", "Height Min"), ("central_cylindrical_range_v_max", "Max")),
        (("central_cylindrical_range_u_min", "Longitude Min"), ("central_cylindrical_range_u_max", "Max")),
        (("central_cylindrical_radius", "Cylinder Radius"),),
    ),
}


class LANCER_DATA_PT_panorama(LancerPanel, bpy.types.Panel):
    bl_label = "Panorama"
    bl_context = "data"
    bl_parent_id = "DATA_PT_lens"

    @classmethod
    def poll(cls, context):
        return super().poll(context) and context.camera is not None and context.camera.type == "PANO"

    def draw(self, context):
        # Before 4.2 the properties belong to the Cycles add-on, which may be disabled.
        camera = context.camera
        owner = camera if hasattr(camera, "panorama_type") else getattr(camera, "cycles", None)
        column = self._column(animated=True)
        if owner is None:
            column.label(text="Enable the add-on Cycles Render Engine", icon="ERROR")
            return
        column.prop(owner, "panorama_type", text="Type")
        for group in _SHAPES.get(owner.panorama_type, ()):
            part = column.column(align=True)
            for name, label in group:
                part.prop(owner, name, text=label)


CLASSES = (LANCER_DATA_PT_panorama,)
