// SPDX-License-Identifier: MIT
#include "parses/c_stage_calls.h"

namespace topple::parses {

void StageCaller::call() {
    using Call = void (StageCaller::*)();
    static constexpr Call calls[] = {&StageCaller::normals, &StageCaller::barriers,
                                     &StageCaller::supports, &StageCaller::volume,
                                     &StageCaller::convolve};
    (this->*calls[random_.below(std::size(calls))])();
}

void StageCaller::normals() {
    const topple_cloud c = cloud();
    const std::size_t count = scene_.cloud.size();
    std::vector<float> out(3 * count);
    double spacing = 0;
    const double eye[] = {number(-2, 2), number(-2, 2), number(0, 2)};
    check("topple_point_spacing",
          topple_point_spacing(or_null(&c), or_null(&spacing), status_or_null()));
    check("topple_normals",
          topple_normals(device(), or_null(&c), number(0.05, 0.3), or_null(eye, 0.7),
                         or_null(out.data()), out.data() + count, out.data() + 2 * count,
                         status_or_null()));
}

void StageCaller::barriers() {
    const std::uint64_t bodies = random_.below(4);
    std::vector<std::uint64_t> first{0};
    std::vector<double> points, mass, centre;
    for (std::uint64_t b = 0; b < bodies; ++b) {
        const std::uint64_t corners = random_.below(12);
        for (std::uint64_t n = 0; n < 3 * corners; ++n) points.push_back(number(-1, 1));
        first.push_back(first.back() + corners);
        mass.push_back(number(0.1, 10));
        for (int a = 0; a < 3; ++a) centre.push_back(number(-0.5, 0.5));
    }
    if (chance(0.05)) first[random_.below(first.size())] = huge_count();
    std::vector<double> barrier(bodies), release(bodies);
    const int code = topple_barriers(device(), or_null(points.data()), or_null(first.data()),
                                     chance(0.03) ? huge_count() : bodies, or_null(mass.data()),
                                     or_null(centre.data()), number(0.001, 0.1),
                                     or_null(barrier.data()), release.data(), status_or_null());
    check("topple_barriers", code);
    if (code != TOPPLE_OK) return;
    for (std::uint64_t b = 0; b < bodies; ++b)
        if (barrier[b] < 0 || release[b] < 0) throw Broken{"a barrier is negative"};
}

void StageCaller::supports() {
    const std::uint64_t corners = random_.below(20), directions = 1 + random_.below(20);
    std::vector<float> values(3 * (corners + directions)), out(directions);
    for (float& v : values) v = static_cast<float>(number(-1, 1));
    topple_array vertices[3], along[3];
    for (std::size_t a = 0; a < 3; ++a) {
        vertices[a] = {values.data() + a * corners, corners, 0, 0};
        along[a] = {values.data() + 3 * corners + a * directions, directions, 0, 0};
    }
    if (chance(0.03)) vertices[random_.below(3)].count = huge_count();
    if (chance(0.03)) along[random_.below(3)].data = nullptr;
    const std::uint64_t first[2] = {0, chance(0.1) ? corners + 5 : corners};
    topple_array to{out.data(), chance(0.1) ? directions - 1 : directions, 0,
                    chance(0.05) ? random_.bits() : 0};
    check("topple_support_functions",
          topple_support_functions(device(), or_null(&vertices[0]), or_null(first),
                                   chance(0.03) ? huge_count() : 1, or_null(&along[0]),
                                   or_null(&to), status_or_null()));
}

void StageCaller::volume() {
    const topple_cloud c = cloud();
    std::vector<std::int32_t> label(scene_.cloud.size());
    for (std::int32_t& l : label) l = static_cast<std::int32_t>(random_.below(4)) - 1;
    if (chance(0.05) && !label.empty()) label[random_.below(label.size())] = any_int();
    if (chance(0.03) && !label.empty()) label.back() = 0x7fffffff;
    topple_volume* made = nullptr;
    check("topple_volume_create",
          topple_volume_create(or_null(&c), or_null(label.data()), number(0.05, 0.2),
                               or_null(&made, 0.02), status_or_null()));
    const Volume held(made);
    const topple_intrinsics camera{
        8, 6, number(4, 9), number(4, 9), number(2, 5), number(2, 4), number(500, 2000)};
    std::vector<std::uint16_t> depth(48);
    for (std::uint16_t& d : depth) d = static_cast<std::uint16_t>(random_.below(3000));
    std::vector<double> pose{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    pose[random_.below(12)] = number(-1, 1);
    check("topple_volume_carve",
          topple_volume_carve(or_null(made), device(), or_null(&camera), or_null(depth.data()),
                              or_null(pose.data()), chance(0.03) ? huge_count() : random_.below(2),
                              status_or_null()));
    std::uint64_t filled = 0;
    const std::int32_t hollow[] = {static_cast<std::int32_t>(random_.below(4)), any_int()};
    check("topple_volume_fill",
          topple_volume_fill(or_null(made), device(), static_cast<std::uint32_t>(random_.below(8)),
                             or_null(hollow, 0.5),
                             chance(0.03) ? huge_count() : random_.below(chance(0.2) ? 3 : 1),
                             or_null(&filled, 0.5), status_or_null()));
    const int state = topple_volume_state(or_null(made), any_int(), any_int(), any_int());
    if (state < 0 || state > 3) throw Broken{"no state of a voxel"};
}

void StageCaller::convolve() {
    const auto width = static_cast<std::uint32_t>(random_.below(9));
    const auto height = static_cast<std::uint32_t>(random_.below(9));
    const auto margin = static_cast<std::uint32_t>(random_.below(4));
    std::vector<float> primary((width + 2 * margin) * (height + 2 * margin)),
        density(width * height);
    for (float& v : primary) v = static_cast<float>(number(0, 1));
    std::vector<topple_footprint_entry> footprint(random_.below(5));
    for (auto& e : footprint)
        e = {static_cast<std::int32_t>(random_.below(7)) - 3,
             static_cast<std::int32_t>(random_.below(7)) - 3, static_cast<float>(number(0, 1))};
    if (chance(0.03) && !footprint.empty()) footprint[0].dx = any_int();
    const std::uint32_t first[2] = {0, static_cast<std::uint32_t>(footprint.size())};
    topple_array from{primary.data(), primary.size(), 0, 0},
        to{density.data(), density.size(), 0, 0};
    if (chance(0.03)) from.count = huge_count();
    if (chance(0.03)) to.data = nullptr;
    // Shapes that don't match the arrays are refused.
    const auto odd = [&](std::uint32_t size) {
        return chance(0.03) ? static_cast<std::uint32_t>(random_.bits()) : size;
    };
    check("topple_convolve", topple_convolve(device(), odd(width), odd(height), 1, odd(margin),
                                             or_null(&from), or_null(footprint.data()),
                                             or_null(first), or_null(&to), status_or_null()));
}

}  // namespace topple::parses
