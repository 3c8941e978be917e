"""The course's settings in the snapshot: polygons for flat shading, ambient light."""

import bpy
import numpy as np
import stage
from export_cases import export

# A pentagon, a concave hexagon and a warped quadrilateral.
_CORNERS = [
    (0, 0, 0), (4, 0, 0), (5, 2, 0), (2, 4, 0), (0, 1, 0),
    (10, 0, 0), (14, 0, 0), (14, 1, 0), (11, 1, 0), (11, 4, 0), (10, 4, 0),
    (20, 0, 0), (22, 0, 1), (22, 2, 0), (20, 2, 1),
]  # fmt: skip
_FACES = [(0, 1, 2, 3, 4), (5, 6, 7, 8, 9, 10), (11, 12, 13, 14)]


def polygons():
    """Return {integrator: {object: (polygon of each triangle or None, mean of each polygon's vertices)}}, Blender's centres."""
    scene = stage.empty()
    first = stage.mesh("flat", _CORNERS, _FACES)
    first.lancer.shading = "FLAT"
    # A second object with the same mesh, not flat; and one whose faces are triangles already.
    stage.link("as mesh", first.data)
    bare = stage.mesh("triangle", [(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
    bare.lancer.shading = "FLAT"
    found = {"blender": [list(face.center) for face in first.data.polygons]}
    for integrator in ("CLASSIC", "PATH"):
        scene.lancer.integrator = integrator
        snapshot = export()
        table = snapshot.instances
        found[integrator] = {
            table.names[table.name_indices[i]]: _of_mesh(snapshot.meshes[table.meshes[i]]) for i in range(len(table))
        }
        found[integrator + " meshes"] = len(snapshot.meshes)
    return found


def _of_mesh(mesh):
    if mesh.polygons is None:
        return None
    means = []
    for polygon in range(int(mesh.polygons.max()) + 1):
        vertices = np.unique(mesh.triangles[mesh.polygons == polygon])
        means.append(mesh.positions[vertices].mean(axis=0).tolist())
    return mesh.polygons.tolist(), means


def ambient():
    """Return the ambient colours of the world and of a lamp, for each position of their switches."""
    scene = stage.empty()
    scene.world = bpy.data.worlds.new("World")
    lamp = bpy.data.lights.new("Lamp", "POINT")
    stage.link("Lamp", lamp)
    own, light = scene.world.lancer, lamp.lancer
    own.ambient_color, light.ambient_color = (0.25, 0.5, 0.75), (0.5, 0.25, 0.125)
    found = {}
    for used in (False, True):
        own.use_ambient_color = used
        ambient = export().world.ambient
        found[f"world {used}"] = None if ambient is None else list(ambient)
    for used in (False, True):
        for separate in (False, True):
            light.use_ambient, light.use_separate_colors = used, separate
            found[f"lamp {used} {separate}"] = list(export().lights[0].ambient_color)
    return found
