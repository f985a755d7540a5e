# SPDX-License-Identifier: MIT
"""topple.parse: what it takes, what it gives, and how it is stopped."""
import gc
import json
import os
import pickle
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import topple
from others import Exported, raises
from made_scans import CAMERA, POSES, colours_of, seen_from


def quick(points, device, **options):
    return topple.parse(points, device=device, disturbances=[], **options)


def test_finds_what_is_there(result, points):
    boxes = [o for o in result.objects if not o.grounded]
    assert len(boxes) >= 2
    assert result.backend == 'native' and result.source == 'points'
    top = result.point_object[(np.abs(points[:, 2] - 0.85) < 0.01) & (np.abs(points[:, 0] - 1.3) < 0.05)]
    upper = result.objects[np.bincount(top[top >= 0]).argmax()]
    assert not upper.grounded and upper.barrier_J > 0 and upper.risk_J['wind'] >= 0
    tips = upper.overturning
    assert 0 < tips.tilt_deg < 90 and tips.tilt_error_deg > 0 and tips.push_N > 0 and 0 < tips.shake_g <= 0.3
    assert np.isnan(upper.fragility.pga_g) and upper.fragility.counted.shape == (0, 2)  # no earthquake was asked for
    assert np.isnan(result.objects[0].overturning.tilt_deg) or not result.objects[0].grounded
    assert set(upper.risk_error_J) == {'wind'} and upper.risk_error_J['wind'] >= upper.risk_spread_J['wind'] >= 0
    assert upper.unsafety_category in ('none', 'low', 'medium', 'high') and upper.unsafety_certain in (True, False)
    assert upper.fall.hits_J > 0 and upper.fall.people_share is None and len(upper.fall.lands_m) == 3  # no walks were asked for
    assert upper.why.endswith('.') and upper.instability.shape[1] == 2
    assert {(s.supporter, s.supported) for s in result.supports} == {
        (lower, o.id) for o in result.objects for lower in o.stands_on}
    assert {c.relation for c in result.contacts} <= {'fixed', 'support', 'adjacent'}
    assert sum(p.points for p in result.primitives) == np.count_nonzero(result.point_primitive >= 0)
    assert set(result.fields) == {'wind'} and len(result.solid['state']) > 1000
    assert result.timings_s['normals'] > 0 and result.notes


def test_says_who_passes_where_things_land(points, device):
    parsed = topple.parse(points, device=device, disturbances='human', walks=50)
    shares = [o.fall.people_share for o in parsed.objects if not o.grounded]
    assert shares and all(0 <= share <= 1 for share in shares)
    assert all(o.fall.people_share is None for o in parsed.objects if o.grounded)


@pytest.fixture
def record(tmp_path):
    def write(name, step_s, *values):
        lines = [f'{n * step_s} {value}' for n, value in enumerate(values)]
        (tmp_path / name).write_text('\n'.join(['# m/s2', *lines]))
        return tmp_path / name
    return write


def test_takes_the_components_of_a_record(points, device, record):
    shaken = [record(name, 0.1, 0, *values, 0) for name, values in
              [('along', [4, -4] * 8), ('across', [3, -3] * 8), ('up', [2, -2] * 8)]]

    def by(accelerogram):
        parsed = topple.parse(points, device=device, disturbances='earthquake', accelerogram=accelerogram)
        return [note for note in parsed.notes if 'accelerogram' in note], [o.fall_chance['earthquake'] for o in parsed.objects]

    one, two, three = by(str(shaken[0])), by(shaken[:2]), by(tuple(shaken))
    assert by((shaken[0],)) == one == by((shaken[0], None, None))
    assert '4 m/s^2' in one[0][0] and '3.46 m/s^2' in two[0][0] and '3.46 m/s^2' in three[0][0]  # the level ones' mean
    assert by((shaken[0], None, shaken[2]))[0] == one[0]


def test_the_unit_of_a_record_may_be_given(points, device, tmp_path):
    (tmp_path / 'quake.txt').write_text('\n'.join(f'{0.1 * n} {value}' for n, value in enumerate([0, *[100, -100] * 8, 0])))

    def by(**options):
        parsed = topple.parse(points[::6], device=device, disturbances='earthquake', accelerogram=tmp_path / 'quake.txt', **options)
        return next(note for note in parsed.notes if 'accelerogram' in note)
    assert '1 m/s^2' in by(accelerogram_unit='cm/s2')
    with raises('input', r'quake.txt.*name it with accelerogram_unit \(--accelerogram-unit\): g, m/s2 or cm/s2'):
        by()
    for unit, options in (('ft', {'accelerogram': tmp_path / 'quake.txt'}), ('g', {})):
        with raises('usage', '^accelerogram_unit'):
            topple.parse(points, device=device, accelerogram_unit=unit, **options)


