// SPDX-License-Identifier: MIT
#include <console_bridge/console.h>
#include <gtest/gtest.h>
#include <urdf_parser/urdf_parser.h>

#include "simulators/exported.h"
#include "simulators/placed.h"

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

TEST(Exports, UrdfIsReadByUrdfdomWithoutAWord) {
    for (const Exported& each : exported()) {
        Heard heard;
        const auto all = urdf::parseURDFFile(each.folder / "scene.urdf");
        ASSERT_TRUE(all) << heard.all;
        EXPECT_EQ(all->getRoot()->name, "world");
        EXPECT_EQ(all->links_.size(), each.bodies.size() + 1);
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
            EXPECT_EQ(alone->links_.size(), 1u);
            expect_link(*alone->getRoot(), named, files, 0.001);
        }
        EXPECT_EQ(heard.all, "");
    }
}

}  // namespace
}  // namespace topple::exports::test
