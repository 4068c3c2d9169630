# SPDX-License-Identifier: MIT
"""Imported results: shape, camera, material and light. Arguments: the add-on's zip and a folder of results."""

import importlib
import json
import math
import os
import struct
import sys
import tempfile

import bpy
import numpy as np
from bpy_extras.object_utils import world_to_camera_view

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from harness import ARGUMENTS, PACKAGE, install, picture, pixels, run

archive, results = ARGUMENTS
HALF = 2.0**-11  # the most that a half differs from what was rounded to it, as a share
POWER = 5.95


def folder(name):
    return os.path.join(results, name)


def bring(name, **options):
    """Imports a result and returns its objects by the last word of their names."""
    assert bpy.ops.import_scene.merlin_folder(filepath=os.path.join(folder(name), "maps.exr"), **options) == {"FINISHED"}
    bpy.context.view_layer.update()
    return {each.name.split()[-1]: each for each in bpy.data.collections[name].objects}


def report(name):
    with open(os.path.join(folder(name), "report.json"), encoding="utf-8") as file:
        return json.load(file)


def points(thing):
    values = np.empty(3 * len(thing.data.vertices), np.float32)
    thing.data.vertices.foreach_get("co", values)
    return values.reshape(-1, 3)


def places(thing):
    """Where the photograph shows each vertex, in pixels from its upper left corner, by the texture coordinates."""
    scene = bpy.context.scene
    vertices, uv = np.empty(len(thing.data.loops), np.int32), np.empty(2 * len(thing.data.loops), np.float32)
    thing.data.loops.foreach_get("vertex_index", vertices)
    thing.data.uv_layers[0].data.foreach_get("uv", uv)
    out = np.empty((len(thing.data.vertices), 2))
    out[vertices] = uv.reshape(-1, 2)
    out[:, 1] = 1 - out[:, 1]
    return out * (scene.render.resolution_x, scene.render.resolution_y)


def ply_points(path):
    """The vertices of a binary PLY of merlin's."""
    with open(path, "rb") as file:
        data = file.read()
    head, body = data.split(b"end_header\n", 1)
    lines = head.decode().split("\n")
    count = next(int(line.split()[2]) for line in lines if line.startswith("element vertex"))
    sizes = {"float": 4, "uchar": 1}
    element = [line.split()[1:] for line in lines if line.startswith("property") and "list" not in line]
    stride = sum(sizes[kind] for kind, _ in element)
    assert [name for _, name in element[:3]] == ["x", "y", "z"]
    rows = np.frombuffer(body, np.uint8, count * stride).reshape(count, stride)
    return np.ascontiguousarray(rows[:, :12]).view("<f4")


# ---- shape and camera ----


def check_overlay(name):
    thing, camera = (lambda parts: (parts["object"], parts["camera"]))(bring(name))
    scene = bpy.context.scene
    mask = picture(os.path.join(folder(name), "mask.png"), data=True)[:, :, 0]
    size = (scene.render.resolution_x, scene.render.resolution_y)
    assert size == mask.shape[::-1] and scene.camera == camera
    wanted, worst = places(thing), 0.0
    for vertex in range(0, len(thing.data.vertices), 97):
        seen = world_to_camera_view(scene, camera, thing.matrix_world @ thing.data.vertices[vertex].co)
        assert seen.z > 0
        at = np.array([seen.x * size[0], (1 - seen.y) * size[1]])
        worst = max(worst, float(np.abs(at - wanted[vertex]).max()))
        assert mask[int(at[1]), int(at[0])] >= 0.5
    assert worst < 0.01, f"{worst} pixels beside the photograph"
    covered = np.zeros(mask.shape, bool)
    columns, rows = wanted.astype(int).T
    covered[rows, columns] = True
    assert covered[mask > 0.5].mean() > 0.98, f"only {covered[mask > 0.5].mean()} of the object has vertices"
    normals = np.empty(3 * len(thing.data.polygons), np.float32)
    thing.data.polygons.foreach_get("normal", normals)
    middles = np.empty(3 * len(thing.data.polygons), np.float32)
    thing.data.polygons.foreach_get("center", middles)
    facing = (normals.reshape(-1, 3) * -middles.reshape(-1, 3)).sum(1)
    far = camera.data.type == "ORTHO"
    assert ((normals.reshape(-1, 3)[:, 2] if far else facing) > 0).all(), "faces turn away from the camera"


