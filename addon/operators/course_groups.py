"""The course's models in the Shader Editor: Add > Lancer adds a node group with a socket for each parameter of a model.

The nodes inside approximate the model in Cycles and EEVEE; Lancer renders the model itself (export/course_models.py).
"""

import bpy

from ..engine.render_engine import LancerRenderEngine
from ..export.course_models import MODELS, NORMAL, PARAMETERS, is_as_made, mark, model_of, parameters_of
from ..host.registering import add_all
from ..settings.properties import LancerMaterialSettings

_SETTINGS = LancerMaterialSettings.__annotations__
# Models by their names, descriptions and numbers in the material's own settings.
_ITEMS = [item for item in _SETTINGS["model"].keywords["items"] if item[0] in MODELS]
_NAMES = {item[0]: item[1] for item in _ITEMS}
_OLD = bpy.app.version < (4, 0)  # without tree.interface


# ---- the groups' insides -------------------------------------------------------------------------------------------------


class _Inside:
    """The nodes of a group under construction; each is placed to the right of its sources."""

    def __init__(self, tree, sockets):
        self.tree = tree
        self.start = tree.nodes.new("NodeGroupInput")
        self.sockets = {name: self.start.outputs[name] for name in sockets}
        self._depths = {self.start.name: 0}

    def node(self, name, kind, inputs, output=0, **settings):
        """Add a node and return one of its outputs. inputs: constants or outputs of other nodes, by socket name or number."""
        node = self.tree.nodes.new("ShaderNode" + kind)
        node.name = node.label = name
        for setting, value in settings.items():
            setattr(node, setting, value)
        for socket, value in inputs.items():
            if isinstance(value, bpy.types.NodeSocket):
                self.tree.links.new(value, node.inputs[socket])
            else:
                node.inputs[socket].default_value = value
        self._place(node)
        return node.outputs[output]

    def finish(self, shader):
        end = self.tree.nodes.new("NodeGroupOutput")
        self.tree.links.new(shader, end.inputs[0])
        self._place(end)

    def _place(self, node):
        sources = [link.from_node.name for link in self.tree.links if link.to_node == node]
        depth = 1 + max((self._depths[name] for name in sources), default=0)
        row = sum(other == depth for other in self._depths.values())
        self._depths[node.name] = depth
        node.location = 220.0 * depth, -220.0 * row


def _math(inside, name, operation, a, b):
    return inside.node(name, "Math", {0: a, 1: b}, operation=operation)


def _body(inside, color):
    """Add the diffuse base."""
    return inside.node("Body", "BsdfDiffuse", {"Color": color, "Normal": inside.sockets[NORMAL]})


def _highlight(inside, color, roughness):
    inputs = {"Color": color, "Roughness": roughness, "Normal": inside.sockets[NORMAL]}
    return inside.node("Highlight", "BsdfGlossy", inputs, distribution="BECKMANN")


def _show_kd_ks(inside, kd, ks, roughness, ior):
    """Blender's roughness is the square root of alpha; the Fresnel term of the clear layer depends on the view direction."""
    layer = _highlight(inside, ks, _math(inside, "Square Root of Alpha", "POWER", roughness, 0.5))
    share = inside.node("Fresnel", "Fresnel", {"IOR": ior, "Normal": inside.sockets[NORMAL]})
    # A Mix Shader with one input scales it by the factor.
    coat = inside.node("Share", "MixShader", {0: share, 2: layer})
    return inside.node("Sum", "AddShader", {0: _body(inside, kd), 1: coat})


def _show_power(inside, kd, ks, exponent):
    """A Beckmann lobe as wide as cos^n about the normal: alpha^2 = 2 / (n + 2), roughness = sqrt(alpha)."""
    square = _math(inside, "Square of Alpha", "DIVIDE", 2.0, _math(inside, "Exponent + 2", "ADD", exponent, 2.0))
    highlight = _highlight(inside, ks, _math(inside, "Roughness", "POWER", square, 0.25))
    return inside.node("Sum", "AddShader", {0: _body(inside, kd), 1: highlight})


def _show_phong(inside, kd, ks, shininess):
    """The angle to the mirror direction is about twice the half vector's angle: cos^n of one is cos^4n of the other."""
    return _show_power(inside, kd, ks, _math(inside, "Blinn's Exponent", "MULTIPLY", shininess, 4.0))


def _show_minnaert(inside, kd, darkness):
    """The factor cos_o^(k - 1) of (cos_i cos_o)^(k - 1), with a colour of at most 1."""
    facing = inside.node("Away", "LayerWeight", {"Blend": 0.5, "Normal": inside.sockets[NORMAL]}, "Facing")
    cosine = _math(inside, "At Least", "MAXIMUM", _math(inside, "Cosine", "SUBTRACT", 1.0, facing), 1e-3)
    power = _math(inside, "Power", "POWER", cosine, _math(inside, "k - 1", "SUBTRACT", darkness, 1.0))
    color = inside.node("Color", "VectorMath", {0: kd, "Scale": power}, operation="SCALE")
    return _body(inside, inside.node("At Most", "VectorMath", {0: color, 1: (1.0, 1.0, 1.0)}, operation="MINIMUM"))


