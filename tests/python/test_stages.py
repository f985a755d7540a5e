# SPDX-License-Identifier: MIT
"""topple.stages: against closed forms and plain NumPy, in every layout, and what it refuses."""
import ast
import inspect
import os
import threading
import time
import warnings

import numpy as np
import pytest

import topple
from others import Exported
from topple import kernels, stages

GRAVITY = 9.80665


def grid(step=0.01, side=40):
    """A level square of points, (side * side, 3), float32."""
    x, y = np.meshgrid(np.arange(side) * step, np.arange(side) * step)
    return np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], 1).astype(np.float32)


class OnAnotherDevice:
    def __dlpack__(self, **options):
        raise BufferError('it lies on device 2')

    def __dlpack_device__(self):
        return (2, 0)


def test_the_spacing_of_a_grid_is_its_step():
    assert stages.point_spacing(grid(0.013)) == pytest.approx(0.013, rel=1e-5)
    assert stages.point_spacing(np.zeros((1, 3), np.float32)) == 0


@pytest.mark.parametrize('eye', [(0.2, 0.2, 3), (0.2, 0.2, -3)])
def test_normals_turn_to_the_eye(device, eye):
    n = stages.normals(grid(), 0.02, eye_m=eye, device=device)
    assert n.shape == (1600, 3) and n.dtype == np.float32 and all(c.flags.c_contiguous for c in n.T)
    assert np.allclose(n, [0, 0, np.sign(eye[2])], atol=1e-6)


def test_normals_turn_to_where_each_point_was_seen_from(device):
    square = grid()
    eyes = np.tile(np.float32([0.1, 0.2, 1]), (len(square), 1))
    eyes[square[:, 0] > 0.195] = 0.29, 0.2, -1
    expected = np.where(square[:, 0] < 0.195, 1, -1)
    clear = np.abs(square[:, 0] - 0.195) > 0.03  # of cells that were seen from one side
    records = np.zeros(len(square), [('vp_x', 'f4'), ('vp_y', 'f4'), ('vp_z', 'f4')])
    for axis, name in enumerate(records.dtype.names):
        records[name] = eyes[:, axis]
    for given in (eyes, eyes.astype(float), records, tuple(eyes.T), Exported(eyes)):
        n = stages.normals(square, 0.02, eye_m=given, device=device)
        assert np.allclose(n[clear, 2], expected[clear], atol=1e-6)
    eyes[::3] = np.nan
    with pytest.warns(RuntimeWarning, match='eye_m: of 1600 points 534 have no finite place .* the nearest one of the others is taken'):
        assert np.allclose(stages.normals(square, 0.02, eye_m=eyes, device=device)[clear, 2], expected[clear], atol=1e-6)
    with pytest.warns(RuntimeWarning, match='count as not known'):
        stages.normals(square, 0.02, eye_m=eyes * np.nan, device=device)


def test_normals_of_every_layout_are_the_same(device, points):
    expected = stages.normals(points, 0.06, device=device)
    assert np.allclose(np.linalg.norm(expected, axis=1)[np.any(expected, axis=1)], 1, atol=1e-5)
    records = np.zeros(len(points), [('x', 'f4'), ('more', 'u1', 5), ('y', 'f4'), ('z', 'f4')])
    for axis, name in enumerate('xyz'):
        records[name] = points[:, axis]
    for given in (records, np.asfortranarray(points), points.astype(float), Exported(points), tuple(points.T)):
        assert np.array_equal(stages.normals(given, 0.06, device=device), expected)
    out = np.empty((3, len(points)), np.float32)
    written = stages.normals(points, 0.06, device=device, out=out)
    assert np.shares_memory(written, out) and np.array_equal(out.T, expected)
    spoilt = points.copy()
    spoilt[7, 1] = np.nan
    assert not stages.normals(spoilt, 0.06, device=device)[7].any()


