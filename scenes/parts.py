"""Building blocks of scenes: meshes, materials, lights, camera and world, identical in Blender 3.4 to 5.2."""

import math

import bmesh
import bpy
import numpy as np
from mathutils import Matrix, Vector

# Principled's sockets by their names since 4.0, with their names in 3.x.
OLD_SOCKETS = {
    "Specular IOR Level": "Specular",
    "Transmission Weight": "Transmission",
    "Coat Weight": "Clearcoat",
    "Coat Roughness": "Clearcoat Roughness",
    "Sheen Weight": "Sheen",
    "Emission Color": "Emission",
}


# ---- meshes ----------------------------------------------------------------------------------------------------------


def mesh_from_bmesh(name, make, smooth):
    """Returns a mesh of the geometry that make(bm) adds to an empty bmesh."""
    bm = bmesh.new()
    make(bm)
    mesh = bpy.data.meshes.new(name)
    bm.to_mesh(mesh)
    bm.free()
    mesh.polygons.foreach_set("use_smooth", np.full(len(mesh.polygons), smooth))
    return mesh


def mesh_from_points(name, points, faces):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(points, [], faces)
    return mesh


def sphere_mesh(name, segments=64, rings=32, radius=1.0):
    def make(bm):
        bmesh.ops.create_uvsphere(bm, u_segments=segments, v_segments=rings, radius=radius)

    return mesh_from_bmesh(name, make, smooth=True)


def cube_mesh(name, size=2.0):
    return mesh_from_bmesh(name, lambda bm: bmesh.ops.create_cube(bm, size=size), smooth=False)


def plane_mesh(name, size=2.0):
    return mesh_from_bmesh(name, lambda bm: bmesh.ops.create_grid(bm, x_segments=1, y_segments=1, size=size / 2), smooth=False)


def cone_mesh(name, bottom=1.0, top=0.0, height=2.0, segments=64):
    """A closed cone, or a cylinder where top equals bottom, around the z axis."""

    def make(bm):
        bmesh.ops.create_cone(bm, cap_ends=True, segments=segments, radius1=bottom, radius2=top, depth=height)

    return mesh_from_bmesh(name, make, smooth=False)


def monkey_mesh(name, subdivisions):
    """Returns Blender's monkey; every face becomes 4 ** subdivisions quads of the Catmull-Clark surface."""
    mesh = mesh_from_bmesh(name, bmesh.ops.create_monkey, smooth=True)
    if not subdivisions:
        return mesh
    # Let the modifier subdivide a temporary object, and keep the evaluated mesh.
    owner = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(owner)
    modifier = owner.modifiers.new("Subdivision", "SUBSURF")
    modifier.levels = modifier.render_levels = subdivisions
    result = bpy.data.meshes.new_from_object(owner.evaluated_get(bpy.context.evaluated_depsgraph_get()))
    bpy.data.objects.remove(owner)
    bpy.data.meshes.remove(mesh)
    result.name = name
    return result


def torus_mesh(name, major=1.0, minor=0.3, major_segments=128, minor_segments=64):
    u, v = np.meshgrid(
        np.arange(major_segments) * (2 * math.pi / major_segments),
        np.arange(minor_segments) * (2 * math.pi / minor_segments),
        indexing="ij",
    )
    ring = major + minor * np.cos(v)
    points = np.stack([ring * np.cos(u), ring * np.sin(u), minor * np.sin(v)], axis=-1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(major_segments), np.arange(minor_segments), indexing="ij")
    next_i, next_j = (i + 1) % major_segments, (j + 1) % minor_segments
    corners = [(i, j), (next_i, j), (next_i, next_j), (i, next_j)]
    faces = np.stack([a * minor_segments + b for a, b in corners], axis=-1).reshape(-1, 4)
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(points.tolist(), [], faces.tolist())
    mesh.polygons.foreach_set("use_smooth", np.full(len(mesh.polygons), True))
    return mesh


def lathe_mesh(name, profile, segments=96):
    """Returns the points (radius, height) of profile rotated around the z axis, smooth; UVs run around and along."""
    turns = np.arange(segments + 1) * (2 * math.pi / segments)
    radii, heights = np.array(profile, float).T
    ring = np.stack([np.cos(turns[:-1]), np.sin(turns[:-1])], axis=-1)
    points = np.concatenate(
        [radii[:, None, None] * ring, np.broadcast_to(heights[:, None, None], (len(radii), segments, 1))], -1
    )
    i, j = np.meshgrid(np.arange(len(radii) - 1), np.arange(segments), indexing="ij")
    after = (j + 1) % segments
    faces = np.stack([i * segments + j, i * segments + after, (i + 1) * segments + after, (i + 1) * segments + j], axis=-1)
    mesh = mesh_from_points(name, points.reshape(-1, 3).tolist(), faces.reshape(-1, 4).tolist())
    mesh.polygons.foreach_set("use_smooth", np.full(len(mesh.polygons), True))
    u, v = turns / (2 * math.pi), np.arange(len(radii)) / (len(radii) - 1)
    uvs = [
        [(u[b], v[a]), (u[b + 1], v[a]), (u[b + 1], v[a + 1]), (u[b], v[a + 1])] for a, b in zip(i.flat, j.flat, strict=True)
    ]
    mesh.uv_layers.new(name="UVMap").data.foreach_set("uv", np.array(uvs, np.float32).ravel())
    return _joined_at_poles(mesh)


