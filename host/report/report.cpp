// SPDX-License-Identifier: MIT
#include "report/report.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <ctime>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/json.h"
#include "core/printable.h"
#include "core/thread_pool.h"
#include "io/file_writer.h"
#include "io/palette.h"
#include "io/replace_file.h"
#include "io/text.h"
#include "report/drawing.h"
#include "report/embedded.h"
#include "report/page_parts.h"
#include "report/view_data.h"
#include "result/scene_json.h"
#include "safety/disturbances.h"
#include "safety/earthquake/fragility.h"
#include "safety/earthquake/intensity.h"

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
              {"cell", deflated(records.cell)},
              {"aux", deflated(records.aux)}};
    if (!records.photo.empty()) json["photo"] = deflated(records.photo);
    return json;
}

// Normals only shade, which takes few digits: to multiples of `unit`, a power of 2.
std::vector<std::array<std::int8_t, 4>> rounded_normals(std::vector<std::array<std::int8_t, 4>> aux,
                                                        int unit) {
    for (auto& record : aux) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const int nearest = (record[axis] + 128 + unit / 2) / unit * unit - 128;
            record[axis] = static_cast<std::int8_t>(std::min(nearest, 128 - unit));
        }
    }
    return aux;
}

// In the order of a curve that fills space (Morton's), along which neighbours are alike.
Records along_a_curve(const Records& records) {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
    const auto spread = [](std::uint64_t v) {
        std::uint64_t out = 0;
        for (unsigned bit = 0; bit < 16; ++bit) out |= (v >> bit & 1) << (3 * bit);
        return out;
    };
    for (std::uint32_t i = 0; i < records.cell.size(); ++i) {
        const auto& c = records.cell[i];
        order.emplace_back(spread(c[0]) | spread(c[1]) << 1 | spread(c[2]) << 2, i);
    }
    std::ranges::sort(order);
    Records out;
    for (const auto& [key, i] : order) out.add(records.at(i), !records.photo.empty());
    out.total = records.total;
    return out;
}

Json points_json(const Records& points) {
    Records sorted = along_a_curve(points);
    sorted.aux = rounded_normals(std::move(sorted.aux), 8);
    return records_json(sorted);
}

// All numbers of some rows, one after the other, each to the nearest part of one.
template <class Rows>
Json rounded(const Rows& rows, double parts) {
    Json numbers = Json::array();
    for (const auto& row : rows)
        for (const double x : row) numbers.push_back(std::round(parts * x) / parts);
    return numbers;
}

// To a tenth of a millimetre.
Json spots_json(const PackedView& view) {
    Json spots = Json::array();
    for (const auto& spot : view.spots)
        spots.push_back(spot ? rounded(std::array<Vec3, 1>{*spot}, 10000) : Json::array());
    return spots;
}

Json surface_json(const PackedSurface& surface, ThreadPool& pool) {
    std::array<std::string, 4> parts;
    pool.each(parts.size(), 1, [&](std::size_t n) {
        parts[n] = n == 0   ? deflated(surface.cell)
                   : n == 1 ? deflated(rounded_normals(surface.aux, 4))
                   : n == 2 ? deflated_plain(surface.index)
                            : deflated(surface.photo);
    });
    Json json{{"count", surface.cell.size()},
              {"triangles", surface.index.size()},
              {"cell", std::move(parts[0])},
              {"aux", std::move(parts[1])},
              {"index", std::move(parts[2])}};
    if (!surface.photo.empty()) json["photo"] = std::move(parts[3]);
    return json;
}

// Places to the millimetre.
Json walks_json(const PackedWalks& walks) {
    Json paths = Json::array();
    for (const auto& path : walks.paths) paths.push_back(rounded(path, 1000));
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

// points: of the view, as the page has them.
Json view_json(const PackedView& view, Json points, ThreadPool& pool) {
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
            {"spots", spots_json(view)},
            {"voxels", records_json(view.voxels)},
            {"points", std::move(points)},
            {"surface", surface_json(view.surface, pool)},
            {"fields", std::move(fields)},
            {"walks", walks_json(view.walks)}};
}

Json point_json(const Point& p) {
    return rounded(std::array<Point, 1>{p}, 10);
}

