"""Objects that Cycles divides adaptively, as they are exported, and what the export leaves behind."""

import os
import resource
import tempfile

import bpy
import numpy as np
import stage
from export_cases import export_told

from addon.bindings.enums import CameraKind
from addon.bindings.snapshot import Camera
from addon.export.parts import Parts
from addon.export.scene import ExportOptions, export_scene
from addon.export.subdivision import divided


def _adaptive(scene, thing, rate, kind="CATMULL_CLARK"):
    """Give an object a Subdivision modifier of one level that Cycles replaces."""
    modifier = thing.modifiers.new("Round", "SUBSURF")
    modifier.levels = modifier.render_levels = 1
    modifier.subdivision_type = kind
    if hasattr(modifier, "use_adaptive_subdivision"):
        modifier.use_adaptive_subdivision, modifier.adaptive_pixel_size = True, rate
    else:
        scene.cycles.feature_set, thing.cycles.use_adaptive_subdivision, thing.cycles.dicing_rate = "EXPERIMENTAL", True, rate
    return modifier


def _exported():
    snapshot, messages = export_told()
    mesh = snapshot.meshes[0]
    return {"triangles": len(mesh.triangles), "meshes": len(snapshot.meshes), "told": messages.lines()}


def _kept():
    """Return what an export must leave as it is."""
    modifiers = [(m.name, m.show_render, m.show_viewport) for item in bpy.data.objects for m in item.modifiers]
    return [len(bpy.data.meshes), len(bpy.data.objects), modifiers]


def _quads(scene):
    thing = stage.plane(2.0)
    thing.modifiers.new("Row", "ARRAY").count = 2
    return thing, _adaptive(scene, thing, 2.6, "SIMPLE")


def objects():
    """Return what the export makes of a row of two squares in several states."""
    result = {"version": bpy.app.version[:2]}
    scene = stage.empty(width=80, height=60)
    stage.camera((0, 0, 5), (0, 0, 0), type="ORTHO", ortho_scale=8.0)
    thing, modifier = _quads(scene)
    before = _kept()
    result["divided"] = _exported()
    result["kept"] = _kept() == before
    modifier.show_render = False
    result["off"] = _exported()
    modifier.show_render = True
    last = thing.modifiers.new("Last", "SMOOTH")
    result["not last"] = _exported()
    thing.modifiers.remove(last)
    scene.cycles.max_subdivisions = 1
    result["levels"] = _exported()
    scene.cycles.max_subdivisions = 12
    scene.cycles.dicing_rate = 2.0
    result["coarser"] = _exported()
    copy = stage.link("Copy", None, (0, 2, 0))
    group = bpy.data.collections.new("Group")
    group.objects.link(thing)
    copy.instance_type, copy.instance_collection = "COLLECTION", group
    result["instances"] = _exported()
    return result


def layers():
    """Return attributes of a divided square with flat and smooth faces, slots, colours and a UV map."""
    scene = stage.empty(width=64, height=64)
    stage.camera((0, 0, 5), (0, 0, 0), type="ORTHO", ortho_scale=4.0)
    thing = stage.mesh(
        "Two", [(-1, -1, 0), (0, -1, 0), (1, -1, 0), (1, 1, 0), (0, 1, 0), (-1, 1, 0)], [(0, 1, 4, 5), (1, 2, 3, 4)]
    )
    data = thing.data
    for name in ("One", "Other"):
        data.materials.append(stage.shader(name=name))
    data.polygons.foreach_set("material_index", [0, 1])
    data.polygons.foreach_set("use_smooth", [True, False])
    places = np.array([data.vertices[loop.vertex_index].co[:2] for loop in data.loops])
    data.uv_layers.new(name="UVMap").data.foreach_set("uv", (0.5 + 0.5 * places).astype(np.float32).ravel())
    colors = data.color_attributes.new("Color", "FLOAT_COLOR", "CORNER")
    colors.data.foreach_set("color", np.column_stack([places, np.zeros(8), np.ones(8)]).astype(np.float32).ravel())
    _adaptive(scene, thing, 1.0, "SIMPLE")
    mesh = export_told()[0].meshes[0]
    corners = mesh.positions[mesh.triangles]
    right = corners.mean(axis=1)[:, 0] > 0.0
    return {
        "triangles": len(mesh.triangles),
        "uv error": float(np.abs(mesh.uvs - (0.5 + 0.5 * corners[..., :2])).max()),
        "color error": float(np.abs(mesh.colors[..., :2] - corners[..., :2]).max()),
        "slots agree": bool((mesh.material_slots == right).all()),
        "normal error": float(np.abs(mesh.normals - (0.0, 0.0, 1.0)).max()),
        "normals at corners": mesh.normals.ndim == 3,
    }


def limited():
    """Return the error of an export for which there is no memory, and what it leaves."""
    scene = stage.empty(width=800, height=600)
    stage.camera((0, 0, 5), (0, 0, 0))
    _adaptive(scene, stage.cube(2.0), 0.5)
    before, real = _kept(), divided.most_triangles
    divided.most_triangles = lambda corners: 1000 if corners in (24, 96) else 0
    error = ""
    try:
        bpy.ops.render.render()
    except RuntimeError as raised:
        error = str(raised)
    divided.most_triangles = real
    return {"error": error, "kept": _kept() == before}


