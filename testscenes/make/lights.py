#!/usr/bin/env python3
"""Writes the scenes that show lights: sun and sky, portals, an environment map, lamps.

    python3 testscenes/make/lights.py

writes into testscenes, and a picture into testscenes/textures; the same every time. It needs Python 3 alone.
"""

import math

from models import ROOT, write_png

MODES = ["bidirectional", "metropolis", "aperture_diffraction"]


def write(name, text):
    (ROOT / name).write_text(f'<?xml version="1.0" encoding="utf-8"?>\n{text}', encoding="utf-8")


def scene(name, what, body, pre_scale=0.3, burn=6, bidirectional=False):
    """A whole scene; `what` tells what it shows."""
    on = {"bidirectional": bidirectional}
    modes = "".join(f"        <{m}>{str(on.get(m, False)).lower()}</{m}>\n" for m in MODES)
    lines = "\n".join(f"    {line}" if line else "" for line in what.strip().split("\n"))
    write(
        name,
        f"""<!--
{lines}

    Written by make/lights.py.
-->
<scene>
    <renderer_settings>
        <width>640</width>
        <height>480</height>
        <super_sample_factor>2</super_sample_factor>
{modes}    </renderer_settings>
    <tonemapping>
        <reinhard><pre_scale>{pre_scale:g}</pre_scale><post_scale>1</post_scale><burn>{burn:g}</burn></reinhard>
    </tonemapping>
{body}</scene>
""",
    )


def part(name, what, body):
    """Something for scenes to include."""
    write(name, f"<!-- {what} Written by make/lights.py. -->\n<scenedata>\n{body}</scenedata>\n")


def include(name):
    return f"    <include><pathname>{name}</pathname></include>\n"


def camera(pos, forwards, dist=0.035, white="D65", focus=6.0):
    return f"""    <camera>
        <pos>{pos}</pos>
        <up>0 0 1</up>
        <forwards>{forwards}</forwards>
        <aperture_radius>0.001</aperture_radius>
        <focus_distance>{focus:g}</focus_distance>
        <aspect_ratio>1.33333</aspect_ratio>
        <sensor_width>0.036</sensor_width>
        <lens_sensor_dist>{dist}</lens_sensor_dist>
        <white_balance>{white}</white_balance>
    </camera>
"""


def material(name, body):
    return f"    <material>\n        <name>{name}</name>\n        {body}\n    </material>\n"


def rgb(colour):
    return f"<rgb><rgb>{colour}</rgb><gamma>2.2</gamma></rgb>"


def matt(name, colour):
    return material(name, f"<diffuse><albedo_spectrum>{rgb(colour)}</albedo_spectrum></diffuse>")


def tiled(name, uv_set):
    texture = f"<uv_set>{uv_set}</uv_set><path>textures/tiles.png</path><exponent>2.2</exponent>"
    return material(name, f"<diffuse><albedo_texture>{texture}</albedo_texture></diffuse>")


def glazed(name, colour, exponent):
    ground = f"<diffuse_albedo_spectrum>{rgb(colour)}</diffuse_albedo_spectrum>"
    return material(name, f"<phong>{ground}<ior>1.5</ior><exponent>{exponent}</exponent></phong>")


def metal(name, nk, exponent):
    return material(name, f"<phong><nk_data>nkdata/{nk}.nk</nk_data><exponent>{exponent}</exponent></phong>")


def mesh(name, of, faces, uv=None):
    """Convex faces, counter-clockwise seen from the front; `uv` gives the coordinates of a point's set."""
    vertices, triangles = [], []
    for face in faces:
        first = len(vertices)
        for point in face:
            at = "" if uv is None else ' uv0="{:g} {:g}"'.format(*uv(point))
            vertices.append('            <vertex pos="{:g} {:g} {:g}"{}/>'.format(*point, at))
        triangles += [f"<tri>{first} {first + i} {first + i + 1}</tri>" for i in range(1, len(face) - 1)]
    rows = ["                " + "".join(triangles[i : i + 4]) for i in range(0, len(triangles), 4)]
    exposed = f"<expose_uv_set><index>0</index><name>{name}</name></expose_uv_set>"
    head = [] if uv is None else ["            " + exposed]
    inside = "\n".join([*head, *vertices, "            <triangle_set>", f"                <material_name>{of}</material_name>", *rows, "            </triangle_set>"])
    return f"""    <mesh>
        <name>{name}</name>
        <normal_smoothing>false</normal_smoothing>
        <embedded>
{inside}
        </embedded>
    </mesh>
"""


