# SPDX-License-Identifier: MIT
"""Spots of a result's parts, by which corrections name them (docs/corrections.md)."""
import numpy as np

from . import geometry
from ._arrays import usage

# A spot stands for the part of the nearest solid voxel: one of the part's own, as far as that from voxels of others.
_CLEAR_VOXELS = 3
_TRIED = 400  # voxels of a part, the nearest to its middle


class Parts:
    """The solid voxels of a result by their cells and parts."""

    def __init__(self, result):
        solid = result.solid
        self._part = np.asarray(solid['primitive'])
        self._seen = np.asarray(solid['state']) == 0
        self._at = geometry.solid_points(result)[0].astype(float)
        turned = self._at @ geometry.room_axes(result).T
        cells = np.rint((turned - turned.min(axis=0)) / result.voxel_size_m).astype(np.int64) if len(turned) else np.zeros((0, 3), np.int64)
        margin = _CLEAR_VOXELS + 1
        self._cells = cells + margin
        self._shape = self._cells.max(axis=0, initial=0) + 1 + margin
        keys = self._key(self._cells)
        self._order = np.argsort(keys, kind='stable')
        self._keys = keys[self._order]
        self._of_part = np.argsort(self._part, kind='stable')
        self._sorted_parts = self._part[self._of_part]

    def _key(self, cells):
        return (cells[..., 0] * self._shape[1] + cells[..., 1]) * self._shape[2] + cells[..., 2]

    def spot(self, part):
        """A point [x, y, z] of the part's solid, in its midst; None where it has none."""
        first, last = np.searchsorted(self._sorted_parts, [part, part + 1])
        own = self._of_part[first:last]
        if len(own) == 0:
            return None
        middle = np.median(self._at[own], axis=0)
        surface = own[self._seen[own]]
        own = surface if len(surface) else own
        far = np.linalg.norm(self._at[own] - middle, axis=1)
        own = own[np.argsort(far, kind='stable')[:_TRIED]]
        best = own[np.argmax(self._clear(own, part))]  # the first of the clearest: the nearest to the middle
        return [float(x) for x in self._at[best]]

    def _clear(self, voxels, part):
        """How many voxels each is away from the next of another part, _CLEAR_VOXELS + 1 at most."""
        reach = np.arange(-_CLEAR_VOXELS, _CLEAR_VOXELS + 1)
        around = np.stack(np.meshgrid(reach, reach, reach, indexing='ij'), axis=-1).reshape(-1, 3)
        wanted = self._key(self._cells[voxels][:, None] + around)
        found = np.minimum(np.searchsorted(self._keys, wanted), len(self._keys) - 1)
        of = self._part[self._order[found]]
        others = (self._keys[found] == wanted) & (of != part) & (of >= 0)
        return np.where(others, np.linalg.norm(around, axis=1), _CLEAR_VOXELS + 1).min(axis=1)


def _numbered(items, item, what):
    """The item that is given by itself or by its id."""
    number = getattr(item, 'id', item)
    if isinstance(number, (bool, np.bool_)) or not isinstance(number, (int, np.integer)) or not 0 <= number < len(items):
        raise usage(f"{what}: expected one of the result's, or an id from 0 to {len(items) - 1}, not {item!r}")
    return items[number]


def spots(result, parts, item):
    """A spot of each part of an object that has solid voxels, the largest part first."""
    primitives = result.primitives
    of = _numbered(result.objects, item, 'object')
    largest = sorted(of.primitives, key=lambda p: (-primitives[p].solid_voxels, p))
    return [spot for spot in map(parts.spot, largest) if spot is not None]


def spot(result, parts, item, part):
    """A spot of an object's largest part, or of the part itself."""
    if part:
        found = parts.spot(_numbered(result.primitives, item, 'part').id)
    else:
        found = next(iter(spots(result, parts, item)), None)
    if found is None:
        raise usage(f"{'part' if part else 'object'} {getattr(item, 'id', item)} has no solid voxels, so that no correction can name it; "
                    'a smaller voxel_m may give it some')
    return found
