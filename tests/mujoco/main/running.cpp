// SPDX-License-Identifier: MIT
#include "mujoco/running.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace topple::mujoco {

struct Running::State {
    mjModel* model = nullptr;
    mjData* data = nullptr;
    ~State() {
        if (data) mj_deleteData(data);
        if (model) mj_deleteModel(model);
    }
    int body(const std::string& name) const { return mj_name2id(model, mjOBJ_BODY, name.c_str()); }
};

Running::Running(const std::filesystem::path& file) : state_(std::make_unique<State>()) {
    // Else it writes a file of warnings into the current folder.
    mju_user_warning = [](const char*) {};
    char error[1000] = "";
    state_->model = mj_loadXML(file.c_str(), nullptr, error, sizeof(error));
    trouble_ = error;
    if (!state_->model) return;
    // Versions before 2.3 have no memory that grows, and say so while they load a scene of more
    // than a hundred contacts; newer ones would take gigabytes for a file that names a number.
    if (mj_version() < 230 && trouble_.starts_with("Pre-allocated contact buffer is full"))
        trouble_.clear();
    state_->model->nconmax = 3000;
    state_->model->njmax = 12000;
    state_->data = mj_makeData(state_->model);
    if (!state_->data) trouble_ += "no memory";
}

Running::~Running() = default;

double Running::mass_kg(const std::string& body) const {
    return state_->model->body_mass[state_->body(body)];
}
double Running::height_m(const std::string& body) const {
    return state_->model->body_pos[3 * state_->body(body) + 2];
}
bool Running::is_box(const std::string& body) const {
    return state_->model->geom_type[state_->model->body_geomadr[state_->body(body)]] == mjGEOM_BOX;
}

double Running::deepest_m() {
    mj_forward(state_->model, state_->data);
    double deepest = 0;
    for (int n = 0; n < state_->data->ncon; ++n)
        deepest = std::max(deepest, -state_->data->contact[n].dist);
    return deepest;
}

Running::Stay Running::run(double seconds) {
    const mjModel& model = *state_->model;
    mjData& data = *state_->data;
    mj_forward(&model, &data);
    const auto bodies = static_cast<std::size_t>(model.nbody);
    const std::vector<mjtNum> place(data.xpos, data.xpos + 3 * bodies);
    const std::vector<mjtNum> turn(data.xquat, data.xquat + 4 * bodies);
    std::vector<bool> fast(bodies, false);
    while (data.time < seconds) {
        mj_step(&model, &data);
        for (std::size_t b = 1; b < bodies; ++b) {
            const mjtNum* v = data.cvel + 6 * b + 3;
            if (std::hypot(v[0], v[1], v[2]) > 1) fast[b] = true;
        }
    }
    Stay out;
    for (std::size_t b = 1; b < bodies; ++b) {
        if (model.body_jntnum[b] == 0) continue;
        ++out.free;
        out.launched += fast[b];
        double moved = 0, cosine = 0;
        for (std::size_t a = 0; a < 3; ++a)
            moved = std::hypot(moved, data.xpos[3 * b + a] - place[3 * b + a]);
        for (std::size_t a = 0; a < 4; ++a) cosine += data.xquat[4 * b + a] * turn[4 * b + a];
        const double degrees = 2 * std::acos(std::min(1.0, std::abs(cosine))) * 180 / M_PI;
        out.stay += moved < 0.01 && degrees < 2;
    }
    return out;
}

}  // namespace topple::mujoco