// As short as it can be: a scene has hundreds of these.
Json drawing_json(const Drawing& d) {
    constexpr std::array styles{"axis", "curve", "border", "pass", "lowest", "pose", "now"};
    constexpr std::array anchors{"start", "middle", "end"};
    const auto style = [&](Drawing::Style s) { return styles[static_cast<std::size_t>(s)]; };
    Json strokes = Json::array(), dots = Json::array(), labels = Json::array(),
         swatches = Json::array();
    for (const Drawing::Stroke& stroke : d.strokes)
        strokes.push_back({style(stroke.style), rounded(stroke.points, 10)});
    for (const Drawing::Dot& dot : d.dots)
        dots.push_back({style(dot.style), point_json(dot.at), dot.radius});
    for (const Drawing::Label& label : d.labels)
        labels.push_back({anchors[static_cast<std::size_t>(label.anchor)], point_json(label.at),
                          label.strong, label.text});
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

// What the page is to say of disturbances and how it draws them.
Json disturbances_json(const Scene& scene) {
    static constexpr std::array strengths{"visits", "mean", "speed"};
    auto kinds = Json::array();
    for (const safety::DisturbanceKind* kind : safety::disturbance_kinds()) {
        // What few runs have says nothing where it is missing.
        if (kind->acts && !scene.fields.contains(kind->name)) continue;
        const safety::DisturbanceWords& words = kind->words;
        const auto& arrows = words.arrows;
        const auto& figure = words.figure;
        kinds.push_back({{"name", kind->name},
                         {"cause", words.cause},
                         {"event", words.event},
                         {"one_event", words.one_event},
                         {"everyday", kind->everyday},
                         {"may_be_left_out", kind->left_out_below_none != nullptr},
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

// By the upper ends of their ranges, null for none.
Json shakings_json() {
    auto all = Json::array();
    for (const auto& [up_to_g, word, intensity] : safety::intensities())
        all.push_back({std::isfinite(up_to_g) ? Json(up_to_g) : Json(), word, intensity});
    return all;
}

// Ids of the objects that fall in weaker earthquakes than those that the hazard curve tells of.
Json below_hazard_json(const Scene& scene) {
    auto ids = Json::array();
    const auto from = scene.events.find("hazard_from_g");
    if (from == scene.events.end()) return ids;
    for (const Object& o : scene.objects)
        if (!o.grounded && safety::falls_below(o.fragility, from->second)) ids.push_back(o.id);
    return ids;
}

// The last part of a path; what else names a source is that name.
std::string source_name(const std::string& source) {
    const auto end = source.find_last_not_of('/');
    if (end == std::string::npos) return source;
    return std::filesystem::path(source.substr(0, end + 1)).filename().string();
}

// All that a stranger may have written is read by a person: what steers a terminal or turns the
// direction of text is not to be in it.
void make_printable(Json& json) {
    if (json.is_string()) {
        json = printable(json.get_ref<const std::string&>(), std::string::npos);
    } else if (json.is_structured()) {
        for (Json& inner : json) make_printable(inner);
    }
}

// In universal time: "2026-01-31".
std::string today() {
    const std::time_t now = std::time(nullptr);
    std::tm date{};
    gmtime_r(&now, &date);
    char text[16];
    return {text, std::strftime(text, sizeof(text), "%Y-%m-%d", &date)};
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
    std::string title;
    ViewPacker view;
    Json data, points;
};

Report::Report(const Scene& scene, bool with_surfaces, ReportWords words)
    : parts_(new Parts{printable(words.title.empty() ? source_name(scene.source) : words.title,
                                 std::string::npos),
                       {scene, {}, with_surfaces},
                       io::scene_document(scene),
                       {}}) {
    parts_->points = points_json(parts_->view.points());
    Json& json = parts_->data;
    make_printable(json);
    // What is long and nobody but the page reads there.
    for (const char* bulk : {"primitives", "contacts", "swc_energy"})
        json[bulk] = deflated(json[bulk].dump());
    for (const char* later : {"colours", "view"}) json[later] = nullptr;
    json["drawings"] = deflated(landscapes_json(scene).dump());
    json["ramp"] = {{"colours", ramp}, {"bands", bands}};
    json["disturbance_kinds"] = disturbances_json(scene);
    json["unsafety_ramp"] = unsafety_ramp;
    json["unranked_colour"] = unranked_colour;
    json["shakings"] = shakings_json();
    json["below_hazard"] = below_hazard_json(scene);
    json["title"] = parts_->title;
    json["made"] = today();
    json["command"] = std::move(words.command);
    make_printable(json["command"]);
}
Report::~Report() = default;

void Report::write(const std::filesystem::path& file, std::span<const ObjectSurface> surfaces,
                   unsigned threads) {
    ThreadPool pool(threads);
    Json& json = parts_->data;
    {
        const PackedView view = parts_->view.pack(surfaces, pool);
        json["colours"] = colours_json(view);
        json["view"] = view_json(view, std::move(parts_->points), pool);
    }
    const auto data = script_safe(json.dump(-1, ' ', false, Json::error_handler_t::replace));
    const auto title = html_escaped(parts_->title);
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

bool add_verification(const std::filesystem::path& report, const std::string& json) {
    constexpr std::string_view begin = "<script type=\"application/json\" id=\"verified\">";
    constexpr std::string_view end = "</script>";
    const io::FileBytes bytes =
        io::read_file(io::FileName::beside(report, report.filename()), std::uint64_t{256} << 20);
    const std::string_view page = bytes.text();
    // In what is embedded before it no < begins anything: the first is the page's own.
    const std::size_t at = page.find(begin);
    if (at == page.npos) return false;
    const std::size_t from = at + begin.size(), to = page.find(end, from);
    if (to == page.npos) return false;
    std::string out;
    out.reserve(page.size() + json.size());
    out.append(page.substr(0, from)).append(script_safe(json)).append(page.substr(to));
    io::replace_file(report, out);
    return true;
}

}  // namespace topple::report
