"""What window_viewport.py does to a 3D view: generators that yield seconds of waiting and return what was seen."""

import gc
import math
import threading
import time

import bpy
import gpu
import memory_now
import numpy as np
import stage
from bpy_extras.view3d_utils import location_3d_to_region_2d
from mathutils import Matrix, Quaternion, Vector

import addon
from addon.bindings.session import Scene, Session
from addon.export.messages import Messages
from addon.export.scene import export_scene
from addon.export.view import Rectangle, export_view
from addon.viewport import viewport
from addon.viewport.canvas import Canvas

_LOOK = 0.05
_PATIENCE = 60.0
POINTS = [Vector(point) for point in ((0.3, 0.2, 0.1), (-0.8, 0.5, 0.4), (0.9, -0.7, 0.6), (0.1, 0.9, -0.3))]


class View:
    """The first 3D view of the first window."""

    def __init__(self):
        self.window = bpy.context.window_manager.windows[0]
        self.area = next(area for area in self.window.screen.areas if area.type == "VIEW_3D")
        self.region = next(region for region in self.area.regions if region.type == "WINDOW")
        self.space = self.area.spaces.active
        self.data = self.space.region_3d

    def override(self):
        """For a moment: Blender's own loop reads such a context without Python's lock."""
        return bpy.context.temp_override(window=self.window, screen=self.window.screen, area=self.area, region=self.region)

    def render(self):
        self.space.shading.type = "RENDERED"
        self.space.overlay.show_overlays = False
        self.space.show_gizmo = False


def build(samples=8):
    """Three things of three colours on a floor, under a lamp and a sky."""
    scene = stage.empty(160, 120)
    stage.plane(8.0, stage.shader(Color=(0.6, 0.6, 0.6)))
    stage.cube(0.8, stage.shader(Color=(0.8, 0.1, 0.1)), location=(-1, 0, 0.4))
    stage.ball(0.5, stage.shader(Color=(0.1, 0.8, 0.1)), location=(1, 0, 0.5))
    stage.cube(0.4, stage.shader("ShaderNodeEmission", Color=(0.1, 0.1, 0.9)), location=(0, 1, 1))
    stage.light("POINT", 200.0, (2, -3, 4))
    stage.sky()
    stage.camera()
    scene.lancer.preview_samples = samples
    return scene


def shown():
    """The Viewport that is open, or None."""
    return next(iter(viewport._open), None)


def until(condition, patience=_PATIENCE):
    """Waits; whether it has come true."""
    limit = time.monotonic() + patience
    while not condition():
        if time.monotonic() > limit:
            return False
        yield _LOOK
    return True


def finished():
    """Whether all samples of what is shown are there."""
    view = shown()
    if view is None or view.painter.picture is None or view._wanted is None:
        return False
    picture = view.painter.picture
    wanted = view._wanted
    return picture.wanted is wanted and picture.size == wanted.finest and picture.samples == wanted.settings.samples


def left():
    """What is open of the library, and threads of our own."""
    gc.collect()
    handles = [thing for thing in gc.get_objects() if type(thing) in (Scene, Session)]
    things = [type(handle).__name__ for handle in handles if handle._finalizer.alive]
    return things + [thread.name for thread in threading.enumerate() if "lancer" in thread.name]


# ---- where points of the scene lie in the picture -----------------------------------------------------------------------


def _raster(view, point):
    """The pixel of the region at which a View's camera shows a point, by the definitions of lancer.h."""
    camera = view.camera
    local = np.linalg.inv(np.vstack([camera.matrix, [0, 0, 0, 1]])) @ (*point, 1.0)
    x, y = local[:2] / -local[2] if camera.kind == 0 else local[:2]
    left, right, bottom, top = camera.window
    rectangle = view.rectangle
    return (
        rectangle.x + (x - left) / (right - left) * rectangle.width,
        rectangle.y + (y - bottom) / (top - bottom) * rectangle.height,
    )


def _free(view):
    view.data.view_perspective = "PERSP"


