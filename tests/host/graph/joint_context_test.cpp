// SPDX-License-Identifier: MIT
#include "graph/joint_context.h"

#include "errors.h"
#include "fitted/network.h"
#include "oracle/message_passing_oracle.h"
#include "topple/kernel_testing/each_backend.h"
#include "topple/kernel_testing/random.h"

namespace topple::graph {
namespace {

using fitted::context_table;
using oracle::Matrix;

// Primitives that joints of any kind lie between; the last has none.
struct AnyJoints {
    geometry::PrimitiveShapes shapes;
    JointTable table;
    JointOdds alone;

    AnyJoints(std::size_t primitives, std::size_t joints) : shapes{} {
        test::Random random(joints);
        for (std::size_t p = 0; p < primitives; ++p) {
            geometry::PrimitiveShape shape;
            shape.last = random.word() % 300;
            shape.area_m2 = random.uniform(0, 2);
            shapes.of.push_back(shape);
            alone.shell.push_back(random.uniform(-6, 6));
        }
        std::set<std::pair<std::int32_t, std::int32_t>> pairs;
        while (pairs.size() < joints) {
            const auto a = static_cast<std::int32_t>(random.word() % (primitives - 1)),
                       b = static_cast<std::int32_t>(random.word() % (primitives - 1));
            if (a < b) pairs.emplace(a, b);
        }
        table.pairs.assign(pairs.begin(), pairs.end());
        for (std::size_t n = 0; n < joints * joint_feature_names().size(); ++n)
            table.rows.push_back(random.word() % 20 ? random.uniform(-3, 3) : NAN);
        for (std::size_t j = 0; j < joints; ++j) alone.joints.push_back(random.uniform(-6, 6));
    }
};

// The network in plain double precision, layer by layer from its table.
struct PlainNetwork {
    std::size_t at = 0;  // in the weights
    Matrix h, e;

    Matrix layer(const Matrix& rows, bool rectified) {
        const std::size_t width = context_table.width;
        Matrix weights;
        for (std::size_t line = 0; line <= rows[0].size(); ++line, at += width) {
            const auto from = context_table.weights.subspan(at, width);
            weights.emplace_back(from.begin(), from.end());
        }
        std::vector<double> y, bound;
        oracle::dense_layer(rows, weights, rectified, nullptr, y, bound);
        Matrix out;
        for (auto row = y.begin(); row != y.end(); row += context_table.width)
            out.emplace_back(row, row + context_table.width);
        return out;
    }
    Matrix two_layers(const Matrix& rows, bool rectified = false) {
        return layer(layer(rows, true), rectified);
    }

    static std::vector<double> joined(std::initializer_list<std::vector<double>> parts) {
        std::vector<double> out;
        for (const auto& part : parts) out.insert(out.end(), part.begin(), part.end());
        return out;
    }
    static Matrix scaled(const fitted::InputScaling& scaling, const Matrix& rows) {
        Matrix out;
        for (const auto& row : rows) {
            const std::vector<float> values(row.begin(), row.end());
            std::vector<float> to(scaling.width());
            scaling.scale(values, to);
            out.emplace_back(to.begin(), to.end());
        }
        return out;
    }