def walking(file, unit=1.0, up=2):
    """Writes a table of a body that swings its leg, without times."""
    across = [axis for axis in range(3) if axis != up]
    columns, rows = [f'{joint}.{axis}' for joint in ('l_hip', 'l_knee', 'l_ankle', 'r_hip') for axis in 'xyz'], []
    for n in range(120):
        swing, row = 0.1 * np.sin(n / 10), []
        for height, ahead, left in ((0.9, 0, 0.1), (0.45, swing, 0.1), (0.05, 2 * swing, 0.1), (0.9, 0, -0.1)):
            place = [0.0, 0.0, 0.0]
            place[up], place[across[0]], place[across[1]] = height / unit, ahead / unit, left / unit
            row += place
        rows.append(' '.join(f'{value:.6g}' for value in row))
    file.write_text('\n'.join([' '.join(columns), *rows]))
    return file


def test_what_a_recording_does_not_say_may_be_given(points, device, tmp_path):
    plain = walking(tmp_path / 'plain.csv')

    def by(**options):
        parsed = topple.parse(points[::6], device=device, disturbances='human', walks=40, **options)
        return np.stack([parsed.fields['human'][name] for name in ('vx', 'vy', 'vz', 'density')])
    expected = by(motion=plain, motion_rate=np.float32(60))
    odd = by(motion=[walking(tmp_path / 'odd.csv', 0.0312, 0)], motion_rate=60, motion_unit=0.0312, motion_up=(1, 0, 0))
    assert np.abs(expected).max() > 0 and np.allclose(odd, expected, rtol=1e-3, atol=1e-3)
    for options, words in (({'motion': plain}, r'motion_rate \(--motion-rate\)'), ({'motion': plain, 'motion_rate': 60, 'motion_unit': 10}, 'tall'),
                           ({'motion': plain, 'motion_rate': 0}, r'^motion_rate \(--motion-rate\) 0: expected a number above 0'),
                           ({'motion': plain, 'motion_rate': 60, 'motion_up': (0, 0, 0)}, r'^motion_up \(--motion-up\): expected three numbers, not all zero'),
                           ({'motion_rate': 60}, 'there is no motion')):
        with pytest.raises(topple.Error, match=words):
            topple.parse(points, device=device, **options)


@pytest.mark.parametrize('wrong', [(), ('a', 'b', 'c', 'd'), (None, 'b')])
def test_a_record_has_one_to_three_components(points, device, wrong):
    with raises('usage', 'along, across and up'):
        topple.parse(points, device=device, accelerogram=wrong)


def test_components_of_different_steps_are_refused(points, device, record):
    with pytest.raises(topple.Error, match='components of one record'):
        topple.parse(points, device=device, accelerogram=(record('a', 0.01, 1, -1, 1), record('b', 0.02, 1, -1, 1)))


def test_arrays_are_the_results_own(result, points):
    for name in ('point_object', 'point_primitive', 'point_region'):
        array = getattr(result, name)
        assert array.dtype == np.int32 and array.shape == (len(points),)
        assert np.shares_memory(array, getattr(result, name))
    assert np.shares_memory(result.normals[2], result.normals[2])
    assert all(np.shares_memory(c, points) for c in result._axes())
    assert len(result.point_index) == 0
    assert np.shares_memory(np.from_dlpack(result.point_object), result.point_object)


def test_arrays_outlive_the_result(points, device):
    parsed = quick(points, device)
    labels, item, expected = parsed.point_object, parsed.objects[-1], parsed.point_object.copy()
    number = item.id
    del parsed
    gc.collect()
    assert np.array_equal(labels, expected) and item.id == number


def wide(points):
    records = np.zeros((len(points), 5), np.float32)
    records[:, 1:4] = points
    return records[:, 1:4]


def fields(points):
    records = np.zeros(len(points), [('x', 'f4'), ('colour', 'u1', 3), ('y', 'f4'), ('z', 'f4')])
    for axis, name in enumerate('xyz'):
        records[name] = points[:, axis]
    return records


@pytest.mark.parametrize('layout', [wide, fields, np.asfortranarray, np.float64, Exported,
                                    lambda p: tuple(np.ascontiguousarray(c) for c in p.T)])
def test_takes_every_layout(points, result, device, layout):
    assert np.array_equal(quick(layout(points), device).point_object, result.point_object)


def test_float32_is_not_copied(points, device):
    for given in (points, wide(points), np.asfortranarray(points)):
        assert np.shares_memory(quick(given, device)._axes()[1], given)


def test_points_that_are_not_finite_are_left_out(points, result, device):
    spoilt = np.concatenate([points[:5], [[np.nan, 0, 0]], points[5:]]).astype(np.float32)
    parsed = quick(spoilt, device)
    assert np.array_equal(parsed.point_object, result.point_object)
    assert parsed.point_index[4] == 4 and parsed.point_index[5] == 6
    assert np.array_equal(parsed.xyz, points)


