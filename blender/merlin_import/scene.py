# SPDX-License-Identifier: MIT
"""A result as objects of Blender: everything in merlin's space under one empty, which stands it upright.

    root = build(context, read_result(folder), Wishes())

Object, camera and lamps have merlin's coordinates (x right, y up, z toward the camera) as their own; the empty turns
them so that the camera at its place looks along y, as Blender's front view does.
"""

import math
import os
from dataclasses import dataclass
from typing import Optional

import bpy
import numpy as np
from mathutils import Matrix, Vector

from .result import Camera, Lamp, Result, Unreadable
from .surface import Surface, surface_of

UPRIGHT = (math.pi / 2, 0, 0)
F0 = 0.05  # what merlin's materials reflect of light that meets them head on
F0_OF_SPECULAR_1 = 0.08  # of the Principled BSDF, whose index of refraction stays 1.5
SENSOR = 36.0  # mm, the picture's width
MOST_GUIDE_SIDE = 2048  # of the picture behind the camera's view
SKY = (128, 64)
MOST_SAMPLES = 1 << 16  # pixels, of an object
SAMPLES = 128  # of Cycles a pixel
HALF_ROUNDING = 2.0**-11  # the most that a half differs from what was rounded to it, as a share


@dataclass
class Wishes:
    """How a result is put among what is there."""

    photograph: Optional[str] = None  # the file, where it is known
    own_scene: bool = True  # a new scene that looks as the photograph does, with nothing else in it
    beside: float = 0  # how far to the right of the origin, in a scene that is there


def build(context: bpy.types.Context, found: Result, wishes: Wishes) -> bpy.types.Object:
    """Makes all objects of a result, in a collection of its name, and returns the empty that holds them."""
    _refine_depth(found)
    shape = surface_of(found)
    if not shape.faces:
        raise Unreadable(f"{found.folder} shows no surface: its mask is too thin, or depth jumps everywhere")
    material = _material(found)
    root = bpy.data.objects.new(found.name, None)
    root.rotation_euler = UPRIGHT
    root["merlin_folder"], root["merlin_unit"] = found.folder, found.unit
    thing = bpy.data.objects.new(f"{found.name} object", _mesh(found, shape))
    thing.data.materials.append(material)
    camera = _camera(found, wishes)
    parts = [thing, camera] + [_lamp(found.name, lamp) for lamp in found.lamps]
    collection = bpy.data.collections.new(found.name)
    collection.objects.link(root)
    for part in parts:
        part.parent = root
        collection.objects.link(part)
    if wishes.own_scene:
        _stand_alone(context, found, collection, camera)
    else:
        root.location = (wishes.beside, 0, 0)
        context.scene.collection.children.link(collection)
    if context.mode == "OBJECT":  # somebody may be at work on a mesh meanwhile
        _select(context.view_layer, thing)
    return root


def _select(layer: bpy.types.ViewLayer, thing: bpy.types.Object) -> None:
    for other in layer.objects:
        other.select_set(other == thing, view_layer=layer)
    layer.objects.active = thing


# ---- the object ----


def _refine_depth(found: Result) -> None:
    """Takes depths from depth.png, whose 16 bits part the object's depths finer than halves do: rounded to halves a
    slope is wrong by degrees from pixel to pixel, which lamps aside show as specks. maps.exr says which depths they are."""
    path = os.path.join(found.folder, "depth.png")
    if not found.rounded or not os.path.isfile(path):
        return
    image = bpy.data.images.load(path)
    image.colorspace_settings.name = "Non-Color"
    fine = _pixels(image)[:, :, 0] if image.size[:] == found.depth.shape[::-1] else None
    bpy.data.images.remove(image)
    rows, columns = _some_of(found.mask >= 0.5)
    if fine is None or len(rows) == 0:
        return
    ours, theirs = found.depth[rows, columns].astype(np.float64), fine[rows, columns].astype(np.float64)
    slope, offset = np.polyfit(theirs, ours, 1)
    if np.abs(slope * theirs + offset - ours).max() <= HALF_ROUNDING * ours.max():
        found.depth = np.where(found.mask > 0, slope * fine + offset, found.depth)


