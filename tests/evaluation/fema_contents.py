#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Compares what topple says of furniture in earthquakes with FEMA P-58.

  fema_contents.py TOPPLE [--every N] [--things [--amplification X]] [--keep FOLDER] [--strict]

Each item of the 2nd edition's fragility database (v3.1.2, groups E20.22, contents, unanchored) becomes a scan, points
on the faces of a box of its depth and height that stands on a floor, or on a table; `topple parse` finds it there, and
its median and dispersion are compared with FEMA's. FEMA's own velocities were computed from the items' proportions,
for rocking without slip, so these boxes stand on friction 1: b / h is 0.62 at most, which shaken askew takes up to
sqrt(2) times that. The accelerations are judgement from surveys; friction
is as the item is named there, from tables of engineers: rubber 0.7, smooth 0.25 to 0.3, glass or metal on wood 0.2. What
stands on furniture is shaken by that: 2.5 times as strongly as the floor, as building codes reckon flexible components
(a_p of ASCE 7, chapter 13), unless --amplification says otherwise.
Exit status: 1 where a median of the bookcases and cabinets is not within 1.5 times FEMA's, or their order differs
(rank correlation below 0.95). With --strict also where a dispersion is not from 0.35 to 0.65, or a median of the other
things not within twice FEMA's; these are printed in any case.
"""
import argparse
import json
import math
import os
import statistics
import subprocess
import sys
import tempfile

WIDTH_M = 0.9
# depth, height, median in m/s, dispersion
RACKS = [('bookcase, 2 shelves', 0.321, 0.737, 0.724, 0.5),
         ('bookcase, 3 shelves', 0.321, 1.041, 0.493, 0.5),
         ('bookcase, 4 shelves', 0.321, 1.422, 0.361, 0.5),
         ('bookcase, 5 shelves', 0.321, 1.803, 0.290, 0.5),
         ('bookcase, 6 shelves', 0.321, 2.064, 0.251, 0.5),
         ('vertical cabinet, 2 drawers', 0.381, 0.610, 1.229, 0.5),
         ('vertical cabinet, 4 drawers', 0.381, 1.321, 0.498, 0.5),
         ('lateral cabinet, 4 drawers', 0.472, 1.334, 0.688, 0.5),
         ('lateral cabinet, 5 drawers', 0.472, 1.721, 0.526, 0.5)]
# edge, height, depth of what it stands on, friction, median in g, dispersion
THINGS = [('fragile on a shelf', 0.10, 0.20, 0.30, 0.3, 0.40, 0.6),
          ('fragile on a shelf, low friction', 0.10, 0.20, 0.30, 0.2, 0.25, 0.5),
          ('desktop electronics, slip-resistant', 0.35, 0.40, 0.75, 0.7, 1.0, 0.5),
          ('desktop electronics, smooth', 0.35, 0.40, 0.75, 0.25, 0.4, 0.5),
          ('home entertainment', 0.40, 0.40, 0.60, 0.4, 0.8, 0.45)]
FRICTION = 1.0
SPACING_M = 0.012


def box(low, high, below=False):
    """Points on the faces of a box, not on the one below unless asked for."""
    points = []
    steps = [max(1, round((h - l) / SPACING_M)) for l, h in zip(low, high)]
    at = lambda axis, n: low[axis] + (high[axis] - low[axis]) * n / steps[axis]
    for axis in range(3):
        a, b = [k for k in range(3) if k != axis]
        for side in (0, steps[axis]):
            if axis == 2 and side == 0 and not below:
                continue
            for i in range(steps[a] + 1):
                for j in range(steps[b] + 1):
                    p = [0, 0, 0]
                    p[axis], p[a], p[b] = at(axis, side), at(a, i), at(b, j)
                    points.append(p)
    return points


def floor(half):
    steps = round(2 * half / SPACING_M)
    return [[-half + 2 * half * i / steps, -half + 2 * half * j / steps, 0] for i in range(steps + 1)
            for j in range(steps + 1)]


def room(half, height=3):
    """A floor and walls: without them a lone cabinet as tall as a door is taken for a part of the room."""
    points = floor(half)
    columns, rows = round(2 * half / SPACING_M), round(height / SPACING_M)
    for i in range(columns + 1):
        for j in range(1, rows + 1):
            along, up = -half + 2 * half * i / columns, height * j / rows
            points += [[along, -half, up], [along, half, up], [-half, along, up], [half, along, up]]
    return points


def parse(topple, folder, name, points, friction, amplification=1.0):
    path = os.path.join(folder, name.replace(' ', '-').replace(',', '') + '.xyz')
    with open(path, 'w') as file:
        file.writelines('%.4f %.4f %.4f\n' % tuple(p) for p in points)
    out = path[:-4] + '-parsed'
    subprocess.run([topple, 'parse', path, '-o', out, '--up', '0,0,1', '--disturbance', 'earthquake', '--backend', 'native',
                    '--friction', str(friction), '--floor-amplification', str(amplification), '--quiet'], check=True)
    with open(os.path.join(out, 'scene.json')) as file:
        return json.load(file)


def thing_at(scene, height):
    """The object whose centre of mass is nearest to where the box's is."""
    movable = [o for o in scene['objects'] if not o['grounded']]
    if not movable:
        return None
    return min(movable, key=lambda o: math.dist(o['center_of_mass_m'], (0, 0, height)))


