import hashlib
import threading
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer

import pytest

from linepose.errors import InputError
from linepose.survey.datasets import check_dataset, download_dataset, find_dataset

CONTENT = {"COPYING": b"do as you like\n", "views/1.csv": b"1,2,3\n", "views/2.csv": b"4,5,6\n"}
SHA256 = {file: hashlib.sha256(content).hexdigest() for file, content in CONTENT.items()}
CLOSED = "http://127.0.0.1:9/data/"  # the discard port, which nothing listens on


def put(folder, content=CONTENT):
    for file, data in content.items():
        (folder / file).parent.mkdir(parents=True, exist_ok=True)
        (folder / file).write_bytes(data)
    return folder


class QuietHandler(SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


@pytest.fixture
def server(tmp_path):
    """Address of a server on this machine, and the folder whose files it serves."""
    folder = put(tmp_path / "served")
    with ThreadingHTTPServer(("127.0.0.1", 0), partial(QuietHandler, directory=folder)) as running:
        thread = threading.Thread(target=running.serve_forever, kwargs={"poll_interval": 0.01})
        thread.start()
        yield f"http://127.0.0.1:{running.server_port}/", folder
        running.shutdown()
        thread.join()


@pytest.fixture(autouse=True)
def no_wait(monkeypatch):
    """Retries follow at once, and no proxy stands between the test and this machine."""
    monkeypatch.setattr("pooch.core.time.sleep", lambda _: None)
    monkeypatch.setenv("NO_PROXY", "127.0.0.1")


def test_first_folder_that_has_the_data_set(tmp_path):
    folders = [tmp_path / "data", tmp_path / "a", tmp_path / "b"]
    put(folders[1] / "robot")
    put(folders[2] / "robot")
    assert find_dataset("robot", list(CONTENT), folders) == folders[1] / "robot"
    assert find_dataset("rover", list(CONTENT), folders) is None


def test_folder_without_a_file_of_it_is_no_copy(tmp_path):
    (tmp_path / "data" / "robot" / "views").mkdir(parents=True)
    here = put(tmp_path / "shared" / "robot")
    assert find_dataset("robot", list(CONTENT), [tmp_path / "data", tmp_path / "shared"]) == here


def test_part_of_a_data_set_is_named(tmp_path):
    folder = put(tmp_path / "robot")
    (folder / "views" / "2.csv").unlink()
    with pytest.raises(InputError) as error:
        find_dataset("robot", list(CONTENT), [tmp_path])
    assert str(error.value) == (
        f"{folder}/views/2.csv: found no such file, expected all 3 files of the data set robot; "
        f"complete the folder, or remove {folder} to have it downloaded"
    )


def test_data_set_whose_files_nobody_lists_is_any_folder(tmp_path):
    (tmp_path / "robot").mkdir()
    assert find_dataset("robot", [], [tmp_path / "data", tmp_path]) == tmp_path / "robot"
    assert find_dataset("rover", [], [tmp_path]) is None


def test_whole_data_set_passes(tmp_path):
    assert check_dataset(put(tmp_path), SHA256) == SHA256


def test_file_without_a_known_sum_is_told_its_sum(tmp_path):
    assert check_dataset(put(tmp_path), SHA256 | {"COPYING": None}) == SHA256


@pytest.mark.parametrize(("data", "size"), [(b"4,5,7\n", 6), (b"4,5", 3), (b"", 0)])
def test_altered_or_truncated_file_is_named(tmp_path, data, size):
    put(tmp_path, CONTENT | {"views/2.csv": data})
    with pytest.raises(InputError) as error:
        check_dataset(tmp_path, SHA256)
    found = hashlib.sha256(data).hexdigest()[:12]
    assert str(error.value) == (
        f"{tmp_path}/views/2.csv: found sha256 {found}... ({size} bytes), "
        f"expected sha256 {SHA256['views/2.csv'][:12]}...; "
        "the file is altered or truncated: restore it from the source"
    )


def test_missing_file_is_named(tmp_path):
    put(tmp_path)
    (tmp_path / "COPYING").unlink()
    with pytest.raises(InputError) as error:
        check_dataset(tmp_path, SHA256)
    assert str(error.value) == f"{tmp_path}/COPYING: found no such file, expected a file of the data set; restore it"


def test_download_brings_every_file(server, tmp_path):
    url, _ = server
    folder = tmp_path / "data" / "robot"
    download_dataset("robot", url, SHA256, {}, folder, [tmp_path / "data"])
    assert {file: (folder / file).read_bytes() for file in CONTENT} == CONTENT
    assert sum(path.is_file() for path in folder.rglob("*")) == len(CONTENT)


def test_download_takes_a_file_that_stands_elsewhere(server, tmp_path):
    url, served = server
    (served / "above").mkdir()
    (served / "COPYING").rename(served / "above" / "LICENCE")
    folder = tmp_path / "data" / "robot"
    download_dataset("robot", url, SHA256, {"COPYING": f"{url}above/LICENCE"}, folder, [tmp_path / "data"])
    assert (folder / "COPYING").read_bytes() == CONTENT["COPYING"]


def test_altered_download_is_named_and_not_kept(server, tmp_path):
    url, served = server
    (served / "views" / "1.csv").write_bytes(b"1,2,4\n")
    folder = tmp_path / "data" / "robot"
    with pytest.raises(InputError) as error:
        download_dataset("robot", url, SHA256, {}, folder, [tmp_path / "data"])
    message = str(error.value)
    assert message.startswith(f"{url}views/1.csv: found SHA256 hash of downloaded file")
    assert SHA256["views/1.csv"] in message
    assert hashlib.sha256(b"1,2,4\n").hexdigest() in message
    assert message.endswith("expected the file with the known sha256; report this")
    assert "\n" not in message
    assert not (folder / "views" / "1.csv").exists()


def test_file_that_the_server_has_not(server, tmp_path):
    url, served = server
    (served / "views" / "2.csv").unlink()
    with pytest.raises(InputError) as error:
        download_dataset("robot", url, SHA256, {}, tmp_path / "data" / "robot", [tmp_path / "data"])
    assert f"{url}views/2.csv cannot be reached (HTTPError)" in str(error.value)


def test_without_network_the_message_says_where_to_put_a_copy(tmp_path):
    searched = [tmp_path / "data", tmp_path / "shared"]
    with pytest.raises(InputError) as error:
        download_dataset("robot", CLOSED, SHA256, {}, searched[0] / "robot", searched)
    assert str(error.value) == (
        f"data set robot: found no copy in {tmp_path}/data/robot, {tmp_path}/shared/robot, and {CLOSED}COPYING "
        f"cannot be reached (ConnectionError), expected a copy or a network; "
        f"put its files in {tmp_path}/data/robot, or leave its platforms out: snakemake --config offline=true"
    )


def test_a_copy_put_in_the_next_folder_is_found_after_a_failed_download(tmp_path):
    searched = [tmp_path / "data", tmp_path / "shared"]
    with pytest.raises(InputError):
        download_dataset("robot", CLOSED, SHA256, {}, searched[0] / "robot", searched)
    copy = put(searched[1] / "robot")
    assert find_dataset("robot", list(CONTENT), searched) == copy


@pytest.mark.field
def test_field_data_are_those_of_the_configured_sums(field_data, ladybird_dataset):
    assert len(ladybird_dataset.sha256) == 52
    check_dataset(field_data, ladybird_dataset.sha256)
