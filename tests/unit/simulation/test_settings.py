import copy

import numpy as np
import pytest

from linepose.errors import InputError
from linepose.simulation.settings import settings_from_dict


def test_degrees_become_radians(section):
    settings = settings_from_dict(section)
    np.testing.assert_allclose(settings.reported_sigma.euler_rad, np.deg2rad([0.24, 0.26, 0.11]))
    assert settings.passes[1].channel_roll_rad == pytest.approx(np.deg2rad(4.0))


def test_settings_are_hashable(section):
    assert hash(settings_from_dict(section)) == hash(settings_from_dict(copy.deepcopy(section)))


@pytest.mark.parametrize(
    ("change", "place"),
    [
        ({"passes": [{"north_m": 0.0}]}, "simulation.passes.0"),
        ({"sead": 3}, "simulation.sead"),
        ({"true_pose": [1.0, 2.0]}, "simulation.true_pose"),
        ({"board": {"position_m": [0, 0, 0], "euler_deg": "east"}}, "simulation.board.euler_rad"),
        ({"faults": [{"observation": 4}]}, "simulation.faults.*`like` are left out by `faults: .]`"),
    ],
)
def test_wrong_key_is_named(section, change, place):
    with pytest.raises(InputError, match=place):
        settings_from_dict(section | change)