def vertices_are_seen_where_the_photograph_shows_them():
    check_overlay("demo")


def so_they_are_beside_the_axis_of_a_known_lens():
    check_overlay("slanted")
    camera = bpy.context.scene.camera.data
    assert abs(math.degrees(camera.angle_x) - 70) < 0.05, math.degrees(camera.angle_x)
    assert abs(camera.shift_x) < 2 / 640 and abs(camera.shift_y) < 2 / 640, "the axis is in the photograph's middle"


def so_they_are_where_the_lens_is_not_known():
    check_overlay("shifted")
    assert abs(bpy.context.scene.camera.data.shift_x) > 0.1, "the camera is taken to look at the object"


def so_they_are_in_a_surface_of_stereo_from_afar():
    check_overlay("far")
    assert bpy.context.scene.camera.data.type == "ORTHO"


def so_they_are_in_a_surface_of_stereo_in_perspective():
    check_overlay("near")
    assert bpy.context.scene.camera.data.type == "PERSP"


def the_shape_is_that_of_merlins_own_mesh():
    for name in ("demo", "slanted", "shifted"):
        ours, theirs = points(bring(name)["object"]).astype(float), ply_points(folder(f"{name}.ply")).astype(float)
        # the same pixels in the same order, but for those without a face
        order_of = lambda p: np.lexsort(np.round(p[:, :2] / -p[:, 2:], 5).T)
        spare = len(theirs) - len(ours)
        assert 0 <= spare < 0.02 * len(theirs), f"{len(ours)} vertices, merlin has {len(theirs)}"
        rays = {tuple(r): z for r, z in zip(np.round(theirs[:, :2] / -theirs[:, 2:], 5).tolist(), theirs[:, 2])}
        keys = np.round(ours[:, :2] / -ours[:, 2:], 5).tolist()
        both = np.array([(z, rays[tuple(k)]) for k, z in zip(keys, ours[:, 2]) if tuple(k) in rays])
        assert len(both) > 0.9 * len(ours), f"{name}: {len(both)} of {len(ours)} vertices lie on merlin's rays"
        error = np.abs(both[:, 0] - both[:, 1]).max()
        assert error < HALF * np.abs(theirs[:, 2]).max(), f"{name}: depth differs by {error}"


def depth_is_finer_than_halves():
    thing = bring("demo")["object"]
    depth = np.sort(np.unique(points(thing)[:, 2]))
    assert len(depth) > 20000, f"{len(depth)} different depths"


def an_empty_file_gets_a_scene_of_its_own_and_the_other_stays():
    before = bpy.context.scene
    bring("demo")
    scene = bpy.context.scene
    assert scene != before and not before.objects and before.world is None
    assert scene.view_settings.view_transform == "Standard" and scene.render.engine == "CYCLES"
    assert bpy.context.view_layer.objects.active.name == "demo object"


def objects_can_join_the_scene_that_is_there():
    before = bpy.context.scene
    bring("demo", own_scene=False)
    assert bpy.context.scene == before and before.camera is None and "demo object" in before.objects


# ---- material ----


def linked(socket):
    (link,) = socket.links
    return link.from_node


def the_material_has_albedo_normals_roughness_and_merlins_gloss():
    (material,) = bring("demo")["object"].data.materials
    shader = next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    specular = shader.inputs.get("Specular") or shader.inputs["Specular IOR Level"]
    assert abs(specular.default_value * 0.08 - 0.05) < 1e-6 and shader.inputs["Metallic"].default_value == 0
    normal = linked(shader.inputs["Normal"])
    assert normal.space == "OBJECT"
    textures = {
        "albedo.png": (linked(shader.inputs["Base Color"]), "sRGB"),
        "roughness.png": (linked(shader.inputs["Roughness"]), "Non-Color"),
        "normal.png": (linked(normal.inputs["Color"]), "Non-Color"),
    }
    for name, (node, space) in textures.items():
        assert os.path.samefile(bpy.path.abspath(node.image.filepath), os.path.join(folder("demo"), name))
        assert node.image.colorspace_settings.name == space, name


def a_surface_of_stereo_is_matte():
    (material,) = bring("far")["object"].data.materials
    shader = next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    specular = shader.inputs.get("Specular") or shader.inputs["Specular IOR Level"]
    assert specular.default_value == 0 and not shader.inputs["Roughness"].links


# ---- light ----