def _joined_at_poles(mesh):
    """Returns the mesh without the degenerate faces of rings with radius 0."""
    bm = bmesh.new()
    bm.from_mesh(mesh)
    bmesh.ops.remove_doubles(bm, verts=bm.verts, dist=1e-6)
    bm.to_mesh(mesh)
    bm.free()
    return mesh


# ---- objects ---------------------------------------------------------------------------------------------------------


def place(scene, name, mesh, material=None, location=(0, 0, 0), scale=(1, 1, 1), rotation=(0, 0, 0), shape="MESH"):
    """Adds an object. shape: the exact surface that Lancer traces instead of the mesh; other engines render the mesh."""
    thing = bpy.data.objects.new(name, mesh)
    thing.location = location
    thing.scale = (scale,) * 3 if isinstance(scale, (int, float)) else scale
    thing.rotation_euler = rotation
    scene.collection.objects.link(thing)
    if material is not None:
        if not mesh.materials:
            mesh.materials.append(None)
        # Objects share meshes but not materials, so the slot belongs to the object.
        thing.material_slots[0].link = "OBJECT"
        thing.material_slots[0].material = material
    if hasattr(thing, "lancer"):
        thing.lancer.shape = shape
    return thing


def aim(thing, location, target):
    """Moves a camera or light to location and turns it towards target."""
    direction = Vector(target) - Vector(location)
    thing.matrix_world = Matrix.Translation(location) @ direction.to_track_quat("-Z", "Y").to_matrix().to_4x4()


def add_light(scene, name, kind, energy, location, target=(0, 0, 0), color=(1, 1, 1), **settings):
    light = bpy.data.lights.new(name, kind)
    light.energy = energy
    light.color = color
    for key, value in settings.items():
        setattr(light, key, value)
    thing = bpy.data.objects.new(name, light)
    scene.collection.objects.link(thing)
    aim(thing, location, target)
    return thing


def add_camera(scene, location, target, lens=50.0, fstop=None, focus=None):
    """Adds the scene's camera; with fstop, a thin lens focused at the point focus (default: target)."""
    camera = bpy.data.cameras.new("Camera")
    camera.lens = lens
    thing = bpy.data.objects.new("Camera", camera)
    scene.collection.objects.link(thing)
    aim(thing, location, target)
    if fstop is not None:
        camera.dof.use_dof = True
        camera.dof.aperture_fstop = fstop
        # The focal plane is perpendicular to the view, so the distance is measured along the camera's axis.
        axis = (Vector(target) - Vector(location)).normalized()
        camera.dof.focus_distance = (Vector(focus or target) - Vector(location)).dot(axis)
    scene.camera = thing
    return thing


# ---- materials and world ---------------------------------------------------------------------------------------------


def enable_nodes(owner):
    """Returns an empty node tree; since 5.0 a tree always exists, and use_nodes is deprecated."""
    if bpy.app.version < (5, 0, 0):
        owner.use_nodes = True
    owner.node_tree.nodes.clear()
    return owner.node_tree


def principled(name, **inputs):
    """Returns a Principled material; inputs by socket name with underscores: base_color, roughness, transmission_weight ..."""
    material = bpy.data.materials.new(name)
    tree = enable_nodes(material)
    node = tree.nodes.new("ShaderNodeBsdfPrincipled")
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(node.outputs["BSDF"], output.inputs["Surface"])
    sockets = {socket.name.lower(): socket for socket in node.inputs if socket.enabled}
    for old_key in OLD_SOCKETS:
        if OLD_SOCKETS[old_key].lower() in sockets:
            sockets.setdefault(old_key.lower(), sockets[OLD_SOCKETS[old_key].lower()])
    for key, value in inputs.items():
        socket = sockets[key.replace("_", " ").lower()]
        if socket.type == "RGBA" and len(value) == 3:
            value = (*value, 1.0)
        socket.default_value = value
    if "base_color" in inputs:
        material.diffuse_color = (*inputs["base_color"][:3], 1.0)
    return material


def course_material(name, kd, ks, roughness, ior, **settings):
    """Returns a material of the course's Kd, Ks model: exact in Lancer, a similar Principled elsewhere."""
    material = principled(name, base_color=kd, roughness=math.sqrt(roughness), ior=ior)
    if hasattr(material, "lancer"):
        material.lancer.model = "KD_KS"
        for key, value in {"kd": kd, "ks": ks, "roughness": roughness, "ior": ior, **settings}.items():
            setattr(material.lancer, key, value)
    return material


def set_world(scene, color, strength=1.0):
    world = bpy.data.worlds.new("World")
    tree = enable_nodes(world)
    background = tree.nodes.new("ShaderNodeBackground")
    output = tree.nodes.new("ShaderNodeOutputWorld")
    tree.links.new(background.outputs["Background"], output.inputs["Surface"])
    background.inputs["Color"].default_value = (*color, 1.0)
    background.inputs["Strength"].default_value = strength
    scene.world = world


def set_size(scene, width, height, samples):
    scene.render.resolution_x = width
    scene.render.resolution_y = height
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "PNG"
    if hasattr(scene, "lancer"):
        scene.lancer.quality, scene.lancer.samples, scene.lancer.target_error = "CUSTOM", samples, 0.0
        scene.lancer.use_denoising = False


def add_passes(scene):
    """Adds Normal and Z, the most common passes for compositing."""
    scene.view_layers[0].use_pass_normal = scene.view_layers[0].use_pass_z = True


def set_look(scene, *names):
    """Sets the first look that this Blender has; the names of looks depend on the view transform of the release."""
    for name in names:
        try:
            scene.view_settings.look = name
            return
        except TypeError:
            continue
