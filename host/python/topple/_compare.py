# SPDX-License-Identifier: MIT
"""Two scans of one room at two times."""
import os
from typing import NamedTuple

import numpy as np

from . import _topple
from ._arrays import usage


class Alignment(NamedTuple):
    """How the earlier result A and the later one B lie on each other."""
    a_from_b: "NDArray[np.float64]"  # (4, 4), rigid: from B's frame to A's, metres
    same_frame: bool  # both had the same coordinates, but for errors
    seen: float  # of all surfaces, those whose place the other scan saw
    agreeing: float  # of these, those that are surface there, too
    next_agreeing: float  # the same of the next best of all ways to turn and shift the room; 0: there is none
    error_m: float  # how far the building's surfaces lie apart, root mean square


class ComparedThing(NamedTuple):
    """What became of a thing."""
    became: str  # "same", "moved", "came", "went", "merged" (its place is solid in the other scan, as other things), "unseen" (the other scan did not see its place)
    a: int  # id in A; -1: there is none
    b: int  # id in B; -1: there is none
    moved_m: float  # the way of its middle, of what moved
    free: float  # share of its seen surface that the other scan shows to be free
    solid: float  # share that it shows to be solid
    less_safe: bool
    safer: bool
    stands_otherwise: bool  # nothing that holds it now held it before


class Comparison(NamedTuple):
    """What compare() has found."""
    alignment: Alignment
    things: "list[ComparedThing]"  # by objects of A, then what only B has


def compare(a, b):
    """What came, went and moved between two scans of one room, and what became less safe: a, b are folders that parses have written, of
    the earlier and the later one. Their frames may differ. Raises Error of kind "input" where the rooms do not match."""
    try:
        folders = os.fspath(a), os.fspath(b)
    except TypeError:
        raise usage(f'compare: expected two folders that parses have written (Result.write), not {a!r} and {b!r}'[:300]) from None
    alignment, things = _topple.compare(*folders)
    matrix, *rest = alignment
    return Comparison(Alignment(np.array(matrix).reshape(4, 4), *rest), [ComparedThing(*thing) for thing in things])
