"""The structs of the interface in ctypes, field by field.

Generated from core/include/lancer.h by `make bindings`; changes here are lost.
"""

from ctypes import POINTER, Structure, c_char, c_char_p, c_double, c_float, c_int32, c_uint8, c_uint32, c_uint64, c_void_p

from .enums import Struct

# Arrays are passed as plain addresses, which numpy provides without a conversion for each element type.
Array = c_void_p


class Attribute(Structure):
    """A named mesh attribute that nodes read."""

    _fields_ = [
        ("name", c_char_p),
        ("values", Array),
        ("domain", c_uint32),
        ("channels", c_uint32),
    ]


class Mesh(Structure):
    """A triangle mesh in object space, shared by any number of instances."""

    _fields_ = [
        ("name", c_char_p),
        ("positions", Array),
        ("triangles", Array),
        ("normals", Array),
        ("uvs", Array),
        ("colors", Array),
        ("material_slots", Array),
        ("polygons", Array),
        ("attributes", POINTER(Attribute)),
        ("vertex_count", c_uint32),
        ("triangle_count", c_uint32),
        ("normal_domain", c_uint32),
        ("attribute_count", c_uint32),
        ("moved_positions", Array),
        ("moved_normals", Array),
        ("vector_positions", Array),
        ("key_count", c_uint32),
        ("reserved", c_uint32),
    ]


class Instance(Structure):
    """One placed object."""

    _fields_ = [
        ("matrix", c_double * 12),
        ("kind", c_uint32),
        ("mesh", c_uint32),
        ("first_slot", c_uint32),
        ("slot_count", c_uint32),
        ("object_index", c_uint32),
        ("shading", c_uint32),
        ("name", c_uint32),
        ("hidden_from", c_uint32),
        ("flags", c_uint32),
        ("object_matte", c_uint32),
        ("asset_matte", c_uint32),
        ("light_group", c_uint32),
        ("terminator", c_float),
        ("receiver_set", c_uint32),
        ("blocker_set", c_uint32),
        ("fast_distance", c_float),
        ("reserved", c_uint32),
        ("unlit_sets", c_uint64),
        ("clear_sets", c_uint64),
    ]


class Image(Structure):
    _fields_ = [
        ("name", c_char_p),
        ("texels", Array),
        ("width", c_uint32),
        ("height", c_uint32),
        ("channels", c_uint32),
        ("kind", c_uint32),
        ("transfer", c_uint32),
        ("alpha", c_uint32),
        ("tile", c_uint32),
        ("layout", c_uint32),
        ("matrix", c_float * 9),
        ("gaps", c_uint32),
        ("mipmaps", c_uint32),
        ("reserved", c_uint32),
    ]


class Parameter(Structure):
    """A value of a material, light or world."""

    _fields_ = [
        ("value", c_float * 3),
        ("node", c_int32),
    ]


class Node(Structure):
    _fields_ = [
        ("kind", c_uint32),
        ("option", c_uint32),
        ("flags", c_uint32),
        ("image", c_uint32),
        ("image_count", c_uint32),
        ("first", c_uint32),
        ("name", c_char_p),
        ("inputs", Parameter * 5),
        ("matrix", c_float * 12),
    ]


class Principled(Structure):
    """The Principled BSDF's inputs under their newest names."""

    _fields_ = [
        ("rules", c_uint32),
        ("distribution", c_uint32),
        ("option", c_uint32),
        ("subsurface_option", c_uint32),
        ("base_color", Parameter),
        ("metallic", Parameter),
        ("roughness", Parameter),
        ("ior", Parameter),
        ("diffuse_roughness", Parameter),
        ("specular", Parameter),
        ("specular_tint", Parameter),
        ("anisotropic", Parameter),
        ("anisotropic_rotation", Parameter),
        ("transmission", Parameter),
        ("transmission_roughness", Parameter),
        ("coat", Parameter),
        ("coat_roughness", Parameter),
        ("coat_ior", Parameter),
        ("coat_tint", Parameter),
        ("coat_normal", Parameter),
        ("sheen", Parameter),
        ("sheen_roughness", Parameter),
        ("sheen_tint", Parameter),
        ("emission", Parameter),
        ("film_thickness", Parameter),
        ("film_ior", Parameter),
        ("thin_wall", Parameter),
        ("wall_scattering", Parameter),
        ("wall_forward", Parameter),
        ("subsurface", Parameter),
        ("subsurface_radius", Parameter),
        ("subsurface_color", Parameter),
        ("subsurface_ior", Parameter),
        ("subsurface_anisotropy", Parameter),
    ]


