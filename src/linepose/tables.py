"""Results on disk: Parquet with a fixed schema, whole or not at all, the same bytes for the same values."""

import errno
import os
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Final

import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

from linepose.errors import InputError

FULL: Final = frozenset({errno.ENOSPC, errno.EDQUOT, errno.EFBIG})
UNWRITABLE: Final = FULL | {
    errno.EACCES,
    errno.EPERM,
    errno.ENOENT,
    errno.EROFS,
    errno.ENOTDIR,
    errno.ENAMETOOLONG,
    errno.EISDIR,
}
_MARK: Final = b"linepose"
_NAMES: Final = {b"names": b"of points"}
_marks: dict[bytes, bytes] = {}


def mark_tables(text: str) -> None:
    """From now on, each table that this process writes carries this text: what made it."""
    _marks[_MARK] = text.encode()


def read_mark(path: Path | str) -> str | None:
    """The text that a table on disk carries; None where there is none, or no Parquet file."""
    try:
        metadata = pq.read_schema(path).metadata or {}
    except (OSError, pa.ArrowException):
        return None
    return metadata[_MARK].decode() if _MARK in metadata else None


@contextmanager
def atomic_write(path: Path | str) -> Iterator[Path]:
    """A temporary path beside `path` that takes its place when the block ends well, and vanishes otherwise.

    A link stays, and what it leads to is replaced. Raises InputError for a device or folder, and for a full disk.
    """
    target = _followed(Path(path))
    temporary = None
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(dir=target.parent, prefix=f".{target.stem[:40]}-", suffix=target.suffix)
        os.close(handle)
        temporary = Path(name)
        yield temporary
        temporary.chmod(0o644)
        temporary.replace(target)
    except OSError as error:
        raise _unwritten(path, error) from None
    finally:
        if temporary is not None:
            temporary.unlink(missing_ok=True)


def _followed(path: Path) -> Path:
    """Where a file is to be written: of a link the file that it leads to; raises InputError for what is no file."""
    target = path.resolve() if path.is_symlink() else path
    if target.exists() and not target.is_file():
        kind = "a folder" if target.is_dir() else "a device or pipe"
        raise InputError(str(path), kind, "a file, or a name that is free", "give another name")
    return target


def _unwritten(path: Path | str, error: OSError) -> Exception:
    """The user's fault that kept a file from being written; any other error as it is."""
    if error.errno not in UNWRITABLE:
        return error
    remedy = "make room there" if error.errno in FULL else "give another place, or the right to write there"
    told = os.strerror(error.errno or 0).lower()
    return InputError(str(path), f"{told} while it was written", "a place that can be written", remedy)


def write_table(table: pd.DataFrame, path: Path | str, schema: pa.Schema) -> None:
    """Write a table as Parquet in the schema's columns and order, with the mark of `mark_tables`.

    Raises InputError where it does not fit.
    """
    try:
        arrow = pa.Table.from_pandas(table, schema=_of_its_names(schema, table), preserve_index=False)
    except (KeyError, ValueError, pa.ArrowException) as error:
        found = " ".join(str(argument) for argument in error.args).splitlines()[0]
        raise InputError(str(path), found, f"columns {schema.names} without gaps", "mend the result") from None
    unknown = set(table.columns) - set(schema.names)
    if unknown:
        raise InputError(str(path), f"columns {sorted(unknown)}", f"columns {schema.names}", "mend the result")
    with atomic_write(path) as temporary:
        marked = arrow.replace_schema_metadata(dict(_marks) or None)
        pq.write_table(marked, temporary, compression="zstd", write_page_checksum=True)


def read_table(path: Path | str, schema: pa.Schema | None = None) -> pd.DataFrame:
    """Read a Parquet table; raises InputError for a file that is missing, is not Parquet, or lacks columns."""
    if not Path(path).is_file():
        raise InputError(str(path), "no such file", "a result of an earlier stage", "run that stage first")
    try:
        arrow = read_parquet(Path(path))
    except InputError as error:
        raise InputError(str(path), error.found, "a Parquet file", "delete it and run again") from None
    missing = [name for name in schema.names if name not in arrow.column_names] if schema else []
    if missing:
        raise InputError(str(path), f"no column {', '.join(missing)}", "the stage's schema", "delete it and run again")
    wrong = [one.name for one in schema or () if not _is_held_by(one, arrow.schema.field(one.name).type)]
    if wrong:
        raise InputError(
            str(path), f"column {wrong[0]} of another type", "the stage's schema", "delete it and run again"
        )
    return arrow.to_pandas()


def read_parquet(path: Path) -> pa.Table:
    """A Parquet file whose pages agree with their check sums; raises InputError for one that is broken."""
    try:
        table = pq.read_table(path, page_checksum_verification=True)
        table.validate(full=True)
    except (pa.ArrowException, OSError, ValueError, UnicodeError) as error:
        found = " ".join(str(error).split()) or type(error).__name__
        raise InputError(str(path), found, "a Parquet file", "restore it") from None
    return table


def write_csv(table: pd.DataFrame, path: Path | str) -> None:
    """Write a table as CSV for people and spreadsheets, ten significant digits."""
    with atomic_write(path) as temporary:
        table.to_csv(temporary, index=False, float_format="%.10g", lineterminator="\n")


def _of_its_names(schema: pa.Schema, table: pd.DataFrame) -> pa.Schema:
    """The schema as it is on disk: a column of names of points is text where the table has text in it."""

    def on_disk(field: pa.Field) -> pa.Field:
        named = field.metadata == _NAMES and not pd.api.types.is_numeric_dtype(table[field.name].dtype)
        text = named and any(isinstance(name, str) for name in table[field.name])
        return field.remove_metadata().with_type(pa.string() if text else field.type)

    return pa.schema([on_disk(field) for field in schema])


def _is_held_by(field: pa.Field, kind: pa.DataType) -> bool:
    """Whether a column of this type is what a field of the schema asks for; pandas writes text as a type of its own."""
    if pa.types.is_large_string(kind):
        kind = pa.string()
    return bool(kind == field.type or (field.metadata == _NAMES and kind == pa.string()))


def floats(*names: str) -> list[pa.Field]:
    """Columns of real numbers."""
    return [pa.field(name, pa.float64(), nullable=False) for name in names]


def optional_floats(*names: str) -> list[pa.Field]:
    """Columns of real numbers that are null where there is none."""
    return [pa.field(name, pa.float64()) for name in names]


def whole_numbers(*names: str) -> list[pa.Field]:
    """Columns of whole numbers."""
    return [pa.field(name, pa.int64(), nullable=False) for name in names]


def point_column(name: str = "point") -> pa.Field:
    """The column of points' names: whole numbers, or text where one of a table's names is."""
    return pa.field(name, pa.int64(), nullable=False, metadata=_NAMES)


def texts(*names: str) -> list[pa.Field]:
    """Columns of text."""
    return [pa.field(name, pa.string(), nullable=False) for name in names]


def flags(*names: str) -> list[pa.Field]:
    """Columns of yes or no."""
    return [pa.field(name, pa.bool_(), nullable=False) for name in names]


def with_parameters(schema: pa.Schema, names: Sequence[str]) -> pa.Schema:
    """The schema with the columns of a noise model's own parameters at its end."""
    return pa.schema([*schema, *floats(*names)])
