# SPDX-License-Identifier: MIT
"""Scans in other programs' formats: the same objects as from PLY, or from a folder of frames, and clear errors."""
import json
import os
import struct
import subprocess
import sys
import zipfile

import numpy as np
import pytest

import topple
from others import raises
import topple.formats
from made_scans import CAMERA, POSES, colours_of, graphics, parsed, quaternion, refused, same_objects, seen_from, truncated
from topple.formats import cloud, frames

# With the packages that ./dev setup installs, or not at all: package/python_formats runs them.
pytest.importorskip('lazrs')


# LAZ

def laz(path, points, scale=1e-4, offset=(0, 0, 0)):
    laspy = pytest.importorskip('laspy')
    header = laspy.LasHeader(point_format=2, version='1.2')
    header.scales, header.offsets = [scale] * 3, offset
    las = laspy.LasData(header)
    las.x, las.y, las.z = points.T
    las.red, las.green, las.blue = colours_of(points).T.astype(np.uint16) * 257
    las.write(path)
    return path


def test_laz(points, ply, device, tmp_path):
    result = parsed(laz(tmp_path / 'room.laz', points), device)
    same_objects(result, ply, within=0.02)
    assert result.source == str(tmp_path / 'room.laz')
    assert len(result.xyz) == len(points) and np.abs(result.xyz[:, 0] - points[:, 0]).max() < 1e-4
    result.write(tmp_path / 'out')
    seen = json.loads((tmp_path / 'out' / 'scene.json').read_text())
    assert seen['source'] == result.source and (tmp_path / 'out' / 'points.ply').stat().st_size > 20 * len(points)


def test_laz_far_from_the_origin(points, ply, device, tmp_path):
    far = np.array([500_000.0, 5_400_000.0, 120.0])
    result = parsed(laz(tmp_path / 'utm.laz', points + far, offset=far), device)
    assert len(result.objects) == len(ply.objects)
    result.write(tmp_path / 'out')
    offset = json.loads((tmp_path / 'out' / 'scene.json').read_text())['offset_m']
    assert np.abs(offset + result.xyz.mean(axis=0, dtype=float) - (points + far).mean(axis=0)).max() < 0.01


def test_laz_that_is_wrong(points, device, tmp_path):
    whole = laz(tmp_path / 'room.laz', points)
    for share in (0.02, 0.5, 0.95):
        refused(truncated(whole, share), device)
    endless = tmp_path / 'endless.laz'  # laspy goes through all the records that it promises
    endless.write_bytes(whole.read_bytes()[:100] + b'\xff' * 4 + whole.read_bytes()[104:])
    refused(endless, device, '4294967295 records', isolate=False)
    other = tmp_path / 'other.laz'
    other.write_bytes(b'ply\n' + b'x' * 500)
    refused(other, device, 'LASF')


# E57

def e57(path, scans):
    """scans: (points in the scanner's frame, rotation w x y z, translation)."""
    pye57 = pytest.importorskip('pye57')
    file = pye57.E57(str(path), mode='w')
    for points, rotation, translation in scans:
        red, green, blue = colours_of(points).T
        file.write_scan_raw({'cartesianX': points[:, 0].astype(float), 'cartesianY': points[:, 1].astype(float),
                             'cartesianZ': points[:, 2].astype(float), 'colorRed': red.copy(), 'colorGreen': green.copy(),
                             'colorBlue': blue.copy()}, rotation=np.array(rotation, float), translation=np.array(translation, float))
    file.close()
    return path


def test_e57(device, tmp_path):
    # The room from nine places, of which each scan is in its scanner's own frame.
    scans, seen, eyes = [], [], []
    for pose in POSES[::2]:
        depth = seen_from(pose)[0]
        u, v = np.meshgrid(np.arange(CAMERA.width), np.arange(CAMERA.height))
        own = np.stack([(u - CAMERA.cx) / CAMERA.fx * depth, (v - CAMERA.cy) / CAMERA.fy * depth, depth], axis=-1).reshape(-1, 3)
        scans.append((own, np.roll(quaternion(pose[:3, :3]), 1), pose[:3, 3]))
        seen.append(own @ pose[:3, :3].T + pose[:3, 3])
        eyes.append(np.tile(pose[:3, 3], (len(own), 1)))
    file, both, eyes = e57(tmp_path / 'room.e57', scans), np.concatenate(seen), np.concatenate(eyes)
    result = parsed(file, device)
    for name in ('order.ply', 'order.pcd'):
        cloud.write_cloud(tmp_path / name, cloud.Cloud(both, viewpoint=eyes), file)
        same_objects(result, parsed(tmp_path / name, device), within=0.02)
    same_objects(result, topple.parse(both, viewpoint=eyes, device=device, disturbances=[]), within=0.02)
    assert any('9 scans' in note for note in result.notes)
    assert not any('virtual views' in note for note in result.notes)


