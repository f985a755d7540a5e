# SPDX-License-Identifier: MIT
# how_it_works.py PARSED DIR: the pictures of docs/how-it-works.md and of fields in docs/output.md, from an output folder of
#   topple generate office --kind office --seed 4
#   topple parse office -o PARSED --png --octomap --fields
# It needs PyPI's matplotlib and Pillow.
import argparse
import json
import os

import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.patches import Patch
from PIL import Image

WIDTH, HEIGHT = 860, 500  # pixels
LAMP_M = -0.41, -0.89, -0.22  # in the scan: the desk lamp whose contacts and energies are drawn


def read_ply(path):
    """A binary .ply of topple as a structured array."""
    types = {'float': '<f4', 'int': '<i4', 'uchar': 'u1'}
    with open(path, 'rb') as file:
        fields, count = [], 0
        for line in iter(lambda: file.readline().decode().split(), ['end_header']):
            if line[0] == 'element':
                count = int(line[2])
            elif line[0] == 'property':
                fields.append((line[2], types[line[1]]))
        return np.fromfile(file, fields, count)


def read_octomap(path):
    """A .bt: free and occupied cubes: first voxels (N, 3), edges in voxels (N,), whether occupied (N,)."""
    with open(path, 'rb') as file:
        for line in iter(file.readline, b'data\n'):
            pass
        data = np.frombuffer(file.read(), '<u2')
    corners, sizes, occupied, place = [], [], [], 0

    def node(corner, size):
        nonlocal place
        word = int(data[place])
        place += 1
        half = size // 2
        for child in range(8):
            bits = word >> 2 * child & 3
            at = [corner[axis] + half * (child >> axis & 1) for axis in range(3)]
            if bits == 3:
                node(at, half)
            elif bits:
                corners.append(at)
                sizes.append(half)
                occupied.append(bits == 2)

    node([-2**15] * 3, 2**16)
    return np.array(corners), np.array(sizes), np.array(occupied)


def save(image, path):
    """A PIL image, in 256 colours."""
    image.convert('RGB').quantize(256, Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE).save(path, optimize=True)


def save_plot(figure, path):
    figure.savefig(path, dpi=100, metadata={'Software': None})
    plt.close(figure)
    save(Image.open(path), path)


def distinct(count, seed=3):
    """(count, 3) colours that differ."""
    random = np.random.default_rng(seed)
    hue = np.arange(count) * 0.618034 % 1
    return (matplotlib.colors.hsv_to_rgb(np.stack([hue, 0.45 + 0.35 * random.random(count), 0.6 + 0.35 * random.random(count)], 1)) * 255).astype('u1')


def painted(points, colours, size):
    """Points of the room (N, 3), z up, seen in perspective from a corner: the nearest in each pixel. size: metres of a point."""
    low, high = np.percentile(points, [1, 99], axis=0)
    middle = (low + high) / 2 - [0, 0, 0.25]
    eye = middle + np.array([0.62, -0.95, 0.85]) * np.linalg.norm(high - low) * 0.78
    forward = (middle - eye) / np.linalg.norm(middle - eye)
    right = np.cross(forward, [0, 0, 1])
    right /= np.linalg.norm(right)
    seen = (points - eye) @ np.stack([right, np.cross(right, forward), forward], 1)
    scale = 2  # drawn twice as large, then made smaller, which smooths
    focal = 1.55 * HEIGHT * scale
    order = np.argsort(-seen[:, 2])
    seen, colours = seen[order], colours[order]
    image = np.full((HEIGHT * scale, WIDTH * scale, 3), 250, 'u1')
    x = (seen[:, 0] / seen[:, 2] * focal + WIDTH * scale / 2).astype(int)
    y = (HEIGHT * scale / 2 - seen[:, 1] / seen[:, 2] * focal).astype(int)
    radius = max(1, round(size * focal / np.median(seen[:, 2]) / 2))
    # The farthest first; the offsets of one distance slice at a time, so that near points cover far ones.
    for part in np.array_split(np.arange(len(x)), 200):
        for dx in range(-radius, radius + 1):
            for dy in range(-radius, radius + 1):
                u, v = x[part] + dx, y[part] + dy
                inside = (u >= 0) & (u < image.shape[1]) & (v >= 0) & (v < image.shape[0])
                image[v[inside], u[inside]] = colours[part][inside]
    return Image.fromarray(image).resize((WIDTH, HEIGHT), Image.Resampling.LANCZOS)


