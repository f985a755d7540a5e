# SPDX-License-Identifier: MIT
"""docs/examples/ros2_live.py, with stand-ins for what it takes of ROS: messages are what their definitions say, topics are lists."""
import importlib.util
import json
import pathlib
import sys
import types
from types import SimpleNamespace as Fields

import numpy as np
import pytest

import topple
from made_scans import CAMERA, POSES
from topple.geometry import quaternion

NODE = pathlib.Path(__file__).parents[2] / 'docs/examples/ros2_live.py'


class Marker(Fields):
    ADD, DELETEALL, CUBE, TEXT_VIEW_FACING = 0, 3, 1, 9

    def __init__(self, **given):
        point = lambda: Fields(x=0.0, y=0.0, z=0.0)
        super().__init__(header=Fields(frame_id=''), pose=Fields(position=point(), orientation=Fields(x=0.0, y=0.0, z=0.0, w=1.0)), scale=point(),
                         color=Fields(r=0.0, g=0.0, b=0.0, a=0.0), **given)


class Node:
    def __init__(self, name):
        self.said, self.topics = [], {}

    def declare_parameter(self, name, value):
        return Fields(value=PARAMETERS.get(name, value))

    def create_publisher(self, kind, topic, depth):
        self.topics[topic] = []
        return Fields(publish=self.topics[topic].append)

    def create_subscription(self, kind, topic, call, quality):
        self.topics[topic] = call

    def create_timer(self, seconds, call):
        self.timer = call

    def get_logger(self):
        return Fields(warning=self.said.append, info=lambda text: None)


class TransformException(Exception):
    pass


class Buffer:
    poses = {}

    def lookup_transform(self, target, source, time):
        assert (target, source) == ('map', 'camera')
        if time not in self.poses:
            raise TransformException('not yet')
        position, turn = placed(self.poses[time])
        return Fields(transform=Fields(translation=position, rotation=turn))


PARAMETERS = {}


def placed(pose):
    return Fields(**dict(zip('xyz', pose[:3, 3]))), Fields(**dict(zip('xyzw', quaternion(pose[:3, :3]))))


def stamp(time):
    return Fields(sec=int(time), nanosec=round(1e9 * (time - int(time))))


@pytest.fixture
def live(monkeypatch, tmp_path):
    message = type('Message', (Fields,), {})
    modules = {'rclpy': {'ok': lambda: True, 'time': Fields(Time=Fields(from_msg=lambda s: s.sec + s.nanosec / 1e9))},
               'rclpy.node': {'Node': Node}, 'rclpy.qos': {'qos_profile_sensor_data': None, 'QoSProfile': Fields, 'DurabilityPolicy': Fields(TRANSIENT_LOCAL=1)},
               'tf2_ros': {'Buffer': Buffer, 'TransformListener': lambda *_: None, 'TransformException': TransformException},
               'nav_msgs.msg': {'Path': message}, 'sensor_msgs.msg': {'CameraInfo': message, 'Image': message, 'PointCloud2': message}, 'std_msgs.msg': {'String': message},
               'visualization_msgs.msg': {'Marker': Marker, 'MarkerArray': lambda: Fields(markers=[])}}
    for name, members in modules.items():
        monkeypatch.setitem(sys.modules, name, types.ModuleType(name))
        vars(sys.modules[name]).update(members)
    monkeypatch.setattr(Buffer, 'poses', {})
    monkeypatch.setitem(PARAMETERS, 'checkpoint', str(tmp_path / 'room.session'))
    spec = importlib.util.spec_from_file_location('ros2_live', NODE)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.Live


def image(metres, time, kind):
    stored = (1000 * metres).round().astype('>u2') if kind == '16UC1' else metres.astype('<f4')
    rows = np.zeros((stored.shape[0], stored.shape[1] * stored.itemsize + 6), np.uint8)  # rows may be longer than what they hold
    rows[:, :-6] = np.ascontiguousarray(stored).view(np.uint8).reshape(len(rows), -1)
    return Fields(header=Fields(stamp=stamp(time), frame_id='camera'), encoding=kind, is_bigendian=int(kind == '16UC1'), height=stored.shape[0],
                  width=stored.shape[1], step=rows.shape[1], data=rows.tobytes())


def shifted(pose, metres):
    return np.block([[np.eye(3), np.array([[metres], [0], [0]])], [0, 0, 0, 1]]) @ pose


