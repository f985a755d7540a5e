# SPDX-License-Identifier: MIT
"""Result: columns, data frames, tables of notebooks and pickles."""
import copy
import os
import pickle
import re
import subprocess
import sys
from html.parser import HTMLParser
from types import SimpleNamespace

import numpy as np
import pytest

import topple
from made_scans import box
from others import raises


def test_columns_have_what_the_objects_have(result):
    table = result.columns()
    count = len(result.objects)
    assert all(len(column) == count for column in table.values())
    assert table['id'].dtype == np.int32 and table['grounded'].dtype == bool
    for o in result.objects:
        assert table['barrier_J'][o.id] == o.barrier_J and table['why'][o.id] == o.why and table['mode'][o.id] == o.mode
        assert np.array_equal(table['center_of_mass_m'][o.id], o.center_of_mass_m)
        for column, value in (('overturning_tilt_deg', o.overturning.tilt_deg), ('fragility_pga_g', o.fragility.pga_g),
                              ('risk_wind_J', o.risk_J['wind']), ('risk_error_wind_J', o.risk_error_J['wind']),
                              ('fall_chance_wind', o.fall_chance['wind']), ('fall_hits_J', o.fall.hits_J), ('unsafety', o.unsafety)):
            assert np.array_equal(table[column][o.id], value, equal_nan=True), column
        assert np.isnan(table['fall_people_share'][o.id])
        assert table['stands_on'][o.id] == o.stands_on and table['fall_takes_along'][o.id] == o.fall.takes_along
    assert not any('human' in name for name in table)
    listed = topple._topple.COLUMNS['Object']
    assert {name for name, how in listed.items() if how in ('float64', 'int32', 'bool', 'vector')} - {'drop_m'} <= set(table)
    assert np.array_equal(table['overturning_direction'][1], result.objects[1].overturning.direction)


@pytest.mark.parametrize('what', ['primitives', 'contacts', 'supports'])
def test_columns_of_the_other_items(result, what):
    items, table = getattr(result, what), result.columns(what)
    assert items and set(table) == {n for n in dir(items[0]) if not n.startswith('_')}
    for name, column in table.items():
        assert [np.asarray(v).tolist() for v in column] == [np.asarray(getattr(item, name)).tolist() for item in items], name


def test_columns_of_a_scene_without_contacts_have_their_shapes(device):
    square = np.random.default_rng(4).random((4000, 3), np.float32) * np.array([2, 2, 0.002], np.float32)
    table = topple.parse(square, device=device, disturbances=[]).columns('supports')
    assert table['supporter'].shape == (0,) and table['supporter'].dtype == np.int32
    with raises('usage', 'what: expected objects, primitives, contacts, supports, pushes, blows, not 3'):
        topple.parse(square, device=device, disturbances=[]).columns(3)


def test_columns_have_the_figures_of_why_and_advice(result):
    table = result.columns()
    for o in result.objects:
        why, advice = o.why_figures, o.advice_figures
        assert why.sentence == o.why and advice.sentence == o.advice and why.stands_on == o.stands_on and why.drop_m == o.drop_m
        assert why.edge_m.shape in ((0, 3), (2, 3)) and (o.grounded or (why.W_J, why.S_J) == (o.barrier_J, o.release_J))
        for name in ('azimuth_deg', 'W_J', 'S_J', 'way_m', 'drop_m', 'lands_on'):
            assert np.array_equal(table[f'why_{name}'][o.id], getattr(why, name), equal_nan=True), name
        for name in ('kind', 'move_m', 'risk_J', 'hold_N', 'hold_height_m'):
            assert np.array_equal(table[f'advice_{name}'][o.id], getattr(advice, name)), name
        ends = np.stack([table['why_edge_start_m'][o.id], table['why_edge_end_m'][o.id]])
        assert np.array_equal(ends, why.edge_m) if len(why.edge_m) else np.isnan(ends).all()
    assert any(len(o.why_figures.edge_m) for o in result.objects)


