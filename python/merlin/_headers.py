# SPDX-License-Identifier: MIT
"""The public headers of include/merlin, as ctypes has them: structures, constants and functions.

Nothing here has a meaning of its own. tests/test_headers.py compiles a C program over the headers and compares every
offset, size, constant and function with it, so that a header that changes breaks that test and no user.
"""
from __future__ import annotations

import ctypes
from ctypes import CFUNCTYPE, POINTER, c_char, c_char_p, c_double, c_float, c_int, c_long, c_size_t, c_ssize_t
from ctypes import c_int64, c_uint, c_uint32, c_uint64, c_void_p
from typing import Any, Dict, List, Tuple

floats3 = c_float * 3
floats9x3 = (c_float * 3) * 9

# ---- status.h ----

OK, WRONG_USE, BAD_INPUT, CANNOT_WRITE, NO_MEMORY, DEVICE_FAILED, STOPPED = range(7)
Progress = CFUNCTYPE(None, c_void_p, c_char_p, c_float)
Stop = CFUNCTYPE(c_int)
_WATCH = [("stop", Stop), ("progress", Progress), ("progress_context", c_void_p)]


class Struct(ctypes.Structure):
    """A structure of the library; `c_name` is its name there, without merlin_."""

    c_name = ""


def _struct(c_name: str, fields: List[Tuple[str, Any]]) -> Any:
    return type(c_name, (Struct,), {"c_name": c_name, "_fields_": fields})


# ---- image.h, files.h, warnings.h, camera.h ----

Image = _struct("image", [("width", c_int), ("height", c_int), ("channels", c_int), ("data", c_void_p)])
PIXEL_8, PIXEL_16, PIXEL_FLOAT = range(3)
PixelLayout = _struct("pixel_layout", [
    ("width", c_int), ("height", c_int), ("channels", c_int), ("type", c_int), ("linear", c_int),
    ("stride", c_ssize_t)])
Files = _struct("files", [("at", POINTER(c_char_p)), ("count", c_size_t), ("bytes", c_uint64)])
SkippedFile = _struct("skipped_file", [("name", c_char_p), ("why", c_char_p)])
SkippedFiles = _struct("skipped_files", [("at", POINTER(SkippedFile)), ("count", c_size_t)])
MOST_WARNINGS, WARNING_WORDS = 24, 512
Warned = _struct("warning", [("code", c_char_p), ("message", c_char * WARNING_WORDS)])
Warnings = _struct("warnings", [("count", c_size_t), ("more", c_size_t), ("at", Warned * MOST_WARNINGS)])
Camera = _struct("camera", [("focal", c_float), ("x", c_float), ("y", c_float), ("distance", c_float)])

# ---- maps.h ----

FoundLight = _struct("found_light", [
    ("known", c_int), ("flash", c_float), ("lamp", floats3), ("lamp_sure", c_float), ("lamp_distance", c_float),
    ("lamp_strength", floats3), ("rest", floats9x3)])
MASK_GIVEN, MASK_FOUND = range(2)
Timing = _struct("timing", [
    (name, c_double) for name in ("mask", "prepare", "choose", "compile", "network", "upsample")])
Crop = _struct("maps.crop", [("x", c_int), ("y", c_int), ("side", c_int)])
Mended = _struct("maps.mended", [(name, c_float) for name in ("normal", "albedo", "roughness", "depth")])
MAP_NAMES = ("albedo", "normal", "roughness", "depth", "mask", "photo", "reconstruction", "spread")
Maps = _struct("maps", [(name, Image) for name in MAP_NAMES] + [
    ("crop", Crop), ("size", c_int), ("gain", c_float), ("burnt_out", c_float), ("mask_source", c_int),
    ("has_environment", c_int), ("environment", floats9x3), ("light", FoundLight), ("mask_confidence", c_float),
    ("model", c_char * 64), ("timing", Timing), ("doubts", c_uint), ("light_elsewhere", c_float), ("reduced", c_int),
    ("frames", c_int), ("captured", c_int), ("photographs", c_int), ("refined", c_int),
    ("further_light", floats3), ("fov", c_float), ("slant", c_float * 2), ("mended", Mended),
    ("noticed", POINTER(Warnings))])
