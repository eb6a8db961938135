"""Draws a GLB file of the room with Cycles, Blender's path tracer, with diffuse materials as Alvor understands them (docs/surfaces.md).

Run: blender -b --factory-startup --python cycles_room.py -- ROOM.glb PICTURE.png [SAMPLES [EXPOSURE]]
Written for Blender 3.4.1. Also writes PICTURE.exr: radiance in W/m2 sr.
The picture is mapped to screen colours as by `alvor render`. EXPOSURE is the factor by which radiosity in W/m2 is multiplied before;
without it, the script finds it by Alvor's rule (client/picture/tone_map.cpp) from the picture by Cycles.

The camera is that of docs/surfaces.md, and lamps are as bright as with `alvor solve --light-scale 0.001464`.
What the room does not need is not supported: textures other than of base colour and emission, texture transforms, instances of lamps.
"""

import json
import math
import os
import struct
import sys
import zlib

import bpy
import numpy as np
from mathutils import Vector

EYE, TARGET = (1.2, 1.6, 1.6), (-0.4, 1.2, -2.5)  # metres, y up
VERTICAL_FIELD_OF_VIEW = 60  # degrees: what `alvor render` takes inside a room
WIDTH, HEIGHT = 720, 540
LIGHT_SCALE = 0.001464  # 1 / 683: Blender writes 683 cd for 1 W/sr
BACKGROUND = 0.018  # linear; dark grey where nothing is seen, as in client/picture/render.cpp


def z_up(p):
    """Returns a point of glTF in Blender's axes."""
    return Vector((p[0], -p[2], p[1]))


def read_json(path):
    with open(path, "rb") as file:
        data = file.read()
    length, = struct.unpack_from("<I", data, 12)
    return json.loads(data[20:20 + length])


# Materials.

def linear_image(image):
    """Returns a copy of an image with linear values. Cycles blends texels of 8 bits before it makes them linear, glTF says after."""
    width, height = image.size
    texels = np.array(image.pixels[:], dtype=np.float32).reshape(-1, 4)
    colour = texels[:, :3]
    texels[:, :3] = np.where(colour <= 0.04045, colour / 12.92, ((colour + 0.055) / 1.055) ** 2.4)
    copy = bpy.data.images.new(image.name + " linear", width, height, alpha=True, float_buffer=True, is_data=True)
    copy.alpha_mode = "CHANNEL_PACKED"
    copy.pixels = texels.ravel().tolist()
    return copy


class Tree:
    """Builds the node tree of one material anew. Shaders and values are output sockets."""

    def __init__(self, material, images):
        material.use_nodes = True
        self.nodes, self.links, self.images = material.node_tree.nodes, material.node_tree.links, images
        self.nodes.clear()

    def node(self, kind, *inputs, **settings):
        """Adds a node. Of the inputs, in their order, sockets are linked, other values set, and None left alone."""
        node = self.nodes.new("ShaderNode" + kind)
        for key, value in settings.items():
            setattr(node, key, value)
        for socket, value in zip(node.inputs, inputs):
            if isinstance(value, bpy.types.NodeSocket):
                self.links.new(value, socket)
            elif value is not None:
                socket.default_value = value
        return node

    def add(self, *shaders):
        total = shaders[0]
        for shader in shaders[1:]:
            total = self.node("AddShader", total, shader).outputs[0]
        return total

    def mix(self, share, without, full):
        return self.node("MixShader", share, without, full).outputs[0]

    def diffuse(self, colour):
        return self.node("BsdfDiffuse", colour, 0.0).outputs[0]

    def multiply(self, socket, factor):
        return self.node("VectorMath", socket, factor[:3], operation="MULTIPLY").outputs[0]

    def texture(self, info):
        assert set(info) == {"index"}, "textures with a transform or other coordinates are not supported"
        return self.node("TexImage", image=self.images[info["index"]], interpolation="Linear")

    def emission(self, colour, strength):
        return self.node("Emission", colour, strength).outputs[0]

    def finish(self, shader):
        self.node("OutputMaterial", shader)


def rgba(colour, factor=1):
    return [factor * band for band in colour[:3]] + [1]


def front_only(tree, shader):
    """Returns a shader whose back is black and opaque."""
    return tree.mix(tree.node("NewGeometry").outputs["Backfacing"], shader, tree.diffuse((0, 0, 0, 1)))


def clear_behind(tree, shader, through):
    """Returns a shader whose back is another one, `through`, which lets light through and reflects nothing."""
    return tree.mix(tree.node("NewGeometry").outputs["Backfacing"], shader, through)


