# SPDX-License-Identifier: MIT
"""parse(frames=...): depth frames of memory give what a folder of them gives."""
import pickle
import warnings

import numpy as np
import pytest

import topple
from others import raises
from made_scans import CAMERA, POSES, seen_from

INTRINSICS = topple.stages.Intrinsics(CAMERA.fx, CAMERA.fy, CAMERA.cx, CAMERA.cy)


@pytest.fixture(scope='module')
def depth(walk):
    return np.stack([np.round(1000 * metres).astype(np.uint16) for _, metres in walk])


def of_memory(depth, device, **options):
    given = {'camera_to_world': np.array(POSES), 'intrinsics': INTRINSICS, 'disturbances': [], **options}
    return topple.parse(frames=depth, device=device, **given)


def same(result, expected):
    for one, other in zip(result.xyz.T, expected.xyz.T):
        assert np.array_equal(one, other)
    assert np.array_equal(result.point_object, expected.point_object)
    assert [(o.mass_kg, o.barrier_J) for o in result.objects] == [(o.mass_kg, o.barrier_J) for o in expected.objects]


class OneByOne:
    """Frames that are made when they are asked for."""

    def __init__(self, frames):
        self.frames, self.asked = frames, []

    def __len__(self):
        return len(self.frames)

    def __getitem__(self, number):
        self.asked.append(number)
        return self.frames[number].copy()


def test_arrays_lists_and_what_comes_one_by_one(depth, sequence, device, tmp_path):
    result = of_memory(depth, device, name='head')
    same(result, sequence)
    assert result.source == 'head'
    result.write(tmp_path / 'out')
    metres = np.where(depth == 0, np.nan, depth / 1000)
    same(of_memory([frame for frame in metres.astype(np.float32)], device), sequence)
    same(of_memory(metres.transpose(0, 2, 1).copy().transpose(0, 2, 1), device), sequence)  # float64, of any strides
    lazy = OneByOne(depth)
    same(of_memory(lazy, device), sequence)
    assert set(lazy.asked) == set(range(len(depth)))


def test_colours(depth, device, tmp_path):
    colours = np.zeros((*depth.shape, 3), np.uint8)
    colours[:, :, :80] = [200, 30, 40]
    result = of_memory(depth, device, colours=[None] + list(colours[1:]))
    assert any('1 frame of 18 has no colours' in note for note in result.notes)
    result.write(tmp_path / 'out')
    head, _, body = (tmp_path / 'out' / 'points.ply').read_bytes().partition(b'end_header\n')
    kinds = {'float': '<f4', 'int': '<i4', 'uchar': 'u1', 'double': '<f8', 'uint': '<u4', 'ushort': '<u2'}
    fields = [line.split()[1:] for line in head.decode().splitlines() if line.startswith('property')]
    count = int(next(line for line in head.decode().splitlines() if line.startswith('element vertex')).split()[2])
    reds = np.frombuffer(body, [(name, kinds[kind]) for kind, name in fields], count)['red']
    assert {0, 200} <= set(np.unique(reds).tolist())