def scan_and_primitives(scene, points, turn, out):
    xyz = np.stack([points[axis] for axis in 'xyz'], 1) @ turn.T
    height = xyz[:, 2] - np.percentile(xyz[:, 2], 1)
    shown = height < 2.2  # not the ceiling
    own = np.stack([points[name] for name in ('red', 'green', 'blue')], 1)
    save(painted(xyz[shown], own[shown], 0.012), os.path.join(out, 'how-scan.png'))
    colours = np.append(distinct(len(scene['primitives'])), [[200, 200, 200]], 0)  # -1: of none
    grounded = [scene['objects'][p['object']]['grounded'] for p in scene['primitives']] + [False]
    colours[np.array(grounded)] = colours[np.array(grounded)] // 3 + 140
    save(painted(xyz[shown], colours[points['primitive'][shown]], 0.012), os.path.join(out, 'how-primitives.png'))


def space(scene, parsed, turn, out):
    """An upright cut through the room: what was seen to be free, seen surface, completed, never seen."""
    voxel = scene['voxel_size_m']
    solid = read_ply(os.path.join(parsed, 'solid.ply'))
    cells = np.floor(np.stack([solid[axis] for axis in 'xyz'], 1) @ turn.T / voxel).astype(int)
    corners, sizes, occupied = read_octomap(os.path.join(parsed, 'map.bt'))
    things = np.isin(solid['object'], [o['id'] for o in scene['objects'] if not o['grounded']]) & (solid['state'] == 1)
    rows, counts = np.unique(cells[things, 1], return_counts=True)
    cut = rows[np.argmax(counts)]  # through where most was completed
    low, high = np.percentile(cells, 0.2, axis=0).astype(int) - 4, np.percentile(cells, 99.8, axis=0).astype(int) + 4
    state = np.zeros((high - low + 1)[[2, 0]], int)  # 0 never seen, 1 free, 2 surface, 3 completed
    for corner, size in zip(corners[~occupied], sizes[~occupied]):
        if corner[1] <= cut < corner[1] + size:
            first = np.maximum(corner - low, 0)
            last = np.minimum(corner + size - low, high - low + 1)
            state[first[2]:max(last[2], 0), first[0]:max(last[0], 0)] = 1
    here = (cells[:, 1] == cut) & np.all((cells >= low) & (cells <= high), axis=1)
    state[cells[here, 2] - low[2], cells[here, 0] - low[0]] = np.where(solid['state'][here] == 0, 2, 3)
    figure, axes = plt.subplots(figsize=(8.6, 4.4), layout='constrained')
    colours = ['#c9cdd3', '#ffffff', '#20262e', '#e8883a']
    axes.imshow(state, origin='lower', cmap=ListedColormap(colours), vmin=0, vmax=3, interpolation='nearest',
                extent=[0, state.shape[1] * voxel, 0, state.shape[0] * voxel])
    axes.set(xlabel='m', ylabel='m')
    axes.legend(handles=[Patch(facecolor=c, edgecolor='black', linewidth=0.5, label=l) for c, l in
                         zip(colours, ['occluded: no ray got there', 'free: a ray passed', 'surface: seen', 'completed: inferred'])],
                loc='upper center', bbox_to_anchor=(0.5, 1.16), ncol=4, frameon=False)
    save_plot(figure, os.path.join(out, 'how-space.png'))


