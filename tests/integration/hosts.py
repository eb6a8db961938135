"""Hosts on a private network, which are containers, and what may befall them. Needs root."""

import contextlib
import ipaddress
import json
import subprocess
import time

NETWORK = "alvor-test"  # without its own name service: podman's (aardvark-dns 1.4) is silent for seconds whenever a container comes or goes
SHIPPED = ["--read-only", "--read-only-tmpfs=false", "--cap-drop=all", "--security-opt=no-new-privileges"]


def run(*command, timeout=120, check=True, **more):
  """What it wrote to stdout. Raises, telling stderr, where it fails."""
  done = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=timeout, **more)
  if check and done.returncode != 0:
    raise AssertionError(f"{' '.join(map(str, command))}: {done.returncode}\n{done.stdout}{done.stderr}")
  return done.stdout.strip()


def podman(*words, **more):
  return run("podman", *words, **more)


def until(condition, seconds, what):
  """The seconds that passed until condition() was true, looked at ten times a second. Fails where they are more."""
  begin = time.monotonic()
  while not condition():
    assert time.monotonic() < begin + seconds, f"not within {seconds} s: {what}"
    time.sleep(0.1)
  return time.monotonic() - begin


KNOWN = {"server": 200, "front": 201, "worker": 202}  # hosts that all others know by these names, by the last part of the address


def address_of(name):
  """The address of a known host."""
  subnet = json.loads(podman("network", "inspect", NETWORK))[0]["subnets"][0]["subnet"]
  return str(ipaddress.ip_network(subnet)[KNOWN[name]])


class Host:
  """A container. `options` are podman's, `command` is what its image's program is told."""

  def __init__(self, name, image, command=(), options=()):
    self.name = name
    address = [word for known in KNOWN if known != name for word in ("--add-host", f"{known}:{address_of(known)}")]
    if name in KNOWN:  # the same card too: others remember it with the address for half a minute
      address += ["--hostname", name, "--ip", address_of(name), "--mac-address", f"02:00:00:00:00:{KNOWN[name]:02x}"]
    podman("run", "--detach", "--name", name, "--network", NETWORK, *address, *SHIPPED, *options, image, *command)

  def inspect(self, field):
    return podman("inspect", "--format", "{{" + field + "}}", self.name)

  def is_running(self):
    return self.inspect(".State.Running") == "true"

  def wait(self, seconds):
    """Its exit status."""
    until(lambda: not self.is_running(), seconds, f"{self.name} ends; it says: {self.log()[-1000:]}")
    return int(self.inspect(".State.ExitCode"))

  def runs(self, program):
    """Whether a process of this name runs on it."""
    return program in podman("top", self.name, "comm").splitlines()

  def log(self):
    done = subprocess.run(["podman", "logs", self.name], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    return done.stdout

  def kill(self):
    podman("kill", "--signal", "KILL", self.name)
    until(lambda: not self.is_running(), 10, f"{self.name} is dead")

  def stop(self):
    """SIGTERM, and 30 seconds later SIGKILL. Returns the exit status."""
    podman("stop", "--time", 30, self.name)
    return int(self.inspect(".State.ExitCode"))

  def start(self):
    podman("start", self.name)

  def remove(self):
    podman("rm", "--force", "--ignore", "--time", 0, self.name)

  @contextlib.contextmanager
  def paused(self):
    podman("pause", self.name)
    try:
      yield
    finally:
      podman("unpause", self.name)

  def within(self, *command):
    """Runs a command of this machine on the container's network."""
    return run("nsenter", "--target", self.inspect(".State.Pid"), "--net", *command)

  def cable(self):
    """The machine's side of its link."""
    here = json.loads(self.within("ip", "-json", "link", "show", "eth0"))[0]["link_index"]
    return next(link["ifname"] for link in json.loads(run("ip", "-json", "link")) if link["ifindex"] == here)

  @contextlib.contextmanager
  def cable_pulled(self):
    """Nothing goes through and nobody is told, and the address stays."""
    link = self.cable()
    run("ip", "link", "set", link, "down")
    try:
      yield
    finally:
      run("ip", "link", "set", link, "up")

  def slow_down(self, megabytes_per_s, loss):
    """Both ways."""
    shape = ["root", "tbf", "rate", f"{8 * megabytes_per_s}mbit", "burst", "32kb", "latency", "400ms"]
    self.within("tc", "qdisc", "add", "dev", "eth0", *shape)
    run("tc", "qdisc", "add", "dev", self.cable(), *shape)
    for chain in ("INPUT", "OUTPUT"):
      self.within("iptables", "-A", chain, "-m", "statistic", "--mode", "random", "--probability", loss, "-j", "DROP")
