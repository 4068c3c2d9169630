# SPDX-License-Identifier: MIT
"""Photographs imported by merlin, without a window. Arguments: the add-on's zip, merlin, and an empty folder with
demo.png and window.png."""

import os
import shutil
import sys
from math import degrees

import bpy
import numpy as np

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from harness import ARGUMENTS, install, picture, preferences, run

archive, merlin, place = ARGUMENTS
QUICK = {"size": 256, "views": 1}


def path(name):
    return os.path.join(place, name)


def bring(*names, **options):
    files = [{"name": name} for name in names]
    return bpy.ops.import_scene.merlin_photographs(directory=place, files=files, filepath=path(names[0]), **QUICK, **options)


def refusal(*names, **options):
    try:
        bring(*names, **options)
    except RuntimeError as error:
        return str(error)
    raise AssertionError(f"{names} were imported")


def guide(name):
    return bpy.data.objects[f"{name} camera"].data.background_images[0].image


def a_photograph_becomes_an_object_and_its_results_stay_beside_it():
    assert bring("demo.png") == {"FINISHED"}
    assert os.path.isfile(path("demo.merlin/maps.exr"))
    assert bpy.data.objects["demo object"].data.polygons and bpy.context.scene.name == "demo"
    assert os.path.samefile(bpy.path.abspath(guide("demo").filepath), path("demo.png"))


def several_get_a_scene_each():
    preferences().output = path("here")
    assert bring("demo.png", "window.png") == {"FINISHED"}
    assert "demo" in bpy.data.scenes and "window" in bpy.data.scenes
    assert os.path.isfile(path("here/window/maps.exr"))


def or_stand_side_by_side_in_one():
    preferences().output = path("here")
    bring("demo.png", "window.png", own_scene=False)
    assert bpy.data.objects["demo"].location.x == 0 and bpy.data.objects["window"].location.x > 1
    assert len(bpy.data.scenes) == 1


def one_alone_has_a_folder_inside_that_of_all_results_too():
    preferences().output = path("alone")
    bring("demo.png")
    assert os.path.isfile(path("alone/demo/maps.exr"))


def options_reach_merlin():
    shutil.copy(path("demo.merlin/mask.png"), path("painted.png"))
    bring("demo.png", model="merlin-env", fov=40, mask=path("painted.png"))
    assert abs(degrees(bpy.data.cameras["demo camera"].angle_x) - 40) < 0.01
    assert bpy.context.scene.world.node_tree.nodes.get("Environment Texture"), "merlin-env finds surroundings"


def exif_turned(data, orientation):
    """A JPEG that says how the camera was held."""
    tiff = b"MM\0\x2a\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01" + bytes([0, orientation]) + b"\0\0\0\0\0\0"
    body = b"Exif\0\0" + tiff
    return data[:2] + b"\xff\xe1" + (len(body) + 2).to_bytes(2, "big") + body + data[2:]


def a_photograph_that_was_turned_lies_behind_as_merlin_read_it():
    image = bpy.data.images.load(path("demo.png"))
    assert image.pixels[0] is not None  # which reads it
    image.file_format, image.filepath_raw = "JPEG", path("upright.jpg")
    image.save()
    with open(path("upright.jpg"), "rb") as file:
        data = file.read()
    with open(path("turned.jpg"), "wb") as file:
        file.write(exif_turned(data, 3))
    mask = picture(path("demo.merlin/mask.png"), data=True)
    for name, turn in (("upright", 1), ("turned", -1)):
        out = bpy.data.images.new("mask", mask.shape[1], mask.shape[0])
        out.pixels = mask[::-1][::turn, ::turn].ravel()
        out.file_format, out.filepath_raw = "PNG", path(f"{name}_mask.png")
        out.save()
        bring(f"{name}.jpg")
    assert not guide("upright").packed_file and guide("turned").packed_file
    size = guide("turned").size[:]
    cut = np.array(guide("turned").pixels[:]).reshape(size[1], size[0], 4)[::-1]
    upright = picture(path("demo.png"))[::-1, ::-1]
    inside = cut[:, :, 3] > 0.999
    assert inside.mean() > 0.2 and np.abs(cut - upright)[inside][:, :3].mean() < 0.02


def refusals_are_in_merlins_words():
    assert "merlin estimate: " in refusal("missing.png") and "missing.png" in refusal("missing.png")
    with open(path("text.png"), "w", encoding="utf-8") as file:
        file.write("no picture")
    assert "merlin estimate: " in refusal("text.png")
    assert "Error: " not in refusal("text.png").removeprefix("Error: ")


def those_that_are_sound_are_imported_beside_one_that_is_not():
    words = refusal("missing.png", "window.png")
    assert "missing.png" in words and "window.png" not in words, words
    assert "window object" in bpy.data.objects


def a_program_that_is_not_there_is_named():
    preferences().program = "no-such-merlin"
    assert "no-such-merlin is not in PATH: install merlin" in refusal("demo.png")
    preferences().program = path("demo.png")
    assert f"{path('demo.png')} is no program" in refusal("demo.png")


def a_program_that_dies_is_told_of():
    for words, told in (("exit 7", "merlin exited with 7 without a word"), ("kill -9 $$", "ended by signal 9")):
        with open(path("broken"), "w", encoding="utf-8") as file:
            file.write(f"#!/bin/sh\n{words}\n")
        os.chmod(path("broken"), 0o755)
        preferences().program = path("broken")
        assert told in refusal("demo.png")


install(archive)


def with_settings(check):
    def checked():
        preferences().program, preferences().output = merlin, ""
        check()

    checked.__name__ = check.__name__
    return checked


run([with_settings(check) for check in (
    a_photograph_becomes_an_object_and_its_results_stay_beside_it,
    several_get_a_scene_each,
    or_stand_side_by_side_in_one,
    one_alone_has_a_folder_inside_that_of_all_results_too,
    options_reach_merlin,
    a_photograph_that_was_turned_lies_behind_as_merlin_read_it,
    refusals_are_in_merlins_words,
    those_that_are_sound_are_imported_beside_one_that_is_not,
    a_program_that_is_not_there_is_named,
    a_program_that_dies_is_told_of,
)])  # fmt: skip
