# SPDX-License-Identifier: MIT
"""A ROS 2 node that says what may fall while a camera maps a room.

  python3 ros2_live.py --ros-args -r depth:=/camera/depth/image_rect -r camera_info:=/camera/depth/camera_info -r path:=/rtabmap/mapPath

Takes depth images (sensor_msgs/Image, 16UC1 in millimetres or 32FC1 in metres, rectified) with their CameraInfo, the camera's place from tf2,
and, where a SLAM system tells one, its path (nav_msgs/Path), which moves the frames of before a loop closure. Tells `objects`
(visualization_msgs/MarkerArray: a box and words each) and `things` (std_msgs/String, JSON: id, change, object, what is to be done).

Parameters: fixed_frame (map); step_m, step_deg (0.1, 10): how far the camera goes from one frame that is taken to the next; update_s (5): from
the end of an update to the next one; checkpoint (none): a file to go on from after a crash. It needs rclpy, tf2_ros and topple.
"""
import collections
import json
import os
import threading

import numpy as np
import rclpy
import tf2_ros
from nav_msgs.msg import Path
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import CameraInfo, Image
from std_msgs.msg import String
from visualization_msgs.msg import Marker, MarkerArray

import topple
from topple import geometry


def metres(image):
    """(H, W) float32 of an Image."""
    kinds = {'16UC1': 'u2', 'mono16': 'u2', '32FC1': 'f4'}
    if image.encoding not in kinds:
        raise ValueError(f'depth is {image.encoding}; expected 16UC1 or 32FC1')
    kind = np.dtype(('>' if image.is_bigendian else '<') + kinds[image.encoding])
    rows = np.frombuffer(bytes(image.data), np.uint8).reshape(image.height, image.step)[:, :image.width * kind.itemsize]
    values = np.ascontiguousarray(rows).view(kind)
    return values.astype(np.float32) * (0.001 if kind.kind == 'u' else 1)


