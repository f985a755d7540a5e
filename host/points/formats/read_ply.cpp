// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "io/text.h"
#include "points/formats/cloud_builder.h"
#include "points/formats/formats.h"
#include "points/formats/ply_file.h"
#include "points/formats/point_values.h"
#include "points/formats/scalar.h"
#include "points/formats/splats.h"

namespace topple::io {
namespace {

std::optional<std::size_t> find_property(const std::filesystem::path& file,
                                         const PlyElement& vertex, const std::string& name) {
    std::optional<std::size_t> found;
    for (std::size_t i = 0; i < vertex.properties.size(); ++i) {
        if (vertex.properties[i].name != name) continue;
        if (found) fail(file, "the vertices have two properties " + name);
        if (vertex.properties[i].list_count)
            fail(file, "the vertex property " + name + " is a list");
        found = i;
    }
    return found;
}

ColourValues colour_values(Scalar type) {
    if (type == Scalar::u8) return ColourValues::bytes;
    return type == Scalar::f32 || type == Scalar::f64 ? ColourValues::real : ColourValues::whole;
}

// Whether red, green and blue are those that write_points_ply() gives to objects.
bool coloured_by_object(const PlyElement& vertex) {
    const auto has = [&](std::string_view name) {
        return std::ranges::any_of(vertex.properties,
                                   [&](const PlyProperty& p) { return p.name == name; });
    };
    return has("primitive") && has("object") && !has("object_red");
}

// Passes vertices on to a cloud; of splats those that hide what lies behind.
class Vertices {
  public:
    Vertices(const std::filesystem::path& file, const PlyElement& vertex, const CloudSink* sink)
        : file_(file), vertex_(vertex), splats_(splat_fields(file, vertex)) {
        cloud_.emplace(file, vertex.count, find_values(), sink);
    }

    // Of each vertex: read them, and then call add().
    const std::vector<PointValues::Value>& values() const { return read_.values; }

    void add() {
        ++seen_;
        if (splats_ && !hides(opacity_)) return;
        if (splats_) read_.point.colour = splat_colour(read_.point.colour);
        cloud_->add(read_.point);
    }
    std::uint64_t seen() const { return seen_; }

    PointCloud finish() {
        if (splats_ && seen_ > 0 && cloud_->seen() == 0) {
            fail(file_, std::string("holds ") + counted(seen_, "Gaussian splat") +
                            ", of which none is more than half opaque; there is no surface");
        }
        PointCloud out = cloud_->finish();
        if (splats_) out.notes.push_back(splats_note(cloud_->seen(), seen_));
        return out;
    }

  private:
    CloudFields find_values() {
        const auto find = [&](const std::string& name) {
            return find_property(file_, vertex_, name);
        };
        CloudFields fields =
            read_.take_named(file_, find, "the vertices have no property ", {"n", "normal_"});
        if (!splats_) {
            fields.colours = find_colour();
            return fields;
        }
        // Their normals are all 0.
        read_.values.erase(read_.values.begin() + 3, read_.values.end());
        read_.values.push_back({splats_->opacity, &opacity_});
        const auto& [red, green, blue] = splats_->colour;
        read_.take({red, green, blue}, read_.point.colour);
        return {.colours = ColourValues::bytes};
    }

    // The three channels, under the first of their names of which there are all, and of one type.
    ColourValues find_colour() {
        if (coloured_by_object(vertex_)) return ColourValues::none;
        static constexpr std::array<std::array<const char*, 3>, 3> names{
            {{"red", "green", "blue"},
             {"diffuse_red", "diffuse_green", "diffuse_blue"},
             {"r", "g", "b"}}};
        for (const auto& name : names) {
            PointValues::Columns at;
            for (std::size_t c = 0; c < 3; ++c) at[c] = find_property(file_, vertex_, name[c]);
            if (!at[0] || !at[1] || !at[2]) continue;
            const auto type = [&](std::size_t c) { return vertex_.properties[*at[c]].type; };
            if (type(1) != type(0) || type(2) != type(0)) continue;
            read_.take(at, read_.point.colour);
            return colour_values(type(0));
        }
        return ColourValues::none;
    }

    const std::filesystem::path& file_;
    const PlyElement& vertex_;
    std::optional<SplatFields> splats_;  // then colour is where theirs are
    PointValues read_;
    double opacity_ = 0;
    std::optional<CloudBuilder> cloud_;
    std::uint64_t seen_ = 0;
};

// The items of a text file: each is one line.
class TextVertices {
  public:
    TextVertices(const std::filesystem::path& file, std::string_view bytes, const PlyHeader& header)
        : file_(file), lines_(bytes, header.data_offset, header.lines) {}

