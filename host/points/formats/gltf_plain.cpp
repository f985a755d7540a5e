// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <map>
#include <vector>

#include "io/json_text.h"
#include "io/text.h"
#include "points/formats/gltf.h"
#include "points/formats/scalar.h"

namespace topple::io {
namespace {

namespace fs = std::filesystem;
using json = Json;

constexpr std::uint64_t float_type = 5126, index_type = 5125;

std::uint64_t whole(const json& object, const char* key, std::uint64_t otherwise = 0) {
    return object.value(key, otherwise);
}

// The scalars of glTF's component types, from 5120 on.
Scalar scalar_of(std::uint64_t component) {
    constexpr std::array types{Scalar::i8,  Scalar::u8,  Scalar::i16, Scalar::u16,
                               Scalar::f32, Scalar::u32, Scalar::f32};
    return component >= 5120 && component < 5120 + types.size() ? types[component - 5120]
                                                                : Scalar::f32;
}

// What a normalised integer of that type has for 1.
double one_of(Scalar type) {
    if (type > Scalar::u16) return 1;
    const bool is_signed = type == Scalar::i8 || type == Scalar::i16;
    return (1 << (8 * bytes_of(type) - is_signed)) - 1;
}

std::string from_base64(const fs::path& file, std::string_view text) {
    std::string out;
    std::uint32_t bits = 0;
    int held = 0;
    for (const char c : text.substr(0, text.find('='))) {
        constexpr std::string_view digits =
            "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        const auto digit = digits.find(c);
        if (digit == std::string_view::npos) fail(file, "a data: URI in it is no base64");
        bits = bits << 6 | static_cast<std::uint32_t>(digit);
        held += 6;
        if (held < 8) continue;
        held -= 8;
        out.push_back(static_cast<char>(bits >> held & 0xFF));
    }
    return out;
}

template <class T>
void append(std::string& to, T value) {
    std::array<char, sizeof(T)> bytes{};
    std::memcpy(bytes.data(), &value, sizeof(T));
    if (std::endian::native == std::endian::big) std::ranges::reverse(bytes);
    to.append(bytes.data(), bytes.size());
}

class PlainGltf {
  public:
    PlainGltf(const fs::path& file, json& root, std::optional<std::string_view> binary)
        : file_(file), root_(root) {
        for (const json& buffer : list(root_, "buffers")) {
            start_.push_back(data_.size());
            data_ += data_of(buffer, binary);
            data_.resize(start_.back() + whole(buffer, "byteLength"));
            data_.resize((data_.size() + 3) / 4 * 4);
        }
    }

    std::string glb() {
        for (json& view : root_["bufferViews"]) {
            view["byteOffset"] = whole(view, "byteOffset") + start_.at(whole(view, "buffer"));
            view["buffer"] = 0;
        }
        for (json& mesh : root_["meshes"])
            for (json& primitive : mesh["primitives"]) plain_primitive(primitive);
        for (const char* key : {"animations", "skins", "extensionsRequired"}) root_.erase(key);
        for (json& node : root_["nodes"])
            for (const char* key : {"skin", "weights"}) node.erase(key);
        drop_unnamed_accessors();
        root_["buffers"] = json::array({{{"byteLength", data_.size()}}});
        return as_file();
    }

  private:
    static json& list(json& object, const char* key) {
        if (!object.contains(key)) object[key] = json::array();
        return object[key];
    }

    std::string data_of(const json& buffer, const std::optional<std::string_view>& binary) const {
        const auto uri = buffer.find("uri");
        if (uri == buffer.end()) return std::string(start_.size() == 1 ? binary.value_or("") : "");
        const auto& text = uri->get_ref<const std::string&>();
        if (!text.starts_with("data:"))
            return std::string(read_file(file_beside(file_, text)).text());
        const auto comma = text.find(',');
        if (comma == std::string::npos ||
            text.substr(0, comma).find(";base64") == std::string::npos)
            fail(file_, "a data: URI in it is no base64");
        return from_base64(file_, std::string_view(text).substr(comma + 1));
    }

