// SPDX-License-Identifier: MIT
#include "mujoco/verdict.h"

#include <cstdio>
#include <map>
#include <utility>

#include "core/json.h"
#include "io/json_values.h"
#include "topple/error.h"

namespace topple::mujoco {
namespace {

constexpr Says all_says[] = {Says::stable, Says::unsure, Says::falls};

OrderedJson object_json(const ObjectVerdict& o) {
    OrderedJson json{{"id", o.object},
                     {"says", to_string(o.says)},
                     {"barrier_J", io::number(o.barrier_J)},
                     {"barrier_error_J", io::number(o.barrier_error_J)},
                     {"on_pad", o.on_pad},
                     {"held", o.held},
                     {"free", o.motion.has_value()}};
    if (o.motion) {
        json["stays"] = o.stays();
        json["moved_m"] = io::number(o.motion->moved_m);
        json["turned_deg"] = io::number(o.motion->turned_deg);
        json["fastest_m_s"] = io::number(o.motion->fastest_m_s);
    }
    const std::optional<bool> agrees = o.agrees();
    json["agrees"] = agrees ? OrderedJson(*agrees) : OrderedJson(nullptr);
    return json;
}

double real_time_factor(const Settled& run) {
    return run.wall_s > 0 ? run.simulated_s / run.wall_s : 0;
}

template <class... Values>
std::string printed(const char* format, Values... values) {
    char line[256];
    std::snprintf(line, sizeof(line), format, values...);
    return line;
}

using Count = unsigned long long;

std::string row_text(const ObjectVerdict& o) {
    const std::optional<bool> agrees = o.agrees();
    return printed("%6d  %-7s %10.3g %10.3g %9.1f %11.1f %12.2f  %s\n", o.object, to_string(o.says),
                   o.barrier_J, o.barrier_error_J, 100 * o.motion->moved_m, o.motion->turned_deg,
                   o.motion->fastest_m_s, agrees ? *agrees ? "agrees" : "disagrees" : "-");
}

}  // namespace

const char* to_string(Says says) {
    return says == Says::stable ? "stable" : says == Says::falls ? "falls" : "unsure";
}

Says says_of(const Object& object) {
    if (!object.seen_enough) return Says::unsure;
    if (object.barrier_J <= 0) return object.release_J > 0 ? Says::falls : Says::stable;
    return barrier_within_error(object) ? Says::unsure : Says::stable;
}

std::optional<bool> ObjectVerdict::agrees() const {
    if (!motion || says == Says::unsure) return std::nullopt;
    return stays() == (says == Says::stable);
}

Verdict::Count Verdict::count(std::optional<Says> says) const {
    Count out;
    for (const ObjectVerdict& o : objects) {
        if (!o.motion || o.says != says.value_or(o.says)) continue;
        ++out.free;
        out.stay += o.stays();
    }
    return out;
}

Verdict judge(const Scene& scene, const ExportSummary& exported, Settled run, double asked_s) {
    std::map<std::string, Motion> moved;
    for (Motion& motion : run.motions) moved.emplace(motion.body, motion);
    run.motions.clear();
    Verdict out;
    out.run = std::move(run);
    out.asked_s = asked_s;
    for (const ExportedBody& body : exported.bodies) {
        if (body.object < 0 || body.parts == 0) continue;
        const Object& object = scene.objects.at(static_cast<std::size_t>(body.object));
        if (object.grounded) continue;
        ObjectVerdict verdict;
        verdict.object = body.object;
        verdict.says = says_of(object);
        verdict.barrier_J = object.barrier_J;
        verdict.barrier_error_J = object.barrier_error_J;
        verdict.on_pad = body.on_pad;
        verdict.held = body.held;
        if (const auto motion = moved.find(body.name); motion != moved.end())
            verdict.motion = motion->second;
        out.objects.push_back(std::move(verdict));
    }
    return out;
}

void check_stable(const Verdict& verdict, const std::string& output) {
    if (verdict.run.cut_short != became_unstable) return;
    throw Error(ErrorKind::input,
                output + printed(": MuJoCo became unstable after %.3g of %.3g s, so that it is not "
                                 "known what stays",
                                 verdict.run.simulated_s, verdict.asked_s));
}

std::string verdict_json(const Verdict& verdict) {
    const Settled& run = verdict.run;
    OrderedJson counts = OrderedJson::object(), objects = OrderedJson::array();
    for (const Says says : all_says) {
        const Verdict::Count of = verdict.count(says);
        counts[to_string(says)] = {{"free", of.free}, {"stay", of.stay}};
    }
    for (const ObjectVerdict& o : verdict.objects) objects.push_back(object_json(o));
    const OrderedJson json{{"schema", "topple.verify/1"},
                           {"simulator", "MuJoCo " + run.version},
                           {"asked_s", verdict.asked_s},
                           {"simulated_s", io::number(run.simulated_s)},
                           {"cut_short", run.cut_short},
                           {"real_time_factor", io::number(real_time_factor(run))},
                           {"stays_within_m", stays_m},
                           {"stays_within_deg", stays_deg},
                           {"contacts_at_start", run.contacts},
                           {"deepest_contact_m", io::number(run.deepest_m)},
                           {"steps_without_room", run.left_out},
                           {"counts", std::move(counts)},
                           {"objects", std::move(objects)}};
    return json.dump(1, ' ', false, OrderedJson::error_handler_t::replace) + "\n";
}

std::string verdict_text(const Verdict& verdict) {
    const Settled& run = verdict.run;
    const Verdict::Count all = verdict.count();
    std::string out =
        printed("MuJoCo %s: %llu of %llu objects stay within %.0f cm and %.0f degrees for %.3g s\n",
                run.version.substr(0, 20).c_str(), Count{all.stay}, Count{all.free}, 100 * stays_m,
                stays_deg, run.simulated_s);
    if (!run.cut_short.empty())
        out += printed("It ended before the %.3g s that were asked for: %.60s\n", verdict.asked_s,
                       run.cut_short.c_str());
    out += printed("%llu contacts at the start, %.3f mm deep at most; %.2g times real time\n",
                   Count{run.contacts}, 1e3 * run.deepest_m, real_time_factor(run));
    if (run.left_out > 0)
        out += printed(
            "In %llu steps there was no room for all contacts, so that things may have sunk in: "
            "MuJoCo from 2.3 on has room\n",
            Count{run.left_out});
    out += printed("\n%-11s %7s %6s %6s\n", "topple says", "objects", "stay", "move");
    for (const Says says : all_says) {
        const Verdict::Count of = verdict.count(says);
        out += printed("%-11s %7llu %6llu %6llu\n", to_string(says), Count{of.free}, Count{of.stay},
                       Count{of.free - of.stay});
    }
    std::string rows;
    std::size_t held = 0;
    for (const ObjectVerdict& o : verdict.objects) {
        held += !o.motion;
        if (o.motion && (!o.stays() || o.agrees() == false)) rows += row_text(o);
    }
    if (held > 0)
        out += printed("%-11s %7llu      (without a footing that was seen and kept)\n", "held",
                       static_cast<Count>(held));
    if (!rows.empty())
        out += printed("\n%6s  %-7s %10s %10s %9s %11s %12s\n", "object", "says", "barrier J",
                       "error J", "moved cm", "turned deg", "fastest m/s") +
               rows;
    return out;
}

}  // namespace topple::mujoco