def build(tree, source, vertex_colours=None):
    """Builds the nodes of a glTF material, given as its JSON. `vertex_colours` names a layer that multiplies the base colour."""
    surface, extensions = source.get("pbrMetallicRoughness", {}), source.get("extensions", {})
    factor = surface.get("baseColorFactor", [1, 1, 1, 1])
    texture = tree.texture(surface["baseColorTexture"]) if "baseColorTexture" in surface else None
    colour = rgba(factor)
    if texture:
        colour = tree.multiply(texture.outputs["Color"], factor)
    if vertex_colours:
        assert not texture
        colour = tree.multiply(tree.node("VertexColor", layer_name=vertex_colours).outputs["Color"], factor)

    transmission = extensions.get("KHR_materials_transmission", {}).get("transmissionFactor", 0)
    scattering = extensions.get("KHR_materials_diffuse_transmission", {})
    share = scattering.get("diffuseTransmissionFactor", 0)
    shader = tree.diffuse(colour)
    if share > 0:
        behind = rgba(scattering.get("diffuseTransmissionColorFactor", [1, 1, 1]))
        shader = tree.mix(share, shader, tree.node("BsdfTranslucent", behind).outputs[0])
    mode = source.get("alphaMode", "OPAQUE")
    two_sided = source.get("doubleSided", False) or share > 0

    light = rgba(source.get("emissiveFactor", [0, 0, 0]))
    if any(light[:3]):
        strength = extensions.get("KHR_materials_emissive_strength", {}).get("emissiveStrength", 1)
        if "emissiveTexture" in source:
            light = tree.multiply(tree.texture(source["emissiveTexture"]).outputs["Color"], light)
        shader = tree.add(shader, tree.emission(light, strength))
    if transmission > 0:
        through = tree.node("BsdfTransparent", colour).outputs[0]
        front = tree.mix(transmission, shader, through)
        absorbing = tree.mix(transmission, tree.diffuse((0, 0, 0, 1)), through)
        shader = front if two_sided else clear_behind(tree, front, absorbing)
    elif not two_sided:
        shader = front_only(tree, shader)
    if mode != "OPAQUE":
        alpha = factor[3]
        if texture:
            alpha = tree.node("Math", texture.outputs["Alpha"], alpha, operation="MULTIPLY").outputs[0]
            if mode == "MASK":
                alpha = tree.node("Math", alpha, source.get("alphaCutoff", 0.5), operation="GREATER_THAN").outputs[0]
        shader = tree.mix(alpha, tree.node("BsdfTransparent", (1, 1, 1, 1)).outputs[0], shader)
    tree.finish(shader)


def make_diffuse(gltf):
    """Replaces all materials by diffuse ones. Meshes without a material get glTF's default one, with their vertex colours."""
    linear = {image.name: linear_image(image) for image in list(bpy.data.images) if image.has_data or image.packed_file}
    images = [linear[gltf["images"][texture["source"]]["name"]] for texture in gltf.get("textures", [])]
    by_name = {material["name"]: material for material in gltf["materials"]}
    for material in bpy.data.materials:
        build(Tree(material, images), by_name[material.name])
    for mesh in bpy.data.meshes:
        if not any(mesh.materials):
            mesh.materials.clear()
            mesh.materials.append(bpy.data.materials.new(mesh.name + " default"))
            build(Tree(mesh.materials[0], images), {}, mesh.color_attributes[0].name if mesh.color_attributes else None)


# Lamps, camera and render.

def spot_share(tree, axis, cone):
    """Returns the share of a spot's intensity that KHR_lights_punctual says: the square of a linear function of the cosine."""
    edge = math.cos(cone["outerConeAngle"])
    width = max(1e-3, math.cos(cone["innerConeAngle"]) - edge)
    # In the shader of a lamp, `Incoming` points from the lamp to the lit place.
    cosine = tree.node("VectorMath", tree.node("NewGeometry").outputs["Incoming"], tuple(axis), operation="DOT_PRODUCT").outputs["Value"]
    line = tree.node("MapRange", cosine, edge, edge + width, 0.0, 1.0, clamp=True).outputs[0]
    return tree.node("Math", line, line, operation="MULTIPLY").outputs[0]


def set_lamps(gltf):
    """Gives lamps the intensities, cones and sharp shadows of the file. Blender's own spots have another edge."""
    lights = {light["name"]: light for light in gltf["extensions"]["KHR_lights_punctual"]["lights"]}
    for lamp in [thing for thing in bpy.data.objects if thing.type == "LIGHT"]:
        source = lights[lamp.data.name]
        lamp.data.color = source.get("color", [1, 1, 1])
        intensity = LIGHT_SCALE * source.get("intensity", 1)
        if source["type"] == "directional":
            lamp.data.energy, lamp.data.angle = intensity, 0
            continue
        lamp.data.type = "POINT"
        data = lamp.data  # a point lamp's watts are those of all directions
        data.energy, data.shadow_soft_size = 4 * math.pi * intensity, 0
        if source["type"] == "spot":
            tree = Tree(data, [])
            axis = lamp.matrix_world.to_quaternion() @ Vector((0, 0, -1))
            tree.node("OutputLight", tree.emission((1, 1, 1, 1), spot_share(tree, axis, source["spot"])))


