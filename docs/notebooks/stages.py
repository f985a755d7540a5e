# SPDX-License-Identifier: MIT
# Single stages on arrays of your own: a camera looks at a crate on the floor, and NumPy does the rest. The cells are
# those of a notebook; beside topple it needs matplotlib. Leaves stages.png.

# %% A device for all of it: opening one takes longer than most stages
import matplotlib.pyplot as plt
import numpy as np

import topple
from topple import stages

device = topple.open_device('native')

# %% Depth as a sensor gives it, in millimetres: the floor z = 0 and a crate, from three places around it
low, high = np.array([-0.3, -0.2, 0.0]), np.array([0.3, 0.2, 0.7])
camera = stages.Intrinsics(fx=180, fy=180, cx=119.5, cy=89.5)
v, u = np.mgrid[:180, :240]
rays = np.stack([(u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, np.ones(u.shape)], -1)


def looking(eye, at):
    """The pose of a camera: its x to the right, y down and z ahead, in the world."""
    ahead = (at - eye) / np.linalg.norm(at - eye)
    right = np.cross(ahead, [0, 0, 1])
    right /= np.linalg.norm(right)
    pose = np.eye(4)
    pose[:3] = np.stack([right, np.cross(ahead, right), ahead, eye], 1)
    return pose


poses = np.stack([looking(np.array([1.6 * np.cos(a), 1.6 * np.sin(a), 1.3]), np.array([0, 0, 0.3])) for a in (0.4, 2.3, 4.2)])
depth, points = [], []
for pose in poses:
    eye, way = pose[:3, 3], rays @ pose[:3, :3].T
    with np.errstate(divide='ignore'):
        near, far = np.sort([(low - eye) / way, (high - eye) / way], 0)
        floor = np.where(way[..., 2] < 0, -eye[2] / way[..., 2], np.inf)
    near, far = near.max(-1), far.min(-1)
    metres = np.where((near < far) & (near > 0), near, floor)
    metres[metres > 3] = 0  # beyond what the sensor reads
    depth.append(np.round(1000 * metres).astype(np.uint16))
    seen = depth[-1] > 0
    points.append(eye + way[seen] * (depth[-1][seen] / 1000)[:, None])
points = np.concatenate(points).astype(np.float32)

# %% Spacing and normals
spacing_m = stages.point_spacing(points)
normals = stages.normals(points, 2 * spacing_m, eye_m=(0, 0, 3), device=device)
print(f'{len(points)} points, {1000 * spacing_m:.1f} mm apart; {np.mean(np.abs(normals[:, 2]) > 0.9):.0%} of them level')

# %% A volume: what the frames saw through is empty, and what none saw inside of the crate is filled
voxel_m = 0.025
label = np.where(points[:, 2] > 0.5 * voxel_m, 1, 0).astype(np.int32)  # of the floor, and of the crate
volume = stages.Volume(points, label, voxel_m)
volume.carve(depth, poses, camera, device=device)
volume.fill(3, hollow=[0], device=device)
solid = volume.solid()
crate = solid.label == 1
# The surface passes through the voxels that it was seen in: of those about half is solid.
share = np.where(solid.state[crate] == stages.State.SURFACE, 0.5, 1.0)
volume_m3 = share.sum() * voxel_m**3
print(f'{volume_m3:.3f} m3 are solid, the crate has {np.prod(high - low):.3f}')

# %% How hard it is to tip: its barrier, and all that more energy could release
centers = np.stack([solid.i, solid.j, solid.k], 1)[crate] * voxel_m + voxel_m / 2
body = stages.StandingBody(points[label == 1].astype(float), 700 * volume_m3, np.average(centers, 0, share))
barrier, = stages.barriers([body], voxel_m, device=device)
print(f'{body.mass_kg:.0f} kg, tips at {barrier.barrier_J:.1f} J and then releases {barrier.release_J:.1f} J')

# %% Where something acts on the crate: each place on the map spreads its strength over a disc of 0.3 m
place = np.zeros((1, 40, 40), np.float32)
place[0, 18:22, 18:22] = 1
dy, dx = np.mgrid[-6:7, -6:7]
disc = np.hypot(dx, dy) <= 6
footprint = np.stack([dx[disc], dy[disc], np.full(disc.sum(), 1 / disc.sum())], 1)
field = stages.convolve(place, footprint, [0, len(footprint)], device=device)

# %% Pictures
figure, axes = plt.subplots(1, 3, figsize=(14, 4.2), constrained_layout=True)
front = points[:, 1] < 0.02
axes[0].scatter(points[front, 0], points[front, 2], s=0.4, c=np.abs(normals[front]).clip(0, 1), rasterized=True)
axes[0].set(title='points by normal, from the side', xlabel='x, m', ylabel='z, m', aspect='equal', xlim=(-0.8, 0.8))
i, k = np.meshgrid(np.arange(-30, 30), np.arange(-2, 34))
states = volume.state_at(i, 0, k)
axes[1].imshow(states, origin='lower', extent=(-30 * voxel_m, 30 * voxel_m, -2 * voxel_m, 34 * voxel_m), vmin=0, vmax=3, cmap='viridis')
axes[1].set(title='states: seen empty, surface, unseen, completed', xlabel='x, m', ylabel='z, m')
axes[2].imshow(field[0], origin='lower', cmap='magma')
axes[2].set(title='a field by convolution', xlabel='cells', ylabel='cells')
figure.savefig('stages.png', dpi=100)
