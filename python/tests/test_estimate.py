# SPDX-License-Identifier: MIT
"""Photographs become maps; maps are lit, changed, written and read."""
import os
import pathlib
import warnings

import numpy as np
import pytest

import merlin


def test_maps_are_arrays_of_the_photographs_size(kept_maps, photo):
    """Values as documented."""
    m = kept_maps
    height, width = photo[0].shape[:2]
    assert m.albedo.shape == m.normal.shape == m.photo.shape == m.reconstruction.shape == (height, width, 3)
    assert m.roughness.shape == m.depth.shape == m.mask.shape == (height, width)
    inside = m.mask == 1
    np.testing.assert_allclose(np.linalg.norm(m.normal[inside], axis=-1), 1, atol=1e-3)
    assert (m.normal[inside][:, 2] > 0).all() and m.roughness[inside].min() >= 0.03 - 1e-6
    assert (m.albedo[m.mask == 0] == 0).all() and 0 <= m.albedo.min() and m.albedo.max() <= 1
    assert m.depth[inside].min() > 0.2 and m.depth.dtype == np.float32
    assert (m.height, m.width) == (height, width) and m.crop.side > 0 and m.size == 64
    assert m.mask_source == "given" and m.mask_confidence == 1 and m.model_name == "merlin-any"
    assert m.fov is None and m.gain > 0 and 0 <= m.burnt_out <= 1 and m.mended == (0, 0, 0, 0)
    assert m.light is not None and m.light.rest.shape == (9, 3) and m.environment is None
    assert set(m.timing) >= {"network"} and "128 x 128" in repr(m)


def test_a_file_and_its_array_have_the_same_maps(quick, demo):
    """To the last bit, whatever names the file."""
    color, alpha = merlin.read_image(demo)
    ours = quick(color[::2, ::2], alpha[::2, ::2])
    theirs = quick(merlin.to_pixels(color[::2, ::2], np.float32, linear=True), alpha[::2, ::2] >= 0.5)
    np.testing.assert_array_equal(ours.mask >= 0.5, theirs.mask >= 0.5)
    by_path, by_name = quick(pathlib.Path(demo)), quick(os.fsencode(demo))
    np.testing.assert_array_equal(by_path.normal, by_name.normal)
    np.testing.assert_array_equal(by_path.normal, quick(color, alpha).normal)


def test_an_object_is_found_and_can_be_given(quick, photo):
    """By its alpha, by points, by a mask."""
    color, mask = photo
    found = merlin.find_object(color, points=[(64, 64)])
    assert found.source == "found" and 0 <= found.confidence <= 1 and found.mask.shape == mask.shape
    maps = quick(color, found)
    assert maps.mask_source == "found" and maps.mask_confidence == pytest.approx(found.confidence)
    given = merlin.find_object(np.dstack([color, mask.astype(np.uint8) * 255]))
    assert given.source == "given" and ((given.mask > 0.5) == mask).all()
    with pytest.raises(merlin.WrongUseError):
        merlin.find_object(color, mask, points=[(64, 64)])
    with pytest.raises(ValueError, match="at most 16 points"):
        merlin.find_object(color, points=[(1, 1)] * 17)
    with pytest.raises(TypeError, match="whole number"):
        merlin.find_object(color, points=[(0.5, 1)])


def test_doubts_are_warnings_and_attributes(model, photo):
    """What the library doubts is told."""
    color, mask = photo
    grey = np.repeat(color.mean(axis=2, keepdims=True), 3, axis=2).astype(np.uint8)
    with pytest.warns(merlin.MerlinWarning, match=r"\(grey\)") as told:
        maps = model.estimate(grey, mask, size=64, views=1)
    assert "grey" in [doubt.code for doubt in maps.doubts]
    assert told[0].filename == __file__


def test_progress_is_told(quick, photo):
    """Shares go from 0 to 1."""
    told = []
    quick(*photo, progress=lambda stage, share: told.append((stage, share)))
    assert {stage for stage, _share in told} == {"estimating", "refining"}
    assert all(0 <= share <= 1 for _stage, share in told)


def test_the_lens_and_the_exposure_can_be_told(quick, photo):
    """By their names."""
    maps, brighter = quick(*photo, fov=40, exposure=0.5), quick(*photo, exposure=1.5)
    assert maps.fov == pytest.approx(40, rel=0.05) and brighter.gain == pytest.approx(2 * maps.gain, rel=1e-4)


