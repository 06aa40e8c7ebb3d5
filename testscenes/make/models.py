#!/usr/bin/env python3
"""Makes the models and textures of the test scenes that are nobody's but ours.

    python3 testscenes/make/models.py

writes into testscenes/models and testscenes/textures; the same every time. It needs Python 3 alone.
"""

import math
import struct
import zlib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def smooth_normals(points, faces):
    """For each point the mean of the normals of its faces, weighted by their areas."""
    sums = [[0.0, 0.0, 0.0] for _ in points]
    for face in faces:
        # Across the diagonals: right for triangles and quadrilaterals, planar or not.
        a, b, c, d = (points[face[i % len(face)]] for i in (0, 1, 2, 3))
        u, v = [c[k] - a[k] for k in range(3)], [d[k] - b[k] for k in range(3)]
        normal = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        for i in face:
            for k in range(3):
                sums[i][k] += normal[k]
    return [tuple(x / (math.hypot(*sum_) or 1.0) for x in sum_) for sum_ in sums]


def write_ply(name, points, faces):
    """Binary little-endian PLY of at most 65536 positions, smooth normals and polygons."""
    head = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n"
        "property float x\nproperty float y\nproperty float z\n"
        "property float nx\nproperty float ny\nproperty float nz\n"
        f"element face {len(faces)}\nproperty list uchar ushort vertex_indices\nend_header\n"
    )
    with open(ROOT / "models" / name, "wb") as file:
        file.write(head.encode())
        for point, normal in zip(points, smooth_normals(points, faces)):
            file.write(struct.pack("<6f", *point, *normal))
        for face in faces:
            file.write(struct.pack(f"<B{len(face)}H", len(face), *face))


def write_obj(name, material, points, faces):
    """The same as text that names its material."""
    lines = [f"v {x:.7f} {y:.7f} {z:.7f}" for x, y, z in points]
    lines += [f"vn {x:.3f} {y:.3f} {z:.3f}" for x, y, z in smooth_normals(points, faces)]
    lines.append(f"usemtl {material}")
    lines += ["f " + " ".join(f"{i + 1}//{i + 1}" for i in face) for face in faces]
    (ROOT / "models" / name).write_text("\n".join(lines) + "\n", encoding="utf-8")


def write_png(name, width, height, colour):
    """Eight-bit RGB of `colour(u, v)` in [0, 1], each texel the mean of 4 x 4 points."""
    rows = bytearray()
    for row in range(height):
        rows.append(0)
        for column in range(width):
            points = [
                colour((column + (i + 0.5) / 4) / width, 1 - (row + (j + 0.5) / 4) / height)
                for i in range(4)
                for j in range(4)
            ]
            rows.extend(round(255 * sum(channel) / 16) for channel in zip(*points))

    def chunk(kind, data):
        body = kind + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    data = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(bytes(rows), 9))
    (ROOT / "textures" / name).write_bytes(data + chunk(b"IEND", b""))


def lathe(profiles, sides):
    """Profiles, each a list of (radius, height), turned about z.

    Where one profile ends and the next begins there is a crease: they share no vertices.
    """
    points, faces = [], []
    for profile in profiles:
        first = len(points)
        for radius, height in profile:
            for side in range(sides):
                angle = 2 * math.pi * side / sides
                points.append((radius * math.cos(angle), radius * math.sin(angle), height))
        for ring in range(len(profile) - 1):
            for side in range(sides):
                a = first + ring * sides + side
                b = first + ring * sides + (side + 1) % sides
                faces.append((a, b, b + sides, a + sides))
    return points, faces


def arc(centre, radius, start, end, steps):
    """Points (radius, height) of an arc in the profile plane, angles in degrees from the radius axis."""
    for step in range(steps + 1):
        angle = math.radians(start + (end - start) * step / steps)
        yield centre[0] + radius * math.cos(angle), centre[1] + radius * math.sin(angle)


def make_pawn():
    """A pawn of a chess set, 6 cm high, in two formats: a .ply file cannot name its material."""
    foot = [(0.0165, 0.0), (0.0165, 0.004)]
    step = [*arc((0.0145, 0.006), 0.0028, -45, 90, 8), (0.013, 0.0088)]
    body = [
        (0.0125 - 0.0072 * math.sin(math.pi / 2 * t / 16) ** 0.8, 0.0088 + 0.0275 * (t / 16) ** 1.25)
        for t in range(17)
    ]
    collar = [(0.0053, 0.0363), *arc((0.0088, 0.0383), 0.0016, -90, 90, 8), (0.005, 0.0399)]
    head = list(arc((0.0, 0.0487), 0.0098, -62, 89.9, 24))
    pawn = lathe([foot, step, body, collar, head], 36)
    write_ply("pawn.ply", *pawn)
    write_obj("pawn_black.obj", "ebony", *pawn)


def make_column():
    """A round column, 2.4 m high, with base and capital."""
    base = [(0.27, 0.0), *arc((0.25, 0.06), 0.06, -90, 90, 10), (0.22, 0.125)]
    torus = [(0.215, 0.14), *arc((0.205, 0.17), 0.03, -90, 90, 8), (0.195, 0.215)]
    # The shaft swells a little, as ancient ones do.
    shaft = [
        (0.175 - 0.03 * t / 12 + 0.008 * math.sin(math.pi * t / 12), 0.215 + 1.8 * t / 12) for t in range(13)
    ]
    ring = list(arc((0.15, 2.035), 0.02, -90, 90, 8))
    bell = [(0.15 + 0.13 * (t / 10) ** 2.2, 2.055 + 0.225 * t / 10) for t in range(11)]
    write_ply("column.ply", *lathe([base, torus, shaft, ring, bell], 40))


