"""Files as COCO, Label Studio and VIA have them, made up: two scans, points 0 and gate, and what is passed over."""

import csv
import io
import json
from copy import deepcopy
from pathlib import Path

import pytest
from PIL import Image

from linepose.errors import InputError
from linepose.inputs.labels import read_point_labels
from linepose.inputs.labels.format import entries

SCANS = {1: Path("scans/run-01.hdr"), 3: Path("scans/run-03.bil.hdr")}
COCO = {
    "images": [
        {"id": 11, "file_name": "png/run-01.png", "width": 640, "height": 400},
        {"id": 12, "file_name": "run-03.png", "width": 640, "height": 400},
    ],
    "categories": [{"id": 1, "name": "board", "keypoints": ["0", "gate"], "skeleton": []}],
    "annotations": [
        {"id": 1, "image_id": 11, "category_id": 1, "keypoints": [10.5, 20.5, 2, 0, 0, 0], "bbox": [0, 0, 9, 9]},
        {"id": 2, "image_id": 12, "category_id": 1, "keypoints": [1.5, 2.5, 1, 100.5, 30.5, 2]},
        {"id": 3, "image_id": 12, "category_id": 1, "bbox": [0, 0, 9, 9]},
    ],
}


def region(name, x, y, kind="keypointlabels", **keys):
    value = {"x": 100 * x / 640, "y": 100 * y / 400, "width": 0.5, kind: [name]}
    size = {"original_width": 640, "original_height": 400, "image_rotation": 0}
    return {"id": f"r{x}", "from_name": "kp", "to_name": "image", "type": kind, "value": value, **size, **keys}


STUDIO = [
    {
        "id": 7,
        "data": {"image": "/data/upload/1/0badcafe-run-01.png"},
        "annotations": [
            {"result": [region("0", 10.5, 20.5), region("board", 1, 1, "rectanglelabels")]},
            {"result": [region("0", 50, 60)], "was_cancelled": True},
        ],
    },
    {
        "id": 8,
        "data": {"image": "/data/local-files/?d=png%2Frun-03.png"},
        "annotations": [
            {
                "result": [
                    region("0", 1.5, 2.5),
                    region("dot", 100.5, 30.5),
                    region("dot", 100.5, 30.5) | {"from_name": "mark", "type": "textarea", "value": {"text": ["gate"]}},
                ]
            }
        ],
    },
]


def point(x, y, kind="point", **attributes):
    return {"shape_attributes": {"name": kind, "cx": x, "cy": y}, "region_attributes": attributes}


VIA = {
    "_via_settings": {},
    "_via_img_metadata": {
        "run-01.png123": {"filename": "run-01.png", "size": 123, "regions": [point(10.5, 20.5, id="0", quality="7")]},
        "run-03.png9": {
            "filename": "run-03.png",
            "size": 9,
            "regions": {
                "0": point(1.5, 2.5, id={"0": True, "1": False}),
                "1": point(100.5, 30.5, id="gate"),
                "2": point(0, 0, "rect"),
            },
        },
    },
}


def read(folder, content, point_id=None):
    (folder / "labels.json").write_text(json.dumps(content))
    return read_point_labels(folder, "labels.json", SCANS, 640, point_id)


@pytest.mark.parametrize(
    ("content", "told"),
    [
        (COCO, "1 keypoints of visibility 0, 1 annotations without keypoints"),
        (VIA, "1 regions that are no points"),
        (VIA["_via_img_metadata"], "1 regions that are no points"),
    ],
)
def test_points_by_name_and_what_is_passed_over(tmp_path, content, told, caplog):
    labels = read(tmp_path, content)
    assert labels.to_numpy().tolist() == [[1, "0", 10, 20], [3, "0", 1, 2], [3, "gate", 100, 30]]
    assert f"labels.json: passed over: {told}" in caplog.text


