"""Light below surfaces: each method, its inputs, and objects that are thin, open, hollow, or placed many times."""

import bpy

from .. import parts
from .catalogue import case, variants
from .nodes import material, principled, shader
from .stages import ball, camera, floor, lamp, sky, studio

_SKIN = (0.8, 0.5, 0.35)
_RADIUS = (0.5, 0.2, 0.1)
_KIND = "ShaderNodeSubsurfaceScattering"
# Names of the methods: before 4.0 Random Walk, now Skin, was another one.
_WALK = "RANDOM_WALK_FIXED_RADIUS" if bpy.app.version < (4, 0) else "RANDOM_WALK"
_SKIN_WALK = "RANDOM_WALK" if bpy.app.version < (4, 0) else "RANDOM_WALK_SKIN"


def _wax(method=_WALK, **inputs):
    return shader(_KIND, {"falloff": method}, **{"Color": _SKIN, "Radius": _RADIUS, "Scale": 1.0, **inputs})


@variants(
    "LOBES",
    values={
        "burley": "BURLEY",
        "walk": _WALK,
        "skin": (_SKIN_WALK),
        "legacy": ("RANDOM_WALK_LEGACY", {"since": (5, 2)}),
    },
)
def subsurface_method(scene, method):
    studio(scene, _wax(method))


@variants("LOBES", values={"small": 0.02, "wide": 5.0, "vast": 1000.0})
def subsurface_scale(scene, scale):
    studio(scene, _wax(Scale=scale))


@variants("LOBES", values={"burley": "BURLEY", "walk": (_WALK, {"quick": True}), "skin": (_SKIN_WALK, {"quick": True})})
def subsurface_one_channel(scene, method):
    """Channels without a radius are diffuse."""
    studio(scene, _wax(method, Radius=(0.5, 0.0, 0.0)))


@variants("LOBES", values={"dark": (0.05, 0.02, 0.005), "white": (1.0, 1.0, 1.0), "red": (1.0, 0.1, 0.0)})
def subsurface_color(scene, color):
    studio(scene, _wax(Color=color))


@variants("LOBES", values={"forward": 0.8, "backward": (-0.6, {"since": (5, 2)})})
def subsurface_anisotropy(scene, g):
    studio(scene, _wax(Anisotropy=g))


@variants("LOBES", values={"low": 1.05, "high": 2.2})
def subsurface_ior(scene, ior):
    studio(scene, _wax(_SKIN_WALK, IOR=ior))


@variants("LOBES", values={"smooth": 0.0, "middle": 0.4}, since=(4, 2))
def subsurface_roughness(scene, roughness):
    studio(scene, _wax(Roughness=roughness))


@variants("LOBES", values={"burley": "BURLEY", "walk": _WALK})
def subsurface_bump(scene, method):
    def build(nodes):
        noise = nodes.add("ShaderNodeTexNoise", Scale=4.0)
        bump = nodes.add("ShaderNodeBump", Strength=0.8, Distance=0.3, Height=noise.outputs[0])
        inputs = {"Color": _SKIN, "Radius": _RADIUS, "Scale": 0.5, "Normal": bump}
        return nodes.add(_KIND, props={"falloff": method}, **inputs)

    studio(scene, material(build))


@variants("LOBES", values={"burley": "BURLEY", "walk": _WALK, "skin": _SKIN_WALK})
def subsurface_principled(scene, method):
    def build(nodes):
        inputs = {"Base_Color": _SKIN, "Roughness": 0.35, "Subsurface_Weight": 0.7, "Subsurface_Radius": _RADIUS}
        inputs |= {"Subsurface_Color": (0.9, 0.3, 0.2)} if bpy.app.version < (4, 0) else {"Subsurface_Scale": 1.0}
        return nodes.add("ShaderNodeBsdfPrincipled", props={"subsurface_method": method}, **inputs)

    studio(scene, material(build))


