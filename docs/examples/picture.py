# SPDX-License-Identifier: MIT
# picture.py DIR PICTURE.png [--parts] [--open] [--seconds S]: what MuJoCo shows of an export, after S seconds. It needs PyPI's
# mujoco and Pillow, and where there is no screen MUJOCO_GL=osmesa (libosmesa6) or egl. --parts: what collides, each part in a
# colour of its own, instead of the surfaces. --open: doors and drawers half open. --look X Y Z DISTANCE: from so far at a place.
import argparse
import os
import sys

import mujoco
import numpy as np
from PIL import Image

SURFACES, PARTS = 2, 3  # groups of geoms
WIDTH, HEIGHT = 1200, 750


def main():
    options = argparse.ArgumentParser()
    options.add_argument('dir')
    options.add_argument('picture')
    options.add_argument('--parts', action='store_true')
    options.add_argument('--open', action='store_true', help='doors and drawers half open')
    options.add_argument('--look', type=float, nargs=4, metavar=('X', 'Y', 'Z', 'DISTANCE'), help='what to look at, and from how far, metres')
    options.add_argument('--seconds', type=float, default=0)
    options.add_argument('--azimuth', type=float, default=225)
    options.add_argument('--elevation', type=float, default=-55)
    options = options.parse_args()
    scene = os.path.join(options.dir, 'scene.xml')
    if not os.path.exists(scene):
        sys.exit(f'picture.py: there is no {scene}; export with --mjcf {options.dir} first')
    model = mujoco.MjModel.from_xml_path(scene)
    model.vis.global_.offwidth, model.vis.global_.offheight = WIDTH, HEIGHT
    if options.parts:
        model.geom_rgba[:, :3] = 0.3 + 0.6 * np.random.default_rng(2).random((model.ngeom, 3))
    data = mujoco.MjData(model)
    fronts = model.jnt_limited.astype(bool) & options.open
    data.qpos[model.jnt_qposadr[fronts]] = model.jnt_range[fronts, 1] / 2
    mujoco.mj_forward(model, data)
    for _ in range(round(options.seconds / model.opt.timestep)):
        mujoco.mj_step(model, data)
    camera = mujoco.MjvCamera()
    camera.azimuth, camera.elevation = options.azimuth, options.elevation
    camera.lookat = (data.geom_xpos.min(axis=0) + data.geom_xpos.max(axis=0)) / 2
    camera.distance = 1.2 * np.linalg.norm(np.ptp(data.geom_xpos, axis=0))
    if options.look:
        camera.lookat, camera.distance = options.look[:3], options.look[3]
    shown = mujoco.MjvOption()
    shown.geomgroup[:] = 0
    shown.geomgroup[PARTS if options.parts else SURFACES] = 1
    try:
        renderer = mujoco.Renderer(model, HEIGHT, WIDTH)
    except (mujoco.FatalError, RuntimeError, AttributeError, ImportError) as error:
        sys.exit(f"picture.py: MuJoCo can't draw here ({error}); without a screen set MUJOCO_GL=egl, or osmesa with Debian's libosmesa6")
    with renderer:
        renderer.update_scene(data, camera, shown)
        Image.fromarray(renderer.render()).save(options.picture, optimize=True)


if __name__ == '__main__':
    main()
