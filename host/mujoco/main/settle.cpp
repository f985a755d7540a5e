// SPDX-License-Identifier: MIT
#include "mujoco/main/settle.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <initializer_list>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

namespace topple::mujoco {
namespace {

using Model = std::unique_ptr<mjModel, decltype(&mj_deleteModel)>;
using Data = std::unique_ptr<mjData, decltype(&mj_deleteData)>;

// problem: why it was not loaded, or what MuJoCo warned of.
Model load(const std::filesystem::path& file, std::string& problem) {
    // Else it writes a file of warnings into the current folder.
    mju_user_warning = [](const char*) {};
    char error[1000] = "";
    Model model(mj_loadXML(file.c_str(), nullptr, error, sizeof(error)), &mj_deleteModel);
    // Versions before 2.3 have room for a hundred contacts, and say so while they load.
    const bool only_small =
        model && std::string_view(error).starts_with("Pre-allocated contact buffer is full");
    if (!only_small) problem = error;
    return model;
}

// The memory of versions before 2.3 does not grow, and takes the square of the contacts, 1.8 GB for
// the most: so what has too little is simulated anew with twice as much.
constexpr bool memory_grows = mjVERSION_HEADER >= 230;
constexpr int least_room = 250, most_room = 3000;

// The data of a model; nothing where there is no memory for it.
Data make_data(mjModel& model, [[maybe_unused]] int room) {
#if mjVERSION_HEADER < 230
    model.nconmax = room;
    model.njmax = 4 * room;  // rows
#endif
    return {mj_makeData(&model), &mj_deleteData};
}

// Whether the last step warned of any of these; that is told once.
bool warned(mjData& data, std::initializer_list<mjtWarning> of) {
    int number = 0;
    for (const mjtWarning each : of) number += std::exchange(data.warning[each].number, 0);
    return number > 0;
}

void follow(Motion& motion, const mjData& data, std::size_t body, const std::vector<mjtNum>& place,
            const std::vector<mjtNum>& pose) {
    const mjtNum* v = data.cvel + 6 * body + 3;
    motion.fastest_m_s = std::max(motion.fastest_m_s, std::hypot(v[0], v[1], v[2]));
    double moved = 0, cosine = 0;
    for (std::size_t a = 0; a < 3; ++a)
        moved = std::hypot(moved, data.xpos[3 * body + a] - place[3 * body + a]);
    for (std::size_t a = 0; a < 4; ++a) cosine += data.xquat[4 * body + a] * pose[4 * body + a];
    const double degrees = 2 * std::acos(std::min(1.0, std::abs(cosine))) * 180 / M_PI;
    motion.moved_m = std::max(motion.moved_m, moved);
    motion.turned_deg = std::max(motion.turned_deg, degrees);
}

// From the start, with room for so many contacts where that must be said.
Settled simulate(mjModel& model, int room, double seconds, double patience_s) {
    Settled out;
    out.version = mj_versionString();
    const Data made = make_data(model, room);
    if (!made) out.problem = "no memory";
    if (!made) return out;
    mjData& data = *made;
    mj_forward(&model, &data);
    out.contacts = static_cast<std::uint64_t>(data.ncon);
    for (int n = 0; n < data.ncon; ++n)
        out.deepest_m = std::max(out.deepest_m, -double{data.contact[n].dist});
    std::vector<std::size_t> free;
    for (std::size_t b = 1; b < static_cast<std::size_t>(model.nbody); ++b) {
        if (model.body_dofnum[b] != 6) continue;  // held, or a front on its joint
        free.push_back(b);
        out.motions.push_back({mj_id2name(&model, mjOBJ_BODY, static_cast<int>(b)), 0, 0, 0});
    }
    const std::vector<mjtNum> place(data.xpos, data.xpos + 3 * model.nbody);
    const std::vector<mjtNum> pose(data.xquat, data.xquat + 4 * model.nbody);
    const auto start = std::chrono::steady_clock::now();
    const auto taken_s = [&] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    const bool may_have_more = !memory_grows && room < most_room;
    while (data.time < seconds) {
        if (taken_s() > patience_s) {
            out.cut_short = "it took longer than it may";
            break;
        }
        mj_step(&model, &data);
        out.left_out += warned(data, {mjWARN_CONTACTFULL, mjWARN_CNSTRFULL});
        if (out.left_out > 0 && may_have_more) break;
        if (warned(data, {mjWARN_BADQPOS, mjWARN_BADQVEL, mjWARN_BADQACC})) {
            out.cut_short = became_unstable;
            break;
        }
        for (std::size_t n = 0; n < free.size(); ++n)
            follow(out.motions[n], data, free[n], place, pose);
        out.simulated_s = data.time;
    }
    out.wall_s = taken_s();
    return out;
}

}  // namespace

Settled settle(const std::filesystem::path& file, double seconds, double patience_s,
               void (*on_error)(const char* what)) {
    mju_user_error = on_error;
    Settled out;
    out.version = mj_versionString();
    const Model model = load(file, out.problem);
    if (!out.problem.empty()) return out;
    for (int room = least_room;; room = std::min(2 * room, most_room)) {
        out = simulate(*model, room, seconds, patience_s);
        patience_s -= out.wall_s;
        if (memory_grows || out.left_out == 0 || room == most_room) return out;
    }
}

}  // namespace topple::mujoco
