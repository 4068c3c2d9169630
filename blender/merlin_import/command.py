# SPDX-License-Identifier: MIT
"""The command `merlin estimate` beside Blender: started, watched and ended, while nobody waits for it.

    run = Command(program, arguments, lambda report: read_result(report["output"]))
    while run.is_running():
        ... run.share, run.stage ...
        for report, result in run.take_reports(): ...
    run.failure()

Its standard error is a terminal of its own, since merlin draws its progress on terminals alone.
"""

import json
import os
import re
import shutil
import signal
import subprocess
import threading
import time
from typing import Any, Callable, Optional

PATIENCE = 3.0  # seconds from the request to stop until the process is ended whatever it does
ESCAPES = re.compile(r"\x1b\[[0-9;]*[A-Za-z]")
BAR = re.compile(r"(?P<stage>.*) \[[#.]+\] +(?P<percent>\d+) %")

Report = dict[str, Any]


class Missing(Exception):
    """Says that there is no such program."""


def find_program(wanted: str) -> str:
    """Returns the path of the program merlin: a name is looked for in PATH."""
    path = shutil.which(os.path.expanduser(wanted or "merlin"))
    if path:
        return path
    if os.path.dirname(wanted):
        raise Missing(f"{wanted} is no program: name merlin's in the add-on's preferences")
    raise Missing(f"{wanted or 'merlin'} is not in PATH: install merlin, or name its program in the add-on's preferences")


class Command:
    """One run. Threads read what it says; everything else is for the thread that made it."""

    def __init__(self, program: str, arguments: list[str], prepare: Callable[[Report], Any]) -> None:
        """prepare makes something of each report, in a thread of its own."""
        self.share, self.stage = 0.0, "starting"
        self.messages: list[str] = []
        self.code: Optional[int] = None
        self._prepare = prepare
        self._reports: list[tuple[Report, Any]] = []
        self._done: list[str] = []
        self._asked_to_stop = 0.0
        terminal, theirs = os.openpty()
        try:
            self._process = subprocess.Popen(
                [program, *arguments],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=theirs,
                env={**os.environ, "TERM": "xterm"},
                start_new_session=True,
            )
        except OSError as error:
            os.close(terminal)
            raise Missing(f"{program} cannot be run: {error.strerror}") from error
        finally:
            os.close(theirs)
        readers = [(self._read_reports, self._process.stdout), (self._read_terminal, terminal)]
        self._readers = [threading.Thread(target=read, args=(source,), daemon=True) for read, source in readers]
        for reader in self._readers:
            reader.start()

    # ---- what it says ----

    def _read_reports(self, stream: Any) -> None:
        with stream:
            for line in stream:
                try:
                    report = json.loads(line)
                except ValueError:
                    self.messages.append(line.decode("utf-8", "replace").strip())
                else:
                    self._reports.append((report, self._prepare(report)))

    def _read_terminal(self, terminal: int) -> None:
        left = b""
        while True:
            try:
                said = os.read(terminal, 4096)
            except OSError:  # how a terminal ends whose other side is closed
                said = b""
            *lines, left = (left + said).replace(b"\r", b"\n").split(b"\n")
            for line in lines + ([left] if not said else []):
                self._take_line(line)
            if not said:
                os.close(terminal)
                return
            bar = BAR.match(ESCAPES.sub("", left.decode("utf-8", "replace")))
            if bar:
                self._take_bar(bar)

    def _take_bar(self, bar: "re.Match[str]") -> None:
        self.stage, self.share = bar["stage"].strip(), int(bar["percent"]) / 100

    def _take_line(self, line: bytes) -> None:
        text = ESCAPES.sub("", line.decode("utf-8", "replace")).strip()
        bar = BAR.match(text)
        if bar:
            self._take_bar(bar)
        elif text:
            self.messages.append(text)

    def take_reports(self) -> list[tuple[Report, Any]]:
        """Returns the reports of the photographs that were done since the last call, and what was made of them."""
        count = len(self._reports)
        taken, self._reports[:count] = self._reports[:count], []
        self._done += [report["input"] for report, _ in taken]
        return taken

    # ---- how it goes ----

    def is_running(self) -> bool:
        """Tells whether it still runs; once it does not, all that it said is there, and code is how it ended."""
        if self.code is not None:
            return False
        if self._asked_to_stop and time.monotonic() > self._asked_to_stop + PATIENCE:
            self._signal(signal.SIGKILL)
        if self._process.poll() is None or any(reader.is_alive() for reader in self._readers):
            return True
        self.code = self._process.returncode
        return False

    def _signal(self, number: int) -> None:
        if self._process.poll() is None:
            os.killpg(self._process.pid, number)

    def stop(self) -> None:
        """Asks it to stop, which merlin does without a half-written file; after some patience it is ended."""
        if not self._asked_to_stop:
            self._asked_to_stop = time.monotonic()
            self._signal(signal.SIGINT)

    def end(self) -> None:
        """Stops it and waits for that."""
        self.stop()
        while self.is_running():
            time.sleep(0.02)

    def failure(self) -> list[str]:
        """What to tell of a run that has failed: its own words, without doubts about photographs that went well."""
        if self.code == 0:
            return []
        said = [line for line in self.messages if not any(f" {photograph}: " in line for photograph in self._done)]
        if said:
            return said
        how = f"was ended by signal {-self.code}" if self.code and self.code < 0 else f"exited with {self.code}"
        return [f"merlin {how} without a word"]
