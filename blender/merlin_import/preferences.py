# SPDX-License-Identifier: MIT
"""Settings of the add-on that stay."""

import bpy
from bpy.props import StringProperty


class MerlinPreferences(bpy.types.AddonPreferences):
    """Where the program is and where its results go."""

    bl_idname = __package__

    program: StringProperty(
        name="Program", subtype="FILE_PATH", default="merlin", description="merlin's program; a name is looked for in PATH"
    )
    output: StringProperty(
        name="Results", subtype="DIR_PATH",
        description="Folder for merlin's results; empty: beside each photograph, in its name + .merlin",
    )  # fmt: skip

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.prop(self, "program")
        self.layout.prop(self, "output")


def preferences(context: bpy.types.Context) -> MerlinPreferences:
    return context.preferences.addons[__package__].preferences


CLASSES = (MerlinPreferences,)
