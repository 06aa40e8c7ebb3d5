#!/usr/bin/env python3
"""Makes pictures of the gallery from renders: names under the balls of contact sheets, glasses side by side, JPEG.

    python3 docs/gallery/make_pictures.py FOLDER

takes the PNG files of a folder, called after the scenes, and writes into docs/gallery. It needs Pillow, 11 or later.
"""

import pathlib
import sys

from PIL import Image, ImageDraw, ImageFont

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
PLAIN = ["skin", "drinks", "prism", "lampshade", "frosted_glass", "metals"]


def save(picture, name):
    picture.save(HERE / f"{name}.jpg", quality=88, optimize=True)
    print(f"{name}.jpg: {picture.width} x {picture.height}")


def words(name, draw, font, width):
    """A name in lines that are no wider than that."""
    lines = [""]
    for word in name.split("_"):
        longer = f"{lines[-1]} {word}".strip()
        if lines[-1] and draw.textlength(longer, font) > width:
            lines.append(word)
        else:
            lines[-1] = longer
    return lines


def labelled(picture, names, columns, apart, size):
    """Names under balls in rows, the first at the top left, which are `apart` times as far apart as the columns, as
    crates/xtask/src/scenes/contact_sheet.rs has them."""
    draw, font = ImageDraw.Draw(picture), ImageFont.load_default(size)
    rows = -(-len(names) // columns)
    # As many pitches fill the picture; what is over is its border.
    pitch = picture.width / (columns + 0.1)
    for i, name in enumerate(names):
        x = picture.width / 2 + (i % columns - (columns - 1) / 2) * pitch
        y = picture.height / 2 + (i // columns - (rows - 1) / 2) * apart * pitch
        for k, line in enumerate(words(name, draw, font, 0.98 * pitch)):
            draw.text((x, y + 0.47 * pitch + k * size), line, (0, 0, 0), font, anchor="ma")
    return picture


def main():
    folder = pathlib.Path(sys.argv[1])

    def render(name):
        path = folder / f"{name}.png"
        return Image.open(path).convert("RGB") if path.exists() else None

    for name in PLAIN:
        if picture := render(name):
            save(picture, name)
    if picture := render("nkdata"):
        names = sorted(path.stem for path in (ROOT / "nkdata").glob("*.nk"))
        save(labelled(picture, [name.capitalize() for name in names], 8, 1.33, 15), "nkdata")
    if picture := render("media"):
        names = sorted(path.stem for path in (ROOT / "media").glob("*.igs"))
        save(labelled(picture, names, 11, 1.5, 9), "media")
    glasses = [render(name) for name in ("wineglass_empty", "wineglass", "wineglass_explicit")]
    if all(glasses):
        strip = Image.new("RGB", (sum(glass.width for glass in glasses), glasses[0].height))
        for i, glass in enumerate(glasses):
            strip.paste(glass, (i * glass.width, 0))
        save(strip, "wineglass")


if __name__ == "__main__":
    main()
