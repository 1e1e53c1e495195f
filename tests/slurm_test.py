#!/usr/bin/env python3
"""A farm on one machine: slurmctld and three slurmd, each in a network of its own, render an animation by
tools/farm/render.sbatch while one node is killed and the link of another is cut for a while.

usage: slurm_test.py PROGRAM SCENE [--frames N] [--chunks N] [--size WxH]      (exit code 1 if anything differs)

Checked: every frame is there and has the bytes of one run on one node, no temporary file is left, and the merged log
has each frame. Printed: how long one node and three took. Needs to be root, and the packages slurmctld, slurmd,
slurm-client, munge and iproute2 of Debian; nothing of them is left running. Networks, bridges and folders have names
of their own, and go at the end.
"""
import argparse
import contextlib
import hashlib
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time

FARM = pathlib.Path(__file__).resolve().parent.parent / "tools" / "farm" / "render.sbatch"
NODES = ["n1", "n2", "n3"]
PORT = 47817  # of slurmctld; the nodes have their own networks, so all use the next

# `config_overrides`: the nodes have the processors that this file states, whatever the machine has. Times are short
# so that a lost node is noticed within seconds.
CONFIG = """ClusterName=tenebra_test
SlurmctldHost=ctl(10.213.47.1)
SlurmctldPort={port}
SlurmdPort={slurmd_port}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge/socket
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool/%n
SlurmctldPidFile={folder}/ctl.pid
SlurmdPidFile={folder}/%n.pid
SlurmctldLogFile={folder}/ctl.log
SlurmdLogFile={folder}/%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=batch_sched_delay=1,sched_interval=2,sched_min_interval=0
SlurmdParameters=config_overrides
SlurmctldTimeout=10
SlurmdTimeout=10
KillWait=2
MessageTimeout=4
TCPTimeout=2
ReturnToService=2
MpiDefault=none
SwitchType=switch/none
{nodes}
PartitionName=farm Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def call(*command, check=True, **more):
    return subprocess.run([str(word) for word in command], check=check, capture_output=True, text=True, **more).stdout


class Network:
    """A bridge in the controller's network, and a network for each node with a cable to it."""

    def __init__(self):
        self.tag = f"tnb{os.getpid()}"
        call("ip", "netns", "add", self.space("ctl"))
        self.inside("ctl", "ip", "link", "set", "lo", "up")
        self.inside("ctl", "ip", "link", "add", "br0", "type", "bridge")
        self.inside("ctl", "ip", "address", "add", "10.213.47.1/24", "dev", "br0")
        self.inside("ctl", "ip", "link", "set", "br0", "up")
        for i, node in enumerate(NODES):
            call("ip", "netns", "add", self.space(node))
            self.inside("ctl", "ip", "link", "add", node, "type", "veth", "peer", "name", "eth0", "netns",
                        self.space(node))
            self.inside("ctl", "ip", "link", "set", node, "master", "br0", "up")
            self.inside(node, "ip", "address", "add", f"10.213.47.{11 + i}/24", "dev", "eth0")
            self.inside(node, "ip", "link", "set", "lo", "up")
            self.inside(node, "ip", "link", "set", "eth0", "up")

    def space(self, name):
        return f"{self.tag}{name}"

    def entering(self, name, *command):
        """`ip netns exec` would hide the system's own mounts; nsenter leaves them. The host's name is the node's."""
        words = " ".join(f"'{word}'" for word in command)
        return ["nsenter", f"--net=/run/netns/{self.space(name)}", "unshare", "-u", "sh", "-c",
                f"hostname {name}; exec {words}"]

    def inside(self, name, *command, **more):
        return call(*self.entering(name, *command), **more)

    def link(self, node, state):
        self.inside("ctl", "ip", "link", "set", node, state)

    def kill(self, name):
        """All that runs on a machine, at once, as when its power goes."""
        while processes := call("ip", "netns", "pids", self.space(name), check=False).split():
            for process in processes:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(int(process), signal.SIGKILL)
            time.sleep(0.05)

    def close(self):
        for name in [*NODES, "ctl"]:
            self.kill(name)
            call("ip", "netns", "delete", self.space(name), check=False)