def external(name, path):
    return f"""    <mesh>
        <name>{name}</name>
        <normal_smoothing>true</normal_smoothing>
        <external><path>{path}</path></external>
    </mesh>
"""


def placed(element, name, pos="0 0 0", more="", scale=1.0):
    inside = f"<pos>{pos}</pos><scale>{scale:g}</scale>{more}<mesh_name>{name}</mesh_name>"
    return f"    <{element}>{inside}</{element}>\n"


def turned(matrix):
    return f"<rotation><matrix>{matrix}</matrix></rotation>"


def sphere(of, centre, radius):
    inside = f"<center>{centre}</center><radius>{radius:g}</radius><material_name>{of}</material_name>"
    return f"    <sphere>{inside}</sphere>\n"


def ground(of):
    return f"    <plane><normal>0 0 1</normal><dist>0</dist><material_name>{of}</material_name></plane>\n"


def box(low, high):
    (a, b, c), (d, e, f) = low, high
    return [
        [(a, b, c), (a, e, c), (d, e, c), (d, b, c)],
        [(a, b, f), (d, b, f), (d, e, f), (a, e, f)],
        [(a, b, c), (d, b, c), (d, b, f), (a, b, f)],
        [(a, e, c), (a, e, f), (d, e, f), (d, e, c)],
        [(a, b, c), (a, b, f), (a, e, f), (a, e, c)],
        [(d, b, c), (d, e, c), (d, e, f), (d, b, f)],
    ]


def boxes(*pairs):
    return [face for low, high in pairs for face in box(low, high)]


def skylight(sundir, turbidity, more=""):
    return f"    <skylight><sundir>{sundir}</sundir><turbidity>{turbidity}</turbidity>{more}</skylight>\n"