_INSIDES = {"KD_KS": _show_kd_ks, "PHONG": _show_phong, "BLINN_PHONG": _show_power, "MINNAERT": _show_minnaert}


# ---- groups ----------------------------------------------------------------------------------------------------------------


def group_of(model):
    """Return the file's unchanged node group of a model, or make one."""
    for tree in bpy.data.node_groups:
        if model_of(tree) == model and tree.library is None and is_as_made(tree):
            return tree
    return _make_group(model)


def _make_group(model):
    tree = bpy.data.node_groups.new(f"Lancer {_NAMES[model]}", "ShaderNodeTree")
    names = parameters_of(model)
    sockets = [PARAMETERS[name].socket for name in names]
    for name in names:
        _add_input(tree, name)
    normal = _add_socket(tree, NORMAL, "Vector")
    # Hide the value: an unlinked input means the surface's own normal.
    normal.hide_value = True
    _add_socket(tree, "BSDF", "Shader", "OUTPUT")
    inside = _Inside(tree, [*sockets, NORMAL])
    # Only Lancer has ambient light.
    values = [inside.sockets[PARAMETERS[name].socket] for name in names if name != "ka"]
    inside.finish(_INSIDES[model](inside, *values))
    mark(tree, model)
    return tree


def _add_input(tree, name):
    """Add a socket with default, range and description of the material's setting of that name."""
    setting = _SETTINGS[name].keywords
    is_color = PARAMETERS[name].kind == "color"
    socket = _add_socket(tree, PARAMETERS[name].socket, "Color" if is_color else "Float")
    socket.default_value = (*setting["default"], 1.0) if is_color else setting["default"]
    socket.description = setting["description"]
    if not is_color:
        socket.min_value = setting["min"]
        socket.max_value = setting.get("max", socket.max_value)


def _add_socket(tree, name, kind, direction="INPUT"):
    if _OLD:
        return (tree.inputs if direction == "INPUT" else tree.outputs).new("NodeSocket" + kind, name)
    return tree.interface.new_socket(name, in_out=direction, socket_type="NodeSocket" + kind)


# ---- the menu --------------------------------------------------------------------------------------------------------------


class LANCER_OT_add_model(bpy.types.Operator):
    bl_idname = "lancer.add_model"
    bl_label = "Add Model"
    bl_description = (
        "Adds a node group of one of the course's models. Lancer renders the model itself from the node's inputs, constant or "
        "linked; Cycles and EEVEE show the nodes inside, which approximate it. Changes of these nodes do not change Lancer's "
        "picture: ungroup the node to render its nodes instead of the model"
    )
    bl_options = {"REGISTER", "UNDO"}

    model: bpy.props.EnumProperty(name="Model", items=_ITEMS)

    @classmethod
    def description(cls, _context, properties):
        text = next(item[2] for item in _ITEMS if item[0] == properties.model)
        return f"{text}. {cls.bl_description}"

    @classmethod
    def poll(cls, context):
        return _edited(context) is not None

    def execute(self, context):
        space, tree = context.space_data, _edited(context)
        if model_of(tree) is not None:
            self.report({"ERROR"}, "Lancer: nodes inside a model's group have no effect: add the node outside of it")
            return {"CANCELLED"}
        for other in tree.nodes:
            other.select = False
        node = tree.nodes.new("ShaderNodeGroup")
        node.node_tree = group_of(self.model)
        node.label = _NAMES[self.model]
        node.width = 180.0
        node.location = space.cursor_location
        node.select, tree.nodes.active = True, node
        return {"FINISHED"}

    def invoke(self, context, event):
        context.space_data.cursor_location_from_region(event.mouse_region_x, event.mouse_region_y)
        result = self.execute(context)
        # Like Blender's own nodes, the new node follows the mouse until a click; a right click removes it.
        if "FINISHED" in result:
            bpy.ops.node.translate_attach_remove_on_cancel("INVOKE_DEFAULT")
        return result


def _edited(context):
    """Return the shader node tree in the editor; None if there is none that may be changed."""
    space = context.space_data
    tree = getattr(space, "edit_tree", None)
    if tree is None or space.tree_type != "ShaderNodeTree" or space.shader_type != "OBJECT" or tree.library is not None:
        return None
    return tree


class NODE_MT_lancer_models(bpy.types.Menu):
    bl_idname = "NODE_MT_lancer_models"
    bl_label = "Lancer"

    def draw(self, _context):
        for model, name, *_ in _ITEMS:
            self.layout.operator(LANCER_OT_add_model.bl_idname, text=name).model = model


def _draw_entry(self, context):
    space = context.space_data
    shaders = space.tree_type == "ShaderNodeTree" and space.shader_type == "OBJECT"
    if shaders and context.engine == LancerRenderEngine.bl_idname:
        self.layout.menu(NODE_MT_lancer_models.bl_idname)


_CLASSES = (LANCER_OT_add_model, NODE_MT_lancer_models)


def register():
    add_all(_CLASSES, bpy.utils.register_class, bpy.utils.unregister_class)
    bpy.types.NODE_MT_add.append(_draw_entry)


def unregister():
    bpy.types.NODE_MT_add.remove(_draw_entry)
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
