"""config/paper/regression.yaml: which numbers each platform is held against."""

from pathlib import Path
from typing import Literal

from pydantic import Field

from linepose.config.platform import read_yaml
from linepose.settings import Settings, validated

NumberSetName = Literal["ladybird", "ladybird_attitude", "ladybird_simulated", "shrimp_simulated"]


class Declarations(Settings):
    """What is declared of the regression before anything is run."""

    platforms: dict[str, NumberSetName] = Field(description="The set of numbers that each platform is held against.")


def load_declarations(path: Path) -> Declarations:
    """The declarations in a file; raises InputError naming the first key that is wrong."""
    return validated(Declarations, read_yaml(path), str(path))
