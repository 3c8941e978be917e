"""Nodes and images through the C interface, against numpy in double: texture lookups and chains of nodes."""

import itertools

import numpy as np
import pytest

from addon.bindings.abi import LancerError
from addon.bindings.enums import (
    AlphaMode,
    Coordinate,
    Domain,
    Extension,
    Interpolation,
    LobeKind,
    MathOperation,
    MixMode,
    NodeKind,
    Transfer,
)
from addon.bindings.session import Scene
from addon.bindings.snapshot import (
    Image,
    Instance,
    InstanceTable,
    Lobe,
    Material,
    MeshAttribute,
    MeshData,
    Node,
    NodeRef,
    SceneSnapshot,
)

UV = Node(NodeKind.COORDINATE, Coordinate.UV)
STRAIGHT = 256
# Error of a lookup: u up to 3 has a rounding of 2^-24, times 37 texels, times a difference of texels of at most 1; the sRGB
# curve has a slope of at most 2.4 / 1.055.
PLACE = 3 * 37 * 2.0**-24 * 2.3


def values(nodes, uv, images=()):
    """Return the values (count, 4) of the last node at uv."""
    material = Material("nodes", (Lobe(LobeKind.DIFFUSE, NodeRef(len(nodes) - 1)),), nodes=tuple(nodes))
    with Scene.upload(SceneSnapshot(materials=(material,), images=tuple(images))) as scene:
        return scene.node(0, len(nodes) - 1, uv)


def image_node(vector, count=1, extension=Extension.REPEAT, interpolation=Interpolation.LINEAR, flags=0):
    flags |= int(extension) | int(interpolation) << 4
    return Node(NodeKind.IMAGE, image_count=count, flags=flags, inputs=(NodeRef(vector),))


def srgb(c):
    return np.where(c < 0.04045, c / 12.92, ((np.maximum(c, 0.0) + 0.055) / 1.055) ** 2.4)


def wrapped(index, size, extension):
    """Return the texel index for an index of the infinite row, and whether the texel exists."""
    if extension == Extension.REPEAT:
        return index % size, np.ones(index.shape, bool)
    if extension == Extension.MIRROR:
        folded = index % (2 * size)
        return np.where(folded < size, folded, 2 * size - 1 - folded), np.ones(index.shape, bool)
    inside = (index >= 0) & (index < size)
    return np.clip(index, 0, size - 1), inside if extension == Extension.CLIP else np.ones(index.shape, bool)


def weights(place, interpolation):
    """Return [(index, weight)] of the neighbours of a position in texels."""
    if interpolation == Interpolation.CLOSEST:
        return [(np.floor(place).astype(int), np.ones(place.shape))]
    first = np.floor(place - 0.5).astype(int)
    t = place - 0.5 - first
    if interpolation == Interpolation.LINEAR:
        return [(first, 1 - t), (first + 1, t)]
    spline = [(1 - t) ** 3, 3 * t**3 - 6 * t**2 + 4, 3 * (t**2 - t**3 + t) + 1, t**3]
    return [(first + k - 1, w / 6) for k, w in enumerate(spline)]


def looked_up(texels, uv, extension, interpolation):
    """Return the interpolated values of texels (height, width, 4) at uv (count, 2)."""
    height, width = texels.shape[:2]
    total = np.zeros((len(uv), 4))
    for (x, wx), (y, wy) in itertools.product(
        weights(uv[:, 0] * width, interpolation), weights(uv[:, 1] * height, interpolation)
    ):
        (x, x_there), (y, y_there) = wrapped(x, width, extension), wrapped(y, height, extension)
        total += (wx * wy * x_there * y_there)[:, None] * texels[y, x]
    return total


@pytest.fixture(scope="module")
def uv():
    """Return texture coordinates in and around the image, away from borders of texels, where rounding decides."""
    rng = np.random.default_rng(1)
    return (np.floor(rng.uniform(-1, 2, (400, 2)) * 37) + rng.uniform(0.1, 0.9, (400, 2))).astype(np.float32) / np.float32(37)


@pytest.fixture(scope="module")
def bytes_with_alpha():
    return np.random.default_rng(2).integers(0, 256, (37, 37, 4), dtype=np.uint8)


@pytest.mark.parametrize("interpolation", list(Interpolation), ids=lambda i: i.name)
@pytest.mark.parametrize("extension", list(Extension), ids=lambda e: e.name)
def test_lookup_of_every_kind(extension, interpolation, uv, bytes_with_alpha):
    exact = np.float64(uv)
    for texels, largest in ((bytes_with_alpha, 255), (bytes_with_alpha.astype(np.uint16) * 257, 65535)):
        image = Image("picture", texels, alpha=AlphaMode.CHANNEL_PACKED)
        got = values([UV, image_node(0, 1, extension, interpolation)], uv, [image])
        expected = looked_up(texels / largest, exact, extension, interpolation)
        assert np.abs(got - expected).max() < PLACE


def test_alpha_is_multiplied_in_bytes_and_divided_before_the_curve(uv, bytes_with_alpha):
    image = Image("picture", bytes_with_alpha, Transfer.SRGB, AlphaMode.STRAIGHT)
    stored = bytes_with_alpha.astype(int)
    stored[..., :3] = stored[..., :3] * stored[..., 3:] // 255
    mean = looked_up(stored / 255, np.float64(uv), Extension.EXTEND, Interpolation.LINEAR)
    for flags in (0, STRAIGHT):
        got = values([UV, image_node(0, 1, Extension.EXTEND, flags=flags)], uv, [image])
        color = mean[:, :3] / mean[:, 3:] if flags else mean[:, :3]
        solid = mean[:, 3] > 0.1
        assert np.abs(got[:, 3] - mean[:, 3]).max() < PLACE
        # Division by alpha amplifies the rounding.
        assert np.abs(got[:, :3] - srgb(color))[solid].max() < PLACE * (10 if flags else 1)


