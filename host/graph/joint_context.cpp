// SPDX-License-Identifier: MIT
#include "graph/joint_context.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <numeric>
#include <span>
#include <string>
#include <string_view>

#include "dense_layer.hpp"
#include "device/devices.h"
#include "fitted/network.h"
#include "neighbour_pool.hpp"
#include "topple/error.h"
#include "topple/kernels/queue.h"

namespace topple::graph {
namespace {

using device::Buffer;
using fitted::context_table;
using Indices = std::vector<std::uint32_t>;

// What the network is given of a primitive, in this order.
constexpr std::array<std::string_view, 3> node_inputs{"log_area", "shell", "log_samples"};
// Of a joint: features of its table, and last
constexpr std::string_view own_log_odds = "log_odds";

// Where the table has the inputs; none stands for the joint's own log-odds.
std::vector<std::size_t> columns_of_joints() {
    const auto have = joint_feature_names();
    std::vector<std::size_t> out;
    for (const std::string_view name : context_table.joints.names) {
        const auto at = std::ranges::find(have, name);
        if (at == have.end() && name != own_log_odds)
            throw Error(ErrorKind::input, "context.model.json: nothing is known of its input " +
                                              std::string(name) + "; fit it anew");
        out.push_back(static_cast<std::size_t>(at - have.begin()));
    }
    return out;
}

std::vector<float> scaled_nodes(const geometry::PrimitiveShapes& shapes,
                                TableView<PrimitiveId, double> shell) {
    const fitted::InputScaling& scaling = context_table.nodes;
    if (!std::ranges::equal(scaling.names, node_inputs))
        throw Error(
            ErrorKind::input,
            "context.model.json: its inputs of primitives are not those known; fit it anew");
    std::vector<float> out(shapes.of.size() * scaling.width());
    for (std::size_t p = 0; p < shapes.of.size(); ++p) {
        const geometry::PrimitiveShape& shape = shapes.of[p];
        const std::array values{static_cast<float>(std::log(shape.area_m2 + 1e-4)),
                                static_cast<float>(shell[p]),
                                static_cast<float>(std::log1p(shape.samples()))};
        scaling.scale(values, std::span(out).subspan(p * scaling.width(), scaling.width()));
    }
    return out;
}

std::vector<float> scaled_joints(const JointTable& table, std::span<const double> log_odds) {
    const fitted::InputScaling& scaling = context_table.joints;
    const std::vector<std::size_t> columns = columns_of_joints();
    const std::size_t width = joint_feature_names().size();
    std::vector<float> out(table.pairs.size() * scaling.width()), values(columns.size());
    for (std::size_t j = 0; j < table.pairs.size(); ++j) {
        const auto row = std::span(table.rows).subspan(j * width, width);
        std::ranges::transform(columns, values.begin(), [&](std::size_t at) {
            return at < width ? row[at] : static_cast<float>(log_odds[j]);
        });
        scaling.scale(values, std::span(out).subspan(j * scaling.width(), scaling.width()));
    }
    return out;
}

// The smaller and the bigger primitive of each joint, as the features have them.
std::array<Indices, 2> ends_of(const JointTable& table, const geometry::PrimitiveShapes& shapes) {
    std::array<Indices, 2> out;
    for (auto [small, big] : table.pairs) {
        const auto area = [&](std::int32_t p) {
            return shapes.of[static_cast<std::size_t>(p)].area_m2;
        };
        if (area(small) > area(big)) std::swap(small, big);
        out[0].push_back(static_cast<std::uint32_t>(small));
        out[1].push_back(static_cast<std::uint32_t>(big));
    }
    return out;
}

// Of each node its edges, as kernel neighbour_pool takes them.
struct Incidence {
    Indices first, edge;

    Incidence(const std::array<Indices, 2>& ends, std::size_t nodes) : first(nodes + 1, 0) {
        for (const Indices& side : ends)
            for (const std::uint32_t node : side) ++first[node + 1];
        std::inclusive_scan(first.begin(), first.end(), first.begin());
        edge.resize(first.back());
        Indices next(first.begin(), first.end() - 1);
        for (std::uint32_t j = 0; j < ends[0].size(); ++j)
            for (const std::uint32_t side : {0u, 1u}) edge[next[ends[side][j]]++] = 2 * j + side;
    }
};

// The network on a device: h are the states of primitives, e those of joints.
class Network {
  public:
    Network(device::Device& device, std::size_t nodes, const std::array<Indices, 2>& ends)
        : device_(device),
          queue_(device),
          nodes_(static_cast<std::uint32_t>(nodes)),
          joints_(static_cast<std::uint32_t>(ends[0].size())),
          incidence_(ends, nodes),
          weights_(device, context_table.weights, "weights"),
          each_(device, counted(std::max(nodes, ends[0].size())), "rows"),
          small_(device, ends[0], "smaller ends"),
          big_(device, ends[1], "bigger ends"),
          first_(device, incidence_.first, "joints of primitives"),
          edge_(device, incidence_.edge, "joint of each end"),
          h_(device, nodes * width, "states of primitives"),
          e_(device, joints_ * width, "states of joints"),
          hidden_(device, std::max<std::size_t>(nodes, joints_) * width, "hidden states"),
          to_small_(device, joints_ * width, "messages to smaller ends"),
          to_big_(device, joints_ * width, "messages to bigger ends"),
          told_(device, nodes * 2 * width, "messages of primitives") {}