class Lobe(Structure):
    _fields_ = [
        ("kind", c_uint32),
        ("distribution", c_uint32),
        ("option", c_uint32),
        ("rules", c_uint32),
        ("weight", Parameter),
        ("color", Parameter),
        ("roughness", Parameter),
        ("ior", Parameter),
        ("shininess", Parameter),
        ("edge", Parameter),
        ("anisotropy", Parameter),
        ("rotation", Parameter),
        ("normal", Parameter),
        ("tangent", Parameter),
        ("roughness_across", Parameter),
        ("offset", Parameter),
        ("film_thickness", Parameter),
        ("film_ior", Parameter),
        ("principled", POINTER(Principled)),
    ]


class Portal(Structure):
    """A part of a surface that light enters to go on elsewhere, as Cycles' Ray Portal."""

    _fields_ = [
        ("moves", c_uint32),
        ("reserved", c_uint32),
        ("weight", Parameter),
        ("position", Parameter),
        ("direction", Parameter),
    ]


class Output(Structure):
    """A value of a surface or of the world that goes into a pass AOV_COLOR or AOV_VALUE."""

    _fields_ = [
        ("number", c_uint32),
        ("is_color", c_uint32),
        ("value", Parameter),
    ]


class Material(Structure):
    _fields_ = [
        ("name", c_char_p),
        ("lobes", POINTER(Lobe)),
        ("nodes", POINTER(Node)),
        ("portals", POINTER(Portal)),
        ("outputs", POINTER(Output)),
        ("lobe_count", c_uint32),
        ("node_count", c_uint32),
        ("material_index", c_uint32),
        ("flags", c_uint32),
        ("portal_count", c_uint32),
        ("output_count", c_uint32),
        ("matte", c_uint32),
        ("reserved", c_uint32),
        ("emission", Parameter),
        ("transmittance", Parameter),
        ("holdout", Parameter),
        ("ambient", Parameter),
        ("displacement", Parameter),
        ("normal", Parameter),
    ]


class Light(Structure):
    """A light emits along its local -z."""

    _fields_ = [
        ("name", c_char_p),
        ("nodes", POINTER(Node)),
        ("node_count", c_uint32),
        ("strength", Parameter),
        ("matrix", c_double * 12),
        ("kind", c_uint32),
        ("emission", c_float * 3),
        ("radius", c_float),
        ("soft_falloff", c_uint32),
        ("spot_angle", c_float),
        ("spot_blend", c_float),
        ("spot_cosine", c_uint32),
        ("sun_angle", c_float),
        ("sun_flat", c_uint32),
        ("size", c_float * 2),
        ("shape", c_uint32),
        ("spread", c_float),
        ("hidden_from", c_uint32),
        ("no_shadow", c_uint32),
        ("light_group", c_uint32),
        ("falloff", c_uint32),
        ("falloff_radius", c_float),
        ("ambient_color", c_float * 3),
        ("diffuse_color", c_float * 3),
        ("specular_color", c_float * 3),
        ("lit_surfaces", c_uint32),
        ("no_catchers", c_uint32),
        ("opening", c_uint32),
        ("unlit_sets", c_uint64),
        ("clear_sets", c_uint64),
    ]


class World(Structure):
    """The environment's radiance, as a value or as nodes."""

    _fields_ = [
        ("nodes", POINTER(Node)),
        ("outputs", POINTER(Output)),
        ("node_count", c_uint32),
        ("hidden_from", c_uint32),
        ("radiance", Parameter),
        ("ambient", c_float * 3),
        ("use_ambient", c_uint32),
        ("map_resolution", c_uint32),
        ("light_group", c_uint32),
        ("output_count", c_uint32),
        ("lit_surfaces", c_uint32),
    ]


