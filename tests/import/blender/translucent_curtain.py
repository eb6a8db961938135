"""Makes the curtain of a room translucent, which Blender's exporter cannot do: adds KHR_materials_diffuse_transmission to its material.

Run: python3 translucent_curtain.py FILE.glb
A file whose curtain has the extension already stays as it is. The binary chunk is kept byte by byte.
"""

import json
import struct
import sys

EXTENSION = "KHR_materials_diffuse_transmission"
CURTAIN = {"diffuseTransmissionFactor": 0.25, "diffuseTransmissionColorFactor": [0.9, 0.8, 0.6]}
JSON_CHUNK = 0x4E4F534A


def make_translucent(gltf):
    """Adds the extension to the material `Curtain` of parsed glTF. Returns whether anything changed."""
    curtain = next(material for material in gltf["materials"] if material["name"] == "Curtain")
    extensions = curtain.setdefault("extensions", {})
    if EXTENSION in extensions:
        return False
    extensions[EXTENSION] = CURTAIN
    used = gltf.setdefault("extensionsUsed", [])
    if EXTENSION not in used:
        used.append(EXTENSION)
    return True


def patch_glb(path):
    """Makes the curtain of a GLB file translucent."""
    with open(path, "rb") as file:
        data = file.read()
    magic, version, _, length, kind = struct.unpack_from("<4sIIII", data)
    assert magic == b"glTF" and version == 2 and kind == JSON_CHUNK
    gltf, rest = json.loads(data[20:20 + length]), data[20 + length:]
    if not make_translucent(gltf):
        return
    text = json.dumps(gltf, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    with open(path, "wb") as file:
        file.write(struct.pack("<4sIIII", magic, version, 20 + len(text) + len(rest), len(text), kind) + text + rest)


if __name__ == "__main__":
    patch_glb(sys.argv[1])
