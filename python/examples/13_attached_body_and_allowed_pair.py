"""A cup in the hand goes where the hand goes: what it is attached to and may touch decides on paths."""

import pathlib
import tempfile

import mjarm

wall = mjarm.Robot("ur5e").file.with_name("wall.xml")
with tempfile.TemporaryDirectory() as folder:
    scene = pathlib.Path(folder) / "cup.xml"
    scene.write_text(f"""<mujoco><include file="{wall}"/><worldbody>
      <geom name="table" type="box" size="0.1 0.1 0.04" pos="0.3 -0.45 0.04"/>
      <body name="cup" pos="0.3 -0.45 0.13"><freejoint/>
        <geom name="cup" type="cylinder" size="0.02 0.05"/></body></worldbody></mujoco>""")
    robot = mjarm.Robot(scene, allow_outside=True)  # it includes a file outside of its folder

start = [-4.375, -1.2456, 1.9905, -2.3157, -1.5708, 0]  # [rad]
goal = [-5.551, -1.2456, 1.9905, -2.3157, -1.5708, 0]
try:  # attached, it overlaps the table that it stands on by a hair
    robot.plan(start, goal, held=["cup"])
except mjarm.NoPath as why:
    print(f"the cup is attached: {why}")
plan = robot.plan(start, goal, held=["cup"], allowed=[("cup", "table")])
print(f"and may touch the table: {plan.length:.2f} rad")
