# SPDX-License-Identifier: MIT
"""Inputs that nobody would write by intent: good files of every format, and what can be done to them.

cases(good, rng) yields (name, make), where make(folder) writes the input into an empty folder and returns the
words of the command line after `topple`. The same seed gives the same cases.
"""
import json
import math
import os
import pathlib
import random
import struct
import sys
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / 'fuzz'))
import seeds  # noqa: E402

EXTENSION = {'ply': 'ply', 'pcd': 'pcd', 'xyz': 'xyz', 'las': 'las', 'obj': 'obj', 'stl': 'stl', 'glb': 'glb',
             'octomap': 'bt'}
# What counts and sizes are set to.
WORDS = (0, 1, 0x7fffffff, 0x80000000, 0xffffffff, 0x00ffffff, 0x7f800000, 0x7fc00000, 0xff7fffff)
NUMBERS = ('0', '-1', '1e308', '1e400', 'nan', 'inf', '-inf', '4294967295', '4294967296', '18446744073709551615',
           '99999999999999999999999', '1e-320', '0x10', '', '"', '1 1', 'ä', '\0')
VALUES = (None, True, -1, 0, 1e308, 10 ** 30, 1e-320, 'x', '', [], {}, [[]], {'a': 1}, [1, 'a', None], 4294967295, 0.5)


def box_points(spacing):
    """Points on the sides of a box of 0.6 x 0.4 x 0.5 m on a floor of 1.6 m."""
    def steps(low, high):
        n = max(2, int(round((high - low) / spacing)) + 1)
        return [low + (high - low) * i / (n - 1) for i in range(n)]
    points = [(x, y, 0.0) for x in steps(-0.8, 0.8) for y in steps(-0.8, 0.8)]
    xs, ys, zs = steps(-0.3, 0.3), steps(-0.2, 0.2), steps(0.0, 0.5)
    points += [(x, y, z) for x in xs for y in (-0.2, 0.2) for z in zs]
    points += [(x, y, z) for x in (-0.3, 0.3) for y in ys for z in zs]
    return points + [(x, y, 0.5) for x in xs for y in ys]


def room_files():
    """Small clouds that a parse goes through with, by extension."""
    points = box_points(0.03)
    raw = b''.join(struct.pack('<3f', *p) for p in points)
    text = ''.join('%.4f %.4f %.4f\n' % p for p in points)
    head = 'ply\nformat %s 1.0\nelement vertex ' + str(len(points)) + \
        '\nproperty float x\nproperty float y\nproperty float z\nend_header\n'
    yield 'ply', (head % 'ascii' + text).encode()
    yield 'ply', (head % 'binary_little_endian').encode() + raw
    yield 'pcd', ('# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH %d\nHEIGHT 1\n'
                  'VIEWPOINT 0 0 0 1 0 0 0\nPOINTS %d\nDATA binary\n' % (len(points), len(points))).encode() + raw
    yield 'xyz', text.encode()


def chunk(kind, data):
    return struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))


def png(width, height, bits=16, colour=0, rows=None):
    if rows is None:
        rows = b''.join(b'\0' + struct.pack('>%dH' % width, *((1000 + 3 * x + y) & 0xffff for x in range(width)))
                        for y in range(height))
    return (b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', struct.pack('>IIBBBBB', width, height, bits, colour, 0, 0, 0))
            + chunk(b'IDAT', zlib.compress(rows)) + chunk(b'IEND', b''))


