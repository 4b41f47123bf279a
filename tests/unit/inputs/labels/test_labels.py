import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from linepose.errors import InputError
from linepose.inputs.labels import read_point_labels
from linepose.inputs.targets.refine import METHODS

SCANS = {1: Path("scans/run-01.hdr"), 3: Path("scans/run-03.bil.hdr")}
PLACES = {(1, 0): (10.0, 20.0), (1, 14): (100.5, 30.25), (3, 7): (0.0, 0.0)}  # u_px, line


def shape(label, x, y, kind="point"):
    return {"label": label, "points": [[x, y]], "shape_type": kind, "group_id": None, "flags": {}}


def labelme(folder, name, shapes, **keys):
    folder.mkdir(exist_ok=True)
    content = {
        "version": "5.4.1",
        "flags": {},
        "shapes": shapes,
        "imagePath": f"..\\png\\{name}.png",
        "imageData": None,
    }
    path = folder / f"{name}.json"
    path.write_text(json.dumps(content | {"imageHeight": 400, "imageWidth": 640} | keys))
    return path


def cvat(path, points, root="annotations", image='name="png/run-01.png" width="640" height="400"'):
    path.write_text(
        f'<?xml version="1.0" encoding="utf-8"?>\n<{root}><version>1.1</version><meta/>'
        f'<image id="0" {image}>{points}</image></{root}>'
    )


def read(folder, pattern):
    return read_point_labels(folder, pattern, SCANS, 640)


def assert_places(labels):
    assert {(o, p): (u, v) for o, p, u, v in labels.itertuples(index=False)} == PLACES
    assert labels["observation"].is_monotonic_increasing


def test_our_csv(tmp_path):
    rows = [f"{o},{p},{u},{v}" for (o, p), (u, v) in PLACES.items()]
    (tmp_path / "labels.csv").write_text("\n".join(["observation,point,u_px,line", *rows]))
    assert_places(read(tmp_path, "labels.csv"))


def test_labelme_counts_from_the_corner_of_the_first_pixel(tmp_path):
    labelme(tmp_path / "l", "run-01", [shape("0", 10.5, 20.5), shape("point 14", 101.0, 30.75)])
    labelme(tmp_path / "l", "run-03", [shape("p07", 0.5, 0.5)])
    assert_places(read(tmp_path, "l/*.json"))


def test_cvat_counts_from_the_corner_of_the_first_pixel(tmp_path):
    points = (
        '<points label="0" points="10.50,20.50"/>'
        '<points label="target" points="101.0,30.75"><attribute name="id">14</attribute></points>'
    )
    cvat(tmp_path / "a.xml", points)
    text = (tmp_path / "a.xml").read_text()
    points = '<points label="p7" points="0.5,0.5" z_order="0"/>'
    second = f'<image id="1" name="run-03.png" width="640" height="9">{points}</image>'
    (tmp_path / "a.xml").write_text(text.replace("</annotations>", f"{second}</annotations>"))
    assert_places(read(tmp_path, "a.xml"))


def test_labelme_group_id_names_the_point(tmp_path, caplog):
    dots = [shape("dot", 10.5, 20.5) | {"group_id": 3}, shape("dot5mm", 50.5, 20.5) | {"group_id": 4}]
    labelme(tmp_path, "run-01", [*dots, shape("board", 0, 0, "rectangle")])
    assert read(tmp_path, "run-01.json").to_numpy().tolist() == [[1, 3, 10, 20], [1, 4, 50, 20]]
    assert "run-01.json: passed over: 1 shapes that are no points" in caplog.text


@pytest.mark.parametrize("label", ["dot", "dot5mm", "dot 7"])
@pytest.mark.parametrize("name", ["id", "ID", "point_id"])
def test_cvat_attribute_of_its_name_alone_is_the_id(tmp_path, label, name):
    attributes = f'<attribute name="quality">2</attribute><attribute name="{name}">7</attribute>'
    cvat(tmp_path / "a.xml", f'<points label="{label}" points="10.50,20.50">{attributes}</points>')
    assert read(tmp_path, "a.xml").to_numpy().tolist() == [[1, 7, 10, 20]]


