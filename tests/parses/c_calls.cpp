// SPDX-License-Identifier: MIT
#include "parses/c_calls.h"

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <vector>

#include "core/random.h"
#include "parses/random_scene.h"
#include "topple/topple.h"

namespace topple::parses {
namespace {

struct Broken {
    std::string what;
};

template <auto release>
struct Release {
    template <class T>
    void operator()(T* handle) const {
        release(handle);
    }
};
using Device = std::unique_ptr<topple_device, Release<topple_device_release>>;
using Result = std::unique_ptr<topple_result, Release<topple_result_release>>;
using Volume = std::unique_ptr<topple_volume, Release<topple_volume_release>>;

class Caller {
  public:
    explicit Caller(std::uint64_t seed) : random_(seed), scene_(random_scene(seed)) {
        topple_device* opened = nullptr;
        topple_status status;
        check("topple_device_open", topple_device_open("native", 1, &opened, &status), status);
        device_.reset(opened);
    }

    void call() {
        switch (random_.below(12)) {
            case 0:
                return parse();
            case 1:
                return get_scene();
            case 2:
                return get(topple_result_primitive, "topple_result_primitive");
            case 3:
                return get(topple_result_object, "topple_result_object");
            case 4:
                return get(topple_result_contact, "topple_result_contact");
            case 5:
                return get(topple_result_support, "topple_result_support");
            case 6:
                return arrays();
            case 7:
                return normals();
            case 8:
                return barriers();
            case 9:
                return supports();
            case 10:
                return volume();
            default:
                return convolve();
        }
    }

  private:
    bool chance(double share) { return random_.uniform() < share; }
    // Mostly sensible.
    double number(double low, double high) {
        constexpr std::array<double, 6> odd{
            0, -1, 1e300, -1e-300, INFINITY, std::numeric_limits<double>::quiet_NaN()};
        return chance(0.1) ? odd[random_.below(odd.size())] : random_.uniform(low, high);
    }

    void check(const char* function, int code, const topple_status& status) {
        const std::string at = std::string(function) + ": ";
        if (code < TOPPLE_OK || code >= TOPPLE_ERROR_INTERNAL)
            throw Broken{at + "code " + std::to_string(code) + ", " + status.message};
        if (status.code != code) throw Broken{at + "the status has another code"};
        const std::size_t length = ::strnlen(status.message, sizeof(status.message));
        if (length == sizeof(status.message)) throw Broken{at + "a message without an end"};
        if ((length == 0) != (code == TOPPLE_OK)) throw Broken{at + "a message that should not be"};
        for (std::size_t n = 0; n < length; ++n)
            if (static_cast<unsigned char>(status.message[n]) < 0x20)
                throw Broken{at + "a message of more than one line"};
    }

    topple_cloud cloud() {
        topple_cloud c;
        topple_cloud_init(&c, sizeof(c));
        const PointCloud& from = scene_.cloud;
        c.x = from.x.data();
        c.y = from.y.data();
        c.z = from.z.data();
        c.count = chance(0.1) ? random_.below(from.size() + 1) : from.size();
        if (!from.nx.empty()) {
            c.nx = from.nx.data();
            c.ny = from.ny.data();
            c.nz = chance(0.05) ? nullptr : from.nz.data();
        }
        if (chance(0.05)) c.y = nullptr;
        if (chance(0.05)) c.width = static_cast<std::uint32_t>(random_.bits());
        if (chance(0.05)) c.size = random_.below(2 * sizeof(c));
        return c;
    }

    void parse() {
        topple_options o;
        topple_options_init(&o, sizeof(o));
        o.device = device_.get();
        o.walks = 1 + static_cast<std::uint32_t>(random_.below(3));
        o.seed = random_.bits();
        o.disturbances = static_cast<std::uint32_t>(random_.below(chance(0.1) ? 20 : 8));
        if (chance(0.2)) o.voxel_m = number(0.02, 0.2);
        if (chance(0.2)) o.density_kg_m3 = number(1, 20000);
        if (chance(0.2)) o.friction = number(0.01, 2);
        if (chance(0.1)) o.up[random_.below(3)] = number(-1, 1);
        if (chance(0.2)) o.without_coordinates = 1;
        if (chance(0.1)) o.without_isolation = 1;
        if (chance(0.05)) o.size = random_.below(2 * sizeof(o));
        if (chance(0.1)) o.cancelled = [](void*) { return 1; };
        topple_result* parsed = nullptr;
        topple_status status;
        if (chance(0.1)) {
            const int code = topple_parse(chance(0.5) ? "/nowhere" : nullptr, &o, &parsed, &status);
            check("topple_parse", code, status);
        } else {
            const topple_cloud c = cloud();
            const int code = topple_parse_cloud(chance(0.02) ? nullptr : &c, &o,
                                                chance(0.02) ? nullptr : &parsed, &status);
            check("topple_parse_cloud", code, status);
        }
        if (parsed) result_.reset(parsed);
    }

