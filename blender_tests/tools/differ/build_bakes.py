"""Records of bakes: what is baked into which image or colour attribute, and the bake by one of the engines."""

import bpy
import numpy as np

from scenes import parts
from tools.parity import engines

from . import build_meshes

# Cycles sums the places of its samples.
_OF_ONE_SAMPLE = ("POSITION",)


class Bake:
    """A bake that is ready: render() is as engines.render."""

    def __init__(self, scene, fields, thing):
        self._scene, self._fields = scene, fields
        self._sources, self._target, self._cage = [], thing, None
        onto = fields.get("onto")
        if onto is not None:
            self._sources, self._target = [thing], _copy(scene, thing, "Bake target", onto.get("scale", 1.1))
            if "cage" in onto:
                self._cage = _copy(scene, thing, "Bake cage", onto["cage"])
                self._cage.hide_render = True
        mesh = self._target.data
        if not mesh.uv_layers:
            build_meshes.add_uvs(mesh, "UVMap", 0)
        self._attribute = fields.get("attribute")
        if self._attribute is not None:
            mesh.color_attributes.active_color = mesh.color_attributes.new("Baked", "FLOAT_COLOR", self._attribute)
        self._image = bpy.data.images.new("Baked", *fields.get("size", (32, 32)), alpha=True, float_buffer=True)
        self._image.colorspace_settings.name = "Non-Color"
        _show_in_all_slots(self._target, self._image)

    def render(self, scene, engine, case, samples, seed, folder):
        """Return {"Combined": the texels, "Alpha"}, of an attribute one below the other."""
        scene.render.engine = engine
        engines.unbias(scene, case, 1 if self._kind in _OF_ONE_SAMPLE else samples, seed)
        self._choose()
        self._image.pixels.foreach_set(np.zeros(len(self._image.pixels), np.float32))
        bpy.ops.object.bake(**self._options())
        texels = self._texels()
        return {"Alpha": texels[..., 3:], "Combined": texels[..., :3]}

    @property
    def _kind(self):
        return self._fields.get("type", "COMBINED")

    def _options(self):
        fields, onto = self._fields, self._fields.get("onto")
        options = {"type": self._kind, "margin": 0, "use_clear": True}
        if "filters" in fields:
            options["pass_filter"] = set(fields["filters"])
        if "space" in fields:
            options["normal_space"] = fields["space"]
        for name, axis in zip("rgb", fields.get("axes", ()), strict=False):
            options[f"normal_{name}"] = axis
        self._scene.render.bake.view_from = fields.get("view_from", "ABOVE_SURFACE")
        if onto is not None:
            options |= {
                "use_selected_to_active": True,
                "cage_extrusion": onto.get("extrusion", 0.1),
                "max_ray_distance": onto.get("distance", 0.0),
            }
        if self._cage is not None:
            options |= {"use_cage": True, "cage_object": self._cage.name}
        if self._attribute is not None:
            options["target"] = "VERTEX_COLORS"
        return options

    def _choose(self):
        bpy.ops.object.select_all(action="DESELECT")
        for thing in (*self._sources, self._target):
            thing.select_set(True)
        bpy.context.view_layer.objects.active = self._target

    def _texels(self):
        if self._attribute is None:
            values = np.empty(len(self._image.pixels), np.float32)
            self._image.pixels.foreach_get(values)
            return values.reshape(self._image.size[1], self._image.size[0], 4)
        data = self._target.data.color_attributes["Baked"].data
        values = np.empty(4 * len(data), np.float32)
        data.foreach_get("color", values)
        return values.reshape(len(data), 1, 4)


def _copy(scene, thing, name, scale):
    """Return a copy of an object's own mesh, larger than it, at its place."""
    copy = bpy.data.objects.new(name, thing.data.copy())
    scene.collection.objects.link(copy)
    bpy.context.view_layer.update()
    copy.matrix_world = thing.matrix_world.copy()
    copy.scale = [side * scale for side in copy.scale]
    copy.data.materials.clear()
    copy.data.materials.append(parts.principled(name))
    copy.visible_shadow = copy.visible_diffuse = False
    return copy


def _show_in_all_slots(thing, image):
    """Let each slot have a material whose active node shows the image."""
    if not thing.material_slots:
        thing.data.materials.append(None)
    for slot in thing.material_slots:
        if slot.material is None:
            slot.material = parts.principled("Baked")
        tree = slot.material.node_tree
        node = tree.nodes.new("ShaderNodeTexImage")
        node.image = image
        tree.nodes.active = node
