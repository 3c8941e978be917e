"""Flaws as artists build them: F12 warns of them, and Check Scene lists them."""

import bpy
import stage

_BOX = [(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (0.5, 1.5)]
_SIDES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]


def _glass(**inputs):
    return stage.shader("ShaderNodeBsdfGlass", "Glass", **inputs)


def _add(shader, other):
    """Return a material whose Add Shader adds these two nodes."""
    material = stage.shader(shader, "Sum")
    tree = material.node_tree
    first = next(node for node in tree.nodes if node.type != "OUTPUT_MATERIAL")
    output = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
    second, total = tree.nodes.new(other), tree.nodes.new("ShaderNodeAddShader")
    tree.links.new(first.outputs[0], total.inputs[0])
    tree.links.new(second.outputs[0], total.inputs[1])
    tree.links.new(total.outputs[0], output.inputs["Surface"])
    return material


def _painted(value):
    """Return a material whose colour is a picture of one value."""
    picture = bpy.data.images.new("Paint", 8, 8, float_buffer=True)
    picture.pixels.foreach_set([value, value, value, 1.0] * 64)
    material = stage.shader(name="Painted")
    tree = material.node_tree
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image = picture
    diffuse = next(other for other in tree.nodes if other.type == "BSDF_DIFFUSE")
    tree.links.new(node.outputs["Color"], diffuse.inputs["Color"])
    return material


def _smooth(item):
    item.data.polygons.foreach_set("use_smooth", [True] * len(item.data.polygons))
    return item


def _flip_some(item):
    """Replace the mesh by one of which every seventh face is flipped."""
    data = item.data
    faces = [list(face.vertices)[:: -1 if number % 7 == 0 else 1] for number, face in enumerate(data.polygons)]
    return _smooth(stage.mesh("Flipped", [vertex.co for vertex in data.vertices], faces, location=(0, 0, 1)))


def _far(radius, x):
    """Return a ball whose vertices are moved along x, while its origin stays at the world's."""
    item = stage.ball(radius, segments=16)
    for vertex in item.data.vertices:
        vertex.co.x += x
    item.data.update()
    return item


# name: (builder of the flaw, builder of the same without it); each builder adds to a lit room without a cube.
_FLAWS = {
    "open glass": (
        lambda: stage.mesh("Thing", _BOX, _SIDES[:5], _glass()),
        lambda: stage.mesh("Thing", _BOX, _SIDES, _glass()),
    ),
    "glass inside out": (
        lambda: stage.mesh("Thing", _BOX, [side[::-1] for side in _SIDES], _glass()),
        lambda: stage.mesh("Thing", _BOX, [side[::-1] for side in _SIDES], stage.shader()),
    ),
    "two planes": (
        lambda: stage.plane(3.0, stage.shader(Color=(0.8, 0.1, 0.1))),
        lambda: stage.plane(3.0, stage.shader(Color=(0.8, 0.1, 0.1)), location=(0, 0, 1e-4)),
    ),
    "glass on glass": (
        lambda: [stage.cube(1.0, _glass(), location=(0, 0, z)) for z in (1.5, 2.5)],
        lambda: [stage.cube(1.0, _glass(), location=(0, 0, z)) for z in (1.5, 2.75)],
    ),
    "copy in place": (
        lambda: [stage.ball(location=(0, 0, 1)) for _ in range(2)],
        lambda: [stage.ball(location=(0, x, 1)) for x in range(2)],
    ),
    "flipped faces": (
        lambda: _flip_some(stage.ball(location=(3, 0, 1))),
        lambda: _smooth(stage.cube(location=(0, 0, 1))),
    ),
    "far from the origin": (lambda: _far(1.0, 1e6), lambda: _far(1.0, 1e3)),
    "tiny in its place": (
        lambda: stage.ball(1.0, location=(1e8, 0, 0)),
        lambda: stage.ball(1.0, location=(1e4, 0, 0)),
    ),
    "light that grows": (
        lambda: stage.ball(material=_add("ShaderNodeBsdfDiffuse", "ShaderNodeBsdfGlossy"), location=(0, 0, 1.5)),
        lambda: stage.ball(material=_add("ShaderNodeBsdfDiffuse", "ShaderNodeEmission"), location=(0, 0, 1.5)),
    ),
    "picture beyond white": (
        lambda: stage.ball(material=_painted(2.0), location=(0, 0, 1.5)),
        lambda: stage.ball(material=_painted(0.5), location=(0, 0, 1.5)),
    ),
    "invisible glass": (
        lambda: stage.ball(material=_glass(IOR=1.0), location=(0, 0, 1.5)),
        lambda: stage.ball(material=_glass(IOR=1.1), location=(0, 0, 1.5)),
    ),
}


