"""Pictures of every tab of the Properties editor, as an artist sees it, with all of Lancer's panels open.

    xvfb-run -s "-screen 0 1920x2400x24" blender --factory-startup -p 0 0 1920 2400 -P window_tabs.py -- FOLDER [NAME...]

writes FOLDER/NAME.png for each of the names, all of them by default, and ends Blender. Seconds of patience for a slow display
are in LANCER_TABS_WAIT (1.5).
"""

import os
import subprocess
import sys
import traceback

import bpy

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [os.path.dirname(os.path.dirname(os.path.dirname(HERE))), HERE]

import stage  # noqa: E402

import addon  # noqa: E402
from addon import ui  # noqa: E402

FOLDER, *NAMES = sys.argv[sys.argv.index("--") + 1 :]
WAIT = float(os.environ.get("LANCER_TABS_WAIT", "1.5"))


def show(name):
    thing = bpy.data.objects[name]
    bpy.context.view_layer.objects.active = thing
    return thing


def a_render():
    bpy.ops.render.render()
    bpy.ops.lancer.check_scene()
    bpy.ops.lancer.measure_quality(seconds=1.0)


def a_cube():
    bpy.context.scene.world.lancer.use_cube = True


def a_bare_object():
    show("Bare")


def editing():
    show("Cube")
    bpy.ops.object.mode_set(mode="EDIT")


def a_loss():
    bpy.ops.object.mode_set(mode="OBJECT")
    tree = show("Cube").active_material.node_tree
    body = next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")
    unknown = stage.unknown(tree)
    tree.links.new(unknown.outputs["Fac"], body.inputs["Roughness"])


def a_model():
    show("Cube").active_material.lancer.model = "PHONG"


def a_panorama():
    camera = show("Camera").data
    camera.type = "PANO"
    owner = camera if hasattr(camera, "panorama_type") else camera.cycles
    owner.panorama_type = "EQUIRECTANGULAR"


def a_lamp(kind):
    def chosen():
        show("Light").data.type = kind

    return chosen


# (name, tab, preparation or None) in this order.
TABS = (
    ("render", "RENDER", None),
    ("render_after", "RENDER", a_render),
    ("output", "OUTPUT", None),
    ("view_layer", "VIEW_LAYER", None),
    ("scene", "SCENE", None),
    ("world", "WORLD", None),
    ("world_cube", "WORLD", a_cube),
    ("object", "OBJECT", lambda: show("Cube")),
    ("object_light", "OBJECT", lambda: show("Light")),
    ("material_none", "MATERIAL", a_bare_object),
    ("material_edit", "MATERIAL", editing),
    ("material_loss", "MATERIAL", a_loss),
    ("material_model", "MATERIAL", a_model),
    ("mesh", "DATA", lambda: show("Cube")),
    ("camera", "DATA", lambda: show("Camera")),
    ("camera_panorama", "DATA", a_panorama),
    ("light_point", "DATA", a_lamp("POINT")),
    ("light_sun", "DATA", a_lamp("SUN")),
    ("light_spot", "DATA", a_lamp("SPOT")),
    ("light_area", "DATA", a_lamp("AREA")),
)


def build():
    scene = bpy.context.scene
    for item in list(bpy.data.objects):
        bpy.data.objects.remove(item)
    stage.plane(material=stage.shader(name="Floor"))
    stage.cube(material=stage.shader("ShaderNodeBsdfPrincipled", "Paint"), location=(0, 0, 0.5))
    stage.ball(0.3, location=(1, 0, 0.3)).name = "Bare"
    stage.light().data.use_nodes = True
    stage.sky()
    stage.camera()
    scene.render.engine = "LANCER"
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 64, 48, 100
    scene.lancer.samples = 16


def properties():
    window = bpy.context.window_manager.windows[0]
    return window, next(area for area in window.screen.areas if area.type == "PROPERTIES")


def photograph(window, area, path):
    """Save a screenshot by ImageMagick: on such a display Blender's own screenshots are black in some of its versions."""
    part = f"{area.width}x{area.height}+{area.x}+{window.height - area.y - area.height}"
    subprocess.run(["import", "-window", "root", "-crop", part, "+repage", path], check=True)


def walk():
    """Show one tab after the other, and save a screenshot of each after the time it needs to draw."""
    window, area = properties()
    for other in window.screen.areas:
        if other.type == "VIEW_3D":
            # Without a graphics card a 3D view takes seconds to draw.
            other.type = "CONSOLE"
    # The Outliner takes space that tall tabs need.
    outliner = next(other for other in window.screen.areas if other.type == "OUTLINER")
    with bpy.context.temp_override(window=window, area=outliner, region=outliner.regions[-1]):
        bpy.ops.screen.area_close()
    yield
    for name, tab, prepare in TABS:
        if prepare is not None:
            with bpy.context.temp_override(window=window):
                prepare()
        if NAMES and name not in NAMES:
            continue
        # Areas move when others close, and a drawing updates which tabs there are.
        window, area = properties()
        area.tag_redraw()
        yield
        area.spaces.active.context = tab
        area.tag_redraw()
        yield
        photograph(window, area, os.path.join(FOLDER, name + ".png"))


def tick(steps=walk()):  # noqa: B008 - one walk for the life of the timer
    try:
        next(steps)
        return WAIT
    except StopIteration:
        pass
    except Exception:
        traceback.print_exc()
    addon.unregister()
    bpy.ops.wm.quit_blender()
    return None


for cls in ui.CLASSES:
    cls.bl_options = set(getattr(cls, "bl_options", ())) - {"DEFAULT_CLOSED"}
addon.register()
build()
bpy.context.preferences.view.show_splash = False
bpy.app.timers.register(tick, first_interval=2 * WAIT)
