// SPDX-License-Identifier: MIT
#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "io/json_text.h"
#include "io/text.h"
#include "points/formats/gltf.h"
#include "points/formats/import_budget.h"

namespace topple::io {
namespace {

namespace fs = std::filesystem;
using json = Json;

// The reader calls itself for each level of nodes.
constexpr std::size_t most_generations = 256;
// What the reader makes of each, bytes: names have a kilobyte, of a material each property, and
// each element of an accessor becomes a vector or colour.
constexpr std::uint64_t object_bytes = 2048, material_bytes = 32768, element_bytes = 16;

// "%2E" and the like.
std::string percent_decoded(std::string_view uri) {
    const auto digit = [](char c) {
        return c <= '9' ? c - '0' : std::tolower(static_cast<unsigned char>(c)) - 'a' + 10;
    };
    std::string out;
    for (std::size_t n = 0; n < uri.size(); ++n) {
        if (uri[n] == '%' && n + 2 < uri.size() && std::isxdigit(uri[n + 1]) &&
            std::isxdigit(uri[n + 2])) {
            out += static_cast<char>(16 * digit(uri[n + 1]) + digit(uri[n + 2]));
            n += 2;
        } else {
            out += uri[n];
        }
    }
    return out;
}

// Reads of the JSON what decides over what is allocated.
class GltfChecks {
  public:
    GltfChecks(const fs::path& file, const json& root, std::uint64_t text_bytes,
               std::optional<std::uint64_t> binary_bytes)
        : file_(file), root_(root), binary_bytes_(binary_bytes), text_bytes_(text_bytes) {}

    void check() {
        check_extensions();
        check_buffers();
        check_views();
        check_accessors();
        check_nodes();
        check_weight();
    }

  private:
    [[noreturn]] void not_read(const std::string& extension) const {
        const bool draco = extension == "KHR_draco_mesh_compression";
        fail(file_, "needs glTF's extension " + printable(extension, 80) +
                        ", which is not read: export it without" +
                        (draco ? ", or decompress it: gltf-pipeline -i FILE -o OUT.glb" : ""));
    }

    // Those that say where surfaces are, and those that leave that as it is.
    void check_extensions() const {
        static constexpr std::array<std::string_view, 4> shape{
            "KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression",
            "EXT_mesh_gpu_instancing"};
        static constexpr std::array<std::string_view, 12> harmless{
            "KHR_mesh_quantization", "KHR_materials_", "KHR_lights_",    "KHR_texture_",
            "EXT_texture_",          "KHR_animation_", "KHR_xmp",        "EXT_lights_",
            "MSFT_texture_",         "ADOBE_",         "EXT_structural", "EXT_mesh_features"};
        for (const json& name : list(root_, "extensionsRequired")) {
            if (!name.is_string()) fail(file_, "\"extensionsRequired\" must be a list of names");
            const auto& text = name.get_ref<const std::string&>();
            if (std::ranges::none_of(
                    harmless, [&](std::string_view begin) { return text.starts_with(begin); }))
                not_read(text);
        }
        // Some files use one without asking for it.
        const auto check = [&](const json& object) {
            const auto extensions = object.find("extensions");
            if (extensions == object.end() || !extensions->is_object()) return;
            for (const std::string_view name : shape)
                if (extensions->contains(std::string(name))) not_read(std::string(name));
        };
        for (const json& view : entries(root_, "bufferViews")) check(view);
        for (const json& node : entries(root_, "nodes")) check(node);
        for (const json& mesh : entries(root_, "meshes")) {
            for (const json& primitive : entries(mesh, "primitives")) {
                if (!primitive.contains("attributes") || has_data(primitive["attributes"]))
                    continue;
                check(primitive);
            }
        }
    }

