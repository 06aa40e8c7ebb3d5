#!/usr/bin/env python3
"""What Mitsuba 3 reaches on scenes of `cargo xtask bench transport`, on one thread.

usage: race_mitsuba.py [--seconds S] [--variant V] [--max-depth N] FILE.igs REFERENCE.xyz ...

FILE.igs is written by `cargo xtask bench transport --export DIR`, REFERENCE.xyz is what that benchmark keeps in
`bench-data/transport` once it ran: two halves of X, Y, Z as floats. Needs the packages `mitsuba` and `numpy`, and LLVM
16 or later for the vectorised variant (DRJIT_LIBLLVM_PATH names it). Measures as the benchmark does: passes of a few
samples per pixel until the process has used S seconds, relMSE of luminance against the reference, cut at the 99.9th
percentile, less the reference's noise, scaled to exactly S seconds. Compiling kernels is not counted. The radiometric
unit is another, so the picture is scaled to the reference's mean.

Only what `room`, `caustic` and `balls` contain is translated: flat spectra, diffuse and transparent specular materials,
reflective Phong lobes (as GGX conductors, which is another picture: then the error is taken against a long render
of Mitsuba itself), one-sided mesh lamps, an even background.
"""

import argparse
import math
import time
import xml.etree.ElementTree as ElementTree

import mitsuba as mi
import numpy as np

DARK, QUANTILE = 0.01, 0.999


def numbers(text):
    return [float(word) for word in text.split()]


def value(element):
    return float(element.find(".//uniform/value").text)


def bsdf(material, media):
    """The nearest of Mitsuba's models, and whether it is the same model."""
    if (diffuse := material.find("diffuse")) is not None:
        reflectance = {"type": "uniform", "value": value(diffuse)}
        return {"type": "twosided", "inner": {"type": "diffuse", "reflectance": reflectance}}, True
    if (specular := material.find("specular")) is not None:
        ior = float(media[specular.findtext("internal_medium_name")].findtext("basic/ior"))
        return {"type": "dielectric", "int_ior": ior, "ext_ior": 1.0}, True
    if (phong := material.find("phong")) is not None:
        # A Phong lobe of exponent n is about as wide as a microfacet lobe of alpha^2 = 2 / (n + 2) (Walter et al. 2007).
        alpha = math.sqrt(2.0 / (float(phong.findtext("exponent")) + 2.0))
        reflectance = {"type": "uniform", "value": value(phong)}
        metal = {"type": "roughconductor", "material": "none", "distribution": "ggx", "alpha": alpha}
        return {"type": "twosided", "inner": metal | {"specular_reflectance": reflectance}}, False
    raise SystemExit(f"no translation of {ElementTree.tostring(material)[:80]}")


def mesh(element, properties):
    vertices = np.array([numbers(v.get("pos")) for v in element.iter("vertex")], dtype=np.float32)
    faces = np.array([[int(i) for i in t.text.split()] for t in element.iter("tri")], dtype=np.uint32)
    made = mi.Mesh(element.findtext("name"), len(vertices), len(faces), props=properties)
    parameters = mi.traverse(made)
    parameters["vertex_positions"] = vertices.ravel()
    parameters["faces"] = faces.ravel()
    parameters.update()
    return made


def properties(bsdf_of, emitter=None):
    made = mi.Properties()
    made["face_normals"] = True
    made["bsdf"] = mi.load_dict(bsdf_of)
    if emitter:
        made["emitter"] = mi.load_dict(emitter)
    return made


