#!/usr/bin/python3
"""Remakes the vectors that tests/model/test_reference.c holds the network engine against.

    apt install python3-torch && tests/reference/make_reference.py

Small MERLiN variants, written in PyTorch in double precision beside src/model: one training step (losses, gradients,
Adam with clipping and two learning rates), the losses after it, and the outputs in evaluation mode. Inputs and initial
parameters are not stored: both sides draw them from the same hash.
"""
import math
import os

import torch
import torch.nn.functional as F

from numbers_by_name import Params, as_float, hashed, write_safetensors

SIZE, BATCH, STRIDE, WIDTH = 64, 2, 8, 8  # outputs are kept at every STRIDE-th pixel
LEVELS, LIGHT_POWER, FOV = 5, 5.95, 60.0
RATE, CLIP, EPSILON = 0.01, 1.0, 1e-3
WEIGHTS = {"normal": 2.0}


def image_input(name, channels, scale, shift):
    u = hashed(name, BATCH * SIZE * SIZE * channels).reshape(BATCH, SIZE, SIZE, channels)
    return as_float(scale * u + shift).permute(0, 3, 1, 2)


def disc(radius):
    y, x = torch.meshgrid(torch.arange(SIZE), torch.arange(SIZE), indexing="ij")
    one = ((2 * x + 1 - SIZE) ** 2 + (2 * y + 1 - SIZE) ** 2 < 4 * radius**2).to(torch.float64)
    return one.expand(BATCH, 1, SIZE, SIZE)


def make_inputs():
    mask = disc(26)
    inputs = {"mask": mask, "loss_mask": disc(25), "image": image_input("image", 3, 0.5, 0.5) * mask}
    for name, channels, scale, shift in (
        ("albedo_true", 3, 1, 0), ("roughness_true", 1, 1, 0), ("normal_true", 3, 1, 0), ("depth_true", 1, 0.1, 1),
        ("direct_true", 3, 0.5, 0.5), ("indirect_true", 3, 0.05, 0.05), ("reconstruction_true", 3, 0.5, 0.5),
        ("relit_true", 3, 0.5, 0.5)):
        inputs[name] = image_input(name, channels, scale, shift)
    inputs["light"] = hashed("light", BATCH * 3).reshape(BATCH, 3)
    inputs["light_position"] = as_float(0.5 * hashed("light_position", BATCH * 3)).reshape(BATCH, 3)
    return inputs


# ---- the network of src/model ----

