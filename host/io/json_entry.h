// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

#include "core/json.h"
#include "io/json_text.h"
#include "io/text.h"

// Files that people write: a schema and one list of {..}. All throw Error(input) that names the
// file, the entry and what is wrong with it.
namespace topple::io {

// The list of that name in a file's text. what: "file of corrections", for messages.
inline Json listed_in(const std::filesystem::path& file, std::string_view text, const char* what,
                      const char* schema, const char* list) {
    Json json = parse_json(file, text);
    const auto own = json.is_object() ? json.find("schema") : json.end();
    if (!json.is_object() || own == json.end() || *own != schema)
        fail(file, std::string("is no ") + what + ": its \"schema\" is not " + in_quotes(schema));
    const auto entries = json.find(list);
    if (entries == json.end() || !entries->is_array()) fail(file, "has no list " + in_quotes(list));
    return std::move(*entries);
}

// One entry of such a list.
class JsonEntry {
  public:
    // called: "correction 3".
    JsonEntry(const std::filesystem::path& file, std::string called, const Json& json)
        : file_(file), called_(std::move(called)), json_(json) {
        if (!json.is_object()) wrong(std::string("is ") + json.type_name() + " where {..} is due");
    }
    // Messages from then on name it so, too: " (hollow)".
    void call_also(const std::string& more) { called_ += more; }
    [[noreturn]] void wrong(const std::string& what) const { fail(file_, called_ + ": " + what); }

    bool has(const char* name) const { return json_.contains(name); }
    const Json& field(const char* name) const {
        const auto found = json_.find(name);
        if (found == json_.end()) wrong("has no " + in_quotes(name));
        return *found;
    }
    std::string text(const char* name) const {
        const Json& value = field(name);
        if (!value.is_string())
            wrong(in_quotes(name) + " is " + value.type_name() + " where a text is due");
        return value.get<std::string>();
    }
    double number(const char* name) const {
        const Json& value = field(name);
        if (!value.is_number())
            wrong(in_quotes(name) + " is " + value.type_name() + " where a number is due");
        return value.get<double>();
    }

  private:
    const std::filesystem::path& file_;
    std::string called_;
    const Json& json_;
};

}  // namespace topple::io
