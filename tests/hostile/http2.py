"""HTTP/2 frame by frame (RFC 9113), as nobody's library would send it."""

import struct

from strangers import Stranger

DATA, HEADERS, PRIORITY, RST_STREAM, SETTINGS, PING, WINDOW_UPDATE, CONTINUATION = 0, 1, 2, 3, 4, 6, 8, 9
END_STREAM, END_HEADERS = 1, 4
PREFACE = b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n"
CANCEL = struct.pack(">I", 8)


def frame(kind, flags=0, stream=0, content=b""):
  return struct.pack(">I", len(content))[1:] + bytes([kind, flags]) + struct.pack(">I", stream) + content


def literal(name, value):
  """A header of fewer than 127 bytes each, which HPACK's table does not keep."""
  return b"\0" + bytes([len(name)]) + name + bytes([len(value)]) + value


def call_headers(token=None, path=b"/alvor.v1.SceneService/ListScenes"):
  """POST by https, with what gRPC wants."""
  headers = b"\x83\x87" + b"".join(literal(*pair) for pair in (
      (b":path", path), (b":authority", b"localhost"), (b"content-type", b"application/grpc"), (b"te", b"trailers")))
  return headers + literal(b"authorization", b"Bearer " + token.encode()) if token else headers


def resets(token):
  """Blocks of a hundred streams that are reset as soon as they are opened."""
  headers = call_headers(token)
  stream = lambda number: frame(HEADERS, END_HEADERS, number, headers) + frame(RST_STREAM, 0, number, CANCEL)
  return lambda block: b"".join(stream(200 * block + 2 * k + 1) for k in range(100))


def small_headers():
  """Blocks of 1 800 headers that go on with the first stream's."""
  block = frame(CONTINUATION, 0, 1, literal(b"x-a", b"b") * 1800)
  return lambda _: block


class Http2Stranger(Stranger):
  """A connection that has said its preface and settings."""

  def __init__(self, target, address="127.0.0.66"):
    super().__init__(target, target.calls, "h2", address)
    self.send(PREFACE + frame(SETTINGS))