class Camera(Structure):
    """The camera looks along its local -z, y up."""

    _fields_ = [
        ("matrix", c_double * 12),
        ("kind", c_uint32),
        ("width", c_uint32),
        ("height", c_uint32),
        ("x", c_uint32),
        ("y", c_uint32),
        ("region_width", c_uint32),
        ("region_height", c_uint32),
        ("aperture_blades", c_uint32),
        ("window", c_double * 4),
        ("panorama", c_double * 8),
        ("clip_start", c_double),
        ("clip_end", c_double),
        ("lens_radius", c_double),
        ("focal_distance", c_double),
        ("aperture_rotation", c_double),
        ("aperture_ratio", c_double),
        ("eye_offset", c_double),
        ("convergence_distance", c_double),
        ("pole_merge_from", c_double),
        ("pole_merge_to", c_double),
        ("matrix_before", c_double * 12),
        ("matrix_after", c_double * 12),
        ("window_before", c_double * 4),
        ("window_after", c_double * 4),
    ]


class Motion(Structure):
    """Motion while the shutter is open."""

    _fields_ = [
        ("shutter", Array),
        ("shutter_count", c_uint32),
        ("key_count", c_uint32),
        ("keys", POINTER(Camera)),
        ("rolling", c_uint32),
        ("reserved", c_uint32),
        ("rolling_duration", c_double),
    ]


class Settings(Structure):
    """How a scene is rendered."""

    _fields_ = [
        ("integrator", c_uint32),
        ("samples", c_uint32),
        ("seed", c_uint32),
        ("max_bounces", c_uint32),
        ("diffuse_bounces", c_uint32),
        ("glossy_bounces", c_uint32),
        ("transmission_bounces", c_uint32),
        ("contribution_threshold", c_float),
        ("clamp_indirect", c_float),
        ("clamp_direct", c_float),
        ("no_reflections", c_uint32),
        ("no_refractions", c_uint32),
        ("filter_glossy", c_float),
        ("exposure", c_float),
        ("fast_bounces", c_uint32),
        ("fast_factor", c_float),
        ("fast_distance", c_float),
        ("ambient", c_float),
        ("split_lights", c_uint32),
        ("split_paths", c_uint32),
        ("pixel_filter", c_uint32),
        ("filter_width", c_float),
        ("film_transparent", c_uint32),
        ("transparent_glass", c_uint32),
        ("glass_roughness", c_float),
        ("transparent_bounces", c_uint32),
        ("transparent_shadows", c_uint32),
        ("alpha_threshold", c_float),
        ("environment_reflections", c_uint32),
        ("occlusion_distance", c_float),
        ("mist_start", c_float),
        ("mist_depth", c_float),
        ("mist_falloff", c_float),
        ("blended_features", c_uint32),
        ("sky_vectors", c_uint32),
        ("even_choices", c_uint32),
        ("features", c_uint32),
        ("passes", c_uint32),
        ("mattes", c_uint32),
        ("light_groups", c_uint32),
        ("aov_colors", c_uint32),
        ("aov_values", c_uint32),
        ("catchers", c_uint32),
        ("threads", c_uint32),
        ("tile_size", c_uint32),
        ("refines", c_uint32),
    ]


class Progress(Structure):
    _fields_ = [
        ("fraction", c_double),
        ("seconds", c_double),
        ("samples", c_uint64),
        ("rays", c_uint64),
    ]


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
        ("features", c_char * 512),
        ("kernel", c_char * 64),
        ("instruction_set", c_char * 32),
        ("texture_bytes", c_uint64),
        ("mapped_bytes", c_uint64),
        ("vertices", c_uint64),
        ("split_lights", c_uint32),
        ("split_paths", c_uint32),
    ]


class Texel(Structure):
    """A texel of an image that shows the surface of a mesh."""

    _fields_ = [
        ("triangle", c_uint32),
        ("weights", c_float * 2),
        ("dx", c_float * 2),
        ("dy", c_float * 2),
    ]


class Bake(Structure):
    """The picture of a surface in texels, in place of the camera's view."""

    _fields_ = [
        ("texels", POINTER(Texel)),
        ("texel_count", c_uint32),
        ("instance", c_uint32),
        ("view", c_uint32),
        ("lacks", c_uint32),
        ("bare_roughness", c_float),
        ("reserved", c_uint32),
    ]