@pytest.mark.parametrize('given, words', [
    (np.zeros((30, 4), np.float32), 'points: expected floats of shape (N, 3), not float32 of shape (30, 4); '
                                    'points[:, :3] takes the first three columns'),
    (np.zeros((30, 2), np.float32), 'points: expected floats of shape (N, 3), not float32 of shape (30, 2)'),
    (np.zeros((3, 30), np.float32), 'not float32 of shape (3, 30); points.T has a row'),
    (np.zeros((4, 5, 3), np.float32), 'points.reshape(-1, 3) has a row'),
    ([[1, 2, 3]] * 9, "np.array(points, 'float32') converts integers"),
    (np.random.default_rng(1).random((3000, 3)).astype(np.float32) * 3000, 'in mm, multiply them by 0.001 (3.0 m), in cm by 0.01 (30 m), else'),
    (np.random.default_rng(1).random((3000, 3)).astype(np.float32) * 938, 'in mm, multiply them by 0.001 (0.94 m), in cm by 0.01 (9.4 m), in inches by'),
    (np.zeros((30, 3), int), "not int64 of shape (30, 3); points.astype('float32') converts"),
    (np.zeros((30, 4), np.int32), "points[:, :3].astype('float32')"),
    ((np.zeros(3, np.float32),) * 2 + (np.zeros(3, int),), "points z: expected floats of shape (N,), not int64 of shape (3,); z.as"),
    (np.zeros(5, [('x', 'f4'), ('y', 'f4')]), 'the records have no field z'),
    (np.zeros((4, 3), np.float32), 'points: 4 points were found, but the smallest solid takes 8'),
    (np.full((40, 3), np.nan, np.float32), 'none of its 40 points is finite'),
    ('nowhere--up.ply', 'nowhere--up.ply'),
])
def test_errors_say_what_is_wrong(given, words, device):
    with pytest.raises(topple.Error) as raised:
        quick(given, device)
    message = str(raised.value)
    assert words in message
    assert ('[:, :3]' in message) == (np.ndim(given) == 2 and np.shape(given)[0] != 3 < np.shape(given)[1])
    usage = 'expected' in message or 'field' in message
    assert raised.value.kind == ('usage' if usage else 'input')


class Frame:
    """Named columns, as pandas and polars have them."""

    def __init__(self, **columns):
        self._columns, self.columns = columns, list(columns)

    def __getitem__(self, name):
        return self._columns[name]


def by_name(points, **more):
    return Frame(z=points[:, 2], x=points[:, 0], **more, y=points[:, 1])


def test_takes_tables_and_masked_arrays(points, result, device):
    for given in (by_name(points, colour=None), {'y': points[:, 1], 'z': points[:, 2], 'x': points[:, 0]}, np.ma.masked_array(points),
                  points.astype('>f4')):
        assert np.array_equal(quick(given, device).point_object, result.point_object)
    masked = np.ma.masked_array(np.concatenate([points[:5], [[9, 9, 9]], points[5:]]).astype(np.float32), False)
    masked[5, 1] = np.ma.masked
    parsed = quick(masked, device)
    assert np.array_equal(parsed.point_object, result.point_object) and parsed.point_index[5] == 6
    red = np.full(len(points), 200, np.uint8)
    quick(points, device, colours={'green': red, 'blue': red, 'red': red}, viewpoint=Frame(vp_x=red / 100, vp_y=red / 100, vp_z=red / 100))
    coarse = quick(points.astype(np.float16), device)  # to 2 mm
    assert len(coarse.objects) == len(result.objects)


class Open3D:
    points = np.zeros((30, 3))


class Learnt:
    def __dlpack__(self, **options):
        raise RuntimeError("Can't export tensors that require gradient, use tensor.detach()")


@pytest.mark.parametrize('given, words', [
    (np.zeros((4, 30), np.float32), 'points[:3].T has a row for each point'),
    (np.zeros(30, np.float32), 'points.reshape(-1, 3) has a row for each point'),
    (np.zeros((9, 3), object), "points.astype('float32') converts them"),
    (np.ma.masked_less(np.arange(30).reshape(10, 3), 4), 'points: a masked array of int64'),
    (Open3D(), 'of a point cloud of Open3D give np.asarray(points.points)'),
    (Learnt(), 'give .detach()'),
    (Frame(X=1, y=2, z=3), "points: there is no column 'x', but 'X', 'y', 'z'"),
    ({'x': [0.5], 'y': [0.5]}, "points: there is no column 'z'"),
    (Frame(x=np.zeros(3, int), y=np.zeros(3), z=np.zeros(3)), "points['x'].astype('float32') converts integers"),
])
def test_what_others_hold_is_told_how_to_give(given, words, device):
    with pytest.raises(topple.Error) as raised:
        quick(given, device)
    assert words in str(raised.value) and raised.value.kind == 'usage'


