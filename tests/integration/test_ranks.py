"""One solve on the ranks of two hosts, and what befalls them."""

import time

import pytest

from conftest import SCENES, alvor, solves, the_solve, until_refined_is_kept
from hosts import Host, run, until

JOB = ["mpirun", "--host", "server,worker", "--map-by", "ppr:1:node", "alvord", "--insecure", "--gang", "2", "--checkpoint-interval", "0.5"]


@pytest.fixture
def ranks(world):
  """A server of two ranks, one on each of two hosts. Returns both hosts."""
  keys = world.folder / "ssh"
  keys.mkdir()
  run("ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-f", keys / "id_rsa")
  (keys / "id_rsa").chmod(0o644)  # for the containers' user
  options = ["--volume", f"{keys}:/etc/alvor/ssh:ro", "--tmpfs", "/tmp"]
  worker = world.add(Host("worker", "alvor-ranks", options=[*options, "--no-healthcheck"]))
  until(lambda: "listening" in worker.log(), 10, "sshd listens")
  return world.server(*JOB, image="alvor-ranks", options=options), worker


def test_two_hosts(world, ranks, observed):
  """Two hosts with a rank each: a solve gives the same bytes as on one, and both hosts work on it."""
  server, _ = ranks
  desk = world.desk()
  alvor(desk, "solve", f"{SCENES}/enfilade.obj", "--tolerance", "0.03", "-o", "two.glb")
  one = world.client("solve", f"{SCENES}/enfilade.obj", "--tolerance", "0.03", "-o", "one.glb")
  assert one.wait(60) == 0
  assert world.digest("two.glb") == world.digest("one.glb")
  cpu = [server.metric(f'alvor_rank_cpu_seconds_total{{rank="{rank}"}}') for rank in (0, 1)]
  assert min(cpu) > 0.3, cpu
  server.stop()  # mpirun ends with status 1 when it was asked to end
  assert server.log().splitlines()[-1].endswith("stopped"), server.log()[-1000:]
  observed.append(f"equal files; {cpu[0]:.1f} and {cpu[1]:.1f} CPU s; SIGTERM: all stop")


def test_cut_between_ranks(world, ranks, observed):
  """Cable of one host cut: the job ends within 15 s and says why; started again it goes on, and the watcher has the file of an undisturbed solve."""
  server, worker = ranks
  scene = [f"{SCENES}/cornell_box.obj", "--tolerance", "0.01", "--pace", "1"]
  watcher = world.client("solve", *scene, "--server", "server:50051", "-o", "watched.glb")
  desk = world.desk()
  until_refined_is_kept(server, desk, the_solve(desk))
  begin = time.monotonic()
  with worker.cable_pulled():
    server.wait(15)
    took = time.monotonic() - begin
    said = [line for line in server.log().splitlines() if "lost communication" in line or "worker" in line]
    assert said, server.log()[-2000:]
    until(lambda: not worker.runs("alvord"), 20, "the rank that nobody hears ends")
  server.start()
  assert watcher.wait(90) == 0
  again = solves(desk)[0]
  assert again["resumed_from_revision"] > 0, again
  alone = world.client("solve", *scene[:3], "-o", "alone.glb")
  assert alone.wait(60) == 0
  assert world.digest("watched.glb") == world.digest("alone.glb")
  observed.append(f"the job ended after {took:.1f} s: \"{said[0].strip()}\"; went on from revision {again['resumed_from_revision']}; equal files")
