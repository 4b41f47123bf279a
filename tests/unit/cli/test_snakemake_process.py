"""What a child process tells is kept in a file and heard; progress bars are heard alone."""

import sys

import pytest
import typer

from linepose.cli import snakemake_process
from linepose.cli.run import _run
from linepose.cli.snakemake_process import BY_KEYBOARD, Followed, follow_snakemake
from linepose.cli.stage_lines import StageLines
from linepose.errors import one_line

CHILD = """
import sys
print("terminal" if sys.stderr.isatty() else "pipe", file=sys.stderr)
for step in (1, 2):
    print(f"\\r {step}0%|#   | {step}/10", end="", file=sys.stderr)
print("\\nlast words", end="", file=sys.stderr)
sys.exit(3)
"""


@pytest.fixture
def child(monkeypatch, tmp_path):
    """Follows a process that prints, in the place of Snakemake; its exit code."""
    monkeypatch.setattr(snakemake_process, "_command", lambda snakefile, root: [sys.executable, "-c", CHILD])

    def follow(hear, hear_bar=None):
        return follow_snakemake(tmp_path / "Snakefile", tmp_path, [], tmp_path / "logs" / "run.log", hear, hear_bar)

    return follow


WITH_BAR = """
import sys
from tqdm import tqdm
for step in tqdm(range(2), disable=None, mininterval=0):
    pass
"""


def test_messages_are_heard_and_kept(child, tmp_path):
    heard = []
    assert child(heard.append) == Followed(3, None)
    assert heard[0] == "pipe"
    assert heard[-1] == "last words"
    assert (tmp_path / "logs" / "run.log").read_text().splitlines() == heard


def test_bars_are_drawn_for_a_terminal_and_not_kept(child, tmp_path):
    heard, bars = [], []
    assert child(heard.append, bars.append) == Followed(3, None)
    assert heard == ["terminal", "last words"]
    assert bars == ["10%|#   | 1/10", "20%|#   | 2/10"]
    assert (tmp_path / "logs" / "run.log").read_text().splitlines() == heard


def test_a_run_that_the_keyboard_ends_is_followed_to_its_end(child, tmp_path):
    def hear(message):
        raise KeyboardInterrupt

    assert child(hear) == Followed(BY_KEYBOARD, None)
    assert (tmp_path / "logs" / "run.log").read_text().splitlines()[-1] == "last words"


def test_a_job_finds_a_terminal_in_which_its_bar_has_room(child, monkeypatch):
    monkeypatch.setattr(snakemake_process, "_command", lambda *_: [sys.executable, "-c", WITH_BAR])
    heard, bars = [], []
    assert child(heard.append, bars.append) == Followed(0, None)
    assert any("1/2" in bar for bar in bars)
    assert max(map(len, bars)) < 80
    assert heard == []


def test_a_run_whose_log_has_no_room_is_followed_to_its_end(child, tmp_path):
    (tmp_path / "logs").mkdir()
    (tmp_path / "logs" / "run.log").symlink_to("/dev/full")
    heard = []
    followed = child(heard.append)
    assert followed.code == 3
    assert heard[-1] == "last words"
    assert "run.log: found no space left on device, expected a disk to write to; make" in one_line(followed.log_fault)


NO_ROOM = "run.log: found no space left on device, expected a disk to write to; make room on it"
STAGE_FAILED = """
import sys
print("linepose.pipeline.optimise: found no minimum", file=sys.stderr)
print("Error in rule optimise:", file=sys.stderr)
sys.exit(1)
"""


@pytest.mark.parametrize("is_interrupted", [False, True])
def test_a_log_without_room_is_one_more_line_of_a_run_that_failed(monkeypatch, tmp_path, capsys, is_interrupted):
    def interrupt(self, message):
        raise KeyboardInterrupt

    monkeypatch.setattr(snakemake_process, "_command", lambda *_: [sys.executable, "-c", STAGE_FAILED])
    if is_interrupted:
        monkeypatch.setattr(StageLines, "hear", interrupt)
    (tmp_path / "results" / "logs" / "mine").mkdir(parents=True)
    (tmp_path / "results" / "logs" / "mine" / "run.log").symlink_to("/dev/full")
    with pytest.raises(typer.Exit) as ended:
        _run(tmp_path / "Snakefile", tmp_path, ["mine"], [])
    told = capsys.readouterr().err
    assert ended.value.exit_code == (BY_KEYBOARD if is_interrupted else 1)
    assert NO_ROOM in told
    assert ("stopped by the keyboard" if is_interrupted else "optimise failed: found no minimum") in told


def test_a_run_that_stopped_outside_a_stage_names_no_log_that_lacks_its_fault(monkeypatch, tmp_path, capsys):
    fault = "import sys; sys.exit('SomeError: why')"
    monkeypatch.setattr(snakemake_process, "_command", lambda *_: [sys.executable, "-c", fault])
    (tmp_path / "results" / "logs" / "mine").mkdir(parents=True)
    (tmp_path / "results" / "logs" / "mine" / "run.log").symlink_to("/dev/full")
    with pytest.raises(typer.Exit):
        _run(tmp_path / "Snakefile", tmp_path, ["mine"], [])
    no_room, why, stopped = capsys.readouterr().err.splitlines()
    assert NO_ROOM in no_room
    assert why == "SomeError: why"
    assert stopped == "linepose: run mine stopped: the fault stands above"
