"""Prints what the OpenEXR library reads in a file: attributes, size, then R, G and B of every pixel."""

import sys

import numpy as np
import OpenEXR

with OpenEXR.File(sys.argv[1]) as file:
    header = file.header()
    numbers = [float(v) for v in header["chromaticities"]]
    white = header.get("whiteLuminance")
    print("whiteLuminance", "none" if white is None else f"{white:g}")
    print("chromaticities", *(f"{v:g}" for v in numbers))
    print("indigo.scene_file_path", header["indigo.scene_file_path"])
    print("order", header["lineOrder"], "tiled" if header.get("tiles") else "scanlines")
    print("date", header["capDate"], f"{header['utcOffset']:g}")
    print("exposure", *(f"{header[name]:g}" for name in ("expTime", "aperture", "isoSpeed", "focus")))
    point = np.array([3.0, 7.0, 4.0, 1.0])
    ndc = point @ header["worldToNDC"]
    print("camera", *(f"{v:g}" for v in point @ header["worldToCamera"]))
    print("ndc", *(f"{v:g}" for v in ndc[:3] / ndc[3]))
    pixels = file.channels()["RGB"].pixels
    print("size", pixels.shape[1], pixels.shape[0])
    for value in pixels.reshape(-1):
        print(repr(float(value)))