def test_points_are_named_by_label_or_the_place_that_a_key_says(tmp_path):
    shapes = [shape("gate", 1.5, 1.5), shape("p07", 2.5, 2.5), shape("stone 7", 3.5, 3.5), shape("1e6", 4.5, 4.5)]
    labelme(tmp_path, "run-01", shapes)
    assert read(tmp_path, "*.json")["point"].tolist() == ["1000000", "7", "gate", "stone 7"]
    attributes = '<attribute name="quality">2</attribute><attribute name="Mark">7</attribute>'
    cvat(tmp_path / "a.xml", f'<points label="3" points="10.50,20.50">{attributes}</points>')
    named = [read_point_labels(tmp_path, "a.xml", SCANS, 640, key)["point"].tolist() for key in (None, "mark", "label")]
    assert named == [[3], [7], [3]]
    with pytest.raises(InputError, match=r"label '3', quality '2', mark '7', id '', expected .* by source.point_id"):
        read_point_labels(tmp_path, "a.xml", SCANS, 640, "id")


@pytest.mark.parametrize("skeleton", ["", 'outside="0"'])
def test_cvat_points_outside_the_picture_are_no_labels(tmp_path, caplog, skeleton):
    points = (
        f'<skeleton label="board" source="manual" {skeleton}>'
        '<points label="0" outside="0" occluded="0" points="10.50,20.50"></points>'
        '<points label="1" outside="1" occluded="0" points="99.00,99.00"></points></skeleton>'
        '<skeleton label="board" outside="true"><points label="2" outside="0" points="1,2"></points></skeleton>'
        '<points label="4" outside="1" points="3,4"/><box label="board" xtl="1"/>'
    )
    cvat(tmp_path / "a.xml", points)
    assert read(tmp_path, "a.xml").to_numpy().tolist() == [[1, 0, 10, 20]]
    assert "a.xml: passed over: 3 shapes outside their pictures, 1 shapes that are no points" in caplog.text


@pytest.mark.parametrize("tool", ["csv", "json", "xml"])
def test_a_dot_labelled_at_its_middle_is_found_there(tmp_path, drawn, tool):
    """A picture whose dot is known, labelled at its middle as each tool counts: the refinement agrees to a tenth."""
    picture = drawn([[420.0, 30.0], [20.0, 500.0]], (150.0, 200.0))
    u, line = picture.truth[7]
    if tool == "csv":
        (tmp_path / "a.csv").write_text(f"observation,point,u_px,line\n1,7,{u},{line}\n")
    elif tool == "json":
        labelme(tmp_path, "run-01", [shape("7", u + 0.5, line + 0.5)], imageWidth=300)
    else:
        image = 'name="run-01.png" width="300" height="400"'
        cvat(tmp_path / "a.xml", f'<points label="7" points="{u + 0.5},{line + 0.5}"/>', image=image)
    labels = read_point_labels(tmp_path, {"json": "run-01.json"}.get(tool, f"a.{tool}"), SCANS, 300)
    found = METHODS["centroid"](picture.intensity, *labels[["u_px", "line"]].to_numpy()[0])
    np.testing.assert_allclose(found, labels[["u_px", "line"]].to_numpy()[0], atol=0.1)