def linked():
    """Return the triangles of a divided cube, and of the same cube linked from another file."""
    scene = stage.empty(width=80, height=60)
    cube = stage.cube(2.0)
    _adaptive(scene, cube, 8.0)
    counts = [_exported()["triangles"]]
    path = os.path.join(tempfile.mkdtemp(), "cube.blend")
    bpy.data.libraries.write(path, {cube})
    feature_set = getattr(scene.cycles, "feature_set", None)
    scene = stage.empty(width=80, height=60)
    if feature_set is not None:
        scene.cycles.feature_set = feature_set
    with bpy.data.libraries.load(path, link=True) as (there, here):
        here.objects = there.objects
    scene.collection.objects.link(here.objects[0])
    before = _kept()
    # Twice: the first export must leave the modifier on.
    counts += [_exported()["triangles"] for _ in range(2)]
    return {"counts": counts, "kept": _kept()[2] == before[2]}


def undivided():
    """Return the MB by which the process grows while it exports a grid of which its modifier would make millions of faces."""
    scene = stage.empty(width=80, height=60)
    stage.camera((0, 0, 5), (0, 0, 0))
    side = np.arange(101)
    places = np.stack([*np.meshgrid(side / 50.0 - 1.0, side / 50.0 - 1.0), np.zeros((101, 101))], axis=-1).reshape(-1, 3)
    first = (101 * side[:100, None] + side[:100]).reshape(-1)
    faces = np.stack([first, first + 1, first + 102, first + 101], axis=1)
    modifier = _adaptive(scene, stage.mesh("Grid", places.tolist(), faces.tolist()), 100.0)
    modifier.levels = modifier.render_levels = 4 if bpy.app.version >= (4, 5) else 1
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    snapshot, _ = export_told()
    grown = (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) / 1024
    return {"grown": grown, "triangles": len(snapshot.meshes[0].triangles), "version": bpy.app.version[:2]}


def letter():
    """Return the export of a divided letter, the mesh of which Blender makes."""
    scene = stage.empty(width=800, height=600)
    stage.camera((0, 0, 5), (0, 0, 0))
    curve = bpy.data.curves.new("Letter", "FONT")
    curve.body = "I"
    _adaptive(scene, stage.link("Letter", curve), 2.0)
    return {"version": bpy.app.version[:2], **_exported()}


def creased_border():
    """Return how far a square of four creased edges reaches along both x and y, and whether Cycles divides it as it is."""
    scene = stage.empty(width=64, height=64)
    stage.camera((0, 0, 5), (0, 0, 0), type="ORTHO", ortho_scale=4.0)
    thing = stage.plane(2.0)
    if bpy.app.version >= (4, 0):
        thing.data.attributes.new("crease_edge", "FLOAT", "EDGE").data.foreach_set("value", [1.0] * 4)
    else:
        thing.data.edges.foreach_set("crease", [1.0] * 4)
    _adaptive(scene, thing, 4.0)
    positions = export_told()[0].meshes[0].positions
    return float(np.abs(positions[:, :2]).min(axis=1).max()), bpy.app.version >= (4, 5)


def dicing_cameras():
    """Return what the export tells of a dicing camera of no size, without and with an object to divide."""
    scene = stage.empty(width=80, height=60)
    stage.camera((0, 0, 5), (0, 0, 0), type="ORTHO", ortho_scale=8.0)
    own, other = scene.camera, stage.camera((0, 0, 5), (0, 0, 0))
    other.scale = 3 * [0.0]
    scene.camera, scene.cycles.dicing_camera = own, other
    stage.plane(2.0)
    plain = export_told()[1].lines()
    _quads(scene)
    results = [export_told()]
    scene.cycles.dicing_camera = None
    results.append(export_told())
    counts = [sum(len(mesh.triangles) for mesh in snapshot.meshes) for snapshot, _ in results]
    return {"plain": plain, "counts": counts, "told": results[0][1].lines()}


def _seen(width):
    """Return the Camera of a view of the xy plane, 8 wide."""
    matrix = np.array([(1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 5)], float)
    return Camera(matrix, CameraKind.ORTHOGRAPHIC, window=(-4.0, 4.0, -4.0, 4.0), width=width, height=width)


def views():
    """Return the triangles of a row of two squares in views by their pixels, and what a view without pixels tells."""
    scene = stage.empty()
    scene.cycles.preview_dicing_rate = 1.0
    # No view is divided by this camera, which is an error elsewhere.
    stage.camera((0, 0, 5), (0, 0, 0)).scale = 3 * [0.0]
    _quads(scene)
    depsgraph = bpy.context.evaluated_depsgraph_get()

    def exported(dicing, parts):
        snapshot, messages = export_scene(depsgraph, ExportOptions(view=Camera(), dicing=dicing, parts=parts))
        return {"triangles": len(snapshot.meshes[0].triangles), "told": messages.lines()}

    kept = Parts()
    fine, later = (exported(_seen(width), kept)["triangles"] for width in (80, 40))
    return {"fine": fine, "later": later, "coarse": exported(_seen(40), Parts())["triangles"], "none": exported(None, Parts())}
