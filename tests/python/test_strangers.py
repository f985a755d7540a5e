# SPDX-License-Identifier: MIT
"""What strangers try on who parses their scans: code beside a scan, names and links that lead out of it, bombs, texts that steer
terminals, readers that lie. All of it ends soon, in a result or an Error of one printable line."""
import json
import os
import pathlib
import struct
import subprocess
import sys
import zipfile
import zlib

import numpy as np
import pytest

import topple
from made_scans import CAMERA, POSES, SECRET, tried
from test_formats import colmap_dense, colmap_model
from topple import _arrays, _topple, formats
from topple.formats import apart, colmap, limits, packed_folder, polycam, record3d, scan_folder
from topple.formats.frames import png


# Code beside a scan

def planted(folder):
    """Modules of every name that may be imported late, programs, and more that Python or a shell may run; the files to parse."""
    names = {*sys.stdlib_module_names, 'laspy', 'lazrs', 'pye57', 'rosbags', 'mcap', 'liblzfse', 'OpenEXR', 'PIL', 'numpy', 'topple', '_topple',
             'sitecustomize', 'usercustomize', 'apsw', 'lz4', 'zstandard', 'ruamel', 'requests'}
    folder.mkdir()
    for name in names:
        (folder / f'{name}.py').write_text(f'open({str(folder / "hit-")!r} + {name!r}, "w")')
        (folder / f'{name}.pth').write_text(f'import os; open({str(folder / "hit-pth-")!r} + {name!r}, "w")')
    for name in ('python3', 'python', 'sh', 'gs', 'topple', 'topple-reader'):
        (folder / name).write_text(f'#!/bin/sh\n: > {folder}/hit-{name}\n')
        (folder / name).chmod(0o755)
    (folder / 'pyvenv.cfg').write_text(f'home = {folder}\n')
    scans = [folder / f'scan.{ending}' for ending in ('laz', 'e57', 'mcap', 'r3d')]
    for scan in scans:
        scan.write_bytes(b'LASF' * 100)
    with zipfile.ZipFile(folder / 'scan.zip', 'w') as archive:
        archive.writestr('keyframes/depth/1.png', b'%!PS\n(run) =\n')
        archive.writestr('keyframes/cameras/1.json', '{}')
    (folder / 'scan.obj').write_text('v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n')
    return [*scans, folder / 'scan.zip', folder / 'scan.obj']


PARSES = '''
import os, sys
os.chdir(sys.argv[1])
import topple
sys.path[:0] = eval(sys.argv[2])
for scan in sys.argv[3:]:
    try: topple.parse(scan)
    except topple.Error as error: print(error.kind)
'''


@pytest.mark.parametrize('after', [[], ['', '.', 'FOLDER']])
def test_code_beside_a_scan_is_not_run(tmp_path, after):
    folder = tmp_path / 'scan'
    scans = [scan.name if after else scan for scan in planted(folder)]
    script = tmp_path / 'script.py'
    script.write_text(PARSES)
    environment = {**os.environ, 'PATH': f'.:{folder}:' + os.environ['PATH'], 'PYTHONSTARTUP': 'sitecustomize.py', 'PYTHONBREAKPOINT': 'laspy.x',
                   'LD_LIBRARY_PATH': '.:', 'PYTHONWARNINGS': 'ignore', 'LC_ALL': 'C', 'PYTHONPLATLIBDIR': 'lib'}
    said = subprocess.run([sys.executable, script, folder, repr([str(folder) if place == 'FOLDER' else place for place in after]), *scans], capture_output=True, text=True,
                          env=environment, timeout=60)
    assert said.returncode == 0 and said.stdout.split() and set(said.stdout.split()) <= {'input', 'usage'}, said.stderr
    assert not list(folder.glob('hit*')) and not (folder / '__pycache__').exists()


# What a reader's process may do

