"""The scenes that render_peers.py renders, as files for tem00 and for Mitsuba.

The open box is [-1, 1]³ without the wall towards the camera, with a displaced sphere; all of albedo
0.6. Its light is a square of 0.5 m under the ceiling, or a point. The spot and the line are those
of scenes/: Mitsuba has neither beam, so a spot light with a soft edge and a projector with a bright
row of texels stand in for them; what is compared is the cost of finding the light.
"""

import math
import pathlib

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
SIDE = 512
SAMPLES = 64
ALBEDO = 0.6
RADIANCE = 10.0
POWER = 20.0
# The opening of the box, 2 m wide, is 2.9 m from the camera and just outside the picture.
CAMERA_Z = 3.9
TANGENT = 1 / 2.95
FOCAL_LENGTH = 0.025


def write_sphere(path, columns):
    """Writes a displaced sphere of 2 × columns² triangles."""
    phi = 2 * np.pi * np.arange(columns) / columns
    theta = np.pi * (np.arange(columns + 1) + 0.5) / (columns + 1)
    theta, phi = np.meshgrid(theta, phi, indexing="ij")
    radius = 0.5 * (1 + 0.1 * np.sin(5 * phi) * np.sin(6 * theta))
    x = radius * np.sin(theta) * np.cos(phi)
    z = radius * np.sin(theta) * np.sin(phi)
    vertices = np.stack([x, radius * np.cos(theta) - 0.3, z], axis=-1).reshape(-1, 3)

    row, column = np.meshgrid(np.arange(columns), np.arange(columns), indexing="ij")
    a, b = row * columns + column, row * columns + (column + 1) % columns
    c, d = a + columns, b + columns
    triangles = np.stack([a, b, d, a, d, c], axis=-1).reshape(-1, 3)
    faces = np.zeros(len(triangles), dtype=[("count", "u1"), ("corners", "<i4", 3)])
    faces["count"], faces["corners"] = 3, triangles
    with open(path, "wb") as file:
        file.write(
            b"ply\nformat binary_little_endian 1.0\n"
            + f"element vertex {len(vertices)}\n".encode()
            + b"property float x\nproperty float y\nproperty float z\n"
            + f"element face {len(faces)}\n".encode()
            + b"property list uchar int vertex_indices\nend_header\n"
        )
        vertices.astype("<f4").tofile(file)
        faces.tofile(file)
    return len(triangles)


# The inner faces of the box: centre and normal.
WALLS = [
    ((0, -1, 0), (0, 1, 0)),
    ((0, 1, 0), (0, -1, 0)),
    ((-1, 0, 0), (1, 0, 0)),
    ((1, 0, 0), (-1, 0, 0)),
    ((0, 0, -1), (0, 0, 1)),
]


def tem00_box(mesh, light, integrator):
    image_distance = FOCAL_LENGTH * CAMERA_Z / (CAMERA_Z - FOCAL_LENGTH)
    pitch = 2 * TANGENT * image_distance / SIDE
    # A pinhole, as Mitsuba's is.
    text = f"""
[render]
{integrator}
[camera]
position = [0, 0, {CAMERA_Z}]
focal_length = {FOCAL_LENGTH}
f_number = 1e6
depth_of_field = false
pixel_pitch = {pitch}
resolution = [{SIDE}, {SIDE}]
[[laser]] # a scene file needs one; it is left out
wavelength = "650 nm"
power = 1
position = [0, 0, 3]
spot.waist_radius = "1 mm"
"""
    if light == "area":
        text += f"""
[[light]]
rectangle = {{ centre = [0, 0.99, 0], normal = [0, -1, 0], size = [0.5, 0.5], radiance = {RADIANCE} }}
"""
    else:
        text += f"""
[[light]]
point = {{ position = [0, 0.9, 0], power = {POWER} }}
"""
    for centre, normal in WALLS:
        text += f"""
[[surface]]
rectangle = {{ centre = {list(centre)}, normal = {list(normal)}, size = [2, 2] }}
lambertian.reflectance = {ALBEDO}
"""
    return text + f"""
[[surface]]
mesh = {{ file = "{mesh}", unit = "m" }}
lambertian.reflectance = {ALBEDO}
"""


MITSUBA_DIFFUSE = '<bsdf type="diffuse"><rgb name="reflectance" value="{}"/></bsdf>'


def mitsuba_film(width, height, tangent, position, integrator):
    fov = math.degrees(2 * math.atan(tangent))
    return f"""<scene version="3.0.0">
<default name="sampler" value="independent"/>
{integrator}
<sensor type="perspective">
  <string name="fov_axis" value="x"/><float name="fov" value="{fov}"/>
  <float name="near_clip" value="0.001"/>
  <transform name="to_world"><lookat origin="{position}" target="0, 0, 0" up="0, 1, 0"/></transform>
  <sampler type="$sampler"/>
  <film type="hdrfilm">
    <integer name="width" value="{width}"/><integer name="height" value="{height}"/>
    <rfilter type="box"/>
  </film>
</sensor>
"""


