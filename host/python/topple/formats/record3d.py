# SPDX-License-Identifier: MIT
"""Record3D's recordings of phones with LiDAR: .r3d (pyliblzfse), or its export of EXR images with metadata.json (OpenEXR), as a zip
archive or a folder. Depth beyond 5 m, and what the phone itself trusts least, is left out."""
import os
import tempfile

import numpy as np

from .errors import needs, reading, wrong
from .frames import Camera, FrameFolder, by_phone, from_graphics, pose
from .limits import Budget
from .packed_folder import PackedFolder, holds

FORMAT = 'Record3D recording'


def recognises(path):
    return path.suffix.lower() == '.r3d' or (holds(path, 'metadata.json', '.zip') and holds(path, 'depth', '.zip') and
                                             (holds(path, 'rgb', '.zip') or holds(path, 'color', '.zip')))


def _cameras(path, metadata, count):
    """For each frame its Camera, of the colour image, and its pose."""
    with reading(path, FORMAT):
        width, height = int(metadata['w']), int(metadata['h'])
        k = np.array(metadata['K'], float).reshape(3, 3)  # by columns
        shared = k[0, 0], k[1, 1], k[2, 0], k[2, 1]
        own = metadata.get('perFrameIntrinsicCoeffs') or [shared] * count
        poses = np.array(metadata['poses'], float).reshape(-1, 7)
        if len(poses) < count or len(own) < count:
            raise wrong(path, f'has {count} frames of depth, but {len(poses)} poses and {len(own)} intrinsics')
        return [(_camera(width, height, *(float(v) for v in own[n])), from_graphics(pose(poses[n, :4], poses[n, 4:])))
                for n in range(count)]


def _camera(width, height, fx, fy, cx, cy):
    """Of a phone held upright; some recordings have the intrinsics of the sensor, which lies on its side then."""
    across = abs(cy - width / 2) + abs(cx - height / 2)
    return Camera(width, height, fy, fx, cy, cx) if across < abs(cx - width / 2) + abs(cy - height / 2) else Camera(width, height, fx, fy, cx, cy)


def _exr(path, name, data, budget):
    """The one channel of an EXR image, float32, metres."""
    openexr = needs('OpenEXR', 'OpenEXR', path)
    with tempfile.TemporaryDirectory(prefix='topple-') as place:  # OpenEXR reads files only
        file = os.path.join(place, 'depth.exr')
        with open(file, 'wb') as out:
            out.write(data)
        try:
            window = openexr.File(file, header_only=True).header()['dataWindow']
            width, height = (int(high) - int(low) + 1 for low, high in zip(*window))
        except Exception:
            raise wrong(path, f'{name} is no EXR image, cut short or damaged') from None
        budget.take(16 * width * height, f'{name}, of {width} x {height} pixels,')
        try:
            channels = openexr.File(file, separate_channels=True).channels()
        except Exception:  # which would tell of the temporary file
            raise wrong(path, f'{name} is no EXR image, cut short or damaged') from None
        for channel in ('R', 'Z', 'Y'):
            if channel in channels:
                return np.array(channels[channel].pixels, np.float32)
        raise wrong(path, f'{name} has channels {", ".join(channels)}; R, Z or Y is read')


def _numbers(names):
    """Frames are numbered from 0, without leading zeros."""
    return sorted((int(name) for name in names if name.isdigit()))


def _recording(path, folder, budget):
    lzfse = needs('liblzfse', 'pyliblzfse', path)
    with PackedFolder(path, 'metadata', budget) as export:
        metadata = export.json('metadata')
        numbers = _numbers(export.list('rgbd/', '.depth'))
        with reading(path, FORMAT):
            width, height = int(metadata.get('dw', metadata['w'])), int(metadata.get('dh', metadata['h']))

        def unpacked(name, kind):
            with reading(path, f'recording with a sound {name}'):
                values = np.frombuffer(lzfse.decompress(export.read(name)), kind)
                budget.take(values.nbytes, name)
                if values.size != width * height:
                    raise wrong(path, f'{name} has {values.size} values for {width} x {height} pixels')
                return values.reshape(height, width)

        frames = FrameFolder(folder, path)
        cameras = _cameras(path, metadata, numbers[-1] + 1 if numbers else 0)
        for number in numbers:
            depth = unpacked(f'rgbd/{number}.depth', '<f4')
            trust = unpacked(f'rgbd/{number}.conf', 'u1') if export.has(f'rgbd/{number}.conf') else None
            camera, camera_to_world = cameras[number]
            seen = export.read(f'rgbd/{number}.jpg') if export.has(f'rgbd/{number}.jpg') else None
            frames.add(camera.resized(width, height), by_phone(depth, trust), camera_to_world, seen)
        return folder, frames.finish(), None


def _export(path, folder, budget):
    with PackedFolder(path, 'metadata.json', budget) as export:
        metadata = export.json('metadata.json')
        numbers = _numbers(export.list('depth/', '.exr'))
        frames = FrameFolder(folder, path)
        cameras = _cameras(path, metadata, numbers[-1] + 1 if numbers else 0)
        for number in numbers:
            depth = _exr(path, f'depth/{number}.exr', export.read(f'depth/{number}.exr'), budget)
            camera, camera_to_world = cameras[number]
            pictures = [name for name in (f'rgb/{number}.jpg', f'rgb/{number}.png') if export.has(name)]
            frames.add(camera.resized(depth.shape[1], depth.shape[0]), by_phone(depth, None), camera_to_world,
                       export.read(pictures[0]) if pictures else None)
        return folder, frames.finish(), None


def convert(path, folder, options):
    budget = Budget(path, options)
    return _recording(path, folder, budget) if path.suffix.lower() == '.r3d' else _export(path, folder, budget)
