"""What the server does when it must not, cannot or shall not go on."""

import threading

from conftest import SCENES, alvor, reason, scenes, solves
from hosts import podman, until


def test_memory_limit(world, observed):
  """Memory limit of the container: new work is RESOURCE_EXHAUSTED and running solves end with what they have, before the server is killed."""
  server = world.server("--insecure", options=["--memory=256m", "--memory-swap=256m"])
  desk = world.desk()
  alvor(desk, "solve", f"{SCENES}/cornell_box.obj", "--tolerance", "0.001", "--max-elements", 4_000_000, "--time-limit", 60)
  ended = solves(desk)[0]
  assert ended["end_reason"] == "memory limit reached", ended
  large = world.scene(500)
  status, _, said = alvor(desk, "solve", large, check=False)
  assert status == 5 and "of memory" in said, said
  until(lambda: alvor(desk, "solve", f"{SCENES}/cornell_box.obj", check=False)[0] == 0, 20, "there is room for a small scene")
  assert server.inspect(".State.OOMKilled") == "false" and server.is_healthy() and server.inspect(".RestartCount") == "0"
  observed.append(f"256 MB: a solve ended at {ended['leaves']} leaves; 250 000 faces: \"{reason(said)}\"; then a small scene solved")


def test_full_disk(world, observed):
  """Disk full: scenes are refused with RESOURCE_EXHAUSTED, what was acknowledged stays, and goes on once there is room."""
  server = world.server("--insecure", options=["--mount=type=tmpfs,destination=/data,tmpfs-size=14m,tmpfs-mode=1777", "--env=ALVORD_DATA=/data"])
  desk = world.desk()
  kept = 0
  for n in range(20):
    scene = world.scene(200 + n)
    status, _, said = alvor(desk, "solve", scene, "--max-depth", 0, check=False)
    if status != 0:
      break
    kept += 1
  assert status == 5 and "full" in said, said
  assert 1 <= kept < 20
  held = scenes(desk)
  assert len(held) >= kept and server.is_healthy()
  for each in solves(desk):
    alvor(desk, "solves", "delete", each["name"])
  for each in held:
    alvor(desk, "scenes", "delete", each["name"])
  alvor(desk, "solve", f"{SCENES}/cornell_box.obj")
  observed.append(f"14 MB: full after {kept} scenes (\"{reason(said)}\"); all still listed; room again after deleting")


def test_backup(world, observed):
  """Backup of the data directory, restored into an empty volume: the same scenes, and solutions of the same bytes."""
  server = world.server("--insecure")
  desk = world.desk()
  alvor(desk, "solve", f"{SCENES}/cornell_box.obj", "-o", "before.glb")
  held = scenes(desk)
  name = solves(desk)[0]["name"]
  assert server.stop() == 0
  server.remove()
  tar = ["run", "--rm", f"--volume={server.VOLUME}:/data", f"--volume={world.folder}:/backup", "debian:bookworm-slim", "tar", "-C", "/data"]
  podman(*tar, "-czf", "/backup/alvor.tgz", ".")
  podman("volume", "rm", server.VOLUME)
  podman(*tar, "-xzf", "/backup/alvor.tgz")
  world.server("--insecure")
  assert scenes(desk) == held
  alvor(desk, "watch", name, "-o", "after.glb")
  assert world.digest("before.glb") == world.digest("after.glb")
  observed.append(f"{(world.folder / 'alvor.tgz').stat().st_size / 1e3:.0f} KB; equal files")


def test_rolling_restarts(world, observed):
  """Rolling restarts with drain under load: every client gets its solution, of the same bytes, from servers that come and go."""
  server = world.server("--insecure")
  desk = world.desk()
  ends = []

  def work(user):
    for turn in range(4):
      file = f"user{user}_{turn}.glb"
      ends.append(alvor(desk, "solve", f"{SCENES}/cornell_box.obj", "--tolerance", "0.02", "--pace", "0.1", "-o", file, check=False))

  users = [threading.Thread(target=work, args=[user]) for user in range(3)]
  at_work = lambda: any(user.is_alive() for user in users)
  for user in users:
    user.start()
  restarts = 0
  while at_work() and restarts < 4:
    until(lambda: any(each["state"] == "RUNNING" for each in solves(desk)) or not at_work(), 20, "there is work")
    assert server.stop() == 0
    server.remove()
    server = world.server("--insecure")
    restarts += 1
  for user in users:
    user.join(120)
  assert restarts >= 3
  assert [status for status, _, _ in ends] == [0] * 12, [said for status, _, said in ends if status]
  digests = {world.digest(file) for file in world.folder.glob("user*.glb")}
  assert len(digests) == 1
  parked = sum(each["restarts"] > 0 for each in solves(desk))
  assert parked > 0
  assert all(each["work_lost_s"] == 0 for each in solves(desk))
  observed.append(f"{restarts} restarts; 12 of 12 solves done, {parked} of them across a restart, without loss of work; equal files")
