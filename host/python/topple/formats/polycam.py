# SPDX-License-Identifier: MIT
"""Polycam's raw data of phones with LiDAR, as a zip archive or a folder: keyframes with depth and poses.

Poses are Polycam's corrected ones where there are any. Depth beyond 5 m, and what the phone itself trusts least, is left out."""
import numpy as np

from . import images as pictures
from .errors import reading, wrong
from .frames import Camera, FrameFolder, by_phone, from_graphics
from .limits import Budget
from .packed_folder import PackedFolder, holds

FORMAT = 'Polycam export'
DEPTH, CONFIDENCE = 'keyframes/depth/', 'keyframes/confidence/'


def recognises(path):
    return holds(path, DEPTH, '.zip')


def _image(path, export, name):
    return pictures.grey(export.read(name), path, name, export.budget)


def _camera(path, export, name):
    values = export.json(name)
    with reading(path, f'export with a sound {name}'):
        pose = np.eye(4)
        pose[:3] = [[float(values[f't_{row}{column}']) for column in range(4)] for row in range(3)]
        camera = Camera(int(values['width']), int(values['height']), *(float(values[k]) for k in ('fx', 'fy', 'cx', 'cy')))
        return camera, from_graphics(pose)


def convert(path, folder, options):
    notes, depthless = [], 0
    with PackedFolder(path, DEPTH, Budget(path, options)) as export:
        corrected = export.list('keyframes/corrected_cameras/', '.json')
        cameras = 'keyframes/corrected_cameras/' if corrected else 'keyframes/cameras/'
        images = 'keyframes/corrected_images/' if corrected else 'keyframes/images/'
        frames = FrameFolder(folder, path)
        for name in export.list(cameras, '.json'):
            if not export.has(f'{DEPTH}{name}.png'):
                depthless += 1
                continue
            camera, pose = _camera(path, export, f'{cameras}{name}.json')
            depth = _image(path, export, f'{DEPTH}{name}.png') / 1000.0
            trust = _image(path, export, f'{CONFIDENCE}{name}.png') if export.has(f'{CONFIDENCE}{name}.png') else None
            if trust is not None and trust.shape != depth.shape:
                raise wrong(path, f'{CONFIDENCE}{name}.png is of another size than the depth image')
            seen = export.read(f'{images}{name}.jpg') if export.has(f'{images}{name}.jpg') else None
            # Each keyframe has intrinsics of its own, by the lens' focus; depth is smaller than colour.
            frames.add(camera.resized(depth.shape[1], depth.shape[0]), by_phone(depth, trust), pose, seen)
        if depthless:
            notes.append(f'{depthless} of the keyframes have no depth image.')
        if not corrected:
            notes.append("The export has no corrected cameras, so the phone's own poses were taken, which drift.")
        return folder, frames.finish(notes), None