def graph(scene, one, turn, out):
    """Left: an object's primitives and those that they touch; right: what carries what, from the ground up."""
    objects, owner = scene['objects'], {p['id']: p['object'] for p in scene['primitives']}
    colours = distinct(len(objects)) / 255
    figure, (left, right) = plt.subplots(1, 2, figsize=(8.6, 4.4), layout='constrained', gridspec_kw={'width_ratios': [1, 1.7]})
    edges = [c for c in scene['contacts'] if one in (owner[c['a']], owner[c['b']])]
    nodes = {c[end] for c in edges for end in 'ab'}
    own = sorted(node for node in nodes if owner[node] == one)
    others = sorted(nodes - set(own))
    # Its own where they are, seen from the side; the others in a row below.
    middles = np.array([scene['primitives'][node]['center_of_mass_m'] for node in own]) @ turn.T
    side = middles[:, [np.argmax(np.ptp(middles[:, :2], axis=0)), 2]]
    at = dict(zip(own, (side - side.min(axis=0)) / np.ptp(side, axis=0) * 2 - 1))
    at.update({node: np.array([place, -1.7]) for node, place in zip(others, np.linspace(-1, 1, len(others)))})
    for c in edges:
        fixed = c['relation'] == 'fixed'
        ends = np.stack([at[c['a']], at[c['b']]])
        left.plot(*ends.T, color='#c22' if fixed else '#778', lw=2.5 if fixed else 1, ls='-' if fixed else '--', zorder=1)
        left.annotate(f'{c["probability"]:.2f}', 0.55 * ends[0] + 0.45 * ends[1], fontsize=8, ha='center', va='center',
                      bbox={'facecolor': 'white', 'edgecolor': 'none', 'pad': 1})
    for node in nodes:
        left.plot(*at[node], 'o', ms=20, color='#bbb' if objects[owner[node]]['grounded'] else colours[owner[node]])
        left.annotate(str(node), at[node], ha='center', va='center', fontsize=8)
    left.set_title(f'Contact graph: primitives of object {one}\nand what they touch', fontsize=10)
    left.set(xlim=(-1.4, 1.4), ylim=(-2, 1.3))

    # Each object below its likeliest carrier, which makes a tree.
    likeliest = {}
    for support in scene['supports']:
        if support['probability'] > likeliest.get(support['supported'], (0,))[0]:
            likeliest[support['supported']] = (support['probability'], support['supporter'])
    above = {}
    for carried, (_, carrier) in likeliest.items():
        above.setdefault(carrier, []).append(carried)
    places, leaves = {}, 0

    def put(node, level):
        nonlocal leaves
        if node in places:
            return
        places[node] = None
        carried = sorted(above.get(node, []))
        for item in carried:
            put(item, level + 1)
        known = [places[item][0] for item in carried if places.get(item)]
        if not known:
            known, leaves = [leaves], leaves + 1
        # Neighbours at three heights, so that their numbers don't cover each other.
        places[node] = (np.mean(known), level + (0.22 * (leaves % 3) if level else 0))

    put(0, 0)
    for carried, (_, carrier) in likeliest.items():
        if carried in places and carrier in places:
            right.plot(*np.stack([places[carried], places[carrier]]).T, color='#99a', lw=0.8, zorder=1)
    for node, place in places.items():
        right.plot(*place, 's' if node == 0 else 'o', ms=13, color='#bbb' if node == 0 else colours[node])
        right.annotate('ground' if node == 0 else str(node), place, ha='center', va='top' if node == 0 else 'center', fontsize=7,
                       xytext=(0, -9) if node == 0 else (0, 0), textcoords='offset points')
    right.set_title('Support graph: each object above what carries it', fontsize=10)
    right.margins(y=0.12)
    for axes in (left, right):
        axes.axis('off')
    save_plot(figure, os.path.join(out, 'how-contacts.png'))


