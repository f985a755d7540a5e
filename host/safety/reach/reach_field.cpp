// SPDX-License-Identifier: MIT
#include "safety/reach/reach_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <map>
#include <numbers>

#include "core/cell_columns.h"
#include "core/thread_pool.h"
#include "physics/directions.h"
#include "physics/landscape.h"
#include "safety/columns.h"
#include "safety/human/walkable_map.h"
#include "safety/objects.h"
#include "safety/reach/hand_load.h"

namespace topple::safety {
namespace {

constexpr double lean_height_m = 0.6;    // above the floor
constexpr double climbing_step_m = 0.3;  // above the floor: who climbs begins lower; set by hand
// The scope of ASTM F2057-23: 27 in and 30 lb.
constexpr double least_climbed_m = 0.686, least_climbed_kg = 13.6;
constexpr std::size_t most_places = 50000;  // of a kind; of more every second of a row, and so on
constexpr std::uint64_t places_at_once = 1024;

// What the level lines from a place in one direction meet first of an object: its cells, ascending.
struct Met {
    std::int32_t object = 0;
    unsigned direction = 0;
    std::vector<std::uint32_t> cells;
};

// A hold that someone of a kind may take.
struct Grip {
    enum class Act : std::uint8_t { pull, lean, climb, open, fall };
    std::size_t kind = 0;
    Act act = Act::pull;
    unsigned direction = 0;  // from who takes it
    std::int32_t layer = 0;  // of cells, at which it is taken
    std::int32_t floor = 0;  // the layer from the bottom of which on heights count, of who falls
    auto operator<=>(const Grip&) const = default;
};
using Grips = std::map<Grip, double>;  // how often, per hold

// The solids that hands meet.
struct Solids {
    const SolidCells& cells;
    std::vector<std::int32_t> object;  // of each cell; -1: none that moves
    Columns columns;
    CellColumns by_column;

    Solids(const Surroundings& surroundings, std::span<const RiskObject> objects)
        : cells(*surroundings.cells),
          object(movable_object_of_cells(surroundings, objects)),
          columns(cells),
          by_column(cells) {}

    std::int32_t layer_of(double height_m) const {
        return static_cast<std::int32_t>(std::floor(height_m / cells.voxel_m));
    }
    double height_m(std::int32_t layer) const { return (layer + 0.5) * cells.voxel_m; }

    // Lines from (x, y), metres, at the layers from `low` on, which are `open`, as long as an arm.
    void meet(double x, double y, std::int32_t low, std::vector<bool> open, double arm_m,
              unsigned towards, std::vector<Met>& out) const {
        const auto [dx, dy] = direction(towards);
        const auto layers = static_cast<std::int32_t>(open.size());
        std::map<std::int32_t, std::vector<std::uint32_t>> met;
        std::int32_t last_i = 0, last_j = 0;
        bool first = true;
        for (double s = 0; s <= arm_m; s += cells.voxel_m / 2) {
            const std::int32_t i = layer_of(x + s * dx), j = layer_of(y + s * dy);
            if (!first && i == last_i && j == last_j) continue;
            first = false;
            last_i = i;
            last_j = j;
            bool any = false;
            for (std::int32_t l = 0; l < layers && !any; l += 64)
                any = columns.solid(i, j, std::int64_t{low} + l) != 0;
            if (!any) continue;
            const auto [from, to] = by_column.at(i, j);
            for (std::size_t c = from; c < to; ++c) {
                const std::int64_t l = std::int64_t{cells.k[c]} - low;
                if (l < 0 || l >= layers || !open[static_cast<std::size_t>(l)]) continue;
                open[static_cast<std::size_t>(l)] = false;
                if (object[c] >= 0) met[object[c]].push_back(static_cast<std::uint32_t>(c));
            }
        }
        for (auto& [id, of_object] : met) {
            std::ranges::sort(of_object);
            out.push_back({id, towards, std::move(of_object)});
        }
    }
};

// Where someone may stand.
struct Stand {
    double x = 0, y = 0, floor_m = 0;
};
std::vector<Stand> standing_places(const WalkableMap& map) {
    std::int64_t every = 1;
    const auto size = static_cast<std::int64_t>(map.walkable.size());
    while (size / (every * every) > static_cast<std::int64_t>(most_places)) ++every;
    std::vector<Stand> out;
    for (const std::uint32_t c : map.walkable) {
        const Place at = map.place(c);
        if (at.x % every != 0 || at.y % every != 0) continue;
        const auto [x, y] = map.center(at);
        out.push_back({x, y, double{map.floor_m[c]}});
    }
    return out;
}

// All that people do from where they stand.
class Reaching {
  public:
    Reaching(device::Device& device, const Surroundings& surroundings,
             std::span<const RiskObject> objects, std::span<const PersonKind* const> kinds)
        : device_(device),
          surroundings_(surroundings),
          objects_(objects),
          kinds_(kinds),
          solids_(surroundings, objects),
          cells_(cells_of_objects(solids_.object, objects.size())),
          grips_(objects.size()) {
        for (std::size_t o = 0; o < objects.size(); ++o)
            stances_.push_back(stance(surroundings, cells_[o], objects[o]));
    }

