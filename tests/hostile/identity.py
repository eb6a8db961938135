"""Who nginx says that a caller is. alvord is not asked: both back ends are sockets of this file, which note what nginx sends them."""

import contextlib
import pathlib
import socket
import struct
import subprocess
import threading

import hpack

from attack import attack
from http2 import END_HEADERS, HEADERS, Http2Stranger, call_headers, frame, literal
from machine import until
from strangers import Stranger

FAMILY = "identity"
HEADER = "x-alvor-tenant"
ASKED_FOR = ("# ssl_client_certificate", "# ssl_verify_client optional")  # as docker/nginx.conf has them, commented out


class Back:
  """A Unix socket. `heard` is the headers of each request by HTTP/1.1, and of each call by HTTP/2, as dictionaries."""

  def __init__(self, path):
    self.heard = []
    self.listener = socket.socket(socket.AF_UNIX)
    self.listener.bind(str(path))
    self.listener.listen()
    threading.Thread(target=self.listen, daemon=True).start()

  def listen(self):
    with contextlib.suppress(OSError):
      while True:
        connection, _ = self.listener.accept()
        connection.settimeout(2)
        with connection, contextlib.suppress(OSError):
          self.heard.append(headers_of(connection.makefile("rb")))
          connection.sendall(b"HTTP/1.1 204 No Content\r\nConnection: close\r\n\r\n")

  def close(self):
    self.listener.close()


def headers_of(stream):
  first = stream.readline()
  if first.startswith(b"PRI"):
    return headers_of_call(stream)
  lines = iter(stream.readline, b"\r\n")
  return {name.decode().lower(): value.strip().decode() for name, _, value in (line.partition(b":") for line in lines)}


def headers_of_call(stream):
  stream.read(8)  # the rest of the preface
  while True:
    head = stream.read(9)
    content = stream.read(struct.unpack(">I", b"\0" + head[:3])[0])
    if head[3] == HEADERS:
      return dict(hpack.Decoder().decode(content))


class Caller:
  """A caller's certificate, or none. What a Stranger asks of a target is here."""

  def __init__(self, target, port, files=None):
    self.target, self.calls, self.web, self.files = target, ("127.0.0.1", port), ("127.0.0.1", port), files

  def tls(self, *protocols):
    context = self.target.tls(*protocols)
    if self.files:
      context.load_cert_chain(*self.files)
    return context


def certificate(folder, subject, file, authority=None):
  """Makes `file`.crt and `file`.key, signed by an authority or by itself."""
  made = [folder / f"{file}.crt", folder / f"{file}.key"]
  request = ["openssl", "req", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes", "-subj", subject, "-keyout", made[1]]
  run = lambda *command: subprocess.run([*map(str, command)], check=True, capture_output=True)
  if authority is None:
    run(*request, "-x509", "-days", 2, "-out", made[0])
    return made
  run(*request, "-out", folder / f"{file}.csr")
  run("openssl", "x509", "-req", "-days", 2, "-in", folder / f"{file}.csr", "-CA", authority[0], "-CAkey", authority[1], "-CAcreateserial",
      "-out", made[0])
  return made


def ask(caller, backs):
  """Sends one request by HTTP/1.1 and one call by HTTP/2, both of which claim to be ali. Returns what the back ends were told."""
  claim = f"{HEADER}: ali\r\nX_Alvor_Tenant: ali\r\n".encode()
  for back in backs:
    back.heard.clear()
  page = Stranger(caller, caller.web, "http/1.1")
  page.send(b"GET / HTTP/1.1\r\nHost: localhost\r\n" + claim + b"\r\n")
  page.receive(1, 12)
  call = Http2Stranger(caller)
  call.send(frame(HEADERS, END_HEADERS, 1, call_headers() + literal(HEADER.encode(), b"ali")))
  with contextlib.suppress(AssertionError):
    until(lambda: all(back.heard for back in backs), 1, "both were asked")
  call.close()
  page.close()
  return [back.heard[0].get(HEADER) if back.heard else "not asked" for back in backs]


@attack(FAMILY)
def certified_names(target, seconds):
  """nginx tells alvord the name of a valid client certificate, and of nobody else, whatever callers claim."""
  if not target.has_front:
    return "nginx's own matter: not asked bare"
  folder = pathlib.Path(target.folder) / "identity"
  folder.mkdir()
  authority = certificate(folder, "/CN=authority", "client_ca")
  for name in ("tls.crt", "tls.key"):
    (folder / name).write_bytes((target.folder / name).read_bytes())
  backs = [Back(folder / "grpc.sock"), Back(folder / "web.sock")]
  port = target.start_nginx([f"unix:{folder}/{name}.sock" for name in ("grpc", "web")], folder, ASKED_FOR)
  told = {
      "none": ask(Caller(target, port), backs),
      "CN=bob": ask(Caller(target, port, certificate(folder, "/O=x/CN=bob", "bob", authority)), backs),
      "CN=x,CN=ali": ask(Caller(target, port, certificate(folder, "/CN=x,CN=ali", "comma", authority)), backs),
      "O=x,CN=ali": ask(Caller(target, port, certificate(folder, "/O=x,CN=ali", "organisation", authority)), backs),
      "signed by itself": ask(Caller(target, port, certificate(folder, "/CN=ali", "stranger")), backs),
  }
  for back in backs:
    back.close()
  expected = {"none": [None, None], "CN=bob": ["bob", "bob"], "CN=x,CN=ali": [None, None], "O=x,CN=ali": [None, None],
              "signed by itself": ["not asked", "not asked"]}
  assert told == expected, f"told {told}"
  return ", ".join(f"{subject}: {names[0]}" for subject, names in told.items())
