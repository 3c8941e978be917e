"""Scenes that are exported but not rendered. Each function returns facts of the snapshot, which its test compares."""

import bpy
import numpy as np
import stage

from addon.bindings.enums import InstanceKind, LightKind, Ray, Shading
from addon.export.arrays import triangle_faces
from addon.export.mesh import _triangle_corners
from addon.export.scene import export_scene


class ExportProbe(bpy.types.RenderEngine):
    """Exports the depsgraph of a final render: only it has the render visibility and the render counts."""

    bl_idname = "EXPORT_PROBE"
    bl_label = "Export Probe"
    caught = None
    look = None  # a function that is called with the depsgraph, if set

    def render(self, depsgraph):
        ExportProbe.caught = export_scene(depsgraph)
        if ExportProbe.look is not None:
            ExportProbe.look = ExportProbe.look(depsgraph)


def export():
    """Return the scene's snapshot."""
    return export_told()[0]


def export_told():
    """Return (snapshot, messages) of the scene, adding a camera if it has none. The console shows an error of the export."""
    scene = bpy.context.scene
    if scene.camera is None:
        stage.camera()
    bpy.utils.register_class(ExportProbe)
    ExportProbe.caught, scene.render.engine = None, ExportProbe.bl_idname
    bpy.ops.render.render()
    bpy.utils.unregister_class(ExportProbe)
    assert ExportProbe.caught is not None, "the export failed"
    return ExportProbe.caught


def facts(snapshot):
    table, rows = snapshot.instances, []
    for i in range(len(table)):
        rows.append(
            {
                "name": table.names[table.name_indices[i]],
                "kind": InstanceKind(int(table.kinds[i])).name,
                "shading": Shading(int(table.shadings[i])).name,
                "mesh": int(table.meshes[i]),
                "matrix": table.matrices[i].tolist(),
                "materials": [snapshot.materials[s].name for s in table.slots[table.first_slots[i] :][: table.slot_counts[i]]],
            }
        )
    return rows


def counts(snapshot):
    rows = facts(snapshot)
    return {
        "meshes": len(snapshot.meshes),
        "instances": len(rows),
        "names": sorted(row["name"] for row in rows),
        "mesh of": [row["mesh"] for row in rows],
        "triangles": [len(mesh.triangles) for mesh in snapshot.meshes],
        "places": sorted([row[3] for row in placed["matrix"]] for placed in rows),
    }


def named(item, name):
    item.name = name
    return item


def modifiers():
    stage.empty()
    item = stage.cube(2.0)
    subdivision = item.modifiers.new("Subdivision", "SUBSURF")
    subdivision.subdivision_type, subdivision.levels, subdivision.render_levels = "SIMPLE", 0, 1
    item.modifiers.new("Array", "ARRAY").count = 3
    snapshot = export()
    positions = snapshot.meshes[0].positions
    return {**counts(snapshot), "low": positions.min(axis=0).tolist(), "high": positions.max(axis=0).tolist()}


def collection_instances():
    scene = stage.empty()
    group = bpy.data.collections.new("Group")
    item = stage.cube(location=(0, 0, 1))
    scene.collection.objects.unlink(item)
    group.objects.link(item)
    for x in (1, 2, 3):
        holder = stage.link("Holder", None, (x, 0, 0))
        holder.instance_type, holder.instance_collection = "COLLECTION", group
    return counts(export())


def particle_instances():
    stage.empty()
    seed = named(stage.cube(0.1), "Seed")
    ground = named(stage.plane(2.0), "Ground")
    ground.modifiers.new("Particles", "PARTICLE_SYSTEM")
    settings = ground.particle_systems[0].settings
    settings.type, settings.count, settings.render_type, settings.instance_object = "HAIR", 7, "OBJECT", seed
    return counts(export())