def test_maps_are_relit(kept_maps):
    """By lamps, by what was found, by surroundings; each way."""
    right = kept_maps.relight((0.7, 0.3, -0.4))
    assert right.shape == kept_maps.albedo.shape and 0 <= right.min() and right.max() <= 1
    left = kept_maps.relight(np.array([-0.7, 0.3, -0.4]))
    assert np.abs(left - right).mean() > 0.005
    direct = kept_maps.relight((0.7, 0.3, -0.4), by="direct")
    unshadowed = kept_maps.relight((0.7, 0.3, -0.4), by="unshadowed")
    assert unshadowed.sum() >= direct.sum() > 0
    assert kept_maps.relight("found", turn=30).mean() > 0
    for wrong in ({"light": "sun"}, {}, {"light": (0, 0)}, {"light": (0, 0, 0), "by": "magic"},
                  {"light": (0, 0, 0), "turn": 3}, {"light": (0, 0, np.nan)}, {"light": (0, 0, 0), "by": "network"}):
        with pytest.raises(ValueError):
            kept_maps.relight(**wrong)


def write_hdr(path):
    """A Radiance picture, bright to the right."""
    rows = bytearray()
    for _y in range(16):
        for x in range(32):
            rows += bytes((128, 128, 128, 132 if 20 <= x < 24 else 126))
    path.write_bytes(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 16 +X 32\n" + bytes(rows))


def test_maps_are_relit_by_surroundings(kept_maps, tmp_path):
    """By a path or an Environment, with a lamp or without."""
    write_hdr(tmp_path / "room.hdr")
    alone = kept_maps.relight(environment=tmp_path / "room.hdr", by="direct")
    turned = kept_maps.relight(environment=merlin.Environment(tmp_path / "room.hdr", turn=180), by="direct")
    lamp = kept_maps.relight((0, 0, 0), environment=tmp_path / "room.hdr", by="direct")
    assert alone.mean() > 0 and np.abs(alone - turned).max() > 0.01 and lamp.sum() > alone.sum()
    with pytest.raises(merlin.MissingFileError):
        kept_maps.relight(environment=tmp_path / "none.hdr")


def test_a_relighter_is_as_relight(kept_maps):
    """Of the crop."""
    with kept_maps.relighter(64) as relighter:
        picture = relighter((0.5, 0, -0.5))
        assert picture.shape == (64, 64, 3) and picture.max() > 0.05
        np.testing.assert_array_equal(picture, relighter.render((0.5, 0, -0.5)))
        with pytest.raises(merlin.WrongUseError):
            relighter.render()
    with pytest.raises(ValueError, match="closed"):
        relighter((0, 0, 0))
    with pytest.raises(merlin.WrongUseError, match="8000"):
        kept_maps.relighter(9000)


def test_lamps_are_colourful_and_several(kept_maps):
    """Each adds its light."""
    red = merlin.Lamp((0.5, 0, -0.5), power=(1, 0, 0))
    far = merlin.Lamp((-1, 0, 1), distant=True, power=0.5)
    with kept_maps.relighter(64, by="direct") as relighter:
        relighter.white = 4 * relighter.white
        one, other, both = (relighter(light) for light in (red, far, [red, far]))
        np.testing.assert_allclose(both, one + other, atol=2e-3)
        assert one[:, :, 1:].max() == 0 < one.max() and relighter.mask.shape == (64, 64)
        assert relighter.meter([red]) > 0
        before = relighter((0, 0, 0))
        relighter.make_matte()
        assert relighter((0, 0, 0)).sum() < before.sum()
    assert kept_maps.relight([red, (0, 0, 0)], by="direct").shape == kept_maps.albedo.shape
    for wrong in ([], (1, 2), merlin.Lamp((0, np.nan, 0)), merlin.Lamp((0, 0, 0), power=(1, 2)), [[1, 2, 3], "x"]):
        with pytest.raises(ValueError):
            kept_maps.relight(wrong)


def test_domes_and_orbits_have_lamps(tmp_path):
    """And lists of lights."""
    lamps, directions = merlin.dome(20), merlin.dome_directions(20)
    assert len(lamps) == 20 and lamps[0].distant and not merlin.dome(3, near=1.5)[0].distant
    np.testing.assert_allclose(np.linalg.norm(directions, axis=1), 1, atol=1e-5)
    assert merlin.orbit(8)[0].at[0] > 0.5
    assert merlin.temperature_color(2000)[0] == 1 > merlin.temperature_color(2000)[2]
    (tmp_path / "lights.lp").write_text("1\na.png 0 0 1\n")
    assert len(merlin.read_lamps(tmp_path / "lights.lp")) == 1
    for wrong in (lambda: merlin.dome(0), lambda: merlin.orbit(-1), lambda: merlin.temperature_color(10),
                  lambda: merlin.dome(2**40), lambda: merlin.read_lamps(tmp_path / "none")):
        with pytest.raises(ValueError):
            wrong()


def test_pictures_of_a_dome_become_an_rti(kept_maps, tmp_path):
    """A folder or a file."""
    relighter = kept_maps.relighter(64, by="direct")
    pictures = [relighter(lamp) for lamp in merlin.dome(12)]
    written = merlin.write_rti(tmp_path / "cup", pictures, merlin.dome_directions(12), basis="hsh")
    assert "info.json" in [os.path.basename(path) for path in written]
    assert merlin.write_rti(tmp_path / "cup.ptm", pictures, merlin.dome_directions(12)) == [str(tmp_path / "cup.ptm")]
    assert (tmp_path / "cup.ptm").read_bytes().startswith(b"PTM_1.2")
    for wrong in (([], np.zeros((0, 3))), (pictures, np.eye(3)), (pictures[:2], merlin.dome_directions(2)),
                  (pictures[:11] + [pictures[0][1:]], merlin.dome_directions(12))):
        with pytest.raises(merlin.WrongUseError):
            merlin.write_rti(tmp_path / "wrong", *wrong)
    assert not (tmp_path / "wrong").exists()


def test_the_found_light_can_be_taken(kept_maps):
    """And put back, as "found" does it."""
    lamps, around = kept_maps.found_lights()
    back = kept_maps.relight(lamps or None, environment=around, by="direct")
    np.testing.assert_allclose(back, kept_maps.relight("found", by="direct"), atol=0.02)
    if around is not None:
        around.turn(90)
        assert around.negative == 0
    assert 1 < kept_maps.field_of_view < 150
    np.testing.assert_allclose(kept_maps.lens_place((0, 0, 0)), 0, atol=1e-6)


def test_changed_maps_are_relit_as_changed(maps):
    """Through the views; values that are not numbers are refused."""
    before = maps.relight((0, 0, 0), by="direct")
    maps.albedo *= 0.5
    after = maps.relight((0, 0, 0), by="direct")
    assert after.sum() < 0.8 * before.sum()
    maps.roughness = 0.9
    assert (maps.roughness == np.float32(0.9)).all()
    with pytest.raises(ValueError):
        maps.albedo = np.zeros((3, 3))
    maps.normal[5, 5] = np.nan
    for use in (lambda: maps.relight((0, 0, 0)), lambda: maps.relighter(64), lambda: maps.view("never.html")):
        with pytest.raises(merlin.WrongUseError, match="normal.*not finite"):
            use()


def test_maps_are_saved_and_loaded(kept_maps, tmp_path):
    """As the command writes them."""
    kept_maps.save(tmp_path / "maps")
    assert {"maps.exr", "albedo.png", "report.json", "overview.png"} <= {p.name for p in (tmp_path / "maps").iterdir()}
    loaded = merlin.Maps.load(tmp_path / "maps")
    np.testing.assert_allclose(loaded.albedo, kept_maps.albedo, atol=2e-3)
    assert loaded.reconstruction is None and loaded.crop == kept_maps.crop and loaded.model_name == "merlin-any"
    relit = loaded.relight((0.7, 0.3, -0.4))
    np.testing.assert_allclose(relit, kept_maps.relight((0.7, 0.3, -0.4)), atol=0.02)
    loaded.albedo *= 0.5
    loaded.save(tmp_path / "again")  # with a reconstruction of its own
    again = merlin.Maps.load(tmp_path / "again")
    np.testing.assert_allclose(again.albedo, 0.5 * kept_maps.albedo, atol=2e-3)
    assert (tmp_path / "again" / "reconstruction.png").exists()
    with pytest.raises(merlin.MissingFileError):
        merlin.Maps.load(tmp_path / "nowhere")
    with pytest.raises(merlin.CannotWriteError):
        kept_maps.save("/proc/merlin")


def test_a_reconstruction_is_made_again(kept_maps, tmp_path):
    """Of loaded maps, nearly as it was."""
    kept_maps.save(tmp_path / "maps")
    merlin.Maps.load(tmp_path / "maps").save(tmp_path / "again")
    one, other = (merlin.read_image(tmp_path / name / "reconstruction.png")[0] for name in ("maps", "again"))
    assert np.abs(one - other)[kept_maps.mask > 0.5].mean() < 0.05 < one[kept_maps.mask > 0.5].mean()


def test_maps_that_could_not_be_loaded_are_not_saved(maps, tmp_path):
    """With the words of load."""
    for name, wrong, words in (("albedo", 255, "albedo.R goes"), ("depth", -1, "depth.Z goes"),
                               ("normal", 0, "no length"), ("mask", 0, "selects nothing")):
        kept = getattr(maps, name).copy()
        setattr(maps, name, kept * wrong)
        with pytest.raises(merlin.BadInputError, match="these maps: .*" + words):
            maps.save(tmp_path / "maps")
        setattr(maps, name, kept)
    assert not (tmp_path / "maps").exists()
    with pytest.raises(merlin.WrongUseError, match="takes no such values"):
        maps.albedo = "white"


def test_other_weights_than_the_maps_get_a_word(kept_maps):
    """Where they work."""
    point = merlin.Model("merlin-point")
    with pytest.warns(merlin.MerlinWarning, match="bounces of their light of merlin-point .other_model"):
        kept_maps.relight((0, 0, 0), model=point)
    with pytest.warns(merlin.MerlinWarning, match="other_model"):
        kept_maps.relighter(64, model=point)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        kept_maps.relight((0, 0, 0), by="direct", model=point)
        kept_maps.relight((0, 0, 0))


def test_maps_become_a_mesh(kept_maps, tmp_path):
    """Of arrays, which are written as they are changed."""
    mesh = kept_maps.mesh(side=64)
    count, faces = len(mesh.vertices), len(mesh.faces)
    assert mesh.vertices.shape == mesh.normals.shape == mesh.colors.shape == (count, 3) and mesh.uvs.shape == (count, 2)
    assert mesh.faces.shape == (faces, 3) and mesh.faces.dtype == np.uint32 and mesh.faces.max() < count
    a, b, c = (mesh.vertices[mesh.faces[:, i]] for i in range(3))
    assert (np.cross(b - a, c - a) * -a).sum(axis=1).min() > -1e-6  # they face the camera
    np.testing.assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1, atol=1e-3)
    assert np.abs(mesh.vertices.mean(axis=0) - [0, 0, -1]).max() < 0.3
    mesh.colors[...] = 0.25
    written = mesh.save(tmp_path / "a.obj")
    assert {path.rsplit(".", 1)[1] for path in written} == {"obj", "mtl", "png"}
    mesh.faces[0, 0] = count
    with pytest.raises(merlin.WrongUseError, match=f"names vertex {count}"):
        mesh.save(tmp_path / "b.ply")
    vertices = mesh.vertices
    del mesh
    assert vertices.shape == (count, 3) and np.isfinite(vertices).all()
    with pytest.raises(merlin.WrongUseError):
        kept_maps.mesh(side=-5)


