"""Floods of HTTP/2 frames by strangers without a token."""

from attack import Bystander, attack
from http2 import (CONTINUATION, DATA, END_HEADERS, HEADERS, PING, PRIORITY, SETTINGS, WINDOW_UPDATE, Http2Stranger, call_headers, frame,
                   resets, small_headers)
from strangers import flood
from target import token_of

FAMILY = "HTTP/2 floods"
LITTLE_MEMORY = ("--memory-limit", "600M")
TOO_MUCH = 1000  # MB of alvord: the promise is broken, and this machine must not suffer more


def stand(target, seconds, block, first=b"", reads=True):
  """Floods while a bystander looks on. Returns what was seen."""
  with Bystander(target) as bystander:
    sent = flood(lambda: Http2Stranger(target), seconds, block, first, reads, lambda: target.alvord.rss() > TOO_MUCH)
  return f"{sent}; {bystander.seen}"


@attack(FAMILY, LITTLE_MEMORY)
def rapid_reset(target, seconds):
  """Streams that are opened and reset at once (CVE-2023-44487) end no solve and take no memory."""
  return stand(target, seconds, resets(None))


@attack(FAMILY, LITTLE_MEMORY)
def rapid_reset_with_a_token(target, seconds):
  """The same by somebody who has a token."""
  return stand(target, seconds, resets(token_of("bob")))


@attack(FAMILY, LITTLE_MEMORY)
def endless_header_value(target, seconds):
  """One header whose value goes on through CONTINUATION frames for ever is not kept."""
  first = frame(HEADERS, 0, 1, call_headers() + b"\0\x03x-y\x7f\xff\xff\xff\xff\x07")
  return stand(target, seconds, lambda _: frame(CONTINUATION, 0, 1, b"a" * 16000), first)


@attack(FAMILY, LITTLE_MEMORY)
def endless_small_headers(target, seconds):
  """Small headers in CONTINUATION frames without end are not kept."""
  return stand(target, seconds, small_headers(), frame(HEADERS, 0, 1, call_headers()))


@attack(FAMILY, LITTLE_MEMORY)
def pings_without_reading(target, seconds):
  """Answers to pings that nobody reads do not pile up."""
  return stand(target, seconds, lambda _: frame(PING, 0, 0, b"12345678") * 1000, reads=False)


@attack(FAMILY, LITTLE_MEMORY)
def settings_without_reading(target, seconds):
  """Acknowledgements of settings that nobody reads do not pile up."""
  return stand(target, seconds, lambda _: frame(SETTINGS, 0, 0, b"\0\4\0\1\0\0") * 1000, reads=False)


@attack(FAMILY, LITTLE_MEMORY)
def empty_data(target, seconds):
  """Frames of DATA without content cost nobody else anything."""
  return stand(target, seconds, lambda _: frame(DATA, 0, 1) * 1000, frame(HEADERS, END_HEADERS, 1, call_headers()))


@attack(FAMILY, LITTLE_MEMORY)
def window_updates(target, seconds):
  """Neither do windows that open byte by byte, nor priorities."""
  block = (frame(WINDOW_UPDATE, 0, 0, b"\0\0\0\1") + frame(PRIORITY, 0, 3, b"\0\0\0\0\1")) * 500
  return stand(target, seconds, lambda _: block)
