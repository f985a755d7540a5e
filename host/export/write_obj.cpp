// SPDX-License-Identifier: MIT
#include "export/write_obj.h"

#include <map>
#include <vector>

#include "core/vectors.h"
#include "export/colour_texture.h"
#include "export/export_folder.h"
#include "export/text.h"

namespace topple::exports {
namespace {

// A hundredth of a millimetre: what is seen need not be finer.
constexpr int visual_digits = 5, normal_digits = 3, texel_digits = 7;

void add_vector(std::string& out, const char* what, const auto& v, int digits) {
    out += what;
    for (const double each : v) {
        out += ' ';
        append_fixed(out, each, digits);
    }
    out += '\n';
}

}  // namespace

std::string part_obj(const ConvexPart& part, const Vec3& center_m) {
    std::string out(text_mark);
    for (const Vec3& c : part.corner) append(out, "v ", text(minus(c, center_m)), "\n");
    for (const auto& outline : part.outline) {
        for (std::size_t n = 1; n + 1 < outline.size(); ++n) {
            out += 'f';
            for (const std::uint32_t v : {outline[0], outline[n], outline[n + 1]})
                append(out, " ", std::to_string(v + 1));
            out += '\n';
        }
    }
    return out;
}

std::string visual_obj(const Visual& visual) {
    std::string out(text_mark);
    out.reserve(64 * visual.vertex.size() + 48 * visual.triangle.size());
    append(out, "mtllib ", material_file, "\n");
    for (const Vec3& v : visual.vertex) add_vector(out, "v", v, visual_digits);
    for (const Vec3& n : visual.normal) add_vector(out, "vn", n, normal_digits);
    std::vector<std::uint32_t> texel;
    for (const auto& triangle : visual.triangle) {
        ColourSum colours;
        for (const std::uint32_t v : triangle) colours.add(visual.colour[v]);
        texel.push_back(texel_of(colours.mean()));
    }
    std::map<std::uint32_t, std::string> number;  // of each texel that is used
    for (const std::uint32_t each : texel) number.try_emplace(each);
    std::size_t numbered = 0;
    for (auto& [each, written] : number) {
        written = std::to_string(++numbered);
        add_vector(out, "vt", middle_of_texel(each), texel_digits);
    }
    out += "usemtl colours\n";
    for (std::size_t n = 0; n < visual.triangle.size(); ++n) {
        out += 'f';
        for (const std::uint32_t v : visual.triangle[n]) {
            const std::string vertex = std::to_string(v + 1);
            append(out, " ", vertex, "/", number[texel[n]], "/", vertex);
        }
        out += '\n';
    }
    return out;
}

std::string material() {
    return joined(text_mark, "newmtl colours\nKa 1 1 1\nKd 1 1 1\nKs 0 0 0\nillum 1\nmap_Kd ",
                  colour_file, "\n");
}

}  // namespace topple::exports
