"""lancer.h in ctypes: loads the library and declares its functions; also re-exports structs and enums."""

import ctypes
import functools
import mmap
import os
import sys
from ctypes import POINTER, c_char_p, c_double, c_float, c_int32, c_size_t, c_uint32, c_uint64

from . import elf
from .enums import *  # noqa: F403 - abi is the one name under which others find the whole interface
from .enums import ABI_VERSION, Status
from .library_file import library_path
from .structs import *  # noqa: F403
from .structs import (
    STRUCTS,
    Bake,
    Camera,
    DenoisedError,
    Error,
    Image,
    Light,
    Made,
    Material,
    Mesh,
    Motion,
    Node,
    Part,
    Progress,
    Settings,
    Statistics,
    World,
)
from .structs import Array as _Array

UINT32_MAX = 0xFFFFFFFF

_u32, _u64 = c_uint32, c_uint64
# Argument types of the functions that return a lancer_status.
_CALLS = {
    "lancer_object_create_image": (POINTER(Image), _u32, POINTER(_u64)),
    "lancer_object_create_mesh": (POINTER(Mesh), _u32, POINTER(_u64)),
    "lancer_object_create_material": (POINTER(Material), _u32, _u32, _Array, POINTER(_u64)),
    "lancer_object_create_light": (POINTER(Light), _u32, _u32, _Array, POINTER(_u64)),
    "lancer_object_create_world": (POINTER(World), _u32, _Array, POINTER(_u64)),
    "lancer_object_destroy": (_u64,),
    "lancer_object_prepare": (_u64, _u32),
    "lancer_scene_edit": (_u64, POINTER(_u64)),
    "lancer_scene_set_objects": (_u64, _u32, _u32, _Array),
    "lancer_scene_clear_instances": (_u64,),
    "lancer_scene_create": (POINTER(_u64),),
    "lancer_scene_destroy": (_u64,),
    "lancer_scene_add_mesh": (_u64, POINTER(Mesh)),
    "lancer_scene_add_material": (_u64, POINTER(Material)),
    "lancer_scene_add_light": (_u64, POINTER(Light)),
    "lancer_scene_add_instances": (_u64, _u32, _Array, _u32, _Array, c_char_p, c_size_t),
    "lancer_scene_set_object_infos": (_u64, _u32, _Array),
    "lancer_scene_add_object_attribute": (_u64, c_char_p, _u32, _Array),
    "lancer_scene_move_instances": (_u64, _u32, _Array, _u32, _Array),
    "lancer_scene_set_vectors": (_u64, _u32, _Array, _Array),
    "lancer_scene_set_motion": (_u64, POINTER(Motion)),
    "lancer_scene_add_image": (_u64, POINTER(Image)),
    "lancer_make_mipmaps": (POINTER(Image), _Array),
    "lancer_scene_set_world": (_u64, POINTER(World)),
    "lancer_scene_commit": (_u64, _u32, _u32),
    "lancer_scene_wait": (_u64, _u32),
    "lancer_scene_cancel": (_u64,),
    "lancer_scene_messages": (_u64, c_char_p, c_size_t, POINTER(c_size_t)),
    "lancer_session_create": (_u64, POINTER(Camera), POINTER(Settings), POINTER(_u64)),
    "lancer_session_create_bake": (_u64, POINTER(Camera), POINTER(Settings), POINTER(Bake), POINTER(_u64)),
    "lancer_session_destroy": (_u64,),
    "lancer_session_render": (_u64, _u32, _u32),
    "lancer_session_wait": (_u64, _u32, POINTER(Progress)),
    "lancer_session_cancel": (_u64,),
    "lancer_session_stop": (_u64,),
    "lancer_session_refine": (_u64, c_double, c_double),
    "lancer_session_error": (_u64, c_double, POINTER(Error)),
    "lancer_combine_denoised": (
        *(_u32, _u32, _Array, _Array, _Array, _Array, _Array),
        *(c_double, _u32, c_double, _u32, _Array, _Array, POINTER(DenoisedError)),
    ),
    "lancer_compose_catchers": (_u64, _Array, _Array, _Array, _Array),
    "lancer_scene_set_digest": (_u64, c_char_p),
    "lancer_session_create_joiner": (c_char_p, POINTER(Camera), POINTER(Settings), POINTER(_u64)),
    "lancer_session_tiles": (_u64, _u32, _Array, POINTER(_u32)),
    "lancer_session_decide": (_u64,),
    "lancer_session_plan": (_u64, c_double, c_double, _u32, _Array, POINTER(_u32)),
    "lancer_session_render_ranges": (_u64, _u32, _Array),
    "lancer_session_clear": (_u64,),
    "lancer_session_export": (_u64, _Array, c_size_t, POINTER(c_size_t)),
    "lancer_session_import": (_u64, _Array, c_size_t),
    "lancer_part_describe": (_Array, c_size_t, POINTER(Part)),
    "lancer_session_read": (_u64, _u32, _Array, c_size_t),
    "lancer_session_statistics": (_u64, POINTER(Statistics)),
    "lancer_debug_sample": (_u64, _u32, _u32, _u32, _Array, _Array, _u32, POINTER(_u32)),
    "lancer_probe_made": (_u64, POINTER(Made)),
    "lancer_probe_intersect": (_u64, _u32, _Array, _Array, _Array, _Array, _Array),
    "lancer_probe_occluded": (_u64, _u32, _Array, _Array, _Array, _Array, _Array),
    "lancer_probe_traversal": (_u64, _u32, _Array, _Array, _Array, _Array, _u32, _Array),
    "lancer_probe_bsdf": (_u64, _u32, _u32, _Array, _Array, _Array, _Array),
    "lancer_probe_bsdf_sample": (_u64, _u32, _u32, _Array, _Array, _Array),
    "lancer_probe_lobes": (_u64, _u32, _Array, _Array, _u32, POINTER(_u32), _Array, _Array),
    "lancer_probe_node": (_u64, _u32, _u32, _u32, _Array, _Array),
    "lancer_evaluate_node": (POINTER(Node), _Array),
    "lancer_compute_sky": (_u32, c_double, c_double, c_double, _Array, _Array, _Array),
    "lancer_probe_world": (_u64, _u32, _Array, _Array, _Array),
    "lancer_probe_microfacet": (_u32, _Array, _Array, _Array, _Array, _Array, _Array, _Array, _Array),
    "lancer_probe_light": (_u64, _u32, _u32, _Array, _Array, _Array),
    "lancer_probe_light_pdf": (_u64, _u32, _u32, _Array, _Array, _Array),
    "lancer_probe_camera": (_u64, _u32, _Array, _Array, _Array, _Array),
    "lancer_probe_sampler": (_u32, _u32, _u32, _u32, _u32, _Array),
    "lancer_probe_filter": (_u32, c_float, _u32, _Array, _Array),
}
_QUERIES = {
    "lancer_abi_version": (_u32, ()),
    "lancer_version": (c_char_p, ()),
    "lancer_last_error": (c_char_p, ()),
    "lancer_sizeof": (_u32, (_u32,)),
}


