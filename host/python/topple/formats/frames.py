# SPDX-License-Identifier: MIT
"""Depth frames on their way into a folder that topple reads: depth/*.png, intrinsics.json, trajectory.txt."""
import dataclasses
import json
import struct
import zlib

import numpy as np

from .errors import wrong


@dataclasses.dataclass(frozen=True)
class Camera:
    """A pinhole camera, in pixels; pixel (u, v) has its centre at (u, v)."""
    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float

    def resized(self, width, height):
        """The camera of the same images in another size."""
        x, y = width / self.width, height / self.height
        return Camera(width, height, self.fx * x, self.fy * y, (self.cx + 0.5) * x - 0.5, (self.cy + 0.5) * y - 0.5)


def png(values):
    """An image as the bytes of a PNG: (height, width) uint16 grey, or (height, width, 3) uint8 sRGB."""
    height, width = values.shape[:2]
    depth, colour = (16, 0) if values.ndim == 2 else (8, 2)
    data = np.ascontiguousarray(values.astype('>u2') if depth == 16 else values).view(np.uint8).reshape(height, -1)
    rows = np.zeros((height, 1 + data.shape[1]), np.uint8)  # each begins with its filter, none
    rows[:, 1:] = data

    def chunk(kind, data):
        return struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))

    return (b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', struct.pack('>IIBBBBB', width, height, depth, colour, 0, 0, 0)) +
            chunk(b'IDAT', zlib.compress(rows.tobytes(), 1)) + chunk(b'IEND', b''))


def as_seen_by(camera, depth, other):
    """The depth image of a camera, (height, width), as another at the same place with the same direction sees it: the
    nearest pixel's, 0 where there is none."""
    if other == camera:
        return depth
    u = np.round((np.arange(other.width) - other.cx) * (camera.fx / other.fx) + camera.cx).astype(int)
    v = np.round((np.arange(other.height) - other.cy) * (camera.fy / other.fy) + camera.cy).astype(int)
    inside = ((v >= 0) & (v < camera.height))[:, None] & ((u >= 0) & (u < camera.width))[None, :]
    seen = depth[np.clip(v, 0, camera.height - 1)][:, np.clip(u, 0, camera.width - 1)]
    return np.where(inside, seen, 0)


class Frames:
    """What becomes of frames, one by one; all get the first one's intrinsics. Of those below it one says where they go."""

    def __init__(self, source, depth_scale=1000.0):
        """source: the file to name in errors; depth_scale: metres = stored value / depth_scale."""
        self.source, self.depth_scale = source, depth_scale
        self.camera = None
        self.poses = []
        self.resampled = 0

    def add(self, camera, depth_m, pose, colour=None):
        """depth_m: (height, width) along the camera's axis in metres; 0, NaN: no reading. pose: 4 x 4, camera to world, the camera's
        x right, y down, z forward, metres. colour: of what the camera saw, (height, width, 3) uint8 sRGB, or of a folder the bytes of a
        JPEG or PNG."""
        if depth_m.shape != (camera.height, camera.width):
            raise wrong(self.source, f'frame {len(self.poses)} has {depth_m.shape[1]} x {depth_m.shape[0]} pixels of depth, '
                                     f'its camera {camera.width} x {camera.height}')
        if self.camera is None:
            self._check(camera)
            self.camera = camera
            self._begin({**dataclasses.asdict(camera), 'depth_scale': self.depth_scale})
        if camera != self.camera:
            self.resampled += 1
            colour = None  # they would have intrinsics of their own
        if not np.isfinite(pose).all():
            raise wrong(self.source, f'the pose of frame {len(self.poses)} is not finite')
        depth_m = np.where(np.isfinite(depth_m) & (depth_m > 0), depth_m, 0)
        stored = np.round(as_seen_by(camera, depth_m, self.camera) * self.depth_scale)
        # What 16 bits can't hold is no reading, as it is with sensors.
        self._put(np.where(stored > 65535, 0, stored).astype(np.uint16), np.asarray(pose, float), colour)
        self.poses.append(pose)

    def _check(self, camera):
        if not (camera.width > 0 and camera.height > 0 and np.isfinite([camera.fx, camera.fy, camera.cx, camera.cy]).all()
                and camera.fx >= 1 and camera.fy >= 1):
            raise wrong(self.source, f'its camera makes no sense, in pixels: {camera}')

    def finish(self, notes=()):
        """The notes, with what was done to the frames."""
        if not self.poses:
            raise wrong(self.source, 'has no depth frame with a pose')
        notes = list(notes)
        if self.resampled:
            notes.append(f'{self.resampled} of {len(self.poses)} depth images have intrinsics of their own, and were resampled '
                         "to the first one's.")
        return notes


