"""Hypothesis strategies: files that were whole, with what cables, editors, spreadsheets and people do to them."""

import re
import struct
from dataclasses import dataclass

from hypothesis import strategies as st

WORDS = (
    "1e400",
    "-1e400",
    "1" * 30,
    "9" * 5000,
    "NaN",
    "nan",
    "inf",
    "-inf",
    "1_00",
    "yes",
    "true",
    "null",
    "",
    "-1",
    "0",
    "1e-400",
    "1e18",
    "9223372036854775808",
    "-9223372036854775809",
    "4294967296",
    "0x10",
    "1:30",
    "1,5",
    "٣",
    "abc",
    "2024-02-30",
    "2024-13-01",
    "99999-01-01",
    "0001-01-01",
    "9999-12-31T23:59:59Z",
    "\x1b[31mred\x1b[0m",
    "a\x00b",
    "é",
    "../../x",
    "/etc/passwd",
    "*",
    "**",
    "{a}",
    "a b",
    "[",
    "]" * 3,
    "[" * 3000,
    "{" * 3000,
    "<" * 50,
    "&a",
    "*a",
    "!!int abc",
    "!!python/object:x",
    "- ",
    ": ",
    "#",
    "'",
    '"',
    "$",
    ";",
    "%",
    "\r",
    "\t",
    "\ufeff",
    "1000000000",
    "NULL",
    "None",
)
_DOUBLES = (float("nan"), float("inf"), -1.0, 0.0, 1e300, 1e-300, 1e18, 2.0**63)
_BYTES = (
    b"\xff" * 8,
    b"\x00" * 8,
    b"\x7f\xff\xff\xff\xff\xff\xff\xff",
    b"\xff\xff\xff\x7f",
    *(struct.pack("<d", one) for one in _DOUBLES),
    *(struct.pack("<I", one) for one in (0, 1, 2**31, 2**32 - 1, 10**6)),
)
_MOST_BYTES = 300_000
_NUMBER = re.compile(rb"[-+]?\d+(?:\.\d*)?(?:[eE][-+]?\d+)?")
_WORD = re.compile(rb"[^\s,;={}\[\]<>\"]+")


@dataclass(frozen=True)
class Mutation:
    """One thing that is done to a file's bytes; `at` and `to` are places as shares of all that there are."""

    kind: str
    at: float
    to: float
    word: str
    raw: bytes

    def __call__(self, data: bytes) -> bytes:
        """The bytes after it."""
        return getattr(self, f"_{self.kind}")(data)

    def _place(self, data: bytes, share: float) -> int:
        return int(share * len(data))

    def _number(self, data: bytes) -> bytes:
        return self._replaced(data, list(_NUMBER.finditer(data)))

    def _token(self, data: bytes) -> bytes:
        return self._replaced(data, list(_WORD.finditer(data)))

    def _replaced(self, data: bytes, found: list) -> bytes:
        if not found:
            return data + self.word.encode()
        one = found[int(self.at * len(found))]
        return data[: one.start()] + self.word.encode() + data[one.end() :]

    def _insert(self, data: bytes) -> bytes:
        place = self._place(data, self.at)
        return data[:place] + self.word.encode() + data[place:]

    def _flip(self, data: bytes) -> bytes:
        place = self._place(data, self.at)
        return data[:place] + bytes([data[place] ^ (1 << int(self.to * 8))]) + data[place + 1 :] if data else data

    def _overwrite(self, data: bytes) -> bytes:
        place = self._place(data, self.at)
        return data[:place] + self.raw + data[place + len(self.raw) :]

    def _aligned(self, data: bytes) -> bytes:
        place = self._place(data, self.at) // 8 * 8
        return data[:place] + self.raw + data[place + len(self.raw) :]

    def _truncate(self, data: bytes) -> bytes:
        return data[: self._place(data, self.at)]

    def _cut(self, data: bytes) -> bytes:
        first, last = sorted((self._place(data, self.at), self._place(data, self.to)))
        return data[:first] + data[last:]

    def _twice(self, data: bytes) -> bytes:
        first, last = sorted((self._place(data, self.at), self._place(data, self.to)))
        return data[:last] + data[first:last] + data[last:]

    def _line_twice(self, data: bytes) -> bytes:
        lines = data.splitlines(keepends=True)
        row = int(self.at * len(lines))
        return b"".join([*lines[: row + 1], *lines[row:]])

    def _line_away(self, data: bytes) -> bytes:
        lines = data.splitlines(keepends=True)
        row = int(self.at * len(lines))
        return b"".join([*lines[:row], *lines[row + 1 :]])

    def _lines_swapped(self, data: bytes) -> bytes:
        lines = data.splitlines(keepends=True)
        if lines:
            one, other = int(self.at * len(lines)), int(self.to * len(lines))
            lines[one], lines[other] = lines[other], lines[one]
        return b"".join(lines)

    def _many_lines(self, data: bytes) -> bytes:
        lines = data.splitlines(keepends=True) or [b"\n"]
        row = int(self.at * len(lines))
        return b"".join([*lines[:row], lines[row] * 3000, *lines[row + 1 :]])

    def _line_ends(self, data: bytes) -> bytes:
        return data.replace(b"\n", b"\r" if self.at < 0.5 else b"\r\n")

    def _other(self, data: bytes) -> bytes:
        return self.word.encode() * (1 + int(self.at * 20))

    def _utf_16(self, data: bytes) -> bytes:
        return data.decode("latin-1").encode("utf-16")


ANY = ("flip", "flip", "overwrite", "aligned", "truncate", "cut", "twice", "other")
TEXT = (
    "number",
    "number",
    "number",
    "token",
    "token",
    "insert",
    "line_twice",
    "line_away",
    "lines_swapped",
    "many_lines",
    "line_ends",
    "utf_16",
)


def mutations(is_text: bool) -> st.SearchStrategy[tuple[Mutation, ...]]:
    """One to three things that are done to a file."""
    share = st.integers(0, 9999).map(lambda number: number / 10_000)
    kinds = st.sampled_from((*TEXT, *ANY) if is_text else ANY)
    one = st.builds(
        Mutation, kinds, share, share, st.sampled_from(WORDS), st.sampled_from(_BYTES) | st.binary(max_size=9)
    )
    return st.lists(one, min_size=1, max_size=3).map(tuple)


def mutated(data: bytes, done: tuple[Mutation, ...]) -> bytes:
    """A file's bytes after all of it."""
    for one in done:
        data = one(data)[:_MOST_BYTES]
    return data
