# SPDX-License-Identifier: MIT
# From a scan to its report. The cells are those of a notebook (Jupyter and editors open this file as one); beside topple
# it needs matplotlib. `python first_report.py` runs it all, and leaves first-report.png and the folder first-report.

# %% A scan to try things on: depth frames of a walk through a furnished room. Yours is a path, or points in memory.
import matplotlib.pyplot as plt
import numpy as np

import topple

scan = topple.generate('scan', seed=4, frames=8)

# %% Parse it. A notebook shows a result as a table of what may fall, the riskiest first.
result = topple.parse(scan)
result

# %% The same as columns: NumPy arrays with an entry for each object, or result.to_dataframe() for pandas
table = result.columns()
loose = ~table['grounded']
for n in np.flatnonzero(loose)[np.argsort(np.nan_to_num(-table['unsafety'][loose], nan=0))][:3]:
    print(f"object {table['id'][n]}, unsafety {table['unsafety'][n]:.1f}, {table['mass_kg'][n]:.1f} kg: {table['why'][n]}")

# %% The points from above, by object and by unsafety; what holds the floor is grey
labels = result.point_object
x, y, z = result.xyz.T
shown = np.random.default_rng(1).permutation(np.flatnonzero(labels >= 0))[:80000]
shown = shown[np.argsort(z[shown])]
ground = table['grounded'][labels[shown]]
figure, axes = plt.subplots(1, 2, figsize=(12, 5.5), constrained_layout=True, sharex=True, sharey=True)
colour = {'objects': (table['id'] * 7 % 20, 'tab20', None), 'unsafety': (table['unsafety'], 'RdYlGn_r', (1, 10))}
for axis, (name, (value, colours, limits)) in zip(axes, colour.items()):
    axis.scatter(x[shown][ground], y[shown][ground], s=0.3, c='0.85', rasterized=True)
    drawn = axis.scatter(x[shown][~ground], y[shown][~ground], s=0.6, c=value[labels[shown]][~ground], cmap=colours, rasterized=True)
    if limits:
        drawn.set_clim(limits)
        figure.colorbar(drawn, ax=axis, label='unsafety')
    axis.set(title=name, xlabel='x, m', ylabel='y, m', aspect='equal')
figure.savefig('first-report.png', dpi=100)

# %% Everything as files: report.html opens in a browser, scene.json has every number
result.write('first-report')
