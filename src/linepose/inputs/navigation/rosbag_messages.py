"""Messages of bags of ROS 1 (.bag) and ROS 2 (a folder, or .db3 and .mcap files), topic by topic."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final

from linepose.errors import InputError, LineposeError

_WHAT: Final = "a whole ROS 1 or ROS 2 bag"
_REMEDY: Final = "restore the bag, or repair its index (rosbag reindex, ros2 bag reindex)"
_BEGINNINGS: Final = {".bag": b"#ROSBAG V2.0\n", ".db3": b"SQLite format 3\0", ".mcap": b"\x89MCAP0\r\n"}


@contextmanager
def opened(path: Path) -> Iterator[Any]:
    """The bag, whatever its kind; faults of its format, also those met while reading, become one line."""
    from rosbags.highlevel import AnyReader
    from rosbags.typesys import Stores, get_typestore

    _check_beginning(path)
    in_folder = path.suffix in {".db3", ".mcap"} and (path.parent / "metadata.yaml").is_file()
    try:
        with AnyReader(
            [path.parent if in_folder else path], default_typestore=get_typestore(Stores.ROS2_HUMBLE)
        ) as bag:
            yield bag
    except LineposeError:
        raise
    except Exception as error:  # of broken bags, the reader lets out whatever its decoders raise
        found = " ".join(str(error).split()) or type(error).__name__
        raise InputError(str(path), found, _WHAT, _REMEDY) from None


def _check_beginning(path: Path) -> None:
    """Raise InputError for a file that does not begin as its kind does: the reader would look for a line end in it."""
    beginning = _BEGINNINGS.get(path.suffix)
    if beginning is None or not path.is_file():
        return
    with path.open("rb") as file:
        if file.read(len(beginning)) != beginning:
            raise InputError(str(path), f"bytes that begin no {path.suffix}", _WHAT, _REMEDY)


def topics_of(bag: Any, kinds: Sequence[str]) -> list[str]:
    """The topics of messages of these kinds."""
    return sorted({one.topic for one in bag.connections if one.msgtype in kinds})


def messages(bag: Any, path: Path, kinds: Sequence[str], topic: str | None, key: str) -> Iterator[tuple[int, Any]]:
    """Time (us) and content of a topic's messages, in the order of the bag; `key` is the one that names the topic.

    Raises InputError where there is no such topic, or several and none is named.
    """
    topics, told = topics_of(bag, kinds), " or ".join(kinds)
    if topic is None and len(topics) != 1:
        found = f"{len(topics)} topics of {told}" + (f" ({', '.join(topics)})" if topics else "")
        held = ", ".join(sorted({f"{one.topic} ({one.msgtype})" for one in bag.connections})) or "nothing"
        remedy = f"set source.navigation.{key}; the bag holds {held}"
        raise InputError(str(path), found, "one, or its name in the platform file", remedy)
    if topic is not None and topic not in topics:
        found, expected = f"no topic {topic} of {told}", f"one of {', '.join(topics) or 'none'}"
        raise InputError(str(path), found, expected, f"correct source.navigation.{key}")
    chosen = [one for one in bag.connections if one.msgtype in kinds and one.topic == (topic or topics[0])]
    for connection, _, raw in bag.messages(connections=chosen):
        message = bag.deserialize(raw, connection.msgtype)
        yield stamp_us(message.header), message


def stamp_us(header: Any) -> int:
    """Unix time (us) of a header."""
    return int(header.stamp.sec * 1_000_000 + (header.stamp.nanosec + 500) // 1000)
