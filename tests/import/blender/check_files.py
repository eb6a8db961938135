#!/usr/bin/env python3
"""check_files.py [FOLDER]: reads the exported files on its own and compares them with what Blender says in expected.json.

Uses Python's standard library only, and shares no code with make_room.py or with Alvor's importers. Exit status 1 if a file differs.
"""

import array
import json
import math
import os
import struct
import sys
import xml.etree.ElementTree
import zlib

FOLDER = sys.argv[1] if len(sys.argv) > 1 else os.path.join(os.path.dirname(os.path.abspath(__file__)), "files")
IDENTITY = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]


# Vectors and matrices (four rows that multiply columns).

def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def minus(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def times(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(4)) for j in range(4)] for i in range(4)]


def moved(matrix, point):
    return tuple(sum(matrix[i][k] * point[k] for k in range(3)) + matrix[i][3] for i in range(3))


def determinant(m):
    return sum(m[0][i] * (m[1][(i + 1) % 3] * m[2][(i + 2) % 3] - m[1][(i + 2) % 3] * m[2][(i + 1) % 3]) for i in range(3))


def z_up(point):
    """Turns a point of a y-up file into Blender's frame."""
    return (point[0], -point[2], point[1])


# Readers. Each returns faces in metres, z up, as tuples (object, material, points); object and material are None if the file has none.

def read_obj(name, convert):
    points, faces, thing, material = [], [], None, None
    for line in open(os.path.join(FOLDER, name), encoding="utf-8"):
        key, *words = line.split() or [""]
        if key == "o":
            thing, material = line.split(None, 1)[1].strip(), None
        elif key == "usemtl":
            material = line.split(None, 1)[1].strip()
        elif key == "v":
            points.append(convert(tuple(map(float, words[:3]))))
        elif key == "f":
            faces.append((thing, material, [points[int(word.split("/")[0]) - 1] for word in words]))
    return faces


def gltf_parts(name):
    """Returns the JSON document and the bytes of the only buffer."""
    data = open(os.path.join(FOLDER, name), "rb").read()
    if not name.endswith(".glb"):
        gltf = json.loads(data)
        return gltf, open(os.path.join(FOLDER, gltf["buffers"][0]["uri"]), "rb").read()
    length = struct.unpack_from("<I", data, 12)[0]
    return json.loads(data[20:20 + length]), data[28 + length:]


def gltf_accessor(gltf, buffer, index):
    accessor = gltf["accessors"][index]
    width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}[accessor["type"]]
    kind = {5121: "B", 5123: "H", 5125: "I", 5126: "f"}[accessor["componentType"]]
    view = gltf["bufferViews"][accessor["bufferView"]]
    assert "byteStride" not in view
    start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    values = struct.unpack_from(f"<{width * accessor['count']}{kind}", buffer, start)
    return [values[i:i + width] for i in range(0, len(values), width)] if width > 1 else list(values)


