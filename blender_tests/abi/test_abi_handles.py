"""Invalid handles, freed handles and null pointers: each call returns a status and a message, and never crashes."""

import ctypes

import numpy as np
import pytest
from raw import FOREIGN, add, refused

from addon.bindings import abi
from addon.bindings.abi import Status


def calls_on_scenes(raw):
    """Return every call that takes a scene, with valid arguments except the scene."""
    array = raw.keep(np.zeros(64))
    hits = raw.keep((abi.Hit * 4)())
    pointer, out = array.ctypes.data, ctypes.addressof(hits)
    count = ctypes.byref(raw.keep(ctypes.c_uint32()))
    handle = raw.keep(ctypes.c_uint64(0))
    camera, settings = raw.keep(raw.camera()), raw.keep(raw.settings())
    return {
        "lancer_scene_add_mesh": (ctypes.byref(raw.keep(raw.mesh())),),
        "lancer_scene_add_material": (ctypes.byref(raw.keep(raw.material())),),
        "lancer_scene_add_light": (ctypes.byref(raw.keep(raw.light())),),
        "lancer_scene_add_instances": (0, pointer, 0, pointer, b"\0", 1),
        "lancer_scene_add_image": (ctypes.byref(raw.keep(raw.image())),),
        "lancer_scene_set_object_infos": (0, pointer),
        "lancer_scene_add_object_attribute": (b"heat", 0, pointer),
        "lancer_scene_move_instances": (0, pointer, 3, pointer),
        "lancer_scene_set_vectors": (0, pointer, pointer),
        "lancer_scene_set_motion": (ctypes.byref(raw.keep(abi.Motion())),),
        "lancer_scene_set_world": (ctypes.byref(raw.keep(raw.world())),),
        "lancer_scene_set_digest": (b"d" * 32,),
        "lancer_scene_edit": (ctypes.byref(handle),),
        "lancer_scene_set_objects": (0, 0, None),
        "lancer_scene_clear_instances": (),
        "lancer_probe_made": (ctypes.byref(raw.keep(abi.Made())),),
        "lancer_scene_commit": (0, 1),
        "lancer_scene_wait": (0,),
        "lancer_scene_cancel": (),
        "lancer_scene_messages": (None, 0, None),
        "lancer_session_create": (ctypes.byref(camera), ctypes.byref(settings), ctypes.byref(handle)),
        "lancer_session_create_bake": (
            ctypes.byref(camera),
            ctypes.byref(settings),
            ctypes.byref(raw.keep(abi.Bake())),
            ctypes.byref(handle),
        ),
        "lancer_probe_intersect": (1, pointer, pointer, pointer, pointer, out),
        "lancer_probe_occluded": (1, pointer, pointer, pointer, pointer, out),
        "lancer_probe_traversal": (1, pointer, pointer, pointer, pointer, 0, out),
        "lancer_probe_bsdf": (0, 1, pointer, pointer, out, out),
        "lancer_probe_bsdf_sample": (0, 1, pointer, pointer, out),
        "lancer_probe_lobes": (0, pointer, out, 1, count, None, None),
        "lancer_probe_node": (0, 0, 1, pointer, out),
        "lancer_probe_world": (1, pointer, out, out),
        "lancer_probe_light": (0, 1, pointer, pointer, out),
        "lancer_probe_light_pdf": (0, 1, pointer, pointer, out),
        "lancer_scene_destroy": (),
    }


