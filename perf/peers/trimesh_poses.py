# SPDX-License-Identifier: MIT
"""Times trimesh's stable poses of hulls: trimesh_poses.py FILE, one hull a line, x y z of each point.

The centre of mass is the origin. Prints trimesh's version, the best seconds of three runs over all hulls, and the
number of poses."""
import sys
import time

try:
    import numpy
    import trimesh
    from trimesh.poses import compute_stable_poses
except ImportError:
    sys.exit(0)

with open(sys.argv[1]) as file:
    hulls = [numpy.array(line.split(), float).reshape(-1, 3) for line in file]
best, poses = float("inf"), 0
for _ in range(3):
    start = time.perf_counter()
    # The mesh is made in the time that is taken: topple's own starts from points, too.
    poses = sum(len(compute_stable_poses(trimesh.convex.convex_hull(hull), center_mass=numpy.zeros(3))[1])
                for hull in hulls)
    best = min(best, time.perf_counter() - start)
print(trimesh.__version__, best, poses)
