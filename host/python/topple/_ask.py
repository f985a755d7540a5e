# SPDX-License-Identifier: MIT
"""What holds what, and what falls without it."""
from typing import NamedTuple

from . import _topple
from ._arrays import usage
from ._spots import numbered


class Unheld(NamedTuple):
    """What falls once something is gone, and why (Result.falls_without)."""
    object: int  # id
    lost: "list[int]"  # ids of what carried it and is taken, or falls before it
    left: "list[int]"  # ids of what carried it and is still there
    beyond_m: float  # how far its centre of mass then lies outside of what is left, level; NaN: nothing is left, or only what it carries itself
    probability: float  # of the likeliest of the supports that it lost
    reason: str


class FallsWithout(NamedTuple):
    """What falls, in the order in which it does, and the ids of what may fall, too: it touches that, and the parse does not know what holds it."""
    falls: "list[Unheld]"
    unsure: "list[int]"


class Holder(NamedTuple):
    """What carries an object (Result.held_by)."""
    object: int  # id
    building: bool  # it is the building, or fixed to it
    area_m2: float  # on which it carries
    probability: float  # that it does
    from_below: bool  # the object's solid voxels lie above its own; else it touches its side, or there are no voxels


def ids(result, items):
    """The ids of one item or of several, each given by itself or by its id."""
    several = items if isinstance(items, (list, tuple, set, frozenset)) else [items]
    if not several:
        raise usage('items: expected an object, or some')
    return [numbered(result.objects, item, 'object').id for item in several]


def falls_without(result, parsed, items):
    falls, unsure = _topple.falls_without(parsed, ids(result, items))
    return FallsWithout([Unheld(*one) for one in falls], unsure)


def removal_steps(result, parsed, before):
    return _topple.removal_steps(parsed, None if before is None else ids(result, [before])[0])


def held_by(result, parsed, item):
    return [Holder(*one) for one in _topple.held_by(parsed, ids(result, [item])[0])]