def _some_of(where: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Rows and columns of pixels there, spread evenly: at most so many as tell of all."""
    at = np.flatnonzero(where)
    return np.unravel_index(at[:: max(1, len(at) // MOST_SAMPLES)], where.shape)


def _mesh(found: Result, shape: Surface) -> bpy.types.Mesh:
    """Texture coordinates are the photograph's: (0, 0) is its lower left corner."""
    mesh = bpy.data.meshes.new(found.name)
    mesh.from_pydata(shape.points.tolist(), [], shape.faces)
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    vertices = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("vertex_index", vertices)
    uv = shape.pixels / (found.camera.width, found.camera.height)
    uv[:, 1] = 1 - uv[:, 1]
    mesh.uv_layers.new(name="photograph").data.foreach_set("uv", uv[vertices].astype(np.float32).ravel())
    mesh.update()
    return mesh


def _texture(tree: bpy.types.NodeTree, path: str, data: bool, y: float) -> bpy.types.NodeSocket:
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image = bpy.data.images.load(path)
    node.image.name = f"{os.path.basename(os.path.dirname(path))} {os.path.basename(path)}"
    if data:
        node.image.colorspace_settings.name = "Non-Color"
    node.location = (-600, y)
    return node.outputs["Color"]


def _material(found: Result) -> bpy.types.Material:
    """Normals are those of the camera's space, which is the object's own: so they need no tangents, of which Blender
    makes others than glTF's. A surface of `merlin stereo` is matte, as `merlin relight` has it."""
    textures = ["albedo.png", "normal.png"] + (["roughness.png"] if found.glossy else [])
    paths = {name: found.picture(name) for name in textures}
    material = bpy.data.materials.new(found.name)
    material.use_nodes = True
    tree = material.node_tree
    shader = next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")
    shader.distribution = "GGX"
    specular = "Specular" if "Specular" in shader.inputs else "Specular IOR Level"  # its name since Blender 4.0
    shader.inputs[specular].default_value = F0 / F0_OF_SPECULAR_1 if found.glossy else 0
    shader.inputs["Roughness"].default_value = 1
    tree.links.new(_texture(tree, paths["albedo.png"], False, 300), shader.inputs["Base Color"])
    if found.glossy:
        tree.links.new(_texture(tree, paths["roughness.png"], True, 0), shader.inputs["Roughness"])
    normal = tree.nodes.new("ShaderNodeNormalMap")
    normal.space, normal.location = "OBJECT", (-250, -300)
    tree.links.new(_texture(tree, paths["normal.png"], True, -300), normal.inputs["Color"])
    tree.links.new(normal.outputs["Normal"], shader.inputs["Normal"])
    return material


# ---- the camera ----


def _camera(found: Result, wishes: Wishes) -> bpy.types.Object:
    camera = found.camera
    data = bpy.data.cameras.new(f"{found.name} camera")
    data.sensor_fit, data.sensor_width = "HORIZONTAL", SENSOR
    if camera.focal > 0:
        data.lens = camera.focal * SENSOR / camera.width
    else:
        data.type, data.ortho_scale = "ORTHO", camera.width * found.pitch
    data.shift_x = 0.5 - camera.center[0] / camera.width
    data.shift_y = (camera.center[1] - camera.height / 2) / camera.width
    data.clip_start, data.display_size = 0.01, 0.1
    data.show_background_images = True
    behind = data.background_images.new()
    behind.image = _guide(found, wishes.photograph)
    behind.alpha = 0.5
    thing = bpy.data.objects.new(data.name, data)
    thing.matrix_local = Matrix(camera.axes.tolist()).to_4x4()
    return thing


def _pixels(image: bpy.types.Image) -> np.ndarray:
    """Values of an image, height x width x channels, the upper row first."""
    values = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(values)
    return values.reshape(image.size[1], image.size[0], -1)[::-1]


def _encode(linear: np.ndarray) -> np.ndarray:
    """sRGB's curve."""
    x = np.clip(linear, 0, 1)
    return np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)


def _shows_the_same(image: bpy.types.Image, found: Result) -> bool:
    """Tells whether Blender reads the photograph as merlin did, which heeds how the camera was held and whose colours
    they are."""
    if tuple(image.size) != (found.camera.width, found.camera.height) or image.is_float:
        return False
    rows, columns = _some_of(found.mask >= 0.999)
    if len(rows) == 0:
        return False
    theirs, ours = _pixels(image)[rows, columns, :3], _encode(found.photo[rows, columns].astype(np.float32))
    return float(np.abs(theirs - ours).mean()) < 0.01


def _guide(found: Result, photograph: Optional[str]) -> bpy.types.Image:
    """The photograph itself, where Blender reads it; else what maps.exr holds of it, the object; of a capture its albedo."""
    if found.photo is None:
        return bpy.data.images.load(found.picture("albedo.png"))
    if photograph:
        try:
            image = bpy.data.images.load(photograph)
        except RuntimeError:  # a format that Blender does not know, such as a raw picture
            image = None
        if image and _shows_the_same(image, found):
            return image
        if image:
            bpy.data.images.remove(image)
    return _cut_out(found)


