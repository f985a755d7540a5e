#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Fits the network that looks at each joint amid those around it (host/graph/joint_context.h), and writes its file.

usage: fit_context.py --topple PROGRAM --topple-features PROGRAM --scans FOLDER ... --work FOLDER [--left-out ROOM ...]

Takes every scan below the FOLDERs that has truth.json and truth.ply, those of depth frames a second time with the
correlated noise and the drift of real sensors, keeps what the models see of them (topple_features) in --work, fits on all
but the rooms left out, says how good it is on those, and, where none is left out, writes host/fitted/context.model.json.
The room of a scan is its name up to the last hyphen. Generated buildings teach it that walls stand within a scan, too, but
nothing of joints: those of things that we modelled are easier than others. Colours are no input: what they tell differs most between models of
things and things; the joint's own log-odds know them. Takes torch, scikit-learn, scipy and pillow; the same file each time
on the same processor.
"""
import argparse
import json
import shutil
import subprocess
import sys
import zlib
from pathlib import Path

import numpy as np
import torch
from PIL import Image
from scipy.ndimage import gaussian_filter
from scipy.spatial.transform import Rotation
from sklearn.metrics import log_loss, roc_auc_score
from torch import nn
from torch.nn import functional

from fit import Table, calibration_error, read_ply, sigmoid, write

WIDTH, ROUNDS, EPOCHS, RATE = 32, 3, 30, 3e-3
JITTER, DROPOUT, SHELL_WEIGHT = 0.05, 0.1, 0.3
MOST_JOINTS = 12000  # of a scan that is learnt from
MOST_S = 600  # for what the models see of a scan
SHARE = 0.5  # of the network in the log-odds, the joints' own having the rest
# Generated: seeds, points and metres from one to the next.
BUILDINGS = [(seed, 250_000, 0.045 + 0.005 * (seed % 3)) for seed in range(11, 17)]
NODES = ('log_area', 'shell', 'log_samples')


def with_noise(scan, out):
    """A copy of frames as a sensor of structured light sees them, its poses off by millimetres."""
    rng = np.random.default_rng(zlib.crc32(scan.name.encode()))
    shutil.copytree(scan, out)
    camera = json.loads((out / 'intrinsics.json').read_text())
    scale, pixels = camera.get('depth_scale', 1000), camera['fx'] / 580
    strength, reach = rng.uniform(0.08, 0.35), rng.uniform(2, 9) * pixels
    for image in sorted((out / 'depth').iterdir()):
        depth = np.array(Image.open(image)) / scale
        wide = gaussian_filter(rng.standard_normal(depth.shape), reach)
        noise = wide / wide.std() + 0.4 * rng.standard_normal(depth.shape)
        seen = depth + depth ** 2 / (580 * 0.06) * strength * noise
        kept = (depth > 0) & (seen > 0.1)
        Image.fromarray(np.where(kept, np.round(seen * scale), 0).clip(0, 65535).astype(np.uint16)).save(image)
    poses = out / 'trajectory.txt'
    if poses.exists():
        shift, turn = rng.uniform(0.002, 0.008), np.radians(rng.uniform(0.05, 0.35))
        lines = []
        for row in np.atleast_2d(np.loadtxt(poses)):
            place = row[1:4] + rng.normal(0, shift, 3)
            turned = Rotation.from_quat(row[4:8]) * Rotation.from_rotvec(rng.normal(0, turn, 3))
            lines.append(' '.join(f'{value:.9g}' for value in (row[0], *place, *turned.as_quat())))
        poses.write_text('\n'.join(lines) + '\n')


class Example:
    """The graph of one scan: primitives, the joints between them from the smaller to the bigger, and the truth."""

    def __init__(self, scan, folder, room):
        table = Table(scan, folder, room)
        self.room, self.names = room, table.joint_names
        column = {name: k for k, name in enumerate(table.joint_names)}
        area = table.nodes[:, table.node_names.index('log_area')]
        a, b = table.pairs.T
        a_is_small = area[a] <= area[b]
        self.ends = np.stack([np.where(a_is_small, a, b), np.where(a_is_small, b, a)], 1)
        shell = np.full(len(area), 0.001)
        for side, name in enumerate(('shell_small', 'shell_big')):
            shell[self.ends[:, side]] = table.joints[:, column[name]]
        shell = shell.clip(0.001, 0.999)
        self.shell = np.log(shell / (1 - shell))
        primitive = np.fromfile(folder / 'primitive.i32', '<i4')
        samples = np.bincount(primitive[primitive >= 0], minlength=len(area))
        self.nodes = np.stack([area, self.shell, np.log1p(samples)], 1)
        self.log_odds = np.fromfile(folder / 'log_odds.f32', '<f4').reshape(-1, 2)  # with colours, without
        self.joints = table.joints
        self.known, self.one = table.known_pair, table.is_one
        self.known_node, self.is_shell = table.known, table.is_shell


class Scaling:
    """Inputs with a mean of 0 and a deviation of 1, without their outermost values; what is missing is 0, and told."""

    def __init__(self, rows, names):
        self.names = names
        self.low, self.high = np.nanpercentile(rows, [0.5, 99.5], 0)
        rows = rows.clip(self.low, self.high)
        self.mean, self.deviation = np.nanmean(rows, 0), np.nanstd(rows, 0) + 1e-6
        self.missing = np.nonzero(np.isnan(rows).mean(0) > 0.002)[0]

    def __call__(self, rows):
        scaled = np.nan_to_num((rows.clip(self.low, self.high) - self.mean) / self.deviation)
        return torch.tensor(np.concatenate([scaled, np.isnan(rows[:, self.missing])], 1), dtype=torch.float32)

    def inputs(self):
        return len(self.names) + len(self.missing)

    def file(self):
        return {'names': list(self.names), 'missing': self.missing.tolist(),
                **{key: [float(f'{v:.7g}') for v in getattr(self, key)] for key in ('low', 'high', 'mean', 'deviation')}}


def two_layers(inputs):
    return nn.Sequential(nn.Linear(inputs, WIDTH), nn.ReLU(), nn.Linear(WIDTH, WIDTH))


class Network(nn.Module):
    """Message passing (Gilmer et al. 2017): what a primitive is told by its joints, as mean and maximum, changes it, and
    both ends of a joint change the joint."""

    def __init__(self, node_inputs, joint_inputs):
        super().__init__()
        self.node, self.joint = two_layers(node_inputs), two_layers(joint_inputs)
        rounds = range(ROUNDS)
        self.to_small = nn.ModuleList(two_layers(2 * WIDTH) for _ in rounds)
        self.to_big = nn.ModuleList(two_layers(2 * WIDTH) for _ in rounds)
        self.node_change = nn.ModuleList(two_layers(3 * WIDTH) for _ in rounds)
        self.joint_change = nn.ModuleList(two_layers(3 * WIDTH) for _ in rounds)
        self.joint_out, self.node_out = nn.Linear(WIDTH, 1), nn.Linear(WIDTH, 1)
        for out in (self.joint_out, self.node_out):
            nn.init.zeros_(out.weight)
        self.scale = nn.Parameter(torch.ones(2))

    def forward(self, nodes, joints, ends, log_odds, shell):
        def dropped(x):
            return functional.dropout(x, DROPOUT, self.training)

        h, e = self.node(dropped(nodes)), self.joint(dropped(joints))
        small, big = ends.T
        told = torch.cat([small, big])
        count = torch.zeros(len(h), 1).index_add_(0, told, torch.ones(len(told), 1)).clamp(min=1)
        for n in range(ROUNDS):
            message = torch.relu(torch.cat([self.to_small[n](torch.cat([h[big], e], 1)),
                                            self.to_big[n](torch.cat([h[small], e], 1))]))
            mean = torch.zeros_like(h).index_add_(0, told, message) / count
            most = torch.zeros_like(h).scatter_reduce(0, told[:, None].expand_as(message), message, 'amax')
            h = h + self.node_change[n](dropped(torch.cat([h, mean, most], 1)))
            e = e + self.joint_change[n](dropped(torch.cat([h[small], h[big], e], 1)))
        return self.scale[0] * log_odds + self.joint_out(e)[:, 0], self.scale[1] * shell + self.node_out(h)[:, 0]


class Fitted:
    def __init__(self, examples):
        names = examples[0].names
        self.columns = [k for k, name in enumerate(names) if 'colour' not in name]
        self.node_scaling = Scaling(np.concatenate([x.nodes for x in examples]), NODES)
        self.joint_scaling = Scaling(np.concatenate([self.rows(x, 0) for x in examples]),
                                     [names[k] for k in self.columns] + ['log_odds'])
        torch.manual_seed(0)
        self.network = Network(self.node_scaling.inputs(), self.joint_scaling.inputs())
        self.learn(examples)

    def rows(self, x, without_colours):
        return np.concatenate([x.joints[:, self.columns], x.log_odds[:, without_colours:without_colours + 1]], 1)

    def inputs(self, x, without_colours):
        return (self.node_scaling(x.nodes), self.joint_scaling(self.rows(x, without_colours)), torch.tensor(x.ends).long(),
                torch.tensor(x.log_odds[:, without_colours]), torch.tensor(x.shell, dtype=torch.float32))

    def learn(self, examples):
        rng = np.random.default_rng(0)
        loss_of = functional.binary_cross_entropy_with_logits
        data = [([self.inputs(x, k) for k in (0, 1)], torch.tensor(x.known), torch.tensor(x.one).float(),
                 torch.tensor(x.known_node), torch.tensor(x.is_shell).float(), np.sqrt(max(x.known.sum(), x.known_node.sum())) / 15) for x in examples]
        optimiser = torch.optim.AdamW(self.network.parameters(), RATE, weight_decay=1e-4)
        schedule = torch.optim.lr_scheduler.OneCycleLR(optimiser, RATE, total_steps=EPOCHS * len(data))
        self.network.train()
        for epoch in range(EPOCHS):
            for n in rng.permutation(len(data)):
                inputs, known, one, known_node, is_shell, weight = data[n]
                nodes, joints, *rest = inputs[rng.integers(2)]  # most scans have no colours
                found, shell = self.network(nodes + JITTER * torch.randn_like(nodes),
                                            joints + JITTER * torch.randn_like(joints), *rest)
                loss = weight * SHELL_WEIGHT * loss_of(shell[known_node], is_shell[known_node])
                if known.any():
                    loss = loss + weight * loss_of(found[known], one[known])
                optimiser.zero_grad()
                loss.backward()
                nn.utils.clip_grad_norm_(self.network.parameters(), 2.0)
                optimiser.step()
                schedule.step()
            if epoch % 10 == 9:
                print(f'epoch {epoch + 1}: loss {loss.item():.3f}', flush=True)
        self.network.eval()

    def __call__(self, x):
        with torch.no_grad():
            found, shell = self.network(*self.inputs(x, 0))
        return ((1 - SHARE) * x.log_odds[:, 0] + SHARE * found.numpy(), (1 - SHARE) * x.shell + SHARE * shell.numpy())

    def file(self):
        weights = []
        net = self.network
        layers = [net.node, net.joint]
        for n in range(ROUNDS):
            layers += [net.to_small[n], net.to_big[n], net.node_change[n], net.joint_change[n]]
        for pair in layers:
            for layer in (pair[0], pair[2]):
                weights += [*layer.bias.tolist(), *layer.weight.T.flatten().tolist()]
        out = {'schema': 'topple.context/1', 'about': 'joints and shell amid the joints around them',
               'width': WIDTH, 'rounds': ROUNDS, 'nodes': self.node_scaling.file(), 'joints': self.joint_scaling.file(),
               'weights': [float(f'{w:.7g}') for w in weights]}
        for k, (name, layer) in enumerate((('joint_out', net.joint_out), ('shell_out', net.node_out))):
            own = 1 - SHARE + SHARE * net.scale[k].item()
            out[name] = [float(f'{v:.7g}') for v in (own, SHARE * layer.bias.item(), *(SHARE * layer.weight[0]).tolist())]
        return out


def building(arguments, seed, points, spacing_m):
    """A scan of a generated building, with the truth in the form of labelled scans."""
    scan = arguments.work / 'buildings' / f'building{seed}-plan'
    if not (scan / 'truth.json').exists():
        scan.mkdir(parents=True, exist_ok=True)
        subprocess.run([arguments.topple, 'generate', scan / 'cloud.ply', '--building', '--points', str(points), '--spacing',
                        str(spacing_m), '--seed', str(seed), '--storeys', str(1 + seed % 2)], check=True, capture_output=True)
        labelled = read_ply(scan / 'cloud.ply')
        head = 'ply\nformat binary_little_endian 1.0\nelement vertex %d\n' % len(labelled) + ''.join(
            f'property {kind} {name}\n' for kind, name in (('float', 'x'), ('float', 'y'), ('float', 'z'), ('int', 'object')))
        (scan / 'truth.ply').write_bytes((head + 'end_header\n').encode() + labelled.tobytes())
        objects = json.loads((scan / 'cloud.truth.json').read_text())['objects']
        (scan / 'truth.json').write_text(json.dumps({'objects': [
            {'id': o['id'], 'shell': o['id'] == 0, 'fixed': o['id'] == 0 or bool(o['fixed_to'])} for o in objects]}))
    return scan


def make(arguments):
    """The examples, made where they are not there yet."""
    scans = [building(arguments, *b) for b in BUILDINGS]
    for folder in arguments.scans:
        scans += sorted(path.parent for path in folder.glob('*/truth.json'))
    out = []
    for scan in scans:
        ways = [(scan, '')]
        if (scan / 'depth').is_dir():
            noisy = arguments.work / 'noisy' / scan.name
            if not noisy.exists():
                with_noise(scan, noisy)
            ways.append((noisy, '-noisy'))
        for source, suffix in ways:
            table = arguments.work / 'tables' / (scan.name + suffix)
            cloud = source / 'cloud.ply'
            if not (table / 'table.json').exists():
                try:
                    subprocess.run([arguments.topple_features, cloud if cloud.exists() else source, table], check=True,
                                   capture_output=True, timeout=MOST_S)
                except (subprocess.CalledProcessError, subprocess.TimeoutExpired) as problem:
                    print(f'{source} is left out: {problem}', file=sys.stderr)
                    continue
            example = Example(scan, table, scan.name.rsplit('-', 1)[0])
            example.kind = scan.name.rsplit('-', 1)[1].rstrip('0123456789') + suffix
            if example.kind == 'plan':
                example.known[:] = False
            if example.known.sum() > 3 or example.kind == 'plan':
                out.append(example)
    return out


def report(fitted, examples):
    for kind in sorted({x.kind for x in examples}):
        mine = [x for x in examples if x.kind == kind]
        found = [fitted(x) for x in mine]
        for what, before, after, truth in (
                ('joints', [x.log_odds[x.known, 0] for x in mine], [f[0][x.known] for f, x in zip(found, mine)],
                 [x.one[x.known] for x in mine]),
                ('shell', [x.shell[x.known_node] for x in mine], [f[1][x.known_node] for f, x in zip(found, mine)],
                 [x.is_shell[x.known_node] for x in mine])):
            truth = np.concatenate(truth)
            if len(truth) and 0 < truth.mean() < 1:
                told = [sigmoid(np.concatenate(odds)) for odds in (before, after)]
                print(f'{kind} {what}: {len(truth)}, AUC ' + ' -> '.join(f'{roc_auc_score(truth, p):.3f}' for p in told) +
                      ', log-loss ' + ' -> '.join(f'{log_loss(truth, p):.3f}' for p in told) +
                      ', calibration error ' + ' -> '.join(f'{calibration_error(p, truth):.3f}' for p in told), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--topple', type=Path, required=True)
    parser.add_argument('--topple-features', type=Path, required=True)
    parser.add_argument('--scans', type=Path, nargs='+', required=True)
    parser.add_argument('--work', type=Path, required=True)
    parser.add_argument('--left-out', nargs='+', default=[], metavar='ROOM')
    arguments = parser.parse_args()
    torch.set_num_threads(1)  # sums in one order
    examples = make(arguments)
    fitted = Fitted([x for x in examples if x.room not in arguments.left_out and len(x.joints) < MOST_JOINTS])
    report(fitted, [x for x in examples if x.room in arguments.left_out] or examples)
    if not arguments.left_out:
        write('context.model.json', fitted.file())


if __name__ == '__main__':
    main()
