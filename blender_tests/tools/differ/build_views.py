"""Records of views as those of the scene: settings of the camera's eyes, or cameras beside it."""

import bpy

_SUFFIXES = ("_a", "_b", "_c")


def build_views(scene, fields):
    camera, render = scene.camera, scene.render
    render.use_multiview = True
    for setting, value in fields.get("stereo", {}).items():
        setattr(camera.data.stereo, setting, value)
    if "apart" not in fields:
        return
    render.views_format = "MULTIVIEW"
    for view in render.views:
        view.use = False
    # The first view is the camera itself.
    camera.name = f"Eye{_SUFFIXES[0]}"
    _add_view(render, _SUFFIXES[0])
    for suffix, place in zip(_SUFFIXES[1:], fields["apart"], strict=False):
        other = bpy.data.objects.new(f"Eye{suffix}", camera.data)
        scene.collection.objects.link(other)
        other.parent, other.location = camera, place
        _add_view(render, suffix)


def _add_view(render, suffix):
    view = render.views.new(f"view{suffix}")
    view.camera_suffix = suffix
