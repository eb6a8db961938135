"""Makes a room with a bulb, a spot and the sun, for docs/lights.md: exports OUT/room.glb, and draws it with Cycles as OUT/cycles.png.

Run: blender -b -P docs/lights/room.py -- OUT
"""

import math
import pathlib
import sys

import bpy
import mathutils

WIDTH, DEPTH, HEIGHT = 4, 5, 3
out = pathlib.Path(sys.argv[sys.argv.index("--") + 1])
bpy.ops.wm.read_factory_settings(use_empty=True)


def diffuse(name, colour):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    surface = material.node_tree.nodes["Principled BSDF"]
    surface.inputs["Base Color"].default_value = (*colour, 1)
    surface.inputs["Roughness"].default_value, surface.inputs["Specular"].default_value = 1, 0
    return material


def polygon(name, corners, material):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(corners, [], [list(range(len(corners)))])
    mesh.materials.append(material)
    bpy.context.collection.objects.link(bpy.data.objects.new(name, mesh))


def wall_with_x(name, x, low, high, material):
    (y, z), (Y, Z) = low, high
    polygon(name, [(x, y, z), (x, y, Z), (x, Y, Z), (x, Y, z)], material)


def box(name, size, place, turn, material):
    bpy.ops.mesh.primitive_cube_add(size=size, location=place)
    bpy.context.object.name, bpy.context.object.rotation_euler[2] = name, turn
    bpy.context.object.data.materials.append(material)


def lamp(kind, name, place, turn=(0, 0, 0), **settings):
    light = bpy.data.lights.new(name, kind)
    for key, value in settings.items():
        setattr(light, key, value)
    node = bpy.data.objects.new(name, light)
    node.location, node.rotation_euler = place, [math.radians(angle) for angle in turn]
    bpy.context.collection.objects.link(node)


white, grey = diffuse("white", (0.7, 0.7, 0.7)), diffuse("grey", (0.4, 0.4, 0.4))
red, green = diffuse("red", (0.6, 0.1, 0.1)), diffuse("green", (0.1, 0.5, 0.1))
X, Y, Z = WIDTH, DEPTH, HEIGHT
polygon("floor", [(0, 0, 0), (X, 0, 0), (X, Y, 0), (0, Y, 0)], grey)
polygon("ceiling", [(0, 0, Z), (0, Y, Z), (X, Y, Z), (X, 0, Z)], white)
polygon("left", [(0, 0, 0), (0, Y, 0), (0, Y, Z), (0, 0, Z)], red)
polygon("back", [(0, Y, 0), (X, Y, 0), (X, Y, Z), (0, Y, Z)], white)
polygon("front", [(0, 0, 0), (0, 0, Z), (X, 0, Z), (X, 0, 0)], white)
for part, (low, high) in enumerate([((0, 0), (1.5, Z)), ((3.5, 0), (Y, Z)), ((1.5, 0), (3.5, 1)), ((1.5, 2.2), (3.5, Z))]):
    wall_with_x(f"right {part}", X, low, high, green)
box("large box", 1, (1.2, 3.2, 0.5), 0.4, white)
box("small box", 0.6, (2.8, 1.6, 0.3), 0, white)
lamp("POINT", "bulb", (2, 2.5, 2.5), energy=60, shadow_soft_size=0)
lamp("SPOT", "spot", (0.6, 0.8, 2.6), (40, 0, -40), energy=150, spot_size=math.radians(50), spot_blend=0.3, color=(1, 0.8, 0.5), shadow_soft_size=0)
lamp("SUN", "sun", (8, 2, 6), (0, 60, 10), energy=3, angle=0)

camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
bpy.context.collection.objects.link(camera)
camera.location = (3.7, 0.3, 1.7)
camera.rotation_euler = (mathutils.Vector((1.5, 3.5, 1.2)) - camera.location).to_track_quat("-Z", "Y").to_euler()
camera.data.sensor_fit, camera.data.angle_y = "VERTICAL", math.radians(60)
scene = bpy.context.scene
scene.camera = camera
bpy.ops.export_scene.gltf(filepath=str(out / "room.glb"), export_lights=True)
scene.render.engine, scene.cycles.samples, scene.cycles.use_denoising = "CYCLES", 128, False
scene.cycles.max_bounces = scene.cycles.diffuse_bounces = 24
scene.render.resolution_x, scene.render.resolution_y = 640, 480
scene.view_settings.view_transform = "Standard"
scene.render.filepath = str(out / "cycles.png")
bpy.ops.render.render(write_still=True)
