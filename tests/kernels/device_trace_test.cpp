// SPDX-License-Identifier: MIT
#include <CL/cl.h>

#include "device/trace.h"
#include "environment.h"
#include "io/staging_folder.h"
#include "multiply_add.hpp"
#include "topple/embed.h"
#include "topple/kernel_testing/compare.h"
#include "topple/kernel_testing/each_backend.h"
#include "topple/kernels/queue.h"
#include "trace_file.h"
#include "triad.hpp"

// What TOPPLE_TRACE writes.
namespace topple::test {
namespace {

using ::testing::HasSubstr;

class DeviceTrace : public EachBackend {
  protected:
    const io::StagingFolder folder_ = io::StagingFolder::temporary();
    const std::filesystem::path file_ = folder_.path() / "trace.json";

    // Two batches, the first of two dispatches.
    static device::Counters use(device::Device& device) {
        const std::uint32_t count = 1000;
        device::Buffer<float> a(device, std::vector<float>(count, 2), "a \"quoted\""),
            out(device, count, "out");
        out.fill(0);
        device::Queue queue(device);
        for (const int dispatches : {2, 1}) {
            for (int d = 0; d < dispatches; ++d)
                queue.add<kernels::Triad>(count, {.a = a, .b = a, .dst = out},
                                          {.count = count, .scale = 3});
            queue.run();
        }
        EXPECT_EQ(out.download()[count - 1], 8.0f);
        return device.counters();
    }
};
TOPPLE_ON_EACH_FORM(DeviceTrace);

TEST_P(DeviceTrace, SaysWhatWasCounted) {
    const EnvironmentVariable asked("TOPPLE_TRACE", file_.string());
    const auto traced = device::open_form(GetParam());
    const device::Counters counts = use(*traced);
    traced->trace()->write();
    const TraceFile trace(file_);
    EXPECT_EQ(counts.dispatches, 3u);
    trace.expect_counts(counts);
    trace.expect_dispatches_in_batches();
    EXPECT_EQ(trace.of_kind("batch").size(), 2u);
    EXPECT_EQ(trace.names("dispatch"), std::set<std::string>{"triad"});
    EXPECT_EQ(trace.names("write"), std::set<std::string>{"write a \"quoted\""});
    EXPECT_EQ(trace.names("read"), std::set<std::string>{"read out"});
    EXPECT_EQ(trace.names("fill"), std::set<std::string>{"fill out"});
    ASSERT_EQ(trace.devices().size(), 1u);
    EXPECT_THAT(trace.devices()[0], HasSubstr(traced->info().name));
    const bool native = traced->info().backend == device::Backend::native;
    EXPECT_THAT(trace.devices()[0], HasSubstr(native ? "by the host's clock" : "by its own clock"));
    EXPECT_EQ(trace.of_kind("wait").empty(), native);
}

// Devices of a process share the file, which has what they did also when they are gone.
TEST_P(DeviceTrace, IsWrittenWhenTheLastDeviceGoes) {
    const EnvironmentVariable asked("TOPPLE_TRACE", file_.string());
    auto first = device::open_form(GetParam()), second = device::open_form(GetParam());
    use(*first);
    use(*second);
    first.reset();
    EXPECT_TRUE(TraceFile(file_).of_kind("dispatch").empty());
    second.reset();
    EXPECT_EQ(TraceFile(file_).of_kind("dispatch").size(), 6u);
    EXPECT_EQ(TraceFile(file_).devices().size(), 2u);
}

TEST_P(DeviceTrace, RecordsNothingUnasked) {
    EXPECT_EQ(device->trace(), nullptr);
}

// The clock tells long dispatches from short ones, in either order.
TEST_P(DeviceTrace, TimesEachDispatch) {
    device->record(std::make_shared<device::Trace>());
    const std::uint32_t count = 256 * 256;
    const device::Buffer<float> x(*device, std::vector<float>(count, 1), "x");
    device->prepare(kernels::MultiplyAdd::source());
    device::Queue queue(*device);
    const std::vector<std::uint32_t> rounds{20'000, 1, 1, 20'000, 1};
    for (const std::uint32_t n : rounds)
        queue.add<kernels::MultiplyAdd>(count, {.x = x}, {.count = count, .rounds = n});
    queue.run();
    std::vector<double> took;
    for (const auto& event : device->trace()->events())
        if (std::string_view(event.kind) == "dispatch")
            took.push_back(std::chrono::duration<double>(event.end - event.begin).count());
    ASSERT_EQ(took.size(), rounds.size());
    for (const std::size_t is_short : {1, 2, 4})
        for (const std::size_t is_long : {0, 3}) EXPECT_LT(5 * took[is_short], took[is_long]);
}

TEST_P(DeviceTrace, RefusesAFileThatCannotBeWritten) {
    const std::string nowhere = (folder_.path() / "none" / "trace.json").string();
    const EnvironmentVariable asked("TOPPLE_TRACE", nowhere);
    const std::string said = message_of([&] { device::open_form(GetParam()); }, ErrorKind::input);
    EXPECT_THAT(said, HasSubstr("TOPPLE_TRACE: "));
    EXPECT_THAT(said, HasSubstr((folder_.path() / "none").string()));
}

// A queue of the caller's that does not profile stays as it is; the trace says what it has instead.
TEST(DeviceTraceAdopted, TakesTheHostsClock) {
    cl_platform_id platform = nullptr;
    cl_device_id id = nullptr;
    if (clGetPlatformIDs(1, &platform, nullptr) != CL_SUCCESS ||
        clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 1, &id, nullptr) != CL_SUCCESS) {
        ASSERT_FALSE(backends_required()) << "an OpenCL driver is missing";
        GTEST_SKIP() << "no OpenCL driver";
    }
    cl_int code = CL_SUCCESS;
    cl_context context = clCreateContext(nullptr, 1, &id, nullptr, nullptr, &code);
    ASSERT_EQ(code, CL_SUCCESS);
    const io::StagingFolder folder = io::StagingFolder::temporary();
    for (const bool profiles : {false, true}) {
        cl_command_queue queue =
            clCreateCommandQueue(context, id, profiles ? CL_QUEUE_PROFILING_ENABLE : 0, &code);
        ASSERT_EQ(code, CL_SUCCESS);
        const std::filesystem::path file = folder.path() / "adopted.json";
        const EnvironmentVariable asked("TOPPLE_TRACE", file.string());
        {
            const auto device = device::adopt_opencl({context, id, queue});
            const device::Buffer<float> a(*device, std::vector<float>(10, 1), "a");
            run_kernel<kernels::Triad>(*device, 10, {.a = a, .b = a, .dst = a},
                                       {.count = 10, .scale = 0});
        }
        const TraceFile trace(file);
        EXPECT_EQ(trace.of_kind("dispatch").size(), 1u);
        trace.expect_dispatches_in_batches();
        ASSERT_EQ(trace.devices().size(), 1u);
        EXPECT_THAT(trace.devices()[0], HasSubstr(profiles ? "by its own clock"
                                                           : "the host's clock, one by one: the "
                                                             "queue that was given does not"));
        clReleaseCommandQueue(queue);
    }
    clReleaseContext(context);
}

}  // namespace
}  // namespace topple::test
