#!/usr/bin/python3
"""Remakes the vectors that tests/model/test_rivals.c holds the paper's rivals against.

    apt install python3-torch && tests/reference/make_rivals.py

The networks of Li et al. 2018 and of Sang and Chandraker 2020 with one cascade, written with PyTorch's own modules in
double precision beside src/model/rivals: their outputs in evaluation mode.
"""
import os

import torch
import torch.nn.functional as F

from make_reference import STRIDE, make_inputs, render
from numbers_by_name import Params, write_safetensors

ENCODER, DECODER = (32, 64, 128, 256, 256, 512), (64, 32, 64, 128, 256, 256)


class Rival:
    def __init__(self):
        self.p = Params()

    def norm(self, y, name):
        statistics = [self.p.get(f"{name}.{s}", y.shape[1]) for s in ("running_mean", "running_var", "weight", "bias")]
        return F.batch_norm(y, *statistics, training=False, eps=1e-5)

    def finish(self, y, name):
        return F.relu(self.norm(y, name + ".norm"))

    def down(self, x, name, out, kernel):
        weight = self.p.get(name + ".conv.weight", out, x.shape[1], kernel, kernel)
        return self.finish(F.conv2d(x, weight, stride=2, padding=kernel // 2 - 1), name)

    def up(self, x, name, out):
        weight = self.p.get(name + ".conv.weight", x.shape[1], out, 4, 4)
        return self.finish(F.conv_transpose2d(x, weight, stride=2, padding=1), name)

    def same(self, x, name, out, dilation=1):
        weight = self.p.get(name + ".conv.weight", out, x.shape[1], 3, 3)
        return F.conv2d(x, weight, padding=dilation, dilation=dilation)

    def residual(self, x, name, count, dilation=1):
        for i in range(count):
            block = f"{name}.block{i}"
            y = self.finish(self.same(x, block + ".a", x.shape[1], dilation), block + ".a")
            x = F.relu(x + self.norm(self.same(y, block + ".b", x.shape[1], dilation), block + ".b.norm"))
        return x

    def head(self, x, name, channels):
        weight = self.p.get(name + ".weight", channels, x.shape[1], 5, 5)
        return F.conv2d(x, weight, self.p.get(name + ".bias", channels), padding=2)

    def encoder(self, x):
        features = []
        for i, width in enumerate(ENCODER):
            x = self.down(x, f"encoder.level{i}", width, 4 if i else 6)
            features.append(x)
        return features

    def decoder(self, name, y, skips, shared=None):
        own = {}
        for i in reversed(range(6)):
            own[i] = y = self.up(y, f"{name}.level{i}", DECODER[i])
            if i:
                y = torch.cat([y, skips[i - 1]] + ([shared[i]] if shared else []), 1)
        return y, own

    def code(self, light):
        for i, width in enumerate((8, 32, 128)):
            weight = self.p.get(f"lighting.fc{i + 1}.weight", width, light.shape[1])
            light = torch.tanh(F.linear(light, weight, self.p.get(f"lighting.fc{i + 1}.bias", width)))
        return light[:, :, None, None]


def maps_of(y):
    """Albedo, normal, roughness and depth of four times three channels."""
    albedo, normal, roughness, depth = torch.tanh(y).split(3, 1)
    return {"albedo": albedo, "normal": F.normalize(normal, dim=1, eps=1e-6),
            "roughness": roughness.mean(1, keepdim=True), "depth": 1 / (1.2 * depth.mean(1, keepdim=True) + 1.45)}


def seen_by_cascade(inputs, out, last):
    parts = [inputs["image"], inputs["mask"]] + [out[k] for k in ("albedo", "normal", "roughness", "depth", "direct")]
    return torch.cat(parts + [last], 1) * inputs["mask"]


def direct_of(out, inputs):
    out["direct"] = render(out, inputs["mask"], torch.zeros_like(inputs["light_position"]))
    return out


def sang(r, inputs):
    def relit(y):
        return (0.5 * torch.tanh(y) + 0.5) * inputs["mask"]

    skips = r.encoder(torch.cat([inputs["image"], inputs["mask"]], 1))
    y, shared = r.decoder("material", skips[-1], skips)
    out = maps_of(r.head(r.residual(y, "material", 1, 2), "material.head", 12))
    code = r.code(inputs["light"])
    lit = torch.cat([skips[-1], code.expand(-1, -1, *skips[-1].shape[2:])], 1)
    y = r.residual(r.decoder("relight", lit, skips, shared)[0], "relight", 3, 2)
    out["relit_direct"] = relit(r.head(y, "relight.head", 3))
    direct_of(out, inputs)

    half = r.down(seen_by_cascade(inputs, out, out["relit_direct"]), "cascade1.level0", 64, 6)
    x = r.residual(r.down(half, "cascade1.level1", 128, 6), "cascade1", 3)
    name = "cascade1.material"
    fine = r.up(r.residual(x, name, 3), name + ".level1", 64)
    out = maps_of(r.head(r.up(torch.cat([fine, half], 1), name + ".level0", 64), name + ".head", 12))
    name = "cascade1.relight"
    x = torch.cat([x, code.expand(-1, -1, *x.shape[2:])], 1)
    x = r.finish(r.same(x, name + ".light", 128), name + ".light")
    y = torch.cat([r.up(r.residual(x, name, 3), name + ".level1", 64), half, fine], 1)
    out["relit_direct"] = relit(r.head(r.up(y, name + ".level0", 64), name + ".head", 3))
    return direct_of(out, inputs)


def bounce(r, before, out, mask, name):
    x = torch.cat([before] + [out[k] for k in ("albedo", "normal", "roughness", "depth")] + [mask], 1) * mask
    skips = []
    for i, width in enumerate((64, 64, 128, 256, 256)):
        x = r.down(x, f"{name}.down{i}", width, 4 if i else 6)
        if i == 3:
            x = r.finish(r.same(x, name + ".dilated", width, 3), name + ".dilated")
        skips.append(x)
    for i, width in reversed(list(enumerate((64, 32, 64, 128, 256)))):
        x = r.up(x, f"{name}.up{i}", width)
        if i:
            x = torch.cat([x, skips[i - 1]], 1)
    return 0.1 * r.head(x, name + ".head", 3) * mask


def li(r, inputs):
    names = ("albedo", "normal", "roughness", "depth")
    skips = r.encoder(torch.cat([inputs["image"], inputs["mask"]], 1))
    heads = [r.head(r.decoder("material_" + k, skips[-1], skips)[0], f"material_{k}.head", 3) for k in names]
    out = direct_of(maps_of(torch.cat(heads, 1)), inputs)

    half = r.down(seen_by_cascade(inputs, out, inputs["image"] ** 2 - out["direct"]), "cascade1.level0", 64, 6)
    x = r.residual(r.down(half, "cascade1.level1", 128, 6), "cascade1", 3)
    heads = []
    for name in ("cascade1." + k for k in names):
        y = torch.cat([r.up(r.residual(x, name, 3), name + ".level1", 64), half], 1)
        heads.append(r.head(r.up(y, name + ".level0", 64), name + ".head", 3))
    out = direct_of(maps_of(torch.cat(heads, 1)), inputs)
    second = bounce(r, out["direct"], out, inputs["mask"], "bounce2")
    out["indirect"] = second + bounce(r, second, out, inputs["mask"], "bounce3")
    return out


def main():
    tensors, inputs = {}, {name: value[:1] for name, value in make_inputs().items()}
    for name, network in (("sang", sang), ("li", li)):
        with torch.no_grad():
            out = network(Rival(), inputs)
        out["relit_brdf"] = render(out, inputs["mask"], inputs["light_position"])
        tensors.update({f"{name}.{k}": v[:, :, ::STRIDE, ::STRIDE].permute(0, 2, 3, 1) for k, v in out.items()})
        print(name, {k: round(float(v.std()), 4) for k, v in out.items()})
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "rivals.safetensors")
    write_safetensors(path, tensors)
    print(f"{path}: {os.path.getsize(path)} bytes")


if __name__ == "__main__":
    main()