def test_labels_of_pixels(walk, depth, sequence, points, device, result):
    parsed = of_memory(depth, device)
    for n in (0, 7):
        labels = parsed.frame_labels(n)
        assert labels.shape == depth[n].shape and labels.dtype == np.int32 and np.array_equal(labels, sequence.frame_labels(n))
        assert np.array_equal(labels, parsed.frame_labels(depth[n], camera_to_world=POSES[n], intrinsics=INTRINSICS))
        parts = parsed.frame_labels(n, primitives=True)
        known = parts >= 0
        assert known.mean() > 0.9 and (np.array([p.object for p in parsed.primitives])[parts[known]] == labels[known]).all()
        # What is in the picture there: the room, the crate, the box on it.
        _, what = walk[n][0], seen_from(walk[n][0])[1]
        for number in range(3):
            found = labels[(what == number) & known]
            if len(found) > 50:
                assert parsed.objects[np.bincount(found).argmax()].grounded == (number == 0)
                assert np.bincount(found).max() > 0.9 * len(found)
    moved = depth[0].copy()
    moved[:20] //= 5
    moved[20:30] = 0
    others = parsed.frame_labels(moved, camera_to_world=POSES[0], intrinsics=INTRINSICS)
    assert (others[:30] == -1).all() and np.array_equal(others[30:], parsed.frame_labels(0)[30:])
    cloud = result.frame_labels(np.float32(depth[0] / 1000), camera_to_world=POSES[0], intrinsics=INTRINSICS)
    assert (cloud >= 0).mean() > 0.4  # its walls are lower
    assert np.array_equal(of_memory(OneByOne(depth), device).frame_labels(7), parsed.frame_labels(7))
    for call, words in ((lambda: parsed.frame_labels(18), 'there is no frame 18: they count from 0, and there are 18'),
                        (lambda: parsed.frame_labels(-1), 'there is no frame -1'), (lambda: sequence.frame_labels(18), 'there is no frame 18'),
                        (lambda: result.frame_labels(0), 'points were parsed'), (lambda: parsed.frame_labels(depth[0]), 'takes camera_to_world'),
                        (lambda: parsed.frame_labels('first'), 'frame'), (lambda: parsed.frame_labels(True), 'no frame True'),
                        (lambda: parsed.frame_labels(0, intrinsics=INTRINSICS), 'are for a depth image'),
                        (lambda: parsed.frame_labels(depth[:1], camera_to_world=POSES[0], intrinsics=INTRINSICS), 'of shape (1, 120, 160); give one of them'),
                        (lambda: parsed.frame_labels(depth[0], camera_to_world=POSES, intrinsics=INTRINSICS), 'expected shape (4, 4), not (18, 4, 4)'),
                        (lambda: parsed.frame_labels(depth[0], camera_to_world=POSES[0][:3], intrinsics=INTRINSICS), 'not (3, 4); add the row 0, 0, 0, 1'),
                        (lambda: parsed.frame_labels(depth[0], camera_to_world=POSES[0], intrinsics=np.eye(3)), 'of a matrix K give Intrinsics(K[0, 0]'),
                        (lambda: parsed.frame_labels(depth, camera_to_world=POSES[0], intrinsics=INTRINSICS), 'of shape (H, W)'),
                        (lambda: parsed.frame_labels(depth[0], camera_to_world=np.diag([1, 1, -1, 1.0]), intrinsics=INTRINSICS), 'camera_to_world')):
        with pytest.raises(topple.Error) as raised:
            call()
        assert words in str(raised.value), raised.value


def test_labels_of_pixels_after_a_pickle(depth, sequence, device, result, tmp_path, monkeypatch):
    of_folder = pickle.loads(pickle.dumps(sequence))
    monkeypatch.chdir(tmp_path)
    for n in (0, 7):
        assert np.array_equal(of_folder.frame_labels(n), sequence.frame_labels(n))
    given = {'camera_to_world': POSES[7], 'intrinsics': INTRINSICS}
    parsed = of_memory(depth, device)
    of_frames, of_points = pickle.loads(pickle.dumps(parsed)), pickle.loads(pickle.dumps(result))
    for back, whole in ((of_frames, parsed), (of_points, result), (pickle.loads(pickle.dumps(of_points)), result)):
        assert np.array_equal(back.frame_labels(depth[7], **given), whole.frame_labels(depth[7], **given))
    for back, words in ((of_frames, 'a pickle does not hold the frames that were parsed; give the depth image with its camera_to_world'),
                        (of_points, 'points were parsed, and no depth frames')):
        with raises('usage', words):
            back.frame_labels(0)


def test_poses_and_principal_points_that_mean_something_else_are_noted(depth, sequence, device):
    assert not any('convention' in note or 'principal point' in note for note in sequence.notes)
    flipped = np.array(POSES) @ np.diag([1, -1, -1, 1])
    with pytest.warns(RuntimeWarning, match='The poses seem to be in another convention'):
        coarse = INTRINSICS._replace(fx=INTRINSICS.fx / 2, fy=INTRINSICS.fy / 2, cx=INTRINSICS.cx / 2, cy=INTRINSICS.cy / 2)
        notes = of_memory(depth[:, ::2, ::2], device, camera_to_world=flipped, intrinsics=coarse, voxel_m=0.05).notes
    assert notes[0].startswith('The poses seem to be in another convention') and 'columns negated (pose @ np.diag([1, -1, -1, 1])).' in notes[0]
    with warnings.catch_warnings(), pytest.raises(RuntimeWarning):  # at once, and the parse ends
        warnings.simplefilter('error')
        of_memory(depth, device, camera_to_world=flipped)
    notes = of_memory(depth[:1], device, camera_to_world=None, intrinsics=INTRINSICS._replace(cx=0)).notes
    assert any('The principal point (0, 59.5)' in note for note in notes)


