#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Compares what `topple estimate` says with what parses take, on small random inputs of every kind.

  estimates.py --program TOPPLE --work DIR [--count N] [--first SEED] [--threads N] [--table FILE]
  estimates.py --program TOPPLE --work DIR --inputs SCAN... [--threads N] [--table FILE]
  estimates.py --fit TABLE...

Each seed is an input: rooms and buildings of `topple generate` as every scan, or the mesh, map and volume of an earlier
parse; with a voxel and tiles by chance; or the inputs are given. It is parsed once as it is, and once with a
--max-memory near the estimate, which must be refused or kept. Printed is each ratio of estimate to truth, and at the
end the shares within a quarter, by kind. Time is compared by the processor's, which a busy machine leaves about as it
is, and by the clock. Exit code 1 where a limit was not kept.

--fit prints constants of host/scale/estimate.cpp and parse_memory.h that fit tables best.
"""
import argparse
import json
import math
import operator
import os
import pathlib
import random
import shutil
import subprocess
import sys
import time

KINDS = ['kitchen', 'bathroom', 'bedroom', 'living', 'office', 'shop', 'storage', 'corridor', 'precarious', 'tabletop',
         'library', 'meeting', 'lounge', 'laundry', 'depot', 'plain', 'varied']
SAID = ['points', 'frames', 'pixels', 'surface_m2', 'tiled', 'cell_m', 'voxel_m', 'views', 'patches_m', 'ground_m2',
        'box_voxels', 'seconds', 'processor_s', 'probe_s', 'memory_bytes', 'least_bytes']
COLUMNS = ['seed', 'what', 'options', *SAID, 'wall_s', 'spent_s', 'peak_bytes', 'limit_bytes', 'limit_peak_bytes', 'limit']
# As in host/scale/estimate.cpp, and parse_memory.h.
PROBE_REFERENCE_S, LAYERS, WALKED_M2 = 0.027, 2.3, 4


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


def make(program, folder, seed):
    """What the input is, its path, and the options of its parse."""
    chance = random.Random(seed)
    options = []
    if chance.random() < 0.4:
        options += ['--voxel', '%.3g' % chance.uniform(0.02, 0.05)]
    kind = chance.choices(['room', 'building', 'derived'], [70, 12, 18])[0]
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
    folder = a.work / (seed.name if a.inputs else str(seed))
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    what, file, options = (seed.name, seed, []) if a.inputs else make(a.program, folder, seed)
    return compare(a, folder, seed if not a.inputs else 0, what, file, options)


def compare(a, folder, seed, what, file, options):
    common = ['--backend', 'native', '--threads', a.threads, '--quiet']
    said = Ran([a.program, 'estimate', file, *options, *common, '--json'])
    row = {'seed': seed, 'what': what, 'options': ' '.join(options)}
    if said.code != 0:
        return row, 'estimate: ' + said.error.strip()
    row.update({key: value for key, value in json.loads(said.out).items() if key in SAID})

    def parse(*more):
        return Ran([a.program, 'parse', file, '-o', folder / 'out', '--no-cache', *options, *common, *more])

    whole = parse()
    if whole.code != 0:
        return row, 'parse: ' + whole.error.strip()
    row.update(wall_s=round(whole.wall_s, 3), spent_s=round(whole.processor_s, 3), peak_bytes=whole.peak_bytes)
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
    """Of estimate to truth: memory, time of the processor, time by the clock."""
    return row['memory_bytes'] / row['peak_bytes'], row['processor_s'] / row['spent_s'], row['seconds'] / row['wall_s']


def kind_of(row):
    """The sort of input, for the table."""
    if row['tiled']:
        return 'clouds in blocks'
    if row['frames']:
        return 'single frames' if row['frames'] == 1 else 'frames with poses'
    if row['what'].endswith(('.obj', '.stl', '.glb')):
        return 'meshes'
    if row['what'].endswith(('.bt', '.vdb')):
        return 'maps and volumes'
    return 'clouds'


def within(values, factor=1.25):
    return sum(1 / factor <= v <= factor for v in values) / max(1, len(values))


def summary(rows):
    names = ['memory', 'time of the processor', 'time by the clock']
    for kind in sorted({kind_of(row) for row in rows}) + ['all']:
        of_kind = [row for row in rows if kind in ('all', kind_of(row))]
        print('%s, %d' % (kind, len(of_kind)))
        for name, values in zip(names, zip(*(ratios(row) for row in of_kind))):
            ordered = sorted(values)
            print('  %-22s %3.0f %% within a quarter; median %.2f, from %.2f to %.2f' %
                  (name, 100 * within(values), ordered[len(ordered) // 2], ordered[0], ordered[-1]))
    limits = [row['limit'] for row in rows]
    print('limits: ' + ', '.join('%d %s' % (limits.count(word), word) for word in ('refused', 'kept', 'EXCEEDED')))
    print('peaks above what --max-memory asks for: %d' % sum(r['peak_bytes'] > r['least_bytes'] for r in rows))


def read_table(file):
    lines = pathlib.Path(file).read_text().splitlines()
    names = lines[0].split('\t')
    text = {'what', 'options', 'limit'}
    return [{n: v if n in text else v == 'True' if n in ('tiled', 'views') else float(v) for n, v in zip(names, line.split('\t'))}
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


def report(file, names, start, columns, truth):
    """Fits and prints constants that the columns are multiplied with: their sum is a row's truth."""
    def told(c):
        return [sum(map(operator.mul, c, row)) for row in columns]

    c = search(start, lambda c: loss(list(zip(told(c), truth))))
    values = [a / b for a, b in zip(told(c), truth)]
    print('%s: %s' % (file, ', '.join('%s = %.3g' % both for both in zip(names, c))))
    print('    %.0f %% of %d within a quarter, from %.2f to %.2f' %
          (100 * within(values), len(values), min(values), max(values)))