def set_camera(scene):
    data = bpy.data.cameras.new("View")
    data.sensor_fit, data.angle_y, data.clip_start = "VERTICAL", math.radians(VERTICAL_FIELD_OF_VIEW), 1e-3
    camera = bpy.data.objects.new("View", data)
    camera.location = z_up(EYE)
    camera.rotation_euler = (z_up(TARGET) - z_up(EYE)).to_track_quat("-Z", "Y").to_euler()
    scene.collection.objects.link(camera)
    scene.camera = camera


def render(scene, path, samples):
    """Renders plain paths, without anything that makes them biased, into an EXR file."""
    scene.world = None
    scene.render.engine, scene.cycles.device = "CYCLES", "CPU"
    settings = {"samples": samples, "use_adaptive_sampling": False, "use_denoising": False, "max_bounces": 64, "diffuse_bounces": 32,
                "transmission_bounces": 32, "transparent_max_bounces": 32, "sample_clamp_direct": 0, "sample_clamp_indirect": 0,
                "light_sampling_threshold": 0, "pixel_filter_type": "BOX", "filter_width": 1, "film_exposure": 1}
    for key, value in settings.items():
        setattr(scene.cycles, key, value)
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = WIDTH, HEIGHT, 100
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
    scene.render.image_settings.color_mode, scene.render.filepath = "RGB", path
    bpy.ops.render.render(write_still=True)


# Screen colours, as in client/picture/tone_map.cpp.

def automatic_exposure(radiosity):
    """Returns the exposure by Alvor's rule, from the pixels that Alvor looks at. Emitters are not left out, unlike there."""
    rows, columns = ((np.arange(n) + 0.5) / n * size for n, size in ((72, HEIGHT), (96, WIDTH)))
    pick = np.ix_(rows.astype(int), columns.astype(int))
    luminance = (radiosity @ [0.2126, 0.7152, 0.0722])[pick]
    luminance = np.sort(luminance[luminance > 0])[::-1]
    high = luminance[math.ceil(0.02 * len(luminance)) - 1]
    return min(0.25 / np.exp(np.mean(np.log(np.maximum(luminance, 1e-3 * high)))), 1.2 / high)


def screen_colours(radiosity, exposure):
    """Returns sRGB values in [0, 1] of radiosity in W/m2: a filmic curve (Narkowicz 2015), then sRGB's own."""
    x = np.clip(exposure * radiosity, 0, 1e3)
    linear = np.minimum(1, x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14))
    linear[~radiosity.any(axis=2)] = BACKGROUND
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def read_pixels(path):
    """Returns rows of RGB, the top row first."""
    image = bpy.data.images.load(path)
    return np.array(image.pixels[:], dtype=np.float64).reshape(HEIGHT, WIDTH, 4)[::-1, :, :3]


def write_picture(path, values):
    """Writes sRGB values as PNG, with 7 bits a band: noise does not compress, and the last bit would add a fifth to the file."""
    rows = (2 * np.rint(127 * values)).astype(np.uint8).reshape(HEIGHT, 3 * WIDTH)
    rows[:, 3:] -= rows[:, :-3].copy()  # PNG's filter 1: what a pixel adds to the one on its left
    raw = b"".join(b"\1" + row.tobytes() for row in rows)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", WIDTH, HEIGHT, 8, 2, 0, 0, 0)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b""))


def main():
    arguments = sys.argv[sys.argv.index("--") + 1:]
    room, picture = map(os.path.abspath, arguments[:2])
    samples = int(arguments[2]) if len(arguments) > 2 else 256
    radiance_file = os.path.splitext(picture)[0] + ".exr"
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=room, import_shading="FLAT")
    bpy.context.view_layer.update()
    gltf = read_json(room)
    make_diffuse(gltf)
    set_lamps(gltf)
    set_camera(bpy.context.scene)
    render(bpy.context.scene, radiance_file, samples)
    radiosity = math.pi * read_pixels(radiance_file)
    found = automatic_exposure(radiosity)
    exposure = float(arguments[3]) if len(arguments) > 3 else found
    print(f"exposure {exposure:.4f}; by Alvor's rule {found:.4f}")
    write_picture(picture, screen_colours(radiosity, exposure))


main()
