"""How every function of the kernel is compiled."""

from collections.abc import Callable
from typing import Any, Final

from numba import njit

# Fusing a product with a sum is all that may be done to the arithmetic: NaN and infinity keep their meaning, and every
# compilation gives the same bits. (Allowed to reorder sums, LLVM orders them differently from process to process.)
FUSED_ARITHMETIC: Final = {"contract"}


def kernel_function(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile a part of the kernel; only what calls the parts is cached on disk, see kernel.py."""
    return njit(error_model="numpy", fastmath=FUSED_ARITHMETIC)(function)