def fit(a):
    rows = [row for file in a.fit for row in read_table(file)]
    whole, tiled = [r for r in rows if not r['tiled']], [r for r in rows if r['tiled']]

    def reference_s(of):
        return [row['spent_s'] / row['probe_s'] * PROBE_REFERENCE_S for row in of]

    def surface(row):
        return row['surface_m2'] / row['voxel_m'] ** 2

    report('parse_memory.h', ('fixed', 'voxel'), [0.3, 7e-6],
           [[1.0, math.sqrt(surface(r) * r['box_voxels'])] for r in whole], reference_s(whole))
    report('parse_memory.h', ('fixed', 'of_views', 'of_walks', 'a_point', 'a_surface_voxel', 'a_voxel', 'a_patch_m'),
           [40e6, 40e6, 40e6, 200, 1300, 6, 4e5],
           [[1.0, float(r['views']), min(1.0, r['ground_m2'] / WALKED_M2), r['points'], surface(r), r['box_voxels'],
             r['patches_m']] for r in whole], [r['peak_bytes'] for r in whole])
    if tiled:
        report('estimate.cpp', ('tiled_fixed_s', 'tiled_cell_s'), [1.5, 6e-6],
               [[1.0, min(0.95 * r['points'], LAYERS * r['surface_m2'] / r['cell_m'] ** 2)] for r in tiled],
               reference_s(tiled))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('--program', type=pathlib.Path)
    parser.add_argument('--work', type=pathlib.Path)
    parser.add_argument('--count', type=int, default=200)
    parser.add_argument('--first', type=int, default=1)
    parser.add_argument('--threads', type=int, default=1)
    parser.add_argument('--table', type=pathlib.Path)
    parser.add_argument('--keep', action='store_true', help='keep the inputs')
    parser.add_argument('--inputs', nargs='+', type=pathlib.Path, help='scans to compare, instead of random ones')
    parser.add_argument('--fit', nargs='+')
    a = parser.parse_args()
    if a.fit:
        return fit(a)
    a.program = a.program.resolve()
    table = open(a.table, 'w', encoding='utf-8') if a.table else None
    if table:
        print(*COLUMNS, sep='\t', file=table, flush=True)
    rows, refused = [], 0
    for seed in a.inputs or range(a.first, a.first + a.count):
        row, why = measure(a, seed)
        if why:
            refused += 1
            print('%s %s: %s' % (row['seed'], row['what'], why), flush=True)
            continue
        rows.append(row)
        if table:
            print(*(row[name] for name in COLUMNS), sep='\t', file=table, flush=True)
        print('%s %s %s: memory %.2f, time %.2f of the processor, %.2f by the clock; %s' %
              (row['seed'], row['what'], row['options'], *ratios(row), row['limit']), flush=True)
    summary(rows)
    if refused:
        print('%d inputs could not be parsed' % refused)
    return any(row['limit'] == 'EXCEEDED' or row['peak_bytes'] > row['least_bytes'] for row in rows)


if __name__ == '__main__':
    sys.exit(main())
