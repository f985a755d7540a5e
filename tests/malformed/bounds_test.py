#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Small inputs that ask for much: what a parse of them takes.

  bounds_test.py --program TOPPLE --work DIR [--cases N] [--first N] [--only KIND] [--table FILE]

Case N is made from the seed N alone: huge triangles, needles, terrains, points at few places, clusters far apart, lattices,
planes, frames of odd cameras, maps and volumes. A case passes where topple ends with 0 or 1, has taken at most 2 GB, and,
where it took over 30 s of processor time, has said before the 10th second of them that it takes long; then it is ended.
What it says so of takes 20 s on a usual machine, and half as long again on slow ones.
"""
import argparse
import json
import math
import os
import pathlib
import random
import resource
import shutil
import signal
import struct
import subprocess
import sys
import time

import inputs

MOST_KB, MOST_S, TOLD_S, HARD_KB = 2_000_000, 30, 10, 12_000_000


def sized(rng, low, high):
    """A number whose logarithm is evenly spread."""
    return math.exp(rng.uniform(math.log(low), math.log(high)))


def turned(rng, points):
    """Turned about the vertical, or as they are."""
    if rng.random() < 0.5:
        return points
    c, s = math.cos(1), math.sin(1)
    return [(c * x - s * y, s * x + c * y, z) for x, y, z in points]


def ply(points, faces=()):
    head = 'ply\nformat binary_little_endian 1.0\nelement vertex %d\n' % len(points)
    head += ''.join('property float %s\n' % axis for axis in 'xyz')
    if faces:
        head += 'element face %d\nproperty list uchar int vertex_indices\n' % len(faces)
    return (head + 'end_header\n').encode() + b''.join(struct.pack('<3f', *p) for p in points) + \
        b''.join(struct.pack('<B3i', 3, *f) for f in faces)


def triangles(rng):
    size, flat = sized(rng, 0.02, 5000), rng.random() < 0.3
    faces = rng.choice((1, 2, 3, 12, 200, 3000))
    part = sized(rng, 0.01, 1) if faces > 12 else 1
    out = b'\0' * 80 + struct.pack('<I', faces)
    for _ in range(faces):
        middle = [rng.uniform(-size, size) for _ in range(3)]
        corners = [[m + part * rng.uniform(-size, size) for m in middle] for _ in range(3)]
        if flat:
            for corner in corners:
                corner[2] = 0
        out += struct.pack('<12fH', 0, 0, 0, *[v for corner in corners for v in corner], 0)
    return 'in.stl', out


def box_mesh(rng):
    edge = [sized(rng, 0.1, 2000) for _ in range(3)]
    corners = [(x * edge[0], y * edge[1], z * edge[2]) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    sides = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
    return 'in.ply', ply(turned(rng, corners), [f for a, b, c, d in sides for f in ((a, b, c), (a, c, d))])


def terrain(rng):
    n, step, high = int(sized(rng, 30, 280)), sized(rng, 0.01, 0.24), sized(rng, 0.01, 30)
    noise, wave = rng.choice((0, 0.02, 1)), sized(rng, 3, 200)
    return 'in.ply', ply(turned(rng, [
        (a * step, b * step, high * (math.sin(a / wave) * math.cos(b / wave) + noise * rng.random()))
        for a in range(n) for b in range(n)]))


def places(rng):
    """Points at few places, each many times."""
    count, size = int(sized(rng, 5, 4000)), sized(rng, 0.1, 100)
    spots = [tuple(rng.uniform(-size, size) * rng.choice((1, 0.01)) for _ in range(3)) for _ in range(count)]
    return 'in.ply', ply([spots[n % count] for n in range(rng.choice((3000, 80000)))])


def clusters(rng):
    apart, size = sized(rng, 1, 1e5), sized(rng, 0.05, 20)
    ends = [tuple(rng.uniform(-apart, apart) for _ in range(3)) for _ in range(rng.choice((2, 2, 5, 200)))]
    return 'in.ply', ply([tuple(c + rng.gauss(0, size) for c in rng.choice(ends)) for _ in range(30000)])


def lattice(rng):
    n, step = int(sized(rng, 5, 42)), sized(rng, 0.003, 0.24)
    jitter = rng.choice((0, 0, 0.3))
    return 'in.ply', ply([tuple(step * (v + jitter * rng.random()) for v in (a, b, c))
                          for a in range(n) for b in range(n) for c in range(n)])


def planes(rng):
    n, step, gap = int(sized(rng, 20, 120)), sized(rng, 0.005, 0.2), sized(rng, 0.003, 3)
    sheets = max(1, min(80000 // (n * n), rng.choice((1, 3, 30, 400))))
    return 'in.ply', ply(turned(rng, [(a * step, b * step, c * gap)
                                      for c in range(sheets) for a in range(n) for b in range(n)]))


def flight(rng):
    """Steps of all lengths: needles, knots and leaps."""
    at, out, least = [0.0, 0.0, 0.0], [], sized(rng, 0.002, 0.1)
    for _ in range(rng.choice((2000, 60000))):
        step = least * min(1e4, (1 - rng.random()) ** (-1 / 1.5))
        at = [v + step * rng.gauss(0, 1) for v in at]
        out.append(tuple(at))
    return 'in.ply', ply(out)


def shells(rng):
    out, size = [], sized(rng, 0.1, 60)
    for _ in range(40000):
        v = [rng.gauss(0, 1) for _ in range(3)]
        scale = size * rng.choice((1, 0.5, 0.99)) / math.hypot(*v)
        out.append(tuple(scale * c for c in v))
    return 'in.ply', ply(out)


def repeats(rng):
    """A packed PCD: a column's few values, over and over, in a hundredth of their size."""
    points, period = rng.choice((200_000, 2_000_000)), rng.choice((8, 500, 2000))
    size, packed = sized(rng, 0.1, 50), b''
    for _ in range(3):
        pattern = struct.pack('<%df' % period, *[rng.uniform(-size, size) for _ in range(period)])
        for at in range(0, len(pattern), 32):
            piece = pattern[at:at + 32]
            packed += bytes((len(piece) - 1,)) + piece
        left = 4 * points - len(pattern)
        while left >= 3:
            length = min(264, left)
            length -= length > 264 - 3 and 0 < left - length < 3 and 3
            back = len(pattern) - 1
            packed += (bytes((length - 2 << 5 | back >> 8, back & 255)) if length < 9 else
                       bytes((7 << 5 | back >> 8, length - 9, back & 255)))
            left -= length
        if left:
            packed += bytes((left - 1,)) + pattern[-left:]
    head = ('# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH %d\nHEIGHT 1\n'
            'VIEWPOINT 0 0 0 1 0 0 0\nPOINTS %d\nDATA binary_compressed\n' % (points, points))
    return 'in.pcd', head.encode() + struct.pack('<II', len(packed), 12 * points) + packed


