# SPDX-License-Identifier: MIT
"""Depth frames that are given as arrays, as the library takes them: where they lie, if they are that already."""
import numpy as np

from . import _topple
from ._arrays import as_array, error, exactly, is_masked, usage
from .stages import camera


def depth_image(source, name):
    """(height, width) uint16 or float32, its rows without gaps."""
    if is_masked(source) and source.dtype.kind == 'u':
        source = source.filled(0)
    values = as_array(source, name)
    if values.ndim != 2 or (values.dtype.kind != 'f' and values.dtype != np.uint16):
        mend = f"; {name}.astype('uint16') converts them" if values.ndim == 2 and values.dtype.kind in 'iu' else \
            '; give one of them' if values.ndim == 3 else ''
        raise usage(f'{name}: expected uint16, metres times depth_scale, or floats, metres, of shape (H, W), not {values.dtype} of shape '
                    f'{values.shape}{mend}')
    return _without_gaps(values, np.uint16 if values.dtype.kind == 'u' else np.float32)


def colour_image(source, name):
    """(height, width, 3) uint8, its rows without gaps."""
    values = as_array(source, name)
    if values.ndim != 3 or values.shape[2] != 3 or values.dtype != np.uint8:
        raise usage(f'{name}: expected uint8, sRGB, of shape (H, W, 3), not {values.dtype} of shape {values.shape}')
    return _without_gaps(values, np.uint8)


def _without_gaps(values, dtype):
    values = values.astype(dtype, copy=False)
    inner = values[0] if len(values) else values
    return values if inner.flags.c_contiguous else np.ascontiguousarray(values)


def poses(given, count, number=None):
    """16 numbers for each frame, in a row; none for a single frame without a pose. number: of a single one, for messages."""
    if given is None:
        if count != 1:
            raise usage(f'camera_to_world: {count} frames take a pose each, an array of shape ({count}, 4, 4)')
        return np.empty(0)
    found = as_array(given, 'camera_to_world')
    if found.shape == (4, 4):
        found = found[None]
    if found.shape != (count, 4, 4):
        expected = f'({count}, 4, 4), a pose for each of the frames' if count != 1 else '(4, 4)'
        mend = '; add the row 0, 0, 0, 1' if found.shape in ((3, 4), (count, 3, 4)) else ''
        raise usage(f'camera_to_world: expected shape {expected}, not {found.shape}{mend}')
    if not np.issubdtype(found.dtype, np.number) or found.dtype.kind == 'c':
        raise usage(f'camera_to_world: expected floats, not {found.dtype}')
    if not np.isfinite(found).all():
        frame = int(np.argwhere(~np.isfinite(found))[0][0]) if count != 1 else number
        of = '' if frame is None else f' of frame {frame}'
        raise error('input', f'frames: the pose{of} is not finite; leave the frame out')
    return exactly(found.astype(float).ravel(), 'camera_to_world', (None,), float)


class Frames:
    """What parse(frames=...) takes, checked as far as that goes without looking at pixels."""

    def __init__(self, frames, camera_to_world, intrinsics, colours, colour_intrinsics):
        if intrinsics is None:
            raise usage('intrinsics: depth frames take a topple.stages.Intrinsics(fx, fy, cx, cy, depth_scale)')
        self._camera = camera(intrinsics, 'intrinsics')
        self._colour_camera = None if colour_intrinsics is None else camera(colour_intrinsics, 'colour_intrinsics')
        self._frames, self._colours = _images(frames, 'frames', ()), None if colours is None else _images(colours, 'colours', (3,))
        try:
            self._count = len(self._frames)
        except TypeError:
            raise usage(f'frames: expected an array of shape (F, H, W), a list of arrays, or what has a length and gives one for each '
                        f'number, not {frames!r}'[:300]) from None
        if self._count == 0:
            raise error('input', 'frames: there are none')
        if self._colours is not None and len(self._colours) != self._count:
            raise usage(f'colours: there are {len(self._colours)} images for {self._count} frames; give one for each, None where there '
                        'is none')
        self._poses = poses(camera_to_world, self._count)

    def _load(self, number):
        depth = depth_image(self._frames[number], f'frames[{number}]')
        seen = None if self._colours is None else self._colours[number]
        return depth, None if seen is None else colour_image(seen, f'colours[{number}]')

    def __len__(self):
        return self._count

    def labels(self, labeller, number):
        """What the labeller says of one of them."""
        depth, _ = self._load(number)
        return labelled(labeller, depth, self._poses[16 * number:16 * number + 16], self._camera, f'frames[{number}]')

    def parse(self, name, device, options, progress, cancelled):
        """The library's result. What is no array or list is asked for its frames one by one, and again where they are needed again."""
        here = all(isinstance(images, (np.ndarray, list, tuple, type(None))) for images in (self._frames, self._colours))
        images = [self._load(number) for number in range(self._count if here else 1)]
        height, width = images[0][0].shape
        return _topple.parse_frames(images if here else [], None if here else self._load, (width, height), self._poses, self._camera,
                                    self._colour_camera, name, device, options, progress, cancelled)


def labelled(labeller, depth, pose, camera, name):
    height, width = depth.shape
    return labeller.of_array((depth, None), (width, height), pose, camera, name)


def one_frame(frame, camera_to_world, intrinsics):
    """A depth image of its own as labelled() takes it: depth, pose and camera."""
    if intrinsics is None or camera_to_world is None:
        raise usage('frame_labels: a depth image takes camera_to_world, a (4, 4) array, and a topple.stages.Intrinsics')
    return depth_image(frame, 'frame'), poses(camera_to_world, 1), camera(intrinsics, 'intrinsics')


def _images(given, name, pixel):
    """A sequence of images; of a single one that stands alone, too. pixel: the shape of one."""
    if hasattr(given, '__dlpack__') and not isinstance(given, np.ndarray):
        given = as_array(given, name)
    alone = isinstance(given, np.ndarray) and given.ndim == 2 + len(pixel) and given.shape[2:] == pixel
    return given[None] if alone else given