def test_a_peak_in_another_unit_is_told(points, device):
    notes = topple.parse(points, device=device, disturbances='earthquake', pga_m_s2=0.3).notes
    assert notes[0] == 'pga_m_s2 (--pga) = 0.3 is 0.031 g (light shaking, intensity IV): for 0.3 g give pga_m_s2 (--pga) = 2.94.'
    assert sum('pga' in note for note in notes) == 1
    assert not any('pga' in note for note in quick(points, device, pga_m_s2=0.3).notes)


def test_errors_of_options_and_devices(points):
    for option, value, words in (('tile_m', 5, r'^tile_m \(--tile\) 5: only clouds in files'), ('friction', -1, r'^friction \(--friction\) -1: expected'), ('wind_from_deg', 400, r'^wind_from_deg \(--wind-from\) 400: '),
                                 ('max_memory_bytes', 1, r'the 1 B of max_memory_bytes \(--max-memory\): allow that much'),
                                 ('disturbances', ['wind', 'wind'], r'^disturbances \(--disturbance\): wind is given twice; name each once$'),
                                 ('disturbances', 'flood', r'^disturbances \(--disturbance\) flood: expected human, wind, earthquake or reach'),
                                 ('people', 'pets', r'^people \(--people\) pets: expected adults, children, toddlers, elderly or wheelchair$'),
                                 ('people', [], r'^people \(--people\): none is given')):
        with raises('usage' if words[0] == '^' else 'input', words):
            topple.parse(points, **{option: value})
    with raises('usage', r'^backend \(--backend\) abacus is unknown'):
        topple.parse(points, device='abacus')
    assert 'native' in {d.backend for d in topple.devices() if d.usable}
    assert repr(topple.open_device('native')).startswith('<topple.Device native')
    with pytest.raises(TypeError, match='open_device: backend: expected "auto", "native", "opencl" or "vulkan", not 3'):
        topple.open_device(3)
    with pytest.raises(topple.Error, match='threads: expected a whole number, 0 for all cores, not -1'):
        topple.open_device('native', -1)


@pytest.mark.parametrize('name, value', [
    ('up', 'z'), ('up', '0,0,1'), ('up', (0, 0)), ('up', (0, 0, np.nan)), ('voxel_m', '1cm'), ('voxel_m', None), ('wind_from_deg', 'north'),
    ('seed', -1), ('seed', 1.5), ('seed', 1 << 64), ('walks', 1 << 32), ('viewpoint', (0, 0)), ('device', 3), ('disturbances', 3), ('disturbances', [3]),
    ('motion_unit', 'cm'), ('motion_rate', 'fast'), ('motion_up', 'z'), ('motion_up', (0, np.inf, 0)), ('accelerogram_unit', 9.8),
    ('isolate', 'no'), ('progress', 3), ('cancelled', True), ('hazard', 3), ('cache_file', 3), ('motion', 3), ('accelerogram', 3), ('name', 3), ('name', 'a\n'),
    ('corrections', {'do': 'fixed'})])
def test_wrong_types_of_options_are_refused_by_name(points, name, value):
    with pytest.raises(topple.Error, match=f'^{name}: expected') as raised:
        topple.parse(points, **{name: value})
    assert raised.value.kind == 'usage' and repr(value) in str(raised.value) or name == 'corrections'


def test_viewpoints_have_a_row_for_each_point(points, device):
    with pytest.raises(topple.Error, match='viewpoint'):
        quick(points, device, viewpoint=np.zeros((3, 2), 'float32'))
    with pytest.raises(topple.Error, match=f'viewpoint: expected shape .{len(points)}, 3., one for each point, not 3'):
        quick(points, device, viewpoint=np.zeros((3, 3), 'float32'))


def test_viewpoints_that_are_not_finite_are_told(points, device):
    few = points[::6]
    seen_from = np.broadcast_to(np.float32([1.4, 0.4, 1.0]), few.shape).copy()
    seen_from[:7] = np.nan
    assert any(f'Of {len(few)} points 7 have no finite place' in note for note in quick(few, device, viewpoint=seen_from).notes)
    seen_from[:] = np.inf
    assert any('not finite: they count as not known' in note for note in quick(few, device, viewpoint=seen_from).notes)
    with pytest.raises(topple.Error, match='viewpoint: expected three finite numbers'):
        quick(points, device, viewpoint=(0, 0, np.nan))


