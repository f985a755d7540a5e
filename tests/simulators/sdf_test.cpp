// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <sdf/sdf.hh>

#include "simulators/exported.h"
#include "simulators/placed.h"

// scene.sdf as Gazebo's library reads it.
namespace topple::exports::test {
namespace {

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
    ASSERT_EQ(model.LinkCount(), 1u);
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
        EXPECT_NEAR(element->Get<double>("mu"), each.scene.friction, 1e-9);
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

}  // namespace
}  // namespace topple::exports::test