ESCAPES = '''
import ctypes, os, socket, sys
from topple import _topple
own, other = sys.argv[1:]
_topple.confine([own], [own], os.getppid())
def attempts():
    yield 'read', lambda: open(other + '/secret').read()
    yield 'list', lambda: os.listdir(other)
    yield 'read by ..', lambda: open(own + '/../other/secret').read()
    yield 'read by a link', lambda: open(own + '/link').read()
    yield 'read /etc', lambda: open('/etc/passwd').read()
    yield 'read a parent', lambda: open(f'/proc/{os.getppid()}/environ').read()
    yield 'write', lambda: open(other + '/new', 'w')
    yield 'write over', lambda: open(other + '/secret', 'a')
    yield 'write by a link', lambda: open(own + '/link', 'a')
    yield 'move out', lambda: os.rename(own + '/file', other + '/file')
    yield 'delete', lambda: os.unlink(other + '/secret')
    yield 'mkdir', lambda: os.mkdir(other + '/new')
    yield 'rmdir', lambda: os.rmdir(other + '/empty')
    yield 'truncate', lambda: os.truncate(other + '/secret', 0)
    yield 'symlink', lambda: os.symlink('/etc', own + '/new')
    yield 'hard link', lambda: os.link(own + '/file', own + '/new')
    yield 'chmod', lambda: os.chmod(other + '/secret', 0o777)
    yield 'chown', lambda: os.chown(own + '/file', 0, 0)
    yield 'mkfifo', lambda: os.mkfifo(own + '/pipe')
    yield 'tcp', lambda: socket.socket()
    yield 'udp', lambda: socket.socket(type=socket.SOCK_DGRAM)
    yield 'unix', lambda: socket.socket(socket.AF_UNIX)
    yield 'pair', lambda: socket.socketpair()
    yield 'fork', lambda: os.fork() or os._exit(0)
    yield 'exec', lambda: os.execv('/bin/true', ['true'])
    yield 'spawn', lambda: os.posix_spawn('/bin/true', ['true'], {})
    yield 'kill', lambda: os.kill(os.getppid(), 0)
    yield 'kill a group', lambda: os.kill(0, 0)
    for number, call in ((101, 'ptrace'), (425, 'io_uring'), (165, 'mount'), (321, 'bpf'), (272, 'unshare'), (434, 'pidfd')):
        yield call, lambda: ctypes.CDLL(None).syscall(number, 0, 0, 0, 0) < 0 and 1 / 0
for name, attempt in attempts():
    try: attempt()
    except (OSError, ZeroDivisionError): continue
    print(name)
print(open(own + '/file').read(), file=open(own + '/made', 'w'))
import threading
thread = threading.Thread(target=print, args=('thread',))
thread.start()
thread.join()
'''


def has_landlock():
    import ctypes
    return ctypes.CDLL(None).syscall(444, None, 0, 1) > 0


@pytest.mark.skipif(os.uname().machine != 'x86_64' or not has_landlock(), reason='the kernel has no Landlock')
def test_a_reader_reaches_its_scan_alone(tmp_path):
    own, other = tmp_path / 'own', tmp_path / 'other'
    own.mkdir()
    (other / 'empty').mkdir(parents=True)
    (other / 'secret').write_text(SECRET)
    (own / 'file').write_text('own')
    (own / 'link').symlink_to(other / 'secret')
    said = subprocess.run([sys.executable, '-c', ESCAPES, own, other], capture_output=True, text=True, timeout=60)
    assert said.returncode == 0 and said.stdout.split() == ['thread'], said.stdout + said.stderr
    assert (other / 'secret').read_text() == SECRET and sorted(os.listdir(other)) == ['empty', 'secret']
    assert sorted(os.listdir(own)) == ['file', 'link', 'made']


LIES = [{'place': '/etc'}, {'place': '/etc/passwd'}, {'place': 'scan'}, {'place': '../scan'}, {'place': 3}, {'place': None}, {'place': 'FOLDER/../x'},
        {'place': 'FOLDER/none.ply'}, {'place': 'FOLDER/a/b'}, {'notes': 'text'}, {'notes': [3]}, {'notes': None}, {'offset': [0, 0]},
        {'offset': [0.0, 0.0, float('nan')]}, {'offset': [0.0, 0.0, float('inf')]}, {'offset': ['0', 0.0, 0.0]}, {'offset': None}, {'made': 'link'},
        {'made': 'linked folder'}, {'made': 'pipe'}, {'made': 'deep link'}]


