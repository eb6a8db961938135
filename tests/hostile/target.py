"""What is attacked: alvord, bare or behind nginx with docker/nginx.conf. Everything listens on free ports of the loopback."""

import hashlib
import os
import pathlib
import re
import socket
import ssl
import subprocess
import sys

from machine import LONGEST_WAIT, Program, free_port, until

ROOT = pathlib.Path(__file__).resolve().parents[2]
BINARIES = pathlib.Path(os.environ.get("ALVOR_BINARIES", ROOT / "build/release/bin"))
TENANTS = ("ali", "bob", "cleo", "dora", "emil")
SOCKETS = ("unix:/run/alvor/grpc.sock", "unix:/run/alvor/web.sock")


def make_secrets(folder):
  """Writes a certificate for localhost with its key, and the tokens of TENANTS."""
  subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes", "-days", "2",
                  "-subj", "/CN=localhost", "-addext", "subjectAltName=DNS:localhost,IP:127.0.0.1", "-keyout", folder / "tls.key",
                  "-out", folder / "tls.crt"], check=True, capture_output=True)
  lines = [f"{name} {hashlib.sha256(token_of(name).encode()).hexdigest()}\n" for name in TENANTS]
  (folder / "tokens").write_text("".join(lines))


def token_of(tenant):
  return f"token of {tenant}"


class Target:
  """One alvord for one attack. `calls` and `web` are (host, port): of alvord itself, or both of nginx. They speak TLS."""

  def __init__(self, folder, front="none", options=(), descriptors=None):
    self.folder, self.has_front = folder, front == "nginx"
    self.certificate = folder / "tls.crt"
    self.on_sockets = self.has_front and "--identity-header" in alvord_help()
    self.fronts = []
    self.alvord = Program([BINARIES / "alvord", *self.listening(), "--health", "127.0.0.1:0", "--tokens", folder / "tokens", *options],
                          folder / "alvord.log", descriptors)
    try:
      until(lambda: self.said(r"(?<!not )listening on (\S+)") or not self.alvord.is_running(), LONGEST_WAIT, "alvord listens")
      assert self.alvord.is_running(), f"alvord ended: {self.alvord.log()[-500:]}"
      self.health = self.said(r"health on (\S+)")
      self.find_addresses()
    except BaseException:
      self.close()
      raise

  def listening(self):
    if self.on_sockets:
      return ["--listen", f"unix:{self.folder}/grpc.sock", "--web", f"unix:{self.folder}/web.sock"]
    return ["--listen", "127.0.0.1:0", "--web", "127.0.0.1:0", "--tls-cert", self.folder / "tls.crt", "--tls-key", self.folder / "tls.key"]

  def said(self, pattern):
    found = re.search(pattern, self.alvord.log())
    return found and found.group(1)

  def find_addresses(self):
    if self.on_sockets:
      back = (f"unix:{self.folder}/grpc.sock", f"unix:{self.folder}/web.sock")
    else:
      back = (self.said(r"listening on (127\S+)"), re.sub("https?://|/$", "", self.said(r"web page on (\S+)")))
    if self.has_front:
      self.calls = self.web = ("127.0.0.1", self.start_nginx(back))
    else:
      self.calls, self.web = (split_address(address) for address in back)

  def start_nginx(self, back, folder=None, uncommented=()):
    """Starts nginx with the configuration that is shipped, but for its addresses and directories, and lines that are to be uncommented. Returns
    its port."""
    folder, port = folder or self.folder, free_port()
    is_plain = back[0].startswith("unix:")  # else an alvord that takes tokens with TLS alone
    changes = {"/tmp/": f"{folder}/", SOCKETS[0]: back[0], SOCKETS[1]: back[1], "/etc/alvor/tls": str(folder),
               "listen 8443": f"listen 127.0.0.1:{port}"}
    changes |= {} if is_plain else {"grpc://": "grpcs://", "http://alvor_web": "https://alvor_web"}
    changes |= {line: line.removeprefix("# ") for line in uncommented}
    settings = (ROOT / "docker/nginx.conf").read_text()
    for shipped, here in changes.items():
      assert shipped in settings, f"docker/nginx.conf has no {shipped}"
      settings = settings.replace(shipped, here)
    (folder / "nginx.conf").write_text("daemon off;\n" + ("user root;\n" if os.getuid() == 0 else "") + settings)
    nginx = Program(["nginx", "-e", "stderr", "-c", folder / "nginx.conf"], folder / "nginx.log")
    self.fronts.append(nginx)
    until(lambda: is_open(port) or not nginx.is_running(), LONGEST_WAIT, "nginx listens")
    assert nginx.is_running(), f"nginx ended: {nginx.log()[-500:]}"
    return port

  def tls(self, *protocols):
    """A client's TLS that offers these protocols by ALPN."""
    context = ssl.create_default_context(cafile=self.certificate)
    context.set_alpn_protocols(list(protocols))
    return context

  def close(self):
    for program in (*self.fronts, self.alvord):
      program.kill()


def alvord_help():
  return subprocess.run([BINARIES / "alvord", "--help"], capture_output=True, text=True, check=True).stdout


def split_address(address):
  host, port = address.rsplit(":", 1)
  return host, int(port)


def is_open(port):
  try:
    socket.create_connection(("127.0.0.1", port), 1).close()
    return True
  except OSError:
    return False


def make_stubs(folder):
  """Makes Python's messages of the API, and lets them be imported. Not of grpc.health: its package would hide gRPC's own."""
  proto = ROOT / "proto"
  subprocess.run(["protoc", "-I", proto, "--python_out", folder, *sorted((proto / "alvor/v1").glob("*.proto"))], check=True)
  sys.path.insert(0, str(folder))
