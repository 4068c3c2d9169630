"""Numbers that tests/support/reference.h computes in the same way, and the file of results that it reads."""
import json
import math
import struct

import torch


def hashed(name, count):
    """count numbers in [-1, 1): FNV-1a of the name, the index, MurmurHash3's finalizer."""
    seed = 2166136261
    for byte in name.encode():
        seed = (seed ^ byte) * 16777619 & 0xFFFFFFFF
    x = (seed + torch.arange(count, dtype=torch.int64) * 0x9E3779B9) & 0xFFFFFFFF
    x = (x ^ x >> 16) * 0x85EBCA6B & 0xFFFFFFFF  # int64 wraps around, which leaves the low bits as they are
    x = (x ^ x >> 13) * 0xC2B2AE35 & 0xFFFFFFFF
    x = x ^ x >> 16
    return (x >> 8).to(torch.float64) * 2.0**-23 - 1


def as_float(x):
    return x.to(torch.float32).to(torch.float64)


class Params(dict):
    """Parameters by name, made when the network first asks for them."""

    def get(self, name, *shape):
        if name not in self:
            u = hashed(name, math.prod(shape)).reshape(shape)
            if len(shape) > 1:
                u = u * math.sqrt(6.0 / math.prod(shape[1:]))
            elif name.endswith(".running_var") or name.endswith("norm.weight"):
                u = 1 + 0.2 * u
            else:
                u = 0.2 * u
            self[name] = as_float(u).requires_grad_(".running_" not in name)
        return self[name]


def write_safetensors(path, tensors):
    header, data = {}, b""
    for name, t in tensors.items():
        half = name.startswith("step.")
        raw = t.detach().contiguous().to(torch.float16 if half else torch.float32).numpy().tobytes()
        header[name] = {"dtype": "F16" if half else "F32", "shape": list(t.shape),
                        "data_offsets": [len(data), len(data) + len(raw)]}
        data += raw
    text = json.dumps(header, separators=(",", ":")).encode()
    with open(path, "wb") as f:
        f.write(struct.pack("<Q", len(text)) + text + data)
