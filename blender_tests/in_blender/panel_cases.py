"""Lancer's panels, and Blender's that it shows, drawn without a window."""

import types
from dataclasses import replace

import bpy
import stage


class _Layout:
    """Takes a panel's calls and judges them as Blender would: a property must exist, an icon must have a name known to it."""

    def __init__(self, shown=None):
        self.shown = [] if shown is None else shown

    def row(self, **_):
        return _Layout(self.shown)

    def column(self, **_):
        return _Layout(self.shown)

    def grid_flow(self, **_):
        return _Layout(self.shown)

    def separator(self, **_):
        pass

    def prop(self, data, name, **options):
        if name not in data.bl_rna.properties:
            raise KeyError(f"{data.bl_rna.identifier}.{name}")
        self._judge("prop", options)
        self.shown.append(name)

    def operator(self, name, **options):
        group, _, operator = name.partition(".")
        if operator not in dir(getattr(bpy.ops, group)):
            raise KeyError(name)
        self._judge("operator", options)
        self.shown.append(name)
        return types.SimpleNamespace()

    def label(self, **options):
        self._judge("label", options)
        self.shown.append(options["text"])

    def template_node_view(self, tree, node, socket):
        if socket.node != node or node.id_data != tree:
            raise ValueError("the socket is of another node")
        self.shown.append("nodes")

    @staticmethod
    def _judge(name, options):
        parameters = bpy.types.UILayout.bl_rna.functions[name].parameters
        for option, value in options.items():
            if option not in parameters:
                raise TypeError(f"{name} has no option {option}")
            if option == "icon" and value not in parameters["icon"].enum_items:
                raise TypeError(f"no icon {value}")


def _draw(cls, context):
    """Calls draw as Blender does, on a stand-in: a panel exists only within a window."""
    members = {name: value for base in reversed(cls.__mro__[:2]) for name, value in vars(base).items()}
    panel = types.SimpleNamespace(layout=_Layout())
    panel._column = types.MethodType(members["_column"], panel)
    if "_draw_nodes" in members:
        panel._draw_nodes = members["_draw_nodes"].__get__(None, cls)
    cls.draw(panel, context)
    return panel.layout.shown


def _variants(context):
    """The context again and again, with other choices made."""
    from addon import engine, measuring
    from addon.bindings.hints import Cost, Costs

    yield "plain"
    bpy.ops.render.render()
    yield "rendered"
    bpy.ops.lancer.check_scene()
    yield "checked"
    name = context.scene.name
    text = "3 materials use refraction; without it this frame would take 22 % less time for the same samples"
    cost = Cost("glass", 3, 0.22, 0.02, 1.5, text, "they are opaque, in the same colour")
    engine.last_costs[name] = Costs((cost, replace(cost, share=0.01)), ("metal",), 6.8)
    yield "measured"
    engine.last_costs[name] = Costs()
    yield "measured, nothing found"
    measuring.running[name] = ("lancer.measure_features", 0.5, "3 materials use refraction")
    yield "measuring"
    del measuring.running[name]
    measuring.running[name] = ("lancer.measure_quality", 0.25, "All pixels alike")
    yield "measuring quality"
    del measuring.running[name]
    bpy.ops.lancer.measure_quality(seconds=0.1)
    yield "quality"
    context.scene.lancer.max_bounces += 1
    yield "quality of other settings"
    context.scene.lancer.max_bounces -= 1
    own = context.scene.lancer
    for integrator in own.bl_rna.properties["integrator"].enum_items.keys():
        own.integrator = integrator
        yield integrator
    for model in ("KD_KS", "PHONG", "BLINN_PHONG", "MINNAERT", "NODES"):
        context.material.lancer.model = model
        yield model
    context.material.node_tree.nodes.clear()
    yield "material without output"
    context.world.node_tree.nodes.clear()
    yield "world without output"
    context.light.lancer.use_separate_colors = True
    if "use_temperature" in context.light.bl_rna.properties:
        context.light.use_temperature = True
    lamp = next(item for item in bpy.data.objects if item.type == "LIGHT")
    for kind in ("SUN", "SPOT", "AREA", "POINT"):
        lamp.data.type = kind
        # The type of the data-block's Python object follows its kind only when asked for anew.
        context.light = lamp.data
        yield kind
        if kind == "AREA":
            for shape in ("SQUARE", "RECTANGLE", "DISK", "ELLIPSE"):
                lamp.data.shape = shape
                yield shape


def panels():
    """Draws every panel in many states: what was shown, and what went wrong."""
    from addon import ui

    scene = stage.room(width=16, height=16, samples=1)
    cube = bpy.data.objects["Cube"]
    context = types.SimpleNamespace(
        engine="LANCER",
        region=None,
        scene=scene,
        view_layer=scene.view_layers[0],
        object=cube,
        material=cube.data.materials[0],
        light=next(item.data for item in bpy.data.objects if item.type == "LIGHT"),
        world=scene.world,
    )
    shown, errors, polls = {cls.__name__: {} for cls in ui._CLASSES}, [], []
    for variant in _variants(context):
        for cls in ui._CLASSES:
            try:
                if not cls.poll(context):
                    polls.append(f"{cls.__name__}: hidden, {variant}")
                shown[cls.__name__][variant] = _draw(cls, context)
            except Exception as error:
                errors.append(f"{cls.__name__}, {variant}: {type(error).__name__}: {error}")
    nothing = types.SimpleNamespace(engine="LANCER", object=None, material=None, light=None, world=None)
    hidden = [cls.__name__ for cls in ui._CLASSES if not cls.poll(nothing)]
    context.engine = "CYCLES"
    foreign = [cls.__name__ for cls in ui._CLASSES if cls.poll(context)]
    return {"shown": shown, "errors": errors, "polls": polls, "hidden": hidden, "foreign": foreign}


def simplify():
    """{panel: what it shows} of Blender's own panels of Simplify, as Lancer shows them."""
    context = types.SimpleNamespace(engine="LANCER", scene=stage.room())
    result = {}
    for cls in bpy.types.Panel.__subclasses__():
        if "RENDER_PT_simplify" in (cls.__name__, getattr(cls, "bl_parent_id", "")) and cls.poll(context):
            panel = types.SimpleNamespace(layout=_Layout())
            if "draw_header" in vars(cls):
                cls.draw_header(panel, context)
            cls.draw(panel, context)
            result[cls.__name__] = panel.layout.shown
    return result
