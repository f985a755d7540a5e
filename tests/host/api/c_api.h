// SPDX-License-Identifier: MIT
#pragma once

#include "host/io/files.h"
#include "host/pipeline/small_room.h"
#include "topple/topple.h"

namespace topple::test {

inline topple_cloud c_cloud(const PointCloud& cloud) {
    topple_cloud c;
    topple_cloud_init(&c, sizeof(c));
    c.x = cloud.x.data();
    c.y = cloud.y.data();
    c.z = cloud.z.data();
    c.count = cloud.size();
    return c;
}

class CApi : public Files {
  protected:
    void SetUp() override {
        ASSERT_EQ(topple_device_open("native", 2, &device, &status), TOPPLE_OK) << status.message;
        topple_options_init(&options, sizeof(options));
        options.device = device;
        options.disturbances = TOPPLE_WIND;
    }
    void TearDown() override {
        topple_result_release(result);
        topple_device_release(device);
    }
    int parsed() { return topple_parse_cloud(&cloud, &options, &result, &status); }
    // An item of the result, or what of it is not of items.
    template <class Out>
    Out get(int (*from)(const topple_result*, std::uint64_t, Out*, topple_status*),
            std::uint64_t n) {
        Out out{};
        out.size = sizeof(out);
        EXPECT_EQ(from(result, n, &out, &status), TOPPLE_OK) << status.message;
        return out;
    }
    topple_object object(std::uint64_t n) { return get(topple_result_object, n); }
    topple_scene scene() {
        topple_scene out{};
        out.size = sizeof(out);
        EXPECT_EQ(topple_result_scene(result, &out, &status), TOPPLE_OK) << status.message;
        return out;
    }

    const SmallRoom room = SmallRoom::scattered();
    topple_cloud cloud = c_cloud(room.cloud);
    topple_status status{};
    topple_device* device = nullptr;
    topple_options options{};
    topple_result* result = nullptr;
};

}  // namespace topple::test
