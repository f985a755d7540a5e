# SPDX-License-Identifier: MIT
"""What pixels of depth frames show of a result."""
import operator
import os

from . import _frames
from ._arrays import usage


def _number(frame, count):
    if isinstance(frame, bool) or not 0 <= operator.index(frame) < count:
        raise usage(f'frame_labels: there is no frame {frame!r}: they count from 0, and there are {count}')
    return operator.index(frame)


def of_frame(labeller, frames, frame, camera_to_world, intrinsics, primitives):
    """frames: where those that were parsed are: a path, Frames, or None. frame: the number of one, or a depth image."""
    if not hasattr(frame, '__index__') or getattr(frame, 'ndim', 0) > 0:
        found = _frames.labelled(labeller, *_frames.one_frame(frame, camera_to_world, intrinsics), 'frame')
    elif camera_to_world is not None or intrinsics is not None:
        raise usage('frame_labels: camera_to_world and intrinsics are for a depth image; frames that were parsed have their own')
    elif isinstance(frames, str):
        if not os.path.isdir(frames):
            raise usage(f'frame_labels: {frames} holds no depth frames; give a depth image with its camera_to_world and intrinsics')
        if isinstance(frame, bool) or operator.index(frame) < 0:
            raise usage(f'frame_labels: there is no frame {frame!r}: they count from 0')
        found = labeller.of_file(frames, operator.index(frame))
    elif frames is not None:
        found = frames.labels(labeller, _number(frame, len(frames)))
    else:
        raise usage('frame_labels: points were parsed, and no depth frames; give a depth image with its camera_to_world and intrinsics')
    height, width, parts, objects = found
    return (parts if primitives else objects).reshape(height, width)
