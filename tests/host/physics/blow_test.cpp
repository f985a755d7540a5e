// SPDX-License-Identifier: MIT
#include "physics/blow.h"

#include "core/random.h"
#include "physics/landscape.h"
#include "testing.h"

namespace topple::physics {
namespace {

// A block of half width b and half height h.
Upright block(double b, double h) {
    return {b, b, h, std::sqrt((b * b + h * h) / 3)};
}
double rise(const Upright& body) {
    return gravity * (std::hypot(body.ahead_m, body.height_m) - body.height_m);
}
double energy(const Upright& body, double z, double v) {
    return v * v / 2 * free_share(body, z);
}

// A body in a plane that stands on two points, in small steps: what is struck at height z with the
// speed v, and how it ends. It shares nothing with the closed forms: contacts are complementarity
// of velocities, solved by projected Gauss-Seidel (Moreau's scheme), and angles are of any size.
class PlaneBody {
  public:
    PlaneBody(const Upright& body, double friction)
        : foot_{{{body.ahead_m, -body.height_m}, {-body.behind_m, -body.height_m}}},
          k2_(body.gyration_m * body.gyration_m),
          mu_(friction),
          h_(body.height_m),
          ahead_(std::atan2(body.ahead_m, body.height_m)),
          behind_(std::atan2(body.behind_m, body.height_m)) {}

    // 1: over the edge ahead, -1: over the one behind, 0: neither.
    int falls(double z, double v) {
        z_ = h_;
        angle_ = 0;
        speed_ = {v, 0, v * (z - h_) / k2_};  // along, up, turning ahead
        for (int n = 0; n < 16000; ++n) {
            step();
            if (angle_ > ahead_ + 0.05) return 1;
            if (angle_ < -behind_ - 0.05) return -1;
            if (n > 200 && std::abs(speed_[0]) + std::abs(speed_[1]) + std::abs(speed_[2]) < 1e-4)
                return 0;
        }
        return 0;
    }

  private:
    void step() {
        constexpr double dt = 2e-4;
        speed_[1] -= gravity * dt;
        const double s = std::sin(angle_), c = std::cos(angle_);
        std::array<double, 2> x{}, y{}, pressed{}, rubbed{};
        std::array<bool, 2> touches{};
        for (std::size_t f = 0; f < 2; ++f) {
            x[f] = foot_[f][0] * c + foot_[f][1] * s;  // turned ahead, from the centre
            y[f] = -foot_[f][0] * s + foot_[f][1] * c;
            touches[f] = z_ + y[f] <= 1e-6;
        }
        // A point at (x, y) moves by (w y, -w x) for turning ahead at w.
        for (int sweep = 0; sweep < 40; ++sweep) {
            for (std::size_t f = 0; f < 2; ++f) {
                if (!touches[f]) continue;
                const double up = speed_[1] - speed_[2] * x[f];
                const double press =
                    std::max(0.0, pressed[f] - up / (1 + x[f] * x[f] / k2_)) - pressed[f];
                pressed[f] += press;
                speed_[1] += press;
                speed_[2] -= press * x[f] / k2_;
                const double along = speed_[0] + speed_[2] * y[f];
                const double most = mu_ * pressed[f];
                const double rub =
                    std::clamp(rubbed[f] - along / (1 + y[f] * y[f] / k2_), -most, most) -
                    rubbed[f];
                rubbed[f] += rub;
                speed_[0] += rub;
                speed_[2] += rub * y[f] / k2_;
            }
        }
        z_ += speed_[1] * dt;
        angle_ += speed_[2] * dt;
        // What of the step went into the ground is taken back.
        double deepest = 0;
        for (const auto& foot : foot_)
            deepest =
                std::min(deepest, z_ - foot[0] * std::sin(angle_) + foot[1] * std::cos(angle_));
        z_ -= deepest;
    }

