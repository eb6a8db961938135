#!/usr/bin/python3
"""Fills the disk under a server, stops or kills it, and looks whether it keeps its promises:

- what does not fit is refused with RESOURCE_EXHAUSTED and says that the disk is full;
- the server starts on the full disk, and has every scene that it acknowledged;
- every delete succeeds, and gives room for new scenes.

  full_disk.py DIRECTORY_OF_ALVORD [SECONDS [SEED]]

Needs root, to mount a small disk; python3-grpcio, python3-protobuf, protobuf-compiler. Exit status 1: a promise was broken.
"""

import collections
import contextlib
import itertools
import pathlib
import random
import re
import subprocess
import sys
import tempfile
import threading
import time

import grpc
from google.protobuf import empty_pb2

PROTO = pathlib.Path(__file__).resolve().parents[2] / "proto"
ENDINGS = ("none", "SIGTERM", "SIGKILL", "SIGKILL while it writes")


class Broken(Exception):
  """A promise that was not kept."""


def make_stubs(folder):
  files = sorted(PROTO.glob("alvor/**/*.proto")) + sorted(PROTO.glob("google/**/*.proto"))
  subprocess.run(["protoc", "-I", PROTO, f"--python_out={folder}", *files], check=True)
  sys.path.insert(0, str(folder))
  global scenes, solves
  from alvor.v1 import scene_service_pb2 as scenes
  from alvor.v1 import solve_service_pb2 as solves


@contextlib.contextmanager
def small_disk(folder, megabytes):
  subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={megabytes}m", "tmpfs", folder], check=True)
  try:
    yield folder
  finally:
    subprocess.run(["umount", "--lazy", folder], check=True)


class Server:
  def __init__(self, binaries, data):
    words = [f"{binaries}/alvord", "--listen", "127.0.0.1:0", "--data", data, "--checkpoint-interval", "0.1"]
    self.process = subprocess.Popen([str(word) for word in words], stderr=subprocess.PIPE, text=True, errors="replace")
    self.log = []
    self.channel = None
    for line in self.process.stderr:
      self.log.append(line)
      if found := re.search(r" listening on (\S+)", line):
        break
    else:
      self.process.wait()
      raise Broken(f"it does not start: {''.join(self.log[-3:])}")
    threading.Thread(target=lambda: self.log.extend(self.process.stderr), daemon=True).start()
    self.channel = grpc.insecure_channel(found.group(1))

  def end(self, how):
    if how == "SIGTERM":
      self.process.terminate()
    else:
      self.process.kill()
    if self.process.wait(timeout=20) not in (0, -9):
      raise Broken(f"it ended with {self.process.returncode}: {''.join(self.log[-3:])}")
    if self.channel:
      self.channel.close()

  def call(self, service, method, request, answer):
    """Returns the code and the answer, or what was said instead."""
    call = self.channel.unary_unary(f"/alvor.v1.{service}/{method}", type(request).SerializeToString, answer.FromString)
    return outcome(lambda: call(request, timeout=30))

  def create_scene(self, chunk):
    call = self.channel.stream_unary("/alvor.v1.SceneService/CreateScene", scenes.CreateSceneRequest.SerializeToString,
                                     scenes.Scene.FromString)
    messages = [scenes.CreateSceneRequest(scene=scenes.Scene()), scenes.CreateSceneRequest(chunk=chunk)]
    return outcome(lambda: call(iter(messages), timeout=30))

  def vertices_of(self, scene):
    call = self.channel.unary_stream("/alvor.v1.SceneService/ReadScene", scenes.ReadSceneRequest.SerializeToString,
                                     scenes.ReadSceneResponse.FromString)
    request = scenes.ReadSceneRequest(name=scene)
    return outcome(lambda: sum(len(part.chunk.vertex_coordinates) for part in call(request, timeout=30)) // 3)

  def delete_scene(self, name):
    return self.call("SceneService", "DeleteScene", scenes.DeleteSceneRequest(name=name), empty_pb2.Empty)

  def scene_names(self):
    code, answer = self.call("SceneService", "ListScenes", scenes.ListScenesRequest(page_size=1000), scenes.ListScenesResponse)
    return {scene.name for scene in answer.scenes} if code == "OK" else set()

  def create_solve(self, scene):
    """Returns when it has left a checkpoint."""
    spec = solves.SolveSpec(tolerance=1e-9, max_elements=20000, threads=1)
    request = solves.CreateSolveRequest(parent=scene, solve=solves.Solve(spec=spec))
    name = required("CreateSolve", self.call("SolveService", "CreateSolve", request, solves.Solve)).name
    while not self.solve(name).HasField("checkpoint_time"):
      time.sleep(0.02)
    return name

  def solve(self, name):
    return required("GetSolve", self.call("SolveService", "GetSolve", solves.GetSolveRequest(name=name), solves.Solve))

  def delete_solve(self, name):
    """Ends it where it still runs."""
    self.call("SolveService", "CancelSolve", solves.CancelSolveRequest(name=name), solves.Solve)
    for _ in range(100):
      code, text = self.call("SolveService", "DeleteSolve", solves.DeleteSolveRequest(name=name), empty_pb2.Empty)
      if code != "FAILED_PRECONDITION":
        break
      time.sleep(0.1)
    return code, text


def outcome(call):
  try:
    return "OK", call()
  except grpc.RpcError as refusal:
    return refusal.code().name, refusal.details()


def required(what, result):
  if result[0] != "OK":
    raise Broken(f"{what}: {result[0]}: {result[1]}")
  return result[1]


def triangles(count, dice):
  """Random ones, which do not compress."""
  points = []
  for _ in range(count):
    x, y, z = (dice.random() * 50 for _ in range(3))
    points += [x, y, z, x + 0.1, y + dice.random() * 0.1, z, x, y + 0.1, z + 0.1]
  lamp = scenes.Material(name="lamp", emission=scenes.Rgb(r=1, g=1, b=1), reflectance=scenes.Rgb(r=0.5, g=0.5, b=0.5))
  return scenes.GeometryChunk(vertex_coordinates=points, face_corner_counts=[3] * count, face_materials=[0] * count,
                              corner_vertices=range(3 * count), materials=[lamp])


def room():
  """A closed one, in which light goes round for long."""
  side, lamp = (0, 2), (0.7, 1.3)
  points = [(x, y, z) for z in side for y in side for x in side] + [(x, y, 1.99) for y in lamp for x in lamp]
  faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (1, 5, 7, 3), (3, 7, 6, 2), (2, 6, 4, 0), (8, 10, 11, 9)]
  walls = scenes.Material(name="walls", reflectance=scenes.Rgb(r=0.7, g=0.7, b=0.7))
  light = scenes.Material(name="lamp", emission=scenes.Rgb(r=100, g=100, b=100))
  return scenes.GeometryChunk(vertex_coordinates=[x for point in points for x in point], face_corner_counts=[4] * len(faces),
                              face_materials=[0] * 6 + [1], corner_vertices=[v for face in faces for v in face],
                              materials=[walls, light])