def ranks(values):
    order = sorted(range(len(values)), key=lambda n: values[n])
    out = [0] * len(values)
    for rank, n in enumerate(order):
        out[n] = rank
    return out


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument('topple')
    arguments.add_argument('--every', type=int, default=1, metavar='N', help='only every Nth bookcase or cabinet')
    arguments.add_argument('--keep')
    arguments.add_argument('--things', action='store_true', help='things on shelves and desks, too')
    arguments.add_argument('--amplification', type=float, default=2.5, help='of the floor by furniture (2.5)')
    arguments.add_argument('--strict', action='store_true')
    options = arguments.parse_args()
    fails, misses = [], []
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.keep or temporary
        os.makedirs(folder, exist_ok=True)
        print('%-38s %21s %21s %7s' % ('item', 'topple', 'FEMA P-58', 'ratio'))
        medians, wanted = [], []
        for name, depth, height, median, dispersion in RACKS[::options.every]:
            low, high = (-depth / 2, -WIDTH_M / 2, 0), (depth / 2, WIDTH_M / 2, height)
            scene = parse(options.topple, folder, name, room(2) + box(low, high), FRICTION)
            found = thing_at(scene, height / 2)
            f = found and found['fragility']
            if not f or f['pgv_m_s'] is None:
                print('%-38s: no median' % name)
                fails.append(name)
                continue
            ratio = f['pgv_m_s'] / median
            print('%-38s %6.3f m/s, beta %4.2f %7.3f m/s, beta %4.2f %6.2f' %
                  (name, f['pgv_m_s'], f['pgv_dispersion'], median, dispersion, ratio))
            medians.append(f['pgv_m_s'])
            wanted.append(median)
            if not 1 / 1.5 <= ratio <= 1.5:
                fails.append(name + ': median')
            if not 0.35 <= f['pgv_dispersion'] <= 0.65:
                fails.append(name + ': dispersion')
        if len(medians) > 2:
            rank = statistics.correlation(ranks(medians), ranks(wanted))
            print('rank correlation %.3f' % rank)
            if rank < 0.95:
                fails.append('rank correlation')
        for name, edge, height, depth, friction, median, dispersion in THINGS if options.things else []:
            top = 0.75
            table = box((-depth / 2, -0.6, 0), (depth / 2, 0.6, top))
            thing = box((-edge / 2, -edge / 2, top), (edge / 2, edge / 2, top + height))
            scene = parse(options.topple, folder, name, room(1.5) + table + thing, friction, options.amplification)
            found = thing_at(scene, top + height / 2)
            f = found and found['fragility']
            if not f or f['pga_g'] is None:
                print('%-38s: no median; counted %s' % (name, [round(s['chance'], 2) for s in f['counted']] if f else None))
                misses.append(name)
                continue
            ratio = f['pga_g'] / median
            print('%-38s %6.3f g,   beta %4.2f %7.3f g,   beta %4.2f %6.2f' %
                  (name, f['pga_g'], f['pga_dispersion'], median, dispersion, ratio))
            if not 0.5 <= ratio <= 2:
                misses.append(name + ': median')
    for miss in fails + misses:
        print('out of its bounds: ' + miss)
    return 1 if fails or options.strict and misses else 0


if __name__ == '__main__':
    sys.exit(main())