def row_of_cubes():
    """Add instances by nodes: five cubes on a line of points."""
    tree = bpy.data.node_groups.new("Row", "GeometryNodeTree")
    if hasattr(tree, "interface"):
        tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    else:
        tree.outputs.new("NodeSocketGeometry", "Geometry")
    line, box = tree.nodes.new("GeometryNodeMeshLine"), tree.nodes.new("GeometryNodeMeshCube")
    spread, output = tree.nodes.new("GeometryNodeInstanceOnPoints"), tree.nodes.new("NodeGroupOutput")
    line.inputs["Count"].default_value = 5
    line.inputs["Offset"].default_value = (2, 0, 0)
    tree.links.new(line.outputs["Mesh"], spread.inputs["Points"])
    tree.links.new(box.outputs["Mesh"], spread.inputs["Instance"])
    tree.links.new(spread.outputs["Instances"], output.inputs[0])
    item = stage.plane()
    item.modifiers.new("Row", "NODES").node_group = tree
    return item


def node_instances():
    """Build five cubes on a line of points, beside a plain cube."""
    stage.empty()
    row_of_cubes()
    stage.cube(location=(0, 9, 0))
    return counts(export())


def _walk(depsgraph):
    """Return [name, matrix, ray types that it is hidden from, pass index] of each entry of the depsgraph with a mesh."""
    rows = []
    for entry in depsgraph.object_instances:
        thing = entry.object
        if thing.type != "MESH" or not entry.show_self or not thing.data.polygons:
            continue
        owners = [thing, entry.parent] if entry.is_instance else [thing]
        hidden = sorted({ray for ray in ("camera", "shadow") if not all(getattr(x, "visible_" + ray) for x in owners)})
        matrix = np.array(entry.matrix_world, float)
        # A plane's instance has its origin in the middle of the mesh, here 2 m to the side.
        if thing.lancer.shape == "PLANE":
            matrix = matrix @ np.array([[1, 0, 0, 2], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]], float)
        rows.append([thing.name, matrix[:3].tolist(), hidden, thing.pass_index])
    return rows


def walked():
    """Instance meshes in every way that Blender has. Return the rows of the snapshot, and those of the depsgraph."""
    scene = stage.empty()
    top = stage.link("Top", None, (1, 2, 3), (0.3, 0.2, 0.1))
    top.scale = (1.0, -2.0, 0.5)
    for number in range(3):
        child = named(stage.cube(location=(number, 0, 0), rotation=(0.1 * number, 0.7, 0)), f"Child {number}")
        child.parent, child.pass_index, child.visible_camera = top, number, number != 1
    copy = stage.link("Copy", child.data, (0, -5, 0))
    copy.visible_shadow = False
    named(stage.cube(), "Gone").hide_render = True
    stage.link("Bare", bpy.data.meshes.new("Bare"))
    stage.light("POINT", location=(0, 0, 5))
    group = bpy.data.collections.new("Group")
    scene.collection.children.link(group)
    for name in ("Piece", "Other"):
        item = named(stage.cube(0.3, location=(0, 0, 1)), name)
        scene.collection.objects.unlink(item)
        group.objects.link(item)
    for number in range(3):
        holder = stage.link(f"Holder {number}", None, (number, 4, 0), (0, 0, number))
        holder.instance_type, holder.instance_collection, holder.visible_camera = "COLLECTION", group, number != 2
    ground = named(stage.plane(2.0), "Ground")
    ground.modifiers.new("Particles", "PARTICLE_SYSTEM")
    settings = ground.particle_systems[0].settings
    settings.type, settings.count, settings.render_type, settings.instance_object = "HAIR", 7, "OBJECT", item
    settings.size_random = 0.5
    row_of_cubes()
    corners = [(1, -1, 0), (3, -1, 0), (3, 1, 0), (1, 1, 0)]
    stage.mesh("Flat", corners, [(0, 1, 2, 3)], location=(0, 0, -1)).lancer.shape = "PLANE"
    ExportProbe.look = _walk
    table = export().instances
    told, ExportProbe.look = ExportProbe.look, None
    rays = {"camera": Ray.CAMERA, "shadow": Ray.SHADOW}
    rows = [
        [
            table.names[table.name_indices[i]],
            table.matrices[i].tolist(),
            [name for name, ray in rays.items() if table.hidden_from[i] & ray],
            int(table.object_indices[i]),
        ]
        for i in range(len(table))
    ]
    return {"rows": rows, "told": told}


