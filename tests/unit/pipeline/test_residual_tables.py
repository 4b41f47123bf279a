import numpy as np
import pandas as pd
import pytest

from linepose.likelihood.base import Residuals
from linepose.pipeline.residual_tables import (
    ESTIMATED_POINTS,
    POINT_COVARIANCE_COLUMNS,
    RESIDUALS,
    intraclass_correlation,
    residual_tables,
)
from linepose.survey.observations import POSITION_COLUMNS, survey_from_table
from linepose.tables import write_table
from unit import made_up


class FixedLikelihood:
    """Residuals that say where they stand: observation, point; point 3 was never estimated."""

    def __init__(self, survey):
        self.survey = survey

    def select(self, numbers):
        return FixedLikelihood(self.survey.select(numbers))

    def residuals(self, parameters):
        u = 10.0 * self.survey.number[:, None] + np.arange(4) + parameters[0]
        u[:, 3] = np.nan
        covariance = np.arange(36.0).reshape(4, 3, 3)
        points = np.arange(12.0).reshape(4, 3)
        points[3] = np.nan
        return Residuals(u, u / 2, np.stack([u, -u], axis=-1), points, covariance)


def test_tables_hold_each_residual_and_point_of_each_stage(tmp_path):
    likelihood = FixedLikelihood(survey_from_table(made_up.observations()))
    stages = {"all": [1, 2, 3], "inliers": [3, 1]}
    residuals, points = residual_tables(likelihood, stages, {"all": [0.0], "inliers": [0.5]})
    assert len(residuals) == 9 + 6
    row = residuals[(residuals["stage"] == "inliers") & (residuals["observation"] == 3) & (residuals["point"] == 2)]
    np.testing.assert_allclose(row[["error_px", "error_u_px", "error_v_px", "sigma_px"]], [[32.5, 32.5, -32.5, 16.25]])
    assert list(points["point"]) == [0, 1, 2] * 2
    origin = likelihood.survey.origin_m
    np.testing.assert_allclose(points.loc[1, list(POSITION_COLUMNS)].to_numpy(dtype=float) - origin, [3.0, 4.0, 5.0])
    np.testing.assert_allclose(
        points.loc[1, list(POINT_COVARIANCE_COLUMNS)].to_numpy(dtype=float), [9, 10, 11, 13, 14, 17]
    )
    write_table(residuals, tmp_path / "residuals.parquet", RESIDUALS)
    write_table(points, tmp_path / "points.parquet", ESTIMATED_POINTS)


@pytest.mark.statistical
@pytest.mark.parametrize("share", [0.0, 0.5, 0.9])
def test_what_a_view_has_in_common_is_found(share):
    random = np.random.default_rng(3)
    n_views, n_points = 400, 15
    error = np.sqrt(share) * random.standard_normal((n_views, 1)) + np.sqrt(1 - share) * random.standard_normal(
        (n_views, n_points)
    )
    views, points = np.indices(error.shape).reshape(2, -1)
    table = pd.DataFrame({"observation": views, "point": points, "error_u_px": error.ravel()})
    # the standard error of an intraclass correlation, Fisher (1925)
    sigma = (1 - share) * (1 + (n_points - 1) * share) * np.sqrt(2 / (n_points * (n_points - 1) * (n_views - 1)))
    assert intraclass_correlation(table, "error_u_px") == pytest.approx(share, abs=4 * sigma)


def test_views_of_one_point_say_nothing_of_what_they_share():
    assert np.isnan(
        intraclass_correlation(pd.DataFrame({"observation": [1, 2], "error_u_px": [1.0, 2.0]}), "error_u_px")
    )


def test_views_of_different_size_that_are_each_constant_share_everything():
    table = pd.DataFrame({"observation": [1, 1, 2, 2, 2], "error_u_px": [1.0, 1.0, 4.0, 4.0, 4.0]})
    assert intraclass_correlation(table, "error_u_px") == pytest.approx(1.0)


def test_what_two_small_views_share_is_that_of_the_analysis_of_variance():
    # means 1 and 5 of two: mean squares 2 (4 + 4) = 16 between and 4 / 2 = 2 within, (16 - 2) / (16 + 2)
    table = pd.DataFrame({"observation": [1, 1, 2, 2], "error_u_px": [0.0, 2.0, 4.0, 6.0]})
    assert intraclass_correlation(table, "error_u_px") == pytest.approx(14 / 18)