def test_points_in_centimetres_are_told(device):
    patch = np.random.default_rng(3).random((2000, 3), np.float32) * np.float32([4, 4, 0.001])
    corners = np.concatenate([patch + np.float32(at) for at in ((0, 0, 0), (120, 0, 0), (0, 120, 0), (0, 0, 120))])
    with raises('input', r'^it all extends over 124 m: if .* in cm, multiply them by 0.01 \(1.2 m\), .*, else: (.*or|the scene.s bounds, .* hold \d+ blocks of 8x8x8 voxels, .*;) use voxel_m \(--voxel\) = '):
        quick(corners, device, voxel_m=0.02)


def test_a_viewpoint_in_millimetres_is_refused(points, device):
    with raises('input', r'^points: its viewpoint lies 1499 m off the points, which extend over 2.8 m: .* in mm, multiply it by 0.001'):
        quick(points, device, viewpoint=(0, 0, 1500))
    assert len(quick(points, device, viewpoint=(1.4, 0.4, 1.0)).objects) > 2


def test_that_there_are_no_colours_is_noted(points, result, sequence, coloured_sequence, ply, device, tmp_path):
    note = 'No colours were given: things that touch are told apart less well than with them.'
    assert result.notes.count(note) == 1 and sequence.notes.count(note) == 1
    assert note not in ply.notes and note not in coloured_sequence.notes
    assert note not in quick(points, device, colours=np.full(points.shape, 90, np.uint8)).notes
    (tmp_path / 'crate.obj').write_text('v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 0 0 1\nv 2 0 1\nf 1 2 3 4\nf 1 2 6 5\n')
    assert note not in quick(tmp_path / 'crate.obj', device).notes  # of meshes the shape is known


def test_misspelt_arguments_are_told_which_were_meant(points):
    for name, words in (('colors', "; did you mean 'colours'?"), ('voxel', "; did you mean 'voxel_m'?"), ('disturbance', "; did you mean 'disturbances'?"),
                        ('pga', "; did you mean 'pga_m_s2'?"), ('poses', None)):
        with pytest.raises(TypeError) as raised:
            topple.parse(points, **{name: 3})
        assert str(raised.value) == f'parse() has no argument {name!r}' + (words or '')


def test_an_organised_cloud_is_a_frame(device, tmp_path):
    depth = seen_from(POSES[0])[0]
    v, u = np.mgrid[:CAMERA.height, :CAMERA.width]
    seen = np.stack([(u - CAMERA.cx) / CAMERA.fx * depth, (v - CAMERA.cy) / CAMERA.fy * depth, depth], axis=-1).astype('<f4')
    seen[:9] = np.nan
    file = tmp_path / 'seen.pcd'
    file.write_bytes(f'VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH {CAMERA.width}\nHEIGHT {CAMERA.height}\n'
                     f'VIEWPOINT 0 0 0 1 0 0 0\nPOINTS {depth.size}\nDATA binary\n'.encode() + seen.tobytes())
    parsed = quick(file, device)
    assert parsed.image_shape == depth.shape and any(note.startswith('A single frame') for note in parsed.notes)
    assert np.array_equal(parsed.xyz, seen.reshape(-1, 3)[parsed.point_index])
    labels = np.full(depth.size, -1, np.int32)
    labels[parsed.point_index] = parsed.point_object
    for got in (parsed, pickle.loads(pickle.dumps(parsed))):
        assert np.array_equal(got.frame_labels(0), labels.reshape(depth.shape)) and (got.frame_labels(0)[:9] == -1).all()
        assert np.array_equal(got.frame_labels(primitives=True) >= 0, labels.reshape(depth.shape) >= 0)
        with pytest.raises(topple.Error, match='no frame 1: they count from 0, and there are 1'):
            got.frame_labels(1)
    assert quick(seen[9:].reshape(-1, 3), device).image_shape is None


def test_a_density_in_other_units_is_told(points, device):
    with pytest.warns(RuntimeWarning, match=r'give density_kg_m3 \(--density\) 1000 times') as warned:
        notes = quick(points[::6], device, density_kg_m3=0.7).notes
    assert [w.filename for w in warned] == [__file__]
    assert any('0.7 kg/m³' in note and 'give density_kg_m3 (--density) 1000 times' in note for note in notes)


def test_a_cache_serves_any_number_of_threads(points, tmp_path):
    file = tmp_path / 'scan.xyz'
    np.savetxt(file, points[::6], fmt='%.4f')
    results, stages = [], []
    for threads in (1, 3):
        stages.clear()
        results.append(topple.parse(file, device=topple.open_device('native', threads), disturbances=[], cache_file=tmp_path / 'cache',
                                    progress=lambda stage, done: stages.append((stage, done))))
    assert stages[0][0] == 'cache' and 'ingest' not in dict(stages) and [done for _, done in stages] == sorted(done for _, done in stages)
    assert np.array_equal(results[0].point_object, results[1].point_object)
    assert [o.barrier_J for o in results[0].objects] == [o.barrier_J for o in results[1].objects]


