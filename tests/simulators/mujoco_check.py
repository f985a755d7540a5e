# SPDX-License-Identifier: MIT
"""scene.xml and scene.urdf as MuJoCo reads and runs them."""
import sys

from expected import WITHIN_M, Expected, matrix, near, near_inertia, needed

mujoco = needed('mujoco')
np = needed('numpy')


def corners(model, data, geom):
    """Points, in the world, whose extents along the axes are the geom's."""
    size, turn = model.geom_size[geom], data.geom_xmat[geom].reshape(3, 3)
    kind = model.geom_type[geom]
    if kind == mujoco.mjtGeom.mjGEOM_MESH:
        mesh = model.geom_dataid[geom]
        first = model.mesh_vertadr[mesh]
        local = model.mesh_vert[first:first + model.mesh_vertnum[mesh]]
    elif kind == mujoco.mjtGeom.mjGEOM_BOX:
        local = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * size
    else:
        along = np.zeros(3) if kind == mujoco.mjtGeom.mjGEOM_SPHERE else np.abs(turn[:, 2])
        half = along * size[1] + size[0] * np.sqrt(np.maximum(0, 1 - along ** 2))
        return data.geom_xpos[geom] + np.array([-half, half])
    return data.geom_xpos[geom] + local @ turn.T


def check_geoms(expected, model, data, name):
    body = expected.bodies[name]
    geoms = [g for g in range(model.ngeom) if model.geom_bodyid[g] == model.body(name).id]
    hard = [g for g in geoms if model.geom_contype[g]]
    assert len(hard) == len(body['parts']), name
    for geom, (part, place) in zip(sorted(hard, key=lambda g: model.geom(g).name), sorted(body['parts'].items())):
        assert model.geom(geom).name == part
        points = corners(model, data, geom)
        near(part, [points.min(0), points.max(0)], [place['low'], place['high']], WITHIN_M)
    seen = [g for g in geoms if not model.geom_contype[g]]
    assert len(seen) == body['colours'], name
    return seen


def check(expected, file):
    model = mujoco.MjModel.from_xml_path(expected.path(file))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    near('gravity', model.opt.gravity, [0, 0, -expected.gravity], 1e-9)
    assert {model.body(b).name for b in range(1, model.nbody)} == set(expected.bodies) | set(expected.fronts()), file
    for name, body in expected.bodies.items():
        found = model.body(name)
        near(name, data.xpos[found.id], body['center'], 1e-6)
        assert model.body_dofnum[found.id] == (0 if body['fixed'] else 6), name
        if not body['fixed']:
            near(name, found.mass, body['mass'], 1e-6 * body['mass'])
            near_inertia(name, found.inertia, matrix(*found.iquat), body)
        seen = check_geoms(expected, model, data, name)
        if file == 'scene.xml':
            rubs = [model.geom_friction[g][0] for g in range(model.ngeom) if model.geom_bodyid[g] == found.id and model.geom_contype[g]]
            near(name, rubs, [body['friction']] * len(rubs), 1e-9)
            for geom in seen:
                mesh = model.geom_dataid[geom]
                assert model.geom_matid[geom] >= 0 and model.mesh_texcoordnum[mesh] > 0, name
    for name, (of, front) in expected.fronts().items():
        check_front(model, data, name, of, front)
    rests(expected, model, data, file)
    opens(expected, model, data)


def check_front(model, data, name, of, front):
    found, joint = model.body(name), model.joint(front['joint'])
    assert model.body(found.parentid[0]).name == of and found.jntadr[0] == joint.id, name
    near(name, data.xipos[found.id], front['center'], 1e-6)
    near(name, found.mass, front['mass'], 1e-6 * front['mass'])
    near_inertia(name, found.inertia, data.ximat[found.id].reshape(3, 3), front)
    assert joint.type[0] == (mujoco.mjtJoint.mjJNT_SLIDE if front['slides'] else mujoco.mjtJoint.mjJNT_HINGE), name
    near(name, data.xaxis[joint.id], front['axis'], 1e-6)
    near(name, joint.range, [0, front['most']], 1e-6)
    if not front['slides']:
        near(name, np.cross(data.xanchor[joint.id] - np.array(front['at']), front['axis']), [0, 0, 0], 1e-6)
    boxes = [g for g in range(model.ngeom) if model.geom_bodyid[g] == found.id and model.geom_contype[g]]
    assert len(boxes) == front['boxes'], name
    points = np.concatenate([corners(model, data, g) for g in boxes])
    near(name, [points.min(0), points.max(0)], [front['low'], front['high']], WITHIN_M)


def opens(expected, model, data):
    """What is pulled opens outwards as far as its joint lets it, and no further."""
    for name, (_, front) in expected.fronts().items():
        joint = model.joint(front['joint'])
        angle = lambda: data.qpos[joint.qposadr[0]]
        near(f'{name}, shut', angle(), 0, 0.002)
        before = data.body(name).xipos.copy()
        data.qfrc_applied[joint.dofadr[0]] = 25 if front['slides'] else 3
        end = data.time + 4
        while data.time < end:
            mujoco.mj_step(model, data)
        near(f'{name}, open', angle(), front['most'], 0.02)
        data.qfrc_applied[joint.dofadr[0]] = 0
        assert (data.body(name).xipos - before)[1] < -0.1, name  # its front looks to -y


def rests(expected, model, data, file):
    names = list(expected.free())
    before = {name: data.body(name).xpos.copy() for name in names}
    while data.time < 1:
        mujoco.mj_step(model, data)
    for name in names:
        near(f'{file}: {name} after a second', data.body(name).xpos, before[name], 0.003)
    assert not any(warning.number for warning in data.warning), file


def sleeps(expected):
    """All that is free goes to sleep where it stands, and what is pushed wakes up."""
    model = mujoco.MjModel.from_xml_path(expected.path('scene_asleep.xml'))
    data = mujoco.MjData(model)
    before = data.qpos.copy()
    while data.time < 1:
        mujoco.mj_step(model, data)
    assert data.ntree_awake == 0 and data.ncon == 0, f'{data.ntree_awake} of {model.ntree} are awake'
    near('places of what sleeps', data.qpos, before, 0.003)
    joint = model.body(next(iter(expected.free()))).jntadr[0]
    data.qvel[model.jnt_dofadr[joint]] = 0.5
    mujoco.mj_step(model, data)
    assert data.ntree_awake > 0, 'nothing woke up'


expected = Expected(sys.argv[1])
check(expected, 'scene.xml')
check(expected, 'scene.urdf')
sleeps(expected)
print('mujoco has read all')