def test_pushes_by_direction_are_in_the_frame_of_the_scan(result, points, device):
    loose = [o for o in result.objects if not o.grounded]
    for o in loose:
        by = o.barrier_by_direction
        assert by.direction.shape == (16, 3) and by.push_N.shape == by.push_error_N.shape == (16,)
        assert np.allclose(np.linalg.norm(by.direction, axis=1), 1) and np.allclose(by.direction @ result.up, 0)
        turned = np.degrees(np.arctan2(*(by.direction @ result.manhattan_from_input[:2, :3].T).T))
        off = (turned - np.arange(16) * 22.5 + 180) % 360 - 180
        assert np.allclose(off, 0, atol=1e-6)
        # No side takes less than the easiest way, and those across it more than that way itself.
        assert by.push_N.min() >= o.overturning.hand_push_N * (1 - 1e-6) and (by.push_error_N > 0).all()
        ahead = np.argmax(by.direction @ o.overturning.direction)
        assert by.push_N[ahead] <= o.overturning.hand_push_N * 1.1
    # A box of 25 x 20 x 35 cm: over its narrow side M g b / h, and over its corners as far as these lie.
    box = min(loose, key=lambda o: o.mass_kg)
    weight, reach = 9.80665 * box.mass_kg, box.overturning.hand_height_m
    expected = [weight * min(0.125 / max(abs(x), 1e-9), 0.1 / max(abs(y), 1e-9)) / reach for x, y, _ in box.barrier_by_direction.direction]
    assert np.allclose(box.barrier_by_direction.push_N, expected, rtol=0.25)
    # What it stands on is the other box, 50 cm high; blows are impulses: that of a free box of half the height in z.
    assert abs(box.support_height_m - 0.5) < 0.03 and abs(box.center_height_m - 0.175) < 0.03
    assert box.support_height_m + box.center_height_m == pytest.approx(np.dot(result.up, box.center_of_mass_m))
    blows = box.barrier_by_direction
    assert blows.blow_Ns.shape == blows.blow_J.shape == (16, len(blows.height_m))
    middle = np.abs(blows.height_m - box.center_height_m).argmin()
    assert np.allclose(blows.blow_Ns[:, middle], np.sqrt(2 * box.mass_kg * blows.blow_J[:, middle]), rtol=0.05)
    table = result.columns('pushes')
    assert table['object'].tolist() == [o.id for o in loose for _ in range(16)] and table['direction'].shape == (16 * len(loose), 3)
    rows = table['object'] == box.id
    assert np.array_equal(table['push_N'][rows], box.barrier_by_direction.push_N) and (table['slide_N'][rows] == box.overturning.slide_N).all()
    assert table['azimuth_deg'][rows][3] == 67.5
    table = result.columns('blows')
    rows = table['object'] == box.id
    assert np.array_equal(table['blow_Ns'][rows], blows.blow_Ns.ravel()) and np.array_equal(table['height_m'][rows], np.tile(blows.height_m, 16))
    assert np.array_equal(table['direction'][rows], blows.direction.repeat(len(blows.height_m), 0)) and table['azimuth_deg'][rows][-1] == 337.5
    assert len(rows) == sum(o.barrier_by_direction.blow_J.size for o in loose)
    # A scan that is turned has them turned.
    turn = np.array([[0.6, -0.8, 0], [0.8, 0.6, 0], [0, 0, 1]])
    again = topple.parse(points.astype(float) @ turn.T, device=device, disturbances=[])
    same = min((o for o in again.objects if not o.grounded), key=lambda o: np.linalg.norm(o.center_of_mass_m - turn @ box.center_of_mass_m))
    ahead = turn @ box.overturning.direction
    here = same.barrier_by_direction
    assert here.push_N[np.argmax(here.direction @ ahead)] == pytest.approx(box.overturning.hand_push_N, rel=0.3)


def test_without_a_disturbance_nothing_is_said_to_be_safe(points, device):
    quiet = topple.parse(points, device=device, disturbances=[])
    assert any(n.startswith('No disturbance was asked for') for n in quiet.notes)
    for o in quiet.objects:
        assert o.risk_J == {} and (o.grounded or (np.isnan(o.unsafety) and o.unsafety_category is None and not o.unsafety_certain))
        assert o.grounded or o.barrier_J > 0
    assert 'not ranked' in quiet._repr_html_()


