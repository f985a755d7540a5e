# SPDX-License-Identifier: MIT
"""Single stages of a parse, for programs that have the rest (topple/stages.h in C++).

    spacing_m = stages.point_spacing(points)
    n = stages.normals(points, 2 * spacing_m, device=device)

Metres, kilograms, joules. Stages that take points work in the points' frame; where gravity plays a part (volumes,
barriers), that frame must have z up.

points: an array of shape (N, 3), records with fields x, y, z, a tuple of three arrays, or whatever has __dlpack__ in
memory of the CPU. float32 is read where it lies, with any strides; float64 is converted, integers are refused. Other
arrays are read where they lie if they have the type that is named and no gaps.

device: a Device of topple.open_device(), or a backend's name, or None for the best, opened for this call alone. Opening
takes longer than most stages: open one, and keep it. A device, and a Volume, serves one thread at a time.

Other threads of Python run meanwhile, and must not write to the arrays. What is wrong is raised as topple.Error, which
names the argument, what it is and what it should be.
"""
import enum
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from ._arrays import as_array, columns, exactly, fields, has_rows, number, usage, warn
from ._device import opened as _opened
from ._shown import figure
from ._topple import stages as _stages

__all__ = ['Barrier', 'Intrinsics', 'StandingBody', 'State', 'Volume', 'Voxels', 'barriers', 'convolve', 'footprint_dtype',
           'normals', 'point_spacing', 'support_functions']

_AIR_KG_M3 = 1.2

footprint_dtype = np.dtype([('dx', np.int32), ('dy', np.int32), ('weight', np.float32)])


class State(enum.IntEnum):
    """What is known of a voxel."""
    EMPTY = 0  # seen to be
    SURFACE = 1  # holds points
    UNSEEN = 2
    COMPLETED = 3  # was never seen, and is taken to be solid


class Intrinsics(NamedTuple):
    """A pinhole camera: x right, y down, z forward; pixel (u, v) has its centre at (u, v)."""
    fx: float  # pixels, as the next three
    fy: float
    cx: float
    cy: float
    depth_scale: float = 1000.0  # metres = stored value / depth_scale


class Voxels(NamedTuple):
    """The solid voxels, sorted by (i, j, k): voxel (i, j, k) spans [i, i + 1] * voxel_m along x, and so on."""
    i: np.ndarray  # (N,) int32, as the next three
    j: np.ndarray
    k: np.ndarray
    label: np.ndarray  # -1: none
    state: np.ndarray  # (N,) uint8: State.SURFACE or State.COMPLETED


class StandingBody(NamedTuple):
    """A rigid body on level ground, as it stands, z up."""
    points: np.ndarray  # (N, 3) float64, metres: of its whole surface, 4 at least, whose convex hull decides; see barriers()
    mass_kg: float
    center_of_mass_m: tuple  # x, y, z


class Barrier(NamedTuple):
    """What it takes to make a body fall by tipping."""
    barrier_J: float  # least energy that takes it out of its pose; 0: it falls by itself
    release_J: float  # what it then can release
    direction: list  # horizontal way that it goes, unit; zeros: any
    curve: np.ndarray  # (steps, 2) float64: S(W), W_J and S_J of each step; none where no pose lies lower


def _points(source, name='points'):
    return columns(source, ('x', 'y', 'z'), name)


def _coordinates(source, name):
    """Three columns without gaps, finite."""
    return [exactly(c, f'{name} {axis}', (None,), np.float32) for c, axis in zip(_points(source, name), 'xyz')]


def _fields(kind, given, name):
    """What is given as that kind of tuple, or as its values in a row."""
    try:
        return kind(*given)
    except TypeError as error:
        raise usage(f'{name}: expected {", ".join(kind._fields)}, not {given!r}') from error


def camera(given, name):
    """fx, fy, cx, cy and depth_scale as floats; given: Intrinsics, or a mapping as intrinsics.json has it."""
    try:
        if isinstance(given, Mapping):
            return [float(value) for value in Intrinsics(**{key: given[key] for key in Intrinsics._fields if key in given})]
        return [float(value) for value in Intrinsics(*given)]
    except (TypeError, ValueError):
        of_matrix = getattr(given, 'shape', None) == (3, 3) or isinstance(given, (list, tuple)) and list(map(np.size, given)) == [3, 3, 3]
        mend = '; of a matrix K give Intrinsics(K[0, 0], K[1, 1], K[0, 2], K[1, 2])' if of_matrix else ''
        raise usage(f"{name}: expected a topple.stages.Intrinsics({', '.join(Intrinsics._fields)}), not "
                    + ' '.join(f'{given!r}'.split())[:200] + mend) from None


