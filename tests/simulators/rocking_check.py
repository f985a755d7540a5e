# SPDX-License-Identifier: MIT
"""How blocks on shaking ground end in MuJoCo, beside what topple's kernel says: they stand, overturn or slide off.

rocking_check.py FILE: the cases of rocking_test.cpp. A block moves in a plane, by two slides and a hinge, on a plate that
ends where its support does. Everything is relative to the ground, whose acceleration acts as a force at the centre of mass.

Contacts are as hard as the step allows (a time constant of four steps) and damped critically, so that nothing bounces. Let go
from a lean, blocks twice to five times as high as wide then keep within 1 % of the speed that Housner's impact leaves them.
Friction has a slower time constant of its own: MuJoCo's friction cone gives what slides a normal speed of friction times
sliding speed for as long as the sliding is being stopped, so that at the same time constant blocks hop while they slide, and
some then overturn that only can slide. With 20 ms they don't, and slide as far as Newmark says within 0.5 %.
"""
import json
import math
import sys
from collections import Counter

from expected import needed

mujoco = needed('mujoco')
np = needed('numpy')
rollout = needed('mujoco.rollout')

STEP_S = 0.0005
FRICTION_S = 0.02
SETTLING_S, AFTER_S, CHUNK_S = 0.1, 8, 1
LIES = math.radians(85)  # a face on the plate, but for what the contacts give
STANDS, OVERTURNS, SLIDES = 'stands', 'overturns', 'slides off'


def block(half_width, half_height, friction, support):
    behind, ahead = support
    return mujoco.MjModel.from_xml_string(f'''
<mujoco>
  <option timestep="{STEP_S}" gravity="0 0 0" cone="elliptic" impratio="100" integrator="implicitfast"/>
  <worldbody>
    <geom name="plate" type="box" pos="{(ahead - behind) / 2} 0 -0.5" size="{(ahead + behind) / 2} 1 0.5"/>
    <body pos="0 0 {half_height}">
      <joint name="x" type="slide" axis="1 0 0"/>
      <joint name="z" type="slide" axis="0 0 1"/>
      <joint type="hinge" axis="0 1 0"/>
      <geom name="block" type="box" size="{half_width} 0.5 {half_height}" mass="1"/>
    </body>
  </worldbody>
  <contact>
    <pair geom1="plate" geom2="block" friction="{friction} {friction} 0 0 0" solref="{4 * STEP_S} 1"
          solreffriction="{FRICTION_S} 1" solimp="0.99 0.99 0.001"/>
  </contact>
  <actuator><motor joint="x"/><motor joint="z"/></actuator>
</mujoco>''')


class Ground:
    """The forces on a block of a kilogram, by steps, from when something can move it."""

    def __init__(self, case, record, gravity):
        components = np.array(record['m_s2'])
        at = np.arange(components.shape[1]) * record['step_s']
        times = np.arange(STEP_S / 2, at[-1], STEP_S)
        along, across, up = (scale * np.interp(times, at, c) for scale, c in zip(case['scale'], components))
        level, weight = along + across, gravity + up
        least = 0.99 * min(case['friction'], case['half_width_m'] / case['half_height_m'])
        moves = np.flatnonzero(np.abs(level) > least * weight)
        first, last = (moves[0], moves[-1] + 1) if len(moves) else (0, 0)
        settling, after = round(SETTLING_S / STEP_S), round(AFTER_S / STEP_S)
        self.last = settling + last - first  # afterwards nothing sets it in motion again
        self.forces = np.zeros((settling + len(level) - first + after, 2))
        self.forces[:, 1] = -gravity
        self.forces[settling:len(self.forces) - after] = np.stack([level, -weight], axis=1)[first:]


def ends(cases, records, gravity):
    """How each ends."""
    models = [block(c['half_width_m'], c['half_height_m'], c['friction'], c['support_m']) for c in cases]
    grounds = [Ground(c, records[c['record']], gravity) for c in cases]
    spec = mujoco.mjtState.mjSTATE_FULLPHYSICS  # time, places, speeds
    state = np.zeros((len(cases), mujoco.mj_stateSize(models[0], spec)))
    data = [mujoco.MjData(models[0]) for _ in range(2)]
    beyond = np.zeros(len(cases), bool)  # its base had its middle where the support ends before it was beyond its balance
    out = [STANDS] * len(cases)
    going, step, chunk = list(range(len(cases))), 0, round(CHUNK_S / STEP_S)
    while going:
        forces = np.zeros((len(going), chunk, 2))
        forces[:, :, 1] = -gravity
        for k, n in enumerate(going):
            part = grounds[n].forces[step:step + chunk]
            forces[k, :len(part)] = part
        states, _ = rollout.rollout([models[n] for n in going], data, state[going], forces)
        step += chunk
        left = []
        for k, n in enumerate(going):
            case, (x, z, turn), speed = cases[n], states[k, :, 1:4].T, states[k, -1, 4:7]
            if not np.isfinite(states[k]).all():
                raise RuntimeError(f'case {n}: not finite')
            state[n] = states[k, -1]
            high, balance = case['half_height_m'], math.atan2(case['half_width_m'], case['half_height_m'])
            middle = x - high * np.sin(turn)
            outside = np.flatnonzero((middle > case['support_m'][1]) | (middle < -case['support_m'][0]))
            over = np.flatnonzero(np.abs(turn) > balance)
            if len(outside) and not (len(over) and over[0] < outside[0]):
                beyond[n] = True
            if ((np.abs(turn) > LIES) | (z < -high)).any():
                out[n] = SLIDES if beyond[n] else OVERTURNS
                continue
            rests = step > grounds[n].last and np.abs(speed).max() < 1e-3 and abs(turn[-1]) < 0.1 * balance
            if not rests and step < len(grounds[n].forces):
                left.append(n)
        going = left
    return out


def main():
    with open(sys.argv[1], encoding='utf-8') as file:
        scene = json.load(file)
    cases = scene['cases']
    own = [OVERTURNS if c['overturned'] else SLIDES if c['slid_off'] else STANDS for c in cases]
    theirs = ends(cases, scene['records'], scene['gravity'])
    count = Counter(zip(own, theirs))
    for one in (STANDS, OVERTURNS, SLIDES):
        print(f'{one:10} in topple; in MuJoCo ' +
              ', '.join(f'{count[one, other]} {other}' for other in (STANDS, OVERTURNS, SLIDES)))
    neither, either = count[STANDS, STANDS], len(cases) - count[STANDS, STANDS]
    differ = [c for c, a, b in zip(cases, own, theirs) if (a == STANDS) != (b == STANDS)]
    both = either - len(differ)
    print(f'{len(cases)} blocks: {100 * (both + neither) / len(cases):.1f} % stand or fall alike; of the {either} that fall in '
          f'either {100 * both / max(either, 1):.1f} % do in both; of the {len(differ)} others {sum(c["near"] for c in differ)} end '
          'otherwise in topple at a peak a tenth lower or higher')
    return 0 if both + neither >= scene['least_alike'] * len(cases) and both >= scene['least_both'] * either else 1


if __name__ == '__main__':
    sys.exit(main())