DOUBTS = (
    "NO_OBJECT", "BURNT_OUT", "OBJECT_UNSURE", "LIGHT_ELSEWHERE", "NO_FLASH", "LIGHT_BEHIND", "HOLLOW", "DRAWING",
    "LENS_NARROW", "LENS_WIDE", "DARK", "OBJECT_CUT", "OBJECT_SMALL", "GREY", "REDUCED", "FIRST_FRAME",
    "NORMALS_NOT_UNIT", "ALBEDO_CLAMPED", "ROUGHNESS_CLAMPED", "DEPTH_CLAMPED", "NOT_REFINED", "STRENGTHS_UNEQUAL",
    "LIGHTS_FAR")
LIGHT_WORDS = 128
WriteParams = _struct("write_params", [("in_place", c_int), ("last", c_int), *_WATCH])

# ---- estimate.h ----

FLASH_UNKNOWN, FLASH_NONE, FLASH_FIRED = range(3)
Shot = _struct("shot", [("flash", c_int), ("focal_35mm", c_float), ("reduced", c_int), ("frames", c_int)])
MOST_POINTS = 16
Point = _struct("hint.point[0]", [("x", c_int), ("y", c_int)])
Box = _struct("hint.box", [("x", c_int), ("y", c_int), ("width", c_int), ("height", c_int)])
Hint = _struct("hint", [("point_count", c_int), ("point", Point * MOST_POINTS), ("box", Box), ("reduced", c_int)])
LEAST_SIZE, LARGEST_SIZE, SIZE_STEP = 64, 512, 32
Params = _struct("params", [
    ("size", c_int), ("views", c_int), ("auto_exposure", c_int), ("exposure", c_float), *_WATCH, ("shot", Shot),
    ("flash", c_int), ("fov", c_float), ("hint", Hint), ("near_network", c_void_p), ("last", c_int)])
Object = _struct("object", [("mask", Image), ("source", c_int), ("confidence", c_float), ("seconds", c_double)])

# ---- photos.h ----

PhotoFile = _struct("photo_file", [("path", c_char_p), ("mask", c_char_p)])
Photos = _struct("photos", [("at", POINTER(PhotoFile)), ("count", c_size_t), ("skipped", SkippedFiles)])

# ---- pictures.h ----

PNG, JPEG = range(2)
Tile = _struct("tile", [("label", c_char_p), ("picture", POINTER(Image))])

# ---- frames.h ----

FramesHead = _struct("frames_head", [
    ("width", c_int), ("height", c_int), ("video", c_int), ("rate", c_double), ("count", c_long), ("missing", c_long),
    ("first_gap", c_long), ("interlaced", c_int)])
Frame = _struct("frame", [("image", Image), ("mask", Image), ("number", c_long), ("path", c_char_p)])

# ---- lights.h ----

Lamp = _struct("lamp", [("at", floats3), ("distant", c_int), ("power", floats3)])
Lamps = _struct("lamps", [("at", POINTER(Lamp)), ("count", c_size_t), ("warnings", Warnings)])
FoundLights = _struct("found_lights", [("lamps", Lamp * 2), ("count", c_int), ("rest", c_void_p)])

# ---- relight.h ----

BY_BRDF, BY_NETWORK, BY_BRDF_UNSHADOWED, BY_BRDF_DIRECT = range(4)

# ---- sequences.h ----

SMOOTH, MOST_SMOOTH = 8, 100
OBJECT_GIVEN, OBJECT_FOUND, OBJECT_FOLLOWED, OBJECT_LOST = range(4)
SequenceParams = _struct("sequence_params", [("smooth", c_int), ("apart", c_int)])
FrameFacts = _struct("frame_facts", [
    ("number", c_long), ("object", c_int), ("overlap", c_float), ("exposure", floats3), ("shift", c_int * 2),
    ("cut", c_int), ("kept", c_float)])
Differences = _struct("differences", [
    (name, c_double) for name in ("photo", "albedo", "normal", "roughness", "depth", "mask")])
Flicker = _struct("flicker", [("pairs", c_long), ("before", Differences), ("after", Differences)])
SequenceFile = _struct("sequence_file", [("number", c_long), ("folder", c_char_p)])
SequenceFiles = _struct("sequence_files", [
    ("rate", c_double), ("at", POINTER(SequenceFile)), ("count", c_size_t)])

# ---- stereo.h ----

