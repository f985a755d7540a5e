#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Compares what `topple estimate` says with what parses take, on small random inputs of every kind.

  estimates.py --program TOPPLE --work DIR [--count N] [--first SEED] [--threads N] [--table FILE]
  estimates.py --fit TABLE... [--clock]

Each seed is an input: rooms and buildings of `topple generate` as every scan, boxes of its own as clouds and meshes,
maps and volumes of an earlier parse; with a voxel and tiles by chance. It is parsed once as it is, and once with a
--max-memory near the estimate, which must be refused or kept. Printed is each ratio of estimate to truth, and at the
end the shares within a quarter. Time is compared by the processor's (one thread), which a busy machine leaves as it
is, and by the clock. Exit code 1 where a limit was not kept.

--fit prints constants of host/pipeline/estimate.cpp (time) and parse_memory.h (memory) that fit tables best; --clock
fits the time by the clock, for tables of a quiet machine with all threads.
"""
import argparse
import json
import math
import os
import pathlib
import random
import shutil
import struct
import subprocess
import sys
import time

KINDS = ['kitchen', 'bathroom', 'bedroom', 'living', 'office', 'shop', 'storage', 'corridor', 'precarious', 'tabletop',
         'library', 'meeting', 'lounge', 'laundry', 'depot', 'plain', 'varied']
COLUMNS = ['seed', 'what', 'options', 'points', 'frames', 'pixels', 'surface_m2', 'tiled', 'cell_m', 'voxel_m',
           'box_voxels', 'seconds', 'probe_s', 'probe_processor_s', 'memory_bytes', 'least_bytes', 'wall_s',
           'processor_s', 'peak_bytes', 'limit_bytes', 'limit_peak_bytes', 'limit']
PROBE_REFERENCE_S = 0.075  # as in host/pipeline/estimate.cpp


class Ran:
    """A finished run: exit code, seconds by the clock and of the processor, peak of memory in bytes."""

    def __init__(self, words):
        begin = time.monotonic()
        child = subprocess.Popen([str(w) for w in words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        # Both are short, so that neither pipe fills up.
        self.out, self.error = child.stdout.read(), child.stderr.read()
        _, status, used = os.wait4(child.pid, 0)
        child.returncode = self.code = os.waitstatus_to_exitcode(status)
        self.wall_s = time.monotonic() - begin
        self.processor_s = used.ru_utime + used.ru_stime
        self.peak_bytes = 1024 * used.ru_maxrss


# Solids as quadrilaterals (origin, edge, edge), which face outwards.
def box(low, size):
    x, y, z = ((size[0], 0, 0), (0, size[1], 0), (0, 0, size[2]))
    far = tuple(a + b for a, b in zip(low, size))
    return [(low, y, x), (low, x, z), (low, z, y), ((low[0], low[1], far[2]), x, y), ((far[0], low[1], low[2]), y, z),
            ((low[0], far[1], low[2]), z, x)]


def boxes(chance):
    side = chance.uniform(1, 5)
    faces = [((-side / 2, -side / 2, 0), (side, 0, 0), (0, side, 0))]
    for _ in range(chance.randrange(1, 12)):
        size = [chance.uniform(0.1, 0.8) for _ in range(3)]
        low = tuple(chance.uniform(-side / 2, side / 2 - s) for s in size[:2]) + (0,)
        faces += box(low, size)[1:]
    return faces


def points_of(faces, spacing, noise, chance):
    for origin, u, v in faces:
        across, up = (max(1, int(math.hypot(*e) / spacing)) for e in (u, v))
        for i in range(across):
            for j in range(up):
                a, b = (i + chance.random()) / across, (j + chance.random()) / up
                yield tuple(o + a * p + b * q + chance.gauss(0, noise) for o, p, q in zip(origin, u, v))


def write_cloud(file, points):
    if file.suffix == '.xyz':
        file.write_text(''.join('%.4f %.4f %.4f\n' % p for p in points))
    elif file.suffix == '.las':
        header = bytearray(227)
        header[0:4] = b'LASF'
        header[24:26] = bytes((1, 2))
        struct.pack_into('<HII', header, 94, 227, 227, 0)
        struct.pack_into('<BHI', header, 104, 0, 20, len(points))
        struct.pack_into('<6d', header, 131, 0.001, 0.001, 0.001, 0, 0, 0)
        file.write_bytes(bytes(header) + b''.join(struct.pack('<3i8x', *(round(1000 * c) for c in p)) for p in points))
    else:
        file.write_bytes(('ply\nformat binary_little_endian 1.0\nelement vertex %d\nproperty float x\n'
                          'property float y\nproperty float z\nend_header\n' % len(points)).encode() +
                         b''.join(struct.pack('<3f', *p) for p in points))


def write_mesh(file, faces):
    corners = [[tuple(o + a * p + b * q for o, p, q in zip(origin, u, v)) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
               for origin, u, v in faces]
    vertices = [c for face in corners for c in face]
    quads = [(n, n + 1, n + 2, n + 3) for n in range(0, len(vertices), 4)]
    if file.suffix == '.obj':
        file.write_text(''.join('v %g %g %g\n' % c for c in vertices) +
                        ''.join('f %d %d %d %d\n' % tuple(n + 1 for n in q) for q in quads))
    elif file.suffix == '.stl':
        triangles = [t for q in quads for t in ((q[0], q[1], q[2]), (q[0], q[2], q[3]))]
        file.write_bytes(b'\0' * 80 + struct.pack('<I', len(triangles)) + b''.join(
            struct.pack('<12fH', 0, 0, 0, *(x for n in t for x in vertices[n]), 0) for t in triangles))
    else:
        file.write_text('ply\nformat ascii 1.0\nelement vertex %d\nproperty float x\nproperty float y\n'
                        'property float z\nelement face %d\nproperty list uchar int vertex_indices\n'
                        'end_header\n' % (len(vertices), len(quads)) +
                        ''.join('%g %g %g\n' % c for c in vertices) + ''.join('4 %d %d %d %d\n' % q for q in quads))


def make(program, folder, seed):
    """What the input is, its path, and the options of its parse."""
    chance = random.Random(seed)
    options = []
    if chance.random() < 0.4:
        options += ['--voxel', '%.3g' % chance.uniform(0.02, 0.05)]
    kind = chance.choices(['room', 'building', 'boxes', 'mesh', 'derived'], [50, 10, 15, 13, 12])[0]
    if kind == 'boxes':
        file = folder / ('boxes' + chance.choice(['.ply', '.xyz', '.las']))
        spacing = chance.uniform(0.01, 0.05)
        write_cloud(file, list(points_of(boxes(chance), spacing, chance.uniform(0, 0.2) * spacing, chance)))
        return 'boxes' + file.suffix, file, options
    if kind == 'mesh':
        file = folder / ('mesh' + chance.choice(['.ply', '.obj', '.stl']))
        write_mesh(file, boxes(chance))
        return 'mesh' + file.suffix, file, options
    if kind == 'building':
        points = chance.randrange(30_000, 150_000)
        words = ['--building', '--points', points, '--spacing', '%.3g' % chance.uniform(0.03, 0.06)]
        subprocess.run([str(w) for w in (program, 'generate', folder / 'b.ply', '--seed', seed, *words)], check=True,
                       stdout=subprocess.DEVNULL)
        if chance.random() < 0.6:
            options = ['--tile', '5']
        return 'building', folder / 'b.ply', options
    scan = chance.choice(['walk', 'sparse', 'cloud', 'laser', 'single'])
    family = chance.choice(KINDS)
    if kind == 'derived':
        scan, family = 'sparse', chance.choice(['tabletop', 'bathroom', 'corridor', 'plain'])
    words = ['--kind', family, '--scan', scan]
    if scan == 'walk':
        words += ['--frames', chance.randrange(4, 25)]
    subprocess.run([str(w) for w in (program, 'generate', folder / 'scan', '--seed', seed, *words)], check=True,
                   stdout=subprocess.DEVNULL)
    scanned = folder / 'scan' / 'cloud.ply'
    if not scanned.exists():
        scanned = folder / 'scan'
    if kind == 'room':
        return '%s of %s' % (scan, family), scanned, options
    subprocess.run([str(w) for w in (program, 'parse', scanned, '-o', folder / 'first', '--quiet', '--octomap', '--glb',
                                     '--backend', 'native', '--threads', 1)], check=True, stdout=subprocess.DEVNULL)
    derived = chance.choice(['map.bt', 'volume.vdb', 'objects.glb'])
    if derived == 'objects.glb':  # a whole room, with a point on each centimetre
        options = ['--voxel', '%.3g' % chance.uniform(0.03, 0.05)]
    return derived, folder / 'first' / derived, options


def measure(a, seed):
    folder = a.work / str(seed)
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    what, file, options = make(a.program, folder, seed)
    common = ['--backend', 'native', '--threads', a.threads, '--quiet']
    said = Ran([a.program, 'estimate', file, *options, *common, '--json'])
    row = {'seed': seed, 'what': what, 'options': ' '.join(options)}
    if said.code != 0:
        return row, 'estimate: ' + said.error.strip()
    row.update({key: value for key, value in json.loads(said.out).items() if key in COLUMNS})

    def parse(*more):
        return Ran([a.program, 'parse', file, '-o', folder / 'out', '--no-cache', *options, *common, *more])

    whole = parse()
    if whole.code != 0:
        return row, 'parse: ' + whole.error.strip()
    row.update(wall_s=round(whole.wall_s, 3), processor_s=round(whole.processor_s, 3), peak_bytes=whole.peak_bytes)
    # From what is refused to what is enough.
    row['limit_bytes'] = int(random.Random(seed + 1).uniform(0.7, 1.05) * row['least_bytes'])
    limited = parse('--max-memory', row['limit_bytes'])
    row['limit_peak_bytes'] = limited.peak_bytes
    row['limit'] = 'refused' if limited.code else 'kept' if limited.peak_bytes <= row['limit_bytes'] else 'EXCEEDED'
    # With the least that it asks for, the first parse would have run as it did.
    if limited.code == 0 and whole.peak_bytes > row['least_bytes']:
        row['limit'] = 'EXCEEDED'
    if not a.keep:
        shutil.rmtree(folder)
    return row, ''


def ratios(row):
    """Of estimate to truth: memory, time of the processor (of one thread), time by the clock."""
    slower = row['probe_processor_s'] / row['probe_s']
    return (row['memory_bytes'] / row['peak_bytes'], row['seconds'] * slower / row['processor_s'],
            row['seconds'] / row['wall_s'])


def within(values, factor=1.25):
    return sum(1 / factor <= v <= factor for v in values) / max(1, len(values))


def summary(rows):
    names = ['memory', 'time of the processor', 'time by the clock']
    for name, values in zip(names, zip(*(ratios(row) for row in rows))):
        ordered = sorted(values)
        print('%-22s %3.0f %% of %d within a quarter; median %.2f, from %.2f to %.2f' %
              (name, 100 * within(values), len(values), ordered[len(ordered) // 2], ordered[0], ordered[-1]))
    limits = [row['limit'] for row in rows]
    print('limits: ' + ', '.join('%d %s' % (limits.count(word), word) for word in ('refused', 'kept', 'EXCEEDED')))
    print('peaks above what --max-memory asks for: %d' % sum(r['peak_bytes'] > r['least_bytes'] for r in rows))


def read_table(file):
    lines = pathlib.Path(file).read_text().splitlines()
    names = lines[0].split('\t')
    text = {'what', 'options', 'limit'}
    return [{n: v if n in text else v == 'True' if n == 'tiled' else float(v) for n, v in zip(names, line.split('\t'))}
            for line in lines[1:]]


def search(start, cost):
    """Least cost by changing one factor of the start at a time, in ever smaller steps."""
    best, least = list(start), cost(start)
    step = 0.5
    while step > 0.01:
        improved = False
        for n in range(len(best)):
            for factor in (1 + step, 1 / (1 + step)):
                tried = list(best)
                tried[n] *= factor
                c = cost(tried)
                if c < least - 1e-9:
                    best, least, improved = tried, c, True
        if not improved:
            step /= 2
    return best


def loss(pairs):
    """Mean of how far ratios are off, in which what is far off counts no more than the square of a half."""
    return sum(min(math.log(a / b) ** 2, 0.25) + 0.1 * abs(math.log(a / b)) for a, b in pairs) / len(pairs)


def fit(a):
    rows = [row for file in a.fit for row in read_table(file) if not row['tiled']]

    def reference_s(row):
        probes = row['wall_s'] / row['probe_s'] if a.clock else row['processor_s'] / row['probe_processor_s']
        return probes * PROBE_REFERENCE_S

    def seconds(c, row):
        return (c[0] * row['points'] + c[1] * row['surface_m2'] / row['voxel_m'] ** 2 + c[2] * row['box_voxels'] +
                c[3] * row['pixels'] + c[4])

    c = search([4e-6, 5e-5, 6e-8, 6e-8, 0.3], lambda c: loss([(seconds(c, row), reference_s(row)) for row in rows]))
    names = ('point_s', 'surface_voxel_s', 'voxel_s', 'pixel_s', 'fixed_s')
    print('estimate.cpp: ' + ', '.join('%s = %.2g' % both for both in zip(names, c)))
    print('    %.0f %% within a quarter' % (100 * within([seconds(c, row) / reference_s(row) for row in rows])))

    def peak(c, row):
        surface = c[2] * row['surface_m2'] / row['voxel_m'] ** 2 + c[3] * row['box_voxels']
        return c[0] + (0 if row['frames'] else c[4]) + max(c[1] * row['points'], surface)

    c = search([80e6, 500, 1500, 3, 30e6], lambda c: loss([(peak(c, row), row['peak_bytes']) for row in rows]))
    names = ('fixed', 'a_point', 'a_surface_voxel', 'a_voxel', 'of_views')
    print('parse_memory.h: ' + ', '.join('%s = %.3g' % both for both in zip(names, c)))
    values = [peak(c, row) / row['peak_bytes'] for row in rows]
    print('    %.0f %% within a quarter, least %.2f of the peak' % (100 * within(values), min(values)))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('--program', type=pathlib.Path)
    parser.add_argument('--work', type=pathlib.Path)
    parser.add_argument('--count', type=int, default=200)
    parser.add_argument('--first', type=int, default=1)
    parser.add_argument('--threads', type=int, default=1)
    parser.add_argument('--table', type=pathlib.Path)
    parser.add_argument('--keep', action='store_true', help='keep the inputs')
    parser.add_argument('--fit', nargs='+')
    parser.add_argument('--clock', action='store_true')
    a = parser.parse_args()
    if a.fit:
        return fit(a)
    a.program = a.program.resolve()
    table = open(a.table, 'w', encoding='utf-8') if a.table else None
    if table:
        print(*COLUMNS, sep='\t', file=table, flush=True)
    rows, refused = [], 0
    for seed in range(a.first, a.first + a.count):
        row, why = measure(a, seed)
        if why:
            refused += 1
            print('%d %s: %s' % (seed, row['what'], why), flush=True)
            continue
        rows.append(row)
        if table:
            print(*(row[name] for name in COLUMNS), sep='\t', file=table, flush=True)
        print('%d %s %s: memory %.2f, time %.2f of the processor, %.2f by the clock; %s' %
              (seed, row['what'], row['options'], *ratios(row), row['limit']), flush=True)
    summary(rows)
    if refused:
        print('%d inputs could not be parsed' % refused)
    return any(row['limit'] == 'EXCEEDED' or row['peak_bytes'] > row['least_bytes'] for row in rows)


if __name__ == '__main__':
    sys.exit(main())
