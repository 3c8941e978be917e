"""Light linking in the snapshot: collections as sets."""

import blenders
from blenders import MODULE, PROGRAM

ALL = 2**64 - 1


def case(tmp_path, name, which=MODULE):
    return blenders.run(which, tmp_path, "linking_cases", name)


def test_sets(tmp_path):
    got = case(tmp_path, "sets")
    assert not got["messages"]
    sets = {name: rows[0][:2] for name, rows in got["links"].items()}
    light, shadow = ({name: pair[i] for name, pair in sets.items()} for i in range(2))
    assert len({light["included"], light["excluded"], 0}) == 3 and light["glowing"] == light["other"] == 0
    assert shadow["included"] == shadow["other"] != 0 and shadow["excluded"] == shadow["glowing"] == 0
    # A lamp whose collection includes objects lights these alone; the others light all but what they exclude.
    only = ALL & ~(1 << light["included"])
    assert got["lamps"] == {"first": [only, 0], "second": [only, 0], "shadowed": [0, 1 << shadow["included"]]}
    assert {name: rows[0][2:] for name, rows in got["links"].items() if any(rows[0][2:])} == {
        "glowing": [1 << light["excluded"], 0]
    }


def test_an_empty_collection_links_nothing(tmp_path):
    got = case(tmp_path, "unlinked")
    assert not got["kept"] and got["links"] == {"cube": [[0, 0, 0, 0]]} and got["lamps"] == {"Light": [0, 0]}


def test_blender_3_has_none(tmp_path):
    assert not case(tmp_path, "unlinked", PROGRAM)["kept"]


def test_an_instancer_goes_before_what_it_shows(tmp_path):
    got = case(tmp_path, "instances")
    sets = sorted(row[0] for row in got["links"]["shown"])
    assert len(set(sets)) == 2 and 0 not in sets


def test_limits_are_told(tmp_path):
    got = case(tmp_path, "too_many")
    assert all(any(words in line for line in got["messages"]) for words in ("70 collections", "64 sets")), got["messages"]
    assert max(row[0][0] for row in got["links"].values()) == 63
