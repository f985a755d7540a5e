# SPDX-License-Identifier: MIT
"""scene.usda as USD reads it, and as its own checks judge it."""
import sys

from expected import WITHIN_M, Expected, matrix, near, near_inertia, needed

needed('pxr.Usd')
np = needed('numpy')
from pxr import Usd, UsdGeom, UsdPhysics, UsdShade  # noqa: E402


def check_rules(stage, file):
    try:
        from pxr import UsdValidation
    except ImportError:
        from pxr import UsdUtils
        checker = UsdUtils.ComplianceChecker()
        checker.CheckCompliance(file)
        found = checker.GetErrors() + checker.GetFailedChecks() + checker.GetWarnings()
    else:
        validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
        assert validators
        found = [e.GetErrorAsString() for e in UsdValidation.ValidationContext(validators).Validate(stage)]
    assert not found, found


def check_part(prim, place, friction, boxes):
    bounds = boxes.ComputeWorldBound(prim).ComputeAlignedRange()
    near(prim.GetName(), [bounds.GetMin(), bounds.GetMax()], [place['low'], place['high']], WITHIN_M)
    if place['mesh']:
        assert UsdPhysics.MeshCollisionAPI(prim).GetApproximationAttr().Get() == 'convexHull'
    material, _ = UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial('physics')
    near('friction', UsdPhysics.MaterialAPI(material.GetPrim()).GetStaticFrictionAttr().Get(), friction, 1e-6)


def check(prim, body, boxes):
    name = prim.GetName()
    assert prim.HasAPI(UsdPhysics.RigidBodyAPI) == (not body['fixed']), name
    place = UsdGeom.Xformable(prim).ComputeLocalToWorldTransform(Usd.TimeCode.Default()).ExtractTranslation()
    near(name, place, body['center'], 1e-6)
    if not body['fixed']:
        mass = UsdPhysics.MassAPI(prim)
        near(name, mass.GetMassAttr().Get(), body['mass'], 1e-5 * body['mass'])
        turn = mass.GetPrincipalAxesAttr().Get()
        near_inertia(name, mass.GetDiagonalInertiaAttr().Get(), matrix(turn.GetReal(), *turn.GetImaginary()), body)
    parts = {child.GetName(): child for child in prim.GetChildren() if child.HasAPI(UsdPhysics.CollisionAPI)}
    assert set(parts) == set(body['parts']), name
    for part, child in parts.items():
        check_part(child, body['parts'][part], body['friction'], boxes)
    seen = prim.GetChild('visual')
    assert bool(seen) == body['colours'], name
    if seen:
        colours = UsdGeom.Mesh(seen).GetDisplayColorPrimvar()
        assert len(colours.ComputeFlattened()) in (1, len(UsdGeom.Mesh(seen).GetPointsAttr().Get())), name


def check_front(stage, name, of, front, boxes):
    prim, joint = stage.GetPrimAtPath(f'/World/{name}'), stage.GetPrimAtPath(f'/World/{front["joint"]}')
    place = UsdGeom.Xformable(prim).ComputeLocalToWorldTransform(Usd.TimeCode.Default()).ExtractTranslation()
    near(name, place, front['center'], 1e-6)
    mass = UsdPhysics.MassAPI(prim)
    turn = mass.GetPrincipalAxesAttr().Get()
    near_inertia(name, mass.GetDiagonalInertiaAttr().Get(), matrix(turn.GetReal(), *turn.GetImaginary()), front)
    bounds = boxes.ComputeWorldBound(prim).ComputeAlignedRange()
    near(name, [bounds.GetMin(), bounds.GetMax()], [front['low'], front['high']], WITHIN_M)
    kind = UsdPhysics.PrismaticJoint if front['slides'] else UsdPhysics.RevoluteJoint
    made = kind(joint)
    assert made and [str(t) for t in made.GetBody0Rel().GetTargets() + made.GetBody1Rel().GetTargets()] == [f'/World/{of}', f'/World/{name}'], name
    assert made.GetAxisAttr().Get() == 'X', name
    turn = made.GetLocalRot0Attr().Get()
    near(name, matrix(turn.GetReal(), *turn.GetImaginary())[:, 0], front['axis'], 1e-6)
    near(name, made.GetUpperLimitAttr().Get(), front['most'] * (1 if front['slides'] else 180 / np.pi), 1e-4)
    near(name, np.array(made.GetLocalPos1Attr().Get()) + front['center'], front['at'], 1e-6)


expected = Expected(sys.argv[1])
stage = Usd.Stage.Open(expected.path('scene.usda'))
check_rules(stage, expected.path('scene.usda'))
near('units', [UsdGeom.GetStageMetersPerUnit(stage), UsdPhysics.GetStageKilogramsPerUnit(stage)], [1, 1], 0)
assert UsdGeom.GetStageUpAxis(stage) == 'Z'
physics = UsdPhysics.Scene(stage.GetDefaultPrim().GetChild('physics'))
near('gravity', physics.GetGravityMagnitudeAttr().Get(), expected.gravity, 1e-5)
near('gravity', physics.GetGravityDirectionAttr().Get(), [0, 0, -1], 0)
bodies = [p for p in stage.GetDefaultPrim().GetChildren() if p.GetTypeName() == 'Xform']
assert {p.GetName() for p in bodies} == set(expected.bodies) | set(expected.fronts())
boxes = UsdGeom.BBoxCache(Usd.TimeCode.Default(), [UsdGeom.Tokens.default_, UsdGeom.Tokens.guide])
for prim in bodies:
    if prim.GetName() in expected.bodies:
        check(prim, expected.bodies[prim.GetName()], boxes)
for name, (of, front) in expected.fronts().items():
    check_front(stage, name, of, front, boxes)
print('usd has read all')
