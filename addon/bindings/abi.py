"""lancer.h in ctypes: its structs, its functions, and the loading of the library."""

import ctypes
import functools
import os
import sys
from ctypes import POINTER, Structure, c_char, c_char_p, c_double, c_float, c_int32, c_size_t, c_uint32, c_uint64, c_void_p

from . import elf
from .enums import *  # noqa: F403 - abi is the one name under which others find the whole interface
from .enums import Status, Struct

ABI_VERSION = 1
UINT32_MAX = 0xFFFFFFFF

# Arrays cross as plain addresses: numpy gives them without a conversion for each element type.
_Array = c_void_p


class Mesh(Structure):
    _fields_ = [
        ("name", c_char_p),
        ("positions", _Array),
        ("triangles", _Array),
        ("normals", _Array),
        ("uvs", _Array),
        ("colors", _Array),
        ("material_slots", _Array),
        ("vertex_count", c_uint32),
        ("triangle_count", c_uint32),
        ("normal_domain", c_uint32),
        ("reserved", c_uint32),
    ]


class Instance(Structure):
    _fields_ = [
        ("matrix", c_double * 12),
        ("kind", c_uint32),
        ("mesh", c_uint32),
        ("first_slot", c_uint32),
        ("slot_count", c_uint32),
        ("object_index", c_uint32),
        ("shading", c_uint32),
        ("name", c_uint32),
        ("reserved", c_uint32),
    ]


class Parameter(Structure):
    _fields_ = [("value", c_float * 3), ("texture", c_int32)]


class Lobe(Structure):
    _fields_ = [
        ("kind", c_uint32),
        ("color", Parameter),
        ("roughness", Parameter),
        ("ior", Parameter),
        ("shininess", Parameter),
    ]


class Material(Structure):
    _fields_ = [
        ("name", c_char_p),
        ("lobes", POINTER(Lobe)),
        ("lobe_count", c_uint32),
        ("material_index", c_uint32),
        ("emission", Parameter),
        ("opacity", Parameter),
        ("ambient", Parameter),
    ]


class Light(Structure):
    _fields_ = [
        ("name", c_char_p),
        ("matrix", c_double * 12),
        ("kind", c_uint32),
        ("emission", c_float * 3),
        ("radius", c_float),
        ("soft_falloff", c_uint32),
        ("spot_angle", c_float),
        ("spot_blend", c_float),
        ("spot_cosine", c_uint32),
        ("sun_angle", c_float),
        ("size", c_float * 2),
        ("shape", c_uint32),
        ("spread", c_float),
        ("falloff", c_uint32),
        ("falloff_radius", c_float),
        ("ambient_color", c_float * 3),
        ("diffuse_color", c_float * 3),
        ("specular_color", c_float * 3),
    ]


class Camera(Structure):
    _fields_ = [
        ("matrix", c_double * 12),
        ("kind", c_uint32),
        ("width", c_uint32),
        ("height", c_uint32),
        ("x", c_uint32),
        ("y", c_uint32),
        ("region_width", c_uint32),
        ("region_height", c_uint32),
        ("window", c_double * 4),
        ("clip_start", c_double),
        ("clip_end", c_double),
        ("lens_radius", c_double),
        ("focal_distance", c_double),
    ]


class Settings(Structure):
    _fields_ = [
        ("integrator", c_uint32),
        ("samples", c_uint32),
        ("seed", c_uint32),
        ("max_bounces", c_uint32),
        ("contribution_threshold", c_float),
        ("clamp_indirect", c_float),
        ("pixel_filter", c_uint32),
        ("filter_width", c_float),
        ("film_transparent", c_uint32),
        ("features", c_uint32),
        ("passes", c_uint32),
        ("threads", c_uint32),
        ("tile_size", c_uint32),
    ]


class Progress(Structure):
    _fields_ = [("fraction", c_double), ("seconds", c_double), ("samples", c_uint64), ("rays", c_uint64)]


class Statistics(Structure):
    _fields_ = [
        ("build_seconds", c_double),
        ("render_seconds", c_double),
        ("samples", c_uint64),
        ("camera_rays", c_uint64),
        ("bounce_rays", c_uint64),
        ("shadow_rays", c_uint64),
        ("invalid_samples", c_uint64),
        ("invalid_x", c_uint32),
        ("invalid_y", c_uint32),
        ("invalid_sample", c_uint32),
        ("threads", c_uint32),
        ("triangles", c_uint64),
        ("instances", c_uint64),
        ("lights", c_uint64),
        ("geometry_bytes", c_uint64),
        ("accelerator_bytes", c_uint64),
        ("film_bytes", c_uint64),
        ("features", c_char * 256),
        ("kernel", c_char * 64),
        ("instruction_set", c_char * 32),
    ]