def _turned(view):
    view.data.view_rotation = Quaternion((0.3, 1.0, 0.2), 0.9)
    view.data.view_distance = 6.0


def _orthographic(view):
    view.data.view_perspective = "ORTHO"


def _lens(view):
    view.data.view_perspective = "PERSP"
    view.space.lens = 85.0


def _border(view):
    view.space.use_render_border = True
    view.space.render_border_min_x, view.space.render_border_max_x = 0.2, 0.7
    view.space.render_border_min_y, view.space.render_border_max_y = 0.3, 0.9


def _camera(view):
    view.space.use_render_border = False
    view.data.view_perspective = "CAMERA"


def _zoomed(view):
    view.data.view_camera_zoom = 40.0
    view.data.view_camera_offset = (0.1, -0.05)


def _shifted(view):
    data = bpy.context.scene.camera.data
    data.shift_x, data.shift_y, data.sensor_fit = 0.2, -0.1, "VERTICAL"


def _portrait(view):
    render = bpy.context.scene.render
    render.resolution_x, render.resolution_y, render.pixel_aspect_y = 90, 200, 1.5


def _camera_border(view):
    render = bpy.context.scene.render
    render.use_border = True
    render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y = 0.25, 0.75, 0.1, 0.6


def _camera_orthographic(view):
    bpy.context.scene.camera.data.type = "ORTHO"


VIEWS = (
    _free, _turned, _orthographic, _lens, _border, _camera, _zoomed, _shifted, _portrait, _camera_border, _camera_orthographic,
)  # fmt: skip


def places(folder):
    """{view: largest distance in pixels between where Blender and our camera see four points, rectangle, whole region}"""
    scene = build()
    view = View()
    result = {}
    for change in VIEWS:
        change(view)
        yield 0.3
        depsgraph = bpy.context.evaluated_depsgraph_get()
        got = export_view(view.region, view.data, view.space, depsgraph, Messages())
        far = 0.0
        for point in POINTS:
            theirs = location_3d_to_region_2d(view.region, view.data, point)
            far = max(far, math.dist(theirs, _raster(got, point)))
        result[change.__name__.strip("_")] = far, *got.rectangle, view.region.width, view.region.height
    assert scene.camera is not None
    return result


# ---- what is shown --------------------------------------------------------------------------------------------------


class _Record:
    """Notes each drawing: when, by which generation of the scene, how fine, how many samples."""

    def __init__(self):
        self.draws = []
        self._plain = viewport.Viewport.draw

    def __enter__(self):
        record, plain = self, self._plain

        def draw(self, context, depsgraph):
            plain(self, context, depsgraph)
            picture = self._drawn[0]
            record.draws.append((time.monotonic(), picture, self._text(picture)))

        viewport.Viewport.draw = draw
        return self

    def __exit__(self, *_):
        viewport.Viewport.draw = self._plain


def refining(folder):
    """From the first picture to the last: sizes and samples of what was drawn, and the last text."""
    build(samples=16)
    view = View()
    with _Record() as record:
        view.render()
        done = yield from until(finished)
        yield 0.2
    drawn = [(picture.size, picture.samples) for _, picture, _ in record.draws if picture is not None]
    return {"done": done, "drawn": drawn, "texts": [text for *_, text in record.draws]}


