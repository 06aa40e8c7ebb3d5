"""Prints what the OpenEXR library reads in a file of layers: each channel's name and its values."""

import sys

import OpenEXR

with OpenEXR.File(sys.argv[1], separate_channels=True) as file:
    for name, channel in file.channels().items():
        print(name, *(repr(float(value)) for value in channel.pixels.reshape(-1)))
