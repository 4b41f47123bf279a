"""The examples of docs/exports.md run as they stand there, on a platform that has been run."""

import re
from pathlib import Path

import numpy as np
import yaml

from unit import made_up

PAGE = Path(__file__).parents[4] / "docs" / "exports.md"
BLOCK = re.compile(r"^```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def test_examples_run_and_read_the_same_pose(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    made_up.write_results(tmp_path / "results" / "myrobot")
    (tmp_path / "config" / "platforms").mkdir(parents=True)
    values = made_up.PLATFORM | {"map_frame": {"crs": "EPSG:32756"}}
    (tmp_path / "config" / "platforms" / "myrobot.yaml").write_text(yaml.safe_dump(values))
    blocks = BLOCK.findall(PAGE.read_text())
    assert len(blocks) == 6
    namespace = {}
    for block in blocks:
        exec(compile(block, str(PAGE), "exec"), namespace)
    half_turn = np.diag([1.0, -1.0, -1.0, 1.0])
    pose = namespace["pose"]
    np.testing.assert_allclose(half_turn @ namespace["base_from_camera"], pose["matrix"], atol=1e-9)
    inverse = np.array(namespace["camera"]["T_cam_imu"]) @ pose["matrix"]
    np.testing.assert_allclose(inverse, np.eye(4), atol=1e-9)
    assert namespace["points"].crs.to_epsg() == 32756
    assert len(namespace["on_the_globe"]) == 4 + 2 * 24


def test_page_names_every_format_and_no_other():
    from linepose.pipeline.exports.registry import EXPORTS

    named = re.findall(r"^\| `(\w+)` \|", PAGE.read_text(), re.MULTILINE)
    assert sorted(named) == EXPORTS.names()
