"""Prints a chart of colours as each tone mapping and white balance shows it, by colour-science and NumPy alone.

Every line: name of the white, its x and y, the tone mapping, then X Y Z and the display-linear R G B of a patch.
The exposure is 2 lux seconds per cd/m2. Reinhard's statistics are those of the whole chart.
"""

import colour
import numpy as np

EXPOSURE = 2.0
REC709 = colour.RGB_COLOURSPACES["ITU-R BT.709"].copy()
REC709.use_derived_transformation_matrices(True)
D65 = np.array([0.3127, 0.3290])
WHITES = colour.CCS_ILLUMINANTS["CIE 1931 2 Degree Standard Observer"]
NAMES = {"D65": "D65", "A": "A", "D50": "D50", "E": "E", "F2": "FL2"}


def chart():
    """The 24 patches of a ColorChecker under D50 at several luminances, greys far too bright, and black."""
    data = colour.CCS_COLOURCHECKERS["ColorChecker 2005"].data
    patches = [colour.xyY_to_XYZ(xyY) * scale for xyY, scale in zip(data.values(), np.geomspace(0.02, 4, 24))]
    greys = [colour.xyY_to_XYZ([*D65, y]) for y in (0.0, 1e-4, 0.5, 3.0, 40.0)]
    return np.round(np.array(patches + greys), 9)


def adapted(xyz, white):
    matrix = colour.adaptation.matrix_chromatic_adaptation_VonKries(
        colour.xy_to_XYZ(white), colour.xy_to_XYZ(D65), transform="Bradford"
    )
    return xyz @ matrix.T


def linear(xyz):
    return 0.2 * EXPOSURE * xyz @ REC709.matrix_XYZ_to_RGB.T


def reinhard(xyz, pre=1.5, post=0.9, burn=6.0):
    y = xyz[:, 1]
    mean = np.exp(np.mean(np.log(y[y > 0])))
    scaled = pre * y / mean
    white = min(burn, scaled.max())
    compressed = post * scaled * (1 + scaled / white**2) / (1 + scaled)
    ratio = np.divide(compressed, y, out=np.zeros_like(y), where=y > 0)
    return (xyz * ratio[:, None]) @ REC709.matrix_XYZ_to_RGB.T


def camera(xyz, ev=0.5, iso=20.0):
    irradiance = EXPOSURE * iso / 78 * 2**ev * xyz @ REC709.matrix_XYZ_to_RGB.T
    points = np.linspace(0, 1, 256)
    curves = [points**g for g in (1 / 2.2, 1 / 1.8, 0.7)]
    brightness = [np.interp(irradiance[:, c], points, curves[c]) for c in range(3)]
    return colour.models.eotf_sRGB(np.stack(brightness, axis=1))


for name, entry in NAMES.items():
    white = D65 if name == "D65" else np.round(WHITES[entry], 5)
    xyz = chart()
    balanced = adapted(xyz, white)
    for mapping in (linear, reinhard, camera):
        for patch, rgb in zip(xyz, np.clip(mapping(balanced), 0, 1)):
            numbers = " ".join(f"{v:.9f}" for v in (*patch, *rgb))
            print(f"{name} {white[0]:.5f} {white[1]:.5f} {mapping.__name__} {numbers}")
