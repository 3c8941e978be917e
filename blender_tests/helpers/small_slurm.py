"""Debian's Slurm with this machine as its only node: daemons of its own in a folder, on free ports, without root's services."""

import os
import pwd
import re
import shutil
import socket
import subprocess
import tempfile
import time
from pathlib import Path

_CONFIGURATION = """\
ClusterName=lancer
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller}
SlurmdPort={node}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket={folder}/munge.socket
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerType=sched/builtin
SchedulerParameters=batch_sched_delay=0,sched_interval=1
# More processors than there are: all tasks of a test run side by side.
SlurmdParameters=config_overrides
NodeName={host} NodeAddr=127.0.0.1 CPUs=16 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES State=UP
"""
_DAEMONS = {
    "munged": "--foreground --num-threads=2 --key-file={0}/key --socket={0}/munge.socket --pid-file={0}/munged.pid "
    "--seed-file={0}/seed --log-file={0}/munged.log",
    "slurmctld": "-D",
    "slurmd": "-D",
}


class SmallSlurm:
    """A context: the daemons run inside it."""

    def __enter__(self):
        # Sockets need a short path, which all users may enter.
        self.folder = Path(tempfile.mkdtemp(prefix="slurm-"))
        self.folder.chmod(0o755)
        self.environment = {**os.environ, "SLURM_CONF": str(self.folder / "slurm.conf")}
        self._daemons = []
        try:
            self._start()
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        if len(self._daemons) == len(_DAEMONS):
            subprocess.run(["scancel", "--full", "--user", self._user()], env=self.environment, capture_output=True)
        for daemon in reversed(self._daemons):
            daemon.terminate()
        for daemon in self._daemons:
            try:
                daemon.wait(10)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()
        shutil.rmtree(self.folder, ignore_errors=True)

    def _user(self):
        return pwd.getpwuid(os.getuid()).pw_name

    def _start(self):
        (self.folder / "key").write_bytes(os.urandom(1024))
        (self.folder / "key").chmod(0o400)
        for name in ("state", "spool"):
            (self.folder / name).mkdir()
        with socket.socket() as controller, socket.socket() as node:
            controller.bind(("127.0.0.1", 0))
            node.bind(("127.0.0.1", 0))
            ports = {"controller": controller.getsockname()[1], "node": node.getsockname()[1]}
        host = socket.gethostname().split(".")[0]
        text = _CONFIGURATION.format(host=host, user=self._user(), folder=self.folder, **ports)
        (self.folder / "slurm.conf").write_text(text)
        for name, arguments in _DAEMONS.items():
            path = shutil.which(name, path=os.environ["PATH"] + ":/usr/sbin:/sbin")
            assert path, f"{name} is missing: apt-get install munge slurm-client slurmctld slurmd"
            with open(self.folder / f"{name}.txt", "wb") as said:
                command = [path, *arguments.format(self.folder).split()]
                self._daemons.append(subprocess.Popen(command, env=self.environment, stdout=said, stderr=subprocess.STDOUT))
            if name == "munged":
                self._until(lambda: (self.folder / "munge.socket").exists())
        self._until(lambda: "idle" in self._said("sinfo", "--noheader", "--format=%T"))

    def _until(self, condition):
        """Wait for a condition; a minute without it is a failure with the last words of the daemons."""
        for _ in range(600):
            if condition():
                return
            time.sleep(0.1)
        told = [f"{path.name}:\n{path.read_text(errors='replace')[-1500:]}" for path in sorted(self.folder.glob("*.txt"))]
        raise AssertionError("Slurm does not get there:\n" + "\n".join(told))

    def _said(self, *command):
        return subprocess.run(command, env=self.environment, capture_output=True, text=True).stdout

    def submit(self, script, *options):
        """Run the script, which submits itself, with a folder for the logs; return (exit code, numbers of the jobs by step)."""
        done = subprocess.run(["sh", script, *options], env=self.environment, cwd=self.folder, capture_output=True, text=True)
        return done.returncode, dict(re.findall(r"^(\w+): job (\d+)$", done.stdout, re.MULTILINE))

    def wait(self):
        self._until(lambda: not self._said("squeue", "--noheader"))

    def ends(self, job):
        """Return {number of a task: (state, exit code)} of an array that is over."""
        fields = r"ArrayTaskId=(\d+) .*JobState=(\w+) .*ExitCode=(\d+):"
        found = re.findall(fields, self._said("scontrol", "show", "job", "--oneliner", job))
        return {int(number): (state, int(code)) for number, state, code in found}