def _target(out, shape, name='out'):
    """Where a stage writes, as one row: the caller's array, or a new one."""
    if out is None:
        out = np.empty(shape, np.float32)
    if not isinstance(out, np.ndarray) or out.dtype != np.float32 or out.shape != shape or not out.flags.c_contiguous \
            or not out.flags.writeable:
        what = f'{out.dtype} of shape {out.shape}' if isinstance(out, np.ndarray) else repr(type(out).__name__)
        raise usage(f'{name}: expected a writeable float32 array of shape {shape} without gaps, not {what}; '
                    f'np.empty({shape}, np.float32) makes one')
    return out


def point_spacing(points):
    """Typical distance of a point to its nearest neighbour, metres; 0 for fewer than two places. Points so far apart that they
    can't be in metres are refused."""
    return _stages.point_spacing(_points(points))


def normals(points, cell_m, *, eye_m=None, device=None, out=None):
    """Normals of a cloud: (N, 3) float32, unit, each of the plane through its point's neighbourhood; 0, 0, 0 where there
    is none, and for points that are not finite. cell_m: edge of the cells whose points are looked at together, metres, 1 at
    most, about twice the points' spacing. eye_m: where the sensor was, x, y, z, to which normals then turn; or (N, 3) where each
    point was seen from, NaN where that is not known, of which a RuntimeWarning tells: the nearest of the others is taken. Without,
    the sign is arbitrary but agrees among neighbours. out: an array for them, (3, N) float32 without gaps.

    Each coordinate is an array of its own: `nx, ny, nz = normals.T` are three without gaps."""
    given = _points(points)
    out = _target(out, (3, len(given[0])))
    eye, eyes = None, []
    if has_rows(eye_m):
        eyes = _eyes(eye_m, len(given[0]))
    elif eye_m is not None:
        eye = exactly(np.asarray(eye_m, float), 'eye_m', (3,), float)
    _stages.normals(given, number(cell_m, 'cell_m'), eye, eyes, _opened(device), list(out))
    return out.T


def _eyes(given, count):
    """Three columns, one for each point."""
    eyes = columns(given, ('vp_x', 'vp_y', 'vp_z'), 'eye_m')
    if len(eyes[0]) != count:
        raise usage(f'eye_m: expected shape (3,) or ({count}, 3), one for each point, not {len(eyes[0])} of them')
    unknown = count - np.count_nonzero(np.isfinite(eyes[0]) & np.isfinite(eyes[1]) & np.isfinite(eyes[2]))
    if unknown:
        warn(f'eye_m: of {count} points {unknown} have no finite place that they were seen from: '
             + ('they count as not known' if unknown == count else 'the nearest one of the others is taken'))
    return eyes


def _stored(depth, depth_scale, shape, name):
    """Depth as it is stored; metres are rounded to that, as those of frames are. shape: of the first image; None: this is it."""
    depth = as_array(depth, name)
    if depth.ndim != 2 or depth.dtype.kind not in 'fiu' or shape not in (None, depth.shape):
        expected = '(H, W)' if shape is None or len(shape) != 2 else f'{shape}, as depth 0'
        raise usage(f'{name}: expected uint16, metres times depth_scale, or floats, metres, of shape {expected}, not {depth.dtype} of '
                    f'shape {depth.shape}')
    if depth.dtype.kind != 'f' or not depth_scale > 0:
        return exactly(depth, name, depth.shape, np.uint16)
    with np.errstate(invalid='ignore'):
        stored = np.round(depth * depth_scale)
        held = (stored >= 0) & (stored <= 65535)
    if (stored[np.isfinite(stored)] > 65535).any() and not (stored[held] > 0).any():
        raise usage(f'{name}: all its readings lie beyond {figure(65535 / depth_scale)} m; floats are metres: of millimetres give '
                    f'{name.split()[0]} / 1000')
    return np.where(held, stored, 0).astype(np.uint16)


