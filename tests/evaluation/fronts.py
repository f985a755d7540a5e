#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""How many doors and drawers of generated furniture an export has, and whether they open as they do in truth: same kind, axis within
10 degrees, hinge within 6 cm, rectangles that overlap by half of both. Needs NumPy. Rooms are kept in WORK and taken up again.

    fronts.py build/release WORK --kinds kitchen,office --seeds 1-4
"""
import argparse, json, os, subprocess, sys
from concurrent.futures import ThreadPoolExecutor
import numpy as np

HINGE_M, AXIS_COS, LEAST_OVERLAP = 0.06, 0.985, 0.5


def export(programs, work, kind, seed):
    scan, out, sim = (os.path.join(work, f'{kind}{seed}{end}') for end in ('', '.out', '.sim'))
    run = lambda *args: subprocess.run(args, check=True, stdout=subprocess.DEVNULL)
    if not os.path.exists(f'{scan}/truth.json'):
        run(f'{programs}/topple-lab', 'generate', scan, '--kind', kind, '--seed', str(seed))
    if not os.path.exists(f'{out}/scene.json'):
        run(f'{programs}/topple', 'parse', scan, '-o', out, '--backend', 'native', '--quiet', '--no-cache', '--threads', '1')
    run(f'{programs}/topple', 'export', out, '--mjcf', sim, '--no-visuals', '--threads', '1')
    load = lambda name: json.load(open(name))
    return load(f'{scan}/truth.json'), load(f'{out}/scene.json'), load(f'{sim}/bodies.json')['fronts']


def true_fronts(truth, scene):
    to = np.array(scene['manhattan_from_input']).reshape(4, 4) @ np.array(truth['world_to_scan'])
    place, turn = (lambda p: to[:3, :3] @ p + to[:3, 3]), to[:3, :3]
    for thing in truth['objects']:
        for front in thing.get('fronts', []):
            cosine, sine = np.cos(front['yaw']), np.sin(front['yaw'])
            yield {'thing': thing['name'], 'opens': front['kind'], 'handle': front['handle'], 'name': front['name'], 'middle': place(front['center']),
                   'across': turn @ [cosine, sine, 0], 'out': turn @ [-sine, cosine, 0], 'sides': (front['size'][0], front['size'][2]),
                   'axis': turn @ front['axis'], 'at': place(front['at']) if 'at' in front else None}


def overlap(true, found):
    """Of their rectangles, over both together."""
    off = np.array(found['middle_m']) - true['middle']
    if abs(off @ true['out']) > 0.12:
        return 0
    way, areas, common = (true['across'] @ off, off[2]), 1, 1
    for d, a, b in zip(way, true['sides'], (found['wide_m'], found['high_m'])):
        common *= max(0, min(a / 2, d + b / 2) - max(-a / 2, d - b / 2))
    return common / (true['sides'][0] * true['sides'][1] + found['wide_m'] * found['high_m'] - common)


def opens_alike(true, found):
    axis = np.array(found['axis'])
    if true['opens'] != found['opens'] or abs(axis @ true['axis']) < AXIS_COS:
        return False
    if true['at'] is None:
        return True
    off = np.array(found['at_m']) - true['at']
    return np.linalg.norm(off - axis * (axis @ off)) <= HINGE_M


def judge(truth, scene, fronts, name, verbose):
    true, left, found, right, with_handle = list(true_fronts(truth, scene)), list(fronts), 0, 0, 0
    for each in true:
        best = max(left, key=lambda f: overlap(each, f), default=None)
        hit = best is not None and overlap(each, best) >= LEAST_OVERLAP
        alike = hit and opens_alike(each, best)
        if hit:
            left.remove(best)
        found, right, with_handle = found + hit, right + alike, with_handle + each['handle']
        if verbose:
            print(f"  {name} {each['thing']} {each['name']}{'' if each['handle'] else ' without a handle'}: {'right' if alike else 'opens otherwise' if hit else 'not found'}")
    if verbose:
        for f in left:
            print(f"  {name} none: object {f['object']} {f['opens']} {f['wide_m']:.2f} x {f['high_m']:.2f} at {np.round(f['middle_m'], 2)} "
                  f"P {f['probability']:.2f}")
    return np.array([len(true), len(fronts), found, right, with_handle])


def main():
    ask = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    ask.add_argument('programs')
    ask.add_argument('work')
    ask.add_argument('--kinds', default='kitchen,office,bedroom,laundry,living,meeting,lounge')
    ask.add_argument('--seeds', default='1-2', help='first-last')
    ask.add_argument('--verbose', action='store_true', help='what became of each')
    a = ask.parse_args()
    os.makedirs(a.work, exist_ok=True)
    first, last = map(int, a.seeds.split('-'))
    rooms = [(kind, seed) for kind in a.kinds.split(',') for seed in range(first, last + 1)]
    total = np.zeros(5, int)
    with ThreadPoolExecutor(2) as pool:
        for (kind, seed), made in zip(rooms, pool.map(lambda room: export(a.programs, a.work, *room), rooms)):
            total += judge(*made, f'{kind}{seed}', a.verbose)
    true, said, found, right, with_handle = total
    print(f'{len(rooms)} rooms: {true} doors and drawers, {with_handle} with handles, {said} in exports; found {found / max(1, true):.2f}, '
          f'found and open alike {right / max(1, true):.2f}, precision {right / max(1, said):.2f}')


if __name__ == '__main__':
    sys.exit(main())
