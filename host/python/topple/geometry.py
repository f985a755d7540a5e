# SPDX-License-Identifier: MIT
"""A Result's objects as the shapes that viewers and plots draw."""
import math
from typing import NamedTuple

import numpy as np


class Box(NamedTuple):
    """The box of an object's solid, along the room's axes, in the scan's frame, metres."""
    object: int
    centre: np.ndarray  # (3,)
    size: np.ndarray  # (3,)


def room_axes(result):
    """3 x 3: turns the scan's coordinates to the room's, z up and walls along x and y."""
    return np.array(result.manhattan_from_input, float).reshape(4, 4)[:3, :3]


def quaternion(matrix):
    """x y z w of a rotation."""
    vectors = np.linalg.eigh(np.array([
        [matrix[0, 0] - matrix[1, 1] - matrix[2, 2], 0, 0, 0],
        [matrix[0, 1] + matrix[1, 0], matrix[1, 1] - matrix[0, 0] - matrix[2, 2], 0, 0],
        [matrix[0, 2] + matrix[2, 0], matrix[1, 2] + matrix[2, 1], matrix[2, 2] - matrix[0, 0] - matrix[1, 1], 0],
        [matrix[2, 1] - matrix[1, 2], matrix[0, 2] - matrix[2, 0], matrix[1, 0] - matrix[0, 1], np.trace(matrix)]]))[1]
    return vectors[:, -1]  # of the largest eigenvalue


def solid_points(result):
    """The solid voxels' centres, (N, 3), and the object of each, (N,)."""
    solid = result.solid
    return np.stack([solid['x'], solid['y'], solid['z']], axis=1), solid['object']


def boxes(result):
    """The Box of each object that has a solid and can move; walls have none to speak of."""
    points, owners = solid_points(result)
    axes = room_axes(result)
    turned = points @ axes.T
    out = []
    for o in result.objects:
        of = turned[owners == o.id]
        if o.grounded or len(of) == 0:
            continue
        low, high = of.min(axis=0) - result.voxel_size_m / 2, of.max(axis=0) + result.voxel_size_m / 2
        out.append(Box(o.id, (low + high) / 2 @ axes, high - low))
    return out


def unsafety_colour(item):
    """Red, green and blue, 0 to 255: green to red by unsafety; grey of what can't move, or has no rank."""
    if item.grounded:
        return 150, 150, 150
    if math.isnan(item.unsafety):
        return 110, 110, 160
    share = (item.unsafety - 1) / 9
    return round(255 * min(1, 2 * share)), round(200 * min(1, 2 - 2 * share)), 40


def points_of(result):
    """The scan's points, (N, 3) float32; none of a result that has no coordinates."""
    return result.xyz.astype(np.float32, copy=False)


def label_colours(result, owners):
    """(N, 3) uint8: each point's object by its unsafety; dark where it has none."""
    palette = np.array([unsafety_colour(o) for o in result.objects] + [(60, 60, 60)], np.uint8)
    return palette[owners]


def described(item):
    """What an object is called in a view."""
    rank = '-' if math.isnan(item.unsafety) else f'{item.unsafety:.1f}'
    return f'object {item.id}, unsafety {rank}'


def links(result, pairs):
    """The centres of mass of pairs of objects, (N, 2, 3); supports have no place of their own."""
    centres = {o.id: o.center_of_mass_m for o in result.objects}
    return np.array([[centres[a], centres[b]] for a, b in pairs], float).reshape(-1, 2, 3)


def contact_lines(result):
    """The centres of mass of the primitives that touch, (N, 2, 3), and each contact."""
    centres = {p.id: p.center_of_mass_m for p in result.primitives}
    contacts = list(result.contacts)
    return np.array([[centres[c.a], centres[c.b]] for c in contacts], float).reshape(-1, 2, 3), contacts