def matrix(position, turn):
    """(4, 4) of a place and a quaternion."""
    x, y, z, w = np.array([turn.x, turn.y, turn.z, turn.w]) / np.linalg.norm([turn.x, turn.y, turn.z, turn.w])
    out = np.eye(4)
    out[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                   [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                   [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    out[:3, 3] = position.x, position.y, position.z
    return out


def seconds(stamp):
    return stamp.sec + 1e-9 * stamp.nanosec


class Live(Node):
    def __init__(self):
        super().__init__('topple_live')
        self.fixed, self.step_m, self.step_deg, self.update_s, self.checkpoint = (
            self.declare_parameter(name, value).value
            for name, value in (('fixed_frame', 'map'), ('step_m', 0.1), ('step_deg', 10.0), ('update_s', 5.0), ('checkpoint', '')))
        self.session = topple.Session.resume(self.checkpoint) if self.checkpoint and os.path.exists(self.checkpoint) else None
        self.waiting = collections.deque(maxlen=30)  # images whose place is not known yet
        self.last = None  # the pose of the frame that was taken last
        self.path = {}  # poses by time, as the SLAM system has them now
        self.hangs = {}  # of each frame: the time of its place in the path, and its pose from there; or its own time and pose
        self.changed = threading.Event()
        self.buffer = tf2_ros.Buffer()
        self.listener = tf2_ros.TransformListener(self.buffer, self)
        self.objects = self.create_publisher(MarkerArray, 'objects', 1)
        self.things = self.create_publisher(String, 'things', 1)
        self.create_subscription(CameraInfo, 'camera_info', self.take_camera, qos_profile_sensor_data)
        self.create_subscription(Image, 'depth', self.take_image, qos_profile_sensor_data)
        self.create_subscription(Path, 'path', self.take_path, 1)

    def take_camera(self, info):
        if self.session is None and info.k[0] > 0:
            self.session = topple.Session(topple.stages.Intrinsics(info.k[0], info.k[4], info.k[2], info.k[5]))

    def take_image(self, image):
        self.waiting.append(image)
        while self.session is not None and self.waiting:
            header = self.waiting[0].header
            try:
                found = self.buffer.lookup_transform(self.fixed, header.frame_id, rclpy.time.Time.from_msg(header.stamp)).transform
            except tf2_ros.TransformException:
                return  # not yet: it is asked again with the next image
            self.take_frame(self.waiting.popleft(), matrix(found.translation, found.rotation))

    def take_frame(self, image, pose):
        if self.last is not None:
            turn = np.degrees(np.arccos(np.clip((np.trace(self.last[:3, :3].T @ pose[:3, :3]) - 1) / 2, -1, 1)))
            if np.linalg.norm(pose[:3, 3] - self.last[:3, 3]) < self.step_m and turn < self.step_deg:
                return
        try:
            frame = self.session.add(metres(image), pose)
        except (topple.Error, ValueError) as error:
            self.get_logger().warning(f'{error}; it is left out')
            return
        self.last = pose
        self.hangs[frame] = self.hung(seconds(image.header.stamp), pose)
        self.changed.set()

    def hung(self, time, pose):
        """Where the path has a place before it: that one's time, and the pose from there."""
        before = [t for t in self.path if t <= time]
        return (max(before), np.linalg.inv(self.path[max(before)]) @ pose) if before else (time, pose)

    def take_path(self, path):
        """After a loop closure all frames go where the path goes."""
        self.path = {seconds(p.header.stamp): matrix(p.pose.position, p.pose.orientation) for p in path.poses}
        moved = {}
        for frame, (time, pose) in self.hangs.items():
            if time in self.path:
                moved[frame] = self.path[time] @ pose
            else:
                self.hangs[frame] = self.hung(time, pose)
        if moved:
            self.session.correct(moved)
            self.changed.set()

    def update(self):
        """Parses what is there, and tells it."""
        self.changed.clear()
        found = self.session.update()
        if self.checkpoint:
            self.session.checkpoint(self.checkpoint)
        objects = {o.id: o for o in found.result.objects}
        self.things.publish(String(data=json.dumps([
            {'id': t.id, 'change': t.change, 'object': t.object, 'moved_m': t.moved_m,
             'action': objects[t.object].action if t.object >= 0 else ''} for t in found.things])))
        self.objects.publish(self.markers(found))

    def markers(self, found):
        out = MarkerArray()
        out.markers.append(Marker(action=Marker.DELETEALL))
        ids = {t.object: t.id for t in found.things}
        items = {o.id: o for o in found.result.objects}
        turn = geometry.quaternion(geometry.room_axes(found.result).T)
        for box in geometry.boxes(found.result):
            item = items[box.object]
            for name, kind, size in (('boxes', Marker.CUBE, box.size), ('words', Marker.TEXT_VIEW_FACING, (0, 0, 0.05))):
                marker = Marker(ns=name, id=int(ids[item.id]), type=kind, action=Marker.ADD)
                marker.header.frame_id = self.fixed
                marker.pose.position.x, marker.pose.position.y, marker.pose.position.z = map(float, box.centre)
                at = marker.pose.orientation
                at.x, at.y, at.z, at.w = map(float, turn)
                marker.scale.x, marker.scale.y, marker.scale.z = map(float, size)
                paint = marker.color
                paint.r, paint.g, paint.b = (c / 255 for c in geometry.unsafety_colour(item))
                paint.a = 0.5 if kind == Marker.CUBE else 1.0
                marker.text = f'{ids[item.id]}: {item.action}' if kind == Marker.TEXT_VIEW_FACING else ''
                out.markers.append(marker)
        return out

    def run(self):
        while rclpy.ok():
            if self.changed.wait(self.update_s):
                try:
                    self.update()
                except topple.Error as error:
                    self.get_logger().warning(str(error))
                threading.Event().wait(self.update_s)


def main():
    rclpy.init()
    node = Live()
    threading.Thread(target=node.run, daemon=True).start()
    rclpy.spin(node)


if __name__ == '__main__':
    main()
