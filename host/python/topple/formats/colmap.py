# SPDX-License-Identifier: MIT
"""COLMAP: a dense workspace's depth maps with their poses, as frames; else its fused points, or a sparse model's points.

Its unit is arbitrary, unless the model was scaled: unit_m says how many metres one has."""
import struct

import numpy as np

from .cloud import Cloud, write_cloud
from .errors import reading, wrong
from .frames import Camera, FrameFolder, pose

FORMAT = 'COLMAP model'
UNIT_NOTE = ("COLMAP's unit is arbitrary: energies and masses are only right if the model was scaled to metres, or unit_m says "
             'how many metres a unit has.')
# Binary models number the cameras' models; the others have lens distortion, which depth maps are free of.
PINHOLES = {0: 'SIMPLE_PINHOLE', 1: 'PINHOLE'}
PARAMETERS = (3, 4, 4, 5, 8, 8, 12, 5, 4, 5, 12)


class _Bytes:
    """Takes values off the front of a little-endian binary file."""

    def __init__(self, path):
        self.path, self.data, self.at = path, path.read_bytes(), 0

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


def _lines(path):
    """The words of each line that is no comment."""
    with open(path, encoding='utf-8') as file:
        return [line.split() for line in file if line.strip() and not line.startswith('#')]


def _model_file(folder, name):
    """cameras, images or points3D of a model, binary or text; None: there is none."""
    for ending in ('.bin', '.txt'):
        if (folder / (name + ending)).is_file():
            return folder / (name + ending)
    return None


def _is_model(folder):
    return all(_model_file(folder, name) for name in ('cameras', 'images', 'points3D'))


def _cameras(path):
    """{id: (Camera, or None of one with distortion, name of its model)}."""
    found = {}

    def add(number, model, width, height, values):
        camera = None
        if model in ('SIMPLE_PINHOLE', 'PINHOLE'):
            fx, fy = (values[0], values[0]) if model == 'SIMPLE_PINHOLE' else values[:2]
            # COLMAP's pixels have their centres at a half.
            camera = Camera(width, height, fx, fy, values[-2] - 0.5, values[-1] - 0.5)
        found[number] = camera, model

    with reading(path, FORMAT):
        if path.suffix == '.txt':
            for words in _lines(path):
                add(int(words[0]), words[1], int(words[2]), int(words[3]), [float(w) for w in words[4:]])
        else:
            file = _Bytes(path)
            for _ in range(file.take('Q')[0]):
                number, model, width, height = file.take('iiQQ')
                if not 0 <= model < len(PARAMETERS):
                    raise wrong(path, f'has a camera of model {model}; 0 to {len(PARAMETERS) - 1} are known')
                add(number, PINHOLES.get(model, f'number {model}'), width, height, file.take(f'{PARAMETERS[model]}d'))
    return found


def _images(path):
    """[(name, id of its camera, 4 x 4 camera to world)], by name."""
    found = []

    def add(name, camera, w, x, y, z, *translation):
        world_to_camera = pose((x, y, z, w), translation)
        found.append((name, camera, np.linalg.inv(world_to_camera)))

    with reading(path, FORMAT):
        if path.suffix == '.txt':
            # Every other line has the image's points, and may be empty.
            with open(path, encoding='utf-8') as file:
                rows = [line.split() for line in file if not line.startswith('#')]
            for words in rows[::2]:
                if words:
                    add(' '.join(words[9:]), int(words[8]), *(float(w) for w in words[1:8]))
        else:
            file = _Bytes(path)
            for _ in range(file.take('Q')[0]):
                values = file.take('i7di')
                name = file.text()
                file.skip(file.take('Q')[0], 24)
                add(name, values[8], *values[1:8])
    return sorted(found, key=lambda image: image[0])


def read_points(path):
    """The Cloud of a points3D.bin or points3D.txt."""
    points, colours = [], []
    with reading(path, FORMAT):
        if path.suffix == '.txt':
            for words in _lines(path):
                points.append([float(w) for w in words[1:4]])
                colours.append([int(w) for w in words[4:7]])
        else:
            file = _Bytes(path)
            for _ in range(file.take('Q')[0]):
                _, x, y, z, red, green, blue, _ = file.take('Q3d3Bd')
                points.append((x, y, z))
                colours.append((red, green, blue))
                file.skip(file.take('Q')[0], 8)
        if not points:
            raise wrong(path, 'has no points')
        return Cloud(np.array(points, float).reshape(-1, 3), np.array(colours).reshape(-1, 3).astype(np.uint8),
                     notes=[f'The {len(points)} points are of a sparse model, which shows corners and texture and leaves out plain '
                            "surfaces. COLMAP's dense reconstruction (its depth maps or fused.ply) tells much more.", UNIT_NOTE])


def read_depth_map(path):
    """(height, width) float32, in the model's unit along the camera's axis; 0: none."""
    with reading(path, 'COLMAP depth map'):
        data = path.read_bytes()
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


def _frames(workspace, folder, unit_m):
    cameras = _cameras(_model_file(workspace / 'sparse', 'cameras'))
    maps = []
    for name, number, camera_to_world in _images(_model_file(workspace / 'sparse', 'images')):
        file = workspace / 'stereo' / 'depth_maps' / f'{name}.geometric.bin'
        if not file.is_file():
            continue
        if number not in cameras:
            raise wrong(workspace, f'image {name} has camera {number}, which the model lacks')
        camera, model = cameras[number]
        if camera is None:
            raise wrong(workspace, f'image {name} has a camera with distortion ({model}); depth maps are of pinhole cameras, as '
                                   'colmap image_undistorter makes them')
        maps.append((name, file, camera, camera_to_world))
    if not maps:
        raise wrong(workspace, 'has no stereo/depth_maps/*.geometric.bin of an image of its model')
    farthest = max(float(np.nanmax(read_depth_map(file), initial=0)) for _, file, _, _ in maps) * unit_m
    if not 0 < farthest < 65535:
        raise wrong(workspace, f'its depth maps reach {farthest:g} m; say by unit_m how many metres a unit has')
    frames = FrameFolder(folder, workspace, depth_scale=float(min(1e6, max(1, np.floor(65535 / farthest)))))
    for name, file, camera, camera_to_world in maps:
        depth = read_depth_map(file)
        if depth.shape != (camera.height, camera.width):
            camera = camera.resized(depth.shape[1], depth.shape[0])
        image = workspace / 'images' / name
        seen = image.read_bytes() if image.suffix.lower() in ('.jpg', '.jpeg', '.png') and image.is_file() else None
        in_metres = camera_to_world.copy()
        in_metres[:3, 3] *= unit_m
        frames.add(camera, depth * unit_m, in_metres, seen)
    return frames.finish([] if unit_m != 1 else [UNIT_NOTE])


def convert(path, folder, options):
    workspace = _dense(path) if path.is_dir() else None
    if workspace:
        return folder, _frames(workspace, folder, options.unit_m), None
    if path.is_dir():
        for place in (path, path / 'dense', path / 'dense' / '0'):
            if (place / 'fused.ply').is_file():
                return place / 'fused.ply', [UNIT_NOTE] if options.unit_m == 1 else [], None
    cloud = read_points(path if path.is_file() else _model_file(_sparse(path), 'points3D')).moved_near(options.unit_m)
    out = folder / f'points{options.ending}'
    write_cloud(out, cloud, path)
    return out, cloud.notes, cloud.offset
