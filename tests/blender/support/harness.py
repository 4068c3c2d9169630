# SPDX-License-Identifier: MIT
"""What the checks inside Blender share: the add-on installed from its zip, pictures as arrays, and a run of all checks.

A check is a function whose name is a true sentence; it fails by assert. Each begins with an empty file.
"""

import os
import sys
import traceback

import addon_utils
import bpy
import numpy as np

ARGUMENTS = sys.argv[sys.argv.index("--") + 1 :]
AS_EXTENSION = bpy.app.version >= (4, 2, 0)
PACKAGE = "bl_ext.user_default.merlin_import" if AS_EXTENSION else "merlin_import"


def install(archive):
    """As a user does; BLENDER_USER_RESOURCES or the like says where to."""
    if AS_EXTENSION:
        bpy.ops.extensions.package_install_files(filepath=archive, repo="user_default", enable_on_install=True)
    else:
        bpy.ops.preferences.addon_install(filepath=archive)
        bpy.ops.preferences.addon_enable(module=PACKAGE)
    assert addon_utils.check(PACKAGE)[1], "the add-on is not enabled"


def preferences():
    return bpy.context.preferences.addons[PACKAGE].preferences


def start_afresh():
    """An empty file; the add-on stays."""
    bpy.ops.wm.read_homefile(use_empty=True)


def pixels(image):
    """Values, height x width x channels, the upper row first."""
    values = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(values)
    return values.reshape(image.size[1], image.size[0], -1)[::-1]


def picture(path, data=False):
    """A file's values as they stand in it, or with data those of a map."""
    image = bpy.data.images.load(path)
    if data:
        image.colorspace_settings.name = "Non-Color"
    values = pixels(image).copy()
    bpy.data.images.remove(image)
    return values


def shrunk(values, to):
    """The means over squares of pixels, until it is as large as that picture."""
    step = values.shape[0] // to.shape[0]
    assert values.shape[0] == step * to.shape[0] and values.shape[1] == step * to.shape[1]
    return values.reshape(to.shape[0], step, to.shape[1], step, -1).mean((1, 3))


def render(path, percentage, samples):
    """What Cycles makes of the scene, as an 8-bit picture."""
    scene = bpy.context.scene
    assert scene.render.engine == "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.use_adaptive_sampling = samples, False, False
    scene.render.resolution_percentage = percentage
    scene.render.image_settings.file_format, scene.render.image_settings.color_mode = "PNG", "RGB"
    scene.render.filepath = path
    bpy.ops.render.render(write_still=True)
    return picture(path)[:, :, :3]


def run(checks):
    """Runs them all and ends Blender: with 1 if any has failed."""
    failed = 0
    for check in checks:
        try:
            start_afresh()
            check()
            print(f"[ OK ] {check.__name__}", flush=True)
        except Exception:
            failed += 1
            print(f"[FAIL] {check.__name__}\n{traceback.format_exc()}", flush=True)
    print(f"{len(checks) - failed} passed, {failed} failed", flush=True)
    sys.stdout.flush()
    os._exit(1 if failed else 0)  # Blender's own exit code would be 0
