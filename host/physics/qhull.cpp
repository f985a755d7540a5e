// SPDX-License-Identifier: MIT
#include "physics/qhull.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <new>

// Last: its macros are many.
extern "C" {
#include <libqhull_r/qhull_ra.h>
}

namespace topple::physics {
namespace {

// Qhull writes its complaints to a file; a scratch stream keeps the library silent.
class Silence {
  public:
    Silence() : stream_(open_memstream(&text_, &length_)) {
        if (!stream_) throw std::bad_alloc();
    }
    Silence(const Silence&) = delete;
    Silence& operator=(const Silence&) = delete;
    ~Silence() {
        std::fclose(stream_);
        std::free(text_);
    }
    std::FILE* stream() const { return stream_; }

  private:
    char* text_ = nullptr;
    std::size_t length_ = 0;
    std::FILE* stream_ = nullptr;
};

class Qhull {
  public:
    explicit Qhull(std::span<const std::array<double, 3>> points) {
        for (const auto& p : points) coordinates_.insert(coordinates_.end(), p.begin(), p.end());
        qh_zero(&state_, silence_.stream());
        char options[] = "qhull ";
        failed_ = qh_new_qhull(&state_, 3, static_cast<int>(points.size()), coordinates_.data(),
                               False, options, nullptr, silence_.stream());
    }
    Qhull(const Qhull&) = delete;
    Qhull& operator=(const Qhull&) = delete;
    ~Qhull() {
        qh_freeqhull(&state_, !qh_ALL);
        int current = 0, total = 0;
        qh_memfreeshort(&state_, &current, &total);
    }
    // Throws std::bad_alloc where that is why.
    bool failed() const {
        if (failed_ == qh_ERRmem) throw std::bad_alloc();
        return failed_ != 0;
    }

    std::vector<std::uint32_t> vertices() {
        qhT* qh = &state_;
        std::vector<std::uint32_t> found;
        vertexT* vertex;
        FORALLvertices {
            found.push_back(number(vertex));
        }
        std::sort(found.begin(), found.end());
        return found;
    }

    // Empty where Qhull's ridges don't make loops.
    std::vector<std::vector<std::uint32_t>> faces() {
        qhT* qh = &state_;
        std::vector<std::vector<std::uint32_t>> found;
        facetT* facet;
        FORALLfacets {
            auto loop = facet->simplicial ? triangle(facet) : chain(facet);
            if (loop.size() < 3) return {};
            if (along(loop, facet->normal) < 0) std::reverse(loop.begin(), loop.end());
            found.push_back(std::move(loop));
        }
        return found;
    }

  private:
    std::uint32_t number(const vertexT* vertex) {
        return static_cast<std::uint32_t>(qh_pointid(&state_, vertex->point));
    }
    std::vector<std::uint32_t> triangle(const facetT* facet) {
        std::vector<std::uint32_t> corners;
        vertexT *vertex, **vertexp;
        FOREACHvertex_(facet->vertices) corners.push_back(number(vertex));
        return corners;
    }
    // The corners of a face of many ridges, from ridge to ridge.
    std::vector<std::uint32_t> chain(const facetT* facet) {
        std::map<std::uint32_t, std::vector<std::uint32_t>> beside;
        ridgeT *ridge, **ridgep;
        FOREACHridge_(facet->ridges) {
            const std::uint32_t a = number(SETfirstt_(ridge->vertices, vertexT)),
                                b = number(SETsecondt_(ridge->vertices, vertexT));
            beside[a].push_back(b);
            beside[b].push_back(a);
        }
        std::vector<std::uint32_t> loop;
        if (beside.empty()) return loop;
        std::uint32_t at = beside.begin()->first, before = at;
        do {
            const auto& next = beside[at];
            if (next.size() != 2 || loop.size() == beside.size()) return {};
            loop.push_back(at);
            const std::uint32_t step = next[0] != before ? next[0] : next[1];
            before = at;
            at = step;
        } while (at != loop.front());
        return loop.size() == beside.size() ? loop : std::vector<std::uint32_t>{};
    }
    // Twice the loop's area, signed, as seen against the normal.
    double along(const std::vector<std::uint32_t>& loop, const coordT* normal) const {
        const auto at = [&](std::uint32_t n, std::size_t a) {
            return coordinates_[std::size_t{n} * 3 + a] -
                   coordinates_[std::size_t{loop[0]} * 3 + a];
        };
        double sum = 0;
        for (std::size_t n = 1; n + 1 < loop.size(); ++n) {
            for (std::size_t a = 0; a < 3; ++a) {
                const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
                sum += normal[a] *
                       (at(loop[n], b) * at(loop[n + 1], c) - at(loop[n], c) * at(loop[n + 1], b));
            }
        }
        return sum;
    }
    Silence silence_;
    std::vector<coordT> coordinates_;
    qhT state_;
    int failed_ = 0;
};

}  // namespace

std::optional<ConvexHull> convex_hull(std::span<const std::array<double, 3>> points) {
    if (points.size() < 4) return std::nullopt;
    Qhull qhull(points);
    if (qhull.failed()) return std::nullopt;
    ConvexHull hull{qhull.vertices(), qhull.faces()};
    if (hull.faces.size() < 4) return std::nullopt;
    return hull;
}

}  // namespace topple::physics
