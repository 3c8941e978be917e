"""Export of Blender's materials to records, in the bpy module of this Python and in Debian's Blender 3.4.1, without tracing.

Blender stores single precision: the tolerance is 1e-6, sixteen times its rounding of 2^-24.
"""

import re

import blenders
import numpy as np
import pytest
from blenders import MODULE, PROGRAM
from stored import near

pytestmark = pytest.mark.parametrize("which", [MODULE, PROGRAM])
WHITE, NONE = [1.0, 1.0, 1.0], [0.0, 0.0, 0.0]
GGX, BECKMANN, ASHIKHMIN_SHIRLEY, MULTI_GGX = range(4)


@pytest.fixture(scope="module")
def answers():
    return {}


@pytest.fixture
def case(which, answers, tmp_path):
    """Return a function that runs a case once in each Blender and caches its result for all tests."""

    def run(name, *arguments, where="material_cases"):
        if (which, name) not in answers:
            answers[which, name] = blenders.run(which, tmp_path, where, name, *arguments)
        return answers[which, name]

    return run


def test_graphs_end_with_their_export(case):
    assert case("freed") == 0


class Nodes:
    """An independent evaluation of the nodes of weights, for a given value of the mesh attribute."""

    def __init__(self, material, number):
        self.material, self.number = material, number

    def value(self, parameter):
        if not isinstance(parameter, dict):
            return np.array(parameter, float)
        node, kind = self.material["nodes"][parameter["node"]], self.material["node kinds"][parameter["node"]]
        inputs = [self.value(item) for item in node["inputs"]]
        if kind == "ATTRIBUTE":
            return np.full(3, self.number)
        if kind == "VECTOR_MATH":
            a, b = inputs[:2]
            return {0: a + b, 2: a * b, 8: np.full(3, np.sum(a * b))}[node["option"]]
        assert kind == "MATH", kind
        a, b = inputs[0], inputs[1]
        result = {0: a + b, 1: a - b, 2: a * b}[node["option"]]
        return np.clip(result, 0.0, 1.0) if node["flags"] == 1 else result


def test_own_models(case):
    got = case("own_models")
    kd, ks = [0.5, 0.25, 0.125], [0.75, 0.5, 0.25]
    for model, kind in (("KD_KS", "BECKMANN"), ("PHONG", "PHONG"), ("BLINN_PHONG", "BLINN_PHONG")):
        material = got[model]
        assert material["kinds"] == ["LAMBERT", kind]
        diffuse, glossy = material["lobes"]
        assert diffuse["color"] == near(kd) and glossy["color"] == near(ks)
        assert material["ambient"] == near([0.5, 0.25, 0.0]) and material["transmittance"] == material["emission"] == NONE
        if model == "KD_KS":
            assert (glossy["roughness"], glossy["ior"]) == near((0.25, 1.75))
        else:
            assert glossy["shininess"] == near(40.0)
    matt = got["MINNAERT"]
    assert matt["kinds"] == ["MINNAERT"] and matt["lobes"][0]["color"] == near(kd)
    assert matt["lobes"][0]["shininess"] == near(0.75) and matt["ambient"] == near([0.5, 0.25, 0.0])


def test_principled_under_newest_names(case):
    got = case("principled")
    new = got["version"] >= [4, 0]
    rules = sum(got["version"] >= first for first in ([4, 0], [4, 5], [5, 0], [5, 2]))
    plain, full = (got[name]["lobes"][0]["principled"] for name in ("plain", "all"))
    assert (plain["rules"], plain["distribution"], full["distribution"]) == (rules, GGX, MULTI_GGX if new else GGX)
    assert plain["base_color"] == near([0.75, 0.5, 0.25])
    assert [plain[name] for name in ("roughness", "ior", "specular", "metallic")] == near([0.5, 1.5, 0.5, 0.0])
    # A tint is a colour from 4.0 on, and a share before.
    assert plain["specular_tint"] == (WHITE if new else NONE)
    assert [full[n] for n in ("metallic", "transmission", "coat", "sheen")] == near([0.25, 0.5, 0.5, 0.25])
    assert [full[n] for n in ("anisotropic", "anisotropic_rotation", "coat_roughness")] == near([0.75, 0.125, 0.03])
    # Anisotropic lobes need a tangent, around z of the generated coordinates.
    assert got["plain"]["lobes"][0]["tangent"] == NONE and got["plain"]["attributes"] == []
    assert got["all"]["lobes"][0]["tangent"] == {"node": 0} and got["all"]["attributes"] == ["generated"]
    assert got["all"]["node kinds"] == ["TANGENT"] and got["all"]["nodes"][0]["option"] == 2
    assert got["plain"]["messages"] == []
    assert ["Clearcoat leaves" in text for text in got["all"]["messages"]] == ([] if new else [True])


