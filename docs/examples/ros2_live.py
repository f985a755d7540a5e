# SPDX-License-Identifier: MIT
"""A ROS 2 node that says what may fall while a camera maps a room.

  python3 ros2_live.py --ros-args -r depth:=/camera/depth/image_rect -r camera_info:=/camera/depth/camera_info -r path:=/rtabmap/mapPath

Takes depth images (`depth`: sensor_msgs/Image, 16UC1 in millimetres or 32FC1 in metres, rectified, its frame_id the optical frame; without
colours) with their CameraInfo, the camera's place from tf2, and, where a SLAM system tells one, its path (`path`: nav_msgs/Path, each pose with
its own stamp), which moves the frames of before a loop closure; without it they stay where they were. With `-p of_points:=true` it takes `points`
(sensor_msgs/PointCloud2, in a frame of the sensor with z upwards) in place of depth.

Tells, latched: `objects` (visualization_msgs/MarkerArray: a box and its category each), and `things` (std_msgs/String, JSON: a list of {id, the
same as long as it is the same thing, 0 for the building; change, moved_m: docs/live.md; and of what is there category, action: what is to be
done, middle_m and size_m: its box, in fixed_frame and along the room's axes}).

Parameters: of_points (false); fixed_frame (map), z upwards; step_m, step_deg (0.1, 10): one of them is how far the camera goes from a frame that is taken to the
next; update_s (5): from the end of an update to the next one; voxel_m (0: found); checkpoint (none): a file that is written after each update and
gone on from at the start, where it is there, in the same map. Frames of before that are not moved by loop closures any more.

It needs rclpy, tf2_ros and topple for the Python that ROS has: docs/python.md says which wheel fits, and how to build it where none does.
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
from rclpy.qos import DurabilityPolicy, QoSProfile, qos_profile_sensor_data
from sensor_msgs.msg import CameraInfo, Image, PointCloud2
from std_msgs.msg import String
from visualization_msgs.msg import Marker, MarkerArray

import topple
from topple import geometry
from topple.formats.cloud import message_points
from topple.formats.frames import pose as pose_of


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
    return pose_of((turn.x, turn.y, turn.z, turn.w), (position.x, position.y, position.z))


def seconds(stamp):
    return stamp.sec + 1e-9 * stamp.nanosec


class Live(Node):
    def __init__(self):
        super().__init__('topple_live')
        self.fixed, self.step_m, self.step_deg, self.update_s, voxel_m, self.checkpoint, self.of_points = (
            self.declare_parameter(name, value).value
            for name, value in (('fixed_frame', 'map'), ('step_m', 0.1), ('step_deg', 10.0), ('update_s', 5.0), ('voxel_m', 0.0), ('checkpoint', ''), ('of_points', False)))
        self.options = {'up': (0, 0, 1), 'voxel_m': voxel_m}
        self.session = topple.Session(**self.options) if self.of_points else None  # once the camera is known
        if self.checkpoint and os.path.exists(self.checkpoint):
            self.session = topple.Session.resume(self.checkpoint, **self.options)
            self.get_logger().info(f'going on from {self.checkpoint} with {len(self.session.frames)} frames')
        self.waiting = collections.deque(maxlen=30)  # images or clouds whose place is not known yet
        self.last = None  # the pose of the frame that was taken last
        self.path = {}  # poses by time, as the SLAM system has them now
        self.hangs = {}  # of each frame: its time, its pose, and the time of a place in the path with the pose from there, or None
        self.changed = threading.Event()
        self.buffer = tf2_ros.Buffer()
        self.listener = tf2_ros.TransformListener(self.buffer, self)
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.objects = self.create_publisher(MarkerArray, 'objects', latched)
        self.things = self.create_publisher(String, 'things', latched)
        self.input = 'points' if self.of_points else 'depth'
        if not self.of_points:
            self.create_subscription(CameraInfo, 'camera_info', self.take_camera, qos_profile_sensor_data)
        self.create_subscription(PointCloud2 if self.of_points else Image, self.input, self.take, qos_profile_sensor_data)
        self.create_subscription(Path, 'path', self.take_path, 1)
        self.create_timer(10.0, self.tell)

    def take_camera(self, info):
        if self.session is None and info.p[0] > 0:  # of the rectified image
            self.session = topple.Session(topple.stages.Intrinsics(info.p[0], info.p[5], info.p[2], info.p[6]), **self.options)

    def tell(self):
        """What is missing, as long as something is."""
        if self.session is None:
            self.get_logger().warning('no CameraInfo has come on camera_info')
        elif self.waiting:
            self.get_logger().warning(f'{len(self.waiting)} messages on {self.input} wait for tf from {self.waiting[0].header.frame_id} to {self.fixed}')
        elif not self.session.frames:
            self.get_logger().warning(f'nothing has come on {self.input}')

    def take(self, message):
        self.waiting.append(message)
        while self.session is not None and self.waiting:
            header = self.waiting[0].header
            try:
                found = self.buffer.lookup_transform(self.fixed, header.frame_id, rclpy.time.Time.from_msg(header.stamp)).transform
            except tf2_ros.TransformException:
                return  # not yet: it is asked again with the next one
            self.take_frame(self.waiting.popleft(), matrix(found.translation, found.rotation))

    def take_frame(self, message, pose):
        if self.last is not None:
            turn = np.degrees(np.arccos(np.clip((np.trace(self.last[:3, :3].T @ pose[:3, :3]) - 1) / 2, -1, 1)))
            if np.linalg.norm(pose[:3, 3] - self.last[:3, 3]) < self.step_m and turn < self.step_deg:
                return
        try:
            if self.of_points:
                points, colours = message_points(message, 'points')
                frame = self.session.add(points, pose, colours)
            else:
                frame = self.session.add(metres(message), pose)
        except (topple.Error, ValueError) as error:
            self.get_logger().warning(f'{error}; it is left out')
            return
        self.last = pose
        self.hangs[frame] = self.hung(seconds(message.header.stamp), pose)
        self.changed.set()

    def hung(self, time, pose):
        """On the last place of the path before it, where there is one."""
        place = max((t for t in self.path if t <= time), default=None)
        return time, pose, place if place is None else (place, np.linalg.inv(self.path[place]) @ pose)

    def take_path(self, path):
        """After a loop closure all frames go where the path goes; one whose place has left it stays."""
        places = {seconds(p.header.stamp): matrix(p.pose.position, p.pose.orientation) for p in path.poses}
        if not all(np.isfinite(place).all() for place in places.values()):
            self.get_logger().warning('a pose of the path is not finite; frames stay where they were')
            return
        self.path = places
        moved = {}
        for frame, (time, pose, place) in self.hangs.items():
            if place and place[0] in places:
                moved[frame] = places[place[0]] @ place[1]
                self.hangs[frame] = time, moved[frame], place
            else:
                self.hangs[frame] = self.hung(time, pose)
        if moved:
            self.session.correct(moved)
            self.changed.set()

    def update(self):
        """Parses what is there, and tells it."""
        self.changed.clear()
        found = self.session.update()
        told = [{'id': t.id, 'change': t.change, 'moved_m': t.moved_m} for t in found.things]
        for one, thing in zip(told, found.things):
            if thing.object >= 0:
                o = found.result.objects[thing.object]
                one |= {'category': o.unsafety_category, 'action': o.action, 'middle_m': list(o.box_middle_m), 'size_m': list(o.size_m)}
        self.things.publish(String(data=json.dumps(told)))
        self.objects.publish(self.markers(found))
        if self.checkpoint:
            self.session.checkpoint(self.checkpoint)

    def markers(self, found):
        out = MarkerArray()
        out.markers.append(Marker(action=Marker.DELETEALL))
        ids = {t.object: t.id for t in found.things}
        turn = geometry.quaternion(geometry.room_axes(found.result).T)
        for box in geometry.boxes(found.result):
            item = found.result.objects[box.object]
            above = np.array([0, 0, box.size[2] / 2 + 0.05])
            for name, kind, size, lift in (('boxes', Marker.CUBE, box.size, 0 * above), ('words', Marker.TEXT_VIEW_FACING, (0, 0, 0.05), above)):
                marker = Marker(ns=name, id=int(ids[item.id]), type=kind, action=Marker.ADD)
                marker.header.frame_id = self.fixed
                marker.pose.position.x, marker.pose.position.y, marker.pose.position.z = map(float, box.centre + lift)
                at = marker.pose.orientation
                at.x, at.y, at.z, at.w = map(float, turn)
                marker.scale.x, marker.scale.y, marker.scale.z = map(float, size)
                paint = marker.color
                paint.r, paint.g, paint.b = (c / 255 for c in geometry.unsafety_colour(item))
                paint.a = 0.5 if kind == Marker.CUBE else 1.0
                marker.text = f'{ids[item.id]}: {item.unsafety_category or "not judged"}' if kind == Marker.TEXT_VIEW_FACING else ''
                out.markers.append(marker)
        return out

    def run(self):
        while rclpy.ok():
            if self.changed.wait(self.update_s):
                try:
                    self.update()
                except Exception as error:  # whatever it is, the next update may do
                    self.get_logger().warning(f'{type(error).__name__}: {error}')
                threading.Event().wait(self.update_s)


def main():
    rclpy.init()
    node = Live()
    threading.Thread(target=node.run, daemon=True).start()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    node.destroy_node()


if __name__ == '__main__':
    main()
