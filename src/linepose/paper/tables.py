"""The paper's Tables 2-5 with the obtained numbers beside the printed ones, for people to read."""

from collections.abc import Mapping, Sequence
from typing import Any, Final

import numpy as np
import pandas as pd
import pyarrow as pa

from linepose.geometry.pose import POSE_COLUMNS, SIGMA_COLUMNS
from linepose.paper.declarations import Declarations
from linepose.paper.hand_measured import as_printed
from linepose.survey.navigation import SIGMA_COLUMNS as NAVIGATION_SIGMA_COLUMNS
from linepose.tables import floats, texts

PUBLISHED_NAVIGATION: Final = pa.schema(
    [*texts("platform", "quantity"), *floats("published", "obtained", "relative_difference")]
)
PUBLISHED_POSES: Final = pa.schema(
    [
        *texts("platform", "set", "parameter"),
        *floats("published", "obtained", "difference_sigmas", "published_sigma", "obtained_sigma"),
        *texts("note"),
    ]
)
_STAGES: Final = {"all_25": "all", "inliers_16": "inliers", "hand_measured": "hand_measured"}


def navigation_table(platform: str, published: Sequence[float], obtained: pd.DataFrame) -> pd.DataFrame:
    """Table 2: median navigation sigmas, one row a quantity, m and deg; `obtained` as in `NAVIGATION_SIGMA`."""
    sigma = obtained.iloc[0][list(NAVIGATION_SIGMA_COLUMNS)].to_numpy(dtype=float, copy=True)
    sigma[3:] = np.rad2deg(sigma[3:])
    return pd.DataFrame(
        {
            "platform": platform,
            "quantity": [name.replace("_rad", "_deg") for name in NAVIGATION_SIGMA_COLUMNS],
            "published": np.asarray(published, dtype=float),
            "obtained": sigma,
            "relative_difference": sigma / np.asarray(published, dtype=float) - 1,
        }
    )


def pose_table(
    platform: str,
    published: Mapping[str, Mapping[str, Sequence[float]]],
    obtained: pd.DataFrame,
    notes: Mapping[str, str],
) -> pd.DataFrame:
    """Tables 3-5: one row a set of observations and number of the pose, with the difference in published sigmas.

    `obtained` has a row for each set, indexed by its name; a published set without one is left out.
    """
    parts = []
    for name in (name for name in published if name in obtained.index):
        printed, own = published[name], obtained.loc[name]
        pose, sigma = np.asarray(printed["pose"], dtype=float), np.asarray(printed["sigma"], dtype=float)
        own_pose = own[list(POSE_COLUMNS)].to_numpy(dtype=float)
        parts.append(
            pd.DataFrame(
                {
                    "platform": platform,
                    "set": name,
                    "parameter": POSE_COLUMNS,
                    "published": pose,
                    "obtained": own_pose,
                    "difference_sigmas": (own_pose - pose) / sigma,
                    "published_sigma": sigma,
                    "obtained_sigma": own[list(SIGMA_COLUMNS)].to_numpy(dtype=float),
                    "note": notes.get(name, ""),
                }
            )
        )
    return pd.concat(parts, ignore_index=True)


def published_tables(
    platform: str,
    published: Mapping[str, Any],
    navigation_sigma: pd.DataFrame,
    poses: pd.DataFrame,
    subsets: pd.DataFrame,
    repeatability: pd.DataFrame,
    declarations: Declarations,
) -> dict[str, pd.DataFrame]:
    """Tables 2 to 5 of the field platform by name, from the results of its stages and experiments.

    Sets of which numbers are declared to deviate have the reason as their note.
    """
    stages = as_printed(poses).loc[list(_STAGES.values())].set_axis(list(_STAGES), axis="index")

    def table(number: int, printed: Mapping[str, Any], obtained: pd.DataFrame) -> pd.DataFrame:
        notes = {name: declarations.reason(f"{platform}, Table {number}, {name}, ") for name in printed}
        return pose_table(platform, printed, obtained, notes)

    return {
        "table2": navigation_table(platform, published["table2"]["ladybird"], navigation_sigma),
        "table3": table(3, published["table3"]["ladybird"], stages),
        "table4": table(4, published["table4"], subsets.set_index("subset")),
        "table5": table(5, published["table5"], repeatability.set_index("subset")),
    }


def markdown(table: pd.DataFrame, title: str) -> str:
    """The table in Markdown under a heading, numbers to four significant digits."""
    rows = [list(table.columns), ["---"] * len(table.columns)]
    rows += [[_cell(value) for value in row] for row in table.itertuples(index=False)]
    lines = "\n".join(f"| {' | '.join(map(str, row))} |" for row in rows)
    return f"# {title}\n\n{lines}\n"


def _cell(value: object) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)
