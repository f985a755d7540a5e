// SPDX-License-Identifier: MIT
#include "perf/peers/pcl_segmentation.h"

#include <pcl/features/normal_3d_omp.h>
#include <pcl/pcl_config.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/lccp_segmentation.h>
#include <pcl/segmentation/region_growing.h>
#include <pcl/segmentation/supervoxel_clustering.h>

#include <chrono>
#include <map>

namespace topple::perf {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

Cloud::Ptr as_pcl(const CloudView& cloud) {
    Cloud::Ptr out(new Cloud);
    out->reserve(cloud.size());
    for (std::size_t n = 0; n < cloud.size(); ++n)
        out->push_back({cloud.x[n], cloud.y[n], cloud.z[n]});
    return out;
}

class Stopwatch {
  public:
    // Seconds since it was made or last asked.
    double lap() {
        const auto now = std::chrono::steady_clock::now();
        const double s = std::chrono::duration<double>(now - start_).count();
        start_ = now;
        return s;
    }

  private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

std::optional<PeerSegments> pcl_region_growing(const CloudView& cloud) {
    const Cloud::Ptr points = as_pcl(cloud);
    PeerSegments out;
    out.name = "pcl_region_growing";
    out.library = "PCL " PCL_VERSION_PRETTY;
    Stopwatch clock;
    const pcl::search::KdTree<pcl::PointXYZ>::Ptr tree(new pcl::search::KdTree<pcl::PointXYZ>);
    const pcl::PointCloud<pcl::Normal>::Ptr normals(new pcl::PointCloud<pcl::Normal>);
    pcl::NormalEstimationOMP<pcl::PointXYZ, pcl::Normal> estimation;
    estimation.setSearchMethod(tree);
    estimation.setInputCloud(points);
    estimation.setKSearch(30);
    estimation.compute(*normals);
    out.normals_s = clock.lap();
    pcl::RegionGrowing<pcl::PointXYZ, pcl::Normal> growing;
    growing.setMinClusterSize(50);
    growing.setMaxClusterSize(static_cast<int>(points->size()));
    growing.setSearchMethod(tree);
    growing.setNumberOfNeighbours(30);
    growing.setInputCloud(points);
    growing.setInputNormals(normals);
    growing.setSmoothnessThreshold(3.0f * static_cast<float>(M_PI) / 180);
    growing.setCurvatureThreshold(1);
    std::vector<pcl::PointIndices> clusters;
    growing.extract(clusters);
    out.segments_s = clock.lap();
    out.label.assign(cloud.size(), -1);
    for (std::size_t k = 0; k < clusters.size(); ++k) {
        for (const int i : clusters[k].indices) out.label[i] = static_cast<std::int32_t>(k);
    }
    return out;
}

std::optional<PeerSegments> pcl_lccp(const CloudView& cloud) {
    const Cloud::Ptr points = as_pcl(cloud);
    PeerSegments out;
    out.name = "pcl_lccp";
    out.library = "PCL " PCL_VERSION_PRETTY;
    Stopwatch clock;
    pcl::SupervoxelClustering<pcl::PointXYZ> supervoxels(0.02f, 0.12f);
    supervoxels.setUseSingleCameraTransform(false);  // the cloud is of many views
    supervoxels.setInputCloud(points);
    supervoxels.setColorImportance(0);
    supervoxels.setSpatialImportance(1);
    supervoxels.setNormalImportance(4);
    std::map<std::uint32_t, pcl::Supervoxel<pcl::PointXYZ>::Ptr> clusters;
    supervoxels.extract(clusters);
    std::multimap<std::uint32_t, std::uint32_t> adjacency;
    supervoxels.getSupervoxelAdjacency(adjacency);
    pcl::LCCPSegmentation<pcl::PointXYZ> lccp;
    lccp.setConcavityToleranceThreshold(10);
    lccp.setSmoothnessCheck(true, 0.02f, 0.12f, 0.1f);
    lccp.setSanityCheck(true);
    lccp.setMinSegmentSize(1);
    lccp.setInputSupervoxels(clusters, adjacency);
    lccp.segment();
    const auto labelled = supervoxels.getLabeledCloud();
    auto relabelled = *labelled;
    lccp.relabelCloud(relabelled);
    out.segments_s = clock.lap();
    for (const auto& point : relabelled) {
        out.label.push_back(point.label == 0 ? -1 : static_cast<std::int32_t>(point.label));
    }
    return out;
}

}  // namespace topple::perf