def calls_on_sessions(raw):
    array = raw.keep(np.zeros(64))
    statistics, error, count = raw.keep(abi.Statistics()), raw.keep(abi.Error()), raw.keep(ctypes.c_uint32())
    pointer = array.ctypes.data
    return {
        "lancer_session_render": (0, 1),
        "lancer_session_wait": (0, None),
        "lancer_session_cancel": (),
        "lancer_session_stop": (),
        "lancer_session_refine": (0.1, 0.95),
        "lancer_session_error": (0.95, ctypes.byref(error)),
        "lancer_session_tiles": (0, None, ctypes.byref(count)),
        "lancer_session_decide": (),
        "lancer_session_plan": (0.1, 0.95, 0, None, ctypes.byref(count)),
        "lancer_session_render_ranges": (0, None),
        "lancer_session_clear": (),
        "lancer_session_export": (None, 0, None),
        # The part is checked only for a session that is there.
        "lancer_session_import": (pointer, 16),
        "lancer_session_read": (0, pointer, 4),
        "lancer_session_statistics": (ctypes.byref(statistics),),
        "lancer_debug_sample": (0, 0, 0, pointer, None, 0, ctypes.byref(count)),
        "lancer_probe_camera": (1, pointer, pointer, pointer, pointer),
        "lancer_session_destroy": (),
    }


def test_every_call_with_a_handle_is_tried_here(raw):
    known = {
        "lancer_scene_create",
        "lancer_combine_denoised",
        "lancer_compose_catchers",
        "lancer_probe_microfacet",
        "lancer_probe_sampler",
        "lancer_probe_filter",
        "lancer_evaluate_node",
        "lancer_compute_sky",
        "lancer_make_mipmaps",
        "lancer_object_create_image",
        "lancer_object_create_mesh",
        "lancer_object_create_material",
        "lancer_object_create_light",
        "lancer_object_create_world",
        "lancer_object_destroy",
        "lancer_object_prepare",
        "lancer_part_describe",
        "lancer_session_create_joiner",
    }
    assert set(calls_on_scenes(raw)) | set(calls_on_sessions(raw)) | known == set(abi._CALLS)


@pytest.mark.parametrize("handle", [0, 1 << 63, FOREIGN, 2**64 - 1])
def test_wrong_handles(raw, handle):
    for name, arguments in {**calls_on_scenes(raw), **calls_on_sessions(raw)}.items():
        result = raw.call(name, handle, *arguments)
        assert result[0] == Status.ERROR_HANDLE and result[1], f"{name}: {result}"


def test_use_after_free_and_double_free(raw):
    scene = raw.committed()
    session = raw.session(scene)
    assert raw.call("lancer_session_destroy", session)[0] == Status.OK
    assert raw.call("lancer_scene_destroy", scene)[0] == Status.OK
    # A new scene must not reuse the old handle.
    other = raw.committed()
    for name, arguments in calls_on_scenes(raw).items():
        assert raw.call(name, scene, *arguments)[0] == Status.ERROR_HANDLE, name
    for name, arguments in calls_on_sessions(raw).items():
        assert raw.call(name, session, *arguments)[0] == Status.ERROR_HANDLE, name
    assert raw.call("lancer_scene_destroy", other)[0] == Status.OK
    refused(raw.call("lancer_scene_destroy", other), status=Status.ERROR_HANDLE)


def test_scene_and_session_handles_are_not_mixed_up(raw):
    scene = raw.committed()
    session = raw.session(scene)
    for name, arguments in calls_on_scenes(raw).items():
        assert raw.call(name, session, *arguments)[0] == Status.ERROR_HANDLE, name
    for name, arguments in calls_on_sessions(raw).items():
        assert raw.call(name, scene, *arguments)[0] == Status.ERROR_HANDLE, name


