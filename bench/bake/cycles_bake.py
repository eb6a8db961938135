"""Bakes a room by Blender's Cycles and compares Alvor's lightmaps with it: blender -b --python cycles_bake.py -- FOLDER OUT.md

FOLDER holds what scripts/bake.sh made: room.glb, baked by alvor with --lightmap-format exr --convention godot, and for each
tolerance T a lightmap T.exr of the same charts and T.cpu, the CPU seconds of solving and baking. Cycles bakes the same charts: the
light that a white surface would send out, without denoising, clamping or a limit of bounces that matters. The truth is the mean of two long
bakes with other seeds; their difference tells its noise, which is taken out of all errors. A bake of a quarter of the texels' size tells
which texels are open: each of their sixteen parts lies on a chart and has light. Others lie on the edge of a chart or partly below
something that stands there. What they should hold is a matter of taste, and the programs differ: Cycles takes the darkness below into the mean,
Alvor leaves it out, so that none of it is seen beside a table's leg.
"""

import pathlib
import sys
import time

import bpy
import numpy

for name, kind in (("bool", bool), ("object", object), ("int", int), ("float", float)):
    if name not in vars(numpy):  # Blender 3.4 still asks for these
        setattr(numpy, name, kind)

SIZE = 512
TRUTH_SAMPLES = 2048
FINE_SAMPLES = 64
SAMPLES = (16, 64, 256, 1024)
BOUNCES = 64
FOLDER, OUT = map(pathlib.Path, sys.argv[sys.argv.index("--") + 1 :][:2])


def pixels_of(image):
    """The image as rows from the top, of four floats."""
    columns, rows = image.size
    values = numpy.empty(columns * rows * 4, dtype=numpy.float32)
    image.pixels.foreach_get(values)
    return values.reshape(rows, columns, 4)[::-1].astype(numpy.float64)


def make_lambertian(material):
    """Gives a material diffuse reflection and emission on its front, and black on its back, as Alvor has them."""
    material.use_nodes = True
    tree = material.node_tree
    output = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
    principled = next((node for node in tree.nodes if node.type == "BSDF_PRINCIPLED"), None)
    if principled is None:
        return
    new = tree.nodes.new
    diffuse, emission, both = new("ShaderNodeBsdfDiffuse"), new("ShaderNodeEmission"), new("ShaderNodeAddShader")
    diffuse.inputs["Color"].default_value = principled.inputs["Base Color"].default_value
    emission.inputs["Color"].default_value = principled.inputs["Emission"].default_value
    emission.inputs["Strength"].default_value = principled.inputs["Emission Strength"].default_value
    geometry, black, side = new("ShaderNodeNewGeometry"), new("ShaderNodeBsdfDiffuse"), new("ShaderNodeMixShader")
    black.inputs["Color"].default_value = (0, 0, 0, 1)
    for start, end in (
        (diffuse.outputs[0], both.inputs[0]),
        (emission.outputs[0], both.inputs[1]),
        (geometry.outputs["Backfacing"], side.inputs[0]),
        (both.outputs[0], side.inputs[1]),
        (black.outputs[0], side.inputs[2]),
        (side.outputs[0], output.inputs["Surface"]),
    ):
        tree.links.new(start, end)


def load_room():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=str(FOLDER / "room.glb"))
    scene = bpy.context.scene
    scene.world = bpy.data.worlds.new("dark")
    scene.world.use_nodes = False
    scene.world.color = (0, 0, 0)
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.max_bounces = cycles.diffuse_bounces = BOUNCES
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    for material in bpy.data.materials:
        make_lambertian(material)


def target_of_all_materials(size):
    image = bpy.data.images.new("bake", size, size, float_buffer=True, alpha=True)
    for material in bpy.data.materials:
        node = material.node_tree.nodes.get("target") or material.node_tree.nodes.new("ShaderNodeTexImage")
        node.name = "target"
        node.image = image
        material.node_tree.nodes.active = node
    for item in bpy.data.objects:
        is_mesh = item.type == "MESH"
        item.select_set(is_mesh)
        if is_mesh:
            bpy.context.view_layer.objects.active = item
            item.data.uv_layers.active_index = len(item.data.uv_layers) - 1
    return image


def bake(image, samples, seed):
    """Bakes once. Returns the pixels and the CPU seconds."""
    scene = bpy.context.scene
    scene.cycles.samples = samples
    scene.cycles.seed = seed
    begin = time.process_time()
    bpy.ops.object.bake(type="DIFFUSE", pass_filter={"DIRECT", "INDIRECT"}, margin=0, use_clear=True)
    return pixels_of(image), time.process_time() - begin


def open_texels():
    """Tells of each texel whether all its sixteen parts lie on a chart and have light."""
    fine, _ = bake(target_of_all_materials(4 * SIZE), FINE_SAMPLES, 5)
    has_light = (fine[..., 3] > 0.5) & (fine[..., :3].sum(-1) > 0)
    return has_light.reshape(SIZE, 4, SIZE, 4).all(axis=(1, 3))


def main():
    load_room()
    is_open = open_texels()
    image = target_of_all_materials(SIZE)
    first, _ = bake(image, TRUTH_SAMPLES, 1)
    second, _ = bake(image, TRUTH_SAMPLES, 2)
    is_baked = first[..., 3] > 0.5
    light = [pixels[..., :3].mean(-1)[is_baked] for pixels in (first, second)]
    truth = (light[0] + light[1]) / 2
    inner = is_open[is_baked]
    seen = truth > 0  # texels under and inside solids are dark, and nobody sees them
    mean = truth[inner].mean()

    def noise(which):
        return ((light[0] - light[1])[which] ** 2).mean() / 4

    def error(pixels, which):
        squares = ((pixels[..., :3].mean(-1)[is_baked] - truth)[which] ** 2).mean()
        return 100 * numpy.sqrt(max(0, squares - noise(which))) / mean

    rows = [("| program | setting | nRMSE over open texels | over all with light | CPU s |", ""), ("|---|---|---|---|---|", "")]

    def add(program, setting, pixels, cpu_s, remark=""):
        rows.append((f"| {program} | {setting} | {error(pixels, inner):.2f} % | {error(pixels, seen):.2f} % | {cpu_s:.1f} |", remark))

    for samples in SAMPLES:
        pixels, cpu_s = bake(image, samples, 3)
        add("Cycles", f"{samples} samples", pixels, cpu_s)
    for lightmap in sorted(FOLDER.glob("0.*.exr"), reverse=True):
        loaded = bpy.data.images.load(str(lightmap))
        loaded.colorspace_settings.name = "Non-Color"
        pixels = pixels_of(loaded)
        cpu_s = float(lightmap.with_suffix(".cpu").read_text())
        bias = pixels[..., :3].mean(-1)[is_baked][inner].mean() / mean - 1
        add("Alvor", f"tolerance {100 * float(lightmap.stem):g} %", pixels, cpu_s, f"bias {100 * bias:.2f} %")
    for row, remark in rows:
        print(row, remark)
    print(f"{seen.sum()} texels with light, {inner.sum()} of them open; standard error of the truth {100 * numpy.sqrt(noise(inner)) / mean:.2f} %")
    OUT.write_text("\n".join(row for row, _ in rows) + "\n")


main()
