"""Sessions and probes of the C interface with wrong values: each returns a status and a message with the value, no crash."""

import ctypes
import math

import numpy as np
import pytest
from raw import refused

from addon.bindings import abi
from addon.bindings.abi import Pass, Status

NAN, INF = float("nan"), float("inf")


WRONG_CAMERAS = {
    "kind": 8,
    "width": 0,
    "height": 0,
    "region_width": 0,
    "region_height": 17,
    "x": 1,
    "y": 2**32 - 1,
    "window": (0.5, 0.5, -0.5, 0.5),
    "clip_start": NAN,
    "clip_end": 0.05,
    "lens_radius": -1.0,
    "matrix": (0,) * 12,
    "aperture_rotation": NAN,
}
# Invalid parameters of each kind of panorama.
WRONG_PANORAMAS = [
    (abi.CameraKind.EQUIRECTANGULAR, (0.0, 0.0, NAN, 1.0)),
    (abi.CameraKind.FISHEYE_EQUIDISTANT, (0.0,)),
    (abi.CameraKind.FISHEYE_EQUISOLID, (0.0, 3.0, 36.0, 24.0)),
    (abi.CameraKind.FISHEYE_POLYNOMIAL, (3.0, 0.0, 24.0)),
    (abi.CameraKind.CYLINDRICAL, (-1.0, 1.0, -1.0, 1.0, 0.0)),
]


@pytest.mark.parametrize("kind, numbers", WRONG_PANORAMAS)
def test_wrong_panoramas(raw, kind, numbers):
    camera = raw.camera(kind=kind, panorama=(*numbers, *(0.0,) * (8 - len(numbers))), window=(0, 1, 0, 1))
    refused(raw.create_session(raw.committed(), camera=camera), "camera")


@pytest.mark.parametrize("field", WRONG_CAMERAS)
def test_wrong_cameras(raw, field):
    camera = raw.camera(**{field: WRONG_CAMERAS[field] if field != "matrix" else (ctypes.c_double * 12)()})
    refused(raw.create_session(raw.committed(), camera=camera), "camera")


@pytest.mark.parametrize("window", [(0.5, 0.5, -0.5, 0.5), (-0.5, 0.5, 0.5, 0.5)])
def test_a_window_has_a_width_and_a_height(raw, window):
    refused(raw.create_session(raw.committed(), camera=raw.camera(window=window)), "camera", "window")


@pytest.mark.parametrize("ratio", [0.0, -1.0, NAN, INF])
def test_the_aperture_must_have_a_ratio_where_a_lens_is(raw, ratio):
    camera = raw.camera(lens_radius=0.1, focal_distance=1.0, aperture_ratio=ratio)
    refused(raw.create_session(raw.committed(), camera=camera), "camera", "aperture ratio")


def test_focal_distance_must_be_positive_where_a_lens_is(raw):
    for distance in (0.0, -1.0, NAN):
        refused(
            raw.create_session(raw.committed(), camera=raw.camera(lens_radius=0.1, focal_distance=distance)), "camera", "focal"
        )


@pytest.mark.parametrize(
    "field, value",
    [("integrator", 3), ("pixel_filter", 2), ("features", 2), ("passes", 1 << 30), ("mattes", 8), ("catchers", 3)],
)
def test_wrong_choices_in_settings(raw, field, value):
    refused(raw.create_session(raw.committed(), settings=raw.settings(**{field: value})), str(value))


@pytest.mark.parametrize("field", ["max_bounces", "transparent_bounces", "transparent_shadows"])
def test_too_many_bounces(raw, field):
    refused(raw.create_session(raw.committed(), settings=raw.settings(**{field: 1025})), field, "1025", "1024")


def test_the_deepest_recursion_of_classic(raw):
    settings = raw.settings(integrator=1, max_bounces=17)
    refused(raw.create_session(raw.committed(), settings=settings), "max_bounces 17", "CLASSIC")


