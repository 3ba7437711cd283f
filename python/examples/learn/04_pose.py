"""Two orientations that are nearly the same, and two ways from one to the other."""

import numpy as np

import mjarm

numbers = [3.0, 0.4, 1.0]
fixed = mjarm.Pose([0, 0, 0], euler=numbers)  # about the fixed axes x, y, z
x, y, z = (mjarm.Pose([0, 0, 0], euler=np.where(np.arange(3) == i, numbers, 0)).rotation for i in range(3))
moving = mjarm.Pose([0, 0, 0], matrix=x @ y @ z)  # about moving axes, as MJCF reads euler="..."
same = np.abs(fixed.rotation - z @ y @ x).max()
print(f"fixed = Rz Ry Rx to {same:.0e}; the same numbers about moving axes: "
      f"{np.degrees(fixed.difference(moving)[1]):.1f} deg away")
w, i, j, k = fixed.quat
swapped = mjarm.Pose([0, 0, 0], quat=[i, j, k, w])
print(f"quaternion read in the order x y z w: {np.degrees(fixed.difference(swapped)[1]):.1f} deg away")

start = mjarm.Pose([0, 0, 0], euler=[np.radians(170), 0, 0])  # tool down, leaning 10 deg to one side
goal = mjarm.Pose([0, 0, 0], euler=[np.radians(-170), 0, 0])  # and to the other
print(f"from one lean to the other: {np.degrees(start.difference(goal)[1]):.1f} deg")
share = np.linspace(0, 1, 201)
by_euler = [mjarm.Pose([0, 0, 0], euler=start.euler + s * (goal.euler - start.euler)) for s in share]
by_slerp = [start.interpolate(goal, s) for s in share]


def way(poses):
    """What the tool turns in all [deg]."""
    return np.degrees(sum(a.difference(b)[1] for a, b in zip(poses, poses[1:])))


print(f"way by Euler angles {way(by_euler):.1f} deg, by slerp {way(by_slerp):.1f} deg")
print(f"half way the tool's z axis points: Euler {by_euler[100].rotation[2, 2]:+.2f}, "
      f"slerp {by_slerp[100].rotation[2, 2]:+.2f}   (+1 up, -1 down)")
raise SystemExit(0 if same < 1e-15 and way(by_euler) > 300 and abs(way(by_slerp) - 20) < 0.01 else 1)