def a_flash_alone_is_a_lamp_at_the_camera():
    parts = bring("demo")
    assert report("demo")["model"] == "merlin-point" and set(parts) == {"demo", "object", "camera", "flash"}
    flash = parts["flash"]
    assert flash.data.type == "POINT" and flash.matrix_world.translation.length < 1e-6
    assert flash.data.shadow_soft_size == 0
    assert abs(flash.data.energy - 4 * math.pi * POWER / report("demo")["exposure_gain"]) < 1e-3
    background = next(n for n in bpy.context.scene.world.node_tree.nodes if n.type == "BACKGROUND")
    assert not background.inputs["Color"].links and tuple(background.inputs["Color"].default_value)[:3] == (0, 0, 0)


def upright(p):
    """Blender's axes: z is up, and the camera looks along y."""
    return np.array([p[0], -p[2], p[1]])


def the_found_lamp_stands_where_the_report_says():
    parts, told = bring("window"), report("window")
    light, white = told["light"], told["exposure_gain"]
    distance = light["lamp_distance"]
    place = upright(np.array(light["lamp"]) * distance - (0, 0, 1))
    assert distance > 0 and np.abs(np.array(parts["lamp"].matrix_world.translation) - place).max() < 1e-4
    data = parts["lamp"].data
    strength = np.array(data.color) * data.energy / (4 * math.pi)
    assert np.allclose(strength, np.array(light["lamp_strength"]) * distance**2 * POWER / white, rtol=1e-3)
    flash = parts["flash"].data
    assert abs(flash.energy - 4 * math.pi * light["flash"] * POWER / white) < 1e-3 * flash.energy


def sh_radiance(coefficients, d):
    """As docs/conventions.md orders them."""
    x, y, z = d
    basis = [0.282095, 0.488603 * y, 0.488603 * z, 0.488603 * x, 1.092548 * x * y, 1.092548 * y * z]
    basis += [0.315392 * (3 * z * z - 1), 1.092548 * x * z, 0.546274 * (x * x - y * y)]
    return np.maximum(np.array(basis) @ coefficients, 0)


def the_world_shines_as_the_surroundings_do():
    """Six small pictures, along the axes and aside, of nothing but the world."""
    scene = (bring("window"), bpy.context.scene)[1]
    told = report("window")
    rest = np.reshape(told["light"]["rest"], (9, 3)) / told["exposure_gain"]
    bpy.data.objects["window"].hide_render = bpy.data.objects["window object"].hide_render = True
    camera = bpy.data.objects.new("narrow", bpy.data.cameras.new("narrow"))
    camera.data.angle = 0.01
    scene.collection.objects.link(camera)
    scene.camera = camera
    scene.render.resolution_x = scene.render.resolution_y = 4
    scene.cycles.samples, scene.render.film_transparent = 4, False
    image_settings = scene.render.image_settings
    image_settings.file_format, image_settings.color_depth = "OPEN_EXR", "32"
    scene.render.filepath = os.path.join(tempfile.gettempdir(), f"merlin-sky-{os.getpid()}.exr")
    directions = [(1, 0, 0), (-1, 0, 0), (0, 1, 0.3), (0, 0, 1), (0, 0, -1), (0.6, 0.64, -0.48), (-0.6, 0.48, 0.64)]
    from mathutils import Vector

    for d in directions:
        d = np.array(d) / np.linalg.norm(d)
        camera.rotation_euler = Vector(-upright(d)).to_track_quat("Z", "Y").to_euler()
        bpy.ops.render.render(write_still=True)
        seen = picture(scene.render.filepath).reshape(-1, 4).mean(0)[:3]
        wanted = sh_radiance(rest, d)
        assert np.allclose(seen, wanted, atol=0.02 * wanted.max() + 1e-4), f"toward {d}: {seen}, not {wanted}"
    os.remove(scene.render.filepath)


def a_room_that_a_model_knows_is_there():
    assert "environment" in report("room")
    parts = bring("room")
    assert "flash" in parts and bpy.context.scene.world.node_tree.nodes["Environment Texture"].image


def a_surface_of_stereo_has_a_sun_that_makes_white_white():
    parts = bring("far")
    sun = parts["sun"]
    assert sun.data.type == "SUN" and abs(sun.data.energy - math.pi) < 1e-5
    toward = sun.matrix_world.to_3x3() @ __import__("mathutils").Vector((0, 0, 1))
    assert np.allclose(toward, upright(np.array([-1, 1, 1.5])) / math.sqrt(4.25), atol=1e-5)


