# SPDX-License-Identifier: MIT
"""The binding's structures, constants and functions are those of the headers: a compiler is asked."""
import ctypes
import glob
import os
import re
import shutil
import subprocess

import pytest

from merlin import _headers as h

# Structures that a program cannot name are looked into where they lie: the field's path in the structure around them.
OPAQUE = {"model", "environment", "relighter", "capture", "frames", "video", "sequence"}


def headers(source):
    """All public headers' text, without comments."""
    text = ""
    for path in sorted(glob.glob(os.path.join(source, "include", "merlin", "*.h"))):
        with open(path, encoding="utf-8") as file:
            text += file.read()
    return re.sub(r"/\*.*?\*/", "", text, flags=re.S)


def structures():
    """Every structure of the binding."""
    return [s for s in vars(h).values() if isinstance(s, type) and issubclass(s, h.Struct) and s is not h.Struct]


def constants():
    """C's name and the value of every constant of the binding."""
    found = {"MERLIN_" + name: value for name, value in vars(h).items() if name.isupper() and isinstance(value, int)}
    found.update({"MERLIN_DOUBT_" + name: 1 << bit for bit, name in enumerate(h.DOUBTS)})
    found.update({"MERLIN_EXPORT_" + name: 1 << bit for bit, name in enumerate(h.EXPORT_NAMES)})
    return found


def lines_of(structure):
    """C expressions that are the structure's size, and each field's offset and size, with the binding's answers."""
    name, *inner = structure.c_name.split(".", 1)
    around = f"merlin_{name}"
    whole = f"((({around} *)0)->{inner[0]})" if inner else f"(*({around} *)0)"
    start = f"offsetof({around}, {inner[0]})" if inner else "(size_t)0"
    yield f"sizeof{whole}", ctypes.sizeof(structure)
    for field, kind in structure._fields_:
        path = f"{inner[0]}.{field}" if inner else field
        offset = getattr(structure, field).offset
        yield f"offsetof({around}, {path}) - {start}", offset
        yield f"sizeof((({around} *)0)->{path})", ctypes.sizeof(kind)


@pytest.fixture(scope="module")
def c_answers(source, tmp_path_factory):
    """The expressions of lines_of and the constants, by the compiler."""
    compiler = shutil.which("cc") or shutil.which("gcc")
    if not compiler:
        pytest.skip("there is no C compiler")
    expressions = [line for s in structures() for line, _value in lines_of(s)] + list(constants())
    folder = tmp_path_factory.mktemp("headers")
    program = "#include <merlin/merlin.h>\n#include <stddef.h>\n#include <stdio.h>\nint main(void)\n{\n"
    program += "".join(f'    printf("%lld\\n", (long long)({line}));\n' for line in expressions) + "    return 0;\n}\n"
    (folder / "layout.c").write_text(program)
    subprocess.run([compiler, "-I", os.path.join(source, "include"), str(folder / "layout.c"), "-o",
                    str(folder / "layout")], check=True)
    values = subprocess.run([str(folder / "layout")], check=True, capture_output=True, text=True).stdout.split()
    return dict(zip(expressions, map(int, values)))


@pytest.mark.parametrize("structure", structures(), ids=lambda s: s.c_name)
def test_a_structure_lies_in_memory_as_the_compiler_has_it(structure, c_answers):
    """Offsets and sizes."""
    for line, value in lines_of(structure):
        assert c_answers[line] == value, line


def test_constants_are_the_headers(c_answers):
    """Values of enums."""
    for name, value in constants().items():
        assert c_answers[name] == value, name


def test_every_field_of_the_headers_is_bound(source):
    """No field is left out, which offsets alone would not tell of a structure's last."""
    text = headers(source)
    for structure in structures():
        if "." in structure.c_name:
            continue
        body = re.search(r"typedef struct merlin_%s \{(.*?)\n\} merlin_%s;" % ((structure.c_name,) * 2), text, re.S)
        assert body, structure.c_name
        flat = re.sub(r"struct \{[^}]*\}", "int", body.group(1))
        names = []
        for statement in flat.split(";"):
            callback = re.search(r"\(\*(\w+)\)", statement)
            if callback:
                names.append(callback.group(1))
            elif statement.strip():
                kind, rest = re.match(r"\s*((?:const )?(?:struct )?\w+)\s*(.*)", statement, re.S).groups()
                names += [re.match(r"[\s*]*(\w+)", one).group(1) for one in rest.split(",")]
        assert names == [field for field, _kind in structure._fields_], structure.c_name


def test_every_structure_of_the_headers_is_bound(source):
    """All that is not opaque."""
    named = set(re.findall(r"typedef struct merlin_(\w+) \{", headers(source)))
    assert named == {s.c_name for s in structures() if "." not in s.c_name}


def test_every_constant_of_the_headers_is_bound(source):
    """Of every enum."""
    bodies = re.findall(r"enum (?:merlin_\w+ )?\{(.*?)\}", headers(source), re.S)
    named = {name for body in bodies for name in re.findall(r"\bMERLIN_\w+", body)}
    assert named == set(constants())


def declarations(source):
    """Each function's name, what it returns and its parameters, as the headers write them."""
    found = re.findall(r"^([\w ]+?[ *]+)merlin_(\w+)\(([^;{]*)\);", headers(source), re.M)
    return {name: (" ".join(returned.split()), [] if taken.strip() == "void" else [
        " ".join(one.split()) for one in taken.split(",")]) for returned, name, taken in found}


def kind_of(text):
    """What ctypes should have for a C type, roughly: by pointer, number or structure."""
    pointers = text.count("*") + text.count("[")
    if pointers:
        return "pointer"
    if text.startswith("void"):
        return "nothing"
    for word in ("float", "double", "size_t"):
        if re.match(r"(const )?" + word, text):
            return word
    return "structure" if re.match(r"merlin_(params|lamp)\b", text) else "int"


def kind_of_ctype(ctype):
    """The same of the binding."""
    if ctype is None:
        return "nothing"
    if ctype in (ctypes.c_void_p, ctypes.c_char_p) or issubclass(ctype, ctypes._Pointer):
        return "pointer"
    known = {ctypes.c_float: "float", ctypes.c_double: "double", ctypes.c_size_t: "size_t"}
    return known.get(ctype, "structure" if issubclass(ctype, ctypes.Structure) else "int")


def test_every_function_of_the_headers_is_bound(source):
    """And no other."""
    assert set(declarations(source)) == set(h.FUNCTIONS)


@pytest.mark.parametrize("name", sorted(h.FUNCTIONS))
def test_a_function_takes_what_the_headers_say(name, source):
    """How many arguments, and of which kind."""
    returned, taken = declarations(source)[name]
    ours = h.FUNCTIONS[name]
    assert kind_of(returned) == kind_of_ctype(ours[0])
    assert [kind_of(one) for one in taken] == [kind_of_ctype(one) for one in ours[1]]
