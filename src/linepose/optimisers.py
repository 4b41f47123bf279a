"""The searches that can be chosen by name; each one takes a likelihood, a start pose (6,) and the search's limits."""

from collections.abc import Callable
from typing import Final

from linepose.errors import InputError
from linepose.likelihood.base import Likelihood
from linepose.optimise import Optimum, Search, optimise
from linepose.rotations import Floats
from linepose.wide_search import search_widely

Optimiser = Callable[[Likelihood, Floats, Search], Optimum]


def search_as_published(likelihood: Likelihood, start: Floats, search: Search) -> Optimum:
    """Powell's method on the paper's equations, in which points behind the camera count as if in front.

    This reproduces the basin of section 4.7; to exclude such poses, as `optimise` does, widens it.
    """
    return optimise(likelihood.mirrored(), start, search)


OPTIMISERS: Final[dict[str, Optimiser]] = {
    "powell": search_as_published,
    "powell_in_front": optimise,
    "wide": search_widely,
}


def optimiser(name: str) -> Optimiser:
    """The search of this name; raises InputError for an unknown one."""
    if name not in OPTIMISERS:
        raise InputError("basin.optimisers", f"{name!r}", f"one of {', '.join(OPTIMISERS)}", "correct the name")
    return OPTIMISERS[name]
