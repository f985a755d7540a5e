# SPDX-License-Identifier: MIT
"""Small inputs of every kind: a table on a floor, as little of it as a parse takes."""
import json
import math
import struct
import zlib
from pathlib import Path


def surface():
    """Points of a floor of 1.6 m and a box of 40 cm on it, about 4 cm apart."""
    points = []
    step = 0.04

    def patch(origin, u, v, nu, nv):
        for a in range(nu):
            for b in range(nv):
                points.append(tuple(o + step * ((a + 0.5) * p + (b + 0.5) * q) for o, p, q in zip(origin, u, v)))

    patch((-0.8, -0.8, 0), (1, 0, 0), (0, 1, 0), 40, 40)
    patch((-0.2, -0.2, 0.4), (1, 0, 0), (0, 1, 0), 10, 10)
    for side in (-0.2, 0.2):
        patch((side, -0.2, 0), (0, 1, 0), (0, 0, 1), 10, 10)
        patch((-0.2, side, 0), (1, 0, 0), (0, 0, 1), 10, 10)
    return points


def write_ply(file):
    points = surface()
    header = ("ply\nformat binary_little_endian 1.0\nelement vertex %d\nproperty float x\nproperty float y\n"
              "property float z\nend_header\n" % len(points))
    file.write_bytes(header.encode() + b"".join(struct.pack("<3f", *p) for p in points))


def write_xyz(file):
    file.write_text("".join("%.4f %.4f %.4f\n" % p for p in surface()))


def write_las(file):
    points = surface()
    header = bytearray(227)
    header[0:4] = b"LASF"
    header[24:26] = bytes((1, 2))
    struct.pack_into("<H", header, 94, 227)
    struct.pack_into("<I", header, 96, 227)
    struct.pack_into("<BHI", header, 104, 0, 20, len(points))
    struct.pack_into("<6d", header, 131, 0.001, 0.001, 0.001, 0, 0, 0)
    records = b"".join(struct.pack("<3i8x", *(round(1000 * c) for c in p)) for p in points)
    file.write_bytes(bytes(header) + records)


def write_obj(file):
    def box(low, high, first):
        lines = ["v %g %g %g" % (x, y, z) for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])]
        for face in ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)):
            lines.append("f " + " ".join(str(first + n) for n in face))
        return lines

    # Small: a mesh gets a point every centimetre.
    lines = ["v %g %g 0" % p for p in ((-0.4, -0.4), (0.4, -0.4), (0.4, 0.4), (-0.4, 0.4))] + ["f 1 2 3 4"]
    file.write_text("\n".join(lines + box((-0.12, -0.12, 0), (0.12, 0.12, 0.24), 5)) + "\n")


def png16(width, height, values):
    rows = b"".join(b"\0" + struct.pack(">%dH" % width, *values[y * width:(y + 1) * width]) for y in range(height))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 16, 0, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


WIDTH, HEIGHT, FOCAL = 80, 60, 60.0


def depth_image(eye, down_deg):
    """Millimetres from a camera at `eye` that looks along +y, turned down, at the floor and the box."""
    tilt = math.radians(down_deg)
    forward, down = (0, math.cos(tilt), -math.sin(tilt)), (0, -math.sin(tilt), -math.cos(tilt))
    values = []
    for v in range(HEIGHT):
        for u in range(WIDTH):
            x, y = (u - WIDTH / 2 + 0.5) / FOCAL, (v - HEIGHT / 2 + 0.5) / FOCAL
            ray = (x, forward[1] + y * down[1], forward[2] + y * down[2])
            best = -eye[2] / ray[2] if ray[2] < 0 else math.inf
            near, far = 0, math.inf  # slabs of the box
            for axis, (low, high) in enumerate(((-0.2, 0.2), (-0.2, 0.2), (0, 0.4))):
                if ray[axis] == 0:
                    if not low <= eye[axis] <= high:
                        near = math.inf
                    continue
                a, b = sorted(((low - eye[axis]) / ray[axis], (high - eye[axis]) / ray[axis]))
                near, far = max(near, a), min(far, b)
            if near < far:
                best = min(best, near)
            values.append(round(1000 * best) if best < 6 else 0)
    pose = (1, 0, 0, eye[0], 0, down[1], forward[1], eye[1], 0, down[2], forward[2], eye[2])
    return png16(WIDTH, HEIGHT, values), pose


def write_frames(folder, count):
    (folder / "depth").mkdir(parents=True)
    poses = []
    for n in range(count):
        image, pose = depth_image((0.3 * n - 0.15, -1.2, 0.9), 30)
        (folder / "depth" / ("%06d.png" % n)).write_bytes(image)
        poses.append(" ".join("%.9g" % c for c in pose))
    (folder / "intrinsics.json").write_text(json.dumps(
        {"width": WIDTH, "height": HEIGHT, "fx": FOCAL, "fy": FOCAL, "cx": WIDTH / 2 - 0.5, "cy": HEIGHT / 2 - 0.5,
         "depth_scale": 1000}))
    if count > 1:
        (folder / "poses.txt").write_text("\n".join(poses) + "\n")


def write_all(folder):
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    write_ply(folder / "cloud.ply")
    write_xyz(folder / "cloud.xyz")
    write_las(folder / "cloud.las")
    write_obj(folder / "mesh.obj")
    write_frames(folder / "frames", 3)
    write_frames(folder / "single", 1)