def different_chunks(dice):
  """Endless. What is there already would not be kept twice, so each has a vertex more than the last."""
  pool = [triangles(6000, dice) for _ in range(4)]
  for n in itertools.count():
    chunk = pool[n % len(pool)]
    chunk.vertex_coordinates.extend([n, n, n])
    yield chunk


def create_until_full(server, chunks):
  """Returns the names of what was acknowledged. Full is where four in a row did not fit."""
  names, refused = [], 0
  while refused < 4:
    code, answer = server.create_scene(next(chunks))
    if code == "OK":
      names.append(answer.name)
      refused = 0
    elif code != "RESOURCE_EXHAUSTED" or "the disk is full" not in answer:
      raise Broken(f"CreateScene: {code}: {answer}")
    else:
      refused += 1
  return names


def fill(disk):
  """As others who use the disk might: leaves no block of it."""
  with contextlib.suppress(OSError), open(disk / "of others", "ab", buffering=0) as file:
    while True:
      file.write(bytes(4096))


def restarted(server, how, binaries, disk, chunks, dice):
  if how == "none":
    return server
  if how == "SIGKILL while it writes":
    threading.Thread(target=server.create_scene, args=(next(chunks),), daemon=True).start()
    time.sleep(dice.random() * 0.05)
  server.end(how)
  return Server(binaries, disk)


def check_deletes(server, names, solve, chunks):
  if solve:
    required("DeleteSolve", server.delete_solve(solve))
  refusals = collections.Counter(said for name in names if (said := server.delete_scene(name))[0] != "OK")
  if refusals:
    raise Broken(f"of {len(names)} deletes {sum(refusals.values())} were refused: {refusals.most_common(1)[0][0]}")
  required("CreateScene after all deletes", server.create_scene(next(chunks)))


def trial(binaries, disk, how, has_solve, has_others, dice):
  """Returns how many scenes fitted."""
  chunks = different_chunks(dice)
  server = Server(binaries, disk)
  try:
    names = [required("CreateScene", server.create_scene(room())).name]
    solve = server.create_solve(names[0]) if has_solve else None
    names += create_until_full(server, chunks)
    if has_solve:
      time.sleep(1)  # its checkpoints become larger
    if has_others:
      fill(disk)
    server = restarted(server, how, binaries, disk, chunks, dice)
    if lost := set(names) - server.scene_names():
      raise Broken(f"{len(lost)} of {len(names)} acknowledged scenes are gone")
    required("ReadScene", server.vertices_of(names[-1]))
    check_deletes(server, names, solve, chunks)
    return len(names)
  finally:
    if server.process.poll() is None:
      server.end("SIGKILL")


def main(binaries, seconds="60", seed="1"):
  dice = random.Random(int(seed))
  end = time.monotonic() + float(seconds)
  kept, broken = collections.Counter(), 0
  with tempfile.TemporaryDirectory() as folder:
    make_stubs(folder)
    disk = pathlib.Path(folder) / "disk"
    disk.mkdir()
    for how, has_solve, has_others in itertools.cycle(itertools.product(ENDINGS, (True, False), (True, False))):
      if time.monotonic() > end - 5:
        break
      what = f"{how}, {'with' if has_solve else 'without'} a solve, {'others fill the rest' if has_others else 'alone'}"
      with small_disk(disk, 20):
        try:
          fitted = trial(binaries, disk, how, has_solve, has_others, dice)
          kept[how] += 1
          print(f"ok: {what}: {fitted} scenes", flush=True)
        except Broken as fault:
          broken += 1
          print(f"BROKEN: {what}: {fault}", flush=True)
  print(f"{broken} trials broke a promise, {sum(kept.values())} did not: {dict(kept)}")
  return 1 if broken or not kept else 0


if __name__ == "__main__":
  sys.exit(main(*sys.argv[1:]))