class Volume:
    """A voxel grid of surface voxels, to carve and fill. z up.

    points: the cloud. label: (N,) int32, what each point is part of, counted from 0, or -1. voxel_m: edge of a voxel,
    metres, 0.001 to 1."""

    def __init__(self, points, label, voxel_m):
        given = _points(points)
        self._volume = _stages.Volume(given, exactly(label, 'label', (len(given[0]),), np.int32), number(voxel_m, 'voxel_m'))

    def carve(self, depth, camera_to_world, intrinsics, *, device=None):
        """Makes voxels in front of a depth reading empty; may be called for one batch of frames after the other.

        depth: (F, H, W) uint16, metres times intrinsics.depth_scale, or floats, metres; or a list of (H, W), or one; 0, and of
        floats what is not finite or not above 0: no reading. camera_to_world: (F, 4, 4) float64, or (4, 4):
        rigid, metres, row by row. intrinsics: Intrinsics. Cameras and readings that can't be in metres are refused: cameras
        that leap, or are hundreds of metres from the points, and readings from as far away."""
        if not isinstance(depth, (list, tuple)):
            depth = as_array(depth, 'depth')
            depth = [depth] if depth.ndim == 2 else list(depth) if depth.ndim == 3 else [depth]
        if not depth:
            return
        poses = as_array(camera_to_world, 'camera_to_world')
        poses = exactly(poses[None] if poses.ndim == 2 else poses, 'camera_to_world', (len(depth), 4, 4), float)
        _check_rigid(poses)
        seen_by = camera(intrinsics, 'intrinsics')
        frames = [_stored(depth[0], seen_by[-1], None, 'depth 0')]
        height, width = frames[0].shape
        frames += [_stored(d, seen_by[-1], (height, width), f'depth {n}') for n, d in enumerate(depth[1:], 1)]
        self._volume.carve([f.reshape(-1) for f in frames], poses.reshape(-1), width, height, seen_by, _opened(device))

    def fill(self, votes, hollow=(), *, device=None):
        """Voxels that no frame saw take the label that at least `votes` (1 to 6) of the rays along their six axes hit
        first. hollow: labels that stop rays but neither fill nor are filled, as walls do. Returns how many voxels were
        completed."""
        labels = exactly(hollow, 'hollow', (None,), np.int32)
        if not isinstance(votes, (int, np.integer)) or not 1 <= votes <= 6:
            raise usage(f'votes: expected 1 to 6, not {votes!r}')
        return self._volume.fill(int(votes), labels.tolist(), _opened(device))

    def state_at(self, i, j, k):
        """The State of voxel (i, j, k); of arrays of voxels, int32, a uint8 array of their states. Beyond the cloud's
        bounds it is State.UNSEEN."""
        try:
            shape = np.broadcast_shapes(*(np.shape(index) for index in (i, j, k)))
        except ValueError as error:
            raise usage(f'i, j, k: shapes {np.shape(i)}, {np.shape(j)} and {np.shape(k)} do not go together') from error
        rows = [exactly(np.broadcast_to(as_array(index, name), shape).reshape(-1), name, (None,), np.int32)
                for index, name in zip((i, j, k), 'ijk')]
        states = self._volume.state_at(*rows)
        return states.reshape(shape) if shape else State(int(states[0]))

    def solid(self):
        """The solid Voxels."""
        return Voxels(*self._volume.solid())


def _check_rigid(poses):
    turn = np.clip(poses[:, :3, :3], -2, 2)  # beyond it is none, and may overflow
    rigid = (np.abs(turn @ turn.transpose(0, 2, 1) - np.eye(3)).max((1, 2)) < 1e-3) & (np.linalg.det(turn) > 0)
    rigid &= (poses[:, 3] == [0, 0, 0, 1]).all(1)
    if not rigid.all():
        n = int(np.argmin(rigid))
        raise usage(f'camera_to_world {n}: its rows are no rotation, a place and 0, 0, 0, 1, but {poses[n].tolist()}; a matrix '
                    'that is stored by columns takes .T')


def support_functions(vertices, first, directions, *, device=None, out=None):
    """Support functions of sets of vertices (the paper's Eq. 4): s(d) = min of v . d over the vertices v of each set,
    metres, for every direction d.

    vertices: as points, (V, 3). first: (sets + 1,) uint64, where each set starts in them, and last V; no set is empty.
    directions: as points, (D, 3). Returns (sets, D) float32; out: an array for it."""
    v, d = _coordinates(vertices, 'vertices'), _coordinates(directions, 'directions')
    starts = exactly(first, 'first', (None,), np.uint64)
    out = _target(out, (max(len(starts) - 1, 0), len(d[0])))
    _stages.support_functions(v, starts, d, _opened(device), out.reshape(-1))
    return out


