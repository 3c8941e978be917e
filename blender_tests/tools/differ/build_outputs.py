"""Records of light groups, AOVs and cryptomattes as those of a view layer."""

import bpy


def build_light_group(name):
    bpy.ops.scene.view_layer_add_lightgroup(name=name)


def build_aov(name, fields):
    aov = bpy.context.view_layer.aovs.add()
    aov.name, aov.type = name, fields.get("type", "COLOR")


def name_aov(node, name):
    """Let an AOV Output node give an AOV; before 4.2 the name of the node itself says which."""
    if hasattr(node, "aov_name"):
        node.aov_name = name
    else:
        node.name = name


def ask_for_mattes(titles, levels):
    """titles: of the passes, such as CryptoObject."""
    layer = bpy.context.view_layer
    for title in titles:
        setattr(layer, f"use_pass_cryptomatte_{title.removeprefix('Crypto').lower()}", True)
    layer.pass_cryptomatte_depth = levels
