#!/usr/bin/env python3
"""Makes the pictures of the front page from the scenes of the repository.

    cargo build --release -p tem00-cli -p tem00-inspect
    pip install numpy pillow
    docs/figures/front_page.py face 64    # machined_part.png, with pieces enlarged
    docs/figures/front_page.py film 8     # film.webp: ten minutes on two cores

The numbers are samples per pixel. In the film a part slides under a laser line, and its height map
grows: above `machined_part.toml` with the laser and the motion of `triangulation/flange.toml`, seen
from farther away; below the frames of the sensor and the heights of the profiles so far.
"""

import pathlib
import subprocess
import sys
import tempfile

import numpy as np
from PIL import Image, ImageDraw, ImageFont

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAMS, SCENES = ROOT / "target/release", ROOT / "examples/scenes"
FIGURES = ROOT / "docs/figures"
FRAMES = 60
WIDTH, VIEW, BELOW = 640, 400, 220

# Heights of 0 to 20 mm in five colours of viridis (Matplotlib, public domain).
STOPS = [(68, 1, 84), (59, 82, 139), (33, 145, 140), (94, 201, 98), (253, 231, 37)]
HOLE = (24, 24, 24)

OVERVIEW = {
    "render.frames": FRAMES,
    "camera.position": '["70 mm", "-230 mm", "190 mm"]',
    "camera.look_at": '["0 mm", "6 mm", "0 mm"]',
    "camera.pixel_pitch": '"6.2 um"',
    "camera.resolution": f"[{WIDTH}, {VIEW}]",
    "laser[0].position": '["0 mm", "0 mm", "250 mm"]',
    "laser[0].look_at": '["0 mm", "0 mm", "8 mm"]',
    "laser[0].line_direction": "[1, 0, 0]",
    "laser[0].power": '"120 mW"',
    "surface[0].displacement_per_frame": '[0, "1.1 mm", 0]',
    "surface[0].mesh.position": '[0, "-32.45 mm", 0]',
}


def colours(heights: np.ndarray) -> np.ndarray:
    """Colours of heights in metres; holes are dark."""
    place = np.clip(np.nan_to_num(heights) / 20e-3, 0, 1) * (len(STOPS) - 1)
    rgb = [np.interp(place, range(len(STOPS)), channel) for channel in zip(*STOPS, strict=True)]
    found = np.isfinite(heights)[..., None]
    return np.where(found, np.stack(rgb, axis=-1), HOLE).astype(np.uint8)


def height_map(heights: np.ndarray, profiles: int) -> Image.Image:
    """The heights of the first profiles, the first at the top: the part moves away."""
    seen = np.where(np.arange(len(heights))[:, None] < profiles, heights, np.nan)
    return Image.fromarray(colours(seen)).resize((BELOW, BELOW), Image.Resampling.NEAREST)


def render(scene: str, folder: str, *options: str) -> None:
    """Renders a scene into a folder."""
    command = [PROGRAMS / "tem00", "render", SCENES / scene, "-o", folder, *options]
    subprocess.run(command, check=True)


def face(samples: str) -> None:
    """Renders the part, and puts a piece of the line with and without speckle into its corner."""
    left, top, width, height = 760, 232, 56, 40
    zoom = 3
    with tempfile.TemporaryDirectory() as work:
        render("machined_part.toml", f"{work}/with", "--spp", samples)
        render("machined_part.toml", f"{work}/without", "--spp", samples, "--no-speckle")
        files = [f"{work}/{name}/machined_part.png" for name in ("with", "without")]
        pictures = [Image.open(file).convert("RGB") for file in files]
    picture = pictures[0].copy()
    draw, font = ImageDraw.Draw(picture), ImageFont.load_default(15)
    box = (left, top, left + width, top + height)
    for number, (name, source) in enumerate(zip(("speckle", "no speckle"), pictures, strict=True)):
        piece = source.crop(box).resize((zoom * width, zoom * height), Image.Resampling.NEAREST)
        place = (12 + number * (zoom * width + 6), 12)
        picture.paste(piece, place)
        corner = (place[0] + piece.width - 1, place[1] + piece.height - 1)
        draw.rectangle((*place, *corner), outline="white")
        draw.text((place[0] + 6, place[1] + piece.height - 22), name, font=font, fill="white")
    draw.rectangle(box, outline="white")
    picture.save(FIGURES / "machined_part.png", optimize=True)


def film(samples: str) -> None:
    """Renders both views and puts them together."""
    with tempfile.TemporaryDirectory() as work:
        view, scan = f"{work}/view", f"{work}/scan"
        changes = [part for key, value in OVERVIEW.items() for part in ("--set", f"{key}={value}")]
        render("machined_part.toml", view, "--spp", samples, *changes)
        sensor = SCENES / "triangulation/flange.toml"
        subprocess.run([PROGRAMS / "tem00-inspect", "triangulate", sensor, "-o", scan], check=True)
        heights = np.load(f"{scan}/height.npy")
        frames = []
        for number in range(FRAMES):
            frame = Image.new("RGB", (WIDTH, VIEW + BELOW), HOLE)
            frame.paste(Image.open(f"{view}/machined_part_{number:04}.png").convert("RGB"), (0, 0))
            raw = np.asarray(Image.open(f"{scan}/raw_{number:04}.png")) / 4095
            raw = Image.fromarray((255 * np.sqrt(raw)).astype(np.uint8))
            frame.paste(raw.resize((WIDTH - BELOW, 147)), (0, VIEW + (BELOW - 147) // 2))
            frame.paste(height_map(heights, number + 1), (WIDTH - BELOW, VIEW))
            frames.append(frame)
    first, *others = frames
    options = {"save_all": True, "append_images": others, "duration": 80, "loop": 0}
    first.save(FIGURES / "film.webp", quality=75, method=6, **options)


if __name__ == "__main__":
    what, samples_per_pixel = sys.argv[1:]
    {"face": face, "film": film}[what](samples_per_pixel)
