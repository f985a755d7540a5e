# SPDX-License-Identifier: MIT
"""COLMAP: a dense workspace's depth maps with their poses, as frames; else its fused points, or a sparse model's points.

Its unit is arbitrary, unless the model was scaled: unit_m says how many metres one has."""
import io
import itertools
import pathlib
import struct
from typing import NamedTuple

import numpy as np

from .cloud import Cloud, kept
from .errors import reading, wrong
from .frames import Camera, FrameFolder, pose
from .scan_folder import ScanFolder, regular

FORMAT = 'COLMAP model'
UNIT_NOTE = ("COLMAP's unit is arbitrary: energies and masses are only right if the model was scaled to metres, or unit_m says "
             'how many metres a unit has.')
# Binary models number the cameras' models; the others have lens distortion, which depth maps are free of.
PINHOLES = {0: 'SIMPLE_PINHOLE', 1: 'PINHOLE'}
FUSED = ('fused.ply', 'dense/fused.ply', 'dense/0/fused.ply')
PARAMETERS = (3, 4, 4, 5, 8, 8, 12, 5, 4, 5, 12)


class _File(NamedTuple):
    """One of a model, and what it holds."""
    path: pathlib.Path
    data: bytes

    @property
    def is_text(self):
        return self.path.suffix == '.txt'

    def lines(self):
        """The words of each line that is no comment."""
        return (line.split() for line in io.TextIOWrapper(io.BytesIO(self.data), encoding='utf-8') if not line.startswith('#'))


class _Bytes:
    """Takes values off the front of a little-endian binary file."""

    def __init__(self, file):
        self.path, self.data, self.at = file.path, file.data, 0

    def take(self, form):
        values = struct.unpack_from('<' + form, self.data, self.at)
        self.at += struct.calcsize('<' + form)
        return values

    def skip(self, count, size):
        if count * size > len(self.data) - self.at:
            raise wrong(self.path, f'is cut short: byte {self.at} promises {count} entries of {size} bytes')
        self.at += count * size

    def text(self):
        end = self.data.index(b'\0', self.at)
        out, self.at = self.data[self.at:end].decode(), end + 1
        return out


def _model_file(folder, name):
    """cameras, images or points3D of a model, binary or text; None: there is none."""
    for ending in ('.bin', '.txt'):
        if (folder / (name + ending)).is_file():
            return folder / (name + ending)
    return None


def read_file(path):
    """The _File that a user named."""
    with reading(path, FORMAT), regular(path) as opened:
        return _File(path, opened.read())


def _of_model(scan, folder, name):
    """The _File of a model that lies in a folder of the scan's."""
    path = _model_file(folder, name)
    with reading(path, FORMAT):
        return _File(path, scan.read(path.relative_to(scan.path).as_posix()))


def _is_model(folder):
    return all(_model_file(folder, name) for name in ('cameras', 'images', 'points3D'))


def _cameras(file):
    """{id: (Camera, or None of one with distortion, name of its model)}."""
    found = {}

    def add(number, model, width, height, values):
        camera = None
        if model in ('SIMPLE_PINHOLE', 'PINHOLE'):
            fx, fy = (values[0], values[0]) if model == 'SIMPLE_PINHOLE' else values[:2]
            # COLMAP's pixels have their centres at a half.
            camera = Camera(width, height, fx, fy, values[-2] - 0.5, values[-1] - 0.5)
        found[number] = camera, model

    with reading(file.path, FORMAT):
        if file.is_text:
            for words in filter(None, file.lines()):
                add(int(words[0]), words[1], int(words[2]), int(words[3]), [float(w) for w in words[4:]])
        else:
            left = _Bytes(file)
            for _ in range(left.take('Q')[0]):
                number, model, width, height = left.take('iiQQ')
                if not 0 <= model < len(PARAMETERS):
                    raise wrong(file.path, f'has a camera of model {model}; 0 to {len(PARAMETERS) - 1} are known')
                add(number, PINHOLES.get(model, f'number {model}'), width, height, left.take(f'{PARAMETERS[model]}d'))
    return found


def _images(file):
    """[(name, id of its camera, 4 x 4 camera to world)], by name."""
    found = []

    def add(name, camera, w, x, y, z, *translation):
        world_to_camera = pose((x, y, z, w), translation)
        found.append((name, camera, np.linalg.inv(world_to_camera)))

    with reading(file.path, FORMAT):
        if file.is_text:
            # Every other line has the image's points, and may be empty.
            for words in itertools.islice(file.lines(), 0, None, 2):
                if words:
                    add(' '.join(words[9:]), int(words[8]), *(float(w) for w in words[1:8]))
        else:
            left = _Bytes(file)
            for _ in range(left.take('Q')[0]):
                values = left.take('i7di')
                name = left.text()
                left.skip(left.take('Q')[0], 24)
                add(name, values[8], *values[1:8])
    return sorted(found, key=lambda image: image[0])