def make_arch():
    """One bay of an arcade in the plane of x and z: 3 m wide, springing at 2.4 m, 0.4 m thick."""
    half, radius, bottom, top, thick, steps = 1.5, 1.28, 2.4, 4.4, 0.2, 32
    curve = [
        (-radius * math.cos(math.pi * s / steps), bottom + radius * math.sin(math.pi * s / steps))
        for s in range(steps + 1)
    ]
    rim = [(max(-half, min(half, x * 1.9)), top if z > bottom + 0.2 else bottom) for x, z in curve]
    points, faces = [], []

    def quad(*corners):
        # At the corners of the wall two points fall into one: a triangle is left.
        corners = list(dict.fromkeys(corners))
        faces.append(tuple(range(len(points), len(points) + len(corners))))
        points.extend(corners)

    for (x0, z0), (x1, z1), (u0, w0), (u1, w1) in zip(curve, curve[1:], rim, rim[1:]):
        quad((x0, -thick, z0), (x1, -thick, z1), (u1, -thick, w1), (u0, -thick, w0))
        quad((x1, thick, z1), (x0, thick, z0), (u0, thick, w0), (u1, thick, w1))
        quad((x0, thick, z0), (x1, thick, z1), (x1, -thick, z1), (x0, -thick, z0))
    for side in (-1, 1):
        quad(
            (side * half, -thick, bottom), (side * half, thick, bottom),
            (side * radius, thick, bottom), (side * radius, -thick, bottom),
        )
    write_ply("arch.ply", points, faces)


# Middle and radius of the rocks of the sand garden, in metres.
ROCKS = [(-0.95, 0.45, 0.62), (1.15, -0.35, 0.36), (1.35, 1.45, 0.27)]


def sand_height(x, y):
    """Raked sand: straight furrows, and four rings round each rock."""
    pitch, depth, rings = 0.17, 0.019, 4
    nearest = min(math.hypot(x - cx, y - cy) - radius for cx, cy, radius in ROCKS)
    phase = nearest if nearest < rings * pitch else y
    wave = 0.5 + 0.5 * math.cos(2 * math.pi * phase / pitch)
    edge = abs(nearest - rings * pitch)
    return depth * wave * min(1.0, edge / 0.05)


def make_sand():
    """The sand garden: 6 m x 5 m of raked sand."""
    step, columns, rows = 0.03125, 193, 161
    points = []
    for row in range(rows):
        for column in range(columns):
            x, y = step * (column - columns // 2), step * (row - rows // 2)
            points.append((x, y, sand_height(x, y)))
    faces = [
        (a, a + 1, a + 1 + columns, a + columns)
        for row in range(rows - 1)
        for a in range(row * columns, row * columns + columns - 1)
    ]
    write_ply("sand.ply", points, faces)


def make_tower():
    """An include file: a round tower of loose bricks, each course turned by half a brick."""
    courses, bricks, height = 30, 12, 0.062
    lines = [
        '<?xml version="1.0" encoding="utf-8"?>',
        "<!-- The bricks of instances.igs, written by make/models.py. -->",
        "<scenedata>",
    ]
    for course in range(courses):
        t = course / (courses - 1)
        radius = 0.42 + 0.16 * math.sin(math.pi * (0.12 + 1.05 * t)) - 0.10 * t
        for brick in range(bricks):
            angle = 2 * math.pi * (brick + 0.5 * (course % 2) + 0.012 * course) / bricks
            # Radial, along the ring, up; the brick is stretched to leave the same gaps on every course.
            c, s, length = math.cos(angle), math.sin(angle), radius / 0.5
            kind = "abc"[(brick * 5 + course * 7 + course * brick) % 3]
            position = f"{radius * c:.4f} {radius * s:.4f} {height * (course + 0.5):.4f}"
            matrix = f"{c:.4f} {-s * length:.4f} 0 {s:.4f} {c * length:.4f} 0 0 0 1"
            lines.append(
                f"    <model><pos>{position}</pos><scale>1</scale>"
                f"<rotation><matrix>{matrix}</matrix></rotation><mesh_name>brick_{kind}</mesh_name></model>"
            )
    lines.append("</scenedata>\n")
    (ROOT / "instances_tower.igs").write_text("\n".join(lines), encoding="utf-8")


def checker(u, v):
    """Two by two squares of ivory and slate."""
    return (0.90, 0.87, 0.80) if (u < 0.5) == (v < 0.5) else (0.24, 0.28, 0.33)


def tiles(u, v):
    """A painted tile: quarter circles in the corners, a star in the middle, a fine joint."""
    ivory, blue, ochre, joint = (0.93, 0.90, 0.83), (0.16, 0.30, 0.52), (0.80, 0.55, 0.24), (0.62, 0.59, 0.54)
    x, y = abs(u - 0.5), abs(v - 0.5)
    if max(x, y) > 0.49:
        return joint
    corner = math.hypot(0.5 - x, 0.5 - y)
    star = min(x, y) * 1.9 + max(x, y)
    if corner < 0.14 or 0.30 < star < 0.345:
        return ochre
    if corner < 0.26 and corner > 0.18 or star < 0.25:
        return blue
    return ivory


def main():
    make_pawn()
    make_column()
    make_arch()
    make_sand()
    make_tower()
    write_png("checker.png", 64, 64, checker)
    write_png("tiles.png", 128, 128, tiles)


if __name__ == "__main__":
    main()
