import numpy as np
import pandas as pd
import pyarrow as pa
import pytest
from scipy.stats import chi

from linepose.errors import InputError
from linepose.experiments.consistency import (
    CONSISTENCY,
    CONSISTENCY_SUMMARY,
    NAMED_SUBSETS,
    Comparisons,
    Group,
    groups_of,
    summarise_consistency,
)
from linepose.experiments.splits import split_numbers
from linepose.geometry.pose import POSE_COLUMNS
from linepose.likelihood.published import PublishedLikelihood
from linepose.likelihood.shared import SharedLikelihood
from unit.experiments.conftest import TRUE_POSE, GaussianLikelihood
from unit.experiments.conftest import make_survey as made_survey
from unit.likelihood.small_survey import CAMERA, POSE, Truth, make_survey

SIGMA = 1e-3 * np.array([10, 15, 20, 3, 4, 2])  # so small that turns and differences of rotation vectors are one


@pytest.fixture
def comparisons():
    """Two groups of direct measurements of one pose, by a model that tells the right covariance."""
    random = np.random.default_rng(5)
    groups = {
        name: Group(
            GaussianLikelihood(made_survey(12), TRUE_POSE + random.normal(size=(12, 6)) * SIGMA, np.diag(SIGMA**2)),
            TRUE_POSE + 0.01,
        )
        for name in ("own", "other")
    }
    return Comparisons({"published": groups}, ([1, 2, 3], [4, 5, 6, 7]), TRUE_POSE, seed=3)


def expected_distance(group, first, second, other=None):
    means = [g.likelihood.select(n).means for g, n in ((group, first), (other or group, second))]
    difference = means[0].mean(axis=0) - means[1].mean(axis=0)
    return np.sqrt(np.sum(difference**2 / (SIGMA**2 * (1 / len(first) + 1 / len(second)))))


def test_halves_are_the_seed_and_the_index_and_their_distance_is_in_sigmas(comparisons):
    table = comparisons.random_halves("published", "own", range(3))
    group = comparisons.groups["published"]["own"]
    for _, row in table.iterrows():
        first, second = split_numbers(np.arange(1, 13), 6, 3, row["split"])
        assert row["observations_1"] == " ".join(map(str, first))
        # turns and differences of rotation vectors are alike to a per cent at a few thousandths of a radian
        assert row["mahalanobis"] == pytest.approx(expected_distance(group, first, second), rel=0.02)


def test_pairs_are_groups_and_named_subsets(comparisons):
    table = comparisons.pairs("published").set_index("comparison")
    own, other = comparisons.groups["published"].values()
    everything = list(range(1, 13))
    assert table.loc["own against other", "mahalanobis"] == pytest.approx(
        expected_distance(own, everything, everything, other), rel=0.02
    )
    assert table.loc[NAMED_SUBSETS, "mahalanobis"] == pytest.approx(
        expected_distance(own, [1, 2, 3], [4, 5, 6, 7]), rel=0.02
    )


def test_parts_make_the_same_table_in_any_batches(comparisons):
    by_one = comparisons.parts(4, 1)
    by_three = comparisons.parts(4, 3)
    assert len(by_one) == 1 + 2 * 4
    assert len(by_three) == 1 + 2 * 2
    tables = [pd.concat([make() for make in parts.values()], ignore_index=True) for parts in (by_one, by_three)]
    pd.testing.assert_frame_equal(*tables)
    pa.Table.from_pandas(tables[0], schema=CONSISTENCY, preserve_index=False)


def test_too_few_observations_are_told(comparisons):
    group = comparisons.groups["published"]["own"]
    few = Comparisons({"published": {"own": Group(group.likelihood.select([1, 2, 3]), TRUE_POSE)}}, (), TRUE_POSE, 3)
    with pytest.raises(InputError, match=r"own: found 3 accepted observations, expected at least 4"):
        few.parts(4, 1)


def test_groups_start_at_the_optima_of_the_table():
    survey = make_survey(5, 4, Truth(0.5), seed=2)
    levels = {"log_shared_level": -0.7, "log_white_level": -3.0, "log_pixel_level": 0.1}
    levels |= {"principal_point_px": 300.0, "focal_length_m": 8e-3}
    rows = [
        {"noise_model": model, "set": "inliers", **dict(zip(POSE_COLUMNS, POSE, strict=True)), **extra}
        for model, extra in (("published", {}), ("shared", levels))
    ]
    groups = groups_of({"own": survey}, {"own": "inliers"}, CAMERA, pd.DataFrame(rows))
    assert isinstance(groups["published"]["own"].likelihood, PublishedLikelihood)
    assert isinstance(groups["shared"]["own"].likelihood, SharedLikelihood)
    np.testing.assert_array_equal(groups["published"]["own"].optimum, POSE)
    np.testing.assert_array_equal(groups["shared"]["own"].optimum, [*POSE, *levels.values()])


def test_summary_of_right_and_of_half_sigmas():
    right = chi.ppf((np.arange(200) + 0.5) / 200, 6)
    rows = [
        {"noise_model": model, "comparison": "halves", "split": index, "mahalanobis": factor * distance}
        for model, factor in (("right", 1.0), ("half", 2.0))
        for index, distance in enumerate([*right, np.nan])
    ]
    summary = summarise_consistency(pd.DataFrame(rows))
    pa.Table.from_pandas(summary, schema=CONSISTENCY_SUMMARY, preserve_index=False)
    first, second = summary.to_dict("records")
    assert (first["n_splits"], first["n_open"]) == (200, 1)
    assert first["sigma_factor"] == pytest.approx(1.0, abs=0.005)
    assert second["sigma_factor"] == pytest.approx(2.0, abs=0.01)
    assert (first["share_beyond_68"], first["share_beyond_95"]) == (0.32, 0.05)
    assert first["kolmogorov"] == pytest.approx(0.5 / 200)
    assert second["kolmogorov"] > 0.5


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
