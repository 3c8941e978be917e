"""Determinism: the picture has the same bits however the work is divided, since a sample depends only on its address."""

import dataclasses
import os
import subprocess
import sys

import numpy as np
import pytest
import tiny_scenes
from conftest import HERE, ROOT
from tiny_scenes import showroom

from addon.bindings.abi import Accelerator, Features, Integrator, LancerError, LightKind, Pass, PixelFilter, Status
from addon.bindings.session import Scene, Session

INTEGRATORS = [Integrator.PATH, Integrator.CLASSIC, Integrator.NORMALS]


def bits(snapshot, pieces=None):
    """Return all passes of a render as bytes; pieces: the sizes of its sample ranges."""
    with Session.upload(snapshot) as session:
        first = 0
        for count in pieces or [snapshot.settings.samples]:
            session.render(first, count)
            while not session.wait(0.1).finished:
                pass
            first += count
        assert first == snapshot.settings.samples
        plain = {which.name: session.read(which).tobytes() for which in Pass}
        return plain | {str(which): session.read(which).tobytes() for which in tiny_scenes.EXTRAS}


def picture(samples=4, **settings):
    return showroom(40, samples=samples, **settings)


@pytest.fixture(scope="module", params=INTEGRATORS, ids=lambda i: i.name)
def reference(request):
    return request.param, bits(picture(integrator=request.param, threads=1))


def assert_same(reference, **settings):
    integrator, expected = reference
    got = bits(picture(integrator=integrator, **settings))
    assert [name for name in expected if got[name] != expected[name]] == []


@pytest.mark.parametrize("threads", [1, 2, 3, 7, 0])
def test_threads(reference, threads):
    assert_same(reference, threads=threads)


@pytest.mark.parametrize("tile_size", [1, 5, 16, 37, 64, 1000])
def test_tile_sizes(reference, tile_size):
    assert_same(reference, threads=2, tile_size=tile_size)


@pytest.mark.parametrize("integrator", INTEGRATORS, ids=lambda i: i.name)
def test_vertices_are_counted_the_same(integrator):
    """Statistics count the same vertices, however the work is divided and whatever the passes."""

    def counted(**settings):
        with Session.upload(picture(integrator=integrator, **settings)) as session:
            session.render_all()
            return session.statistics().vertices

    alone = {"passes": (Pass.COMBINED,)}
    expected = counted(threads=1, **alone)
    assert expected > 0
    for settings in ({"threads": 7}, {"threads": 2, "tile_size": 5}, {"threads": 2, "tile_size": 1000}):
        assert counted(**settings, **alone) == expected
    assert counted(threads=2) == expected


@pytest.mark.parametrize("accelerator", Accelerator)
def test_accelerators(reference, accelerator):
    assert_same(reference, threads=2, accelerator=accelerator)


@pytest.mark.parametrize("features", Features)
def test_features(reference, features):
    assert_same(reference, threads=2, features=features)


@pytest.mark.parametrize("name", ["lambert", "mirror", "lens", "opacity", "sky", "sun"])
def test_special_kernels_equal_the_general_one(name):
    """Scenes with one feature each, whose special kernels omit the most."""
    room = showroom(24, samples=4)
    keep = {"lambert": [0], "mirror": [0, 3], "lens": [0, 1], "opacity": [0, 5], "sky": [0, 1, 2], "sun": [0, 6]}[name]
    # Vectors name instances by their numbers in the whole room.
    rows = {f.name: getattr(room.instances, f.name) for f in dataclasses.fields(room.instances)} | {"vectors": None}
    by_instance = {k for k, v in rows.items() if v is not None and len(v) == len(room.instances)} - {"names", "slots"}
    rows = {k: v[keep] if k in by_instance else v for k, v in rows.items()}
    lights = {"sky": (), "sun": room.lights[2:3]}.get(name, room.lights[:1])
    camera = room.camera if name == "lens" else dataclasses.replace(room.camera, lens_radius=0.0)
    small = dataclasses.replace(
        room,
        instances=type(room.instances)(**rows),
        lights=lights,
        camera=camera,
        world=room.world if name == "sky" else (0, 0, 0),
    )
    for integrator in (Integrator.PATH, Integrator.CLASSIC):
        special, general = (bits(tiny_scenes.with_settings(small, integrator=integrator, features=f)) for f in Features)
        assert special == general, integrator.name


