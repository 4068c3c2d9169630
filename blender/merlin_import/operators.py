# SPDX-License-Identifier: MIT
"""What a user can do: import photographs, by merlin in the background, and import folders of its results."""

import os
import time
from typing import Any, Optional, Union

import bpy
from bpy.props import BoolProperty, CollectionProperty, EnumProperty, FloatProperty, IntProperty, StringProperty
from bpy_extras.io_utils import ImportHelper

from .command import Command, Missing, Report, find_program
from .exr import Unreadable
from .preferences import preferences
from .result import Result, read_result
from .scene import Wishes, build

TICK = 0.2  # seconds
APART = 1.5  # of several objects in one scene: each is about 1 wide
PHOTOGRAPHS = "*.png;*.jpg;*.jpeg;*.tif;*.tiff;*.webp;*.heic;*.avif;*.gif;*.bmp;*.tga;*.ppm;*.exr;*.hdr"
RAW = "*.dng;*.cr2;*.cr3;*.nef;*.arw;*.orf;*.raf;*.rw2;*.pef"

MODELS = [
    ("AUTO", "Automatic", "$MERLIN_MODEL, else merlin-any, and merlin-point for what it sees lit by a flash alone"),
    ("merlin-any", "merlin-any", "Any light"),
    ("merlin-point", "merlin-point", "The flash alone"),
    ("merlin-env", "merlin-env", "The flash in a room"),
]


class EstimateSettings:
    """Options of merlin estimate, shared by the operators below."""

    model: EnumProperty(name="Model", items=MODELS, description="Weights to take the photograph apart by")
    size: IntProperty(
        name="Size", default=512, min=64, max=512, step=32,
        description="Side of the square that the network sees, a multiple of 32; 256 is quicker than 512",
    )  # fmt: skip
    views: IntProperty(
        name="Views", default=4, min=1, max=8,
        description="The mean over so many orientations of the photograph: better maps, more time",
    )  # fmt: skip
    fov: FloatProperty(
        name="Field of View", default=0, min=0, max=150,
        description="How wide the whole photograph is, in degrees; 0: by its EXIF",
    )  # fmt: skip
    flash: BoolProperty(name="Flash Alone", description="The light was the camera's flash and nothing else")
    mask: StringProperty(
        name="Mask",
        description="A picture that is white on the object, or a folder of them for several photographs. Empty: "
        "NAME_mask.png beside the photograph, else its alpha, else the object is searched for",
    )
    own_scene: BoolProperty(
        name="Scene of Its Own", default=True,
        description="A new scene for each, which renders as the photograph looks; else the objects join this scene",
    )  # fmt: skip

    def settings(self) -> dict[str, Any]:
        names = ("model", "size", "views", "fov", "flash", "mask", "own_scene")
        return {name: getattr(self, name) for name in names}

    def arguments(self) -> list[str]:
        """The options as merlin's own."""
        given = ["--json", f"--size={self.size}", f"--views={self.views}"]
        if self.model != "AUTO":
            given.append(f"--model={self.model}")
        if self.fov > 0:
            given.append(f"--fov={self.fov:g}")
        if self.flash:
            given.append("--flash")
        if self.mask:
            given.append(f"--mask={bpy.path.abspath(self.mask)}")
        return given


class IMPORT_SCENE_OT_merlin_photographs(bpy.types.Operator, ImportHelper, EstimateSettings):
    """Take photographs of objects apart by merlin: each becomes an object with its material, camera and light"""

    bl_idname = "import_scene.merlin_photographs"
    bl_label = "Import Photographs by merlin"

    files: CollectionProperty(type=bpy.types.OperatorFileListElement, options={"HIDDEN", "SKIP_SAVE"})
    directory: StringProperty(subtype="DIR_PATH", options={"HIDDEN", "SKIP_SAVE"})
    filter_glob: StringProperty(default=f"{PHOTOGRAPHS};{RAW}", options={"HIDDEN"})

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return MERLIN_OT_estimate.running is None

    def execute(self, context: bpy.types.Context) -> set[str]:
        chosen = [os.path.join(self.directory, file.name) for file in self.files if file.name] or [self.filepath]
        photographs = [{"name": path} for path in chosen]
        how = "EXEC_DEFAULT" if bpy.app.background else "INVOKE_DEFAULT"
        try:
            return bpy.ops.merlin.estimate(how, photographs=photographs, **self.settings())
        except RuntimeError as error:  # in the background errors that were reported come as exceptions
            self.report({"ERROR"}, str(error).removeprefix("Error: ").strip())
            return {"CANCELLED"}