def test_frames_carve_what_they_see_through(device):
    """A camera at the origin looks along x at a wall 2 m away, and at nothing below."""
    y, z = np.meshgrid(np.arange(-1, 1, 0.02), np.arange(-1, 1, 0.02))
    wall = np.stack([np.full(y.size, 2.01), y.ravel(), z.ravel()], 1)
    far = wall + [1, 0, 0]
    cloud = np.concatenate([[[0.05, 0, 0]], wall, far]).astype(np.float32)
    volume = stages.Volume(cloud, np.zeros(len(cloud), np.int32), 0.1)
    pose = np.eye(4)
    pose[:3, :3] = np.array([[0, -1, 0], [0, 0, -1], [1, 0, 0]]).T  # camera's x, y and z in the world
    assert volume.state_at(10, 0, 0) is stages.State.UNSEEN
    camera = stages.Intrinsics(fx=100, fy=100, cx=79.5, cy=59.5)
    volume.carve(np.full((120, 160), 2010, np.uint16), pose, camera, device=device)
    assert volume.state_at(10, 0, 0) == stages.State.EMPTY
    assert volume.state_at(20, 0, 0) == stages.State.SURFACE
    states = volume.state_at(np.arange(5, 30), 0, 0)
    assert states.dtype == np.uint8 and np.all(states[:14] == 0) and np.all(states[16:24] == stages.State.UNSEEN)
    again = stages.Volume(cloud, np.zeros(len(cloud), np.int32), 0.1)
    frames = np.zeros((3, 120, 160), np.uint16)
    frames[1] = 2010
    again.carve(list(frames), np.stack([pose] * 3), (100, 100, 79.5, 59.5, 1000), device=device)
    again.carve([], np.zeros((0, 4, 4)), camera, device=device)
    assert np.array_equal(again.state_at(np.arange(5, 30), 0, 0), states)
    metres = stages.Volume(cloud, np.zeros(len(cloud), np.int32), 0.1)
    metres.carve(np.where(frames > 0, frames / 1000, np.nan), np.stack([pose] * 3), camera, device=device)
    assert np.array_equal(metres.state_at(np.arange(5, 30), 0, 0), states)


def test_what_is_closed_is_filled(device):
    """A shell of points around a cube of 10 voxels."""
    cells = np.array(np.meshgrid(*[range(10)] * 3)).reshape(3, -1).T
    shell = (cells == 0).any(1) | (cells == 9).any(1)
    cloud = (cells[shell] * 0.05 + 0.025).astype(np.float32)
    for hollow, completed in (((), 8**3), ([0], 0)):
        volume = stages.Volume(cloud, np.zeros(len(cloud), np.int32), 0.05)
        assert volume.fill(6, hollow, device=device) == completed
        solid = volume.solid()
        assert len(solid.i) == shell.sum() + completed
        assert np.count_nonzero(solid.state == stages.State.COMPLETED) == completed and not solid.label.any()
    index = solid.i
    del volume, solid
    assert index.min() == 0 and index.max() == 9  # the arrays outlive the volume


def test_support_functions_are_least_products(device):
    random = np.random.default_rng(1)
    vertices, directions = random.normal(size=(90, 3)).astype(np.float32), random.normal(size=(37, 3)).astype(np.float32)
    first = [0, 1, 40, 90]
    expected = [(vertices[a:b] @ directions.T).min(0) for a, b in zip(first, first[1:])]
    found = stages.support_functions(vertices, first, tuple(np.asfortranarray(directions).T), device=device)
    assert found.shape == (3, 37) and np.allclose(found, expected, atol=1e-5)
    out = np.empty((3, 37), np.float32)
    assert stages.support_functions(vertices, np.array(first, np.uint64), directions, device=device, out=out) is out
    assert np.array_equal(out, found)


def box_points(a, b, h):
    return np.array([[x, y, z] for x in (0, a) for y in (0, b) for z in (0, h)], float)


