"""A square displaced by a height of constant slope in x and y, by each method of displacement, as the core receives it."""

import dataclasses

import numpy as np
import stage
from export_cases import export_told
from material_cases import Tree, told

from addon.bindings.enums import Pass
from addon.bindings.session import Scene, Session


def _rising(method, slope):
    tree = Tree(method)
    # The method is a setting of the material from 4.1 on, and one of Cycles before.
    owner = tree.material if hasattr(tree.material, "displacement_method") else tree.material.cycles
    owner.displacement_method = method
    place = tree.node("TexCoord").outputs["Object"]
    height = tree.node("VectorMath", operation="DOT_PRODUCT")
    tree.tree.links.new(place, height.inputs[0])
    height.inputs[1].default_value = slope
    lifted = tree.node("Displacement", Height=height.outputs["Value"], Midlevel=0.0, Scale=1.0)
    tree.tree.links.new(lifted.outputs[0], tree.output.inputs["Displacement"])
    return tree.show(tree.node("BsdfDiffuse").outputs[0])


def methods(*slope):
    slope = [float(value) for value in slope]
    result = {}
    for method in ("BUMP", "DISPLACEMENT", "BOTH"):
        stage.empty(width=1, height=1)
        # Smooth, as displaced meshes are: Cycles' own versions differ for flat faces in BOTH.
        faces = stage.plane(4.0, _rising(method, slope)).data.polygons
        faces.foreach_set("use_smooth", [True] * len(faces))
        stage.camera((0, 0, 5), (0, 0, 0), type="ORTHO", ortho_scale=1.0)
        snapshot, messages = export_told()
        with Scene.upload(snapshot) as uploaded:
            places = np.array([(1.0, 0.0, 5.0), (0.5, -1.0, 5.0), (-1.5, 0.25, 5.0)])
            hits = uploaded.intersect(places, [(0.0, 0.0, -1.0)])
        settings = dataclasses.replace(snapshot.settings, passes=(Pass.COMBINED, Pass.NORMAL))
        with Session.upload(dataclasses.replace(snapshot, settings=settings)) as session:
            session.render_all()
            normal = session.read(Pass.NORMAL)[0, 0]
        material = told(snapshot.materials[0])
        result[method] = {
            "displacement": material["displacement"],
            "normal": material["normal"],
            "lobe normal": material["lobes"][0]["normal"],
            "mesh": snapshot.meshes[0].positions[:, 2].tolist(),
            "places": places[:, :2].tolist(),
            "heights": hits.position[:, 2].tolist(),
            "shown": normal.tolist(),
            "messages": messages.lines(),
        }
    return result