    std::array<std::array<double, 2>, 2> foot_;
    double k2_, mu_, h_, ahead_, behind_;
    double z_ = 0, angle_ = 0;
    std::array<double, 3> speed_{};
};

// Where the edge holds, the angular momentum about it is what counts: z v of it against
// (k^2 + R^2) w, so that the energy is the barrier times (k^2 + R^2) (k^2 + (z - h)^2) / (k z)^2.
TEST(Blow, OnRoughGroundTurnsAboutTheEdge) {
    const Upright body = block(0.05, 0.15);
    const double k2 = body.gyration_m * body.gyration_m, z = 0.22, R2 = 0.05 * 0.05 + 0.15 * 0.15;
    const double W = energy(body, z, tips_ahead_m_s(body, z, 0.6));
    EXPECT_NEAR(W, rise(body) * (k2 + R2) * (k2 + (z - 0.15) * (z - 0.15)) / (k2 * z * z), 1e-12);
    // The best height, on ground that is rough enough at each, is h + k^2 / h, and takes the
    // barrier times 1 + b^2 / (h^2 + k^2).
    const double best = 0.15 + k2 / 0.15;
    EXPECT_NEAR(energy(body, best, tips_ahead_m_s(body, best, 0.9)),
                rise(body) * (1 + 0.05 * 0.05 / (0.15 * 0.15 + k2)), 1e-12);
}

// On ice an edge can only be pressed down: W (z - h) counts, and the centre falls straight.
// On ice the edge slips backwards until the body turns at v / h, and is at rest. So far angles are
// taken to be small, and what turns keeps the inertia k^2 + b^2 of the start: a part of its energy
// is lost. From there on it is kept, and must raise the centre over the edge.
double least_on_ice(double b, double h, double k2, double arm) {
    const auto goes_over = [&](double v) {
        const double inertia = k2 + b * b, rate = arm * v / inertia, rest = v / h;
        const double climbed = inertia * (rate * rate - rest * rest) / (2 * gravity);
        const double beyond = b * b - 2 * h * climbed;
        if (beyond < 0) return true;
        const double angle = (b - std::sqrt(beyond)) / h;
        const double beside = b * std::cos(angle) - h * std::sin(angle),
                     high = h * std::cos(angle) + b * std::sin(angle);
        return (k2 + beside * beside) * rest * rest / 2 >= gravity * (std::hypot(b, h) - high);
    };
    double low = 0, high = 1;
    for (int n = 0; n < 60; ++n) {
        const double middle = 0.5 * (low + high);
        (goes_over(middle) ? high : low) = middle;
    }
    return high;
}

TEST(Blow, OnIceNothingButTheBlowTurns) {
    const Upright body = block(0.05, 0.15);
    const double k2 = body.gyration_m * body.gyration_m, z = 0.25, arm = z - 0.15;
    const double found = tips_ahead_m_s(body, z, 0), expected = least_on_ice(0.05, 0.15, k2, arm);
    EXPECT_NEAR(found, expected, expected / 256) << "to which speeds are found";
    // rate w = v (z - h) / (k^2 + b^2), and (k^2 + b^2) w^2 / 2 = the barrier: a thirtieth less.
    const double v = std::sqrt(2 * rise(body) * (k2 + 0.05 * 0.05)) / arm;
    EXPECT_NEAR(expected / v, 1.032, 0.001);
    EXPECT_TRUE(std::isinf(tips_ahead_m_s(body, 0.15, 0))) << "at the centre it glides away";
    EXPECT_TRUE(std::isinf(tips_behind_m_s(body, 0.15, 0)));
    EXPECT_NEAR(sliding_share(body, 0.15, 0.3), 1, 1e-12);
}

// Struck low, a tall thing is thrown backwards; a flat thing slides, wherever it is struck.
TEST(Blow, FlatThingsSlideAndTallOnesTip) {
    const Upright tall = block(0.03, 0.15), book = block(0.1, 0.015);
    EXPECT_LT(energy(tall, 0.25, tips_ahead_m_s(tall, 0.25, 0.3)), 1.3 * rise(tall));
    EXPECT_GT(energy(tall, 0.03, tips_ahead_m_s(tall, 0.03, 0.3)), 2 * rise(tall));
    for (const double z : {0.002, 0.015, 0.028}) {
        const double tip = std::min(tips_ahead_m_s(book, z, 0.3), tips_behind_m_s(book, z, 0.3));
        EXPECT_GT(energy(book, z, tip), 4 * rise(book)) << z;
        EXPECT_GT(sliding_share(book, z, 0.3), 0.9) << z;
    }
}

TEST(Blow, NoneTakesLessThanTheBarrier) {
    Random random(3);
    for (int n = 0; n < 3000; ++n) {
        Upright body = block(random.uniform(0.01, 0.3), random.uniform(0.01, 0.6));
        body.behind_m = random.uniform(0.01, 0.3);
        body.gyration_m *= random.uniform(0.7, 1.4);
        const double z = random.uniform(0, 2 * body.height_m), mu = random.uniform(0, 1);
        const double v = tips_ahead_m_s(body, z, mu);
        if (std::isfinite(v)) {
            EXPECT_GE(energy(body, z, v), rise(body) * (1 - 1e-9)) << n;
        }
        const double share = sliding_share(body, z, mu);
        EXPECT_GE(share, 0);
        EXPECT_LE(share, 1 + 1e-12);
    }
}

TEST(Blow, AgreesWithABodyInSmallSteps) {
    Random random(1);
    int above = 0, above_near = 0, below = 0, below_near = 0;
    for (int n = 0; n < 120; ++n) {
        Upright body = block(random.uniform(0.02, 0.12), random.uniform(0.06, 0.3));
        if (body.ahead_m > 0.8 * body.height_m) continue;
        body.gyration_m *= random.uniform(0.85, 1.15);
        body.behind_m *= random.uniform(0.7, 1.3);
        const double mu = random.uniform(0.2, 0.6);
        const double z = random.uniform(0.1, 2.0) * body.height_m;
        const double own = std::min(tips_ahead_m_s(body, z, mu), tips_behind_m_s(body, z, mu));
        const double most = std::sqrt(2 * 12 * rise(body) / free_share(body, z));
        PlaneBody plane(body, mu);
        if (!(own < most) && plane.falls(z, most) == 0) continue;  // neither says that it falls
        const double more = std::sqrt(1.25);
        const bool near =
            own < most && plane.falls(z, own * more) != 0 && plane.falls(z, own / more) == 0;
        if (z >= body.height_m) {
            ++above;
            above_near += near;
        } else {
            ++below;
            below_near += near;
        }
    }
    std::printf("within 25 %% of the energy: %d of %d struck above the centre, %d of %d below\n",
                above_near, above, below_near, below);
    EXPECT_GE(above, 40);
    EXPECT_GE(above_near, 0.9 * above);
    EXPECT_GE(below, 30);
    EXPECT_GE(below_near, 0.75 * below);
}

}  // namespace
}  // namespace topple::physics
