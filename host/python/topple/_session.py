# SPDX-License-Identifier: MIT
"""A scan that is still being made."""
import operator
import os
import weakref
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from . import _topple
from ._arrays import channels, columns, usage
from ._device import open_device
from ._frames import colour_image, depth_image, poses as _poses
from ._options import named, option, options
from .stages import camera


class Thing(NamedTuple):
    """What is the same from update to update of a Session: id (0: the building), object (its number in LiveScene.result, -1: it is lost or gone),
    change since the update before, and moved_m, metres."""
    id: int  # the same as long as it is the same thing; 0: the building
    object: int  # id in LiveScene.result; -1: it is lost or gone
    change: str  # since the update before: "none", "found" (not seen or told apart before), "came", "moved", "changed" (what it stands on, its category), "lost" (not told apart any more), "gone"
    moved_m: float  # how far, where it moved


class Appeared(NamedTuple):
    """What Session.glance() finds: a thing that came, as far as it was seen, and down to what carries it. middle_m, size_m: of its box, upright and
    along the room's axes, metres. mass_kg and its standard error. stands_on: numbers of objects of scene.result, of which scene.things[number].id
    is the thing. barrier_J, its standard error, release_J, mode, risk_J and fall_chance, by disturbance, as those of an Object. unsafety_category: as
    an Object's, but at the worse end of errors."""
    middle_m: "NDArray[np.float64]"  # (3,)
    size_m: "NDArray[np.float64]"  # (3,)
    mass_kg: float
    mass_error_kg: float
    stands_on: "list[int]"  # objects of scene.result
    barrier_J: float
    barrier_error_J: float
    release_J: float
    mode: str  # "tip", "slide", "none"
    risk_J: "dict[str, float]"  # by disturbance
    fall_chance: "dict[str, float]"
    unsafety_category: str  # at the worse end of errors; "": no disturbance was asked for


class LiveScene(NamedTuple):
    """What an update of a Session has found: its result; things, by the result's objects, then those that are lost or gone; the frames that it was
    parsed from; number of the parse; current, whether these, and their poses, were all that there was."""
    result: "Result"
    things: "list[Thing]"  # by objects of the result, then what is lost or gone
    frames: "list[int]"  # that it was parsed from
    number: int  # of the parse that found it: 1, 2, ...
    current: bool  # whether these, and their poses, were all that there was when an update gave it