def test_e57_of_one_scan_knows_its_scanner(points, device, tmp_path):
    eye = np.array([0.3, 0.4, 1.3])
    scan = topple.formats.e57.read(e57(tmp_path / 'one.e57', [(points - eye, [1, 0, 0, 0], eye)]), topple.formats.Options())
    assert np.allclose(scan.viewpoint, eye) and np.abs(scan.points - points).max() < 1e-6
    assert (scan.colours == colours_of(points - eye)).all()
    result = parsed(tmp_path / 'one.e57', device)
    expected = topple.parse(scan.points, colours=scan.colours, viewpoint=list(eye), device=device, disturbances=[])
    same_objects(result, expected)


def test_e57_that_is_wrong(points, device, tmp_path):
    whole = e57(tmp_path / 'room.e57', [(points, [1, 0, 0, 0], [0, 0, 0])])
    for share in (0.001, 0.5, 0.99):
        refused(truncated(whole, share), device, 'E57')


# COLMAP

def colmap_model(folder, poses, names, binary, points=()):
    folder.mkdir(parents=True)
    k = [CAMERA.fx, CAMERA.fy, CAMERA.cx + 0.5, CAMERA.cy + 0.5]
    inverse = [np.linalg.inv(pose) for pose in poses]
    turns = [np.roll(quaternion(pose[:3, :3]), 1) for pose in inverse]
    colours = colours_of(np.asarray(points)) if len(points) else ()
    if binary:
        (folder / 'cameras.bin').write_bytes(struct.pack('<QiiQQ4d', 1, 1, 1, CAMERA.width, CAMERA.height, *k))
        images = [struct.pack('<i7di', n, *turn, *pose[:3, 3], 1) + name.encode() + b'\0' + struct.pack('<Q2dq', 1, 1.5, 2.5, -1)
                  for n, (turn, pose, name) in enumerate(zip(turns, inverse, names))]
        (folder / 'images.bin').write_bytes(struct.pack('<Q', len(images)) + b''.join(images))
        listed = [struct.pack('<Q3d3BdQ2i', n, *p, *c, 0.5, 1, 0, 0) for n, (p, c) in enumerate(zip(points, colours))]
        (folder / 'points3D.bin').write_bytes(struct.pack('<Q', len(listed)) + b''.join(listed))
    else:
        (folder / 'cameras.txt').write_text(f'# list\n1 PINHOLE {CAMERA.width} {CAMERA.height} ' + ' '.join(map(repr, map(float, k))) + '\n')
        (folder / 'images.txt').write_text('# list\n' + ''.join(
            f'{n} ' + ' '.join(repr(float(v)) for v in (*turn, *pose[:3, 3])) + f' 1 {name}\n\n'
            for n, (turn, pose, name) in enumerate(zip(turns, inverse, names))))
        (folder / 'points3D.txt').write_text('# list\n' + ''.join(
            f'{n} {p[0]} {p[1]} {p[2]} {c[0]} {c[1]} {c[2]} 0.5 0 0\n' for n, (p, c) in enumerate(zip(points, colours))))
    return folder


@pytest.mark.parametrize('binary', [True, False])
def test_colmap_sparse(points, ply, device, tmp_path, binary):
    model = colmap_model(tmp_path / 'scan' / 'sparse' / '0', POSES, [f'{n}.jpg' for n in range(len(POSES))], binary, points)
    result = parsed(tmp_path / 'scan', device)
    same_objects(result, ply, within=0.0 if binary else 1e-3)
    assert any('sparse' in note for note in result.notes)
    file = topple.formats.colmap.read_file(model / ('points3D.bin' if binary else 'points3D.txt'))
    alone = topple.formats.colmap.points_of(file)
    assert np.abs(alone.points - points).max() < 1e-6 and (alone.colours == colours_of(points)).all()


