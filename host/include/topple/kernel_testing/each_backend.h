// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <string>

#include "topple/error.h"
#include "topple/kernels/device.h"

namespace topple::test {

// Whether a missing backend is a failure, as in CI, rather than a reason to skip by name.
inline bool backends_required() {
    const char* required = std::getenv("TOPPLE_REQUIRE_BACKENDS");
    return required && std::string(required) == "1";
}

// A test that runs once on each backend, of kernels by Vulkan also in their form for real GPUs. A
// missing backend skips by name; with TOPPLE_REQUIRE_BACKENDS=1 (as in CI) it fails instead.
class EachBackend : public ::testing::TestWithParam<const char*> {
  protected:
    void SetUp() override {
        try {
            device = device::open_form(GetParam());
        } catch (const Error& error) {
            if (backends_required())
                FAIL() << "backend " << GetParam() << " is missing: " << error.what();
            GTEST_SKIP() << "backend " << GetParam() << " is missing: " << error.what();
        }
        ASSERT_TRUE(std::string(GetParam()).starts_with(device::to_string(device->info().backend)));
    }
    std::shared_ptr<device::Device> device;
};

inline auto all_backends() {
    return ::testing::Values("native", "opencl", "vulkan");
}
// And by Vulkan also as on a real GPU.
inline auto all_forms() {
    return ::testing::ValuesIn(device::forms);
}
inline std::string backend_name(const ::testing::TestParamInfo<const char*>& info) {
    return info.param;
}

}  // namespace topple::test

#define TOPPLE_ON_EACH_BACKEND(suite)                                     \
    INSTANTIATE_TEST_SUITE_P(Device, suite, topple::test::all_backends(), \
                             topple::test::backend_name)
// Of kernels: each form of theirs.
#define TOPPLE_ON_EACH_FORM(suite) \
    INSTANTIATE_TEST_SUITE_P(Device, suite, topple::test::all_forms(), topple::test::backend_name)
