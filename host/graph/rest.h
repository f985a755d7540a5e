// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "graph/contact_graph.h"
#include "graph/undersides.h"
#include "physics/bodies.h"
#include "physics/landscape.h"

// Standing is evidence: what was scanned stood. Where an object would fall off what was seen to
// hold it, it is likelier that the scan missed some of that than that it was just falling.
namespace topple::graph {

// How an object is held up.
enum class RestKind : std::uint8_t {
    seen,     // by contacts that were seen, or that nobody saw into
    near,     // by those, and where noise leaves a small gap, or by more of its underside
    leaning,  // by those, and by what it touches beside it
    hidden,  // by what was not seen: taken to be where the object is lowest, or to go straight down
             // from there where nobody saw in
    none,    // by nothing: it has no solid cells
};
const char* to_string(RestKind kind);

struct Rest {
    RestKind kind = RestKind::seen;
    double probability = 1;  // of this among all ways
    // Its border is where it is to be expected of what stands: a centre of mass measured to be m
    // inside of it, with a standard error of s, is inside of it indeed, and hardly within s of it.
    // The mean of the margin x over N(x; m, s) x / (x + 2 s), x > 0, takes the place of m; far from
    // the border it is m.
    std::vector<std::array<double, 2>> support_polygon;
    double support_height_m = 0;
    double margin_error_m = 0;  // standard error of that
    // How far inside of its border the centre of mass would be if its foot went on where nobody saw
    // in, as in a leg that is hidden; 0 where that is no more than it is taken to be.
    double unseen_margin_m = 0;
};

// The likeliest way in which a body stands: of each, how often scans miss so much of a support,
// times the likelihood that a body stands so far from its border: of a margin as a share of what it
// would be if all of the body were held. candidate: with the contacts that were seen.
// boundary: what bounds the columns' cells, if that is known. center_error_m: of the body's centre,
// horizontal, which is one with that of the border. floors_m: heights of the room's floors, which
// go on below what ends at them, where no ray came.
Rest infer_rest(const physics::Candidate& candidate, const std::vector<Underside>& columns,
                const ContactGraph& contacts, const BoundaryCells& boundary = {},
                double center_error_m = 0, std::span<const double> floors_m = {});

}  // namespace topple::graph