def colmap_dense(folder, walk):
    names = [f'view {n:02d}.png' for n in range(len(walk))]
    colmap_model(folder / 'sparse', [pose for pose, _ in walk], names, binary=True)
    maps = folder / 'stereo' / 'depth_maps'
    maps.mkdir(parents=True)
    for (_, depth), name in zip(walk, names):
        (maps / f'{name}.geometric.bin').write_bytes(f'{CAMERA.width}&{CAMERA.height}&1&'.encode() + depth.astype('<f4').tobytes())
    return folder


def test_colmap_dense(walk, sequence, device, tmp_path):
    result = parsed(colmap_dense(tmp_path / 'scan' / 'dense' / '0', walk).parents[1], device)
    same_objects(result, sequence, within=0.02)
    assert any('unit' in note for note in result.notes)


def test_colmap_in_another_unit(walk, sequence, device, tmp_path):
    smaller = []
    for pose, depth in walk:
        pose = pose.copy()
        pose[:3, 3] /= 4
        smaller.append((pose, depth / 4))
    same_objects(parsed(colmap_dense(tmp_path / 'scan', smaller), device, unit_m=4.0), sequence, within=0.02)


def test_colmap_that_is_wrong(walk, device, tmp_path):
    folder = colmap_dense(tmp_path / 'scan', walk)
    damaged = next((folder / 'stereo' / 'depth_maps').iterdir())
    damaged.write_bytes(damaged.read_bytes()[:-7])
    with pytest.raises(topple.Error, match='cut short') as error:
        parsed(folder, device)
    assert damaged.name in str(error.value) and error.value.kind == 'input'
    images = folder / 'sparse' / 'images.bin'
    images.write_bytes(images.read_bytes()[:100])
    with pytest.raises(topple.Error, match='images.bin.*cut short'):
        parsed(folder, device)
    (folder / 'points3D.bin').write_bytes(struct.pack('<Q', 1 << 60))
    refused(folder / 'points3D.bin', device, 'cut short')


# Gaussian splats

def test_splats(points, ply, device, tmp_path):
    y00 = 0.5 / np.sqrt(np.pi)
    haze = np.random.default_rng(2).uniform([0.2, 0.2, 0.2], [2.6, 2.2, 1.3], (2000, 3))
    names = ['x', 'y', 'z', 'f_dc_0', 'f_dc_1', 'f_dc_2', 'opacity', *(f'scale_{n}' for n in range(3)), *(f'rot_{n}' for n in range(4))]
    records = np.zeros((len(points) + len(haze), len(names)), '<f4')
    records[:, :3] = np.concatenate([points, haze])
    records[:len(points), 3:6] = (colours_of(points) / 255 - 0.5) / y00
    records[:, 6] = np.where(np.arange(len(records)) < len(points), 3, -3)
    header = ['ply', 'format binary_little_endian 1.0', f'element vertex {len(records)}', *(f'property float {n}' for n in names), 'end_header', '']
    (tmp_path / 'splats.ply').write_bytes('\n'.join(header).encode() + records.tobytes())
    result = parsed(tmp_path / 'splats.ply', device)
    same_objects(result, ply)
    assert any('splats' in note for note in result.notes)


# Phones

def polycam(folder, walk, photographs):
    for name in ('depth', 'confidence', 'corrected_cameras', 'corrected_images'):
        (folder / 'keyframes' / name).mkdir(parents=True)
    for n, ((pose, depth), seen) in enumerate(zip(walk, photographs)):
        stem = str(1000 + n)
        depth = np.round(depth * 1000).astype(np.uint16)
        trust = np.full(depth.shape, 255, np.uint8)
        trust[:3] = 0
        depth[:3] = 9000  # which nobody may believe
        (folder / 'keyframes' / 'depth' / f'{stem}.png').write_bytes(frames.png(depth))
        pytest.importorskip('PIL.Image').fromarray(trust).save(folder / 'keyframes' / 'confidence' / f'{stem}.png')
        camera = CAMERA.resized(2 * CAMERA.width, 2 * CAMERA.height)
        values = {'fx': camera.fx, 'fy': camera.fy, 'cx': camera.cx, 'cy': camera.cy, 'width': camera.width, 'height': camera.height}
        values.update({f't_{r}{c}': graphics(pose)[r, c] for r in range(3) for c in range(4)})
        (folder / 'keyframes' / 'corrected_cameras' / f'{stem}.json').write_text(json.dumps(values))
        (folder / 'keyframes' / 'corrected_images' / f'{stem}.jpg').write_bytes(seen)
    return folder


