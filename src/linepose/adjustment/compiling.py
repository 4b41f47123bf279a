"""How the adjustment's kernels are compiled."""

from collections.abc import Callable
from typing import Any, Final

from numba import njit

# A product may be fused with a sum; nothing may be reordered, so that every compilation gives the same bits.
FUSED_ARITHMETIC: Final = {"contract"}


def kernel(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile a function and keep what was compiled on disk; division by zero gives infinity as in NumPy."""
    return njit(cache=True, error_model="numpy", fastmath=FUSED_ARITHMETIC)(function)
