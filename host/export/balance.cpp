// SPDX-License-Identifier: MIT
#include "export/balance.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "export/brace.h"
#include "export/eigen.h"
#include "export/separate.h"
#include "export/touching.h"

namespace topple::exports {
namespace {

// What moves with less than this share of gravity stands: sums are not exact.
constexpr double at_rest_share = 0.01;
// Things stand on ground that is out of level by so much, too: what just balances falls in a while.
constexpr double out_of_level = 0.005;
// Simulators let things creep down slopes that friction just holds.
constexpr double sure_friction = 0.8;

// A force of one contact along an edge of its cone of friction, on the body above; its opposite
// acts on the one below.
struct Force {
    std::size_t above = 0, below = 0;
    Eigen::Vector3d along;                     // unit normal + friction
    Eigen::Vector3d turns_above, turns_below;  // moments about the centres of mass
    Eigen::Vector3d spins_above, spins_below;  // angular acceleration that 1 N gives
    double yields = 0;                         // acceleration along itself that 1 N gives
    double newtons = 0;
};

// Accelerations of rigid bodies that push against one another.
class Statics {
  public:
    Statics(const std::vector<Body>& bodies, double friction, double gravity_m_s2)
        : bodies_(bodies), friction_(friction), gravity_m_s2_(gravity_m_s2) {
        extend();
    }
    // Takes in what has been added to the bodies.
    void extend() {
        const std::size_t first = light_.size();
        light_.resize(bodies_.size(), 0.0);
        supple_.resize(bodies_.size(), Eigen::Matrix3d::Zero());
        reach_m_.resize(bodies_.size(), 0.0);
        for (std::size_t n = first; n < bodies_.size(); ++n) release(n);
        for (const Touch& touch : touches_of(bodies_, first)) add(touch);
    }
    // It does not move from now on.
    void hold(std::size_t body) {
        light_[body] = 0;
        supple_[body].setZero();
        for (Force& force : forces_)
            if (force.above == body || force.below == body) weigh(force);
    }
    // The accelerations of the fastest ends, on level ground and on such as is nearly level.
    std::vector<double> accelerations_m_s2() {
        std::vector<double> out(bodies_.size(), 0.0);
        for (const auto& [x, y] :
             {std::array{0.0, 0.0}, std::array{1.0, 0.0}, std::array{-1.0, 0.0},
              std::array{0.0, 1.0}, std::array{0.0, -1.0}}) {
            solve({x * out_of_level * gravity_m_s2_, y * out_of_level * gravity_m_s2_,
                   -gravity_m_s2_});
            for (std::size_t n = 0; n < out.size(); ++n)
                out[n] = std::max(out[n], move_[n].norm() + turn_[n].norm() * reach_m_[n]);
        }
        return out;
    }

