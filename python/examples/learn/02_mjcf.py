"""A box hangs in the air until its body has a joint. Which joint says how it may move."""

import mujoco

HELLO = """<mujoco model="hello">
  <worldbody>
    <geom name="floor" type="plane" size="5 5 0.1"/>
    <body name="box" pos="0 0 2">
      {joint}
      <geom name="box" type="box" size="0.5 0.5 0.5" density="500"/>
    </body>
  </worldbody>
</mujoco>"""


def height(joint, seconds):
    """Of the box's middle [m], after so much time."""
    model = mujoco.MjModel.from_xml_string(HELLO.format(joint=joint))
    data = mujoco.MjData(model)
    while data.time < seconds - 1e-9:
        mujoco.mj_step(model, data)
    mujoco.mj_forward(model, data)  # page 03 tells why
    return data.body("box").xpos[2]


hangs = height("", 0.5)
falls = height("<freejoint/>", 0.5)
lies = height("<freejoint/>", 2)
turns = height('<joint axis="0 1 0"/>', 0.5)
swings = height('<joint axis="0 1 0" pos="-1 0 0"/>', 0.5)
print(f"no joint {hangs:.3f} m, free joint {falls:.3f} m, on the floor {lies:.3f} m")
print(f"hinge through the middle {turns:.3f} m, hinge 1 m beside it {swings:.3f} m")
print(f"2 - g t^2 / 2 = {2 - 9.81 * 0.5**2 / 2:.3f} m")
sound = hangs == 2 and abs(falls - 0.774) < 0.01 and abs(lies - 0.5) < 0.001 and turns == 2 and swings < 1.9
raise SystemExit(0 if sound else 1)
