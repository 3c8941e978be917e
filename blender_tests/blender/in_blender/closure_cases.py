"""Films, hair and portals, as they are exported."""

import bpy
import stage
from export_cases import export_told
from material_cases import Tree, answer


def films():
    """Thin films and thin walls of the nodes of this Blender that have them, set and at their defaults."""
    stage.empty()
    materials = []
    for kind in ("BsdfPrincipled", "BsdfGlass", "BsdfMetallic"):
        for thickness in (0.0, 0.1, 300.0):
            tree = Tree(f"{kind} {thickness:g}")
            try:
                node = tree.node(kind)
            except RuntimeError:
                break
            if "Thin Film Thickness" not in node.inputs:
                break
            node.inputs["Thin Film Thickness"].default_value, node.inputs["Thin Film IOR"].default_value = thickness, 1.25
            materials.append(tree.show(node.outputs[0]))
    if bpy.app.version >= (5, 2):
        tree = Tree("wall")
        node = tree.node("BsdfPrincipled", Thin_Wall=True, Subsurface_Weight=0.5, Subsurface_Anisotropy=0.5)
        materials.append(tree.show(node.outputs[0]))
    return answer(*materials)


def hair():
    """Principled Hair by each description of its colour, and hair with a tangent."""
    stage.empty()
    materials = []
    values = {"Color": (0.25, 0.0, 1.0), "Melanin": 0.5, "Melanin_Redness": 0.25, "Tint": (1.0, 1.0, 1.0), "Random": 1.0}
    values |= {"Absorption_Coefficient": (0.1, 0.2, 0.3), "Radial_Roughness": 0.5, "Random_Color": 0.5, "Coat": 0.25}
    for way in ("COLOR", "MELANIN", "ABSORPTION"):
        tree = Tree(way)
        node = tree.node("BsdfHairPrincipled", parametrization=way)
        for name, value in values.items():
            socket = next(socket for socket in node.inputs if socket.identifier == name.replace("_", " "))
            socket.default_value = (*value, 1.0)[: len(socket.default_value)] if isinstance(value, tuple) else value
        materials.append(tree.show(node.outputs[0]))
    if bpy.app.version >= (4, 0):
        tree = Tree("Huang")
        node = tree.node("BsdfHairPrincipled", model="HUANG", parametrization="COLOR")
        node.inputs["Color"].default_value, node.inputs["Roughness"].default_value = (0.25, 0.5, 1.0, 1.0), 0.5
        node.inputs["Aspect Ratio"].default_value, node.inputs["IOR"].default_value = 0.75, 1.4
        for name, factor in (("Reflection", 2.0), ("Transmission", 0.5), ("Secondary Reflection", 0.25)):
            node.inputs[name].default_value = factor
        materials.append(tree.show(node.outputs[0]))
    for name in ("bare", "combed"):
        tree = Tree(name)
        node = tree.node("BsdfHair", Offset=0.5)
        if name == "combed":
            tree.tree.links.new(tree.node("Tangent", direction_type="RADIAL").outputs[0], node.inputs["Tangent"])
        materials.append(tree.show(node.outputs[0]))
    return answer(*materials)


def portals_of_classic():
    """Return the messages of a Ray Portal for each integrator; nothing where this Blender has none."""
    told = {}
    for integrator in ("PATH", "CLASSIC") if bpy.app.version >= (4, 2) else ():
        scene = stage.empty()
        tree = Tree("Portal")
        stage.plane(material=tree.show(tree.node("BsdfRayPortal").outputs[0]))
        scene.lancer.integrator = integrator
        told[integrator] = [text for text in export_told()[1].lines() if "Portal" in text]
    return told


def portals():
    """Ray Portals with and without links, beside a diffuse part; nothing where this Blender has none."""
    stage.empty()
    if bpy.app.version < (4, 2):
        return answer()
    materials = []
    for name in ("still", "moves"):
        tree = Tree(name)
        portal = tree.node("BsdfRayPortal", Color=(0.5, 0.25, 1.0), Position=(1.0, 2.0, 3.0), Direction=(0.0, 2.0, 0.0))
        if name == "moves":
            tree.tree.links.new(tree.node("NewGeometry").outputs["Position"], portal.inputs["Position"])
        matt = tree.node("BsdfDiffuse").outputs[0]
        materials.append(tree.show(tree.shaders("MixShader", portal.outputs[0], matt)))
    return answer(*materials)