class Cluster:
    def __init__(self, folder, network):
        self.folder, self.network = folder, network
        for name in ("munge", "state", *(f"spool/{node}" for node in NODES)):
            (folder / name).mkdir(parents=True)
        nodes = "\n".join(f"NodeName={node} NodeAddr=10.213.47.{11 + i} NodeHostname={node} CPUs=1 State=UNKNOWN"
                          for i, node in enumerate(NODES))
        self.config = folder / "slurm.conf"
        self.config.write_text(CONFIG.format(folder=folder, nodes=nodes, port=PORT, slurmd_port=PORT + 1))
        (folder / "cgroup.conf").write_text("CgroupPlugin=cgroup/v1\nCgroupAutomount=no\n")
        self.environment = {**os.environ, "SLURM_CONF": str(self.config)}
        self.processes = {}
        self.start_munge()
        self.start("ctl", "slurmctld", "-D", "-c", "-f", self.config)
        for node in NODES:
            self.start_node(node)

    def start_munge(self):
        munge = self.folder / "munge"
        (munge / "key").write_bytes(os.urandom(128))
        (munge / "key").chmod(0o400)
        self.start("ctl", "munged", "--foreground", "--force", f"--key-file={munge}/key", f"--socket={munge}/socket",
                   f"--seed-file={munge}/seed", f"--pid-file={munge}/pid", f"--log-file={munge}/log")

    def start(self, machine, *command):
        log = (self.folder / f"{machine}.{pathlib.Path(command[0]).name}.out").open("a")
        self.processes[machine, command[0]] = subprocess.Popen(
            self.network.entering(machine, *command), stdout=log, stderr=log, stdin=subprocess.DEVNULL,
            env=self.environment)

    def start_node(self, node):
        self.start(node, "slurmd", "-D", "-N", node, "-f", self.config)

    def run(self, *command):
        return self.network.inside("ctl", *command, env=self.environment)

    def states(self):
        return dict(line.split() for line in self.run("sinfo", "-h", "-N", "-o", "%N %T").splitlines())

    def wait_ready(self, nodes):
        wait_for(lambda: all(self.states().get(node) == "idle" for node in nodes), 60, f"{nodes} to be idle")

    def submit(self, job_environment, *arguments):
        """A job's number."""
        exports = ",".join(["ALL", *(f"{name}={value}" for name, value in job_environment.items())])
        return re.search(r"\d+", self.run("sbatch", "--parsable", f"--export={exports}", *arguments)).group()

    def tasks(self, job):
        """Task, state and node of what is queued or runs."""
        return [line.split("|") for line in self.run("squeue", "-h", "-r", "-j", job, "-o", "%K|%T|%N").splitlines()]

    def stop(self):
        for process in self.processes.values():
            if process.poll() is None:
                process.terminate()
        for process in self.processes.values():
            with contextlib.suppress(subprocess.TimeoutExpired):
                process.wait(5)


def wait_for(true, seconds, what):
    end = time.monotonic() + seconds
    while True:
        with contextlib.suppress(subprocess.CalledProcessError):
            if true():
                return
        if time.monotonic() > end:
            raise AssertionError(f"waited {seconds} s for {what}")
        time.sleep(0.5)


class Farm:
    """The render as the documentation has it, once undisturbed on one node, once on three that fail."""

    def __init__(self, arguments, folder, cluster):
        self.arguments, self.folder, self.cluster = arguments, folder, cluster

    def submit(self, name, *options):
        out, logs = self.folder / name, self.folder / f"{name}_logs"
        out.mkdir(), logs.mkdir()
        job = self.cluster.submit(
            {"TENEBRA": self.arguments.program, "LOGS": logs}, f"--array=1-{self.arguments.chunks}", "--cpus-per-task=1",
            f"--output={logs}/%a.out", *options, FARM, self.arguments.scene, "--frames",
            f"0:{self.arguments.frames - 1}", "--size", self.arguments.size, "-o", f"{out}/%04d.png", "--mask",
            f"{out}/mask_%04d.png")
        return out, logs, job

    def wait(self, job, seconds=3600):
        wait_for(lambda: not self.cluster.tasks(job), seconds, f"job {job} to end")

    def run_alone(self):
        begun = time.monotonic()
        out, logs, job = self.submit("alone", "--nodelist=n1")
        self.wait(job)
        return out, logs, time.monotonic() - begun

    def run_undisturbed(self):
        begun = time.monotonic()
        out, logs, job = self.submit("three")
        self.wait(job)
        return out, logs, time.monotonic() - begun

    def run_disturbed(self):
        """A third of the way n1 loses its power and n2 its link, which comes back once Slurm has given n2 up."""
        out, logs, job = self.submit("disturbed")
        wait_for(lambda: len(list(out.glob("[0-9]*.png"))) > self.arguments.frames / 3, 1800, "a third of the frames")
        both = {"n1", "n2"}
        wait_for(lambda: both <= {node for _, state, node in self.cluster.tasks(job) if state == "RUNNING"}, 60,
                 "chunks on n1 and n2")
        running = {node: task for task, state, node in self.cluster.tasks(job) if state == "RUNNING"}
        self.cluster.network.kill("n1")
        self.cluster.network.link("n2", "down")
        print(f"n1 killed in chunk {running.get('n1')}, n2 cut off in chunk {running.get('n2')}")
        wait_for(lambda: self.cluster.states()["n2"].startswith("down"), 120, "n2 to be given up")
        self.cluster.network.link("n2", "up")
        self.cluster.start_node("n1")
        self.wait(job)
        return out, logs