class FrameFolder(Frames):
    """Writes a folder, so that `topple live` may follow it."""

    def __init__(self, folder, source, depth_scale=1000.0):
        super().__init__(source, depth_scale)
        self.folder = folder
        (folder / 'depth').mkdir(parents=True)

    def _begin(self, intrinsics):
        (self.folder / 'intrinsics.json').write_text(json.dumps(intrinsics))

    def _put(self, depth, pose, colour):
        name = f'{len(self.poses):06d}'
        (self.folder / 'depth' / f'{name}.png').write_bytes(png(depth))
        if colour is not None:
            (self.folder / 'color').mkdir(exist_ok=True)
            colour = colour if isinstance(colour, bytes) else png(colour)
            ending = 'png' if colour.startswith(b'\x89PNG') else 'jpg'
            (self.folder / 'color' / f'{name}.{ending}').write_bytes(colour)
        with open(self.folder / 'trajectory.txt', 'a', encoding='ascii') as file:
            file.write(' '.join(repr(float(v)) for v in pose[:3].ravel()) + '\n')


class Messages(Frames):
    """Writes the messages that `topple live -` takes, of frames or of sweeps of points."""

    def __init__(self, file, source, depth_scale=1000.0):
        super().__init__(source, depth_scale)
        self.file = file

    def add_points(self, points, pose, colours=None):
        """points: (N, 3) in the sensor's axes, metres; pose: 4 x 4, sensor to world; colours: (N, 3) uint8 sRGB."""
        self._say({'add': 'points', 'count': len(points), 'pose': np.ravel(pose).tolist(), 'rgb': colours is not None},
                  np.asarray(points, '<f4'), colours)

    def _begin(self, intrinsics):
        self._say({'intrinsics': intrinsics})

    def _put(self, depth, pose, colour):
        self._say({'add': 'frame', 'pose': pose.ravel().tolist(), 'rgb': colour is not None}, depth.astype('<u2'), colour)

    def _say(self, message, *arrays):
        readings = b''.join(np.ascontiguousarray(a).tobytes() for a in arrays if a is not None)
        self.file.write(json.dumps(message).encode() + b'\n' + readings)
        self.file.flush()


# Phones' LiDAR reaches this far; what they tell of depth beyond is made up.
PHONE_REACH_M = 5.0


def by_phone(depth_m, confidence):
    """Depth of a phone's LiDAR without what is too far, or what it trusts least itself: confidence 0. confidence: of the same shape, or
    None."""
    good = depth_m <= PHONE_REACH_M if confidence is None else (depth_m <= PHONE_REACH_M) & (confidence > 0)
    return np.where(good, depth_m, 0.0)


def from_graphics(pose):
    """Camera to world of a camera with x right, y up and looking along -z (OpenGL, ARKit), as topple has it."""
    return pose @ np.diag([1.0, -1.0, -1.0, 1.0])


def rotation(x, y, z, w):
    """The 3 x 3 matrix of a quaternion, which needs no unit length; NaN where it has none."""
    norm = np.sqrt(x * x + y * y + z * z + w * w)
    with np.errstate(invalid='ignore', divide='ignore'):
        x, y, z, w = np.array([x, y, z, w]) / norm
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def pose(quaternion_xyzw, position):
    """4 x 4 of a rotation and a translation."""
    out = np.eye(4)
    out[:3, :3] = rotation(*quaternion_xyzw)
    out[:3, 3] = position
    return out