def zipped(folder, path, inside=''):
    with zipfile.ZipFile(path, 'w') as archive:
        for file in sorted(folder.rglob('*')):
            if file.is_file():
                archive.write(file, inside + file.relative_to(folder).as_posix())
    return path


def test_polycam(walk, photographs, coloured_sequence, device, tmp_path):
    folder = polycam(tmp_path / 'raw', walk, photographs)
    result = parsed(zipped(folder, tmp_path / 'raw.zip', 'capture/'), device)
    same_objects(result, coloured_sequence, within=0.05)
    result.write(tmp_path / 'out')
    assert b'red' in (tmp_path / 'out' / 'points.ply').read_bytes()[:1000]
    again = parsed(folder, device)
    assert [o.mass_kg for o in again.objects] == [o.mass_kg for o in result.objects]


def test_polycam_that_is_wrong(walk, photographs, device, tmp_path):
    folder = polycam(tmp_path / 'raw', walk[:2], photographs)
    (folder / 'keyframes' / 'corrected_cameras' / '1001.json').write_text('{"fx": 1')
    refused(folder, device, '1001.json')
    refused(truncated(zipped(folder, tmp_path / 'raw.zip')), device)
    refused(zipped(tmp_path / 'raw' / 'keyframes' / 'depth', tmp_path / 'other.zip'), device, 'Polycam', 'Record3D')


def record3d_metadata(walk, name):
    camera = CAMERA.resized(2 * CAMERA.width, 2 * CAMERA.height)
    poses = [quaternion(graphics(pose)[:3, :3]) + list(pose[:3, 3]) for pose, _ in walk]
    return {name: json.dumps({'w': camera.width, 'h': camera.height, 'dw': CAMERA.width, 'dh': CAMERA.height,
                              'K': [camera.fx, 0, 0, 0, camera.fy, 0, camera.cx, camera.cy, 1], 'poses': poses, 'fps': 30})}


def r3d(path, walk, photographs):
    lzfse = pytest.importorskip('liblzfse')
    with zipfile.ZipFile(path, 'w') as archive:
        for name, text in record3d_metadata(walk, 'metadata').items():
            archive.writestr(name, text)
        for n, (_, depth) in enumerate(walk):
            trust = np.full(depth.shape, 2, np.uint8)
            archive.writestr(f'rgbd/{n}.depth', lzfse.compress(depth.astype('<f4').tobytes()))
            archive.writestr(f'rgbd/{n}.conf', lzfse.compress(trust.tobytes()))
            archive.writestr(f'rgbd/{n}.jpg', photographs[n])
    return path


def test_record3d(walk, photographs, coloured_sequence, device, tmp_path):
    file = r3d(tmp_path / 'scan.r3d', walk, photographs)
    same_objects(parsed(file, device), coloured_sequence, within=0.02)
    refused(truncated(file), device)
    other = tmp_path / 'other.r3d'
    other.write_bytes(b'no archive')
    refused(other, device)


def test_record3d_exr(walk, photographs, coloured_sequence, device, tmp_path):
    openexr = pytest.importorskip('OpenEXR')
    folder = tmp_path / 'EXR_RGBD'
    (folder / 'depth').mkdir(parents=True)
    (folder / 'rgb').mkdir()
    for name, text in record3d_metadata(walk, 'metadata.json').items():
        (folder / name).write_text(text)
    for n, (_, depth) in enumerate(walk):
        with openexr.File({'compression': openexr.ZIP_COMPRESSION}, {'R': depth.astype(np.float32)}) as image:
            image.write(str(folder / 'depth' / f'{n}.exr'))
        (folder / 'rgb' / f'{n}.jpg').write_bytes(photographs[n])
    same_objects(parsed(folder, device), coloured_sequence, within=0.02)
    (folder / 'depth' / '3.exr').write_bytes(b'no image')
    refused(folder, device, 'depth/3.exr')


def test_record3d_of_a_sensor_on_its_side():
    upright = topple.formats.record3d._camera(720, 960, 700.0, 710.0, 480.0, 360.0)
    assert (upright.fx, upright.fy, upright.cx, upright.cy) == (710.0, 700.0, 360.0, 480.0)
    assert topple.formats.record3d._camera(720, 960, 700.0, 710.0, 350.0, 470.0).cx == 350.0


