// SPDX-License-Identifier: MIT
#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>

#include "io/replace_file.h"
#include "perf/kernels/report.h"
#include "perf/landscape_stages.h"
#include "perf/peers/landscape_peers.h"
#include "perf/peers/peers.h"
#include "topple/device.h"

// Other libraries on the same data as topple's stages, beside them.
int main(int argc, char** argv) {
    using namespace topple;
    CLI::App app{"Runs other libraries on the same data as topple's stages, beside them."};
    std::string backend = "native", csv;
    unsigned runs = 5;
    app.add_option("--backend", backend, "native, opencl or vulkan")->capture_default_str();
    app.add_option("--stage-runs", runs, "Runs of each of topple's stages, at least 1")
        ->check(CLI::Range(1u, 1000u))
        ->capture_default_str();
    app.add_option("--csv", csv, "Write one line per case to this file");
    CLI11_PARSE(app, argc, argv);
    try {
        const auto device = device::open_device(backend);
        const perf::StageScene scene = perf::make_stage_scene(*device);
        const perf::StageRun own = perf::measure_stages(*device, scene, runs);
        std::vector<perf::Result> results = own.results;
        for (const auto& result : perf::measure_landscapes(*device, runs))
            results.push_back(result);
        perf::print_results(results);
        for (const auto& peer : perf::compare_with_peers(scene, own)) results.push_back(peer);
        for (const auto compare : {perf::compare_with_trimesh, perf::compare_with_bullet})
            if (const auto peer = compare(results)) results.push_back(*peer);
        if (!csv.empty()) io::replace_file(csv, perf::csv_text(results));
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "topple_peers: %s\n", error.what());
        return 1;
    }
}