def courtyards():
    """A court 12 m wide with an arcade behind, a fountain, and orange trees in tubs."""
    body = matt("default", "0.86 0.79 0.68") + matt("plaster", "0.88 0.70 0.52") + matt("roof", "0.68 0.38 0.27")
    body += matt("leaves", "0.24 0.40 0.15") + matt("oranges", "0.93 0.50 0.10") + tiled("paving", "paving")
    body += external("column", "models/column.ply") + external("arch", "models/arch.ply")
    court = [(-6.2, -9, 0), (6.2, -9, 0), (6.2, 9, 0), (-6.2, 9, 0)]
    body += mesh("paving", "paving", [court], uv=lambda p: (p[0] / 0.6, p[1] / 0.6)) + placed("model", "paving")
    walls = [((-6.2, 8, 0), (6.2, 8.4, 6.6)), ((-6.6, -9, 0), (-6.2, 8.4, 6.6)), ((6.2, -9, 0), (6.6, 8.4, 6.6))]
    body += mesh("walls", "plaster", boxes(*walls, ((-6.2, 5.2, 4.4), (6.2, 5.6, 6.6)))) + placed("model", "walls")
    body += mesh("roof", "roof", boxes(((-6.2, 4.9, 6.6), (6.2, 8.4, 6.75)))) + placed("model", "roof")
    # The spaces between the arches, and a ledge over them.
    stone = [((-6.2, 5.2, 2.4), (-6, 5.6, 4.4)), ((6, 5.2, 2.4), (6.2, 5.6, 4.4)), ((-6.2, 5.1, 4.35), (6.2, 5.6, 4.5))]
    stone += [((-6.2, 5.2, 4.2), (6.2, 8, 4.4))]
    body += mesh("stone", "default", boxes(*stone)) + placed("model", "stone")
    body += "".join(placed("model", "column", f"{x} 5.4 0") for x in (-6, -3, 0, 3, 6))
    body += "".join(placed("model", "arch", f"{x} 5.4 0") for x in (-4.5, -1.5, 1.5, 4.5))
    basin = []
    for i in range(8):
        a, b = (math.pi * (k - 0.5) / 4 for k in (i, i + 1))
        low = [(r * math.cos(t), r * math.sin(t)) for r in (1.1, 0.9) for t in (a, b)]
        (ax, ay), (bx, by), (cx, cy), (dx, dy) = low
        basin += [
            [(ax, ay, 0), (bx, by, 0), (bx, by, 0.55), (ax, ay, 0.55)],
            [(dx, dy, 0), (cx, cy, 0), (cx, cy, 0.55), (dx, dy, 0.55)],
            [(ax, ay, 0.55), (bx, by, 0.55), (dx, dy, 0.55), (cx, cy, 0.55)],
        ]
    body += mesh("basin", "default", basin) + placed("model", "basin", "-1 0.6 0")
    for x, y in ((-4.6, 3.2), (4.4, 3.4), (3.9, -1.8)):
        tub = boxes(((x - 0.35, y - 0.35, 0), (x + 0.35, y + 0.35, 0.6)), ((x - 0.05, y - 0.05, 0.6), (x + 0.05, y + 0.05, 1.4)))
        body += mesh(f"tub {x:g}", "roof", tub) + placed("model", f"tub {x:g}")
        body += sphere("leaves", f"{x:g} {y:g} 1.9", 0.75)
        for i in range(9):
            a, z = 2.4 * i, (i - 4) / 5.5
            across = 0.74 * math.sqrt(1 - z * z)
            at = (x + across * math.cos(a), y + across * math.sin(a), 1.9 + 0.74 * z)
            body += sphere("oranges", "{:.3f} {:.3f} {:.3f}".format(*at), 0.09)
    body += camera("1.2 -8.6 1.75", "-0.1 1 0.02", 0.0255, "D55", 9)
    part("courtyard.igs", "A court with an arcade, without light.", body)
    for name, sun, height in [
        ("morning", "-1 -0.75 0.22", "10 degrees high: long shadows, warm light, a pale sky"),
        ("forenoon", "-0.75 -0.8 0.75", "34 degrees high, from the left"),
        ("noon", "-0.45 -0.35 1.3", "66 degrees high: short shadows, and a dark arcade that the paving lights"),
    ]:
        what = f"A courtyard in the {name}." if name != "noon" else "A courtyard at noon."
        scene(f"courtyard_{name}.igs", f"{what}\n\nThe sun is {height}.", include("courtyard.igs") + skylight(sun, 2.5))


def skies():
    """A plain with a row of posts and a ball, towards the sun."""
    body = matt("ground", "0.52 0.50 0.46") + matt("ball", "0.85 0.85 0.85") + matt("post", "0.75 0.30 0.24")
    body += ground("ground") + sphere("ball", "-1.7 7.5 1", 1)
    posts = boxes(*(((2 - 0.08, y - 0.08, 0), (2 + 0.08, y + 0.08, 1.2)) for y in (5, 7.5, 11, 16, 24)))
    body += mesh("posts", "post", posts) + placed("model", "posts")
    body += camera("0 0 1.7", "0 1 0.16", 0.022, "D65", 8)
    part("sky.igs", "A plain with a ball and posts, without light.", body)
    for turbidity, air in ((2, "very clear air"), (4, "some haze"), (8, "thick haze")):
        what = f"The sky round the sun at turbidity {turbidity}: {air}.\n\nThe sun's disc stands in the picture, of its true size: half a degree."
        scene(f"sky_{turbidity}.igs", what, include("sky.igs") + skylight("0.35 1 0.45", turbidity), 0.5, 9)
    what = "The sun without an atmosphere (extra_atmospheric): the sky is black, and shadows get what the ground\nsends back alone."
    outside = skylight("0.35 1 0.45", 2, "<extra_atmospheric>true</extra_atmospheric>")
    scene("sky_space.igs", what, include("sky.igs") + outside, 1.6, 8)


