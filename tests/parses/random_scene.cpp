// SPDX-License-Identifier: MIT
#include "parses/random_scene.h"

#include "core/random.h"

namespace topple::parses {
namespace {

double normal(Random& random) {
    return std::sqrt(-2 * std::log(1 - random.uniform())) * std::cos(2 * M_PI * random.uniform());
}

bool chance(Random& random, double share) {
    return random.uniform() < share;
}

class Maker {
  public:
    Maker(std::uint64_t seed, bool small) : random_(seed), small_(small) {}

    PointCloud cloud() {
        spacing_ = random_.uniform(0.03, 0.09) * (small_ ? 2.5 : 1);
        noise_ = chance(random_, 0.5) ? 0 : random_.uniform(0, 0.5) * spacing_;
        normals_ = chance(random_, 0.4);
        turn_ = random_.uniform(0, 2 * M_PI);
        if (small_ && chance(random_, 0.7)) {
            image();
        } else if (chance(random_, 0.15)) {
            odd();
        } else {
            if (!chance(random_, 0.1)) floor();
            const std::uint64_t things = random_.below(small_ ? 4 : 7);
            for (std::uint64_t n = 0; n < things; ++n) thing();
        }
        damage();
        return std::move(cloud_);
    }

    ParseOptions options() {
        ParseOptions o;
        const auto pick = [&](auto& value, double low, double high, double wrong) {
            if (chance(random_, 0.33)) value = random_.uniform(low, high);
            if (chance(random_, 0.03)) value = wrong;
        };
        const double nan = std::numeric_limits<double>::quiet_NaN();
        if (small_) o.voxel_m = random_.uniform(0.07, 0.2);
        pick(o.voxel_m, small_ ? 0.05 : 0.01, small_ ? 0.3 : 0.1,
             chance(random_, 0.5) ? 1e-9 : nan);
        pick(o.density_kg_m3, 1, 20000, -1);
        pick(o.friction, 0.001, 5, nan);
        pick(o.wind_m_s, 0.1, 150, 1e9);
        pick(o.tolerable_J, 1e-6, 1e6, 0);
        if (chance(random_, 0.2)) pick(o.wind_from_deg.emplace(0), -360, 360, nan);
        if (chance(random_, 0.2)) pick(o.pga_m_s2.emplace(1), 0.01, 50, -2);
        if (chance(random_, 0.1)) o.up = Vec3{normal(random_), normal(random_), normal(random_)};
        if (o.up) {
            const double length = std::hypot((*o.up)[0], (*o.up)[1], (*o.up)[2]);
            for (double& v : *o.up) v /= length;
        }
        o.walks = static_cast<unsigned>(1 + random_.below(5));
        o.seed = random_.bits();
        o.disturbances.clear();
        for (const char* name : {"human", "wind", "earthquake"})
            if (chance(random_, 0.3)) o.disturbances.emplace_back(name);
        o.coordinates = !chance(random_, 0.2);
        return o;
    }

  private:
    void add(double x, double y, double z, const Vec3& n) {
        // Turned about z, as the rooms that one finds are.
        const double c = std::cos(turn_), s = std::sin(turn_);
        const auto put = [&](std::vector<float>& to, double v) {
            to.push_back(static_cast<float>(v + noise_ * normal(random_)));
        };
        put(cloud_.x, c * x - s * y);
        put(cloud_.y, s * x + c * y);
        put(cloud_.z, z);
        if (!normals_) return;
        cloud_.nx.push_back(static_cast<float>(c * n[0] - s * n[1]));
        cloud_.ny.push_back(static_cast<float>(s * n[0] + c * n[1]));
        cloud_.nz.push_back(static_cast<float>(n[2]));
    }

    void rectangle(const Vec3& corner, const Vec3& u, const Vec3& v, const Vec3& n) {
        const auto steps = [&](const Vec3& along) {
            const double length = std::hypot(along[0], along[1], along[2]);
            return static_cast<int>(std::min(60.0, length / spacing_)) + 1;
        };
        const int across = steps(u), up = steps(v);
        for (int i = 0; i <= across; ++i) {
            for (int j = 0; j <= up; ++j) {
                const double a = static_cast<double>(i) / across, b = static_cast<double>(j) / up;
                add(corner[0] + a * u[0] + b * v[0], corner[1] + a * u[1] + b * v[1],
                    corner[2] + a * u[2] + b * v[2], n);
            }
        }
    }

