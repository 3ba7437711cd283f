"""A trained policy, tried on goals that training has never seen, and written for other programs."""

import pathlib
import tempfile

import mjarm

policy = mjarm.Policy.load("reach")  # a checkpoint knows the task it was trained for
result = policy.evaluate(episodes=100, seed=7)
print(f"within 2 cm of {100 * result['within_2cm']:.0f} % of {result['episodes']} goals, median {1e3 * result['median']:.1f} mm")

with tempfile.TemporaryDirectory() as folder:
    file = pathlib.Path(folder) / "reach.onnx"
    policy.save_onnx(file)
    print(f"{file.name}: {file.stat().st_size} bytes")
