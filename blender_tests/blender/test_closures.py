"""Export of closures that few files use, films, hair and portals, in the bpy module and in Debian's Blender 3.4.1."""

import math

import blenders
import pytest
from blenders import MODULE, PROGRAM
from stored import near

pytestmark = pytest.mark.parametrize("which", [MODULE, PROGRAM])


@pytest.fixture
def case(which, tmp_path):
    return lambda name: blenders.run(which, tmp_path, "closure_cases", name)


def test_thin_films_and_walls(case):
    got = dict(case("films"))
    version = got.pop("version")
    del got["console"]
    kinds = {name.split()[0] for name in got}
    assert ("BsdfPrincipled" in kinds, "BsdfGlass" in kinds, "BsdfMetallic" in kinds) == (
        version >= [4, 2], version >= [5, 0], version >= [5, 0]
    )  # fmt: skip
    for name, material in got.items():
        assert material["messages"] == [], name
        (lobe,) = material["lobes"]
        values = lobe["principled"] or lobe
        # Cycles has no film of 0.1 nanometres or less.
        if name.endswith(" 300"):
            assert (values["film_thickness"], values["film_ior"]) == (300.0, 1.25), name
        else:
            assert values["film_thickness"] == 0.0, name
    assert ("wall" in got) == (version >= [5, 2])
    if "wall" in got:
        values = got["wall"]["lobes"][0]["principled"]
        assert (values["thin_wall"], values["wall_scattering"], values["wall_forward"]) == near([1.0, 0.5, 0.75])


def test_hair_on_meshes(case):
    got = dict(case("hair"))
    del got["version"], got["console"]
    lobes = {name: material["lobes"][0] for name, material in got.items()}
    if "Huang" in got:
        huang = lobes.pop("Huang")
        # It has one roughness, here 0.5 as the other nodes' radial one.
        assert huang["color"][0] == near(lobes["COLOR"]["color"][0])
        assert (huang["option"], huang["roughness"], huang["roughness_across"]) == near((1, 0.5, 0.75))
        assert (huang["edge"], huang["ior"]) == (near([2.0, 0.5, 0.25]), near(1.4))
    assert all(lobes[way]["option"] == 0 for way in ("COLOR", "MELANIN", "ABSORPTION"))
    assert all(material["messages"] == [] for material in got.values())
    scale = 5.969 + 0.5 * (-0.215 + 0.5 * (2.532 + 0.5 * (-10.73 + 0.5 * (5.574 + 0.5 * 0.245))))
    assert lobes["COLOR"]["color"] == near([(math.log(x) / scale) ** 2 for x in (0.25, 1e-30, 1.0)])
    # Random 1 adds half of Random Color's amount to the melanin: 0.5 becomes 0.75.
    melanin = -math.log(1.0 - 0.75)
    pigments = zip((0.506, 0.841, 1.653), (0.343, 0.733, 1.924), strict=True)
    assert lobes["MELANIN"]["color"] == near([melanin * (0.75 * dark + 0.25 * red) for dark, red in pigments])
    assert lobes["ABSORPTION"]["color"] == near([0.1, 0.2, 0.3])
    assert lobes["COLOR"]["edge"][0] == pytest.approx(0.75)
    # Without a tangent Cycles takes an edge of the triangle, and no offset.
    assert lobes["bare"]["offset"] == 0.0 and lobes["combed"]["offset"] == pytest.approx(0.5)
    assert got["bare"]["node kinds"] == ["COORDINATE"]


def test_portals_of_classic_are_told(case):
    got = dict(case("portals_of_classic"))
    del got["console"]
    if got:
        assert got.pop("PATH") == []
        (text,) = got["CLASSIC"]
        assert "the integrator Classic lets its rays pass straight on" in text


def test_portals(case):
    got = dict(case("portals"))
    del got["console"]
    if got.pop("version") < [4, 2]:
        assert got == {}
        return
    for name, material in got.items():
        assert material["messages"] == [] and material["kinds"] == ["LAMBERT"]
        assert material["transmittance"] == near([0.25, 0.125, 0.5])
        (portal,) = material["portals"]
        assert f"Portal: 0.25 0.125 0.5{', elsewhere' if name == 'moves' else ''}" in material["panel"]
        assert portal["weight"] == near([0.25, 0.125, 0.5]) and portal["direction"] == near([0.0, 2.0, 0.0])
        # Cycles reads a position from a link alone.
        assert (portal["moves"], isinstance(portal["position"], dict)) == ((1, True) if name == "moves" else (0, False))