def _cut_out(found: Result) -> bpy.types.Image:
    step = -(-max(found.mask.shape) // MOST_GUIDE_SIDE)
    mask = found.mask[::step, ::step, None]
    color = _encode(found.photo[::step, ::step].astype(np.float32) / np.maximum(mask, 1e-3))
    values = np.concatenate([color, mask], axis=2)[::-1].astype(np.float32)
    image = bpy.data.images.new(f"{found.name} photograph", values.shape[1], values.shape[0], alpha=True)
    image.alpha_mode = "STRAIGHT"
    image.pixels.foreach_set(np.ascontiguousarray(values).ravel())
    image.pack()
    return image


# ---- light ----


def _lamp(name: str, lamp: Lamp) -> bpy.types.Object:
    """Blender's watts leave a point light to all sides, 4 pi; a sun's strength is what arrives."""
    data = bpy.data.lights.new(f"{name} {lamp.name}", "SUN" if lamp.distant else "POINT")
    strongest = float(max(lamp.strength.max(), 1e-9))
    data.color = np.maximum(lamp.strength, 0) / strongest
    data.energy = strongest if lamp.distant else 4 * math.pi * strongest
    thing = bpy.data.objects.new(data.name, data)
    if lamp.distant:
        data.angle = 0
        toward = Vector(lamp.at).normalized()
        thing.rotation_euler = toward.to_track_quat("Z", "Y").to_euler()
        thing.location = Vector((0, 0, -1)) + toward
    else:
        data.shadow_soft_size = 0
        thing.location = lamp.at
    return thing


def _basis(d: np.ndarray) -> np.ndarray:
    """Real spherical harmonics, bands 0 to 2, of unit directions, n x 3, in merlin's space."""
    x, y, z = d.T
    first, second = 0.48860251190291992, 1.0925484305920792
    terms = [np.full_like(x, 0.28209479177387814), first * y, first * z, first * x, second * x * y, second * y * z]
    terms += [0.31539156525252005 * (3 * z * z - 1), second * x * z, second / 2 * (x * x - y * y)]
    return np.stack(terms, axis=1)


def sky_of(coefficients: np.ndarray) -> np.ndarray:
    """Radiance all around as Blender's worlds take it, lowest row first; the middle column is toward +x, that left of
    it toward +y. Three bands of a bright sky may fall below zero, which is dark."""
    width, height = SKY
    turn = np.pi - (np.arange(width) + 0.5) * (2 * np.pi / width)
    up = (np.arange(height) + 0.5) * (np.pi / height) - np.pi / 2
    turn, up = np.meshgrid(turn, up)
    x, y, z = np.cos(up) * np.cos(turn), np.cos(up) * np.sin(turn), np.sin(up)
    upright = np.stack([x, z, -y], axis=2).reshape(-1, 3)  # what the empty's turn makes of merlin's axes
    return np.maximum(_basis(upright) @ coefficients, 0).reshape(height, width, 3)


def _world(found: Result) -> bpy.types.World:
    """The surroundings that were found, or darkness."""
    world = bpy.data.worlds.new(found.name)
    world.use_nodes = True
    tree = world.node_tree
    background = next(node for node in tree.nodes if node.type == "BACKGROUND")
    background.inputs["Color"].default_value = (0, 0, 0, 1)
    sky = sky_of(found.surroundings) if found.surroundings is not None else np.zeros(1)
    if not sky.any():
        return world
    image = bpy.data.images.new(f"{found.name} surroundings", *SKY, float_buffer=True)
    opaque = np.concatenate([sky, np.ones(sky.shape[:2] + (1,))], axis=2)
    image.pixels.foreach_set(opaque.astype(np.float32).ravel())
    image.pack()
    node = tree.nodes.new("ShaderNodeTexEnvironment")
    node.image, node.location = image, (-300, 300)
    tree.links.new(node.outputs["Color"], background.inputs["Color"])
    return world


def _has_denoiser() -> bool:
    """Debian's Blender has none, and renders nothing where one is asked for."""
    try:
        from _cycles import with_openimagedenoise
    except ImportError:
        return False
    return bool(with_openimagedenoise)


def _stand_alone(
    context: bpy.types.Context, found: Result, collection: bpy.types.Collection, camera: bpy.types.Object
) -> None:
    """Makes a scene that Cycles renders as the photograph was exposed, and shows it through the camera. Filmic and AgX
    would show other tones; what the surroundings are is too coarse to be seen behind the object."""
    scene = bpy.data.scenes.new(found.name)
    scene.collection.children.link(collection)
    scene.camera, scene.world = camera, _world(found)
    if hasattr(scene, "cycles"):
        scene.render.engine = "CYCLES"
        scene.cycles.samples, scene.cycles.use_denoising = SAMPLES, _has_denoiser()
    scene.render.resolution_x, scene.render.resolution_y = found.camera.width, found.camera.height
    scene.view_settings.view_transform, scene.render.film_transparent = "Standard", True
    context.window.scene = scene
    for area in context.window.screen.areas:
        if area.type == "VIEW_3D":
            area.spaces.active.region_3d.view_perspective = "CAMERA"
