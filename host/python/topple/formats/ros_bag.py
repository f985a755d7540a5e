# SPDX-License-Identifier: MIT
"""Recordings of ROS (rosbags): bags of ROS 2 (.mcap, .db3, or their folder) and of ROS 1 (.bag).

Depth images with their CameraInfo and tf become frames; where there are none, PointCloud2 becomes a cloud in tf's root."""
import contextlib
import os
import struct
from collections import Counter

import numpy as np

from . import images
from .cloud import Cloud, kept, message_points
from .errors import needs, reading, wrong
from .frames import Camera, FrameFolder, Messages
from .limits import Budget
from .ros_colour import ColourImages, is_colour
from .scan_folder import ScanFolder
from .transforms import Transforms

FORMAT = 'ROS bag'
IMAGE, PACKED, INFO, CLOUD = (f'sensor_msgs/msg/{kind}' for kind in ('Image', 'CompressedImage', 'CameraInfo', 'PointCloud2'))
DEPTH_ENCODINGS = {'16UC1': ('u2', 0.001), 'mono16': ('u2', 0.001), '32FC1': ('f4', 1.0)}  # kind, metres
# A camera that hardly moved sees nothing new.
STEP_M, TURN_RAD = 0.03, np.deg2rad(2)
CELL_M = 0.01  # of several clouds each cell keeps its first point


def recognises(path):
    if path.is_dir():
        return (path / 'metadata.yaml').is_file() and any(file.suffix in ('.mcap', '.db3') for file in path.iterdir())
    return path.suffix.lower() in ('.mcap', '.db3', '.bag')


def _check_files(path):
    """That rosbags, which opens what metadata.yaml names in the folder, is led to no other place."""
    names = [path.name]
    if path.is_dir():
        scan, names = ScanFolder(path), os.listdir(path)
        for name in names:
            if not (path / name).is_dir() or (path / name).is_symlink():
                scan.open(name).close()
    # SQLite takes the name for an address, of which these are marks.
    odd = next((name for name in names if '.db3' in name and set('%?#') & set(name)), None)
    if odd is not None:
        raise wrong(path, f'the name {odd} has one of % ? #, by which another file may be read; rename it')


class Bag:
    """The messages of a bag, decoded."""

    def __init__(self, path, budget):
        self.path, self.budget = path, budget
        highlevel = needs('rosbags.highlevel', 'rosbags', path)
        typesys = needs('rosbags.typesys', 'rosbags', path)
        with reading(path, FORMAT):
            _check_files(path)
            # Bags before MCAP don't say what their types are; those that are read here never changed.
            self.reader = highlevel.AnyReader([path], default_typestore=typesys.get_typestore(typesys.Stores.LATEST))
            self.reader.open()
        self.connections = list(self.reader.connections)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        with contextlib.suppress(Exception):
            self.reader.close()

    def topics(self, kind):
        """{topic: number of messages} of a type."""
        counts = Counter()
        for connection in self.connections:
            if connection.msgtype == kind:
                counts[connection.topic] += connection.msgcount
        return counts

    def messages(self, *topics):
        """(topic, message), in the order of their recording."""
        chosen = [c for c in self.connections if c.topic in topics]
        with reading(self.path, FORMAT):
            if not chosen:
                return
            for connection, _, data in self.reader.messages(connections=chosen):
                yield connection.topic, self.reader.deserialize(data, connection.msgtype)

    def between(self, topic, start=None, stop=None):
        """(time of recording in ns, message) of a topic, from start to before stop."""
        chosen = [c for c in self.connections if c.topic == topic]
        with reading(self.path, FORMAT):
            for connection, time, data in self.reader.messages(connections=chosen, start=start, stop=stop):
                yield time, self.reader.deserialize(data, connection.msgtype)


def _transforms(bag):
    found = Transforms()
    for topic, message in bag.messages('/tf', '/tf_static'):
        found.add(message, fixed=topic == '/tf_static')
    found.sort()
    return found


def _time(header):
    return header.stamp.sec * 1_000_000_000 + header.stamp.nanosec


def _depth_topics(bag):
    """{topic: messages} of images that hold depth, as the first of each tells."""
    found = Counter()
    for topic in bag.topics(PACKED):
        if topic.endswith('/compressedDepth'):
            found[topic] = bag.topics(PACKED)[topic]
    for topic, count in bag.topics(IMAGE).items():
        for _, message in bag.messages(topic):
            if message.encoding in ('16UC1', '32FC1') or (message.encoding == 'mono16' and 'depth' in topic):
                found[topic] = count
            break
    return found