@pytest.mark.parametrize("pieces", [[1] * 16, [8, 8], [1, 1, 2, 4, 8], [3, 13], [15, 1], [5, 6, 5]])
def test_split_sample_ranges(pieces):
    whole = bits(picture(16, pixel_filter=PixelFilter.BLACKMAN_HARRIS, filter_width=1.5))
    assert bits(picture(16, pixel_filter=PixelFilter.BLACKMAN_HARRIS, filter_width=1.5), pieces) == whole


def test_a_second_session_repeats_the_first():
    """Sessions of one scene share nothing but the scene."""
    snapshot = picture()
    with Scene.upload(snapshot) as scene:
        with (
            Session(scene, snapshot.camera, snapshot.settings) as one,
            Session(scene, snapshot.camera, snapshot.settings) as two,
        ):
            one.render(0, 4)
            two.render(0, 4)
            for session in (one, two):
                while not session.wait(0.1).finished:
                    pass
            assert np.array_equal(one.read(), two.read())


def test_another_seed_gives_another_picture():
    assert bits(picture(seed=1))["COMBINED"] != bits(picture(seed=2))["COMBINED"]


@pytest.mark.parametrize("integrator", INTEGRATORS, ids=lambda i: i.name)
def test_debug_sample_is_what_the_film_got(integrator):
    """With one sample the bits equal the film's; with more the film is their mean in double, rounded to float32."""
    snapshot = showroom(12, samples=1, integrator=integrator)
    with Session.upload(snapshot) as session:
        session.render_all()
        film = session.read()
        for y in range(12):
            for x in range(12):
                rgba, vertices = session.debug_sample(x, y, 0)
                assert rgba.tobytes() == film[y, x].tobytes(), (x, y)
                assert len(vertices) >= (integrator == Integrator.NORMALS and film[y, x, 0] == 0.0)
    snapshot = showroom(6, samples=8, integrator=integrator)
    with Session.upload(snapshot) as session:
        session.render_all()
        film = session.read()
        for y in range(6):
            for x in range(6):
                mean = np.mean([session.debug_sample(x, y, s)[0].astype(float) for s in range(8)], axis=0)
                # The film may sum short blocks in float32: 8 additions of 6e-8.
                assert np.allclose(film[y, x], mean, rtol=6e-7, atol=1e-7), (x, y)


def test_debug_sample_tells_the_path():
    """debug_sample returns the positions and throughputs of a path between two known planes."""
    snapshot = tiny_scenes.two_planes(2.0, 0.8, 1.0, max_bounces=3)
    with Session.upload(snapshot) as session:
        rgba, vertices = session.debug_sample(0, 0, 0)
    assert len(vertices) >= 2
    first = vertices[0]
    assert np.allclose(first.position, (0, 0, 2), atol=1e-5) and abs(first.t - 1.0) < 1e-12 and first.instance == 1
    assert first.depth == 0 and np.all(first.beta == 1.0) and first.material == 1
    assert vertices[1].instance == 0 and np.allclose(vertices[1].position[2], 0.0, atol=1e-12)
    assert np.allclose(vertices[1].beta, 0.8, rtol=1e-6)
    assert np.allclose(rgba[:3], 0.8, rtol=0.5)


def test_debug_sample_tells_the_same_vertices_with_any_passes():
    """A path that ends at a dark surface tells this vertex, although no light comes from it."""
    numbers = []
    for passes in ((Pass.COMBINED,), (Pass.COMBINED, Pass.NORMAL)):
        with Session.upload(showroom(8, samples=1, max_bounces=0, passes=passes)) as session:
            numbers.append([len(session.debug_sample(x, y, 0)[1]) for y in range(8) for x in range(8)])
    assert numbers[0] == numbers[1] and max(numbers[0]) > 1


def test_debug_vertices_are_cut_at_capacity():
    snapshot = tiny_scenes.furnace(0.99, 0.1, max_bounces=50)
    with Session.upload(snapshot) as session:
        _, some = session.debug_sample(0, 0, 0, capacity=2)
        _, all_of_them = session.debug_sample(0, 0, 0, capacity=64)
    assert len(some) == 2 and len(all_of_them) > 2 and some.tobytes() == all_of_them[:2].tobytes()