def test_principled_alpha_and_emission(case):
    got = case("principled")
    veil, unseen = got["veil"], got["unseen"]
    assert veil["lobes"][0]["weight"] == near([0.25] * 3) and veil["transmittance"] == near([0.75] * 3)
    assert unseen["lobes"] == [] and unseen["transmittance"] == WHITE
    # Emission under a coat belongs to the lobe; without a coat it is the material's.
    light = near([3.0, 1.5, 0.75])
    lamp, coated = got["lamp"], got["lamp under coat"]
    assert lamp["emission"] == light and lamp["lobes"][0]["principled"]["emission"] == NONE
    if got["version"] >= [4, 0]:
        assert coated["emission"] == NONE and coated["lobes"][0]["principled"]["emission"] == light
    else:
        assert coated["emission"] == light


def test_textured_principled(case):
    got = case("principled")["textured"]
    lobe = got["lobes"][0]
    for number in (0.0, 0.25, 1.0):
        nodes = Nodes(got, number)
        assert nodes.value(lobe["weight"])[0] == near(number)
        assert nodes.value(got["transmittance"])[0] == near(1.0 - number)
    assert got["node kinds"][lobe["principled"]["base_color"]["node"]] == "ATTRIBUTE"
    assert got["node kinds"][lobe["normal"]["node"]] == "NORMAL_MAP"
    assert got["attributes"] == ["paint", "shade", "tangent:"]
    assert any("textured" in line for line in got["panel"])


def _method(version):
    """Return the number of the default method: Random Walk, whose meaning has changed twice."""
    return 2 if version < [4, 0] else 3 if version >= [5, 2] else 1 | 4 * (version < [4, 4])


def test_light_below_surfaces(case):
    got, version = case("principled"), case("principled")["version"]
    wax = got["wax"]
    assert (wax["messages"], wax["kinds"]) == ([], ["PRINCIPLED"])
    values = wax["lobes"][0]["principled"]
    assert values["subsurface"] == 0.5 and values["subsurface_option"] == _method(version)
    # The defaults of Radius and Scale, whose product the core takes; without a scale, only before 4.0.
    scale = 1.0 if version < [4, 0] else 0.05 if version < [5, 2] else 0.005
    assert values["subsurface_radius"] == near([scale * length for length in (1.0, 0.2, 0.1)])
    assert got["plain"]["lobes"][0]["principled"]["subsurface"] == 0.0
    node = case("closures")["SubsurfaceScattering"]["lobes"][0]
    scale = 1.0 if version < [4, 0] else scale
    assert node["option"] == _method(version) and node["edge"] == near([scale * length for length in (1.0, 0.2, 0.1)])


KINDS = {
    "BsdfAnisotropic": "GLOSSY",
    "BsdfDiffuse": "LAMBERT",
    "BsdfGlass": "GLASS",
    "BsdfGlossy": "GLOSSY",
    "BsdfMetallic": "CONDUCTOR",
    "BsdfPrincipled": "PRINCIPLED",
    "BsdfHair": "HAIR",
    "BsdfHairPrincipled": "HAIR_FIBRE",
    "BsdfRefraction": "REFRACTION",
    "BsdfSheen": "SHEEN",
    "BsdfToon": "TOON",
    "BsdfTranslucent": "TRANSLUCENT",
    "BsdfVelvet": "SHEEN",
    "SubsurfaceScattering": "SUBSURFACE",
}


def test_every_closure_of_this_blender(case):
    got = case("closures")
    version = got["version"]
    got = {name: material for name, material in got.items() if isinstance(material, dict)}
    for name, kind in KINDS.items():
        if name in got:
            assert got[name]["kinds"] == [kind] and got[name]["messages"] == [], name
            assert got[name]["transmittance"] == got[name]["emission"] == NONE, name
    assert ("BsdfVelvet" in got, "BsdfSheen" in got) == (version < [4, 0], version >= [4, 0])
    assert got["BsdfTransparent"]["transmittance"] == WHITE and got["BsdfTransparent"]["lobes"] == []
    if "BsdfRayPortal" in got:
        assert got["BsdfRayPortal"]["transmittance"] == WHITE and got["BsdfRayPortal"]["lobes"] == []
    assert got["Emission"]["emission"] == WHITE and got["Holdout"]["holdout"] == 1.0
    assert got["colour as shader"]["emission"] == near([0.5] * 3)
    # All other nodes give a message.
    silent = {*KINDS, "BsdfTransparent", "BsdfRayPortal", "Emission", "Holdout", "Background", "MixShader", "AddShader"}
    silent |= {"colour as shader", "rough", "velvet", "GGX", "BECKMANN", "ASHIKHMIN_SHIRLEY", "MULTI_GGX"}
    assert all(material["messages"] for name, material in got.items() if name not in silent)


