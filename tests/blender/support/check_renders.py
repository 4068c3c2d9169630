# SPDX-License-Identifier: MIT
"""Cycles renders imported results as merlin relights them. Arguments: the add-on's zip, a folder of results, and where
the renders go.

Means of absolute differences inside the object, of 8-bit values as a share of white. The two agree in light, exposure,
geometry and shadows; they differ in the diffuse part (Blender 3.4's Principled BSDF has Burley's, brighter at grazing
angles; 4's is dimmed by what the gloss reflects), in bounces (traced, or a network's) and by the render's noise.
Measured with Blender 3.4.1 and 4.3.2: see BOUNDS.
"""

import os
import sys

import bpy
import numpy as np

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from harness import ARGUMENTS, install, picture, render, run, shrunk

archive, results, renders = ARGUMENTS
PERCENTAGE, SAMPLES = 25, 64
# What may be left, mean and the signed mean; about half as much again as was measured.
BOUNDS = {"flash": (0.02, 0.02), "lamp": (0.035, 0.02), "slanted": (0.02, 0.02), "window": (0.03, 0.022), "far": (0.035, 0.025)}


def bring(name):
    bpy.ops.import_scene.merlin_folder(filepath=os.path.join(results, name))


def compare(name, relit):
    seen = render(os.path.join(renders, f"{relit}.png"), PERCENTAGE, SAMPLES)
    wanted = shrunk(picture(os.path.join(results, "relit", relit, "relit.png"))[:, :, :3], seen)
    inside = shrunk(picture(os.path.join(results, name, "mask.png"), data=True)[:, :, :1], seen)[:, :, 0] > 0.999
    assert inside.sum() > 500
    difference = (seen - wanted)[inside]
    off, bias = float(np.abs(difference).mean()), float(difference.mean())
    unlike = float(np.abs(wanted[inside] - wanted[inside].mean(0)).mean())
    print(f"{relit}: {100 * off:.2f} % of white, bias {100 * bias:+.2f} %, a flat picture {100 * unlike:.1f} %", flush=True)
    most, most_bias = BOUNDS[relit]
    assert off < most and abs(bias) < most_bias and unlike > 3 * off


def a_flash_renders_as_merlin_relights():
    bring("demo")
    compare("demo", "flash")


def a_lamp_aside_renders_as_merlin_relights():
    bring("demo")
    bpy.data.objects["demo flash"].location = (0.7, 0.3, -0.4)
    compare("demo", "lamp")


def beside_the_lens_axis_it_renders_as_merlin_relights():
    bring("slanted")
    compare("slanted", "slanted")


def the_found_light_renders_as_merlin_relights():
    bring("window")
    compare("window", "window")


def a_surface_of_stereo_renders_as_merlin_relights():
    bring("far")
    compare("far", "far")


install(archive)
run([
    a_flash_renders_as_merlin_relights,
    a_lamp_aside_renders_as_merlin_relights,
    beside_the_lens_axis_it_renders_as_merlin_relights,
    the_found_light_renders_as_merlin_relights,
    a_surface_of_stereo_renders_as_merlin_relights,
])  # fmt: skip
