"""Makes one furnished room in Blender, exports it with Blender's own exporters and writes what Blender itself says of it.

Run: blender -b --factory-startup --python make_room.py -- OUTDIR [PICTURE.png]
Written for Blender 3.4.1. With PICTURE.png it also renders the room, to look at; the exported files do not depend on that.
"""

import datetime
import json
import math
import os
import re
import struct
import sys
import unittest.mock
import zlib

import bpy

# The exporters put Python sets and hashes of names into their files: strings must hash alike in every run.
if sys.flags.hash_randomization:
    os.environ["PYTHONHASHSEED"] = "0"
    os.execv(bpy.app.binary_path, [bpy.app.binary_path, "--python-use-system-env", *sys.argv[1:]])

import numpy as np
from mathutils import Matrix, Vector

sys.dont_write_bytecode = True  # no folder of it beside this script
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import translucent_curtain

arguments = sys.argv[sys.argv.index("--") + 1:]
OUT = os.path.abspath(arguments[0])
PICTURE = os.path.abspath(arguments[1]) if len(arguments) > 1 else None

WIDTH, DEPTH, HEIGHT = 4.0, 5.0, 2.8  # metres, along x, y and z; the floor's centre is the origin
TEXELS = 32  # a side of every image
VERTEX_COLOUR = (0.5, 0.2, 0.1)  # of the one object that has no material, linear


# Images.

