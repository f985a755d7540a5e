# SPDX-License-Identifier: MIT
# What may fall, by what, and how hard: risks, and S(W), what energy can set free. The cells are those of a notebook;
# beside topple it needs matplotlib. Leaves what-may-fall.png.

# %% A room, and all disturbances: someone walks by, wind, an earthquake
import matplotlib.pyplot as plt
import numpy as np

import topple

result = topple.parse(topple.generate('scan', seed=7, frames=8), pga_m_s2=4.0)
ranked = sorted((o for o in result.objects if not o.grounded and o.unsafety == o.unsafety), key=lambda o: -o.unsafety)
for o in ranked[:4]:
    print(f'object {o.id}: {o.why}\n    {o.advice}')

# %% Risk in joules for each event, with one standard error
table = result.columns()
ids = [o.id for o in ranked[:8]]
figure, (risks, curves, shaking) = plt.subplots(1, 3, figsize=(15, 4.5), constrained_layout=True)
for n, disturbance in enumerate(('human', 'wind', 'earthquake')):
    risks.bar(np.arange(len(ids)) + 0.27 * (n - 1), table[f'risk_{disturbance}_J'][ids], 0.25,
              yerr=table[f'risk_error_{disturbance}_J'][ids], label=disturbance)
risks.set_xticks(range(len(ids)), ids)
risks.set_yscale('symlog', linthresh=1e-3)
risks.set(title='risk, J an event', xlabel='object', ylim=(0, None))
risks.legend()

# %% S(W): an object that absorbs W joules can release S. It begins at the barrier, left of which nothing falls.
for o in ranked[:4]:
    if len(o.instability):
        W, S = np.vstack([o.instability, [[2 * o.instability[-1, 0], o.instability[-1, 1]]]]).T
        line, = curves.step(W, S, where='post', label=f'object {o.id}')
        curves.axvspan(max(o.barrier_J - o.barrier_error_J, 1e-3), o.barrier_J + o.barrier_error_J, color=line.get_color(), alpha=0.1)
curves.set(title='S(W), with the error of the barrier', xlabel='W, J absorbed', ylabel='S, J released', xscale='log', yscale='log')
curves.legend()

# %% How likely each falls in an earthquake, over its peak
for o in ranked[:4]:
    if len(o.fragility.counted):
        shaking.plot(*o.fragility.counted.T, marker='.', label=f'object {o.id}')
shaking.set(title='chance to fall', xlabel='peak ground acceleration, g', ylim=(-0.02, 1.02))
shaking.legend()
figure.savefig('what-may-fall.png', dpi=100)
