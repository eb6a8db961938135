"""Decodes frames of a watched solve by docs/frame-format.md, and keeps a mirror of its leaves. Needs nothing of Alvor's."""

import struct

import zstandard

FINEST = 15
FACES = 2**22
QUARTERS, SLABS_ALONG_U, SLABS_ALONG_V = range(3)  # how a patch is split into four
DISPLAY, EXACT = 1, 2  # alvor.v1.Detail


class FrameError(Exception):
  """A frame contradicts itself or the mirror."""


def level_of(patch):
  low = patch & 0xFFFFFFFF
  return FINEST - ((low & -low).bit_length() - 1) // 2


def face_of(patch):
  return patch >> 32 & FACES - 1


def place_of(patch):
  """The id without the slab code in its upper ten bits. Leaves are sorted by it."""
  return patch & (1 << 54) - 1


def slab_splits(patch):
  """Of each ancestor that was split into slabs: its level, how, and the bits of the slab code that say so."""
  for shift in (54, 59):
    code = patch >> shift & 31
    if code:
      yield (code - 1) // 2, SLABS_ALONG_U + (code - 1) % 2, code << shift


def split_above(patch, level):
  """How the ancestor at `level` - 1 is split."""
  return next((how for above, how, _ in slab_splits(patch) if above == level - 1), QUARTERS)


def ancestor_of(patch, level):
  bit = 1 << 2 * (FINEST - level)
  return place_of(patch) & ~(2 * bit - 1) | bit | sum(code for above, _, code in slab_splits(patch) if above < level)


def sibling_of(patch, k):
  """Child `k` of the patch's parent."""
  bit = patch & -patch
  return patch & ~(6 * bit) | 2 * k * bit


def child_of(patch, k, how):
  bit = patch & -patch
  code = 0 if how == QUARTERS else 2 * level_of(patch) + how
  return patch - bit + (2 * k + 1) * (bit >> 2) | code << (59 if patch >> 54 else 54)


def patch_at(position, level):
  """The patch of `level` that begins at `position` on the curve of finest patches, without slabs."""
  face, path = divmod(position, 4**FINEST)
  return face << 32 | path << 1 | 1 << 2 * (FINEST - level)


def guessed_slabs(patch, before):
  """The slab code that the leaf before tells: of common ancestors; others are split into quarters."""
  if before is None or face_of(before) != face_of(patch):
    return 0
  begins = [x - (x & -x) & 0xFFFFFFFF for x in (patch, before)]
  common = (31 - (begins[0] ^ begins[1]).bit_length()) // 2
  return ancestor_of(before, common + 1) >> 54


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
    code, slabs = number & 7, None
    if code == 7:
      level = raw[at] & 0x7F
      at += 1
      if raw[at - 1] & 0x80:
        slabs = raw[at] | raw[at + 1] << 8
        at += 2
    else:
      level += -(code + 1) // 2 if code & 1 else code // 2
    size = 4 ** (FINEST - level)
    first = -(-end // size) * size + (number >> 3) * size
    patch = patch_at(first, level)
    if slabs is None:
      slabs = guessed_slabs(patch, ids[-1] if ids else None)
    ids.append(patch | slabs << 54)
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
    self.leaves, self.inner, self.revision, self.epoch = {}, {}, 0, ""  # inner: how patches are split

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
    """Makes a patch one leaf, which inherits from the first in it."""
    if patch not in self.inner:
      return
    how = self.inner.pop(patch)
    children = [child_of(patch, k, how) for k in range(4)]
    for child in children:
      self._merge_within(child)
    self.leaves[patch] = [self.leaves.pop(child) for child in children][0]

  def _split_down_to(self, patch):
    ancestors = [ancestor_of(patch, level) for level in range(level_of(patch) + 1)]
    if ancestors[0] not in self.inner:
      self.leaves.setdefault(ancestors[0], (0.0, 0.0, 0.0))
    for level, (above, below) in enumerate(zip(ancestors, ancestors[1:]), 1):
      how = split_above(patch, level)
      if self.inner.get(above, how) != how:  # as after a solve has begun anew
        self._merge_within(above)
      if above not in self.inner:
        self.inner[above] = how
        inherited = self.leaves.pop(above)
        self.leaves.update((sibling_of(below, k), inherited) for k in range(4))