DISTANT_LIGHTS, NEAR_LIGHTS, UNKNOWN_LIGHTS = range(3)
Light = _struct("light", [("direction", floats3), ("position", floats3), ("intensity", floats3), ("lobe", c_float)])
CaptureFiles = _struct("capture_files", [
    ("lights", c_char_p), ("mask", c_char_p), ("ambient", c_char_p), ("near_lights", c_int),
    ("unknown_lights", c_int), ("lights_optional", c_int), ("frames", c_int), ("linear", c_int),
    ("field_of_view", c_float), ("distance", c_float), *_WATCH])
CaptureParams = _struct("capture_params", [
    ("lighting", c_int), ("unknown_intensities", c_int), ("field_of_view", c_float), ("distance", c_float)])
STEREO_AUTO, STEREO_LS, STEREO_ROBUST, STEREO_NEAR, STEREO_SEMI, STEREO_UNCALIBRATED, STEREO_NFPS = range(7)
StereoParams = _struct("stereo_params", [
    ("method", c_int), ("keep_edges", c_int), ("integrate", c_int), ("iterations", c_int), ("unchecked", c_int),
    *_WATCH])
Statistics = _struct("statistics", [("mean", c_double), ("median", c_double), ("count", c_size_t)])
RelitPhoto = _struct("relit_photo", [
    ("lights", c_int), ("subsets", c_int), ("lights_a_subset", c_int), ("model", c_char * 64), ("pixels", c_size_t),
    ("pixels_left", c_size_t), ("spread", c_double), ("angle", c_double)])
StereoSeconds = _struct("surface.seconds", [
    (name, c_double) for name in ("read", "solve", "integrate", "total")])
SURFACE_NAMES = ("normal", "albedo", "depth", "residual", "spread", "mask")
Surface = _struct("surface", [(name, Image) for name in SURFACE_NAMES] + [
    ("camera", Camera), ("method", c_int), ("by_network", c_int), ("lights", POINTER(Light)), ("light_count", c_int),
    ("lights_near", c_int),
    ("strengths_unsure", c_int), ("distance_unsure", c_int), ("lights_unsure", c_int), ("warnings", Warnings),
    ("keep_edges", c_int), ("picture_count", c_int), ("picture_names", POINTER(c_char_p)), ("lights_in_order", c_int),
    ("skipped", SkippedFiles), ("normal_error", Statistics), ("seconds", StereoSeconds), ("relit", RelitPhoto)])

# ---- surface.h ----

SPREAD_LIMIT = 20

# ---- calibrate.h ----

CHROME_BALL, MATTE_BALL = range(2)
CalibrateParams = _struct("calibrate_params", [
    ("ball", c_int), ("mask", c_char_p), ("linear", c_int), ("field_of_view", c_float), *_WATCH])
Circle = _struct("circle", [("x", c_float), ("y", c_float), ("radius", c_float)])
Calibration = _struct("calibration", [
    ("ball", c_int), ("circle", Circle), ("from_mask", c_int), ("mask_file", c_char_p), ("count", c_int),
    ("names", POINTER(c_char_p)), ("lights", POINTER(Light)), ("highlights", POINTER(Circle)),
    ("residuals", POINTER(c_float)), ("warnings", Warnings), ("skipped", SkippedFiles), ("brightest", Image)])

# ---- export.h ----

EXPORT_NAMES = ("ALBEDO", "NORMAL", "ROUGHNESS", "SMOOTHNESS", "OCCLUSION", "ORM", "HEIGHT", "HEIGHT_FLOAT", "ALPHA",
                "MATERIALX")
EXPORT_ALL = (1 << len(EXPORT_NAMES)) - 1
EXPORT_SIDE, EXPORT_LEAST_SIDE, EXPORT_MOST_SIDE = 2048, 64, 8192
ExportParams = _struct("export_params", [("maps", c_uint), ("normal_down", c_int), ("side", c_int)] + _WATCH)
ExportFacts = _struct("export_facts", [("side", c_int), ("relief", c_float), ("width", c_float)])

# ---- rti.h ----