def _colours(bag, depth_topic, depth_frame, transforms):
    """The pictures to take: of the depth images' own frame, or else of one that tf has a place for; of several, those of most messages.
    None: there are none."""
    found = []
    for kind in (IMAGE, PACKED):
        for topic, count in bag.topics(kind).items():
            first = next((message for _, message in bag.messages(topic)), None)
            if first is None or topic == depth_topic or not is_colour(first):
                continue
            frame = first.header.frame_id.lstrip('/')
            placed = frame == depth_frame or transforms.root_of(frame) == transforms.root_of(depth_frame)
            camera = _camera_beside(bag, topic)
            if placed and (camera is not None or frame == depth_frame):
                found.append((frame != depth_frame, -count, topic, frame, camera))
    if not found:
        return None
    _, _, topic, frame, camera = min(found, key=lambda one: one[:3])
    return ColourImages(Bag(bag.path, bag.budget), topic, frame, camera)  # a reader goes through one topic at a time


def _camera_beside(bag, topic):
    """The camera of a topic's pictures, None where nothing tells."""
    name = _info_beside(bag, topic)
    for _, info in bag.messages(name) if name else ():
        with reading(bag.path, FORMAT):
            return _camera(info, topic)[0]
    return None


def _most(counts, wanted, path, what):
    """The topic that is wanted, or else the one of most messages; the first by name of several."""
    if wanted is not None and wanted in counts:
        return wanted
    if wanted is not None:
        raise wrong(path, f'has no {what} in topic {wanted}; it has {", ".join(sorted(counts)) or "none"}', 'usage')
    return min(counts, key=lambda topic: (-counts[topic], topic))


def _info_beside(bag, topic):
    """The topic of the CameraInfo that is an image's neighbour, None where there is none."""
    topic = topic.removesuffix('/compressedDepth').removesuffix('/compressed')
    place = topic.rsplit('/', 1)[0]
    names = (f'{place}/camera_info', f'{topic}/camera_info', f'{place.rsplit("/", 1)[0]}/camera_info')
    return next((name for name in names if name in bag.topics(INFO)), None)


def _info_topic(bag, topic):
    """The topic of the CameraInfo that belongs to an image: its neighbour, by ROS' convention."""
    topics = bag.topics(INFO)
    found = _info_beside(bag, topic)
    if found is None and len(topics) == 1:
        found = next(iter(topics))
    if found is not None:
        return found
    raise wrong(bag.path, f'has depth images in {topic}, but no camera_info beside them; it has {", ".join(sorted(topics)) or "none"}')


def _camera(info, topic):
    """The Camera, and whether it has distortion that is left alone."""
    k, p, d = (np.array(getattr(info, name, getattr(info, name.upper(), ())), float) for name in 'kpd')
    if 'rect' in topic and len(p) == 12 and p[0] > 0:
        return Camera(info.width, info.height, p[0], p[5], p[2], p[6]), False
    return Camera(info.width, info.height, k[0], k[4], k[2], k[5]), bool(np.any(np.abs(d) > 1e-6))


def _unpacked(message, path, budget):
    """(height, width) in metres of an image that the plugin compressed_depth_image_transport packed: a head of 12 bytes, then a PNG of
    millimetres, or of inverse depth between two constants that are in the head."""
    with reading(path, 'bag with sound compressedDepth images'):
        data = bytes(message.data)
        _, a, b = struct.unpack_from('<iff', data)
        stored = images.grey(data[12:], path, 'compressedDepth image', budget)
        if message.format.startswith('16UC1'):
            return stored * 0.001
        if message.format.startswith('32FC1'):
            with np.errstate(divide='ignore'):
                return np.where(stored > 0, a / (stored.astype(float) - b), 0.0)
    raise wrong(path, f'has a compressedDepth image of format {message.format}; 16UC1 and 32FC1 are read')


def _depth(message, path, budget):
    """(height, width) in metres."""
    if hasattr(message, 'format'):
        return _unpacked(message, path, budget)
    if message.encoding not in DEPTH_ENCODINGS:
        raise wrong(path, f'has a depth image of encoding {message.encoding}; 16UC1 and 32FC1 are read')
    kind, metres = DEPTH_ENCODINGS[message.encoding]
    kind = np.dtype(kind).newbyteorder('>' if message.is_bigendian else '<')
    row = message.width * kind.itemsize
    data = np.asarray(message.data, np.uint8)
    if message.step < row or len(data) < message.step * message.height or message.height == 0 or row == 0:
        raise wrong(path, f'has a depth image of {message.width} x {message.height} pixels in {len(data)} bytes, {message.step} a row')
    rows = data[:message.step * message.height].reshape(message.height, message.step)[:, :row]
    return np.ascontiguousarray(rows).view(kind).astype(float) * metres


