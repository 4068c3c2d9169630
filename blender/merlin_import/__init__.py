# SPDX-License-Identifier: MIT
"""merlin in Blender: photographs of objects, and merlin's results, as objects with material, camera and light."""

bl_info = {  # until Blender 4.1; from 4.2 on blender_manifest.toml says the same
    "name": "merlin",
    "description": "Photographs of objects to meshes with material, camera and light",
    "author": "the authors of merlin",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "File > Import, and the 3-D view's sidebar",
    "category": "Import-Export",
}

import bpy

try:
    import numpy  # noqa: F401
except ModuleNotFoundError as error:  # which Debian's Blender does not bring along
    raise ModuleNotFoundError("merlin's add-on needs numpy for Python: apt-get install python3-numpy") from error

from . import operators, panel, preferences

CLASSES = preferences.CLASSES + operators.CLASSES + panel.CLASSES


def register() -> None:
    for each in CLASSES:
        bpy.utils.register_class(each)
    bpy.types.TOPBAR_MT_file_import.append(panel.add_to_menu)


def unregister() -> None:
    bpy.types.TOPBAR_MT_file_import.remove(panel.add_to_menu)
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)