    // A struct of the size that it says, between bytes that must stay.
    template <class Struct>
    struct Guarded {
        std::array<unsigned char, 64> before;
        Struct value;
        std::array<unsigned char, 64> after;
        explicit Guarded(std::size_t size) {
            before.fill(0xA5);
            std::memset(static_cast<void*>(&value), 0xA5, sizeof(value));
            after.fill(0xA5);
            value.size = size;
        }
        bool kept() const {
            const auto* bytes = reinterpret_cast<const unsigned char*>(&value);
            for (std::size_t n = std::max(value.size, sizeof(value.size)); n < sizeof(value); ++n)
                if (bytes[n] != 0xA5) return false;
            for (const auto* guard : {&before, &after})
                for (const unsigned char byte : *guard)
                    if (byte != 0xA5) return false;
            return true;
        }
    };
    template <class Struct>
    std::size_t size_of() {
        return chance(0.3) ? random_.below(sizeof(Struct) + 1) : sizeof(Struct);
    }

    void get_scene() {
        Guarded<topple_scene> to(size_of<topple_scene>());
        topple_status status;
        check("topple_result_scene",
              topple_result_scene(result_.get(), chance(0.05) ? nullptr : &to.value, &status),
              status);
        if (!to.kept()) throw Broken{"topple_result_scene: wrote beyond the struct's size"};
    }

    template <class Struct>
    void get(int (*function)(const topple_result*, std::uint64_t, Struct*, topple_status*),
             const char* name) {
        Guarded<Struct> to(size_of<Struct>());
        const std::uint64_t index = chance(0.1) ? random_.bits() : random_.below(8);
        topple_status status;
        check(name, function(result_.get(), index, chance(0.05) ? nullptr : &to.value, &status),
              status);
        if (!to.kept()) throw Broken{std::string(name) + ": wrote beyond the struct's size"};
    }

    void arrays() {
        if (!result_) return;
        topple_scene scene{};
        scene.size = sizeof(scene);
        topple_status status;
        check("topple_result_scene", topple_result_scene(result_.get(), &scene, &status), status);
        const std::int32_t* primitive = topple_result_point_primitives(result_.get());
        const std::int32_t* object = topple_result_point_objects(result_.get());
        for (std::uint64_t n = 0; n < scene.points; ++n) {
            if (primitive[n] < -1 || primitive[n] >= static_cast<std::int64_t>(scene.primitives) ||
                object[n] < -1 || object[n] >= static_cast<std::int64_t>(scene.objects))
                throw Broken{"a label is out of range"};
        }
        topple_result_point_normals(result_.get(), static_cast<int>(random_.below(5)) - 1);
        topple_result_point_index(result_.get());
        topple_result_note(result_.get(), random_.below(4));
        const topple_cloud c = cloud();
        check("topple_result_add_coordinates",
              topple_result_add_coordinates(result_.get(), &c, &status), status);
    }

    void normals() {
        const topple_cloud c = cloud();
        std::vector<float> out(3 * scene_.cloud.size());
        float* const nx = out.data();
        double spacing = 0;
        topple_status status;
        check("topple_point_spacing", topple_point_spacing(&c, &spacing, &status), status);
        check("topple_normals",
              topple_normals(chance(0.1) ? nullptr : device_.get(), &c, number(0.05, 0.3), nullptr,
                             nx, nx + scene_.cloud.size(), nx + 2 * scene_.cloud.size(), &status),
              status);
    }

