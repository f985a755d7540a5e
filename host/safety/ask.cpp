// SPDX-License-Identifier: MIT
#include "topple/ask.h"

#include <algorithm>
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/strong_components.hpp>
#include <boost/range/iterator_range.hpp>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

#include "core/listed.h"
#include "core/numbered_object.h"
#include "core/sort_unique.h"
#include "io/length_text.h"
#include "io/text.h"
#include "safety/footholds.h"
#include "topple/error.h"

namespace topple {
namespace {

using Ids = std::vector<std::int32_t>;

void check_loose(const Scene& scene, std::int32_t id) {
    const auto refuse = [&](const std::string& why) {
        throw Error(ErrorKind::usage, "object " + std::to_string(id) + ": " + why);
    };
    if (scene.objects.empty()) refuse("the scene has no objects");
    if (id < 0 || static_cast<std::size_t>(id) >= scene.objects.size())
        refuse("the scene has objects 0 to " + std::to_string(scene.objects.size() - 1));
    if (scene.objects[id].grounded)
        refuse("it is the building, or fixed to it: nothing takes it away, or has to hold it");
}

// "object 3 (fridge) and the building".
std::string named(const Scene& scene, const Ids& ids) {
    std::vector<std::string> words;
    for (const std::int32_t id : ids) {
        const Object& o = scene.objects[id];
        std::string word = o.grounded ? "the building" : numbered_object(o);
        if (std::ranges::find(words, word) == words.end()) words.push_back(std::move(word));
    }
    return listed(words, "and");
}

// The objects among `ids` in groups that carry one another in a ring, and each other one alone, so
// that none stands after what carries it.
std::vector<Ids> rings_from_the_top(const Scene& scene, const Ids& ids) {
    std::vector<std::size_t> node(scene.objects.size(), ids.size());
    for (std::size_t n = 0; n < ids.size(); ++n) node[ids[n]] = n;
    boost::adjacency_list<boost::vecS, boost::vecS, boost::directedS> carries(ids.size());
    for (const Support& s : scene.supports)
        if (node[s.supporter] < ids.size() && node[s.supported] < ids.size())
            boost::add_edge(node[s.supporter], node[s.supported], carries);
    std::vector<std::size_t> ring(ids.size());
    const std::size_t rings = boost::strong_components(
        carries,
        boost::make_iterator_property_map(ring.begin(), boost::get(boost::vertex_index, carries)));
    std::vector<Ids> out(rings);
    for (std::size_t n = 0; n < ids.size(); ++n) out[ring[n]].push_back(ids[n]);
    // A ring's number is above those of all that it carries, so that their layers are known.
    std::vector<std::size_t> layer(rings, 0);
    for (std::size_t r = 0; r < rings; ++r)
        for (const std::int32_t id : out[r])
            for (const auto edge :
                 boost::make_iterator_range(boost::out_edges(node[id], carries))) {
                const std::size_t on = ring[boost::target(edge, carries)];
                if (on != r) layer[r] = std::max(layer[r], layer[on] + 1);
            }
    std::vector<std::pair<std::size_t, Ids>> by_layer;
    for (std::size_t r = 0; r < rings; ++r) {
        std::ranges::sort(out[r]);
        by_layer.emplace_back(layer[r], std::move(out[r]));
    }
    std::ranges::sort(by_layer);
    for (std::size_t r = 0; r < rings; ++r) out[r] = std::move(by_layer[r].second);
    return out;
}

// What holds what, while things go.
class Holding {
  public:
    explicit Holding(const Scene& scene)
        : scene_(scene),
          footholds_(scene),
          supports_(scene.objects.size()),
          carries_(scene.objects.size()),
          there_(scene.objects.size(), true),
          lost_(scene.objects.size(), 0.0) {
        for (std::size_t n = 0; n < scene.supports.size(); ++n) {
            supports_[scene.supports[n].supported].push_back(n);
            carries_[scene.supports[n].supporter].push_back(scene.supports[n].supported);
        }
        find_roots();
    }

    // probability: that it goes.
    void take(std::int32_t object, double probability = 1) {
        there_[object] = false;
        lost_[object] = probability;
        shaken_.insert(shaken_.end(), carries_[object].begin(), carries_[object].end());
    }
    bool there(std::int32_t object) const { return there_[object]; }

