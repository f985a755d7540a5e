// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/table.h"

namespace topple {

// A look at the list that has the object of each primitive. That of no primitive is none.
class ObjectOf {
  public:
    ObjectOf(std::span<const std::int32_t> of_primitive) : of_primitive_(of_primitive) {}
    ObjectOf(const std::vector<std::int32_t>& of_primitive) : of_primitive_(of_primitive) {}
    ObjectId operator()(PrimitiveId p) const {
        return p < 0 ? ObjectId() : ObjectId(of_primitive_[p.place()]);
    }
    std::size_t primitives() const { return of_primitive_.size(); }
    operator std::span<const std::int32_t>() const { return of_primitive_; }

  private:
    std::span<const std::int32_t> of_primitive_;
};

}  // namespace topple