AMOUNTS = ("filter_width", "contribution_threshold", "clamp_indirect", "glass_roughness", "alpha_threshold")
AMOUNTS += ("occlusion_distance", "mist_start", "mist_depth", "mist_falloff")


@pytest.mark.parametrize("field", AMOUNTS)
@pytest.mark.parametrize("value", [NAN, INF, -1.0])
def test_wild_values_in_settings(raw, field, value):
    refused(raw.create_session(raw.committed(), settings=raw.settings(**{field: value})), field.split("_")[0])


@pytest.mark.parametrize("size", [2**32 - 1, 2**31, 1_000_000])
def test_enormous_resolution(raw, size):
    camera = raw.camera(width=size, height=size, region_width=size, region_height=size)
    result = raw.create_session(raw.committed(), camera=camera)
    assert result[0] in (Status.ERROR_MEMORY, Status.ERROR_ARGUMENT), result
    assert str(size) in result[1], result[1]


def test_read_checks_pass_and_size(raw):
    session = raw.session(raw.committed())
    assert raw.read(session, Pass.COMBINED, 16 * 16 * 4)[0] == Status.OK
    for count in (0, 16 * 16 * 4 - 1, 16 * 16 * 4 + 1, 2**40):
        out = np.zeros(16 * 16 * 4 + 1, np.float32)
        refused(raw.call("lancer_session_read", session, 0, out.ctypes.data, count), str(count), str(16 * 16 * 4))
    refused(raw.read(session, Pass.DEPTH, 16 * 16))
    refused(raw.read(session, 99, 16 * 16), "99")


def test_probes_check_their_numbers(raw):
    scene = raw.committed()
    session = raw.session(scene)
    array = np.zeros(256)
    p = array.ctypes.data
    refused(raw.call("lancer_probe_bsdf", scene, 1, 1, p, p, p, p), "material", "1")
    refused(raw.call("lancer_probe_bsdf_sample", scene, 2**32 - 1, 1, p, p, p), "material", "4294967295")
    lobes = ctypes.c_uint32()
    refused(raw.call("lancer_probe_lobes", scene, 1, p, p, 1, ctypes.byref(lobes), None, None), "material", "1")
    refused(raw.call("lancer_probe_node", scene, 0, 5, 1, p, p), "node", "5")
    refused(raw.call("lancer_probe_node", scene, 4, 0, 1, p, p), "material", "4")
    refused(raw.call("lancer_probe_light", scene, 9, 1, p, p, p), "light", "9")
    refused(raw.call("lancer_probe_light_pdf", scene, 9, 1, p, p, p), "light", "9")
    refused(raw.call("lancer_probe_filter", 7, 1.0, 1, p, p), "filter", "7")
    count = ctypes.c_uint32()
    refused(raw.call("lancer_debug_sample", session, 16, 0, 0, p, None, 0, ctypes.byref(count)), "16")
    refused(raw.call("lancer_debug_sample", session, 0, 16, 0, p, None, 0, ctypes.byref(count)), "16")


def test_rays_that_are_no_rays_meet_nothing(raw):
    scene = raw.committed()
    rows = [(NAN, 0, 1), (0.2, 0.2, INF), (0.2, 0.2, 1), (0.2, 0.2, 1), (0.2, 0.2, 1)]
    directions = [(0, 0, -1), (0, 0, -1), (0, 0, 0), (0, NAN, -1), (0, 0, -INF)]
    o, d = np.array(rows, np.float64), np.array(directions, np.float64)
    near, far = np.zeros(5), np.full(5, INF)
    hits = (abi.Hit * 5)()
    arguments = [x.ctypes.data for x in (o, d, near, far)]
    assert raw.call("lancer_probe_intersect", scene, 5, *arguments, ctypes.addressof(hits))[0] == Status.OK
    assert [hit.instance for hit in hits] == [abi.UINT32_MAX] * 5
    assert all(math.isinf(hit.t) for hit in hits)