class Error(Structure):
    """The distance of the picture from the converged one."""

    _fields_ = [
        ("error", c_double),
        ("low", c_double),
        ("high", c_double),
        ("cannot_exclude", c_double),
        ("clipped", c_double),
        ("clipped_direct", c_double),
        ("cut", c_double),
        ("no_caustics", c_double),
        ("filtered", c_double),
        ("filtered_error", c_double),
        ("guessed", c_double),
        ("guessed_error", c_double),
        ("missing", c_double),
        ("planned_samples", c_double),
        ("least_samples", c_uint32),
        ("most_samples", c_uint32),
    ]


class DenoisedError(Structure):
    """The error of a denoised picture, in the unit of lancer_error."""

    _fields_ = [
        ("error", c_double),
        ("low", c_double),
        ("high", c_double),
        ("moved", c_double),
    ]


class Range(Structure):
    """Samples first ..."""

    _fields_ = [
        ("tile", c_uint32),
        ("first", c_uint32),
        ("count", c_uint32),
    ]


class Part(Structure):
    """The picture that a part belongs to, and the samples that it holds."""

    _fields_ = [
        ("digest", c_uint8 * 32),
        ("release", c_char * 16),
        ("hash", c_uint64),
        ("samples", c_uint64),
        ("camera", Camera),
        ("settings", Settings),
        ("split_lights", c_uint32),
        ("split_paths", c_uint32),
        ("tiles", c_uint64),
        ("first", c_uint32),
        ("end", c_uint32),
    ]


class Vertex(Structure):
    """One vertex of a replayed sample."""

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


class Made(Structure):
    """The parts that a scene's commit made; it took all others from the objects or from the scene before."""

    _fields_ = [
        ("placements", c_uint32),
        ("mesh_trees", c_uint32),
        ("triangles", c_uint32),
        ("changed_meshes", c_uint32),
        ("materials", c_uint32),
        ("emitters", c_uint32),
        ("skies", c_uint32),
        ("plane_searches", c_uint32),
    ]


class BsdfSample(Structure):
    _fields_ = [
        ("wi", c_float * 3),
        ("weight", c_float * 3),
        ("pdf", c_float),
        ("delta", c_uint32),
    ]


class LobeInfo(Structure):
    """A lobe for one wo, after nodes and layers."""

    _fields_ = [
        ("kind", c_uint32),
        ("component", c_uint32),
        ("weight", c_float * 3),
        ("albedo", c_float * 3),
        ("roughness", c_float * 2),
        ("ior", c_float),
        ("probability", c_float),
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
    Struct.ATTRIBUTE: Attribute,
    Struct.IMAGE: Image,
    Struct.NODE: Node,
    Struct.PRINCIPLED: Principled,
    Struct.WORLD: World,
    Struct.LOBE_INFO: LobeInfo,
    Struct.ERROR: Error,
    Struct.DENOISED_ERROR: DenoisedError,
    Struct.RANGE: Range,
    Struct.PART: Part,
    Struct.PORTAL: Portal,
    Struct.MADE: Made,
    Struct.MOTION: Motion,
    Struct.OUTPUT: Output,
    Struct.TEXEL: Texel,
    Struct.BAKE: Bake,
}

