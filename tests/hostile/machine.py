"""Programs that the attacks start on this machine, and what /proc says of them."""

import os
import pathlib
import resource
import socket
import subprocess
import time

LONGEST_WAIT = 30  # seconds, for anything: no attack may hang


def until(condition, seconds, what):
  """Returns the seconds that passed until condition() was true. Raises AssertionError where they are more than `seconds`."""
  begin = time.monotonic()
  while not condition():
    assert time.monotonic() < begin + seconds, f"not within {seconds} s: {what}"
    time.sleep(0.02)
  return time.monotonic() - begin


def free_port():
  with socket.create_server(("127.0.0.1", 0)) as listener:
    return listener.getsockname()[1]


def allow_many_descriptors():
  """Lets this process, which plays many callers, open as many sockets as it may."""
  _, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
  resource.setrlimit(resource.RLIMIT_NOFILE, (hard, hard))


class Program:
  """A running program. `descriptors` is (soft, hard) of its RLIMIT_NOFILE."""

  def __init__(self, command, log, descriptors=None):
    self.log_file = pathlib.Path(log)
    limit = (lambda: resource.setrlimit(resource.RLIMIT_NOFILE, descriptors)) if descriptors else None
    with open(log, "wb") as out:
      self.child = subprocess.Popen([str(word) for word in command], stdout=out, stderr=out, stdin=subprocess.DEVNULL, preexec_fn=limit)

  def log(self):
    return self.log_file.read_text(errors="replace")

  def is_running(self):
    return self.child.poll() is None

  def exit_status(self):
    return self.child.poll()

  def rss(self):
    """Megabytes of anonymous memory, of children too: nginx works in some. Pages of files do not count."""
    return sum(anonymous_megabytes(pid) for pid in (self.child.pid, *children(self.child.pid)))

  def descriptors(self):
    return len(os.listdir(f"/proc/{self.child.pid}/fd"))

  def terminate(self, seconds=LONGEST_WAIT):
    """Sends SIGTERM. Returns the seconds until it ended, or None where it did not within `seconds`."""
    begin = time.monotonic()
    self.child.terminate()
    try:
      self.child.wait(seconds)
    except subprocess.TimeoutExpired:
      return None
    return time.monotonic() - begin

  def kill(self):
    """Ends it and its children, which are its own."""
    if not self.is_running():
      return
    for pid in (*children(self.child.pid), self.child.pid):
      try:
        os.kill(pid, 9)
      except ProcessLookupError:
        pass
    self.child.wait()


def children(pid):
  try:
    return [int(child) for child in pathlib.Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]
  except OSError:
    return []


def anonymous_megabytes(pid):
  try:
    lines = pathlib.Path(f"/proc/{pid}/status").read_text().splitlines()
  except OSError:
    return 0.0
  return sum(int(line.split()[1]) for line in lines if line.startswith("RssAnon")) / 1024