def test_an_up_that_the_scan_contradicts_is_told_at_once(depth, sequence, device):
    up = np.array(sequence.up)
    with warnings.catch_warnings():
        warnings.simplefilter('error')
        given = of_memory(depth, device, up=9.81 * up + [0.5, 0.5, 0])
        assert given.up_method == 'given' and not any('The up that was given' in note for note in given.notes)
        with pytest.raises(RuntimeWarning, match='is 180 degrees from what the surfaces and cameras show'):
            of_memory(depth, device, up=-9.81 * up)


def refused(kind, *parts, **options):
    with pytest.raises(topple.Error) as error:
        topple.parse(**options)
    assert error.value.kind == kind, error.value
    for part in parts:
        assert part in str(error.value), error.value


def test_what_makes_no_sense(depth, points, device):
    given = {'frames': depth, 'camera_to_world': np.array(POSES), 'intrinsics': INTRINSICS, 'device': device}
    refused('usage', 'expected one of a source', source=points, frames=depth)
    refused('usage', 'expected one of a source')
    refused('usage', 'are for frames in memory', source=points, intrinsics=INTRINSICS)
    refused('usage', 'intrinsics', **(given | {'intrinsics': None}))
    refused('usage', 'fx, fy, cx, cy', **(given | {'intrinsics': 130.0}))
    refused('input', 'intrinsics', '"fx" is 0', **(given | {'intrinsics': INTRINSICS._replace(fx=0)}))
    refused('usage', "frames[0]: expected uint16", 'int64', "astype('uint16')", **(given | {'frames': depth.astype(int)}))
    refused('usage', '(18, 4, 4)', '(17, 4, 4)', **(given | {'camera_to_world': np.array(POSES[1:])}))
    refused('usage', 'camera_to_world', **(given | {'camera_to_world': None}))
    poses = np.array(POSES)
    poses[3, 0, 3] = np.nan
    refused('input', 'pose of frame 3', **(given | {'camera_to_world': poses}))
    refused('input', 'frames: there are none', **(given | {'frames': depth[:0], 'camera_to_world': np.empty((0, 4, 4))}))
    refused('usage', 'colours', '17 images for 18', **(given | {'colours': list(np.zeros((17, 2, 2, 3), np.uint8))}))
    refused('usage', 'colours[0]', '(H, W, 3)', **(given | {'colours': np.zeros((18, 12, 16), np.uint8)}))
    refused('input', 'frame 0: colour is 12 x 16', **(given | {'colours': np.zeros((18, 16, 12, 3), np.uint8)}))
    refused('usage', 'unit_m', **(given | {'unit_m': 0.001}))
    refused('usage', 'tile_m (--tile) 5: only clouds in files', **(given | {'tile_m': 5}))
    refused('usage', 'cache_file', **(given | {'cache_file': 'cache'}))
    refused('usage', 'viewpoint', **(given | {'viewpoint': [0, 0, 0]}))
    refused('input', 'max_memory_bytes', **(given | {'max_memory_bytes': 1 << 20}))
    refused('input', 'lie beyond 65.535 m', **(given | {'frames': depth.astype(np.float32)}))
    refused('cancelled', 'cancelled', **(given | {'cancelled': lambda: True}))

    class Broken(OneByOne):
        def __getitem__(self, number):
            if number == 7:
                raise LookupError('frame 7 is lost')
            return super().__getitem__(number)
    with pytest.raises(LookupError, match='frame 7 is lost'):
        topple.parse(**(given | {'frames': Broken(depth)}))
