// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <system_error>

#include "core/thread_pool.h"
#include "io/file_writer.h"
#include "io/replace_file.h"
#include "lab/rooms/building.h"
#include "lab/scan/room_scan.h"
#include "lab/solids/ground_truth.h"
#include "topple/error.h"

namespace topple::scenes {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

// One vertex of the .ply.
struct Vertex {
    float x, y, z;
    std::int32_t object;
};
static_assert(sizeof(Vertex) == 16 && std::endian::native == std::endian::little,
              "vertices are written as they lie in memory");

constexpr std::uint64_t block_points = 1'000'000;  // points that are in memory at a time
// In the head of a cloud, by which an earlier one is known.
constexpr const char* building_mark = "property int truth_object";
constexpr std::uint64_t noise_stream = 5ULL << 40;

Vec3 shifted(const Vec3& origin, const Vec3& p) {
    return {origin[0] + p[0], origin[1] + p[1], origin[2] + p[2]};
}

json shifted_json(const Vec3& origin, Part part) {
    part.center = shifted(origin, part.center);
    return part_json(part);
}

// The truth, an element of its two lists at a time.
class TruthWriter {
  public:
    TruthWriter(io::FileWriter& out, const Building& building) : out_(out) {
        const BuildingOptions& o = building.options();
        json head{{"seed", o.seed},
                  {"points", o.points},
                  {"noise", o.noise_m},
                  {"furniture", o.varied ? "varied" : "plain"},
                  {"storeys", building.storeys()}};
        const std::string text = head.dump();
        out_.write(text.substr(0, text.size() - 1) + ",\n\"rooms\":[");
    }

    void room(const Building::Room& room, std::uint64_t first_object) {
        json doors = json::array(), stations = json::array(), parts = json::array();
        for (const Building::Door& door : room.doors) {
            doors.push_back({{"to", door.to},
                             {"low", shifted(room.origin, door.opening[0])},
                             {"high", shifted(room.origin, door.opening[1])}});
        }
        for (const Vec3& station : room.stations) stations.push_back(shifted(room.origin, station));
        for (const Part& part : room.world.parts) {
            if (part.object == 0) parts.push_back(shifted_json(room.origin, part));
        }
        element({{"id", room.id},
                 {"storey", room.storey},
                 {"origin", room.origin},
                 {"size", room.world.room},
                 {"first_object", first_object},
                 {"objects", room.world.objects.size() - 1},
                 {"doors", doors},
                 {"stations", stations},
                 {"parts", parts}});
    }

    void end_rooms(double spacing_m) {
        out_.write("\n],\n\"spacing\":" + json(spacing_m).dump() + ",\n\"objects\":[");
        first_ = true;
        element({{"id", 0}, {"name", "building"}, {"where", "building"}, {"room", -1}});
    }

    // `points`: how many there are on each object of the room's world.
    void objects(const Building::Room& room, std::uint64_t first_object,
                 const std::vector<std::uint64_t>& points) {
        const World& world = room.world;
        std::vector<std::set<std::uint64_t>> rests(world.objects.size()), fixed(rests.size());
        const auto object_of = [&](std::int32_t part) {
            return static_cast<std::size_t>(world.parts[part].object);
        };
        const auto id = [&](std::size_t object) {
            return object == 0 ? 0 : first_object + object - 1;
        };
        for (const auto& [below, above] : world.support)
            rests[object_of(above)].insert(id(object_of(below)));
        for (const auto& [a, b] : world.fixed) {
            const std::size_t p = object_of(a), q = object_of(b);
            if (p != q) fixed[std::max(p, q)].insert(id(std::min(p, q)));
        }
        for (std::size_t k = 1; k < world.objects.size(); ++k) {
            json parts = json::array();
            double volume = 0;
            Bounds bounds = no_bounds();
            for (const Part& part : world.parts) {
                if (static_cast<std::size_t>(part.object) != k) continue;
                extend(bounds, part.bounds());
                volume += part.volume();
                parts.push_back(shifted_json(room.origin, part));
            }
            element({{"id", id(k)},
                     {"name", world.objects[k].name},
                     {"where", world.objects[k].where},
                     {"room", room.id},
                     {"points", points[k]},
                     {"bounds", {shifted(room.origin, bounds[0]), shifted(room.origin, bounds[1])}},
                     {"volume", volume},
                     {"rests_on", rests[k]},
                     {"fixed_to", fixed[k]},
                     {"parts", parts}});
        }
    }

    void end() { out_.write("\n]}\n"); }

  private:
    void element(const json& value) {
        out_.write((first_ ? "\n" : ",\n") + value.dump());
        first_ = false;
    }

    io::FileWriter& out_;
    bool first_ = true;
};

// The points of all rooms, so many per area that they come to the right number in the end.
class CloudWriter {
  public:
    CloudWriter(io::FileWriter& out, const BuildingOptions& options, double area_m2)
        : out_(out), options_(options), area_m2_(area_m2) {
        out_.write("ply\nformat binary_little_endian 1.0\ncomment metres\nelement vertex " +
                   std::to_string(options.points) +
                   "\nproperty float x\nproperty float y\nproperty float z\n" + building_mark +
                   "\nend_header\n");
    }