def hashes(folder):
    return {file.name: hashlib.sha256(file.read_bytes()).hexdigest() for file in folder.glob("*.png")}


def check(arguments, expected, out, logs):
    """What is wrong, in words."""
    found, wrong = hashes(out), []
    lost = sorted(set(expected) - set(found))
    if lost:
        wrong.append(f"{len(lost)} files are lost, {lost[0]} among them")
    differing = sorted(name for name in found if found[name] != expected.get(name))
    if differing:
        wrong.append(f"{len(differing)} files differ, {differing[0]} among them")
    left = [file.name for file in out.iterdir() if file.name.startswith(".tenebra-")]
    if left:
        wrong.append(f"temporary files are left: {left}")
    merged = logs / "merged.csv"
    call(arguments.program, "log", "merge", *sorted(logs.glob("chunk_*.csv")), "-o", merged)
    rows = [line for line in merged.read_text().splitlines() if not line.startswith("#")][1:]
    frames = [int(row.split(",")[0]) for row in rows]
    if frames != list(range(arguments.frames)):
        wrong.append(f"the merged log has {len(frames)} rows, expected one for each of {arguments.frames} frames")
    return wrong


def show(logs):
    for log in sorted(logs):
        print(f"--- {log.name}", *log.read_text(errors="replace").splitlines()[-60:], sep="\n", file=sys.stderr)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("scene", type=pathlib.Path)
    parser.add_argument("--frames", type=int, default=800)
    parser.add_argument("--chunks", type=int, default=16)
    parser.add_argument("--size", default="320x240")
    arguments = parser.parse_args()
    arguments.program, arguments.scene = arguments.program.resolve(), arguments.scene.resolve()
    if os.geteuid() != 0:
        print("slurm_test.py: needs to be root", file=sys.stderr)
        return 1
    with tempfile.TemporaryDirectory(prefix="tenebra-farm-") as name, contextlib.closing(Network()) as network:
        folder = pathlib.Path(name)
        cluster = Cluster(folder, network)
        try:
            cluster.wait_ready(NODES)
            farm = Farm(arguments, folder, cluster)
            alone, _, alone_s = farm.run_alone()
            expected = hashes(alone)
            if len(expected) != 2 * arguments.frames:
                raise AssertionError(f"one node made {len(expected)} files: {(folder / 'alone_logs' / '1.out').read_text()}")
            three, logs, three_s = farm.run_undisturbed()
            wrong = [f"three nodes: {what}" for what in check(arguments, expected, three, logs)]
            print(f"one node {alone_s:.0f} s, three {three_s:.0f} s: {alone_s / three_s:.2f} times as fast, on "
                  f"{os.cpu_count()} processors")
            disturbed, logs = farm.run_disturbed()
            wrong += [f"one node killed, one cut off: {what}" for what in check(arguments, expected, disturbed, logs)]
            if wrong:
                show([folder / "ctl.slurmctld.out", *logs.glob("*.out")])
        except Exception:
            show([*folder.glob("*.log"), *folder.glob("*.out")])
            raise
        finally:
            cluster.stop()
    print("\n".join(wrong) if wrong else f"{arguments.frames} frames: none lost, none half-written, the same bytes")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