class Hit(Structure):
    _fields_ = [
        ("t", c_double),
        ("u", c_double),
        ("v", c_double),
        ("position", c_double * 3),
        ("normal", c_float * 3),
        ("geometric_normal", c_float * 3),
        ("uv", c_float * 2),
        ("color", c_float * 3),
        ("instance", c_uint32),
        ("primitive", c_uint32),
        ("material", c_uint32),
    ]


class Vertex(Structure):
    _fields_ = [
        ("position", c_double * 3),
        ("t", c_double),
        ("normal", c_float * 3),
        ("beta", c_float * 3),
        ("radiance", c_float * 3),
        ("instance", c_uint32),
        ("primitive", c_uint32),
        ("material", c_uint32),
        ("depth", c_uint32),
    ]


class LightSample(Structure):
    _fields_ = [
        ("wi", c_double * 3),
        ("distance", c_double),
        ("radiance", c_float * 3),
        ("pdf", c_float),
        ("delta", c_uint32),
        ("reserved", c_uint32),
    ]


class BsdfSample(Structure):
    _fields_ = [("wi", c_float * 3), ("weight", c_float * 3), ("pdf", c_float), ("delta", c_uint32)]


STRUCTS = {
    Struct.MESH: Mesh,
    Struct.INSTANCE: Instance,
    Struct.PARAMETER: Parameter,
    Struct.LOBE: Lobe,
    Struct.MATERIAL: Material,
    Struct.LIGHT: Light,
    Struct.CAMERA: Camera,
    Struct.SETTINGS: Settings,
    Struct.PROGRESS: Progress,
    Struct.STATISTICS: Statistics,
    Struct.HIT: Hit,
    Struct.VERTEX: Vertex,
    Struct.LIGHT_SAMPLE: LightSample,
    Struct.BSDF_SAMPLE: BsdfSample,
}

_u32, _u64 = c_uint32, c_uint64
# Arguments of the calls that return a lancer_status.
_CALLS = {
    "lancer_scene_create": (POINTER(_u64),),
    "lancer_scene_destroy": (_u64,),
    "lancer_scene_add_mesh": (_u64, POINTER(Mesh)),
    "lancer_scene_add_material": (_u64, POINTER(Material)),
    "lancer_scene_add_light": (_u64, POINTER(Light)),
    "lancer_scene_add_instances": (_u64, _u32, _Array, _u32, _Array, c_char_p, c_size_t),
    "lancer_scene_set_world": (_u64, _Array),
    "lancer_scene_commit": (_u64, _u32, _u32),
    "lancer_scene_wait": (_u64, _u32),
    "lancer_scene_cancel": (_u64,),
    "lancer_scene_messages": (_u64, c_char_p, c_size_t, POINTER(c_size_t)),
    "lancer_session_create": (_u64, POINTER(Camera), POINTER(Settings), POINTER(_u64)),
    "lancer_session_destroy": (_u64,),
    "lancer_session_render": (_u64, _u32, _u32),
    "lancer_session_wait": (_u64, _u32, POINTER(Progress)),
    "lancer_session_cancel": (_u64,),
    "lancer_session_read": (_u64, _u32, _Array, c_size_t),
    "lancer_session_statistics": (_u64, POINTER(Statistics)),
    "lancer_debug_sample": (_u64, _u32, _u32, _u32, _Array, _Array, _u32, POINTER(_u32)),
    "lancer_probe_intersect": (_u64, _u32, _Array, _Array, _Array, _Array, _Array),
    "lancer_probe_occluded": (_u64, _u32, _Array, _Array, _Array, _Array, _Array),
    "lancer_probe_bsdf": (_u64, _u32, _u32, _Array, _Array, _Array, _Array),
    "lancer_probe_bsdf_sample": (_u64, _u32, _u32, _Array, _Array, _Array),
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
    """One sentence for the user; status is the lancer_status behind it, or None where no call failed."""

    def __init__(self, text, status=None):
        super().__init__(text)
        self.status = status


def library_path():
    """Where the build puts the library and where the add-on loads it from."""
    names = {"win32": "lancer.dll", "darwin": "liblancer.dylib"}
    folder = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "lib")
    return os.path.join(folder, names.get(sys.platform, "liblancer.so"))


def load_library(path=None):
    """The library with typed functions; raises LancerError where it is absent, broken or does not fit this add-on."""
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
        raise LancerError(f"Lancer's library cannot be loaded ({error}): {remedy}") from None
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


def check(status, library=None):
    """Returns status where the call did its work; raises LancerError with the library's sentence where it failed."""
    if status <= Status.CANCELLED:
        return Status(status)
    text = (library or load_library()).lancer_last_error().decode("utf-8", "replace")
    raise LancerError(text or f"Lancer's library failed with status {status}", Status(status))
