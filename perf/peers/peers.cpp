// SPDX-License-Identifier: MIT
#include "perf/peers/peers.h"

#include <algorithm>
#include <cstdio>
#include <span>
#include <string>

#include "lab/scores/score.h"
#include "perf/peers/cloud_peers.h"
#include "perf/peers/frame_peers.h"
#include "perf/peers/octomap_carving.h"
#include "perf/peers/pcl_segmentation.h"

namespace topple::perf {
namespace {

const Result& result_of(const StageRun& run, const std::string& name) {
    return *std::find_if(run.results.begin(), run.results.end(),
                         [&](const Result& r) { return r.name == name; });
}

Result peer_result(std::string name, std::string library, const Work& work, double seconds) {
    Result result;
    result.backend = "peer";
    result.device = std::move(library);
    result.name = std::move(name);
    result.work = work;
    result.samples_s = {seconds};
    return result;
}

void print_row(const Result& own, const Result& peer) {
    std::printf("%-32s %9.3f %9.3f %8.1fx  ", peer.name.c_str(), own.best(), peer.best(),
                peer.best() / own.best());
}

void print_segments(const StageScene& scene, std::span<const std::int32_t> label,
                    std::span<const std::int32_t> peer) {
    const auto& truth = scene.sequence.part_of_point;
    const auto own = scenes::segmentation_score(truth, label);
    const auto theirs = scenes::segmentation_score(truth, peer);
    std::printf("part mIoU %.3f against %.3f, Hamming %.3f against %.3f\n", own.miou, theirs.miou,
                own.hamming, theirs.hamming);
}

// What topple says of the voxels that OctoMap calls free, and the other way round.
struct Agreement {
    std::uint64_t free = 0, empty = 0, invisible = 0, surface = 0;
    void add(vdb::State state) {
        ++free;
        empty += state == vdb::State::empty;
        invisible += state == vdb::State::invisible;
        surface += state == vdb::State::surface;
    }
    void print() const {
        const auto percent = [&](std::uint64_t n) {
            return 100.0 * static_cast<double>(n) / static_cast<double>(free);
        };
        std::printf(
            "of %llu voxels free there: %.2f %% empty here, %.2f %% unseen, %.2f %% surface\n",
            static_cast<unsigned long long>(free), percent(empty), percent(invisible),
            percent(surface));
    }
};

}  // namespace

std::vector<Result> compare_with_peers(const StageScene& scene, const StageRun& own) {
    std::vector<Result> results;
    std::printf("\n%-32s %9s %9s %9s\n", "side by side", "topple s", "peer s", "ratio");
    const Result& segmentation = result_of(own, "segmentation");
    for (const auto run : {pcl_region_growing, pcl_lccp}) {
        const auto peer = run(scene.ingested.cloud);
        if (!peer) continue;
        results.push_back(peer_result("segmentation/" + peer->name, peer->library,
                                      segmentation.work, peer->normals_s + peer->segments_s));
        print_row(segmentation, results.back());
        print_segments(scene, own.label, peer->label);
    }
    if (results.empty()) std::printf("PCL: not in this build; apt-get install libpcl-dev\n");
    const std::vector<CloudPeer> peers = cloud_peers(scene.ingested.cloud);
    if (peers.empty()) std::printf("Open3D, small_gicp: not found by python3; they are on PyPI\n");
    for (const CloudPeer& peer : peers) {
        const bool segments = !peer.label.empty();
        const Result& mine = segments ? segmentation : result_of(own, "segmentation/normals");
        results.push_back(peer_result(peer.name, peer.library, mine.work, peer.seconds));
        print_row(mine, results.back());
        if (segments)
            print_segments(scene, own.label, peer.label);
        else
            std::printf("%s\n", peer.library.c_str());
    }
    const Result& carving = result_of(own, "carving");
    Agreement agreement;
    const auto map =
        octomap_carving(scene.sequence.intrinsics, scene.sequence.frames, stage_voxel_m,
                        [&](std::int32_t i, std::int32_t j, std::int32_t k, bool occupied) {
                            if (!occupied) agreement.add(own.carved->state_at(i, j, k));
                        });
    if (map) {
        results.push_back(peer_result("carving/octomap", map->library, carving.work, map->seconds));
        print_row(carving, results.back());
        agreement.print();
    } else {
        std::printf("OctoMap: not in this build; apt-get install liboctomap-dev\n");
    }
    const std::vector<Told> mappers =
        frame_peers(scene.sequence.intrinsics, scene.sequence.frames, stage_voxel_m);
    if (mappers.empty())
        std::printf("VDBFusion, DUFOMap, Open3D: not found by python3; they are on PyPI\n");
    for (const Told& peer : mappers) {
        results.push_back(peer_result(peer.name, peer.library, carving.work, peer.seconds));
        print_row(carving, results.back());
        std::printf("%s\n", peer.library.c_str());
    }
    std::fflush(stdout);
    return results;
}

}  // namespace topple::perf
