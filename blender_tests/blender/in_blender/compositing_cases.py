"""One compositing script for both engines: four view layers, mattes, light groups, a catcher, and denoising of each group."""

import bpy
import stage
from joined_cases import composite_input, compositor

_SIZE, _SAMPLES, _BLOCK = 32, 128, 8
_SEEDS = (1, 2, 3)
# The collection that each view layer shows.
_LAYERS = {"Set": "Set", "Hero": "Hero", "Ground": "Hero and ground", "Lamps": "Hero"}


def _collection(scene, *things):
    made = bpy.data.collections.new("Part")
    scene.collection.children.link(made)
    for thing in things:
        scene.collection.objects.unlink(thing)
        made.objects.link(thing)
    return made


def _scene():
    """Build a wall, a ball and a cube over a floor that catches their shadows, between two lamps of their own groups."""
    scene = stage.empty(_SIZE, _SIZE, _SAMPLES)
    scene.cycles.samples, scene.cycles.use_adaptive_sampling, scene.cycles.use_denoising = _SAMPLES, False, False
    scene.cycles.filter_width = 1.0
    scene.render.film_transparent = True
    wall = stage.plane(8.0, stage.shader(name="Wall", Color=(0.5, 0.6, 0.3)), location=(0, 3, 0), rotation=(1.4, 0, 0))
    ball = stage.ball(0.8, stage.shader(name="Red", Color=(0.8, 0.2, 0.1)))
    ball.name, ball.location = "Ball", (-0.7, 0.0, 0.8)
    cube = stage.cube(0.9, stage.shader(name="Blue", Color=(0.1, 0.3, 0.8)), location=(0.9, 0.1, 0.45), rotation=(0, 0, 0.4))
    ground = stage.plane(8.0, stage.shader(name="Ground"))
    ground.is_shadow_catcher = True
    key = stage.light("AREA", 150.0, (2.0, -3.0, 3.0), (0.8, 0.0, 0.6))
    fill = stage.light("POINT", 60.0, (-3.0, -2.0, 2.0))
    stage.sky(strength=0.3)
    stage.camera()
    key.lightgroup, fill.lightgroup = "Key", "Fill"
    parts = {"Set": _collection(scene, wall), "Hero": _collection(scene, ball, cube), "Ground": _collection(scene, ground)}
    first = scene.view_layers[0]
    for number, (name, shown) in enumerate(_LAYERS.items()):
        layer = first if number == 0 else scene.view_layers.new(name)
        layer.name = name
        for part, collection in parts.items():
            layer.layer_collection.children[collection.name].exclude = part.lower() not in shown.lower()
    scene.view_layers["Hero"].use_pass_cryptomatte_object = True
    scene.view_layers["Ground"].cycles.use_pass_shadow_catcher = True
    lamps = scene.view_layers["Lamps"]
    lamps.cycles.denoising_store_passes = True
    for name in ("Key", "Fill"):
        lamps.lightgroups.add(name=name)
    return scene


class _Script:
    """The nodes that composite the layers; the same for both engines."""

    def __init__(self, scene):
        self.scene, self.tree = scene, compositor(scene)
        self.nodes, self.links = self.tree.nodes, self.tree.links
        self.matte = None

    def mixed(self, how, first, second):
        """Return the mix of two outputs, or of an output and a colour."""
        is_new = bpy.app.version >= (5, 0)
        node = self.nodes.new("ShaderNodeMix" if is_new else "CompositorNodeMixRGB")
        node.blend_type = how
        if is_new:
            node.data_type = "RGBA"
            inputs = {socket.identifier: socket for socket in node.inputs}
            factor, a, b = (inputs[name] for name in ("Factor_Float", "A_Color", "B_Color"))
            out = next(socket for socket in node.outputs if socket.identifier == "Result_Color")
        else:
            (factor, a, b), out = node.inputs, node.outputs[0]
        factor.default_value = 1.0
        for source, target in ((first, a), (second, b)):
            if isinstance(source, tuple):
                target.default_value = source
            else:
                self.links.new(source, target)
        return out

    def layer(self, name):
        node = self.nodes.new("CompositorNodeRLayers")
        node.scene, node.layer = self.scene, name
        return {socket.name: socket for socket in node.outputs if socket.enabled}

    def denoised(self, light, layer):
        node = self.nodes.new("CompositorNodeDenoise")
        self.links.new(light, node.inputs["Image"])
        for guide in ("Normal", "Albedo"):
            self.links.new(layer[f"Denoising {guide}"], node.inputs[guide])
        return node.outputs["Image"]

    def over(self, below, above):
        node = self.nodes.new("CompositorNodeAlphaOver")
        images = [socket for socket in node.inputs if socket.type == "RGBA"]
        self.links.new(below, images[0])
        self.links.new(above, images[1])
        return node.outputs["Image"]

    def build(self):
        lamps = self.layer("Lamps")
        groups = {name: self.denoised(lamps[f"Combined_{name}"], lamps) for name in ("Key", "Fill")}
        relit = self.mixed("ADD", self.mixed("MULTIPLY", groups["Key"], (0.5, 0.7, 1.0, 1.0)), groups["Fill"])
        behind = self.mixed("MULTIPLY", self.layer("Set")["Image"], self.layer("Ground")["Shadow Catcher"])
        whole = self.over(behind, self.layer("Hero")["Image"])
        self.matte = self.nodes.new("CompositorNodeCryptomatteV2")
        self.matte.source, self.matte.scene, self.matte.layer_name = "RENDER", self.scene, "Hero.CryptoObject"
        self.links.new(self.layer("Hero")["Image"], self.matte.inputs["Image"])
        tinted = self.mixed("MULTIPLY", self.matte.outputs["Matte"], (0.1, 0.3, 0.1, 1.0))
        self.links.new(self.mixed("ADD", self.mixed("ADD", whole, relit), tinted), composite_input(self.tree))


def both():
    """Return the means of the blocks of the composite, [engine][seed][block][channel], and those of the matte's share."""
    scene = _scene()
    script = _Script(scene)
    script.build()
    found = {}
    for engine in ("LANCER", "CYCLES"):
        scene.render.engine = engine
        scene.lancer.samples = scene.cycles.samples = 1
        # The node knows the names once a render has told the manifest.
        bpy.ops.render.render()
        script.matte.matte_id = "Ball"
        scene.lancer.samples = scene.cycles.samples = _SAMPLES
        found[engine] = []
        for seed in _SEEDS:
            scene.lancer.seed = scene.cycles.seed = seed
            found[engine].append(_blocks(stage.picture(scene)[..., :3]))
    script.matte.matte_id = ""
    without = _blocks(stage.picture(scene)[..., :3])
    return {"pictures": found, "without": without}


def _blocks(picture):
    side = _SIZE // _BLOCK
    return picture.reshape(side, _BLOCK, side, _BLOCK, 3).astype(float).mean(axis=(1, 3)).reshape(-1, 3).tolist()