def test_maps_are_exported(kept_maps, tmp_path):
    """By their names."""
    done = kept_maps.export(tmp_path / "usual")
    assert {"albedo.png", "normal.png", "export.json"} <= {path.rsplit("/", 1)[1] for path in done.files}
    assert done.side > 0 and done.relief > 0 and done.width > 0
    done = kept_maps.export(tmp_path / "named", ["ao", "height32"], side=64)
    assert {"ao.png", "height.exr"} <= {path.rsplit("/", 1)[1] for path in done.files}
    done = kept_maps.export(tmp_path / "all", "all", normal_y="down", side=64)
    assert not (tmp_path / "all" / "material.mtlx").exists()
    done = kept_maps.export(tmp_path / "unreal", ["orm", "normal"], normal_y="down", side=64)
    assert done.side == 64 and (tmp_path / "unreal" / "orm.png").exists()
    shade = kept_maps.occlusion(64)
    assert shade.shape == (64, 64) and 0 <= shade.min() < 1 == shade.max()
    for wrong in ({"maps": ["gloss"]}, {"normal_y": "left"}, {"side": 7}, {"maps": "materialx", "normal_y": "down"}):
        with pytest.raises(ValueError):
            kept_maps.export(tmp_path / "wrong", **wrong)
    assert not (tmp_path / "wrong").exists()