def test_options_of_numpy_are_taken(points, result, device):
    parsed = quick(points, device, seed=np.int64(1), up=np.array([0, 0, 1]), friction=np.float32(0.3), walks=np.uint8(9))
    assert parsed.up.tolist() == [0, 0, 1] and parsed.friction == np.float32(0.3) and parsed.density_kg_m3 == 700 and len(parsed.objects) == len(result.objects)


def test_things_weigh_by_their_kind(points, result, device, tmp_path):
    kind = {'name': 'crate', 'size_m': [0.2, 0.25, 0.35], 'fill': 1, 'density_kg_m3': 70, 'spread': 0.4}
    (tmp_path / 'kinds.json').write_text(json.dumps({'schema': 'topple.materials/1', 'kinds': [kind]}))
    named = [{'do': 'name', 'at_m': [[1.2, 1.2, 0.7]], 'name': 'crate'}]
    light, heavy = (quick(points, device, corrections=named, materials=given) for given in (tmp_path / 'kinds.json', None))
    for a, b in zip(light.objects, heavy.objects):
        if b.name == 'crate':
            assert a.mass_model == 'kind' and abs(a.mass_kg * 10 / b.mass_kg - 1) < 1e-6 and a.mass_error_kg > 0.3 * a.mass_kg
    assert 'crate' in [o.name for o in light.objects]
    assert 'kind' in [o.mass_model for o in quick(points, device, materials='household').objects]
    (tmp_path / 'kinds.json').write_text(json.dumps({'schema': 'topple.materials/1', 'kinds': [{**kind, 'spread': -1}]}))
    with raises('input', 'kinds.json: kind 1: spread is -1; it must be from 0 to 3'):
        quick(points, device, materials=tmp_path / 'kinds.json')


def test_a_cache_is_of_files_and_a_name_of_arrays(points, device, tmp_path):
    with raises('usage', r'^cache_file \(--cache\) /nope/x: .*in memory'):
        quick(points, device, cache_file='/nope/x')
    with pytest.raises(topple.Error, match='name are for points in memory'):
        quick(tmp_path, device, name='desk')
    parsed = quick(points, device, name='desk')
    assert parsed.source == 'desk' and 'desk' in repr(parsed) and parsed.offset_m.tolist() == [0, 0, 0]
    with pytest.raises(topple.Error, match='^desk: '):
        quick(points[:4], device, name='desk')


def test_one_disturbance_may_be_named_alone(points, result, device):
    parsed = topple.parse(points, device=device, disturbances='wind')
    assert set(parsed.fields) == {'wind'}
    assert [o.risk_J for o in parsed.objects] == [o.risk_J for o in result.objects]


def test_progress_and_cancelling(points, device):
    stages = []
    quick(points, device, progress=lambda stage, done: stages.append((stage, done)))
    names = list(dict.fromkeys(stage for stage, done in stages))
    assert names[0] == 'ingest' and 'grouping' in names and names[-1] == 'assembly'
    shares = [done for stage, done in stages]
    assert shares == sorted(shares) and 0 <= shares[0] < 0.1 and shares[-1] == 1 and len(set(shares)) > 10
    with raises('cancelled', '^cancelled$'):
        quick(points, device, cancelled=lambda: True)

    def fails(stage, done):
        raise KeyError(stage)
    with pytest.raises(KeyError):
        quick(points, device, progress=fails)
    with pytest.raises(TypeError):
        quick(points, device, cancelled=lambda: 'yes')


def test_ctrl_c_stops_a_parse(points, device):
    def interrupt(stage, done):
        if stage == 'normals':
            os.kill(os.getpid(), signal.SIGINT)
            time.sleep(0.06)  # beyond the time between two looks at signals
    with pytest.raises(KeyboardInterrupt):
        quick(points, device, progress=interrupt)


def test_other_threads_run_meanwhile(points):
    labels, ticks, done = [None, None], 0, threading.Event()

    def work(n):
        labels[n] = quick(points, topple.open_device('native', 1)).point_object
        done.set()
    threads = [threading.Thread(target=work, args=(n,)) for n in range(2)]
    for thread in threads:
        thread.start()
    while not done.is_set():
        ticks += 1
        time.sleep(0.001)
    for thread in threads:
        thread.join()
    assert ticks > 20 and np.array_equal(*labels)


def test_a_device_serves_one_parse_at_a_time(points, device):
    def again(stage, done):
        with pytest.raises(topple.Error, match='in use by another'):
            quick(points, device)
        raise StopIteration
    with pytest.raises(StopIteration):
        quick(points, device, progress=again)


