# SPDX-License-Identifier: MIT
"""Times Python's libraries on a cloud: cloud_peers.py POINTS LABELS, x y z of each point as float32.

Prints a line for each that is installed: what it did, its name and version, and the best seconds of three runs. LABELS
takes the planar patch of each point, int32, -1 for none, where Open3D finds them."""
import os
import sys
from importlib.metadata import version

try:
    import numpy as np
except ImportError:
    sys.exit(0)

from timing import best, tell, tell_all

NEIGHBOURS, THREADS = 30, len(os.sched_getaffinity(0))
points = np.fromfile(sys.argv[1], np.float32).reshape(-1, 3)


def small_gicp_normals():
    import small_gicp
    cloud = small_gicp.PointCloud(points.astype(np.float64))

    def run():
        small_gicp.estimate_normals(cloud, num_neighbors=NEIGHBOURS, num_threads=THREADS)
    tell('normals/small_gicp', f'small_gicp {version("small_gicp")}', best(run)[0])


def open3d_cloud():
    import open3d
    open3d.utility.set_verbosity_level(open3d.utility.VerbosityLevel.Error)
    return open3d, open3d.geometry.PointCloud(open3d.utility.Vector3dVector(points.astype(np.float64)))


def open3d_normals():
    open3d, cloud = open3d_cloud()
    knn = open3d.geometry.KDTreeSearchParamKNN(NEIGHBOURS)
    tell('normals/open3d', f'Open3D {open3d.__version__}', best(lambda: cloud.estimate_normals(knn))[0])


def open3d_patches():
    """Normals and planar patches, with the parameters of Open3D's tutorial; a point is of the first box that holds it."""
    open3d, cloud = open3d_cloud()
    knn = open3d.geometry.KDTreeSearchParamKNN(NEIGHBOURS)

    def run():
        cloud.estimate_normals(knn)
        return cloud.detect_planar_patches(normal_variance_threshold_deg=60, coplanarity_deg=75, outlier_ratio=0.75,
                                           min_plane_edge_length=0, min_num_points=0, search_param=knn)
    seconds, boxes = best(run, 1)
    label = np.full(len(points), -1, np.int32)
    for n, box in reversed(list(enumerate(boxes))):
        label[box.get_point_indices_within_bounding_box(cloud.points)] = n
    label.tofile(sys.argv[2])
    tell('segmentation/open3d', f'Open3D {open3d.__version__}', seconds)


if __name__ == '__main__':
    tell_all((small_gicp_normals, open3d_normals, open3d_patches))