@case("LOBES")
def subsurface_below_a_coat(scene):
    coat = {"Coat_Weight": 0.8, "Coat_Roughness": 0.1} if bpy.app.version >= (4, 0) else {"Sheen_Weight": 0.8}
    scale = {"Subsurface_Scale": 1.0} if bpy.app.version >= (4, 0) else {"Subsurface_Color": _SKIN}
    inputs = {"Base_Color": _SKIN, "Subsurface_Weight": 1.0, "Subsurface_Radius": _RADIUS, **scale, **coat}
    studio(scene, principled(**inputs))


@case("LOBES")
def subsurface_varies(scene):
    """Colour and scale by a texture, mixed with gloss."""

    def build(nodes):
        checker = nodes.add("ShaderNodeTexChecker", Scale=3.0)
        wax = nodes.add(_KIND, props={"falloff": _WALK}, Color=checker.outputs[0], Radius=_RADIUS, Scale=checker.outputs[1])
        return nodes.add("ShaderNodeMixShader", 0.2, wax, nodes.add("ShaderNodeBsdfGlossy", Roughness=0.3))

    studio(scene, material(build))


def _light(scene):
    floor(scene)
    lamp(scene)
    sky(scene)
    camera(scene, (0, -4.2, 2.2), (0, 0, 0.85), lens=60.0)


@variants("LOBES", values={"burley": "BURLEY", "walk": _WALK})
def subsurface_placed_often(scene, method):
    """One mesh in three sizes and forms; the objects touch, but no path goes from one to another below their surfaces."""
    mesh, wax = parts.sphere_mesh("Ball", 48, 24), _wax(method)
    parts.place(scene, "Large", mesh, wax, (0.55, 0, 0.6), (0.6, 0.6, 0.6))
    parts.place(scene, "Flat", mesh, wax, (-0.6, 0, 0.6), (0.6, 0.5, 0.2), (0, 0.6, 0.2))
    parts.place(scene, "Mirrored", mesh, wax, (0, 0, 1.3), (-0.4, 0.4, 0.6), (0.4, 0, 0))
    _light(scene)


@variants("LOBES", values={"burley": "BURLEY", "walk": _WALK, "skin": _SKIN_WALK})
def subsurface_thin_and_open(scene, method):
    """A slab thinner than its radii, and an open half of a ball seen from both sides."""
    wax = _wax(method, Scale=0.3)
    slab = parts.place(scene, "Slab", parts.cube_mesh("Slab", 1.2), wax, (-0.5, 0.3, 0.9), (1, 0.04, 1), (0, 0, 0.5))
    slab.data.update()
    bowl = parts.lathe_mesh("Bowl", [(0.0, 0.0), (0.3, 0.05), (0.5, 0.25), (0.55, 0.5)])
    parts.place(scene, "Bowl", bowl, wax, (0.7, -0.2, 0.3), rotation=(0.5, 0.3, 0))
    _light(scene)


@case("LOBES")
def subsurface_ring(scene):
    """A concave object, whose parts shadow and reach one another."""
    parts.place(scene, "Ring", parts.torus_mesh("Ring", 0.8, 0.3), _wax(), (0, 0, 0.8), rotation=(1.0, 0, 0.3))
    _light(scene)


@case("LOBES", bounces=5)
def subsurface_after_diffuse(scene):
    """Walks behind diffuse reflection, which Cycles until 4.5, and for Burley's profile, takes as diffuse."""
    floor(scene, (0.8, 0.8, 0.8))
    ball(scene, _wax(Color=(0.9, 0.3, 0.2), Scale=2.0), 64, 0.7, (0.4, 0, 0.7))
    wall = shader("ShaderNodeBsdfDiffuse", Color=(0.8, 0.8, 0.8))
    parts.place(scene, "Wall", parts.plane_mesh("Wall", 3.0), wall, (-0.7, 0, 1), rotation=(0, 1.57, 0))
    lamp(scene, location=(3.5, -1.0, 2.5))
    camera(scene, (0.6, -4.2, 2.2), (0, 0, 0.6), lens=50.0)


@case("LOBES", passes=("Combined", "Diffuse Direct", "Diffuse Indirect", "Diffuse Color"))
def subsurface_passes(scene):
    studio(scene, _wax())
