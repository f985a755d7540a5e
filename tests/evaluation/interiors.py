#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""How much of the inside of things stays free in exports: of the space within cups, bins, shelves and the like of generated rooms, the
share that no convex part of an export fills. A point is inside where the same thing is below it and on three sides or more, and
nothing is there. Needs NumPy and SciPy. Rooms are kept in WORK and taken up again.

    interiors.py build/release WORK --seeds 1-4
"""
import argparse, json, os, subprocess, sys
import xml.etree.ElementTree as xml
from collections import defaultdict
import numpy as np
from scipy.spatial import ConvexHull


def turn(yaw, lean):
    c, s, d, t = np.cos(yaw), np.sin(yaw), np.cos(lean), np.sin(lean)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ np.array([[1, 0, 0], [0, d, -t], [0, t, d]])


def within(part, points):
    p = (points - part['center']) @ turn(part['yaw'], part.get('lean', 0))
    half, kind = np.array(part['size']) / 2, part['kind']
    radius = np.hypot(p[:, 0], p[:, 1])
    if kind in ('box', 'rounded'):
        return (np.abs(p) <= half).all(1)
    if kind == 'cyl':
        return (radius <= half[0]) & (np.abs(p[:, 2]) <= half[2])
    if kind == 'lying':
        return (np.hypot(p[:, 1], p[:, 2]) <= half[1]) & (np.abs(p[:, 0]) <= half[0])
    if kind == 'sph':
        return (p ** 2).sum(1) <= half[0] ** 2
    if kind == 'cone':
        up = p[:, 2] / half[2] / 2 + 0.5
        return (np.abs(p[:, 2]) <= half[2]) & (radius <= half[0] * (1 + (part['top_ratio'] - 1) * up))
    inside, corners = np.zeros(len(p), bool), part['profile']
    for (r, z), (s, w) in zip(corners, corners[1:] + corners[:1]):  # even and odd crossings
        if z != w:
            inside ^= ((z > p[:, 2]) != (w > p[:, 2])) & (radius < r + (s - r) * (p[:, 2] - z) / (w - z))
    return inside


def inside(own, others):
    """Points within what these parts enclose, and the volume that each stands for."""
    sizes = [np.abs(turn(p['yaw'], p.get('lean', 0))) @ np.array(p['size']) / 2 for p in own]
    low = np.min([p['center'] - s for p, s in zip(own, sizes)], 0)
    high = np.max([p['center'] + s for p, s in zip(own, sizes)], 0)
    step = max(0.004, (np.prod(high - low) / 150_000) ** (1 / 3))
    axes = [np.arange(a + step / 2, b, step) for a, b in zip(low, high)]
    grid = np.stack(np.meshgrid(*axes, indexing='ij'), -1)
    points = grid.reshape(-1, 3)
    solid = np.any([within(p, points) for p in own], 0).reshape(grid.shape[:3])
    seen = lambda a, axis: np.logical_or.accumulate(a, axis)
    sides = sum(seen(solid, a).astype(int) + np.flip(seen(np.flip(solid, a), a), a) for a in (0, 1))
    found = points[(~solid & seen(solid, 2) & (sides >= 3)).reshape(-1)]
    for part in others:
        found = found[~within(part, found)]
    return found, step ** 3, np.prod(high - low)


def solids(scene):
    """A test of points for each part that collides."""
    root = xml.parse(scene).getroot()
    numbers = lambda node, name, default='': np.array((node.get(name) or default).split(), float)
    hulls = {m.get('name'): numbers(m, 'vertex').reshape(-1, 3) for m in root.iter('mesh') if m.get('vertex')}
    for body in root.find('worldbody').findall('body'):
        at = numbers(body, 'pos')
        for geom in body.findall('geom'):
            if geom.get('class') != 'collision':
                continue
            kind, size = geom.get('type'), numbers(geom, 'size')
            place = at + numbers(geom, 'pos', '0 0 0')
            if kind == 'mesh':
                faces = ConvexHull(hulls[geom.get('mesh')] + at).equations
                yield lambda p, f=faces: (p @ f[:, :3].T + f[:, 3] <= 0).all(1)
            elif kind == 'box':
                w, x, y, z = numbers(geom, 'quat', '1 0 0 0')
                axes = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                                 [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                                 [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])
                yield lambda p, a=axes, c=place, s=size: (np.abs((p - c) @ a) <= s).all(1)
            elif kind == 'sphere':
                yield lambda p, c=place, s=size: ((p - c) ** 2).sum(1) <= s[0] ** 2
            else:
                axis = numbers(geom, 'zaxis')

                def in_cylinder(p, c=place, s=size, a=axis):
                    along = (p - c) @ a
                    return (np.abs(along) <= s[1]) & (((p - c) ** 2).sum(1) - along ** 2 <= s[0] ** 2)
                yield in_cylinder


def judge(programs, work, seed):
    scan, out, sim = (os.path.join(work, f'varied{seed}{end}') for end in ('', '.out', '.sim'))
    run = lambda *args: subprocess.run(args, check=True, stdout=subprocess.DEVNULL)
    if not os.path.exists(f'{out}/scene.json'):
        run(f'{programs}/topple-lab', 'generate', scan, '--furniture', 'varied', '--seed', str(seed))
        run(f'{programs}/topple', 'parse', scan, '-o', out, '--backend', 'native', '--quiet', '--no-cache')
    run(f'{programs}/topple', 'export', out, '--mjcf', sim, '--no-visuals')
    truth, scene = json.load(open(f'{scan}/truth.json')), json.load(open(f'{out}/scene.json'))
    to = np.array(scene['manhattan_from_input']).reshape(4, 4)
    parts = defaultdict(list)
    for part in truth['parts']:
        parts[part['object']].append({**part, 'center': np.array(part['center'])})
    fill = list(solids(f'{sim}/scene.xml'))
    for number, own in parts.items():
        if number == 0:
            continue
        points, each, box = inside(own, [p for other, all_of in parts.items() if other != number for p in all_of])
        if len(points) * each < max(5e-5, 0.1 * box):
            continue
        there = points @ np.array(truth['tilt']).T @ to[:3, :3].T + to[:3, 3]
        filled = np.zeros(len(there), bool)
        for test in fill:
            filled |= test(there)
        yield truth['objects'][number]['name'], len(points) * each, 1 - filled.mean()


def main():
    ask = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    ask.add_argument('programs')
    ask.add_argument('work')
    ask.add_argument('--seeds', default='1-4', help='first-last')
    a = ask.parse_args()
    os.makedirs(a.work, exist_ok=True)
    first, last = map(int, a.seeds.split('-'))
    all_of = [each for seed in range(first, last + 1) for each in judge(a.programs, a.work, seed)]
    for name, volume, kept in sorted(all_of):
        print(f'{name}: {1000 * volume:.2f} l, kept {kept:.2f}')
    volume, kept = np.array([v for _, v, _ in all_of]), np.array([k for *_, k in all_of])
    print(f'{len(all_of)} things: kept by volume {(volume * kept).sum() / volume.sum():.2f}, in the median {np.median(kept):.2f}, '
          f'{(kept >= 0.9).mean():.2f} of them to nine tenths')


if __name__ == '__main__':
    sys.exit(main())
