"""Files that were lost from a folder of results."""

from linepose.pipeline.file_list import lost_files, write_file_list


def test_lost_files_are_named(tmp_path):
    folder, path = tmp_path / "mcmc", tmp_path / "mcmc_files.txt"
    (folder / "deep").mkdir(parents=True)
    for name in ("b", "a", "deep/c"):
        (folder / name).touch()
    assert lost_files(folder, path) == []
    write_file_list(folder, path)
    assert path.read_text() == "a\nb\ndeep/c\n"
    assert lost_files(folder, path) == []
    (folder / "deep" / "c").unlink()
    (folder / "further").touch()
    assert lost_files(folder, path) == ["deep/c"]