def points_of(file):
    """The Cloud of a points3D.bin or points3D.txt."""
    points, colours = [], []
    with reading(file.path, FORMAT):
        if file.is_text:
            for words in filter(None, file.lines()):
                points.append([float(w) for w in words[1:4]])
                colours.append([int(w) for w in words[4:7]])
        else:
            left = _Bytes(file)
            for _ in range(left.take('Q')[0]):
                _, x, y, z, red, green, blue, _ = left.take('Q3d3Bd')
                points.append((x, y, z))
                colours.append((red, green, blue))
                left.skip(left.take('Q')[0], 8)
        if not points:
            raise wrong(file.path, 'has no points')
        return Cloud(np.array(points, float).reshape(-1, 3), np.array(colours).reshape(-1, 3).astype(np.uint8),
                     notes=[f'The {len(points)} points are of a sparse model, which shows corners and texture and leaves out plain '
                            "surfaces. COLMAP's dense reconstruction (its depth maps or fused.ply) tells much more.", UNIT_NOTE])


def _depth_map(scan, name):
    """(height, width) float32, in the model's unit along the camera's axis; 0: none."""
    path = scan.path / name
    with reading(path, 'COLMAP depth map'):
        data = scan.read(name)
        width, height, channels, rest = data[:64].split(b'&', 3)
        width, height, channels = int(width), int(height), int(channels)
        start = len(data[:64]) - len(rest)
        if channels != 1 or width < 1 or height < 1 or len(data) - start != 4 * width * height:
            raise wrong(path, f'has {len(data) - start} bytes of depth for {width} x {height} x {channels} values of 4; '
                              'it is cut short, or no depth map')
        return np.frombuffer(data, '<f4', offset=start).reshape(height, width)


def _dense(folder):
    """The dense workspace that a folder is or has, else None."""
    for workspace in (folder, folder / 'dense', folder / 'dense' / '0'):
        maps = workspace / 'stereo' / 'depth_maps'
        if maps.is_dir() and _is_model(workspace / 'sparse') and next(maps.rglob('*.geometric.bin'), None):
            return workspace
    return None


def _sparse(folder):
    for model in (folder, folder / 'sparse', folder / 'sparse' / '0'):
        if _is_model(model):
            return model
    return None


def recognises(path):
    if path.is_file():
        return path.name in ('points3D.bin', 'points3D.txt')
    return path.is_dir() and (_dense(path) or _sparse(path)) is not None


def _frames(scan, workspace, folder, unit_m):
    cameras = _cameras(_of_model(scan, workspace / 'sparse', 'cameras'))
    place = workspace.relative_to(scan.path)
    maps = []
    for name, number, camera_to_world in _images(_of_model(scan, workspace / 'sparse', 'images')):
        # What COLMAP calls an image is a path below images/, which a stranger may lead out of it.
        file, image = f'{place}/stereo/depth_maps/{name}.geometric.bin'.removeprefix('./'), f'{place}/images/{name}'.removeprefix('./')
        if not scan.has(file):
            continue
        if number not in cameras:
            raise wrong(workspace, f'image {name} has camera {number}, which the model lacks')
        camera, model = cameras[number]
        if camera is None:
            raise wrong(workspace, f'image {name} has a camera with distortion ({model}); depth maps are of pinhole cameras, as '
                                   'colmap image_undistorter makes them')
        maps.append((file, image, camera, camera_to_world))
    if not maps:
        raise wrong(workspace, 'has no stereo/depth_maps/*.geometric.bin of an image of its model')
    farthest = max(float(np.nanmax(_depth_map(scan, file), initial=0)) for file, *_ in maps) * unit_m
    if not 0 < farthest < 65535:
        raise wrong(workspace, f'its depth maps reach {farthest:g} m; say by unit_m how many metres a unit has')
    frames = FrameFolder(folder, workspace, depth_scale=float(min(1e6, max(1, np.floor(65535 / farthest)))))
    for file, image, camera, camera_to_world in maps:
        depth = _depth_map(scan, file)
        if depth.shape != (camera.height, camera.width):
            camera = camera.resized(depth.shape[1], depth.shape[0])
        seen = scan.read(image) if image.lower().endswith(('.jpg', '.jpeg', '.png')) and scan.has(image) else None
        in_metres = camera_to_world.copy()
        in_metres[:3, 3] *= unit_m
        frames.add(camera, depth * unit_m, in_metres, seen)
    return frames.finish([] if unit_m != 1 else [UNIT_NOTE])


def convert(path, folder, options):
    if path.is_dir():
        scan = ScanFolder(path)
        if workspace := _dense(path):
            return folder, _frames(scan, workspace, folder, options.unit_m), None
        for name in FUSED:
            if scan.has(name):
                scan.open(name).close()
                return path / name, [UNIT_NOTE] if options.unit_m == 1 else [], None
        file = _of_model(scan, _sparse(path), 'points3D')
    else:
        file = read_file(path)
    return kept(points_of(file).moved_near(options.unit_m), path, folder, options)
