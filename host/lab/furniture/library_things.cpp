// SPDX-License-Identifier: MIT
#include <algorithm>

#include "lab/furniture/things.h"

namespace topple::scenes {
namespace {

struct BookPlace {
    double from, to;  // along x
    double front;     // where the books' backs are, along y
    double bottom, height, depth;
    double sign;  // +1: they face +y
    bool flush;
    double full;
};

// Returns what stands on the shelf itself.
std::vector<int> add_books(Blueprint& b, const BookPlace& p, Random& random) {
    std::vector<int> lowest;
    const bool series = random.chance(0.35);
    const double least = series ? 0.97 : random(0.55, 0.9);
    const double even = random(0.02, 0.06);
    const double tall = p.height * random(0.75, 0.99);
    const auto put = [&](double x, double z, const Vec3& size) {
        const double in = p.flush ? 0 : random(0, 0.02);
        return b.box("volume", x, p.front - p.sign * (in + size[1] / 2), z, size);
    };
    for (double x = p.from; x < p.to;) {
        if (random.chance(0.08)) {  // some lie
            const double wide = random(0.14, 0.3);
            if (x + wide > p.to) break;
            double z = 0;
            for (int k = random.integer(1, 5); k > 0; --k) {
                const double t = random(0.015, 0.05);
                if (z + t > tall) break;
                const int book =
                    put(x + wide / 2, p.bottom + z, {wide, random(0.7, 0.9) * p.depth, t});
                if (z == 0) lowest.push_back(book);
                z += t;
            }
            x += wide + 0.002;
            continue;
        }
        const double t = series ? even : random(0.015, 0.06);
        if (x + t > p.to) break;
        if (random.uniform() > p.full) {
            x += random(0.5, 4) * t;
            continue;
        }
        const double deep = p.depth * (p.flush ? 0.9 : random(0.7, 0.9));
        lowest.push_back(put(x + t / 2, p.bottom, {t, deep, tall * random(least, 1)}));
        x += t + random(0.0002, 0.002);
    }
    return lowest;
}

}  // namespace

BookcaseMake any_bookcase_make(Random& random, double most_height) {
    BookcaseMake m{};
    m.width = random(0.6, 1.5);
    m.depth = random(0.22, 0.42);
    m.height = std::min(most_height, random(1.2, 2.4));
    m.shelves = std::max(2, static_cast<int>(m.height / random(0.28, 0.42)));
    m.two_sided = random.chance(0.5);
    m.back = random.chance(0.8);
    m.one = random.chance(0.5);
    m.full = random.chance(0.5) ? 1 : random(0.3, 0.98);
    m.flush = random.chance(0.6);
    return m;
}

Blueprint make_case_of_books(Random& random, const BookcaseMake& m) {
    Blueprint b("bookcase");
    const double t = 0.022, d = m.two_sided ? 2 * m.depth : m.depth;
    for (const double s : {-1.0, 1.0})
        b.foot(b.box("side", s * (m.width - t) / 2, 0, 0, {t, d, m.height}));
    const double inner = m.width - 2 * t, plinth = 0.08;
    const double wall = m.two_sided || m.back ? 0.01 : 0;
    const double wall_y = m.two_sided ? 0 : -d / 2 + wall / 2;
    if (wall > 0) b.box("back", 0, wall_y, plinth, {inner, wall, m.height - plinth});
    b.box("plinth", 0, 0, 0, {inner, d - 0.06, plinth});
    const double pitch = (m.height - plinth - t) / m.shelves;
    for (const double sign : {1.0, -1.0}) {
        if (sign < 0 && !m.two_sided) break;
        const double deep = m.two_sided ? d / 2 - wall / 2 : d - wall;
        const double y = m.two_sided ? sign * (wall + deep) / 2 : wall / 2;
        for (int k = 0; k < m.shelves; ++k) {
            const double z = plinth + k * pitch;
            const int board = b.box("board", 0, y, z, {inner, deep, t});
            if (m.one && !random.chance(0.08))
                add_books(b,
                          {-inner / 2 + 0.003, inner / 2 - 0.003, y + sign * (deep / 2 - 0.004),
                           z + t, pitch - t, deep, sign, m.flush, m.full},
                          random);
            else
                b.surfaces.push_back(
                    {board, 0, y, inner / 2 - 0.004, deep / 2 - 0.006, pitch - t - 0.004, "shelf"});
        }
    }
    const int top = b.box("top", 0, 0, m.height - t, {inner, d, t});
    if (random.chance(0.3)) b.stand_on(top, 0.4, "shelf top", 0.02);
    return b;
}

Blueprint make_books(Random& random, double length, double height, double depth, bool flush) {
    Blueprint b("books");
    b.pile = true;
    const double full = random.chance(0.6) ? 1 : random(0.5, 0.98);
    b.feet = add_books(b, {-length / 2, length / 2, depth / 2, 0, height, depth, 1, flush, full},
                       random);
    if (b.parts.empty()) b.foot(b.box("volume", 0, 0, 0, {length, 0.8 * depth, 0.8 * height}));
    return b;
}

Blueprint make_service_desk(Random& random) {
    Blueprint b("desk");
    const double w = random(1.2, 2.6), d = random(0.55, 0.85), h = random(0.7, 0.95), t = 0.03;
    const int top = b.box("tabletop", 0, 0, h - t, {w, d, t});
    for (const double s : {-1.0, 1.0})
        b.foot(b.box("cheek", s * (w / 2 - 0.03), 0, 0, {0.04, d, h - t}));
    const double rise = random.chance(0.6) ? random(0.12, 0.35) : 0;
    b.foot(b.box("panel", 0, -d / 2 - 0.0125, 0, {w, 0.025, h + rise}));
    if (rise > 0) b.box("ledge", 0, -d / 2 + 0.06, h + rise, {w, 0.3, 0.025});
    b.surfaces.push_back({top, 0, 0.12, w / 2 - 0.05, d / 2 - 0.16, 0.8, "table"});
    return b;
}

}  // namespace topple::scenes
