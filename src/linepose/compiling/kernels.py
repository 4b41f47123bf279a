"""How every kernel is compiled: division by zero gives infinity as in NumPy."""

from collections.abc import Callable
from typing import Any, Final

from numba import njit

# Fusing a product with a sum is all that may be done to the arithmetic: NaN and infinity keep their meaning, and every
# compilation gives the same bits. (Allowed to reorder sums, LLVM orders them differently from process to process.)
FUSED_ARITHMETIC: Final = {"contract"}


def kernel(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile a function and keep what was compiled on disk."""
    return njit(cache=True, error_model="numpy", fastmath=FUSED_ARITHMETIC)(function)


def kernel_part(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile a function of which only the callers are kept on disk."""
    return njit(error_model="numpy", fastmath=FUSED_ARITHMETIC)(function)