def what_was_made_is_in_the_file():
    bring("window")
    path = os.path.join(tempfile.mkdtemp(), "saved.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    before = {i.name: pixels(i).copy() for i in bpy.data.images if i.packed_file}
    bpy.ops.wm.open_mainfile(filepath=path)
    assert len(before) == 2, list(before)
    for name, values in before.items():
        assert np.abs(pixels(bpy.data.images[name]) - values).max() < 0.01, name


# ---- what is wrong ----


def refusal(path):
    try:
        bpy.ops.import_scene.merlin_folder(filepath=path)
    except RuntimeError as error:
        return str(error)
    raise AssertionError(f"{path} was imported")


def a_folder_of_something_else_is_refused():
    empty = tempfile.mkdtemp()
    assert f"no maps.exr in {empty}: choose a folder" in refusal(empty)


def copied(name):
    to = tempfile.mkdtemp()
    for file in ("maps.exr", "albedo.png", "normal.png", "roughness.png", "depth.png"):
        with open(os.path.join(folder(name), file), "rb") as source, open(os.path.join(to, file), "wb") as target:
            target.write(source.read())
    return to


def a_map_that_is_missing_is_named():
    broken = copied("demo")
    os.remove(os.path.join(broken, "albedo.png"))
    assert f"{broken} has no albedo.png" in refusal(broken)


def depths_that_somebody_has_edited_are_taken_from_maps_exr():
    edited = copied("demo")
    with open(os.path.join(folder("slanted"), "depth.png"), "rb") as other:
        data = other.read()
    with open(os.path.join(edited, "depth.png"), "wb") as file:
        file.write(data)
    bpy.ops.import_scene.merlin_folder(filepath=edited)
    assert len(np.unique(points(bpy.context.view_layer.objects.active)[:, 2])) < 5000


def damaged_files_are_refused_in_one_line():
    """Cut short anywhere, and with bytes changed in the head."""
    exr = importlib.import_module(f"{PACKAGE}.exr")
    result = importlib.import_module(f"{PACKAGE}.result")
    with open(os.path.join(folder("slanted"), "maps.exr"), "rb") as file:
        whole = file.read()
    broken = tempfile.mkdtemp()
    path, refused, random = os.path.join(broken, "maps.exr"), 0, np.random.default_rng(1)

    def attempt(data):
        with open(path, "wb") as file:
            file.write(data)
        try:
            result.read_result(broken)
            return 0
        except exr.Unreadable as error:
            assert broken in str(error) and "\n" not in str(error), error
            return 1

    cuts = sorted(set(random.integers(0, len(whole) - 1, 60).tolist()) | set(range(0, 1200, 13)))
    assert sum(attempt(whole[:cut]) for cut in cuts) == len(cuts)
    for _ in range(300):
        changed = bytearray(whole)
        for at in random.integers(0, 1500, 3):
            changed[at] = random.integers(0, 256)
        refused += attempt(bytes(changed))
    assert refused > 100, refused
    assert attempt(whole) == 0


install(archive)
run([
    vertices_are_seen_where_the_photograph_shows_them,
    so_they_are_beside_the_axis_of_a_known_lens,
    so_they_are_where_the_lens_is_not_known,
    so_they_are_in_a_surface_of_stereo_from_afar,
    so_they_are_in_a_surface_of_stereo_in_perspective,
    the_shape_is_that_of_merlins_own_mesh,
    depth_is_finer_than_halves,
    an_empty_file_gets_a_scene_of_its_own_and_the_other_stays,
    objects_can_join_the_scene_that_is_there,
    the_material_has_albedo_normals_roughness_and_merlins_gloss,
    a_surface_of_stereo_is_matte,
    a_flash_alone_is_a_lamp_at_the_camera,
    the_found_lamp_stands_where_the_report_says,
    the_world_shines_as_the_surroundings_do,
    a_room_that_a_model_knows_is_there,
    a_surface_of_stereo_has_a_sun_that_makes_white_white,
    what_was_made_is_in_the_file,
    a_folder_of_something_else_is_refused,
    a_map_that_is_missing_is_named,
    depths_that_somebody_has_edited_are_taken_from_maps_exr,
    damaged_files_are_refused_in_one_line,
])  # fmt: skip
