"""A SLURM of two nodes on this machine's loopback, on Debian and as root: installed, configured, started, stopped."""

import os
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

PACKAGES = {"slurm-wlm": "/usr/sbin/slurmctld", "munge": "/usr/sbin/munged"}
CONFIGURATION = Path("/etc/slurm/slurm.conf")  # the only place that clients read: the plugin takes SLURM_CONF away
NODES = ("n1", "n2")
CORES = 2  # of each node, whatever this machine has
MEMORY_MB = 8000

TEXT = """\
# Written by the tests of linepose (make slurm-test).
ClusterName=loopback
SlurmctldHost=localhost(127.0.0.1)
CommunicationParameters=NoInAddrAny,NoCtldInAddrAny
AuthType=auth/munge
SlurmUser=root
SlurmdUser=root
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool-%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd-%n.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd-%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
SchedulerParameters=sched_interval=1,bf_interval=1
JobAcctGatherType=jobacct_gather/linux
JobAcctGatherFrequency=1
JobAcctGatherParams=OverMemoryKill
AccountingStorageType=accounting_storage/none
ReturnToService=2
SlurmdParameters=config_overrides
{nodes}
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def install() -> None:
    """Install what is missing, by apt."""
    if os.geteuid() != 0:
        sys.exit("slurm-test: found another user than root, expected root on Debian 12; run it as root in a container")
    missing = [name for name, program in PACKAGES.items() if not Path(program).is_file()]
    if missing:
        environment = os.environ | {"DEBIAN_FRONTEND": "noninteractive"}
        subprocess.run(["apt-get", "update", "-qq"], check=True, env=environment)
        command = ["apt-get", "install", "-y", "-qq", "--no-install-recommends", *missing]
        subprocess.run(command, check=True, env=environment, stdout=subprocess.DEVNULL)


@contextmanager
def running(folder: Path) -> Iterator[None]:
    """The cluster at work, with its state and logs in a folder; all that was started is stopped afterwards."""
    if slurm("sinfo", check=False) is not None:
        sys.exit("slurm-test: found a SLURM at work here, expected none; run it on a machine without one")
    before = CONFIGURATION.read_text() if CONFIGURATION.is_file() else None
    for name in ("state", *(f"spool-{node}" for node in NODES)):
        (folder / name).mkdir()
    node = "NodeName={} NodeHostname=localhost NodeAddr=127.0.0.1 Port={} CPUs={} RealMemory={}"
    nodes = [node.format(name, 17001 + i, CORES, MEMORY_MB) for i, name in enumerate(NODES)]
    CONFIGURATION.write_text(TEXT.format(folder=folder, nodes="\n".join(nodes)))
    daemons = _munge(folder)
    try:
        for command in (["slurmctld", "-D"], *(["slurmd", "-D", "-N", name] for name in NODES)):
            daemons.append(_start(command, folder / "daemons.log"))
        _wait_until_idle()
        yield
    finally:
        slurm("scancel", "--me", check=False)
        for daemon in reversed(daemons):
            daemon.terminate()
            daemon.wait(30)
        if before is None:
            CONFIGURATION.unlink()
        else:
            CONFIGURATION.write_text(before)


def slurm(*command: str, check: bool = True) -> str | None:
    """What a command of SLURM prints; None where it fails and may."""
    try:
        return subprocess.run(command, check=True, capture_output=True, text=True, timeout=60).stdout
    except (subprocess.SubprocessError, FileNotFoundError):
        if check:
            raise
        return None


def _munge(folder: Path) -> "list[subprocess.Popen[bytes]]":
    """munged at work, as its own user; none where one is already."""
    if slurm("munge", "-n", check=False) is not None:
        return []
    Path("/run/munge").mkdir(exist_ok=True)
    shutil.chown("/run/munge", "munge", "munge")
    started = _start(
        ["setpriv", "--reuid=munge", "--regid=munge", "--clear-groups", "munged", "-F"], folder / "munge.log"
    )
    deadline = time.monotonic() + 30
    while slurm("munge", "-n", check=False) is None:
        if started.poll() is not None or time.monotonic() > deadline:
            sys.exit(f"slurm-test: munged does not answer: {(folder / 'munge.log').read_text()}")
        time.sleep(0.1)
    return [started]


def _start(command: list[str], log: Path) -> "subprocess.Popen[bytes]":
    with log.open("a") as file:
        return subprocess.Popen(command, stdout=file, stderr=file)


def _wait_until_idle() -> None:
    deadline = time.monotonic() + 60
    while (slurm("sinfo", "-h", "-N", "-o", "%t", check=False) or "").split() != ["idle"] * len(NODES):
        if time.monotonic() > deadline:
            sys.exit(f"slurm-test: the nodes are not idle after 60 s: {slurm('sinfo', '-N', check=False)}")
        time.sleep(0.2)