    Disturbance disturbance() {
        Disturbance out;
        out.name = reach_kind().name;
        out.draws = 0;
        std::size_t able = 0;
        std::vector<Counted> counted;
        for (std::size_t kind = 0; kind < kinds_.size(); ++kind) {
            counted.push_back(count(kind));
            able += counted.back().places > 0;
            out.draws += counted.back().places;
        }
        out.draws = std::max<std::size_t>(out.draws, 1);
        out.work.resize(objects_.size());
        out.response.resize(objects_.size());
        out.strongest.resize(objects_.size());
        out.holds.resize(objects_.size());
        out.exposure.assign(solids_.object.size(), 0.0f);
        for (const Counted& of_kind : counted) {
            if (of_kind.places == 0) continue;
            const double per_place = 1.0 / static_cast<double>(of_kind.places * able);
            for (std::size_t o = 0; o < objects_.size(); ++o)
                for (const auto& [grip, times] : of_kind.grips[o])
                    grips_[o][grip] += times * per_place;
            for (std::size_t c = 0; c < out.exposure.size(); ++c)
                out.exposure[c] += static_cast<float>(of_kind.cells[c] * per_place);
        }
        for (std::size_t o = 0; o < objects_.size(); ++o) take_holds(o, out);
        out.samples = arrows(out.exposure);
        if (able == 0 && !std::ranges::all_of(objects_, &RiskObject::grounded))
            out.notes.push_back("Nobody of those who reach for things gets at any from the floor.");
        return out;
    }

  private:
    // Per place of one kind, summed over its places.
    struct Counted {
        std::size_t places = 0;    // from which a thing is in reach
        std::vector<Grips> grips;  // by object
        std::vector<double> cells;
    };

    std::vector<Met> met_from(const Stand& at, const PersonKind& kind) const {
        const std::int32_t low = solids_.layer_of(at.floor_m + kind.reach_low_m + 1e-9),
                           high = solids_.layer_of(at.floor_m + kind.reach_high_m - 1e-9);
        std::vector<Met> out;
        for (unsigned d = 0; d < direction_count; ++d)
            solids_.meet(at.x, at.y, low,
                         std::vector<bool>(static_cast<std::size_t>(high - low + 1), true),
                         kind.arm_m, d, out);
        return out;
    }

    Counted count(std::size_t kind_number) {
        const PersonKind& kind = *kinds_[kind_number];
        const WalkableMap map = walkable_map(surroundings_, walker(kind));
        const std::vector<Stand> all = standing_places(map);
        Counted out;
        out.grips.resize(objects_.size());
        out.cells.assign(solids_.object.size(), 0.0);
        // In batches: what a batch meets is kept, and added in the places' order.
        std::vector<std::vector<Met>> met(places_at_once);
        for (std::uint64_t first = 0; first < all.size(); first += places_at_once) {
            const std::uint64_t number =
                std::min<std::uint64_t>(places_at_once, all.size() - first);
            device_.threads().each(number, 16,
                                   [&](std::size_t n) { met[n] = met_from(all[first + n], kind); });
            for (std::uint64_t n = 0; n < number; ++n)
                add(kind_number, all[first + n], met[n], out);
        }
        return out;
    }

