// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "io/text.h"
#include "points/formats/cloud_builder.h"
#include "points/formats/formats.h"
#include "points/formats/ply_file.h"
#include "points/formats/scalar.h"
#include "points/formats/splats.h"

namespace topple::io {
namespace {

// Where in a vertex the coordinates, the normal and the colour are: indices into its properties.
struct PlyWanted {
    std::array<std::size_t, 3> point{}, normal{}, colour{}, viewpoint{};
    CloudFields fields;
    std::optional<SplatFields> splats;  // then colour is where theirs are
};

std::optional<std::size_t> find_property(const std::filesystem::path& file,
                                         const PlyElement& vertex, std::string_view name) {
    std::optional<std::size_t> found;
    for (std::size_t i = 0; i < vertex.properties.size(); ++i) {
        if (vertex.properties[i].name != name) continue;
        if (found) fail(file, "the vertices have two properties " + std::string(name));
        if (vertex.properties[i].list_count)
            fail(file, "the vertex property " + std::string(name) + " is a list");
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

// The three channels, under the first of their names of which there are all, and of one type.
void find_colour(const std::filesystem::path& file, const PlyElement& vertex, PlyWanted& wanted) {
    if (coloured_by_object(vertex)) return;
    static constexpr std::array<std::array<const char*, 3>, 3> names{
        {{"red", "green", "blue"},
         {"diffuse_red", "diffuse_green", "diffuse_blue"},
         {"r", "g", "b"}}};
    for (const auto& name : names) {
        std::array<std::optional<std::size_t>, 3> at;
        for (std::size_t c = 0; c < 3; ++c) at[c] = find_property(file, vertex, name[c]);
        if (!at[0] || !at[1] || !at[2]) continue;
        const Scalar type = vertex.properties[*at[0]].type;
        if (vertex.properties[*at[1]].type != type || vertex.properties[*at[2]].type != type)
            continue;
        wanted.colour = {*at[0], *at[1], *at[2]};
        wanted.fields.colours = colour_values(type);
        return;
    }
}

PlyWanted find_wanted(const std::filesystem::path& file, const PlyElement& vertex) {
    PlyWanted wanted;
    wanted.splats = splat_fields(file, vertex);
    static constexpr std::array<const char*, 3> point{"x", "y", "z"};
    static constexpr std::array<const char*, 3> normal{"nx", "ny", "nz"},
        long_normal{"normal_x", "normal_y", "normal_z"};
    static constexpr std::array<const char*, 3> viewpoint{"vp_x", "vp_y", "vp_z"};
    int normals = 0, viewpoints = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto at = find_property(file, vertex, point[axis]);
        if (!at)
            fail(file, std::string("the vertices have no property ") + point[axis] +
                           "; x, y and z are needed");
        wanted.point[axis] = *at;
        auto of_normal = find_property(file, vertex, normal[axis]);
        if (!of_normal) of_normal = find_property(file, vertex, long_normal[axis]);
        if (of_normal) {
            wanted.normal[axis] = *of_normal;
            ++normals;
        }
        if (const auto eye = find_property(file, vertex, viewpoint[axis])) {
            wanted.viewpoint[axis] = *eye;
            ++viewpoints;
        }
    }
    wanted.fields.normals = normals == 3;
    wanted.fields.viewpoints = viewpoints == 3;
    if (wanted.splats) {
        wanted.colour = wanted.splats->colour;
        // Their normals are all 0.
        wanted.fields = {.normals = false, .viewpoints = false, .colours = ColourValues::bytes};
    } else {
        find_colour(file, vertex, wanted);
    }
    return wanted;
}

// The elements that come after the vertices. Where the file ends before what the header promises of
// them does, it is cut short, even if all vertices are there. Those without any property take no
// room, and are nobody's.
std::vector<const PlyElement*> after(const PlyHeader& header, const PlyElement& vertices) {
    std::vector<const PlyElement*> out;
    bool behind = false;
    for (const PlyElement& element : header.elements) {
        if (behind && !element.properties.empty()) out.push_back(&element);
        behind = behind || &element == &vertices;
    }
    return out;
}

// Passes vertices on to a cloud; of splats those that hide what lies behind.
class Vertices {
  public:
    Vertices(const std::filesystem::path& file, std::uint64_t promised, const PlyWanted& wanted,
             const CloudSink* sink)
        : file_(file), splats_(wanted.splats), cloud_(file, promised, wanted.fields, sink) {}

    void add(const std::array<double, 3>& point, const std::array<double, 3>& normal,
             const std::array<double, 3>& colour, const std::array<double, 3>& viewpoint,
             double opacity) {
        ++seen_;
        if (!splats_) {
            cloud_.add(point, normal, colour, viewpoint);
        } else if (hides(opacity)) {
            cloud_.add(point, normal, splat_colour(colour));
        }
    }
    std::uint64_t seen() const { return seen_; }

    PointCloud finish() {
        if (splats_ && seen_ > 0 && cloud_.seen() == 0) {
            fail(file_, std::string("holds ") + counted(seen_, "Gaussian splat") +
                            ", of which none is more than half opaque; there is no surface");
        }
        PointCloud out = cloud_.finish();
        if (splats_) out.notes.push_back(splats_note(cloud_.seen(), seen_));
        return out;
    }

  private:
    const std::filesystem::path& file_;
    std::optional<SplatFields> splats_;
    CloudBuilder cloud_;
    std::uint64_t seen_ = 0;
};

// Reads vertex lines. Every item is one line.
PointCloud read_ascii(const std::filesystem::path& file, std::string_view bytes,
                      const PlyHeader& header, const CloudSink* sink) {
    Lines lines(bytes, header.data_offset, header.lines);
    std::string_view line;
    for (const auto& element : header.elements) {
        const bool is_vertex = element.name == "vertex";
        // Each value takes a character and a separator; the last line may lack its end.
        const auto needed = saturating_multiply(
            element.count, std::max<std::uint64_t>(1, 2 * element.properties.size()));
        if (needed > lines.remaining() + 1)
            ply_cut_short(file, element, needed - 1, lines.remaining());
        if (!is_vertex) {
            for (std::uint64_t i = 0; i < element.count; ++i) {
                if (!lines.next(line)) ply_cut_short(file, element, needed, 0);
            }
            continue;
        }
        const auto wanted = find_wanted(file, element);
        Vertices cloud(file, element.count, wanted, sink);
        const bool coloured = wanted.fields.colours != ColourValues::none;
        // Where each value on the line goes; null: nowhere.
        std::array<double, 3> point{}, normal{}, colour{}, viewpoint{};
        double opacity = 0;
        std::vector<double*> place(element.properties.size(), nullptr);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            place[wanted.point[axis]] = &point[axis];
            if (wanted.fields.normals) place[wanted.normal[axis]] = &normal[axis];
            if (coloured) place[wanted.colour[axis]] = &colour[axis];
            if (wanted.fields.viewpoints) place[wanted.viewpoint[axis]] = &viewpoint[axis];
        }
        if (wanted.splats) place[wanted.splats->opacity] = &opacity;
        const auto bad = [&](const std::string& message) {
            fail(file, "line " + std::to_string(lines.number()) + ": " + message);
        };
        while (cloud.seen() < element.count) {
            if (!lines.next(line)) {
                fail(file, "the header promises " + std::to_string(element.count) +
                               " vertices, the file has " + std::to_string(cloud.seen()) +
                               "; it is cut short, or its header is wrong");
            }
            auto rest = line;
            for (std::size_t i = 0; i < place.size(); ++i) {
                const auto token = next_token(rest);
                if (token.empty()) {
                    bad(std::to_string(i) + " of the " + counted(place.size(), "value") +
                        " that each vertex has");
                }
                if (element.properties[i].list_count) {
                    std::uint64_t length = 0;
                    if (!parse_count(token, length))
                        bad(in_quotes(token) + " is no length of a list");
                    for (; length > 0; --length) {
                        if (next_token(rest).empty())
                            bad("a list has fewer values than its length says");
                    }
                } else if (place[i] && !parse_number(token, *place[i])) {
                    bad(in_quotes(token) + " is not a number");
                }
            }
            if (!next_token(rest).empty()) {
                bad("more than the " + counted(place.size(), "value") + " that each vertex has");
            }
            cloud.add(point, normal, colour, viewpoint, opacity);
        }
        for (const PlyElement* rest : after(header, element)) {
            for (std::uint64_t i = 0; i < rest->count; ++i) {
                if (!lines.next(line))
                    ply_cut_short(file, *rest, saturating_multiply(rest->count - i, 2), 0);
            }
        }
        return cloud.finish();
    }
    fail(file, "has no element vertex");
}

// Reads the vertices of a binary file.
PointCloud read_binary(const std::filesystem::path& file, std::string_view bytes,
                       const PlyHeader& header, const CloudSink* sink) {
    PlyItems items(file, bytes, header);
    for (const auto& element : header.elements) {
        if (element.name != "vertex") {
            items.step_over_all(element);
            continue;
        }
        items.expect(element);
        const auto wanted = find_wanted(file, element);
        Vertices cloud(file, element.count, wanted, sink);
        const bool coloured = wanted.fields.colours != ColourValues::none;
        // Where each property of the current vertex starts.
        std::vector<const char*> starts(element.properties.size());
        const auto load_one = [&](std::size_t which) {
            return load_scalar(element.properties[which].type, starts[which], items.swapped());
        };
        const auto load = [&](const std::array<std::size_t, 3>& which) {
            return std::array{load_one(which[0]), load_one(which[1]), load_one(which[2])};
        };
        const bool fixed = !element.has_lists();
        const auto stride = element.least_bytes();
        for (std::uint64_t i = 0; i < element.count; ++i) {
            if (!fixed || i == 0) {
                items.step_over(element, i, starts.data());
            } else {
                for (auto& start : starts) start += stride;
            }
            cloud.add(load(wanted.point),
                      wanted.fields.normals ? load(wanted.normal) : std::array<double, 3>{},
                      coloured ? load(wanted.colour) : std::array<double, 3>{},
                      wanted.fields.viewpoints ? load(wanted.viewpoint) : std::array<double, 3>{},
                      wanted.splats ? load_one(wanted.splats->opacity) : 0);
        }
        if (fixed && element.count > 0) {
            PlyElement others = element;  // than the first, which was stepped over
            --others.count;
            items.step_over_all(others);
        }
        for (const PlyElement* rest : after(header, element)) items.step_over_all(*rest);
        return cloud.finish();
    }
    fail(file, "has no element vertex");
}

}  // namespace

PointCloud parse_ply(const std::filesystem::path& file, std::string_view bytes,
                     const CloudSink* sink) {
    const auto header = parse_ply_header(file, bytes);
    return header.encoding == PlyEncoding::ascii ? read_ascii(file, bytes, header, sink)
                                                 : read_binary(file, bytes, header, sink);
}

}  // namespace topple::io