class LancerError(Exception):
    """An error with a sentence for the user; status: the lancer_status of the call that failed, or None."""

    def __init__(self, text, status=None):
        super().__init__(text)
        self.status = status


def load_library(path=None):
    """Return the library with typed functions; raise LancerError if it is missing, broken or of another version."""
    return _load(os.path.abspath(os.fspath(path)) if path is not None else library_path())


@functools.cache
def _load(path):
    remedy = "install the add-on for this system again, or run `make` in the project's root"
    if not os.path.isfile(path):
        raise LancerError(f"Lancer's library is missing ({path}): {remedy}")
    if sys.platform.startswith("linux"):
        what = elf.fault(path)
        if what:
            raise LancerError(f"Lancer's library {what} ({path}): {remedy}")
    try:
        library = ctypes.CDLL(path)
    except OSError as error:
        if not _has_room(2 * os.path.getsize(path)):
            raise LancerError(f"there is not enough memory or address space to load Lancer's library ({error})") from None
        # Not every system's error names the file.
        raise LancerError(f"Lancer's library cannot be loaded ({error}; {path}): {remedy}") from None
    try:
        for name, (result, arguments) in _QUERIES.items():
            function = getattr(library, name)
            function.restype, function.argtypes = result, arguments
        version = library.lancer_abi_version()
        if version != ABI_VERSION:
            raise LancerError(f"Lancer's library has interface {version}, the add-on needs {ABI_VERSION} ({path}): {remedy}")
        for number, structure in STRUCTS.items():
            size = library.lancer_sizeof(number)
            if size != ctypes.sizeof(structure):
                raise LancerError(
                    f"Lancer's library is of another version ({structure.__name__} has {size} bytes there, "
                    f"{ctypes.sizeof(structure)} here; {path}): {remedy}"
                )
        for name, arguments in _CALLS.items():
            function = getattr(library, name)
            function.restype, function.argtypes = c_int32, arguments
    except AttributeError as error:
        raise LancerError(f"Lancer's library is of another version ({error}): {remedy}") from None
    return library


def _has_room(size):
    """Whether size bytes can be mapped. The loader's error does not say whether memory was the cause."""
    try:
        mmap.mmap(-1, size).close()
    except (OSError, MemoryError):
        return False
    return True


def check(status, library=None):
    """Return status as a Status; raise LancerError with the library's message if the call failed."""
    if status <= Status.CANCELLED:
        return Status(status)
    text = (library or load_library()).lancer_last_error().decode("utf-8", "replace")
    raise LancerError(text or f"Lancer's library failed with status {status}", Status(status))
