"""The course's models as node groups: compared with the material's own settings; copied, linked, edited and undone."""

import types

import bpy
import numpy as np
import stage
from material_cases import Tree, answer

from addon.export.course_models import MODELS, PARAMETERS, TAG, parameters_of
from addon.operators import course_groups
from scenes.pictures import make_image

VALUES = {
    "ka": (0.25, 0.125, 0.0),
    "kd": (0.5, 0.25, 0.125),
    "ks": (0.75, 0.5, 0.25),
    "roughness": 0.3,
    "ior": 1.75,
    "shininess": 30.0,
    "darkness": 1.75,
}
POWER, LAMP, EYE, SKY = 800.0, (0.25, 2.0, 3.0), (0.0, -3.0, 4.0), 0.25
# The two halves of a textured input.
HALVES = {
    "ka": ((0.5, 0.25, 0.0), (0.0, 0.5, 1.0)),
    "kd": ((0.75, 0.5, 0.25), (0.125, 0.25, 0.5)),
    "ks": ((0.5, 0.25, 0.125), (0.25, 0.5, 1.0)),
    "roughness": (0.25, 0.5),
    "ior": (1.25, 2.0),
    "shininess": (10.0, 60.0),
    "darkness": (0.75, 2.5),
}


def own(model, **values):
    material = bpy.data.materials.new(model)
    material.lancer.model = model
    for name in parameters_of(model):
        setattr(material.lancer, name, {**VALUES, **values}[name])
    return material


def node_of(tree, model, **values):
    """Return a group node of a model, with constants."""
    node = tree.node("Group", node_tree=course_groups.group_of(model))
    for name in parameters_of(model):
        value = {**VALUES, **values}[name]
        node.inputs[PARAMETERS[name].socket].default_value = (*value, 1.0) if isinstance(value, tuple) else value
    return node


def grouped(model, **values):
    tree = Tree(model)
    return tree.show(node_of(tree, model, **values).outputs[0])


def lit(material, integrator, engine="LANCER"):
    """Return a picture of a ball of the material in a room."""
    scene = stage.room(engine=engine, width=24, height=24)
    scene.lancer.integrator = integrator
    faces = stage.ball(1.0, material(), location=(0, 0, 1.2)).data.polygons
    # Blender 3 sums the normals of vertices in the order of its threads, which differs from render to render.
    faces.foreach_set("use_smooth", [False] * len(faces))
    return stage.picture(scene)


def constants():
    """Return, for each model and integrator, whether node and settings give the same bits, and which parameters act."""
    result = {}
    for model in MODELS:
        for integrator in ("PATH", "CLASSIC"):
            expected = lit(lambda m=model: own(m), integrator)
            same = np.array_equal(lit(lambda m=model: grouped(m), integrator), expected)
            telling = []
            for name in parameters_of(model):
                changed = lit(lambda m=model, n=name: grouped(m, **{n: HALVES[n][1]}), integrator)
                telling.append([name, bool(np.any(changed != expected))])
            result[f"{model} {integrator}"] = {"same": bool(same), "telling": telling}
    return result


def _halves(tree, name):
    """Return the output of an image whose left and right half are the two values of a parameter."""
    pixels = np.ones((1, 2, 4))
    for column, value in enumerate(HALVES[name]):
        pixels[0, column, :3] = value
    node = tree.node("TexImage", image=make_image(name, pixels, linear=True), interpolation="Closest")
    return node.outputs["Color"]


def _floor(make, integrator):
    """Return two pixels of a floor of the material that make() returns, one on each half, under a lamp and a grey sky."""
    scene = stage.empty(width=4, height=4, samples=1)
    scene.lancer.integrator = integrator
    floor = stage.plane(2.0, make())
    layer = floor.data.uv_layers.new(name="UVMap")
    for loop, corner in zip(layer.data, floor.data.loops, strict=True):
        x, y, _ = floor.data.vertices[corner.vertex_index].co
        loop.uv = ((x + 1) / 2, (y + 1) / 2)
    stage.light(energy=POWER, location=LAMP, shadow_soft_size=0.0)
    stage.sky((SKY,) * 3)
    stage.camera(EYE, (0, 0, 0), type="ORTHO", ortho_scale=2.0)
    return stage.picture(scene)[1, 1:3, :3].tolist()


