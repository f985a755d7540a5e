// SPDX-License-Identifier: MIT
#include "result/solids_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "core/checksum.h"
#include "host/export/blocks.h"
#include "host/io/files.h"
#include "io/text.h"
#include "topple/error.h"

namespace topple::exports::test {
namespace {

class SolidsFile : public topple::test::Files {
  protected:
    static SolidScene scene() {
        const SolidScene plain =
            solids_of({{{0, 0, 0}, {6, 5, 4}, 0}, {{0, 0, 4}, {2, 2, 6}, 1}}, 2);
        BoundaryCells boundary;
        SurfacePatch patch;
        patch.origin = {0.1, 0.2, 0.3};
        patch.c = {0, 0, 0, 1, 0, 0, 0, 0, 0, 0.5};
        patch.noise_m = 0.001;
        patch.primitive = 1;
        boundary.patches = {patch};
        boundary.i = {0, 1};
        boundary.j = {0, 1};
        boundary.k = {5, 5};
        boundary.primitive = {1, 1};
        for (auto& slot : boundary.slot) slot = {0, 0};
        boundary.form = {1, 1};
        boundary.share = {4096, 17};
        for (auto& moment : boundary.moment) moment = {3, -4};
        return {plain.cells(), {Role::floor, Role::none}, {}, boundary};
    }
    std::string written() const {
        io::write_solids(path("solids.bin"), scene());
        return std::string(io::read_file(path("solids.bin")).text());
    }
};

TEST_F(SolidsFile, ComesBackAsItWas) {
    written();
    const auto back = io::read_solids(path("solids.bin"));
    const SolidScene was = scene();
    EXPECT_EQ(back->cells().i, was.cells().i);
    EXPECT_EQ(back->cells().primitive, was.cells().primitive);
    EXPECT_EQ(back->voxel_m(), was.voxel_m());
    EXPECT_EQ(back->role(0), Role::floor);
    EXPECT_EQ(back->boundary().share, was.boundary().share);
    EXPECT_EQ(back->boundary().moment, was.boundary().moment);
    EXPECT_EQ(back->boundary().patches[0].c, was.boundary().patches[0].c);
    EXPECT_EQ(back->boundary().patches[0].primitive, 1);
}

TEST_F(SolidsFile, EveryFlippedByteAndEveryCutIsTold) {
    const std::string whole = written();
    for (std::size_t n = 0; n < whole.size(); ++n) {
        std::string bytes = whole;
        bytes[n] = static_cast<char>(bytes[n] ^ 0x40);
        write("flipped", bytes);
        EXPECT_THROW(io::read_solids(path("flipped")), Error) << n;
    }
    for (std::size_t n = 1; n < whole.size(); n += 7) {
        write("cut", whole.substr(0, n));
        EXPECT_THROW(io::read_solids(path("cut")), Error) << n;
    }
    EXPECT_THROW(io::read_solids(path("missing")), Error);
}

// Who changes a file can give it a right checksum, too.
TEST_F(SolidsFile, WhatNoParseWritesIsRefusedWhateverItsChecksum) {
    const std::string whole = written();
    const SolidScene was = scene();
    const std::size_t cells = was.cells().size(), below = was.cells().unseen_below.size();
    constexpr std::size_t at_voxel = 16, head = 72;
    const std::size_t at_i = head, at_j = at_i + 4 * cells, at_k = at_j + 4 * cells,
                      at_primitive = at_k + 4 * cells, at_basis = at_primitive + 4 * cells,
                      at_boundary = at_basis + cells + below, at_slot = at_boundary + 4 * 8,
                      at_form = at_slot + 4 * 8, at_share = at_form + 8,
                      at_patch = at_share + 8 + 3 * 8, at_patch_primitive = at_patch + 120,
                      at_role = at_patch_primitive + 4;
    const auto forged = [&](std::size_t at, const auto& value) {
        std::string bytes = whole;
        std::memcpy(bytes.data() + at, &value, sizeof(value));
        const std::size_t summed = bytes.size() - sizeof(Checksum::Value);
        const Checksum::Value sum = Checksum::of(bytes.data(), summed);
        std::memcpy(bytes.data() + summed, &sum, sizeof(sum));
        write("forged", bytes);
    };
    forged(at_share, std::uint32_t{4095});
    EXPECT_EQ(io::read_solids(path("forged"))->boundary().share[0], 4095U);
    const auto refused = [&](std::size_t at, const auto& value) {
        forged(at, value);
        topple::test::expect_input_error([&] { io::read_solids(path("forged")); },
                                         {"forged", "damaged", "parse the scan again"});
    };
    using Limits = std::numeric_limits<std::int32_t>;
    const std::size_t last = 4 * (cells - 1);
    const struct {
        const char* what;
        std::size_t at;
        std::vector<std::int32_t> words;
    } tables[] = {
        {"first cell", at_i, {5, 1 << 29, Limits::max(), Limits::min()}},
        {"last cell", at_i + last, {-1, 1 << 22, 1 << 29, Limits::max(), Limits::min()}},
        {"columns", at_j, {5, Limits::max()}},
        {"levels", at_k + last, {0, 1 << 22, Limits::max(), Limits::min()}},
        {"primitives", at_primitive, {-2, 2, Limits::max(), Limits::min()}},
        {"boundary's place", at_boundary, {2, Limits::max(), Limits::min()}},
        {"boundary's primitive", at_boundary + 3 * 8, {-1, 2, Limits::max(), Limits::min()}},
        {"slots", at_slot, {1, -1, Limits::max()}},
        {"form", at_form, {7}},
        {"share", at_share, {4097, -1}},
        {"patch's primitive", at_patch_primitive, {-2, 2, Limits::max(), Limits::min()}},
    };
    for (const auto& [what, at, words] : tables) {
        for (const std::int32_t word : words) {
            SCOPED_TRACE(std::string(what) + ' ' + std::to_string(word));
            refused(at, word);
        }
    }
    refused(at_basis, std::uint8_t{basis_count});
    refused(at_role, std::uint8_t{9});
    for (const double number : {std::nan(""), HUGE_VAL, -1.0}) refused(at_voxel, number);
    for (const double number : {std::nan(""), HUGE_VAL, 1e300}) refused(at_patch, number);
    for (std::size_t count = 0; count < 6; ++count)
        for (const std::uint64_t many : {std::uint64_t{1} << 40, ~std::uint64_t{0}})
            refused(at_voxel + 8 + 8 * count, many);
}

TEST_F(SolidsFile, SaysTheSameEachTime) {
    EXPECT_EQ(written(), written());
}

}  // namespace
}  // namespace topple::exports::test
