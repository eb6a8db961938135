"""Decodes frames of a watched solve by docs/frame-format.md, and keeps a mirror of its leaves. Needs nothing of Alvor's."""

import struct

import zstandard

FINEST = 15
DISPLAY, EXACT = 1, 2  # alvor.v1.Detail


class FrameError(Exception):
  """A frame contradicts itself or the mirror."""


def level_of(patch):
  low = patch & 0xFFFFFFFF
  return FINEST - ((low & -low).bit_length() - 1) // 2


def child_of(patch, k):
  bit = patch & -patch
  return patch - bit + (2 * k + 1) * (bit >> 2)


def patch_at(position, level):
  """The patch of `level` that begins at `position` on the curve of finest patches."""
  face, path = divmod(position, 4**FINEST)
  return face << 32 | path << 1 | 1 << 2 * (FINEST - level)


def read_ids(raw, count):
  """The ids, and how many bytes they took."""
  ids, at, level, end = [], 0, 0, 0
  for _ in range(count):
    number = shift = 0
    while True:
      byte = raw[at]
      at += 1
      number |= (byte & 0x7F) << shift
      shift += 7
      if byte < 0x80:
        break
    code = number & 7
    if code == 7:
      level = raw[at]
      at += 1
    else:
      level += -(code + 1) // 2 if code & 1 else code // 2
    size = 4 ** (FINEST - level)
    first = -(-end // size) * size + (number >> 3) * size
    ids.append(patch_at(first, level))
    end = first + size
  return ids, at


def planes(raw, start, count, leaf, word):
  """The four bytes of a word, each from its plane."""
  return [raw[start + (4 * word + k) * count + leaf] for k in range(4)]


def guess(before, exponent, shift):
  mantissa, finer = before >> shift & 511, (before >> 27) - exponent
  return min(mantissa << finer, 511) if finer >= 0 else mantissa >> -finer


def read_display(raw, start, count, scale):
  before = 0
  for leaf in range(count):
    r, g, b, top = planes(raw, start, count, leaf, 0)
    folded = [r | (top >> 2 & 1) << 8, g | (top >> 1 & 1) << 8, b | (top & 1) << 8]
    change = [511 - x // 2 if x & 1 else x // 2 for x in folded]
    change = [change[0] + change[1], change[1], change[2] + change[1]]
    exponent, word = top >> 3, (top >> 3) << 27
    for band in range(3):
      word |= (guess(before, exponent, 9 * band) + change[band] & 511) << 9 * band
    before = word
    yield tuple((word >> 9 * band & 511) * 2.0 ** (exponent + scale) for band in range(3))


def read_exact(raw, start, count):
  before = [0, 0, 0]
  for leaf in range(count):
    for band in range(3):
      difference = int.from_bytes(bytes(planes(raw, start, count, leaf, band)), "little")
      before[band] = before[band] + difference & 0xFFFFFFFF
    yield struct.unpack("<3f", struct.pack("<3I", *before))


def decode_leaves(message):
  """Of a LeafValues message: (id, (r, g, b)) of each leaf, ascending."""
  if message.count == 0:
    return []
  if message.raw_size > 262144 or message.count > 52428:
    raise FrameError("a frame that large is none")
  raw = zstandard.ZstdDecompressor().decompress(message.zstd, max_output_size=message.raw_size)
  ids, start = read_ids(raw, message.count)
  if message.detail == DISPLAY:
    return list(zip(ids, read_display(raw, start, message.count, message.scale)))
  return list(zip(ids, read_exact(raw, start, message.count)))


def finished(x):
  x = (x ^ x >> 16) * 0x85EBCA6B & 0xFFFFFFFF
  x = (x ^ x >> 13) * 0xC2B2AE35 & 0xFFFFFFFF
  return x ^ x >> 16


def hash_of(leaves):
  """The state hash of a dictionary of leaves."""
  upper = lower = 0
  for patch, irradiance in leaves.items():
    a, b = 0x9E3779B9, 0x85EBCA6B
    for word in (patch >> 32, patch & 0xFFFFFFFF, *struct.unpack("<3I", struct.pack("<3f", *irradiance))):
      a = (a ^ word) * 0x9E3779B1 & 0xFFFFFFFF
      a ^= a >> 15
      b = (b ^ word) * 0x85EBCA77 & 0xFFFFFFFF
      b ^= b >> 13
    upper, lower = upper + finished(a), lower + finished(b)
  return (upper & 0xFFFFFFFF) << 32 | lower & 0xFFFFFFFF


class Mirror:
  """The leaves of a solve: a dictionary from patch id to irradiance (r, g, b) in W/m2."""

  def __init__(self):
    self.leaves, self.inner, self.revision, self.epoch = {}, set(), 0, ""

  def apply(self, frame):
    if frame.reset:
      self.__init__()
    self.epoch = frame.epoch
    if frame.from_revision != self.revision:
      raise FrameError(f"the frame begins at {frame.from_revision}, the mirror is at {self.revision}")
    for patch, irradiance in decode_leaves(frame.leaves):
      self._split_down_to(patch)
      self._merge_within(patch)
      self.leaves[patch] = irradiance
    self.revision = frame.to_revision
    if frame.HasField("state_hash") and frame.state_hash != hash_of(self.leaves):
      raise FrameError("the mirror is not what the server has")

  def _merge_within(self, patch):
    if patch not in self.inner:
      return
    self.inner.remove(patch)
    for k in range(4):
      self._merge_within(child_of(patch, k))
      self.leaves.pop(child_of(patch, k), None)

  def _split_down_to(self, patch):
    if patch in self.leaves or patch in self.inner:
      return
    path = patch & 0xFFFFFFFF
    ancestors = []
    for level in range(level_of(patch)):
      bit = 1 << 2 * (FINEST - level)
      ancestors.append(patch & ~0xFFFFFFFF | path & ~(2 * bit - 1) | bit)
    inherited = (0.0, 0.0, 0.0)
    for above, below in zip(ancestors, ancestors[1:] + [patch]):
      inherited = self.leaves.pop(above, inherited)
      if above in self.inner:
        inherited = self.leaves.get(below, inherited)
        continue
      self.inner.add(above)
      for k in range(4):
        if child_of(above, k) != below:
          self.leaves[child_of(above, k)] = inherited
