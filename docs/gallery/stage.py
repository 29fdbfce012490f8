"""Writes a stage with forty lamps: stage.toml, and beside it the pictures that ten of the lamps project, as PNG.
Usage: stage.py FOLDER"""
import math
import pathlib
import struct
import sys
import zlib


def noise(i):
    """A number in [0,1) for each i, the same in every run."""
    return math.modf(math.sin(12.9898 * i + 4.1) * 43758.5453)[0] % 1.0


def write_png(path, rows, channels):
    """Rows of bytes, each `channels` to a pixel."""
    def chunk(kind, data):
        return struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))
    kind = 0 if channels == 1 else 2
    header = struct.pack('>IIBBBBB', len(rows[0]) // channels, len(rows), 8, kind, 0, 0, 0)
    packed = zlib.compress(b''.join(b'\0' + bytes(row) for row in rows), 9)
    path.write_bytes(b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', header) + chunk(b'IDAT', packed) + chunk(b'IEND', b''))


def mean(value, x, y, step):
    """Mean of a function over 3 x 3 points of a pixel."""
    points = [(x + (i - 1) * step / 3, y + (j - 1) * step / 3) for i in range(3) for j in range(3)]
    return sum(value(*p) for p in points) / 9


def leaves(size=256):
    """A gobo of light between leaves: ellipses cut out of a round hole."""
    blades = [(2 * noise(5 * i) - 1, 2 * noise(5 * i + 1) - 1, math.pi * noise(5 * i + 2), 0.10 + 0.10 * noise(5 * i + 3))
              for i in range(46)]

    def light(x, y):
        if math.hypot(x, y) > 0.97:
            return 0.0
        for a, b, turn, length in blades:
            along = (x - a) * math.cos(turn) + (y - b) * math.sin(turn)
            across = (y - b) * math.cos(turn) - (x - a) * math.sin(turn)
            if abs(along) < length and abs(across) < 0.42 * length * (1 - (along / length) ** 2):
                return 0.0
        return 1.0
    pixel = 2 / size
    return [[round(255 * mean(light, (i + 0.5) * pixel - 1, (j + 0.5) * pixel - 1, pixel)) for i in range(size)]
            for j in range(size)]


def window(width=96, height=144):
    """A gobo of a window with a round arch and bars."""
    def light(x, y):  # in widths, from the middle of the arch
        arch = y < 0 and math.hypot(x, y) > 0.46
        bar = min(abs(x), abs(abs(x) - 0.25)) < 0.018 or abs((y + 0.02) % 0.3 - 0.15) < 0.018
        return 0.0 if arch or abs(x) > 0.46 or y > 0.96 or bar else 1.0
    return [[round(255 * mean(light, (i + 0.5) / width - 0.5, (j + 0.5) / width - 0.5, 1 / width)) for i in range(width)]
            for j in range(height)]


def night(width=640, height=360):
    """A slide of a moon over hills and water."""
    def colour(x, y):  # in heights, from the top left
        from_moon = math.hypot(x - 1.25, y - 0.24)
        if from_moon < 0.085:
            return 255, 246, 214
        glow = math.exp(-4.0 * from_moon)
        if y > 0.86:  # water
            path = math.exp(-18 * abs(x - 1.25)) * (0.55 + 0.45 * math.sin(140 * y))
            return 20 + 200 * path, 40 + 180 * path, 86 + 120 * path
        if y > 0.70 + 0.05 * math.sin(3.1 * x + 0.4) + 0.02 * math.sin(11 * x):
            return 10, 26, 34
        if y > 0.60 + 0.07 * math.sin(2.2 * x + 2.0) + 0.015 * math.sin(9 * x):
            return 22, 44, 66
        return 24 + 90 * y + 120 * glow, 36 + 60 * y + 110 * glow, 96 + 60 * y + 80 * glow
    rows = []
    for j in range(height):
        row = []
        for i in range(width):
            row += [min(255, round(c)) for c in colour((i + 0.5) / height, (j + 0.5) / height)]
        rows.append(row)
    return rows


SET = '''# A stage of forty lamps, ten of which project pictures. docs/gallery/stage.py writes this file and the pictures.
title = "Stage"

[materials.boards]
reflectance = [0.30, 0.24, 0.19]
[materials.cloth]                      # of the backdrop
reflectance = 0.72
[materials.black]
reflectance = 0.03
[materials.stone]
reflectance = [0.55, 0.52, 0.48]
[materials.red]
reflectance = [0.55, 0.07, 0.06]
[materials.blue]
reflectance = [0.10, 0.20, 0.50]
[materials.skin]
reflectance = [0.62, 0.45, 0.36]

[[surfaces]]
name = "boards"
material = "boards"
polygon = [[-6, 0, 0], [6, 0, 0], [6, 8, 0], [-6, 8, 0]]
[[surfaces]]
name = "backdrop"
material = "cloth"
polygon = [[-6, 7.9, 0], [6, 7.9, 0], [6, 7.9, 5.5], [-6, 7.9, 5.5]]
[[surfaces]]
name = "house"
material = "black"
box = { min = [-9, -12, -1], max = [9, 8, 8], inward = true }
[[surfaces]]
name = "wings"
material = "black"
polygons = [
  [[-5.2, 2.0, 0], [-4.6, 2.3, 0], [-4.6, 2.3, 5.5], [-5.2, 2.0, 5.5]],
  [[-5.2, 5.0, 0], [-4.6, 5.3, 0], [-4.6, 5.3, 5.5], [-5.2, 5.0, 5.5]],
  [[5.2, 2.0, 0], [4.6, 2.3, 0], [4.6, 2.3, 5.5], [5.2, 2.0, 5.5]],
  [[5.2, 5.0, 0], [4.6, 5.3, 0], [4.6, 5.3, 5.5], [5.2, 5.0, 5.5]],
]
[[surfaces]]
name = "steps"
material = "stone"
box = { min = [-1.8, 4.6, 0], max = [1.8, 5.4, 0.18] }
[[surfaces]]
name = "terrace"
material = "stone"
box = { min = [-1.8, 5.4, 0], max = [1.8, 6.6, 0.36] }
'''


def surface(name, material, shape):
    return f'[[surfaces]]\nname = "{name}"\nmaterial = "{material}"\n{shape}\n'


def people():
    text = ''
    for name, material, x, y, z in (('tenor', 'blue', -1.1, 2.6, 0.0), ('soprano', 'red', 0.7, 5.9, 0.36),
                                    ('chorus', 'stone', 2.9, 3.6, 0.0)):
        text += surface(name + "'s gown", material,
                        f'cone = {{ from = [{x}, {y}, {z}], to = [{x}, {y}, {z + 1.45:g}], radius = 0.34, top_radius = 0.13 }}')
        text += surface(name, 'skin', f'sphere = {{ center = [{x}, {y}, {z + 1.58:g}], radius = 0.13 }}')
    for name, x in (('left column', -3.4), ('right column', -2.4)):
        text += surface(name, 'stone',
                        f'cylinder = {{ from = [{x}, 6.4, 0], to = [{x}, 6.4, 4.2], radius = 0.22 }}')
    return text


def lamp(name, position, look_at, strength, *more):
    lines = ['[[lamps]]', f'name = "{name}"', f'position = {list(position)}', f'look_at = {list(look_at)}', strength, *more]
    return '\n'.join(lines) + '\n'


def lamps():
    text = lamp('backdrop', (0, -7.0, 5.2), (0, 7.9, 2.75), 'lumens = 60000', 'picture = "night.png"', 'beam = 43.5',
                'shutters = { bottom = 0.03 }')
    for k in range(6):  # light between leaves
        x = -3.4 + 1.36 * k
        text += lamp(f'leaves {k + 1}', (round(0.7 * x, 3), 1.6 + 0.5 * (k % 2), 5.3), (round(x, 3), 2.2 + 0.9 * (k % 3), 0),
                     'lumens = 1500', 'colour = [0.75, 1.0, 0.55]', 'picture = "leaves.png"', 'beam = 27',
                     f'focus = {5.3 if k < 3 else 3.0}', 'lens = 0.15', f'up = [{round(math.cos(k), 3)}, {round(math.sin(k), 3)}, 0]')
    text += lamp('window', (4.4, -1.5, 4.6), (-0.6, 3.2, 0), 'lumens = 6500', 'colour = [1.0, 0.72, 0.42]',
                 'picture = "window.png"', 'beam = 17', 'focus = 8')
    text += lamp('far window', (-3.6, 0.6, 5.0), (3.3, 7.9, 2.0), 'lumens = 1100', 'colour = [1.0, 0.72, 0.42]',
                 'picture = "window.png"', 'beam = 11', 'focus = 6', 'lens = 0.15')
    text += lamp('frame', (0.2, -2.0, 5.2), (0.7, 5.9, 1.3), 'lumens = 2600', 'colour = [1.0, 0.85, 0.7]',
                 'picture = "leaves.png"', 'beam = 24', 'shutters = { left = 0.36, right = 0.36, top = 0.25, bottom = 0.3 }')
    for k in range(10):  # from the house
        x = -4.5 + k
        text += lamp(f'front {k + 1}', (x, -3.5, 5.4), (round(0.7 * x, 3), 3.0, 1.2), 'candela = 450',
                     f'colour = {[1.0, 0.78, 0.55] if k % 2 else [0.62, 0.75, 1.0]}', 'cone = [7, 12]')
    for k in range(10):  # from behind, down
        x = -4.5 + k
        text += lamp(f'back {k + 1}', (x, 7.2, 5.4), (x, 4.2, 0), 'candela = 900', 'colour = [0.35, 0.45, 1.0]', 'cone = [8, 14]')
    for k in range(10):  # from the wings
        side = -1 if k % 2 else 1
        y = 1.0 + 1.2 * (k // 2)
        text += lamp(f'side {k + 1}', (5.6 * side, y, 2.2), (0, y, 1.0), 'candela = 160',
                     f'colour = {[1.0, 0.45, 0.3] if side < 0 else [0.3, 0.55, 1.0]}', 'cone = [10, 18]')
    return text


CAMERA = '''[[cameras]]
name = "stalls"
position = [0.6, -9.5, 2.3]
look_at = [0, 5, 2.05]
up = [0, 0, 1]
fov = 50
size = [720, 405]
'''


def main():
    folder = pathlib.Path(sys.argv[1])
    write_png(folder / 'leaves.png', leaves(), 1)
    write_png(folder / 'window.png', window(), 1)
    write_png(folder / 'night.png', night(), 3)
    (folder / 'stage.toml').write_text(SET + people() + lamps() + CAMERA)


main()
