// SPDX-License-Identifier: MIT
#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>

#include "device/devices.h"
#include "perf/peers/primitive_peers.h"

// Parallel algorithms of other libraries beside topple's data-parallel primitives.
int main(int argc, char** argv) {
    using namespace topple;
    CLI::App app{"Runs other libraries' parallel algorithms beside topple's primitives."};
    std::string backend = "native";
    std::uint32_t count = 1u << 26;
    unsigned runs = 3;
    app.add_option("--backend", backend, "native (the standard library) or opencl (Boost.Compute)")
        ->check(CLI::IsMember({"native", "opencl"}))
        ->capture_default_str();
    app.add_option("--elements", count, "Elements of each array")
        ->check(CLI::Range(1u, 1u << 28))
        ->capture_default_str();
    app.add_option("--runs", runs, "Runs of each, of which the best counts")
        ->check(CLI::Range(1u, 1000u))
        ->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    try {
        return perf::compare_primitives(*device::open_device(backend), count, runs) ? 0 : 1;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "topple_primitive_peers: %s\n", error.what());
        return 1;
    }
}