class MERLIN_OT_estimate(bpy.types.Operator, EstimateSettings):
    """Run merlin estimate on photographs and import what it finds"""

    bl_idname = "merlin.estimate"
    bl_label = "merlin"
    bl_options = {"INTERNAL", "UNDO"}

    photographs: CollectionProperty(type=bpy.types.PropertyGroup)

    running: Optional["MERLIN_OT_estimate"] = None  # one at a time: merlin uses every processor

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Waits for it, in scripts and without windows."""
        if not self.begin(context):
            return {"CANCELLED"}
        while self.command.is_running():
            time.sleep(TICK)
        return self.finish(context)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if not self.begin(context):
            return {"CANCELLED"}
        MERLIN_OT_estimate.running = self
        manager = context.window_manager
        manager.progress_begin(0, 100)
        self.timer = manager.event_timer_add(TICK, window=context.window)
        manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if event.type == "ESC" and event.value == "PRESS":
            self.stop()
        elif event.type == "TIMER":
            if not self.command.is_running():
                self.take_away(context)
                return self.finish(context)
            self.take_reports(context)
            self.show(context)
        return {"PASS_THROUGH"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender closes, or another file is opened."""
        self.command.end()
        self.take_away(context)

    # ---- steps ----

    def begin(self, context: bpy.types.Context) -> bool:
        wanted = preferences(context)
        self.paths = [photograph.name for photograph in self.photographs]
        self.done, self.stopped, self.shown = 0, False, ""
        arguments = ["estimate", *self.arguments(), *output_for(self.paths, wanted.output), "--", *self.paths]
        try:
            self.command = Command(find_program(bpy.path.abspath(wanted.program)), arguments, read_or_say)
        except Missing as error:
            self.report({"ERROR"}, str(error))
            return False
        return True

    def stop(self) -> None:
        self.stopped = True
        self.command.stop()

    def take_reports(self, context: bpy.types.Context) -> None:
        """Imports the photographs that are done."""
        for report, found in self.command.take_reports():
            self.done += bring_in(self, context, found, Wishes(report["input"], self.own_scene, APART * self.done))
            for warning in report["warnings"]:
                self.report({"WARNING"}, f"{report['input']}: {warning['message']}")

    def finish(self, context: bpy.types.Context) -> set[str]:
        self.take_reports(context)
        if self.stopped:
            self.report({"INFO"}, "merlin was stopped")
        else:
            for line in self.command.failure():
                self.report({"ERROR"}, line)
        return {"FINISHED"} if self.done else {"CANCELLED"}

    def words(self) -> str:
        return f"merlin: {'stopping' if self.stopped else self.command.stage}, {100 * self.command.share:.0f} %"

    def show(self, context: bpy.types.Context) -> None:
        if self.words() == self.shown:
            return
        self.shown = self.words()
        context.window_manager.progress_update(int(100 * self.command.share))
        context.workspace.status_text_set(f"{self.shown} (Escape stops it)")
        redraw(context)

    def take_away(self, context: bpy.types.Context) -> None:
        MERLIN_OT_estimate.running = None
        context.window_manager.event_timer_remove(self.timer)
        context.window_manager.progress_end()
        if context.workspace:
            context.workspace.status_text_set(None)
        redraw(context)


def output_for(paths: list[str], folder: str) -> list[str]:
    """The option that puts each photograph's folder inside this one; merlin itself does so of several."""
    if not folder:
        return []
    name = os.path.splitext(os.path.basename(paths[0]))[0] if len(paths) == 1 else ""
    return [f"--output={os.path.join(bpy.path.abspath(folder), name)}"]


def redraw(context: bpy.types.Context) -> None:
    """Draws the sidebars anew, not what they stand beside, which may be slow to draw."""
    for window in context.window_manager.windows:
        for area in (area for area in window.screen.areas if area.type == "VIEW_3D"):
            for region in (region for region in area.regions if region.type == "UI"):
                region.tag_redraw()


class MERLIN_OT_stop(bpy.types.Operator):
    """Stop merlin: nothing of the photograph at work is written"""

    bl_idname = "merlin.stop"
    bl_label = "Stop"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return MERLIN_OT_estimate.running is not None

    def execute(self, context: bpy.types.Context) -> set[str]:
        MERLIN_OT_estimate.running.stop()
        return {"FINISHED"}


def read_or_say(report: Report) -> Union[Result, Unreadable]:
    """Reads what a photograph's report names, which takes seconds of a large one; in a thread nobody catches anything."""
    try:
        return read_result(report["output"])
    except Unreadable as error:
        return error


def bring_in(
    operator: bpy.types.Operator, context: bpy.types.Context, found: Union[Result, Unreadable], wishes: Wishes
) -> bool:
    """Makes objects of what was read; what is wrong with it is reported."""
    try:
        if isinstance(found, Unreadable):
            raise found
        build(context, found, wishes)
    except (Unreadable, RuntimeError) as error:  # the latter: a picture that Blender cannot read
        operator.report({"ERROR"}, str(error).strip())
        return False
    return True


class IMPORT_SCENE_OT_merlin_folder(bpy.types.Operator, ImportHelper):
    """Import a folder that merlin estimate or merlin stereo has written: object, material, camera and light"""

    bl_idname = "import_scene.merlin_folder"
    bl_label = "Import merlin's Results"
    bl_options = {"UNDO"}

    filter_glob: StringProperty(default="maps.exr", options={"HIDDEN"})
    own_scene: EstimateSettings.__annotations__["own_scene"]

    def execute(self, context: bpy.types.Context) -> set[str]:
        folder = self.filepath if os.path.isdir(self.filepath) else os.path.dirname(self.filepath)
        found = read_or_say({"output": os.path.abspath(folder)})
        done = bring_in(self, context, found, Wishes(own_scene=self.own_scene))
        return {"FINISHED"} if done else {"CANCELLED"}


CLASSES = (IMPORT_SCENE_OT_merlin_photographs, IMPORT_SCENE_OT_merlin_folder, MERLIN_OT_estimate, MERLIN_OT_stop)