    // How many points there are on each object. `before` and `after`: the area of the rooms before
    // this one, without and with its own.
    std::vector<std::uint64_t> room(const Building::Room& room, const RoomScan& scan,
                                    std::uint64_t first_object, double before, double after) {
        std::vector<std::uint64_t> points(room.world.objects.size(), 0);
        const std::uint64_t end = points_up_to(after);
        double sum = 0;
        for (std::size_t patch = 0; patch < scan.patches();) {
            first_patch_ = patch;
            starts_.assign(1, 0);
            while (patch < scan.patches() && starts_.back() < block_points) {
                sum += scan.area(patch);
                const bool last = patch + 1 == scan.patches();
                const std::uint64_t up_to = last ? end : std::min(end, points_up_to(before + sum));
                starts_.push_back(starts_.back() + up_to - written_);
                const auto object = static_cast<std::size_t>(scan.object(patch));
                points[object] += up_to - written_;
                written_ = up_to;
                ++patch;
            }
            write_block(room, scan, first_object);
        }
        return points;
    }

  private:
    std::uint64_t points_up_to(double area) const {
        return static_cast<std::uint64_t>(static_cast<double>(options_.points) * (area / area_m2_));
    }

    void write_block(const Building::Room& room, const RoomScan& scan, std::uint64_t first_object) {
        vertices_.resize(starts_.back());
        ThreadPool(options_.threads).each(starts_.size() - 1, 64, [&](std::size_t n) {
            const std::size_t patch = first_patch_ + n;
            std::vector<Vec3> places(starts_[n + 1] - starts_[n]);
            if (places.empty()) return;
            scan.sample(patch, options_.noise_m,
                        Random(options_.seed, noise_stream + (room.id << 32) + patch), places);
            const std::int32_t object = scan.object(patch);
            const auto id = object == 0 ? 0 : static_cast<std::int32_t>(first_object) + object - 1;
            for (std::size_t k = 0; k < places.size(); ++k) {
                const Vec3 p = shifted(room.origin, places[k]);
                vertices_[starts_[n] + k] = {static_cast<float>(p[0]), static_cast<float>(p[1]),
                                             static_cast<float>(p[2]), id};
            }
        });
        out_.write(vertices_.data(), vertices_.size() * sizeof(Vertex));
    }

    io::FileWriter& out_;
    const BuildingOptions& options_;
    double area_m2_;
    std::uint64_t written_ = 0;
    std::size_t first_patch_ = 0;
    std::vector<std::uint64_t> starts_;  // of the block's patches among its points, and their end
    std::vector<Vertex> vertices_;
};

double area_of(const RoomScan& scan) {
    double sum = 0;
    for (std::size_t k = 0; k < scan.patches(); ++k) sum += scan.area(k);
    return sum;
}

}  // namespace

fs::path truth_of(const fs::path& cloud) {
    return fs::path(cloud).replace_extension(".truth.json");
}

BuildingSummary write_building(const fs::path& cloud, const BuildingOptions& options,
                               const std::function<bool(std::size_t, std::size_t)>& keep_going) {
    const Building building(options);
    io::check_own_file(cloud, building_mark, "is no building of topple; choose another name");
    io::PendingFile points(cloud), truth(truth_of(cloud));
    io::FileWriter points_file(points.path()), truth_file(truth.path());
    TruthWriter truth_out(truth_file, building);

    // How much there is to see, before the first point is written: each takes its share of it.
    std::vector<double> up_to{0};  // area of the rooms before this one
    std::vector<std::uint64_t> first_object{1};
    const auto scan_of = [&](const Building::Room& room) {
        return RoomScan(room.world, room.stations, options.threads);
    };
    for (std::size_t k = 0; k < building.rooms(); ++k) {
        if (!keep_going(k, 2 * building.rooms())) return {};
        const Building::Room room = building.room(k);
        up_to.push_back(up_to.back() + area_of(scan_of(room)));
        truth_out.room(room, first_object.back());
        first_object.push_back(first_object.back() + room.world.objects.size() - 1);
    }
    const double spacing = std::sqrt(up_to.back() / static_cast<double>(options.points));
    truth_out.end_rooms(spacing);

    CloudWriter cloud_out(points_file, options, up_to.back());
    for (std::size_t k = 0; k < building.rooms(); ++k) {
        if (!keep_going(building.rooms() + k, 2 * building.rooms())) return {};
        const Building::Room room = building.room(k);
        const RoomScan scan = scan_of(room);
        const auto counts = cloud_out.room(room, scan, first_object[k], up_to[k], up_to[k + 1]);
        truth_out.objects(room, first_object[k], counts);
    }
    truth_out.end();
    points_file.close();
    truth_file.close();
    truth.commit();
    points.commit();
    return {building.rooms(), building.storeys(), first_object.back(), spacing};
}

}  // namespace topple::scenes
