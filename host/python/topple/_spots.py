# SPDX-License-Identifier: MIT
"""Spots of a result's parts, by which corrections name them (docs/corrections.md)."""
import numpy as np

from . import _topple, geometry
from ._arrays import usage


class Parts:
    """Where the parts of a result lie among its solid voxels."""

    def __init__(self, result):
        solid = result.solid
        self._at = geometry.solid_points(result)[0].astype(float)
        turned = self._at @ geometry.room_axes(result).T
        lowest = turned.min(axis=0) if len(turned) else 0
        cells = np.rint((turned - lowest) / result.voxel_size_m).astype(np.int32)
        state = np.where(np.asarray(solid['state']) == 0, 1, 3).astype(np.uint8)
        part = np.ascontiguousarray(solid['primitive'], np.int32)
        self._spots = _topple.stages.label_spots([np.ascontiguousarray(axis) for axis in cells.T], part, state)

    def spot(self, part):
        """A point [x, y, z] of the part's solid, in its midst; None where it has none."""
        at = self._spots[part] if 0 <= part < len(self._spots) else -1
        return None if at < 0 else self._at[at].copy()


def numbered(items, item, what):
    """The item that is given by itself or by its id."""
    number = getattr(item, 'id', item)
    if isinstance(number, (bool, np.bool_)) or not isinstance(number, (int, np.integer)) or not 0 <= number < len(items):
        raise usage(f"{what}: expected one of the result's, or an id from 0 to {len(items) - 1}, not {item!r}")
    return items[number]


def spots(result, parts, item):
    """A spot of each part of an object that has solid voxels, the largest part first."""
    primitives = result.primitives
    of = numbered(result.objects, item, 'object')
    largest = sorted(of.primitives, key=lambda p: (-primitives[p].solid_voxels, p))
    return [spot for spot in map(parts.spot, largest) if spot is not None]


def spot(result, parts, item, part):
    """A spot of an object's largest part, or of the part itself."""
    if part:
        found = parts.spot(numbered(result.primitives, item, 'part').id)
    else:
        found = next(iter(spots(result, parts, item)), None)
    if found is None:
        raise usage(f"{'part' if part else 'object'} {getattr(item, 'id', item)} has no solid voxels, so that no correction can name it; "
                    'a smaller voxel_m may give it some')
    return found