    // One of the objects, then one of the directions in which it is met, then one of the acts.
    void add(std::size_t kind_number, const Stand& at, const std::vector<Met>& met, Counted& out) {
        if (met.empty()) return;
        const PersonKind& kind = *kinds_[kind_number];
        ++out.places;
        std::map<std::int32_t, double> directions;  // of each object
        for (const Met& m : met) directions[m.object] += 1;
        for (const Met& m : met) {
            const auto o = static_cast<std::size_t>(m.object);
            const double share =
                1 / (static_cast<double>(directions.size()) * directions[m.object]);
            for (const std::uint32_t c : m.cells) out.cells[c] += share;
            const SolidCells& cells = solids_.cells;
            const auto [low, high] =
                std::ranges::minmax(m.cells, {}, [&](std::uint32_t c) { return cells.k[c]; });
            const bool stands = is_furniture(o, at.floor_m);
            const std::int32_t shoulder = solids_.layer_of(at.floor_m + kind.shoulder_m);
            const double opens = stands ? opened(o, m.direction) : 0;
            const double falls = cells.k[low] <= shoulder ? kind.falls : 0;
            const std::int32_t leaned = std::clamp(solids_.layer_of(at.floor_m + lean_height_m),
                                                   cells.k[low], cells.k[high]);
            using enum Grip::Act;
            const std::array<std::pair<Grip, double>, 5> acts{{
                {{kind_number, pull, m.direction, cells.k[high]}, 1},
                {{kind_number, lean, m.direction, leaned}, 1},
                {{kind_number, climb, m.direction}, kind.climbs && stands ? 1.0 : 0.0},
                {{kind_number, open, m.direction}, opens},
                {{kind_number, fall, m.direction, std::min(cells.k[high], shoulder),
                  solids_.layer_of(at.floor_m + 1e-9)},
                 falls},
            }};
            double all = 0;
            for (const auto& [grip, times] : acts) all += times;
            for (const auto& [grip, times] : acts)
                if (times > 0) out.grips[o][grip] += share * times / all;
        }
    }

    // Who takes hold of it from that way stands before its drawers: how likely it has any.
    double opened(std::size_t o, unsigned from) const {
        const physics::Drawers& drawers = objects_[o].drawers;
        const auto [dx, dy] = direction(from);
        const double before = -(dx * drawers.way[0] + dy * drawers.way[1]);
        return before >= std::numbers::sqrt2 / 2 ? drawers.probability : 0;
    }

    bool is_furniture(std::size_t o, double floor_m) const {
        const MassSpread& stands = stances_[o];
        return objects_[o].mass_kg >= least_climbed_kg &&
               stands.bottom_m - floor_m <= climbing_step_m &&
               stands.top_m - stands.bottom_m >= least_climbed_m;
    }

    // How far its cells stand out before its centre of mass.
    double front_m(std::size_t o, double dx, double dy) const {
        const SolidCells& cells = solids_.cells;
        double most = 0;
        for (const std::uint32_t c : cells_[o])
            most = std::max(most,
                            ((cells.i[c] + 0.5) * cells.voxel_m - stances_[o].center[0]) * dx +
                                ((cells.j[c] + 0.5) * cells.voxel_m - stances_[o].center[1]) * dy);
        return most + (std::fabs(dx) + std::fabs(dy)) / 2 * cells.voxel_m;
    }

    HandLoad load_of(std::size_t o, const Grip& grip) const {
        const PersonKind& kind = *kinds_[grip.kind];
        const bool away = grip.act == Grip::Act::lean || grip.act == Grip::Act::fall;
        const physics::Drawers& drawers = objects_[o].drawers;
        auto [dx, dy] = direction(grip.direction);
        if (!away) {
            dx = 0.0 - dx;
            dy = 0.0 - dy;
        }
        if (grip.act == Grip::Act::open) {
            dx = drawers.way[0];
            dy = drawers.way[1];
        }
        HandLoad out;
        out.way = {dx, dy, 0};
        out.arm_m = kind.arm_m;
        out.half_base_m = half_base(objects_[o], stances_[o], dx, dy);
        if (grip.act == Grip::Act::climb || grip.act == Grip::Act::open) {
            out.height_m = stances_[o].top_m - stances_[o].bottom_m;
            const double front = std::max(0.0, front_m(o, dx, dy) - out.half_base_m);
            const double drawn = grip.act == Grip::Act::open ? drawers.out_m : 0;
            if (kind.climbs) {
                out.weight_N = kind.mass_kg * physics::gravity;
                out.climber_Nm = climber_moment_Nm(kind.mass_kg, front + drawn);
            }
            if (drawn > 0) {
                const double weight = drawers.mass_share * objects_[o].mass_kg * physics::gravity;
                if (!kind.climbs) out.weight_N = weight;
                out.climber_Nm += weight * drawn;
            }
            return out;
        }
        out.height_m = std::max(0.0, solids_.height_m(grip.layer) - stances_[o].bottom_m);
        if (grip.act == Grip::Act::fall) {
            // From the middle of what is in reach.
            const Fall fall =
                fall_against(kind.height_m, kind.mass_kg, kind.walking_speed_m_s,
                             solids_.height_m(grip.layer - grip.floor), kind.arm_m / 2);
            out.struck_kg = fall.mass_kg;
            out.struck_m_s = fall.speed_m_s;
        } else {
            out.force_N = away ? kind.push_N : kind.pull_N;
        }
        return out;
    }