def via_csv(mark="", shape=None):
    """The same as VIA's CSV has it, with another shape in the first row."""
    rows = [
        [picture["filename"], picture["size"], "{}", len(regions), k, *(json.dumps(one) for one in region.values())]
        for picture in VIA["_via_img_metadata"].values()
        for regions in [list(entries(picture["regions"]))]
        for k, region in enumerate(regions)
    ]
    rows[0][5] = rows[0][5] if shape is None else shape
    heading = "filename,file_size,file_attributes,region_count,region_id,region_shape_attributes,region_attributes"
    text = io.StringIO()
    csv.writer(text).writerows([*rows, ["run-02.png", 5, "{}", 0, 0, "{}", "{}"]])
    return f"{mark}{heading}\r\n{text.getvalue()}"


@pytest.mark.parametrize("mark", ["", "#", "\ufeff", "\r\n# of Monday, by hand\r\n\r\n"])
def test_vias_csv_is_read_as_its_json(tmp_path, mark, caplog):
    (tmp_path / "via.csv").write_text(via_csv(mark), encoding="utf-8")
    labels = read_point_labels(tmp_path, "via.csv", SCANS, 640)
    assert labels.to_numpy().tolist() == [[1, "0", 10, 20], [3, "0", 1, 2], [3, "gate", 100, 30]]
    assert "via.csv: passed over: 1 regions that are no points" in caplog.text


VIA_3_CSV = """# Exported using VGG Image Annotator (http://www.robots.ox.ac.uk/~vgg/software/via)
# SHAPE_ID = {"POINT":1,"RECTANGLE":2}
# CSV_HEADER = metadata_id,file_list,flags,temporal_coordinates,spatial_coordinates,metadata
"1_a","[""run-01.png""]",0,"[]","[1,10.5,20.5]","{""1"":""0""}"
"""


def test_a_project_of_via_3_is_told(tmp_path):
    content = {"project": {"pid": "a"}, "config": {}, "attribute": {}, "file": {}, "metadata": {}, "view": {}}
    with pytest.raises(InputError, match=r"labels.json: found annotations of VIA 3, expected those of VIA 2"):
        read(tmp_path, content)


def test_our_own_csv_beside_vias_is_told_with_both_layouts(tmp_path):
    (tmp_path / "a.csv").write_text(via_csv())
    (tmp_path / "b.csv").write_text("observation,point,u_px,line\n1,0,10,20\n")
    found = (
        r"b.csv: found a CSV of our own \(observation,point,u_px,line\) beside one of a tool, .*of one of them alone"
    )
    with pytest.raises(InputError, match=found):
        read_point_labels(tmp_path, "*.csv", SCANS, 640)
    (tmp_path / "b.csv").write_text("a,b\n1,0\n")
    with pytest.raises(InputError, match=r"b.csv: found CSV of another kind, expected that of one of VIA 2;"):
        read_point_labels(tmp_path, "*.csv", SCANS, 640)


def test_a_pattern_of_our_own_csv_is_of_one_file(tmp_path):
    (tmp_path / "a.csv").write_text("observation,point,u_px,line\n1,0,10,20\n")
    assert read_point_labels(tmp_path, "*.csv", SCANS, 640).to_numpy().tolist() == [[1, 0, 10, 20]]
    (tmp_path / "b.csv").write_text("observation,point,u_px,line\n3,0,10,20\n")
    with pytest.raises(InputError, match=r"found 2 files, as a.csv and b.csv, expected one CSV of labels \(obs"):
        read_point_labels(tmp_path, "*.csv", SCANS, 640)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (via_csv(shape="{"), r"row 2, region_shape_attributes: found '\{', expected a mapping"),
        (via_csv(shape='{"name": "point"}'), r"run-01.png, region 1: found cx=None, expected cx and cy in pixels"),
        (via_csv() + "run-03.png,1,2\r\n", r"via.csv, row 7: found 3 cells, expected 7"),
        (via_csv("\r\n# a\r\n") + "run-03.png,1\r\n", r"via.csv, row 9: found 2 cells, expected 7"),
        (VIA_3_CSV, r"via.csv: found annotations of VIA 3, expected those of VIA 2; draw the points in VIA 2, or"),
    ],
)
def test_vias_csv_that_cannot_be_used_is_one_line(tmp_path, text, told):
    (tmp_path / "via.csv").write_text(text)
    with pytest.raises(InputError, match=told) as error:
        read_point_labels(tmp_path, "via.csv", SCANS, 640)
    assert "\n" not in str(error.value)