def garden():
    """Shrubs on both sides, as high as the windows show: they turn their shaded sides to the room."""
    text = ""
    for i in range(150):
        along, up, out = (i * 0.618034) % 1, (i % 5) / 5, (i * 0.754878) % 1
        place = (-6.6 - 0.9 * out, -3 + 15 * along) if i % 3 else (-5 + 10 * along, 11 + out)
        radius = 0.55 + 0.3 * ((i * 0.569840) % 1)
        centre = f"{place[0]:.2f} {place[1]:.2f} {-0.2 + 3.2 * up:.2f}"
        text += sphere("young leaves" if i % 7 < 3 else "leaves", centre, round(radius, 2))
    return text


def portal_room():
    """A room of 4 by 6 by 2.6 m; a large window on the left and a small one in the back wall."""
    body = matt("plaster", "0.90 0.88 0.84") + matt("wood", "0.60 0.42 0.27") + matt("cloth", "0.28 0.42 0.55")
    body += matt("lawn", "0.26 0.36 0.14") + matt("cushion", "0.86 0.55 0.20") + glazed("vase", "0.75 0.22 0.16", 800)
    body += matt("leaves", "0.24 0.36 0.15") + matt("young leaves", "0.34 0.46 0.17")
    # Outside, below the floor.
    body += "    <plane><normal>0 0 1</normal><dist>-0.6</dist><material_name>lawn</material_name></plane>\n"
    body += garden()
    boards = [[(-2 + 0.2 * i, 0, 0), (-1.806 + 0.2 * i, 0, 0), (-1.806 + 0.2 * i, 6, 0), (-2 + 0.2 * i, 6, 0)] for i in range(20)]
    body += mesh("floor", "wood", boards + box((-2.2, -0.2, -0.2), (2.2, 6.2, -0.004))) + placed("model", "floor")
    shell = [((-2.2, -0.2, 2.6), (2.2, 6.2, 2.8)), ((2, 0, -0.2), (2.2, 6, 2.6)), ((-2.2, -0.2, -0.2), (2.2, 0, 2.6))]
    shell += [((-2.2, 0, -0.2), (-2, 2.2, 2.6)), ((-2.2, 4.9, -0.2), (-2, 6, 2.6))]
    shell += [((-2.2, 2.2, -0.2), (-2, 4.9, 0.8)), ((-2.2, 2.2, 2.2), (-2, 4.9, 2.6))]
    shell += [((-2.2, 6, -0.2), (0.5, 6.2, 2.6)), ((1.4, 6, -0.2), (2.2, 6.2, 2.6))]
    shell += [((0.5, 6, -0.2), (1.4, 6.2, 1.1)), ((0.5, 6, 2.1), (1.4, 6.2, 2.6))]
    body += mesh("shell", "plaster", boxes(*shell)) + placed("model", "shell")
    bars = [((-2.12, 3.5, 0.8), (-2.06, 3.56, 2.2)), ((-2.12, 2.2, 1.5), (-2.06, 4.9, 1.54)), ((0.93, 6.06, 1.1), (0.97, 6.12, 2.1))]
    sill = [((-2.2, 2.2, 0.8), (-1.9, 4.9, 0.83))]
    table = [((-1, 2.9, 0.4), (0, 3.9, 0.44))] + [((x, y, 0), (x + 0.05, y + 0.05, 0.4)) for x in (-0.95, -0.1) for y in (2.95, 3.8)]
    body += mesh("joinery", "wood", boxes(*bars, *sill, *table)) + placed("model", "joinery")
    sofa = [((1.05, 2.3, 0.08), (1.9, 4.7, 0.42)), ((1.7, 2.3, 0.42), (1.95, 4.7, 0.85))]
    sofa += [((1.05, 2.1, 0.08), (1.95, 2.3, 0.6)), ((1.05, 4.7, 0.08), (1.95, 4.9, 0.6))]
    body += mesh("sofa", "cloth", boxes(*sofa)) + placed("model", "sofa")
    body += mesh("cushions", "cushion", boxes(((1.5, 2.45, 0.42), (1.68, 2.95, 0.8)), ((1.5, 4.1, 0.42), (1.68, 4.55, 0.8)))) + placed("model", "cushions")
    body += sphere("vase", "-0.45 3.45 0.56", 0.12)
    # On the outside of the walls, so that no point of a reveal lies beyond; fronts towards the interior.
    body += mesh("large", "plaster", [[(-2.2, 2.2, 0.8), (-2.2, 4.9, 0.8), (-2.2, 4.9, 2.2), (-2.2, 2.2, 2.2)]])
    body += mesh("small", "plaster", [[(0.5, 6.2, 1.1), (1.4, 6.2, 1.1), (1.4, 6.2, 2.1), (0.5, 6.2, 2.1)]])
    body += placed("exit_portal", "large") + placed("exit_portal", "small")
    body += skylight("-1 -0.1 0.85", 3) + camera("0.35 0.3 1.45", "-0.09 1 -0.12", 0.02, "D55", 4)
    what = "A room that sun and sky light through two windows.\n\nA portal in each window leads light paths in; without them most would be lost on the walls outside.\nCompare without the exit_portal elements."
    scene("portal_room.igs", what, body, 0.42, 6)