def test_a_box_tips_over_its_long_edge(device):
    bodies = [stages.StandingBody(box_points(a, b, h), 2.0, (a / 2, b / 2, h / 2))
              for a, b, h in ((0.2, 0.4, 0.6), (0.3, 0.2, 0.1))]
    found = stages.barriers(bodies, 0.001, device=device)
    for body, barrier in zip(bodies, found):
        a, b, h = 2 * np.array(body.center_of_mass_m)
        expected = 2.0 * GRAVITY * (np.hypot(min(a, b) / 2, h / 2) - h / 2)
        assert barrier.barrier_J == pytest.approx(expected, rel=0.02)
        assert abs(barrier.direction[0 if a < b else 1]) == pytest.approx(1, abs=0.05)
    upright, flat = (barrier.curve for barrier in found)
    assert upright[0] == pytest.approx((found[0].barrier_J, found[0].release_J)) and (np.diff(upright, axis=0) > 0).all()
    assert flat.shape == (0, 2)  # it lies as low as it can


def test_convolution_is_the_weighted_sum(device):
    random = np.random.default_rng(2)
    primary = random.random((2, 17, 23), np.float32)
    footprint = np.array([(0, 0, 1), (2, -1, 0.5), (-3, 4, 0.25), (1, 1, 2)], stages.footprint_dtype)
    first = [0, 3, 4]
    expected = np.zeros_like(primary)
    for d in range(2):
        wide = np.pad(primary[d], 8)
        for dx, dy, weight in footprint[first[d]:first[d + 1]]:
            expected[d] += weight * wide[8 + dy:8 + dy + 17, 8 + dx:8 + dx + 23]
    found = stages.convolve(primary, footprint, first, device=device)
    assert np.allclose(found, expected, atol=1e-5)
    table = np.array([list(entry) for entry in footprint.tolist()])
    out = np.empty_like(primary)
    assert stages.convolve(primary, table, np.array(first), device=device, out=out) is out and np.array_equal(out, found)


def test_a_body_beside_its_footing_falls_and_says_so(device):
    seen = box_points(0.3, 0.3, 0.6)
    seen = seen[seen[:, 0] <= seen[:, 0].min() + 1e-6]  # of one side alone
    middle = box_points(0.3, 0.3, 0.6).mean(axis=0)
    with pytest.warns(RuntimeWarning, match=r'bodies\[0\]: its centre of mass is not above its footing'):
        assert stages.barriers([(np.vstack([seen, middle]), 2.0, tuple(middle))], 0.005, device=device)[0].barrier_J == 0
    with warnings.catch_warnings():
        warnings.simplefilter('error')
        assert stages.barriers([(box_points(0.3, 0.3, 0.6), 2.0, tuple(middle))], 0.005, device=device)[0].barrier_J > 0


def test_a_body_lighter_than_air_is_told(device):
    with pytest.warns(RuntimeWarning, match=r'bodies\[0\]: 0.0378 kg in a box of 0.054 m3 are less than air'):
        stages.barriers([(box_points(0.3, 0.3, 0.6), 0.7 * 0.054, (0.15, 0.15, 0.3))], 0, device=device)


SQUARE = grid(side=10)
POSE = np.eye(4)
CAMERA = stages.Intrinsics(100, 100, 2, 2)
SEEN = np.full((4, 4), 2000, np.uint16)


def far_off(count, step_m):
    poses = np.tile(POSE, (count, 1, 1))
    poses[:, 0, 3] = step_m * np.arange(1, count + 1)
    return poses


def volume():
    return stages.Volume(SQUARE, np.zeros(100, np.int32), 0.05)


