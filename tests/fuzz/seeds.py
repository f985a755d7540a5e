#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes small valid files of every format that topple reads, as seeds for fuzzing: seeds.py FOLDER.

FOLDER gets a folder for each reader of tests/fuzz/readers.cpp.
"""
import json
import pathlib
import struct
import sys
import zlib

CORNERS = [(x, y, z) for z in (0.0, 0.5) for y in (0.0, 1.0) for x in (0.0, 2.0)]
QUADS = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]
TRIANGLES = [t for q in QUADS for t in ((q[0], q[1], q[2]), (q[0], q[2], q[3]))]


def ply():
    head = "ply\nformat {} 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n{}end_header\n"
    faces = "element face 6\nproperty list uchar int vertex_indices\n"
    lines = "".join("%g %g %g\n" % c for c in CORNERS)
    yield (head.format("ascii", "") + lines).encode()
    yield (head.format("ascii", faces) + lines + "".join("4 %d %d %d %d\n" % q for q in QUADS)).encode()
    for order, name in (("<", "little"), (">", "big")):
        data = b"".join(struct.pack(order + "3f", *c) for c in CORNERS)
        data += b"".join(struct.pack(order + "B4i", 4, *q) for q in QUADS)
        yield head.format("binary_%s_endian" % name, faces).encode() + data

    # Gaussian splats, of which half are haze.
    names = ["f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"]
    fields = "".join("property float %s\n" % n for n in names)
    splats = [(*c, 0.5, -0.5, 0, (-1) ** n, -4, -4, -4, 1, 0, 0, 0) for n, c in enumerate(CORNERS)]
    yield (head.format("ascii", fields) + "".join(" ".join("%g" % v for v in s) + "\n" for s in splats)).encode()
    yield head.format("binary_little_endian", fields).encode() + b"".join(struct.pack("<14f", *s) for s in splats)


def pcd():
    head = ("# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH %d\nHEIGHT %d\n"
            "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 8\nDATA %s\n")
    raw = b"".join(struct.pack("<3f", *c) for c in CORNERS)
    yield (head % (8, 1, "ascii")).encode() + "".join("%g %g %g\n" % c for c in CORNERS).encode()
    yield (head % (4, 2, "binary")).encode() + raw
    columns = b"".join(struct.pack("<8f", *(c[a] for c in CORNERS)) for a in range(3))
    literal = b"".join(bytes([len(columns[i:i + 32]) - 1]) + columns[i:i + 32] for i in range(0, len(columns), 32))
    yield (head % (8, 1, "binary_compressed")).encode() + struct.pack("<II", len(literal), len(columns)) + literal


def volume():
    def text(words):
        return struct.pack("<i", len(words)) + words

    head = b" BDV\0\0\0\0" + struct.pack("<III", 224, 10, 0) + b"\1" + b"0" * 36
    head += struct.pack("<i", 1) + text(b"creator") + text(b"string") + text(b"topple") + struct.pack("<i", 1)
    head += text(b"distance") + text(b"Tree_float_5_4_3") + text(b"")
    tree = struct.pack("<Ii", 1, 1) + text(b"class") + text(b"string") + text(b"level set") + text(b"UniformScaleMap")
    tree += b"\0" * 120 + struct.pack("<ifII", 1, 0.1, 1, 0) + b"\0" * 17
    first = len(head) + 24
    yield head + struct.pack("<3q", first, first + len(tree), first + len(tree)) + tree


def xyz():
    yield b"# scan\n8\n" + b"".join(b"%g %g %g\n" % c for c in CORNERS)
    yield b"id,x,y,z,nx,ny,nz\n" + b"".join(b"1,%g,%g,%g,0,0,1\n" % c for c in CORNERS)


def las():
    for minor, fmt, record in ((2, 0, 20), (4, 6, 30)):
        size = 375 if minor == 4 else 227
        head = bytearray(size)
        head[0:4] = b"LASF"
        head[24:26] = bytes((1, minor))
        struct.pack_into("<HII", head, 94, size, size, 0)
        struct.pack_into("<BHI", head, 104, fmt, record, 0 if minor == 4 else 8)
        struct.pack_into("<6d", head, 131, 0.001, 0.001, 0.001, 500000, 5400000, 0)
        if minor == 4:
            struct.pack_into("<Q", head, 247, 8)
        yield bytes(head) + b"".join(
            struct.pack("<3i", *(int(v * 1000) for v in c)).ljust(record, b"\0") for c in CORNERS)


def obj():
    vertices = "".join("v %g %g %g\n" % c for c in CORNERS)
    yield (vertices + "".join("f %d %d %d %d\n" % tuple(i + 1 for i in q) for q in QUADS)).encode()
    yield ("o a\nvn 0 0 1\nvt 0 0\n" + vertices + "g b\nf 1/1/1 2/1/1 3/1/1\nf -1//1 -2//1 -3//1\nl 1 2\n").encode()


def stl():
    yield b" " * 80 + struct.pack("<I", 12) + b"".join(
        struct.pack("<12fH", 0, 0, 0, *CORNERS[t[0]], *CORNERS[t[1]], *CORNERS[t[2]], 0) for t in TRIANGLES)
    yield ("solid a\n" + "".join("facet normal 0 0 1\nouter loop\n" + "".join("vertex %g %g %g\n" % CORNERS[i] for i in t)
                                 + "endloop\nendfacet\n" for t in TRIANGLES) + "endsolid a\n").encode()


def glb():
    data = b"".join(struct.pack("<3f", *c) for c in CORNERS) + b"".join(struct.pack("<3H", *t) for t in TRIANGLES)
    root = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0, "translation": [1, 2, 3]}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3"},
                          {"bufferView": 1, "componentType": 5123, "count": 36, "type": "SCALAR"}],
            "bufferViews": [{"buffer": 0, "byteLength": 96}, {"buffer": 0, "byteOffset": 96, "byteLength": 72}],
            "buffers": [{"byteLength": len(data)}]}
    text = json.dumps(root, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    yield (b"glTF" + struct.pack("<III", 2, 28 + len(text) + len(data), len(text)) + b"JSON" + text
           + struct.pack("<I", len(data)) + b"BIN\0" + data)


def octomap():
    yield b"# Octomap OcTree binary file\nid OcTree\nsize 34\nres 0.1\ndata\n" + b"\x03\x00" * 15 + b"\x99\x66"
    path = b"".join(struct.pack("<fB", 0.5, 1) for _ in range(16)) + struct.pack("<fB", 3, 0)
    yield b"# Octomap OcTree file\nid OcTree\nsize 17\nres 0.1\ndata\n" + path


def depth():
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = b"".join(b"\0" + struct.pack(">9H", *range(100 * y, 100 * y + 9)) for y in range(7))
    yield (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 9, 7, 16, 0, 0, 0, 0))
           + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def intrinsics():
    yield b'{"width": 5, "height": 3, "fx": 4.5, "fy": 4.25, "cx": 2, "cy": 1, "depth_scale": 1000}'


def trajectory():
    yield b"# t\n0 1 2 3 0 0 0 1\n1 1 2 3 0.5 -0.5 0.5 0.5\n"
    yield b"1 0 0 1 0 1 0 2 0 0 1 3\n0 -1 0 4 1 0 0 5 0 0 1 6\n"
    yield b"1 1 2\n0 -1 0 4\n1 0 0 5\n0 0 1 6\n0 0 0 1\n0 0 1\n1 0 0 1\n0 1 0 2\n0 0 1 3\n0 0 0 1\n"


def bvh():
    joint = "OFFSET 0 %g 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n"
    text = "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n"
    names = ("LeftShoulder", "LeftArm", "LeftForeArm", "LeftHand")
    for name in names:
        text += "JOINT %s\n{\n" % name + joint % 0.3
    text += "End Site\n{\nOFFSET 0 0.1 0\n}\n" + "}\n" * len(names) + "}\nMOTION\nFrames: 4\nFrame Time: 0.1\n"
    yield (text + ("0 1 0 0 0 0 " + "0 10 0 " * len(names) + "\n") * 4).encode()


def joints():
    names = ("l_shoulder", "l_elbow", "l_wrist")
    head = "time," + ",".join("%s.%s" % (n, a) for n in names for a in "xyz")
    yield (head + "\n" + "".join("%g,0,0,1.4,0,0,1.1,0,0,0.83\n" % (f / 10) for f in range(6))).encode()


def record_json():
    yield b'{"name": "a", "numPoints": 3, "dT": 0.02, "unit": "g", "factor": 1, "accel_data": [0.1, -0.2, 3e-1]}'
    yield b'{"timeSeries": [{"dt": 0.01, "data": [1, 2], "units": "m/s^2"}]}'


def record_text():
    yield b"# time s, acceleration m/s^2\n0 0.5\n0.01 -1\n0.02 0.25\n"
    yield b"A RECORD\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS=  3, DT= .01 SEC\n .1E+00 -.2E+00\n .05\n"


def scene():
    yield b'{"schema": "topple.scene/1", "source": "a", "primitives": [], "objects": [], "contacts": [], "supports": []}'


def landscapes():
    poses = [{"up": [0, 0, 1], "energy_J": 0, "joins_at_J": None, "joins": -1, "probability": 0.6},
             {"up": [1, 0, 0], "energy_J": 0.5, "joins_at_J": 1.5, "joins": 0, "probability": 0.4}]
    passes = [{"up": [0.7, 0, 0.7], "energy_J": 1.5, "poses": [0, 1], "border": [[0.7, 0.1, 0.7], [0.7, -0.1, 0.7]]}]
    one = {"id": 1, "hull_m": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], "now": 0, "poses": poses, "passes": passes,
           "places": {"side": 1, "step_m": 0.02, "energy_J": [None], "blocked": [0]}}
    yield json.dumps({"schema": "topple.landscapes/1", "objects": [one]}).encode()


def main():
    folder = pathlib.Path(sys.argv[1])
    for make in (ply, pcd, xyz, las, obj, stl, glb, octomap, volume, depth, intrinsics, trajectory, bvh, joints, record_json,
                 record_text, scene, landscapes):
        into = folder / make.__name__
        into.mkdir(parents=True, exist_ok=True)
        for number, data in enumerate(make()):
            (into / ("seed-%d" % number)).write_bytes(data)


if __name__ == "__main__":
    main()
