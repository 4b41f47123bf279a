"""What two disjoint subsets must be."""

import pytest

from linepose.errors import InputError
from linepose.experiments.repeatability import check_disjoint


def test_shared_observation_is_named():
    with pytest.raises(InputError, match=r"repeatability: found observation 3 5 in both subsets"):
        check_disjoint([1, 3, 5], [5, 2, 3], "repeatability")
    check_disjoint([1, 3], [2, 4], "repeatability")
