"""The model never changes, the data is what changes; and two ways to hold an arm up."""

import mujoco

import mjarm

robot = mjarm.Robot("ur5e")
model = mujoco.MjModel.from_xml_path(str(robot.file))
data = mujoco.MjData(model)
tool = data.site("attachment_site")

mujoco.mj_resetDataKeyframe(model, data, 0)
mujoco.mj_forward(model, data)
before = tool.xpos.copy()  # without copy() it would be a window on data, not a value
data.qpos[0] += 0.5
stale = tool.xpos.copy()
mujoco.mj_forward(model, data)
fresh = tool.xpos.copy()
print(f"before     {before.round(3)}\nstale      {stale.round(3)}\nmj_forward {fresh.round(3)}")


def error_after(seconds, controller=None):
    """How far the tool is from where it began [m], while it shall stand still."""
    mujoco.mj_resetDataKeyframe(model, data, 0)  # it also puts ctrl to the posture
    while data.time < seconds:
        if controller:
            controller.step(data)  # writes data.ctrl
        mujoco.mj_step(model, data)
    return robot.fk(data.qpos).difference(robot.fk(robot.home))[0]


controller = mjarm.Robot(model).controller()
controller.hold(robot.home)
servo, ours = error_after(2), error_after(2, controller)
print(f"held for 2 s: by ctrl = q {1e3 * servo:.2f} mm off, by the controller {1e3 * ours:.4f} mm")
raise SystemExit(0 if (stale == before).all() and abs(fresh - before).max() > 0.1 and ours < 1e-6 < servo else 1)
