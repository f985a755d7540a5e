# SPDX-License-Identifier: MIT
"""What a colour camera of a ROS bag saw of each pixel of a depth image, wherever it sits on the robot."""
import numpy as np

from . import images
from .errors import wrong

RAW = {'rgb8': (3, (0, 1, 2)), 'bgr8': (3, (2, 1, 0)), 'rgba8': (4, (0, 1, 2)), 'bgra8': (4, (2, 1, 0))}  # bytes a pixel, channels
# Of a camera at 10 Hz or more one is this near in time; one that is farther off saw something else.
FARTHEST_NS = 60_000_000
# Messages are recorded after they were taken, each with its own delay.
WINDOW_NS = 300_000_000


def is_colour(message):
    """Whether an Image or CompressedImage is a picture."""
    if hasattr(message, 'encoding'):
        return message.encoding in RAW
    return 'compressedDepth' not in message.format and any(kind in message.format.lower() for kind in ('jpeg', 'jpg', 'png'))


def pixels_of(message, path, budget):
    """(height, width, 3) uint8."""
    if not hasattr(message, 'encoding'):
        return images.coloured(bytes(message.data), path, 'colour image', budget)
    size, channels = RAW[message.encoding]
    data = np.asarray(message.data, np.uint8)
    if message.step < message.width * size or len(data) < message.step * message.height or message.height == 0 or message.width == 0:
        raise wrong(path, f'has a colour image of {message.width} x {message.height} pixels in {len(data)} bytes, {message.step} a row')
    rows = data[:message.step * message.height].reshape(message.height, message.step)[:, :message.width * size]
    return rows.reshape(message.height, message.width, size)[:, :, channels]


def laid_on(depth_m, camera, colours, colour_camera, to_colour):
    """The colours of the pixels of a depth image, (height, width, 3) uint8: 0, 0, 0 where it has no reading, or the colour image does not
    reach. to_colour: 4 x 4, from the depth camera to the colour camera."""
    v, u = np.mgrid[:camera.height, :camera.width]
    seen = np.isfinite(depth_m) & (depth_m > 0)
    z = np.where(seen, depth_m, 1.0)
    at = np.stack([(u - camera.cx) / camera.fx * z, (v - camera.cy) / camera.fy * z, z], axis=-1) @ to_colour[:3, :3].T + to_colour[:3, 3]
    seen &= at[..., 2] > 0
    ahead = np.where(seen, at[..., 2], 1.0)
    height, width = colours.shape[:2]
    x = np.clip(np.round(at[..., 0] / ahead * colour_camera.fx + colour_camera.cx), -1, width).astype(int)
    y = np.clip(np.round(at[..., 1] / ahead * colour_camera.fy + colour_camera.cy), -1, height).astype(int)
    seen &= (x >= 0) & (x < width) & (y >= 0) & (y < height)
    out = np.zeros((camera.height, camera.width, 3), np.uint8)
    out[seen] = colours[y[seen], x[seen]]
    return out


class ColourImages:
    """The pictures of one topic."""

    def __init__(self, bag, topic, frame, camera):
        """frame: of tf, in which they were taken. camera: of the pictures; or None, and it is the depth camera's in their size."""
        self.bag, self.topic, self.frame, self.camera = bag, topic, frame, camera

    def nearest(self, stamp, recorded):
        """The message that is nearest in time, None where none is near; times in ns, of the header and of the recording."""
        best, off = None, FARTHEST_NS
        for _, message in self.bag.between(self.topic, recorded - WINDOW_NS, recorded + WINDOW_NS):
            time = message.header.stamp.sec * 1_000_000_000 + message.header.stamp.nanosec
            if abs(time - stamp) <= off and is_colour(message):
                best, off = message, abs(time - stamp)
        return best

    def of(self, depth_m, depth_camera, depth_frame, transforms, stamp, recorded):
        """The colours of a depth image's pixels; None where there is no picture near in time, or tf does not say where it was taken."""
        message = self.nearest(stamp, recorded)
        if message is None:
            return None
        to_colour = np.eye(4)
        if self.frame != depth_frame:
            depth_pose, colour_pose = transforms.to_root(depth_frame, stamp), transforms.to_root(self.frame, stamp)
            if depth_pose is None or colour_pose is None or transforms.root_of(depth_frame) != transforms.root_of(self.frame):
                return None
            to_colour = np.linalg.inv(colour_pose) @ depth_pose
        pixels = pixels_of(message, self.bag.path, self.bag.budget)
        camera = (self.camera or depth_camera).resized(pixels.shape[1], pixels.shape[0])
        return laid_on(depth_m, depth_camera, pixels, camera, to_colour)