def translate(path, max_depth):
    """A scene of Mitsuba's, and whether every model in it is the same as in the file."""
    root = ElementTree.parse(path).getroot()
    media = {m.findtext("name"): m for m in root.findall("medium")}
    translated = {m.findtext("name"): bsdf(m, media) for m in root.findall("material")}
    materials = {name: pair[0] for name, pair in translated.items()}
    meshes = {m.findtext("name"): m for m in root.findall("mesh")}
    camera = root.find("camera")
    position, forwards = numbers(camera.findtext("pos")), numbers(camera.findtext("forwards"))
    half = 0.5 * float(camera.findtext("sensor_width")) / float(camera.findtext("lens_sensor_dist"))
    size = [int(root.findtext(f"renderer_settings/{side}")) for side in ("width", "height")]
    target = [p + f for p, f in zip(position, forwards)]
    scene = {
        "type": "scene",
        # Mitsuba counts edges, max_depth bounces.
        "integrator": {"type": "path", "max_depth": max_depth + 1},
        "sensor": {
            "type": "perspective",
            "fov": math.degrees(2.0 * math.atan(half)),
            "fov_axis": "x",
            "to_world": mi.ScalarTransform4f().look_at(position, target, numbers(camera.findtext("up"))),
            "film": {
                "type": "hdrfilm",
                "width": size[0],
                "height": size[1],
                "rfilter": {"type": "box"},
                "pixel_format": "xyz",
                "component_format": "float32",
            },
            "sampler": {"type": "independent"},
        },
    }
    for i, model in enumerate(root.findall("model")):
        element = meshes[model.findtext("mesh_name")]
        material = element.findtext(".//material_name")
        scene[f"model_{i}"] = mesh(element, properties(materials[material]))
    for i, lamp in enumerate(root.findall("meshlight")):
        element = meshes[lamp.findtext("mesh_name")]
        black = {"type": "diffuse", "reflectance": {"type": "uniform", "value": 0.0}}
        emitter = {"type": "area", "radiance": {"type": "uniform", "value": value(lamp)}}
        scene[f"lamp_{i}"] = mesh(element, properties(black, emitter))
    for i, ball in enumerate(root.findall("sphere")):
        scene[f"ball_{i}"] = {
            "type": "sphere",
            "center": numbers(ball.findtext("center")),
            "radius": float(ball.findtext("radius")),
            "bsdf": materials[ball.findtext("material_name")],
        }
    if (background := root.find("background")) is not None:
        scene["sky"] = {"type": "constant", "radiance": {"type": "uniform", "value": value(background)}}
    used = {e.text for e in root.iter("material_name")}
    return mi.load_dict(scene), all(translated[name][1] for name in used)


def render(scene, seconds, per_pass, seed):
    """Mean luminance of passes that took so many seconds of this process, samples per pixel, and seconds."""
    total, samples, used = 0.0, 0, 0.0
    while used < seconds:
        start = time.process_time()
        picture = np.array(mi.render(scene, spp=per_pass, seed=seed + samples // per_pass))[:, :, 1]
        used += time.process_time() - start
        total, samples = total + picture.astype(np.float64), samples + per_pass
    return total / samples * per_pass, samples, used


def rel_mse(reference, difference):
    dark = DARK * np.mean(reference**2)
    terms = np.sort((difference**2 / (reference**2 + dark)).ravel())
    return float(np.mean(np.minimum(terms, terms[int(len(terms) * QUANTILE)])))


def race(path, reference_path, arguments):
    scene, is_same = translate(path, arguments.max_depth)
    side = mi.traverse(scene)["sensor.film.size"]
    halves = np.fromfile(reference_path, dtype=np.float32).reshape(2, side[1], side[0], 3)[..., 1].astype(np.float64)
    # The first passes compile.
    for seed in (1, 2):
        mi.render(scene, spp=arguments.per_pass, seed=seed).numpy()
    picture, samples, used = render(scene, arguments.seconds, arguments.per_pass, 1000)
    if is_same:
        reference, noise = halves.mean(axis=0), rel_mse(halves.mean(axis=0), 0.5 * (halves[0] - halves[1]))
        note = "the benchmark's reference"
    else:
        long = [render(scene, 6.0 * arguments.seconds, arguments.per_pass, s)[0] for s in (10**6, 2 * 10**6)]
        reference = 0.5 * (long[0] + long[1])
        noise = rel_mse(reference, 0.5 * (long[0] - long[1]))
        note = "a long render of its own (GGX for Phong lobes)"
    scale = reference.mean() / picture.mean()
    error = (rel_mse(reference, scale * picture - reference) - noise) * used / arguments.seconds
    print(
        f"{path}: {samples / used * arguments.seconds:.0f} samples per pixel, "
        f"{samples * side[0] * side[1] / used:.3g} samples/s, relMSE {error:.3g} at {arguments.seconds} s "
        f"against {note} (its noise {noise:.1e}; mean times {scale:.5g})"
    )


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--variant", default="llvm_ad_spectral")
    parser.add_argument("--per-pass", type=int, default=64)
    parser.add_argument("--max-depth", type=int, default=15)
    parser.add_argument("files", nargs="+")
    arguments = parser.parse_args()
    mi.set_variant(arguments.variant)
    import drjit

    drjit.set_thread_count(1)
    for path, reference in zip(arguments.files[::2], arguments.files[1::2]):
        race(path, reference, arguments)


main()