def textures():
    """Return, for each model and parameter, the two pixels with a texture in that socket; of PATH also with constants."""
    pixels = {}
    for model in MODELS:
        for name in parameters_of(model):

            def textured(model=model, name=name):
                tree = Tree(model)
                node = node_of(tree, model)
                tree.tree.links.new(_halves(tree, name), node.inputs[PARAMETERS[name].socket])
                return tree.show(node.outputs[0])

            found = {integrator: _floor(textured, integrator) for integrator in ("CLASSIC", "PATH")}
            plain = [_floor(lambda m=model, n=name, v=value: grouped(m, **{n: v}), "PATH") for value in HALVES[name]]
            found["PATH of constants"] = [plain[0][0], plain[1][1]]
            pixels[f"{model} {name}"] = found
    stage_told = {"power": POWER, "lamp": LAMP, "eye": EYE, "sky": SKY}
    return {"values": VALUES, "halves": HALVES, "stage": stage_told, "pixels": pixels}


def normals():
    """Link a node that bends the normal to the model's own socket."""
    stage.empty()
    materials = []
    for model in MODELS:
        tree = Tree(model)
        node = node_of(tree, model)
        tree.tree.links.new(tree.node("Bump", Height=tree.varying()).outputs["Normal"], node.inputs["Normal"])
        materials.append(tree.show(node.outputs[0]))
    return answer(*materials)


def mixed():
    """Mix a quarter of a model with a diffuse BSDF; put the model into another group, whose input is the model's colour."""
    stage.empty()
    tree = Tree("mixed")
    diffuse = tree.node("BsdfDiffuse", Color=(1.0, 1.0, 1.0)).outputs[0]
    shader = tree.shaders("MixShader", diffuse, node_of(tree, "PHONG").outputs[0])
    shader.node.inputs[0].default_value = 0.25
    mixed = tree.show(shader)
    outer = bpy.data.node_groups.new("Outer", "ShaderNodeTree")
    course_groups._add_socket(outer, "Paint", "Color")
    course_groups._add_socket(outer, "Shader", "Shader", "OUTPUT")
    start, end = outer.nodes.new("NodeGroupInput"), outer.nodes.new("NodeGroupOutput")
    inner = outer.nodes.new("ShaderNodeGroup")
    inner.node_tree = course_groups.group_of("PHONG")
    outer.links.new(start.outputs["Paint"], inner.inputs["Diffuse"])
    outer.links.new(inner.outputs[0], end.inputs[0])
    tree = Tree("nested")
    nested = tree.show(tree.node("Group", node_tree=outer, Paint=(0.25, 0.5, 0.75)).outputs[0])
    return answer(mixed, nested)


def identity():
    """Rename, copy and change groups: which does the add-on reuse, and which does the exporter read as a model?"""
    stage.empty()
    first = course_groups.group_of("PHONG")
    first.name = "Something else"
    reused = course_groups.group_of("PHONG") == first
    copied = Tree("copied")
    node = node_of(copied, "PHONG")
    node.node_tree = first.copy()
    copied.show(node.outputs[0])
    changed = Tree("changed")
    node = node_of(changed, "PHONG")
    node.node_tree = first.copy()
    links = node.node_tree.links
    links.remove(next(link for link in links if link.from_node.name == "Body"))
    changed.show(node.outputs[0])
    # The only group of the model is a changed one: a new node gets an unchanged one.
    for tree in [tree for tree in bpy.data.node_groups if tree != node.node_tree]:
        bpy.data.node_groups.remove(tree)
    fresh = course_groups.group_of("PHONG") != node.node_tree
    unknown = Tree("of a version to come")
    node = node_of(unknown, "PHONG")
    node.node_tree = node.node_tree.copy()
    node.node_tree[TAG] = "WARD"
    unknown.show(node.outputs[0])
    poor = Tree("poor")
    node = node_of(poor, "PHONG")
    node.node_tree = node.node_tree.copy()
    inputs = node.node_tree.inputs if course_groups._OLD else node.node_tree.interface
    socket = (inputs if course_groups._OLD else inputs.items_tree)["Shininess"]
    inputs.remove(socket)
    poor.show(node.outputs[0])
    found = answer(changed.material, unknown.material, poor.material)
    return {**found, "reused": reused, "fresh": fresh}


def save(path):
    """Save a file with each model, which other Blenders open."""
    stage.empty()
    for model in MODELS:
        grouped(model).use_fake_user = True
    bpy.ops.wm.save_as_mainfile(filepath=path)
    return True


