"""Export of one depsgraph to one snapshot."""

import time
from dataclasses import dataclass

from ..bindings.enums import Pass
from ..bindings.session import Cancelled
from ..bindings.snapshot import SceneSnapshot
from ..messages.messages import Messages
from .camera import export_camera
from .catchers import catchers_of, tell_of_aovs
from .culling import Culling
from .even_normals import with_even_normals
from .flat import report_flat
from .images import Images
from .instances import Instances
from .light_groups import group_numbers
from .light_linking import read_linking
from .materials import Materials
from .motion import read_motion
from .named_passes import named_passes
from .outputs import rendered_aovs
from .scene_state import scene_state
from .settings import export_settings, world_of
from .shader_cache import ShaderCache
from .smaller_images import size_limit
from .subdivision.divider import Divider
from .texture_cache import texture_cache
from .unsupported import check_passes, check_scene, check_view_layer
from .world import export_world

# Seconds between polls: to ask Blender takes as long as a tenth of a small mesh, which asks ten times.
_POLL_EVERY = 0.005


@dataclass(frozen=True)
class ExportOptions:
    camera: object = None  # the camera object; None is the scene's
    passes: tuple = (Pass.COMBINED,)
    kept: object = None  # the Kept of earlier frames
    parts: object = None  # the Parts of earlier exports
    on_mesh: object = None  # is called with each MeshData as soon as it is read
    is_preview: bool = False  # of a material, a world or a lamp
    picture: object = None  # the snapshot.Camera of a picture that no camera object takes: a bake's
    # For motion: the Shutter, a function that evaluates the depsgraph at a time in frames, and the ShaderCache of another time.
    shutter: object = None
    set_frame: object = None
    shaders: object = None
    sight_of_views: object = None  # the Sight of a picture with several views, whose cameras are read with what moves
    # For a window:
    view: object = None  # a snapshot.Camera that replaces the camera object
    dicing: object = None  # the snapshot.Camera by whose pixels meshes are divided
    space: object = None  # the SpaceView3D, whose local view and filters exclude objects
    sight: object = None  # a value that differs if the space excludes other objects


def export_scene(depsgraph, options=None, poll=None):
    """Return (SceneSnapshot, Messages). poll is called every few milliseconds; raise Cancelled if it returns True.

    Raise LancerError if there is no camera or no image to render.
    """
    options = options or ExportOptions()
    polled = -_POLL_EVERY

    def obey():
        nonlocal polled
        if poll is None or time.monotonic() - polled < _POLL_EVERY:
            return
        if poll():
            raise Cancelled
        polled = time.monotonic()

    obey()
    messages = Messages()
    scene = depsgraph.scene
    view_layer = depsgraph.view_layer
    # Read camera and settings first, so that an error in them ends the export early.
    camera = options.view or options.picture or export_camera(options.camera or scene.camera, depsgraph, messages)
    world = world_of(depsgraph)
    # The view layer refers to original data without animation: use the evaluated copy.
    override = view_layer.material_override and view_layer.material_override.evaluated_get(depsgraph)
    in_view = options.view is not None
    settings = export_settings(depsgraph, options.passes, world, messages, in_view)

    def with_catchers(snapshot):
        return settings.replaced(catchers=catchers_of(snapshot.instances, view_layer, settings.integrator))

    check_scene(scene, messages)
    check_passes(scene, options.passes, messages)
    check_view_layer(scene, view_layer, messages)
    named = tuple(item for item in named_passes(view_layer) if item.source in options.passes)
    linking = read_linking(depsgraph, messages)
    parts, cache = options.parts, texture_cache(scene)
    if parts is not None:
        parts.read_by(cache)
        state = scene_state(depsgraph), linking, options.sight, messages.lines(), size_limit(scene, in_view)
        again = parts.begin(depsgraph, state, obey)
        if again is not None:
            # The messages of the last export include those of the checks above, which have not changed.
            snapshot, messages, geometries = again
            snapshot = snapshot.replaced(named_passes=named)
            return _placed(snapshot, geometries, messages, options, camera, with_catchers(snapshot)), messages
    images = parts.images if parts is not None else options.shaders.images if options.shaders else Images(obey, options.kept)
    images.obey = obey
    images.frame, images.is_preview, images.texture_cache = scene.frame_current, options.is_preview, cache
    images.limit = size_limit(scene, in_view)
    shaders = parts.shaders if parts is not None else options.shaders or ShaderCache(images)
    materials = Materials(messages, override, images, depsgraph, shaders)
    # As in Cycles, a bake shows the meshes of Blender, whose triangles its texels name.
    is_bake = options.picture is not None
    divider = Divider(depsgraph, options.dicing if in_view else camera, messages, in_view, is_off=is_bake)
    aovs = rendered_aovs(view_layer, options.passes)
    materials.aovs = aovs
    instances = Instances(depsgraph, materials, messages, shaders, divider, linking, Culling(scene, camera), options)
    instances.collect(obey)

    def read_sky(messages, images, value):
        return export_world(sky, images, depsgraph, messages, aovs)

    sky = world if view_layer.use_sky else None
    exported = export_world(None, images, depsgraph, messages) if sky is None else shaders.find(sky, messages, read_sky)
    snapshot = SceneSnapshot(
        meshes=tuple(instances.meshes),
        instances=instances.to_table(obey),
        materials=tuple(materials.list),
        lights=tuple(instances.lights if parts is None else parts.lights(instances.lights)),
        images=tuple(images.list),
        world=_grouped(exported.world, sky, group_numbers(view_layer, options.passes)),
        named_passes=named,
    )
    tell_of_aovs(snapshot.instances, aovs, messages)
    obey()
    if options.shutter is not None:
        at_middle = snapshot.replaced(camera=camera)
        snapshot = read_motion(at_middle, depsgraph, options.camera or scene.camera, instances.places, options, messages, obey)
        camera = snapshot.camera
    if parts is not None:
        # The instance of a lamp moves with its instancer; the places of object and camera decide how a mesh is divided.
        moves_freely = not (instances.has_lamp_instances or divider.depends_on_places or instances.culls)
        parts.end(snapshot, messages, instances.places if moves_freely else None, instances.geometries, state)
    return _placed(snapshot, instances.geometries, messages, options, camera, with_catchers(snapshot)), messages


def _grouped(world, sky, groups):
    """Return a snapshot.World with the number of its light group. sky: Blender's world, or None."""
    group = 0 if sky is None else groups.get(sky.lightgroup, 0)
    return world.replaced(light_group=group) if group else world


def _placed(snapshot, geometries, messages, options, camera, settings):
    """Return the snapshot with all that follows from the places of its objects; geometries: see with_even_normals."""
    snapshot = snapshot.replaced(camera=camera, settings=settings)
    report_flat(snapshot.instances, snapshot.meshes, messages)
    if options.view is not None:
        return snapshot
    # Only final renders of Cycles transform meshes to the world, which changes normals.
    known = {} if options.parts is None else options.parts.even
    meshes, table = with_even_normals(snapshot.meshes, snapshot.instances, geometries, snapshot.materials, known)
    return snapshot.replaced(meshes=tuple(meshes), instances=table)
