// SPDX-License-Identifier: MIT
#include "environment.h"
#include "host/pipeline/small_room.h"
#include "lab/temporary_folder.h"
#include "topple/kernel_testing/each_backend.h"
#include "trace_file.h"

// The trace of a whole parse.
namespace topple::test {
namespace {

class ParseTrace : public EachBackend {};
TOPPLE_ON_EACH_BACKEND(ParseTrace);

TEST_P(ParseTrace, HasStagesAndKernels) {
    const scenes::TemporaryFolder folder("topple_trace");
    const std::filesystem::path file = folder.path() / "trace.json";
    const EnvironmentVariable asked("TOPPLE_TRACE", file.string());
    ParseOptions options;
    options.device = device::open_form(GetParam());
    const ParseResult result = parse(SmallRoom::scattered().cloud, options);
    const TraceFile trace(file);
    trace.expect_counts(options.device->counters());
    trace.expect_dispatches_in_batches();
    std::set<std::string> stages;
    double all_s = 0;
    for (const auto& [name, time_s] : result.scene.timings_s) {
        stages.insert(name);
        all_s += time_s;
    }
    EXPECT_EQ(trace.names("stage"), stages);
    EXPECT_NEAR(1e-6 * trace.microseconds("stage"), all_s, 0.02 * all_s);
    for (const char* kernel : {"voxel_normals", "six_fill_sweep", "rocking"})
        EXPECT_TRUE(trace.names("dispatch").contains(kernel)) << kernel;
}

}  // namespace
}  // namespace topple::test