def _room():
    scene = stage.empty(samples=1, width=8, height=8)
    stage.plane(material=stage.shader(Color=(0.6, 0.6, 0.6)))
    stage.light()
    stage.camera()
    return scene


def _findings():
    from addon.operators import check_scene

    scene = bpy.context.scene
    before = bpy.context.view_layer.objects.active
    assert bpy.ops.lancer.check_scene() == {"FINISHED"}
    assert bpy.context.view_layer.objects.active == before
    return [(finding.kind, finding.severity.name, finding.object) for finding in check_scene.last_findings[scene.name]]


def _told():
    from addon.engine import render_engine as engine

    bpy.ops.render.render()
    return list(engine.last_messages[bpy.context.scene.name])


def flaws():
    """Return {name: [(findings, messages of F12) with the flaw, the same without it]}."""
    result = {}
    for name, builders in _FLAWS.items():
        result[name] = []
        for build in builders:
            _room()
            build()
            result[name].append((_findings(), _told()))
    return result


def switches():
    """Return whether F12 obeys its switch, whether Check Scene skips hidden objects, and the results of its buttons."""
    from addon.operators import check_scene

    scene = _room()
    thing = _FLAWS["open glass"][0]()
    result = {"on": _told()}
    scene.lancer.use_check = False
    result["off"], result["asked"] = _told(), _findings()
    thing.hide_render = True
    result["hidden"] = _findings()
    thing.hide_render = False
    result["selected"] = []
    for name in ("Thing", "Camera"):
        bpy.ops.lancer.select_object(name=name)
        active = bpy.context.view_layer.objects.active.name
        result["selected"].append((active, [item.name for item in bpy.context.view_layer.objects if item.select_get()]))
    bpy.ops.lancer.select_object(name="Thing")
    bpy.ops.object.mode_set(mode="EDIT")
    result["modes"] = []
    for name in ("Thing", "Camera"):
        bpy.ops.lancer.select_object(name=name)
        result["modes"].append(bpy.data.objects["Thing"].mode)
    result["nobody"] = sorted(bpy.ops.lancer.select_object(name="Nobody"))
    bpy.context.scene.camera = None
    try:
        bpy.ops.lancer.check_scene()
        result["without camera"] = ""
    except RuntimeError as error:
        result["without camera"] = str(error)
    result["kept"] = [finding.object for finding in check_scene.last_findings[scene.name]]
    return result


def failing():
    """Make the check raise. Return the messages of F12, and the mean of its picture."""
    from addon import engine
    from addon.engine import quick_check

    scene = _room()

    def fail(*_, **__):
        raise ValueError("no such edge")

    good, quick_check.check_snapshot = quick_check.check_snapshot, fail
    try:
        messages = _told()
    finally:
        quick_check.check_snapshot = good
    return {"messages": messages, "samples": engine.last_statistics[scene.name]["samples"]}


def _monkey():
    bpy.ops.mesh.primitive_monkey_add(location=(0, 0, 1))
    bpy.ops.object.shade_smooth()


def _letters():
    bpy.ops.object.text_add(location=(-2, 0, 1))
    text = bpy.context.object.data
    text.body, text.extrude, text.bevel_depth, text.bevel_resolution = "Lancer @&8", 0.1, 0.04, 3


def smooth():
    """Return {name: {lamp: (findings, messages of F12)}} of Blender's own objects, smooth across sharp folds."""
    result = {}
    for name, build in (("monkey", _monkey), ("letters", _letters)):
        result[name] = {}
        for lamp in ("POINT", "AREA"):
            _room()
            bpy.data.lights["Light"].type = lamp
            build()
            result[name][lamp] = (_findings(), _told())
    return result