@pytest.mark.parametrize('lie', LIES, ids=str)
def test_a_reader_that_lies_is_found_out(tmp_path, lie):
    folder = tmp_path / 'made' / 'scan'
    (folder / 'depth').mkdir(parents=True)
    (folder / 'points.ply').write_text('ply')
    said = {'place': 'FOLDER/points.ply', 'notes': ['a\x1b[31m', 'b\u202e'], 'offset': [0.0, 1.0, 2.0]}

    def checked(**other):
        answered = {name: value.replace('FOLDER', str(folder)) if isinstance(value, str) else value for name, value in {**said, **other}.items()}
        return apart._checked(answered, tmp_path / 'scan', folder, colmap)

    place, notes, offset = checked()
    assert place == folder / 'points.ply' and notes == ['a\\x1b[31m', 'b\\xe2\\x80\\xae'] and list(offset) == [0, 1, 2]
    made = lie.get('made')
    if made == 'pipe':
        os.mkfifo(folder / 'x')
    elif made:
        (folder / ('depth' if 'deep' in made else '') / 'x').symlink_to('/etc' if 'folder' in made else '/etc/passwd')
    with pytest.raises(topple.Error, match='makes no sense'):
        checked(**{name: value for name, value in lie.items() if name != 'made'})


# Names and links

def test_what_a_scan_names_lies_in_it(tmp_path):
    root = tmp_path / 'root'
    (root / 'inner').mkdir(parents=True)
    (tmp_path / 'secret').write_text(SECRET)
    (root / 'inner' / 'file').write_bytes(b'own')
    for name, target in (('link', '../secret'), ('inner/link', '/etc/passwd'), ('folder', '..'), ('loop', 'loop'), ('dangling', 'none'), ('to-own', 'inner/file')):
        (root / name).symlink_to(target)
    os.mkfifo(root / 'pipe')
    scan = scan_folder.ScanFolder(root)
    assert scan.read('inner/file') == b'own' and scan.has('inner/file') and not scan.has('none')
    (tmp_path / 'by-link').symlink_to(root)
    assert scan_folder.ScanFolder(tmp_path / 'by-link').read('inner/file') == b'own'
    for name in ('link', 'inner/link', 'folder/secret', 'folder', 'loop', 'dangling', 'to-own', 'pipe', 'inner', 'none', '../secret', 'inner/../../secret',
                 '/etc/passwd', '', '.', '..', './inner/file', 'inner//file', 'inner/', 'inner/file/', 'inner/file\0', 'a' * 5000, '\ud800'):
        assert not tried(scan.read, name), name
    for pathname in (root / 'pipe', root, pathlib.Path('/dev/zero')):
        assert not tried(scan_folder.regular, pathname), pathname


def dense(folder, secret=None, name=None):
    scan = colmap_dense(folder, [(POSES[0], np.ones((CAMERA.height, CAMERA.width)))])
    (scan / 'images').mkdir()
    (scan / 'images' / 'view 00.png').write_bytes(b'\x89PNG')
    if name:
        images_bin = scan / 'sparse' / 'images.bin'
        images_bin.write_bytes(images_bin.read_bytes().replace(b'view 00.png', name.encode()))
    return scan


LINKED = ['images/view 00.png', 'images', 'stereo/depth_maps/view 00.png.geometric.bin', 'stereo/depth_maps', 'stereo', 'sparse', 'sparse/cameras.bin',
          'sparse/images.bin']
NAMED = ['../../secret.png', '../../../etc/passwd', '/etc/passwd', '.', 'a/../../b', '\x1b[2J\u202e', 'a\nb', 'x' * 3000]


@pytest.mark.parametrize('links', [True, False])
def test_colmap_leads_nowhere(tmp_path, links):
    (tmp_path / 'secret.png').write_text(SECRET)
    for number, what in enumerate(LINKED if links else NAMED):
        scan = dense(tmp_path / f'scan {number}', name=None if links else what)
        if links:
            (scan / what).rename(tmp_path / f'moved {number}')
            (scan / what).symlink_to(tmp_path / f'moved {number}')
        else:
            (scan / 'secret.png.geometric.bin').write_bytes((scan / 'stereo/depth_maps/view 00.png.geometric.bin').read_bytes())
        out = tmp_path / f'out {number}'
        assert not tried(formats.convert, scan, out, formats.Options(isolate=False)), what
        assert not out.exists()
    model = colmap_model(tmp_path / 'fused', POSES[:1], ['a'], True)
    (model / 'fused.ply').symlink_to(tmp_path / 'secret.png')
    assert not tried(formats.convert, model, tmp_path / 'fused.ply', formats.Options(isolate=False))