@pytest.mark.parametrize('call, words', [
    (lambda d: stages.point_spacing(np.zeros((5, 4), np.float32)), 'points: expected floats of shape (N, 3), not float32 of shape (5, 4)'),
    (lambda d: stages.point_spacing(np.zeros((5, 3), int)), "points.astype('float32') converts"),
    (lambda d: stages.point_spacing(OnAnotherDevice()), 'points: its memory is not NumPy'),
    (lambda d: stages.point_spacing([[1.0, 2.0], [3.0]]), 'points: no array can be made'),
    (lambda d: stages.point_spacing(np.full((5, 3), np.nan, np.float32)), 'finite'),
    (lambda d: stages.normals(SQUARE, 0, device=d), 'cell_m 0: expected metres above 0'),
    (lambda d: stages.normals(SQUARE, 20, device=d), 'cell_m 20: expected metres above 0 and at most 1'),
    (lambda d: stages.normals(SQUARE * 1000, 0.02, device=d), 'the points extend over 90 m and are 10 m apart'),
    (lambda d: stages.point_spacing(SQUARE * 1000), 'are 10 m apart, more than the 0.25 m'),
    (lambda d: stages.normals(SQUARE, 0.1, eye_m=np.zeros((9, 3)), device=d), 'eye_m: expected shape (3,) or (100, 3), one for each point, not 9'),
    (lambda d: stages.normals(SQUARE, 0.1, eye_m=np.zeros((100, 2)), device=d), 'eye_m: expected floats of shape (N, 3)'),
    (lambda d: stages.Volume(SQUARE, np.zeros(100, int), 20), 'voxel_m 20: expected metres from 0.001 to 1'),
    (lambda d: stages.barriers([(box_points(300, 300, 600), 10, (150, 150, 300))], 0.5, device=d), 'points must be in metres'),
    (lambda d: stages.barriers([(box_points(0.3, 0.3, 0.6), 10, (150, 150, 300))], 0.005, device=d), 'of body 0 lies 299.4 m off its points'),
    (lambda d: stages.barriers([(box_points(1, 1, 1), 10, (0.5, 0.5, 0.5))], 20, device=d), 'resolution_m 20: expected metres from 0 to 1'),
    (lambda d: stages.normals(SQUARE, 'wide', device=d), "cell_m: expected a number, not 'wide'"),
    (lambda d: stages.normals(SQUARE, 0.1, eye_m=(0, np.inf, 1), device=d), 'eye_m: inf at (1,)'),
    (lambda d: stages.normals(SQUARE, 0.1, eye_m=(0, 1), device=d), 'eye_m: expected floats of shape (3,), not float64 of shape (2,)'),
    (lambda d: stages.normals(SQUARE, 0.1, device=d, out=np.empty((100, 3), np.float32)), 'out: expected a writeable float32 array of shape (3, 100)'),
    (lambda d: stages.normals(SQUARE, 0.1, device=7), "device: expected one of topple.open_device()"),
    (lambda d: stages.Volume(SQUARE, np.zeros(99, np.int32), 0.05), 'label: expected integers of shape (100,), not int32 of shape (99,)'),
    (lambda d: stages.Volume(SQUARE, np.zeros(100), 0.05), "label.astype('int32') converts"),
    (lambda d: stages.Volume(SQUARE, np.full(100, -2), 0.05), 'a label of -2'),
    (lambda d: stages.Volume(SQUARE, np.full(100, 1 << 40), 0.05), 'label: 1099511627776 is beyond what int32 holds'),
    (lambda d: stages.Volume(SQUARE, np.zeros(100, int), 0), 'voxel'),
    (lambda d: volume().carve(np.full((4, 4), 1 << 20), POSE, CAMERA, device=d), 'depth 0: 1048576 is beyond'),
    (lambda d: volume().carve(np.zeros(4, np.uint16), POSE, CAMERA, device=d), 'depth 0: expected uint16, metres times depth_scale, or floats, metres, of shape (H, W), not uint16 of shape (4,)'),
    (lambda d: volume().carve([np.zeros((4, 4), np.uint16), np.zeros((4, 5), np.uint16)], [POSE, POSE], CAMERA, device=d), 'of shape (4, 4), as depth 0, not uint16 of shape (4, 5)'),
    (lambda d: volume().carve(np.zeros((2, 4, 4), np.uint16), POSE, CAMERA, device=d), 'camera_to_world: expected floats of shape (2, 4, 4)'),
    (lambda d: volume().carve(np.zeros((4, 4), np.uint16), POSE * np.nan, CAMERA, device=d), 'camera_to_world: nan at (0, 0, 0)'),
    (lambda d: volume().carve(np.zeros((4, 4), np.uint16), POSE * 1e300, CAMERA, device=d), 'camera_to_world 0: its rows are no rotation'),
    (lambda d: volume().carve(np.zeros((4, 4), np.uint16), np.vstack([POSE[:3], [1, 2, 3, 1]]), CAMERA, device=d), 'takes .T'),
    (lambda d: volume().carve(np.zeros((4, 4), np.uint16), POSE, (0, 1, 2, 3, 1000), device=d), 'intrinsics: need at least 2x2'),
    (lambda d: volume().fill(7, device=d), 'votes: expected 1 to 6, not 7'),
    (lambda d: volume().fill(3, [4], device=d), 'hollow label 4'),
    (lambda d: volume().state_at(0.5, 0, 0), 'i: expected integers'),
    (lambda d: stages.support_functions(SQUARE, [0, 5], SQUARE, device=d), 'first must rise from 0 to the 100'),
    (lambda d: stages.support_functions(SQUARE, [0, -5, 100], SQUARE, device=d), 'first: -5 is beyond what uint64 holds'),
    (lambda d: stages.support_functions(SQUARE, [], SQUARE, device=d), 'first'),
    (lambda d: stages.support_functions(SQUARE + np.float32(np.inf), [0, 100], SQUARE, device=d), 'vertices x: inf at (0,)'),
    (lambda d: stages.barriers([(box_points(1, 1, 1), -1, (0, 0, 0))], 0, device=d), 'body 0: its mass must be above 0'),
    (lambda d: stages.barriers([(np.zeros((0, 3)), 1, (0, 0, 0))], 0, device=d), 'body 0 has no points'),
    (lambda d: stages.barriers([(box_points(1, 1, 1) * np.nan, 1, (0, 0, 0))], 0, device=d), 'bodies[0].points: nan'),
    (lambda d: stages.barriers([(box_points(1, 1, 1), 1, (0, 0))], 0, device=d), 'bodies[0].center_of_mass_m: expected'),
    (lambda d: stages.barriers([(box_points(1, 1, 1) * 1e200, 1, (0, 0, 0))], 0, device=d), 'body 0 has a point at 1e+200: expected metres up to'),
    (lambda d: stages.barriers([(np.eye(3), 1, (0, 0, 0))], 0, device=d), 'bodies[0].points: 3 of them make no solid'),
    (lambda d: stages.barriers([3], 0, device=d), 'bodies[0]: expected points, mass_kg, center_of_mass_m, not 3'),
    (lambda d: stages.barriers(5, 0, device=d), 'bodies: expected a list of StandingBody, not int'),
    (lambda d: volume().carve(np.zeros((4, 4), np.uint16), POSE, (1, 1), device=d), 'intrinsics: expected a topple.stages.Intrinsics(fx, fy, cx, cy, depth_scale), not (1, 1)'),
    (lambda d: volume().carve(np.zeros((4, 4), np.uint16), POSE, np.eye(3), device=d), 'of a matrix K give Intrinsics(K[0, 0], K[1, 1], K[0, 2], K[1, 2])'),
    (lambda d: volume().carve(SEEN, far_off(1, 1200), CAMERA, device=d), 'the cameras are 1199.91 m from the points: places of poses are metres'),
    (lambda d: volume().carve(np.stack([SEEN] * 2), far_off(2, 1200), CAMERA, device=d), 'the camera moves by 1200 m from one frame to the next'),
    (lambda d: volume().carve(SEEN.astype(float), POSE, CAMERA, device=d), 'depth 0: all its readings lie beyond 65.5 m; floats are metres: of millimetres give depth / 1000'),
    (lambda d: volume().carve(SEEN, POSE, CAMERA._replace(depth_scale=1.0), device=d), 'at the depth_scale of the intrinsics, 1, the readings of 1 depth frame lie about 2000 m away'),
    (lambda d: volume().state_at([1, 2], [1, 2, 3], 0), 'i, j, k: shapes (2,), (3,) and () do not go together'),
    (lambda d: stages.normals(SQUARE, 0.1, eye_m=(1e300, 0, 0), device=d), 'eye_m 1e+300: expected metres up to'),
    (lambda d: stages.normals(SQUARE, 0.1, device='abacus'), 'backend (--backend) abacus is unknown; take auto'),
    (lambda d: stages.convolve(np.zeros((4, 4), np.float32), [[0, 0, 1.0]], [0, 1], device=d), 'primary: expected floats of shape (directions, height, width), not float32 of shape (4, 4)'),
    (lambda d: stages.convolve(np.zeros((1, 4, 4), np.float32), [[0, 0, 1.0]], [0], device=d), 'first: expected integers of shape (2,)'),
    (lambda d: stages.convolve(np.zeros((1, 4, 4), np.float32), [[0.5, 0, 1]], [0, 1], device=d), 'whole cells'),
    (lambda d: stages.convolve(np.zeros((1, 4, 4), np.float32), [[1e12, 0, 1]], [0, 1], device=d), 'footprint dx: 1000000000000'),
    (lambda d: stages.convolve(np.zeros((1, 4, 4), np.float32), [[0, 0, 1.0]], [0, 2], device=d), 'first must rise'),
])
def test_errors_name_the_argument_and_the_mend(call, words, device):
    with pytest.raises(topple.Error) as raised:
        call(device)
    assert words in str(raised.value)
    assert raised.value.kind in ('usage', 'input')


