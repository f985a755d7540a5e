# SPDX-License-Identifier: MIT
# room.py SCAN PICTURE.png: what a scan holds, drawn by matplotlib, which it needs beside topple
# (apt-get install python3-matplotlib, or pip install matplotlib). The cells are those of a notebook.

# %% Parse
import sys

import matplotlib

matplotlib.use('Agg')
import matplotlib.pyplot as plt
import numpy as np

import topple

scan, picture = sys.argv[1:3]
result = topple.parse(scan, disturbances=['human', 'wind'], progress=lambda stage, done: done or print(stage))
print(f'{len(result.objects)} objects of {len(result.point_object)} points on {result.backend}')

# %% The riskiest, and why; last those whose unsafety is NaN, since what holds them was not seen
for o in sorted(result.objects, key=lambda o: np.nan_to_num(-o.unsafety, nan=0))[:3]:
    print(f'object {o.id}, unsafety {o.unsafety:.1f}: {o.why}')

# %% A colour by unsafety for each point: its object's; nothing is copied but what is computed here
unsafety = np.array([o.unsafety for o in result.objects])
ground = np.array([o.grounded for o in result.objects])
labels = result.point_object
value = np.where(labels >= 0, unsafety[labels], np.nan)
x, y, z = result.xyz.T
shown = np.random.default_rng(1).permutation(np.flatnonzero((labels >= 0) & ~ground[labels]))[:60000]
floor = np.random.default_rng(2).permutation(np.flatnonzero((labels >= 0) & ground[labels]))[:20000]

# %% Plan, and view from the side
figure, axes = plt.subplots(1, 2, figsize=(13, 6), constrained_layout=True)
for axis, (u, v), name in zip(axes, ((x, y), (x, z)), ('plan', 'from the side')):
    axis.scatter(u[floor], v[floor], s=0.3, c='0.85', rasterized=True)
    points = axis.scatter(u[shown], v[shown], s=0.5, c=value[shown], cmap='RdYlGn_r', vmin=1, vmax=10)
    for o in result.objects:
        if o.unsafety > 5:
            at = o.center_of_mass_m
            axis.annotate(str(o.id), (at[0], at[1 if axis is axes[0] else 2]), weight='bold')
    axis.set(title=name, xlabel='x, m', ylabel='y, m' if axis is axes[0] else 'z, m', aspect='equal')
figure.colorbar(points, ax=axes, label='unsafety')
figure.savefig(picture, dpi=110)