def test_tiles_and_their_gaps():
    tiles = [Image(f"tile {number}", np.full((4, 4, 3), number - 1000, np.float32), tile=number) for number in (1001, 1012)]
    got = values([UV, image_node(0, 2)], [(0.5, 0.5), (1.5, 1.5), (1.5, 0.5), (-2.0, 0.5)], tiles)
    assert got[:, :3].tolist() == [[1, 1, 1], [12, 12, 12], [1, 0, 1], [1, 0, 1]]


def test_a_matrix_leads_to_the_working_space():
    matrix = np.random.default_rng(3).uniform(-0.5, 1.5, (3, 3))
    color = np.array([0.2, 0.5, 0.9], np.float32)
    image = Image("picture", color.reshape(1, 1, 3), matrix=tuple(matrix.ravel()))
    assert values([UV, image_node(0)], [(0.5, 0.5)], [image])[0, :3] == pytest.approx(matrix @ color, rel=4e-7, abs=4e-7)


def test_a_chain_of_nodes(uv):
    """A mapped image mixed with a ramp: every result is the next node's input."""
    texels = np.random.default_rng(4).uniform(0, 1, (37, 37, 3)).astype(np.float32)
    turn, scale, shift = 0.3, (1.5, 0.5, 1.0), (0.2, -0.4, 0.0)
    chain = [
        UV,
        Node(NodeKind.MAPPING, inputs=(NodeRef(0), shift, (0.0, 0.0, turn), scale)),
        image_node(1, extension=Extension.MIRROR),
        Node(NodeKind.SEPARATE, 0, inputs=(NodeRef(0),)),
        Node(NodeKind.MATH, MathOperation.MULTIPLY_ADD, inputs=(NodeRef(3), 0.5, 0.25), flags=1),
        Node(NodeKind.MIX, MixMode.MULTIPLY, inputs=(NodeRef(4), NodeRef(2), (0.3, 0.6, 0.9))),
    ]
    got = values(chain, uv, [Image("picture", texels)])[:, :3]
    u, v = (np.float64(uv) * scale[:2]).T
    c, s = np.cos(turn), np.sin(turn)
    place = np.stack([c * u - s * v + shift[0], s * u + c * v + shift[1]], axis=1)
    four = np.dstack([texels, np.ones((37, 37))])
    picture = looked_up(four, place, Extension.MIRROR, Interpolation.LINEAR)[:, :3]
    factor = np.clip(uv[:, :1] * 0.5 + 0.25, 0, 1)
    assert np.abs(got - (picture * (1 - factor) + factor * picture * [0.3, 0.6, 0.9])).max() < 4 * PLACE


def test_bad_programs_name_material_node_and_value():
    def refusal(*nodes):
        with pytest.raises(LancerError) as caught:
            values(nodes, [(0.5, 0.5)])
        return str(caught.value)

    assert "material 'nodes': node 1: input 0 refers to node 1, which does not precede it" in refusal(
        UV, Node(NodeKind.ALPHA, inputs=(NodeRef(1),))
    )
    assert "material 'nodes': node 0: images 0 + 1 > 0 images" in refusal(Node(NodeKind.IMAGE, image_count=1))
    assert "material 'nodes': node 0: input 1 is nan" in refusal(
        Node(NodeKind.MATH, MathOperation.ADD, inputs=(1.0, float("nan")))
    )


def test_displacement_moves_what_rays_meet():
    """A scaled square whose material displaces it by an attribute of its mesh."""
    corners = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], np.float32)
    height = MeshAttribute("height", np.array([[0.0], [1.0], [1.0], [0.0]], np.float32), Domain.VERTEX)
    mesh = MeshData("square", corners, [(0, 1, 2), (0, 2, 3)], normals=[(0, 0, 1)] * 4, attributes=(height,))
    nodes = (
        Node(NodeKind.ATTRIBUTE, name="height"),
        Node(NodeKind.DISPLACEMENT, inputs=(NodeRef(0), 0.5, 2.0, (0.0, 0.0, 0.0))),
    )
    material = Material("lifted", (Lobe(LobeKind.DIFFUSE),), nodes=nodes, displacement=NodeRef(1))
    placed = Instance(matrix=np.diag([3.0, 3.0, 3.0, 1.0]), mesh=0, materials=(0,))
    snapshot = SceneSnapshot(meshes=(mesh,), materials=(material,), instances=InstanceTable.build([placed]))
    with Scene.upload(snapshot) as scene:
        x = np.array([0.3, 1.2, 2.4])
        hits = scene.intersect(np.stack([x, 0.5 + 0 * x, 50 + 0 * x], axis=1), (0, 0, -1))
    # (height - 1/2) 2 along z of the object, in a world three times as large.
    np.testing.assert_allclose(hits.position[:, 2], 3 * (x / 3 - 0.5) * 2, rtol=1e-6, atol=1e-6)
    slope = np.array([-2.0, 0.0, 1.0]) / np.sqrt(5)
    np.testing.assert_allclose(hits.normal, np.broadcast_to(slope, (3, 3)), atol=1e-6)