def test_label_studio_in_per_cent_with_names_in_labels_or_a_control(tmp_path, caplog):
    labels = read(tmp_path, STUDIO)
    assert labels["point"].tolist() == ["0", "0", "dot"]
    assert labels[["u_px", "line"]].to_numpy().ravel() == pytest.approx([10, 20, 1, 2, 100, 30])
    assert "passed over: 1 regions that are no keypoints, 1 cancelled annotations" in caplog.text
    studio = deepcopy(STUDIO)
    studio[1]["annotations"][0]["result"].pop(0)
    studio[0]["annotations"][0]["result"][0]["value"]["text"] = "post"
    studio[0]["annotations"][0]["result"][0]["from_name"] = "mark"
    assert read(tmp_path, studio, "mark")["point"].tolist() == ["post", "gate"]


def test_label_studios_short_form(tmp_path):
    short = {"keypointlabels": ["7"], "x": 50.0, "y": 25.0, "width": 0.5, "original_width": 640, "original_height": 400}
    labels = read(tmp_path, [{"id": 1, "image": "/data/upload/1/0badcafe-run-01.png", "kp": [short], "annotator": 1}])
    assert labels.to_numpy().tolist() == [[1, 7, 319.5, 99.5]]


@pytest.mark.parametrize(
    ("content", "keys", "value", "told"),
    [
        (
            COCO,
            ["annotations", 0, "keypoints"],
            [1, 2],
            r"annotation 1: found 2 numbers for 2 keypoints",
        ),
        (COCO, ["annotations", 0, "keypoints"], ["a"], r"annotation 1: found keypoints that are no numbers"),
        (COCO, ["annotations", 0, "image_id"], 5, r"annotation 1: found image_id 5, expected the id of an image"),
        (COCO, ["categories"], [], r"annotation 1: found 6 numbers for 0 keypoints"),
        (COCO, ["images", 0, "width"], 320, r"annotation 1, 0: found a picture 320 pixels wide, expected 640"),
        (STUDIO, [0, "annotations", 0, "result", 0, "value", "x"], "a", r"task 7, region r10.5: found no place"),
        (STUDIO, [0, "annotations", 0, "result", 0, "image_rotation"], 90, r"found a picture turned by 90 deg"),
        (STUDIO, [0, "data"], {}, r"task 7, region r10.5: found picture , expected the name of a scan"),
        (VIA, ["_via_img_metadata", "run-01.png123", "regions", 0, "shape_attributes", "cx"], None, r"found cx=None"),
        (
            VIA,
            ["_via_img_metadata", "run-01.png123", "regions", 0, "region_attributes"],
            {"quality": "2"},
            r"run-01.png, region 1: found label '', quality '2', expected .* by source.point_id which place",
        ),
    ],
)
def test_what_cannot_be_used_is_one_line(tmp_path, content, keys, value, told):
    content = deepcopy(content)
    part = content
    for key in keys[:-1]:
        part = part[key]
    part[keys[-1]] = value
    with pytest.raises(InputError, match=told) as error:
        read(tmp_path, content)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("content", [[], {}, 3, [[1]], {"a": {"b": 1}}, {"images": [], "annotations": 3}])
def test_json_of_another_kind(tmp_path, content):
    with pytest.raises(InputError, match=r"JSON of another kind, expected that of one of LabelMe, COCO k"):
        read(tmp_path, content)


def cvat(folder, height):
    image = f'<image name="run-01.png" width="640" height="{height}"><points label="0" points="10.5,20.5"/></image>'
    (folder / "labels.xml").write_text(f"<annotations>{image}</annotations>")