def test_writes_the_outputs(result, points, tmp_path, device):
    result.write(tmp_path / 'with', octomap=True)
    assert (tmp_path / 'with' / 'map.bt').exists()
    result.write(tmp_path / 'out')
    assert not (tmp_path / 'out' / 'map.bt').exists()
    assert {'scene.json', 'points.ply', 'report.html'} <= {p.name for p in (tmp_path / 'out').iterdir()}
    again = quick(tmp_path / 'out' / 'points.ply', device)
    assert np.array_equal(again.xyz, points) and again.source.endswith('points.ply')
    with pytest.raises(topple.Error):
        result.write(tmp_path)


def test_colours_come_along(points, device, tmp_path):
    colours = np.full((len(points), 3), 40, np.uint8)
    colours[5] = 1, 2, 3
    records = np.zeros(len(points), [('red', 'u1'), ('green', 'u1'), ('blue', 'u1')])
    for axis, name in enumerate(records.dtype.names):
        records[name] = colours[:, axis]
    for number, given in enumerate((colours, records, tuple(colours.T))):
        out = tmp_path / str(number)
        quick(points, device, colours=given).write(out)
        head, data = (out / 'points.ply').read_bytes().split(b'end_header\n', 1)
        assert head.index(b'uchar red') < head.index(b'uchar object_red')
        assert data[5 * 38 + 32:5 * 38 + 35] == b'\1\2\3'
    for wrong, why in ((colours.astype(float), 'uint8'), (colours[:, :2], r'\(N, 3\)'), (colours[1:], 'colours: expected shape')):
        with pytest.raises(topple.Error, match=why):
            quick(points, device, colours=wrong)
    with pytest.raises(topple.Error, match='colours'):
        topple.parse(str(tmp_path), colours=colours)


def test_takes_corrections(points, device, tmp_path):
    on_crate, on_box = np.array([1.0, 1.2, 0.25]), (1.2, 1.2, 0.7)
    listed = [{'do': 'one_thing', 'at_m': [on_crate, on_box]}, {'do': 'mass', 'at_m': [on_box], 'kg': np.float32(12.5)},
              {'do': 'name', 'at_m': [list(on_crate)], 'name': 'chest'}, {'do': 'fixed', 'at_m': [[0.5, 0.5, 0.9]]}]
    corrected = quick(points, device, corrections=listed)
    chest = corrected.objects[corrected.corrections[0].objects[0]]
    assert (chest.name, chest.corrected) == ('chest', [1, 2, 3]) and abs(chest.mass_kg - 12.5) < 1e-6
    assert [c.do for c in corrected.corrections] == ['one_thing', 'mass', 'name', 'fixed']
    assert [c.outcome for c in corrected.corrections[:3]] == ['held'] * 3
    assert repr(corrected.corrections[1]) == '<topple.AppliedCorrection mass of chest: held>'
    carried = next(s for s in corrected.supports if s.supported == chest.id)
    assert repr(carried).startswith(f'<topple.Support: object 0 carries {chest.id} (chest), ')
    assert repr(pickle.loads(pickle.dumps(corrected)).supports) == repr(corrected.supports)
    assert not corrected.corrections[3].held and 'nothing' in corrected.corrections[3].outcome
    assert not quick(points, device).corrections
    for wrong, why in (([{'do': 'one_thing', 'objects': [1, 2]}], r'correction 1 \(one_thing\) has no "at_m".*result.spot'), (7, 'list of dicts'), ([7], 'list of dicts'), ([{'do': 'glue'}], 'correction 1'),
                       ([{'do': 'name', 'at_m': [on_box], 'name': object()}], 'no number')):
        with pytest.raises(topple.Error, match=why):
            quick(points, device, corrections=wrong)
    file = tmp_path / 'scan.xyz'
    np.savetxt(file, points, fmt='%.4f')
    (tmp_path / 'corrections.json').write_text(json.dumps(
        {'schema': 'topple.corrections/1', 'corrections': [{'do': 'not_there', 'at_m': [on_box]}]}))
    stages = []
    for _ in range(2):
        stages.clear()
        kept = topple.parse(file, device=device, disturbances=[], corrections=tmp_path / 'corrections.json',
                            cache_file=tmp_path / 'cache', progress=lambda stage, done: stages.append(stage))
        assert kept.corrections[0].held and len(kept.objects) == 2
    assert stages[0] == 'cache' and 'ingest' not in stages  # it goes on from what the first one kept


