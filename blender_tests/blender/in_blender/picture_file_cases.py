"""What Blender sees in a file of the farm's."""

import bpy


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
