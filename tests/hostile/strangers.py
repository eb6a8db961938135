"""Connections of strangers. They come from addresses of their own (127.0.0.66), so that limits by address do not meet the others."""

import contextlib
import socket
import time


class Stranger:
  """One connection, by TLS where `protocol` is given, from `address` unless it is None. Whatever the other side does to it is no error."""

  def __init__(self, target, to, protocol=None, address="127.0.0.66"):
    self.is_open, self.sent = False, 0
    with contextlib.suppress(OSError):
      self.socket = socket.create_connection(to, 2, source_address=address and (address, 0))
      if protocol:
        self.socket = target.tls(protocol).wrap_socket(self.socket, server_hostname="localhost")
      self.socket.settimeout(1)
      self.is_open = True

  def send(self, content):
    """Returns whether the connection is open and all was taken."""
    try:
      if self.is_open:
        self.socket.settimeout(1)
        self.socket.sendall(content)
        self.sent += len(content)
    except OSError:
      self.close()
    return self.is_open

  def skip_answers(self):
    """Reads what has come, so that the other side may go on writing."""
    try:
      self.socket.settimeout(0)
      while self.is_open:
        if not self.socket.recv(1 << 16):
          self.close()
    except BlockingIOError:
      pass
    except OSError as reason:  # SSLWantReadError is one, and means that there is nothing more
      if "WantRead" not in type(reason).__name__:
        self.close()

  def receive(self, seconds, enough=1 << 20):
    """Returns what comes until it ends, is enough, or the time is over."""
    content, end = b"", time.monotonic() + seconds
    with contextlib.suppress(OSError):
      while self.is_open and len(content) < enough and time.monotonic() < end:
        self.socket.settimeout(max(0.01, end - time.monotonic()))
        piece = self.socket.recv(1 << 16)
        if not piece:
          break
        content += piece
    return content

  def is_closed_by_the_other(self, seconds):
    """Whether the other side ends the connection within this time."""
    end = time.monotonic() + seconds
    while self.is_open and time.monotonic() < end:
      self.skip_answers()
      time.sleep(0.02)
    return not self.is_open

  def close(self):
    self.is_open = False
    with contextlib.suppress(OSError, AttributeError):
      self.socket.close()


def flood(connect, seconds, block, first=b"", reads=True, is_enough=lambda: False):
  """Sends `first` and then block(0), block(1), ... until the time is over or it is enough, on a new connection where one was closed. Returns
  what was sent, in words."""
  end, sent, blocks, connections = time.monotonic() + seconds, 0, 0, 0
  while time.monotonic() < end and not is_enough():
    stranger, number = connect(), 0
    connections += 1
    stranger.send(first)
    while time.monotonic() < end and stranger.send(block(number)) and not (number % 50 == 0 and is_enough()):
      number += 1
      if reads:
        stranger.skip_answers()
    blocks, sent = blocks + number, sent + stranger.sent
    stranger.close()
    time.sleep(0.005)
  return f"{sent / 1e6:.1f} MB in {blocks} blocks on {connections} connections"
