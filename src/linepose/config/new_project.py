"""A project's config.yaml: made where there is none, and a platform added to one with its comments kept."""

import io
from pathlib import Path
from typing import Final

from ruamel.yaml import YAML
from ruamel.yaml.error import YAMLError

from linepose.config.platform_patterns import fits
from linepose.config.project import CONFIG
from linepose.errors import InputError
from linepose.tables import atomic_write

_STUDY: Final = """# What is run. Every key, its unit and default: docs/configuration.md

platforms: # files of config/platforms
  - {name}

data_folders: # searched in this order for a folder named like the data set
  - data

"""


def make_project(root: Path, platform: str) -> Path:
    """Write a minimal project with one platform into a folder that has none: its config.yaml."""
    with atomic_write(root / CONFIG) as temporary:
        temporary.write_text(_STUDY.format(name=platform), encoding="utf-8")
    (root / "data").mkdir(exist_ok=True)
    return root / CONFIG


def add_platform(config: Path, platform: str) -> bool:
    """Add a platform to those of a config.yaml, everything else left as it is; whether none there named it.

    Raises InputError for a file that is no YAML or has no list of platforms.
    """
    yaml = YAML()
    yaml.preserve_quotes = True
    yaml.width = 10_000
    yaml.indent(mapping=2, sequence=4, offset=2)
    try:
        values = yaml.load(config.read_text(encoding="utf-8"))
    except YAMLError as error:
        raise InputError(str(config), " ".join(str(error).split()), "YAML", "correct the file") from None
    platforms = values.get("platforms") if isinstance(values, dict) else None
    if not isinstance(platforms, list):
        raise InputError(f"{config}: platforms", repr(platforms), "a list of names", f"add `- {platform}` by hand")
    if any(fits(platform, str(one)) for one in platforms):
        return False
    _append(platforms, platform)
    text = io.StringIO()
    yaml.dump(values, text)
    with atomic_write(config) as temporary:
        temporary.write_text(text.getvalue(), encoding="utf-8")
    return True


def _append(platforms: list[str], platform: str) -> None:
    """Append to a list of ruamel's; the blank lines that stand below its last item stay below the last item."""
    last = len(platforms) - 1
    platforms.append(platform)
    comments = getattr(platforms, "ca", None)
    if comments is None or last not in comments.items:
        return
    token = comments.items[last][0]
    if token is None or "\n" not in token.value:
        return
    own, _, below = token.value.partition("\n")
    if not below.strip() and below:
        moved = type(token)("\n" + below, token.start_mark, token.end_mark)
        token.value = own + "\n" if own else "\n"
        comments.items[last + 1] = [moved, None, None, None]
        if not own:
            del comments.items[last]
