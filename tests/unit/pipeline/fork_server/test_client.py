"""Scripts run by the fork server as if they had been started alone, and what happens when one side is killed."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from linepose.pipeline.fork_server.client import NAME, name_server
from linepose.pipeline.fork_server.client import run_forked as run_forked_job
from linepose.pipeline.fork_server.server import imported_modules
from linepose.pipeline.parent_process import SNAKEMAKE

pytestmark = pytest.mark.skipif(not hasattr(os, "pidfd_open"), reason="processes are not forked on this system")
PATIENCE_S = 20.0


@pytest.fixture
def snakemake(monkeypatch):
    """A process that stands for Snakemake; the server ends with it."""
    process = subprocess.Popen(["sleep", "600"])
    monkeypatch.setenv(SNAKEMAKE, str(process.pid))
    monkeypatch.setenv(NAME, "")
    name_server()
    yield process
    process.kill()
    process.wait()


def run_forked(script: str, threads: int) -> int | None:
    return run_forked_job(script, "adjust", Path(script).with_suffix(".log"), threads)


def script(folder: Path, text: str) -> str:
    path = folder / "script.py"
    path.write_text(text)
    return str(path)


def until(happened: Callable[[], bool]) -> None:
    deadline = time.monotonic() + PATIENCE_S
    while not happened():
        assert time.monotonic() < deadline
        time.sleep(0.02)


def is_alive(process: int) -> bool:
    status = Path(f"/proc/{process}/stat")
    return status.exists() and status.read_text().rpartition(")")[2].split()[0] != "Z"


def test_a_script_finds_its_modules_loaded_and_the_environment_folder_and_streams_of_its_client(
    snakemake, tmp_path, monkeypatch, capfd
):
    monkeypatch.setenv("TOLD", "by the client")
    monkeypatch.chdir(tmp_path)
    text = (
        "import os, sys\nprint('linepose.arrays' in sys.modules, os.environ['TOLD'], os.getcwd(), __name__)\n"
        "import linepose.arrays\nprint('to the error stream', file=sys.stderr)\n"
    )
    assert run_forked(script(tmp_path, text), threads=1) == 0
    output, error = capfd.readouterr()
    assert output == f"True by the client {tmp_path} __main__\n"
    assert error == "to the error stream\n"


def test_the_exit_code_is_the_scripts(snakemake, tmp_path, capfd):
    assert run_forked(script(tmp_path, "import sys; sys.exit(3)"), threads=1) == 3
    assert run_forked(script(tmp_path, "import sys; sys.exit('told')"), threads=1) == 1
    assert capfd.readouterr().err == "told\n"
    assert run_forked(script(tmp_path, "1 / 0"), threads=1) == 1
    assert "ZeroDivisionError" in capfd.readouterr().err


def test_a_script_that_cannot_import_is_told_by_itself(snakemake, tmp_path, capfd):
    assert run_forked(script(tmp_path, "import linepose.no_such_module"), threads=1) == 1
    assert "linepose.no_such_module" in capfd.readouterr().err


def test_a_script_whose_process_is_killed_fails_in_one_line(snakemake, tmp_path, capfd):
    assert run_forked(script(tmp_path, "import os; os.kill(os.getpid(), 9)"), threads=1) == 137
    told = capfd.readouterr().err
    assert told.startswith("linepose.adjust: found its process killed")
    assert (tmp_path / "script.log").read_text() == told


def test_a_job_of_several_threads_or_without_a_run_is_not_handed_over(snakemake, tmp_path, monkeypatch):
    assert run_forked(script(tmp_path, ""), threads=2) is None
    monkeypatch.delenv(NAME)
    assert run_forked(script(tmp_path, ""), threads=1) is None


def test_where_a_process_cannot_be_followed_no_server_is_started(snakemake, tmp_path, monkeypatch):
    def forbidden(process):
        raise PermissionError(process)

    monkeypatch.setattr(os, "pidfd_open", forbidden)
    assert run_forked(script(tmp_path, ""), threads=1) is None
    assert os.environ[NAME] not in sockets()


def test_a_server_that_was_killed_is_followed_by_another(snakemake, tmp_path):
    server = tmp_path / "server"
    tells = script(tmp_path, f"import os; open({str(server)!r}, 'w').write(str(os.getppid()))")
    assert run_forked(tells, threads=1) == 0
    first = int(server.read_text())
    os.kill(first, signal.SIGKILL)
    until(lambda: not is_alive(first))
    assert run_forked(tells, threads=1) == 0
    assert int(server.read_text()) != first


def sockets() -> str:
    return Path("/proc/net/unix").read_text()


def test_the_server_and_its_socket_are_gone_when_snakemake_has_ended(snakemake, tmp_path):
    assert run_forked(script(tmp_path, ""), threads=1) == 0
    assert os.environ[NAME] in sockets()
    snakemake.kill()
    until(lambda: os.environ[NAME] not in sockets())


def test_a_name_that_no_socket_can_have_leaves_jobs_to_themselves(snakemake, tmp_path, monkeypatch):
    monkeypatch.setenv(NAME, "x" * 200)
    assert run_forked(script(tmp_path, ""), threads=1) is None


def test_another_users_server_is_not_trusted(snakemake, tmp_path, monkeypatch):
    monkeypatch.setattr(os, "getuid", lambda: -1)
    assert run_forked(script(tmp_path, "raise SystemExit(3)"), threads=1) is None


def test_a_job_ends_when_its_client_is_killed(snakemake, tmp_path):
    job = tmp_path / "job"
    long = script(tmp_path, f"import os, time; open({str(job)!r}, 'w').write(str(os.getpid())); time.sleep(600)")
    asks = "from linepose.pipeline.fork_server.client import run_forked; from pathlib import Path; "
    asks += f"run_forked({long!r}, 'adjust', Path({str(tmp_path / 'log')!r}), 1)"
    client = subprocess.Popen([sys.executable, "-c", asks])
    until(lambda: job.exists() and job.read_text() != "")
    assert is_alive(int(job.read_text()))
    client.kill()
    client.wait()
    until(lambda: not is_alive(int(job.read_text())))


def test_imported_modules_are_those_of_the_package_wherever_they_stand(tmp_path):
    text = "import os, linepose.tables\nwith x:\n    from linepose.errors import one_line\n    from numpy import pi\n"
    assert imported_modules(Path(script(tmp_path, text))) == ["linepose.errors", "linepose.tables"]