def _beside_footing(points, center, resolution_m):
    """Whether all that bears the body lies to one side of its centre of mass."""
    footing = points[points[:, 2] <= points[:, 2].min() + resolution_m, :2] - center[:2]
    angles = np.sort(np.arctan2(footing[:, 1], footing[:, 0]))
    return np.diff(np.append(angles, angles[0] + 2 * np.pi)).max() > np.pi


def barriers(bodies, resolution_m, *, device=None):
    """What it takes to make each of the bodies fall by tipping (paper, 3.2): a list of Barrier.

    bodies: of StandingBody. resolution_m: to what their points are known, 0 to 1; what is no higher than that above the lowest
    point bears the body, and is its footing. What would be denser than any matter is refused, as is a centre of mass many times as
    far from the points as these extend, and what would be lighter than air, as by a density in g/cm3, is told by a RuntimeWarning.

    Points must go all around the body: its corners, or the solid voxels of an object, result.solid. Of a scan that saw it
    from one side the footing is a strip below that side, and a centre of mass that is not above it makes the body fall by
    itself: barrier_J is 0 then, which a RuntimeWarning says."""
    if not isinstance(bodies, (list, tuple)) or isinstance(bodies, StandingBody):
        raise usage(f'bodies: expected a list of StandingBody, not {type(bodies).__name__}')
    given = []
    for n, body in enumerate(bodies):
        points, mass_kg, center = _fields(StandingBody, body, f'bodies[{n}]')
        points = exactly(points, f'bodies[{n}].points', (None, 3), float)
        if 0 < len(points) < 4:
            raise usage(f'bodies[{n}].points: {len(points)} of them make no solid; give 4 at least, as the corners of its box')
        given.append((points.reshape(-1),
                      number(mass_kg, f'bodies[{n}].mass_kg'),
                      exactly(np.asarray(center, float), f'bodies[{n}].center_of_mass_m', (3,), float)))
    found = _stages.barriers(given, number(resolution_m, 'resolution_m'), _opened(device))
    for n, (points, mass_kg, _) in enumerate(given):
        size = np.ptp(points.reshape(-1, 3), axis=0) + resolution_m
        if mass_kg < _AIR_KG_M3 * size.prod():
            warn(f'bodies[{n}]: {figure(mass_kg)} kg in a box of {figure(size.prod())} m3 are less than air weighs; mass_kg is in kilograms, of '
                 'a density in kg/m3')
    for n, ((points, _, center), (barrier_J, *_)) in enumerate(zip(given, found)):
        if barrier_J == 0 and _beside_footing(points.reshape(-1, 3), center, resolution_m):
            warn(f'bodies[{n}]: its centre of mass is not above its footing, so that it falls by itself; of a body that a scan saw '
                 'from one side give points of its whole footing')
    return [Barrier(*energies, curve.reshape(-1, 2)) for *energies, curve in found]


def convolve(primary, footprint, first, *, device=None, out=None):
    """Disturbance field by convolution (paper, 5.1.2): for each direction d and cell c the sum of
    weight * primary[d, c + (dx, dy)] over the footprint's entries of d, in their order; cells beyond the map count as 0.

    primary: (directions, height, width) float32. footprint: records of footprint_dtype, or an array of shape (n, 3) whose
    columns are dx, dy (whole cells, along width and height) and weight. first: (directions + 1,) uint32, where each
    direction's entries start, and last n. Returns an array of primary's shape; out: an array for it."""
    planes = exactly(primary, 'primary', ('directions', 'height', 'width'), np.float32)
    entries = as_array(footprint, 'footprint')
    given = fields(entries, footprint_dtype.names, 'footprint')
    if given is None:
        table = exactly(entries, 'footprint', (None, 3), float)
        if not (table[:, :2] == np.rint(table[:, :2])).all():
            raise usage('footprint: dx and dy must be whole cells')
        given = [table[:, 0].astype(np.int64), table[:, 1].astype(np.int64), table[:, 2]]
    given = [exactly(e, f'footprint {name}', (None,), footprint_dtype[name]) for e, name in zip(given, footprint_dtype.names)]
    out = _target(out, planes.shape)
    _stages.convolve(planes.reshape(-1), planes.shape, given, exactly(first, 'first', (len(planes) + 1,), np.uint32),
                     _opened(device), out.reshape(-1))
    return out
