"""Light linking: a light reaches some sets of receivers, and passes some sets of blockers."""

import dataclasses

import numpy as np
import pytest
import tiny_scenes
from tiny_scenes import lambert, move, rotate_x, scale

from addon.bindings.abi import LancerError
from addon.bindings.enums import Integrator, LightKind, LobeKind, Pass
from addon.bindings.snapshot import Camera, Instance, InstanceTable, Light, Lobe, Material

MARKED = 1  # a set
UNLIT = 1 << MARKED
GLOW = Material("glow", lobes=(), emission=(6.0, 4.0, 2.0))
MIRROR = Material("mirror", lobes=(Lobe(LobeKind.MIRROR, color=(0.9, 0.9, 0.9)),))
ROUGH = tiny_scenes.beckmann(0.9, 0.3)


def links(receiver=0, blocker=0, unlit=0, clear=0):
    return receiver, blocker, unlit, clear


def lamp(name, place, intensity=9.0, **fields):
    return Light(name, move(*place), LightKind.POINT, emission=(intensity,) * 3, radius=0.2, hidden_from=0, **fields)


def lamps(count, **of_first):
    """Return balls of light in a ring; the first one has the given links."""
    turns = np.arange(count) * 2 * np.pi / count
    made = [lamp(f"lamp {i}", (2.0 * np.cos(turn), 2.0 * np.sin(turn), 1.5)) for i, turn in enumerate(turns)]
    return [dataclasses.replace(made[0], **of_first), *made[1:]]


def glowing(**fields):
    """Return an emitting square above the origin that faces down."""
    return Instance(mesh=0, matrix=move(0.3, 0.2, 1.2) @ rotate_x(np.pi), materials=(1,), name="glow", **fields)


def floor(material=0, **fields):
    return Instance(mesh=0, matrix=scale(4.0), materials=(material,), name="floor", **fields)


def picture(instances, lights=(), samples=1 << 12, **settings):
    """Return the light of the floor's middle, as one scene of a matt, a glowing, a mirroring and a rough material."""
    snapshot = tiny_scenes.scene(
        instances,
        [lambert(0.8), GLOW, MIRROR, ROUGH],
        lights,
        [tiny_scenes.quad(1.0)],
        camera=tiny_scenes.pencil((0.0, 0.0, 0.4), (0.0, 0.0, 0.0), 1e-3, 2),
        **{"samples": samples, "max_bounces": 2, **settings},
    )
    return tiny_scenes.radiance(snapshot)


@pytest.mark.parametrize("integrator", [Integrator.PATH, Integrator.CLASSIC])
@pytest.mark.parametrize("lights", [[lamps(1, unlit_sets=UNLIT)[0]], []])
def test_a_receiver_without_light_is_black(integrator, lights):
    emitters = [] if lights else [glowing(links=links(unlit=UNLIT))]
    marked = [floor(links=links(receiver=MARKED)), *emitters]
    assert not picture(marked, lights, samples=64, integrator=integrator).any()
    assert picture([floor(), *emitters], lights, samples=64, integrator=integrator).all()


@pytest.mark.parametrize("count", [1, 3, 40])
def test_it_is_as_if_the_light_were_not_there(count):
    """The trees of a set have only the lights that reach it: the same choices, so the same bits as without the light.

    The normalisation and a mirror's rays do not depend on the light, which lies within the others' bounds.
    """
    marked = [floor(3, links=links(receiver=MARKED))]
    there = [
        *lamps(count),
        Light("extra", move(0.1, 0.1, 1.0), LightKind.POINT, emission=(50.0,) * 3, radius=0.1, unlit_sets=UNLIT),
    ]
    assert np.array_equal(picture(marked, there, samples=64), picture(marked, lamps(count), samples=64))
    assert not np.array_equal(picture([floor(3)], there, samples=64), picture([floor(3)], lamps(count), samples=64))


@pytest.mark.parametrize("material", [0, 2, 3])
def test_an_emitting_object_that_is_hidden_from_rays_gives_the_same(material):
    """A linked emitter gives no light to the receiver: as one whose material does not emit."""
    marked = floor(material, links=links(receiver=MARKED))
    dark = dataclasses.replace(glowing(), materials=(4,))
    black = Material("black", lobes=())

    def seen(emitter):
        snapshot = tiny_scenes.scene(
            [marked, emitter], [lambert(0.8), GLOW, MIRROR, ROUGH, black], lamps(2), [tiny_scenes.quad(1.0)],
            camera=tiny_scenes.pencil((0.0, 0.0, 0.4), (0.0, 0.0, 0.0), 1e-3, 2), samples=1 << 12, max_bounces=2,
        )  # fmt: skip
        return tiny_scenes.radiance(snapshot)

    # 16384 samples of light within a factor of ten: a standard error below 1 %.
    assert seen(glowing(links=links(unlit=UNLIT))) == pytest.approx(seen(dark), rel=0.05)


