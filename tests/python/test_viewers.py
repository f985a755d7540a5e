# SPDX-License-Identifier: MIT
"""topple.to_mcap, topple.to_rerun and topple.plot: what viewers get is what the Result says."""
import os
import subprocess
import sys

import numpy as np
import pytest

import topple
from others import raises
from topple import geometry


@pytest.fixture(scope='module')
def shaken(points, device):
    return topple.parse(points, device=device, disturbances=['earthquake', 'wind'])


def movable(result):
    return [o for o in result.objects if not o.grounded]


def test_boxes_hold_their_objects(result):
    boxes = {box.object: box for box in geometry.boxes(result)}
    assert set(boxes) == {o.id for o in movable(result)}
    axes = geometry.room_axes(result)
    for o in movable(result):
        box = boxes[o.id]
        # A voxel on each side, and one where the foot of another thing blurs an edge.
        assert box.size == pytest.approx(o.size_m, abs=3.1 * result.voxel_size_m)
        inside = np.abs(axes @ (np.array(o.center_of_mass_m) - box.centre)) <= box.size / 2
        assert inside.all()


def test_quaternions_turn_as_their_matrices_do():
    random = np.random.default_rng(4)
    for _ in range(50):
        q = random.normal(size=4)
        matrix = topple.formats.frames.rotation(*q)
        got = geometry.quaternion(matrix)
        assert topple.formats.frames.rotation(*got) == pytest.approx(matrix, abs=1e-12)


def cloud_of(message):
    kinds = {7: '<f4', 6: '<i4'}
    layout = np.dtype({'names': [f.name for f in message.fields], 'formats': [kinds[f.type] for f in message.fields],
                       'offsets': [f.offset for f in message.fields], 'itemsize': message.point_stride})
    return np.frombuffer(message.data, layout)


def test_mcap(result, points, tmp_path):
    pytest.importorskip('mcap_protobuf')
    pytest.importorskip('foxglove_schemas_protobuf')
    from mcap.reader import make_reader
    from mcap_protobuf.decoder import DecoderFactory
    (tmp_path / 'scene.mcap').write_bytes(b'an older one')
    topple.to_mcap(result, tmp_path / 'scene.mcap')
    with open(tmp_path / 'scene.mcap', 'rb') as file:
        read = {channel.topic: (schema.name, message) for schema, channel, _, message in
                make_reader(file, decoder_factories=[DecoderFactory()]).iter_decoded_messages()}
    assert {topic: name for topic, (name, _) in read.items()} == {
        '/tf': 'foxglove.FrameTransform', '/points': 'foxglove.PointCloud', '/solids': 'foxglove.PointCloud', '/objects': 'foxglove.SceneUpdate',
        '/supports': 'foxglove.SceneUpdate', '/contacts': 'foxglove.SceneUpdate', '/fields/wind': 'foxglove.PointCloud'}
    cloud = cloud_of(read['/points'][1])
    assert np.array_equal(np.stack([cloud[c] for c in 'xyz'], axis=1), points) and np.array_equal(cloud['object'], result.point_object)
    unsafety = np.array([o.unsafety for o in result.objects], np.float32)
    on_objects = cloud['object'] >= 0
    assert np.array_equal(cloud['unsafety'][on_objects], unsafety[cloud['object'][on_objects]], equal_nan=True)
    assert len(cloud_of(read['/solids'][1])) == len(result.solid['x'])
    assert len(cloud_of(read['/fields/wind'][1])) == len(result.fields['wind']['density'])
    objects = {entity.id: entity for entity in read['/objects'][1].entities}
    assert set(objects) == {f'object_{o.id}' for o in movable(result)}
    for o in movable(result):
        facts = {pair.key: pair.value for pair in objects[f'object_{o.id}'].metadata}
        assert float(facts['barrier_J']) == pytest.approx(o.barrier_J, rel=1e-5) and facts['why'] == o.why
    assert len(read['/supports'][1].entities[0].arrows) == len(result.supports)
    assert len(read['/contacts'][1].entities[0].lines[0].points) == 2 * len(result.contacts)
    q = read['/tf'][1].rotation
    up = topple.formats.frames.rotation(q.x, q.y, q.z, q.w) @ result.up
    assert up == pytest.approx([0, 0, 1], abs=1e-6)
    assert os.listdir(tmp_path) == ['scene.mcap']


def test_mcap_that_fails_leaves_nothing(result, tmp_path):
    pytest.importorskip('mcap_protobuf')
    (tmp_path / 'taken').mkdir()
    with pytest.raises(OSError):
        topple.to_mcap(result, tmp_path / 'taken')
    assert os.listdir(tmp_path) == ['taken']


def test_rerun(result, tmp_path):
    rerun = pytest.importorskip('rerun')
    recording = rerun.RecordingStream('topple-test')
    topple.to_rerun(result, save=tmp_path / 'scene.rrd', recording=recording)
    recording.disconnect()
    data = (tmp_path / 'scene.rrd').read_bytes()
    assert len(data) > 12 * len(result.xyz)
    wanted = ['scan/points', 'scan/objects', 'contacts', 'supports', 'fields/wind', 'risk/wind'] + [f'objects/object_{o.id}' for o in movable(result)]
    for path in wanted:
        assert path.encode() in data, path