RTI_PTM, RTI_LRGB, RTI_HSH, RTI_RBF = range(4)
RTI_MOST_SIDE, RTI_MOST_PICTURES, RTI_MOST_RBF_PICTURES = 16384, 999, 300
RTI_PLANES, RTI_MOST_PLANES, RTI_QUALITY = 18, 27, 95
RtiParams = _struct("rti_params", [("basis", c_int), ("planes", c_int), ("quality", c_int)])

# ---- mesh.h ----

Mesh = _struct("mesh", [
    ("vertex_count", c_size_t), ("triangle_count", c_size_t), ("positions", POINTER(c_float)),
    ("normals", POINTER(c_float)), ("uvs", POINTER(c_float)), ("colors", POINTER(c_float)),
    ("triangles", POINTER(c_uint32)), ("width", c_int), ("height", c_int), ("pixels", POINTER(c_uint32)),
    ("face_normals", POINTER(c_float)), ("albedo", Image), ("roughness", Image), ("scale", c_double), ("matte", c_int)])
MeshParams = _struct("mesh_params", [("side", c_int), ("texture_side", c_int)])

# ---- view.h ----

VIEW_SIDE, VIEW_LEAST_SIDE, VIEW_MOST_SIDE = 2048, 64, 4096
ViewParams = _struct("view_params", [("name", c_char_p), ("folder", c_char_p), ("side", c_int)])

# ---- weights.h ----

COST_SIDE = 256
Tensor = _struct("tensor", [("name", c_char_p), ("type", c_char_p), ("rank", c_int), ("shape", c_int64 * 4)])
Weights = _struct("weights", [
    ("name", c_char * 64), ("parameters", c_size_t), ("statistics", c_size_t), ("gmac", c_double),
    ("tensor_count", c_size_t), ("tensors", POINTER(Tensor)), ("file", c_void_p)])

# ---- functions ----

_handle = c_void_p  # an opaque structure of the library
_out = POINTER(c_void_p)
_at = POINTER
_light3 = POINTER(c_float)

