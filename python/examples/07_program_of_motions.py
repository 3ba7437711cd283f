"""A motion program as text: joint and straight moves, blended, planned as one and run in MuJoCo."""

import mjarm

program = mjarm.Program.parse("""
robot: ur5e
program:
  - movej: {pos: [0.2, -0.45, 0.4], euler: [180deg, 0, 0]}
  - repeat:
      times: 2
      program:
      - movel: {pos: [-0.2, -0.45, 0.4], euler: [180deg, 0, 0], speed: 0.3, blend: 20mm}
      - movel: {pos: [-0.2, -0.45, 0.25], euler: [180deg, 0, 0], speed: 0.1}
      - wait: 200ms
      - movec: {via: {pos: [0, -0.35, 0.35], euler: [180deg, 0, 0]}, to: {pos: [0.2, -0.45, 0.4], euler: [180deg, 0, 0]}}
""")
plan = program.check()
for fault in plan.faults:
    print(fault)
run = plan.run()
print(f"{len(plan)} motions in {plan.duration:.2f} s, at most {1e3 * run.report['path_error_max']:.1g} mm from the path")
