// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace topple::fitted {

// How inputs become numbers about 0 (tests/fitting/fit_context.py).
struct InputScaling {
    std::span<const std::string_view> names;
    std::span<const float> low, high, mean, deviation;  // by name
    std::span<const std::uint32_t> missing;             // names whose lack is an input of its own

    std::size_t width() const { return names.size() + missing.size(); }
    // values: in the order of the names, NaN where not known. to: width() numbers.
    void scale(std::span<const float> values, std::span<float> to) const;
};

// A network that passes messages along the joints of primitives (graph/joint_context.h), as the
// build made it of its file, which it checked (fitted/embed_models.py).
struct ContextTable {
    InputScaling nodes, joints;
    std::uint32_t width = 0, rounds = 0;
    // Layer after layer, each its bias and then a line of weights of each input, `width` long.
    std::span<const float> weights;
    // Of what comes out: the share of the log-odds that went in, the bias, and `width` weights.
    std::span<const float> joint_out, shell_out;
};

extern const ContextTable context_table;

}  // namespace topple::fitted