def mitsuba_rectangle(centre, normal, scale, content):
    x, y, z = centre
    target = f"{x + normal[0]}, {y + normal[1]}, {z + normal[2]}"
    up = "0, 0, 1" if normal[1] else "0, 1, 0"
    return f"""<shape type="rectangle"><transform name="to_world">
  <scale x="{scale[0]}" y="{scale[1]}"/><lookat origin="{x}, {y}, {z}" target="{target}" up="{up}"/>
</transform>{content}</shape>
"""


def mitsuba_box(mesh, light, integrator):
    text = mitsuba_film(SIDE, SIDE, TANGENT, f"0, 0, {CAMERA_Z}", integrator)
    diffuse = MITSUBA_DIFFUSE.format(ALBEDO)
    for centre, normal in WALLS:
        text += mitsuba_rectangle(centre, normal, (1, 1), diffuse)
    text += f"""<shape type="ply"><string name="filename" value="{mesh}"/>
  <boolean name="face_normals" value="true"/>{diffuse}</shape>
"""
    if light == "area":
        emitter = f'<emitter type="area"><rgb name="radiance" value="{RADIANCE}"/></emitter>'
        black = MITSUBA_DIFFUSE.format(0)
        text += mitsuba_rectangle((0, 0.99, 0), (0, -1, 0), (0.25, 0.25), black + emitter)
    else:
        text += f"""<emitter type="point"><point name="position" x="0" y="0.9" z="0"/>
  <rgb name="intensity" value="{POWER / (4 * math.pi)}"/></emitter>
"""
    return text + "</scene>\n"


def mitsuba_plate(resolution, position, half_size, emitter, integrator):
    """A plate seen from 300 mm by a 25 mm lens with pixels of 3.45 µm, as in examples/scenes/."""
    width, height = resolution
    tangent = 0.5 * width * 3.45e-6 / (0.025 * 0.3 / (0.3 - 0.025))
    text = mitsuba_film(width, height, tangent, position, integrator)
    text += mitsuba_rectangle((0, 0, 0), (0, 0, 1), half_size, MITSUBA_DIFFUSE.format(0.8))
    return text + emitter + "</scene>\n"


SPOT = """<emitter type="spot"><transform name="to_world">
  <lookat origin="0.1, 0, 0.1732" target="0, 0, 0" up="0, 1, 0"/></transform>
  <rgb name="intensity" value="1"/><float name="cutoff_angle" value="1"/>
  <float name="beam_width" value="0.1"/></emitter>
"""


def line_projector(folder):
    """A projector of 30° whose middle row of texels is bright.

    On the plate the row is 0.1 mm wide at half its height, as our line.
    """
    import mitsuba as mi

    mi.set_variant("scalar_rgb")
    texels = np.zeros((1025, 1024, 3), dtype=np.float32)
    texels[512] = 1
    mi.Bitmap(texels).write(str(folder / "line.exr"))
    return f"""<emitter type="projector"><transform name="to_world">
  <lookat origin="0, 0.1, 0.1732" target="0, 0, 0" up="0, 1, 0"/></transform>
  <float name="fov" value="30"/>
  <texture name="irradiance" type="bitmap"><string name="filename" value="{folder / 'line.exr'}"/>
    <boolean name="raw" value="true"/></texture></emitter>
"""


def mitsuba_integrator(kind):
    if kind == "direct":
        return """<integrator type="direct"><integer name="emitter_samples" value="1"/>
  <integer name="bsdf_samples" value="0"/></integrator>"""
    return '<integrator type="path"><integer name="max_depth" value="4"/></integrator>'


def tem00_integrator(kind):
    """The keys of [render] for the same light paths."""
    # Mitsuba counts the segments of a path, we the surfaces on it.
    return {"direct": "max_depth = 1", "path": "max_depth = 3"}[kind]


def write_scenes(folder):
    """Writes all scenes; returns a name, our file, theirs, and whether our lasers are left out."""
    folder.mkdir(parents=True, exist_ok=True)
    rows = []

    def add(name, ours, theirs, lights_only):
        theirs_file = folder / f"{len(rows)}.xml"
        theirs_file.write_text(theirs)
        if not isinstance(ours, pathlib.Path):
            file = folder / f"{len(rows)}.toml"
            file.write_text(ours)
            ours = file
        rows.append((name, ours, theirs_file, lights_only))

    for label, columns in [("1 k", 22), ("1 M", 708)]:
        mesh = folder / f"sphere_{columns}.ply"
        if not mesh.exists():
            write_sphere(mesh, columns)
        for kind, light, name in [
            ("direct", "area", "direct, area light"),
            ("direct", "point", "direct, point light"),
            ("path", "area", "path of depth 4"),
        ]:
            add(
                f"{name}, {label}",
                tem00_box(mesh, light, tem00_integrator(kind)),
                mitsuba_box(mesh, light, mitsuba_integrator(kind)),
                True,
            )
    direct = mitsuba_integrator("direct")
    camera = "0, 0, 0.3"
    spot = mitsuba_plate((320, 240), camera, (0.02, 0.015), SPOT, direct)
    line = mitsuba_plate((400, 120), camera, (0.06, 0.015), line_projector(folder), direct)
    add("laser spot", ROOT / "examples/scenes/spot.toml", spot, False)
    add("laser line", ROOT / "examples/scenes/line_with_speckle.toml", line, False)
    return rows