@pytest.mark.parametrize(
    ("shapes", "keys", "told"),
    [
        ([shape("", 1, 1)], {}, r"run-01.json, shape 1: found label '', expected a whole number from 0, or a name"),
        ([shape("1.5", 1, 1)], {}, r"found label '1.5', expected a whole number"),
        ([shape("3", 1, 1, "polygon")], {}, r"run-01.json: found no label"),
        ([shape("-3", 1, 1)], {}, r"found label '-3', expected a whole number"),
        (
            [shape("7", 1, 1) | {"group_id": 3}],
            {},
            r"shape 1: found group_id '3' and label '7', expected one name .* source.point_id: group_id",
        ),
        ([shape("dot", 1, 1) | {"group_id": -1}], {}, r"found label 'dot', group_id '-1', expected a whole number"),
        ([shape("dot", 1, 1), shape("dot", 2, 2)], {}, r"found point dot of .* again, .* by source.point_id where"),
        ([shape("3", 1, 1), shape("3", 2, 2)], {}, r"shape 2: found point 3 of .* again, expected each point once"),
        ([shape("3", 1, 1)], {"imageWidth": 320}, r"found a picture 320 pixels wide, expected 640, as camera.n_pixels"),
        (
            [shape("3", 1, 1)],
            {"imagePath": "other.png"},
            r"found picture other.png, expected the name of a scan: run-01, run",
        ),
        ([shape("3", 1, 1) | {"points": []}], {}, r"shape 1: found no label with one place"),
        ([], {}, r"run-01.json: found no label"),
        ({}, {}, r"run-01.json: found JSON of another kind, expected that of one of LabelMe, COCO"),
    ],
)
def test_wrong_labelme_file_is_one_line(tmp_path, shapes, keys, told):
    labelme(tmp_path, "run-01", shapes, **keys)
    with pytest.raises(InputError, match=told) as error:
        read(tmp_path, "*.json")
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("points", "keys", "told"),
    [
        (
            '<points label="3" points="1,2;3,4"/>',
            {},
            r"a.xml, image png/run-01.png, points 1: found 2 places in one shape",
        ),
        ('<points label="3" points="1"/>', {}, r"points 1: found points='1', expected x,y"),
        ('<points label="3" points="nan,1"/>', {}, r"points 1: found place nan, 1.0, expected two numbers"),
        ('<points points="1,2"/>', {}, r"found label '', expected a whole number from 0, or a name"),
        (
            '<points label="3" points="1,2"><attribute name="id">2</attribute></points>',
            {},
            r"found id '2' and label '3', expected one name",
        ),
        ('<box label="3"/>', {}, r"a.xml: found no label"),
        ("", {"root": "opencv"}, r"a.xml: found an element <opencv>, expected CVAT for images 1.1"),
        ("<points", {}, r"a.xml: found .*, expected CVAT's XML"),
    ],
)
def test_wrong_cvat_file_is_one_line(tmp_path, points, keys, told):
    cvat(tmp_path / "a.xml", points, **keys)
    with pytest.raises(InputError, match=told):
        read(tmp_path, "a.xml")


def test_video_of_cvat_is_told(tmp_path):
    (tmp_path / "a.xml").write_text("<annotations><track/></annotations>")
    with pytest.raises(InputError, match=r"found an element <track>, as of a video"):
        read(tmp_path, "a.xml")


def test_other_files_are_told(tmp_path):
    with pytest.raises(InputError, match=r"labels.json: found no such file"):
        read(tmp_path, "labels.json")
    (tmp_path / "labels.json").write_text("{")
    with pytest.raises(InputError, match=r"labels.json: found .*, expected labels in JSON"):
        read(tmp_path, "labels.json")
    Image.new("L", (4, 4)).save(tmp_path / "labels.png")
    with pytest.raises(InputError, match=r"found file type '.png', expected one of .csv, .json, .xml"):
        read(tmp_path, "labels.png")


def test_scans_of_one_name_are_told(tmp_path):
    labelme(tmp_path, "raw_0", [shape("3", 1, 1)])
    scans = {1: Path("a/raw_0.hdr"), 2: Path("b/raw_0.hdr")}
    with pytest.raises(
        InputError, match=r"b/raw_0.hdr: found the name raw_0.hdr again, expected another name than a/raw_0"
    ):
        read_point_labels(tmp_path, "*.json", scans, 640)


def test_rows_of_more_cells_than_the_heading_are_not_shifted(tmp_path):
    """The point would be taken for the observation, and so on."""
    (tmp_path / "labels.csv").write_text("observation,point,u_px,line\n3,1,7,20,30\n3,1,8,21,31\n")
    with pytest.raises(InputError, match=r"labels.csv: found rows of more cells than the heading"):
        read_point_labels(tmp_path, "labels.csv", SCANS, 640)


def test_blanks_beside_commas_and_pictures_with_the_scans_whole_name(tmp_path):
    (tmp_path / "labels.csv").write_text("observation, point, line, u_px\n3, gate, 30, 20\n")
    assert read(tmp_path, "labels.csv").to_numpy().tolist() == [[3, "gate", 20, 30]]
    labelme(tmp_path, "run-01", [shape("0", 10.5, 20.5)], imagePath="run-01.hdr.png")
    assert read(tmp_path, "*.json").to_numpy().tolist() == [[1, 0, 10, 20]]
