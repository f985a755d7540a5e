#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The same input gives the same bytes, whatever computes it: backends, numbers of threads, builds, and orders of points.

    referee.py PROGRAM [PROGRAM ...] [--backends native vulkan opencl] [--threads 1 2 7] [--all] [--shared FOLDER]
               [--scans NAME ...] [--also PROGRAM] [--every]

Parses small scans with every program (builds of another type, compiler, sanitizer or revision) on every backend, the first
of both with each number of threads and the others with one of them (--every: with each), and compares all that is written
byte for byte with the first. --all: scans of all kinds and formats, with exports; FOLDER/data has more, of real rooms. What
differs is told by field: a member's path in JSON, a property of a PLY, else the first byte. Only what tells of the run
itself may differ: times, and the names of the device and of the input. Of a cloud whose points come in another order, all
but points.ply must be the same, and that as a set of lines. Prints one hash for each scan; leaves with 1 where a run differs.
"""
import argparse
import hashlib
import itertools
import json
import random
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / 'faults'))
import inputs  # noqa: E402

SMALL = ['--voxel', '0.08', '--walks', '4']
OF_THE_RUN = ('timings_s', 'backend', 'device', 'source', 'topple_version', 'command', 'title')
SIZES = {'char': 1, 'uchar': 1, 'short': 2, 'ushort': 2, 'int': 4, 'uint': 4, 'float': 4, 'double': 8}
TOLD = 3  # differences of a file
# What `topple generate` is asked for, and the options of its parse.
GENERATED = {
    'walk': (['--frames', '20'], ['--png']), 'tilted': (['--frames', '20', '--tilt', '20'], []),
    'varied': (['--frames', '20', '--furniture', 'varied'], ['--disturbance', 'wind', '--wind-from', '30']),
    'image': (['--single'], []), 'kitchen-sparse': (['--kind', 'kitchen', '--scan', 'sparse'], ['--hazard', 'HAZARD']),
    'office-laser': (['--kind', 'office', '--scan', 'laser'], []), 'shop-cloud': (['--kind', 'shop', '--scan', 'cloud'], []),
    'tabletop-image': (['--kind', 'tabletop', '--scan', 'single'], []),
    'precarious-walk': (['--kind', 'precarious', '--scan', 'walk'], ['--pga', '0.4g']),
    'library-sparse': (['--kind', 'library', '--scan', 'sparse'], ['--contents', 'solid', '--tolerable', '1']),
    'depot-sparse': (['--kind', 'depot', '--scan', 'sparse'], ['--tile', '5']),
    'building': (['--building', '--points', '200000'], []),
}
REAL = {'kitchen': 'kitchen', 'living-room': 'livingroom', 'table': 'frames/table0', 'tabletop': 'tabletop/test0.pcd',
        'laser-room': 'clouds/room_scan1.pcd', 'octomap': 'maps/geb079.bt', 'bookstore': 'worlds/bookstore-sparse/cloud.ply'}


def ply(data):
    """The header, its properties as (name, bytes), and the lines of points."""
    end = data.index(b'end_header\n') + len(b'end_header\n')
    header = data[:end].decode()
    properties = [(line.split()[2], SIZES[line.split()[1]]) for line in header.splitlines() if line.startswith('property ')]
    width = sum(size for _, size in properties)
    return header, properties, [data[at:at + width] for at in range(end, len(data), width)]


def without_run(scene):
    return {key: value for key, value in scene.items() if key not in OF_THE_RUN}


def told(name, data, ordered):
    """A file's content without what may differ."""
    if name == 'scene.json':
        return json.dumps(without_run(json.loads(data))).encode()
    if name == 'report.html':
        shown = [json.loads(text) for text in re.findall(rb'<script type="application/json" id="\w+">([^<]+)</script>', data)]
        return json.dumps([without_run(part) if isinstance(part, dict) else part for part in shown]).encode()
    if name == 'points.ply' and not ordered:
        header, _, rows = ply(data)
        return header.encode() + b''.join(sorted(rows))
    return data


