# SPDX-License-Identifier: MIT
"""Sessions: frames come one by one, poses are corrected, things keep their ids."""
import subprocess
import sys

import numpy as np
import pytest

import topple
from made_scans import CAMERA, POSES

INTRINSICS = topple.stages.Intrinsics(CAMERA.fx, CAMERA.fy, CAMERA.cx, CAMERA.cy)


@pytest.fixture(scope='module')
def depth_frames(walk):
    return np.stack([np.round(1000 * metres).astype(np.uint16) for _, metres in walk])


def shifted(pose, metres):
    pose = pose.copy()
    pose[0, 3] += metres
    return pose


def session(device, **options):
    return topple.Session(INTRINSICS, device=device, disturbances=[], **options)


def test_an_update_is_a_parse_of_the_frames_that_are_there(device, depth_frames):
    live = session(device)
    assert live.scene is None and live.frames == [] and live.frame_bytes == 0
    for n, depth in enumerate(depth_frames):
        assert live.add(depth, shifted(POSES[n], 0.2 if n % 3 else 0)) == n
    assert live.update().frames == list(range(len(depth_frames)))
    live.correct({n: POSES[n] for n in range(len(depth_frames))})
    found = live.update()
    parsed = topple.parse(frames=depth_frames, camera_to_world=np.array(POSES), intrinsics=INTRINSICS, device=device, disturbances=[])
    assert np.array_equal(found.result.point_object, parsed.point_object)
    assert [o.mass_kg for o in found.result.objects] == [o.mass_kg for o in parsed.objects]
    assert [thing.object for thing in found.things[:len(parsed.objects)]] == [o.id for o in parsed.objects]
    # Nothing new.
    again = live.update()
    assert [(t.id, t.change) for t in again.things] == [(t.id, 'none') for t in found.things if t.object >= 0]
    labels = live.label(depth_frames[0], POSES[0])
    assert labels.shape == depth_frames[0].shape and labels.dtype == np.int64
    objects = found.result.frame_labels(depth_frames[0], camera_to_world=POSES[0], intrinsics=INTRINSICS)
    ids = np.array([t.id for t in found.things] + [-1])
    assert np.array_equal(labels, ids[objects])
    live.forget(0)
    assert live.frames[0] == 1


@pytest.fixture(scope='module')
def sweeps(walk):
    """The frames as a sensor with z upwards and x ahead gives points, and its poses."""
    axes = np.array([[0, -1, 0, 0], [0, 0, -1, 0], [1, 0, 0, 0], [0, 0, 0, 1]], float)  # of the sensor, in the camera's
    u, v = np.meshgrid(np.arange(CAMERA.width), np.arange(CAMERA.height))
    out = []
    for pose, metres in walk:
        seen = np.stack([metres * (u - CAMERA.cx) / CAMERA.fx, metres * (v - CAMERA.cy) / CAMERA.fy, metres], axis=-1).reshape(-1, 3)
        out.append(((seen @ axes[:3, :3]).astype(np.float32), pose @ axes))
    return out


def test_points_come_in_place_of_frames(device, sweeps, tmp_path):
    live = topple.Session(device=device, disturbances=[])
    assert live.frames == []
    for n, (points, pose) in enumerate(sweeps):
        assert live.add(points, shifted(pose, 0.3 if n == 3 else 0)) == n
    live.correct({3: sweeps[3][1]})
    found = live.update()
    world = [(points.astype(float) @ pose[:3, :3].T + pose[:3, 3]) for points, pose in sweeps]
    parsed = topple.parse(np.concatenate(world).astype(np.float32), device=device, disturbances=[],
                          viewpoint=np.concatenate([np.tile(pose[:3, 3].astype(np.float32), (len(points), 1)) for points, pose in sweeps]))
    assert len(found.result.objects) == len(parsed.objects) > 2
    assert found.result.voxel_size_m == parsed.voxel_size_m
    labels = live.label(*sweeps[0])
    assert labels.shape == (len(sweeps[0][0]),) and labels.dtype == np.int64 and (labels >= 0).mean() > 0.9
    ids = np.array([t.id for t in found.things])
    assert (labels == ids[found.result.point_object[:len(labels)]]).mean() > 0.98
    assert live.glance() == []
    rows = np.linspace(0, 0.35, 60, dtype=np.float32)
    u, v = np.meshgrid(rows, rows)
    crate = np.concatenate([np.stack([0.2 + u, 0.3 + v, 0.35 + 0 * u], -1), np.stack([0.2 + u, 0.3 + 0 * v, v], -1)]).reshape(-1, 3)
    for points, pose in sweeps[::6]:  # beside all else that is seen from there
        live.add(np.concatenate([points, ((crate - pose[:3, 3]) @ pose[:3, :3]).astype(np.float32)]), pose)
    came, = live.glance()
    assert isinstance(came, topple.Appeared) and np.allclose(came.middle_m, (0.375, 0.475, 0.175), atol=0.04) and came.barrier_J > came.barrier_error_J > 0
    assert came.unsafety_category == '' and found.result.objects[came.stands_on[0]].grounded
    assert live.scene.things[came.stands_on[0]].id == 0 and came.fall_chance == {}
    live.write(tmp_path / 'out')
    assert {'report.html', 'things.json', 'scene.json'} <= {path.name for path in (tmp_path / 'out').iterdir()}
    with pytest.raises(topple.Error, match='a dict of poses'):
        live.correct([np.eye(4)])
    live.forget(live.add(sweeps[1][0], sweeps[0][1]))
    live.forget(live.add(sweeps[1][0], sweeps[0][1]))  # it may come once more
    live.checkpoint(tmp_path / 'points')
    again = topple.Session.resume(tmp_path / 'points', device=device, disturbances=[])
    coloured = np.full(sweeps[0][0].shape, 90, np.uint8)
    assert again.add(tuple(sweeps[0][0].T + 0.001), sweeps[0][1], coloured) == len(sweeps) + 5
    for call, words in ((lambda: live.add(np.zeros((4, 4), np.uint16), np.eye(4)), 'needs intrinsics'), (lambda: live.add(np.zeros((4, 4), np.float32), np.eye(4)), r'\(N, 3\)'),
                        (lambda: live.add(sweeps[0][0], None), r'shape \(4, 4\)'), (lambda: live.add(np.full((2, 3), np.nan, np.float32), np.eye(4)), 'finite'),
                        (lambda: live.add(sweeps[0][0][:0], np.eye(4)), 'no points')):
        with pytest.raises(topple.Error, match=words):
            call()