# What is missing, what goes wrong, and the command

def test_what_crashes_crashes_apart(points, device, tmp_path, monkeypatch):
    """A reader that dies, or takes more than it may, is an Error that names the file."""
    packages, scans = tmp_path / 'packages', tmp_path / 'scans'
    packages.mkdir()
    scans.mkdir()
    monkeypatch.setattr(sys, 'path', [str(packages), *sys.path])
    for package, code, name, part in (('lazrs', 'import os; os.abort()', 'room.laz', 'SIGABRT'),
                                      ('pye57', 'bytearray(1 << 40)', 'room.e57', 'memory'),
                                      ('rosbags', 'import os; os._exit(7)', 'room.bag', 'exit code 7')):
        (packages / f'{package}.py').write_text(code)
        (scans / name).write_bytes(b'LASF')
        refused(scans / name, device, part)


def test_a_conversion_is_cancelled(points, device, tmp_path):
    model = colmap_model(tmp_path / 'model', POSES[:1], ['a.jpg'], True, points)
    with raises('cancelled'):
        parsed(model, device, cancelled=lambda: True)


def test_a_missing_package_is_named(device, tmp_path):
    file = tmp_path / 'room.laz'
    file.write_bytes(b'LASF')
    code = ('import sys; sys.modules["lazrs"] = None\nimport topple\n'
            f'try: topple.parse({str(file)!r}, isolate=False)\nexcept topple.Error as e: print(e.kind, e)')
    said = subprocess.run([sys.executable, '-c', code], capture_output=True, text=True, check=True).stdout
    assert said.startswith('usage') and "pip install 'laspy[lazrs]'" in said and str(file) in said


def command(*arguments):
    return subprocess.run([sys.executable, '-m', 'topple.formats', 'convert', *map(str, arguments)], capture_output=True, text=True)


def test_command_converts(points, walk, photographs, ply, sequence, device, tmp_path):
    model = colmap_model(tmp_path / 'model', POSES[:1], ['a.jpg'], True, points)
    done = command(model, tmp_path / 'room.ply')
    assert done.returncode == 0 and 'room.ply' in done.stdout and 'sparse' in done.stdout, done.stderr
    result = parsed(tmp_path / 'room.ply', device)
    same_objects(result, ply)
    # What was said of it goes with it, and into what is parsed.
    assert 'sparse' in (tmp_path / 'room.ply.topple-notes.txt').read_text() and 'sparse' in result.notes[0]
    assert sum('sparse' in note for note in result.notes) == 1
    dense = colmap_dense(tmp_path / 'dense', walk)
    assert command(dense, tmp_path / 'walk').returncode == 0
    same_objects(parsed(tmp_path / 'walk', device), sequence, within=0.02)
    drifting = polycam(tmp_path / 'raw', walk, photographs)
    (drifting / 'keyframes' / 'corrected_cameras').rename(drifting / 'keyframes' / 'cameras')
    assert command(drifting, tmp_path / 'phone').returncode == 0
    assert 'drift' in parsed(tmp_path / 'phone', device).notes[0]
    for wrong, parts in [((model, tmp_path / 'room.ply'), 'there already'), ((model, tmp_path / 'folder'), '.ply'),
                         ((dense, tmp_path / 'walk.ply'), 'folder'), ((tmp_path / 'missing.laz', tmp_path / 'a.las'), 'not there')]:
        failed = command(*wrong)
        assert failed.returncode in (1, 2) and parts in failed.stderr and failed.stderr.count('\n') == 1, failed.stderr
    assert not [name for name in os.listdir(tmp_path) if name.startswith('.topple')]


def test_nothing_is_left_in_temporary_places(points, device, tmp_path, monkeypatch):
    import gc
    import tempfile
    monkeypatch.setattr(tempfile, 'tempdir', str(tmp_path / 'tmp'))
    (tmp_path / 'tmp').mkdir()
    model = colmap_model(tmp_path / 'model', POSES[:1], ['a.jpg'], True, points)
    result = parsed(model, device)
    result.write(tmp_path / 'out')
    del result
    gc.collect()
    assert os.listdir(tmp_path / 'tmp') == []
