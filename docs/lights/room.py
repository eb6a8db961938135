"""Makes a room with a bulb, a spot and the sun, for docs/lights.md: exports OUT/room.glb, and draws it with Cycles as OUT/cycles.png.

Then it measures irradiance with Cycles: with all lamps, and with each alone, for which it exports OUT/bulb.glb, OUT/spot.glb and
OUT/sun.glb. It prints means over areas, and what the bulb brings to 64 points in the middle of each of
five faces, which it writes to OUT/points.csv for alvor probe.

Run: blender -b -P docs/lights/room.py -- OUT
"""

import math
import pathlib
import sys

import bpy
import mathutils
import numpy

WIDTH, DEPTH, HEIGHT = 4, 5, 3
TEXELS, SAMPLES = 32, 256  # of a face, along each side; of a texel
MIDDLE = slice(TEXELS * 3 // 8, TEXELS * 5 // 8)
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


def export(name, lamps):
    bpy.ops.object.select_all(action="DESELECT")
    for node in scene.objects:
        node.select_set(node.type == "MESH" or node in lamps)
    bpy.ops.export_scene.gltf(filepath=str(out / f"{name}.glb"), export_lights=True, use_selection=True)


def make_lambertian(material):
    """Replaces the Principled BSDF: rough, it reflects light from 60 degrees 3 % more than its colour says."""
    nodes = material.node_tree.nodes
    surface = nodes.new("ShaderNodeBsdfDiffuse")
    surface.inputs["Color"].default_value = nodes["Principled BSDF"].inputs["Base Color"].default_value
    surface.inputs["Roughness"].default_value = 0
    material.node_tree.links.new(surface.outputs["BSDF"], nodes["Material Output"].inputs["Surface"])


def lay_out_texels(node):
    """Gives each face of an object a square of texels of its own. Faces are rectangles, so texels are equal in area."""
    faces = node.data.polygons
    layer = node.data.uv_layers.new(name="texels")
    node.data.uv_layers.active = layer
    for face in faces:
        for loop, (u, v) in zip(face.loop_indices, [(0, 0), (1, 0), (1, 1), (0, 1)]):
            layer.data[loop].uv = ((face.index + u) / len(faces), v)


def bake(node):
    """Returns irradiance on the fronts of an object's faces, W/m2: array of face, row, column, band."""
    count = len(node.data.polygons)
    image = bpy.data.images.new("irradiance", TEXELS * count, TEXELS, float_buffer=True, is_data=True)
    nodes = node.active_material.node_tree.nodes
    nodes.active = nodes.new("ShaderNodeTexImage")
    nodes.active.image = image
    bpy.ops.object.select_all(action="DESELECT")
    node.select_set(True)
    bpy.context.view_layer.objects.active = node
    bpy.ops.object.bake(type="DIFFUSE", pass_filter={"DIRECT", "INDIRECT"}, margin=0, use_clear=True)
    texels = numpy.array(image.pixels[:]).reshape(TEXELS, count, TEXELS, 4).swapaxes(0, 1)[..., :3]
    bpy.data.images.remove(image)
    return texels * math.pi  # Cycles divides the radiance by the colour only


def area(node):
    return sum(face.area for face in node.data.polygons)


def middle_texels(node):
    """Yields the centre of each texel in the middle of the first face, and the face's normal."""
    face = node.data.polygons[0]
    a, b, _, d = [node.data.vertices[vertex].co for vertex in face.vertices]
    for row in range(TEXELS)[MIDDLE]:
        for column in range(TEXELS)[MIDDLE]:
            place = a + (column + 0.5) / TEXELS * (b - a) + (row + 0.5) / TEXELS * (d - a)
            yield node.matrix_world @ place, node.matrix_world.to_3x3() @ face.normal


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
lamps = [node for node in scene.objects if node.type == "LIGHT"]
export("room", lamps)
for node in lamps:
    export(node.name, [node])
scene.render.engine, scene.cycles.samples, scene.cycles.use_denoising = "CYCLES", 128, False
scene.cycles.max_bounces = scene.cycles.diffuse_bounces = 24
scene.render.resolution_x, scene.render.resolution_y = 640, 480
scene.view_settings.view_transform = "Standard"
scene.render.filepath = str(out / "cycles.png")
bpy.ops.render.render(write_still=True)

scene.cycles.samples, scene.cycles.use_adaptive_sampling, scene.cycles.light_sampling_threshold = SAMPLES, False, 0
for material in bpy.data.materials:
    make_lambertian(material)
polygon("check", [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], white)
check = scene.objects["check"]
lamp("SUN", "check sun", (0, 0, 1), (60, 0, 0), energy=1, angle=0)
check_sun = scene.objects["check sun"]
surfaces = [node for node in scene.objects if node.type == "MESH" and node != check]
for node in [check, *surfaces]:
    lay_out_texels(node)


def show_only(shown):
    for node in scene.objects:
        node.hide_render = node not in shown


show_only([check, check_sun])
print(f"check: a plane that the sun lights from 60 degrees, 1 W/m2: {bake(check).mean():.4f} W/m2, should be 0.5")
bpy.data.objects.remove(check)
bpy.data.objects.remove(check_sun)

luminance = numpy.array([0.2126, 0.7152, 0.0722])
total = sum(area(node) for node in surfaces)
probed = surfaces[:5]
for name, lit_by in [("room", lamps)] + [(node.name, [node]) for node in lamps]:
    show_only(surfaces + lit_by)
    fronts = [bake(node) @ luminance for node in surfaces]
    for node in surfaces:
        node.data.flip_normals()
    backs = [bake(node) @ luminance for node in surfaces]
    for node in surfaces:
        node.data.flip_normals()
    front, back = (sum(area(node) * texels.mean() for node, texels in zip(surfaces, side)) / total for side in (fronts, backs))
    print(f"{name}: mean irradiance of all surfaces {(front + back) / 2:.4f} W/m2, of fronts {front:.4f}, of backs {back:.4f}")
    if name == "bulb":
        print("bulb: in the middles of", *(f"{node.name} {texels[0, MIDDLE, MIDDLE].mean():.4f}" for node, texels in zip(probed, fronts)))

with open(out / "points.csv", "w") as points:
    for node in probed:
        for place, normal in middle_texels(node):
            print(place.x, place.z, -place.y, normal.x, normal.z, -normal.y, sep=",", file=points)