def edits(folder):
    """After each edit: whether something was always shown, never again what was before, and how much the picture changed."""
    scene = build(samples=4)
    view = View()
    view.render()
    yield from until(finished)
    ball, body = bpy.data.objects["Ball"], bpy.data.objects["Cube"]
    material = ball.active_material.node_tree.nodes

    def color():
        next(node for node in material if node.type == "BSDF_DIFFUSE").inputs["Color"].default_value = (0.9, 0.9, 0.1, 1)

    def mesh():
        body.data.vertices[0].co.x -= 0.5
        body.data.update()

    changes = {
        "moved": lambda: setattr(ball, "location", (1, 1, 0.5)),
        "coloured": color,
        "bent": mesh,
        "brighter": lambda: setattr(bpy.data.objects["Light"].data, "energy", 800.0),
        "film": lambda: setattr(scene.render, "film_transparent", True),
        "bounces": lambda: setattr(scene.lancer, "max_bounces", 0),
        "turned": lambda: setattr(view.data, "view_rotation", Quaternion((0, 0, 1), 0.5) @ view.data.view_rotation),
    }
    result = {}
    for name, change in changes.items():
        before = shown().painter.picture
        with _Record() as record:
            change()
            view.area.tag_redraw()
            done = yield from until(lambda before=before: shown()._wanted is not before.wanted and finished())
            yield 0.1
        after = shown().painter.picture
        pictures = [picture for _, picture, _ in record.draws]
        order = [before, *pictures]
        ages = [picture is not before for picture in order]
        result[name] = {
            "done": done,
            "always": all(picture is not None for picture in pictures),
            "ordered": ages == sorted(ages),
            "rebuilt": after.wanted.contents is not before.wanted.contents,
            "change": float(np.abs(after.image - before.image).mean()) if after.image.shape == before.image.shape else 1.0,
        }
    return result


def _panoramic(view):
    data = bpy.context.scene.camera.data
    data.type = "PANO"
    (data if hasattr(data, "panorama_type") else data.cycles).panorama_type = "EQUIRECTANGULAR"


def _blurred(view):
    dof = bpy.context.scene.camera.data.dof
    dof.use_dof, dof.focus_distance, dof.aperture_fstop = True, 3.0, 0.2


def alike(folder):
    """{camera: mean over 8 x 8 blocks of how far the view's picture is from F12's, relative to its mean}"""
    scene = build(samples=16)
    view = View()
    view.render()
    scene.render.use_border = True
    result = {}
    for change in (_camera, _shifted, _blurred, _panoramic, _camera_orthographic):
        change(view)
        view.area.tag_redraw()
        yield 0.3
        if not (yield from until(finished)):
            return {"late": change.__name__}
        picture = shown().painter.picture
        rectangle = picture.wanted.view.rectangle
        depsgraph = bpy.context.evaluated_depsgraph_get()
        whole, _ = export_scene(depsgraph)
        size = {"width": rectangle.width, "height": rectangle.height}
        region = {"region_width": rectangle.width, "region_height": rectangle.height, "x": 0, "y": 0}
        camera = whole.camera.replaced(**size, **region)
        with Session.upload(whole.replaced(camera=camera)) as session:
            session.render_all(16)
            theirs = _blocks(session.read())
        result[change.__name__.strip("_")] = float(np.abs(_blocks(picture.image) - theirs).mean() / theirs.mean())
    return result


