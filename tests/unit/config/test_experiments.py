"""What a platform file may say of its experiments, and how it is told what it may not."""

import numpy as np
import pytest

from linepose.config.experiments import BasinSection, ExperimentsSection, SubsetSection
from linepose.errors import InputError
from linepose.settings import validated

RULE = {"angle": "roll", "count": 1}


def message(values: dict) -> str:
    with pytest.raises(InputError) as caught:
        validated(ExperimentsSection, values, "robot.yaml")
    assert "\n" not in str(caught.value)
    return str(caught.value)


@pytest.mark.parametrize(
    ("values", "told"),
    [
        ({"basin": {"n_distances": 0}}, "robot.yaml: basin.n_distances: found 0"),
        ({"basin": {"maximum_angle_deg": 0}}, "basin.maximum_angle_deg: found 0"),
        ({"basin": {"optimisers": ["powel"]}}, "basin.optimisers.0: found 'powel'"),
        ({"basin": {"optimisers": []}}, "basin.optimisers"),
        ({"basin": {"n_angle": 5}}, "did you mean n_angles?"),
        ({"subsets": {"a": {}}}, "either observations or rules"),
        (
            {"subsets": {"a": {"observations": [1], "rules": [{"angle": "roll", "count": 1}]}}},
            "either observations or rules",
        ),
        ({"subsets": {"a": {"rules": [{"angle": "heading", "count": 2}]}}}, "found 'heading'"),
        ({"subsets": {"a": {"rules": [{"angle": "yaw", "count": 0}]}}}, "count: found 0"),
        ({"repeatability": {"first": {"observations": [1, 2]}}}, "both first and second"),
    ],
)
def test_what_cannot_be_is_one_clear_line(values, told):
    assert told in message(values)


def test_every_experiment_but_subsets_runs_by_default_and_null_leaves_one_out():
    default = validated(ExperimentsSection, {}, "robot.yaml")
    assert not default.subsets
    assert default.basin
    assert default.repeatability
    assert default.repeatability.first is None
    assert validated(ExperimentsSection, {"basin": None}, "robot.yaml").basin is None


def test_angles_become_radians():
    basin = BasinSection(maximum_angle_deg=90, region_angle_deg=30)
    assert basin.grid().maximum_angle_rad == pytest.approx(np.pi / 2)
    assert basin.region().angle_rad == pytest.approx(np.pi / 6)
    subset = SubsetSection(rules=[{"angle": "pitch", "minimum_deg": 1, "maximum_deg": 2, "count": 3}])
    rule = subset.rules[0].rule()
    assert (rule.angle, rule.count) == ("pitch", 3)
    assert np.degrees([rule.minimum_rad, rule.maximum_rad]) == pytest.approx([1, 2])
