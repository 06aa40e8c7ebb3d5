#!/usr/bin/env python3
"""Writes the scene of a prism that splits sunlight.

    python3 testscenes/make/prism.py

writes into testscenes; the same every time. It needs Python 3 alone.
"""

import math

from lights import include, material, matt, mesh, placed, write

# The sun grazes the table by this angle, so that its light draws lines on it, and stands this high above the horizon: the table
# is tilted by the difference.
GRAZING, ELEVATION = 5, 40
# Side and height of the prism, metres.
SIDE, HEIGHT = 0.036, 0.034
# The slit in the wall: width, height, depth, and where the wall stands.
SLIT, TALL, DEEP, WALL = 0.002, 0.044, 0.12, -0.13
# The walls of the room.
RIGHT, NEAR, FAR, CEILING = 0.5, -0.6, 0.3, 0.7
# The way through the glass of least deviation, clockwise from that of the sunlight: half the deviation of yellow light, of
# which the index is 1.728: 2 asin(1.728 sin 30°) - 60° = 59.5°.
INSIDE = -29.8


def world(point):
    """From the table's coordinates, with the sunlight along x, to those of the scene, with the zenith along z."""
    x, y, z = point
    c, s = (f(math.radians(ELEVATION - GRAZING)) for f in (math.cos, math.sin))
    return (x * c + z * s, y, z * c - x * s)


def tilted(name, of, faces):
    return mesh(name, of, [[world(p) for p in face] for face in faces])


def prism():
    corners = []
    for third in range(3):
        at = math.radians(INSIDE + 90 + 120 * third)
        corners.append((SIDE / math.sqrt(3) * math.cos(at), SIDE / math.sqrt(3) * math.sin(at)))
    # Half a millimetre above the table.
    low, high = ([(x, y, z) for x, y in corners] for z in (0.0005, HEIGHT))
    sides = [[low[i], low[(i + 1) % 3], high[(i + 1) % 3], high[i]] for i in range(3)]
    return tilted("prism", "flint", [low[::-1], high, *sides])


def middle():
    """Where the beam passes the prism: through the middle of the face where it enters."""
    at = math.radians(INSIDE + 150)
    return SIDE / math.sqrt(12) * math.sin(at)


def box(x0, x1, y0, y1, z0, z1):
    """The inside of a box without its floor and its left."""
    a, b, c, d = (x0, y0), (x1, y0), (x1, y1), (x0, y1)
    wall = lambda p, q: [(*q, z0), (*p, z0), (*p, z1), (*q, z1)]
    return [wall(a, b), wall(b, c), wall(c, d), [(x0, y1, z1), (x1, y1, z1), (x1, y0, z1), (x0, y0, z1)]]


def panel(y0, y1, z0, z1):
    """A part of the left wall, which faces the room."""
    return [(WALL, y0, z0), (WALL, y1, z0), (WALL, y1, z1), (WALL, y0, z1)]


def main():
    low, high = middle() - SLIT / 2, middle() + SLIT / 2
    # As deep as a door is wide: hardly any light of the sky comes through.
    sides = [[(WALL - DEEP, y, -0.03), (WALL, y, -0.03), (WALL, y, 0.08), (WALL - DEEP, y, 0.08)] for y in (low, high)]
    wall = [panel(NEAR, low, 0, CEILING), panel(high, FAR, 0, CEILING), panel(low, high, TALL, CEILING)]
    body = include("media/glass_sf10.igs")
    body += material("flint", "<specular><transparent>true</transparent><internal_medium_name>glass_sf10</internal_medium_name></specular>")
    body += matt("paper", "0.85 0.85 0.85") + matt("card", "0.25 0.25 0.26") + matt("black", "0 0 0")
    body += prism() + placed("model", "prism")
    body += tilted("table", "paper", [[(WALL, NEAR, 0), (RIGHT, NEAR, 0), (RIGHT, FAR, 0), (WALL, FAR, 0)]]) + placed("model", "table")
    body += tilted("room", "card", box(WALL, RIGHT, NEAR, FAR, 0, CEILING) + wall) + placed("model", "room")
    body += tilted("sides", "black", sides) + placed("model", "sides")
    body += tilted("slit", "black", [panel(low, high, 0, TALL)]) + placed("exit_portal", "slit")
    # So placed that the top of the prism mirrors it.
    body += tilted("lamp", "black", [[(-0.22, 0.29, 0.10), (0.10, 0.29, 0.10), (0.10, 0.22, 0.36), (-0.22, 0.22, 0.36)]])
    body += placed("meshlight", "lamp", more="<spectrum><blackbody><temperature>5500</temperature><gain>4.5e-7</gain></blackbody></spectrum>")
    body += tilted("ceiling", "black", [[(-0.12, -0.5, 0.6), (-0.12, 0.2, 0.6), (0.45, 0.2, 0.6), (0.45, -0.5, 0.6)]])
    body += placed("meshlight", "ceiling", more="<spectrum><blackbody><temperature>5500</temperature><gain>1.6e-7</gain></blackbody></spectrum>")
    sun = math.radians(ELEVATION)
    body += f"    <skylight><sundir>{-math.cos(sun):.6f} 0 {math.sin(sun):.6f}</sundir><turbidity>2</turbidity></skylight>\n"
    eye, at = (0.07, -0.31, 0.26), (0.042, -0.062, 0.0)
    p, q, up = world(eye), world(at), world((0, 0, 1))
    forwards = [b - a for a, b in zip(p, q)]
    numbers = lambda v: " ".join(f"{x:.6f}" for x in v)
    write(
        "prism.igs",
        f"""<!--
    Sunlight falls through a slit into a dark room and on a prism of flint glass, which fans it out into its colours.

    The prism stands at the angle of least deviation for yellow light. The table is tilted, so that the sun grazes it
    all along the way of its light. The portal in the slit leads light paths in, of which bidirectional path
    tracing joins every one to the camera.

    Written by make/prism.py.
-->
<scene>
    <renderer_settings>
        <width>480</width>
        <height>300</height>
        <super_sample_factor>1</super_sample_factor>
        <bidirectional>true</bidirectional>
        <metropolis>false</metropolis>
        <aperture_diffraction>false</aperture_diffraction>
    </renderer_settings>
    <tonemapping>
        <reinhard><pre_scale>0.05</pre_scale><post_scale>1</post_scale><burn>6</burn></reinhard>
    </tonemapping>
    <camera>
        <pos>{numbers(p)}</pos>
        <up>{numbers(up)}</up>
        <forwards>{numbers(forwards)}</forwards>
        <aperture_radius>0.0005</aperture_radius>
        <focus_distance>{math.dist(p, q):.3f}</focus_distance>
        <aspect_ratio>1.6</aspect_ratio>
        <sensor_width>0.036</sensor_width>
        <lens_sensor_dist>0.042</lens_sensor_dist>
        <white_balance>D55</white_balance>
    </camera>
{body}</scene>
""",
    )


if __name__ == "__main__":
    main()