def test_the_output_is_written_through_no_link(tmp_path):
    victim = tmp_path / 'victim'
    victim.write_text(SECRET)
    model = colmap_model(tmp_path / 'model', POSES[:1], ['a'], True, np.eye(3))
    (tmp_path / 'out.ply.topple-notes.txt').symlink_to(victim)
    (tmp_path / 'there.ply').symlink_to(victim)
    (tmp_path / 'dangling.ply').symlink_to(tmp_path / 'none')
    assert tried(formats.convert, model, tmp_path / 'out.ply', formats.Options(isolate=False))
    assert not any(tried(formats.convert, model, tmp_path / name, formats.Options(isolate=False)) for name in ('there.ply', 'dangling.ply'))
    assert victim.read_text() == SECRET and not (tmp_path / 'none').exists() and not (tmp_path / 'out.ply.topple-notes.txt').is_symlink()


# Texts that steer a terminal

STEERING = ['\x00', '\x07', '\x08', '\x1b[2J', '\x1b]0;x\x07', '\x7f', '\x80', '\x9b31m', '\x9d', '\xad', '\n', '\r', '\t', '\u061c', '\u200b', '\u200e',
            '\u200f', '\u2028', '\u2029', '\u202a', '\u202e', '\u2060', '\u2066', '\u2069', '\ufeff', '\ufff9', '\uffff', '\U000e0041', '\U0001d173',
            '\ud800', '\udc9b', '\udcff']


def test_texts_steer_nothing(tmp_path):
    for text in STEERING:
        for shown in (_arrays.printable(f'a{text}b'), str(_arrays.error('input', text)), str(topple.Error(_arrays.printable(text)))):
            assert shown.isprintable() and ('\\x' in shown), repr(text)
        assert not tried(formats.convert, tmp_path / f'{text.replace(chr(0), "")}.laz'.replace('/', ''), tmp_path / 'out.las')
    for text in ('plain', 'Küche', '客厅', '🛋', 'a\xa0b', "it's \\x1b"):
        assert _arrays.printable(text) == text
    for raw in (b'\xff', b'\xc0\x80', b'\xe0\x80\x80', b'\xed\xa0\x80', b'\xf0\x80\x80\x80', b'\xf4\x90\x80\x80', b'\xe2\x80', b'\xc2'):
        assert _topple.printable(raw, 99).isprintable() and '\\x' in _topple.printable(raw, 99), raw
    assert len(_arrays.printable('\x1b' * 10000, 100)) < 110


# Bombs

def zip_of(path, **files):
    with zipfile.ZipFile(path, 'w', zipfile.ZIP_DEFLATED) as archive:
        for name, data in files.items():
            archive.writestr(name, data)
    return path


def blank_png(width, height):
    """That says so, and has a few bytes."""
    def chunk(kind, data):
        return struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))
    return b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', struct.pack('>IIBBBBB', width, height, 16, 0, 0, 0, 0)) + chunk(b'IDAT', zlib.compress(b'')) + chunk(b'IEND', b'')