# Name without merlin_: what it returns, what it takes.
FUNCTIONS: Dict[str, Tuple[Any, List[Any]]] = {
    "error": (c_char_p, []),
    "version": (c_char_p, []),
    "set_threads": (c_int, [c_int]),
    "image_read": (c_int, [c_char_p, _at(Image), _at(Image)]),
    "mask_read": (c_int, [c_char_p, _at(Image)]),
    "image_write": (c_int, [c_char_p, _at(Image)]),
    "image_free": (None, [_at(Image)]),
    "image_from_pixels": (c_int, [c_void_p, _at(PixelLayout), _at(Image), _at(Image)]),
    "mask_from_pixels": (c_int, [c_void_p, _at(PixelLayout), _at(Image)]),
    "image_to_pixels": (c_int, [_at(Image), _at(Image), _at(PixelLayout), c_void_p]),
    "photos_list": (c_int, [c_char_p, c_char_p, _at(Photos)]),
    "photos_free": (None, [_at(Photos)]),
    "mask_find": (c_int, [c_char_p, _at(c_void_p)]),
    "masks_find": (c_int, [c_char_p, _at(c_char_p), c_size_t, _at(c_void_p)]),
    "mask_is_name": (c_int, [c_char_p]),
    "frames_are": (c_int, [c_char_p]),
    "frames_open": (c_int, [c_char_p, c_char_p, _out]),
    "frames_open_pictures": (c_int, [_at(c_char_p), c_size_t, c_char_p, _out]),
    "frames_about": (_at(FramesHead), [_handle]),
    "frames_next": (c_int, [_handle, _at(Frame)]),
    "frame_free": (None, [_at(Frame)]),
    "frames_close": (None, [_handle]),
    "video_create": (c_int, [c_char_p, c_int, c_int, c_double, _out]),
    "video_add": (c_int, [_handle, _at(Image)]),
    "video_finish": (c_int, [_handle, c_int]),
    "image_resize": (c_int, [_at(Image), c_int, c_int, _at(Image)]),
    "image_encode": (c_int, [_at(Image), c_int, _at(c_void_p), _at(c_size_t)]),
    "mask_write": (c_int, [_at(Image), c_char_p]),
    "sheet_write": (c_int, [_at(Tile), c_int, c_int, c_int, c_char_p]),
    "animation_new": (c_int, [c_int, c_int, c_int, _out]),
    "animation_add": (c_int, [_handle, _at(Image)]),
    "animation_write": (c_int, [_handle, c_char_p, c_int]),
    "animation_free": (None, [_handle]),
    "files_free": (None, [_at(Files)]),
    "model_open": (c_int, [c_char_p, _out]),
    "model_add_flash": (c_int, [_handle, c_char_p]),
    "model_add_several": (c_int, [_handle, c_char_p]),
    "model_close": (None, [_handle]),
    "model_name": (c_char_p, [_handle]),
    "model_prepare": (c_int, [_handle, _at(Params)]),
    "weights_read": (c_int, [c_char_p, _at(Weights)]),
    "weights_metadata": (c_char_p, [_at(Weights), c_char_p]),
    "weights_free": (None, [_at(Weights)]),
    "maps_free": (None, [_at(Maps)]),
    "doubt_code": (c_char_p, [c_int]),
    "doubt_message": (c_int, [_at(Maps), c_int, c_char_p, c_int]),
    "light_words": (c_int, [_at(FoundLight), c_char_p, c_int]),
    "lamp_words": (c_int, [_light3, c_char_p, c_int]),
    "maps_warnings": (None, [_at(Maps), _at(Warnings)]),
    "maps_write": (c_int, [_handle, _at(Maps), _at(WriteParams), c_char_p]),
    "maps_report": (c_int, [_at(Maps), POINTER(c_void_p)]),
    "maps_export": (c_int, [_at(Maps), _at(ExportParams), c_char_p, _at(ExportFacts), _at(Files)]),
    "maps_occlusion": (c_int, [_at(Maps), c_int, _at(Image)]),
    "rti_new": (c_int, [c_int, c_int, _at(RtiParams), _out]),
    "rti_add": (c_int, [_handle, _at(Image), _light3]),
    "rti_write": (c_int, [_handle, c_char_p, _at(Files)]),
    "rti_write_ptm": (c_int, [_handle, c_char_p]),
    "rti_free": (None, [_handle]),
    "maps_read": (c_int, [c_char_p, _at(Maps)]),
    "maps_look": (c_int, [c_char_p, POINTER(c_int)]),
    "shot_read": (c_int, [c_char_p, _at(Shot)]),
    "params_default": (Params, []),
    "estimate": (c_int, [_handle, _at(Image), _at(Image), _at(Params), _at(Maps)]),
    "sequence_new": (c_int, [_handle, _at(Params), _at(SequenceParams), _out]),
    "sequence_estimate": (c_int, [_handle, _at(Frame), _at(Maps), _at(FrameFacts)]),
    "sequence_drop_last": (None, [_handle]),
    "sequence_flicker": (None, [_handle, _at(Flicker)]),
    "sequence_warnings": (None, [_handle, _at(FramesHead), _at(Warnings)]),
    "sequence_report": (c_int, [_handle, _at(FramesHead), POINTER(c_void_p)]),
    "sequence_write": (c_int, [_handle, _at(FramesHead), c_char_p]),
    "sequence_free": (None, [_handle]),
    "sequence_folder": (c_int, [c_long, c_char_p, c_int]),
    "sequence_is": (c_int, [c_char_p]),
    "sequence_read": (c_int, [c_char_p, _at(SequenceFiles)]),
    "sequence_files_free": (None, [_at(SequenceFiles)]),
    "object_find": (c_int, [_at(Image), _at(Image), _at(Hint), _at(Object)]),
    "object_free": (None, [_at(Object)]),
    "estimate_object": (c_int, [_handle, _at(Image), _at(Object), _at(Params), _at(Maps)]),
    "relight": (c_int, [_handle, _at(Maps), _light3, c_int, _at(Image)]),
    "relighting_model": (c_char_p, [_handle, _at(Maps), c_int]),
    "relighting_warnings": (None, [_handle, _at(Maps), c_int, _at(Warnings)]),
    "environment_read": (c_int, [c_char_p, c_float, c_float, _out]),
    "environment_free": (None, [_handle]),
    "relight_environment": (c_int, [_handle, _at(Maps), _handle, _light3, c_int, _at(Image)]),
    "relight_found": (c_int, [_handle, _at(Maps), c_float, c_int, _at(Image)]),
    "relighter_new": (c_int, [_handle, _at(Maps), c_int, c_int, _out]),
    "relighter_render": (c_int, [_handle, _light3, _handle, _at(Image)]),
    "relighter_free": (None, [_handle]),
    "lamp_at": (Lamp, [c_float, c_float, c_float]),
    "lamp_toward": (Lamp, [c_float, c_float, c_float]),
    "dome_lamp": (Lamp, [c_int, c_int, c_float]),
    "dome_direction": (None, [c_int, c_int, _light3]),
    "orbit_lamp": (Lamp, [c_int, c_int]),
    "temperature_color": (c_int, [c_double, _light3]),
    "lamps_read": (c_int, [c_char_p, c_float, _at(Lamps)]),
    "lamps_free": (None, [_at(Lamps)]),
    "environment_turn": (None, [_handle, c_float]),
    "environment_negative": (c_double, [_handle]),
    "found_lights_new": (c_int, [_at(FoundLight), c_float, _at(FoundLights)]),
    "found_lights_turn": (None, [_at(FoundLights), c_float]),
    "found_lights_free": (None, [_at(FoundLights)]),
    "maps_field_of_view": (c_double, [_at(Maps)]),
    "maps_lens_place": (None, [_at(Maps), _light3, _light3]),
    "relighter_render_lamps": (c_int, [_handle, _at(Lamp), c_int, _handle, _at(Image)]),
    "relighting_check": (c_int, [c_int, _at(Lamp), c_int]),
    "relighter_make_matte": (c_int, [_handle]),
    "relighter_resize": (c_int, [_handle, _at(Maps), c_int]),
    "relighter_mask": (_at(Image), [_handle]),
    "relighter_place": (c_int, [_handle, _at(Image), _at(Image)]),
    "relighter_white": (c_float, [_handle]),
    "relighter_set_white": (c_int, [_handle, c_float]),
    "relighter_meter": (c_int, [_handle, _at(Lamp), c_size_t, _handle, _light3]),
    "relighter_meter_together": (c_int, [_handle, _at(Lamp), c_size_t, _handle, _light3]),
    "capture_read": (c_int, [c_char_p, _at(CaptureFiles), _out]),
    "capture_read_pictures": (c_int, [POINTER(c_char_p), c_size_t, _at(CaptureFiles), _out]),
    "capture_lighting": (c_int, [_handle]),
    "capture_new": (c_int, [_at(CaptureParams), _at(Image), _out]),
    "capture_add": (c_int, [_handle, _at(Image), _at(Light)]),
    "capture_add_file": (c_int, [_handle, c_char_p, c_int, _at(Light)]),
    "capture_free": (None, [_handle]),
    "stereo": (c_int, [_handle, _at(StereoParams), _at(Surface)]),
    "near_network_open": (c_int, [c_char_p, _out]),
    "near_network_close": (None, [_handle]),
    "stereo_by_network": (c_int, [_handle, _handle, _at(StereoParams), _at(Surface)]),
    "surface_free": (None, [_at(Surface)]),
    "stereo_method_name": (c_char_p, [c_int]),
    "surface_write": (c_int, [_at(Surface), c_char_p, _at(WriteParams), c_char_p]),
    "surface_report": (c_int, [_at(Surface), c_char_p, POINTER(c_void_p)]),
    "maps_from_surface": (c_int, [_at(Surface), _at(Maps)]),
    "maps_from_capture": (c_int, [_handle, _handle, _at(Params), _at(Maps)]),
    "stereo_from_maps": (c_int, [_handle, _at(Maps), _at(StereoParams), _at(Surface)]),
    "mesh_from_maps": (c_int, [_at(Maps), _at(MeshParams), _at(Mesh)]),
    "mesh_from_surface": (c_int, [_at(Surface), _at(Mesh)]),
    "mesh_free": (None, [_at(Mesh)]),
    "mesh_check_name": (c_int, [c_char_p]),
    "mesh_files": (c_int, [_at(Mesh), c_char_p, _at(Files)]),
    "mesh_write": (c_int, [_at(Mesh), c_char_p, _at(Files)]),
    "calibrate": (c_int, [c_char_p, _at(CalibrateParams), _at(Calibration)]),
    "calibration_free": (None, [_at(Calibration)]),
    "calibration_write": (c_int, [_at(Calibration), c_char_p, _at(Files)]),
    "view_write": (c_int, [_at(Maps), _at(ViewParams), c_char_p]),
}
