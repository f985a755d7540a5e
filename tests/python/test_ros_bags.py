# SPDX-License-Identifier: MIT
"""Bags of ROS: depth images with tf, and clouds, from what rosbags and mcap-ros2-support write."""
import concurrent.futures
import io
import json
import struct
import time

import numpy as np
import pytest

import topple
from others import raises
import topple.formats
from made_scans import CAMERA, POSES, colours_of, parsed, quaternion, refused, same_objects, truncated
from topple.formats import ros_bag
from topple.formats.frames import png
from topple.formats.limits import Budget
from topple.formats.transforms import Transforms

rosbags = pytest.importorskip('rosbags')
from rosbags.typesys import Stores, get_typestore  # noqa: E402

STORE = get_typestore(Stores.ROS2_HUMBLE)
TYPES = STORE.types
SECOND = 1_000_000_000


def header(time, frame):
    return TYPES['std_msgs/msg/Header'](stamp=TYPES['builtin_interfaces/msg/Time'](sec=time // SECOND, nanosec=time % SECOND), frame_id=frame)


def tf(*edges):
    """(time, parent, child, 4 x 4)."""
    out = []
    for time, parent, child, matrix in edges:
        x, y, z, w = quaternion(matrix[:3, :3])
        transform = TYPES['geometry_msgs/msg/Transform'](
            translation=TYPES['geometry_msgs/msg/Vector3'](*map(float, matrix[:3, 3])),
            rotation=TYPES['geometry_msgs/msg/Quaternion'](float(x), float(y), float(z), float(w)))
        out.append(TYPES['geometry_msgs/msg/TransformStamped'](header=header(time, parent), child_frame_id=child, transform=transform))
    return TYPES['tf2_msgs/msg/TFMessage'](transforms=out)


def image(time, depth, encoding, frame='optical'):
    data = np.round(depth * 1000).astype('<u2') if encoding == '16UC1' else depth.astype('<f4')
    height, width = depth.shape
    padded = np.zeros((height, width * data.itemsize + 8), np.uint8)  # rows may be longer than their pixels
    padded[:, :-8] = data.view(np.uint8).reshape(height, -1)
    return TYPES['sensor_msgs/msg/Image'](header=header(time, frame), height=height, width=width, encoding=encoding, is_bigendian=0,
                                          step=padded.shape[1], data=padded.ravel())


def packed_image(time, depth, kind):
    """As compressed_depth_image_transport writes them."""
    if kind == '16UC1':
        a, b, stored = 0.0, 0.0, np.round(depth * 1000)
    else:  # of inverse depth, the finer the nearer
        a, b = 100 * (100 / 5 + 1), 1 - 100.0
        stored = np.round(a / depth + b)
    data = struct.pack('<iff', 0, a, b) + png(stored.astype(np.uint16))
    return TYPES['sensor_msgs/msg/CompressedImage'](header=header(time, 'optical'), format=f'{kind}; compressedDepth png',
                                                    data=np.frombuffer(data, np.uint8))


def camera_info():
    k = np.array([CAMERA.fx, 0, CAMERA.cx, 0, CAMERA.fy, CAMERA.cy, 0, 0, 1], float)
    return TYPES['sensor_msgs/msg/CameraInfo'](
        header=header(0, 'optical'), height=CAMERA.height, width=CAMERA.width, distortion_model='plumb_bob', d=np.zeros(5), k=k,
        r=np.eye(3).ravel(), p=np.zeros(12), binning_x=0, binning_y=0,
        roi=TYPES['sensor_msgs/msg/RegionOfInterest'](0, 0, 0, 0, False))


def point_cloud(time, points, frame, colours=None):
    field = TYPES['sensor_msgs/msg/PointField']
    names = ['x', 'y', 'z'] + ['rgb'] * (colours is not None)
    records = np.zeros(len(points), [(name, '<u4' if name == 'rgb' else '<f4') for name in names] + [('unused', '<f4')])
    for axis, name in enumerate('xyz'):
        records[name] = points[:, axis]
    if colours is not None:
        records['rgb'] = colours.astype(np.uint32) @ [1 << 16, 1 << 8, 1]
    return TYPES['sensor_msgs/msg/PointCloud2'](
        header=header(time, frame), height=1, width=len(points), fields=[field(name, 4 * n, 7, 1) for n, name in enumerate(names)],
        is_bigendian=False, point_step=records.itemsize, row_step=records.nbytes, data=records.view(np.uint8), is_dense=True)


def write_bag(folder, storage, messages):
    """messages: (topic, type, time, message)."""
    from rosbags.rosbag2 import StoragePlugin, Writer
    with Writer(folder, version=9, storage_plugin=StoragePlugin.MCAP if storage == 'mcap' else StoragePlugin.SQLITE3) as writer:
        connections = {}
        for topic, kind, time, message in messages:
            if topic not in connections:
                connections[topic] = writer.add_connection(topic, kind, typestore=STORE)
            writer.write(connections[topic], time, STORE.serialize_cdr(message, kind))
    return folder


# The optical frame hangs on the body by a fixed turn; the body moves in the map.
BODY_TO_OPTICAL = np.array([[0, 0, 1, 0.1], [-1, 0, 0, 0], [0, -1, 0, 0.05], [0, 0, 0, 1.0]])


def depth_messages(walk, encoding):
    out = [('/tf_static', 'tf2_msgs/msg/TFMessage', 0, tf((0, 'body', 'optical', BODY_TO_OPTICAL)))]
    for n, (pose, depth) in enumerate(walk):
        time = (n + 1) * SECOND
        body = pose @ np.linalg.inv(BODY_TO_OPTICAL)
        out += [('/tf', 'tf2_msgs/msg/TFMessage', time, tf((time, 'map', 'body', body))),
                ('/camera/depth/camera_info', 'sensor_msgs/msg/CameraInfo', time, camera_info()),
                ('/camera/depth/image_raw', 'sensor_msgs/msg/Image', time, image(time, depth, encoding))]
    return out


@pytest.mark.parametrize('storage, encoding', [('mcap', '16UC1'), ('sqlite3', '32FC1')])
def test_depth_images(walk, sequence, device, tmp_path, storage, encoding):
    bag = write_bag(tmp_path / 'bag', storage, depth_messages(walk, encoding))
    result = parsed(bag, device)
    same_objects(result, sequence, within=0.02)
    assert any(f'{len(walk)} of the {len(walk)} depth images' in note and '"map"' in note for note in result.notes)
    alone = next(file for file in bag.iterdir() if file.suffix in ('.mcap', '.db3'))
    assert [o.mass_kg for o in parsed(alone, device).objects] == [o.mass_kg for o in result.objects]


def test_bags_are_played_at_their_pace(walk, tmp_path):
    """Image by image, as a converted one has them; a second of the bag takes a fifth of one at a rate of five."""
    bag, played, converted = write_bag(tmp_path / 'bag', 'mcap', depth_messages(walk[:6], '16UC1')), tmp_path / 'played', tmp_path / 'converted'
    begun = time.monotonic()
    with concurrent.futures.ThreadPoolExecutor(1) as pool:
        playing = pool.submit(topple.formats.play, bag, played, rate=5)
        counts = []
        while not playing.done():
            counts.append(len((played / 'trajectory.txt').read_text().splitlines()) if (played / 'trajectory.txt').exists() else 0)
            time.sleep(0.05)
    assert time.monotonic() - begun >= 5 / 5 and len(set(counts)) >= 4 and counts == sorted(counts)
    assert any('6 of the 6 depth images' in note for note in playing.result())
    topple.formats.convert(bag, converted)
    for name in ('intrinsics.json', 'trajectory.txt', *(f'depth/{n:06d}.png' for n in range(6))):
        assert (played / name).read_bytes() == (converted / name).read_bytes(), name
    for source, out, rate, words in ((bag, played, 1, 'is there already'), (bag, tmp_path / 'a', 0, 'rate 0'), (played, tmp_path / 'a', 1, 'is no bag'),
                                     (tmp_path / 'missing', tmp_path / 'a', 1, 'is not there')):
        with pytest.raises(topple.Error, match=words):
            topple.formats.play(source, out, rate=rate)


def played_messages(bag, **options):
    """As `topple live -` reads them: each message, and what is left after its line up to the next."""
    stream = io.BytesIO()
    topple.formats.play(bag, stream, rate=1000, **options)
    stream.seek(0)
    pixels = 0
    while line := stream.readline():
        message = json.loads(line)
        count = message.get('count', pixels)
        pixels = message['intrinsics']['width'] * message['intrinsics']['height'] if 'intrinsics' in message else pixels
        each = {'frame': 2, 'points': 12}.get(message.get('add'), 0)
        yield message, stream.read(each * count), stream.read(3 * count if message.get('rgb') else 0)


def test_bags_are_played_as_messages(walk, points, tmp_path):
    """Depth frames as a folder has them; clouds of a bag that has none, or that are asked for, in their sensor's axes."""
    kind = 'sensor_msgs/msg/PointCloud2'
    turn = np.array([[0, -1, 0, 1], [1, 0, 0, 2], [0, 0, 1, 0.5], [0, 0, 0, 1.0]])
    seen = (points - turn[:3, 3]) @ turn[:3, :3]
    clouds = [('/tf_static', 'tf2_msgs/msg/TFMessage', 0, tf((0, 'map', 'lidar', turn))),
              ('/points', kind, SECOND, point_cloud(SECOND, seen, 'lidar', colours_of(points))),
              ('/points', kind, 2 * SECOND, point_cloud(2 * SECOND, seen[::2], 'lidar', colours_of(points)[::2]))]
    depth = depth_messages(walk[:3], '16UC1')
    first, *frames = played_messages(write_bag(tmp_path / 'frames', 'mcap', depth))
    assert first[0]['intrinsics']['fx'] == CAMERA.fx and len(frames) == 3
    for (message, readings, _), (pose, metres) in zip(frames, walk):
        assert np.allclose(message['pose'], pose.ravel(), atol=1e-9)
        assert np.array_equal(np.frombuffer(readings, '<u2').reshape(metres.shape), np.round(1000 * metres))
    for bag, options in ((write_bag(tmp_path / 'clouds', 'sqlite3', clouds), {}), (write_bag(tmp_path / 'both', 'mcap', depth + clouds), {'topic': '/points'})):
        sweeps = list(played_messages(bag, **options))
        assert [message['count'] for message, *_ in sweeps] == [len(points), len(points[::2])]
        message, places, colours = sweeps[0]
        assert np.array_equal(np.frombuffer(places, '<f4').reshape(-1, 3), seen.astype(np.float32))
        assert np.array_equal(np.frombuffer(colours, np.uint8).reshape(-1, 3), colours_of(points)) and np.allclose(message['pose'], turn.ravel())
    with pytest.raises(topple.Error, match='can be played to "-"'):
        topple.formats.play(tmp_path / 'clouds', tmp_path / 'folder')
    assert not (tmp_path / 'folder').exists()


def picture(time, pixels, frame, encoding='bgr8'):
    channels = pixels[:, :, ::-1] if encoding == 'bgr8' else pixels
    return TYPES['sensor_msgs/msg/Image'](header=header(time, frame), height=pixels.shape[0], width=pixels.shape[1], encoding=encoding,
                                          is_bigendian=0, step=3 * pixels.shape[1], data=np.ascontiguousarray(channels).ravel())


@pytest.mark.parametrize('storage, beside', [('mcap', 0.0), ('sqlite3', 0.06)])
def test_colours_are_laid_on_depth_images(walk, tmp_path, storage, beside):
    """Of a camera of twice the size, in the same place or 6 cm to the right of it."""
    image_of = pytest.importorskip('PIL.Image')
    right = np.eye(4)
    right[0, 3] = beside
    messages = depth_messages(walk[:3], '16UC1')
    frame = 'colour' if beside else 'optical'
    messages[0][3].transforms.extend(tf((0, 'optical', 'colour', right)).transforms)
    info = camera_info()
    k = np.array([2 * CAMERA.fx, 0, 2 * CAMERA.cx + 0.5, 0, 2 * CAMERA.fy, 2 * CAMERA.cy + 0.5, 0, 0, 1])
    info = TYPES['sensor_msgs/msg/CameraInfo'](**{name: getattr(info, name) for name in info.__dataclass_fields__ if name != '__msgtype__'}
                                               | {'k': k, 'width': 2 * CAMERA.width, 'height': 2 * CAMERA.height})
    columns = np.zeros((2 * CAMERA.height, 2 * CAMERA.width, 3), np.uint8)
    columns[..., 0] = 1 + np.arange(2 * CAMERA.width) // 2  # red tells the column
    columns[..., 2] = 9
    for n in range(2):  # the third has none
        time = (n + 1) * SECOND + 20_000_000
        messages += [('/camera/color/camera_info', 'sensor_msgs/msg/CameraInfo', time, info),
                     ('/camera/color/image_raw', 'sensor_msgs/msg/Image', time, picture(time, columns, frame)),
                     ('/camera/color/image_raw', 'sensor_msgs/msg/Image', time + 200_000_000, picture(time + 200_000_000, 0 * columns, frame))]
    messages.sort(key=lambda message: message[2])
    done = topple.formats.convert(write_bag(tmp_path / 'bag', storage, messages), tmp_path / 'out')
    assert any(note.startswith('2 of them have colours, of the images of /camera/color/image_raw') for note in done.notes)
    assert sorted(file.name for file in (tmp_path / 'out' / 'color').iterdir()) == ['000000.png', '000001.png']
    got = np.array(image_of.open(tmp_path / 'out' / 'color' / '000001.png')).astype(int)
    expected = 1 + np.arange(CAMERA.width) - beside * CAMERA.fx / walk[1][1]
    inside = (expected >= 2) & (expected < CAMERA.width - 1)
    assert inside.mean() > 0.8 and np.abs(got[..., 0] - expected)[inside].max() <= 1 and set(got[inside][:, 2]) == {9}


@pytest.mark.parametrize('kind, within', [('16UC1', 1e-9), ('32FC1', 0.02)])
def test_compressed_depth_images(walk, tmp_path, kind, within):
    pytest.importorskip('PIL')
    messages = depth_messages(walk[:3], '16UC1')
    packed = []
    for topic, name, time, message in messages:
        if 'image' in topic:
            depth = walk[time // SECOND - 1][1]
            topic, name, message = f'{topic}/compressedDepth', 'sensor_msgs/msg/CompressedImage', packed_image(time, depth, kind)
        packed.append((topic, name, time, message))
    path = write_bag(tmp_path / 'packed', 'mcap', packed)
    with ros_bag.Bag(path, Budget(path, topple.formats.Options())) as bag:
        seen = [ros_bag._depth(message, bag.path, bag.budget) for _, message in bag.messages('/camera/depth/image_raw/compressedDepth')]
    for got, (_, depth) in zip(seen, walk):
        assert got == pytest.approx(depth, rel=within)
    done = topple.formats.convert(tmp_path / 'packed', tmp_path / 'out')
    assert any('3 of the 3' in note for note in done.notes)


def test_frames_of_a_camera_that_stands_are_taken_once(walk, tmp_path):
    messages = depth_messages(walk[:2], '16UC1')
    later = int(2.2 * SECOND)
    messages.append(('/camera/depth/image_raw', 'sensor_msgs/msg/Image', later, image(later, walk[1][1], '16UC1')))
    done = topple.formats.convert(write_bag(tmp_path / 'bag', 'mcap', messages), tmp_path / 'out')
    assert sorted(file.name for file in (tmp_path / 'out' / 'depth').iterdir()) == ['000000.png', '000001.png']
    assert any('2 of the 3' in note for note in done.notes)
    written = np.loadtxt(tmp_path / 'out' / 'trajectory.txt').reshape(-1, 3, 4)
    assert np.abs(written - np.array(POSES[:2])[:, :3]).max() < 1e-9


def test_clouds(points, ply, device, tmp_path):
    kind = 'sensor_msgs/msg/PointCloud2'
    turn = np.array([[0, -1, 0, 1], [1, 0, 0, 2], [0, 0, 1, 0.5], [0, 0, 0, 1.0]])
    seen = (points - turn[:3, 3]) @ turn[:3, :3]
    bag = write_bag(tmp_path / 'bag', 'sqlite3', [
        ('/tf_static', 'tf2_msgs/msg/TFMessage', 0, tf((0, 'map', 'lidar', turn))),
        ('/points', kind, SECOND, point_cloud(SECOND, seen, 'lidar', colours_of(points)))])
    with topple.formats.opened(bag) as converted:
        text = converted.path.read_bytes()[:300]
        assert b'VIEWPOINT 1.0 2.0 0.5' in text and b'rgb' in text
    # Without tf nothing is known of the sensor, as of points in a PLY.
    plain = write_bag(tmp_path / 'plain', 'mcap', [('/points', kind, SECOND, point_cloud(SECOND, points, 'map', colours_of(points)))])
    same_objects(parsed(plain, device), ply, within=1e-6)


def test_clouds_of_ros_1(points, tmp_path):
    from rosbags.rosbag1 import Writer
    store = get_typestore(Stores.ROS1_NOETIC)
    kind = 'sensor_msgs/msg/PointCloud2'
    message = point_cloud(SECOND, points, 'map', colours_of(points))
    header_of, fields = store.types['std_msgs/msg/Header'], store.types['sensor_msgs/msg/PointField']
    values = {name: getattr(message, name) for name in message.__dataclass_fields__ if name != '__msgtype__'}
    values['header'] = header_of(seq=1, stamp=store.types['builtin_interfaces/msg/Time'](1, 0), frame_id='map')
    values['fields'] = [fields(f.name, f.offset, f.datatype, f.count) for f in message.fields]
    with Writer(tmp_path / 'room.bag') as writer:
        connection = writer.add_connection('/points', kind, typestore=store)
        writer.write(connection, SECOND, store.serialize_ros1(store.types[kind](**values), kind))
    topple.formats.convert(tmp_path / 'room.bag', tmp_path / 'room.ply')
    head, _, body = (tmp_path / 'room.ply').read_bytes().partition(b'end_header\n')
    records = np.frombuffer(body, [('xyz', '<f4', 3), ('rgb', 'u1', 3)])
    assert np.array_equal(records['xyz'], points) and np.array_equal(records['rgb'], colours_of(points))


def test_many_clouds_become_one(points, device, tmp_path):
    kind = 'sensor_msgs/msg/PointCloud2'
    bag = write_bag(tmp_path / 'bag', 'mcap', [('/points', kind, n * SECOND, point_cloud(n * SECOND, points[n::3], 'map')) for n in range(3)]
                    + [('/points', kind, 4 * SECOND, point_cloud(4 * SECOND, points, 'map'))])
    with topple.formats.opened(bag) as converted:
        assert any('4 clouds' in note for note in converted.notes)
        count = int(converted.path.read_bytes().split(b'POINTS ')[1].split()[0])
    cells = len(np.unique(np.floor(points.astype(float) / ros_bag.CELL_M), axis=0))
    assert count == cells


def test_mcap_of_another_writer(walk, sequence, device, tmp_path):
    writer_of = pytest.importorskip('mcap_ros2.writer')
    path = tmp_path / 'scan.mcap'
    with open(path, 'wb') as file:
        writer = writer_of.Writer(file)
        schemas = {}
        for topic, kind, time, message in depth_messages(walk, '16UC1'):
            if kind not in schemas:
                text = STORE.generate_msgdef(kind, ros_version=2)[0]
                schemas[kind] = writer.register_msgdef(kind, text)
            writer.write_message(topic=topic, schema=schemas[kind], message=plain(message), log_time=time, publish_time=time)
        writer.finish()
    same_objects(parsed(path, device), sequence, within=0.02)


def plain(value):
    """A message as nested dictionaries."""
    if hasattr(value, '__msgtype__'):
        return {name: plain(getattr(value, name)) for name in value.__dataclass_fields__ if name != '__msgtype__'}
    if isinstance(value, np.ndarray):
        return value.tobytes() if value.dtype == np.uint8 else value.tolist()
    return [plain(one) for one in value] if isinstance(value, list) else value


def test_tf_lies_between_its_messages():
    found = Transforms()
    quarter = np.array([[0, -1, 0, 2], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]])
    found.add(tf((0, 'map', 'body', np.eye(4)), (SECOND, 'map', 'body', quarter)), fixed=False)
    found.sort()
    half = found.to_root('body', SECOND // 2)
    assert half[:3, 3] == pytest.approx([1, 0, 0]) and half[0, 0] == pytest.approx(np.sqrt(0.5)) and half[1, 0] == pytest.approx(np.sqrt(0.5))
    assert found.to_root('body', 3 * SECOND) is None and np.array_equal(found.to_root('map', 0), np.eye(4))
    found.add(tf((0, 'body', 'map', np.eye(4))), fixed=True)
    assert found.root_of('body') == 'body'  # of a loop, which has no end


def test_bags_that_are_wrong(walk, device, tmp_path):
    messages = depth_messages(walk[:3], '16UC1')
    bag = write_bag(tmp_path / 'bag', 'mcap', messages)
    file = next(bag.glob('*.mcap'))
    refused(truncated(file), device)
    without_tf = write_bag(tmp_path / 'still', 'mcap', [m for m in messages if m[0] not in ('/tf',)])
    assert [o.id for o in parsed(without_tf, device).objects][0] == 0  # one place for all: the body's
    unplaced = write_bag(tmp_path / 'unplaced', 'mcap', [
        (topic, kind, time + 90 * SECOND, image(time + 90 * SECOND, walk[0][1], '16UC1')) if 'image' in topic else (topic, kind, time, message)
        for topic, kind, time, message in messages])
    refused(unplaced, device, 'tf does not say where optical was')
    no_info = write_bag(tmp_path / 'no-info', 'sqlite3', [m for m in messages if 'info' not in m[0]])
    refused(no_info, device, 'camera_info')
    nothing = write_bag(tmp_path / 'nothing', 'mcap', [m for m in messages if m[0] == '/tf'])
    refused(nothing, device, 'no depth image', 'tf2_msgs/msg/TFMessage')
    other = tmp_path / 'other.db3'
    other.write_bytes(b'no database')
    refused(other, device)
    with raises('usage', '/nowhere'):
        topple.formats.convert(bag, tmp_path / 'out', topple.formats.Options(topic='/nowhere'))