def empty_png(side, bits, colour, channels):
    """All zero, packed to a thousandth, without holding it."""
    row = b'\0' * (1 + side * channels * bits // 8)
    packer, data = zlib.compressobj(9), b''
    for _ in range(side):
        data += packer.compress(row)
    data += packer.flush()
    return (b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', struct.pack('>IIBBBBB', side, side, bits, colour, 0, 0, 0))
            + chunk(b'IDAT', data) + chunk(b'IEND', b''))


def frames(folder, width=48, height=36, count=3, intrinsics=None, depth=None, trajectory=None):
    (folder / 'depth').mkdir(parents=True)
    for n in range(count):
        (folder / 'depth' / ('%d.png' % n)).write_bytes(depth() if callable(depth) else depth or png(width, height))
    good = {'width': width, 'height': height, 'fx': 40.0, 'fy': 40.0, 'cx': 23.5, 'cy': 17.5, 'depth_scale': 1000}
    text = json.dumps(good) if intrinsics is None else intrinsics
    (folder / 'intrinsics.json').write_text(text)
    poses = ''.join('%d %g 0 1 0 0 0 1\n' % (n, 0.01 * n) for n in range(count)) if trajectory is None else trajectory
    if poses:
        (folder / 'trajectory.txt').write_text(poses)


def glb_of(root, data=b''):
    text = json.dumps(root, separators=(',', ':')).encode() if not isinstance(root, bytes) else root
    text += b' ' * (-len(text) % 4)
    binary = struct.pack('<I', len(data)) + b'BIN\0' + data if data else b''
    return b'glTF' + struct.pack('<III', 2, 20 + len(text) + len(binary), len(text)) + b'JSON' + text + binary


def glb_parts():
    good = next(seeds.glb())
    size = struct.unpack_from('<I', good, 12)[0]
    return json.loads(good[20:20 + size]), good[28 + size:]


# --- what is done to any file ----------------------------------------------------------------------------------

def cut(data, share):
    return data[:int(len(data) * share)]


def flipped(data, rng, count):
    out = bytearray(data)
    for _ in range(count):
        at = rng.randrange(len(out))
        out[at] ^= 1 << rng.randrange(8)
    return bytes(out)


def word_set(data, rng, value):
    out = bytearray(data)
    at = rng.randrange(max(1, len(out) - 4))
    out[at:at + 4] = struct.pack('<I', value)[:max(0, min(4, len(out) - at))]
    return bytes(out)


def number_set(data, rng, text):
    """One of its words that is a number, mostly of its first lines, becomes another."""
    places, at = [], 0
    for token in data[:4000].replace(b'\n', b' ').split(b' '):
        if token[:1] in b'-0123456789' and token:
            places.append((at, at + len(token)))
        at += len(token) + 1
    if not places:
        return data
    low, high = rng.choice(places)
    return data[:low] + text.encode() + data[high:]


def mutations(data, rng, each):
    for n in range(each):
        yield 'cut', cut(data, (n + 0.5) / each)
        yield 'flip', flipped(data, rng, 1 << rng.randrange(6))
        yield 'word', word_set(data, rng, rng.choice(WORDS))
        yield 'number', number_set(data, rng, rng.choice(NUMBERS))
    middle = len(data) // 2
    yield 'twice', data + data
    yield 'hole', data[:middle] + b'\0' * 64 + data[middle + 64:]
    yield 'tail', data + bytes(range(256))
    yield 'zeros', b'\0' * len(data)


def json_places(value, path=()):
    yield path
    if isinstance(value, dict):
        for key in value:
            yield from json_places(value[key], path + (key,))
    elif isinstance(value, list):
        for n in range(min(len(value), 4)):
            yield from json_places(value[n], path + (n,))


REMOVED = object()


def json_set(value, path, other):
    """With another value at that place, or none."""
    if not path:
        return other
    out = dict(value) if isinstance(value, dict) else list(value)
    if other is REMOVED and len(path) == 1:
        del out[path[0]]
    else:
        out[path[0]] = json_set(value[path[0]], path[1:], other)
    return out


def json_variants(value, rng, count):
    places = list(json_places(value))
    for _ in range(count):
        path = rng.choice(places)
        other = REMOVED if path and rng.random() < 0.2 else rng.choice(VALUES)
        yield json.dumps(json_set(value, path, other))
    yield '[' * 200000
    yield '{"a":' * 100000
    yield json.dumps(value)[:-1]
    yield ''
    yield '\ufeff' + json.dumps(value)


# --- what takes a writer of its own ---------------------------------------------------------------------------

def hostile_glbs():
    root, data = glb_parts()

    def nodes(count, children):
        return dict(root, nodes=[dict(children(n), mesh=0) for n in range(count)])
    yield 'chain', glb_of(nodes(100000, lambda n: {'children': [n + 1]} if n < 99999 else {}), data)
    yield 'cycle', glb_of(nodes(3, lambda n: {'children': [(n + 1) % 3]}), data)
    yield 'itself', glb_of(nodes(1, lambda n: {'children': [0]}), data)
    yield 'doubled', glb_of(nodes(40, lambda n: {'children': [n + 1, n + 1]} if n < 39 else {}), data)
    yield 'nobody', glb_of(nodes(2, lambda n: {'children': [7]}), data)
    yield 'wide', glb_of(dict(nodes(60000, lambda n: {}), scenes=[{'nodes': list(range(60000))}]), data)
    yield 'materials', glb_of(dict(root, materials=[{}] * 100000), data)
    yield 'textures', glb_of(dict(root, textures=[{}] * 100000, images=[{}] * 100000), data)
    primitive = root['meshes'][0]['primitives'][0]
    yield 'primitives', glb_of(dict(root, meshes=[{'primitives': [primitive] * 60000}]), data)
    yield 'meshes', glb_of(dict(root, meshes=[{'primitives': [primitive]}] * 60000), data)
    many = b'\0' * (12 * 100000)
    big = dict(root, accessors=[{'bufferView': 0, 'componentType': 5126, 'count': 100000, 'type': 'VEC3'}],
               bufferViews=[{'buffer': 0, 'byteLength': len(many)}], buffers=[{'byteLength': len(many)}])
    shared = {'attributes': {'POSITION': 0, 'NORMAL': 0}}
    yield 'shared', glb_of(dict(big, meshes=[{'primitives': [shared] * 5000}]), many)
    yield 'targets', glb_of(dict(big, meshes=[{'primitives': [dict(shared, targets=[{'POSITION': 0}] * 5000)]}]), many)
    yield 'images', glb_of(dict(big, images=[{'bufferView': 0, 'mimeType': 'image/png'}] * 5000), many)
    yield 'samplers', glb_of(dict(big, animations=[{'samplers': [{'input': 0, 'output': 0}] * 3000, 'channels': [
        {'sampler': n, 'target': {'node': 0, 'path': 'scale'}} for n in range(3000)]}]), many)
    yield 'skins', glb_of(dict(root, skins=[{'joints': [0] * 20000}], nodes=[{'mesh': 0, 'skin': 0}] * 200), data)
    yield 'names', glb_of(dict(root, nodes=[{'mesh': 0, 'name': 'n' * 5000000}]), data)
    yield 'brackets', glb_of(b'[' * 1000000)
    yield 'extras', glb_of(b'{"extras":' * 500000 + b'1' + b'}' * 500000)
    for uri in ('../../../../etc/passwd', '/etc/passwd', 'file:///etc/passwd', '%2e%2e/x', 'fifo', 'out', 'a\0b', '',
                '/dev/zero', 'http://localhost/x'):
        yield 'uri', glb_of(dict(root, buffers=[{'byteLength': 168, 'uri': uri}]))
    yield 'huge', glb_of(dict(root, nodes=[{'mesh': 0, 'scale': [1e30, 1e30, 1e30]}]), data)
    yield 'far', glb_of(dict(root, nodes=[{'mesh': 0, 'scale': [1e4, 1e4, 1e4]}]), data)
    yield 'nan', glb_of(root, struct.pack('<24f', *[math.nan] * 24) + data[96:])
    yield 'version', glb_of(root, data)[:4] + struct.pack('<I', 9) + glb_of(root, data)[8:]


def hostile_gltfs():
    root, data = glb_parts()
    for uri in ('a.bin', '../a.bin', '/etc/passwd', 'file:///etc/passwd', '%2e%2e/a.bin', 'fifo', 'out', 'dir', '/dev/zero',
                '', 'x' * 5000, 'data:;base64,' + 'A' * 224, 'data:;base64,@@@', 'data:application/octet-stream,abc'):
        yield json.dumps(dict(root, buffers=[{'byteLength': 168, 'uri': uri}]))


def hostile_files():
    """Pairs of a file's name and its bytes."""
    for name, data in hostile_glbs():
        yield name + '.glb', data
    yield 'groups.obj', b'v 0 0 0\nv 1 0 0\nv 0 1 0\n' + b''.join(b'g %d\nf 1 2 3\n' % n for n in range(200000))
    yield 'objects.obj', b'o a\n' * 800000 + b'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n'
    yield 'materials.obj', b'mtllib fifo\nv 0 0 0\nv 1 0 0\nv 0 1 0\n' + b'usemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\n' * 50000
    yield 'faces.obj', b'v 0 0 0\nv 1 0 0\nv 0 1 0\n' + b'f 1 2 3\n' * 400000
    yield 'corners.obj', b'v 0 0 0\nv 1 0 0\nv 0 1 0\nf' + b' 1 2 3' * 500000 + b'\n'
    yield 'lines.obj', b'v 0 0 0\nv 1 0 0\n' + b'l 1 2\n' * 500000
    yield 'points.obj', b'v 0 0 0\nv 1 0 0\n' + b'p 1\n' * 800000
    yield 'index.obj', b'v 0 0 0\nv 1 0 0\nf 1 2 3\nf -9 1 2\nf 0 0 0\nf 4294967296 1 2\nf 1//9 2//9 1//9\n'
    yield 'backslash.obj', b'v 0 0 0\nf 1 \\\n' * 200000
    yield 'solids.stl', b'solid facet\n' * 300000
    yield 'facets.stl', b'solid a\n' + b'facet\n' * 500000
    yield 'count.stl', b' ' * 80 + struct.pack('<I', 0xffffffff) + b'\0' * 100
    yield 'elements.ply', b'ply\nformat ascii 1.0\n' + b''.join(b'element e%d 1\n' % n for n in range(50000)) + b'end_header\n'
    yield 'properties.ply', (b'ply\nformat ascii 1.0\nelement vertex 1\n'
                             + b''.join(b'property float p%d\n' % n for n in range(100000)) + b'end_header\n')
    for line in (b'format binary_little_endian 1.0', b'element vertex\0 3', b'property float y\fz', b'element face 2 3'):
        yield 'confused.ply', (b'ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n'
                               b'property float z\n' + line + b'\nelement face 1\nproperty list uchar int vertex_indices\n'
                               b'end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n')
    yield 'endless.ply', b'ply\nformat ascii 1.0\n' + b'comment a\n' * 300000
    yield 'line.ply', b'ply\nformat ascii 1.0\ncomment ' + b'a' * 3000000
    for size in ('1e-30', '1e-300', '1e30', '1e400', '0', '-1', 'nan', '4e-5', '1e-4', '2000'):
        for data in seeds.octomap():
            yield 'size.bt', data.replace(b'res 0.1', b'res ' + size.encode())
    yield 'full.bt', b'# Octomap OcTree binary file\nid OcTree\nsize 1\nres 0.05\ndata\n\xaa\xaa'
    yield 'tree.bt', b'# Octomap OcTree binary file\nid OcTree\nsize 1\nres 0.05\ndata\n' + b'\xff\xff' * 400000
    yield 'deep.bt', b'# Octomap OcTree binary file\nid OcTree\nsize 1\nres 0.05\ndata\n' + b'\x03\x00' * 400000
    yield 'deep.ot', b'# Octomap OcTree file\nid OcTree\nsize 1\nres 0.05\ndata\n' + struct.pack('<fB', 1, 1) * 100000
    yield 'kind.bt', b'# Octomap OcTree binary file\nid ColorOcTree\nsize 1\nres 0.05\ndata\n\xaa\xaa'
    yield 'lzf.pcd', (b'# .PCD v0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 300000000\nHEIGHT 1\n'
                      b'POINTS 300000000\nDATA binary_compressed\n' + struct.pack('<II', 900, 3600000000) + b'\xe0' * 900)
    yield 'count.pcd', (b'# .PCD v0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 4000000000\nWIDTH 1\nHEIGHT 1\n'
                        b'POINTS 1\nDATA binary\n' + b'\0' * 12)
    yield 'image.pcd', (b'# .PCD v0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 65536\nHEIGHT 65536\n'
                        b'POINTS 4294967296\nDATA ascii\n0 0 0\n')
    for scale in (0.0, -1.0, 1e-300, 1e300, math.nan, math.inf):
        data = bytearray(next(seeds.las()))
        struct.pack_into('<3d', data, 131, scale, scale, scale)
        yield 'scale.las', bytes(data)
        struct.pack_into('<3d', data, 131, 0.001, 0.001, 0.001)
        struct.pack_into('<3d', data, 155, scale, scale, scale)
        yield 'offset.las', bytes(data)
    yield 'same.xyz', b'1 2 3\n' * 20000
    yield 'line.xyz', b''.join(b'%d 0 0\n' % n for n in range(20000))
    yield 'spread.xyz', b''.join(b'%d %d %d\n' % (n * 7919 % 999983, n * 104729 % 999983, n * 31 % 999983) for n in range(3000))
    yield 'wide.xyz', b'1 ' * 1000000 + b'\n'
    yield 'word.xyz', b'1' * 3000000 + b' 2 3\n'
    yield 'empty.ply', b''
    yield 'empty.vdb', b''
    yield 'empty.glb', b''
    yield 'header.vdb', b' BDV\0\0\0\0' + struct.pack('<I', 224) + b'\xff' * 200


def hostile_folders():
    """Pairs of a name and what frames() takes."""
    yield 'bomb', dict(width=30000, height=30000, count=1, trajectory='', depth=lambda: empty_png(30000, 16, 0, 1))
    yield 'no-depth', dict(count=0)
    yield 'many-poses', dict(trajectory='0 0 0 0 0 0 0 1\n' * 200000)
    yield 'nan-poses', dict(trajectory='0 nan 0 0 0 0 0 1\n' * 3)
    yield 'zero-poses', dict(trajectory='0 0 0 0 0 0 0 0\n' * 3)
    yield 'far-poses', dict(trajectory='0 1e30 0 0 0 0 0 1\n' * 3)
    yield 'apart', dict(trajectory='0 0 0 0 0 0 0 1\n1 900000 0 0 0 0 0 1\n2 0 900000 0 0 0 0 1\n')
    yield 'colour', dict(depth=png(48, 36, 8, 2, b''.join(b'\0' + b'\1\2\3' * 48 for _ in range(36))))
    yield 'small', dict(depth=png(12, 9))
    yield 'large', dict(depth=png(480, 36))
    yield 'empty', dict(depth=b'\x89PNG\r\n\x1a\n')
    yield 'short', dict(depth=png(48, 36)[:-30])
    yield 'dark', dict(depth=png(48, 36, rows=(b'\0' + b'\0\0' * 48) * 36))
    yield 'text', dict(depth=b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', struct.pack('>IIBBBBB', 48, 36, 16, 0, 0, 0, 0))
                       + chunk(b'zTXt', b'a\0\0' + zlib.compress(b'a' * 100000000)) + chunk(b'IEND', b''))


def special_files(folder):
    """Files of kinds that must not be opened, beside the input."""
    os.mkfifo(folder / 'fifo')
    os.symlink('/etc/hostname', folder / 'out')
    os.mkdir(folder / 'dir')
    (folder.parent / 'a.bin').write_bytes(b'\0' * 168)


def cases(good, rng, each):
    """good: a folder with volume.vdb, map.bt, objects.glb, scene.json, landscapes.json of a parse."""
    def put(name, data, *words):
        def make(folder):
            (folder / name).write_bytes(data)
            return ['parse', folder / name, *words]
        return make

    files = [(kind + '-' + str(n), 'in.' + extension, data) for kind, extension in EXTENSION.items()
             for n, data in enumerate(getattr(seeds, kind)())]
    files += [('room-%d' % n, 'in.' + extension, data) for n, (extension, data) in enumerate(room_files())]
    files += [('volume', 'in.vdb', (good / 'volume.vdb').read_bytes()), ('map', 'in.bt', (good / 'map.bt').read_bytes()),
              ('objects', 'in.glb', (good / 'objects.glb').read_bytes())]
    for kind, name, data in files:
        for how, changed in mutations(data, rng, each):
            yield kind + ' ' + how, put(name, changed)
    for _ in range(8 * each):
        data = (good / 'volume.vdb').read_bytes()
        changed = bytearray(data)
        for _ in range(1 << rng.randrange(8)):  # most of its counts stand in front
            changed[rng.randrange(16, min(len(data), 6000))] = rng.randrange(256)
        yield 'volume head', put('in.vdb', bytes(changed))
    for name, data in hostile_files():
        yield 'hostile ' + name, put(name, data)
        if name.endswith(('.glb', '.obj', '.bt')):
            yield 'estimate ' + name, lambda folder, n=name, d=data: ['estimate'] + put(n, d)(folder)[1:2]
    root, _ = glb_parts()
    for text in json_variants(root, rng, 8 * each):
        yield 'json glb', put('in.glb', glb_of(text.encode(), glb_parts()[1]))
    for text in hostile_gltfs():
        def make(folder, text=text):
            special_files(folder)
            (folder / 'a.bin').write_bytes(glb_parts()[1])
            return put('in.gltf', text.encode())(folder)
        yield 'uri gltf', make
    for name in ('a.ply', 'a.vdb', 'a.bt', 'a.glb', 'a.gltf', 'a.obj', 'a.las', 'a.png', 'a'):
        for special in ('fifo', 'out', 'dir', '/dev/zero', '/dev/null', 'missing'):
            def make(folder, name=name, special=special):
                special_files(folder)
                os.symlink(special, folder / name)
                return ['parse', folder / name]
            yield 'special ' + name, make
    yield from folder_cases(rng, each)
    yield from result_cases(good, rng, each)
    yield from side_cases(rng, each, put)


def folder_cases(rng, each):
    def scan(files=None, **arguments):
        """A folder of frames, and what else is in it by name."""
        def make(folder):
            frames(folder / 'in', **arguments)
            for name, data in (files or {}).items():
                (folder / 'in' / name).parent.mkdir(exist_ok=True)
                (folder / 'in' / name).write_bytes(data() if callable(data) else data)
            return ['parse', folder / 'in']
        return make

    camera = {'width': 48, 'height': 36, 'fx': 40.0, 'fy': 40.0, 'cx': 23.5, 'cy': 17.5}
    for text in json_variants(dict(camera, depth_scale=1000, color_intrinsics=camera), rng, 10 * each):
        yield 'json intrinsics', scan(intrinsics=text)
    for name, arguments in hostile_folders():
        yield 'frames ' + name, scan(**arguments)
    for how, data in mutations(png(48, 36), rng, 2 * each):
        yield 'depth ' + how, scan(depth=data)
    colour = png(48, 36, 8, 2, b''.join(b'\0' + b''.join(bytes((x * 5 % 256, y * 7 % 256, 40)) for x in range(48))
                                        for y in range(36)))
    for how, data in mutations(colour, rng, each):
        yield 'colour ' + how, scan({'color/%d.png' % n: data for n in range(3)})
    yield 'colour bomb', scan({'color/0.png': lambda: empty_png(8000, 8, 2, 3)}, count=1, trajectory='')
    for text in seeds.trajectory():
        for how, data in mutations(text, rng, each):
            yield 'trajectory ' + how, scan({'trajectory.txt': data}, count=2, trajectory='')


def result_cases(good, rng, each):
    """Outputs of a parse as inputs of `topple landscape`."""
    texts = {name: (good / name).read_text() for name in ('scene.json', 'landscapes.json')}
    for name, text in texts.items():
        changed = list(json_variants(json.loads(text), rng, 10 * each))
        changed += [data.decode('latin-1') for _, data in mutations(text.encode(), rng, each)]
        for data in changed:
            def make(folder, name=name, data=data):
                for other, own in texts.items():
                    (folder / other).write_text(data if other == name else own, encoding='latin-1', errors='replace')
                return ['landscape', folder, '--object', '1']
            yield 'landscape ' + name, make


def side_cases(rng, each, put):
    """Recordings of movement and of the ground, beside a good cloud."""
    cloud = next(data for extension, data in room_files() if extension == 'xyz')
    sides = [('bvh', 'm.bvh', '--motion'), ('joints', 'm.csv', '--motion'), ('record_json', 'r.json', '--accelerogram'),
             ('record_text', 'r.txt', '--accelerogram')]
    for kind, name, option in sides:
        for data in getattr(seeds, kind)():
            for how, changed in mutations(data, rng, each):
                def make(folder, name=name, option=option, changed=changed):
                    (folder / name).write_bytes(changed)
                    return put('in.xyz', cloud, option, folder / name)(folder)
                yield kind + ' ' + how, make
    deep = 'HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 0\n' + 'JOINT b\n{\nOFFSET 0 1 0\nCHANNELS 0\n' * 50000
    wide = '{"dT": 0.01, "accel_data": [' + '1,' * 3000000 + '1]}'
    for name, option, text in (('m.bvh', '--motion', deep), ('r.json', '--accelerogram', wide),
                               ('r.json', '--accelerogram', '[' * 3000000),
                               ('r.json', '--accelerogram', '{"dT": 1e-300, "accel_data": [1, 2]}'),
                               ('r.json', '--accelerogram', '{"dT": 0.1, "accel_data": [1e400, 2]}')):
        def make(folder, name=name, option=option, text=text):
            (folder / name).write_text(text)
            return put('in.xyz', cloud, option, folder / name)(folder)
        yield 'side ' + name, make
