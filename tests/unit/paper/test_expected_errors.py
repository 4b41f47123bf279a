"""The interval of errors in sigmas: of which surveys, and what is printed of them."""

import numpy as np
import pandas as pd
import pytest

from linepose.config.platform import load_platform
from linepose.experiments.truth_error import POSE, POSITION, ROTATION
from linepose.geometry.pose import POSE_COLUMNS
from linepose.paper.expected_errors import errors_in_sigmas, quantile_table
from unit.paper.reproduced import PAPER


def test_interval_holds_99_per_cent_of_the_errors():
    errors = pd.DataFrame({"r_x_m": np.linspace(-3.0, 5.0, 1001)})
    row = quantile_table(errors).loc["r_x_m"]
    low, high = row["expected"] - row["tolerance"], row["expected"] + row["tolerance"]
    assert np.mean((errors["r_x_m"] >= low) & (errors["r_x_m"] <= high)) == pytest.approx(0.99, abs=0.002)
    assert row["expected"] == pytest.approx(1.0)


def test_a_survey_depends_on_its_number_alone_and_its_error_is_of_its_size():
    platform = load_platform(PAPER.parent / "platforms", "ladybird-sim")
    errors = errors_in_sigmas(platform, 2, seed=5)
    assert list(errors.columns) == [*POSE_COLUMNS, POSITION, ROTATION, POSE]
    np.testing.assert_array_equal(errors.iloc[0], errors_in_sigmas(platform, 1, seed=5).iloc[0])
    assert not np.array_equal(errors.iloc[0], errors.iloc[1])
    assert np.all((errors[POSE] > 0.5) & (errors[POSE] < 20.0))
