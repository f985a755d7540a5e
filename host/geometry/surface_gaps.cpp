// SPDX-License-Identifier: MIT
#include "geometry/surface_gaps.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace topple::geometry {
namespace {

using Point = std::array<float, 3>;

// Cells of a primitive that hold a point already: an open-addressed table of keys.
class Taken {
  public:
    // Whether it was not taken yet.
    bool take(const std::array<std::int32_t, 3>& cell, std::int32_t primitive) {
        if (2 * (count_ + 1) > keys_.size()) grow();
        const Key key{cell[0], cell[1], cell[2], primitive};
        Key& slot = find(key);
        if (slot[3] >= 0) return false;
        slot = key;
        ++count_;
        return true;
    }

  private:
    using Key = std::array<std::int32_t, 4>;  // the last, a primitive, is negative where it is free
    Key& find(const Key& key) {
        std::uint64_t hash = 0;
        for (const std::int32_t k : key)
            hash = (hash ^ static_cast<std::uint32_t>(k)) * 0x9e3779b97f4a7c15U;
        std::size_t at = (hash >> 20) & (keys_.size() - 1);
        while (keys_[at][3] >= 0 && keys_[at] != key) at = (at + 1) & (keys_.size() - 1);
        return keys_[at];
    }
    void grow() {
        std::vector<Key> before(std::max<std::size_t>(2 * keys_.size(), 1024), Key{0, 0, 0, -1});
        before.swap(keys_);
        for (const Key& key : before)
            if (key[3] >= 0) find(key) = key;
    }
    std::vector<Key> keys_;
    std::size_t count_ = 0;
};

class Closing {
  public:
    Closing(const Surfels& surfels, double step_m)
        : s_(surfels), step_(static_cast<float>(step_m)) {}

    void cover(const std::array<std::size_t, 3>& corner, std::int32_t primitive,
               std::int32_t face) {
        const std::array<Point, 3> t{at(corner[0]), at(corner[1]), at(corner[2])};
        float side = 0;
        for (std::size_t n = 0; n < 3; ++n) side = std::max(side, distance(t[n], t[(n + 1) % 3]));
        if (side <= 2 * step_) return;
        const int steps = static_cast<int>(std::ceil(side / step_));
        for (int u = 0; u <= steps; ++u) {
            for (int v = 0; v <= steps - u; ++v) {
                const float a = static_cast<float>(u) / static_cast<float>(steps),
                            b = static_cast<float>(v) / static_cast<float>(steps);
                Point p{};
                std::array<std::int32_t, 3> cell{};
                for (std::size_t k = 0; k < 3; ++k) {
                    p[k] = t[0][k] + a * (t[1][k] - t[0][k]) + b * (t[2][k] - t[0][k]);
                    cell[k] = static_cast<std::int32_t>(
                        std::clamp(std::floor(p[k] / step_), -2e9F, 2e9F));
                }
                if (!taken_.take(cell, primitive)) continue;
                out_.x.push_back(p[0]);
                out_.y.push_back(p[1]);
                out_.z.push_back(p[2]);
                out_.primitive.push_back(primitive);
                out_.face.push_back(face);
            }
        }
    }
    GapPoints finish() { return std::move(out_); }

  private:
    Point at(std::size_t n) const { return {s_.x[n], s_.y[n], s_.z[n]}; }
    static float distance(const Point& p, const Point& q) {
        return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
    }
    const Surfels& s_;
    float step_;
    Taken taken_;
    GapPoints out_;
};

}  // namespace

GapPoints close_gaps(const Surfels& s, std::span<const std::int32_t> face,
                     std::span<const std::int32_t> primitive, double step_m) {
    const auto near = [&](std::size_t n) {
        return std::span(s.neighbours)
            .subspan(s.neighbour_first[n], s.neighbour_first[n + 1] - s.neighbour_first[n]);
    };
    Closing closing(s, step_m);
    // What is on one face comes first.
    for (const bool one_face : {true, false}) {
        for (std::size_t a = 0; a < s.size(); ++a) {
            if (primitive[a] < 0) continue;
            for (const std::uint32_t b : near(a)) {
                if (b <= a || primitive[b] != primitive[a]) continue;
                for (const std::uint32_t c : near(b)) {
                    if (c <= b || primitive[c] != primitive[a]) continue;
                    if (one_face != (face[a] == face[b] && face[a] == face[c])) continue;
                    if (std::ranges::binary_search(near(a), c))
                        closing.cover({a, b, c}, primitive[a], one_face ? face[a] : -1);
                }
            }
        }
    }
    return closing.finish();
}

}  // namespace topple::geometry
