"""A platform's summary beside its page: what the study's page says of platforms that other runs made."""

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any, Final

import numpy as np

from linepose.errors import InputError
from linepose.pipeline.checks import Check, Level
from linepose.pipeline.pose_tables import PoseNumber
from linepose.pipeline.summary import PlatformSummary
from linepose.pipeline.verdict import Verdict

SUMMARY: Final = "summary.json"
PAGE: Final = "report.html"


def write_summary(summary: PlatformSummary, path: Path) -> None:
    """Write a summary as JSON."""
    values = asdict(summary) | {"quaternion": summary.quaternion.tolist()}
    path.write_text(json.dumps(values, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")


def read_summary(path: Path) -> PlatformSummary:
    """Read what `write_summary` wrote; raises InputError for another file."""
    try:
        values: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
        verdict = values.pop("verdict")
        checks = tuple(Check(**check | {"level": Level(check["level"])}) for check in verdict["checks"])
        numbers = {key: [PoseNumber(**one) for one in values.pop(key)] for key in ("rotation_vector", "euler")}
        return PlatformSummary(
            **values | {"quaternion": np.array(values["quaternion"])} | numbers,
            verdict=Verdict(Level(verdict["level"]), verdict["sentence"], checks),
        )
    except (OSError, ValueError, KeyError, TypeError) as error:
        found = " ".join(str(error).split())[:80]
        remedy = f"run `linepose run {path.parent.name}` again"
        raise InputError(str(path), found, "a platform's summary", remedy) from None


def summaries_on_disk(results: Path) -> dict[str, Path]:
    """The summary of each platform below the folder of all results that has a page, by the platform's name."""
    found = sorted(results.glob(f"*/{SUMMARY}"))
    return {path.parent.name: path for path in found if (path.parent / PAGE).is_file()}