def test_maps_report_what_was_done(kept_maps, tmp_path):
    """As report.json does, and with words for the light."""
    report = kept_maps.report()
    assert report["model"] == "merlin-any" and report["width"] == kept_maps.width
    assert [one["code"] for one in report["warnings"]] == [one.code for one in kept_maps.doubts]
    assert kept_maps.light_words == report["light"]["words"] != ""
    told = []
    kept_maps.save(tmp_path / "maps", progress=lambda stage, share: told.append(stage))
    assert "writing" in told
    with pytest.raises(merlin.StoppedError):
        kept_maps.save(tmp_path / "stopped", stop=lambda: True)
    assert not (tmp_path / "stopped").exists()


def test_a_page_is_written(kept_maps, tmp_path):
    """One file."""
    kept_maps.view(tmp_path / "viewer.html", name="cup", side=64)
    text = (tmp_path / "viewer.html").read_text(encoding="utf-8")
    assert "<html" in text and "cup" in text
    with pytest.raises(merlin.WrongUseError):
        kept_maps.view(tmp_path / "viewer.html", side=7)
    with pytest.raises(merlin.WrongUseError, match="ends in .html"):
        kept_maps.view(tmp_path / "photo.png")


def test_save_replaces_nobodys_pictures(kept_maps, tmp_path):
    """As the command does: an albedo.png without maps.exr beside it is no earlier result."""
    own = tmp_path / "own"
    own.mkdir()
    (own / "albedo.png").write_bytes(b"mine")
    with pytest.raises(merlin.CannotWriteError, match="albedo.png is no earlier result"):
        kept_maps.save(own)
    assert (own / "albedo.png").read_bytes() == b"mine" and len(list(own.iterdir())) == 1
    for _ in range(2):
        kept_maps.save(tmp_path / "saved")