def written(folder, ordered):
    # Pictures of the report show the device's name; exports name the folder of the parse.
    return {str(path.relative_to(folder)): told(path.name, path.read_bytes(), ordered)
            for path in sorted(folder.rglob('*')) if path.is_file() and path.suffix != '.png'}


def json_differences(a, b, path=''):
    if type(a) is not type(b):
        yield '%s: %.40r, %.40r' % (path, a, b)
    elif isinstance(a, dict):
        for key in sorted(a.keys() | b.keys()):
            if key not in a or key not in b:
                yield '%s.%s: only in one' % (path, key)
            else:
                yield from json_differences(a[key], b[key], '%s.%s' % (path, key))
    elif isinstance(a, list):
        if len(a) != len(b):
            yield '%s: %d, %d elements' % (path, len(a), len(b))
        for n, (x, y) in enumerate(zip(a, b)):
            yield from json_differences(x, y, '%s[%d]' % (path, n))
    elif a != b:
        yield '%s: %.60r, %.60r' % (path, a, b)


def ply_differences(a, b):
    (header, properties, rows), (other_header, _, other_rows) = ply(a), ply(b)
    if header != other_header:
        yield 'header: %d, %d lines of points' % (len(rows), len(other_rows))
        return
    at = 0
    for name, size in properties:
        off = sum(x[at:at + size] != y[at:at + size] for x, y in zip(rows, other_rows))
        at += size
        if off:
            yield '%s: %d of %d lines' % (name, off, len(rows))


def differences(name, a, b):
    if a is None or b is None:
        return ['only one run wrote it']
    if name.endswith(('.json', '.html')):
        return itertools.islice(json_differences(json.loads(a), json.loads(b)), TOLD)
    if name.endswith('.ply'):
        return ply_differences(a, b)
    at = next((n for n, (x, y) in enumerate(zip(a, b)) if x != y), min(len(a), len(b)))
    return ['%d, %d bytes; the first that differs: %d' % (len(a), len(b), at)]


def shuffled(path, out, seed):
    """A binary PLY with its points in another order."""
    header, _, rows = ply(path.read_bytes())
    random.Random(seed).shuffle(rows)
    out.write_bytes(header.encode() + b''.join(rows))


def ways(args, all_threads):
    """Programs, backends and numbers of threads; the first two with each number, if all are asked for."""
    for n, (program, backend) in enumerate(itertools.product(args.programs, args.backends)):
        if args.every or (all_threads and n == 0):
            yield from ((program, backend, threads) for threads in args.threads)
        else:
            yield program, backend, args.threads[n % len(args.threads)]


def scans_of(args, folder):
    """Each with what makes it, its file or folder, and the options of its parse."""
    inputs.write_all(folder)
    scans = {'cloud': (None, folder / 'cloud.ply', SMALL), 'mesh': (None, folder / 'mesh.obj', SMALL + ['--glb']),
             'frames': (None, folder / 'frames', SMALL), 'blocks': (None, folder / 'cloud.ply', SMALL + ['--tile', '5'])}
    if args.all:
        (folder / 'hazard').write_text('0.1 0.01\n0.3 0.002\n1 0.0001\n')
        exports = ['--octomap', '--glb', '--mjcf', 'OUT/mjcf', '--urdf', 'OUT/urdf', '--sdf', 'OUT/sdf', '--usd', 'OUT/scene.usda']
        scans.update({'text': (None, folder / 'cloud.xyz', SMALL + exports), 'las': (None, folder / 'cloud.las', SMALL),
                      'single': (None, folder / 'single', SMALL)})
        for name, (asked, options) in GENERATED.items():
            scan = folder / (name + '.ply' if name == 'building' else name)
            cloud = scan / 'cloud.ply' if name.endswith(('sparse', 'laser', 'cloud')) else scan
            # What is parsed in blocks can't be exported.
            scans[name] = ([args.programs[0], 'generate', scan, '--seed', '7', *asked], cloud,
                           options if '--tile' in options else exports + options)
        # Maps of a room, as topple writes them.
        scans['octomap-of-room'] = (None, folder / 'maps/map.bt', [])
        scans['volume-of-room'] = (None, folder / 'maps/volume.vdb', [])
        scans['mesh-of-room'] = (None, folder / 'maps/objects.glb', [])
    if args.shared:
        scans.update({name: (None, args.shared / 'data' / path, []) for name, path in REAL.items()})
    unknown = set(args.scans or ()) - scans.keys()
    if unknown:
        sys.exit('no scan is called %s; there are: %s' % (' '.join(unknown), ' '.join(scans)))
    return {name: scan for name, scan in scans.items() if not args.scans or name in args.scans}


