// SPDX-License-Identifier: MIT
#include "io/voxel_mesh.h"

#include <algorithm>
#include <tuple>

namespace topple::io {
namespace {

using Cell = std::array<std::int32_t, 3>;

// Faces of voxels, across axis `axis` at plane `w`: from corner (u[0], v[0]) to (u[1], v[1]), along
// the next axis and the one after it.
struct Rectangle {
    std::size_t axis = 0;
    bool upper = false;  // seen from the axis's positive side
    std::int32_t w = 0;
    std::array<std::int32_t, 2> u{}, v{};

    Cell at(std::int32_t along_u, std::int32_t along_v) const {
        Cell p{};
        p[axis] = w;
        p[(axis + 1) % 3] = along_u;
        p[(axis + 2) % 3] = along_v;
        return p;
    }
};

// One run of faces beside each other along v.
struct Run {
    bool upper;
    std::int32_t w, u, low, high;
    auto order() const { return std::tuple(upper, w, u, low); }
};

// Whether rectangles must end there.
bool ends_at(std::int32_t at, std::int32_t longest) {
    return longest > 0 && at % longest == 0;
}

// The runs of faces across one axis.
std::vector<Run> runs_across(std::size_t axis, std::span<const Cell> voxels, std::int32_t longest) {
    const std::size_t a = axis, b = (axis + 1) % 3, c = (axis + 2) % 3;
    std::vector<Cell> along(voxels.begin(), voxels.end());  // columns along the axis
    std::sort(along.begin(), along.end(), [&](const Cell& p, const Cell& q) {
        return std::tuple(p[b], p[c], p[a]) < std::tuple(q[b], q[c], q[a]);
    });
    std::vector<Run> faces;
    for (std::size_t n = 0; n < along.size(); ++n) {
        const Cell& p = along[n];
        const auto touches = [&](std::size_t m, std::int32_t step) {
            return along[m][b] == p[b] && along[m][c] == p[c] && along[m][a] == p[a] + step;
        };
        if (n == 0 || !touches(n - 1, -1)) faces.push_back({false, p[a], p[b], p[c], p[c] + 1});
        if (n + 1 == along.size() || !touches(n + 1, 1))
            faces.push_back({true, p[a] + 1, p[b], p[c], p[c] + 1});
    }
    std::sort(faces.begin(), faces.end(),
              [](const Run& p, const Run& q) { return p.order() < q.order(); });
    std::vector<Run> runs;
    for (const Run& face : faces) {
        const bool goes_on = !runs.empty() && runs.back().upper == face.upper &&
                             runs.back().w == face.w && runs.back().u == face.u &&
                             runs.back().high == face.low && !ends_at(face.low, longest);
        if (goes_on) {
            runs.back().high = face.high;
        } else {
            runs.push_back(face);
        }
    }
    return runs;
}

// Runs of one length and place side by side become one rectangle.
void append_rectangles(std::size_t axis, const std::vector<Run>& runs, std::int32_t longest,
                       std::vector<Rectangle>& out) {
    std::vector<Rectangle> open, next;  // that end at the row before, and at this one, by v
    for (std::size_t first = 0; first < runs.size();) {
        std::size_t end = first;
        next.clear();
        std::size_t candidate = 0;
        const Run& row = runs[first];
        const bool follows = !open.empty() && open[0].upper == row.upper && open[0].w == row.w &&
                             open[0].u[1] == row.u && !ends_at(row.u, longest);
        if (!follows) {
            out.insert(out.end(), open.begin(), open.end());
            open.clear();
        }
        for (; end < runs.size() && runs[end].upper == row.upper && runs[end].w == row.w &&
               runs[end].u == row.u;
             ++end) {
            const Run& run = runs[end];
            while (candidate < open.size() && open[candidate].v[0] < run.low)
                out.push_back(open[candidate++]);
            if (candidate < open.size() && open[candidate].v == std::array{run.low, run.high}) {
                next.push_back(open[candidate++]);
                next.back().u[1] = run.u + 1;
            } else {
                next.push_back({axis, run.upper, run.w, {run.u, run.u + 1}, {run.low, run.high}});
            }
        }
        out.insert(out.end(), open.begin() + static_cast<std::ptrdiff_t>(candidate), open.end());
        std::swap(open, next);
        first = end;
    }
    out.insert(out.end(), open.begin(), open.end());
}

class Builder {
  public:
    explicit Builder(const std::vector<Rectangle>& rectangles) {
        for (const Rectangle& r : rectangles) {
            for (const auto u : r.u) {
                for (const auto v : r.v) corners_.push_back(r.at(u, v));
            }
        }
        std::sort(corners_.begin(), corners_.end());
        corners_.erase(std::unique(corners_.begin(), corners_.end()), corners_.end());
        for (const Cell& c : corners_)
            mesh_.vertex.push_back({double(c[0]), double(c[1]), double(c[2])});
    }

    void add(const Rectangle& r) {
        border_.clear();
        // Against the clock, seen from the axis's positive side.
        side(r, {r.u[0], r.v[0]}, {r.u[1], r.v[0]});
        side(r, {r.u[1], r.v[0]}, {r.u[1], r.v[1]});
        side(r, {r.u[1], r.v[1]}, {r.u[0], r.v[1]});
        side(r, {r.u[0], r.v[1]}, {r.u[0], r.v[0]});
        if (!r.upper) std::reverse(border_.begin(), border_.end());
        if (border_.size() == 4) {
            mesh_.triangle.push_back({border_[0], border_[1], border_[2]});
            mesh_.triangle.push_back({border_[0], border_[2], border_[3]});
            return;
        }
        // Other rectangles' corners lie on its sides: a fan around its middle has no flat triangle.
        const auto middle = static_cast<std::uint32_t>(mesh_.vertex.size());
        Vec3 p{};
        p[r.axis] = r.w;
        p[(r.axis + 1) % 3] = 0.5 * (double(r.u[0]) + r.u[1]);
        p[(r.axis + 2) % 3] = 0.5 * (double(r.v[0]) + r.v[1]);
        mesh_.vertex.push_back(p);
        for (std::size_t n = 0; n < border_.size(); ++n)
            mesh_.triangle.push_back({middle, border_[n], border_[(n + 1) % border_.size()]});
    }

    TriangleMesh finish() { return std::move(mesh_); }

  private:
    using Place = std::array<std::int32_t, 2>;

    // The corners of any rectangle along one side, but for the last.
    void side(const Rectangle& r, Place from, const Place& to) {
        const Place step{(to[0] > from[0]) - (to[0] < from[0]),
                         (to[1] > from[1]) - (to[1] < from[1])};
        for (; from != to; from = {from[0] + step[0], from[1] + step[1]}) {
            const Cell p = r.at(from[0], from[1]);
            const auto found = std::lower_bound(corners_.begin(), corners_.end(), p);
            if (found != corners_.end() && *found == p)
                border_.push_back(static_cast<std::uint32_t>(found - corners_.begin()));
        }
    }

    TriangleMesh mesh_;
    std::vector<Cell> corners_;
    std::vector<std::uint32_t> border_;
};

}  // namespace

TriangleMesh voxel_boundary(std::span<const Cell> voxels, std::int32_t longest) {
    std::vector<Rectangle> rectangles;
    for (std::size_t axis = 0; axis < 3; ++axis)
        append_rectangles(axis, runs_across(axis, voxels, longest), longest, rectangles);
    Builder builder(rectangles);
    for (const Rectangle& r : rectangles) builder.add(r);
    return builder.finish();
}

}  // namespace topple::io
