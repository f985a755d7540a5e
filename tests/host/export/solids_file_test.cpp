// SPDX-License-Identifier: MIT
#include "io/solids_file.h"

#include <gtest/gtest.h>

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

TEST_F(SolidsFile, SaysTheSameEachTime) {
    EXPECT_EQ(written(), written());
}

}  // namespace
}  // namespace topple::exports::test
