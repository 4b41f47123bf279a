"""What Snakemake tells of a run, as one line a stage."""

import re
from typing import Final

_N_STAGES: Final = re.compile(r"total +(\d+)")
_BEGUN: Final = re.compile(r"(?:local)?rule (\w+):")
_SAID: Final = re.compile(r"linepose\.(?:\w+\.)*(\w+): (?!warning: )(.*)")
_FINISHED: Final = re.compile(r"Finished jobid: \d+ \(Rule: (\w+)\)")
_FAILED: Final = re.compile(r"Error in rule (\w+):")
_LOG: Final = re.compile(r" +log: (.+) \(check log file")
_FAULT: Final = re.compile(r"\w*(Error|Exception)\b")
_FOUND: Final = re.compile(r"linepose: .*: found ")  # a fault of which the Snakefile tells
_TARGET: Final = "all"  # the rule that makes nothing itself
_NOTHING: Final = "Nothing to be done"
_MOST_LINES: Final = 8


class StageLines:
    """Hears Snakemake's messages one after another, and tells what of them a person wants to know.

    `running` are the stages at work. After a run that failed, `told_why` is whether a line said the reason, `log` the
    log of the stage that failed, where one did, and `unexplained` Snakemake's own account of a fault outside a stage.
    """

    def __init__(self) -> None:
        self.running: list[str] = []
        self.log: str | None = None
        self.told_why = False
        self.unexplained: list[str] = []
        self.n_stages = 0
        self._n_finished = 0
        self._said: dict[str, str] = {}

    @property
    def counted(self) -> str:
        """How many stages are finished, of how many: " 3/17"."""
        return f"{self._n_finished:{len(str(self.n_stages))}d}/{self.n_stages}"

    def hear(self, message: str) -> str | None:
        """The line that a message gives rise to, if any."""
        if found := _SAID.fullmatch(message):
            self._said[found[1]] = found[2]
            return None
        if message.startswith("linepose"):  # warnings, and what the Snakefile itself has to say
            self.told_why = self.told_why or _FOUND.match(message) is not None
            return message
        if found := _FINISHED.match(message):
            return self._finish(found[1])
        if found := _FAILED.match(message):
            return self._fail(found[1])
        return self._follow(message)

    def _follow(self, message: str) -> str | None:
        """Keep what a message says of the run's course."""
        if found := _N_STAGES.fullmatch(message.strip()):
            self.n_stages = int(found[1]) - 1
            return f"{self.n_stages} stages to run" if self.n_stages > 1 else None
        if message.startswith(_NOTHING):
            return "nothing to run: all results are up to date"
        if found := _BEGUN.fullmatch(message):
            self.running.append(found[1])
        elif self.told_why and self.log is None and (found := _LOG.match(message)):
            self.log = found[1]
        elif (self.unexplained or _FAULT.match(message)) and len(self.unexplained) < _MOST_LINES:
            self.unexplained.append(message)
        return None

    def _finish(self, stage: str) -> str | None:
        self._end(stage)
        if stage == _TARGET:
            return None
        self._n_finished += 1
        return f"{self.counted} {stage}: {self._said.pop(stage, 'done')}"

    def _fail(self, stage: str) -> str:
        self._end(stage)
        self.told_why = True
        return f"{stage} failed: {self._said.pop(stage, 'it ended without a word')}"

    def _end(self, stage: str) -> None:
        if stage in self.running:
            self.running.remove(stage)
