"""Ordinary calls, by gRPC and by gRPC-Web, and scenes to make them with. Import it after target.make_stubs()."""

import http.client
import re
import struct
import time

import grpc
from google.protobuf import duration_pb2, message_factory

from alvor.v1 import scene_service_pb2 as scenes
from alvor.v1 import solve_service_pb2 as solves
from target import token_of

SERVING = b"\x08\x01"
METHODS = {method.name: method for file in (scenes, solves) for service in file.DESCRIPTOR.services_by_name.values()
           for method in service.methods}
make_class = message_factory.MessageFactory().GetPrototype


class Caller:
  """A tenant's calls: caller.GetScene(request). Several tenants may share a channel."""

  def __init__(self, target, tenant="ali", channel=None):
    self.channel = channel or open_channel(target)
    self.metadata = (("authorization", f"Bearer {token_of(tenant)}"),) if tenant else ()

  def __getattr__(self, name):
    method = METHODS[name]
    kinds = {(False, False): "unary_unary", (False, True): "unary_stream", (True, False): "stream_unary"}
    streams = (name == "CreateScene", name in ("ReadScene", "ReadMesh", "ReadImages", "WatchSolve"))
    call = getattr(self.channel, kinds[streams])(
        path_of(name), request_serializer=lambda request: request.SerializeToString(),
        response_deserializer=make_class(method.output_type).FromString)
    return lambda request, timeout=10: call(request, timeout=timeout, metadata=self.metadata)

  def create_scene(self, chunks, timeout=10, request_id=""):
    first = scenes.CreateSceneRequest(scene=scenes.Scene(display_name="attack"), request_id=request_id)
    return self.CreateScene(iter([first, *(scenes.CreateSceneRequest(chunk=chunk) for chunk in chunks)]), timeout)

  def create_solve(self, scene, pause=0, **spec):
    spec = solves.SolveSpec(step_pause=duration_pb2.Duration(seconds=pause), **spec)
    return self.CreateSolve(solves.CreateSolveRequest(parent=scene, solve=solves.Solve(spec=spec)))

  def state_of(self, solve):
    return solves.Solve.State.Name(self.GetSolve(solves.GetSolveRequest(name=solve)).state)

  def close(self):
    self.channel.close()


def path_of(name):
  method = METHODS[name]
  return f"/{method.containing_service.full_name}/{name}"


def open_channel(target):
  """A channel with a connection of its own."""
  credentials = grpc.ssl_channel_credentials(target.certificate.read_bytes())
  options = [("grpc.use_local_subchannel_pool", 1), ("grpc.max_receive_message_length", -1)]
  return grpc.secure_channel("localhost:%d" % target.calls[1], credentials, options=options)


def outcome(call, *arguments, **more):
  """Returns (name of the status, answer or details). The answer of a stream is the list of its messages."""
  try:
    answer = call(*arguments, **more)
    return "OK", list(answer) if hasattr(answer, "cancel") else answer
  except grpc.RpcError as refusal:
    return refusal.code().name, refusal.details()


def health(target, timeout=5):
  """Returns (whether it says SERVING, the seconds that it took), on a new connection."""
  begin = time.monotonic()
  with grpc.insecure_channel(target.health, options=[("grpc.use_local_subchannel_pool", 1)]) as channel:
    status, answer = outcome(channel.unary_unary("/grpc.health.v1.Health/Check"), b"", timeout=timeout)
  return (status, answer) == ("OK", SERVING), time.monotonic() - begin


def web_message(request):
  content = request.SerializeToString()
  return b"\0" + struct.pack(">I", len(content)) + content


class WebCaller:
  """Calls of gRPC-Web over one connection that is kept."""

  def __init__(self, target):
    self.connection = http.client.HTTPSConnection("localhost", target.web[1], context=target.tls("http/1.1"), timeout=10)

  def call(self, name, request, tenant, timeout=None):
    """Returns (name of the status, the answer's first message or None)."""
    headers = {"Content-Type": "application/grpc-web+proto", "Authorization": f"Bearer {token_of(tenant)}"}
    if timeout:
      headers["grpc-timeout"] = f"{int(1000 * timeout)}m"
    requests = request if isinstance(request, list) else [request]
    self.connection.request("POST", path_of(name), b"".join(web_message(each) for each in requests), headers)
    response = self.connection.getresponse()
    return read_web_answer(response.status, response.read(), make_class(METHODS[name].output_type))


def read_web_answer(http_status, content, message_class):
  if http_status != 200:
    return f"HTTP {http_status}", None
  trailer = re.search(rb"grpc-status: ?(\d+)", content)
  status = next(code.name for code in grpc.StatusCode if code.value[0] == int(trailer.group(1)))
  size = struct.unpack(">I", content[1:5])[0]
  return status, message_class.FromString(content[5:5 + size]) if content[0] == 0 else None


GREY = scenes.Rgb(r=0.5, g=0.5, b=0.5)


def room(shift=0.0):
  """A closed box with a lamp, in one chunk."""
  s = 2.0 + shift
  corners = [0, 0, 0, s, 0, 0, s, s, 0, 0, s, 0, 0, 0, s, s, 0, s, s, s, s, 0, s, s,
             .7, .7, s - .01, 1.3, .7, s - .01, 1.3, 1.3, s - .01, .7, 1.3, s - .01]
  faces = [0, 1, 2, 3, 7, 6, 5, 4, 0, 4, 5, 1, 1, 5, 6, 2, 2, 6, 7, 3, 3, 7, 4, 0, 11, 10, 9, 8]
  lamp = scenes.Material(name="lamp", emission=scenes.Rgb(r=100, g=100, b=100))
  return [scenes.GeometryChunk(vertex_coordinates=corners, face_corner_counts=[4] * 7, face_materials=[0] * 6 + [1],
                               corner_vertices=faces, materials=[scenes.Material(name="grey", reflectance=GREY), lamp])]


def nearly_collinear_polygons(count, corners):
  """Polygons all but two of whose corners lie on one line: the worst case of ear clipping."""
  lamp = scenes.Material(name="lamp", emission=scenes.Rgb(r=1, g=1, b=1))
  chunks = [scenes.GeometryChunk(materials=[scenes.Material(name="grey", reflectance=GREY), lamp])]
  for number in range(count):
    z = 0.5 * number
    points = [v for k in range(corners - 2) for v in (1.01 * k / (corners - 3), 0, z)] + [1, 1, z, 0, 1, z]
    chunks.append(scenes.GeometryChunk(vertex_coordinates=points, face_corner_counts=[corners], face_materials=[number % 2],
                                       corner_vertices=range(number * corners, (number + 1) * corners)))
  return chunks