CAMERA_JSON = json.dumps({'fx': 9, 'fy': 9, 'cx': 4, 'cy': 4, 'width': 8, 'height': 8, **{f't_{r}{c}': float(r == c) for r in range(3) for c in range(4)}})
SMALL = png(np.ones((8, 8), np.uint16))
ARCHIVES = {
    'a bomb of zeros': {'keyframes/depth/1.png': bytes(80 << 20)},
    'a bomb of text': {'keyframes/cameras/1.json': '[' * (80 << 20)},
    'a deep text': {'keyframes/cameras/1.json': '[' * 200000},
    'a large image': {'keyframes/depth/1.png': blank_png(30000, 30000)},
    'an image of promises': {'keyframes/depth/1.png': blank_png(2 ** 31 - 1, 2 ** 31 - 1)},
    'a flat image': {'keyframes/depth/1.png': blank_png(0, 5)},
    'PostScript': {'keyframes/depth/1.png': b'%!PS-Adobe-3.0 EPSF-3.0\n%%BoundingBox: 0 0 8 8\n'},
    'no image': {'keyframes/depth/1.png': b'GIF89a' + bytes(99)},
    'no numbers': {'keyframes/cameras/1.json': CAMERA_JSON.replace('9', '"x"')},
    'NaN': {'keyframes/cameras/1.json': CAMERA_JSON.replace('1.0', 'NaN')},
    'no size': {'keyframes/cameras/1.json': CAMERA_JSON.replace('"width": 8', '"width": 0')},
    'an endless number': {'keyframes/cameras/1.json': CAMERA_JSON.replace('"width": 8', '"width": 1e999')},
    'digits': {'keyframes/cameras/1.json': CAMERA_JSON.replace('"width": 8', '"width": ' + '9' * 100000)},
    'a list': {'keyframes/cameras/1.json': '[]'},
}


@pytest.mark.parametrize('what', ARCHIVES)
def test_archives_that_harm(tmp_path, what):
    pytest.importorskip('PIL')
    sound = {'keyframes/depth/1.png': SMALL, 'keyframes/cameras/1.json': CAMERA_JSON}
    path = zip_of(tmp_path / 'scan.zip', **{**sound, '../../out': 'x', '/tmp/out': 'x', '..\\out': 'x', 'a\x1b[2J': 'x', **ARCHIVES[what]})
    (tmp_path / 'made').mkdir()
    assert formats.format_of(path) is polycam
    def convert():
        with formats.reading(path, polycam.FORMAT):
            polycam.convert(path, tmp_path / 'made', formats.Options())
    assert not tried(convert)
    assert sorted(os.listdir(tmp_path)) == ['made', 'scan.zip']


def test_archives_count_what_they_unpack(tmp_path):
    path = zip_of(tmp_path / 'many.zip', **{f'keyframes/depth/{n}.png': bytes(1 << 20) for n in range(90)})
    with packed_folder.PackedFolder(path, 'keyframes/depth/', limits.Budget(path, formats.Options())) as export:
        assert sum(tried(export.read, f'keyframes/depth/{n}.png') for n in range(90)) == export.budget.whole >> 20 < 90
    for raw in (b'', b'PK', b'PK\x05\x06' + b'\xff' * 18, b'keyframes/depth/' * 99, b'PK\x03\x04' + bytes(9999)):
        (tmp_path / 'odd.zip').write_bytes(raw)
        assert not tried(formats.format_of, tmp_path / 'odd.zip') or raw == b''
    sparse = tmp_path / 'sparse.e57'
    with open(sparse, 'wb') as file:
        file.truncate(1 << 40)
    assert limits.size_of(sparse) < 1 << 20


def test_what_packages_unpack_is_counted(tmp_path, monkeypatch):
    lzfse = pytest.importorskip('liblzfse')
    monkeypatch.setattr(limits, 'LEAST_UNPACKED', 1 << 20)
    metadata = json.dumps({'w': 8, 'h': 8, 'K': [9, 0, 0, 0, 9, 0, 4, 4, 1], 'poses': [[0, 0, 0, 1, 0, 0, 0]]})
    scan = zip_of(tmp_path / 'scan.zip', metadata=metadata, **{'rgbd/0.depth': lzfse.compress(bytes(4 << 20))}).rename(tmp_path / 'scan.r3d')
    (tmp_path / 'made').mkdir()
    with pytest.raises(topple.Error, match='no sound scan of its size'):
        record3d.convert(scan, tmp_path / 'made', formats.Options())


def test_pipes_are_not_waited_for(tmp_path):
    for name in ('scan.bag', 'scan.e57', 'scan.zip', 'scan.laz', 'scan.ply', 'points3D.bin'):
        os.mkfifo(tmp_path / name)
        assert not tried(topple.parse, tmp_path / name), name