def _blocks(image):
    height, width = (side // 8 * 8 for side in image.shape[:2])
    return image[:height, :width, :3].reshape(height // 8, 8, width // 8, 8, 3).mean(axis=(1, 3))


def selects(folder):
    """What a click that changes no picture costs: whether anything is rendered anew."""
    build(samples=2)
    view = View()
    view.render()
    yield from until(finished)
    before = shown().painter.picture
    bpy.data.objects["Ball"].select_set(True)
    bpy.context.scene.cursor.location = (1, 1, 1)
    yield 0.5
    return {"same": shown().painter.picture is before}


def screen(folder):
    """A glowing wall before the view, whose colour on the screen is the display transform's: the scene is ready for a shot."""
    scene = stage.empty(64, 64)
    stage.sky((0.5, 0.25, 0.1))
    stage.camera()
    scene.lancer.preview_samples = 1
    view = View()
    view.render()
    yield from until(finished)
    yield 0.3
    bpy.ops.screen.screenshot(filepath=f"{folder}/shot.png")
    image = bpy.data.images.load(f"{folder}/shot.png")
    width, height = image.size
    pixels = np.empty(4 * width * height, np.float32)
    image.pixels.foreach_get(pixels)
    pixels = pixels.reshape(height, width, 4)
    x, y = view.region.x + view.region.width // 2, view.region.y + view.region.height // 2
    return {"color": (255 * pixels[y, x, :3]).round().tolist()}


def filtered(folder):
    """How many objects are rendered in local view and under filters, and how fine the finest pixels are."""
    scene = build(samples=1)
    view = View()
    view.render()
    yield from until(finished)

    def rendered():
        return [len(shown()._contents.instances), len(shown()._contents.lights)]

    result = {"all": rendered()}
    ball = bpy.data.objects["Ball"]
    ball.select_set(True)
    bpy.context.view_layer.objects.active = ball
    with view.override():
        bpy.ops.view3d.localview(frame_selected=False)
    yield 0.3
    result["local"] = rendered()
    with view.override():
        bpy.ops.view3d.localview(frame_selected=False)
    yield 0.3
    view.space.show_object_viewport_light = False
    view.area.tag_redraw()
    yield 0.3
    result["without lamps"] = rendered()
    scene.render.preview_pixel_size = "2"
    view.area.tag_redraw()
    yield 0.3
    result["done"] = yield from until(finished)
    result["size"] = shown().painter.picture.size
    return result


def plays(folder):
    """An animation that is played: whether pictures of several frames are shown, and nothing is read but what moves."""
    scene = build(samples=100)
    ball = bpy.data.objects["Ball"]
    for frame, x in ((1, -1.0), (50, 1.0)):
        ball.location.x = x
        ball.keyframe_insert("location", frame=frame)
    scene.frame_set(1)
    view = View()
    view.render()
    yield from until(lambda: shown() is not None and shown().painter.picture is not None)
    with _Record() as record:
        with view.override():
            bpy.ops.screen.animation_play()
        yield 3.0
        with view.override():
            bpy.ops.screen.animation_cancel(restore_frame=False)
    contents = {id(picture.wanted.contents) for _, picture, _ in record.draws}
    return {"frames": len(contents), "read": shown()._parts.counts, "at": scene.frame_current}


def resized(folder):
    """Mebibytes that Blender has grown by, from the tenth to the last of many changes of the view's size; and of one copy."""
    build(samples=0)
    data = bpy.data.meshes.new("Heavy")
    side = 500
    x, y = np.meshgrid(np.linspace(-1.0, 1.0, side), np.linspace(-1.0, 1.0, side))
    places = np.stack([x, y, np.sin(9.0 * x) * np.sin(9.0 * y)], axis=2).reshape(-1, 3)
    first = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).ravel()
    data.from_pydata(places.tolist(), [], np.stack([first, first + 1, first + side + 1, first + side], 1).tolist())
    stage.link("Heavy", data)
    View().render()
    held = []
    for _ in range(40):
        before = View().region.width
        with View().override():
            bpy.ops.screen.screen_full_area(use_hide_panels=True)
        yield 0.3
        assert View().region.width != before
        View().render()
        yield from until(lambda: shown() is not None and shown().painter.picture is not None)
        held.append(memory_now.held()["resident"])
    copy = sum(array.nbytes for mesh in shown()._contents.meshes for array in vars(mesh).values() if hasattr(array, "nbytes"))
    return {"growth": (held[-1] - held[9]) / 2**20, "copy": copy / 2**20}


def canvas(folder):
    """What a picture of 4 x 2 pixels becomes in a framebuffer of 64 x 48: colours inside, at a corner, and outside."""
    yield 0.1
    image = np.zeros((2, 4, 4), np.float32)
    image[..., 3] = 1.0
    image[0, :, 0], image[1, :, 1], image[0, 0] = 0.25, 1e30, (0.125, 0.125, 0.125, 0.5)
    target = gpu.types.GPUOffScreen(64, 48, format="RGBA16F")
    with target.bind():
        framebuffer = gpu.state.active_framebuffer_get()
        framebuffer.clear(color=(0.0, 0.0, 0.0, 0.0))
        with gpu.matrix.push_pop():
            gpu.matrix.load_matrix(Matrix.Identity(4))
            gpu.matrix.load_projection_matrix(Matrix(((2 / 64, 0, 0, -1), (0, 2 / 48, 0, -1), (0, 0, -1, 0), (0, 0, 0, 1))))
            Canvas().draw(image, Rectangle(8, 8, 32, 16))
        drawn = np.array(framebuffer.read_color(0, 0, 64, 48, 4, 0, "FLOAT").to_list())
    target.free()
    places = {"low": (9, 30), "high": (23, 30), "corner": (9, 9), "outside": (30, 50), "left": (12, 4)}
    return {name: drawn[place].tolist() for name, place in places.items()}


# ---- endings ----------------------------------------------------------------------------------------------------------


def _toggle(view):
    view.space.shading.type = "SOLID"
    yield 0.05
    view.render()


def _undo(view):
    with view.override():
        bpy.ops.ed.undo_push(message="before")
        bpy.data.objects["Ball"].location.x += 0.1
        bpy.ops.ed.undo_push(message="after")
    yield 0.02
    with view.override():
        bpy.ops.ed.undo()
    yield 0.02
    with view.override():
        bpy.ops.ed.redo()


def _mode(view):
    bpy.context.view_layer.objects.active = bpy.data.objects["Cube"]
    with view.override():
        bpy.ops.object.mode_set(mode="EDIT")
    yield 0.05
    with view.override():
        bpy.ops.object.mode_set(mode="OBJECT")


def _engine(view):
    scene = bpy.context.scene
    scene.render.engine = "BLENDER_WORKBENCH"
    yield 0.05
    scene.render.engine = "LANCER"


def _load(view):
    bpy.ops.wm.open_mainfile(filepath=_load.path)
    yield 0.05


def _addon(view):
    addon.unregister()
    yield 0.05
    addon.register()
    bpy.context.scene.render.engine = "LANCER"


def _quad(view):
    with view.override():
        bpy.ops.screen.region_quadview()
    yield 0.1
    with view.override():
        bpy.ops.screen.region_quadview()


def _window(view):
    """Another window with a view of its own, closed while it renders."""
    with view.override():
        bpy.ops.wm.window_new_main()
    yield 0.1
    other = bpy.context.window_manager.windows[-1]
    area = next(area for area in other.screen.areas if area.type == "VIEW_3D")
    area.spaces.active.shading.type = "RENDERED"
    yield 0.2
    with bpy.context.temp_override(window=other):
        bpy.ops.wm.window_close()


def _f12(view):
    """A render beside the view."""
    with view.override():
        bpy.ops.render.render("INVOKE_DEFAULT")
    yield 0.1
    yield from until(lambda: not bpy.app.is_job_running("RENDER"))


KINDS = {
    "toggle": _toggle, "undo": _undo, "mode": _mode, "engine": _engine, "load": _load, "addon": _addon, "quad": _quad,
    "window": _window, "f12": _f12,
}  # fmt: skip


def stress(folder, kind, count):
    """The same thing again and again while the view renders: how often it went well, and what threads are left."""
    build(samples=0)
    view = View()
    _load.path = f"{folder}/scene.blend"
    view.render()
    bpy.ops.wm.save_as_mainfile(filepath=_load.path)
    went = 0
    for number in range(int(count)):
        yield from KINDS[kind](View())
        # Another moment each time.
        yield 0.01 * (number % 12)
        View().render()
        went += yield from until(lambda: shown() is not None and shown().painter.picture is not None)
    views = len(viewport._open)
    View().space.shading.type = "SOLID"
    yield from until(lambda: not left(), 5.0)
    return {"went": went, "views": views, "left": left()}


def leave(folder):
    """The program is quit while the view renders; its own way out takes the add-on away."""
    build(samples=0)
    view = View()
    view.render()
    rendered = yield from until(lambda: shown() is not None and shown().painter.picture is not None)
    return {"rendered": rendered, "quits": False}