    // Whether the places of a primitive's corners lie in a buffer, uncompressed.
    bool has_data(const json& attributes) const {
        const json& accessors = entries(root_, "accessors");
        const auto n =
            attributes.is_object() ? whole(attributes, "POSITION", UINT64_MAX) : UINT64_MAX;
        return n < accessors.size() && accessors[n].contains("bufferView");
    }

    // A count or offset; `otherwise` where there is none.
    std::uint64_t whole(const json& object, const char* key, std::uint64_t otherwise) const {
        const auto found = object.find(key);
        if (found == object.end()) return otherwise;
        if (!found->is_number_unsigned()) {
            fail(file_, std::string("\"") + key + "\" must be a whole number from 0 on, not " +
                            printable(found->dump(-1, ' ', true), 40));
        }
        return found->get<std::uint64_t>();
    }

    const json& list(const json& object, const char* key) const {
        static const json none = json::array();
        const auto found = object.find(key);
        if (found == object.end()) return none;
        if (!found->is_array()) fail(file_, std::string("\"") + key + "\" must be a list");
        return *found;
    }

    // A list of objects.
    const json& entries(const json& object, const char* key) const {
        const json& found = list(object, key);
        for (const json& entry : found) {
            if (!entry.is_object())
                fail(file_, std::string("the entries of \"") + key + "\" must be objects");
        }
        return found;
    }

    // The file that an entry names beside itself; none where it has its data elsewhere.
    std::optional<std::string> outer_uri(const json& entry) const {
        const auto uri = entry.find("uri");
        if (uri == entry.end()) return std::nullopt;
        if (!uri->is_string()) fail(file_, "a \"uri\" must be a string");
        const auto& text = uri->get_ref<const std::string&>();
        if (text.starts_with("data:")) return std::nullopt;
        return text;
    }

    void check_buffers() {
        for (const json& buffer : entries(root_, "buffers")) {
            const auto bytes = whole(buffer, "byteLength", 0);
            std::uint64_t there = text_bytes_;  // data: lies in the text
            if (const auto uri = outer_uri(buffer)) {
                if (binary_bytes_) {
                    fail(file_, "one of its buffers is the file " + in_quotes(*uri) +
                                    "; of a GLB only what lies in it is read");
                }
                there = OpenFile(file_beside(file_, *uri)).size;
            } else if (binary_bytes_ && buffers_.empty() && !buffer.contains("uri")) {
                there = *binary_bytes_;
            }
            if (bytes > there) {
                fail(file_, "buffer " + std::to_string(buffers_.size()) + " promises " +
                                counted(bytes, "byte") + ", but the file has " +
                                std::to_string(there) + " for it; it is cut short");
            }
            buffers_.push_back(bytes);
            buffer_bytes_ += bytes;
        }
    }

    void check_views() {
        for (const json& view : entries(root_, "bufferViews")) {
            const std::string name = "buffer view " + std::to_string(views_.size());
            const auto buffer = whole(view, "buffer", UINT64_MAX);
            const auto offset = whole(view, "byteOffset", 0);
            const auto bytes = whole(view, "byteLength", 0);
            if (buffer >= buffers_.size() || offset > buffers_[buffer] ||
                bytes > buffers_[buffer] - offset)
                fail(file_, name + " reaches beyond its buffer; the file is damaged");
            const auto stride = whole(view, "byteStride", 0);
            if (stride > 252) fail(file_, name + " has a stride beyond glTF's limit of 252 bytes");
            views_.push_back({bytes, stride});
        }
    }

    std::uint64_t element_size(const json& accessor, const std::string& name) const {
        constexpr std::array<std::uint64_t, 7> component_bytes{1, 1, 2, 2, 0, 4, 4};
        static constexpr std::pair<std::string_view, std::uint64_t> types[] = {
            {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4},
            {"MAT2", 4},   {"MAT3", 9}, {"MAT4", 16}};
        const auto component = whole(accessor, "componentType", 0);
        const auto type = accessor.find("type");
        if (component >= 5120 && component <= 5126 && type != accessor.end() && type->is_string()) {
            for (const auto& [known, components] : types) {
                if (type->get_ref<const std::string&>() == known &&
                    component_bytes[component - 5120] > 0)
                    return components * component_bytes[component - 5120];
            }
        }
        fail(file_, name + " has no \"componentType\" and \"type\" of glTF; the file is damaged");
    }

