# SPDX-License-Identifier: MIT
"""Files that topple wrote itself, changed by who knows how they are made: binary ones get a right checksum.

cases(program, work, rng, each) yields (name, make) as inputs.cases() does, for what reads such files: export, verify,
landscape, ask, parse with --cache, parses that go on in blocks, and `topple.load` where Python has it ('load').
"""
import ctypes
import json
import os
import pathlib
import re
import shutil
import struct
import subprocess
import time

import inputs

SUM = 16  # bytes of a checksum, at the end
LONGS = (0, 1, 1 << 16, 1 << 31, 1 << 32, (1 << 63) - 1, 1 << 63, (1 << 64) - 1)
DOUBLES = (float('nan'), float('inf'), -1e308, 1e-308, -1.0, 1e9)
SHORTS = (-1, 0, 1, 255, 1 << 20, (1 << 29) + 7, (1 << 31) - 1, -(1 << 31), -(1 << 30), -2)


class Sums(ctypes.Structure):
    _fields_ = [('low', ctypes.c_uint64), ('high', ctypes.c_uint64)]


def hasher():
    """XXH3 of 128 bits, or None where its library is missing."""
    try:
        function = ctypes.CDLL('libxxhash.so.0').XXH3_128bits
    except (OSError, AttributeError):
        return None
    function.argtypes, function.restype = [ctypes.c_char_p, ctypes.c_size_t], Sums
    return function


def sealed(data, function):
    value = function(bytes(data[:-SUM]), len(data) - SUM)
    return bytes(data[:-SUM]) + struct.pack('<QQ', value.low, value.high)


def forged(data, rng, first):
    """Some words of it, from byte `first` on, become others: in place, or two of its own change places."""
    out = bytearray(data)
    end = len(out) - SUM
    # Heads and counts stand in front, or before an array.
    for _ in range(1 << rng.randrange(4)):
        span = min(end, first + 600) if rng.random() < 0.4 else end
        at = rng.randrange(first, span - 8)
        kind = rng.randrange(6)
        if kind == 0:
            out[at] = rng.randrange(256)
        elif kind == 1:
            out[at:at + 4] = struct.pack('<i', rng.choice(SHORTS))
        elif kind == 2:
            out[at:at + 8] = struct.pack('<Q', rng.choice(LONGS))
        elif kind == 3:
            out[at:at + 8] = struct.pack('<d', rng.choice(DOUBLES))
        elif kind == 4:
            other = rng.randrange(first, end - 8)
            out[at:at + 4], out[other:other + 4] = out[other:other + 4], out[at:at + 4]
        else:
            out[at:at + 4] = struct.pack('<f', rng.choice((float('nan'), float('inf'), -1e38)))
    return out


class SolidsFile:
    """solids.bin by its arrays: the head of nine words tells how long they are."""

    def __init__(self, data):
        self.data = data
        cells, below, strays, boundary, patches, primitives = struct.unpack_from('<6Q', data, 24)
        self.arrays, at = [], 72
        for name, size, count in (
                [(n, 4, cells) for n in ('i', 'j', 'k', 'primitive')] + [('basis', 1, cells), ('below', 1, below)]
                + [('stray ' + n, 4, strays) for n in ('i', 'j', 'k', 'primitive')] + [('stray basis', 1, strays)]
                + [('boundary ' + n, 4, boundary) for n in ('i', 'j', 'k', 'primitive')]
                + [('slot', 4, boundary)] * 4 + [('form', 4, boundary), ('share', 4, boundary)]
                + [('moment', 4, boundary)] * 3 + [('patch', 120, patches), ('patch primitive', 4, patches)]
                + [('role', 1, primitives)]):
            self.arrays.append((name, size, at, count))
            at += size * count

    def variants(self, rng):
        """Of each array its first, last and some other value, set to what it must not be, and to what it may be."""
        for name, size, at, count in self.arrays:
            for _ in range(2):
                for place in {0, count - 1, rng.randrange(max(count, 1))} if count else ():
                    out = bytearray(self.data)
                    where = at + size * place
                    if size == 1:
                        out[where] = rng.choice((7, 128, 255, 3))
                    elif size == 4:
                        out[where:where + 4] = struct.pack('<i', rng.choice(SHORTS))
                    else:
                        where += 8 * rng.randrange(15)
                        out[where:where + 8] = struct.pack('<d', rng.choice(DOUBLES))
                    yield name, out


def work_folder(program, folder):
    """What a parse in blocks leaves that was killed once its blocks were there; None where none could be killed so."""
    cloud = folder / 'in.xyz'
    words = [str(program), 'parse', str(cloud), '-o', str(folder / 'OUT'), *WORK_WORDS]
    left = folder / '.OUT.topple-work'
    for _ in range(20):
        run = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while run.poll() is None and not (left / 'block-0').exists():
            time.sleep(0.001)
        run.kill()
        run.wait()
        if (left / 'block-0').exists():
            return left
        shutil.rmtree(folder / 'OUT', ignore_errors=True)
    return None