    void floor() {
        const double side = random_.uniform(0.3, 1.2);
        rectangle({-side / 2, -side / 2, 0}, {side, 0, 0}, {0, side, 0}, {0, 0, 1});
        if (chance(random_, 0.3))
            rectangle({-side / 2, -side / 2, 0}, {side, 0, 0}, {0, 0, side}, {0, 1, 0});
    }

    // A box on the floor, on what came before, or in the air; sides may be missing.
    void thing() {
        const Vec3 size{random_.uniform(0.05, 0.6), random_.uniform(0.05, 0.6),
                        random_.uniform(0.03, 0.8)};
        Vec3 low{random_.uniform(-0.6, 0.6), random_.uniform(-0.6, 0.6), 0};
        if (top_ > 0 && chance(random_, 0.5)) low = {at_[0], at_[1], top_};
        if (chance(random_, 0.1)) low[2] += random_.uniform(-0.1, 0.5);
        const Vec3 x{size[0], 0, 0}, y{0, size[1], 0}, z{0, 0, size[2]};
        const Vec3 far{low[0] + size[0], low[1] + size[1], low[2] + size[2]};
        const double seen = chance(random_, 0.5) ? 1 : 0.6;
        const auto side = [&](const Vec3& corner, const Vec3& u, const Vec3& v, const Vec3& n) {
            if (chance(random_, seen)) rectangle(corner, u, v, n);
        };
        side({low[0], low[1], far[2]}, x, y, {0, 0, 1});
        side(low, x, z, {0, -1, 0});
        side({low[0], far[1], low[2]}, x, z, {0, 1, 0});
        side(low, y, z, {-1, 0, 0});
        side({far[0], low[1], low[2]}, y, z, {1, 0, 0});
        top_ = far[2];
        at_ = {low[0] + random_.uniform(-0.1, 0.1), low[1] + random_.uniform(-0.1, 0.1)};
    }

    // What a depth camera sees of boxes on a floor, as an organised cloud in its own frame. It
    // looks down a little, so that its up and the floor's are the same.
    void image() {
        const auto width = static_cast<std::uint32_t>(12 + random_.below(24)),
                   height = static_cast<std::uint32_t>(10 + random_.below(16));
        const double focal = random_.uniform(0.6, 1.4) * width, down = random_.uniform(0.1, 1.2),
                     above = random_.uniform(0.4, 1.5);
        struct Box {
            Vec3 low, high;
        };
        std::vector<Box> boxes;  // x right, y up from the floor, z ahead
        for (std::uint64_t n = random_.below(6); n > 0; --n) {
            const Vec3 low{random_.uniform(-1, 0.8),
                           chance(random_, 0.2) ? random_.uniform(0, 0.6) : 0,
                           random_.uniform(0.3, 2)};
            boxes.push_back(
                {low,
                 {low[0] + random_.uniform(0.05, 0.7), low[1] + random_.uniform(0.05, 0.9),
                  low[2] + random_.uniform(0.05, 0.7)}});
        }
        if (!chance(random_, 0.1)) boxes.push_back({{-9, -1, -9}, {9, 0, 9}});
        cloud_.width = width;
        cloud_.height = height;
        const double c = std::cos(down), s = std::sin(down);
        for (std::uint32_t pixel = 0; pixel < width * height; ++pixel) {
            const Vec3 ray{(pixel % width + 0.5 - width / 2.0) / focal,
                           (pixel / width + 0.5 - height / 2.0) / focal, 1};  // y down
            const Vec3 way{ray[0], -c * ray[1] - s, c - s * ray[1]}, from{0, above, 0};
            double nearest = 6;
            for (const Box& box : boxes) {
                double in = 0, out = nearest;
                for (std::size_t a = 0; a < 3; ++a) {
                    const double t0 = (box.low[a] - from[a]) / way[a],
                                 t1 = (box.high[a] - from[a]) / way[a];
                    in = std::max(in, std::min(t0, t1));
                    out = std::min(out, std::max(t0, t1));
                }
                if (in < out) nearest = in;
            }
            if (nearest >= 6 || chance(random_, 0.02)) continue;
            nearest *= 1 + noise_ / 10 * normal(random_);
            for (const auto& [to, a] : {std::pair{&cloud_.x, 0}, {&cloud_.y, 1}, {&cloud_.z, 2}})
                to->push_back(static_cast<float>(nearest * ray[a]));
            cloud_.pixel.push_back(pixel);
        }
        normals_ = false;
        imaged_ = true;
    }

