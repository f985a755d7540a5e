// SPDX-License-Identifier: MIT
#include "parses/c_calls.h"

#include <thread>

#include "lab/temporary_folder.h"
#include "parses/c_stage_calls.h"

namespace topple::parses {
namespace {

// Parses, and what is asked of their results.
class Caller : public Arguments {
  public:
    explicit Caller(std::uint64_t seed) : Arguments(seed), stages_(seed + 1) {}

    void call() {
        using Call = void (Caller::*)();
        // Each as often as it stands here.
        static constexpr Call calls[] = {
            &Caller::parse,       &Caller::get_scene,   &Caller::get_items, &Caller::get_items,
            &Caller::get_items,   &Caller::risks,       &Caller::numbers,   &Caller::arrays,
            &Caller::stays,       &Caller::label,       &Caller::write,     &Caller::handles,
            &Caller::two_threads, &Caller::one_stage,   &Caller::one_stage, &Caller::one_stage,
            &Caller::one_stage,   &Caller::coordinates, &Caller::one_stage,
        };
        (this->*calls[random_.below(std::size(calls))])();
    }

  private:
    const topple_result* result() { return or_null(result_.get(), 0.02); }

    void parse() {
        topple_options o{};
        topple_options_init(&o, chance(0.05) ? random_.below(sizeof(o) + 1) : sizeof(o));
        o.size = sizeof(o);
        o.device = device_.get();  // NULL: the best, which takes long to be found
        o.walks = 1 + static_cast<std::uint32_t>(random_.below(3));
        o.seed = random_.bits();
        o.disturbances = static_cast<std::uint32_t>(random_.below(chance(0.1) ? 20 : 8));
        for (double* value : {&o.unit_m, &o.tolerable_J, &o.wind_m_s, &o.wind_from_deg, &o.pga_m_s2,
                              &o.contents_kg_m3, &o.floor_amplification, &o.grouping_time_s})
            if (chance(0.05)) *value = number(0.01, 20);
        if (chance(0.2)) o.voxel_m = number(0.02, 0.2);
        if (chance(0.2)) o.density_kg_m3 = number(1, 20000);
        if (chance(0.2)) o.friction = number(0.01, 2);
        if (chance(0.1)) o.up[random_.below(3)] = number(-1, 1);
        if (chance(0.1)) o.max_memory_bytes = random_.bits() >> random_.below(60);
        if (chance(0.2)) o.without_coordinates = any_int();
        if (chance(0.1)) o.without_isolation = any_int();
        const double rising[] = {0.1, number(0.2, 0.3), 0.5}, falling[] = {0.1, 0.01, 0.001};
        if (chance(0.1)) {
            o.hazard_pga_g = or_null(rising);
            o.hazard_per_year = or_null(falling);
            o.hazard_points = chance(0.1) ? huge_count() : random_.below(4);
        }
        if (chance(0.1))
            o.corrections_json = R"({"corrections": [{"do": "fixed", "at_m": [[0, 0, 0]]}]})";
        if (chance(0.05)) o.corrections_json = "[";
        if (chance(0.03)) o.corrections_file = "/nowhere";
        if (chance(0.03)) o.cache_file = "/nowhere/cache";
        if (chance(0.05)) o.size = random_.below(2 * sizeof(o));
        if (chance(0.1)) o.cancelled = [](void*) { return 1; };
        if (chance(0.1)) o.log = [](int, const char*, void*) {};
        if (chance(0.1)) o.progress = [](const char*, double, void*) {};
        const topple_allocator allocator{
            [](std::size_t bytes, std::size_t alignment, void*) {
                return std::aligned_alloc(alignment,
                                          (bytes + alignment - 1) / alignment * alignment);
            },
            [](void* memory, std::size_t, void*) { std::free(memory); }, nullptr};
        const topple_allocator empty{
            [](std::size_t, std::size_t, void*) -> void* { return nullptr; }, allocator.release,
            nullptr};
        if (chance(0.1)) o.allocator = chance(0.3) ? &empty : &allocator;
        topple_result* parsed = nullptr;
        topple_result** to = or_null(&parsed, 0.02);
        const topple_options* options = or_null(&o, 0.01);
        if (options == nullptr) return;  // it would take the best device, and 500 walks
        if (chance(0.1)) {
            check("topple_parse",
                  topple_parse(or_null("/nowhere", 0.5), options, to, status_or_null()));
        } else if (chance(0.2)) {
            const topple_frames f = frames();
            check("topple_parse_frames",
                  topple_parse_frames(or_null(&f), options, to, status_or_null()));
        } else {
            const topple_cloud c = cloud();
            check("topple_parse_cloud",
                  topple_parse_cloud(or_null(&c), options, to, status_or_null()));
        }
        if (parsed) result_.reset(parsed);
    }