class Network:
    def __init__(self, variant, params):
        self.variant, self.p, self.training = variant, params, True

    def conv(self, x, name, out, kernel, stride=1, bias=True):
        weight = self.p.get(name + ".weight", out, x.shape[1], kernel, kernel)
        return F.conv2d(x, weight, self.p.get(name + ".bias", out) if bias else None, stride, (kernel - 1) // 2)

    def normed(self, x, name, out, stride=1):
        y = self.conv(x, name + ".conv", out, 3, stride, bias=False)
        statistics = [self.p.get(f"{name}.norm.{s}", out) for s in ("running_mean", "running_var", "weight", "bias")]
        return F.batch_norm(y, *statistics, training=self.training, momentum=0.1, eps=1e-5)

    def block(self, x, name, out, stride=1):
        return F.relu(self.normed(x, name, out, stride))

    def residual(self, x, name, count):
        for i in range(count):
            x = x + self.normed(self.block(x, f"{name}.block{i}.a", WIDTH), f"{name}.block{i}.b", WIDTH)
        return x

    def linear(self, x, name, out):
        return torch.tanh(F.linear(x, self.p.get(name + ".weight", out, x.shape[1]), self.p.get(name + ".bias", out)))

    def encoder(self, x, name):
        n, c, h, w = x.shape
        x = x.reshape(n, c, h // 2, 2, w // 2, 2).permute(0, 3, 5, 1, 2, 4).reshape(n, 4 * c, h // 2, w // 2)
        blocks = self.variant["encoder_blocks"] if name == "encoder" else [0] * LEVELS
        features = []
        for i in range(LEVELS):
            x = self.block(x, f"{name}.level{i}.a", WIDTH, 2 if i else 1)
            for convolution in ([], ["b"], ["b"], ["b"], ["b", "c"])[i]:
                x = self.block(x, f"{name}.level{i}.{convolution}", WIDTH)
            x = self.residual(x, f"{name}.level{i}", blocks[i])
            features.append(x)
        return features

    def gate(self, skip, signal, name):
        if not self.variant["gated_attention"]:
            return skip
        x = self.conv(skip, name + ".skip", WIDTH // 2, 1, 2, bias=False)
        x = F.relu(x + self.conv(signal, name + ".signal", WIDTH // 2, 1))
        alpha = torch.sigmoid(self.conv(x, name + ".psi", 1, 1))
        return skip * self.double(alpha)

    @staticmethod
    def double(x):
        return F.interpolate(x, scale_factor=2, mode="bilinear", align_corners=False)

    def decoder(self, name, bottleneck, skips, shared=None):
        blocks = self.variant["material_blocks"] if name.startswith("material") else [0] * LEVELS
        d, features = bottleneck, [None] * (LEVELS - 1)
        for i in reversed(range(LEVELS - 1)):
            stage = f"{name}.level{i}"
            parts = [self.double(self.conv(d, stage + ".up", WIDTH, 1)), self.gate(skips[i], d, stage + ".gate")]
            if shared:
                parts.append(self.gate(shared[i], d, stage + ".shared_gate"))
            d = self.block(torch.cat(parts, 1), stage + ".fuse", WIDTH) + skips[i]
            features[i] = d = self.residual(d, stage, blocks[i])
        return features

    def head(self, x, name, channels):
        y = self.conv(x, name, 4 * channels, 3)
        n, _, h, w = y.shape
        return y.reshape(n, 2, 2, channels, h, w).permute(0, 3, 4, 1, 5, 2).reshape(n, channels, 2 * h, 2 * w)

    def material(self, encoder):
        if self.variant["material_decoders"] == 1:
            features = self.decoder("material", encoder[-1], encoder)
            heads = self.head(features[0], "material.head", 8).split((3, 3, 1, 1), 1)
            return heads, features
        heads, total = [], None
        for name, channels in (("albedo", 3), ("normal", 3), ("roughness", 1), ("depth", 1)):
            features = self.decoder("material_" + name, encoder[-1], encoder)
            heads.append(self.head(features[0], f"material_{name}.head", channels))
            total = features if total is None else [a + b for a, b in zip(total, features)]
        return heads, total

    def indirect(self, direct, maps, mask):
        x = torch.cat((direct, maps["albedo"], maps["normal"], maps["roughness"], maps["depth"], mask), 1) * mask
        encoder = self.encoder(x, "indirect.encoder")
        features = self.decoder("indirect.decoder", encoder[-1], encoder)
        return 0.1 * self.head(features[0], "indirect.head", 3) * mask

    def relit(self, inputs, encoder, shared):
        code = inputs["light"]
        for i, width in enumerate((8, 32, 128)):
            code = self.linear(code, f"lighting.fc{i + 1}", width)
        deepest = encoder[-1]
        tiled = code[:, :, None, None].expand(-1, -1, deepest.shape[2], deepest.shape[3])
        features = self.decoder("relight", torch.cat((deepest, tiled), 1), encoder, shared)
        return torch.sigmoid(self.head(features[0], "relight.head", 3)) * inputs["mask"]

    def forward(self, inputs):
        mask = inputs["mask"]
        encoder = self.encoder(torch.cat((inputs["image"], mask), 1), "encoder")
        (albedo, normal, roughness, depth), features = self.material(encoder)
        out = {"albedo": torch.tanh(albedo), "normal": F.normalize(normal, dim=1, eps=1e-6),
               "roughness": torch.tanh(roughness), "depth": 1 / (1.2 * torch.tanh(depth) + 1.45)}
        out["direct"] = render(out, mask, torch.zeros_like(inputs["light_position"]))
        if self.variant["global_illumination"]:
            out["indirect"] = self.indirect(out["direct"], out, mask)
        if self.variant["relight_by_network"]:
            out["relit_direct"] = self.relit(inputs, encoder, features if self.variant["feature_sharing"] else None)
        if not self.variant["relight_by_network"] or not self.training:
            out["relit_brdf"] = render(out, mask, inputs["light_position"])
        return out


def render(maps, mask, light):
    """Karis 2013 with F0 = 0.05 under one point light, clipped (docs/conventions.md)."""
    step = 2 * math.tan(math.radians(FOV / 2)) / SIZE
    y, x = torch.meshgrid(torch.arange(SIZE), torch.arange(SIZE), indexing="ij")
    ray = torch.stack(((x + 0.5 - SIZE / 2) * step, (SIZE / 2 - y - 0.5) * step, -torch.ones_like(x))).to(torch.float64)
    to_light = light[:, :, None, None] - ray * maps["depth"]
    distance2 = (to_light**2).sum(1, keepdim=True)
    l, v = to_light / distance2.sqrt(), F.normalize(-ray, dim=0).expand_as(to_light)
    h, n = F.normalize(l + v, dim=1), maps["normal"]

    def cosine(a, b):
        return (a * b).sum(1, keepdim=True).clamp(0, 1)

    n_l, n_v, n_h, v_h = cosine(n, l), cosine(n, v), cosine(n, h), cosine(v, h)
    roughness = (0.5 * maps["roughness"] + 0.5).clamp(min=0.03)
    alpha2, k = roughness**4, (roughness + 1) ** 2 / 8
    distribution = alpha2 / (math.pi * (n_h**2 * (alpha2 - 1) + 1) ** 2)
    fresnel = 0.05 + 0.95 * 2 ** ((-5.55473 * v_h - 6.98316) * v_h)
    specular = distribution * fresnel / (4 * (n_l * (1 - k) + k) * (n_v * (1 - k) + k))
    radiance = LIGHT_POWER * ((0.5 * maps["albedo"] + 0.5) / math.pi + specular) * n_l / distance2
    return radiance.clamp(0, 1) * mask


# ---- losses ----

def masked_l2(prediction, target, mask):
    return (((prediction - target) * mask) ** 2).sum() / mask.sum()


def masked_gradient_l2(prediction, target, mask):
    e, inside = prediction - target, mask > 0.5
    right = ((e[..., 1:] - e[..., :-1]) ** 2)[(inside[..., 1:] & inside[..., :-1]).expand_as(e[..., 1:])].sum()
    below = (e[..., 1:, :] - e[..., :-1, :]) ** 2
    return (right + below[(inside[..., 1:, :] & inside[..., :-1, :]).expand_as(below)].sum()) / mask.sum()


def all_losses(out, inputs):
    mask = inputs["loss_mask"]
    losses = {k: masked_l2(out[k], inputs[k + "_true"], mask) for k in ("albedo", "normal", "depth", "roughness", "direct")}
    losses["roughness_gradient"] = masked_gradient_l2(out["roughness"], inputs["roughness_true"], mask)
    if "indirect" in out:
        losses["indirect"] = masked_l2(out["indirect"], inputs["indirect_true"], mask)
        losses["reconstruction"] = masked_l2(out["direct"] + out["indirect"], inputs["reconstruction_true"], mask)
    relit = out["relit_direct"] if "relit_direct" in out else out["relit_brdf"]
    losses["relight"] = masked_l2(relit, inputs["relit_true"], mask)
    return losses


# ---- one variant's file ----

def optimize(params, losses):
    total = sum(WEIGHTS.get(k, 1.0) * v for k, v in losses.items())
    total.backward()
    learned = {k: p for k, p in params.items() if p.requires_grad}
    gradients = {k: p.grad.clone() for k, p in learned.items()}
    groups = [{"params": [p for k, p in learned.items() if k.startswith("relight") == fast], "lr": RATE * (1 + fast)}
              for fast in (False, True)]
    groups = [g for g in groups if g["params"]]
    torch.nn.utils.clip_grad_norm_(list(learned.values()), CLIP)
    before = {k: p.detach().clone() for k, p in learned.items()}
    torch.optim.Adam(groups, betas=(0.9, 0.999), eps=EPSILON).step()
    return total, gradients, {k: (p.detach() - before[k]) / RATE for k, p in learned.items()}


def make(path, variant):
    params, inputs, tensors = Params(), make_inputs(), {}
    network = Network(variant, params)
    losses = all_losses(network.forward(inputs), inputs)
    total, gradients, steps = optimize(params, losses)
    tensors["total"] = total.reshape(1)
    tensors.update({"loss." + k: v.reshape(1) for k, v in losses.items()})
    tensors.update({"gradient." + k: v for k, v in gradients.items()})
    if variant["keep_steps"]:
        tensors.update({"step." + k: v for k, v in steps.items()})
    after = all_losses(network.forward(inputs), inputs)
    tensors.update({"after." + k: v.reshape(1) for k, v in after.items()})
    tensors.update({"running." + k: v for k, v in params.items() if ".running_" in k})
    network.training = False
    with torch.no_grad():
        out = network.forward(inputs)
    tensors.update({"output." + k: v[:, :, ::STRIDE, ::STRIDE].permute(0, 2, 3, 1) for k, v in out.items()})
    write_safetensors(path, tensors)
    print(f"{path}: {os.path.getsize(path)} bytes, {sum(p.numel() for p in params.values())} parameters, "
          f"loss {float(total):.6f}, then {float(sum(WEIGHTS.get(k, 1.0) * v for k, v in after.items())):.6f}")


if __name__ == "__main__":
    torch.manual_seed(0)
    folder = os.path.dirname(os.path.abspath(__file__))
    make(os.path.join(folder, "merlin.safetensors"),
         {"material_decoders": 1, "feature_sharing": True, "gated_attention": True, "relight_by_network": True,
          "global_illumination": True, "encoder_blocks": [0, 0, 2, 0, 1], "material_blocks": [0, 1, 0, 0],
          "keep_steps": True})
    make(os.path.join(folder, "four_decoders.safetensors"),
         {"material_decoders": 4, "feature_sharing": False, "gated_attention": False, "relight_by_network": False,
          "global_illumination": False, "encoder_blocks": [0, 1, 0, 0, 0], "material_blocks": [0, 0, 1, 0],
          "keep_steps": False})
