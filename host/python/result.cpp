// SPDX-License-Identifier: MIT
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "python.h"

namespace topple::python {
namespace {

// The vector's memory as an array, which keeps its owner alive.
template <class T>
py::array borrowed(const std::vector<T>& values, const py::object& owner) {
    return py::array_t<T>({static_cast<py::ssize_t>(values.size())},
                          {static_cast<py::ssize_t>(sizeof(T))}, values.data(), owner);
}

// The same of vectors: (N, 3).
py::array vectors(const std::vector<Vec3>& values, const py::object& owner) {
    return py::array_t<double>(
        {static_cast<py::ssize_t>(values.size()), py::ssize_t{3}},
        {static_cast<py::ssize_t>(sizeof(Vec3)), static_cast<py::ssize_t>(sizeof(double))},
        values.empty() ? nullptr : values.front().data(), owner);
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

// A value of each pose, where it lies.
template <class T>
auto pose_array(T Landscape::Pose::*value) {
    return [value](const py::object& self) {
        const auto& poses = self.cast<const Landscape&>().poses;
        return py::array_t<T>({static_cast<py::ssize_t>(poses.size())},
                              {py::ssize_t{sizeof(Landscape::Pose)}},
                              poses.empty() ? nullptr : &(poses.data()->*value), self);
    };
}

// Of blows, where they lie: (directions, heights).
auto blow_rows(std::vector<double> DirectedBarrier::*blows) {
    return [blows](const py::object& self) {
        const auto& from = self.cast<const DirectedBarrier&>();
        const auto directions = static_cast<py::ssize_t>(from.push_J.size());
        const auto heights = static_cast<py::ssize_t>(from.height_m.size());
        const auto width = static_cast<py::ssize_t>(sizeof(double));
        return py::array_t<double>({directions, heights}, {heights * width, width},
                                   (from.*blows).data(), self);
    };
}

void bind_landscape(py::module_& module) {
    py::class_<Landscape>(module, "Landscape")
        .def_readonly("now", &Landscape::now)
        .def_property_readonly(
            "up",
            [](const py::object& self) {
                const auto& poses = self.cast<const Landscape&>().poses;
                return py::array_t<double>(
                    {static_cast<py::ssize_t>(poses.size()), py::ssize_t{3}},
                    {py::ssize_t{sizeof(Landscape::Pose)}, py::ssize_t{sizeof(double)}},
                    poses.empty() ? nullptr : poses.data()->up.data(), self);
            })
        .def_property_readonly("energy_J", pose_array(&Landscape::Pose::energy_J))
        .def_property_readonly("joins_at_J", pose_array(&Landscape::Pose::joins_at_J))
        .def_property_readonly("joins", pose_array(&Landscape::Pose::joins))
        .def_property_readonly("probability", pose_array(&Landscape::Pose::probability));
}

void bind_items(py::module_& module) {
    py::class_<Primitive>(module, "Primitive")
        .def_readonly("id", &Primitive::id)
        .def_readonly("object", &Primitive::object)
        .def_readonly("model", &Primitive::model)
        .def_readonly("points", &Primitive::points)
        .def_readonly("solid_voxels", &Primitive::solid_voxels)
        .def_readonly("volume_m3", &Primitive::volume_m3)
        .def_readonly("mass_kg", &Primitive::mass_kg)
        .def_readonly("center_of_mass_m", &Primitive::center_of_mass_m)
        .def_readonly("name", &Primitive::name);
    py::class_<Overturning>(module, "Overturning")
        .def_readonly("tilt_deg", &Overturning::tilt_deg)
        .def_readonly("tilt_error_deg", &Overturning::tilt_error_deg)
        .def_readonly("direction", &Overturning::direction)
        .def_readonly("push_N", &Overturning::push_N)
        .def_readonly("push_error_N", &Overturning::push_error_N)
        .def_readonly("slide_N", &Overturning::slide_N)
        .def_readonly("shake_g", &Overturning::shake_g)
        .def_readonly("hand_push_N", &Overturning::hand_push_N)
        .def_readonly("hand_push_error_N", &Overturning::hand_push_error_N)
        .def_readonly("hand_height_m", &Overturning::hand_height_m)
        .def_readonly("gust_m_s", &Overturning::gust_m_s)
        .def_readonly("gust_error_m_s", &Overturning::gust_error_m_s);
    py::class_<DirectedBarrier>(module, "DirectedBarrier")
        .def_property_readonly("height_m",
                               [](const py::object& self) {
                                   return borrowed(self.cast<const DirectedBarrier&>().height_m,
                                                   self);
                               })
        .def_property_readonly("push_J",
                               [](const py::object& self) {
                                   return borrowed(self.cast<const DirectedBarrier&>().push_J,
                                                   self);
                               })
        .def_property_readonly("blow_Ns", blow_rows(&DirectedBarrier::blow_Ns))
        .def_property_readonly("blow_J", blow_rows(&DirectedBarrier::blow_J))
        .def_property_readonly("direction",
                               [](const py::object& self) {
                                   return vectors(self.cast<const DirectedBarrier&>().direction,
                                                  self);
                               })
        .def_property_readonly("push_N",
                               [](const py::object& self) {
                                   return borrowed(self.cast<const DirectedBarrier&>().push_N,
                                                   self);
                               })
        .def_property_readonly("push_error_N", [](const py::object& self) {
            return borrowed(self.cast<const DirectedBarrier&>().push_error_N, self);
        });
    py::class_<Why>(module, "Why")
        .def_readonly("azimuth_deg", &Why::azimuth_deg)
        .def_property_readonly(
            "edge_m",
            [](const py::object& self) { return vectors(self.cast<const Why&>().edge_m, self); })
        .def_readonly("W_J", &Why::W_J)
        .def_readonly("S_J", &Why::S_J)
        .def_readonly("way_m", &Why::way_m)
        .def_readonly("drop_m", &Why::drop_m)
        .def_readonly("lands_on", &Why::lands_on)
        .def_readonly("stands_on", &Why::stands_on)
        .def_readonly("sentence", &Why::sentence);
    py::class_<Advice>(module, "Advice")
        .def_readonly("kind", &Advice::kind)
        .def_readonly("move_m", &Advice::move_m)
        .def_readonly("risk_J", &Advice::risk_J)
        .def_readonly("hold_N", &Advice::hold_N)
        .def_readonly("hold_height_m", &Advice::hold_height_m)
        .def_readonly("sentence", &Advice::sentence)
        .def_readonly("action", &Advice::action);
    py::class_<Fragility>(module, "Fragility")
        .def_readonly("pga_g", &Fragility::pga_g)
        .def_readonly("pga_dispersion", &Fragility::pga_dispersion)
        .def_readonly("firm_pga_g", &Fragility::firm_pga_g)
        .def_readonly("pgv_m_s", &Fragility::pgv_m_s)
        .def_readonly("pgv_dispersion", &Fragility::pgv_dispersion)
        .def_property_readonly(
            "counted",
            [](const py::object& self) {
                const auto& steps = self.cast<const Fragility&>().counted;
                return py::array_t<double>(
                    {static_cast<py::ssize_t>(steps.size()), py::ssize_t{2}},
                    {py::ssize_t{sizeof(Fragility::Step)}, py::ssize_t{sizeof(double)}},
                    reinterpret_cast<const double*>(steps.data()), self);
            })
        .def_readonly("falls_per_year", &Fragility::falls_per_year)
        .def_readonly("return_years", &Fragility::return_years);
    py::class_<Fall>(module, "Fall")
        .def_readonly("falls", &Fall::falls)
        .def_readonly("lands_m", &Fall::lands_m)
        .def_readonly("drop_m", &Fall::drop_m)
        .def_readonly("lands_on", &Fall::lands_on)
        .def_readonly("leans_on", &Fall::leans_on)
        .def_readonly("takes_along", &Fall::takes_along)
        .def_readonly("hits_J", &Fall::hits_J)
        .def_property_readonly("people_share", [](const Fall& fall) -> std::optional<double> {
            if (std::isnan(fall.people_share)) return std::nullopt;
            return fall.people_share;
        });
    bind_landscape(module);
    py::class_<Object>(module, "Object")
        .def_readonly("id", &Object::id)
        .def_readonly("primitives", &Object::primitives)
        .def_readonly("grounded", &Object::grounded)
        .def_readonly("agreement", &Object::agreement)
        .def_readonly("mass_kg", &Object::mass_kg)
        .def_readonly("center_of_mass_m", &Object::center_of_mass_m)
        .def_readonly("support_height_m", &Object::support_height_m)
        .def_readonly("center_height_m", &Object::center_height_m)
        .def_readonly("size_m", &Object::size_m)
        .def_readonly("box_middle_m", &Object::box_middle_m)
        .def_readonly("piece_of", &Object::piece_of)
        .def_readonly("piece_probability", &Object::piece_probability)
        .def_readonly("joint_probability", &Object::joint_probability)
        .def_readonly("weakest_joint", &Object::weakest_joint)
        .def_readonly("barrier_J", &Object::barrier_J)
        .def_readonly("barrier_error_J", &Object::barrier_error_J)
        .def_readonly("mass_error_kg", &Object::mass_error_kg)
        .def_readonly("center_of_mass_error_m", &Object::center_of_mass_error_m)
        .def_readonly("footprint_error_m", &Object::footprint_error_m)
        .def_readonly("mass_model", &Object::mass_model)
        .def_property_readonly("inertia_kg_m2",
                               [](const Object& o) {
                                   py::array_t<double> out({3, 3});
                                   std::ranges::copy(o.inertia_kg_m2, out.mutable_data());
                                   return out;
                               })
        .def_readonly("release_J", &Object::release_J)
        .def_readonly("overturning", &Object::overturning)
        .def_readonly("fragility", &Object::fragility)
        .def_readonly("barrier_by_direction", &Object::barrier_by_direction)
        .def_readonly("landscape", &Object::landscape)
        .def_property_readonly("drop_m", [](const Object& o) { return o.why.drop_m; })
        .def_readonly("mode", &Object::mode)
        .def_readonly("direction", &Object::direction)
        .def_readonly("risk_J", &Object::risk_J)
        .def_readonly("risk_spread_J", &Object::risk_spread_J)
        .def_readonly("risk_error_J", &Object::risk_error_J)
        .def_readonly("fall_chance", &Object::fall_chance)
        .def_readonly("unsafety", &Object::unsafety)
        .def_property_readonly("unsafety_category",
                               [](const Object& o) -> std::optional<std::string> {
                                   if (o.unsafety_category.empty()) return std::nullopt;
                                   return o.unsafety_category;
                               })
        .def_readonly("unsafety_certain", &Object::unsafety_certain)
        .def_readonly("seen_enough", &Object::seen_enough)
        .def_readonly("rests_by", &Object::rests_by)
        .def_readonly("rest_probability", &Object::rest_probability)
        .def_property_readonly(
            "instability",
            [](const py::object& self) {
                const auto& curve = self.cast<const Object&>().instability;
                return py::array_t<double>(
                    {static_cast<py::ssize_t>(curve.size()), py::ssize_t{2}},
                    {py::ssize_t{sizeof(InstabilityStep)}, py::ssize_t{sizeof(double)}},
                    reinterpret_cast<const double*>(curve.data()), self);
            })
        .def_property_readonly("why", [](const Object& o) { return o.why.sentence; })
        .def_readonly("why_figures", &Object::why)
        .def_readonly("fall", &Object::fall)
        .def_property_readonly("stands_on", [](const Object& o) { return o.why.stands_on; })
        .def_property_readonly("advice", [](const Object& o) { return o.advice.sentence; })
        .def_property_readonly("action", [](const Object& o) { return o.advice.action; })
        .def_readonly("advice_figures", &Object::advice)
        .def_readonly("name", &Object::name)
        .def_readonly("corrected", &Object::corrected);
    py::class_<Contact>(module, "Contact")
        .def_readonly("a", &Contact::a)
        .def_readonly("b", &Contact::b)
        .def_readonly("area_m2", &Contact::area_m2)
        .def_readonly("normal", &Contact::normal)
        .def_readonly("relation", &Contact::relation)
        .def_readonly("probability", &Contact::probability);
    py::class_<Support>(module, "Support")
        .def_readonly("supporter", &Support::supporter)
        .def_readonly("supported", &Support::supported)
        .def_readonly("area_m2", &Support::area_m2)
        .def_readonly("probability", &Support::probability);
    py::class_<AppliedCorrection>(module, "AppliedCorrection")
        .def_property_readonly(
            "do", [](const AppliedCorrection& c) { return to_string(c.correction.kind); })
        .def_readonly("held", &AppliedCorrection::held)
        .def_readonly("outcome", &AppliedCorrection::outcome)
        .def_readonly("objects", &AppliedCorrection::objects);
}

template <class Member>
auto point_array(Member member) {
    return
        [member](const py::object& self) { return borrowed(scene_of(self).points.*member, self); };
}

py::dict solid(const py::object& self) {
    const SolidVoxels& v = scene_of(self).solid;
    py::dict out;
    out["x"] = borrowed(v.x, self);
    out["y"] = borrowed(v.y, self);
    out["z"] = borrowed(v.z, self);
    out["primitive"] = borrowed(v.primitive, self);
    out["object"] = borrowed(v.object, self);
    out["state"] = borrowed(v.state, self);
    return out;
}

py::dict fields(const py::object& self) {
    py::dict out;
    for (const auto& [name, f] : scene_of(self).fields) {
        py::dict field;
        field["x"] = borrowed(f.x, self);
        field["y"] = borrowed(f.y, self);
        field["z"] = borrowed(f.z, self);
        field["vx"] = borrowed(f.vx, self);
        field["vy"] = borrowed(f.vy, self);
        field["vz"] = borrowed(f.vz, self);
        field["density"] = borrowed(f.density, self);
        out[py::str(name)] = field;
    }
    return out;
}

}  // namespace

void bind_result(py::module_& module) {
    bind_items(module);
    const auto scene = [](auto member) {
        return [member](const Parsed& p) { return p.result.scene.*member; };
    };
    py::class_<Parsed, std::shared_ptr<Parsed>>(module, "Parsed")
        .def_property_readonly("source", scene(&Scene::source))
        .def_property_readonly("backend", scene(&Scene::backend))
        .def_property_readonly("device", scene(&Scene::device))
        .def_property_readonly("seed", scene(&Scene::seed))
        .def_property_readonly("voxel_size_m", scene(&Scene::voxel_size_m))
        .def_property_readonly("offset_m", scene(&Scene::offset_m))
        .def_property_readonly("up", scene(&Scene::up))
        .def_property_readonly("up_method", scene(&Scene::up_method))
        .def_property_readonly("manhattan_from_input", scene(&Scene::manhattan_from_input))
        .def_property_readonly("notes", scene(&Scene::notes))
        .def_property_readonly("timings_s",
                               [](const Parsed& p) {
                                   py::dict out;
                                   for (const auto& [name, s] : p.result.scene.timings_s)
                                       out[py::str(name)] = s;
                                   return out;
                               })
        .def_property_readonly("in_blocks",
                               [](const Parsed& p) { return p.result.tiled != nullptr; })
        .def_property_readonly("events", scene(&Scene::events))
        .def_property_readonly(
            "objects", [](const py::object& self) { return items(scene_of(self).objects, self); })
        .def_property_readonly(
            "primitives",
            [](const py::object& self) { return items(scene_of(self).primitives, self); })
        .def_property_readonly(
            "contacts", [](const py::object& self) { return items(scene_of(self).contacts, self); })
        .def_property_readonly(
            "supports", [](const py::object& self) { return items(scene_of(self).supports, self); })
        .def_property_readonly(
            "corrections",
            [](const py::object& self) { return items(scene_of(self).corrections, self); })
        .def_property_readonly("x", point_array(&ScenePoints::x))
        .def_property_readonly("y", point_array(&ScenePoints::y))
        .def_property_readonly("z", point_array(&ScenePoints::z))
        .def_property_readonly("nx", point_array(&ScenePoints::nx))
        .def_property_readonly("ny", point_array(&ScenePoints::ny))
        .def_property_readonly("nz", point_array(&ScenePoints::nz))
        .def_property_readonly("point_primitive", point_array(&ScenePoints::primitive))
        .def_property_readonly("point_object", point_array(&ScenePoints::object))
        .def_property_readonly("point_region", point_array(&ScenePoints::region))
        .def_property_readonly("point_index", point_array(&ScenePoints::index))
        .def_property_readonly("solid", solid)
        .def_property_readonly("fields", fields);
}

}  // namespace topple::python