def test_it_takes_frames_follows_the_path_and_tells(live, walk):
    node = live()
    node.timer()
    assert 'camera_info' in node.said.pop()
    node.topics['camera_info'](Fields(p=[CAMERA.fx, 0, CAMERA.cx, 0, 0, CAMERA.fy, CAMERA.cy, 0, 0, 0, 1, 0]))
    path = lambda by: Fields(poses=[Fields(header=Fields(stamp=stamp(float(n))), pose=Fields(**dict(zip(('position', 'orientation'), placed(shifted(np.eye(4), by[n]))))))
                                    for n in range(len(by))])
    drift = [0.0, 0.0, 0.2, 0.2, 0.2, 0.2]
    node.topics['path'](path(drift))
    for n, (pose, depth) in enumerate(walk[:6]):
        node.topics['depth'](image(depth, n + 0.5, '32FC1' if n == 3 else '16UC1'))
        assert len(node.waiting) == 1  # its place is told later
        Buffer.poses[n + 0.5] = shifted(pose, drift[n])
    node.topics['depth'](image(walk[5][1], 5.75, '16UC1'))
    Buffer.poses[5.75] = shifted(walk[5][0], drift[5])  # where the one before was
    node.topics['depth'](image(np.zeros((5, 5), np.float32), 6.5, '16UC1'))
    Buffer.poses[6.5] = np.eye(4)
    node.topics['depth'](image(walk[0][1], 7.5, '16UC1'))
    assert node.session.frames == list(range(6)) and len(node.said) == 1 and 'pixels' in node.said[0]
    poses = lambda: [node.hangs[n][1] for n in range(6)]
    assert np.allclose(poses(), [shifted(walk[n][0], drift[n]) for n in range(6)])
    node.topics['path'](Fields(poses=[]))  # all of it is gone: nothing moves
    node.topics['path'](path(drift))
    assert np.allclose(poses(), [shifted(walk[n][0], drift[n]) for n in range(6)])
    node.topics['path'](path([0.0] * 6))  # a loop closure
    assert np.allclose(poses(), [pose for pose, _ in walk[:6]])
    wrong = path([1.0] * 6)
    wrong.poses[0].pose.orientation = Fields(x=0.0, y=0.0, z=0.0, w=0.0)
    node.topics['path'](wrong)
    assert 'stay where they were' in node.said.pop()
    node.topics['path'](path([0.0] * 6))
    assert node.changed.is_set()
    node.update()
    expected = topple.parse(frames=[np.round(1000 * depth).astype(np.uint16) for _, depth in walk[:6]], camera_to_world=np.array(POSES[:6]),
                            intrinsics=topple.stages.Intrinsics(CAMERA.fx, CAMERA.fy, CAMERA.cx, CAMERA.cy), up=(0, 0, 1))
    found = node.session.scene
    assert len(found.result.objects) == len(expected.objects) > 2
    told = json.loads(node.topics['things'][0].data)
    assert [(t['id'], t['change']) for t in told] == [(t.id, t.change) for t in found.things]
    assert all(t['action'] or t['id'] == 0 for t in told) and all(len(t['middle_m']) == 3 for t in told)
    markers = node.topics['objects'][0].markers
    assert markers[0].action == Marker.DELETEALL and len(markers) > 3 and all(m.header.frame_id == 'map' for m in markers[1:])
    boxes = [m for m in markers[1:] if m.type == Marker.CUBE]
    assert all(min(m.scale.x, m.scale.y, m.scale.z) > 0 and m.color.a == 0.5 for m in boxes)
    # As if it had ended and been begun again.
    again = live()
    assert again.session.frames == list(range(6))
    again.update()
    assert [t['change'] for t in json.loads(again.topics['things'][0].data)] == ['none'] * len(told)


def test_it_takes_points_of_a_lidar(live, monkeypatch):
    monkeypatch.setitem(PARAMETERS, 'of_points', True)
    node = live()
    assert set(node.topics) == {'objects', 'things', 'points', 'path'}
    node.timer()
    assert 'nothing has come on points' in node.said.pop()
    around = np.random.default_rng(1).normal(size=(2000, 3))
    around *= 2 / np.abs(around).max(axis=1, keepdims=True)  # on the sides of a room of 4 m
    for time in (0.5, 1.5):
        pose = shifted(np.eye(4), 0.4 * time)
        Buffer.poses[time] = pose
        data = np.zeros(2000, np.dtype({'names': list('xyz'), 'formats': ['<f4'] * 3, 'offsets': [4, 8, 12], 'itemsize': 20}))
        for axis, values in zip('xyz', (around - pose[:3, 3]).T):
            data[axis] = values
        fields = [Fields(name=name, offset=4 + 4 * n, datatype=7) for n, name in enumerate('xyz')]
        node.topics['points'](Fields(header=Fields(stamp=stamp(time), frame_id='camera'), fields=fields, is_bigendian=0, width=2000, height=1, point_step=20,
                                     row_step=40000, data=data.tobytes()))
    assert node.session.frames == [0, 1] and node.changed.is_set() and not node.said
