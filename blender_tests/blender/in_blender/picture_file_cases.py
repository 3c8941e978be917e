"""What Blender sees in a file of the farm's, and what it writes itself."""

import bpy
import exr
import stage

from addon.engine import render_export


def layers(path):
    """Return the kind of the image, and the view layer and the passes that the compositor offers."""
    image = bpy.data.images.load(path)
    tree = bpy.data.node_groups.new("files", "CompositorNodeTree")
    node = tree.nodes.new("CompositorNodeImage")
    node.image = image
    return {
        "type": image.type,
        "layer": node.layer if node.has_layers else "",
        "passes": [socket.name for socket in node.outputs if socket.enabled],
        "size": list(image.size),
    }


def named_passes(snapshot, picture):
    """Write the snapshot and the picture of a scene with a light group, AOVs, mattes and a catcher."""
    scene = stage.room(width=16, height=16, samples=4)
    layer = scene.view_layers[0]
    bpy.data.objects["Plane"].is_shadow_catcher = True
    layer.cycles.use_pass_shadow_catcher = layer.use_pass_vector = True
    layer.use_pass_cryptomatte_object = layer.use_pass_cryptomatte_material = True
    bpy.ops.scene.view_layer_add_lightgroup(name="key")
    bpy.data.objects["Light"].lightgroup = "key"
    tree = bpy.data.objects["Cube"].data.materials[0].node_tree
    for name, kind, socket, value in (("Tint", "COLOR", "Color", (0.25, 1.5, 2.0, 1.0)), ("Number", "VALUE", "Value", 0.75)):
        aov = layer.aovs.add()
        aov.name, aov.type = name, kind
        node = tree.nodes.new("ShaderNodeOutputAOV")
        node.aov_name, node.inputs[socket].default_value = name, value
    render_export.export(bpy.context).snapshot.save(snapshot)
    exr.write_settings(scene, picture)
    bpy.ops.render.render(write_still=True)
    return True
