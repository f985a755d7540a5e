# SPDX-License-Identifier: MIT
"""What can be taken away first, by what carries what."""
from typing import NamedTuple

from ._arrays import number, usage


class RemovalOrder(NamedTuple):
    """Ids of all objects but the ground, in the order in which they can be taken away. What nothing was seen to hold is in it, too."""
    layers: "list[list[int]]"  # of ids, ascending: what carries nothing once the layers before it are gone
    entangled: "list[int]"  # ids of what is left then: pieces that carry each other, perhaps of one thing, and all that carries such

    def __repr__(self):
        left = '' if not self.entangled else f'; objects {", ".join(map(str, self.entangled))} carry each other, or what does, and have no order'
        return f'<topple.RemovalOrder: {self.layers}{left}>'


def order(result, min_probability):
    least = number(min_probability, 'min_probability')
    if not 0 <= least <= 1:
        raise usage(f'min_probability: expected a number from 0 to 1, not {min_probability!r}')
    left = {o.id for o in result.objects if not o.grounded}
    carries = {id: set() for id in left}
    for support in result.supports:
        if support.probability >= least and support.supporter in left and support.supported in left:
            carries[support.supporter].add(support.supported)
    layers = []
    while free := sorted(id for id in left if not carries[id] & left):
        layers.append(free)
        left -= set(free)
    return RemovalOrder(layers, sorted(left))
