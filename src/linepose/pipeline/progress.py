"""Whether long work shows how far it is: on a terminal, and never in continuous integration."""

import os
import sys


def shown() -> bool:
    """True where a person is watching: standard error is a terminal and `CI` is not set."""
    return sys.stderr.isatty() and not os.environ.get("CI")
