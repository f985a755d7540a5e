// SPDX-License-Identifier: MIT
#include <unistd.h>

#include "errors.h"
#include "topple/kernel_testing/compare.h"
#include "topple/kernel_testing/each_backend.h"
#include "topple/kernels/queue.h"
#include "triad.hpp"

namespace topple::test {
namespace {

using ::testing::HasSubstr;

constexpr std::uint64_t step = device::slice_alignment / 4;

std::vector<std::uint32_t> counting(std::size_t count) {
    std::vector<std::uint32_t> out(count);
    std::iota(out.begin(), out.end(), 0u);
    return out;
}

class DeviceBuffer : public EachBackend {};
TOPPLE_ON_EACH_FORM(DeviceBuffer);

TEST_P(DeviceBuffer, GivesBackWhatItTook) {
    for (const std::size_t count : {0, 1, 63, 64, 65, 997, 3'000'001}) {
        SCOPED_TRACE(count);
        const std::vector<std::uint32_t> data = counting(count);
        const device::Buffer<std::uint32_t> buffer(*device, data, "data");
        EXPECT_EQ(buffer.size(), count);
        EXPECT_TRUE(same(buffer.download(), data));
    }
}

TEST_P(DeviceBuffer, UploadsAndDownloadsParts) {
    device::Buffer<std::int32_t> buffer(*device, 1000, "parts");
    buffer.fill(-7);
    buffer.upload(std::vector<std::int32_t>{1, 2, 3}, 501);
    std::vector<std::int32_t> part(5);
    buffer.download(part, 500);
    EXPECT_EQ(part, (std::vector<std::int32_t>{-7, 1, 2, 3, -7}));
    buffer.upload(std::vector<std::int32_t>{}, 1000);
    EXPECT_EQ(buffer.download()[999], -7);
}

TEST_P(DeviceBuffer, FillsEveryElement) {
    for (const std::size_t count : {1, 3, 64, 997}) {
        device::Buffer<float> buffer(*device, count, "filled");
        buffer.fill(-0.1f);
        EXPECT_TRUE(same(buffer.download(), std::vector<float>(count, -0.1f)));
    }
}

TEST_P(DeviceBuffer, RefusesRangesOutside) {
    device::Buffer<float> buffer(*device, 10, "ten");
    const std::string expected = "buffer ten: range [8, 11) is outside of its 10 elements";
    EXPECT_EQ(message_of([&] { buffer.upload(std::vector<float>(3), 8); }), expected);
    std::vector<float> to(3);
    EXPECT_EQ(message_of([&] { buffer.download(to, 8); }), expected);
    EXPECT_THAT(message_of([&] { buffer.slice(~0ull, 2); }),
                HasSubstr("outside of its 10 elements"));
}

TEST_P(DeviceBuffer, RefusesMisalignedSlices) {
    const device::Buffer<float> buffer(*device, 3 * step, "aligned");
    EXPECT_NO_THROW(buffer.slice(2 * step, step));
    EXPECT_NO_THROW(buffer.slice(3 * step, 0));
    EXPECT_THAT(message_of([&] { buffer.slice(1, 4); }),
                HasSubstr("must start at a multiple of " + std::to_string(step)));
}

TEST_P(DeviceBuffer, RefusesMoreThanTheDeviceAllocates) {
    const std::uint64_t count = device->info().limits.max_allocation_bytes / 4 + 1;
    const std::string said = message_of([&] { device::Buffer<float>(*device, count, "huge"); });
    EXPECT_THAT(said, HasSubstr("buffer huge: " + std::to_string(4 * count) + " bytes"));
    EXPECT_THAT(said, Not(HasSubstr("--")));  // options are the program's
    EXPECT_THAT(message_of([&] { device::Buffer<float>(*device, ~0ull / 2, "absurd"); }),
                HasSubstr("overflow a 64-bit size"));
}

// Both ways of reaching the elements see the same memory.
TEST_P(DeviceBuffer, HostViewIsTheBuffer) {
    device::Buffer<std::uint32_t> buffer(*device, counting(100), "viewed");
    const std::span<std::uint32_t> view = buffer.host_view();
    if (view.empty()) {
        ASSERT_TRUE(device->info().gpu) << "a CPU shares its memory with the host";
        return;
    }
    ASSERT_EQ(view.size(), 100u);
    EXPECT_EQ(view[42], 42u);
    view[42] = 7;
    EXPECT_EQ(buffer.download()[42], 7u);
    buffer.upload(std::vector<std::uint32_t>{8}, 43);
    EXPECT_EQ(buffer.host_view()[43], 8u);
    buffer.fill(9);
    EXPECT_EQ(buffer.host_view()[44], 9u);
}

TEST_P(DeviceBuffer, CountsBytes) {
    device::Buffer<float> buffer(*device, std::vector<float>(100), "counted");
    EXPECT_EQ(buffer.download().size(), 100u);
    EXPECT_EQ(device->counters().bytes_written, 400u);
    EXPECT_EQ(device->counters().bytes_read, 400u);
}

// Kernels that can't be built say so by name, with the driver's own words.

std::string build_error(device::Device& device, const device::KernelSource& source) {
    return message_of([&] { device.prepare(source); });
}

// OpenCL kernels are compiled at first use; the others with topple, and only set up by the driver.
class OpenClErrors : public EachBackend {};
INSTANTIATE_TEST_SUITE_P(Device, OpenClErrors, ::testing::Values("opencl"), backend_name);
class VulkanErrors : public EachBackend {};
INSTANTIATE_TEST_SUITE_P(Device, VulkanErrors, ::testing::Values("vulkan"), backend_name);

TEST_P(OpenClErrors, BuildLogNamesFileAndLine) {
    device::KernelSource broken = kernels::Triad::source();
    broken.name = "broken";
    broken.opencl =
        "#line 1 \"kernels/broken.kernel\"\n"
        "__kernel void broken(__global float* x) {\n"
        "    x[0] = no_such_name;\n"
        "}\n";
    const std::string message = build_error(*device, broken);
    EXPECT_THAT(message, HasSubstr("kernel broken does not build for " + device->info().name));
    // NVIDIA's compiler counts lines of what it is given, whatever #line says.
    if (!device->info().gpu) {
        EXPECT_THAT(message, HasSubstr("broken.kernel:2"));
    }
    EXPECT_THAT(message, HasSubstr("no_such_name"));
    EXPECT_EQ(device->counters().kernel_builds, 0u);
    // The device still works.
    EXPECT_NO_THROW(device->prepare(kernels::Triad::source()));
}

TEST_P(VulkanErrors, RefusesGroupsLargerThanTheDeviceRuns) {
    device::KernelSource wide = kernels::Triad::source();
    wide.name = "wide";
    wide.group_size = device->info().limits.max_group_size + 1;
    EXPECT_THAT(build_error(*device, wide),
                HasSubstr("kernel wide does not build for " + device->info().name));
}

// A batch with a kernel that does not build runs none of its dispatches.
TEST_P(OpenClErrors, ABatchThatCannotBuildRunsNothing) {
    device::KernelSource broken = kernels::Triad::source();
    broken.name = "broken";
    broken.opencl = "not a kernel";
    const device::Buffer<float> a(*device, std::vector<float>(10, 1), "a"),
        c(*device, std::vector<float>(10, 0), "c");
    const kernels::TriadParams params{.count = 10, .scale = 1};
    device::Dispatch dispatch;
    dispatch.kernel = &kernels::Triad::source();
    dispatch.groups = 1;
    kernels::Triad::bind({.a = a, .b = a, .dst = c}, dispatch.ranges);
    const auto bytes = std::as_bytes(std::span(&params, 1));
    dispatch.params.assign(bytes.begin(), bytes.end());
    std::vector<device::Dispatch> batch{dispatch, dispatch};
    batch[1].kernel = &broken;
    EXPECT_THROW(device->run(batch), Error);
    EXPECT_TRUE(same(c.download(), std::vector<float>(10, 0)));
    batch.pop_back();
    device->run(batch);
    EXPECT_TRUE(same(c.download(), std::vector<float>(10, 2)));
}

// The range of one binding is limited; what is larger goes in tiles.
TEST_P(VulkanErrors, RefusesBindingsBeyondTheLimit) {
    const auto& limits = device->info().limits;
    if (limits.max_binding_bytes + 4 > limits.max_allocation_bytes) {
        GTEST_SKIP() << "what this device allocates it can bind";
    }
    const std::uint64_t count = limits.max_binding_bytes / 4 + 1;
    const device::Buffer<float> large(*device, count, "large");
    device::Queue queue(*device);
    EXPECT_THAT(message_of([&] {
                    queue.add<kernels::Triad>(64, {.a = large, .b = large, .dst = large},
                                              {.count = 64, .scale = 1});
                }),
                HasSubstr("kernel triad: binding a spans"));
}

// tools/build_kernels.py refuses broken kernels, and names the file and the line in it.

// What the tool says of a kernel with the statement on its line 6; empty where it takes it.
std::string verdict(const std::string& statement) {
    const auto folder =
        std::filesystem::temp_directory_path() / ("topple_kernel_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "sample.kernel") << "// A sample.\n"
                                               "KERNEL(sample, 64)\n"
                                               "    BUFFER_OUT(0, float, o)\n"
                                               "    PARAMS(TriadParams, p)\n"
                                               "BEGIN\n"
                                            << statement << "\nEND\n";
    const std::string kernels = TOPPLE_SOURCE_DIR "/kernels";
    const std::string command = "python3 '" + kernels + "/tools/build_kernels.py' '" +
                                folder.string() + "' --kernel '" +
                                (folder / "sample.kernel").string() + "' --params '" + kernels +
                                "/probes/params.h' --root '" + folder.string() +
                                "' --namespace sample --glslang glslangValidator 2>&1";
    std::string said;
    FILE* pipe = popen(command.c_str(), "r");
    if (!pipe) return "popen failed";
    std::array<char, 512> piece{};
    while (std::fgets(piece.data(), piece.size(), pipe)) said += piece.data();
    const int status = pclose(pipe);
    std::filesystem::remove_all(folder);
    EXPECT_EQ(status == 0, said.empty()) << said;
    return said;
}

TEST(DeviceTools, TakesWhatTheDialectHas) {
    EXPECT_EQ(verdict("o[GLOBAL_ID] = 1.5f * sqrt(2.0f) + 1.0e-3f; // 0.5 and exp(1) in words"),
              "");
}

TEST(DeviceTools, RefusesByFileAndLine) {
    const std::array<std::array<std::string, 2>, 7> cases{{
        {"o[0] = 0.5;", "sample.kernel:6: 0.5 is a double"},
        {"o[0] = 1e-3;", "sample.kernel:6: 1e-3 is a double"},
        {"o[0] = exp(1.0f);", "sample.kernel:6: exp( differs between backends"},
        {"o[0] = fma(o[0], o[1], o[2]);", "sample.kernel:6: fma( rounds differently"},
        {"double d = 1.0f;", "sample.kernel:6: double is not a type"},
        {"o[0] = p.scal;", "sample.kernel:6: 'scal' : no such field"},
        {"o[0] = nowhere;", "sample.kernel:6: 'nowhere' : undeclared identifier"},
    }};
    for (const auto& [statement, expected] : cases) {
        const std::string said = verdict(statement);
        EXPECT_NE(said.find(expected), std::string::npos) << statement << "\n" << said;
    }
}

}  // namespace
}  // namespace topple::test
