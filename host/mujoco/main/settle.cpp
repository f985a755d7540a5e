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

// The data of a model; nothing where there is no memory for it.
Data make_data(mjModel& model) {
#if mjVERSION_HEADER < 230
    // Their memory does not grow, and takes the square of the contacts, 1.8 GB for the most: so as
    // many as there are at the start, and as many again.
    constexpr int least = 250, most = 3000;
    for (int room = least;; room = std::min(2 * room, most)) {
        model.nconmax = room;
        model.njmax = 4 * room;  // rows
        Data data(mj_makeData(&model), &mj_deleteData);
        if (!data || room == most) return data;
        mj_forward(&model, data.get());
        const bool enough = 2 * data->ncon <= room;
        mj_resetData(&model, data.get());
        if (enough) return data;
    }
#else
    return {mj_makeData(&model), &mj_deleteData};
#endif
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

}  // namespace

Settled settle(const std::filesystem::path& file, double seconds, double patience_s,
               void (*on_error)(const char* what)) {
    mju_user_error = on_error;
    Settled out;
    out.version = mj_versionString();
    const Model loaded = load(file, out.problem);
    if (!out.problem.empty()) return out;
    const Data made = make_data(*loaded);
    if (!made) out.problem = "no memory";
    if (!made) return out;
    const mjModel& model = *loaded;
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
    while (data.time < seconds) {
        if (taken_s() > patience_s) {
            out.cut_short = "it took longer than it may";
            break;
        }
        mj_step(&model, &data);
        out.left_out += warned(data, {mjWARN_CONTACTFULL, mjWARN_CNSTRFULL});
        if (warned(data, {mjWARN_BADQPOS, mjWARN_BADQVEL, mjWARN_BADQACC})) {
            out.cut_short = "it became unstable";
            break;
        }
        for (std::size_t n = 0; n < free.size(); ++n)
            follow(out.motions[n], data, free[n], place, pose);
        out.simulated_s = data.time;
    }
    out.wall_s = taken_s();
    return out;
}

}  // namespace topple::mujoco
