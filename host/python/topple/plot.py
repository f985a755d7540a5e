# SPDX-License-Identifier: MIT
"""Plots of a Result for papers (pip install matplotlib). Each draws into the axes that it is given, or a figure of its own, and
returns the axes: plot.plan(result).figure.savefig('plan.pdf')."""
import math

import numpy as np

from . import geometry
from ._arrays import usage
from ._optional import needed


def _axes(axes, **options):
    if axes is not None:
        return axes
    return needed('matplotlib.pyplot', 'matplotlib', 'topple.plot').subplots(layout='constrained', **options)[1]


def plan(result, *, by='unsafety', labels=True, axes=None):
    """The floor plan, along the room's axes in metres: what can move, seen from above, and walls in grey.

    by: "unsafety", 1 to 10, what has no rank being hatched; or a disturbance that was parsed for, "human", "wind" or
    "earthquake": its risk in J. labels: writes objects' ids. Raises topple.Error of kind "usage"."""
    names = sorted(result.fields)
    if by != 'unsafety' and by not in names:
        raise usage(f"plan: by={by!r}; expected 'unsafety'" + ''.join(f' or {name!r}' for name in names))
    points, owners = geometry.solid_points(result)
    if len(points) == 0:
        raise usage('plan: the result has no solids to draw')
    axes = _axes(axes)
    turned = points @ geometry.room_axes(result).T
    step = result.voxel_size_m
    low = turned.min(axis=0)
    cells = np.round((turned - low) / step).astype(int)
    shape = cells.max(axis=0)[:2] + 1
    grounded = np.array([o.grounded for o in result.objects] + [True])  # -1, of no object, is the last
    values = np.array([o.unsafety if by == 'unsafety' else o.risk_J.get(by, math.nan) for o in result.objects] + [math.nan])
    # Walls stand where the ground fills more than half of the height; floor and ceiling don't.
    fixed, moving = cells[grounded[owners]], cells[~grounded[owners]]
    heights = np.zeros(shape)
    np.add.at(heights, (fixed[:, 0], fixed[:, 1]), 1)
    walls = np.where(heights > (cells[:, 2].max() + 1) / 2, 1.0, np.nan)
    top = np.full(shape, -1)
    order = np.argsort(moving[:, 2], kind='stable')
    top[moving[order, 0], moving[order, 1]] = owners[~grounded[owners]][order]
    seen, unranked = np.where(top >= 0, values[top], np.nan), (top >= 0) & np.isnan(values[top])
    extent = [low[0] - step / 2, low[0] + (shape[0] - 0.5) * step, low[1] - step / 2, low[1] + (shape[1] - 0.5) * step]
    shown = {'origin': 'lower', 'extent': extent, 'interpolation': 'nearest'}
    axes.imshow(walls.T, cmap='Greys', vmin=0, vmax=2, **shown)
    limits = {'vmin': 1, 'vmax': 10} if by == 'unsafety' else {'vmin': 0, 'vmax': max(np.nanmax(values, initial=0), 1e-9)}
    image = axes.imshow(seen.T, cmap='RdYlGn_r' if by == 'unsafety' else 'YlOrRd', **limits, **shown)
    if unranked.any():
        x, y = (low[axis] + np.arange(shape[axis]) * step for axis in (0, 1))
        axes.contourf(x, y, unranked.T.astype(float), levels=[0.5, 1.5], colors='none', hatches=['////'])
    axes.figure.colorbar(image, ax=axes, label='unsafety' if by == 'unsafety' else f'expected release per event, {by} (J)')
    axes.set(xlabel='x (m)', ylabel='y (m)', aspect='equal', xlim=extent[:2], ylim=extent[2:])
    if labels:
        shown, cells_of = np.unique(top[top >= 0], return_counts=True)
        largest = shown[np.argsort(-cells_of, kind='stable')]
        _write_apart(axes, [(str(n), (geometry.room_axes(result) @ result.objects[n].center_of_mass_m)[:2]) for n in largest])
    return axes