def octomap(rng):
    """A random tree: of each node's children some are leaves, occupied or free, and some have their own."""
    nodes, deepest, share = [0], rng.randint(3, 16), rng.uniform(0.1, 0.6)

    def node(depth):
        nodes[0] += 1
        kinds = [rng.choices((0, 1, 2, 3), (1, 2, 2, 0 if depth >= deepest or nodes[0] > 60000 else 8 * share))[0]
                 for _ in range(8)]
        bits = sum(kind << 2 * n for n, kind in enumerate(kinds))
        return struct.pack('<H', bits) + b''.join(node(depth + 1) for kind in kinds if kind == 3)

    tree = node(1)
    head = '# Octomap OcTree binary file\nid OcTree\nsize %d\nres %g\ndata\n' % (nodes[0], sized(rng, 0.005, 0.3))
    return 'in.bt', head.encode() + tree


def cameras(rng):
    """Frames of an odd camera, which may stand far apart."""
    count, scale, focal = rng.choice((1, 3, 12)), sized(rng, 10, 20000), sized(rng, 2, 3000)
    width, height, apart = 64, 48, sized(rng, 0.01, 9)
    flat = rng.randint(1, 65535)

    def row():
        return b'\0' + struct.pack('>%dH' % width, *[rng.choice((0, flat, flat, rng.randint(0, 65535))) for _ in range(width)])

    def make(folder):
        poses = ''.join('%d %g %g %g 0 0 %g %g\n' % (n, apart * n, apart * rng.random(), 1, math.sin(n), math.cos(n))
                        for n in range(count if count > 1 else 0))
        intrinsics = {'width': width, 'height': height, 'fx': focal, 'fy': focal * rng.choice((1, 1, 0.1)),
                      'cx': width / 2, 'cy': height / 2, 'depth_scale': scale}
        inputs.frames(folder, width, height, count, json.dumps(intrinsics),
                      inputs.png(width, height, rows=b''.join(row() for _ in range(height))), poses)

    return 'in', make