def product():
    """A tea set in the middle of a studio's picture."""
    body = glazed("glaze", "0.10 0.30 0.42", 6000) + matt("table", "0.80 0.79 0.77")
    body += metal("gold", "au", 20000) + metal("silver", "ag", 300)
    body += include("../media/glass_bk7.igs")
    body += material("glass", "<specular><transparent>true</transparent><internal_medium_name>glass_bk7</internal_medium_name></specular>")
    body += external("teapot", "models/utah_teapot.obj")
    # A table that rises to a backdrop.
    profile = [(-14, 0), (5, 0)] + [(5 + 4 * math.sin(t), 4 - 4 * math.cos(t)) for t in (math.pi / 240 * i for i in range(1, 121))] + [(9, 12)]
    sweep = [[(-14, y0, z0), (14, y0, z0), (14, y1, z1), (-14, y1, z1)] for (y0, z0), (y1, z1) in zip(profile, profile[1:])]
    body += mesh("sweep", "table", sweep) + placed("model", "sweep")
    body += placed("model", "teapot", "0 0 0", turned("0.94 0 0.34 0.34 0 -0.94 0 1 0"))
    body += sphere("gold", "3.2 -2.6 0.7", 0.7) + sphere("silver", "-3.9 -0.9 0.9", 0.9) + sphere("glass", "-1.7 -3.4 0.6", 0.6)
    body += "    <env_map><latlong><path>env/studio_256x128_half.exr</path><gain>1e9</gain></latlong></env_map>\n"
    body += camera("0 -15 4.6", "0 1 -0.235", 0.058, "D65", 14)
    what = "A tea set in the light of a picture of a studio.\n\nGlaze, gold, brushed silver and glass show what the lamps of the studio look like."
    scene("env_product.igs", what, body, 0.45, 5)


