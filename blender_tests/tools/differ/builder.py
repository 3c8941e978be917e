"""build(scene, records): the records as a Blender scene, in any Blender. What is missing is left out."""

import contextlib

import bpy
from mathutils import Matrix

from scenes import parts
from scenes.parity import subdivisions

from . import (
    build_bakes,
    build_images,
    build_limits,
    build_links,
    build_meshes,
    build_motion,
    build_nodes,
    build_outputs,
    build_photometry,
    build_views,
)

_MODIFIER_SHAPES = {"MESH"}


class Builder:
    def __init__(self, scene):
        self.scene = scene
        self.things = {}  # by the record's name
        self.trees = {}
        self.bake = None  # in place of a picture
        self._views = None

    def find(self, name):
        return None if name is None else self.things.get(name.removeprefix("@"))

    def build(self, records):
        for record in records:
            getattr(self, f"_{record.verb}")(record.name, record.fields)
        if self.scene.camera is None:
            parts.add_camera(self.scene, (0, -5, 2), (0, 0, 0.9))
        if self._views is not None:
            build_views.build_views(self.scene, self._views)

    # ---- data ----

    def _frame(self, name, fields):
        if "mattes" in fields:
            build_outputs.ask_for_mattes(fields["mattes"], fields.get("matte_levels", 6))

    def _image(self, name, fields):
        self.things[name] = build_images.build_image(name, fields)
        if build_images.is_cached(fields):
            self.scene.render.use_texture_cache = self.scene.render.use_auto_generate_texture_cache = True

    def _photometry(self, name, fields):
        self.things[name] = build_photometry.build_photometry(name, fields)

    def _material(self, name, fields):
        material = self.things[name] = bpy.data.materials.new(name)
        self.trees[name] = parts.enable_nodes(material)
        material.pass_index = fields.get("pass_index", 0)
        if "displacement" in fields:
            _set_any((material, material.cycles), "displacement_method", fields["displacement"])
        if fields.get("opaque_shadows"):
            _set_any((material, material.cycles), "use_transparent_shadow", False)
        if "emission_sampling" in fields:
            if hasattr(material.cycles, "emission_sampling"):
                material.cycles.emission_sampling = fields["emission_sampling"]
            else:
                material.cycles.sample_as_light = fields["emission_sampling"] != "NONE"
        if fields.get("no_bump_correction") and hasattr(material.cycles, "use_bump_map_correction"):
            material.cycles.use_bump_map_correction = False

    def _world(self, name, fields):
        world = self.things[name] = bpy.data.worlds.new(name)
        if not fields.get("apart"):
            self.scene.world = world
        self.trees[name] = parts.enable_nodes(world)
        # A finer map of where the sky is bright takes longer than all renders of such a scene.
        world.cycles.sampling_method, world.cycles.sample_map_resolution = "MANUAL", fields.get("map_resolution", 64)
        for ray in fields.get("hidden_from", ()):
            setattr(world.cycles_visibility, ray, False)
        if "max_bounces" in fields:
            world.cycles.max_bounces = fields["max_bounces"]
        for setting, value in fields.get("mist", {}).items():
            setattr(world.mist_settings, setting, value)
        if "occlusion_distance" in fields:
            world.light_settings.distance = fields["occlusion_distance"]

    def _mesh(self, name, fields):
        self.things[name] = build_meshes.build_mesh(name, fields, self.find)

    def _attribute(self, name, fields):
        mesh = self.find(fields["mesh"])
        if mesh is not None:
            build_meshes.build_attribute(mesh, name, fields)

    def _curve(self, name, fields):
        curve = self._with_materials(bpy.data.curves.new(name, "CURVE"), name, fields)
        curve.dimensions, curve.bevel_depth, curve.resolution_u = "3D", 0.15, 4
        spline = curve.splines.new("BEZIER")
        spline.bezier_points.add(2)
        for point, co in zip(spline.bezier_points, ((-0.8, 0, 0), (0, 0.5, 0.6), (0.8, 0, -0.2)), strict=True):
            point.co, point.handle_left_type, point.handle_right_type = co, "AUTO", "AUTO"

    def _text(self, name, fields):
        text = self._with_materials(bpy.data.curves.new(name, "FONT"), name, fields)
        text.body, text.extrude, text.align_x, text.size = "Ab", 0.15, "CENTER", 1.3

    def _metaball(self, name, fields):
        ball = self._with_materials(bpy.data.metaballs.new(name), name, fields)
        ball.render_resolution = ball.resolution = 0.3
        for x in (-0.4, 0.4):
            element = ball.elements.new()
            element.co, element.radius = (x, 0.0, 0.0), 0.9

    def _surface(self, name, fields):
        surface = self._with_materials(bpy.data.curves.new(name, "SURFACE"), name, fields)
        surface.dimensions = "3D"
        for row in range(4):
            spline = surface.splines.new("NURBS")
            spline.points.add(3)
            for column, point in enumerate(spline.points):
                point.co = (0.5 * (column - 1.5), 0.5 * (row - 1.5), 0.3 * ((row * column) % 3), 1.0)
                point.select = True
        maker = bpy.data.objects.new(name, surface)
        self.scene.collection.objects.link(maker)
        bpy.context.view_layer.objects.active = maker
        # Only the editor makes one surface of rows of points.
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.curve.make_segment()
        bpy.ops.object.mode_set(mode="OBJECT")
        surface.splines[0].order_u = surface.splines[0].order_v = 4
        surface.splines[0].use_endpoint_u = surface.splines[0].use_endpoint_v = True
        surface.splines[0].resolution_u = surface.splines[0].resolution_v = 3
        bpy.data.objects.remove(maker)

    def _with_materials(self, data, name, fields):
        for material in fields.get("materials", ()):
            data.materials.append(self.find(material))
        self.things[name] = data
        return data

    def _lamp(self, name, fields):
        lamp = self.things[name] = bpy.data.lights.new(name, fields["type"])
        for setting, value in fields.get("settings", {}).items():
            if hasattr(lamp, setting):
                setattr(lamp, setting, value)
        if fields.get("no_shadow"):
            if bpy.app.version >= (4, 2):
                lamp.use_shadow = False
            else:
                lamp.cycles.cast_shadow = False
        if "max_bounces" in fields:
            lamp.cycles.max_bounces = fields["max_bounces"]
        if fields.get("portal"):
            lamp.cycles.is_portal = True
        if fields.get("nodes"):
            if bpy.app.version < (5, 2):
                lamp.use_nodes = True
            self.trees[name] = parts.enable_nodes(lamp)

    def _camera(self, name, fields):
        camera = self.things[name] = bpy.data.cameras.new(name)
        for owner, key in ((camera, "settings"), (camera.dof, "dof")):
            for setting, value in fields.get(key, {}).items():
                setattr(owner, setting, self.find(value) if setting == "focus_object" else value)
        for setting, value in fields.get("panorama", {}).items():
            # Versions lack some kinds of panoramas and their settings.
            with contextlib.suppress(AttributeError, TypeError):
                setattr(camera if hasattr(camera, setting) else camera.cycles, setting, value)

    # ---- objects ----

    def _object(self, name, fields):
        data = self.find(fields.get("data"))
        if data is None and "data" in fields:
            return
        thing = self.things[name] = bpy.data.objects.new(name, data)
        self.scene.collection.objects.link(thing)
        if "target" in fields:
            parts.aim(thing, fields["location"], fields["target"])
        else:
            thing.location, thing.rotation_euler = fields.get("location", (0, 0, 0)), fields.get("rotation", (0, 0, 0))
        # Embree in Debian's Blender 3 aborts in instances that are flat.
        thinnest = 0.1 if bpy.app.version < (4, 0) else 0.0
        thing.scale = [side or thinnest for side in fields.get("scale", (1, 1, 1))]
        for setting, value in fields.get("settings", {}).items():
            setattr(thing, setting, value)
        if "material" in fields and len(thing.material_slots):
            thing.material_slots[0].link = "OBJECT"
            thing.material_slots[0].material = self.find(fields["material"])
        if "exact" in fields:
            thing.lancer.shape = fields["exact"]
        if "terminator" in fields:
            _set_any((thing, thing.cycles), "shadow_terminator_geometry_offset", fields["terminator"])
        collection = self.find(fields.get("collection"))
        if collection is not None:
            thing.instance_type, thing.instance_collection = "COLLECTION", collection
        if "instances" in fields:
            own = fields["instances"]
            thing.instance_type = own["type"]
            thing.show_instancer_for_render = thing.show_instancer_for_viewport = own["shown"]
            thing.use_instance_vertices_rotation = own["use_instance_vertices_rotation"]
            thing.use_instance_faces_scale = own["use_instance_faces_scale"]
        if thing.type == "CAMERA":
            self.scene.camera = thing

    def _parent(self, name, fields):
        child, parent = self.find(name), self.find(fields["parent"])
        if child is None or parent is None:
            return
        child.parent = parent
        if fields.get("inverse"):
            bpy.context.view_layer.update()
            child.matrix_parent_inverse = parent.matrix_world.inverted_safe()
        else:
            child.matrix_parent_inverse = Matrix()

    def _modifier(self, name, fields):
        thing = self.find(fields["object"])
        if thing is None or thing.type not in _MODIFIER_SHAPES:
            return
        modifier = thing.modifiers.new(name, fields["type"])
        for setting, value in fields.get("settings", {}).items():
            setattr(modifier, setting, value)
        if "dicing_rate" in fields:
            subdivisions.dice(self.scene, thing, modifier, fields["dicing_rate"])

    def _collection(self, name, fields):
        collection = self.things[name] = bpy.data.collections.new(name)
        self.scene.collection.children.link(collection)
        for member in fields.get("objects", ()):
            thing = self.find(member)
            if thing is None:
                continue
            collection.objects.link(thing)
            if fields.get("only") and thing.name in self.scene.collection.objects:
                self.scene.collection.objects.unlink(thing)
        switch = fields.get("switch", "none")
        if switch == "hide_render":
            collection.hide_render = True
        elif switch != "none":
            setattr(bpy.context.view_layer.layer_collection.children[collection.name], switch, True)

    def _property(self, name, fields):
        places = {"scene": self.scene, "layer": bpy.context.view_layer, "world": self.scene.world}
        owner = places[fields["owner"]] if fields["owner"] in places else self.find(fields["owner"])
        if owner is not None:
            owner[name] = fields["value"]

    def _motion(self, name, fields):
        owner = self.find(fields["owner"])
        if owner is not None:
            build_motion.build_motion(self.scene, owner, fields)

    # ---- settings ----

    def _shutter(self, name, fields):
        build_motion.build_shutter(self.scene, fields)

    def _film(self, name, fields):
        for setting, value in fields.items():
            setattr(self.scene.render if hasattr(self.scene.render, setting) else self.scene.cycles, setting, value)

    def _bake(self, name, fields):
        thing = self.find(fields.get("object"))
        if thing is not None and thing.type == "MESH":
            self.bake = build_bakes.Bake(self.scene, fields, thing)

    def _eyes(self, name, fields):
        # They need the camera, which any scene has in the end.
        self._views = fields

    def _linking(self, name, fields):
        build_links.build_linking(name, fields, self.find)

    def _fast_gi(self, name, fields):
        build_limits.build_fast_gi(self.scene, fields, self.find)

    def _culling(self, name, fields):
        build_limits.build_culling(self.scene, fields, self.find)

    def _texels(self, name, fields):
        build_limits.build_texels(self.scene, fields)

    def _light_group(self, name, fields):
        self.things[name] = name
        build_outputs.build_light_group(name)

    def _member(self, name, fields):
        owner, group = self.find(fields["owner"]), self.find(fields["group"])
        if owner is not None and group is not None:
            owner.lightgroup = group

    def _aov(self, name, fields):
        build_outputs.build_aov(name, fields)

    def _layer(self, name, fields):
        layer = bpy.context.view_layer
        for setting, value in fields.items():
            if hasattr(layer, setting):
                setattr(layer, setting, self.find(value) if setting.endswith("_override") else value)

    # ---- nodes ----

    def _group(self, name, fields):
        self.things[name] = self.trees[name] = build_nodes.build_group(name, fields)

    def _node(self, name, fields):
        tree = self.trees.get(fields["tree"])
        if tree is not None:
            node = build_nodes.build_node(tree, name, fields, self.find)
            if node is not None:
                self.things[name] = node

    def _link(self, name, fields):
        build_nodes.build_link(fields, self.find)


def _set_any(owners, name, value):
    for owner in owners:
        if hasattr(owner, name):
            setattr(owner, name, value)
            return


def build(scene, records):
    """Return the bake that the records ask for, or None."""
    builder = Builder(scene)
    builder.build(records)
    return builder.bake