    void run(std::span<const float> nodes, std::span<const float> joints) {
        const Buffer<float> node_rows(device_, nodes, "inputs of primitives"),
            joint_rows(device_, joints, "inputs of joints");
        const auto in = [](const fitted::InputScaling& s) {
            return static_cast<std::uint32_t>(s.width());
        };
        two_layers({{&node_rows, &each_, in(context_table.nodes)}}, h_, nodes_, Form::set);
        two_layers({{&joint_rows, &each_, in(context_table.joints)}}, e_, joints_, Form::set);
        for (std::uint32_t n = 0; n < context_table.rounds; ++n) {
            two_layers({{&h_, &big_, width}, {&e_, &each_, width}}, to_small_, joints_,
                       Form::rectified);
            two_layers({{&h_, &small_, width}, {&e_, &each_, width}}, to_big_, joints_,
                       Form::rectified);
            queue_.add<kernels::NeighbourPool>(std::uint64_t{nodes_} * width,
                                               {.to_small = to_small_,
                                                .to_big = to_big_,
                                                .first = first_,
                                                .edge = edge_,
                                                .y = told_},
                                               {.nodes = nodes_, .width = width});
            two_layers({{&h_, &each_, width}, {&told_, &each_, 2 * width}}, h_, nodes_,
                       Form::added);
            two_layers({{&h_, &small_, width}, {&h_, &big_, width}, {&e_, &each_, width}}, e_,
                       joints_, Form::added);
        }
        queue_.run();
    }

    std::vector<double> joint_log_odds(std::span<const double> alone) const {
        return read(e_, context_table.joint_out, alone);
    }
    // As it was of those without joints: there are none to learn that from.
    std::vector<double> shell_log_odds(std::span<const double> alone) const {
        std::vector<double> out = read(h_, context_table.shell_out, alone);
        for (std::size_t n = 0; n < nodes_; ++n)
            if (incidence_.first[n] == incidence_.first[n + 1]) out[n] = alone[n];
        return out;
    }

  private:
    enum class Form { set, rectified, added };
    struct Part {
        const Buffer<float>* table = nullptr;
        const Buffer<std::uint32_t>* rows = nullptr;
        std::uint32_t width = 0;
    };

    static Indices counted(std::size_t count) {
        Indices out(count);
        std::iota(out.begin(), out.end(), 0u);
        return out;
    }

    // The next two layers, the one between them rectified.
    void two_layers(std::initializer_list<Part> parts, const Buffer<float>& y, std::uint32_t rows,
                    Form form) {
        layer(parts, hidden_, rows, Form::rectified);
        layer({{&hidden_, &each_, width}}, y, rows, form);
    }
    void layer(std::initializer_list<Part> given, const Buffer<float>& y, std::uint32_t rows,
               Form form) {
        std::array<Part, 3> parts;
        parts.fill({given.begin()->table, given.begin()->rows, 0});
        std::ranges::copy(given, parts.begin());
        const std::uint32_t inputs = parts[0].width + parts[1].width + parts[2].width;
        queue_.add<kernels::DenseLayer>(std::uint64_t{rows} * width,
                                        {.a = *parts[0].table,
                                         .b = *parts[1].table,
                                         .c = *parts[2].table,
                                         .of_a = *parts[0].rows,
                                         .of_b = *parts[1].rows,
                                         .of_c = *parts[2].rows,
                                         .weight = weights_,
                                         .y = y},
                                        {.rows = rows,
                                         .outputs = width,
                                         .width_a = parts[0].width,
                                         .width_b = parts[1].width,
                                         .width_c = parts[2].width,
                                         .weight_first = weight_first_,
                                         .rectified = form == Form::rectified,
                                         .added = form == Form::added});
        weight_first_ += (1 + inputs) * width;
    }

    static std::vector<double> read(const Buffer<float>& states, std::span<const float> out,
                                    std::span<const double> alone) {
        const std::vector<float> rows = states.download();
        std::vector<double> log_odds;
        for (std::size_t n = 0; n < alone.size(); ++n) {
            double sum = double{out[0]} * alone[n] + double{out[1]};
            for (std::size_t k = 0; k < width; ++k)
                sum += double{out[2 + k]} * double{rows[n * width + k]};
            log_odds.push_back(sum);
        }
        return log_odds;
    }

    static inline const std::uint32_t width = context_table.width;

    device::Device& device_;
    device::Queue queue_;
    std::uint32_t nodes_, joints_, weight_first_ = 0;
    Incidence incidence_;
    Buffer<float> weights_;
    Buffer<std::uint32_t> each_, small_, big_, first_, edge_;
    Buffer<float> h_, e_, hidden_, to_small_, to_big_, told_;
};

}  // namespace

JointOdds in_context(device::Device& device, const geometry::PrimitiveShapes& shapes,
                     const JointTable& table, const JointOdds& alone) {
    if (table.pairs.empty()) return alone;
    const std::uint64_t inputs = context_table.joints.width(), width = context_table.width;
    const std::uint64_t most =
        std::max(table.pairs.size() * std::max(inputs, width), shapes.of.size() * 2 * width);
    // What some devices bind at once is not much: all backends say the same.
    if (device.info().backend != device::Backend::native &&
        most * sizeof(float) > device.info().limits.max_binding_bytes) {
        const auto native = device::open_device("native", device.threads().threads());
        return in_context(*native, shapes, table, alone);
    }
    Network network(device, shapes.of.size(), ends_of(table, shapes));
    network.run(scaled_nodes(shapes, alone.shell), scaled_joints(table, alone.joints));
    return {network.joint_log_odds(alone.joints), network.shell_log_odds(alone.shell)};
}

}  // namespace topple::graph
