"""Checks an ONNX model and runs it; onnx_export_test calls this.

    python run_onnx.py MODEL.onnx OBSERVATIONS.json        with onnx and onnxruntime

Prints the actions, one list an observation, as JSON.
"""

import json
import sys

import numpy
import onnx
import onnxruntime

model = onnx.load(sys.argv[1])
onnx.checker.check_model(model, full_check=True)
observations = numpy.array(json.load(open(sys.argv[2])), numpy.float32)
session = onnxruntime.InferenceSession(sys.argv[1], providers=["CPUExecutionProvider"])
assert [i.name for i in session.get_inputs()] == ["observation"], session.get_inputs()
assert [o.name for o in session.get_outputs()] == ["action"], session.get_outputs()
print(json.dumps(session.run(["action"], {"observation": observations})[0].tolist()))
