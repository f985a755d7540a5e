// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <string>

#include "device/devices.h"
#include "topple/error.h"

namespace topple::test {

// A test that runs once on each backend. A missing backend skips by name; with
// TOPPLE_REQUIRE_BACKENDS=1 (as in CI) it fails instead.
class EachBackend : public ::testing::TestWithParam<const char*> {
  protected:
    void SetUp() override {
        try {
            device = device::open_device(GetParam());
        } catch (const Error& error) {
            const char* required = std::getenv("TOPPLE_REQUIRE_BACKENDS");
            if (required && std::string(required) == "1") {
                FAIL() << "backend " << GetParam() << " is missing: " << error.what();
            }
            GTEST_SKIP() << "backend " << GetParam() << " is missing: " << error.what();
        }
        ASSERT_STREQ(device::to_string(device->info().backend), GetParam());
    }
    std::shared_ptr<device::Device> device;
};

inline auto all_backends() {
    return ::testing::Values("native", "opencl", "vulkan");
}
inline std::string backend_name(const ::testing::TestParamInfo<const char*>& info) {
    return info.param;
}

}  // namespace topple::test

#define TOPPLE_ON_EACH_BACKEND(suite)                                     \
    INSTANTIATE_TEST_SUITE_P(Device, suite, topple::test::all_backends(), \
                             topple::test::backend_name)