def opened(path, how):
    """Return the models of a file that is opened, or appended or linked into an empty one."""
    stage.empty()
    if how == "open":
        bpy.ops.wm.open_mainfile(filepath=path)
    else:
        with bpy.data.libraries.load(path, link=how == "link") as (there, here):
            here.materials = list(there.materials)
    found = answer(*[bpy.data.materials[model] for model in MODELS])
    # New nodes do not use linked groups.
    local = [course_groups.group_of(model).library is None for model in MODELS]
    return {**found, "local": local, "groups": len(bpy.data.node_groups)}


def widths():
    """The factor of Phong's exponent in the nodes that show its group, by which the lobe is as wide as Blinn-Phong's."""
    nodes = course_groups.group_of("PHONG").nodes
    return [float(nodes["Blinn's Exponent"].inputs[1].default_value), nodes["Blinn's Exponent"].operation]


def cycles():
    """Return Cycles' mean of a ball of each model, and how much the parameters of the highlight change it."""
    result = {}
    for model in MODELS:
        means = []
        for values in ({}, {name: HALVES[name][0] for name in parameters_of(model)}):
            scene = stage.room(engine="LANCER", width=24, height=24)
            stage.ball(1.0, grouped(model, **values), location=(0, 0, 1.2))
            scene.render.engine = "CYCLES"
            scene.cycles.samples, scene.cycles.use_denoising = 16, False
            means.append(stage.picture(scene)[..., :3].mean(axis=(0, 1)).tolist())
        result[model] = means
    return result


def _editing(tree):
    """Show a tree in the node editor of Blender's window. Return the arguments of bpy.context.temp_override."""
    window = bpy.context.window_manager.windows[0]
    area = max(window.screen.areas, key=lambda area: area.width * area.height)
    area.type = "NODE_EDITOR"
    space = area.spaces.active
    space.tree_type, space.pin, space.node_tree = "ShaderNodeTree", True, tree
    return {"window": window, "area": area, "region": area.regions[-1]}


def editor():
    """Run the operator and draw its menu."""
    scene = stage.empty()
    tree = Tree("edited")
    place = _editing(tree.tree)
    space = place["area"].spaces.active
    found = {"models": list(MODELS)}
    with bpy.context.temp_override(**place):
        for model in MODELS:
            bpy.ops.lancer.add_model(model=model)
            bpy.ops.lancer.add_model(model=model)
        added = [node for node in tree.tree.nodes if node.type == "GROUP"]
        found["added"] = [node.node_tree[TAG] for node in added]
        found["selected"] = [node.name for node in tree.tree.nodes if node.select] == [added[-1].name]
        found["trees"] = len(bpy.data.node_groups)
        found["menu"] = _entries(bpy.context)
        scene.render.engine = "CYCLES"
        found["menu of Cycles"] = _entries(bpy.context)
        scene.render.engine = "LANCER"
        space.node_tree = added[0].node_tree
        try:
            found["inside"] = list(bpy.ops.lancer.add_model(model="PHONG"))
        except RuntimeError as error:
            found["inside"] = str(error)
        space.node_tree = None
        found["nothing edited"] = bpy.ops.lancer.add_model.poll()
    return found


def undo():
    """Return the number of groups after the operator, after one undo, and after one redo."""
    stage.empty()
    material = Tree("undone").material
    material.use_fake_user = True
    bpy.ops.ed.undo_push(message="before")
    with bpy.context.temp_override(**_editing(material.node_tree)):
        bpy.ops.lancer.add_model("EXEC_DEFAULT", True, model="PHONG")
    found = [len(bpy.data.node_groups)]
    for step in (bpy.ops.ed.undo, bpy.ops.ed.redo):
        step()
        nodes = bpy.data.materials["undone"].node_tree.nodes
        found.append(len(bpy.data.node_groups) + sum(node.type == "GROUP" for node in nodes) - 1)
    return found


def _entries(context):
    """Return the menus that the add-on appends to Add, and the operators in them."""
    shown = []

    class Layout:
        def menu(self, name, **_):
            shown.append(name)
            getattr(bpy.types, name).draw(types.SimpleNamespace(layout=self), context)

        def operator(self, name, text=""):
            shown.append(text)
            return types.SimpleNamespace()

    course_groups._draw_entry(types.SimpleNamespace(layout=Layout()), context)
    return shown