    // The same accessor with other data, once for all that name it.
    std::uint64_t plain(std::uint64_t accessor, bool indices) {
        const auto [at, fresh] = made_.try_emplace(accessor, root_["accessors"].size());
        if (!fresh) return at->second;
        const json old = root_["accessors"].at(accessor);
        const auto count = whole(old, "count");
        const std::size_t width = width_of(old);
        const std::vector<double> values = values_of(old, count, width);
        root_["bufferViews"].push_back({{"buffer", 0},
                                        {"byteOffset", data_.size()},
                                        {"byteLength", values.size() * sizeof(float)}});
        for (const double v : values) {
            if (indices)
                append(data_, static_cast<std::uint32_t>(v));
            else
                append(data_, static_cast<float>(v));
        }
        root_["accessors"].push_back({{"bufferView", root_["bufferViews"].size() - 1},
                                      {"componentType", indices ? index_type : float_type},
                                      {"count", count},
                                      {"type", old.at("type")}});
        return at->second;
    }

    static std::size_t width_of(const json& accessor) {
        const std::string type = accessor.at("type");
        return type == "SCALAR" ? 1 : type.starts_with("VEC") ? std::size_t(type[3] - '0') : 0;
    }

    const char* bytes_at(const json& view, std::uint64_t offset, std::uint64_t size) const {
        const std::uint64_t at = whole(view, "byteOffset") + offset;
        if (at > data_.size() || size > data_.size() - at)
            fail(file_, "an accessor reaches beyond its buffer; the file is damaged");
        return data_.data() + at;
    }

    std::vector<double> values_of(const json& accessor, std::uint64_t count,
                                  std::size_t width) const {
        const Scalar type = scalar_of(whole(accessor, "componentType"));
        const std::uint64_t size = width * bytes_of(type);
        const bool normalized = accessor.value("normalized", false);
        const bool is_signed = type == Scalar::i8 || type == Scalar::i16;
        const auto load = [&](const char* from, double* to) {
            for (std::size_t c = 0; c < width; ++c) {
                to[c] = load_scalar(type, from + c * bytes_of(type), must_swap(false));
                if (!normalized) continue;
                to[c] /= one_of(type);
                if (is_signed) to[c] = std::max(to[c], -1.0);
            }
        };
        std::vector<double> out(count * width, 0.0);
        if (accessor.contains("bufferView") && count > 0) {
            const json& view = root_["bufferViews"].at(whole(accessor, "bufferView"));
            const std::uint64_t step = std::max(size, whole(view, "byteStride"));
            const char* from =
                bytes_at(view, whole(accessor, "byteOffset"), (count - 1) * step + size);
            for (std::uint64_t n = 0; n < count; ++n) load(from + n * step, &out[n * width]);
        }
        if (!accessor.contains("sparse")) return out;
        const json& sparse = accessor.at("sparse");
        const json &where = sparse.at("indices"), &what = sparse.at("values");
        const std::uint64_t changed = whole(sparse, "count");
        const Scalar index = scalar_of(whole(where, "componentType"));
        const auto in = [&](const json& part, std::uint64_t bytes) {
            return bytes_at(root_["bufferViews"].at(whole(part, "bufferView")),
                            whole(part, "byteOffset"), saturating_multiply(changed, bytes));
        };
        const char *places = in(where, bytes_of(index)), *values = in(what, size);
        for (std::uint64_t n = 0; n < changed; ++n) {
            const double place = load_scalar(index, places + n * bytes_of(index), must_swap(false));
            if (!(place >= 0 && place < static_cast<double>(count)))
                fail(file_, "a sparse accessor changes element " + short_number(place) + " of " +
                                std::to_string(count) + "; the file is damaged");
            load(values + n * size, &out[static_cast<std::size_t>(place) * width]);
        }
        return out;
    }

    void plain_primitive(json& primitive) {
        primitive.erase("targets");
        json attributes = json::object();
        for (const auto& [name, accessor] : primitive.at("attributes").items()) {
            if (name != "POSITION" && name != "NORMAL" && !name.starts_with("TEXCOORD_") &&
                !name.starts_with("COLOR_"))
                continue;
            attributes[name] = plain(accessor, false);
        }
        primitive["attributes"] = attributes;
        if (primitive.contains("indices")) primitive["indices"] = plain(primitive["indices"], true);
    }