class _Moved:
    """Tells which poses lie far enough from the last one that was taken."""

    def __init__(self):
        self.last = None

    def __call__(self, pose):
        if self.last is not None:
            step = np.linalg.norm(pose[:3, 3] - self.last[:3, 3])
            cosine = (np.trace(self.last[:3, :3].T @ pose[:3, :3]) - 1) / 2
            if step < STEP_M and np.arccos(np.clip(cosine, -1, 1)) < TURN_RAD:
                return False
        self.last = pose
        return True


def _frames(bag, begin, topic, others, wait=None):
    """begin(): the Frames, once there is a camera; wait(ns): is called before each image is looked at, with the time of its recording. Returns the notes."""
    transforms = _transforms(bag)
    first = next((message for _, message in bag.messages(topic)), None)
    if first is None:
        raise wrong(bag.path, f'{topic} has no message')
    pictures = _colours(bag, topic, first.header.frame_id.lstrip('/'), transforms)
    info_topic = _info_topic(bag, topic)
    camera = distorted = None
    for _, info in bag.messages(info_topic):
        with reading(bag.path, FORMAT):
            camera, distorted = _camera(info, topic)
        break
    if camera is None:
        raise wrong(bag.path, f'{info_topic} has no message')
    frames, moved = begin(), _Moved()
    seen = unplaced = coloured = 0
    for recorded, message in bag.between(topic):
        seen += 1
        if wait is not None:
            wait(recorded)
        frame = message.header.frame_id.lstrip('/')
        pose = transforms.to_root(frame, _time(message.header))
        if pose is None:
            unplaced += 1
        elif moved(pose):
            depth = _depth(message, bag.path, bag.budget)
            own = camera.resized(depth.shape[1], depth.shape[0])
            colours = pictures and pictures.of(depth, own, frame, transforms, _time(message.header), recorded)
            coloured += colours is not None
            frames.add(own, depth, pose, colours)
    if unplaced == seen:
        raise wrong(bag.path, f'{topic}: tf does not say where {frame} was when any of its {seen} images was taken')
    moves = f'those before which the camera had moved by {STEP_M * 100:.0f} cm or turned by {np.rad2deg(TURN_RAD):.0f} degrees'
    notes = [f'{len(frames.poses)} of the {seen} depth images of {topic} were taken: '
             f'{moves if len(frames.poses) > 1 else "by tf the camera stands still, so that one shows what all do"}. Coordinates are in the '
             f'frame "{transforms.root_of(frame)}".']
    if pictures:
        notes.append(f'{coloured} of them have colours, of the images of {pictures.topic} that are nearest in time.')
    if unplaced:
        notes.append(f'{unplaced} depth images were left out, as tf does not say where the camera was.')
    if distorted:
        notes.append(f"{info_topic} tells of the lens' distortion, which is not corrected: surfaces are bent towards the images' corners.")
    if others:
        notes.append(f'Other topics with depth were left out: {", ".join(others)}.')
    return frames.finish(notes)


def _thinned(points, *others):
    """The first point of each cell, in order, and what else there is of it."""
    kept = np.flatnonzero(np.isfinite(points).all(axis=1))
    _, first = np.unique(np.floor(points[kept] / CELL_M).astype(np.int64), axis=0, return_index=True)
    kept = kept[np.sort(first)]
    return [values[kept] for values in (points, *others)]