    template <class Struct>
    std::size_t size_of() {
        return chance(0.3) ? random_.below(sizeof(Struct) + 1) : sizeof(Struct);
    }

    void get_scene() {
        Guarded<topple_scene> to(size_of<topple_scene>());
        check("topple_result_scene",
              topple_result_scene(result(), or_null(&to.value), status_or_null()));
        if (!to.kept()) throw Broken{"topple_result_scene: wrote beyond the struct's size"};
    }

    template <class Struct>
    void get(int (*function)(const topple_result*, std::uint64_t, Struct*, topple_status*),
             const char* name) {
        Guarded<Struct> to(size_of<Struct>());
        check(name, function(result(), index(), or_null(&to.value), status_or_null()));
        if (!to.kept()) throw Broken{std::string(name) + ": wrote beyond the struct's size"};
    }

    void get_items() {
        switch (random_.below(5)) {
            case 0:
                return get(topple_result_primitive, "topple_result_primitive");
            case 1:
                return get(topple_result_object, "topple_result_object");
            case 2:
                return get(topple_result_contact, "topple_result_contact");
            case 3:
                return get(topple_result_support, "topple_result_support");
            default:
                return get(topple_result_correction, "topple_result_correction");
        }
    }

    void risks() {
        const char* name = chance(0.1) ? or_null("storm", 0.5)
                                       : topple_disturbance_name(static_cast<std::uint32_t>(
                                             chance(0.05) ? random_.bits() : random_.below(4)));
        double a = 0, b = 0;
        check("topple_result_risk", topple_result_risk(result(), index(), name, or_null(&a),
                                                       or_null(&b), status_or_null()));
        check("topple_result_risk_error",
              topple_result_risk_error(result(), index(), name, or_null(&a), or_null(&b),
                                       status_or_null()));
    }

    void numbers() {
        const char* const names[] = {"object", "support", "scene", "body", nullptr};
        const char* const fields[] = {
            "id", "fall.lands_m", "barrier_by_direction.blow_J", "up", "fall.", ".", nullptr};
        std::array<double, 4> values{};
        std::uint64_t count = 0;
        check("topple_result_numbers",
              topple_result_numbers(result(), names[random_.below(5)], index(),
                                    fields[random_.below(7)], or_null(values.data()),
                                    random_.below(5), or_null(&count), status_or_null()));
    }

    void stays() {
        const double place[] = {number(-1, 1), number(-1, 1), number(0, 1)};
        const double way[] = {number(-1, 1), number(-1, 1), number(-1, 1)};
        int stays = 7;
        int* const to = or_null(&stays);
        check(
            "topple_result_stays",
            topple_result_stays(result(), index(), or_null(place), or_null(way, 0.3), number(0, 50),
                                number(0, 5), number(0, 0.1), to, status_or_null()));
        if (to && stays != 0 && stays != 1) throw Broken{"topple_result_stays: neither 0 nor 1"};
    }

    void arrays() {
        topple_result_note(result(), index());
        topple_result_point_normals(
            result(), chance(0.1) ? any_int() : static_cast<int>(random_.below(5)) - 1);
        topple_result_point_index(result());
        if (result_) check_labels();
    }
    void check_labels() {
        topple_scene scene{};
        scene.size = sizeof(scene);
        check("topple_result_scene", topple_result_scene(result_.get(), &scene, &status_));
        const std::int32_t* primitive = topple_result_point_primitives(result_.get());
        const std::int32_t* object = topple_result_point_objects(result_.get());
        for (std::uint64_t n = 0; n < scene.points; ++n) {
            if (primitive[n] < -1 || primitive[n] >= static_cast<std::int64_t>(scene.primitives) ||
                object[n] < -1 || object[n] >= static_cast<std::int64_t>(scene.objects))
                throw Broken{"a label is out of range"};
        }
    }

