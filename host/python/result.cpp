// SPDX-License-Identifier: MIT
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/python_type.h"
#include "core/result_fields.h"
#include "python.h"

namespace topple::python {
namespace {

// Memory of the owner's as an array, which keeps it alive: values of this shape, `step` bytes from
// one row to the next.
template <class T>
py::array lent(const T* first, std::vector<py::ssize_t> shape, std::size_t step,
               const py::object& owner) {
    std::vector<py::ssize_t> strides{static_cast<py::ssize_t>(step)};
    if (shape.size() > 1) strides.push_back(sizeof(T));
    return py::array_t<T>(std::move(shape), std::move(strides), first, owner);
}

template <class T>
py::array borrowed(const std::vector<T>& values, const py::object& owner) {
    return lent(values.data(), {static_cast<py::ssize_t>(values.size())}, sizeof(T), owner);
}

// The same of what has nothing but so many numbers: a row for each, (N, width).
template <class Row>
py::array rows(const std::vector<Row>& values, const py::object& owner) {
    constexpr std::size_t width = sizeof(Row) / sizeof(double);
    return lent(reinterpret_cast<const double*>(values.data()),
                {static_cast<py::ssize_t>(values.size()), py::ssize_t{width}}, sizeof(Row), owner);
}

// A few numbers as an array of their own.
template <std::size_t count>
py::array copied(const std::array<double, count>& values) {
    std::vector<py::ssize_t> shape{py::ssize_t{count}};
    if (count > 3) shape.assign(2, count == 9 ? 3 : 4);
    return py::array_t<double>(std::move(shape), values.data());
}

// References to the items, each of which keeps the result alive.
template <class Item>
py::list items(const std::vector<Item>& from, const py::object& owner) {
    py::list out;
    for (const Item& item : from)
        out.append(py::cast(&item, py::return_value_policy::reference_internal, owner));
    return out;
}

const Scene& scene_of(const py::object& self) {
    return self.cast<const Parsed&>().result.scene;
}

// Of blows, where they lie: (directions, heights).
py::array blow_rows(const std::vector<double>& blows, const DirectedBarrier& of,
                    const py::object& owner) {
    const auto directions = static_cast<py::ssize_t>(of.push_J.size());
    const auto heights = static_cast<py::ssize_t>(of.height_m.size());
    return lent(blows.data(), {directions, heights}, of.height_m.size() * sizeof(double), owner);
}

// The value of a field of `item`, which keeps `owner` alive where it lies in its memory.
template <class Item, class T>
py::object python_value(const Item& item, const T& value, const Note& note,
                        const py::object& owner) {
    if (note.or_none && is_none(value)) return py::none();
    if constexpr (Listed<T>) {
        return py::cast(&value, py::return_value_policy::reference_internal, owner);
    } else if constexpr (array_size<T> > 2) {
        return copied(value);
    } else if constexpr (std::is_same_v<T, std::vector<double>>) {
        if constexpr (std::is_same_v<Item, DirectedBarrier>)
            if (note.rows) return blow_rows(value, item, owner);
        return borrowed(value, owner);
    } else if constexpr (std::is_same_v<T, std::vector<Vec3>>) {
        return rows(value, owner);
    } else if constexpr (std::is_same_v<T, decltype(Scene::timings_s)>) {
        py::dict out;
        for (const auto& [name, seconds] : value) out[py::str(name)] = seconds;
        return out;
    } else if constexpr (is_a<T, std::vector>) {
        if constexpr (!Listed<typename T::value_type>)
            return py::cast(value);
        else if constexpr (kind<typename T::value_type>.name == nullptr)
            return rows(value, owner);
        else
            return items(value, owner);
    } else {
        return py::cast(value);
    }
}

// How columns hold a field; "": they don't. What is in an item has its kind's name.
template <class T>
const char* column() {
    if constexpr (Listed<T>)
        return kind<T>.name;
    else if constexpr (std::is_same_v<T, bool>)
        return "bool";
    else if constexpr (std::is_integral_v<T>)
        return sizeof(T) == 4 ? "int32" : "uint64";
    else if constexpr (std::is_same_v<T, double>)
        return "float64";
    else if constexpr (std::is_convertible_v<T, std::string>)
        return "object";
    else if constexpr (std::is_same_v<T, Vec3>)
        return "vector";
    else if constexpr (is_a<T, std::map>)
        return "by_disturbance";
    else if constexpr (std::is_same_v<T, std::vector<std::int32_t>>)
        return "ids";
    return "";
}

// The class of a kind of item, which `item_of` finds in what Python has.
template <class Item, class Class, class ItemOf>
void bind_fields(py::module_& module, Class& bound, const ItemOf& item_of) {
    py::dict columns;
    const auto property = [&](const auto& field) {
        using Value =
            std::remove_cvref_t<decltype(std::invoke(field.member, std::declval<const Item&>()))>;
        const char* name = field.note.python ? field.note.python : field.name;
        bound.def_property_readonly(
            name,
            [field, item_of](const py::object& self) {
                const Item& item = item_of(self);
                return python_value(item, std::invoke(field.member, item), field.note, self);
            },
            python_words<Value>(field.words, field.note).c_str());
        if (const std::string how = column<Value>(); !how.empty()) columns[name] = how;
    };
    fields<Item>(property);
    std::apply([&](const auto&... each) { (property(each), ...); }, shortcuts<Item>);
    module.attr("COLUMNS")[kind<Item>.name] = columns;
}

template <class Item, class... Extra>
auto bind_item(py::module_& module, const Extra&... extra) {
    py::class_<Item> bound(module, kind<Item>.name, kind<Item>.words, extra...);
    bind_fields<Item>(module, bound, [](const py::object& self) -> const Item& {
        return self.cast<const Item&>();
    });
    return bound;
}

// Of all poses a field each, where they lie.
void bind_landscape(py::module_& module) {
    auto bound = bind_item<Landscape>(module);
    fields<Landscape::Pose>([&](const auto& field) {
        bound.def_property_readonly(
            field.name,
            [field](const py::object& self) -> py::object {
                using Pose = Landscape::Pose;
                const auto& poses = self.cast<const Landscape&>().poses;
                const auto count = static_cast<py::ssize_t>(poses.size());
                const auto* first = poses.empty() ? nullptr : &(poses.data()->*field.member);
                if constexpr (std::is_same_v<decltype(first), const Vec3*>)
                    return lent(first ? first->data() : nullptr, {count, 3}, sizeof(Pose), self);
                else
                    return lent(first, {count}, sizeof(Pose), self);
            },
            (std::string("by pose: ") + field.words).c_str());
    });
}

void bind_items(py::module_& module) {
    module.attr("COLUMNS") = py::dict();
    bind_item<Primitive>(module);
    bind_item<Overturning>(module);
    bind_item<DirectedBarrier>(module);
    bind_item<Why>(module);
    bind_item<Advice>(module);
    bind_item<Fragility>(module);
    bind_item<Alternative>(module);
    bind_item<Hold>(module);
    bind_item<PossibleThing>(module);
    bind_item<Fall>(module);
    bind_landscape(module);
    bind_item<Object>(module);
    bind_item<Contact>(module);
    // Python gives these the names of the objects that they are about.
    bind_item<Support>(module, py::dynamic_attr());
    bind_item<AppliedCorrection>(module, py::dynamic_attr());
}

template <class Member>
auto point_array(Member member) {
    return
        [member](const py::object& self) { return borrowed(scene_of(self).points.*member, self); };
}

// Of names and vectors in turn.
template <class Vector, class... More>
py::dict named_arrays(const py::object& owner, const char* name, const Vector& values,
                      const More&... more) {
    py::dict out;
    out[name] = borrowed(values, owner);
    if constexpr (sizeof...(more) > 0) out.attr("update")(named_arrays(owner, more...));
    return out;
}

py::dict solid(const py::object& self) {
    const SolidVoxels& v = scene_of(self).solid;
    return named_arrays(self, "x", v.x, "y", v.y, "z", v.z, "primitive", v.primitive, "object",
                        v.object, "state", v.state);
}

py::dict disturbance_fields(const py::object& self) {
    py::dict out;
    for (const auto& [name, f] : scene_of(self).fields)
        out[py::str(name)] = named_arrays(self, "x", f.x, "y", f.y, "z", f.z, "vx", f.vx, "vy",
                                          f.vy, "vz", f.vz, "density", f.density);
    return out;
}

}  // namespace

void bind_result(py::module_& module) {
    bind_items(module);
    py::class_<Parsed, std::shared_ptr<Parsed>> bound(module, "Parsed");
    bind_fields<Scene>(module, bound, scene_of);
    for (const auto& [name, member] : {std::pair("x", &ScenePoints::x),
                                       {"y", &ScenePoints::y},
                                       {"z", &ScenePoints::z},
                                       {"nx", &ScenePoints::nx},
                                       {"ny", &ScenePoints::ny},
                                       {"nz", &ScenePoints::nz}})
        bound.def_property_readonly(name, point_array(member));
    bound
        .def_property_readonly(
            "in_blocks", [](const Parsed& p) { return p.result.tiled != nullptr; },
            "bool: a cloud was parsed in blocks (docs/scale.md), and the arrays over its points "
            "are of a sample of them.")
        .def_property_readonly("point_primitive", point_array(&ScenePoints::primitive),
                               "(N,) int32: the primitive of each point that is finite, -1: none.")
        .def_property_readonly(
            "point_object", point_array(&ScenePoints::object),
            "(N,) int32: the object of each point that is finite, -1: none. Where points of the "
            "input were left out, point_index says which of the input's these are.")
        .def_property_readonly(
            "point_region", point_array(&ScenePoints::region),
            "(N,) int32: the smooth piece of surface of each point that is finite, -1: none.")
        .def_property_readonly("point_index", point_array(&ScenePoints::index),
                               "uint64: of arrays, and organised clouds in files, with points that "
                               "are not finite, the places in them of the N others, ascending; "
                               "empty where all are finite, and of other files.")
        .def_property_readonly(
            "image_shape",
            [](const Parsed& p) -> py::object {
                if (p.result.image_height == 0) return py::none();
                return py::make_tuple(p.result.image_height, p.result.image_width);
            },
            "(height, width) of the depth image that an organised .pcd is, whose pixels are its "
            "places, row by row; None: it is none.")
        .def_property_readonly("solid", solid,
                               "dict of arrays over the solid voxels: \"x\", \"y\", \"z\", their "
                               "centres in metres, float32; \"primitive\", \"object\", int32; "
                               "\"state\", uint8, 0: seen surface, 1: completed.")
        .def_property_readonly(
            "fields", disturbance_fields,
            "dict by disturbance, of dicts of float32 arrays: \"x\", \"y\", \"z\" in metres; "
            "\"vx\", \"vy\", \"vz\", mean direction times strength (m/s; m/s^2 for earthquakes); "
            "\"density\", visits per event, or exposure in 0 to 1.");
}

}  // namespace topple::python
