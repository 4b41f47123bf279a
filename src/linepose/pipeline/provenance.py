"""What made a result: settings, inputs and code, as a text that each result carries.

The text is the same wherever and whenever the result is made: no times, no names of machines, no paths from a root.
"""

import hashlib
import json
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any, Final

from linepose.tables import read_mark

NO_SETTINGS: Final = frozenset({"code", "module", "work", "folder", "file", "searched", "batch_size"})
"""Names of rules' parameters, and of keys in them, that change no number: where files stand, how work is shared out."""

FOR_THE_ORDER_ALONE: Final = frozenset({"compiled", "readable", "parts"})
"""Names of rules' inputs whose content changes no number beside the rule's own parameters."""


@dataclass(frozen=True)
class Provenance:
    """What made a result.

    `settings` are the rule's sections of the configuration by name, `inputs` the digest of each input by its path in
    the project, `code` what `script_digest` says, `version` this package's.
    """

    settings: Mapping[str, Any]
    inputs: Mapping[str, str]
    code: str
    version: str

    def text(self) -> str:
        """As JSON, the same text for the same values."""
        return json.dumps(asdict(self), sort_keys=True, separators=(",", ":"), ensure_ascii=False)


def provenance_of_job(parameters: Mapping[str, Any], inputs: Iterable[Path | str]) -> Provenance:
    """What is about to make results: a rule's parameters, `code` among them, and its inputs, relative to the project.

    Inputs outside of the project are known by their name alone.
    """
    digests = {_place(Path(file)): content_digest(Path(file)) for file in inputs}
    code = str(parameters.get("code", ""))
    return Provenance(plain_settings(parameters), digests, code, version("linepose"))


def read_provenance(path: Path | str) -> Provenance | None:
    """What made a result; None where it does not say, or is no Parquet file."""
    text = read_mark(path)
    try:
        return None if text is None else Provenance(**json.loads(text))
    except (TypeError, ValueError):
        return None


def plain_settings(values: Mapping[str, Any]) -> dict[str, Any]:
    """Settings as JSON has them, without what changes no number."""
    return dict(json.loads(json.dumps(_of_effect(values), default=str)))


def content_digest(path: Path) -> str:
    """Digest of a file's content, or of the names and contents of all files below a folder."""
    if not path.is_dir():
        with path.open("rb") as content:
            return hashlib.file_digest(content, "sha256").hexdigest()[:16]
    digest = hashlib.sha256()
    for file in sorted(file for file in path.rglob("*") if file.is_file() and not file.name.startswith(".")):
        digest.update(f"{file.relative_to(path).as_posix()} {content_digest(file)}\n".encode())
    return digest.hexdigest()[:16]


def _place(path: Path) -> str:
    return path.name if path.is_absolute() or ".." in path.parts else path.as_posix()


def _of_effect(values: Any) -> Any:
    if isinstance(values, Mapping):
        return {str(key): _of_effect(value) for key, value in values.items() if key not in NO_SETTINGS}
    return [_of_effect(value) for value in values] if isinstance(values, list | tuple) else values