    void check_accessors() {
        for (const json& accessor : entries(root_, "accessors")) {
            const std::string name = "accessor " + std::to_string(counts_.size());
            const std::uint64_t size = element_size(accessor, name);
            // Without a view it is all zeros, but for what a sparse one changes.
            if (!accessor.contains("bufferView")) {
                counts_.push_back(whole(accessor, "count", 0));
                continue;
            }
            const auto view = whole(accessor, "bufferView", UINT64_MAX);
            const auto offset = whole(accessor, "byteOffset", 0);
            const auto count = whole(accessor, "count", 0);
            const auto promises = [&] {
                fail(file_,
                     name + " promises more than its buffer view holds; the file is damaged");
            };
            if (view >= views_.size() || offset > views_[view].bytes) promises();
            const std::uint64_t left = views_[view].bytes - offset;
            const std::uint64_t step = std::max(size, views_[view].stride);
            if (count > 0 && (size > left || count - 1 > (left - size) / step)) promises();
            counts_.push_back(count);
        }
    }

    // That they are trees.
    void check_nodes() {
        const json& nodes = entries(root_, "nodes");
        std::vector<std::vector<std::uint64_t>> children(nodes.size());
        std::vector<bool> has_parent(nodes.size());
        for (std::size_t n = 0; n < nodes.size(); ++n) {
            for (const json& child : list(nodes[n], "children")) {
                if (!child.is_number_unsigned() || child.get<std::uint64_t>() >= nodes.size())
                    fail(file_, "node " + std::to_string(n) + " has a child that is no node");
                const auto c = child.get<std::uint64_t>();
                if (has_parent[c])
                    fail(file_, "node " + std::to_string(c) +
                                    " is the child of two nodes, or twice of one; glTF has each "
                                    "node in one place");
                has_parent[c] = true;
                children[n].push_back(c);
            }
        }
        std::vector<std::pair<std::uint64_t, std::size_t>> left;
        for (std::size_t n = 0; n < nodes.size(); ++n)
            if (!has_parent[n]) left.emplace_back(n, 1);
        std::size_t reached = 0;
        while (!left.empty()) {
            const auto [node, generation] = left.back();
            left.pop_back();
            ++reached;
            if (generation > most_generations)
                fail(file_, "its nodes are nested more than " + std::to_string(most_generations) +
                                " deep; flatten them");
            for (const std::uint64_t c : children[node]) left.emplace_back(c, generation + 1);
        }
        if (reached < nodes.size()) fail(file_, "its nodes are one another's children, in a cycle");
    }

    // How many elements the values of an object that name accessors have.
    std::uint64_t named_elements(const json& object) const {
        std::uint64_t sum = 0;
        for (const json& value : object) {
            if (value.is_number_unsigned() && value.get<std::uint64_t>() < counts_.size())
                sum += counts_[value.get<std::uint64_t>()];
        }
        return sum;
    }

    std::uint64_t elements(const json& primitive) const {
        std::uint64_t sum = 0;
        const auto named = [&](const char* key) {
            const auto found = primitive.find(key);
            return found != primitive.end() && found->is_object() ? named_elements(*found) : 0;
        };
        sum += named("attributes");
        const auto indices = whole(primitive, "indices", UINT64_MAX);
        if (indices < counts_.size()) sum += counts_[indices];
        for (const json& target : entries(primitive, "targets")) sum += named_elements(target);
        return sum;
    }

