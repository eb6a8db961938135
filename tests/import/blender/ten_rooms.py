"""Makes ten furnished rooms of random sizes, materials, windows and lamps in Blender and exports each as GLB.

Run: blender -b --factory-startup --python ten_rooms.py -- OUTDIR
Written for Blender 3.4.1. Room N is OUTDIR/N.glb, and the same on every run. Every room has pictures on its faces, a window and things on the
floor; each kind of surface in docs/surfaces.md is in several of them, each kind of lamp too. scripts/rooms.sh measures Alvor by them.
"""

import math
import os
import random
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import make_room
from make_room import add, boxes, mesh_of, principled, translucent_curtain

import bpy


def picture(name, texel, size=64):
    """Writes an image of `texel`(x, y) -> bytes and loads it."""
    make_room.write_png(name, [[texel(x, y) for x in range(size)] for y in range(size)])
    image = bpy.data.images.load(os.path.join(make_room.OUT, name))
    image.name = name
    return image


def byte(value):
    return max(0, min(255, int(value)))


def make_materials(dice, folder):
    """Returns materials by a short key. Images differ between rooms, so `folder` goes into their names."""
    tint = [dice.uniform(0.5, 1.0) for _ in range(3)]
    tiles, stripes = dice.choice((4, 8, 16)), dice.choice((4, 8, 32))
    blade = dice.uniform(0.5, 0.95)

    def tile(x, y):
        light = 220 if (x // tiles + y // tiles) % 2 else 70
        return tuple(byte(light * band) for band in tint)

    def stripe(x, y):
        light = 235 if x // stripes % 2 else 150
        return byte(light), byte(light * 0.9), byte(160 + 1.2 * y)

    def leaf(x, y):
        return 60, 140 + y // 2, 50, 255 if abs(x - 31.5) < 31 * blade * math.sin(math.pi * (y + 0.5) / 64) else 0

    def grain(x, y):
        wave = 20 * math.sin(0.7 * x + 2 * math.sin(0.12 * y))
        return byte(150 + wave), byte(105 + wave), byte(62 + wave / 2)

    def screen(x, y):
        return byte(20 + 3.5 * x), byte(200 * (y // 16 % 2)), byte(250 - 3.5 * y)

    image = {kind.__name__: picture(f"{folder}_{kind.__name__}.png", kind) for kind in (tile, stripe, leaf, grain, screen)}
    colour = lambda low, high: tuple(dice.uniform(low, high) for _ in range(3))
    return {
        "plaster": principled("Plaster", colour(0.6, 0.85)),
        "wallpaper": principled("Wallpaper", (1, 1, 1), image=image["stripe"]),
        "floor": principled("Floor", (1, 1, 1), image=dice.choice((image["tile"], image["grain"]))),
        "wood": principled("Wood", (1, 1, 1), image=image["grain"]),
        "fabric": principled("Fabric", colour(0.05, 0.6)),
        "steel": principled("Steel", (0.7, 0.7, 0.72), roughness=0.3, Metallic=1.0),
        "glass": principled("Glass", colour(0.85, 1.0), roughness=0.0, Transmission=dice.choice((1.0, 0.8)), IOR=1.45),
        "curtain": principled("Curtain", colour(0.2, 0.6), two_sided=True),
        "gauze": principled("Gauze", colour(0.5, 0.8), two_sided=True, Alpha=dice.uniform(0.2, 0.7)),
        "leaf": principled("Leaf", (1, 1, 1), image=image["leaf"], two_sided=True),
        "panel": principled("Panel", (0.3, 0.3, 0.3), emission=(1.0, 0.9, 0.75), strength=dice.uniform(8, 20)),
        "screen": principled("Screen", (0.03, 0.03, 0.03), emission_image=image["screen"], strength=dice.uniform(2, 6)),
    }


def wall(name, corners, material):
    """Adds one face, counter-clockwise seen from inside, with an image to every 1.1 m."""
    length, height = math.dist(corners[0], corners[1]) / 1.1, math.dist(corners[1], corners[2]) / 1.1
    uv = dict(zip(corners, ((0, 0), (length, 0), (length, height), (0, height))))
    nearest = lambda *p: uv[min(corners, key=lambda c: math.dist(c, p))]
    add(name, mesh_of(name, corners, [(0, 1, 2, 3)], [material], uv=nearest))


def shell(dice, m, width, depth, height):
    """Adds floor, ceiling, walls, and a window with its pane in the north wall. Returns the window as x0, z0, x1, z1."""
    x, y, z = width / 2, depth / 2, height
    wall("Floor", [(-x, -y, 0), (x, -y, 0), (x, y, 0), (-x, y, 0)], m["floor"])
    wall("Ceiling", [(-x, y, z), (x, y, z), (x, -y, z), (-x, -y, z)], m["plaster"])
    wall("West", [(-x, -y, 0), (-x, y, 0), (-x, y, z), (-x, -y, z)], m["wallpaper"])
    wall("East", [(x, y, 0), (x, -y, 0), (x, -y, z), (x, y, z)], m["plaster"])
    wall("South", [(x, -y, 0), (-x, -y, 0), (-x, -y, z), (x, -y, z)], m["plaster"])
    x0, z0 = dice.uniform(0.4, 0.3 * width), dice.uniform(0.3, 1.0)
    x1, z1 = dice.uniform(0.6 * width, width - 0.3), dice.uniform(0.7, 0.9) * height
    make_room.HEIGHT = height
    add("North", mesh_of("North", *make_room.wall_with_hole(width, (x0, z0, x1, z1)), [m["plaster"]]), at=(-x, y, 0))
    ring = ((x0, z0), (x1, z0), (x1, z1), (x0, z1))
    reveal = [(px, py, pz) for py in (0, 0.2) for px, pz in ring]
    add("Reveal", mesh_of("Reveal", reveal, [(i, (i + 1) % 4, (i + 1) % 4 + 4, i + 4) for i in range(4)], [m["plaster"]]), at=(-x, y, 0))
    if dice.random() < 0.6:  # a pane that has two sides, as Blender's own scenes have it
        add("Pane", mesh_of("Pane", *boxes(((x0, 0.09, z0), (x1, 0.1, z1))), [m["glass"]]), at=(-x, y, 0))
    else:
        add("Pane", mesh_of("Pane", [(x0, 0.1, z0), (x1, 0.1, z0), (x1, 0.1, z1), (x0, 0.1, z1)], [(0, 1, 2, 3)], [m["glass"]]), at=(-x, y, 0))
    return x0 - x, z0, x1 - x, z1


def cloth(dice, m, window, y):
    """Hangs a curtain in folds, gauze, or both before the window."""
    x0, z0, x1, z1 = window
    kind = dice.choice(("curtain", "gauze", "both"))
    if kind != "gauze":
        folds = [(x0 - 0.1 + 0.1 * i, 0.05 * (i % 2), z) for z in (0.05, z1 + 0.1) for i in range(9)]
        add("Curtain", mesh_of("Curtain", folds, [(i, i + 1, i + 10, i + 9) for i in range(8)], [m["curtain"]]), at=(0, y - 0.25, 0))
    if kind != "curtain":
        middle = (x0 + x1) / 2
        add("Gauze", mesh_of("Gauze", [(middle, 0, z0 - 0.1), (x1, 0, z0 - 0.1), (x1, 0, z1), (middle, 0, z1)], [(0, 1, 2, 3)], [m["gauze"]]),
            at=(0, y - 0.15, 0))


def furniture(dice, m, x, y):
    """Puts tables, cupboards, plants and a kettle on a grid of places of 1.2 m, so that none stands in another."""
    flat = lambda px, py, pz: (px + 0.3 * pz, py)
    places = [(-x + 0.9 + 1.2 * i, -y + 0.9 + 1.2 * j) for i in range(int((2 * x - 0.6) / 1.2)) for j in range(int((2 * y - 1.2) / 1.2))]
    dice.shuffle(places)
    leaf = mesh_of("Leaf", [(-0.12, 0, 0), (0.12, 0, 0), (0.12, 0, 0.4), (-0.12, 0, 0.4)], [(0, 1, 2, 3)], [m["leaf"]],
                   uv=lambda px, py, pz: ((px + 0.12) / 0.24, pz / 0.4))
    for number, place in enumerate(places[:dice.randint(5, 9)]):
        turn, kind = dice.uniform(0, 90), ("table", "plant", "cupboard", "stools")[number % 4]
        at = (*place, 0)
        if kind == "table":
            h = dice.uniform(0.45, 0.75)
            legs = [((sx * 0.4 - 0.03, sy * 0.25 - 0.03, 0), (sx * 0.4 + 0.03, sy * 0.25 + 0.03, h)) for sx in (-1, 1) for sy in (-1, 1)]
            table = add("Table", mesh_of("Table", *boxes(((-0.45, -0.3, h), (0.45, 0.3, h + 0.04)), *legs), [m["wood"]], uv=flat), at=at, turn=(0, 0, turn))
            add("Tin", mesh_of("Tin", *boxes(((-0.06, -0.06, 0), (0.06, 0.06, 0.15))), [m["steel"]]), at=(0.2, 0.05, h + 0.041), parent=table)
        elif kind == "plant":
            pot = add("Pot", mesh_of("Pot", *boxes(((-0.12, -0.12, 0), (0.12, 0.12, 0.25))), [m["fabric"]]), at=at, turn=(0, 0, turn))
            for i in range(dice.randint(4, 9)):
                add("Leaf", leaf, at=(0, 0, 0.25 + 0.05 * i), turn=(dice.uniform(15, 60), 0, 137.5 * i), parent=pot)
        elif kind == "cupboard":
            add("Cupboard", mesh_of("Cupboard", *boxes(((-0.4, -0.2, 0.02), (0.4, 0.2, dice.uniform(0.6, 1.6)))), [m["wood"]], uv=flat),
                at=at, turn=(0, 0, turn))
        else:
            stool = mesh_of("Stool", *boxes(((-0.18, -0.18, 0), (0.18, 0.18, 0.42))), [m["fabric"]])
            add("Stool", stool, at=at, turn=(0, 0, turn))
            add("Stool", stool, at=(place[0] + 0.02, place[1] - 0.02, 0.43), turn=(0, 0, turn + 31), scale=(0.7, 1.1, 0.5))


def lamps(dice, m, number, x, y, z):
    """Lights a room by what its number says: a panel, a screen, a point, a spot or the sun, always with a second light."""
    def lamp(kind, energy, **settings):
        data = bpy.data.lights.new(kind, kind)
        data.energy, data.color = energy, (1, dice.uniform(0.7, 1), dice.uniform(0.5, 1))
        for key, value in settings.items():
            setattr(data, key, value)
        return data

    kinds = ("panel", "screen", "point", "spot", "sun")
    for kind in (kinds[number % 5], kinds[(number + 1 + number // 5) % 5]):
        if kind == "panel":
            half = dice.uniform(0.2, 0.5)
            add("Panel", mesh_of("Panel", [(-half, -0.3, 0), (half, -0.3, 0), (half, 0.3, 0), (-half, 0.3, 0)], [(3, 2, 1, 0)], [m["panel"]]),
                at=(dice.uniform(-0.5, 0.5), 0, z - 0.05))
        elif kind == "screen":
            screen = [(0, -0.6, 0), (0, -0.6, 0.7), (0, 0.6, 0.7), (0, 0.6, 0)]
            add("Screen", mesh_of("Screen", screen, [(0, 1, 2, 3)], [m["screen"]], uv=lambda px, py, pz: ((py + 0.6) / 1.2, pz / 0.7)),
                at=(x - 0.03, -0.3, 0.9))
        elif kind == "point":
            add("Point", lamp("POINT", 60.0, shadow_soft_size=0.05), at=(0.3, -0.4, z - 0.6))
        elif kind == "spot":
            add("Spot", lamp("SPOT", 90.0, spot_size=math.radians(70), spot_blend=0.3, shadow_soft_size=0.02), at=(-0.5, 0.2, z - 0.3), turn=(20, 10, 0))
        else:
            add("Sun", lamp("SUN", 4.0, angle=0.00918), at=(0, y + 2, 4), turn=(dice.uniform(-60, -40), 0, dice.uniform(-25, 25)))


def make(number):
    dice = random.Random(number)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    m = make_materials(dice, str(number))
    width, depth, height = dice.uniform(3.2, 6), dice.uniform(3.5, 7), dice.uniform(2.4, 3.2)
    window = shell(dice, m, width, depth, height)
    cloth(dice, m, window, depth / 2)
    furniture(dice, m, width / 2, depth / 2)
    lamps(dice, m, number, width / 2, depth / 2, height)
    path = os.path.join(make_room.OUT, f"{number}.glb")
    bpy.ops.export_scene.gltf(filepath=path, export_format="GLB", export_lights=True)
    if "Curtain" in bpy.data.objects:
        translucent_curtain.patch_glb(path)


os.makedirs(make_room.OUT, exist_ok=True)
for number in range(1, 11):
    make(number)
