"""What readers warn of while a platform is checked, as findings: nothing that they pass over goes untold."""

import logging
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from typing import Final

from linepose.check.finding import Finding, warning
from linepose.inputs.gps_time import LOST_WEEKS

_ROOM: Final = "linepose.inputs"
_SUBJECTS: Final = {"scans": "scans", "navigation": "navigation log", "labels": "labels", "targets": "targets"}


class _Collector(logging.Handler):
    def __init__(self) -> None:
        super().__init__(logging.WARNING)
        self.records: dict[str, logging.LogRecord] = {}

    def emit(self, record: logging.LogRecord) -> None:
        self.records.setdefault(record.getMessage(), record)


@contextmanager
def readers_warnings() -> Iterator[list[Finding]]:
    """A list that holds, when the context is left, what readers warned of: each once, those of one kind together."""
    logger, collector, findings = logging.getLogger(_ROOM), _Collector(), list[Finding]()
    level, passes_on = logger.level, logger.propagate
    logger.addHandler(collector)
    logger.setLevel(logging.WARNING)
    logger.propagate = False
    try:
        yield findings
    finally:
        logger.removeHandler(collector)
        logger.setLevel(level)
        logger.propagate = passes_on
        findings += _findings(collector.records)


def agreeing(told: Sequence[Finding], findings: Sequence[Finding]) -> list[Finding]:
    """What was told, without a guess of lost GPS weeks where something else explains an error of the clocks."""
    explained = {cause for one in findings for cause in one.causes}
    if not explained or LOST_WEEKS in explained:
        return list(told)
    return [one for one in told if LOST_WEEKS not in one.causes]


def _findings(records: dict[str, logging.LogRecord]) -> list[Finding]:
    kinds: dict[tuple[str, str], list[str]] = {}
    for told, record in records.items():
        kinds.setdefault((record.name, str(record.msg)), []).append(told)
    findings = []
    for (name, _), alike in kinds.items():
        more = f" (and {len(alike) - 1} more like it)" if len(alike) > 1 else ""
        room = name.removeprefix(f"{_ROOM}.").partition(".")[0]
        cause = getattr(records[alike[0]], "cause", None)
        found = warning(_SUBJECTS.get(room, "files"), f"{alike[0]}{more}", "")
        findings.append(found if cause is None else replace(found, causes=(cause,)))
    return findings