def test_the_stubs_name_what_there_is(result):
    stub = open(os.path.join(os.path.dirname(topple.__file__), '__init__.pyi'), encoding='utf-8').read()
    for kind, item in (('Object', result.objects[0]), ('Primitive', result.primitives[0]), ('Result', result),
                       ('Contact', result.contacts[0]), ('Support', result.supports[0]), ('Why', result.objects[0].why_figures),
                       ('Advice', result.objects[0].advice_figures), ('DirectedBarrier', result.objects[0].barrier_by_direction)):
        block = stub.split(f'class {kind}:')[1].split('\nclass ')[0].split('\ndef ')[0]
        named = {line.split('def ')[1].split('(')[0] for line in block.splitlines() if ' def ' in line}
        assert named == {n for n in dir(item) if not n.startswith('_')} - {'x', 'y', 'z', 'nx', 'ny', 'nz'}


# A daemon may be at work when the interpreter ends: it is stopped and waited for.
@pytest.mark.parametrize('after_s', [0.0, 0.05, 0.3])
def test_the_interpreter_may_end_during_a_parse(after_s):
    script = f'''
import sys, threading, time
import numpy as np
import topple
points = np.random.default_rng(1).random((300000, 3), np.float32) * np.array([6, 6, 0.01], np.float32)
began = threading.Event()
def work():
    while True:
        topple.devices()
        topple.parse(points, progress=lambda stage, done: began.set())
threading.Thread(target=work, daemon=True).start()
began.wait()
time.sleep({after_s})
'''
    ended = subprocess.run([sys.executable, '-c', script], capture_output=True, text=True, timeout=60)
    assert ended.returncode == 0, ended.stderr


def test_exports_to_simulators(result, tmp_path):
    made = result.export(mjcf=tmp_path / 'mjcf')
    assert [b.object for b in made.bodies[:len(result.objects)]] == [o.id for o in result.objects]
    assert made.deepest_overlap_m < 0.001
    for body, o in zip(made.bodies, result.objects):
        assert body.name == f'object_{o.id}' and body.mass_kg == o.mass_kg and body.parts > 0
        assert body.fixed == (o.grounded or body.held) and len(body.moved_m) == 3
        assert body.parts_m3 > 0.9 * (body.solid_m3 - body.lost_m3)
    written = json.loads((tmp_path / 'mjcf' / 'bodies.json').read_text())
    assert [(b['name'], b['excess_share']) for b in written['bodies']] == [(b.name, b.excess_share) for b in made.bodies]
    assert 'object_1' in (tmp_path / 'mjcf' / 'scene.xml').read_text()
    # Its floor lies on a border of voxels, so that no fitted plane cuts one.
    assert made.floor_m == written['floor_m'] == pytest.approx(0, abs=0.021)
    assert made.free_place_m == written['free_place_m'] and 0.4 < made.free_radius_m < 0.7
    assert result.export(mjcf=tmp_path / 'mjcf', threads=1) == made
    assert repr(made).startswith(f'<topple.ExportSummary: {len(made.bodies)} bodies, 1 of them fixed, that overlap by ') and len(repr(made)) < 120


def test_exports_have_the_colours_of_points_in_memory(points, device, ply, tmp_path):
    def surfaces(result, name):
        result.export(mjcf=tmp_path / name)
        return {file.name: file.read_bytes() for file in (tmp_path / name).rglob('object_*.obj')}
    coloured = quick(points, device, colours=colours_of(points))
    # With more than one colour a surface is split where they change.
    seen, plain = surfaces(coloured, 'memory'), surfaces(quick(points, device), 'plain')
    assert seen == surfaces(ply, 'file') == surfaces(coloured, 'again') and len(seen) == len(coloured.objects)
    assert all(len(seen[name]) > len(plain[name]) for name in seen)


def test_exports_into_what_looks_like_a_file_are_refused(result, tmp_path):
    for name, file, top in (('mjcf', 'a.xml', 'scene.xml'), ('urdf', 'b.URDF', 'scene.urdf'), ('sdf', 'c.sdf', 'scene.sdf')):
        with raises('usage', rf'^{name}: .*{file} looks like a file; it is a folder, into which {top} is written'):
            result.export(**{name: tmp_path / file})
    assert not list(tmp_path.iterdir())
    (tmp_path / 'd.sdf').mkdir()
    assert result.export(sdf=tmp_path / 'd.sdf').bodies


def test_exports_to_nothing_or_over_others_files_are_refused(result, tmp_path):
    with raises('usage', 'mjcf'):
        result.export()
    for wrong in ({'threads': -1}, {'visuals': 'no'}, {'mjcf': 3}):
        with pytest.raises(topple.Error, match=f'^{[*wrong][0]}: expected'):
            result.export(**{'mjcf': tmp_path / 'mjcf', **wrong})
    (tmp_path / 'scene.xml').write_text('<mujoco/>')
    with raises('input', 'scene.xml'):
        result.export(mjcf=tmp_path)
    assert (tmp_path / 'scene.xml').read_text() == '<mujoco/>'
