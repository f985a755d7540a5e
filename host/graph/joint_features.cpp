// SPDX-License-Identifier: MIT
#include "graph/joint_features.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "graph/borders.h"
#include "graph/stable_objects.h"
#include "physics/tipping.h"

namespace topple::graph {
namespace {

using Eigen::Vector3d;
using geometry::PrimitiveShape;

constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

// What holds for one primitive with all its borders.
struct Node {
    double near = 0;     // samples near any other, each counted with each
    double borders = 0;  // how many
    double stands = 0;   // see margin()
    double volume_m3 = 0, fill = 0;
};

// How far the weight of a body is from tipping over: the distance of its centre from the edge of
// its support over its height, clamped; -2 where nothing holds it.
double margin(const physics::Candidate& c) {
    if (c.support_polygon.empty()) return -2;
    const physics::Footing foot =
        physics::footing(c.support_polygon, c.body.center[0], c.body.center[1]);
    const double height = std::max(c.body.center[2] - c.support_height_m, 0.03);
    return std::clamp(foot.margin_m / height, -2.0, 2.0);
}

class Rows {
  public:
    Rows(const geometry::SurfaceSamples& samples, const geometry::PrimitiveShapes& shapes,
         const ContactGraph& contacts, TableView<PrimitiveId, physics::MassProperties> bodies,
         const geometry::SurfaceSeams& seams, TableView<PrimitiveId, float> shell,
         ThreadPool& threads)
        : samples_(samples),
          shapes_(shapes),
          contacts_(contacts),
          bodies_(bodies),
          seams_(seams),
          shell_(shell),
          threads_(threads),
          borders_(find_borders(samples, threads)),
          nodes_(shapes.of.size()) {
        for (const float p : shell) in_shell_.push_back(p > 0.5f);
        for (const Border& b : borders_) {
            at_[{b.a, b.b}].border = &b;
            add(b.a, b.near_a);
            add(b.b, b.near_b);
        }
        for (const physics::TouchingPair& t : contacts.pairs) at_[{t.a, t.b}].touching = &t;
        for (const Carrying& c : contacts.carryings) {
            if (c.supporter < 0) continue;
            auto& pair = at_[std::minmax(c.supporter, c.supported)];
            (c.supporter < c.supported ? pair.a_carries : pair.b_carries) = &c;
        }
        threads.each(nodes_.size(), 16, [&](std::size_t p) {
            Node& node = nodes_[p];
            node.volume_m3 = bodies[p].volume_m3;
            const Vector3d box = (shapes.of[p].high - shapes.of[p].low).cwiseMax(samples.spacing_m);
            node.fill = node.volume_m3 / box.prod();
            if (bodies[p].voxels > 0)
                node.stands = margin(
                    candidate_of(contacts, bodies, in_shell_, {static_cast<std::int32_t>(p)}));
        });
    }

    JointTable table() const {
        JointTable out;
        std::vector<const Evidence*> of;
        for (const auto& [pair, evidence] : at_) {
            if (node_of(pair.first).volume_m3 <= 0 || node_of(pair.second).volume_m3 <= 0) continue;
            out.pairs.push_back(pair);
            of.push_back(&evidence);
        }
        const std::size_t width = joint_feature_names().size();
        out.rows.resize(of.size() * width);
        threads_.each(of.size(), 16, [&](std::size_t n) {
            add_row(out.pairs[n].first, out.pairs[n].second, *of[n], &out.rows[n * width]);
        });
        return out;
    }

  private:
    struct Evidence {
        const Border* border = nullptr;
        const physics::TouchingPair* touching = nullptr;
        const Carrying *a_carries = nullptr, *b_carries = nullptr;
    };
    const Node& node_of(PrimitiveId p) const { return nodes_[p]; }

    void add(PrimitiveId p, double near) {
        Node& node = nodes_[p];
        node.near += near;
        node.borders += 1;
    }

    void add_row(std::int32_t a, std::int32_t b, const Evidence& e, float* row_values) const;