WORK_WORDS = ('--backend', 'native', '--quiet', '--walks', '5', '--tile', '5', '--voxel', '0.08')


def put_all(folder, good, names, changed, data):
    for name in names:
        (folder / name).write_bytes(data if name == changed else (good / name).read_bytes())


def cases(program, good, rng, each):
    """good: the outputs of a parse, beside which its cloud box.xyz lies."""
    function = hasher()
    results = ('scene.json', 'landscapes.json', 'points.ply', 'solid.ply', 'solids.bin')
    exports = ('export', '.', '--mjcf', 'm', '--urdf', 'u', '--sdf', 's', '--usd', 's.usda')

    def result_case(name, data, words):
        def make(folder):
            put_all(folder, good, results, name, data)
            return [folder if word == '.' else word for word in words]
        return make

    texts = {name: (good / name).read_bytes() for name in ('scene.json', 'landscapes.json')}
    for name, data in texts.items():
        changed = [text.encode('utf-8', 'replace') for text in inputs.json_variants(json.loads(data), rng, 25 * each)]
        changed += [other for _, other in inputs.mutations(data, rng, each)]
        for other in changed:
            for words in ((exports, ('verify', '.', '--seconds', '0.1'), ('ask', '.', '--without', '1')) if name == 'scene.json' else ()) + (
                    ('landscape', '.', '--object', '1'), ('load', '.')):
                if rng.random() < 0.4:
                    yield 'own %s %s' % (words[0], name), result_case(name, other, words)
    for name in ('points.ply', 'solid.ply'):
        for _, other in inputs.mutations((good / name).read_bytes(), rng, 4 * each):
            yield 'own load ' + name, result_case(name, other, ('load', '.'))
            if name == 'solid.ply':
                yield 'own ask ' + name, result_case(name, other, ('ask', '.', '--without', '1'))
            if name == 'points.ply' and rng.random() < 0.3:
                yield 'own export ' + name, result_case(name, other, exports)
    if function is None:
        print('own files with checksums are left out: libxxhash.so.0 is missing')
        return
    solids = (good / 'solids.bin').read_bytes()
    variants = list(SolidsFile(solids).variants(rng))
    variants += [('words', forged(solids, rng, 16)) for _ in range(15 * each)]
    for name, other in variants:
        other = sealed(other, function)
        yield 'own export solids.bin ' + name, result_case('solids.bin', other, exports)
        if rng.random() < 0.3:
            yield 'own load solids.bin ' + name, result_case('solids.bin', other, ('load', '.'))
    yield from cache_cases(program, good, rng, each, function)
    yield from work_cases(program, good, rng, each, function)


def cache_cases(program, good, rng, each, function):
    cloud = good.parent / 'box.xyz'
    words = ('--voxel', '0.08')
    cache = good.parent / 'cache'
    subprocess.run([str(program), 'parse', str(cloud), '-o', str(good.parent / 'with-cache'), '--cache', str(cache),
                    '--backend', 'native', '--quiet', '--walks', '5', *words], check=True)
    data = cache.read_bytes()
    for _ in range(60 * each):
        other = sealed(forged(data, rng, 24), function)

        def make(folder, other=other):
            shutil.copyfile(cloud, folder / 'box.xyz')
            (folder / 'cache').write_bytes(other)
            return ['parse', folder / 'box.xyz', '--cache', folder / 'cache', *words]
        yield 'own cache', make


def work_cases(program, good, rng, each, function):
    folder = good.parent / 'blocks'
    folder.mkdir()
    shutil.copyfile(good.parent / 'box.xyz', folder / 'in.xyz')
    left = work_folder(program, folder)
    if left is None:
        print('work folders are left out: no parse could be killed in time')
        return
    status = (folder / 'in.xyz').stat()
    manifest = next(left.glob('*manifest*'), None) or next(p for p in left.iterdir() if b'topple.work' in p.read_bytes()[:20])
    files = sorted(p.name for p in left.iterdir()
                   if re.match(r'(block-|bins|layout|cells-|order-)', p.name) and not p.name.endswith('.part'))
    for name in files:
        data = (left / name).read_bytes()
        for _ in range(8 * each):
            other = sealed(forged(data, rng, 8), function)

            def make(target, name=name, other=other):
                shutil.copyfile(folder / 'in.xyz', target / 'in.xyz')
                os.utime(target / 'in.xyz', ns=(status.st_atime_ns, status.st_mtime_ns))
                own = target / '.OUT.topple-work'
                shutil.copytree(left, own)
                own.chmod(0o700)
                (own / name).write_bytes(other)
                text = manifest.read_bytes().replace(str(folder).encode(), str(target).encode())
                (own / manifest.name).write_bytes(text)
                return ['parse', target / 'in.xyz', *WORK_WORDS[5:]]
            yield 'own work ' + name, make
