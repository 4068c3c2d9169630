# SPDX-License-Identifier: MIT
"""What docs/python.md prints runs."""
import os
import re
import shutil
import warnings

import merlin


def blocks(path):
    """The page's indented blocks of Python."""
    with open(path, encoding="utf-8") as file:
        found = re.findall(r"(?:^    .*\n|^\n(?=    ))+", file.read(), re.M)
    code = [re.sub(r"^    ", "", block, flags=re.M) for block in found]
    return [block for block in code if not re.match(r"\s*(sudo|python3|env/|pip)", block)]


def test_the_pages_programs_run(source, demo, tmp_path, monkeypatch):
    """In their order, on a small photograph."""
    color, alpha = merlin.read_image(demo)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(merlin.Model.estimate, "__kwdefaults__",
                        {**merlin.Model.estimate.__kwdefaults__, "size": 64, "views": 1})
    shutil.copy(demo, "photo.jpg")
    programs = blocks(os.path.join(source, "docs", "python.md"))
    assert len(programs) == 5 and color.shape[:2] == alpha.shape
    names = {}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for program in programs:
            exec(compile(program, "docs/python.md", "exec"), names)
    assert {"photo.merlin", "relit.png", "viewer.html", "surface.glb"} <= set(os.listdir("."))
    assert len(names["pictures"]) == 5