    void coordinates() {
        const topple_cloud c = cloud();
        check("topple_result_add_coordinates",
              topple_result_add_coordinates(or_null(result_.get(), 0.02), or_null(&c),
                                            status_or_null()));
    }

    void label() {
        topple_labeller* made = nullptr;
        check("topple_labeller_create",
              topple_labeller_create(result(), or_null(&made, 0.02), status_or_null()));
        const Labeller held(made);
        const topple_frames f = frames();
        std::vector<std::int32_t> primitives(16 * 12), objects(16 * 12);
        check("topple_labeller_label",
              topple_labeller_label(or_null(held.get()), or_null(&f), index(),
                                    or_null(primitives.data(), 0.1), or_null(objects.data(), 0.1),
                                    status_or_null()));
    }

    // Files take long.
    void write() {
        if (!chance(0.2)) return;
        static const scenes::TemporaryFolder folder("topple_c_calls");
        const std::string out = (folder.path() / "out").string();
        const char* to = chance(0.2) ? or_null("/nowhere/out", 0.3) : out.c_str();
        if (chance(0.5)) {
            std::filesystem::remove_all(folder.path() / "out");
            const auto what =
                static_cast<std::uint32_t>(chance(0.1) ? random_.bits() : 2 * random_.below(4));
            check("topple_result_write",
                  topple_result_write(result(), to, what & ~1U, status_or_null()));
            return;
        }
        constexpr const char* formats[] = {"mjcf", "urdf", "sdf", "usd", "obj", ""};
        check("topple_result_export",
              topple_result_export(result(), or_null(formats[random_.below(6)]), to,
                                   status_or_null()));
        std::filesystem::remove_all(folder.path() / "out");
    }

    // What lives on when what it was made with does not.
    void handles() {
        if (chance(0.5)) device_ = open_native();
        if (chance(0.1)) result_.reset();
        topple_device* none = nullptr;
        check("topple_device_open",
              topple_device_open(chance(0.5) ? "cuda" : "", random_.below(2) ? 0U : ~0U,
                                 or_null(&none, 0.3), status_or_null()));
        check("topple_device_adopt_opencl",
              topple_device_adopt_opencl(nullptr, nullptr, nullptr, or_null(&none),
                                         status_or_null()));
        check("topple_device_adopt_vulkan",
              topple_device_adopt_vulkan(nullptr, nullptr, nullptr, nullptr,
                                         static_cast<std::uint32_t>(random_.bits()), or_null(&none),
                                         status_or_null()));
        if (none) throw Broken{"a device was made of nothing"};
        if (!topple_device_name(device()) || !topple_device_backend(device()) ||
            !topple_version() || topple_version_number() == 0)
            throw Broken{"a text that must be there is NULL"};
        // Drivers take long to be tried; without room for the list they are not.
        std::uint64_t count = 0;
        check("topple_list_devices", topple_list_devices(nullptr, 1 + random_.bits() / 2,
                                                         or_null(&count), status_or_null()));
        topple_device_release(nullptr);
        topple_result_release(nullptr);
        topple_volume_release(nullptr);
        topple_labeller_release(nullptr);
        topple_cloud_init(nullptr, 8);
        topple_frame_init(nullptr, 8);
        topple_frames_init(nullptr, 8);
        topple_options_init(nullptr, 8);
    }

    void one_stage() { stages_.call(); }

    // One result is read from two threads, and each has a device of its own.
    void two_threads() {
        std::string wrong;
        std::thread other([&] {
            try {
                for (int n = 0; n < 2; ++n) stages_.call();
                topple_scene scene{};
                scene.size = sizeof(scene);
                topple_result_scene(result_.get(), &scene, nullptr);
            } catch (const Broken& broken) {
                wrong = broken.what;
            }
        });
        try {
            get_items();
            stays();
            label();
        } catch (const Broken& broken) {
            other.join();
            throw;
        }
        other.join();
        if (!wrong.empty()) throw Broken{wrong};
    }

    StageCaller stages_;
    Result result_;
};

}  // namespace

std::string try_calls(std::uint64_t seed) {
    try {
        Caller caller(seed);
        for (int n = 0; n < calls_of_a_seed; ++n) caller.call();
    } catch (const Broken& broken) {
        return broken.what;
    }
    return {};
}

}  // namespace topple::parses