def test_reprs_say_what_an_item_is(result):
    box, joint, carried = result.objects[-1], result.contacts[0], result.supports[0]
    for item, words in ((box, f'<topple.Object {box.id}, unsafety'), (result.primitives[2], f'<topple.Primitive 2: {result.primitives[2].model}, of object'),
                        (joint, f'<topple.Contact: primitives {joint.a} and {joint.b}, {joint.relation}'),
                        (carried, f'<topple.Support: object {carried.supporter} carries {carried.supported}'),
                        (box.why_figures, f'<topple.Why: {box.why}'), (box.advice_figures, '<topple.Advice'), (box.overturning, '<topple.Overturning: tips at'),
                        (box.fragility, '<topple.Fragility'), (box.barrier_by_direction, '<topple.DirectedBarrier: 16 directions, a push from'),
                        (box.landscape, '<topple.Landscape: '), (box.fall, '<topple.Fall: '), (result.objects[0].overturning, '<topple.Overturning: ')):
        assert repr(item).startswith(words), repr(item)
        assert repr(pickle.loads(pickle.dumps(item))) == repr(item)
    back = pickle.loads(pickle.dumps(result))
    assert repr(back.supports) == repr(result.supports) and repr(back.primitives) == repr(result.primitives)
    assert repr(topple._snapshot.Item(id=3)) == '<topple item 3>'  # of a pickle of an earlier version


def test_a_data_frame_splits_vectors(result):
    pandas = pytest.importorskip('pandas')
    frame = result.to_dataframe()
    assert isinstance(frame, pandas.DataFrame) and len(frame) == len(result.objects)
    assert frame.center_of_mass_z_m[1] == result.objects[1].center_of_mass_m[2] and 'direction_x' in frame
    assert result.to_dataframe('contacts').normal_y[0] == result.contacts[0].normal[1]
    assert {'why_edge_start_x_m', 'advice_move_z_m', 'advice_hold_N', 'why_azimuth_deg'} <= set(frame)
    assert list(result.to_dataframe('pushes'))[:3] == list(result.to_dataframe('blows'))[:3] == ['object', 'azimuth_deg', 'direction_x']


def test_without_pandas_the_error_says_so(result, monkeypatch):
    monkeypatch.setitem(sys.modules, 'pandas', None)
    with pytest.raises(ImportError, match='pip install pandas'):
        result.to_dataframe()