def test_an_update_keeps_its_budget_and_settles_as_a_parse(device, depth_frames):
    height, width = depth_frames[0].shape
    file = {'width': width, 'height': height, 'fx': CAMERA.fx, 'fy': CAMERA.fy, 'cx': CAMERA.cx, 'cy': CAMERA.cy, 'depth_scale': 1000}
    live = topple.Session(intrinsics=file, device=device, disturbances=[])
    with pytest.raises(topple.Error, match='the intrinsics say'):
        live.add(depth_frames[0][:50], POSES[0])
    for depth, pose in zip(depth_frames, POSES):
        live.add(depth, pose)
    assert live.update(0) is None
    with pytest.raises(topple.Error, match='budget_ms'):
        live.update('soon')
    settled = live.settle()
    parsed = topple.parse(frames=depth_frames, camera_to_world=np.array(POSES), intrinsics=file, device=device, disturbances=[])
    assert np.array_equal(settled.point_object, parsed.point_object)
    found = live.update(1000)
    assert found.frames == live.frames and {t.change for t in found.things} == {'found'}
    live.forget(0)
    assert live.update(0).frames == found.frames
    live.cancel()
    assert live.scene.frames == found.frames


def test_a_session_at_work_ends_with_the_interpreter(depth_frames):
    code = f"""
import numpy, topple
live = topple.Session(topple.stages.Intrinsics{tuple(INTRINSICS)}, device='native')
for n in range(6):
    live.add(numpy.full((120, 160), 2000 + 10 * n, numpy.uint16), numpy.eye(4))
live.update(0)
print('ended')
"""
    done = subprocess.run([sys.executable, '-c', code], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0 and done.stdout == 'ended\n', done.stderr


def test_what_is_no_frame_is_refused(device, depth_frames):
    live = session(device)
    for call, kind, words in ((live.update, 'usage', 'no frames yet'), (lambda: live.forget(3), 'usage', 'no frames yet'),
                              (lambda: live.add(depth_frames[0], None), 'usage', 'camera_to_world'),
                              (lambda: live.add(np.zeros_like(depth_frames[0]), POSES[0]), 'input', 'no readings')):
        with pytest.raises(topple.Error, match=words) as raised:
            call()
        assert raised.value.kind == kind
    live.add(depth_frames[0], POSES[0])
    for call, words in ((lambda: live.add(depth_frames[0], POSES[0]), 'once more'), (lambda: live.add(depth_frames[1][:50], POSES[1]), 'pixels'),
                        (lambda: live.forget(7), 'no frame 7'), (lambda: live.forget('x'), "expected the number of one frame, as add.. returns it, not 'x'"),
                        (lambda: live.forget([0]), r"not \[0\]"), (lambda: live.forget(-1), 'no frame -1'), (lambda: live.correct({0: None}), r'shape \(4, 4\)'),
                        (lambda: live.correct({0: POSES[0] * np.nan}), 'the pose of frame 0 is not'), (lambda: live.add(depth_frames[1], POSES[1] * np.nan), 'the pose is not'),
                        (lambda: live.correct({7: POSES[0]}), 'no frame 7'), (lambda: live.add(depth_frames[1].astype(int), POSES[1]), 'uint16')):
        with pytest.raises(topple.Error, match=words):
            call()
    assert live.frames == [0]
    with pytest.raises(topple.Error, match='humans'):
        topple.Session(disturbances=['humans']).add(np.ones((9, 3), np.float32), POSES[0])
    with pytest.raises(topple.Error, match='max_frame_bytes'):
        session(device, max_frame_bytes=0).add(depth_frames[0], POSES[0])


def test_a_session_goes_on_from_its_checkpoint(device, depth_frames, tmp_path):
    live = session(device)
    with pytest.raises(topple.Error, match='no frames yet'):
        live.checkpoint(tmp_path / 'none')
    for n in range(4):
        live.add(depth_frames[n], POSES[n])
    before = live.update()
    live.checkpoint(tmp_path / 'session')
    again = topple.Session.resume(tmp_path / 'session', device=device, disturbances=[])
    assert again.scene is None and again.frames == [0, 1, 2, 3]
    found = again.update()
    assert [(t.id, t.object, t.change) for t in found.things] == [(t.id, t.object, 'none') for t in before.things]
    assert np.array_equal(found.result.point_object, before.result.point_object)
    assert np.array_equal(again.label(depth_frames[1], POSES[1]), live.label(depth_frames[1], POSES[1]))
    assert again.add(depth_frames[4], POSES[4]) == 4
    (tmp_path / 'session').write_bytes(b'topple.w')
    for path in (tmp_path / 'session', tmp_path / 'missing'):
        with pytest.raises(topple.Error, match=path.name) as raised:
            topple.Session.resume(path)
        assert raised.value.kind == 'input'