def write_png(name, rows):
    """Writes rows of RGB or RGBA byte tuples, the top row first, as OUT/name."""
    channels = len(rows[0][0])
    raw = b"".join(b"\0" + bytes(value for texel in row for value in texel) for row in rows)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 2 if channels == 3 else 6, 0, 0, 0)
    with open(os.path.join(OUT, name), "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b""))


def linear(byte):
    """Returns the linear value of an sRGB byte."""
    value = byte / 255
    return value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4


def make_images():
    """Writes the images and returns them by name, each with the mean of its linear texels."""
    n = range(TEXELS)
    pictures = {
        "floor_checker.png": [[(200, 190, 170) if (x // 8 + y // 8) % 2 else (90, 60, 40) for x in n] for y in n],
        "wall paper.png": [[(120 + 4 * x, 200 - 2 * y, 180) for x in n] for y in n],
        "wood.png": [[(150 + (7 * x + 3 * y) % 20, 105 + (7 * x + 3 * y) % 14, 60) for x in n] for y in n],
        "leaf.png": [[(60, 150, 50, 255 if abs(x - 15.5) < 14 * math.sin(math.pi * (y + 0.5) / TEXELS) else 0) for x in n] for y in n],
        "screen.png": [[(30 + 6 * x, 60, 250 - 6 * y) for x in n] for y in n],
    }
    images, means = {}, {}
    for name, rows in pictures.items():
        write_png(name, rows)
        images[name] = bpy.data.images.load(os.path.join(OUT, name))
        images[name].name = name
        texels = [texel for row in rows for texel in row]
        means[name] = [sum(linear(texel[c]) for texel in texels) / len(texels) for c in range(3)]
        if len(texels[0]) == 4:
            means[name].append(sum(texel[3] for texel in texels) / (255 * len(texels)))
    return images, means


# Materials.

def principled(name, colour, *, roughness=0.8, image=None, two_sided=False, emission=None, strength=1.0, emission_image=None, **inputs):
    """Makes a material of Blender's Principled BSDF. `colour` is linear RGB; `inputs` sets further sockets, such as Metallic."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    material.use_backface_culling = not two_sided
    nodes, links = material.node_tree.nodes, material.node_tree.links
    shader = nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*colour, 1)
    material.diffuse_color = (*colour, 1)
    shader.inputs["Roughness"].default_value = roughness
    for socket, value in inputs.items():
        shader.inputs[socket].default_value = value

    def texture(image):
        node = nodes.new("ShaderNodeTexImage")
        node.image = image
        return node

    if image:
        node = texture(image)
        links.new(node.outputs["Color"], shader.inputs["Base Color"])
        if image.depth == 32:  # 24 without alpha
            links.new(node.outputs["Alpha"], shader.inputs["Alpha"])
            material.blend_method, material.alpha_threshold = "CLIP", 0.5
    elif inputs.get("Alpha", 1) < 1:
        material.blend_method = "BLEND"
    if emission:
        shader.inputs["Emission"].default_value = (*emission, 1)
        shader.inputs["Emission Strength"].default_value = strength
    if emission_image:
        links.new(texture(emission_image).outputs["Color"], shader.inputs["Emission"])
        shader.inputs["Emission Strength"].default_value = strength
    return material


def make_materials(images):
    """Returns the room's materials by a short key. Some names hold spaces or letters beyond ASCII, as people's names do."""
    return {
        "white": principled("Wandfarbe weiß", (0.8, 0.8, 0.78)),
        "paper": principled("Wall paper", (1, 1, 1), image=images["wall paper.png"]),
        "floor": principled("Floor tiles", (1, 1, 1), image=images["floor_checker.png"], roughness=0.5),
        "wood": principled("Wood", (1, 1, 1), image=images["wood.png"], roughness=0.6),
        "fabric": principled("Fabric.red", (0.45, 0.08, 0.06)),
        "books": principled("Books", (0.12, 0.2, 0.35)),
        "steel": principled("Brushed steel", (0.77, 0.78, 0.78), roughness=0.3, Metallic=1.0),
        "glass": principled("Window glass", (0.95, 0.98, 0.96), roughness=0.0, Transmission=1.0, IOR=1.45),
        "curtain": principled("Curtain", (0.6, 0.55, 0.4), two_sided=True),
        "leaf": principled("Leaf", (1, 1, 1), image=images["leaf.png"], two_sided=True),
        "gauze": principled("Gauze", (0.7, 0.7, 0.7), two_sided=True, Alpha=0.4),
        "panel": principled("Lamp panel", (0.2, 0.2, 0.2), emission=(1.0, 0.9, 0.7), strength=15.0),
        "screen": principled("Screen", (0.02, 0.02, 0.02), emission_image=images["screen.png"], strength=2.0),
        "glow": principled("Night light", (0.5, 0.5, 0.5), emission=(0.2, 0.5, 0.9), strength=0.5),
    }


# Meshes.

def mesh_of(name, vertices, faces, materials=(), *, slots=None, edges=(), uv=None):
    """Makes a mesh. `slots` gives each face's material slot; `uv` maps a vertex position to texture coordinates."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices, edges, faces)
    for material in materials:
        mesh.materials.append(material)
    if slots:
        mesh.polygons.foreach_set("material_index", slots)
    if uv:
        layer = mesh.uv_layers.new(name="UVMap")
        for loop in mesh.loops:
            layer.data[loop.index].uv = uv(*mesh.vertices[loop.vertex_index].co)
    return mesh


def boxes(*corners):
    """Returns vertices and outward faces of closed boxes, each given by its lower and upper corner."""
    vertices, faces = [], []
    for (x0, y0, z0), (x1, y1, z1) in corners:
        n = len(vertices)
        vertices += [(x0, y0, z0), (x1, y0, z0), (x1, y1, z0), (x0, y1, z0), (x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1)]
        faces += [tuple(n + i for i in face) for face in
                  ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))]
    return vertices, faces


def wall_with_hole(length, hole):
    """Returns a wall in its own plane, x to the right and z up, as the cells of a grid around a hole (x0, z0, x1, z1), facing -y."""
    xs = sorted({0, hole[0], hole[2], length})
    zs = sorted({0, hole[1], hole[3], HEIGHT})
    vertices = [(x, 0, z) for z in zs for x in xs]
    n = len(xs)
    faces = [(j * n + i, j * n + i + 1, (j + 1) * n + i + 1, (j + 1) * n + i) for j in range(len(zs) - 1) for i in range(n - 1)
             if not (hole[0] <= xs[i] < hole[2] and hole[1] <= zs[j] < hole[3])]
    return vertices, faces


def add(name, data, *, at=(0, 0, 0), turn=(0, 0, 0), scale=(1, 1, 1), parent=None):
    """Adds an object of mesh, lamp, camera or nothing. `at` is in metres and `turn` in degrees, in its parent's frame."""
    thing = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(thing)
    thing.location, thing.scale, thing.parent = at, scale, parent
    thing.rotation_euler = [math.radians(angle) for angle in turn]
    return thing


def shell(m):
    """Adds floor, ceiling and walls: single faces, counter-clockwise seen from inside."""
    x, y, z = WIDTH / 2, DEPTH / 2, HEIGHT
    along = lambda px, py, pz: (px + x, py + y)  # one image to a square metre
    add("Floor", mesh_of("Floor", [(-x, -y, 0), (x, -y, 0), (x, y, 0), (-x, y, 0)], [(0, 1, 2, 3)], [m["floor"]], uv=along))
    add("Ceiling", mesh_of("Ceiling", [(-x, -y, z), (x, -y, z), (x, y, z), (-x, y, z)], [(3, 2, 1, 0)], [m["white"]], uv=along))
    add("Wall west", mesh_of("Wall west", [(-x, -y, 0), (-x, y, 0), (-x, y, z), (-x, -y, z)], [(0, 1, 2, 3)], [m["paper"]],
                             uv=lambda px, py, pz: ((py + y) / 1.25, pz / 1.4)))  # 4 by 2 whole images
    add("Wall east", mesh_of("Wall east", [(x, -y, 0), (x, -y, z), (x, y, z), (x, y, 0)], [(0, 1, 2, 3)], [m["white"]]))
    window, door = (1.2, 0.9, 2.8, 2.1), (0.5, 0.0, 1.4, 2.1)
    add("Wall north", mesh_of("Wall north", *wall_with_hole(WIDTH, window), [m["white"]]), at=(-x, y, 0))
    add("Wall south", mesh_of("Wall south", *wall_with_hole(WIDTH, door), [m["white"]]), at=(x, -y, 0), turn=(0, 0, 180))
    x0, z0, x1, z1 = window
    reveal = [(px, py, pz) for py in (0, 0.2) for px, pz in ((x0, z0), (x1, z0), (x1, z1), (x0, z1))]
    add("Window reveal", mesh_of("Window reveal", reveal, [(i, (i + 1) % 4, (i + 1) % 4 + 4, i + 4) for i in range(4)], [m["white"]]),
        at=(-x, y, 0))
    add("Pane", mesh_of("Pane", *boxes(((x0, 0.09, z0), (x1, 0.1, z1))), [m["glass"]]), at=(-x, y, 0))


def dining_group(m):
    """Adds a table and six chairs that share one mesh, under an empty that is turned and moved."""
    group = add("Dining group", None, at=(0.35, -0.4, 0), turn=(0, 0, 20))
    flat = lambda x, y, z: (x, y)
    top = add("Table top", mesh_of("Table top", *boxes(((-0.8, -0.45, 0.7), (0.8, 0.45, 0.74))), [m["wood"]], uv=flat), parent=group)
    bevel = top.modifiers.new("Bevel", "BEVEL")
    bevel.width, bevel.segments = 0.01, 1
    legs = add("Table legs", mesh_of("Table leg", *boxes(((0.68, 0.34, 0), (0.74, 0.4, 0.7))), [m["wood"]], uv=flat), parent=top)
    mirror = legs.modifiers.new("Mirror", "MIRROR")
    mirror.use_axis = (True, True, False)

    # One arm rest only, so that a mirrored chair differs from a turned one.
    parts = [((-0.2, -0.2, 0.42), (0.2, 0.2, 0.46)), ((-0.2, 0.17, 0.46), (0.2, 0.2, 0.9)), ((0.17, -0.15, 0.6), (0.2, 0.17, 0.63))]
    parts += [((x, -0.18, 0), (x + 0.03, 0.18, 0.42)) for x in (-0.2, 0.17)]
    slots = [0] * 6 + [1] * (6 * (len(parts) - 1))
    chair = mesh_of("Chair", *boxes(*parts), [m["fabric"], m["wood"]], slots=slots, uv=flat)
    add("Chair", chair, at=(-0.35, 0.65, 0), parent=group)
    add("Chair.001", chair, at=(0.4, 0.7, 0), turn=(0, 0, -12), parent=group)
    add("Chair.002", chair, at=(-0.4, -0.65, 0), turn=(0, 0, 180), parent=group)
    add("Chair.003", chair, at=(0.35, -0.7, 0), turn=(0, 0, 170), parent=group)
    add("Chair mirrored", chair, at=(1.15, 0, 0), turn=(0, 0, -90), scale=(-1, 1, 1), parent=group)
    add("Chair stretched", chair, at=(-1.2, 0, 0), turn=(0, 0, 90), scale=(1.2, 0.8, 1.15), parent=group)

    # A turned child of a stretched parent: its world matrix shears.
    stretch = add("Stretch", None, at=(-1.5, -1.7, 0), scale=(1, 1.5, 1))
    add("Sheared stool", mesh_of("Stool", *boxes(((-0.2, -0.2, 0), (0.2, 0.2, 0.45))), [m["fabric"]]), turn=(0, 0, 30), parent=stretch)

    kettle = [(0.09 * math.cos(i * math.pi / 3), 0.09 * math.sin(i * math.pi / 3), z) for z in (0, 0.2) for i in range(6)]
    sides = [(i, (i + 1) % 6, (i + 1) % 6 + 6, i + 6) for i in range(6)]
    add("Kettle", mesh_of("Kettle", kettle, [(5, 4, 3, 2, 1, 0), (6, 7, 8, 9, 10, 11), *sides], [m["steel"]]), at=(-0.4, 0.1, 0.74), parent=top)
    add("Napkin", mesh_of("Napkin", [(0, 0, 0), (0.3, 0, 0), (0.3, 0.3, 0.03), (0, 0.3, 0)], [(0, 1, 2, 3)], [m["white"]]),
        at=(0.2, -0.2, 0.745), parent=top)


def furniture(m):
    """Adds what stands along the walls, and the faces that emit light."""
    shelf = add("Shelf", mesh_of("Shelf", *boxes(((-0.15, -0.6, 1.2), (0.15, 0.6, 1.23))), [m["wood"]], uv=lambda x, y, z: (y, x)),
                at=(1.85, 1.2, 0))
    books = add("Bücher", mesh_of("Book", *boxes(((-0.1, -0.55, 0), (0.1, -0.51, 0.25))), [m["books"]]), at=(0, 0, 1.231), parent=shelf)
    array = books.modifiers.new("Array", "ARRAY")
    array.count, array.relative_offset_displace = 8, (0, 1.1, 0)
    pouf = add("Pouf", mesh_of("Pouf", *boxes(((-0.3, -0.3, 0), (0.3, 0.3, 0.45))), [m["fabric"]]), at=(-1.3, 1.4, 0))
    smooth = pouf.modifiers.new("Subdivision", "SUBSURF")
    smooth.levels = smooth.render_levels = 1
    for polygon in pouf.data.polygons:
        polygon.use_smooth = True
    block = mesh_of("Block", *boxes(((-0.1, -0.1, 0), (0.1, 0.1, 0.3))))
    for corner in block.color_attributes.new("Col", "BYTE_COLOR", "CORNER").data:
        corner.color = (*VERTEX_COLOUR, 1)
    add("Unpainted block", block, at=(1.7, -2.2, 0))

    y = lambda i: 0.06 if i % 2 else 0.0
    curtain = [(0.1 * i, y(i), z) for z in (0.1, 2.4) for i in range(7)]
    add("Curtain", mesh_of("Curtain", curtain, [(i, i + 1, i + 8, i + 7) for i in range(6)], [m["curtain"]]), at=(-1.45, 2.3, 0))
    add("Gauze", mesh_of("Gauze", [(0, 0, 0.5), (0.6, 0, 0.5), (0.6, 0, 2.4), (0, 0, 2.4)], [(0, 1, 2, 3)], [m["gauze"]]), at=(0.3, 2.35, 0))
    leaf = mesh_of("Leaf", [(-0.1, 0, 0), (0.1, 0, 0), (0.1, 0, 0.3), (-0.1, 0, 0.3)], [(0, 1, 2, 3)], [m["leaf"]],
                   uv=lambda x, y, z: ((x + 0.1) / 0.2, z / 0.3))
    for i in range(3):
        add(f"Leaf.{i:03}", leaf, at=(-1.7, 2.2, 0.3), turn=(30, 0, 60 * i))
    arrow = [(0, 0, 0), (0.5, 0, 0), (0.25, 0, 0.15), (0.5, 0, 0.5), (0, 0, 0.3)]
    add("Concave sign", mesh_of("Concave sign", arrow, [(0, 1, 2, 3, 4)], [m["books"]]), at=(1.99, 0.1, 1.7), turn=(0, 0, -90))

    panel = add("Lamp panel", mesh_of("Lamp panel", [(-0.6, -0.3, 0), (0.6, -0.3, 0), (0.6, 0.3, 0), (-0.6, 0.3, 0)], [(3, 2, 1, 0)],
                                      [m["panel"]]), at=(0, 0, 2.77))
    panel["alvor_note"] = "a custom property of Blender"
    panel["alvor_lumens"] = 4200.0
    add("Screen", mesh_of("Screen", [(0, -0.4, 0), (0, -0.4, 0.5), (0, 0.4, 0.5), (0, 0.4, 0)], [(0, 1, 2, 3)], [m["screen"]],
                          uv=lambda x, y, z: ((y + 0.4) / 0.8, z / 0.5)), at=(1.98, -1.0, 1.2))
    add("Night light", mesh_of("Night light", *boxes(((-0.03, -0.02, 0), (0.03, 0.02, 0.08))), [m["glow"]]), at=(-1.97, 0.5, 0.3))


def faults(m):
    """Adds geometry that a careful reader has to survive."""
    fins = [(0, 0, 0), (0, 0, 0.3), (0.2, 0, 0), (0.2, 0, 0.3), (-0.1, 0.2, 0), (-0.1, 0.2, 0.3), (-0.1, -0.2, 0), (-0.1, -0.2, 0.3)]
    add("Three fins on an edge", mesh_of("Fins", fins, [(0, 2, 3, 1), (0, 4, 5, 1), (0, 6, 7, 1)], [m["steel"]]), at=(-1.6, -0.9, 0.01))
    loose = [(0, 0, 0), (0.2, 0, 0), (0.2, 0.2, 0), (0, 0.2, 0), (0.3, 0, 0), (0.3, 0.2, 0), (0.4, 0.1, 0)]
    add("Loose edge and vertex", mesh_of("Loose", loose, [(0, 1, 2, 3)], [m["white"]], edges=[(4, 5)]), at=(-1.7, 0.2, 0.01))
    add("Wire", mesh_of("Wire", [(0, 0, 0), (0, 0, 0.5)], [], edges=[(0, 1)]), at=(-1.8, -0.2, 0.1))
    degenerate = [(0, 0, 0), (0.25, 0, 0), (0.25, 0.25, 0), (0, 0.25, 0), (0.125, 0, 0), (0.5, 0.5, 0), (0.5, 0.5, 0), (0.75, 0.5, 0)]
    add("Degenerate triangles", mesh_of("Degenerate", degenerate, [(0, 1, 2, 3), (0, 4, 1), (5, 6, 7)], [m["white"]]), at=(-1.7, 0.6, 0.01))
    square = [(0, 0, 0), (0.2, 0, 0), (0.2, 0.2, 0), (0, 0.2, 0)]
    add("Face listed twice", mesh_of("Face listed twice", square, [(0, 1, 2, 3), (0, 1, 2, 3)], [m["fabric"]]), at=(0.9, -2.3, 0.01))
    add("Two faces in one place", mesh_of("Two faces in one place", square * 2, [(0, 1, 2, 3), (4, 5, 6, 7)], [m["fabric"]]), at=(1.2, -2.3, 0.01))


def lamps_and_camera():
    """Adds one lamp of each kind that Blender has, a camera and a sky. Lamps shine along their own -z."""
    def lamp(kind, name, energy, colour, **settings):
        data = bpy.data.lights.new(name, kind)
        data.energy, data.color = energy, colour
        for key, value in settings.items():
            setattr(data, key, value)
        return data

    add("Point lamp", lamp("POINT", "Point lamp", 40.0, (1, 0.8, 0.6), shadow_soft_size=0.05), at=(-1.6, -2.1, 1.6))
    add("Spot lamp", lamp("SPOT", "Spot lamp", 60.0, (1, 1, 1), spot_size=math.radians(50), spot_blend=0.2, shadow_soft_size=0.02),
        at=(1.2, -1.8, 2.5), turn=(35, 0, 20))
    add("Sun", lamp("SUN", "Sun", 3.0, (1, 0.95, 0.9), angle=0.00918), at=(0, 6, 6), turn=(-50, 0, 15))
    area = lamp("AREA", "Area lamp", 25.0, (0.9, 0.95, 1), shape="RECTANGLE", size=0.8, size_y=0.4)
    add("Area lamp", area, at=(-1.2, 0.6, 2.6), turn=(0, -15, 0))
    camera = bpy.data.cameras.new("Camera")
    camera.angle = math.radians(80)
    bpy.context.scene.camera = add("Camera", camera, at=(1.8, -2.4, 1.9), turn=(72, 0, 34))
    world = bpy.data.worlds.new("Sky")
    world.use_nodes = True
    background = world.node_tree.nodes["Background"].inputs
    background["Color"].default_value, background["Strength"].default_value = (0.4, 0.6, 1.0, 1), 0.8
    bpy.context.scene.world = world


def make_scene():
    """Replaces Blender's start scene by the room and returns the means of its images."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    images, means = make_images()
    materials = make_materials(images)
    shell(materials)
    dining_group(materials)
    furniture(materials)
    faults(materials)
    lamps_and_camera()
    bpy.context.view_layer.update()
    return means


# The truth: from Blender's evaluated objects, in metres, z up.

def measured(corners):
    """Returns area and signed volume (about the origin) of triangles, an array of n x 3 corners x 3 coordinates."""
    crossed = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return np.linalg.norm(crossed, axis=1) / 2, np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6


COUNTED = ("polygons", "triangles", "area_m2", "polygon_area_m2")


def summed(parts, keys=COUNTED):
    return {key: sum(part[key] for part in parts) for key in keys}


def vector_area(corners):
    """Returns the length of a polygon's vector area: its area if it is flat."""
    return float(np.linalg.norm(np.cross(corners, np.roll(corners, -1, axis=0)).sum(axis=0)) / 2)


def truth_of_objects():
    """Returns counts, areas and bounds of every mesh object with its modifiers applied, by name."""
    objects = {}
    for instance in bpy.context.evaluated_depsgraph_get().object_instances:
        thing = instance.object
        if thing.type != "MESH":
            continue
        mesh, matrix = thing.to_mesh(), np.array(instance.matrix_world, dtype=np.float64)
        points = np.array([vertex.co for vertex in mesh.vertices], dtype=np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
        mesh.calc_loop_triangles()
        corners = points[np.array([triangle.vertices for triangle in mesh.loop_triangles], dtype=int).reshape(-1, 3)]
        if np.linalg.det(matrix[:3, :3]) < 0:  # what faces out of a mesh faces out of its mirror image
            corners = corners[:, ::-1]
        areas, volumes = measured(corners)
        slots = [slot.material.name if slot.material else None for slot in thing.material_slots] or [None]
        parts = {}
        for polygon in mesh.polygons:
            part = parts.setdefault(slots[polygon.material_index] or "", dict.fromkeys(COUNTED, 0))
            part["polygons"] += 1
            part["triangles"] += polygon.loop_total - 2
            part["polygon_area_m2"] += vector_area(points[list(polygon.vertices)])
        for triangle, area in zip(mesh.loop_triangles, areas):
            parts[slots[triangle.material_index] or ""]["area_m2"] += float(area)
        objects[thing.name] = summed(parts.values()) | {
            "signed_volume_m3": float(volumes.sum()), "bounds_m": [points.min(axis=0).tolist(), points.max(axis=0).tolist()],
            "mirrored": bool(np.linalg.det(matrix[:3, :3]) < 0), "materials": parts}
        thing.to_mesh_clear()
    objects["Unpainted block"]["vertex_colour_linear"] = VERTEX_COLOUR
    return dict(sorted(objects.items()))


def truth_of_material(material, means):
    shader = material.node_tree.nodes["Principled BSDF"]
    value = lambda socket: shader.inputs[socket].default_value
    image = lambda socket: shader.inputs[socket].links[0].from_node.image.name if shader.inputs[socket].links else None
    texture, emission_texture, strength = image("Base Color"), image("Emission"), value("Emission Strength")
    colour = means[texture][:3] if texture else list(value("Base Color"))[:3]
    emission = means[emission_texture][:3] if emission_texture else list(value("Emission"))[:3]
    return {
        "base_colour_linear": colour, "base_colour_texture": texture,
        "alpha": means[texture][3] if image("Alpha") else value("Alpha"), "alpha_mode": material.blend_method,
        "metallic": value("Metallic"), "roughness": value("Roughness"), "transmission": value("Transmission"), "ior": value("IOR"),
        "emission_linear": [strength * channel for channel in emission], "emission_strength": strength if any(emission) else 0.0,
        "emission_texture": emission_texture, "two_sided": not material.use_backface_culling}


def truth_of_lamp(thing):
    lamp, matrix = thing.data, thing.matrix_world
    told = {"name": thing.name, "kind": lamp.type, "colour": list(lamp.color), "position_m": list(matrix.translation),
            "direction": list(-matrix.col[2].xyz)}
    told["irradiance_w_per_m2" if lamp.type == "SUN" else "power_w"] = lamp.energy
    if lamp.type == "SPOT":
        told |= {"full_angle_degrees": math.degrees(lamp.spot_size), "blend": lamp.spot_blend}
    if lamp.type == "AREA":
        told |= {"size_m": [lamp.size, lamp.size_y]}
    return told


def less(told, part):
    return {key: told[key] - part[key] for key in COUNTED}


def truth_of_formats(total, objects, materials):
    """Returns, for every file, its unit and axes, and the figures that its exporter changes."""
    def told(up, changed=None, *, metres_per_unit=1.0, triangulated=False):
        return {"up": up, "metres_per_unit": metres_per_unit, "triangulated": triangulated} | (changed or {})

    # glTF, Collada: a face that another face repeats is lost, by Mesh.validate() in the one and by the cut into triangles in the other.
    twice, material = objects["Face listed twice"], "Fabric.red"
    half = {key: twice[key] / 2 if "area" in key else twice[key] // 2 for key in COUNTED}
    once = {"total": less(total, half), "objects": {"Face listed twice": half}, "materials": {material: less(materials[material], half)}}
    # PLY: io_mesh_ply moves a mirrored object's points but keeps the order of its corners, so its faces turn inside out.
    turned = sum(o["signed_volume_m3"] for o in objects.values() if o["mirrored"])
    ply = {"total": {"signed_volume_m3": total["signed_volume_m3"] - 2 * turned}}
    return {
        "room.glb": told("y", once, triangulated=True), "room.gltf": told("y", once, triangulated=True),
        "room_extras.gltf": told("y", once, triangulated=True), "room.obj": told("y"), "room_z_up.obj": told("z"),
        "room.ply": told("z", ply), "room.stl": told("z", triangulated=True), "room.dae": told("z", once, triangulated=True),
        "room.fbx": told("y", metres_per_unit=0.01)}


def truth(means):
    objects = truth_of_objects()
    materials = {material.name: truth_of_material(material, means) for material in sorted(bpy.data.materials, key=lambda m: m.name)}
    for name in [*materials, ""]:
        materials.setdefault(name, {}).update(summed([o["materials"][name] for o in objects.values() if name in o["materials"]]))
    told = [m for m in materials.values() if "metallic" in m]
    background = bpy.context.scene.world.node_tree.nodes["Background"].inputs
    total = {"objects": len(objects)} | summed(objects.values(), (*COUNTED, "signed_volume_m3")) | {
        "bounds_m": [[pick(o["bounds_m"][i][axis] for o in objects.values()) for axis in range(3)] for i, pick in enumerate((min, max))]}
    return {
        "about": "What Blender says of the room, from its evaluated objects: metres, z up. README.md tells what each figure means.",
        "blender": bpy.app.version_string,
        "total": total,
        "counts": {
            "materials": len(told), "textured": sum(bool(m["base_colour_texture"]) for m in told),
            "alpha": sum(m["alpha_mode"] != "OPAQUE" for m in told), "metal": sum(m["metallic"] > 0.5 for m in told),
            "transmissive": sum(m["transmission"] > 0 for m in told), "emissive": sum(m["emission_strength"] > 0 for m in told),
            "two_sided": sum(m["two_sided"] for m in told)},
        "formats": truth_of_formats(total, objects, materials),
        "materials": materials,
        "objects": objects,
        "lamps": [truth_of_lamp(o) for o in sorted(bpy.data.objects, key=lambda o: o.name) if o.type == "LIGHT"],
        "sky_radiance": [c * background["Strength"].default_value for c in list(background["Color"].default_value)[:3]],
        "camera": {"position_m": list(bpy.context.scene.camera.matrix_world.translation),
                   "direction": list(-bpy.context.scene.camera.matrix_world.col[2].xyz)},
    }


# Export.

def out(name):
    return os.path.join(OUT, name)


def export_gltf():
    told = {"export_lights": True, "export_cameras": True, "export_extras": True, "export_apply": True, "export_animations": False}
    bpy.ops.export_scene.gltf(filepath=out("room.glb"), export_format="GLB", **told)
    bpy.ops.export_scene.gltf(filepath=out("room.gltf"), export_format="GLTF_SEPARATE", **told)


def export_fbx():
    """Exports FBX as if at a fixed moment and from a fixed folder: the exporter writes the time of day and its images' full paths."""
    import io_scene_fbx.export_fbx_bin as exporter

    class FixedDatetime(datetime.datetime):
        @classmethod
        def now(cls, tz=None):
            return cls(2020, 1, 1, tzinfo=tz)

    paths = lambda image, scene_data: (f"/home/somebody/room/{image.name}", image.name)  # full, relative
    with unittest.mock.patch.object(datetime, "datetime", FixedDatetime), unittest.mock.patch.object(exporter, "_gen_vid_path", paths):
        bpy.ops.export_scene.fbx(filepath=out("room.fbx"), bake_anim=False)


def export_dae():
    """Exports Collada, and replaces the time that the exporter writes by a fixed one."""
    bpy.ops.wm.collada_export(filepath=out("room.dae"), apply_modifiers=True, include_animations=False)
    with open(out("room.dae"), encoding="utf-8") as file:
        text = file.read()
    with open(out("room.dae"), "w", encoding="utf-8") as file:
        file.write(re.sub(r"<(created|modified)>[^<]*<", r"<\1>2020-01-01T00:00:00<", text))


def export_all():
    bpy.ops.wm.obj_export(filepath=out("room.obj"), path_mode="RELATIVE")
    bpy.ops.wm.obj_export(filepath=out("room_z_up.obj"), path_mode="RELATIVE", forward_axis="Y", up_axis="Z", export_pbr_extensions=True)
    bpy.ops.export_mesh.ply(filepath=out("room.ply"))
    bpy.ops.export_mesh.stl(filepath=out("room.stl"))
    export_fbx()
    export_dae()
    export_gltf()  # last: it removes repeated faces from the scene itself


def write_extras(told):
    """Writes room_extras.gltf: room.gltf with the area lamp, the sky and the thin curtain that Blender's exporter leaves out."""
    with open(out("room.gltf"), encoding="utf-8") as file:
        gltf = json.load(file)
    area = next(lamp for lamp in told["lamps"] if lamp["kind"] == "AREA")
    thing = bpy.data.objects["Area lamp"]
    # Blender's z up to glTF's y up. The lamp keeps its own axes: it shines along -z, and `size` is along its x and y.
    world = Matrix.Rotation(math.radians(-90), 4, "X") @ thing.matrix_world
    w, x, y, z = world.to_quaternion()
    node = next((n for n in gltf["nodes"] if n["name"] == "Area lamp"), None)
    if node is None:
        node = {"name": "Area lamp"}
        gltf["scenes"][0]["nodes"].append(len(gltf["nodes"]))
        gltf["nodes"].append(node)
    node["translation"], node["rotation"] = list(world.translation), [x, y, z, w]
    node.setdefault("extras", {})["alvor_area_light"] = {"size": area["size_m"], "power_watts": area["power_w"], "colour": area["colour"]}
    gltf["scenes"][0].setdefault("extras", {})["alvor_sky"] = {"radiance": told["sky_radiance"]}
    by_name = {material["name"]: material for material in gltf["materials"]}
    translucent_curtain.make_translucent(gltf)
    texture = by_name["Floor tiles"]["pbrMetallicRoughness"]["baseColorTexture"]
    texture["extensions"] = {"KHR_texture_transform": {"offset": [0.25, 0.5], "rotation": math.radians(30), "scale": [2.0, 2.0]}}
    gltf["extensionsUsed"] = sorted({*gltf.get("extensionsUsed", []), "KHR_texture_transform"})
    with open(out("room_extras.gltf"), "w", encoding="utf-8") as file:
        json.dump(gltf, file, separators=(",", ":"), ensure_ascii=False)
        file.write("\n")


def rounded(value):
    """Returns the value with floats of nine significant digits, so that the JSON file stays readable."""
    if isinstance(value, dict):
        return {key: rounded(inner) for key, inner in value.items()}
    if isinstance(value, (list, tuple)):
        return [rounded(inner) for inner in value]
    return float(f"{value:.9g}") if isinstance(value, float) else value


def render(picture):
    scene = bpy.context.scene
    scene.render.engine, scene.cycles.samples, scene.cycles.use_denoising = "CYCLES", 12, False
    scene.view_settings.view_transform = "Standard"
    scene.render.resolution_x, scene.render.resolution_y, scene.render.filepath = 640, 480, picture
    bpy.ops.render.render(write_still=True)


def main():
    os.makedirs(OUT, exist_ok=True)
    told = truth(make_scene())
    export_all()
    translucent_curtain.patch_glb(out("room.glb"))
    write_extras(told)
    with open(out("expected.json"), "w", encoding="utf-8") as file:
        json.dump(rounded(told), file, indent=1, ensure_ascii=False)
        file.write("\n")
    if PICTURE:
        render(PICTURE)


if __name__ == "__main__":
    main()