    void check_weight() const {
        ImportWeight weight(file_, text_bytes_ + buffer_bytes_);
        weight.add(entries(root_, "nodes").size(), object_bytes, "node");
        weight.add(entries(root_, "materials").size(), material_bytes, "material");
        for (const auto& [key, noun] : {std::pair("images", "image"),
                                        {"textures", "texture"},
                                        {"samplers", "sampler"},
                                        {"cameras", "camera"},
                                        {"skins", "skin"},
                                        {"scenes", "scene"},
                                        {"meshes", "shape"},
                                        {"accessors", "accessor"},
                                        {"bufferViews", "view"},
                                        {"buffers", "buffer"}})
            weight.add(entries(root_, key).size(), object_bytes, noun);
        std::vector<std::uint64_t> primitives;
        for (const json& mesh : entries(root_, "meshes")) {
            const json& parts = entries(mesh, "primitives");
            for (const json& part : parts) {
                weight.add(1, object_bytes, "primitive");
                weight.add(elements(part), element_bytes, "element");
            }
            primitives.push_back(parts.size());
        }
        for (const json& image : entries(root_, "images")) {
            const auto view = whole(image, "bufferView", UINT64_MAX);
            if (view < views_.size()) weight.add(views_[view].bytes, 1, "image byte");
        }
        for (const json& animation : entries(root_, "animations")) {
            weight.add(1, object_bytes, "animation");
            weight.add(entries(animation, "channels").size(), object_bytes, "channel");
            for (const json& sampler : entries(animation, "samplers"))
                weight.add(named_elements(sampler), 4 * element_bytes, "key frame");
        }
        check_skins(weight, primitives);
    }

    // Each joint of a skin becomes a bone of each part of the mesh that wears it.
    void check_skins(ImportWeight& weight, const std::vector<std::uint64_t>& primitives) const {
        std::vector<std::uint64_t> joints;
        for (const json& skin : entries(root_, "skins"))
            joints.push_back(list(skin, "joints").size());
        for (const json& node : entries(root_, "nodes")) {
            const auto skin = whole(node, "skin", UINT64_MAX);
            const auto mesh = whole(node, "mesh", UINT64_MAX);
            if (skin < joints.size() && mesh < primitives.size())
                weight.add(saturating_multiply(joints[skin], primitives[mesh]), object_bytes,
                           "bone");
        }
    }

    struct View {
        std::uint64_t bytes, stride;
    };
    const fs::path& file_;
    const json& root_;
    std::optional<std::uint64_t> binary_bytes_;
    std::uint64_t text_bytes_, buffer_bytes_ = 0;
    std::vector<std::uint64_t> buffers_;  // bytes
    std::vector<View> views_;
    std::vector<std::uint64_t> counts_;  // of accessors
};

}  // namespace

FileName file_beside(const fs::path& file, std::string_view uri) {
    const std::string name = percent_decoded(uri);
    const FileName there = FileName::beside(file, name);
    const bool plain =
        name.find('\0') == std::string::npos && name.find("://") == std::string::npos;
    const Descriptor open(plain ? there.open(O_PATH) : -1);
    struct stat status {};
    if (!plain || (open.get() < 0 && (errno == EXDEV || errno == ELOOP)))
        fail(file, "names the file " + in_quotes(uri) +
                       ", which is not in its own folder; only files there are read, and no links");
    if (open.get() < 0 || ::fstat(open.get(), &status) != 0)
        fail(file, "names the file " + in_quotes(uri) +
                       ", which can't be opened: " + std::strerror(errno) + "; copy it there, too");
    if (!S_ISREG(status.st_mode))
        fail(file, "names the file " + in_quotes(uri) + ", which is not a regular file");
    return there;
}

json checked_gltf(const fs::path& file, std::string_view text,
                  std::optional<std::uint64_t> binary_bytes) {
    json root = parse_json(file, text, "holds no JSON of glTF");
    if (!root.is_object()) fail(file, "holds no glTF: its JSON is no object");
    GltfChecks(file, root, text.size(), binary_bytes).check();
    return root;
}

}  // namespace topple::io
