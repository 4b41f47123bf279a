"""What is compared, and that a part of the work without a row is none."""

import numpy as np
import pytest

from linepose.experiments.consistency import Comparisons, Group


@pytest.mark.parametrize(
    ("subsets", "parts"),
    [([], ["shared-own-000000-000003"]), ([[1, 2], [3, 4]], ["shared-pairs", "shared-own-000000-000003"])],
)
def test_one_group_without_subsets_has_no_pairs(gaussian, subsets, parts):
    group = Group(gaussian, gaussian.means.mean(axis=0))
    work = Comparisons({"shared": {"own": group}}, subsets, np.zeros(6), 1).parts(3, 5)
    assert list(work) == parts
    for part in work.values():
        assert len(part())