    void barriers() {
        const std::uint64_t bodies = random_.below(4);
        std::vector<std::uint64_t> first{0};
        std::vector<double> points, mass, centre;
        for (std::uint64_t b = 0; b < bodies; ++b) {
            const std::uint64_t corners = random_.below(12);
            for (std::uint64_t n = 0; n < 3 * corners; ++n) points.push_back(number(-1, 1));
            first.push_back(first.back() + corners);
            mass.push_back(number(0.1, 10));
            for (int a = 0; a < 3; ++a) centre.push_back(number(-0.5, 0.5));
        }
        std::vector<double> barrier(bodies), release(bodies);
        topple_status status;
        check("topple_barriers",
              topple_barriers(device_.get(), points.data(), first.data(), bodies, mass.data(),
                              centre.data(), number(0.001, 0.1), barrier.data(), release.data(),
                              &status),
              status);
        if (status.code != TOPPLE_OK) return;
        for (std::uint64_t b = 0; b < bodies; ++b)
            if (barrier[b] < 0 || release[b] < 0) throw Broken{"a barrier is negative"};
    }

    void supports() {
        const std::uint64_t corners = random_.below(20), directions = 1 + random_.below(20);
        std::vector<float> values(3 * (corners + directions)), out(directions);
        for (float& v : values) v = static_cast<float>(number(-1, 1));
        topple_array vertices[3], along[3];
        for (std::size_t a = 0; a < 3; ++a) {
            vertices[a] = {values.data() + a * corners, corners, 0, 0};
            along[a] = {values.data() + 3 * corners + a * directions, directions, 0, 0};
        }
        const std::uint64_t first[2] = {0, chance(0.1) ? corners + 5 : corners};
        topple_array to{out.data(), chance(0.1) ? directions - 1 : directions, 0,
                        chance(0.05) ? random_.bits() : 0};
        topple_status status;
        check("topple_support_functions",
              topple_support_functions(device_.get(), vertices, first, 1, along, &to, &status),
              status);
    }

    void volume() {
        const topple_cloud c = cloud();
        std::vector<std::int32_t> label(scene_.cloud.size());
        for (std::int32_t& l : label) l = static_cast<std::int32_t>(random_.below(4)) - 1;
        topple_volume* made = nullptr;
        topple_status status;
        check("topple_volume_create",
              topple_volume_create(&c, label.data(), number(0.05, 0.2), &made, &status), status);
        const Volume held(made);
        if (!held) return;
        const topple_intrinsics camera{
            8, 6, number(4, 9), number(4, 9), number(2, 5), number(2, 4), number(500, 2000)};
        std::vector<std::uint16_t> depth(48);
        for (std::uint16_t& d : depth) d = static_cast<std::uint16_t>(random_.below(3000));
        std::vector<double> pose{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
        pose[random_.below(12)] = number(-1, 1);
        check("topple_volume_carve",
              topple_volume_carve(made, device_.get(), &camera, depth.data(), pose.data(),
                                  random_.below(2), &status),
              status);
        std::uint64_t filled = 0;
        check("topple_volume_fill",
              topple_volume_fill(made, device_.get(), static_cast<std::uint32_t>(random_.below(8)),
                                 nullptr, 0, chance(0.5) ? &filled : nullptr, &status),
              status);
        const auto index = [&] { return static_cast<std::int32_t>(random_.bits()); };
        const int state = topple_volume_state(made, index(), index(), index());
        if (state < 0 || state > 3) throw Broken{"no state of a voxel"};
    }

    void convolve() {
        const auto width = static_cast<std::uint32_t>(random_.below(9));
        const auto height = static_cast<std::uint32_t>(random_.below(9));
        const auto margin = static_cast<std::uint32_t>(random_.below(4));
        std::vector<float> primary((width + 2 * margin) * (height + 2 * margin)),
            density(width * height);
        for (float& v : primary) v = static_cast<float>(number(0, 1));
        std::vector<topple_footprint_entry> footprint(random_.below(5));
        for (auto& e : footprint)
            e = {static_cast<std::int32_t>(random_.below(7)) - 3,
                 static_cast<std::int32_t>(random_.below(7)) - 3, static_cast<float>(number(0, 1))};
        const std::uint32_t first[2] = {0, static_cast<std::uint32_t>(footprint.size())};
        const topple_array from{primary.data(), primary.size(), 0, 0},
            to{density.data(), density.size(), 0, 0};
        topple_status status;
        check("topple_convolve",
              topple_convolve(device_.get(), width, height, 1, margin, &from, footprint.data(),
                              first, &to, &status),
              status);
    }

    Random random_;
    RandomScene scene_;
    Device device_;
    Result result_;
};

}  // namespace

std::string try_calls(std::uint64_t seed) {
    try {
        Caller caller(seed);
        for (int n = 0; n < 40; ++n) caller.call();
    } catch (const Broken& broken) {
        return broken.what;
    }
    return {};
}

}  // namespace topple::parses
