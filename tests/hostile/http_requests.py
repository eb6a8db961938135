"""Requests of HTTP/1.1 that are too long, contradict themselves, or hide another."""

from attack import Bystander, attack
from calls import path_of
from slowness import fetch_page
from strangers import Stranger, flood

FAMILY = "HTTP/1.1"
LITTLE_MEMORY = ("--memory-limit", "600M")


def connect(target):
  return Stranger(target, target.web, "http/1.1")


def host(target):
  return b"Host: localhost:%d\r\n" % target.web[1]


def post(target):
  return b"POST %s HTTP/1.1\r\n%sContent-Type: application/grpc-web+proto\r\n" % (path_of("ListScenes").encode(), host(target))


def stand(target, seconds, first, block):
  with Bystander(target) as bystander:
    sent = flood(lambda: connect(target), seconds, lambda _: block, first, reads=False)
    fetch_page(target)
  return f"{sent}; {bystander.seen}"


@attack(FAMILY, LITTLE_MEMORY)
def endless_header_line(target, seconds):
  """A header line without end is not kept, and ends no solve."""
  return stand(target, seconds, b"GET / HTTP/1.1\r\n" + host(target) + b"X: ", b"a" * 65536)


@attack(FAMILY, LITTLE_MEMORY)
def endless_header_lines(target, seconds):
  """Header lines without end are not kept, and end no solve."""
  return stand(target, seconds, b"GET / HTTP/1.1\r\n" + host(target), b"X-a: b\r\n" * 8192)


@attack(FAMILY, LITTLE_MEMORY)
def endless_request_line(target, seconds):
  """A path without end is not kept."""
  return stand(target, seconds, b"GET /", b"a" * 65536)


@attack(FAMILY, LITTLE_MEMORY)
def endless_chunk_size(target, seconds):
  """The line of a chunk's size without end is not kept."""
  return stand(target, seconds, post(target) + b"Transfer-Encoding: chunked\r\n\r\n", b"1" * 65536)


@attack(FAMILY, LITTLE_MEMORY)
def body_without_a_token(target, seconds):
  """A long body without a token is not kept."""
  return stand(target, seconds, post(target) + b"Content-Length: 9999999999\r\n\r\n\0\x04\0\0\0", b"1" * 65536)


def smuggled(target):
  """Requests by what they hide. Each ends with a second request, for /icon.svg, that must not be answered."""
  empty = b"\0\0\0\0\0"
  inner = b"GET /icon.svg HTTP/1.1\r\n" + host(target) + b"\r\n"
  chunked = b"Transfer-Encoding: chunked\r\n"
  return {
      "length and chunks": b"Content-Length: 5\r\n" + chunked + b"\r\n0\r\n\r\n" + inner,
      "two lengths": b"Content-Length: 5\r\nContent-Length: 10\r\n\r\n" + empty + inner,
      "unknown coding": b"Transfer-Encoding: xchunked\r\n\r\n" + inner,
      "two codings": b"Transfer-Encoding: identity, chunked\r\n\r\n5\r\n" + empty + b"\r\n0\r\n\r\n" + inner,
      "negative length": b"Content-Length: -1\r\n\r\n" + inner,
      "length in letters": b"Content-Length: abc\r\n\r\n" + inner,
      "negative chunk": chunked + b"\r\n-1\r\n" + inner,
      "huge chunk": chunked + b"\r\nffffffffffffffff\r\n" + inner,
      "blank before colon": b"Content-Length : 5\r\n\r\n" + empty + inner,
  }


@attack(FAMILY)
def smuggling(target, seconds):
  """Of a request whose length is told twice or wrongly, nothing is taken for a second request."""
  answered = []
  for what, rest in smuggled(target).items():
    stranger = connect(target)
    stranger.send(post(target) + rest)
    if b"image/svg" in stranger.receive(0.3):
      answered.append(what)
    stranger.close()
  fetch_page(target)
  assert not answered, f"answered twice: {', '.join(answered)}"
  return f"{len(smuggled(target))} forms refused or read as one"


@attack(FAMILY)
def foreign_pages(target, seconds):
  """A page of another origin cannot call, nor can paths leave the page's directory."""
  call = post(target) + b"Origin: https://evil.example\r\nContent-Length: 5\r\n\r\n\0\0\0\0\0"
  paths = (b"/../../../etc/passwd", b"/%2e%2e/%2e%2e/etc/passwd", b"/assets/..%2f..%2f..%2fetc/passwd", b"//etc/passwd")
  requests = [call] + [b"GET " + path + b" HTTP/1.1\r\n" + host(target) + b"\r\n" for path in paths]
  for request in requests:
    stranger = connect(target)
    stranger.send(request)
    answer = stranger.receive(0.3)
    stranger.close()
    assert b" 200 " not in answer[:40] and b"root:" not in answer, f"{request[:60]!r}: {answer[:40]!r}"
  return "403 for the call, 400 or 404 for the paths"


@attack(FAMILY)
def not_http(target, seconds):
  """What is no HTTP, or no TLS, ends its own connection only."""
  begin = (b"\x16\x03\x01\x02\0\x01\0\x01\xfc\x03\x03" + bytes(range(256)), b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n", b"\0" * 1000,
           b"GET / HTTP/1.1\nHost: a\n\n", b"GET / HTTP/1.1\r\nX: \0\r\n\r\n", b"GET http://evil.example/ HTTP/1.1\r\n\r\n")
  with Bystander(target) as bystander:
    for content in begin:
      for protocol in (None, "http/1.1"):
        stranger = Stranger(target, target.web, protocol)
        stranger.send(content)
        stranger.receive(0.1)
        stranger.close()
    fetch_page(target)
  return bystander.seen