def gltf_matrix(node):
    if "matrix" in node:
        return [[node["matrix"][4 * j + i] for j in range(4)] for i in range(4)]
    x, y, z, w = node.get("rotation", (0, 0, 0, 1))
    s, t = node.get("scale", (1, 1, 1)), node.get("translation", (0, 0, 0))
    r = ((1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
         (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
         (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)))
    return [[*(r[i][j] * s[j] for j in range(3)), t[i]] for i in range(3)] + [[0, 0, 0, 1]]


def read_gltf(name):
    gltf, buffer = gltf_parts(name)
    faces = []

    def visit(index, parent):
        node = gltf["nodes"][index]
        matrix = times(parent, gltf_matrix(node))
        for child in node.get("children", ()):
            visit(child, matrix)
        for primitive in gltf["meshes"][node["mesh"]]["primitives"] if "mesh" in node else ():
            assert primitive.get("mode", 4) == 4
            points = [z_up(moved(matrix, point)) for point in gltf_accessor(gltf, buffer, primitive["attributes"]["POSITION"])]
            corners = gltf_accessor(gltf, buffer, primitive["indices"])
            material = gltf["materials"][primitive["material"]]["name"] if "material" in primitive else None
            step = -1 if determinant(matrix) < 0 else 1
            faces.extend((node["name"], material, [points[k] for k in corners[i:i + 3]][::step]) for i in range(0, len(corners), 3))

    for root in gltf["scenes"][gltf["scene"]]["nodes"]:
        visit(root, IDENTITY)
    return faces


def read_ply(name):
    header, data = open(os.path.join(FOLDER, name), "rb").read().split(b"end_header\n", 1)
    counts = {line.split()[1]: int(line.split()[2]) for line in header.decode().splitlines() if line.startswith("element")}
    size = 4 * header.count(b"property float") + header.count(b"property uchar")  # of a vertex, in bytes
    points = [struct.unpack_from("<3f", data, size * i) for i in range(counts["vertex"])]
    offset, faces = size * counts["vertex"], []
    for _ in range(counts["face"]):
        n = data[offset]
        faces.append((None, None, [points[i] for i in struct.unpack_from(f"<{n}I", data, offset + 1)]))
        offset += 1 + 4 * n
    assert offset == len(data)
    return faces


def read_stl(name):
    data = open(os.path.join(FOLDER, name), "rb").read()
    count = struct.unpack_from("<I", data, 80)[0]
    assert len(data) == 84 + 50 * count
    corners = [struct.unpack_from("<9f", data, 84 + 50 * i + 12) for i in range(count)]
    return [(None, None, [c[0:3], c[3:6], c[6:9]]) for c in corners]


def read_dae(name):
    root = xml.etree.ElementTree.parse(os.path.join(FOLDER, name)).getroot()
    ns = {"c": "http://www.collada.org/2005/11/COLLADASchema"}
    metres = float(root.find("c:asset/c:unit", ns).get("meter"))
    convert = {"Z_UP": lambda p: p, "Y_UP": z_up}[root.findtext("c:asset/c:up_axis", None, ns)]
    materials = {m.get("id"): m.get("name") for m in root.iterfind("c:library_materials/c:material", ns)}
    geometries = {g.get("id"): g for g in root.iterfind("c:library_geometries/c:geometry", ns)}
    faces = []

    def read_mesh(thing, geometry, symbols, matrix):
        mesh = geometry.find("c:mesh", ns)
        source = mesh.find("c:vertices/c:input[@semantic='POSITION']", ns).get("source")[1:]
        values = list(map(float, mesh.findtext(f"c:source[@id='{source}']/c:float_array", "", ns).split()))
        points = [convert(moved(matrix, values[i:i + 3])) for i in range(0, len(values), 3)]
        points = [tuple(metres * c for c in point) for point in points]
        step = -1 if determinant(matrix) < 0 else 1
        for part in [*mesh.iterfind("c:triangles", ns), *mesh.iterfind("c:polylist", ns)]:
            inputs = part.findall("c:input", ns)
            stride = 1 + max(int(i.get("offset")) for i in inputs)
            offset = next(int(i.get("offset")) for i in inputs if i.get("semantic") == "VERTEX")
            corners = list(map(int, (part.findtext("c:p", "", ns) or "").split()))[offset::stride]
            counts = list(map(int, part.findtext("c:vcount", "", ns).split())) or [3] * (len(corners) // 3)
            material, at = materials.get(symbols.get(part.get("material"))), 0
            for n in counts:
                faces.append((thing, material, [points[k] for k in corners[at:at + n]][::step]))
                at += n

    def visit(node, parent):
        matrix = parent
        told = node.find("c:matrix", ns)
        if told is not None:
            v = list(map(float, told.text.split()))
            matrix = times(parent, [v[0:4], v[4:8], v[8:12], v[12:16]])
        for instance in node.iterfind("c:instance_geometry", ns):
            symbols = {m.get("symbol"): m.get("target")[1:] for m in instance.iter(f"{{{ns['c']}}}instance_material")}
            read_mesh(node.get("name"), geometries[instance.get("url")[1:]], symbols, matrix)
        for child in node.iterfind("c:node", ns):
            visit(child, matrix)

    for node in root.iterfind("c:library_visual_scenes/c:visual_scene/c:node", ns):
        visit(node, IDENTITY)
    return faces


def fbx_nodes(data, offset, end):
    """Yields the nodes (name, values, children) of a binary FBX file of version 7.4."""
    while offset < end:
        stop, count, _, length = struct.unpack_from("<IIIB", data, offset)
        if stop == 0:
            return
        name, at, values = data[offset + 13:offset + 13 + length].decode(), offset + 13 + length, []
        for _ in range(count):
            kind, at = chr(data[at]), at + 1
            if kind in "CYIFDL":
                form = {"C": "<?", "Y": "<h", "I": "<i", "F": "<f", "D": "<d", "L": "<q"}[kind]
                values.append(struct.unpack_from(form, data, at)[0])
                at += struct.calcsize(form)
            elif kind in "SR":
                size = struct.unpack_from("<I", data, at)[0]
                values.append(data[at + 4:at + 4 + size])
                at += 4 + size
            else:
                _, packed, size = struct.unpack_from("<III", data, at)
                raw = data[at + 12:at + 12 + size]
                values.append(array.array({"f": "f", "d": "d", "i": "i", "l": "q", "b": "b"}[kind], zlib.decompress(raw) if packed else raw))
                at += 12 + size
        yield name, values, list(fbx_nodes(data, at, stop))
        offset = stop


def fbx_matrix(properties):
    """Returns a model's own matrix: translation, then rotation about x, y and z in degrees, then scale."""
    given = lambda key, default: properties.get(key, default)
    (x, y, z), s = map(math.radians, given(b"Lcl Rotation", (0, 0, 0))), given(b"Lcl Scaling", (1, 1, 1))
    rx = [[1, 0, 0, 0], [0, math.cos(x), -math.sin(x), 0], [0, math.sin(x), math.cos(x), 0], [0, 0, 0, 1]]
    ry = [[math.cos(y), 0, math.sin(y), 0], [0, 1, 0, 0], [-math.sin(y), 0, math.cos(y), 0], [0, 0, 0, 1]]
    rz = [[math.cos(z), -math.sin(z), 0, 0], [math.sin(z), math.cos(z), 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
    r, t = times(rz, times(ry, rx)), given(b"Lcl Translation", (0, 0, 0))
    return [[*(r[i][j] * s[j] for j in range(3)), t[i]] for i in range(3)] + [[0, 0, 0, 1]]


def read_fbx(name):
    data = open(os.path.join(FOLDER, name), "rb").read()
    assert data.startswith(b"Kaydara FBX Binary") and struct.unpack_from("<I", data, 23)[0] == 7400
    tree = {key: (values, children) for key, values, children in fbx_nodes(data, 27, len(data))}

    def properties(children):
        rows = next((c for key, _, c in children if key == "Properties70"), [])
        return {values[0]: values[4:] for _, values, _ in rows}

    told = properties(tree["GlobalSettings"][1])
    metres = told[b"UnitScaleFactor"][0] / 100  # the unit is UnitScaleFactor centimetres
    convert = {1: z_up, 2: lambda p: p}[told[b"UpAxis"][0]]
    objects = {values[0]: (key, values, children) for key, values, children in tree["Objects"][1]}
    children_of, parent_of = {}, {}
    for _, values, _ in tree["Connections"][1]:
        children_of.setdefault(values[2], []).append(values[1])
        if objects.get(values[1], ("",))[0] == "Model":
            parent_of[values[1]] = values[2]
    plain = lambda name: name.split(b"\0")[0].decode()

    def world(model):
        own = fbx_matrix(properties(objects[model][2]))
        return times(world(parent_of[model]), own) if parent_of.get(model) in objects else own

    faces = []
    for model, (key, values, _) in objects.items():
        linked = [objects[child] for child in children_of.get(model, ()) if child in objects] if key == "Model" else []
        materials = [plain(v[1]) for k, v, _ in linked if k == "Material"]
        for _, _, geometry in [g for g in linked if g[0] == "Geometry"]:
            parts = {k: (v, c) for k, v, c in geometry}
            if "PolygonVertexIndex" not in parts:
                continue
            v, matrix = parts["Vertices"][0][0], world(model)
            points = [tuple(metres * c for c in convert(moved(matrix, v[i:i + 3]))) for i in range(0, len(v), 3)]
            slots = next((list(v[0]) for k, v, _ in parts.get("LayerElementMaterial", ([], []))[1] if k == "Materials"), [0])
            step, corners, count = -1 if determinant(matrix) < 0 else 1, [], 0
            for index in parts["PolygonVertexIndex"][0][0]:
                corners.append(points[~index if index < 0 else index])
                if index < 0:  # the last corner of a polygon
                    slot = slots[count if len(slots) > 1 else 0]
                    faces.append((plain(values[1]), materials[slot] if materials else None, corners[::step]))
                    corners, count = [], count + 1
    return faces


# Figures.

def figures(faces):
    """Returns what expected.json tells of a set of faces. A polygon's area is the length of its vector area."""
    area = volume = 0.0
    for _, _, points in faces:
        fan = [cross(minus(points[i], points[0]), minus(points[i + 1], points[0])) for i in range(1, len(points) - 1)]
        whole = [sum(column) for column in zip(*fan)]
        area += math.hypot(*whole) / 2
        volume += sum(a * b for a, b in zip(points[0], whole)) / 6
    return {"polygons": len(faces), "triangles": sum(len(points) - 2 for *_, points in faces), "area_m2": area, "signed_volume_m3": volume}


def bounds(faces):
    points = [point for *_, face in faces for point in face]
    return [[pick(point[axis] for point in points) for axis in range(3)] for pick in (min, max)]


def grouped(faces, key):
    groups = {}
    for face in faces:
        groups.setdefault(face[key] or "", []).append(face)
    return {name: figures(group) for name, group in groups.items()}


# Comparison.

failures = 0


def expect(ok, message):
    global failures
    if not ok:
        failures += 1
        print(f"  DIFFERS: {message}")


def near(found, wanted, tolerance):
    return abs(found - wanted) <= tolerance


def compare(where, found, wanted, triangulated, tolerance):
    """Compares the figures of a file with those of Blender. `wanted` may lack some figures."""
    if not triangulated and "polygons" in wanted:
        expect(found["polygons"] == wanted["polygons"], f"{where}: {found['polygons']} polygons, not {wanted['polygons']}")
    expect(found["triangles"] == wanted["triangles"], f"{where}: {found['triangles']} triangles, not {wanted['triangles']}")
    area = wanted["area_m2"] if triangulated else wanted["polygon_area_m2"]
    expect(near(found["area_m2"], area, tolerance * max(area, 1)), f"{where}: area {found['area_m2']:.6f}, not {area:.6f}")
    if "signed_volume_m3" in wanted:
        expect(near(found["signed_volume_m3"], wanted["signed_volume_m3"], tolerance * 60),
               f"{where}: signed volume {found['signed_volume_m3']:.6f}, not {wanted['signed_volume_m3']:.6f}")


def check(name, faces, truth, *, spelling=lambda text: text, tolerance=2e-5):
    """Compares one file with the truth, as changed by its entry under `formats`. `tolerance` is relative; files hold 32-bit floats."""
    told = truth["formats"][name]
    triangulated = told["triangulated"]
    total, found = truth["total"] | told.get("total", {}), figures(faces)
    print(f"{name}: {found['polygons']} polygons, {found['triangles']} triangles, {found['area_m2']:.4f} m2, "
          f"signed volume {found['signed_volume_m3']:.4f} m3")
    compare("all", found, total, triangulated, tolerance)
    for found_corner, corner in zip(bounds(faces), total["bounds_m"]):
        expect(all(near(a, b, 1e-5) for a, b in zip(found_corner, corner)), f"bounds {found_corner}, not {corner}")
    for kind, key in (("objects", 0), ("materials", 1)):
        if not any(face[key] for face in faces):
            continue
        groups = grouped(faces, key)
        changed = {thing: figures | told.get(kind, {}).get(thing, {}) for thing, figures in truth[kind].items()}
        wanted = {spelling(thing): figures for thing, figures in changed.items() if figures["triangles"]}
        expect(groups.keys() == wanted.keys(), f"{kind} {sorted(groups.keys() ^ wanted.keys())} in one of both only")
        for thing in groups.keys() & wanted.keys():
            compare(f"{kind[:-1]} '{thing}'", groups[thing], wanted[thing], triangulated, tolerance)


def check_gltf_settings(name, truth):
    """Compares lamps and materials of a glTF file with Blender's."""
    gltf, _ = gltf_parts(name)
    lamps = {n["name"]: gltf["extensions"]["KHR_lights_punctual"]["lights"][n["extensions"]["KHR_lights_punctual"]["light"]]
             for n in gltf["nodes"] if "KHR_lights_punctual" in n.get("extensions", {})}
    for lamp in truth["lamps"]:
        matrix = gltf_matrix(next(node for node in gltf["nodes"] if node["name"] == lamp["name"]))  # lamps are at the root
        for what, column, sign in (("position_m", 3, 1), ("direction", 2, -1)):
            found = z_up([sign * matrix[i][column] for i in range(3)])
            expect(all(near(a, b, 1e-5) for a, b in zip(found, lamp[what])), f"{lamp['name']}: {what} {found}")
        if lamp["kind"] == "AREA":
            expect(lamp["name"] not in lamps, "an area lamp is exported after all")
            continue
        found = lamps[lamp["name"]]
        wanted = 683 * (lamp["irradiance_w_per_m2"] if lamp["kind"] == "SUN" else lamp["power_w"] / (4 * math.pi))
        expect(near(found["intensity"], wanted, 1e-3), f"{lamp['name']}: intensity {found['intensity']}, not {wanted}")
        if lamp["kind"] == "SPOT":
            expect(near(found["spot"]["outerConeAngle"], math.radians(lamp["full_angle_degrees"] / 2), 1e-5), "the spot's angle")
    for material in gltf["materials"]:
        wanted, pbr, extensions = truth["materials"][material["name"]], material["pbrMetallicRoughness"], material.get("extensions", {})
        strength = extensions.get("KHR_materials_emissive_strength", {}).get("emissiveStrength", 1)
        if not wanted["emission_texture"]:
            emission = [strength * channel for channel in material.get("emissiveFactor", (0, 0, 0))]
            expect(all(near(a, b, 1e-5) for a, b in zip(emission, wanted["emission_linear"])), f"{material['name']}: emission {emission}")
        if not wanted["base_colour_texture"]:
            colour = pbr.get("baseColorFactor", (1, 1, 1, 1))
            expect(all(near(a, b, 1e-6) for a, b in zip(colour, [*wanted["base_colour_linear"], wanted["alpha"]])),
                   f"{material['name']}: colour {colour}")
        expect(pbr.get("metallicFactor", 1) == wanted["metallic"], f"{material['name']}: metallic")
        expect(material.get("doubleSided", False) == wanted["two_sided"], f"{material['name']}: two-sided")
        transmission = extensions.get("KHR_materials_transmission", {}).get("transmissionFactor", 0)
        expect(transmission == wanted["transmission"], f"{material['name']}: transmission")
        mode = {"OPAQUE": "OPAQUE", "CLIP": "MASK", "BLEND": "BLEND"}[wanted["alpha_mode"]]
        expect(material.get("alphaMode", "OPAQUE") == mode, f"{material['name']}: alpha mode")


def check_mtl_settings(name, truth):
    """Compares a material file with Blender's materials."""
    found = {}
    for line in open(os.path.join(FOLDER, name), encoding="utf-8"):
        key, *words = line.split() or [""]
        if key == "newmtl":
            material = found[" ".join(words)] = {}
        elif words and key != "#":
            material[key] = words
    for title, wanted in truth["materials"].items():
        if "metallic" not in wanted:
            continue
        told, floats = found[title.replace(" ", "_")], lambda words: [float(word) for word in words]
        if not wanted["emission_texture"]:
            expect(all(near(a, b, 1e-5) for a, b in zip(floats(told["Ke"]), wanted["emission_linear"])), f"{title}: Ke {told['Ke']}")
        if wanted["base_colour_texture"]:
            expect(" ".join(told["map_Kd"]) == wanted["base_colour_texture"] and "Kd" not in told, f"{title}: {told}")
        else:
            expect(all(near(a, b, 1e-5) for a, b in zip(floats(told["Kd"]), wanted["base_colour_linear"])), f"{title}: Kd {told['Kd']}")
        if wanted["alpha_mode"] != "CLIP":
            expect(near(float(told["d"][0]), wanted["alpha"], 1e-5), f"{title}: d {told['d']}")


def main():
    truth = json.load(open(os.path.join(FOLDER, "expected.json"), encoding="utf-8"))
    underscored = lambda text: text.replace(" ", "_")
    for name in ("room.glb", "room.gltf", "room_extras.gltf"):
        check(name, read_gltf(name), truth)
        check_gltf_settings(name, truth)
    check("room.obj", read_obj("room.obj", z_up), truth, spelling=underscored)
    check("room_z_up.obj", read_obj("room_z_up.obj", lambda point: point), truth, spelling=underscored)
    for name in ("room.mtl", "room_z_up.mtl"):
        check_mtl_settings(name, truth)
    check("room.ply", read_ply("room.ply"), truth)
    check("room.stl", read_stl("room.stl"), truth)
    # The Collada exporter cuts quads along the shorter diagonal: where they are not flat, areas differ from those of Blender's own cut.
    check("room.dae", read_dae("room.dae"), truth, tolerance=2e-4)
    check("room.fbx", read_fbx("room.fbx"), truth)
    print("All files agree with expected.json." if not failures else f"{failures} differences")
    sys.exit(failures != 0)


main()
