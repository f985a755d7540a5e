// SPDX-License-Identifier: MIT
#include "simulation/pushes.h"

namespace topple::simulation {
namespace {

class Blows {
  public:
    explicit Blows(const StandingObject& object)
        : simulation_(object.body, object.fixed, friction),
          sunk_m_(0.5 * object.body.voxel_m),
          most_J_(simulation_.mass_kg() * 9.80665 * 2) {}

    // Blows of less than the least found so far are tried only where one of nearly as much
    // suffices: of most directions that takes a single run.
    void try_all(std::span<const Vec3> directions) {
        for (const Vec3& direction : directions) {
            for (const double share : {1.0, 0.5, 0.0}) {
                const Vec3 at{0, 0, share * simulation_.height_m()};
                double enough = std::isfinite(least_J_) ? fine * least_J_ : most_J_;
                if (!suffices(direction, at, enough)) continue;
                // Quartered until it does not suffice, then between the two, by ratios.
                double low = 0;
                while (low < fine * enough && enough > 1e-9 * most_J_) {
                    const double between = low > 0 ? std::sqrt(low * enough) : 0.25 * enough;
                    (suffices(direction, at, between) ? enough : low) = between;
                }
                least_J_ = enough;
            }
        }
    }
    double least_J() const { return least_J_; }

  private:
    static constexpr double fine = 0.98;

    bool suffices(const Vec3& direction, const Vec3& at, double energy_J) {
        const double scale = std::sqrt(energy_J / simulation_.energy_J(direction, at));
        simulation_.reset();
        simulation_.push({scale * direction[0], scale * direction[1], 0}, at);
        return simulation_.sinks(5, sunk_m_);
    }

    Simulation simulation_;
    double sunk_m_, most_J_;
    double least_J_ = std::numeric_limits<double>::infinity();
};

}  // namespace

double weakest_blow_J(const StandingObject& object) {
    std::vector<Vec3> directions;
    for (int n = 0; n < 16; ++n) {
        // Far apart in turn, so that a low energy is found soon.
        const double angle = 7 * n * std::numbers::pi / 8;
        directions.push_back({std::cos(angle), std::sin(angle), 0});
    }
    Blows blows(object);
    blows.try_all(directions);
    return blows.least_J();
}

double weakest_blow_J(const StandingObject& object, const Vec3& direction) {
    Blows blows(object);
    blows.try_all(std::span(&direction, 1));
    return blows.least_J();
}

}  // namespace topple::simulation
