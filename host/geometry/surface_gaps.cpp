// SPDX-License-Identifier: MIT
#include "geometry/surface_gaps.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/place.h"
#include "core/rows.h"

namespace topple::geometry {
namespace {

using Point = std::array<float, 3>;

// Cells that hold a point already, 4 x 4 x 4 to a word: an open-addressed table of words. Points
// come in rows, most of them to the word of the one before.
class Taken {
  public:
    // Whether it was not taken yet.
    bool take(const Place& cell) {
        const Place at{cell[0] >> 2, cell[1] >> 2, cell[2] >> 2};
        if (count_ == 0 || at != words_[last_].at) last_ = slot_of(at);
        const std::uint64_t bit = std::uint64_t{1}
                                  << ((cell[0] & 3) << 4 | (cell[1] & 3) << 2 | (cell[2] & 3));
        std::uint64_t& cells = words_[last_].cells;
        const bool is_new = (cells & bit) == 0;
        cells |= bit;
        return is_new;
    }

  private:
    struct Word {
        std::uint64_t cells = 0;  // none where the slot is free
        Place at{};
    };
    // Of the word, or of the free slot that it is to have.
    std::size_t find(const Place& at) const {
        std::uint64_t hash = 0;
        for (const std::int32_t k : at)
            hash = (hash ^ static_cast<std::uint32_t>(k)) * 0x9e3779b97f4a7c15U;
        const std::size_t mask = words_.size() - 1;
        std::size_t slot = (hash >> 20) & mask;
        while (words_[slot].cells != 0 && words_[slot].at != at) slot = (slot + 1) & mask;
        return slot;
    }
    std::size_t slot_of(const Place& at) {
        if (2 * (count_ + 1) > words_.size()) grow();
        const std::size_t slot = find(at);
        if (words_[slot].cells == 0) {
            ++count_;
            words_[slot].at = at;
        }
        return slot;
    }
    void grow() {
        std::vector<Word> before(std::max<std::size_t>(2 * words_.size(), 64));
        before.swap(words_);
        for (const Word& word : before)
            if (word.cells != 0) words_[find(word.at)] = word;
    }
    std::vector<Word> words_;
    std::size_t count_ = 0, last_ = 0;
};

// Points on the triangles of one primitive.
class Closing {
  public:
    Closing(const Surfels& surfels, double step_m)
        : s_(surfels), step_(static_cast<float>(step_m)) {}

    void cover(const std::array<std::size_t, 3>& corner, std::int32_t face) {
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
                Place cell{};
                for (std::size_t k = 0; k < 3; ++k) {
                    p[k] = t[0][k] + a * (t[1][k] - t[0][k]) + b * (t[2][k] - t[0][k]);
                    cell[k] = static_cast<std::int32_t>(
                        std::clamp(std::floor(p[k] / step_), -2e9F, 2e9F));
                }
                if (!taken_.take(cell)) continue;
                out_.x.push_back(p[0]);
                out_.y.push_back(p[1]);
                out_.z.push_back(p[2]);
                out_.face.push_back(face);
                out_.surfel.push_back(static_cast<std::uint32_t>(corner[0]));
            }
        }
    }
    GapPoints finish() { return std::move(out_); }

  private:
    Point at(std::size_t n) const { return {s_.x[n], s_.y[n], s_.z[n]}; }
    static float distance(const Point& p, const Point& q) {
        const float x = p[0] - q[0], y = p[1] - q[1], z = p[2] - q[2];
        return std::sqrt(x * x + y * y + z * z);
    }
    const Surfels& s_;
    float step_;
    Taken taken_;
    GapPoints out_;
};

GapPoints close_primitive(const Surfels& s, std::span<const std::int32_t> face,
                          std::span<const std::int32_t> primitive,
                          std::span<const std::uint32_t> members, double step_m) {
    Closing closing(s, step_m);
    // What is on one face comes first.
    for (const bool one_face : {true, false}) {
        for (const std::uint32_t a : members) {
            for (const std::uint32_t b : s.around(a)) {
                if (b <= a || primitive[b] != primitive[a]) continue;
                if (one_face && face[a] != face[b]) continue;
                for (const std::uint32_t c : s.around(b)) {
                    if (c <= b || primitive[c] != primitive[a]) continue;
                    if (one_face != (face[a] == face[b] && face[a] == face[c])) continue;
                    if (std::ranges::binary_search(s.around(a), c))
                        closing.cover({a, b, c}, one_face ? face[a] : -1);
                }
            }
        }
    }
    return closing.finish();
}

}  // namespace

GapPoints close_gaps(const Surfels& s, std::span<const std::int32_t> face,
                     std::span<const std::int32_t> primitive, double step_m, ThreadPool& pool) {
    std::int32_t primitives = 0;
    for (const std::int32_t p : primitive) primitives = std::max(primitives, p + 1);
    const auto members = places_by_label(primitive, static_cast<std::size_t>(primitives));
    std::vector<GapPoints> closed(members.size());
    pool.each(members.size(), 1, [&](std::size_t p) {
        closed[p] = close_primitive(s, face, primitive, members[p], step_m);
    });
    GapPoints out;
    const auto append = [](auto& to, const auto& from) {
        to.insert(to.end(), from.begin(), from.end());
    };
    for (std::size_t p = 0; p < closed.size(); ++p) {
        append(out.x, closed[p].x);
        append(out.y, closed[p].y);
        append(out.z, closed[p].z);
        append(out.face, closed[p].face);
        append(out.surfel, closed[p].surfel);
        out.primitive.resize(out.x.size(), static_cast<std::int32_t>(p));
        closed[p] = {};
    }
    return out;
}

PointCloud with_gaps(const CloudView& cloud, const GapPoints& gaps) {
    PointCloud out;
    const auto joined = [](const auto& first, const std::vector<float>& then) {
        std::vector<float> all;
        all.reserve(first.size() + then.size());
        for (const float v : first) all.push_back(v);
        all.insert(all.end(), then.begin(), then.end());
        return all;
    };
    out.x = joined(cloud.x, gaps.x);
    out.y = joined(cloud.y, gaps.y);
    out.z = joined(cloud.z, gaps.z);
    return out;
}

}  // namespace topple::geometry