    void expect(const PlyElement& element) const {
        // Each value takes a character and a separator; the last line may lack its end.
        const auto needed = saturating_multiply(
            element.count, std::max<std::uint64_t>(1, 2 * element.properties.size()));
        if (needed > lines_.remaining() + 1)
            ply_cut_short(file_, element, needed - 1, lines_.remaining());
    }
    void step_over_all(const PlyElement& element) {
        for (std::uint64_t i = 0; i < element.count; ++i) {
            if (!lines_.next(rest_))
                ply_cut_short(file_, element, saturating_multiply(element.count - i, 2), 0);
        }
    }
    void read_all(const PlyElement& element, Vertices& vertices) {
        std::vector<double*> place(element.properties.size(), nullptr);
        for (const auto& [column, to] : vertices.values()) place[column] = to;
        while (vertices.seen() < element.count) {
            if (!lines_.next(rest_)) {
                fail(file_, "the header promises " + std::to_string(element.count) +
                                " vertices, the file has " + std::to_string(vertices.seen()) +
                                "; it is cut short, or its header is wrong");
            }
            for (std::size_t i = 0; i < place.size(); ++i) {
                const auto token = next_token(rest_);
                if (token.empty()) {
                    bad(std::to_string(i) + " of the " + counted(place.size(), "value") +
                        " that each vertex has");
                }
                if (element.properties[i].list_count) {
                    step_over_list(token);
                } else if (place[i] && !parse_number(token, *place[i])) {
                    bad(in_quotes(token) + " is not a number");
                }
            }
            if (!next_token(rest_).empty())
                bad("more than the " + counted(place.size(), "value") + " that each vertex has");
            vertices.add();
        }
    }

  private:
    [[noreturn]] void bad(const std::string& message) const {
        fail(file_, "line " + std::to_string(lines_.number()) + ": " + message);
    }
    void step_over_list(std::string_view token) {
        std::uint64_t length = 0;
        if (!parse_count(token, length)) bad(in_quotes(token) + " is no length of a list");
        for (; length > 0; --length) {
            if (next_token(rest_).empty()) bad("a list has fewer values than its length says");
        }
    }

    const std::filesystem::path& file_;
    Lines lines_;
    std::string_view rest_;  // of the line
};

class BinaryVertices : public PlyItems {
  public:
    using PlyItems::PlyItems;

    void read_all(const PlyElement& element, Vertices& vertices) {
        // Where each property of the current vertex starts.
        std::vector<const char*> starts(element.properties.size());
        const bool fixed = !element.has_lists();
        const auto stride = element.least_bytes();
        for (std::uint64_t i = 0; i < element.count; ++i) {
            if (!fixed || i == 0) {
                step_over(element, i, starts.data());
            } else {
                for (auto& start : starts) start += stride;
            }
            for (const auto& [column, to] : vertices.values())
                *to = load_scalar(element.properties[column].type, starts[column], swapped());
            vertices.add();
        }
        if (fixed && element.count > 0) {
            PlyElement others = element;  // than the first, which was stepped over
            --others.count;
            step_over_all(others);
        }
    }
};

// The vertices; but where the file ends before what the header promises of any element does, it is
// cut short, even if they are all there.
template <class Items>
PointCloud read_vertices(const std::filesystem::path& file, const PlyHeader& header, Items items,
                         const CloudSink* sink) {
    std::optional<Vertices> vertices;
    for (const PlyElement& element : header.elements) {
        // Those behind without any property take no room, and are nobody's.
        if (vertices && element.properties.empty()) continue;
        if (!vertices) items.expect(element);
        if (element.name == "vertex")
            items.read_all(element, vertices.emplace(file, element, sink));
        else
            items.step_over_all(element);
    }
    if (!vertices) fail(file, "has no element vertex");
    return vertices->finish();
}

}  // namespace

PointCloud parse_ply(const std::filesystem::path& file, std::string_view bytes,
                     const CloudSink* sink) {
    const auto header = parse_ply_header(file, bytes);
    return header.encoding == PlyEncoding::ascii
               ? read_vertices(file, header, TextVertices(file, bytes, header), sink)
               : read_vertices(file, header, BinaryVertices(file, bytes, header), sink);
}

}  // namespace topple::io