def test_the_camera_sees_a_light_that_lights_nothing():
    emitter = glowing(links=links(unlit=(1 << 64) - 1))
    camera = Camera(
        tiny_scenes.look_at((0.3, 0.2, 0.0), (0.3, 0.2, 1.2), (0, 1, 0)), width=1, height=1, window=(-0.01, 0.01) * 2
    )
    snapshot = tiny_scenes.scene([emitter], [lambert(), GLOW], [], [tiny_scenes.quad(1.0)], camera=camera)
    assert tiny_scenes.radiance(snapshot) == pytest.approx(GLOW.emission)


def wall(**fields):
    """Return a square between the floor's middle and the light above it."""
    return Instance(mesh=0, matrix=move(0.15, 0.1, 0.6) @ scale(3.0), materials=(0,), name="wall", **fields)


@pytest.mark.parametrize("material", [0, 2, 3])
@pytest.mark.parametrize("kind", ["lamp", "mesh"])
def test_light_passes_the_blockers_that_it_is_told(kind, material):
    """The wall is black and hidden from all but shadow rays: the floor shows the light as if the wall were not there.

    Light samples find a matt floor's light, a mirror's rays only the light on their way, a rough floor both: none may be
    missing or counted twice. 16384 samples within a factor of ten: a standard error below 1 %.
    """
    if kind == "lamp":
        emitters, lights = (
            [],
            [Light("lamp", move(0.3, 0.2, 1.2), LightKind.AREA, emission=(6,) * 3, size=(1, 1), clear_sets=2)],
        )
    else:
        emitters, lights = [glowing(links=links(clear=2))], []
    blocking, clear = wall(hidden_from=0b1111), wall(hidden_from=0b1111, links=links(blocker=1))
    ground = floor(material)
    without = picture([ground, *emitters], lights)
    assert picture([ground, clear, *emitters], lights) == pytest.approx(without, rel=0.05)
    if material != 2:
        assert picture([ground, blocking, *emitters], lights).max() < 0.5 * without.max()


def test_a_blocker_that_is_not_told_blocks():
    light = Light("lamp", move(0.3, 0.2, 1.2), LightKind.POINT, emission=(6,) * 3, clear_sets=1 << 5)
    assert not picture([floor(), wall(hidden_from=0b1111, links=links(blocker=1))], [light], samples=64).any()


def test_sets_are_below_64():
    with pytest.raises(LancerError, match="set 64 of light linking"):
        picture([floor(links=links(receiver=64))], lamps(1))


def test_links_are_kept_with_a_snapshot(tmp_path):
    table = InstanceTable.build([floor(links=links(3, 5, 1 << 63, 2)), floor()])
    snapshot = dataclasses.replace(
        tiny_scenes.scene(), instances=table, lights=tuple(lamps(1, unlit_sets=7, clear_sets=1 << 63))
    )
    snapshot.save(tmp_path / "linked.npz")
    assert type(snapshot).load(tmp_path / "linked.npz") == snapshot
    assert InstanceTable.build([floor()]).links is None


def test_passes_add_up():
    """Light that passes blockers goes into the passes of its first scattering, as any other light."""
    lights = lamps(3, clear_sets=2)
    parts = (Pass.GLOSSY_DIRECT, Pass.GLOSSY_INDIRECT, Pass.GLOSSY_COLOR)
    snapshot = tiny_scenes.scene(
        [floor(3), wall(links=links(blocker=1))], [lambert(0.8), GLOW, MIRROR, ROUGH], lights, [tiny_scenes.quad(1.0)],
        camera=tiny_scenes.pencil((0.0, 0.0, 0.4), (0.0, 0.0, 0.0), 1e-3, 2), samples=256, max_bounces=2,
        passes=(Pass.COMBINED, *parts),
    )  # fmt: skip
    whole, direct, indirect, color = (tiny_scenes.render(snapshot, which)[..., :3] for which in (Pass.COMBINED, *parts))
    # Single precision over 256 samples.
    assert (direct + indirect) * color == pytest.approx(whole, rel=1e-4)