    // What falls next, as long as anything does.
    std::vector<Unheld> next() {
        std::vector<Unheld> out;
        sort_unique(shaken_);
        for (const std::int32_t id : std::exchange(shaken_, {})) {
            const Object& o = scene_.objects[id];
            if (there_[id] && !o.grounded && !is_held(o))
                out.push_back(unheld(o, probability(supports_of(o))));
        }
        if (!out.empty()) return out;
        // Nothing tips, but rings may hold themselves alone: as likely as any of them lost another.
        const std::vector<bool> reached = reached_from_roots();
        double likeliest = 0;
        for (const Object& o : scene_.objects)
            if (there_[o.id] && !reached[o.id])
                likeliest = std::max(likeliest, probability(supports_of(o)));
        for (const Object& o : scene_.objects)
            if (there_[o.id] && !reached[o.id]) out.push_back(unheld(o, likeliest));
        return out;
    }

  private:
    struct Supports {
        std::vector<std::size_t> left, lost;
    };
    Supports supports_of(const Object& o) const {
        Supports out;
        for (const std::size_t n : supports_[o.id])
            (there_[scene_.supports[n].supporter] ? out.left : out.lost).push_back(n);
        return out;
    }
    bool has_foothold(std::size_t support) const { return !footholds_.of(support).empty(); }

    // How far its centre of mass lies outside of what is left; less than 0: it is held.
    double beyond_m(const Object& o, const Supports& by) const {
        constexpr double held = -1;
        const auto foothold = [&](std::size_t n) { return has_foothold(n); };
        if (by.lost.empty() || by.left.empty() || !std::ranges::all_of(by.left, foothold))
            return held;
        const double outside = footholds_.outside_m(by.left, o.center_of_mass_m);
        double before = 0;
        // What held it without a foothold may have held all of it.
        if (std::ranges::all_of(by.lost, foothold))
            before = std::max(0.0, footholds_.outside_m(supports_[o.id], o.center_of_mass_m));
        return outside > before + scene_.voxel_size_m / 2 ? outside : held;
    }
    bool is_held(const Object& o) const {
        const Supports by = supports_of(o);
        return by.lost.empty() || (!by.left.empty() && beyond_m(o, by) < 0);
    }

    // That what stood on these has lost one.
    double probability(const Supports& by) const {
        double out = 0;
        for (const std::size_t n : by.lost)
            out =
                std::max(out, scene_.supports[n].probability * lost_[scene_.supports[n].supporter]);
        return out;
    }
    Unheld unheld(const Object& o, double likely) const {
        const Supports by = supports_of(o);
        Unheld out;
        out.object = o.id;
        out.probability = likely;
        for (const std::size_t n : by.left) out.left.push_back(scene_.supports[n].supporter);
        for (const std::size_t n : by.lost) out.lost.push_back(scene_.supports[n].supporter);
        sort_unique(out.left);
        sort_unique(out.lost);
        const double beyond = beyond_m(o, by);
        const std::string who = named(scene_, {o.id});
        if (by.left.empty()) {
            out.reason = who + " rests on " + named(scene_, out.lost) + ", and on nothing else";
        } else if (beyond < 0) {
            out.reason = who + " is left with " + named(scene_, out.left) +
                         ", and rests there in a ring that nothing else holds";
        } else {
            out.beyond_m = beyond;
            out.reason = who + " loses " + named(scene_, out.lost) + ": its centre of mass lies " +
                         io::length_text(beyond) + " outside of what is left to stand on, " +
                         named(scene_, out.left);
        }
        out.reason[0] = 'O';
        constexpr double sure = 0.9;  // below it is told how likely that is
        if (out.probability < sure)
            out.reason += " (" + io::two_digits(100 * out.probability) + " % likely)";
        return out;
    }

