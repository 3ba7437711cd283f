"""From the camera to the can in the tray: see, plan, execute; and what each layer answers when it cannot."""

import math

import mujoco
import numpy as np

import mjarm

robot = mjarm.Robot(mjarm.Robot("ur5e").file.with_name("pick.xml"))
qpos = mujoco.MjModel.from_xml_path(str(robot.file)).key_qpos[0]  # arm, fingers, box, can, house
try:
    eye = robot.eye("rgbd")
except mjarm.NotAvailable as why:
    raise SystemExit(f"no picture on this machine: {why}")

can = eye.look(qpos).objects["can"].pose  # the camera, and a 6D pose
print(f"seen: can {1e3 * np.linalg.norm(can.pos - qpos[15:18]):.2f} mm from where it is")
believed = qpos.copy()
believed[15:22] = [*can.pos, *can.quat]  # plans know what was seen, not what is
place = mjarm.Pose([0.56, -0.33, 0.256])
plan = robot.pick("can", place, any_turn=True, qpos=believed)  # planner, straight ways, inverse kinematics
print(f"planned: {' '.join(m.word for m in plan.motions)}, {plan.duration:.1f} s")
run = robot.simulate(plan.motions)
off = np.linalg.norm(run.qpos[15:18] - place.pos)
print(f"done: {run.ok}, can {'less' if off < 0.002 else 'more'} than 2 mm from its place")

print(f"camera: can: {eye.look(run.qpos).missing['can']}")  # it stands behind the fence now
into_table = mjarm.Pose([0.5, -0.33, 0.15], euler=[math.pi, 0, 0])
for layer, asked in (robot.plan, (None, into_table)), (robot.ik, (mjarm.Pose([1.5, 0, 0.3]),)):
    try:
        raise SystemExit(f"{layer.__name__}: this should not work: {layer(*asked)}")
    except mjarm.errors.Error as e:
        print(f"{layer.__name__}: {e}")
line = robot.line(robot.fk(robot.home), mjarm.Pose([0.56, -0.33, 0.22], euler=[math.pi, 0, 0]), robot.home)
print(f"line: {line.message}")
print(f"simulation: {robot.simulate(plan.motions, control='servo').message}")
raise SystemExit(not (run.ok and off < 0.002 and not line.ok))