def _write_apart(axes, texts):
    """Writes each text at its place, or as near beside it as no earlier one lies, with a line to it."""
    look = {'ha': 'center', 'va': 'center', 'fontsize': 'small', 'textcoords': 'offset points',
            'bbox': {'facecolor': 'white', 'edgecolor': 'none', 'alpha': 0.6, 'pad': 1}}
    root = axes.figure.canvas.figure
    root.draw_without_rendering()  # places are known in pixels once all is laid out
    written, per_point = [], root.dpi / 72
    for text, place in texts:
        note = axes.annotate(text, place, (0, 0), **look)
        box = note.get_window_extent()
        half = np.array([box.width, box.height]) / 2 + per_point
        middle, moved = axes.transData.transform(place), np.zeros(2)
        angles = np.arange(12) * np.pi / 6
        rings = [radius * np.array([np.cos(a), np.sin(a)]) for radius in np.arange(1, 9) * box.height * 0.75 for a in angles]
        for way in [np.zeros(2), *rings]:
            if all((np.abs(middle + way - other) >= half + other_half).any() for other, other_half in written):
                moved = way
                break
        written.append((middle + moved, half))
        if moved.any():
            note.remove()
            axes.annotate(text, place, moved / per_point, arrowprops={'arrowstyle': '-', 'linewidth': 0.6, 'shrinkB': 0}, **look)


def instability(item, *, axes=None):
    """S(W) of an Object: the energy that it can release, J, once a disturbance has given it W, J; both of scene.json's `instability`."""
    steps = np.asarray(item.instability)
    if len(steps) == 0:
        raise usage(f'instability: object {item.id} has no S(W): it can\'t move, or was not seen enough')
    axes = _axes(axes)
    last = steps[-1, 0] * 1.2 if steps[-1, 0] > 0 else 1.0
    axes.step([0, *steps[:, 0], last], [0, *steps[:, 1], steps[-1, 1]], where='post', label=f'object {item.id}')
    axes.set(xlabel='W (J)', ylabel='S(W) (J)', xlim=(0, last))
    axes.set_ylim(bottom=0)
    return axes


def fragility(item, *, axes=None):
    """The chance that an earthquake upsets an Object by the ground's peak acceleration: what was counted, and the lognormal fit."""
    counted, median, spread = np.asarray(item.fragility.counted), item.fragility.pga_g, item.fragility.pga_dispersion
    if len(counted) == 0:
        raise usage(f'fragility: object {item.id} has none: no earthquake was parsed for, or it can\'t move')
    axes = _axes(axes)
    axes.plot(counted[:, 0], counted[:, 1], 'o', label=f'object {item.id}, counted')
    if math.isfinite(median) and spread > 0:
        peaks = np.linspace(counted[:, 0].max() / 200, counted[:, 0].max(), 200)
        chance = [0.5 * (1 + math.erf(math.log(peak / median) / (spread * math.sqrt(2)))) for peak in peaks]
        axes.plot(peaks, chance, label=f'median {median:.2g} g, dispersion {spread:.2g}')
    axes.set(xlabel='peak ground acceleration (g)', ylabel='chance to fall', ylim=(0, 1))
    axes.legend()
    return axes


def barriers(item, *, axes=None):
    """The least work of a slow push from which an Object falls, J, by the direction that it goes, in polar axes like a compass: 0° is the room's
    y, clockwise as seen from above (`barrier_by_direction` of docs/output.md). What does not fall there has no point."""
    push = np.asarray(item.barrier_by_direction.push_J)
    if len(push) == 0 or not np.isfinite(push).any():
        raise usage(f'barriers: object {item.id} falls in no direction, or was not seen enough')
    if axes is not None and not hasattr(axes, 'set_theta_zero_location'):
        raise usage("barriers: axes must be polar: matplotlib's subplots(subplot_kw={'projection': 'polar'}) makes such")
    axes = _axes(axes, subplot_kw={'projection': 'polar'})
    angles = np.arange(len(push) + 1) * 2 * np.pi / len(push)
    axes.set_theta_zero_location('N')
    axes.set_theta_direction(-1)
    axes.plot(angles, np.append(push, push[0]), 'o-', label=f'object {item.id} (J)')
    axes.set_title(f"Object {item.id}: least work of a slow push that upsets it (J)\nby where it goes, 0°: along the room's y, seen from above",
                   fontsize='medium')
    axes.set_ylim(bottom=0)
    return axes


_MOST_POSES = 10  # the deepest basins; others would not be told apart


