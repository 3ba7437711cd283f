"""Does the arm touch itself or the scene, where, and how near is the next pair?"""

import mjarm

robot = mjarm.Robot("ur5e")
below_the_floor = [0, 0, 2.65, -1.3, 1.55, 0]  # [rad]
for q in (robot.home, below_the_floor):
    report = robot.check(q, margin=1)
    print(f"{'free' if report else 'touches'}: {report.nearest} at {1e3 * report.distance:.1f} mm")
    for contact in report.contacts:
        print(f"  {contact.geoms[0]} and {contact.geoms[1]} overlap by {1e3 * contact.depth:.1f} mm")