def test_rerun_follows_a_scan_by_frames(result, tmp_path):
    rerun = pytest.importorskip('rerun')
    recording = rerun.RecordingStream('topple-test')
    recording.save(tmp_path / 'live.rrd')
    for frame in (3, 7):
        topple.to_rerun(result, recording=recording, frame=frame)
    recording.disconnect()
    data = (tmp_path / 'live.rrd').read_bytes()
    assert len(data) > 24 * len(result.xyz) and b'frame' in data and b'ClearIsRecursive' in data


def test_rerun_asks_where_to(result):
    with raises('usage', 'save='):
        topple.to_rerun(result)


@pytest.fixture
def pyplot():
    pytest.importorskip('matplotlib').use('Agg')
    from matplotlib import pyplot
    yield pyplot
    pyplot.close('all')


def test_plan(shaken, pyplot, tmp_path):
    axes = topple.plot.plan(shaken)
    written = {text.get_text() for text in axes.texts}
    assert written == {str(o.id) for o in movable(shaken)}
    ranks = axes.images[1].get_array().compressed()
    assert set(np.round(ranks, 6)) <= {round(o.unsafety, 6) for o in movable(shaken)} and len(ranks) > 50
    # An object's cells lie where it is: their middle is its own, as it is a box.
    x0, x1, y0, y1 = axes.images[1].get_extent()
    shown = axes.images[1].get_array().filled(np.nan)
    crate = max(movable(shaken), key=lambda o: o.mass_kg)
    rows, columns = np.nonzero(np.isfinite(shown))
    middle = [x0 + (columns.mean() + 0.5) * (x1 - x0) / shown.shape[1], y0 + (rows.mean() + 0.5) * (y1 - y0) / shown.shape[0]]
    assert middle == pytest.approx((geometry.room_axes(shaken) @ crate.center_of_mass_m)[:2], abs=0.05)
    assert np.isfinite(axes.images[0].get_array().filled(np.nan)).sum() > 100  # walls
    axes.figure.savefig(tmp_path / 'plan.pdf')
    boxes = [text.get_window_extent() for text in axes.texts]
    assert not any(one.overlaps(other) for n, one in enumerate(boxes) for other in boxes[:n])
    risk = topple.plot.plan(shaken, by='wind', labels=False)
    assert not risk.texts and risk.images[1].get_array().max() == pytest.approx(max(o.risk_J['wind'] for o in movable(shaken)))
    with pytest.raises(topple.Error, match="'earthquake' or 'wind'"):
        topple.plot.plan(shaken, by='human')


def test_curves(shaken, pyplot):
    item = max((o for o in movable(shaken) if len(o.instability)), key=lambda o: o.unsafety)  # the crate lies lowest as it is
    x, y = topple.plot.instability(item).lines[0].get_data()
    assert np.array_equal(x[1:-1], item.instability[:, 0]) and np.array_equal(y[1:-1], item.instability[:, 1]) and y[0] == 0
    axes = topple.plot.fragility(item)
    assert np.array_equal(np.stack(axes.lines[0].get_data(), axis=1), item.fragility.counted)
    if np.isfinite(item.fragility.pga_g):
        peaks, chance = axes.lines[1].get_data()
        assert np.interp(item.fragility.pga_g, peaks, chance) == pytest.approx(0.5, abs=0.01)
    compass = topple.plot.barriers(item)
    polar = compass.lines[0].get_data()[1]
    assert f'Object {item.id}' in compass.get_title() and '(J)' in compass.get_title()
    assert np.array_equal(polar[:-1], item.barrier_by_direction.push_J, equal_nan=True)
    tree = topple.plot.disconnectivity(item)
    poses = item.landscape
    assert poses.up.shape == (len(poses.energy_J), 3) and np.linalg.norm(poses.up, axis=1) == pytest.approx(1)
    assert np.all(np.diff(poses.energy_J) >= 0) and poses.joins[0] == -1 and np.isinf(poses.joins_at_J[0])
    leaves = {note.get_text(): note.xy for note in tree.texts}
    shown = [text for text in leaves if not text.startswith('fallen')]
    assert sorted(shown, key=int) == [str(n + 1) for n in range(min(10, len(poses.energy_J)))]
    heights = sorted(leaves[text][1] for text in shown)
    assert set(np.round(heights, 9)) <= set(np.round(poses.energy_J, 9)) and f'Object {item.id}' in tree.get_title()
    lines = np.concatenate([line.get_ydata() for line in tree.lines])
    finite = poses.joins_at_J[np.isfinite(poses.joins_at_J)]
    assert lines.max() >= (finite.min() if len(finite) else 0)
    with pytest.raises(topple.Error, match=r"^barriers: axes must be polar: matplotlib's subplots\(subplot_kw=") as raised:
        topple.plot.barriers(item, axes=tree)
    assert raised.value.kind == 'usage' and topple.plot.barriers(item, axes=compass) is compass
    ground = next(o for o in shaken.objects if o.grounded)
    for plot in (topple.plot.instability, topple.plot.fragility, topple.plot.barriers, topple.plot.disconnectivity):
        with pytest.raises(topple.Error, match=f'object {ground.id}'):
            plot(ground)


def test_nothing_of_this_is_imported_with_topple():
    code = 'import sys, topple; print(sorted(set(sys.modules) & {"matplotlib", "rerun", "mcap", "laspy", "pye57", "rosbags", "PIL"}))'
    assert subprocess.run([sys.executable, '-c', code], capture_output=True, text=True, check=True).stdout.strip() == '[]'
