# SPDX-License-Identifier: MIT
"""Puts a picture with alpha, halved, far up and left into one of 640 x 400."""

import sys

import bpy
import numpy as np

source, target = sys.argv[sys.argv.index("--") + 1 :]
picture = bpy.data.images.load(source)
values = np.array(picture.pixels[:]).reshape(picture.size[1], picture.size[0], 4)
values[:, :, :3] *= values[:, :, 3:]
halves = (values[0::2, 0::2] + values[1::2, 0::2] + values[0::2, 1::2] + values[1::2, 1::2]) / 4
halves[:, :, :3] /= np.maximum(halves[:, :, 3:], 1e-3)
wide = np.zeros((400, 640, 4))
wide[400 - 20 - halves.shape[0] : 400 - 20, 10 : 10 + halves.shape[1]] = halves
out = bpy.data.images.new("wide", 640, 400, alpha=True)
out.pixels = wide.ravel()
out.filepath_raw, out.file_format = target, "PNG"
out.save()
