"""Where a box and a can stand, from one look of an RGB-D camera."""

import mjarm

robot = mjarm.Robot(mjarm.Robot("ur5e").file.with_name("pick.xml"))
try:
    seen = robot.eye("rgbd").look()
except mjarm.NotAvailable as why:
    raise SystemExit(f"no picture on this machine: {why}")
for name, found in seen.objects.items():
    print(f"{name} at {found.pose.pos.round(4)} m, {100 * found.seen:.0f} % of it seen")
for name, reason in seen.missing.items():
    print(f"{name}: {reason}")