def test_values_of_closures(case):
    got = case("closures")
    for name, number in (("GGX", GGX), ("BECKMANN", BECKMANN), ("ASHIKHMIN_SHIRLEY", ASHIKHMIN_SHIRLEY)):
        lobe = got[name]["lobes"][0]
        assert lobe["distribution"] == number and lobe["tangent"] == {"node": 0}
        assert [lobe[n] for n in ("roughness", "anisotropy", "rotation")] == near([0.25, 0.5, 0.125])
    assert got["MULTI_GGX"]["lobes"][0]["distribution"] == MULTI_GGX
    assert got["velvet"]["lobes"][0]["distribution"] == BECKMANN
    if "BsdfSheen" in got:
        assert got["BsdfSheen"]["lobes"][0]["distribution"] == GGX
    rough = got["rough"]["lobes"][0]
    assert got["rough"]["kinds"] == ["DIFFUSE"] and rough["roughness"] == near(0.5)
    assert rough["color"] == near([0.5, 0.25, 0.125]) and rough["option"] == (1 if got["version"] >= [4, 3] else 0)


def test_constant_shares_of_shaders(case):
    """1/4 red, 1/8 glass, 1/8 holdout, 1/4 transparent and emission of 4, and 3/4 blue."""
    got = case("mixing")["mixed"]
    assert got["nodes"] == [] and got["kinds"] == ["LAMBERT", "GLASS"]
    diffuse, glass = got["lobes"]
    # Two diffuse lobes of different colours are merged.
    assert diffuse["color"] == near([0.25, 0.0, 0.75]) and diffuse["weight"] == WHITE
    assert glass["color"] == WHITE and glass["weight"] == near([0.125] * 3)
    assert got["holdout"] == near(0.125) and got["transmittance"] == near([0.125, 0.25, 0.25])
    assert got["emission"] == near([1.0] * 3)


def test_varying_shares_of_shaders(case):
    """The mix with a factor from a mesh attribute, which is clamped."""
    got = case("mixing")["textured"]
    assert got["kinds"] == ["LAMBERT", "GLASS", "LAMBERT"] and got["attributes"] == ["shade"]
    for number, factor in ((0.0, 0.0), (0.3, 0.3), (1.0, 1.0), (1.5, 1.0), (-1.0, 0.0)):
        nodes = Nodes(got, number)
        red, glass, blue = (nodes.value(lobe["weight"]) for lobe in got["lobes"])
        assert red[0] == near(1 - factor) and blue[0] == near(factor) and glass[0] == near(0.5 * (1 - factor))
        assert nodes.value(got["transmittance"]) == near(np.array([0.5, 1.0, 1.0]) * (1 - factor))
        assert nodes.value(got["emission"]) == near(np.full(3, 4.0 * (1 - factor)))
        assert nodes.value(got["holdout"])[0] == near(0.5 * (1 - factor))


def test_what_adds_nothing_is_left_out_and_long_chains_are_followed(case):
    got = case("mixing")
    assert got["nothing"]["lobes"] == [] and got["nothing"]["panel"] == ["Black"]
    assert got["long"]["kinds"] == ["LAMBERT"] and got["long"]["lobes"][0]["color"] == near([0.0, 0.0, 1.0])
    assert got["doubled"]["lobes"][0]["color"] == near([1024.0, 0.0, 0.0])
    sums = got["sums"]
    assert sums["node kinds"].count("MATH") == 1000 and sums["messages"] == []
    nodes = {}
    for number, node in enumerate(sums["nodes"]):
        a = node["inputs"][0] if sums["node kinds"][number] == "MATH" else 0.25
        nodes[number] = a if isinstance(a, float) else nodes[a["node"]] + node["inputs"][1]
    assert nodes[sums["lobes"][0]["roughness"]["node"]] == near(0.25 + 1000 / 1024)


def test_displacement_by_method(case):
    got = case("displacements")
    for method in ("BUMP", "DISPLACEMENT", "BOTH"):
        material = got[method]
        lobe = material["lobes"][0]
        if method == "BUMP":
            assert material["displacement"] == NONE
        else:
            node = material["nodes"][material["displacement"]["node"]]
            assert material["node kinds"][material["displacement"]["node"]] == "DISPLACEMENT"
            assert node["option"] == 1 and node["inputs"][1:3] == near([0.25, 2.0])
        if method == "DISPLACEMENT":
            assert lobe["normal"] == NONE
            continue
        number = lobe["normal"]["node"]
        bump = material["nodes"][number]
        assert material["node kinds"][number] == "BUMP"
        # No other value reads the nodes of the height.
        assert bump["first"] <= bump["inputs"][2]["node"] < number
        strength, distance, height, normal, width = bump["inputs"]
        assert (strength, distance, normal) == (1.0, 1.0, NONE) and width == (0.1 if got["version"] >= [4, 5] else 1.0)
        assert Nodes(material, 0.75).value(height)[0] == near((0.75 - 0.25) * 2.0)