class Table(HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.open, self.rows, self.words = [], 0, ''
        self.feed(text)
        assert not self.open

    def handle_starttag(self, tag, attributes):
        self.open.append(tag)
        self.rows += tag == 'tr'

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.words += data + '\n'


def test_a_notebook_shows_the_riskiest_first(result):
    table = Table(result._repr_html_())
    loose = [o for o in result.objects if not o.grounded]
    assert table.rows == 1 + min(len(loose), 12) and '<script' not in result._repr_html_()
    category = {'high': 3, 'medium': 2, 'low': 1}
    riskiest = max(loose, key=lambda o: (category.get(o.unsafety_category, 0), o.unsafety_category in category and o.unsafety_certain, np.nan_to_num(o.unsafety, nan=0)))
    assert 'e+' not in table.words and topple._shown.figure(234.5, 1) == '234' and topple._shown.figure(0.0000234, 1) == '0.00002'
    places = [table.words.find(o.why) for o in loose]
    assert min(p for p in places if p >= 0) == table.words.find(riskiest.why)


def same(a, b):
    if isinstance(a, np.ndarray):
        return a.dtype == b.dtype and np.array_equal(a, b, equal_nan=a.dtype.kind == 'f')
    if isinstance(a, (list, tuple)):
        return len(a) == len(b) and all(map(same, a, b))
    if isinstance(a, dict):
        return a.keys() == b.keys() and all(same(a[name], b[name]) for name in a)
    if type(a).__module__ == 'topple._topple':
        return all(same(getattr(a, n), getattr(b, n)) for n in dir(a) if not n.startswith('_'))
    return a == b or (a != a and b != b)


def test_a_pickle_holds_all_that_can_be_asked_for(result, points, tmp_path):
    back = pickle.loads(pickle.dumps(result))
    for name in dir(result):
        if not name.startswith('_') and not callable(getattr(result, name)):
            assert same(getattr(result, name), getattr(back, name)), name
    assert np.array_equal(back.xyz, points)
    assert back._repr_html_() == result._repr_html_() and same(result.columns(), back.columns())
    assert set(dir(back)) == set(dir(result))
    again = copy.deepcopy(back)
    assert np.array_equal(again.point_object, result.point_object)
    for call in (lambda: back.write(tmp_path / 'out'), lambda: back.export(mjcf=tmp_path / 'mjcf')):
        with pytest.raises(topple.Error, match='before pickling'):
            call()
    assert not list(tmp_path.iterdir())


def test_an_item_can_be_pickled_alone(result):
    item = result.objects[1]
    for back in (pickle.loads(pickle.dumps(item)), copy.deepcopy(item)):
        assert back.id == 1 and back.risk_J == item.risk_J and back.overturning.tilt_deg == item.overturning.tilt_deg
        assert np.array_equal(back.instability, item.instability)


def test_help_has_a_line_for_each_attribute(result):
    kinds = [topple.Result] + [type(part) for o in result.objects[:1] for part in (o, o.fall, o.overturning, o.fragility, o.barrier_by_direction, o.why_figures, o.advice_figures)]
    for kind in kinds + [topple.Primitive, topple.Contact, topple.Support, topple.AppliedCorrection, topple.Device]:
        public = {n: p for n, p in vars(kind).items() if not n.startswith('_')}
        assert kind.__doc__ and public and all(p.__doc__ for p in public.values()), kind
    assert {n for n in dir(result._parsed) if not n.startswith('_')} - set(dir(result)) == {'x', 'y', 'z', 'nx', 'ny', 'nz'}
    with pytest.raises(AttributeError, match="topple.Result has no attribute 'labels'"):
        result.labels


def test_spots_lie_in_the_midst_of_their_parts(result, points, device):
    spots = {p.id: result.spot(p, part=True) for p in result.primitives}
    solid = np.stack([result.solid[axis] for axis in 'xyz'], axis=1)
    for part, spot in spots.items():
        away = np.linalg.norm(solid - spot, axis=1)
        assert result.solid['primitive'][away.argmin()] == part and away.min() < 1e-6
        others = result.solid['primitive'] != part
        largest = result.solid['primitive'] == part
        assert away[others].min() >= result.voxel_size_m * 0.99 and away[largest].min() == away.min()
    for o in result.objects:
        listed = result.spots(o.id)
        assert sorted(map(tuple, listed)) == sorted(tuple(spots[p]) for p in o.primitives)
        largest = max(o.primitives, key=lambda p: (result.primitives[p].solid_voxels, -p))
        assert np.array_equal(result.spot(o), listed[0]) and np.array_equal(listed[0], spots[largest])
    loose = [o.id for o in result.objects if not o.grounded]
    again = topple.parse(points, device=device, disturbances=[], corrections=[
        {'do': 'one_thing', 'at_m': [result.spot(n) for n in loose]}, {'do': 'name', 'at_m': [result.spot(loose[0])], 'name': 'pile'}])
    assert [c.held for c in again.corrections] == [True, True] and len(again.objects) == len(result.objects) - len(loose) + 1
    assert np.array_equal(pickle.loads(pickle.dumps(result)).spot(1), result.spot(1))
    for wrong in (99, -1, 1.5, 'box', True):
        with pytest.raises(topple.Error, match='object: expected one of the result'):
            result.spot(wrong)


def test_vectors_are_arrays(result):
    vectors = [result.up, result.offset_m, result.spot(1), *result.spots(1), result.contacts[0].normal, result.primitives[0].center_of_mass_m]
    for o in result.objects:
        vectors += [o.center_of_mass_m, o.center_of_mass_error_m, o.size_m, o.box_middle_m, o.direction, o.overturning.direction, o.fall.lands_m, o.advice_figures.move_m]
    assert all(isinstance(v, np.ndarray) and v.dtype == np.float64 and v.shape == (3,) for v in vectors)
    assert result.manhattan_from_input.shape == (4, 4) and np.allclose(result.manhattan_from_input[2, :3], result.up)
    before = result.up.copy()
    result.up[0] = 7  # they are copies: nobody's result changes
    assert np.array_equal(result.up, before)


def test_what_can_be_taken_away_first(result):
    below, above = sorted((o.id for o in result.objects if not o.grounded), key=lambda n: result.objects[n].support_height_m)
    assert result.removal_order() == ([[above], [below]], []) and repr(result.removal_order()) == f'<topple.RemovalOrder: [[{above}], [{below}]]>'

    def of(count, *supports):
        items = [SimpleNamespace(id=n, grounded=n == 0) for n in range(count)]
        return SimpleNamespace(objects=items, supports=[SimpleNamespace(supporter=a, supported=b, probability=p) for a, b, p in supports])
    order = topple._removal.order
    room = of(7, (0, 1, 1), (1, 2, 0.9), (1, 3, 0.6), (3, 4, 0.3), (0, 5, 1), (5, 6, 0.8))
    assert order(room, 0.5) == ([[2, 3, 4, 6], [1, 5]], []) and order(room, 0) == ([[2, 4, 6], [3, 5], [1]], [])
    torn = of(5, (1, 2, 1), (2, 3, 0.7), (3, 2, 0.7), (0, 1, 1))  # 2 and 3 carry each other, on 1
    assert order(torn, 0.5) == ([[4]], [1, 2, 3]) and 'objects 1, 2, 3 carry each other' in repr(order(torn, 0.5))
    for wrong in (-0.1, 1.1, 'half', np.nan):
        with raises('usage', '^min_probability: expected a number'):
            result.removal_order(wrong)


def test_what_falls_without_an_object(result, tmp_path):
    below, above = sorted((o.id for o in result.objects if not o.grounded), key=lambda n: result.objects[n].support_height_m)
    result.write(tmp_path / 'out')
    for asked in (result, topple.load(tmp_path / 'out')):
        falls, unsure = asked.falls_without(below)
        assert [(f.object, f.lost, f.left) for f in falls] == [(above, [below], [])] and np.isnan(falls[0].beyond_m) and unsure == []
        assert falls[0].reason.startswith(f'Object {above} rests on object {below}, and on nothing else') and 0.2 < falls[0].probability <= 1
        assert asked.falls_without(asked.objects[above]) == ([], []) == asked.falls_without([below, asked.objects[above]])
        assert asked.removal_steps() == [[above], [below]] == asked.removal_steps(below) and asked.removal_steps(asked.objects[above]) == [[above]]
        floor, = asked.held_by(below)
        assert floor.building and asked.objects[floor.object].grounded and floor.from_below and floor.area_m2 > 0.1
        held, = asked.held_by(asked.objects[above])
        assert (held.object, held.building, held.from_below) == (below, False, True)


@pytest.mark.parametrize('item, words', [
    (99, 'object: expected one of the result'), (-1, 'object: expected one of the result'), ('crate', 'object: expected one of the result'),
    (True, 'object: expected one of the result'), (0, 'object 0: it is the building, or fixed to it')])
def test_what_is_not_there_holds_nothing(result, item, words):
    for ask in (result.falls_without, result.removal_steps, result.held_by):
        with raises('usage', words):
            ask(item)
    with raises('usage', 'expected an object, or some'):
        result.falls_without([])
    for ask in ('falls_without', 'held_by', 'removal_steps'):
        with raises('usage', f'{ask}: this result was pickled'):
            getattr(pickle.loads(pickle.dumps(result)), ask)(1)


def test_a_folder_can_be_loaded(ply, coloured_sequence, points, tmp_path):
    for result, folder in ((ply, tmp_path / 'cloud'), (coloured_sequence, tmp_path / 'frames')):
        result.write(folder)
        back = topple.load(folder)
        for name in ('objects', 'primitives', 'contacts', 'supports'):
            assert repr(getattr(back, name)) == repr(getattr(result, name))
        for name, column in result.columns().items():
            assert column.dtype == object or np.allclose(column, back.columns()[name], rtol=1e-9, atol=1e-12, equal_nan=True), name
        for name in ('point_object', 'point_primitive', 'up', 'manhattan_from_input', 'friction', 'density_kg_m3', 'notes', 'seed', 'source'):
            assert same(getattr(back, name), getattr(result, name)), name
        assert same(back.xyz, result.xyz) and same(back.normals, result.normals) and same(back.solid, result.solid)
        assert np.array_equal(back.spot(1), result.spot(1)) and back.removal_order() == result.removal_order()
        assert all(np.allclose(a.landscape.energy_J, b.landscape.energy_J, rtol=1e-3) for a, b in zip(back.objects, result.objects))
        assert back.export(mjcf=tmp_path / 'back').notes == result.export(mjcf=tmp_path / 'was').notes
        for file in (tmp_path / 'was').rglob('*.*'):
            assert file.read_bytes() == (tmp_path / 'back' / file.relative_to(tmp_path / 'was')).read_bytes(), file
        assert back.fields == {} and len(back.point_region) == 0
        with raises('usage', 'read from a folder, which has no voxel grids'):
            back.write(tmp_path / 'again')
        assert not (tmp_path / 'again').exists()
        assert pickle.loads(pickle.dumps(back)).columns().keys() == result.columns().keys()
    assert np.array_equal(topple.load(tmp_path / 'frames').frame_labels(3), coloured_sequence.frame_labels(3))
    cut = tmp_path / 'cloud' / 'points.ply'
    cut.write_bytes(cut.read_bytes()[:-1])
    with raises('input', 'points.ply'):
        topple.load(tmp_path / 'cloud')
    for wrong, words in ((tmp_path / 'nowhere', 'nowhere: No such file'), (tmp_path, 'no scene.json'), (3, 'folder: expected')):
        with pytest.raises(topple.Error, match=words):
            topple.load(wrong)


def test_a_pickle_is_read_by_another_process(result, tmp_path):
    (tmp_path / 'result').write_bytes(pickle.dumps(result))
    script = f'import pickle; r = pickle.load(open({str(tmp_path / "result")!r}, "rb")); print(len(r.objects), r.point_object.sum())'
    said = subprocess.run([sys.executable, '-c', script], capture_output=True, text=True, timeout=60)
    assert said.stdout.split() == [str(len(result.objects)), str(result.point_object.sum())], said.stderr


def test_generates_a_room_that_parses(device, tmp_path):
    scan = topple.generate(tmp_path / 'scan', seed=2, single=True)
    assert sorted(os.listdir(os.path.join(scan, 'depth'))) == ['0000.png']
    assert len(topple.parse(scan, device=device, disturbances=[]).objects) > 2
    for option, words in ({'kind': 'zoo'}, '^--kind zoo: expected plain'), ({'seed': 'x'}, '^--seed x: expected a whole number'):
        with raises('usage', words):
            topple.generate(tmp_path / 'other', **option)
    (tmp_path / 'thesis').mkdir()
    (tmp_path / 'thesis' / 'chapter.tex').write_text('x')
    with raises('input', r'thesis: holds other things .*chapter.tex.*choose a folder'):
        topple.generate(tmp_path / 'thesis')
    assert os.listdir(tmp_path / 'thesis') == ['chapter.tex']
    assert topple.generate(scan, seed=3, single=True) == scan  # over its like
    with raises('input', '/proc: can.t be written to'):
        topple.generate('/proc/nowhere')
    listed = subprocess.run([sys.executable, '-m', 'topple', '--version'], capture_output=True, text=True, timeout=60)
    assert topple.__version__ in listed.stdout


def test_stays_says_what_may_be_touched(result):
    loose = [o for o in result.objects if not o.grounded]
    assert len(loose) == 2 and not any(o.piece_of >= 0 for o in loose)
    for o in loose:
        at = o.center_of_mass_m
        assert result.stays(o, at, force_N=1) and result.stays(o.id, at, o.barrier_by_direction.direction[3], impulse_Ns=0.1)
        assert not result.stays(o, at, force_N=1.1 * o.overturning.slide_N)
        speed = np.sqrt(2 * 0.3 * 9.80665 * 0.02)  # slides by 2 cm
        assert not result.stays(o, at, impulse_Ns=1.01 * speed * o.mass_kg) and not result.stays(o, at, impulse_Ns=0.1, slack_m=0)
        assert not result.stays(o, np.add(at, [0, 0, 5]), force_N=1)
        assert result.why_moves(o, at, force_N=1) == '' and 'above its top, by' in result.why_moves(o, np.add(at, [0, 0, 5]), force_N=1)
        least = result.stays_up_to_N(o, at)
        assert result.stays(o, at, force_N=0.99 * least)
        assert re.fullmatch('the push may (set it sliding|tip it): (at that height, )?from .+ N on it may', result.why_moves(o, at, force_N=1.01 * least))
        assert result.released_J(o, 1e9) == max(o.instability[:, 1], default=0) and result.released_J(o.id, 0) == 0
    assert result.stays(0, [0, 0, 0], force_N=1e6) and result.released_J(0, 1e9) == 0
    with pytest.raises(topple.Error, match='W_J: expected joules'):
        result.released_J(0, float('nan'))


@pytest.mark.parametrize('given, words', [
    ({'place_m': [0, 0]}, 'place_m: expected three finite numbers'), ({'place_m': [0, 0, np.nan]}, 'place_m: expected three finite numbers'),
    ({'way': [2, 0, 0]}, r'stays: way \(2, 0, 0\) is 2 long: expected a unit vector'), ({'way': [0, 0, 1]}, 'expected a level way'),
    ({'force_N': -1}, 'stays: force_N -1: expected newtons'), ({'impulse_Ns': np.nan}, 'stays: impulse_Ns nan: expected newton seconds'),
    ({'slack_m': 'much'}, "slack_m: expected a number, not 'much'"), ({'item': 99}, 'object: expected one of the result')])
def test_stays_refuses_what_makes_no_sense(result, given, words):
    with raises('usage', words):
        result.stays(**{'item': 1, 'place_m': [1, 1, 0.3], **given})


def test_stays_is_not_pickled(result):
    with raises('usage', 'stays: this result was pickled'):
        pickle.loads(pickle.dumps(result)).stays(1, [1, 1, 0.3])


def test_object_at_goes_from_a_place_to_the_object(result, points):
    floor, crate, box = (result.object_at(at, 0.05) for at in ([0.4, 0.4, 0], [1.05, 0.95, 0.5], (1.3, 1.2, 0.85)))
    assert result.objects[floor].grounded and len({floor, crate, box}) == 3
    assert result.object_at([1.3, 1.2, 1.2], 0.05) == -1 and result.object_at([1.3, 1.2, 1.2], np.inf) == box
    assert pickle.loads(pickle.dumps(result)).object_at(points[5], 0) == result.point_object[5]
    for wrong in ({'place_m': [0, 0, np.inf], 'within_m': 1}, {'place_m': [0, 0, 0], 'within_m': -1}, {'place_m': [0, 0, 0], 'within_m': None}):
        with raises('usage'):
            result.object_at(**wrong)


def test_an_alternative_is_what_a_correction_makes_of_it(points, device):
    """A smaller box flush on a larger one, in the room without its other things."""
    random = np.random.default_rng(2)
    inside = (points[:, :2] > [0.9, 0.8]).all(1) & (points[:, :2] < [1.8, 1.6]).all(1)
    room = [points[~(inside & (points[:, 2] > 0.01))]]
    scan = np.concatenate(room + box(random, [1, 0.9, 0], [0.7, 0.6, 0.4]) + box(random, [1.02, 0.92, 0.4], [0.66, 0.56, 0.3])).astype(np.float32)
    found = topple.parse(scan, device=device, disturbances=['wind'])
    doubtful, other = next((o, a) for o in found.objects for a in o.alternatives)
    assert 0.25 <= other.probability <= 1 and other.whole not in (-1, doubtful.id)
    spots = [*found.spots(doubtful.id), *found.spots(other.whole)]
    one = topple.parse(scan, device=device, disturbances=['wind'], corrections=[{'do': 'one_thing', 'at_m': [list(map(float, s)) for s in spots]}])
    whole = next(o for o in one.objects if set(doubtful.primitives) < set(o.primitives))
    assert (other.mass_kg, other.barrier_J, other.barrier_error_J) == pytest.approx((whole.mass_kg, whole.barrier_J, whole.barrier_error_J), rel=0.01)
    assert not whole.alternatives  # it is known
