"""What Snakemake tells of a run of several platforms, as one line a platform."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from linepose.cli.stage_lines import StageLines

_JUDGED: Final = re.compile(r"linepose\.report: (?!warning: )(.*)")
_FAILED: Final = re.compile(r" *Error in rule (\w+):")
_LOG: Final = re.compile(r" +log: (.+) \(check log file")


class PlatformLines(StageLines):
    """Tells each platform's verdict when its page is written, and of a stage that fails what its log ends with.

    Of several stages at work it cannot be told which of them says what, so `root`, the project's folder, is where logs
    are read.
    """

    def __init__(self, root: Path, n_platforms: int) -> None:
        super().__init__()
        self._root, self._n_platforms = root, n_platforms
        self._judged: set[str] = set()
        self._failed = ""

    def hear(self, message: str) -> str | None:
        """The line that a message gives rise to, if any."""
        if found := _JUDGED.fullmatch(message):
            return self._judge(found[1].partition(": ")[0], found[1])
        if found := _FAILED.match(message):
            super().hear(message.lstrip())
            self._failed = found[1]
            return None
        if self._failed and (found := _LOG.match(message)):
            failed, self._failed, self.log = self._failed, "", None
            log = found[1].split(", ")[0]  # of the rule; an executor's own stands behind it
            return f"{failed} failed: {self._last_word(log)} ({log})"
        line = super().hear(message)
        return None if line is not None and re.match(r" *\d+/\d+ ", line) else line

    def unheard(self, names: Sequence[str], since_s: float) -> list[str]:
        """Verdicts of pages that were written since a time (s since 1970) and of which no message has told."""
        from linepose.output.report.summary_file import read_summary

        lines = []
        for name in (one for one in names if one not in self._judged):
            path = self._root / "results" / name / "summary.json"
            if path.is_file() and path.stat().st_mtime >= since_s:
                lines.append(self._judge(name, f"{name}: {read_summary(path).verdict.sentence}"))
        return lines

    def _judge(self, name: str, told: str) -> str:
        self._judged.add(name)
        return f"{len(self._judged):{len(str(self._n_platforms))}d}/{self._n_platforms} {told}"

    def _last_word(self, log: str) -> str:
        try:
            *_, last = (self._root / log).read_text(encoding="utf-8").splitlines()
        except (OSError, ValueError):
            return "it ended without a word"
        return last.partition(": ")[2] if last.startswith("linepose.") else last