def test_bumps_on_bumps(case):
    got = case("displacements")["chained"]
    number = got["lobes"][0]["normal"]["node"]
    second = got["nodes"][number]
    first = second["inputs"][3]["node"]
    assert got["node kinds"][number] == got["node kinds"][first] == "BUMP"
    assert second["flags"] == 1 and got["nodes"][first]["flags"] == 0
    # The first bump is not among the nodes that are evaluated again for the second's height.
    assert first < second["first"] <= second["inputs"][2]["node"] < number
    assert got["nodes"][first]["inputs"][3] == NONE


def test_attributes_that_a_material_reads(case):
    got = case("attributes")
    reader = got["Reader"]
    assert got["Plain"]["attributes"] == {}
    # An attribute and a sum may leave 0 to 1, where Blender 3 follows them.
    clamped = ["Metallic", "Roughness"] if got["version"][0] == 3 else []
    assert [re.search("input '(.*)' is clamped to 0 to 1", text)[1] for text in got["messages"]] == clamped
    triangles, original = np.array(reader["triangles"]), np.array(got["original"])
    face = [0, 0, 1, 2, 3, 4]
    domain, values = reader["attributes"]["Second"]
    at = original[triangles].reshape(-1, 3)
    assert domain == "CORNER" and np.array(values) == near(np.stack([0.5 * at[:, 0] + 0.5, 0.25 * at[:, 1]], axis=1))
    domain, values = reader["attributes"]["Paint"]
    assert domain == "VERTEX" and np.array(values) == near(np.array([[0.1 * i, 0.5, 0.25, 0.5] for i in range(5)]))
    domain, values = reader["attributes"]["number"]
    assert domain == "FACE" and np.array(values)[:, 0] == near(np.array(face, float))
    # The modifier moved the vertices; GENERATED has the positions before it, relative to the mesh's bounds.
    assert np.abs(np.array(reader["positions"]) - original).max() > 0.05
    domain, values = reader["attributes"]["generated"]
    assert domain == "VERTEX" and np.array(values) == near((original - [-1, -1, 0]) / 2.0)
    # Tangents lie in the faces, along u, which increases with x.
    domain, values = reader["attributes"]["tangent:Second"]
    values = np.array(values)
    assert domain == "CORNER" and np.linalg.norm(values[:, :3], axis=1) == near(np.ones(18), 1e-5)
    assert (values[:6, 0] > 0.99).all() and set(np.abs(values[:, 3])) == {1.0}


def test_random_trees_never_fail(case):
    got = case("fuzz", 120, where="material_fuzz_cases")
    # Random trees give enough variety; no node refers to a later one or has values that the core refuses.
    assert got["kinds"] > 80 and got["lobes"] > 20 and got["nodes"] > 20
    assert got["backward"] == got["wild"] == 0


def test_the_panel_tells_the_lobes_of_principled(case):
    """The panel shows the core's lobes at normal incidence, computed once for each change."""
    got = case("panel")
    assert got["asked"] == ["matt", "metal", "coated", "coated"]
    said = got["said"]
    assert all(line == lines[0] for lines in said.values() for line in lines)
    (matt,), (metal,), coated = (said[name][0] for name in ("matt", "metal", "coated"))
    assert matt.endswith("iffuse Kd: 0.8 0.4 0.2")
    # At normal incidence the albedo of metal is its base colour minus the loss by masking, about half of alpha^2 = 0.09^2.
    name, told = metal.split(": ")
    albedo, roughness, *_ = told.split(", ")
    assert name.endswith("Ks") and 0.5 * (1.0 - 0.09**2) < float(albedo) <= 0.5 and roughness == "roughness 0.3"
    # From 4.0 on the coat reduces the light of the base.
    coat, diffuse = sorted(coated[:2], key=lambda line: "Kd" in line)
    assert ["Clearcoat leaves" in line for line in coated[2:]] == ([] if got["version"] >= [4, 0] else [True])
    assert "roughness 0.1, IOR 1.5" in coat and 0.7 < float(diffuse.split("Kd: ")[1]) <= 0.8
    assert "Passes: 0.75" in said["veil"][0]