def test_null_pointers(raw):
    scene, committed = raw.filled(), raw.committed()
    session = raw.session(committed)
    array, made = np.zeros(64), ctypes.c_uint64()
    p = array.ctypes.data
    cases = [
        ("lancer_scene_create", None),
        ("lancer_scene_add_mesh", scene, None),
        ("lancer_scene_add_material", scene, None),
        ("lancer_scene_add_light", scene, None),
        ("lancer_scene_add_instances", scene, 1, None, 0, None, b"\0", 1),
        ("lancer_scene_add_image", scene, None),
        ("lancer_scene_set_object_infos", scene, 1, None),
        ("lancer_scene_add_object_attribute", scene, b"heat", 1, None),
        ("lancer_scene_add_object_attribute", scene, None, 0, p),
        ("lancer_scene_set_world", scene, None),
        ("lancer_scene_messages", scene, None, 8, None),
        ("lancer_session_create", committed, None, ctypes.byref(raw.settings()), ctypes.byref(ctypes.c_uint64())),
        ("lancer_session_create", committed, ctypes.byref(raw.camera()), None, ctypes.byref(ctypes.c_uint64())),
        ("lancer_session_create", committed, ctypes.byref(raw.camera()), ctypes.byref(raw.settings()), None),
        ("lancer_scene_set_digest", scene, None),
        ("lancer_session_create_joiner", None, ctypes.byref(raw.camera()), ctypes.byref(raw.settings()), ctypes.byref(made)),
        ("lancer_session_create_joiner", b"d" * 32, None, ctypes.byref(raw.settings()), ctypes.byref(made)),
        ("lancer_session_create_joiner", b"d" * 32, ctypes.byref(raw.camera()), None, ctypes.byref(made)),
        ("lancer_session_create_joiner", b"d" * 32, ctypes.byref(raw.camera()), ctypes.byref(raw.settings()), None),
        ("lancer_session_tiles", session, 4, None, ctypes.byref(ctypes.c_uint32())),
        ("lancer_session_tiles", session, 0, None, None),
        ("lancer_session_render_ranges", session, 1, None),
        ("lancer_session_import", session, None, 0),
        ("lancer_part_describe", None, 0, None),
        ("lancer_session_read", session, 0, None, 16 * 16 * 4),
        ("lancer_session_statistics", session, None),
        ("lancer_debug_sample", session, 0, 0, 0, None, None, 4, None),
        ("lancer_probe_intersect", committed, 1, None, p, p, p, p),
        ("lancer_probe_intersect", committed, 1, p, p, p, p, None),
        ("lancer_probe_occluded", committed, 1, p, None, p, p, p),
        ("lancer_probe_traversal", committed, 1, p, p, p, p, 0, None),
        ("lancer_probe_bsdf", committed, 0, 1, p, None, p, p),
        ("lancer_probe_bsdf_sample", committed, 0, 1, p, p, None),
        ("lancer_probe_lobes", committed, 0, None, p, 1, ctypes.byref(ctypes.c_uint32()), None, None),
        ("lancer_probe_lobes", committed, 0, p, None, 1, ctypes.byref(ctypes.c_uint32()), None, None),
        ("lancer_probe_lobes", committed, 0, p, p, 1, None, None, None),
        ("lancer_probe_node", committed, 0, 0, 1, None, p),
        ("lancer_probe_world", committed, 1, p, None, p),
        ("lancer_probe_microfacet", 1, None, p, p, p, p, p, p, p),
        ("lancer_probe_light", committed, 0, 1, None, p, p),
        ("lancer_probe_light_pdf", committed, 0, 1, p, p, None),
        ("lancer_probe_camera", session, 1, p, p, None, p),
        ("lancer_probe_sampler", 0, 0, 0, 0, 4, None),
        ("lancer_probe_filter", 0, 1.0, 4, None, p),
    ]
    for name, *arguments in cases:
        result = raw.call(name, *arguments)
        assert result[0] == Status.ERROR_ARGUMENT and result[1], f"{name}{arguments}: {result}"


def test_null_arrays_of_a_mesh(raw):
    scene = raw.scene()
    for field in ("positions", "triangles"):
        mesh = raw.mesh()
        setattr(mesh, field, None)
        refused(add(raw, scene, "mesh", mesh), "mesh 'Cube'", field)
    refused(add(raw, scene, "material", null_lobes(raw)), "material 'Paint'")


def null_lobes(raw):
    material = raw.material()
    material.lobes = ctypes.POINTER(abi.Lobe)()
    return material


def test_a_name_may_be_null(raw):
    scene = raw.scene()
    for kind in ("mesh", "image", "material", "light"):
        result = add(raw, scene, kind, getattr(raw, kind)(name=None))
        assert result[0] == Status.OK, result
