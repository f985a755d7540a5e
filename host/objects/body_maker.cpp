// SPDX-License-Identifier: MIT
#include "objects/body_maker.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace topple {

BodyMaker::BodyMaker(const SolidScene& solids, const ObjectStage& stage,
                     const Table<PrimitiveId, bool>& shell, bool sensed)
    : boundary_(solids.boundary()),
      stage_(stage),
      shell_(shell),
      sensed_(sensed),
      errors_(physics::volume_errors(solids.cells(), solids.boundary())) {}

Body BodyMaker::made(std::vector<std::int32_t> primitives,
                     const std::vector<graph::Underside>& columns, bool grounded) const {
    Body out;
    out.candidate =
        graph::candidate_of(stage_.contacts, stage_.bodies, shell_, std::move(primitives));
    out.body_error = physics::body_error(out.candidate.body, out.candidate.primitives, errors_,
                                         stage_.masses.density_kg_m3);
    out.grounded = grounded;
    if (!grounded) {
        graph::Rest rest =
            graph::infer_rest(out.candidate, columns, stage_.contacts, boundary_,
                              std::max(out.body_error.center_m[0], out.body_error.center_m[1]),
                              stage_.floors.levels_m());
        out.rest = rest.kind;
        out.rest_probability = rest.probability;
        out.margin_error_m = rest.margin_error_m;
        if (sensed_) out.unseen_margin_m = rest.unseen_margin_m;
        out.candidate.stood = rest.kind != graph::RestKind::none;
        out.candidate.support_polygon = std::move(rest.support_polygon);
        out.candidate.support_height_m = rest.support_height_m;
        out.floor_m = stage_.floors.below_m(rest.support_height_m);
        out.floor_shakes = stage_.floors.shaking(out.floor_m);
    }
    out.lowest_m = std::numeric_limits<double>::infinity();
    out.highest_m = -out.lowest_m;
    for (const std::int32_t p : out.candidate.primitives) {
        out.lowest_m = std::min(out.lowest_m, stage_.contacts.lowest_m[p]);
        out.highest_m = std::max(out.highest_m, stage_.contacts.highest_m[p]);
    }
    return out;
}

}  // namespace topple