def _cloud(bag, topic, others):
    transforms = _transforms(bag)
    points, colours, places = np.empty((0, 3)), np.empty((0, 3), np.uint8), np.empty((0, 3), np.float32)
    thinned_to = taken = unplaced = 0
    coloured, frame, placed = False, '', False
    for _, message in bag.messages(topic):
        frame = message.header.frame_id.lstrip('/')
        pose = transforms.to_root(frame, _time(message.header))
        if pose is None:
            unplaced += 1
            continue
        with reading(bag.path, FORMAT):
            new, seen = message_points(message, bag.path)
        coloured = coloured or seen is not None
        points = np.concatenate([points, new @ pose[:3, :3].T + pose[:3, 3]])
        colours = np.concatenate([colours, np.zeros((len(new), 3), np.uint8) if seen is None else seen])
        taken += 1
        # Only a frame that has a place in another is the sensor's.
        place = pose[:3, 3] if frame in transforms.edges else np.full(3, np.nan)
        placed = placed or frame in transforms.edges
        places = np.concatenate([places, np.tile(place.astype(np.float32), (len(new), 1))])
        if taken > 1 and len(points) > 2 * thinned_to + 2_000_000:
            points, colours, places = _thinned(points, colours, places)
            thinned_to = len(points)
    if taken == 0:
        raise wrong(bag.path, f'{topic}: tf does not say where "{frame}" was when any of its {unplaced} clouds was taken'
                    if unplaced else f'{topic} has no message')
    notes = []
    if taken > 1:
        points, colours, places = _thinned(points, colours, places)
        notes.append(f'The {taken} clouds of {topic} were put together; each cell of {CELL_M * 100:.0f} cm keeps one point. Coordinates '
                     f'are in the frame "{transforms.root_of(frame)}".')
    if unplaced:
        notes.append(f'{unplaced} clouds were left out, as tf does not say where the sensor was.')
    if others:
        notes.append(f'Other topics with clouds were left out: {", ".join(others)}.')
    viewpoint = None if not placed else places[0].astype(float) if taken == 1 else places
    return Cloud(points, colours if coloured else None, viewpoint, notes=notes)


def _sweeps(bag, messages, topic, wait):
    """As _frames(), of clouds in their sensor's axes."""
    transforms = _transforms(bag)
    seen = taken = placed = 0
    for recorded, message in bag.between(topic):
        wait(recorded)
        seen += 1
        frame = message.header.frame_id.lstrip('/')
        pose = transforms.to_root(frame, _time(message.header))
        placed += frame in transforms.edges
        if pose is None:
            continue
        with reading(bag.path, FORMAT):
            points, colours = message_points(message, bag.path)
        known = np.isfinite(points).all(axis=1)
        messages.add_points(points[known], pose, None if colours is None else colours[known])
        taken += 1
    if taken == 0:
        raise wrong(bag.path, f'{topic}: tf does not say where the sensor was when any of its {seen} clouds was taken')
    notes = [f'{taken} of the {seen} clouds of {topic} were played' + ('.' if taken == seen else '; of the others tf does not say where the sensor was.')]
    if not placed:
        notes.append(f'The bag has no tf of "{frame}": all clouds were played as of a sensor that stands still, whose frame they are in.')
    return notes


def play(path, out, options, wait):
    """Writes the bag's depth frames as convert() does, one by one: each after wait(ns) of its time of recording; or, where `out` is a
    file of bytes, as messages, and the clouds of a bag that has no depth. Returns the notes."""
    with Bag(path, Budget(path, options)) as bag:
        depth, clouds = _depth_topics(bag), bag.topics(CLOUD)
        messages = Messages(out, path) if hasattr(out, 'write') else None
        if messages and clouds and (options.topic in clouds or not depth):
            return _sweeps(bag, messages, _most(clouds, options.topic, path, 'PointCloud2'), wait)
        if not depth:
            raise wrong(path, 'has no depth image (16UC1, 32FC1, compressedDepth) that could be played' +
                        (': its clouds can be played to "-", for topple live -' if clouds else ''))
        topic = _most(depth, options.topic, path, 'depth image')
        return _frames(bag, lambda: messages or FrameFolder(out, path), topic, sorted(set(depth) - {topic}), wait)


def convert(path, folder, options):
    with Bag(path, Budget(path, options)) as bag:
        depth, clouds = _depth_topics(bag), bag.topics(CLOUD)
        if depth and options.topic not in clouds:
            topic = _most(depth, options.topic, path, 'depth image')
            return folder, _frames(bag, lambda: FrameFolder(folder, path), topic, sorted(set(depth) - {topic})), None
        if not clouds:
            kinds = sorted({c.msgtype for c in bag.connections})
            raise wrong(path, f'has no depth image (16UC1, 32FC1, compressedDepth) and no PointCloud2, but {", ".join(kinds)[:300] or "nothing"}')
        topic = _most(clouds, options.topic, path, 'PointCloud2')
        cloud = _cloud(bag, topic, sorted(set(clouds) - {topic})).moved_near(options.unit_m)
    return kept(cloud, path, folder, options)