def surfaces():
    """A curve, a text and a metaball."""
    stage.empty()
    curve = bpy.data.curves.new("Curve", "CURVE")
    curve.dimensions, curve.bevel_depth = "3D", 0.1
    curve.splines.new("POLY").points.add(1)
    curve.splines[0].points[1].co = (1, 0, 0, 1)
    stage.link("Curve", curve)
    stage.link("Text", bpy.data.curves.new("Text", "FONT"))
    ball = bpy.data.metaballs.new("Meta")
    ball.elements.new()
    stage.link("Meta", ball)
    return counts(export())


def shapes():
    """Export a box from (1, 2, 3) to (3, 6, 9), scaled by 2 at (10, 0, 0), as each shape and with each kind of shading."""
    stage.empty()
    corners = [(x, y, z) for x in (1, 3) for y in (2, 6) for z in (3, 9)]
    for kind in InstanceKind:
        item = stage.mesh(kind.name, corners, [(0, 1, 3, 2)], location=(10, 0, 0))
        item.scale = (2, 2, 2)
        item.lancer.shape = kind.name
    for way in Shading:
        item = stage.cube()
        item.name, item.lancer.shading = f"shading {way.name}", way.name
    snapshot = export()
    return {"meshes": len(snapshot.meshes), "rows": {row["name"]: row for row in facts(snapshot)}}


def roof(name, smooth=True, **place):
    """Return two slopes of 45 degrees that meet in a ridge along y."""
    vertices = [(-1, 0, 0), (-1, 2, 0), (0, 0, 1), (0, 2, 1), (1, 0, 0), (1, 2, 0)]
    item = stage.mesh(name, vertices, [(0, 2, 3, 1), (2, 4, 5, 3)], **place)
    item.data.name = name
    item.data.polygons.foreach_set("use_smooth", [smooth] * 2)
    return item


def attributes():
    """Roofs: flat, smooth, with a sharp ridge, with custom normals, and with UVs and colours that depend on the place."""
    stage.empty()
    roof("flat", False)
    roof("smooth")
    mixed = roof("mixed")
    mixed.data.polygons[0].use_smooth = False
    sharp, custom = roof("sharp").data, roof("custom").data
    for mesh in (sharp, custom):
        if hasattr(mesh, "use_auto_smooth"):
            mesh.use_auto_smooth, mesh.auto_smooth_angle = True, np.pi
    next(edge for edge in sharp.edges if set(edge.vertices) == {2, 3}).use_edge_sharp = True
    custom.normals_split_custom_set([(0.6, 0.0, 0.8)] * len(custom.loops))
    painted, points = roof("painted").data, roof("points").data
    painted.uv_layers.new(name="Other")
    painted.uv_layers.new(name="Shown").active_render = True
    paint = painted.color_attributes.new("Paint", "FLOAT_COLOR", "CORNER")
    # A new attribute may move the others in memory, so the layer is fetched after the last one is added.
    layer = painted.uv_layers["Shown"]
    for polygon in painted.polygons:
        for loop in polygon.loop_indices:
            x, y, z = painted.vertices[painted.loops[loop].vertex_index].co
            layer.data[loop].uv = (0.5 * x, 0.25 * y)
            paint.data[loop].color = (z, float(polygon.index), 0.5, 1.0)
        polygon.material_index = polygon.index
    paint = points.color_attributes.new("Paint", "FLOAT_COLOR", "POINT")
    for vertex in points.vertices:
        paint.data[vertex.index].color = (vertex.co.x + 1, 0.25 * vertex.co.y, vertex.co.z, 1.0)
    arrays = {mesh.name: {k: v for k, v in vars(mesh).items() if k not in ("name", "attributes")} for mesh in export().meshes}
    return {name: {k: None if v is None else v.tolist() for k, v in fields.items()} for name, fields in arrays.items()}


