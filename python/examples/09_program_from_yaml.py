"""A motion program from a YAML file: read, planned, executed in MuJoCo, measured, reported."""

import json
import sys

import mjarm

program = mjarm.Program.load(sys.argv[1] if len(sys.argv) > 1 else "ellipse")  # a path, or one that comes with mjarm
run = program.run()
print(json.dumps(run.report, indent=2))
sys.exit(not run)
