# SPDX-License-Identifier: MIT
"""Tells which things in a 3D scan of a room are one solid object, what holds what up, and what may fall.

    result = topple.parse(points)           # NumPy, (N, 3), metres; or a file, or a folder of depth frames
    for o in result.objects: print(o.id, o.unsafety, o.why)
    result.write("out")

Lengths in metres, masses in kilograms, energies in joules, in the input's frame; ids count from 0, -1 means
unassigned. Object.unsafety, 1 to 10, is NaN where what holds the object was not seen: such objects have no rank, and
a sort by unsafety alone would be left in no order. What goes wrong is raised as topple.Error.
"""
import json
import os
import threading
from typing import NamedTuple

import numpy as np

from . import _topple
from ._topple import AppliedCorrection, Contact, Device, DirectedBarrier, Error, Fall, Object, Overturning, Primitive, Support, __version__, open_device

__all__ = ['AppliedCorrection', 'Contact', 'Device', 'DeviceInfo', 'DirectedBarrier', 'Error', 'ExportSummary', 'ExportedBody', 'Fall', 'Object', 'Overturning', 'Primitive', 'Result',
           'Support', '__version__', 'devices', 'open_device', 'parse']


class DeviceInfo(NamedTuple):
    """A device of this machine, or why a backend offers none."""
    backend: str
    name: str
    driver: str
    gpu: bool
    usable: bool
    problem: str


class ExportedBody(NamedTuple):
    """What became of an object in an export, or a pad that was made to carry one (docs/export.md)."""
    name: str  # in the export: "object_3", "pad_28"
    object: int  # id; -1 for a pad
    fixed: bool  # part of the world, which nothing moves
    on_pad: bool  # its footing was not seen, or was cut away as it lay in others: it stands on a pad,
    held: bool  # or is held where it is
    struts: int  # of its parts: in the place of feet that were not seen
    moved_m: list  # by which it was let down, z up
    parts: int  # convex ones
    mass_kg: float
    solid_m3: float  # of the object as it was parsed
    parts_m3: float  # of its parts: more by what their hulls add
    lost_m3: float  # cut off its parts, so that no two bodies overlap


class ExportSummary(NamedTuple):
    """What Result.export() made."""
    bodies: list  # of ExportedBody: those of the objects by id, then pads
    deepest_overlap_m: float  # of any two bodies
    floor_m: float  # height of the main level floor; None: there is none
    free_place_m: list  # the middle of the widest place on it where nothing stands, x, y, z; None: there is none
    free_radius_m: float  # of that place; 0: there is none


def devices():
    """Every device of every backend, as `topple devices` lists them."""
    return [DeviceInfo(*listed) for listed in _topple.list_devices()]


def _usage(message):
    error = Error(message)
    error.kind = 'usage'
    return error


def _wrong_array(values, name, shape, variable, columns=''):
    """The Error that says what an array is and what it should be, with the mend."""
    mend = ''
    if values.dtype.kind in 'iub':
        mend = f"; {variable}{columns}.astype('float32') converts integers, and they must be metres"
    elif columns:
        mend = f'; {variable}{columns} takes the first three columns'
    return _usage(f'{name}: expected floats of shape {shape}, not {values.dtype} of shape {values.shape}{mend}')


def _column(values, name, variable):
    """One coordinate of each point as float32: where it lies, if it is that already."""
    values = np.asarray(values)
    if values.ndim != 1 or values.dtype.kind != 'f':
        raise _wrong_array(values, name, '(N,)', variable)
    return values if values.dtype == np.float32 else values.astype(np.float32)


def _columns(source, names, what):
    """The three coordinates of an array, of records with fields of these names, or of three arrays."""
    if isinstance(source, tuple) and len(source) == 3:
        return [_column(c, f'{what} {name}', name) for c, name in zip(source, names)]
    if hasattr(source, '__dlpack__') and not isinstance(source, np.ndarray):
        source = np.from_dlpack(source)
    source = np.asarray(source)
    if source.dtype.names:
        missing = [name for name in names if name not in source.dtype.names]
        if missing:
            raise _usage(f'{what}: the records have no field {missing[0]}')
        return [_column(source[name], f'{what} {name}', f"{what}['{name}']") for name in names]
    if source.ndim != 2 or source.shape[1] != 3 or source.dtype.kind != 'f':
        raise _wrong_array(source, what, '(N, 3)', what,
                           '[:, :3]' if source.ndim == 2 and source.shape[1] > 3 else '')
    if source.dtype != np.float32:
        source = source.astype(np.float32)
    return [source[:, axis] for axis in range(3)]


