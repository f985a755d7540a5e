// SPDX-License-Identifier: MIT
#pragma once

// What a level blow does to a rigid body that stands on level ground: seen from the side, along the
// way of the blow. docs/risk.md derives the equations. Metres, seconds; per kilogram of the
// body.
namespace topple::physics {

struct Upright {
    double ahead_m = 0, behind_m = 0;  // from under the centre of mass to the edges of its base
    double height_m = 0;               // of the centre of mass, above the base
    double gyration_m = 0;             // about the level axis through that, across the blow
};

// A blow at height z of impulse P is given as v = P / M, the speed that the free body's centre gets
// of it. The free body gets v^2 / 2 (1 + (z - h)^2 / k^2) joules per kilogram of it, turning
// included; this is the bracket, which is also its mass over the mass that the blow meets.
double free_share(const Upright& body, double z_m);

// Least v of a blow at z that turns the body over the edge ahead, or over the one behind; infinite
// where none of sensible strength does. Impacts are plastic, friction is Coulomb's:
//   - the blow presses the edge ahead down (z > h), which holds, or slips forwards (low blows) or
//     backwards (high ones); it then turns while friction acts, and from the slip's end about an
//     edge that is at rest;
//   - a blow below the centre (z < h) first turns it backwards about the edge behind, over which it
//     may go; else it comes down and goes on about the edge ahead, over which friction may take it;
//   - a body that does not go over a far edge ahead may come back over a near one behind.
// Angles of the first part are small, those of the rest any; edges are rigid. A blow that does not
// meet an edge squarely has v across it, and `aside` times as much along it, where the base slips
// as well: friction acts against both together, so that less of it acts across. (Of blows above the
// centre from which the edge slips forwards; those below it take a quarter more energy.)
double tips_ahead_m_s(const Upright& body, double z_m, double friction, double aside = 0);
double tips_behind_m_s(const Upright& body, double z_m, double friction);

// How far the body slides that such a blow does not upset: as far as one that gets this share of v
// and does not turn, share^2 v^2 / (2 mu g). While its base slips until it has come down again,
// that is 1: what it presses more as it is lifted, it presses less in the air. Where the edge comes
// to rest before, it went half of what it slipped at first times that time. 0 where the base does
// not slip forwards.
double sliding_share(const Upright& body, double z_m, double friction);

}  // namespace topple::physics
