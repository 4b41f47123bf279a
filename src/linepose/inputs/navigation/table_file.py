"""Columns of a table on disk, of Parquet or of text."""

from collections.abc import Sequence
from pathlib import Path
from typing import Final

from linepose.errors import InputError
from linepose.inputs.navigation.table_columns import Columns, Name, parts_of
from linepose.inputs.navigation.text_file import TextLayout, read_text
from linepose.tables import read_parquet

_PARQUET: Final = {".parquet", ".pq"}


def read_columns(
    path: Path, layout: TextLayout, used: Sequence[Name], as_text: Sequence[str], apart: Sequence[str] = ()
) -> Columns:
    """The columns `used` of a file that it has; those `as_text` stay text, and those `apart` may take three cells."""
    if path.suffix.lower() not in _PARQUET:
        table = read_text(path, layout, [part for name in used for part in parts_of(name)], as_text, apart)
        return Columns(path, table.cells, table.first_line, table.names, layout.decimal)
    table = read_parquet(path)
    twice = [name for name in table.column_names if table.column_names.count(name) > 1]
    if twice:
        raise InputError(str(path), f"column {twice[0]} twice", "each column once", "remove or rename one of them")
    try:
        cells = table.to_pandas(timestamp_as_object=False)
        is_named = any(name is not None for name in cells.index.names)
        return Columns(path, cells.reset_index(drop=not is_named), 0, decimal=layout.decimal)
    except (ValueError, TypeError) as error:
        raise InputError(str(path), " ".join(str(error).split()), "columns of numbers and text", "restore it") from None
