#!/usr/bin/python3
"""Submits a room to an Alvor server, watches it being solved, and writes the irradiance at the middle of each leaf.

  watch_a_room.py HOST:PORT OUT.csv [--detail display|exact] [--tolerance T]

OUT.csv has one line a leaf, `x,y,z,nx,ny,nz,r,g,b`. Prints the name of the solve. Needs Debian's python3-grpcio, python3-zstandard and
python3-protobuf, and the messages: protoc -I proto --python_out DIR proto/alvor/v1/*.proto, with DIR in PYTHONPATH.
"""

import argparse
import csv

import grpc
from alvor.v1 import scene_service_pb2 as scenes
from alvor.v1 import solve_service_pb2 as solves

import frame

# A room of 4 x 3 x 2.5 m, a table and a lamp under the ceiling. Corners counter-clockwise as seen from the front.
WHITE, RED, LAMP = range(3)
MATERIALS = [("white", 0, (0.7, 0.7, 0.7)), ("red", 0, (0.6, 0.1, 0.1)), ("lamp", 20, (0, 0, 0))]
QUADS = [
    (WHITE, [(0, 0, 0), (4, 0, 0), (4, 3, 0), (0, 3, 0)]),
    (WHITE, [(0, 0, 2.5), (0, 3, 2.5), (4, 3, 2.5), (4, 0, 2.5)]),
    (RED, [(0, 0, 0), (0, 3, 0), (0, 3, 2.5), (0, 0, 2.5)]),
    (WHITE, [(4, 0, 0), (4, 0, 2.5), (4, 3, 2.5), (4, 3, 0)]),
    (WHITE, [(0, 0, 0), (0, 0, 2.5), (4, 0, 2.5), (4, 0, 0)]),
    (WHITE, [(0, 3, 0), (4, 3, 0), (4, 3, 2.5), (0, 3, 2.5)]),
    (WHITE, [(1, 1, 0.8), (2.5, 1, 0.8), (2.5, 2, 0.8), (1, 2, 0.8)]),
    (WHITE, [(1, 1, 0.8), (1, 2, 0.8), (2.5, 2, 0.8), (2.5, 1, 0.8)]),
    (LAMP, [(1.5, 1, 2.4), (1.5, 2, 2.4), (2.5, 2, 2.4), (2.5, 1, 2.4)]),
]


def room():
  chunk = scenes.GeometryChunk()
  for name, emission, (r, g, b) in MATERIALS:
    chunk.materials.add(name=name, emission=scenes.Rgb(r=emission, g=emission, b=emission), reflectance=scenes.Rgb(r=r, g=g, b=b))
  for material, corners in QUADS:
    for corner in corners:
      chunk.corner_vertices.append(len(chunk.vertex_coordinates) // 3)
      chunk.vertex_coordinates.extend(corner)
    chunk.face_corner_counts.append(4)
    chunk.face_materials.append(material)
  return chunk


class Server:
  def __init__(self, address):
    self.channel = grpc.insecure_channel(address)

  def call(self, method, request, response):
    kind = self.channel.stream_unary if hasattr(request, "__next__") else self.channel.unary_unary
    return kind(method, lambda message: message.SerializeToString(), response.FromString)(request, timeout=30)

  def create_scene(self):
    requests = [scenes.CreateSceneRequest(scene=scenes.Scene(display_name="a room")), scenes.CreateSceneRequest(chunk=room())]
    return self.call("/alvor.v1.SceneService/CreateScene", iter(requests), scenes.Scene)

  def create_solve(self, scene, tolerance):
    spec = solves.SolveSpec(tolerance=tolerance)
    request = solves.CreateSolveRequest(parent=scene.name, solve=solves.Solve(spec=spec))
    return self.call("/alvor.v1.SolveService/CreateSolve", request, solves.Solve)

  def watch(self, solve, mirror, detail):
    """Applies every frame to the mirror, acknowledges and yields it, until the solve has ended."""
    watch = self.channel.unary_stream("/alvor.v1.SolveService/WatchSolve", lambda message: message.SerializeToString(),
                                      solves.WatchSolveResponse.FromString)
    request = solves.WatchSolveRequest(name=solve.name, epoch=mirror.epoch, base_revision=mirror.revision, detail=detail)
    for count, message in enumerate(watch(request), 1):
      mirror.apply(message)
      yield message
      if message.ended:
        return
      acknowledgement = solves.AcknowledgeFrameRequest(watch_id=message.watch_id, revision=message.to_revision, frame_count=count)
      try:
        self.call("/alvor.v1.SolveService/AcknowledgeFrame", acknowledgement, solves.AcknowledgeFrameResponse)
      except grpc.RpcError as error:
        if error.code() != grpc.StatusCode.NOT_FOUND:  # the watch has just ended
          raise


def middle_of(patch):
  """Of a leaf of a quad, and the normal there."""
  corners = QUADS[frame.face_of(patch)][1]
  u = v = 0.0
  width = height = 1.0
  for level in range(1, frame.level_of(patch) + 1):
    k = patch >> 2 * (frame.FINEST - level) + 1 & 3
    how = frame.split_above(patch, level)
    columns, rows = {frame.QUARTERS: (2, 2), frame.SLABS_ALONG_U: (4, 1), frame.SLABS_ALONG_V: (1, 4)}[how]
    width /= columns
    height /= rows
    u += width * (k % columns)
    v += height * (k // columns)
  u, v = u + width / 2, v + height / 2
  weights = ((1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v)
  point = [sum(w * c[axis] for w, c in zip(weights, corners)) for axis in range(3)]
  a, b = ([corners[n][axis] - corners[0][axis] for axis in range(3)] for n in (1, 3))
  normal = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
  length = sum(x * x for x in normal) ** 0.5
  return point + [x / length for x in normal]


def main():
  parser = argparse.ArgumentParser()
  parser.add_argument("server")
  parser.add_argument("out")
  parser.add_argument("--detail", choices=["display", "exact"], default="display")
  parser.add_argument("--tolerance", type=float, default=0.03)
  options = parser.parse_args()
  server = Server(options.server)
  solve = server.create_solve(server.create_scene(), options.tolerance)
  mirror = frame.Mirror()
  for message in server.watch(solve, mirror, frame.DISPLAY if options.detail == "display" else frame.EXACT):
    if message.steps:
      step = message.steps[-1]
      print(f"revision {step.revision}: {step.leaves} leaves, estimated error {100 * step.estimated_error:.1f} %")
  leaves = sorted(mirror.leaves.items(), key=lambda leaf: frame.place_of(leaf[0]))
  with open(options.out, "w", newline="") as out:
    csv.writer(out).writerows(middle_of(patch) + list(irradiance) for patch, irradiance in leaves)
  print(solve.name)


if __name__ == "__main__":
  main()