    void run(const AnyJoints& given) {
        Matrix nodes, joints;
        for (std::size_t p = 0; p < given.shapes.of.size(); ++p) {
            const auto& shape = given.shapes.of[p];
            nodes.push_back({std::log(shape.area_m2 + 1e-4), given.alone.shell[p],
                             std::log1p(static_cast<double>(shape.samples()))});
        }
        const auto names = joint_feature_names();
        std::vector<std::array<std::uint32_t, 2>> ends;
        for (std::size_t j = 0; j < given.table.pairs.size(); ++j) {
            joints.emplace_back();
            for (const auto name : context_table.joints.names) {
                const auto column =
                    static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
                joints.back().push_back(column < names.size()
                                            ? given.table.rows[j * names.size() + column]
                                            : given.alone.joints[j]);
            }
            const auto [a, b] = given.table.pairs[j];
            const bool swap = given.shapes.of[static_cast<std::size_t>(a)].area_m2 >
                              given.shapes.of[static_cast<std::size_t>(b)].area_m2;
            ends.push_back({static_cast<std::uint32_t>(swap ? b : a),
                            static_cast<std::uint32_t>(swap ? a : b)});
        }
        h = two_layers(scaled(context_table.nodes, nodes));
        e = two_layers(scaled(context_table.joints, joints));
        for (std::size_t n = 0; n < context_table.rounds; ++n) round(ends);
    }
    void round(const std::vector<std::array<std::uint32_t, 2>>& ends) {
        std::array<Matrix, 2> message;
        for (const std::size_t side : {0, 1}) {
            Matrix rows;
            for (std::size_t j = 0; j < e.size(); ++j)
                rows.push_back(joined({h[ends[j][1 - side]], e[j]}));
            message[side] = two_layers(rows, true);
        }
        std::vector<double> told, bound;
        oracle::neighbour_pool(h.size(), context_table.width, ends, message, told, bound);
        Matrix rows;
        const std::size_t pair = 2 * context_table.width;
        for (std::size_t p = 0; p < h.size(); ++p)
            rows.push_back(joined({h[p],
                                   {told.begin() + static_cast<std::ptrdiff_t>(p * pair),
                                    told.begin() + static_cast<std::ptrdiff_t>((p + 1) * pair)}}));
        add(two_layers(rows), h);
        rows.clear();
        for (std::size_t j = 0; j < e.size(); ++j)
            rows.push_back(joined({h[ends[j][0]], h[ends[j][1]], e[j]}));
        add(two_layers(rows), e);
    }
    static void add(const Matrix& more, Matrix& to) {
        for (std::size_t r = 0; r < to.size(); ++r)
            for (std::size_t k = 0; k < to[r].size(); ++k) to[r][k] += more[r][k];
    }
    static double out(std::span<const float> of, double alone, const std::vector<double>& state) {
        double sum = of[0] * alone + of[1];
        for (std::size_t k = 0; k < state.size(); ++k) sum += of[2 + k] * state[k];
        return sum;
    }
};

class JointContext : public test::EachBackend {};
TOPPLE_ON_EACH_BACKEND(JointContext);

TEST_P(JointContext, IsThatOfThePlainNetwork) {
    const AnyJoints given(41, 160);
    const JointOdds amid = in_context(*device, given.shapes, given.table, given.alone);
    PlainNetwork plain;
    plain.run(given);
    ASSERT_EQ(amid.joints.size(), given.table.pairs.size());
    ASSERT_EQ(amid.shell.size(), given.shapes.of.size());
    // Single precision through 14 layers of numbers about 1, of odds up to some tens.
    for (std::size_t j = 0; j < amid.joints.size(); ++j)
        EXPECT_NEAR(amid.joints[j],
                    PlainNetwork::out(context_table.joint_out, given.alone.joints[j], plain.e[j]),
                    2e-3);
    for (std::size_t p = 0; p + 1 < amid.shell.size(); ++p)
        EXPECT_NEAR(amid.shell[p],
                    PlainNetwork::out(context_table.shell_out, given.alone.shell[p], plain.h[p]),
                    2e-3);
    EXPECT_EQ(amid.shell.back(), given.alone.shell.back()) << "without joints";
}

TEST_P(JointContext, HasTheBitsOfNative) {
    const AnyJoints given(300, 2000);
    const JointOdds here = in_context(*device, given.shapes, given.table, given.alone);
    const JointOdds native =
        in_context(*device::open_form("native"), given.shapes, given.table, given.alone);
    EXPECT_EQ(here.joints, native.joints);
    EXPECT_EQ(here.shell, native.shell);
}

TEST_P(JointContext, OfNoJointsIsWhatWasKnown) {
    AnyJoints given(3, 0);
    const JointOdds amid = in_context(*device, given.shapes, given.table, given.alone);
    EXPECT_TRUE(amid.joints.empty());
    EXPECT_EQ(amid.shell, given.alone.shell);
}

}  // namespace
}  // namespace topple::graph
