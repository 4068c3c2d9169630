# SPDX-License-Identifier: MIT
"""What docs/python.md prints runs."""
import os
import re
import shutil
import warnings

import pytest

import merlin


def blocks(path):
    """The page's indented blocks of Python."""
    with open(path, encoding="utf-8") as file:
        found = re.findall(r"(?:^    .*\n|^\n(?=    ))+", file.read(), re.M)
    code = [re.sub(r"^    ", "", block, flags=re.M) for block in found]
    return [block for block in code if not re.match(r"\s*(sudo|python3|env/|pip)", block)]


@pytest.fixture
def quick_estimates(tmp_path, monkeypatch):
    """In a folder of their own."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(merlin.Model.estimate, "__kwdefaults__",
                        {**merlin.Model.estimate.__kwdefaults__, "size": 64, "views": 1})


def run(program, name, names):
    """Without warnings."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        exec(compile(program, name, "exec"), names)


def test_the_example_makes_its_pictures(source, quick_estimates):
    """Each of the photographs' in its place."""
    path = os.path.join(source, "examples", "photo_to_maps.py")
    with open(path, encoding="utf-8") as file:
        run(file.read(), path, {"__file__": path})
    for name in ("flash.png", "window.png"):
        sheet, _alpha = merlin.read_image(name)
        assert 2.2 > sheet.shape[1] / sheet.shape[0] > 1.5 and sheet.max() > 0.3
    assert os.path.getsize("lamp.webp") > 10_000


def test_the_pages_programs_run(source, demo, quick_estimates):
    """In their order, on a small photograph."""
    color, alpha = merlin.read_image(demo)
    shutil.copy(demo, "photo.jpg")
    programs = blocks(os.path.join(source, "docs", "python.md"))
    assert len(programs) == 5 and color.shape[:2] == alpha.shape
    names = {}
    for program in programs:
        run(program, "docs/python.md", names)
    assert {"photo.merlin", "relit.png", "viewer.html", "surface.glb"} <= set(os.listdir("."))
    assert len(names["pictures"]) == 5
