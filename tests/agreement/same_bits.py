#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The same input gives the same bytes, whatever computes it: backends, numbers of threads, builds, and orders of points.

    same_bits.py PROGRAM [PROGRAM ...] [--backends native vulkan opencl] [--threads 1 2 7] [--large]
                 [--also PROGRAM] [--every]

Parses small scans of each kind with every program (builds of another type, compiler or sanitizer) on every backend, the
first of both with each number of threads and the others with one of them (--every: with each), and compares all that is written, but for what tells of the run itself: times, and the names of
the device and of the input. Of a cloud whose points come in another order, all but points.ply must be the same, and that
as a set of lines. Prints one hash for each input; leaves with 1 where a run differs.
"""
import argparse
import hashlib
import itertools
import json
import random
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / 'faults'))
import inputs  # noqa: E402

SMALL = ['--voxel', '0.08', '--walks', '4']
OF_THE_RUN = ('timings_s', 'backend', 'device', 'source')


def scene_hash(path):
    """Of scene.json without what tells of the run."""
    scene = json.loads(path.read_text())
    for key in OF_THE_RUN:
        scene.pop(key, None)
    return json.dumps(scene, sort_keys=True).encode()


def ply_rows(data, ordered):
    """The header and the lines of points, sorted where their order doesn't count."""
    end = data.index(b'end_header\n') + len(b'end_header\n')
    header = data[:end].decode()
    size = {'float': 4, 'int': 4, 'uchar': 1}
    width = sum(size[line.split()[1]] for line in header.splitlines() if line.startswith('property '))
    rows = [data[at:at + width] for at in range(end, len(data), width)]
    return header.encode() + b''.join(rows if ordered else sorted(rows))


def hashes(out, ordered):
    """The hash of each file of an output; report.html holds times and is left out."""
    found = {}
    for path in sorted(out.iterdir()):
        if path.name == 'report.html':
            continue
        data = path.read_bytes()
        if path.name == 'scene.json':
            data = scene_hash(path)
        elif path.name == 'points.ply':
            data = ply_rows(data, ordered)
        found[path.name] = hashlib.sha256(data).hexdigest()
    return found


def shuffled(path, out, seed):
    """A binary PLY with its points in another order."""
    data = path.read_bytes()
    end = data.index(b'end_header\n') + len(b'end_header\n')
    header = data[:end].decode()
    count = int(header.split('element vertex ')[1].split()[0])
    width = (len(data) - end) // count
    rows = [data[end + width * n:end + width * (n + 1)] for n in range(count)]
    random.Random(seed).shuffle(rows)
    out.write_bytes(data[:end] + b''.join(rows))


def ways(args, all_threads):
    """Programs, backends and numbers of threads; the first two with each number, if all are asked for."""
    for n, (program, backend) in enumerate(itertools.product(args.programs, args.backends)):
        if args.every or (all_threads and n == 0):
            yield from ((program, backend, threads) for threads in args.threads)
        else:
            yield program, backend, args.threads[n % len(args.threads)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('programs', nargs='+', metavar='PROGRAM', type=lambda p: Path(p).resolve())
    parser.add_argument('--backends', nargs='+', default=['native'])
    parser.add_argument('--threads', nargs='+', type=int, default=[1, 2, 7])
    parser.add_argument('--every', action='store_true', help='each program and backend with each number of threads')
    parser.add_argument('--large', action='store_true', help='a generated kitchen and a walk through it, too')
    parser.add_argument('--also', type=Path, help='one more program, where it is there')
    args = parser.parse_args()
    if args.also and args.also.exists():
        args.programs.append(args.also.resolve())
    different = 0
    with tempfile.TemporaryDirectory(prefix='topple-bits-') as temporary:
        folder = Path(temporary)
        inputs.write_all(folder)
        scans = {'cloud': (folder / 'cloud.ply', SMALL), 'mesh': (folder / 'mesh.obj', SMALL + ['--glb']),
                 'frames': (folder / 'frames', SMALL), 'blocks': (folder / 'cloud.ply', SMALL + ['--tile', '5'])}
        if args.large:
            for scan in ('sparse', 'walk'):
                subprocess.run([args.programs[0], 'generate', folder / scan, '--seed', '7', '--kind', 'kitchen', '--scan', scan],
                               check=True, stdout=subprocess.DEVNULL)
            scans['room'] = (folder / 'sparse/cloud.ply', ['--glb'])
            scans['walk'] = (folder / 'walk', ['--glb'])
        for name, (scan, options) in scans.items():
            # In the first order, and in another.
            orders = [(scan, True)]
            if scan.suffix == '.ply':
                shuffled(scan, folder / 'shuffled.ply', 3)
                orders = [(scan, False), (folder / 'shuffled.ply', False)]
            first, runs = None, 0
            for file, ordered in orders:
                for program, backend, threads in ways(args, all_threads=file == scan):
                    out = folder / 'out'
                    command = [program, 'parse', file, '-o', out, '--backend', backend, '--threads', str(threads),
                               '--quiet', '--no-cache', *options]
                    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
                    got = hashes(out, ordered)
                    runs += 1
                    first = first or got
                    for part in sorted(first.keys() | got.keys()):
                        if first.get(part) != got.get(part):
                            different += 1
                            print('%s: %s differs: %s' % (name, part, ' '.join(map(str, command))))
            text = json.dumps(first, sort_keys=True).encode()
            print('%-8s %3d runs  %s' % (name, runs, hashlib.sha256(text).hexdigest()[:16]), flush=True)
    sys.exit(1 if different else 0)


if __name__ == '__main__':
    main()
