"""Whether camera and navigation tell the same time: overlap, gaps, and the offset that would explain a miss."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from linepose.check.finding import Finding, error, ok, warning
from linepose.inputs.gps_time import LOST_WEEKS

Times = NDArray[np.int64]

_SUBJECT: Final = "time"
_LOST_WEEKS_S: Final = 619_315_200
_EPOCHS_S: Final = (315_964_800, 315_964_782)  # from 1970 to 1980, without and with 18 leap seconds
_NAMED_OFFSETS_S: Final = (
    (18, "GPS time against UTC (18 leap seconds since 2017)"),
    (17, "GPS time against UTC (17 leap seconds, 2015 to 2016)"),
    (_LOST_WEEKS_S, LOST_WEEKS),
    (37, "TAI against UTC"),
    (19, "TAI against GPS time"),
    (_EPOCHS_S[0], "the GPS epoch of 1980 against that of 1970"),
    (_EPOCHS_S[1], "the GPS epoch and 18 leap seconds"),
    *((hours * 3600, f"a time zone of {hours} h") for hours in range(1, 15)),
    (86_400, "a day"),
)

_HEADER_TOLERANCE_S: Final = 5.0  # headers say whole seconds, and a recorder starts a little later
_WHOLE_TOLERANCE_S: Final = 2.0


def overlap_findings(
    time_us: Times,
    navigation_us: Times,
    what: str,
    offset_s: float | None = None,
    of_epoch: tuple[str, str] = ("", ""),
) -> list[Finding]:
    """Whether times of points (P,) lie within those of the navigation (K,), increasing; `what` names the latter.

    `offset_s` is source.time_offset_s, None where the source has no such key. `of_epoch` are the keys that mend times
    since 1980 which were read as since 1970, of the camera and of the navigation; empty where there are none.
    """
    start, end = navigation_us[0], navigation_us[-1]
    outside = (time_us < start) | (time_us > end)
    if not outside.any():
        return [ok(_SUBJECT, f"all {len(time_us)} points lie within the {what} ({(end - start) / 1e6:.0f} s)")]
    if not outside.all():
        late = float(max((time_us - end).max(), (start - time_us).max())) / 1e6
        return [
            error(
                _SUBJECT,
                f"{int(outside.sum())} of {len(time_us)} points lie up to {late:.3g} s outside the {what}",
                "complete the navigation log, leave these observations out, or correct the clocks",
            )
        ]
    earliest, latest = (start - time_us.min()) / 1e6, (end - time_us.max()) / 1e6
    found = f"no point lies within the {what}: points from {_told(time_us.min())}, {what} from {_told(start)}"
    names: dict[str, str] = {}
    for seconds, name in _NAMED_OFFSETS_S:
        for sign, epoch_key in zip((1, -1), of_epoch, strict=True):
            if earliest <= sign * seconds <= latest:
                by_key = f"set {epoch_key}" if epoch_key and seconds in _EPOCHS_S else ""
                names.setdefault(by_key or _remedy(sign * seconds, offset_s), name)
    if names:
        told = [f"{remedy} ({name})" for remedy, name in names.items()]
        return [replace(error(_SUBJECT, found, "; or ".join(told[:3])), causes=tuple(names.values()))]
    key = "" if offset_s is None else " (source.time_offset_s)"
    advice = f"move the camera's clock{key} by {earliest:.1f} to {latest:.1f} s, or bring the log of that day"
    return [error(_SUBJECT, found, advice if earliest <= latest else "bring the log that covers the whole survey")]


def _remedy(shift_s: int, offset_s: float | None) -> str:
    """What mends a named offset: of weeks that the navigation lost, in its log; else what moves the camera's clock."""
    if shift_s == -_LOST_WEEKS_S:
        return f"add {_LOST_WEEKS_S} s to the times of the navigation, or correct its gps_week"
    return _moved(shift_s, offset_s)