def test_other_threads_run_during_a_stage_and_a_device_serves_one(device):
    cloud = np.random.default_rng(3).random((300000, 3), np.float32)
    ticks, refused, done = 0, [], threading.Event()

    def work():
        while not done.is_set():
            try:
                stages.normals(cloud, 0.03, device=device)
                done.set()
            except topple.Error:  # the other one was first
                time.sleep(0.001)
    thread = threading.Thread(target=work)
    thread.start()
    while not done.is_set():
        try:
            stages.normals(SQUARE, 0.02, device=device)
        except topple.Error as error:
            refused.append(str(error))
        ticks += 1
        time.sleep(0.001)
    thread.join()
    assert ticks > 5 and refused and 'the device is in use by another parse or stage' in refused[0]


@pytest.mark.parametrize('module, name', [(topple, '__init__'), (kernels, 'kernels'), (stages, 'stages')])
def test_the_stubs_have_the_signatures_that_there_are(module, name):
    tree = ast.parse(open(os.path.join(os.path.dirname(topple.__file__), name + '.pyi'), encoding='utf-8').read())

    def arguments(node):
        return [a.arg for a in node.args.posonlyargs + node.args.args], [a.arg for a in node.args.kwonlyargs]

    def there(function):
        kinds = inspect.signature(function).parameters.values()
        return ([p.name for p in kinds if p.kind is p.POSITIONAL_OR_KEYWORD], [p.name for p in kinds if p.kind is p.KEYWORD_ONLY])
    named = {node.name for node in tree.body if isinstance(node, (ast.FunctionDef, ast.ClassDef))}
    named |= {node.target.id for node in tree.body if isinstance(node, ast.AnnAssign)}
    named |= {alias.asname for node in tree.body if isinstance(node, ast.ImportFrom) for alias in node.names if alias.asname == alias.name}
    assert set(module.__all__) <= named
    for node in tree.body:
        if isinstance(node, ast.FunctionDef) and inspect.isfunction(getattr(module, node.name)):
            assert arguments(node) == there(getattr(module, node.name)), node.name
        if isinstance(node, ast.ClassDef) and node.name not in ('_SupportsDLPack',):
            kind = getattr(module, node.name, None)
            if kind is None:
                continue  # of which there are objects only
            if hasattr(kind, '_fields'):
                assert [n.target.id for n in node.body if isinstance(n, ast.AnnAssign)] == list(kind._fields), node.name
            for method in (n for n in node.body if isinstance(n, ast.FunctionDef) and not n.decorator_list):
                assert arguments(method) == there(getattr(kind, method.name)), f'{node.name}.{method.name}'