def run(program, scan, out, options):
    of_files = {'OUT': str(out), 'HAZARD': str(out.parent / 'hazard')}
    options = [re.sub('^(OUT|HAZARD)', lambda m: of_files[m.group()], o) for o in options]
    done = subprocess.run([program, 'parse', scan, '-o', out, '--quiet', '--no-cache', *options], stdout=subprocess.DEVNULL,
                          stderr=subprocess.PIPE, text=True, check=False)
    if done.returncode:
        sys.exit('%s: %s' % (scan, done.stderr.strip()))


def compare(args, folder, name, scan, options):
    """What it prints of a scan, and the number of files that differ."""
    # In the first order, and in another.
    orders, different = [(scan, True)], 0
    if scan.suffix == '.ply' and name in ('cloud', 'blocks'):
        shuffled(scan, folder / 'shuffled.ply', 3)
        orders = [(scan, False), (folder / 'shuffled.ply', False)]
    first, runs = None, 0
    for file, ordered in orders:
        for program, backend, threads in ways(args, all_threads=file == scan and name != 'building'):
            shutil.rmtree(folder / 'out', ignore_errors=True)
            run(program, file, folder / 'out', ['--backend', backend, '--threads', str(threads), *options])
            got = written(folder / 'out', ordered)
            runs += 1
            first = first or got
            for part in sorted(first.keys() | got.keys()):
                if first.get(part) != got.get(part):
                    different += 1
                    print('%s: %s differs (%s, %s, %d threads)' % (name, part, program, backend, threads))
                    for line in differences(part, first.get(part), got.get(part)):
                        print('   ', line)
    bits = hashlib.sha256(b''.join(part.encode() + data for part, data in sorted(first.items()))).hexdigest()[:16]
    print('%-16s %3d runs  %3d files  %s' % (name, runs, len(first), bits), flush=True)
    return different


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('programs', nargs='+', metavar='PROGRAM', type=lambda p: Path(p).resolve())
    parser.add_argument('--backends', nargs='+', default=['native'])
    parser.add_argument('--threads', nargs='+', type=int, default=[1, 2, 7])
    parser.add_argument('--every', action='store_true', help='each program and backend with each number of threads')
    parser.add_argument('--all', action='store_true', help='scans of all kinds and formats, with exports')
    parser.add_argument('--shared', type=Path, help='its folder data holds scans of real rooms, which are parsed, too')
    parser.add_argument('--scans', nargs='+', help='only those')
    parser.add_argument('--also', type=Path, help='one more program, where it is there')
    args = parser.parse_args()
    if args.also and args.also.exists():
        args.programs.append(args.also.resolve())
    different = 0
    with tempfile.TemporaryDirectory(prefix='topple-referee-') as temporary:
        folder = Path(temporary)
        scans = scans_of(args, folder)
        if any(name.endswith('of-room') for name in scans):
            subprocess.run([args.programs[0], 'generate', folder / 'room', '--seed', '7', '--frames', '20'], check=True, stdout=subprocess.DEVNULL)
            run(args.programs[0], folder / 'room', folder / 'maps', ['--octomap', '--glb'])
        for name, (made, scan, options) in scans.items():
            if made:
                subprocess.run(made, check=True, stdout=subprocess.DEVNULL)
            different += compare(args, folder, name, scan, options)
    sys.exit(1 if different else 0)


if __name__ == '__main__':
    main()
