"""What config.yaml may say of the coverage study."""

import pytest

from linepose.config.coverage import CoverageSection
from linepose.errors import InputError

REGIMES = {"white": {"white_level": 1.0}, "shared": {"shared_level": 1.0}}


def test_adjustment_alone_estimates_unless_told_otherwise():
    assert CoverageSection(regimes=REGIMES).regimes["white"].noise_models == ["adjustment"]


def test_hand_measurement_that_would_not_count_is_told():
    regime = {"hand_measured_prior": True, "noise_models": ["adjustment", "published"]}
    with pytest.raises(InputError, match="hand_measured_prior with noise_models published"):
        CoverageSection(regimes={"white": regime})


@pytest.mark.parametrize(
    ("pools", "found"),
    [
        ({"both": ["white", "shard"]}, "pools.both: found shard"),
        ({"both": []}, "pools.both: found no regime"),
        ({"white": ["white", "shared"]}, "pools.white: found the name of a regime"),
    ],
)
def test_pool_of_regimes_that_are_none_is_told(pools, found):
    with pytest.raises(InputError, match=found):
        CoverageSection(regimes=REGIMES, pools=pools)


def test_pool_of_regimes():
    assert CoverageSection(regimes=REGIMES, pools={"both": ["white", "shared"]}).pools == {"both": ["white", "shared"]}
