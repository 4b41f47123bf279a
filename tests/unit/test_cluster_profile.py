"""Every rule says what it asks of a scheduler, and the profile for SLURM names rules that are there."""

import re
from pathlib import Path

import yaml

from linepose.experiments.registry import EXPERIMENTS

ROOT = Path(__file__).parents[2]
RULES = "\n\n".join(path.read_text() for path in sorted((ROOT / "workflow" / "rules").glob("*.smk")))
BLOCKS = re.findall(r"^ *rule(?: (\w+))?:.*?\n(.*?)(?=^\S|\Z)", RULES, re.MULTILINE | re.DOTALL)
PROFILE = yaml.safe_load((ROOT / "profiles" / "slurm" / "config.yaml").read_text())


def test_every_job_says_what_memory_and_time_it_asks_for():
    scripts = [(name, block) for name, block in BLOCKS if "script:" in block]
    assert len(scripts) > 20
    for name, block in scripts:
        assert re.search(r"resources:\n +\*\*\(?(LIGHT|LONG|BATCHES)\b", block), name or block


def test_groups_name_rules_that_are_there_and_no_long_experiment():
    names = {name for name, _ in BLOCKS} | {one.name for one in EXPERIMENTS}
    assert PROFILE["groups"].keys() <= names
    short = {one.name for one in EXPERIMENTS if not one.in_batches}
    assert {name for name, group in PROFILE["groups"].items() if group == "experiments"} <= short
    assert PROFILE["group-components"].keys() == {"experiments"}
    assert PROFILE["group-components"]["experiments"] >= len(short)


def test_no_job_asks_for_more_cores_than_a_group_has():
    said = [int(threads) for threads in re.findall(r"threads: (\d+)", RULES)]
    most = max([*said, *(one.cores or 1 for one in EXPERIMENTS)])
    assert most <= PROFILE["max-threads"] <= PROFILE["cores"]
