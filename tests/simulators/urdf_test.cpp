// SPDX-License-Identifier: MIT
#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <sdf/sdf.hh>

#include "simulators/exported.h"
#include "simulators/placed.h"
#include "simulators/script.h"

// scene.urdf and the single ones, as ROS's library reads them.
namespace topple::exports::test {
namespace {

// What the library says.
class Heard : public console_bridge::OutputHandler {
  public:
    Heard() {
        console_bridge::useOutputHandler(this);
        console_bridge::setLogLevel(console_bridge::CONSOLE_BRIDGE_LOG_WARN);
    }
    ~Heard() override { console_bridge::restorePreviousOutputHandler(); }
    void log(const std::string& text, console_bridge::LogLevel, const char*, int) override {
        all += text;
        all += '\n';
    }
    std::string all;
};

Bounds bounds_of(const urdf::Collision& collision, const Vec3& center,
                 const std::filesystem::path& folder) {
    const urdf::Pose& pose = collision.origin;
    std::array<double, 4> q{};
    pose.rotation.getQuaternion(q[1], q[2], q[3], q[0]);
    const Vec3 at{center[0] + pose.position.x, center[1] + pose.position.y,
                  center[2] + pose.position.z};
    if (const auto* box = dynamic_cast<const urdf::Box*>(collision.geometry.get()))
        return bounds_of_box(q, at, {box->dim.x / 2, box->dim.y / 2, box->dim.z / 2});
    if (const auto* cylinder = dynamic_cast<const urdf::Cylinder*>(collision.geometry.get()))
        return bounds_of_cylinder(q, at, cylinder->radius, cylinder->length / 2);
    if (const auto* sphere = dynamic_cast<const urdf::Sphere*>(collision.geometry.get()))
        return bounds_of_box({1, 0, 0, 0}, at, {sphere->radius, sphere->radius, sphere->radius});
    const auto& mesh = dynamic_cast<const urdf::Mesh&>(*collision.geometry);
    return bounds_of_mesh(q, at, folder / mesh.filename);
}

// thinner_m: of hulls, all around.
void expect_link(const urdf::Link& link, const NamedBody& named,
                 const std::filesystem::path& folder, double thinner_m) {
    const Body& body = *named.body;
    ASSERT_TRUE(link.inertial);
    EXPECT_NEAR(link.inertial->mass, body.fixed ? 0 : body.mass_kg, 1e-6 * body.mass_kg);
    if (!body.fixed) {
        EXPECT_NEAR(link.inertial->ixx, body.inertia_kg_m2[0], 1e-6 * body.inertia_kg_m2[0]);
        EXPECT_NEAR(link.inertial->ixy, body.inertia_kg_m2[1], 1e-6 * body.inertia_kg_m2[0]);
    }
    ASSERT_EQ(link.collision_array.size(), named.parts.size());
    for (std::size_t n = 0; n < named.parts.size(); ++n) {
        SCOPED_TRACE(named.parts[n].name);
        EXPECT_EQ(link.collision_array[n]->name, named.parts[n].name);
        const ConvexPart& part = *named.parts[n].part;
        bounds_of(*link.collision_array[n], body.center_m, folder)
            .expect(is_mesh(named.parts[n].shape) ? shrunk(part, thinner_m) : part,
                    round_tolerance_m + 1e-6);
    }
    EXPECT_EQ(link.visual_array.size(), body.visual.triangle.empty() ? 0u : 1u);
    for (const auto& visual : link.visual_array) {
        const auto& mesh = dynamic_cast<const urdf::Mesh&>(*visual->geometry);
        EXPECT_TRUE(std::filesystem::exists(folder / mesh.filename));
    }
}

void expect_front(const urdf::ModelInterface& model, const NamedFront& named, const NamedBody& of) {
    const JointedFront& front = *named.front;
    const auto link = model.getLink(front.name);
    ASSERT_TRUE(link);
    EXPECT_EQ(link->getParent()->name, of.name);
    EXPECT_NEAR(link->inertial->mass, front.mass_kg, 1e-6);
    EXPECT_EQ(link->collision_array.size(), front.boxes.size());
    const urdf::Joint& joint = *link->parent_joint;
    EXPECT_EQ(joint.type, front.slides() ? urdf::Joint::PRISMATIC : urdf::Joint::REVOLUTE);
    EXPECT_NEAR(joint.limits->upper, front.most, 1e-8);
    EXPECT_EQ(joint.limits->lower, 0);
    EXPECT_NEAR(joint.axis.y * front.axis[1] + joint.axis.z * front.axis[2], 1, 1e-8);
    EXPECT_NEAR(joint.parent_to_joint_origin_transform.position.x,
                front.at_m[0] - of.body->center_m[0], 1e-8);
}

TEST(Exports, UrdfIsReadByUrdfdomWithoutAWord) {
    for (const Exported& each : exported()) {
        Heard heard;
        const auto all = urdf::parseURDFFile(each.folder / "scene.urdf");
        ASSERT_TRUE(all) << heard.all;
        EXPECT_EQ(all->getRoot()->name, "world");
        EXPECT_EQ(all->links_.size(), each.bodies.size() + each.scene.fronts.size() + 1);
        for (const NamedBody& named : each.bodies) {
            SCOPED_TRACE(named.name);
            const auto link = all->getLink(named.name);
            ASSERT_TRUE(link);
            expect_link(*link, named, each.folder, 0);
            const urdf::Joint& joint = *link->parent_joint;
            EXPECT_EQ(joint.type, named.body->fixed ? urdf::Joint::FIXED : urdf::Joint::FLOATING);
            EXPECT_NEAR(joint.parent_to_joint_origin_transform.position.z, named.body->center_m[2],
                        1e-8);
            const auto files = each.folder / "scene_urdf";
            const auto alone = urdf::parseURDFFile(files / (named.name + ".urdf"));
            ASSERT_TRUE(alone) << heard.all;
            EXPECT_EQ(alone->links_.size(), 1 + named.fronts.size());
            for (const NamedFront& front : named.fronts) {
                expect_front(*all, front, named);
                expect_front(*alone, front, named);
            }
            expect_link(*alone->getRoot(), named, files, 0.001);
        }
        EXPECT_EQ(heard.all, "");
    }
}

// scene.sdf as Gazebo's library reads it.

Bounds bounds_of(const sdf::Collision& collision, const Vec3& center,
                 const std::filesystem::path& folder) {
    const auto pose = collision.RawPose();
    const std::array<double, 4> q{pose.Rot().W(), pose.Rot().X(), pose.Rot().Y(), pose.Rot().Z()};
    const Vec3 at{center[0] + pose.Pos().X(), center[1] + pose.Pos().Y(),
                  center[2] + pose.Pos().Z()};
    const sdf::Geometry& shape = *collision.Geom();
    if (const sdf::Box* box = shape.BoxShape()) {
        const auto size = box->Size();
        return bounds_of_box(q, at, {size.X() / 2, size.Y() / 2, size.Z() / 2});
    }
    if (const sdf::Cylinder* cylinder = shape.CylinderShape())
        return bounds_of_cylinder(q, at, cylinder->Radius(), cylinder->Length() / 2);
    if (const sdf::Sphere* sphere = shape.SphereShape())
        return bounds_of_box({1, 0, 0, 0}, at,
                             {sphere->Radius(), sphere->Radius(), sphere->Radius()});
    return bounds_of_mesh(q, at, folder / shape.MeshShape()->Uri());
}

void expect_model(const sdf::Model& model, const NamedBody& named, const Exported& each) {
    const Body& body = *named.body;
    EXPECT_EQ(model.Static(), body.fixed);
    EXPECT_NEAR(model.RawPose().Pos().Z(), body.center_m[2], 1e-8);
    ASSERT_EQ(model.LinkCount(), 1 + named.fronts.size());
    ASSERT_EQ(model.JointCount(), named.fronts.size());
    for (std::size_t n = 0; n < named.fronts.size(); ++n) {
        const JointedFront& front = *named.fronts[n].front;
        const sdf::Joint& joint = *model.JointByIndex(n);
        EXPECT_EQ(joint.ChildLinkName(), front.name);
        EXPECT_EQ(joint.Type(),
                  front.slides() ? sdf::JointType::PRISMATIC : sdf::JointType::REVOLUTE);
        EXPECT_NEAR(joint.Axis(0)->Upper(), front.most, 1e-8);
        EXPECT_NEAR(joint.Axis(0)->Xyz().Z(), front.axis[2], 1e-8);
        EXPECT_NEAR(joint.RawPose().Pos().X(), front.at_m[0] - front.center_m[0], 1e-8);
        const sdf::Link& link = *model.LinkByName(front.name);
        EXPECT_NEAR(link.Inertial().MassMatrix().Mass(), front.mass_kg, 1e-6);
        EXPECT_EQ(link.CollisionCount(), front.boxes.size());
    }
    const sdf::Link& link = *model.LinkByIndex(0);
    if (!body.fixed) {
        const auto mass = link.Inertial().MassMatrix();
        EXPECT_NEAR(mass.Mass(), body.mass_kg, 1e-6 * body.mass_kg);
        EXPECT_NEAR(mass.Ixx(), body.inertia_kg_m2[0], 1e-6 * body.inertia_kg_m2[0]);
        EXPECT_NEAR(mass.Ixy(), body.inertia_kg_m2[1], 1e-6 * body.inertia_kg_m2[0]);
    }
    ASSERT_EQ(link.CollisionCount(), named.parts.size());
    for (const NamedPart& part : named.parts) {
        SCOPED_TRACE(part.name);
        const sdf::Collision* collision = link.CollisionByName(part.name);
        ASSERT_TRUE(collision);
        sdf::ElementPtr element = collision->Element();
        for (const char* within : {"surface", "friction", "ode"})
            element = element->GetElement(within);
        EXPECT_NEAR(element->Get<double>("mu"), named.friction, 1e-9);
        bounds_of(*collision, body.center_m, each.folder)
            .expect(*part.part, round_tolerance_m + 1e-6);
    }
    ASSERT_EQ(link.VisualCount(), body.visual.triangle.empty() ? 0u : 1u);
    if (link.VisualCount() == 0) return;
    const sdf::Mesh* mesh = link.VisualByIndex(0)->Geom()->MeshShape();
    ASSERT_TRUE(mesh);
    EXPECT_TRUE(std::filesystem::exists(each.folder / mesh->Uri()));
}

TEST(Exports, SdfIsReadBySdformatWithoutAWarning) {
    for (const Exported& each : exported()) {
        sdf::ParserConfig strict;
        strict.SetWarningsPolicy(sdf::EnforcementPolicy::ERR);
        strict.SetUnrecognizedElementsPolicy(sdf::EnforcementPolicy::ERR);
        strict.SetDeprecatedElementsPolicy(sdf::EnforcementPolicy::ERR);
        sdf::Root root;
        for (const sdf::Error& error : root.Load(each.folder / "scene.sdf", strict))
            ADD_FAILURE() << error.Message();
        ASSERT_EQ(root.WorldCount(), 1u);
        const sdf::World& world = *root.WorldByIndex(0);
        EXPECT_NEAR(world.Gravity().Z(), -each.scene.gravity_m_s2, 1e-9);
        EXPECT_EQ(world.LightCount(), 1u);
        EXPECT_EQ(world.ModelCount(), each.bodies.size());
        for (const NamedBody& named : each.bodies) {
            SCOPED_TRACE(named.name);
            ASSERT_TRUE(world.ModelByName(named.name));
            expect_model(*world.ModelByName(named.name), named, each);
        }
    }
}

// What libraries for Python make of exports: each has a script of its own in this folder.

void check_by(const std::string& library) {
    for (const Exported& each : exported()) {
        const auto [text, code] = run_script(library + "_check.py", each.folder.string());
        if (code == script_missing) GTEST_SKIP() << text << "run ./dev setup";
        EXPECT_EQ(code, 0) << text;
        EXPECT_NE(text.find(library + " has read all"), std::string::npos) << text;
    }
}

TEST(Exports, AreReadAndRunByMujoco) {
    check_by("mujoco");
}
TEST(Exports, AreReadAndRunByPybullet) {
    check_by("pybullet");
}
TEST(Exports, AreReadByUsd) {
    check_by("usd");
}

}  // namespace
}  // namespace topple::exports::test