def _channels(source):
    """Red, green and blue of an array, of records with fields of these names, or of three arrays; no copies."""
    names = ('red', 'green', 'blue')
    if hasattr(source, '__dlpack__') and not isinstance(source, np.ndarray):
        source = np.from_dlpack(source)
    if isinstance(source, tuple) and len(source) == 3:
        channels = [np.asarray(c) for c in source]
    else:
        source = np.asarray(source)
        if source.dtype.names:
            missing = [name for name in names if name not in source.dtype.names]
            if missing:
                raise _usage(f'colours: the records have no field {missing[0]}')
            channels = [source[name] for name in names]
        elif source.ndim == 2 and source.shape[1] == 3:
            channels = [source[:, c] for c in range(3)]
        else:
            raise _usage(f'colours: an array of shape {source.shape}; expected (N, 3)')
    for channel in channels:
        if channel.dtype != np.uint8:
            raise _usage(f'colours: {channel.dtype}; expected uint8, 0 to 255: '
                         'of 0 to 1 give (255 * colours).astype(np.uint8)')
    return channels


class Result:
    """What a scan holds. Arrays over its points and voxels are the result's own memory, not copies: they keep
    it alive, and writing to them changes what write() writes."""

    def __init__(self, parsed, points, colours=()):
        self._parsed = parsed
        self._points = points  # the caller's, where they are theirs
        self._colours = colours
        self._writing = threading.Lock()  # the coordinates are in the result for as long as it takes

    def __getattr__(self, name):
        if name.startswith('_'):
            raise AttributeError(name)
        return getattr(self._parsed, name)

    def __dir__(self):
        return sorted(set(object.__dir__(self)) | {n for n in dir(self._parsed) if not n.startswith('_')})

    def __repr__(self):
        return f'<topple.Result of {self.source}: {len(self.objects)} objects on {self.backend}>'

    @property
    def xyz(self):
        """Three arrays: the coordinates of the points that the labels are of. Of arrays that were given, views of
        these, unless points that are not finite were left out."""
        if self._points is None:
            return self._parsed.x, self._parsed.y, self._parsed.z
        index = self._parsed.point_index
        return tuple(c[index] if len(index) else c for c in self._points)

    @property
    def normals(self):
        """Three arrays: unit normals of the points, towards the side that was seen; 0 where there is none."""
        return self._parsed.nx, self._parsed.ny, self._parsed.nz

    def write(self, folder, *, pictures=False, glb=False, octomap=False):
        """Writes the folder of outputs (docs/output.md), which appears whole or not at all: with view-*.png,
        objects.glb and map.bt where they are asked for."""
        with self._writing:
            _topple.write(self._parsed, os.fspath(folder), pictures, glb, octomap, self._points or [],
                          list(self._colours))

    def export(self, *, mjcf=None, urdf=None, sdf=None, usd=None, visuals=True, threads=0):
        """Writes the scene for simulators, in the formats whose paths are given, and what became of each body as
        bodies.json beside it (docs/export.md); returns an ExportSummary. mjcf, urdf, sdf: the folders for scene.xml
        (MuJoCo's format), scene.urdf and scene.sdf; usd: the file, NAME.usda. visuals: what bodies look like, in the
        scan's colours, beside what collides. Folders are made where they are missing; an earlier export is replaced, a
        file of others is an Error of kind "input". threads: 0 for all cores; the result is the same. Other threads of
        Python run meanwhile."""
        paths = {'mjcf': mjcf, 'urdf': urdf, 'sdf': sdf, 'usd': usd}
        given = {name: os.fspath(path) for name, path in paths.items() if path is not None}
        bodies, *rest = _topple.export_scene(self._parsed, given, visuals, threads)
        return ExportSummary([ExportedBody(*body) for body in bodies], *rest)


def _files(given):
    """The paths of one file, of several, or of None."""
    if given is None:
        return []
    return [os.fspath(given)] if isinstance(given, (str, os.PathLike)) else [os.fspath(file) for file in given]


def _corrections_text(corrections):
    """The file's text of a list of corrections; numbers and arrays of NumPy are taken as they are in lists."""
    def plain(value):
        if hasattr(value, 'tolist'):
            return value.tolist()
        raise _usage(f'corrections: {value!r} is no number, text or list')
    try:
        listed = [dict(c) for c in corrections]
    except (TypeError, ValueError):
        raise _usage(f'corrections: expected a file or a list of dicts, not {corrections!r}'[:200]) from None
    return json.dumps({'schema': 'topple.corrections/1', 'corrections': listed}, default=plain)