def _moved(shift_s: int, offset_s: float | None) -> str:
    """What moves the camera's clock by a shift, as an imperative."""
    if offset_s is None:
        return f"add {shift_s * 1_000_000} us to column 1 of each view file"
    return f"set source.time_offset_s: {offset_s + shift_s:.13g}"


def header_findings(first_us: Mapping[str, int], header_us: Mapping[str, int], offset_s: float = 0.0) -> list[Finding]:
    """Whether scans' headers say the time of the first line that their time stamps say; both are by the scan's name.

    `offset_s` is source.time_offset_s.
    """
    late_s = {name: (first_us[name] - header_us[name]) / 1e6 for name in header_us if name in first_us}
    apart = [name for name, late in late_s.items() if abs(late) > _HEADER_TOLERANCE_S]
    if not apart:
        return []
    late = late_s[apart[0]]
    names = [name for seconds, name in _NAMED_OFFSETS_S if _is_whole(abs(late), seconds)]
    alike = f" (and {len(apart) - 1} more scans)" if len(apart) > 1 else ""
    found = f"{apart[0]}: its time stamps begin {abs(late):.3f} s {'after' if late > 0 else 'before'} the time in its "
    found += f"header, read as UTC{alike}" + (f": {names[0]}" if names else "")
    right_s = [sign * seconds for seconds, _ in _NAMED_OFFSETS_S for sign in (1, -1) if _is_whole(late, sign * seconds)]
    advice = "find out which of the two is right by a landmark; if it is the header, "
    exactly = f"set source.time_offset_s: {offset_s - right_s[0]:.13g}" if right_s else ""
    advice += exactly or "measure the offset by the landmark, and set source.time_offset_s to it"
    return [warning(_SUBJECT, found, advice)]


def _is_whole(late_s: float, seconds: int) -> bool:
    """Whether a lateness is that of a named offset, which headers and recorders round."""
    return abs(late_s - seconds) < _WHOLE_TOLERANCE_S


def gap_findings(time_us: Times, navigation_us: Times, maximum_s: float, what: str, key: str) -> list[Finding]:
    """How far points lie from the nearest navigation time; those farther than `maximum_s` stop the run."""
    gap_s = nearest_gap_s(time_us, navigation_us)
    beyond = int((gap_s > maximum_s).sum())
    found = f"nearest {what} at most {gap_s.max():.3f} s away"
    if beyond:
        return [
            error(
                _SUBJECT,
                f"{found}, for {beyond} of {len(time_us)} points more than {maximum_s:g} s",
                f"complete the log, leave these observations out, correct the clocks, or raise {key}",
            )
        ]
    return [ok(_SUBJECT, f"{found} (limit {maximum_s:g} s)")]


def nearest_gap_s(time_us: Times, navigation_us: Times) -> NDArray[np.float64]:
    """Time (P,) from each point (P,) to the nearest navigation time (K,), in seconds."""
    after = np.searchsorted(navigation_us, time_us).clip(0, len(navigation_us) - 1)
    before = (after - 1).clip(0)
    gap = np.minimum(np.abs(navigation_us[after] - time_us), np.abs(navigation_us[before] - time_us))
    return np.asarray(gap / 1e6)


def rate_findings(log_us: Times, maximum_gap_s: float) -> list[Finding]:
    """How often the navigation log has a pose (K,)."""
    steps_s = np.diff(log_us) / 1e6
    step_s = float(np.median(steps_s))
    found = f"a pose every {step_s:.3g} s in the navigation log, at most {steps_s.max():.3g} s apart"
    if step_s > maximum_gap_s:
        return [
            error(
                _SUBJECT,
                f"{found}, but navigation.maximum_pose_gap_s is {maximum_gap_s:g} s",
                "log the navigation more often (100 Hz is common), or raise navigation.maximum_pose_gap_s",
            )
        ]
    if step_s > 0.5 * maximum_gap_s:
        return [warning(_SUBJECT, found, "log it more often, and set navigation.association: interpolate")]
    return [ok(_SUBJECT, found)]


def _told(time_us: np.int64) -> str:
    return f"{np.datetime64(int(time_us) // 1_000_000, 's')} UTC"