def washed_wall():
    """Four lamps under a ceiling, 40 cm before a wall."""
    body = matt("wall", "0.82 0.78 0.72") + matt("floor", "0.42 0.34 0.28") + matt("black", "0 0 0")
    body += matt("frame", "0.2 0.16 0.12") + matt("bench", "0.30 0.34 0.32")
    body += mesh("room", "wall", [
        [(-4.2, 0, 0), (4.2, 0, 0), (4.2, 0, 3), (-4.2, 0, 3)],
        [(-4.2, -7, 3), (-4.2, 0, 3), (4.2, 0, 3), (4.2, -7, 3)],
        [(-4.2, -7, 0), (-4.2, 0, 0), (-4.2, 0, 3), (-4.2, -7, 3)],
        [(4.2, -7, 0), (4.2, -7, 3), (4.2, 0, 3), (4.2, 0, 0)],
    ]) + placed("model", "room")
    body += mesh("floor", "floor", [[(-4.2, -7, 0), (4.2, -7, 0), (4.2, 0, 0), (-4.2, 0, 0)]]) + placed("model", "floor")
    body += mesh("bench", "bench", boxes(((-1.6, -1.5, 0.38), (1.6, -1, 0.45)), ((-1.4, -1.45, 0), (-1.3, -1.05, 0.38)), ((1.3, -1.45, 0), (1.4, -1.05, 0.38)))) + placed("model", "bench")
    # A lamp of 10 cm that looks down.
    body += mesh("lamp", "black", [[(-0.05, -0.05, 0), (-0.05, 0.05, 0), (0.05, 0.05, 0), (0.05, -0.05, 0)]])
    warm = "<spectrum><blackbody><temperature>3000</temperature><gain>1</gain></blackbody></spectrum>"
    for i, file in enumerate(["lambert_1000cd", "spot_cos8_2000cd", "quadrant_bat", "irregular_angles"]):
        profile = f"<ies_profile><path>ies/{file}.ies</path></ies_profile>"
        body += placed("meshlight", "lamp", f"{-3 + 2 * i:g} -0.4 2.95", warm + profile)
    body += camera("0 -6.6 1.5", "0 1 0", 0.0275, "A", 6.6)
    what = "A wall washed by four measured lamps (ies_profile).\n\nFrom the left: even by the cosine, a narrow spot, one that throws light aside, and one of few angles."
    scene("ies_wall.igs", what, body, 0.34, 4, bidirectional=True)


# Red, amber, blue, green, clear and pale blue glass.
GLASS = [(0.80, 0.10, 0.07), (0.98, 0.72, 0.20), (0.10, 0.24, 0.78), (0.16, 0.55, 0.28), (0.95, 0.93, 0.80), (0.55, 0.78, 0.92)]


def window_height(x):
    """The height of a pointed arch over x, from -1 to 1: two arcs of radius 2 that meet at the middle."""
    return 2.2 + math.sqrt(4 - (abs(x) + 1) ** 2)


def stained(u, v):
    """The colour of a window 2 m wide and 4 m high at a point; coordinates from 0 to 1."""
    x, y = 2 * u - 1, 4 * v
    lead, stone = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    across, up = x, y - 2.75
    r, turn = math.hypot(across, up), math.atan2(up, across) / (2 * math.pi)
    if r < 0.66:
        # A rose of twelve petals.
        petal = (turn * 12) % 1
        if r < 0.15:
            return GLASS[1]
        if abs(r - 0.17) < 0.02 or abs(r - 0.42) < 0.012 or min(petal, 1 - petal) * r < 0.035:
            return lead
        ring = r < 0.42
        return GLASS[0 if ring else 2] if int(turn * 12 + 12) % 2 else GLASS[2 if ring else 0]
    if r < 0.72:
        return stone
    if y > 2.02:
        # Spandrels beside the rose.
        return lead if (4 * x + 3 * y) % 1 < 0.08 or (4 * x - 3 * y) % 1 < 0.08 else GLASS[5]
    # Two lancets of lozenges with a border.
    a = abs(x) - 0.5
    if abs(a) > 0.46 or y < 0.05 or y > 1.96:
        return stone
    if abs(a) > 0.36 or y < 0.16 or y > 1.86:
        joint = (y * 6) % 1 < 0.1 or abs(abs(a) - 0.37) < 0.012
        return lead if joint else GLASS[4 if int(y * 6) % 2 else 0]
    s, t = 4 * a + 2.4 * y, 4 * a - 2.4 * y
    if min(s % 1, t % 1) < 0.07:
        return lead
    return GLASS[(5, 2, 4, 3, 5, 1)[(int(s + 20) * 2 + int(t + 20) * 3) % 6]]


