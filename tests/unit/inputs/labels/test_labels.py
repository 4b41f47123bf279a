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
        ([shape("corner", 1, 1)], {}, r"run-01.json, shape 1: found label 'corner', expected one number from 0 to 14"),
        ([shape("15", 1, 1)], {}, r"found label '15', expected one number from 0 to 14"),
        ([shape("1-2", 1, 1)], {}, r"found label '1-2'"),
        ([shape("3", 1, 1, "polygon")], {}, r"shape 1: found a shape of type 'polygon', expected a point"),
        ([shape("3", 1, 1), shape("3", 2, 2)], {}, r"shape 2: found point 3 of .* again, expected each point once"),
        ([shape("3", 1, 1)], {"imageWidth": 320}, r"found a picture 320 pixels wide, expected 640, as camera.n_pixels"),
        (
            [shape("3", 1, 1)],
            {"imagePath": "other.png"},
            r"found picture other.png, expected the name of a scan: run-01, run",
        ),
        ([shape("3", 1, 1) | {"points": []}], {}, r"shape 1: found no label with one place"),
        ([], {}, r"run-01.json: found no label"),
        ({}, {}, r"run-01.json: found JSON without shapes, expected LabelMe's JSON"),
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
        ('<points label="dot" points="1,2"/>', {}, r"found label 'dot', expected one number"),
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
    with pytest.raises(InputError, match=r"labels.json: found .*, expected LabelMe's JSON"):
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