def labelme(folder, height):
    shape = {"label": "0", "points": [[10.5, 20.5]], "shape_type": "point"}
    content = {"shapes": [shape], "imagePath": "run-01.png", "imageWidth": 640, "imageHeight": height}
    (folder / "labels.json").write_text(json.dumps(content))


def coco(folder, height):
    content = deepcopy(COCO) | {"annotations": COCO["annotations"][:1]}
    content["images"][0]["height"] = height
    (folder / "labels.json").write_text(json.dumps(content))


def studio(folder, height):
    value = {"x": 100 * 10.5 / 640, "y": 100 * 20.5 / height, "keypointlabels": ["0"]}
    result = {"id": "r", "from_name": "kp", "type": "keypointlabels", "value": value}
    task = {"data": {"image": "https://store/a/run-01.png?key=a.b"}, "annotations": [{"result": [result]}]}
    result |= {"original_width": 640, "original_height": height}
    (folder / "labels.json").write_text(json.dumps([task]))


@pytest.mark.parametrize("write", [cvat, labelme, coco, studio])
def test_pictures_of_another_height_than_their_scans_are_refused(tmp_path, write):
    """As of pictures that were scaled along the track alone."""
    scans = {1: tmp_path / "run-01.png"}
    Image.new("I;16", (640, 400)).save(scans[1])
    write(tmp_path, 400)
    (labels,) = (path.name for path in tmp_path.glob("labels.*"))
    assert read_point_labels(tmp_path, labels, scans, 640).to_numpy().tolist()[0][2:] == pytest.approx([10, 20])
    write(tmp_path, 200)
    with pytest.raises(InputError, match=r"found a picture of 200 lines, expected 400, as its scan has"):
        read_point_labels(tmp_path, labels, scans, 640)


def test_a_control_beside_a_region_needs_no_size_of_its_own(tmp_path):
    content = deepcopy(STUDIO[1:])
    del content[0]["annotations"][0]["result"][2]["original_width"]
    content[0]["annotations"][0]["result"].pop(0)
    assert read(tmp_path, content, "mark")["point"].tolist() == ["gate"]


@pytest.mark.parametrize(
    "data",
    [
        {"comment": "Flight over the field.", "image": "/data/upload/1/0badcafe-run-01.png"},
        {"comment": "see run-03.png", "image": "https://store/v1.2/run-01.png?key=a.b/c.png"},
        {"recorded": "2026-05-01T12:00:00.25Z", "image": "/tasks/run-01.png?version=1.0"},
        {"note": "v1.2", "photo": "run-01.JPG"},
    ],
)
def test_a_text_with_a_full_stop_is_no_picture(tmp_path, data):
    content = deepcopy(STUDIO[:1])
    content[0] |= {"data": data, "file_upload": "0badcafe-tasks.json"}
    assert read(tmp_path, content)["observation"].tolist() == [1]


@pytest.mark.parametrize(
    ("picture", "observation"),
    [
        ("run.raw.png", 1),
        ("run.img.hdr.png", 2),
        ("run.png", None),
        ("run-03.png", 3),
        ("run-03.hdr.png", 3),
        ("run-03.bil.png", 3),
        ("run-04.bil.png", 4),
    ],
)
def test_scans_told_apart_by_the_ending_of_their_data(tmp_path, picture, observation):
    """`run.raw` and `run.img` in one folder, each with a header of its own: the picture's whole name counts."""
    scans = {1: Path("run.raw.hdr"), 2: Path("run.img.hdr"), 3: Path("run-03.bil.hdr"), 4: Path("run-04.hdr")}
    content = deepcopy(COCO) | {"annotations": COCO["annotations"][:1]}
    content["images"][0]["file_name"] = picture
    (tmp_path / "labels.json").write_text(json.dumps(content))
    if observation is None:
        with pytest.raises(InputError, match=r"run.png, expected the name of a scan: run-03, run-04, run.img, "):
            read_point_labels(tmp_path, "labels.json", scans, 640)
    else:
        assert read_point_labels(tmp_path, "labels.json", scans, 640)["observation"].tolist() == [observation]