    // What holds without being held by what was seen: the building; what nothing was seen to hold;
    // and rings of such.
    void find_roots() {
        Ids all;
        for (const Object& o : scene_.objects) all.push_back(o.id);
        std::vector<bool> is_in_ring(all.size(), false);
        for (const Ids& ring : rings_from_the_top(scene_, all)) {
            for (const std::int32_t id : ring) is_in_ring[id] = true;
            const bool held = std::ranges::any_of(ring, [&](std::int32_t id) {
                return std::ranges::any_of(supports_[id], [&](std::size_t n) {
                    return !is_in_ring[scene_.supports[n].supporter];
                });
            });
            for (const std::int32_t id : ring) {
                is_in_ring[id] = false;
                if (!held || scene_.objects[id].grounded) roots_.push_back(id);
            }
        }
    }
    std::vector<bool> reached_from_roots() const {
        std::vector<bool> reached(scene_.objects.size(), false);
        Ids open;
        const auto reach = [&](std::int32_t id) {
            if (!there_[id] || reached[id]) return;
            reached[id] = true;
            open.push_back(id);
        };
        std::ranges::for_each(roots_, reach);
        while (!open.empty()) {
            const std::int32_t id = open.back();
            open.pop_back();
            std::ranges::for_each(carries_[id], reach);
        }
        return reached;
    }

    const Scene& scene_;
    safety::Footholds footholds_;
    std::vector<std::vector<std::size_t>> supports_;  // by supported, into Scene::supports
    std::vector<Ids> carries_;                        // by supporter
    std::vector<bool> there_;
    std::vector<double> lost_;  // how likely it is that an object has gone
    Ids shaken_;                // what has lost a supporter since next() looked
    Ids roots_;
};

// What touches what is gone and may be held by it, though the parse does not say so.
Ids unsure_beside(const Scene& scene, const Holding& holding) {
    const auto gone = [&](std::int32_t id) { return id >= 0 && !holding.there(id); };
    Ids out;
    for (const Contact& c : scene.contacts) {
        const std::int32_t a = scene.primitives[c.a].object, b = scene.primitives[c.b].object;
        for (const auto& [one, other] : {std::pair{a, b}, std::pair{b, a}}) {
            if (!gone(one) || other < 0 || gone(other)) continue;
            const Object& o = scene.objects[other];
            const bool known = o.seen_enough && (o.rests_by == "seen" || o.rests_by == "near");
            if (!o.grounded && !known) out.push_back(other);
        }
    }
    sort_unique(out);
    return out;
}

// All that may fall.
std::vector<Unheld> take_away(const Ids& taken, Holding& holding) {
    for (const std::int32_t id : taken) holding.take(id);
    std::vector<Unheld> out;
    for (auto next = holding.next(); !next.empty(); next = holding.next()) {
        for (Unheld& one : next) {
            holding.take(one.object, one.probability);
            out.push_back(std::move(one));
        }
    }
    return out;
}

}  // namespace

FallsWithout falls_without(const Scene& scene, const std::vector<std::int32_t>& taken) {
    constexpr double likelier_than_not = 0.5;
    for (const std::int32_t id : taken) check_loose(scene, id);
    Holding holding(scene);
    FallsWithout out;
    std::vector<Unheld> all = take_away(taken, holding);
    out.unsure = unsure_beside(scene, holding);
    for (Unheld& one : all) {
        if (one.probability < likelier_than_not)
            out.unsure.push_back(one.object);
        else
            out.falls.push_back(std::move(one));
    }
    sort_unique(out.unsure);
    return out;
}

std::vector<std::vector<std::int32_t>> removal_steps(const Scene& scene) {
    Ids loose;
    for (const Object& o : scene.objects)
        if (!o.grounded) loose.push_back(o.id);
    return rings_from_the_top(scene, loose);
}

std::vector<std::vector<std::int32_t>> removal_steps(const Scene& scene, std::int32_t before) {
    check_loose(scene, before);
    Holding holding(scene);
    Ids going{before};
    for (const Unheld& one : take_away({before}, holding)) going.push_back(one.object);
    std::ranges::sort(going);
    return rings_from_the_top(scene, going);
}

std::vector<Holder> held_by(const Scene& scene, std::int32_t object) {
    check_loose(scene, object);
    const safety::Footholds footholds(scene);
    std::vector<Holder> out;
    for (std::size_t n = 0; n < scene.supports.size(); ++n) {
        const Support& s = scene.supports[n];
        if (s.supported != object) continue;
        out.push_back({s.supporter, scene.objects[s.supporter].grounded, s.area_m2, s.probability,
                       !footholds.of(n).empty()});
    }
    std::ranges::sort(out, [](const Holder& a, const Holder& b) {
        return std::pair(-a.probability, a.object) < std::pair(-b.probability, b.object);
    });
    return out;
}

}  // namespace topple
