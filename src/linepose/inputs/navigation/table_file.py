"""Columns of a table on disk, of Parquet or of text."""

from collections.abc import Sequence
from pathlib import Path
from typing import Final

import pyarrow as pa
import pyarrow.parquet as pq

from linepose.errors import InputError
from linepose.inputs.navigation.table_columns import Columns, Name, parts_of
from linepose.inputs.navigation.text_file import TextLayout, read_text

_PARQUET: Final = {".parquet", ".pq"}


def read_columns(
    path: Path, layout: TextLayout, used: Sequence[Name], as_text: Sequence[str], apart: Sequence[str] = ()
) -> Columns:
    """The columns `used` of a file that it has; those `as_text` stay text, and those `apart` may take three cells."""
    if path.suffix.lower() not in _PARQUET:
        table = read_text(path, layout, [part for name in used for part in parts_of(name)], as_text, apart)
        return Columns(path, table.cells, table.first_line, table.names)
    try:
        return Columns(path, pq.read_table(path).to_pandas(timestamp_as_object=False), 0)
    except (pa.ArrowException, OSError) as error:
        raise InputError(str(path), " ".join(str(error).split()), "a Parquet file", "restore it") from None
