# SPDX-License-Identifier: MIT
"""Times Python's libraries on depth frames: frame_peers.py CAMERA DEPTH.

CAMERA: float64, metres of a voxel, width, height, fx, fy, cx, cy, depth scale, then the 16 numbers of each frame's
pose, camera to world. DEPTH: uint16, the frames one after the other. Points of readings are made before the time is
taken, as for OctoMap. Prints a line for each library that is installed, of the best of three runs over all frames,
of VDBFusion one."""
import os
import sys
from importlib.metadata import version

try:
    import numpy as np
except ImportError:
    sys.exit(0)

from timing import best, tell, tell_all

camera = np.fromfile(sys.argv[1])
voxel, width, height, fx, fy, cx, cy, scale = camera[:8]
poses = camera[8:].reshape(-1, 4, 4)
frames = np.fromfile(sys.argv[2], np.uint16).reshape(len(poses), int(height), int(width))
THREADS, TRUNCATION = len(os.sched_getaffinity(0)), 3.0  # voxels on either side of a surface


def readings():
    """Of each frame, the points in the world and the pose."""
    out = []
    for depth, pose in zip(frames, poses):
        v, u = np.nonzero(depth)
        d = depth[v, u] / scale
        seen = np.stack([(u - cx) / fx * d, (v - cy) / fy * d, d], 1)
        out.append((np.ascontiguousarray(seen @ pose[:3, :3].T + pose[:3, 3]), np.ascontiguousarray(pose)))
    return out


def vdbfusion_carving():
    import vdbfusion
    scans = readings()

    def run():
        volume = vdbfusion.VDBVolume(voxel, TRUNCATION * voxel, space_carving=True)
        for points, pose in scans:
            volume.integrate(points, pose)
    tell('carving/vdbfusion', f'VDBFusion {version("vdbfusion")}', best(run, 1)[0])


def dufomap_carving():
    """What was seen through, nothing inflated."""
    os.environ.setdefault('GLOG_minloglevel', '1')
    import dufomap
    scans = [(points.astype(np.float32), pose) for points, pose in readings()]

    def run():
        space = dufomap.dufomap(voxel, 0, 0, num_threads=THREADS)
        for points, pose in scans:
            space.run(points, pose, cloud_transform=False)
    tell('carving/dufomap', f'DUFOMap {version("dufomap")}', best(run)[0])


def open3d_fusion():
    """A TSDF, which knows of no free space away from surfaces."""
    import open3d
    core, t = open3d.core, open3d.t
    intrinsic = core.Tensor([[fx, 0, cx], [0, fy, cy], [0, 0, 1]])
    images = [(t.geometry.Image(core.Tensor(depth)), core.Tensor(np.linalg.inv(pose)))
              for depth, pose in zip(frames, poses)]
    farthest = frames.max() / scale + 1

    def run():
        grid = t.geometry.VoxelBlockGrid(('tsdf', 'weight'), (core.float32, core.float32), ((1), (1)), voxel, 8, 10000)
        for image, extrinsic in images:
            blocks = grid.compute_unique_block_coordinates(image, intrinsic, extrinsic, scale, farthest, TRUNCATION)
            grid.integrate(blocks, image, intrinsic, extrinsic, scale, farthest, TRUNCATION)
    tell('carving/surfaces_alone', f'Open3D {open3d.__version__}', best(run)[0])


if __name__ == '__main__':
    tell_all((vdbfusion_carving, dufomap_carving, open3d_fusion))