    const geometry::SurfaceSamples& samples_;
    const geometry::PrimitiveShapes& shapes_;
    const ContactGraph& contacts_;
    TableView<PrimitiveId, physics::MassProperties> bodies_;
    const geometry::SurfaceSeams& seams_;
    TableView<PrimitiveId, float> shell_;
    ThreadPool& threads_;
    std::vector<Border> borders_;
    Table<PrimitiveId, Node> nodes_;
    Table<PrimitiveId, bool> in_shell_;
    std::map<std::pair<std::int32_t, std::int32_t>, Evidence> at_;
};

// One row is written value by value, each with its name, so that names and values can't part.
class Row {
  public:
    Row(float* values, std::vector<std::string_view>* names) : values_(values), names_(names) {}
    void operator()(std::string_view name, double value) {
        if (values_) *values_++ = static_cast<float>(value);
        if (names_) names_->push_back(name);
    }

  private:
    float* values_;  // the next one
    std::vector<std::string_view>* names_;
};

// Of the one in the other's bounds, seen from above.
double plan_overlap(const PrimitiveShape& of, const PrimitiveShape& in, double edge) {
    double share = 1;
    for (Eigen::Index a = 0; a < 2; ++a) {
        const double both = std::min(of.high[a], in.high[a]) - std::max(of.low[a], in.low[a]);
        share *= std::clamp((both + edge) / (of.high[a] - of.low[a] + edge), 0.0, 1.0);
    }
    return share;
}

double height_overlap(const PrimitiveShape& of, const PrimitiveShape& in, double edge) {
    const double both = std::min(of.high[2], in.high[2]) - std::max(of.low[2], in.low[2]);
    return std::clamp((both + edge) / (of.high[2] - of.low[2] + edge), -1.0, 1.0);
}

struct Inputs {
    const PrimitiveShape &small, &big;
    const Node &small_node, &big_node;
    const Border* border = nullptr;
    bool small_is_a = true;
    double edge = 0, floor = 0, small_shell = 0, big_shell = 0;
    double touch_share_small = 0, touch_share_big = 0, touch_z = 0, touch_area = 0;
    double small_on_big = 0, big_on_small = 0;
    double union_stands = 0;
    double seam_flush = 0, seam_ledge = 0, seam_pairs = 0;
};

void add_border(const Inputs& in, Row& row) {
    const Border* b = in.border;
    const auto value = [&](std::string_view name, auto of) {
        row(name, b ? static_cast<double>(of(*b)) : static_cast<double>(unknown));
    };
    const bool first = in.small_is_a;
    const auto near_small = [&](const Border& x) { return double(first ? x.near_a : x.near_b); };
    const auto near_big = [&](const Border& x) { return double(first ? x.near_b : x.near_a); };
    const auto samples = [](const PrimitiveShape& p) {
        return std::max(1.0, static_cast<double>(p.samples()));
    };
    value("colour_border", [](const Border& x) { return x.colour; });
    value("gap_least", [](const Border& x) { return x.gap_least; });
    value("gap_20", [](const Border& x) { return x.gap_20; });
    value("gap_50", [](const Border& x) { return x.gap_50; });
    value("gap_least_over_edge", [&](const Border& x) { return x.gap_least / in.edge; });
    value("gap_20_over_edge", [&](const Border& x) { return x.gap_20 / in.edge; });
    value("near_share_small", [&](const Border& x) { return near_small(x) / samples(in.small); });
    value("near_share_big", [&](const Border& x) { return near_big(x) / samples(in.big); });
    value("border_share_small",
          [&](const Border& x) { return near_small(x) / in.small_node.near; });
    value("border_share_big", [&](const Border& x) { return near_big(x) / in.big_node.near; });
    value("near_area", [&](const Border& x) {
        return std::log(in.edge * in.edge * (near_small(x) + near_big(x)));
    });
    value("convexity", [](const Border& x) { return x.convexity; });
    value("convex_share", [](const Border& x) { return x.convex_share; });
    value("concave_share", [](const Border& x) { return x.concave_share; });
    value("border_parallel", [](const Border& x) { return x.parallel; });
    value("flush_share", [](const Border& x) { return x.flush_share; });
    value("offset", [](const Border& x) { return x.offset; });
    value("offset_over_edge", [&](const Border& x) { return x.offset / in.edge; });
    value("length", [](const Border& x) { return x.spread[2]; });
    value("length_over_small",
          [&](const Border& x) { return x.spread[2] / (in.small.spread[2] + in.edge); });
    value("length_over_big",
          [&](const Border& x) { return x.spread[2] / (in.big.spread[2] + in.edge); });
    value("width_over_small",
          [&](const Border& x) { return x.spread[1] / (in.small.spread[1] + in.edge); });
    value("width", [](const Border& x) { return x.spread[1]; });
    value("place_in_small", [&](const Border& x) {
        return (x.center[2] - in.small.low[2] + in.edge / 2) /
               (in.small.high[2] - in.small.low[2] + in.edge);
    });
    value("place_in_big", [&](const Border& x) {
        return (x.center[2] - in.big.low[2] + in.edge / 2) /
               (in.big.high[2] - in.big.low[2] + in.edge);
    });
    value("border_height", [](const Border& x) { return x.high - x.low; });
    value("border_above_floor", [&](const Border& x) { return x.center[2] - in.floor; });
    value("rise", [&](const Border& x) { return (first ? 1 : -1) * x.direction[2]; });
    value("direction_length", [](const Border& x) { return x.direction.norm(); });
    value("direction_in_face", [&](const Border& x) {
        return std::abs(x.direction.dot(in.big.face())) / std::max(x.direction.norm(), 1e-6);
    });
}

void add_shapes(const Inputs& in, Row& row) {
    const PrimitiveShape &s = in.small, &b = in.big;
    const double edge = in.edge;
    row("edge", edge);
    row("colours_apart", (s.colour - b.colour).norm());
    row("colour_spread_small", s.colour_spread);
    row("colour_spread_big", b.colour_spread);
    row("area_small", std::log(s.area_m2 + 1e-4));
    row("area_big", std::log(b.area_m2 + 1e-4));
    row("area_ratio", std::log((b.area_m2 + 1e-4) / (s.area_m2 + 1e-4)));
    row("thickness_small", s.spread[0]);
    row("thickness_big", b.spread[0]);
    row("width_small", s.spread[1]);
    row("width_big", b.spread[1]);
    row("length_small", s.spread[2]);
    row("length_big", b.spread[2]);
    row("slender_small", (s.spread[1] + edge) / (s.spread[2] + edge));
    row("slender_big", (b.spread[1] + edge) / (b.spread[2] + edge));
    row("face_z_small", s.face()[2]);
    row("face_z_big", b.face()[2]);
    row("planar_small", s.normal.norm());
    row("planar_big", b.normal.norm());
    row("up_small", s.up_share);
    row("up_big", b.up_share);
    row("side_small", s.side_share);
    row("side_big", b.side_share);
    row("faces_parallel", std::abs(s.face().dot(b.face())));
    row("long_axes_parallel", std::abs(s.axes.col(2).dot(b.axes.col(2))));
    row("aligned_small", std::max(std::abs(s.face()[0]), std::abs(s.face()[1])));
    row("low_small", s.low[2] - in.floor);
    row("low_big", b.low[2] - in.floor);
    row("high_small", s.high[2] - in.floor);
    row("high_big", b.high[2] - in.floor);
    row("height_small", s.high[2] - s.low[2]);
    row("height_big", b.high[2] - b.low[2]);
    row("above_big", s.low[2] - b.high[2]);
    row("below_big", s.high[2] - b.low[2]);
    row("tops", s.high[2] - b.high[2]);
    row("feet", s.low[2] - b.low[2]);
    row("height_overlap_small", height_overlap(s, b, edge));
    row("height_overlap_big", height_overlap(b, s, edge));
    row("plan_small", plan_overlap(s, b, edge));
    row("plan_big", plan_overlap(b, s, edge));
    const Vector3d apart = b.center - s.center;
    row("apart", apart.norm());
    row("apart_off_big", std::abs(apart.dot(b.face())));
    row("apart_off_small", std::abs(apart.dot(s.face())));
    row("apart_level_over_big",
        std::hypot(apart[0], apart[1]) / (std::hypot(b.spread[1], b.spread[2]) + edge));
}

void add_solids(const Inputs& in, Row& row) {
    row("shell_small", in.small_shell);
    row("shell_big", in.big_shell);
    row("borders_small", in.small_node.borders);
    row("borders_big", in.big_node.borders);
    row("volume_small", std::log(in.small_node.volume_m3 + 1e-7));
    row("volume_big", std::log(in.big_node.volume_m3 + 1e-7));
    row("fill_small", in.small_node.fill);
    row("fill_big", in.big_node.fill);
    row("stands_small", in.small_node.stands);
    row("stands_big", in.big_node.stands);
    row("stands_both", in.union_stands);
    row("stands_more", in.union_stands - std::min(in.small_node.stands, in.big_node.stands));
    row("touch_share_small", in.touch_share_small);
    row("touch_share_big", in.touch_share_big);
    row("touch_z", in.touch_z);
    row("touch_area", in.touch_area);
    row("small_on_big", in.small_on_big);
    row("big_on_small", in.big_on_small);
    row("seam_flush", in.seam_flush);
    row("seam_ledge", in.seam_ledge);
    row("seam_pairs", in.seam_pairs);
}

void write_row(const Inputs& in, Row& row) {
    add_border(in, row);
    add_shapes(in, row);
    add_solids(in, row);
}

void Rows::add_row(std::int32_t a, std::int32_t b, const Evidence& e, float* row_values) const {
    const TableView<PrimitiveId, PrimitiveShape> shape(shapes_.of);
    const bool a_is_small = shape[a].area_m2 <= shape[b].area_m2;
    const std::int32_t small = a_is_small ? a : b, big = a_is_small ? b : a;
    Inputs in{shape[small], shape[big], node_of(small), node_of(big)};
    in.border = e.border;
    in.small_is_a = a_is_small;
    in.edge = samples_.spacing_m;
    in.floor = shapes_.low[2];
    in.small_shell = shell_[small];
    in.big_shell = shell_[big];
    const std::array<std::int32_t, 2> both{std::min(a, b), std::max(a, b)};
    in.union_stands =
        margin(candidate_of(contacts_, bodies_, in_shell_, {both.begin(), both.end()}));
    if (e.touching) {
        const auto axis = static_cast<std::size_t>(
            std::max_element(e.touching->normal.begin(), e.touching->normal.end(),
                             [](double x, double y) { return std::abs(x) < std::abs(y); }) -
            e.touching->normal.begin());
        const auto share = [&](std::int32_t p) {
            return e.touching->area_m2 / std::max(contacts_.silhouette_m2[p][axis], 1e-9);
        };
        in.touch_share_small = share(small);
        in.touch_share_big = share(big);
        in.touch_z = (small == e.touching->a ? 1 : -1) * e.touching->normal[2];
        in.touch_area = e.touching->area_m2;
    }
    const auto carried = [&](const Carrying* c, std::int32_t by) {
        return c ? c->area_m2 / std::max(contacts_.section_m2[by], 1e-9) : 0;
    };
    in.small_on_big = carried(small == a ? e.b_carries : e.a_carries, small);
    in.big_on_small = carried(small == a ? e.a_carries : e.b_carries, big);
    const auto seam = seams_.between.find({a, b});
    if (seam != seams_.between.end() && seam->second.pairs > 0) {
        const double pairs = static_cast<double>(seam->second.pairs);
        in.seam_flush = static_cast<double>(seam->second.flush) / pairs;
        in.seam_ledge = static_cast<double>(seam->second.ledge) / pairs;
        in.seam_pairs = std::log1p(pairs);
    }
    Row row(row_values, nullptr);
    write_row(in, row);
}

std::vector<std::string_view> feature_names() {
    std::vector<std::string_view> out;
    const PrimitiveShape shape;
    const Node node;
    Row row(nullptr, &out);
    write_row(Inputs{shape, shape, node, node}, row);
    return out;
}

}  // namespace

std::span<const std::string_view> joint_feature_names() {
    static const std::vector<std::string_view> names = feature_names();
    return names;
}

JointTable joint_features(const geometry::SurfaceSamples& samples,
                          const geometry::PrimitiveShapes& shapes, const ContactGraph& contacts,
                          TableView<PrimitiveId, physics::MassProperties> bodies,
                          const geometry::SurfaceSeams& seams, TableView<PrimitiveId, float> shell,
                          ThreadPool& threads) {
    return Rows(samples, shapes, contacts, bodies, seams, shell, threads).table();
}

}  // namespace topple::graph
