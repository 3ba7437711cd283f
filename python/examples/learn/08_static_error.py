"""Static error of a servo is gravity / gain: worked out for each joint, compared with MuJoCo, and cured."""

import mujoco
import numpy as np

import mjarm

robot = mjarm.Robot("ur5e")
model = mujoco.MjModel.from_xml_path(str(robot.file))
data = mujoco.MjData(model)
start = [-1.57, -1.34, 2.65, -1.3, 1.55, 0]
goal = robot.ik(mjarm.Pose([-0.13, 0.6, 0.1], euler=[3.14, 0, 1.57]), seed=start).q

data.qpos[:6] = goal
mujoco.mj_forward(model, data)
gravity = data.qfrc_bias[:6].copy()  # [N m] at rest: what holds the arm against gravity
gain = model.actuator_gainprm[:6, 0]  # [N m/rad]
expected = gravity / gain

mujoco.mj_resetData(model, data)
data.qpos[:6] = start
data.ctrl[:6] = goal  # "go there" is all that a plain servo is told
while data.time < 5:
    mujoco.mj_step(model, data)
sag = goal - data.qpos[:6]
for name, torque, k, e, s in zip(robot.joints, gravity, gain, expected, sag):
    if abs(torque) > 0.1:
        print(f"{name}: {torque:.2f} N m / {k:.0f} N m/rad = {1e3 * e:.2f} mrad, measured {1e3 * s:.2f} mrad")
print(f"the tool is {1e3 * robot.fk(data.qpos).difference(robot.fk(goal))[0]:.1f} mm off")

motion = robot.time([start, goal], share=0.5)
error = [robot.simulate(motion, control=c, rest=2).report["static_error"]["position"] for c in ("servo_gravity", "computed_torque")]
print("servo + gravity, computed torque: under 0.01 mm" if max(error) < 1e-5 else error)
raise SystemExit(not (max(error) < 1e-5 and np.allclose(sag, expected, rtol=0.03, atol=1e-4)))
