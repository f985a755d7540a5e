# SPDX-License-Identifier: MIT
"""What pixels of depth frames show of a result."""
import operator
import os

import numpy as np

from . import _frames, _snapshot, _topple
from ._arrays import usage

NOT_KEPT = False  # in the place of frames that a pickle does not hold


def labeller(result):
    """What labels frames by a result's points, also by those that a pickle holds."""
    parsed = result._parsed
    if not isinstance(parsed, _snapshot.Item):
        return _topple.Labeller(parsed, list(result._points or []))
    if getattr(parsed, 'in_blocks', False):
        raise usage('frame_labels: the cloud was parsed in blocks, of which a result holds a sample of the points alone; parse frames, or a '
                    'smaller cloud')
    return _topple.Labeller([np.ascontiguousarray(c, np.float32) for c in result._axes()],
                            *(np.ascontiguousarray(ids, np.int32) for ids in (parsed.point_primitive, parsed.point_object)), parsed.voxel_size_m)


def kept(frames, source):
    """What a pickle holds of where frames are: the path of a folder of the caller's, who can give it again."""
    if frames is None or isinstance(frames, str) and frames == source:
        return frames and os.path.abspath(frames)
    return NOT_KEPT


def numbered(frame):
    """Whether it is the number of a frame, and no image."""
    return hasattr(frame, '__index__') and getattr(frame, 'ndim', 0) == 0


def _number(frame, count):
    if isinstance(frame, bool) or not 0 <= operator.index(frame) < count:
        raise usage(f'frame_labels: there is no frame {frame!r}: they count from 0, and there are {count}')
    return operator.index(frame)


def of_image(result, frame, primitives):
    """Of an organised cloud, which is one depth image: what its pixels' points are of."""
    _number(frame, 1)
    height, width = result.image_shape
    index, ids = result.point_index, result.point_primitive if primitives else result.point_object
    labels = np.full(height * width, -1, np.int32)
    labels[index if len(index) else slice(None)] = ids
    return labels.reshape(height, width)


def of_frame(labeller, frames, frame, camera_to_world, intrinsics, primitives):
    """frames: where those that were parsed are: a path, Frames, or None. frame: the number of one, or a depth image."""
    if not numbered(frame):
        found = _frames.labelled(labeller, *_frames.one_frame(frame, camera_to_world, intrinsics), 'frame')
    elif camera_to_world is not None or intrinsics is not None:
        raise usage('frame_labels: camera_to_world and intrinsics are for a depth image; frames that were parsed have their own')
    elif isinstance(frames, str):
        if not os.path.isdir(frames):
            raise usage(f'frame_labels: {frames} is no folder of depth frames and no organised .pcd; give a depth image with its camera_to_world and intrinsics')
        if isinstance(frame, bool) or operator.index(frame) < 0:
            raise usage(f'frame_labels: there is no frame {frame!r}: they count from 0')
        found = labeller.of_file(frames, operator.index(frame))
    elif frames is NOT_KEPT:
        raise usage('frame_labels: a pickle does not hold the frames that were parsed; give the depth image with its camera_to_world and '
                    'intrinsics')
    elif frames is not None:
        found = frames.labels(labeller, _number(frame, len(frames)))
    else:
        raise usage('frame_labels: points were parsed, and no depth frames; give a depth image with its camera_to_world and intrinsics')
    height, width, parts, objects = found
    return (parts if primitives else objects).reshape(height, width)
