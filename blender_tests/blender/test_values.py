"""Value nodes with constants: what the exporter folds them to is what Cycles of the same Blender shows for them."""

import blenders
import numpy as np
import pytest
from blenders import MODULE, PROGRAM

# Cycles shows values on top of 128, of which single precision keeps 2^-17 = 7.6e-6, and computes with numbers up to 8 in its
# own single precision, whose rounding of 2^-24 some ten steps add up to 5e-6.
LIMIT = 2e-5


@pytest.mark.parametrize("which", [MODULE, PROGRAM])
@pytest.mark.parametrize("name, least", [("mathematics", 70), ("vectors", 55), ("colours", 70), ("links", 12)])
def test_folded_values(which, name, least, tmp_path):
    got = blenders.run(which, tmp_path, "value_cases", name)
    got.pop("console")
    assert len(got) >= least
    wrong = {what: pair for what, pair in got.items() if np.abs(np.subtract(*pair)).max() > LIMIT}
    assert not wrong