class Session:
    """A scan that grows: depth frames, or sweeps of points, come one by one, a SLAM system corrects their poses, and update() says what is
    there, and what came, moved and has gone since.

    intrinsics: a topple.stages.Intrinsics of all frames, or a dict as intrinsics.json has it; None: of points, as LiDARs give them. forget_gone: whether readings are left out at
    places that most of the latest looks see through. max_frame_bytes: that kept frames take, compressed (640 x 480 pixels about 0.3 MB); where
    that is not enough those go whose camera has a neighbour in time next to it. The other options are those of parse(). One thread may add
    frames while another updates. Raises Error as parse() does."""

    @named
    def __init__(self, intrinsics=None, *, device=None, voxel_m=0.0, up=None, disturbances=None, seed=1, density_kg_m3=700.0, friction=0.3,
                 tolerable_J=0.1, wind_m_s=12.0, forget_gone=True, max_frame_bytes=2_000_000_000):
        self._camera = None if intrinsics is None else camera(intrinsics, 'intrinsics')
        sized = isinstance(intrinsics, Mapping) and {'width', 'height'} <= intrinsics.keys()
        self._size = (intrinsics['width'], intrinsics['height']) if sized else None
        self._options = options(disturbances, {'voxel_m': voxel_m, 'up': up, 'seed': seed, 'density_kg_m3': density_kg_m3, 'friction': friction,
                                               'tolerable_J': tolerable_J, 'wind_m_s': wind_m_s})
        device = option('device', device)
        self._device = open_device(device) if isinstance(device, str) else device
        self._forget_gone = option('forget_gone', forget_gone)
        self._max_frame_bytes = option('max_frame_bytes', max_frame_bytes)
        self._session = None  # once the frames' size is known
        self._of_points = intrinsics is None

    @classmethod
    def resume(cls, path, **options):
        """Goes on from what checkpoint() wrote: its frames, their poses, and the things of its last update, whose ids stay. options: those of
        Session, but for its intrinsics, which the file has. scene is None until update()."""
        if 'intrinsics' in options:
            raise TypeError('resume() takes no intrinsics: those of the checkpoint count')
        session = cls(**options)
        session._begin(os.fspath(path))
        session._of_points = session._session.is_of_points()
        return session

    def checkpoint(self, path):
        """Writes the frames, their poses, and the things of the last update to a file, which is there whole or not at all."""
        self._begun().checkpoint(os.fspath(path))

    def add(self, depth, camera_to_world, colour=None):
        """Copies a frame in, and returns its number, from 0. depth: (H, W) uint16, metres times depth_scale, 0: no reading; or floats, metres.
        camera_to_world: (4, 4), metres, camera x right, y down, z forward. colour: (H, W, 3) uint8 sRGB, or None. A frame without
        readings, or that of before once more, is an Error of kind "input".

        In a session of points, these come in place of depth: as parse() takes them, in the sensor's axes, z up, colours as many; and
        camera_to_world is the sensor's."""
        if self._of_points:
            if getattr(depth, 'dtype', None) == np.uint16:
                raise usage('depth: a session of depth frames needs intrinsics, which topple.Session() has none of')
            points = columns(depth, 'xyz', 'points')
            colours = [] if colour is None else channels(colour)
            if self._session is None:
                self._begin()
            return self._session.add_points(points, colours, self._pose(camera_to_world))
        depth = depth_image(depth, 'depth')
        frame = depth, None if colour is None else colour_image(colour, 'colour')
        pose = self._pose(camera_to_world)
        if self._session is None:
            size = depth.shape[::-1]
            if self._size not in (None, size):
                raise usage('depth: {} x {} pixels, the intrinsics say {} x {}'.format(*size, *self._size))
            self._begin(size, self._camera)
        return self._session.add(frame, pose)

    def correct(self, camera_to_world):
        """After a loop closure: a dict of the poses, (4, 4), that are others now, by frame."""
        if not isinstance(camera_to_world, Mapping):
            raise usage('correct: expected a dict of poses by the numbers of their frames')
        frames = [self._number(frame) for frame in camera_to_world]
        if frames:
            poses = [self._pose(pose, frame) for frame, pose in zip(frames, camera_to_world.values())]
            self._begun().correct(frames, np.concatenate(poses))

    def forget(self, frame):
        """Leaves a frame out, by its number: what only it shows is lost at the next update(). Numbers of others stay."""
        self._begun().forget(self._number(frame))

    @property
    def frames(self):
        """Numbers of the frames that are kept."""
        return self._session.frames() if self._session else []

    @property
    def frame_bytes(self):
        """That kept frames take."""
        return self._session.frame_bytes() if self._session else 0

    def update(self, budget_ms=None):
        """Parses the frames that are there now: a LiveScene, whose result is that of parse() of the same frames and poses, but for what has
        gone, whatever was added, corrected or forgotten before. Ctrl-C stops it, and the scene before stays. budget_ms: how long to wait
        for it; a parse that takes longer goes on behind, a later update has its scene, and until then it is the one before without
        changes, or None."""
        if budget_ms is not None:
            try:
                budget_ms = int(min(float(budget_ms), 1e9))
                if budget_ms < 0:
                    raise ValueError
            except (TypeError, ValueError, OverflowError):
                raise usage(f'budget_ms: expected milliseconds, 0 or more, not {budget_ms!r}') from None
        return self._described(self._begun().update(budget_ms))

    def glance(self):
        """What the latest frames since the last update() show that was not there then: a list of Appeared, the largest first; in some tenths
        of a second, also while another thread is in update(). Empty before the first."""
        return [Appeared(np.array(middle), np.array(size), *more) for middle, size, *more in self._session.glance()] if self._session else []

    def settle(self):
        """The Result of parse() of all frames and poses that are there, bit for bit, also of what has gone, which takes a parse of its own;
        an update() comes first."""
        from . import Result
        return Result(self._begun().settle(), None)

    def write(self, folder):
        """Writes what `topple live` does of the scene of the last update: outputs with a report, and things.json."""
        self._begun().write(os.fspath(folder))

    def cancel(self):
        """From any thread: ends the update that is at work, or goes on behind, as cancelled. The scene before stays."""
        self._begun().cancel()

    @property
    def scene(self):
        """The LiveScene of the last update; None before the first."""
        return self._described(self._session.scene()) if self._session else None

    def label(self, depth, camera_to_world):
        """The id of the Thing that each pixel of a depth image shows, (H, W) int64, or each point, (N,), in a session of points; -1: nothing
        that is known."""
        if self._of_points:
            return self._begun().label_points(columns(depth, 'xyz', 'points'), self._pose(camera_to_world))
        height, width, ids = self._begun().label((depth_image(depth, 'depth'), None), self._pose(camera_to_world))
        return ids.reshape(height, width)

    def _begin(self, *of):
        self._session = _topple.Session(*of, self._device, self._options, self._forget_gone, self._max_frame_bytes)
        weakref.finalize(self, self._session.cancel)  # nothing goes on behind when the interpreter ends

    @staticmethod
    def _pose(camera_to_world, number=None):
        pose = _poses(camera_to_world, 1, number)
        if not len(pose):
            raise usage('camera_to_world: expected an array of shape (4, 4)')
        return pose

    @staticmethod
    def _number(frame):
        try:
            number = operator.index(frame)
        except TypeError:
            number = None
        if number is None or isinstance(frame, bool):
            raise usage(f'session: expected the number of one frame, as add() returns it, not {frame!r}')
        if number < 0:
            raise usage(f'session: there is no frame {number}')
        return number

    def _begun(self):
        if self._session is None:
            raise usage('session: there are no frames yet; add some first')
        return self._session

    @staticmethod
    def _described(found):
        from . import Result
        if found is None:
            return None
        parsed, things, *more = found
        return LiveScene(Result(parsed, None), [Thing(*thing) for thing in things], *more)
