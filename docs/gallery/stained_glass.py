"""Draws a pane of stained glass as PNG: a golden sun over blue water between red hills and green trees, in leads.
Usage: stained_glass.py OUT.png"""
import math
import struct
import sys
import zlib

WIDTH, HEIGHT, PIECES = 240, 320, 90
LEAD = (6, 6, 7)


def noise(i):
    """A number in [0,1) for each i, the same in every run."""
    return math.modf(math.sin(12.9898 * i + 4.1) * 43758.5453)[0] % 1.0


def colour(x, y):
    """sRGB of the glass around (x, y), both in [0,1], y downwards."""
    from_sun = math.hypot(x - 0.5, (y - 0.36) * HEIGHT / WIDTH)
    if from_sun < 0.16:
        return 255, 214, 64
    if from_sun < 0.27:
        return 250, 138, 20
    if y > 0.72:
        return (16, 64, 214) if (x + 0.6 * y) % 0.3 < 0.17 else (20, 150, 226)
    if y > 0.52 + 0.1 * math.sin(5.0 * x + 0.6):
        return (206, 16, 24) if x < 0.5 else (22, 142, 44)
    return (120, 30, 170) if y < 0.14 else (190, 30, 110) if x < 0.5 else (40, 90, 220)


def nearest_two(x, y, pieces):
    order = sorted((math.hypot(x - a, (y - b) * HEIGHT / WIDTH), i) for i, (a, b) in enumerate(pieces))
    return order[0], order[1]


def rows():
    pieces = []
    for i in range(PIECES):  # each as far from the others as the best of twelve
        tries = [(noise(24 * i + 2 * k), noise(24 * i + 2 * k + 1)) for k in range(12)]
        pieces.append(max(tries, key=lambda t: min([math.dist(t, p) for p in pieces] + [9.0])))
    for j in range(HEIGHT):
        row = bytearray([0])
        for i in range(WIDTH):
            x, y = (i + 0.5) / WIDTH, (j + 0.5) / HEIGHT
            (first, piece), (second, _) = nearest_two(x, y, pieces)
            at_edge = min(i, j, WIDTH - 1 - i, HEIGHT - 1 - j) < 5
            if at_edge or second - first < 0.018:
                row += bytes(LEAD)
                continue
            tone = 0.8 + 0.2 * noise(piece + 1000)
            row += bytes(round(tone * c) for c in colour(*pieces[piece]))
        yield bytes(row)


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


with open(sys.argv[1], "wb") as out:
    header = struct.pack(">IIBBBBB", WIDTH, HEIGHT, 8, 2, 0, 0, 0)
    out.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(b"".join(rows()), 9)))
    out.write(chunk(b"IEND", b""))
