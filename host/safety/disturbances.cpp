// SPDX-License-Identifier: MIT
#include "safety/disturbances.h"

#include <array>
#include <utility>

#include "safety/earthquake/earthquake_field.h"
#include "safety/human/human_field.h"
#include "safety/wind/wind_field.h"
#include "topple/error.h"

namespace topple::safety {
namespace {

class MadeField : public DisturbanceField {
  public:
    explicit MadeField(Disturbance disturbance) : disturbance_(std::move(disturbance)) {}
    Disturbance disturbance() override { return std::move(disturbance_); }

  private:
    Disturbance disturbance_;
};

}  // namespace

std::span<const DisturbanceKind* const> disturbance_kinds() {
    static const std::array kinds{&human_kind(), &wind_kind(), &earthquake_kind()};
    return kinds;
}

const DisturbanceKind* find_disturbance_kind(std::string_view name) {
    for (const DisturbanceKind* kind : disturbance_kinds())
        if (name == kind->name) return kind;
    return nullptr;
}

const DisturbanceKind& disturbance_kind(std::string_view name) {
    if (const DisturbanceKind* kind = find_disturbance_kind(name)) return *kind;
    std::string known;
    const auto kinds = disturbance_kinds();
    for (std::size_t n = 0; n < kinds.size(); ++n) {
        if (n > 0) known += n + 1 < kinds.size() ? ", " : " or ";
        known += kinds[n]->name;
    }
    throw Error(ErrorKind::usage, "--disturbance " + std::string(name) + ": expected " + known);
}

std::unique_ptr<DisturbanceField> made_field(Disturbance disturbance) {
    return std::make_unique<MadeField>(std::move(disturbance));
}

}  // namespace topple::safety