def _components(accelerogram):
    """The paths of a record's components along, across and up, None where one is not known."""
    given = [accelerogram] if isinstance(accelerogram, (str, os.PathLike)) else list(accelerogram)
    if not 1 <= len(given) <= 3 or given[0] is None:
        raise _usage(f'accelerogram: expected a file, or up to three: along, across and up, not {accelerogram!r}')
    return [None if file is None else os.fspath(file) for file in given + [None] * (3 - len(given))]


def parse(source, *, device=None, voxel_m=0.0, unit_m=1.0, up=None, disturbances=None,
          seed=1, max_memory_bytes=0, density_kg_m3=700.0, friction=0.3, contents_kg_m3=68.0, walks=500, motion=None, wind_m_s=12.0,
          wind_from_deg=None, pga_m_s2=None, accelerogram=None, floor_amplification=1.0, hazard=None, tolerable_J=0.1, grouping_time_s=None, corrections=None, cache_file=None, normals=None,
          viewpoint=None, colours=None, isolate=True, progress=None, cancelled=None):
    """Parses a scan into a Result.

    source: a path, as the command line takes it; or points in metres: an array of shape (N, 3), records with
    fields x, y, z, a tuple of three arrays, or whatever has __dlpack__. float32 is read where it lies, with any
    strides, and must not change meanwhile; float64 is converted, which takes 12 bytes a point, and integers are
    refused: hardly ever are they metres. Points that are not finite are left out: Result.point_index then says
    where the others are.

    disturbances: a list of "human", "wind", "earthquake", which may be empty; or one of these names; or None for
    all that there are.

    device: a Device of open_device(), or a backend's name. motion: a file, or a list of files; accelerogram: a file, or
    a tuple of up to three with a record's components along, across and up, None for one that is not known; hazard: a file. normals, viewpoint: of
    points, as they are given; where the sensor was. colours: of points, sRGB as uint8, an array of shape (N, 3),
    records with fields red, green, blue, or a tuple of three arrays; 0, 0, 0 where it is not known. progress(stage, done) is called as stages start and go on;
    contents_kg_m3: of closed furniture, or None where all is solid.
    corrections: what you know of the room beside the scan: a file, or a list of dicts such as {"do": "fixed", "at_m":
    [[x, y, z]]} (docs/corrections.md); Result.corrections says what became of each. cache_file: keeps what does not
    depend on them, so that the next parse of that file or folder is quick.
    cancelled() is polled, and True stops the parse with an Error of kind "cancelled". Ctrl-C stops it, too, with
    KeyboardInterrupt. isolate=False: meshes, OctoMaps and OpenVDB files are read in this process, not in one of
    its own with limits of memory and time; for large files that you trust. Other threads of Python run meanwhile. The other options
    are those of `topple parse --help`.
    """
    options = _topple.Options()
    options.voxel_m, options.unit_m, options.up = voxel_m, unit_m, up
    if disturbances is not None:
        options.disturbances = [disturbances] if isinstance(disturbances, str) else list(disturbances)
    options.seed, options.isolate = seed, isolate
    options.max_memory_bytes, options.density_kg_m3, options.friction = max_memory_bytes, density_kg_m3, friction
    options.contents_kg_m3 = contents_kg_m3
    options.walks, options.wind_m_s, options.wind_from_deg = walks, wind_m_s, wind_from_deg
    options.pga_m_s2, options.tolerable_J, options.grouping_time_s = pga_m_s2, tolerable_J, grouping_time_s
    for file in _files(motion):
        options.read_motion(file)
    if accelerogram is not None:
        options.read_accelerogram(*_components(accelerogram))
    options.floor_amplification = floor_amplification
    if hazard is not None:
        options.read_hazard_curve(os.fspath(hazard))
    if isinstance(corrections, (str, os.PathLike)):
        options.read_corrections(os.fspath(corrections))
    elif corrections is not None:
        options.take_corrections(_corrections_text(corrections))
    if cache_file is not None:
        options.set_cache_file(os.fspath(cache_file))
    if isinstance(device, str):
        device = open_device(device)
    if isinstance(source, (str, os.PathLike)):
        if normals is not None or viewpoint is not None or colours is not None:
            raise _usage('normals, colours and viewpoint are for points in memory; a file brings its own')
        return Result(_topple.parse_path(os.fspath(source), device, options, progress, cancelled), None)
    points = _columns(source, ('x', 'y', 'z'), 'points')
    directions = [] if normals is None else _columns(normals, ('nx', 'ny', 'nz'), 'normals')
    channels = [] if colours is None else _channels(colours)
    return Result(_topple.parse_arrays(points, directions, channels, viewpoint, device, options, progress, cancelled),
                  points, channels)