def test_nothing_stands_for_unknown_but_none(model, demo):
    """The library's own zeros are refused, as the command refuses them."""
    with pytest.raises(merlin.WrongUseError, match="fov"):
        model.estimate(demo, size=64, views=1, fov=0)
    with pytest.raises(merlin.WrongUseError, match="box"):
        merlin.find_object(demo, box=(0, 0, 0, 0))


def test_normals_of_any_length_are_directions(maps):
    """Those longer than one are not cut off component by component."""
    light = (0.7, 0.3, -0.4)
    whole = maps.relight(light, by="direct")
    maps.normal[...] *= 2
    doubled = maps.relight(light, by="direct")
    assert abs(doubled - whole).max() < 2e-3


def test_a_model_is_opened_by_name_and_closed(demo):
    """Maps outlive it."""
    with merlin.Model("merlin-point") as model:
        assert model.name == "merlin-point" and "merlin-point" in repr(model)
        model.prepare(size=64, views=1)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            maps = model.estimate(demo, size=64, views=1, last=True)
        network = maps.relight((0.3, 0, -0.5), by="network")
        relighter = maps.relighter(64)
    assert network.mean() > 0 and relighter((0, 0, 0)).mean() > 0
    with pytest.raises(ValueError, match="closed"):
        model.estimate(demo)
    with pytest.raises(ValueError, match="closed"):
        maps.relight((0, 0, 0))
    assert maps.albedo.mean() > 0 and "closed" in repr(model)


def test_the_default_model_is_the_commands(monkeypatch, demo):
    """merlin-any, with merlin-point for flashes; or $MERLIN_MODEL."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        assert merlin.estimate(demo, size=64, views=1, flash=True).model_name == "merlin-point"
        monkeypatch.setenv("MERLIN_MODEL", "merlin-env")
        maps = merlin.Model().estimate(demo, size=64, views=1)
    assert maps.model_name == "merlin-env" and maps.environment.shape == (9, 3)
    monkeypatch.setenv("MERLIN_MODEL", "merlin-none")
    with pytest.raises(merlin.MissingFileError, match="MERLIN_MODEL: there is no weights file merlin-none"):
        merlin.Model()


def test_how_a_photograph_was_taken_is_read(demo):
    """By its file, which tells nothing here."""
    assert merlin.read_shot(demo) == (None, 0, 1, 1)


def test_weights_tell_what_they_are(source):
    """As merlin info does."""
    weights = merlin.Weights("merlin-any")
    assert weights.name == "merlin-any" and weights.config["name"] == "merlin-any" and weights.gmac > 1
    held = sum(int(np.prod(one.shape)) for one in weights.tensors)
    assert weights.parameters <= held <= weights.parameters + weights.statistics + 1000
    assert weights.metadata("nothing of the kind") is None and weights.metadata("samples")
    with pytest.raises(merlin.BadInputError):
        merlin.Weights(source + "/README.md")
