// SPDX-License-Identifier: MIT
#include "host/pipeline/scan.h"
#include "kernels/device_harness.h"

// The same input and seed give the same result, whatever it is computed on.
namespace topple::test {
namespace {

// FNV-1a over all that a parse decides, bit for bit.
class Hash {
  public:
    template <class T>
    void add(const std::vector<T>& values) {
        for (const T& v : values) add(v);
    }
    template <class T>
    void add(const T& value) {
        static_assert(std::is_arithmetic_v<T>);
        char bytes[sizeof(T)];
        std::memcpy(bytes, &value, sizeof(T));
        for (const char b : bytes) {
            hash_ = (hash_ ^ static_cast<unsigned char>(b)) * 0x100000001b3ULL;
        }
    }
    std::uint64_t value() const { return hash_; }

  private:
    std::uint64_t hash_ = 0xcbf29ce484222325ULL;
};

std::uint64_t hash_of(const Scene& scene) {
    Hash h;
    for (const auto* axis : {&scene.points.x, &scene.points.nx, &scene.solid.x, &scene.solid.z})
        h.add(*axis);
    for (const auto* labels : {&scene.points.primitive, &scene.points.object,
                               &scene.solid.primitive, &scene.solid.object})
        h.add(*labels);
    h.add(scene.solid.state);
    for (const Object& o : scene.objects) {
        for (const double v : {o.mass_kg, o.barrier_J, o.release_J, o.unsafety}) h.add(v);
        for (const auto& [name, risk] : o.risk_J) h.add(risk);
    }
    for (const Contact& c : scene.contacts) h.add(c.probability);
    for (const Support& s : scene.supports) h.add(s.area_m2);
    return h.value();
}

double share_equal(const std::vector<std::int32_t>& a, const std::vector<std::int32_t>& b) {
    EXPECT_EQ(a.size(), b.size());
    std::size_t same = 0;
    for (std::size_t n = 0; n < std::min(a.size(), b.size()); ++n) same += a[n] == b[n];
    return static_cast<double>(same) / static_cast<double>(std::max(a.size(), b.size()));
}

TEST(Threads, change_no_bit) {
    const PointCloud cloud = cloud_of_room(3);
    const Scene one = parse(cloud, on(device::open_device("native", 1))).scene;
    const Scene two = parse(cloud, on(device::open_device("native", 2))).scene;
    const Scene five = parse(cloud, on(device::open_device("native", 5))).scene;
    ASSERT_GT(one.objects.size(), 3u);
    EXPECT_EQ(one.points.primitive, two.points.primitive);
    EXPECT_EQ(one.points.object, two.points.object);
    EXPECT_EQ(hash_of(one), hash_of(two));
    EXPECT_EQ(hash_of(one), hash_of(five));
}

using SlowBackends = EachBackend;

TEST_P(SlowBackends, agree_on_primitives_and_objects) {
    const PointCloud cloud = cloud_of_room(3);
    const Scene here = parse(cloud, on(device)).scene;
    EXPECT_EQ(here.backend, device::to_string(device->info().backend));
    const Scene native = parse(cloud, on(device::open_device("native"))).scene;
    ASSERT_GT(native.objects.size(), 3u);
    EXPECT_EQ(here.primitives.size(), native.primitives.size());
    EXPECT_EQ(here.objects.size(), native.objects.size());
    EXPECT_GE(share_equal(here.points.primitive, native.points.primitive), 0.999);
    EXPECT_GE(share_equal(here.points.object, native.points.object), 0.999);
    RecordProperty("bit_equal", hash_of(here) == hash_of(native) ? "yes" : "no");
}

TOPPLE_ON_EACH_BACKEND(SlowBackends);

}  // namespace
}  // namespace topple::test