class _Tree:
    """A disconnectivity graph, being joined: clusters of leaves, each with the place and energy that its line has got to."""

    def __init__(self, item):
        poses = item.landscape
        self.energy = [float(e) for e in poses.energy_J]
        depth = np.where(np.arange(len(self.energy)) == poses.now, np.inf, poses.joins_at_J - poses.energy_J)
        deepest = sorted(np.argsort(-depth, kind='stable')[:_MOST_POSES].tolist())
        self.name = {pose: str(number) for number, pose in enumerate(deepest, 1)}
        joins = [(float(at), pose, int(into), False) for pose, (at, into) in enumerate(zip(poses.joins_at_J, poses.joins)) if into >= 0]
        self.fallen = None
        if item.drop_m > 0:
            # Work against friction is no height to fall from.
            self.fallen = len(self.energy)
            self.energy.append((0 if item.mode == 'slide' else item.barrier_J) - item.release_J)
            self.name[self.fallen] = f'fallen: {self.energy[-1]:.3g} J'
            joins.append((item.barrier_J, self.fallen, poses.now, True))
        self.joins = sorted(joins, key=lambda join: join[0])
        self.root = list(range(len(self.energy)))

    def root_of(self, leaf):
        while self.root[leaf] != leaf:
            leaf = self.root[leaf]
        return leaf

    def leaves(self):
        """Those that are shown, side by side in the order of the joins."""
        below = [[leaf] if leaf in self.name else [] for leaf in range(len(self.energy))]
        for _, a, b, _ in self.joins:
            a, b = self.root_of(a), self.root_of(b)
            below[b] += below[a]
            below[a], self.root[a] = [], b
        self.root = list(range(len(self.energy)))
        return [leaf for leaves in below for leaf in leaves]


def disconnectivity(item, *, axes=None):
    """The disconnectivity graph of an Object: poses in which it could lie on level ground, as leaves at their energy, J, above or below that as
    it was scanned; two join at the energy that takes it from one to the other. Of many poses those of the deepest basins. The pose that it
    is in is filled; where its easiest way leads down from its support, that is a leaf, too, joined in red at its barrier."""
    if len(item.landscape.energy_J) == 0 or item.landscape.now < 0:
        raise usage(f'disconnectivity: object {item.id} has no poses: it can\'t move, or its shape is not known')
    tree = _Tree(item)
    axes = _axes(axes)
    leaves = tree.leaves()
    at = {leaf: (float(n), tree.energy[leaf]) for n, leaf in enumerate(leaves)}
    poses = [tree.energy[leaf] for leaf in leaves if leaf != tree.fallen]
    high = max([join[0] for join in tree.joins] + poses)
    low, room = min(poses), max(high - min(poses), 1e-9)
    # A fall that dwarfs the poses would leave them no room: its name says how deep it is.
    floor = low - 0.6 * room if tree.fallen is not None and low - tree.energy[tree.fallen] > room else -math.inf
    line = {'color': 'black', 'linewidth': 1.2}
    for energy, a, b, falls in tree.joins:
        a, b = tree.root_of(a), tree.root_of(b)
        tree.root[a] = b
        if a not in at:
            continue
        if b not in at:
            at[b] = at[a]
            continue
        for x, below in (at[a], at[b]):
            axes.plot([x, x], [max(below, floor), energy], **line)
        axes.plot([at[a][0], at[b][0]], [energy, energy], **(line | {'color': 'tab:red'} if falls else line))
        at[b] = (at[a][0] + at[b][0]) / 2, energy
    for leaf in {tree.root_of(leaf) for leaf in leaves}:
        x, below = at[leaf]
        axes.plot([x, x], [max(below, floor), high + 0.12 * room], **line)
    for n, leaf in enumerate(leaves):
        y = max(tree.energy[leaf], floor)
        axes.plot([n], [y], 'o', color='black', markerfacecolor='tab:blue' if leaf == item.landscape.now else 'white', zorder=3)
        axes.annotate(tree.name[leaf], (n, y), (0, -8), textcoords='offset points', ha='center', va='top',
                      fontweight='bold' if leaf == item.landscape.now else 'normal')
    axes.set(xticks=[], xlim=(-0.7, len(leaves) - 0.3), ylabel='energy (J)', title=f'Object {item.id}: poses and what keeps them apart')
    axes.margins(y=0.12)
    return axes
