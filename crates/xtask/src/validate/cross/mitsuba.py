"""Renders scenes with Mitsuba 3 as `cargo xtask validate` describes them.

usage: mitsuba.py JOBS.json VERSION.txt

JOBS.json is a list of {scene, samples, seeds, out}: the dictionary of a scene, in which shapes of type `mesh` hold
`vertices` and `faces`, and `to_world` may be {look_at: [origin, target, up]}. Writes to `out` how many seconds it took and the
pictures of the seeds, one after another: X, Y, Z of each pixel, in units of the luminance of a radiance of 1 at all wavelengths;
all as 32-bit numbers. Writes to VERSION.txt which Mitsuba rendered. A scene that fails leaves no file, and the others are rendered.
"""

import json
import os
import sys
import time
import traceback

import mitsuba as mi
import numpy as np

# Mitsuba's films divide X, Y and Z by this (MI_CIE_Y_NORMALIZATION in its spectrum.h).
MI_CIE_Y_NORMALIZATION = 106.7502593994140625


def choose_variant():
    """The vectorised variant where DRJIT_LIBLLVM_PATH names an LLVM for it (16 or later: earlier ones abort while they
    compile), else the plain one, which is slower and the same."""
    variant = "llvm_ad_spectral" if os.environ.get("DRJIT_LIBLLVM_PATH") else "scalar_spectral"
    mi.set_variant(variant)
    return variant


def mesh(description):
    vertices = np.array(description["vertices"], dtype=np.float32)
    faces = np.array(description["faces"], dtype=np.uint32)
    properties = mi.Properties()
    properties["face_normals"] = True
    for key in ("bsdf", "emitter", "interior"):
        if key in description:
            properties[key] = mi.load_dict(made(description[key]))
    places = description.get("places")
    shape = mi.Mesh("mesh", len(vertices), len(faces), has_vertex_texcoords=places is not None, props=properties)
    parameters = mi.traverse(shape)
    if places is not None:
        size = np.array(description["emitter"]["radiance"]["size"])
        u, v = ((np.array(places) * [1, -1] + [0, 1]) * size + 0.5).T / (size + 1)[:, np.newaxis]
        parameters["vertex_texcoords"] = np.stack([u, v], axis=1).astype(np.float32).ravel()
    parameters["vertex_positions"] = vertices.ravel()
    parameters["faces"] = faces.ravel()
    parameters.update()
    return shape


def environment(description):
    """Texels of Mitsuba are light of D65 whose luminance is 1 for the value 1; here it is that of even radiance 1."""
    width, height = description["size"]
    grey = np.array(description["grey"], dtype=np.float32).reshape(height, width, 1)
    bitmap = mi.Bitmap(np.ascontiguousarray(np.repeat(grey, 3, axis=2)))
    to_world = made(description["to_world"])
    return {"type": "envmap", "bitmap": bitmap, "scale": unit(), "to_world": to_world}


def picture(description):
    """Texels of radiance, the same at all wavelengths.

    Indigo's stand at the corners of a grid that begins at (0, 0), the bottom of the file, and run on into the first ones of the
    next repetition. Mitsuba's stand in the middle of their cells, from (0, 0), the top, and it draws points of a lamp between 0
    and 1 alone: it gets one more row and column, and the coordinates between their middles."""
    width, height = description["size"]
    grey = np.array(description["grey"], dtype=np.float32).reshape(height, width, 1)
    bitmap = mi.Bitmap(np.ascontiguousarray(np.pad(grey, ((1, 0), (0, 1), (0, 0)), mode="wrap")))
    return {"type": "bitmap", "bitmap": bitmap, "raw": True}


def made(value):
    """What a dictionary describes, in Mitsuba's types."""
    if not isinstance(value, dict):
        return value
    if "look_at" in value:
        origin, target, up = value["look_at"]
        return mi.ScalarTransform4f().look_at(origin=origin, target=target, up=up)
    if "matrix" in value:
        return mi.ScalarTransform4f(np.array(value["matrix"], dtype=np.float32))
    if value.get("type") == "mesh":
        return mesh(value)
    if value.get("type") == "picture":
        return picture(value)
    if value.get("type") == "envmap":
        return environment(value)
    return {key: made(inner) for key, inner in value.items()}


def unit():
    """Y of a radiance of 1 at all wavelengths: the film's own observer, summed over its range, over what it divides by."""
    wavelengths = np.linspace(360.0, 830.0, 471)
    y = np.array([mi.cie1931_y(float(w)) for w in wavelengths]).ravel()
    return float(np.trapezoid(y, wavelengths)) / MI_CIE_Y_NORMALIZATION


def main():
    variant = choose_variant()
    one = unit()
    version = f"Mitsuba {mi.__version__}, {variant}"
    print(f"  {version}, unit {one:.6f}", flush=True)
    with open(sys.argv[2], "w") as file:
        file.write(version)
    with open(sys.argv[1]) as file:
        jobs = json.load(file)
    failed = 0
    for job in jobs:
        print(f"  {job['name']}", flush=True)
        try:
            render(job, one)
        except Exception:
            traceback.print_exc()
            failed += 1
    if failed:
        sys.exit(f"{failed} of {len(jobs)} scenes could not be rendered")


def render(job, one):
    start = time.monotonic()
    scene = mi.load_dict(made(job["scene"]))
    pictures = [
        np.array(mi.render(scene, spp=job["samples"], seed=seed), dtype=np.float32) / one
        for seed in range(job["first_seed"], job["first_seed"] + job["seeds"])
    ]
    seconds = np.array([time.monotonic() - start])
    # Whole or not at all: a later run may go on with it.
    np.concatenate([seconds, np.stack(pictures).ravel()]).astype("<f4").tofile(job["out"] + ".part")
    os.replace(job["out"] + ".part", job["out"])


main()