    void odd() {
        const auto count = static_cast<int>(1 + random_.below(600));
        const std::uint64_t kind = random_.below(6);
        const double scale = std::pow(10, random_.uniform(-4, 5));
        for (int n = 0; n < count; ++n) {
            const double t = static_cast<double>(n) / count;
            if (kind == 0) add(1, 2, 3, {0, 0, 1});
            if (kind == 1) add(t * scale, 2 * t * scale, 0, {1, 0, 0});
            if (kind == 2)
                add(normal(random_) * scale, normal(random_) * scale, normal(random_) * scale, {});
            if (kind == 3)
                add(n % 10 * spacing_, n / 10 % 10 * spacing_, n / 100 * spacing_, {0, 0, -1});
            if (kind == 4) add(std::cos(40 * t), std::sin(40 * t), t * scale / 1e4, {0, 0, 1});
            if (kind == 5)
                add(t < 0.5 ? 0 : scale, n % 20 * spacing_, n / 20 % 20 * spacing_, {1, 0, 0});
        }
    }

    void damage() {
        if (imaged_) return;  // its points are its pixels
        const float nan = std::numeric_limits<float>::quiet_NaN();
        if (chance(random_, 0.1)) {
            for (float& v : cloud_.x)
                if (chance(random_, 0.02)) v = nan;
        }
        if (normals_ && chance(random_, 0.2)) {
            for (float& v : cloud_.nz)
                if (chance(random_, 0.1)) v = chance(random_, 0.5) ? 0 : nan;
        }
        if (chance(random_, 0.1)) {
            const auto by = static_cast<float>(random_.uniform(-1000, 1000));
            for (float& v : cloud_.y) v += by;
        }
        if (chance(random_, 0.1)) {
            const std::size_t size = cloud_.x.size();
            for (auto* values :
                 {&cloud_.x, &cloud_.y, &cloud_.z, &cloud_.nx, &cloud_.ny, &cloud_.nz})
                values->reserve(2 * size);
            for (auto* values :
                 {&cloud_.x, &cloud_.y, &cloud_.z, &cloud_.nx, &cloud_.ny, &cloud_.nz})
                values->insert(values->end(), values->begin(), values->end());
        }
        if (chance(random_, 0.1)) {
            for (std::size_t n = 0; n < cloud_.x.size(); ++n) {
                cloud_.red.push_back(static_cast<std::uint8_t>(random_.below(256)));
                cloud_.green.push_back(static_cast<std::uint8_t>(random_.below(256)));
                cloud_.blue.push_back(static_cast<std::uint8_t>(random_.below(256)));
            }
        }
        if (chance(random_, 0.1)) {
            cloud_.has_viewpoint = true;
            cloud_.viewpoint = {normal(random_), normal(random_), normal(random_)};
        }
    }

    Random random_;
    bool small_;
    PointCloud cloud_;
    double spacing_ = 0.03, noise_ = 0, turn_ = 0, top_ = 0;
    std::array<double, 2> at_{};
    bool normals_ = false, imaged_ = false;
};

}  // namespace

RandomScene random_scene(std::uint64_t seed, bool small) {
    Maker maker(seed, small);
    RandomScene out;
    out.cloud = maker.cloud();
    out.options = maker.options();
    return out;
}

}  // namespace topple::parses
