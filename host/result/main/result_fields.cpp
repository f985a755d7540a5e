// SPDX-License-Identifier: MIT
#include "core/result_fields.h"

#include <cstdio>
#include <functional>
#include <tuple>
#include <type_traits>

#include "core/json.h"
#include "core/python_type.h"

// Prints the lists of core/result_fields.h, for what makes stubs and pages of them:
// [{"kind": .., "words": .., "fields": [{"name": .., "python": .., "type": .., "shape": ..,
// "words":
// .., "in_file": ..}]}].
namespace {

using namespace topple;

template <class Item>
OrderedJson fields_of() {
    auto of_item = OrderedJson::array();
    const auto add = [&](const auto& field, bool in_file) {
        using Value =
            std::remove_cvref_t<std::invoke_result_t<decltype(field.member), const Item&>>;
        const Note& note = field.note;
        of_item.push_back({{"name", field.name},
                           {"python", note.python ? note.python : field.name},
                           {"type", python_type<Value>(note)},
                           {"shape", python_shape<Value>()},
                           {"words", field.words},
                           {"in_file", in_file && !note.elsewhere}});
    };
    fields<Item>([&](const auto& field) { add(field, true); });
    std::apply([&](const auto&... each) { (add(each, false), ...); }, shortcuts<Item>);
    return of_item;
}

template <class Item>
OrderedJson listed() {
    return {{"kind", kind<Item>.name}, {"words", kind<Item>.words}, {"fields", fields_of<Item>()}};
}

// Python has an array over the poses of each of their fields.
OrderedJson landscape() {
    OrderedJson json = listed<Landscape>();
    for (OrderedJson& field : fields_of<Landscape::Pose>()) {
        const bool ids = field["type"] == "int";
        field["type"] = ids ? "NDArray[np.int32]" : "NDArray[np.float64]";
        field["shape"] = field["shape"] == "" ? "(poses,)" : "(poses, 3)";
        json["fields"].push_back(std::move(field));
    }
    return json;
}

}  // namespace

int main() {
    const auto all = OrderedJson::array(
        {listed<Primitive>(), listed<Overturning>(), listed<DirectedBarrier>(), listed<Why>(),
         listed<Advice>(), listed<Alternative>(), listed<Hold>(), listed<PossibleThing>(),
         listed<Fragility>(), landscape(), listed<Fall>(), listed<AppliedCorrection>(),
         listed<Object>(), listed<Contact>(), listed<Support>(), listed<Scene>()});
    std::puts(all.dump(1).c_str());
}