def stained_glass():
    """The end of a nave with a window that shines."""
    write_png("stained_glass.png", 256, 512, stained)
    body = matt("stone", "0.76 0.73 0.67") + matt("black", "0.02 0.02 0.02") + glazed("floor", "0.42 0.38 0.34", 250)
    body += mesh("floor", "floor", [[(-3, -9, 0), (3, -9, 0), (3, 0, 0), (-3, 0, 0)]]) + placed("model", "floor")
    # The wall round the window, its outline from the left foot over the top to the right foot; and the reveal.
    xs = [math.sin(math.pi / 2 * (i / 12 - 1)) for i in range(25)]
    outline = [(-1, 0.0)] + [(x, window_height(x)) for x in xs] + [(1, 0.0)]
    at = [(x, 1 + z) for x, z in outline]
    faces = [[(-3, 0, 0), (3, 0, 0), (3, 0, 1), (-3, 0, 1)], [(-3, 0, 1), (-1, 0, 1), (-1, 0, 3.2), (-3, 0, 3.2)], [(1, 0, 1), (3, 0, 1), (3, 0, 3.2), (1, 0, 3.2)]]
    for (x0, z0), (x1, z1) in zip(at[1:], at[2:-1]):
        faces.append([(x0, 0, z0), (x1, 0, z1), (x1, 0, 7), (x0, 0, 7)])
    faces += [[(-3, 0, 3.2), (-1, 0, 3.2), (-1, 0, 7), (-3, 0, 7)], [(1, 0, 3.2), (3, 0, 3.2), (3, 0, 7), (1, 0, 7)]]
    loop = at[::-1]
    for (x0, z0), (x1, z1) in zip(loop, loop[1:] + loop[:1]):
        faces.append([(x0, 0, z0), (x1, 0, z1), (x1, 0.35, z1), (x0, 0.35, z0)])
    faces += [[(-3, -9, 0), (-3, 0, 0), (-3, 0, 7), (-3, -9, 7)], [(3, -9, 0), (3, -9, 7), (3, 0, 7), (3, 0, 0)], [(-3, -9, 7), (-3, 0, 7), (3, 0, 7), (3, -9, 7)]]
    body += mesh("nave", "stone", faces) + placed("model", "nave") + external("column", "models/column.ply")
    body += matt("default", "0.76 0.73 0.67")
    body += "".join(placed("model", "column", f"{x} {y} 0", scale=1.7) for x in (-2.1, 2.1) for y in (-5, -1.6))
    pane = [[(x0, 0.34, 1), (x1, 0.34, 1), (x1, 0.34, z1), (x0, 0.34, z0)] for (x0, z0), (x1, z1) in zip(at[1:], at[2:-1])]
    body += mesh("window", "black", pane, uv=lambda p: ((p[0] + 1) / 2, (p[2] - 1) / 4))
    spectrum = "<spectrum><blackbody><temperature>6500</temperature><gain>1</gain></blackbody></spectrum>"
    power = "<efficacy_scale><power_drawn>200</power_drawn><overall_luminous_efficacy>30</overall_luminous_efficacy></efficacy_scale>"
    texture = "<texture><uv_set>window</uv_set><path>textures/stained_glass.png</path><exponent>2.2</exponent></texture>"
    body += placed("meshlight", "window", more=spectrum + power + texture)
    body += camera("0.5 -8.6 1.7", "-0.045 1 0.09", 0.029, "D65", 8)
    what = "A stained-glass window that shines: 6000 lm, modulated by a picture.\n\nPoints of the window are drawn by the brightness of its panes; the polished floor mirrors it."
    scene("stained_glass.igs", what, body, 0.13, 14, bidirectional=True)


def main():
    courtyards()
    skies()
    portal_room()
    product()
    washed_wall()
    stained_glass()


if __name__ == "__main__":
    main()
