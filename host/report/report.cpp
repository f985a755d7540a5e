// SPDX-License-Identifier: MIT
#include "report/report.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "core/json.h"
#include "io/file_writer.h"
#include "io/palette.h"
#include "io/scene_json.h"
#include "report/base64.h"
#include "report/drawing.h"
#include "report/page_parts.h"
#include "report/script_safe.h"
#include "report/view_data.h"
#include "safety/disturbances.h"

namespace topple::report {
namespace {

using Json = OrderedJson;

// Typed arrays in the page are little-endian on every machine that runs a browser.
static_assert(std::endian::native == std::endian::little,
              "swap the records' bytes before packing them");

template <class T>
std::string packed(const std::vector<T>& records) {
    return base64(records.data(), records.size() * sizeof(T));
}

Json records_json(const Records& records) {
    Json json{{"count", records.cell.size()},
              {"total", records.total},
              {"cell", packed(records.cell)},
              {"aux", packed(records.aux)}};
    if (!records.photo.empty()) json["photo"] = packed(records.photo);
    return json;
}

Json surface_json(const PackedSurface& surface) {
    Json json{{"count", surface.cell.size()},
              {"triangles", surface.index.size()},
              {"cell", packed(surface.cell)},
              {"aux", packed(surface.aux)},
              {"index", packed(surface.index)}};
    if (!surface.photo.empty()) json["photo"] = packed(surface.photo);
    return json;
}

// Places to the millimetre.
Json walks_json(const PackedWalks& walks) {
    Json paths = Json::array();
    for (const auto& path : walks.paths) {
        Json corners = Json::array();
        for (const auto& corner : path)
            for (const float x : corner) corners.push_back(std::round(1000 * double{x}) / 1000);
        paths.push_back(std::move(corners));
    }
    return {{"nx", walks.nx},
            {"ny", walks.ny},
            {"corner_m", walks.corner_m},
            {"along_x_m", walks.along_x_m},
            {"along_y_m", walks.along_y_m},
            {"shade", packed(walks.shade)},
            {"floor_mm", packed(walks.floor_mm)},
            {"most", walks.most},
            {"paths", std::move(paths)}};
}

Json view_json(const PackedView& view) {
    Json groups = Json::array();
    for (const auto& [primitive, object] : view.groups) groups.push_back({primitive, object});
    Json fields = Json::object();
    for (const auto& [name, arrows] : view.fields) {
        fields[name] = {{"count", arrows.arrow.size()},
                        {"total", arrows.total},
                        {"arrow", packed(arrows.arrow)}};
    }
    return {{"view_from_input", view.view_from_input},
            {"origin_m", view.origin_m},
            {"step_m", view.step_m},
            {"cube_m", view.cube_m},
            {"groups", std::move(groups)},
            {"voxels", records_json(view.voxels)},
            {"points", records_json(view.points)},
            {"surface", surface_json(view.surface)},
            {"fields", std::move(fields)},
            {"walks", walks_json(view.walks)}};
}

Json point_json(const Point& p) {
    return {std::round(10 * p[0]) / 10, std::round(10 * p[1]) / 10};
}

// As short as it can be: a scene has hundreds of these.
Json drawing_json(const Drawing& d) {
    constexpr std::array styles{"axis", "curve", "border", "pass", "lowest", "pose", "now"};
    constexpr std::array anchors{"start", "middle", "end"};
    const auto style = [&](Drawing::Style s) { return styles[static_cast<std::size_t>(s)]; };
    Json strokes = Json::array(), dots = Json::array(), labels = Json::array(),
         swatches = Json::array();
    for (const Drawing::Stroke& stroke : d.strokes) {
        Json points = Json::array();
        for (const Point& p : stroke.points)
            for (const double x : p) points.push_back(std::round(10 * x) / 10);
        strokes.push_back({style(stroke.style), std::move(points)});
    }
    for (const Drawing::Dot& dot : d.dots)
        dots.push_back({style(dot.style), point_json(dot.at), dot.radius});
    for (const Drawing::Label& label : d.labels) {
        labels.push_back({anchors[static_cast<std::size_t>(label.align)], point_json(label.at),
                          label.strong, label.text});
    }
    for (const Drawing::Swatch& s : d.swatches)
        swatches.push_back({s.colour, point_json(s.corner), s.width, s.height});
    Json json{{"title", d.title},
              {"width", d.width},
              {"height", d.height},
              {"strokes", std::move(strokes)},
              {"dots", std::move(dots)},
              {"labels", std::move(labels)},
              {"swatches", std::move(swatches)}};
    if (d.sphere) {
        const double unit = d.sphere->highest_m / 32767;
        std::vector<std::int16_t> corners;
        for (const Vec3& v : d.sphere->corners)
            for (const double x : v)
                corners.push_back(static_cast<std::int16_t>(std::lround(x / unit)));
        json["sphere"] = {{"middle", d.sphere->middle},
                          {"radius", d.sphere->radius},
                          {"low", d.sphere->lowest_m / unit},
                          {"high", d.sphere->highest_m / unit},
                          {"corners", packed(corners)}};
    }
    if (d.raster) {
        json["raster"] = {{"corner", d.raster->corner},
                          {"size", d.raster->size},
                          {"side", d.raster->side},
                          {"palette", d.raster->palette},
                          {"code", packed(d.raster->code)}};
    }
    return json;
}

// By object id; the most unsafe objects first, as far as they find room.
Json landscapes_json(const Scene& scene) {
    constexpr std::size_t most_bytes = 2'000'000;
    std::vector<const Object*> order;
    for (const Object& object : scene.objects) order.push_back(&object);
    std::ranges::stable_sort(order, [](const Object* a, const Object* b) {
        return (std::isnan(a->unsafety) ? 0 : a->unsafety) >
               (std::isnan(b->unsafety) ? 0 : b->unsafety);
    });
    Json all = Json::object();
    std::size_t bytes = 0;
    for (const Object* object : order) {
        Json drawings = Json::array();
        for (const Drawing& d : landscape_drawings(scene, *object))
            drawings.push_back(drawing_json(d));
        const std::size_t size = drawings.dump().size();
        if (bytes + size > most_bytes) break;
        bytes += size;
        all[std::to_string(object->id)] = std::move(drawings);
    }
    return all;
}

// The palette that the .ply files use, for the ids that occur.
Json colours_json(const PackedView& view) {
    std::int32_t most = -1;
    for (const auto& [primitive, object] : view.groups) most = std::max({most, primitive, object});
    Json colours = Json::array();
    for (std::int32_t id = 0; id <= std::min(most, 65535); ++id)
        colours.push_back(io::colour_of(id));
    return colours;
}

std::string html_escaped(std::string_view text) {
    std::string out;
    for (const char c : text) {
        switch (c) {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '"':
                out += "&quot;";
                break;
            default:
                out += c;
        }
    }
    return out;
}

// What the page is to say of disturbances and how it draws them.
Json disturbances_json() {
    static constexpr std::array strengths{"visits", "mean", "speed"};
    auto kinds = Json::array();
    for (const safety::DisturbanceKind* kind : safety::disturbance_kinds()) {
        const auto& [cause, event, one_event, column, doing, mend, arrows, figure] = kind->words;
        kinds.push_back({{"name", kind->name},
                         {"cause", cause},
                         {"event", event},
                         {"one_event", one_event},
                         {"strength", strengths[static_cast<std::size_t>(arrows.strength)]},
                         {"at_tip", arrows.at_tip},
                         {"below_things", arrows.below_things},
                         {"legend", arrows.legend},
                         {"scale", arrows.scale},
                         {"unit", arrows.unit},
                         {"figure",
                          {{"key", figure.key},
                           {"follows", figure.follows},
                           {"name", figure.name},
                           {"unit", figure.unit}}}});
    }
    return kinds;
}

// Writes the template with its @NAMES@ filled in, one pass: what is filled in is not searched.
void write_page(io::FileWriter& writer, std::string_view html,
                std::initializer_list<std::pair<std::string_view, std::string_view>> parts) {
    for (const auto& [name, text] : parts) {
        const auto at = html.find(name);
        if (at == std::string_view::npos)
            throw std::logic_error("page.html has no " + std::string(name));
        writer.write(html.substr(0, at));
        writer.write(text);
        html.remove_prefix(at + name.size());
    }
    writer.write(html);
}

}  // namespace

struct Report::Parts {
    std::string source;
    ViewPacker view;
    Json data;
};

Report::Report(const Scene& scene, bool with_surfaces)
    : parts_(new Parts{scene.source, {scene, {}, with_surfaces}, io::scene_document(scene)}) {
    Json& json = parts_->data;
    for (const char* later : {"colours", "view"}) json[later] = nullptr;
    json["drawings"] = landscapes_json(scene);
    json["ramp"] = {{"colours", ramp}, {"bands", bands}};
    json["disturbance_kinds"] = disturbances_json();
    json["unsafety_ramp"] = unsafety_ramp;
    json["unranked_colour"] = unranked_colour;
}
Report::~Report() = default;

void Report::write(const std::filesystem::path& file, std::span<const ObjectSurface> surfaces) {
    Json& json = parts_->data;
    {
        const PackedView view = parts_->view.pack(surfaces);
        json["colours"] = colours_json(view);
        json["view"] = view_json(view);
    }
    const auto data = script_safe(json.dump(-1, ' ', false, Json::error_handler_t::replace));
    const auto title = html_escaped(parts_->source);
    io::FileWriter writer(file);
    write_page(writer, page::html,
               {{"@TITLE@", title},
                {"@STYLE@", page::style},
                {"@DATA@", data},
                {"@THREE@", page::three},
                {"@CONTROLS@", page::controls},
                {"@SCRIPT@", page::script}});
    writer.close();
}

void write_report(const std::filesystem::path& file, const Scene& scene,
                  std::span<const ObjectSurface> surfaces) {
    Report(scene, !surfaces.empty()).write(file, surfaces);
}

}  // namespace topple::report