    void take_holds(std::size_t o, Disturbance& out) const {
        std::vector<std::pair<HandLoad, double>> loads;
        for (const auto& [grip, probability] : grips_[o]) {
            loads.emplace_back(load_of(o, grip), probability);
            const HandLoad& load = loads.back().first;
            const double force =
                load.climber_Nm > 0 ? load.climber_Nm / load.height_m : load.force_N;
            Push& most = out.strongest[o];
            if (force * load.height_m > most.force_N * most.height_m) most = {force, load.height_m};
        }
        if (loads.empty()) return;
        out.response[o] = [loads](const RiskObject& object) {
            std::vector<WorkSample> work;
            for (auto [load, probability] : loads) {
                load.half_base_m = std::max(0.0, load.half_base_m + object.border_shift_m);
                work.push_back({hand_work_J(object, load), probability, load.way});
                if (load.struck_kg > 0) work.back().height_m = load.height_m;
            }
            return work;
        };
        out.work[o] = out.response[o](objects_[o]);
        out.holds[o] = told(o, loads, out.work[o]);
    }

    // By kind and act, in their order.
    std::vector<Hold> told(std::size_t o, std::span<const std::pair<HandLoad, double>> loads,
                           std::span<const WorkSample> work) const {
        static constexpr std::array acts{"pull", "lean", "climb", "open", "fall"};
        std::vector<Hold> out;
        std::pair<double, double> most;  // what the one that is told of does, and brings
        std::size_t n = 0;
        for (const auto& [grip, probability] : grips_[o]) {
            const HandLoad& load = loads[n].first;
            const WorkSample& sample = work[n++];
            const PersonKind& kind = *kinds_[grip.kind];
            const char* act = acts[static_cast<std::size_t>(grip.act)];
            if (out.empty() || out.back().by != kind.name || out.back().act != act) {
                out.push_back({kind.name, act});
                most = {-1, -1};
            }
            const std::pair does{instability(objects_[o], sample), sample.W_J};
            out.back().chance += probability;
            if (does.first > 0) out.back().fall_chance += probability;
            if (does <= most) continue;
            most = does;
            const MassSpread& stands = stances_[o];
            const bool hangs = load.weight_N > 0;
            const double ahead = hangs ? load.half_base_m + load.climber_Nm / load.weight_N : 0;
            out.back().place_m = {stands.center[0] + ahead * load.way[0],
                                  stands.center[1] + ahead * load.way[1],
                                  stands.bottom_m + load.height_m};
            const auto along = [&](double value) {
                return Vec3{value * load.way[0], value * load.way[1], 0};
            };
            out.back().force_N = hangs ? Vec3{0, 0, -load.weight_N} : along(load.force_N);
            out.back().impulse_Ns = along(blow_impulse_Ns(objects_[o], load));
        }
        return out;
    }

    // At what is in reach, the ways that it is pulled.
    FieldSamples arrows(std::span<const float> exposure) const {
        ArrowSample out;
        const SolidCells& cells = solids_.cells;
        for (std::size_t c = 0; c < exposure.size(); ++c) {
            if (!(exposure[c] > 0)) continue;
            Vec3 way{};
            for (const auto& [grip, times] : grips_[static_cast<std::size_t>(solids_.object[c])]) {
                const auto [dx, dy] = direction(grip.direction);
                way = {way[0] - times * dx, way[1] - times * dy, 0};
            }
            out.offer({(cells.i[c] + 0.5) * cells.voxel_m, (cells.j[c] + 0.5) * cells.voxel_m,
                       (cells.k[c] + 0.5) * cells.voxel_m},
                      way, exposure[c]);
        }
        return out.take();
    }

    device::Device& device_;
    const Surroundings& surroundings_;
    std::span<const RiskObject> objects_;
    std::span<const PersonKind* const> kinds_;
    Solids solids_;
    std::vector<std::vector<std::uint32_t>> cells_;  // by object
    std::vector<MassSpread> stances_;                // by object
    std::vector<Grips> grips_;                       // by object
};

}  // namespace

Disturbance reach_field(device::Device& device, const Surroundings& surroundings,
                        std::span<const RiskObject> objects,
                        std::span<const PersonKind* const> kinds) {
    return Reaching(device, surroundings, objects, kinds).disturbance();
}

}  // namespace topple::safety