def energy(scene, one, out):
    """An object's energy as it tips over its easiest edge, its barrier by direction, and S(W)."""
    item = scene['objects'][one]
    figure = plt.figure(figsize=(8.6, 3.4), layout='constrained')
    tipping, compass, curve = figure.add_subplot(131), figure.add_subplot(132, projection='polar'), figure.add_subplot(133)
    # The edge b beside the centre of mass and h below it that takes the barrier: h (1 / cos(tilt) - 1) is the climb.
    tilt, weight = np.radians(item['overturning']['tilt_deg']), item['mass_kg'] * 9.80665
    height = item['barrier_J'] / weight / (1 / np.cos(tilt) - 1)
    angle = np.radians(np.linspace(0, 60, 200))
    tipping.plot(np.degrees(angle), weight * height * (np.cos(angle) + np.tan(tilt) * np.sin(angle) - 1), color='#1c549c', lw=2)
    tipping.plot(np.degrees(tilt), item['barrier_J'], 'o', ms=8, mfc='#fd4', mec='black')
    tipping.annotate(f'barrier {item["barrier_J"]:.2f} J\nat {np.degrees(tilt):.0f}°', (np.degrees(tilt), item['barrier_J']), xytext=(8, 10),
                     textcoords='offset points', fontsize=9)
    tipping.axhline(0, color='#999', lw=0.8)
    tipping.set_ylim(top=item['barrier_J'] * 2.4)
    tipping.set_title(f'Energy of object {one}\nas it tips', fontsize=10)
    tipping.set(xlabel='leaning (degrees)', ylabel='potential energy (J)')
    push = np.array([np.nan if value is None else value for value in item['barrier_by_direction']['push_J']])
    compass.set_theta_zero_location('N')
    compass.set_theta_direction(-1)
    compass.plot(np.arange(len(push) + 1) * 2 * np.pi / len(push), np.append(push, push[0]), 'o-', color='#1c549c', ms=4)
    compass.set_ylim(bottom=0)
    compass.tick_params(labelsize=7)
    compass.set_title('Work of a slow push that\nupsets it, by direction (J)', fontsize=10)
    steps = np.array([[step['W_J'], step['S_J']] for step in item['instability']])
    last = steps[-1, 0] * 1.25
    curve.step([0, *steps[:, 0], last], [0, *steps[:, 1], steps[-1, 1]], where='post', color='#1c549c', lw=2)
    curve.set_title('S(W): what W joules\ncan release', fontsize=10)
    curve.set(xlabel='energy absorbed W (J)', ylabel='energy released S (J)', xlim=(0, last))
    curve.set_ylim(bottom=0)
    save_plot(figure, os.path.join(out, 'how-energy.png'))


def views(parsed, out):
    for name in ('objects', 'human', 'risk'):
        image = Image.open(os.path.join(parsed, f'view-{name}.png')).convert('RGB')
        save(image.resize((900, 562), Image.Resampling.LANCZOS), os.path.join(out, f'how-{name}.png'))
    save(Image.open(os.path.join(parsed, 'field-human.png')).convert('RGB'), os.path.join(out, 'field-human.png'))


def main():
    options = argparse.ArgumentParser()
    options.add_argument('parsed')
    options.add_argument('dir')
    options = options.parse_args()
    with open(os.path.join(options.parsed, 'scene.json'), encoding='utf-8') as file:
        scene = json.load(file)
    turn = np.array(scene['manhattan_from_input'])[:3, :3]
    scan_and_primitives(scene, read_ply(os.path.join(options.parsed, 'points.ply')), turn, options.dir)
    space(scene, options.parsed, turn, options.dir)
    free = [o for o in scene['objects'] if not o['grounded']]
    lamp = min(free, key=lambda o: np.linalg.norm(np.subtract(o['center_of_mass_m'], LAMP_M)))['id']
    graph(scene, lamp, turn, options.dir)
    energy(scene, lamp, options.dir)
    views(options.parsed, options.dir)


if __name__ == '__main__':
    main()
