"""How many floating-point operations one evaluation takes, counted in the kernel's own source.

Counted are the sums, differences, products and quotients written in the loops over lanes, each as one; index
arithmetic, comparisons, changes of sign, and lanes without a point are not. A fused product and sum is two.
"""

import ast
import inspect
import textwrap
from collections.abc import Callable
from functools import cache
from typing import Any

from linepose.likelihood.estimate import accumulate_pairs, solve_points
from linepose.likelihood.pairs import intersect
from linepose.likelihood.rays import propagate_covariances, trace_rays
from linepose.likelihood.reprojection import reproject


def floating_point_operations(n_observations: int, n_points: int) -> int:
    """Operations of one log-likelihood of N observations of M points, none missing: quadratic in N, linear in M."""
    each_point = _count(solve_points)
    each_ray = sum(_count(part) for part in (trace_rays, propagate_covariances, accumulate_pairs, reproject))
    each_pair = _count(intersect)
    n_pairs = n_observations * (n_observations - 1) // 2
    return n_points * (each_point + each_ray * n_observations + each_pair * n_pairs)


@cache
def _count(part: Callable[..., Any]) -> int:
    source = textwrap.dedent(inspect.getsource(inspect.unwrap(part)))
    loops = [node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.For)]
    return sum(count_operations(loop) for loop in loops if ast.unparse(loop.target) == "lane")


def count_operations(node: ast.AST) -> int:
    """Arithmetic operations in a syntax tree, those that work out an index left aside."""
    if isinstance(node, ast.Subscript):
        return 0
    own = isinstance(node, ast.AugAssign) or (
        isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub | ast.Mult | ast.Div)
    )
    return int(own) + sum(count_operations(child) for child in ast.iter_child_nodes(node))
