"""How every function of the kernel is compiled."""

from collections.abc import Callable
from typing import Any, Final

from numba import njit

# Arithmetic may be reordered and fused, but NaN and infinity keep their meaning.
FAST_ARITHMETIC: Final = {"contract", "reassoc", "nsz", "arcp", "afn"}


def part(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile a part of the kernel; only what calls the parts is cached on disk, see kernel.py."""
    return njit(error_model="numpy", fastmath=FAST_ARITHMETIC)(function)