def volume(rng, good):
    return 'in.vdb', inputs.flipped((good / 'volume.vdb').read_bytes(), rng, rng.choice((1, 2, 4, 8)))


KINDS = (triangles, box_mesh, terrain, places, clusters, lattice, planes, flight, shells, repeats, octomap, cameras, volume)


def limit():
    resource.setrlimit(resource.RLIMIT_AS, (HARD_KB * 1024, HARD_KB * 1024))


def run(program, folder, scan):
    """(exit code or None where it was ended, seconds of the processor, peak in kB, when it said so, its words)."""
    command = [program, 'parse', scan, '-o', folder / 'OUT', '--backend', 'native', '--walks', '5']
    with open(folder / 'stderr', 'wb') as error:
        child = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=error, preexec_fn=limit)
    ticks, told, ended, used = os.sysconf('SC_CLK_TCK'), None, False, None
    while used is None:
        pid, status, usage = os.wait4(child.pid, os.WNOHANG)
        if pid:
            used = usage
            break
        fields = pathlib.Path('/proc/%d/stat' % child.pid).read_text(encoding='ascii').rsplit(')', 1)[1].split()
        seconds = (int(fields[11]) + int(fields[12])) / ticks
        if told is None and b'long for an input' in (folder / 'stderr').read_bytes():
            told = seconds
        if seconds > MOST_S:
            ended = True
            child.send_signal(signal.SIGKILL)
        time.sleep(0.05)
    child.returncode = os.waitstatus_to_exitcode(status)
    words = (folder / 'stderr').read_text(encoding='utf-8', errors='replace').strip().splitlines()
    return (None if ended else child.returncode, used.ru_utime + used.ru_stime, used.ru_maxrss, told,
            ' | '.join(line for line in words if 'topple:' in line or 'long for' in line))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('--program', required=True, type=pathlib.Path)
    parser.add_argument('--work', required=True, type=pathlib.Path)
    parser.add_argument('--cases', type=int, default=500)
    parser.add_argument('--first', type=int, default=0)
    parser.add_argument('--only', default='')
    parser.add_argument('--table', type=pathlib.Path)
    a = parser.parse_args()
    shutil.rmtree(a.work, ignore_errors=True)
    a.work.mkdir(parents=True)
    program = a.program.resolve()
    (a.work / 'box.xyz').write_bytes(dict(inputs.room_files())['xyz'])
    subprocess.run([program, 'parse', a.work / 'box.xyz', '-o', a.work / 'good', '--backend', 'native', '--quiet'], check=True)
    table = open(a.table, 'a', encoding='utf-8') if a.table else None
    bad = tried = 0
    for number in range(a.first, a.first + a.cases):
        rng, kind = random.Random(number), KINDS[number % len(KINDS)]
        if a.only not in kind.__name__:
            continue
        folder = a.work / 'case'
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        name, made = kind(rng, a.work / 'good') if kind is volume else kind(rng)
        if callable(made):
            made(folder / name)
        else:
            (folder / name).write_bytes(made)
        code, seconds, peak_kb, told, words = run(program, folder, folder / name)
        faults = ['exit code %s' % code] if code not in (0, 1, None) else []
        if peak_kb > MOST_KB:
            faults.append('%d MB of memory' % (peak_kb // 1000))
        if code != 1 and seconds > MOST_S and (told is None or told > TOLD_S + 1):
            faults.append('%.0f s, told after %s' % (seconds, told))
        tried += 1
        bad += bool(faults)
        line = '%d %s: code %s, %.1f s, %d MB%s %s %s' % (
            number, kind.__name__, code, seconds, peak_kb // 1000, '' if told is None else ', told at %.1f s' % told,
            '; '.join(faults) and 'WRONG: ' + '; '.join(faults), words[:300])
        if faults:
            print(line, flush=True)
        if table:
            print(line, file=table, flush=True)
    print('%d cases, %d wrong' % (tried, bad))
    return 1 if bad or not tried else 0


if __name__ == '__main__':
    sys.exit(main())
