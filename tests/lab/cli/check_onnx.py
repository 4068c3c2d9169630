# SPDX-License-Identifier: MIT
"""check_onnx.py FOLDER BATCH,HEIGHT,WIDTH: the networks of merlin-lab export are valid ONNX whose shapes can be inferred, with
the inputs and outputs that networks.json names, in pictures of that shape."""
import json
import pathlib
import sys

import onnx

folder, shape = pathlib.Path(sys.argv[1]), sys.argv[2].split(",")


def expected(entry):
    batch, *sides = shape
    reduction = entry["reduction"]
    if reduction == 0:
        sides = ["1", "1"]
    elif reduction > 1:
        sides = [str(int(s) // reduction) if s.isdigit() else f"{s}/{reduction}" for s in sides]
    return entry["name"], [batch, str(entry["channels"]), *sides]


def declared(value):
    return value.name, [d.dim_param or str(d.dim_value) for d in value.type.tensor_type.shape.dim]


networks = json.loads((folder / "networks.json").read_text())["networks"]
assert [n["file"] for n in networks] == ["maps.onnx", "bounces.onnx", "relight.onnx"], networks
for network in networks:
    model = onnx.load(folder / network["file"])
    onnx.checker.check_model(model, full_check=True)
    onnx.shape_inference.infer_shapes(model, strict_mode=True)
    assert [expected(e) for e in network["inputs"]] == [declared(v) for v in model.graph.input], network["file"]
    assert [expected(e) for e in network["outputs"]] == [declared(v) for v in model.graph.output], network["file"]
    assert {"config", "license", "model"} == {p.key for p in model.metadata_props}, network["file"]