def test_cancel_keeps_what_is_there():
    """After a cancel the picture is finite and of the same scene, and further renders are refused."""
    snapshot = showroom(64, samples=100000, threads=2)
    with Session.upload(snapshot) as session:
        session.render(0, 2)
        while not session.wait(0.1).finished:
            pass
        first = session.read()
        session.render(2, 99998)
        session.wait(0.3)
        session.cancel()
        progress = session.wait(5.0)
        assert progress.finished and progress.cancelled and progress.fraction < 1.0
        kept = session.read()
        assert np.all(np.isfinite(kept)) and not np.array_equal(kept, first)
        # The mean is that of the first samples within their noise.
        assert abs(kept[..., :3].mean() - first[..., :3].mean()) < 0.2 * first[..., :3].mean()
        assert np.allclose(kept[..., 3], 1.0, atol=1e-6)
        with pytest.raises(LancerError) as error:
            session.render(0, 1)
        assert error.value.status in (Status.ERROR_STATE, Status.ERROR_ARGUMENT)


def test_reading_while_rendering():
    """A picture read during a render is finite, and opaque where there are samples."""
    with Session.upload(showroom(64, samples=100000, threads=2)) as session:
        session.render(0, 100000)
        for _ in range(20):
            session.wait(0.02)
            now = session.read()
            assert np.all(np.isfinite(now)) and np.all(now[..., 3] <= 1.0 + 1e-6)
        session.cancel()
        while not session.wait(0.1).finished:
            pass
        assert session.statistics().invalid_samples == 0


def under_many_lamps():
    """Return a scene with many visible lamps, which are sampled and intersected through a tree of several levels."""
    room = picture(passes=(Pass.COMBINED,))
    lamp = room.lights[0]
    lights = []
    for index in range(300):
        matrix = lamp.matrix.copy()
        matrix[:3, 3] = index % 20 / 2 - 5, index // 20 / 2 - 4, 2.0 + index % 7 / 4
        kind = LightKind.POINT if index % 3 else LightKind.SPOT
        emission = (0.1 * (index % 5 + 1),) * 3
        lights.append(dataclasses.replace(lamp, matrix=matrix, kind=kind, spot_angle=1.0, emission=emission))
    return dataclasses.replace(room, lights=tuple(lights))


ISA_SCRIPT = """
import sys
sys.path[:0] = sys.argv[2:]
import hashlib, tiny_scenes, test_determinism
from addon.bindings.session import Session
h = hashlib.sha256()
for integrator in test_determinism.INTEGRATORS:
    snapshot = test_determinism.picture(integrator=integrator)
    for data in test_determinism.bits(snapshot).values():
        h.update(data)
with Session.upload(test_determinism.under_many_lamps()) as session:
    session.render_all()
    h.update(session.read().tobytes())
with Session.upload(snapshot) as session:
    name = session.statistics().instruction_set
open(sys.argv[1], "w").write(name + " " + h.hexdigest())
"""


def test_instruction_sets(tmp_path):
    """LANCER_ISA selects a lower instruction set, with the same bits."""
    results, places = {}, [HERE, os.path.join(HERE, "helpers"), os.path.join(HERE, "physics")]
    for isa in ("", "scalar", "sse4", "avx2", "avx512"):
        out = tmp_path / f"isa{isa}"
        environment = {**os.environ, "LANCER_ISA": isa} if isa else {k: v for k, v in os.environ.items() if k != "LANCER_ISA"}
        command = [sys.executable, "-c", ISA_SCRIPT, str(out), ROOT, *places]
        done = subprocess.run(command, env=environment, capture_output=True, text=True, cwd=ROOT)
        assert done.returncode == 0, done.stderr
        results[isa] = out.read_text().split(" ")
    hashes = {digest for *_, digest in results.values()}
    assert len(hashes) == 1, results
    # The lowest set runs everywhere; a request beyond the processor's sets selects its best one.
    assert results["scalar"][0] == "scalar"
    assert results["sse4"][0] != results[""][0] or "SSE" in results[""][0].upper(), results