    // The library looks at all that there are.
    void drop_unnamed_accessors() {
        json kept = json::array();
        std::map<std::uint64_t, std::uint64_t> number;
        const auto keep = [&](json& accessor) {
            const auto [at, fresh] = number.try_emplace(accessor, kept.size());
            if (fresh) kept.push_back(root_["accessors"].at(at->first));
            accessor = at->second;
        };
        for (json& mesh : root_["meshes"]) {
            for (json& primitive : mesh["primitives"]) {
                for (json& accessor : primitive["attributes"]) keep(accessor);
                if (primitive.contains("indices")) keep(primitive["indices"]);
            }
        }
        root_["accessors"] = kept;
    }

    std::string as_file() const {
        std::string text = root_.dump();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        std::string out = "glTF";
        for (const std::uint64_t word :
             {std::uint64_t{2}, 28 + text.size() + data_.size(), text.size()}) {
            if (word > UINT32_MAX) fail(file_, "has more than 4 GiB of data, and no GLB may");
            append(out, static_cast<std::uint32_t>(word));
        }
        out += "JSON" + text;
        append(out, static_cast<std::uint32_t>(data_.size()));
        out.append("BIN\0", 4);
        return out + data_;
    }

    const fs::path& file_;
    json& root_;
    std::string data_;                  // of all buffers, one after another
    std::vector<std::uint64_t> start_;  // where each begins
    std::map<std::uint64_t, std::uint64_t> made_;
};

bool is_plain(const json& root) {
    const json none = json::array();
    const json accessors = root.value("accessors", none);
    const auto whole_view = [](const json& accessor) {
        return accessor.contains("bufferView") && !accessor.contains("sparse");
    };
    if (!std::ranges::all_of(accessors, whole_view)) return false;
    for (const json& mesh : root.value("meshes", none)) {
        for (const json& primitive : mesh.at("primitives")) {
            for (const auto& [name, accessor] : primitive.at("attributes").items()) {
                if (name.starts_with("COLOR_") || name.starts_with("JOINTS_") ||
                    name.starts_with("WEIGHTS_") || name.starts_with("_"))
                    continue;
                if (whole(accessors.at(accessor.get<std::uint64_t>()), "componentType") !=
                    float_type)
                    return false;
            }
        }
    }
    return true;
}

struct GltfParts {
    std::string_view text;
    std::optional<std::string_view> binary;  // of a GLB, be it empty
};

GltfParts parts_of_glb(const fs::path& file, std::string_view bytes) {
    const auto word = [&](std::uint64_t at) { return value_at<std::uint32_t>(bytes, at); };
    if (bytes.size() < 20 || !bytes.starts_with("glTF"))
        fail(file, "is no GLB: it doesn't start with \"glTF\"");
    if (word(4) != 2) {
        fail(file, "is GLB version " + std::to_string(word(4)) + "; version 2 is read");
    }
    if (word(8) != bytes.size() || word(12) > bytes.size() - 20) {
        fail(file, "its header promises " + counted(word(8), "byte") + ", but the file has " +
                       std::to_string(bytes.size()) + "; it is cut short or damaged");
    }
    const std::uint64_t next = 20 + std::uint64_t{word(12)};
    std::uint64_t binary_bytes = 0;
    if (bytes.size() - next >= 8) {
        binary_bytes = word(next);
        if (binary_bytes > bytes.size() - next - 8) fail(file, "its binary part is cut short");
    }
    return {bytes.substr(20, word(12)),
            binary_bytes > 0 ? bytes.substr(next + 8, binary_bytes) : ""};
}

}  // namespace

std::optional<std::string> plain_gltf(const fs::path& file, std::string_view bytes, bool glb) {
    const GltfParts parts = glb ? parts_of_glb(file, bytes) : GltfParts{bytes, std::nullopt};
    std::optional<std::uint64_t> binary_bytes;
    if (parts.binary) binary_bytes = parts.binary->size();
    json root = checked_gltf(file, parts.text, binary_bytes);
    try {
        if (is_plain(root)) return std::nullopt;
        return PlainGltf(file, root, parts.binary).glb();
    } catch (const json::exception& error) {
        fail(file, "its JSON is not as glTF's: " + json_problem(error));
    }
}

}  // namespace topple::io
