"""Makes library.safetensors, which safetensors_test reads: tensors as the library itself writes them.

    python make_safetensors.py        with safetensors 0.8.0 and numpy
"""

import pathlib

import numpy
from safetensors.numpy import save_file

save_file(
    {
        "weight": numpy.arange(6, dtype=numpy.float32).reshape(2, 3) / 4,
        "bias": numpy.array([-1.5, 3e-9], numpy.float32),
        "scalar": numpy.array(0.1, numpy.float64),
        "many": numpy.array([2**62, -7], numpy.int64),
        "none": numpy.zeros((0, 3), numpy.float32),
        'a "name"\n\u00e9': numpy.array([1.0], numpy.float32),
    },
    pathlib.Path(__file__).parent / "library.safetensors",
    metadata={"activation": "tanh"},
)
