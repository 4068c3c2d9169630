#!/usr/bin/python3
"""Remakes the vectors that tests/nn/test_groups_reference.c holds the operations over several pictures against.

    apt install python3-torch && tests/reference/make_groups.py

A net of layer norm, attention among an object's pictures, pooling, their maximum, mean and spread, and values at
sampled points, by PyTorch's own functions in double precision: loss, gradients, one step of AdamW, output.
"""
import os

import torch
import torch.nn.functional as F

from numbers_by_name import Params, as_float, hashed, write_safetensors

OBJECTS, PICTURES, SIZE, CHANNELS, HEADS, POINTS = 2, 3, 6, 8, 2, 5
RATE, EPSILON, DECAY = 0.01, 1e-3, 0.1
ABSENT = 4  # the second picture of the second object


def conv(p, x, name, out):
    return F.conv2d(x, p.get(name + ".weight", out, x.shape[1], 1, 1), p.get(name + ".bias", out))


def layer_norm(p, x, name):
    y = F.layer_norm(x.permute(0, 2, 3, 1), (x.shape[1],), p.get(name + ".weight", x.shape[1]),
                     p.get(name + ".bias", x.shape[1]))
    return y.permute(0, 3, 1, 2)


def attend(query, key, value, absent):
    """Attention by PyTorch's module with projections that change nothing; tokens × length × channels."""
    module = torch.nn.MultiheadAttention(CHANNELS, HEADS, bias=False, batch_first=True, dtype=torch.float64)
    with torch.no_grad():
        module.in_proj_weight.copy_(torch.eye(CHANNELS, dtype=torch.float64).repeat(3, 1))
        module.out_proj.weight.copy_(torch.eye(CHANNELS, dtype=torch.float64))
    return module(query, key, value, key_padding_mask=absent, need_weights=False)[0]


def tokens(x):
    """Pictures × channels × rows × columns to (objects · pixels) × pictures × channels."""
    x = x.reshape(OBJECTS, PICTURES, x.shape[1], SIZE * SIZE)
    return x.permute(0, 3, 1, 2).reshape(OBJECTS * SIZE * SIZE, PICTURES, -1)


def untokens(t):
    count = t.shape[1]
    t = t.reshape(OBJECTS, SIZE * SIZE, count, CHANNELS).permute(0, 2, 3, 1)
    return t.reshape(OBJECTS * count, CHANNELS, SIZE, SIZE)


def statistics(x, present):
    """Maximum, mean and standard deviation of the pictures that are there."""
    out = []
    for o in range(OBJECTS):
        there = torch.stack([x[i] for i in range(o * PICTURES, (o + 1) * PICTURES) if present[i]])
        out.append(torch.cat([there.max(0)[0], there.mean(0), there.std(0, unbiased=False)]))
    return torch.stack(out)


def net(p, image, present, places):
    x = torch.tanh(conv(p, image, "first", CHANNELS))
    x = layer_norm(p, x, "norm")
    absent = ~present.reshape(OBJECTS, 1, PICTURES).expand(-1, SIZE * SIZE, -1).reshape(-1, PICTURES)
    query, key, value = tokens(conv(p, x, "attention", 3 * CHANNELS)).split(CHANNELS, 2)
    seen = attend(query, key, value, absent) * (~absent).unsqueeze(2)
    seen = untokens(seen)
    key, value = tokens(conv(p, seen, "pooled", 2 * CHANNELS)).split(CHANNELS, 2)
    learned = p.get("pool.weight", CHANNELS).expand(len(key), 1, -1)
    pooled = untokens(attend(learned, key, value, absent))
    common = conv(p, torch.cat([statistics(x, present), pooled], 1), "common", CHANNELS)
    x = torch.tanh(torch.cat([seen, common.repeat_interleave(PICTURES, 0)], 1))
    at = ((places + 0.5) / SIZE * 2 - 1).repeat_interleave(PICTURES, 0).unsqueeze(1)
    at = F.grid_sample(x, at, mode="bilinear", padding_mode="border", align_corners=False)
    return conv(p, at, "last", 3)


def main():
    p, count = Params(), OBJECTS * PICTURES
    image = as_float(hashed("image", count * SIZE * SIZE * 3)).reshape(count, SIZE, SIZE, 3).permute(0, 3, 1, 2)
    places = as_float(4 * hashed("places", OBJECTS * POINTS * 2) + 2.5).reshape(OBJECTS, POINTS, 2)
    target = as_float(hashed("target", count * POINTS * 3)).reshape(count, 1, POINTS, 3).permute(0, 3, 1, 2)
    present = torch.arange(count) != ABSENT
    out = net(p, image, present, places)
    loss = ((out - target) ** 2).sum() / (count * POINTS)
    loss.backward()
    gradients = {k: q.grad.clone() for k, q in p.items()}
    before = {k: q.detach().clone() for k, q in p.items()}
    groups = [{"params": [q for q in p.values() if (q.dim() > 1) == decays], "weight_decay": DECAY * decays}
              for decays in (False, True)]
    torch.optim.AdamW(groups, lr=RATE, betas=(0.9, 0.999), eps=EPSILON).step()
    tensors = {"loss": loss.reshape(1), "output": out.permute(0, 2, 3, 1)}
    tensors.update({"gradient." + k: v for k, v in gradients.items()})
    tensors.update({"step." + k: (q.detach() - before[k]) / RATE for k, q in p.items()})
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "groups.safetensors")
    write_safetensors(path, tensors)
    print(f"{path}: {os.path.getsize(path)} bytes, loss {float(loss):.6f}")


if __name__ == "__main__":
    main()
