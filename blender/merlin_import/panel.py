# SPDX-License-Identifier: MIT
"""Where the operators are found: the sidebar of the 3-D view and the import menu."""

import bpy

from .operators import IMPORT_SCENE_OT_merlin_folder, IMPORT_SCENE_OT_merlin_photographs, MERLIN_OT_estimate, MERLIN_OT_stop

ENTRIES = (
    (IMPORT_SCENE_OT_merlin_photographs, "Photographs by merlin"),
    (IMPORT_SCENE_OT_merlin_folder, "Results of merlin (maps.exr)"),
)


class VIEW3D_PT_merlin(bpy.types.Panel):
    """Imports, and how far merlin is"""

    bl_label = "merlin"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "merlin"

    def draw(self, context: bpy.types.Context) -> None:
        column = self.layout.column()
        for operator, words in ENTRIES:
            column.operator(operator.bl_idname, text=words)
        if MERLIN_OT_estimate.running:
            column.label(text=MERLIN_OT_estimate.running.words())
            column.operator(MERLIN_OT_stop.bl_idname)


def add_to_menu(menu: bpy.types.Menu, context: bpy.types.Context) -> None:
    for operator, words in ENTRIES:
        menu.layout.operator(operator.bl_idname, text=words)


CLASSES = (VIEW3D_PT_merlin,)