def sharing():
    """Use one mesh three times: plain, with a material of the object, and mirrored."""
    stage.empty()
    plain = stage.cube(material=bpy.data.materials.new("of the mesh"))
    plain.name = "plain"
    own = stage.link("own", plain.data)
    own.material_slots[0].link = "OBJECT"
    own.material_slots[0].material = bpy.data.materials.new("of the object")
    stage.link("mirrored", plain.data, (5, 0, 0)).scale = (-1, 2, 3)
    snapshot = export()
    return {"meshes": len(snapshot.meshes), "rows": {row["name"]: row for row in facts(snapshot)}}


def lights():
    stage.empty()
    for kind in ("POINT", "SPOT", "SUN"):
        named(stage.light(kind, 10.0, color=(1.0, 0.5, 0.25)), kind)
    area = named(stage.light("AREA", 10.0, shape="RECTANGLE", size=2.0, size_y=0.5), "rectangle")
    area.scale = (3, 3, 1)
    named(stage.light("AREA", 10.0, shape="DISK", size=2.0), "disk")
    result = {"version": list(bpy.app.version)}
    if "exposure" in bpy.types.Light.bl_rna.properties:
        named(stage.light("POINT", 10.0, exposure=2.0), "exposure")
        warm = named(stage.light("POINT", 10.0, use_temperature=True, temperature=3000.0), "temperature")
        result["temperature color"] = list(warm.data.temperature_color)
    for light in export().lights:
        result[light.name] = {"kind": LightKind(light.kind).name, "emission": light.emission, "size": light.size}
    return result


def cameras():
    result = {}
    for name, width, height, aspect, shift in (
        ("portrait", 20, 40, (1, 1), (0, 0)),
        ("shift", 40, 20, (1, 1), (0.1, -0.2)),
        ("wide pixels", 40, 40, (2, 1), (0, 0)),
        ("all", 20, 50, (1.5, 1), (0.25, 0.125)),
    ):
        scene = stage.empty(width, height)
        item = stage.camera(lens=50.0, sensor_width=36.0, shift_x=shift[0], shift_y=shift[1])
        scene.render.pixel_aspect_x, scene.render.pixel_aspect_y = aspect
        graph = bpy.context.evaluated_depsgraph_get()
        matrix = item.calc_matrix_camera(graph, x=width, y=height, scale_x=aspect[0], scale_y=aspect[1])
        window = export().camera.window
        result[name] = {"window": list(window), "projection": [list(row) for row in matrix]}
    scene = stage.empty(40, 20)
    render = scene.render
    render.use_border = True
    render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y = 0.25, 0.75, 0.5, 0.9
    camera = export().camera
    result["border"] = [camera.width, camera.height, camera.x, camera.y, camera.region_width, camera.region_height]
    return result


def hidden():
    """Return the exported names of objects hidden in renders, in viewports, and by their collection."""
    scene = stage.empty()
    named(stage.cube(), "shown")
    named(stage.cube(), "hidden").hide_render = True
    named(stage.cube(), "hidden in viewports").hide_viewport = True
    for name in ("shown light", "hidden light"):
        named(stage.light(), name).hide_render = name == "hidden light"
    group = bpy.data.collections.new("Group")
    scene.collection.children.link(group)
    item = named(stage.cube(), "in hidden collection")
    scene.collection.objects.unlink(item)
    group.objects.link(item)
    group.hide_render = True
    snapshot = export()
    return sorted([*snapshot.instances.names, *(light.name for light in snapshot.lights)])


def triangulation():
    """Return corners and faces of the triangles of a quad, a triangle and a pentagon: as exported, and as Blender has them."""
    stage.empty()
    places = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (1, 4, 0), (3, 4, 0), (5, 2, 1), (5, 0, 1)]
    data = stage.mesh("Faces", places, [(0, 1, 2, 3), (3, 2, 4), (2, 1, 7, 6, 5)]).data
    data.calc_loop_triangles()
    corners = root = _triangle_corners(data, len(data.loop_triangles))
    while isinstance(root.base, np.ndarray):
        root = root.base
    return {
        "corners": corners.tolist(),
        "copied": root.flags.owndata,
        "faces": triangle_faces(data).tolist(),
        "told": [[list(triangle.loops), triangle.polygon_index] for triangle in data.loop_triangles],
    }
