# SPDX-License-Identifier: MIT
"""In a window: Blender goes on while merlin works and shows how far it is; Escape, the button and Blender's own end stop
it. Arguments: the add-on's zip, a folder to write to, and a picture. Programs that draw merlin's bar and never end by
themselves stand for merlin; the last one's number is left in the file process, for who sees Blender end."""

import importlib
import os
import sys
import time

import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from harness import ARGUMENTS, PACKAGE, install, preferences

archive, place, photograph = ARGUMENTS
POLITE, STUBBORN = f'echo interrupted >"{place}/interrupted"; exit 1', ""
STUB = """#!/bin/sh
trap '%s' INT
echo $$ >"%s/process"
i=0
while :; do
    i=$((i + 1))
    printf '\\restimating [######......] %%3d %%%%  0:09 left\\033[K' $i >&2
    sleep 0.1
done
"""
DEADLINE = 180  # seconds, most of them for drawing


def name_program(on_interrupt):
    """A new name each time: a script that runs cannot be written."""
    path = os.path.join(place, f"stub{len(os.listdir(place))}")
    with open(path, "w", encoding="utf-8") as file:
        file.write(STUB % (on_interrupt, place))
    os.chmod(path, 0o755)
    preferences().program = path


def process():
    with open(os.path.join(place, "process"), encoding="utf-8") as file:
        return int(file.read())


class Story:
    """What happens: a generator that goes on at every tick of a timer of Blender's."""

    def __init__(self):
        self.operator = importlib.import_module(f"{PACKAGE}.operators").MERLIN_OT_estimate
        self.began, self.spent = time.monotonic(), []
        self.steps = self.tell()
        self.time_the_operator()

    def time_the_operator(self):
        """Notes how long Blender waits for it at each event; drawing, which is slow here, is not its own."""
        modal, spent = self.operator.modal, self.spent

        def timed(operator, context, event):
            began = time.monotonic()
            try:
                return modal(operator, context, event)
            finally:
                spent.append(time.monotonic() - began)

        self.operator.modal = timed

    def tick(self):
        try:
            assert time.monotonic() - self.began < DEADLINE, "it hangs"
            next(self.steps)
            return 0.05
        except StopIteration:
            return None
        except Exception as error:
            print(f"[FAIL] {type(error).__name__}: {error}", flush=True)
            os._exit(1)

    def start(self):
        with bpy.context.temp_override(window=bpy.context.window_manager.windows[0]):
            assert bpy.ops.import_scene.merlin_photographs(filepath=photograph) == {"RUNNING_MODAL"}
            assert not bpy.ops.import_scene.merlin_photographs.poll(), "a second one could be started"

    def watched(self):
        """Waits for three more shares."""
        shares = set()
        while len(shares) < 3:
            assert self.operator.running, "it ended by itself"
            shares.add(self.operator.running.command.share)
            yield
        assert self.operator.running.command.stage == "estimating"
        assert "merlin: estimating, " in self.operator.running.words()

    def ended(self):
        """Waits for the process's end, and sees that another can be started."""
        number = process()
        while self.operator.running:
            yield
        assert not os.path.exists(f"/proc/{number}"), "the process is still there"
        assert bpy.ops.import_scene.merlin_photographs.poll()

    def tell(self):
        name_program(POLITE)
        self.start()
        yield from self.watched()
        window = bpy.context.window_manager.windows[0]
        window.event_simulate(type="ESC", value="PRESS", x=window.width // 2, y=window.height // 2)
        yield from self.ended()
        assert os.path.exists(os.path.join(place, "interrupted")), "it was not asked to stop"
        print("[ OK ] Escape stops it", flush=True)
        name_program(STUBBORN)
        self.start()
        yield from self.watched()
        with bpy.context.temp_override(window=window):
            assert bpy.ops.merlin.stop() == {"FINISHED"}
        yield from self.ended()
        print("[ OK ] the button ends one that does not heed it", flush=True)
        name_program(POLITE)
        self.start()
        yield from self.watched()
        assert max(self.spent) < 0.2, f"Blender waited {self.spent}"
        print(f"[ OK ] Blender waits {1000 * max(self.spent):.1f} ms for it at most", flush=True)
        print("3 passed, 0 failed", flush=True)
        bpy.ops.wm.quit_blender()


install(archive)
bpy.context.preferences.view.show_splash = False
bpy.app.timers.register(Story().tick, first_interval=1)