  private:
    // By Gauss's principle of least constraint, contacts leave the accelerations that are least,
    // each weighed with its mass: a sum of squares over forces >= 0, one after another
    // (Gauss-Seidel).
    void solve(const Eigen::Vector3d& weight_m_s2) {
        constexpr int most_rounds = 2000;
        const double small = 1e-4 * gravity_m_s2_;
        move_.assign(bodies_.size(), Eigen::Vector3d::Zero());
        turn_.assign(bodies_.size(), Eigen::Vector3d::Zero());
        for (std::size_t n = 0; n < bodies_.size(); ++n)
            if (light_[n] > 0) move_[n] = weight_m_s2;
        for (const Force& force : forces_) apply(force, force.newtons);
        for (int round = 0; round < most_rounds; ++round) {
            double most = 0;
            for (Force& force : forces_) {
                if (!(force.yields > 0)) continue;
                const double apart = force.along.dot(move_[force.above] - move_[force.below]) +
                                     force.turns_above.dot(turn_[force.above]) -
                                     force.turns_below.dot(turn_[force.below]);
                const double newtons = std::max(0.0, force.newtons - apart / force.yields);
                const double more = newtons - force.newtons;
                if (more == 0) continue;
                apply(force, more);
                force.newtons = newtons;
                most = std::max(most, std::abs(more) * force.yields);
            }
            if (most < small) break;
        }
    }
    void release(std::size_t n) {
        const Body& body = bodies_[n];
        if (body.fixed || !(body.mass_kg > 0) || body.parts.empty()) return;
        // Symmetric: the order of its rows doesn't matter.
        const Eigen::Map<const Eigen::Matrix3d> inertia(body.inertia_kg_m2.data());
        light_[n] = 1 / body.mass_kg;
        supple_[n] = inertia.inverse();
        const Extents<double> box = box_around(body.parts);
        reach_m_[n] = (eigen(box.high) - eigen(box.low)).norm() / 2;
    }
    void add(const Touch& touch) {
        const Eigen::Vector3d n = eigen(touch.normal);
        // One edge of the cone lies along the slope, on which things slide.
        Eigen::Vector3d down = n[2] * n - Eigen::Vector3d::UnitZ();
        if (down.norm() < 1e-6) down = n.cross(Eigen::Vector3d::UnitY());
        down.normalize();
        const Eigen::Vector3d level = n.cross(down);
        const double friction = bodies_[touch.above].friction_or(friction_);
        for (const Vec3& p : touch.point) {
            for (const Eigen::Vector3d& t :
                 {down, Eigen::Vector3d(-down), level, Eigen::Vector3d(-level)}) {
                Force force;
                force.above = touch.above;
                force.below = touch.below;
                force.along = n + sure_friction * friction * t;
                force.turns_above =
                    (eigen(p) - eigen(bodies_[touch.above].center_m)).cross(force.along);
                force.turns_below =
                    (eigen(p) - eigen(bodies_[touch.below].center_m)).cross(force.along);
                weigh(force);
                forces_.push_back(force);
            }
        }
    }
    void weigh(Force& force) const {
        force.spins_above = supple_[force.above] * force.turns_above;
        force.spins_below = supple_[force.below] * force.turns_below;
        force.yields = (light_[force.above] + light_[force.below]) * force.along.squaredNorm() +
                       force.turns_above.dot(force.spins_above) +
                       force.turns_below.dot(force.spins_below);
    }
    void apply(const Force& force, double newtons) {
        move_[force.above] += newtons * light_[force.above] * force.along;
        move_[force.below] -= newtons * light_[force.below] * force.along;
        turn_[force.above] += newtons * force.spins_above;
        turn_[force.below] -= newtons * force.spins_below;
    }

    const std::vector<Body>& bodies_;
    double friction_, gravity_m_s2_;
    std::vector<double> light_;            // 1 / mass; 0: it does not move
    std::vector<Eigen::Matrix3d> supple_;  // inverse of the inertia
    std::vector<double> reach_m_;
    std::vector<Force> forces_;
    std::vector<Eigen::Vector3d> move_, turn_;  // accelerations
};

}  // namespace

void keep_balance(std::vector<Body>& bodies, const Scenery& scenery) {
    Statics statics(bodies, scenery.friction, scenery.gravity_m_s2);
    while (true) {
        const std::vector<double> a_m_s2 = statics.accelerations_m_s2();
        // What carries the others is the cause; of several the one that moves most.
        std::optional<std::size_t> worst;
        double most = 0;
        for (std::size_t n = 0; n < bodies.size(); ++n) {
            if (bodies[n].fixed || bodies[n].parts.empty() || !(bodies[n].firm_m > 0)) continue;
            const double a = a_m_s2[n];
            if (!(a > at_rest_share * scenery.gravity_m_s2)) continue;
            if (worst && (bodies[n].level > bodies[*worst].level ||
                          (bodies[n].level == bodies[*worst].level && a <= most)))
                continue;
            worst = n;
            most = a;
        }
        if (!worst) return;
        if (!bodies[*worst].on_pad && put_on_pad(bodies, *worst, scenery.thick_m)) {
            statics.extend();
            continue;
        }
        bodies[*worst].fixed = bodies[*worst].held = true;
        statics.hold(*worst);
    }
}

}  // namespace topple::exports