# Kind and default of each parameter, from lancer.h.
PARAMETERS = {
    Principled: {
        "base_color": ("color", (0.8, 0.8, 0.8)),
        "metallic": ("share", 0.0),
        "roughness": ("share", 0.5),
        "ior": ("index", 1.5),
        "diffuse_roughness": ("share", 0.0),
        "specular": ("amount", 0.5),
        "specular_tint": ("color", (1.0, 1.0, 1.0)),
        "anisotropic": ("share", 0.0),
        "anisotropic_rotation": ("turns", 0.0),
        "transmission": ("share", 0.0),
        "transmission_roughness": ("share", 0.0),
        "coat": ("amount", 0.0),
        "coat_roughness": ("share", 0.03),
        "coat_ior": ("denser", 1.5),
        "coat_tint": ("color", (1.0, 1.0, 1.0)),
        "coat_normal": ("direction", (0.0, 0.0, 0.0)),
        "sheen": ("amount", 0.0),
        "sheen_roughness": ("share", 0.5),
        "sheen_tint": ("color", (1.0, 1.0, 1.0)),
        "emission": ("vector", (0.0, 0.0, 0.0)),
        "film_thickness": ("amount", 0.0),
        "film_ior": ("index", 1.33),
        "thin_wall": ("share", 0.0),
        "wall_scattering": ("share", 0.0),
        "wall_forward": ("share", 0.5),
        "subsurface": ("share", 0.0),
        "subsurface_radius": ("color", (0.0, 0.0, 0.0)),
        "subsurface_color": ("color", (0.8, 0.8, 0.8)),
        "subsurface_ior": ("index", 1.4),
        "subsurface_anisotropy": ("signed", 0.0),
    },
    Lobe: {
        "weight": ("color", (1.0, 1.0, 1.0)),
        "color": ("color", (0.8, 0.8, 0.8)),
        "roughness": ("share", 0.5),
        "ior": ("index", 1.5),
        "shininess": ("amount", 50.0),
        "edge": ("color", (1.0, 1.0, 1.0)),
        "anisotropy": ("signed", 0.0),
        "rotation": ("turns", 0.0),
        "normal": ("direction", (0.0, 0.0, 0.0)),
        "tangent": ("direction", (0.0, 0.0, 0.0)),
        "roughness_across": ("share", 0.0),
        "offset": ("turns", 0.0),
        "film_thickness": ("amount", 0.0),
        "film_ior": ("index", 1.33),
    },
    Portal: {
        "weight": ("color", (0.0, 0.0, 0.0)),
        "position": ("vector", (0.0, 0.0, 0.0)),
        "direction": ("vector", (0.0, 0.0, 0.0)),
    },
    Output: {
        "value": ("vector", (0.0, 0.0, 0.0)),
    },
    Material: {
        "emission": ("color", (0.0, 0.0, 0.0)),
        "transmittance": ("color", (0.0, 0.0, 0.0)),
        "holdout": ("share", 0.0),
        "ambient": ("color", (0.0, 0.0, 0.0)),
        "displacement": ("vector", (0.0, 0.0, 0.0)),
        "normal": ("direction", (0.0, 0.0, 0.0)),
    },
    Light: {
        "strength": ("vector", (1.0, 1.0, 1.0)),
    },
    World: {
        "radiance": ("color", (0.0, 0.0, 0.0)),
    },
}

# Kind and default of each setting, from lancer.h.
SETTINGS = {
    "integrator": ("choice", 0),
    "samples": ("number", 256),
    "seed": ("number", 0),
    "max_bounces": ("number", 12),
    "diffuse_bounces": ("number", 1024),
    "glossy_bounces": ("number", 1024),
    "transmission_bounces": ("number", 1024),
    "contribution_threshold": ("amount", 0.0),
    "clamp_indirect": ("amount", 0.0),
    "clamp_direct": ("amount", 0.0),
    "no_reflections": ("switch", False),
    "no_refractions": ("switch", False),
    "filter_glossy": ("amount", 0.0),
    "exposure": ("amount", 1.0),
    "fast_bounces": ("number", 0),
    "fast_factor": ("amount", 1.0),
    "fast_distance": ("amount", 0.0),
    "ambient": ("amount", 0.0),
    "split_lights": ("number", 1),
    "split_paths": ("number", 1),
    "pixel_filter": ("choice", 0),
    "filter_width": ("width", 1.0),
    "film_transparent": ("switch", False),
    "transparent_glass": ("switch", False),
    "glass_roughness": ("amount", 0.0),
    "transparent_bounces": ("number", 8),
    "transparent_shadows": ("number", 8),
    "alpha_threshold": ("amount", 0.5),
    "environment_reflections": ("switch", False),
    "occlusion_distance": ("amount", 0.0),
    "mist_start": ("amount", 5.0),
    "mist_depth": ("amount", 25.0),
    "mist_falloff": ("amount", 2.0),
    "blended_features": ("switch", False),
    "sky_vectors": ("switch", False),
    "even_choices": ("switch", False),
    "features": ("choice", 0),
    "passes": ("bits", 1),
    "mattes": ("bits", 0),
    "light_groups": ("number", 0),
    "aov_colors": ("number", 0),
    "aov_values": ("number", 0),
    "catchers": ("choice", 0),
    "threads": ("number", 0),
    "tile_size": ("number", 0),
    "refines": ("switch", False),
}
